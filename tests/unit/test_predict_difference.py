"""Difference of two loads, where it means something."""

import numpy as np
import pytest

from reduction.prediction.wave_load import (
    ImmersedSection,
    _find_extremes,
    _load_difference,
)
from reduction.prediction.wave_theory import stokes_wave

HOSE = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
WAVE = stokes_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=-0.038)
EXTREMES = _find_extremes(WAVE, HOSE)


def test_extremes_are_cut_by_what_lies_between_the_cuts_of_drag_and_inertia():
    found = _load_difference(EXTREMES)
    drag, inertia = 1 - 0.0951 / 0.114, 1 - 0.0091 / (np.pi * 0.114**2 / 4)
    for name in ("horizontal_of_maximum", "horizontal_of_minimum"):
        assert inertia < float(getattr(found, name)) < drag
    # upwards the width is that of the whole hose: the inertia alone is cut
    assert 0 < float(found.vertical_of_maximum) < inertia
    by_hand = 1 - EXTREMES.vertical.minimum / EXTREMES.vertical_classic.minimum
    assert float(found.vertical_of_minimum) == pytest.approx(float(by_hand))
