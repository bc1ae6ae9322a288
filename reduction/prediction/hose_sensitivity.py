r"""Derivatives of a hose prediction with respect to its design parameters.

**Stretch of a water-filled hose as a function of the stretch and the angle of its cords.**
Derivatives of the kinematics of `reduction.prediction.hose_geometry`.

**State of a hose at a strain or an event, and how its parameters change it.** With
:math:`P` the tension of a cord, :math:`d_w` the mean diameter of the layers and :math:`n` the cords
per length, the net tension and the fill pressure are

.. math::

    T &= 2\pi n d_w P\, G/\lambda_c + A\,R(\lambda_h), \qquad
    G = \lambda_h \cos^2\alpha_0 - \sin^2\alpha_0 / (2\lambda_h^2) \\
    p &= 2 n \left(d_1^{-1} + d_2^{-1}\right) P \sin^2\alpha_0 / (\lambda_h\lambda_c)

A design parameter acts directly, and through :math:`\lambda_h`, :math:`\lambda_c` and
:math:`P`.  On the curve the strain is constant: the angle changes the cord strain, the dead length
the free stretch.  At an event the cord strain is constant, and the hose stretch follows from it.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, sec. 1.2.1; eq. 8, 24
   and 26 (the equations that are differentiated, with the end cap by virtual work).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.cord_curve import cord_load, cord_stiffness, cord_strain_at
from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    slackest_stretch_ratio,
)
from reduction.prediction.hose_product import HOSE_PARAMETERS, HoseDesign
from reduction.prediction.rubber_wall import rubber_stiffness, rubber_tension
from reduction.record.arrays import as_finite
from reduction.record.measurement import Floats, read_only_arrays


def _stretch_ratio_per_angle(cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""Derivative of the stretch of a water-filled hose by the angle, at constant cord stretch.

    .. math:: \frac{\partial\lambda_h}{\partial a_0} = \frac{(\lambda_h^2 - 1/\lambda_h)\sin a_0
       \cos a_0}{\lambda_h \cos^2 a_0 - \sin^2 a_0/(2\lambda_h^2)}

    Notes
    -----
    Eq. (8) of [1]_ differentiated at constant :math:`\lambda_c`.

    Examples
    --------
    Points of stretch per degree, at a cord strain of 9.5 %:

    >>> print(np.radians(100 * _stretch_ratio_per_angle(1.095, np.radians([64.0, 68.0]))).round(1))
    [ 8.6 12.5]
    """
    stretch, cosine2, sine2 = _stretched(cord_stretch_ratio, wrap_angle)
    rise = (stretch**2 - 1 / stretch) * np.sqrt(cosine2 * sine2)
    return np.asarray(rise / _rise_of_cord(stretch, cosine2, sine2))


