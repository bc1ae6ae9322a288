"""Input and output of a hose prediction.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from math import pi
from typing import Literal

import numpy as np

from reduction.prediction.cord_curve import CordCurve
from reduction.record.arrays import require_of_design
from reduction.record.measurement import Bools, Floats, read_only_arrays

RubberLaw = Literal["neo-hookean", "linear", "linear-current", "hencky"]

HOSE_PARAMETERS = (
    "wrap_angle",
    "layer_diameter",
    "inner_diameter",
    "outer_diameter",
    "cords_per_length",
    "rubber_modulus",
    "cord_load_scale",
    "cord_strain_scale",
    "dead_length_share",
)
"""Design parameters that may be uncertain or calibrated; a layer diameter means both layers."""


@dataclass(frozen=True)
@read_only_arrays
class HoseDesign:
    """One hose, or many that share a cord curve and a rubber law.

    Parameters are floats or arrays that broadcast to the shape (...) of the designs.

    Parameters
    ----------
    wrap_angle : float or ndarray, shape (...)
        Angle of the cords at rest, from the hose axis. [rad]
    layer_diameter : tuple of 2 (float or ndarray, shape (...))
        Mean diameters of the inner and the outer cord layer at rest. [m]
    inner_diameter, outer_diameter : float or ndarray, shape (...)
        Diameters of the rubber wall at rest. [m]
    cords_per_length : float or ndarray, shape (...)
        Cords of the fabric per length across the cords. [m-1]
    cord_diameter : float or ndarray, shape (...)
        Diameter of one cord; affects the spacing only. [m]
    rubber_modulus : float or ndarray, shape (...)
        Young's modulus at small strain. [Pa]
    cord : CordCurve
        Load on one cord against its strain.
    rubber_law : {"neo-hookean", "linear", "linear-current", "hencky"}
        Law of the tension of the rubber wall.
    working_share : float
        Share of the break load of a cord at the safe working load. [1]
    cord_load_scale, cord_strain_scale : float or ndarray, shape (...)
        Factors on the two axes of the cord curve. [1]
    dead_length_share : float or ndarray, shape (...)
        Share of the relaxed length that does not stretch: the stretch-limited ends. [1]
    minimum_inner_diameter : float
        Smallest allowed bore; 0 where none is stated. [m]
    """

    wrap_angle: float | Floats
    layer_diameter: tuple[float | Floats, float | Floats]
    inner_diameter: float | Floats
    outer_diameter: float | Floats
    cords_per_length: float | Floats
    cord_diameter: float | Floats
    rubber_modulus: float | Floats
    cord: CordCurve
    rubber_law: RubberLaw = "neo-hookean"
    working_share: float = 1 / 3
    cord_load_scale: float | Floats = 1.0
    cord_strain_scale: float | Floats = 1.0
    dead_length_share: float | Floats = 0.0
    minimum_inner_diameter: float = 0.0

    def __post_init__(self) -> None:
        """Check ranges and the order of the diameters, and make the arrays read-only."""
        inner, outer = (np.asarray(one, dtype=np.float64) for one in self.layer_diameter)
        bore = np.asarray(self.inner_diameter, dtype=np.float64)
        skin = np.asarray(self.outer_diameter, dtype=np.float64)
        angle = np.asarray(self.wrap_angle, dtype=np.float64)
        _need("wrap_angle", angle, (angle > 0) & (angle < pi / 2), "between 0 and 90 deg")
        positive = {
            "inner_diameter": bore,
            "layer_diameter": inner,
            "outer_diameter": skin,
            "cords_per_length": self.cords_per_length,
            "cord_diameter": self.cord_diameter,
            "cord_load_scale": self.cord_load_scale,
            "cord_strain_scale": self.cord_strain_scale,
        }
        for name, value in positive.items():
            number = np.asarray(value, dtype=np.float64)
            _need(name, number, (number > 0) & np.isfinite(number), "above zero")
        modulus = np.asarray(self.rubber_modulus, dtype=np.float64)
        _need("rubber_modulus", modulus, (modulus >= 0) & np.isfinite(modulus), "zero or more")
        _need("layer_diameter", inner, inner > bore, "above inner_diameter")
        _need("layer_diameter", outer, outer >= inner, "the inner layer before the outer one")
        laid = float(np.max(outer))
        _need("outer_diameter", skin, skin > outer,
              f"above the diameter of the cord layers, {laid:g} m (wrap_diameter)")  # fmt: skip
        share = np.asarray(self.dead_length_share, dtype=np.float64)
        _need("dead_length_share", share, (share >= 0) & (share < 1), "from 0 to below 1")
        working = np.asarray(self.working_share)
        _need("working_share", working, (working > 0) & (working <= 1), "above 0, at most 1")
        bore_limit = np.asarray(self.minimum_inner_diameter)
        _need("minimum_inner_diameter", bore_limit, bore_limit >= 0, "zero or more")

    @property
    def wrap_diameter(self) -> Floats:
        """Mean of the two cord layers, shape (...). [m]."""
        first, second = self.layer_diameter
        return np.asarray((np.asarray(first, dtype=np.float64) + second) / 2)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Common shape of the designs; () for one."""
        numbers = [
            getattr(self, item.name)
            for item in fields(self)
            if item.name not in ("layer_diameter", "cord", "rubber_law")
        ]
        shapes = {np.shape(one) for one in (*numbers, *self.layer_diameter)}
        return np.broadcast_shapes(*shapes)


