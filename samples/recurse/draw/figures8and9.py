"""Variations on Hilbert's curve, squigs and their reptile (Figures 8 and 9 of Carlson and
Woodbury 1990), and more curves, tilings and grammars of forms."""

import math

from common import (MOTIF, clone, form, mirror, move, number, points, polygon, scale, shape, similar, turn,
                    write)

PAPER = "of Carlson and Woodbury 1990"
LAGOON = ("#14444f", "#2f7f79", "#d2913a")
EMBER = ("#6d1f2b", "#b4482f", "#dd9a3c")
MEADOW = ("#24452f", "#5c7a3a", "#c2a54a")
DUSK = ("#2b2a5a", "#7b3f72", "#cf7f86")
PALE = "#f1ddb8"


def line(d, colour, width, **more):
    """A line with round ends and corners."""
    return shape(d, fill="none", stroke=colour, stroke_width=width, stroke_linecap="round",
                 stroke_linejoin="round", **more)


def pen(width, *box):
    """The width in the form's units of a line that is this wide on the page; `box` is the size of
    the motif's box. For strokes that stay as they are drawn."""
    return width * max(box) / MOTIF[2]


def tile(d, fill, stroke, width, **more):
    """A filled shape with an edge."""
    return shape(d, fill=fill, stroke=stroke, stroke_width=width, stroke_linecap="round",
                 stroke_linejoin="round", **more)


def dist(p, q):
    return math.hypot(q[0] - p[0], q[1] - p[1])


def cross(p, q, r):
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def between(p, q, share):
    return (p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]))


def corner_at(degrees, distance=1.0):
    return turn(degrees)((distance, 0))


def petal(length, width, start=0.0):
    """A pointed petal along the way up, from `start` to `start + length`."""
    y, z, w = -start, -start - length, width / 2
    low, high = number(y - length / 5), number(z + length / 3)
    y, z, right, left = number(y), number(z), number(w), number(-w)
    return f"M0,{y} C{right},{low} {right},{high} 0,{z} C{left},{high} {left},{low} 0,{y} Z"


def circle(x, y, r):
    x0, x1, y, r = number(x - r), number(x + r), number(y), number(r)
    return f"M{x0},{y} A{r},{r} 0 0 1 {x1},{y} A{r},{r} 0 0 1 {x0},{y} Z"


def turned(d, degrees):
    return mapped(d, turn(degrees))


def moved(d, x, y):
    return mapped(d, move(x, y))


def mapped(d, by):
    """Path data of Bezier curves under an affine map."""
    out = []
    for word in d.replace("M", "M ").replace("C", "C ").split():
        if "," in word:
            x, y = by(tuple(map(float, word.split(","))))
            word = f"{number(x)},{number(y)}"
        out.append(word)
    return " ".join(out)


# Figure 8. Hilbert's motif fills the square from -2 to 2; its vertices are at -1 and 1.

VERTICES = ((-1, 1), (-1, -1), (1, -1), (1, 1))


def hilbert():
    """Half-size clones centred at the vertices. The outer two are mirrored in a diagonal, so that
    the ends of the copies meet their neighbours."""
    across = (mirror((-1, 1), (1, -1)), None, None, mirror((-1, -1), (1, 1)))
    clones = []
    for vertex, flip in zip(VERTICES, across):
        centred = move(*vertex) @ scale(0.5)
        clones.append(clone(centred @ flip if flip else centred))
    return clones


def hilbert_sample(name, title, text, motif, depth, box=(-2, -2, 4, 4), **more):
    write(name, title, f"{text} After Figure 8{name[5]} {PAPER}.",
          form("hilbert", motif + hilbert(), depth=depth, generations="last", **more), fit=box)


