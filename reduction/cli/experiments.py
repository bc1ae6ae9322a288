"""Implements the commands experiment and surface."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from rich.markup import escape

from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.csv_columns import csv_text
from reduction.campaign.experiment_plans import ExperimentSpec, RunSeries, load_spec, read_runs
from reduction.campaign.toml_file import at_place
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain, short, table_of
from reduction.experiments.designs import Design, DesignKind, box_behnken, plackett_burman
from reduction.experiments.fit_results import (
    FIT_REASONS,
    LACK_OF_FIT_REASONS,
    STATIONARY_KINDS,
    STATIONARY_REASONS,
    ResponseSurfaces,
)
from reduction.experiments.response_surfaces import OBJECTS, fit_surfaces, scatter_by_scale
from reduction.experiments.response_transform import Transform, fitted_unit
from reduction.experiments.run_sheet import (
    SIGNIFICANCE,
    Caution,
    ExpectedPrecision,
    RunSheet,
    expected_precision,
    find_cautions,
    make_run_sheet,
    order_cautions,
    smallest_effect,
)
from reduction.experiments.screening import (
    ScreeningEffects,
    alias_matrix,
    screening_effects,
    screening_remarks,
)
from reduction.experiments.surface_warnings import (
    Drift,
    drift_over_order,
    drifting_responses,
    negative_surfaces,
    outlying_runs,
)
from reduction.quantities.units import UnitSystem, combined_unit, display_unit
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note
from reduction.uncertainty.surface_errors import surfaces_between_runs

_EXACT = 1e-9


class _ShownUnits:
    """Display units of a response and of its factors."""

    def __init__(
        self, response: str, transform: str, factors: tuple[str, ...], system: UnitSystem
    ) -> None:
        # a logarithm has no unit to convert
        self.unit, self.scale = display_unit(
            fitted_unit(response, transform), system if transform == "none" else "si"
        )
        self._factors = [display_unit(unit, system) for unit in factors]

    def of_term(self, powers: tuple[int, ...]) -> tuple[str, float]:
        """Unit of a coefficient in engineering units, and its conversion factor."""
        units = [unit for unit, _ in self._factors]
        scales = [scale for _, scale in self._factors]
        scale = math.prod(one**power for one, power in zip(scales, powers, strict=True))
        return combined_unit(self.unit, units, powers), self.scale / scale


def plan_runs(kind: DesignKind, path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Print the run sheet of SPEC.toml, and write it if requested."""
    spec = load_spec(path)
    with at_place(f"{path}: "):
        design = _design(kind, spec)
        sheet = make_run_sheet(
            design,
            tuple(factor.levels for factor in spec.factors if factor.levels is not None),
            rated_break_strength=spec.keys.rated_break_strength,
            repeats=spec.keys.repeats,
        )
        cautions = find_cautions(
            sheet, load_limit=spec.keys.load_limit[0], peak_share_limit=spec.keys.load_limit[1]
        )
        precision = _precision(design, sheet, spec)
    if out is not None:
        write_text_atomically(out, _csv(design, sheet, spec))
    _show_sheet(sheet, spec, output)
    for caution in cautions:
        output.say(f"caution: {caution.message}. {caution.hint}")
    if precision is not None:
        _show_precision(precision, spec, output)
    if out is not None:
        output.say(f"run sheet: {out}")
    output.answer(_document(kind, design, sheet, spec, cautions, precision, out))


def _design(kind: DesignKind, spec: ExperimentSpec) -> Design:
    if spec.keys.kind not in (None, kind):
        raise SettingsError(
            "the design in the file differs from the command", found=f'kind = "{spec.keys.kind}"',
            needed=kind,
        )  # fmt: skip
    if not spec.factors:
        raise SettingsError(
            "there are no factors", needed='[factors] with frequency = ["0.1 Hz", "0.5 Hz"]'
        )
    if kind == "box-behnken":
        if spec.keys.n_runs is not None:
            raise SettingsError(
                "experiment.n_runs applies only to plackett-burman", needed="n_centre, or nothing"
            )
        return box_behnken(len(spec.factors), n_centre=spec.keys.n_centre)
    if spec.keys.n_centre is not None:
        raise SettingsError(
            "experiment.n_centre applies only to box-behnken", needed="n_runs, or nothing",
            hint="A design with two levels has no centre.",
        )  # fmt: skip
    return plackett_burman(len(spec.factors), n_runs=spec.keys.n_runs)


