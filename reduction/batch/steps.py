"""One step of a log that holds several: its rows, and the plan of a test of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reduction.campaign.plan import StepPlan, TestPlan
from reduction.errors import DataError
from reduction.pipeline.locate import locate
from reduction.record import Record


def _slice(record: Record, first: int, stop: int) -> Record:
    """The rows from ``first`` up to ``stop``, as a record of its own."""
    part = slice(first, stop)
    return replace(
        record,
        time=record.time[part],
        crosshead_position=record.crosshead_position[part],
        tension=record.tension[:, part],
        quality_flag=record.quality_flag[:, part],
        crosshead_position_quality_flag=record.crosshead_position_quality_flag[part],
        measured_strain=None if record.measured_strain is None else record.measured_strain[:, part],
        cycle_counter=None if record.cycle_counter is None else record.cycle_counter[part],
        n_rows_read=stop - first,
    )


def step_record(record: Record, step: StepPlan, plan: TestPlan) -> Record:
    """The rows of one step of a log."""
    if step.time_range is not None:
        low, high = step.time_range
        inside = np.flatnonzero((record.time >= low) & (record.time <= high))
        if inside.size == 0:
            raise DataError(
                f"step '{step.name}' of test '{plan.id}' holds no row of the log",
                found=f"{record.time[0]:g} to {record.time[-1]:g} s in the log",
                needed=f"rows from {low:g} to {high:g} s",
            )
        return _slice(record, int(inside[0]), int(inside[-1]) + 1)
    whole = locate(record, kind="cyclic", settings=plan.settings)
    first, last = step.cycle_range or (1, 1)
    if whole.cycles is None or not 1 <= first <= last <= whole.cycles.n_cycles:
        raise DataError(
            f"step '{step.name}' of test '{plan.id}' asks for cycles that the log lacks",
            found=f"cycles {first} to {last}",
            needed=f"1 to {0 if whole.cycles is None else whole.cycles.n_cycles}",
        )
    return _slice(record, int(whole.cycles.first[first - 1]), int(whole.cycles.last[last - 1]) + 1)


def step_plan(plan: TestPlan, step: StepPlan, place: int) -> TestPlan:
    """The plan of one step as that of a test."""
    cycles = replace(plan.settings.cycles, expected_cycles=step.expected_cycles)
    note = {"step": step.name} | ({"step_note": step.note} if step.note else {})
    return replace(
        plan,
        id=step.product(plan.id),
        kind=step.kind,
        target_strain=step.target_strain or plan.target_strain,
        settings=replace(plan.settings, cycles=cycles),
        attributes=plan.attributes | note,
        step_place=place,
        failed=step.failed,
        steps=(),
    )
