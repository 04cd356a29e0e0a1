"""Figure 7 of Carlson and Woodbury 1990, "Exploring the binary tree": one tree, and what turns up
while its fork is turned about its attachment point.

The trunk goes from (0, 0) up to (0, -1). The fork is two clones of it at the tip: one to the left,
and the reflection of that one in the trunk's line. Turning the fork turns both together.
"""

import cmath
import math

from common import clone, form, move, number, points, polygon, scale, shape, turn, write

ROOT_HALF = math.sqrt(0.5)
GOLDEN = (math.sqrt(5) - 1) / 2
# The ratio of a tree whose branches hardly meet, before any coincidence is looked for.
PLAIN = 3 / 5

LAGOON = ("#14444f", "#2f7f79", "#d2913a")
EMBER = ("#6d1f2b", "#b4482f", "#dd9a3c")
MEADOW = ("#24452f", "#5c7a3a", "#c2a54a")
DUSK = ("#2b2a5a", "#7b3f72", "#cf7f86")

# The box of a tree's motif.
UPRIGHT = (-0.8, -1.7, 1.6, 1.8)


def sample(name, title, text, *forms, **where):
    """Writes a sample, whose name starts with its letter in the figure."""
    text += f" After Figure 7{name[0]} of Carlson and Woodbury 1990."
    write(f"fig7-{name}", title, text, *forms, **where)


def fork(angle, ratio, heading=0):
    """The two clones of a fork turned clockwise by an angle, of a trunk that points to a heading."""
    there, back = turn(heading) @ move(0, -1), turn(-heading)
    return [clone(there @ turn(angle - 45) @ scale(ratio) @ back),
            clone(there @ turn(angle + 45) @ scale(-ratio, ratio) @ back)]


def tree(motif, angle, ratio, heading=0, **params):
    """The clones come first: the trunk is painted over its branches."""
    return form("tree", fork(angle, ratio, heading) + motif, **params)


def ramp(tones, depth=None):
    """The colours parameter: blended over the generations, or in turn if a depth is given."""
    return ",".join(tones[i % len(tones)] for i in range(depth or len(tones)))


def outline(matrix, *corners):
    return polygon(*(matrix(c) for c in corners))


def limb(start, end, width, taper):
    """A branch with round ends, so that forks have no notches whatever their angle."""
    along = complex(end[0] - start[0], end[1] - start[1])
    across = along / abs(along) * 1j * width / 2
    a, b = complex(*start), complex(*end)
    path = [a + across, b + across * taper, b - across * taper, a - across]
    p, q, r, s = (f"{number(z.real)},{number(z.imag)}" for z in path)
    tip, foot = number(width * taper / 2), number(width / 2)
    return f"M{p} L{q} A{tip},{tip} 0 0 0 {r} L{s} A{foot},{foot} 0 0 0 {p} Z"


def branches(angle, ratio, width, tones, depth, heading=0, **params):
    """A tree of tapered limbs, blended from the first tone to the last."""
    tip = turn(heading)((0, -1))
    trunk = shape(limb((0, 0), tip, width, ratio), fill=tones[0])
    return tree([trunk], angle, ratio, heading, depth=depth, colours=ramp(tones), **params)


def wide(height):
    """A frame as wide as ever, for forms that are not square."""
    return (230, 220 - height / 2, 400, height)


# a to f: the tree, and squares in it

def trees_and_squares():
    sample("a-tree", "Binary tree",
           "A trunk and two clones of it, each three fifths as long and turned by 45 degrees.",
           branches(0, PLAIN, 0.13, MEADOW, 8), fit=UPRIGHT)
    sample("b-squares", "Fork turned by 45 degrees",
           "One branch goes on, the other turns off: the branches enclose squares, and these overlap.",
           branches(45, 2 / 3, 0.1, LAGOON, 8), fit=UPRIGHT)
    for name, title, text, ratio, tones, depth in [
            ("c-golden", "Golden squares",
             "The same fork by the golden ratio: on every square stand two smaller ones that fill its side.",
             GOLDEN, LAGOON, 9),
            ("d-three", "Squares in threes",
             "Smaller clones, by the root of 1 = r + r² + r³: on every square stand three.",
             three_ratio(), (EMBER[0], EMBER[1], EMBER[2], "#f1d9b0"), 8),
            ("e-limit", "Squares by halves",
             "Clones of half the size: the squares on a side never end, and all of them fill a triangle.",
             0.5, DUSK, 7)]:
        both = ratio + ratio ** 2
        square = shape(rippled_square(ratio), fill=tones[0], fill_rule="evenodd")
        sample(name, title, text,
               tree([square], 45, ratio, depth=depth, colours=ramp(tones, depth)),
               fit=(-0.1, -1.1 - both, both + 0.2, both + 0.2))
    sample("f-cubes", "Golden cubes",
           "Cubes stand where the golden squares lay; each is painted before those in front of it.",
           cubes(GOLDEN, EMBER, 8), fit=(-1.5, -1.1, 3, 2.5), frame=wide(230))


