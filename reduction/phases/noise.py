"""Noise and quantum of a channel, from its own samples, whether it moves or stands.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from math import comb, sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.samples.scratch import empty_like

_STRETCHES, _STRETCH_SAMPLES = 64, 1024
_ORDERS = (2, 4, 6)
_TINY = 1e-12  # a channel that is zero throughout has a range to stay within, too
_NORMAL_MEDIAN = 0.67449  # median of |z| of a normal variable
_NOISE_WIDTHS = 12.0  # range that 10**7 normal samples hardly leave, in standard deviations
_QUANTA = 3.0  # range of a level between two steps, with noise below one step
_FLICKER_SHARE = 0.2  # steps undone by the next step; 0.1 at 10 samples a triangle's branch


def _stretches(values: Floats) -> Floats:
    """Finite samples in at most 64 rows of consecutive ones, spread over the record."""
    length = min(_STRETCH_SAMPLES, values.size)
    n_rows = min(_STRETCHES, values.size // length)
    first = np.linspace(0, values.size - length, n_rows).astype(np.intp)
    rows: Floats = take_samples(values, first[:, None] + np.arange(length))
    if np.isfinite(rows).all():
        return rows
    finite = _finite(values)
    return _stretches(finite) if finite.size else finite[None, :]


def _finite(values: Floats) -> Floats:
    """The finite samples of a series."""
    counts = [
        int(np.count_nonzero(np.isfinite(values[part])))
        for part in sample_blocks(values.size, values)
    ]
    finite = empty_like(values, shape=sum(counts))
    ends = np.cumsum(counts)
    for part, count, end in zip(
        sample_blocks(values.size, values, finite), counts, ends, strict=True
    ):
        block = values[part]
        finite[end - count : end] = block[np.isfinite(block)]
    return finite


def estimate_noise(values: ArrayLike) -> tuple[float, float]:
    r"""Standard deviation of the noise and size of the quantisation step of a channel.

    .. math:: s = \min_k \; \mathrm{median}|\Delta^k x| / (0.674 \sqrt{\tbinom{2k}{k}})

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Channel as logged; NaN is left out. [any unit]

    Returns
    -------
    noise : float
        Standard deviation. [unit of the channel]
    quantum : float
        Size of one step of the converter, 0 where the channel is not seen to be
        quantised. [unit of the channel]

    Raises
    ------
    DataError
        If fewer than 8 samples are finite.

    Notes
    -----
    Differences of order k = 2, 4 and 6 take the movement away: order 2 leaves nothing
    of a triangular wave but its corners, order 6 next to nothing of a sine with 19
    samples a cycle.  All see white noise alike, so the least is taken.  At most 65,536
    samples are read, in 64 stretches spread over the record.

    A channel counts as quantised where more than a fifth of its steps are undone by the
    next step: the flicker of a level between two codes.  The quantum is the median such
    step.  With noise far below the quantum the differences are mostly zero, and ``noise``
    may be 0 while ``quantum`` is not.

    Examples
    --------
    A ramp with noise of 0.5.

    >>> generator = np.random.default_rng(0)
    >>> noise, quantum = estimate_noise(np.arange(5000) + generator.normal(0, 0.5, 5000))
    >>> print(round(noise, 2), quantum)
    0.50 0.0
    """
    rows = _stretches(np.asarray(values, dtype=np.float64))
    if rows.size < 8:
        raise DataError(
            "too few samples to tell noise from movement",
            found=f"{rows.size} finite samples",
            needed="8 or more",
        )
    noise = min(
        float(np.median(np.abs(np.diff(rows, n=order, axis=1))))
        / (_NORMAL_MEDIAN * sqrt(comb(2 * order, order)))
        for order in _ORDERS
        if order < rows.shape[1]
    )
    steps = np.diff(rows, axis=1).ravel()
    steps = steps[steps != 0]
    undone = np.abs(steps[1:] + steps[:-1]) < 0.05 * np.abs(steps[1:])
    is_quantised = steps.size > 1 and undone.mean() > _FLICKER_SHARE
    return noise, float(np.median(np.abs(steps[1:][undone]))) if is_quantised else 0.0


def noise_range(values: ArrayLike) -> float:
    """Range that noise alone may span in a channel: twelve deviations or three quanta.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        Channel as logged; NaN is left out. [any unit]

    Returns
    -------
    noise_range : float
        The greater of twelve standard deviations of the noise and three quanta; at least
        1e-9 of the greatest magnitude, so that rounding alone is no movement, and 1e-12.
        [unit of the channel]

    Raises
    ------
    DataError
        If fewer than 8 samples are finite.

    Notes
    -----
    Ten million normal samples span eleven deviations; a level between two codes with noise
    below one of them flickers over two or three, cf. the 12-bit position of [1]_.

    Examples
    --------
    >>> print(round(noise_range(np.random.default_rng(0).normal(0, 0.5, 5000)), 1))
    6.1
    """
    values = np.asarray(values, dtype=np.float64)
    noise, quantum = estimate_noise(values)
    floor = max(1e-9 * float(np.nanmax(np.abs(_stretches(values)))), _TINY)
    return max(_NOISE_WIDTHS * noise, _QUANTA * quantum, floor)
