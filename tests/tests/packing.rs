//! What packing can do beside filling: fillers of all kinds, threaded elements, finishes, one connected
//! piece, pictures of the flow; and drawings that are hard to fill.

mod support;

use rinceau::geom::boolean::{area, difference, intersection, offset, signed_area, simplified, union};
use rinceau::geom::region::Region;
use rinceau_format::{Artwork, Part, Scene};
use support::geometry::*;
use support::packing::{check, pack};

const HEART: &str =
    "M200,110C230,10 390,20 380,150C372,240 260,310 200,385C140,310 28,240 20,150C10,20 170,10 200,110Z";

fn heart() -> Scene {
    scene(&format!(
        "<path id='c' class='rinceau-container' d='{HEART}'/><path class='rinceau-guide' d='M200,350C180,200 100,200 110,110' fill='none'/>"
    ))
}

fn scene(body: &str) -> Scene {
    let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 400'>{body}</svg>");
    read(svg).1
}

fn packed(scene: &Scene, params: &[(&str, &str)]) -> Artwork {
    let params: Vec<(&str, String)> =
        params.iter().map(|(name, value)| (*name, (*value).to_owned())).collect();
    pack(scene, &params, 5).unwrap()
}

/// Everything that containers cover.
fn region(scene: &Scene) -> Region {
    let outlines = scene.containers.iter().flat_map(|container| &container.outlines);
    let all = outlines.map(|outline| simplified(&contours(&outline.path), true));
    Region::new(all.reduce(|a, b| union(&a, &b)).unwrap()).unwrap()
}

fn names(artwork: &Artwork, group: &str) -> Vec<String> {
    let mut names: Vec<String> = artwork
        .group(group)
        .map_or(Vec::new(), |group| group.items.iter().map(|item| item.of.clone()).collect());
    names.sort();
    names.dedup();
    names
}

#[test]
fn gaps_take_dots_diamonds_drops_and_elements_of_ones_own() {
    let own = "<g class='rinceau-element' rinceau:kind='star' xmlns:rinceau='RINCEAU' id='star'><path d='M0,10 20,0 40,10 20,20Z' fill='#c00'/><path class='rinceau-spine' d='M0,10H40'/></g>"
        .replace("RINCEAU", rinceau_format::NAMESPACE);
    let own = scene(&format!("<path id='c' class='rinceau-container' d='{HEART}'/>{own}"));
    for (scene, fillers, expected) in [
        (heart(), "dots", &["dot"][..]),
        (heart(), "diamonds", &["diamond"]),
        (heart(), "drops", &["drop"]),
        (heart(), "dots drops", &["dot", "drop"]),
        (own, "star", &["star"]),
    ] {
        let artwork = packed(
            &scene,
            &[("spacing", "46"), ("min-gap", "3"), ("elements", "mixed"), ("fillers", fillers)],
        );
        check(&artwork, &region(&scene), &[], (3.0, 3.0));
        assert_eq!(names(&artwork, "fillers"), expected);
        assert!(artwork.counts["fillers"] > 12.0, "{fillers}: {:?}", artwork.counts);
        // The gap around them is one's own choice too.
        let closer = [("spacing", "46"), ("min-gap", "4"), ("filler-gap", "1.5"), ("fillers", fillers)];
        check(&packed(&scene, &closer), &region(&scene), &[], (4.0, 1.5));
    }
    let refused = pack(&heart(), &[("fillers", "dost".to_owned())], 1).unwrap_err();
    assert_eq!(refused.code(), "no-filler");
}

