"""Draws the samples of recursive forms: a motif with its clones on the left, a frame for the
form on the right. Run `python3 samples/recurse/draw/all.py` from the top of the repository."""

import math
import os
from xml.sax.saxutils import escape

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# The frame that the form is fitted into, and the box of the motif beside it.
FRAME = (230, 20, 400, 400)
MOTIF = (20, 120, 190, 190)


class Affine:
    """An SVG matrix (a b c d e f): x' = a x + c y + e, y' = b x + d y + f. `A @ B` does B first."""

    def __init__(self, a=1, b=0, c=0, d=1, e=0, f=0):
        self.m = (a, b, c, d, e, f)

    def __matmul__(self, other):
        a, b, c, d, e, f = self.m
        p, q, r, s, t, u = other.m
        return Affine(a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s,
                      a * t + c * u + e, b * t + d * u + f)

    def __call__(self, point):
        a, b, c, d, e, f = self.m
        x, y = point
        return (a * x + c * y + e, b * x + d * y + f)


def move(x, y):
    return Affine(1, 0, 0, 1, x, y)


def turn(degrees, about=(0, 0)):
    """Turns clockwise on the page, where y runs downwards."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return move(*about) @ Affine(c, s, -s, c, 0, 0) @ move(-about[0], -about[1])


def scale(x, y=None, about=(0, 0)):
    y = x if y is None else y
    return move(*about) @ Affine(x, 0, 0, y, 0, 0) @ move(-about[0], -about[1])


def mirror(p, q):
    """Reflection in the line through two points."""
    angle = math.degrees(math.atan2(q[1] - p[1], q[0] - p[0]))
    return turn(angle, p) @ scale(1, -1, p) @ turn(-angle, p)


def similar(p, q, to_p, to_q, mirrored=False):
    """The similarity that takes p to to_p and q to to_q."""
    v, w = complex(q[0] - p[0], q[1] - p[1]), complex(to_q[0] - to_p[0], to_q[1] - to_p[1])
    z = w / (v.conjugate() if mirrored else v)
    linear = Affine(z.real, z.imag, z.imag, -z.real) if mirrored else Affine(z.real, z.imag, -z.imag, z.real)
    return move(*to_p) @ linear @ move(-p[0], -p[1])


def number(x):
    text = f"{x:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def points(*corners):
    """Path data through corners, open."""
    return "M" + " L".join(f"{number(x)},{number(y)}" for x, y in corners)


def polygon(*corners):
    return points(*corners) + " Z"


def shape(d, generations=None, **style):
    """A primitive: path data and its style, `stroke_width=2` and so on. `generations` is last or
    inner for one that is not drawn in every generation."""
    return ("shape", d, style, generations)


def clone(matrix, of=None):
    """A clone: where the motif goes; `of` names another form."""
    return ("clone", matrix, of, None)


def form(name, items, **params):
    """A form: its display list in paint order, and parameters such as depth=7, generations='last'."""
    return (name, items, params)


def write(name, title, description, *forms, fit=None, background=None, frame=FRAME, size=(650, 440)):
    """Writes a sample. `fit` is the box (x, y, width, height) in the forms' own coordinates that
    goes into the box of the motif; more forms than one are drawn below each other by it."""
    x, y, width, height = fit
    s = min(MOTIF[2] / width, MOTIF[3] / height / len(forms))
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:rinceau="urn:rinceau:1" '
        f'width="{size[0]}" height="{size[1]}" viewBox="0 0 {size[0]} {size[1]}">',
        f"  <title>{escape(title)}</title>",
        f"  <desc>{escape(description)}</desc>",
    ]
    if background:
        lines.append(f'  <rect width="{size[0]}" height="{size[1]}" fill="{background}"/>')
    lines.append('  <rect id="frame" class="rinceau-container" rinceau:role="container" inkscape:label="Frame" '
                 f'x="{frame[0]}" y="{frame[1]}" width="{frame[2]}" height="{frame[3]}" rx="6" '
                 'fill="none" stroke="#cccccc" stroke-width="0.5"/>')
    for index, (form_name, items, params) in enumerate(forms):
        left = MOTIF[0] + (MOTIF[2] - s * width) / 2
        top = MOTIF[1] + MOTIF[3] * index / len(forms) + (MOTIF[3] / len(forms) - s * height) / 2
        place = f"matrix({number(s)} 0 0 {number(s)} {number(left - s * x)} {number(top - s * y)})"
        own = "".join(f' rinceau:{key.replace("_", "-")}="{value}"' for key, value in params.items())
        lines.append(f'  <g id="{form_name}" class="rinceau-form" rinceau:role="form" '
                     f'inkscape:label="{escape(form_name)}"{own} transform="{place}">')
        firsts = {f[0]: f"{f[0]}-1" for f in forms}
        shapes = clones = 0
        for kind, what, extra, generations in items:
            if kind == "shape":
                shapes += 1
                style = ";".join(f"{key.replace('_', '-')}:{value}" for key, value in extra.items())
                when = f' rinceau:generations="{generations}"' if generations else ""
                lines.append(f'    <path id="{form_name}-{shapes}"{when} d="{what}" style="{style}"/>')
            else:
                clones += 1
                of = f' rinceau:of="{extra}"' if extra and extra != form_name else ""
                href = firsts[extra or form_name]
                m = " ".join(number(v) for v in what.m)
                lines.append(f'    <use id="{form_name}-clone-{clones}" class="rinceau-clone" '
                             f'rinceau:role="clone"{of} xlink:href="#{href}" transform="matrix({m})"/>')
        lines.append("  </g>")
    lines.append("</svg>")
    with open(os.path.join(FOLDER, name + ".svg"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
