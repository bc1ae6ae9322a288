r"""Fundamental of a series over each cycle, at the frequency of the cycles around it.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t

by least squares over the samples of the cycle, weighted by time.  Noise and sampling put a turn
a sample early or late, so that a cycle's own duration is no period; the mean over twenty is.

References
----------
.. [1] CG-D-39-80, sec. 2.2 and eqs. 1-4: a rope's tension leads its strain; the part in
   phase is stored, the part in quadrature is lost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.cycles.turn import cosine_and_sine
from reduction.errors import DataError
from reduction.record import Floats, Integers, read_only_arrays

_AROUND = 10  # cycles on either side whose durations make the period of one
_LEAST_DETERMINANT = 1e-9  # of the normal equations; 2 where samples are many and even


@dataclass(frozen=True)
@read_only_arrays
class CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``share`` (twice the trapezoid's weight over the duration), ``cosine`` and ``sine`` have
    shape (n_samples,); ``end_share`` is the share of the last sample of each cycle,
    ``end_cosine`` and ``end_sine`` the same times those of its phase.  ``inverse``, shape
    (n_cycles, 3, 3), turns sums of a series over share, cosine and sine into its mean and
    its two amplitudes; ``turn_rate`` [rad s-1] is that of the phase; ``first`` and ``last``
    are the cycles they were made for.
    """

    share: Floats
    cosine: Floats
    sine: Floats
    end_share: Floats
    end_cosine: Floats
    end_sine: Floats
    inverse: Floats
    turn_rate: Floats
    first: Integers
    last: Integers


def cycle_basis(
    time: Floats, first: Integers, last: Integers, *, period: Floats | None = None
) -> CycleBasis:
    """Basis of the fundamental, common to all specimens of a test.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time, rising inside a cycle; steps need not be equal. [s]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle, both inside. [1]
    period : ndarray, shape (n_cycles,), optional
        Of the wave in each cycle; that of the cycles around where not given. [s]

    Returns
    -------
    basis : CycleBasis
        Weighted cosine and sine.

    Raises
    ------
    DataError
        If a cycle takes no time, or its samples have fewer than three phases.

    Examples
    --------
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> bool(abs(basis.sine[:8].sum()) < 1e-15)
    True
    """
    duration = time[last] - time[first]
    if not np.all(duration > 0):
        bad = int(np.flatnonzero(~(duration > 0))[0])
        raise DataError(
            f"cycle {bad + 1} takes no time",
            found=f"{duration[bad]:g} s from its first to its last sample",
            needed="a time channel that rises over the cycle",
        )
    weight = np.zeros_like(time)
    np.subtract(time[2:], time[:-2], out=weight[1:-1])
    # an end of the cycle counts half; the other half belongs to the cycle that it touches
    weight[first] = time[first + 1] - time[first]
    # one value a sample from one value a cycle, with nothing between cycles
    gaps = np.diff(first, append=time.size) - (last - first)
    lengths = np.column_stack([last - first, gaps]).ravel()
    nothing = np.zeros(first.size)
    begin = int(first[0]) if first.size else time.size
    if period is None:
        period = mean_period(time[first], first, last, last_turn=time[last])
    turn_rate = 2 * np.pi / period
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= np.repeat(np.column_stack([turn_rate, nothing]).ravel(), lengths)
    share, cosine, sine = np.zeros_like(time), np.zeros_like(time), np.zeros_like(time)
    rate = np.repeat(np.column_stack([1 / duration, nothing]).ravel(), lengths)
    np.multiply(rate, weight[begin:], out=share[begin:])
    bare = cosine_and_sine(phase)
    np.multiply(bare[0], share[begin:], out=cosine[begin:])
    np.multiply(bare[1], share[begin:], out=sine[begin:])
    end_share = (time[last] - time[last - 1]) / duration
    end_phase = turn_rate * duration
    end = end_share * np.cos(end_phase), end_share * np.sin(end_phase)
    gram = np.empty((first.size, 3, 3))
    gram[:, 0, 0] = sums_over_cycles(share, first, last) + end_share
    for row, (weighted, at_end) in enumerate(zip((cosine, sine), end, strict=True), start=1):
        gram[:, 0, row] = gram[:, row, 0] = sums_over_cycles(weighted, first, last) + at_end
        products = weighted[begin:] * bare[0]
        gram[:, row, 1] = gram[:, 1, row] = sums_over_cycles(
            products, first - begin, last - begin
        ) + at_end * np.cos(end_phase)
    gram[:, 2, 2] = gram[:, 0, 0] - gram[:, 1, 1]
    is_flat = ~(np.linalg.det(gram) > _LEAST_DETERMINANT)
    if is_flat.any():
        bad = int(np.flatnonzero(is_flat)[0])
        raise DataError(
            f"the samples of cycle {bad + 1} stand too close in time to have a fundamental",
            found=f"{last[bad] - first[bad] + 1} samples from {time[first[bad]]:g} s to "
            f"{time[last[bad]]:g} s",
            needed="samples that are spread over the cycle",
            hint="Check the time channel.",
        )
    return CycleBasis(
        share,
        cosine,
        sine,
        end_share,
        *end,
        np.linalg.inv(gram).astype(np.float64),
        turn_rate,
        first,
        last,
    )


