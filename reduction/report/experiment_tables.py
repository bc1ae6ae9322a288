"""Tables and sentences on experiments and their surfaces.

References
----------
.. [1] CG-D-39-80, sec. 4.4.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 7.2.7 (what a report of uncertainty holds).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.shared_errors import FREEDOM
from reduction.archive.uncertainty_budget import all_budgets
from reduction.experiments.fit_results import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.experiments.screening import alias_matrix
from reduction.experiments.surface_points import (
    evaluate_surfaces,
    extremes_in_box,
)
from reduction.quantities.digits import fixed_number, places_of
from reduction.quantities.names import QUANTITIES, RESPONSES, SCALES
from reduction.quantities.row import CONTRIBUTION
from reduction.record.contributions import CONFIDENCE, coverage_factor, effective_degrees_of_freedom
from reduction.record.measurement import Floats, Integers
from reduction.record.notes import urgency
from reduction.report.answer_tables import AnswerBudget
from reduction.report.campaign_summary import TOPICS, SummaryFinding
from reduction.report.product_views import (
    FORM_WORDS,
    ExperimentView,
    base_response,
    expanded_of_runs,
    in_words,
    response_unit,
)
from reduction.report.sheet import Sheet
from reduction.report.test_section import CONDITIONING, REFUSED, about_line, add_line
from reduction.report.test_view import (
    Expanded,
    TestView,
    expand,
    factor_words,
    plus_minus,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    NOT_GIVEN,
    PERCENT,
    PageTable,
    Shown,
    TableCell,
    f_text,
    in_order,
    make_table,
    number,
    number_text,
    percent_cell,
    share_text,
    shown,
    source_meanings,
    source_words,
    superscript,
    with_interval,
    words,
)
from reduction.uncertainty.budget import RANDOM, Budget, BudgetRow
from reduction.uncertainty.surface_errors import with_shared_at_points


def negative_inside(surfaces: ResponseSurfaces) -> dict[str, tuple[float, Floats]]:
    """Return least value and its place of each surface that is negative although it cannot be."""
    least, _, place = extremes_in_box(surfaces)
    return {
        name: (float(least[index]), place[index])
        for index, name in enumerate(surfaces.response_names)
        if name in RESPONSES and least[index] < 0
    }


@dataclass(frozen=True)
class _CoefficientSpread:
    """Expanded uncertainty of the coefficients of a surface, and its shared part alone."""

    all: Expanded
    shared: Floats


def _expanded_of_coefficients(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, *, in_units: bool = False
) -> _CoefficientSpread:
    """Return the uncertainty of the coefficients of a surface, coded or in units."""
    name = f"{surfaces.response_names[index]}_coefficient"
    random = surfaces.coefficient_standard_uncertainty[index]
    if in_units:
        name += "_engineering"
        random = surfaces.coefficient_engineering_standard_uncertainty[index]
    contribution = _rows(view, name, random.size)
    factor = coverage_factor(
        effective_degrees_of_freedom(
            random,
            surfaces.term_degrees_of_freedom[index],
            contribution=contribution,
            of_contribution=_freedom(view),
        )
    )
    shared = np.sqrt(np.sum(contribution**2, axis=0))
    return _CoefficientSpread(Expanded(factor * np.hypot(random, shared), factor), factor * shared)


def _shared_by_runs(view: ExperimentView, surfaces: ResponseSurfaces) -> list[str]:
    """Return the shared sources of the runs that affect a surface, in fixed order."""
    sources = view.texts("uncertainty_source")
    found: set[str] = set()
    for name in surfaces.response_names:
        rows = _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        found |= {sources[place] for place in np.flatnonzero(np.nan_to_num(rows).any(axis=1))}
    return in_order(found)


def _interval_of_surfaces(
    view: ExperimentView, surfaces: ResponseSurfaces, coded: ArrayLike
) -> tuple[Floats, Floats]:
    """Return the ends of the 95 % interval of every surface at points in coded levels."""
    at = evaluate_surfaces(surfaces, coded, units="coded", outside="flag")
    rows = [
        _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        for name in surfaces.response_names
    ]
    both = with_shared_at_points(surfaces, at, np.stack(rows, axis=1), _freedom(view))
    ends = both.confidence_interval
    return np.array(ends[..., 0]), np.array(ends[..., 1])


def _rows(view: ExperimentView, name: str, n_terms: int) -> Floats:
    """Contributions to the coefficients, shape (n_components, n_terms): zero where none."""
    found = view.array(f"{name}{CONTRIBUTION}")
    n_components = _freedom(view).size
    if found.ndim != 2:
        return np.zeros((n_components, n_terms))
    return np.asarray(found[:n_components, :n_terms])


def _freedom(view: ExperimentView) -> Floats:
    """Degrees of freedom of each shared error of the experiment."""
    sources = list(filter(None, view.texts("uncertainty_source")))
    known = view.array(FREEDOM)[: len(sources)]
    return np.where(known > 0, known, np.inf) if known.size else np.full(len(sources), np.inf)


def _term_words(powers: Integers, factors: tuple[str, ...]) -> str:
    """Return a term in words.

    Examples
    --------
    >>> _term_words(np.array([1, 1]), ("frequency", "mean_tension"))
    'frequency by mean tension'
    >>> _term_words(np.array([2, 0]), ("frequency", "mean_tension"))
    'frequency²'
    """
    parts = [
        in_words(name) + ("²" if power == 2 else "")
        for name, power in zip(factors, powers, strict=True)
        if power
    ]
    return " by ".join(parts) or "mean"


_LEAST_ALIAS = 1e-6


_FULL = 1 - 1e-6


def confounding_words(view: ExperimentView) -> list[str]:
    """Name the effects that are confounded with each main effect."""
    plan = view.array("run_plan")[:, : len(view.factors)]
    _, alias = alias_matrix(np.where(plan < 0, -1.0, 1.0))
    of_factors = np.abs(alias[1:])
    present = of_factors > _LEAST_ALIAS
    if not present.any():
        return ["No two-factor interaction is aliased with a main effect."]
    largest = float(of_factors.max())
    whole = "the whole of" if largest > _FULL else f"up to {largest:.2g} of"
    numbers = sorted({int(number) for number in present.sum(axis=1)})
    many = " to ".join(map(str, dict.fromkeys([numbers[0], numbers[-1]])))
    return [
        f"Confounding: each main effect is aliased with {whole} {many} interactions of two other"
        " factors, with either sign. A factor that looks active may be a sum of interactions, and"
        " one that looks inactive may be hidden by them. Confirm the result by a second experiment."
    ]


_PRINTED = (
    "F as printed in CG-D-39-80 counts the mean among the terms and in the error (10 and 4 degrees"
    " of freedom for fifteen runs); it is given only for comparison with the report."
)


_OF_RUNS = "scatter of the runs about the surface"


_ONE_LINE = "differences between lines (one was tested)"


NOT_OF_RUNS = "errors common to all runs: calibration, gauge length, the one line tested"

"""Errors that no scatter of runs includes."""


_LARGE = 1e9

"""From this value on, all rows of a column of squares have powers of ten."""


_ON_SCALE = {
    "log": ", by its logarithm",
    "box-cox": ", by its Box-Cox transform",
    "log-times-frequency": ", by the logarithm of its product with frequency",
}


def run_table(view: ExperimentView, tests: Mapping[str, TestView]) -> PageTable | None:
    """Return the runs as planned and as reached, with the responses of each."""
    strength = view.per_run("run_rated_break_strength")
    is_share = bool(np.isfinite(strength).any())
    load = Shown("%RBS", 100.0) if is_share else shown("tension", view.units)
    divisor = strength if is_share else np.ones(len(view.runs))
    level, plan = view.array("run_level"), view.array("run_plan")[:, : len(view.factors)]
    sheet = Sheet(view, ("run",)).texts("run", view.runs).texts("plan, coded", map(_coded, plan))
    for place, unit in enumerate(view.factor_units):
        sheet.numbers(in_words(view.factors[place]), level[:, place], unit)
    for heading, name in (("peak", "run_peak_tension"), ("minimum", "run_minimum_tension")):
        pairs = zip(view.per_run(name), load.factor / divisor, strict=True)
        sheet.cells(load.label(heading), [_fixed(*one, 1 if is_share else 0) for one in pairs])
    for name in view.responses:
        sheet.measured(
            in_words(name), view.per_run(f"{name}_measured"), response_unit(name, view.units),
            expanded_of_runs(view, name, tests), is_short=True,
        )  # fmt: skip
    if any(view.texts("run_remark")):
        sheet.texts("remark", "run_remark")
    factors = ", ".join(in_words(name) for name in view.factors)
    return sheet.table(
        f"Runs as planned (coded {factors}) and as reached: means over the cycles of each run; peak"
        " and minimum are the greatest and least of its cycles.",
        remarks=[_about_runs(view, sheet, tests)], is_compact=True,
    )  # fmt: skip


def _about_runs(view: ExperimentView, sheet: Sheet, tests: Mapping[str, TestView]) -> str:
    runs = [tests[name] for name in dict.fromkeys(view.texts("run_name")) if name in tests]
    held = "scatter between the cycles of the run"
    if runs:
        names = [f"test_{name}" for name in view.responses]
        return plus_minus_of_tests(sheet.factors, runs, names, found_from=held)
    has_line = {"dissipation_spring_constant", "relaxation_time"} & set(view.responses)
    return plus_minus(sheet.factors, held + (", and the K_0 of the slow pull" if has_line else ""))


def _fixed(value: float, factor: float, places: int) -> TableCell:
    """Return a cell with a number to so many places; it also keeps the value of the archive."""
    if not np.isfinite(value * factor):
        return TableCell(NOT_GIVEN, is_number=True)
    text = f"{round(value * factor, places) + 0.0:,.{places}f}"
    return TableCell(text, repr(float(value)), is_number=True)


def _coded(levels: Floats) -> str:
    return ", ".join("0" if level == 0 else f"{level:+g}" for level in levels)


def caution_table(view: ExperimentView) -> PageTable | None:
    """Return the warnings about the runs as reached."""
    own = view.own_rows("caution")
    return (
        Sheet(view)
        .texts("kind", [row["caution_kind"].replace("-", " ") for row in own])
        .texts("runs", [row.get("caution_runs", "") or "all runs" for row in own])
        .texts("caution", [row["caution"] for row in own])
        .texts("remedy", [row.get("caution_hint", "") for row in own])
        .table("Cautions about the runs as they were made.")
    )  # fmt: skip


def effect_table(view: ExperimentView, name: str) -> PageTable | None:
    """Return the effects of a screening on one response, the largest first."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0:
        return None
    # without dummies the error is Lenth's, with a third as many degrees of freedom as effects
    freedom = effect.size - len(view.factors) or effect.size / 3
    spread = expand(view.scalar(f"{name}_effect_standard_uncertainty"), degrees_of_freedom=freedom)
    order = np.argsort(-np.abs(effect), kind="stable")
    counts = np.where(view.array(f"{name}_effect_is_significant") > 0, "yes", "no")
    is_factor = np.arange(effect.size) < len(view.factors)
    sheet = Sheet(view)
    (
        sheet.texts("factor", [in_words(view.texts("plan_column_name")[k]) for k in order])
        .measured("effect", effect[order], response_unit(name, view.units), spread)
        .numbers("share of the mean", effect[order] / view.scalar(f"{name}_mean"), PERCENT, 3)
        .numbers("t", view.array(f"{name}_effect_t")[order], "number")
        .probabilities("p", view.array(f"{name}_effect_p_value")[order])
        .texts("significant", np.where(is_factor, counts, "")[order])
    )
    return sheet.table(
        f"{in_words(name).capitalize()}: effects (mean at the high level minus mean at the low"
        " level).",
        remarks=[
            "A dummy is a column without a factor: it shows scatter and interactions.",
            plus_minus(sheet.factors, "effects of the dummies", left_out=NOT_OF_RUNS),
        ],
    )  # fmt: skip


