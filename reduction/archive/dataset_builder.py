"""Builds a dataset that follows CF: dimensions, variables, global attributes.

Every attribute is a text, not a list: a list with one entry does not survive netCDF. Several raw
files have one line each, as have the stages in ``history``.
"""

from __future__ import annotations

import hashlib
import json
import re
import zlib
from collections.abc import Hashable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.variables import Values
from reduction.quantities.row import Quantity
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Origin, Source, Step
from reduction.record.notes import note_message
from reduction.record.samples import release_pages
from reduction.stages.reduced_test import ReducedTest

SCHEMA_NAME = "mooring-reduction archive"

SCHEMA_VERSION = "1.0"
"""The first number rises if a name, group, dimension, unit or meaning is changed or removed, the
second if one is added: a reader of 1.0 can read 1.7.
"""

_COMPRESSED_FROM = 4096  # values; below it a chunk with its index costs more than it saves

_TRIED = 16384  # values used to test compression

_CHUNK = 65536  # values; half a megabyte, the cost of reading a cycle from a long record


def build_dataset(
    values: Values,
    schema: Mapping[str, Quantity],
    *,
    attributes: Mapping[str, str],
    is_stored: bool = False,
) -> xr.Dataset:
    """Convert arrays to the archive dataset, in schema order.

    Arrays that were stored before get no new storage settings.
    """
    unknown = sorted(set(values) - set(schema))
    if unknown:
        raise ArchiveError("values without a place in the schema", found=", ".join(unknown))
    # zero-length dimensions would become unlimited in a file, so empty arrays are left out
    present = {name: values[name] for name in schema if name in values and values[name].size}
    sizes = _sizes(present, schema)
    auxiliary = schema["time"].dims[0] if "time" in present else ""
    variables = {
        name: _stored(array, schema[name], present)
        if is_stored
        else _variable(array, schema[name], present, auxiliary)
        for name, array in present.items()
    }
    coordinates = {name for name in variables if name == "time" or name in sizes}
    return xr.Dataset(
        data_vars={name: one for name, one in variables.items() if name not in coordinates},
        coords={name: one for name, one in variables.items() if name in coordinates},
        attrs=dict(attributes),
    )


def _sizes(values: Values, schema: Mapping[str, Quantity]) -> dict[str, int]:
    """Length of every dimension; refuse an array that does not match the others."""
    sizes: dict[str, int] = {}
    for name, array in values.items():
        dims = schema[name].dims
        fits = array.ndim == len(dims) and all(
            sizes.setdefault(dim, length) == length
            for dim, length in zip(dims, array.shape, strict=True)
        )
        if not fits:
            needed = ", ".join(f"{dim} {sizes.get(dim, '?')}" for dim in dims)
            raise ArchiveError(
                f"{name} does not fit its dimensions",
                found=f"shape {array.shape}",
                needed=needed or "a scalar",
            )
    return sizes


def _variable(array: NDArray[Any], row: Quantity, present: Values, auxiliary: str) -> xr.Variable:
    made = variable_of(
        row.name,
        row.dims,
        array if row.is_text else array.astype(row.dtype, copy=False),
        attributes=_attributes(row, present),
        encoding={"group": row.group} | _encoding(array, row, auxiliary),
    )
    release_pages(array)
    return made


def _stored(array: NDArray[Any], row: Quantity, present: Values) -> xr.Variable:
    return variable_of(row.name, row.dims, array, attributes=as_read(_attributes(row, present)))