#[test]
fn large_rooms_get_elements_with_veins() {
    let outline = "M0,20C30,0 90,0 120,20C90,40 30,40 0,20Z";
    let veins = "M20,18H100V22H20ZM30,12H90V15H30ZM30,25H90V28H30Z";
    let element = |id: &str, d: &str, y: f64| {
        format!(
            "<g class='rinceau-element' id='{id}' transform='translate(0 {y})'><path fill-rule='evenodd' d='{d}'/><path class='rinceau-spine' d='M0,20H120'/></g>"
        )
    };
    let container = format!("<path id='c' class='rinceau-container' d='{HEART}'/>");
    let both = scene(&format!(
        "{container}{}{}",
        element("blank", outline, 400.0),
        element("veined", &format!("{outline}{veins}"), 450.0)
    ));
    let params = [("spacing", "46"), ("elements", "drawn"), ("fillers", "none"), ("mould", "0")];
    let sizes = |artwork: &Artwork, of: &str| -> Vec<f64> {
        let items = artwork.group("elements").unwrap().items.iter().filter(|item| item.of == of);
        // The outline is the largest contour.
        let outline =
            |part: &Part| contours(&part.path).iter().map(|c| signed_area(c).abs()).fold(0.0, f64::max);
        items.flat_map(|item| item.parts.iter().map(outline)).collect()
    };
    let artwork = packed(&both, &params);
    let (blank, veined) = (sizes(&artwork, "blank"), sizes(&artwork, "veined"));
    let largest = |sizes: &[f64]| sizes.iter().copied().fold(0.0, f64::max);
    assert!(veined.len() > blank.len(), "{} {}", veined.len(), blank.len());
    assert!(largest(&veined) > 1.3 * largest(&blank), "{veined:?} {blank:?}");
    // Where there is no other, it is taken as ever.
    let alone = packed(&scene(&format!("{container}{}", element("blank", outline, 400.0))), &params);
    assert!(alone.counts["coverage"] > 0.5, "{:?}", alone.counts);
}

#[test]
fn elements_are_threaded_on_lines() {
    let scene = heart();
    let (single, threaded) =
        (packed(&scene, &[("spacing", "30")]), packed(&scene, &[("spacing", "30"), ("thread", "4")]));
    assert!(threaded.counts["streamlines"] > 1.6 * single.counts["streamlines"]);
    check(&threaded, &region(&scene), &[], (30.0 / 8.0, 0.42 * 30.0 / 8.0));
}

/// Small elements fill what refinement leaves open.
#[test]
fn refinement_inserts_small_elements_and_evens_the_gaps() {
    let scene = heart();
    let measure = |iterations: &str, fillers: &str| {
        let artwork = packed(&scene, &[("iterations", iterations), ("fillers", fillers)]);
        (rinceau::quality::measure(&scene, &artwork).unwrap(), artwork.counts["elements"])
    };
    let ((before, few), (after, many)) = (measure("0", "none"), measure("15", "none"));
    assert!(many > few);
    assert!(after["coverage"] > 1.06 * before["coverage"], "{before:?} {after:?}");
    let (filled, _) = measure("15", "dots");
    assert!(filled["gap_cv"] < 0.72 * before["gap_cv"], "{before:?} {filled:?}");
    assert!(filled["evenness"] > before["evenness"], "{before:?} {filled:?}");
}

/// Strokes are ink: gaps between them are as even as between outlines.
#[test]
fn gaps_between_strokes_are_filled_too() {
    let largest = |stroke: &str| {
        let scene = scene(&format!(
            "<circle class='rinceau-container' cx='200' cy='200' r='120'/><g class='rinceau-element' id='e'><path d='M600,0C610,-10 630,-10 640,0C630,10 610,10 600,0Z' fill='#284' stroke='#c40' stroke-width='{stroke}'/><path class='rinceau-spine' d='M600,0H640' fill='none'/></g>"
        ));
        rinceau::quality::measure(&scene, &packed(&scene, &[("spacing", "25")])).unwrap()["largest_gap"]
    };
    for stroke in ["0", "2", "5"] {
        let largest = largest(stroke);
        assert!(largest < 1.6, "stroke {stroke}: {largest}");
    }
}

#[test]
fn worn_and_rounded_elements_stay_within_themselves() {
    let scene = heart();
    let plain = packed(&scene, &[("spacing", "40")]);
    let elements = pieces(&plain, "elements");
    for (name, value, least) in [("distress", "0.5", 0.5), ("rounding", "1.5", 0.9)] {
        let finished = packed(&scene, &[("spacing", "40"), (name, value)]);
        let worn = pieces(&finished, "elements");
        assert_eq!(worn.len(), elements.len());
        let (mut all, mut kept) = (0.0, 0.0);
        for (worn, whole) in worn.iter().zip(&elements) {
            let whole = simplified(whole, false);
            let beyond = area(&difference(&simplified(worn, false), &offset(&whole, 0.2)));
            assert!(beyond < 1e-3, "{name}: {beyond} beyond its outline");
            all += area(&whole);
            kept += area(&simplified(worn, false));
        }
        assert!(kept < 0.999 * all && kept > least * all, "{name}: {kept} of {all}");
        assert_eq!(
            format!("{:?}", packed(&scene, &[("spacing", "40"), (name, value)]).groups),
            format!("{:?}", finished.groups)
        );
    }
}

