"""When a hold begins: the ramp before it, and its samples.

To first order a ramp acts as a step at the centre of the tension that it adds, whatever
the law of relaxation; what is left falls with the square of ramp time over elapsed time.

References
----------
.. [1] L. J. Zapas and J. C. Phillips, "Simple shearing flows in polyisobutylene solutions," J.
   Res. Natl. Bur. Stand. 75A(1), 1971 (half of the ramp time as the zero of time).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_increasing, as_same_shape
from reduction.record.measurement import Floats
from reduction.record.samples import (
    BLOCK,
    finite_extremes,
    last_sample,
    mean_of,
    release_pages,
    sample_blocks,
    select_samples,
)


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
    way = _way_back(place, band)
    if way is None:
        return None
    # The last sample within the band of the far end: a standstill there is no part of the ramp.
    first = last_sample(
        lambda part: way.sign * (place[part] - place[-1]) >= way.reach - band,
        way.first, place.size, place,
    )  # fmt: skip
    seconds, place, load = seconds[first:], place[first:], load[first:]
    end = float(seconds[-1])
    adds = load if load[-1] > load[0] else place
    lowest, rise = float(adds[0]), float(adds[-1] - adds[0])
    before = square = 0.0
    for part in sample_blocks(seconds.size, seconds, adds, overlap=1):
        added, left = (adds[part] - lowest) / rise, end - seconds[part]
        before += float(np.trapezoid(added, seconds[part]))
        # Exact where both factors are straight between samples: a ramp may have few of them.
        middle = (left[1:] + left[:-1]) * (added[1:] + added[:-1]) / 2
        both = left[1:] * added[1:] + left[:-1] * added[:-1] + 2 * middle
        square += float(np.diff(seconds[part]) @ both) / 3
    centre = end - before
    spread = max(0.0, square - before**2)
    return Ramp(
        start_time=float(seconds[0]),
        end_time=end,
        centre_time=min(end, max(float(seconds[0]), centre)),
        duration=min(end - float(seconds[0]), float(np.sqrt(12 * spread))),
        stiffness=_upper_slope(place, load),
    )


def begins_inside(position: ArrayLike, *, band: float) -> bool:
    """Whether a series shows where its last motion began, so that nothing before it counts.

    Examples
    --------
    >>> begins_inside([0.0, 1.0, 2.0], band=0.1), begins_inside([5.0, 0.0, 1.0, 2.0], band=0.1)
    (False, True)
    """
    way = _way_back(np.asarray(position, dtype=np.float64), band)
    return way is not None and way.turned


@dataclass(frozen=True)
class _Way:
    """The last motion of a record: its first sample, or one before it, and how far it came.

    ``reach`` is its greatest distance from the last sample, times ``sign`` positive in the
    direction from which the crosshead came; ``turned`` is true where a turn begins it.
    """

    first: int
    sign: float
    reach: float
    turned: bool


def _way_back(place: Floats, band: float) -> _Way | None:
    """The last motion, looked for backwards from the last sample; None without motion."""
    end = place[-1]
    distant = last_sample(lambda part: np.abs(place[part] - end) > band, 0, place.size, place)
    if distant is None:
        return None
    sign, reach = float(np.sign(place[distant] - end)), -np.inf
    for stop in range(place.size, 0, -BLOCK):
        back = sign * (place[max(stop - BLOCK, 0) : stop] - end)[::-1]
        reached = np.maximum(np.maximum.accumulate(back), reach)
        release_pages(place)
        turned = np.flatnonzero(reached - back > band)
        if turned.size:
            at = int(turned[0])
            return _Way(stop - at, sign, float(reached[at]), turned=True)
        reach = float(reached[-1])
    return _Way(0, sign, reach, turned=False)


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