def _precision(
    design: Design, sheet: RunSheet, spec: ExperimentSpec
) -> ExpectedPrecision | float | None:
    """Half-widths of a surface, or the smallest significant effect of a screening."""
    sigma, _ = spec.keys.sigma
    if sigma is None:
        return None
    if design.kind == "plackett-burman":
        return float(smallest_effect(design, sigma=sigma))
    return expected_precision(sheet.coded, sigma=sigma, factor_names=sheet.names)


def _level_units(spec: ExperimentSpec) -> tuple[str, ...]:
    """SI units of the levels on the sheet, on which shares are converted to forces."""
    return tuple(
        factor.si_unit if factor.levels and factor.levels.basis == "absolute" else "N"
        for factor in spec.factors
    )


def _loads(sheet: RunSheet) -> dict[str, tuple[np.ndarray[Any, Any], str]]:
    """Known loads of each run, with their units."""
    columns = {
        "peak_tension": (sheet.peak_tension, "N"),
        "minimum_tension": (sheet.minimum_tension, "N"),
        "peak_share": (sheet.peak_share, "1"),
        "minimum_share": (sheet.minimum_share, "1"),
    }
    return {name: entry for name, entry in columns.items() if np.isfinite(entry[0]).all()}


def _csv(design: Design, sheet: RunSheet, spec: ExperimentSpec) -> str:
    """The sheet as a form: levels in SI, and an empty column for each response."""
    loads = _loads(sheet)
    header = [
        "run_order", "run", *(f"{name} [coded]" for name in sheet.names),
        *(f"dummy_{number + 1}" for number in range(design.dummy.shape[1])),
        *(f"{name} [{unit}]" for name, unit in zip(sheet.names, _level_units(spec), strict=True)),
        *(f"{name} [{unit}]" for name, (_, unit) in loads.items()),
        *(f"{entry.name} [{entry.unit}]" if entry.unit else entry.name for entry in spec.responses),
    ]  # fmt: skip
    numbers = np.column_stack(
        [
            sheet.coded,
            design.dummy[sheet.run - 1],
            sheet.engineering,
            *(values for values, _ in loads.values()),
        ]
    )
    # 0.1 from a mean and a half-range becomes 0.09999999999999998
    rounded = [[float(f"{value:.12g}") for value in row] for row in numbers.tolist()]
    blank = [None] * len(spec.responses)
    return csv_text(
        header,
        ([place + 1, int(sheet.run[place]), *row, *blank] for place, row in enumerate(rounded)),
    )


def _show_sheet(sheet: RunSheet, spec: ExperimentSpec, output: CommandOutput) -> None:
    columns = [
        (name, *output.unit(unit), sheet.engineering[:, place])
        for place, (name, unit) in enumerate(zip(sheet.names, _level_units(spec), strict=True))
    ]
    columns += [
        (name, "%RBS", 100.0, values) if unit == "1" else (name, *output.unit(unit), values)
        for name, (values, unit) in _loads(sheet).items()
        if name != "minimum_share"  # omitted for lack of room in a terminal; it is in the file
    ]
    # words of a name are stacked, so that seven factors fit side by side
    headings = [f"{name.replace('_', chr(10))}\n[{unit}]" for name, unit, _, _ in columns]
    table = table_of("order", "run", "coded", *headings, texts=0)
    for place, run in enumerate(sheet.run):
        coded = " ".join(f"{level:+.0f}" if level else " 0" for level in sheet.coded[place])
        numbers = (short(scale * values[place]) for _, _, scale, values in columns)
        table.add_row(str(place + 1), str(run), coded, *numbers)
    output.show(table)


def _show_precision(
    precision: ExpectedPrecision | float,
    spec: ExperimentSpec,
    output: CommandOutput,
) -> None:
    one, si_unit = spec.keys.sigma
    unit, scale = ("%", 100.0) if si_unit == "1" else output.unit(si_unit)
    sigma = f"{short(scale * (one or 0.0))} {unit}"
    if isinstance(precision, float):
        output.say(
            f"expected with sigma {sigma}: effects above {short(scale * precision)} {unit} are "
            "significant (90 %)"
        )
        return
    output.say(
        f"expected with sigma {sigma}: half widths of {100 * CONFIDENCE:g} % intervals, "
        f"{precision.degrees_of_freedom} degrees of freedom [{unit}]"
    )
    table = table_of("term", "half width")
    for term, width in zip(precision.terms, precision.term_half_width, strict=True):
        table.add_row(escape(term), short(scale * width, 3))
    output.show(table)
    table = table_of("surface at", "coded", "half width", "of one more run", texts=2)
    for kind, place in _kinds(precision).items():
        point = " ".join(f"{level:+.0f}" if level else " 0" for level in precision.points[place])
        table.add_row(
            kind, point, short(scale * precision.confidence_half_width[place], 3),
            short(scale * precision.prediction_half_width[place], 3),
        )  # fmt: skip
    output.show(table)


