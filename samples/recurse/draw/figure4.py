"""The forms of Figures 1, 3, 4 and 6 of Carlson and Woodbury 1990, and three pieces of our own."""

import math

from common import Affine, clone, form, mirror, move, number, points, polygon, scale, shape, similar, turn, write

LAGOON = ("#14444f", "#2f7f79", "#d2913a")
EMBER = ("#6d1f2b", "#b4482f", "#dd9a3c")
MEADOW = ("#24452f", "#5c7a3a", "#c2a54a")
DUSK = ("#2b2a5a", "#7b3f72", "#cf7f86")
INK = "#1c1b22"
GOLDEN = (1 + math.sqrt(5)) / 2


def ramp(colours):
    return ",".join(colours)


def fill(d, colour, **more):
    return shape(d, fill=colour, stroke="none", **more)


def line(d, colour, width, **more):
    style = {"stroke_linecap": "round", "stroke_linejoin": "round", **more}
    return shape(d, fill="none", stroke=colour, stroke_width=number(width), **style)


def at(place, turned, by, mirrored=False):
    """A copy whose origin goes to `place`, turned and scaled; mirrored in its own upright first."""
    return move(*place) @ turn(turned) @ scale(-by if mirrored else by, by)


def polar(radius, angle):
    return radius * math.cos(angle), radius * math.sin(angle)


def between(p, q, t):
    return tuple(m + t * (n - m) for m, n in zip(p, q))


def pairs(*where):
    """Points as path data."""
    return tuple(f"{number(x)} {number(y)}" for x, y in where)


def onto(corners, to):
    """The affine map that takes three corners to three others."""
    (ax, ay), (bx, by), (cx, cy) = corners
    inverse_of = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    (px, py), (qx, qy), (rx, ry) = to

    def row(p, q, r):
        x = ((q - p) * (cy - ay) - (r - p) * (by - ay)) / inverse_of
        y = ((r - p) * (bx - ax) - (q - p) * (cx - ax)) / inverse_of
        return x, y, p - x * ax - y * ay

    a, c, e = row(px, qx, rx)
    b, d, f = row(py, qy, ry)
    return Affine(a, b, c, d, e, f)


def bend(p, q, r, t):
    """A point of the quadratic curve from p to r with handle q."""
    u = 1 - t
    return tuple(u * u * a + 2 * u * t * b + t * t * c for a, b, c in zip(p, q, r))


def heading(p, q, r, t):
    """The way that curve goes there, in degrees clockwise from straight up."""
    x, y = ((1 - t) * (b - a) + t * (c - b) for a, b, c in zip(p, q, r))
    return math.degrees(math.atan2(x, -y))


def aside(point, turned, by):
    """To the right of a point, seen along a heading."""
    a = math.radians(turned)
    return point[0] + by * math.cos(a), point[1] + by * math.sin(a)


def taper(p, q, r, wide, narrow):
    """The outline of a limb about a quadratic curve: cut flat at its foot, round at its tip."""
    first, last = heading(p, q, r, 0), heading(p, q, r, 1)
    middle = (first + last) / 2
    a, b, c, d, e, f = pairs(
        aside(p, first, wide / 2), aside(q, middle, (wide + narrow) / 4), aside(r, last, narrow / 2),
        aside(r, last, -narrow / 2), aside(q, middle, -(wide + narrow) / 4), aside(p, first, -wide / 2))
    n = number(narrow / 2)
    return f"M{a} Q{b} {c} A{n} {n} 0 0 0 {d} Q{e} {f} Z"


def lance(foot, tip, wide, droop):
    """A slender leaf from its foot to its tip, bent to the right by a share of its length."""
    (x, y), (u, v) = foot, tip
    across = y - v, u - x

    def beside(t, by):
        p, q = between(foot, tip, t)
        return p + by * across[0], q + by * across[1]

    a, b, c, d, e, f = pairs(foot, beside(0.25, wide - droop), beside(0.6, wide - droop), tip,
                             beside(0.55, -wide - droop), beside(0.2, -wide * 0.8))
    return f"M{a} C{b} {c} {d} C{e} {f} {a} Z"


def oval(x, y, a, b, turned=0):
    """An ellipse."""
    p, q = ((x + s * a * math.cos(math.radians(turned)), y + s * a * math.sin(math.radians(turned))) for s in (-1, 1))
    radii = f"A{number(a)} {number(b)} {number(turned)} 0 0"
    return f"M{pairs(p)[0]} {radii} {pairs(q)[0]} {radii} {pairs(p)[0]} Z"


