#!/usr/bin/env python3
"""Draws the samples of growth: panels with a hole, a concave one and a letter for each pattern,
symmetric ones, one design in several styles, growth towards fixed blossoms, and rules in a drawing."""

import html
import os

HERE = os.path.dirname(os.path.abspath(__file__))
PAPER = 'fill="#f7f1e1"'


def save(name, width, height, body, metadata=""):
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:rinceau="urn:rinceau:1" '
        f'width="{width}" height="{height}" viewBox="0 0 {width} {height}">\n{metadata}{body}\n</svg>\n'
    )
    with open(os.path.join(HERE, name + ".svg"), "w", encoding="utf-8") as out:
        out.write(text)


def carried(name, rules):
    """Metadata with growth rules."""
    return f'<metadata><rinceau:rules name="{name}">\n{html.escape(rules, quote=False)}</rinceau:rules></metadata>\n'


def panel(ident, d, **attributes):
    extra = "".join(f' rinceau:{name.replace("_", "-")}="{value}"' for name, value in attributes.items())
    return f'<path id="{ident}" class="rinceau-container"{extra} {PAPER} fill-rule="evenodd" d="{d}"/>'


def ring(cx, cy, outer, inner):
    def circle(r):
        return f"M{cx - r},{cy}A{r},{r} 0 1 1 {cx + r},{cy}A{r},{r} 0 1 1 {cx - r},{cy}Z"

    return circle(outer) + circle(inner)


def arch(x, y, width, height, thick):
    r, s = width / 2, width / 2 - thick
    right, bottom = x + width, y + height
    return (
        f"M{x},{bottom}V{y + r}A{r},{r} 0 0 1 {right},{y + r}V{bottom}H{right - thick}V{y + r}"
        f"A{s},{s} 0 0 0 {x + thick},{y + r}V{bottom}Z"
    )


def letter_r(x, y):
    """A bold R, 240 wide and 300 high."""
    return (
        f"M{x},{y}H{x + 140}C{x + 215},{y} {x + 235},{y + 45} {x + 235},{y + 88}"
        f"C{x + 235},{y + 130} {x + 205},{y + 160} {x + 170},{y + 168}L{x + 240},{y + 300}H{x + 150}"
        f"L{x + 90},{y + 178}V{y + 300}H{x}Z"
        f"M{x + 90},{y + 66}V{y + 116}H{x + 120}C{x + 142},{y + 116} {x + 150},{y + 108} {x + 150},{y + 91}"
        f"C{x + 150},{y + 74} {x + 142},{y + 66} {x + 120},{y + 66}Z"
    )


def heart(x, y, s):
    def p(a, b):
        return f"{x + a * s:.2f},{y + b * s:.2f}"

    return (
        f"M{p(150, 285)}C{p(30, 195)} {p(0, 145)} {p(0, 90)}C{p(0, 40)} {p(36, 8)} {p(78, 8)}"
        f"C{p(112, 8)} {p(138, 28)} {p(150, 58)}C{p(162, 28)} {p(188, 8)} {p(222, 8)}"
        f"C{p(264, 8)} {p(300, 40)} {p(300, 90)}C{p(300, 145)} {p(270, 195)} {p(150, 285)}Z"
    )


PATTERNS = ["spiral", "vines", "vase", "willow", "willow-planned", "flower", "dots"]


def patterns():
    """Three panels for each pattern."""
    for name in PATTERNS:
        start = {"dots": ["lower-left", "lower-left", "middle"]}.get(name, ["middle"] * 3)
        panels = [
            panel("arch", arch(20, 20, 300, 300, 90), rules=name, start=start[0]),
            panel("letter", letter_r(365, 20), rules=name, start=start[1]),
            panel("ring", ring(800, 170, 150, 55), rules=name, start=start[2]),
        ]
        save(name, 970, 340, "\n".join(panels))


