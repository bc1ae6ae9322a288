"""Export formats: the files of each format, and the accuracy of their curves."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Literal, get_args

import numpy as np
import scipy

from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.workbook import write_workbook
from reduction.lines.deck_moordyn import (
    TABLE_POINTS,
    OpenFastForm,
    deck_length,
    moordyn_files,
    moorpy_files,
    openfast_files,
)
from reduction.lines.deck_text import header_lines, one_line, real_number
from reduction.lines.export_line import (
    CONTINUED,
    SEA_WATER,
    ExportLine,
    about_mean,
    continued_tension,
    curve_from_zero,
    damping_words,
    end_slope,
    local_share,
    local_words,
    straight_cycle,
    thin_curve,
    without_damping,
)
from reduction.lines.export_tables import (
    ValueTable,
    curve_table,
    sheets_of_table,
    table_text_of,
    write_netcdf,
)
from reduction.quantities.digits import plain_number
from reduction.quantities.units import UnitSystem
from reduction.record.errors import SettingsError
from reduction.record.measurement import STANDARD_GRAVITY, Floats, read_only_arrays

ABAQUS_POINTS = 200
"""Rows of a table. [1]"""


def _abaqus_text(line: ExportLine) -> str:
    """A material for Abaqus, nominal stress and nominal strain.

    Notes
    -----
    Stress is tension over the area of the nominal diameter at zero tension.  The Marlow potential
    takes the data as they are; it needs the origin among them.
    """
    curve = thin_curve(line.strain, line.tension, most=ABAQUS_POINTS)
    diameter = line.needed("diameter")
    area = math.pi / 4 * diameter**2
    head = header_lines(
        line,
        curve,
        f"nominal stress in Pa: tension over {area:.6g} m2, of the nominal diameter "
        f"{1000 * diameter:.4g} mm at zero tension; nominal strain",
        f"greatest error in stress {curve.error / area:.3g} Pa",
        "stress stands before strain",
    )
    rows = [
        f"{real_number(t / area)}, {real_number(e)}"
        for e, t in zip(curve.strain, curve.tension, strict=True)
    ]
    text = [f"** {one}" for one in head]
    text += [f"*MATERIAL, NAME={_name(line)}", "*HYPERELASTIC, MARLOW", "*UNIAXIAL TEST DATA"]
    return "\n".join([*text, *rows, ""])


def _name(line: ExportLine) -> str:
    """A label of Abaqus begins with a letter and has at most 80 characters."""
    name = line.identifier.replace("-", "_")[:78]
    return name if name[0].isalpha() else f"M_{name}"


ORCAFLEX_POINTS = 100
"""Rows of a table. [1]"""

_PER_KILO = 1e-3


def _orcaflex_text(line: ExportLine) -> str:
    """A text data file for OrcaFlex."""
    curve = thin_curve(line.strain, line.tension, most=ORCAFLEX_POINTS)
    volume, words = line.volume_diameter
    mass, water = line.needed("linear_density"), line.hydrodynamics
    nominal = line.diameter if line.diameter > 0 else volume
    share = volume / nominal
    normal, axial = share * water.normal_drag, share * water.axial_drag
    head = header_lines(
        line,
        curve,
        "syntax checked only: OrcaFlex was not run; inspect the line type before use",
        words.removesuffix(f"; drag refers to it, and not to the nominal {1000 * nominal:.4g} mm"),
        f"hydrodynamic coefficients: {water.source}",
        f"OD, for buoyancy and added mass, is the volume-equivalent diameter {1000 * volume:.4g} "
        f"mm; drag diameters are the nominal one, {1000 * nominal:.4g} mm: Cd of the volume "
        f"diameter, {water.normal_drag:.4g} across and {water.axial_drag:.4g} along, as MoorDyn "
        f"has them, is times {share:.4g} here, since Cd times diameter is the drag; Ca refers to "
        f"the displaced volume in both, and of the nominal one would be {share**2:.4g} times as "
        "much",
        "bending and torsion stiffness 0: not measured",
        without_damping(line),
        "units of the file: kN, te, m",
    )
    name = f"{line.identifier} axial stiffness"
    rows = [
        f"        - [{real_number(e)}, {real_number(_PER_KILO * t)}]"
        for e, t in zip(curve.strain, curve.tension, strict=True)
    ]
    text = [
        "%YAML 1.1",
        "# Type: Model",
        "# Program: OrcaFlex 11.6b",
        *(f"# {one}" for one in head),
        "---",
        "General:",
        "  UnitsSystem: SI",
        "VariableData:",
        "  Axialstiffness:",
        f'    - Name: "{name}"',
        "      IndependentValue, DependentValue:",
        *rows,
        "LineTypes:",
        f'  - Name: "{line.identifier}"',
        "    Category: General",
        f"    OD: {real_number(volume)}",
        "    ID: 0.0",
        f"    MassPerUnitLength: {real_number(_PER_KILO * mass)}",
        "    EIx: 0.0",
        "    EIy: ~",
        f'    EA: "{name}"',
        "    GJ: ~",
        "    PoissonRatio: 0.5",
        f"    Cd: [{real_number(normal)}, ~, {real_number(axial)}]",
        f"    NormalDragLiftDiameter: {real_number(nominal)}",
        f"    AxialDragLiftDiameter: {real_number(nominal)}",
        f"    Ca: [{real_number(water.normal_added_mass)}, ~,"
        f" {real_number(water.axial_added_mass)}]",
        "",
    ]
    return "\n".join(text)


def _raft_text(line: ExportLine) -> str:
    """The mooring section of a design for RAFT, whose lines have one stiffness.

    Notes
    -----
    RAFT computes the mean position and the motion in waves with it, so its line is the straight
    line through the turns of the cycle.  That line has no tension at the strain e0, and is written
    as a line of 1 + e0 times the length and K_ap (1 + e0): tension over length is the same, and so
    are mass, volume and drag of the whole line.
    """
    cycle = straight_cycle(line)
    if cycle is None:
        raise SettingsError(
            f"no cycle of {line.name} is known, and RAFT takes a single stiffness",
            needed="--frequency, --mean-tension and --tension-amplitude of a line with surfaces, "
            "below the end of its curve, or the archive of a cyclic test and its mean curve",
        )
    share = 1 + cycle.slack_strain
    if share <= 0:
        raise SettingsError(
            f"the straight line of the cycle of {line.name} has tension at any length",
            found=f"no tension at strain {cycle.slack_strain:.4g}", needed="a strain above -1",
        )  # fmt: skip
    length, (volume, words), water = deck_length(line), line.volume_diameter, line.hydrodynamics
    mass = line.needed("linear_density")
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    straight = cycle.tension + cycle.stiffness * (strain - cycle.strain)
    off = np.abs(straight - tension) / tension[-1]
    inside = np.abs(strain - cycle.strain) <= 3 * cycle.strain_amplitude
    head = header_lines(
        line,
        None,
        "RAFT has one stiffness and no damping per line: this is the linear stiffness of one cycle,"
        f" K_ap {plain_number(cycle.stiffness, 6)} N about {plain_number(cycle.tension, 6)} N and"
        f" strain {cycle.strain:.6g}, {cycle.holds}",
        f"its hysteresis energy, {plain_number(cycle.hysteresis_energy, 4)} J/m, is NOT included",
        "it differs from the slow curve by up to"
        f" {plain_number(100 * float(off[inside].max(initial=0)), 2)} percent of the greatest"
        " tension within three amplitudes of the mean, and by"
        f" {plain_number(100 * float(off.max()), 2)} percent over the whole of it: export again for"
        " another mean",
        f"a line of {length:g} m is written as {length * share:.6g} m, the length at which the "
        f"straight line has no tension: take {share:.6g} times the length of yours, too; "
        "stiffness, mass and diameter are per length of that, so that the whole line keeps its own",
        words,
        f"hydrodynamic coefficients: {water.source}",
    )
    strength = line.rated_break_strength
    of_area = math.sqrt(share)
    rows = {
        "diameter": volume / of_area,
        "mass_density": mass / share,
        "stiffness": cycle.stiffness * share,
        "breaking_load": strength if math.isfinite(strength) else 0.0,
        "cost": 0.0,
        "transverse_added_mass": water.normal_added_mass,
        "tangential_added_mass": water.axial_added_mass,
        "transverse_drag": water.normal_drag / of_area,
        "tangential_drag": water.axial_drag / of_area,
    }
    deep = length * (1 + cycle.strain)
    text = [
        "mooring:",
        f"  water_depth: {real_number(2 * deep)}",
        "  points:",
        f"    - {{name: anchor, type: fixed, location: [0.0, 0.0, {real_number(-deep)}]}}",
        "    - {name: fairlead, type: vessel, location: [0.0, 0.0, 0.0]}",
        "  lines:",
        f'    - {{name: line, endA: anchor, endB: fairlead, type: "{line.identifier}", '
        f"length: {real_number(length * share)}}}",
        "  line_types:",
        f'    - name: "{line.identifier}"',
        *(f"      {name}: {real_number(value)}" for name, value in rows.items()),
        "",
    ]
    return "\n".join([*(f"# {one}" for one in head), *text])


_DEGREE = 2

_FIRST, _MOST = 4, 48

_SHORTEST = 1e-3

_ENOUGH = 1e-3  # share of the greatest tension

_ENOUGH_THERE, _FROM = 5e-3, 0.05  # share of the local tension, at least this share of the greatest

_LEAST_SLOPE = 1e-6

_GRID = 801


@dataclass(frozen=True)
@read_only_arrays
class _SmoothCurve:
    """Cubic pieces of a curve."""

    start: Floats
    end: float
    coefficient: Floats
    error: float
    share: float
    local: float
    words: str


def _fit_smooth_curve(strain: Floats, tension: Floats) -> _SmoothCurve:
    """Fit a rising cubic spline to a curve.

    Notes
    -----
    The first pieces begin at the points of the curve thinned to five points; then the piece with
    the worst error is halved repeatedly, but not below a thousandth of the strain. Errors are
    compared with a thousandth of the greatest tension, or 0.5 % of the local tension: the strain at
    a tension should be right to 1 %. Least squares on a uniform grid and on the points; the error
    is the greatest one anywhere.

    Examples
    --------
    >>> at = np.linspace(0, 1, 50)
    >>> _fit_smooth_curve(at, 100 * at**3).share < 1e-3
    True
    """
    at, load, words = curve_from_zero(strain, tension)
    end, top = float(at[-1]), float(load[-1])
    grid = np.union1d(np.linspace(0.0, end, _GRID), at)
    wanted = np.interp(grid, at, load)
    knots = thin_curve(at, load, most=_FIRST + 1).strain[:-1]
    knots = knots[np.append(True, np.diff(knots) > _SHORTEST * end)]
    knots = knots[end - knots > _SHORTEST * end]
    best = _fitted(grid, wanted, knots, end, top)
    error, worst, place = _greatest_error(best, at, load)
    while worst > 1 and knots.size < _MOST:
        bounds = np.append(knots, end)
        piece = min(int(np.searchsorted(knots, place, side="right")), knots.size) - 1
        if bounds[piece + 1] - bounds[piece] <= 2 * _SHORTEST * end:
            piece = int(np.diff(bounds).argmax())
        knots = np.insert(knots, piece + 1, (bounds[piece] + bounds[piece + 1]) / 2)
        # more knots never fit worse, but one bend may stay the worst
        best = _fitted(grid, wanted, knots, end, top)
        error, worst, place = _greatest_error(best, at, load)
    local = local_share(best(grid) - wanted, wanted, top)
    return _SmoothCurve(
        best.x[:-1].copy(), end, best.c[::-1].T.copy(), error, error / top, local, words
    )


def _greatest_error(
    fitted: scipy.interpolate.PPoly, at: Floats, load: Floats
) -> tuple[float, float, float]:
    """Greatest difference from the straight lines between the points; the worst, and its strain.

    The worst is taken relative to the tolerance at its place.
    """
    breaks = np.union1d(at, fitted.x)
    step = np.clip(np.searchsorted(at, breaks[:-1], "right") - 1, 0, at.size - 2)
    slope = (np.diff(load) / np.diff(at))[step]
    # at equal slopes: a quadratic in the strain above the start of the piece
    piece = np.clip(np.searchsorted(fitted.x, breaks[:-1], "right") - 1, 0, fitted.c.shape[1] - 1)
    cubic, square, linear = fitted.c[:3, piece]
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(square**2 - 3 * cubic * (linear - slope))
        both = np.stack([(-square + root) / (3 * cubic), (-square - root) / (3 * cubic)])
        flat = (slope - linear) / (2 * square)
    places = fitted.x[piece] + np.concatenate([both, flat[np.newaxis]])
    inside = (places > breaks[:-1]) & (places < breaks[1:])
    places = np.concatenate([breaks, places[inside]])
    there = np.interp(places, at, load)
    off = np.abs(fitted(places) - there)
    enough = _ENOUGH_THERE * np.maximum(there, _FROM * load[-1])
    over = off / np.minimum(enough, _ENOUGH * load[-1])
    return float(off.max()), float(over.max()), float(places[over.argmax()])


def _fitted(
    grid: Floats, wanted: Floats, knots: Floats, end: float, top: float
) -> scipy.interpolate.PPoly:
    """Integral of positive quadratic B-splines from 0 0, as pieces."""
    whole = np.concatenate([[0.0] * _DEGREE, knots, [end] * (_DEGREE + 1)])
    count = whole.size - _DEGREE - 1
    integrals = [
        scipy.interpolate.BSpline(whole, row, _DEGREE, extrapolate=True).antiderivative()
        for row in np.eye(count)
    ]
    columns = np.stack([one(grid) - one(0.0) for one in integrals], axis=1)
    least = _LEAST_SLOPE * top / end
    weights, _ = scipy.optimize.nnls(
        columns / end, wanted / top - columns.sum(axis=1) * least / top
    )
    slope = scipy.interpolate.BSpline(whole, least + weights * top / end, _DEGREE)
    pieces = scipy.interpolate.PPoly.from_spline(slope.antiderivative().tck)
    # from_spline keeps the repeated knots as empty pieces
    real = np.flatnonzero(np.diff(pieces.x) > 0)
    bounds = np.append(pieces.x[real], end)
    coefficient = pieces.c[:, real].copy()
    coefficient[-1] -= coefficient[-1, 0]
    return scipy.interpolate.PPoly(coefficient, bounds)


WhoiCableForm = Literal["expression", "table"]

CABLE_POINTS = 100
"""Pairs of a table. [1]"""


_SMALL = 1e-4  # bending and torsion were not measured, and zero would be singular


def _whoicable_text(line: ExportLine, *, form: WhoiCableForm = "expression") -> str:
    """A materials section for WHOI Cable."""
    smooth = _fit_smooth_curve(line.strain, line.tension)
    curve = thin_curve(line.strain, line.tension, most=CABLE_POINTS)
    at, load, _ = curve_from_zero(line.strain, line.tension)
    start, powers = _with_straight_ends(smooth, end_slope(at, load))
    tension = _expression(start, powers)
    remarks = [
        f"expressions: {smooth.start.size} cubic pieces, greatest error"
        f" {plain_number(smooth.error, 3)} N {local_words(smooth)}; beyond strain {smooth.end:.6g}"
        " and below zero a straight line goes on and nothing is known"
    ]
    if form == "table":
        # Cable continues with the last step of a table, which may be a bend
        further = (1 + CONTINUED) * float(at[-1])
        beyond = float(continued_tension(line, further))
        pairs = [*zip(curve.strain, curve.tension, strict=True), (further, beyond)]
        tension = " ".join(f"({real_number(e)}, {real_number(t)})" for e, t in pairs)
        remarks[0] = f"Te and Tee from a spline; {remarks[0]}"
    volume, words = line.volume_diameter
    mass, water = line.needed("linear_density"), line.hydrodynamics
    wet = (mass - SEA_WATER * math.pi / 4 * volume**2) * STANDARD_GRAVITY
    strength = line.rated_break_strength
    along = water.axial_added_mass
    head = header_lines(
        line,
        curve,
        *remarks,
        f"added mass along the line, {along:g}, left out: Cable has none" if along else "",
        words,
        f"hydrodynamic coefficients: {water.source}",
        without_damping(line),
        f"EI and GJ {_SMALL:g}: not measured; wet in N/m in water of {SEA_WATER:g} kg/m3",
        "EA: secant over the whole curve, as a first guess of the program",
        "Cable needs some horizontal force for a static solution",
    )
    rows = {
        "type": "nonlinear",
        "T": tension,
        "Te": _expression(start, powers[:, 1:] * (1.0, 2.0, 3.0)),
        "Tee": _expression(start, powers[:, 2:] * (2.0, 6.0)),
        "EA": real_number(float(curve.tension[-1] / curve.strain[-1])),
        "EI": real_number(_SMALL),
        "GJ": real_number(_SMALL),
        "m": real_number(mass),
        "d": real_number(volume),
        "wet": real_number(wet),
        "am": real_number(water.normal_added_mass * SEA_WATER * math.pi / 4 * volume**2),
        "Cdn": real_number(water.normal_drag),
        "Cdt": real_number(water.axial_drag),
        "SWL": "0.0",
        "yield": real_number(strength) if math.isfinite(strength) else "0.0",
        "comment": f'"{one_line(line.curve)}"',
    }
    text = [f"/* {one} */" for one in head]
    text += ["", "Materials", f'    "{line.identifier}"']
    text += [f"        {name} = {value}" for name, value in rows.items()]
    return "\n".join([*text, "", "End", ""])


def _with_straight_ends(curve: _SmoothCurve, beyond: float) -> tuple[Floats, Floats]:
    """Pieces with a straight one before the first, at its slope, and one after the last.

    Beyond its last point a cubic may fall, and Cable finds an equilibrium there; ``beyond`` [N] is
    the slope of the straight continuation, which the last cubic does not have.
    """
    linear = float(curve.coefficient[0, 1])
    top = float(np.polyval(curve.coefficient[-1, ::-1], curve.end - curve.start[-1]))
    below, above = [0.0, linear, 0.0, 0.0], [top, beyond, 0.0, 0.0]
    powers = np.vstack([below, curve.coefficient, above])
    # the piece before the first one starts at the same place, strain zero
    return np.concatenate([[0.0], curve.start, [curve.end]]), powers


def _expression(start: Floats, powers: Floats) -> str:
    """Pieces selected by ``?:``, each in Horner's form with the variable ``e``."""
    text = ""
    for piece in range(len(powers) - 1, -1, -1):
        here = f"(e - {real_number(float(start[piece]))})"
        polynomial = ""
        for power in reversed(powers[piece]):
            value = real_number(abs(float(power)))
            value = f"(-{value})" if power < 0 else value
            polynomial = f"({value} + {here}*{polynomial})" if polynomial else value
        if piece == len(powers) - 1:
            text = polynomial
        else:
            end = real_number(float(start[piece + 1]))
            text = f"((e < {end}) ? {polynomial} : {text})"
    return text


