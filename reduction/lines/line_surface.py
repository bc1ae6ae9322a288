r"""Values and intervals of a quadratic surface at points, computed in blocks of points.

.. math:: \hat y = x^T b, \qquad
          \hat y \pm t_{\nu_{eff}} \sqrt{s^2 (1 + h) + \textstyle\sum_k (x^T c_k)^2}, \qquad
          h = x^T C x

with the contribution c_k of each error that the runs share, and Welch-Satterthwaite degrees of
freedom; for the surface itself with h in place of 1 + h.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 5.2.2, G.4.1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import coded_from_engineering, model_matrix
from reduction.experiments.response_transform import back_transform, back_transformed_change
from reduction.experiments.run_sheet import variance_factor
from reduction.experiments.surface_discrepancy import discrepancy_at
from reduction.experiments.surface_points import is_within_levels
from reduction.lines.lookup_product import LineSurface
from reduction.record.arrays import run_blocks
from reduction.record.contributions import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, read_only_arrays

_BLOCK = 16_384


@dataclass(frozen=True)
@read_only_arrays
class SurfacePoints:
    """A surface at points; arrays have the shape (n_points,).

    ``low`` and ``high`` are the 95 % interval of one more run there, ``surface_low`` and
    ``surface_high`` that of the surface itself; NaN where sigma is not known. [unit of the
    quantity]  ``contribution``, shape (n_components, n_points), holds the signed contribution of
    each shared error of the runs to the value; ``random`` and ``run_random`` are the standard
    uncertainties of the surface alone and of one more run, without the shared part. [unit of the
    quantity]  ``random_freedom`` are the degrees of freedom of the first. [1]
    """

    value: Floats
    low: Floats
    high: Floats
    surface_low: Floats
    surface_high: Floats
    leverage: Floats
    contribution: Floats
    random: Floats
    random_freedom: Floats
    run_random: Floats
    is_inside: Bools


def evaluate_surface(surface: LineSurface, points: ArrayLike) -> SurfacePoints:
    """Value of a surface at points, with two intervals.

    Notes
    -----
    Source: [1]_, eq. 5 with the coding of App. C.  A transformed quantity is transformed back:
    value and intervals are those of its median.  The factor of an interval is that of [2]_, as for
    every other number.

    Examples
    --------
    The value at the centre of a surface is its first coefficient:

    >>> from reduction.experiments.designs import quadratic_exponents
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
             "random_freedom", "run_random")  # fmt: skip
    out = {name: np.empty(size) for name in names}
    moved = np.empty((surface.contribution.shape[0], size))
    inside = np.empty(size, dtype=bool)
    sigma = surface.sigma if surface.degrees_of_freedom > 0 else float("nan")
    few = np.array([one.degrees_of_freedom for one in surface.component])
    # a level in round shares of a strength may lie beyond the one printed in whole units
    rounded = surface.rounding if surface.rounding.size else np.zeros(surface.low.size)
    allowed = 2 * rounded / (surface.high - surface.low)

    def with_missed(scatter: Floats, missed: Floats) -> tuple[Floats, Floats]:
        """Scatter including the lack of fit of a quadratic, and the degrees of freedom of both."""
        freedom = effective_degrees_of_freedom(
            scatter,
            surface.degrees_of_freedom,
            contribution=missed[None],
            of_contribution=[surface.discrepancy_degrees_of_freedom],
        )
        return np.hypot(scatter, missed), freedom

    def half_of(random: Floats, freedom: Floats, rows: Floats) -> Floats:
        """Half width of a 95 % interval."""
        if not rows.size:
            return coverage_factor(freedom) * random
        effective = effective_degrees_of_freedom(
            random, freedom, contribution=rows, of_contribution=few
        )
        return coverage_factor(effective) * combined_standard_uncertainty(rows, random)

    def fill(block: slice) -> None:
        coded = coded_from_engineering(given[block], low=surface.low, high=surface.high)
        terms = model_matrix(coded, surface.exponents)
        leverage = variance_factor(terms, surface.covariance_factor)
        centre = terms @ surface.coefficient
        # one error of all runs moves the whole surface, and the next run with it
        rows = surface.contribution @ terms.T if surface.component else np.empty((0, centre.size))
        missed = np.zeros(centre.size)
        if surface.discrepancy.size:
            more = model_matrix(coded, surface.discrepancy_exponents)
            missed = discrepancy_at(more, surface.discrepancy)
        random, freedom = with_missed(sigma * np.sqrt(leverage), missed)
        run_random, run_freedom = with_missed(sigma * np.sqrt(1 + leverage), missed)
        half, own = half_of(run_random, run_freedom, rows), half_of(random, freedom, rows)
        for name, values in (
            ("value", centre),
            ("low", centre - half),
            ("high", centre + half),
            ("surface_low", centre - own),
            ("surface_high", centre + own),
            ("leverage", leverage),
            ("random", random),
            ("random_freedom", freedom),
            ("run_random", run_random),
        ):
            out[name][block] = values
        moved[:, block] = rows
        inside[block] = is_within_levels(coded, allowed=allowed)

    run_blocks(fill, [slice(start, start + _BLOCK) for start in range(0, size, _BLOCK)])
    if surface.exponent != 1:
        # one standard uncertainty to either side
        scaled = out["value"]
        moved = back_transformed_change(scaled, moved, surface.exponent)
        for name in ("random", "run_random"):
            out[name] = back_transformed_change(scaled, out[name], surface.exponent)
        for name in ("value", "low", "high", "surface_low", "surface_high"):
            out[name] = back_transform(out[name], surface.exponent)
    if surface.frequency_column is not None:
        frequency = given[:, surface.frequency_column]
        moved = moved / frequency
        for name in ("value", "low", "high", "surface_low", "surface_high", "random", "run_random"):
            out[name] = out[name] / frequency
    return SurfacePoints(**out, contribution=moved, is_inside=inside)
