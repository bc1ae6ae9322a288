r"""Values of response surfaces at points, with intervals.

**Values of response surfaces at points, with intervals and the support by the runs there**:

.. math::

    \hat y \pm t_\nu\, s \sqrt{h(x)}, \qquad
    \hat y \pm t_\nu\, s \sqrt{1 + h(x)}, \qquad
    \hat y \pm \sqrt{p F_{p, \nu}}\, s \sqrt{h(x)}, \qquad h(x) = x^T C x

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4 ("range of usefulness").
.. [2] H. Working and H. Hotelling, "Applications of the Theory of Error to the Interpretation
   of Trends," J. Am. Stat. Assoc., vol. 24, suppl., pp. 73-85, 1929.
.. [3] H. Scheffe, The Analysis of Variance. New York: Wiley, 1959, sec. 3.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.experiments.designs import (
    coded_from_engineering,
    engineering_from_coded,
    model_matrix,
)
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_matrix import times
from reduction.experiments.response_transform import back_transform, retransformed_mean
from reduction.experiments.run_sheet import ON_PLAN, variance_factor
from reduction.record.arrays import as_finite
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, read_only_arrays

ABOVE_LEVERAGE = 1 + 1e-9
"""Leverage of a point over the greatest of a tested one, beyond which support is less. [1]."""

_EDGE = 1e-9
"""Rounding in the change of units, by which a point on the edge may appear outside."""


def is_within_levels(coded: ArrayLike, *, allowed: ArrayLike = 0.0) -> Bools:
    """Whether points are between the low and the high level of every factor.

    Notes
    -----
    The range is that of the plan ([1]_).  A point within it may still be far from every run.

    Examples
    --------
    >>> is_within_levels([[0.0, 1.0], [0.0, 1.02]])
    array([ True, False])
    >>> is_within_levels([[0.0, 1.0], [0.0, 1.02]], allowed=0.05)
    array([ True,  True])
    """
    within = np.abs(np.asarray(coded)) <= 1 + _EDGE + np.asarray(allowed)
    return np.asarray(within.all(axis=-1))


def _levels_tested(reached: Floats, plan: Floats) -> Floats:
    """Coded levels that count as tested: those reached, and those of the plan near them.

    Notes
    -----
    A planned level is no farther from its run than the run is from its plan: scatter of the
    machine does not make the level untested.  This does not apply to a run that went elsewhere.

    Examples
    --------
    >>> _levels_tested(np.array([[0.98], [0.2]]), np.array([[1.0], [-1.0]])).ravel()
    array([0.98, 0.2 , 1.  ])
    """
    is_near = np.all(np.abs(reached - plan) <= ON_PLAN, axis=1)
    return np.concatenate([reached, plan[is_near]])


def greatest_leverage(surfaces: ResponseSurfaces, plan: ArrayLike | None = None) -> Floats:
    """Greatest leverage of a tested level, by response; beyond it there is less support by runs.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    plan : array_like, shape (n_runs or more, n_factors), optional
        Coded levels as planned, in the order of the runs; without it only the levels reached
        count. [1]

    Returns
    -------
    greatest : ndarray, shape (n_responses,)
        NaN where a response has no run with a level. [1]

    Examples
    --------
    A parabola through runs at three levels, the upper one nearly reached:

    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> plan = np.array([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]])
    >>> runs = np.where(plan > 0, 0.9, plan)
    >>> found = fit_surfaces(runs, [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> print(greatest_leverage(found).round(3), greatest_leverage(found, plan).round(3))
    [0.5] [0.71]
    """
    coded = surfaces.coded
    planned = coded if plan is None else np.asarray(plan, dtype=np.float64)[: len(coded)]
    known = np.isfinite(coded).all(axis=1)
    found = np.full(len(surfaces.covariance_factor), np.nan)
    for pattern, (factor, used) in enumerate(
        zip(surfaces.covariance_factor, surfaces.is_used, strict=True)
    ):
        own = known & used
        levels = _levels_tested(coded[own], planned[own])
        leverage = variance_factor(model_matrix(levels, surfaces.exponents), factor)
        leverage = leverage[np.isfinite(leverage)]
        if leverage.size:
            found[pattern] = leverage.max()
    return found[surfaces.pattern]


@dataclass(frozen=True)
@read_only_arrays
class _PlanPoints:
    """Points of a plan, without repeats."""

    coded: Floats
    name: tuple[str, ...]
    kind: tuple[str, ...]


def plan_points(plan: ArrayLike) -> _PlanPoints:
    """Centre of the cube, then the distinct points of the plan, then the corners.

    Notes
    -----
    A Box-Behnken plan of three factors has its runs at the centre and on the 12 edge midpoints:
    with the 8 corners 21 points.  The corners belong to the tested range of each factor [1]_,
    but no run was near; intervals there show it.

    Examples
    --------
    >>> from reduction.experiments.designs import box_behnken
    >>> found = plan_points(box_behnken(3).coded)
    >>> [(kind, found.kind.count(kind)) for kind in dict.fromkeys(found.kind)]
    [('centre', 1), ('edge midpoint', 12), ('corner', 8)]
    >>> found.name[1]
    '(-1, -1, 0)'
    """
    levels = as_finite("plan", plan)
    n_factors = levels.shape[1]
    corners = np.array(list(product((-1.0, 1.0), repeat=n_factors)))
    # adding zero converts -0 to 0
    every = np.vstack([np.zeros((1, n_factors)), levels, corners]) + 0.0
    _, first = np.unique(every, axis=0, return_index=True)
    kept = every[np.sort(first)]
    is_corner = (np.abs(kept) == 1).all(axis=1)
    coded = np.vstack([kept[~is_corner], corners])
    return _PlanPoints(
        coded=coded,
        name=tuple(f"({', '.join(f'{x:+g}' if x else '0' for x in row)})" for row in coded),
        kind=_kinds(coded),
    )


def _kinds(coded: Floats) -> tuple[str, ...]:
    n_factors = coded.shape[1]
    nil, ends = np.sum(coded == 0, axis=1), np.sum(np.abs(coded) == 1, axis=1)
    kind = np.select(
        [
            ends == n_factors,
            nil == n_factors,
            (ends == n_factors - 1) & (nil == 1),
            (ends == 1) & (nil == n_factors - 1),
        ],
        ["corner", "centre", "edge midpoint", "face centre"],
        "design point",
    )
    return tuple(kind.tolist())


@dataclass(frozen=True)
@read_only_arrays
class SurfaceValues:
    """Surfaces at points; shape (n_responses, n_points), intervals with a last axis of 2.

    Values and intervals are those of the response itself; transformed ones are transformed back.

    Parameters
    ----------
    coded, engineering : ndarray, shape (n_points, n_factors)
        The points. [1], [SI unit of each factor]
    value : ndarray
        Value of the surface; the median response if it was transformed. [unit of the response]
    mean_value : ndarray
        The mean response: the same if it was not transformed. [unit of the response]
    fitted_standard_uncertainty : ndarray
        Of the surface, on the scale on which it was fitted. [unit of the fitted response]
    run_standard_uncertainty : ndarray
        For one more run at the point, on the same scale. [unit of the fitted response]
    variance_factor : ndarray
        Leverage of the point. [1]
    confidence_interval : ndarray
        For the surface at this point. [unit of the response]
    prediction_interval : ndarray
        For one more run at this point, with another specimen if specimens are random.
        [unit of the response]
    simultaneous_interval : ndarray
        For the surface at all points at once. [unit of the response]
    is_inside : ndarray of bool, shape (n_points,)
        True between the low and high levels of every factor.
    above_leverage : ndarray of bool
        True inside, if there is less support by the runs than at the worst of them, as in the
        corners of the cube of a Box-Behnken design (1.396 against 0.75).
    degrees_of_freedom : ndarray, shape (n_responses,)
        Of the intervals. [1]
    confidence : float
        Of each interval. [1]
    notes : tuple of str
        Contributions included in the intervals, and those not included.
    """

    coded: Floats
    engineering: Floats
    value: Floats
    mean_value: Floats
    fitted_standard_uncertainty: Floats
    run_standard_uncertainty: Floats
    variance_factor: Floats
    confidence_interval: Floats
    prediction_interval: Floats
    simultaneous_interval: Floats
    is_inside: Bools
    above_leverage: Bools
    degrees_of_freedom: Floats
    notes: tuple[str, ...] = ()


def evaluate_surfaces(
    surfaces: ResponseSurfaces,
    points: ArrayLike,
    *,
    units: Literal["engineering", "coded"] = "engineering",
    outside: Literal["refuse", "flag"] = "refuse",
    plan: ArrayLike | None = None,
) -> SurfaceValues:
    r"""Value of every surface at every point, with three kinds of interval.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    points : array_like, shape (n_points, n_factors)
        Points at which to evaluate. [SI unit of each factor, or 1 where coded]
    units : {'engineering', 'coded'}
        Units of the points.
    outside : {'refuse', 'flag'}
        Treatment of a point beyond the levels of the plan.
    plan : array_like, shape (n_runs, n_factors), optional
        Coded levels as planned: those that a run came near also count as tested. [1]

    Returns
    -------
    values : SurfaceValues
        NaN for a response without a surface, NaN intervals for one without scatter.

    Raises
    ------
    DataError
        If a point is not finite, or is outside and is to be refused.

    Notes
    -----
    The range is that of the plan ([1]_, "range of usefulness"); a point inside it may still be
    far from every run: `above_leverage`.  Simultaneous intervals hold for the whole surface
    at once ([2]_, [3]_) and are the ones to draw; a confidence interval holds for one point
    chosen beforehand.  With fixed blocks all results are for the mean over these specimens; with
    random ones for the population, with the fewest degrees of freedom of any term.

    Examples
    --------
    A mean of three runs and its slope, at the end of the range:

    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]],
    ...     [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> at = evaluate_surfaces(found, [[0.5]])
    >>> print(at.value, at.variance_factor.round(3), at.confidence_interval.round(2))
    [[3.5]] [[0.5]] [[[1.91 5.09]]]
    """
    asked = as_finite("points", points)
    limits = {"low": surfaces.low, "high": surfaces.high}
    coded = asked if units == "coded" else coded_from_engineering(asked, **limits)
    is_inside = is_within_levels(coded)
    if outside == "refuse" and not is_inside.all():
        _refuse(surfaces, coded, int(np.flatnonzero(~is_inside)[0]), int((~is_inside).sum()))

    terms = model_matrix(coded, surfaces.exponents)
    of_pattern = variance_factor(
        np.broadcast_to(terms, (len(surfaces.covariance_factor), *terms.shape)),
        surfaces.covariance_factor,
        pattern=np.arange(len(surfaces.covariance_factor)),
    )
    factor = of_pattern[surfaces.pattern]
    greatest = greatest_leverage(surfaces, plan)
    fitted = times(surfaces.coefficient, terms.T)
    sigma = np.where(surfaces.reason == 0, surfaces.sigma, np.nan)[:, None]
    freedom = np.min(surfaces.term_degrees_of_freedom, axis=1)
    between = np.zeros_like(sigma)
    if surfaces.blocks is not None and surfaces.blocks.treatment == "random":
        between = surfaces.blocks.standard_deviation[:, None]
    deviation = sigma * np.sqrt(factor)
    of_run = np.sqrt(sigma**2 + between**2 + deviation**2)
    student = np.asarray(scipy.special.stdtrit(freedom, (1 + CONFIDENCE) / 2))[:, None]
    n_terms = len(surfaces.term_names)
    scheffe = np.sqrt(n_terms * np.asarray(scipy.special.fdtri(n_terms, freedom, CONFIDENCE)))[
        :, None
    ]

    power = surfaces.transform_exponent[:, None]
    plain = np.array([kind == "none" for kind in surfaces.transform])[:, None]

    multiplier = surfaces.multiplier(coded)

    def back(values: Floats) -> Floats:
        found = np.where(plain, values, back_transform(values, np.where(plain, 1.0, power)))
        return np.asarray(found / multiplier)

    def interval(half: Floats) -> Floats:
        return np.stack([back(fitted - half), back(fitted + half)], axis=-1)

    mean = retransformed_mean(fitted, np.where(plain, 1.0, power), sigma=np.hypot(sigma, between))
    mean = mean / multiplier
    return SurfaceValues(
        coded=coded,
        engineering=engineering_from_coded(coded, **limits),
        value=back(fitted),
        mean_value=np.where(plain, fitted, mean),
        fitted_standard_uncertainty=deviation,
        run_standard_uncertainty=of_run,
        variance_factor=factor,
        confidence_interval=interval(student * deviation),
        prediction_interval=interval(student * of_run),
        simultaneous_interval=interval(scheffe * deviation),
        is_inside=is_inside,
        above_leverage=is_inside & (factor > ABOVE_LEVERAGE * greatest[:, None]),
        degrees_of_freedom=freedom,
        notes=_notes(surfaces),
    )


_MOST_POINTS = 20000


def extremes_in_box(surfaces: ResponseSurfaces) -> tuple[Floats, Floats, Floats]:
    """Return least and greatest value of each surface within the levels, and place of the least.

    Evaluated on a grid of up to 21 levels of each factor.
    """
    n_factors = surfaces.coded.shape[1]
    n_side = max(3, min(21, int(_MOST_POINTS ** (1 / n_factors))))
    points = np.array(list(product(np.linspace(-1, 1, n_side), repeat=n_factors)))
    value = evaluate_surfaces(surfaces, points, units="coded").value
    known = np.isfinite(value)
    row = np.arange(len(value))
    low = np.argmin(np.where(known, value, np.inf), axis=1)
    high = np.argmax(np.where(known, value, -np.inf), axis=1)
    return value[row, low], value[row, high], points[low]


def _refuse(surfaces: ResponseSurfaces, coded: Floats, row: int, count: int) -> None:
    column = int(np.argmax(np.abs(coded[row])))
    level = engineering_from_coded(coded[row], low=surfaces.low, high=surfaces.high)[column]
    raise DataError(
        f"{count} of {len(coded)} points lie outside the tested range, first point {row + 1}",
        found=f"{surfaces.factor_names[column]} = {level:g}",
        needed=f"{surfaces.low[column]:g} to {surfaces.high[column]:g}",
        hint="Ask for the value with a flag, or test there.",
    )


def _notes(surfaces: ResponseSurfaces) -> tuple[str, ...]:
    notes = []
    if set(surfaces.transform) != {"none"}:
        notes.append(
            "values of transformed responses are medians; the exponent counts as known in "
            "their intervals"
        )
    if surfaces.blocks is not None and surfaces.blocks.treatment == "fixed":
        notes.append("intervals are of the mean over the specimens tested, not of another specimen")
    return tuple(notes)
