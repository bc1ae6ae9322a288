"""Relaxed lengths of tape readings; covariances against many sets of marks drawn."""

import numpy as np
import pytest
from scipy import stats

from reduction.record.errors import DataError
from reduction.stages.strain.mark_readings import relaxed_lengths

READING = 0.00124
DRAWS = 4000


def drawn_rows(n_rows, seed):
    """Free and splice lengths of many sets of slack rows."""
    near, far, thimble = np.random.default_rng(seed).normal(0, READING, (3, DRAWS, n_rows))
    return 2.55 + far - near, 1.18 + thimble - far + near


def test_relaxed_lengths_share_their_toe_readings():
    free, splice = drawn_rows(6, 1)
    means = np.stack([free.mean(axis=1), splice.mean(axis=1)])
    found = relaxed_lengths([2.55], [1.18], reading_uncertainty=READING)
    # one row is all the tape says; six rows are a sixth of it
    np.testing.assert_allclose(np.cov(means), found.covariance / 6, rtol=0.1)


def test_scatter_that_the_tape_explains_leaves_its_error_as_stated():
    """The larger of both would be 1.37 times too large in the mean: E max(1, chi^2_2 / 2)."""
    free, splice = drawn_rows(2, 2)
    found = [
        relaxed_lengths(one, other, reading_uncertainty=READING).covariance
        for one, other in zip(free, splice, strict=True)
    ]
    # two rows leave two degrees of freedom; sound ones are widened in one set of 200
    expected = 1 + stats.chi2.sf(stats.chi2.isf(0.005, 2), 4) - 0.005
    assert expected == pytest.approx(1.027, abs=1e-3)
    mean = np.mean(found, axis=0).diagonal() / (np.array([2.0, 3.0]) * READING**2 / 2)
    np.testing.assert_allclose(mean, expected, atol=0.02)


def test_relaxed_lengths_that_differ_are_widened_together():
    found = relaxed_lengths([2.50, 2.60], [1.18, 1.18], reading_uncertainty=READING)
    assert found.values.tolist() == pytest.approx([2.55, 1.18])
    # the inverse of [[2, -2], [-2, 3]] has 3/2 for the free length; two rows, each 0.05 off
    chi_square = 2 * 1.5 * (0.05 / READING) ** 2
    widened = READING**2 * chi_square / 2
    np.testing.assert_allclose(found.covariance, widened * np.array([[2, -2], [-2, 3]]) / 2)
    ratio = np.sqrt(chi_square / 2)
    assert str(found.note).startswith(
        f"the rows scatter {ratio:.1f} times as much as tape reading explains"
    )


def test_rows_without_a_stated_error_take_their_scatter():
    free = np.array([2.54, 2.55, 2.56])
    found = relaxed_lengths(free, 3.73 - free, reading_uncertainty=0.0)
    # free and splices differ by one toe: their scatter is 1 cm each, against one another, and
    # 0.01^2 (3/2 - 2 + 1) in readings; four degrees of freedom, Student's t 2.776 over 1.960
    reading = np.sqrt(2 * 0.01**2 * 0.5 / 4) * 2.776445 / 1.959964
    assert np.sqrt(found.covariance[0, 0]) == pytest.approx(reading * np.sqrt(2 / 3), rel=1e-5)
    assert str(found.note).endswith("it is estimated from their scatter, with 4 degrees of freedom")


def test_no_slack_row_is_refused():
    with pytest.raises(DataError, match="the marks have no slack row"):
        relaxed_lengths([], [], reading_uncertainty=READING)


def test_relaxed_lengths_are_positive():
    with pytest.raises(DataError, match="relaxed length are not positive"):
        relaxed_lengths([0.0], [1.18], reading_uncertainty=READING)
