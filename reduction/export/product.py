"""What a mooring code is told of a line: one curve, its range, its dynamics, its properties.

References
----------
.. [1] M. Bigon and G. Regazzoni, "The Morrow Guide to Knots," Quill, New York, 1982, p. 14,
   "Comparison between fibers used in ropemaking."
"""

from __future__ import annotations

import math
import re
import unicodedata
from dataclasses import dataclass, field

from reduction.errors import SettingsError
from reduction.export.dynamics import Syrope, Viscoelasticity
from reduction.export.spread import CurveSpread
from reduction.record import Floats, read_only_arrays

SEA_WATER = 1025.0
"""Density that turns a wet mass into a displaced volume. [kg m-3]"""
FIBRE_DENSITY = {"nylon": 1140.0, "polyester": 1380.0}
"""By material; specific gravity of [1]_. [kg m-3]"""


@dataclass(frozen=True)
class Hydrodynamics:
    """Drag and added-mass coefficients, across the line and along it, and where they are from.

    Drag across refers to diameter times length, drag along to pi times that, as MoorDyn has it.
    """

    normal_drag: float
    axial_drag: float
    normal_added_mass: float
    axial_added_mass: float
    source: str


CYLINDER = Hydrodynamics(
    1.2, 0.0, 1.0, 0.0, "assumed, not measured: a smooth cylinder across the flow, none along it"
)


@dataclass(frozen=True)
@read_only_arrays
class ExportLine:
    """A line as a mooring code takes it.

    Parameters
    ----------
    name : str
        Becomes the line type; other signs than letters, digits, ``_`` and ``-`` become ``_``.
    strain, tension : ndarray, shape (n_points,)
        One curve, strain rising, tension not falling. [1], [N]
    curve : str
        What it is, in words: which branch, which cycles, or the mean of what. Never a loop.
    tested : tuple of float
        Least and greatest strain that was tested; NaN where nothing was. [1]
    diameter : float
        NaN where not stated. [m]
    linear_density, wet_linear_density : float
        In air, and less the displaced water; NaN where not stated. [kg m-1]
    rated_break_strength : float
        NaN where not stated. [N]
    unstretched_length : float
        Of the whole line; NaN where a curve holds for any length. [m]
    material : str
        Of the fibre, where it is stated.
    viscoelasticity : Viscoelasticity, optional
        Where it was found.
    syrope : Syrope, optional
        Where it is known.
    spread : CurveSpread, optional
        Uncertainty of the tensions, where it is known.
    hydrodynamics : Hydrodynamics
        With their source.
    sources : tuple of str
        Where every number came from, over which range, which errata touch it.
    notes : tuple of str
        Joins, gaps, what else to know.
    is_synthetic : bool
        Nothing was tested: the numbers were made.
    """

    name: str
    strain: Floats
    tension: Floats
    curve: str
    tested: tuple[float, float]
    diameter: float = math.nan
    linear_density: float = math.nan
    wet_linear_density: float = math.nan
    rated_break_strength: float = math.nan
    unstretched_length: float = math.nan
    material: str = ""
    viscoelasticity: Viscoelasticity | None = None
    syrope: Syrope | None = None
    spread: CurveSpread | None = None
    hydrodynamics: Hydrodynamics = field(default_factory=lambda: CYLINDER)
    sources: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False

    def __post_init__(self) -> None:
        """Check that somebody has said what the curve is and where it is from."""
        for name, needed in (
            ("name", "letters or digits"),
            ("curve", "a branch or a mean, in words"),
        ):
            if not re.search(r"\w", getattr(self, name)):
                raise SettingsError(f"a line for export has no {name}", needed=needed)
        if self.wet_linear_density >= self.linear_density:
            raise SettingsError(
                f"{self.name} is not lighter in water than in air",
                found=f"{self.wet_linear_density:g} kg/m in water, {self.linear_density:g} kg/m in "
                "air",
                needed="a wet linear density below the dry one",
            )
        if not self.sources:
            raise SettingsError(f"{self.name} has no source", needed="where its numbers are from")

    @property
    def identifier(self) -> str:
        """The name as one ASCII word that every code takes; accents are left away."""
        bare = unicodedata.normalize("NFKD", self.name)
        bare = "".join(sign for sign in bare if not unicodedata.combining(sign))
        word = re.sub(r"[^A-Za-z0-9_-]+", "_", re.sub("-{2,}", "-", bare)).strip("-")
        if not word.strip("_"):
            raise SettingsError(
                "the name has no sign that a mooring code takes", found=self.name,
                needed="letters A to Z or digits", hint="csv, json and netcdf take any name.",
            )  # fmt: skip
        return word

    @property
    def volume_diameter(self) -> tuple[float, str]:
        """Diameter of the cylinder that displaces as much water, and how it was found. [m]."""
        displaced = (self.linear_density - self.wet_linear_density) / SEA_WATER
        words = f"dry and wet mass in water of {SEA_WATER:g} kg/m3"
        density = FIBRE_DENSITY.get(self.material.strip().lower(), math.nan)
        if not math.isfinite(displaced):
            displaced = self.linear_density / density
            words = (
                f"the mass a length and the density of {self.material} fibre, {density:g} kg/m3 "
                "(Bigon and Regazzoni, The Morrow Guide to Knots, p. 14), since no wet mass is "
                "stated"
            )
        if displaced > 0:
            diameter = math.sqrt(4 * displaced / math.pi)
            nominal = "" if math.isnan(self.diameter) else (
                f"; drag refers to it, and not to the nominal {1000 * self.diameter:.4g} mm"
            )  # fmt: skip
            found = f"{1000 * diameter:.4g} mm, of the displaced volume"
            return diameter, f"diameter: {found}, from {words}{nominal}"
        return (
            self.needed("diameter"),
            "diameter: nominal; the displaced volume of a rope is smaller",
        )

    def needed(self, name: str) -> float:
        """A property that a format cannot do without; `SettingsError` where it is not stated."""
        value = float(getattr(self, name))
        if not (math.isfinite(value) and value > 0):
            raise SettingsError(
                f"the {name.replace('_', ' ')} of {self.name} is not known, and this format needs "
                "it",
                needed=f"{name} above zero",
                hint=f"Give --{name.replace('_', '-')} with a unit.",
            )
        return value
