"""Surfaces at points that were chosen beforehand, and along the way up and down, by name."""

from __future__ import annotations

import numpy as np

from reduction.archive.values import Values, texts
from reduction.experiment import SharedSurfaces
from reduction.record import Floats
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.canonical import ridge_path
from reduction.surface.points import plan_points
from reduction.surface.product import ResponseSurfaces
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.surfacepoints import with_shared_at_points

_CONFIDENCE = 0.95
_RADIUS = np.linspace(0.0, 1.0, 11)


def point_values(
    surfaces: ResponseSurfaces, plan: Floats, shared: SharedSurfaces | None = None
) -> Values:
    """Return every surface at the centre, at the points of the plan and at the corners.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    plan : ndarray, shape (n_runs, n_factors)
        Coded levels as planned.
    shared : SharedSurfaces, optional
        What the runs share; nothing where not given.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`.
    """
    points = plan_points(plan)
    found = evaluate_surfaces(
        surfaces, points.coded, units="coded", confidence=_CONFIDENCE, outside="flag", plan=plan
    )
    both = with_shared_at_points(surfaces, found, *_rows(surfaces, shared))
    values: Values = {
        "interval_confidence": np.array(found.confidence),
        "point": np.arange(1, len(points.name) + 1),
        "point_name": texts(points.name),
        "point_kind": texts(points.kind),
        "point_coded_level": found.coded,
        "point_level": found.engineering,
    }
    for index, name in enumerate(surfaces.response_names):
        values |= {
            f"{name}_point_value": found.value[index],
            f"{name}_point_mean_value": found.mean_value[index],
            f"{name}_point_variance_factor": found.variance_factor[index],
            f"{name}_point_is_above_leverage": found.above_leverage[index],
        }
        values |= both_parts(
            f"{name}_point_value",
            both.random_standard_uncertainty[index],
            None if shared is None else both.contribution[:, index],
        )
        for kind in ("confidence", "prediction", "simultaneous"):
            ends = getattr(both, f"{kind}_interval")[index]
            values[f"{name}_point_{kind}_low"] = ends[:, 0]
            values[f"{name}_point_{kind}_high"] = ends[:, 1]
    return values


def both_parts(name: str, random: Floats, rows: Floats | None) -> Values:
    """Return the uncertainty of a quantity with its parts; one part alone has no other beside it.

    Parameters
    ----------
    name : str
        Of the quantity.
    random : ndarray, shape (...)
        Its random part. [any]
    rows : ndarray, shape (n_components, ...), or None
        Contributions of shared errors; None where nothing is shared. [as random]

    Returns
    -------
    values : dict of str to ndarray
        By the name and `reduction.archive.variable.SUFFIXES`.
    """
    if rows is None:
        return {f"{name}_standard_uncertainty": random}
    return {
        f"{name}_standard_uncertainty": combined_standard_uncertainty(rows, random),
        f"{name}_random_standard_uncertainty": random,
        f"{name}_uncertainty_contribution": rows,
    }


def _rows(surfaces: ResponseSurfaces, shared: SharedSurfaces | None) -> tuple[Floats, Floats]:
    """Contributions to the coefficients, and the degrees of freedom of each shared error."""
    if shared is None:
        return np.zeros((0, *surfaces.coefficient.shape)), np.zeros(0)
    return shared.coefficient, np.array([one.degrees_of_freedom for one in shared.component])


def ridge_values(surfaces: ResponseSurfaces, shared: SharedSurfaces | None = None) -> Values:
    """Return the highest and the lowest points of every surface, by distance from the centre.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    shared : SharedSurfaces, optional
        What the runs share; nothing where not given.

    Returns
    -------
    values : dict of str to ndarray
        Names of `reduction.archive.surface_schema`; NaN for a response without a surface.

    Notes
    -----
    The points are found on the scale that a surface was fitted on, which rises with the response.
    The same runs chose them: of the intervals only the simultaneous ones hold there.
    """
    limits = {"low": surfaces.low, "high": surfaces.high}
    paths = [
        ridge_path(
            surfaces.coefficient, surfaces.exponents, radius=_RADIUS, direction=direction, **limits
        )
        for direction in ("ascent", "descent")
    ]
    coded = np.stack([path.coded for path in paths], axis=1)
    engineering = np.stack([path.engineering for path in paths], axis=1)
    n_responses, n_points = len(coded), 2 * _RADIUS.size
    found = evaluate_surfaces(
        surfaces,
        np.nan_to_num(coded).reshape(n_responses * n_points, -1),
        units="coded",
        confidence=_CONFIDENCE,
        outside="flag",
    )
    both = with_shared_at_points(surfaces, found, *_rows(surfaces, shared))
    values: Values = {"ridge_direction": texts(("ascent", "descent")), "ridge_radius": _RADIUS}
    for index, name in enumerate(surfaces.response_names):
        # each surface at the points of its own ridge
        own = (index, slice(index * n_points, (index + 1) * n_points))
        ends = both.simultaneous_interval[own].reshape(2, _RADIUS.size, 2)
        values |= {
            f"{name}_ridge_coded_level": coded[index],
            f"{name}_ridge_level": engineering[index],
            f"{name}_ridge_value": found.value[own].reshape(2, _RADIUS.size),
            f"{name}_ridge_simultaneous_low": ends[..., 0],
            f"{name}_ridge_simultaneous_high": ends[..., 1],
        }
    return values