#[test]
fn what_is_not_finished_when_the_time_is_out_stays_whole() {
    struct Half;
    impl rinceau::Progress for Half {
        fn step(&mut self, stage: &'static str, done: f64) -> bool {
            stage != "artwork" || done < 0.5
        }
    }
    let run = |params: &[(&str, &str)], progress: &mut dyn rinceau::Progress| {
        let params: Vec<_> = params.iter().map(|&(name, value)| (name, value.to_owned())).collect();
        let pack = generator("pack");
        rinceau::generate(pack, &values(pack, &params), &heart(), 5, progress).unwrap()
    };
    let worn = [("spacing", "20"), ("distress", "0.5"), ("fillers", "none")];
    let half = run(&worn, &mut Half);
    let of = |params| pieces(&run(params, &mut rinceau::Deadline::new(None)), "elements");
    let (worn, whole, half_worn) = (of(&worn), of(&[worn[0], worn[2]]), pieces(&half, "elements"));
    let like =
        |others: &[Vec<Vec<kurbo::Point>>]| half_worn.iter().zip(others).filter(|(a, b)| a == b).count();
    assert!(!half.complete && half_worn.len() == whole.len());
    assert!(like(&worn) > 15 && like(&whole) > 15, "{} {} of {}", like(&worn), like(&whole), whole.len());
}

#[test]
fn one_connected_piece_is_nowhere_thinner_than_a_bridge() {
    let two = scene(
        "<circle class='rinceau-container' cx='110' cy='200' r='90'/><circle class='rinceau-container' cx='310' cy='200' r='80'/>",
    );
    for (scene, fillers) in [(heart(), "none"), (heart(), "dots"), (two, "none")] {
        let width = 4.0;
        let artwork =
            packed(&scene, &[("spacing", "40"), ("connect", "true"), ("bridge", "4"), ("fillers", fillers)]);
        assert!(artwork.group("elements").is_none());
        let piece = simplified(&pieces(&artwork, "piece")[0], false);
        let outer = |contours: &[Vec<kurbo::Point>]| contours.iter().filter(|c| signed_area(c) > 0.0).count();
        assert_eq!(outer(&piece), 1, "one piece");
        // A knife of nearly half the width from both sides leaves it whole.
        let thinned = offset(&piece, -0.46 * width);
        let crumbs = thinned.iter().filter(|c| signed_area(c) > 1e-3).count();
        assert_eq!(crumbs, 1, "nothing hangs by less than a bridge");
        let opened = offset(&offset(&piece, -0.48 * width), 0.48 * width);
        assert!(area(&difference(&piece, &offset(&opened, 0.03 * width))) < 1e-3 * area(&piece));
        assert!(artwork.counts["bridges"] > 5.0, "{:?}", artwork.counts);
    }
    for bridge in ["90", "1e9"] {
        let refused = pack(&heart(), &[("connect", "true".to_owned()), ("bridge", bridge.to_owned())], 1);
        assert_eq!(refused.unwrap_err().code(), "bridge-too-wide");
    }
}

/// The one piece of a mirrored layout is its own mirror image, and hangs together in two places at least.
#[test]
fn bridges_of_a_mirrored_layout_are_mirrored() {
    let flags = [
        ("spacing", "40"),
        ("connect", "true"),
        ("bridge", "4"),
        ("symmetry", "mirror"),
        ("fillers", "none"),
    ];
    let artwork = packed(&heart(), &flags);
    let piece = simplified(&pieces(&artwork, "piece")[0], false);
    assert_eq!(piece.iter().filter(|contour| signed_area(contour) > 0.0).count(), 1);
    let all = bounds(&piece);
    let axis = all.center().x;
    let image: Vec<Vec<kurbo::Point>> = piece
        .iter()
        .map(|contour| contour.iter().rev().map(|p| kurbo::Point::new(2.0 * axis - p.x, p.y)).collect())
        .collect();
    let unlike = area(&difference(&piece, &image));
    assert!(unlike < 2e-3 * area(&piece), "{unlike} of {}", area(&piece));
    let strip = |x0: f64, x1: f64| {
        vec![[(x0, all.y0), (x1, all.y0), (x1, all.y1), (x0, all.y1)].map(Into::into).to_vec()]
    };
    let across = intersection(&piece, &strip(axis - 0.05, axis + 0.05));
    assert_eq!(across.len(), 2, "two bridges over the axis");
}

