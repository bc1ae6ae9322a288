"""Tables of armours, hoses, wave loads and comparisons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.prediction.armour import PredictedArmour
from reduction.prediction.wave_load import (
    CODE_OF_HYDROLOGY,
    PUBLISHED_COEFFICIENTS,
    PredictedWaveLoad,
)
from reduction.quantities.digits import plain_number
from reduction.quantities.units import UnitSystem, display_unit
from reduction.report.figures.theory_figures import (
    THEORY_NAMES,
    THEORY_WORDS,
    force_per_length,
    moment_unit,
    of_layers,
)
from reduction.report.product_views import SOURCE_WORDS, ComparisonView, FittedNumber, HoseView
from reduction.report.sheet import Calculated, Sheet
from reduction.report.test_view import NORMAL, factor_words, plus_minus
from reduction.report.text_style import (
    DEGREES,
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
    with_prefix,
    words,
)

_ROWS = 24
"""Of the curve of a hose on the page, about; the archive has them all."""

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
    """Return the sentence that says what ± is, or that nothing is known."""
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
    """Return where the cords pick up, work and break: a line a hose."""
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
    """Return what happens to the cords, in the order of stretch."""
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
    """Return the numbers that the hose is made of, and what follows from them."""
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
    """Return what the layers that carry no load are put to, and at which angle they bear it."""
    sheet = Sheet(view, ("hose_layer",))
    low, high, tensile, compressive = (
        sheet.of(f"hose_layer_{name}")
        for name in ("least_strain", "greatest_strain", "strain_limit", "compression_limit")
    )
    (
        sheet.texts("layer", "hose_layer_name")
        .numbers("wrap angle", "hose_layer_wrap_angle")
        .spans("strain up to working load", low, high, PERCENT, places=1)
        .numbers("most until cords break", "hose_layer_break_strain", PERCENT, 3)
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
    """Return some points of the predicted curve, evenly spread, with the last."""
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
    """Return what each comparison says: a line a comparison."""
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
    """Return the differences of each measured curve, and what the calibration leaves."""
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
    """Return what happens to the cords, predicted and measured, in tension and in strain."""
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
    """Return energies between the same two strains; None where nothing could be integrated."""
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
    """Return the fitted numbers with intervals and bounds; None where none was fitted."""
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
            " points;"
            f" extra scatter needed to explain them: {added} {force.unit}.",
        ],
    )  # fmt: skip


def correlation_table(view: ComparisonView) -> PageTable | None:
    """Return how the fitted numbers go together; None of fewer than two."""
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


def wires_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return forces, moments and stresses of one wire of each layer by each theory."""
    pairs = [
        (place, theory, response)
        for place in range(len(found.layer_names))
        for theory, response in found.responses.items()
    ]
    sheet = Sheet(Calculated(units)).texts(
        "layer, theory", [f"{found.layer_names[place]}, {THEORY_WORDS[theory]}"
                          for place, theory, _ in pairs]
    )  # fmt: skip
    for name in ("axial_force", "shear_force", "bending_moment", "torsion_moment", "axial_stress",
                 "bending_stress", "torsion_stress"):  # fmt: skip
        words_, kind = name.replace("_", " "), name.partition("_")[2]
        unit = {"force": shown("tension", units), "moment": moment_unit(units)}.get(kind, "stress")
        values = [getattr(response, name)[place, 0] for place, _, response in pairs]
        sheet.numbers(words_, values, unit)  # type: ignore[arg-type]
    return sheet.table(
        f"One wire of each layer by each theory, at {100 * float(found.strain[0]):g} % of strain of"
        " the cable.",
        is_compact=True,
        remarks=[
            "Exact: the exact helix with the report's moments; small and intermediate angles are"
            " approximations. With an energy: the rod whose tension is the derivative of its"
            " strain energy, used for layers and cable. Large angles: a spring without a core, a"
            " different body.",
            "No uncertainty is given: none is stated of the armour. None includes thinning of the"
            " wires or compliance of the core.",
        ],
    )  # fmt: skip


