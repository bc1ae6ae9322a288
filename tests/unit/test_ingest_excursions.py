import numpy as np
import pytest

from reduction.readers.sample_flags import _find_excursions, _find_spikes, _noise_of, _usual_step

TIME = np.arange(0, 200, 0.1)
NOISE = np.random.default_rng(20051010).normal(0, 0.3, TIME.size)
# a hundred samples up and a hundred down, then a rest
COURSE = 20 + np.where(TIME < 160, 100 - 100 * np.abs((TIME / 20) % 1 - 0.5) * 2, 0.0) + NOISE


def off(values, factor=12.0):
    return np.flatnonzero(_find_spikes(values, noise=_noise_of(values)[0], factor=factor)).tolist()


@pytest.mark.parametrize("length", [2, 3, 5, 10])
@pytest.mark.parametrize("level", [-40.0, 0.0, 280.0])
@pytest.mark.parametrize("begin", [50, 97, 150, 1700])  # rise, peak, fall, rest
def test_a_drop_out_of_up_to_ten_samples_is_flagged_throughout(length, level, begin):
    values = COURSE.copy()
    values[begin : begin + length] = level
    assert off(values) == list(range(begin, begin + length))


def test_eleven_samples_off_are_a_stretch_of_its_own():
    values = COURSE.copy()
    values[150:161] = -40.0
    assert off(values) == []


def test_a_channel_that_does_not_come_back_to_its_course_has_stepped():
    values = COURSE.copy()
    values[1700:1705] += 80.0
    values[1705:] += 40.0
    assert off(values) == []


def test_excursions_and_single_samples_beside_each_other_are_all_flagged():
    values = COURSE.copy()
    values[1700:1703] = 80.0
    values[1709] = -10.0
    values[1715:1722] = 80.0
    assert off(values) == [1700, 1701, 1702, 1709, *range(1715, 1722)]


def test_excursions_longer_than_what_is_between_them_are_none():
    values = COURSE.copy()
    values[1700:1708] = values[1713:1721] = 80.0
    assert off(values) == []


def test_four_excursions_that_follow_each_other_closely_are_a_signal():
    values = COURSE.copy()
    for begin in (1700, 1712, 1724):
        values[begin : begin + 3] = 80.0
    assert len(off(values)) == 9
    values[1736:1739] = 80.0
    assert off(values) == []


def test_a_tenth_of_a_series_in_excursions_is_its_signal():
    values = np.zeros(1000) + NOISE[:1000]
    for begin in range(20, 980, 32):
        values[begin : begin + 3] = 80.0
    assert len(off(values)) == 90
    for begin in range(20, 980, 32):
        values[begin : begin + 4] = 80.0
    assert off(values) == []


def test_an_excursion_where_two_pieces_of_a_long_series_meet_is_found():
    values = np.tile(COURSE, 100)
    for begin in (65530, 131071, 196602):  # across, from the last, up to the edge
        values[begin : begin + 6] = -60.0
    assert off(values) == [begin + i for begin in (65530, 131071, 196602) for i in range(6)]


def test_a_missing_sample_beside_an_excursion_leaves_it_alone():
    values = COURSE.copy()
    values[150:153] = -40.0
    values[149] = np.nan
    assert off(values) == []


def test_no_jump_is_no_excursion():
    assert _find_excursions(COURSE, np.empty(0, dtype=np.intp), limit=1.0).size == 0


def test_the_usual_step_passes_over_two_large_ones():
    values = np.arange(20.0)
    values[12:] += 50
    values[14:] += 50
    assert _usual_step(values, np.array([9]), np.array([9])) == pytest.approx([1.0])