TABLES = ("csv", "json", "latex", "markdown", "netcdf", "xlsx")
"""Formats of a table of values."""

_WrittenCurve = Literal["points", "pieces", "none"]


@dataclass(frozen=True)
class _MooringCode:
    """Format of a mooring code.

    ``files`` writes a line; it takes a stem for the names of further files and returns text by
    name, "" for the requested file.  ``forms`` are its options, the first the default, and "" if
    there is only one; the value of each is the form of the curve in it: ``most_points`` at most,
    cubic pieces, or no curve.
    """

    files: Callable[..., dict[str, str]]
    most_points: int
    forms: Mapping[str, _WrittenCurve] = field(default_factory=lambda: {"": "points"})


def _one_file(text: Callable[..., str]) -> Callable[..., dict[str, str]]:
    """The files of a code whose deck is one file."""

    def files(line: ExportLine, _stem: str, **said: str) -> dict[str, str]:
        return {"": text(line, **said)}

    return files


_MOORDYN_FORMS: dict[str, _WrittenCurve] = {
    "table": "points",
    "damped-table": "points",
    "static-dynamic": "none",
    "load-dependent": "none",
    "syrope": "none",
}

_OPENFAST_FORMS = {form: _MOORDYN_FORMS[form] for form in get_args(OpenFastForm)}

