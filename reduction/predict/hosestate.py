"""Where a hose is, at a strain or at an event, and how its numbers move it from there.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.predict.cord import (
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    slackest_stretch_ratio,
)
from reduction.predict.cordload import cord_load, cord_stiffness
from reduction.predict.cordrates import (
    rise_of_cord,
    stretch_ratio_per_angle,
    stretch_ratio_per_cord_stretch,
)
from reduction.predict.helix import NEUTRAL_ANGLE
from reduction.predict.product import HoseDesign
from reduction.record import Floats

Rates = Mapping[str, Floats]


@dataclass(frozen=True)
class HoseState:
    """Where a hose is, and how each parameter moves it from there; ``columns`` adds an axis."""

    stretch: Floats
    cord_stretch: Floats
    cord_tension: Floats
    of_stretch: Rates
    of_cord_stretch: Rates
    of_cord_tension: Rates
    columns: bool = False


def as_number(value: ArrayLike, *, columns: bool) -> Floats:
    """Numbers of designs as float64, with an axis for strain where there are ``columns``."""
    array = np.asarray(value, dtype=np.float64)
    return array[..., None] if columns else array


def on_the_curve(design: HoseDesign, strain: Floats) -> HoseState:
    """Where hoses are at strains of their whole length."""
    angle, dead, load_scale, strain_scale = (
        as_number(one, columns=True)
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
    load = load_scale * cord_load(design.cord, at)
    stiffness = load_scale / strain_scale * cord_stiffness(design.cord, at)
    cosine, sine = np.cos(angle), np.sin(angle)
    by_stretch = rise_of_cord(stretch, cosine**2, sine**2) / cord
    per_strain = 1 / (1 - dead)
    of_stretch = {"strain": per_strain, "dead_length_share": (stretch - 1) * per_strain}
    of_cord = {name: by_stretch * rate for name, rate in of_stretch.items()}
    of_cord["wrap_angle"] = sine * cosine * (1 / stretch - stretch**2) / cord
    of_load = {name: stiffness * rate for name, rate in of_cord.items()}
    of_load["cord_load_scale"] = load / load_scale
    of_load["cord_strain_scale"] = -stiffness * at
    return HoseState(stretch, cord, load, of_stretch, of_cord, of_load, columns=True)


def at_deepest_slack(design: HoseDesign) -> HoseState:
    """Where the cords are slackest."""
    angle = np.asarray(design.wrap_angle, dtype=np.float64)
    stretch = slackest_stretch_ratio(angle)
    per_angle = 2 / 3 * stretch / (np.sin(angle) * np.cos(angle))
    return _slack(design, stretch, per_angle)


def at_pick_up(design: HoseDesign) -> HoseState:
    """Where the cords begin to carry."""
    angle = np.asarray(design.wrap_angle, dtype=np.float64)
    stretch = pick_up_stretch_ratio(angle)
    per_angle = 2 * np.tan(angle) / np.cos(angle) ** 2 / (2 * stretch + 1)
    return _slack(design, stretch, per_angle)


def _slack(design: HoseDesign, stretch: Floats, per_angle: Floats) -> HoseState:
    """Where the cords carry nothing; below the neutral angle the hose is at rest there."""
    is_above = np.asarray(design.wrap_angle) > NEUTRAL_ANGLE
    of_stretch = {
        "strain": 1 / (1 - np.asarray(design.dead_length_share, dtype=np.float64)),
        "wrap_angle": np.where(is_above, per_angle, 0.0),
    }
    return HoseState(stretch, np.ones(stretch.shape), np.zeros(stretch.shape), of_stretch, {}, {})


def at_cord_strain(design: HoseDesign, at: Floats) -> HoseState:
    """Where the cords are at a strain of their measured curve."""
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
    per_cord = stretch_ratio_per_cord_stretch(cord, angle)
    per_strain = 1 / (1 - dead)
    return HoseState(
        hose_stretch_ratio(cord, angle),
        cord,
        load_scale * load,
        of_stretch={
            "strain": per_strain,
            "wrap_angle": stretch_ratio_per_angle(cord, angle),
            "cord_strain_scale": per_cord * at,
        },
        of_cord_stretch={"strain": per_strain / per_cord, "cord_strain_scale": at},
        of_cord_tension={
            "strain": load_scale / strain_scale * slope * per_strain / per_cord,
            "cord_load_scale": load,
        },
    )
