r"""A quadratic surface at points, with its intervals, in one pass over blocks of points.

.. math:: \hat y = x^T b, \qquad
          \hat y \pm t_{\nu_{eff}} \sqrt{s^2 (1 + h) + \textstyle\sum_k (x^T c_k)^2}, \qquad
          h = x^T C x

with the contribution c_k of each error that the runs share, and the degrees of freedom of Welch and
Satterthwaite; of the surface itself with h in place of 1 + h.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.2, G.4.1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.lookup.linesurface import LineSurface
from reduction.record import Bools, Floats, read_only_arrays
from reduction.surface.coding import coded_from_engineering
from reduction.surface.designs import box_behnken
from reduction.surface.terms import model_matrix, quadratic_exponents
from reduction.surface.tested import is_within_levels
from reduction.surface.transform import back_transform, back_transformed_change
from reduction.surface.variance import variance_factor
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.workers import run_blocks

_BLOCK = 16_384


@dataclass(frozen=True)
@read_only_arrays
class SurfacePoints:
    """A surface at points; arrays have the shape (n_points,).

    ``low`` and ``high`` hold one more run there with 95 %, ``surface_low`` and
    ``surface_high`` the surface itself; NaN where sigma is not known. [unit of the quantity]
    ``contribution``, of shape (n_components, n_points), is what each error that the runs share adds
    to the value; ``random`` and ``run_random`` are one standard uncertainty of what is of the
    surface alone, and of one more run beside that. [unit of the quantity]
    """

    value: Floats
    low: Floats
    high: Floats
    surface_low: Floats
    surface_high: Floats
    leverage: Floats
    contribution: Floats
    random: Floats
    run_random: Floats
    is_inside: Bools


def evaluate_surface(surface: LineSurface, points: ArrayLike) -> SurfacePoints:
    """Value of a surface at points, with two intervals.

    Parameters
    ----------
    surface : LineSurface
        One quantity.
    points : array_like, shape (n_points, n_factors)
        [SI unit of each factor]

    Returns
    -------
    points : SurfacePoints
        Outside the levels too, and flagged there.

    Raises
    ------
    DataError
        If a point is not finite, or has another number of factors.

    Notes
    -----
    Source: [1]_, eq. 5 with the coding of App. C.  A transformed quantity is brought back: value
    and intervals are of its median.  The factor of an interval is that of [2]_, as of every other
    number.

    Examples
    --------
    The centre of a surface is its first coefficient:

    >>> exponents = quadratic_exponents(3)
    >>> surface = LineSurface(
    ...     "apparent_spring_constant", np.array([3.451, *[0.0] * 9]), exponents,
    ...     np.array([0.1, 768, 320]), np.array([0.5, 1920, 768]), np.eye(10) / 3, 0.1, 5, 0.75,
    ... )
    >>> print(evaluate_surface(surface, [[0.3, 1344, 544]]).value)
    [3.451]
    """
    given = np.asarray(points, dtype=np.float64)
    if given.ndim != 2 or given.shape[1] != surface.low.size:
        raise DataError(
            "the points do not pair up with the factors of the surface",
            found=f"shape {given.shape}", needed=f"(n_points, {surface.low.size})",
        )  # fmt: skip
    size = given.shape[0]
    names = ("value", "low", "high", "surface_low", "surface_high", "leverage", "random",
             "run_random")  # fmt: skip
    out = {name: np.empty(size) for name in names}
    moved = np.empty((surface.contribution.shape[0], size))
    inside = np.empty(size, dtype=bool)
    sigma = surface.sigma if surface.degrees_of_freedom > 0 else float("nan")
    few = np.array([one.degrees_of_freedom for one in surface.component])
    # a level in round shares of a strength may lie beyond the one that is printed in whole units
    rounded = surface.rounding if surface.rounding.size else np.zeros(surface.low.size)
    allowed = 2 * rounded / (surface.high - surface.low)

    def half_of(random: Floats, rows: Floats) -> Floats:
        """Half width of a 95 % interval."""
        if not rows.size:
            return coverage_factor(surface.degrees_of_freedom) * random
        effective = effective_degrees_of_freedom(
            random, surface.degrees_of_freedom, contribution=rows, of_contribution=few
        )
        return coverage_factor(effective) * combined_standard_uncertainty(rows, random)

    def fill(block: slice) -> None:
        coded = coded_from_engineering(given[block], low=surface.low, high=surface.high)
        terms = model_matrix(coded, surface.exponents)
        leverage = variance_factor(terms, surface.covariance_factor)
        centre = terms @ surface.coefficient
        # one error of all runs moves the whole surface, and the next run with it
        rows = surface.contribution @ terms.T if surface.component else np.empty((0, centre.size))
        random, run_random = sigma * np.sqrt(leverage), sigma * np.sqrt(1 + leverage)
        half, own = half_of(run_random, rows), half_of(random, rows)
        for name, values in (
            ("value", centre),
            ("low", centre - half),
            ("high", centre + half),
            ("surface_low", centre - own),
            ("surface_high", centre + own),
            ("leverage", leverage),
            ("random", random),
            ("run_random", run_random),
        ):
            out[name][block] = values
        moved[:, block] = rows
        inside[block] = is_within_levels(coded, allowed=allowed)

    run_blocks(fill, [slice(start, start + _BLOCK) for start in range(0, size, _BLOCK)])
    if surface.exponent != 1:
        # of one standard uncertainty to either side
        scaled = out["value"]
        moved = back_transformed_change(scaled, moved, surface.exponent)
        for name in ("random", "run_random"):
            out[name] = back_transformed_change(scaled, out[name], surface.exponent)
        for name in ("value", "low", "high", "surface_low", "surface_high"):
            out[name] = back_transform(out[name], surface.exponent)
    return SurfacePoints(**out, contribution=moved, is_inside=inside)


def sigma_from_r2(coefficient: ArrayLike, r2: float, *, n_factors: int = 3) -> float:
    r"""Scatter of a run about a surface of which only coefficients and r2 are printed.

    .. math:: s^2 = \frac{(1 - r^2)}{r^2 \, \nu} \sum_i (\hat y_i - \bar{\hat y})^2

    Parameters
    ----------
    coefficient : array_like, shape (n_terms,)
        Coded, in printed order, of a Box-Behnken design. [unit of the quantity]
    r2 : float
        As printed. [1]
    n_factors : int
        Of the design.

    Returns
    -------
    sigma : float
        With the residual degrees of freedom of the design, 5 of fifteen runs; NaN where
        r2 is not between 0 and 1. [unit of the quantity]

    Raises
    ------
    DataError
        If there are not as many coefficients as the quadratic has terms.

    Notes
    -----
    Least squares with a mean leaves the mean of the fitted values that of the runs, so that the
    explained sum of squares follows from the design, which [1]_ states, and the coefficients.  The
    rounding of r2 moves it: 0.985 stands for 0.9845 to 0.9855, sigma for +-1.7 %.

    Examples
    --------
    A slope of 1 alone explains 8 of fifteen runs; with r2 = 0.5 as much is left, over 5:

    >>> round(sigma_from_r2([0, 0, 0, 0, 1, 0, 0, 0, 0, 0], 0.5) ** 2, 12)
    1.6
    """
    values = np.asarray(coefficient, dtype=np.float64)
    exponents = quadratic_exponents(n_factors)
    if values.shape != (len(exponents),):
        raise DataError(
            "the coefficients are not those of a quadratic", found=str(values.shape),
            needed=f"({len(exponents)},)",
        )  # fmt: skip
    if not 0 < r2 < 1:
        return float("nan")
    coded = box_behnken(n_factors).coded
    fitted = model_matrix(coded, exponents) @ values
    explained = float(np.sum((fitted - fitted.mean()) ** 2))
    freedom = len(coded) - len(exponents)
    return float(np.sqrt(explained * (1 - r2) / r2 / freedom))
