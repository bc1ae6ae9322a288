"""Decks in the grammar of MoorDyn: MoorDyn-C, MoorPy, OpenFAST.

**MoorDyn: look-up table, static and dynamic stiffness, stiffness that grows with load, Syrope.**
MoorDyn 2.7 has these limits and errors; each is handled here as stated:

* it does not start with a line end after the last row, or with more than 30 rows: neither is
  written;
* it keeps the tension below the first and beyond the last row: the first row is 0 0, and the last
  one lies beyond the curve on its straight continuation;
* a loop gives meaningless results, and a table beside ``|EA_d`` is replaced by its last secant:
  neither can occur here;
* a Syrope line whose dynamic stiffness does not grow causes a division by zero and starts at
  another tension: the stiffness grows by a millionth;
* a Syrope line without initial conditions ends in a segmentation fault: they are always written;
* its own time step (CFL) takes the stiffness of a table as zero, and the line diverges: the deck
  states a step from the steepest part of the curve;
* N = K_1 tau beside a table is far too much damping for cycles that are fast relative to tau, and
  requires steps of microseconds: a table has numerical damping, or the dashpot of one cycle;
* it reports the tension at the middle of its last step: a cycle has too little hysteresis energy,
  by half a step over the lag of strain behind tension; the step of a deck with damping is short
  enough for 1 %;
* without damping of the fast spring the second-order integration grows without bounds: a little
  damping is written, and called numerical.

**MoorPy: its deck with a table, and its library of line properties.** MoorPy 1.3 has these limits
and errors; each is handled here as stated:

* it opens a file named in the EA column without the first and last character of the name, and only
  if the name contains ``.txt``; anything else silently becomes 1,000 MN: ``|name.txt|`` is written;
* the table ends at a line with ``---``; without it, or with a line after it, reading fails;
* the table is read from the working folder: the header says so;
* version 1.2 has no line without EA, and so none with a table: the header says so;
* the slope of the dynamic stiffness is ``EAD_LM`` in 1.3 and ``EAd_MBL_Lm`` in its own list of
  names: both are written;
* a least or greatest diameter in the library causes an error: none is written.

**OpenFAST's MoorDyn module (MoorDyn-F): the grammar of MoorDyn, with other options.** The
`moordyn_driver` of OpenFAST 5.0 has these limits and errors; each is handled here as stated:

* a table beside a negative damping, which in MoorDyn-C is a share of critical, stops it: the
  damping is written as a number;
* the name of a line type is cut at 20 characters and then not found, that of a table at 40: both
  are shortened;
* a stiffness that grows with load does not settle: K_ap of one line was 104, 49.5 and 47.5 kN
  after 30, 80 and 90 cycles, where MoorDyn-C and the three parameters have 50. The law in its
  source is the same and the cause was not found, so this form is not written;
* it starts a line with the whole strain in its slow spring, from which a viscoelastic line
  relaxes: the header says so;
* it has no Syrope: there is no such form.

The tests run it where a program `moordyn_driver` is on the path; it is not a Python package.

References
----------
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4.
"""

from __future__ import annotations

import math
from dataclasses import replace
from hashlib import sha256
from typing import Literal

import numpy as np

from reduction.lines.deck_text import header_lines, number, one_line, real_number
from reduction.lines.export_dynamics import Syrope, Viscoelasticity
from reduction.lines.export_line import (
    CONTINUED,
    CycleDamping,
    ExportLine,
    ThinnedCurve,
    about_mean,
    continued_tension,
    damping_words,
    thin_curve,
    without_damping,
)
from reduction.quantities.digits import plain_number
from reduction.record.errors import SettingsError

_LENGTH, _SEGMENTS = 10.0, 5

NO_GRAVITY = "0 g"

WEIGHTLESS = (
    f"NO GRAVITY in this deck ({NO_GRAVITY}), so that tension depends on strain alone: set 9.81,"
    " or copy the line type into your own deck"
)

_COURANT = 0.1

_DEPTH = 100.0

_OF_WAVE = 0.2  # greatest length of the line of a deck over the wave path in 1/(2 pi) of a cycle

_SHORTEST_STEP, _LONGEST_STEP = 1e-4, 0.02

_SHARE_OF_LAG = 0.02
"""Time step as a share of the lag of strain behind tension: MoorDyn gives the tension of the middle
of its last step, and a delay of half a step lowers the hysteresis energy by 1 %. [1]"""

