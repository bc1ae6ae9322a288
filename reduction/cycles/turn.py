"""Cosine and sine of many angles, from a table of one turn.

References
----------
.. [1] M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions," NBS, 1964,
   eqs. 4.3.16 and 4.3.17 (sums of angles), 4.3.65 and 4.3.66 (series).
"""

from __future__ import annotations

import numpy as np

from reduction.record import Floats

_PLACES = 1 << 12  # a power of two, so that the turns come off an index bit by bit
_STEP = 2 * np.pi / _PLACES
_COSINE, _SINE = np.cos(_STEP * np.arange(_PLACES)), np.sin(_STEP * np.arange(_PLACES))


def cosine_and_sine(phase: Floats) -> tuple[Floats, Floats]:
    """Cosine and sine of many angles, in half the time of `numpy.cos` and `numpy.sin` or less.

    Parameters
    ----------
    phase : ndarray, shape (n_samples,)
        Angles of some turns. [rad]

    Returns
    -------
    cosine, sine : ndarray, shape (n_samples,)
        To 7e-16 within a turn; NaN where the angle is. [1]

    Raises
    ------
    TypeError
        If the angles are not real numbers.

    Notes
    -----
    From the nearest of 4,096 tabulated angles by the sum of two angles ([1]_).  Over the rest, at
    most 8e-4, the next terms of both series, of fifth and sixth power, are below 1e-17.

    Examples
    --------
    >>> cosine, sine = cosine_and_sine(np.array([0.0, np.pi / 6]))
    >>> print(cosine[0], sine[1].round(15))
    1.0 0.5
    """
    nearest = phase * (1 / _STEP)
    np.rint(nearest, out=nearest)
    with np.errstate(invalid="ignore"):  # NaN has no place, and its rest is NaN
        place = nearest.astype(np.intp)
    place &= _PLACES - 1
    nearest *= _STEP
    rest = np.subtract(phase, nearest, out=nearest)
    square = rest * rest
    less = square * (-1 / 24)  # one less the cosine of the rest
    less += 0.5
    less *= square
    square *= rest
    square *= 1 / 6
    rest -= square  # now its sine
    cosine, sine = _COSINE.take(place), _SINE.take(place)
    change = np.multiply(sine, rest, out=square)
    change += cosine * less
    rest *= cosine
    less *= sine
    rest -= less
    cosine -= change
    sine += rest
    return cosine, sine
