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
    with pytest.raises(DataError, match="tension is not constant: it strays .* needed 1 % or less"):
        creep_rate(TIME, STRAIN, 400 - 10 * np.log10(TIME), ramp_duration=2.0)


@pytest.mark.parametrize(("size", "lasts", "is_given"), [(0.05, 3.0, True), (0.05, 12.0, False)])
def test_a_load_that_overshoots_shortly_before_the_readings_that_count_gives_a_rate(
    size, lasts, is_given
):
    """Ramp of 6 s, readings count from 18 s on; a specimen whose creep is a logarithm of time."""
    over = TIME <= lasts
    # the response to the overshoot, which ends there
    after = np.maximum(TIME - lasts, 1e-3)
    strain = 0.03 * ((1 + size) * np.log10(TIME) - size * np.log10(np.where(over, 1, after)))
    tension = np.where(over, 400 * (1 + size), 400.0)
    if is_given:
        found = creep_rate(TIME, strain, tension, ramp_duration=6.0)
        assert found.value == pytest.approx(0.03, rel=5e-3)
        return
    with pytest.raises(DataError, match="tension is not constant"):
        creep_rate(TIME, strain, tension, ramp_duration=6.0)


def test_no_tension_is_refused():
    with pytest.raises(DataError, match="creep under no tension; found 0 N"):
        _tension_variation(TIME, np.zeros(TIME.size))


def test_a_hold_too_short_is_refused():
    with pytest.raises(DataError, match="too short for a rate per decade"):
        creep_rate(TIME[:5], STRAIN[:5], np.full(5, 400.0), ramp_duration=2.0)
