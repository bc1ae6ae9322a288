r"""What a quadratic surface may miss between its runs.

Three levels of a factor carry a slope and a curvature; what the response does between them they
do not say.  A power of the frequency with the exponent -0.9, quadratic in the frequency on the
scale of its logarithm, is met at 0.1, 0.3 and 0.5 Hz and is off by 6 % at 0.2 Hz, with residuals
of nil.  The terms of third and fourth order that the surface does without are drawn from what
the lower ones say of their size:

.. math::

    \delta(x) = \sum_\alpha \gamma_\alpha \left(x^\alpha - x^T (X^T X)^{-1} X^T X^\alpha\right),
    \qquad
    \gamma_{kkk}^2 \sim (a_k \rho_k^2 / 3)^2 + (c_k \rho_k)^2, \quad
    \gamma_{kkkk}^2 \sim (a_k \rho_k^3 / 4)^2 + (11 c_k \rho_k^2 / 12)^2

with the half range of a factor over its centre, rho, by which the terms of a logarithm or a power
of the factor fall from order to order, and c the curvature beyond that of a line and a logarithm.

References
----------
.. [1] M. C. Kennedy and A. O'Hagan, "Bayesian Calibration of Computer Models," J. R. Stat. Soc.
   B, vol. 63, pp. 425-464, 2001 (discrepancy).
.. [2] G. E. P. Box and N. R. Draper, "A Basis for the Selection of a Response Surface Design,"
   J. Am. Stat. Assoc., vol. 54, pp. 622-654, 1959 (bias from terms of higher order).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import model_matrix
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_matrix import block_contrasts
from reduction.record.measurement import Floats, Integers, read_only_arrays

_ORDERS = (3, 4)

_OF_SQUARE = np.array([0.0, 0.0, 1.0, 1.0, 11 / 12])
"""Terms of the square of a logarithm, by order: (ln(1 + x))^2 = x^2 - x^3 + 11/12 x^4 - .."""

_NO_ZERO = 0.5
"""Fall of the terms from order to order of a factor that may be zero or less."""

_LARGEST = 2 / 3
"""Of a factor whose range reaches near zero: no series falls more slowly within three levels."""


@dataclass(frozen=True)
@read_only_arrays
class SurfaceDiscrepancy:
    """Second moments of what surfaces miss, on the scale that they were fitted on.

    Parameters
    ----------
    exponents : ndarray of int, shape (n_all, n_factors)
        Terms of the surface, then those of third and fourth order.
    moment : ndarray, shape (n_responses, n_all, n_all)
        Expected products of the coefficients of the difference between response and surface; NaN
        for a response without a surface. [unit of the fitted response, squared]
    degrees_of_freedom : ndarray, shape (n_responses,)
        Squares that the size of the terms was found from. [1]
    """

    exponents: Integers
    moment: Floats
    degrees_of_freedom: Floats

    def at(self, coded: ArrayLike) -> Floats:
        """Standard uncertainty at points (n_points, n_factors), shape (n_responses, n_points)."""
        terms = model_matrix(np.asarray(coded, dtype=np.float64), self.exponents)
        return discrepancy_at(terms, self.moment)


def discrepancy_at(terms: Floats, moment: Floats) -> Floats:
    """Root of the quadratic form of a moment (..., n_all, n_all) in terms (n_points, n_all)."""
    square = np.sum((terms @ moment) * terms, axis=-1)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def discrepancy_of(surfaces: ResponseSurfaces) -> SurfaceDiscrepancy:
    r"""Size of the terms that quadratic surfaces do without, and what that does between the runs.

    .. math::

        a_k^2 = \max\left[b_k^2, (2 b_{kk} / \rho_k)^2\right], \qquad
        c_k = b_{kk} - \min(\max(b_{kk}, -\rho_k b_k / 2), 0) \; (b_k > 0), \qquad
        \gamma_\alpha^2 = \theta \prod_k \rho_k^{2 \alpha_k} / \bar\rho^2

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted, or as read from an archive.

    Returns
    -------
    discrepancy : SurfaceDiscrepancy
        Of every response, on the scale of its fit.

    Raises
    ------
    ValueError
        If the runs do not pair up with the terms.

    Notes
    -----
    Method: the bias of [2]_ with the sizes of its terms drawn, as the discrepancy of [1]_.  Along
    a factor the terms fall as those of its logarithm, :math:`\rho^n / n`, with one amplitude: the
    larger of what slope and curvature say, since a relaxation within the range bends more than the
    logarithm of its slope, and halfway through it has a slope without curvature.  What bends more
    than a line or a logarithm of its slope, or the other way, has an extreme near the levels or
    rises as an exponential: it falls as the square of a logarithm, beside it.  Terms of several
    factors have one scale, from the interactions and from
    what the runs scatter about the surface beyond their repeats (or at all, where none is
    repeated): the only terms of third order of which a Box-Behnken design sees anything.  From
    every square the part that scatter alone gives is taken off.  Signs are independent.  A
    response that turns within less than the distance of two levels (a step, a kink) is not
    covered: no run says so.

    Examples
    --------
    ln f^-0.9 of runs at 0.1, 0.3 and 0.5 Hz: what is stated at 0.2 and 0.4 Hz beside what the
    parabola misses there.

    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> def law(x):
    ...     return (0.3 + 0.2 * np.asarray(x)) ** -0.9
    >>> levels = np.array([[-1.0], [0.0], [1.0], [0.0], [0.0]])
    >>> found = fit_surfaces(levels, [law(levels[:, 0]) * [1, 1, 1, 1.001, 0.999]],
    ...     factor_names=["f"], response_names=["tau"], low=[0.1], high=[0.5], units="coded",
    ...     transforms="log")
    >>> between = np.array([[-0.5], [0.5]])
    >>> print(discrepancy_of(found).at(between).round(3))
    [[0.046 0.046]]
    >>> fitted = found.coefficient @ model_matrix(between, found.exponents).T
    >>> print(abs(np.log(law(between[:, 0])) - fitted).round(3))
    [[0.063 0.037]]
    """
    n_factors = surfaces.coded.shape[1]
    more = _higher_orders(n_factors)
    ratio = _falls(surfaces.low, surfaces.high)
    n_terms, n_more = len(surfaces.exponents), len(more)
    moment = np.full((len(surfaces.response_names), n_terms + n_more, n_terms + n_more), np.nan)
    freedom = np.full(len(surfaces.response_names), np.nan)
    # of responses that miss the same runs the matrices are the same
    of_runs: dict[bytes, tuple[Floats, Floats]] = {}
    for row, pattern in enumerate(surfaces.pattern.tolist()):
        used = surfaces.is_used[pattern] & np.isfinite(surfaces.coded).all(axis=1)
        if not np.isfinite(surfaces.coefficient[row]).all():
            continue
        key = used.tobytes()
        if key not in of_runs:
            of_runs[key] = _aliases(surfaces, used, more)
        change, seen = of_runs[key]
        size, freedom[row] = _sizes(surfaces, row, more, ratio, seen)
        moment[row] = (change * size) @ change.T
    return SurfaceDiscrepancy(np.concatenate([surfaces.exponents, more]), moment, freedom)


def _higher_orders(n_factors: int) -> Integers:
    """Powers of each factor in every term of third and fourth order."""
    every = product(range(max(_ORDERS) + 1), repeat=n_factors)
    return np.array([one for one in every if sum(one) in _ORDERS], dtype=np.int64)


def _falls(low: Floats, high: Floats) -> Floats:
    """Half range over centre of each factor: the series of a power of it falls by that.

    Examples
    --------
    0.1 to 0.5 Hz, and 12 to 30 % of a strength:

    >>> print(_falls(np.array([0.1, 0.12, -1.0]), np.array([0.5, 0.3, 1.0])).round(3))
    [0.667 0.429 0.5  ]
    """
    centre = (high + low) / 2
    share = np.divide(high - low, 2 * centre, out=np.full(low.shape, _NO_ZERO), where=low > 0)
    return np.asarray(np.minimum(share, _LARGEST))


def _aliases(surfaces: ResponseSurfaces, used: np.ndarray, more: Integers) -> tuple[Floats, Floats]:
    """Coefficients of what a surface misses of each term, and how much of it the residuals see."""
    terms = model_matrix(surfaces.coded[used], surfaces.exponents)
    higher = model_matrix(surfaces.coded[used], more)
    matrix = terms
    if surfaces.blocks is not None:
        effects = block_contrasts(surfaces.blocks.index[used])
        matrix = np.hstack([terms, effects - effects.mean(axis=0)])
    inverse = np.linalg.pinv(matrix)
    change = np.vstack([-(inverse @ higher)[: terms.shape[1]], np.eye(len(more))])
    left = higher - matrix @ (inverse @ higher)
    return change, np.sum(left**2, axis=0)


def _sizes(
    surfaces: ResponseSurfaces, row: int, more: Integers, ratio: Floats, seen: Floats
) -> tuple[Floats, float]:
    """Mean square of the coefficient of each term of higher order, and of how many squares."""
    variance = (
        np.nan_to_num(surfaces.sigma[row]) ** 2
        * np.diagonal(surfaces.covariance_factor[surfaces.pattern[row]])[: len(surfaces.exponents)]
    )
    square = np.maximum(surfaces.coefficient[row] ** 2 - variance, 0.0)
    powers = surfaces.exponents
    n_moved = (powers > 0).sum(axis=1)
    # one factor by itself: slope and curvature say how large the series is
    slope, curve = (
        [np.flatnonzero((powers == order * own).all(axis=1))[0] for own in np.eye(ratio.size)]
        for order in (1, 2)
    )
    amplitude = np.maximum(square[slope], square[curve] * (2 / ratio) ** 2)
    # what a line, a logarithm and all between them bend less than: a parabola in the logarithm
    coefficient = surfaces.coefficient[row]
    ends = np.sort([np.zeros(ratio.size), -ratio / 2 * coefficient[slope]], axis=0)
    beyond = coefficient[curve] - np.clip(coefficient[curve], *ends)
    beyond = np.maximum(beyond**2 - variance[curve] - (ratio / 2) ** 2 * variance[slope], 0.0)
    order = more.sum(axis=1)
    size = np.zeros(len(more))
    alone = (more > 0).sum(axis=1) == 1
    factor = np.argmax(more[alone], axis=1)
    power = 2.0 * (order[alone] - 2)
    size[alone] = ratio[factor] ** power * (
        amplitude[factor] * (ratio[factor] / order[alone]) ** 2
        + beyond[factor] * _OF_SQUARE[order[alone]] ** 2
    )
    if alone.all():
        return size, 2.0 * ratio.size

    def weight(of: Integers) -> Floats:
        return np.asarray(np.prod(ratio ** (2.0 * of), axis=1) / np.mean(ratio) ** 2)

    together = ~alone
    crossed = n_moved == 2
    lack = surfaces.lack_of_fit
    excess, freedom = _beyond_repeats(
        float(lack.sum_of_squares[row]), int(lack.degrees_of_freedom[row]),
        float(lack.pure_error_sum_of_squares[row]), int(lack.pure_error_degrees_of_freedom[row]),
    )  # fmt: skip
    of_residuals = float(seen[together] @ weight(more[together]))
    total, count = float(np.sum(square[crossed] / weight(powers[crossed]))), int(crossed.sum())
    if freedom > 0 and of_residuals > 0:
        total, count = total + freedom * excess / of_residuals, count + freedom
    size[together] = total / count * weight(more[together])
    return size, 2.0 * ratio.size + count


def _beyond_repeats(
    lack: float, lack_freedom: int, pure: float, pure_freedom: int
) -> tuple[float, int]:
    """Sum of squares about a surface that repeats do not explain, and its degrees of freedom."""
    if pure_freedom <= 0 or not np.isfinite(pure):
        return float(np.nan_to_num(lack)), max(lack_freedom, 0)
    expected = max(lack_freedom, 0) * pure / pure_freedom
    return max(float(np.nan_to_num(lack)) - expected, 0.0), max(lack_freedom, 0)