def paisley(dark, light):
    """A drop with a curled tip: it is like none of its turned or mirrored copies. The white edge
    keeps copies apart that lie on each other."""
    body = ("M1.05,-1.75 C0.1,-1.8 -1.27,-0.95 -1.27,0.5 C-1.27,1.27 -0.7,1.8 0,1.8 "
            "C0.75,1.8 1.27,1.27 1.27,0.56 C1.27,-0.22 0.6,-0.5 0.46,-0.97 C0.34,-1.3 0.56,-1.6 1.05,-1.75 Z")
    heart = ("M-0.14,-0.58 C-0.48,-0.34 -0.66,0.05 -0.66,0.5 C-0.66,0.92 -0.37,1.2 0,1.2 "
             "C0.38,1.2 0.66,0.92 0.66,0.56 C0.66,0.14 0.06,-0.11 -0.14,-0.58 Z")
    return [shape(f"{body} {heart}", fill=dark, fill_rule="evenodd", stroke="#ffffff", stroke_width=0.12,
                  stroke_linejoin="round", paint_order="stroke"),
            shape(heart, fill=light)]


def parallelogram(x, y):
    """Corners of one with sides (4, 0) and (2, 2) about a centre."""
    return ((x - 3, y - 1), (x + 1, y - 1), (x + 3, y + 1), (x - 1, y + 1))


def figure8():
    dark, middle, light = LAGOON
    hilbert_sample("fig8-a-hilbert", "Hilbert's motif",
                   "An inverted U with half-size clones centred at its vertices; the last generation.",
                   [line(points(*VERTICES), dark, pen(3.2, 4, 4))], 5, strokes="fixed")
    hilbert_sample("fig8-b-hilbert-joined", "Hilbert's curve",
                   "The same copies joined in drawing order: one line from corner to corner.",
                   [line(points(*VERTICES), dark, pen(2.4, 4, 4))], 6, strokes="fixed", join="all")
    hilbert_sample("fig8-c-orientations", "Which way the copies are turned",
                   "A drop with a curled tip in place of the U shows how each copy is turned or mirrored.",
                   paisley(dark, light), 4)
    hilbert_sample("fig8-d-regions", "Regions of Hilbert's form",
                   "A vertical line at the side of the square: the copies join to paths that bound regions.",
                   [line(points((2, -2), (2, 2)), dark, pen(2.6, 5, 5))], 6, box=(-2.5, -2.5, 5, 5),
                   strokes="fixed")
    hilbert_sample("fig8-e-parallelogram", "Branching paths",
                   "A parallelogram that reaches over both sides of its square: branching paths across "
                   "the bounds of the regions.",
                   [tile(polygon(*parallelogram(0, 0)), light, dark, pen(1.9, 6.4, 5))], 5,
                   box=(-3.2, -2.5, 6.4, 5), strokes="fixed")
    corners = parallelogram(0, 2)
    slanted = (corners[1], corners[0], corners[3], corners[2])
    hilbert_sample("fig8-f-impossible", "An impossible frame",
                   "Three sides of the parallelogram, moved down by half a square: beams that no "
                   "carpenter can build.",
                   [tile(points(*slanted), PALE, dark, pen(3.4, 6.4, 6.4))], 4, box=(-3.2, -2.4, 6.4, 6.4),
                   strokes="fixed")


# Figure 9. Paths of three segments over a square grid, from START to END. The lengths of the
# segments are the roots of 2, 1 and 1, and that from end to end is the root of their sum 4: so the
# areas of three clones laid on the segments add up to that of the whole.

START, END = (0, 0), (2, 0)
HOOK = (START, (1, -1), (1, 0), END)
# The hook with its last two segments mirrored in the axis through their outer ends.
BOW = (START, (1, -1), (2, -1), END)
# Of the 64 squigs of the bow this one fills a plane and nowhere meets itself.
FILLING = (2, 0, 0)


def laid(segment, way):
    """One of the four ways to lay a path on a segment: 0 as it is, 1 mirrored in the segment, 2
    the other way round, 3 both."""
    p, q = reversed(segment) if way & 2 else segment
    return similar(START, END, p, q, mirrored=bool(way & 1))


def squig(path, ways, of=None):
    """Clones of a path on the segments of another or of itself."""
    return [clone(laid(segment, way), of) for segment, way in zip(zip(path, path[1:]), ways)]


