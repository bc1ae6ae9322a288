"""Published coefficients, typed again, and the numbers by which they are chosen."""

import numpy as np
import pytest

from reduction.prediction.wave_load import (
    CODE_OF_HYDROLOGY,
    GREATEST_DIAMETER_TO_LENGTH,
    PUBLISHED_COEFFICIENTS,
    _drag_to_inertia,
    _flow_regime,
    _keulegan_carpenter_number,
    _reynolds_number,
)
from reduction.prediction.wave_theory import airy_wave, particle_motion, stokes_wave
from reduction.record.errors import DataError

SEA = {"wave_height": 1.25, "wave_period": 3.57, "water_depth": 3.0, "elevation": -0.038}
TABLE_2 = [
    ((1.0, 1.0), 0.95, "Wiegel"), ((1.0, 1.4), 2.0, "Agerschou"),
    ((1.34, 1.34), 1.6, "Keulegan"), ((0.8, 1.0), 2.0, "Agerschou"),
]  # fmt: skip


def test_table_2_and_the_code_are_typed_alike():
    found = [(one.drag_coefficient, one.inertia_coefficient) for one in PUBLISHED_COEFFICIENTS]
    assert found == [row[:2] for row in TABLE_2]
    for one, row in zip(PUBLISHED_COEFFICIENTS, TABLE_2, strict=True):
        assert row[2] in one.source
    assert (CODE_OF_HYDROLOGY.drag_coefficient, CODE_OF_HYDROLOGY.inertia_coefficient) == (
        (1.2, 1.2), 2.0,
    )  # fmt: skip


def test_drag_over_inertia_is_that_of_the_two_terms():
    speed, period, diameter, density = 1.3, 4.0, 0.2, 1025.0
    drag = 0.5 * 1.2 * density * diameter * speed**2
    inertia = 2.0 * density * np.pi * diameter**2 / 4 * speed * 2 * np.pi / period
    number = _keulegan_carpenter_number(speed, period, diameter)
    assert number == pytest.approx(1.3 * 4 / 0.2)
    assert _drag_to_inertia(number) == pytest.approx(drag / inertia, rel=1e-13)


def test_reynolds_number_takes_the_magnitude():
    assert _reynolds_number(-1.0, 0.1) == pytest.approx(0.1 / 1.1892e-6)


@pytest.mark.parametrize("make", [airy_wave, stokes_wave])
@pytest.mark.parametrize("current", [0.0, 0.4, -0.9])
def test_greatest_velocity_is_that_of_a_fine_sweep(make, current):
    wave = make(**SEA)
    regime = _flow_regime(wave, [0.114, 0.3], current_velocity=current)
    sweep = particle_motion(wave, np.linspace(0.0, 3.57, 200_001)).horizontal_velocity + current
    assert regime.greatest_velocity == pytest.approx(np.max(np.abs(sweep)), rel=1e-9)
    assert regime.keulegan_carpenter_number == pytest.approx(
        regime.greatest_velocity * 3.57 / np.array([0.114, 0.3])
    )
    assert regime.diameter_to_length == pytest.approx(
        np.array([0.114, 0.3]) * wave.wave_number / (2 * np.pi)
    )
    assert np.all(regime.diameter_to_length < GREATEST_DIAMETER_TO_LENGTH)
    assert GREATEST_DIAMETER_TO_LENGTH == 0.2


def test_numbers_that_are_none_are_refused():
    with pytest.raises(DataError, match="greatest_velocity"):
        _keulegan_carpenter_number(np.nan, 3.0, 0.1)
    with pytest.raises(DataError, match="outer_diameter"):
        _reynolds_number(1.0, 0.0)
    with pytest.raises(DataError, match="inertia_coefficient"):
        _drag_to_inertia(10.0, inertia_coefficient=0.0)
