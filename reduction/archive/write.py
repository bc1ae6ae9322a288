"""Writes archives: a netCDF file is written completely or not at all.

Statements on persons, dates, instruments and limits are separate from the archives. They affect no
number, so that a report can be amended without changing any archive.  An empty text was not stated;
a report shows it as such and never omits it.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8 (what a report of tests holds).
"""

from __future__ import annotations

import datetime
import hashlib
import shutil
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Generic, Literal, TypeVar

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
)

from reduction.archive.atomic_write import atomic_file, remove_abandoned, take_away
from reduction.quantities.row import GROUPS
from reduction.record.errors import ArchiveError
from reduction.record.samples import release_pages, sample_blocks
from reduction.uncertainty.budget import DecisionRule

_BLOCK = 1 << 20  # values along the last dimension written together: whole chunks

_CACHE = 1 << 19  # bytes of the largest chunk: each is written once


def _write_netcdf(dataset: xr.Dataset, path: Path) -> str:
    """Write a dataset from `build_dataset`, and return the checksum of its values."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(dataset.attrs)
        for name, size in dataset.sizes.items():
            file.createDimension(str(name), size)
        placed = sorted(_placed(dataset), key=lambda one: one[0])
        for group in dict.fromkeys(group for group, _ in placed if group):
            file.createGroup(group).setncattr("comment", GROUPS[group])
        todo = [
            (
                _defined(file[group] if group else file, name, dataset.variables[name]),
                dataset.variables[name].values,
            )
            for group, name in placed
        ]
        written = hashlib.sha256()
        for place, values in todo:
            letters = _characters(values) if values.dtype.kind in "UO" else values
            written.update(place.name.encode())
            for part in _parts(letters.shape, letters):
                place[part] = letters[part]
                written.update(letters[part].tobytes())
            release_pages(values)
        file.setncattr("values_sha256", written.hexdigest())
    return written.hexdigest()


def _placed(dataset: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Group and name of each variable; a group has the coordinates missing from the root."""
    groups_of: dict[Hashable, dict[str, None]] = {}
    for variable in dataset.variables.values():
        for dim in variable.dims:
            if (
                variable.dims != (dim,)
                or dim not in dataset.variables
                or (dataset.variables[dim] is not variable)
            ):
                groups_of.setdefault(dim, {})[variable.encoding.get("group", "")] = None
    axes = {name for name, one in dataset.variables.items() if one.dims == (name,)}
    edges = {dataset.variables[axis].attrs.get("bounds"): axis for axis in axes}
    for name, variable in dataset.variables.items():
        axis = name if name in axes else edges.get(name)
        groups = groups_of.get(axis, {}) if axis is not None else {}
        if not groups or "" in groups:
            groups = {"" if groups else variable.encoding.get("group", ""): None}
        for group in groups:
            yield group, str(name)


def values_sha256(path: Path) -> str:
    """Checksum of the names and values of all variables currently in a file."""
    found = hashlib.sha256()
    with netCDF4.Dataset(path) as file:
        for group in (file, *file.groups.values()):
            group.set_auto_maskandscale(False)
            group.set_auto_chartostring(False)
            for name, variable in group.variables.items():
                found.update(name.encode())
                for part in _parts(variable.shape):
                    found.update(np.asarray(variable[part]).tobytes())
    return found.hexdigest()


