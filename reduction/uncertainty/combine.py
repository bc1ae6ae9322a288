r"""Shared and random parts together: combined and expanded uncertainty.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, G.4 (effective degrees of freedom, Welch and Satterthwaite).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from reduction.record import Floats

__all__ = [
    "combined_standard_uncertainty",
    "coverage_factor",
]

CONFIDENCE = 0.95


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


def coverage_factor(
    standard_uncertainty: ArrayLike,
    random: ArrayLike,
    degrees_of_freedom: ArrayLike,
    *,
    confidence: float = CONFIDENCE,
) -> Floats:
    r"""Factor of the expanded uncertainty, by the effective degrees of freedom.

    .. math:: \nu_{eff} = \nu \, (u / u_r)^4

    Parameters
    ----------
    standard_uncertainty : array_like, shape (...)
        Combined. [any]
    random : array_like, shape (...)
        Its random part, known from repeats. [as standard_uncertainty]
    degrees_of_freedom : array_like, shape (...)
        Of the random part. [1]
    confidence : float
        Of the interval. [1]

    Returns
    -------
    factor : ndarray, shape (...)
        k; 1.96 where the shared part, taken as known, is most of it. [1]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Notes
    -----
    [1]_, G.4.1, the shared part with infinitely many degrees of freedom.

    Examples
    --------
    Scatter of ten cycles alone, and beside a shared part of twice its size:

    >>> print(coverage_factor([1.0, np.sqrt(5)], 1.0, 9.0).round(2))
    [2.26 1.97]
    """
    total, part = np.broadcast_arrays(
        np.asarray(standard_uncertainty, dtype=np.float64), np.asarray(random, dtype=np.float64)
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(part > 0, total / part, np.inf)
        effective = np.minimum(np.asarray(degrees_of_freedom) * ratio**4, 1e9)
    return np.asarray(stats.t.ppf((1 + confidence) / 2, effective))
