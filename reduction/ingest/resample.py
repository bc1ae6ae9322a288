"""Channels with their own time stamps on one time axis: that of the slowest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reduction.errors import DataError
from reduction.record import Floats

_COUNTED = "cycle_counter"


@dataclass(frozen=True)
class CommonTime:
    """Channels on one time axis.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Of the slowest channel. [s]
    values : dict of str to ndarray, shape (n_samples,)
        By channel key; NaN where a channel has no sample near enough.
    resampled : frozenset of str
        Channels that were interpolated.
    notes : tuple of str
        What was done, with both rates.
    """

    time: Floats
    values: dict[str, Floats]
    resampled: frozenset[str] = frozenset()
    notes: tuple[str, ...] = ()


@dataclass
class _Axis:
    time: Floats
    keys: list[str]

    @property
    def step(self) -> float:
        """Median of the steps forward. [s]."""
        steps = np.diff(self.time)
        steps = steps[steps > 0]
        return float(np.median(steps)) if steps.size else np.nan


def on_common_time(
    shared: Floats | None,
    values: Mapping[str, Floats],
    own: Mapping[str, Floats],
    *,
    gap_factor: float,
) -> CommonTime:
    """Bring channels to the time axis of the slowest by linear interpolation.

    Nothing is interpolated over a gap or a missing value, nor beyond the ends: the
    value is NaN there.  A cycle counter keeps the count of the sample before.

    Parameters
    ----------
    shared : ndarray, shape (n_rows,), optional
        Time of the channels that have no time stamps of their own. [s]
    values : mapping of str to ndarray, shape (n_rows_of_channel,)
        Channels. [any]
    own : mapping of str to ndarray, shape (n_rows_of_channel,)
        Time stamps of the channels that have their own. [s]
    gap_factor : float
        As in `reduction.settings.QualitySettings`. [1]

    Returns
    -------
    common : CommonTime
        The channels as they came where there is one time axis only.

    Raises
    ------
    DataError
        If a channel has no time or fewer than two stamps, or the axes do not overlap.
    """
    axes: list[_Axis] = []
    trimmed: dict[str, Floats] = {}
    for key, series in values.items():
        time = own.get(key, shared)
        if time is None:
            raise DataError(
                f"channel '{key}' has no time",
                found="neither a time channel nor time stamps of its own",
                needed="a time channel, a time_column, or a sample_interval in the layout",
            )
        if own:  # the column of a slower channel ends before the table does
            stamped = np.flatnonzero(np.isfinite(time))
            if stamped.size < 2:
                raise DataError(
                    f"channel '{key}' has too few time stamps",
                    found=str(stamped.size),
                    needed="two or more",
                )
            time, series = time[: stamped[-1] + 1], series[: stamped[-1] + 1]
        trimmed[key] = series
        same = next((axis for axis in axes if _is_same(axis.time, time)), None)
        if same is None:
            axes.append(_Axis(time, [key]))
        else:
            same.keys.append(key)
    if len(axes) == 1:
        return CommonTime(axes[0].time, trimmed)
    base = max(axes, key=lambda axis: axis.step)
    result = {key: trimmed[key] for key in base.keys}
    notes = []
    for axis in axes:
        if axis is base:
            continue
        _check_overlap(base, axis)
        for key in axis.keys:
            result[key] = _interpolate(
                base.time, axis, trimmed[key], gap_factor, is_count=key == _COUNTED
            )
        notes.append(
            f"{', '.join(axis.keys)}: {1 / axis.step:.4g} Hz resampled to the "
            f"{1 / base.step:.4g} Hz of {', '.join(base.keys)} by linear interpolation"
        )
    moved = frozenset(key for axis in axes if axis is not base for key in axis.keys)
    return CommonTime(base.time, {key: result[key] for key in values}, moved, tuple(notes))


def _is_same(one: Floats, other: Floats) -> bool:
    return one is other or np.array_equal(one, other, equal_nan=True)


def _check_overlap(base: _Axis, axis: _Axis) -> None:
    low, high = np.nanmin(axis.time), np.nanmax(axis.time)
    if np.count_nonzero((base.time >= low) & (base.time <= high)) < 2:
        raise DataError(
            "the log has two time bases",
            found=f"{', '.join(base.keys)} from {np.nanmin(base.time):g} to "
            f"{np.nanmax(base.time):g} s, {', '.join(axis.keys)} from {low:g} to {high:g} s",
            needed="time stamps that count from the same moment",
        )


def _interpolate(
    time: Floats, axis: _Axis, series: Floats, gap_factor: float, *, is_count: bool
) -> Floats:
    ahead = np.concatenate([[True], axis.time[1:] > np.fmax.accumulate(axis.time)[:-1]])
    ahead &= np.isfinite(axis.time)
    stamps, series = axis.time[ahead], series[ahead]
    after = np.clip(np.searchsorted(stamps, time), 1, max(stamps.size - 1, 1))
    if is_count:
        place = np.clip(np.searchsorted(stamps, time, side="right") - 1, 0, stamps.size - 1)
        result = series[place]
    else:
        result = np.interp(time, stamps, series)
    in_gap = (stamps[after] - stamps[after - 1] > gap_factor * axis.step) & (
        (time > stamps[after - 1]) & (time < stamps[after])
    )
    outside = ~((time >= stamps[0]) & (time <= stamps[-1]))
    return np.where(in_gap | outside, np.nan, result)
