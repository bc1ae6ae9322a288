r"""Terms of the quadratic surface in the printed order, and the matrices that stand on them.

For the factors :math:`X_1 .. X_k` in coded units,

.. math::

    y = B_1 + \sum_j B_{1+j} X_j^2 + \sum_j B_{1+k+j} X_j
        + \sum_{i<j} B_{..} X_i X_j

With frequency, mean tension and tension amplitude that is B1..B10 of [1]_, eq. 5: the mean,
the squares, the linear terms, then f Tm, f dT and Tm dT.  The squares stand before the linear
terms; other programs print them last.  As printed, eq. 5a sets the physical factors beside the
coefficients of the coded ones; as computed, a coefficient belongs to the units it was found in.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, Tables 3-5 and 11-19.
.. [2] G. E. P. Box and D. W. Behnken, "Some New Three Level Designs for the Study of
   Quantitative Variables," Technometrics, vol. 2, no. 4, pp. 455-475, 1960.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.errors import DataError, SettingsError
from reduction.record import Floats, Integers


def quadratic_exponents(n_factors: int) -> Integers:
    """Powers of each factor in each term of the quadratic surface, in printed order.

    Parameters
    ----------
    n_factors : int
        One or more.

    Returns
    -------
    exponents : ndarray of int, shape (n_terms, n_factors)
        Mean, squares, linear terms, interactions (1, 2), (1, 3), .. (2, 3) .. [1]

    Raises
    ------
    SettingsError
        If there is no factor.

    Notes
    -----
    Source: [1]_, eq. 5.  There are (k + 1)(k + 2) / 2 terms.

    Examples
    --------
    >>> print(quadratic_exponents(2).tolist())
    [[0, 0], [2, 0], [0, 2], [1, 0], [0, 1], [1, 1]]
    """
    if n_factors < 1:
        raise SettingsError("a surface has no factor", found=f"{n_factors}", needed="one or more")
    unit = np.eye(n_factors, dtype=np.int64)
    pairs = [unit[first] + unit[second] for first, second in combinations(range(n_factors), 2)]
    return np.vstack([np.zeros_like(unit[:1]), 2 * unit, unit, *pairs])


def term_kinds(exponents: Integers) -> tuple[str, ...]:
    """Kind of each term: mean, square, linear or interaction.

    Parameters
    ----------
    exponents : ndarray of int, shape (n_terms, n_factors)
        As `quadratic_exponents` gives them. [1]

    Returns
    -------
    kinds : tuple of str, length n_terms
        ``mean``, ``square``, ``linear`` or ``interaction``.

    Raises
    ------
    SettingsError
        If a term is of third or higher order.

    Examples
    --------
    >>> term_kinds(quadratic_exponents(2))
    ('mean', 'square', 'square', 'linear', 'linear', 'interaction')
    """
    kinds = {(0, 0): "mean", (1, 1): "linear", (2, 2): "square", (2, 1): "interaction"}
    found = [(int(row.sum()), int(row.max())) for row in exponents]
    strange = [shape for shape in found if shape not in kinds]
    if strange:
        raise SettingsError(
            "a term is above second order", found=f"order {strange[0][0]}", needed="0, 1 or 2"
        )
    return tuple(kinds[shape] for shape in found)


def term_names(exponents: Integers, factor_names: Sequence[str]) -> tuple[str, ...]:
    """Names of the terms, made of the names of the factors.

    Parameters
    ----------
    exponents : ndarray of int, shape (n_terms, n_factors)
        As `quadratic_exponents` gives them. [1]
    factor_names : sequence of str, length n_factors
        In the order of the columns.

    Returns
    -------
    names : tuple of str, length n_terms
        ``mean``, ``f^2``, ``f``, ``f*T``.

    Raises
    ------
    SettingsError
        If the names do not pair up with the factors, or one stands twice.

    Examples
    --------
    >>> term_names(quadratic_exponents(2), ["frequency", "mean_tension"])[1:]
    ('frequency^2', 'mean_tension^2', 'frequency', 'mean_tension', 'frequency*mean_tension')
    """
    if len(factor_names) != exponents.shape[1] or len(set(factor_names)) != len(factor_names):
        raise SettingsError(
            "the names do not pair up with the factors",
            found=", ".join(factor_names) or "no name",
            needed=f"{exponents.shape[1]} different names",
        )
    return tuple(
        "*".join(
            name if power == 1 else f"{name}^{power}"
            for name, power in zip(factor_names, row, strict=True)
            if power
        )
        or "mean"
        for row in exponents
    )


def model_matrix(coded: ArrayLike, exponents: Integers) -> Floats:
    r"""Value of each term at each point.

    .. math:: x_{it} = \prod_j X_{ij}^{p_{tj}}

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        Points, in the units the coefficients belong to. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers :math:`p`. [1]

    Returns
    -------
    matrix : ndarray, shape (..., n_terms)
        One row a point. [1]

    Raises
    ------
    DataError
        If a point is not finite, or has another number of factors.

    Examples
    --------
    The corner (1, -1) of a square:

    >>> print(model_matrix([1.0, -1.0], quadratic_exponents(2)))
    [ 1.  1.  1.  1. -1. -1.]
    """
    points = _points(coded, exponents)
    matrix = np.ones((*points.shape[:-1], len(exponents)))
    for term, powers in enumerate(exponents):
        for factor in np.repeat(np.arange(powers.size), powers):
            matrix[..., term] *= points[..., factor]
    return matrix


def gradient_matrix(coded: ArrayLike, exponents: Integers) -> Floats:
    r"""Derivative of each term by each factor at each point.

    .. math:: d_{ijt} = \partial x_{it} / \partial X_{ij}

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        Points, in the units the coefficients belong to. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers. [1]

    Returns
    -------
    matrix : ndarray, shape (..., n_factors, n_terms)
        Times the coefficients it is the slope of the surface. [1]

    Raises
    ------
    DataError
        If a point is not finite, or has another number of factors.

    Examples
    --------
    Of 1, X^2 and X at X = 3:

    >>> print(gradient_matrix([3.0], quadratic_exponents(1)))
    [[0. 6. 1.]]
    """
    points = _points(coded, exponents)
    slopes = []
    for power, step in zip(exponents.T, np.eye(exponents.shape[1], dtype=np.int64), strict=True):
        lowered = np.maximum(exponents - step, 0)
        slopes.append(power * model_matrix(points, lowered))
    return np.stack(slopes, axis=-2)


def _points(coded: ArrayLike, exponents: Integers) -> Floats:
    points = as_finite("the levels", coded)
    if points.ndim == 0 or points.shape[-1] != exponents.shape[1]:
        raise DataError(
            "the points do not have the factors of the surface",
            found=f"shape {points.shape}",
            needed=f"{exponents.shape[1]} levels a point",
        )
    return points
