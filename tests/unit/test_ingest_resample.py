import numpy as np
import pytest

from reduction.readers.record_in_si import _on_common_time
from reduction.record.errors import DataError
from reduction.record.settings import QualitySettings

FAST, SLOW = np.arange(0, 10, 0.01), np.arange(0, 10, 0.1)
NAN = np.nan
QUALITY = QualitySettings(gap_factor=3.5)


def common(shared, values, own):
    values = {key: np.asarray(series, float) for key, series in values.items()}
    own = {key: np.asarray(series, float) for key, series in own.items()}
    shared = None if shared is None else np.asarray(shared, float)
    return _on_common_time(shared, values, own, quality=QUALITY)


def test_one_time_axis_is_handed_on_untouched():
    position = 2 * FAST
    result = _on_common_time(FAST, {"crosshead_position": position}, {}, quality=QUALITY)
    assert result.time is FAST and result.values["crosshead_position"] is position
    assert result.resampled == frozenset() and tuple(map(str, result.notes)) == ()


def test_own_time_stamps_equal_to_the_shared_time_are_no_second_axis():
    result = common(FAST, {"crosshead_position": FAST, "tension.1": FAST}, {"tension.1": FAST})
    assert result.resampled == frozenset()


def test_the_faster_channel_comes_to_the_slower_one():
    result = common(
        FAST, {"crosshead_position": 2 * FAST + 1, "tension.1": SLOW}, {"tension.1": SLOW + 0.003}
    )
    np.testing.assert_allclose(result.time, SLOW + 0.003)
    inside = slice(None, -1)
    np.testing.assert_allclose(
        result.values["crosshead_position"][inside], 2 * (SLOW + 0.003)[inside] + 1
    )
    np.testing.assert_allclose(result.values["tension.1"], SLOW)
    assert result.resampled == {"crosshead_position"}
    assert tuple(map(str, result.notes)) == (
        "crosshead_position: resampled from 100 Hz to the 10 Hz of tension.1, by cubics through four readings",
    )


def test_a_load_whose_lag_is_in_its_stamps_keeps_the_crest_of_a_wave():
    # the phase and amplitude of a sine are known in closed form; a straight line leaves cos(pi/16)
    step, lag = 1 / 16, 0.5 / 16
    rows = np.arange(0, 10, step)
    load = np.sin(2 * np.pi * (rows - lag))
    result = common(
        rows, {"crosshead_position": np.sin(2 * np.pi * rows), "tension.1": load},
        {"tension.1": rows - lag},
    )  # fmt: skip
    inside = slice(16, -16)
    turn = np.exp(-2j * np.pi * rows)[inside]
    found = 2 * np.mean(result.values["tension.1"][inside] * turn)
    assert abs(found / (2 * np.mean(np.sin(2 * np.pi * rows)[inside] * turn)) - 1) < 1e-3


def test_a_load_beside_a_jump_or_at_its_limit_is_not_overshot():
    load = np.where(FAST < 5, 0.0, 1.0)
    clipped = np.clip(np.sin(FAST), -0.5, 0.5)
    for series in (load, clipped):
        result = common(
            FAST, {"crosshead_position": FAST, "tension.1": series}, {"tension.1": FAST + 0.004}
        )
        known = result.values["tension.1"][1:]
        assert known.min() >= series.min() and known.max() <= series.max()


def test_a_slower_column_that_ends_before_the_table_is_cut_to_its_stamps():
    stamps = np.full(FAST.size, NAN)
    stamps[: SLOW.size] = SLOW
    result = common(FAST, {"crosshead_position": FAST, "tension.1": stamps}, {"tension.1": stamps})
    np.testing.assert_allclose(result.time, SLOW)


def test_nothing_is_interpolated_over_a_gap_or_beyond_the_ends():
    stamps = np.concatenate([np.arange(2.0, 4.0, 0.01), np.arange(6.0, 8.0, 0.01)])
    result = common(SLOW, {"crosshead_position": SLOW, "tension.1": stamps}, {"tension.1": stamps})
    known = np.isfinite(result.values["tension.1"])
    expected = ((SLOW > 1.995) & (SLOW < 3.995)) | ((SLOW > 5.995) & (SLOW < 7.995))
    assert np.array_equal(known, expected)


def test_a_missing_value_is_not_bridged():
    load = FAST.copy()
    load[500:520] = NAN
    result = common(SLOW, {"crosshead_position": SLOW, "tension.1": load}, {"tension.1": FAST})
    missing = np.flatnonzero(np.isnan(result.values["tension.1"]))
    assert set(missing) <= {50, 51, 52} and 51 in missing


def test_stamps_that_go_back_are_passed_over():
    stamps = FAST.copy()
    stamps[300:310] -= 0.5
    result = common(SLOW, {"crosshead_position": SLOW, "tension.1": FAST}, {"tension.1": stamps})
    known = np.isfinite(result.values["tension.1"])
    np.testing.assert_allclose(result.values["tension.1"][known], SLOW[known], atol=1e-9)


def test_a_counter_keeps_the_count_of_the_sample_before():
    count = np.floor(FAST)
    result = common(FAST, {"tension.1": SLOW, "cycle_counter": count}, {"tension.1": SLOW + 0.005})
    counted = result.values["cycle_counter"]
    np.testing.assert_equal(counted[:-1], np.floor(SLOW + 0.005)[:-1])


def test_a_channel_without_time_is_refused():
    with pytest.raises(DataError, match="channel 'tension.1' has no time; found neither"):
        common(None, {"tension.1": SLOW}, {})


def test_a_channel_with_a_single_stamp_is_refused():
    with pytest.raises(DataError, match="channel 'tension.1' has too few time stamps; found 1"):
        common(SLOW, {"crosshead_position": SLOW, "tension.1": SLOW[:2]}, {"tension.1": [0.0, NAN]})


def test_time_axes_that_do_not_overlap_are_two_time_bases():
    with pytest.raises(
        DataError,
        match=r"two time bases; found crosshead_position from 0 to 9.9 s, tension.1 from 1e",
    ):
        common(SLOW, {"crosshead_position": SLOW, "tension.1": FAST}, {"tension.1": FAST + 1e6})


def test_a_drop_out_is_not_interpolated_into_the_readings_beside_it():
    # the position reads 0 at 4 s; the load is read 4 ms before each reading of the position
    position = np.where(FAST < 3, FAST, 3.0)
    position[400] = 0.0
    load = np.arange(0, 10, 0.011)
    result = common(FAST, {"crosshead_position": position, "tension.1": load}, {"tension.1": load})
    found, clean = result.values["crosshead_position"], np.minimum(load, 3.0)
    lost = np.isnan(found) & (load < 9.9)
    assert 1 <= lost.sum() <= 3 and np.abs(load[lost] - 4.0).max() < 0.011
    known = np.isfinite(found)
    assert np.abs(found - clean)[known].max() < 0.01
    assert "readings of crosshead_position jump away and back at once (1, " in str(result.notes[0])
