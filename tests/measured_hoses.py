"""Curves of a stretch hose made from known numbers, by formulas of their own.

Virtual work on a water-filled hose: constant volume of wall and bore gives the radial stretch
lambda_h**-1/2, so the cords stretch by lambda_c**2 = lambda_h**2 cos2 + sin2 / lambda_h; the net
tension is the derivative by length of what cords and rubber store.
"""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
from scipy.interpolate import PchipInterpolator

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_product import HoseDesign

INCH, POUND_FORCE = 0.0254, 4.4482216152605
CORD_STRAIN = np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22])
CORD_LOAD = np.array([0.0, 1.6, 5.0, 10.0, 18.0, 30.0]) * POUND_FORCE


@dataclass(frozen=True)
class Truth:
    """What a measured curve is generated from."""

    wrap_angle: float = np.radians(64.0)
    layer_diameter: tuple = (3.4 * INCH, 3.6 * INCH)
    inner_diameter: float = 2.5 * INCH
    outer_diameter: float = 5.0 * INCH
    cords_per_length: float = 34.0 / INCH
    rubber_modulus: float = 200 * 6894.757293168
    cord_load_scale: float = 1.0
    cord_strain_scale: float = 1.0
    dead_length_share: float = 0.0

    def but(self, **changes):
        return replace(self, **changes)

    def design(self, **changes):
        numbers = {name: getattr(self, name) for name in self.__dataclass_fields__}
        curve = CordCurve(CORD_STRAIN.copy(), CORD_LOAD.copy())
        return HoseDesign(**({"cord": curve, "cord_diameter": 0.022 * INCH} | numbers | changes))

    def cord_stretch(self, stretch):
        cos2, sin2 = np.cos(self.wrap_angle) ** 2, np.sin(self.wrap_angle) ** 2
        return np.sqrt(stretch**2 * cos2 + sin2 / stretch)

    def cord_load(self, cord):
        curve = PchipInterpolator(CORD_STRAIN, CORD_LOAD, extrapolate=False)
        return self.cord_load_scale * curve(np.maximum(cord - 1, 0) / self.cord_strain_scale)

    def tension(self, strain):
        """Net tension [N] at strains of the whole length."""
        stretch = 1 + np.asarray(strain) / (1 - self.dead_length_share)
        cos2, sin2 = np.cos(self.wrap_angle) ** 2, np.sin(self.wrap_angle) ** 2
        cord = self.cord_stretch(stretch)
        load = self.cord_load(cord)
        # cords in length L: fabric across the cords is pi d cos(a0) wide, each L / cos(a0) long
        n_cords = sum(pi * d * np.cos(self.wrap_angle) for d in self.layer_diameter)
        n_cords *= self.cords_per_length
        cord_rate = (stretch * cos2 - sin2 / (2 * stretch**2)) / cord  # d lambda_c / d lambda_h
        area = pi / 4 * (self.outer_diameter**2 - self.inner_diameter**2)
        rubber = area * self.rubber_modulus / 3 * (stretch - stretch**-2)
        return n_cords / np.cos(self.wrap_angle) * load * cord_rate + rubber

    def pressure(self, strain):
        """Fill pressure [Pa]: hoop force of the cords of each layer over its radius."""
        stretch = 1 + np.asarray(strain) / (1 - self.dead_length_share)
        cord = self.cord_stretch(stretch)
        load = self.cord_load(cord)
        # sine of the angle of the stretched hose: radius and cord length change it
        sine = np.sin(self.wrap_angle) / (cord * np.sqrt(stretch))
        pressure = 0.0
        for diameter in self.layer_diameter:
            radius = diameter / 2 / np.sqrt(stretch)
            n_cords = pi * diameter * np.cos(self.wrap_angle) * self.cords_per_length
            # a cord crosses the cut along the axis once per pitch
            pitch = 2 * pi * radius * np.sqrt(1 - sine**2) / sine
            pressure = pressure + n_cords / pitch * load * sine / radius
        return pressure

    def pick_up_strain(self):
        stretch = (-1 + np.sqrt(1 + 4 * np.tan(self.wrap_angle) ** 2)) / 2
        return (stretch - 1) * (1 - self.dead_length_share)
