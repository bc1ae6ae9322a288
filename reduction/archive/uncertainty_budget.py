"""The uncertainty budget of one number of an archive.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 4.2.6, G.4.1 (Welch and Satterthwaite).
.. [2] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
   difference," Ann. Math. Statist., vol. 12, no. 2, pp. 153-162, 1941.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.shared_errors import FREEDOM, SHARED_OF_CHANNELS, components_of
from reduction.archive.variables import stored
from reduction.quantities.row import COMPONENT, CONTRIBUTION, RANDOM_PART
from reduction.quantities.units import parse_quantity
from reduction.record.contributions import Component, effective_degrees_of_freedom
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.measurement import Floats
from reduction.stages.moduli.local_regression import curve_at
from reduction.uncertainty.budget import Budget, budget_of

# one of these dimensions means a regression on hundreds of samples
_OF_SAMPLES = frozenset({
    "cycle", "selected_cycle", "hold", "held_pair", "slip", "step", "interval", "tension_grid",
    "break_share", "pull_term", "strain_level", "elastomer_parameter", "first_loading_strain_bin",
    "comparison_point", "sample", "property",
})  # fmt: skip

# read once, from the samples of one rise, one pull or two cycles
_ONCE = ("bedding_", "pull_", "tensile_strength", "strain_at_failure", "permanent_set",
         "slack_strain", "test_quasi_static_spring_constant")  # fmt: skip

_LAST = ("dynamic_stiffness", "dynamic_mean_tension", "dynamic_tension_amplitude")

_OF_SURFACE = ("_point_value", "_stationary_point", "_eigenvalue")

_LINES = ("_per_decade", "_per_cycle", "_change", "_drift")

_SINGLE = "tension_amplitude"

# from the differences of neighbouring cycles, each of which is used twice
_OF_NEIGHBOURS = frozenset({"peak_tension_change", "mean_strain_drift"})

_READINGS = {"diameter": "diameter_reading", "area": "diameter_reading"}

# counts of the cycles that reach each bin
_COUNTS = {"tangent_modulus": "tangent_modulus_count", "branch_tension": "branch_tension_count",
           "tangent_modulus_untrimmed": "branch_tension_count"}  # fmt: skip


def cycles_averaged(archive: xr.Dataset, name: str) -> Floats:
    """Number of cycles in the mean of a quantity over a test: with a value and after break-in.

    By specimen if the archive keeps single cycles, else one value for all.

    Notes
    -----
    A cycle with a missing channel has no value and is not in the mean.  For quantities not kept
    cycle by cycle, the cycles with a tension amplitude are counted.

    Examples
    --------
    >>> cycles = xr.Dataset({"tension_amplitude": (("specimen", "cycle"), [[5.0, np.nan, 5.1]])})
    >>> print(cycles_averaged(cycles, "test_dynamic_modulus"))
    [2]
    """
    break_in = break_in_cycles(archive)
    for single in (name.removeprefix("test_"), _SINGLE):
        if single in archive and archive.variables[single].dims == ("specimen", "cycle"):
            known = np.isfinite(archive.variables[single].values[:, break_in:])
            return np.asarray(known.sum(axis=1))
    return np.asarray(max(archive.sizes.get("cycle", 0) - break_in, 0))


def break_in_cycles(archive: xr.Dataset) -> int:
    """Number of first cycles left out of means, from the settings of an archive."""
    return _stated_break_in(str(archive.attrs.get("settings") or "{}"))


@cache
def _stated_break_in(settings: str) -> int:
    stated = json.loads(settings).get("reduction", {}).get("cycles", {})
    return int(stated.get("break_in_cycles", 0))


def random_freedom(archive: xr.Dataset, name: str) -> Floats:
    """Degrees of freedom of the random part of a quantity.

    Degrees of freedom, at least 1.

    Notes
    -----
    Stated by the archive for a regression over runs or a ratio.  Otherwise readings minus one; or
    cycles minus one, two for a line over them, counting those that reach the number or all with it
    after break-in; 2 (n - 1)^2 / (3 n - 4) for the differences of n neighbours, whose mean square
    has the variance 4 (3 n - 4) sigma^4 / (n - 1)^2 about 2 sigma^2 ([2]_); infinite for a
    regression on the samples of one rise, pull or hold, and for a single cycle
    ([1]_, 4.2.6).

    Examples
    --------
    >>> readings = xr.Dataset({"diameter_reading": (("specimen", "reading"), [[1.0, 2.0, 3.0]])})
    >>> print(random_freedom(readings, "area"), random_freedom(readings, "pull_peak_tension"))
    [2.] inf
    """
    base = name.removesuffix("_engineering").removesuffix("_coefficient")
    for stated in (f"{base}_term_degrees_of_freedom", f"{name}_degrees_of_freedom"):
        if stated in archive:
            return np.asarray(archive.variables[stated].values, dtype=np.float64)
    for of in _OF_SURFACE:
        if f"{name.removesuffix(of)}_term_degrees_of_freedom" in archive and name.endswith(of):
            found = archive.variables[f"{name.removesuffix(of)}_term_degrees_of_freedom"].values
            # all terms of a surface have the degrees of freedom of the least known one
            fewest = np.min(found, axis=-1, where=np.isfinite(found), initial=np.inf)
            return np.asarray(fewest[:, None])
    if _READINGS.get(name) in archive:
        read = np.isfinite(archive.variables[_READINGS[name]].values).sum(axis=-1)
        return np.asarray(np.maximum(read - 1.0, 1.0))
    if _COUNTS.get(name) in archive:
        count = np.asarray(archive.variables[_COUNTS[name]].values, dtype=np.float64)
        return np.where(count > 1, count - 1, np.inf)
    dims = set(map(str, archive.variables[name].dims)) if name in archive else set()
    if _OF_SAMPLES & dims or name.startswith(_ONCE):
        return np.asarray(np.inf)
    fitted = 2.0 if name.endswith(_LINES) else 1.0
    if name.startswith(_LAST) and "dynamic_cycles" in archive:
        last = np.asarray(archive.variables["dynamic_cycles"].values, dtype=np.float64)
        return np.maximum(last - fitted, 1.0)
    if name in _OF_NEIGHBOURS:
        n_cycles = max(archive.sizes.get("cycle", 0), 2)
        return np.asarray(2.0 * (n_cycles - 1) ** 2 / (3 * n_cycles - 4))
    count = cycles_averaged(archive, name)
    if count.ndim:
        own = tuple(archive.variables[name].dims) if name in archive else ()
        # dimensions after the specimen: branches, segments and the like
        behind = [1] * (len(own) - 1)
        count = count.reshape(-1, *behind) if own[:1] == ("specimen",) else count.min()
    return np.where(count == 1, np.inf, np.maximum(count - fitted, 1.0))


def effective_freedom(archive: xr.Dataset, name: str) -> Floats:
    """Degrees of freedom of the combined uncertainty of a quantity.

    Of the random and shared parts combined; without separate parts in the archive, the whole
    uncertainty counts as random.

    Notes
    -----
    [1]_, G.4.1: stated instrument errors count as exactly known, the scatter of a few readings does
    not.

    Examples
    --------
    The area uncertainty comes only from a diameter read three times:

    >>> archive = xr.Dataset({
    ...     "area": ("specimen", [1.0]),
    ...     "area_random_standard_uncertainty": ("specimen", [0.0]),
    ...     "area_uncertainty_contribution": (("uncertainty_component", "specimen"), [[0.1]]),
    ...     "uncertainty_source_degrees_of_freedom": ("uncertainty_component", [2.0])})
    >>> print(effective_freedom(archive, "area"))
    [2.]
    """
    variable = archive.variables[name]
    spread = stored(archive, f"{name}{RANDOM_PART}")
    if spread is None:
        spread = stored(archive, f"{name}_standard_uncertainty")
    own = np.broadcast_to(random_freedom(archive, name), variable.shape)
    if spread is None or spread.dims != variable.dims:
        return np.array(own)
    rows, known = stored(archive, f"{name}{CONTRIBUTION}"), stored(archive, FREEDOM)
    if rows is None:
        return effective_degrees_of_freedom(spread.values, own)
    of_rows = np.asarray(np.inf)
    if known is not None:
        # with several experiments each has its own errors
        dims = (COMPONENT, *variable.dims)
        of_each = np.where(known.values > 0, known.values, np.inf)
        of_each = of_each.transpose([known.dims.index(dim) for dim in dims if dim in known.dims])
        of_rows = of_each.reshape([known.sizes.get(dim, 1) for dim in dims])
    return effective_degrees_of_freedom(
        spread.values,
        own,
        contribution=rows.transpose(COMPONENT, *variable.dims).values,
        of_contribution=of_rows,
    )


# user names of dimensions; no quantity has two with the same one
_CALLED = {"branch_name": "branch", "strain_bin": "strain", "first_loading_strain_bin": "strain",
           "ratio_strain_bin": "strain", "tension_grid": "tension"}  # fmt: skip

ON_AN_AXIS = ("strain_bin", "first_loading_strain_bin", "ratio_strain_bin", "tension_grid")
"""Dimensions along which numbers are interpolated linearly."""

_ROUNDING = 1e-9

_MOST = 12

# variables that identify the entries of a dimension, beside their number
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
    """User name of a dimension in a request: ``branch``, ``strain``."""
    return _CALLED.get(dim, dim)


def parse_place(name: str, text: str) -> str:
    """Label of a place for `_find_place`: a strain as a number, a tension in newtons.

    Examples
    --------
    >>> parse_place("strain", "125 %"), parse_place("branch", " ascending")
    ('1.25', 'ascending')
    """
    key, label = name.strip(), text.strip()
    if key.endswith(("strain", "strain_bin")):
        return str(parse_quantity(label, "strain"))
    return str(parse_quantity(label, "force")) if key in ("tension", "tension_grid") else label


def _label_of(archive: xr.Dataset, dim: str, index: int) -> Any:
    """Label of an entry along a dimension, or its number if it has none."""
    return archive.variables[dim].values[index] if dim in archive.variables else index + 1


def words_of(
    archive: xr.Dataset,
    dim: str,
    index: int,
    place: Mapping[str, int],
    on_axis: float | None = None,
) -> str:
    """Description of an entry, for a reader who does not know its number.

    Such as ``dynamic stiffness of R01``, or a number with its unit; empty if the label is
    sufficient.
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
                text
                if one.dtype.kind not in "fi"
                else f"{name.removeprefix(f'{dim}_').replace('_', ' ')} {_meaning(one)}"
            )
    return _JOINED.get(dim, ", ").join(dict.fromkeys(found))


