"""Uncertainty of surfaces and of runs: scatter of the runs, and what the runs share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.shared import FREEDOM
from reduction.record import Floats
from reduction.report.experimentview import ExperimentView
from reduction.report.sources import in_order
from reduction.report.uncertainty import Expanded, expand, expanded_of
from reduction.report.view import TestView
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.product import ResponseSurfaces
from reduction.uncertainty.combine import coverage_factor, effective_degrees_of_freedom
from reduction.uncertainty.surfacepoints import with_shared_at_points

_CONTRIBUTION = "_uncertainty_contribution"


@dataclass(frozen=True)
class CoefficientSpread:
    """Expanded uncertainty of the coefficients of a surface, and its shared part alone.

    The parts of scatter and of what is shared add up by their squares; both have the factor of all.
    """

    all: Expanded
    shared: Floats


def expanded_of_coefficients(
    view: ExperimentView, surfaces: ResponseSurfaces, index: int, *, in_units: bool = False
) -> CoefficientSpread:
    """Return the uncertainty of the coefficients of a surface, coded or in units.

    An archive that keeps no shared errors has those of scatter alone.
    """
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
    return CoefficientSpread(Expanded(factor * np.hypot(random, shared), factor), factor * shared)


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
    """Return the ends of the 95 % interval of every surface at points in coded levels.

    Parameters
    ----------
    view : ExperimentView
        Whose archive keeps what the runs share.
    surfaces : ResponseSurfaces
        Of it.
    coded : array_like, shape (n_points, n_factors)
        [1]

    Returns
    -------
    low, high : ndarray, shape (n_responses, n_points)
        NaN where there is no surface or no scatter. [unit of the response]
    """
    at = evaluate_surfaces(surfaces, coded, units="coded", outside="flag")
    rows = [
        _rows(view, f"{name}_coefficient", len(surfaces.term_names))
        for name in surfaces.response_names
    ]
    both = with_shared_at_points(surfaces, at, np.stack(rows, axis=1), _freedom(view))
    ends = both.confidence_interval
    return np.array(ends[..., 0]), np.array(ends[..., 1])


def expanded_of_runs(view: ExperimentView, name: str, tests: Mapping[str, TestView]) -> Expanded:
    """Return the expanded uncertainty of a response in each run.

    Where the run is a test of the campaign its archive knows all of it; a run from elsewhere has
    the uncertainty that was given with it.
    """
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
    """Contributions to the coefficients, shape (n_components, n_terms): zero where none.

    Not a number, where it is not kept of every run what it shares with the others.
    """
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