def spirals(turns):
    """The two edges of the area that the curve fills, from START to END. Both ends are spirals,
    whose corners go half as near with each quarter turn; `turns` corners are drawn of each."""
    def spiral(centre, corner):
        x, y = corner[0] - centre[0], corner[1] - centre[1]
        corners = []
        for _ in range(turns):
            corners.append((centre[0] + x, centre[1] + y))
            x, y = -y / 2, x / 2
        return corners
    # A corner that both spirals of an edge have is said by one of them.
    return (spiral(START, (0, -1))[::-1] + spiral(END, (2, -2)),
            spiral(START, (1, 1))[:0:-1] + spiral(END, (1, 1)))


def reptile():
    """That area. The whole has an area of 5, its three parts 5/2, 5/4 and 5/4."""
    upper, lower = spirals(12)
    return polygon(*upper, *lower[::-1])


SQUIG_BOX = (-0.5, -2, 3.5, 3)


def figure9():
    dark, middle, light = LAGOON

    def sample(name, title, text, forms, box):
        write(name, title, f"{text} After Figure 9{name[5]} {PAPER}.", *forms, fit=box)

    sample("fig9-a-motif", "Three segments",
           "A path of three segments through points of a square grid.",
           [form("path", grid() + [line(points(*HOOK), dark, pen(5, 2.6, 2.6))], depth=1, strokes="fixed")],
           (-0.3, -1.8, 2.6, 2.6))
    sample("fig9-b-squig", "A squig",
           "Clones of the path laid on its segments, over and over; the last generation. Each clone "
           "can be laid in four ways, so there are 64 of these squigs.",
           [form("path", [line(points(*HOOK), dark, pen(3.6, 3, 3))] + squig(HOOK, (3, 0, 1)), depth=12,
                 generations="last", strokes="fixed", min_size=34, join="touching")],
           (-0.5, -2, 3, 3))
    sample("fig9-c-curve", "An awkward curve that fills an area",
           "The same path, its last two clones laid on the mirror image of its last two segments: "
           "the curve fills an area with an unusual boundary.",
           [form("path", [line(points(*HOOK), dark, pen(2.4, 3.5, 3))] + squig(BOW, FILLING), depth=12,
                 generations="last", strokes="fixed", min_size=16, join="touching")], SQUIG_BOX)
    sample("fig9-d-elegant", "An elegant curve that fills the same area",
           "The last two segments of the path mirrored in the axis through their outer ends: a single "
           "line that never meets itself.",
           [form("path", [line(points(*BOW), dark, pen(3.2, 3.5, 3))] + squig(BOW, FILLING), depth=12,
                 generations="last", strokes="fixed", min_size=16, join="touching")], SQUIG_BOX)
    figure9e()


def grid():
    """The square grid behind the path."""
    lines = [points((x, -1), (x, 0)) for x in range(3)] + [points((0, y), (2, y)) for y in (-1, 0)]
    return [line(" ".join(lines), PALE, pen(2, 2.6, 2.6))]


def figure9e():
    """Each tone is a form; all of them go on in the same way. The white lines stop before they
    would fill the inside of the spirals."""
    edges = " ".join(points(*edge) for edge in spirals(5))
    names = ("dark", "middle", "light")
    forms = [form("reptile", [clone(m[1], name) for m, name in zip(squig(BOW, FILLING), names)], depth=4)]
    for name, colour in zip(names, LAGOON):
        forms.append(form(name, [shape(reptile(), fill=colour)] + squig(BOW, FILLING, name)
                          + [line(edges, "#ffffff", 0.04)]))
    write("fig9-e-reptile", "A reptile",
          "The area that the curve fills is made of three smaller copies of itself, each of three "
          f"again. After Figure 9e {PAPER}.", *forms, fit=SQUIG_BOX)


# Curves in one line. A clone that is laid the other way round is drawn backwards, so that each
# piece begins where the one before ends. The corners are cut off: those between two pieces by
# the straight lines that join them.

