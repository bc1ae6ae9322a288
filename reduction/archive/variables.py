"""Converts arrays and notes to variables of an archive."""

from __future__ import annotations

import json
from collections.abc import Hashable, Sequence
from typing import Any, cast

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from reduction.record.measurement import Floats, Integers
from reduction.record.note_sentences import Severity
from reduction.record.notes import Note

Values = dict[str, NDArray[Any]]
"""Arrays by schema name; the schema provides dimensions and attributes."""


def texts(items: Sequence[str]) -> NDArray[np.str_]:
    """Return labels as an array; an empty sequence gives an empty text array."""
    return np.array(list(items), dtype=np.str_)


def numbers(items: Sequence[float | None]) -> Floats:
    """Return numbers as float64, NaN for None."""
    return np.array([np.nan if item is None else item for item in items], dtype=np.float64)


def pad(rows: Sequence[ArrayLike]) -> Floats:
    """Stack ragged rows, with NaN where a row is shorter."""
    arrays = [np.atleast_1d(np.asarray(row, dtype=np.float64)) for row in rows]
    table = np.full((len(arrays), max((row.size for row in arrays), default=0)), np.nan)
    for line, row in zip(table, arrays, strict=True):
        line[: row.size] = row
    return table


def pad_texts(rows: Sequence[Sequence[str]]) -> NDArray[np.str_]:
    """Stack ragged rows of labels, with "" where a row is shorter."""
    length = max((len(row) for row in rows), default=0)
    return np.array([[*row, *[""] * (length - len(row))] for row in rows], dtype=np.str_)


def stored(dataset: xr.Dataset, name: str) -> xr.Variable | None:
    """Return a variable of an archive, or None.

    Examples
    --------
    >>> stored(xr.Dataset({"strain": 1.5}), "tension") is None
    True
    """
    return dataset.variables[name] if name in dataset else None


def at_places(variable: xr.Variable, dim: Hashable, places: Integers) -> xr.Variable:
    """Return entries of a variable along a dimension in memory; all of it if it lacks this.

    Like `xarray.Variable.isel`, which would import Dask to check the type of the places.
    """
    if dim not in variable.dims:
        return variable
    if isinstance(variable, xr.IndexVariable):
        labels = variable.to_index()[places]
        return xr.IndexVariable(variable.dims, labels, variable.attrs)
    taken = np.take(variable.values, places, axis=variable.dims.index(dim))
    return xr.Variable(variable.dims, taken, variable.attrs, fastpath=True)


_NOTE_TEXTS = ("note", "note_stage", "note_code", "note_severity")

NOTE_VARIABLES = (*_NOTE_TEXTS, "note_effect")


def settings_of(archive: xr.Dataset) -> dict[str, Any]:
    """Return all settings of the run that made an archive; empty if it states none."""
    return dict(json.loads(str(archive.attrs.get("settings") or "{}")))


def note_values(notes: Sequence[Note]) -> Values:
    """Return notes as variables, in order."""
    return {
        "note": texts([str(one) for one in notes]),
        "note_stage": texts([one.stage for one in notes]),
        "note_code": texts([one.code for one in notes]),
        "note_severity": texts([one.severity for one in notes]),
        "note_effect": np.array([one.numbers.get("effect", np.nan) for one in notes], dtype=float),
    }


def read_notes(archive: xr.Dataset, *, of: tuple[str, str] | None = None) -> tuple[Note, ...]:
    """Return the notes of an archive, optionally for one value of a variable, without repeats."""
    if "note" not in archive:
        return ()
    columns = [archive.variables[name].values.astype(str).tolist() for name in _NOTE_TEXTS]
    rows = zip(*columns, archive.variables["note_effect"].values.tolist(), strict=True)
    owners = archive.variables[of[0]].values.astype(str) if of else columns[0]
    found = (
        Note(
            code,
            cast("Severity", severity),
            stage=stage,
            numbers={"effect": effect} if np.isfinite(effect) else {},
            text=text,
        )
        for (text, stage, code, severity, effect), owner in zip(rows, owners, strict=True)
        if of is None or owner == of[1]
    )
    return tuple(dict.fromkeys(found))
