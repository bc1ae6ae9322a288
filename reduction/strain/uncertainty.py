"""Standard uncertainty of strain: what all samples share, and what a reading adds.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] JCGM 100, "Guide to the expression of uncertainty in measurement," 2008, 5.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.record import Floats
from reduction.strain.evaluate import strain_by_model, strain_sensitivity_of
from reduction.strain.model import StrainModel

__all__ = ["strain_uncertainty_of"]


def strain_uncertainty_of(
    model: StrainModel,
    *,
    position: ArrayLike,
    tension: ArrayLike,
    position_uncertainty: float,
    tension_uncertainty: float,
) -> Floats:
    r"""Standard uncertainty of strain at given samples.

    .. math:: u^2 = s^T C s + (\partial\varepsilon/\partial p)^2 u_p^2
              + (\partial\varepsilon/\partial F)^2 u_F^2

    Parameters
    ----------
    model : StrainModel
        With coefficients and their covariance C.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Of this specimen. [N]
    position_uncertainty : float
        Standard uncertainty of a reading, as declared; NaN where not declared. [m]
    tension_uncertainty : float
        The same of tension. [N]

    Returns
    -------
    uncertainty : ndarray, shape (...)
        Standard uncertainty; NaN where none of its parts is known, for an extensometer, and
        where strain is NaN. [1]

    Raises
    ------
    DataError
        If a coefficient of the model is impossible.

    Notes
    -----
    First order ([2]_), the three parts taken as independent.  The coefficients are those of
    the tape readings of [1]_, Table 3: their part is shared by all samples and does not
    average out.  A part that is not known counts as zero where another is: what is not
    declared is not in it.

    Examples
    --------
    A gauge length of 1 m known to 2 mm, position to 1 mm, at 50 %: 1 and 1 mm per metre.

    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> print(strain_uncertainty_of(model, position=[0.5], tension=[900.0],
    ...     position_uncertainty=0.001, tension_uncertainty=np.nan).round(6))
    [0.001414]
    """
    place, load = np.broadcast_arrays(
        np.asarray(position, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    )
    if model.method == "extensometer":
        return np.full(place.shape, np.nan)
    parts: list[Floats] = []
    size = len(model.coefficients)
    if size and model.covariance.shape == (size, size) and model.covariance.any():
        _, slope = strain_sensitivity_of(model, position=place, tension=load)
        parts.append(np.einsum("i...,ij,j...->...", slope, model.covariance, slope))
    for shift_position, shift_tension in ((position_uncertainty, 0.0), (0.0, tension_uncertainty)):
        if not np.isfinite(shift_position + shift_tension):
            continue
        # a step of one standard uncertainty: finite where a law is steep near no tension
        high, low = (
            strain_by_model(
                model,
                position=place + sign * shift_position,
                tension=load + sign * shift_tension,
            )
            for sign in (1, -1)
        )
        parts.append(((high - low) / 2) ** 2)
    if not parts:
        return np.full(place.shape, np.nan)
    return np.asarray(np.sqrt(np.sum(parts, axis=0)))