def cut_corners(path, cut=0.3):
    corners = []
    for p, q in zip(path, path[1:]):
        corners += [between(p, q, cut), between(p, q, 1 - cut)]
    return points(*corners)


def dragon():
    """Each segment becomes two sides of a square corner, to the left in one form, to the right in
    the other."""
    start, end = (0, 0), (1, 0)
    forms = []
    for name, side in (("left", -0.5), ("right", 0.5)):
        corner = (0.5, side)
        forms.append(form(name, [
            line(cut_corners((start, corner, end), 0.36), EMBER[0], pen(2.4, 1.4, 1.4)),
            clone(similar(start, end, start, corner), "left"),
            clone(similar(start, end, corner, end), "right")],
            depth=10, generations="last", strokes="fixed", join="all"))
    write("dragon", "Heighway's dragon",
          "A strip of paper, folded in half ten times and opened to right angles: one line that "
          "never meets itself.", *forms, fit=(-0.1, -0.35, 1.2, 0.7))


def gosper():
    """Seven segments on a grid of triangles, four of them laid as they are, three the other way
    round."""
    headings = (0, -60, -180, -120, 0, 0, 60)
    backwards = (False, True, True, False, False, False, True)
    path = [(0, 0)]
    for heading in headings:
        step = corner_at(heading)
        path.append((path[-1][0] + step[0], path[-1][1] + step[1]))
    level = similar(path[0], path[-1], (0, 0), (1, 0))
    path = [level(corner) for corner in path]
    ends = path[0], path[-1]
    there = [(segment[::-1] if back else segment, "back" if back else "there")
             for segment, back in zip(zip(path, path[1:]), backwards)]
    back = [(segment, "there" if name == "back" else "back") for segment, name in there[::-1]]
    forms = [form(name, [line(cut_corners(drawn), DUSK[0], pen(2.5, 1.3, 2.6))]
                  + [clone(similar(*ends, *segment), of) for segment, of in clones],
                  depth=4, generations="last", strokes="fixed", join="all")
             for name, drawn, clones in (("there", path, there), ("back", path[::-1], back))]
    write("gosper", "Gosper's flowsnake", "Seven segments in each segment: one line that fills an island.",
          *forms, fit=(-0.1, -0.9, 1.2, 1.3))


# Penrose's rhombs, each cut into two triangles. The sides are in the golden ratio.

GOLDEN = (5 ** 0.5 - 1) / 2


THIN = ((0, 0), (1, 0), corner_at(36))
THICK = ((0, 0), (1, 0), corner_at(108))


def penrose(name, title, text, depth, thin_motif, thick_motif):
    """Ten thin halves around the origin, every second one mirrored."""
    def laid_on(corners, p, q, r):
        """The similarity that takes a triangle to another."""
        return similar(corners[0], corners[1], p, q, cross(*corners) * cross(p, q, r) < 0)

    a, b, c = THIN
    p = between(a, b, GOLDEN)
    thin = [clone(laid_on(THIN, c, p, b), "thin"), clone(laid_on(THICK, p, c, a), "thick")]
    a, b, c = THICK
    p, q = between(b, a, GOLDEN), between(b, c, GOLDEN)
    thick = [clone(laid_on(THICK, q, c, a), "thick"), clone(laid_on(THICK, p, q, b), "thick"),
             clone(laid_on(THIN, q, p, a), "thin")]
    around = []
    for k in range(10):
        flip = mirror((0, 0), corner_at(18)) if k % 2 else move(0, 0)
        around.append(clone(turn(36 * k) @ flip, "thin"))
    write(name, title, text, form("sun", around, depth=depth, generations="last"),
          form("thin", thin_motif + thin), form("thick", thick_motif + thick), fit=(-1.05, -1.05, 2.1, 2.1))


def half_rhomb(corners, fill, edge):
    """Only the sides of the rhomb have lines. One in the fill's colour along the third side lets
    the halves meet without a gap."""
    first, *others = corners
    seam = between(*others, 0.09), between(*others, 0.91)
    return [shape(polygon(*corners), fill=fill),
            shape(points(*seam), fill="none", stroke=fill, stroke_width=0.03),
            line(points(others[0], first, others[1]), "#ffffff", edge)]


