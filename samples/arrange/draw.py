"""Draws the samples of arrangement by example: a small drawn example on the left, and on the right
a shape that the example goes on in. Run `python3 samples/arrange/draw.py` from the top of the
repository.

Elements on the border of an example only serve as neighbours, so every example is drawn wider than
what is copied, and every symbol stands in its middle at least once.
"""

import math
import os
import random
from xml.sax.saxutils import escape

FOLDER = os.path.dirname(os.path.abspath(__file__))
SIZE = (700, 500)

LAGOON = ("#14444f", "#2f7f79", "#d2913a")
EMBER = ("#6d1f2b", "#b4482f", "#dd9a3c")
MEADOW = ("#24452f", "#5c7a3a", "#c2a54a")
DUSK = ("#2b2a5a", "#7b3f72", "#cf7f86")
PAPER = "#f3e3bd"
# Paper that hardly shows, for the page itself.
PAGE = "#fdf9ef"


def number(x):
    text = f"{x:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def mix(a, b, share):
    """A tone between two, in sRGB as an artist's blend would be."""
    pairs = [(int(a[i:i + 2], 16), int(b[i:i + 2], 16)) for i in (1, 3, 5)]
    return "#" + "".join(f"{round(p + share * (q - p)):02x}" for p, q in pairs)


def style(**paint):
    """A style attribute: `stroke_width=2` and so on."""
    return ";".join(f"{key.replace('_', '-')}:{value}" for key, value in paint.items())


def params(given):
    """Attributes such as rinceau:vary-size, of vary_size=0.1."""
    return "".join(f' rinceau:{key.replace("_", "-")}="{value}"' for key, value in given.items())


# Path data

def at(x, y, angle=0, size=1):
    """A place: turns points by degrees, scales them and moves them."""
    c, s = size * math.cos(math.radians(angle)), size * math.sin(math.radians(angle))
    return lambda px, py: f"{number(x + c * px - s * py)},{number(y + s * px + c * py)}"


def placed(text, place):
    """Path data whose commands are M, L, C, Q and Z with absolute numbers, moved to a place."""
    out = []
    for word in text.split():
        letter = word[0] if word[0].isalpha() else ""
        rest = word[len(letter):]
        out.append(letter + (place(*map(float, rest.split(","))) if rest else ""))
    return " ".join(out)


def smooth(points):
    """A closed curve through points (Catmull and Rom's)."""
    n = len(points)
    text = f"M{number(points[0][0])},{number(points[0][1])}"
    for i in range(n):
        a, b, c, d = (points[(i + k) % n] for k in (-1, 0, 1, 2))
        first = (b[0] + (c[0] - a[0]) / 6, b[1] + (c[1] - a[1]) / 6)
        second = (c[0] - (d[0] - b[0]) / 6, c[1] - (d[1] - b[1]) / 6)
        text += " C" + " ".join(f"{number(x)},{number(y)}" for x, y in (first, second, c))
    return text + " Z"


def stone(rng, x, y, width, height, wobble=0.06, power=2.6):
    """A rounded stone: squarer than an ellipse, and a little irregular."""
    points = []
    for i in range(8):
        a = 2 * math.pi * (i + 0.5) / 8
        c, s = math.cos(a), math.sin(a)
        r = (abs(c) ** power + abs(s) ** power) ** (-1 / power) * (1 + rng.uniform(-wobble, wobble))
        points.append((x + 0.5 * width * r * c, y + 0.5 * height * r * s))
    return smooth(points)


# Elements of an example

def path(d, **paint):
    return f'<path d="{d}" style="{style(**paint)}"/>'


def circle(x, y, r, **paint):
    return f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(r)}" style="{style(**paint)}"/>'


def named(symbol, *shapes):
    """An element: one shape, or a group of several, that is one of a symbol."""
    mark = f' rinceau:symbol="{symbol}"'
    if len(shapes) > 1:
        return f"<g{mark}>" + "".join(shapes) + "</g>"
    head, tail = shapes[0].split(" ", 1)
    return head + mark + " " + tail


