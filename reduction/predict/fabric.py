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

__all__ = [
    "angle_per_relative_width",
    "dead_length_share_of",
    "number_of_cords",
    "ribbon_angle",
    "ribbon_width",
]


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


def ribbon_angle(wrap_diameter: ArrayLike, width: ArrayLike) -> Floats:
    r"""Wrap angle that a ribbon of given width makes where it is butt wrapped.

    Parameters
    ----------
    wrap_diameter : array_like, shape (...)
        Mean diameter of the layer at rest. [m]
    width : array_like, shape (...)
        Of the ribbon, across the cords. [m]

    Returns
    -------
    angle : ndarray, shape (...)
        From the hose axis, :math:`\arccos(w_c / \pi d_w)`; NaN where the ribbon is wider than
        the circumference. [rad]

    Raises
    ------
    DataError
        If a diameter or a width is not positive.

    Notes
    -----
    Inverse of eq. 10 of [1]_ (module).  One width on two layers gives two angles: the outer
    layer is steeper, picks up later, and the layers no longer balance in torque.

    Examples
    --------
    The width that gives 64 degrees on 3.4 in gives 1.5 degrees more on 3.6 in.

    >>> width = ribbon_width(3.4, np.radians(64))
    >>> print(np.degrees(ribbon_angle([3.4, 3.6], width)).round(2))
    [64.   65.54]
    """
    share = as_positive("width", width) / (pi * as_positive("wrap_diameter", wrap_diameter))
    return np.asarray(np.arccos(np.where(share <= 1, share, np.nan)))


def angle_per_relative_width(wrap_angle: ArrayLike) -> Floats:
    r"""Change of the wrap angle for a relative error of diameter over ribbon width.

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        From the hose axis. [rad]

    Returns
    -------
    slope : ndarray, shape (...)
        :math:`d\alpha_0 / d\ln(d_w/w_c) = \cot\alpha_0`. [rad]

    Raises
    ------
    DataError
        If an angle is not finite.

    Notes
    -----
    Derived from eq. 10 of [1]_ (module).  With the angle held, the diameter of the cords does
    not change the stretch at the working load; with the *ribbon* held, it does: a layer 1 %
    larger than it was cut for, or a ribbon 1 % narrow, is wrapped 0.28 degrees steeper at 64
    degrees.  Where the angle is not measured on the hose but follows from the ribbon, this
    times the relative uncertainty of diameter and width is the uncertainty of the angle.

    Examples
    --------
    >>> print(np.degrees(0.01 * angle_per_relative_width(np.radians([64, 68]))).round(3))
    [0.279 0.231]
    """
    return np.asarray(1 / np.tan(as_finite("wrap_angle", wrap_angle)))


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


def dead_length_share_of(length: ArrayLike, dead_lengths: ArrayLike) -> Floats:
    """Part of a hose that the stretch-limiting layers at its ends keep from stretching.

    Parameters
    ----------
    length : array_like, shape (...)
        Relaxed, between the points whose distance the strain is of. [m]
    dead_lengths : array_like, shape (n_ends, ...)
        Relaxed, of each stretch-limited end inside ``length``. [m]

    Returns
    -------
    share : ndarray, shape (...)
        `dead_length_share` of a design. [1]

    Raises
    ------
    DataError
        If a length is not positive, an end is negative, or no free length is left.

    Notes
    -----
    Section 2.0 of [1]_ (module): layers near each termination "reduce the hose stretch under
    load to near zero where the hose body is positioned over the coupling".  Near zero is taken
    as zero; the transition beyond the layers is not in it.

    Examples
    --------
    The 8 ft test hose with 6 in at each end: an eighth of its stretch is lost.

    >>> print(dead_length_share_of(96.0, [6.0, 6.0]))
    0.125
    """
    whole = as_positive("length", length)
    ends = as_finite("dead_lengths", dead_lengths)
    if ends.ndim == 0:
        raise DataError(
            "dead_lengths has no axis of ends", found="one number", needed="a length of each end"
        )
    dead = ends.sum(axis=0)
    if np.any(ends < 0) or np.any(dead >= whole):
        raise DataError(
            "the ends do not leave a free length",
            found=f"ends of {np.array2string(dead, threshold=4)} m in "
            f"{np.array2string(whole, threshold=4)} m",
            needed="ends of zero or more that are together shorter than the hose",
        )
    return np.asarray(dead / whole)
