"""Creep at constant tension."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds.relaxation_numbers import _tension_variation, creep_rate

TIME = np.arange(1.0, 2001.0)
STRAIN = 1 + 0.03 * np.log10(TIME)


def test_a_logarithmic_creep_gives_its_rate_under_noisy_tension():
    tension = 400 + 3 * np.random.default_rng(0).standard_normal(TIME.size)
    # The first blocks hold one sample each: three standard deviations stay within 1 %.
    tension = np.clip(tension, 397, 403)
    assert creep_rate(TIME, STRAIN, tension, ramp_duration=2.0).value == pytest.approx(
        0.03, rel=1e-2
    )


def test_tension_that_is_not_constant_is_refused():
    with pytest.raises(DataError, match="tension is not constant: it strays .* needed 1% or less"):
        creep_rate(TIME, STRAIN, 400 - 10 * np.log10(TIME), ramp_duration=2.0)


def test_no_tension_is_refused():
    with pytest.raises(DataError, match="creep under no tension; found 0 N"):
        _tension_variation(TIME, np.zeros(TIME.size))


def test_a_hold_too_short_is_refused():
    with pytest.raises(DataError, match="too short for a rate per decade"):
        creep_rate(TIME[:5], STRAIN[:5], np.full(5, 400.0), ramp_duration=2.0)
