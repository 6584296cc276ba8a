# SPDX-License-Identifier: BSD-3-Clause
"""Draws performance profiles (Dolan and Moré, 2002) as SVG."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 760, 420, 60, 190, 44, 56
COLOURS = ("#d7301f", "#2166ac", "#1a9850", "#7b3294", "#e08214", "#777777", "#00838f", "#a6761d")


def profile(costs, rule):
    """Returns the sorted ratios of a rule's costs to the best of each case. `costs`: {case: {rule: cost, None: failure}}."""
    ratios = []
    for of in costs.values():
        known = [cost for cost in of.values() if cost]
        if known and of.get(rule):
            ratios.append(of[rule] / min(known))
    return sorted(ratios)


def draw(title, costs, rules, most=32.0):
    """Returns the picture: the share of cases that a rule solves within a factor of the best rule's cost."""
    def x(ratio):
        return LEFT + math.log(min(ratio, most)) / math.log(most) * (WIDTH - LEFT - RIGHT)

    def y(share):
        return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)

    def text(a, b, words, anchor="start", size=12, colour="#222222"):
        return f'<text x="{a:.1f}" y="{b:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{colour}">{escape(words)}</text>'

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
           'font-family="sans-serif">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', text(LEFT, 24, title, size=15)]
    for ratio in (1, 1.3, 2, 4, 8, 16, 32):
        out += [f'<line x1="{x(ratio):.1f}" y1="{y(0):.1f}" x2="{x(ratio):.1f}" y2="{y(1):.1f}" stroke="#e4e4e4"/>',
                text(x(ratio), y(0) + 18, f"{ratio:g}", "middle")]
    for share in (0, 0.25, 0.5, 0.75, 1):
        out += [f'<line x1="{x(1):.1f}" y1="{y(share):.1f}" x2="{x(most):.1f}" y2="{y(share):.1f}" stroke="#e4e4e4"/>',
                text(LEFT - 8, y(share) + 4, f"{100 * share:.0f} %", "end")]
    out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, "cost over that of the best rule on the same case", "middle"))
    for i, rule in enumerate(rules):
        colour, ratios = COLOURS[i % len(COLOURS)], profile(costs, rule)
        points = [(x(1), y(0))]
        for k, ratio in enumerate(ratios):
            if ratio <= most:
                points += [(x(ratio), y(k / len(costs))), (x(ratio), y((k + 1) / len(costs)))]
        points.append((x(most), points[-1][1]))
        out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="' +
                   " ".join(f"{a:.1f},{b:.1f}" for a, b in points) + '"/>')
        at = TOP + 14 + 20 * i
        out += [f'<line x1="{WIDTH - RIGHT + 14}" y1="{at}" x2="{WIDTH - RIGHT + 38}" y2="{at}" stroke="{colour}" '
                'stroke-width="2"/>', text(WIDTH - RIGHT + 44, at + 4, rule)]
    return "\n".join(out + ["</svg>", ""])
