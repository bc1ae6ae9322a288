"""Samples of a hold and the ramp before it, taken from a record.

The start and end of each hold are found in `reduction.stages.standstills`.  To first order a ramp
acts as a step at the centre of the tension that it adds, whatever the law of relaxation; the
remaining error falls with the square of ramp time over elapsed time.

References
----------
.. [1] L. J. Zapas and J. C. Phillips, "Simple shearing flows in polyisobutylene solutions," J.
   Res. Natl. Bur. Stand. 75A(1), 1971 (half of the ramp time as the zero of time).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_increasing, as_same_shape
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note
from reduction.record.samples import (
    empty_like,
    finite_extremes,
    last_sample,
    mean_of,
    sample_blocks,
    select_samples,
    shifted,
)
from reduction.stages.approach import find_approach, last_motion
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.holds.ramp_end import (
    FEWEST_STEPS,
    level_at_end,
    ramp_end_time,
    time_to_stop,
)
from reduction.stages.holds.relaxation_numbers import (
    TENSION_TOLERANCE,
    end_mean,
    logarithmic_blocks,
)
from reduction.stages.moduli.splice_slip import sample_noise
from reduction.stages.standstills import Standstills

_EMPTY = np.empty(0)

BESIDE = 0.05
"""Share of a ramp on either side of its end in which a log may peak."""

SAMPLES_BESIDE = 5
"""Readings on either side at least."""


@dataclass(frozen=True)
class _Ramp:
    """The ramp that led to a hold.

    ``stiffness`` is the slope at its end of the channel that answers: tension over position [N/m],
    under load control strain over tension, a compliance [1/N].  ``centre_time`` is that of what the
    answering channel adds, ``driven_centre_time`` that of the channel that the machine moves. [s]
    """

    start_time: float
    end_time: float
    centre_time: float
    duration: float
    stiffness: float
    end_uncertainty: float = 0.0
    # tension at even times up to the end, NaN after the last reading; empty if none is added [N]
    tension: Floats = field(default_factory=lambda: _EMPTY)
    driven_centre_time: float = float("nan")

    @property
    def length(self) -> float:
        """Duration from its first sample to its end. [s]."""
        return self.end_time - self.start_time

    def added(self, at_end: float) -> Floats | None:
        """Tension added at even times up to the end, where it is ``at_end``; None where none is."""
        if not self.tension.size:
            return None
        tension = np.append(self.tension[:-1], at_end)
        known = np.flatnonzero(np.isfinite(tension))
        even: Floats = np.interp(np.arange(tension.size), known, tension[known]) - tension[0]
        return even


def _find_ramp(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, *, band: float
) -> _Ramp | None:
    r"""Last monotonic motion of a record that ends where a hold begins.

    .. math:: t_c = t_1 - \int_{t_0}^{t_1} \frac{T - T_0}{T_1 - T_0} dt

    is the centre of the tension that the ramp adds; the spread is its second moment.

    Notes
    -----
    The half-ramp rule ([1]_) is the case of tension that rises evenly.  A tension that
    stiffens with stretch has a later centre.  Where the ramp does not add
    tension (unloading), the centre of position is taken.  Both moments are integrals of
    the record, not of its differences, so noise hardly affects them.  The ramp begins at
    the last sample within ``band`` of its far end, which is late by the time that the
    crosshead takes to cross the band.  It ends between two samples (`ramp_end_time`).

    Examples
    --------
    >>> t = np.arange(0.0, 5.0)
    >>> ramp = _find_ramp(t, [0.0, 0.0, 1.0, 2.0, 3.0], [0.0, 0.0, 10.0, 20.0, 30.0], band=0.1)
    >>> ramp.start_time, ramp.centre_time, ramp.duration, round(ramp.stiffness, 6)
    (1.0, 2.5, 3.0, 10.0)
    >>> _find_ramp(t, [0.0, 0.0, 1.0, 1.0, 1.0], [9.0, 9.0, 9.0, 9.0, 9.0], band=2.0) is None
    True
    """
    seconds = as_increasing("time", time)
    seconds, place, load = as_same_shape(time=seconds, position=position, tension=tension)
    way = last_motion(place, band)
    if way is None:
        return None
    # The last sample within the band of the far end: a standstill there is not part of the ramp.
    first = last_sample(
        lambda part: way.sign * (place[part] - place[-1]) >= way.reach - band,
        way.first, place.size, place,
    )  # fmt: skip
    seconds, place, load = seconds[first:], place[first:], load[first:]
    end = float(seconds[-1])
    adds = load if load[-1] > load[0] else place
    lowest, rise = float(adds[0]), float(adds[-1] - adds[0])
    if rise == 0:  # a log too coarse for the motion: it came back to the reading that it left
        return None
    if adds is load:
        # a machine that rings as it stops may read far below what the ramp has added
        highest = float(np.max(load[-1 - SAMPLES_BESIDE :])) - lowest
        rise = highest if highest - rise > _RINGS * highest else rise
    before = square = driven = 0.0
    for part in sample_blocks(seconds.size, seconds, adds, overlap=1):
        added, left = (adds[part] - lowest) / rise, end - seconds[part]
        before += float(np.trapezoid(added, seconds[part]))
        way_made = (place[part] - place[0]) / (place[-1] - place[0])
        driven += float(np.trapezoid(way_made, seconds[part]))
        # Exact where both factors are straight between samples: a ramp may have few of them.
        middle = (left[1:] + left[:-1]) * (added[1:] + added[:-1]) / 2
        both = left[1:] * added[1:] + left[:-1] * added[:-1] + 2 * middle
        square += float(np.diff(seconds[part]) @ both) / 3
    centre = end - before
    spread = max(0.0, square - before**2)
    ended, end_uncertainty = ramp_end_time(seconds, place, band=band)
    begins = -ramp_end_time(-seconds[::-1], place[::-1], band=band)[0]
    on_ramp = int(np.searchsorted(seconds, ended))
    return _Ramp(
        start_time=float(seconds[0]),
        end_time=ended,
        centre_time=min(end, max(float(seconds[0]), centre)),
        duration=min(end - float(seconds[0]), float(np.sqrt(12 * spread))),
        stiffness=_upper_slope(place, load),
        end_uncertainty=end_uncertainty,
        # a chord across the corner at either end would miss it
        tension=np.interp(
            np.linspace(seconds[0], ended, _TIMES_OF_RAMP),
            np.concatenate([seconds[:1], [begins], seconds[1:on_ramp], [ended]]),
            np.concatenate([load[:1], load[:1], load[1:on_ramp], [np.nan]]),
        )
        if adds is load
        else _EMPTY,
        driven_centre_time=end - driven,
    )


_TIMES_OF_RAMP = 65

_RINGS = 0.02  # of the tension that a ramp adds


def _begins_inside(position: ArrayLike, *, band: float) -> bool:
    """Whether a series shows where its last motion began, so that earlier samples do not matter.

    Examples
    --------
    >>> _begins_inside([0.0, 1.0, 2.0], band=0.1), _begins_inside([5.0, 0.0, 1.0, 2.0], band=0.1)
    (False, True)
    """
    way = last_motion(np.asarray(position, dtype=np.float64), band)
    return way is not None and way.turned


def _upper_slope(place: Floats, load: Floats) -> float:
    """Slope of tension on position over the last half of a stroke; NaN where it has none."""
    half = 0.5 * abs(place[-1] - place[0])
    x, y = select_samples(lambda part: np.abs(place[part] - place[-1]) <= half, place, load)
    middle, level = mean_of(x), mean_of(y)
    square = product = 0.0
    for part in sample_blocks(x.size, x, y):
        off = x[part] - middle
        square += float(off @ off)
        product += float(off @ (y[part] - level))
    low, high = finite_extremes(x)
    return product / square if high > low else float("nan")


SIGNIFICANT = 3.0


@dataclass(frozen=True)
class Hold:
    """One specimen in one hold: finite samples in order, and the ramp before them.

    Parameters
    ----------
    time, position, tension, strain : ndarray, shape (n_samples,)
        Samples of the hold. [s], [m], [N], [1]
    start_time : float
        End of the approach to the hold. [s]
    ramp : Ramp or None
        None where the record does not show it.
    position_tolerance : float
        Range of position allowed inside the standstill. [m]
    slack_tension : float
        Tension at or below which the specimen is slack. [N]
    logged_peak, ramp_peak, earlier_peak : float
        Greatest reading of tension near the end of the ramp; the greatest of these before the
        ramp ends; the greatest in the last half of the ramp, before these.  NaN where the ramp
        does not add tension. [N]
    ramp_leads_to, ramp_leads_to_within : float
        Tension, extrapolated from the last readings of the ramp to the length where it
        ends, and its noise; NaN where it is not known. [N]
    n_logged : int
        Number of samples in the log, including those that are left out. [1]
    on_tension : bool
        Whether the machine controls the tension, so that the length responds.
    refusals, notes : list of Note
        Filled as the hold is reduced; so is ``made``, the history.
    """

    time: Floats
    position: Floats
    tension: Floats
    strain: Floats
    start_time: float
    ramp: _Ramp | None
    position_tolerance: float
    slack_tension: float = 0.0
    logged_peak: float = float("nan")
    ramp_peak: float = float("nan")
    earlier_peak: float = float("nan")
    ramp_leads_to: float = float("nan")
    ramp_leads_to_within: float = float("nan")
    n_logged: int = 0
    on_tension: bool = False
    refusals: list[Note] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)
    made: list[str] = field(default_factory=list)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample. [s]."""
        return float(self.time[-1] - self.time[0]) if self.time.size else 0.0

    @cached_property
    def tension_noise(self) -> float:
        """Standard deviation of one reading of tension, its quantum included. [N]."""
        return _noise_of(self.tension)

    @cached_property
    def tension_step(self) -> float:
        """Step of the converter of tension; 0 where noise spreads readings over codes. [N]."""
        return _step_of(self.tension)

    @cached_property
    def motion(self) -> _Motion:
        """Motion of the crosshead since the end of the ramp, in blocks of the logarithm of time."""
        return _motion_of(self)

    @property
    def strain_uncertainty(self) -> float:
        """Type A uncertainty of its mean strain; NaN with fewer than two readings. [1]."""
        (known,) = select_samples(lambda part: np.isfinite(self.strain[part]), self.strain)
        if known.size < 2:
            return float("nan")
        return end_mean(known, n_samples=known.size)[1]

    @property
    def ramp_end_time(self) -> float:
        """End of the ramp, or the first sample where none is known. [s]."""
        return float(self.time[0]) if self.ramp is None else self.ramp.end_time

    @property
    def since_centre(self) -> Floats:
        """Time from the centre of the ramp, or from the first sample where none is known. [s]."""
        centre = self.time[0] if self.ramp is None else self.ramp.centre_time
        return shifted(self.time, float(centre))

    @property
    def ramp_is_within_steps(self) -> bool:
        """Whether the ramp takes at most two steps of the log: each is cut short."""
        if self.ramp is None or self.time.size < 2:
            return False
        step = float(self.time[1] - self.time[0])
        return self.ramp.length <= (FEWEST_STEPS - 1) * (1 + 1e-6) * step

    @property
    def ramp_duration(self) -> float:
        """Duration of the equivalent constant-rate ramp; 0 where none is known. [s]."""
        return 0.0 if self.ramp is None else self.ramp.duration