#[test]
fn bridges_go_around_what_is_fixed_if_they_can() {
    let in_heart = |fixed: &str| {
        let scene = scene(&format!("<path class='rinceau-container' d='{HEART}'/>{fixed}"));
        let artwork =
            packed(&scene, &[("spacing", "40"), ("connect", "true"), ("bridge", "4"), ("fillers", "none")]);
        let piece = simplified(&pieces(&artwork, "piece")[0], false);
        assert_eq!(
            piece.iter().filter(|contour| signed_area(contour) > 0.0).count(),
            1,
            "{fixed}: one piece"
        );
        let parts = scene.fixed.iter().flat_map(|fixed| &fixed.parts);
        let fixed: Vec<Vec<kurbo::Point>> = parts.flat_map(|part| contours(&part.path)).collect();
        (area(&intersection(&piece, &simplified(&fixed, false))), artwork.warnings.join("; "))
    };
    // The shortest bridge would cross the first two.
    for [x, y, width, height] in
        [[242, 74, 140, 1], [224, 68, 140, 1], [120, 160, 280, 8], [200, 100, 8, 240]]
    {
        let (common, warnings) = in_heart(&format!(
            "<rect class='rinceau-fixed' x='{x}' y='{y}' width='{width}' height='{height}'/>"
        ));
        assert!(common < 1e-6 && warnings.is_empty(), "{x},{y}: {common} {warnings}");
    }
    let (common, warnings) = in_heart("<rect class='rinceau-fixed' x='0' y='195' width='400' height='12'/>");
    assert!(common > 12.0 && common < 60.0, "one bridge: {common}");
    assert_eq!(
        warnings,
        "1 bridge crosses what is fixed, since nothing else joins the piece on both sides of it"
    );
}

#[test]
fn the_flow_can_be_seen() {
    let scene = scene(
        "<circle class='rinceau-container' cx='200' cy='200' r='150'/><circle class='rinceau-guide' cx='200' cy='200' r='80' fill='none'/>",
    );
    let artwork = packed(&scene, &[("show-flow", "true")]);
    let flow = artwork.group("flow").unwrap();
    assert!(flow.hidden);
    let singular: Vec<kurbo::Rect> = flow
        .items
        .iter()
        .filter(|item| item.of == "singularity")
        .map(|item| bounds(&contours(&item.parts[0].path)))
        .collect();
    assert!(!singular.is_empty() && singular.len() <= 2, "{singular:?}");
    assert!(singular.iter().all(|at| at.center().distance((200.0, 200.0).into()) < 40.0), "{singular:?}");
}

#[test]
fn the_shortest_paths_of_the_paper_keep_all_promises() {
    let scene = heart();
    let artwork =
        packed(&scene, &[("spacing", "44"), ("shift", "paper"), ("iterations", "6"), ("min-gap", "3")]);
    check(&artwork, &region(&scene), &[], (3.0, 3.0));
    assert!(artwork.counts["flow-angle"] < 10.0, "{:?}", artwork.counts);
}

