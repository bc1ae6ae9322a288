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

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.line.cubic import slope_of_cubic
from reduction.lookup.product import LineCurve
from reduction.moduli.interpolation import curve_at
from reduction.record import Bools, Floats, read_only_arrays
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)

_EDGE = 1e-9


@dataclass(frozen=True)
@read_only_arrays
class CurvePoints:
    """A curve at points; arrays have the shape (...) of the points.

    Parameters
    ----------
    value : ndarray
        A polynomial goes on beyond its range; between points straight lines, beyond the last
        one NaN. [SI unit of the quantity]
    random, freedom : ndarray
        Standard uncertainty of what is of this curve alone, and its degrees of freedom; NaN where
        not known. [SI unit of the quantity], [1]
    contribution : ndarray, shape (n_components, ...)
        Of the errors that the curve shares. [SI unit of the quantity]
    standard_uncertainty, half_width : ndarray
        Of both together, and of the 95 % interval; NaN where not known. [SI unit of the quantity]
    is_inside : ndarray of bool
        Between the ends of the range that was tested, and in none of its gaps. [1]
    """

    value: Floats
    random: Floats
    freedom: Floats
    contribution: Floats
    standard_uncertainty: Floats
    half_width: Floats
    is_inside: Bools


def evaluate_curve(curve: LineCurve, at: ArrayLike) -> CurvePoints:
    """Value of a curve, its uncertainty, and whether the point was tested.

    Parameters
    ----------
    curve : LineCurve
        Polynomial or points.
    at : array_like, shape (...)
        Of its variable. [SI unit of the variable]

    Returns
    -------
    points : CurvePoints
        [SI unit of the quantity]

    Raises
    ------
    DataError
        If a cubic whose slope is wanted has not four coefficients.

    Notes
    -----
    Source: [1]_ for polynomials, [2]_ for moduli over strain.  Between points every part of the
    uncertainty is on a straight line, as the value is: neighbours are of the same cycles.

    Examples
    --------
    >>> curve = LineCurve("strain", "tension", 0.0, 10.0, coefficient=np.array([0.0, 0.1, 0.02]))
    >>> found = evaluate_curve(curve, [5.0, 20.0])
    >>> print(found.value, found.is_inside)
    [ 1. 10.] [ True False]
    """
    points = np.asarray(at, dtype=np.float64)
    width = _EDGE * max(abs(curve.low), abs(curve.high))
    inside = (points >= curve.low - width) & (points <= curve.high + width)
    for low, high in curve.gaps:
        inside &= (points <= low + width) | (points >= high - width)

    def between(values: Floats) -> Floats:
        return curve_at(points.ravel(), curve.at, values, spacing=None).reshape(points.shape)

    if curve.is_inverse_slope:
        value = slope_of_cubic(points, curve.coefficient)
    elif curve.coefficient.size:
        value = np.asarray(np.polynomial.polynomial.polyval(points, curve.coefficient))
    else:
        value = between(curve.value)
    nothing: Floats = np.full(points.shape, np.nan)
    rows = np.zeros((len(curve.component), *points.shape))
    random, freedom = nothing, nothing
    if curve.standard_uncertainty.size:
        shared = np.sum(curve.contribution**2, axis=0) if curve.component else 0.0
        random = between(np.sqrt(np.maximum(curve.standard_uncertainty**2 - shared, 0.0)))
        few = 1 / curve.degrees_of_freedom if curve.degrees_of_freedom.size else 0 * curve.at
        with np.errstate(divide="ignore"):
            freedom = 1 / between(few)
        for place, own in enumerate(curve.contribution):
            rows[place] = between(own)
    spread = combined_standard_uncertainty(rows, random)
    effective = effective_degrees_of_freedom(
        random,
        freedom,
        contribution=rows,
        of_contribution=np.array([one.degrees_of_freedom for one in curve.component]),
    )
    return CurvePoints(
        value=value,
        random=random,
        freedom=freedom,
        contribution=rows,
        standard_uncertainty=spread,
        half_width=coverage_factor(effective) * spread,
        is_inside=inside,
    )
