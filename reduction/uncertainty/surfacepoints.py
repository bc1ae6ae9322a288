r"""Surfaces at points with what their runs share: uncertainty, and intervals by one rule.

.. math::

    u^2 = s^2 h + \sum_k (x^T c_k)^2, \qquad \hat y \pm t_{\nu_{eff}} u, \qquad
    \hat y \pm \sqrt{p F_{p, \nu_{eff}}}\, u

with the contribution c_k of each shared error to the coefficients, and the degrees of freedom of
Welch and Satterthwaite.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.2, G.4.1.
.. [2] H. Scheffe, The Analysis of Variance. New York: Wiley, 1959, sec. 3.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtri

from reduction.record import Floats, read_only_arrays
from reduction.surface.bands import SurfaceValues
from reduction.surface.product import ResponseSurfaces
from reduction.surface.terms import model_matrix
from reduction.surface.transform import back_transform, back_transformed_change
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)

_MANY = 1e9


@dataclass(frozen=True)
@read_only_arrays
class SharedAtPoints:
    """Surfaces at points with both parts of their uncertainty, on the scale of the response.

    Parameters
    ----------
    standard_uncertainty, random_standard_uncertainty : ndarray, shape (n_responses, n_points)
        Of the surface: both parts, and the scatter of the runs alone. [unit of the response]
    contribution : ndarray, shape (n_components, n_responses, n_points)
        Of each shared error, signed. [unit of the response]
    confidence_interval : ndarray, shape (n_responses, n_points, 2)
        Of the surface at this point. [unit of the response]
    prediction_interval : ndarray, shape (n_responses, n_points, 2)
        Of one more run there. [unit of the response]
    simultaneous_interval : ndarray, shape (n_responses, n_points, 2)
        Of the surface everywhere at once. [unit of the response]
    """

    standard_uncertainty: Floats
    random_standard_uncertainty: Floats
    contribution: Floats
    confidence_interval: Floats
    prediction_interval: Floats
    simultaneous_interval: Floats


def with_shared_at_points(
    surfaces: ResponseSurfaces,
    values: SurfaceValues,
    contribution: ArrayLike,
    of_contribution: ArrayLike,
) -> SharedAtPoints:
    """Put what the runs share beside the scatter of the runs, at points of their surfaces.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    values : SurfaceValues
        Of them, from `reduction.surface.bands.evaluate_surfaces`.
    contribution : array_like, shape (n_components, n_responses, n_terms)
        Of each shared error to the coded coefficients, signed; no rows where nothing is shared, NaN
        where it is not known. [as the coefficients]
    of_contribution : array_like, shape (n_components,)
        Degrees of freedom of each. [1]

    Returns
    -------
    shared : SharedAtPoints
        NaN for a response without a surface, or of whose runs it is not known what they share.

    Raises
    ------
    ValueError
        If the contributions do not fit the surfaces.

    Notes
    -----
    [1]_ with the degrees of freedom of the scatter for its part.  The next run has the instruments
    of the others: what is shared is in its interval in full.  Everywhere at once, as [2]_, with the
    same uncertainty and degrees of freedom: an error of the coefficients is one of them all.  Ends
    of intervals are brought back from the scale of the fit; an uncertainty is half of what lies
    between the two ends of one standard uncertainty.

    Examples
    --------
    Six runs in pairs that differ by 1, at one of the pairs: 0.5 of scatter by three degrees of
    freedom, and a load cell that is known to 1, are together 1.118 by 75 of them.

    >>> from reduction.surface.bands import evaluate_surfaces
    >>> from reduction.surface.surfaces import fit_surfaces
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
    freedom = values.degrees_of_freedom[:, None]
    kind = np.array(surfaces.transform) == "none"
    exponent = np.where(kind, 1.0, surfaces.transform_exponent)[:, None]

    def back(scaled: Floats) -> Floats:
        return np.where(kind[:, None], scaled, back_transform(scaled, exponent))

    def change(moved: Floats) -> Floats:
        return np.where(kind[:, None], moved, back_transformed_change(fitted, moved, exponent))

    def interval(random: Floats, *, is_everywhere: bool = False) -> Floats:
        effective = effective_degrees_of_freedom(
            random, freedom, contribution=rows, of_contribution=of_contribution
        )
        factor = coverage_factor(effective, confidence=values.confidence)
        if is_everywhere:
            n_terms = len(surfaces.term_names)
            bounded = np.minimum(effective, _MANY)
            factor = np.sqrt(n_terms * fdtri(n_terms, bounded, values.confidence))
        half = factor * combined_standard_uncertainty(rows, random)
        return np.stack([back(fitted - half), back(fitted + half)], axis=-1)

    own = values.fitted_standard_uncertainty
    random, moved = change(own), np.asarray([change(one) for one in rows]).reshape(rows.shape)
    return SharedAtPoints(
        standard_uncertainty=combined_standard_uncertainty(moved, random),
        random_standard_uncertainty=random,
        contribution=moved,
        confidence_interval=interval(own),
        prediction_interval=interval(values.run_standard_uncertainty),
        simultaneous_interval=interval(own, is_everywhere=True),
    )
