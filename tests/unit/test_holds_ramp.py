"""The ramp before a hold, and what the rule of its centre is worth."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds.hold_selection import _find_ramp


def record(rate=0.2, stroke=1.0, power=1.0, rest=10.0, step=0.05):
    """Rest, then a constant-rate ramp of a specimen whose tension is stroke**power."""
    time = np.arange(0, rest + stroke / rate + step / 2, step)
    position = np.clip((time - rest) * rate, 0, stroke)
    return time, position, 100 * position**power


def test_a_linear_specimen_has_its_centre_at_half_the_ramp():
    ramp = _find_ramp(*record(), band=1e-3)
    assert ramp.start_time == pytest.approx(10, abs=0.06)
    assert ramp.end_time == pytest.approx(15)
    assert ramp.centre_time == pytest.approx(12.5, abs=0.05)
    assert ramp.duration == pytest.approx(5, abs=0.05)
    assert ramp.stiffness == pytest.approx(100)


@pytest.mark.parametrize("power", [2.0, 3.0])
def test_a_stiffening_specimen_has_its_centre_later(power):
    # The mean of t over d(t^p), t in 0..5, is 5 p / (p + 1).
    ramp = _find_ramp(*record(power=power), band=1e-3)
    assert ramp.centre_time == pytest.approx(10 + 5 * power / (power + 1), abs=0.05)
    # Its variance is p / ((p + 1)^2 (p + 2)) of the ramp time squared.
    spread = np.sqrt(12 * power / ((power + 1) ** 2 * (power + 2)))
    assert ramp.duration == pytest.approx(5 * spread, abs=0.05)


def test_noise_of_position_does_not_move_the_start():
    rng = np.random.default_rng(0)
    time, position, tension = record(rest=60.0)
    noisy = position + rng.uniform(-0.01, 0.01, time.size)
    ramp = _find_ramp(time, noisy, tension, band=0.02)
    assert ramp.start_time == pytest.approx(60, abs=0.25)
    assert ramp.centre_time == pytest.approx(62.5, abs=0.1)


def test_only_the_last_stroke_counts():
    time = np.arange(0, 20, 0.1)
    position = np.interp(time, [0, 5, 10, 20], [0, 2, 1, 3])
    ramp = _find_ramp(time, position, position, band=0.01)
    assert ramp.start_time == pytest.approx(10, abs=0.2)


def test_unloading_takes_the_centre_of_position():
    time = np.arange(0, 10.05, 0.1)
    position = 3 - np.clip(time - 5, 0, None) / 5
    ramp = _find_ramp(time, position, 100 * position, band=0.01)
    assert ramp.centre_time == pytest.approx(7.5, abs=0.1)


def test_without_motion_there_is_no_ramp():
    assert _find_ramp([0.0, 1.0, 2.0], [1.0, 1.0, 1.0], [5.0, 5.0, 5.0], band=0.01) is None


def test_the_rule_of_the_centre_holds_for_a_relaxation_of_any_spectrum():
    # Superposition of two terms and a logarithm after a ramp of a stiffening specimen.
    def relaxation(time):
        return 100 + 30 * np.exp(-time / 20) + 20 * np.exp(-time / 200) - 4 * np.log1p(time)

    time, position, elastic = record(power=2.0, step=0.01)
    ramp = _find_ramp(time, position, elastic, band=1e-4)
    added = np.diff(elastic) / elastic[-1]
    middle = (time[1:] + time[:-1]) / 2
    for multiple, tolerance in [(3, 0.004), (10, 0.0004)]:
        later = ramp.centre_time + multiple * ramp.duration
        exact = added @ relaxation(later - middle)
        step = relaxation(later - ramp.centre_time)
        assert abs(step - exact) < tolerance * abs(relaxation(1) - relaxation(100))


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        _find_ramp([0.0, 1.0], [0.0, 1.0, 2.0], [0.0, 1.0], band=0.1)
