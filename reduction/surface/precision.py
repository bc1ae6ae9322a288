r"""How well an experiment will know its surface, before a line is broken.

.. math:: v_t = \left[(X^T X)^{-1}\right]_{tt}, \qquad v(x) = f^T (X^T X)^{-1} f, \qquad
   w = t_{\nu}\, \sigma \sqrt{v}

References
----------
.. [1] CG-D-39-80, sec. 4.3 and eq. 5: fifteen runs, ten terms.
.. [2] R. H. Myers and D. C. Montgomery, Response Surface Methodology, 2nd ed. New York: Wiley,
   2002, sec. 8.2 (scaled prediction variance).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError, FitError, SettingsError
from reduction.record import Bools, Floats, read_only_arrays
from reduction.surface.terms import model_matrix, quadratic_exponents, term_names
from reduction.surface.variance import covariance_factor, variance_factor


@dataclass(frozen=True)
@read_only_arrays
class ExpectedPrecision:
    """Expected half widths of the intervals of a quadratic surface.

    Parameters
    ----------
    terms : tuple of str, length n_terms
        In printed order: mean, squares, linear, interactions.
    term_variance_factor : ndarray, shape (n_terms,)
        Variance of a coefficient over that of one run. [1]
    term_half_width : ndarray, shape (..., n_terms)
        Of the confidence interval of each coefficient. [unit of sigma]
    points : ndarray, shape (n_points, n_factors)
        Centre, the other points of the design, and the corners of the cube, coded. [1]
    point_kind : tuple of str, length n_points
        ``centre``, ``design`` or ``corner``.
    point_variance_factor : ndarray, shape (n_points,)
        Variance of the fitted response over that of one run. [1]
    confidence_half_width, prediction_half_width : ndarray, shape (..., n_points)
        Of the mean response, and of one more run there. [unit of sigma]
    is_beyond_design : ndarray of bool, shape (n_points,)
        The variance factor is above the greatest of the runs themselves.
    degrees_of_freedom : int
        Of the residual.
    confidence : float
        Of each interval alone. [1]
    condition_number : float
        Of the model matrix. [1]
    """

    terms: tuple[str, ...]
    term_variance_factor: Floats
    term_half_width: Floats
    points: Floats
    point_kind: tuple[str, ...]
    point_variance_factor: Floats
    confidence_half_width: Floats
    prediction_half_width: Floats
    is_beyond_design: Bools
    degrees_of_freedom: int
    confidence: float
    condition_number: float


def _points(coded: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Centre first, then the design, then corners that are no runs."""
    n_factors = coded.shape[1]
    runs = np.unique(coded, axis=0)
    runs = runs[np.any(runs != 0, axis=1)]
    corners = np.array(list(product((-1.0, 1.0), repeat=n_factors)))
    corners = corners[~np.any(np.all(corners[:, None] == runs, axis=2), axis=1)]
    kinds = ("centre",) + ("design",) * len(runs) + ("corner",) * len(corners)
    return np.vstack([np.zeros((1, n_factors)), runs, corners]), kinds


def expected_precision(
    coded: ArrayLike,
    *,
    sigma: ArrayLike,
    confidence: float = 0.95,
    factor_names: Sequence[str] | None = None,
) -> ExpectedPrecision:
    """Half width of the interval of each term and of the response, for a stated scatter.

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Runs as planned, or as far as they got. [1]
    sigma : array_like, shape (...)
        Standard deviation of one run; relative to the response where that is what is
        known, and the half widths then are relative too. [unit of the response, or 1]
    confidence : float
        Of each interval alone. [1]
    factor_names : sequence of str, optional
        None: X1, X2, ..

    Returns
    -------
    precision : ExpectedPrecision
        One set of half widths a value of ``sigma``.

    Raises
    ------
    DataError
        If the runs are no table of finite numbers, or sigma is not above zero.
    SettingsError
        If the confidence is not between 0 and 1, or the names do not fit.
    FitError
        If the runs cannot carry the surface: too few, or two terms not told apart.

    Notes
    -----
    The quantile is Student's for the residual of the runs to come, so that the price of
    five degrees of freedom is in the width; the scatter they will show is taken as
    ``sigma`` itself.  The width holds for a quadratic surface: where the response is
    not one, its misfit comes on top.

    Examples
    --------
    The design of [1]_: mean, squares, linear terms, interactions, then the corners.

    >>> from reduction.surface.designs import box_behnken
    >>> precision = expected_precision(box_behnken(3).coded, sigma=0.02)
    >>> print(precision.term_variance_factor.round(4)[[0, 1, 4, 7]])
    [0.3333 0.2708 0.125  0.25  ]
    >>> print(precision.point_variance_factor.round(3)[[0, 1, -1]])
    [0.333 0.75  1.396]
    """
    runs = as_finite("coded", coded)
    if runs.ndim != 2:
        raise DataError(
            "the coded levels are not a table of runs",
            found=f"shape {runs.shape}",
            needed="one row a run, one column a factor",
        )
    scatter = as_positive("sigma", sigma)
    if not 0 < confidence < 1:
        raise SettingsError(
            "the confidence is not a share", found=f"{confidence:g}", needed="between 0 and 1"
        )
    n_runs, n_factors = runs.shape
    exponents = quadratic_exponents(n_factors)
    names = [f"X{i + 1}" for i in range(n_factors)] if factor_names is None else factor_names
    terms = term_names(exponents, names)
    matrix = model_matrix(runs, exponents)
    factor = covariance_factor(matrix, names=terms)
    freedom = n_runs - len(terms)
    if freedom == 0:
        raise FitError(
            "as many runs as terms leave nothing to judge the surface by",
            found=f"{n_runs} runs",
            needed=f"more than the {len(terms)} terms",
            degrees_of_freedom=freedom,
        )
    points, kinds = _points(runs)
    of_term = np.diagonal(factor)
    of_point = variance_factor(model_matrix(points, exponents), factor)
    of_run = variance_factor(matrix, factor)
    reach = stdtrit(freedom, (1 + confidence) / 2) * scatter[..., None]
    return ExpectedPrecision(
        terms=terms,
        term_variance_factor=of_term,
        term_half_width=reach * np.sqrt(of_term),
        points=points,
        point_kind=kinds,
        point_variance_factor=of_point,
        confidence_half_width=reach * np.sqrt(of_point),
        prediction_half_width=reach * np.sqrt(1 + of_point),
        is_beyond_design=of_point > of_run.max() * (1 + 1e-9),
        degrees_of_freedom=freedom,
        confidence=confidence,
        condition_number=float(np.linalg.cond(matrix)),
    )
