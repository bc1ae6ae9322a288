r"""The power by which a response becomes nearest to a quadratic with even scatter.

References
----------
.. [1] G. E. P. Box and D. R. Cox, "An Analysis of Transformations," J. R. Stat. Soc. B, vol. 26,
   pp. 211-252, 1964.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import boxcox, chdtri

from reduction.errors import SettingsError
from reduction.record import Bools, Floats
from reduction.surface.rows import patterns_of, times
from reduction.surface.search import highest_of_each
from reduction.surface.transform import transform

LIMITS = (-2.0, 2.0)
"""Exponents that are searched."""
_GRID = 81
_STEPS = 60


class BoxCoxExponent(NamedTuple):
    """Best exponent of each response and its interval; infinite where the search ends first."""

    exponent: Floats
    low: Floats
    high: Floats


def box_cox_exponent(
    matrix: ArrayLike, responses: ArrayLike, *, confidence: float = 0.95
) -> BoxCoxExponent:
    r"""Exponent of each response that makes its residuals smallest, by profile likelihood.

    .. math::

        \ell(\lambda) = -\frac{n}{2} \ln \lVert (I - H) z_\lambda(y / \bar y_g) \rVert^2, \qquad
        \ell(\lambda) > \ell_{max} - \tfrac{1}{2} \chi^2_1

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    responses : array_like, shape (n_responses, n_runs)
        Above zero; NaN where a run is missing. [unit of the response]
    confidence : float
        Of the interval. [1]

    Returns
    -------
    found : BoxCoxExponent
        exponent, low and high, (n_responses,); NaN where the runs do not outnumber the
        columns.

    Raises
    ------
    DataError
        If a value is not above zero.
    SettingsError
        If the confidence is not between 0 and 1.

    Notes
    -----
    Source: [1]_, sec. 3; dividing by the geometric mean takes the Jacobian along.  Exponents
    from -2 to 2 are searched.  Where the largest value is less than twice the smallest the
    interval is wide and says so: the exponent is then no finding, and 1 or 0 will do.

    Examples
    --------
    Values whose logarithms scatter evenly:

    >>> found = box_cox_exponent(np.ones((5, 1)), [np.exp([-2.0, -1.0, 0.0, 1.0, 2.0])])
    >>> print(abs(found.exponent.round(6)), (found.low < 0) & (found.high > 0))
    [0.] [ True]
    """
    if not 0 < confidence < 1:
        raise SettingsError(
            "the confidence of an interval is a probability",
            found=f"{confidence:g}",
            needed="between 0 and 1",
        )
    columns = np.asarray(matrix, dtype=np.float64)
    logarithm = transform(responses, 0.0)
    is_used, pattern = patterns_of(np.isfinite(logarithm))
    found = np.full((3, logarithm.shape[0]), np.nan)
    for index, used in enumerate(is_used):
        rows = np.flatnonzero(pattern == index)
        left, size, _ = np.linalg.svd(columns[used], full_matrices=False)
        # columns of blocks that are missing add nothing
        basis = left[:, size > 1e-9 * size.max(initial=0.0)]
        if used.sum() <= basis.shape[1]:
            continue
        part = logarithm[rows][:, used]
        scaled = np.exp(part - part.mean(axis=1, keepdims=True))
        drop = float(chdtri(1, 1 - confidence)) / 2
        found[:, rows] = _profile(_likelihood(scaled, basis), rows.size, drop)
    return BoxCoxExponent(*found)


def _likelihood(scaled: Floats, basis: Floats) -> Callable[[Floats], Floats]:
    """Log-likelihood of one exponent a response."""

    def at(exponent: Floats) -> Floats:
        transformed = boxcox(scaled, exponent[:, None])
        residual = transformed - times(times(transformed, basis), basis.T)
        square = np.sum(residual**2, axis=1)
        return np.asarray(-scaled.shape[1] / 2 * np.log(np.maximum(square, np.finfo(float).tiny)))

    return at


def _profile(likelihood: Callable[[Floats], Floats], count: int, drop: float) -> Floats:
    """Exponent, low and high end of each response, shape (3, count)."""
    grid = np.linspace(*LIMITS, _GRID)
    best, height = highest_of_each(likelihood, grid, count)
    threshold = likelihood(best) - drop
    below = height < threshold[:, None]
    before, after = below & (grid < best[:, None]), below & (grid > best[:, None])
    # the nearest exponent of the grid on each side that the interval does not hold
    outer_low = grid[_GRID - 1 - np.argmax(before[:, ::-1], axis=1)]
    outer_high = grid[np.argmax(after, axis=1)]
    low = _crossing(likelihood, best, outer_low, threshold)
    high = _crossing(likelihood, best, outer_high, threshold)
    low[~before.any(axis=1)], high[~after.any(axis=1)] = -np.inf, np.inf
    return np.stack([best, low, high])


def _crossing(
    likelihood: Callable[[Floats], Floats], inner: Floats, outer: Floats, threshold: Floats
) -> Floats:
    for _ in range(_STEPS):
        middle = (inner + outer) / 2
        held: Bools = likelihood(middle) >= threshold
        inner, outer = np.where(held, middle, inner), np.where(held, outer, middle)
    return (inner + outer) / 2
