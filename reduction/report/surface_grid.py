"""Surfaces on planes for figures, with their uncertainty."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.shared_errors import FREEDOM
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.surface_points import SurfaceValues, evaluate_surfaces, greatest_leverage
from reduction.quantities.names import RESPONSES
from reduction.record.contributions import coverage_factor, effective_degrees_of_freedom
from reduction.record.measurement import Bools, Floats
from reduction.report.product_views import ExperimentView
from reduction.report.test_view import Expanded, TestView, expand, expanded_of
from reduction.report.text_style import in_order
from reduction.uncertainty.surface_errors import with_shared_at_points

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
    """Return the planes over two loads at three frequencies; None with fewer than three factors."""
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
    """Return least and greatest value of each surface within the levels, and where it is least."""
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


_CONTRIBUTION = "_uncertainty_contribution"


@dataclass(frozen=True)
class _CoefficientSpread:
    """Expanded uncertainty of the coefficients of a surface, and its shared part alone."""

    all: Expanded
    shared: Floats


def expanded_of_coefficients(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, *, in_units: bool = False
) -> _CoefficientSpread:
    """Return the uncertainty of the coefficients of a surface, coded or in units."""
    name = f"{surfaces.response_names[index]}_coefficient"
    random = surfaces.coefficient_standard_uncertainty[index]
    if in_units:
        name += "_engineering"
        random = surfaces.coefficient_engineering_standard_uncertainty[index]
    contribution = _rows(view, name, random.size)
    factor = coverage_factor(
        effective_degrees_of_freedom(
            random,
            surfaces.term_degrees_of_freedom[index],
            contribution=contribution,
            of_contribution=_freedom(view),
        )
    )
    shared = np.sqrt(np.sum(contribution**2, axis=0))
    return _CoefficientSpread(Expanded(factor * np.hypot(random, shared), factor), factor * shared)


def shared_by_runs(view: ExperimentView, surfaces: ResponseSurfaces) -> list[str]:
    """Return the sources that the runs share and that reach a surface, in fixed order."""
    sources = view.texts("uncertainty_source")
    found: set[str] = set()
    for name in surfaces.response_names:
        rows = _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        found |= {sources[place] for place in np.flatnonzero(np.nan_to_num(rows).any(axis=1))}
    return in_order(found)


def interval_of_surfaces(
    view: ExperimentView, surfaces: ResponseSurfaces, coded: ArrayLike
) -> tuple[Floats, Floats]:
    """Return the ends of the 95 % interval of every surface at points in coded levels."""
    at = evaluate_surfaces(surfaces, coded, units="coded", outside="flag")
    rows = [
        _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        for name in surfaces.response_names
    ]
    both = with_shared_at_points(surfaces, at, np.stack(rows, axis=1), _freedom(view))
    ends = both.confidence_interval
    return np.array(ends[..., 0]), np.array(ends[..., 1])


def expanded_of_runs(view: ExperimentView, name: str, tests: Mapping[str, TestView]) -> Expanded:
    """Return the expanded uncertainty of a response in each run."""
    spread = view.per_run(f"{name}_measured_standard_uncertainty")
    given = expand(spread)
    half, factor = given.half.copy(), given.factor.copy()
    pairs = zip(view.texts("run_name"), view.texts("run_specimen"), strict=True)
    for place, (run, specimen) in enumerate(pairs):
        test = tests.get(run)
        own = None if test is None else test.array(f"test_{name}")
        if test is None or own is None or specimen not in test.specimens:
            continue
        found = expanded_of(test, f"test_{name}", own)
        row = test.specimens.index(specimen)
        half[place], factor[place] = found.half[row], found.factor[row]
    return Expanded(half, factor)


def _rows(view: ExperimentView, name: str, n_terms: int) -> Floats:
    """Contributions to the coefficients, shape (n_components, n_terms): zero where none."""
    found = view.array(f"{name}{_CONTRIBUTION}")
    n_components = _freedom(view).size
    if found.ndim != 2:
        return np.zeros((n_components, n_terms))
    return np.asarray(found[:n_components, :n_terms])


def _freedom(view: ExperimentView) -> Floats:
    """Degrees of freedom of each shared error of the experiment."""
    sources = list(filter(None, view.texts("uncertainty_source")))
    known = view.array(FREEDOM)[: len(sources)]
    return np.where(known > 0, known, np.inf) if known.size else np.full(len(sources), np.inf)
