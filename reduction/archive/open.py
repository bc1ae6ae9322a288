"""Opens archives with this major version of the schema."""

from __future__ import annotations

import json
import math
import pickle
import re
from collections.abc import Callable, Collection, Container, Hashable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from functools import cached_property
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any, Literal

import h5py
import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction import __version__
from reduction.archive.dataset_builder import (
    SCHEMA_NAME,
    SCHEMA_VERSION,
    as_read,
    build_dataset,
    variable_of,
)
from reduction.archive.scratch_file import ScratchFile
from reduction.quantities.names import (
    COMPARISON_SCHEMA,
    OUTCOME_SCHEMA,
    PREDICTION_SCHEMA,
    PROPERTY_SCHEMA,
    STEPWISE_SCHEMA,
    SURFACE_SCHEMA,
    TEST_SCHEMA,
)
from reduction.quantities.row import GROUPS, Quantity
from reduction.record.errors import ArchiveError, SettingsError

Chunks = int | Mapping[str, int | Literal["auto"] | tuple[int, ...]]
"""Chunk size in values, overall or by dimension, as for `xarray.open_dataset`."""

Opener = Callable[[Path], AbstractContextManager[xr.Dataset]]
"""Context manager that opens an archive, like `reading`."""

KeptArchive = bytes
"""A newly written archive, pickled, and passed unchanged from a worker to the scratch file."""

_CACHE = 1 << 20
"""Library cache for each variable in bytes: two chunks of an archive. The default of 64 MB would
hold everything read from a test, in addition to its results.
"""

LARGEST = 8_000_000  # bytes of unpacked values of an archive kept during a run

_ROOM = 2_000_000_000  # bytes of all archives on disk, beside archives of nearly the same size

_BESIDE = "_nc4_non_coord_"
"""Prefix for a variable named after a dimension without being its coordinate."""

_NO_VARIABLE = np.dtype(">f4")
"""Type of a dimension without a variable in the netCDF library."""

_OF_LIBRARY = re.compile(r"(\[Errno -\d+\] )?NetCDF: ")

_VERSION = re.compile(r"(\d{1,4})\.\d{1,4}", re.ASCII)

_MOST_PACKED = 1100  # maximum ratio of deflated values to the file size

_LONGEST_SETTINGS = 20_000_000

_TEXTS = (
    "id", "campaign", "test", "test_kind", "title", "raw_file", "raw_file_sha256", "raw_file_bytes",
    "raw_metadata", "settings", "key", "history", "command", "software_version", "synthetic",
)  # fmt: skip

_AGAIN = "Check the disk; take a copy that is whole, or remove it and run the campaign again."

# by a dimension unique to each kind; a reduced test has comparisons of specimens as well
_OF_CAMPAIGN: dict[str, dict[str, Quantity]] = {
    "experiment": SURFACE_SCHEMA,
    "outcome": OUTCOME_SCHEMA,
    "comparison_point": COMPARISON_SCHEMA,
    "hose": PREDICTION_SCHEMA,
    "property": PROPERTY_SCHEMA,
}


@contextmanager
def reading(path: Path) -> Iterator[xr.Dataset]:
    """Open an archive as a context manager, for reading its values.

    For a small archive of a test all values are read at once, which is faster than a query of each
    variable in the netCDF library.

    Yields
    ------
    dataset : xarray.Dataset
        Dataset as from `open_archive`.
    """
    own = _read_own(path)
    with failing_reads(str(path)), open_archive(path) if own is None else nullcontext(own) as found:
        yield found


class ReadOnce:
    """Reads small archives once, and then returns them from a scratch file.

    Opening an archive takes longer than reading all of a small one, since the library examines each
    of its 350 variables, and the steps of a run read each several times.  A call like `reading`
    gives an archive for the caller alone.  A file that has changed is read again.
    """

    def __init__(self) -> None:
        self._scratch = ScratchFile()
        self._kept: dict[Path, tuple[tuple[int, ...], slice]] = {}

    @contextmanager
    def __call__(self, path: Path) -> Iterator[xr.Dataset]:
        """Open an archive as a context manager, like `reading`."""
        stamp = _stamp_of(path)
        known, place = self._kept.get(path, ((), slice(0)))
        if stamp and known == stamp:
            content = self._scratch.get(place)
        else:
            with reading(path) as archive:
                if archive.nbytes > LARGEST or self._scratch.n_bytes > _ROOM:
                    yield archive
                    return
                content = pickle.dumps(in_memory(archive).copy())  # the copy has no file to close
            self._put(path, stamp, content)
        yield pickle.loads(content)  # noqa: S301  # of this object

    def keep(self, path: Path, written: KeptArchive) -> None:
        """Keep a newly written archive."""
        if self._scratch.n_bytes <= _ROOM:
            self._put(path, _stamp_of(path), written)

    def _put(self, path: Path, stamp: tuple[int, ...], content: bytes) -> None:
        with suppress(OSError):  # without disk space it is read again
            self._kept[path] = stamp, self._scratch.put(content)


