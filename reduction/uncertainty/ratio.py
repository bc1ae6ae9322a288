r"""What shared errors do to the ratio of two moduli, and the interval that it then has.

.. math:: \delta r = r \left(c_1 / E_1 - c_2 / E_2\right)

One load cell, or one crosshead, is in both moduli and cancels as far as it does the same to both.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.2 and G.4.1.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.6.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.moduli.product import Ratio
from reduction.record import Floats
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)

_BOTH = (
    "the interval holds what differs from cycle to cycle (type A), and errors of instruments, "
    "diameters and splice strain as far as the two do not share them"
)


def ratio_contributions(
    ratio: ArrayLike,
    *,
    numerator: ArrayLike,
    of_numerator: ArrayLike,
    denominator: ArrayLike,
    of_denominator: ArrayLike,
) -> Floats:
    """Contributions to a ratio.

    Parameters
    ----------
    ratio : array_like, shape (...)
        [1]
    numerator, denominator : array_like, shape (...)
        [any]
    of_numerator, of_denominator : array_like, shape (n_components, ...)
        Contributions to them, of the same components. [as numerator]

    Returns
    -------
    contribution : ndarray, shape (n_components, ...)
        [1]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Notes
    -----
    First order ([1]_, 5.2.2).

    Examples
    --------
    The gain of one cell leaves the ratio as it is; two diameters do not cancel.

    >>> print(ratio_contributions(2.0, numerator=4.0, of_numerator=[0.04, 0.08, 0.0],
    ...     denominator=2.0, of_denominator=[0.02, 0.0, 0.04]))
    [ 0.    0.04 -0.04]
    """
    value = np.asarray(ratio, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        above = np.asarray(of_numerator, dtype=np.float64) / np.asarray(numerator)
        below = np.asarray(of_denominator, dtype=np.float64) / np.asarray(denominator)
    return np.asarray(value * (above - below))


def with_shared_interval(
    ratio: Ratio, contribution: ArrayLike, *, of_contribution: ArrayLike = np.inf
) -> Ratio:
    """Ratio with the interval of both parts; its standard uncertainty stays the random one.

    Parameters
    ----------
    ratio : Ratio
        With its interval of type A. [1]
    contribution : array_like, shape (n_components, 2, n_bins)
        Of shared errors. [1]
    of_contribution : array_like, shape (n_components,), optional
        Degrees of freedom of each; infinite where it is stated. [1]

    Returns
    -------
    ratio : Ratio
        Wider where something is not shared; ``is_different`` follows. [1]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Notes
    -----
    Source: [2]_ compares new and used tethers; factor by effective degrees of freedom ([1]_).

    Examples
    --------
    10 % more by cycles that are known to 1 %; diameters known to 10 % leave nothing of it.

    >>> one = np.ones((2, 1))
    >>> found = Ratio("used", "new", np.array([1.0]), 1.1 * one, 0.01 * one, 1.08 * one,
    ...     1.12 * one, one > 0)
    >>> wider = with_shared_interval(found, [0.1 * one])
    >>> print(wider.ratio_low[0].round(3), wider.is_different[0])
    [0.903] [False]
    """
    random = ratio.ratio_standard_uncertainty
    total = combined_standard_uncertainty(np.nan_to_num(contribution), random)
    freedom = effective_degrees_of_freedom(
        random, ratio.degrees_of_freedom, contribution=contribution, of_contribution=of_contribution
    )
    reach = total * coverage_factor(freedom)
    low, high = ratio.ratio - reach, ratio.ratio + reach
    return replace(
        ratio,
        ratio_low=low,
        ratio_high=high,
        is_different=(low > 1) | (high < 1),
        notes=(_BOTH, *ratio.notes[1:]),
    )
