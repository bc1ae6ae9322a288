import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.rope_programme import parting_sample, tensile_pull


def pull(*, after, back=0.0, noise=0.0, n=400):
    """A rise to 5,000 N over 1 m, and 50 readings after it."""
    reach = np.concatenate([np.linspace(0, 1, n), np.linspace(1, 1 - back, 50)])
    load = np.concatenate([np.linspace(0, 5000, n), np.full(50, float(after))])
    if back:
        load[n:] = np.linspace(5000, after, 50)
    load = load + np.random.default_rng(1).normal(0, noise, load.size)
    return reach, load, reach / 8


def test_a_break_is_a_fall_at_the_position_of_the_peak():
    position, load, strain = pull(after=20.0)
    found = tensile_pull(position, load, strain, rated_break_strength=4000.0)
    assert found.is_break.tolist() == [True]
    assert found.peak_tension == pytest.approx([5000.0])
    assert found.strain_at_peak == pytest.approx([0.125])
    assert found.peak_tension_over_strength == pytest.approx([1.25])
    assert "falls by half" in found.how[0]


def test_a_pull_that_is_taken_back_is_no_break():
    found = tensile_pull(*pull(after=20.0, back=0.9), rated_break_strength=np.nan)
    assert found.is_break.tolist() == [False]
    assert np.isnan(found.peak_tension_over_strength).all()
    assert "does not fall by half" in found.how[0] and "state failed = true" in found.how[0]


def test_a_strand_that_parts_and_leaves_more_than_half_is_no_break():
    assert not tensile_pull(*pull(after=3000.0), rated_break_strength=np.nan).is_break.any()


def test_two_low_readings_are_no_break():
    position, load, strain = pull(after=4900.0)
    load[-10:-8] = 0.0
    assert not tensile_pull(position, load, strain, rated_break_strength=np.nan).is_break.any()


@pytest.mark.parametrize("broke", [True, False])
def test_the_word_of_the_laboratory_decides(broke):
    found = tensile_pull(
        *pull(after=20.0 if not broke else 5000.0), rated_break_strength=1e4, broke=broke
    )
    assert found.is_break.tolist() == [broke] and found.how == ("as stated",)


def test_the_greatest_of_noisy_readings_is_known_to_what_noise_makes_of_it():
    position, load, strain = pull(after=20.0, noise=10.0, n=4000)
    found = tensile_pull(position, load, strain, rated_break_strength=1e4)
    # the rms error of the greatest of readings that rise by 5000/4000 N each
    draws = np.random.default_rng(2).normal(0, 10, (4000, 200)) - 5000 / 4000 * np.arange(200)
    rms = np.sqrt(np.mean(draws.max(axis=1) ** 2))
    assert found.peak_tension_standard_uncertainty == pytest.approx([rms], rel=0.3)
    assert abs(found.peak_tension[0] - 5000) < 4 * found.peak_tension_standard_uncertainty[0]
    assert found.peak_tension_over_strength_standard_uncertainty == pytest.approx(
        found.peak_tension_standard_uncertainty / 1e4
    )


@pytest.mark.parametrize(("noise", "step"), [(0.0, 0.0), (10.0, 0.0), (0.0, 50.0), (20.0, 50.0)])
@pytest.mark.parametrize("n", [30, 300, 3000])
@pytest.mark.parametrize("is_stopped", [False, True])
def test_a_line_parts_or_turns_between_two_readings(n, noise, step, is_stopped):
    """Readings at any phase of a rise to 5,013 N and .125: rms of error over uncertainty."""
    rng = np.random.default_rng(n)
    misses = []
    for _ in range(60):
        reach = (np.arange(-5, 2 * n) + rng.uniform()) / n
        rises = reach <= 1
        load = 5013 * np.clip(reach, 0, None) * rises
        if is_stopped:
            reach = np.where(rises, reach, 2 - reach)
            load = np.clip(5013 * np.where(rises, reach, 0.9 * reach), 0, None)
        load += rng.normal(0, noise, load.size)
        load = np.round(load / step) * step if step else load
        strain = np.clip(reach, 0, None) / 8
        found = tensile_pull(reach, [load], [strain], rated_break_strength=1e4)
        assert found.is_break.tolist() == [not is_stopped]
        misses.append(
            [
                (found.peak_tension[0] - 5013) / found.peak_tension_standard_uncertainty[0],
                (found.strain_at_peak[0] - 0.125) / found.strain_at_peak_standard_uncertainty[0],
            ]
        )
    rms = np.sqrt(np.mean(np.square(misses), axis=0))
    assert (rms > 0.35).all() and (rms < 1.4).all(), rms