def even(rng, width, height, kinds, gap, tries=6000):
    """Places of unlike size spread evenly over a box: (x, y, kind). `kinds` are (name, radius, how
    many, how far apart at least), the largest first. Darts alone leave gaps of all widths, so
    everything is pushed apart in the end until gaps are about equal."""
    spots = []
    for name, radius, count, apart in kinds:
        for _ in range(tries):
            if count == 0:
                break
            x, y = rng.uniform(radius, width - radius), rng.uniform(radius, height - radius)
            new = (x, y, radius, name, apart)
            if all(math.hypot(x - s[0], y - s[1]) > reach(new, s, gap) for s in spots):
                spots.append(new)
                count -= 1
    for step in range(150):
        spots = [pushed(spots, i, 1.6 * gap, width, height) for i in range(len(spots))]
    return [(x, y, name) for x, y, _, name, _ in spots]


def reach(a, b, gap):
    """How far apart two spots should be: two of a kind more than others."""
    between = a[2] + b[2] + gap
    return max(between, a[4]) if a[3] == b[3] else between


def pushed(spots, index, gap, width, height):
    """A spot, one step away from all that are too near."""
    own = spots[index]
    x, y, r = own[:3]
    dx = dy = 0
    for other in spots:
        if other is own:
            continue
        distance = math.hypot(x - other[0], y - other[1])
        lack = reach(own, other, gap) - distance
        if lack > 0:
            dx += 0.2 * lack * (x - other[0]) / distance
            dy += 0.2 * lack * (y - other[1]) / distance
    return (min(max(x + dx, r), width - r), min(max(y + dy, r), height - r), *own[2:])


def in_turn(rng, tones, places, far):
    """A tone for each place, and none like another nearer than `far`, if that can be."""
    chosen = []
    for x, y in places:
        near = {tone for tone, (u, v) in zip(chosen, places) if math.hypot(x - u, y - v) < far}
        chosen.append(rng.choice([tone for tone in tones if tone not in near] or tones))
    return chosen


# The drawing

class Sample:
    def __init__(self, name, title, description, page=PAGE):
        self.name = name
        self.lines = [
            '<?xml version="1.0" encoding="UTF-8"?>',
            '<svg xmlns="http://www.w3.org/2000/svg" '
            'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:rinceau="urn:rinceau:1" '
            f'width="{SIZE[0]}" height="{SIZE[1]}" viewBox="0 0 {SIZE[0]} {SIZE[1]}">',
            f"  <title>{escape(title)}</title>",
            f"  <desc>{escape(description)}</desc>",
            f'  <rect width="{SIZE[0]}" height="{SIZE[1]}" fill="{page}"/>',
        ]

    def add(self, line):
        """Artwork that no generator looks at."""
        self.lines.append("  " + line)

    def example(self, elements, x=20, y=20):
        """The example, its elements in paint order."""
        self.add('<g id="example" class="rinceau-reference" rinceau:role="reference" '
                 f'inkscape:label="Example" transform="translate({number(x)} {number(y)})">')
        for index, element in enumerate(elements):
            head, tail = element.split(" ", 1)
            self.add(f'  {head} id="e{index + 1}" {tail}')
        self.add("</g>")

    def container(self, d, fill="none", stroke="#b9b2a3", **given):
        self.add('<path id="shape" class="rinceau-container" rinceau:role="container" '
                 f'inkscape:label="Shape"{params(given)} d="{d}" '
                 f'style="fill:{fill};fill-rule:evenodd;stroke:{stroke};stroke-width:0.75"/>')

    def line(self, role, index, d, stroke, width=1, opacity=1, **given):
        self.add(f'<path id="{role}-{index}" class="rinceau-{role}" rinceau:role="{role}" '
                 f'inkscape:label="{role.capitalize()} {index}"{params(given)} d="{d}" style="fill:none;stroke:{stroke};'
                 f'stroke-opacity:{opacity};stroke-width:{width};stroke-linecap:round;stroke-linejoin:round"/>')

    def guides(self, *lines):
        for index, d in enumerate(lines, 1):
            self.line("guide", index, d, "#ff0000", 0.75, 0.5)

    def boundaries(self, *lines):
        for index, d in enumerate(lines, 1):
            self.line("boundary", index, d, "#0000ff", 0.75, 0.5)

    def sprays(self, width, *lines, **given):
        for index, d in enumerate(lines, 1):
            self.line("spray", index, d, "#000000", width, 0.08, **given)

    def seed(self, x, y):
        self.add(f'<circle id="start" class="rinceau-seed" rinceau:role="seed" inkscape:label="Start" '
                 f'cx="{number(x)}" cy="{number(y)}" r="2" style="fill:#888888;fill-opacity:0.5"/>')

    def fixed(self, name, *shapes):
        self.add(f'<g id="{name}" class="rinceau-fixed" rinceau:role="fixed" '
                 f'inkscape:label="{name.capitalize()}">' + "".join(shapes) + "</g>")

    def write(self):
        with open(os.path.join(FOLDER, self.name + ".svg"), "w", encoding="utf-8") as file:
            file.write("\n".join(self.lines) + "\n</svg>\n")


