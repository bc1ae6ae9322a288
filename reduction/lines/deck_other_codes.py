r"""Decks for Abaqus, OrcaFlex and WHOI Cable.

Abaqus: uniaxial test data of a hyperelastic material, nominal stress first.

OrcaFlex: a line type with a variable axial stiffness, as text YAML.  Syntax checked only.

OrcaFlex is closed and was not run; the keys are those of its text files, tension in kN, mass in
tonnes.  A table of axial stiffness is strain against wall tension, which this is where internal
and external pressure have no part in the tension that was measured.

A curve as a rising function with a continuous second derivative.

The stiffness is a sum of quadratic B-splines with positive weights, so the tension, its integral,
is a cubic spline with two continuous derivatives that rises everywhere ([3]_):

.. math:: T(e) = \sum_k c_k \int_0^e B_k, \qquad c_k > 0.

WHOI Cable: a material as a table, and as expressions of the strain with two derivatives.

What Cable does with a material that is not to its liking, and what is done here about it:

* a derivative that is a constant counts as missing: each expression holds ``e`` in every piece;
* T, Te and Tee are needed all three, and EA beside them: they are written;
* ``^`` is a bitwise operation: products stand in Horner's form;
* a number without a point is read as an integer of 32 bits: every number has a point.

Cable is a program of its own under the GPL; nothing of it is part of this package.

References
----------
.. [3] J. O. Ramsay, "Monotone regression splines in action," Statist. Sci., vol. 3, no. 4, pp.
   425-441, 1988.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from reduction.lines.deck_moordyn import header_lines, one_line, real_number
from reduction.lines.export_line import (
    SEA_WATER,
    ExportLine,
    curve_from_zero,
    local_share,
    local_words,
    thin_curve,
)
from reduction.quantities.digits import plain_number
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, read_only_arrays

ABAQUS_POINTS = 200
"""Rows of a table. [1]"""


def abaqus_text(line: ExportLine) -> str:
    """A material for Abaqus, nominal stress and nominal strain.

    Notes
    -----
    Stress is tension over the area at zero tension, of the nominal diameter.  The potential of
    Marlow takes the data as they are; it needs the origin among them.
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
    """A label of Abaqus begins with a letter and has at most 80 signs."""
    name = line.identifier.replace("-", "_")[:78]
    return name if name[0].isalpha() else f"M_{name}"


ORCAFLEX_POINTS = 100
"""Rows of a table. [1]"""

_PER_KILO = 1e-3


def orcaflex_text(line: ExportLine) -> str:
    """A text data file for OrcaFlex."""
    curve = thin_curve(line.strain, line.tension, most=ORCAFLEX_POINTS)
    volume, words = line.volume_diameter
    mass, water = line.needed("linear_density"), line.hydrodynamics
    head = header_lines(
        line,
        curve,
        "syntax checked only: OrcaFlex was not run, look at the line type before it is used",
        words,
        f"hydrodynamic coefficients: {water.source}",
        "bending and torsion stiffness 0: not measured",
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
        f"    Cd: [{real_number(water.normal_drag)}, ~, {real_number(water.axial_drag)}]",
        f"    Ca: [{real_number(water.normal_added_mass)}, ~, "
        f"{real_number(water.axial_added_mass)}]",
        "",
    ]
    return "\n".join(text)


_DEGREE = 2

_FIRST, _MOST = 4, 24

_SHORTEST = 1e-3

_ENOUGH = 1e-3

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