def as_kept(written: xr.Dataset) -> KeptArchive | None:
    """A newly written archive as seen by a reader, for `keep_written`; None if large."""
    return pickle.dumps(_as_read(written)) if written.nbytes <= LARGEST else None


def keep_written(opener: Opener, path: Path, written: KeptArchive | None) -> None:
    """Keep a newly written archive, if the opener keeps archives."""
    if isinstance(opener, ReadOnce) and written is not None:
        opener.keep(path, written)


def _stamp_of(path: Path) -> tuple[int, ...]:
    found = path.stat() if path.is_file() else None
    return () if found is None else (found.st_mtime_ns, found.st_size, found.st_ino)


def _as_read(built: xr.Dataset) -> xr.Dataset:
    """Convert a dataset built for writing to the form that a reader gets.

    Its variables replace those of a copy, since building a new dataset takes four times as long.
    """
    found = built.copy(deep=False)
    for variable in found.variables.values():
        if variable.dtype.kind == "U":
            texts = variable.values.astype(object)
            # as a variable: for an array, xarray would import Dask to check its type
            variable.data = xr.Variable(variable.dims, texts, fastpath=True)
        variable.attrs = as_read(variable.attrs)
        variable.encoding = {}
    return found


def in_memory(archive: xr.Dataset) -> xr.Dataset:
    """Return the archive with all values read, so that its file can be closed.

    Like `xarray.Dataset.load`, which would import Dask to check whether the arrays are its own.
    """
    for variable in archive.variables.values():
        _ = variable.values  # kept by an archive opened without chunks
    return archive


def place_of(path: Path) -> tuple[str, float]:
    """Name of the test in an archive and its position in the history, infinite without one."""
    try:
        with h5py.File(path, "r", locking=False) as file:
            name, order = file.attrs["test"], file.attrs.get("test_order", "inf")
            return _as_text(name), float(_as_text(order))
    except (OSError, RuntimeError, KeyError, ValueError):
        with reading(path) as archive:  # reports any fault
            return str(archive.attrs["test"]), float(archive.attrs.get("test_order", "inf"))


def variables_if(
    path: Path, attributes: Mapping[str, str], names: Collection[str]
) -> xr.Dataset | None:
    """Return a few variables of a test archive; None if an attribute has another text."""
    schema = TEST_SCHEMA | STEPWISE_SCHEMA
    found: dict[str, tuple[tuple[str, ...], NDArray[Any]]] = {}
    try:
        with h5py.File(path, "r", locking=False) as file:
            if any(_as_text(file.attrs.get(key, "")) != text for key, text in attributes.items()):
                return None
            groups = (file.get(name) for name in GROUPS)  # a variable may have the name of a group
            places = [file, *(one for one in groups if isinstance(one, h5py.Group))]
            for place, name in product(places, names):
                for stored in (name, f"{_BESIDE}{name}"):
                    is_there = isinstance(place.get(stored, getlink=True), h5py.HardLink)
                    one = _Stored(place[stored].id) if is_there else None
                    if one is not None and one.dtype != _NO_VARIABLE:
                        found[name] = schema[name].dims, _values_of(one, schema[name])
    except (KeyError, RuntimeError, ValueError) as error:  # library errors on disk failure
        raise OSError(str(error)) from error
    return xr.Dataset(found)


def _as_text(value: Any) -> str:
    # a non-ASCII text is stored as an array with one string
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    return value.decode() if isinstance(value, bytes) else str(value)


