#!/usr/bin/env python3
"""Draws grow.svg: artwork that a generator bends along grown lines or puts on grown discs.

Run it from anywhere; it rewrites grow.svg next to itself, the same bytes every time.

A line artwork lies along the x axis from 0 (base) to 100 (tip); a round one lies around the
origin within radius 50 and faces right. The y axis points down. A point is a complex number, a
curve is a list of cubics (p0, c1, c2, p3). Curves are written down as nodes, and Hobby's method
chooses the handles.
"""
import cmath
import math
import os

DARK, MID, ACCENT, LIGHT = "#111111", "#555555", "#999999", "#dddddd"
KAPPA = 0.5522847498


# ---- curves ---------------------------------------------------------------------------------

def unit(degrees):
    return cmath.exp(1j * math.radians(degrees))


def polar(r, degrees):
    return r * unit(degrees)


def velocity(a, b):
    """Handle length, as a share of the chord, at the end with angle a (b at the other end)."""
    sa, sb, ca, cb = math.sin(a), math.sin(b), math.cos(a), math.cos(b)
    top = 2 + math.sqrt(2) * (sa - sb / 16) * (sb - sa / 16) * (ca - cb)
    low = 1 + (math.sqrt(5) - 1) / 2 * ca + (3 - math.sqrt(5)) / 2 * cb
    return min(max(top / low / 3, 0.05), 1.2)


def wrap(angle):
    return (angle + math.pi) % (2 * math.pi) - math.pi


def run(points, start, end):
    """A smooth curve through points; start and end are directions in degrees or None."""
    n = len(points) - 1
    chord = [points[i + 1] - points[i] for i in range(n)]
    length = [abs(c) for c in chord]
    turn = [0.0] + [wrap(cmath.phase(chord[i] / chord[i - 1])) for i in range(1, n)] + [0.0]
    rows = [[0.0] * (n + 1) for _ in range(n + 1)]
    right = [0.0] * (n + 1)
    if start is None:
        rows[0][0], rows[0][1], right[0] = 1.0, 1.0, -turn[1]
    else:
        rows[0][0], right[0] = 1.0, wrap(math.radians(start) - cmath.phase(chord[0]))
    for i in range(1, n):
        a, b = 1 / length[i - 1], 1 / length[i]
        rows[i][i - 1], rows[i][i], rows[i][i + 1] = a, 2 * (a + b), b
        right[i] = -2 * a * turn[i] - b * turn[i + 1]
    if end is None:
        rows[n][n - 1], rows[n][n] = 1.0, 1.0
    else:
        rows[n][n], right[n] = 1.0, wrap(math.radians(end) - cmath.phase(chord[n - 1]))
    for i in range(n + 1):
        best = max(range(i, n + 1), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best], right[i], right[best] = rows[best], rows[i], right[best], right[i]
        for k in range(i + 1, n + 1):
            f = rows[k][i] / rows[i][i]
            if f:
                rows[k] = [x - f * y for x, y in zip(rows[k], rows[i])]
                right[k] -= f * right[i]
    theta = [0.0] * (n + 1)
    for i in range(n, -1, -1):
        rest = sum(rows[i][k] * theta[k] for k in range(i + 1, n + 1))
        theta[i] = (right[i] - rest) / rows[i][i]
    out = []
    for i in range(n):
        a = theta[i]
        b = -turn[i + 1] - theta[i + 1] if i + 1 < n else -theta[n]
        c1 = points[i] + chord[i] * cmath.exp(1j * a) * velocity(a, b)
        c2 = points[i + 1] - chord[i] * cmath.exp(-1j * b) * velocity(b, a)
        out.append((points[i], c1, c2, points[i + 1]))
    return out


def curve(*nodes):
    """An open curve through nodes: (x, y) smooth, (x, y, d) with the direction d, (x, y, i, o) a
    corner that arrives with direction i and leaves with o (None: free)."""
    cubics, points, start = [], [], None
    for k, node in enumerate(nodes):
        points.append(complex(node[0], node[1]))
        if k == 0:
            start = node[-1] if len(node) > 2 else None
        elif len(node) > 2 or k == len(nodes) - 1:
            cubics += run(points, start, node[2] if len(node) > 2 else None)
            points, start = [points[-1]], node[-1] if len(node) > 2 else None
    return cubics


