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
from reduction.archive.whole import whole_file
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


@dataclass(frozen=True)
class Index:
    """Tests and numbers of a folder.

    Parameters
    ----------
    tests : pyarrow.Table
        A row for each specimen of each archive, and one for the whole archive.
    values : pyarrow.Table
        ``quantity``, ``row`` of ``tests``, ``value``, ``standard_uncertainty`` (SI), and a column
        for each dimension along which numbers stand.
    """

    tests: Any
    values: Any

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


def _values(tables: dict[tuple[str, ...], list[tuple[Block, np.ndarray[Any, Any]]]]) -> Any:
    parts = [_table_of([])]
    for dims, blocks in tables.items():
        columns = [
            ("quantity", np.concatenate([block.quantity for block, _ in blocks])),
            ("row", np.concatenate([row for _, row in blocks])),
            ("value", np.concatenate([block.value for block, _ in blocks])),
            (
                "standard_uncertainty",
                np.concatenate([block.standard_uncertainty for block, _ in blocks]),
            ),
        ]
        columns += [
            (dim, np.concatenate([block.place[dim] for block, _ in blocks])) for dim in dims
        ]
        parts.append(_table_of(columns))
    return pyarrow.concat_tables(parts, promote_options="default")


def _table_of(columns: Sequence[tuple[str, np.ndarray[Any, Any]]]) -> Any:
    arrays = dict(columns) or {name: np.empty(0, object) for name in _VALUES}
    return pyarrow.table(
        {
            name: pyarrow.array(array, _VALUES.get(name) or column_type(name), from_pandas=True)
            for name, array in arrays.items()
        }
    )


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
    values = pyarrow.concat_tables(
        [_renumbered(kept.values, of_kept), _renumbered(added.values, new_row[n_kept:])],
        promote_options="default",
    )
    return Index(
        tests.take(pyarrow.array(order)),
        values.sort_by([("quantity", "ascending"), ("row", "ascending")]),
    )


def _renumbered(values: Any, new_row: np.ndarray[Any, Any]) -> Any:
    row = new_row[values["row"].to_numpy()]
    place = values.schema.get_field_index("row")
    return values.set_column(place, "row", pyarrow.array(row, pyarrow.int32())).filter(
        pyarrow.array(row >= 0)
    )


def save_index(index: Index, path: Path) -> None:
    """Write the index, whole or not at all; `OSError` where the disk refuses."""
    values = index.values
    schema = pyarrow.unify_schemas([_TESTS, values.schema]).with_metadata(
        {_MARK: f"{_FORMAT} {__version__}".encode()}
    )
    none = {
        name: pyarrow.nulls(0, kind) for name, kind in zip(schema.names, schema.types, strict=True)
    }
    empty = pyarrow.table(none, schema=schema)
    tests, numbers = (
        pyarrow.concat_tables([empty, table], promote_options="default").cast(schema)
        for table in (index.tests, values)
    )
    with (
        whole_file(path) as part,
        pyarrow.parquet.ParquetWriter(part, schema, compression="zstd") as writer,
    ):
        writer.write_table(tests, row_group_size=max(1, tests.num_rows))
        writer.write_table(numbers, row_group_size=_ROWS_AT_ONCE)


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
            places = [name for name in file.schema_arrow.names if name not in _TESTS.names]
            tests = file.read_row_group(0, columns=_TESTS.names).cast(_TESTS)
            groups = _groups_with(file, quantities)
            values = file.read_row_groups(groups, columns=places)
    except (OSError, pyarrow.ArrowException):
        # one that another program left, or a damaged one: it is made again
        return None
    if quantities is not None:
        wanted = pyarrow.array(list(quantities), pyarrow.string())
        values = values.filter(pyarrow.compute.is_in(values["quantity"], wanted))
    return Index(tests, values)


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
