"""Where a test is held at constant tension: the crosshead creeps, the machine keeps the load.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.phases.intervals import still_intervals
from reduction.phases.noise import noise_range
from reduction.phases.standstill import Standstills, describe_standstills, find_standstills
from reduction.samples.blocks import mean_of_rows
from reduction.settings import PhaseSettings


def find_tension_stands(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, *, settings: PhaseSettings
) -> Standstills:
    """Find every hold at constant tension, and every rest.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time. [s]
    position : array_like, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    settings : PhaseSettings
        What is None there is found here and written into the result. [SI]

    Returns
    -------
    standstills : Standstills
        In order of time, with ``tension_tolerance``. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, are too short, or time does not advance.

    Notes
    -----
    *Holds* are intervals above the slack tension in which the tension stands still
    (`still_intervals`), that of the machine: the mean over the specimens, which pull at one
    crosshead.  Tolerance, where not stated: `noise_range` of it.  *Rests* are those of
    `find_standstills`, since a slack specimen has the same tension wherever the crosshead
    goes.  Where both meet the rest is shortened.

    Examples
    --------
    A minute slack, a pull of 10 s, a minute at 100 N in which the crosshead creeps.

    >>> time = np.arange(0, 130.0)
    >>> load = np.interp(time, [0, 60, 70, 130], [0, 0, 100, 100])
    >>> position = load / 100 + 0.1 * np.clip(time - 70, 0, None)
    >>> found = find_tension_stands(time, position, [load], settings=PhaseSettings())
    >>> print(found.start_time, found.end_time, found.is_rest)
    [ 0. 70.] [ 60. 129.] [ True False]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    seconds, place, _ = as_same_shape(time=time, position=position, tension=loads[0])
    crosshead = find_standstills(seconds, place, loads, settings=settings)
    mean = mean_of_rows(loads)
    tolerance = settings.tension_tolerance
    if tolerance is None:
        tolerance = noise_range(mean)
    first, last = still_intervals(
        seconds, mean, tolerance=tolerance, minimum_duration=settings.minimum_duration
    )
    limits = {
        "position_tolerance": crosshead.position_tolerance,
        "slack_tension": crosshead.slack_tension,
        "tension_tolerance": float(tolerance),
    }
    stands = describe_standstills(seconds, place, loads, first, last, **limits)
    held, rest = ~stands.is_rest, crosshead.is_rest
    first = np.concatenate([stands.first[held], crosshead.first[rest]])
    last = np.concatenate([stands.last[held], crosshead.last[rest]])
    is_rest = np.repeat([False, True], [held.sum(), rest.sum()])
    order = np.argsort(first, kind="stable")
    first, last, is_rest = first[order], last[order], is_rest[order]
    before = is_rest[:-1]
    last[:-1][before] = np.minimum(last[:-1], first[1:] - 1)[before]
    first[1:][is_rest[1:]] = np.maximum(first[1:], last[:-1] + 1)[is_rest[1:]]
    left = first <= last
    return describe_standstills(seconds, place, loads, first[left], last[left], **limits)
