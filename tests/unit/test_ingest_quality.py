import numpy as np
import pytest

from reduction.readers.sample_flags import (
    _find_missing,
    _find_outside_range,
    _find_spikes,
    _noise_of,
    _time_faults,
)
from reduction.record.measurement import Quality, Record
from reduction.record.row_counts import count_rows

RANDOM = np.random.default_rng(20051010)
CLOCK = np.arange(0, 200, 0.1)


def triangle(time, period=20.0, low=0.0, high=100.0):
    """Constant rate up and down."""
    phase = np.abs((time / period) % 1 - 0.5) * 2
    return high - (high - low) * phase


def faults(time):
    return _time_faults(np.asarray(time, float), gap_factor=3.5, rate_tolerance=0.2)


def spikes(values, factor=12.0):
    return np.flatnonzero(_find_spikes(values, noise=_noise_of(values)[0], factor=factor))


def test_missing_values_are_those_that_are_nan():
    values = np.array([1.0, np.nan, 3.0])
    assert _find_missing(values).tolist() == [False, True, False]
    assert not _find_missing(np.array([1e300, 1e300])).any()


def test_values_outside_the_verified_range_are_both_too_low_and_too_high():
    values = np.array([-1.0, 0.0, 5.0, 10.0, 11.0, np.nan])
    assert _find_outside_range(values, 0.0, 10.0).tolist() == [
        True,
        False,
        False,
        False,
        True,
        False,
    ]
    assert not _find_outside_range(values[1:4], 0.0, 10.0).any()


def test_an_even_time_axis_has_no_fault():
    timing = faults(CLOCK)
    assert not timing.gap.any() and not timing.backward.any()
    assert timing.n_uneven == 0
    assert timing.step == pytest.approx(0.1)


def test_a_gap_is_flagged_at_the_first_sample_after_it():
    time = np.delete(CLOCK, slice(50, 60))
    timing = faults(time)
    assert np.flatnonzero(timing.gap).tolist() == [50]
    assert timing.n_uneven == 0 and timing.longest == pytest.approx(0.1)


def test_three_and_a_half_median_steps_are_no_gap_yet():
    assert not faults(np.delete(CLOCK, slice(50, 52))).gap.any()
    assert faults(np.delete(CLOCK, slice(50, 53))).gap.any()


def test_a_slow_part_of_a_log_is_not_a_row_of_gaps():
    time = np.concatenate(
        [np.arange(0, 100, 0.1), np.arange(100, 200, 1.0), np.arange(200, 300, 0.1)]
    )
    timing = faults(time)
    assert not timing.gap.any()
    assert timing.n_uneven == 100
    assert (timing.shortest, timing.longest) == (pytest.approx(0.1), pytest.approx(1.0))


def test_gaps_at_both_ends_are_found():
    time = np.concatenate([[0.0], np.arange(5, 10, 0.1), [20.0]])
    assert np.flatnonzero(faults(time).gap).tolist() == [1, time.size - 1]


def test_repeated_and_backward_time_is_flagged_until_the_clock_has_caught_up():
    timing = faults([0.0, 0.1, 0.2, 0.2, 0.3, 0.15, 0.25, 0.3, 0.4, 0.5])
    assert np.flatnonzero(timing.backward).tolist() == [3, 5, 6, 7]


def test_backward_time_is_seen_across_the_pieces_in_which_the_axis_is_read():
    time = np.arange(200_000) * 0.1
    time[1 << 16 :] -= 5.0  # 50 samples of a clock set back, exactly where a piece begins
    found = np.flatnonzero(faults(time).backward)
    assert found.tolist() == list(range(1 << 16, (1 << 16) + 50))


def test_missing_time_is_neither_gap_nor_backward():
    time = CLOCK.copy()
    time[100] = np.nan
    timing = faults(time)
    assert not timing.gap.any() and not timing.backward.any()


def test_a_clock_that_stands_still_is_backward_throughout():
    timing = faults(np.zeros(5))
    assert timing.backward.tolist() == [False, True, True, True, True]
    assert np.isnan(timing.step)


def test_an_uneven_rate_is_counted_with_its_extremes():
    time = np.cumsum(np.tile([0.1, 0.1, 0.1, 0.15], 100))
    timing = faults(time)
    assert timing.n_uneven == 100
    assert timing.longest == pytest.approx(0.15)


def test_noise_is_that_which_was_put_in():
    values = triangle(CLOCK) + RANDOM.normal(0, 0.5, CLOCK.size)
    noise, _ = _noise_of(values)
    assert noise == pytest.approx(0.5, rel=0.1)