def rounded(where, share):
    """An open path whose corners are cut round, from a share of each side on."""
    text = "M" + pairs(where[0])[0]
    for before, corner, after in zip(where, where[1:], where[2:]):
        text += " L{} Q{} {}".format(*pairs(between(corner, before, share), corner, between(corner, after, share)))
    return text + " L" + pairs(where[-1])[0]


def smooth(where, closed=False):
    """Path data of a smooth curve through points; it goes on from where it starts with."""
    count = len(where)

    def handle(i, side):
        before, here, after = (where[j % count if closed else min(max(j, 0), count - 1)] for j in (i - 1, i, i + 1))
        return tuple(h + side * (a - b) / 6 for b, h, a in zip(before, here, after))

    text = "M" + pairs(where[0])[0]
    for i in range(count if closed else count - 1):
        to = (i + 1) % count
        text += " C" + " ".join(pairs(handle(i, 1), handle(to, -1), where[to]))
    return text + (" Z" if closed else "")


def squig(path, ways):
    """The clones of a path that takes the place of each of its own lines: laid from the line's one
    end to the other, or back, or mirrored, or both."""
    whole = path[0], path[-1]
    ends = {"on": (1, False), "back": (-1, False), "mirrored": (1, True), "back mirrored": (-1, True)}
    clones = []
    for segment, way in zip(zip(path, path[1:]), ways):
        order, mirrored = ends[way]
        clones.append(clone(similar(*whole, *segment[::order], mirrored=mirrored)))
    return clones


class View:
    """Parallel projection of space, z upwards, seen from a compass direction and a height."""

    def __init__(self, compass, height):
        a, e = math.radians(compass), math.radians(height)
        self.right = (-math.sin(a), math.cos(a), 0)
        self.down = (math.sin(e) * math.cos(a), math.sin(e) * math.sin(a), -math.cos(e))

    def __call__(self, *p):
        return tuple(sum(m * n for m, n in zip(axis, p)) for axis in (self.right, self.down))

    def face(self, *corners):
        return polygon(*(self(*corner) for corner in corners))

    def copy(self, by, *to):
        """A copy of a solid, scaled about the origin and carried there."""
        return move(*self(*to)) @ scale(by)


def figure_1():
    p, q, r = (0, 0), (0.07, -0.5), (0, -1)
    wide, leader = 0.13, 0.74
    limb = taper(p, q, r, wide, wide * leader)

    def limb_at(t, turned, by, mirrored=False):
        return clone(at(bend(p, q, r, t), heading(p, q, r, t) + turned, by, mirrored))

    # The leader lies over the round tip that it goes on from, so that no joint is seen.
    write("fig1-tree", "Tree, fifth generation",
          "A trunk with three clones: one goes on from its tip, two stand at its sides. "
          "After Figure 1 of Carlson and Woodbury 1990.",
          form("tree", [
              limb_at(0.48, -54, 0.52, mirrored=True),
              limb_at(0.74, 54, 0.55),
              fill(limb, MEADOW[0]),
              clone(at(r, heading(p, q, r, 0) + heading(p, q, r, 1), leader, mirrored=True)),
          ], depth=5, colours=ramp(MEADOW)),
          fit=(-0.75, -1.75, 1.5, 1.85))


def figure_3():
    view = View(34, 27)
    x_tone, y_tone, z_tone = "#2f7f79", "#14444f", "#ecd9a8"

    def face(colour, *corners):
        return shape(view.face(*corners), fill=colour, stroke=INK, stroke_width=0.012,
                     stroke_linejoin="round")

    def octant(*signs):
        return clone(view.copy(0.5, *(sign / 2 for sign in signs)))

    # From the back to the front; what would stand behind the rest altogether is left out.
    write("fig3-planes", "Intersecting planes, fourth generation",
          "Six polygons are three planes that cut each other; a clone of half the size stands in three of the "
          "eight corners. The order in which they are painted makes it solid. "
          "After Figure 3 of Carlson and Woodbury 1990.",
          form("planes", [
              face(y_tone, (-1, 0, -1), (0, 0, -1), (0, 0, 1), (-1, 0, 1)),
              face(z_tone, (-1, 0, 0), (0, 0, 0), (0, 1, 0), (-1, 1, 0)),
              octant(-1, 1, 1),
              face(x_tone, (0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)),
              face(z_tone, (0, -1, 0), (1, -1, 0), (1, 0, 0), (0, 0, 0)),
              face(y_tone, (0, 0, -1), (1, 0, -1), (1, 0, 1), (0, 0, 1)),
              octant(1, 1, -1),
              face(z_tone, (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)),
              octant(1, 1, 1),
          ], depth=4, strokes="fixed"),
          fit=(-1.4, -1.5, 2.8, 3))


