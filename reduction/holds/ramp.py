r"""The finite ramp before a hold: when it began, where its centre is, how long it counts.

To first order a ramp acts as a step at the centre of the tension that it adds, whatever
the law of relaxation; what is left falls with the square of ramp time over elapsed time.

References
----------
.. [1] L. J. Zapas and J. C. Phillips, "Simple shearing flows in polyisobutylene solutions,"
   J. Res. Natl. Bur. Stand. 75A(1), 1971 (half of the ramp time as the zero of time).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_increasing, as_same_shape
from reduction.record import Floats

__all__ = ["Ramp", "begins_inside", "find_ramp"]


@dataclass(frozen=True)
class Ramp:
    """The ramp that led to a hold.

    Parameters
    ----------
    start_time, end_time : float
        First and last time of the motion. [s]
    centre_time : float
        Time at which a step would act as the ramp does. [s]
    duration : float
        Duration of the constant-rate ramp of the same centre and spread. [s]
    stiffness : float
        Slope of tension on position over the last half of the stroke. [N m-1]
    """

    start_time: float
    end_time: float
    centre_time: float
    duration: float
    stiffness: float


def find_ramp(
    time: ArrayLike, position: ArrayLike, tension: ArrayLike, *, band: float
) -> Ramp | None:
    r"""Last monotonic motion of a record that ends where a hold begins.

    .. math:: t_c = t_1 - \int_{t_0}^{t_1} \frac{T - T_0}{T_1 - T_0} dt

    is the centre of the tension that the ramp adds; the spread is its second moment.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        From any time before the ramp up to the first sample of the hold. [s]
    position : array_like, shape (n_samples,)
        Crosshead position. [m]
    tension : array_like, shape (n_samples,)
        Tension. [N]
    band : float
        A change of position within it is not motion. [m]

    Returns
    -------
    ramp : Ramp or None
        None where the record shows no motion before the hold. [s]

    Raises
    ------
    DataError
        If the series do not pair up or the time does not increase.

    Notes
    -----
    The rule of the half ramp ([1]_) is the case of tension rising evenly.  A tension that
    stiffens with stretch puts the centre later than that.  Where the ramp does not add
    tension (unloading), the centre of position is taken.  Both moments are integrals of
    the record, not of its differences, so noise does not enter them.  The ramp begins at
    the last sample within ``band`` of its far end, which is late by the time that the
    crosshead takes for it.

    Examples
    --------
    >>> t = np.arange(0.0, 5.0)
    >>> ramp = find_ramp(t, [0.0, 0.0, 1.0, 2.0, 3.0], [0.0, 0.0, 10.0, 20.0, 30.0], band=0.1)
    >>> ramp.start_time, ramp.centre_time, ramp.duration, round(ramp.stiffness, 6)
    (1.0, 2.5, 3.0, 10.0)
    """
    seconds = as_increasing("time", time)
    seconds, place, load = as_same_shape(time=seconds, position=position, tension=tension)
    reach, _ = _way_back(place, band)
    if reach.size == 0:
        return None
    # The last sample within the band of the far end: a standstill there is no part of the ramp.
    first = place.size - 1 - int(np.flatnonzero(reach >= reach.max() - band)[0])
    seconds, place, load = seconds[first:], place[first:], load[first:]
    end = float(seconds[-1])
    rise = load[-1] - load[0]
    added = (load - load[0]) / rise if rise > 0 else (place - place[0]) / (place[-1] - place[0])
    before = float(np.trapezoid(added, seconds))
    left, step = end - seconds, np.diff(seconds)
    # Exact where both factors are straight between samples: a ramp may have few of them.
    middle = (left[1:] + left[:-1]) * (added[1:] + added[:-1]) / 2
    square = float(step @ (left[1:] * added[1:] + left[:-1] * added[:-1] + 2 * middle)) / 3
    centre = end - before
    spread = max(0.0, square - before**2)
    upper = np.abs(place - place[-1]) <= 0.5 * abs(place[-1] - place[0])
    stroke = np.ptp(place[upper])
    return Ramp(
        start_time=float(seconds[0]),
        end_time=end,
        centre_time=min(end, max(float(seconds[0]), centre)),
        duration=min(end - float(seconds[0]), float(np.sqrt(12 * spread))),
        stiffness=float(np.polyfit(place[upper], load[upper], 1)[0]) if stroke > 0 else np.nan,
    )


def begins_inside(position: ArrayLike, *, band: float) -> bool:
    """Whether a series shows where its last motion began, so that nothing before it counts.

    Parameters
    ----------
    position : array_like, shape (n_samples,)
        Up to the first sample of the hold. [m]
    band : float
        A change of position within it is not motion. [m]

    Returns
    -------
    begins_inside : bool
        False where the motion may have begun before the series. [1]

    Raises
    ------
    IndexError
        If there is no sample.

    Examples
    --------
    >>> begins_inside([0.0, 1.0, 2.0], band=0.1), begins_inside([5.0, 0.0, 1.0, 2.0], band=0.1)
    (False, True)
    """
    return _way_back(np.asarray(position, dtype=np.float64), band)[1]


def _way_back(place: Floats, band: float) -> tuple[Floats, bool]:
    """Distance from the last sample, backwards through the last motion; whether a turn ends it.

    Positive in the direction from which the crosshead came; empty without motion.
    """
    away = place - place[-1]
    distant = np.flatnonzero(np.abs(away) > band)
    if distant.size == 0:
        return np.empty(0), False
    back = (away * np.sign(away[distant[-1]]))[::-1]
    turned = np.flatnonzero(np.maximum.accumulate(back) - back > band)
    return (back[: turned[0]], True) if turned.size else (back, False)
