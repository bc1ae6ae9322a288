"""Surfaces and effects as tables on a terminal."""

from __future__ import annotations

import numpy as np
from rich.markup import escape

from reduction.campaign.runtable import RunSeries
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import Shown, short, table_of
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.product import (
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.surface.screening import ScreeningEffects
from reduction.units import UnitSystem, display_unit


def show_surfaces(
    surfaces: ResponseSurfaces,
    runs: RunSeries,
    notes: tuple[str, ...],
    output: CommandOutput,
    system: UnitSystem,
) -> None:
    """Each surface: its terms, its analysis of variance, its stationary point."""
    for index, name in enumerate(surfaces.response_names):
        transform = surfaces.transform[index]
        shown = Shown(runs.response_units[index], transform, runs.factor_units, system)
        power = f", Box-Cox exponent {surfaces.transform_exponent[index]:.3g}"
        unit = f" [{shown.unit}]" if shown.unit else f" ({transform})" * (transform != "none")
        output.say(f"{name}{unit}{power if transform == 'box-cox' else ''}")
        if surfaces.reason[index] in (1, 2):
            output.say(f"  {FIT_REASONS[int(surfaces.reason[index])]}")
            continue
        _show_terms(surfaces, index, shown.scale, output)
        output.say(
            f"r2 {short(surfaces.r2[index])}, adjusted {short(surfaces.adjusted_r2[index])}, "
            f"predicted {short(surfaces.predicted_r2[index])}; "
            f"F {short(surfaces.overall_f[index])}, p {short(surfaces.overall_p_value[index], 3)}"
        )
        output.say(
            f"sigma {short(shown.scale * surfaces.sigma[index])} with "
            f"{surfaces.degrees_of_freedom[index]} degrees of freedom"
        )
        _show_anova(surfaces, index, shown.scale, output)
        _show_stationary(surfaces, index, shown, runs, output, system)
        _show_equation(surfaces, index, shown, output)
        output.say("")
    for note in notes:
        output.say(f"note: {note}")


def _show_terms(
    surfaces: ResponseSurfaces, index: int, scale: float, output: CommandOutput
) -> None:
    table = table_of("", "term", "coefficient", "standard error", "t", "p", texts=2)
    rows = zip(
        surfaces.labels, surfaces.term_names, surfaces.coefficient[index],
        surfaces.coefficient_standard_uncertainty[index], surfaces.t[index],
        surfaces.p_value[index], strict=True,
    )  # fmt: skip
    for label, term, coefficient, error, t, p in rows:
        table.add_row(
            label, escape(term), short(scale * coefficient), short(scale * error), short(t, 4),
            short(p, 3),
        )  # fmt: skip
    output.show(table)


def _show_equation(
    surfaces: ResponseSurfaces, index: int, shown: Shown, output: CommandOutput
) -> None:
    """The equation in the units of the factors, where they have any."""
    engineering = surfaces.coefficient_engineering[index]
    if np.array_equal(surfaces.coefficient[index], engineering):
        return
    errors = surfaces.coefficient_engineering_standard_uncertainty[index]
    table = table_of("", "in units", "coefficient", "standard error", "unit", texts=2)
    rows = zip(
        surfaces.labels, surfaces.term_names, engineering, errors, surfaces.exponents, strict=True
    )
    for label, term, coefficient, error, powers in rows:
        unit, scale = shown.of_term(tuple(powers.tolist()))
        table.add_row(
            label, escape(term), short(scale * coefficient, 8), short(scale * error),
            escape(unit),
        )  # fmt: skip
    output.show(table)


def _show_anova(
    surfaces: ResponseSurfaces, index: int, scale: float, output: CommandOutput
) -> None:
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
    output.show(table)
    reason = LACK_OF_FIT_REASONS[int(surfaces.lack_of_fit.reason[index])]
    if reason:
        output.say(f"no test of lack of fit: {reason}")


def _show_stationary(
    surfaces: ResponseSurfaces,
    index: int,
    shown: Shown,
    runs: RunSeries,
    output: CommandOutput,
    system: UnitSystem,
) -> None:
    canonical = surfaces.canonical
    reason = STATIONARY_REASONS[int(canonical.reason[index])]
    if reason:
        output.say(f"no stationary point: {reason}")
        return
    inside = "among" if canonical.is_inside[index] else "outside"
    eigenvalues = ", ".join(short(shown.scale * value) for value in canonical.eigenvalue[index])
    output.say(
        f"{STATIONARY_KINDS[int(canonical.kind[index])]} {inside} the levels, value "
        f"{short(shown.scale * canonical.stationary_value[index])}; eigenvalues {eigenvalues}"
    )
    table = table_of("stationary point", "coded", "in units", "unit")
    for name, unit, coded, engineering in zip(
        runs.factor_names, runs.factor_units, canonical.stationary_point[index],
        canonical.stationary_point_engineering[index], strict=True,
    ):  # fmt: skip
        text, scale = display_unit(unit, system)
        table.add_row(escape(name), short(coded), short(scale * engineering), escape(text))
    output.show(table)


def show_effects(
    effects: ScreeningEffects,
    runs: RunSeries,
    notes: tuple[str, ...],
    output: CommandOutput,
    system: UnitSystem,
) -> None:
    """Effects of each response, largest first, and the smallest that counts."""
    for index, name in enumerate(runs.response_names):
        unit, scale = display_unit(runs.response_units[index], system)
        output.say(f"{name} [{unit}]" if unit else name)
        if effects.reason[index]:
            output.say(f"  {effects.reason[index]}")
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
        output.show(table)
        of = "the dummies" if effects.error_from == "dummy" else "Lenth"
        output.say(
            f"significant at {100 * (1 - effects.significance):g} %: above "
            f"{short(scale * effects.minimum_significant_effect[index])}, all factors together "
            f"{short(scale * effects.simultaneous_minimum_effect[index])}; standard error by {of} "
            f"{short(scale * effects.effect_standard_error[index])} with "
            f"{short(effects.degrees_of_freedom, 3)} degrees of freedom"
        )
        output.say("")
    for note in notes:
        output.say(f"note: {note}")