def answer_table(view: ExperimentView, surfaces: ResponseSurfaces) -> PageTable | None:
    """Return each response in the middle of the tested range, and its range over it."""
    least, greatest, _ = extremes_in_box(surfaces)
    centre = np.zeros((1, len(view.factors)))
    middle = evaluate_surfaces(surfaces, centre, units="coded")
    lows, highs = _interval_of_surfaces(view, surfaces, centre)
    names = surfaces.response_names
    # of several surfaces of a response, the one used for look-ups
    used = {
        next(f"{scale}{base}" for scale in (*SCALES, "") if f"{scale}{base}" in names)
        for base in map(base_response, names)
    }
    kept = [
        (k, base_response(name), response_unit(base_response(name), view.units))
        for k, name in enumerate(names)
        if np.isfinite(middle.value[k, 0]) and name in used
    ]
    cells = [
        with_interval(
            float(middle.value[k, 0]), float(lows[k, 0]), float(highs[k, 0]), unit
        )
        for k, _, unit in kept
    ]  # fmt: skip

    def extreme(values: Floats, k: int, unit: Shown) -> TableCell:
        """Return a value with as many significant digits as that in the middle."""
        half = float(highs[k, 0] - lows[k, 0]) / 2
        if not (np.isfinite(half) and half > 0 and middle.value[k, 0]):
            return number(float(values[k]), unit)
        digits = places_of(half, 2) - places_of(float(middle.value[k, 0]), 1) + 1
        value = float(values[k]) * unit.factor
        text = fixed_number(value, places_of(value, min(max(digits, 2), 7)))
        return TableCell(text, repr(float(values[k])), is_number=True)

    middles = ", ".join(
        f"{in_words(name)} {number_text(view.levels(place)[1], 3)} {view.factor_units[place].unit}"
        for place, name in enumerate(view.factors)
    )
    sources = _shared_by_runs(view, surfaces)
    return (
        Sheet(view)
        .texts(
            "response",
            [
                unit.label(f"{in_words(base)}{_ON_SCALE.get(surfaces.transform[k], '')}")
                for k, base, unit in kept
            ],
        )
        .cells("at the centre", [shown_ for shown_, _ in cells])
        .cells(f"{100 * CONFIDENCE:g} % interval", [ends for _, ends in cells])
        .cells("minimum", [extreme(least, k, unit) for k, _, unit in kept])
        .cells("maximum", [extreme(greatest, k, unit) for k, _, unit in kept])
        .table(
            f"Experiment {view.name}: responses from the fitted surfaces, at the centre of the"
            f" tested range ({middles}) and over the whole range.",
            remarks=[f"The interval is that of the surface: {_held(sources)}. Not included:"
                     f" {_left_out(sources)}."],
        )
    )  # fmt: skip


