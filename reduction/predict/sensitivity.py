r"""Derivatives of a hose prediction by the numbers of its design.

With :math:`P` the tension of a cord, :math:`d_w` the mean diameter of the layers and :math:`n`
the cords per length, the net tension and the fill pressure are

.. math::

    T &= 2\pi n d_w P\, G/\lambda_c + A\,R(\lambda_h), \qquad
    G = \lambda_h \cos^2\alpha_0 - \sin^2\alpha_0 / (2\lambda_h^2) \\
    p &= 2 n \left(d_1^{-1} + d_2^{-1}\right) P \sin^2\alpha_0 / (\lambda_h\lambda_c)

A number of the design acts directly, and through :math:`\lambda_h`, :math:`\lambda_c` and
:math:`P`.  On the curve the strain is held: the angle moves the cord strain, the dead length
the free stretch.  At an event the cord strain is held: the hose stretch follows.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   eq. 8, 24 and 26 (the equations that are differentiated, with the end cap by virtual work).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.predict.cordload import cord_strain_at
from reduction.predict.cordrates import rise_of_cord
from reduction.predict.hosestate import (
    HoseState,
    Rates,
    as_number,
    at_cord_strain,
    at_deepest_slack,
    at_pick_up,
    on_the_curve,
)
from reduction.predict.product import HOSE_PARAMETERS, HoseDesign
from reduction.predict.rubber import rubber_stiffness, rubber_tension
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class EventSensitivity:
    """Derivatives where something happens to the cords, shape (n_parameters, ...).

    Rows as `reduction.predict.product.HOSE_PARAMETERS`, in the unit of the quantity a unit of
    the parameter.  ``strain`` is of the whole length; ``stiffness``, shape (...), is the slope
    of the tension over it there, at pick-up that of the slack side. [N]
    """

    strain: Floats
    tension: Floats
    fill_pressure: Floats
    stiffness: Floats


@dataclass(frozen=True)
@read_only_arrays
class HoseSensitivity:
    """Derivatives of a prediction.

    Parameters
    ----------
    strain : ndarray, shape (n_strain,)
        Of the whole relaxed length, held. [1]
    tension, fill_pressure : ndarray, shape (n_parameters, ..., n_strain)
        Rows as `reduction.predict.product.HOSE_PARAMETERS`; NaN where the cords are broken.
        [N or Pa, a unit of the parameter]
    stiffness : ndarray, shape (..., n_strain)
        Slope of tension over strain. [N]
    deepest_slack, pick_up, working, cord_break : EventSensitivity
        Where the cords are shortest, pick up, reach the working share of their break load,
        and break.
    """

    strain: Floats
    tension: Floats
    fill_pressure: Floats
    stiffness: Floats
    deepest_slack: EventSensitivity
    pick_up: EventSensitivity
    working: EventSensitivity
    cord_break: EventSensitivity


def hose_sensitivity(design: HoseDesign, strain: ArrayLike) -> HoseSensitivity:
    r"""Derivatives by every number of the design that may be uncertain.

    Parameters
    ----------
    design : HoseDesign
        One hose, or many.
    strain : array_like, shape (n_strain,)
        Of the whole relaxed length. [1]

    Returns
    -------
    sensitivity : HoseSensitivity
        Of the curve at held strain, and of the events.

    Raises
    ------
    DataError
        If a strain is not finite, or -1 or less.

    Notes
    -----
    Eq. 8, 24 and 26 of [1]_ (module) differentiated.  A row ``layer_diameter`` moves both
    layers by the same length.  Every row holds the others: a layer diameter that comes out
    large *with its ribbon as cut* moves the wrap angle too, by the cotangent of the angle times
    the relative error (eq. 10).

    At pick-up the derivatives jump: a cord strain of exactly zero counts as slack, also of a
    hose below 54.7356 degrees at rest.  There the cords pick up at rest at any angle, and the
    strain of pick-up does not follow it.

    Examples
    --------
    Points of stretch a degree at the working load of the two hoses of [1]_, section 3.0, with
    a cord that has 9.5 % at a third of its break load; and for 1 % of cord strain.

    >>> from reduction.predict.cordcurve import CordCurve
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
    curve = on_the_curve(design, along)
    tension, pressure = _chain(design, curve)
    shape = (*design.shape, along.size)
    working = cord_strain_at(design.cord, design.working_share * design.cord.break_load)
    broken = np.where(np.isnan(curve.cord_tension), np.nan, 0.0)  # the rubber knows nothing of it
    return HoseSensitivity(
        strain=np.array(along),
        tension=_rows(tension, shape) + broken,
        fill_pressure=_rows(pressure, shape) + broken,
        stiffness=np.broadcast_to(tension["strain"], shape).copy(),
        deepest_slack=_of_event(design, at_deepest_slack(design)),
        pick_up=_of_event(design, at_pick_up(design)),
        working=_of_event(design, at_cord_strain(design, working)),
        cord_break=_of_event(design, at_cord_strain(design, np.asarray(design.cord.break_strain))),
    )


def _of_event(design: HoseDesign, state: HoseState) -> EventSensitivity:
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


def _chain(design: HoseDesign, state: HoseState) -> tuple[Rates, Rates]:
    """Tension and fill pressure by every parameter: directly, and through the state."""
    angle, first, second, bore, skin, density, modulus = (
        as_number(one, columns=state.columns)
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
    lever = rise_of_cord(stretch, cosine**2, sine**2) / cord
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
