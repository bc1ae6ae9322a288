"""Unit tests of reduction.strain.uncertainty; expected values from the derivatives by hand."""

import numpy as np
import pytest

from reduction.strain.model import StrainModel
from reduction.strain.uncertainty import strain_uncertainty_of

NAN = np.nan
GAUGE = {"reference_position": 0.0, "gauge_length": 2.0}
LAW = {
    "relaxed_free_length": 2.5,
    "relaxed_splice_length": 1.2,
    "splice_compliance": 0.0012,
    "splice_exponent": 0.85,
}


def spread(model, position=1.0, tension=400.0, of_position=NAN, of_tension=NAN):
    return strain_uncertainty_of(
        model,
        position=[position],
        tension=[tension],
        position_uncertainty=of_position,
        tension_uncertainty=of_tension,
    )[0]


def test_a_reading_counts_by_the_slope_of_strain_on_position():
    model = StrainModel("rope", "gauge-length", GAUGE)
    assert spread(model, of_position=0.003) == pytest.approx(0.003 / 2.0)


def test_coefficients_count_with_their_correlation():
    # strain = (p - p0) / L0: slopes -1/L0 and -(p - p0)/L0^2
    covariance = np.array([[4e-6, -1e-6], [-1e-6, 9e-6]])
    slope = np.array([-1 / 2.0, -1.0 / 2.0**2])
    expected = np.sqrt(slope @ covariance @ slope)
    model = StrainModel("rope", "gauge-length", GAUGE, covariance)
    assert spread(model) == pytest.approx(expected, rel=1e-6)


def test_tension_counts_through_the_splice_law():
    # free length = p - Ls (1 + c F^n), strain = free length / Lf - 1
    slope = 1.2 * 0.0012 * 0.85 * 400.0 ** (0.85 - 1) / 2.5
    model = StrainModel("tether", "tension-driven", LAW, tension_high=600.0)
    assert spread(model, position=6.0, of_tension=2.0) == pytest.approx(slope * 2.0, rel=1e-5)


def test_parts_add_as_squares():
    model = StrainModel("tether", "tension-driven", LAW, tension_high=600.0)
    apart = [spread(model, 6.0, of_position=0.002), spread(model, 6.0, of_tension=2.0)]
    both = spread(model, 6.0, of_position=0.002, of_tension=2.0)
    assert both == pytest.approx(np.hypot(*apart))


def test_nothing_known_is_not_zero():
    assert np.isnan(spread(StrainModel("rope", "gauge-length", GAUGE)))


def test_an_extensometer_has_no_part_of_position_or_tension():
    assert np.isnan(spread(StrainModel("rope", "extensometer"), of_position=0.001))


def test_a_missing_sample_has_no_uncertainty():
    model = StrainModel("rope", "gauge-length", GAUGE)
    assert np.isnan(spread(model, position=NAN, of_position=0.003))