def figure_6():
    # So far round that the larger square stands upright.
    path = [turn(math.degrees(math.atan(3)))(p) for p in [(0, 0), (2, 0), (3, 1), (2, 2)]]
    write("fig6-compounding", "Recursion compounds complexity",
          "Three lines, and the same three lines in the place of each: out of them come a pattern, a boundary and "
          "the play of light and dark. After Figure 6 of Carlson and Woodbury 1990.",
          form("squig", [
              line(points(*path), LAGOON[0], 0.015),
              *squig(path, ["back", "on", "on"]),
          ], depth=9, generations="last", strokes="fixed", join="touching", min_size=2),
          fit=(-2.4, -0.9, 3.8, 3.8))


def ammonite():
    whorl, ribs, mouth = 2.3, 28, math.radians(-32)
    step = math.tau / ribs
    growth = math.log(whorl) / math.tau

    def place(across, along):
        """A point of the whorl: across from its inner edge 0 to its outer edge 1, along by angle.
        Ribs run as an S, forwards where they reach the rim."""
        angle = along + 0.20 * across ** 2 - 0.075 * math.sin(math.tau * across)
        inner = 0.985 / whorl
        return polar((inner + (1 - inner) * across) * math.exp(growth * angle), mouth - angle)

    def side(along, low, high):
        return [place(low + (high - low) * k / 8, along) for k in range(9)]

    def chamber(start, end, bulge):
        """The whorl between two ribs, with a bulge of the rim."""
        rim = [place(1 + bulge * math.sin(math.pi * k / 6), start + (end - start) * k / 6) for k in range(7)]
        foot = [place(0, end + (start - end) * k / 4) for k in range(5)]
        edges = side(start, 0, 1), rim, side(end, 1, 0), foot
        return smooth(edges[0]) + "".join(" L" + smooth(edge)[1:] for edge in edges[1:]) + " Z"

    def rib(start, end, low, high):
        """A rib, round at both ends."""
        def edge(k):
            a = math.tau * k / 32
            breadth = math.copysign(math.sqrt(abs(math.sin(a))), math.sin(a)) / 2
            return place((low + high - (high - low) * math.cos(a)) / 2, (start + end + (end - start) * 2 * breadth) / 2)

        return smooth([edge(k) for k in range(32)], closed=True)

    # The larger rib lies over the smaller, so that no seam is seen; the last is a dot.
    write("fig4-a-ammonite", "Ammonite",
          "One rib of a shell, and one clone of it, smaller and further round. "
          "After Figure 4a of Carlson and Woodbury 1990.",
          form("ammonite", [
              clone(turn(math.degrees(step)) @ scale(math.exp(-growth * step))),
              fill(chamber(-1.2 * step, 0, 0.05), EMBER[0]),
              fill(rib(-1.05 * step, -0.35 * step, 0.02, 1.01), EMBER[1]),
              fill(rib(-0.88 * step, -0.5 * step, 0.1, 0.97), EMBER[2]),
          ], depth=230),
          fit=(-0.2, -1, 1.2, 1.2))


