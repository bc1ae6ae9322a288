"""One archive as the index keeps it: conditions of its specimens, and numbers with their places."""

from __future__ import annotations

import hashlib
from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.open import reading
from reduction.archive.products import OF_CAMPAIGN
from reduction.catalogue.columns import LEFT_OUT, NUMBERS, TEXTS, column_type
from reduction.catalogue.entry import WHOLE, ArchiveEntry, Block
from reduction.catalogue.files import shown_path
from reduction.errors import ArchiveError
from reduction.record import Floats
from reduction.vocabulary import QUANTITIES

__all__ = ["identity_of", "kept_cycles", "read_entry"]

_SAMPLES_AT_ONCE = 1_000_000


def identity_of(path: Path) -> str:
    """What an archive says of itself; it differs where raw file, settings or version do.

    Parameters
    ----------
    path : pathlib.Path
        An archive.

    Returns
    -------
    identity : str
        Of its global attributes, which name the raw files with their hashes, the settings and the
        version: equal ones give equal products.

    Raises
    ------
    ArchiveError
        If the file cannot be read.
    """
    with reading(path) as archive:
        return _identity(archive.attrs)


def _identity(attributes: Mapping[str, Any]) -> str:
    text = "\0".join(f"{name}={attributes[name]}" for name in sorted(attributes))
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:32]


def kept_cycles(n_cycles: int) -> NDArray[np.intp]:
    """Index of the cycles whose numbers the index keeps: 1, 2, 5, 10, 20, 50, ... and the last.

    Examples
    --------
    >>> [int(index) + 1 for index in kept_cycles(3000)]
    [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 3000]
    """
    numbers = [one * 10**power for power in range(len(str(n_cycles))) for one in (1, 2, 5)]
    return np.array(sorted({n for n in numbers if n < n_cycles} | {n_cycles}), dtype=np.intp) - 1


def read_entry(path: Path, name: str) -> ArchiveEntry:
    """Read what the index keeps of an archive.

    Parameters
    ----------
    path : pathlib.Path
        The archive.
    name : str
        What is shown of its path.

    Returns
    -------
    entry : ArchiveEntry
        With the ``fault`` where the file cannot be read; nothing is raised then, so that one
        broken archive does not hide the others.
    """
    # campaign and test of a broken archive are those of its path
    folder, _, stem = name.rpartition("/")
    known = {"archive": name, "campaign": folder, "test": stem.removesuffix(".nc")}
    if path.is_dir():
        fault = f"{name} is a folder that is no archive, or one that this user may not look into"
        return ArchiveEntry("", dict(known), fault=fault)
    try:
        with reading(path) as archive:
            return _entry(archive, known)
    except ArchiveError as error:
        return ArchiveEntry("", dict(known), fault=shown_path(str(error)))
    except (OSError, RuntimeError, ValueError, KeyError, IndexError) as error:
        # a file that opens and whose parts are damaged or not those of an archive
        words = (str(error) or type(error).__name__).splitlines()[0]
        return ArchiveEntry(
            "", dict(known), fault=shown_path(f"{name} cannot be read; found {words}")
        )


def _entry(archive: xr.Dataset, known: Mapping[str, str]) -> ArchiveEntry:
    attributes = archive.attrs
    whole: dict[str, str | float] = {
        name: str(attributes[name]) for name in TEXTS if name in attributes
    }
    whole = {"synthetic": "no"} | dict(known) | whole | {"archive": known["archive"]}
    part = known["test"] if known["test"] in OF_CAMPAIGN else ""
    whole["test_kind"] = part or str(attributes.get("test_kind", ""))
    if "cycle" in archive.sizes:
        whole["n_cycles"] = float(archive.sizes["cycle"])
    names = archive.variables["specimen"].values.tolist() if "specimen" in archive.sizes else []
    ends = _strain_ends(archive) if names else []
    specimens = tuple(
        whole | {"specimen": str(name)} | _conditions(archive, place) | ends[place]
        for place, name in enumerate(names)
    )
    return ArchiveEntry(_identity(attributes), whole, specimens, tuple(_blocks(archive, names)))