def _kinds(precision: ExpectedPrecision) -> dict[str, int]:
    """The worst point of each kind, with the most precise kind first."""
    factor, worst = precision.point_variance_factor, dict[str, int]()
    for kind in dict.fromkeys(precision.point_kind):
        places = np.flatnonzero([one == kind for one in precision.point_kind])
        # corners are equal except for rounding, which depends on the processor
        is_worst = factor[places] >= (1 - _EXACT) * factor[places].max()
        place = int(places[is_worst.argmax()])
        beyond = " (beyond the runs)" if precision.is_beyond_design[place] else ""
        worst[kind + beyond] = place
    return dict(sorted(worst.items(), key=lambda one: float(factor[one[1]])))


def _document(
    kind: DesignKind,
    design: Design,
    sheet: RunSheet,
    spec: ExperimentSpec,
    cautions: tuple[Caution, ...],
    precision: ExpectedPrecision | float | None,
    out: Path | None,
) -> dict[str, Any]:
    units = _level_units(spec)
    loads = _loads(sheet)
    runs = [
        {
            "run_order": place + 1,
            "run": int(run),
            "load_block": int(sheet.load_block[place]) or None,
            "coded": plain(sheet.coded[place]),
            "dummy": plain(design.dummy[run - 1]),
            "levels": plain(sheet.engineering[place]),
            **{name: plain(values[place]) for name, (values, _) in loads.items()},
        }
        for place, run in enumerate(sheet.run)
    ]
    expected: dict[str, Any] | None = None
    if precision is not None:
        expected = dict(zip(("sigma", "unit"), spec.keys.sigma, strict=True))
    if isinstance(precision, float) and expected is not None:
        expected |= {"smallest_significant_effect": precision, "significance": 0.10}
    elif isinstance(precision, ExpectedPrecision) and expected is not None:
        expected |= {
            "confidence": CONFIDENCE,
            "degrees_of_freedom": precision.degrees_of_freedom,
            "terms": list(precision.terms),
            "term_half_width": plain(precision.term_half_width),
            "points": plain(precision.points),
            "point_kind": list(precision.point_kind),
            "confidence_half_width": plain(precision.confidence_half_width),
            "prediction_half_width": plain(precision.prediction_half_width),
            "is_beyond_design": plain(precision.is_beyond_design),
        }
    return {
        "kind": kind,
        "factors": [
            dict(
                zip(
                    ("unit", "low", "high"),
                    factor.axis(spec.keys.rated_break_strength),
                    strict=True,
                ),
                name=factor.name,
                level_unit=unit,
            )
            for factor, unit in zip(spec.factors, units, strict=True)
        ],
        "runs": runs,
        "units": {name: unit for name, (_, unit) in loads.items()},
        "cautions": [
            {"kind": one.kind, "message": one.message, "hint": one.hint, "runs": list(one.runs)}
            for one in cautions
        ],
        "expected_precision": expected,
        "out": None if out is None else str(out),
    }


def _frame(runs: RunSeries, notes: tuple[str, ...]) -> dict[str, Any]:
    """Common part of the output for surfaces and for effects."""
    return {
        "n_runs": len(runs.row),
        "factors": [
            {"name": name, "unit": unit, "low": low, "high": high}
            for name, unit, low, high in zip(
                runs.factor_names, runs.factor_units, runs.low.tolist(), runs.high.tolist(),
                strict=True,
            )
        ],
        "notes": list(notes),
    }  # fmt: skip


