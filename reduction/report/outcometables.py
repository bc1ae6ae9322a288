"""Tables of outcomes without a log: strength, exposure and life."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite

from reduction.outcomes.groups import Group
from reduction.outcomes.life_rows import fatigue_rows, load_life_rows
from reduction.outcomes.row import Row
from reduction.outcomes.rows import exposure_rows, strength_rows
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    number_text,
    words,
)
from reduction.report.outcomeview import OutcomeView, group_names
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import expand, plus_minus

__all__ = ["exposure_table", "fatigue_table", "load_life_table", "strength_table"]

_PERCENT = Shown("%", 100.0)
_NUMBER = Shown("1", 1.0)
_SCATTER = "scatter between the tests of a group"
_FIT = "scatter of the tests about the fit"
_NOT_IN_IT = "calibration of the machine"
_BOUNDS = "Intervals hold 95 %, two-sided."
_Column = tuple[str, Callable[[Row], Cell]]


def _table(
    caption: str,
    rows: Sequence[Row],
    columns: Sequence[_Column],
    view: OutcomeView,
    *notes: str,
    held: str,
    reason: str,
) -> Table | None:
    """Lay out rows by group; a column in which nothing stands is left out.

    What ± holds, what is missing, and why, stands below: ``held``, the words of column ``reason``.
    """
    if not rows:
        return None
    names = group_names([_group(row) for row in rows], view.units)
    cells = [[words(name), *(cell(row) for _, cell in columns)] for name, row in zip(
        names, rows, strict=True
    )]  # fmt: skip
    filled = [
        place
        for place in range(len(columns) + 1)
        if any(row[place].text != NOT_GIVEN for row in cells)
    ]
    headings = ["group", *(heading for heading, _ in columns)]
    return make_table(
        caption, [headings[place] for place in filled],
        [[row[place] for place in filled] for row in cells], synthetic=view.is_synthetic,
        remarks=[
            plus_minus(factors_of(cells), held, left_out=_NOT_IN_IT),
            *notes, *_missing(names, rows, reason),
        ], is_tall=len(rows) > 12,
    )  # fmt: skip


def _missing(names: Sequence[str], rows: Sequence[Row], reason: str) -> list[str]:
    told: dict[str, list[str]] = {}
    for name, row in zip(names, rows, strict=True):
        load = _real(row, "peak_load_ratio")
        place = f" at {_PERCENT.factor * load:.3g} %" if load == load else ""
        if row[reason]:
            told.setdefault(str(row[reason]), []).append(f"{name}{place}")
    return [f"{'; '.join(groups)}: {text}." for text, groups in told.items()]


def _group(row: Row) -> Group:
    diameter, exposure = _real(row, "diameter"), _real(row, "exposure")
    return Group(
        str(row["line"]), str(row["material"]), str(row["construction"]),
        diameter if diameter == diameter else None,
        str(row.get("condition", "")), exposure if exposure == exposure else None,
    )  # fmt: skip


def _real(row: Row, name: str) -> float:
    return float(row.get(name, "nan"))


def _known(
    name: str, unit: Shown, counted: str = "", fitted: int = 1, *, confidence: bool = False
) -> Callable[[Row], Cell]:
    """A number known from so many tests less so many fitted; or as its interval has it."""

    def cell(row: Row) -> Cell:
        spread = _real(row, f"{name}_standard_uncertainty")
        if confidence:
            half = (_real(row, f"{name}_high") - _real(row, f"{name}_low")) / 2
            factor = half / spread if spread > 0 else float("nan")
        else:
            freedom = max(_real(row, counted) - fitted, 1.0)
            found = expand(spread, degrees_of_freedom=freedom)
            half, factor = float(found.half), float(found.factor)
        return measured(_real(row, name), half, unit, factor=factor)

    return cell


def _plain(name: str, unit: Shown, digits: int = 3) -> Callable[[Row], Cell]:
    return lambda row: number(_real(row, name), unit, digits=digits)


def _count(name: str) -> Callable[[Row], Cell]:
    return lambda row: count(_real(row, name))


def _some(name: str) -> Callable[[Row], Cell]:
    """A count that is worth a column only where something was counted."""
    return lambda row: count(_real(row, name)) if row[name] else words("")


def _interval(low: str, high: str, unit: Shown, digits: int = 3) -> Callable[[Row], Cell]:
    def cell(row: Row) -> Cell:
        ends = [_real(row, name) for name in (low, high)]
        if not any(isfinite(end) for end in ends):
            return words("")
        text = " to ".join(number_text(end * unit.factor, digits) for end in ends)
        return Cell(text, " ".join(repr(end) for end in ends), is_number=True)

    return cell


def strength_table(view: OutcomeView, name: str) -> Table | None:
    """Return a quantity of the table of strength by group: mean, scatter, change, bounds."""
    is_force = name == "tensile_strength"
    unit = shown("tension" if is_force else "strain", view.units)
    what = "tensile strength" if is_force else "strain at failure"
    rows = [
        row
        for row in strength_rows(view.outcomes)
        if any(row[f"{name}_{use}count"] for use in ("", "lower_bound_", "excluded_"))
    ]
    columns: list[_Column] = [
        ("tests", _count(f"{name}_count")),
        (unit.label(f"mean {what}"), _known(name, unit, f"{name}_count")),
        (unit.label("deviation"), _plain(f"{name}_standard_deviation", unit)),
        ("deviation over mean [%]", _plain(f"{name}_relative_variability", _PERCENT)),
        (
            unit.label("least to greatest"),
            _interval(f"{name}_minimum", f"{name}_maximum", unit, 4),
        ),
        ("change against new [%]", _known(f"{name}_change", _PERCENT, confidence=True)),
        (
            "interval of the change [%]",
            _interval(f"{name}_change_low", f"{name}_change_high", _PERCENT),
        ),
        ("p of no change [1]", _plain(f"{name}_p_value", _NUMBER, 2)),
        ("lower bounds", _some(f"{name}_lower_bound_count")),
        (unit.label("mean with the bounds"), _plain(f"{name}_with_lower_bounds", unit, 4)),
        (
            unit.label("its interval"),
            _interval(f"{name}_with_lower_bounds_low", f"{name}_with_lower_bounds_high", unit, 4),
        ),
        ("not used", _some(f"{name}_excluded_count")),
    ]
    return _table(
        f"{what.capitalize()} by group: mean of the valid tests; a break in the termination is a"
        " lower bound and stands apart. Change: against the group of the same line whose"
        " condition is new.",
        rows, columns, view, _BOUNDS, held=_SCATTER, reason=f"{name}_reason",
    )  # fmt: skip


def exposure_table(view: OutcomeView) -> Table | None:
    """Return the straight line of strength over years in the field, one row a line."""
    unit = shown("tension", view.units)
    columns: list[_Column] = [
        ("breaks", _count("break_count")),
        ("years", _interval("exposure_low", "exposure_high", _NUMBER)),
        (
            unit.label("strength when new"),
            _known("strength_when_new", unit, "degrees_of_freedom", 0),
        ),
        (
            f"change a year [{unit.unit}/year]",
            _known("strength_slope", unit, "degrees_of_freedom", 0),
        ),
        ("lost a year [% of new]", _plain("share_lost_per_year", _PERCENT)),
        (
            "its interval [% of new]",
            _interval("share_lost_per_year_low", "share_lost_per_year_high", _PERCENT),
        ),
        (unit.label("deviation of a break"), _plain("strength_scatter", unit)),
        ("p of a straight line [1]", _plain("lack_of_fit_p_value", _NUMBER, 2)),
        ("lower bounds", _some("lower_bound_count")),
        ("not used", _some("unused_count")),
    ]
    return _table(
        "Strength against time in the field: a straight line through the breaks of each line.",
        exposure_rows(view.outcomes), columns, view, _BOUNDS, held=_FIT, reason="exposure_reason",
    )  # fmt: skip


def fatigue_table(view: OutcomeView, quantity: str) -> Table | None:
    """Return cycles to failure or of abrasion by group and peak load."""
    force = shown("tension", view.units)
    rows = [row for row in fatigue_rows(view.outcomes) if row["quantity"] == quantity]
    columns: list[_Column] = [
        ("peak load [% of rated break strength]", _plain("peak_load_ratio", _PERCENT)),
        (force.label("peak load"), _plain("peak_load", force, 4)),
        ("least load [% of rated break strength]", _plain("minimum_load_ratio", _PERCENT)),
        ("failed", _count("failed_count")),
        ("stopped", _some("suspended_count")),
        ("mean of the failed [1]", _known("mean_cycles", _NUMBER, "failed_count")),
        ("shortest to longest [1]", _interval("least_cycles", "most_cycles", _NUMBER, 4)),
        ("median life [1]", _plain("median_life", _NUMBER)),
        ("its interval [1]", _interval("median_life_low", "median_life_high", _NUMBER)),
        ("not used", _some("excluded_count")),
    ]
    what = "Cycles to failure" if quantity == "cycles_to_failure" else "Cycles of abrasion"
    return _table(
        f"{what} by group and peak load. The mean is of the failed alone; the median life (Weibull)"
        " takes tests that were stopped as lower bounds.",
        rows, columns, view, _BOUNDS, held=_SCATTER, reason="life_reason",
    )  # fmt: skip


def load_life_table(view: OutcomeView) -> Table | None:
    """Return the line of life against peak load, one row a group tested at several loads."""
    columns: list[_Column] = [
        ("peak loads [%]", _interval("peak_load_ratio_low", "peak_load_ratio_high", _PERCENT)),
        ("failed", _count("failed_count")),
        ("stopped", _some("suspended_count")),
        ("exponent m [1]", _known("life_exponent", _NUMBER, "failed_count", 2)),
        ("at a peak load of [%]", _plain("reference_load_ratio", _PERCENT)),
        ("median life there [1]", _known("life_at_reference", _NUMBER, "failed_count", 2)),
        ("scatter of ln cycles [1]", _known("log_life_scale", _NUMBER, "failed_count", 2)),
        ("p of a straight line [1]", _plain("lack_of_fit_p_value", _NUMBER, 2)),
        ("not used", _some("unused_count")),
    ]
    return _table(
        "Life against peak load: ln N = a - m ln S, lives lognormal with one scatter, tests that"
        " were stopped as lower bounds. Loads over the rated break strength.",
        load_life_rows(view.outcomes), columns, view, held=_FIT, reason="life_reason",
    )  # fmt: skip
