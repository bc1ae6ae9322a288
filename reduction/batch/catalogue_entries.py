"""Builds catalogue rows from the archives of a campaign, and writes the file."""

from __future__ import annotations

import pickle
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pyarrow
import pyarrow.parquet
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.atomic_write import remove_abandoned
from reduction.archive.open import Opener, reading
from reduction.archive.product_files import OF_CAMPAIGN
from reduction.archive.scratch_file import ScratchFile
from reduction.batch.catalogue import (
    CONDITIONS,
    FILE_NAME,
    MARK,
    NUMBER,
    NUMBERS,
    TEXTS,
    _archives_of,
    _column_type,
    _mark,
    _shown_path,
    _whole_file,
    campaigns_below,
)
from reduction.quantities.names import QUANTITIES
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Floats

LEFT_OUT: Final = frozenset(
    {"sample", "selected_cycle", "bound", "uncertainty_component", "uncertainty_source"}
)

"""Dimensions not copied from the archives: samples, curves by cycle, parts of uncertainties."""

_SAMPLES_AT_ONCE = 1_000_000

_CYCLES_AT_ONCE = 10_000

_ROWS_AT_ONCE = 16_384  # with conditions and writer buffers for 60 columns they take 40 MB

_ARCHIVES_AT_ONCE = 100
"""Number of archives sorted together, in about 30 MB."""

_WHOLE = -1

_TYPES: Final = {"row": pyarrow.int32(), "is_whole": pyarrow.bool_()}

_TESTS = pyarrow.schema(
    list(_TYPES.items()) + [(name, _column_type(name)) for name in (*CONDITIONS, *NUMBER)]
)


@dataclass(frozen=True)
class CatalogueEntry:
    """Catalogue data of one archive."""

    rows: list[dict[str, Any]]
    numbers: list[Any]


class CatalogueEntries:
    """Entries of archives, kept on disk until the catalogue is written: a thousand take 0.3 GB."""

    def __init__(self) -> None:
        self._scratch = ScratchFile()
        self._places: dict[Path, slice] = {}

    def __contains__(self, path: Path) -> bool:
        """Whether an archive has an entry."""
        return path in self._places

    def __getitem__(self, path: Path) -> CatalogueEntry:
        """Return the entry of an archive."""
        found: CatalogueEntry = pickle.loads(self._scratch.get(self._places[path]))  # noqa: S301
        return found

    def add(self, path: Path, archive: xr.Dataset) -> None:
        """Store the entry of an archive."""
        self._places[path] = self._scratch.put(pickle.dumps(entry_of(path, archive)))


def write_catalogue(
    archives: Sequence[Path],
    path: Path,
    *,
    entries: CatalogueEntries | None = None,
    opener: Opener = reading,
) -> None:
    """Write the catalogue of a campaign completely or not at all; indexed archives stay closed."""
    entries = entries or CatalogueEntries()
    for one in archives:
        if one not in entries:
            with opener(one) as archive:
                entries.add(one, archive)
    _write(entries, sorted(archives), path)


def rebuild(folder: Path) -> dict[str, str]:
    """Write the catalogue of every campaign in a folder from the existing archives."""
    left_out = {}
    for campaign in campaigns_below(folder):
        shown = _shown_path(campaign.name)
        entries, known = CatalogueEntries(), []
        try:
            for path in _archives_of(campaign):
                try:
                    with reading(path) as archive:
                        entries.add(path, archive)
                    known.append(path)
                except (ArchiveError, OSError, RuntimeError, ValueError, LookupError) as error:
                    # an archive that opens may have damaged parts, or parts of something else
                    words = (str(error) or type(error).__name__).splitlines()[0]
                    left_out[f"{shown}/{_shown_path(path.name)}"] = _shown_path(words)
            if known:
                _write(entries, known, campaign / FILE_NAME)
        except OSError as error:
            left_out[shown] = _shown_path(str(error))
    return left_out