def _meaning(one: xr.Variable) -> str:
    meanings, values = one.attrs.get("flag_meanings"), one.attrs.get("flag_values")
    if meanings is not None and values is not None:
        known = dict(zip(np.atleast_1d(values).tolist(), str(meanings).split(), strict=False))
        return str(known.get(int(one.values), int(one.values)))
    return _number(float(one.values), one)


def _number(value: float, variable: xr.Variable) -> str:
    unit = str(variable.attrs.get("units", ""))
    return f"{value:.6g}" if unit in ("", "1") else f"{value:.6g} {unit}"


def _find_place(archive: xr.Dataset, dim: str, text: str | None, others: Mapping[str, int]) -> int:
    """Index of a requested place along a dimension."""
    size, known = archive.sizes[dim], dict(others)
    labels = [str(_label_of(archive, dim, index)) for index in range(size)]
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
            f"{place_name(dim)} is not stated, and there are several",
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
    """Index of the nearest point; values outside the range are refused."""
    middle = np.asarray(archive[dim].values, dtype=np.float64)
    rounding = _ROUNDING * float(np.max(np.abs(middle)))
    if not middle.min() - rounding <= value <= middle.max() + rounding:
        raise SettingsError(
            f"{place_name(dim)} has no bin at {value:g}",
            needed=f"{middle.min():.4g} to {middle.max():.4g}",
        )
    return int(np.argmin(np.abs(middle - value)))


