"""Surfaces and effects as tables on a terminal."""

from __future__ import annotations

import numpy as np
from rich.markup import escape

from reduction.campaign.runtable import RunSeries
from reduction.cli.numbers import Shown, short, table_of
from reduction.cli.outcome import Outcome
from reduction.surface.product import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.surface.screening import ScreeningEffects
from reduction.units import UnitSystem, display_unit

__all__ = ["show_effects", "show_surfaces"]


def show_surfaces(
    surfaces: ResponseSurfaces,
    runs: RunSeries,
    notes: tuple[str, ...],
    outcome: Outcome,
    system: UnitSystem,
) -> None:
    """Each surface: its terms, its analysis of variance, its stationary point."""
    for index, name in enumerate(surfaces.response_names):
        scale = surfaces.transform[index]
        # another scale has no unit that could be changed
        shown = Shown(
            runs.response_units[index], runs.factor_units, system if scale == "none" else "si"
        )
        unit = f" [{shown.unit}]" if shown.unit else ""
        of = {"none": "", "log": "ln of "}.get(
            scale, f"Box-Cox transform ({surfaces.transform_exponent[index]:.3g}) of "
        )
        outcome.say(f"{of}{name}{unit}")
        if surfaces.reason[index] in (1, 2):
            outcome.say(f"  {FIT_REASONS[int(surfaces.reason[index])]}")
            continue
        _show_terms(surfaces, index, shown, outcome)
        outcome.say(
            f"r2 {short(surfaces.r2[index])}, adjusted {short(surfaces.adjusted_r2[index])}, "
            f"predicted {short(surfaces.predicted_r2[index])}; "
            f"sigma {short(shown.scale * surfaces.sigma[index])} with "
            f"{surfaces.degrees_of_freedom[index]} degrees of freedom; "
            f"F {short(surfaces.overall_f[index])}, p {short(surfaces.overall_p_value[index], 3)}"
        )
        _show_anova(surfaces, index, shown.scale, outcome)
        _say_stationary(surfaces, index, shown, runs, outcome, system)
        outcome.say("")
    for note in notes:
        outcome.say(f"note: {note}")


def _show_terms(surfaces: ResponseSurfaces, index: int, shown: Shown, outcome: Outcome) -> None:
    # coded factors without units of their own have one equation
    has_units = not np.array_equal(surfaces.coefficient, surfaces.coefficient_engineering)
    in_units = ("in units", "unit") if has_units else ()
    table = table_of("", "term", "coefficient", "standard error", "t", "p", *in_units, texts=2)
    rows = zip(
        surfaces.labels, surfaces.term_names, surfaces.coefficient[index],
        surfaces.coefficient_standard_uncertainty[index], surfaces.t[index],
        surfaces.p_value[index], surfaces.coefficient_engineering[index], surfaces.exponents,
        strict=True,
    )  # fmt: skip
    for label, term, coefficient, error, t, p, engineering, powers in rows:
        unit, scale = shown.of_term(tuple(powers.tolist()))
        table.add_row(
            label, escape(term), short(shown.scale * coefficient), short(shown.scale * error),
            short(t, 4), short(p, 3),
            *((short(scale * engineering), escape(unit)) if has_units else ()),
        )  # fmt: skip
    outcome.show(table)


def _show_anova(surfaces: ResponseSurfaces, index: int, scale: float, outcome: Outcome) -> None:
    anova = surfaces.anova
    table = table_of("source", "df", "sum of squares", "mean square", "F", "p")
    rows = zip(
        anova.source, anova.degrees_of_freedom[index], anova.sum_of_squares[index],
        anova.mean_square[index], anova.f[index], anova.p_value[index], strict=True,
    )  # fmt: skip
    for source, df, squares, mean, f, p in rows:
        table.add_row(
            source, short(df), short(scale**2 * squares), short(scale**2 * mean), short(f, 4),
            short(p, 3),
        )  # fmt: skip
    outcome.show(table)
    reason = LACK_OF_FIT_REASONS[int(surfaces.lack_of_fit.reason[index])]
    if reason:
        outcome.say(f"no test of lack of fit: {reason}")


def _say_stationary(
    surfaces: ResponseSurfaces,
    index: int,
    shown: Shown,
    runs: RunSeries,
    outcome: Outcome,
    system: UnitSystem,
) -> None:
    canonical = surfaces.canonical
    reason = STATIONARY_REASONS[int(canonical.reason[index])]
    if reason:
        outcome.say(f"no stationary point: {reason}")
        return
    places = []
    for name, unit, coded, engineering in zip(
        runs.factor_names, runs.factor_units, canonical.stationary_point[index],
        canonical.stationary_point_engineering[index], strict=True,
    ):  # fmt: skip
        text, scale = display_unit(unit, system)
        own = f" = {short(scale * engineering)} {text}" if unit != "1" else ""
        places.append(f"{name} {short(coded, 4)}{own}")
    inside = "among" if canonical.is_inside[index] else "outside"
    eigenvalues = ", ".join(short(shown.scale * value) for value in canonical.eigenvalue[index])
    outcome.say(
        f"{STATIONARY_KINDS[int(canonical.kind[index])]} {inside} the levels, value "
        f"{short(shown.scale * canonical.stationary_value[index])}: {', '.join(places)}"
    )
    outcome.say(f"eigenvalues {eigenvalues}")


def show_effects(
    effects: ScreeningEffects,
    runs: RunSeries,
    notes: tuple[str, ...],
    outcome: Outcome,
    system: UnitSystem,
) -> None:
    """Effects of each response, largest first, and the smallest that counts."""
    for index, name in enumerate(runs.response_names):
        unit, scale = display_unit(runs.response_units[index], system)
        outcome.say(f"{name} [{unit}]" if unit else name)
        if effects.reason[index]:
            outcome.say(f"  {effects.reason[index]}")
        table = table_of("factor", "effect", "t", "p", "significant")
        order = sorted(
            range(len(effects.names)), key=lambda place: -abs(effects.effect[index, place])
        )
        for place in order:
            table.add_row(
                escape(effects.names[place]), short(scale * effects.effect[index, place]),
                short(effects.t_value[index, place], 4), short(effects.p_value[index, place], 3),
                "yes" if effects.is_significant[index, place] else "no",
            )  # fmt: skip
        outcome.show(table)
        of = "the dummies" if effects.error_from == "dummy" else "Lenth"
        outcome.say(
            f"significant at {100 * (1 - effects.significance):g} %: above "
            f"{short(scale * effects.minimum_significant_effect[index])}, all factors together "
            f"{short(scale * effects.simultaneous_minimum_effect[index])}; standard error by {of} "
            f"{short(scale * effects.effect_standard_error[index])} with "
            f"{short(effects.degrees_of_freedom, 3)} degrees of freedom"
        )
        outcome.say("")
    for note in notes:
        outcome.say(f"note: {note}")