def line(*points):
    points = [complex(*p) for p in points]
    return [(p, p + (q - p) / 3, q - (q - p) / 3, q) for p, q in zip(points, points[1:])]


def graph(width, at):
    """The curve y = -width(x) with nodes at the given x."""
    out = []
    for a, b in zip(at, at[1:]):
        h, e = (b - a) / 3, 1e-4
        slope = [(width(x + e) - width(x - e)) / (2 * e) for x in (a, b)]
        out.append((complex(a, -width(a)), complex(a + h, -width(a) - slope[0] * h),
                    complex(b - h, -width(b) + slope[1] * h), complex(b, -width(b))))
    return out


def quarter(p, q, direction):
    """A quarter of an ellipse from p to q that leaves p along the given axis direction."""
    d = unit(direction)
    along = ((q - p) * d.conjugate()).real
    across = (q - p) - along * d
    return [(p, p + KAPPA * along * d, q - KAPPA * across, q)]


def back(cubics):
    return [(d, c, b, a) for a, b, c, d in reversed(cubics)]


def flip(cubics):
    return [tuple(p.conjugate() for p in c) for c in cubics]


def both(upper):
    """Closes a curve from base to tip with its mirror image below the axis."""
    return upper + back(flip(upper))


def move(cubics, turn=0.0, by=0j, scale=1.0):
    f = scale * unit(turn)
    return [tuple(f * p + by for p in c) for c in cubics]


def stretch(cubics, x, y):
    return [tuple(complex(p.real * x, p.imag * y) for p in c) for c in cubics]


def ellipse(a, b=None, at=0j):
    b = a if b is None else b
    upper = quarter(-a + 0j, -1j * b, -90) + quarter(-1j * b, a + 0j, 0)
    return move(both(upper), by=at)


def ends(cubic):
    a, b, c, d = cubic
    first = next(p - a for p in (b, c, d) if abs(p - a) > 1e-9)
    last = next(d - p for p in (c, b, a) if abs(d - p) > 1e-9)
    return first / abs(first), last / abs(last)


def grown(cubics, by):
    """A closed curve grown outward (it runs clockwise on screen), with sharp corners kept."""
    n = len(cubics)
    node = []
    for i in range(n):
        last, first = ends(cubics[i - 1])[1], ends(cubics[i])[0]
        m1, m2 = last * -1j, first * -1j
        middle = m1 + m2
        share = (middle * middle.conjugate()).real / 4
        node.append(cubics[i][0] + by * middle / 2 / max(share, 0.2))
    out = []
    for i, (a, b, c, d) in enumerate(cubics):
        p, q = node[i], node[(i + 1) % n]
        f = abs(q - p) / abs(d - a)
        out.append((p, p + (b - a) * f, q + (c - d) * f, q))
    return out


# ---- pieces of artwork ------------------------------------------------------------------------

def stroke(width, at, base, tip):
    """A stroke from 0 to 100 with the half-width width(x) and round ends of the given lengths."""
    upper = graph(width, [base] + at + [100 - tip])
    a, b = upper[0][0], upper[-1][-1]
    return both(quarter(0j, a, -90) + upper + quarter(b, 100 + 0j, 0))


def stem():
    return [(DARK, stroke(lambda u: 1.6 + 6.4 * (1 - max(u - 4, 0) ** 1.35 / 96 ** 1.35),
                          [22, 42, 62, 82], 4.5, 1.6))]


def vine():
    return [(DARK, stroke(lambda u: 6.0, [26, 50, 74], 4, 4))]


def brush():
    return [(DARK, both(curve((0, 0, -22), (18, -7.3), (40, -11, 0), (60, -9.2), (80, -4.4),
                              (100, 0, 9))))]


def band(base, full, tip, w):
    fall = lambda u: w * (1 - (max(u - full, 0) / (tip - full)) ** 1.7)
    at = [full] + [full + (tip - full) * k / 3 for k in (1, 2)] + [tip]
    cap = min(3.5, w)
    upper = quarter(base + 0j, complex(base + cap, -w), -90)
    return both(upper + graph(fall, [base + cap] + at))


