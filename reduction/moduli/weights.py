"""What readings under hung weights say: gauge length, odd rows, branches, slopes.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive, as_same_shape
from reduction.errors import DataError
from reduction.record import Bools, Floats, Integers

STRAIN_DIGIT = 0.01
"""A recorded elongation is a whole per cent; readings that differ by less agree. [1]"""
_ASCENDING, _DESCENDING = 1, 2
# robust standard deviations beyond which a row disagrees with the others
_INCONSISTENT = 5.0
_MAD_TO_DEVIATION = 1.4826
_MEDIAN_TO_MEAN = sqrt(pi / 2)


def recover_gauge_length(length: ArrayLike, printed_strain: ArrayLike) -> tuple[float, float]:
    r"""Gauge length that readings of length and elongation imply.

    .. math:: g = \operatorname{median}\; \ell_i / (1 + \varepsilon_i)

    Parameters
    ----------
    length : array_like, shape (n_steps,)
        Between the gauge marks. [m]
    printed_strain : array_like, shape (n_steps,)
        Elongation as recorded; NaN where not recorded. [1]

    Returns
    -------
    gauge_length : float
        Median over the rows, which a single misread row does not move. [m]
    standard_uncertainty : float
        Of the median, from the scatter of the rows (type A). [m]

    Raises
    ------
    DataError
        If no row has both readings, or one is impossible.

    Notes
    -----
    Table 4 of [1]_ gives 6.125 in, with 14 of 15 rows within 0.6 points of strain;
    section 4.8 states a free length of 18 in, which would make every strain
    negative or nearly so.

    Examples
    --------
    Three rows of Table 4 of [1]_, in inches:

    >>> gauge, _ = recover_gauge_length([9.31, 12.95, 18.00], [0.52, 1.11, 1.94])
    >>> print(round(gauge, 3))
    6.125
    """
    rows = as_same_shape(length=length, printed_strain=printed_strain)
    known = np.isfinite(rows[1])
    if not known.any():
        raise DataError(
            "no reading has a recorded elongation",
            needed="at least one, or a stated gauge length",
            hint="Give gauge_length of the specimen.",
        )
    stretch = as_positive("1 + printed_strain", 1 + rows[1][known])
    gauge = as_positive("length", rows[0][known]) / stretch
    median = float(np.median(gauge))
    deviation = _MAD_TO_DEVIATION * float(np.median(np.abs(gauge - median)))
    return median, _MEDIAN_TO_MEAN * deviation / sqrt(gauge.size)


def find_inconsistent_readings(
    length: ArrayLike, printed_strain: ArrayLike, *, gauge_length: float
) -> Bools:
    """Rows whose length and recorded elongation disagree.

    Parameters
    ----------
    length : array_like, shape (n_steps,)
        Between the gauge marks. [m]
    printed_strain : array_like, shape (n_steps,)
        Elongation as recorded; NaN where not recorded. [1]
    gauge_length : float
        At zero tension. [m]

    Returns
    -------
    is_inconsistent : ndarray of bool, shape (n_steps,)
        True beyond five robust standard deviations of all rows and one per cent of
        elongation, the last digit recorded; False where nothing was recorded. [1]

    Raises
    ------
    DataError
        If ``gauge_length`` is not positive.

    Examples
    --------
    1325 in Table 4 of [1]_: 16.38 in is 167 %, recorded is 151 %.

    >>> print(find_inconsistent_readings(
    ...     [17.38, 16.38, 11.68], [1.84, 1.51, 0.91], gauge_length=6.125))
    [False  True False]
    """
    as_positive("gauge_length", gauge_length)
    lengths, printed = as_same_shape(length=length, printed_strain=printed_strain)
    difference = np.abs(lengths / gauge_length - 1 - printed)
    known = difference[np.isfinite(difference)]
    usual = _MAD_TO_DEVIATION * float(np.median(known)) if known.size else 0.0
    return np.nan_to_num(difference) > max(_INCONSISTENT * usual, STRAIN_DIGIT)


def step_branches(tension: ArrayLike) -> Integers:
    """Branch of each step of a stepwise test.

    Parameters
    ----------
    tension : array_like, shape (n_steps,)
        Weights in the order they were hung. [N]

    Returns
    -------
    branch : ndarray of int, shape (n_steps,)
        1 where the weight had been raised, 2 where it had been lowered; a repeated
        weight keeps its branch, and the first step has that of the second. [1]

    Raises
    ------
    DataError
        If the weights never change.

    Examples
    --------
    >>> print(step_branches([51.0, 74.0, 97.0, 97.0, 74.0]))
    [1 1 1 1 2]
    """
    change = np.sign(np.diff(as_finite("tension", tension)))
    moved = np.flatnonzero(change)
    if moved.size == 0:
        raise DataError(
            "the weights of a stepwise test never change",
            found=f"{np.size(tension)} equal weights",
            needed="at least two different weights",
        )
    # last change at or before each interval; before the first one, the first one
    last = np.maximum.accumulate(np.where(change != 0, np.arange(change.size), -1))
    direction = change[np.where(last < 0, moved[0], last)]
    rising = np.concatenate([direction[:1], direction]) > 0
    return np.where(rising, _ASCENDING, _DESCENDING)


def interval_slopes(
    tension: ArrayLike,
    strain: ArrayLike,
    *,
    area: float,
    tension_uncertainty: float = 0.0,
    strain_uncertainty: float = 0.0,
) -> tuple[Floats, Floats, Floats]:
    r"""Modulus between each reading and the next.

    .. math:: E = \frac{\Delta F}{A\,\Delta\varepsilon}

    Parameters
    ----------
    tension : array_like, shape (n_steps,)
        Weight hung. [N]
    strain : array_like, shape (n_steps,)
        Of the gauge length. [1]
    area : float
        At zero tension. [m2]
    tension_uncertainty : float
        Standard uncertainty of one weight. [N]
    strain_uncertainty : float
        Standard uncertainty of one strain, from reading the length. [1]

    Returns
    -------
    interval_strain : ndarray, shape (n_steps - 1,)
        Middle of the interval. [1]
    modulus : ndarray, shape (n_steps - 1,)
        NaN where strain does not change. [Pa]
    standard_uncertainty : ndarray, shape (n_steps - 1,)
        From the readings; not of area or gauge length, which all share. [Pa]

    Raises
    ------
    DataError
        If the series do not pair up or ``area`` is not positive.

    Notes
    -----
    A difference over 15 to 35 points of strain: tape reading is 1 to 3 % of it, so
    that no smoothing is called for, but neighbours share a reading and their
    errors are opposed.  The modulus is that of slow steps with creep in them, 10
    to 45 minutes each in [1]_.  NaN in, NaN out.

    Examples
    --------
    0945 to 0955 in Table 4 of [1]_, on a diameter of 1 in: 87 psi.

    >>> _, modulus, _ = interval_slopes(
    ...     np.array([51, 74]) * 4.4482216, [0.52, 0.858], area=np.pi * 0.0127**2)
    >>> print((modulus / 6894.757).round(0))
    [87.]
    """
    as_positive("area", area)
    force, elongation = as_same_shape(tension=tension, strain=strain)
    stress_step, strain_step = np.diff(force) / area, np.diff(elongation)
    strain_step = np.where(strain_step == 0, np.nan, strain_step)
    modulus = stress_step / strain_step
    uncertainty = sqrt(2) * np.hypot(
        tension_uncertainty / area / strain_step, strain_uncertainty * modulus / strain_step
    )
    return (elongation[:-1] + elongation[1:]) / 2, modulus, uncertainty
