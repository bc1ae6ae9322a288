r"""Cubic of strain against tension: its slope, where it rises, and the cubic of K_0.

.. math:: \varepsilon = A + B T + C T^2 + D T^3, \qquad K_0 = 1 / (B + 2 C T + 3 D T^2)

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2, 4.4.3, Tables 6-9.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def slope_of_cubic(tension: ArrayLike, coefficient: ArrayLike) -> Floats:
    r"""Quasi-static spring constant of a load-strain cubic.

    .. math:: K_0 = 1 / (B + 2 C T + 3 D T^2)

    Parameters
    ----------
    tension : array_like, shape (...)
        :math:`T`. [N]
    coefficient : array_like, shape (4,)
        A, B, C, D of strain = A + B T + C T^2 + D T^3. [N-k]

    Returns
    -------
    quasi_static_spring_constant : ndarray, shape (...)
        NaN where the slope of strain is not positive. [N]

    Raises
    ------
    DataError
        If there are not four coefficients.

    Notes
    -----
    Source: [1]_, sec. 4.4.2, and Tables 8 and 9 for the cubic.

    Examples
    --------
    Nylon double braid, 1/2 in, Table 8 of [1]_, at the mean loads of Table 1, in 1e4 lb:

    >>> slope = slope_of_cubic([768.0, 1344.0, 1920.0], [-4.13e-4, 1.389e-4, -3.906e-8, 3.795e-12])
    >>> print((slope / 1e4).round(3))
    [1.168 1.836 3.238]
    """
    load, terms = np.asarray(tension, dtype=np.float64), np.asarray(coefficient, dtype=np.float64)
    if terms.shape != (4,):
        raise DataError("a cubic has four coefficients", found=str(terms.shape), needed="(4,)")
    slope = terms[1] + load * (2 * terms[2] + load * 3 * terms[3])
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse: Floats = np.where(slope > 0, 1 / slope, np.nan)
    return inverse


def positive_range(coefficient: Floats) -> tuple[float, float]:
    """Longest part of -1 to 1 in which the slope of a cubic of u is positive.

    Parameters
    ----------
    coefficient : ndarray, shape (4,)
        Of 1, u, u^2, u^3. [1]

    Returns
    -------
    low, high : float
        Both 0 where the slope is positive nowhere. [1]

    Raises
    ------
    IndexError
        If there are fewer than four coefficients.

    Notes
    -----
    A slope that is not positive has no quasi-static spring constant ([1]_, sec. 4.4.2).

    Examples
    --------
    >>> positive_range(np.array([0.0, 0.5, -0.5, 0.0]))
    (-1.0, 0.5)
    """
    roots = np.roots(coefficient[:0:-1] * np.array([3, 2, 1]))
    inside = sorted(float(root.real) for root in roots if root.imag == 0 and -1 < root.real < 1)
    edges = [-1.0, *inside, 1.0]
    best = (0.0, 0.0)
    for low, high in pairwise(edges):
        middle = (low + high) / 2
        slope = coefficient[1] + middle * (2 * coefficient[2] + middle * 3 * coefficient[3])
        if slope > 0 and high - low > best[1] - best[0]:
            best = (low, high)
    return best


def printed_form(
    coefficient: Floats, *, low: float, high: float, centre: float, half: float
) -> tuple[Floats, float]:
    r"""K_0 as a cubic of tension, by least squares to the slope of a cubic of strain.

    .. math:: K_0 \approx A + B T + C T^2 + D T^3

    Parameters
    ----------
    coefficient : ndarray, shape (4,)
        Of strain, in powers of u = (T - centre)/half. [1]
    low, high : float
        Range of tension to fit. [N]
    centre, half : float
        Scale of u. [N]

    Returns
    -------
    polynomial : ndarray, shape (4,)
        A, B, C, D. [N N-k]
    deviation : float
        Greatest distance from the slope, as a share of it. [1]

    Raises
    ------
    ValueError
        If the slope is positive nowhere in the range.

    Notes
    -----
    The form of Table 7 of [1]_.  Shares of K_0 count alike, since it spans a factor of
    several over the range.

    Examples
    --------
    >>> fit, deviation = printed_form(
    ...     np.array([0.0, 0.025, 0.0, 0.0]), low=0.0, high=2000.0, centre=1000.0, half=1000.0)
    >>> print(fit.round(3) + 0.0, round(deviation, 9))
    [40000. 0. 0. 0.] 0.0
    """
    load = np.linspace(low, high, 201)
    scaled = (load - centre) / half
    # an end of the range where the slope is just positive would rule the fit alone
    slope = coefficient[1] + scaled * (2 * coefficient[2] + scaled * 3 * coefficient[3])
    kept = slope > 0
    exact = half / slope[kept]
    powers = scaled[kept, None] ** np.arange(4)
    fit, *_ = np.linalg.lstsq(powers / exact[:, None], np.ones(exact.size), rcond=None)
    deviation = float(np.max(np.abs(powers @ fit / exact - 1)))
    series = np.polynomial.Polynomial(fit, domain=[centre - half, centre + half])
    printed = np.zeros(4)
    converted = series.convert().coef
    printed[: converted.size] = converted
    return printed, deviation
