"""A step of a rope programme out of its archive, for one specimen."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr

from reduction.errors import ArchiveError
from reduction.line.propertyproduct import (
    BeddingCycles,
    CyclicLevel,
    FirstRise,
    HeldTension,
    PairOfHolds,
    StepOfProgramme,
)
from reduction.record import Floats

__all__ = ["CHANGES_LENGTH", "step_of_archive"]

_HELD = ("quasi-static stiffness", "creep")
CHANGES_LENGTH = ("bedding-in", "dynamic stiffness", *_HELD)
"""Steps that a change-in-length property can come from."""
_U = "_standard_uncertainty"


def step_of_archive(dataset: xr.Dataset, specimen: str) -> StepOfProgramme:
    """What an archive keeps of one specimen of a step.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `reduction.archive.open.open_archive`.
    specimen : str
        Which.

    Returns
    -------
    step : StepOfProgramme
        Its parts are those of the archive; a test that is no step has its first rise alone.

    Raises
    ------
    ArchiveError
        If the archive has no such specimen.
    """
    names = dataset["specimen"].values.astype(str).tolist()
    if specimen not in names:
        raise ArchiveError(f"the archive has no specimen '{specimen}'", found=", ".join(names))
    row = names.index(specimen)
    settings = json.loads(str(dataset.attrs["settings"]))
    bedding = _bedding(dataset, row)
    return StepOfProgramme(
        name=str(dataset.attrs["test"]),
        reference_time=float(settings["reduction"]["rope"]["reference_time"]),
        first_rise=_first_rise(dataset, row),
        bedding=bedding,
        level=None if bedding is not None else _level(dataset, row),
        pairs=_pairs(dataset, specimen),
        holds=_holds(dataset, specimen),
    )


def _first_rise(dataset: xr.Dataset, row: int) -> FirstRise | None:
    """None where fewer than two strains have a tension."""
    name = "branch_tension_first_loading"
    if name not in dataset:
        return None
    tension = dataset[name].values[row, 0]
    grid = dataset["first_loading_strain_bin"].values
    known = np.isfinite(tension) & (grid <= _first_peak(dataset, row))
    if np.count_nonzero(known) < 2:
        return None
    spread = dataset[f"{name}{_U}"].values[row, 0]
    return FirstRise(
        grid[known], tension[known], np.nan_to_num(spread[known]), float(np.diff(grid).min())
    )


def _first_peak(dataset: xr.Dataset, row: int) -> float:
    """Greatest strain until the first cycle is over: what lies beyond is of later cycles."""
    if "cycle_last_sample" not in dataset:
        return float("inf")
    last = int(dataset["cycle_last_sample"].values[0])
    return float(np.nanmax(dataset["strain"].values[row, : last + 1]))


def _bedding(dataset: xr.Dataset, row: int) -> BeddingCycles | None:
    if "bedding_permanent_strain" not in dataset:
        return None

    def of_step(name: str) -> float:
        return float(dataset[name].values[row])

    def of_first(name: str) -> float:
        return float(dataset[name].values[row, 0])

    return BeddingCycles(
        first_stiffness=of_step("bedding_first_stiffness"),
        first_stiffness_standard_uncertainty=of_step(f"bedding_first_stiffness{_U}"),
        permanent_strain=of_step("bedding_permanent_strain"),
        permanent_strain_standard_uncertainty=of_step(f"bedding_permanent_strain{_U}"),
        foot_strain=of_first("mean_strain") - of_first("strain_amplitude"),
        foot_strain_standard_uncertainty=float(
            np.hypot(of_first(f"mean_strain{_U}"), of_first(f"strain_amplitude{_U}"))
        ),
        valley_tension=of_first("valley_tension"),
        first_peak_tension=of_first("peak_tension"),
        peak_tension=float(np.nanmax(dataset["peak_tension"].values[row])),
    )


def _level(dataset: xr.Dataset, row: int) -> CyclicLevel | None:
    if "dynamic_stiffness" not in dataset:
        return None
    names = ("stiffness", f"stiffness{_U}", "mean_tension", "tension_amplitude")
    return CyclicLevel(*(float(dataset[f"dynamic_{name}"].values[row]) for name in names))


def _pairs(dataset: xr.Dataset, specimen: str) -> tuple[PairOfHolds, ...]:
    if "held_pair_specimen" not in dataset:
        return ()
    return tuple(
        _pair(dataset, int(row))
        for row in np.flatnonzero(dataset["held_pair_specimen"].values == specimen)
    )


def _pair(dataset: xr.Dataset, row: int) -> PairOfHolds:
    def of_pair(name: str) -> float:
        return float(dataset[name].values[row])

    reason = str(dataset["static_refusal"].values[row])
    at = of_pair("static_reference_time")
    elapsed = _known(dataset, "static_elapsed_time", row)
    if elapsed.size and not elapsed[0] <= at <= elapsed[-1]:
        reason = (
            f"read off the line beyond the hold, of which there are points from {elapsed[0]:.3g} "
            f"to {elapsed[-1]:.3g} s"
        )
    return PairOfHolds(
        of_pair("held_pair_low_tension"), of_pair("held_pair_high_tension"),
        of_pair("static_stiffness"), of_pair(f"static_stiffness{_U}"), at, reason,
    )  # fmt: skip


def _known(dataset: xr.Dataset, name: str, row: int) -> Floats:
    values: Floats = dataset[name].values[row] if name in dataset else np.empty(0)
    return values[np.isfinite(values)]


def _holds(dataset: xr.Dataset, specimen: str) -> tuple[HeldTension, ...]:
    """Holds of a step at which the machine kept the tension."""
    step = str(dataset["programme_step"].values) if "programme_step" in dataset else ""
    if step not in _HELD or "hold_specimen" not in dataset:
        return ()
    is_own = dataset["hold_specimen"].values == specimen
    tensions = dataset["hold_initial_tension"].values + dataset["hold_final_tension"].values
    start = dataset["hold_start_time"].values
    ends = start + dataset["hold_duration"].values
    centre = dataset["hold_ramp_centre_time"].values
    begins = np.where(np.isfinite(centre), centre, start)
    return tuple(
        HeldTension(
            float(tensions[row]) / 2,
            float(ends[row] - begins[row]),
            float(dataset["creep_rate_per_decade"].values[row]),
            float(dataset[f"creep_rate_per_decade{_U}"].values[row]),
            str(dataset["hold_refusal"].values[row]),
        )
        for row in np.flatnonzero(is_own & (dataset["hold_kind"].values == "creep"))
    )
