"""Surfaces on the planes that figures show: two factors across, the others held."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from reduction.record import Bools, Floats
from reduction.report.experimentview import ExperimentView
from reduction.surface.bands import SurfaceValues, evaluate_surfaces
from reduction.surface.product import ResponseSurfaces
from reduction.surface.tested import greatest_leverage
from reduction.vocabulary import RESPONSES

POINTS = 31
"""Points along each side of a plane: finer is not seen, and makes the page heavy."""
HELD = (-1.0, 0.0, 1.0)
"""Coded levels of the held factor, one plane each. [1]"""
_MOST_POINTS = 20000
_NEAR = 0.5
"""A run belongs to a plane where its held factor is nearer to it than to the next one. [1]"""


@dataclass(frozen=True)
class Planes:
    """Every surface of an experiment on three planes.

    Parameters
    ----------
    across : tuple of int
        Factors along x and y.
    held : int
        Factor that is constant on a plane; any further ones are in the middle.
    coded : ndarray, shape (n_points,)
        Of x and of y. [1]
    value : ndarray, shape (n_responses, 3, n_points, n_points)
        Rows are y; on the scale of the response itself. [unit of the response]
    leverage_ratio : ndarray, shape (n_responses, 3, n_points, n_points)
        Leverage over the greatest of a tested level: above 1 the runs say less than at the
        worst of them. [1]
    """

    across: tuple[int, int]
    held: int
    coded: Floats
    value: Floats
    leverage_ratio: Floats


def make_planes(view: ExperimentView, surfaces: ResponseSurfaces) -> Planes | None:
    """Return the planes over two loads at three frequencies; None with fewer than three factors.

    The factor that is held is the frequency where there is one, else the last.
    """
    names = view.factors
    if len(names) < 3:
        return None
    held = names.index("frequency") if "frequency" in names else len(names) - 1
    across = [place for place in range(len(names)) if place != held][:2]
    side = np.linspace(-1.0, 1.0, POINTS)
    points = np.zeros((3, POINTS, POINTS, len(names)))
    points[..., held] = np.array(HELD)[:, None, None]
    points[..., across[0]] = side
    points[..., across[1]] = side[:, None]
    at = evaluate_surfaces(surfaces, points.reshape(-1, len(names)), units="coded", outside="flag")
    shape = (len(surfaces.response_names), *points.shape[:3])
    ratio = leverage_ratio(view, surfaces, at)
    return Planes((across[0], across[1]), held, side, at.value.reshape(shape), ratio.reshape(shape))


def leverage_ratio(view: ExperimentView, surfaces: ResponseSurfaces, at: SurfaceValues) -> Floats:
    """Leverage of points over the greatest of a tested level, shape (n_responses, n_points)."""
    plan = view.array("run_plan")[:, : len(view.factors)]
    ratio: Floats = at.variance_factor / greatest_leverage(surfaces, plan)[:, None]
    return ratio


def runs_on_plane(view: ExperimentView, planes: Planes, level: float) -> Bools:
    """Which runs were made on a plane."""
    coded = view.array("run_coded_level")
    others = [k for k in range(coded.shape[1]) if k not in (*planes.across, planes.held)]
    on_plane = np.abs(coded[:, planes.held] - level) < _NEAR
    return np.asarray(on_plane & (np.abs(coded[:, others]) < _NEAR).all(axis=1))


def extremes_in_box(surfaces: ResponseSurfaces) -> tuple[Floats, Floats, Floats]:
    """Return least and greatest value of each surface within the levels, and where it is least.

    The place is coded; the values are of the response itself.
    """
    n_factors = surfaces.coded.shape[1]
    n_side = max(2, min(21, int(_MOST_POINTS ** (1 / n_factors))))
    points = np.array(list(product(np.linspace(-1, 1, n_side), repeat=n_factors)))
    value = evaluate_surfaces(surfaces, points, units="coded").value
    known = np.isfinite(value)
    row = np.arange(len(value))
    low = np.argmin(np.where(known, value, np.inf), axis=1)
    high = np.argmax(np.where(known, value, -np.inf), axis=1)
    return value[row, low], value[row, high], points[low]


def negative_inside(surfaces: ResponseSurfaces) -> dict[str, tuple[float, Floats]]:
    """Return least value and its place of each surface that goes below zero and cannot be."""
    least, _, place = extremes_in_box(surfaces)
    return {
        name: (float(least[index]), place[index])
        for index, name in enumerate(surfaces.response_names)
        if name in RESPONSES and least[index] < 0
    }
