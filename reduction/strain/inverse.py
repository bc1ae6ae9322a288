"""Length from strain: the strain correction the other way round.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1, Table 3.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats
from reduction.strain.evaluate import strain_by_model
from reduction.strain.model import StrainModel

# lengths that grow with the free length; the others of a method do not, or say nothing of splices
_SCALED = {
    "tension-driven": "relaxed_free_length",
    "strain-ratio": "relaxed_free_length",
    "gauge-length": "gauge_length",
}


def position_by_model(model: StrainModel, *, strain: ArrayLike, tension: ArrayLike) -> Floats:
    r"""Crosshead position, thimble to thimble, at which the free length has a strain.

    .. math:: p = \frac{\varepsilon - \varepsilon(0, F)}{\varepsilon(1, F) - \varepsilon(0, F)}

    Parameters
    ----------
    model : StrainModel
        Of the specimen; any method but an extensometer.
    strain : array_like, shape (...)
        Nominal strain of the free length. [1]
    tension : array_like, shape (...)
        At that strain; the splices of ``tension-driven`` stretch by it. [N]

    Returns
    -------
    position : ndarray, shape (...)
        Length with the splices. [m]

    Raises
    ------
    DataError
        If the method is an extensometer, which says nothing of the length of the specimen.

    Notes
    -----
    Every method is a straight line of strain on position at one tension, so that two
    positions give its inverse exactly, and the laws of the splices stand in one place.

    Examples
    --------
    Table 3 of [1]_, used tether: 103.2 % of the free length is 6.629 m from thimble to thimble.

    >>> line = StrainModel("used", "marks", {"free_length_intercept": -0.83512,
    ...     "free_length_slope": 0.90527, "relaxed_free_length": 2.542})
    >>> print(position_by_model(line, strain=[1.032], tension=[480.0]).round(3))
    [6.628]
    """
    if model.method == "extensometer":
        raise DataError(
            f"strain of '{model.specimen}' is from an extensometer, which does not know the length",
            needed="a strain method with a length: marks, strain-ratio, tension-driven, ...",
        )
    stretch, load = np.broadcast_arrays(
        np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    )
    at_zero = strain_by_model(model, position=np.zeros(load.shape), tension=load)
    at_one = strain_by_model(model, position=np.ones(load.shape), tension=load)
    return np.asarray((stretch - at_zero) / (at_one - at_zero), dtype=np.float64)


def with_free_length(model: StrainModel, free_length: float) -> StrainModel:
    """Model of a specimen that is like another one but longer: the same splices.

    Parameters
    ----------
    model : StrainModel
        Of the tested specimen.
    free_length : float
        Relaxed, splice toe to splice toe, of the new one. [m]

    Returns
    -------
    model : StrainModel
        With that length; marks and covariance, which are of the old one, left out.

    Raises
    ------
    DataError
        If the method knows no splice apart from the whole, or the length is not positive.

    Notes
    -----
    A line through the marks, and a constant fraction, hold for the length that was tested: the
    share of the splices is another in a longer tether ([1]_, Table 3: a third of 12 ft at rest).

    Examples
    --------
    >>> model = StrainModel("new", "strain-ratio", {"relaxed_free_length": 2.5,
    ...     "relaxed_splice_length": 1.2, "splice_strain_ratio": 0.2})
    >>> longer = with_free_length(model, 10.0)
    >>> print(position_by_model(longer, strain=1.0, tension=0.0).round(2))
    21.44
    """
    length = float(as_positive("free_length", free_length))
    name = _SCALED.get(model.method)
    if name is None:
        raise DataError(
            f"a strain model by {model.method} holds for the length that was tested",
            needed="tension-driven, strain-ratio or gauge-length",
            hint="These know the splices apart from the free length.",
        )
    coefficients = {**model.coefficients, name: length}
    if model.method == "gauge-length":
        # it begins at the gauge length where the position is a length, at zero where it is none
        old = model.coefficients["gauge_length"]
        begin = model.coefficients["reference_position"]
        coefficients["reference_position"] = begin * length / old
    return replace(
        model,
        coefficients=coefficients,
        covariance=np.empty((0, 0)),
        marks_from="none",
        mark_test=(),
        mark_hold=(),
        mark_position=np.empty(0),
        mark_strain=np.empty(0),
        mark_tension=np.empty(0),
        mark_strain_residual=np.empty(0),
        mark_load_cell=(),
        notes=(*model.notes, f"of another free length: {length:.4g} m"),
        splice_law={},
    )
