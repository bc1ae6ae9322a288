r"""Errors shared by runs, in the coefficients and values of surfaces.

**Effect of shared errors of the runs on a response surface**:

.. math:: \delta b = (X^T X)^{-1} X^T
          \left(\delta y - \sum_j \frac{\partial \hat y}{\partial x_j} \delta x_j\right)

An error of a load cell is in the response and in the levels to which it is assigned.

**Surfaces at points with shared errors: uncertainty, and intervals by one rule**:

.. math::

    u^2 = s^2 h + \delta^2 + \sum_k (x^T c_k)^2, \qquad \hat y \pm t_{\nu_{eff}} u, \qquad
    \hat y \pm \sqrt{p F_{p, \nu_{eff}}}\, u

with the possible misfit of a quadratic at the point, delta, the contribution c_k of each shared
error to the coefficients, and the degrees of freedom of Welch and Satterthwaite.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2; 5.2.2, G.4.1.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C.
.. [3] H. Scheffe, The Analysis of Variance. New York: Wiley, 1959, sec. 3.5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtri

from reduction.experiments.designs import model_matrix
from reduction.experiments.experiment import ExperimentResult, SharedSurfaces
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.response_transform import back_transform, back_transformed_change
from reduction.experiments.surface_discrepancy import discrepancy_of
from reduction.experiments.surface_points import SurfaceValues, evaluate_surfaces
from reduction.quantities.names import response_of_surface
from reduction.record.contributions import (
    CONFIDENCE,
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays


def _coefficient_contributions(
    coded: ArrayLike,
    exponents: Integers,
    coefficient: ArrayLike,
    *,
    response: ArrayLike,
    level: ArrayLike,
    blocks: ArrayLike | None = None,
) -> Floats:
    """Contributions to the coefficients of a surface from those to its runs.

    Notes
    -----
    First order ([1]_, 5.2).  The surface of [2]_ is linear in its responses, and so is the effect
    of shared errors.  Errors that are random from run to run are already in the scatter about the
    surface and are not included here.

    Examples
    --------
    A gain of 1 % raises every coefficient of a spring constant by 1 %, if it affects no level:

    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.designs import quadratic_exponents
    >>> at, powers = box_behnken(3).coded, quadratic_exponents(3)
    >>> b = np.array([3.4, -0.1, 0.1, 0.3, 0.1, 0.5, -0.5, 0.0, 0.1, -0.2])
    >>> runs = model_matrix(at, powers) @ b
    >>> found = _coefficient_contributions(at, powers, b, response=0.01 * runs[None],
    ...     level=np.zeros((1, len(at), 3)))
    >>> print(np.allclose(found, 0.01 * b))
    True
    """
    at, own = np.asarray(coded, dtype=np.float64), np.asarray(coefficient, dtype=np.float64)
    of_response = np.asarray(response, dtype=np.float64)
    of_level = np.asarray(level, dtype=np.float64)
    used = np.isfinite(at).all(axis=1) & np.isfinite(of_response).all(axis=0)
    used &= np.isfinite(of_level).all(axis=(0, 2))
    terms = model_matrix(at[used], exponents)
    # for a quadratic, the central difference is its exact slope
    steps = np.eye(at.shape[1])
    slope = np.stack(
        [
            (model_matrix(at[used] + step, exponents) - model_matrix(at[used] - step, exponents))
            @ own
            / 2
            for step in steps
        ],
        axis=1,
    )
    moved = of_response[:, used] - np.einsum("rj,krj->kr", slope, of_level[:, used])
    matrix = terms
    if blocks is not None:
        matrix = np.concatenate([terms, block_contrasts(np.asarray(blocks)[used])], axis=1)
    solved: Floats = moved @ np.linalg.pinv(matrix).T
    return solved[:, : terms.shape[1]]


_MANY = 1e9


@dataclass(frozen=True)
@read_only_arrays
class _SharedAtPoints:
    """Surfaces at points with both parts of their uncertainty, on the scale of the response."""

    standard_uncertainty: Floats
    random_standard_uncertainty: Floats
    discrepancy: Floats
    degrees_of_freedom: Floats
    contribution: Floats
    confidence_interval: Floats
    prediction_interval: Floats
    simultaneous_interval: Floats


def with_shared_at_points(
    surfaces: ResponseSurfaces,
    values: SurfaceValues,
    contribution: ArrayLike,
    of_contribution: ArrayLike,
) -> _SharedAtPoints:
    """Combine shared errors of the runs, and the misfit of a quadratic, with the scatter of runs.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    values : SurfaceValues
        Values of these, from `reduction.experiments.surface_points.evaluate_surfaces`.
    contribution : array_like, shape (n_components, n_responses, n_terms)
        Of each shared error to the coded coefficients, signed; no rows if nothing is shared, NaN
        if it is not known. [as the coefficients]
    of_contribution : array_like, shape (n_components,)
        Degrees of freedom of each. [1]

    Returns
    -------
    shared : SharedAtPoints
        NaN for a response without a surface, or with unknown shared errors of its runs. The
        random part is that of the scatter and of the discrepancy, which is also given separately;
        degrees of freedom are those of the random part.

    Notes
    -----
    [1]_, 5.2.2, G.4.1 with the degrees of freedom of scatter and discrepancy for their parts
    (`reduction.experiments.surface_discrepancy.discrepancy_of`).  The next run has the instruments
    of the others, and the surface has the same misfit at the point: both are in its
    interval in full.  Simultaneous intervals are as in [3]_, with the
    same uncertainty and degrees of freedom, since an error of the coefficients is common to all
    points.  Ends of intervals are transformed back from the scale of the fit; an uncertainty is
    half the distance between the two ends of one standard uncertainty.

    Examples
    --------
    Six runs in pairs that differ by 1, at one of the pairs, where a parabola has no misfit: 0.5 of
    scatter with three degrees of freedom, and a load cell known to 1, give together 1.118 with
    75 degrees of freedom:

    >>> from reduction.experiments.surface_points import evaluate_surfaces
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]],
    ...     [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> at = evaluate_surfaces(found, [[0.5]])
    >>> both = with_shared_at_points(found, at, [[[1.0, 0.0, 0.0]]], [np.inf])
    >>> print(both.standard_uncertainty.round(3), both.confidence_interval.round(2))
    [[1.118]] [[[1.27 5.73]]]
    """
    terms = model_matrix(values.coded, surfaces.exponents)
    fitted = surfaces.coefficient @ terms.T
    rows = np.asarray(contribution, dtype=np.float64) @ terms.T
    missed = discrepancy_of(surfaces)
    between = missed.at(values.coded)
    kind = np.array(surfaces.transform) == "none"
    exponent = np.where(kind, 1.0, surfaces.transform_exponent)[:, None]

    multiplier = surfaces.multiplier(values.coded)

    def back(scaled: Floats) -> Floats:
        found = np.where(kind[:, None], scaled, back_transform(scaled, exponent))
        return np.asarray(found / multiplier)

    def change(moved: Floats) -> Floats:
        found = np.where(kind[:, None], moved, back_transformed_change(fitted, moved, exponent))
        return np.asarray(found / multiplier)

    def with_missed(scatter: Floats) -> tuple[Floats, Floats]:
        few = effective_degrees_of_freedom(
            scatter,
            values.degrees_of_freedom[:, None],
            contribution=between[None],
            of_contribution=missed.degrees_of_freedom[None, :, None],
        )
        return np.hypot(scatter, between), few

    def interval(scatter: Floats, *, is_everywhere: bool = False) -> Floats:
        random, freedom = with_missed(scatter)
        effective = effective_degrees_of_freedom(
            random, freedom, contribution=rows, of_contribution=of_contribution
        )
        factor = coverage_factor(effective)
        if is_everywhere:
            n_terms = len(surfaces.term_names)
            bounded = np.minimum(effective, _MANY)
            factor = np.sqrt(n_terms * fdtri(n_terms, bounded, CONFIDENCE))
        half = factor * combined_standard_uncertainty(rows, random)
        return np.stack([back(fitted - half), back(fitted + half)], axis=-1)

    own = values.fitted_standard_uncertainty
    both, freedom = with_missed(own)
    random, moved = change(both), np.asarray([change(one) for one in rows]).reshape(rows.shape)
    return _SharedAtPoints(
        standard_uncertainty=combined_standard_uncertainty(moved, random),
        random_standard_uncertainty=random,
        discrepancy=change(between),
        degrees_of_freedom=freedom,
        contribution=moved,
        confidence_interval=interval(own),
        prediction_interval=interval(values.run_standard_uncertainty),
        simultaneous_interval=interval(own, is_everywhere=True),
    )


@dataclass(frozen=True)
@read_only_arrays
class BetweenRuns:
    """Surfaces at every combination of a quarter, half and three quarters of each range.

    ``coded`` (n_points, n_factors); the others (n_responses, n_points), in the unit of each
    response: value, standard uncertainty due to the scatter of the runs and due to the misfit of a
    quadratic, and the ends of the 95 % interval of both.
    """

    coded: Floats
    value: Floats
    scatter_uncertainty: Floats
    discrepancy: Floats
    low: Floats
    high: Floats


def surfaces_between_runs(surfaces: ResponseSurfaces) -> BetweenRuns:
    """Values and intervals of surfaces of a table of runs, which states no shared errors.

    Examples
    --------
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [1.0], [1.0]],
    ...     [[1.0, 2.0, 4.0, 5.0, 3.0, 4.0]], factor_names=["frequency"],
    ...     response_names=["stiffness"], low=[0.1], high=[0.5], units="coded")
    >>> between = surfaces_between_runs(found)
    >>> print(between.coded.ravel(), between.discrepancy.round(2))
    [-0.5  0.   0.5] [[0.64 0.   0.38]]
    """
    n_factors = surfaces.coded.shape[1]
    steps = np.meshgrid(*[np.array([-0.5, 0.0, 0.5])] * n_factors, indexing="ij")
    coded = np.stack([one.ravel() for one in steps], axis=1)
    values = evaluate_surfaces(surfaces, coded, units="coded")
    nothing = np.zeros((0, len(surfaces.response_names), len(surfaces.term_names)))
    found = with_shared_at_points(surfaces, values, nothing, np.zeros(0))
    own = np.sqrt(np.maximum(found.random_standard_uncertainty**2 - found.discrepancy**2, 0.0))
    low, high = np.moveaxis(found.confidence_interval, -1, 0)
    return BetweenRuns(coded, values.value, own, found.discrepancy, low, high)


def with_shared_surfaces(result: ExperimentResult) -> ExperimentResult:
    """Propagate the shared errors of the runs to the coefficients of every surface."""
    surfaces, shared = result.surfaces, result.runs.shared
    if surfaces is None or shared is None or not shared.component:
        return result
    n_components, n_runs = len(shared.component), len(result.runs.run)
    half = (result.high - result.low) / 2
    level = np.zeros((n_components, n_runs, len(result.factor_names)))
    for place, name in enumerate(result.factor_names):
        if name in shared.values:
            level[..., place] = shared.values[name] / half[place]
    blocks = result.runs.specimen if len(set(result.runs.specimen)) > 1 else None
    names = None if blocks is None else np.unique(blocks, return_inverse=True)[1]
    rows = []
    for index, name in enumerate(surfaces.response_names):
        of = response_of_surface(name)
        own = shared.values[of] * _slope_of_scale(result, surfaces, index, of)
        if surfaces.transform[index] == "log-times-frequency" and "frequency" in shared.values:
            # both factors of the product have errors
            own = own + shared.values["frequency"] / surfaces.multiplier(surfaces.coded)[index]
        several = _of_several_pulls(own, level, result.runs.run)
        rows.append(
            _coefficient_contributions(
                surfaces.coded, surfaces.exponents, surfaces.coefficient[index],
                response=own * several[:, None], level=level * several[:, None, None],
                blocks=names,
            )
            if np.isfinite(surfaces.coefficient[index]).all()
            else np.full((n_components, surfaces.coefficient.shape[1]), np.nan)
        )  # fmt: skip
    coded = np.stack(rows, axis=1)
    return replace(
        result,
        shared=SharedSurfaces(
            component=shared.component,
            coefficient=coded,
            coefficient_engineering=coded @ surfaces.engineering_matrix.T,
        ),
    )


def _of_several_pulls(response: Floats, level: Floats, pulls: Sequence[str]) -> Bools:
    """Mask of errors of more than one pull: that of one (its temperature) is in the scatter."""
    moves = (np.nan_to_num(response) != 0) | (np.nan_to_num(level) != 0).any(axis=2)
    _, place = np.unique(np.asarray(pulls), return_inverse=True)
    of_pull = place == np.arange(place.max() + 1)[:, None]
    return np.asarray((moves @ of_pull.T > 0).sum(axis=1) > 1)


def _slope_of_scale(
    result: ExperimentResult, surfaces: ResponseSurfaces, index: int, name: str
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Derivative of the scale of a surface over its response, at each run."""
    values = result.runs.response[result.response_names.index(name)]
    exponent = surfaces.transform_exponent[index]
    if surfaces.transform[index] == "none":
        return np.where(np.isfinite(values), 1.0, np.nan)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(values > 0, values ** (exponent - 1), np.nan))