def as_read(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Variable attributes in the form that a reader gets: a single number is not an array."""
    return {
        name: value[0] if isinstance(value, np.ndarray) and value.size == 1 else value
        for name, value in attributes.items()
    }


def variable_of(
    name: str,
    dims: tuple[Hashable, ...],
    values: NDArray[Any],
    *,
    attributes: Mapping[str, Any],
    encoding: Mapping[str, Any] | None = None,
) -> xr.Variable:
    """Make a variable from an array unchanged; labels of a dimension become an index.

    For labels that are not an index, xarray would import pint to check their type, which takes
    longer than reading a test.
    """
    if dims != (name,):
        return xr.Variable(dims, values, attributes, encoding, fastpath=True)
    index = pd.Index(values, dtype=object if values.dtype.kind in "UO" else None)
    made: xr.IndexVariable = xr.IndexVariable(dims, index, attributes, encoding)
    return made


def _attributes(row: Quantity, present: Values) -> dict[str, Any]:
    if row.is_bounds:
        return {}
    attributes: dict[str, Any] = {"long_name": row.long_name}
    if row.standard_name is not None:
        attributes["standard_name"] = row.standard_name
    if row.flags:
        kind = "flag_masks" if row.is_mask else "flag_values"
        attributes[kind] = np.array(list(row.flags.values()), dtype=row.dtype)
        attributes["flag_meanings"] = " ".join(row.flags)
    elif not row.is_text:
        attributes["units"] = row.unit
    companions = [name for name in row.ancillary if name in present]
    if companions:
        attributes["ancillary_variables"] = " ".join(companions)
    if row.bounds in present:
        attributes["bounds"] = row.bounds
    return attributes


def _encoding(array: NDArray[Any], row: Quantity, auxiliary: str) -> dict[str, Any]:
    # labels are not listed: readers find them under the names of their dimensions, and CF advises
    # against listing an array that shares the name of its dimension
    is_beside = auxiliary and auxiliary in row.dims and row.name != "time"
    listed = {"coordinates": "time"} if is_beside else {}
    if row.is_text:
        return {"dtype": "S1", "char_dim_name": f"{row.name}_strlen"} | listed
    is_coordinate = row.is_bounds or row.name == "time" or row.dims == (row.name,)
    has_gaps = row.dtype == "f8" and not is_coordinate
    encoding: dict[str, Any] = {"dtype": row.dtype, "_FillValue": np.nan if has_gaps else None}
    encoding |= listed
    if array.size >= _COMPRESSED_FROM:
        encoding |= {
            "zlib": True,
            "complevel": 1,
            "shuffle": _is_smaller_shuffled(array),
            "chunksizes": _chunk_sizes(array.shape),
        }
    return encoding


def _is_smaller_shuffled(array: NDArray[Any]) -> bool:
    """Whether its numbers compress better after a byte shuffle."""
    if array.size < _CHUNK:
        return True
    quarter = array.size // 4  # within the first of two specimens
    tried = array.reshape(-1)[quarter : quarter + _TRIED]
    octets = np.frombuffer(tried.tobytes(), dtype=np.uint8).reshape(tried.size, tried.itemsize)
    shuffled, plain = (len(zlib.compress(one.tobytes(), 1)) for one in (octets.T, octets))
    return shuffled <= plain


def _chunk_sizes(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Chunk of at most `_CHUNK` values: filled from the last dimension to the first."""
    sizes: list[int] = []
    left = _CHUNK
    for length in reversed(shape):
        sizes.append(min(length, left))
        left //= sizes[-1]
    return tuple(reversed(sizes))


PartName = Literal["surfaces", "outcomes", "predictions", "comparisons", "change_in_length"]

CONVENTIONS = "CF-1.11 ACDD-1.3"

_SOFTWARE = "mooring-reduction"

_PROPAGATION = "first order (JCGM 100:2008)"

# a line bends where E' is near K_0: each test states the method for its uncertainty
_OF_LINE = "; K_1, tau and K_1 tau as test_line_uncertainty_method says (JCGM 101:2008)"

_KEYWORDS = "mooring, tension test, elastic modulus, hysteresis"

_OF_PART: dict[PartName, tuple[str, str]] = {
    "surfaces": (
        "Response surfaces and effects of experiment {names}.",
        "mooring, designed experiment, response surface, spring constant",
    ),
    "outcomes": (
        "Strength, strain at failure and life of lines, without logs.",
        "mooring, tensile strength, fatigue, abrasion, exposure",
    ),
    "predictions": (
        "Load and fill pressure of {names}, from construction alone.",
        "mooring, stretch hose, tire cord, load elongation, prediction",
    ),
    "comparisons": (
        "Measured curves against their predictions: {names}.",
        "mooring, stretch hose, validation, measured against predicted",
    ),
    "change_in_length": (
        "Change-in-length properties of {names}.",
        "mooring, rope, stiffness, change in length, creep",
    ),
}

_LEGAL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def _status(test: ReducedTest) -> str:
    """Status with the gravest warning, for a reader who sees only the root of the archive."""
    notes = test.all_notes()
    others = sum(one.severity == "warning" for one in notes) - 1
    if others < 0:
        return "reduced"
    more = f" (and {others} more in the group notes)" if others else ""
    return f"check: {note_message(notes)}{more}"


def global_attributes(
    test: ReducedTest, *, version: str, command: str, samples: str = "all"
) -> dict[str, str]:
    """Return the global attributes in fixed order, without empty ones."""
    about = test.description
    names = " and ".join(one.name for one in test.specimens)
    return _complete(
        about.attributes,
        {
            "summary": f"Reduced {about.kind} test {about.test_id} of specimen {names}.",
            "keywords": _KEYWORDS,
            "id": f"{about.campaign_id}/{about.test_id}",
            "campaign": about.campaign_id,
            "test": about.test_id,
            "test_kind": about.kind,
            "control": about.control,
            "waveform": about.waveform,
            "test_order": "" if about.order is None else str(about.order),
            "test_status": _status(test),
            **_raw_files(test.sources),
            "uncertainty_propagation": _PROPAGATION
            + ("" if test.line_spread is None else _OF_LINE),
            "raw_metadata": "" if test.record is None else _as_json(test.record.metadata),
            "stored_samples": "" if test.record is None else samples,
            "settings": test.settings_json,
            "key": key_of(test.settings_json),
        },
        steps=test.all_steps(),
        version=version,
        command=command,
    )


def part_attributes(part: PartName, names: Sequence[str] = (), *, origin: Origin) -> dict[str, str]:
    """Return the global attributes for an archive of part of a campaign, in the same order."""
    summary, keywords = _OF_PART[part]
    return _complete(
        origin.attributes,
        {
            "summary": summary.format(names=" and ".join(names)),
            "keywords": keywords,
            "id": f"{origin.campaign_id}/{part}",
            "campaign": origin.campaign_id,
            **_raw_files(origin.sources),
            "uncertainty_propagation": _PROPAGATION,
            "settings": origin.settings_json,
            "key": key_of(origin.settings_json),
        },
        steps=origin.steps,
        version=origin.version,
        command=origin.command,
    )


def key_of(settings_json: str) -> str:
    """Key of a product beside its raw files and version: SHA-256 of its settings."""
    return hashlib.sha256(settings_json.encode()).hexdigest()


def _raw_files(sources: Sequence[Source]) -> dict[str, str]:
    return {
        "raw_file": "\n".join(one.name for one in sources),
        "raw_file_sha256": "\n".join(one.sha256 for one in sources),
        "raw_file_bytes": "\n".join(str(one.size) for one in sources),
    }


def _complete(
    attributes: Mapping[str, str],
    product: dict[str, str],
    *,
    steps: Sequence[Step],
    version: str,
    command: str,
) -> dict[str, str]:
    """Attributes from the laboratory and of the product, with those common to all products."""
    given = dict(attributes)
    title = given.pop("title", f"Campaign {product['campaign']}")
    source = given.pop("source", "")
    if given.get("synthetic") == "yes":
        # a reader of only the title or the source must see it too
        title = title if "synthetic" in title.lower() else f"{title} (synthetic data)"
        source = source if "synthetic" in source.lower() else f"synthetic; {source}".rstrip("; ")
    own = {
        "Conventions": CONVENTIONS,
        "schema_name": SCHEMA_NAME,
        "schema_version": SCHEMA_VERSION,
        "title": title,
        "summary": given.pop("summary", product.pop("summary")),
        "keywords": given.pop("keywords", product.pop("keywords")),
        "source": source,
        **product,
        "command": command,
        "history": "\n".join(step.line(version) for step in steps),
        "software": _SOFTWARE,
        "software_version": version,
        "processing_level": "reduced",
    }
    _refuse_names(given, own)
    return {name: text for name, text in (own | given).items() if text}


def _as_json(metadata: dict[str, str]) -> str:
    return json.dumps(metadata, ensure_ascii=False) if metadata else ""


def _refuse_names(given: dict[str, str], own: dict[str, str]) -> None:
    taken = sorted(set(given) & set(own))
    if taken:
        raise ArchiveError(
            "attributes of the test have names that the archive keeps for itself",
            found=", ".join(taken),
            hint="Give them another name in campaign.toml.",
        )
    illegal = sorted(name for name in given if not _LEGAL.fullmatch(name))
    if illegal:
        raise ArchiveError(
            "attributes of the test have names that CF does not allow",
            found=", ".join(illegal),
            needed="letters, digits and underscores, a letter first",
            hint="Give them another name in campaign.toml.",
        )
