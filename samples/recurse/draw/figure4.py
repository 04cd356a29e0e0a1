"""The forms of Figures 1, 3, 4 and 6 of Carlson and Woodbury 1990, and three pieces of our own."""

import cmath
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


def pairs(*where):
    return tuple(f"{number(x)} {number(y)}" for x, y in where)


def taper(p, q, r, wide, narrow):
    """The outline of a limb about a quadratic curve: cut flat at its foot, round at its tip."""
    first, last = heading(p, q, r, 0), heading(p, q, r, 1)
    middle = (first + last) / 2
    a, b, c, d, e, f = pairs(
        aside(p, first, wide / 2), aside(q, middle, (wide + narrow) / 4), aside(r, last, narrow / 2),
        aside(r, last, -narrow / 2), aside(q, middle, -(wide + narrow) / 4), aside(p, first, -wide / 2))
    n = number(narrow / 2)
    return f"M{a} Q{b} {c} A{n} {n} 0 0 0 {d} Q{e} {f} Z"


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


def squig(path, ways):
    """The clones of a path whose every segment is replaced by the path: each laid from the one end
    of its segment to the other, or back, or mirrored, or both."""
    whole = path[0], path[-1]
    ends = {"on": (1, False), "back": (-1, False), "mirrored": (1, True), "back mirrored": (-1, True)}
    clones = []
    for segment, way in zip(zip(path, path[1:]), ways):
        order, mirrored = ends[way]
        clones.append(clone(similar(*whole, *segment[::order], mirrored=mirrored)))
    return clones


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


def polar(radius, angle):
    return radius * math.cos(angle), radius * math.sin(angle)


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
          ], depth=200),
          fit=(-0.2, -1, 1.2, 1.2))


def draw():
    figure_1()
