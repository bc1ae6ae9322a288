"""Hoses that give a wanted stretch, and a wanted load, where the cords bear their share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from reduction.errors import SettingsError
from reduction.predict.events import find_events
from reduction.predict.fabric import ribbon_width
from reduction.predict.hosedesign import design_angle, design_diameters, design_fabric
from reduction.predict.product import HoseDesign, HoseEvents
from reduction.prediction import HosePlan, HoseTarget


@dataclass(frozen=True)
class DesignedHose:
    """One way to reach a target; ``design`` and ``events`` are None where there is none.

    ``varied`` says what was changed: the wrap angle, and with it the fabric or the diameters.
    ``ribbon_width`` is of each cord layer [m]; ``refusal`` why there is no such hose.
    """

    varied: str
    design: HoseDesign | None
    events: HoseEvents | None
    ribbon_width: tuple[float, float]
    refusal: str


def design_hoses(plan: HosePlan, target: HoseTarget) -> tuple[DesignedHose, ...]:
    """Each way to reach a target from a hose: angle alone, with fabric, with diameters.

    Parameters
    ----------
    plan : HosePlan
        What the wanted hose has in common with it.
    target : HoseTarget
        Strain, and tension where one is wanted, at the working load.

    Returns
    -------
    designs : tuple of DesignedHose
        The first holds everything but the angle, so that its load is what it is.
    """
    like = plan.design
    ways: dict[str, Callable[[], HoseDesign]] = {
        "wrap angle": partial(design_angle, like, strain=target.strain)
    }
    if target.tension is not None:
        wanted = {"strain": target.strain, "tension": target.tension}
        ways["wrap angle and fabric"] = partial(design_fabric, like, **wanted)
        ways["wrap angle and diameters"] = partial(design_diameters, like, **wanted)
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
