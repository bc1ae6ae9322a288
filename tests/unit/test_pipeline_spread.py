"""Unit tests of reduction.pipeline.spread."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.spread import strain_spread
from reduction.strain.model import StrainModel
from reduction.vocabulary import PHASE_VALUES

# slope of strain on the gauge length is -(p - p0) / L0^2: it depends on the sample
MODEL = StrainModel(
    "rope",
    "gauge-length",
    {"reference_position": 0.0, "gauge_length": 1.0},
    np.diag([0.0, 0.01**2]),
)
POSITION = np.array([0.0, 0.1, 0.3, 0.4, 0.9])
REST, CYCLING, HOLD = (PHASE_VALUES[name] for name in ("rest", "cycling", "hold"))


def located(declared=()):
    record = SimpleNamespace(
        tension_standard_uncertainty=declared, position_standard_uncertainty=np.nan
    )
    return SimpleNamespace(
        record=record, position=POSITION, tension=np.full((1, POSITION.size), 100.0)
    )


def test_one_value_a_specimen_is_the_root_mean_square_over_the_cycles():
    phase = np.array([REST, HOLD, CYCLING, CYCLING, REST], dtype=np.int8)
    found = strain_spread(located(), [MODEL], phase=phase)
    assert found == pytest.approx([0.01 * np.sqrt((0.3**2 + 0.4**2) / 2)], rel=1e-6)


def test_a_test_without_cycles_takes_all_but_the_rests():
    phase = np.array([REST, HOLD, HOLD, HOLD, REST], dtype=np.int8)
    found = strain_spread(located(), [MODEL], phase=phase)
    assert found == pytest.approx([0.01 * np.sqrt((0.1**2 + 0.3**2 + 0.4**2) / 3)], rel=1e-6)


def test_without_a_known_part_the_value_is_missing():
    bare = StrainModel("rope", "gauge-length", MODEL.coefficients)
    phase = np.full(POSITION.size, CYCLING, dtype=np.int8)
    assert np.isnan(strain_spread(located(), [bare], phase=phase)).all()