def overview():
    """All patterns beside each other, for the dialog."""
    body = []
    for i, name in enumerate(PATTERNS):
        x, y = 10 + (i % 4) * 160, 10 + (i // 4) * 180
        body.append(panel(name, f"M{x},{y}h150v150h-150Z", rules=name, rule_unit="2.2"))
        body.append(
            f'<text x="{x + 75}" y="{y + 165}" style="font:13px sans-serif" text-anchor="middle">{name}</text>'
        )
    save("patterns", 650, 370, "\n".join(body))


def symmetric():
    save("rosette", 420, 420, panel("disc", "M10,210A200,200 0 1 1 410,210A200,200 0 1 1 10,210Z", symmetry="d6", rule_unit="5"))
    save("turned", 420, 420, panel("disc", "M10,210A200,200 0 1 1 410,210A200,200 0 1 1 10,210Z", symmetry="c6", rules="vines"))
    save("mirrored", 420, 400, panel("heart", heart(20, 20, 1.27), symmetry="mirror", rules="vines"))
    save("band", 840, 120, panel("band", "M0,0H840V120H0Z", symmetry="pma2", repeats=3, rules="vines"))
    save("wallpaper", 480, 480, panel("tile", "M0,0H480V480H0Z", symmetry="p4g", repeats=2, rule_unit="2.4"))
    tall = 480 * 3**0.5 / 2
    save(
        "wallpaper-hexagonal",
        480,
        round(tall, 4),
        panel("tile", f"M0,0H480V{tall:.4f}H0Z", symmetry="p6", repeats=2, rule_unit="2.4", rules="vines"),
    )


def border():
    """A page border whose corners are its start."""
    d = "M10,10H410V570H10ZM70,70V510H350V70Z"
    save("border", 420, 580, panel("frame", d, start="corners", symmetry="d2"))


def styles():
    """One design, several strokes (000 Figure 17)."""
    body = []
    for i, style in enumerate(["drawn", "brush", "ribbon", "rope", "leafy", "acanthus"]):
        x, y = 10 + (i % 3) * 250, 10 + (i // 3) * 250
        body.append(panel(style, f"M{x},{y}h240v240h-240Z", style=style, rule_unit="4.2"))
    save("styles", 770, 510, "\n".join(body))


SCROLL = """
fn foot(line, place) {
    let best = 0.0;
    let least = 1e9;
    let k = 0;
    while k <= 8 {
        let d = distance(line.at(k / 8.0), place);
        if d < least { least = d; best = k / 8.0; }
        k += 1;
    }
    best
}

fn scroll(from, center, hand, width) {
    let step = PI() / 4.0;
    let shrink = 0.885;
    let radius = distance(from, center);
    let spoke = from - center;
    let pitch = atan(-ln(shrink) / step);
    let at = from;
    let whole = radius;
    while radius > max(0.8, 0.16 * whole) {
        let next = spoke + hand * step;
        let to = center.offset(next, radius * shrink);
        let piece = add("arm");
        piece.set(at, spoke + hand * (PI() / 2.0 + pitch), 0.347, to, next + hand * (PI() / 2.0 + pitch), 0.347);
        piece.hand = hand;
        piece.width = width * (0.3 + 0.7 * radius / whole);
        at = to;
        spoke = next;
        radius *= shrink;
    }
}
"""


def targets():
    """Vines that grow towards blossoms which stand where they are."""
    body = [panel("garden", heart(20, 20, 1.3), rules="deliver")]
    for i, (x, y) in enumerate([(120, 130), (310, 130), (215, 215), (215, 320)]):
        petals = "".join(
            f'<ellipse cx="0" cy="-13" rx="8" ry="12" transform="rotate({k * 60})" fill="#b4482f"/>' for k in range(6)
        )
        body.append(
            f'<g id="rose{i + 1}" class="rinceau-fixed" transform="translate({x} {y})">{petals}'
            '<circle r="7" fill="#dd9a3c"/></g>'
        )
    rules = """// Branches seek the nearest fixed blossom that none has reached yet; spirals fill the rest.
smallest 1.2
element seed: point
element branch: bezier, hand = 1
element arm: bezier, hand = 1, width = 1.0

let reached = [];

@SCROLL@
// The blossom nearest to a place that is still alone.
fn seek(from, reached) {
    let least = 1e9;
    let found = ();
    for place in targets() {
        let is_new = true;
        for known in reached { if distance(known, place.center) < 0.5 { is_new = false; } }
        let d = distance(from, place.center);
        if is_new && d < least { least = d; found = place; }
    }
    found
}

rule seed -> {
    let to = seek(parent.center, reached);
    if type_of(to) == "()" { parent.sterile = true; return FAILURE; }
    let towards = to.center - parent.center;
    let end = to.center.offset(towards, -(to.radius + 2.2));
    let hand = if reached.len() % 2 == 0 { 1 } else { -1 };
    let branch = add("branch");
    branch.set(parent.center, towards + 0.7 * hand, 0.4, end, towards - 0.5 * hand, 0.4);
    branch.hand = hand;
    reached.push(to.center);
}

// On from a blossom that is reached to the next.
rule branch -> branch next {
    delivered(parent, next, seek(goal.center, reached)) && { reached.push(seek(goal.center, reached).center); true }
}
rule arm -> branch next {
    delivered(parent, next, seek(goal.center, reached)) && { reached.push(seek(goal.center, reached).center); true }
}

// A stem from a line to a blossom's rim, if one can be seen from there.
fn delivered(line, next, to) {
    if type_of(to) == "()" { return false; }
    let t = foot(line, to.center);
    let from = line.at(t);
    if distance(from, to.center) > 40.0 { return false; }
    let towards = to.center - from;
    let along = line.tangent(t);
    let turn = if along.cross(towards) > 0.0 { -0.8 } else { 0.8 };
    let end = to.center.offset(towards, -(to.radius + 2.2));
    next.set(from, towards + turn, 0.4, end, towards - turn * 0.6, 0.4);
    next.hand = -line.hand;
    clearance(next, 0.6) > 0.5
}

rule branch -> {
    if goal.radius < 2.2 { return FAILURE; }
    let t = foot(parent, goal.center);
    let from = parent.at(t);
    let hand = if parent.tangent(t).cross(goal.center - from) > 0.0 { 1 } else { -1 };
    let size = min(min(distance(from, goal.center), goal.radius), 14.0);
    scroll(from, from.offset(goal.center - from, size), hand, min(1.2, 0.4 + size / 14.0));
}

rule arm -> {
    if goal.radius < 2.2 { return FAILURE; }
    let t = foot(parent, goal.center);
    let from = parent.at(t);
    let hand = if parent.tangent(t).cross(goal.center - from) > 0.0 { 1 } else { -1 };
    if hand == parent.hand && goal.radius > 3.0 { return FAILURE; }
    let size = min(min(distance(from, goal.center), goal.radius), 14.0);
    let width = 0.4 + size / 14.0;
    scroll(from, from.offset(goal.center - from, size), hand, min(width, max(parent.width, 0.7 * width)));
}

look arm: art stem, width 1.2, thick width, join
look branch: art vine, width 1.5
"""
    rules = rules.replace("@SCROLL@", SCROLL.strip())
    metadata = carried("deliver", rules)
    seed = '<circle id="start" class="rinceau-seed" cx="215" cy="268" r="2" fill="none"/>'
    save("targets", 430, 410, "\n".join(body + [seed]), metadata)


SCROLLS = (
    SCROLL
    + """
rule arm -> {
    if goal.radius < 2.0 { return FAILURE; }
    let t = foot(parent, goal.center);
    let from = parent.at(t);
    let hand = if parent.tangent(t).cross(goal.center - from) > 0.0 { 1 } else { -1 };
    if hand == parent.hand && goal.radius > 3.0 { return FAILURE; }
    let size = min(min(distance(from, goal.center), goal.radius), 14.0);
    let width = 0.4 + size / 14.0;
    scroll(from, from.offset(goal.center - from, size), hand, min(width, max(parent.width, 0.7 * width)));
}
"""
)


def corners():
    """A frame with a blossom of its own for every corner, and scrolls that leave them."""
    rules = (
        """// Corners first (000 2.1.3): a blossom in each, as large as fits, then scrolls from blossom to blossom.
smallest 1.1
element seed: point
element rose: circle
element arm: bezier, hand = 1, width = 1.0

rule seed -> {
    parent.sterile = true;
    for corner in corners() {
        // The outer corners of the frame are where the way inside stays inside for longest.
        let size = 8.0;
        let at = corner.at.offset(corner.inwards, size * 1.52);
        if boundary_distance(at) < size * 1.02 { continue; }
        let rose = add("rose");
        rose.set(at, size);
    }
}

rule rose -> {
    if goal.radius < 2.0 { return FAILURE; }
    let towards = goal.center - parent.center;
    let from = parent.center.offset(towards, parent.radius);
    let size = min(goal.radius, 14.0);
    let hand = if parent.children % 2 == 0 { 1 } else { -1 };
    scroll(from, from.offset(towards, size), hand, 0.4 + size / 14.0);
}
"""
        + SCROLLS
        + """
look arm: art stem, width 1.2, thick width, join
look rose: art peony
"""
    )
    metadata = carried("corners", rules)
    d = "M10,10H410V570H10ZM90,90V490H330V90Z"
    seed = '<circle id="start" class="rinceau-seed" cx="210" cy="50" r="2" fill="none"/>'
    save("corners", 420, 580, panel("frame", d, rules="corners") + "\n" + seed, metadata)


def half_open():
    """A border that keeps to three sides and fades into the page (000 1.1, Figure 2b)."""
    rules = (
        """// Close at the left and at the ends, open to the right: growth goes no farther than a wavy line.
smallest 1.1
element seed: point
element arm: bezier, hand = 1, width = 1.0

fn is_open(place) {
    let p = panel();
    let across = (place.x - p.left) / p.width;
    let along = (place.y - p.top) / p.height;
    // Far into the page at both ends, narrow in between.
    across > 0.24 + 0.6 * pow((2.0 * along - 1.0).abs(), 3.0) + 0.05 * sin(along * 40.0)
}

rule seed -> {
    parent.sterile = true;
    scroll(parent.center, parent.center.offset(0.3, 9.0), 1, 1.3);
}
"""
        + SCROLLS.replace(
            "    if goal.radius < 2.0 { return FAILURE; }\n    let t", "    if goal.radius < 1.6 || is_open(goal.center) { return FAILURE; }\n    let t"
        )
        + """
look arm: art stem, width 1.2, thick width, join
"""
    )
    metadata = carried("half-open", rules)
    seed = '<circle id="start" class="rinceau-seed" cx="45" cy="290" r="2" fill="none"/>'
    save("half-open", 420, 580, panel("page", "M10,10H410V570H10Z", rules="half-open") + "\n" + seed, metadata)


def half_open_band():
    """A band that is closed below, fades above, and repeats without a seam: the edge of its growth is
    a wave with a whole number of periods."""
    rules = (
        """// Closed below, open above; as wide as the shape, the band repeats.
smallest 1.0
element seed: point
element arm: bezier, hand = 1, width = 1.0

fn is_open(place) {
    let p = panel();
    let along = (place.x - p.left) / p.width;
    let up = (p.bottom - place.y) / p.height;
    up > 0.5 + 0.26 * cos(6.0 * PI() * along)
}

rule seed -> {
    parent.sterile = true;
    scroll(parent.center, parent.center.offset(-1.1, 17.0), 1, 1.5);
}
"""
        + SCROLLS.replace(
            "    if goal.radius < 2.0 { return FAILURE; }\n    let t", "    if goal.radius < 1.4 || is_open(goal.center) { return FAILURE; }\n    let t"
        )
        + """
look arm: art stem, width 1.2, thick width, join
"""
    )
    metadata = carried("half-open-band", rules)
    seed = '<circle id="start" class="rinceau-seed" cx="197" cy="121" r="2" fill="none"/>'
    band = panel("edge", "M0,0H660V130H0Z", rules="half-open-band", symmetry="p111", repeats=3, rule_unit=2.6)
    save("half-open-band", 660, 130, band + "\n" + seed, metadata)


def frame():
    """A frame whose sides repeat and whose corners are solved."""
    d = "M10,10H650V490H10ZM90,90V410H570V90Z"
    save("frame", 660, 500, panel("frame", d, rules="vines", symmetry="frame", repeats=3, rule_unit=2.8))


def half_open_frame():
    """A border that is closed outside and open inside, repeats along its sides, and has a blossom of its
    own for every corner (000 1.1, 2.1.3)."""
    rules = (
        """// In a frame: closed outside, fading inside, a blossom in the corners.
smallest 1.0
element seed: point
element rose: circle
element arm: bezier, hand = 1, width = 1.0

// Scallops: deep in the middle of each module, shallow where two meet and at the corners.
fn is_open(place) {
    let p = panel();
    let along = (place.x - p.left) / p.width;
    let depth = (place.y - p.top) / p.height;
    if p.section == "corner" { return max(along, depth) > 0.68 && min(along, depth) > 0.6; }
    depth > 0.66 - 0.26 * cos(2.0 * PI() * along)
}

rule seed -> {
    parent.sterile = true;
    let p = panel();
    if p.section == "corner" {
        let rose = add("rose");
        let r = 0.26 * p.height;
        rose.set(p.center.offset(-PI() * 0.75, 0.16 * p.height), r);
    } else {
        let from = parent.center;
        scroll(from, from.offset(-PI() / 2.0, 0.2 * p.height), 1, 1.3);
    }
}

rule rose -> {
    if goal.radius < 1.6 || is_open(goal.center) { return FAILURE; }
    let towards = goal.center - parent.center;
    let from = parent.center.offset(towards, parent.radius);
    let size = min(goal.radius, 14.0);
    let hand = if parent.children % 2 == 0 { 1 } else { -1 };
    scroll(from, from.offset(towards, size), hand, 0.4 + size / 14.0);
}
"""
        + SCROLLS.replace(
            "    if goal.radius < 2.0 { return FAILURE; }\n    let t", "    if goal.radius < 1.4 || is_open(goal.center) { return FAILURE; }\n    let t"
        )
        + """
look arm: art stem, width 1.2, thick width, join
look rose: art peony
"""
    )
    d = "M10,10H650V430H10ZM110,110V330H550V110Z"
    frame = panel("page", d, rules="half-open-frame", symmetry="frame", repeats=2, rule_unit=2.6)
    save("half-open-frame", 660, 440, frame, carried("half-open-frame", rules))


def drawn():
    """The drawing's own blossom and leaf for the elements of a pattern."""
    body = [
        panel("panel", "M10,10H410V410H10Z", rules="flower"),
        '<g id="tulip" class="rinceau-element" rinceau:symbol="flower" transform="translate(450 60)">'
        '<path d="M0,0C-18,-26 14,-34 34,-26C28,-18 30,-12 44,-9C32,-4 32,4 44,9C30,12 28,18 34,26C14,34 -18,26 0,0Z" fill="#7b3f72"/>'
        '<circle cx="8" cy="0" r="6" fill="#cf7f86"/><path class="rinceau-spine" d="M0,0H44" fill="none"/></g>',
        '<g id="blade" class="rinceau-element" rinceau:symbol="leaf" transform="translate(450 140)">'
        '<path d="M0,0C14,-14 34,-12 50,0C34,12 14,14 0,0Z" fill="#5c7a3a"/><path class="rinceau-spine" d="M0,0H50" fill="none"/></g>',
    ]
    save("drawn", 520, 420, "\n".join(body))


if __name__ == "__main__":
    patterns()
    overview()
    symmetric()
    border()
    styles()
    targets()
    corners()
    half_open()
    half_open_band()
    frame()
    half_open_frame()
    drawn()
