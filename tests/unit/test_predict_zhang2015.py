"""Printed settings beside the theories of the package."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import stokes_wave
from reduction.published.zhang_2015 import printed_airy_wave, printed_stokes_wave
from reduction.record.errors import SettingsError


def test_the_printed_stokes_wave_is_that_of_the_package_but_for_the_rounded_frequency():
    printed = printed_stokes_wave()
    wave = stokes_wave(
        wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=0.0,
        wave_number=2 * np.pi / 20,
    )  # fmt: skip
    for name in (
        "elevation", "horizontal_velocity", "vertical_velocity",
        "horizontal_acceleration", "vertical_acceleration",
    ):  # fmt: skip
        assert getattr(printed, name) == pytest.approx(getattr(wave, name), rel=1e-13)
    assert wave.angular_frequency == pytest.approx(1.76, abs=0.005)


def test_only_two_loads_are_printed():
    with pytest.raises(SettingsError, match="the paper has no such load; found 'third'"):
        printed_airy_wave("third")
