"""Coefficients in printed order, and what they are judged by: residuals, or blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record import Floats, Integers
from reduction.surface.blocks import fit_random_intercept
from reduction.surface.coding import engineering_matrix
from reduction.surface.leastsquares import LeastSquares
from reduction.surface.parts import BlockEffects
from reduction.surface.variance import variance_factor


@dataclass(frozen=True)
class Estimates:
    """Coefficients in printed order and what they are judged by."""

    coefficient: Floats
    covariance_factor: Floats
    pattern: Integers
    sigma: Floats
    degrees_of_freedom: Floats
    error_term: tuple[str, ...]


def fixed_estimates(fit: LeastSquares, column: Integers) -> Estimates:
    """Least squares in printed order."""
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)
    return Estimates(
        fit.coefficient[:, column],
        fit.covariance_factor[:, column[:, None], column],
        fit.pattern,
        fit.sigma,
        np.repeat(freedom[:, None], column.size, axis=1),
        ("residuals",) * column.size,
    )


def with_blocks(
    fixed: Estimates,
    fit: LeastSquares,
    surface: Floats,
    values: Floats,
    names: tuple[str, ...],
    index: Integers,
    treatment: Literal["fixed", "random"],
) -> tuple[Estimates, BlockEffects]:
    """Estimates as the treatment of the blocks wants them, and the blocks' own levels."""
    n_responses = len(values)
    if treatment == "fixed":
        # level of each block's runs above the surface: also where a response misses a block
        above = values - fixed.coefficient @ np.nan_to_num(surface).T
        member = (index == np.arange(len(names))[:, None]) & np.isfinite(values)[:, None]
        count = member.sum(axis=2)
        level = np.where(member, above[:, None], 0.0).sum(axis=2)
        effect = np.divide(level, count, out=np.full(level.shape, np.nan), where=count > 0)
        none, inside = np.full(n_responses, np.nan), np.zeros(n_responses, dtype=bool)
        return fixed, BlockEffects(names, index, treatment, effect, none, inside)
    mixed = fit_random_intercept(surface, values, block=index)
    terms = tuple("blocks" if between else "residuals" for between in mixed.is_between)
    estimates = Estimates(
        mixed.coefficient,
        mixed.covariance_factor,
        np.arange(n_responses),
        mixed.sigma,
        mixed.degrees_of_freedom,
        terms,
    )
    effects = BlockEffects(
        names,
        index,
        treatment,
        mixed.effect,
        mixed.standard_deviation,
        mixed.at_boundary,
    )
    return estimates, effects


def deviations(
    found: Estimates, exponents: Integers, low: ArrayLike, high: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Standard uncertainties of coded and of engineering coefficients, and the way between."""
    factor = found.covariance_factor
    to_engineering = engineering_matrix(exponents, low=low, high=high)
    rows = np.broadcast_to(to_engineering, factor.shape)
    engineering = variance_factor(rows, factor, pattern=np.arange(len(factor)))
    coded = np.einsum("ptt->pt", factor)
    sigma = found.sigma[:, None]
    return (
        np.sqrt(coded)[found.pattern] * sigma,
        np.sqrt(engineering)[found.pattern] * sigma,
        to_engineering,
    )
