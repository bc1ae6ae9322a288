"""A table of runs from anywhere: one row a run; factors, responses, block, specimen, order."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reduction.campaign.cells import CellSheet, read_cells
from reduction.campaign.runlevels import check_levels, is_of_mean, levels_of_factor
from reduction.campaign.spec import ExperimentSpec, FactorSpec, ResponseSpec, response_unit
from reduction.errors import DataError, LogError, SettingsError
from reduction.record import Floats, read_only_arrays

_LABELS = ("run", "run_order", "block", "specimen")
_DUMMY = re.compile(r"dummy_\d+")


@dataclass(frozen=True)
@read_only_arrays
class RunSeries:
    """Runs as they were done.

    Parameters
    ----------
    factor_names, factor_units : tuple of str, length n_factors
        SI units of low and high.
    low, high : ndarray, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]
    coded : ndarray, shape (n_runs, n_factors)
        As reached; NaN where a run was not done. [1]
    dummy : ndarray, shape (n_runs, n_dummy)
        Columns ``dummy_1``, .. of a screening. [1]
    response_names, response_units : tuple of str, length n_responses
        A unit is empty where none is stated.
    responses : ndarray, shape (n_responses, n_runs)
        NaN where a run gave none. [SI unit of each response]
    run_names : tuple of str, length n_runs
    row : tuple of int, length n_runs
        Of the file, its first line being 1.
    run_order : ndarray, shape (n_runs,)
        NaN where not given. [1]
    blocks : tuple of str, length n_runs, or None
        Block or specimen of each run, where there are several.
    notes : tuple of str
        What a reader of the numbers has to know.
    """

    factor_names: tuple[str, ...]
    factor_units: tuple[str, ...]
    low: Floats
    high: Floats
    coded: Floats
    dummy: Floats
    response_names: tuple[str, ...]
    response_units: tuple[str, ...]
    responses: Floats
    run_names: tuple[str, ...]
    row: tuple[int, ...]
    run_order: Floats
    blocks: tuple[str, ...] | None
    notes: tuple[str, ...]


def _declared(
    sheet: CellSheet, spec: ExperimentSpec | None
) -> tuple[tuple[FactorSpec, ...], tuple[ResponseSpec, ...]]:
    """Factors and responses: as declared, else the last column and the others."""
    factors, responses = ((), ()) if spec is None else (spec.factors, spec.responses)
    named = {factor.name for factor in factors} | {entry.name for entry in responses}
    free = [
        column
        for column in sheet.columns
        if column.name not in (*_LABELS, *named) and not _DUMMY.fullmatch(column.name)
    ]
    if not responses:
        if not free or sheet.columns[-1] is not free[-1]:
            raise sheet.fault("the last column is not a response", needed="the response last")
        responses = (ResponseSpec(free.pop().name),)
    if not factors:
        factors = tuple(FactorSpec(column.name) for column in free)
        if not factors:
            raise sheet.fault("the table has no factor", needed="a column a factor")
    return factors, responses


def _labels(sheet: CellSheet, name: str) -> tuple[str, ...] | None:
    found = sheet.named(name)
    return found[0].cells if found else None


def _same_run(sheet: CellSheet, header: str, keys: Iterable[tuple[str, ...]]) -> None:
    seen: dict[tuple[str, ...], int] = {}
    for row, key in zip(sheet.row, keys, strict=True):
        if key[-1] and seen.setdefault(key, row) != row:
            raise DataError(
                f"{sheet.path}:{row} [{header}]: a run stands twice",
                found=f"{key[-1]!r}, also in row {seen[key]}",
                needed="each run once",
                hint="A repeat is a run of its own and has a number of its own.",
            )


def read_runs(path: Path, spec: ExperimentSpec | None = None) -> RunSeries:
    """Read a table of runs.

    Parameters
    ----------
    path : pathlib.Path
        CSV with a header; parted by commas, semicolons or tabs.
    spec : ExperimentSpec, optional
        What the columns are; without it the last one is the response and the others are
        coded factors.

    Returns
    -------
    runs : RunSeries
        Every row a run, in order; nothing is left out.

    Raises
    ------
    LogError
        With row and column, if the table cannot be read or a value is not a number.
    SettingsError
        If a value is still ``?``, or a unit is unknown or does not fit.
    DataError
        If a run stands twice, has a value and no levels, or the levels lie beside the plan.
    """
    sheet = read_cells(path)
    factors, responses = _declared(sheet, spec)
    strength = None if spec is None else spec.rated_break_strength
    coded = np.full((len(sheet.row), len(factors)), math.nan)
    used: set[str] = set()
    axes = [factor.axis(strength) for factor in factors]
    mean: Floats | None = None
    # an amplitude that is a share of the mean comes after the mean
    for place in sorted(range(len(factors)), key=lambda index: is_of_mean(factors[index])):
        factor = factors[place]
        column, coded[:, place] = levels_of_factor(sheet, factor, spec, mean)
        check_levels(sheet, column, factor.name, coded[:, place], stated=factor.levels is not None)
        used.add(column.header)
        unit, low, high = axes[place]
        if factor.name == "mean_tension" and unit == "N":
            mean = (low + high) / 2 + coded[:, place] * (high - low) / 2
    values, units = [], []
    for response in responses:
        column = sheet.one(response.name, "response")
        used.add(column.header)
        try:
            unit, by, offset = response_unit(response.name, column.unit or response.unit)
        except SettingsError as error:
            raise SettingsError(
                f"{path}:{sheet.first} [{column.header}]: {error.problem}", found=error.found,
                needed=error.needed, hint=error.hint,
            ) from error  # fmt: skip
        values.append(by * sheet.numbers(column) + offset)
        units.append(unit)
    measured = np.array(values)
    lost = np.isfinite(measured).any(axis=0) & ~np.isfinite(coded).all(axis=1)
    if lost.any():
        first = int(np.flatnonzero(lost)[0])
        name = factors[int(np.flatnonzero(~np.isfinite(coded[first]))[0])].name
        raise DataError(
            f"{path}:{sheet.row[first]} [{name}]: a run has a value and no level",
            needed="the level that the run reached",
        )
    dummies = [column for column in sheet.columns if _DUMMY.fullmatch(column.name)]
    blocks, notes = _blocks(sheet)
    known = {*_LABELS, *(factor.name for factor in factors)}
    others = [
        column.header
        for column in sheet.columns
        if column.header not in used and column not in dummies and column.name not in known
    ]
    if others:
        notes.append(f"columns that are not used: {', '.join(others)}")
    return RunSeries(
        factor_names=tuple(factor.name for factor in factors),
        factor_units=tuple(unit for unit, _, _ in axes),
        low=np.array([low for _, low, _ in axes]),
        high=np.array([high for _, _, high in axes]),
        coded=coded,
        dummy=np.array([sheet.numbers(column) for column in dummies]).T.reshape(
            len(sheet.row), len(dummies)
        ),
        response_names=tuple(response.name for response in responses),
        response_units=tuple(units),
        responses=measured,
        run_names=_run_names(sheet),
        row=sheet.row,
        run_order=_order(sheet),
        blocks=blocks,
        notes=tuple(notes),
    )


def _blocks(sheet: CellSheet) -> tuple[tuple[str, ...] | None, list[str]]:
    """Blocks, by the column block before the column specimen, where there are several."""
    several = {
        name: labels
        for name in ("block", "specimen")
        if (labels := _labels(sheet, name)) and len(set(labels)) > 1
    }
    if not several:
        return None, []
    name, labels = next(iter(several.items()))
    empty = [row for row, label in zip(sheet.row, labels, strict=True) if not label]
    if empty:
        raise LogError(
            sheet.path, f"a run has no {name}", row=empty[0], channel=name,
            needed="a name in every row, or in none",
        )  # fmt: skip
    pairs = set(zip(*several.values(), strict=True))
    if len(several) > 1 and len(pairs) > len(set(labels)):
        return labels, ["blocks are those of the column block; specimens in one are not told apart"]
    return labels, []


def _run_names(sheet: CellSheet) -> tuple[str, ...]:
    """Names of the runs, with the specimen where a run has several; their numbers else."""
    names, specimens = _labels(sheet, "run"), _labels(sheet, "specimen")
    apart = specimens or _labels(sheet, "block") or ("",) * len(sheet.row)
    if names is None:
        return tuple(str(number + 1) for number in range(len(sheet.row)))
    _same_run(sheet, "run", zip(apart, names, strict=True))
    empty = [row for row, name in zip(sheet.row, names, strict=True) if not name]
    if empty:
        raise LogError(
            sheet.path,
            "a run has no name",
            row=empty[0],
            channel="run",
            needed="a name or a number",
        )
    many = max(Counter(names).values()) > 1
    return tuple(f"{name} {of}" if many else name for name, of in zip(names, apart, strict=True))


def _order(sheet: CellSheet) -> Floats:
    """Place of each run in the order; each once in a block."""
    found = sheet.named("run_order")
    if not found:
        return np.full(len(sheet.row), math.nan)
    apart = _labels(sheet, "specimen") or _labels(sheet, "block") or ("",) * len(sheet.row)
    order = sheet.numbers(found[0])
    _same_run(sheet, found[0].header, zip(apart, found[0].cells, strict=True))
    return order