@pytest.mark.parametrize("noise", [2.0, 20.0])
def test_the_strain_of_a_flat_top_is_that_of_its_greatest_reading(noise):
    reach = np.linspace(0, 1, 2000)
    load = 5000 * (1 - (reach - 0.7) ** 2 / 0.49) * (reach < 0.95)
    load += np.random.default_rng(3).normal(0, noise, 2000)
    found = tensile_pull(reach, [load], [reach / 8], rated_break_strength=1e4)
    spread = found.strain_at_peak_standard_uncertainty[0]
    # 4 sigma of noise hide so much on either side
    width = 0.7 * np.sqrt(4 * noise / 5000) / 8
    assert found.strain_at_peak[0] == reach[load.argmax()] / 8
    assert abs(found.strain_at_peak[0] - 0.7 / 8) < 2 * spread
    assert 0.3 * width < spread < width


def test_a_slow_log_does_not_know_what_came_between_two_readings():
    position, load, strain = pull(after=20.0, n=41)  # 125 N and 1/320 of strain a reading
    found = tensile_pull(position, load, strain, rated_break_strength=1e4)
    # the line parted anywhere between its last reading and the next: 0 to 1 of them more
    assert found.peak_tension_standard_uncertainty == pytest.approx([125 / np.sqrt(3)])
    assert found.strain_at_peak_standard_uncertainty == pytest.approx([1 / 320 / np.sqrt(3)])


def test_without_strain_there_is_none_at_the_peak():
    position, load, strain = pull(after=20.0)
    found = tensile_pull(position, load, strain * np.nan, rated_break_strength=1e4)
    assert np.isnan(found.strain_at_peak).all() and np.isfinite(found.peak_tension).all()


def test_missing_readings_after_the_peak_say_nothing():
    position, load, strain = pull(after=np.nan)
    assert not tensile_pull(position, load, strain, rated_break_strength=1e4).is_break.any()
    assert parting_sample(position, load, last=399, least_position=0.9, tension_low=2500.0) == -1


def test_a_pull_without_readings_is_refused():
    position, load, strain = pull(after=0.0)
    with pytest.raises(DataError, match="too few readings of tension"):
        tensile_pull(position, load * np.nan, strain, rated_break_strength=1e4)


@pytest.mark.parametrize("left", [np.nan, 0.0, 0.4, 1.0])
@pytest.mark.parametrize("noise", [0.0, 2e-5])
def test_an_extensometer_that_is_taken_off_knows_no_strain_at_failure(left, noise):
    # at 70 % of the load; what it reads then is a share of its last reading, or nothing
    position = np.linspace(10, 11, 400)
    load = np.append(np.linspace(0, 5000, 350), np.zeros(50))
    strain = np.linspace(0, 0.05, 400) + np.random.default_rng(1).normal(0, noise, 400)
    whole = tensile_pull(position, load, strain, rated_break_strength=1e4)
    assert whole.strain_at_peak[0] == pytest.approx(0.05 * 349 / 399, abs=3 * noise + 1e-9)
    strain[245:] = left * strain[244]
    found = tensile_pull(position, load, strain, rated_break_strength=1e4)
    assert np.isnan(found.strain_at_peak[0])
    assert found.peak_tension[0] == 5000


def test_a_pull_of_few_readings_has_its_strain_at_failure():
    position = np.linspace(10, 11, 40)
    load = np.append(np.linspace(0, 5000, 14), np.zeros(26))
    found = tensile_pull(position, load, (position - 10) / 10, rated_break_strength=1e4)
    assert found.strain_at_peak[0] == pytest.approx(0.1 * 13 / 39)