def rect(x, y, width, height, round=0, **paint):
    return (f'<rect x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}" '
            f'rx="{number(round)}" style="{style(**paint)}"/>')


# Regular: bricks (Figure 8a)

def bricks():
    rng = random.Random(8)
    across, down, joint = 30, 15, 2.5
    tones = [mix(EMBER[1], EMBER[0], t) for t in (0, 0.3, 0.6)] + [EMBER[0], mix(EMBER[1], EMBER[2], 0.35)]
    sample = Sample("bricks", "Brick wall",
                    "Regular bricks go on in a gable with a window, from the mark on. Stones at the corners "
                    "and around the window are fixed. After Figure 8a of Ijiri et al. 2008.")
    places = [(across * (column + 0.5 * (row % 2)), down * row)
              for row in range(11) for column in range(6 - row % 2)]
    tone = in_turn(rng, tones, places, 1.1 * across)
    sample.example([named("brick", rect(x, y, across - joint, down - joint, 1, fill=t))
                    for (x, y), t in zip(places, tone)], x=16)
    gable(sample, across, down, joint)
    sample.write()


def gable(sample, across, down, joint):
    """A wall with crow steps. The mark lies in the middle of a brick of the lowest row; rows that are
    set off half a brick against an edge end in a stone."""
    left, base, columns = 226, 478, 15
    right = left + across * columns
    # Left edge of each row of the wall, from below: straight up to the eaves, then in steps.
    edges = [left] * 18 + [left + 1.5 * across * (1 + step // 2) for step in range(8)]
    wall = [(left, base)]
    for row, edge in enumerate(edges):
        y = base - down * row
        wall += [(edge, y), (edge, y - down)]
    wall += [(left + right - x, y) for x, y in reversed(wall)]
    middle, half = (left + right) / 2, 2.5 * across
    sill, lintel = base - 6 * down, base - 17 * down
    window = rectangle(middle - half, lintel, middle + half, sill)
    outline = "M" + " L".join(f"{number(x)},{number(y)}" for x, y in wall) + " Z " + window
    mortar = mix(PAPER, EMBER[0], 0.12)
    sample.container(outline, fill=mortar, stroke="none", edge="inside")
    stones = []
    for row, edge in enumerate(edges):
        y = base - down * (row + 1)
        ends = [(edge, 1), (left + right - edge, -1)]
        if lintel <= y < sill:
            ends += [(middle - half, -1), (middle + half, 1)]
        for x, way in ends:
            # Bricks of odd rows begin half a brick further on.
            if (x - left - 0.5 * across * (row % 2)) % across > 1:
                stones.append(block(x if way > 0 else x - across / 2, y, across / 2, down, joint))
    for row in range(17, len(edges), 2):
        edge, top = edges[row], base - down * (row + 1)
        inner = edges[row + 1] if row + 1 < len(edges) else middle
        for x0, x1 in [(edge - 3, inner - 1), (left + right - inner + 1, left + right - edge + 3)]:
            stones.append(rect(x0, top - 7, x1 - x0, 7, 1, fill=STONE))
    sample.fixed("stones", *stones, *opening(middle, half, lintel, sill, down))
    sample.seed(left + across / 2 + 2 * across, base - down / 2)


# Dressed stone beside bricks.
STONE = mix(PAPER, EMBER[2], 0.35)


def rectangle(x0, y0, x1, y1):
    return f"M{number(x0)},{number(y0)} H{number(x1)} V{number(y1)} H{number(x0)} Z"


def block(x, y, width, height, joint):
    return rect(x + joint / 2, y + joint / 2, width - joint, height - joint, 1, fill=STONE)


def opening(middle, half, top, sill, down):
    """An arched window in a frame of stone."""
    r = half - 12
    spring = top + 12 + r
    x0, x1 = number(middle - r), number(middle + r)
    pane = (f"M{x0},{number(sill - 6)} V{number(spring)} A{number(r)},{number(r)} 0 0 1 "
            f"{x1},{number(spring)} V{number(sill - 6)} Z")
    bars = (f"M{number(middle)},{number(top + 12)} V{number(sill - 6)} M{x0},{number(spring)} H{x1} "
            f"M{x0},{number((spring + sill) / 2)} H{x1}")
    return [path(rectangle(middle - half + 1, top + 1, middle + half - 1, sill - 1), fill=STONE),
            path(pane, fill=LAGOON[0]), path(bars, fill="none", stroke=STONE, stroke_width=4),
            path(f"M{number(middle - half + 1)},{number(sill - 6)} H{number(middle + half - 1)}", fill="none",
                 stroke=mix(STONE, EMBER[0], 0.25), stroke_width=1)]


# Near-regular: pebbles (8b)

def pebbles():
    rng = random.Random(3)
    sample = Sample("pebbles", "Pebble path",
                    "Stones in staggered rows follow a winding path, each a little different in size, "
                    "turn and tone. After Figure 8b of Ijiri et al. 2008.")
    across, down = 22, 18.5
    tones = (LAGOON[0], LAGOON[1], mix(LAGOON[1], PAPER, 0.35), mix(LAGOON[0], LAGOON[1], 0.5))
    places = [(across * (column + 0.5 * (row % 2)) + 11 + rng.uniform(-0.8, 0.8),
               down * row + 10 + rng.uniform(-0.8, 0.8)) for row in range(9) for column in range(7)]
    tone = in_turn(rng, tones, places, 1.15 * across)
    # Two warm ones, far from each other.
    for index in (31, 37):
        tone[index] = LAGOON[2]
    sample.example([named("stone", path(stone(rng, x, y, 19, 15.8), fill=t)) for (x, y), t in zip(places, tone)])
    sample.container("M214,520 C216,410 270,330 352,266 C430,204 460,120 456,-20 L682,-20 C690,160 646,262 552,336 "
                     "C478,394 444,440 442,520 Z", fill="#f0e6cf", stroke="none", mode="flow", edge="middle",
                     vary_size=0.06, vary_turn=8, output="paths", vary_tone=0.08)
    sample.guides("M328,520 C330,430 370,366 450,301 C536,232 574,140 569,-20")
    sample.write()


# A tile for cloth: the same stones, which fit their copies on all sides

def cloth():
    rng = random.Random(21)
    sample = Sample("cloth", "Cloth",
                    "A tile that repeats to all sides: what leaves it on the right comes in on the left, and the rows "
                    "fit though the tile was not measured for them.")
    across, down = 24, 19
    tones = (EMBER[0], EMBER[1], EMBER[2], mix(EMBER[2], PAPER, 0.45))
    places = [(across * (column + 0.5 * (row % 2)) + 14 + rng.uniform(-1.2, 1.2),
               down * row + 12 + rng.uniform(-1.2, 1.2)) for row in range(9) for column in range(7)]
    tone = in_turn(rng, tones, places, 1.15 * across)

    def petals(x, y, colour):
        turn = rng.uniform(0, 60)
        return [path(placed("M0,0 C-3.2,-3 -2.6,-8.4 0,-9.2 C2.6,-8.4 3.2,-3 0,0 Z", at(x, y, turn + 72 * k)), fill=colour)
                for k in range(5)] + [circle(x, y, 2.1, fill=PAPER)]

    sample.example([named(f"flower{tones.index(t) + 1}", *petals(x, y, t)) for (x, y), t in zip(places, tone)])
    sample.container(rectangle(230, 40, 630, 440), fill="#f7ead0", stroke="none", repeat="true")
    sample.write()


# Irregular and even: confetti (8c)

def heart(x, y, size):
    place = at(x, y, 0, size)
    return placed("M0,1 C-0.32,0.72 -1.08,0.28 -1.08,-0.34 C-1.08,-0.74 -0.8,-0.98 -0.5,-0.98 "
                  "C-0.28,-0.98 -0.08,-0.86 0,-0.64 C0.08,-0.86 0.28,-0.98 0.5,-0.98 "
                  "C0.8,-0.98 1.08,-0.74 1.08,-0.34 C1.08,0.28 0.32,0.72 0,1 Z", place)


def confetti():
    rng = random.Random(8)
    sample = Sample("confetti", "Confetti",
                    "Dots of three sizes and tones, without order but evenly spread. After Figure 8c of "
                    "Ijiri et al. 2008.")
    kinds = [("large", 7.2, 22, 30), ("middle", 5.4, 34, 22), ("small", 3.6, 150, 0)]
    paint = {"large": EMBER[0], "middle": EMBER[1], "small": EMBER[2]}
    radius = {kind[0]: kind[1] for kind in kinds}
    spots = even(rng, 176, 200, kinds, 4)
    sample.example([named(kind, circle(x, y, radius[kind], fill=paint[kind])) for x, y, kind in spots], x=14)
    sample.container(heart(450, 250, 222), edge="inside")
    sample.write()


# Turned as fits best: linked stones (8d)

def linked_stones():
    rng = random.Random(5)
    sample = Sample("linked-stones", "Linked stones",
                    "Dark stones linked in rows between pale ones; the example is turned as fits best. "
                    "After Figure 8d of Ijiri et al. 2008.")
    across, down = 17, 14.7
    pale = (mix(DUSK[2], PAPER, 0.35), mix(DUSK[2], PAPER, 0.6))
    elements = []
    for row in range(12):
        for column in range(10):
            x = across * (column + 0.5 * (row % 2)) + 9 + rng.uniform(-1, 1)
            y = down * row + 12 + 4.5 * math.sin(0.7 * column) + rng.uniform(-0.8, 0.8)
            dark = row % 3 == 1
            tone = rng.choice((DUSK[0], mix(DUSK[0], DUSK[1], 0.35))) if dark else rng.choice(pale)
            elements.append(named("dark" if dark else "pale",
                                  path(stone(rng, x, y, 15.2, 13.6, power=2.3), fill=tone)))
    sample.example(elements, x=14)
    sample.container("M450,32 A218,218 0 1 1 449.9,32 Z", mode="rotate", edge="inside", stroke="none")
    sample.write()


# Overlapping with a flow: scales (9)

SCALE = "M-11,-10 C2,-13 13,-8 14,0 C13,8 2,13 -11,10 Z"


def scale(x, y, tone, size=1):
    place = at(x, y, 0, size)
    rib = "M-4,-5 C4,-6 8,-3 9,0 C8,3 4,6 -4,5"
    return named("scale", path(placed(SCALE, place), fill=tone, stroke=PAPER, stroke_width=1),
                 path(placed(rib, place), fill="none", stroke=mix(tone, PAPER, 0.4), stroke_width=0.8))


def lattice(columns, rows, across, down):
    """Places of staggered columns, from right to left: each lies over those to the right of it."""
    return [(across * column, down * (row + 0.5 * (column % 2)))
            for column in reversed(range(columns)) for row in range(rows - column % 2)]


def scales():
    rng = random.Random(4)
    sample = Sample("scales", "Fish scales",
                    "Scales that overlap, row over row, along the lines of a fish. After Figure 9 of Ijiri "
                    "et al. 2008.")
    tones = (mix(LAGOON[0], LAGOON[1], 0.25), mix(LAGOON[0], LAGOON[1], 0.6), LAGOON[1],
             mix(LAGOON[1], LAGOON[2], 0.35), LAGOON[2])
    places = lattice(14, 11, 11.5, 17)
    tone = in_turn(rng, tones, places, 19)
    sample.example([scale(x + 12, y + 12, t, 0.82) for (x, y), t in zip(places, tone)], x=14)
    fish(sample)
    sample.write()


def fish(sample):
    body = ("M330,158 C420,104 530,122 594,208 C604,222 614,228 630,230 L630,290 C614,292 604,298 594,312 "
            "C530,398 420,416 330,362 C352,330 352,190 330,158 Z")
    head = ("M334,155.500 C356,190 356,330 334,364.500 C286,346 244,308 220,274 C212,262 212,256 220,246 "
            "C244,212 286,174 334,155.500 Z")
    tail = "M628,229 C650,220 668,186 692,160 C680,214 680,306 692,360 C668,334 650,300 628,291 Z"
    back = "M376,146 C420,84 510,66 560,88 C544,112 548,138 566,184 C530,170 440,160 376,146 Z"
    belly = "M408,382 C446,428 490,446 520,440 C512,420 516,404 528,372 C500,370 440,370 408,382 Z"
    for d in (tail, back, belly):
        sample.add(path(d, fill=LAGOON[0]))
    rays = ("M638,240 L680,200 M642,252 L680,236 M642,268 L680,284 M638,280 L680,320 "
            "M440,114 L470,88 M476,114 L506,82 M510,124 L536,86 M462,404 L478,430 M490,400 L502,436")
    sample.add(path(rays, fill="none", stroke=LAGOON[1], stroke_width=1.5, stroke_linecap="round"))
    sample.container(body, fill=LAGOON[0], stroke="none", mode="flow", edge="inside")
    sample.guides("M334,180 C420,134 520,150 590,216", "M340,260 H606", "M334,340 C420,386 520,370 590,304")
    sample.add(path(head, fill=LAGOON[0]))
    sample.add(path("M318,180 C332,220 332,300 318,340", fill="none", stroke=LAGOON[1], stroke_width=2,
                    stroke_linecap="round"))
    sample.add(circle(282, 234, 12, fill=PAPER) + circle(280, 234, 6, fill=LAGOON[0]))
    sample.add(path("M216,262 C230,272 244,274 256,272", fill="none", stroke=LAGOON[1], stroke_width=2,
                    stroke_linecap="round"))


# Overlapping with a flow: feathers (1 c and d)

def feather(x, y, tone):
    place = at(x, y)
    vane = "M-28,-2 C-14,-11 10,-11 24,-5 C28,-3 29,2 26,4 C12,11 -14,10 -28,2 Z"
    barbs = "M-16,0 L-8,-6 M-6,0 L3,-7 M4,0 L13,-6.5 M-16,0 L-8,6 M-6,0 L3,7 M4,0 L13,6"
    light = mix(tone, PAPER, 0.45)
    return named("feather", path(placed(vane, place), fill=tone, stroke=PAPER, stroke_width=1),
                 path(placed(barbs, place), fill="none", stroke=light, stroke_width=0.6),
                 path(placed("M-28,0 L22,0", place), fill="none", stroke=light, stroke_width=1.1))


def feathers():
    rng = random.Random(6)
    sample = Sample("feathers", "Wing",
                    "Feathers that overlap and turn with the lines of a wing. After Figure 1 (c) and (d) of "
                    "Ijiri et al. 2008.")
    tones = (DUSK[0], mix(DUSK[0], DUSK[1], 0.5), DUSK[1], mix(DUSK[1], DUSK[2], 0.5), DUSK[2])
    places = lattice(8, 8, 19, 19)
    # Painted aslant, since the wing's feathers point to the right and downwards.
    places.sort(key=lambda p: -(p[0] + 0.7 * p[1]))
    # Drawn with a free hand.
    sample.example([feather(x + 28 + rng.uniform(-1, 1), y + 12 + rng.uniform(-1, 1), rng.choice(tones))
                    for x, y in places])
    arm = ("M244,350 C218,200 320,52 440,44 C560,36 650,120 690,262 "
           "C612,190 540,124 448,124 C360,124 292,200 244,350 Z")
    sample.add(path(arm, fill=mix(DUSK[0], DUSK[1], 0.25)))
    sample.container("M250,300 C248,190 334,84 440,78 C546,74 630,150 676,262 C684,282 690,300 686,318 "
                     "C600,330 520,364 450,416 C400,444 330,452 276,440 C254,400 248,350 250,300 Z",
                     stroke="none", mode="flow", edge="middle")
    sample.guides("M262,160 C268,250 280,340 312,440", "M330,84 C356,190 392,300 440,410",
                  "M430,52 C470,150 510,250 560,350", "M530,66 C580,150 620,240 650,320",
                  "M620,140 C650,190 672,250 684,310")
    sample.write()


# Boundaries: blocks (1 e and f)

def blocks():
    rng = random.Random(2)
    sample = Sample("blocks", "Paving with dividing lines",
                    "Blocks lie along the dividing lines; growth stops at these, and starts anew behind "
                    "them. After Figure 1 (e) and (f) of Ijiri et al. 2008.")
    across, down, joint = 21, 16, 2.6
    tones = (MEADOW[1], mix(MEADOW[1], MEADOW[0], 0.4), mix(MEADOW[1], MEADOW[2], 0.45),
             mix(MEADOW[1], PAPER, 0.35))
    places = [(across * (column + 0.5 * (row % 2)), down * row) for row in range(11) for column in range(8 - row % 2)]
    tone = in_turn(rng, tones, places, 1.2 * across)
    sample.example([named("block", rect(x, y, across - joint, down - joint, 3, fill=t))
                    for (x, y), t in zip(places, tone)], x=14)
    # A threshold of three courses about one centre, far below. Rows that bend more than this slide against each other.
    reach = 0.21
    ends = [(r * math.sin(reach), r * math.cos(reach)) for r in (1100, 951, 802, 653)]
    arcs = [f"M{451 - dx:.1f},{1126 - dy:.1f} A{r},{r} 0 0 1 {451 + dx:.1f},{1126 - dy:.1f}"
            for r, (dx, dy) in zip((1100, 951, 802, 653), ends)]
    (dx, dy), r = ends[3], 653
    panel = f"{arcs[0]} L{451 + dx:.1f},{1126 - dy:.1f} A{r},{r} 0 0 0 {451 - dx:.1f},{1126 - dy:.1f} Z"
    sample.container(panel, edge="inside", mode="flow", fill="#f4ebd6")
    sample.boundaries(*arcs[1:3])
    # The outer ones keep rows level at the edges of the panel.
    sample.guides(*arcs)
    sample.write()


# Sprayed strokes: Euro (10)

def euro():
    rng = random.Random(9)
    sample = Sample("euro", "Euro",
                    "A word of sprayed strokes, filled with leaves up to its rims. Choose the flow as mode, and "
                    "they turn with the strokes. After Figure 10 of Ijiri et al. 2008.")
    tones = (MEADOW[0], MEADOW[1], mix(MEADOW[0], MEADOW[1], 0.5), mix(MEADOW[1], MEADOW[2], 0.5), MEADOW[2])
    places = lattice(17, 13, 8.5, 9.5)
    tone = in_turn(rng, tones, places, 11)
    # Drawn with a free hand.
    sample.example([small_leaf(x + 12 + rng.uniform(-0.15, 0.15), y + 8 + rng.uniform(-0.15, 0.15), t)
                    for (x, y), t in zip(places, tone)])
    letters = ["M314,150 C262,144 238,190 238,240 C238,296 262,338 318,330 M240,240 H306",
               "M372,196 V288 C372,346 444,346 444,288 V196",
               "M498,338 V240 C498,208 514,192 540,194",
               "M626,192 C574,192 574,336 626,336 C678,336 678,192 626,192 Z"]
    sample.sprays(42, *letters, edge="middle")
    sample.guides(*letters)
    sample.write()


def small_leaf(x, y, tone):
    place = at(x, y)
    return named("leaf", path(placed("M-8,0 C-5,-5.5 3,-6 9,0 C3,6 -5,5.5 -8,0 Z", place), fill=tone,
                              stroke=PAPER, stroke_width=0.6))


# Priority: fillers

def flower(x, y, r, tone, heart_tone, petals=6, turn=0):
    shapes = []
    for i in range(petals):
        place = at(x, y, turn + 360 * i / petals, r)
        shapes.append(path(placed("M0.12,0 C0.3,-0.5 1,-0.52 1,0 C1,0.52 0.3,0.5 0.12,0 Z", place), fill=tone))
    return shapes + [circle(x, y, 0.28 * r, fill=heart_tone)]


def leaf(x, y, length, tone, turn=0):
    place = at(x, y, turn, length / 2)
    return [path(placed("M-1,0 C-0.5,-0.55 0.4,-0.55 1,0 C0.4,0.55 -0.5,0.55 -1,0 Z", place), fill=tone),
            path(placed("M-0.8,0 L0.6,0", place), fill="none", stroke=PAPER, stroke_width=0.8)]


def fillers():
    rng = random.Random(15)
    sample = Sample("fillers", "Flowers, leaves and dots",
                    "Flowers go first, then leaves; dots fill the room between them.")
    kinds = [("flower", 12.5, 13, 42), ("leaf", 8.5, 30, 22), ("dot", 2.6, 160, 0)]
    elements = []
    for x, y, kind in even(rng, 178, 220, kinds, 4.6):
        if kind == "flower":
            shapes = flower(x, y, 12.5, EMBER[1], EMBER[2], 6, rng.uniform(0, 60))
        elif kind == "leaf":
            shapes = leaf(x, y, 22, MEADOW[0], rng.uniform(0, 360))
        else:
            shapes = [circle(x, y, 2.6, fill=EMBER[2])]
        elements.append(named(kind, *shapes))
    sample.example(elements, x=14)
    sample.container("M396,24 H504 C502,50 488,64 486,84 C490,124 650,160 650,306 C650,400 570,450 516,476 H384 "
                     "C330,450 250,400 250,306 C250,160 410,124 414,84 C412,64 398,50 396,24 Z",
                     fill=PAPER, priority="flower leaf")
    sample.write()


# A print: meadow

def meadow():
    rng = random.Random(21)
    sample = Sample("meadow", "Meadow print",
                    "A half-drop repeat of poppies, asters, sprigs and buds, drawn with a free hand, over a "
                    "kimono; collar and sash are kept clear.")
    across, down = 24.5, 20
    elements = []
    for row in range(11):
        for column in range(7):
            x = across * (column + 0.5 * (row % 2)) + 12 + rng.uniform(-1.2, 1.2)
            y = down * row + 12 + rng.uniform(-1.2, 1.2)
            elements.append(meadow_flower(rng, x, y, 2 * (row % 2) + (column + row // 2) % 2))
    sample.example(elements, x=8)
    kimono(sample)
    sample.write()


def meadow_flower(rng, x, y, kind):
    if kind == 0:
        return named("poppy", *flower(x, y, 11.5, EMBER[1], DUSK[0], 5, rng.uniform(0, 72)))
    if kind == 1:
        return named("sprig", *sprig(x, y, MEADOW[1], rng.uniform(-130, -50)))
    if kind == 2:
        return named("aster", *flower(x, y, 9.5, DUSK[1], EMBER[2], 8, rng.uniform(0, 45)))
    return named("bud", *(circle(x + 4 * math.sin(a), y - 4 * math.cos(a), 2.3, fill=EMBER[2])
                          for a in (0, 2 * math.pi / 3, -2 * math.pi / 3)))


def sprig(x, y, tone, turn):
    """Three leaves on a stalk."""
    place = at(x, y, turn)
    blade = "M0,0 C2,-5 8,-5 11,0 C8,5 2,5 0,0 Z"
    leaves = [path(placed(blade, at(x - 1 * math.cos(math.radians(turn)), y - 1 * math.sin(math.radians(turn)),
                                    turn + lean, 0.95)), fill=tone) for lean in (-62, 0, 62)]
    return leaves + [path(placed("M-9,0 L2,0", place), fill="none", stroke=tone, stroke_width=1.4,
                          stroke_linecap="round")]


def kimono(sample):
    sample.container("M396,32 L450,200 L504,32 L690,62 V270 C660,276 620,276 576,268 V478 H324 V268 "
                     "C280,276 240,276 210,270 V62 Z", fill=PAPER)
    collar = "M390,26 L450,262 L510,26 L490,22 L450,176 L410,22 Z"
    sash = rectangle(320, 250, 580, 300)
    cords = "M320,261 H580 M320,289 H580"
    sample.fixed("collar", path(collar, fill=DUSK[0]))
    sample.fixed("sash", path(sash, fill=DUSK[0]), path(cords, fill="none", stroke=EMBER[2], stroke_width=2))


def main():
    for draw in (bricks, pebbles, cloth, confetti, linked_stones, scales, feathers, blocks, euro, fillers, meadow):
        draw()


if __name__ == "__main__":
    main()
