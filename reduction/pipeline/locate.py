"""Where a test stands still and where it cycles, and which of its samples may be used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.find import find_cycles
from reduction.cycles.product import Cycles
from reduction.errors import DataError
from reduction.phases.constant_tension import find_tension_stands
from reduction.phases.standstill import Standstills, find_standstills
from reduction.record import UNUSABLE, Floats, Quality, Record
from reduction.samples.blocks import copied, sample_blocks
from reduction.samples.scratch import empty_like
from reduction.settings import ReductionSettings

CYCLIC = ("cyclic", "fatigue", "snap", "bedding-in")
PULLED = ("quasi-static", "tensile")
HELD = ("relaxation", "creep")
_REPEATS = Quality.SATURATED | Quality.STUCK


@dataclass(frozen=True)
class Located:
    """A record with its standstills and, where the test has them, its cycles.

    ``position`` (n_samples,) [m] and ``tension`` (n_specimens, n_samples) [N] are those of
    the record, NaN where they are not usable.
    """

    record: Record
    position: Floats
    tension: Floats
    standstills: Standstills
    cycles: Cycles | None


def locate(record: Record, *, kind: str, settings: ReductionSettings) -> Located:
    """Find the standstills and the cycles of a record; only cyclic kinds have cycles."""
    if kind not in (*CYCLIC, *PULLED, *HELD):
        raise DataError(
            f"test '{record.test_id}' is of a kind that this version does not reduce",
            found=kind,
            needed="one of " + ", ".join((*CYCLIC, *PULLED, *HELD, "stepwise")),
        )
    position = usable(record.crosshead_position, record.crosshead_position_quality_flag)
    if kind == "creep" or (settings.cycles.control == "load" and kind != "relaxation"):
        record, standstills = _held_on_tension(record, position, settings)
        tension = usable(record.tension, record.quality_flag)
    else:
        tension = usable(record.tension, record.quality_flag)
        standstills = find_standstills(record.time, position, tension, settings=settings.phases)
    if kind not in CYCLIC:
        return Located(record, position, tension, standstills, None)
    cycles = find_cycles(
        record.time,
        position,
        tension,
        standstills,
        settings=settings.cycles,
        cycle_counter=record.cycle_counter,
    )
    return Located(record, position, tension, standstills, cycles)


def _held_on_tension(
    record: Record, position: Floats, settings: ReductionSettings
) -> tuple[Record, Standstills]:
    """Holds at constant tension, in which a load that repeats one value is no fault."""
    standstills = find_tension_stands(
        record.time,
        position,
        usable(record.tension, record.quality_flag, but=_REPEATS),
        settings=settings.phases,
    )
    flags, freed = copied(record.quality_flag), 0
    for first, last, is_rest in zip(
        standstills.first, standstills.last, standstills.is_rest, strict=True
    ):
        of_hold = flags[:, first : last + 1]
        for part in sample_blocks(0 if is_rest else of_hold.shape[1], flags):
            freed += int(np.count_nonzero(of_hold[:, part] & _REPEATS))
            of_hold[:, part] &= ~np.uint16(_REPEATS)
    if not freed:
        return record, standstills
    note = (
        f"{freed} samples in holds at constant tension repeat one value of it: their flags stuck "
        "and saturated are taken off, since the machine holds it there"
    )
    return replace(record, quality_flag=flags, notes=(*record.notes, note)), standstills


def usable(values: Floats, flags: NDArray[np.uint16], *, but: int = 0) -> Floats:
    """A channel without the samples that no number may rest on, NaN there.

    Flags of the masks ``but`` are passed over.
    """
    masks = UNUSABLE & ~np.uint16(but)
    n_samples = values.shape[-1]
    if not any(np.any(flags[..., part] & masks) for part in sample_blocks(n_samples, flags)):
        return values
    kept = empty_like(values)
    for part in sample_blocks(n_samples, values, flags, kept):
        flagged = (flags[..., part] & masks) != 0
        kept[..., part] = np.where(flagged, np.nan, values[..., part])
    return np.asarray(kept)