def arches():
    view = View(38, 25)
    half, high, wall, slab, ledge = 0.5, 1.0, 0.17, 0.12, 0.04
    # The opening: half its width, and how high its arch springs from.
    wide, spring = 0.27, 0.46
    left, right, light, shade, deep = "#7b3f72", "#2b2a5a", "#e9c3bf", "#57376b", "#1d1c40"

    def arc(radius):
        return [(radius * math.cos(a), spring + radius * math.sin(a)) for a in (math.pi * k / 36 for k in range(37))]

    opening = [(wide, 0), *arc(wide), (-wide, 0)]

    def put(axis, depth, points):
        """Points of an upright wall, square to the x axis or to the y axis."""
        return [view(depth, u, v) if axis == "x" else view(u, depth, v) for u, v in points]

    def front(axis, depth, out, height, colour):
        wall_outline = [(-out, 0), (out, 0), (out, height), (-out, height)]
        d = polygon(*put(axis, depth, wall_outline)) + " " + polygon(*put(axis, depth, opening))
        return fill(d, colour, fill_rule="evenodd")

    def reveal(axis, near, far, colour):
        """The thickness of a wall inside its opening, where it is turned to the eye."""
        a, b = put(axis, near, opening), put(axis, far, opening)

        def faces_eye(i):
            (p, q), (r, s), (t, u) = a[i], a[i + 1], b[i]
            return ((r - p) * (u - q) - (s - q) * (t - p) > 0) == (axis == "y")

        seen = [i for i in range(len(a) - 1) if faces_eye(i)]
        first, last = seen[0], seen[-1] + 1
        return fill(polygon(*a[first:last + 1], *b[first:last + 1][::-1]), colour)

    def band(axis, depth, colour):
        return fill(polygon(*put(axis, depth, arc(wide + 0.03) + arc(wide + 0.075)[::-1])), colour)

    inner, top, out = half - wall, high - slab, half + ledge
    box = [(-out, top), (out, top), (out, high), (-out, high)]
    over = [(out, -out, top), (out, out, top), (-out, out, top),
            (-out, out, high), (-out, -out, high), (out, -out, high)]
    size = 0.45
    corner = half - size * out
    # The first shape stands for the whole in the picture of the clones; it is painted over.
    write("fig4-b-arches", "Arches",
          "A block with an arch in each side carries four clones of itself. "
          "After Figure 4b of Carlson and Woodbury 1990.",
          form("arches", [
              front("y", half, half, top, right),
              reveal("x", -inner, -half, shade), front("x", -inner, inner, top, shade),
              reveal("y", -inner, -half, deep), front("y", -inner, inner, top, deep),
              reveal("x", half, inner, deep), reveal("y", half, inner, shade),
              front("x", half, half, top, left), band("x", half, light),
              front("y", half, half, top, right), band("y", half, left),
              fill(view.face(*over), light),
              fill(polygon(*put("x", out, box)), "#cf7f86"), fill(polygon(*put("y", out, box)), left),
              *(clone(view.copy(size, x * corner, y * corner, high)) for x, y in ((-1, -1), (-1, 1), (1, -1), (1, 1))),
          ], depth=5),
          fit=(-0.8, -1.8, 1.6, 2.2))


def mesh():
    a, b, c = (0, 0), (1.1, 0), (0.5, 1)
    # A side and the side that meets it in one corner are parted alike, so that neighbours match.
    d, e, f = between(a, b, 0.385), between(b, c, 0.55), between(c, a, 0.385)
    middle = tuple(sum(part) / 3 for part in zip(a, b, c))
    halves = [between(p, q, 0.5) for p, q in ((a, b), (b, c), (c, a))]
    threads = " ".join(points(middle, half) for half in halves)
    write("fig4-c-mesh", "Mesh",
          "A triangle in four clones that fit, although none is like another. "
          "After Figure 4c of Carlson and Woodbury 1990.",
          form("mesh", [
              line(threads, LAGOON[0], 0.008),
              *(clone(onto((a, b, c), to)) for to in ((a, d, f), (d, b, e), (f, e, c), (e, d, f))),
          ], depth=6, generations="last", strokes="fixed"),
          fit=(-0.05, -0.05, 1.15, 1.1))


def meander():
    # As high as the path can be before its copies run into each other.
    path = [turn(-24)(p) for p in [(0, 0), (0.25, -0.544), (0.75, -0.544), (1, 0)]]
    ways = ["back", "back mirrored", "back mirrored"]
    clones = squig(path, ways)
    course = [path[0]]

    def wind(matrix, on, longest):
        """Goes along a copy of the path, on or back."""
        for item in clones if on else clones[::-1]:
            part = matrix @ item[1]
            ends = part(path[0]), part(path[-1])
            if math.dist(*ends) > longest:
                wind(part, not on, longest)
            else:
                course.append(ends[0] if on else ends[1])

    wind(Affine(), True, 0.25)
    write("fig4-d-meander", "Meander",
          "A winding river, and three clones of it along its three great reaches. All copies stop at one size, so "
          "that it winds evenly. After Figure 4d of Carlson and Woodbury 1990.",
          form("meander", [line(rounded(course, 0.5), LAGOON[1], 0.016), *clones],
               depth=14, generations="last", strokes="fixed", min_size=56, join="touching"),
          fit=(-0.4, -1, 1.5, 1.5))


