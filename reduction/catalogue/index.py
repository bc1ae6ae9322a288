"""The index of a folder of products: one Parquet file that can always be made again.

The first row group are the tests, a row for each specimen and one for what belongs to the whole
test; the others are numbers, in order of their quantity, so that a question reads few of them.
The file is written whole, and what it says of an archive counts only while that archive is as it
was when it was read.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow  # type: ignore[import-untyped]
import pyarrow.compute  # type: ignore[import-untyped]
import pyarrow.parquet  # type: ignore[import-untyped]

from reduction import __version__
from reduction.archive.whole import remove_abandoned, whole_file
from reduction.catalogue.columns import ABOUT, CONDITIONS, column_type
from reduction.catalogue.entry import ArchiveEntry, Block
from reduction.catalogue.files import FileState

__all__ = ["INDEX_NAME", "Index", "index_of", "joined", "load_index", "save_index"]

INDEX_NAME = "catalogue.parquet"
_FORMAT = "1"
_MARK = b"reduction_catalogue"
_ROWS_AT_ONCE = 65_536
_TYPES: dict[str, Any] = {
    "size": pyarrow.int64(),
    "modified": pyarrow.int64(),
    "changed": pyarrow.int64(),
    "identity": pyarrow.string(),
    "fault": pyarrow.string(),
    "is_whole": pyarrow.bool_(),
}
_TESTS = pyarrow.schema(
    [(name, column_type(name)) for name in CONDITIONS] + [(name, _TYPES[name]) for name in ABOUT]
)
_VALUES = {
    "quantity": pyarrow.string(),
    "row": pyarrow.int32(),
    "value": pyarrow.float64(),
    "standard_uncertainty": pyarrow.float64(),
}
_NO_VALUES = pyarrow.schema(list(_VALUES.items())).empty_table()


@dataclass(frozen=True)
class Index:
    """Tests and numbers of a folder.

    Parameters
    ----------
    tests : pyarrow.Table
        A row for each specimen of each archive, and one for the whole archive.
    values : tuple of pyarrow.Table
        One for each set of dimensions: ``quantity``, ``row`` of ``tests``, ``value``,
        ``standard_uncertainty`` (SI), and a column for each dimension along which numbers stand.
    """

    tests: Any
    values: tuple[Any, ...]

    def numbers_of(self, quantity: str) -> Any:
        """Numbers of a quantity, with a column for each dimension of any of them."""
        found = [
            part.filter(pyarrow.compute.equal(part["quantity"], quantity)) for part in self.values
        ]
        found = [part for part in found if part.num_rows]
        return pyarrow.concat_tables([_NO_VALUES, *found], promote_options="default")

    @staticmethod
    def empty() -> Index:
        """Index of no archive."""
        return index_of([])

    def states(self) -> dict[str, tuple[FileState, str]]:
        """State and identity of each archive when it was read."""
        whole = self.tests.filter(self.tests["is_whole"])
        columns = (whole[name].to_pylist() for name in ("archive", *ABOUT[:4]))
        return {
            name: (FileState(size, modified, changed), identity)
            for name, size, modified, changed, identity in zip(*columns, strict=True)
        }

    def unreadable(self) -> dict[str, str]:
        """Archives that could not be read, each with the reason."""
        whole = self.tests.filter(self.tests["is_whole"])
        columns = (whole[name].to_pylist() for name in ("archive", "fault"))
        return {name: fault for name, fault in zip(*columns, strict=True) if fault}

    def with_states(self, states: Mapping[str, FileState]) -> Index:
        """The same index with other states of some archives."""
        columns = {name: self.tests[name].to_pylist() for name in ("archive", *ABOUT[:3])}
        tests = self.tests
        for name in ABOUT[:3]:
            new = [
                getattr(states[archive], name) if archive in states else old
                for archive, old in zip(columns["archive"], columns[name], strict=True)
            ]
            place = tests.schema.get_field_index(name)
            tests = tests.set_column(place, name, pyarrow.array(new, _TYPES[name]))
        return Index(tests, self.values)


def index_of(entries: Sequence[tuple[ArchiveEntry, FileState]]) -> Index:
    """Index of archives that were just read."""
    rows: list[dict[str, object]] = []
    tables: dict[tuple[str, ...], list[tuple[Block, np.ndarray[Any, Any]]]] = {}
    for entry, state in entries:
        about = {
            "size": state.size, "modified": state.modified, "changed": state.changed,
            "identity": entry.identity, "fault": entry.fault,
        }  # fmt: skip
        first = len(rows)
        rows.append(entry.whole | about | {"is_whole": True})
        rows += [one | about | {"is_whole": False} for one in entry.specimens]
        for block in entry.blocks:
            # the row of the whole test stands before those of its specimens
            tables.setdefault(tuple(block.place), []).append((block, first + 1 + block.specimen))
    tests = pyarrow.Table.from_pylist(rows, schema=_TESTS)
    return Index(tests, _values(tables))


def _values(
    tables: dict[tuple[str, ...], list[tuple[Block, np.ndarray[Any, Any]]]],
) -> tuple[Any, ...]:
    return _together([_table_of(dims, blocks) for dims, blocks in tables.items()])


def _table_of(dims: Sequence[str], blocks: Sequence[tuple[Block, np.ndarray[Any, Any]]]) -> Any:
    columns = {
        "quantity": [block.quantity for block, _ in blocks],
        "row": [row for _, row in blocks],
        "value": [block.value for block, _ in blocks],
        "standard_uncertainty": [block.standard_uncertainty for block, _ in blocks],
    } | {dim: [block.place[dim] for block, _ in blocks] for dim in dims}
    return pyarrow.table(
        {
            name: pyarrow.array(
                np.concatenate(arrays), _VALUES.get(name) or column_type(name), from_pandas=True
            )
            for name, arrays in columns.items()
        }
    )


def _together(parts: Sequence[Any]) -> tuple[Any, ...]:
    """One table for each set of columns: a column of nothing for each other dimension is no use."""
    alike: dict[tuple[str, ...], list[Any]] = {}
    for part in parts:
        names = (*_VALUES, *sorted(set(part.column_names) - _VALUES.keys()))
        alike.setdefault(names, []).append(part.select(names))
    merged = (pyarrow.concat_tables(tables) for _, tables in sorted(alike.items()))
    return tuple(one for one in merged if one.num_rows)


def joined(kept: Index, names: Iterable[str], added: Index) -> Index:
    """What ``kept`` knows of the archives ``names``, and all of ``added``; tests in order.

    Parameters
    ----------
    kept, added : Index
        Of different archives.
    names : iterable of str
        Archives of ``kept`` that count still.
    """
    stays = pyarrow.compute.is_in(
        kept.tests["archive"], pyarrow.array(list(names), pyarrow.string())
    ).to_numpy()
    n_kept = int(stays.sum())
    tests = pyarrow.concat_tables([kept.tests.filter(pyarrow.array(stays)), added.tests])
    order = np.asarray(
        pyarrow.compute.sort_indices(
            tests.append_column("place", pyarrow.array(np.arange(tests.num_rows))),
            sort_keys=[("archive", "ascending"), ("place", "ascending")],
        )
    )
    new_row = np.empty(tests.num_rows, np.int32)
    new_row[order] = np.arange(tests.num_rows)
    of_kept = np.full(kept.tests.num_rows, -1, np.int32)
    of_kept[stays] = new_row[:n_kept]
    values = _together(
        [_renumbered(part, of_kept) for part in kept.values]
        + [_renumbered(part, new_row[n_kept:]) for part in added.values]
    )
    order_of_values = [("quantity", "ascending"), ("row", "ascending")]
    return Index(
        tests.take(pyarrow.array(order)), tuple(part.sort_by(order_of_values) for part in values)
    )


def _renumbered(values: Any, new_row: np.ndarray[Any, Any]) -> Any:
    row = new_row[values["row"].to_numpy()]
    place = values.schema.get_field_index("row")
    return values.set_column(place, "row", pyarrow.array(row, pyarrow.int32())).filter(
        pyarrow.array(row >= 0)
    )


def save_index(index: Index, path: Path) -> None:
    """Write the index, whole or not at all; `OSError` where the disk refuses."""
    parts = [index.tests, *index.values]
    schema = pyarrow.unify_schemas([_TESTS, _NO_VALUES.schema, *(part.schema for part in parts)])
    schema = schema.with_metadata({_MARK: f"{_FORMAT} {__version__}".encode()})
    remove_abandoned(path)
    with (
        whole_file(path) as part,
        pyarrow.parquet.ParquetWriter(part, schema, compression="zstd") as writer,
    ):
        # the first group even where there is no test
        writer.write_table(_widened(index.tests, schema), max(1, index.tests.num_rows))
        for values in index.values:
            for first in range(0, values.num_rows, _ROWS_AT_ONCE):
                writer.write_table(_widened(values.slice(first, _ROWS_AT_ONCE), schema))


def _widened(table: Any, schema: Any) -> Any:
    """A table with every column of the file."""
    n_rows = table.num_rows
    return pyarrow.table(
        [
            table[one.name] if one.name in table.column_names else pyarrow.nulls(n_rows, one.type)
            for one in schema
        ],
        schema=schema,
    )


def load_index(path: Path, quantities: Sequence[str] | None = None) -> Index | None:
    """Read an index; None where there is none, or none of this version.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    quantities : sequence of str, optional
        Whose numbers are read; left out: all.
    """
    try:
        with pyarrow.parquet.ParquetFile(path) as file:
            mark = (file.schema_arrow.metadata or {}).get(_MARK, b"")
            if mark != f"{_FORMAT} {__version__}".encode():
                return None
            tests = file.read_row_group(0, columns=_TESTS.names).cast(_TESTS)
            values = [
                file.read_row_group(group, columns=_columns_in(file, group))
                for group in _groups_with(file, quantities)
            ]
    except (OSError, pyarrow.ArrowException):
        # one that another program left, or a damaged one: it is made again
        return None
    if quantities is not None:
        wanted = pyarrow.array(list(quantities), pyarrow.string())
        values = [part.filter(pyarrow.compute.is_in(part["quantity"], wanted)) for part in values]
    return Index(tests, _together(values))


def _columns_in(file: Any, group: int) -> list[str]:
    """Columns of numbers that have any entry in a row group."""
    about = file.metadata.row_group(group)
    found = []
    for place, name in enumerate(file.schema_arrow.names):
        known = about.column(place).statistics
        has_any = known is None or known.null_count < about.num_rows
        if name in _VALUES or (name not in _TESTS.names and has_any):
            found.append(name)
    return found


def _groups_with(file: Any, quantities: Sequence[str] | None) -> list[int]:
    """Row groups of numbers that may have one of the quantities."""
    numbers = range(1, file.metadata.num_row_groups)
    if quantities is None:
        return list(numbers)
    column = file.schema_arrow.names.index("quantity")
    found = []
    for number in numbers:
        bounds = file.metadata.row_group(number).column(column).statistics
        if any(bounds.min <= name <= bounds.max for name in quantities):
            found.append(number)
    return found