def _write(entries: CatalogueEntries, archives: Sequence[Path], path: Path) -> None:
    """Write the tests, then their numbers, for some of the archives at a time."""
    parts = [
        archives[first : first + _ARCHIVES_AT_ONCE]
        for first in range(0, len(archives), _ARCHIVES_AT_ONCE)
    ]
    names, ends, of_parts = dict.fromkeys(_TESTS.names), [0], []
    for part in parts:
        rows: list[dict[str, Any]] = []
        for entry in (entries[one] for one in part):
            names |= dict.fromkeys(name for one in entry.numbers for name in one.column_names)
            rows += [row | {"row": place} for place, row in enumerate(entry.rows, ends[-1])]
            ends.append(ends[-1] + len(entry.rows))
        of_parts.append(pyarrow.Table.from_pylist(rows, schema=_TESTS))
    tests = pyarrow.concat_tables(of_parts)
    first_row = dict(zip(archives, ends, strict=False))
    # each number has the conditions of its test, so that the file is self-contained
    conditions = tests.select(["row", "is_whole", *CONDITIONS]).combine_chunks()
    types = {name: _TYPES.get(name) or _column_type(name) for name in names}
    schema = pyarrow.schema(types.items(), {MARK: _mark()})
    remove_abandoned(path)
    with (
        _whole_file(path) as new,
        new.open("wb") as file,  # opened here: a path may not be valid text
        pyarrow.parquet.ParquetWriter(file, schema, compression="zstd") as writer,
    ):
        writer.write_table(_complete(tests, schema), max(1, tests.num_rows))  # the first group
        for part in parts:
            numbers = []
            for one in part:
                for table in entries[one].numbers:
                    row = pyarrow.array(table["row"].to_numpy() + first_row[one], pyarrow.int32())
                    numbers.append(table.set_column(0, "row", row))
            for some in _by_quantity(numbers):
                # in one piece: each piece of a column costs as much as some thousand rows
                table = pyarrow.concat_tables(some, promote_options="default").combine_chunks()
                of_test = conditions.take(table["row"]).drop_columns("row")
                for name in of_test.column_names:
                    table = table.append_column(name, of_test[name])
                writer.write_table(_complete(table, schema), table.num_rows)
    # the memory of the writer is no longer needed
    pyarrow.default_memory_pool().release_unused()


def _complete(table: Any, schema: Any) -> Any:
    """The table with all columns of the file in order, and texts as text type."""
    columns = [
        table[one.name].cast(one.type)
        if one.name in table.column_names
        else pyarrow.nulls(table.num_rows, one.type)
        for one in schema
    ]
    return pyarrow.table(columns, schema=schema)


def _by_quantity(numbers: Sequence[Any]) -> Iterator[list[Any]]:
    """Parts of tables, each sorted by quantity, large enough for a group of the file."""
    slices: list[tuple[str, int, int, int]] = []
    for place, table in enumerate(numbers):
        names = table["quantity"].to_numpy(zero_copy_only=False)
        ends = [*(np.flatnonzero(names[1:] != names[:-1]) + 1).tolist(), len(names)]
        for start, stop in zip([0, *ends[:-1]], ends, strict=True):
            if stop > start:
                slices.append((str(names[start]), place, start, stop))
    some, n_rows = [], 0
    for _, place, start, stop in sorted(slices):
        some.append(numbers[place].slice(start, stop - start))
        n_rows += stop - start
        if n_rows >= _ROWS_AT_ONCE:
            yield some
            some, n_rows = [], 0
    if some:
        yield some


def _kept_cycles(n_cycles: int) -> NDArray[np.intp]:
    """Index of the cycles kept in a catalogue: 1, 2, 5, 10, 20, 50, ... and the last.

    Examples
    --------
    >>> [int(index) + 1 for index in _kept_cycles(3000)]
    [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 3000]
    """
    numbers = [one * 10**power for power in range(len(str(n_cycles))) for one in (1, 2, 5)]
    return np.array(sorted({n for n in numbers if n < n_cycles} | {n_cycles}), dtype=np.intp) - 1