def _noise_of(series: Floats) -> float:
    """Standard deviation of one reading, its quantum included."""
    return float(np.hypot(reading_noise(series), _step_of(series) / np.sqrt(12)))


def _step_of(series: Floats) -> float:
    """Step of a converter, where readings have less noise than half of it; else 0."""
    quantum = sample_noise(series)[1]
    return quantum if reading_noise(series) < quantum / 2 else 0.0


@dataclass(frozen=True)
class _Motion:
    """Motion of the crosshead after the end of its ramp.

    ``time`` and ``distance``, shape (n_blocks,), are block means [s], [m]; ``greatest`` the
    greatest of them, signed, zero where none differs significantly from noise; ``known_to`` the
    standard uncertainty of the position that they count from, zero where noise explains it [m].
    """

    time: Floats
    distance: Floats
    greatest: float
    known_to: float


def _motion_of(hold: Hold) -> _Motion:
    """Motion of the crosshead since the end of the ramp, on blocks in the logarithm of time."""
    # from few readings the noise is known to a few over the root of their number
    noise = _noise_of(hold.position) * (1 + 3 / np.sqrt(hold.position.size))
    since = shifted(hold.time, hold.ramp_end_time)
    begin = level_at_end(since, hold.position, noise=noise, step=_step_of(hold.position))
    later = int(np.searchsorted(since, 0.0, side="right"))
    if since.size - later < 2:
        return _Motion(np.empty(0), np.empty(0), 0.0, 0.0)
    blocks = logarithmic_blocks(since[later:], hold.position[later:], per_decade=10)
    quantum = sample_noise(hold.position)[1]
    # for a crosshead that stands, the initial position is known to its noise
    own = min(begin.standard_uncertainty, _NOISE_OF_BEGIN * noise)
    spread = np.hypot(
        np.hypot(noise / np.sqrt(blocks.count), own),
        quantum / np.sqrt(12) if noise < quantum / 2 else 0.0,
    )
    distance = blocks.value - begin.value
    least = np.maximum(_MOTION_TOLD * spread, _ROUNDED * abs(begin.value))
    told = np.where(np.abs(distance) > least, distance, 0.0)
    return _Motion(
        blocks.elapsed + hold.ramp_end_time, distance, float(told[np.argmax(np.abs(told))]),
        begin.standard_uncertainty if begin.standard_uncertainty > own else 0.0,
    )  # fmt: skip