_UNITS = {"wrap_angle": "deg", "cords_per_length": "1/m", "rubber_modulus": "Pa"}
"""Units of the numbers that are neither diameters nor ratios."""


def _need(name: str, value: Floats, is_good: Bools, needed: str) -> None:
    unit = "m" if name.endswith("diameter") else _UNITS.get(name, "")
    require_of_design("a hose", name, value, is_good, needed, unit)


@dataclass(frozen=True)
@read_only_arrays
class HosePrediction:
    """Response of the hose at each strain.  Arrays have the shape (..., n_strain).

    Every load is NaN where the cords are broken; in the slack zone the rubber alone carries.

    Parameters
    ----------
    strain : ndarray, shape (n_strain,)
        Strain of the whole relaxed length, including dead ends. [1]
    free_strain : ndarray
        Strain of the part that stretches. [1]
    tension : ndarray
        Net axial load. [N]
    fill_pressure : ndarray
        Pressure in the bore, above that outside. [Pa]
    cord_tension : ndarray
        Tension of one cord. [N]
    cord_strain : ndarray
        Negative where the cord is slack. [1]
    cord_share, rubber_share : ndarray
        Shares of the net tension; for the cords, after the end cap. [1]
    end_cap_load : ndarray
        Part of the axial load of the cords that balances the pressure. [N]
    current_wrap_angle : ndarray
        From the axis; for a slack cord, that of its helix. [rad]
    cord_spacing : ndarray
        Distance between centres of neighbouring cords of one layer. [m]
    current_inner_diameter : ndarray
        Bore. [m]
    is_slack, is_broken, is_jammed, is_bore_too_small : ndarray of bool
        Cords carry no load; cords are beyond their curve; cords touch; bore is below its limit.
    """

    strain: Floats
    free_strain: Floats
    tension: Floats
    fill_pressure: Floats
    cord_tension: Floats
    cord_strain: Floats
    cord_share: Floats
    rubber_share: Floats
    end_cap_load: Floats
    current_wrap_angle: Floats
    cord_spacing: Floats
    current_inner_diameter: Floats
    is_slack: Bools
    is_broken: Bools
    is_jammed: Bools
    is_bore_too_small: Bools


@dataclass(frozen=True)
@read_only_arrays
class HoseEvent:
    """State at an event of the cords.  Arrays have the shape (...) of the designs."""

    strain: Floats
    tension: Floats
    fill_pressure: Floats
    cord_tension: Floats
    cord_strain: Floats


@dataclass(frozen=True)
class HoseEvents:
    """Cords are shortest, pick up, reach the working share of their break load, and break.

    ``deepest_slack`` and ``pick_up`` are at zero strain where the angle is not above
    54.7356 deg; ``working.tension`` is the safe working load.
    """

    deepest_slack: HoseEvent
    pick_up: HoseEvent
    working: HoseEvent
    cord_break: HoseEvent
