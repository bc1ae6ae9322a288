r"""Whether a response drifts over the order of the runs, beyond what the surface says.

.. math:: y = x^T \beta + \delta\,(k - \bar k) + e

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 (order by rising peak load).
.. [2] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998,
   sec. 4.1 (a variable that enters after the others).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats
from reduction.surface.fit import fit_least_squares, two_sided_p
from reduction.surface.product import ResponseSurfaces
from reduction.surface.rows import block_contrasts
from reduction.surface.terms import model_matrix


class Drift(NamedTuple):
    """Slope over the order, its standard uncertainty, t and p; NaN where it is not told apart."""

    slope: Floats
    standard_uncertainty: Floats
    t: Floats
    p_value: Floats


def drift_over_order(surfaces: ResponseSurfaces, order: ArrayLike) -> Drift:
    r"""Slope of every response over the order of the runs, beside all terms of its surface.

    .. math:: t = \delta / s_\delta, \qquad \nu = n - p - 1

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    order : array_like, shape (n_runs,)
        Place of each run, counted in its block where there are several; NaN where it is not
        known. [1]

    Returns
    -------
    drift : Drift
        Of the response as fitted, a run; NaN where the order says nothing that the terms do
        not say, or no degree of freedom is left for it. [unit of the fitted response]

    Raises
    ------
    DataError
        If the order does not pair up with the runs.

    Notes
    -----
    Source: [2]_.  In an order by rising load [1]_ drift lies mostly in the terms of the loads
    and only what is left over is seen: no drift here is not proof of none.

    Examples
    --------
    Centre runs first, in the middle and last see a drift of 0.2 a run.

    >>> from reduction.surface.designs import box_behnken
    >>> from reduction.surface.surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded[[12, 0, 5, 2, 7, 8, 1, 13, 3, 4, 10, 6, 9, 11, 14]]
    >>> noise = 0.1 * np.array([1, -1, 1, 1, -1, -1, 1, -1, 1, -1, 1, 1, -1, 1, -1])
    >>> found = fit_surfaces(runs, [3 + runs[:, 0] + 0.2 * np.arange(15) + noise], units="coded",
    ...     factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3, high=[1] * 3)
    >>> drift = drift_over_order(found, np.arange(15))
    >>> print(abs(drift.slope[0] - 0.2) < 2 * drift.standard_uncertainty[0], drift.p_value < 0.01)
    True [ True]
    """
    place = np.array(order, dtype=np.float64)
    if place.shape != surfaces.coded.shape[:1]:
        raise DataError(
            "the order does not pair up with the runs",
            found=f"shape {place.shape}",
            needed=f"{len(surfaces.coded)} places",
        )
    known = np.isfinite(place) & np.isfinite(surfaces.coded).all(axis=1)
    if not known.any():
        return Drift(*np.full((4, surfaces.reason.size), np.nan))
    terms = np.zeros((place.size, len(surfaces.exponents)))
    terms[known] = model_matrix(surfaces.coded[known], surfaces.exponents)
    # of about the size of the coded terms, as the check of the columns wants it
    turn = np.where(known, (place - place[known].mean()) / place.size, 0.0)
    blocks = surfaces.blocks
    own = np.empty((place.size, 0)) if blocks is None else block_contrasts(blocks.index)
    fit = fit_least_squares(
        np.hstack([terms[:, :1], own, terms[:, 1:], turn[:, None]]),
        np.where(known, surfaces.fitted + surfaces.residual, np.nan),
        n_baseline=1 + own.shape[1],
        block=None if blocks is None else blocks.index,
    )
    size = place.size
    slope = fit.coefficient[:, -1] / size
    deviation = np.sqrt(fit.covariance_factor[:, -1, -1])[fit.pattern] * fit.sigma / size
    judged = (fit.reason == 0) & (deviation > 0)
    t = np.divide(slope, deviation, out=np.full(slope.shape, np.nan), where=judged)
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)
    return Drift(slope, deviation, t, two_sided_p(t, freedom))