_NOISE_OF_BEGIN = 3.0  # at most, for a line through three readings

_MOTION_TOLD = 5.0  # standard uncertainties: some fifty blocks are tested

_LOOKED_BACK = 1 << 16
"""Samples before a hold in which its ramp is first looked for: many cycles may lie between two
holds."""


def _finite_times(part: slice, time: Floats, *series: Floats) -> Floats:
    """Times of the samples of a part, -inf where one of their values is not finite."""
    finite = np.isfinite(time[part])
    for one in series:
        finite &= np.isfinite(one[part])
    return np.where(finite, time[part], -np.inf)


def _is_finite_and_later(time: Floats, *series: Floats, after: float = -np.inf) -> Bools:
    """Mark samples with finite values and a time later than all before."""
    is_finite_and_later, latest = empty_like(time, dtype=bool), after
    for part in sample_blocks(time.size, time, *series, is_finite_and_later):
        known = _finite_times(part, time, *series)
        reached = np.maximum.accumulate(np.concatenate([[latest], known]))
        np.greater(known, reached[:-1], out=is_finite_and_later[part])
        latest = float(reached[-1])
    return is_finite_and_later


def _latest(time: Floats, *series: Floats) -> float:
    """Latest time of samples whose values are finite."""
    latest = -np.inf
    for part in sample_blocks(time.size, time, *series):
        latest = _finite_times(part, time, *series).max(initial=latest)
    return float(latest)