def fit_smooth_curve(strain: Floats, tension: Floats) -> _SmoothCurve:
    """Fit a rising cubic spline to a curve.

    Notes
    -----
    The first pieces begin where a curve thinned to five points has them; then the piece with the
    greatest error is halved, again and again, but never below a thousandth of the strain. Least
    squares on an even grid and on the points; the error is the greatest one anywhere.

    Examples
    --------
    >>> at = np.linspace(0, 1, 50)
    >>> fit_smooth_curve(at, 100 * at**3).share < 1e-3
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
    error, worst = _greatest_error(best, at, load)
    while error > _ENOUGH * top and knots.size < _MOST:
        bounds = np.append(knots, end)
        piece = min(int(np.searchsorted(knots, worst, side="right")), knots.size) - 1
        if bounds[piece + 1] - bounds[piece] <= 2 * _SHORTEST * end:
            piece = int(np.diff(bounds).argmax())
        knots = np.insert(knots, piece + 1, (bounds[piece] + bounds[piece + 1]) / 2)
        fitted = _fitted(grid, wanted, knots, end, top)
        off, worst = _greatest_error(fitted, at, load)
        if off < error:
            best, error = fitted, off
    local = local_share(best(grid) - wanted, wanted, top)
    return _SmoothCurve(
        best.x[:-1].copy(), end, best.c[::-1].T.copy(), error, error / top, local, words
    )


def _greatest_error(
    fitted: scipy.interpolate.PPoly, at: Floats, load: Floats
) -> tuple[float, float]:
    """Greatest difference from the straight lines between the points, and its strain."""
    breaks = np.union1d(at, fitted.x)
    step = np.clip(np.searchsorted(at, breaks[:-1], "right") - 1, 0, at.size - 2)
    slope = (np.diff(load) / np.diff(at))[step]
    # where the slopes are equal: a quadratic in the strain above the start of the piece
    piece = np.clip(np.searchsorted(fitted.x, breaks[:-1], "right") - 1, 0, fitted.c.shape[1] - 1)
    cubic, square, linear = fitted.c[:3, piece]
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(square**2 - 3 * cubic * (linear - slope))
        both = np.stack([(-square + root) / (3 * cubic), (-square - root) / (3 * cubic)])
        flat = (slope - linear) / (2 * square)
    places = fitted.x[piece] + np.concatenate([both, flat[np.newaxis]])
    inside = (places > breaks[:-1]) & (places < breaks[1:])
    places = np.concatenate([breaks, places[inside]])
    off = np.abs(fitted(places) - np.interp(places, at, load))
    return float(off.max()), float(places[off.argmax()])


def _fitted(
    grid: Floats, wanted: Floats, knots: Floats, end: float, top: float
) -> scipy.interpolate.PPoly:
    """Integral of positive quadratic B-splines through 0 0, as pieces."""
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

_GRAVITY = 9.80665

_SMALL = 1e-4  # bending and torsion were not measured, and zero is singular


def whoicable_text(line: ExportLine, *, form: WhoiCableForm = "expression") -> str:
    """A materials section for WHOI Cable."""
    if form not in ("expression", "table"):
        raise SettingsError(
            "the form of a Cable material is not known",
            found=repr(form),
            needed="expression or table",
        )
    smooth = fit_smooth_curve(line.strain, line.tension)
    curve = thin_curve(line.strain, line.tension, most=CABLE_POINTS)
    powers = smooth.coefficient
    tension = _expression(smooth, powers)
    remarks = [
        f"expressions: {smooth.start.size} cubic pieces, greatest error "
        f"{plain_number(smooth.error, 3)} N, "
        f"{smooth.share:.2e} of the greatest tension; {local_words(smooth)}; beyond strain "
        f"{smooth.end:.6g} the last piece goes on and nothing is known"
    ]
    if form == "table":
        pairs = zip(curve.strain, curve.tension, strict=True)
        tension = " ".join(f"({real_number(e)}, {real_number(t)})" for e, t in pairs)
        remarks[0] = f"Te and Tee from a spline; {remarks[0]}"
    volume, words = line.volume_diameter
    mass, water = line.needed("linear_density"), line.hydrodynamics
    wet = (mass - SEA_WATER * math.pi / 4 * volume**2) * _GRAVITY
    strength = line.rated_break_strength
    along = water.axial_added_mass
    head = header_lines(
        line,
        curve,
        *remarks,
        f"added mass along the line, {along:g}, left out: Cable has none" if along else "",
        words,
        f"hydrodynamic coefficients: {water.source}",
        f"EI and GJ {_SMALL:g}: not measured; wet in N/m in water of {SEA_WATER:g} kg/m3",
        "EA: secant over the whole curve, as a first guess of the program",
        "Cable needs some horizontal force for a static solution",
    )
    rows = {
        "type": "nonlinear",
        "T": tension,
        "Te": _expression(smooth, powers[:, 1:] * (1.0, 2.0, 3.0)),
        "Tee": _expression(smooth, powers[:, 2:] * (2.0, 6.0)),
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


def _expression(curve: _SmoothCurve, powers: Floats) -> str:
    """Pieces chosen by ``?:``, each in Horner's form; ``e`` stands in every one of them."""
    text = ""
    for piece in range(len(powers) - 1, -1, -1):
        here = f"(e - {real_number(float(curve.start[piece]))})"
        polynomial = ""
        for power in reversed(powers[piece]):
            value = real_number(abs(float(power)))
            value = f"(-{value})" if power < 0 else value
            polynomial = f"({value} + {here}*{polynomial})" if polynomial else value
        if piece == len(powers) - 1:
            text = polynomial
        else:
            end = real_number(float(curve.start[piece + 1]))
            text = f"((e < {end}) ? {polynomial} : {text})"
    return text
