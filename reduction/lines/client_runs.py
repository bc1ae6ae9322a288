"""Comparison of written decks, run in their programs, with the expected values.

A line is stretched along its curve and beyond its end, and for a form with damping, through a
sinusoid at the levels of that form.  The expected values come from the line, not from the deck:
its curve with its straight continuation, the three parameters in closed form, or the curve with
its dashpot.  Each program runs in a separate folder and process; a program that is not installed is
named.
"""

from __future__ import annotations

import importlib.util
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from reduction.lines.deck_moordyn import deck_length, working_frequency
from reduction.lines.export_dynamics import Syrope, Viscoelasticity
from reduction.lines.export_line import (
    ExportLine,
    continued_tension,
    loop_stiffness,
    straight_cycle,
)
from reduction.quantities.digits import plain_number
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats

LIMITS = {"tension": 0.01, "strain": 0.01, "EA": 0.01, "K_ap": 0.01, "H": 0.03}
"""Greatest allowed difference from the expected value, as a share of it. [1]"""

_SHARES = np.array([0.05, 0.2, 0.5, 0.8, 1.0, 1.2])  # of the end of a curve
_LEAST = 1e-3  # share of the greatest tension below which errors are relative to this share
_OF_MEAN = 0.05  # amplitude of a cycle of a linear line, as a share of the mean strain
_AT_REST = 0.1  # strain at which a linear line rests
_IN_A_CYCLE = 200
_SETTLED = 1e-3  # share of a change that remains when a cycle is read
_MOST_CYCLES = 400
_BEGINS = 3  # rests before the first one
_GROWN = 3  # cycles until a sinusoid has its full amplitude


@dataclass(frozen=True)
class ClientCheck:
    """One number of a program beside the expected one; the error is relative to ``scale``."""

    program: str
    quantity: str
    at: str
    unit: str
    promised: float
    found: float
    scale: float

    @property
    def error(self) -> float:
        """Difference over the scale. [1]."""
        return float((self.found - self.promised) / self.scale)

    @property
    def is_kept(self) -> bool:
        """Whether the result of the program agrees with the expected one."""
        return abs(self.error) <= LIMITS[self.quantity]


def verify_deck(line: ExportLine, to: str, form: str, paths: Sequence[Path]) -> list[ClientCheck]:
    """Run written files in their program."""
    run = _RUNS.get((to, form))
    if run is None:
        raise SettingsError(
            f"nothing here runs --to {to}" + (f" --form {form}" if form else ""),
            needed="--verify with " + ", ".join(f"{one} {kind}".strip() for one, kind in _RUNS),
        )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in paths:
            shutil.copy(path, folder / path.name)
        return run(line, folder, paths[-1].name)


def in_words(checks: Sequence[ClientCheck]) -> tuple[str, ...]:
    """One sentence per quantity: difference of the program from the expected value.

    Examples
    --------
    >>> one = ClientCheck("MoorDyn 2.7", "K_ap", "0.3 Hz", "N", 500.0, 501.0, 500.0)
    >>> in_words([one])[0].split(" (")[0]
    'run in MoorDyn 2.7: K_ap within 0.20 percent of what is promised'
    """
    said = []
    for quantity in dict.fromkeys(one.quantity for one in checks):
        of_it = [one for one in checks if one.quantity == quantity]
        worst = max(of_it, key=lambda one: abs(one.error))
        lost = [one for one in of_it if not one.is_kept]
        doubt = "DOUBTFUL: " if lost else ""
        said.append(
            f"{doubt}run in {worst.program}: {quantity} within {100 * abs(worst.error):.2f} "
            f"percent of what is promised ({plain_number(worst.found, 6)} {worst.unit} for "
            f"{plain_number(worst.promised, 6)} {worst.unit} at {worst.at})"
        )
    return tuple(said)


def _needed(what: str, found: object, how: str) -> None:
    if found is None:
        raise SettingsError(f"{what} is not installed", needed=how)


def _run(arguments: Sequence[str], folder: Path, what: str) -> str:
    done = subprocess.run(  # noqa: S603 - programs on the path, or this Python
        arguments, cwd=folder, capture_output=True, text=True, errors="replace", check=False
    )
    if done.returncode:
        told = (done.stderr.strip() or done.stdout.strip())[-400:]
        raise DataError(f"{what} ended with status {done.returncode}", found=told or "no message")
    return done.stdout + done.stderr


