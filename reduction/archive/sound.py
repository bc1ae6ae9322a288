"""Whether a file that says it is an archive is made as one, before anything is read from it."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterator
from pathlib import Path

import h5py  # type: ignore[import-untyped]
import numpy as np
import xarray as xr

from reduction.archive.check import schema_of_file
from reduction.errors import ArchiveError
from reduction.globalheap import endless_heap

__all__ = ["check_form", "check_stored"]

_MOST_PACKED = 1100  # times that deflated values can be larger than the file
_LONGEST_SETTINGS = 20_000_000
_TEXTS = (
    "id", "campaign", "test", "test_kind", "title", "raw_file", "raw_file_sha256", "raw_file_bytes",
    "raw_metadata", "settings", "history", "command", "software_version", "synthetic",
)  # fmt: skip
_OF_PARTS = {"experiment", "outcome", "comparison_point", "hose", "property"}
_ERROR_NUMBER = re.compile(r"\berrno = ([1-9]\d{0,3})\b")
_HINT = "Take the archive as a run wrote it, or reduce the campaign again."


def check_stored(path: Path) -> None:
    """Refuse values that lie in other files, or of which the file can hold but a part.

    Parameters
    ----------
    path : pathlib.Path
        A file; one that is no HDF5 is left to the library that opens it.

    Raises
    ------
    ArchiveError
        If it has links, groups, virtual variables, external storage, shapes beyond its size or
        texts that the library would look for without end, or the disk refuses.

    Notes
    -----
    The library that reads archives follows links to other files, and takes values from any file.
    """
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        _refuse_disk(path, error)
        return
    with file:
        try:
            with path.open("rb") as plain:
                fault = endless_heap(plain, file.id.get_create_plist().get_sizes()[1])
            fault = fault or next(_faults_stored(file.id, path.stat().st_size), None)
        except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
            _refuse_disk(path, error)
            fault = f"what cannot be read: {str(error).splitlines()[0][:200]}"
    if fault is not None:
        raise _no_archive(path, fault)


def _refuse_disk(path: Path, error: Exception) -> None:
    """Where the system refused, say what it said; the library puts it into its own words."""
    told = _ERROR_NUMBER.search(str(error))
    number = int(told[1]) if told else getattr(error, "errno", None)
    if number:
        raise ArchiveError(
            f"{path} cannot be read",
            found=os.strerror(number),
            hint="Check the disk, and take a copy that is whole.",
        ) from error


def _faults_stored(root: h5py.h5g.GroupID, size: int) -> Iterator[str]:
    for raw in root:
        name = raw.decode(errors="replace")[:80]
        if root.links.get_info(raw).type != h5py.h5l.TYPE_HARD:
            yield f"a link '{name}'"
            continue
        held = h5py.h5o.open(root, raw)
        if isinstance(held, h5py.h5g.GroupID):
            yield f"a group '{name}'"
        if not isinstance(held, h5py.h5d.DatasetID):
            continue
        made = held.get_create_plist()
        if made.get_layout() == h5py.h5d.VIRTUAL or made.get_external_count():
            yield f"a variable '{name}' whose values lie in other files"
        n_bytes = math.prod(held.shape or ()) * held.get_type().get_size()
        if n_bytes > _MOST_PACKED * size:
            yield f"a variable '{name}' of {n_bytes:,} bytes in a file of {size:,}"


def check_form(path: Path, dataset: xr.Dataset) -> None:
    """Refuse variables of another type or along other dimensions than archives have them.

    Parameters
    ----------
    path : pathlib.Path
        For the message.
    dataset : xarray.Dataset
        The open file; no values are read.

    Raises
    ------
    ArchiveError
        If a variable or an attribute is not of its kind.
    """
    fault = next(_faults_of_form(dataset), None)
    if fault is not None:
        raise _no_archive(path, fault)


def _faults_of_form(dataset: xr.Dataset) -> Iterator[str]:
    for key in _TEXTS:
        if not isinstance(dataset.attrs.get(key, ""), str):
            yield f"attribute {key} that is no text"
    is_of_a_test = "diameter" in dataset.variables and not _OF_PARTS & set(dataset.dims)
    if is_of_a_test and not dataset.attrs.get("test"):
        yield "no attribute test"
    settings = dataset.attrs.get("settings", "")
    if len(settings) > _LONGEST_SETTINGS:
        yield f"settings of {len(settings):,} characters"
    elif settings and not _is_json_object(settings):
        yield "settings that are no JSON object"
    for label, index in dataset.indexes.items():  # in memory already
        values = index.to_numpy()
        if values.dtype.kind == "f" and not np.all(np.isfinite(values)):
            yield f"coordinate {label} that is not finite"
    schema = schema_of_file({str(name) for name in dataset.dims})
    for name, variable in dataset.variables.items():
        row = schema.get(str(name))
        if row is None:  # of another program, which may add to a file
            continue
        if {"scale_factor", "add_offset"} & set(variable.encoding):
            yield f"{name} that is packed"
        if variable.dims != row.dims:
            yield f"{name} along {', '.join(map(str, variable.dims)) or 'nothing'}"
        kinds = "SUOT" if row.is_text else "fiu"
        if variable.dtype.kind not in kinds:
            yield f"{name} of type {np.dtype(variable.dtype)}"


def _is_json_object(text: str) -> bool:
    try:
        return isinstance(json.loads(text), dict)
    except (json.JSONDecodeError, RecursionError, ValueError):
        return False


def _no_archive(path: Path, found: str) -> ArchiveError:
    return ArchiveError(
        f"{path} is not made as an archive is",
        found=found,
        needed="the variables and attributes that a run writes",
        hint=_HINT,
    )
