"""Flags of a record, put together from the faults of its series."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from reduction.errors import DataError
from reduction.ingest.constant import find_saturated, find_stuck, find_stuck_position
from reduction.ingest.quality import (
    account_rows,
    find_missing,
    find_outside_range,
    find_spikes,
    noise_of,
    time_faults,
)
from reduction.ingest.stamps import bridge_stamps
from reduction.ingest.steps import find_lone_steps
from reduction.record import Bools, Floats, Quality, Record
from reduction.samples.blocks import (
    count_samples,
    finite_extremes,
    sample_blocks,
    take_samples,
)
from reduction.samples.scratch import zeros_like
from reduction.samples.search import any_sample, first_sample
from reduction.settings import QualitySettings
from reduction.workers import run_blocks

_Flags = NDArray[np.uint16]
_NO_READING = np.uint16(Quality.MISSING | Quality.STUCK)
_TOLD_OTHERWISE = np.uint16(
    Quality.MISSING | Quality.STUCK | Quality.SATURATED | Quality.SPIKE | Quality.GAP
    | Quality.REPEATED_OR_BACKWARD_TIME
)  # fmt: skip
_IMPOSSIBLE_SHARE = 0.01  # of a record in lengths of zero or less: the datum is wrong


def flag_record(
    record: Record,
    *,
    settings: QualitySettings,
    resampled: Sequence[str] = (),
    verified: Mapping[tuple[int, int, int], tuple[float, float]] | None = None,
    notes: Sequence[str] = (),
) -> Record:
    """Return the record with its flags set and what they mean in its notes.

    Parameters
    ----------
    record : Record
        In SI.
    settings : QualitySettings
        When a sample is flagged.
    resampled : sequence of str
        Channel keys (``crosshead_position``, ``tension.1``) that were interpolated.
    verified : mapping of (int, int, int) to (float, float), optional
        By specimen, first row and row after the last: the range that the load cell is
        verified for. [N]
    notes : sequence of str
        Further notes of the record.

    Returns
    -------
    record : Record
        Every row kept.

    Raises
    ------
    DataError
        If a channel holds no number that can be used, a tension is zero throughout, or a
        pin-to-pin length is not positive.
    """
    position_flag: _Flags = zeros_like(record.time, dtype=np.uint16)
    tension_flag: _Flags = zeros_like(record.tension, dtype=np.uint16)
    position = record.crosshead_position
    no_stamp = _missing("time", record.time)
    record = replace(record, time=bridge_stamps(record.time, no_stamp))
    timing = time_faults(
        record.time, gap_factor=settings.gap_factor, rate_tolerance=settings.rate_tolerance
    )
    _set(position_flag, no_stamp, Quality.MISSING)
    _set(position_flag, _missing("crosshead_position", position), Quality.MISSING)
    _set(position_flag, timing.gap, Quality.GAP)
    _set(position_flag, timing.backward, Quality.REPEATED_OR_BACKWARD_TIME)
    _set(position_flag, _spikes(position, settings), Quality.SPIKE)
    if record.position_is_length:
        _set(position_flag, _no_length(position, position_flag), Quality.SPIKE)
    if "crosshead_position" in resampled:
        _set_all(position_flag, Quality.RESAMPLED)

    def flag_tension(index: int) -> None:
        load, flags = record.tension[index], tension_flag[index]
        _set(flags, _missing(f"tension of '{record.specimens[index]}'", load), Quality.MISSING)
        saturated = find_saturated(load, position)
        stuck = find_stuck(load, position, samples=settings.stuck_samples)
        _set(flags, stuck, Quality.STUCK)
        _set(flags, saturated, Quality.SATURATED, instead_of=Quality.STUCK)
        _set(flags, _spikes(load, settings), Quality.SPIKE)
        if f"tension.{index + 1}" in resampled:
            _set_all(flags, Quality.RESAMPLED)

    run_blocks(flag_tension, range(len(record.specimens)))
    for (index, start, stop), (low, high) in (verified or {}).items():
        outside = find_outside_range(record.tension[index, start:stop], low, high)
        _set(tension_flag[index, start:stop], outside, Quality.OUTSIDE_VERIFIED_RANGE)
    stuck = find_stuck_position(position, record.tension, samples=settings.stuck_samples)
    _set(position_flag, stuck, Quality.STUCK)
    flagged = replace(
        record, quality_flag=tension_flag, crosshead_position_quality_flag=position_flag
    )
    found = [*record.notes, *notes]
    first_lost = first_sample(no_stamp.__getitem__, 0, no_stamp.size, no_stamp)
    if first_lost is not None:
        found.append(
            f"{count_samples(no_stamp)} rows have no time, first sample {first_lost + 1}: "
            "their time is that of even steps between the rows beside them, and their position is "
            "not used"
        )
    _check_usable(flagged)
    if timing.n_uneven:
        found.append(
            f"the sampling rate is not constant: {timing.n_uneven} of {record.n_samples - 1} time "
            f"steps differ by more than {settings.rate_tolerance:.0%} from their median "
            f"{timing.step:.4g} s ({timing.shortest:.4g} to {timing.longest:.4g} s, gaps apart)"
        )
    found += _lone_steps(flagged, settings)
    account = account_rows(flagged)
    if any(account.n_flagged.values()):
        listed = "; ".join(
            f"{channel} " + ", ".join(f"{mask} {count}" for mask, count in masks.items())
            for channel, masks in account.n_flagged.items()
            if masks
        )
        found.append(f"{account.n_read} rows read, {account.n_kept} kept, flagged: {listed}")
    return replace(flagged, notes=tuple(found))


def _set(flags: _Flags, where: Bools, mask: Quality, *, instead_of: int = 0) -> None:
    """Set a mask on some samples, and take another off them."""
    for part in sample_blocks(flags.size, flags, where):
        chosen = where[part]
        if chosen.any():
            flags[part][chosen] &= ~np.uint16(instead_of)
            flags[part][chosen] |= np.uint16(mask)


def _set_all(flags: _Flags, mask: Quality) -> None:
    for part in sample_blocks(flags.size, flags):
        flags[part] |= np.uint16(mask)


def _missing(name: str, values: Floats) -> Bools:
    missing = find_missing(values)
    if count_samples(missing) == missing.size:
        raise DataError(
            f"{name} holds no number", found=f"{values.size} missing values", needed="a channel"
        )
    return missing


def _spikes(values: Floats, settings: QualitySettings) -> Bools:
    noise, _ = noise_of(values)
    return find_spikes(values, noise=noise, factor=settings.spike_factor)


def _lone_steps(record: Record, settings: QualitySettings) -> list[str]:
    """A note for each channel that steps, and stays, where what it is measured with does not."""
    position, tension = record.crosshead_position[np.newaxis], record.tension
    of_time = record.crosshead_position_quality_flag
    channels = [("crosshead_position", "m", position[0], tension, of_time)]
    for name, load, of_load in zip(record.specimens, tension, record.quality_flag, strict=True):
        channels.append((f"tension of '{name}'", "N", load, position, of_load))
    noise = [noise_of(channel[2])[0] for channel in channels]
    notes = [""] * len(channels)

    def look(index: int) -> None:
        name, unit, values, beside, flags = channels[index]
        step = find_lone_steps(
            values, beside, noise=noise[index], factor=settings.spike_factor,
            noise_beside=np.array(noise[1:] if index == 0 else noise[:1]),
        )  # fmt: skip
        # what is known against a sample beside it has been told
        told = take_samples(flags, step) | take_samples(flags, step + 1)
        told |= take_samples(of_time, step + 1)
        step = step[(told & _TOLD_OTHERWISE) == 0]
        if step.size:
            first = int(step[0])
            low, high = values[first : first + 2].tolist()
            others = f", and at {step.size - 1} more" if step.size > 1 else ""
            notes[index] = (
                f"{name} steps from {low:.4g} to {high:.4g} {unit} between sample {first + 1} "
                f"({record.time[first]:.6g} s) and the next{others}, and stays there, while "
                f"{'tension does' if index == 0 else 'the position does'} not: a slip, a break, a "
                "zero that was set again, or another unit from there on; numbers across it mix both"
            )

    run_blocks(look, range(len(channels)))
    return [note for note in notes if note]


def _no_length(position: Floats, flags: _Flags) -> Bools:
    """Where a pin-to-pin length is zero or less although nothing else is known against it."""
    not_positive: Bools = zeros_like(position, dtype=bool)
    for part in sample_blocks(position.size, position, flags, not_positive):
        not_positive[part] = (position[part] <= 0) & (flags[part] == 0)
    share = count_samples(not_positive) / position.size
    if share > _IMPOSSIBLE_SHARE:
        raise DataError(
            "a pin-to-pin length is not positive",
            found=f"{share:.0%} of the samples at or below 0 m, least "
            f"{finite_extremes(position)[0]:.4g} m",
            needed="the distance between the pins",
            hint='Set datum = "displacement", with a reference_length where one is known, or '
            "correct zero and sign.",
        )
    return not_positive


def _any_reading(flags: _Flags) -> bool:
    """Whether any sample of a channel holds a number that can be used."""
    return any_sample(lambda part: (flags[part] & _NO_READING) == 0, flags.size, flags)


def _check_usable(record: Record) -> None:
    """Refuse a channel that says nothing, whose flags would leave no sample."""
    position = record.crosshead_position
    if not _any_reading(record.crosshead_position_quality_flag):
        known = position[np.isfinite(position)]
        stuck = f" or stuck at {known.mean():.4g} m while tension changes" if known.size else ""
        raise DataError(
            "the crosshead position has no sample that can be used",
            found=f"{position.size} samples missing{stuck}",
            needed="a position that follows the crosshead",
            hint="Is it the right column, and was the transducer connected?",
        )
    for name, load, flags in zip(
        record.specimens, record.tension, record.quality_flag, strict=True
    ):
        if not count_samples(load):
            raise DataError(
                f"tension of '{name}' is zero throughout",
                found=f"{load.size} samples of 0 N",
                needed="a load cell that is connected, or a test without this specimen",
            )
        if not _any_reading(flags):
            raise DataError(
                f"tension of '{name}' has no sample that can be used",
                found=f"{load.size} samples missing or stuck at {np.nanmean(load):.4g} N",
                needed="a load that changes while the crosshead moves",
            )
