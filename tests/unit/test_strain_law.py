"""A power law of tension fitted to the splices."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

from reduction.record.errors import DataError, FitError
from reduction.stages.strain.splice_calibration import fit_power_law

RELAXED, READING = 1.18, 0.00124
FORCE = np.array([190.0, 250.0, 380.0, 480.0, 600.0, 720.0, 900.0, 1100.0, 1300.0, 1600.0])
COMPLIANCE, EXPONENT = 0.00118, 0.86


def splice(force=FORCE, compliance=COMPLIANCE, exponent=EXPONENT, relaxed=RELAXED):
    return relaxed * (1 + compliance * force**exponent)


def noisy(seed):
    return splice() + np.random.default_rng(seed).normal(0, np.sqrt(3) * READING, FORCE.size)


def law(lengths, force=FORCE, relaxed=RELAXED, **more):
    return fit_power_law(
        lengths, force, relaxed_splice_length=relaxed, reading_uncertainty=READING, **more
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
    np.testing.assert_allclose(found.covariance, covariance * 3 * READING**2 / scatter, rtol=1e-3)
    assert found.note is None


def test_the_covariance_is_that_of_many_sets_of_marks():
    drawn = np.array([law(noisy(seed)).values for seed in range(300)])
    expected = np.sqrt(np.diag(law(splice()).covariance))
    np.testing.assert_allclose(drawn.std(axis=0), expected, rtol=0.15)


def test_the_variance_of_three_marks_is_not_the_larger_of_tape_and_scatter():
    """That would be 1.22 times the standard uncertainty too large: one mark is to spare."""
    three = FORCE[[0, 3, 9]]
    rng = np.random.default_rng(8)
    lengths = splice(three) + rng.normal(0, np.sqrt(3) * READING, (600, 3))
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
        scatter / (3 * READING**2), rel=0.1
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


def test_splices_that_do_not_lengthen_are_refused():
    with pytest.raises(FitError, match="the splices do not lengthen with tension"):
        law(RELAXED - 1e-5 * FORCE)


@pytest.mark.parametrize("exponent", [0.1, 2.5])
def test_an_exponent_at_the_edge_of_its_range_is_refused(exponent):
    with pytest.raises(FitError, match="runs to the edge of its range"):
        law(splice(compliance=0.2 / 600**exponent, exponent=exponent))


def test_a_slack_mark_is_no_mark_of_the_law():
    with pytest.raises(DataError, match="1 of 10 values of tension are not positive"):
        law(splice(), np.where(FORCE > 1500, 0.0, FORCE))
