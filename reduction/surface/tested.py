"""What of a plan counts as tested: its levels, and how much its runs say at a point.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4 ("range of usefulness").
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.record import Bools, Floats
from reduction.surface.product import ResponseSurfaces
from reduction.surface.reached import ON_PLAN
from reduction.surface.terms import model_matrix
from reduction.surface.variance import variance_factor

ABOVE_LEVERAGE = 1 + 1e-9
"""Leverage of a point over the greatest of a tested one beyond which the runs say less. [1]."""

_EDGE = 1e-9
"""Rounding of the change of units, by which a point on the edge may lie outside."""


def is_within_levels(coded: ArrayLike, *, allowed: ArrayLike = 0.0) -> Bools:
    """Whether points lie between the low and the high level of every factor.

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        The points. [1]
    allowed : array_like, shape (n_factors,), optional
        By how much a point may lie beyond, as where levels are printed in whole units. [1]

    Returns
    -------
    is_within : ndarray of bool, shape (...)
        False where a level is NaN. [1]

    Raises
    ------
    ValueError
        If the shapes do not pair up.

    Notes
    -----
    The range is that of the plan ([1]_).  A point within can still lie where no run was near.

    Examples
    --------
    >>> is_within_levels([[0.0, 1.0], [0.0, 1.02]])
    array([ True, False])
    >>> is_within_levels([[0.0, 1.0], [0.0, 1.02]], allowed=0.05)
    array([ True,  True])
    """
    within = np.abs(np.asarray(coded)) <= 1 + _EDGE + np.asarray(allowed)
    return np.asarray(within.all(axis=-1))


def levels_tested(reached: Floats, plan: Floats) -> Floats:
    """Coded levels that count as tested: those reached, and those of the plan beside them.

    Parameters
    ----------
    reached : ndarray, shape (n_runs, n_factors)
        As reached. [1]
    plan : ndarray, shape (n_runs, n_factors)
        As planned; NaN where a run has no plan. [1]

    Returns
    -------
    tested : ndarray, shape (n_tested, n_factors)
        Those reached first. [1]

    Raises
    ------
    ValueError
        If reached and planned levels do not pair up.

    Notes
    -----
    A planned level is no farther from its run than the run is from its plan: that scatter of the
    machine is no reason to call the level untested.  Of a run that went elsewhere it says nothing.

    Examples
    --------
    >>> levels_tested(np.array([[0.98], [0.2]]), np.array([[1.0], [-1.0]])).ravel()
    array([0.98, 0.2 , 1.  ])
    """
    is_near = np.all(np.abs(reached - plan) <= ON_PLAN, axis=1)
    return np.concatenate([reached, plan[is_near]])


def greatest_leverage(surfaces: ResponseSurfaces, plan: ArrayLike | None = None) -> Floats:
    """Greatest leverage of a tested level, by response: beyond it the runs say less.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    plan : array_like, shape (n_runs or more, n_factors), optional
        Coded levels as planned, in the order of the runs; without it the levels reached count
        alone. [1]

    Returns
    -------
    greatest : ndarray, shape (n_responses,)
        NaN where a response has no run with a level. [1]

    Raises
    ------
    ValueError
        If the plan has fewer runs, or other factors, than the surfaces.

    Examples
    --------
    A parabola through runs at three levels, of which the upper one was nearly reached:

    >>> from reduction.surface.surfaces import fit_surfaces
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
        levels = levels_tested(coded[own], planned[own])
        leverage = variance_factor(model_matrix(levels, surfaces.exponents), factor)
        leverage = leverage[np.isfinite(leverage)]
        if leverage.size:
            found[pattern] = leverage.max()
    return found[surfaces.pattern]
