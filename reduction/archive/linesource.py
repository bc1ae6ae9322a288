"""Archives as sources of design values: surfaces of an experiment, curves of a test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.linecurves import curves_of_specimen
from reduction.archive.shared import components_of
from reduction.archive.stored import stored
from reduction.archive.surface_read import surface_names, surfaces_of
from reduction.errors import ArchiveError
from reduction.lookup.linesurface import LineSurface
from reduction.lookup.product import LineSource
from reduction.record import Floats
from reduction.surface.product import ResponseSurfaces
from reduction.surface.tested import greatest_leverage
from reduction.uncertainty.product import Component
from reduction.vocabulary import RESPONSES, quantity

_SCALES = ("log_", "box_cox_", "")
"""A surface on a scale that was asked for stands before the one of the quantity itself."""
_TEXTS = {
    "kind": "specimen_kind",
    "material": "specimen_material",
    "construction": "specimen_construction",
    "condition": "specimen_condition",
}
_NUMBERS = ("diameter", "linear_density", "wet_linear_density")


Facts = Mapping[str, str | float]
"""Fields of `LineSource` that a specimen states, by name."""


def line_source_of_experiment(
    dataset: xr.Dataset, experiment: str, *, specimens: Mapping[str, Facts] | None = None
) -> LineSource:
    """Surfaces of an experiment as a source of design values.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of experiments.
    experiment : str
        Name of one.
    specimens : mapping of str to mapping, optional
        What is known of its specimens, by name: `facts_of_specimens` of the archives of its
        tests.  The line has what all of them agree on.

    Returns
    -------
    line : LineSource
        With a surface of each response that was fitted.

    Raises
    ------
    ArchiveError
        If the archive has no such experiment, it has no surface, or its levels are shares of
        break strengths that differ.
    """
    names = surface_names(dataset, experiment)
    if not names:
        raise ArchiveError(f"experiment '{experiment}' has no surface", needed="a Box-Behnken one")
    row = dataset.variables["experiment"].values.astype(str).tolist().index(experiment)
    fitted = surfaces_of(dataset, experiment)
    factors = fitted.factor_names
    units = dataset.variables["factor_unit"].values[row].astype(str)[: len(factors)]
    strength = _one_strength(dataset, row)
    scale = np.array(
        [
            _scale(name, unit, strength, experiment)
            for name, unit in zip(factors, units, strict=True)
        ]
    )
    surfaces = {}
    for response in RESPONSES:
        name = next((f"{one}{response}" for one in _SCALES if f"{one}{response}" in names), None)
        if name is not None:
            shared = _shared(dataset, row, name, len(fitted.exponents))
            plan = dataset["run_plan"].to_numpy()[row, :, : len(factors)]
            surfaces[response] = _surface(
                fitted, names.index(name), response, name, scale, shared, plan
            )
    return LineSource(
        name=experiment,
        source=f"{dataset.attrs.get('id', 'surfaces')}, experiment {experiment}",
        rated_break_strength=strength,
        factor_names=factors,
        surfaces=surfaces,
        notes=_synthetic(dataset),
        **_agreed([(specimens or {}).get(one, {}) for one in specimens_of(dataset, experiment)]),
    )


def specimens_of(dataset: xr.Dataset, experiment: str) -> tuple[str, ...]:
    """Names of the specimens whose runs an experiment is of."""
    row = dataset.variables["experiment"].values.astype(str).tolist().index(experiment)
    return tuple(
        sorted({str(name) for name in dataset.variables["run_specimen"].values[row] if str(name)})
    )


def facts_of_specimens(dataset: xr.Dataset) -> dict[str, Facts]:
    """What the archive of a reduced test states of each of its specimens, by name."""
    if "specimen" not in dataset:
        return {}
    names = dataset.variables["specimen"].values.astype(str).tolist()
    return {name: _facts(dataset, place) for place, name in enumerate(names)}


def _facts(dataset: xr.Dataset, place: int) -> dict[str, Any]:
    return {
        name: str(dataset[stored].values[place]) if stored in dataset else ""
        for name, stored in _TEXTS.items()
    } | {
        name: float(dataset.variables[name].values[place]) if name in dataset else float("nan")
        for name in _NUMBERS
    }


def _agreed(facts: Sequence[Facts]) -> dict[str, Any]:
    """What all specimens have alike; nothing is said of what they differ in."""
    agreed: dict[str, Any] = dict.fromkeys(_TEXTS, "") | dict.fromkeys(_NUMBERS, float("nan"))
    for name, nothing in agreed.items():
        found = {one.get(name, nothing) for one in facts}
        if len(found) == 1:
            agreed[name] = found.pop()
    return agreed


def _shared(
    dataset: xr.Dataset, row: int, name: str, n_terms: int
) -> tuple[tuple[Component, ...], Floats]:
    """Errors that the runs share, and what each of them adds to the coefficients of a surface.

    Not a number, where that is not kept of every run.
    """
    rows = stored(dataset, f"{name}_coefficient_uncertainty_contribution")
    if rows is None:
        return (), np.empty((0, n_terms))
    own = rows.to_numpy()[row, :, :n_terms]
    component = components_of(dataset, row)
    # an experiment with fewer errors than another of the archive is filled up
    is_one = np.array([bool(one.source) for one in component], dtype=bool)
    known = np.flatnonzero(is_one & own.any(axis=1))
    return tuple(component[place] for place in known), own[known]


def _surface(
    fitted: ResponseSurfaces,
    index: int,
    response: str,
    name: str,
    scale: Floats,
    shared: tuple[tuple[Component, ...], Floats],
    plan: Floats,
) -> LineSurface:
    covariance = fitted.covariance_factor[fitted.pattern[index]]
    n_terms = len(fitted.exponents)
    notes = [] if name == response else [f"from the surface of {name}, brought back"]
    component, rows = shared
    sigma = float(fitted.sigma[index])
    if np.isfinite(fitted.coefficient[index]).all() and np.isnan(rows).any():
        component, rows, sigma = (), rows[:0], float("nan")
        notes.append(
            "no interval is given: of some runs it is not kept what they share with the others"
        )
    elif not rows.size:
        notes.append(
            "the intervals are of the scatter of the runs: of what all runs share, as the load "
            "cell, nothing is stated"
        )
    if not np.isfinite(fitted.coefficient[index]).all():
        notes.append("the surface was refused")
    return LineSurface(
        quantity=response,
        coefficient=np.array(fitted.coefficient[index]),
        exponents=np.array(fitted.exponents),
        low=scale * fitted.low,
        high=scale * fitted.high,
        covariance_factor=np.array(covariance[:n_terms, :n_terms]),
        sigma=sigma,
        degrees_of_freedom=float(fitted.degrees_of_freedom[index]),
        greatest_leverage=float(greatest_leverage(fitted, plan)[index]),
        exponent=float(fitted.transform_exponent[index]),
        component=component,
        contribution=rows,
        notes=tuple(notes),
    )


def _one_strength(dataset: xr.Dataset, row: int) -> float:
    """Break strength of the runs; NaN where it is not known, or they differ."""
    if "run_rated_break_strength" not in dataset:
        return float("nan")
    found = dataset.variables["run_rated_break_strength"].values[row]
    known = np.unique(found[np.isfinite(found)])
    return float(known[0]) if known.size == 1 else float("nan")


def _scale(name: str, unit: str, strength: float, experiment: str) -> float:
    """From the unit of the levels to SI: a share of a break strength becomes a tension."""
    try:
        own = quantity(name).unit
    except KeyError:
        return 1.0
    if unit == own:
        return 1.0
    if own == "N" and unit == "1" and np.isfinite(strength):
        return strength
    raise ArchiveError(
        f"levels of {name} of experiment '{experiment}' are no {own}",
        found=f"unit {unit}", needed="one rated_break_strength of all its specimens",
    )  # fmt: skip


def line_source_of_test(dataset: xr.Dataset, specimen: str) -> LineSource:
    """Curves of one specimen of a reduced test as a source of design values.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of a reduced test.
    specimen : str
        One of its specimens.

    Returns
    -------
    line : LineSource
        Tangent modulus and tension over strain on each branch; of a slow pull K_0 over the mean
        tension and strain over tension.

    Raises
    ------
    ArchiveError
        If the archive has no such specimen, or no curve.
    """
    known = (
        []
        if "specimen" not in dataset
        else dataset.variables["specimen"].values.astype(str).tolist()
    )
    if specimen not in known:
        raise ArchiveError(
            "the archive has no such specimen", found=specimen, needed=", ".join(known) or "none"
        )
    place = known.index(specimen)
    strength = "rated_break_strength"
    curves = curves_of_specimen(dataset, place)
    if not curves:
        raise ArchiveError(
            f"the archive of test {dataset.attrs.get('test', '')} has no curve",
            needed="a cyclic test, or a slow pull",
        )

    return LineSource(
        name=specimen,
        source=f"{dataset.attrs.get('id', '')}, specimen {specimen}",
        rated_break_strength=float(dataset[strength].values[place])
        if strength in dataset
        else float("nan"),
        curves=curves,
        notes=_synthetic(dataset),
        **_facts(dataset, place),
    )


def _synthetic(dataset: xr.Dataset) -> tuple[str, ...]:
    return ("synthetic data",) if dataset.attrs.get("synthetic") == "yes" else ()
