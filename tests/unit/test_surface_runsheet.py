"""Order of the runs: rising load, repeats together or spread, loads that are not known."""

import numpy as np
import pytest

from reduction.experiments.designs import FactorLevels, box_behnken, plackett_burman
from reduction.experiments.run_sheet import make_run_sheet
from reduction.record.errors import DataError, SettingsError

FREQUENCY = FactorLevels("frequency", 0.1, 0.5)
MEAN = FactorLevels("mean_tension", 1000.0, 3000.0)
AMPLITUDE = FactorLevels("tension_amplitude", 200.0, 600.0)


def test_every_run_stands_on_the_sheet_once_with_its_own_levels():
    design = box_behnken(3)
    sheet = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE))
    assert sorted(sheet.run) == list(range(1, 16))
    np.testing.assert_array_equal(sheet.coded, design.coded[sheet.run - 1])
    np.testing.assert_allclose(sheet.engineering[:, 1], 2000 + 1000 * sheet.coded[:, 1])
    assert sheet.names == ("frequency", "mean_tension", "tension_amplitude")
    assert sheet.n_runs == 15


def test_peak_never_falls_and_blocks_count_from_one():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    assert np.all(np.diff(sheet.peak_tension) >= 0)
    assert np.all(np.isin(np.diff(sheet.load_block), [0, 1])) and sheet.load_block[0] == 1


def test_runs_of_equal_peak_share_a_block_though_their_last_bit_differs():
    # 0.1 + 0.2 is not 0.3: mean and amplitude swap places at equal peaks
    mean = FactorLevels("mean_tension", 0.3, 0.5)
    amplitude = FactorLevels("tension_amplitude", 0.05, 0.25)
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, mean, amplitude))
    corner = [(0, -1, 1), (0, 1, -1)]
    blocks = {
        int(b) for row, b in zip(sheet.coded, sheet.load_block, strict=True) if tuple(row) in corner
    }
    assert len(blocks) == 1
    # and the lower mean comes first
    assert [tuple(row) for row in sheet.coded if tuple(row) in corner] == corner


@pytest.mark.parametrize("n_centre", [2, 3, 5])
def test_spread_repeats_end_the_sheet_and_never_load_a_later_run_beforehand(n_centre):
    design = box_behnken(3, n_centre=n_centre)
    together = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE))
    sheet = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE), repeats="spread")
    centre = np.flatnonzero(np.all(sheet.coded == 0, axis=1))
    assert centre[0] == np.flatnonzero(np.all(together.coded == 0, axis=1))[0]
    assert centre[-1] == sheet.n_runs - 1
    assert np.all(np.diff(centre) > 1) and np.ptp(np.diff(centre)) <= 1
    rest = np.delete(sheet.peak_tension, centre[1:])
    assert np.all(np.diff(rest) >= 0)
    assert sorted(sheet.run) == list(range(1, design.n_runs + 1))


def test_shares_are_not_numbers_without_a_break_strength():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    assert np.isnan(sheet.peak_share).all() and np.isnan(sheet.minimum_share).all()
    assert np.isfinite(sheet.peak_tension).all()


def test_shares_follow_the_break_strength_of_each_run():
    design = plackett_burman(3)
    strength = np.where(design.coded[:, 2] > 0, 20e3, 10e3)
    factors = (MEAN, AMPLITUDE, FactorLevels("diameter", 0.5, 1.0))
    sheet = make_run_sheet(design, factors, rated_break_strength=strength)
    expected = sheet.peak_tension / np.where(sheet.coded[:, 2] > 0, 20e3, 10e3)
    np.testing.assert_allclose(sheet.peak_share, expected)


def test_without_a_load_the_standard_order_is_kept():
    design = box_behnken(3)
    factors = (FREQUENCY, MEAN, FactorLevels("temperature", 5.0, 20.0))
    sheet = make_run_sheet(design, factors)
    np.testing.assert_array_equal(sheet.run, np.arange(1, 16))
    assert np.isnan(sheet.peak_tension).all() and not sheet.load_block.any()
    np.testing.assert_allclose(sheet.mean_tension, 2000 + 1000 * design.coded[:, 1])


def test_another_placing_of_repeats_is_refused():
    with pytest.raises(
        SettingsError, match="one of two ways; found random; needed together or spread"
    ):
        make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), repeats="random")


def test_a_break_strength_that_cannot_be_is_refused_though_no_level_needs_it():
    with pytest.raises(DataError, match="rated_break_strength are not positive"):
        make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), rated_break_strength=0.0)
    with pytest.raises(DataError, match="break strength does not fit the runs"):
        make_run_sheet(
            box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), rated_break_strength=[1.0, 2.0]
        )


def test_a_sheet_is_read_only():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    with pytest.raises(ValueError, match="read-only"):
        sheet.peak_tension[0] = 0