def _read_own(path: Path) -> xr.Dataset | None:
    """Read a small test archive written by this version; None for any other.

    Dimensions and attributes of variables are taken from the schema instead of the file, which
    takes a fifth of the time.  Unusual files are left to `open_archive`.
    """
    # each is a file of another form, which `open_archive` reads or refuses with its reason
    with suppress(OSError, RuntimeError, KeyError, ValueError):
        refuse_no_file(path)
        with h5py.File(path, "r", locking=False) as file:
            attributes = {
                name: _as_text(text) for name, text in file.attrs.items() if name != "_NCProperties"
            }
            # products of a whole campaign have no test
            is_own = attributes.get("software_version") == __version__ and "test" in attributes
            if not is_own or attributes.get("schema_version") != SCHEMA_VERSION:
                return None
            held: dict[str, _Stored] = {}
            if _fault_in_group(file.id, path.stat().st_size, held=held) is not None:
                return None
            if sum(one.n_bytes for one in held.values()) > LARGEST:
                return None
            # a dimension without a variable is stored as a variable without values
            known = {name: one for name, one in held.items() if one.dtype != _NO_VARIABLE}
            schema = _schema_of_file(known)
            if schema not in (TEST_SCHEMA, STEPWISE_SCHEMA):
                return None
            values = {name: _values_of(known[name], row)
                      for name, row in schema.items() if name in known}  # fmt: skip
            if len(values) < len(known):
                return None
            known.clear()
            held.clear()  # otherwise the file searches for each of them on closing
        found = build_dataset(values, schema, attributes=attributes, is_stored=True)
        return found if _fault_of_form(found) is None else None
    return None


class _Stored:
    """A variable in a file; shape and type are queried once, because both take long."""

    def __init__(self, held: h5py.h5d.DatasetID) -> None:
        self.held, self.shape, self._type = held, held.shape or (), held.get_type()
        self.n_bytes = int(math.prod(self.shape) * self._type.get_size())  # unpacked

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """Type of its values."""
        found: np.dtype[Any] = self._type.dtype
        return found


def _values_of(stored: _Stored, row: Quantity) -> NDArray[Any]:
    """Read all values of a variable; `ValueError` if their type is not that of its row."""
    values = np.empty(stored.shape, "S1" if row.is_text else row.dtype)
    if stored.dtype != values.dtype:
        raise ValueError(row.name)
    stored.held.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
    if not row.is_text:
        return values
    words = values.view(f"S{values.shape[-1]}")[..., 0]
    return np.asarray(np.char.decode(words, "utf-8").astype(object))


@contextmanager
def failing_reads(what: str) -> Iterator[None]:
    """Convert netCDF library errors in a block to archive errors.

    Notes
    -----
    Values are read on demand, so that a disk may fail long after a file was opened. The library
    then raises `RuntimeError`, `AttributeError` or `OSError` without the file name.

    Examples
    --------
    >>> with failing_reads("processed/nylon/T-1.nc"):
    ...     raise RuntimeError("NetCDF: HDF error")
    Traceback (most recent call last):
    reduction.record.errors.ArchiveError: processed/nylon/T-1.nc cannot be read; found NetCDF: HDF
    error. Check the disk; take a copy that is whole, or remove it and run the campaign again.
    """
    try:
        yield
    except (AttributeError, OSError, RuntimeError) as error:
        if not _OF_LIBRARY.match(str(error)):
            raise
        found = _OF_LIBRARY.sub("NetCDF: ", _words(error))
        raise ArchiveError(f"{what} cannot be read", found=found, hint=_AGAIN) from error


def _words(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]


def open_archive(path: Path | str, *, chunks: Chunks | None = None) -> xr.Dataset:
    """Open an archive with root and groups combined; values are read on demand.

    Parameters
    ----------
    path : pathlib.Path or str
        A file written by `write_archive`.
    chunks : int or mapping of str to int or "auto", optional
        Chunk size in values by dimension; every variable is then a Dask array, with stored chunks
        for the dimensions not listed.

    Returns
    -------
    dataset : xarray.Dataset
        Text decoded, elapsed time as numbers. Close it, or use it with ``with``.

    Raises
    ------
    ArchiveError
        If the file is missing, damaged or not netCDF, or has another major version of the schema.
    SettingsError
        If Dask is requested and not installed, or refuses the chunks.
    """
    path = Path(path)
    refuse_no_file(path)
    try:
        _refuse(path, _fault_stored(path))
        with _small_cache():
            dataset = _opened(path)
    except ArchiveError:
        raise
    except UnicodeEncodeError as error:
        # a ValueError too, but about the name and not the file
        raise ArchiveError(
            f"{str(path)!a} cannot be given to the netCDF library",
            found=f"a name that {error.encoding} has no letters for",
            needed="a name in the character set of this process",
            hint="Set PYTHONUTF8=1, or take a locale of UTF-8, or rename the folder.",
        ) from error
    except (AttributeError, KeyError, OSError, RuntimeError, ValueError, TypeError) as error:
        # a TypeError from a text as scale
        raise ArchiveError(
            f"{path} cannot be read as a netCDF file",
            found=_words(error),
            needed="an archive of a reduced test",
            hint=_AGAIN,
        ) from error
    try:
        _refuse_schema(path, dataset.attrs)
        _refuse(path, _fault_of_form(dataset))
    except ArchiveError:
        dataset.close()
        raise
    if chunks is None:
        return dataset
    # the file is known to be an archive, so that a fault is one of the chunks
    dataset.close()
    return _open_in_chunks(path, chunks)


