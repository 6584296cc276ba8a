# SPDX-License-Identifier: BSD-3-Clause
"""Draws contact iterations and CPU time against the penalty r, both axes logarithmic, as SVG."""
import math
from xml.sax.saxutils import escape

WIDTH, PANEL, LEFT, RIGHT, TOP, GAP, BOTTOM = 760, 250, 70, 20, 56, 34, 84
COLOURS = ("#d7301f", "#2166ac", "#1a9850")
MARKS = {"r*": "#222222", "r_A": "#7b3294", "automatic": "#e08214", "printed": "#777777"}


class Axis:
    def __init__(self, values, start, end):
        self.low, self.high = math.log10(min(values) / 1.15), math.log10(max(values) * 1.15)
        self.start, self.end = start, end

    def at(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self):
        """Returns powers of ten, with 2 and 5 times them if there are few."""
        powers = range(math.floor(self.low), math.ceil(self.high) + 1)
        steps = (1, 2, 5) if self.high - self.low < 2.2 else (1,)
        return [m * 10.0 ** e for e in powers for m in steps if self.low <= math.log10(m * 10.0 ** e) <= self.high]


def line(x1, y1, x2, y2, colour, dash=""):
    return (f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"' +
            (f' stroke-dasharray="{dash}"' if dash else "") + "/>")


def text(x, y, words, anchor="start", size=12, colour="#222222", turn=0):
    turned = f' transform="rotate({turn} {x:.1f} {y:.1f})"' if turn else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{colour}"{turned}>{escape(words)}</text>'


def panel(curves, key, title, x, top, marks):
    values = [p[key] for c in curves for p in c["points"] if p.get(key)]
    y = Axis(values, top + PANEL, top)
    out = []
    for tick in x.ticks():
        out.append(line(x.at(tick), top, x.at(tick), top + PANEL, "#e4e4e4"))
        out.append(text(x.at(tick), top + PANEL + 16, f"{tick:g}", "middle"))
    for tick in y.ticks():
        out += [line(LEFT, y.at(tick), WIDTH - RIGHT, y.at(tick), "#e4e4e4"), text(LEFT - 6, y.at(tick) + 4, f"{tick:g}", "end")]
    out.append(text(20, top + PANEL / 2, title, "middle", turn=-90))
    for label, r in marks:
        out.append(line(x.at(r), top, x.at(r), top + PANEL, MARKS[label], "5 4"))
    for colour, curve in zip(COLOURS, curves):
        known = [(x.at(p["r"]), y.at(p[key])) for p in curve["points"] if p.get(key)]
        out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.8" points="' +
                   " ".join(f"{a:.1f},{b:.1f}" for a, b in known) + '"/>')
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{colour}"/>' for a, b in known]
    return out


def draw(title, curves, marks):
    """Returns the picture. `curves`: {"label", "points": [{"r", "iterations", "cpu"}]}; None: not converged. `marks`:
    {label of MARKS: r}; those outside the range of the curves are left out."""
    reach = [p["r"] for c in curves for p in c["points"]]
    x = Axis(reach, LEFT, WIDTH - RIGHT)
    shown = [(label, r) for label, r in marks.items() if r and min(reach) <= r <= max(reach)]
    height = TOP + 2 * PANEL + GAP + BOTTOM
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
           'font-family="sans-serif">', f'<rect width="{WIDTH}" height="{height}" fill="white"/>', text(LEFT, 22, title, size=15)]
    step = (WIDTH - LEFT - RIGHT) / 4
    for i, (label, r) in enumerate(shown):
        out += [line(LEFT + i * step, 40, LEFT + i * step + 22, 40, MARKS[label], "5 4"),
                text(LEFT + i * step + 28, 44, f"{label} {r:.3g}")]
    out += panel(curves, "iterations", "contact iterations", x, TOP, shown)
    out += panel(curves, "cpu", "CPU time, s", x, TOP + PANEL + GAP, shown)
    below = TOP + 2 * PANEL + GAP
    out.append(text((LEFT + WIDTH - RIGHT) / 2, below + 34, "penalty r", "middle"))
    for i, (colour, curve) in enumerate(zip(COLOURS, curves)):
        at = LEFT + i * (WIDTH - LEFT - RIGHT) / 3
        out += [line(at, below + 60, at + 22, below + 60, colour), text(at + 28, below + 64, curve["label"])]
    return "\n".join(out + ["</svg>", ""])