def kawaguchiesque():
    crescent = "M-0.42,0.02 C-0.38,0.19 -0.2,0.262 0.02,0.25 C-0.18,0.205 -0.32,0.13 -0.42,0.02 Z"
    write("fig4-e-kawaguchiesque", "Kawaguchiesque",
          "A disc grows into a horn, and every disc of it bears a small horn at its side. "
          "After Figure 4e of Carlson and Woodbury 1990.",
          form("horn", [
              fill(oval(0, 0, 0.5, 0.33), DUSK[0]),
              fill(oval(0, -0.015, 0.46, 0.29), DUSK[1]),
              fill(crescent, DUSK[2]),
              clone(at((0.46, -0.02), 98, 0.17, mirrored=True)),
              clone(at((-0.015, -0.235), -12.5, 0.935)),
          ], depth=400, min_size=4),
          fit=(-0.9, -0.9, 1.8, 1.5))


def monkey_tree():
    # Six lines a third as long as the whole, and five shorter by the root of three.
    short = 1 / (3 * math.sqrt(3))
    lines = [(60, 1 / 3)] * 2 + [(0, 1 / 3), (-60, 1 / 3)] + [(150, short)] * 2 + [(210, short)] \
        + [(-90, short)] * 2 + [(0, 1 / 3)] * 2
    path = [(0, 0)]
    for heading_of, long in lines:
        x, y = polar(long, math.radians(-heading_of))
        path.append((path[-1][0] + x, path[-1][1] + y))
    ways = ["mirrored", "back mirrored", "on", "back mirrored", "back mirrored", "mirrored",
            "back", "back", "on", "back", "on"]
    write("fig4-f-monkey-tree", "Monkey tree",
          "Mandelbrot's monkeys tree: a path of eleven lines, each of which the path replaces. "
          "After Figure 4f of Carlson and Woodbury 1990.",
          form("monkeys", [fill(polygon(*path), MEADOW[0], fill_rule="evenodd"), *squig(path, ways)],
               depth=4, colours=ramp(MEADOW), min_size=16),
          fit=(-0.1, -0.8, 1.2, 1.1))


def p4_symmetry():
    large = "M0.05,0.05 C0.34,-0.01 0.86,0.06 0.93,0.66 C0.72,0.44 0.26,0.46 0.05,0.05 Z"
    vein = "M0.16,0.11 C0.4,0.12 0.72,0.2 0.86,0.52 C0.66,0.3 0.38,0.3 0.16,0.11 Z"
    small = "M0.95,0.95 C0.66,0.98 0.2,0.9 0.12,0.42 C0.32,0.62 0.74,0.6 0.95,0.95 Z"
    write("fig4-g-p4-symmetry", "p4 symmetry",
          "Two leaves in a square, and four clones about its middle, a quarter turn from one to the next. "
          "After Figure 4g of Carlson and Woodbury 1990.",
          form("p4", [
              fill(large, LAGOON[0]), fill(vein, LAGOON[1]), fill(small, LAGOON[2]),
              fill(oval(1, 0, 0.06, 0.06), LAGOON[0]), fill(oval(0, 1, 0.06, 0.06), LAGOON[0]),
              *(clone(turn(90 * k, (0.5, 0.5)) @ scale(0.5)) for k in range(4)),
          ], depth=4, generations="last"),
          fit=(-0.05, -0.05, 1.1, 1.1))


def evergreen():
    needle = "M-0.05,0 C-0.13,-0.25 -0.09,-0.7 0,-1 C0.09,-0.7 0.13,-0.25 0.05,0 Z"
    write("fig4-h-evergreen", "Evergreen",
          "A leaf in six clones: the tree above, four boughs, and the trunk, which is the tree squeezed thin. "
          "After Figure 4h of Carlson and Woodbury 1990.",
          form("evergreen", [
              fill(needle, MEADOW[0]),
              clone(scale(0.05, 0.3)),
              clone(at((0.02, -0.13), -104, 0.375)),
              clone(at((-0.02, -0.16), 105, 0.37, mirrored=True)),
              clone(at((0.015, -0.255), -95, 0.3, mirrored=True)),
              clone(at((-0.015, -0.28), 94, 0.29)),
              clone(at((0, -0.27), 0, 0.73, mirrored=True)),
          ], depth=30, generations="last", min_size=9),
          fit=(-0.5, -1.05, 1, 1.1))


