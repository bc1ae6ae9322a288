"""Strain at every sample from a fitted model, and where it is an extrapolation.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Bools, Floats
from reduction.settings import StrainMethod
from reduction.strain.methods import (
    gauge_length_strain,
    marked_line_strain,
    splice_ratio_strain,
)
from reduction.strain.model import StrainModel
from reduction.strain.splice import free_length_strain
from reduction.strain.tensiondriven import tension_driven_strain

_OF_POSITION: dict[StrainMethod, Callable[..., Floats]] = {
    "marks": marked_line_strain,
    "strain-ratio": splice_ratio_strain,
    "constant-fraction": free_length_strain,
    "gauge-length": gauge_length_strain,
}
# a crosshead that returns to its marks passes them by its own resolution; not an extrapolation
_MARGIN = 0.01


def strain_by_model(
    model: StrainModel,
    *,
    position: ArrayLike,
    tension: ArrayLike,
    measured_strain: ArrayLike | None = None,
) -> Floats:
    """Strain of one specimen by its model.

    Parameters
    ----------
    model : StrainModel
        From `reduction.strain.fit.fit_strain_model`.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Of this specimen; used by ``tension-driven`` alone. [N]
    measured_strain : array_like, shape (...), optional
        Channel of the extensometer, where that is the method. [1]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length. [1]

    Raises
    ------
    DataError
        If the method is ``extensometer`` and there is no measured strain, or a
        coefficient of the model is impossible.

    Notes
    -----
    Sample by sample, so that a block of a log gives what the whole log gives.
    NaN in, NaN out.

    Examples
    --------
    The line of Table 3 of [1]_, used tether, in metre:

    >>> line = StrainModel("used", "marks", {"free_length_intercept": -0.83512,
    ...     "free_length_slope": 0.90527, "relaxed_free_length": 2.542})
    >>> print(strain_by_model(line, position=[6.629], tension=[480.0]).round(3))
    [1.032]
    """
    if model.method == "extensometer":
        if measured_strain is None:
            raise DataError(
                f"strain of '{model.specimen}' is to come from an extensometer, and the log has "
                "none",
                needed="a strain channel in the layout, or another strain method",
            )
        return np.asarray(measured_strain, dtype=np.float64)
    if model.method == "tension-driven":
        return tension_driven_strain(position, tension, **model.coefficients)
    return _OF_POSITION[model.method](position, **model.coefficients)


def extrapolated(model: StrainModel, position: ArrayLike, tension: ArrayLike) -> Bools:
    """Samples outside the range of the marks.

    Parameters
    ----------
    model : StrainModel
        Fitted to marks; other models extrapolate nowhere.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Of this specimen. [N]

    Returns
    -------
    extrapolated : ndarray of bool, shape (...)
        True outside; False where the value is missing. [1]

    Raises
    ------
    DataError
        Never by itself.

    Notes
    -----
    ``tension-driven`` is bounded in tension, from slack to the highest marked
    tension; the others in position, between the stretched marks.  One per cent of
    the range is allowed for, since a crosshead that returns to its marks passes
    them by its resolution.

    Examples
    --------
    >>> line = StrainModel("used", "marks", position_low=5.9, position_high=7.35)
    >>> print(extrapolated(line, [3.74, 6.6, 7.36, 7.5], 4 * [450.0]))
    [ True False False  True]
    """
    if model.method == "tension-driven":
        values, low, high = np.asarray(tension), -np.inf, model.tension_high
        margin = _MARGIN * high
    else:
        values, low, high = np.asarray(position), model.position_low, model.position_high
        margin = _MARGIN * (high - low)
    outside: Bools = values > high + margin
    if np.isfinite(low):
        outside = outside | (values < low - margin)
    return outside


def strain_sensitivity_of(
    model: StrainModel, *, position: ArrayLike, tension: ArrayLike
) -> tuple[tuple[str, ...], Floats]:
    """Change of strain with each coefficient of a model.

    Parameters
    ----------
    model : StrainModel
        With coefficients.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Of this specimen. [N]

    Returns
    -------
    names : tuple of str
        Coefficients, in the order of ``model.covariance``. [1]
    sensitivity : ndarray, shape (n_coefficients, ...)
        Strain over coefficient. [SI]

    Raises
    ------
    DataError
        If a coefficient of the model is impossible.

    Notes
    -----
    With the covariance this gives the part of the uncertainty of strain that all
    samples share: it does not average out over cycles.  Central differences; the
    coefficients enter smoothly.

    Examples
    --------
    Standard uncertainty of strain from that of a gauge length of 1 m, 2 mm:

    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> names, slope = strain_sensitivity_of(model, position=[0.05], tension=[900.0])
    >>> variance = np.einsum("i...,ij,j...", slope, model.covariance, slope)
    >>> print(np.sqrt(variance).round(6))
    [0.0001]
    """
    names = tuple(model.coefficients)
    rows = []
    for name in names:
        value = model.coefficients[name]
        step = 1e-5 * (abs(value) or 1.0)
        high, low = (
            strain_by_model(
                replace(model, coefficients={**model.coefficients, name: value + sign * step}),
                position=position,
                tension=tension,
            )
            for sign in (1, -1)
        )
        rows.append((high - low) / (2 * step))
    shape = (0, *np.shape(position))
    return names, np.stack(rows) if rows else np.empty(shape)
