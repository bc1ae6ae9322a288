"""A quantity over one variable: polynomials as published, points as measured.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 6-9.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.line.cubic import slope_of_cubic
from reduction.lookup.product import LineCurve
from reduction.record import Bools, Floats

__all__ = ["evaluate_curve"]

_EDGE = 1e-9


def evaluate_curve(curve: LineCurve, at: ArrayLike) -> tuple[Floats, Floats, Bools]:
    """Value of a curve, its standard uncertainty, and whether the point was tested.

    Parameters
    ----------
    curve : LineCurve
        Polynomial or points.
    at : array_like, shape (...)
        Of its variable. [SI unit of the variable]

    Returns
    -------
    value : ndarray, shape (...)
        A polynomial goes on beyond its range; between points straight lines, beyond the last
        one NaN. [SI unit of the quantity]
    standard_uncertainty : ndarray, shape (...)
        NaN where not known. [SI unit of the quantity]
    is_inside : ndarray of bool, shape (...)
        Between the ends of the range that was tested, and in none of its gaps. [1]

    Raises
    ------
    DataError
        If a cubic whose slope is wanted has not four coefficients.

    Notes
    -----
    Source: [1]_ for polynomials, [2]_ for moduli over strain.

    Examples
    --------
    >>> curve = LineCurve("strain", "tension", 0.0, 10.0, coefficient=np.array([0.0, 0.1, 0.02]))
    >>> value, _, inside = evaluate_curve(curve, [5.0, 20.0])
    >>> print(value, inside)
    [ 1. 10.] [ True False]
    """
    points = np.asarray(at, dtype=np.float64)
    width = _EDGE * max(abs(curve.low), abs(curve.high))
    inside = (points >= curve.low - width) & (points <= curve.high + width)
    for low, high in curve.gaps:
        inside &= (points <= low + width) | (points >= high - width)
    spread: Floats = np.full(points.shape, np.nan)
    if curve.standard_uncertainty.size:
        spread = np.interp(points, curve.at, curve.standard_uncertainty, left=np.nan, right=np.nan)
    if curve.is_inverse_slope:
        value = slope_of_cubic(points, curve.coefficient)
    elif curve.coefficient.size:
        value = np.asarray(np.polynomial.polynomial.polyval(points, curve.coefficient))
    else:
        value = np.interp(points, curve.at, curve.value, left=np.nan, right=np.nan)
    return value, spread, inside
