import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from reduction.prediction.cord_curve import (
    CordCurve,
    cord_energy,
    cord_load,
    cord_stiffness,
    cord_strain_at,
)

CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)
# so soft at the start that a monotone cubic begins with no slope
TOE = CordCurve(strain=np.array([0.0, 0.1, 0.2]), load=np.array([0.0, 1.0, 100.0]))
MANY = CordCurve(strain=np.linspace(0, 0.2, 60), load=700 * np.linspace(0, 0.2, 60) ** 1.5)
CURVES = pytest.mark.parametrize("curve", [CORD, TOE, MANY], ids=["nylon", "toe", "many"])


@CURVES
def test_the_load_goes_through_every_point(curve):
    np.testing.assert_allclose(cord_load(curve, curve.strain), curve.load, rtol=1e-14)


@CURVES
def test_the_load_between_points_is_the_monotone_cubic(curve):
    strain = np.linspace(1e-9, curve.break_strain, 1001)
    theirs = PchipInterpolator(curve.strain, curve.load)
    np.testing.assert_allclose(cord_load(curve, strain), theirs(strain), rtol=1e-13)
    assert np.all(np.diff(cord_load(curve, strain)) > 0)


def test_two_points_make_a_straight_line():
    line = CordCurve(strain=np.array([0.0, 0.25]), load=np.array([0.0, 50.0]))
    np.testing.assert_allclose(cord_load(line, [0.05, 0.2]), [10.0, 40.0], rtol=1e-14)


@CURVES
@pytest.mark.parametrize("quantity", [cord_load, cord_stiffness, cord_energy])
def test_a_slack_cord_has_nothing_and_a_broken_one_no_number(curve, quantity):
    strain = np.array([-0.5, -1e-12, 0.0, curve.break_strain * (1 + 1e-9), 1.0, np.nan])
    np.testing.assert_array_equal(quantity(curve, strain), [0, 0, 0, np.nan, np.nan, np.nan])
    assert np.isfinite(quantity(curve, curve.break_strain))


@CURVES
def test_stiffness_is_the_slope_and_energy_the_integral_of_the_load(curve):
    strain = np.linspace(0.003, 0.997, 40) * curve.break_strain
    step = 1e-6 * curve.break_strain
    slope = (cord_load(curve, strain + step) - cord_load(curve, strain - step)) / (2 * step)
    np.testing.assert_allclose(cord_stiffness(curve, strain), slope, rtol=1e-6)
    # two Gauss points a piece are exact for a cubic
    width, middle = np.diff(curve.strain) / 2, (curve.strain[1:] + curve.strain[:-1]) / 2
    areas = [cord_load(curve, middle + side * width / 3**0.5) for side in (-1, 1)]
    held = np.cumsum(width * sum(areas))
    np.testing.assert_allclose(cord_energy(curve, curve.strain[1:]), held, rtol=1e-12)
    half = width[0] / 2
    first = half * sum(cord_load(curve, half + side * half / 3**0.5) for side in (-1, 1))
    np.testing.assert_allclose(cord_energy(curve, width[0]), first, rtol=1e-12)


@CURVES
def test_the_inverse_gives_the_strain_back(curve):
    strain = np.concatenate([10.0 ** np.linspace(-9, -2, 200), np.linspace(0.01, 1, 500)])
    strain *= curve.break_strain
    load = cord_load(curve, strain)
    # one rounding of the load moves the strain by so much, and no more is lost
    rounding = load / (strain * cord_stiffness(curve, strain))
    error = np.abs(cord_strain_at(curve, load) / strain - 1)
    assert np.max(error / (1 + rounding)) < 1e-15
    assert np.max(error) < 1e-14


@CURVES
def test_the_inverse_is_exact_at_the_points(curve):
    np.testing.assert_array_equal(cord_strain_at(curve, curve.load), curve.strain)


def test_loads_no_cord_bears_have_no_strain():
    found = cord_strain_at(CORD, np.array([-1.0, 133.5, np.inf, np.nan, 0.0]))
    np.testing.assert_array_equal(found, [np.nan, np.nan, np.nan, np.nan, 0.0])


def test_the_smallest_loads_on_a_toe_are_found():
    load = 10.0 ** np.linspace(-300, 1, 200)
    np.testing.assert_allclose(cord_load(TOE, cord_strain_at(TOE, load)), load, rtol=1e-14)


def test_shapes_are_kept_and_the_strains_given_are_not_written_on():
    strain = np.full((2, 3), 0.05)
    assert cord_load(CORD, strain).shape == cord_strain_at(CORD, strain).shape == (2, 3)
    assert cord_load(CORD, 0.05).shape == cord_strain_at(CORD, 0.05).shape == ()
    assert np.all(strain == 0.05)
