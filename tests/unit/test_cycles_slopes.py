import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.secant_modulus import slope_readings


@pytest.mark.parametrize("degrees", [5.0, 8.0, 13.0])
def test_readings_are_those_of_a_drawn_ellipse(degrees):
    angle = np.linspace(0, 2 * np.pi, 200_001)
    delta = np.radians(degrees)
    strain, tension = 0.03 * np.sin(angle), 1500 * np.sin(angle + delta)
    high, low = strain.argmax(), strain.argmin()
    by_strain = (tension[high] - tension[low]) / np.ptp(strain)
    high, low = tension.argmax(), tension.argmin()
    by_tension = np.ptp(tension) / (strain[high] - strain[low])
    readings = slope_readings(np.ptp(tension) / np.ptp(strain), np.tan(delta))
    assert readings.amplitude_ratio == pytest.approx(5e4)
    assert readings.between_strain_extremes == pytest.approx(by_strain, rel=1e-5)
    assert readings.between_tension_extremes == pytest.approx(by_tension, rel=1e-5)
    assert readings.relative_spread == pytest.approx((by_tension - by_strain) / 5e4, rel=1e-3)


def test_the_readings_of_the_report_lie_within_0_4_and_2_7_percent():
    readings = slope_readings(np.ones(2), np.tan(np.radians([5.1, 13.1])))
    off = 100 * (readings.between_tension_extremes - 1)
    assert off.round(1).tolist() == [0.4, 2.7]


def test_a_spring_has_one_slope_and_a_missing_cycle_none():
    readings = slope_readings([[100.0, np.nan]], [[0.0, 0.1]])
    assert readings.relative_spread[0, 0] == 0
    assert np.isnan(readings.between_strain_extremes[0, 1])


def test_a_negative_loss_factor_is_refused():
    with pytest.raises(DataError, match="1 of 2 loss factors are negative; found -0.1"):
        slope_readings([1.0, 1.0], [0.1, -0.1])
    with pytest.raises(DataError, match="do not pair up"):
        slope_readings([1.0, 1.0], 0.1)
