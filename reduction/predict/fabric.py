r"""From cord fabric to cord layers: ribbon width, number of cords, spacing, dead ends.

A layer is one ribbon of cord fabric, cords along it, butt wrapped: the turns touch.  Rolled
out, a turn is a parallelogram whose side across the hose is :math:`\pi d_w`, so that

.. math:: w_c = \pi d_w \cos\alpha_0, \qquad N = 2 w_c n_c

The width of the ribbon is what makes the angle: it is cut, and the angle follows from it and
from the diameter it is wrapped on.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   eq. 10, 11, 22, 23 and section 2.0.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError
from reduction.record import Floats


def ribbon_width(wrap_diameter: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""Width to which the ribbon of one layer is cut.

    Parameters
    ----------
    wrap_diameter : array_like, shape (...)
        Mean diameter of the layer at rest. [m]
    wrap_angle : array_like, shape (...)
        Wanted, from the hose axis, 0 to below pi/2. [rad]

    Returns
    -------
    width : ndarray, shape (...)
        Across the cords, :math:`\pi d_w \cos\alpha_0`. [m]

    Raises
    ------
    DataError
        If a diameter is not positive or an angle is outside its range.

    Notes
    -----
    Eq. 10 of [1]_ (module): :math:`p_c \sin\alpha_0` with the pitch :math:`p_c = \pi d_w /
    \tan\alpha_0` is the same.  Each of two layers needs its own width, as it has its own
    diameter.

    Examples
    --------
    A 3.5 in layer at 64 degrees, in inches.

    >>> print(ribbon_width(3.5, np.radians(64)).round(3))
    4.82
    """
    angle = as_finite("wrap_angle", wrap_angle)
    if np.any((angle < 0) | (angle >= pi / 2)):
        raise DataError(
            "wrap_angle is no angle of a ribbon",
            found=f"{np.degrees(angle).min():g} to {np.degrees(angle).max():g} deg",
            needed="from 0 to below 90 deg",
        )
    return np.asarray(pi * as_positive("wrap_diameter", wrap_diameter) * np.cos(angle))


def number_of_cords(
    wrap_diameter: ArrayLike, wrap_angle: ArrayLike, cords_per_length: ArrayLike
) -> Floats:
    """Cords in a cross-section of the hose, both layers together.

    Parameters
    ----------
    wrap_diameter : array_like, shape (...)
        Mean of the two layers at rest. [m]
    wrap_angle : array_like, shape (...)
        From the hose axis, 0 to below pi/2. [rad]
    cords_per_length : array_like, shape (...)
        Of the fabric, across the cords. [m-1]

    Returns
    -------
    number : ndarray, shape (...)
        N, not rounded: a ribbon need not end between two cords. [1]

    Raises
    ------
    DataError
        If a diameter or a cord density is not positive, or an angle is outside its range.

    Notes
    -----
    Eq. 11 of [1]_ (module), with eq. 10.

    Examples
    --------
    3.5 in and 34 cords an inch, 64 and 68 degrees.

    >>> print(number_of_cords(3.5, np.radians([64, 68]), 34).round(1))
    [327.8 280.1]
    """
    density = as_positive("cords_per_length", cords_per_length)
    return 2 * ribbon_width(wrap_diameter, wrap_angle) * density