def _defined(file: netCDF4.Dataset, name: str, variable: xr.Variable) -> netCDF4.Variable[Any]:
    """Define a variable according to its encoding."""
    encoding, dims = variable.encoding, tuple(str(dim) for dim in variable.dims)
    attributes = dict(variable.attrs)
    kind: Any = variable.dtype
    if variable.dtype.kind in "UO":  # labels of a dimension are objects
        length = f"{name}_strlen"
        file.createDimension(length, _characters(variable.values).shape[-1])
        kind, dims = "S1", (*dims, length)
        attributes["_Encoding"] = "utf-8"
    if "coordinates" in encoding:
        attributes["coordinates"] = encoding["coordinates"]
    options = {
        key: encoding[key]
        for key in ("zlib", "complevel", "shuffle", "chunksizes")
        if key in encoding
    }
    # with a checksum per chunk the library refuses corrupted values; a short variable would take
    # several times its size in chunks
    place = file.createVariable(
        name, kind, dims, fill_value=encoding.get("_FillValue"), fletcher32=bool(options), **options
    )
    if options:
        place.set_var_chunk_cache(_CACHE)
    place.set_auto_maskandscale(False)
    place.set_auto_chartostring(False)
    place.setncatts(attributes)
    return place


def _characters(values: NDArray[Any]) -> NDArray[np.bytes_]:
    """Text as UTF-8 bytes along an additional dimension."""
    encoded = np.char.encode(values.astype(np.str_, copy=False), "utf-8")
    letters = encoded.astype(f"S{max(encoded.dtype.itemsize, 1)}")
    return np.ascontiguousarray(letters).view("S1").reshape(*values.shape, letters.dtype.itemsize)


