"""Finds the steps of a log without stated ones: its levels, in the form of campaign.toml."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reduction.campaign.plan import Campaign, StepPlan, TestPlan
from reduction.pipeline.located_test import Located
from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.cycle_search import control_channel
from reduction.stages.cycles.levels import Level, are_unlike, find_levels, spread_of_cycles
from reduction.stages.standstills import median_step

FOUND = {"step_origin": "found in the record, where campaign.toml states no steps"}
"""Attribute of the product of a found step."""

_CUT = ("cyclic",)  # cycles of a fatigue test are counted to failure across its levels

_LOOKED_AT = (*_CUT, "fatigue")


@dataclass(frozen=True)
class _FoundSteps:
    """Steps found (none in a log with one level), and the remark on the log."""

    steps: tuple[StepPlan, ...] = ()
    remark: Note | None = None


def find_steps(plan: TestPlan, located: Located, campaign: Campaign) -> _FoundSteps:
    """Find the levels of a cyclic log without stated steps."""
    if located.cycles is None or plan.kind not in _LOOKED_AT:
        return _FoundSteps()
    time, cycles = located.record.time, located.cycles
    control = control_channel(located.position, located.tension, plan.settings.cycles)
    levels = find_levels(time, control, cycles, waveform=plan.settings.cycles.waveform)
    ranges = [_written(level, median_step(time)) for level in levels]
    steps = _in_toml(ranges)
    if levels and plan.kind in _CUT:
        _refuse_one_name(plan, levels, steps, campaign)
        left_out = cycles.n_cycles - sum(one.last - one.first + 1 for one in levels)
        found = note("levels-found", n_levels=len(levels), steps=steps, n_left_out=left_out)
        return _FoundSteps(_as_steps(plan, ranges), found)
    return _FoundSteps(remark=_on_spread(time, control, cycles, steps))


def remark_on_cycles(plan: TestPlan, located: Located) -> Note | None:
    """Remark on a stated step with dissimilar cycles."""
    if located.cycles is None or plan.kind not in _LOOKED_AT:
        return None
    control = control_channel(located.position, located.tension, plan.settings.cycles)
    return _on_spread(located.record.time, control, located.cycles)


def _on_spread(time: Floats, control: Floats, cycles: Cycles, steps: str = "") -> Note | None:
    spread = spread_of_cycles(time, control, cycles)
    if not steps and not are_unlike(*spread):
        return None
    mean, ratio, of_periods = spread
    return note("cycles-unlike", mean=mean, ratio=ratio, of_periods=of_periods, steps=steps)


def _refuse_one_name(
    plan: TestPlan, levels: Sequence[Level], steps: str, campaign: Campaign
) -> None:
    """Refuse several levels if the campaign uses the test as a single one."""
    named = [
        f"experiment '{name}'" for name, one in campaign.experiments.items() if plan.id in one.runs
    ]
    named += [
        f"comparison '{name}'"
        for name, one in campaign.comparisons.items()
        if one.measured == plan.id
    ]
    if named:
        raise DataError(
            f"the log of test '{plan.id}' contains several levels, but {named[0]} uses it as one",
            found=", ".join(
                f"{one.last - one.first + 1} cycles from {one.start:g} to {one.stop:g} s"
                for one in levels
            ),
            needed=f"that level as a step of [tests.{plan.id}], and the name of this step instead",
            hint=f"Found: {steps}",
        )


def _written(level: Level, step: float) -> tuple[str, str]:
    """Start and end in seconds, with enough digits to include exactly the rows of the level.

    Examples
    --------
    >>> _written(Level(0, 9, 15.0503, 591.0503, 0.0, 1.0, 0.1), 0.05)
    ('15.050', '591.051')
    """
    digits = max(0, 1 - math.floor(math.log10(step)))
    unit = 10.0**-digits
    # a time on a boundary is kept within a thousandth of a unit
    low = math.floor(level.start / unit + 1e-3) * unit
    high = math.ceil(level.stop / unit - 1e-3) * unit
    return f"{low:.{digits}f}", f"{high:.{digits}f}"


def _name(place: int) -> str:
    return f"level {place}"


def _in_toml(ranges: Sequence[tuple[str, str]]) -> str:
    """One line for the table of a test in campaign.toml; empty without levels."""
    steps = (
        f'{{ name = "{_name(place)}", from = "{start} s", to = "{stop} s" }}'
        for place, (start, stop) in enumerate(ranges, start=1)
    )
    return f"steps = [{', '.join(steps)}]" if ranges else ""


def _as_steps(plan: TestPlan, ranges: Sequence[tuple[str, str]]) -> tuple[StepPlan, ...]:
    return tuple(
        StepPlan(
            name=_name(place),
            kind=plan.kind,
            time_range=(float(start), float(stop)),
            cycle_range=None,
            expected_cycles=None,
        )
        for place, (start, stop) in enumerate(ranges, start=1)
    )
