"""Contributions to a slow pull, against the pull fitted again to a log with that one error."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors, merged
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.slow_pull import (
    fit_pull,
    quasi_static_spring_constant,
    strain_at_break_share,
    strain_at_tension,
)
from reduction.uncertainty.errors_of_cycles import errors_of_pull

MODEL = StrainModel("rope", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
LOAD = np.linspace(0.0, 2000.0, 4001)
STRAIN = -4.13e-4 + 1.389e-4 * LOAD - 3.906e-8 * LOAD**2 + 3.795e-12 * LOAD**3
STRENGTH, SHARES = 6400.0, np.array([0.1, 0.2, 0.25])
GRID = np.linspace(100.0, 1900.0, 10)
ERRORS = {
    "tension_gain": 1e-3,
    "tension_offset": 1.0,
    "position_gain": 1e-3,
    "position_offset": 1e-4,
    "rated_break_strength": 1e-3,
}


def numbers(source="", size=0.0):
    load = LOAD * (1 + (size if source == "tension_gain" else 0.0))
    load = load + (size if source == "tension_offset" else 0.0)
    position = 2.0 * STRAIN * (1 + (size if source == "position_gain" else 0.0))
    position = position + (size if source == "position_offset" else 0.0)
    strength = STRENGTH * (1 + (size if source == "rated_break_strength" else 0.0))
    pull = replace(
        fit_pull(np.arange(float(LOAD.size)), position / 2.0, load),
        tension_low=-10.0, tension_high=2010.0,
    )  # fmt: skip
    return pull, {
        "quasi_static_spring_constant": quasi_static_spring_constant(pull, GRID)[0],
        "quasi_static_strain": strain_at_tension(pull, GRID)[0],
        "pull_strain_coefficient": pull.strain_coefficient,
        "strain_at_break_share": strain_at_break_share(pull, SHARES, rated_break_strength=strength)[
            0
        ],
    }


@pytest.mark.parametrize("source", ERRORS)
def test_a_slow_pull_changes_as_its_log_says(source):
    size = ERRORS[source]
    pull, exact = numbers()
    above, below = (numbers(source, way * size)[1] for way in (1, -1))
    parts = errors_of_pull(
        pull, InstrumentErrors("rope", **{source: size}), MODEL,
        tension=GRID, share=SHARES, rated_break_strength=STRENGTH,
    )  # fmt: skip
    found = merged(list(parts)).values
    assert set(found) == set(exact)
    for name, rows in found.items():
        wanted = (above[name] - below[name]) / 2
        scale = np.abs(exact[name])
        tolerance = 0.01 * np.max(np.abs(wanted / scale)) * scale + 1e-7 * scale
        assert np.all(np.abs(rows.sum(axis=0) - wanted) <= tolerance), name


def test_a_pull_of_no_stated_strength_has_no_strain_at_a_share_of_it():
    parts = errors_of_pull(
        numbers()[0], InstrumentErrors("rope", tension_gain=1e-3), MODEL,
        tension=GRID, share=SHARES, rated_break_strength=None,
    )  # fmt: skip
    assert "strain_at_break_share" not in merged(list(parts)).values
