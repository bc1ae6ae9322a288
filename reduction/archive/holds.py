"""Standstills, and the holds that were reduced among them: variables of holds, values of both."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from reduction.archive.reasons import CLOCK
from reduction.archive.values import Values, numbers, pad, texts
from reduction.archive.variable import Variable, count, label, measured, stated
from reduction.holds.product import HoldResult, hold_numbers
from reduction.phases.standstill import Standstills
from reduction.record import Floats

HOLD_ROWS: tuple[Variable, ...] = tuple(
    chain(
        count("hold_number", ("hold",)),
        label("hold_specimen", ("hold",)),
        label("hold_kind", ("hold",)),
        stated("hold_start_time", ("hold",), CLOCK),
        stated("hold_duration", ("hold",), CLOCK),
        stated("hold_ramp_centre_time", ("hold",), CLOCK),
        measured("hold_strain", ("hold",)),
        measured("hold_initial_tension", ("hold",)),
        measured("hold_final_tension", ("hold",)),
        measured("relaxation_drop", ("hold",)),
        measured("relaxation_rate_per_decade", ("hold",)),
        measured("creep_rate_per_decade", ("hold",)),
        measured("tension_at_time", ("hold", "hold_time")),
        measured("strain_at_time", ("hold", "hold_time")),
        measured("prony_tension", ("hold", "prony_term")),
        measured("prony_time", ("hold", "prony_term")),
        measured("long_time_tension", ("hold",)),
        label("hold_criterion", ("hold",)),
        label("hold_refusal", ("hold",)),
    )
)

_PLAIN = (
    "hold_start_time",
    "hold_duration",
    "hold_strain",
    "hold_strain_standard_uncertainty",
    "hold_initial_tension",
    "hold_initial_tension_standard_uncertainty",
    "hold_final_tension",
    "hold_final_tension_standard_uncertainty",
    "relaxation_drop",
    "relaxation_drop_standard_uncertainty",
    "long_time_tension",
    "long_time_tension_standard_uncertainty",
)
_PRONY = (
    "prony_tension",
    "prony_tension_standard_uncertainty",
    "prony_time",
    "prony_time_standard_uncertainty",
)


def standstill_values(standstills: Standstills) -> Values:
    """Return every interval in which the crosshead, or the tension that is kept, stands still."""
    values: Values = {
        "standstill_start_time": standstills.start_time,
        "standstill_end_time": standstills.end_time,
        "standstill_position": standstills.mean_position,
        "standstill_tension": standstills.mean_tension,
        "standstill_is_rest": standstills.is_rest,
        "standstill_position_tolerance": np.array(standstills.position_tolerance),
        "slack_tension": np.array(standstills.slack_tension),
    }
    if standstills.tension_tolerance is not None:
        values["hold_tension_tolerance"] = np.array(standstills.tension_tolerance)
    return values


def hold_values(holds: Sequence[HoldResult]) -> Values:
    """Return one row a hold and specimen, ragged parts padded with NaN."""
    values: Values = {
        "hold": np.arange(1, len(holds) + 1),
        "hold_number": hold_numbers(holds),
        "hold_specimen": texts([one.specimen for one in holds]),
        "hold_kind": texts([one.kind for one in holds]),
        "hold_criterion": texts([one.criterion for one in holds]),
        "hold_refusal": texts(["; ".join(one.refusals) for one in holds]),
    }
    for name in _PLAIN:
        values[name] = numbers([getattr(one, name) for one in holds])
    values["hold_ramp_centre_time"] = numbers([one.ramp_centre_time for one in holds])
    for kind in ("relaxation", "creep"):
        # share of tension and gain of strain are two quantities, so two names
        chosen = [one.kind == kind for one in holds]
        for suffix in ("", "_standard_uncertainty"):
            rate = numbers([getattr(one, f"rate_per_decade{suffix}") for one in holds])
            values[f"{kind}_rate_per_decade{suffix}"] = np.where(chosen, rate, np.nan)
    times = np.unique(np.concatenate([np.empty(0), *(one.times for one in holds)]))
    values["hold_time"] = times
    for name in ("tension_at_time", "strain_at_time"):
        for suffix in ("", "_standard_uncertainty"):
            values[f"{name}{suffix}"] = _on_common_times(holds, f"{name}{suffix}", times)
    for name in _PRONY:
        values[name] = pad([getattr(one, name) for one in holds])
    values["prony_term"] = np.arange(1, values["prony_time"].shape[1] + 1)
    return values


def _on_common_times(holds: Sequence[HoldResult], name: str, times: Floats) -> Floats:
    table = np.full((len(holds), times.size), np.nan)
    for row, one in zip(table, holds, strict=True):
        given = getattr(one, name)
        if given.size:
            row[np.searchsorted(times, one.times)] = given
    return table
