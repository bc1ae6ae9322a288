r"""What shared errors do to numbers that are read at one point of the plane, or between two.

.. math::

    \frac{\delta E_{sec}}{E_{sec}} &= \frac{\delta T}{T} - \frac{\delta\varepsilon}{\varepsilon}
        - 2\frac{\delta d}{d} \\
    \frac{\delta E_{chord}}{E_{chord}} &= \frac{\delta T_2 - \delta T_1}{T_2 - T_1}
        - \frac{\delta\varepsilon_2 - \delta\varepsilon_1}{\varepsilon_2 - \varepsilon_1}
        - 2\frac{\delta d}{d}

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, eqs. 1 and 2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.record import Floats
from reduction.uncertainty.curves import by_diameter, diameter_error
from reduction.uncertainty.field import ErrorField
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors


def with_diameter(
    found: Contributions, errors: InstrumentErrors, values: dict[str, Floats], *, area: float
) -> Contributions:
    r"""Contributions with that of the diameter to what is divided by the area.

    .. math:: \delta y = -2 y \, \delta d / d

    Parameters
    ----------
    found : Contributions
        Of tension and strain, over the area already. [as quantity]
    errors : InstrumentErrors
        For the diameter.
    values : dict of str to ndarray
        Moduli and stresses themselves, by name; others do not know the diameter. [Pa]
    area : float
        Nominal. [m2]

    Returns
    -------
    contributions : Contributions
        As given where no error of the diameter is stated. [as quantity]

    Raises
    ------
    DataError
        If the area is not positive.

    Notes
    -----
    Eq. 2 of [2]_.

    Examples
    --------
    >>> none = Contributions((), {"modulus": np.empty((0, 1))})
    >>> errors = InstrumentErrors("new", diameter=2.5e-4)
    >>> print(with_diameter(none, errors, {"modulus": np.array([1e6])},
    ...     area=np.pi * 0.025**2 / 4).values["modulus"].round(3))
    [[-20000.]]
    """
    if not errors.diameter:
        return found
    rows = {}
    for name, array in found.values.items():
        own = (
            by_diameter(values[name], errors, area=area)
            if name in values
            else np.zeros(array.shape[1:])
        )
        rows[name] = np.concatenate([array, own[None]])
    return Contributions((*found.component, diameter_error(errors)), rows)


def section_contributions(errors: InstrumentErrors, *, area: float) -> Contributions:
    r"""Contributions to the diameter and the area of a specimen.

    .. math:: \delta A = 2 A \, \delta d / d

    Parameters
    ----------
    errors : InstrumentErrors
        For the diameter.
    area : float
        Nominal. [m2]

    Returns
    -------
    contributions : Contributions
        ``diameter`` [m] and ``area`` [m2]; no component where no error is stated.

    Raises
    ------
    DataError
        If the area is not positive.

    Notes
    -----
    Eq. 2 of [2]_.

    Examples
    --------
    >>> found = section_contributions(InstrumentErrors("new", diameter=1e-4), area=5e-4)
    >>> print(found.values["area"].round(9))
    [3.963e-06]
    """
    if not errors.diameter:
        return Contributions((), {"diameter": np.empty(0), "area": np.empty(0)})
    component = (diameter_error(errors),)
    rows = {
        "diameter": np.array([errors.diameter]),
        "area": -by_diameter(area, errors, area=area).reshape(1),
    }
    return Contributions(component, rows)


def stress_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    stress: ArrayLike,
    tension_slope: ArrayLike,
    area: float,
    strain_rate: ArrayLike = 0.0,
) -> Contributions:
    r"""Contributions to the stress at stated strains.

    .. math:: \delta\sigma = (\delta T - T' \delta\varepsilon - T' \dot\varepsilon \Delta t) / A
              - 2 \sigma \, \delta d / d

    Parameters
    ----------
    field : ErrorField
        At these strains.
    errors : InstrumentErrors
        For lag and diameter.
    stress : array_like, shape (...)
        Nominal. [Pa]
    tension_slope : array_like, shape (...)
        Of tension over strain there. [N]
    area : float
        Nominal. [m2]
    strain_rate : array_like, shape (...)
        At which it was stretched: tension that is logged late is lower. [s-1]

    Returns
    -------
    contributions : Contributions
        ``stress``. [Pa]

    Raises
    ------
    DataError
        If shapes differ, or the area is not positive.

    Notes
    -----
    First order ([1]_).

    Examples
    --------
    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", position_offset=0.01)
    >>> field = error_field(errors, model, strain=1.0, tension=500.0)
    >>> print(stress_contributions(field, errors, stress=1e6, tension_slope=400.0, area=5e-4)
    ...     .values["stress"])
    [-8000.]
    """
    value, slope = as_same_shape(stress=stress, tension_slope=tension_slope)
    rows = (field.tension - slope * field.strain) / area
    component = field.component
    if errors.lag:
        late = errors.lag * (1 - field.strain_by_tension * slope)
        own = np.broadcast_to(-late * slope * np.asarray(strain_rate) / area, value.shape)
        component = (*component, Component("lag", errors.tension_instrument))
        rows = np.concatenate([rows, own[None]])
    found = Contributions(component, {"stress": rows})
    return with_diameter(found, errors, {"stress": value}, area=area)


def secant_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    strain: ArrayLike,
    secant_modulus: ArrayLike,
    area: float,
) -> Contributions:
    """Contributions to stress over strain at points.

    Parameters
    ----------
    field : ErrorField
        At the points.
    errors : InstrumentErrors
        For the diameter.
    strain : array_like, shape (...)
        [1]
    secant_modulus : array_like, shape (...)
        [Pa]
    area : float
        Nominal. [m2]

    Returns
    -------
    contributions : Contributions
        ``secant_modulus``. [Pa]

    Raises
    ------
    DataError
        If shapes differ, or the area is not positive.

    Notes
    -----
    Eq. 1 of [2]_; first order ([1]_).

    Examples
    --------
    1 % of gain is 1 % of the secant; 10 mm on 1 m of gauge length are 1 % at 100 %.

    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, position_offset=0.01)
    >>> field = error_field(errors, model, strain=1.0, tension=500.0)
    >>> print(secant_contributions(field, errors, strain=1.0, secant_modulus=1e6, area=5e-4)
    ...     .values["secant_modulus"])
    [ 10000. -10000.]
    """
    at, modulus = as_same_shape(strain=strain, secant_modulus=secant_modulus)
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = (field.tension / area - modulus * field.strain) / at
    found = Contributions(field.component, {"secant_modulus": rows})
    return with_diameter(found, errors, {"secant_modulus": modulus}, area=area)


def chord_contributions(
    begin: ErrorField, end: ErrorField, *, stroke: ArrayLike, chord: ArrayLike
) -> Contributions:
    """Contributions to a difference of tension over the difference of strain beside it.

    Parameters
    ----------
    begin, end : ErrorField
        At the two points.
    stroke : array_like, shape (...)
        Strain at the end less that at the beginning. [1]
    chord : array_like, shape (...)
        Force per unit strain. [N]

    Returns
    -------
    contributions : Contributions
        ``chord``: over the area it is that of a modulus, but for the diameter. [N]

    Raises
    ------
    DataError
        If shapes differ.

    Notes
    -----
    First order ([1]_).  A zero of the load cell is in no difference of tension.

    Examples
    --------
    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, tension_offset=5.0)
    >>> low, high = (error_field(errors, model, strain=e, tension=800 * e) for e in (0.5, 1.0))
    >>> print(chord_contributions(low, high, stroke=0.5, chord=800.0).values["chord"])
    [8. 0.]
    """
    reach, slope = as_same_shape(stroke=stroke, chord=chord)
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = (end.tension - begin.tension - slope * (end.strain - begin.strain)) / reach
    return Contributions(begin.component, {"chord": rows})