def entry_of(path: Path, archive: xr.Dataset) -> CatalogueEntry:
    """Return the catalogue entry of an archive."""
    attributes = archive.attrs
    stem = path.stem
    whole: dict[str, Any] = {"synthetic": "no", "campaign": path.parent.name, "test": stem}
    whole |= {name: str(attributes[name]) for name in TEXTS if name in attributes}
    whole |= {"archive": path.name, "is_whole": True}
    part = stem if stem in OF_CAMPAIGN else ""
    whole["test_kind"] = part or str(attributes.get("test_kind", ""))
    if "cycle" in archive.sizes:
        whole["n_cycles"] = float(archive.sizes["cycle"])
    names = archive.variables["specimen"].values.tolist() if "specimen" in archive.sizes else []
    ends = _strain_ends(archive) if names else []
    of_specimens = [
        whole
        | {"specimen": str(name), "is_whole": False}
        | _conditions(archive, place)
        | ends[place]
        for place, name in enumerate(names)
    ]
    rows = [
        {name: _shown_path(one) if isinstance(one, str) else one for name, one in row.items()}
        for row in (whole, *of_specimens)
    ]
    return CatalogueEntry(rows, list(_blocks(archive, names)))


def _conditions(archive: xr.Dataset, place: int) -> dict[str, str | float]:
    found: dict[str, str | float] = {}
    for name in (*TEXTS, *NUMBERS):
        if name != "specimen" and name in archive and archive.variables[name].dims == ("specimen",):
            value = archive.variables[name].values[place]
            found[name] = float(value) if name in NUMBERS else str(value)
    return _known(found)


def _known(found: dict[str, str | float]) -> dict[str, str | float]:
    """Remove missing numbers."""
    return {name: one for name, one in found.items() if isinstance(one, str) or np.isfinite(one)}


def _strain_ends(archive: xr.Dataset) -> list[dict[str, str | float]]:
    """Minimum and maximum strain of each specimen over its samples, steps and cycles."""
    n_specimens = archive.sizes["specimen"]
    low, high = np.full(n_specimens, np.nan), np.full(n_specimens, np.nan)
    if "strain" in archive and archive.variables["strain"].dims in (
        ("specimen", "sample"),
        ("step",),
    ):
        strain = archive.variables["strain"]
        long = strain.dims[-1]
        for first in range(0, strain.sizes[long], _SAMPLES_AT_ONCE):
            part = strain.isel({long: slice(first, first + _SAMPLES_AT_ONCE)})
            spread = np.broadcast_to(part.values, (n_specimens, part.sizes[long]))
            low, high = _widened(low, high, spread)
    if {"mean_strain", "strain_amplitude"} <= set(archive.variables) and "cycle" in archive.sizes:
        mean, half = (
            archive.variables["mean_strain"].values,
            archive.variables["strain_amplitude"].values,
        )
        low, high = _widened(low, high, np.concatenate([mean - half, mean + half], axis=-1))
    return [
        _known({"least_strain": float(least), "greatest_strain": float(most)})
        for least, most in zip(low, high, strict=True)
    ]


def _widened(low: Floats, high: Floats, strain: Floats) -> tuple[Floats, Floats]:
    # fmin and fmax ignore missing samples
    return (
        np.fmin(low, np.fmin.reduce(strain, axis=-1, initial=np.nan)),
        np.fmax(high, np.fmax.reduce(strain, axis=-1, initial=np.nan)),
    )


def _blocks(archive: xr.Dataset, names: list[str]) -> Iterator[Any]:
    """Numbers of an archive, grouped by dimensions."""
    groups: dict[tuple[Hashable, ...], list[str]] = {}
    for name, variable in archive.variables.items():
        is_number = variable.dtype.kind in "fiu" and "flag_meanings" not in variable.attrs
        stays = LEFT_OUT & set(variable.dims) or any(
            str(dim).endswith("_other") for dim in variable.dims
        )
        if is_number and not stays and name in QUANTITIES and name not in archive.sizes:
            groups.setdefault(variable.dims, []).append(str(name))
    for dims, group in groups.items():
        yield _block(archive, dims, group, names)