def layers_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return what each layer carries and presses, and whether its wires find room."""
    limit, together = found.layers.yield_stress, found.together
    yields = np.where(together.is_yielding[:, 0], "yes", "no")
    return (
        Sheet(Calculated(units))
        .texts("layer", found.layer_names)
        .numbers("tension", together.layer_tension[:, 0], "tension")
        .numbers("torque", together.layer_torque[:, 0], moment_unit(units))
        .numbers("pressure of the layer", together.layer_pressure[:, 0], "stress")
        .numbers("pressure with all outside", together.core_pressure[:, 0], "stress")
        .numbers("von Mises stress", together.wire_stress[:, 0], "stress")
        .numbers("yield stress", limit, "stress")
        .texts("yields", np.where(np.isfinite(limit), yields, ""))
        .numbers("circumference filled", found.fill, PERCENT)
        .numbers("room between wires", found.gap, "small length", 3)
        .numbers("lost by thinning", found.thinning_loss, PERCENT, 2)
        .table(
            f"Layers at {100 * float(found.strain[0]):g} % of strain of the cable, innermost"
            " first.",
            is_compact=True,
            remarks=["Torque: positive for right-handed wires. The cable is held against rotation;"
                     " its core is rigid; friction between layers is neglected. Lost by thinning:"
                     " the amount by which strain and tension are too high, since a thinning wire"
                     " moves towards the core."],
        )
    )  # fmt: skip


def cable_table(found: PredictedArmour, units: UnitSystem) -> PageTable:
    """Return tension, torque, stiffness and first yield of all layers together."""
    force, together = shown("tension", units), found.together
    held, free = found.axial_stiffness
    sheet = Sheet(Calculated(units))

    def add(name: str, value: float) -> None:
        sheet.numbers(name, [value], with_prefix(force, value))

    add("tension", float(together.tension[0]))
    sheet.numbers("torque", together.torque, moment_unit(units))
    left_over = "net torque over the sum of the layers' magnitudes"
    sheet.numbers(left_over, together.torque_imbalance, PERCENT, 3)
    add("axial stiffness, held against rotation", held)
    add("axial stiffness, free to rotate", free)
    if found.strength is None:
        about = "First yield not given: not every layer has a yield stress."
    else:
        sheet.numbers("strain at first yield", [found.strength.strain], PERCENT)
        add("tension at first yield", found.strength.tension)
        about = f"Layer {found.layer_names[found.strength.governing_layer]} yields first."
    return sheet.turned(
        "The cable.", ("value",), "number",
        remarks=["Stiffness: force per unit strain of the cable, at rest.", about],
    )  # fmt: skip


def use_table(found: PredictedArmour) -> PageTable | None:
    """Return between which angles each theory is within the tolerance, layer by layer."""
    pairs = [
        (f"{layer}, {THEORY_WORDS[theory]}", use.least_angle[i], use.greatest_angle[i])
        for layer, use in zip(found.layer_names, found.use, strict=True)
        for i, theory in enumerate(use.theory)
    ]
    sheet = Sheet(Calculated("si")).texts("layer, theory", [name for name, *_ in pairs])
    for k, name in enumerate(found.use[0].quantity):
        sheet.cells(
            DEGREES.label(name.replace("_", " ")),
            [_angles(float(low[k]), float(high[k])) for _, low, high in pairs],
        )
    return sheet.table(
        f"Winding angles at which each theory is within {100 * found.tolerance:g} % of the exact"
        " rod.",
        remarks=["From 5 to 85 degrees in steps of 0.5; the longest of several ranges."],
    )


def _angles(low: float, high: float) -> TableCell:
    if not np.isfinite(low):
        return TableCell("nowhere", is_number=True)
    return number(low, DEGREES, digits=3) if low == high else span(low, high, DEGREES, places=1)


def armour_design_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return what was given of each layer."""
    return (
        Sheet(Calculated(units))
        .texts("layer", found.layer_names)
        .numbers("winding angle", of_layers(found, "winding_angle"), DEGREES)
        .numbers("wire radius", of_layers(found, "wire_radius"), "small length")
        .numbers("core radius", of_layers(found, "core_radius"), "small length")
        .numbers("elastic modulus", of_layers(found, "elastic_modulus"), "stress")
        .numbers("poisson ratio", of_layers(found, "poisson_ratio"), "number")
        .counts("wires", of_layers(found, "n_wires"))
        .texts("lay", found.layers.lay)
        .table("Layers as given, innermost first.")
    )


def extremes_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable | None:
    """Return greatest and least load of both forms, with how much less the improved one is."""
    unit = force_per_length(units)
    pairs = [(one, end) for one in ("horizontal", "vertical") for end in ("maximum", "minimum")]
    sheet = Sheet(Calculated(units)).texts("load", [", ".join(pair) for pair in pairs])
    for heading, form in (("improved", ""), ("classic", "_classic")):
        own = [(getattr(found.extremes, f"{one}{form}"), end) for one, end in pairs]
        sheet.numbers(heading, [getattr(load, end) for load, end in own], unit)
        times = [getattr(load, f"time_of_{end}") for load, end in own]
        sheet.numbers("at", times, "time", 3)
    less = [getattr(found.difference, f"{one}_of_{end}") for one, end in pairs]
    return sheet.numbers("less than classic", less, PERCENT).table(
        "Extremes of the load over a period, by optimisation between the plotted times.",
        remarks=[
            "Classic: Morison's equation on the whole section. Improved: on the part under water"
            " in still water. Each has its own times of extremes.",
            "No uncertainty is given: none is stated for wave, hose or coefficients; that of the"
            " coefficients alone is tens of percent.",
        ],
    )


