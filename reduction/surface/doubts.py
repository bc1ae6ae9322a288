"""What a reader has to doubt of surfaces that were fitted: values that cannot be, drift.

References
----------
.. [1] CG-D-39-80, sec. 4.3 (runs in the order of rising load, on one line) and 4.4 (surfaces of
   quantities that are above zero by nature).
"""

from __future__ import annotations

from itertools import product

import numpy as np

from reduction.errors import DataError
from reduction.surface.bands import evaluate_surfaces
from reduction.surface.drift import Drift
from reduction.surface.product import ResponseSurfaces

_DRIFTS = 0.05
"""A p below this is worth a word."""


def negative_surfaces(surfaces: ResponseSurfaces) -> tuple[str, ...]:
    """Surfaces that fall below zero among the levels, over runs that are all above it.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.

    Returns
    -------
    words : tuple of str
        One entry a response.

    Raises
    ------
    DataError
        If the surfaces have no factor.

    Notes
    -----
    Looked for at every combination of low, middle and high level: the corners, where a
    Box-Behnken design has no run, are the first to fall.  Of the quantities of [1]_ none can
    be below zero.

    Examples
    --------
    One less 1.1 of the factor is -0.1 at its high level, which no run reached.

    >>> from reduction.surface.surfaces import fit_surfaces
    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [0.8], [0.8]],
    ...     [[2.11, 2.09, 1.01, 0.99, 0.13, 0.11]], factor_names=["f"], response_names=["energy"],
    ...     low=[0.1], high=[0.5], units="coded")
    >>> [words[:48] for words in negative_surfaces(found)]
    ['the surface of energy goes below zero among the ']
    """
    grid = np.array(list(product((-1.0, 0.0, 1.0), repeat=surfaces.coded.shape[1])))
    lowest = evaluate_surfaces(surfaces, grid, units="coded").value.min(axis=1)
    measured = np.where(surfaces.transform_exponent == 1, 1.0, np.nan)[:, None] * (
        surfaces.fitted + surfaces.residual
    )
    return tuple(
        f"the surface of {name} goes below zero among the levels, where no run does: "
        'transform = "log" keeps it above'
        for name, low, values in zip(surfaces.response_names, lowest, measured, strict=True)
        if low < 0 and np.isfinite(values).any() and np.nanmin(values) > 0
    )


def drifting_responses(surfaces: ResponseSurfaces, drift: Drift) -> tuple[str, ...]:
    """Responses that drift over the order of the runs beyond their surface.

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    drift : Drift
        Of the same surfaces.

    Returns
    -------
    words : tuple of str
        One entry a response with a p below 0.05.

    Raises
    ------
    DataError
        If the drift is that of other surfaces.

    Notes
    -----
    One response in twenty is named though nothing drifts; runs in an order by load [1]_ hide
    a drift in the terms of the loads.

    Examples
    --------
    >>> from reduction.surface.designs import box_behnken
    >>> from reduction.surface.drift import drift_over_order
    >>> from reduction.surface.surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded[[12, 0, 5, 2, 7, 8, 1, 13, 3, 4, 10, 6, 9, 11, 14]]
    >>> noise = 0.1 * np.array([1, -1, 1, 1, -1, -1, 1, -1, 1, -1, 1, 1, -1, 1, -1])
    >>> found = fit_surfaces(runs, [3 + runs[:, 0] + 0.2 * np.arange(15) + noise], units="coded",
    ...     factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3, high=[1] * 3)
    >>> [words[:34] for words in drifting_responses(found, drift_over_order(found, range(15)))]
    ['y drifts over the order of the run']
    """
    if drift.p_value.shape != surfaces.reason.shape:
        raise DataError(
            "the drift is not that of the surfaces",
            found=f"{drift.p_value.size} responses",
            needed=f"{surfaces.reason.size}",
        )
    return tuple(
        f"{name} drifts over the order of the runs beyond its surface: {slope:+.3g} a run "
        f"(p {p:.2g})"
        for name, slope, p in zip(surfaces.response_names, drift.slope, drift.p_value, strict=True)
        if p < _DRIFTS
    )