@dataclass(frozen=True)
class _Cycle:
    """A sinusoid for which a form is made, and its expected loop."""

    mean: float
    amplitude: float
    frequency: float
    n_cycles: int
    stiffness: float
    energy: float

    @property
    def at(self) -> str:
        """The levels in words."""
        return f"{self.frequency:.3g} Hz, strain {self.mean:.4g} +- {self.amplitude:.3g}"

    def checks(self, program: str, stiffness: float, energy: float) -> list[ClientCheck]:
        """K_ap and H beside the expected ones."""
        rows = (
            ("K_ap", "N", self.stiffness, stiffness), ("H", "J/m", self.energy, energy),
        )  # fmt: skip
        return [
            ClientCheck(program, name, self.at, unit, promised, found, promised)
            for name, unit, promised, found in rows
        ]


def _cycle_of(line: ExportLine, form: str) -> _Cycle | None:
    """The cycle of a form; None for a form without damping of its own."""
    if form == "syrope" and line.syrope is not None:
        return _cycle_on_a_working_curve(line.syrope, line)
    if form == "damped-table" and line.damping is not None and (of := straight_cycle(line)):
        return _Cycle(
            of.strain, of.strain_amplitude, line.damping.frequency, _GROWN + 3,
            loop_stiffness(line, line.damping), of.hysteresis_energy,
        )  # fmt: skip
    part = line.viscoelasticity
    if form not in ("static-dynamic", "load-dependent") or part is None:
        return None
    frequency = (
        part.frequency
        if math.isfinite(part.frequency)
        else 1 / (2 * math.pi * part.relaxation_time)
    )
    is_running = form == "load-dependent"
    modulus = part.running_stiffness_at(frequency) if is_running else part.stiffness_at(frequency)
    mean = part.mean_tension / part.static_stiffness if part.mean_tension > 0 else _AT_REST
    size = part.tension_amplitude / abs(modulus)
    amplitude = size if math.isfinite(size) else _OF_MEAN * mean
    return _Cycle(
        mean, amplitude, frequency, _cycles_to_settle(part, frequency), abs(modulus),
        math.pi * amplitude**2 * modulus.imag,
    )  # fmt: skip


_OF_GAP = 0.1  # of the gap to the greatest mean tension, above which the line changes: small cycle


def _cycle_on_a_working_curve(syrope: Syrope, line: ExportLine) -> _Cycle | None:
    """A cycle whose slow tension stays below the greatest mean; None where there is no room."""
    about, gap = syrope.about_mean, syrope.greatest_mean_tension - syrope.mean_tension
    frequency, part = working_frequency(syrope, line), line.viscoelasticity
    modulus = about.stiffness_at(frequency)
    # strain that the spring of EA_d does not take
    slow = abs(1 - modulus / about.fast_stiffness)
    series = about.static_stiffness / (1 - about.static_stiffness / about.fast_stiffness)
    amplitude = _OF_GAP * min(gap, syrope.mean_tension) / (slow * series)
    if part is not None and part.tension_amplitude > 0:
        amplitude = min(amplitude, part.tension_amplitude / abs(modulus))
    if not amplitude > 0:
        return None
    return _Cycle(
        syrope.initial_strain, amplitude, frequency, _cycles_to_settle(about, frequency),
        abs(modulus), math.pi * amplitude**2 * modulus.imag,
    )  # fmt: skip


def _cycles_to_settle(part: Viscoelasticity, frequency: float) -> int:
    settled = -math.log(_SETTLED) * part.relaxation_time * frequency
    return min(_MOST_CYCLES, _GROWN + 2 + math.ceil(settled))


def _loop(strain: Floats, tension: Floats) -> tuple[float, float]:
    """Range of tension over range of strain, and area, of one complete cycle. [N; J/m]."""
    area = float(np.trapezoid(np.append(tension, tension[0]), np.append(strain, strain[0])))
    return float(np.ptp(tension) / np.ptp(strain)), area


def _tensions(program: str, line: ExportLine, strain: Floats, found: Floats) -> list[ClientCheck]:
    promised = continued_tension(line, strain)
    least = _LEAST * float(line.tension[-1])
    return [
        ClientCheck(program, "tension", f"strain {e:.4g}", "N", float(t), float(f),
                    max(float(t), least))
        for e, t, f in zip(strain, promised, found, strict=True)
    ]  # fmt: skip