def ribbon():
    return [(DARK, band(0, 40, 100, 9)), (LIGHT, band(4.5, 40, 92, 5)), (ACCENT, band(9, 40, 83, 2))]


def rope():
    n, lean, w = 8, 15.0, 7.1
    step = (100 - 2 * 1.5 - lean) / n

    def strand(x, tuck):
        """One strand from the seam at x to the next; it goes on under the next one by tuck."""
        y = x + step
        seam = lambda x: curve((x, w, -18), (x + lean / 2, 0, -72), (x + lean, -w, -18))
        return (curve((y, w, None, None), ((x + y) / 2, 8, 180), (x, w, None)) + seam(x)
                + curve((x + lean, -w, None), ((x + y) / 2 + lean, -8, 0), (y + lean, -w, None))
                + curve((y + lean, -w, None, 140), (y + lean / 2 + tuck, 0, 108), (y, w, 174)))

    y = 1.5 + step
    first = (curve((y, w, None, None), (7.5, 8, 180), (0, 0.3, -90), (12, -8, 0), (y + lean, -w, None))
             + curve((y + lean, -w, None, 140), (y + lean / 2 + 1.5, 0, 108), (y, w, 174)))
    x = 100 - y - lean
    last = (curve((x, w, None, -18), (x + lean / 2, 0, -72), (x + lean, -w, -18, None), (92.5, -8, 0),
                  (100, -0.3, 90), (88, 8, 180), (x, w, None)))
    strands = [first] + [strand(1.5 + step * k, 1.5) for k in range(1, n - 1)] + [last]
    return [(MID if k % 2 else DARK, c) for k, c in enumerate(strands)]


def leafy():
    """A sprig; each leaf is a small acanthus of two lobes and a curling tip."""
    shape = curve((0, 0, None, -78), (2.4, -6.6), (7.2, -10, 0), (11.5, -8.6, 40, -72), (14, -13.4),
                  (19, -15.6, -2), (28, -15, -14, 152), (17.5, -7), (12, 0, 112, 180), (0, 0, 180))
    out = []
    for u, x, y in ((74, 0.62, 0.6), (58, 0.8, 0.79), (41, 0.92, 0.94), (23, 1, 1.02), (5, 1, 1)):
        leaf = move(stretch(shape, x, y), by=complex(u, 0))
        out += [(MID, leaf), (MID, back(flip(leaf)))]
    rib = lambda u: 0.9 + 2.0 * (1 - u / 88)
    out.append((DARK, both(quarter(0j, complex(3, -rib(3)), -90) + graph(rib, [3, 22, 43, 64, 83])
                           + curve((83, -rib(83), None, -35), (90, -3.6, 0), (100, 0, 20)))))
    return out


def beads():
    out, x = [], 0.0
    sizes = [(9.0, 10.0), (5.2, 7.6), (8.0, 8.8), (4.7, 6.6), (7.1, 7.5), (4.1, 5.5), (6.1, 6.1),
             (3.5, 4.4), (5.1, 4.6)]
    lap = 0.7
    total = sum(2 * a for a, _ in sizes) - lap * (len(sizes) - 1)
    for k, (a, b) in enumerate(sizes):
        a *= (100 + lap * 8) / (total + lap * 8)
        out.append((ACCENT if k % 2 else DARK, ellipse(a, b, complex(x + a, 0))))
        x += 2 * a - lap
    return out[1::2] + out[0::2]


def acanthus():
    """Fingers that swell and curl away from the rib, each one over the next."""
    finger = curve((0, 0, None, -30), (8, -7), (17.6, -16, -12), (26, -11, 96), (20.5, -6, 200),
                   (17.5, 0, 85, 180), (0, 0, 180))
    edge = curve((66, 0, None, -42), (74, -7), (83, -8.4, 4), (100, 0, 17, 180), (66, 0, 180))
    tip = curve((68, 0.6, None, -42), (75, -5.4), (83, -6.8, 4), (96, -1, 20, 177), (68, 0.6, None))
    out = [(DARK, curve((14, 0, None, -30), (40, -6, 0), (80, 0, None, 180), (14, 0, 180))),
           (DARK, edge), (MID, tip)]
    for u, x, y in ((56, 0.96, 0.64), (38, 1.02, 0.78), (20, 1.08, 0.9), (2, 1.08, 0.84)):
        leaf = move(stretch(finger, x, y), by=complex(u, 0))
        out += [(DARK, grown(leaf, 1.5)), (MID, leaf)]
    rib = curve((0, 0, None, -90), (4, -3, 4), (28, -1.4), (52, -0.6), (76, -0.4), (100, 0, 2, None)) \
        + curve((100, 0, 176), (76, 2.4), (52, 4.2), (28, 4.8, 180), (5, 4, 184), (0, 0, -90))
    out.append((DARK, rib))
    return out