def bamboo():
    nodes = [0.06, -0.35, -0.82, -1.32, -1.84, -2.34, -2.76]
    culm = []
    for foot, head in zip(nodes, nodes[1:]):
        low, high, waist, flare = foot - 0.008, head + 0.008, 0.036, 0.046
        middle = (low + high) / 2
        culm.append("M{} C{} {} {} Q{} {} C{} {} {} Q{} {} Z".format(*pairs(
            (-flare, low), (-waist, low - 0.06), (-waist, high + 0.06), (-flare, high), (0, high - 0.012),
            (flare, high), (waist, high + 0.06), (waist, low - 0.06), (flare, low), (0, low + 0.012), (-flare, low))))
    leaves = []
    sprays = ((-0.82, 1, ((66, 0.34), (104, 0.42), (140, 0.34))),
              (-1.32, -1, ((50, 0.3), (84, 0.44), (112, 0.5), (142, 0.38))),
              (-2.34, 1, ((72, 0.32), (118, 0.38))))
    for y, side, spray in sprays:
        for angle, long in spray:
            way = math.radians(angle)
            foot = side * 0.05, y - 0.01
            tip = foot[0] + side * long * math.sin(way), foot[1] - long * math.cos(way)
            leaves.append(lance(foot, tip, 0.085, -side * 0.12))
    write("fig4-i-bamboo-texture", "Bamboo texture",
          "One stem and two clones behind it, thinner and a little aside. The wood they grow into shows no rule. "
          "After Figure 4i of Carlson and Woodbury 1990.",
          form("bamboo", [
              clone(Affine(-0.78, 0.02, 0.02, 0.84, -0.48, -0.54)),
              clone(Affine(-0.68, -0.04, -0.02, 0.88, 0.56, 0.1)),
              fill(" ".join(culm + leaves), MEADOW[0]),
          ], depth=7, colours="#24452f,#5c7a3a,#c8cf9f"),
          fit=(-1.3, -2.85, 2.6, 3))


def phyllotaxis():
    golden = math.tau / GOLDEN ** 2
    # Rows of every thirteenth and of every twenty-first seed, and how far round they lead.
    short, long = 13 * golden - 5 * math.tau, 21 * golden - 8 * math.tau
    # So much smaller is each seed that the two rows cross at right angles and seeds are square.
    step = -math.sqrt(-short * long / (13 * 21))

    def seed(size, offset=0.0, count=28):
        """A round diamond between the rows, drawn in the logarithmic plane where the rows are straight."""
        def edge(k):
            a = math.tau * k / count
            u, v = (size * math.copysign(abs(w) ** 0.8, w) / 2 + offset for w in (math.cos(a), math.sin(a)))
            return polar(math.exp(step * (13 * u + 21 * v)), short * u + long * v)

        return smooth([edge(k) for k in range(count)], closed=True)

    write("fig4-j-phyllotaxis", "Phyllotaxis",
          "A seed and its clone, turned by the golden angle and a little smaller. "
          "After Figure 4j of Carlson and Woodbury 1990.",
          form("seeds", [
              fill(seed(0.98), EMBER[0]), fill(seed(0.76, 0.03), EMBER[1]), fill(seed(0.4, 0.1), EMBER[2]),
              clone(turn(math.degrees(golden)) @ scale(math.exp(step))),
          ], depth=520),
          fit=(-0.95, -0.25, 2.15, 1.1))


def bronchus():
    # At the ratio of the root of a half twigs would meet end to end; less leaves room for the stems.
    ratio, wide, arm = 0.68, 0.19, 0.24
    w, n = wide / 2, ratio * wide / 2
    under, over, seam = -1 + n, -1 - n, 0.03

    def half(side):
        """Half of the outline, up the stem to the end of an arm; clones lie over its round end."""
        return [(side * w, seam), (side * w, -0.72), (side * w, under), (side * arm, under),
                (side * arm, over), (side * arm / 2, over), (side * 0.05, over), (0, over + 0.045)]

    a, b, c, d, e, f, g, h = pairs(*half(1))
    i, j, k, l, m, o, p, _ = pairs(*half(-1))
    cap = f"A{number(n)} {number(n)} 0 0 0"
    fork = f"M{a} C{b} {c} {d} {cap} {e} C{f} {g} {h} C{p} {o} {m} {cap} {l} C{k} {j} {i} Z"
    write("fig4-k-bronchus", "Bronchus",
          "A stem that parts in two, each arm a clone at a right angle. The twigs fill their field and never meet. "
          "After Figure 4k of Carlson and Woodbury 1990.",
          form("bronchus", [
              fill(fork, EMBER[0]),
              clone(at((-arm, -1), -90, ratio)), clone(at((arm, -1), 90, ratio)),
          ], depth=10, colours=ramp(EMBER)),
          fit=(-1.1, -1.9, 2.2, 2))