def _parts(shape: tuple[int, ...], *arrays: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Blocks of each series in order, or the whole array if it is short."""
    if not shape or shape[-1] <= _BLOCK:
        yield (...,)
        return
    for row in np.ndindex(shape[:-1]):
        for part in sample_blocks(shape[-1], *arrays, size=_BLOCK):
            yield (*row, part)


def write_archive(dataset: xr.Dataset, path: Path) -> xr.Dataset:
    """Write a dataset from `reduction.archive.test_dataset.to_dataset` as one netCDF file.

    Returns it with the attribute added in writing: the checksum of its values.
    """
    try:
        with atomic_file(path) as part:
            written = _write_netcdf(dataset, part)
        return dataset.assign_attrs(values_sha256=written)
    except ArchiveError:
        raise
    except (OSError, RuntimeError) as error:
        raise _not_written(path, error) from error


def write_text_atomically(path: Path, *pieces: str | bytes) -> None:
    """Write a UTF-8 text file completely or not at all, with line ends unchanged."""
    with append_atomically(path) as append:
        for one in pieces:
            append(one)


@contextmanager
def append_atomically(path: Path) -> Iterator[Callable[[str | bytes], None]]:
    """Yield a function that appends to a file, which appears only if the block succeeds."""
    is_in_block = False
    remove_abandoned(path)
    try:
        with atomic_file(path) as part:
            is_in_block = True
            yield partial(_append, part, path)
            is_in_block = False
    except OSError as error:
        if is_in_block or isinstance(error, ArchiveError):  # of another file, or complete
            raise
        raise _not_written(path, error) from error


def _append(part: Path, path: Path, text: str | bytes) -> None:
    try:
        with part.open("ab") as file:
            file.write(text.encode("utf-8") if isinstance(text, str) else text)
    except OSError as error:
        raise _not_written(path, error) from error


def _not_written(path: Path, error: Exception) -> ArchiveError:
    found = getattr(error, "strerror", None)
    if not isinstance(found, str) or (getattr(error, "errno", None) or 0) < 0:
        # netCDF library error numbers, which hide the system's message
        with suppress(OSError):
            free = shutil.disk_usage(path.parent).free
            found = f"{error}, with {free / 1e6:.0f} MB free on the disk"
    return ArchiveError(
        f"{path} cannot be written",
        found=found or str(error),
        hint="What was there before is kept. Check the folder and the space on the disk.",
    )


FILE_NAME = "report.json"

Paper = Literal["A4", "Letter"]

ReportText = Annotated[str, StringConstraints(max_length=4000, strip_whitespace=True)]


def _as_text(value: object) -> object:
    """A date of TOML as text, unchanged."""
    return value.isoformat() if isinstance(value, datetime.date) else value


Date = Annotated[ReportText, BeforeValidator(_as_text)]
"""A TOML date, or text: ``2026-03-05``, ``"2 to 5 March 2026"``."""


class ReportSection(BaseModel):
    """A table of ``[report]``."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Laboratory(ReportSection):
    """``[report.laboratory]``."""

    name: ReportText = ""
    address: ReportText = ""
    contact: ReportText = ""
    location: ReportText = ""
    """Place of the tests, if it is not the address."""
    accreditation: ReportText = ""


class Client(ReportSection):
    """``[report.client]``."""

    name: ReportText = ""
    address: ReportText = ""
    contact: ReportText = ""
    order: ReportText = ""


class ReportItem(ReportSection):
    """``[report.items.SPECIMEN]``: an item received."""

    identification: ReportText = ""
    """Marking on it: a serial number, a tag."""
    description: ReportText = ""
    condition: ReportText = ""
    """Condition on receipt."""
    received: Date = ""


class _Authorised(ReportSection):
    """``[report.authorised]``."""

    by: ReportText = ""
    function: ReportText = ""
    on: Date = ""


class Instrument(ReportSection):
    """``[[report.instruments]]``: one instrument with its last calibration."""

    name: ReportText
    identification: ReportText = ""
    certificate: ReportText = ""
    traceable_to: ReportText = ""
    calibrated: Date = ""
    due: Date = ""


class ReportLimit(ReportSection):
    """A limit for a number of a test, with at least one end.

    Parameters
    ----------
    quantity : str
        Name in the vocabulary.
    test : str
        Id of the product of a test or a step.
    at : dict of str to str
        Place of the number along each dimension, as for `reduction budget`.
    lower, upper : float or None
        Ends in SI. [unit of the quantity]
    source : str
        Source of the limit.
    """

    quantity: str
    test: str
    at: dict[str, str] = Field(default_factory=dict)
    lower: float | None = None
    upper: float | None = None
    source: str = ""


AnyLimit = TypeVar("AnyLimit")


class Statement(ReportSection, Generic[AnyLimit]):
    """``[report]``: all keys are optional; the report says which are not stated."""

    number: ReportText = ""
    revision: int = Field(default=0, ge=0)
    amendment: ReportText = ""
    """Changes in this revision, and the report it replaces."""
    issued: Date = ""
    received: Date = ""
    """Date of receipt, if the items arrived together."""
    tested: Date = ""
    method: ReportText = ""
    deviations: ReportText = ""
    """Deviations from the method: ``"none"`` if there were none."""
    sampling: ReportText = ""
    environment: ReportText = ""
    opinions: ReportText = ""
    """Opinions and interpretations, marked as such in the report."""
    decision_rule: DecisionRule | None = None
    """Required if a limit is given."""
    paper: Paper = "A4"
    laboratory: Laboratory = Laboratory()
    client: Client = Client()
    authorised: _Authorised = _Authorised()
    items: dict[str, ReportItem] = Field(default_factory=dict)
    instruments: tuple[Instrument, ...] = ()
    limits: tuple[AnyLimit, ...] = ()


class ReportDetails(Statement[ReportLimit]):
    """Statements of the laboratory, with limits in SI."""


def keep_details(folder: Path, details: ReportDetails | None) -> None:
    """Write the statements of the laboratory, or remove those of an earlier run."""
    path = folder / FILE_NAME
    if details is None:
        take_away(path)
        return
    write_text_atomically(path, details.model_dump_json(indent=1) + "\n")


def read_details(folder: Path) -> ReportDetails | None:
    """Read the statements of the laboratory."""
    path = folder / FILE_NAME
    if not path.is_file():
        return None
    try:
        return ReportDetails.model_validate_json(path.read_bytes())
    except (OSError, ValidationError) as error:
        raise ArchiveError(
            f"{path} cannot be read",
            found=str(error).splitlines()[0],
            needed="what a run keeps of [report]",
            hint="Run the campaign again.",
        ) from error
