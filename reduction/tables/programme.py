"""Tables of the steps of a rope laboratory's programme: one row a step and specimen, or a hold."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.record import Integers
from reduction.tables.table import Table, Variables

_BEDDING = (
    "bedding_cycles",
    "bedding_first_stiffness",
    "bedding_first_stiffness_over_strength",
    "bedding_last_stiffness",
    "bedding_last_stiffness_over_strength",
    "bedding_stiffening",
    "bedding_permanent_strain",
)
_DYNAMIC = (
    "dynamic_cycles",
    "dynamic_frequency",
    "dynamic_mean_tension",
    "dynamic_mean_tension_over_strength",
    "dynamic_tension_amplitude",
    "dynamic_tension_amplitude_over_strength",
    "dynamic_stiffness",
    "dynamic_stiffness_over_strength",
    "dynamic_stiffness_drift",
)
_STATIC = (
    "held_pair_low_tension",
    "held_pair_high_tension",
    "static_reference_time",
    "static_stiffness",
    "static_stiffness_over_strength",
    "static_stiffness_per_decade",
    "static_stiffness_per_decade_over_strength",
)
_CREEP = (
    "creep_rate_per_decade",
    "creep_tension_over_strength",
    "creep_compliance_per_decade",
)
_LASTED = (
    "cycles_to_failure",
    "cycles_are_run_out",
    "failure_peak_tension",
    "failure_peak_tension_over_strength",
    "failure_valley_tension",
    "failure_judged_by",
    "earlier_cycles",
)
_PULLED = (
    "tensile_strength",
    "strain_at_failure",
    "pull_is_break",
    "pull_peak_tension",
    "pull_peak_tension_over_strength",
    "pull_peak_strain",
)


def _one_a_specimen(archive: xr.Dataset) -> Variables:
    """Give a step one static stiffness and one creep: of its last pair, its longest hold."""
    if "programme_step" not in archive:
        return {}
    found: dict[str, xr.Variable] = {}
    names = archive.variables["specimen"].values.tolist()
    if "static_stiffness" in archive:
        given = np.isfinite(archive.variables["static_stiffness"].values).astype(np.float64)
        last = _chosen(archive.variables["held_pair_specimen"].values.tolist(), names, given)
        found |= _along_specimen(archive, _STATIC, "held_pair", last)
    if "hold_specimen" in archive:
        longest = _chosen(
            archive.variables["hold_specimen"].values.tolist(),
            names,
            archive.variables["hold_duration"].values,
        )
        found |= _along_specimen(archive, _CREEP, "hold", longest)
    return found


def _chosen(of_row: list[str], names: list[str], rank: np.ndarray) -> Integers:
    """Row of the highest rank of each specimen, the last of those alike; -1 where it has none."""
    found = [
        max((rank[row], row) for row, own in enumerate(of_row) if own == name)[1]
        if name in of_row
        else -1
        for name in names
    ]
    return np.array(found)


def _along_specimen(
    archive: xr.Dataset, names: tuple[str, ...], dim: str, rows: Integers
) -> dict[str, xr.Variable]:
    every = [f"{name}{suffix}" for name in names for suffix in ("", "_standard_uncertainty")]
    return {
        name: xr.Variable(
            "specimen", np.where(rows >= 0, archive.variables[name].values[rows], np.nan)
        )
        for name in every
        if name in archive and archive.variables[name].dims == (dim,)
    }


ROPE_TABLES = (
    Table(
        "rope_programme",
        ("specimen",),
        ("programme_step", *_BEDDING, *_DYNAMIC, *_STATIC, *_CREEP, *_LASTED, *_PULLED),
        ("programme_step",),
        _one_a_specimen,
    ),
    Table(
        "static_stiffness",
        ("held_pair",),
        (
            "specimen=held_pair_specimen",
            "held_pair_low_hold",
            "held_pair_high_hold",
            *_STATIC,
            "static_refusal",
        ),
        ("held_pair",),
    ),
    Table(
        "static_stiffness_times",
        ("held_pair", "held_pair_point"),
        ("specimen=held_pair_specimen", "static_elapsed_time", "static_stiffness_at_time"),
        ("static_stiffness_at_time",),
    ),
    Table(
        "creep",
        ("hold",),
        (
            "specimen=hold_specimen",
            "hold_number",
            "hold_duration",
            "hold_ramp_centre_time",
            "hold_initial_tension",
            "hold_final_tension",
            *_CREEP,
        ),
        ("creep_tension_over_strength",),
    ),
    Table("tensile", ("specimen",), _PULLED, ("pull_peak_tension",)),
)