def tree():
    p, q, r = (0, 0), (0, -0.5), (-0.24, -1)
    wide, leader, branch = 0.16, 0.79, 0.66
    limb = taper(p, q, r, wide, wide * leader)

    def leaf(t, turned, long):
        """A leaf that stands on the limb."""
        foot, way = bend(p, q, r, t), math.radians(heading(p, q, r, t) + turned)
        return lance(foot, (foot[0] + long * math.sin(way), foot[1] - long * math.cos(way)), 0.26, 0.06)

    write("fig4-l-tree", "Tree",
          "A bent limb, one clone that goes on from its tip and one that leaves its side; the last bear leaves. "
          "After Figure 4l of Carlson and Woodbury 1990.",
          form("tree", [
              clone(at(bend(p, q, r, 0.62), heading(p, q, r, 0.62) + 44, branch, mirrored=True)),
              fill(limb, MEADOW[0]),
              clone(at(r, heading(p, q, r, 1) + 4, leader, mirrored=True)),
              fill(leaf(0.4, 64, 1.5), MEADOW[1], generations="last"),
              fill(leaf(0.7, -52, 1.45), MEADOW[1], generations="last"),
              fill(leaf(0.95, 18, 1.55), MEADOW[2], generations="last"),
          ], depth=30, min_size=13),
          fit=(-1.25, -2.2, 2.5, 2.25))


def half_square():
    write("fig4-m-half-square", "Half square",
          "A square with a square of half its size on every side. "
          "After Figure 4m of Carlson and Woodbury 1990.",
          form("squares", [
              *(clone(turn(90 * k) @ move(0, -1.5) @ scale(0.5)) for k in range(4)),
              fill(polygon((-1, -1), (1, -1), (1, 1), (-1, 1)), LAGOON[0]),
          ], depth=6, colours=ramp(LAGOON)),
          fit=(-2.1, -2.1, 4.2, 4.2))


def woven_texture():
    def strand(y, long, wide, narrow):
        """A strand that bows up in its middle and dives at its ends."""
        a, b, c, d = 0.5 - long / 2, 0.5 + long / 2, wide / 2, narrow / 2
        return (f"M{number(a)},{number(y - d)} C{number(a + 0.25)},{number(y - c)} {number(b - 0.25)},{number(y - c)} "
                f"{number(b)},{number(y - d)} L{number(b)},{number(y + d)} C{number(b - 0.25)},{number(y + c)} "
                f"{number(a + 0.25)},{number(y + c)} {number(a)},{number(y + d)} Z")

    rows = (1 / 6, 1 / 2, 5 / 6)
    light = fill(" ".join(strand(y - 0.03, 0.7, 0.11, 0) for y in rows), EMBER[2])
    # The light comes first as well, for the picture of the clones; there it is painted over.
    write("fig4-n-woven-texture", "Woven texture",
          "Three strands in a square, and four clones, two of them laid across. The order of the two ways "
          "never repeats itself. After Figure 4n of Carlson and Woodbury 1990.",
          form("woven", [
              light,
              fill(" ".join(strand(y, 1, 0.32, 0.24) for y in rows), EMBER[0]),
              fill(" ".join(strand(y, 0.94, 0.25, 0.1) for y in rows), EMBER[1]),
              light,
              *(clone(move(x / 2, y / 2) @ scale(0.5) @ (mirror((0, 0), (1, 1)) if x != y else Affine()))
                for x in (0, 1) for y in (0, 1)),
          ], depth=5, generations="last"),
          fit=(-0.05, -0.05, 1.1, 1.1))


def koch_tiling():
    def snowflake(radius, depth):
        """The corners of a Koch snowflake about the origin; its outermost six lie on the radius."""
        ring = [polar(radius, math.radians(90 + 120 * k)) for k in range(3)]
        for _ in range(depth):
            finer = []
            for p, q in zip(ring, ring[1:] + ring[:1]):
                a, b = between(p, q, 1 / 3), between(p, q, 2 / 3)
                finer += [p, a, turn(-60, a)(b), b]
            ring = finer
        return ring

    # Colours of generations replace the fill and the line, which only the picture of the motif shows.
    write("fig4-o-koch-tiling", "Koch tiling",
          "A snowflake is filled without a gap by one of itself in its middle and six in its points. "
          "After Figure 4o of Carlson and Woodbury 1990.",
          form("snowflake", [
              shape(polygon(*snowflake(0.955, 3)), fill="#efcfc0", stroke=DUSK[0], stroke_width=0.01,
                    stroke_linejoin="round", generations="last"),
              clone(turn(30) @ scale(1 / math.sqrt(3))),
              *(clone(move(*polar(2 / 3, math.radians(90 + 60 * k))) @ scale(1 / 3)) for k in range(6)),
          ], depth=7, colours=ramp((DUSK[0],) * 4 + (DUSK[1], DUSK[2], "#efcfc0")), min_size=36),
          fit=(-1.02, -1.02, 2.04, 2.04))