_COLUMNS = (
    "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
    "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
)


def deck_length(line: ExportLine) -> float:
    """Length of the line in a deck: its own length where it has one. [m].

    Else short enough for a wave to pass along it well within the measured cycle: in a soft line
    that moves fast, inertia would otherwise affect the result of the deck.
    """
    if math.isfinite(line.unstretched_length):
        return line.unstretched_length
    speed = math.inf
    if line.damping is not None and line.linear_density > 0:
        rate = 2 * math.pi * line.damping.frequency
        speed = math.sqrt(line.damping.apparent_stiffness / line.linear_density) / rate
    return min(_LENGTH, _OF_WAVE * speed) if speed > 0 else _LENGTH


def segment_length(line: ExportLine) -> float:
    """Length of a segment of the line in a deck. [m]."""
    return deck_length(line) / _SEGMENTS


def _line_type(line: ExportLine, stiffness: str, damping: str) -> str:
    """Return the row of the line types."""
    water = line.hydrodynamics
    numbers = (water.normal_drag, water.normal_added_mass, water.axial_drag, water.axial_added_mass)
    diameter, mass = line.volume_diameter[0], line.needed("linear_density")
    row = (line.identifier, number(diameter), number(mass), stiffness, damping, "0")
    return " ".join((*row, *map(number, numbers)))


def _deck(
    line: ExportLine,
    row: str,
    head: list[str],
    *,
    strain: float,
    stiffness: float,
    damping: float = 0.0,
    lag: float = math.inf,
    conditions: tuple[str, ...] = (),
    program: str = "MoorDyn",
) -> str:
    """A complete input file: one line between two points, with a strain that it can have."""
    length = deck_length(line)
    segments, step = _steps(line.needed("linear_density"), stiffness, damping, segment_length(line))
    step = min(step, max(_SHARE_OF_LAG * lag, _SHORTEST_STEP))
    # keeps the upper end under water, however long the line is
    depth = max(_DEPTH, 2 * length * (1 + strain))
    top = length * (1 + strain) - depth
    rule = "-" * 22
    return "\n".join(
        [
            f"{program} input file with one line type, in a small test deck",
            WEIGHTLESS,
            *head,
            f"{rule} LINE TYPES {rule}",
            *_COLUMNS,
            row,
            f"{rule} POINTS {rule}",
            "ID Attachment X Y Z Mass Volume CdA Ca",
            "(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)",
            f"1 Fixed 0 0 {number(-depth)} 0 0 0 0",
            f"2 Coupled 0 0 {number(top)} 0 0 0 0",
            f"{rule} LINES {rule}",
            "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
            "(-) (name) (ID) (ID) (m) (-) (-)",
            f"1 {line.identifier} 1 2 {number(length)} {segments} -",
            *conditions,
            f"{rule} OPTIONS {rule}",
            "0 writeLog",
            "1 disableOutTime",
            NO_GRAVITY,
            f"{number(2 * depth)} WtrDpth",
            f"{step:.3g} dtM",
            "10 TmaxIC",
            "0.1 dtIC",
            f"{rule} OUTPUTS {rule}",
            "FairTen1",
            "AnchTen1",
            f"{rule} need this line {rule}",
            "",
        ]
    )


def _steps(mass: float, stiffness: float, damping: float, apart: float) -> tuple[int, float]:
    """Segments of the deck and a stable time step; one segment where five need a tiny step."""
    step = _COURANT * apart * math.sqrt(mass / stiffness)
    if damping > 0:
        step = min(step, _COURANT * mass * apart**2 / damping)
    if step < _SHORTEST_STEP:
        return 1, _LONGEST_STEP  # no node is free
    return _SEGMENTS, min(step, _LONGEST_STEP)


OpenFastForm = Literal["table", "damped-table", "static-dynamic"]

MoorDynForm = Literal[OpenFastForm, "load-dependent", "syrope"]

TABLE_POINTS = 29
"""Rows of a curve: MoorDyn accepts 30, and one of them is beyond the end of the curve. [1]"""

NUMERICAL_DAMPING = -1.0
"""Internal damping where none was measured, in MoorDyn's form: share of critical. [1]"""

_FAST_SHARE = 0.1


