r"""What the runs of a design tell of its terms, before any response.

.. math:: C = (X^T X)^{-1}, \qquad h(x) = x^T C x

References
----------
.. [1] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, FitError
from reduction.record import Floats, Integers
from reduction.surface.rows import times

_SINGULAR = 1e-9
"""Smallest over largest singular value, columns of equal length, below which terms are one."""


def find_confounded(matrix: ArrayLike, names: Sequence[str]) -> tuple[str, ...]:
    """Say which columns are sums of the columns before them.

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    names : sequence of str, length n_columns
        Of the columns.

    Returns
    -------
    confounded : tuple of str
        One text for each column without information of its own; empty for a sound matrix.

    Raises
    ------
    DataError
        If the names do not pair up with the columns.

    Examples
    --------
    Two levels do not tell a square from the mean.

    >>> levels = np.array([-1.0, 1.0, -1.0, 1.0])
    >>> find_confounded(np.stack([np.ones(4), levels**2, levels], axis=1), ["mean", "f^2", "f"])
    ('f^2 with mean',)
    """
    columns = np.asarray(matrix, dtype=np.float64)
    if columns.ndim != 2 or columns.shape[1] != len(names):
        raise DataError(
            "the names do not pair up with the columns",
            found=f"{len(names)} names, shape {columns.shape}",
            needed="one name a column",
        )
    size = np.linalg.norm(columns, axis=0)
    unit = columns / np.where(size > 0, size, 1.0)
    kept: list[int] = []
    found: list[str] = []
    for index, name in enumerate(names):
        if size[index] == 0:
            found.append(f"{name} is zero in every run")
            continue
        share, *_ = np.linalg.lstsq(unit[:, kept], unit[:, index], rcond=None)
        left = unit[:, index] - unit[:, kept] @ share
        if np.linalg.norm(left) > _SINGULAR * len(names):
            kept.append(index)
        else:
            partners = [names[at] for at, part in zip(kept, share, strict=True) if abs(part) > 1e-6]
            found.append(f"{name} with {', '.join(partners)}")
    return tuple(found)


def covariance_factor(matrix: ArrayLike, *, names: Sequence[str]) -> Floats:
    r"""Covariance of the coefficients over the variance of a run, from the design alone.

    .. math:: C = (X^T X)^{-1}

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    names : sequence of str, length n_columns
        Of the columns, for the message.

    Returns
    -------
    covariance_factor : ndarray, shape (n_columns, n_columns)
        Symmetric. [1]

    Raises
    ------
    FitError
        If there are fewer runs than terms, or terms are confounded: their names.

    Notes
    -----
    For the fifteen runs of [2]_: mean 1/3, squares 13/48, linear terms 1/8, interactions 1/4.

    Examples
    --------
    A mean of three runs:

    >>> print(covariance_factor(np.ones((3, 1)), names=["mean"]).round(4))
    [[0.3333]]
    """
    columns = np.asarray(matrix, dtype=np.float64)
    n_runs, n_columns = columns.shape
    if n_runs < n_columns:
        raise FitError(
            "there are fewer runs than terms",
            found=f"{n_runs} runs",
            needed=f"{n_columns} for {n_columns} terms, and more to judge the scatter",
            hint="Add runs, or fit fewer factors.",
            n_runs=n_runs,
            n_terms=n_columns,
        )
    if is_singular(columns):
        found = find_confounded(columns, names)
        raise FitError(
            "the runs cannot tell all terms apart",
            found="; ".join(found),
            needed="runs that move every factor over three levels, and pairs of them together",
            hint="Add the runs that are missing from the design.",
            n_confounded=len(found),
        )
    inverse = np.linalg.inv(np.linalg.qr(columns)[1])
    return np.asarray(inverse @ inverse.T)


def variance_factor(
    matrix: ArrayLike, factor: ArrayLike, *, pattern: Integers | None = None
) -> Floats:
    r"""Variance of the surface at points over the variance of a run.

    .. math:: h(x) = x^T C x

    Parameters
    ----------
    matrix : array_like, shape (..., n_points, n_terms)
        Terms at the points; the leading axis is that of the responses, or there is none. [1]
    factor : array_like, shape (n_terms, n_terms) or (n_patterns, n_terms, n_terms)
        Covariance of the coefficients over the variance of a run. [1]
    pattern : ndarray of int, shape (n_responses,), optional
        Which ``factor`` each response has, where there are several. [1]

    Returns
    -------
    variance_factor : ndarray, shape (..., n_points)
        Leverage where the point is a run. [1]

    Raises
    ------
    ValueError
        If the shapes do not pair up.

    Examples
    --------
    >>> print(variance_factor([[1.0]], [[1 / 3]]).round(3))
    [0.333]
    """
    terms, factors = np.asarray(matrix, dtype=np.float64), np.asarray(factor, dtype=np.float64)
    if factors.ndim == 3:
        factors = factors[0] if len(factors) == 1 or pattern is None else factors[pattern]
    if factors.ndim == 2:
        weighed = times(terms.reshape(-1, len(factors)), factors).reshape(terms.shape)
    else:
        weighed = terms @ factors
    return np.asarray(np.sum(weighed * terms, axis=-1))


def is_singular(columns: Floats) -> bool:
    """Whether the runs leave columns of a matrix without information of their own.

    Parameters
    ----------
    columns : ndarray, shape (n_runs, n_columns)
        Model matrix, with no fewer runs than columns. [1]

    Returns
    -------
    is_singular : bool
        By the singular values of the columns at equal length.

    Raises
    ------
    LinAlgError
        From numpy, where a number is not finite.

    Examples
    --------
    Two levels do not tell a square from the mean, three do.

    >>> levels = np.array([-1.0, 1.0, 0.0])
    >>> two, three = (np.stack([x**2, x**0], axis=1) for x in (levels[:2], levels))
    >>> is_singular(two), is_singular(three)
    (True, False)
    """
    size = np.linalg.norm(columns, axis=0)
    if not size.all():
        return True
    values = np.linalg.svd(columns / size, compute_uv=False)
    return bool(values[-1] < _SINGULAR * values[0])
