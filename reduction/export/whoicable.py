"""WHOI Cable: a material as a table, and as expressions of the strain with two derivatives.

What Cable does with a material that is not to its liking, and what is done here about it:

* a derivative that is a constant counts as missing: each expression holds ``e`` in every piece;
* T, Te and Tee are needed all three, and EA beside them: they are written;
* ``^`` is a bitwise operation: products stand in Horner's form;
* a number without a point is read as an integer of 32 bits: every number has a point.

Cable is a program of its own under the GPL; nothing of it is part of this package.

References
----------
.. [1] J. I. Gobat and M. A. Grosenbaugh, "WHOI Cable v2.0: Time Domain Numerical Simulation of
   Moored and Towed Oceanographic Systems," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep.
   WHOI-2000-08, July 2000.
"""

from __future__ import annotations

import math
from typing import Literal

from reduction.digits import plain_number
from reduction.errors import SettingsError
from reduction.export.header import header_lines, one_line, real_number
from reduction.export.product import SEA_WATER, ExportLine
from reduction.export.spline import SmoothCurve, fit_smooth_curve
from reduction.export.thin import local_words, thin_curve
from reduction.record import Floats

WhoiCableForm = Literal["expression", "table"]
CABLE_POINTS = 100
"""Pairs of a table. [1]"""
_GRAVITY = 9.80665
_SMALL = 1e-4  # bending and torsion were not measured, and zero is singular


def whoicable_text(line: ExportLine, *, form: WhoiCableForm = "expression") -> str:
    """A materials section for WHOI Cable.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    form : {"expression", "table"}
        ``expression``: T, Te and Tee of a rising cubic spline. ``table``: T through points, and
        the slopes of the same spline, since Cable needs them.

    Returns
    -------
    text : str
        All of it.

    Raises
    ------
    SettingsError
        If diameter or mass is not known, or the form is not.
    DataError
        If the curve cannot be exported.
    """
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


def _expression(curve: SmoothCurve, powers: Floats) -> str:
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