def _table_text(line: ExportLine, curve: ThinnedCurve) -> str:
    """Look-up table: three lines of header, rows with one blank, no line end at the end."""
    low, high = line.measured
    where = (
        f"tested {plain_number(low, 4)} to {plain_number(high, 4)}"
        if low == low
        else "nothing tested"
    )
    made = "SYNTHETIC; " if line.is_synthetic else ""
    first = one_line(
        f"{line.name}; {made}{line.curve}; error {plain_number(curve.error, 3)} N; {where}; "
        f"{'; '.join(line.sources)}"
    )
    rows = zip(curve.strain, curve.tension, strict=True)
    return "\n".join(
        [first, "Strain Tension", "(-) (N)", *(f"{number(e)} {number(t)}" for e, t in rows)]
    )


def _continued(line: ExportLine, curve: ThinnedCurve) -> ThinnedCurve:
    """One more row on a straight line: these programs keep the last tension beyond the last row."""
    further = float(f"{(1 + CONTINUED) * float(curve.strain[-1]):.10g}")
    beyond = float(continued_tension(line, further))
    return replace(
        curve,
        strain=np.append(curve.strain, further),
        tension=np.append(curve.tension, float(f"{beyond:.10g}")),
    )


_BEYOND = (
    f"the last row of the table is {100 * CONTINUED:g} percent beyond the end of the curve,"
    " extrapolated at its last slope without test data; beyond it the program keeps the last"
    " tension"
)


def fast_damping(stiffness: float, linear_density: float, apart: float) -> float:
    """Numerical damping of the fast spring, a tenth of critical for the segments of a deck. [N s].

    Examples
    --------
    >>> fast_damping(5e4, 0.5, 2.0)
    31.622776601683796
    """
    return _FAST_SHARE * apart * math.sqrt(stiffness * linear_density)


def moordyn_files(line: ExportLine, stem: str, *, form: MoorDynForm = "table") -> dict[str, str]:
    """Files of a line type for MoorDyn, the deck first.

    Notes
    -----
    EA_s is K_0 and EA_d is K_0 + K_1 of [2]_.  MoorDyn puts the slow spring and its dashpot in
    series with EA_d, [2]_ puts a spring and a dashpot in series beside K_0: the same line, but
    not the same dashpot; see `Viscoelasticity.slow_dashpot_coefficient`.
    """
    if form in ("table", "damped-table"):
        return _table_files(line, stem, is_damped=form == "damped-table")
    if form == "syrope":
        return _syrope_files(line, stem)
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"static and dynamic stiffness of {line.name} are not known",
            needed="a published rope, or a campaign with cycles of a rope and its slow pull, with "
            "all of --frequency, --mean-tension and --tension-amplitude",
            hint="State the three levels, or export the curve instead: --form table.",
        )
    apart = segment_length(line)
    fast = fast_damping(part.fast_stiffness, line.needed("linear_density"), apart)
    damping = f"{number(part.slow_dashpot_coefficient)}|{number(fast)}"
    if form == "static-dynamic":
        stiffness = f"{number(part.static_stiffness)}|{number(part.fast_stiffness)}"
    else:
        slope = part.dynamic_stiffness_per_mean_tension
        if not slope > 0:
            raise SettingsError(
                f"no growth of the dynamic stiffness of {line.name} with the mean tension can be "
                "written",
                found=part.growth or f"slope {slope:g}",
                needed="a slope above zero, and a stiffness above zero at no tension",
                hint="Use --form static-dynamic.",
            )
        stiffness = "|".join(map(number, (part.static_stiffness, part.dynamic_stiffness, slope)))
    head = header_lines(
        line,
        None,
        *_said(line),
        *_stiffness_words(part),
        about_mean(line),
        *(() if form == "static-dynamic" else (_running_words(part),)),
        f"BA_d {plain_number(fast, 4)} N s: {_FAST_SHARE:g} of critical for segments of {apart:g} "
        "m, numerical, not measured; without it the integration grows",
    )
    return {
        "": _deck(
            line,
            _line_type(line, stiffness, damping),
            head,
            strain=line.strain[-1] / 2,
            stiffness=part.fast_stiffness,
            lag=part.lag,
        )
    }