/// Shapes that are hard to fill: each fills, and keeps all promises.
#[test]
fn awkward_containers_are_filled() {
    // Drawn by hand: E, u, r, o in a bold face, and a ring with an island.
    let euro = "M20,120H110V160H65V185H100V220H65V245H112V285H20ZM125,165H165V235C165,255 185,255 185,235V165H225V285H188V272C170,295 125,295 125,250ZM240,165H275V185C285,168 300,162 312,166V205C290,200 278,210 278,230V285H240ZM318,225A38,62 0 1 1 394,225A38,62 0 1 1 318,225ZM345,225A11,26 0 1 0 367,225A11,26 0 1 0 345,225Z";
    let island =
        "M200,20A180,180 0 1 1 199.9,20ZM200,70A130,130 0 1 0 200.1,70ZM200,120A80,80 0 1 1 199.9,120Z";
    for (name, outline, least) in [
        ("letters", euro, 0.4),
        ("an island in a hole", island, 0.4),
        ("a neck thinner than the gap", "M20,100H180V198H220V100H380V300H220V200H180V300H20Z", 0.4),
        (
            "spikes",
            "M200,20 215,160 380,60 240,185 390,200 240,215 380,340 215,240 200,390 185,240 20,340 160,215 10,200 160,185 20,60 185,160Z",
            0.15,
        ),
        ("a strip", "M10,195H390V215H10Z", 0.3),
        ("a half open ring", "M200,20A180,180 0 1 0 380,200H340A140,140 0 1 1 200,60Z", 0.4),
    ] {
        let scene =
            scene(&format!("<path id='c' class='rinceau-container' fill-rule='evenodd' d='{outline}'/>"));
        let artwork = packed(&scene, &[("min-gap", "1.5")]);
        check(&artwork, &region(&scene), &[], (1.5, 1.5));
        assert!(artwork.counts["coverage"] > least, "{name}: {:?}", artwork.counts);
    }
}

#[test]
fn containers_that_share_walls_keep_the_gap_across_them() {
    let cell = |x: usize, y: usize| {
        let (x, y) = (20.0 + 90.0 * x as f64, 20.0 + 90.0 * y as f64);
        format!("<path class='rinceau-container' d='M{x},{y}h90v90h-90Z'/>")
    };
    let cells: String = (0..16).map(|k| cell(k % 4, k / 4)).collect();
    let scene = scene(&cells);
    let artwork = packed(&scene, &[("min-gap", "4"), ("edge", "0.5")]);
    check(&artwork, &region(&scene), &[], (4.0, 4.0));
    assert!(artwork.counts["coverage"] > 0.4);
}

/// Guides that contradict each other, close on themselves, wind up or part.
#[test]
fn awkward_guides_are_followed_as_well_as_can_be() {
    let spiral: String = (0..200)
        .map(|k| {
            let angle = f64::from(k) * 0.12;
            let (r, c) = (6.0 * angle, if k == 0 { 'M' } else { 'L' });
            format!("{c}{:.2},{:.2}", 200.0 + r * angle.cos(), 200.0 + r * angle.sin())
        })
        .collect();
    for (name, guides, most) in [
        ("crossing", vec!["M50,200H350".to_owned(), "M200,50V350".to_owned()], 14.0),
        ("contradicting", vec!["M80,200H320".to_owned(), "M80,203L320,197".to_owned()], 8.0),
        ("a closed loop", vec!["M120,200A80,80 0 1 1 280,200A80,80 0 1 1 120,200Z".to_owned()], 9.0),
        ("a spiral", vec![spiral], 9.0),
        (
            "a saddle",
            vec![
                "M60,200Q200,190 200,60".to_owned(),
                "M340,200Q200,210 200,340".to_owned(),
                "M60,210Q190,210 190,340".to_owned(),
                "M340,190Q210,190 210,60".to_owned(),
            ],
            14.0,
        ),
        ("back and forth", vec!["M60,150H340V160H60V170H340".to_owned()], 14.0),
    ] {
        let guides: String =
            guides.iter().map(|d| format!("<path class='rinceau-guide' d='{d}' fill='none'/>")).collect();
        let scene = scene(&format!("<circle class='rinceau-container' cx='200' cy='200' r='170'/>{guides}"));
        let artwork = packed(&scene, &[("spacing", "26"), ("min-gap", "3")]);
        check(&artwork, &region(&scene), &[], (3.0, 3.0));
        assert!(artwork.counts["coverage"] > 0.45, "{name}: {:?}", artwork.counts);
        assert!(artwork.counts["flow-angle"] < most, "{name}: {:?}", artwork.counts);
    }
}

