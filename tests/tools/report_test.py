#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that report.html is one complete, self-contained page with the numbers of result.json.

usage: report_test.py PROGRAM [CHROMIUM]

Runs a block on two ranks and a plane body on one, with names that look like markup; reads the page as HTML and
compares its data with result.json. Then bodies under balls and moving planes, a plastic one, one that does not
converge, one without contact. With a browser it also opens the pages, which have to draw the body.
"""
import base64
import html.parser
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

NAME = 'a <b> & "c" \'d\' <!-- <script>'
ENTRY = "</script><script>document.body.textContent = 1</script> & <i>"
BLOCK = {
    "mesh": {"box": {"size": [2, 1, 1], "cells": [4, 2, 2], "element": "tet10"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "pressure": 0.1, "name": ENTRY}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
}
PLATE = {
    "output": {"scale": 7.5},
    "mesh": {"box": {"size": [2, 1], "cells": [8, 4], "element": "tri3"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0]}, {"on": "top", "pressure": 0.1, "name": ENTRY}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
}
BALL = {  # beyond yield, under a ball seen from below
    "output": {"quantity": "plastic", "view": [1, -2, 3]},
    "mesh": {"box": {"size": [2, 2, 1], "cells": [4, 4, 2], "element": "hex8"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3, "law": {"type": "power", "x0": 1e-3, "n": 0.5}}],
    "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}],
    "contact": [{"on": "top", "obstacle": {"sphere": {"centre": [1, 1, 2.98], "radius": 2}}}],
}
PUSHED = {  # pressed by a moving plane
    "output": {"quantity": "contact_pressure"},
    "mesh": {"box": {"size": [2, 1], "cells": [8, 4], "element": "tri3"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "bottom", "displacement": [0, 0]}],
    "contact": [{"on": "top", "obstacle": {"plane": {"point": [0, 1], "normal": [0, -1]}},
                 "motion": {"path": [{"time": 1, "translation": [0, -0.01]}]}}],
}
LIFTED = {  # moved away from its obstacle
    "output": {"quantity": "contact_pressure"},
    "mesh": {"box": {"size": [2, 1], "cells": [8, 4], "element": "tri3"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0]}, {"on": "top", "pressure": -0.1}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0], "normal": [0, 1]}}}],
}
DISC = {  # a ring pressed onto a ball
    "plane": "axisymmetric",
    "mesh": {"file": "ring.msh"},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": {"box": [[0.5, 1], [2.5, 1]]}, "displacement": [None, -0.01]}],
    "contact": [{"on": {"box": [[0.5, 0], [2.5, 0]]}, "obstacle": {"sphere": {"centre": [0, -9], "radius": 9.05}}}],
}
RING = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0.5 0 0
2 1.5 0 0
3 2.5 0 0
4 0.5 1 0
5 1.5 1 0
6 2.5 1 0
$EndNodes
$Elements
2
1 3 2 1 1 1 2 5 4
2 3 2 1 1 2 3 6 5
$EndElements
"""
VOID = {"meta", "img"}