def arcs(corners, b_radius, c_radius):
    """Arcs about the second and the third corner, from the side of the rhomb to its diagonal."""
    a, b, c = corners
    parts = []
    for centre, other, radius in ((b, c, b_radius), (c, b, c_radius)):
        p, q = between(centre, a, radius), between(centre, other, radius / dist(b, c))
        sweep = int(cross(centre, p, q) > 0)
        # A little further than the edges, so that neighbours overlap.
        further = (1 if sweep else -1) * math.degrees(0.02 / radius)
        p, q = turn(-further, centre)(p), turn(further, centre)(q)
        r = number(radius)
        parts.append(f"M{number(p[0])},{number(p[1])} A{r},{r} 0 0 {sweep} {number(q[0])},{number(q[1])}")
    return " ".join(parts)


def penrose_tilings():
    penrose("penrose", "Penrose's rhombs",
            "Ten triangles around a point, each cut in the golden ratio into smaller ones, over and over. "
            "Two triangles make a rhomb.", 7,
            half_rhomb(THIN, LAGOON[1], 0.07), half_rhomb(THICK, LAGOON[2], 0.07))

    def banded(corners, fill, *radii):
        return [tile(polygon(*corners), fill, fill, 0.012),
                shape(arcs(corners, *radii), fill="none", stroke=DUSK[0], stroke_width=0.11)]

    # Where a thin and a thick rhomb share the side from their first to their second corners, these
    # lie at opposite ends: so the radii about the second corners add up to 1.
    penrose("penrose-bands", "Bands over Penrose's rhombs",
            "Arcs about the corners of the rhombs close to rings and to long bands.", 6,
            banded(THIN, DUSK[1], 0.2, 0.2), banded(THICK, DUSK[2], 0.8, 0.2))


# Inventions.

def snowflake_lace():
    """An arm of loops and rings with three arms on its ring; six arms make the flake. The side
    arms are so short that they stay clear of their neighbours."""
    thread, glow = "#f7eff2", DUSK[2]
    ring = -0.5
    arm = [line(petal(0.43, 0.25), thread, 0.036),
           shape(petal(0.24, 0.1, 0.09), fill=glow),
           line(circle(0, ring, 0.07), thread, 0.036)]
    arm += [shape(moved(turned(petal(0.17, 0.08, 0.1), side), 0, ring), fill=glow) for side in (-120, 120)]
    for degrees, size in ((-60, 0.37), (60, 0.37), (0, 0.6)):
        arm.append(clone(move(0, ring) @ turn(degrees) @ move(0, -0.07) @ scale(size)))
    hub = 0.14
    flake = [shape(circle(0, 0, 0.05), fill=glow), line(circle(0, 0, hub), thread, 0.036)]
    for k in range(6):
        flake += [shape(circle(*corner_at(60 * k, 0.42), 0.026), fill=glow),
                  shape(turned(petal(0.2, 0.09, 0.62), 60 * k + 30), fill=glow)]
    flake += [clone(turn(60 * k) @ move(0, -hub), "arm") for k in range(6)]
    write("snowflake-lace", "Snowflake of lace",
          "Six arms of loops and rings; every ring carries three smaller arms.",
          form("flake", flake, depth=7, min_size=15), form("arm", arm), fit=(-1.1, -1.1, 2.2, 2.2),
          background=DUSK[0])