def _conditions(archive: xr.Dataset, place: int) -> dict[str, str | float]:
    found: dict[str, str | float] = {}
    for name in (*TEXTS, *NUMBERS):
        if name != "specimen" and name in archive and archive.variables[name].dims == ("specimen",):
            value = archive.variables[name].values[place]
            found[name] = float(value) if name in NUMBERS else str(value)
    return _known(found)


def _known(found: dict[str, str | float]) -> dict[str, str | float]:
    """Without numbers that are missing."""
    return {name: one for name, one in found.items() if isinstance(one, str) or np.isfinite(one)}


def _strain_ends(archive: xr.Dataset) -> list[dict[str, str | float]]:
    """Least and greatest strain of each specimen, of its samples, steps and cycles."""
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
    # fmin and fmax pass over samples that are missing
    return (
        np.fmin(low, np.fmin.reduce(strain, axis=-1, initial=np.nan)),
        np.fmax(high, np.fmax.reduce(strain, axis=-1, initial=np.nan)),
    )


def _blocks(archive: xr.Dataset, names: list[str]) -> list[Block]:
    """Numbers of an archive, those on the same dimensions together."""
    groups: dict[tuple[Hashable, ...], list[str]] = {}
    for name, variable in archive.variables.items():
        is_number = variable.dtype.kind in "fiu" and "flag_meanings" not in variable.attrs
        stays = LEFT_OUT & set(variable.dims) or any(
            str(dim).endswith("_other") for dim in variable.dims
        )
        if is_number and not stays and name in QUANTITIES and name not in archive.sizes:
            groups.setdefault(variable.dims, []).append(str(name))
    return [_block(archive, dims, group, names) for dims, group in groups.items()]


def _block(
    archive: xr.Dataset, dims: tuple[Hashable, ...], group: list[str], specimens: list[str]
) -> Block:
    axes = [np.arange(archive.sizes[dim]) for dim in dims]
    cycles: dict[str, NDArray[np.intp]] = {}
    if "cycle" in dims and archive.sizes["cycle"]:
        cycles["cycle"] = kept_cycles(archive.sizes["cycle"])
        axes[dims.index("cycle")] = cycles["cycle"]
    shape = tuple(len(axis) for axis in axes)
    # of many cycles the others are not read
    read = {
        name: archive.variables[name].isel(cycles, missing_dims="ignore")
        for one in group
        for name in (one, f"{one}_standard_uncertainty")
        if name in archive.variables
    }
    values = np.stack([np.asarray(read[name].values, float) for name in group])
    spread = np.full_like(values, np.nan)
    for row, name in enumerate(group):
        own = read.get(f"{name}_standard_uncertainty")
        if own is not None:
            missing = [axis for axis, dim in enumerate(dims) if dim not in own.dims]
            spread[row] = np.broadcast_to(np.expand_dims(own.values, missing), shape)
    # where a quantity is known anywhere its other places stand as missing, so that all keep their
    # order; a quantity of which nothing is known is not there
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
    only = 0 if len(specimens) == 1 else WHOLE
    specimen = np.full(n_values, only, np.int32)
    if "specimen" in at:
        specimen = at["specimen"].astype(np.int32)
    else:
        for dim, index in at.items():
            whose = f"{dim}_specimen"
            if whose in archive and archive.variables[whose].dims == (dim,) and specimens:
                number = {name: place for place, name in enumerate(specimens)}
                of_row = [number.get(str(name), WHOLE) for name in archive.variables[whose].values]
                specimen = np.array(of_row, np.int32)[index]
    return Block(np.array(group, object)[found[0]], specimen, values[found], spread[found], place)


def _labels(archive: xr.Dataset, dim: str) -> NDArray[Any]:
    """Text or number of each place along a dimension; from 1 where the archive names none."""
    is_text = column_type(dim) == "string"
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
