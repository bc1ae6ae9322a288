r"""Coded and engineering units, and what a change between them does to a surface.

.. math:: X = \frac{x - (x_{high} + x_{low}) / 2}{(x_{high} - x_{low}) / 2}

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, App. C, eqs. 5 and 5a.
.. [2] R. H. Myers and D. C. Montgomery, Response Surface Methodology, 2nd ed. New York: Wiley,
   2002, example 7.5, p. 347.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import comb

from reduction.checks import as_finite
from reduction.errors import SettingsError
from reduction.record import Floats, Integers


def coded_from_engineering(levels: ArrayLike, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Levels on the scale where the low one is -1 and the high one +1.

    .. math:: X = \frac{x - (x_{high} + x_{low}) / 2}{(x_{high} - x_{low}) / 2}

    Parameters
    ----------
    levels : array_like, shape (..., n_factors)
        Factors in their own units. [SI unit of each factor]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    coded : ndarray, shape (..., n_factors)
        NaN in, NaN out. [1]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    Source: [1]_, App. C.

    Examples
    --------
    Mean loads of the 1/2 in nylon, 768 to 1920 lb:

    >>> print(coded_from_engineering([[768.0], [1344.0], [1920.0]], low=[768.0], high=[1920.0]).T)
    [[-1.  0.  1.]]
    """
    centre, half = _centre_and_half(low, high)
    coded: Floats = (np.asarray(levels, dtype=np.float64) - centre) / half
    return coded


def engineering_from_coded(coded: ArrayLike, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Levels in the units of the factors.

    .. math:: x = (x_{high} + x_{low}) / 2 + X (x_{high} - x_{low}) / 2

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        Coded levels. [1]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    levels : ndarray, shape (..., n_factors)
        NaN in, NaN out. [SI unit of each factor]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    Source: [1]_, App. C.

    Examples
    --------
    >>> print(engineering_from_coded([0.0], low=[0.1], high=[0.5]).round(3))
    [0.3]
    """
    centre, half = _centre_and_half(low, high)
    levels: Floats = centre + np.asarray(coded, dtype=np.float64) * half
    return levels


def engineering_matrix(exponents: Integers, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Matrix that takes the coefficients of coded factors to those of the factors themselves.

    With centre :math:`c` and half range :math:`h` of each factor,

    .. math:: M_{st} = \prod_j \binom{p_{tj}}{p_{sj}} \frac{(-c_j)^{p_{tj} - p_{sj}}}{h_j^{p_{tj}}},
              \qquad b_{eng} = M b_{coded}, \qquad V_{eng} = M V_{coded} M^T

    Parameters
    ----------
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers :math:`p` of the terms, all terms of the quadratic surface. [1]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    matrix : ndarray, shape (n_terms, n_terms)
        Row s is the coefficient of term s in engineering units.
        [1 over the unit of term s, for a coded coefficient in the unit of the response]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    A coefficient in engineering units mixes several coded ones, so that its uncertainty needs
    the whole covariance; the errors of the engineering coefficients are close to dependent.

    Examples
    --------
    Example 7.5 of [2]_, temperature 175 +- 25: 62 + X - 7.375 X^2 is, in degrees,

    >>> matrix = engineering_matrix(np.array([[0], [2], [1]]), low=[150.0], high=[200.0])
    >>> print((matrix @ [62.0, -7.375, 1.0]).round(4))
    [-3.0638e+02 -1.1800e-02  4.1700e+00]
    """
    centre, half = _centre_and_half(low, high)
    of_row, of_column = exponents[:, None, :], exponents[None, :, :]
    step = np.maximum(of_column - of_row, 0)
    # comb is 0 where the power of the row exceeds that of the column
    factor = comb(of_column, of_row) * (-centre) ** step / half**of_column
    product: Floats = np.prod(factor, axis=-1)
    return product


def _centre_and_half(low: ArrayLike, high: ArrayLike) -> tuple[Floats, Floats]:
    bottom, top = as_finite("low", low), as_finite("high", high)
    if bottom.shape != top.shape or bottom.ndim != 1:
        raise SettingsError(
            "the low and high levels do not pair up",
            found=f"shapes {bottom.shape} and {top.shape}",
            needed="one low and one high level a factor",
        )
    wrong = np.flatnonzero(~(top > bottom))
    if wrong.size:
        first = int(wrong[0])
        raise SettingsError(
            f"the high level of factor {first + 1} does not lie above its low one",
            found=f"{bottom[first]:g} and {top[first]:g}",
            needed="low < high",
        )
    return (top + bottom) / 2, (top - bottom) / 2
