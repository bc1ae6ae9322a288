"""Page and tables of response surfaces fitted to a table of runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.csv_columns import Cell, csv_text
from reduction.campaign.experiment_plans import RunSeries
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_transform import fitted_unit
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.quantities.units import UnitSystem, combined_unit, display_unit
from reduction.record.measurement import Floats
from reduction.report.figure_data import Figure, Trace, axis, line, make_figure, plain_numbers
from reduction.report.single_pages import write_single_page
from reduction.report.test_section import Part, make_part
from reduction.report.text_style import (
    COLOURS,
    PageTable,
    TableCell,
    count,
    make_table,
    number,
    words,
)

_POINTS = 31

_HELD = (-1.0, 0.0, 1.0)

_ABOUT = (
    "Quadratic surfaces by least squares over levels coded -1 to 1 (CG-D-39-80, eq. 5, App. C)."
)


def write_surfaces(
    surfaces: ResponseSurfaces,
    runs: RunSeries,
    out: Path,
    *,
    name: str,
    notes: Sequence[str],
    units: UnitSystem = "si",
) -> list[Path]:
    """Write coefficients, analysis of variance and runs as tables, in SI, and a page."""
    tables = {
        "coefficients": _coefficients(surfaces, runs),
        "anova": _anova(surfaces),
        "runs": _runs(surfaces, runs),
    }
    written = []
    for stem, text in tables.items():
        written.append(out / "tables" / f"{stem}.csv")
        write_text_atomically(written[-1], text)
    parts = [
        part
        for index in range(len(surfaces.response_names))
        if (part := _part(surfaces, runs, index, units)) is not None
    ]
    page = write_single_page(
        out, f"Response surfaces of {name}", "surfaces", parts, answer=None, tiles=(),
        notes=notes, units=units, about=_ABOUT, made_from="a table of runs",
        subtitle=f"{len(surfaces.run_names)} runs.",
    )  # fmt: skip
    return [*written, page]


def _coefficients(surfaces: ResponseSurfaces, runs: RunSeries) -> str:
    head = (
        "response", "transform", "label", "term", "coefficient", "standard_error", "t", "p_value",
        "coefficient_engineering", "standard_error_engineering", "unit", "unit_engineering",
    )  # fmt: skip
    rows: list[list[Cell]] = []
    for index, name in enumerate(surfaces.response_names):
        numbers = (
            surfaces.coefficient[index], surfaces.coefficient_standard_uncertainty[index],
            surfaces.t[index], surfaces.p_value[index], surfaces.coefficient_engineering[index],
            surfaces.coefficient_engineering_standard_uncertainty[index],
        )  # fmt: skip
        transform = surfaces.transform[index]
        unit = fitted_unit(runs.response_units[index], transform)
        for place, (label, term) in enumerate(
            zip(surfaces.labels, surfaces.term_names, strict=True)
        ):
            own: list[Cell] = [_known(float(one[place])) for one in numbers]
            powers = surfaces.exponents[place].tolist()
            of_term = combined_unit(unit, runs.factor_units, powers) if unit else ""
            rows.append([name, transform, label, term, *own, unit, of_term])
    return csv_text(head, rows)


def _anova(surfaces: ResponseSurfaces) -> str:
    anova = surfaces.anova
    head = ("response", "source", "degrees_of_freedom", "sum_of_squares", "mean_square", "f",
            "p_value")  # fmt: skip
    rows: list[list[Cell]] = [
        [name, source, *(_known(float(one[index][place])) for one in _columns(anova))]
        for index, name in enumerate(surfaces.response_names)
        for place, source in enumerate(anova.source)
    ]
    return csv_text(head, rows)


def _columns(anova: object) -> tuple[Floats, ...]:
    names = ("degrees_of_freedom", "sum_of_squares", "mean_square", "f", "p_value")
    return tuple(getattr(anova, one) for one in names)


def _runs(surfaces: ResponseSurfaces, runs: RunSeries) -> str:
    factors = [f"{name} [coded]" for name in runs.factor_names]
    head = ["run", *factors]
    for name, unit, transform in zip(
        runs.response_names, runs.response_units, surfaces.transform, strict=True
    ):
        head.append(f"{name} [{unit}]" if unit else name)
        scale = f" [{fitted_unit(unit, transform)}]" if unit else ""
        head += [f"{name} fitted{scale}", f"{name} residual{scale}"]
    rows: list[list[Cell]] = []
    for place, run in enumerate(runs.run_names):
        row: list[Cell] = [run, *(_known(float(one)) for one in runs.coded[place])]
        for index in range(len(runs.response_names)):
            row += [
                _known(float(one[index][place]))
                for one in (runs.responses, surfaces.fitted, surfaces.residual)
            ]
        rows.append(row)
    return csv_text(head, rows)


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _part(
    surfaces: ResponseSurfaces, runs: RunSeries, index: int, units: UnitSystem
) -> Part | None:
    """Figures and tables of one response; empty for one without a surface."""
    if not np.isfinite(surfaces.coefficient[index]).all():
        return None
    name, transform = surfaces.response_names[index], surfaces.transform[index]
    unit, factor = display_unit(runs.response_units[index] or "1", units)
    scale = factor if transform == "none" else 1.0
    fitted_in = unit if transform == "none" else transform
    label = f"{name} [{unit}]" if runs.response_units[index] else name
    columns = (
        scale * surfaces.coefficient[index],
        scale * surfaces.coefficient_standard_uncertainty[index],
        surfaces.t[index],
        surfaces.p_value[index],
    )
    named = zip(surfaces.labels, surfaces.term_names, strict=True)
    terms = [
        [words(one), words(term), *(number(float(column[place])) for column in columns)]
        for place, (one, term) in enumerate(named)
    ]
    freedom, *others = _columns(surfaces.anova)
    squared = (scale**2, scale**2, 1.0, 1.0)
    rows: list[list[TableCell]] = [
        [
            words(source),
            count(float(freedom[index][place])),
            *(
                number(by * float(one[index][place]))
                for one, by in zip(others, squared, strict=True)
            ),
        ]
        for place, source in enumerate(surfaces.anova.source)
    ]
    tables: list[PageTable] = [
        make_table(
            f"Coefficients of {name}, of coded levels [{fitted_in}]; r2"
            f" {float(surfaces.r2[index]):.4f}, predicted"
            f" {float(surfaces.predicted_r2[index]):.4f}.",
            ("", "term", "coefficient", "standard error", "t", "p"), terms,
        ),
        make_table(
            f"Analysis of variance of {name}.",
            ("source", "df", "sum of squares", "mean square", "F", "p"), rows,
        ),
    ]  # fmt: skip
    figures = [*_contours(surfaces, runs, index, label, factor, units),
               *_against_measured(surfaces, index, label, scale)]  # fmt: skip
    return make_part(name, figures, tables)


def _contours(
    surfaces: ResponseSurfaces,
    runs: RunSeries,
    index: int,
    label: str,
    factor: float,
    units: UnitSystem,
) -> list[Figure]:
    """Contours over the two most important factors, with the next one at three levels."""
    weight = np.abs(surfaces.coefficient[index]) @ (surfaces.exponents > 0)
    order = np.argsort(-weight, kind="stable").tolist()
    if len(order) < 2:
        return []
    across, held = order[:2], order[2] if len(order) > 2 else None
    side = np.linspace(-1.0, 1.0, _POINTS)
    figures, values = [], []
    for level in _HELD if held is not None else (0.0,):
        points = np.zeros((_POINTS**2, len(order)))
        points[:, across[0]], points[:, across[1]] = (
            np.tile(side, _POINTS),
            np.repeat(side, _POINTS),
        )
        if held is not None:
            points[:, held] = level
        found = evaluate_surfaces(surfaces, points, units="coded", outside="flag")
        values.append(factor * found.value[index].reshape(_POINTS, _POINTS))
    axes = [_axis(runs, place, side, units) for place in across]
    ends = {"zmin": float(np.min(values)), "zmax": float(np.max(values))}
    for place, value in enumerate(values):
        at = ""
        if held is not None:
            held_name, ticks = _axis(runs, held, np.array(_HELD), units)
            at = f" at {held_name} = {ticks[place]:.4g}"
        data: list[Trace] = [
            {
                "type": "contour", "name": label, "showlegend": False, **ends,
                "x": plain_numbers(axes[0][1]), "y": plain_numbers(axes[1][1]),
                "z": [plain_numbers(row, 5) for row in value], "colorscale": "Viridis",
                "contours": {"coloring": "fill", "showlabels": True},
            }
        ]  # fmt: skip
        figures.append(
            make_figure(
                f"contour-{index}-{place}", f"{label}{at}",
                f"Contours of the surface{at}; other factors in the middle of their range.",
                data, synthetic=False, height=380, xaxis=axis(axes[0][0]), yaxis=axis(axes[1][0]),
            )
        )  # fmt: skip
    return figures


def _axis(runs: RunSeries, place: int, coded: Floats, units: UnitSystem) -> tuple[str, Floats]:
    """Label and levels of a factor, in display units."""
    unit, factor = display_unit(runs.factor_units[place] or "1", units)
    low, high = float(runs.low[place]), float(runs.high[place])
    levels = factor * ((high + low) / 2 + coded * (high - low) / 2)
    return f"{runs.factor_names[place].replace('_', ' ')} [{unit}]", levels


def _against_measured(
    surfaces: ResponseSurfaces, index: int, label: str, scale: float
) -> list[Figure]:
    fitted = scale * surfaces.fitted[index]
    measured = fitted + scale * surfaces.residual[index]
    known = np.isfinite(measured)
    ends = np.array([np.nanmin([measured, fitted]), np.nanmax([measured, fitted])])
    data: list[Trace] = [
        line(ends, ends, name="equal", colour=COLOURS[1], dash="dot", showlegend=False),
        {
            "type": "scatter", "mode": "markers", "name": "runs",
            "x": plain_numbers(measured[known]), "y": plain_numbers(fitted[known]),
            "text": [run for run, one in zip(surfaces.run_names, known, strict=True) if one],
            "marker": {"color": COLOURS[0], "size": 8},
        },
    ]  # fmt: skip
    return [
        make_figure(
            f"predicted-{index}", f"{label}: surface against measured",
            "Surface value against measured value, one point per run; dotted: equal.",
            data, synthetic=False, xaxis=axis("measured"), yaxis=axis("by the surface"),
        )
    ]  # fmt: skip
