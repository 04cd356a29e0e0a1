//! Style sheets that are large, slow to match, or broken.

use crate::code;
use crate::support::svg;

#[test]
fn floods_of_style() {
    let styled = |sheet: &str, body: &str| {
        code(svg(&format!("<style>{sheet}</style><g class='rinceau-fixed'>{body}</g>")))
    };
    let paths = "<path class='b' d='M0 0L1 1'/>".repeat(2_000);
    let deep = "<g>".repeat(900) + &paths + &"</g>".repeat(900);
    assert_eq!(styled(&format!("{}y{{fill:red}}", "g ".repeat(30)), &deep), "read");
    assert_eq!(
        styled(&format!("{}path{{fill:red}}", "x g g g g g g g g g g ".repeat(3)), &deep),
        "style-too-complex"
    );
    assert_eq!(styled(&format!("{}path{{fill:red}}", "*+".repeat(100_000)), &paths), "read");
    assert_eq!(styled(&"path.a{fill:red}".repeat(50_000), &paths), "style-too-complex");
    assert_eq!(styled(&".a{fill:red}".repeat(50_000), &paths), "read");
    assert_eq!(styled(&format!("{}x{{{}}}", "a,".repeat(200_000), "b:c;".repeat(100_000)), &paths), "read");
    assert_eq!(styled(&"a{b:}".repeat(200_000), &paths), "read");
    assert_eq!(styled(&"x".repeat(2 << 20), ""), "style-too-large");
    assert_eq!(code(svg(&"<style>a{}</style>".repeat(2_000))), "style-too-large");
    let attribute = format!("<path style='{}' d='M0 0'/>", "a:b;".repeat(100_000));
    assert_eq!(styled("", &attribute.repeat(3)), "read");
    let first_child = format!("{}<path/>", "<!---->".repeat(50_000)).repeat(4);
    styled("path:first-child{fill:red} g+path{fill:red}", &first_child);
    for junk in
        ["{", "}", "/*", "@media{", "a{b", "'", "(", "<![CDATA[ ]]]]>", "a:hover{b:c}", "\\", "@", "a[b='é"]
    {
        assert_eq!(styled(junk, "<path d='M0 0'/>"), "read", "{junk}");
    }
}