def rippled_square(ratio):
    """What a fork encloses: a square at the tip of the trunk. Quarter circles are cut out of it that
    shrink as the squares do, so that a square shows its corner at the fork, and its neighbours of
    the same colour are told apart."""
    path = polygon((0, -1), (ratio, -1), (ratio, -1 - ratio), (0, -1 - ratio))
    for outer in (ratio, ratio ** 2, ratio ** 3):
        inner = outer - 0.04 * math.sqrt(ratio * outer)
        o, i = number(outer), number(inner)
        path += (f" M0,{number(-1 - outer)} A{o},{o} 0 0 1 {o},-1 L{i},-1 "
                 f"A{i},{i} 0 0 0 0,{number(-1 - inner)} Z")
    return path


def three_ratio():
    """The positive root of 1 = r + r^2 + r^3, about 0.5437, by Cardano's formula."""
    root = math.sqrt(33)
    return (math.cbrt(17 + 3 * root) - math.cbrt(3 * root - 17) - 1) / 3


def cubes(ratio, tones, depth):
    """Cubes on a floor, seen from the corner that they grow to. Clones are not mirrored here, since
    the light would be; the squares below them are the same."""
    def at(x, y, z):
        return ((x - y) * math.cos(math.pi / 6), (x + y) / 2 - z)

    edge = {"stroke": "#fbeedb", "stroke_width": 0.02, "stroke_linejoin": "round"}
    middle = at(1, 1, 1)
    silhouette = polygon(at(0, 0, 1), at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 1, 1))
    # The clones beside the motif show the first shape alone: it must look like a cube.
    spokes = "".join(" " + points(middle, end) for end in (at(1, 0, 1), at(0, 1, 1), at(1, 1, 0)))
    top = polygon(at(0, 0, 1), at(1, 0, 1), middle, at(0, 1, 1))
    right = polygon(at(1, 0, 0), at(1, 1, 0), middle, at(1, 0, 1))
    return form("cubes", [
        shape(silhouette + spokes, fill=tones[1], **edge),
        shape(top, fill=tones[2], **edge),
        shape(right, fill=tones[0], **edge),
        clone(move(*at(0, 1, 0)) @ scale(ratio)),
        clone(move(*at(1, 0, 0)) @ scale(ratio)),
    ], depth=depth)


# g to o: trees, and the spirals in them

def trees_and_spirals():
    for name, angle, tones, width in [("g-curl", 67.5, MEADOW, 0.1), ("i-hook", 90, DUSK, 0.08),
                                      ("n-whirl", 105, EMBER, 0.08)]:
        sample(name, f"Fork turned by {number(angle)} degrees",
               "Every branch curls the same way: the tree is made of spirals.",
               branches(angle, PLAIN, width, tones, 8), fit=UPRIGHT)
    sample("h-dahlia", "Spirals of kites",
           "The curled tree at the size where its branches meet, eight times around: rings of kites.",
           rosette(8, LAGOON), fit=(-1.05, -1.05, 2.1, 2.1))
    sample("o-darts", "Spirals of darts",
           "The whirling tree at the size where its branches meet, three times around: rings of darts.",
           rosette(3, EMBER), fit=(-1.05, -1.05, 2.1, 2.1))
    for name, title, text, sides, share, tones, depth in [
            ("j-nest", "Nested squares",
             "Each square stands on the middles of the sides of the one around it.", 4, 0.5, DUSK, 10),
            ("k-pentagons", "Nested pentagons",
             "Each pentagon stands on the middles of the sides of the one around it.", 5, 0.5, MEADOW, 14),
            ("l-octagons", "Nested octagons",
             "Each octagon stands on the middles of the sides of the one around it.", 8, 0.5, LAGOON, 27)]:
        sample(name, title, text, nest(sides, share, tones, depth), fit=(-1.05, -1.05, 2.1, 2.1))
    sample("m-golden-nest", "Golden nest of squares",
           "The squares stand where the golden ratio cuts the sides, and wind inwards.",
           nest(4, GOLDEN ** 2, EMBER, 10), fit=(-1.05, -1.05, 2.1, 2.1))


def xy(z):
    return (z.real, z.imag)


