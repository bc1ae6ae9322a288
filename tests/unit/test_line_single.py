import numpy as np
import pytest
from scipy import stats

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.line_model import (
    VERDICTS,
    _power_of_frequency,
    _storage_and_loss,
    check_single_time,
    identify_by_fundamental,
)

FREQUENCY = np.array([0.1, 0.1, 0.3, 0.3, 0.5, 0.5])


def test_exponent_and_uncertainty_are_those_of_a_regression():
    rng = np.random.default_rng(3)
    values = 4 * FREQUENCY**-0.6 * np.exp(rng.normal(0, 0.1, 6))
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values)
    other = stats.linregress(np.log(FREQUENCY), np.log(values))
    assert exponent == pytest.approx(other.slope)
    assert uncertainty == pytest.approx(other.stderr)
    assert left == 4


def test_groups_are_a_regression_with_one_intercept_each():
    rng = np.random.default_rng(4)
    group = np.array(["low", "high", "low", "high", "low", "high"])
    values = np.where(group == "low", 1.0, 20.0) * FREQUENCY**0.3 * np.exp(rng.normal(0, 0.1, 6))
    design = np.column_stack([group == "low", group == "high", np.log(FREQUENCY)]).astype(float)
    beta, rest, *_ = np.linalg.lstsq(design, np.log(values), rcond=None)
    covariance = rest[0] / 3 * np.linalg.inv(design.T @ design)
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values, group=group)
    assert (exponent, uncertainty) == pytest.approx((beta[2], np.sqrt(covariance[2, 2])))
    assert left == 3


def test_many_lines_at_once_are_each_alone_also_with_runs_missing():
    rng = np.random.default_rng(5)
    values = FREQUENCY**-1 * np.exp(rng.normal(0, 0.1, (4, 3, 6)))
    values[1, 2, 0] = np.nan
    values[0, 0, 5] = -1
    group = [1, 2, 1, 2, 1, 2]
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values, group=group)
    assert exponent.shape == uncertainty.shape == left.shape == (4, 3)
    for index in np.ndindex(4, 3):
        kept = values[index] > 0
        one = _power_of_frequency(FREQUENCY[kept], values[index][kept], group=np.array(group)[kept])
        assert exponent[index] == pytest.approx(float(one[0]))
        assert uncertainty[index] == pytest.approx(float(one[1]))
        assert left[index] == one[2]


def test_one_relaxation_time_is_seen_as_one():
    rng = np.random.default_rng(6)
    check = check_single_time(
        FREQUENCY,
        2.0 * np.exp(rng.normal(0, 0.05, 6)),
        0.1 / FREQUENCY * np.exp(rng.normal(0, 0.05, 6)),
    )
    assert VERDICTS[int(check.verdict)].startswith("one relaxation time holds")
    assert check.exponent_low < 0 < check.exponent_high < 1
    assert check.loss_exponent_low < -1 < check.loss_exponent_high
    assert check.p_inverse_frequency < 0.001 < check.p_one_time


@pytest.mark.filterwarnings("error")
def test_relaxation_times_that_are_hardly_known_have_no_upper_ratio():
    tau = np.array([2.0, 1e-200, 2.0, 1e200, 2.0, 1e-200])
    check = check_single_time(FREQUENCY, tau, np.full(6, 0.1))
    assert check.time_ratio_high == np.inf
    assert VERDICTS[int(check.verdict)].startswith("not decided")