def _read_at(
    archive: xr.Dataset, values: xr.Variable, place: Mapping[str, int], on_axis: float | None
) -> Floats:
    """Values at a place, shape (n_components,) or (); interpolated along an axis."""
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


def _where_known(archive: xr.Dataset, variable: xr.Variable, place: Mapping[str, int]) -> str:
    """Places along the last dimension with a number, for the other places requested."""
    dim = str(variable.dims[-1])
    row = variable.isel({one: at for one, at in place.items() if one != dim})
    known = np.flatnonzero(np.isfinite(row.values))
    if not known.size:
        return "another place: there is none at any " + place_name(dim)
    if dim in ON_AN_AXIS:
        middle = archive[dim].values[known]
        return f"{place_name(dim)} {middle[0]:.4g} to {middle[-1]:.4g}"
    labels = [str(_label_of(archive, dim, int(index))) for index in known]
    return f"{place_name(dim)} {_listed(labels)}"


_U = "_standard_uncertainty"

_NAMES = ("{}", "test_{}", "{}_coefficient")

# reasons for missing numbers in the archive
_REASONS = {"property": "property_remark", "hold": "hold_refusal", "held_pair": "static_refusal"}


def quantities_with_budget(archive: xr.Dataset) -> tuple[str, ...]:
    """Names of the quantities with shared errors in an archive, except channels."""
    return tuple(
        str(name).removesuffix(CONTRIBUTION)
        for name in archive.variables
        if str(name).endswith(CONTRIBUTION)
        and str(name).removesuffix(CONTRIBUTION) not in SHARED_OF_CHANNELS
    )