def leaf():
    blade = curve((5, 0, None, -62), (20, -15.5), (37, -20, 3), (58, -14), (78, -5.4), (100, 0, 4, 160),
                  (84, 9.6), (62, 17.6), (42, 17.4), (22, 9.5), (5, 0, 205))
    rib = curve((0, 0, None, -90), (2.5, -2.6, 0), (24, -0.4), (46, 0.2), (68, -0.2), (92, 0.6, None),
                (68, 2.2), (46, 3.6), (24, 3.4), (2.5, 2.6, 180), (0, 0, -90))
    return [(MID, blade), (DARK, rib)]


def willow():
    upper = curve((9, 0, None, -30), (24, -6.2), (42, -9, 0), (62, -7.6), (82, -3.6), (100, 0, 8, None))
    under = curve((100, 0, 178), (75, 1.5), (50, 2.6), (30, 2), (9, 0, 200))
    dark = curve((0, 0, None, -90), (2, -1.9, 0), (14, -1.5), (30, 0.2), (50, 0.6), (75, -0.4),
                 (100, 0, None, 174), (82, 3.2), (63, 7.4), (44, 9, 180), (24, 5.4), (11, 2, 183),
                 (2, 1.9, 180), (0, 0, -90))
    return [(MID, upper + under), (DARK, dark)]


def drop():
    outer = both(curve((0, 0, -3), (24, -5), (48, -15.5), (73, -22, 0), (100, 0, 90)))
    inner = both(curve((36, 0, -4), (54, -5.4), (75, -12, 0), (90, 0, 90)))
    return [(ACCENT, outer), (LIGHT, inner)]


def hook():
    return [(DARK, curve((0, 0, None, -6), (22, -3.6), (44, -7.4), (66, -10.6), (84, -12, 0), (100, 0, 90),
                         (85, 12, 180), (72, 6), (60, -1.6), (42, -3.4), (22, -1.6), (0, 0, 176, None)))]


def petal():
    outer = both(curve((0, 0, -8), (16, -5.5), (34, -19), (51, -24, 0), (70, -16), (84, -5.5),
                       (100, 0, 8)))
    inner = both(curve((11, 0, -10), (22, -5.4), (37, -15.8), (51, -19.6, 0), (67, -13), (78, -5),
                       (90, 0, 12)))
    vein = both(curve((0, 0, -10), (26, -2.2, 0), (60, 0, 5)))
    return [(DARK, outer), (ACCENT, inner), (DARK, vein)]


def quote():
    body = curve((0, 0, -90), (12, -15.5), (29, -20, 0), (47, -14), (64, -7), (82, -8.5),
                 (100, -17, -33, 116), (89, 0.4), (70, 13.4), (50, 19), (30, 20, 180), (9, 14), (0, 0, -90))
    return [(MID, body), (LIGHT, ellipse(13, 9, 31 + 0j))]


def dot():
    return [(DARK, ellipse(50))]


def ring():
    return [(DARK, ellipse(50)), (LIGHT, ellipse(38)), (DARK, ellipse(27)), (ACCENT, ellipse(18))]


def around(n, shape, phase=0.0):
    return [move(shape, 360 / n * k + phase) for k in range(n)]


