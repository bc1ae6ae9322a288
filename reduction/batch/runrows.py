"""What the archive of a run gives to an experiment: one row a specimen."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.open import Opener, reading
from reduction.archive.shared import shared_contributions
from reduction.archive.stored import stored
from reduction.campaign.plan import Campaign, ExperimentPlan
from reduction.line.product import REASONS
from reduction.record import Bools
from reduction.surface.cautions import MEASURED_SLACK

LINE = ("storage_spring_constant", "loss_spring_constant", "quasi_static_spring_constant")
MEASURED = ("frequency", "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude")
_NEEDS_LINE = {"dissipation_spring_constant", "relaxation_time", "dashpot_coefficient"}
# key of REASONS: no quasi-static spring constant at the mean tension
_NO_REST = 1
# what one run and specimen gives, by name
Row = dict[str, Any]


def rows_of_run(
    campaign: Campaign,
    plan: ExperimentPlan,
    run: str,
    coded: tuple[float, ...],
    path: Path | None,
    opener: Opener = reading,
) -> list[Row]:
    """One row a specimen of a run; a run without an archive has one that says so.

    Raises
    ------
    ArchiveError
        If an archive that is there cannot be read.
    """
    log = run.partition(".")[0]
    specimens = campaign.tests[log].specimens
    about = {"run": run, "coded": coded, "order": _order(campaign, plan, run)}
    if path is None or not path.exists():
        missing = "its test failed" if path is None else "its test gave no product"
        return [about | {"remark": missing, "specimen": name} for name in specimens]
    # one that is there and cannot be read is no run that is missing: surfaces would be other ones
    with opener(path) as archive:
        given = [str(name) for name in archive.variables["specimen"].values]
        return [
            about | row_of_archive(plan, archive, given.index(name), name) for name in specimens
        ]


def _order(campaign: Campaign, plan: ExperimentPlan, run: str) -> float:
    """When a run was done among the others; NaN where the campaign does not state it."""
    log = run.partition(".")[0]
    test = campaign.tests[log]
    # the steps of one log follow each other in it
    is_one_log = all(other.partition(".")[0] == log for other in plan.runs)
    start = test.order if test.order is not None else 0 if test.steps and is_one_log else np.nan
    steps = [step.product(log) for step in test.steps]
    return float(start + (steps.index(run) / len(steps) if run in steps else 0.0))


def row_of_archive(plan: ExperimentPlan, archive: xr.Dataset, place: int, specimen: str) -> Row:
    """What the archive of a run holds of one specimen."""

    def of_test(name: str) -> float:
        stated = stored(archive, f"test_{name}")
        return float("nan") if stated is None else float(stated.values[place])

    remarks = _refusal(plan, archive, place, specimen) if _NEEDS_LINE & set(plan.responses) else []
    row: Row = {name: of_test(name) for name in (*MEASURED, *LINE, *plan.responses)}
    for name in plan.responses:
        # what is shared is no scatter of the run: it goes another way, with its sign
        row[f"u {name}"] = of_test(f"{name}_random_standard_uncertainty")
        if np.isnan(row[f"u {name}"]):
            row[f"u {name}"] = of_test(f"{name}_standard_uncertainty")
    row["shared"] = {
        name: shared_contributions(archive, f"test_{name}", place)
        for name in dict.fromkeys((*MEASURED, *plan.responses))
    }
    settings = json.loads(archive.attrs["settings"])
    begin = int(settings["reduction"]["cycles"]["break_in_cycles"])
    if "peak_tension" in archive:
        peak = archive.variables["peak_tension"].values[place, begin:]
        valley = archive.variables["valley_tension"].values[place, begin:]
        row["peak"], row["least"] = float(np.nanmax(peak)), float(np.nanmin(valley))
        remarks += _slack(valley <= MEASURED_SLACK * peak)
    strength = stored(archive, "rated_break_strength")
    row["strength"] = float("nan") if strength is None else float(strength.values[place])
    return row | {"specimen": specimen, "remark": "; ".join(remarks)}


def _slack(is_slack: Bools) -> list[str]:
    if not is_slack.any():
        return []
    return [f"the line goes slack in {'every cycle' if is_slack.all() else 'some of its cycles'}"]


def _refusal(plan: ExperimentPlan, archive: xr.Dataset, place: int, specimen: str) -> list[str]:
    """Why a run has no K_1 and tau; empty where it has."""
    flags = stored(archive, "test_line_refusal")
    code = _NO_REST if flags is None else int(flags.values[place])
    if code == 0:
        return []
    reason, pull = REASONS[code], plan.quasi_static.get(specimen)
    notes = archive.variables["note"].values.tolist() if "note" in archive else []
    if code == _NO_REST and pull is None:
        reason = "no slow pull is named for the specimen"
    elif code == _NO_REST and any(f"specimen {place + 1} has no slow pull" in one for one in notes):
        reason = f"the slow pull {pull} gave no load-strain curve"
    elif code == _NO_REST and any(f"of the slow pull of {specimen}" in one for one in notes):
        reason = f"the mean tension lies outside the slow pull {pull}"
    return [f"K_1 and tau refused: {reason}"]
