"""Scatter of tape readings; expected values from printed quantiles and from draws."""

import numpy as np
import pytest
from scipy import stats

from reduction.stages.strain.mark_readings import LEVEL, row_scatter

LINE = np.stack([np.ones(3), np.arange(3.0)])
AWAY = np.array([1.0, -2.0, 1.0]) / np.sqrt(6)  # what no line through three rows can follow


def test_a_stated_error_stands_up_to_the_quantile_and_widens_beyond():
    # 7.879 is the 99.5 % point of chi-square with one degree of freedom
    inside = row_scatter(4.0, 2 * np.sqrt(7.87) * AWAY, LINE)
    assert (inside.variance, inside.widening, inside.note) == (4.0, 1.0, None)
    beyond = row_scatter(4.0, 2 * np.sqrt(7.89) * AWAY, LINE)
    assert beyond.widening == pytest.approx(np.sqrt(7.89))
    assert beyond.variance == pytest.approx(4.0 * 7.89)
    assert str(beyond.note) == (
        "the rows scatter 2.8 times as much as tape reading explains (chi-square 7.89 with 1 "
        "degree of freedom, probability one in 201); their uncertainty is increased by this factor"
    )


def test_an_error_of_what_the_rows_share_explains_residuals_too():
    # the relaxed length moves the rows by twice what one reading does, along what is left over
    found = row_scatter(1.0, 4.0 * AWAY, LINE, 2.0 * AWAY)
    assert found.widening == 1.0  # 16 / (1 + 4) is 3.2
    assert row_scatter(1.0, 4.0 * AWAY, LINE).widening == pytest.approx(4.0)


def test_what_the_coefficients_follow_explains_nothing():
    assert row_scatter(1.0, 4.0 * AWAY, LINE, 5.0 * LINE).widening == pytest.approx(4.0)


def test_the_mean_variance_of_sound_rows_is_the_derived_one():
    rng = np.random.default_rng(3)
    residual = rng.normal(size=(20_000, 1)) * AWAY
    mean = np.mean([row_scatter(1.0, one, LINE).variance for one in residual])
    expected = 1 + stats.chi2.sf(stats.chi2.isf(LEVEL, 1), 3) - LEVEL
    assert expected == pytest.approx(1.0436, abs=1e-4)
    assert mean == pytest.approx(expected, abs=0.015)


def test_without_a_stated_error_an_interval_by_1_96_holds_95_per_cent():
    rng = np.random.default_rng(4)
    rows = rng.normal(size=(4000, 3))
    held = [
        abs(row.mean())
        <= 1.96 * np.sqrt(row_scatter(0.0, row - row.mean(), np.ones((1, 3))).variance / 3)
        for row in rows
    ]
    assert np.mean(held) == pytest.approx(0.95, abs=0.011)


@pytest.mark.parametrize(
    ("size", "note"), [(2, "they are treated as exact"), (3, "1 degree of freedom")]
)
def test_without_a_stated_error_the_note_says_what_is_taken(size, note):
    found = row_scatter(0.0, np.zeros(size), LINE[:, :size])
    assert found.variance == 0.0
    assert str(found.note).startswith("the rows have no stated reading error") and str(
        found.note
    ).endswith(note)


def test_a_row_to_spare_is_needed_to_refute_the_tape():
    assert row_scatter(1.0, np.zeros(2), LINE[:, :2]).variance == 1.0


def test_odds_that_are_too_small_to_print_are_not_printed():
    assert "below one in a million" in str(row_scatter(1.0, 100 * AWAY, LINE).note)