def rosette():
    sepal = both(curve((20, 0, -90), (34, -9, 0), (45.8, 0, 20)))
    heart = both(curve((9, 0, -50), (21, -12.6), (35, -18, -8), (44.6, -9.2, 82), (38.2, 0, 150, None)))
    out = [(DARK, ellipse(26))]
    for shape, colour, phase in ((sepal, MID, 36), (heart, ACCENT, 0)):
        out += [(DARK, s) for s in around(5, grown(shape, 2.4), phase)]
        out += [(colour, s) for s in around(5, shape, phase)]
    out.append((DARK, ellipse(14)))
    out += [(LIGHT, ellipse(2.6, at=polar(8, a))) for a in (36, 108, 180, 252, 324)]
    out.append((LIGHT, ellipse(2.6)))
    return out


def daisy():
    ray = both(curve((8, 0, -60), (24, -6.2), (37, -10.4, -4), (46.6, 0, 90)))
    edge = []
    for k in range(10):
        edge += move(curve((*_xy(polar(46.5, -18)), None, None), (50, 0, 90), (*_xy(polar(46.5, 18)), None, None)),
                     36 * k)
    out = [(DARK, edge)]
    out += [(LIGHT, s) for s in around(10, ray)]
    out += [(DARK, ellipse(19)), (ACCENT, ellipse(14.5))]
    return out


def _xy(p):
    return p.real, p.imag


def frill(r, half, depth):
    """A petal of three scallops: tip radius r, half its opening angle, depth of the scallops."""
    p = lambda radius, angle: _xy(polar(radius, -angle))
    return both(curve((4, 0, -half), p(r * 0.62, half * 0.86), p(r * 0.88, half * 0.8),
                      (*p(r * 0.97 - depth, half * 0.4), None, None), (r, 0, 90)))


def peony():
    out = []
    for n, r, phase, colour in ((7, 47.2, 180 / 7, MID), (7, 35.5, 0, ACCENT), (5, 23, 36, LIGHT)):
        half, depth = 180 / n, r * 0.05
        out.append((DARK, ellipse(r * 0.7)))
        out += [(DARK, s) for s in around(n, frill(r + 2.8, half * (1.12 + 3 / r), depth), phase)]
        out += [(colour, s) for s in around(n, frill(r, half, depth), phase)]
    out.append((DARK, ellipse(8)))
    return out


def pointed(length, width, bend=0.0, full=0.5):
    """An ogee petal from the origin to the right, widest at the share full of its length; bend
    moves its tip aside."""
    shape = both(curve((0, 0, -40), (length * full * 0.45, -width * 0.75), (length * full, -width, 0),
                       (length * (full + 1.1) / 2.1, -width * 0.5), (length, 0, 12)))
    return [tuple(complex(p.real, p.imag + bend * (p.real / length) ** 2) for p in c) for c in shape]


def lotus():
    base, out = -30 + 0j, []

    def add(turn, length, width, bend, full, colour):
        shape = pointed(length, width, bend, full)
        for side in ((False,) if turn == 0 else (False, True)):
            for c, by in ((DARK, 2.2), (colour, 0)):
                piece = move(grown(shape, by), turn, base)
                out.append((c, back(flip(piece)) if side else piece))

    add(63, 50, 10, 2, 0.66, MID)
    add(22, 73, 12.5, 0, 0.68, MID)
    add(84, 36.6, 8, 5, 0.5, ACCENT)
    add(42.5, 64, 11, 1, 0.5, ACCENT)
    add(0, 77.5, 12.5, 0, 0.5, ACCENT)
    cup = [pointed(33, 8)] + [move(pointed(29, 7.5), a) for a in (48, -48)]
    out += [(DARK, move(c, by=-43 + 0j)) for c in cup]
    out.append((DARK, ellipse(8, 8.5, -42 + 0j)))
    return out


def bud():
    egg = both(curve((-36, 0, -90), (-24, -26), (-2, -36, 0), (25, -22), (50, 0, 30)))
    inner = both(curve((-33, 0, -90), (-22, -24), (-2, -33, 0), (23.5, -19.6), (44, 0, 32)))
    front = both(curve((-26, 0, -90), (-18, -14), (-1, -18, 0), (22, -11.5), (44, 0, 22)))
    out = [(DARK, egg), (ACCENT, inner), (DARK, grown(front, 2)), (ACCENT, front)]
    out.append((LIGHT, both(curve((5, 0, -30), (15, -4.6, 0), (33, 0, 16)))))
    sepal = curve((-46, 0, None, -86), (-40, -20), (-24, -35), (-6, -42.5), (14, -48, -6, 140), (-5, -37),
                  (-21, -24), (-28, -12), (-29, 0, 90, 180), (-46, 0, 180))
    heart = both(curve((-40, 0, -90), (-27, -12, 0), (0, 0, 16)))
    knob = ellipse(8, 9, -42 + 0j)
    out += [(DARK, sepal), (DARK, back(flip(sepal))), (DARK, heart), (DARK, knob)]
    return out


