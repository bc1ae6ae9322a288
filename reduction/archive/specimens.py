"""The specimens of a test: what they were, what they had seen, how their strain was found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.archive.schema import COEFFICIENTS
from reduction.archive.values import Values, numbers, pad, texts
from reduction.errors import ArchiveError
from reduction.product import History
from reduction.record import Floats, Specimen
from reduction.strain.model import StrainModel
from reduction.uncertainty.product import Contributions


def specimen_values(specimens: Sequence[Specimen]) -> Values:
    """Return what is known of each specimen before the test."""
    known = [one.mean_diameter if one.diameter else None for one in specimens]
    area = numbers([one.area if one.diameter else None for one in specimens])
    spread = numbers([one.diameter_scatter for one in specimens])
    return {
        "specimen": texts([one.name for one in specimens]),
        "specimen_kind": texts([one.kind for one in specimens]),
        "specimen_material": texts([one.material for one in specimens]),
        "specimen_construction": texts([one.construction for one in specimens]),
        "specimen_condition": texts([one.condition for one in specimens]),
        "diameter": numbers(known),
        "diameter_standard_uncertainty": spread,
        "diameter_reading": pad([one.diameter for one in specimens]),
        "stretched_diameter_strain": pad(
            [[strain for strain, _ in one.stretched_diameters] for one in specimens]
        ),
        "stretched_diameter": pad(
            [[diameter for _, diameter in one.stretched_diameters] for one in specimens]
        ),
        "area": area,
        "area_standard_uncertainty": 2 * area * spread / numbers(known),
        "rated_break_strength": numbers([one.rated_break_strength for one in specimens]),
        "rated_break_strength_source": texts(
            [one.rated_break_strength_source for one in specimens]
        ),
        "declared_gauge_length": numbers([one.gauge_length for one in specimens]),
        **_linear_densities(specimens),
    }


def random_of_section(specimens: Sequence[Specimen], contributions: Contributions) -> Values:
    """Random part of diameters and areas: none where the error of the mean diameter is shared.

    What is stated is of the mean of the readings, and their scatter is in it; where nothing is
    stated the scatter itself is the error that all numbers over the area share.
    """
    rows = contributions.values.get("diameter")
    if rows is None:
        return {}
    stated = np.any(rows != 0, axis=0)
    own = specimen_values(specimens)
    names = ("diameter", "area")
    return {name: np.where(stated, 0.0, own[f"{name}_standard_uncertainty"]) for name in names}


def _linear_densities(specimens: Sequence[Specimen]) -> Values:
    """Mass a length in air and in water, where it is stated of one at least."""
    values = {
        "linear_density": numbers([one.linear_density for one in specimens]),
        "wet_linear_density": numbers([one.wet_linear_density for one in specimens]),
    }
    return {name: found for name, found in values.items() if np.isfinite(found).any()}


def history_values(history: History) -> Values:
    """Return what each specimen had seen before the test."""
    flex = history.earlier_flex_cycles
    return {
        "earlier_tests": texts([", ".join(tests) for tests in history.earlier_tests]),
        "earlier_maximum_strain": history.earlier_maximum_strain,
        "earlier_maximum_tension": history.earlier_maximum_tension,
        "earlier_cycles": history.earlier_cycles,
        **({} if flex is None else {"earlier_flex_cycles": flex}),
        "permanent_set": history.permanent_set,
        "permanent_set_standard_uncertainty": history.permanent_set_standard_uncertainty,
    }


def strain_model_values(models: Sequence[StrainModel]) -> Values:
    """Return method, coefficients, ranges and marks of each specimen's strain."""
    values: Values = {
        "strain_method": texts([one.method for one in models]),
        "strain_marks_from": texts([one.marks_from for one in models]),
        "strain_slope_ratio": numbers([one.strain_slope_ratio for one in models]),
    }
    for end in ("position_low", "position_high", "tension_low", "tension_high"):
        values[f"strain_{end}"] = numbers([getattr(one, end) for one in models])
    values |= _coefficient_values(models)
    return values | _mark_values(models)


def _coefficient_values(models: Sequence[StrainModel]) -> Values:
    used = {name for one in models for name in one.coefficients}
    unknown = sorted(used - set(COEFFICIENTS))
    if unknown:
        raise ArchiveError(
            "a strain method has coefficients that the archive has no name for",
            found=", ".join(unknown),
            needed=f"names among {', '.join(COEFFICIENTS)}",
            hint="Add the name to reduction.vocabulary and to COEFFICIENTS of the schema.",
        )
    names = [name for name in COEFFICIENTS if name in used]
    uncertainty = np.full((len(models), len(names)), np.nan)
    correlation = np.full((len(models), len(names), len(names)), np.nan)
    for row, one in enumerate(models):
        at = [names.index(name) for name in one.coefficients]
        deviation, matrix = _deviation_and_correlation(one)
        uncertainty[row, at] = deviation
        correlation[row][np.ix_(at, at)] = matrix
    stored = [COEFFICIENTS[name] for name in names]
    values: Values = {
        "coefficient_name": texts(stored),
        "coefficient_name_other": texts(stored),
        "strain_coefficient_correlation": correlation,
    }
    for column, (name, here) in enumerate(zip(names, stored, strict=True)):
        values[here] = numbers([one.coefficients.get(name) for one in models])
        values[f"{here}_standard_uncertainty"] = uncertainty[:, column]
    return values


def _deviation_and_correlation(model: StrainModel) -> tuple[Floats, Floats]:
    """Split a covariance, whose units are mixed, into parts that have a unit each."""
    size = len(model.coefficients)
    if model.covariance.shape != (size, size):
        return np.full(size, np.nan), np.full((size, size), np.nan)
    deviation = np.sqrt(np.diag(model.covariance))
    scale = np.outer(deviation, deviation)
    # an exact coefficient has no spread and is correlated with itself alone
    correlation = np.divide(model.covariance, scale, out=np.eye(size), where=scale > 0)
    return deviation, correlation


def _mark_values(models: Sequence[StrainModel]) -> Values:
    def joined(name: str) -> Floats:
        return np.concatenate([np.empty(0), *(getattr(one, name) for one in models)])

    return {
        "mark_specimen": texts([one.specimen for one in models for _ in one.mark_test]),
        "mark_test": texts([test for one in models for test in one.mark_test]),
        "mark_hold": texts([hold for one in models for hold in one.mark_hold]),
        "mark_position": joined("mark_position"),
        "mark_strain": joined("mark_strain"),
        "mark_tension": joined("mark_tension"),
        "mark_strain_residual": joined("mark_strain_residual"),
    }
