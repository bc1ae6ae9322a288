"""Tables and sentences about an experiment and its surfaces.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 7.2.7 (what a report of uncertainty holds).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reduction.archive.uncertainty_budget import all_budgets
from reduction.experiments.fit_results import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.quantities.names import QUANTITIES
from reduction.record.measurement import Floats
from reduction.report.answer_tables import AnswerBudget
from reduction.report.campaign_summary import SummaryFinding
from reduction.report.figures.surface_figures import base_response, term_words
from reduction.report.product_views import FORM_WORDS, ExperimentView, in_words, response_unit
from reduction.report.sheet import Sheet
from reduction.report.surface_grid import (
    expanded_of_coefficients,
    expanded_of_runs,
    extremes_in_box,
    interval_of_surfaces,
    negative_inside,
    shared_by_runs,
)
from reduction.report.test_tables import CONDITIONING, REFUSED, about_line, add_line
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
    make_table,
    number,
    number_text,
    share_text,
    shown,
    source_meanings,
    source_words,
    superscript,
    with_interval,
    words,
)
from reduction.uncertainty.budget import RANDOM, Budget, BudgetRow

_PRINTED = (
    "F as CG-D-39-80 prints it counts the mean among the terms and in the error (10 and 4 degrees"
    " of freedom for fifteen runs); it stands here to be compared with the report, no more."
)

_OF_RUNS = "scatter of the runs about the surface"

_ONE_LINE = "that one line was tested"

NOT_OF_RUNS = "what all runs share: calibration, gauge length, the one line that was tested"
"""What no scatter of runs has in it."""

_LARGE = 1e9
"""From here on a column of squares has powers of ten in every row, not in some."""

_ON_SCALE = {"log": ", by its logarithm", "box-cox": ", by its Box-Cox transform"}


def run_table(
    view: ExperimentView, tests: Mapping[str, TestView] | None = None
) -> PageTable | None:
    """Return the runs as planned and as reached, with what each gave."""
    own = {} if tests is None else tests
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
            expanded_of_runs(view, name, own), is_short=True,
        )  # fmt: skip
    if any(view.texts("run_remark")):
        sheet.texts("remark", "run_remark")
    factors = ", ".join(in_words(name) for name in view.factors)
    return sheet.table(
        f"Runs as planned (coded {factors}) and as reached: means over the cycles of each run; peak"
        " and minimum are the greatest and least of its cycles.",
        remarks=[_about_runs(view, sheet, own)], is_compact=True,
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
    """Return a cell of a number to so many places; the archive's own value is beside it."""
    if not np.isfinite(value * factor):
        return TableCell(NOT_GIVEN, is_number=True)
    text = f"{round(value * factor, places) + 0.0:,.{places}f}"
    return TableCell(text, repr(float(value)), is_number=True)


def _coded(levels: Floats) -> str:
    return ", ".join("0" if level == 0 else f"{level:+g}" for level in levels)


def caution_table(view: ExperimentView) -> PageTable | None:
    """Return what the runs as reached warn of."""
    own = view.own_rows("caution")
    return (
        Sheet(view)
        .texts("what", [row["caution_kind"].replace("-", " ") for row in own])
        .texts("runs", [row.get("caution_runs", "") or "all runs" for row in own])
        .texts("what is so", [row["caution"] for row in own])
        .texts("what can be done", [row.get("caution_hint", "") for row in own])
        .table("Cautions: what is wrong with the runs as they were made, before any number is"
               " read.")
    )  # fmt: skip


def effect_table(view: ExperimentView, name: str) -> PageTable | None:
    """Return the effects of a screening on one response, the largest first."""
    effect = view.array(f"{name}_effect")
    if effect.size == 0:
        return None
    # without dummies the error is Lenth's, of a third as many degrees of freedom as effects
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
        .probabilities("p [1]", view.array(f"{name}_effect_p_value")[order])
        .texts("significant", np.where(is_factor, counts, "")[order])
    )
    return sheet.table(
        f"{in_words(name).capitalize()}: effects, mean at the high level less that at the low one.",
        remarks=["A dummy is a column that no factor uses: what it shows is scatter and"
                 " interactions.", plus_minus(sheet.factors, "effects of the dummies",
                                               left_out=NOT_OF_RUNS)],
    )  # fmt: skip


