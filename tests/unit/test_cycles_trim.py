"""The constant-rate part of a branch: turns are trimmed, the middle stays, whatever the noise."""

import numpy as np
import pytest

from reduction.record.errors import SettingsError
from reduction.stages.cycles.branch_span import _constant_rate_span, _stroke_span


def soft_triangle(n_cycles, *, rate=10.0, half=5.0, speed=0.2, turn=0.5, noise=0.0):
    """Branches whose speed rises and falls linearly over ``turn`` seconds at each end."""
    n_half = int(half * rate)
    since = (np.arange(n_half) + 0.5) / rate
    share = np.minimum(1, np.minimum(since, half - since) / turn)
    steps = np.concatenate([share, -share]) * speed / rate
    position = 4 + np.concatenate([[0], np.cumsum(np.tile(steps, n_cycles))])
    time = np.arange(position.size) / rate
    edges = n_half * np.arange(2 * n_cycles + 1)
    position += np.random.default_rng(0).normal(0, noise, time.size)
    return time, position, edges[:-1], edges[1:]


def span(time, position, first, last, noise=0.0, threshold=0.97):
    return _constant_rate_span(time, position, first, last, noise=noise, trim_threshold=threshold)


def test_what_is_kept_is_what_moves_at_the_plateau_rate():
    time, position, first, last = soft_triangle(5)
    begin, end, rate = span(time, position, first, last)
    # the rate reaches 0.97 of the plateau 0.485 s into a branch
    assert time[begin] - time[first] == pytest.approx(0.5, abs=0.051)
    assert time[last] - time[end] == pytest.approx(0.5, abs=0.051)
    assert rate == pytest.approx(0.2, rel=1e-9)


def test_sharp_turns_lose_nothing():
    time, position, first, last = soft_triangle(5, turn=1e-9)
    begin, end, _ = span(time, position, first, last)
    assert begin.tolist() == first.tolist() and end.tolist() == last.tolist()


@pytest.mark.parametrize("rate", [10.0, 100.0, 1000.0])
def test_noise_moves_the_ends_little(rate):
    time, position, first, last = soft_triangle(20, rate=rate, noise=0.002)
    begin, end, plateau = span(time, position, first, last, noise=0.002)
    trimmed = (time[begin] - time[first]) + (time[last] - time[end])
    # a window of a quarter branch passes as a whole when a little of it is in the turn
    assert np.median(trimmed) == pytest.approx(0.8, abs=0.4)
    assert plateau == pytest.approx(0.2, rel=0.03)


def test_ten_samples_a_branch_leave_the_middle():
    time, position, first, last = soft_triangle(30, rate=2.0, turn=1.0, noise=0.001)
    begin, end, _ = span(time, position, first, last, noise=0.001)
    kept = end - begin
    assert (kept >= 5).all() and (kept <= 9).all()


@pytest.mark.parametrize("threshold", [0.5, 0.9, 0.99])
def test_a_higher_threshold_keeps_less(threshold):
    time, position, first, last = soft_triangle(5, rate=100.0)
    begin, _, _ = span(time, position, first, last, threshold=threshold)
    assert time[begin] - time[first] == pytest.approx(threshold * 0.5, abs=0.011)


def test_a_window_is_at_most_a_quarter_of_a_branch():
    # eight steps at half the rate: a window of ten passes 0.97 only without any of them,
    # a wider one would take some of them along
    position = np.concatenate([0.5 * np.arange(9.0), 4 + np.arange(1.0, 33.0)])
    begin, end, rate = span(np.arange(41.0), position, np.array([0]), np.array([40]), noise=100.0)
    assert (begin.tolist(), end.tolist(), rate.tolist()) == ([8], [40], [1.0])


def test_rates_differ_from_branch_to_branch():
    time = np.arange(61.0)
    position = np.interp(time, [0, 20, 60], [0, 20, 0])
    _, _, rate = span(time, position, np.array([0, 20]), np.array([20, 60]))
    assert rate == pytest.approx([1.0, 0.5])


def test_missing_samples_give_no_rate_but_take_only_themselves():
    time, position, first, last = soft_triangle(5)
    whole = span(time, position, first, last)
    position[first[1] + 20 : first[1] + 24] = np.nan
    holed = span(time, position, first, last)
    for one, other in zip(whole, holed, strict=True):
        assert one == pytest.approx(other)


def test_a_branch_without_samples_has_no_plateau_and_no_part():
    time, position, first, last = soft_triangle(3)
    position[first[2] + 1 : last[2]] = np.nan
    begin, end, rate = span(time, position, first, last)
    assert end[2] < begin[2] and np.isnan(rate[2])
    assert (end[[0, 1, 3]] > begin[[0, 1, 3]]).all()


def test_repeated_time_stamps_give_no_rate():
    time, position, first, last = soft_triangle(3)
    time[first[1] + 10] = time[first[1] + 9]
    begin, end, rate = span(time, position, first, last)
    assert np.isfinite(rate).all() and (end > begin).all()


def test_long_branches_are_searched_to_their_end():
    # the rate is reached in the last fifth only
    time = np.arange(2_000_001.0)
    position = np.interp(time, [0, 400_000, 2_000_000], [0, 0, 1.6e6])
    begin, end, _ = span(time, position, np.array([0]), np.array([2_000_000]))
    assert (begin[0], end[0]) == (400_000, 2_000_000)


@pytest.mark.parametrize("threshold", [0.0, -1.0, 1.1])
def test_a_threshold_that_is_no_share_is_refused(threshold):
    time, position, first, last = soft_triangle(1)
    with pytest.raises(
        SettingsError, match="trim_threshold is not a share; found .*; needed above 0"
    ):
        span(time, position, first, last, threshold=threshold)


def test_stroke_span_keeps_the_middle_nine_tenths():
    position = np.concatenate([np.arange(0, 101.0), np.arange(99.0, -1, -1)])
    begin, end = _stroke_span(position, np.array([0, 100]), np.array([100, 200]))
    assert (begin.tolist(), end.tolist()) == ([5, 105], [95, 195])


def test_stroke_span_of_a_branch_without_stroke_is_empty():
    begin, end = _stroke_span(np.ones(5), np.array([0]), np.array([4]))
    assert end[0] < begin[0]