def test_noise_of_a_long_series_is_found_from_parts_of_it():
    values = np.tile(triangle(CLOCK), 100) + RANDOM.normal(0, 0.5, 100 * CLOCK.size)
    assert _noise_of(values)[0] == pytest.approx(0.5, rel=0.1)


def test_noise_is_never_below_what_the_printed_step_makes():
    values = np.round(triangle(CLOCK, period=200.0) / 0.244) * 0.244
    noise, step = _noise_of(values)
    assert step == pytest.approx(0.244)
    assert noise >= 0.244 / np.sqrt(12)


def test_a_constant_series_has_no_noise_and_no_spike():
    assert _noise_of(np.ones(100)) == (0.0, 0.0)
    assert not _find_spikes(np.ones(100), noise=0.0, factor=12.0).any()


@pytest.mark.parametrize("noise", [0.0, 0.3])
@pytest.mark.parametrize("quantum", [0.0, 0.244])
def test_reversals_ramp_starts_steps_and_holds_are_no_spikes(noise, quantum):
    time = np.arange(0, 2000, 0.1)
    shapes = [
        triangle(time),  # sharp peaks
        triangle(time, period=0.8),  # four samples up, four down
        50 * np.sin(2 * np.pi * time / 20),
        50 * np.sin(2 * np.pi * time / 0.4 + 0.1),  # four samples a cycle
        np.clip(triangle(time, low=-200, high=300), 0, 100),  # ramp starts and holds
        np.where(time % 40 < 20, 0.0, 100.0),  # steps
        np.where(time % 1.5 < 0.75, 0.0, 100.0),  # steps every seven or eight samples
        np.where(time % 3 < 0.5, 100.0, 0.0),  # a cycle that is 5 samples up and 25 down
        np.where(time % 1000 < 2, triangle(time, period=0.5), 0),  # a few sharp short cycles
    ]
    for values in shapes:
        values = values + noise * RANDOM.normal(size=time.size)
        values = np.round(values / quantum) * quantum if quantum else values
        assert spikes(values).size == 0


def test_single_samples_far_off_are_spikes_on_ramps_holds_and_close_together():
    values = np.clip(triangle(CLOCK, low=-50, high=100), 0, 100)
    values += RANDOM.normal(0, 0.3, values.size)
    for place, size in [(10, 30.0), (60, -20.0), (63, 25.0), (555, 40.0), (1990, -30.0)]:
        values[place] += size
    assert spikes(values).tolist() == [10, 60, 63, 555, 1990]


def test_a_spike_where_two_pieces_of_a_long_series_meet_is_found():
    values = np.tile(triangle(CLOCK), 100) + RANDOM.normal(0, 0.3, 100 * CLOCK.size)
    for place in (65535, 131072, 131073 + 10):
        values[place] += 40.0
    assert spikes(values).tolist() == [65535, 131072, 131083]


def test_a_missing_neighbour_makes_no_spike():
    values = triangle(CLOCK)
    values[500] = np.nan
    assert spikes(values).size == 0


def test_every_row_is_accounted_for_by_mask_and_channel():
    flags = np.zeros((2, 4), dtype=np.uint16)
    flags[0, 1] = Quality.SPIKE | Quality.RESAMPLED
    flags[0, 2] = Quality.SPIKE
    record = Record(
        test_id="T-1",
        specimens=("new", "used"),
        time=np.arange(4.0),
        crosshead_position=np.ones(4),
        tension=np.ones((2, 4)),
        quality_flag=flags,
        crosshead_position_quality_flag=np.full(4, Quality.GAP, dtype=np.uint16),
        n_rows_read=5,
    )
    account = count_rows(record)
    assert (account.n_read, account.n_kept) == (5, 4)
    assert account.n_flagged == {
        "crosshead_position": {"gap": 4},
        "tension of new": {"spike": 2, "resampled": 1},
        "tension of used": {},
    }


def test_an_encoder_that_is_printed_finer_than_it_counts_has_no_spikes():
    # synthetic: codes of .2 um, of which one flickers on a slow ramp, and a drift of a tenth of one
    rng, count = np.random.default_rng(5), np.arange(3000.0)
    counted = np.floor(0.15 * count + 0.1 * rng.standard_normal(3000))
    printed = np.round(0.1997 * counted + 0.02 * np.sin(count / 40), 2)
    noise, _ = _noise_of(printed)
    assert noise * 12 < 0.15  # less than a code
    assert not _find_spikes(printed, noise=noise, factor=12.0).any()
    # what is five codes off is one
    printed[1500] += 1.0
    assert np.flatnonzero(_find_spikes(printed, noise=noise, factor=12.0)).tolist() == [1500]
