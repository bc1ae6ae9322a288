r"""Delay of the tension log relative to position, from the turns of a triangular wave.

A single frequency cannot distinguish a lag from damping: it shows only the phase
:math:`\delta - \omega \ell`.  A turn can.  In any material with memory,

.. math::

    T(t) = G(0) \, p(t) + \int_0^\infty G'(s) \, p(t - s) \, ds

the integral is smoother than position: where the speed of the crosshead jumps, its slope does not.
So the slope of tension jumps with that of position, at that instant, whatever the loss; only
a delay of a channel shifts one corner relative to the other.  Both sides of a turn are fitted by
parabolas, separately in each channel, and the lag is the time between the crossings.

The residual effect of damping makes tension turn *early*, never late.  Creep as a power of
time, :math:`t^{-n}` with :math:`n = 2\delta / \pi`, bends the ramp next to its corner, and
parabolas over a window W cross :math:`n W / 8` early; smaller windows show it.  A dashpot in
parallel, friction, or a relaxation that ends within a few samples shifts the whole ramp by the
time eta / K, and no record at this rate distinguishes that from a lead of the channel.  So a
tension that turns late was logged late, by at least that; one that turns early may be due to
damping, and is refused.

References
----------
.. [1] J. D. Ferry, *Viscoelastic Properties of Polymers*, 3rd ed., Wiley, New York, 1980, ch. 1
   (the integral), ch. 3.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," F.2.4.5 (a bias that is known and not corrected).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from reduction.quantities.flags import LAG_REFUSALS
from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.samples import BLOCK, sample_blocks, take_samples
from reduction.stages.standstills import estimate_noise, median_step

_SHARE = 0.45  # of a ramp, on either side of a turn

_FEWEST_SAMPLES = 10  # in that part, for a parabola through half of them

_FEWEST_TURNS = 6

_MOST_TURNS = 400

_SHARP = 0.7  # jump of the slope over twice the mean slope: 1 for ramps, 0.2 for a sine

_MOST_LOST = 0.2

_NEWTON_STEPS = 8

_WINDOWS = (1.0, 0.7, 0.5)  # of the reach, the first for the estimate

_EARLY = 2.0  # standard uncertainties

_ROUNDING = 1e-9  # of a ramp

_FLAT = 1e-12  # determinant of the normal equations of a parabola; 5e-4 of even samples

_PASSES = 3


@dataclass(frozen=True)
@read_only_arrays
class LagEstimate:
    """Lag of the tension channels; arrays have shape (n_specimens,).

    Parameters
    ----------
    lag : ndarray
        Lower bound of the delay of tension relative to position; NaN where refused. [s]
    standard_uncertainty : ndarray
        Scatter over the turns, peaks against valleys, and change by smaller windows. [s]
    n_turns : ndarray of int
        Number of turns used. [1]
    refusal : ndarray of int
        Code of `LAG_REFUSALS`. [1]
    """

    lag: Floats
    standard_uncertainty: Floats
    n_turns: Integers
    refusal: Integers


def delay_of_extensometer(
    time: Floats, position: Floats, strain: Floats, tension: Floats, inside: NDArray[Any]
) -> float:
    r"""Delay of an extensometer relative to the crosshead; 0 where damping may cause it.

    .. math:: \varepsilon(t) = f(x) - \tau f'(x) \dot x, \qquad T(t) = g(\varepsilon)
              + t_\delta \, g'(\varepsilon) \dot\varepsilon

    Parameters
    ----------
    time, position, strain, tension : ndarray, shape (n_samples,)
        Channels of one specimen. [s], [m], [1], [N]
    inside : ndarray of int, shape (n_samples,)
        Positive within cycles. [1]

    Returns
    -------
    delay : float
        [s]

    Notes
    -----
    Both channels are lengths, one driven by the other: they move together, except for other parts
    stretched between the pins.  Those follow tension, which leads strain by :math:`t_\delta`, and
    put strain behind the crosshead by their share of it.  More than half of that is a delay.

    Examples
    --------
    >>> time = np.arange(0, 60, 0.02)
    >>> wave = [np.sin(2 * np.pi * 0.5 * (time - late)) for late in (0, 0.03, -0.02)]
    >>> given = time, 0.5 + 0.1 * wave[0], 0.2 * wave[1], 50 * wave[2], np.ones(time.size)
    >>> print(round(delay_of_extensometer(*given), 3))
    0.03
    """
    rows = np.flatnonzero(inside[1:-1] > 0)[:_MOST_ROWS] + 1
    if rows.size < _FEWEST_ROWS:
        return 0.0
    gone = take_samples(time, rows + 1) - take_samples(time, rows - 1)

    def late(driver: Floats, answer: Floats, some: Integers) -> float:
        """Delay of the response in seconds, by its curve over the driver and its rate."""
        x, y = take_samples(driver, rows[some]), take_samples(answer, rows[some])
        rate = (take_samples(driver, rows + 1) - take_samples(driver, rows - 1))[some] / gone[some]
        known = np.isfinite(x) & np.isfinite(y) & np.isfinite(rate) & (gone[some] > 0)
        x, y, rate = x[known], y[known], rate[known]
        if x.size < _FEWEST_ROWS // _PARTS or not np.ptp(x) > 0:
            return np.nan
        curve = np.polynomial.Polynomial.fit(x, y, _DEGREE)
        far = np.abs(y - curve(x))
        near = far < _OUTLYING * np.median(far)  # a drop-out is not a delay
        x, y, rate = x[near], y[near], rate[near]
        curve = np.polynomial.Polynomial.fit(x, y, _DEGREE)
        terms = np.column_stack([((x - x.mean()) / np.ptp(x))[:, None] ** np.arange(_DEGREE + 1),
                                 curve.deriv()(x) * rate])  # fmt: skip
        return -float(np.linalg.lstsq(terms, y)[0][-1])

    parts = np.array_split(np.arange(rows.size), _PARTS)
    of_strain = np.array([late(position, strain, one) for one in parts])
    delay, own = float(np.mean(of_strain)), float(np.std(of_strain, ddof=1)) / np.sqrt(_PARTS)
    lead = max(-float(np.mean([late(strain, tension, one) for one in parts])), 0.0)
    is_sure = delay > max(_BEYOND * own, _OF_LEAD * lead)
    return delay if is_sure and delay > _OF_STEP * median_step(time) else 0.0


_MOST_ROWS, _FEWEST_ROWS = 50_000, 200

_PARTS = 5  # of the log: their scatter gives the uncertainty of a delay

_DEGREE = 5

_OUTLYING = 8.0  # median distances from the curve

_BEYOND = 4.0  # standard uncertainties

_OF_LEAD, _OF_STEP = 0.4, 0.5


def lag_by_turns(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, turn: ArrayLike
) -> LagEstimate:
    r"""Estimate the delay of each tension channel relative to position.

    .. math:: \ell = t_T - t_p, \qquad u^2 = u_{scatter}^2 + 4 \max_w (\ell_W - \ell_w)^2
            + \frac{1}{12} (\ell_{peaks} - \ell_{valleys})^2
            + \left( \frac{K_2 - K_1}{K_2 + K_1} \, \frac{s}{v} \right)^2

    Parameters
    ----------
    time, position : array_like, shape (n_samples,)
        NaN where a sample is not usable. [s], [m]
    tension : array_like, shape (n_specimens, n_samples)
        [N]
    turn : array_like of int, shape (n_turns,)
        Samples at which the wave turns, in order. [1]

    Returns
    -------
    estimate : LagEstimate
        With a refusal where the turns do not show it.

    Notes
    -----
    Turns are weighted by the square of the jump of the slope of tension, since the noise of a
    crossing is that of a reading over it.  The bias of a power-law creep is twice the change from W
    to W/2; it is not corrected, since that would assume the law, but included in full in the
    uncertainty ([2]_).  Half of the difference between peaks and valleys counts as a half width.
    A machine that rounds its corners stops short of the crossing of its ramps by a path s, at the
    speed v; where the specimen is stiffer behind the turn (K_2) than before it (K_1), as with
    friction, tension then crosses late.
    A wave that rounds its corners (a sine) is refused: it has only a phase, which is damping and
    lag together ([1]_).

    Examples
    --------
    Ramps of 5 s at 10 Hz, tension logged 30 ms late:

    >>> time = np.arange(0, 60, 0.1)
    >>> ramps = lambda t: 1 - 2 * np.abs(np.mod(t / 10, 1) - 0.5)
    >>> found = lag_by_turns(time, ramps(time), [500 * ramps(time - 0.03)], np.arange(50, 600, 50))
    >>> print(found.lag.round(4), found.n_turns)
    [0.03] [11]
    """
    clock, place = (np.asarray(one, dtype=np.float64) for one in (time, position))
    load = np.asarray(tension, dtype=np.float64)
    turns = np.unique(np.asarray(turn, dtype=np.int64))
    n_specimens = load.shape[0]
    if turns.size < _FEWEST_TURNS:
        return _refused(n_specimens, "few_turns")
    reach = int(_SHARE * np.median(np.diff(turns)))
    if reach < _FEWEST_SAMPLES:
        return _refused(n_specimens, "few_samples_a_ramp")
    margin = 2 * reach
    turns = turns[(turns >= margin) & (turns < clock.size - margin)]
    # a pause between two groups of cycles has no ramp
    ramp = np.diff(turns, prepend=turns[:1] - 2 * reach, append=turns[-1:] + 2 * reach)
    turns = turns[(ramp[:-1] > reach) & (ramp[1:] > reach)]
    turns = turns[:: max(1, -(-turns.size // _MOST_TURNS))]
    found = [_of_specimen(clock, place, series, turns, reach) for series in load]
    lag, spread, used, refusal = zip(*found, strict=True)
    return LagEstimate(np.array(lag), np.array(spread), np.array(used), np.array(refusal))


def _refused(n_specimens: int, reason: str) -> LagEstimate:
    nothing = np.full(n_specimens, np.nan)
    code = np.full(n_specimens, LAG_REFUSALS[reason])
    return LagEstimate(nothing, nothing, np.zeros(n_specimens, dtype=np.int64), code)


def lag_at_stops(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, stop: ArrayLike, turn: ArrayLike
) -> LagEstimate:
    """Estimate the lag by the delay with which tension stops after the crosshead.

    Parameters
    ----------
    time, position : array_like, shape (n_samples,)
        NaN where a sample is not usable. [s], [m]
    tension : array_like, shape (n_specimens, n_samples)
        [N]
    stop : array_like of int, shape (n_stops,)
        Samples at which the crosshead comes to rest under tension. [1]
    turn : array_like of int, shape (n_turns,)
        Samples at which it sets off or turns: a window ends before the next one. [1]

    Returns
    -------
    estimate : LagEstimate
        With a refusal where no stop is sharp.

    Notes
    -----
    A sine has no corner, but its approach, and often its end, has one: there the argument of
    `lag_by_turns` and its refusals apply.  Where a crosshead starts, play in a grip and a slack
    specimen delay tension; where it stops, nothing does.  Stops are few, so the noise, propagated
    through the ends of both parabolas, is added to their scatter.

    Examples
    --------
    A ramp of 4 s, a rest, and tension logged 30 ms late:

    >>> time = np.arange(0, 9, 0.05)
    >>> ramp = lambda t: np.clip(t, 0, 4)
    >>> found = lag_at_stops(time, ramp(time), [500 * ramp(time - 0.03)], [80], [0])
    >>> print(found.lag.round(4), found.n_turns)
    [0.03] [1]
    """
    clock, place = (np.asarray(one, dtype=np.float64) for one in (time, position))
    load = np.asarray(tension, dtype=np.float64)
    stops = np.asarray(stop, dtype=np.int64)[:_MOST_STOPS]
    others = np.unique(np.concatenate([[0], stops, np.asarray(turn, np.int64), [clock.size - 1]]))
    found = []
    for series in load:
        own = np.array([estimate_noise(channel)[0] for channel in (place, series)])
        lags, jumps, noise = [], [], 0.0
        for one in stops.tolist():
            near = others[np.abs(others - one) > _FEWEST_SAMPLES]
            reach = int(_SHARE * np.abs(near - one).min(initial=clock.size))
            window = slice(one - 2 * reach, one + 2 * reach + 1)
            if reach < _FEWEST_SAMPLES or window.start < 0 or window.stop > clock.size:
                continue
            if not np.isfinite(place[window] + series[window]).all():
                continue
            lag, sharp, jump = _lags(clock, place, series, np.array([one]), reach)
            if np.isfinite(lag).all() and sharp[0] >= _SHARP:
                lags.append(lag[:, 0])
                jumps.append(jump[:, 0])
                # the end of a parabola through n readings has the variance 9 / n of one
                of_stop = np.sqrt(18 / reach) * np.hypot(*(own / jump[:, 0]))
                noise = max(noise, float(of_stop))
        if not lags:
            found.append((np.nan, np.nan, 0, LAG_REFUSALS["turns_not_sharp"]))
            continue
        mean, spread = _combined(np.array(lags).T, np.array(jumps)[:, 1])
        found.append(_unless_early(mean, float(np.hypot(spread, noise)), len(lags), 0.0))
    columns = zip(*found, strict=True)
    return LagEstimate(*(np.array(column) for column in columns))


_MOST_STOPS = 20


def delay_by_noise(position: Floats, tension: Floats, *, samples_per_cycle: float) -> float:
    r"""Delay of tension by a filter, in samples, from the remaining noise; 0 without a filter.

    .. math:: r_j = e^{-j/\tau}, \qquad r_j = (1 + j/\tau)\,e^{-j/\tau}, \qquad
              r_j = \max(1 - j/m, 0)

    Parameters
    ----------
    position, tension : ndarray, shape (n_samples,)
        [m], [N]
    samples_per_cycle : float
        Samples per cycle of the wave, which differences of every eighth sample must exclude. [1]

    Returns
    -------
    delay : float
        In samples: the time constant of one pole, the sum of two equal ones, or half the length of
        a moving mean. [1]

    Raises
    ------
    DataError
        If fewer than 8 positions are finite.

    Notes
    -----
    Independent noise is as large in every eighth sample as in all of them.
    After a filter it is smaller in all, since neighbours are alike: by their autocorrelation
    :math:`r_j` after one pole, two poles and a mean of m readings, in differences of sixth order.
    Vibration would show in position; where the noise of position is not white no result is given,
    nor where a step of the converter hides noise.  A zero-phase filter applied to a record
    afterwards gives the same.

    Examples
    --------
    >>> white = np.random.default_rng(1).normal(size=(2, 40_000))
    >>> filtered = scipy.signal.lfilter([1], [1, -np.exp(-1 / 3)], white[1])
    >>> print(round(delay_by_noise(white[0], filtered, samples_per_cycle=500)))
    3
    >>> print(delay_by_noise(*white, samples_per_cycle=500))
    0.0
    """
    if samples_per_cycle < _LEAST_SAMPLES or np.isfinite(tension).sum() < _LEAST_READINGS:
        return 0.0
    found = []
    for series in (position, tension):
        noise, quantum = estimate_noise(series)
        if not noise > max(quantum, _TINY * float(np.nanmax(np.abs(series)))):
            return 0.0
        of_some = np.array([estimate_noise(series[::one])[0] for one in _STRIDES])
        if not of_some.min() > 0:  # a pattern that repeats itself is no noise
            return 0.0
        found.append(np.log(of_some / noise))
    of_position, of_tension = np.array(found)
    if np.abs(of_position).max() > _WHITE or not of_tension[-1] > _COLOURED:
        return 0.0
    lag = np.arange(2 * _ORDER + 1) - _ORDER
    kernel = np.where(lag % 2, -1.0, 1.0) * scipy.special.comb(2 * _ORDER, lag + _ORDER)
    constant = np.geomspace(0.2, 20, 400)
    apart = np.abs(lag) * np.array([1, *_STRIDES])[:, None, None]
    by_time = apart / constant[:, None]
    mean_of = np.arange(2.0, _MOST_AVERAGED + 1)
    misfits, delays = [], (constant, 2 * constant, (mean_of - 1) / 2)
    for alike in (
        np.exp(-by_time), (1 + by_time) * np.exp(-by_time),
        np.maximum(1 - apart / mean_of[:, None], 0.0),
    ):  # fmt: skip
        variance = (kernel * alike).sum(axis=-1)
        ratio = np.log(variance[1:] / variance[0]) / 2
        misfits.append(np.sqrt(np.mean((ratio - of_tension[:, None]) ** 2, axis=0)))
    misfit, delay = np.concatenate(misfits), np.concatenate(delays)
    best = int(np.argmin(misfit))
    return float(delay[best]) if misfit[best] < _MISFIT else 0.0


_ORDER, _STRIDES = 6, (2, 3, 4, 6, 8)

_LEAST_SAMPLES = 40 * _STRIDES[-1]  # a sixth difference leaves 1e-5 of a sine of 40 a cycle

_LEAST_READINGS = 2000

_MOST_AVERAGED = 41  # readings; of more, the differences of every eighth show no more

_COLOURED, _WHITE, _MISFIT = 0.47, 0.25, 0.15  # logarithms; chance makes 0.1

_TINY = 1e-9


def _of_specimen(
    time: Floats, position: Floats, tension: Floats, turns: Integers, reach: int
) -> tuple[float, float, int, int]:
    """Lag, its uncertainty, turns used, and code of the refusal."""
    # window and lag may each move by half a reach
    is_read = np.ones(turns.size, dtype=bool)
    for some, window in _windows(turns, -2 * reach, 2 * reach + 1):
        read = take_samples(position, window) + take_samples(tension, window)
        is_read[some] &= np.isfinite(read).all(axis=1)
    turns = turns[is_read]
    if turns.size < _FEWEST_TURNS:
        return np.nan, np.nan, turns.size, LAG_REFUSALS["few_turns"]
    lags, sharp, jumps = _lags(time, position, tension, turns, reach)
    usable = np.isfinite(lags).all(axis=0)
    n_turns = int(usable.sum())
    if n_turns < (1 - _MOST_LOST) * turns.size or not np.median(sharp[usable]) >= _SHARP:
        return np.nan, np.nan, n_turns, LAG_REFUSALS["turns_not_sharp"]
    lag, spread = _combined(lags[:, usable], jumps[1, usable])
    by_rounding = _by_rounding(time, position, tension, turns[usable], reach, lag)
    spread = float(np.hypot(spread, by_rounding))
    rounding = _ROUNDING * float(time[turns[-1]] - time[turns[0]]) / turns.size
    return _unless_early(lag, spread, n_turns, rounding)


def _unless_early(
    lag: float, spread: float, n_turns: int, rounding: float
) -> tuple[float, float, int, int]:
    if lag < -_EARLY * spread - rounding:
        return np.nan, np.nan, n_turns, LAG_REFUSALS["early_as_damping_makes_it"]
    return lag, spread, n_turns, LAG_REFUSALS["given"]


def _lags(
    time: Floats, position: Floats, tension: Floats, turns: Integers, reach: int
) -> tuple[Floats, Floats, Floats]:
    """Lag by window and turn; for the widest, sharpness and jumps of slope of both channels."""
    step, most = median_step(time[turns[0] - reach : turns[-1] + reach]), reach // 2

    def samples(seconds: Floats) -> Integers:
        return np.rint(np.clip(np.nan_to_num(seconds / step), -most, most)).astype(np.int64)

    turns = turns + samples(_corners(time, position, turns, reach)[0] - take_samples(time, turns))
    lags = []
    sharp, jumps = np.empty(0), np.empty((2, 0))
    later = 0
    for share in _WINDOWS:
        width = int(share * reach)
        of_position, sharp_position, jump_position = _corners(time, position, turns, width)
        if share == 1:
            # one shift for all turns: a corner that the machine rounds is then cut equally
            for _ in range(_PASSES):
                of_tension = _corners(time, tension, turns + later, width)[0]
                later = int(np.median(samples(of_tension - of_position)))
        of_tension, sharp_tension, jump_tension = _corners(time, tension, turns + later, width)
        lags.append(of_tension - of_position)
        if share == 1:
            sharp = np.minimum(sharp_position, sharp_tension)
            jumps = np.array([jump_position, jump_tension])
    return np.array(lags), sharp, jumps


def _combined(lags: Floats, jump: Floats) -> tuple[float, float]:
    """Weighted mean over the turns of the widest window, and its standard uncertainty."""
    weight = jump**2 / np.sum(jump**2)
    means = np.sum(weight * lags, axis=1)
    off = lags[0] - means[0]
    scatter = np.sum((weight * off) ** 2) * off.size / max(off.size - 1, 1)
    form = np.max((means - means[0]) ** 2) * 4
    kinds = [
        np.average(lags[0, kind], weights=weight[kind])
        for kind in (jump > 0, jump < 0)
        if kind.any()
    ]
    return float(means[0]), float(np.sqrt(scatter + form + np.ptp(kinds) ** 2 / 12))


def _corners(
    time: Floats, series: Floats, turns: Integers, width: int
) -> tuple[Floats, Floats, Floats]:
    """Times of the corners of a series, their sharpness, and the jumps of its slope.

    The sample of the turn itself is in neither parabola, since it may be on either side.
    """
    scale, sides = _sides(time, series, turns, (1, width), 2)
    root, sharp, jump = _crossing(*sides)
    return take_samples(time, turns) + root * scale, sharp, jump / scale


def _sides(
    time: Floats, series: Floats, turns: Integers, reach: tuple[int, int], degree: int
) -> tuple[Floats, tuple[Floats, Floats]]:
    """Unit of time of each turn, and the polynomials in it on both sides of the turn."""
    inner, width = reach
    at_turn = take_samples(time, turns)
    scale = np.zeros(turns.size)
    for some, window in _windows(turns, -width, width + 1):
        since = take_samples(time, window) - at_turn[some, None]
        scale[some] = np.maximum(scale[some], np.abs(since).max(axis=1))
    terms = degree + 1
    sides = []
    for first, stop in ((-width, 1 - inner), (inner, width + 1)):
        gram, sums = np.zeros((turns.size, terms, terms)), np.zeros((turns.size, terms))
        for some, window in _windows(turns, first, stop):
            at = (take_samples(time, window) - at_turn[some, None]) / scale[some, None]
            basis = at[..., None] ** np.arange(terms)
            gram[some] += np.einsum("tsi,tsj->tij", basis, basis)
            sums[some] += np.einsum("tsi,ts->ti", basis, take_samples(series, window))
        # near a gap all samples of a side may be one instant, which no polynomial fits
        is_flat = np.linalg.det(gram) <= _FLAT * gram[:, 0, 0] ** terms
        gram[is_flat], sums[is_flat] = np.eye(terms), np.nan
        sides.append(np.asarray(np.linalg.solve(gram, sums[..., None])[..., 0], np.float64))
    return scale, (sides[0], sides[1])


def _by_rounding(
    time: Floats, position: Floats, tension: Floats, turns: Integers, reach: int, lag: float
) -> float:
    """Shift of tension against position at turns that the machine rounds.

    Straight ramps that a rounded corner joins cross beyond it, by a path s.  Behind the turn the
    specimen has then gone that path less.  If it is stiffer there than before, tension crosses
    its own ramp late by (K_2 - K_1) / (K_2 + K_1) of s over the speed, without any delay.
    """
    step = median_step(time[turns[0] - reach : turns[0] + reach])
    later = int(np.clip(round(lag / step), -(reach // 2), reach // 2))
    found, slopes = [], []
    for series, at_turn in ((position, turns), (tension, turns + later)):
        scale, (before, after) = _sides(time, series, at_turn, (1, reach), 2)
        slopes.append((before[:, 1] / scale, after[:, 1] / scale))
        bend = np.nanmean(np.abs(before[:, 2]) + np.abs(after[:, 2]))
        bend /= np.nanmean(np.abs(before[:, 1]) + np.abs(after[:, 1]))
        scale, (before, after) = _sides(time, series, at_turn, (int(_OUTER * reach), reach), 1)
        level, jump = (after - before).T
        with np.errstate(divide="ignore", invalid="ignore"):
            at = np.clip(np.nan_to_num(-level / jump), -1, 1)
        near = at_turn + np.clip(np.rint(at * scale / step), -reach, reach).astype(np.int64)
        since = (take_samples(time, near) - take_samples(time, at_turn)) / scale
        line = np.where((since < at)[:, None], before, after)
        beyond = line[:, 0] + line[:, 1] * since - take_samples(series, near)
        lost = -np.nanmean(beyond * np.sign(jump)) / np.nanmean(np.abs(jump) / scale)
        found.append((float(bend), 2 * max(float(lost), 0.0)))
    (p_before, p_after), (t_before, t_after) = slopes
    with np.errstate(divide="ignore", invalid="ignore"):
        stiff = [np.abs(t_before / p_before), np.abs(t_after / p_after)]
        stiffer = (stiff[1] - stiff[0]) / (stiff[1] + stiff[0])
    weight = (t_after - t_before) ** 2
    known = np.isfinite(stiffer * weight)
    if not known.any():
        return 0.0
    # the channel that the machine drives has the straighter ramps
    return min(found)[1] * abs(float(np.average(stiffer[known], weights=weight[known])))


_OUTER = 0.4  # of the reach: ramps without their corners


def _windows(turns: Integers, first: int, stop: int) -> Iterator[tuple[slice, Integers]]:
    """Samples from ``first`` up to ``stop`` after each turn, some turns and samples at a time."""
    for some in sample_blocks(turns.size, size=max(1, BLOCK // (stop - first))):
        for part in sample_blocks(stop - first, size=BLOCK):
            yield some, turns[some, None] + np.arange(first + part.start, first + part.stop)


def _crossing(before: Floats, after: Floats) -> tuple[Floats, Floats, Floats]:
    """Time at which the parabolas of both sides cross, sharpness of the turn, jump of the slope."""
    height, slope, bend = (after - before).T
    # mean slope of each side, over the whole of it
    mean = np.abs(before[:, 1] - before[:, 2]) + np.abs(after[:, 1] + after[:, 2])
    root = np.zeros(height.shape)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(_NEWTON_STEPS):
            root = root - (height + root * (slope + root * bend)) / (slope + 2 * root * bend)
        root = np.where(np.abs(root) < 0.5, root, np.nan)
        return root, np.abs(slope) / mean, slope
