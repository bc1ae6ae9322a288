"""What two-level effects are mixed of, and where they stand on a half-normal plot.

References
----------
.. [1] R. L. Plackett and J. P. Burman, "The design of optimum multifactorial
   experiments," Biometrika 33(4), 1946.
.. [2] C. Daniel, "Use of half-normal plots in interpreting factorial two-level
   experiments," Technometrics 1(4), 1959.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.record import Floats, Integers, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class HalfNormal:
    """Points of a half-normal plot, smallest first.

    Parameters
    ----------
    order : ndarray of int, shape (..., n_effects)
        Which effect each point is, from 0.
    quantile : ndarray, shape (n_effects,)
        Half-normal quantile. [1]
    size : ndarray, shape (..., n_effects)
        Absolute effect; NaN last. [unit of the response]
    """

    order: Integers
    quantile: Floats
    size: Floats


def two_level_columns(name: str, columns: ArrayLike) -> Floats:
    """Columns of a two-level design as numbers, or a refusal that names them.

    Parameters
    ----------
    name : str
        For the message.
    columns : array_like, shape (n_runs, n_columns)
        Coded levels. [1]

    Returns
    -------
    levels : ndarray, shape (n_runs, n_columns)
        -1 and +1. [1]

    Raises
    ------
    DataError
        If a level is neither -1 nor +1, or the columns are no table.

    Examples
    --------
    >>> print(two_level_columns("the design", [[-1], [1]]).ravel())
    [-1.  1.]
    """
    levels = as_finite(name, columns)
    if levels.ndim != 2 or not np.all(np.abs(levels) == 1):
        raise DataError(
            f"{name} is not a table of two levels",
            found=f"shape {levels.shape}, levels {sorted(set(levels.ravel().tolist()))[:5]}",
            needed="-1 and +1, one row a run",
        )
    return levels


def half_normal_coordinates(effects: ArrayLike) -> HalfNormal:
    r"""Coordinates of a half-normal plot: effects of noise alone lie on a line from zero.

    .. math:: q_i = \Phi^{-1}\!\left(\tfrac12 + \tfrac12 \frac{i - \tfrac12}{m}\right)

    Parameters
    ----------
    effects : array_like, shape (..., n_effects)
        Of factors and dummies together. [unit of the response]

    Returns
    -------
    points : HalfNormal
        Sizes in rising order with their quantiles.

    Raises
    ------
    DataError
        If there is no effect.

    Notes
    -----
    Source: [2]_.

    Examples
    --------
    >>> points = half_normal_coordinates([0.3, -2.0, 0.1])
    >>> print(points.size, points.order, points.quantile.round(3))
    [0.1 0.3 2. ] [2 0 1] [0.21  0.674 1.383]
    """
    size = np.abs(np.asarray(effects, dtype=np.float64))
    if size.ndim == 0 or size.shape[-1] == 0:
        raise DataError("there is no effect to plot", found=f"shape {size.shape}", needed="one")
    order = np.argsort(size, axis=-1, kind="stable")
    m = size.shape[-1]
    quantile = ndtri(0.5 + 0.5 * (np.arange(m) + 0.5) / m)
    return HalfNormal(order, quantile, np.take_along_axis(size, order, axis=-1))


def alias_matrix(coded: ArrayLike) -> tuple[tuple[tuple[int, int], ...], Floats]:
    r"""Share of each two-factor interaction that stands in the mean and in each main effect.

    .. math:: A = (X_1^T X_1)^{-1} X_1^T X_2, \qquad E[E_j] = E_j + \sum_{kl} A_{j,kl} E_{kl}

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Columns of the factors, dummies not among them. [1]

    Returns
    -------
    pairs : tuple of (int, int), length n_pairs
        Factors of each interaction, from 0.
    alias : ndarray, shape (1 + n_factors, n_pairs)
        First row the mean, then one row a factor. [1]

    Raises
    ------
    DataError
        If the columns are not of two levels, or two factors always move together.

    Notes
    -----
    Source: [1]_.  In twelve runs every interaction of two other factors stands in a main
    effect with a third of its size, plus or minus: a factor that looks active may be
    the sum of interactions.

    Examples
    --------
    >>> from reduction.surface.designs import plackett_burman
    >>> pairs, alias = alias_matrix(plackett_burman(3).coded)
    >>> pairs[2], float(abs(alias[1, 2]))  # the second and third factor in the first
    ((1, 2), 0.333)
    """
    levels = two_level_columns("the design", coded)
    pairs = tuple(combinations(range(levels.shape[1]), 2))
    first = np.column_stack([np.ones(levels.shape[0]), levels])
    second = np.empty((levels.shape[0], len(pairs)))
    for column, (one, other) in enumerate(pairs):
        second[:, column] = levels[:, one] * levels[:, other]
    if np.linalg.matrix_rank(first) < first.shape[1]:
        raise DataError(
            "the factors of the design cannot be told apart",
            found=f"rank {np.linalg.matrix_rank(first)}",
            needed=f"{first.shape[1]}",
        )
    alias = np.linalg.lstsq(first, second, rcond=None)[0].astype(np.float64)
    return pairs, alias