def answer_table(view: ExperimentView, surfaces: ResponseSurfaces) -> PageTable | None:
    """Return each response in the middle of the tested range, and from where to where it goes."""
    least, greatest, _ = extremes_in_box(surfaces)
    centre = np.zeros((1, len(view.factors)))
    middle = evaluate_surfaces(surfaces, centre, units="coded")
    lows, highs = interval_of_surfaces(view, surfaces, centre)
    names = surfaces.response_names
    bent = {base_response(one) for one in names if one != base_response(one)}
    kept = [
        (k, base_response(name), response_unit(base_response(name), view.units))
        for k, name in enumerate(names)
        if np.isfinite(middle.value[k, 0]) and not (name in bent and least[k] < 0)
    ]
    cells = [
        with_interval(
            float(middle.value[k, 0]), float(lows[k, 0]), float(highs[k, 0]), unit
        )
        for k, _, unit in kept
    ]  # fmt: skip
    middles = ", ".join(
        f"{in_words(name)} {number_text(view.levels(place)[1], 3)} {view.factor_units[place].unit}"
        for place, name in enumerate(view.factors)
    )
    sources = shared_by_runs(view, surfaces)
    return (
        Sheet(view)
        .texts(
            "response",
            [
                unit.label(f"{in_words(base)}{_ON_SCALE.get(surfaces.transform[k], '')}")
                for k, base, unit in kept
            ],
        )
        .cells("in the middle", [shown_ for shown_, _ in cells])
        .cells(f"{100 * middle.confidence:g} % interval", [ends for _, ends in cells])
        .cells("least in the range", [number(float(least[k]), unit) for k, _, unit in kept])
        .cells("greatest in the range", [number(float(greatest[k]), unit) for k, _, unit in kept])
        .table(
            f"Experiment {view.name}: each response by its surface, in the middle of the tested"
            f" range ({middles}) and over all of it.",
            remarks=[f"The interval is of the surface and holds {_held(sources)}. Not in it:"
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
    for heading, shares in (("r²", surfaces.r2), ("adjusted r²", surfaces.adjusted_r2),
                            ("predicted r²", surfaces.predicted_r2)):  # fmt: skip
        sheet.cells(
            f"{heading} [1]",
            [TableCell(share_text(float(one)), repr(float(one)), is_number=True) for one in shares],
        )
    n_terms = len(surfaces.term_names) - 1
    (
        sheet.cells(
            "standard deviation of a run, s [its unit]",
            [number(float(one), unit) for one, unit in zip(surfaces.sigma, units, strict=True)],
        )
        .numbers("F of all terms", surfaces.overall_f, "number")
        .texts("degrees of freedom", [f"{n_terms}, {one}" for one in surfaces.degrees_of_freedom])
        .probabilities("p of F [1]", surfaces.overall_p_value)
        .numbers("F of lack of fit", lack.f, "number")
        .probabilities("p of lack of fit [1]", lack.p_value)
    )
    is_printed = bool(np.isfinite(surfaces.printed_f).any())
    if is_printed:
        sheet.numbers("F as CG-D-39-80 prints it", surfaces.printed_f, "number")
    return sheet.table(
        "Quality of each surface. p: probability of such an F if the terms were nil, or if the"
        " surface fitted.",
        is_compact=True, remarks=[_PRINTED] if is_printed else [],
    )  # fmt: skip


def surface_coefficient_table(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> PageTable | None:
    """Return the coefficients of a surface, coded and in the units of the factors."""
    name = surfaces.response_names[index]
    unit, said = response_unit(name, view.units), in_words(name)
    coded, in_units = (
        expanded_of_coefficients(view, surfaces, index, in_units=is_it) for is_it in (False, True)
    )
    sources = shared_by_runs(view, surfaces)
    engineering = [view.coefficient_unit(name, tuple(one.tolist())) for one in surfaces.exponents]
    computed = zip(
        surfaces.coefficient_engineering[index], in_units.all.half, engineering, strict=True
    )
    sheet = Sheet(view).texts("", surfaces.labels)
    sheet.texts("term", [term_words(powers, view.factors) for powers in surfaces.exponents])
    sheet.measured("coefficient, coded", surfaces.coefficient[index], unit, coded.all)
    if sources:
        sheet.numbers("shared part of ±, coded", coded.shared, unit, 2)
    (
        sheet.numbers("t", surfaces.t[index], "number")
        .probabilities("p [1]", surfaces.p_value[index])
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
            f"In units: {units}. Digits enough to compute with; the errors of coefficients in"
            " units go together, so that a value of the surface is far better known than the sum of"
            " theirs.",
            plus_minus(sheet.factors, _held(sources), left_out=_left_out(sources)),
            "Shared part: what of ± all runs share, with the same k; the parts add by their"
            " squares. t and p are of the scatter alone." if sources else "",
        ])),
    )  # fmt: skip


def anova_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> PageTable | None:
    """Return the analysis of variance of a surface."""
    anova, name = surfaces.anova, surfaces.response_names[index]
    unit = response_unit(name, view.units)
    square = Shown(_squared(unit.unit), unit.factor**2)
    is_large = bool(np.nanmax(anova.sum_of_squares[index]) * square.factor >= _LARGE)
    sheet = Sheet(view).texts("source", anova.source)
    sheet.counts("degrees of freedom [1]", anova.degrees_of_freedom[index])
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
        sheet.numbers("F", anova.f[index], "number")
        .probabilities("p [1]", anova.p_value[index])
        .texts("tested against", anova.error_term)
        .table(
            f"{in_words(name).capitalize()}: analysis of variance, each source after those above"
            " it."
        )
    )


