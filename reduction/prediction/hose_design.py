r"""Design of hoses for a required stretch and load.

**From a required stretch and working load to a hose, in closed form.** The stretch alone determines
the wrap angle: at the working load the cords carry a known share of their break load, so their
stretch ratio :math:`\lambda_c` is known, and with the required :math:`\lambda_h`

.. math:: \cos^2\alpha_0 = \frac{\lambda_c^2 - 1/\lambda_h}{\lambda_h^2 - 1/\lambda_h}

The load is then linear in the cords per length, and, for constant wall thicknesses, linear in the
wrap diameter: with the thicknesses :math:`t_i` from bore to layers, :math:`t_s` between the layers
and :math:`t_o` from layers to skin, :math:`t = t_i + t_s + t_o`,

.. math:: T = C\,d_w + \pi t (d_w + t_o - t_i)\,\sigma_r

where C is the load of the cords per length of diameter and :math:`\sigma_r` that of the rubber per
area at rest.

The other parameters of the hose are those of a reference design.

A working share of a third refers to the *cords*.  The rubber of a hose that stretches far carries
half of the working load but a quarter of the load at the break, so the hose breaks at less than
three times its working load: 2.2 to 2.7 times with wrap angles of 64 to 68 degrees in a thick wall,
more than three below the neutral angle.  `reduction.prediction.hose_tension.find_events` gives both
loads.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, eq. 8
   and 26 solved for the construction; section 1.2.4 for the working load.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.cord_curve import cord_strain_at
from reduction.prediction.hose_geometry import ribbon_width, wrap_angle_for
from reduction.prediction.hose_prediction import HosePlan, HoseTarget
from reduction.prediction.hose_product import HoseDesign, HoseEvents
from reduction.prediction.hose_tension import find_events, loads_at, numbers_of
from reduction.prediction.rubber_wall import rubber_tension
from reduction.record.errors import SettingsError
from reduction.record.measurement import Bools, Floats


def _design_angle(like: HoseDesign, *, strain: ArrayLike) -> HoseDesign:
    """Wrap angle for a required stretch at the working load.

    Notes
    -----
    Eq. 8 of [1]_ (module).  Only the cord strain at the working share and the dead length
    matter; diameters, fabric and rubber affect only the load.

    Examples
    --------
    A cord with 9.5 % at a third of its break load: 30 % of stretch, and the 140 % of the tethers.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> like = HoseDesign(np.radians(68.0), (0.0889, 0.0889), 0.0635, 0.127,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> print(np.degrees(_design_angle(like, strain=[0.3, 1.4]).wrap_angle).round(2))
    [46.9 67.5]
    """
    wanted = _positive("strain", strain)
    stretch, cord_stretch, _ = _working_state(like, wanted)
    angle = wrap_angle_for(stretch, cord_stretch)
    _refuse(
        "strain", wanted, np.isfinite(angle), "has no wrap angle",
        needed=f"above {_first(cord_stretch - 1, ~np.isfinite(angle)):.4g} of the free length, "
        "which is what cords along the hose stretch at the working load",
        hint="Take a cord that stretches less, or a smaller working share.",
    )  # fmt: skip
    return replace(like, wrap_angle=angle)


def _design_fabric(like: HoseDesign, *, strain: ArrayLike, tension: ArrayLike) -> HoseDesign:
    """Wrap angle and cords per length for a required stretch and load, with constant diameters.

    Notes
    -----
    Eq. 26 of [1]_ (module), linear in the number of cords.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> like = HoseDesign(np.radians(68.0), (0.0889, 0.0889), 0.0635, 0.127,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> design = _design_fabric(like, strain=1.0, tension=[14e3, 16e3])
    >>> print(np.degrees(design.wrap_angle).round(2), (design.cords_per_length * 0.0254).round(1))
    63.45 [23.8 31.2]
    """
    load = _positive("tension", tension)
    angled = _design_angle(like, strain=strain)
    stretch, cords, rubber_stress = _loads(angled, strain)
    rubber = rubber_stress * numbers_of(angled).area
    _refuse(
        "tension", load, load > rubber, "is below that of the rubber alone",
        needed=f"above {_first(rubber, load <= rubber):.4g} N",
        hint="Take a thinner or softer wall, or a smaller hose.",
    )  # fmt: skip
    count = (load - rubber) / cords
    room = 1 / np.asarray(like.cord_diameter, dtype=np.float64)
    _refuse(
        "tension", load, count < room, "needs more cords than find room in two layers",
        needed=f"fewer than {_first(room + 0 * count, count >= room):.4g} cords a metre; "
        f"it takes {_first(count + 0 * room, count >= room):.4g}",
        hint="Take a larger layer diameter or a stronger cord.",
    )  # fmt: skip
    return _with_bore(replace(angled, cords_per_length=count), stretch)


def _design_diameters(like: HoseDesign, *, strain: ArrayLike, tension: ArrayLike) -> HoseDesign:
    """Wrap angle and diameters for a required stretch and load, with constant wall and fabric.

    Notes
    -----
    Eq. 26 of [1]_ (module); the area of the wall is also linear in the wrap diameter.

    Examples
    --------
    Similar to a hose of 3.5 in with half an inch of wall, in inches.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> like = HoseDesign(np.radians(68.0), (0.0889, 0.0889), 0.0762, 0.1016,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> design = _design_diameters(like, strain=1.4, tension=[8e3, 12e3])
    >>> print((design.wrap_diameter / 0.0254).round(2), (design.inner_diameter / 0.0254).round(2))
    [2.32 3.48] [1.82 2.98]
    """
    load = _positive("tension", tension)
    angled = _design_angle(like, strain=strain)
    stretch, cords, rubber_stress = _loads(angled, strain)
    first, second = (np.asarray(one, dtype=np.float64) for one in like.layer_diameter)
    inside = (first - like.inner_diameter) / 2
    between = (second - first) / 2
    outside = (np.asarray(like.outer_diameter, dtype=np.float64) - second) / 2
    wall = inside + between + outside
    a_diameter = cords * like.cords_per_length / like.wrap_diameter
    ring = pi * wall * rubber_stress
    diameter = (load - ring * (outside - inside)) / (a_diameter + ring)
    least = between + 2 * inside
    smallest = a_diameter * least + ring * (least + outside - inside)
    _refuse(
        "tension", load, diameter > least, "leaves no bore within such a wall",
        needed=f"above {_first(smallest, diameter <= least):.4g} N",
        hint="Take a thinner wall, or fewer cords per length.",
    )  # fmt: skip
    return _with_bore(
        replace(
            angled,
            layer_diameter=(diameter - between, diameter + between),
            inner_diameter=diameter - least,
            outer_diameter=diameter + between + 2 * outside,
        ),
        stretch,
    )


def _working_state(design: HoseDesign, strain: Floats) -> tuple[Floats, Floats, Floats]:
    """Stretch of hose and cord, and load on a cord, at the working load."""
    load = design.working_share * design.cord.break_load
    at = cord_strain_at(design.cord, load)
    free = 1 - np.asarray(design.dead_length_share, dtype=np.float64)
    stretch, cord_stretch = np.broadcast_arrays(
        1 + strain / free, 1 + np.asarray(design.cord_strain_scale, dtype=np.float64) * at
    )
    return stretch, cord_stretch, np.asarray(design.cord_load_scale, dtype=np.float64) * load


def _loads(design: HoseDesign, strain: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Stretch, load of the cords for one per length, load of the rubber per area, at work."""
    stretch, cord_stretch, load = _working_state(design, np.asarray(strain, dtype=np.float64))
    one = numbers_of(replace(design, cords_per_length=1.0))
    cords = loads_at(one, stretch, cord_stretch, load).cord_axial_load
    stress = rubber_tension(stretch, area=1.0, modulus=design.rubber_modulus, law=design.rubber_law)
    return stretch, cords, stress


def _with_bore(design: HoseDesign, stretch: Floats) -> HoseDesign:
    bore = np.asarray(design.inner_diameter) / np.sqrt(stretch)
    _refuse(
        "inner_diameter", bore, bore >= design.minimum_inner_diameter,
        "at the working load is below its limit",
        needed=f"{design.minimum_inner_diameter:.4g} m or more",
        hint="A hose of constant volume narrows by the root of its stretch.",
    )  # fmt: skip
    return design


def _positive(name: str, values: ArrayLike) -> Floats:
    wanted = np.asarray(values, dtype=np.float64)
    _refuse(name, wanted, np.isfinite(wanted) & (wanted > 0), "is none", needed="above zero")
    return wanted


def _first(values: Floats, bad: Bools) -> float:
    """Value of the first invalid design; of the first design where none is."""
    value, place = np.broadcast_arrays(values, bad)
    return float(value.flat[int(np.argmax(place))])


def _refuse(
    name: str, values: Floats, is_good: Bools, what: str, *, needed: str, hint: str | None = None
) -> None:
    if np.all(is_good):
        return
    bad = ~np.asarray(is_good)
    where = "" if bad.size == 1 else f" of {int(bad.sum())} of {bad.size} designs"
    raise SettingsError(
        f"wanted {name}{where} {what}", found=f"{_first(values, bad):g} in SI", needed=needed,
        hint=hint,
    )  # fmt: skip


@dataclass(frozen=True)
class DesignedHose:
    """One way to reach a target; ``design`` and ``events`` are None where there is none.

    ``varied`` says what was changed: the wrap angle, and with it the fabric or the diameters.
    ``ribbon_width`` is that of each cord layer [m]; ``refusal`` says why there is no such hose.
    """

    varied: str
    design: HoseDesign | None
    events: HoseEvents | None
    ribbon_width: tuple[float, float]
    refusal: str


def design_hoses(plan: HosePlan, target: HoseTarget) -> tuple[DesignedHose, ...]:
    """Each way to reach a target from a hose: angle alone, with fabric, with diameters."""
    like = plan.design
    ways: dict[str, Callable[[], HoseDesign]] = {
        "wrap angle": partial(_design_angle, like, strain=target.strain)
    }
    if target.tension is not None:
        wanted = {"strain": target.strain, "tension": target.tension}
        ways["wrap angle and fabric"] = partial(_design_fabric, like, **wanted)
        ways["wrap angle and diameters"] = partial(_design_diameters, like, **wanted)
    return tuple(_designed(varied, make) for varied, make in ways.items())


def _designed(varied: str, make: Callable[[], HoseDesign]) -> DesignedHose:
    try:
        design = make()
    except SettingsError as error:
        return DesignedHose(varied, None, None, (float("nan"), float("nan")), str(error))
    first, second = (
        float(ribbon_width(diameter, design.wrap_angle)) for diameter in design.layer_diameter
    )
    return DesignedHose(varied, design, find_events(design), (first, second), "")