def _surface_document(
    surfaces: ResponseSurfaces, index: int, runs: RunSeries, drift: Drift
) -> dict[str, Any]:
    """All numbers of the surface for one response."""
    anova, lack, canonical = surfaces.anova, surfaces.lack_of_fit, surfaces.canonical
    unit = fitted_unit(runs.response_units[index], surfaces.transform[index])
    lines = zip(
        anova.source, anova.degrees_of_freedom[index], anova.sum_of_squares[index],
        anova.mean_square[index], anova.f[index], anova.p_value[index], anova.error_term,
        strict=True,
    )  # fmt: skip
    reason = int(surfaces.reason[index])
    diagnostics, blocks = surfaces.diagnostics, surfaces.blocks
    between = surfaces_between_runs(surfaces)
    return {
        "unit": runs.response_units[index] or None,
        "transform": surfaces.transform[index],
        "transform_exponent": plain(surfaces.transform_exponent[index]),
        "transform_exponent_interval": plain(surfaces.transform_exponent_interval[index]),
        "coefficient_unit": unit or None,
        "labels": list(surfaces.labels),
        "terms": list(surfaces.term_names),
        "coefficient": plain(surfaces.coefficient[index]),
        "standard_error": plain(surfaces.coefficient_standard_uncertainty[index]),
        "t": plain(surfaces.t[index]),
        "p_value": plain(surfaces.p_value[index]),
        "error_term": list(surfaces.error_term),
        "r2": plain(surfaces.r2[index]),
        "adjusted_r2": plain(surfaces.adjusted_r2[index]),
        "predicted_r2": plain(surfaces.predicted_r2[index]),
        "sigma": plain(surfaces.sigma[index]),
        "degrees_of_freedom": int(surfaces.degrees_of_freedom[index]),
        "overall": {
            "f": plain(surfaces.overall_f[index]),
            "p": plain(surfaces.overall_p_value[index]),
            "printed_f": plain(surfaces.printed_f[index]),
        },
        "anova": [
            {
                "source": source, "df": None if np.isnan(df) else int(df), "ss": plain(ss),
                "ms": plain(ms), "f": plain(f), "p": plain(p), "error_term": error_term,
            }
            for source, df, ss, ms, f, p, error_term in lines
        ],
        "lack_of_fit": {
            "df": int(lack.degrees_of_freedom[index]),
            "pure_error_df": int(lack.pure_error_degrees_of_freedom[index]),
            "f": plain(lack.f[index]),
            "p": plain(lack.p_value[index]),
            "reason": LACK_OF_FIT_REASONS[int(lack.reason[index])],
        },
        "stationary_point": {
            "coded": plain(canonical.stationary_point[index]),
            "engineering": plain(canonical.stationary_point_engineering[index]),
            "unit": list(runs.factor_units),
            "coded_standard_error": plain(canonical.stationary_point_standard_uncertainty[index]),
            "value": plain(canonical.stationary_value[index]),
            "kind": STATIONARY_KINDS[int(canonical.kind[index])],
            "inside": bool(canonical.is_inside[index]),
            "reason": STATIONARY_REASONS[int(canonical.reason[index])],
        },
        "eigenvalues": plain(canonical.eigenvalue[index]),
        "eigenvalue_standard_error": plain(canonical.eigenvalue_standard_uncertainty[index]),
        "eigenvectors": plain(canonical.eigenvector[index].T),
        "engineering": {
            "terms": list(surfaces.term_names),
            "coefficient": plain(surfaces.coefficient_engineering[index]),
            "standard_error": plain(surfaces.coefficient_engineering_standard_uncertainty[index]),
            "unit": [
                combined_unit(unit, runs.factor_units, powers.tolist()) if unit else None
                for powers in surfaces.exponents
            ],
        },
        "between_runs": {
            "coded": plain(between.coded),
            "value": plain(between.value[index]),
            "scatter_standard_uncertainty": plain(between.scatter_uncertainty[index]),
            "lack_of_fit_standard_uncertainty": plain(between.discrepancy[index]),
            "low": plain(between.low[index]),
            "high": plain(between.high[index]),
        },
        "drift": {
            "per_run": plain(drift.slope[index]),
            "standard_error": plain(drift.standard_uncertainty[index]),
            "p": plain(drift.p_value[index]),
        },
        "blocks": None if blocks is None else {
            "names": list(blocks.names),
            "treatment": blocks.treatment,
            "effect": plain(blocks.effect[index]),
            "standard_deviation": plain(blocks.standard_deviation[index]),
        },
        "runs": {
            "name": list(surfaces.run_names),
            "coded": plain(surfaces.coded),
            "fitted": plain(surfaces.fitted[index]),
            "residual": plain(surfaces.residual[index]),
            "leverage": plain(diagnostics.leverage[index]),
            "cooks_distance": plain(diagnostics.cooks_distance[index]),
            "deleted_residual": plain(diagnostics.deleted_residual[index]),
        },
        "reason": FIT_REASONS[reason],
    }  # fmt: skip


