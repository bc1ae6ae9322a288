"""Levels of one record: runs of cycles at one mean, amplitude and period of the control channel.

A mean over cycles at several levels represents none of them.

References
----------
.. [1] ISO 18692-1:2018, "Fibre ropes for offshore stationkeeping - Part 1: General
   specification" (cycles at one mean load and range after another).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import MAD_TO_DEVIATION, runs_of_true
from reduction.record.measurement import Floats
from reduction.record.samples import take_samples
from reduction.record.settings import Waveform
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.periods import counted_on_flanks, own_periods

_STEP = 0.1  # of the range of a cycle: least change, of the mean or of the range, for a level

_STEP_OF_PERIOD = 0.25  # relative: noise shifts the turns of a slow wave by some samples

_NOISE = 5.0  # times the scatter from cycle to cycle, if that is more

_ABRUPT = 5.0  # times the change between neighbouring cycles

_FEWEST = 3  # cycles of a level: two that agree may do so by chance

_BESIDE = 5  # cycles on either side of a step, to judge how steady its levels are

_MOST = 20  # levels; a record with more is a spectrum

_UNLIKE = 0.5  # of the range of a cycle; excess of the ratio of ranges or periods over one

_SAME_PERIOD = 0.25  # relative difference allowed for the first cycle after a ramp


@dataclass(frozen=True)
class Level:
    """Cycles at one level: from ``start`` to ``stop`` [s], mean and half range of the control.

    ``first`` and ``last`` are numbers of the first and last one among the cycles of the record.
    """

    first: int
    last: int
    start: float
    stop: float
    mean: float
    amplitude: float
    frequency: float


def find_levels(
    time: ArrayLike, control: ArrayLike, cycles: Cycles, *, waveform: Waveform = "triangular"
) -> tuple[Level, ...]:
    r"""Levels of the cycles of a record, in the order of time.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time. [s]
    control : array_like, shape (n_samples,)
        The channel that the machine controls, on which the cycles were found. [m] or [N]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search.find_cycles`.
    waveform : {"triangular", "sinusoidal", "other"}
        Waveform of the machine.

    Returns
    -------
    levels : tuple of Level
        Empty if the record has one level or more than 20, if the level changes continually from
        cycle to cycle, or if the cycles between two steps are unlike each other.

    Notes
    -----
    Mean and half range are taken at the turns, periods from flank to flank.  A *step* is a
    change of the mean by a tenth of the range, of the range by a tenth or of the period by a
    quarter, or by five times the scatter from cycle to cycle if that is more.  Neighbours
    that differ by less than half a step belong together; three or more such cycles are a run.  Two
    runs are two levels if the medians of the three cycles on both sides differ by a step, and
    by five times the change between the cycles beside them.  A ramp of the
    amplitude, slow or fast, has no such place and is not cut, nor is a single cycle that
    differs.  Cycles between two levels belong to neither.

    The channel controlled by the machine is used, so that creep of strain in load control, or
    slips of a splice in position control, which change the other channel, make no level.

    Where a ramp leads into the first cycle without a turn, that cycle begins as the ramp
    passes the valley, if it is then as long as the next ones and, for a sine, has the same rise.

    Examples
    --------
    Four cycles about 10, then four about 20, with a ramp between them:

    >>> turns = [9, 11, 9, 11, 9, 11, 9, 11, 9, 19, 21, 19, 21, 19, 21, 19, 21, 19]
    >>> time = np.arange(0.0, 17.01, 0.1)
    >>> control = np.interp(time, np.arange(18), turns)
    >>> at = np.array([0, 20, 40, 60, 90, 110, 130, 150])
    >>> ends = np.column_stack([at, at + 10])
    >>> cycles = Cycles(
    ...     at, at + 20, ends, ends + 10, np.ones((8, 2)), np.zeros(171, np.int32),
    ...     np.zeros(171, np.int8), np.zeros(171, bool), 0.2,
    ... )
    >>> for one in find_levels(time, control, cycles):
    ...     print(round(one.start, 6), round(one.stop, 6), round(one.mean, 6))
    0.0 8.0 10.0
    9.0 17.0 20.0
    """
    times, values = np.asarray(time, dtype=np.float64), np.asarray(control, dtype=np.float64)
    n_cycles = cycles.n_cycles
    if n_cycles < 2 * _FEWEST:
        return ()
    read = _of_cycles(times, values, cycles)
    if not np.isfinite(read).all():
        return ()
    noise = (
        _NOISE * np.median(np.abs(np.diff(read, axis=1)), axis=1) * MAD_TO_DEVIATION / np.sqrt(2)
    )
    change = _in_steps(read[:, :-1], read[:, 1:], noise)
    runs: list[tuple[int, int]] = []
    alike = runs_of_true(change < 0.5)  # steps between cycles: of one fewer than there are cycles
    for first, last in alike[np.ptp(alike, axis=1) >= _FEWEST - 1].tolist():
        if runs and not _is_step(read, change, noise, (runs[-1][1], first)):
            runs[-1] = (runs[-1][0], last)
        else:
            runs.append((first, last))
    if not 2 <= len(runs) <= _MOST:
        return ()
    if any(are_unlike(*_spread(read[:, first : last + 1])) for first, last in runs):
        return ()
    stops = [-1, *(int(cycles.last[last]) for _, last in runs)]
    mean, half, period = read[0], np.exp(read[1]), np.exp(read[2])
    return tuple(
        Level(
            first=first,
            last=last,
            start=_start(
                times,
                values,
                cycles,
                first,
                after=stop,
                period=float(period[first]),
                is_sine=waveform == "sinusoidal",
            ),
            stop=float(times[cycles.last[last]]),
            mean=float(np.median(mean[first : last + 1])),
            amplitude=float(np.median(half[first : last + 1])),
            frequency=float(1 / np.median(period[first : last + 1])),
        )
        for (first, last), stop in zip(runs, stops, strict=False)
    )


def _in_steps(one: Floats, other: Floats, noise: Floats) -> Floats:
    """Distance of two cycles in steps, for the one of three numbers that differs most."""
    least = np.minimum(np.exp(one[1]), np.exp(other[1]))
    ratios = [np.full_like(least, np.log1p(step)) for step in (_STEP, _STEP_OF_PERIOD)]
    size = np.stack([2 * _STEP * least, *ratios])
    floor = np.reshape(noise, (3,) + (1,) * least.ndim)
    return np.asarray((np.abs(other - one) / np.maximum(size, floor)).max(axis=0))


def _is_step(read: Floats, change: Floats, noise: Floats, between: tuple[int, int]) -> bool:
    """Whether the cycles up to one and those from another on are two levels."""
    last, first = between
    before = np.median(read[:, last + 1 - _FEWEST : last + 1], axis=1)
    after = np.median(read[:, first : first + _FEWEST], axis=1)
    step = float(_in_steps(before, after, noise))
    beside = max(
        float(np.median(change[max(last - _BESIDE, 0) : last])),
        float(np.median(change[first : first + _BESIDE])),
    )
    return step >= 1 and step >= _ABRUPT * beside


def _start(
    time: Floats,
    values: Floats,
    cycles: Cycles,
    first: int,
    *,
    after: int,
    period: float,
    is_sine: bool,
) -> float:
    """Beginning of the first cycle of a level, possibly the one before the first found."""
    begin = int(cycles.first[first])
    valley = float(values[begin])
    earliest = int(np.searchsorted(time, time[begin] - (1 + _SAME_PERIOD) * period))
    latest = int(np.searchsorted(time, time[begin] - (1 - _SAME_PERIOD) * period, side="right"))
    earliest = max(earliest, after + 1)
    if latest <= earliest:
        return float(time[begin])
    before = values[earliest : latest + 1]
    passes = np.flatnonzero((before[:-1] < valley) & (before[1:] >= valley))
    # the valley of a level that is reached from above has been found
    is_reached_from_below = passes.size and np.nanmin(values[after + 1 : earliest + 1]) < valley
    if not is_reached_from_below:
        return float(time[begin])
    start = earliest + int(passes[-1])
    begins, peak = (start, begin), int(cycles.branch_last[first, 0])
    is_of_wave = not is_sine or _rises_alike(time, values, begins, peak)
    return float(time[start if is_of_wave else begin])


_ALIKE = 0.05  # of a stroke


def _rises_alike(time: Floats, values: Floats, begins: tuple[int, int], peak: int) -> bool:
    """Whether two successive rises agree to a twentieth, aligned at their middles.

    ``begins`` are their first samples, and ``peak`` is the end of the later one.
    """
    low, high = float(values[begins[1]]), float(values[peak])
    level = (low + high) / 2
    reach = (time[peak] - time[begins[1]]) / 2
    about = np.linspace(-0.9 * reach, 0.9 * reach, 19)
    rises = []
    for begin in begins:
        at = begin + 1 + int(np.argmax(values[begin + 1 : peak + 1] >= level))
        below, above = values[at - 1], values[at]
        share = (level - below) / (above - below) if above > below else 1.0
        middle = time[at - 1] + share * (time[at] - time[at - 1])
        rises.append(np.interp(middle + about, time, values))
    return bool(np.nanmax(np.abs(rises[0] - rises[1])) < _ALIKE * (high - low))


def spread_of_cycles(time: Floats, control: Floats, cycles: Cycles) -> tuple[float, float, float]:
    """Range of the means of nine tenths of the cycles over a cycle's range, and two ratios.

    The ratios are those of the ranges and of the periods.

    Examples
    --------
    Twenty cycles of range 2, then twenty of range 4, about one mean:

    >>> time = np.arange(0.0, 161.0)
    >>> control = np.tile([-1.0, 0.0, 1.0, 0.0], 41)[:161] * np.where(time < 80, 1, 2)
    >>> at = 4 * np.arange(40)
    >>> ends = np.column_stack([at, at + 2])
    >>> cycles = Cycles(
    ...     at, at + 4, ends, ends + 2, np.ones((40, 2)), np.zeros(161, np.int32),
    ...     np.zeros(161, np.int8), np.zeros(161, bool), 0.2,
    ... )
    >>> print(*(round(one, 3) for one in spread_of_cycles(time, control, cycles)))
    0.0 2.0 1.0
    """
    return _spread(_of_cycles(time, control, cycles))


def are_unlike(mean: float, ratio: float, of_periods: float) -> bool:
    """Whether the mean over cycles of such a spread represents none of them."""
    return mean > _UNLIKE or max(ratio, of_periods) > 1 + _UNLIKE


def _spread(read: Floats) -> tuple[float, float, float]:
    low, high = np.quantile(read, [0.05, 0.95], axis=1)
    of_range = 2 * np.exp(np.median(read[1]))
    ratio, of_periods = np.exp(high[1:] - low[1:]).tolist()
    return float((high[0] - low[0]) / of_range), ratio, of_periods


def _of_cycles(time: Floats, values: Floats, cycles: Cycles) -> Floats:
    """Mean, logarithm of half the range and of the period of each cycle, shape (3, n_cycles)."""
    turns = np.stack(
        [cycles.branch_first[:, 0], cycles.branch_last[:, 0], cycles.branch_last[:, 1]]
    )
    begin, peak, end = take_samples(values, turns)
    on_rise, on_fall = counted_on_flanks(cycles)
    valley = (np.where(on_rise, end, begin) + np.where(on_fall, begin, end)) / 2
    start, stop = take_samples(time, np.stack([cycles.first, cycles.last]))
    # where a wave dwells, noise decides where it turns; not so from flank to flank
    period, _ = own_periods(time, values, cycles, stop - start, noise=0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([(peak + valley) / 2, np.log((peak - valley) / 2), np.log(period)])
