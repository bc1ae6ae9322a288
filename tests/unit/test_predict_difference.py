"""Difference of two loads, where it means something."""

import numpy as np
import pytest

from reduction.prediction.wave_load import (
    ImmersedSection,
    _find_extremes,
    _load_difference,
    wave_load,
)
from reduction.prediction.wave_theory import stokes_wave
from reduction.record.errors import SettingsError

HOSE = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
WAVE = stokes_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=-0.038)
TIME = np.linspace(0.0, 3.57, 500)
LOAD, EXTREMES = wave_load(WAVE, HOSE, TIME), _find_extremes(WAVE, HOSE)


def test_shares_where_the_load_is_large_and_nothing_elsewhere():
    found = _load_difference(LOAD, EXTREMES, minimum_share=0.2)
    limit = 0.2 * float(EXTREMES.horizontal_classic.greatest)
    small = np.abs(LOAD.horizontal_classic) < limit
    assert small.any() and not small.all()
    assert np.array_equal(np.isnan(found.horizontal), small)
    kept = found.horizontal[~small]
    expected = (LOAD.horizontal_classic - LOAD.horizontal)[~small] / LOAD.horizontal_classic[~small]
    assert kept == pytest.approx(expected)
    assert found.minimum_share == 0.2


def test_the_limit_does_not_depend_on_the_times_asked_for():
    quiet = int(np.argmin(np.abs(LOAD.horizontal_classic)))
    one = _load_difference(wave_load(WAVE, HOSE, TIME[quiet]), EXTREMES)
    assert np.isnan(one.horizontal).all()


def test_extremes_are_cut_by_what_lies_between_the_cuts_of_drag_and_inertia():
    found = _load_difference(LOAD, EXTREMES)
    drag, inertia = 1 - 0.0951 / 0.114, 1 - 0.0091 / (np.pi * 0.114**2 / 4)
    for name in ("horizontal_of_maximum", "horizontal_of_minimum"):
        assert inertia < float(getattr(found, name)) < drag
    # upwards the width is that of the whole hose: the inertia alone is cut
    assert 0 < float(found.vertical_of_maximum) < inertia
    by_hand = 1 - EXTREMES.vertical.minimum / EXTREMES.vertical_classic.minimum
    assert float(found.vertical_of_minimum) == pytest.approx(float(by_hand))


def test_without_a_load_there_is_no_difference():
    still = wave_load(WAVE, HOSE, [0.0], drag_coefficient=0.0)
    extremes = _find_extremes(WAVE, HOSE, drag_coefficient=0.0)
    assert np.isnan(_load_difference(still, extremes).horizontal).all()


@pytest.mark.parametrize("share", [0.0, -0.1, 1.5, float("nan")])
def test_a_share_is_a_share(share):
    with pytest.raises(SettingsError, match="minimum_share is not a share"):
        _load_difference(LOAD, EXTREMES, minimum_share=share)
