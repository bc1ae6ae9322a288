r"""Shared and random parts together: combined and expanded uncertainty.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, G.4 (effective degrees of freedom, Welch and Satterthwaite).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.record import Floats

CONFIDENCE = 0.95
_FEWEST, _MANY = 1.0, 1e9
"""Degrees of freedom below which none are counted, and above which Student's is the normal."""


def combined_standard_uncertainty(contribution: ArrayLike, random: ArrayLike) -> Floats:
    """Root of the sum of the squares of all contributions and of the random part.

    Parameters
    ----------
    contribution : array_like, shape (n_components, ...)
        Signed. [any]
    random : array_like, shape (...)
        Type A of the number itself. [as contribution]

    Returns
    -------
    standard_uncertainty : ndarray, shape (...)
        NaN where the random part is NaN. [as contribution]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Examples
    --------
    >>> print(combined_standard_uncertainty([[3.0], [0.0]], [4.0]))
    [5.]
    """
    rows = np.asarray(contribution, dtype=np.float64)
    return np.asarray(np.sqrt(np.sum(rows**2, axis=0) + np.asarray(random) ** 2))


def effective_degrees_of_freedom(
    random: ArrayLike,
    degrees_of_freedom: ArrayLike,
    *,
    contribution: ArrayLike | None = None,
    of_contribution: ArrayLike = np.inf,
) -> Floats:
    r"""Degrees of freedom of a combined uncertainty, by those of its parts.

    .. math:: \nu_{eff} = \frac{u^4}{u_r^4 / \nu_r + \sum_k c_k^4 / \nu_k}

    Parameters
    ----------
    random : array_like, shape (...)
        Random part. [any]
    degrees_of_freedom : array_like, shape (...)
        Of the random part: those of the cycles, samples or readings that it is from. [1]
    contribution : array_like, shape (n_components, ...), optional
        Of shared errors; what is not a number counts as none. [as random]
    of_contribution : array_like, shape (n_components,) or of the contributions, optional
        Degrees of freedom of each of them; infinite where it is stated. [1]

    Returns
    -------
    effective : ndarray, shape (...)
        Infinite where nothing that is known from few readings adds to it; NaN where the random part
        is NaN. [1]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Notes
    -----
    Welch and Satterthwaite, [1]_, G.4.1, eq. G.2b.

    Examples
    --------
    Scatter of ten cycles alone, and beside a stated error of twice its size; the same beside a
    diameter of three readings:

    >>> print(effective_degrees_of_freedom(1.0, 9.0))
    9.0
    >>> for freedom in (np.inf, 2.0):
    ...     print(effective_degrees_of_freedom(
    ...         1.0, 9.0, contribution=[2.0], of_contribution=[freedom]).round(1))
    225.0
    3.1
    """
    part = np.asarray(random, dtype=np.float64)
    rows = np.zeros((0, *part.shape)) if contribution is None else np.nan_to_num(contribution)
    freedom = np.asarray(of_contribution, dtype=np.float64)
    if freedom.ndim == 1:
        freedom = freedom.reshape(-1, *(1,) * (rows.ndim - 1))
    total = part**2 + np.sum(rows**2, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        # shares of the variance: fourth powers of small numbers are no numbers
        own, shared = part**2 / total, rows**2 / total
        few = own**2 / np.asarray(degrees_of_freedom) + np.sum(shared**2 / freedom, axis=0)
        effective = np.where(total > 0, 1 / few, np.inf)
    return np.asarray(np.where(np.isnan(part), np.nan, effective))


def coverage_factor(degrees_of_freedom: ArrayLike, *, confidence: float = CONFIDENCE) -> Floats:
    """Factor of the expanded uncertainty.

    Parameters
    ----------
    degrees_of_freedom : array_like, shape (...)
        Effective ones; below 1 counts as 1. [1]
    confidence : float
        Of the interval. [1]

    Returns
    -------
    factor : ndarray, shape (...)
        k; 1.96 where what is taken as known is most of it. [1]

    Raises
    ------
    ValueError
        Never by itself.

    Notes
    -----
    Student's, [1]_, G.3.

    Examples
    --------
    Ten cycles, three readings, and what is stated:

    >>> print(coverage_factor([9.0, 2.0, np.inf]).round(2))
    [2.26 4.3  1.96]
    """
    freedom = np.asarray(degrees_of_freedom, dtype=np.float64)
    bounded = np.clip(freedom, _FEWEST, _MANY)
    return np.asarray(stdtrit(bounded, (1 + confidence) / 2))
