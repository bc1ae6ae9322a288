import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.standstills import Standstills
from reduction.stages.three_parameter_line.hold_pairs import held_pairs


def stands(*intervals, tension, rest=()):
    first, last = np.array(intervals).T
    return Standstills(
        first=first,
        last=last,
        start_time=first.astype(float),
        end_time=last.astype(float),
        mean_position=np.ones(first.size),
        mean_tension=np.array([tension]),
        is_rest=np.isin(np.arange(first.size), rest),
        position_tolerance=1e-3,
        slack_tension=5.0,
        tension_tolerance=1.0,
    )


def record(*, drop=100.0, n=1200):
    """A second a reading: 100 N from 10 to 100 s, 300 N from 110 s on."""
    time = np.arange(float(n))
    load = np.interp(time, [0, 10, 100, 110, n], [0, 100, 100, 300, 300])
    since = np.clip(time - 105, 5, None)
    strain = np.where(
        time <= 100, 0.05 * load / 100, 0.05 + (load - 100) / (4000 - drop * np.log10(since / 100))
    )
    return time, 1 + strain, load, strain


def pairs_of(time, position, load, strain, stand, *, strength=1e4, reference_time=100.0):
    return held_pairs(
        time, position, [load], [strain], stand, specimens=["rope"],
        rated_break_strength=strength, reference_time=reference_time,
    )  # fmt: skip


UP = stands((10, 100), (110, 1199), tension=[100.0, 300.0])


def test_a_hold_after_a_lower_one_has_a_stiffness():
    (pair,) = pairs_of(*record(), UP)
    assert (pair.low_hold, pair.high_hold) == (1, 2)
    assert (pair.low_tension, pair.high_tension) == pytest.approx((100.0, 300.0))
    assert pair.stiffness.stiffness_at_reference == pytest.approx(4000, rel=1e-3)
    assert pair.stiffness.slope_per_decade == pytest.approx(-100, rel=0.01)
    assert pair.stiffness.stiffness_over_strength == pytest.approx(0.4, rel=1e-3)


def test_what_is_not_known_of_the_lower_hold_is_in_the_uncertainty():
    time, position, load, strain = record()
    noise = np.where(time < 101, np.random.default_rng(3).normal(0, 1e-3, time.size), 0.0)
    (sure,) = pairs_of(time, position, load, strain, UP)
    (pair,) = pairs_of(time, position, load, strain + noise, UP)
    # the lower strain is the mean of four readings, and the secant is over 0.05 of strain
    expected = 4000 / 0.05 * 1e-3 / 2
    found = pair.stiffness.stiffness_at_reference_standard_uncertainty
    assert found > 10 * sure.stiffness.stiffness_at_reference_standard_uncertainty
    assert found == pytest.approx(expected, rel=0.15)


def test_a_lower_hold_after_it_and_a_rest_between_are_no_pair():
    assert pairs_of(*record(), stands((10, 100), (110, 1199), tension=[100.0, 102.0])) == ()
    assert pairs_of(*record(), stands((10, 100), (110, 1199), tension=[300.0, 100.0])) == ()
    parted = stands((10, 50), (60, 100), (110, 1199), tension=[100.0, 0.0, 300.0], rest=[1])
    assert pairs_of(*record(), parted) == ()


def test_rests_have_no_number():
    begins = stands((0, 5), (10, 100), (110, 1199), tension=[0.0, 100.0, 300.0], rest=[0])
    (pair,) = pairs_of(*record(), begins)
    assert (pair.low_hold, pair.high_hold) == (1, 2)


def test_a_short_hold_has_a_stiffness_at_a_time_within_it_and_no_slope():
    # from 100 to 200 s after the centre of the ramp: 0.3 decades
    time, position, load, strain = record(n=305)
    far = (time >= 110) & (time < 205)
    position, strain = (np.where(far, np.nan, one) for one in (position, strain))
    begins = stands((10, 100), (110, 304), tension=[100.0, 300.0])
    (pair,) = pairs_of(time, position, load, strain, begins, reference_time=150.0)
    true = 4000 - 100 * np.log10(1.5)
    assert pair.stiffness.stiffness_at_reference == pytest.approx(true, rel=1e-3)
    assert np.isnan(pair.stiffness.slope_per_decade)
    assert [one.code for one in pair.stiffness.notes] == ["no-static-slope"]
    (pair,) = pairs_of(time, position, load, strain, begins, reference_time=600.0)
    assert pair.stiffness is None


def test_a_hold_that_is_too_short_is_refused_with_its_levels():
    time, position, load, strain = record(n=120)
    (pair,) = pairs_of(
        time, position, load, strain, stands((10, 100), (110, 119), tension=[100.0, 300.0])
    )
    assert pair.stiffness is None
    assert "too short for a line in the logarithm of time" in pair.reason
    assert pair.high_tension == pytest.approx(300.0)


def test_a_lower_hold_without_strain_is_refused():
    time, position, load, strain = record()
    (pair,) = pairs_of(time, position, load, np.where(time < 101, np.nan, strain), UP)
    assert pair.stiffness is None and "the lower hold has no strain" in pair.reason


def test_an_upper_hold_without_a_ramp_is_refused():
    time, position, load, strain = record()
    load = np.where(time < 111, 300.0, load)
    together = stands((10, 100), (101, 1199), tension=[100.0, 300.0])
    (pair,) = pairs_of(time, position, load, strain, together)
    assert pair.stiffness is None and "does not show the ramp" in pair.reason


def test_a_strength_that_is_not_positive_is_refused():
    with pytest.raises(DataError, match="rated break strength"):
        pairs_of(*record(), UP, strength=-1.0)
