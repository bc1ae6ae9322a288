"""What the page says of an experiment in sentences: quality, summit, line, forms, warnings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reduction.record import Floats
from reduction.report.experimentview import FORM_WORDS, ExperimentView, in_words, response_unit
from reduction.report.figures.surfaces import base_response
from reduction.report.htmltable import number_text, share_text
from reduction.report.summary import Finding
from reduction.report.surfacegrid import negative_inside
from reduction.surface.product import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)


def experiment_findings(view: ExperimentView) -> list[Finding]:
    """Return what a reader must know of an experiment before its numbers."""
    name = f"experiment {view.name}"
    found = [
        Finding("warning", (name,), row["caution"] + _of_runs(row))
        for row in view.own_rows("caution")
    ]
    surfaces = view.surfaces
    if surfaces is not None:
        negative = negative_inside(surfaces)
        found += [
            Finding("warning", (name,), f"{in_words(one)}: {_lower(text)}")
            for one in surfaces.response_names
            for text in negative_words(view, surfaces, one, negative)
        ]
    for note in dict.fromkeys(row["note"] for row in view.own_rows("note")):
        found.append(Finding("refusal" if "refused" in note else "note", (name,), note))
    return found


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
