"""Points of the plan at which a surface is worth a number: centre, runs and corners.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4 ("range of usefulness").
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class PlanPoints:
    """Points of a plan, none twice.

    Parameters
    ----------
    coded : ndarray, shape (n_points, n_factors)
        Levels. [1]
    name : tuple of str, length n_points
        The coded levels, ``(-1, 0, +1)``.
    kind : tuple of str, length n_points
        ``centre``, ``face centre``, ``edge midpoint``, ``corner``, or ``design point``.
    """

    coded: Floats
    name: tuple[str, ...]
    kind: tuple[str, ...]


def plan_points(plan: ArrayLike) -> PlanPoints:
    """Centre of the cube, then the points of the plan that differ, then the corners.

    Parameters
    ----------
    plan : array_like, shape (n_runs, n_factors)
        Coded levels as planned, repeats and all. [1]

    Returns
    -------
    points : PlanPoints
        The points of the plan in its order.

    Raises
    ------
    DataError
        If the plan is no table, or a level is not finite.

    Notes
    -----
    A Box-Behnken plan of three factors has its runs at the centre and on the 12 edge midpoints:
    with the 8 corners 21 points.  The corners belong to the tested range of each factor [1]_,
    and no run was near: an interval there says so.

    Examples
    --------
    >>> from reduction.surface.designs import box_behnken
    >>> found = plan_points(box_behnken(3).coded)
    >>> [(kind, found.kind.count(kind)) for kind in dict.fromkeys(found.kind)]
    [('centre', 1), ('edge midpoint', 12), ('corner', 8)]
    >>> found.name[1]
    '(-1, -1, 0)'
    """
    levels = as_finite("plan", plan)
    if levels.ndim != 2 or not levels.shape[1]:
        raise DataError(
            "the plan is not a table of runs and factors",
            found=f"shape {levels.shape}",
            needed="(n_runs, n_factors)",
        )
    n_factors = levels.shape[1]
    corners = np.array(list(product((-1.0, 1.0), repeat=n_factors)))
    # a sum with nil makes of -0 the 0 that it is
    every = np.vstack([np.zeros((1, n_factors)), levels, corners]) + 0.0
    _, first = np.unique(every, axis=0, return_index=True)
    kept = every[np.sort(first)]
    is_corner = (np.abs(kept) == 1).all(axis=1)
    coded = np.vstack([kept[~is_corner], corners])
    return PlanPoints(
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
