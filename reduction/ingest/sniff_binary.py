"""Look at workbooks, binary files and JSON: which table is the log, and what its columns say."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np

from reduction.errors import LogError
from reduction.ingest.hdf5 import group_table
from reduction.ingest.hdf5file import data_set, open_hdf5, read_texts
from reduction.ingest.layout import Format, Layout
from reduction.ingest.limits import Watch
from reduction.ingest.matlab import (
    matlab_table,
    open_matlab,
    read_cell_texts,
    struct_fields,
    struct_place,
)
from reduction.ingest.matrix import json_content
from reduction.ingest.parquet import open_parquet, parquet_table
from reduction.ingest.sniff_channels import SeenColumn, is_unit
from reduction.ingest.sniff_table import TableShape, look_at_table, seen_columns
from reduction.ingest.spreadsheet import open_workbook, read_rows
from reduction.ingest.table import ColumnTable, matrix_table
from reduction.ingest.tdms import WAVEFORM_COLUMN, open_tdms, tdms_table

_ROWS = 400
_LONGEST_NAME = 1000
_PART = 1 << 20  # rows that are loaded at a time
Candidate = tuple[dict[str, object], ColumnTable]
"""Layout settings and the table that they read."""


@dataclass(frozen=True)
class SeenTable:
    """A table that may be the log: its columns, the layout settings that read it, remarks."""

    format: Format
    columns: list[SeenColumn]
    settings: dict[str, object] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()


def table_sheets(path: Path, watch: Watch) -> list[tuple[str, TableShape]]:
    """Sheets of a workbook that hold a table of two or more rows of numbers."""
    workbook = open_workbook(path, watch)
    found = []
    for place, name in enumerate(workbook.sheet_names):
        table = look_at_table(read_rows(path, workbook, place, _ROWS), ".")
        if table is not None:
            found.append((name, table))
    return found


def look_at_sheet(path: Path, sheet: str | None, watch: Watch) -> SeenTable:
    """One sheet of a workbook, or the one that holds the longest table."""
    found = table_sheets(path, watch)
    chosen = [entry for entry in found if sheet in (None, entry[0])]
    if not chosen:
        raise LogError(
            path, "no sheet holds a table of numbers",
            found=", ".join(repr(name) for name, _ in found) or "no such sheet",
            needed=repr(sheet) if sheet else "rows of two or more numbers",
        )  # fmt: skip
    name, table = max(chosen, key=lambda entry: len(entry[1].rows))
    remarks = [f"guess: the log is on sheet '{name}'"] if sheet is None else []
    if sheet is None and len(found) > 1:
        others = ", ".join(repr(other) for other, _ in found if other != name)
        remarks.append(f"sure: tables stand also on {others}")
    settings: dict[str, object] = {"sheet": name}
    top = table.start if table.name_row is None else table.name_row
    if top:
        settings["preamble_rows"] = top
        remarks.append(f"sure: the table begins below row {top}")
    settings["has_name_row"] = table.name_row is not None
    settings["has_unit_row"] = table.unit_row is not None
    return SeenTable("spreadsheet", seen_columns(table, "."), settings, tuple(remarks))


def _seen(table: ColumnTable) -> list[SeenColumn]:
    """Columns of numbers that share the most common length."""
    columns, sizes = [], []
    for place, (name, unit) in enumerate(zip(table.names, table.units, strict=True)):
        if len(name) > _LONGEST_NAME:  # no layout would write it
            continue
        try:
            parts = table.load(place, _ROWS if table.sizes else _PART)
            values = next(parts)
            size = values.size
            # where the file states how many there are, the rest is not read
            size = table.sizes[place] if table.sizes else size + sum(part.size for part in parts)
        except LogError:  # not a series: no column
            continue
        if values.ndim == 1 and size > 1 and values.dtype.kind in "fiu":
            first = values[:_ROWS].astype(np.float64)
            columns.append(SeenColumn(place + 1, name, unit, first, is_named=bool(name)))
            sizes.append(size)
    if not sizes:
        return []
    length = Counter(sizes).most_common(1)[0][0]
    return [column for column, size in zip(columns, sizes, strict=True) if size == length]


def _named_matrix(
    path: Path, key: str, matrix: Any, texts: Mapping[str, Sequence[str]], group: str = ""
) -> tuple[dict[str, object], ColumnTable]:
    """A matrix with the lists of texts beside it that may be its names and units."""
    settings: dict[str, object] = {"group": group} if group else {}
    settings["matrix"] = key
    given: dict[str, tuple[str, ...]] = {}
    for name, entries in texts.items():
        if matrix.ndim == 2 and len(entries) == matrix.shape[1]:
            filled = [text for text in entries if text]
            kind = "units" if 2 * sum(map(is_unit, filled)) >= len(filled) else "names"
            if kind not in given:
                given[kind] = tuple(entries)
                settings[f"matrix_{kind}"] = name
    return settings, matrix_table(
        path, matrix, where=key, names=given.get("names"), units=given.get("units")
    )


def _is_matrix(values: Any) -> bool:
    return bool(values.dtype.names and values.size > 1) or (
        values.ndim == 2 and min(values.shape) > 1 and values.dtype.kind in "fiu"
    )


def _hdf5_candidates(path: Path, file: h5py.File, watch: Watch) -> Iterator[Candidate]:
    """Groups and matrices of a file; a group that is reached in two ways is looked at once."""
    waiting: deque[h5py.Group] = deque([file])
    seen = set()
    while waiting:
        watch.check_time()
        group = waiting.popleft()
        address = h5py.h5o.get_info(group.id).addr
        if address in seen:
            continue
        seen.add(address)
        place = (group.name or "").strip("/")
        settings = {"group": place} if place else {}
        yield settings, group_table(path, group, watch)
        texts, matrices = {}, {}
        for name in group:
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                continue
            member = group[name]
            if isinstance(member, h5py.Group):
                waiting.append(member)
                continue
            try:
                values = data_set(path, member, watch)
                if _is_matrix(values):
                    matrices[name] = values
                elif values.dtype.kind in "OSUT":
                    texts[name] = read_texts(path, member, watch)
            except LogError:  # neither a matrix nor texts
                continue
        for name, values in matrices.items():
            yield _named_matrix(path, name, values, texts, place)


def _matlab_candidates(
    path: Path, scope: Mapping[str, Any], group: str, seen: set[int], watch: Watch
) -> Iterator[Candidate]:
    watch.check_time()
    yield (
        {"group": group} if group else {},
        matlab_table(path, scope, Layout(format="matlab", channels={})),
    )
    texts, matrices = {}, {}
    for name in scope:
        try:
            value = scope[name]
            fields = struct_fields(value)
            if fields is not None:
                inside = f"{group}.{name}".strip(".")
                place = struct_place(fields)
                if place not in seen:  # a struct of version 7.3 may hold itself
                    seen |= set() if place is None else {place}
                    yield from _matlab_candidates(path, fields, inside, seen, watch)
            elif isinstance(value, np.ndarray) and _is_matrix(value) and not value.dtype.names:
                matrices[name] = value
            else:
                texts[name] = read_cell_texts(path, name, value)
        except LogError:  # neither a struct, a matrix nor texts
            continue
    for name, values in matrices.items():
        yield _named_matrix(path, name, values, texts, group)


def _tdms_candidates(path: Path, file: Any, watch: Watch) -> Iterator[Candidate]:
    groups = file.groups()
    for group in groups:
        settings = {"group": group.name} if len(groups) > 1 else {}
        yield settings, tdms_table(path, file, group, watch)


def look_at_binary(path: Path, kind: Format, watch: Watch) -> SeenTable:
    """The largest table of a TDMS, MATLAB, HDF5 or Parquet file."""
    with ExitStack() as stack:
        candidates: Iterator[Candidate]
        if kind == "tdms":
            file = stack.enter_context(open_tdms(path))
            candidates = _tdms_candidates(path, file, watch)
        elif kind == "hdf5":
            hdf5 = stack.enter_context(open_hdf5(path))
            candidates = _hdf5_candidates(path, hdf5, watch)
        elif kind == "matlab":
            variables = stack.enter_context(open_matlab(path, watch))
            candidates = _matlab_candidates(path, variables, "", set(), watch)
        else:
            parquet = stack.enter_context(open_parquet(path))
            candidates = iter([({}, parquet_table(path, parquet, watch))])
        best: tuple[dict[str, object], list[SeenColumn]] = ({}, [])
        count = 0
        for settings, table in candidates:
            columns = _seen(table)
            count += len(columns) > 1
            if sum(c.values.size for c in columns) > sum(c.values.size for c in best[1]):
                best = settings, columns
        settings, columns = best
        if kind == "tdms" and columns:
            columns = columns + _waveform(file, settings, columns)
    remarks = [f"sure: {len(columns)} columns of numbers of one length"]
    if count > 1:
        remarks.append(f"guess: the largest of {count} tables of the file is the log")
    return SeenTable(kind, columns, settings, tuple(remarks))


def _waveform(
    file: Any, settings: Mapping[str, object], columns: list[SeenColumn]
) -> list[SeenColumn]:
    """Time by the waveform properties, as one more column where the channels have them."""
    group = file[settings["group"]] if "group" in settings else file.groups()[0]
    if all(channel.properties.get(WAVEFORM_COLUMN, 0) for channel in group.channels()):
        return [SeenColumn(len(columns) + 1, WAVEFORM_COLUMN, "s", np.arange(2.0))]
    return []


def look_at_json(path: Path, watch: Watch) -> SeenTable:
    """The largest matrix of a JSON object."""
    _, content = json_content(path, watch)
    texts, matrices = {}, {}
    for key, value in content.items():
        if not isinstance(value, list) or not value:
            continue
        if all(isinstance(entry, str) for entry in value):
            texts[key] = value
        elif isinstance(value[0], list):
            first = [
                row for row in value[:_ROWS] if isinstance(row, list) and len(row) == len(value[0])
            ]
            numbers = [[x if isinstance(x, (int, float)) else np.nan for x in row] for row in first]
            matrices[key] = np.array(numbers, dtype=np.float64)
    if not matrices:
        raise LogError(
            path, "no key holds a matrix of numbers", found=", ".join(map(repr, content)),
            needed="a list of rows",
        )  # fmt: skip
    key = max(matrices, key=lambda name: matrices[name].size)
    settings, table = _named_matrix(path, key, matrices[key], texts)
    columns = _seen(table)
    stated = {
        name: value for name, value in content.items() if isinstance(value, str) and is_unit(value)
    }
    of_time = [value for name, value in stated.items() if "time" in name.lower()]
    if columns and len(of_time) == 1 and not columns[0].name:
        columns[0] = replace(columns[0], unit=of_time[0])
    remarks = [f"sure: '{key}' is a matrix of {len(table.names)} columns"]
    remarks += [
        f"sure: the file states {name!r} as {value!r}; give it as unit_key of its channel"
        for name, value in stated.items()
    ]
    return SeenTable("json", columns, settings, tuple(remarks))
