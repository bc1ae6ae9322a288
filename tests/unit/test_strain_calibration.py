"""Coefficients of splice laws and their covariances.

Covariances are checked against many sets of marks drawn with reading errors: an
independent way to the same number.
"""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain.splice_calibration import (
    fit_free_length_line,
    fit_splice_ratio,
    line_slope,
)

READING = 0.00124
DRAWS = 4000


def drawn_rows(free, splice, seed):
    """Free and splice lengths of many sets of marks; the near splice is half of both."""
    rng = np.random.default_rng(seed)
    near, far, thimble = rng.normal(0, READING, (3, DRAWS, np.size(free)))
    return free + far - near, splice + thimble - far + near


def test_two_marks_give_the_line_through_them():
    line = fit_free_length_line([4.0, 5.0], [5.0, 6.25], reading_uncertainty=READING)
    assert line.values.tolist() == pytest.approx([0.0, 0.8])
    np.testing.assert_allclose(line.residual, 0, atol=1e-14)


def test_the_covariance_of_a_line_is_that_of_many_sets_of_marks():
    true_free, true_splice = np.array([4.5, 5.2, 5.8]), np.array([1.40, 1.46, 1.55])
    free, splice = drawn_rows(true_free, true_splice, 2)
    # slope and intercept of each set, by the normal equations of numpy
    fits = [np.polyfit(f + s, f, 1)[::-1] for f, s in zip(free, splice, strict=True)]
    line = fit_free_length_line(true_free, true_free + true_splice, reading_uncertainty=READING)
    residual_free = fit_free_length_line(
        line.values[0] + line.values[1] * (true_free + true_splice),
        true_free + true_splice,
        reading_uncertainty=READING,
    )
    np.testing.assert_allclose(
        np.sqrt(np.diag(np.cov(np.transpose(fits)))),
        np.sqrt(np.diag(residual_free.covariance)),
        rtol=0.05,
    )
    assert residual_free.covariance[0, 1] < 0


def test_marks_at_one_position_have_no_line():
    with pytest.raises(DataError, match="a line needs marks at two positions; found 1"):
        fit_free_length_line([4.0, 4.1], [5.0, 5.0], reading_uncertainty=READING)


def test_a_missing_mark_is_refused():
    with pytest.raises(DataError, match="1 of 2 values of position are not finite"):
        fit_free_length_line([4.0, 5.0], [5.0, np.nan], reading_uncertainty=READING)


def test_the_uncertainty_of_a_ratio_is_that_of_many_sets_of_marks():
    ratio, strain = 0.23, np.array([0.76, 1.02, 1.27])
    true_free, true_splice = 2.55 * (1 + strain), 1.18 * (1 + ratio * strain)
    free, splice = drawn_rows(true_free, true_splice, 3)
    x, y = free / 2.55 - 1, splice / 1.18 - 1
    drawn = np.sum(x * y, axis=1) / np.sum(x * x, axis=1)
    found = fit_splice_ratio(
        true_free,
        true_splice,
        relaxed_free_length=2.55,
        relaxed_splice_length=1.18,
        reading_uncertainty=READING,
    )
    assert found.values[0] == pytest.approx(ratio, abs=1e-12)
    assert np.sqrt(found.covariance[0, 0]) == pytest.approx(drawn.std(), rel=0.05)


@pytest.mark.parametrize("which", [0, 1])
def test_a_ratio_follows_the_relaxed_lengths_as_stated(which):
    free, splice = np.array([4.5, 5.2, 5.8]), np.array([1.40, 1.46, 1.55])
    lengths = np.array([2.55, 1.18])

    def ratio(values):
        return fit_splice_ratio(
            free,
            splice,
            relaxed_free_length=values[0],
            relaxed_splice_length=values[1],
            reading_uncertainty=READING,
        )

    step = 1e-6 * np.eye(2)[which]
    slope = (ratio(lengths + step).values[0] - ratio(lengths - step).values[0]) / 2e-6
    assert ratio(lengths).relaxed_sensitivity[0, which] == pytest.approx(slope, rel=1e-6)


def test_a_ratio_without_stretch_is_refused():
    with pytest.raises(DataError, match="a strain ratio needs a stretched row"):
        fit_splice_ratio(
            [2.5], [1.2], relaxed_free_length=2.5, relaxed_splice_length=1.2, reading_uncertainty=0
        )


def test_marks_that_contradict_the_tape_widen_line_and_ratio_and_say_so():
    free = np.array([4.5, 5.2, 5.8])
    splice = 1.18 * (1 + 0.23 * (free / 2.55 - 1))
    off = 30 * READING * np.array([0.0, 1.0, 0.0])
    relaxed = {"relaxed_free_length": 2.55, "relaxed_splice_length": 1.18}
    sound = (
        fit_free_length_line(free, free + splice, reading_uncertainty=READING),
        fit_splice_ratio(free, splice, reading_uncertainty=READING, **relaxed),
    )
    wide = (
        fit_free_length_line(free + off, free + splice, reading_uncertainty=READING),
        fit_splice_ratio(free + off, splice - off, reading_uncertainty=READING, **relaxed),
    )
    for before, after in zip(sound, wide, strict=True):
        assert before.note is None
        assert "times as much as tape reading explains" in str(after.note)
    # the variance is then that of the residuals: one degree of freedom of the line, two of the ratio
    at = free + splice
    assert wide[0].covariance[1, 1] == pytest.approx(
        np.sum(wide[0].residual ** 2) / np.sum((at - at.mean()) ** 2)
    )
    ratio = np.sqrt(wide[1].covariance[0, 0] / sound[1].covariance[0, 0])
    assert ratio > 5


def test_a_ratio_without_a_stated_error_takes_its_scatter():
    free, splice = np.array([4.5, 5.2, 5.8]), np.array([1.40, 1.46, 1.55])
    found = fit_splice_ratio(
        free, splice, relaxed_free_length=2.55, relaxed_splice_length=1.18, reading_uncertainty=0.0
    )
    x = free / 2.55 - 1
    expected = found.residual @ found.residual / 2 / (x @ x) * (4.302653 / 1.959964) ** 2
    assert found.covariance[0, 0] == pytest.approx(expected, rel=1e-5)
    assert str(found.note).endswith("it is estimated from their scatter, with 2 degrees of freedom")


def test_line_slope_is_that_of_numpy():
    rng = np.random.default_rng(4)
    position, values = rng.random(9), rng.random(9)
    assert line_slope(position, values) == pytest.approx(np.polyfit(position, values, 1)[0])