def _held(sources: Sequence[str]) -> str:
    """Say what the uncertainty of a surface holds."""
    told = ", ".join(source_words(one) for one in sources)
    return f"{_OF_RUNS}; and what all runs share: {told}" if told else _OF_RUNS


def _left_out(sources: Sequence[str]) -> str:
    return _ONE_LINE if sources else NOT_OF_RUNS


def _to_compute_with(value: float, spread: float, unit: Shown) -> TableCell:
    """Return a coefficient of seven digits and its uncertainty of two."""
    if not np.isfinite(value):
        return TableCell(NOT_GIVEN, is_number=True)
    half = f" ± {number_text(spread * unit.factor, 2)}" if np.isfinite(spread) else ""
    text = f"{number_text(value * unit.factor, 7)}{half}"
    return TableCell(text, repr(float(value)), is_number=True)


def _squared(unit: str) -> str:
    return unit if unit == "1" else f"({unit})²" if " " in unit or "/" in unit else f"{unit}²"


def line_of_runs_table(view: ExperimentView, tests: Mapping[str, TestView]) -> PageTable | None:
    """Return the parameters of the line of each run, and those derived from surfaces beside."""
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
    found = Sheet.stack(sheets, view)
    return found.table(
        "The three-parameter line of each run; at the right K_1 and tau from surfaces of E' and E''"
        " at the same levels, which smooth over the runs.",
        is_compact=True, optional=(REFUSED,), remarks=[CONDITIONING, *about_line(found, used)],
    )  # fmt: skip


def _forms(view: ExperimentView, *dims: str) -> Sheet:
    """A row a form, or a coefficient of one; none without any fit."""
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
        .probabilities("p if nil [1]", "stiffness_p_value")
    )
    return sheet.table(
        "Coefficients of the stiffness forms of mooring codes.",
        remarks=[plus_minus(sheet.factors, "scatter of the runs about the form",
                            left_out="that the form itself may be wrong: see its quality")],
    )  # fmt: skip


def form_quality_table(view: ExperimentView) -> PageTable | None:
    """Return how well each form fits the runs, beside the quadratic surface."""
    sheet = _forms(view)
    if not sheet.n_rows:
        return None
    strength = float(np.nanmax(view.per_run("run_rated_break_strength")))
    unit = response_unit("apparent_spring_constant", view.units)
    return (
        sheet.counts("coefficients [1]", "stiffness_n_coefficients")
        .numbers("r²", "stiffness_r2")
        .numbers("adjusted r²", "stiffness_adjusted_r2")
        .numbers("predicted r²", "stiffness_predicted_r2")
        .numbers("s over break strength", "stiffness_sigma")
        .numbers("s", "stiffness_sigma", Shown(unit.unit, unit.factor * strength))
        .numbers("AICc", "stiffness_aicc")
        .table(
            "The forms against the quadratic surface of the same runs.",
            remarks=["s: standard deviation of a run about the form. AICc: lower is better; one"
                     " form against another on the same runs, nothing by itself."],
        )
    )  # fmt: skip


_RUN_TO_RUN, _REGRESSION = "run_to_run", "regression"


def coefficient_budgets(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int
) -> list[AnswerBudget]:
    """Return the budget of each coded coefficient of a surface: what runs share, and what not."""
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
                f"{one.place['term']}, {term_words(powers, view.factors)}", "", unit,
                _apart(one, share),
            )
        )  # fmt: skip
    return found


def _share_of_repeats(surfaces: ResponseSurfaces, index: int) -> float:
    """Share of the variance about a surface that repeated runs have; NaN where there are none."""
    anova = surfaces.anova
    row = anova.source.index("pure error")
    freedom = float(anova.degrees_of_freedom[index, row])
    variance = float(surfaces.sigma[index]) ** 2
    if not (freedom > 0 and variance > 0):
        return float("nan")
    return float(min(anova.sum_of_squares[index, row] / freedom / variance, 1.0))