_CODES: dict[str, _MooringCode] = {
    "moordyn": _MooringCode(moordyn_files, TABLE_POINTS, _MOORDYN_FORMS),
    "openfast": _MooringCode(openfast_files, TABLE_POINTS, _OPENFAST_FORMS),
    "moorpy": _MooringCode(moorpy_files, TABLE_POINTS, {"table": "points", "library": "none"}),
    "whoi-cable": _MooringCode(
        _one_file(_whoicable_text), CABLE_POINTS, {"expression": "pieces", "table": "points"}
    ),
    "raft": _MooringCode(_one_file(_raft_text), 0, {"": "none"}),
    "orcaflex": _MooringCode(_one_file(_orcaflex_text), ORCAFLEX_POINTS),
    "abaqus": _MooringCode(_one_file(_abaqus_text), ABAQUS_POINTS),
}

FORMS = {name: tuple(form for form in code.forms if form) for name, code in _CODES.items()}
"""Options of the format of each mooring code, the first the default."""

FORMATS = (*TABLES, *FORMS)

_TAILS = ("_table", "_owc", "_syrope", "_moorpy")

_DIGITS = 8


def export_line(
    line: ExportLine, to: str, path: Path, *, form: str | None = None, units: UnitSystem = "si"
) -> list[Path]:
    """Write a line in a format."""
    if to in TABLES:
        _refuse_form(to, form, ())
        return export_table(curve_table(line), to, path, units=units)
    if to not in FORMS:
        raise SettingsError("the format is not known", found=repr(to), needed=", ".join(FORMATS))
    _refuse_form(to, form, FORMS[to])
    said = {} if form is None else {"form": form}
    files = _CODES[to].files(line, _stem_beside(path), **said)
    beside = {path.with_name(name): text for name, text in files.items() if name}
    # a file is written before the file that names it
    for place, text in {**beside, path: files[""]}.items():
        write_text_atomically(place, text)
    return [*beside, path]