def pyramid():
    view = View(45, 22)
    high = 2
    top, left, front, right = (0, 0, high), (1, -1, 0), (1, 1, 0), (-1, 1, 0)
    middle = view(0, 0, high / 3)
    write("fig4-p-pyramid", "Pyramid",
          "A pyramid of five pyramids of half its size, painted from the back to the front. "
          "After Figure 4p of Carlson and Woodbury 1990.",
          form("pyramid", [
              fill(view.face(top, left, front), "#ecc98c", generations="last"),
              fill(view.face(top, front, right), EMBER[0], generations="last"),
              fill(polygon(*(scale(0.985, about=middle)(view(*corner)) for corner in (top, left, front, right))),
                   EMBER[1], generations="inner"),
              *(clone(view.copy(0.5, x / 2, y / 2, 0)) for x, y in ((-1, -1), (-1, 1), (1, -1), (1, 1))),
              clone(view.copy(0.5, 0, 0, high / 2)),
          ], depth=5),
          fit=(-1.4, -1.75, 2.8, 2.3))


def lace():
    # Six circles about one in a ring, and the circles that touch three of these in the gaps.
    gap = 1 / (5 + 2 * math.sqrt(3))

    def petal(turned, near, far, wide):
        way = math.radians(turned)
        return lance(polar(near, way), polar(far, way), wide, 0)

    thread = "#f4ead8"
    flower = " ".join(petal(30 + 60 * k, 0.1, 0.86, 0.3) for k in range(6))
    write("lace", "Lace",
          "A ring with seven clones that touch it and each other, and six small ones in the gaps.",
          form("lace", [
              shape(oval(0, 0, 1, 1), fill="none", stroke=thread, stroke_width=0.017),
              fill(flower, thread, generations="last"),
              *(clone(move(*polar(2 / 3, math.radians(60 * k))) @ scale(1 / 3)) for k in range(6)),
              clone(turn(30) @ scale(1 / 3)),
              *(clone(move(*polar(1 - gap, math.radians(30 + 60 * k))) @ turn(60 * k) @ scale(gap)) for k in range(6)),
          ], depth=6, strokes="fixed", min_size=64),
          fit=(-1.1, -1.1, 2.2, 2.2), background=DUSK[0])


def fern():
    wide, leader, long = 0.026, 0.87, 0.17
    leaflet = lance((0, 0.01), (0.04, -0.5), 0.2, 0.05)
    write("fern", "Fern",
          "A piece of stalk with one clone that carries it on and two fronds, each a fern of its own.",
          form("fern", [
              fill(leaflet, MEADOW[1], generations="last"),
              clone(at((0, -0.35 * long), -60, 0.37)),
              clone(at((0, -0.8 * long), 56, 0.35, mirrored=True)),
              fill(taper((0, 0), (0, -long / 2), (0, -long), wide, wide * leader), MEADOW[0]),
              clone(at((0, -long), 3.2, leader)),
          ], depth=60, min_size=6),
          fit=(-0.38, -0.72, 0.76, 0.76))


def rosette():
    count, shrink = 16, 0.8

    def ring(near, far, wide, droop):
        def turned(k):
            way = math.tau * k / count
            return polar(near, way), polar(far, way + 0.06)

        return " ".join(lance(*turned(k), wide, droop) for k in range(count))

    write("rosette", "Rosette",
          "A ring of petals, and one clone of it, smaller and turned by half a petal.",
          form("rosette", [
              fill(ring(0.5, 1, 0.46, 0.1), DUSK[0]),
              fill(oval(0, 0, 0.8, 0.8), DUSK[0]),
              fill(ring(0.56, 0.95, 0.36, 0.1), DUSK[1]),
              fill(ring(0.66, 0.88, 0.22, 0.1), DUSK[2]),
              clone(turn(180 / count) @ scale(shrink)),
          ], depth=24),
          fit=(-1.05, -1.05, 2.1, 2.1))


def draw():
    figure_1()
    figure_3()
    figure_6()
    ammonite()
    arches()
    mesh()
    meander()
    kawaguchiesque()
    monkey_tree()
    p4_symmetry()
    evergreen()
    bamboo()
    phyllotaxis()
    bronchus()
    tree()
    half_square()
    woven_texture()
    koch_tiling()
    pyramid()
    lace()
    fern()
    rosette()
