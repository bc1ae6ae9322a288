"""One error at points of the plane: what it does to tension and strain, and the slopes of that.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3 (sensitivity coefficients).
"""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.uncertainty.product import Component

ROWS = (
    "tension", "strain", "tension_slope", "strain_slope", "strain_slope_over_tension",
)  # fmt: skip
"""Arrays of one error, in the order of the first axis of `field_rows`."""
FieldPart = tuple[Component, Floats]
"""An error and its rows."""
_STEP = 1e-4  # of the strain 1, and of the tension: for the slopes of the field


def field_rows(
    like: Floats,
    *,
    tension: Floats | float = 0.0,
    strain: Floats | float = 0.0,
    tension_slope: Floats | float = 0.0,
    strain_slope: Floats | float = 0.0,
    strain_slope_over_tension: Floats | float = 0.0,
) -> Floats:
    """The arrays of one error, shape (5, ...) in the order of `ROWS`; ``like`` has the shape."""
    given = (tension, strain, tension_slope, strain_slope, strain_slope_over_tension)
    return np.stack([np.broadcast_to(one, like.shape) for one in given])


def steps_of(load: Floats) -> Floats:
    """Steps of tension for a slope over it. [N]."""
    return np.asarray(_STEP * np.maximum(np.abs(load), 1.0))
