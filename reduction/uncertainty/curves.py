r"""What shared errors do to a curve of tension against strain, and to its slope.

A point of the branch moves by :math:`(\delta\varepsilon, \delta T)`; what is read at one strain
moves by

.. math:: \delta T|_\varepsilon = \delta T - T' \delta\varepsilon, \qquad
          \delta E = \frac{1}{A}\frac{d}{d\varepsilon}\left(\delta T|_\varepsilon\right)
                     - 2 E \frac{\delta d}{d}

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, eq. 2 and sec. 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive, as_same_shape
from reduction.record import Floats
from reduction.uncertainty.field import ErrorField
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors

Waveform = Literal["triangular", "sinusoidal", "other"]


def strain_rate_of_wave(
    strain: ArrayLike,
    *,
    frequency: float,
    mean_strain: float,
    strain_amplitude: float,
    waveform: Waveform,
    speed_ratio: float = 1.0,
) -> tuple[Floats, Floats]:
    r"""Speed of strain along a rising branch, and its slope over strain.

    .. math:: \dot\varepsilon = 4 r f \varepsilon_a \quad\text{or}\quad
              \dot\varepsilon = 2 \pi f \sqrt{\varepsilon_a^2 - (\varepsilon - \varepsilon_m)^2}

    Parameters
    ----------
    strain : array_like, shape (n,)
        On the branch. [1]
    frequency : float
        Of the cycles. [Hz]
    mean_strain, strain_amplitude : float
        Of the cycles. [1]
    waveform : {"triangular", "sinusoidal", "other"}
        An unknown one counts as triangular.
    speed_ratio : float
        r, speed of a ramp over that of one without a stop at its ends. [1]

    Returns
    -------
    strain_rate : ndarray, shape (n,)
        Zero beyond the ends of a sine. [s-1]
    slope : ndarray, shape (n,)
        Of the rate over strain. [s-1]

    Raises
    ------
    DataError
        If frequency or amplitude is not positive.

    Examples
    --------
    >>> rate, _ = strain_rate_of_wave([1.0], frequency=0.1, mean_strain=1.0,
    ...     strain_amplitude=0.25, waveform="triangular")
    >>> print(rate)
    [0.1]
    """
    as_positive("frequency", frequency)
    as_positive("strain_amplitude", strain_amplitude)
    away = np.asarray(strain, dtype=np.float64) - mean_strain
    if waveform != "sinusoidal":
        return np.full(away.shape, 4 * speed_ratio * frequency * strain_amplitude), np.zeros(
            away.shape
        )
    turn = 2 * np.pi * frequency
    rate = turn * np.sqrt(np.maximum(strain_amplitude**2 - away**2, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(rate > 0, -(turn**2) * away / rate, 0.0)
    return rate, slope


def diameter_error(errors: InstrumentErrors) -> Component:
    """Name the error of a diameter, with the degrees of freedom that it has.

    Parameters
    ----------
    errors : InstrumentErrors
        Stated, or of the scatter of readings. [m]

    Returns
    -------
    component : Component
        Of the specimen. [1]

    Raises
    ------
    AttributeError
        If there are no errors.

    Notes
    -----
    Readings less one, for their mean; what is stated counts as known.

    Examples
    --------
    >>> print(diameter_error(InstrumentErrors("new", diameter=1e-4, diameter_readings=3)))
    Component(source='diameter', of='new', number=0, degrees_of_freedom=2.0)
    """
    freedom = float(errors.diameter_readings - 1) if errors.diameter_readings else np.inf
    return Component("diameter", errors.specimen, degrees_of_freedom=freedom)


def by_diameter(modulus: ArrayLike, errors: InstrumentErrors, *, area: float) -> Floats:
    r"""Contribution of the diameter to moduli.

    .. math:: \delta E = -2 E \, \delta d / d

    Parameters
    ----------
    modulus : array_like, shape (...)
        Any modulus: a tension, or a slope of it, over the area. [Pa]
    errors : InstrumentErrors
        For the diameter.
    area : float
        Nominal. [m2]

    Returns
    -------
    contribution : ndarray, shape (...)
        [Pa]

    Raises
    ------
    DataError
        If the area is not positive.

    Notes
    -----
    Eq. 2 of [2]_: the area is that of the mean diameter.

    Examples
    --------
    >>> print(by_diameter(1e6, InstrumentErrors("new", diameter=1e-4), area=np.pi * 0.02**2 / 4))
    -10000.0
    """
    as_positive("area", area)
    return np.asarray(-2 * np.asarray(modulus) * errors.diameter / np.sqrt(4 * area / np.pi))


def curve_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    tangent_modulus: ArrayLike,
    modulus_slope: ArrayLike,
    area: float,
    strain_rate: ArrayLike = 0.0,
    strain_rate_slope: ArrayLike = 0.0,
) -> Contributions:
    r"""Contributions to tangent modulus and tension at given strains of a curve.

    Parameters
    ----------
    field : ErrorField
        At the points of the curve, shape (...).
    errors : InstrumentErrors
        For lag and diameter, which no point of the plane knows.
    tangent_modulus : array_like, shape (...)
        Of the curve. [Pa]
    modulus_slope : array_like, shape (...)
        Of the modulus over strain. [Pa]
    area : float
        Nominal. [m2]
    strain_rate, strain_rate_slope : array_like, shape (...)
        Signed: negative on a descending branch. [s-1]

    Returns
    -------
    contributions : Contributions
        ``tangent_modulus`` [Pa] and ``branch_tension`` [N].

    Raises
    ------
    DataError
        If shapes differ, or the area is not positive.

    Notes
    -----
    First order ([1]_).  Tension that is logged late stands lower on a rising branch and higher on
    a falling one; where the modulus is constant and the rate too, no modulus changes (the slope of
    the splices' share is left out: a hundredth of that).

    Examples
    --------
    1 % of gain is 1 % of modulus; 1 % of diameter is 2 %.

    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, diameter=2.5e-4)
    >>> found = curve_contributions(error_field(errors, model, strain=0.5, tension=900.0), errors,
    ...     tangent_modulus=1e6, modulus_slope=0.0, area=np.pi * 0.025**2 / 4)
    >>> print([one.source for one in found.component], found.values["tangent_modulus"].round(3))
    ['tension_gain', 'diameter'] [ 10000. -20000.]
    """
    as_positive("area", area)
    modulus, bend = as_same_shape(tangent_modulus=tangent_modulus, modulus_slope=modulus_slope)
    rise, curvature = area * modulus, area * bend
    at_strain = field.tension - rise * field.strain
    slope = (
        field.tension_slope * rise
        - rise * (field.strain_slope + field.strain_slope_over_tension * rise)
        - curvature * field.strain
    )
    component = list(field.component)
    tension, moduli = [*at_strain], [*(slope / area)]
    if errors.lag:
        rate, faster = np.asarray(strain_rate), np.asarray(strain_rate_slope)
        component.append(Component("lag", errors.tension_instrument))
        # splices that are taken to stretch by the late tension are late too
        late = errors.lag * (1 - field.strain_by_tension * rise)
        tension.append(-late * rise * rate)
        moduli.append(-late * (bend * rate + modulus * faster))
    if errors.diameter:
        component.append(diameter_error(errors))
        tension.append(np.zeros(modulus.shape))
        moduli.append(by_diameter(modulus, errors, area=area))
    return Contributions(
        tuple(component),
        {
            "tangent_modulus": _stacked(moduli, modulus),
            "branch_tension": _stacked(tension, modulus),
        },
    )


def _stacked(rows: Sequence[Floats], like: Floats) -> Floats:
    if not rows:
        return np.empty((0, *like.shape))
    return np.stack([np.broadcast_to(one, like.shape) for one in rows])