def wave_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return what the wave is, and how far it is from the limits of its theory."""
    theory = found.theory
    return (
        Sheet(Calculated(units))
        .numbers("height", [theory.steepness * theory.wave_length], "length")
        .numbers("period", [2 * np.pi / found.wave.angular_frequency], "time")
        .numbers("length", [theory.wave_length], "length")
        .numbers("depth of the water", [theory.relative_depth * theory.wave_length], "length")
        .numbers("current along the wave", [found.current_velocity], _velocity(units))
        .numbers("depth over length", [theory.relative_depth], "number")
        .numbers("height over length", [theory.steepness], "number")
        .numbers("height over breaking height", [theory.breaking_ratio], "number")
        .numbers("Ursell number", [theory.ursell_number], "number")
        .numbers(
            "second harmonic of the surface over the first", [theory.elevation_ratio], "number"
        )
        .numbers(
            "second harmonic of the velocity over the first", [theory.velocity_ratio], "number"
        )
        .numbers(
            "given length over that of the period, minus one", [theory.length_mismatch], PERCENT
        )
        .turned(
            "The wave.", ("value",), "number",
            remarks=[
                f"Computed by the theory of {_named(found.used)}. By relative depth, as the paper"
                f" reads its table: {_named(theory.theory)}; by the letter of the table:"
                f" {_named(theory.printed)}.",
            ],
        )
    )  # fmt: skip


def regime_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return the hose in the water, and the numbers by which coefficients are chosen."""
    section, regime = found.load.section, found.regime
    return (
        Sheet(Calculated(units))
        .numbers("outer diameter", [section.outer_diameter], "small length")
        .numbers("immersion depth", [section.immersion_depth], "small length")
        .numbers("share of the section under water", [section.submerged_share], PERCENT)
        .numbers("section under water", [section.submerged_section_area], "area")
        .numbers("level of the flow", [found.elevation], "small length")
        .numbers("maximum velocity of the water", [regime.greatest_velocity], _velocity(units))
        .numbers("Keulegan-Carpenter number", [regime.keulegan_carpenter_number], "number")
        .numbers("Reynolds number", [regime.reynolds_number], "number")
        .numbers("Reynolds over Keulegan-Carpenter", [regime.frequency_parameter], "number")
        .numbers("maximum drag over maximum inertia", [regime.drag_to_inertia], "number")
        .numbers("diameter over wave length", [regime.diameter_to_length], "number")
        .turned(
            "The hose in the water, and the flow past it.", ("value",), "number",
            remarks=["Velocity with the current, at the level of the load. Morison's equation holds"
                     " up to a diameter of 0.2 wave lengths."],
        )
    )  # fmt: skip


def anchor_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return the greatest horizontal force of wind, wave and current, added and as one flow."""
    length, speed, anchor = shown("length", units), _velocity(units), found.anchor
    return (
        Sheet(Calculated(units))
        .numbers("wind alone", [anchor.wind], "tension")
        .numbers("current alone", [anchor.current], "tension")
        .numbers("wave alone, maximum", [anchor.wave], "tension")
        .numbers("sum of the three", [anchor.separate], "tension")
        .numbers("wave and current as one flow, with the wind", [anchor.combined], "tension")
        .numbers("combined minus sum, over combined", [anchor.difference], PERCENT)
        .turned(
            f"Horizontal force on {length.factor * found.hose_length:.4g} {length.unit} of hose,"
            " the anchor force.",
            ("value",), "force",
            remarks=[
                f"Wind {speed.factor * found.wind_velocity:.4g} {speed.unit} at the hose, current"
                f" {speed.factor * found.current_velocity:.4g} {speed.unit}. Drag varies with the"
                " square of the velocity: velocities add, loads do not. The whole length is at one"
                " phase: it lies along the crest.",
            ],
        )
    )  # fmt: skip


def wave_coefficient_table(found: PredictedWaveLoad) -> PageTable | None:
    """Return published coefficients, with those of this case and where it stands among them."""
    regime, published = found.regime, (*PUBLISHED_COEFFICIENTS, CODE_OF_HYDROLOGY)
    at = f"KC {float(regime.keulegan_carpenter_number):.3g}"
    at += f", Re {plain_number(float(regime.reynolds_number), 3)}"
    return (
        Sheet(Calculated("si"))
        .texts("source", [one.source for one in published])
        .texts("wave theory", [one.wave_theory for one in published])
        .cells("drag", [_pair(*one.drag_coefficient) for one in published])
        .numbers("inertia", [one.inertia_coefficient for one in published], "number", 3)
        .texts("said of them", [one.comment for one in published])
        .row(
            words("this case"), words(_named(found.used)),
            number(found.drag_coefficient, digits=3), number(found.inertia_coefficient, digits=3),
            words(at),
        )
        .table(
            "Coefficients of drag and inertia as published, and of this case.",
            remarks=["None is for a floating cylinder, and none states its range of KC and Re."
                     " Inertia: one plus the added mass."],
        )
    )  # fmt: skip


def _named(theory: str) -> str:
    return THEORY_NAMES.get(theory, theory)


def _velocity(units: UnitSystem) -> Shown:
    unit, factor = display_unit("m s-1", units)
    return Shown({"m s-1": "m/s", "ft s-1": "ft/s"}.get(unit, unit), factor)


def _pair(low: float, high: float) -> TableCell:
    text = f"{low:g}" if low == high else f"{low:g} to {high:g}"
    return TableCell(text, f"{low!r} {high!r}", is_number=True)