def _effects_document(effects: ScreeningEffects, runs: RunSeries) -> dict[str, Any]:
    """Effects on every response, and their aliases."""
    pairs, alias = alias_matrix(np.where(runs.coded < 0, -1.0, 1.0))
    names = effects.names
    documents = {
        name: {
            "unit": runs.response_units[index] or None,
            "terms": list(names),
            "effect": plain(effects.effect[index]),
            "dummy_effect": plain(effects.dummy_effect[index]),
            "mean": plain(effects.mean[index]),
            "standard_error": plain(effects.effect_standard_error[index]),
            "t": plain(effects.t_value[index]),
            "p_value": plain(effects.p_value[index]),
            "minimum_significant_effect": plain(effects.minimum_significant_effect[index]),
            "simultaneous_minimum_effect": plain(effects.simultaneous_minimum_effect[index]),
            "is_significant": plain(effects.is_significant[index]),
            "reason": str(effects.reason[index]),
        }
        for index, name in enumerate(runs.response_names)
    }
    return {
        "fit": "effects",
        "error_from": effects.error_from,
        "degrees_of_freedom": effects.degrees_of_freedom,
        "significance": SIGNIFICANCE,
        "responses": documents,
        "aliases": {
            name: {
                f"{names[one]}*{names[other]}": value
                for (one, other), value in zip(
                    pairs, alias[place + 1].round(12).tolist(), strict=True
                )
                if value
            }
            for place, name in enumerate(names)
        },
    }


def _show_surfaces(
    surfaces: ResponseSurfaces,
    runs: RunSeries,
    notes: tuple[str, ...],
    output: CommandOutput,
) -> None:
    """Print each surface: its terms, analysis of variance and stationary point."""
    wrong = tuple(map(str, outlying_runs(surfaces)))
    output.say_each("warning", wrong)
    within = "" if surfaces.blocks is None else " within blocks"
    for index, name in enumerate(surfaces.response_names):
        transform = surfaces.transform[index]
        shown = _ShownUnits(runs.response_units[index], transform, runs.factor_units, output.system)
        power = f", Box-Cox exponent {surfaces.transform_exponent[index]:.3g}"
        unit = f" [{shown.unit}]" if shown.unit else f" ({transform})" * (transform != "none")
        output.say(f"{name}{unit}{power if transform == 'box-cox' else ''}")
        if surfaces.reason[index] in (1, 2):
            output.say(f"  {FIT_REASONS[int(surfaces.reason[index])]}")
            continue
        _show_terms(surfaces, index, shown.scale, output)
        output.say(
            f"r2{within} {short(surfaces.r2[index])}, adjusted"
            f" {short(surfaces.adjusted_r2[index])}, predicted"
            f" {short(surfaces.predicted_r2[index])}; F {short(surfaces.overall_f[index])}, p"
            f" {short(surfaces.overall_p_value[index], 3)}"
        )
        output.say(
            f"sigma {short(shown.scale * surfaces.sigma[index])} with"
            f" {surfaces.degrees_of_freedom[index]} degrees of freedom"
        )
        _show_anova(surfaces, index, shown.scale, output)
        _show_between_runs(surfaces, index, output)
        _show_stationary(surfaces, index, shown, runs, output)
        _show_equation(surfaces, index, shown, output)
        output.say("")
    output.say_each("note", (one for one in notes if one not in wrong))


def _show_between_runs(surfaces: ResponseSurfaces, index: int, output: CommandOutput) -> None:
    """Print the possible misfit of a quadratic between levels, not included in standard errors."""
    between = surfaces_between_runs(surfaces)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = between.discrepancy[index] / np.abs(between.value[index])
    if not np.isfinite(share).any():
        return
    output.say(
        "lack of fit between the levels (standard uncertainty, not in the standard errors):"
        f" {100 * np.nanmedian(share):.2g} % of the value at the median,"
        f" {100 * np.nanmax(share):.2g} % at most"
    )


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
    surfaces: ResponseSurfaces, index: int, shown: _ShownUnits, output: CommandOutput
) -> None:
    """Print the equation in the units of the factors, if they have any."""
    engineering = surfaces.coefficient_engineering[index]
    if np.array_equal(surfaces.coefficient[index], engineering):
        return
    errors = surfaces.coefficient_engineering_standard_uncertainty[index]
    n_digits = _digits_of_equation(surfaces, index)
    table = table_of("", "in units", "coefficient", "standard error", "unit", texts=2)
    rows = zip(
        surfaces.labels, surfaces.term_names, engineering, errors, surfaces.exponents, strict=True
    )
    for label, term, coefficient, error, powers in rows:
        unit, scale = shown.of_term(tuple(powers.tolist()))
        table.add_row(
            label, escape(term), short(scale * coefficient, n_digits), short(scale * error),
            escape(unit),
        )  # fmt: skip
    output.show(table)


