"""Published lines and tethers as sources of design values.

**Cubics of CG-D-39-80 as curves of a line, over the range in which they can be trusted.** A cubic
is printed up to the end of its range.  Two conditions show where it is wrong:

- A line does not shorten under more load.  Where the strain cubic turns, its range ends; the error
  of its slope is at least the amount by which the slope is negative there.  K_0, the inverse of the
  slope, is trusted where that amount is at most a share of the slope.
- The slope of the strain cubic is 1/K_0 (sec. 4.4.2): the cubic of K_0 is trusted where it is
  positive and within that share of the slope.

The share is the scatter of new lines, 1.96 times a tenth (sec. 4.4.1).

All windows of a published tether also serve as pieces of a tension-strain curve.

References
----------
.. [4] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 2, 3, 5, 6.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
from numpy.polynomial import polynomial

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.run_sheet import covariance_factor, variance_factor
from reduction.lines.composite import CurvePiece, PieceSource
from reduction.lines.line_lookup import sigma_from_r2
from reduction.lines.lookup_product import LineCurve, LineSource, LineSurface
from reduction.published.printed_cells import number_of, table_of
from reduction.published.published_lines import (
    POUND,
    PublishedCubic,
    PublishedLine,
    PublishedSurface,
    PublishedTether,
    TetherSegment,
    is_documentation,
    level_notes,
    line_scatter,
    own_strength,
    published_lines,
    published_tethers,
    scatter_notes,
    strength_notes,
    strength_of,
)
from reduction.quantities.units import scale_to_si
from reduction.record.arrays import runs_of_true
from reduction.record.measurement import Bools, Floats
from reduction.stages.strain.strain_fit import PooledMarks, fit_to_marks
from reduction.stages.three_parameter_line.slow_pull import slope_of_cubic

OF_CUBIC = {"quasi_static_strain": "strain"}
"""Names of cubics that are looked up through another one."""

_REST = "quasi_static_spring_constant"

_SHARE = 1.96 * 0.1

_NODES = 8001


def _curves_of_line(line: PublishedLine) -> tuple[tuple[LineCurve, ...], dict[str, str]]:
    """K_0 and strain of a line, and why one of them is missing."""
    rest, strain = (
        None if cubic is None else _curve(cubic) for cubic in (line.stiffness, line.load_strain)
    )
    absent = {OF_CUBIC.get(name, name): why for name, why in line.absent.items()}
    for cubic, found in ((line.stiffness, rest), (line.load_strain, strain)):
        if cubic is not None and found is None:
            why = "; ".join(term.note for term in cubic.open_terms) or "the printed range"
            absent[OF_CUBIC.get(cubic.quantity, cubic.quantity)] = f"ambiguous: {why}"
    if rest is not None:
        rest = _beside_slope(rest, strain or _of_same_row(line))
    elif strain is not None:
        rest = _slope(strain)
        absent.pop(_REST, None)
    elif line.load_strain is not None and _REST in absent:
        absent[_REST] = (
            "no table has such a row, and the load-strain cubic, whose slope would take its place, "
            f"is {absent['strain']}"
        )
    if rest is not None:
        rest = replace(rest, notes=(*rest.notes, _rate_note()))
    if strain is not None:
        strain = _rising(strain)
    return tuple(one for one in (rest, strain) if one is not None), absent


def _slow_pulls(line: PublishedLine) -> dict[str, LineCurve]:
    """K_0 by its own cubic and by the slope of load on strain, for each print where two differ."""
    found = {}
    for cubic in (line.stiffness, line.load_strain):
        if cubic is None:
            continue
        is_slope = cubic is line.load_strain
        # the constant of the strain does not affect the slope
        opened = [term for term in cubic.open_terms if term.index or not is_slope]
        label = "slope of load on strain" if is_slope else "cubic of K_0"
        together = f"Table{'s' * (len(cubic.tables) > 1)} {' and '.join(cubic.tables)}"
        apart = [f"Table {table}" for table in opened[0].tables] if opened else [together]
        for place, printed in enumerate(apart):
            coefficient = np.nan_to_num(cubic.coefficient)
            for term in opened:
                coefficient[term.index] = term.values[place]
            found[f"{label}, {printed}"] = LineCurve(
                _REST, "mean_tension", 0.0, cubic.tension_high, coefficient=coefficient,
                is_inverse_slope=is_slope, errata=cubic.errata,
            )  # fmt: skip
    return found


@cache
def _rate_note() -> str:
    """Effect of the pull rate on K_0: Table D-1, for one line that is not named."""
    table = table_of("CG-D-39-80", "D-1")
    slow, fast, early = (
        number_of(table[row, _REST].printed) or np.nan
        for row in (
            "24 h after the dynamic test, slow",
            "24 h after the dynamic test, fast",
            "immediately after the dynamic test, fast",
        )
    )
    return (
        f"K_0 depends on how the line is pulled: in App. D it was {fast / slow:.2f} times as high "
        f"at three times the rate, {early / fast:.2f} times as high without a day of rest, and "
        f"{early / slow:.2f} times as high with both. These are single pulls of one line that is "
        "not named; no scatter is known, and no correction is applied"
    )


def _curve(cubic: PublishedCubic) -> LineCurve | None:
    """Curve, or None where a coefficient or the range is open; an open constant matters little."""
    coefficient, notes = np.array(cubic.coefficient), [cubic.note] if cubic.note else []
    if [term.index for term in cubic.open_terms] == [0]:
        (term,) = cubic.open_terms
        coefficient[0] = term.values[0]
        notes.append(f"ambiguous: constant of {cubic.quantity}: {term.note}; the first is taken")
    if not (np.isfinite(coefficient).all() and np.isfinite(cubic.tension_high)):
        return None
    is_strain = cubic.quantity == "quasi_static_strain"
    return LineCurve(
        quantity=OF_CUBIC.get(cubic.quantity, cubic.quantity),
        variable="tension" if is_strain else "mean_tension",
        low=0.0,
        high=cubic.tension_high,
        coefficient=coefficient,
        errata=cubic.errata,
        notes=tuple(notes),
    )


def _of_same_row(line: PublishedLine) -> LineCurve | None:
    """Strain in the other condition, whose K_0 is in the same row."""
    if line.stiffness is None:
        return None
    for other in published_lines():
        if other.stiffness is None or other.load_strain is None:
            continue
        if np.array_equal(other.stiffness.coefficient, line.stiffness.coefficient):
            return _curve(other.load_strain)
    return None


def _slope(strain: LineCurve) -> LineCurve:
    """K_0 from the slope of load on strain, for a line without a cubic of K_0."""
    curve = LineCurve(
        quantity=_REST,
        variable="mean_tension",
        low=0.0,
        high=strain.high,
        coefficient=np.array(strain.coefficient),
        is_inverse_slope=True,
        errata=strain.errata,
        notes=(*strain.notes, "slope of load against strain: no printed cubic of K_0 is usable"),
    )
    at = np.linspace(0.0, strain.high, _NODES)
    slope = polynomial.polyval(at, polynomial.polyder(strain.coefficient))
    wrong = max(0.0, -float(slope.min()))
    return _within(
        curve, at, (slope > 0) & (wrong <= _SHARE * slope),
        "beyond, the slope of the cubic of strain, which turns, may be wrong by more than "
        f"{100 * _SHARE:.0f} %",
    )  # fmt: skip


def _rising(strain: LineCurve) -> LineCurve:
    at = np.linspace(0.0, strain.high, _NODES)
    slope = polynomial.polyval(at, polynomial.polyder(strain.coefficient))
    return _within(strain, at, slope > 0, "beyond, the cubic of strain falls under more load")


def _beside_slope(rest: LineCurve, strain: LineCurve | None) -> LineCurve:
    at = np.linspace(0.0, rest.high, _NODES)
    value = polynomial.polyval(at, rest.coefficient)
    is_good, why = value > 0, "beyond, the cubic of K_0 is below zero"
    if strain is not None:
        slope = slope_of_cubic(at, strain.coefficient)
        known = at <= strain.high
        is_good &= ~known | (np.abs(value / slope - 1) <= _SHARE)
        why = (
            "beyond, the cubic of K_0 is below zero or differs from the slope of the load-strain "
            f"cubic by more than {100 * _SHARE:.0f} %"
        )
    return _within(rest, at, is_good, why)


def _within(curve: LineCurve, at: Floats, is_good: Bools, why: str) -> LineCurve:
    """The curve over the longest good part of its range."""
    if is_good.all():
        return curve
    low, high = max(at[runs_of_true(is_good) - [0, 1]], key=np.ptp)
    return replace(
        curve,
        low=float(low),
        high=float(high),
        range_note=f"printed for 0 to {curve.high:.5g} N, trusted from {low:.5g} to {high:.5g} N: "
        f"{why}",
    )


_FACTORS = ("frequency", "mean_tension", "tension_amplitude")

_FREEDOM = 5.0

_FIRST = "ten cycles"

_BY_FRACTION = {
    name: "the report took strain as a fixed fraction of the crosshead position. For strain by the"
    f" tape readings of its Table 3, divide the value by {ratio} (WH5-34)"
    for name, ratio in (("new", "1.145"), ("used", "1.163"))
}

TABLE_OF_DATA = {"consolidated": "6", "raw": "5"}
"""Table of WHOI-2005-10 with each kind of moduli."""

_FEWEST = 2.0
"""Number of lines in a surface, where a table states it as two to four. [1]"""

_DESIGN = box_behnken(3).coded

_EXPONENTS = quadratic_exponents(3)


@cache
def published_sources() -> dict[str, LineSource]:
    """Every published line and tether with values to look up, by name."""
    sources = [_line(one) for one in published_lines()]
    windows = (_tether(*window) for window in tether_windows().values())
    sources += [one for one in windows if one is not None]
    return {one.name: one for one in sources}


@cache
def tether_windows() -> dict[str, tuple[PublishedTether, str, str]]:
    """Tether, test and condition of every tether window, by the name of its source."""
    return {
        _name_of_window(tether, test, condition): (tether, test, condition)
        for tether in published_tethers()
        for condition, test in sorted(
            {(segment.name.condition, segment.name.test) for segment in tether.segments},
            key=lambda named: (named[0] != _FIRST, named[1]),
        )
    }


def _name_of_window(tether: PublishedTether, test: str, condition: str) -> str:
    aged = "" if condition == _FIRST else f"-{condition.replace(' ', '-')}"
    return f"rubber-tether-{tether.name}-{test}{aged}"


def _line(line: PublishedLine) -> LineSource:
    surfaces = {}
    curves, absent = _curves_of_line(line)
    for response, found in line.surfaces.items():
        if any(term.index == 0 for term in found.open_terms):
            (term,) = (one for one in found.open_terms if one.index == 0)
            absent[response] = f"its mean B1 is open ({term.erratum}): {term.note}"
        else:
            surfaces[response] = _surface(line, found)
    strength, told = own_strength(line)
    return LineSource(
        name=line.name,
        source="CG-D-39-80",
        material=line.material,
        construction=line.construction,
        condition=line.condition,
        diameter=line.diameter,
        rated_break_strength=line.rated_break_strength,
        factor_names=_FACTORS,
        surfaces=surfaces,
        curves=curves,
        absent=absent,
        kind="rope",
        tensile_strength=strength,
        strength_of=strength_of(line),
        slow_pulls=_slow_pulls(line) if surfaces else {},
        notes=(*strength_notes(line), *told, *scatter_notes(line), *level_notes(line)),
    )


def _surface(line: PublishedLine, found: PublishedSurface) -> LineSurface:
    box, *others = found.boxes
    ends = [np.array([one.frequency, one.mean_tension, one.tension_amplitude]).T
            for one in (box, *others)]  # fmt: skip
    # levels are printed to whole pounds
    rounding = np.array([0.0, 0.5, 0.5]) * POUND
    known = np.array(found.coefficient)
    choices = []
    for chosen in product(*(range(len(term.values)) for term in found.open_terms)):
        one = known.copy()
        for term, place in zip(found.open_terms, chosen, strict=True):
            one[term.index] = term.values[place]
        choices.append(one)
    matrix = model_matrix(_DESIGN, _EXPONENTS)
    # a run at the printed level may have been half a pound beyond it
    edge = model_matrix(_DESIGN * (1 + 2 * rounding / (ends[0][1] - ends[0][0])), _EXPONENTS)
    names = tuple(f"B{number}" for number in range(1, len(_EXPONENTS) + 1))
    covariance = covariance_factor(matrix, names=names)
    notes = [
        f"ambiguous: B{term.index + 1} of {found.response}: {term.note}; the interval spans both"
        for term in found.open_terms
    ]
    if not np.isfinite(found.r2):
        notes.append("r2 is ambiguous: no interval can be given")
    if not found.passes_f_test:
        notes.append(
            "the surface fails its F test at 5 %: it explains the runs no better than their mean"
        )
    notes += [
        f"the tested levels are ambiguous: shares of {box.rated_break_strength:.0f} N (Table "
        f"{box.table}) or of {other.rated_break_strength:.0f} N (Table {other.table}); the "
        "intervals span both"
        for other in others
    ]
    scatter, n_lines = float("nan"), float(found.n_lines or "nan")
    if found.response == "apparent_spring_constant":
        scatter = line_scatter(line)
    if np.isfinite(n_lines):
        notes.append(f"the surface was fitted to {n_lines:.0f} specimens")
    elif np.isfinite(scatter):
        n_lines = _FEWEST
        notes.append(
            f"the number of specimens is not printed; {_FEWEST:.0f}, the smallest of any surface,"
            " is assumed for the scatter between specimens"
        )
    if is_documentation(line):
        notes.append(
            'reported "for documentation purposes but no inference is drawn from it": few lines, '
            "high variability (sec. 4.4.1)"
        )
    return LineSurface(
        quantity=found.response,
        coefficient=choices[0],
        exponents=_EXPONENTS,
        low=ends[0][0],
        high=ends[0][1],
        covariance_factor=covariance,
        sigma=sigma_from_r2(choices[0], found.r2),
        degrees_of_freedom=_FREEDOM,
        greatest_leverage=float(np.max(variance_factor(edge, covariance))),
        alternatives=np.array(choices[1:]).reshape(-1, known.size),
        alternative_boxes=tuple((low, high) for low, high in ends[1:]),
        rounding=rounding,
        line_scatter=scatter,
        n_lines=n_lines,
        errata=found.errata,
        notes=tuple(notes),
    )


def _tether(tether: PublishedTether, test: str, condition: str) -> LineSource | None:
    """Moduli of one test; where a consolidated row is open, a raw row is used."""
    for data in ("consolidated", "raw"):
        found = [
            one
            for one in tether.segments
            if one.name.test == test
            and one.name.data == data
            and one.name.condition == condition
            and not one.is_open
            and np.isfinite(one.modulus)
        ]
        if found:
            return source_of_segments(tether, test, condition, data, found)
    return None


def source_of_segments(
    tether: PublishedTether,
    test: str,
    condition: str,
    data: str,
    found: list[TetherSegment],
) -> LineSource:
    """One window of a tether from one table: ``raw`` is Table 5, ``consolidated`` Table 6."""
    rows = sorted(found, key=lambda one: one.strain_low)
    ends = np.array([[one.strain_low, one.strain_high] for one in rows]).ravel()
    moduli = np.repeat([one.modulus for one in rows], 2)
    tensions = np.array([[one.tension_low, one.tension_high] for one in rows]).ravel()
    errata = tuple(dict.fromkeys(erratum for one in rows for erratum in one.errata))
    table = TABLE_OF_DATA[data]
    notes = tuple(dict.fromkeys(f"Table {table}: {note}" for one in rows for note in one.notes))
    keep = np.isfinite(tensions)
    curves = [
        LineCurve(
            "tangent_modulus", "strain", float(ends[0]), float(ends[-1]), at=ends, value=moduli,
            branch="ascending", errata=errata, notes=notes,
            warnings=(_BY_FRACTION[tether.name],) if test == "T-1" else (),
        )
    ]  # fmt: skip
    if keep.sum() > 1:
        curves.append(
            LineCurve(
                "branch_tension", "strain", float(ends[keep][0]), float(ends[keep][-1]),
                at=ends[keep], value=tensions[keep], branch="ascending", errata=errata,
                notes=notes,
            )
        )  # fmt: skip
    specimen = tether.specimen
    return LineSource(
        name=_name_of_window(tether, test, condition),
        source=f"WHOI-2005-10, Table {table}, {test}, {condition}",
        material="rubber",
        construction="tether",
        condition=specimen.name if condition == _FIRST else f"{specimen.name}, {condition}",
        diameter=float(np.mean(specimen.diameter)),
        rated_break_strength=specimen.rated_break_strength or float("nan"),
        curves=tuple(curves),
        absent={
            "loss_factor": "no descending modulus is tabulated",
        },
        kind=specimen.kind,
        notes=(
            "the printed moduli are slopes of straight segments of the ascending branch, with "
            "strain as a fixed fraction of the crosshead position",
        ),
    )


_TO_THE_POUND = scale_to_si("lbf", "force")[0] / np.sqrt(12)
"""Standard uncertainty of a load printed to the pound. [N]"""


@cache
def published_piece_sources() -> dict[str, PieceSource]:
    """Published tethers by name, each with a piece for every tabulated test.

    Notes
    -----
    Loads at the ends of the segments, as printed and corrected, with straight lines between them as
    in a look-up: Table 6 of [4]_, and Table 5 where a row of Table 6 is open.  Splices have a
    constant ratio of strains, from the marks of Table 3.

    Examples
    --------
    >>> used = published_piece_sources()["rubber-tether-used"]
    >>> print(used.pieces[0].name, round(used.model.coefficients["splice_strain_ratio"], 4))
    T-1 0.2177
    """
    found = {}
    for tether in published_tethers():
        name = f"rubber-tether-{tether.name}"
        windows = [one for key, one in published_sources().items() if key.startswith(f"{name}-")]
        tests = [
            (one, curve)
            for one in windows
            for curve in one.curves
            if curve.quantity == "branch_tension"
        ]
        marks = tether.marks
        readings = PooledMarks(
            marks, np.full(len(marks.test), np.nan), np.ones(len(marks.test), dtype=bool)
        )
        errata = dict.fromkeys(erratum for _, curve in tests for erratum in curve.errata)
        found[name] = PieceSource(
            name=name,
            branch="ascending",
            pieces=tuple(_piece(one.name.removeprefix(f"{name}-"), curve) for one, curve in tests),
            model=replace(
                fit_to_marks("strain-ratio", readings),
                marks_from="WHOI-2005-10, Table 3, marks of T-1",
            ),
            diameter=tether.specimen.mean_diameter,
            rated_break_strength=float(tether.specimen.rated_break_strength or np.nan),
            sources=(
                *(one.source for one, _ in tests),
                f"errata that touch them: {', '.join(errata)}",
            ),
            piece_sources=tuple(one.source for one, _ in tests),
            notes=(
                *dict.fromkeys(note for one in windows for note in one.notes),
                "loads are printed to the pound: that is the uncertainty of a piece",
            ),
        )
    return found


def _piece(test: str, curve: LineCurve) -> CurvePiece:
    """Ends of the segments, each joint once: where its two loads differ, their mean."""
    strain, place = np.unique(curve.at, return_inverse=True)
    tension = np.bincount(place, curve.value) / np.bincount(place)
    return CurvePiece(
        test, "cyclic", "ascending", strain, tension, np.full(strain.size, _TO_THE_POUND)
    )