def rosette(count, tones):
    """Rings of kites around a centre; each ring is the one outside it turned by half a step.

    A kite is what two branches of a fork enclose with the branches that they end in. These meet on
    the fork's axis if the ratio is 1 / (cos + sin) of half a step, and forks are turned by half a
    step more than 45 degrees: 8 kites for 67.5 degrees, 4 (nested squares) for 90, 3 for 105."""
    half = math.pi / count
    ratio = 1 / (math.cos(half) + math.sin(half))
    kites, shades = [], []
    for k in range(count):
        tip = -1j * cmath.exp(2j * half * k)
        left, right, foot = (tip * ratio * cmath.exp(1j * half * side) for side in (-1, 1, 0))
        foot *= ratio
        kites.append(polygon(*map(xy, (tip, right, foot, left))))
        shades.append(polygon(*map(xy, (tip, right, foot))))
    # Rings down to a twenty-fifth of the first.
    depth = math.ceil(math.log(0.04) / math.log(ratio)) + 1
    inside = [-1j * ratio ** (2 - k % 2) * cmath.exp(half * k * 1j) for k in range(2 * count)]
    core = polygon(*map(xy, inside))
    return form("spiral", [
        shape(" ".join(kites), fill=tones[1]),
        shape(" ".join(shades), fill=tones[0]),
        shape(core, generations="last", fill=tones[2]),
        clone(turn(math.degrees(half)) @ scale(ratio)),
    ], depth=depth)


def nest(sides, share, tones, depth):
    """Regular polygons in each other, the corners of each where the sides of the last are cut. The
    motif is what a polygon leaves free of the one around it: a triangle in each corner."""
    step = cmath.exp(2j * math.pi / sides)
    inner = 1 - share + share * step
    corner = -1j * cmath.exp(1j * math.pi / sides) * step
    triangle = shrunk((corner / step * inner, corner, corner * inner), 0.96)
    triangles = [polygon(*(xy(z * step ** k) for z in triangle)) for k in range(sides)]
    core = polygon(*(xy(corner * inner * step ** k) for k in range(sides)))
    return form("nest", [
        shape(" ".join(triangles), fill=tones[0]),
        shape(core, generations="last", fill=tones[-1]),
        clone(turn(math.degrees(cmath.phase(inner))) @ scale(abs(inner))),
    ], depth=depth, colours=ramp(tones, depth))


def shrunk(corners, share):
    """A triangle shrunk towards the centre of its inner circle, which leaves a line of one width
    between neighbours."""
    a, b, c = corners
    opposite = (abs(b - c), abs(c - a), abs(a - b))
    centre = sum(z * side for z, side in zip(corners, opposite)) / sum(opposite)
    return [centre + (z - centre) * share for z in corners]


# p to u: a triangle that is folded into halves

def trees_and_kaleidoscopes():
    sample("p-halfway", "Fork turned by 180 degrees",
           "Halfway round, the tree is the grid that halves a triangle again and again.",
           branches(180, ROOT_HALF, 0.07, DUSK, 10), fit=(-1, -1.3, 2, 1.6), frame=wide(218))
    sample("q-gable", "Fork turned by 270 degrees",
           "The same triangle, with branches from the middle of a side to the middle of the height.",
           branches(270, ROOT_HALF, 0.1, MEADOW, 9, heading=-90), fit=(-2, -0.8, 2.4, 1.6), frame=wide(218))
    sample("r-last", "Last generation",
           "Only the last branches of the gable: a pattern with the mirrors of a square.",
           tree([shape(points(LEG, HEIGHT), fill="none", stroke=MEADOW[0], stroke_width=0.32, stroke_linecap="round")],
                270, ROOT_HALF, -90, depth=9, generations="last"),
           fit=(-2, -0.8, 2.4, 1.6), frame=wide(218))
    for name, title, text, place, half, style, reach in [
            ("s-arrows", "Kaleidoscope of arrows",
             "Four gables make a square. An arrow in place of the trunk shows which copies are mirrored.",
             arrow_between(LEG, HEIGHT), 0.17, {"fill": LAGOON[0]}, 2),
            ("t-stars", "Kaleidoscope of stars",
             "The arrow is moved to where eight mirrors meet.",
             turn(202.5, CORNER) @ move(1.5, 1) @ scale(2.3), 0.1,
             {"fill": EMBER[2], "stroke": EMBER[0], "stroke_width": 0.07, "stroke_linejoin": "round"}, 2),
            ("u-lattice", "Kaleidoscope of knots",
             "The arrow is turned across and made longer, and its copies link to a lattice.",
             turn(202.5, CORNER) @ move(2.5, -2) @ turn(90) @ scale(4), 0.07, {"fill": DUSK[0]}, 3)]:
        motif = [shape(arrow(place, half), **style)]
        if name == "s-arrows":
            # The mirrors themselves, in a pale tone.
            motif.append(shape(polygon(APEX, CORNER, (-3, 1)), fill="none", stroke="#b9cfce", stroke_width=0.05))
        sample(name, title, text, *kaleidoscope(motif),
               fit=(APEX[0] - reach, APEX[1] - reach, 2 * reach, 2 * reach))


