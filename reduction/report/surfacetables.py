"""Tables of the surfaces of an experiment: the answer, quality, coefficients, ANOVA."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.experimentview import ExperimentView, in_words, response_unit
from reduction.report.figures.surfacechecks import term_words
from reduction.report.figures.surfaces import base_response
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
    probability,
    share_text,
    with_interval,
    words,
)
from reduction.report.sources import source_words
from reduction.report.style import Shown, superscript
from reduction.report.surfacegrid import extremes_in_box
from reduction.report.surfaceuncertainty import (
    expanded_of_coefficients,
    interval_of_surfaces,
    shared_by_runs,
)
from reduction.report.uncertainty import plus_minus
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.product import ResponseSurfaces
from reduction.vocabulary import QUANTITIES

__all__ = ["NOT_OF_RUNS", "anova_table", "answer_table", "coefficient_table", "quality_table"]

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


def answer_table(view: ExperimentView, surfaces: ResponseSurfaces) -> Table | None:
    """Return each response in the middle of the tested range, and from where to where it goes.

    Of a response that another surface holds above zero, the one that falls below is left out.
    """
    least, greatest, _ = extremes_in_box(surfaces)
    middle = evaluate_surfaces(surfaces, np.zeros((1, len(view.factors))), units="coded")
    lows, highs = interval_of_surfaces(view, surfaces, np.zeros((1, len(view.factors))))
    sources = shared_by_runs(view, surfaces)
    bent = {base_response(one) for one in surfaces.response_names if one != base_response(one)}
    rows = []
    for k, name in enumerate(surfaces.response_names):
        base = base_response(name)
        if not np.isfinite(middle.value[k, 0]) or (name in bent and least[k] < 0):
            continue
        unit = response_unit(base, view.units)
        low, high = float(lows[k, 0]), float(highs[k, 0])
        rows.append(
            [
                words(unit.label(f"{in_words(base)}{_ON_SCALE.get(surfaces.transform[k], '')}")),
                *with_interval(float(middle.value[k, 0]), low, high, unit),
                number(float(least[k]), unit),
                number(float(greatest[k]), unit),
            ]
        )
    if not rows:
        return None
    middles = ", ".join(
        f"{in_words(name)} {number_text(view.levels(place)[1], 3)} {view.factor_units[place].unit}"
        for place, name in enumerate(view.factors)
    )
    return make_table(
        f"Experiment {view.name}: each response by its surface, in the middle of the tested range"
        f" ({middles}) and over all of it.",
        ("response", "in the middle", f"{100 * middle.confidence:g} % interval",
         "least in the range", "greatest in the range"),
        rows, synthetic=view.is_synthetic,
        remarks=[f"The interval is of the surface and holds {_held(sources)}. Not in it:"
                 f" {_left_out(sources)}."],
    )  # fmt: skip


_ON_SCALE = {"log": ", by its logarithm", "box-cox": ", by its Box-Cox transform"}


def quality_table(view: ExperimentView, surfaces: ResponseSurfaces) -> Table:
    """Return how well the surface of each response fits."""
    lack = surfaces.lack_of_fit
    rows = []
    for k, name in enumerate(surfaces.response_names):
        unit = response_unit(name, view.units)
        freedom = f"{len(surfaces.term_names) - 1}, {surfaces.degrees_of_freedom[k]}"
        rows.append(
            [
                words(unit.label(in_words(name))),
                *(
                    Cell(share_text(float(one[k])), repr(float(one[k])), is_number=True)
                    for one in (surfaces.r2, surfaces.adjusted_r2, surfaces.predicted_r2)
                ),
                number(float(surfaces.sigma[k]), unit),
                number(float(surfaces.overall_f[k])),
                words(freedom),
                probability(float(surfaces.overall_p_value[k])),
                number(float(lack.f[k])),
                probability(float(lack.p_value[k])),
                number(float(surfaces.printed_f[k])),
            ]
        )
    remarks = [_PRINTED]
    columns: tuple[str, ...] = (
        "response", "r² [1]", "adjusted r² [1]", "predicted r² [1]",
        "standard deviation of a run, s [its unit]", "F of all terms [1]", "degrees of freedom",
        "p of F [1]", "F of lack of fit [1]", "p of lack of fit [1]",
        "F as CG-D-39-80 prints it [1]",
    )  # fmt: skip
    if not np.isfinite(surfaces.printed_f).any():
        columns, rows, remarks = columns[:-1], [row[:-1] for row in rows], []
    return make_table(
        "Quality of each surface. p: probability of such an F if the terms were nil, or if the"
        " surface fitted.",
        columns, rows, synthetic=view.is_synthetic, is_compact=True, remarks=remarks,
    )  # fmt: skip


def coefficient_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> Table:
    """Return the coefficients of a surface, coded and in the units of the factors."""
    name = surfaces.response_names[index]
    unit = response_unit(name, view.units)
    coded, in_units = (
        expanded_of_coefficients(view, surfaces, index, in_units=is_it) for is_it in (False, True)
    )
    sources = shared_by_runs(view, surfaces)
    rows = []
    for k, label in enumerate(surfaces.labels):
        powers = surfaces.exponents[k]
        engineering = view.coefficient_unit(name, tuple(powers.tolist()))
        rows.append(
            [
                words(label),
                words(term_words(powers, view.factors)),
                measured(
                    float(surfaces.coefficient[index, k]), float(coded.all.half[k]), unit,
                    factor=float(coded.all.factor[k]),
                ),
                *([number(float(coded.shared[k]), unit, digits=2)] if sources else []),
                number(float(surfaces.t[index, k])),
                probability(float(surfaces.p_value[index, k])),
                _to_compute_with(
                    float(surfaces.coefficient_engineering[index, k]),
                    float(in_units.all.half[k]),
                    engineering,
                ),
                words(superscript(engineering.unit)),
            ]
        )  # fmt: skip
    base = f"{in_words(name)}: coefficients of the surface"
    scale = in_words(name).split(" of ")[0]
    of_numbers = (
        [
            f"The {scale} is of the {in_words(base_response(name))} as a number of"
            f" {superscript(QUANTITIES[base_response(name)].unit)}, whatever units the page shows."
        ]
        if name != base_response(name)
        else []
    )
    units = ", ".join(
        f"{in_words(factor)} in {one.unit}"
        for factor, one in zip(view.factors, view.factor_units, strict=True)
    )
    return make_table(
        f"{base[0].upper()}{base[1:]}, for coded levels and for levels in units.",
        ("", "term", unit.label("coefficient, coded"),
         *([unit.label("shared part of ±, coded")] if sources else []), "t [1]", "p [1]",
         "coefficient, in units", "its unit"),
        rows, synthetic=view.is_synthetic,
        remarks=[
            *of_numbers,
            f"In units: {units}. Digits enough to compute with; the errors of coefficients in"
            " units go together, so that a value of the surface is far better known than the sum of"
            " theirs.",
            plus_minus(
                factors_of(rows), _held(sources), left_out=_left_out(sources)
            ),
            *(
                ["Shared part: what of ± all runs share, with the same k; the parts add by their"
                 " squares. t and p are of the scatter alone."]
                if sources
                else []
            ),
        ],
    )  # fmt: skip


def anova_table(view: ExperimentView, surfaces: ResponseSurfaces, index: int) -> Table:
    """Return the analysis of variance of a surface."""
    anova, name = surfaces.anova, surfaces.response_names[index]
    unit = response_unit(name, view.units)
    square = Shown(_squared(unit.unit), unit.factor**2)
    is_large = bool(np.nanmax(anova.sum_of_squares[index]) * square.factor >= _LARGE)
    rows = [
        [
            words(source),
            count(float(anova.degrees_of_freedom[index, k])),
            *(
                Cell(f"{one[index, k] * square.factor:.3e}", repr(float(one[index, k])), True)
                if is_large
                else number(float(one[index, k]), square)
                for one in (anova.sum_of_squares, anova.mean_square)
            ),
            number(float(anova.f[index, k])),
            probability(float(anova.p_value[index, k])),
            words(anova.error_term[k]),
        ]
        for k, source in enumerate(anova.source)
    ]
    return make_table(
        f"{in_words(name).capitalize()}: analysis of variance, each source after those above it.",
        ("source", "degrees of freedom [1]", square.label("sum of squares"),
         square.label("mean square"), "F [1]", "p [1]", "tested against"),
        rows, synthetic=view.is_synthetic,
    )  # fmt: skip


def _held(sources: Sequence[str]) -> str:
    """Say what the uncertainty of a surface holds."""
    told = ", ".join(source_words(one) for one in sources)
    return f"{_OF_RUNS}; and what all runs share: {told}" if told else _OF_RUNS


def _left_out(sources: Sequence[str]) -> str:
    return _ONE_LINE if sources else NOT_OF_RUNS


def _to_compute_with(value: float, spread: float, unit: Shown) -> Cell:
    """Return a coefficient of seven digits and its uncertainty of two."""
    if not np.isfinite(value):
        return Cell(NOT_GIVEN, is_number=True)
    half = f" ± {number_text(spread * unit.factor, 2)}" if np.isfinite(spread) else ""
    text = f"{number_text(value * unit.factor, 7)}{half}"
    return Cell(text, repr(value), is_number=True)


def _squared(unit: str) -> str:
    return unit if unit == "1" else f"({unit})²" if " " in unit or "/" in unit else f"{unit}²"