def star():
    tip, dip, out = 50 + 0j, polar(24, 22.5), []
    whole, dark = [], []
    for k in range(8):
        t, d, e = (_xy(move([(p,) * 4], 45 * k)[0][0]) for p in (tip, dip, dip.conjugate()))
        whole += line(e, t, d)
        dark.append(line((0, 0), e, t, (0, 0)))
    return [(MID, whole)] + [(DARK, d) for d in dark] + [(LIGHT, ellipse(11))]


# ---- the sheet --------------------------------------------------------------------------------

SHEET = [
    ("line", [("stem", "Tapering stem", "strokes", stem), ("vine", "Even stroke", "strokes", vine),
              ("brush", "Brush stroke", "strokes", brush), ("ribbon", "Ribbon", "strokes", ribbon),
              ("rope", "Rope", "strokes", rope), ("leafy", "Leafy sprig", "sprigs", leafy),
              ("beads", "Beads", "strokes", beads)]),
    ("line", [("acanthus", "Acanthus scroll", "sprigs", acanthus), ("leaf", "Broad leaf", "leaves", leaf),
              ("willow", "Willow leaf", "leaves", willow), ("drop", "Drop", "leaves", drop),
              ("hook", "Comma", "leaves", hook), ("petal", "Ogee petal", "leaves", petal),
              ("quote", "Paisley", "leaves", quote)]),
    ("round", [("dot", "Dot", "discs", dot), ("ring", "Ring", "discs", ring),
               ("rosette", "Rosette", "flowers", rosette), ("daisy", "Daisy", "flowers", daisy),
               ("peony", "Peony", "flowers", peony), ("lotus", "Lotus", "flowers", lotus),
               ("bud", "Bud", "flowers", bud), ("star", "Star", "discs", star)]),
]


def number(x):
    text = f"{x:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def pair(p):
    return number(p.real) + "," + number(p.imag)


def data(cubics):
    text = "M" + pair(cubics[0][0])
    for a, b, c, d in cubics:
        text += f" C{pair(b)} {pair(c)} {pair(d)}"
    return text + "Z"


def merged(shapes):
    """Neighbours in paint order of one colour become one path."""
    out = []
    for colour, cubics in shapes:
        if out and out[-1][0] == colour:
            out[-1][1].append(cubics)
        else:
            out.append((colour, [cubics]))
    return out


def sheet():
    body = []
    for row, (kind, items) in enumerate(SHEET):
        step = 132 if kind == "line" else 116
        for column, (name, label, family, draw) in enumerate(items):
            x = 24 + step * column + (0 if kind == "line" else 48)
            y = 40 + 64 * row + (0 if kind == "line" else 28)
            body.append(f'  <g id="{name}" class="rinceau-element" rinceau:role="element" rinceau:kind="{kind}" '
                        f'rinceau:set="{family}" inkscape:label="{label}" transform="translate({x},{y})">')
            for colour, contours in merged(draw()):
                body.append(f'    <path d="{" ".join(data(c) for c in contours)}" fill="{colour}" fill-rule="nonzero"/>')
            body.append(f'    <path class="rinceau-spine" rinceau:role="spine" d="M0,0 H{100 if kind == "line" else 50}" '
                        'fill="none" stroke="#ff0000" stroke-width="0.5"/>')
            body.append("  </g>")
    return ('<svg xmlns="http://www.w3.org/2000/svg" '
            'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:rinceau="urn:rinceau:1" '
            'width="940" height="260" viewBox="0 0 940 260">\n'
            "  <title>Rinceau grow elements</title>\n" + "\n".join(body) + "\n</svg>\n")


if __name__ == "__main__":
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "grow.svg"), "w", encoding="utf-8", newline="\n") as file:
        file.write(sheet())
