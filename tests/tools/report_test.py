#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Is report.html one whole page that needs nothing else, with the numbers of result.json?

usage: report_test.py PROGRAM [CHROMIUM]

Runs a block on two ranks and a plane body on one, with names that look like markup; reads the page as HTML and
compares the data in it with result.json. With a browser the page is opened too, and has to draw the body.
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
VOID = {"meta", "img"}


class Page(html.parser.HTMLParser):
    """Refuses tags that do not match and everything that would be fetched; keeps texts by tag and id."""

    def __init__(self):
        super().__init__()
        self.open, self.texts = [], {}

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        for name in ("src", "href", "srcset", "action"):
            if not attributes.get(name, "data:").startswith("data:"):
                raise SystemExit(f"<{tag} {name}={attributes[name]}> is outside of the page")
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
    # The corners of quadratic facets have no pressure of their own, and may lie above the largest of a node.
    pressure = max(fields["contact pressure"])
    if scene["dim"] == 2:
        near("largest pressure", pressure, result["max_contact_pressure"])
    same("pressure", pressure >= result["max_contact_pressure"] * (1 - 1e-6), True)
    same("scale", scene["scale"], result["case"].get("output", {}).get("scale", 0))
    same("marks", [(mark["kind"], mark["name"]) for mark in scene["marks"]],
         [("support", "boundary[0]"), ("load", ENTRY), ("contact", "contact[0]")])
    for mark in scene["marks"]:
        same("marked nodes", 0 < len(unpacked(mark["nodes"], "I")) < scene["nodes"], True)


def check_in_browser(browser, folder):
    done = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=5000", "--dump-dom",
         (folder / "report.html").as_uri()], capture_output=True, text=True, check=False, timeout=120)
    same("drawn", 'data-view="drawn"' in done.stdout, True)
    same("entry as text", "&lt;/script&gt;&lt;script&gt;document.body" in done.stdout, True)


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for place, case, ranks in (("block", BLOCK, "2"), ("plate", PLATE, "1")):
            (folder / f"{NAME}.json").write_text(json.dumps(case))
            done = subprocess.run([program, "run", f"{NAME}.json", "--output", place, "--ranks", ranks], cwd=folder,
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0 or done.stderr:
                raise SystemExit(f"{place}: {done.stderr}")
            check_page(folder / place)
            if len(sys.argv) > 2:
                check_in_browser(sys.argv[2], folder / place)
    return 0


if __name__ == "__main__":
    sys.exit(main())