def export_table(table: ValueTable, to: str, path: Path, *, units: UnitSystem = "si") -> list[Path]:
    """Write a table of values as csv, json, latex, markdown, netcdf or xlsx."""
    if to == "netcdf":
        write_netcdf(table, path)
    elif to == "xlsx":
        write_workbook(path, sheets_of_table(table, units=units))
    else:
        write_text_atomically(path, table_text_of(table, to, units=units))
    return [path]


def _stem_beside(path: Path) -> str:
    """Beginning of the names of the files beside one, unique among the files of a folder.

    A name in a deck ends at a blank or at a character of its grammar; where one is removed, or the
    file does not end in ``.dat``, a digest of the file name is added.
    """
    stem = re.sub(r"[^A-Za-z0-9_]+", "_", path.stem).strip("_") or "line"
    # else `leg_table.dat` beside `leg.dat` would find its own name taken
    if path.name == f"{stem}.dat" and not stem.endswith(_TAILS):
        return stem
    return f"{stem}_{sha256(path.name.encode()).hexdigest()[:_DIGITS]}"


def _refuse_form(to: str, form: str | None, forms: tuple[str, ...]) -> None:
    if form is not None and form not in forms:
        raise SettingsError(
            f"{to} has no form '{form}'",
            found=form,
            needed="one of " + ", ".join(forms) if forms else f"no --form with {to}",
        )


_CLOSE = 0.05


_OF_ONE_STIFFNESS = ("static-dynamic", "load-dependent", "library")


def closeness_of(line: ExportLine, to: str, form: str | None) -> tuple[str, ...]:
    """Description of the errors of a curve in a format."""
    if to not in _CODES:
        return ()
    code = _CODES[to]
    curve = code.forms[next(iter(code.forms)) if form is None else form]
    if curve == "none":
        said = about_mean(line) if form in _OF_ONE_STIFFNESS else ""
        return (said,) if said else ()
    found = (
        thin_curve(line.strain, line.tension, most=code.most_points)
        if curve == "points"
        else _fit_smooth_curve(line.strain, line.tension)
    )
    doubt = "DOUBTFUL: " if found.local > _CLOSE else ""
    damping = line.damping if form == "damped-table" else None
    return (
        *(() if damping is None else (damping_words(damping),)),
        f"{doubt}the written curve differs from the computed one by at most"
        f" {plain_number(found.error, 3)} N {local_words(found)}",
    )
