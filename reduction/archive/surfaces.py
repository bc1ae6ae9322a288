"""The experiments of a campaign as one dataset that follows CF."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.stiffness import stiffness_values
from reduction.archive.surface_schema import SURFACE_SCHEMA
from reduction.archive.surface_values import experiment_values
from reduction.archive.values import Values, texts
from reduction.errors import ArchiveError
from reduction.experiment import ExperimentResult
from reduction.provenance import Origin


def surfaces_to_dataset(results: Sequence[ExperimentResult], *, origin: Origin) -> xr.Dataset:
    """Bring experiments into the form of the archive; no file is touched.

    Parameters
    ----------
    results : sequence of ExperimentResult
        One or more, of one campaign.
    origin : Origin
        The campaign, the files that the experiments were made from, and how they were made.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `reduction.archive.surface_schema`, encoding
        included. Equal inputs give equal datasets.

    Raises
    ------
    ArchiveError
        If a response has no name in the vocabulary, two experiments have one name, or a
        run of a surface is not a run of its experiment.
    """
    names = [result.name for result in results]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ArchiveError("an experiment stands twice", found=", ".join(twice))
    values = _stacked([_values_of(result) for result in results])
    values |= {"experiment": texts(names)} | _note_values(results) | _caution_values(results)
    return build_dataset(
        {
            name: array
            for name, array in values.items()
            if array.dtype.kind != "U" or any(array.flat)
        },
        SURFACE_SCHEMA,
        attributes=part_attributes("surfaces", names, origin=origin),
    )


def _values_of(result: ExperimentResult) -> Values:
    values = experiment_values(result)
    if result.form_quality is not None and result.stiffness_forms:
        values |= stiffness_values(result.stiffness_forms, result.form_quality)
    return values


def _stacked(parts: Sequence[Values]) -> Values:
    """Set experiments side by side; an axis of the file is the longest of its kind."""
    sizes: dict[str, int] = {}
    for part in parts:
        for name, array in part.items():
            for dim, length in zip(_own_dims(name), array.shape, strict=True):
                sizes[dim] = max(length, sizes.get(dim, 0))
    values: Values = {}
    for name in dict.fromkeys(name for part in parts for name in part):
        if "experiment" in SURFACE_SCHEMA[name].dims:
            shape = tuple(sizes[dim] for dim in _own_dims(name))
            values[name] = np.stack([_padded(name, part.get(name), shape) for part in parts])
        else:
            values[name] = max((part[name] for part in parts if name in part), key=len)
    return values


def _padded(name: str, array: NDArray[Any] | None, shape: tuple[int, ...]) -> NDArray[Any]:
    """Bring an array to the length of the longest; all of it where there is none."""
    row = SURFACE_SCHEMA[name]
    fill = "" if row.is_text else np.nan if row.dtype == "f8" else 0
    if array is None:
        return np.full(shape, fill, dtype=row.dtype)
    padded: NDArray[Any] = np.full(shape, fill, dtype=array.dtype if row.is_text else row.dtype)
    padded[tuple(slice(length) for length in array.shape)] = array
    return padded


def _own_dims(name: str) -> tuple[str, ...]:
    return tuple(dim for dim in SURFACE_SCHEMA[name].dims if dim != "experiment")


def _note_values(results: Sequence[ExperimentResult]) -> Values:
    """Notes of surfaces under their own stage, and none twice."""
    rows = []
    for result in results:
        of_surfaces = () if result.surfaces is None else result.surfaces.notes
        rows += [(result.name, "surfaces", text) for text in of_surfaces]
        rows += [
            (result.name, "experiment", text) for text in result.notes if text not in of_surfaces
        ]
    return {
        name: texts([row[column] for row in rows])
        for column, name in enumerate(("note_experiment", "note_stage", "note"))
    }


def _caution_values(results: Sequence[ExperimentResult]) -> Values:
    """Cautions, with the names of the runs that they count from 1."""
    rows = [
        (
            result.name,
            caution.kind,
            caution.message,
            caution.hint,
            ", ".join(result.runs.run[number - 1] for number in caution.runs),
        )
        for result in results
        for caution in result.cautions
    ]
    names = ("caution_experiment", "caution_kind", "caution", "caution_hint", "caution_runs")
    return {name: texts([row[column] for row in rows]) for column, name in enumerate(names)}