def _slow_tensions(
    program: str, part: Viscoelasticity, strain: Floats, found: Floats
) -> list[ClientCheck]:
    return [
        ClientCheck(program, "tension", f"strain {e:.4g} at rest", "N", part.static_stiffness * e,
                    float(f), part.static_stiffness * e)
        for e, f in zip(strain, found, strict=True)
    ]  # fmt: skip


_MOORDYN = """
import json, math, sys
import moordyn
job = json.load(open("job.json"))
system = moordyn.Create(sys.argv[1])
if system is None:
    raise SystemExit("MoorDyn does not take the deck")
length, low, step, time, out = job["length"], job["low"], job["step"], 0.0, []
at = lambda strain: [0.0, 0.0, low + length * (1 + strain)]
if moordyn.Init(system, at(job["strain"][0]), [0.0, 0.0, 0.0]):
    raise SystemExit("MoorDyn does not start")
line = moordyn.GetLine(system, 1)
for strain, rate in zip(job["strain"], job["rate"]):
    moordyn.Step(system, at(strain), [0.0, 0.0, rate * length], time, step)
    time += step
    top, bottom = moordyn.GetLineFairTen(line), math.hypot(*moordyn.GetLineNodeTen(line, 0))
    out.append(bottom + job["share"] * (top - bottom))
moordyn.Close(system)
json.dump(out, open("out.json", "w"))
"""
_MOORPY = """
import json, sys
import moorpy
job = json.load(open("job.json"))
system, out = moorpy.System(sys.argv[1]), []
(line,) = system.lineList
low = job["low"]
system.pointList[0].setPosition([0.0, 0.0, low])
for strain in job["strain"]:
    system.pointList[1].setPosition([0.0, 0.0, low + job["length"] * (1 + strain)])
    line.staticSolve()
    out.append(float(line.TB))
json.dump(out, open("out.json", "w"))
"""
_MOORPY_LIBRARY = """
import json, sys
from moorpy.helpers import getLineProps
job = json.load(open("job.json"))
found = getLineProps(job["diameter"], job["name"], source=sys.argv[1])
json.dump({name: float(found[name]) for name in ("EA", "EAd", "EAd_Lm")}, open("out.json", "w"))
"""


def _deck_numbers(text: str) -> tuple[float, float, float]:
    """Unstretched length of the line in a deck, height of its lower end, share of its upper end.

    For accelerations that grow along a line of N segments, the mean tension without inertia is the
    share (N + 1)/(3 N) of that of the last segment, plus the rest of that of the first.
    """
    rows = [row.split() for row in text.split("\n")]
    anchor = next(row for row in rows if row[:2] == ["1", "Fixed"])
    head = next(place for place, row in enumerate(rows) if "UnstrLen" in row)
    segments = int(rows[head + 2][5])
    return float(rows[head + 2][4]), float(anchor[4]), (segments + 1) / (3 * segments)


def _in_python(driver: str, folder: Path, deck: str, what: str, **job: object) -> Any:
    (folder / "job.json").write_text(json.dumps(job), encoding="utf-8")
    _run([sys.executable, "-c", driver, deck], folder, what)
    return json.loads((folder / "out.json").read_text())


# strains at the ends of equal steps [s], the first at the start; gives strain and tension at each
_Stretch = Callable[[Floats, float], tuple[Floats, Floats]]