_FEWEST_DIGITS, _MOST_DIGITS = 8, 15


def _digits_of_equation(surfaces: ResponseSurfaces, index: int) -> int:
    """Digits that give the surface to a hundredth of the uncertainty at the centre.

    Over a range that is small beside its level, such as 1 K at 278 K, the terms are much greater
    than their sum.
    """
    level = np.maximum(np.abs(surfaces.low), np.abs(surfaces.high))
    terms = surfaces.coefficient_engineering[index] * np.prod(level**surfaces.exponents, axis=1)
    close = 0.01 * surfaces.coefficient_standard_uncertainty[index, 0]
    if not close > 0:
        return _FEWEST_DIGITS
    digits = math.ceil(math.log10(max(np.abs(terms).max() / close, 1.0))) + 1
    return min(max(digits, _FEWEST_DIGITS), _MOST_DIGITS)


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
    shown: _ShownUnits,
    runs: RunSeries,
    output: CommandOutput,
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
        text, scale = output.unit(unit)
        table.add_row(escape(name), short(coded), short(scale * engineering), escape(text))
    output.show(table)


def _show_effects(
    effects: ScreeningEffects,
    runs: RunSeries,
    notes: tuple[str, ...],
    output: CommandOutput,
) -> None:
    """Print effects on each response, largest first, and the smallest significant one."""
    for index, name in enumerate(runs.response_names):
        unit, scale = output.unit(runs.response_units[index])
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
            f"significant at {100 * (1 - SIGNIFICANCE):g} %: above"
            f" {short(scale * effects.minimum_significant_effect[index])}, all factors together"
            f" {short(scale * effects.simultaneous_minimum_effect[index])}; standard error by {of}"
            f" {short(scale * effects.effect_standard_error[index])} with"
            f" {short(effects.degrees_of_freedom, 3)} degrees of freedom"
        )
        output.say("")
    output.say_each("note", notes)


_NEAR_A_LEVEL = 0.1
"""Coded distance from -1 or 1 within which a screening level counts as that level."""


def fit_runs(
    path: Path, spec_path: Path | None, *, out: Path | None, output: CommandOutput
) -> None:
    """Fit a table of runs as requested in SPEC.toml and print it; if ``out``, also write it."""
    spec = None if spec_path is None else load_spec(spec_path)
    runs = read_runs(path, spec)
    with at_place(f"{path}: "):
        if spec is not None and spec.keys.kind == "plackett-burman":
            if out is not None:
                raise SettingsError(
                    "effects of a screening are printed alone", found=f"--out {out}",
                    needed="--json, which has all of them",
                )  # fmt: skip
            effects, notes = _screen(runs)
            _show_effects(effects, runs, notes, output)
            output.answer(_frame(runs, notes) | _effects_document(effects, runs))
            return
    surfaces = fit_series(runs, spec, path)
    drift = drift_over_order(surfaces, runs.run_order)
    notes = notes_of_fit(runs, surfaces)
    _show_surfaces(surfaces, runs, notes, output)
    documents = {
        name: _surface_document(surfaces, index, runs, drift)
        for index, name in enumerate(surfaces.response_names)
    }
    files: list[Path] = []
    if out is not None:
        # imports the page, which output to the screen does not need
        from reduction.report.surface_page import write_surfaces

        files = write_surfaces(
            surfaces, runs, out, name=path.stem, notes=notes, units=output.system
        )
        for one in files:
            output.say(f"written: {one}")
    output.answer(
        _frame(runs, notes)
        | {"fit": "quadratic", "responses": documents, "files": [str(one) for one in files]}
    )