def _refuse_schema(path: Path, attributes: Mapping[str, object]) -> None:
    """Refuse another major version, or a file without a schema; minor versions only add."""
    name, version = (attributes.get(f"schema_{part}") for part in ("name", "version"))
    stated = _VERSION.fullmatch(version) if isinstance(version, str) else None
    is_ours = name in (None, SCHEMA_NAME)
    major = SCHEMA_VERSION.partition(".")[0]
    if is_ours and stated is not None and stated[1] == major:
        return
    if is_ours and stated is not None and int(stated[1]) > int(major):
        software = str(attributes.get("software_version", "of unknown version"))[:40]
        raise ArchiveError(
            f"{path} was written by a later version of this software",
            found=f"schema version {stated[0]}, software {software}",
            needed=f"schema version {major}.x",
            hint="Open it with that version, or reduce the test again with this one.",
        )
    what = "none" if version is None else f"version {str(version)[:40]}"
    raise ArchiveError(
        f"{path} has another schema",
        found=what if is_ours else f"{str(name)[:40]}, {what}",
        needed=f"{SCHEMA_NAME}, version {major}.x",
        hint="Reduce the test again with this version.",
    )


def refuse_no_file(path: Path) -> None:
    """Refuse what cannot be opened as a file; a pipe would wait forever for its other end."""
    if path.is_file():
        return
    if path.exists():
        raise ArchiveError(
            f"{path} is not an archive",
            found="a folder" if path.is_dir() else "a pipe, a socket or a device",
            needed="a file",
            hint="Move it away.",
        )
    raise ArchiveError(f"there is no archive {path}", hint="Run the campaign first.")


def _opened(path: Path, chunks: Chunks | None = None) -> xr.Dataset:
    """All groups of a file as one dataset, with variables in schema order."""
    groups = xr.open_groups(
        path,
        engine="netcdf4",
        decode_times=False,
        decode_timedelta=False,
        chunks=chunks,
        create_default_indexes=False,
    )
    root = groups["/"]
    variables = {
        name: variable for one in groups.values() for name, variable in one.variables.items()
    }
    places = {name: place for place, name in enumerate(_schema_of_file(root.sizes))}
    ordered = sorted(variables, key=lambda name: places.get(str(name), len(places)))
    coordinates = {name for one in groups.values() for name in one.coords}
    merged = xr.Dataset(
        {name: variables[name] for name in ordered if name not in coordinates},
        {name: _label_of(name, variables[name]) for name in ordered if name in coordinates},
        root.attrs,
    )
    merged.encoding = root.encoding

    def close() -> None:
        for one in groups.values():
            one.close()

    merged.set_close(close)
    return merged


def _label_of(name: Hashable, variable: xr.Variable) -> xr.Variable:
    """Return the labels of a dimension as an index, and other coordinates unchanged."""
    if variable.dims != (name,):
        return variable
    return variable_of(
        str(name),
        variable.dims,
        variable.values,
        attributes=variable.attrs,
        encoding=variable.encoding,
    )


def _refuse(path: Path, fault: str | None) -> None:
    if fault is not None:
        raise ArchiveError(
            f"{path} is not made as an archive is",
            found=fault,
            needed="the variables and attributes that a run writes",
            hint="Take the archive as a run wrote it, or reduce the campaign again.",
        )


def _fault_stored(path: Path) -> str | None:
    """Fault of values stored in other files, or larger than the file can hold."""
    with h5py.File(path, "r", locking=False) as file:
        return _fault_in_group(file.id, path.stat().st_size)