def _stiffness_words(part: Viscoelasticity) -> tuple[str, ...]:
    """Description of the stiffness values."""
    return (
        f"EA_s {plain_number(part.static_stiffness, 6)} N is K_0; EA_d"
        f" {plain_number(part.fast_stiffness, 6)} N is K_0 + K_1; relaxation time"
        f" {part.relaxation_time:.4g} s",
        f"the dashpot beside the slow spring is {plain_number(part.slow_dashpot_coefficient, 6)} N"
        f" s, which behaves as N = K_1 tau = {plain_number(part.dashpot_coefficient, 6)} N s of the"
        " Maxwell form",
        f"found at {part.holds}" if part.holds else "",
    )


def _running_words(part: Viscoelasticity) -> str:
    """Values of a cycle where the stiffness follows the running tension."""
    if not math.isfinite(part.frequency):
        return "MoorDyn uses the running tension of the slow part as the mean"
    running, held = part.running_stiffness_at(part.frequency), part.stiffness_at(part.frequency)
    # H = pi T_a^2 E'' / K_ap^2: a cycle of the same tension amplitude strains less if stiffer
    energy = running.imag / held.imag * (abs(held) / abs(running)) ** 2
    return (
        "MoorDyn uses the running tension of the slow part as the mean: a small cycle at"
        f" {plain_number(part.frequency, 4)} Hz differs from static-dynamic by"
        f" {100 * (abs(running) / abs(held) - 1):+.1f} percent in K_ap,"
        f" {plain_number(abs(running))} N, and by {100 * (energy - 1):+.1f} percent in hysteresis"
        " energy at equal tension amplitude; where the energy matters, use static-dynamic"
    )


def _said(line: ExportLine) -> tuple[str, ...]:
    return (
        line.volume_diameter[1],
        f"hydrodynamic coefficients: {line.hydrodynamics.source}",
        "bending stiffness 0: not measured",
    )


def _table_files(
    line: ExportLine, stem: str, *, is_damped: bool, takes_share: bool = True
) -> dict[str, str]:
    """Deck and table; ``takes_share`` is whether damping may be a share of critical."""
    curve = thin_curve(line.strain, line.tension, most=TABLE_POINTS)
    table = f"{stem}_table.txt"
    damping = _dashpot_of(line) if is_damped else None
    steepest = float(np.max(np.diff(curve.tension) / np.diff(curve.strain)))
    coefficient = 0.0 if damping is None else damping.coefficient
    written, words = coefficient or NUMERICAL_DAMPING, _NUMERICAL
    if damping is not None:
        words = damping_words(damping)
    elif not takes_share:
        written = fast_damping(steepest, line.needed("linear_density"), segment_length(line))
        words = (
            f"internal damping {plain_number(written, 4)} N s: {_FAST_SHARE:g} of critical for "
            f"segments of {segment_length(line):g} m, numerical, not measured"
        )
    head = header_lines(
        line,
        curve,
        *_said(line),
        words,
        "" if is_damped else without_damping(line),
        _BEYOND,
        f"{table} must be in the folder of this file",
    )
    row = _line_type(line, table, number(written))
    strain = line.strain[-1] / 2
    return {
        "": _deck(
            line,
            row,
            head,
            strain=strain,
            stiffness=steepest,
            damping=coefficient,
            lag=coefficient / steepest if is_damped else math.inf,
        ),
        table: _table_text(line, _continued(line, curve)),
    }


_NUMERICAL = (
    f"internal damping {NUMERICAL_DAMPING:g}: MoorDyn reads a negative number as a share of the "
    "critical damping of each segment; numerical, not measured"
)


def _dashpot_of(line: ExportLine) -> CycleDamping:
    if line.damping is None:
        raise SettingsError(
            f"the hysteresis energy of the cycles of {line.name} is not known",
            needed="the archive of one cyclic test whose loop has an energy above zero, and its "
            "mean curve",
            hint="Export the curve without it: --form table.",
        )
    return line.damping


_NO_GROWTH = 1e-6  # share of the dynamic stiffness, over a curve: zero growth gives NaN