#[test]
fn of_fixed_spines_in_one_place_the_first_carries_an_element() {
    let spines = [
        "M60,200C150,160 250,240 340,200",
        "M200,60C160,150 240,250 200,340",
        "M100,300H300",
        "M340,200C250,240 150,160 60,200",
    ];
    let spines: String =
        spines.map(|d| format!("<path class='rinceau-fixed-spine' fill='none' d='{d}'/>")).concat();
    let scene = scene(&format!("<circle class='rinceau-container' cx='200' cy='200' r='190'/>{spines}"));
    let artwork = packed(&scene, &[]);
    assert_eq!(
        artwork.warnings,
        ["2 of 4 fixed spines carry no element: others that lie below cross them or run there too"]
    );
    // A line of elements along the first.
    let along = |item: &rinceau_format::Item| {
        let at = bounds(&contours(&item.parts[0].path));
        at.x0 < 110.0 && at.x1 > 290.0 && at.height() < 110.0 && (at.center().y - 200.0).abs() < 20.0
    };
    assert!(artwork.group("spines").unwrap().items.iter().any(along));
}

/// A spine that turns back, and one that winds up, carry an element without a fold.
#[test]
fn tight_turns_do_not_fold() {
    let spiral: String = (0..120)
        .map(|k| {
            let angle = f64::from(k) * 0.1;
            let (r, c) = (20.0 + 7.0 * angle, if k == 0 { 'M' } else { 'L' });
            format!("{c}{:.2},{:.2}", 200.0 + r * angle.cos(), 200.0 + r * angle.sin())
        })
        .collect();
    for spine in ["M100,300V150C100,90 170,90 170,150V300", "M120,260V140A14,14 0 0 1 148,140V260", &spiral] {
        let scene = scene(&format!(
            "<circle class='rinceau-container' cx='200' cy='200' r='170'/><path class='rinceau-fixed-spine' d='{spine}' fill='none'/>"
        ));
        assert_eq!(scene.fixed_spines.len(), 1);
        let artwork = packed(&scene, &[("spacing", "30"), ("min-gap", "3")]);
        check(&artwork, &region(&scene), &[], (3.0, 3.0));
        assert!(artwork.warnings.is_empty(), "{:?}", artwork.warnings);
    }
}

/// Strokes count: nothing comes nearer to one than the gap.
#[test]
fn strokes_keep_the_gap_too() {
    let element = |id: &str, stroke: f64| {
        format!(
            "<g class='rinceau-element' id='{id}'><path d='M0,0C30,22 70,22 100,0C70,-22 30,-22 0,0Z' stroke='#222' stroke-width='{stroke}'/><path class='rinceau-spine' d='M0,0H100' fill='none'/></g>"
        )
    };
    let scene = scene(&format!(
        "<path class='rinceau-container' d='{HEART}'/>{}{}",
        element("a", 6.0),
        element("b", 9.0)
    ));
    let artwork = packed(&scene, &[("spacing", "44"), ("min-gap", "3"), ("elements", "a"), ("fillers", "b")]);
    let all: Vec<(Piece, f64)> = ["elements", "fillers"]
        .into_iter()
        .flat_map(|name| {
            let items = &artwork.group(name).unwrap().items;
            let strokes = items.iter().map(|item| item.parts[0].style.stroke_width().unwrap() / 2.0);
            pieces(&artwork, name).into_iter().zip(strokes).collect::<Vec<_>>()
        })
        .collect();
    assert!(artwork.counts["fillers"] > 10.0, "{:?}", artwork.counts);
    for (i, (piece, stroke)) in all.iter().enumerate() {
        for (other, others) in &all[..i] {
            let least = 3.0 + stroke + others;
            assert!(
                distance(piece, other, least) >= least - 2.0 * SLACK,
                "{i}: {} < {least}",
                distance(piece, other, least)
            );
        }
    }
}

