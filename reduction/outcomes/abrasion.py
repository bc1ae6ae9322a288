r"""Cycles to wear through: how much longer a jacket, a material or a construction lasts.

Mean, deviation and relative variability of a group are those of `strength.group_statistics`,
ratios of two groups those of `compare.ratio_of_means` (means) and `life.ratio_of_lives`
(medians, where every life is known).

References
----------
.. [1] CG-D-39-80, section 6.2.2 and Table 20.
.. [2] G. Y. Zou and A. Donner, "Construction of Confidence Limits about Effect Measures: A
   General Approach," Stat. Med., vol. 27, no. 10, pp. 1693-1702, 2008.
"""

from __future__ import annotations

from math import exp, log, log1p, sqrt

from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.errors import DataError
from reduction.outcomes.life import fit_life


def ratio_to_published_life(
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    *,
    reference_mean: float,
    reference_standard_deviation: float,
    reference_n: int,
    confidence: float = 0.95,
) -> tuple[float, float, float]:
    r"""Median life over that of a group of which only mean, deviation and number are printed.

    Parameters
    ----------
    cycles : array_like, shape (n,)
        To failure, or to the end of a test that was stopped. [1]
    is_suspended : array_like of bool, shape (n,)
        True for a suspended test. [1]
    reference_mean, reference_standard_deviation : float
        Cycles of the reference group. [1]
    reference_n : int
        Its specimens. [1]
    confidence : float
        Of the bounds, two-sided. [1]

    Returns
    -------
    ratio, low, high : float
        Of the medians, both lives lognormal; NaN with fewer than two failures. [1]

    Raises
    ------
    DataError
        If a number of the reference is not above zero, or it is of one specimen.

    Notes
    -----
    The reference has :math:`s_{\ln}^2 = \ln(1 + s^2/m^2)` and the median
    :math:`m \exp(-s_{\ln}^2/2)`.  The bounds of the two medians, the profile's and Student's, are
    put together as in [2]_.  In [1]_ the tests of jacketed line were stopped after 13
    samples since lives rose from test to test, three lives are printed, and the ratio
    of "5 to 6" is that of these three to the mode: a ratio to the first, shortest lives.

    Examples
    --------
    The three printed lives over those of 38 samples without a jacket:

    >>> ratio, low, high = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3,
    ...     reference_mean=8134, reference_standard_deviation=1963, reference_n=38)
    >>> print(round(ratio, 2), round(low, 1), round(high, 1))
    4.54 2.8 7.3
    """
    numbers = (reference_mean, reference_standard_deviation, reference_n - 1)
    if not all(number > 0 for number in numbers):
        raise DataError(
            "a reference life cannot be used",
            found=f"mean {reference_mean:g}, deviation {reference_standard_deviation:g}, "
            f"n {reference_n}",
            needed="mean and deviation above zero, n of 2 or more",
        )
    fit = fit_life(cycles, is_suspended, distribution="lognormal", confidence=confidence)
    spread = log1p((reference_standard_deviation / reference_mean) ** 2)
    reference = log(reference_mean) - spread / 2
    half = float(stdtrit(reference_n - 1, (1 + confidence) / 2)) * sqrt(spread / reference_n)
    if not fit.life > 0:
        return float("nan"), float("nan"), float("nan")
    own = log(fit.life)
    below = sqrt((own - log(fit.low)) ** 2 + half**2)
    above = sqrt((log(fit.high) - own) ** 2 + half**2)
    return exp(own - reference), exp(own - reference - below), exp(own - reference + above)