def quality_table(view: ExperimentView, surfaces: ResponseSurfaces) -> PageTable | None:
    """Return how well the surface of each response fits."""
    names, lack = surfaces.response_names, surfaces.lack_of_fit
    units = [response_unit(name, view.units) for name in names]
    sheet = Sheet(view).texts(
        "response", [unit.label(in_words(name)) for name, unit in zip(names, units, strict=True)]
    )
    within = "" if surfaces.blocks is None else " within blocks"
    for heading, shares in (("r²", surfaces.r2), ("adjusted r²", surfaces.adjusted_r2),
                            ("predicted r²", surfaces.predicted_r2)):  # fmt: skip
        sheet.cells(
            f"{heading}{within}",
            [TableCell(share_text(float(one)), repr(float(one)), is_number=True) for one in shares],
        )
    n_terms = len(surfaces.term_names) - 1
    (
        sheet.cells(
            "standard deviation of a run, s [its unit]",
            [number(float(one), unit) for one, unit in zip(surfaces.sigma, units, strict=True)],
        )
        .f_values("F of all terms", surfaces.overall_f)
        .texts("degrees of freedom", [f"{n_terms}, {one}" for one in surfaces.degrees_of_freedom])
        .probabilities("p of F", surfaces.overall_p_value)
        .f_values("F of lack of fit", lack.f)
        .probabilities("p of lack of fit", lack.p_value)
    )
    is_printed = bool(np.isfinite(surfaces.printed_f).any())
    if is_printed:
        sheet.f_values("F as printed in CG-D-39-80", surfaces.printed_f)
    return sheet.table(
        "Quality of each surface. p: probability of an F this large if the terms were zero (F of"
        " all terms) or the surface were adequate (lack of fit).",
        is_compact=True, remarks=[_PRINTED] if is_printed else [],
    )  # fmt: skip