def _ramp_before(time: Floats, moved: Floats, answer: Floats, *, band: float) -> _Ramp | None:
    """The ramp that ends with the last sample, found in as many samples as show where it began."""
    n_looked = 0
    while n_looked < time.size:
        n_looked = min(max(2 * n_looked, _LOOKED_BACK), time.size)
        start = time.size - n_looked
        whole = time, moved, answer
        looked = [one[start:] for one in whole]
        is_finite_and_later = _is_finite_and_later(
            *looked, after=_latest(*(one[:start] for one in whole))
        )
        before = select_samples(is_finite_and_later.__getitem__, *looked)
        if before[0].size > 2 and _begins_inside(before[1], band=band):
            break
    return _find_ramp(*before, band=band) if before[0].size > 2 else None


_SETTLES = 0.5  # of the way between two holds: a shorter last motion is a controller that settles

_SETTLING_RAMPS = 3.0  # ramp times: no controller takes longer to settle, so the machine cycled


def _without_settling(
    ramp: _Ramp,
    time: Floats,
    moved: Floats,
    answer: Floats,
    *,
    band: float,
    left: float,
    level: float,
) -> _Ramp:
    """The ramp that first reached the level of a hold, where the controller overshot it."""
    begins = moved[np.searchsorted(time, ramp.start_time)]
    if not abs(level - begins) < _SETTLES * abs(level - left):
        return ramp
    sign = np.sign(level - left)
    reached = np.fmin(np.fmax.accumulate(sign * moved), sign * level)
    found = _ramp_before(time, sign * reached, answer, band=band)
    at_level = time[np.argmax(reached)]
    if found is None or time[-1] - at_level > _SETTLING_RAMPS * (at_level - found.start_time):
        return ramp
    return found


def _with_time_to_stop(
    ramp: _Ramp, time: Floats, position: Floats, first: int, held_at: float
) -> _Ramp:
    """A ramp that may have ended at any time while its crosshead came to rest."""
    own = slice(int(np.searchsorted(time[: first + 1], ramp.start_time)), first + 1)
    known = np.flatnonzero(_is_finite_and_later(time[own], position[own])) + own.start
    left = time_to_stop(time[known], position[known], held_at=held_at)
    return replace(ramp, end_uncertainty=float(np.hypot(ramp.end_uncertainty, left / 3**0.5)))


