"""Tables and figures of outcomes, snap loading and rope programmes.

References
----------
.. [1] CG-D-39-80.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np
import xarray as xr

from reduction.experiments.life_statistics import life_at_load
from reduction.experiments.outcome_groups import (
    ExposureSeries,
    Group,
    LoadSeries,
    Row,
    exposure_rows,
    exposure_series,
    fatigue_rows,
    load_life_rows,
    load_series,
    strength_rows,
)
from reduction.experiments.outcomes import SnapLevels
from reduction.experiments.strength_statistics import strength_after, summarise_snap_loading
from reduction.quantities.digits import fixed_number, places_of
from reduction.record.measurement import Floats
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.product_views import (
    OutcomeView,
    RopeView,
    expanded_property,
    group_names,
    line_of,
    shared_by_properties,
)
from reduction.report.sheet import Calculated, Sheet, Unit
from reduction.report.test_view import Expanded, expand, plus_minus
from reduction.report.text_style import (
    PERCENT,
    PageTable,
    Shown,
    TableCell,
    colour,
    count,
    in_order,
    marker,
    measured,
    number,
    plot_text,
    shown,
    source_words,
    span,
    words,
)
from reduction.stages.three_parameter_line.change_in_length import PROPERTY_NAMES

_POINTS = 81

_PERCENT = 100.0

_ALPHA = 0.18


def draw_exposure(view: OutcomeView) -> list[Figure]:
    """Draw strength against years in the field, one figure per line."""
    series = exposure_series(view.outcomes)
    names = group_names([one.group for one in series], view.units)
    unit = shown("tension", view.units)
    return [
        make_figure(
            f"outcomes-exposure-{index}", f"Strength against exposure, {name}",
            "Each break; a triangle is a lower bound (the termination broke first, or the test was"
            " stopped) and is not in the fit. Line: least squares over the breaks; shaded: 95 %"
            " interval of the mean strength, inside the tested exposures only.",
            _exposure_traces(one, index, unit.factor), synthetic=view.is_synthetic, height=400,
            xaxis=axis("time in the field [year]"),
            yaxis=axis(unit.label("tensile strength"), rangemode="tozero"),
        )
        for index, (one, name) in enumerate(zip(series, names, strict=True))
    ]  # fmt: skip


def _exposure_traces(series: ExposureSeries, index: int, factor: float) -> list[Trace]:
    data: list[Trace] = []
    if series.fit is not None:
        years = np.linspace(series.fit.exposure_low, series.fit.exposure_high, _POINTS)
        mean, low, high, _ = strength_after(series.fit, years)
        data += [
            band(years, factor * low, factor * high, name="95 % interval", colour=colour(index),
                 alpha=_ALPHA),
            line(years, factor * mean, name="fitted line", colour=colour(index)),
        ]  # fmt: skip
    is_bound = series.is_lower_bound
    strength = factor * series.strength
    data += _points(series.exposure[~is_bound], strength[~is_bound], "breaks", index)
    return data + _points(series.exposure[is_bound], strength[is_bound], "at least", index, "up")


def draw_lives(view: OutcomeView) -> list[Figure]:
    """Draw cycles to failure against peak load, one figure per line, conditions by colour."""
    by_line: dict[Group, list[LoadSeries]] = {}
    for series in load_series(view.outcomes):
        by_line.setdefault(line_of(series.group), []).append(series)
    titles = group_names(list(by_line), view.units)
    return [
        make_figure(
            f"outcomes-lives-{number}", f"Cycles to failure against peak load, {title}",
            "Each test; an arrow is a run-out or a failure of the termination (a lower bound)."
            " Line: median life, with run-outs as lower bounds; shaded: its 95 %"
            " bounds, between the loads tested only. The model has no fatigue limit.",
            [
                trace
                for index, (series, name) in enumerate(
                    zip(own, group_names([one.group for one in own], view.units), strict=True)
                )
                for trace in _life_traces(series, name if len(own) > 1 else "", index)
            ],
            synthetic=view.is_synthetic, height=440, is_wide=True,
            xaxis=axis("peak load [% of rated break strength]"),
            yaxis=axis("cycles [1]", type="log", exponentformat="power"),
        )
        for number, (title, own) in enumerate(zip(titles, by_line.values(), strict=True))
    ]  # fmt: skip


def _life_traces(series: LoadSeries, name: str, index: int) -> list[Trace]:
    prefix = f"{name}: " if name else ""
    data: list[Trace] = []
    if series.fit is not None:
        load = np.linspace(series.fit.load_ratio_low, series.fit.load_ratio_high, _POINTS)
        life, low, high, _ = life_at_load(series.fit, load)
        data += [
            band(_PERCENT * load, low, high, name=f"{prefix}95 % bounds", colour=colour(index),
                 alpha=_ALPHA),
            line(_PERCENT * load, life, name=f"{prefix}median life", colour=colour(index)),
        ]  # fmt: skip
    load, suspended = _PERCENT * series.peak_load_ratio, series.is_suspended
    data += _points(load[~suspended], series.cycles[~suspended], f"{prefix}failed", index)
    run_outs = f"{prefix}at least"
    return data + _points(load[suspended], series.cycles[suspended], run_outs, index, "arrow")


def _points(x: Floats, y: Floats, name: str, index: int, bound: str = "") -> list[Trace]:
    """Points for values, or for lower bounds; empty where there are none."""
    if not x.size:
        return []
    style = marker(index, size=8)
    if bound:
        style |= {"symbol": "arrow-up" if bound == "arrow" else "triangle-up-open", "size": 11}
    return [
        {
            "type": "scatter",
            "mode": "markers",
            "name": plot_text(name),
            "x": plain_numbers(x),
            "y": plain_numbers(y),
            "marker": style,
        }
    ]


_OF_STRENGTH = Shown("% of rated break strength", 100.0)

_OF_NEW = Shown("% of new", 100.0)

_SCATTER = "scatter between the tests of a group"

_FIT = "scatter of the tests about the fit"

_BOUNDS = "Intervals hold 95 %, two-sided."

_SNAP = "Upper bound of the share that fails by then, where all survived; one-sided, 95 %."


class _Groups(Sheet):
    """One row per group, with the values of a table of outcomes."""

    def __init__(self, view: OutcomeView, rows: Sequence[Row]) -> None:
        columns = {name: ("row", [row[name] for row in rows]) for name in rows[0]} if rows else {}
        super().__init__(
            Calculated(view.units, xr.Dataset(columns)), ("row",)
        )  # fmt: skip
        self.rows = rows
        self.names = group_names([_group(row) for row in rows], view.units)
        self.texts("group", self.names)

    def known_from(self, name: str, counted: str, fitted: int = 1) -> Expanded:
        """Uncertainty of a value from the number of tests less the number of fitted parameters."""
        freedom = np.maximum(self.of(counted) - fitted, 1.0)
        return expand(self.of(f"{name}_standard_uncertainty"), degrees_of_freedom=freedom)

    def some(self, heading: str, name: str) -> Self:
        """Add a count as a column, only if anything was counted."""
        return self.cells(heading, (count(one) if one else words("") for one in self.of(name)))

    def grouped(self, caption: str, reason: str, held: str, *notes: str) -> PageTable | None:
        """Return the table, with notes below: scope of ±, missing values, and reasons."""
        told: dict[str, list[str]] = {}
        for name, row in zip(self.names, self.rows, strict=True):
            load = _real(row, "peak_load_ratio")
            place = f" at {PERCENT.factor * load:.3g} %" if load == load else ""
            if row[reason]:
                told.setdefault(str(row[reason]), []).append(f"{name}{place}")
        return self.table(
            caption, optional=self.headings, tall=12,
            remarks=[
                plus_minus(self.factors, held, left_out="calibration of the machine"), *notes,
                *(f"{'; '.join(groups)}: {text}." for text, groups in told.items()),
            ],
        )  # fmt: skip


def _group(row: Row) -> Group:
    diameter, exposure = _real(row, "diameter"), _real(row, "exposure")
    return Group(
        str(row["line"]), str(row["material"]), str(row["construction"]),
        diameter if diameter == diameter else None,
        str(row.get("condition", "")), exposure if exposure == exposure else None,
    )  # fmt: skip


def _real(row: Row, name: str) -> float:
    return float(row.get(name, "nan"))


def strength_table(view: OutcomeView, name: str) -> PageTable | None:
    """Return a quantity of the table of strength by group: mean, scatter, change, bounds."""
    is_force = name == "tensile_strength"
    unit = shown("tension" if is_force else "strain", view.units)
    what = "tensile strength" if is_force else "strain at failure"
    sheet = _Groups(
        view,
        [
            row
            for row in strength_rows(view.outcomes)
            if any(row[f"{name}_{use}count"] for use in ("", "lower_bound_", "excluded_"))
        ],
    )
    change, bounds = f"{name}_change", f"{name}_with_lower_bounds"
    half, spread = (
        (sheet.of(f"{change}_high") - sheet.of(f"{change}_low")) / 2,
        sheet.of(f"{change}_standard_uncertainty"),
    )
    factor = np.divide(half, spread, out=np.full(half.shape, np.nan), where=spread > 0)
    (
        sheet.counts("tests", f"{name}_count")
        .measured(f"mean {what}", name, unit, sheet.known_from(name, f"{name}_count"))
        .numbers("deviation", f"{name}_standard_deviation", unit, 3)
        .numbers("deviation over mean", f"{name}_relative_variability", PERCENT, 3)
        .intervals("least to greatest", f"{name}_minimum", f"{name}_maximum", unit, 4)
        .measured("change against new", change, PERCENT, Expanded(half, factor))
        .intervals("interval of the change", f"{change}_low", f"{change}_high", PERCENT)
        .numbers("p of no change", f"{name}_p_value", "number", 2)
        .some("lower bounds", f"{name}_lower_bound_count")
        .numbers("mean with the bounds", bounds, unit)
        .intervals("its interval", f"{bounds}_low", f"{bounds}_high", unit, 4)
        .some("not used", f"{name}_excluded_count")
    )
    return sheet.grouped(
        f"{what.capitalize()} by group: mean of the valid tests; a break in the termination is a"
        " lower bound and is listed apart. Change: against the group of the same line whose"
        " condition is new.",
        f"{name}_reason", _SCATTER, _BOUNDS,
    )  # fmt: skip


def exposure_table(view: OutcomeView) -> PageTable | None:
    """Return the straight line of strength over years in the field, one row per line."""
    unit = shown("tension", view.units)
    a_year, lost = Shown(f"{unit.unit}/year", unit.factor), "share_lost_per_year"
    sheet = _Groups(view, exposure_rows(view.outcomes))
    new, slope = (
        sheet.known_from(one, "degrees_of_freedom", 0)
        for one in ("strength_when_new", "strength_slope")
    )
    (
        sheet.counts("breaks", "break_count")
        .intervals("years", sheet.of("exposure_low"), sheet.of("exposure_high"))
        .measured("strength when new", "strength_when_new", unit, new)
        .measured("change per year", "strength_slope", a_year, slope)
        .numbers("loss per year", lost, _OF_NEW, 3)
        .intervals("its interval", f"{lost}_low", f"{lost}_high", _OF_NEW)
        .numbers("deviation of a break", "strength_scatter", unit, 3)
        .numbers("p of a straight line", "lack_of_fit_p_value", "number", 2)
        .some("lower bounds", "lower_bound_count")
        .some("not used", "unused_count")
    )
    return sheet.grouped(
        "Strength against time in the field: a straight line through the breaks of each line.",
        "exposure_reason", _FIT, _BOUNDS,
    )  # fmt: skip


def fatigue_table(view: OutcomeView, quantity: str) -> PageTable | None:
    """Return cycles to failure or of abrasion by group and peak load."""
    force = shown("tension", view.units)
    rows = [row for row in fatigue_rows(view.outcomes) if row["quantity"] == quantity]
    sheet = _Groups(view, rows)
    mean = sheet.known_from("mean_cycles", "failed_count")
    (
        sheet.numbers("peak load", "peak_load_ratio", _OF_STRENGTH, 3)
        .numbers("peak load", "peak_load", force)
        .numbers("least load", "minimum_load_ratio", _OF_STRENGTH, 3)
        .counts("failed", "failed_count")
        .some("stopped", "suspended_count")
        .measured("mean of the failed", "mean_cycles", "number", mean)
        .intervals("shortest to longest", "least_cycles", "most_cycles", "number", 4)
        .numbers("median life", "median_life", "number", 3)
        .intervals("its interval", "median_life_low", "median_life_high", "number")
    )
    if any(np.isfinite(row["relative_abrasion_resistance"]) for row in rows):
        name = "relative_abrasion_resistance"
        (
            sheet.numbers("over polypropylene", name, "number", 3)
            .intervals("its interval", f"{name}_low", f"{name}_high", "number")
        )  # fmt: skip
    sheet.some("not used", "excluded_count")
    what = "Cycles to failure" if quantity == "cycles_to_failure" else "Cycles of abrasion"
    return sheet.grouped(
        f"{what} by group and peak load. The mean is of the failed alone; the median life (Weibull)"
        " takes tests that were stopped as lower bounds.",
        "life_reason", _SCATTER, _BOUNDS,
    )  # fmt: skip


def load_life_table(view: OutcomeView) -> PageTable | None:
    """Return the line of life against peak load, one row per group tested at several loads."""
    sheet = _Groups(view, load_life_rows(view.outcomes))
    exponent, life, scale = (
        sheet.known_from(one, "failed_count", 2)
        for one in ("life_exponent", "life_at_reference", "log_life_scale")
    )
    (
        sheet.intervals("peak loads", "peak_load_ratio_low", "peak_load_ratio_high", PERCENT)
        .counts("failed", "failed_count")
        .some("stopped", "suspended_count")
        .measured("exponent m", "life_exponent", "number", exponent)
        .numbers("at a peak load of", "reference_load_ratio", PERCENT, 3)
        .measured("median life there", "life_at_reference", "number", life)
        .measured("scatter of ln cycles", "log_life_scale", "number", scale)
        .numbers("p of a straight line", "lack_of_fit_p_value", "number", 2)
        .some("not used", "unused_count")
    )
    return sheet.grouped(
        "Life against peak load: ln N = a - m ln S, lives lognormal with one scatter, tests that"
        " were stopped as lower bounds. Loads over the rated break strength.",
        "life_reason", _FIT,
    )  # fmt: skip


def _snaps(view: OutcomeView) -> list[tuple[str, SnapLevels]]:
    """Levels of each group whose line goes slack in its cycles, with its name."""
    found = [one for one in load_series(view.outcomes) if (one.minimum_load_ratio <= 0).any()]
    names = group_names([one.group for one in found], view.units)
    return [
        (
            name,
            summarise_snap_loading(
                one.peak_load_ratio, one.minimum_load_ratio, one.cycles, one.is_suspended
            ),
        )
        for name, one in zip(names, found, strict=True)
    ]


def snap_table(view: OutcomeView) -> PageTable | None:
    """Return the effect of each level of peak load on lines that go slack."""
    sheets = (
        Sheet(view)
        .texts("group", [name] * levels.peak_load_ratio.size)
        .numbers("peak load", levels.peak_load_ratio, _OF_STRENGTH, 3)
        .counts("failed", levels.n_failed)
        .counts("stopped", levels.n_suspended)
        .numbers("mean of the failed", levels.mean_cycles, "number")
        .numbers("shortest", levels.least_cycles, "number")
        .numbers("longest", levels.most_cycles, "number")
        .numbers("share failing, at most", levels.failed_share_high, PERCENT, 2)
        for name, levels in _snaps(view)
    )
    return Sheet.stack(sheets).table(
        "Lines that go slack in each cycle, by level of peak load.", remarks=[_SNAP]
    )


def snap_sentences(view: OutcomeView) -> list[str]:
    """Return the loads between which failures begin, and evidence against a sharp limit."""
    sentences = []
    for name, levels in _snaps(view):
        low, high = (PERCENT.factor * end for end in (levels.threshold_low, levels.threshold_high))
        known = [f"no failure up to {low:.3g} %"] if low == low else []
        known += [f"the first at {high:.3g} %"] if high == high else []
        sentences.append(
            f"{name}: {', '.join(known)} of the rated break strength, of lines that go slack in"
            " each cycle. These are tested loads, not safe loads."
        )
        sentences += [f"{name}: {note}." for note in levels.notes]
    return sentences


_CYCLE_SCATTER = "scatter between cycles, noise, regression"

_NOT_IN_ROPE_NUMBERS = (
    "load-cell calibration, scale of position or strain, lag between the channels"
)

_COUNTED = ("bedding_cycles", "dynamic_cycles")


def answer_of_ropes(views: Sequence[RopeView]) -> PageTable | None:
    """Return the properties of each rope in a row; a range where it has several values."""
    if not views:
        return None
    units = views[0].units
    sheet = Sheet(Calculated(units))
    sheet.texts("rope", [view.specimen for view in views])
    for name in PROPERTY_NAMES:
        unit = shown("tension" if name.endswith("stiffness") else "strain", units)
        sheet.cells(unit.label(name), [_least_to_greatest(view, name, unit) for view in views])
    return sheet.table(
        "Change-in-length properties of the ropes, minimum to maximum where the programme gives"
        " several. The section of each rope has the tensions, and reasons for missing values.",
        tall=16, remarks=[_about(sheet, views)],
    )  # fmt: skip


def _about(sheet: Sheet, views: Sequence[RopeView]) -> str:
    """Describe the scope of ±, and the stated instrument errors."""
    shared = in_order({one for view in views for one in shared_by_properties(view)})
    if not shared:
        return plus_minus(sheet.factors, left_out=_NOT_IN_ROPE_NUMBERS)
    told = ", ".join(source_words(one) for one in shared)
    return plus_minus(
        sheet.factors, f"{_CYCLE_SCATTER}; and errors common to all samples: {told}", left_out=""
    )


def _least_to_greatest(view: RopeView, name: str, unit: Shown) -> TableCell:
    kind = "property_stiffness" if name.endswith("stiffness") else "property_strain"
    rows = view.rows_of(name)
    values = view.array(kind)[rows]
    if len(rows) > 1:
        ends = unit.factor * values.min(), unit.factor * values.max()
        text = " to ".join(fixed_number(end, places_of(end, 4)) for end in ends)
        return TableCell(text, is_number=True)
    if not rows:
        return number(float("nan"))
    spread = expanded_property(view, kind)
    return measured(values[0], spread.half[rows[0]], unit, factor=spread.factor[rows[0]])


def rope_notes(view: RopeView, *, known: bool) -> list[str]:
    """Return remarks on the properties with a value, or the reasons why others have none."""
    has_number = {row for name in PROPERTY_NAMES for row in view.rows_of(name)}
    tests = view.texts("property_test")
    return [
        f"{', '.join(filter(None, (view.names[row], tests[row])))}: {text}"
        for row, text in enumerate(view.texts("property_remark"))
        if text and (row in has_number) is known
    ]


def property_table(view: RopeView) -> PageTable | None:
    """Return the six properties; those without a value have their reason."""
    force = shown("tension", view.units)
    ends = zip(view.array("property_low_tension"), view.array("property_high_tension"), strict=True)
    sheet = Sheet(view, ("property",)).texts("property", "property_name").cells(
        force.label("tensions"),
        [
            number(low, force) if low == high else span(low, high, force, places=0)
            for low, high in ends
        ],
    )  # fmt: skip
    sheet.numbers("time after loading", "property_reference_time")
    properties: tuple[tuple[str, str, Unit], ...] = (
        ("stiffness", "property_stiffness", None),
        ("stiffness over strength", "property_stiffness_over_strength", None),
        ("strain", "property_strain", PERCENT),
    )
    for heading, name, unit in properties:
        sheet.measured(heading, name, unit, expanded_property(view, name))
    return sheet.texts("test or step", "property_test").table(
        f"Change-in-length properties of {view.specimen}.", tall=16,
        remarks=[
            *rope_notes(view, known=True),
            "Original stiffness: chord of the first rise of a new rope. Static: secant between two"
            " held tensions. Dynamic: last cycles of a level. Construction strain: what bedding-in"
            " left at equal tension. Polymer strain: creep from the reference time to the end of"
            " the hold. Working strain: rise of tension over static stiffness, after bedding-in.",
            _about(sheet, [view]),
        ],
    )  # fmt: skip


def bedding_table(view: RopeView) -> PageTable | None:
    """Return the effect of bedding-in."""
    return _of_steps(
        view, "specimen", "bedding_permanent_strain", "Bedding-in.",
        ("cycles", "bedding_cycles"),
        ("stiffness of the first cycle", "bedding_first_stiffness"),
        ("stiffness of the last cycle", "bedding_last_stiffness"),
        ("last over first", "bedding_stiffening"),
        ("permanent strain", "bedding_permanent_strain", PERCENT),
    )  # fmt: skip


def level_table(view: RopeView) -> PageTable | None:
    """Return the levels of dynamic stiffness."""
    return _of_steps(
        view, "specimen", "dynamic_stiffness",
        "Levels of dynamic stiffness: EA (K_ap) of the last cycles of each.",
        ("mean tension", "dynamic_mean_tension"),
        ("tension amplitude", "dynamic_tension_amplitude"),
        ("frequency", "dynamic_frequency"),
        ("cycles", "dynamic_cycles"),
        ("dynamic stiffness", "dynamic_stiffness"),
        ("over strength", "dynamic_stiffness_over_strength"),
        ("change per cycle", "dynamic_stiffness_drift"),
    )  # fmt: skip


def pair_table(view: RopeView) -> PageTable | None:
    """Return the pairs of holds, with the reason where there is no stiffness."""
    return _of_steps(
        view, "held_pair", "static_stiffness", "Pairs of held tensions.",
        ("lower tension", "held_pair_low_tension"),
        ("higher tension", "held_pair_high_tension"),
        ("reference time", "static_reference_time"),
        ("static stiffness", "static_stiffness"),
        ("over strength", "static_stiffness_over_strength"),
        ("change per decade of time", "static_stiffness_per_decade"),
        reason="static_refusal",
    )  # fmt: skip


def creep_table(view: RopeView) -> PageTable | None:
    """Return the holds at constant tension, with the reason where there is no rate."""
    return _of_steps(
        view, "hold", "creep_tension_over_strength", "Creep at held tensions.",
        ("tension", "hold_final_tension"),
        ("over strength", "creep_tension_over_strength"),
        ("lasts", "hold_duration"),
        ("strain per decade of time", "creep_rate_per_decade", PERCENT),
        ("strain per decade over tension as a share of strength", "creep_compliance_per_decade",
         PERCENT),
        reason="hold_refusal",
    )  # fmt: skip


def _of_steps(
    view: RopeView,
    along: str,
    needed: str,
    caption: str,
    *columns: tuple[str, str] | tuple[str, str, Unit],
    reason: str = "",
) -> PageTable | None:
    """Return one row per step and place of this rope; columns without values are left out."""
    sheets = []
    for test in view.tests:
        sheet = Sheet(test, (along,))
        owner = sheet.of(along if along == "specimen" else f"{along}_specimen", "")
        sheet.keep(owner.astype(str) == view.specimen)
        if not sheet.n_rows or needed not in test.data:
            continue
        sheet.texts("test or step", [test.id] * sheet.n_rows)
        for one in columns:
            sheet.counts(*one[:2]) if one[1] in _COUNTED else sheet.all_of(one)
        sheets.append(sheet.texts("why there is no number", reason))
    found = Sheet.stack(sheets)
    if not found.is_known:
        return None
    return found.table(caption, optional=found.headings, tall=16, remarks=[found.about()])
