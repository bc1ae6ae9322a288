"""Tethers of known law, for the tests of assemblies."""

import numpy as np

from reduction.lines.assembly import _Tether
from reduction.lines.composite import CurvePiece, _composite_curve
from reduction.stages.strain.strain_model import StrainModel


def curve_of(law, low=0.1, high=2.5, spread=0.0, n=200):
    at = np.linspace(low, high, n)
    return _composite_curve(
        [CurvePiece("T", "static", "ascending", at, law(at), np.full(n, spread))]
    )


def spring(length=1.0, constant=100.0, **curve):
    """A tether without splices, force constant * strain."""
    model = StrainModel("T", "gauge-length", {"reference_position": length, "gauge_length": length})
    return _Tether(curve_of(lambda at: constant * at, **curve), model)


DRIVEN = StrainModel(
    "T",
    "tension-driven",
    {
        "relaxed_free_length": 2.55,
        "relaxed_splice_length": 1.19,
        "splice_compliance": 0.00113,
        "splice_exponent": 0.86,
    },
)
RUBBER = _Tether(curve_of(lambda at: 400 * at + 80 * at**3), DRIVEN)