class Page(html.parser.HTMLParser):
    """Rejects unbalanced tags and external resources; stores texts by tag and id."""

    def __init__(self):
        super().__init__()
        self.open, self.texts, self.pictures = [], {}, []

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        for name in ("src", "href", "srcset", "action"):
            if not attributes.get(name, "data:").startswith("data:"):
                raise SystemExit(f"<{tag} {name}={attributes[name]}> is outside of the page")
        if tag == "img":
            self.pictures.append(attributes["alt"])
        if tag not in VOID:
            self.open.append((tag, attributes.get("id", tag)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop()[0] != tag:
            raise SystemExit(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open:
            key = self.open[-1][1]
            self.texts[key] = self.texts.get(key, "") + data


def same(what, found, expected):
    if found != expected:
        raise SystemExit(f"{what}: expected {expected}, got {found}")


def near(what, found, expected):
    if abs(found - expected) > 1e-6 * abs(expected):
        raise SystemExit(f"{what}: expected {expected}, got {found}")


def unpacked(text, letter):
    data = base64.b64decode(text, validate=True)
    return struct.unpack(f"<{len(data) // 4}{letter}", data)


def check_page(folder):
    page = Page()
    text = (folder / "report.html").read_text(encoding="utf-8")
    page.feed(text)
    page.close()
    same("open tags", page.open, [])
    same("title", page.texts["title"], NAME)
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    same("result", json.loads(page.texts["result"]), result)
    same("history", json.loads(page.texts["history"]), (folder / "history.csv").read_text(encoding="utf-8"))
    if re.search(r"https?:|url\(", page.texts["style"] + page.texts["script"]):
        raise SystemExit("style or script name an address")
    scene = json.loads(page.texts["scene"])
    corners = unpacked(scene["corners"], "I")
    same("corners", len(corners), 3 * scene["triangles"])
    same("corners are nodes", max(corners) < scene["nodes"], True)
    u = unpacked(scene["displacement"], "f")
    same("displacements", len(u), 3 * scene["nodes"])
    near("largest displacement", max(sum(c * c for c in u[i:i + 3]) ** 0.5 for i in range(0, len(u), 3)),
         result["max_displacement"]["value"])
    fields = {field["name"]: unpacked(field["values"], "f") for field in scene["fields"]}
    # Corners of quadratic facets have no pressure of their own; their values may exceed the largest nodal one.
    pressure = max(fields["contact pressure"])
    if scene["dim"] == 2:
        near("largest pressure", pressure, result["max_contact_pressure"])
    same("pressure", pressure >= result["max_contact_pressure"] * (1 - 1e-6), True)
    same("scale", scene["scale"], result["case"].get("output", {}).get("scale", 0))
    same("marks", [(mark["kind"], mark["name"]) for mark in scene["marks"]],
         [("support", "boundary[0]"), ("load", ENTRY), ("contact", "contact[0]")])
    for mark in scene["marks"]:
        same("marked nodes", 0 < len(unpacked(mark["nodes"], "I")) < scene["nodes"], True)


def opened(browser, folder):
    """Returns the page as the browser has it after its script has run."""
    done = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=5000", "--dump-dom",
         (folder / "report.html").as_uri()], capture_output=True, text=True, check=False, timeout=120)
    return done.stdout


def check_in_browser(browser, folder):
    shown = opened(browser, folder)
    same("drawn", 'data-view="drawn"' in shown, True)
    return shown


def check_other(program, browser, folder):
    """Checks what the page draws, and its text where there is nothing to draw."""
    def run(case, *words, code=0):
        (folder / "case.json").write_text(json.dumps(case))
        done = subprocess.run([program, "run", "case.json", "--output", "out", *words], cwd=folder, capture_output=True,
                              text=True, check=False)
        same(f"exit code with {done.stderr}", done.returncode, code)
        page = Page()
        page.feed((folder / "out" / "report.html").read_text(encoding="utf-8"))
        shown = check_in_browser(browser, folder / "out") if browser else None
        return json.loads(page.texts["scene"]), page, (folder / "out" / "deformed.svg").read_text(), shown

    scene, _, picture, _ = run(BALL)
    same("names", [f["name"] for f in scene["fields"]],
         ["von Mises stress", "displacement", "contact pressure", "plastic share"])
    same("quantity", scene["fields"][scene["first"]]["name"], "plastic share")
    plastic = unpacked(scene["fields"][3]["values"], "f")
    same("shares", min(plastic) >= 0 and 0.5 < max(plastic) <= 1, True)
    same("view", scene["view"], [1, -2, 3])
    same("all shown", scene["not_shown"], [])
    corners = unpacked(scene["obstacles"], "f")
    same("obstacle", len(corners) > 0 and len(corners) % 9 == 0, True)
    centre = (0, 0, 2.98 - 0.5)  # the page's origin is the centre of the body
    for k in range(0, len(corners), 3):
        near("on the ball", sum((x - c) ** 2 for x, c in zip(corners[k:k + 3], centre)) ** 0.5, 2.0)
    for text in ("plastic<", "blue: held", "#dfe5e8"):
        same(f"{text} in the picture", text in picture, True)

    scene, _, picture, _ = run(PUSHED)
    same("quantity", scene["fields"][scene["first"]]["name"], "contact pressure")
    ends = unpacked(scene["obstacles"], "f")
    same("obstacle", len(ends), 8 * 2 * 3)
    for height in ends[1::3]:
        near("moved to", height + 0.5, 0.99)
    same("only plastic is missing", scene["not_shown"], ["No element is beyond yield: there is no plastic share."])
    same("pressure", "contact<" in picture and "largest von Mises" in picture, True)

    (folder / "ring.msh").write_text(RING)
    scene, _, picture, shown = run(DISC)
    near("axis", scene["axis"]["x"], -1.5)
    same("axis in the picture", ">axis<" in picture, True)
    same("axis on the page", shown is None or "chain line: axis of revolution" in shown, True)

    scene, page, _, shown = run(LIFTED)
    same("quantity", scene["fields"][scene["first"]]["name"], "von Mises stress")
    said = "Nothing touches: there is no contact pressure (output.quantity): von Mises stress is shown instead."
    same("said", said in scene["not_shown"], True)
    same("pictures", page.pictures, ["The deformed body"])
    same("said on the page", shown is None or said in shown, True)

    scene, page, _, shown = run(BLOCK, "--set", "solver.max_outer=1", "--set", "solver.tolerance=1e-13", code=1)
    result = json.loads(page.texts["result"])
    same("status", result["status"], "not_converged")
    same("pictures", page.pictures, ["The deformed body", "The contact pressure, seen from the obstacles"])
    same("status on the page", shown is None or (result["message"] in shown and ">not converged<" in shown), True)


def check_too_large(browser, folder):
    """Checks the page's text for an omitted body, from data without the body."""
    file = folder / "out" / "report.html"
    text = file.read_text(encoding="utf-8")
    begin = text.index('id="scene">') + len('id="scene">')
    end = text.index("</script>", begin)
    scene = json.loads(text[begin:end])
    kept = {key: scene[key] for key in ("dim", "nodes", "triangles", "most", "not_shown")}
    kept["triangles"] = kept["most"] + 1
    file.write_text(text[:begin] + json.dumps(kept) + text[end:], encoding="utf-8")
    same("too large", "more than the 400000 that a page can hold well" in opened(browser, folder / "out"), True)


def main():
    program = os.path.abspath(sys.argv[1])
    browser = sys.argv[2] if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for place, case, ranks in (("block", BLOCK, "2"), ("plate", PLATE, "1")):
            (folder / f"{NAME}.json").write_text(json.dumps(case))
            done = subprocess.run([program, "run", f"{NAME}.json", "--output", place, "--ranks", ranks], cwd=folder,
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0 or done.stderr:
                raise SystemExit(f"{place}: {done.stderr}")
            check_page(folder / place)
            if browser:
                shown = check_in_browser(browser, folder / place)
                same("entry as text", "&lt;/script&gt;&lt;script&gt;document.body" in shown, True)
        check_other(program, browser, folder)
        if browser:
            check_too_large(browser, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