def _syrope_files(line: ExportLine, stem: str) -> dict[str, str]:
    part = line.syrope
    if part is None:
        raise SettingsError(
            f"{line.name} has no Syrope working curves",
            needed="original working curve, alpha, beta, k1, k2 and where the line starts",
            hint="For a published line with levels: --working-curve, --greatest-mean-tension.",
        )
    curve = thin_curve(part.strain, part.tension, most=TABLE_POINTS)
    working, settings = f"{stem}_owc.dat", f"{stem}_syrope.dat"
    alpha, beta = part.dynamic_stiffness, part.dynamic_stiffness_per_mean_tension
    no_growth = ""
    if not beta:
        beta = _NO_GROWTH * alpha / float(part.tension[-1])
        no_growth = (
            f"beta {beta:.3g} in place of zero, by which MoorDyn divides: the dynamic stiffness "
            "grows by a millionth over the curve"
        )
    row = _line_type(
        line,
        f"SYROPE:{settings}|{number(alpha)}|{number(beta)}",
        f"{number(part.slow_damping)}|{number(part.fast_damping)}",
    )
    rule = "-" * 22
    conditions = (
        f"{rule} SYROPE IC {rule}",
        "Line(s) Tmax0 Tmean0",
        "(-) (N) (N)",
        f"1 {number(part.greatest_mean_tension)} {number(part.mean_tension)}",
    )
    head = header_lines(
        line,
        curve,
        *_said(line),
        f"Syrope, working curves of the form {part.form}; the curve named here is the original one",
        _working_words(part, line.viscoelasticity),
        no_growth,
        _BEYOND,
        f"{settings} and {working} must be in the folder of this file",
    )
    return {
        "": _deck(
            line,
            row,
            head,
            strain=part.initial_strain,
            stiffness=alpha + beta * float(part.tension[-1]),
            damping=part.fast_damping,
            lag=replace(part.about_mean, frequency=working_frequency(part, line)).lag,
            conditions=conditions,
        ),
        settings: _syrope_text(part, working),
        working: _table_text(
            line, _continued(replace(line, strain=part.strain, tension=part.tension), curve)
        ),
    }


def working_frequency(syrope: Syrope, line: ExportLine) -> float:
    """Frequency of the levels of a line, else that of greatest loss in its dashpot. [Hz]."""
    part = line.viscoelasticity
    if part is not None and math.isfinite(part.frequency):
        return part.frequency
    return 1 / (2 * math.pi * syrope.about_mean.relaxation_time)


def _working_words(syrope: Syrope, part: Viscoelasticity | None) -> str:
    """Values of a cycle on the working curve, whose slope replaces K_0."""
    about = syrope.about_mean
    slope = f"slope of the working curve at the mean {plain_number(about.static_stiffness, 6)} N"
    if part is None or not math.isfinite(part.frequency):
        return slope
    found, asked = about.stiffness_at(part.frequency), part.stiffness_at(part.frequency)
    return (
        f"{slope}, K_0 {plain_number(part.static_stiffness, 6)} N: a small cycle at "
        f"{plain_number(part.frequency, 4)} Hz has K_ap {plain_number(abs(found), 6)} N, "
        f"{100 * (abs(found) / abs(asked) - 1):+.1f} percent from static-dynamic, and "
        f"{100 * (found.imag / asked.imag - 1):+.1f} percent in hysteresis energy at equal stretch"
    )


def _syrope_text(part: Syrope, working: str) -> str:
    return "\n".join(
        [
            f"{working} OWC",
            f"{part.form} WCType",
            f"{number(part.k1)} k1",
            f"{number(part.k2)} k2",
        ]
    )


MoorPyForm = Literal["table", "library"]


def moorpy_files(line: ExportLine, stem: str, *, form: MoorPyForm = "table") -> dict[str, str]:
    """Files of a line type for MoorPy, the deck or the library first."""
    if form == "library":
        return {"": _library(line)}
    curve, table = thin_curve(line.strain, line.tension, most=TABLE_POINTS), f"{stem}_moorpy.txt"
    row = _line_type(line, f"|{table}|", number(NUMERICAL_DAMPING))
    head = header_lines(
        line,
        curve,
        line.volume_diameter[1],
        f"hydrodynamic coefficients: {line.hydrodynamics.source}",
        without_damping(line),
        _BEYOND,
        f"MoorPy looks for {table} in the working folder: start it there",
        "MoorPy 1.2, which RAFT 2.0 brings, takes no table (KeyError 'EA'): use 1.3, or --to raft",
        "with a table MoorPy treats the line as straight, with half its weight at each end",
    )
    steepest = float(np.max(np.diff(curve.tension) / np.diff(curve.strain)))
    text = _deck(
        line, row, head, strain=float(line.strain[-1]) / 2, stiffness=steepest, program="MoorPy"
    )
    return {"": text, table: f"{_table_text(line, _continued(line, curve))}\n---"}