def _fault_in_group(
    group: h5py.h5g.GroupID,
    size: int,
    inside: str = "",
    held: dict[str, _Stored] | None = None,
) -> str | None:
    links = group.links
    for raw in group:
        name = inside + raw.decode(errors="replace")[:80]
        if links.get_info(raw).type != h5py.h5l.TYPE_HARD:
            return f"a link '{name}'"
        one = h5py.h5o.open(group, raw)
        if isinstance(one, h5py.h5g.GroupID) and name in GROUPS:
            fault = _fault_in_group(one, size, f"{name}/", held)
            if fault is not None:
                return fault
            continue
        if not isinstance(one, h5py.h5d.DatasetID):
            return f"'{name}', which is no variable"
        made = one.get_create_plist()
        if made.get_layout() == h5py.h5d.VIRTUAL or made.get_external_count():
            return f"a variable '{name}' whose values lie in other files"
        stored = _Stored(one)
        if stored.n_bytes > _MOST_PACKED * size:
            return f"a variable '{name}' of {stored.n_bytes:,} bytes in a file of {size:,}"
        if held is not None:
            own = raw.decode().removeprefix(_BESIDE)
            if own not in held or held[own].dtype == _NO_VARIABLE:
                held[own] = stored
    return None


def _fault_of_form(dataset: xr.Dataset) -> str | None:
    """Fault of variables and attributes of a wrong kind; no values are read."""
    for key in _TEXTS:
        if not isinstance(dataset.attrs.get(key, ""), str):
            return f"attribute {key} that is no text"
    is_of_a_test = "diameter" in dataset.variables and not _OF_CAMPAIGN.keys() & set(dataset.dims)
    if is_of_a_test and not dataset.attrs.get("test"):
        return "no attribute test"
    settings = dataset.attrs.get("settings", "")
    if len(settings) > _LONGEST_SETTINGS:
        return f"settings of {len(settings):,} characters"
    if settings and not _is_json_object(settings):
        return "settings that are no JSON object"
    for label, index in dataset.indexes.items():  # already in memory
        values = index.to_numpy()
        if values.dtype.kind == "f" and not np.all(np.isfinite(values)):
            return f"coordinate {label} that is not finite"
    schema = _schema_of_file(dataset.dims)
    for name, variable in dataset.variables.items():
        row = schema.get(str(name))
        if row is None:  # added to the file by another program
            continue
        if {"scale_factor", "add_offset"} & set(variable.encoding):
            return f"{name} that is packed"
        if variable.dims != row.dims:
            return f"{name} along {', '.join(map(str, variable.dims)) or 'nothing'}"
        if variable.dtype.kind not in ("SUOT" if row.is_text else "fiu"):
            return f"{name} of type {np.dtype(variable.dtype)}"
    return None


def _is_json_object(text: str) -> bool:
    try:
        return isinstance(json.loads(text), dict)
    except (RecursionError, ValueError):
        return False


def _schema_of_file(dimensions: Container[Hashable]) -> Mapping[str, Quantity]:
    """Possible contents of a file, from a dimension unique to its kind."""
    for dimension, schema in _OF_CAMPAIGN.items():
        if dimension in dimensions:
            return schema
    return STEPWISE_SCHEMA if "step" in dimensions else TEST_SCHEMA


@contextmanager
def _small_cache() -> Iterator[None]:
    """Reduce the cache of files opened in the block; others are unaffected."""
    before = netCDF4.get_chunk_cache()
    netCDF4.set_chunk_cache(_CACHE)
    try:
        yield
    finally:
        netCDF4.set_chunk_cache(*before)


def _open_in_chunks(path: Path, chunks: Chunks) -> xr.Dataset:
    if find_spec("dask") is None:
        raise SettingsError(
            "chunks need Dask",
            found="no package of that name",
            needed="dask",
            hint='Install "mooring-reduction[cluster]", or leave chunks out: values are read '
            "when they are asked for all the same.",
        )
    try:
        return _opened(path, chunks=chunks)
    except (AttributeError, TypeError, ValueError, NotImplementedError) as error:
        raise SettingsError(
            "archives cannot be cut in these chunks",
            found=f"{chunks!r}: {str(error).splitlines()[0]}",
            needed='a number of values, or "auto", by the name of a dimension',
        ) from error
