"""What runs say of the line beside their surfaces: K_1 and tau, one time, stiffness forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from reduction.errors import DataError, FitError, SettingsError
from reduction.experiment import RunTable
from reduction.line.identify import identify_by_fundamental
from reduction.line.single import VERDICTS, SingleTimeCheck, check_single_time
from reduction.record import Floats
from reduction.surface.anova import replicate_cells
from reduction.surface.product import ResponseSurfaces
from reduction.surface.stiffness import fit_del_vecchio_stiffness, fit_mean_load_stiffness
from reduction.surface.stiffness_forms import compare_stiffness_forms
from reduction.surface.stiffness_product import FormQuality, StiffnessForm
from reduction.surface.surfaces import fit_surfaces

REFUSALS = (DataError, FitError, SettingsError)
"""What makes a part of an experiment a note in place of a result."""


@dataclass(frozen=True)
class LineOfRuns:
    """What derives K_1 and tau from surfaces of E' and E'', one entry a run. [N]."""

    storage_spring_constant: Floats
    loss_spring_constant: Floats
    quasi_static_spring_constant: Floats


def specimen_blocks(runs: RunTable) -> tuple[str, ...] | None:
    """Specimen of each run, where there are several."""
    return runs.specimen if len(set(runs.specimen)) > 1 else None


def stiffness_of_runs(
    runs: RunTable, surfaces: ResponseSurfaces, response_names: Sequence[str]
) -> tuple[tuple[StiffnessForm, ...], FormQuality | None, list[str]]:
    """Forms that mooring codes ask for, fitted to the apparent spring constant."""
    if "apparent_spring_constant" not in response_names:
        return (), None, []
    spring = runs.response[response_names.index("apparent_spring_constant")]
    used = np.isfinite(spring) & np.isfinite(surfaces.coded).all(axis=1)
    strengths = np.unique(runs.rated_break_strength[used])
    if strengths.size > 1:
        return (), None, [
            "refused: stiffness forms of mooring codes: the runs are of lines of "
            f"{strengths.size} break strengths, or not of every line is one stated"
        ]  # fmt: skip
    strength = float(strengths[0]) if strengths.size and strengths[0] > 0 else None
    spring, frequency = spring[used], runs.frequency[used]
    loads: dict[str, Any] = {
        "mean_tension": runs.mean_tension[used], "rated_break_strength": strength
    }  # fmt: skip
    amplitude = runs.tension_amplitude[used]
    try:
        forms = (
            fit_del_vecchio_stiffness(
                spring, tension_amplitude=amplitude, frequency=frequency,
                load_amplitude="half-range", **loads,
            ),
            fit_mean_load_stiffness(spring, **loads),
        )  # fmt: skip
        quality = compare_stiffness_forms(
            spring, tension_amplitude=amplitude, frequency=frequency,
            coded=surfaces.coded[used], **loads,
        )  # fmt: skip
    except REFUSALS as error:
        return (), None, [f"refused: stiffness forms of mooring codes: {error}"]
    if specimen_blocks(runs) is None:
        return forms, quality, []
    return forms, quality, [
        "stiffness forms of mooring codes pool the specimens: what sets one apart from another "
        "is in their scatter"
    ]  # fmt: skip


def derived_line(
    runs: RunTable, line: LineOfRuns, names: tuple[str, ...], low: Floats, high: Floats
) -> tuple[tuple[Floats, Floats], list[str]]:
    """K_1 and tau at the levels of each run from surfaces of E' and of the logarithm of E''."""
    missing = np.full(len(runs.run), np.nan)
    parts = np.array([line.storage_spring_constant, line.loss_spring_constant])
    try:
        smooth = fit_surfaces(
            runs.level, parts, factor_names=names, low=low, high=high, run_names=runs.names,
            response_names=("storage_spring_constant", "loss_spring_constant"),
            transforms=("none", "log"), blocks=specimen_blocks(runs),
        )  # fmt: skip
    except REFUSALS as error:
        return (missing, missing), [f"refused: K_1 and tau from surfaces of E' and E'': {error}"]
    known = np.isfinite(runs.level).all(axis=1)
    # with the level of the specimen of each run, as its own K_0 is taken off
    storage, loss = smooth.fitted[0], np.exp(smooth.fitted[1])
    if smooth.blocks is not None:
        known &= np.isfinite(smooth.blocks.effect[:, smooth.blocks.index]).all(axis=0)
    found = identify_by_fundamental(
        storage_spring_constant=storage[known],
        loss_spring_constant=loss[known],
        frequency=runs.frequency[known],
        quasi_static_spring_constant=line.quasi_static_spring_constant[known],
    )
    constant, time = missing.copy(), missing.copy()
    constant[known], time[known] = found.dissipation_spring_constant, found.relaxation_time
    return (constant, time), []


def single_time_of_runs(
    runs: RunTable, coded: Floats, frequency: int, response_names: Sequence[str], line: LineOfRuns
) -> tuple[SingleTimeCheck | None, list[str]]:
    """Whether one relaxation time holds: runs at equal loads, as reached, are compared."""
    place = response_names.index("relaxation_time")
    time = runs.response[place]
    used = np.isfinite(time) & np.isfinite(coded).all(axis=1)
    if not used.any():
        return None, ["refused: check of a single relaxation time: no run has one"]
    loads = replicate_cells(np.delete(coded, frequency, axis=1))
    group = [f"{one} {cell}" for one, cell in zip(runs.specimen, loads.tolist(), strict=True)]
    loss = line.loss_spring_constant / line.storage_spring_constant
    try:
        check = check_single_time(
            runs.frequency[used], time[used], loss[used],
            group=np.array(group)[used],
            relative_standard_uncertainty=(runs.response_standard_uncertainty[place] / time)[used],
        )  # fmt: skip
    except REFUSALS as error:
        return None, [f"refused: check of a single relaxation time: {error}"]
    return check, [VERDICTS[int(check.verdict)]]
