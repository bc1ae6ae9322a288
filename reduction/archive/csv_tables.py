"""Writes the CSV tables of a campaign from its archives."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.atomic_write import take_away
from reduction.archive.csv_columns import (
    OUTCOME_TABLES,
    SYNTHETIC,
    TEST,
    Cell,
    CsvColumn,
    CsvTable,
    GroupColumn,
    TableFile,
    column_blocks,
    column_descriptions,
    outcome_table_rows,
    table_blocks,
    uncertainty_of,
)
from reduction.archive.csv_definitions import (
    COMPARISON_TABLES,
    EXPERIMENT_TABLES,
    PREDICTION_TABLES,
    PROPERTY_TABLES,
    TABLES,
)
from reduction.archive.dataset_builder import variable_of
from reduction.archive.open import Opener, place_of, reading
from reduction.archive.shared_errors import components_of, shared_contributions
from reduction.archive.variables import stored
from reduction.quantities.flags import BRANCH_VALUES
from reduction.quantities.names import QUANTITIES, RESPONSE_PATTERNS, SURFACE_NAMES
from reduction.quantities.row import SUFFIXES
from reduction.quantities.units import combined_unit
from reduction.record.contributions import Component, Contributions, combined_standard_uncertainty
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats
from reduction.record.plain_text import natural_order
from reduction.stages.moduli.local_regression import curve_at
from reduction.uncertainty.propagation import ratio_contributions


def _with_uncertainty(name: str) -> tuple[CsvColumn, CsvColumn]:
    column = CsvColumn(name, QUANTITIES[name])
    return column, uncertainty_of(column)


ENVELOPE_COLUMNS = (
    CsvColumn("specimen", QUANTITIES["specimen"]),
    CsvColumn("branch", QUANTITIES["branch_name"]),
    CsvColumn("strain_bin", QUANTITIES["strain_bin"]),
    *_with_uncertainty("envelope_minimum"),
    CsvColumn("envelope_minimum_test", QUANTITIES["envelope_minimum_test"]),
    *_with_uncertainty("envelope_maximum"),
    CsvColumn("envelope_maximum_test", QUANTITIES["envelope_maximum_test"]),
    CsvColumn("n_tests", QUANTITIES["n_tests"]),
    SYNTHETIC,
)


@dataclass(frozen=True)
class _Curve:
    """Mean tangent modulus of one test, specimen and branch; arrays (n_bins,)."""

    test: str
    specimen: str
    branch: str
    synthetic: str
    strain: Floats
    width: float
    modulus: Floats
    uncertainty: Floats
    shared: Contributions = field(default_factory=lambda: Contributions(()))


def _curves_of(archive: xr.Dataset) -> Iterator[_Curve]:
    """Yield the curves of an archive; none for a test without cycles."""
    if "tangent_modulus" not in archive:
        return
    edges = archive.variables["strain_bin_bounds"].values
    rows = stored(archive, "tangent_modulus_uncertainty_contribution")
    component = () if rows is None else tuple(components_of(archive))
    for row, specimen in enumerate(archive.variables["specimen"].values):
        for column, branch in enumerate(archive.variables["branch_name"].values):
            yield _Curve(
                test=archive.attrs["test"],
                specimen=str(specimen),
                branch=str(branch),
                synthetic=archive.attrs.get("synthetic", "no"),
                strain=archive.variables["strain_bin"].values,
                width=float(np.max(edges[:, 1] - edges[:, 0])),
                modulus=archive.variables["tangent_modulus"].values[row, column],
                uncertainty=archive.variables["tangent_modulus_standard_uncertainty"].values[
                    row, column
                ],
                shared=Contributions(component)
                if rows is None
                else Contributions(component, {"tangent_modulus": rows.values[:, row, column]}),
            )


def _on_grid(curve: _Curve, grid: Floats) -> tuple[Floats, Floats]:
    """Interpolate a curve linearly between neighbouring bins onto a strain grid."""
    modulus, uncertainty = _read_curve(curve, grid, np.stack([curve.modulus, curve.uncertainty]))
    return modulus, uncertainty


def _read_curve(curve: _Curve, grid: Floats, values: Floats) -> Floats:
    """Interpolate values at the bins of a curve, (n, n_bins), to a strain grid, (n, n_grid)."""
    known = np.isfinite(curve.modulus)
    strain = curve.strain[known]
    if strain.size == 0:
        return np.full((values.shape[0], grid.size), np.nan)
    found = [curve_at(grid, strain, row[known], spacing=curve.width) for row in values]
    return np.array(found).reshape(len(values), grid.size)


def _envelope_rows(curves: Sequence[_Curve]) -> list[list[Cell]]:
    """Return the envelope of each specimen and branch on a common strain grid."""
    if not curves:
        return []
    widest = max(curves, key=lambda curve: curve.width)
    low = min(float(curve.strain[0]) for curve in curves)
    high = max(float(curve.strain[-1]) for curve in curves)
    origin = float(widest.strain[0])
    steps = np.arange(
        np.floor((low - origin) / widest.width + 0.01),
        np.ceil((high - origin) / widest.width - 0.01) + 1,
    )
    # differences between tests in the sixteenth digit are rounding
    grid = np.round(origin + widest.width * steps, 12)
    groups: dict[tuple[str, str], list[_Curve]] = defaultdict(list)
    for curve in curves:
        groups[curve.specimen, curve.branch].append(curve)
    return [
        row
        for (specimen, branch), group in groups.items()
        for row in _group_rows(specimen, branch, group, grid)
    ]


def _group_rows(
    specimen: str, branch: str, group: Sequence[_Curve], grid: Floats
) -> Iterator[list[Cell]]:
    pairs = [_on_grid(curve, grid) for curve in group]
    modulus = np.array([pair[0] for pair in pairs])
    uncertainty = np.array([pair[1] for pair in pairs])
    synthetic = "yes" if any(curve.synthetic == "yes" for curve in group) else "no"
    for column in np.flatnonzero(np.isfinite(modulus).any(axis=0)):
        at = modulus[:, column]
        cells: list[Cell] = [specimen, branch, float(grid[column])]
        for extreme in (int(np.nanargmin(at)), int(np.nanargmax(at))):
            spread = float(uncertainty[extreme, column])
            cells += [
                float(at[extreme]),
                spread if np.isfinite(spread) else None,
                group[extreme].test,
            ]
        yield [*cells, int(np.isfinite(at).sum()), synthetic]


def _by_response(archive: xr.Dataset) -> xr.Dataset:
    """Stack the responses along a dimension ``response``."""
    names = [
        name
        for name in SURFACE_NAMES
        if f"{name}_measured" in archive or f"{name}_transform" in archive
    ]
    units = [QUANTITIES[f"{name}_sigma"].unit for name in names]
    own_units = [QUANTITIES[f"{name}_point_value"].unit for name in names]
    stacked: dict[str, xr.Variable] = {
        name: variable_of(name, ("response",), np.array(texts, dtype=np.str_), attributes={})
        for name, texts in (("response", names), ("unit", units), ("response_unit", own_units))
    }
    for pattern in RESPONSE_PATTERNS:
        what = pattern.name.removeprefix("<response>")
        for own in (what, *(f"{what}{suffix}" for suffix in SUFFIXES)):
            variable = _stacked(archive, names, own)
            if variable is not None:
                stacked[f"response{own}"] = variable
    if "term_unit_engineering" in archive:
        of_term = archive.variables["term_unit_engineering"].values
        # the unit of a term is a factor there, not a divisor
        full = [
            [[combined_unit(unit, [str(own)], [-1]) for own in row] for unit in units]
            for row in of_term
        ]
        stacked["coefficient_engineering_unit"] = xr.Variable(
            ("experiment", "response", "term"), np.array(full, dtype=np.str_), fastpath=True
        )
    stacked["run_is_there"] = xr.Variable(
        ("experiment", "run"), _marked(archive.variables["run_name"].values != ""), fastpath=True
    )
    stacked["run_plan"] = xr.Variable(
        ("experiment", "run", "factor"),
        archive.variables["run_plan"].values[:, :, : archive.sizes["factor"]],
        fastpath=True,
    )
    if "response_effect" in stacked:
        is_column = archive.variables["plan_column_name"].values[:, None, :] != ""
        known = np.isfinite(stacked["response_effect"].values)
        if "response_effect_refusal" in stacked:
            is_refused = stacked["response_effect_refusal"].values != ""
            known |= is_refused[:, :, None] & is_column
        stacked["effect_is_there"] = xr.Variable(
            ("experiment", "response", "plan_column"), _marked(known), fastpath=True
        )
    # in one call: xarray aligns hundreds of variables for each addition
    return archive.assign(stacked)


def _stacked(archive: xr.Dataset, names: Sequence[str], what: str) -> xr.Variable | None:
    """Stack one quantity of every response after the experiments; None if absent from all."""
    given = {
        name: archive.variables[f"{name}{what}"] for name in names if f"{name}{what}" in archive
    }
    if not given:
        return None
    first = next(iter(given.values()))
    fill = {"U": "", "f": np.nan}.get(first.dtype.kind, 0)
    missing: NDArray[Any] = np.full(first.shape, fill, dtype=first.dtype)
    rows = [given[name].values if name in given else missing for name in names]
    experiment, *rest = first.dims
    return xr.Variable((experiment, "response", *rest), np.stack(rows, axis=1), fastpath=True)


def _marked(present: NDArray[Any]) -> NDArray[Any]:
    return np.where(present, 1.0, np.nan)


STATIC_DYNAMIC_COLUMNS = (
    CsvColumn("static_test", QUANTITIES["static_test"]),
    CsvColumn("static_specimen", QUANTITIES["static_specimen"]),
    TEST,
    CsvColumn("specimen", QUANTITIES["specimen"]),
    CsvColumn("branch", QUANTITIES["branch_name"]),
    CsvColumn("interval_strain", QUANTITIES["interval_strain"]),
    *_with_uncertainty("interval_modulus"),
    *_with_uncertainty("tangent_modulus"),
    *_with_uncertainty("static_dynamic_ratio"),
    SYNTHETIC,
)


@dataclass(frozen=True)
class _Slope:
    """Slope between two readings of a stepwise test, at their mid-strain."""

    test: str
    specimen: str
    branch: str
    synthetic: str
    strain: float
    modulus: float
    uncertainty: float
    shared: Mapping[Component, float] = field(default_factory=dict)


def _slopes_of(archive: xr.Dataset) -> Iterator[_Slope]:
    """Yield the numeric slopes of an archive; none for a test that is not stepwise."""
    if "interval_modulus" not in archive:
        return
    branches = {value: name for name, value in BRANCH_VALUES.items()}
    for index in map(
        int, np.flatnonzero(np.isfinite(archive.variables["interval_modulus"].values))
    ):
        yield _Slope(
            test=archive.attrs["test"],
            specimen=str(archive.variables["specimen"].values[0]),
            branch=branches[int(archive.variables["interval_branch"].values[index])],
            synthetic=archive.attrs.get("synthetic", "no"),
            strain=float(archive.variables["interval_strain"].values[index]),
            modulus=float(archive.variables["interval_modulus"].values[index]),
            uncertainty=float(
                archive.variables["interval_modulus_standard_uncertainty"].values[index]
            ),
            shared=shared_contributions(archive, "interval_modulus", index),
        )


def _static_dynamic_rows(slopes: Sequence[_Slope], curves: Sequence[_Curve]) -> list[list[Cell]]:
    """Pair every static slope with the dynamic curves of its branch, and give their ratio."""
    rows: list[list[Cell]] = []
    for curve in curves:
        beside = sorted(
            (slope for slope in slopes if slope.branch == curve.branch),
            key=lambda slope: (slope.test, slope.specimen, slope.strain),
        )
        at = np.array([slope.strain for slope in beside])
        of_errors = curve.shared.values.get("tangent_modulus", np.empty((0, curve.strain.size)))
        dynamic = np.column_stack([*_on_grid(curve, at), *_read_curve(curve, at, of_errors)])
        rows += [
            _row(slope, curve, float(modulus), float(spread), shared)
            for slope, (modulus, spread, *shared) in zip(beside, dynamic, strict=True)
            if np.isfinite(modulus)
        ]
    return rows


def _row(
    slope: _Slope, curve: _Curve, modulus: float, spread: float, shared: Sequence[float]
) -> list[Cell]:
    ratio = slope.modulus / modulus
    of_curve = dict(zip(curve.shared.component, np.nan_to_num(shared), strict=True))
    component = sorted({*of_curve, *slope.shared})
    above, below = (
        np.array([known.get(one, 0.0) for one in component]) for known in (slope.shared, of_curve)
    )
    rows = ratio_contributions(
        ratio, numerator=slope.modulus, of_numerator=above, denominator=modulus,
        of_denominator=below,
    )  # fmt: skip
    random = np.hypot(
        _left(slope.uncertainty, above) / slope.modulus, _left(spread, below) / modulus
    )
    whole = float(combined_standard_uncertainty(rows, abs(ratio) * random))
    numbers = [slope.modulus, slope.uncertainty, modulus, spread, ratio, whole]
    return [
        slope.test,
        slope.specimen,
        curve.test,
        curve.specimen,
        slope.branch,
        slope.strain,
        *(value if np.isfinite(value) else None for value in numbers),
        "yes" if "yes" in (slope.synthetic, curve.synthetic) else "no",
    ]


def _left(whole: float, contribution: Floats) -> float:
    """Random part of a standard uncertainty, without the shared part."""
    return float(np.sqrt(max(whole**2 - float(contribution @ contribution), 0.0)))


_Place = tuple[float, tuple[tuple[int, int, str], ...]]

_ALL = (
    *TABLES, *PROPERTY_TABLES, *EXPERIMENT_TABLES, *PREDICTION_TABLES, *COMPARISON_TABLES,
)  # fmt: skip

_ABOUT = tuple(
    CsvColumn(name, QUANTITIES[name])
    for name in ("table", "column", "unit", "meaning", "no_uncertainty")
)


def write_tables(
    archives: Sequence[Path],
    folder: Path,
    *,
    surfaces: Path | None = None,
    outcomes: Path | None = None,
    predictions: Path | None = None,
    comparisons: Path | None = None,
    change_in_length: Path | None = None,
    opener: Opener = reading,
    each: Callable[[Path, xr.Dataset], None] = lambda path, archive: None,
) -> list[Path]:
    """Write every table with data in the archives, and columns.csv, which explains them.

    ``each`` is called with every open test archive.
    """
    columns: dict[str, Sequence[CsvColumn | GroupColumn]] = {
        table.name: table.columns for table in _ALL
    }
    columns |= {"envelope": ENVELOPE_COLUMNS, "static_dynamic": STATIC_DYNAMIC_COLUMNS}
    columns |= OUTCOME_TABLES | {"columns": _ABOUT}
    with ExitStack() as whole:
        files = {
            name: TableFile(folder / f"{name}.csv", listed, whole)
            for name, listed in columns.items()
        }
        _add_tests(files, archives, opener, each)
        _add_experiments(files, surfaces, opener)
        _add_outcomes(files, outcomes, opener)
        _add_as_it_is(files, predictions, PREDICTION_TABLES, opener)
        _add_as_it_is(files, comparisons, COMPARISON_TABLES, opener)
        _add_as_it_is(files, change_in_length, PROPERTY_TABLES, opener)
        filled = [name for name in columns if files[name].is_filled] + ["columns"]
        files["columns"].add_rows(
            [
                [f"{name}.csv", *described]
                for name in filled
                for described in column_descriptions(columns[name], files[name].lonely)
            ]
        )
    for name in columns:
        if name not in filled:
            take_away(files[name].path)
    return [files[name].path for name in filled]


def table_of(archive: xr.Dataset, name: str) -> pd.DataFrame:
    """Return one table of a test archive with the contents of its CSV file.

    Parameters
    ----------
    archive : xarray.Dataset
        Dataset from `reduction.open_archive`.
    name : str
        File name without suffix: "cycles", "moduli", "relaxation", ...

    Returns
    -------
    table : pandas.DataFrame
        Columns by their headers with units; no rows if the test lacks the subject.

    Raises
    ------
    SettingsError
        If there is no such table of tests.
    """
    table = next((one for one in TABLES if one.name == name), None)
    if table is None:
        raise SettingsError(
            "there is no such table of a test",
            found=repr(name),
            needed="one of " + ", ".join(sorted(one.name for one in TABLES)),
        )
    empty = pd.DataFrame(columns=[column.header for column in table.columns])
    blocks = list(table_blocks(archive, table))
    return pd.concat(blocks, ignore_index=True) if blocks else empty


def _place(path: Path) -> _Place:
    """Sort key: place in the history, unplaced tests last; then the name, T-2 before T-10."""
    test, order = place_of(path)
    return order, natural_order(test)


def _add_tests(
    files: Mapping[str, TableFile],
    archives: Sequence[Path],
    opener: Opener,
    each: Callable[[Path, xr.Dataset], None],
) -> None:
    curves: list[_Curve] = []
    slopes: list[_Slope] = []
    for path in sorted(archives, key=_place):
        with opener(path) as archive:
            each(path, archive)
            _add(files, archive, TABLES)
            curves += _curves_of(archive)
            slopes += _slopes_of(archive)
    files["envelope"].add_rows(_envelope_rows(curves))
    files["static_dynamic"].add_rows(_static_dynamic_rows(slopes, curves))


def _add_experiments(files: Mapping[str, TableFile], surfaces: Path | None, opener: Opener) -> None:
    if surfaces is None:
        return
    with opener(surfaces) as archive:
        _add(files, _by_response(archive), EXPERIMENT_TABLES)


def _add_as_it_is(
    files: Mapping[str, TableFile], path: Path | None, tables: Sequence[CsvTable], opener: Opener
) -> None:
    if path is None:
        return
    with opener(path) as archive:
        _add(files, archive, tables)


def _add_outcomes(files: Mapping[str, TableFile], outcomes: Path | None, opener: Opener) -> None:
    if outcomes is None:
        return
    with opener(outcomes) as archive:
        for name, rows in outcome_table_rows(archive).items():
            files[name].add_rows(rows)


def _add(files: Mapping[str, TableFile], archive: xr.Dataset, tables: Sequence[CsvTable]) -> None:
    variables = dict(archive.variables)
    for table in tables:
        for _, columns in column_blocks(archive, variables, table):
            files[table.name].add_columns(columns)
