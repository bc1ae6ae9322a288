r"""Responses on another scale: logarithm, Box-Cox power.

**Responses that cannot be negative, fitted on another scale and transformed back**:

.. math::

    z = \frac{y^\lambda - 1}{\lambda} \quad (\lambda \ne 0), \qquad z = \ln y \quad (\lambda = 0),
    \qquad z = \ln (f y)

The last one is for a relaxation time: for a rope whose loss angle hardly changes with the frequency
f it falls as 1/f, which no quadratic in f follows between three levels, while the product of the
two is nearly constant.

The printed quadratic surfaces of H, K_1 and tau of [1]_ fall below zero inside their own
ranges; a surface of ln y cannot.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 11-19.
.. [2] G. E. P. Box and D. R. Cox, "An Analysis of Transformations," J. R. Stat. Soc. B, vol.
   26, pp. 211-252, 1964.
.. [3] J. M. G. Taylor, "The Retransformed Mean After a Fitted Power Transformation," J. Am.
   Stat. Assoc., vol. 81, pp. 114-118, 1986.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.experiments.designs import engineering_from_coded
from reduction.experiments.response_matrix import highest_of_each, patterns_of, times
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats

Transform = Literal["none", "log", "box-cox", "log-times-frequency"]


def fitted_unit(unit: str, transform: str) -> str:
    """Unit of a response on the scale of its fit; empty if not stated."""
    names = {"none": unit, "log": f"ln({unit})", "log-times-frequency": f"ln(Hz {unit})"}
    return names.get(transform, f"Box-Cox({unit})") if unit else ""


def transform(values: ArrayLike, exponent: ArrayLike) -> Floats:
    r"""Power transform of Box and Cox.

    .. math:: z = (y^\lambda - 1) / \lambda, \qquad z = \ln y \text{ at } \lambda = 0

    Notes
    -----
    Source: [2]_, eq. 1.

    Examples
    --------
    >>> print(transform([1.0, 4.0], 0.5), transform(np.e, 0.0))
    [0. 2.] 1.0
    """
    array = np.asarray(values, dtype=np.float64)
    bad = array <= 0
    if bad.any():
        raise DataError(
            f"{int(bad.sum())} of {bad.size} values are not above zero and have no logarithm",
            found=f"{array[bad].flat[0]:g}",
            needed="values above zero",
            hint="Fit the response as it is, or leave the run out for a stated reason.",
        )
    return np.asarray(
        scipy.special.boxcox(array, np.asarray(exponent, dtype=np.float64)), dtype=np.float64
    )


def back_transform(values: ArrayLike, exponent: ArrayLike) -> Floats:
    r"""Response on its own scale: the median if the transformed one is normal.

    .. math:: y = (1 + \lambda z)^{1 / \lambda}, \qquad y = e^z \text{ at } \lambda = 0

    Parameters
    ----------
    values : array_like, shape (...)
        Transformed values. [unit of the response to the power of the exponent]
    exponent : array_like, shape broadcast against values
        :math:`\lambda`. [1]

    Returns
    -------
    response : ndarray, shape (...)
        Beyond the end of the scale, 0 (positive exponent) or infinity (negative one).
        [unit of the response]

    Notes
    -----
    Ends of intervals are transformed back in the same way and remain intervals of the same
    probability; means do not remain means (`retransformed_mean`).

    Examples
    --------
    >>> print(back_transform([0.0, 2.0, -5.0], 0.5))
    [1. 4. 0.]
    """
    scaled, power = np.broadcast_arrays(
        np.asarray(values, dtype=np.float64), np.asarray(exponent, dtype=np.float64)
    )
    base = np.maximum(1 + power * scaled, 0.0)
    log = power == 0
    # an end of an interval may overflow, and is then infinite
    with np.errstate(over="ignore"):
        result = np.exp(np.where(log, scaled, 0.0))
    inverse = np.divide(1.0, power, out=np.ones(power.shape), where=~log)
    ended = (base == 0) & (inverse < 0)
    # 1 where the power is not used
    safe = np.where(log | ended, 1.0, base)
    with np.errstate(over="ignore"):
        root = safe**inverse
    return np.asarray(np.where(log, result, np.where(ended, np.inf, root)))


def back_transformed_change(values: ArrayLike, change: ArrayLike, exponent: ArrayLike) -> Floats:
    """Change of the response for a small change on the transformed scale.

    Parameters
    ----------
    values, change : array_like, shape (...)
        Transformed values. [unit of the response to the power of the exponent]
    exponent : array_like, shape broadcast against values
        Of the transform. [1]

    Returns
    -------
    change : ndarray, shape (...)
        Signed; NaN if the scale ends within the change. [unit of the response]

    Notes
    -----
    Half of the difference between the two ends: the slope there, to second order.

    Examples
    --------
    A change of 0.1 in a logarithm is a tenth:

    >>> print(back_transformed_change(np.log(50.0), 0.1, 0.0).round(2))
    5.01
    """
    at, moved = np.asarray(values, dtype=np.float64), np.asarray(change, dtype=np.float64)
    ends = back_transform(at + moved, exponent), back_transform(at - moved, exponent)
    with np.errstate(invalid="ignore"):
        half = (ends[0] - ends[1]) / 2
    return np.asarray(np.where(np.isfinite(half), half, np.nan))


def retransformed_mean(values: ArrayLike, exponent: ArrayLike, *, sigma: ArrayLike) -> Floats:
    r"""Mean response on its own scale, for normal scatter on the transformed one.

    .. math::

        E y \approx y_m \left[1 + \frac{\sigma^2 (1 - \lambda)}{2 (1 + \lambda z)^2}\right],
        \qquad E y = y_m e^{\sigma^2 / 2} \text{ at } \lambda = 0

    Notes
    -----
    Source: [3]_; exact at 0, second order in sigma elsewhere.  The exponent and sigma are taken
    as known.  A fatigue or damping budget needs this mean; a typical line the median.

    Examples
    --------
    >>> print(retransformed_mean(0.0, 0.0, sigma=0.2).round(4))
    1.0202
    """
    power, scatter = np.asarray(exponent, dtype=np.float64), np.asarray(sigma, dtype=np.float64)
    middle = back_transform(values, power)
    base = 1 + power * np.asarray(values, dtype=np.float64)
    share = scatter**2 * (1 - power) / 2
    second = 1 + np.divide(
        share, base**2, out=np.full(np.shape(base * share), np.nan), where=base > 0
    )
    return np.asarray(
        middle * np.where(power == 0, np.exp(np.where(power == 0, scatter**2, 0.0) / 2), second)
    )


def multipliers(
    transforms: Sequence[str],
    coded: ArrayLike,
    *,
    factor_names: Sequence[str],
    low: ArrayLike,
    high: ArrayLike,
) -> Floats:
    """Factor of each response before it is transformed: the frequency, or 1.

    Parameters
    ----------
    transforms : sequence of str, length n_responses
        Scale of each response.
    coded : array_like, shape (n_points, n_factors)
        Levels of the factors. [1]
    factor_names : sequence of str, length n_factors
        In the order of the columns.
    low, high : array_like, shape (n_factors,)
        Levels coded -1 and +1. [SI unit of each factor]

    Returns
    -------
    multipliers : ndarray, shape (n_responses, n_points)
        The frequency for log-times-frequency, else 1. [Hz, or 1]

    Raises
    ------
    SettingsError
        If a response is to be multiplied by the frequency, which is not a factor.

    Examples
    --------
    >>> of = {"factor_names": ["frequency"], "low": [0.1], "high": [0.5]}
    >>> print(multipliers(["log", "log-times-frequency"], [[-1.0], [0.5]], **of))
    [[1.  1. ]
     [0.1 0.4]]
    """
    points = np.asarray(coded, dtype=np.float64)
    found = np.ones((len(transforms), len(points)))
    rows = [row for row, kind in enumerate(transforms) if kind == "log-times-frequency"]
    if not rows:
        return found
    names = list(factor_names)
    if "frequency" not in names:
        raise SettingsError(
            "a response is to be multiplied by the frequency, which is no factor",
            found=", ".join(names),
            needed="a factor called frequency, or the transform log",
        )
    found[rows] = engineering_from_coded(points, low=low, high=high)[:, names.index("frequency")]
    return found


LIMITS = (-2.0, 2.0)
"""Exponents to be searched."""

_GRID = 81

_STEPS = 60


class _BoxCoxExponent(NamedTuple):
    """Best exponent of each response and its interval; infinite if the search ends first."""

    exponent: Floats
    low: Floats
    high: Floats


def box_cox_exponent(matrix: ArrayLike, responses: ArrayLike) -> _BoxCoxExponent:
    r"""Exponent of each response that minimises its residuals, by profile likelihood.

    .. math::

        \ell(\lambda) = -\frac{n}{2} \ln \lVert (I - H) z_\lambda(y / \bar y_g) \rVert^2, \qquad
        \ell(\lambda) > \ell_{max} - \tfrac{1}{2} \chi^2_1

    Notes
    -----
    Source: [2]_, sec. 3; dividing by the geometric mean includes the Jacobian.  Exponents
    from -2 to 2 are searched.  Where the largest value is less than twice the smallest, the
    interval is wide: the exponent is then not determined, and 1 or 0 will do.

    Examples
    --------
    Values whose logarithms scatter evenly:

    >>> found = box_cox_exponent(np.ones((5, 1)), [np.exp([-2.0, -1.0, 0.0, 1.0, 2.0])])
    >>> print(abs(found.exponent.round(6)), (found.low < 0) & (found.high > 0))
    [0.] [ True]
    """
    columns = np.asarray(matrix, dtype=np.float64)
    logarithm = transform(responses, 0.0)
    is_used, pattern = patterns_of(np.isfinite(logarithm))
    found = np.full((3, logarithm.shape[0]), np.nan)
    for index, used in enumerate(is_used):
        rows = np.flatnonzero(pattern == index)
        left, size, _ = np.linalg.svd(columns[used], full_matrices=False)
        # columns of missing blocks add nothing
        basis = left[:, size > 1e-9 * size.max(initial=0.0)]
        if used.sum() <= basis.shape[1]:
            continue
        part = logarithm[rows][:, used]
        scaled = np.exp(part - part.mean(axis=1, keepdims=True))
        drop = float(scipy.special.chdtri(1, 1 - CONFIDENCE)) / 2
        found[:, rows] = _profile(_likelihood(scaled, basis), rows.size, drop)
    return _BoxCoxExponent(*found)


def _likelihood(scaled: Floats, basis: Floats) -> Callable[[Floats], Floats]:
    """Log-likelihood of one exponent for each response."""

    def at(exponent: Floats) -> Floats:
        transformed = scipy.special.boxcox(scaled, exponent[:, None])
        residual = transformed - times(times(transformed, basis), basis.T)
        square = np.sum(residual**2, axis=1)
        return np.asarray(-scaled.shape[1] / 2 * np.log(np.maximum(square, np.finfo(float).tiny)))

    return at


def _profile(likelihood: Callable[[Floats], Floats], count: int, drop: float) -> Floats:
    """Exponent, low and high end for each response, shape (3, count)."""
    grid = np.linspace(*LIMITS, _GRID)
    best, height = highest_of_each(likelihood, grid, count)
    threshold = likelihood(best) - drop
    below = height < threshold[:, None]
    before, after = below & (grid < best[:, None]), below & (grid > best[:, None])
    # the nearest exponent of the grid on each side that is outside the interval
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
