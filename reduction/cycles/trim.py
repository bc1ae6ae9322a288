"""The part of a branch with a constant rate: the ends, where the machine turns, trimmed.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from reduction.errors import SettingsError
from reduction.record import Bools, Floats

__all__ = ["constant_rate_span", "stroke_span"]

_RATE_NOISE = 0.01
_WIDEST = 4  # a window is at most this part of a branch
_RATES_READ = 33
_CELLS = 1 << 18
_STROKE_END = 0.05

Indices = NDArray[np.intp]


def _rate(time: Floats, values: Floats, first: Indices, width: Indices) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = (values[first + width] - values[first]) / (time[first + width] - time[first])
    return np.asarray(rate)


def _first_passing(
    time: Floats, values: Floats, start: Indices, width: Indices, reach: Indices, least: Floats
) -> Indices:
    """Steps from the start to the first window of rate at least ``least``; -1 where none is.

    ``width`` is negative where windows reach back and the search goes back.
    """
    found = np.full(start.size, -1, dtype=np.intp)
    active = np.arange(start.size)
    begin = 0
    direction = np.sign(width)
    while active.size:
        offsets = begin + np.arange(max(8, _CELLS // active.size))
        allowed = offsets[None, :] <= reach[active, None]
        where = start[active, None] + direction[active, None] * np.minimum(
            offsets[None, :], reach[active, None]
        )
        rate = _rate(time, values, where, width[active, None])
        passes: Bools = np.asarray(allowed & (rate >= least[active, None]))
        hit = passes.any(axis=1)
        found[active[hit]] = begin + passes[hit].argmax(axis=1)
        begin += offsets.size
        active = active[~hit & (reach[active] >= begin)]
    return found


def constant_rate_span(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    *,
    noise: float,
    trim_threshold: float,
) -> tuple[Indices, Indices, Floats]:
    r"""First and last sample of the trimmed part of each branch, and the plateau rate.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    branch_first : ndarray of int, shape (n_branches,)
        First sample of each branch. [1]
    branch_last : ndarray of int, shape (n_branches,)
        Last sample of each branch, inside. [1]
    noise : float
        Standard deviation of the control channel. [m] or [N]
    trim_threshold : float
        Share of the plateau that a rate must have. [1]

    Returns
    -------
    first, last : ndarray of int, shape (n_branches,)
        Ends of the trimmed part, both inside; ``last`` is before ``first`` where no part
        of a branch has the rate. [1]
    plateau_rate : ndarray, shape (n_branches,)
        Median rate of the branch, positive. [m s-1] or [N s-1]

    Raises
    ------
    SettingsError
        If the threshold is not above 0 and at most 1.

    Notes
    -----
    The rate is that between two samples a window apart, both inside the branch.  The
    window is as many samples as make the noise of the rate 1 % of it,
    :math:`\sqrt 2 s / (0.01 v \Delta t)`, at most a quarter of the branch.  The trimmed
    part is all that lies from the begin of the first window to the end of the last
    window whose rate is at least ``trim_threshold`` times the plateau: a window that
    begins in the turn of the machine is slow as a whole.  A missing sample gives no rate.

    Examples
    --------
    One slow sample at each end.

    >>> values = np.array([0.0, 0.2, 1.2, 2.2, 3.2, 4.2, 5.2, 5.4])
    >>> constant_rate_span(
    ...     np.arange(8.0), values, np.array([0]), np.array([7]), noise=0.0, trim_threshold=0.97)
    (array([1]), array([6]), array([1.]))
    """
    if not 0 < trim_threshold <= 1:
        raise SettingsError(
            "cycles.trim_threshold is not a share",
            found=f"{trim_threshold:g}",
            needed="above 0 and at most 1",
        )
    n_steps = branch_last - branch_first
    travel = values[branch_last] - values[branch_first]
    duration = time[branch_last] - time[branch_first]
    step_travel = np.abs(travel) / np.maximum(n_steps, 1)
    typical = float(np.nanmedian(step_travel)) if step_travel.size else 0.0
    wanted = ceil(sqrt(2) * noise / (_RATE_NOISE * typical)) if typical > 0 else 1
    width = np.clip(np.minimum(wanted, n_steps // _WIDEST), 1, None).astype(np.intp)
    reach = n_steps - width  # last begin of a window, from the first sample
    sign = np.sign(travel)

    at = branch_first[:, None] + np.rint(
        np.maximum(reach, 0)[:, None] * np.linspace(0, 1, _RATES_READ)
    ).astype(np.intp)
    at = np.minimum(at, values.size - 1 - width[:, None])
    rates = sign[:, None] * _rate(time, values, at, width[:, None])
    if np.isnan(rates).any():
        known = np.where(np.isnan(rates).all(axis=1)[:, None], 0.0, rates)
        plateau = np.nanmedian(known, axis=1)
    else:
        plateau = np.median(rates, axis=1)

    # Signed so that a window passes where it is fast enough in the branch's direction.
    least = trim_threshold * plateau
    moves = (reach >= 0) & (plateau > 0) & (duration > 0)
    first, last = branch_first.copy(), branch_first - 1
    rows = np.flatnonzero(moves)
    signed = np.where(sign > 0, 1.0, -1.0)[rows]
    for falling in (False, True):
        chosen = rows[(signed < 0) == falling]
        ahead = -values if falling else values
        from_first = _first_passing(
            time, ahead, branch_first[chosen], width[chosen], reach[chosen], least[chosen]
        )
        from_last = _first_passing(
            time, ahead, branch_last[chosen], -width[chosen], reach[chosen], least[chosen]
        )
        passed = from_first >= 0
        first[chosen[passed]] = branch_first[chosen[passed]] + from_first[passed]
        last[chosen[passed]] = branch_last[chosen[passed]] - from_last[passed]
    return first, last, plateau


def stroke_span(
    values: Floats, branch_first: Indices, branch_last: Indices
) -> tuple[Indices, Indices]:
    """First and last sample of the middle 90 % of the stroke of each branch.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    branch_first : ndarray of int, shape (n_branches,)
        First sample of each branch. [1]
    branch_last : ndarray of int, shape (n_branches,)
        Last sample of each branch, inside. [1]

    Returns
    -------
    first, last : ndarray of int, shape (n_branches,)
        Ends of the middle part, both inside; ``last`` before ``first`` where no sample
        is in it. [1]

    Raises
    ------
    IndexError
        If an end is not a sample of the values.

    Notes
    -----
    For waveforms without a plateau.  Five hundredths of the stroke are left out at each
    end; a sine has 44 % of its greatest rate there.

    Examples
    --------
    >>> values = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 21))
    >>> stroke_span(values, np.array([0]), np.array([20]))
    (array([3]), array([17]))
    """
    low = values[branch_first] + _STROKE_END * (values[branch_last] - values[branch_first])
    high = values[branch_last] - _STROKE_END * (values[branch_last] - values[branch_first])
    sign = np.sign(high - low)
    first, last = branch_first.copy(), branch_first - 1
    for i, (begin, end) in enumerate(zip(branch_first, branch_last, strict=True)):
        inside = sign[i] * (values[begin : end + 1] - low[i]) >= 0
        inside &= sign[i] * (high[i] - values[begin : end + 1]) >= 0
        rows = np.flatnonzero(inside)
        if rows.size:
            first[i], last[i] = begin + rows[0], begin + rows[-1]
    return first, last
