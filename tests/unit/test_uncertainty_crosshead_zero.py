"""Errors of the crosshead's scale, as the zero of strain is from the log or from elsewhere."""

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.error_field import error_field

LENGTH, START = 2.0, 2.3
STRAIN = np.array([0.0, 0.4, 0.9])


@pytest.mark.parametrize("is_zero_logged", [True, False])
@pytest.mark.parametrize(("source", "size"), [("position_gain", 1e-3), ("position_offset", 2e-3)])
def test_a_crosshead_that_is_wrong_moves_strain_by_what_its_zero_does_not_share(
    source, size, is_zero_logged
):
    """Positions read wrong, once with the zero from the same log and once with the right one."""
    place = START + LENGTH * STRAIN

    def read(position):
        return position * (1 + size) if source == "position_gain" else position + size

    zero = read(START) if is_zero_logged else START
    expected = (read(place) - zero) / LENGTH - STRAIN
    model = StrainModel(
        "rope", "gauge-length", {"reference_position": START, "gauge_length": LENGTH},
        is_zero_logged=is_zero_logged,
    )  # fmt: skip
    found = error_field(
        InstrumentErrors("rope", **{source: size}), model, strain=STRAIN, tension=1e3 * STRAIN
    )
    moved = found.strain[0] if found.component else np.zeros(3)
    np.testing.assert_allclose(moved, expected, rtol=1e-9, atol=1e-15)
    slope = found.strain_slope[0] if found.component else np.zeros(3)
    np.testing.assert_allclose(slope, np.gradient(expected, STRAIN), rtol=1e-9, atol=1e-12)


def test_a_scale_is_wrong_by_a_share_of_the_displacement_it_reads():
    """1 % of the travel from displacement zero, where the pins are a length apart."""
    travel = LENGTH * STRAIN
    expected = 0.01 * travel / LENGTH
    model = StrainModel(
        "rope", "gauge-length", {"reference_position": START, "gauge_length": LENGTH}
    )
    errors = InstrumentErrors("rope", position_gain=0.01, position_of_scale_zero=START)
    found = error_field(errors, model, strain=STRAIN, tension=1e3 * STRAIN)
    np.testing.assert_allclose(found.strain[0], expected, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found.strain_slope[0], 0.01, rtol=1e-9)
