"""Fewer points, but every extreme and every gap."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from reduction.report.figure_data import keep_extremes, least_and_greatest

VALUES = st.floats(-1e6, 1e6) | st.just(float("nan"))
CHANNELS = arrays(np.float64, st.integers(200, 600), elements=VALUES)


@given(CHANNELS, st.integers(10, 150))
def test_least_and_greatest_stay_and_the_limit_holds(channel, limit):
    kept = keep_extremes(np.arange(channel.size, dtype=float), channel, limit=limit)
    assert kept.size <= limit
    assert (np.diff(kept) > 0).all()
    assert kept[0] == 0
    assert kept[-1] == channel.size - 1
    if np.isfinite(channel).any():
        assert np.nanmin(channel[kept]) == np.nanmin(channel)
        assert np.nanmax(channel[kept]) == np.nanmax(channel)
    assert np.isnan(channel[kept]).any() == np.isnan(channel).any()


@given(arrays(np.float64, 400, elements=VALUES), CHANNELS.map(lambda x: np.resize(x, 400)))
def test_a_time_axis_that_runs_backward_or_is_missing_is_no_obstacle(time, channel):
    kept = keep_extremes(time, channel, limit=50)
    assert kept.size <= 50
    if np.isfinite(channel).any():
        assert np.nanmax(channel[kept]) == np.nanmax(channel)


def test_every_interval_keeps_its_own_extremes():
    time = np.arange(100_000) / 10.0
    channel = np.random.default_rng(1).normal(size=time.size)
    kept = keep_extremes(time, channel, limit=2000)
    # 999 intervals fit into 2000 points; ten wider ones each hold whole ones in them
    for part in np.array_split(np.arange(time.size), 10):
        inside = kept[(kept >= part[0]) & (kept <= part[-1])]
        assert channel[inside].max() == channel[part].max()
        assert channel[inside].min() == channel[part].min()


def test_two_channels_keep_the_extremes_of_both():
    time = np.arange(5000.0)
    first, second = np.zeros(5000), np.zeros(5000)
    first[1234], second[4321] = 7.0, -7.0
    kept = keep_extremes(time, first, second, limit=100)
    assert {1234, 4321} <= set(kept.tolist())
    assert kept.size <= 100


def test_a_gap_stays_where_it_is():
    channel = np.ones(10_000)
    channel[5000:5050] = np.nan
    kept = keep_extremes(np.arange(10_000.0), channel, limit=500)
    missing = kept[np.isnan(channel[kept])]
    assert missing.size > 0
    assert missing.min() >= 5000
    assert missing.max() < 5050


def test_a_short_record_is_kept_whole():
    assert keep_extremes(np.arange(5.0), np.ones(5), limit=10).tolist() == [0, 1, 2, 3, 4]


def test_intervals_of_a_logarithmic_axis_favour_its_start():
    time = np.linspace(0.1, 1e4, 100_000)
    kept = keep_extremes(np.log10(time), np.sin(time), limit=200)
    # one sample in a thousand lies there, and two decades of five
    assert (time[kept] < 10).sum() > 200 / 5


def test_a_sample_on_an_edge_belongs_to_the_interval_above():
    channel = np.ones(209)
    channel[60] = 0.0  # where the fifteenth of 52 intervals of four ends
    _, least, _ = least_and_greatest(np.arange(209.0), channel, n_intervals=52)
    assert np.flatnonzero(least == 0).tolist() == [15]


@given(CHANNELS, st.integers(3, 60))
def test_between_least_and_greatest_lies_every_sample_of_an_interval(channel, n_intervals):
    place = np.arange(channel.size, dtype=float)
    middle, least, greatest = least_and_greatest(place, channel, n_intervals=n_intervals)
    assert middle.size == n_intervals
    assert (np.diff(middle) > 0).all()
    own = np.minimum(place * n_intervals // (channel.size - 1), n_intervals - 1).astype(int)
    for interval in range(n_intervals):
        inside = channel[own == interval]
        known = inside[np.isfinite(inside)]
        if known.size:
            assert (least[interval], greatest[interval]) == (known.min(), known.max())
        else:
            assert np.isnan(least[interval]) and np.isnan(greatest[interval])


def test_nothing_has_no_edges():
    assert [one.size for one in least_and_greatest(np.zeros(0), np.zeros(0))] == [0, 0, 0]
