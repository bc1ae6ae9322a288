"""Which one of the numbers of a quantity is meant: places along its dimensions, and their words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from reduction.errors import SettingsError
from reduction.moduli.interpolation import curve_at
from reduction.record import Floats
from reduction.units import parse_quantity

# what a user calls a dimension; no quantity has two of one name
_CALLED = {"branch_name": "branch", "strain_bin": "strain", "first_loading_strain_bin": "strain",
           "ratio_strain_bin": "strain", "tension_grid": "tension"}  # fmt: skip
ON_AN_AXIS = ("strain_bin", "first_loading_strain_bin", "ratio_strain_bin", "tension_grid")
"""Dimensions along which a number is read between the points, on straight lines."""
_ROUNDING = 1e-9
_MOST = 12
# what tells the entries of a dimension apart, beside their number
_WORDS = {
    "property": ("property_name", "property_specimen", "property_test"),
    "comparison": ("ratio_numerator", "ratio_denominator"),
    "hold": ("hold_specimen", "hold_kind", "hold_start_time"),
    "held_pair": ("held_pair_specimen", "held_pair_low_tension", "held_pair_high_tension"),
    "step": ("clock",),
    "interval": ("interval_strain",),
    "comparison_point": ("strain",),
    "elastomer_parameter": ("elastomer_parameter_fit", "elastomer_parameter_name"),
    "slip": ("slip_specimen", "slip_time"),
}
_JOINED = {"comparison": " over "}


def place_name(dim: str) -> str:
    """What a dimension is called where a place along it is asked for: ``branch``, ``strain``."""
    return _CALLED.get(dim, dim)


def parse_place(name: str, text: str) -> str:
    """Label of a place as `find_place` takes it: a strain as a number, a tension in newton.

    Parameters
    ----------
    name : str
        What the place is called: ``branch``, ``strain``.
    text : str
        As written, with a unit or a percent sign where it is a strain or a tension.

    Returns
    -------
    label : str
        In SI.

    Raises
    ------
    SettingsError
        If a strain or a tension cannot be read.

    Examples
    --------
    >>> parse_place("strain", "125 %"), parse_place("branch", " ascending")
    ('1.25', 'ascending')
    """
    key, label = name.strip(), text.strip()
    if key.endswith(("strain", "strain_bin")):
        return str(parse_quantity(label, "strain"))
    return str(parse_quantity(label, "force")) if key in ("tension", "tension_grid") else label


def label_of(archive: xr.Dataset, dim: str, index: int) -> Any:
    """Label of an entry of a dimension, or its number where it has none."""
    return archive.variables[dim].values[index] if dim in archive.variables else index + 1


def words_of(
    archive: xr.Dataset,
    dim: str,
    index: int,
    place: Mapping[str, int],
    on_axis: float | None = None,
) -> str:
    """What an entry of a dimension is, for a reader who does not know its number.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, of experiments, of properties or of comparisons.
    dim : str
        The dimension.
    index : int
        Of the entry.
    place : mapping of str to int
        The others, where the entry depends on them.
    on_axis : float, optional
        What was asked for between the points of an axis.

    Returns
    -------
    words : str
        Such as ``dynamic stiffness of R01``, or a number with its unit; empty where the label says
        it all.

    Raises
    ------
    IndexError
        If there is no such entry.
    """
    if dim in archive.variables and archive.variables[dim].dtype.kind == "f":
        at = float(archive.variables[dim].values[index])
        return _number(
            at if on_axis is None or dim not in ON_AN_AXIS else on_axis, archive.variables[dim]
        )
    found = []
    for name in _WORDS.get(dim, ()):
        if name not in archive or dim not in archive.variables[name].dims:
            continue
        one = archive.variables[name].isel({key: at for key, at in {**place, dim: index}.items()
                                  if key in archive.variables[name].dims})  # fmt: skip
        if one.ndim == 0 and str(one.values) not in ("", "nan"):
            text = str(one.values)
            found.append(
                text if one.dtype.kind not in "fi" else f"{_told(name, dim)} {_meaning(one)}"
            )
    return _JOINED.get(dim, ", ").join(dict.fromkeys(found))


def _told(name: str, dim: str) -> str:
    return name.removeprefix(f"{dim}_").replace("_", " ")


def _meaning(one: xr.Variable) -> str:
    meanings, values = one.attrs.get("flag_meanings"), one.attrs.get("flag_values")
    if meanings is not None and values is not None:
        known = dict(zip(np.atleast_1d(values).tolist(), str(meanings).split(), strict=False))
        return str(known.get(int(one.values), int(one.values)))
    return _number(float(one.values), one)


def _number(value: float, variable: xr.Variable) -> str:
    unit = str(variable.attrs.get("units", ""))
    return f"{value:.6g}" if unit in ("", "1") else f"{value:.6g} {unit}"


def find_place(
    archive: xr.Dataset, dim: str, text: str | None, others: Mapping[str, int] | None = None
) -> int:
    """Index along a dimension of what was asked for.

    Parameters
    ----------
    archive : xarray.Dataset
        Where.
    dim : str
        The dimension.
    text : str or None
        A label, a number, a strain, or the words of an entry; one that is alone need not be said.
    others : mapping of str to int, optional
        Places along other dimensions, as far as they are known.

    Returns
    -------
    index : int
        Of the entry; on an axis that of the nearest point.

    Raises
    ------
    SettingsError
        If it is not said, or there is no such entry.
    """
    size, known = archive.sizes[dim], dict(others or {})
    labels = [str(label_of(archive, dim, index)) for index in range(size)]
    told = [words_of(archive, dim, index, known) for index in range(size)]
    shown = (
        f"{told[0]} to {told[-1]}"
        if dim in ON_AN_AXIS
        else _listed(
            [
                one if word in ("", one) else f"{one} ({word})"
                for one, word in zip(labels, told, strict=True)
            ]
        )
    )
    if text is None:
        if size == 1:
            return 0
        raise SettingsError(
            f"which {place_name(dim)} is meant is not said",
            needed=f'--at "{place_name(dim)}=..." ({shown})',
        )
    if dim in ON_AN_AXIS:
        return _nearest(archive, dim, float(text))
    if text in labels:
        return labels.index(text)
    if told.count(text) == 1:
        return told.index(text)
    raise SettingsError(f"there is no {place_name(dim)} '{text}'", needed=shown)


def _listed(texts: list[str]) -> str:
    return ", ".join(texts[:_MOST]) + (", ..." if len(texts) > _MOST else "")


def _nearest(archive: xr.Dataset, dim: str, value: float) -> int:
    """Point that is nearest; nothing is read beyond the first and the last."""
    middle = np.asarray(archive[dim].values, dtype=np.float64)
    rounding = _ROUNDING * float(np.max(np.abs(middle)))
    if not middle.min() - rounding <= value <= middle.max() + rounding:
        raise SettingsError(
            f"{place_name(dim)} has no bin at {value:g}",
            needed=f"{middle.min():.4g} to {middle.max():.4g}",
        )
    return int(np.argmin(np.abs(middle - value)))


def read_at(
    archive: xr.Dataset, values: xr.Variable, place: Mapping[str, int], on_axis: float | None
) -> Floats:
    """Values at a place, shape (n_components,) or (); between points where one is given.

    Parameters
    ----------
    archive : xarray.Dataset
        With the points of the axis.
    values : xarray.Variable
        With the dimensions of the place, and one before them at most.
    place : mapping of str to int
        Index along each dimension.
    on_axis : float or None
        Strain or tension that was asked for. [unit of the axis]

    Returns
    -------
    found : ndarray
        [unit of the values]

    Raises
    ------
    IndexError
        If there is no such place.
    """
    axis = next((dim for dim in place if dim in ON_AN_AXIS), None)
    if on_axis is None or axis is None:
        return np.asarray(values.isel(place).values, dtype=np.float64)
    curves = values.isel({dim: index for dim, index in place.items() if dim != axis}).values
    bins = archive[axis].values
    spacing = float(np.min(np.diff(bins), initial=np.inf))
    flat = [
        curve_at(on_axis, bins, row, spacing=spacing if np.isfinite(spacing) else None)
        for row in curves.reshape(-1, bins.size)
    ]
    return np.array(flat).reshape(curves.shape[:-1])


def where_known(archive: xr.Dataset, variable: xr.Variable, place: Mapping[str, int]) -> str:
    """Places along the last dimension that have a number, the others as asked for."""
    dim = str(variable.dims[-1])
    row = variable.isel({one: at for one, at in place.items() if one != dim})
    known = np.flatnonzero(np.isfinite(row.values))
    if not known.size:
        return "another place: there is none at any " + place_name(dim)
    if dim in ON_AN_AXIS:
        middle = archive[dim].values[known]
        return f"{place_name(dim)} {middle[0]:.4g} to {middle[-1]:.4g}"
    labels = [str(label_of(archive, dim, int(index))) for index in known]
    return f"{place_name(dim)} {_listed(labels)}"
