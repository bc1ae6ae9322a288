"""Secant and chord modulus: slopes between two points, not of the curve.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats


def secant_modulus(strain: ArrayLike, tension: ArrayLike, *, area: ArrayLike) -> Floats:
    r"""Stress over strain, from the unstretched state.

    .. math:: E = \frac{F}{A \varepsilon}

    Parameters
    ----------
    strain : array_like, shape (...)
        Nominal strain. [1]
    tension : array_like, shape (...)
        Tension at it. [N]
    area : array_like, shape (...)
        Cross-sectional area at zero tension. [m2]

    Returns
    -------
    modulus : ndarray, shape (...)
        Secant modulus. [Pa]

    Raises
    ------
    DataError
        If an area is not positive.

    Notes
    -----
    Printed source: eq. 1 of [1]_. NaN where strain is zero or below, or an input is NaN.

    Examples
    --------
    The design value of sec. 2.3 of [1]_, 85 lbf at 100 %, on a diameter of 1.04 in: 100 psi.

    >>> print((secant_modulus(1.0, 378.1, area=5.4805e-4) / 6894.757).round(0))
    100.0
    """
    areas = as_positive("area", area)
    strain, tension = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    return np.asarray(tension / (areas * np.where(strain > 0, strain, np.nan)))


def chord_modulus(
    strain_low: ArrayLike,
    strain_high: ArrayLike,
    tension_low: ArrayLike,
    tension_high: ArrayLike,
    *,
    area: ArrayLike,
) -> Floats:
    r"""Slope of stress between two points of a branch.

    .. math:: E = \frac{F_2 - F_1}{A (\varepsilon_2 - \varepsilon_1)}

    Parameters
    ----------
    strain_low : array_like, shape (...)
        Strain at one point. [1]
    strain_high : array_like, shape (...)
        Strain at the other. [1]
    tension_low : array_like, shape (...)
        Tension at the first point. [N]
    tension_high : array_like, shape (...)
        Tension at the other. [N]
    area : array_like, shape (...)
        Cross-sectional area at zero tension. [m2]

    Returns
    -------
    modulus : ndarray, shape (...)
        Chord modulus. [Pa]

    Raises
    ------
    DataError
        If an area is not positive, or a pair of points has the same strain.

    Notes
    -----
    Printed source: Tables 5 and 6 of [1]_ are chords between the limits they print; 43 of
    their 47 rows agree within 1 psi, on 1.04 in for the new tether (Table 2 prints 1.01)
    and 0.94 in for the used one. End points carry the noise of two samples; use it on
    means, not on raw samples.

    Examples
    --------
    Table 6 of [1]_, T-5 new: 124 to 275 lbf over 1.72 to 2.19, printed 378 psi.

    >>> pound_force, psi = 4.4482216, 6894.757
    >>> modulus = chord_modulus(
    ...     1.72, 2.19, 124 * pound_force, 275 * pound_force, area=np.pi / 4 * 0.026416**2
    ... )
    >>> print((modulus / psi).round(0))
    378.0
    """
    areas = as_positive("area", area)
    run = np.asarray(strain_high, dtype=np.float64) - np.asarray(strain_low, dtype=np.float64)
    if (run == 0).any():
        raise DataError(
            "a chord needs two strains",
            found=f"{np.count_nonzero(run == 0)} of {run.size} pairs with equal strain",
            needed="two different strains",
        )
    rise = np.asarray(tension_high, dtype=np.float64) - np.asarray(tension_low, dtype=np.float64)
    return np.asarray(rise / (areas * run))
