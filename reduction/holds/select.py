"""Samples of one specimen in one hold, and the ramp before it, out of a record.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1 (holds between cycles).
"""

from __future__ import annotations

import numpy as np

from reduction.holds.ramp import find_ramp
from reduction.holds.support import Hold
from reduction.phases.standstill import Standstills
from reduction.record import Floats, Integers

__all__ = ["select_hold"]


def _sound_rows(time: Floats, *series: Floats) -> Integers:
    """Rows whose values are finite and whose time is later than all before."""
    finite = np.isfinite(time)
    for one in series:
        finite &= np.isfinite(one)
    rows = np.flatnonzero(finite)
    return rows[np.diff(np.maximum.accumulate(time[rows]), prepend=-np.inf) > 0]


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
    rows = first + _sound_rows(time[inside], position[inside], tension[inside])
    seconds, place, load, stretch = (one[rows] for one in (time, position, tension, strain))
    # under load control the machine moves the tension, and the length answers
    moved, answer, band = position, tension, standstills.position_tolerance
    if standstills.tension_tolerance is not None:
        moved, answer, band = tension, position, standstills.tension_tolerance
    rows = begin + _sound_rows(*(one[begin : first + 1] for one in (time, moved, answer)))
    before = [one[rows] for one in (time, moved, answer)]
    ramp = find_ramp(*before, band=band) if before[0].size > 2 else None
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
