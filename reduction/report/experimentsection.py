"""The section of one experiment: what was run, its surfaces, the line, forms, effects."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reduction.record import Floats
from reduction.report.experimenttables import (
    anova_table,
    caution_table,
    coefficient_table,
    effect_table,
    quality_table,
    run_table,
    share_text,
)
from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figures.lines import draw_derived, draw_forms, draw_single_time
from reduction.report.figures.screening import confounding_words, draw_effects
from reduction.report.figures.surfacechecks import draw_checks, draw_pareto
from reduction.report.figures.surfaces import (
    base_response,
    draw_contours,
    draw_cube,
    draw_surface,
)
from reduction.report.htmltable import number_text
from reduction.report.linetables import (
    FORM_WORDS,
    form_quality_table,
    form_table,
    line_of_runs_table,
)
from reduction.report.section import Part, Section, make_part, provenance_of
from reduction.report.surfacegrid import make_planes, negative_inside
from reduction.report.view import TestView
from reduction.surface.product import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)

__all__ = ["make_experiment_section"]


def make_experiment_section(view: ExperimentView, tests: Mapping[str, TestView]) -> Section:
    """Return the section of one experiment.

    Parameters
    ----------
    view : ExperimentView
        The experiment.
    tests : mapping of str to TestView
        The runs that were tests, by their names; what is not there is left out.
    """
    surfaces = view.surfaces
    parts = [
        make_part("What was run", (), [run_table(view), caution_table(view)]),
        *(_surface_parts(view, surfaces, tests) if surfaces is not None else []),
        *_effect_parts(view),
        make_part(
            "The three-parameter line",
            [*draw_single_time(view), *draw_derived(view)], [line_of_runs_table(view, tests)],
            _single_time_words(view),
        ),
        make_part(
            "Stiffness as mooring codes ask for it", draw_forms(view),
            [form_table(view), form_quality_table(view)], _form_words(view),
        ),
    ]  # fmt: skip
    kind = view.text("experiment_kind").replace("box-behnken", "Box-Behnken")
    kind = kind.replace("plackett-burman", "Plackett-Burman")
    of = ", ".join(in_words(name) for name in view.factors)
    notes = list(dict.fromkeys(row["note"] for row in view.own_rows("note")))
    provenance, documents = provenance_of(view.data.attrs)
    return Section(
        key=view.key,
        title=f"Experiment {view.name}",
        subtitle=f"{kind} design over {of}; {len(view.runs)} runs",
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=(("What a reader of the numbers has to know", notes),) if notes else (),
        provenance=provenance,
        documents=documents,
        noun="experiment",
    )


def _surface_parts(
    view: ExperimentView, surfaces: ResponseSurfaces, tests: Mapping[str, TestView]
) -> list[Part]:
    order = {
        name: int(test.attribute("test_order"))
        for name, test in tests.items()
        if test.attribute("test_order").isdigit()
    }
    planes = make_planes(view, surfaces)
    negative = negative_inside(surfaces)
    parts = [make_part("Quality of the surfaces", (), [quality_table(view, surfaces)])]
    for index, name in enumerate(surfaces.response_names):
        heading = in_words(name)
        if surfaces.reason[index] in _NO_SURFACE:
            reason = FIT_REASONS[int(surfaces.reason[index])]
            parts.append(make_part(_capital(heading), (), (), [f"No surface: {reason}."]))
            continue
        on_planes = []
        if planes is not None:
            on_planes = [
                *draw_surface(view, surfaces, index, planes),
                *draw_contours(view, surfaces, index, planes),
            ]
        parts.append(
            make_part(
                _capital(heading),
                [
                    *on_planes,
                    *draw_cube(view, surfaces, index),
                    *draw_pareto(view, surfaces, index),
                ],
                (),
                [
                    _quality_words(view, surfaces, index),
                    _stationary_words(view, surfaces, index),
                ],
                folded=make_part(
                    f"{_capital(heading)}: coefficients, analysis of variance, residuals",
                    draw_checks(view, surfaces, index, order),
                    [coefficient_table(view, surfaces, index), anova_table(view, surfaces, index)],
                ),
                warnings=_warning(view, surfaces, name, negative),
            )
        )
    return parts


_NO_SURFACE = (1, 2, 6)


def _effect_parts(view: ExperimentView) -> list[Part]:
    if not view.is_screening:
        return []
    words = confounding_words(view)
    parts = []
    for name in view.responses:
        reason = view.text(f"{name}_effect_refusal")
        parts.append(
            make_part(
                f"Effects on the {in_words(name)}", draw_effects(view, name),
                [effect_table(view, name)], [f"No effects: {reason}."] if reason else words,
            )
        )  # fmt: skip
        words = []
    return parts


def _warning(
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


def _quality_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
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


def _stationary_words(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> str:
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


def _single_time_words(view: ExperimentView) -> list[str]:
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


def _form_words(view: ExperimentView) -> list[str]:
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


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