def _by_moordyn(form: str) -> Callable[[ExportLine, Path, str], list[ClientCheck]]:
    def run(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
        _needed("MoorDyn", importlib.util.find_spec("moordyn"), "pip install moordyn")
        program = f"MoorDyn {version('moordyn')}"
        length, low, share = _deck_numbers((folder / deck).read_text())

        def stretch(strain: Floats, step: float) -> tuple[Floats, Floats]:
            found = _in_python(
                _MOORDYN, folder, deck, program, length=length, low=low, step=step, share=share,
                strain=strain[:-1].tolist(), rate=(np.diff(strain) / step).tolist(),
            )  # fmt: skip
            return strain[1:], np.array(found)

        return _stretched(program, line, form, stretch)

    return run


def _stretched(
    program: str,
    line: ExportLine,
    form: str,
    stretch: _Stretch,
    *,
    in_a_cycle: int = _IN_A_CYCLE,
    least_rest: float = 10.0,
) -> list[ClientCheck]:
    """Rest at strains, then run the cycle of the form."""
    part = None if form in ("table", "damped-table", "syrope") else line.viscoelasticity
    strains, rest = np.array([0.5, 1.0]) * _AT_REST, least_rest
    if form == "syrope" and (syrope := line.syrope) is not None:
        # from its working curve to the original one, and beyond it
        line = replace(line, strain=syrope.strain, tension=syrope.tension)
        end = float(syrope.strain[-1])
        top = float(np.interp(syrope.greatest_mean_tension, syrope.tension, syrope.strain))
        beyond = top + (end - top) * np.array([0.25, 0.5, 1.0])
        strains = np.concatenate([[syrope.initial_strain], beyond, [_SHARES[-1] * end]])
        slowest = syrope.slow_damping / syrope.dynamic_stiffness
        rest = max(rest, -math.log(_SETTLED / 10) * slowest)
    elif part is None:
        strains = _SHARES * float(line.strain[-1])
        if form == "damped-table" and line.damping is not None:
            rest = max(rest, 10 / line.damping.frequency)
    else:
        # a stiffness that follows the running tension settles as slowly as the slow spring
        slower = part.fast_stiffness / part.static_stiffness if form == "load-dependent" else 1.0
        rest = max(rest, -math.log(_SETTLED / 10) * slower * part.relaxation_time)
    step = max(0.05, rest / 1000)
    n_rise, n_rest = 10, math.ceil(rest / step)
    before = np.concatenate([strains[:1], strains[:-1]])
    rises = np.linspace(before, strains, n_rise, endpoint=False, axis=1)
    held = np.concatenate([rises, np.repeat(strains[:, None], n_rest, axis=1)], axis=1)
    # from the start of the deck: OpenFAST has that strain in its slow spring
    first = np.full(_BEGINS * n_rest, strains[0])
    # the OpenFAST driver smooths its input over some steps: take the strain that it applied
    had, found = (
        one[first.size + n_rise + 9 * n_rest // 10 :: n_rise + n_rest]
        for one in stretch(np.concatenate([first, held.ravel(), strains[-1:]]), step)
    )
    checks = (
        _tensions(program, line, had, found)
        if part is None
        else _slow_tensions(program, part, had, found)
    )
    if form == "syrope" and line.syrope is not None:
        mean = line.syrope.mean_tension
        start = ClientCheck(program, "tension", "its start", "N", mean, float(found[0]), mean)
        checks = [start, *checks[1:]]
    cycle = _cycle_of(line, form)
    if cycle is None:
        return checks
    turned = np.arange(in_a_cycle * cycle.n_cycles + 1) / in_a_cycle
    grown = np.minimum(turned / _GROWN, 1.0)
    strain, tension = stretch(
        cycle.mean + cycle.amplitude * grown * np.sin(2 * np.pi * turned),
        1 / cycle.frequency / in_a_cycle,
    )
    return checks + cycle.checks(program, *_loop(strain[-in_a_cycle:], tension[-in_a_cycle:]))


_OPENFAST = """the line of a deck, stretched
--- ENVIRONMENT ---
0.0 Gravity
1025.0 rhoW
{depth} WtrDepth
--- MOORDYN ---
"{deck}" MDInputFile
"out" OutRootName
{end} TMax
{step} dtC
1 InputsMode
"motion.txt" InputsFile
0 NumTurbines
--- INITIAL POSITIONS ---
X Y Z surge_init sway_init heave_init roll_init pitch_init
(m) (m) (m) (m) (m) (m) (rad) (rad)
0 0 0 0 0 0 0 0
"""


def _by_openfast(form: str) -> Callable[[ExportLine, Path, str], list[ClientCheck]]:
    def run(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
        driver = shutil.which("moordyn_driver")
        _needed("moordyn_driver, of OpenFAST,", driver, "on the path; benchmarks/build_clients.sh")
        text = (folder / deck).read_text()
        length, low, share = _deck_numbers(text)
        depth = re.search(r"^(\S+) WtrDpth$", text, re.MULTILINE)

        (folder / deck).write_text(text.replace("\nFairTen1\n", "\nFairTen1\nPoint2Pz\n"))

        def stretch(strain: Floats, step: float) -> tuple[Floats, Floats]:
            time, height = step * np.arange(strain.size), low + length * (1 + strain)
            rows = np.column_stack([time, 0 * height, 0 * height, height])
            np.savetxt(folder / "motion.txt", rows, fmt="%.10g")
            (folder / "driver.inp").write_text(
                _OPENFAST.format(
                    depth=depth[1] if depth else 200, deck=deck, end=time[-1], step=step
                )
            )
            _run([str(driver), "driver.inp"], folder, "moordyn_driver")
            told = (folder / "out.MD.out").read_text().split("\n")
            (head,) = (place for place, row in enumerate(told) if row.split()[:1] == ["Time"])
            table = np.array([row.split() for row in told[head + 2 :] if row.strip()], dtype=float)
            names = told[head].lower().split()
            # positions as applied: the program smooths its input
            place, top, bottom = (
                np.interp(time[1:], table[:, 0], table[:, names.index(name)])
                for name in ("point2pz", "fairten1", "anchten1")
            )
            return (place - low) / length - 1, bottom + share * (top - bottom)

        return _stretched(
            "moordyn_driver", line, form, stretch, in_a_cycle=20 * _IN_A_CYCLE, least_rest=60.0
        )

    return run


def _by_moorpy(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
    _needed("MoorPy", importlib.util.find_spec("moorpy"), "pip install moorpy")
    program, strain = f"MoorPy {version('moorpy')}", _SHARES * float(line.strain[-1])
    length, low, _ = _deck_numbers((folder / deck).read_text())
    found = _in_python(
        _MOORPY, folder, deck, program, length=length, low=low, strain=strain.tolist()
    )
    return _tensions(program, line, strain, np.array(found))


def _by_moorpy_library(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
    _needed("MoorPy", importlib.util.find_spec("moorpy"), "pip install moorpy")
    program, part = f"MoorPy {version('moorpy')}", line.viscoelasticity
    if part is None:
        return []
    found: dict[str, float] = dict(
        _in_python(
            _MOORPY_LIBRARY, folder, deck, program, diameter=1e3 * line.needed("diameter"),
            name=line.identifier,
        )
    )  # fmt: skip
    mean = part.mean_tension if part.mean_tension > 0 else 0.0
    rows = (
        ("EA", part.static_stiffness, found["EA"]),
        ("K_ap", part.apparent_stiffness, found["EAd"] + found["EAd_Lm"] * mean),
    )
    return [
        ClientCheck(program, name, f"{mean:.6g} N", "N", promised, value, promised)
        for name, promised, value in rows
    ]


_RAFT = """
import json, sys
import numpy, raft, yaml
job = json.load(open("job.json"))
mooring = yaml.safe_load(open(sys.argv[1]))["mooring"]
buoy = dict(
    name="buoy", type="rigid", rA=[0, 0, -1], rB=[0, 0, 1], shape="circ", gamma=0.0, potMod=False,
    stations=[0, 1], d=1.0, t=0.01, Cd=1.0, Ca=1.0, CdEnd=0.0, CaEnd=[0.0, 0.0],
)
keys = "wind_speed wind_heading turbulence turbine_status yaw_misalign wave_spectrum wave_period "
keys = (keys + "wave_height wave_heading current_speed current_heading").split()
(fowt,) = raft.Model(dict(
    settings=dict(min_freq=0.01, max_freq=0.2, XiStart=0, nIter=4),
    site=dict(water_depth=mooring["water_depth"], rho_water=1025.0, rho_air=0.0, mu_air=0.0,
              shearExp=0.0),
    cases=dict(keys=keys, data=[[0, 0, 0, "parked", 0, "still", 12, 1, 0, 0, 0]]),
    platform=dict(potModMaster=1, dlsMax=5.0, members=[buoy]),
    mooring=mooring,
)).fowtList
out = []
for rise in job["rise"]:
    fowt.setPosition(numpy.array([0, 0, rise, 0, 0, 0], dtype=float))
    out.append([float(fowt.ms.getTensions().mean()), float(fowt.C_moor[2, 2])])
json.dump(out, open("out.json", "w"))
"""


def _by_raft(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
    _needed("RAFT", importlib.util.find_spec("raft"), "pip install openraft, in a venv of its own")
    program, cycle = f"RAFT {version('openraft')}", straight_cycle(line)
    if cycle is None:
        return []
    length, share = deck_length(line), np.array([0.0, -1.0, 1.0])
    found = np.array(
        _in_python(_RAFT, folder, deck, program,
                   rise=(length * cycle.strain_amplitude * share).tolist())
    )  # fmt: skip
    promised = float(continued_tension(line, cycle.strain))
    # for a test, the middle between the turns of the curve
    if line.damping is not None:
        promised = cycle.tension
    by_turns = (found[2, 0] - found[1, 0]) / (2 * cycle.strain_amplitude)
    rows = (
        ("tension", "the middle of the cycle", promised, found[0, 0]),
        ("K_ap", cycle.holds, cycle.stiffness, by_turns),
        ("K_ap", "the stiffness of a platform on it", cycle.stiffness, length * found[0, 1]),
    )
    return [
        ClientCheck(program, name, at, "N", wanted, float(value), wanted)
        for name, at, wanted, value in rows
    ]


_CABLE = """
Problem Description
    title = "a line under an end force"
    type = general
Analysis Parameters
    static-relaxation = 0.1
    static-iterations = 5000
    static-tolerance = 1e-6
Environment
    rho = 1025.0
    gravity = 9.81
    depth = 100.0
Buoys
    ball type = sphere d = 0.5 m = 1.0
Anchors
    clump
Layout
    terminal = {{ anchor = clump }}
    segment = {{ length = 10.0 material = "{name}" nodes = (101, 1.0) }}
    terminal = {{ buoy = ball x-force = 1.0 z-force = {force} }}
{material}
"""
_CABLE_LENGTH, _WEIGHTLESS = (
    10.0,
    "1.0e-4",
)  # [m]; [N/m], so that the force at the end is the total


def _by_cable(line: ExportLine, folder: Path, deck: str) -> list[ClientCheck]:
    cable, reader = shutil.which("cable"), shutil.which("res2asc")
    _needed("cable, of WHOI Cable,", cable, "on the path; benchmarks/build_clients.sh")
    _needed("res2asc, of WHOI Cable,", reader, "on the path; benchmarks/build_clients.sh")
    material = re.sub(
        r"^(\s+wet = ).*$", rf"\g<1>{_WEIGHTLESS}", (folder / deck).read_text(), flags=re.MULTILINE
    )
    checks = []
    for force in _SHARES * float(line.tension[-1]):
        text = _CABLE.format(name=line.identifier, force=float(force), material=material)
        (folder / "x.cbl").write_text(text)
        told = _run(
            [str(cable), "-in", "x.cbl", "-out", "x.crs", "-static", "-nocpp", "-quit"], folder,
            "cable",
        )  # fmt: skip
        if "Static solution complete" not in told:
            raise DataError(f"cable found no equilibrium at {force:.6g} N", found=told[-300:])
        _run([str(reader), "-in", "x.crs", "-variables", "z", "x", "T", "-static", "s.txt"],
             folder, "res2asc")  # fmt: skip
        depth, aside, _ = np.loadtxt(folder / "s.txt", skiprows=2).T
        found = float(np.hypot(np.ptp(depth), np.ptp(aside))) / _CABLE_LENGTH - 1
        promised = _strain_at(line, float(force))
        checks.append(
            ClientCheck("WHOI Cable", "strain", f"{force:.6g} N", "", promised, found, promised)
        )
    return checks


def _strain_at(line: ExportLine, force: float) -> float:
    """Strain at a tension, on the curve and its straight continuation."""
    strain = np.linspace(0.0, 2 * float(line.strain[-1]), 20_001)
    return float(np.interp(force, continued_tension(line, strain), strain))


_RUNS: dict[tuple[str, str], Callable[[ExportLine, Path, str], list[ClientCheck]]] = {
    **{
        ("moordyn", form): _by_moordyn(form)
        for form in ("table", "damped-table", "static-dynamic", "load-dependent", "syrope")
    },
    **{
        ("openfast", form): _by_openfast(form)
        for form in ("table", "damped-table", "static-dynamic")
    },
    ("moorpy", "table"): _by_moorpy,
    ("moorpy", "library"): _by_moorpy_library,
    ("raft", ""): _by_raft,
    ("whoi-cable", "expression"): _by_cable,
    ("whoi-cable", "table"): _by_cable,
}