def mean_period(turns: Floats, first: Integers, last: Integers, *, last_turn: Floats) -> Floats:
    """Mean duration of up to 21 cycles that touch, around each cycle.

    Parameters
    ----------
    turns : ndarray, shape (n_cycles,)
        Time at which each cycle begins. [s]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle; the next begins where one ends, if they touch. [1]
    last_turn : ndarray, shape (n_cycles,)
        Time at which each cycle ends. [s]

    Returns
    -------
    period : ndarray, shape (n_cycles,)
        Of the cycles around. [s]

    Raises
    ------
    IndexError
        If the arrays differ in length.

    Examples
    --------
    >>> first = np.array([0, 8, 17])
    >>> ends = np.array([8, 17, 24])
    >>> print(mean_period(1.0 * first, first, ends, last_turn=1.0 * ends))
    [8. 8. 8.]
    """
    breaks = np.flatnonzero(last[:-1] != first[1:]) + 1
    place = np.arange(first.size)
    run = np.searchsorted(breaks, place, side="right")
    starts = np.concatenate([[0], breaks])
    stops = np.append(breaks, first.size) - 1
    low = np.maximum(place - _AROUND, starts[run])
    high = np.minimum(place + _AROUND, stops[run])
    mean: Floats = (last_turn[high] - turns[low]) / (high - low + 1)
    return mean


def phase_turns(cosine: Floats, sine: Floats, basis: CycleBasis, time: Floats) -> Floats:
    """Time near the first sample of each cycle at which its fundamental turns.

    Parameters
    ----------
    cosine, sine : ndarray, shape (n_cycles,)
        From `fundamental`. [any]
    basis : CycleBasis
        With which they were found.
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]

    Returns
    -------
    turns : ndarray, shape (n_cycles,)
        Least value of the fundamental; the first sample's own time where it has none. [s]

    Raises
    ------
    IndexError
        If the arrays differ in length.

    Examples
    --------
    >>> t = np.arange(14.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = -np.cos(2 * np.pi * (t - 0.4) / 12)
    >>> print(phase_turns(*fundamental(wave, basis)[:2], basis, t).round(3))
    [0.4]
    """
    past = np.arctan2(-sine, -cosine) / basis.turn_rate
    return time[basis.first] + np.where(np.isfinite(past), past, 0.0)


def fundamental(values: Floats, basis: CycleBasis) -> tuple[Floats, Floats, Floats]:
    """Cosine and sine amplitude of the fundamental in each cycle, and its mean.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Without NaN. [any]
    basis : CycleBasis
        From `cycle_basis`.

    Returns
    -------
    cosine, sine, mean : ndarray, shape (n_cycles,)
        Amplitudes and mean over time, in the unit of the series. [any]

    Raises
    ------
    IndexError
        If the series is shorter than the cycles.

    Notes
    -----
    A drift d over the cycle, linear in time, adds -d/pi to the sine: see `mean_drift`.

    Examples
    --------
    >>> t = np.arange(13.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> wave = 7 + 3 * np.cos(2 * np.pi * t / 12) - np.sin(2 * np.pi * t / 12)
    >>> print(*(part.round(12) for part in fundamental(wave, basis)))
    [3.] [-1.] [7.]
    """
    first, last = basis.first, basis.last
    sums = np.stack(
        [
            sums_over_cycles(values * weights, first, last) + values[last] * at_end
            for weights, at_end in (
                (basis.share, basis.end_share),
                (basis.cosine, basis.end_cosine),
                (basis.sine, basis.end_sine),
            )
        ],
        axis=-1,
    )
    mean, cosine, sine = np.einsum("cij,cj->ic", basis.inverse, sums)
    return cosine, sine, mean
