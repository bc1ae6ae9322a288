"""Tables of predicted hoses, and of those compared with their tests."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.product_views import SOURCE_WORDS, ComparisonView, FittedNumber, HoseView
from reduction.report.sheet import Sheet
from reduction.report.test_view import NORMAL, factor_words, plus_minus
from reduction.report.text_style import (
    NOT_GIVEN,
    PERCENT,
    PageTable,
    Shown,
    TableCell,
    interval,
    make_table,
    measured,
    number,
    number_text,
    shown,
    span,
    words,
)

_ROWS = 24
"""Approximate number of points of a hose curve on the page; the archive has all."""

_K = factor_words([NORMAL])

_TOGETHER = (
    "Strain and tension of an event vary together: its tension is better known than the tension at"
    " a fixed strain, which the band in the figure shows."
)

_SIGN = (
    "Differences are predicted minus measured: negative where the hose is stiffer than predicted."
)

_PLUS_MINUS = (
    f"±: expanded uncertainty, 95 % ({_K}), of the difference, combining what is stated for test"
    " and prediction."
)


def _plus_minus_of_hoses(views: Sequence[HoseView]) -> list[str]:
    """Return the sentence that explains ±, or says that no uncertainty is known."""
    named = (name for view in views for name in view.sources)
    sources = dict.fromkeys(SOURCE_WORDS.get(name, name.replace("_", " ")) for name in named)
    if not sources:
        return ["No uncertainty is stated for the construction, so none is given."]
    without = [view.name for view in views if not view.sources]
    said = (
        f"±: expanded uncertainty, 95 % ({_K}), from the stated uncertainty of the construction:"
        f" {', '.join(sources)}. Not included: errors of the model (straight hose, constant"
        " volume, static cord curve, rubber law)."
    )
    return [said, *([f"No uncertainty is stated for {', '.join(without)}."] if without else [])]


def answer_of_hoses(views: Sequence[HoseView]) -> PageTable | None:
    """Return the strains at which the cords pick up, work and break, one line per hose."""
    return Sheet.stack(
        Sheet(view)
        .texts("hose", [view.name])
        .measured("wrap angle", "wrap_angle")
        .at("hose_event", view.event_place("pick_up"))
        .measured("pick-up strain", "event_strain", PERCENT)
        .at("hose_event", view.event_place("working"))
        .measured("strain at working load", "event_strain", PERCENT)
        .measured("safe working load", "event_tension")
        .at("hose_event", view.event_place("cord_break"))
        .measured("strain where cords break", "event_strain", PERCENT)
        .measured("tension where cords break", "event_tension")
        for view in views
    ).table(
        "Predicted hoses, from the construction alone: cord pick-up, working load and cord break.",
        remarks=_plus_minus_of_hoses(views),
    )


def hose_event_table(view: HoseView) -> PageTable | None:
    """Return the events of the cords, in the order of stretch."""
    sheet = Sheet(view, ("hose_event",))
    sheet.keep(np.array([view.event_place(name) for name in view.events]))
    (
        sheet.texts("event", [event.words for event in view.events.values()])
        .measured("strain of the hose", "event_strain", PERCENT)
        .measured("tension", "event_tension")
        .measured("fill pressure", "event_fill_pressure")
        .numbers("tension of a cord", "event_cord_tension")
        .numbers("strain of a cord", "event_cord_strain", PERCENT)
    )
    return sheet.table(
        f"Events of hose {view.name}, from rest to the break of its cords.",
        remarks=[*_plus_minus_of_hoses([view]), *([_TOGETHER] if view.sources else [])],
    )


def hose_design_table(view: HoseView) -> PageTable:
    """Return the design parameters of the hose, and derived values."""
    diameters = view.array("layer_diameter")
    is_same = diameters[0] == diameters[-1]
    layers = ("of both cord layers",) if is_same else ("of the inner layer", "of the outer layer")
    given, found = Sheet(view), Sheet(view)
    given.measured("wrap angle from the axis", "wrap_angle")
    given.measured("bore at rest", "inner_diameter")
    for place, name in enumerate(layers):
        given.at("cord_layer", place).measured(f"diameter {name}", "layer_diameter")
        found.at("cord_layer", place).numbers(f"width of the ribbon {name}", "ribbon_width")
    (
        given.measured("outer diameter", "outer_diameter")
        .measured("cords per length of fabric", "cords_per_length", view.per_length)
        .measured("diameter of a cord", "cord_diameter")
        .measured("Young's modulus of the rubber", "rubber_modulus")
        .measured("scale factor of the cord load", "cord_load_scale")
        .measured("scale factor of the cord strain", "cord_strain_scale")
        .measured("dead length, of the whole", "dead_length_share", PERCENT)
        .measured("working share of the break load of a cord", "working_share", PERCENT)
    )
    if view.scalar("minimum_inner_diameter"):
        given.numbers("minimum bore allowed", "minimum_inner_diameter")
    spacing = np.nanmin(view.array("cord_spacing") / view.scalar("cord_diameter"))
    (
        found.numbers("cords in the section, both layers", "number_of_cords")
        .numbers("torque at the working load, held from turning", "working_torque")
        .numbers("wrap angle of an outer layer without that torque", "balanced_wrap_angle")
        .numbers("least spacing of cords over their diameter", [spacing], "number")
        .numbers(
            "bore at the greatest strain", [np.nanmin(view.array("current_inner_diameter"))],
            "small length",
        )
    )  # fmt: skip
    return make_table(
        f"Construction of hose {view.name}: what was given, and what follows from it.",
        ("number", "value", "from"),
        [
            [words(heading), *column, words(source)]
            for source, sheet in (("given", given), ("geometry", found))
            for heading, column in zip(sheet.headings, sheet.columns, strict=True)
        ],

        remarks=[
            f"Law of the rubber: {view.text('rubber_law')}. ±: expanded uncertainty, 95 %"
            f" ({_K}), of what is stated; a number without ± is treated as exact.",
            *([] if view.scalar("dead_length_share") else [
                "No dead length is stated: stretch-limited ends count as hose that stretches."
            ]),
        ],
    )  # fmt: skip


def layer_table(view: HoseView) -> PageTable | None:
    """Return the strains of the layers that carry no load, and the angles at which they survive."""
    sheet = Sheet(view, ("hose_layer",))
    low, high, tensile, compressive = (
        sheet.of(f"hose_layer_{name}")
        for name in ("least_strain", "greatest_strain", "strain_limit", "compression_limit")
    )
    (
        sheet.texts("layer", "hose_layer_name")
        .numbers("wrap angle", "hose_layer_wrap_angle")
        .spans("strain up to working load", low, high, PERCENT, places=1)
        .numbers("maximum before cords break", "hose_layer_break_strain", PERCENT, 3)
        .numbers("tensile limit", tensile, PERCENT, 3)
        .numbers("compressive limit", compressive, PERCENT, 3)
        .numbers("least angle", "hose_layer_least_angle")
        .numbers("greatest angle", "hose_layer_greatest_angle")
        .texts("within its limits", map(_bears, low, high, tensile, compressive))
    )
    return sheet.table(
        f"Non-structural layers of hose {view.name}: strain up to the working load, and the angles"
        " that keep them within their limits.",
        remarks=["Strains of a layer that follows the hose; it carries no tension, even where it"
                 " is stretched beyond its limit."],
    )  # fmt: skip


def _bears(low: float, high: float, tensile: float, compressive: float) -> str:
    if not (np.isfinite(tensile) or np.isfinite(compressive)):
        return "no limit stated"
    wrong = ["stretched"] if high > tensile else []
    wrong += ["compressed"] if -low > compressive else []
    return f"no: {' and '.join(wrong)} too far" if wrong else "yes"


def cord_table(view: HoseView) -> PageTable | None:
    """Return the measured points of one cord."""
    scales = view.scalar("cord_load_scale"), view.scalar("cord_strain_scale")
    remarks = ["Static pull; monotone cubic between the points; the cord breaks at the last one."]
    if scales != (1.0, 1.0):
        remarks.append(
            f"The prediction uses loads times {scales[0]:g} and strains times {scales[1]:g}."
        )
    sheet = Sheet(view, ("cord_point",))
    load = sheet.of("cord_curve_load")
    (
        sheet.texts("point", range(1, sheet.n_rows + 1))
        .numbers("strain", "cord_curve_strain", PERCENT)
        .numbers("load", "cord_curve_load")
        .numbers("share of break", load / load[-1], PERCENT, 3)
    )
    return sheet.table(
        f"Points of the cord of hose {view.name}; the last is its break.", remarks=remarks
    )


def hose_curve_table(view: HoseView) -> PageTable | None:
    """Return some evenly spaced points of the predicted curve, and the last."""
    sheet = Sheet(view, ("hose_point",))
    size = sheet.n_rows
    at = np.arange(size)
    sheet.keep((at % max(1, -(-(size - 1) // _ROWS)) == 0) | (at == size - 1))
    spacing = sheet.of("cord_spacing") / view.scalar("cord_diameter")
    (
        sheet.numbers("strain", "strain", PERCENT)
        .measured("tension", "tension")
        .measured("fill pressure", "fill_pressure")
        .numbers("cord", "cord_tension")
        .numbers("cord strain", "cord_strain", PERCENT)
        .numbers("cords' share", "cord_share", PERCENT)
        .numbers("rubber's share", "rubber_share", PERCENT)
        .numbers("wrap angle", "current_wrap_angle")
        .numbers("spacing over diameter", spacing, "number")
        .numbers("bore", "current_inner_diameter")
    )
    return sheet.table(
        f"Predicted curve of hose {view.name}, {sheet.n_rows:,} of {size:,} points; the archive"
        " and predictions.csv have them all.",
        is_tall=True, is_compact=True, remarks=_plus_minus_of_hoses([view]),
    )  # fmt: skip


def verdict_table(views: Sequence[ComparisonView]) -> PageTable | None:
    """Return the verdict of each comparison, one line each."""
    return Sheet.stack(
        Sheet(view)
        .at("curve", view.curve_place(view.judged))
        .texts("comparison", [view.name])
        .texts("test", [view.test])
        .texts("hose", [view.hose])
        .texts("loading", [view.loading])
        .texts("verdict", [view.short_verdict])
        .numbers("bias", "tension_bias", digits=3)
        .numbers("RMS", "tension_rms", digits=3)
        .numbers("relative RMS", "tension_relative_rms", PERCENT, 3)
        .numbers("largest difference", "worst_tension_difference", digits=3)
        .numbers("at strain", "worst_strain", PERCENT, 3)
        .numbers("largest ratio", "largest_ratio", digits=3)
        .numbers("limit", "coverage_factor", digits=3)
        for view in views
    ).table(
        "Tests compared with their predicted hoses.",
        is_compact=True,
        remarks=[
            f"{_SIGN} Relative RMS: RMS difference over RMS measured tension.",
            "Largest ratio: largest difference over its standard uncertainty. The verdict is"
            " \"differs\" above the limit, which a correct prediction stays below in 95 % of cases;"
            " \"agrees\" means that no model error can be detected, not that there is none; \"says"
            " little\" means that the uncertainty is too wide to tell.",
        ],
    )  # fmt: skip


def compared_curve_table(view: ComparisonView) -> PageTable | None:
    """Return the differences of each measured curve, and those left after calibration."""
    sheet = Sheet(view, ("curve",)).keep(np.array([view.curve_place(one) for one in view.curves]))
    (
        sheet.texts(
            "curve", [f"{one}, judged" if one == view.judged else one for one in view.curves]
        ).shown("compared curves")
    )
    if view.fitted:
        calibrated = Sheet(view).shown("calibrated curve")
        left = dict(zip(calibrated.headings, (one for (one,) in calibrated.columns), strict=True))
        sheet.row(
            words(f"{view.judged}, calibrated"),
            *(left.get(heading, words("")) for heading in sheet.headings[1:]),
        )
    return sheet.table(
        f"Predicted minus measured tension of each curve, {view.name}.",
        remarks=[
            "The prediction is elastic, so each branch differs from it by half the hysteresis; the"
            f" {view.judged} is compared."
        ]
        if view.judged == "midline"
        else [f"The test has only its {view.judged} branch, which is compared."],
    )


def compared_event_table(view: ComparisonView) -> PageTable | None:
    """Return the events of the cords, predicted and measured, in tension and in strain."""
    sheet = Sheet(view, ("hose_event",))
    (sheet.texts("event", [event.words for event in view.events]).shown("compared events"))
    missing = not np.isfinite(sheet.of("event_measured_tension")).all()
    return sheet.table(
        f"Cord events, {view.name}: measured tension at the predicted strain, and measured strain"
        " at the predicted tension.",
        remarks=[
            f"{_SIGN} {_PLUS_MINUS}",
            *([f"{NOT_GIVEN}: not reached in the test."] if missing else []),
        ],
    )


def energy_table(view: ComparisonView) -> PageTable | None:
    """Return energies between the same two strains; None where none could be integrated."""
    return (
        Sheet(view, where="measured_energy")
        .spans("between strains", "energy_strain_low", "energy_strain_high", PERCENT, places=1)
        .shown("compared energies")
        .table(
            f"Energy absorbed per unit relaxed length of hose, {view.name}.",
            remarks=["The prediction has no hysteresis: it lies below the ascending branch by about"
                     " half the loop even where the midline agrees. No uncertainty is given for"
                     " energies."],
        )
    )  # fmt: skip


def calibration_table(view: ComparisonView) -> PageTable | None:
    """Return the fitted parameters with intervals and bounds; None where none was fitted."""
    fitted = [(one, one.shown(view.units)) for one in view.fitted]
    sheet = Sheet(view)
    (
        sheet.texts("number", [unit.label(one.words) for one, unit in fitted])
        .cells("start", [number(one.start, unit) for one, unit in fitted])
        .cells("fitted", [_fitted(*one) for one in fitted])
        .cells("95 % interval", [_interval(*one) for one in fitted])
        .cells(
            "kept between",
            [_range(one.lower_bound, one.upper_bound, unit) for one, unit in fitted],
        )
        .texts("at a bound", ["yes" if one.is_at_bound else "no" for one, _ in fitted])
    )
    force = shown("tension", view.units)
    added = number_text(force.factor * view.scalar("model_error"), 3)
    return sheet.table(
        f"Numbers of hose {view.hose} fitted to test {view.test}, {view.name}.",
        remarks=[
            plus_minus(
                sheet.factors,
                "scatter of the test, its stated errors, and the correlation of neighbouring"
                " strains", left_out="errors of the model",
            )
            + " Intervals are not cut at the bounds.",
            f"The residuals are equivalent to {view.scalar('effective_points'):.0f} independent"
            f" points; extra scatter needed to explain them: {added} {force.unit}.",
        ],
    )  # fmt: skip


def correlation_table(view: ComparisonView) -> PageTable | None:
    """Return the correlation of the fitted parameters; None with fewer than two."""
    if len(view.fitted) < 2:
        return None
    names = [one.words for one in view.fitted]
    sheet = Sheet(view).texts("number", names)
    for name, column in zip(names, view.array("parameter_correlation").T, strict=True):
        sheet.cells(name, map(_correlation, column))
    index = view.scalar("collinearity")
    if np.isinf(index):
        said = "none: the curve does not respond to one of them."
    else:
        said = f"{number_text(index, 3)}; above 10 to 15 is poor."
    return sheet.table(
        f"Correlation of the fitted numbers, {view.name}.",
        remarks=[f"Collinearity index: {said}"],
    )


def _fitted(one: FittedNumber, unit: Shown) -> TableCell:
    half, spread = (one.high - one.low) / 2, one.value_standard_uncertainty
    return measured(one.value, half, unit, factor=half / spread if spread > 0 else float("nan"))


def _interval(one: FittedNumber, unit: Shown) -> TableCell:
    """95 % interval to the digits of the uncertainty."""
    half = one.value_standard_uncertainty * unit.factor
    if not (np.isfinite(half) and half > 0):
        return _range(one.low, one.high, unit)
    places = int(np.clip(1 - np.floor(np.log10(half)), 0, 10))
    return span(one.low, one.high, unit, places=places)


def _range(low: float, high: float, unit: Shown) -> TableCell:
    return interval(low, high, unit) if np.isfinite(low) and np.isfinite(high) else words("")


def _correlation(value: float) -> TableCell:
    text = f"{value:+.3f}"
    return TableCell(text, repr(float(value)), is_number=True) if np.isfinite(value) else words("")
