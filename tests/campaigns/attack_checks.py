# SPDX-License-Identifier: BSD-3-Clause
"""Runs a case and its twins, and checks the answers by the verifier, a tighter tolerance and the twins."""
import contextlib
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import zlib
from array import array
from dataclasses import dataclass, field

TIGHT = 1e-9
CANNOT_TELL = ("relinearise", "load step before", "file of temperatures", "reference")  # messages of verify
ENTRIES = ("equilibrium", "penetration", "complementarity", "force_balance", "duality_gap")


class Hang(Exception):
    """A command that did not end in time."""


@dataclass
class Done:
    code: int
    out: str
    err: str


def members(session):
    """Yields id, state and CPU seconds of every process in a session."""
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            words = stat.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue  # it has ended
        if int(words[3]) == session:
            yield int(stat.parent.name), words[0], (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def starved(session, limit):
    """Returns whether the session lacks CPU time: stopped, or ready to run with less than half of what it could use."""
    found = list(members(session))
    states = [state for _, state, _ in found]
    cores = min(states.count("R"), os.cpu_count())
    return "T" in states or sum(seconds for *_, seconds in found) < cores * limit / 2


def end(process):
    """Kills a command and the ranks that it started; returns their CPU seconds."""
    used = 0.0
    for pid, _, seconds in list(members(process.pid)):
        used += seconds
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    process.wait()
    return used


def call(program, *arguments, folder, limit):
    """Runs the program in its own session, whose processes end with the call."""
    # Separates Open MPI's files of concurrent runs, also if ctest has set a folder for them.
    environment = {**os.environ, "TMPDIR": str(folder), "OMPI_MCA_orte_tmpdir_base": str(folder)}
    process = subprocess.Popen([str(program), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True, env=environment, start_new_session=True, cwd=folder)
    try:
        for turn in range(10):
            with contextlib.suppress(subprocess.TimeoutExpired):
                out, err = process.communicate(timeout=limit)
                return Done(process.returncode, out, err)
            if not starved(process.pid, limit):
                break
        states = "".join(sorted(state for _, state, _ in members(process.pid)))
        used = end(process)
        raise Hang(f"{' '.join(map(str, arguments))}: no end after {(turn + 1) * limit:g} s, {used:.1f} of them computing, "
                   f"processes in the states {states}")
    finally:
        if process.poll() is None:
            end(process)


# Fields ----------------------------------------------------------------------------------------------------------

TYPES = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}


def read_grid(path):
    """Reads the arrays of a file of the program: raw appended data, compressed by zlib."""
    data = path.read_bytes()
    begin = data.index(b"_", data.index(b"<AppendedData")) + 1
    arrays = {}
    for text in re.findall(rb"<DataArray ([^>]*)/>", data[:begin]):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', text.decode()))
        at = begin + int(attributes["offset"])
        blocks = int.from_bytes(data[at:at + 8], sys.byteorder)
        sizes = array("Q", data[at + 24:at + 24 + 8 * blocks])
        at += 24 + 8 * blocks
        values = array(TYPES[attributes["type"]])
        for size in sizes:
            values.frombytes(zlib.decompress(data[at:at + size]))
            at += size
        width = int(attributes.get("NumberOfComponents", 1))
        values = list(values)
        arrays[attributes["Name"]] = [values[i:i + width] for i in range(0, len(values), width)] if width > 1 else values
    return arrays


@dataclass
class Answer:
    """Result and fields of a run."""
    status: str
    result: dict
    u: dict = field(default_factory=dict)        # displacement by node
    stress: dict = field(default_factory=dict)   # von Mises stress by the set of an element's nodes

    @property
    def applications(self):
        return self.result.get("operator_applications", 0)

    def worst(self):
        """Returns the largest residual including the uncertainty due to rounding."""
        said = self.result["certificate"]
        rounding = said.get("rounding", {})
        return max((v if isinstance(v, (int, float)) else math.inf) + rounding.get(k, 0.0)
                   for k, v in said.items() if k != "rounding")


def node_names(case, grid):
    """Returns the indices of a run's nodes in the case's mesh, or their numbers if the run has another mesh."""
    ids = grid["node_id"]
    if case.options:
        return ids
    if not case.box:
        place = {tag: n for n, tag in enumerate(case.mesh.tags())}
        return [place[i] for i in ids]
    steps = [s / (2 * c) for s, c in zip(case.box["size"], case.box["cells"])]
    def key(x):
        return tuple(round(c / s) for c, s in zip(x, steps))
    place = {key(x): n for n, x in enumerate(case.mesh.nodes)}
    return [place[key(x)] for x in grid["Points"]]


def read_answer(case, output):
    result = json.loads((output / "result.json").read_text())
    answer = Answer(result["status"], result)
    if (output / "body.vtu").exists():
        grid = read_grid(output / "body.vtu")
        names = node_names(case, grid)
        answer.u = {n: u[:case.mesh.dim] for n, u in zip(names, grid["displacement"])}
        ends = grid["offsets"]
        for begin, end, stress in zip([0, *ends], ends, grid["von_mises"]):
            answer.stress[frozenset(names[k] for k in grid["connectivity"][begin:end])] = stress
    return answer


# Comparison ------------------------------------------------------------------------------------------------------

def size(v):
    return math.hypot(*v)


def surface_area(case, name):
    """Returns the approximate area of a group of facets."""
    mesh, total = case.mesh, 0.0
    for facet in mesh.facets.get(name, []):
        x = [mesh.nodes[n] for n in facet[:{"tet10": 3}.get(mesh.element, len(facet))]]
        if mesh.dim == 2:
            radius = 2 * math.pi * 0.5 * (x[0][0] + x[1][0])
            total += math.dist(x[0], x[1]) * (radius if case.document.get("plane") == "axisymmetric"
                                              else case.document.get("thickness", 1.0))
        for k in range(1, len(x) - 1) if mesh.dim == 3 else ():
            a, b = [[p - q for p, q in zip(x[k + j], x[0])] for j in (0, 1)]
            total += 0.5 * size([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    return total


def floor(tolerance):
    """Returns the fraction of the acting forces that is the smallest scale for a force, as in the certificate's
    residuals."""
    return 10 * math.sqrt(tolerance)


def section(case):
    """Returns extent and approximate cross-sectional area of the body."""
    extent = max(max(map(abs, x)) for x in case.mesh.nodes)
    plane = case.document.get("plane", "strain")
    depth = extent if case.mesh.dim == 3 else 2 * math.pi * extent if plane == "axisymmetric" else \
        case.document.get("thickness", 1.0)
    return extent, extent * depth


def least(case, tolerance):
    """Returns the scales of force, displacement and stress due to rounding where nothing acts."""
    extent, area = section(case)
    share = 1e-14 / math.sqrt(tolerance)
    young = max(m["young"] for m in case.document["material"])
    return share * young * area, share * extent, share * young


def contact_scales(case, truth, tolerance):
    """Returns each entry's scale of the contact force: the force, or a fraction of the stress in the elements behind
    it."""
    scales = {}
    for entry in case.document.get("contact", []):
        said = truth.result["contact"].get(entry["name"])
        if not said:
            continue
        nodes = set(case.mesh.surface(entry["on"])) if not case.options else set()
        near = [s for element, s in truth.stress.items() if not nodes or nodes & element]
        own = max(size(said["normal_force"]), size(said["friction_force"]), 0.1 * said["area"] * said["max_pressure"])
        behind = max(near, default=0.0) * surface_area(case, entry["on"])
        scales[entry["name"]] = max(own, floor(tolerance) * behind)
    return scales


def joined_entries(case):
    """Lists of contact entries. Those in one list meet at nodes that friction may hold: the share of each is undetermined."""
    lists = []
    for entry in case.document.get("contact", []):
        nodes, rubs = set(case.mesh.surface(entry["on"])), "friction" in entry
        met = [(names, others, rough) for names, others, rough in lists if nodes & others and (rubs or rough)]
        lists = [old for old in lists if old not in met]
        lists.append(([n for names, _, _ in met for n in names] + [entry["name"]],
                      nodes.union(*(others for _, others, _ in met)), rubs or any(rough for _, _, rough in met)))
    return [names for names, _, _ in lists]


def parts_of(case, truth):
    """Returns nodes and elements of each part, or of the whole body if the mesh is not the case's."""
    if case.options:
        return [(set(truth.u), set(truth.stress))]
    return [({n for i in places for n in case.mesh.elements[i]}, {frozenset(case.mesh.elements[i]) for i in places})
            for places in case.mesh.parts.values()]


def compare(case, truth, answer, tolerance, twin=None):
    """Returns the relative errors of a case's or twin's answer, by quantity."""
    map_vector = twin.vector if twin else (lambda v, factor: v)
    force, length = (twin.force, twin.length) if twin else (1.0, 1.0)
    off = {}
    least_force, least_move, least_stress = least(case, tolerance)

    def note(what, value):
        off[what] = max(off.get(what, 0.0), value if math.isfinite(value) else math.inf)

    scales = contact_scales(case, truth, tolerance)
    for names in joined_entries(case):
        names = [name for name in names if name in scales]
        for key in ("normal_force", "friction_force") if len(names) == 1 else ("force",) if names else ():
            there, here = ([sum(c) for c in zip(*(a.result["contact"][name][key] for name in names))] for a in (truth, answer))
            scale = max(least_force, *(scales[name] for name in names))
            note("contact", math.dist(map_vector(there, force), here) / (force * scale))
    acting = {kind: max((size(e["force"]) for e in truth.result.get(kind, {}).values()), default=0.0)
              for kind in ("reaction", "load", "contact")}
    places = {e["name"]: e["on"] for e in case.document["boundary"]}
    worst = max(truth.stress.values(), default=0.0)
    for name, said in truth.result.get("reaction", {}).items():
        behind = max(*acting.values(), worst * surface_area(case, places[name]))
        scale = force * max(size(said["force"]), floor(tolerance) * behind, least_force)
        note("reaction", math.dist(map_vector(said["force"], force), answer.result["reaction"][name]["force"]) / scale)
    if set(truth.u) == set(answer.u):
        for nodes, elements in parts_of(case, truth):
            moved = max(least_move, *(size(truth.u[n]) for n in nodes))
            far = max(math.dist(map_vector(truth.u[n], length), answer.u[n]) for n in nodes) / length
            note("displacement", far / moved)
            put_on = floor(tolerance) * acting["load"] / section(case)[1]  # share that a spring may carry where it acts
            stress = max(least_stress, put_on, *(truth.stress[e] for e in elements))
            factor = force / length ** 2
            differs = max(abs(truth.stress[e] - answer.stress.get(e, math.inf) / factor) for e in elements)
            note("stress", differs / stress)
    elif not case.options:
        note("displacement", math.inf)
    return off


# One case --------------------------------------------------------------------------------------------------------

@dataclass
class Finding:
    kind: str       # wrong, false alarm, hang, error, verify
    check: str      # verify, tight, or a twin
    text: str


@dataclass
class Report:
    name: str
    status: str
    applications: int = 0
    findings: list = field(default_factory=list)
    off: dict = field(default_factory=dict)        # error over limit, by check and quantity
    notes: list = field(default_factory=list)      # observations that are not findings
    other: tuple = None                            # status and applications of the other program
    seconds: float = 0.0


class Checker:
    """All checks of one case, in one folder."""

    def __init__(self, program, folder, limit):
        self.program, self.folder, self.limit = program, folder, limit

    def run(self, case, name, *options, program=None):
        """Returns the answer, or None and the reason for rejecting the case."""
        place = self.folder / name
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(parents=True)
        case.write(place)
        return self.again(case, place, *options, program=program)

    def again(self, case, place, *options, program=None):
        done = call(program or self.program, "run", "case.json", "--output", "out", "-q", *options, folder=place, limit=self.limit)
        if done.code == 2:
            return None, done.err.strip()
        if done.code not in (0, 1) or not (place / "out" / "result.json").exists():
            raise RuntimeError(f"exit code {done.code}: {done.err.strip()[-400:]}")
        return read_answer(case, place / "out"), ""

    def verified(self, name, *options):
        return call(self.program, "verify", "case.json", "--output", "out", *options, folder=self.folder / name, limit=self.limit)

    def truth(self, case, base, tolerance):
        """Returns the answer at the tightest tolerance that rounding admits, at the first run's load; or None."""
        for wanted in (TIGHT, 1e-8, 1e-7):
            if wanted > 0.11 * tolerance:
                return None
            answer, _ = self.run(case, "tight", "--set", f"solver.tolerance={wanted}", "--set", "solver.max_outer=400")
            if not answer or answer.result.get("load_factor") != base.result.get("load_factor"):
                continue
            if answer.status == "converged" or (answer.status == "limited_by_rounding" and "moving" not in case.traits
                                                and answer.worst() <= 0.11 * tolerance):
                return answer
        return None

    def twin(self, twin):
        """Returns the twin's answer."""
        options = ["--ranks", twin.ranks] if twin.ranks > 1 else []
        if twin.kind == "parted":
            place = self.folder / twin.kind
            shutil.rmtree(place, ignore_errors=True)
            place.mkdir(parents=True)
            twin.case.write(place)
            done = call(self.program, "partition", "case.json", "--ranks", twin.ranks, "--output", "parts",
                        folder=place, limit=self.limit)
            if done.code:
                return None, done.err.strip()
            return self.again(twin.case, place, "--parts", "parts")
        if twin.kind != "restarted":
            return self.run(twin.case, twin.kind, *options)
        first, why = self.run(twin.case, twin.kind, "--set", f"solver.max_outer={twin.cut}")
        place = self.folder / twin.kind
        if not first or not (place / "out" / "checkpoint.kacanov").exists():
            return first, why  # converged before the cut
        return self.again(twin.case, place, "--restart", *options)

    # The checks ---------------------------------------------------------------------------------------------------

    def examine(self, case, twins, other=None):
        """Runs all checks; every unexpected result is a finding or a note."""
        report = Report(case.name, "refused")
        base = self.tried(report, "run", lambda: self.run(case, "base"))
        if not base or not base[0]:
            report.status = "refused" if base else "failed"
            report.notes += [f"refused: {base[1]}"] if base else []
            return report
        base = base[0]
        report.status, report.applications = base.status, base.applications
        if other:
            there = self.tried(report, "other", lambda: self.run(case, "other", program=other))
            report.other = (there[0].status, there[0].applications) if there and there[0] else ("refused", 0)
        tolerance = base.result["case"].get("solver", {}).get("tolerance", 1e-6)
        alarm = self.tried(report, "verify", lambda: self.judge(report, base, tolerance))
        truth = self.tried(report, "tight", lambda: self.truth(case, base, tolerance)) if base.status == "converged" else None
        if truth:
            off = compare(case, truth, base, tolerance)
            self.decide(report, case, "tight", off, tolerance)
        elif base.status == "converged":
            report.notes.append("no truth: no tighter run")
        if alarm:
            false = truth and not any(f.check == "tight" for f in report.findings)
            report.findings.append(Finding("false alarm" if false else "wrong", "verify", alarm))
        for kind, twin in twins.items():
            self.tried(report, kind, lambda twin=twin: self.compare_twin(report, case, truth, twin, base, tolerance))
        return report

    def tried(self, report, check, work):
        """Returns the result of `work`, or None and adds a finding."""
        try:
            return work()
        except Hang as fault:
            report.findings.append(Finding("hang", check, str(fault)))
        except (RuntimeError, OSError, ValueError, KeyError) as fault:
            report.findings.append(Finding("error", check, f"{type(fault).__name__}: {fault}"))
        return None

    def judge(self, report, base, tolerance):
        """Returns the verifier's objection to a converged answer; other objections are findings at once."""
        done = self.verified("base")
        if done.code == 2 and any(words in done.err for words in CANNOT_TELL):
            report.notes.append("not verifiable: " + done.err.strip())
        elif done.code not in (0, 1):
            report.findings.append(Finding("error", "verify", f"exit code {done.code}: {done.err.strip()}"))
        elif done.code == 1 and base.status == "converged":
            return done.out.strip()
        elif "  differs" in done.out:
            report.findings.append(Finding("false alarm", "verify", "the result says something else:\n" + done.out))
        elif base.status == "limited_by_rounding" and unlimited(base, done.out, tolerance):
            report.findings.append(Finding("false alarm", "verify", "no rounding limits it:\n" + done.out))
        return ""

    def decide(self, report, case, check, off, tolerance, answer=None, twin=None):
        """Records the errors of an answer relative to their limits, and adds a finding or a note if one exceeds
        them."""
        report.off[check] = {what: value / allowed(what, tolerance) for what, value in off.items()}
        worst = max(report.off[check], key=report.off[check].get, default=None)
        if worst is None or report.off[check][worst] <= 1:
            return
        text = ", ".join(f"{what} {value:.2e}" for what, value in off.items()) + f" at a tolerance of {tolerance:g}"
        if "coulomb" in case.traits and self.is_another(case, answer, twin, tolerance):
            report.notes.append(f"another equilibrium ({check}): {text}")
        else:
            report.findings.append(Finding("wrong", check, text))

    def is_another(self, case, answer, twin, tolerance):
        """Returns whether a tight run of the twin ends at this answer: Coulomb friction may have several equilibria."""
        if not twin or not answer:
            return False
        name = "twin tight"
        tight, _ = self.run(twin.case, name, "--ranks", twin.ranks, "--set", f"solver.tolerance={TIGHT}")
        if not tight or tight.status != "converged" or self.verified(name, "--set", f"solver.tolerance={TIGHT}").code:
            return False
        return all(value <= allowed(what, tolerance) for what, value in compare(twin.case, tight, answer, tolerance).items())

    def compare_twin(self, report, case, truth, twin, base, tolerance):
        answer, why = self.twin(twin)
        if not answer and "cannot be split into" in why:  # too few elements
            report.notes.append(f"{twin.kind}: too small for its ranks")
            return
        if not answer:
            report.findings.append(Finding("error", twin.kind, "the twin is refused: " + why))
            return
        if answer.status != base.status:
            report.notes.append(f"{twin.kind}: {answer.status}, not {base.status}")
        if answer.status == "converged" and truth:
            off = compare(case, truth, answer, tolerance, twin)
            self.decide(report, case, twin.kind, off, tolerance, answer, twin)


def unlimited(base, table, tolerance):
    """Returns whether the verifier's rounding does not explain `limited_by_rounding`: its arithmetic has more
    digits."""
    lines = [line.split() for line in table.splitlines()]
    told = base.result["certificate"]["rounding"]
    found = [float(w[1]) + max(float(w[3]), told[w[0]]) for w in lines if len(w) > 3 and w[0] in ENTRIES]
    return max(found) <= 0.999 * tolerance


def allowed(what, tolerance):
    """Returns the allowed relative error: the certificate's duality gap bounds the energy error by the tolerance."""
    return math.sqrt(tolerance) * {"stress": 3.0}.get(what, 1.0)