def mixed_grammar():
    """A branch clones itself, leaves and a flower. Branches are drawn while they go on, flowers
    and buds in the last generation alone."""
    bark, leafy, gold = MEADOW
    dark, red, _ = EMBER
    stem = ("M-0.04,0 C-0.032,-0.3 -0.06,-0.6 -0.032,-1 A0.032,0.032 0 0 1 0.032,-1 "
            "C0.008,-0.6 0.045,-0.3 0.04,0 A0.04,0.04 0 0 1 -0.04,0 Z")
    branch = [shape(stem, fill=bark, generations="inner"),
              clone(move(0, -0.4) @ turn(58) @ scale(0.42), "leaf"),
              clone(move(-0.02, -0.7) @ turn(-56) @ scale(0.36), "leaf"),
              shape(petal(0.36, 0.22), fill=red, generations="last"),
              clone(move(-0.01, -0.56) @ turn(-40) @ scale(0.66)),
              clone(move(0, -0.84) @ turn(32) @ scale(0.66)),
              clone(move(0, -1) @ turn(-8) @ scale(0.8)),
              clone(move(0, -1) @ scale(0.42), "flower")]
    leaf = [shape(petal(1, 0.5), fill=leafy), line("M0,0 L0,-0.7", bark, 0.04)]
    flower = [tile(turned(petal(0.8, 0.6), 72 * k), red, dark, 0.05, generations="last") for k in range(5)]
    flower += [shape(turned(petal(0.4, 0.16), 72 * k), fill=dark, generations="last") for k in range(5)]
    flower.append(shape(circle(0, 0, 0.17), fill=gold, generations="last"))
    write("mixed-grammar", "A plant in blossom",
          "Three forms: a branch that carries branches, leaves and a flower. Flowers open in the last "
          "generation only.",
          form("branch", branch, depth=6), form("leaf", leaf), form("flower", flower),
          fit=(-0.95, -1.75, 1.9, 1.9))


def tiles():
    """Warp and weft: each square becomes two of each kind; a leaf lies along one diagonal or the
    other. The ground is drawn once below all, so that no seam can show."""
    dark, middle, light = LAGOON

    def cloth(name, other, fill, flip):
        leaf = "M0.05,0.05 A0.9,0.9 0 0 1 0.95,0.95 A0.9,0.9 0 0 1 0.05,0.05 Z"
        vein = "M0.25,0.25 L0.75,0.75"
        if flip:
            leaf = "M0.95,0.05 A0.9,0.9 0 0 1 0.05,0.95 A0.9,0.9 0 0 1 0.95,0.05 Z"
            vein = "M0.75,0.25 L0.25,0.75"
        ground = polygon((0, 0), (1, 0), (1, 1), (0, 1))
        quarters = (name, other, other, name)
        return form(name, [shape(leaf, fill=fill, generations="last"),
                           line(vein, dark, 0.05, generations="last"),
                           shape(ground, fill=dark, generations="inner")] + [
            clone(move(k % 2 / 2, k // 2 / 2) @ scale(0.5), of) for k, of in enumerate(quarters)], depth=5)

    write("tiles", "Cloth of leaves",
          "Two forms, warp and weft; each becomes two of itself and two of the other.",
          cloth("warp", "weft", light, False), cloth("weft", "warp", middle, True),
          fit=(-0.05, -0.05, 1.1, 1.1))


def sierpinski():
    """The middle triangle, a little smaller and with round corners, so that neighbours do not
    touch."""
    height = 3 ** 0.5 / 2
    corners = (0, 0), (1, 0), (0.5, -height)
    inradius, edge, gap = height / 6, 0.05, 0.012
    inner = scale(1 - (edge / 2 + gap) / inradius, about=(0.5, -height / 3))
    middle = [inner(between(p, q, 0.5)) for p, q in zip(corners, corners[1:] + corners[:1])]
    write("sierpinski", "Sierpinski's triangle",
          "The middle of every triangle; each generation has its own tone.",
          form("triangle", [tile(polygon(*middle), DUSK[0], DUSK[0], edge)]
               + [clone(scale(0.5, about=p)) for p in corners], depth=6, colours=",".join(DUSK)),
          fit=(-0.05, -0.95, 1.1, 1))


def draw():
    figure8()
    figure9()
    dragon()
    gosper()
    penrose_tilings()
    sierpinski()
    snowflake_lace()
    mixed_grammar()
    tiles()


if __name__ == "__main__":
    draw()