def surface_coefficient_table(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> PageTable | None:
    """Return the coefficients of a surface, coded and in the units of the factors."""
    name = surfaces.response_names[index]
    unit, said = response_unit(name, view.units), in_words(name)
    coded, in_units = (
        _expanded_of_coefficients(view, surfaces, index, in_units=is_it) for is_it in (False, True)
    )
    sources = _shared_by_runs(view, surfaces)
    engineering = [view.coefficient_unit(name, tuple(one.tolist())) for one in surfaces.exponents]
    computed = zip(
        surfaces.coefficient_engineering[index], in_units.all.half, engineering, strict=True
    )
    sheet = Sheet(view).texts("", surfaces.labels)
    sheet.texts("term", [_term_words(powers, view.factors) for powers in surfaces.exponents])
    sheet.measured("coefficient, coded", surfaces.coefficient[index], unit, coded.all)
    if sources:
        sheet.numbers("shared part of ±, coded", coded.shared, unit, 2)
    (
        sheet.numbers("t", surfaces.t[index], "number")
        .probabilities("p", surfaces.p_value[index])
        .cells("coefficient, in units", [_to_compute_with(*one) for one in computed])
        .texts("its unit", [superscript(one.unit) for one in engineering])
    )
    base = base_response(name)
    of_numbers = (
        f"The {said.split(' of ')[0]} is of the {in_words(base)} as a number of"
        f" {superscript(QUANTITIES[base].unit)}, whatever units the page shows."
        if name != base
        else ""
    )
    units = ", ".join(
        f"{in_words(factor)} in {one.unit}"
        for factor, one in zip(view.factors, view.factor_units, strict=True)
    )
    return sheet.table(
        f"{said[0].upper()}{said[1:]}: coefficients of the surface, for coded levels and for levels"
        " in units.",
        remarks=list(filter(None, [
            of_numbers,
            f"In units: {units}. The digits suffice for computation. Errors of the coefficients"
            " are correlated: a value of the surface is known much better than their sum suggests.",
            plus_minus(sheet.factors, _held(sources), left_out=_left_out(sources)),
            "Shared part: the part of ± common to all runs, with the same k; parts combine in"
            " quadrature. t and p are for the scatter alone." if sources else "",
        ])),
    )  # fmt: skip


def anova_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> PageTable | None:
    """Return the analysis of variance of a surface."""
    anova, name = surfaces.anova, surfaces.response_names[index]
    unit = response_unit(name, view.units)
    square = Shown(_squared(unit.unit), unit.factor**2)
    is_large = bool(np.nanmax(anova.sum_of_squares[index]) * square.factor >= _LARGE)
    sheet = Sheet(view).texts("source", anova.source)
    sheet.counts("degrees of freedom", anova.degrees_of_freedom[index])
    for heading, values in (("sum of squares", anova.sum_of_squares[index]),
                            ("mean square", anova.mean_square[index])):  # fmt: skip
        sheet.cells(
            square.label(heading),
            [
                TableCell(f"{one * square.factor:.3e}", repr(float(one)), is_number=True)
                if is_large
                else number(float(one), square)
                for one in values
            ],
        )
    return (
        sheet.f_values("F", anova.f[index])
        .probabilities("p", anova.p_value[index])
        .texts("tested against", anova.error_term)
        .table(f"{in_words(name).capitalize()}: sequential analysis of variance.")
    )


def _held(sources: Sequence[str]) -> str:
    """Describe the uncertainty of a surface."""
    told = ", ".join(source_words(one) for one in sources)
    return f"{_OF_RUNS}; and errors common to all runs: {told}" if told else _OF_RUNS


def _left_out(sources: Sequence[str]) -> str:
    return _ONE_LINE if sources else NOT_OF_RUNS


def _to_compute_with(value: float, spread: float, unit: Shown) -> TableCell:
    """Return a coefficient to seven digits and its uncertainty to two."""
    if not np.isfinite(value):
        return TableCell(NOT_GIVEN, is_number=True)
    half = f" ± {number_text(spread * unit.factor, 2)}" if np.isfinite(spread) else ""
    text = f"{number_text(value * unit.factor, 7)}{half}"
    return TableCell(text, repr(float(value)), is_number=True)


def _squared(unit: str) -> str:
    return unit if unit == "1" else f"({unit})²" if " " in unit or "/" in unit else f"{unit}²"


def line_of_runs_table(view: ExperimentView, tests: Mapping[str, TestView]) -> PageTable | None:
    """Return the line parameters of each run, with those derived from surfaces."""
    constant, time = (
        view.per_run(f"derived_{name}")
        for name in ("dissipation_spring_constant", "relaxation_time")
    )
    sheets, used = [], []
    pairs = zip(view.texts("run_name"), view.texts("run_specimen"), strict=True)
    for k, (run, specimen) in enumerate(pairs):
        test = tests.get(run)
        if test is None or "test_relaxation_time" not in test.data:
            continue
        used.append(test)
        sheet = Sheet(test, ("specimen",)).keep(np.array([test.specimens.index(specimen)]))
        add_line(sheet.texts("run", [view.runs[k]]), test)
        sheet.numbers("K_1 from surfaces", constant[[k]], "tension")
        sheets.append(sheet.numbers("tau from surfaces", time[[k]], "time"))
    found = Sheet.stack(sheets)
    return found.table(
        "The three-parameter line of each run; at the right K_1 and tau from surfaces of E' and E''"
        " at the same levels, which smooth over the runs.",
        is_compact=True, optional=(REFUSED,), remarks=[CONDITIONING, *about_line(found, used)],
    )  # fmt: skip


def _forms(view: ExperimentView, *dims: str) -> Sheet:
    """One row per form, or per coefficient of a form; none without any fit."""
    sheet = Sheet(view, ("stiffness_form", *dims))
    if not np.isfinite(view.array("stiffness_n_coefficients")).any():
        sheet.keep(np.zeros(sheet.n_rows, dtype=bool))
    if dims:
        sheet.keep(sheet.of("stiffness_coefficient_name", "").astype(str) != "")
    names = map(str, sheet.of("stiffness_form", ""))
    return sheet.texts("form", [FORM_WORDS.get(name, name) for name in names])


def form_table(view: ExperimentView) -> PageTable | None:
    """Return the coefficients of the stiffness forms with their intervals."""
    sheet = _forms(view, "stiffness_term")
    if not sheet.n_rows:
        return None
    low, high = (sheet.of(f"stiffness_coefficient_{end}") for end in ("low", "high"))
    half, spread = (high - low) / 2, sheet.of("stiffness_coefficient_standard_uncertainty")
    confidence = 100 * float(np.nanmax(view.array("stiffness_confidence")))
    (
        sheet.texts("coefficient", "stiffness_coefficient_name")
        .measured("value", sheet.of("stiffness_coefficient"), None, Expanded(half, half / spread))
        .texts("unit", "stiffness_coefficient_unit")
        .cells(
            f"{confidence:g} % interval",
            [
                TableCell(f"{a:.4g} to {b:.4g}", f"{float(a)!r} {float(b)!r}", is_number=True)
                for a, b in zip(low, high, strict=True)
            ],
        )
        .probabilities("p if zero", "stiffness_p_value")
    )
    return sheet.table(
        "Coefficients of the stiffness forms of mooring codes.",
        remarks=[plus_minus(sheet.factors, "scatter of the runs about the form",
                            left_out="error of the form itself: see its quality")],
    )  # fmt: skip


def form_quality_table(view: ExperimentView) -> PageTable | None:
    """Return how well each form fits the runs, compared with the quadratic surface."""
    sheet = _forms(view)
    if not sheet.n_rows:
        return None
    strength = float(np.nanmax(view.per_run("run_rated_break_strength")))
    unit = response_unit("apparent_spring_constant", view.units)
    return (
        sheet.counts("coefficients", "stiffness_n_coefficients")
        .numbers("r²", "stiffness_r2")
        .numbers("adjusted r²", "stiffness_adjusted_r2")
        .numbers("predicted r²", "stiffness_predicted_r2")
        .numbers("s over break strength", "stiffness_sigma")
        .numbers("s", "stiffness_sigma", Shown(unit.unit, unit.factor * strength))
        .numbers("AICc", "stiffness_aicc")
        .table(
            "The forms against the quadratic surface of the same runs.",
            remarks=["s: standard deviation of a run about the form. AICc: lower is better;"
                     " compare only forms fitted to the same runs."],
        )
    )  # fmt: skip


_RUN_TO_RUN, _REGRESSION = "run_to_run", "regression"


def coefficient_budgets(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> list[AnswerBudget]:
    """Return the budget of each coded coefficient of a surface, with shared and random errors."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    share = _share_of_repeats(surfaces, index)
    labels = {label: place for place, label in enumerate(surfaces.labels)}
    found = []
    for one in all_budgets(view.data, f"{name}_coefficient"):
        if one.place["experiment"] != view.name or not one.standard_uncertainty > 0:
            continue
        place = labels[one.place["term"]]
        powers = surfaces.exponents[place]
        found.append(
            AnswerBudget(
                f"{one.place['term']}, {_term_words(powers, view.factors)}", "", unit,
                _apart(one, share),
            )
        )  # fmt: skip
    return found


def _share_of_repeats(surfaces: ResponseSurfaces, index: int) -> float:
    """Share of repeated runs in the variance about a surface; NaN without repeats."""
    anova = surfaces.anova
    row = anova.source.index("pure error")
    freedom = float(anova.degrees_of_freedom[index, row])
    variance = float(surfaces.sigma[index]) ** 2
    if not (freedom > 0 and variance > 0):
        return float("nan")
    return float(min(anova.sum_of_squares[index, row] / freedom / variance, 1.0))


def _apart(budget: Budget, share: float) -> Budget:
    """Budget with the scatter about the surface in two parts; in one without repeated runs."""
    parts = {_REGRESSION: 1.0} if np.isnan(share) else {
        _RUN_TO_RUN: share, _REGRESSION: 1 - share,
    }  # fmt: skip
    rows = []
    for one in budget.rows:
        if one.source != RANDOM:
            rows.append(one)
            continue
        rows += [
            BudgetRow(source, "", one.contribution * np.sqrt(part), one.share * part)
            for source, part in parts.items()
        ]
    return replace(budget, rows=tuple(sorted(rows, key=lambda row: -row.share)))


def coefficient_budget_table(name: str, answers: Sequence[AnswerBudget]) -> PageTable | None:
    """Return the values behind the bars: value, uncertainty, factor, and share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(one.words),
            one.cell,
            number(one.budget.coverage_factor, digits=3),
            *(percent_cell(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        f"{in_words(name).capitalize()}: share of each source in the variance of the coefficients.",
        ("coefficient, coded", answers[0].unit.label("value"), "k",
         *(f"{source_words(one)} [%]" for one in sources)),
        rows, is_compact=True,
        remarks=[f"±: expanded uncertainty, 95 % ({factors}).", source_meanings(sources)],
    )  # fmt: skip


def experiment_findings(view: ExperimentView) -> list[SummaryFinding]:
    """Return what a reader must know about an experiment before its numbers."""
    name = f"experiment {view.name}"
    cautions = view.own_rows("caution")
    found = [
        SummaryFinding(
            "warning", (name,), _caution_words(row), topic=TOPICS.get(row["caution_kind"])
        )
        for row in cautions
    ]
    # the caution names these runs
    told = {"run-slack"} if any(row["caution_kind"] == "slack" for row in cautions) else set()
    surfaces = view.surfaces
    if surfaces is not None:
        negative = negative_inside(surfaces)
        found += [
            SummaryFinding("warning", (name,), f"{in_words(one)}: {_lower(text)}")
            for one in surfaces.response_names
            for text in negative_words(view, surfaces, one, negative)
        ]
    return found + [
        SummaryFinding(one.severity, (name,), str(one), urgency(one), TOPICS.get(one.code))
        for one in view.notes
        if one.code not in told
    ]


def negative_words(
    view: ExperimentView,
    surfaces: ResponseSurfaces,
    name: str,
    negative: Mapping[str, tuple[float, Floats]],
) -> list[str]:
    """Warn of a surface with values that its response cannot have."""
    if name not in negative:
        return []
    least, place = negative[name]
    unit = response_unit(name, view.units)
    at = ", ".join(
        f"{number_text(low + (one + 1) / 2 * (high - low), 3)} {own.unit}"
        for one, own, (low, _, high) in zip(
            place, view.factor_units, map(view.levels, range(len(view.factors))), strict=True
        )
    )
    bent = [one for one in surfaces.response_names if one != name and base_response(one) == name]
    instead = (
        f"Use the surface of its {in_words(bent[0]).split(' of ')[0]} below, which stays positive."
        if bent
        else f'Request one that cannot: transform = {{ {name} = "log" }} in the campaign.'
    )
    return [
        "This surface falls to"
        f" {number_text(least * unit.factor, 3)}{'' if unit.unit == '1' else ' ' + unit.unit}"
        f" inside the tested range (at {at}), and a {in_words(name)} cannot be negative. {instead}"
    ]


def quality_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Describe the fit of a surface, and that the report would print another F."""
    lack = surfaces.lack_of_fit
    unit = response_unit(surfaces.response_names[index], view.units)
    freedom = int(surfaces.degrees_of_freedom[index])
    shares = [
        share_text(float(one[index]))
        for one in (surfaces.r2, surfaces.adjusted_r2, surfaces.predicted_r2)
    ]
    scatter = number_text(float(surfaces.sigma[index]) * unit.factor, 3)
    sentences = [
        f"r² {shares[0]}, adjusted {shares[1]}, predicted {shares[2]}; standard deviation of a run"
        f" about the surface {scatter}{'' if unit.unit == '1' else ' ' + unit.unit}."
        f" F({len(surfaces.term_names) - 1}, {freedom}) ="
        f" {f_text(float(surfaces.overall_f[index]))},"
        f" {_p(float(surfaces.overall_p_value[index]))}."
    ]
    reason = LACK_OF_FIT_REASONS[int(lack.reason[index])]
    if reason:
        sentences.append(f"No test of lack of fit: {reason}.")
    else:
        p = float(lack.p_value[index])
        verdict = (
            "the runs deviate from the surface by more than repeated runs scatter"
            if p < _SIGNIFICANCE
            else "no lack of fit beyond the scatter of repeated runs"
        )
        sentences.append(
            f"Lack of fit: F({lack.degrees_of_freedom[index]},"
            f" {lack.pure_error_degrees_of_freedom[index]}) = {f_text(float(lack.f[index]))},"
            f" {_p(p)}: {verdict}."
        )
    if np.isfinite(surfaces.printed_f[index]):
        sentences.append(
            "For comparison only: the F that CG-D-39-80 prints, with the mean among the terms, is"
            f" {f_text(float(surfaces.printed_f[index]))} here."
        )
    return " ".join(sentences)


_SIGNIFICANCE = 0.05


def stationary_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Describe a maximum or minimum of the surface, and its place."""
    canonical = surfaces.canonical
    reason = STATIONARY_REASONS[int(canonical.reason[index])]
    if reason:
        return f"No stationary point: {reason}."
    kind = STATIONARY_KINDS[int(canonical.kind[index])]
    if not canonical.is_inside[index]:
        return (
            f"Stationary point: a {kind}, outside the tested range: within it the surface has no"
            " maximum or minimum, and its extremes lie on the boundary."
        )
    unit = response_unit(surfaces.response_names[index], view.units)
    at = ", ".join(
        f"{in_words(name)} {number_text(float(value) * one.factor, 3)} {one.unit} (coded"
        f" {coded:+.2f} ± {spread:.2g})"
        for name, value, one, coded, spread in zip(
            view.factors, canonical.stationary_point_engineering[index], view.factor_units,
            canonical.stationary_point[index],
            canonical.stationary_point_standard_uncertainty[index], strict=True,
        )
    )  # fmt: skip
    value = number_text(float(canonical.stationary_value[index]) * unit.factor)
    return f"Stationary point: a {kind} of {value} {unit.unit} inside the tested range, at {at}."


def block_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> list[str]:
    """Describe the differences between specimens where there are several."""
    blocks = surfaces.blocks
    if blocks is None:
        return []
    unit = response_unit(surfaces.response_names[index], view.units)
    said = "" if unit.unit == "1" else f" {unit.unit}"
    if blocks.treatment == "random":
        spread = number_text(float(blocks.standard_deviation[index]) * unit.factor, 3)
        none = " (no more than runs of one specimen do)" if blocks.at_boundary[index] else ""
        return [
            f"{len(blocks.names)} specimens, taken as a sample of others: they differ by a standard"
            f" deviation of {spread}{said}{none}."
        ]
    effects = ", ".join(
        f"{name} {float(effect) * unit.factor:+.3g}{said}"
        for name, effect in zip(blocks.names, blocks.effect[index], strict=True)
    )
    return [f"Difference of each specimen from their mean, at the same levels: {effects}."]


def single_time_words(view: ExperimentView) -> list[str]:
    """Describe whether one relaxation time holds over frequency."""
    verdict = view.text("single_time_verdict")
    if not verdict:
        return []
    exponent = view.scalar("single_time_exponent")
    if not np.isfinite(exponent):
        return [f"A single relaxation time over frequency: {verdict}."]
    low, high = (view.scalar(f"single_time_exponent_{end}") for end in ("low", "high"))
    tolerance = view.scalar("single_time_tolerance")
    ratio, span = view.scalar("single_time_ratio"), view.scalar("single_time_frequency_ratio")
    return [
        f"A single relaxation time over frequency: {verdict}. With tau ~ f⁻ⁿ, n = {exponent:.4f}"
        f" ({low:.4f} to {high:.4f}; 0 is one relaxation time and 1 is 1/f, either met to within"
        f" {tolerance:g}); over a frequency ratio of {span:.3g} the relaxation time changes by a"
        f" factor of {ratio:.3g}."
    ]


def form_words(view: ExperimentView) -> list[str]:
    """Describe each form in words, and its fit compared with the quadratic surface."""
    equations = view.array_of_texts("stiffness_equation")
    if not equations.size or not any(equations):
        return []
    forms = [str(name) for name in view.data["stiffness_form"].values]
    sentences = [
        f"{FORM_WORDS.get(name, name)}: {_FORM_SENTENCES.get(name, '')}{text}."
        for name, text in zip(forms, equations, strict=True)
        if text
    ]
    scatter = view.array("stiffness_sigma")
    low = float(np.nanmin(view.array("stiffness_mean_load_low")))
    high = float(np.nanmax(view.array("stiffness_mean_load_high")))
    text = (
        f"Range of use: mean tension {100 * low:.3g} to {100 * high:.3g} % of the break strength,"
        " and the amplitudes and frequencies of the runs."
    )
    if "quadratic" in forms and scatter[forms.index("quadratic")] > 0:
        over = scatter / scatter[forms.index("quadratic")]
        more = [
            f"{over[k]:.3g} for {FORM_WORDS.get(name, name)}"
            for k, name in enumerate(forms)
            if name != "quadratic" and np.isfinite(over[k])
        ]
        text += (
            " Standard deviation of a run about the form, over that about the quadratic surface:"
            f" {', '.join(more)}."
        )
    return [*sentences, text]


_FORM_SENTENCES = {
    "del-vecchio": "stiffness over break strength is a constant, plus a share of the mean load,"
    " less a share of the load amplitude and of the logarithm of the period; ",
    "mean-load": "stiffness is a share of the break strength plus a multiple of the mean tension,"
    " whatever amplitude and period; ",
}


def _p(value: float) -> str:
    return "p < 0.0001" if value < 1e-4 else f"p = {value:.4f}"


def _caution_words(row: Mapping[str, str]) -> str:
    """Return a caution with its runs, unless it names them, and with what to do."""
    said, runs, hint = row["caution"], row.get("caution_runs", ""), row.get("caution_hint", "")
    of_runs = f" ({runs})" if runs and runs not in said else ""
    return f"{said}{of_runs}{f'. {hint}' if hint else ''}"


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