def notes_of_fit(runs: RunSeries, surfaces: ResponseSurfaces) -> tuple[str, ...]:
    """Notes for the user of surfaces."""
    drift = drift_over_order(surfaces, runs.run_order)
    return (
        *runs.notes,
        *map(str, surfaces.notes),
        *_unstated(runs),
        *map(str, _rejected_scales(runs, surfaces)),
        *map(str, negative_surfaces(surfaces)),
        *map(str, outlying_runs(surfaces)),
        *map(str, drifting_responses(surfaces, drift)),
        *(
            f"{one.message}. {one.hint}"
            for one in order_cautions(runs.coded, runs.run_order, runs.factor_names)
        ),
    )


_OTHER_SCALE = {"none": ("log", "its logarithm"), "log": ("none", "the response as measured")}


def _rejected_scales(runs: RunSeries, surfaces: ResponseSurfaces) -> list[Note]:
    """Responses that would scatter significantly less about a surface on the other scale."""
    rows = [
        row
        for row, scale in enumerate(surfaces.transform)
        if scale in _OTHER_SCALE and not np.any(runs.responses[row] <= 0)
    ]
    if not rows:
        return []

    def fit(values: Floats, names: list[str], transforms: list[Transform]) -> ResponseSurfaces:
        return fit_surfaces(
            runs.coded, values, factor_names=runs.factor_names, response_names=names,
            low=runs.low, high=runs.high, units="coded", run_names=runs.run_names,
            blocks=runs.blocks, transforms=transforms, with_tests=False,
        )  # fmt: skip

    found = []
    ratios, chances = scatter_by_scale(runs.responses[rows], fit)
    for row, ratio, p in zip(rows, ratios.tolist(), chances.tolist(), strict=True):
        key, scale = _OTHER_SCALE[surfaces.transform[row]]
        own = ratio if key == "none" else 1 / ratio
        if p < OBJECTS and own > 1:
            name = surfaces.response_names[row]
            found.append(
                note("scale-rejected", response=name, scale=scale, key=key, ratio=own, p=p)
            )
    return found


def fit_series(runs: RunSeries, spec: ExperimentSpec | None, path: Path) -> ResponseSurfaces:
    """Quadratic surfaces for a table of runs; errors name its file."""
    with at_place(f"{path}: "):
        return _fit(runs, spec)


def _fit(runs: RunSeries, spec: ExperimentSpec | None) -> ResponseSurfaces:
    levels = [np.unique(column[np.isfinite(column)].round(6)).size for column in runs.coded.T]
    if set(levels) == {2}:
        raise FitError(
            "two levels per factor cannot determine squares",
            needed="three levels, or a screening",
            hint='kind = "plackett-burman" under [experiment] of a SPEC.toml gives the effects.',
        )
    declared = () if spec is None else spec.responses
    return fit_surfaces(
        runs.coded,
        runs.responses,
        factor_names=runs.factor_names,
        response_names=runs.response_names,
        low=runs.low,
        high=runs.high,
        units="coded",
        run_names=runs.run_names,
        blocks=runs.blocks,
        block_treatment="random" if spec and spec.keys.specimens_as == "random" else "fixed",
        transforms=[entry.transform for entry in declared] or "none",
    )


def _screen(runs: RunSeries) -> tuple[ScreeningEffects, tuple[str, ...]]:
    notes = [*runs.notes, *_unstated(runs)]
    near = np.where(runs.coded < 0, -1.0, 1.0)
    away = np.abs(runs.coded - near)
    if not (away <= _NEAR_A_LEVEL).all():
        run, factor = np.argwhere(~(away <= _NEAR_A_LEVEL))[0].tolist()
        raise DataError(
            f"row {runs.row[run]}: a level of {runs.factor_names[factor]} is neither low nor high",
            found=f"{runs.coded[run, factor]:.4g} coded",
            needed="-1 or 1, as in a two-level screening",
        )
    if away.max() > _EXACT:
        notes.append(f"levels up to {away.max():.2g} coded off the plan count as those of the plan")
    notes += map(str, screening_remarks(runs.dummy.shape[1], runs.blocks is not None))
    design = Design("plackett-burman", near, runs.dummy)
    return screening_effects(design, runs.responses, names=runs.factor_names), tuple(notes)


def _unstated(runs: RunSeries) -> list[str]:
    bare = [
        name
        for name, unit in zip(runs.response_names, runs.response_units, strict=True)
        if not unit
    ]
    return [f"without a unit, numbers as in the table: {', '.join(bare)}"] if bare else []
