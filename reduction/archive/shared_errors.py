"""Errors shared between tests, as stored in their archives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.variables import Values, settings_of, stored, texts
from reduction.prediction.measured_curve import SharedErrors, constant_errors
from reduction.quantities.names import OF_TEST
from reduction.quantities.outcomes_and_weights import IN_PLACE_OF_RECORD
from reduction.quantities.row import COMPONENT
from reduction.record.contributions import (
    Component,
    Contributions,
    StatedErrors,
    combined_standard_uncertainty,
)
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note
from reduction.record.samples import like_storage, release_pages

FREEDOM = "uncertainty_source_degrees_of_freedom"
"""Degrees of freedom of each shared error; present if any is based on a few readings."""

SHARED: dict[str, tuple[str, ...]] = {
    row.name: row.contribution_dims
    for row in OF_TEST
    if row.shares_errors and "sample" not in row.dims
}
"""Quantities with stored contributions, with their dimensions."""

SHARED_OF_CHANNELS: dict[str, tuple[str, ...]] = {
    row.name: row.contribution_dims for row in OF_TEST if row.shares_errors and "sample" in row.dims
}
"""Channels: one contribution for all samples of a specimen, with its dimensions."""

SHARED_OF_STEPS: dict[str, tuple[str, ...]] = {
    row.name: row.contribution_dims for row in IN_PLACE_OF_RECORD if row.shares_errors
}
"""Only for a stepwise test: in a record it belongs to each cycle."""

# the curve of one cycle has the shared error of the mean curve
_ALIKE = {"tangent_modulus_by_cycle": "tangent_modulus"}


def with_shared(
    values: Values,
    contributions: Contributions | None,
    shared_uncertainty_of_cycles: dict[str, Floats],
    random: Values,
) -> Values:
    """Store the shared and random parts of every uncertainty, and the combined value."""
    known = SHARED | SHARED_OF_CHANNELS | SHARED_OF_STEPS
    homeless = sorted(set(contributions.values) - set(known)) if contributions else []
    if homeless:
        raise ArchiveError(
            "the archive has no variable for contributions of shared errors",
            found=", ".join(homeless),
            needed="quantities with shares_errors in reduction.quantities",
            hint="this is a fault of the program, not of the campaign",
        )
    found = dict(values)
    for name, shared in shared_uncertainty_of_cycles.items():
        if name in random:
            found[f"{name}_standard_uncertainty"] = random[name]
        _combine(found, name, shared[None])
    if contributions is None:
        return found
    for name, rows in contributions.values.items():
        if name not in values:
            continue  # from a stage absent in this test
        if name in SHARED_OF_CHANNELS:
            _combine_channel(found, name, rows)
            continue
        if name in random:
            found[f"{name}_standard_uncertainty"] = random[name]
        found[f"{name}_random_standard_uncertainty"] = _combine(found, name, rows)
        # without a number there are no contributions
        found[f"{name}_uncertainty_contribution"] = np.where(np.isnan(values[name]), np.nan, rows)
    for name, mean in _ALIKE.items():
        if name in values and mean in contributions.values:
            shared = contributions.shared_standard_uncertainty(mean)
            _combine(found, name, shared[None, :, None])
    return found | component_values(contributions.component)


def component_values(component: Sequence[Component]) -> Values:
    """Return the axis of the shared errors, with their descriptions."""
    freedom = np.array([one.degrees_of_freedom for one in component], dtype=np.float64)
    return {
        COMPONENT: np.arange(1, len(component) + 1),
        "uncertainty_source": texts([one.source for one in component]),
        "uncertainty_source_of": texts([one.of for one in component]),
        "uncertainty_source_number": np.array([one.number for one in component]),
    } | ({} if np.isinf(freedom).all() else {FREEDOM: freedom})


def shared_contributions(archive: xr.Dataset, name: str, *place: int) -> dict[Component, float]:
    """Contribution of each shared error to one number of an archive; empty if unknown."""
    rows = stored(archive, f"{name}_uncertainty_contribution")
    if rows is None:
        return {}
    components = components_of(archive)
    found = np.moveaxis(rows.values, 0, -1)[place]
    return {
        one: float(value)
        for one, value in zip(components, found, strict=True)
        if np.isfinite(value) and value != 0
    }


def components_of(archive: xr.Dataset, experiment: int | None = None) -> list[Component]:
    """All shared errors of an archive, or of one of its experiments, in order."""
    names = ("uncertainty_source", "uncertainty_source_of", "uncertainty_source_number")
    columns = [archive.variables[name].values for name in names]
    own = columns if experiment is None else [column[experiment] for column in columns]
    kept = stored(archive, FREEDOM)
    known = np.full(len(own[0]), np.inf)
    if kept is not None:
        known = kept.values if experiment is None else kept.values[experiment]
        # an experiment with fewer errors than another is padded
        known = np.where(np.isnan(known), np.inf, known)
    return [
        Component(str(source), str(of), int(number), float(freedom))
        for source, of, number, freedom in zip(*own, known, strict=True)
    ]


def _combine(values: Values, name: str, rows: Floats) -> Floats:
    """Replace the uncertainty of a quantity by the combined one; return its random part."""
    key = f"{name}_standard_uncertainty"
    if key not in values:
        return np.full(np.shape(values.get(name, np.nan)), np.nan)
    random: Floats = values[key]
    values[key] = like_storage(random, combined_standard_uncertainty(rows, random))
    release_pages(rows)
    return random


def _combine_channel(values: Values, name: str, rows: Floats) -> None:
    """Store both parts of a channel's uncertainty: for single readings, and for all samples."""
    key = f"{name}_standard_uncertainty"
    reading = np.asarray(values.get(key, np.full(rows.shape[1:], np.nan)), dtype=np.float64)
    # an unstated error of a reading counts as zero if another error is stated
    random = np.where(np.isnan(reading) & np.any(rows != 0, axis=0), 0.0, reading)
    values[f"{name}_random_standard_uncertainty"] = random
    values[f"{name}_uncertainty_contribution"] = rows
    values[key] = combined_standard_uncertainty(rows, random)