def budget_from_archive(archive: xr.Dataset, quantity: str, at: Mapping[str, str]) -> Budget:
    """Read the budget of one number."""
    known = quantities_with_budget(archive)
    name = next((one for pattern in _NAMES if (one := pattern.format(quantity)) in known), None)
    if name is None:
        raise _no_budget(archive, quantity, known)
    variable = archive.variables[name]
    dims = [str(dim) for dim in variable.dims]
    strange = sorted(set(at) - set(dims) - {place_name(dim) for dim in dims})
    if strange:
        raise SettingsError(
            f"{name} does not vary with {', '.join(strange)}",
            needed="--at " + ", ".join(map(place_name, dims)),
        )
    asked = {dim: at.get(place_name(dim), at.get(dim)) for dim in dims}
    place: dict[str, int] = {}
    for dim, text in asked.items():
        place[dim] = _find_place(archive, dim, text, place)
    on_axis = [text for dim, text in asked.items() if dim in ON_AN_AXIS and text is not None]
    strain = float(on_axis[0]) if on_axis else None
    if not np.isfinite(_read_at(archive, variable, place, strain)):
        shown = _labels(archive, place, strain)
        raise ArchiveError(
            f"there is no {name} there",
            found=", ".join(f"{place_name(dim)}={text}" for dim, text in shown.items()),
            needed=_where_known(archive, variable, place),
            hint=_why_there_is_none(archive, place),
        )
    budget = _budget_at(archive, name, place, strain)
    if np.isnan(budget.standard_uncertainty):
        raise ArchiveError(
            f"the uncertainty of {name} there is not known",
            found="an error, or a scatter, of which it is not kept what it adds",
            hint=_why_there_is_none(archive, place)
            or "The notes of the archive say which; reduce what it was made from again.",
        )
    return budget


def all_budgets(archive: xr.Dataset, quantity: str) -> list[Budget]:
    """Read the budget of every number of a quantity.

    Budgets in the order of the archive; empty without shared errors.
    """
    if quantity not in quantities_with_budget(archive):
        return []
    variable = archive.variables[quantity]
    dims = [str(dim) for dim in variable.dims]
    return [
        _budget_at(archive, quantity, dict(zip(dims, map(int, place), strict=True)))
        for place in np.argwhere(np.isfinite(variable.values))
    ]


def _budget_at(
    archive: xr.Dataset, name: str, place: Mapping[str, int], strain: float | None = None
) -> Budget:
    """Budget of one number; a strain is interpolated between bins, as in a look-up."""
    variable = archive.variables[name]
    contribution = archive.variables[f"{name}{CONTRIBUTION}"]
    freedom = np.broadcast_to(random_freedom(archive, name), variable.shape)

    def read(values: xr.Variable) -> Floats:
        return _read_at(archive, values, place, strain)

    components = components_of(archive, place.get("experiment"))
    rows = read(contribution)
    found: dict[Component, float] = {
        one: float(value)
        for one, value in zip(components, rows, strict=False)
        if one.source and value != 0
    }
    few = read(xr.Variable(variable.dims, 1 / freedom, fastpath=True))
    return budget_of(
        name,
        str(variable.attrs.get("units", "")),
        float(read(variable)),
        found,
        random=float(read(archive.variables[f"{name}{RANDOM_PART}"])),
        degrees_of_freedom=float(np.divide(1, few, out=np.array(np.inf), where=few > 0)),
        place=_labels(archive, place, strain),
        words={dim: words_of(archive, dim, index, place, strain) for dim, index in place.items()},
    )


def _labels(archive: xr.Dataset, place: Mapping[str, int], on_axis: float | None) -> dict[str, str]:
    """Label of each place; a strain or a tension as requested."""
    found = {}
    for dim, index in place.items():
        label = _label_of(archive, dim, index)
        if on_axis is not None and dim in ON_AN_AXIS:
            label = float(on_axis)
        found[dim] = f"{label:.6g}" if isinstance(label, float) else str(label)
    return found


def _why_there_is_none(archive: xr.Dataset, place: Mapping[str, int]) -> str:
    """Reason in the archive for a missing number or uncertainty; empty if there is none."""
    said = [
        str(archive.variables[name].values[place[dim]])
        for dim, name in _REASONS.items()
        if dim in place and name in archive
    ]
    told = "; ".join(filter(None, said))
    return f"The archive says: {told}." if told else ""


def _no_budget(archive: xr.Dataset, quantity: str, known: Sequence[str]) -> SettingsError:
    """Error for a quantity without a budget: absent, or without shared errors."""
    of_archive = next(
        (one for pattern in _NAMES if (one := pattern.format(quantity)) in archive), None
    )
    why = "is not in this archive" if of_archive is None else "has no shared part"
    return SettingsError(
        f"{quantity} {why}", needed="one of " + (", ".join(known) or "none: no error is shared")
    )