def select_hold(
    time: Floats,
    position: Floats,
    tension: Floats,
    strain: Floats,
    standstills: Standstills,
    index: int,
) -> Hold:
    """Take the samples of one specimen in one standstill, and the ramp that led to it.

    Notes
    -----
    The ramp is searched from the middle of the standstill before, or the start of the record.

    Examples
    --------
    A rise of 5 m in 5 s; one sample of the hold is missing.

    >>> t = np.arange(0.0, 40.0)
    >>> x = np.clip(t - 10, 0, 5)
    >>> stand = Standstills(
    ...     first=np.array([15]), last=np.array([39]), start_time=np.array([15.0]),
    ...     end_time=np.array([39.0]), mean_position=np.array([5.0]),
    ...     mean_tension=np.array([[400.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.05, slack_tension=5.0)
    >>> hold = select_hold(t, x, np.where(t == 20, np.nan, 80 * x), x / 2, stand, 0)
    >>> print(hold.time.size, hold.duration, round(hold.ramp.duration))
    24 24.0 5
    """
    first, last = int(standstills.first[index]), int(standstills.last[index])
    # the first samples of the standstill before may lie below it, where a ramp ended between two
    begin = int(standstills.first[index - 1] + standstills.last[index - 1]) // 2 if index else 0
    # under load control the machine moves the tension, and the strain responds
    moved, answer, band = position, tension, standstills.position_tolerance
    if standstills.tension_tolerance is not None:
        moved, answer, band = tension, strain, standstills.tension_tolerance
    else:  # the edge of a standstill is where noise hides the rest of the approach
        after = int(standstills.last[index - 1]) + 1 if index else 0
        approach = find_approach(
            time, position, begin=after, first=first, last=last, noise_range=band
        )
        first = first if approach is None else approach.end
    inside = slice(first, last + 1)
    held = [one[inside] for one in (time, position, tension, strain)]
    seconds, place, load, stretch = select_samples(
        _is_finite_and_later(*held[:3]).__getitem__, *held
    )
    if seconds.size and last + 1 < time.size:
        n_held = _before_way_out(seconds, place if moved is tension else load)
        last -= seconds.size - n_held
        seconds, place, load, stretch = (one[:n_held] for one in (seconds, place, load, stretch))
    ramp = _ramp_before(*(one[begin : first + 1] for one in (time, moved, answer)), band=band)
    if ramp is not None and moved is tension and place.size:
        left = moved[begin : int(standstills.last[index - 1]) + 1 if index else begin + 1]
        level = float(np.median(load))
        ramp = _without_settling(
            ramp, *(one[begin : first + 1] for one in (time, moved, answer)), band=band,
            left=float(np.median(left[-_LOOKED_BACK:])), level=level,
        )  # fmt: skip
        # a controller that hunts strays as far, up and down, while its tension counts as constant
        step = abs(level - float(moved[np.searchsorted(time, ramp.start_time)]))
        if step < 2 * TENSION_TOLERANCE * abs(level):
            ramp = None
    earlier, on_ramp, peak = (
        (np.nan,) * 3 if ramp is None else _logged_peaks(time, tension, ramp, first, last)
    )
    leads_to = within = np.nan
    if ramp is not None and standstills.tension_tolerance is None and place.size:
        ramp = _with_time_to_stop(ramp, time, position, first, float(np.median(place)))
        leads_to, within = _ramp_leads_to(
            time[: first + 1], position[: first + 1], tension[: first + 1], ramp,
            held_at=float(place[0]), noise=(reading_noise(place), reading_noise(load)),
        )  # fmt: skip
    return Hold(
        time=seconds,
        position=place,
        tension=load,
        strain=stretch,
        start_time=float(time[first]),
        ramp=ramp,
        position_tolerance=standstills.position_tolerance,
        slack_tension=standstills.slack_tension,
        logged_peak=peak,
        ramp_peak=on_ramp,
        earlier_peak=earlier,
        ramp_leads_to=leads_to,
        ramp_leads_to_within=within,
        n_logged=last + 1 - first,
        on_tension=standstills.tension_tolerance is not None,
    )


