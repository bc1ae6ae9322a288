"""Samples of one specimen in one hold, and the ramp before it, out of a record.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1 (holds between cycles).
"""

from __future__ import annotations

import numpy as np

from reduction.holds.ramp import Ramp, begins_inside, find_ramp
from reduction.holds.support import Hold
from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats
from reduction.samples.blocks import sample_blocks
from reduction.samples.columns import chosen
from reduction.samples.scratch import empty_like

_LOOKED_BACK = 1 << 16
"""Samples before a hold in which its ramp is looked for at first: many cycles may lie between two
holds."""


def _finite_times(part: slice, time: Floats, *series: Floats) -> Floats:
    """Times of the samples of a part, -inf where one of their values is not finite."""
    finite = np.isfinite(time[part])
    for one in series:
        finite &= np.isfinite(one[part])
    return np.where(finite, time[part], -np.inf)


def _is_sound(time: Floats, *series: Floats, after: float = -np.inf) -> Bools:
    """Which samples have finite values and a time that is later than all before."""
    is_sound, latest = empty_like(time, dtype=bool), after
    for part in sample_blocks(time.size, time, *series, is_sound):
        known = _finite_times(part, time, *series)
        reached = np.maximum.accumulate(np.concatenate([[latest], known]))
        np.greater(known, reached[:-1], out=is_sound[part])
        latest = float(reached[-1])
    return is_sound


def _latest(time: Floats, *series: Floats) -> float:
    """Latest time of samples whose values are finite."""
    latest = -np.inf
    for part in sample_blocks(time.size, time, *series):
        latest = _finite_times(part, time, *series).max(initial=latest)
    return float(latest)


def _ramp_before(time: Floats, moved: Floats, answer: Floats, *, band: float) -> Ramp | None:
    """The ramp that ends with the last sample, out of as much as shows where it began."""
    n_looked = 0
    while n_looked < time.size:
        n_looked = min(max(2 * n_looked, _LOOKED_BACK), time.size)
        start = time.size - n_looked
        whole = time, moved, answer
        looked = [one[start:] for one in whole]
        is_sound = _is_sound(*looked, after=_latest(*(one[:start] for one in whole)))
        before = chosen(is_sound.__getitem__, *looked)
        if before[0].size > 2 and begins_inside(before[1], band=band):
            break
    return find_ramp(*before, band=band) if before[0].size > 2 else None


def select_hold(
    time: Floats,
    position: Floats,
    tension: Floats,
    strain: Floats,
    standstills: Standstills,
    index: int,
) -> Hold:
    """Take the samples of one specimen in one standstill, and the ramp that led to it.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time; samples that do not come later than all before are left out. [s]
    position : ndarray, shape (n_samples,)
        Crosshead position. [m]
    tension : ndarray, shape (n_samples,)
        Of this specimen; a sample that is NaN here, in time or in position is left out. [N]
    strain : ndarray, shape (n_samples,)
        Of this specimen; may be NaN. [1]
    standstills : Standstills
        Of the record; where it has a ``tension_tolerance`` the ramp is that of the tension. [SI]
    index : int
        Which of them. [1]

    Returns
    -------
    hold : Hold
        Without notes or refusals as yet. [SI]

    Raises
    ------
    IndexError
        If there is no such standstill.

    Notes
    -----
    The ramp is looked for from the start of the standstill before, or of the record.

    Examples
    --------
    A rise of 5 m in 5 s, of which one sample of the hold is missing.

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
    begin = int(standstills.first[index - 1]) if index else 0
    inside = slice(first, last + 1)
    held = [one[inside] for one in (time, position, tension, strain)]
    seconds, place, load, stretch = chosen(_is_sound(*held[:3]).__getitem__, *held)
    # under load control the machine moves the tension, and the length answers
    moved, answer, band = position, tension, standstills.position_tolerance
    if standstills.tension_tolerance is not None:
        moved, answer, band = tension, position, standstills.tension_tolerance
    ramp = _ramp_before(*(one[begin : first + 1] for one in (time, moved, answer)), band=band)
    return Hold(
        time=seconds,
        position=place,
        tension=load,
        strain=stretch,
        start_time=float(standstills.start_time[index]),
        ramp=ramp,
        position_tolerance=standstills.position_tolerance,
        slack_tension=standstills.slack_tension,
    )