def _block(
    archive: xr.Dataset, dims: tuple[Hashable, ...], group: list[str], specimens: list[str]
) -> Any:
    axes = [np.arange(archive.sizes[dim]) for dim in dims]
    if "cycle" in dims and archive.sizes["cycle"]:
        axes[dims.index("cycle")] = _kept_cycles(archive.sizes["cycle"])
    shape = tuple(len(axis) for axis in axes)
    values = np.stack([_at_kept_cycles(archive.variables[name]) for name in group])
    spread = np.full_like(values, np.nan)
    for row, name in enumerate(group):
        own = archive.variables.get(f"{name}_standard_uncertainty")
        if own is not None:
            missing = [axis for axis, dim in enumerate(dims) if dim not in own.dims]
            spread[row] = np.broadcast_to(np.expand_dims(_at_kept_cycles(own), missing), shape)
    # a quantity known at any place has rows for all places, missing if unknown, so that the order
    # is kept; a quantity without values is left out
    known = np.isfinite(values)
    has_any = known.reshape(len(group), -1).any(axis=1)
    found = np.nonzero(np.broadcast_to(has_any.reshape(-1, *[1] * len(dims)), values.shape))
    at = {dim: axes[axis][found[axis + 1]] for axis, dim in enumerate(dims)}
    n_values = len(found[0])
    place = {
        str(dim): _labels(archive, str(dim))[index]
        for dim, index in at.items()
        if dim != "specimen"
    }
    only = 0 if len(specimens) == 1 else _WHOLE
    specimen = np.full(n_values, only, np.int32)
    if "specimen" in at:
        specimen = at["specimen"].astype(np.int32)
    else:
        for dim, index in at.items():
            whose = f"{dim}_specimen"
            if whose in archive and archive.variables[whose].dims == (dim,) and specimens:
                number = {name: place for place, name in enumerate(specimens)}
                of_row = [number.get(str(name), _WHOLE) for name in archive.variables[whose].values]
                specimen = np.array(of_row, np.int32)[index]
    columns = {
        # the row of the whole test precedes those of its specimens
        "row": 1 + specimen,
        "quantity": np.array(group, object)[found[0]],
        "value": values[found],
        "standard_uncertainty": spread[found],
    } | place
    return pyarrow.table({name: _column(name, values) for name, values in columns.items()})


def _column(name: str, values: NDArray[Any]) -> Any:
    """A stored column of numbers; repeated texts are stored once."""
    column = pyarrow.array(values, _TYPES.get(name) or _column_type(name), from_pandas=True)
    return column.dictionary_encode() if pyarrow.types.is_string(column.type) else column


def _at_kept_cycles(variable: xr.Variable) -> Floats:
    """Values of a variable at the cycles kept; the others are not read.

    Through xarray, each index would be checked for being a Dask array, which imports Dask.
    """
    n_cycles = variable.sizes.get("cycle", 0)
    if n_cycles > _CYCLES_AT_ONCE:
        variable = variable.isel(cycle=_kept_cycles(n_cycles))
    values = np.asarray(variable.values, dtype=np.float64)
    if 0 < n_cycles <= _CYCLES_AT_ONCE:
        values = values.take(_kept_cycles(n_cycles), axis=variable.dims.index("cycle"))
    return values


def _labels(archive: xr.Dataset, dim: str) -> NDArray[Any]:
    """Text or number of each place along a dimension; counted from 1 if the archive has none."""
    is_text = _column_type(dim) == "string"
    if dim == "comparison" and {"ratio_numerator", "ratio_denominator"} <= set(archive.variables):
        pairs = zip(
            archive.variables["ratio_numerator"].values,
            archive.variables["ratio_denominator"].values,
            strict=True,
        )
        labels: NDArray[Any] = np.array([f"{over} over {under}" for over, under in pairs])
    elif dim not in archive.variables:
        labels = np.arange(1, archive.sizes[dim] + 1)
    else:
        labels = archive.variables[dim].values
    return labels.astype(str).astype(object) if is_text else labels.astype(float)
