//! Numbers, lists and paths that are hardly numbers, lists and paths.

use crate::support::svg;
use crate::{code, read};

const NUMBERS: [&str; 24] = [
    "1e9",
    "1e10",
    "-1e10",
    "1e38",
    "1e39",
    "1e300",
    "1e308",
    "-1e308",
    "1e309",
    "1e999999999",
    "NaN",
    "nan",
    "inf",
    "-inf",
    "Infinity",
    "5e-324",
    "1e-300",
    "0",
    "-0",
    "",
    " ",
    "é",
    "100%",
    "1e5em",
];

#[test]
fn odd_numbers_in_every_attribute() {
    let shapes = [
        ("rect", vec!["x", "y", "width", "height", "rx", "ry"]),
        ("image", vec!["x", "y", "width", "height"]),
        ("circle", vec!["cx", "cy", "r"]),
        ("ellipse", vec!["cx", "cy", "rx", "ry"]),
        ("line", vec!["x1", "y1", "x2", "y2"]),
        ("svg", vec!["x", "y", "width", "height", "viewBox"]),
        ("g", vec!["font-size", "stroke-width", "stroke-dasharray", "stroke-dashoffset", "opacity"]),
        ("use", vec!["x", "y", "width", "height"]),
    ];
    let usual = "x='1' y='1' width='9' height='9' r='3' rx='2' ry='2' x2='5' y2='5' href='#s' stroke='red'";
    for (tag, names) in shapes {
        for name in names {
            for number in NUMBERS {
                let number =
                    if name == "viewBox" { format!("0 0 {number} {number}") } else { number.to_owned() };
                let rest: String = usual
                    .split(' ')
                    .filter(|attribute| !attribute.starts_with(&format!("{name}=")))
                    .collect::<Vec<_>>()
                    .join(" ");
                for role in ["fixed", "container", "spray", "seed"] {
                    let content = "<symbol id='s' viewBox='0 0 2 2'><path d='M0 0L1em 1z'/></symbol>";
                    let rect = "<rect width='1em' height='10%' stroke='red'/>";
                    code(svg(&format!(
                        "{content}<g class='rinceau-{role}'><{tag} {rest} {name}='{number}'>{rect}</{tag}></g>"
                    )));
                }
            }
        }
    }
}

#[test]
fn odd_numbers_in_lists() {
    for a in NUMBERS {
        for b in ["0", "1", "1e308", "5e-324", "-1e39"] {
            for data in [
                format!("M{a} {b}"),
                format!("M0 0L{a} {b}"),
                format!("M0 0l{a} {b} l{a} {b} z"),
                format!("M0 0A{a} {b} 0 0 1 9 9"),
                format!("M0 0A5 5 {a} 1 0 {b} 9z"),
                format!("M0 0A1e-300 1e300 {a} 1 1 {b} {a}z"),
                format!("M0 0C{a} {b} 1 1 {b} {a}S1 1 {a} {b}"),
                format!("M0 0q{a} {b} 1 1 t1 1 t1 1 t1 1"),
            ] {
                code(svg(&format!("<path class='rinceau-container' d='{data}'/>")));
            }
            code(svg(&format!("<polygon class='rinceau-container' points='{a},{b} 1,1 {b},{a}'/>")));
            for transform in [
                format!("matrix({a} {b} {b} {a} 0 0)"),
                format!("scale({a},{b})"),
                format!("translate({a},{b})"),
                format!("rotate({a} {b} 1)"),
                format!("skewX({a}) skewY({b})"),
            ] {
                let point = "<path class='rinceau-spray' stroke='red' d='M0 0'/>";
                let line = "<path class='rinceau-fixed' stroke='red' d='M0 0L1 1'/>";
                let group = format!("<g transform='{transform}'>{point}{line}</g>");
                code(svg(&group));
                code(svg(&format!("<g transform='{transform}'>{group}</g>")));
                code(svg(&format!("<g transform-origin='{a} {b}' transform='{transform}'>{line}</g>")));
                code(svg(&format!("<g style='transform:{transform}'>{line}</g>")));
            }
            for root in [
                format!("viewBox='0 0 {a} {b}'"),
                format!("viewBox='{a} {b} 10 10'"),
                format!("viewBox='0 0 10 10' width='{a}' height='{b}'"),
                format!("width='{a}' height='{b}mm'"),
                format!("viewBox='{a}'"),
            ] {
                let text = format!(
                    "<svg xmlns='http://www.w3.org/2000/svg' {root}><rect class='rinceau-container' width='50%' height='9'/></svg>"
                );
                code(text);
            }
        }
    }
}

#[test]
fn odd_paths() {
    let as_role = |role: &str, data: &str| read(svg(&format!("<path class='rinceau-{role}' d='{data}'/>")));
    for data in [
        "",
        " ",
        "none",
        "M5,5",
        "M5,5z",
        "M5,5 M6,6",
        "M1,1 L1,1",
        "M1 1zzzz",
        "M0 0h1v1h-1zM0 0h1v1h-1z",
        "M0 0L4 4L4 0L0 4z",
        "M0 0C0 0 0 0 0 0",
        "M0 0A0 0 0 0 0 1 1",
        "M0 0A1 1 0 0 0 0 0",
    ] {
        for role in ["container", "guide", "fixed", "fixed-spine", "stem", "seed", "boundary", "spray"] {
            assert!(as_role(role, data).is_ok(), "{role} {data}");
        }
        for role in ["element", "spine"] {
            let _ = as_role(role, data);
        }
    }
    for data in
        ["L1,1", "M", "M1", "M0,0 L", "x", "M0,0 é", "M0 0A1 1 0 2 0 1 1", "M0 0 L1 1 #", "\u{feff}M0 0"]
    {
        assert_eq!(as_role("guide", data).unwrap_err().code(), "broken-object", "{data}");
    }
    let seed = as_role("seed", "M5,7").unwrap();
    assert_eq!(seed.seeds[0].at, kurbo::Point::new(5.0, 7.0));
    assert_eq!(as_role("seed", "").unwrap().warnings.len(), 1);
}

#[test]
fn singular_transforms_are_read_and_overflowing_ones_are_not() {
    let with = |transform: &str| {
        code(svg(&format!("<rect transform='{transform}' class='rinceau-container' width='9' height='9'/>")))
    };
    assert_eq!(with("scale(0)"), "read");
    assert_eq!(with("matrix(1 1 1 1 0 0)"), "read");
    assert_eq!(with("scale(1e200) scale(1e200)"), "coordinate-range");
    assert_eq!(with("translate(1e308) translate(1e308)"), "coordinate-range");
    assert_eq!(with("scale(1e8)"), "read");
    assert_eq!(with("scale(1e9)"), "coordinate-range");
    assert_eq!(with("rotate(1,2)"), "broken-object");
}
