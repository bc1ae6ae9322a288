r"""Possible error of a quadratic surface between its runs.

Three levels of a factor determine a slope and a curvature, but not the response between them.  A
power of the frequency with the exponent -0.9, quadratic in the frequency on the
scale of its logarithm, is met at 0.1, 0.3 and 0.5 Hz and is wrong by 6 % at 0.2 Hz, with zero
residuals.  The terms of higher order that the surface omits (of one factor up to the
eighth, of several up to the fourth) are drawn from the size of the lower ones,

.. math::

    \delta(x) = \sum_\alpha \gamma_\alpha \left(x^\alpha - x^T (X^T X)^{-1} X^T X^\alpha\right),

along one factor as those of a relaxing material.  For relaxation strengths h distributed over
the logarithm of time, independently, the parts of the modulus along v = ln f are

.. math::

    E'' = \int h(u)\,\tfrac{1}{2} \operatorname{sech}(v - u)\,du, \qquad
    E' = \int h(u)\,\tfrac{1}{2} [1 + \tanh(v - u)]\,du, \qquad
    k'' \propto \frac{d}{\sinh d}, \qquad k' \propto -\frac{d}{\tanh d},

with k the covariance at a distance d, for E' up to a constant.

References
----------
.. [1] M. C. Kennedy and A. O'Hagan, "Bayesian Calibration of Computer Models," J. R. Stat. Soc.
   B, vol. 63, pp. 425-464, 2001 (discrepancy).
.. [2] G. E. P. Box and N. R. Draper, "A Basis for the Selection of a Response Surface Design,"
   J. Am. Stat. Assoc., vol. 54, pp. 622-654, 1959 (bias from terms of higher order).
.. [3] J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. New York: Wiley, 1980, ch. 3
   (storage and loss of a spectrum of relaxation times).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import model_matrix
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.response_transform import back_transform
from reduction.quantities.names import response_of_surface
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

_ORDERS = (3, 4)

_NO_ZERO = 0.5
"""Ratio of the terms from order to order of a factor that may be zero or less."""

_ALONE = range(5, 9)
"""Further orders along one factor: for a logarithm over levels of 1 to 25, 2 % remains beyond."""

_NO_LEVEL = 1e-6
"""Least level over the centre, for coded levels beyond the range."""

_ALONG = np.linspace(-1.0, 1.0, 41)
"""Coded levels at which a response along one factor is drawn."""

_STORING = ("apparent_spring_constant", "dissipation_spring_constant", "storage_spring_constant")
"""Responses that vary with frequency as a storage modulus."""

_FROM_LOSS = ("relaxation_time", "dashpot_coefficient")
"""Responses that are derived from the loss."""

_OF_ONE_TIME = ("dissipation_spring_constant", *_FROM_LOSS)
"""Responses that a single relaxation leaves constant over frequency."""

_ODDS = 0.1
"""Prior odds of a single relaxation time against a spectrum: a judgement."""


@dataclass(frozen=True)
@read_only_arrays
class SurfaceDiscrepancy:
    """Second moments of the errors of surfaces, on the scale on which they were fitted.

    Parameters
    ----------
    exponents : ndarray of int, shape (n_all, n_factors)
        Terms of the surface, then those of third and fourth order, then higher ones of one factor.
    moment : ndarray, shape (n_responses, n_all, n_all)
        Expected products of the coefficients of the difference between response and surface; NaN
        for a response without a surface. [unit of the fitted response, squared]
    degrees_of_freedom : ndarray, shape (n_responses,)
        Number of squares from which the size of the terms was found, two per factor. [1]
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
    r"""Size of the terms that quadratic surfaces omit, and the resulting error between the runs.

    .. math::

        E[\gamma \gamma^T] = G M G^T + s^2 (C_{\gamma\gamma} - G C_{b\gamma}), \qquad
        G = C_{\gamma b} C_{bb}^{-1}, \qquad M = b b^T - V_b, \qquad
        s^2 = \tfrac{1}{2} \operatorname{tr} C_{bb}^{-1} M

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted, or as read from an archive.

    Returns
    -------
    discrepancy : SurfaceDiscrepancy
        For every response, on the scale of its fit.

    Notes
    -----
    Method: the bias of [2]_ with the sizes of its terms drawn, as the discrepancy of [1]_.
    Along a factor, a normal process with the covariance C gives slope and curvature, b,
    together with the terms beyond them; b then determines the distribution of those terms and the
    size of the process. Along the frequency the process is that of [3]_ above.  For storage, and
    for responses derived from the loss, its size is at least the mean of their own and that
    by the loss: slope and curvature of three levels may miss a relaxation that the loss shows.
    A single relaxation time makes K_1 and tau constant but not the loss: the contribution of the
    loss to them is weighted by the chance of their slope and curvature against that of scatter
    about none.  Along other factors the process of the loss is taken over the level and over its
    logarithm, weighted by the likelihood of slope and curvature, whatever its size. Terms of
    several factors have one scale, from the interactions and from the scatter of the runs about the
    surface beyond their repeats (or at all, where none is repeated): the only terms of third
    order that a Box-Behnken design can detect. From every square the part due to scatter
    alone is subtracted. A response that turns within less than the distance of two levels
    (a step, a kink) is not covered, since no run shows it.

    Examples
    --------
    ln f^-0.9 with runs at 0.1, 0.3 and 0.5 Hz: stated error at 0.2 and 0.4 Hz compared with the
    actual error of the parabola there.

    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> def law(x):
    ...     return (0.3 + 0.2 * np.asarray(x)) ** -0.9
    >>> levels = np.array([[-1.0], [0.0], [1.0], [0.0], [0.0]])
    >>> found = fit_surfaces(levels, [law(levels[:, 0]) * [1, 1, 1, 1.001, 0.999]],
    ...     factor_names=["frequency"], response_names=["tau"], low=[0.1], high=[0.5],
    ...     units="coded", transforms="log")
    >>> between = np.array([[-0.5], [0.5]])
    >>> print(discrepancy_of(found).at(between).round(3))
    [[0.047 0.026]]
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
    # responses that miss the same runs share their matrices
    of_pattern = [_runs_of(surfaces, is_used) for is_used in surfaces.is_used]
    aliases = [_aliases(surfaces, runs, more) for runs in of_pattern]
    loss = _loss_of(surfaces, ratio, of_pattern)
    for row, pattern in enumerate(surfaces.pattern.tolist()):
        if not np.isfinite(surfaces.coefficient[row]).all():
            continue
        change, seen = aliases[pattern]
        size = np.diag(_of_several_factors(surfaces, row, more, ratio, seen))
        for factor in range(n_factors):
            own = np.flatnonzero(np.delete(more, factor, axis=1).sum(axis=1) == 0)
            size[np.ix_(own, own)] = _of_one_factor(
                surfaces, row, factor, ratio, loss, of_pattern[pattern]
            )
        moment[row] = change @ size @ change.T
        freedom[row] = 2.0 * n_factors
    return SurfaceDiscrepancy(np.concatenate([surfaces.exponents, more]), moment, freedom)


def _higher_orders(n_factors: int) -> Integers:
    """Powers of each factor in every term of third and fourth order, and those of one factor."""
    every = product(range(max(_ORDERS) + 1), repeat=n_factors)
    crossed = np.array([one for one in every if sum(one) in _ORDERS], dtype=np.int64)
    alone = np.kron(np.array(_ALONE)[:, None], np.eye(n_factors, dtype=np.int64))
    return np.concatenate([crossed, alone])


def _logarithm_of(ratio: float) -> Callable[[Floats], Floats]:
    """Logarithm of a level over that of the centre, by coded level; finite for a level of zero."""
    return lambda coded: np.asarray(np.log(np.maximum(1 + ratio * coded, _NO_LEVEL)))


def _falls(low: Floats, high: Floats) -> Floats:
    """Half range over centre of each factor: ratio of the terms in the series of a power of it.

    Examples
    --------
    For 0.1 to 0.5 Hz, and 12 to 30 % of a strength:

    >>> print(_falls(np.array([0.1, 0.12, -1.0]), np.array([0.5, 0.3, 1.0])).round(3))
    [0.667 0.429 0.5  ]
    """
    centre = (high + low) / 2
    share = np.divide(high - low, 2 * centre, out=np.full(low.shape, _NO_ZERO), where=low > 0)
    return np.asarray(share)


class _Runs(NamedTuple):
    """Coded levels of the runs of a response, their model matrix and its inverse, with blocks."""

    coded: Floats
    matrix: Floats
    inverse: Floats


def _runs_of(surfaces: ResponseSurfaces, is_used: Bools) -> _Runs:
    """Runs that have a value and levels."""
    used = is_used & np.isfinite(surfaces.coded).all(axis=1)
    matrix = model_matrix(surfaces.coded[used], surfaces.exponents)
    if surfaces.blocks is not None:
        matrix = np.hstack([matrix, block_contrasts(surfaces.blocks.index[used])])
    return _Runs(surfaces.coded[used], matrix, np.asarray(np.linalg.pinv(matrix)))


def _aliases(surfaces: ResponseSurfaces, runs: _Runs, more: Integers) -> tuple[Floats, Floats]:
    """Coefficients of the misfit of each term, and its sum of squares in the residuals."""
    higher = model_matrix(runs.coded, more)
    solved = runs.inverse @ higher
    change = np.vstack([-solved[: len(surfaces.exponents)], np.eye(len(more))])
    left = higher - runs.matrix @ solved
    return change, np.sum(left**2, axis=0)


def _without_scatter(own: Floats, scatter: Floats) -> Floats:
    """Products of some coefficients less the part due to scatter alone, none of them negative."""
    value, vector = np.linalg.eigh(np.outer(own, own) - scatter)
    return np.asarray((vector * np.maximum(value, 0.0)) @ vector.T)


def _loss_kernel(distance: Floats) -> Floats:
    """Covariance of the loss of independent relaxation strengths over the logarithm of the time."""
    apart = np.maximum(np.abs(distance), 1e-9)
    return np.asarray(apart / np.sinh(apart))


def _storage_kernel(distance: Floats) -> Floats:
    """The same for their storage, up to a constant."""
    apart = np.maximum(np.abs(distance), 1e-9)
    return np.asarray(-apart / np.tanh(apart))


class _OneFactor(NamedTuple):
    """Information of slope and curvature along a factor on the terms of higher order.

    ``unlikely`` is one over the likelihood of both, for any size of the process.
    """

    own: Floats
    scatter: Floats
    process: Floats
    products: Floats
    size: float
    gain: Floats
    left: Floats
    unlikely: float

    def moment(self, size: float) -> Floats:
        """Mean products of the coefficients of higher order, for a process of a given size."""
        return np.asarray(self.gain @ self.products @ self.gain.T + size * self.left)

    def chance(self, size: float) -> float:
        """Chance that a process of a size made slope and curvature, not scatter about none. [1]."""
        none, some = self.scatter, self.scatter + size * self.process
        if not np.linalg.det(none) > 0:
            return 1.0

        def unlikely(spread: Floats) -> float:
            square = self.own @ np.linalg.solve(spread, self.own)
            return float(square + np.linalg.slogdet(spread)[1]) / 2

        return float(1 / (1 + _ODDS * np.exp(min(unlikely(some) - unlikely(none), 500.0))))


def _drawn(
    surfaces: ResponseSurfaces,
    row: int,
    factor: int,
    along: Callable[[Floats], Floats],
    runs: _Runs,
    *,
    is_storage: bool = False,
) -> _OneFactor:
    """Terms of a process along a factor, from the slope and curvature of a response.

    The process is drawn at the levels of the runs and between them.  Its parabola is that through
    the runs; its misfit is expanded in the terms of higher order, less their own parabolas.
    """
    place = np.concatenate([_ALONG, runs.coded[:, factor]])
    shift = along(place)
    distance = shift[:, None] - shift
    covariance = _storage_kernel(distance) if is_storage else _loss_kernel(distance)
    own = np.eye(len(surfaces.factor_names), dtype=int)[factor]
    three = [np.flatnonzero((surfaces.exponents == n * own).all(axis=1))[0] for n in range(3)]
    parabola = np.zeros((3, place.size))
    parabola[:, _ALONG.size :] = runs.inverse[three]
    powers = place[:, None] ** np.arange(_ALONE.stop)
    missed = (np.eye(place.size) - powers[:, :3] @ parabola)[: _ALONG.size]
    beyond = np.linalg.pinv(missed @ powers[:, 3:]) @ missed
    every = np.vstack([parabola[1:], beyond])
    joint = every @ covariance @ every.T
    terms = np.array(three[1:])
    slopes = surfaces.coefficient[row, terms]
    factor_of = surfaces.covariance_factor[surfaces.pattern[row]][np.ix_(terms, terms)]
    scatter = np.nan_to_num(surfaces.sigma[row]) ** 2 * factor_of
    products = _without_scatter(slopes, scatter)
    inverse = np.linalg.inv(joint[:2, :2])
    gain = joint[2:, :2] @ inverse
    size = float(np.trace(inverse @ products)) / 2
    unlikely = size / np.sqrt(np.linalg.det(inverse))
    left = joint[2:, 2:] - gain @ joint[:2, 2:]
    return _OneFactor(slopes, scatter, joint[:2, :2], products, size, gain, left, float(unlikely))


class _Loss(NamedTuple):
    """Size of the process of the loss along the frequency, with its spring constant and share."""

    size: float
    spring: float
    share: float


def _loss_of(
    surfaces: ResponseSurfaces, ratio: Floats, of_pattern: Sequence[_Runs]
) -> _Loss | None:
    """Loss along the frequency, from the surfaces of H; None if they do not determine it.

    The size is relative to the loss; the share is that of the loss in K_ap at the centre, H K_ap /
    (pi a^2), zero where no amplitude of the tension is a factor.
    """
    of = [response_of_surface(name) for name in surfaces.response_names]
    known = {
        name: row for row, name in enumerate(of) if np.isfinite(surfaces.coefficient[row]).all()
    }
    if "frequency" not in surfaces.factor_names or "hysteresis_energy" not in known:
        return None
    row = known["hysteresis_energy"]
    relative = _centre(surfaces, row) ** surfaces.transform_exponent[row]
    place = surfaces.factor_names.index("frequency")
    runs = of_pattern[surfaces.pattern[row]]
    size = _drawn(surfaces, row, place, _logarithm_of(ratio[place]), runs).size / relative**2
    share = spring = 0.0
    if "tension_amplitude" in surfaces.factor_names and "apparent_spring_constant" in known:
        place = surfaces.factor_names.index("tension_amplitude")
        amplitude = (surfaces.low[place] + surfaces.high[place]) / 2
        spring = _centre(surfaces, known["apparent_spring_constant"])
        share = _centre(surfaces, row) * spring / (np.pi * amplitude**2)
    # more than the whole means different units
    return _Loss(size, spring, share if 0 < share <= 1 else 0.0)


def _centre(surfaces: ResponseSurfaces, row: int) -> float:
    """Response at the centre of the levels."""
    own, exponent = surfaces.coefficient[row, 0], surfaces.transform_exponent[row]
    return float(own if surfaces.transform[row] == "none" else back_transform(own, exponent))


def _of_one_factor(
    surfaces: ResponseSurfaces,
    row: int,
    factor: int,
    ratio: Floats,
    loss: _Loss | None,
    runs: _Runs,
) -> Floats:
    """Mean products of the coefficients of the higher orders along one factor."""

    def level(coded: Floats) -> Floats:
        return np.asarray(ratio[factor] * coded)

    logarithm = _logarithm_of(ratio[factor])
    if surfaces.low[factor] <= 0:
        drawn = _drawn(surfaces, row, factor, level, runs)
        return drawn.moment(drawn.size)
    if surfaces.factor_names[factor] != "frequency":
        one, other = (_drawn(surfaces, row, factor, each, runs) for each in (level, logarithm))
        both = one.unlikely + other.unlikely
        share = other.unlikely / both if both > 0 else 0.5
        return share * one.moment(one.size) + (1 - share) * other.moment(other.size)
    name = response_of_surface(surfaces.response_names[row])
    is_storage = name in _STORING
    drawn = _drawn(surfaces, row, factor, logarithm, runs, is_storage=is_storage)
    size = drawn.size
    if loss is not None and (is_storage or name in _FROM_LOSS):
        centre = _centre(surfaces, row)
        share = loss.share * loss.spring / centre if is_storage else 1.0
        scale = centre ** surfaces.transform_exponent[row]
        # two estimates of one size, from two squares each
        more = max(loss.size * (share * scale) ** 2 - size, 0.0) / 2
        # with a single relaxation time the loss varies while these stay constant
        size += more * (drawn.chance(size + more) if name in _OF_ONE_TIME else 1.0)
    return drawn.moment(size)


def _of_several_factors(
    surfaces: ResponseSurfaces, row: int, more: Integers, ratio: Floats, seen: Floats
) -> Floats:
    r"""Mean square of the coefficient of each term of several factors, zero for the others.

    .. math:: \gamma_\alpha^2 = \theta \prod_k \rho_k^{2 \alpha_k} / \bar\rho^2
    """
    size = np.zeros(len(more))
    together = (more > 0).sum(axis=1) > 1
    if not together.any():
        return size

    def weight(of: Integers) -> Floats:
        return np.asarray(np.prod(ratio ** (2.0 * of), axis=1) / np.mean(ratio) ** 2)

    crossed = np.flatnonzero((surfaces.exponents > 0).sum(axis=1) == 2)
    variance = np.nan_to_num(surfaces.sigma[row]) ** 2 * np.diagonal(
        surfaces.covariance_factor[surfaces.pattern[row]]
    )
    square = np.maximum(surfaces.coefficient[row, crossed] ** 2 - variance[crossed], 0.0)
    lack = surfaces.lack_of_fit
    excess, freedom = _beyond_repeats(
        float(lack.sum_of_squares[row]), int(lack.degrees_of_freedom[row]),
        float(lack.pure_error_sum_of_squares[row]), int(lack.pure_error_degrees_of_freedom[row]),
    )  # fmt: skip
    of_residuals = float(seen[together] @ weight(more[together]))
    total = float(np.sum(square / weight(surfaces.exponents[crossed])))
    count = crossed.size
    if freedom > 0 and of_residuals > 0:
        total, count = total + freedom * excess / of_residuals, count + freedom
    size[together] = total / count * weight(more[together])
    return size


def _beyond_repeats(
    lack: float, lack_freedom: int, pure: float, pure_freedom: int
) -> tuple[float, int]:
    """Sum of squares about a surface that repeats do not explain, and its degrees of freedom."""
    if pure_freedom <= 0 or not np.isfinite(pure):
        return float(np.nan_to_num(lack)), max(lack_freedom, 0)
    expected = max(lack_freedom, 0) * pure / pure_freedom
    return max(float(np.nan_to_num(lack)) - expected, 0.0), max(lack_freedom, 0)