def _before_way_out(time: Floats, answer: Floats) -> int:
    """How many samples of a hold come before the specimen answers to the next ramp.

    Noise of the channel that is held hides the start of that ramp.  Where the last reading of the
    other one deviates by more than the noise from the line over the logarithm of time through those
    before, the hold ends with the last reading that is within the noise, or on the other side.  A
    deviation for longer than a twentieth of the hold is the specimen's own.

    Examples
    --------
    >>> time = np.arange(200.0)
    >>> tension = 400 - 10 * np.log(1 + time) + 0.1 * np.cos(2 * time)
    >>> tension[-2:] -= 5, 30
    >>> print(_before_way_out(time, tension))
    198
    """
    on_line = min(max(time.size // 5, _FEWEST_ON_LINE), _MOST_ON_LINE)
    before = np.searchsorted(time, time[-1] - _WAY_OUT * (time[-1] - time[0]))
    tested = max(time.size - int(before), FEWEST_STEPS)
    begin = time.size - on_line - tested
    if begin <= 0:
        return time.size
    clock, series = np.log(time[begin:] - time[0]), answer[begin:]
    line = np.polyfit(clock[:on_line], series[:on_line], 1)
    off = series - np.polyval(line, clock)
    own = float(np.std(off[:on_line])), _noise_of(series[:on_line])
    noise = max(*own, _ROUNDED * abs(series[0]))
    if not abs(off[-1]) > _LEAVES * noise:
        return time.size
    back = off[: -tested - 1 : -1] * np.sign(off[-1]) <= _LEAVES / 2 * noise
    return time.size - int(np.argmax(back))


_WAY_OUT = 0.05  # of the time of a hold

_FEWEST_ON_LINE, _MOST_ON_LINE = 32, 1 << 14

_LEAVES = 4.0  # standard deviations

_ROUNDED = 1e-9


def _ramp_leads_to(
    time: Floats,
    position: Floats,
    tension: Floats,
    ramp: _Ramp,
    *,
    held_at: float,
    noise: tuple[float, float],
) -> tuple[float, float]:
    """Tension extrapolated from the last readings of a ramp to its end, and the noise of it.

    ``noise`` of a reading of position [m] and tension [N] is that of the hold: a quick ramp has
    too few readings to show it.
    """
    begin, end = np.searchsorted(time, [ramp.start_time, ramp.end_time])
    known = np.flatnonzero(np.isfinite(position[begin:end] + tension[begin:end])) + begin
    if known.size < _FEWEST_ON_RAMP:
        return float("nan"), float("nan")
    load, place = tension[known[-_FEWEST_ON_RAMP:]], position[known[-_FEWEST_ON_RAMP:]]
    # readings no farther apart than their noise, or not on the way, cannot be extrapolated
    of_position, of_tension = noise
    ahead = held_at - place[-1]
    if not (np.diff(place) * np.sign(ahead)).min() > SIGNIFICANT * of_position:
        return float("nan"), float("nan")
    earlier, slope = np.diff(load) / np.diff(place)
    # where the curvature exceeds noise, the line lies below the curve
    bend = (slope - earlier) / (place[-1] - place[0])
    rough = max(of_tension, reading_noise(tension[begin:end]))  # steps of a converter show here
    if abs(bend) * (place[-1] - place[-2]) ** 2 < _BENDS * rough:
        bend = 0.0
    leads_to = float(load[-1] + slope * ahead + bend * ahead * (held_at - place[-2]))
    # noise of a line through two readings; the extrapolation may curve, and be cut short
    reach = ahead / (place[-1] - place[-2])
    own = of_tension * float(np.hypot(1 + reach, reach))
    return leads_to, float(np.hypot(own, (leads_to - load[-1]) / np.sqrt(3)))


_BENDS = 3.0  # noise of a reading

_FEWEST_ON_RAMP = 3  # readings; the first may lie before the ramp


def _logged_peaks(
    time: Floats, tension: Floats, ramp: _Ramp, first: int, last: int
) -> tuple[float, float, float]:
    """Greatest reading of tension long before the end of a ramp, just before it, and beside it.

    Beside means within a twentieth of the ramp or five samples; NaN where it adds no tension.
    """
    beside = BESIDE * ramp.length
    clock = time[: last + 1]
    begin, centre, low, end, high = np.searchsorted(
        clock,
        [ramp.start_time, ramp.centre_time, ramp.end_time - beside, ramp.end_time,
         ramp.end_time + beside],
    )  # fmt: skip
    low = max(min(int(low), first - SAMPLES_BESIDE), int(begin))
    high = min(max(int(high), first + SAMPLES_BESIDE), last) + 1
    before, on_ramp, near = (
        one[np.isfinite(one)]
        for one in (tension[int(centre) : low], tension[low : int(end)], tension[low:high])
    )
    if not near.size or not near[-1] > tension[begin]:
        return (float("nan"),) * 3
    return _greatest(before), _greatest(on_ramp), _greatest(near)


def _greatest(values: Floats) -> float:
    """Greatest value, or NaN if there is none."""
    return float(np.max(values)) if values.size else float("nan")
