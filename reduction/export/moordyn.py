"""MoorDyn: look-up table, static and dynamic stiffness, stiffness that grows with load, Syrope.

What MoorDyn 2.7 does with a file that is not to its liking, and what is done here about it:

* a line end after the last row, or more than 30 rows, and it does not start: neither is written;
* below the first and beyond the last row it keeps the tension: the first row is 0 0, the header
  gives the last one;
* a loop gives nonsense, and a table beside ``|EA_d`` is replaced by its last secant: neither is
  possible here;
* a Syrope line without initial conditions ends in a segmentation fault: they are always written;
* its own choice of a time step (CFL) takes the stiffness of a table as zero, and the line blows up:
  the deck states a step, from the steepest part of the curve;
* a measured N beside a table is far too much damping for cycles that are fast against tau, and
  asks for steps of microseconds: a table has numerical damping, the other forms the measured one;
* without damping of the fast spring the second-order integration grows without bounds: a little is
  written, and said to be numerical.

References
----------
.. [1] MoorDyn documentation, "Input Files", v2.7.1, 2026.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from reduction.digits import plain_number
from reduction.errors import SettingsError
from reduction.export.deck import deck, line_type, segment_length
from reduction.export.dynamics import Syrope, Viscoelasticity
from reduction.export.header import header_lines, number, one_line
from reduction.export.product import ExportLine
from reduction.export.thin import ThinnedCurve, thin_curve

MoorDynForm = Literal["table", "static-dynamic", "load-dependent", "syrope"]
MOST_POINTS = 30
"""Rows that a table of MoorDyn may have. [1]"""
NUMERICAL_DAMPING = -1.0
"""Internal damping where none was measured, as MoorDyn takes it: share of critical. [1]"""
_FAST_SHARE = 0.1


def table_text(line: ExportLine, curve: ThinnedCurve) -> str:
    """Look-up table: three lines of header, rows with one blank, no line end at the end."""
    low, high = line.tested
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


def fast_damping(stiffness: float, linear_density: float, apart: float) -> float:
    """Numerical damping of the fast spring, a tenth of critical for the segments of a deck. [N s].

    Parameters
    ----------
    stiffness : float
        Of the fast spring. [N]
    linear_density : float
        In air. [kg m-1]
    apart : float
        Length of a segment. [m]

    Returns
    -------
    damping : float
        [N s]

    Raises
    ------
    ValueError
        If one is negative.

    Examples
    --------
    >>> fast_damping(5e4, 0.5, 2.0)
    31.622776601683796
    """
    return _FAST_SHARE * apart * math.sqrt(stiffness * linear_density)


def moordyn_files(line: ExportLine, stem: str, *, form: MoorDynForm = "table") -> dict[str, str]:
    """Files of a line type for MoorDyn, the deck first.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    stem : str
        Of the names of the files beside the deck.
    form : {"table", "static-dynamic", "load-dependent", "syrope"}
        ``table``: the curve. ``static-dynamic``: EA_s|EA_d. ``load-dependent``:
        EA_s|alpha|beta. ``syrope``: working curves under the original one.

    Returns
    -------
    files : dict of str to str
        Text by name; the key of the deck is empty.

    Raises
    ------
    SettingsError
        If the line has not what the form needs, or the form is not known.
    DataError
        If the curve cannot be exported.

    Notes
    -----
    EA_s is K_0 and EA_d is K_0 + K_1 of [2]_.  MoorDyn puts the slow spring and its dashpot in
    series with EA_d, [2]_ puts a spring and a dashpot in series beside K_0: the same line, but
    not the same dashpot; see `Viscoelasticity.slow_dashpot_coefficient`.
    """
    if form == "table":
        return _table_files(line, stem)
    if form == "syrope":
        return _syrope_files(line, stem)
    if form not in ("static-dynamic", "load-dependent"):
        raise SettingsError(
            "the form of a MoorDyn line is not known",
            found=repr(form),
            needed="table, static-dynamic, load-dependent or syrope",
        )
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"static and dynamic stiffness of {line.name} are not known",
            needed="K_0, K_1 and tau of a published line, which are taken at "
            "--frequency, --mean-tension and --tension-amplitude",
            hint="Export the curve instead: --form table.",
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
        ""
        if form == "static-dynamic"
        else "MoorDyn takes the running tension of the slow part for "
        "the mean: about it K_ap of a cycle is 2 to 4 percent above that of static-dynamic on the "
        "published lines",
        f"BA_d {plain_number(fast, 4)} N s: {_FAST_SHARE:g} of critical for segments of {apart:g} "
        "m, numerical, not measured; without it the integration grows",
    )
    return {
        "": deck(
            line,
            line_type(line, stiffness, damping),
            head,
            strain=line.strain[-1] / 2,
            stiffness=part.fast_stiffness,
        )
    }


def _stiffness_words(part: Viscoelasticity) -> tuple[str, ...]:
    """What the numbers of the stiffness are."""
    return (
        f"EA_s {plain_number(part.static_stiffness, 6)} N is K_0; EA_d "
        f"{plain_number(part.fast_stiffness, 6)} N is K_0 + "
        f"K_1; relaxation time {part.relaxation_time:.4g} s",
        f"the dashpot beside the slow spring is "
        f"{plain_number(part.slow_dashpot_coefficient, 6)} N s, which "
        f"behaves as N = K_1 tau = {plain_number(part.dashpot_coefficient, 6)} N s of the "
        f"Maxwell form",
        f"found at {part.holds}" if part.holds else "",
        "a spring constant holds about a mean; the strain of the deck starts at zero tension",
    )


def _said(line: ExportLine) -> tuple[str, ...]:
    return (
        line.volume_diameter[1],
        f"hydrodynamic coefficients: {line.hydrodynamics.source}",
        "bending stiffness 0: not measured",
    )


def _table_files(line: ExportLine, stem: str) -> dict[str, str]:
    curve = thin_curve(line.strain, line.tension, most=MOST_POINTS)
    table = f"{stem}_table.txt"
    head = header_lines(
        line,
        curve,
        *_said(line),
        f"internal damping {NUMERICAL_DAMPING:g}: MoorDyn takes a number below zero for minus a "
        "share of critical damping, and finds the damping of each segment by it; numerical, not "
        "measured",
        f"{table} belongs beside this file",
    )
    row = line_type(line, table, number(NUMERICAL_DAMPING))
    steepest = float(np.max(np.diff(curve.tension) / np.diff(curve.strain)))
    return {
        "": deck(line, row, head, strain=line.strain[-1] / 2, stiffness=steepest),
        table: table_text(line, curve),
    }


def _syrope_files(line: ExportLine, stem: str) -> dict[str, str]:
    part = line.syrope
    if part is None:
        raise SettingsError(
            f"{line.name} has no Syrope working curves",
            needed="original working curve, alpha, beta, k1, k2 and where the line starts",
            hint="For a published line with levels: --working-curve, --greatest-mean-tension.",
        )
    curve = thin_curve(part.strain, part.tension, most=MOST_POINTS)
    working, settings = f"{stem}_owc.dat", f"{stem}_syrope.dat"
    alpha, beta = part.dynamic_stiffness, part.dynamic_stiffness_per_mean_tension
    row = line_type(
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
        f"{settings} and {working} belong beside this file",
    )
    return {
        "": deck(
            line,
            row,
            head,
            strain=part.initial_strain,
            stiffness=alpha + beta * float(part.tension[-1]),
            damping=part.fast_damping,
            conditions=conditions,
        ),
        settings: _syrope_text(part, working),
        working: table_text(line, curve),
    }


def _syrope_text(part: Syrope, working: str) -> str:
    return "\n".join(
        [
            f"{working} OWC",
            f"{part.form} WCType",
            f"{number(part.k1)} k1",
            f"{number(part.k2)} k2",
        ]
    )