def _apart(budget: Budget, share: float) -> Budget:
    """Budget with the scatter about the surface in two parts; in one where runs have no twin."""
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


def coefficient_budget_table(
    view: ExperimentView, name: str, answers: Sequence[AnswerBudget]
) -> PageTable | None:
    """Return the numbers of the bars: value, uncertainty, factor, and the share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(one.words),
            one.cell,
            number(one.budget.coverage_factor, digits=3),
            *(_percent(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        f"{in_words(name).capitalize()}: share of each source in the variance of the coefficients.",
        ("coefficient, coded", answers[0].unit.label("value"), "k [1]",
         *(f"{source_words(one)} [%]" for one in sources)),
        rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[f"±: expanded uncertainty, 95 % ({factors}).", source_meanings(sources)],
    )  # fmt: skip


def _percent(value: float) -> TableCell:
    return TableCell(f"{100 * value:.1f}", repr(value), is_number=True)


def experiment_findings(view: ExperimentView) -> list[SummaryFinding]:
    """Return what a reader must know of an experiment before its numbers."""
    name = f"experiment {view.name}"
    found = [
        SummaryFinding("warning", (name,), row["caution"] + _of_runs(row))
        for row in view.own_rows("caution")
    ]
    surfaces = view.surfaces
    if surfaces is not None:
        negative = negative_inside(surfaces)
        found += [
            SummaryFinding("warning", (name,), f"{in_words(one)}: {_lower(text)}")
            for one in surfaces.response_names
            for text in negative_words(view, surfaces, one, negative)
        ]
    return found + [SummaryFinding(one.severity, (name,), str(one)) for one in view.notes]


def negative_words(
    view: ExperimentView,
    surfaces: ResponseSurfaces,
    name: str,
    negative: Mapping[str, tuple[float, Floats]],
) -> list[str]:
    """Warn of a surface that goes where its response cannot."""
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
        f"Take the surface of its {in_words(bent[0]).split(' of ')[0]} instead, below: it cannot."
        if bent
        else f'Ask for one that cannot: transform = {{ {name} = "log" }} in the campaign.'
    )
    return [
        f"This surface falls to {number_text(least * unit.factor, 3)} {unit.unit} inside"
        f" the tested range (at {at}), and a {in_words(name)} cannot be negative. {instead}"
    ]


def quality_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Say how well a surface fits, and that the report would print another F."""
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
        f" {number_text(float(surfaces.overall_f[index]))},"
        f" {_p(float(surfaces.overall_p_value[index]))}."
    ]
    reason = LACK_OF_FIT_REASONS[int(lack.reason[index])]
    if reason:
        sentences.append(f"No test of lack of fit: {reason}.")
    else:
        p = float(lack.p_value[index])
        verdict = (
            "the runs depart from the surface by more than repeats differ"
            if p < _SIGNIFICANCE
            else "no departure is seen beyond the scatter of repeats"
        )
        sentences.append(
            f"Lack of fit: F({lack.degrees_of_freedom[index]},"
            f" {lack.pure_error_degrees_of_freedom[index]}) = {number_text(float(lack.f[index]))},"
            f" {_p(p)}: {verdict}."
        )
    if np.isfinite(surfaces.printed_f[index]):
        sentences.append(
            "For comparison alone, the F that CG-D-39-80 prints, with the mean among the terms, is"
            f" {number_text(float(surfaces.printed_f[index]))} here."
        )
    return " ".join(sentences)


_SIGNIFICANCE = 0.05


def stationary_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
    """Say whether the surface has a summit or a hollow, and where."""
    canonical = surfaces.canonical
    reason = STATIONARY_REASONS[int(canonical.reason[index])]
    if reason:
        return f"No stationary point: {reason}."
    kind = STATIONARY_KINDS[int(canonical.kind[index])]
    if not canonical.is_inside[index]:
        return (
            f"Stationary point: a {kind}, outside the tested range: within it the surface has no"
            " summit and no hollow, and its greatest and least values lie on the boundary."
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
    """Say how the specimens differ where there are several."""
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
    return [f"Specimens against their mean, over the same levels: {effects}."]


def single_time_words(view: ExperimentView) -> list[str]:
    """Say whether one relaxation time holds over frequency."""
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
    """Say each form in words, and how it does against the quadratic surface."""
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


def _of_runs(row: Mapping[str, str]) -> str:
    runs = row.get("caution_runs", "")
    return f" ({runs})" if runs else ""


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