def test_a_constant_loss_angle_is_seen_as_one_over_frequency_by_way_of_the_inversion():
    # a rope whose loss angle stays 7 degrees while |K| grows a little with frequency
    rng = np.random.default_rng(7)
    modulus = 3.0e4 * (FREQUENCY / 0.3) ** 0.03
    delta = np.radians(7.0) * np.exp(rng.normal(0, 0.03, 6))
    line = identify_by_fundamental(
        storage_spring_constant=modulus * np.cos(delta),
        loss_spring_constant=modulus * np.sin(delta),
        frequency=FREQUENCY,
        quasi_static_spring_constant=1.2e4,
    )
    check = check_single_time(FREQUENCY, line.relaxation_time, np.tan(delta))
    assert VERDICTS[int(check.verdict)].startswith("the relaxation time follows 1/f")
    # A = |K| cos(7 deg) - K_0 grows from 16.81e3 to 18.24e3 N, so tau falls by 4.61 for 5
    assert check.time_ratio == pytest.approx(4.61, rel=0.05)
    assert check.frequency_ratio == pytest.approx(5)
    assert check.loss_exponent == pytest.approx(0, abs=0.05)


def test_a_line_of_three_parameters_passes_its_own_check():
    stored, lost = _storage_and_loss(
        quasi_static_spring_constant=1.2e4,
        dissipation_spring_constant=1.8e4,
        relaxation_time=2.0,
        frequency=FREQUENCY,
    )
    noisy = lost * (1 + 0.02 * np.array([1, -1, -1, 1, 1, -1]))
    line = identify_by_fundamental(
        storage_spring_constant=stored,
        loss_spring_constant=noisy,
        frequency=FREQUENCY,
        quasi_static_spring_constant=1.2e4,
    )
    check = check_single_time(FREQUENCY, line.relaxation_time, noisy / stored)
    assert check.verdict == 1
    assert check.exponent == pytest.approx(0, abs=0.03)


def test_something_between_is_neither():
    wobble = np.exp(0.02 * np.array([1, -1, -1, 1, 1, -1]))
    check = check_single_time(FREQUENCY, FREQUENCY**-0.5 * wobble, 0.1 * wobble)
    assert check.verdict == 3


def test_much_scatter_decides_nothing():
    wobble = np.exp(np.array([1.0, -1, -1, 1, 1, -1]))
    check = check_single_time(FREQUENCY, FREQUENCY**-0.5 * wobble, 0.1 * wobble)
    assert check.verdict == 0


def test_one_pair_of_frequencies_uses_the_stated_uncertainties():
    times = [10.0, 2.0]
    check = check_single_time([0.1, 0.5], times, [0.1, 0.1])
    assert check.verdict == 4 and np.isnan(check.exponent_standard_uncertainty)
    assert check.exponent == pytest.approx(1)
    stated = check_single_time(
        [0.1, 0.5], times, [0.1, 0.1], relative_standard_uncertainty=[0.03, 0.04]
    )
    assert stated.degrees_of_freedom == 0
    assert stated.exponent_standard_uncertainty == pytest.approx(0.05 / np.log(5))
    width = stats.norm.ppf(0.975) * 0.05 / np.log(5)
    assert stated.exponent_high - stated.exponent_low == pytest.approx(2 * width)
    assert stated.verdict == 2


def test_one_frequency_decides_nothing():
    check = check_single_time([0.3, 0.3, 0.3], [2.0, 2.1, 1.9], [0.1, 0.1, 0.1])
    assert check.verdict == 4 and np.isnan(check.exponent)


def test_a_line_without_any_time_decides_nothing():
    check = check_single_time(FREQUENCY, np.full((2, 6), np.nan), np.full((2, 6), 0.1))
    assert check.verdict.tolist() == [4, 4]


def test_a_frequency_is_positive():
    with pytest.raises(DataError, match="frequency are not positive"):
        _power_of_frequency([0.1, -0.2], [1.0, 2.0])


def test_the_tolerance_is_what_a_line_may_miss():
    wobble = np.exp(0.002 * np.array([1, -1, -1, 1, 1, -1]))
    times = FREQUENCY**-0.95 * wobble
    assert check_single_time(FREQUENCY, times, wobble).verdict == 2
    assert check_single_time(FREQUENCY, FREQUENCY**-0.85 * wobble, wobble).verdict == 3