def stated_errors_of(archive: xr.Dataset) -> StatedErrors:
    """Stated standard uncertainties in the reduction of a test."""
    kept = settings_of(archive).get("uncertainty") or {}
    known: dict[str, Any] = {}
    for item in fields(StatedErrors):
        value = kept.get(item.name, item.default)
        if isinstance(item.default, bool):
            if not isinstance(value, bool):
                raise _fault(item.name, value, "true or false")
            known[item.name] = value
            continue
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _fault(item.name, value, "a number in SI")
        known[item.name] = float(value)
    return StatedErrors(**known)


def _fault(name: str, value: object, needed: str) -> ArchiveError:
    return ArchiveError(
        f"the settings of the archive state no standard uncertainty as {name}",
        found=repr(value),
        needed=needed,
    )


_OF_STRAIN = frozenset(
    {
        "position_gain",
        "position_offset",
        "strain_calibration",
        "strain_gain",
        "splice_method",
        "splice_law",
        "splice_friction",
        "splice_slip",
        "machine_compliance",
    }
)
"""Sources that move a point of the curve only along the strain axis."""

# the curve, the modulus used to propagate its strain errors, and their axis
_CURVES = (
    ("branch_tension", "tangent_modulus_untrimmed", "strain_bin"),
    ("branch_tension_first_loading", "tangent_modulus_first_loading", "first_loading_strain_bin"),
)

_OF_CURVE_ALONE = (
    "tension_reversibility", "position_offset", "lag", "stiffness", "attached_mass",
    "linear_density", "machine_compliance",
)  # fmt: skip
"""Possible statements that affect only the curve: neither scales nor the zero of the load."""


def curve_errors_of(archive: xr.Dataset, place: int) -> tuple[SharedErrors, tuple[Note, ...]]:
    """Errors shared by all samples, at the bins of the curve of one specimen."""
    for curve, modulus, axis in _CURVES:
        rows = stored(archive, f"{curve}_uncertainty_contribution")
        if rows is None or modulus not in archive:
            continue
        tension, of_error = archive[curve].values[place], rows.values[:, place]
        slope = archive[modulus].values[place] * float(archive.variables["area"].values[place])
        there = np.isfinite(of_error).all(axis=0) & np.isfinite(tension) & (slope != 0)
        there &= np.isfinite(slope)
        if there.any():
            return _errors(archive, archive[axis].values, tension, of_error, slope, there), ()
    stated = stated_errors_of(archive)
    is_left_out = any(getattr(stated, name) for name in _OF_CURVE_ALONE)
    left_out = (note("no-curve-of-errors"),) if is_left_out else ()
    return _scales_and_zero(archive, place, stated), left_out


def _errors(
    archive: xr.Dataset, strain: Floats, tension: Floats, of_error: Floats, slope: Floats,
    there: Bools,
) -> SharedErrors:  # fmt: skip
    component = components_of(archive)
    tension, slope, there = tension.copy(), slope.copy(), there.copy()
    kept = [k for k, row in enumerate(of_error) if np.any(row[there] != 0)]
    is_strain = np.array([component[k].source in _OF_STRAIN for k in kept], dtype=bool)
    rows = of_error[kept]
    known = np.where(there, rows, np.nan)
    for own, other in ((0, 1), (1, 0)):
        if not there[own].any():
            # the first rise has one branch; a lag has the opposite sign on the way back
            way = np.array([-1.0 if component[k].source == "lag" else 1.0 for k in kept])
            there[own], tension[own], slope[own] = there[other], tension[other], slope[other]
            known[:, own] = way[:, None] * known[:, other]
    moved = -known / np.where(there, slope, np.nan)
    choice = is_strain[:, None, None]
    return SharedErrors(
        tuple(component[k] for k in kept),
        strain=strain,
        tension=tension,
        tension_error=np.where(choice, np.where(there, 0.0, np.nan), known),
        strain_error=np.where(choice, moved, np.where(there, 0.0, np.nan)),
    )


def _scales_and_zero(archive: xr.Dataset, place: int, stated: StatedErrors) -> SharedErrors:
    """Scales of load and strain and zero of the load, which do not need a curve.

    A gauge length, and the scale of the position compared with it, scale every strain; not applied
    to strain without a gauge length.
    """
    gauge = _number(archive, "strain_gauge_length", place)
    spread = _number(archive, "strain_gauge_length_standard_uncertainty", place)
    of_length = (np.nan_to_num(spread) / gauge, stated.position_gain) if gauge > 0 else ()
    return constant_errors(
        tension_gain=stated.tension_gain,
        tension_offset=stated.tension_offset,
        strain_gain=float(np.linalg.norm((stated.strain_gain, *of_length))),
    )


def _number(archive: xr.Dataset, name: str, place: int) -> float:
    """A number for one specimen, or for all; NaN if absent."""
    if name not in archive:
        return float("nan")
    return float(np.broadcast_to(archive.variables[name].values, archive.sizes["specimen"])[place])