/// Elements with one node and with ten thousand, of many colours, with gradients and strokes.
#[test]
fn awkward_elements_are_bent() {
    let wavy: String = (0..10_000)
        .map(|k| {
            let t = f64::from(k) / 10_000.0 * std::f64::consts::TAU;
            let r = 1.0 + 0.05 * (200.0 * t).sin();
            format!(
                "{}{:.3},{:.3}",
                if k == 0 { 'M' } else { 'L' },
                50.0 - 48.0 * r * t.cos(),
                10.0 * r * t.sin()
            )
        })
        .collect();
    let stripes: String = (0..30)
        .map(|k| {
            format!("<path d='M{0},-{1}V{1}h2V-{1}Z' fill='hsl({2},60%,50%)'/>", 3 * k, 10 - (k % 7), 12 * k)
        })
        .collect();
    for (name, body, parts) in [
        ("one node", "<path d='M0,0C60,40 60,-40 0,0Z'/>".to_owned(), 1),
        ("ten thousand nodes", format!("<path d='{wavy}Z'/>"), 1),
        ("many colours", stripes, 30),
        (
            "a gradient and a stroke",
            "<path d='M0,0Q50,20 100,0Q50,-20 0,0Z' fill='url(#g)' stroke='#222' stroke-width='2'/>"
                .to_owned(),
            1,
        ),
    ] {
        let scene = scene(&format!(
            "<defs><linearGradient id='g'><stop offset='0'/></linearGradient></defs><circle class='rinceau-container' cx='200' cy='200' r='170'/><g id='e' class='rinceau-element'>{body}<path class='rinceau-spine' d='M0,0H100' fill='none'/></g>"
        ));
        let artwork = packed(&scene, &[("spacing", "40"), ("fillers", "none")]);
        let elements = artwork.group("elements").unwrap();
        assert!(elements.items.len() > 15, "{name}: {}", elements.items.len());
        assert!(elements.items.iter().all(|item| item.parts.len() == parts), "{name}");
        if parts == 1 && body.len() > 10_000 {
            // All pairs of sides would take minutes; the outline has been checked like any other.
            let all = pieces(&artwork, "elements");
            all.iter()
                .enumerate()
                .for_each(|(i, piece)| assert_inside(&i.to_string(), piece, &region(&scene)));
        } else {
            check(&artwork, &region(&scene), &[], (5.0, 5.0));
        }
    }
}

/// Lines along shortest paths may end up in the middle of another element, where next to no gap is asked for.
#[test]
fn lines_along_shortest_paths_nest_nothing() {
    let (_, scene) = read(std::fs::read(support::root().join("samples/pack/bird.svg")).unwrap());
    let params = [("shift", "paper"), ("min-gap", "0.01"), ("mould", "0"), ("fillers", "none")];
    let params = params.map(|(name, value)| (name, value.to_owned()));
    let measures = rinceau::quality::measure(&scene, &pack(&scene, &params, 1).unwrap()).unwrap();
    assert_eq!(measures["overlap"], 0.0, "{measures:?}");
}

/// A notch in the outline of the bird is narrower than any grid that gaps are looked for on.
#[test]
fn fillers_stay_out_of_slits() {
    let (_, scene) = read(std::fs::read(support::root().join("samples/pack/bird.svg")).unwrap());
    let params = [("min-gap", "0.01"), ("fillers", "dots")].map(|(name, value)| (name, value.to_owned()));
    let measures = rinceau::quality::measure(&scene, &pack(&scene, &params, 1).unwrap()).unwrap();
    assert_eq!((measures["overlap"], measures["spill"]), (0.0, 0.0), "{measures:?}");
}

/// What the samples are known for: gaps of one width, also against what is first placed.
#[test]
fn samples_are_filled_evenly() {
    for name in ["cat", "heart", "leaf", "lion", "unicorn"] {
        let (_, scene) =
            read(std::fs::read(support::root().join(format!("samples/pack/{name}.svg"))).unwrap());
        let measured = |params: &[(&str, String)]| {
            rinceau::quality::measure(&scene, &pack(&scene, params, 1).unwrap()).unwrap()
        };
        let whole = measured(&[]);
        assert!(whole["largest_gap"] <= 1.6, "{name}: {whole:?}");
        assert!(whole["coverage"] >= 0.6 && whole["boundary"] >= 0.9, "{name}: {whole:?}");
        assert!(whole["evenness"] >= 0.85, "{name}: {whole:?}");
        assert_eq!((whole["overlap"], whole["spill"]), (0.0, 0.0), "{name}");
        // Refinement alone, too.
        let none = ("fillers", "none".to_owned());
        let (plain, refined) = (measured(&[none.clone(), ("iterations", "0".to_owned())]), measured(&[none]));
        assert!(refined["gap_cv"] <= 0.7 * plain["gap_cv"], "{name}: {refined:?} {plain:?}");
        assert!(refined["evenness"] > plain["evenness"], "{name}: {refined:?} {plain:?}");
    }
}
