"""Units at the edge: text with a unit in, SI out, and SI to what a reader is shown.

Inside the package every number is SI.  The factors are pint's, which are exact
by definition for the pound-force, the inch and the foot.
"""

from __future__ import annotations

from reduction.units.display import UnitSystem, combined_unit, display_unit
from reduction.units.parse import parse_in_unit, parse_quantity
from reduction.units.scale import DIMENSIONS, Dimension, scale_of_unit, scale_to_si

__all__ = [
    "DIMENSIONS",
    "Dimension",
    "UnitSystem",
    "combined_unit",
    "display_unit",
    "parse_in_unit",
    "parse_quantity",
    "scale_of_unit",
    "scale_to_si",
]
