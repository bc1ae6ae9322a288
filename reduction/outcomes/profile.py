r"""Intervals from the profile of a likelihood.

References
----------
.. [1] W. Q. Meeker and L. A. Escobar, Statistical Methods for Reliability Data, Wiley,
   1998, ch. 8.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, log1p

import scipy
from scipy.special import stdtrit

from reduction.errors import DataError

_MOST_DOUBLINGS = 60


def cutoff(confidence: float, *, n_failed: int, n_coefficients: int) -> float:
    r"""Drop of twice the log likelihood at the ends of an interval.

    Parameters
    ----------
    confidence : float
        Of the interval, two-sided. [1]
    n_failed : int
        Values that are not lower bounds. [1]
    n_coefficients : int
        Coefficients beside the scatter. [1]

    Returns
    -------
    drop : float
        NaN unless there are more failures than coefficients. [1]

    Raises
    ------
    DataError
        If the confidence is not between 0 and 1.

    Notes
    -----
    .. math:: d = r \ln\bigl(1 + t^2_{r - p}/(r - p)\bigr)

    With normal scatter and no lower bound this makes the profile interval the exact one
    of Student; with many failures it is the usual chi square.  Chi square alone is too
    short for the three to five specimens of a load level.

    Examples
    --------
    Three failures, then many (chi square: 3.841):

    >>> print(round(cutoff(0.95, n_failed=3, n_coefficients=1), 2))
    6.99
    >>> print(round(cutoff(0.95, n_failed=100_000, n_coefficients=1), 3))
    3.842
    """
    if not 0 < confidence < 1:
        raise DataError(
            "a confidence is not between 0 and 1", found=f"{confidence:g}", needed="0 to 1"
        )
    free = n_failed - n_coefficients
    if free < 1:
        return float("nan")
    quantile = float(stdtrit(free, (1 + confidence) / 2))
    return n_failed * log1p(quantile**2 / free)


def profile_bounds(
    log_likelihood: Callable[[float], float],
    *,
    estimate: float,
    maximum: float,
    step: float,
    drop: float,
) -> tuple[float, float]:
    """Where twice the profile log likelihood has dropped by ``drop``, on both sides.

    Parameters
    ----------
    log_likelihood : callable
        Greatest log likelihood with the quantity held at a value.
    estimate : float
        Where it is greatest of all. [1]
    maximum : float
        Log likelihood there. [1]
    step : float
        A first step outwards, such as the standard uncertainty. [1]
    drop : float
        As `cutoff` gives it. [1]

    Returns
    -------
    low, high : float
        Infinite where the drop is never reached, NaN where ``drop`` is. [1]

    Raises
    ------
    DataError
        If the step is not above zero.

    Examples
    --------
    >>> print(profile_bounds(lambda value: -value**2 / 2, estimate=0.0, maximum=0.0, step=1.0,
    ...                      drop=4.0))
    (-2.0, 2.0)
    """
    if not step > 0:
        raise DataError("a first step is not above zero", found=f"{step:g}", needed="above 0")
    if drop != drop:
        return float("nan"), float("nan")

    def excess(value: float) -> float:
        return 2 * (maximum - log_likelihood(value)) - drop

    def side(sign: int) -> float:
        near, width = estimate, step
        for _ in range(_MOST_DOUBLINGS):
            far = estimate + sign * width
            if excess(far) >= 0:
                return float(
                    scipy.optimize.brentq(excess, near, far, xtol=1e-12 * step, rtol=1e-12)
                )
            near, width = far, 2 * width
        return sign * inf

    return side(-1), side(1)