def _stretch_ratio_per_cord_stretch(cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""Derivative of the stretch of a water-filled hose by the stretch of its cords.

    .. math:: \frac{\partial\lambda_h}{\partial\lambda_c} =
       \frac{\lambda_c}{\lambda_h \cos^2 a_0 - \sin^2 a_0/(2\lambda_h^2)}

    Notes
    -----
    Eq. (8) of [1]_ differentiated at constant angle.

    Examples
    --------
    >>> print(_stretch_ratio_per_cord_stretch(1.095, np.radians([64.0, 68.0])).round(1))
    [3.7 4. ]
    """
    stretch, cosine2, sine2 = _stretched(cord_stretch_ratio, wrap_angle)
    return np.asarray(np.asarray(cord_stretch_ratio) / _rise_of_cord(stretch, cosine2, sine2))


def _rise_of_cord(stretch: Floats, cosine2: Floats, sine2: Floats) -> Floats:
    """Half the derivative of lambda_c squared: lambda_c times d lambda_c / d lambda_h."""
    return np.asarray(stretch * cosine2 - sine2 / (2 * stretch**2))


def _stretched(
    cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Stretch of the hose, and squares of cosine and sine of the checked angle."""
    stretch = hose_stretch_ratio(cord_stretch_ratio, wrap_angle)
    angle = np.asarray(wrap_angle, dtype=np.float64)
    return stretch, np.asarray(np.cos(angle) ** 2), np.asarray(np.sin(angle) ** 2)


Rates = Mapping[str, Floats]


@dataclass(frozen=True)
class _HoseState:
    """State of a hose, and its derivatives by each parameter; ``columns`` adds an axis."""

    stretch: Floats
    cord_stretch: Floats
    cord_tension: Floats
    of_stretch: Rates
    of_cord_stretch: Rates
    of_cord_tension: Rates
    columns: bool = False


def _as_number(value: ArrayLike, *, columns: bool) -> Floats:
    """Design parameters as float64, with an axis for strain where there are ``columns``."""
    array = np.asarray(value, dtype=np.float64)
    return array[..., None] if columns else array


Beside = Callable[[Floats], tuple[Floats, Floats]]
"""Load and stiffness to be added to those of one cord, at strains on its curve."""


def _on_the_curve(design: HoseDesign, strain: Floats, beside: Beside | None = None) -> _HoseState:
    """State of hoses at strains of their whole length."""
    angle, dead, load_scale, strain_scale = (
        _as_number(one, columns=True)
        for one in (
            design.wrap_angle,
            design.dead_length_share,
            design.cord_load_scale,
            design.cord_strain_scale,
        )
    )
    stretch = 1 + strain / (1 - dead)
    cord = cord_stretch_ratio(stretch, angle)
    at = (cord - 1) / strain_scale
    one, slope = cord_load(design.cord, at), cord_stiffness(design.cord, at)
    if beside is not None:
        added, added_slope = beside(at)
        one, slope = one + added, slope + added_slope
    load, stiffness = load_scale * one, load_scale / strain_scale * slope
    cosine, sine = np.cos(angle), np.sin(angle)
    by_stretch = _rise_of_cord(stretch, cosine**2, sine**2) / cord
    per_strain = 1 / (1 - dead)
    of_stretch = {"strain": per_strain, "dead_length_share": (stretch - 1) * per_strain}
    of_cord = {name: by_stretch * rate for name, rate in of_stretch.items()}
    of_cord["wrap_angle"] = sine * cosine * (1 / stretch - stretch**2) / cord
    of_load = {name: stiffness * rate for name, rate in of_cord.items()}
    of_load["cord_load_scale"] = load / load_scale
    of_load["cord_strain_scale"] = -stiffness * at
    return _HoseState(stretch, cord, load, of_stretch, of_cord, of_load, columns=True)


def _at_deepest_slack(design: HoseDesign) -> _HoseState:
    """State where the cords are slackest."""
    angle = np.asarray(design.wrap_angle, dtype=np.float64)
    stretch = slackest_stretch_ratio(angle)
    per_angle = 2 / 3 * stretch / (np.sin(angle) * np.cos(angle))
    return _slack(design, stretch, per_angle)


def _at_pick_up(design: HoseDesign) -> _HoseState:
    """State where the cords begin to carry."""
    angle = np.asarray(design.wrap_angle, dtype=np.float64)
    stretch = pick_up_stretch_ratio(angle)
    per_angle = 2 * np.tan(angle) / np.cos(angle) ** 2 / (2 * stretch + 1)
    return _slack(design, stretch, per_angle)


def _slack(design: HoseDesign, stretch: Floats, per_angle: Floats) -> _HoseState:
    """State with unloaded cords; below the neutral angle the hose is at rest there."""
    is_above = np.asarray(design.wrap_angle) > NEUTRAL_ANGLE
    of_stretch = {
        "strain": 1 / (1 - np.asarray(design.dead_length_share, dtype=np.float64)),
        "wrap_angle": np.where(is_above, per_angle, 0.0),
    }
    return _HoseState(stretch, np.ones(stretch.shape), np.zeros(stretch.shape), of_stretch, {}, {})


def _at_cord_strain(design: HoseDesign, at: Floats) -> _HoseState:
    """State with the cords at a strain of their measured curve."""
    angle, load_scale, strain_scale, dead = (
        np.asarray(one, dtype=np.float64)
        for one in (
            design.wrap_angle,
            design.cord_load_scale,
            design.cord_strain_scale,
            design.dead_length_share,
        )
    )
    load, slope = cord_load(design.cord, at), cord_stiffness(design.cord, at)
    cord = 1 + strain_scale * at
    per_cord = _stretch_ratio_per_cord_stretch(cord, angle)
    per_strain = 1 / (1 - dead)
    return _HoseState(
        hose_stretch_ratio(cord, angle),
        cord,
        load_scale * load,
        of_stretch={
            "strain": per_strain,
            "wrap_angle": _stretch_ratio_per_angle(cord, angle),
            "cord_strain_scale": per_cord * at,
        },
        of_cord_stretch={"strain": per_strain / per_cord, "cord_strain_scale": at},
        of_cord_tension={
            "strain": load_scale / strain_scale * slope * per_strain / per_cord,
            "cord_load_scale": load,
        },
    )


@dataclass(frozen=True)
@read_only_arrays
class EventSensitivity:
    """Derivatives at the events of the cords, shape (n_parameters, ...).

    Rows as in `reduction.prediction.hose_product.HOSE_PARAMETERS`, in the unit of the quantity per
    unit of the parameter.  ``strain`` refers to the whole length; ``stiffness``, shape (...), is
    the slope of the tension over it there, at pick-up that on the slack side. [N]
    """

    strain: Floats
    tension: Floats
    fill_pressure: Floats
    stiffness: Floats


@dataclass(frozen=True)
@read_only_arrays
class _HoseSensitivity:
    """Derivatives of a prediction."""

    strain: Floats
    tension: Floats
    fill_pressure: Floats
    stiffness: Floats
    deepest_slack: EventSensitivity
    pick_up: EventSensitivity
    working: EventSensitivity
    cord_break: EventSensitivity


def curve_sensitivity(
    design: HoseDesign, strain: Floats, beside: Beside | None = None
) -> tuple[Rates, Rates]:
    """Derivatives of tension and of fill pressure along the curve alone, by name.

    Notes
    -----
    As `hose_sensitivity`, and by ``strain``; a parameter without effect is left out.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> tension, pressure = curve_sensitivity(design, np.array([0.5]))
    >>> print(sorted(set(tension) - set(pressure)))
    ['inner_diameter', 'outer_diameter', 'rubber_modulus']
    """
    return _chain(design, _on_the_curve(design, strain, beside))


def hose_sensitivity(design: HoseDesign, strain: ArrayLike) -> _HoseSensitivity:
    r"""Derivatives with respect to every uncertain design parameter.

    Parameters
    ----------
    design : HoseDesign
        One hose, or many.
    strain : array_like, shape (n_strain,)
        Strain of the whole relaxed length. [1]

    Returns
    -------
    sensitivity : HoseSensitivity
        Derivatives of the curve at constant strain, and of the events.

    Raises
    ------
    DataError
        If a strain is not finite, or -1 or less.

    Notes
    -----
    Eq. 8, 24 and 26 of [1]_ (module) differentiated.  A row ``layer_diameter`` changes both layers
    by the same length.  In every row the other parameters are constant: a layer diameter that
    turns out large *with its ribbon as cut* also changes the wrap angle, by the cotangent of the
    angle times the relative error (eq. 10).

    At pick-up the derivatives jump: a cord strain of exactly zero counts as slack, also for a
    hose below 54.7356 degrees at rest.  There the cords pick up at rest at any angle, and the
    strain of pick-up does not depend on it.

    Examples
    --------
    Points of stretch per degree at the working load of the two hoses of [1]_, section 3.0, with
    a cord that has 9.5 % at a third of its break load; and for 1 % of cord strain.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> design = HoseDesign(np.radians([64.0, 68.0]), (0.0889, 0.0889), 0.0635, 0.127,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> rows = dict(zip(HOSE_PARAMETERS, hose_sensitivity(design, [0.5]).working.strain))
    >>> print(np.radians(100 * rows["wrap_angle"]).round(1), rows["rubber_modulus"])
    [ 8.6 12.5] [0. 0.]
    >>> print((rows["cord_strain_scale"] / 0.095).round(1))
    [3.7 4. ]
    """
    along = as_finite("strain", strain)
    curve = _on_the_curve(design, along)
    tension, pressure = _chain(design, curve)
    shape = (*design.shape, along.size)
    working = cord_strain_at(design.cord, design.working_share * design.cord.break_load)
    broken = np.where(np.isnan(curve.cord_tension), np.nan, 0.0)  # the rubber curve has no break
    return _HoseSensitivity(
        strain=np.array(along),
        tension=_rows(tension, shape) + broken,
        fill_pressure=_rows(pressure, shape) + broken,
        stiffness=np.broadcast_to(tension["strain"], shape).copy(),
        deepest_slack=_of_event(design, _at_deepest_slack(design)),
        pick_up=_of_event(design, _at_pick_up(design)),
        working=_of_event(design, _at_cord_strain(design, working)),
        cord_break=_of_event(design, _at_cord_strain(design, np.asarray(design.cord.break_strain))),
    )


def _of_event(design: HoseDesign, state: _HoseState) -> EventSensitivity:
    free = 1 - np.asarray(design.dead_length_share, dtype=np.float64)
    of_strain = {name: free * rate for name, rate in state.of_stretch.items()}
    of_strain["dead_length_share"] = 1 - state.stretch
    tension, pressure = _chain(design, state)
    return EventSensitivity(
        strain=_rows(of_strain, design.shape),
        tension=_rows(tension, design.shape),
        fill_pressure=_rows(pressure, design.shape),
        stiffness=np.broadcast_to(tension["strain"], design.shape).copy(),
    )


def _chain(design: HoseDesign, state: _HoseState) -> tuple[Rates, Rates]:
    """Tension and fill pressure by every parameter: directly, and through the state."""
    angle, first, second, bore, skin, density, modulus = (
        _as_number(one, columns=state.columns)
        for one in (
            design.wrap_angle,
            *design.layer_diameter,
            design.inner_diameter,
            design.outer_diameter,
            design.cords_per_length,
            design.rubber_modulus,
        )
    )
    stretch, cord, load = state.stretch, state.cord_stretch, state.cord_tension
    cosine, sine = np.cos(angle), np.sin(angle)
    lever = _rise_of_cord(stretch, cosine**2, sine**2) / cord
    hoop = sine**2 / (stretch * cord)
    around = pi * density * (first + second)
    inverse = 2 * density * (1 / first + 1 / second)
    area = pi / 4 * (skin**2 - bore**2)
    law = design.rubber_law
    stress = rubber_tension(stretch, area=1.0, modulus=modulus, law=law)

    tension = {
        "wrap_angle": -around * load * cosine * sine * (2 * stretch + stretch**-2) / cord,
        "layer_diameter": 2 * pi * density * load * lever,
        "inner_diameter": -pi / 2 * bore * stress,
        "outer_diameter": pi / 2 * skin * stress,
        "cords_per_length": around / density * load * lever,
        "rubber_modulus": rubber_tension(stretch, area=area, modulus=1.0, law=law),
    }
    pressure = {
        "wrap_angle": inverse * load * 2 * sine * cosine / (stretch * cord),
        "layer_diameter": -2 * density * (first**-2 + second**-2) * load * hoop,
        "cords_per_length": inverse / density * load * hoop,
    }
    by_stretch = around * load * (cosine**2 + sine**2 / stretch**3) / cord + rubber_stiffness(
        stretch, area=area, modulus=modulus, law=law
    )
    steps = (
        (state.of_stretch, by_stretch, -inverse * load * hoop / stretch),
        (state.of_cord_stretch, -around * load * lever / cord, -inverse * load * hoop / cord),
        (state.of_cord_tension, around * lever, inverse * hoop),
    )
    for rates, of_tension, of_pressure in steps:
        for name, rate in rates.items():
            tension[name] = tension.get(name, 0.0) + of_tension * rate
            pressure[name] = pressure.get(name, 0.0) + of_pressure * rate
    return tension, pressure


def _rows(of: Mapping[str, Floats], shape: tuple[int, ...]) -> Floats:
    table = np.zeros((len(HOSE_PARAMETERS), *shape))
    for place, name in enumerate(HOSE_PARAMETERS):
        table[place, ...] = of.get(name, 0.0)
    return table
