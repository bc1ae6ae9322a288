"""Notes of a reduced test."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from reduction.pipeline.located_test import HELD, Located
from reduction.pipeline.plausibility import plausibility_notes
from reduction.record.measurement import Floats, Specimen, Step
from reduction.record.notes import Note, note
from reduction.record.settings import ReductionSettings
from reduction.stages.holds.relaxation import HoldResult
from reduction.stages.standstills import Standstills
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.stress import check_constant_volume


def notes_of_test(
    located: Located,
    strain: Floats,
    *,
    kind: str,
    specimens: tuple[Specimen, ...],
    settings: ReductionSettings,
    holds: tuple[HoldResult, ...],
    parts: Mapping[str, Any],
    of_stages: Iterable[Note],
    slack_remarks: Sequence[Note | None],
) -> tuple[Note, ...]:
    """What a reader has to know before the numbers are used, nothing twice."""
    record, standstills = located.record, located.standstills
    notes = [one for specimen in specimens for one in check_constant_volume(specimen)]
    notes += of_stages
    notes += [note("no-diameter", one.name) for one in specimens if not one.diameter]
    if kind in HELD and not holds:
        notes.append(_no_hold(standstills, settings))
    notes += plausibility_notes(
        strain, specimens=record.specimens, slack_tension=standstills.slack_tension,
        waveform=settings.cycles.waveform, control=settings.cycles.control, cycles=located.cycles,
        loops=parts.get("loops"), curves=parts.get("curves"), is_snap=kind == "snap",
    )  # fmt: skip
    notes += [
        replace(one, subject=name)
        for name, one in zip(record.specimens, slack_remarks, strict=True)
        if one
    ]
    return tuple(notes)


def stage_lines(located: Located, models: Sequence[StrainModel]) -> tuple[Step, ...]:
    """One line a stage, with the numbers it found."""
    record, standstills, cycles = located.record, located.standstills, located.cycles
    lines = [
        Step("ingest", f"{record.n_rows_read} rows read, {record.n_samples} kept"),
        Step(
            "phases",
            f"{standstills.n_standstills} standstills within "
            f"{standstills.position_tolerance:.4g} m"
            + (
                ""
                if standstills.tension_tolerance is None
                else f", holds on tension within {standstills.tension_tolerance:.4g} N"
            )
            + f", slack at {standstills.slack_tension:.4g} N",
        ),
    ]
    for model in models:
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in model.coefficients.items())
        lines.append(Step("strain", f"{model.specimen} by {model.method}: {numbers}"))
    if cycles is not None:
        lines.append(
            Step("cycles", f"{cycles.n_cycles} by {cycles.counted_by}, band {cycles.band:.4g}")
        )
        lines.append(Step("moduli", "regression in a moving window on a strain grid, SI"))
    return tuple(lines)


def _no_hold(standstills: Standstills, settings: ReductionSettings) -> Note:
    """Why a test that was to be held has no number of a hold."""
    held = standstills.tension_tolerance
    of_position = ("the crosshead", standstills.position_tolerance, "m", "position_tolerance")
    channel, tolerance, unit, key = (
        of_position if held is None else ("the tension", held, "N", "tension_tolerance")
    )
    return note(
        "no-hold", slack_tension=standstills.slack_tension, channel=channel, tolerance=tolerance,
        unit=unit, duration=settings.phases.minimum_duration, key=key,
    )  # fmt: skip
