"""Coefficients of splice laws and their covariances.

Covariances are checked against many sets of marks drawn with reading errors: an
independent way to the same number.
"""

import numpy as np
import pytest
from refusals import refusals
from scipy.optimize import curve_fit

from reduction.record.errors import DataError, FitError
from reduction.stages.strain.splice_calibration import (
    fit_free_length_line,
    fit_power_law,
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


# A power law of tension fitted to the splices

RELAXED, READING_OF_LAW = 1.18, 0.00124
FORCE = np.array([190.0, 250.0, 380.0, 480.0, 600.0, 720.0, 900.0, 1100.0, 1300.0, 1600.0])
COMPLIANCE, EXPONENT = 0.00118, 0.86


def splice(force=FORCE, compliance=COMPLIANCE, exponent=EXPONENT, relaxed=RELAXED):
    return relaxed * (1 + compliance * force**exponent)


def noisy(seed):
    return splice() + np.random.default_rng(seed).normal(0, np.sqrt(3) * READING_OF_LAW, FORCE.size)


def law(lengths, force=FORCE, relaxed=RELAXED, **more):
    return fit_power_law(
        lengths, force, relaxed_splice_length=relaxed, reading_uncertainty=READING_OF_LAW, **more
    )


def test_exact_marks_give_the_law_back():
    found = law(splice())
    assert found.values == pytest.approx([COMPLIANCE, EXPONENT], rel=1e-6)
    np.testing.assert_allclose(found.residual, 0, atol=1e-8)


def test_coefficients_and_covariance_agree_with_levenberg_and_marquardt():
    lengths = noisy(5)
    expected, covariance = curve_fit(
        lambda force, c, n: splice(force, c, n),
        FORCE,
        lengths,
        p0=(0.001, 0.9),
        absolute_sigma=False,
    )
    found = law(lengths)
    assert found.values == pytest.approx(expected, rel=1e-5)
    spare = FORCE.size - 2
    scatter = found.residual @ found.residual / spare
    # the marks scatter as the tape says: the stated error stands
    np.testing.assert_allclose(
        found.covariance, covariance * 3 * READING_OF_LAW**2 / scatter, rtol=1e-3
    )
    assert found.note is None


def test_the_covariance_is_that_of_many_sets_of_marks():
    drawn = np.array([law(noisy(seed)).values for seed in range(300)])
    expected = np.sqrt(np.diag(law(splice()).covariance))
    np.testing.assert_allclose(drawn.std(axis=0), expected, rtol=0.15)


def test_the_variance_of_three_marks_is_not_the_larger_of_tape_and_scatter():
    """That would be 1.22 times the standard uncertainty too large: one mark is to spare."""
    three = FORCE[[0, 3, 9]]
    rng = np.random.default_rng(8)
    lengths = splice(three) + rng.normal(0, np.sqrt(3) * READING_OF_LAW, (600, 3))
    found = [law(row, three) for row in lengths]
    stated = np.sqrt(np.mean([one.covariance[1, 1] for one in found]))
    drawn = np.std([one.values[1] for one in found])
    assert stated / drawn == pytest.approx(1.02, abs=0.09)  # three times 1 / sqrt(2 * 600)


def test_marks_that_contradict_the_tape_widen_the_law():
    lengths = noisy(5)
    lengths[4] += 0.03
    found = law(lengths)
    assert "times as much as tape reading explains" in str(found.note)
    scatter = found.residual @ found.residual / (FORCE.size - 2)
    assert found.covariance[1, 1] / law(noisy(5)).covariance[1, 1] == pytest.approx(
        scatter / (3 * READING_OF_LAW**2), rel=0.1
    )


def test_a_law_follows_the_relaxed_length_as_stated():
    lengths = splice()
    high, low = (law(lengths, relaxed=RELAXED + step).values for step in (1e-5, -1e-5))
    found = law(lengths).relaxed_sensitivity
    np.testing.assert_allclose(found[:, 1], (high - low) / 2e-5, rtol=1e-3)
    assert found[:, 0].tolist() == [0.0, 0.0]


def test_a_held_exponent_is_returned_with_no_uncertainty():
    found = law(splice(exponent=1.0), exponent=1.0)
    assert found.values == pytest.approx([COMPLIANCE, 1.0])
    assert found.covariance[1].tolist() == [0.0, 0.0]
    assert found.covariance[0, 0] > 0


def test_one_mark_is_enough_for_a_held_exponent_and_not_for_a_free_one():
    one = FORCE[:1]
    assert law(splice(one), one, exponent=1.0).residual == pytest.approx([0.0], abs=1e-12)
    with pytest.raises(DataError, match="needs more marks; found 1 stretched rows"):
        law(splice(one), one)


@pytest.mark.parametrize("exponent", [0.1, 2.5])
def test_an_exponent_at_the_edge_of_its_range_is_refused(exponent):
    with pytest.raises(FitError, match="runs to the edge of its range"):
        law(splice(compliance=0.2 / 600**exponent, exponent=exponent))


REFUSED = {
    "marks at one position have no line": (
        lambda: fit_free_length_line([4.0, 4.1], [5.0, 5.0], reading_uncertainty=READING),
        DataError,
        "a line needs marks at two positions; found 1",
    ),
    "a missing mark is refused": (
        lambda: fit_free_length_line([4.0, 5.0], [5.0, np.nan], reading_uncertainty=READING),
        DataError,
        "1 of 2 values of position are not finite",
    ),
    "splices that do not lengthen are refused": (
        lambda: law(RELAXED - 1e-5 * FORCE),
        FitError,
        "the splices do not lengthen with tension",
    ),
    "a slack mark is no mark of the law": (
        lambda: law(splice(), np.where(FORCE > 1500, 0.0, FORCE)),
        DataError,
        "1 of 10 values of tension are not positive",
    ),
}


test_refusals = refusals(REFUSED)