# Points of the triangle that a fork turned by 270 degrees fills, if its trunk points to the left: the
# middle of its leg, where the trunk starts, and of its height, where it ends; its apex, and a corner.
LEG, HEIGHT, APEX, CORNER = (0, 0), (-1, 0), (-1, -1), (1, 1)


def arrow_between(start, end):
    along = complex(*end) - complex(*start)
    return move(*start) @ turn(math.degrees(cmath.phase(along))) @ scale(abs(along))


def arrow(place, half):
    """An arrow of length one with a barb on one side alone, so that its mirror image is another.
    Its shaft is twice as wide as `half`."""
    barb, neck = 3 * half + 0.09, 0.6
    return outline(place, (0, -half), (neck, -half), (neck, -barb), (1, half), (0, half))


def kaleidoscope(motif):
    """Four triangles that make a square, each the last generation of a tree."""
    square = [clone(turn(quarter, APEX), of="tree") for quarter in (0, 90, 180, 270)]
    return [form("field", square, depth=7, generations="last"), tree(motif, 270, ROOT_HALF, -90)]


# v to z: a rectangle that is halved, and the twindragon

def canals_and_dragons():
    sample("v-rectangle", "Fork turned by 315 degrees",
           "Shortly before full circle the tree fills a rectangle, its twigs evenly spaced.",
           branches(315, ROOT_HALF, 0.11, MEADOW, 10, heading=45), fit=(-0.7, -1.4, 2, 1.6), frame=wide(290))
    # Where the middle of the rectangle is, which is the axis of the fork, and how high it is.
    axis, height = ROOT_HALF, math.sqrt(2) + 1
    canal = shape(limb((axis, 0), (axis, -0.75 * height), 0.1, ROOT_HALF), fill=LAGOON[0])
    sample("w-canals", "Canals",
           "The trunk moved onto the middle of the rectangle: no branch crosses another.",
           tree([canal], 315, ROOT_HALF, 45, depth=9, colours=ramp(LAGOON)),
           fit=(axis - 1.3, -2, 2.6, 2.1), frame=wide(290))
    sample("x-middle", "Canals from the middle",
           "The trunk in the centre, and a clone across each of its ends.",
           rods(90, LAGOON, 0.12, 9), fit=(-1.2, -0.9, 2.4, 1.8), frame=wide(290))
    sample("y-dragon", "Clones at 45 degrees",
           "Canals whose clones are turned by half as much fill a shape with the coast of a dragon.",
           rods(45, EMBER, 0.15, 10), fit=(-1.7, -0.9, 3.4, 1.8), frame=wide(290))
    sample("z-twindragon", "Twindragon",
           "The last generation alone, with squares for branches: they cover the dragon once, and its "
           "two halves are dragons again.",
           *twindragon(EMBER, 14), fit=(-2.1, -2.1, 4.2, 4.2), frame=wide(290))


def halves(angle, **of):
    """Two clones whose middles are the ends of a line from (-1, 0) to (1, 0)."""
    return [clone(move(-1, 0) @ turn(angle) @ scale(ROOT_HALF), **of),
            clone(move(1, 0) @ turn(angle + 180) @ scale(ROOT_HALF), **of)]


def rods(angle, tones, width, depth):
    # Ends are blunt: each lies in the middle of a clone, which is less wide, and round ones would
    # stand out from it.
    w = width / 2
    rod = shape(polygon((-1, -w), (1, -w), (1, w), (-1, w)), fill=tones[0])
    return form("canals", halves(angle) + [rod], depth=depth, colours=ramp(tones))


def twindragon(tones, depth):
    """A dragon of two halves. The two clones of the square lie side by side, so that all copies lie
    on a grid: none overlap, and every generation is as large as the motif."""
    square = polygon((-2, 0), (0, -2), (2, 0), (0, 2))
    one, other = halves(45, of="dark"), halves(45, of="light")
    # Edges that are not softened leave no seams between neighbours.
    crisp = {"shape_rendering": "crispEdges"}
    return [form("dragon", [one[0], other[1]], depth=depth, generations="last"),
            form("dark", [shape(square, fill=tones[0], **crisp)] + halves(45)),
            form("light", [shape(square, fill=tones[2], **crisp)] + halves(45))]


def draw():
    trees_and_squares()
    trees_and_spirals()
    trees_and_kaleidoscopes()
    canals_and_dragons()


if __name__ == "__main__":
    draw()