def _library(line: ExportLine) -> str:
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"static and dynamic stiffness of {line.name} are not known",
            needed="a published rope, or a campaign with cycles of a rope and its slow pull, with "
            "all of --frequency, --mean-tension and --tension-amplitude: the library is linear",
            hint="State the three levels, or export the curve instead: --form table.",
        )
    strength, diameter = line.needed("rated_break_strength"), line.needed("diameter")
    mass, water = line.needed("linear_density"), line.hydrodynamics
    beta = part.dynamic_stiffness_per_mean_tension
    volume, words = line.volume_diameter
    head = header_lines(
        line,
        None,
        words,
        f"hydrodynamic coefficients: {water.source}",
        without_damping(line),
        f"holds for the diameter {1000 * diameter:.4g} mm only",
        about_mean(line),
        f"found at {part.holds}" if part.holds else "",
        "the dynamic stiffness is K_ap at that frequency, since the library has no damping; "
        f"K_0 + K_1, that of fast cycles, is {plain_number(part.fast_stiffness, 6)} N"
        if math.isfinite(part.frequency)
        else "",
    )
    slow = part.apparent_stiffness - part.fast_stiffness
    rows = {
        "mass_d2": mass / diameter**2,
        "MBL_d2": strength / diameter**2,
        "EA_MBL": part.static_stiffness / strength,
        "EAd_MBL": (part.dynamic_stiffness + slow) / strength,
        "EAD_LM": beta,
        "EAd_MBL_Lm": beta,
        "dvol_dnom": volume / diameter,
        "Cd": water.normal_drag,
        "Cd_ax": water.axial_drag,
        "Ca": water.normal_added_mass,
        "Ca_ax": water.axial_added_mass,
    }
    text = [f"    {name}: {real_number(value)}" for name, value in rows.items()]
    return "\n".join(
        [f"# {one}" for one in head] + ["lineProps:", f'  "{line.identifier}":', *text, ""]
    )


# OpenFAST passes its own gravity to the module, unless the file has another
_LEFT_OUT = ("0 writeLog", "1 disableOutTime", "10 TmaxIC", "0.1 dtIC", NO_GRAVITY, WEIGHTLESS)

_ABOUT_GRAVITY = "gravity is that of OpenFAST: the line sags, and has more tension than its strain"


_NAME, _FILE = 20, 40
"""Characters after which MoorDyn-F cuts the names of a line type and of a table. [1]"""

_DIGEST = 6


def _shortened(name: str, most: int) -> str:
    """NAME within MOST characters, made unique by a digest where it is cut."""
    if len(name) <= most:
        return name
    return f"{name[: most - _DIGEST - 1]}_{sha256(name.encode()).hexdigest()[:_DIGEST]}"


def openfast_files(line: ExportLine, stem: str, *, form: OpenFastForm = "table") -> dict[str, str]:
    """Files of a line type for OpenFAST, the input file of its MoorDyn module first."""
    stem = _shortened(stem, _FILE - len("_table.txt"))
    files = (
        _table_files(line, stem, is_damped=False, takes_share=False)
        if form == "table"
        else moordyn_files(line, stem, form=form)
    )
    remarks = [f"for MoorDyn of OpenFAST 5.0, run with its driver; {_ABOUT_GRAVITY}"]
    if len(files) > 1:
        remarks.append("the program looks for the table in the folder where it is started")
    if form == "static-dynamic":
        remarks.append(
            "the program starts with the whole strain in the slow spring: leave out the first ten "
            "relaxation times"
        )
    first, *rest = files.pop("").split("\n")
    said = header_lines(line, None, *remarks)
    said = said[next(place for place, text in enumerate(said) if text.startswith("Remark")) :]
    named, short = f"{line.identifier} ", f"{_shortened(line.identifier, _NAME)} "
    kept = [
        row.replace(named, short, 1) if row.startswith((named, f"1 {named}")) else row
        for row in rest
        if row not in _LEFT_OUT
    ]
    return {"": "\n".join([first, *said, *kept]), **files}
