"""Expected widths: against the factors of the fifteen runs, a simulation, and lost runs."""

import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import (
    box_behnken,
    model_matrix,
    plackett_burman,
    quadratic_exponents,
)
from reduction.experiments.run_sheet import expected_precision
from reduction.record.errors import DataError, FitError

FIFTEEN = box_behnken(3).coded


def test_factors_of_fifteen_runs():
    # 1/3, 13/48, 1/8 and 1/4 from the inverse of the moments by hand; corner 1.396
    precision = expected_precision(FIFTEEN, sigma=1.0)
    np.testing.assert_allclose(
        precision.term_variance_factor, [1 / 3] + [13 / 48] * 3 + [1 / 8] * 3 + [1 / 4] * 3
    )
    factor = {
        kind: precision.point_variance_factor[np.array(precision.point_kind) == kind]
        for kind in ("centre", "design", "corner")
    }
    np.testing.assert_allclose(factor["centre"], [1 / 3])
    np.testing.assert_allclose(factor["design"], np.full(12, 0.75))
    np.testing.assert_allclose(factor["corner"], np.full(8, 67 / 48))
    assert precision.degrees_of_freedom == 5
    assert precision.condition_number == pytest.approx(4.24, abs=0.005)


def test_only_the_corners_lie_beyond_the_design():
    precision = expected_precision(FIFTEEN, sigma=1.0)
    expected = [kind == "corner" for kind in precision.point_kind]
    assert precision.is_beyond_design.tolist() == expected


def test_widths_are_students_times_the_root_of_the_factor():
    precision = expected_precision(FIFTEEN, sigma=0.02)
    reach = stats.t.ppf(0.975, 5) * 0.02
    assert precision.term_half_width[0] == pytest.approx(reach * np.sqrt(1 / 3))
    assert precision.confidence_half_width[0] == pytest.approx(reach * np.sqrt(1 / 3))
    assert precision.prediction_half_width[0] == pytest.approx(reach * np.sqrt(4 / 3))


def test_many_responses_at_once_are_each_as_alone():
    sigma = np.array([[0.1, 0.2], [0.3, 0.4]])
    many = expected_precision(FIFTEEN, sigma=sigma)
    assert many.term_half_width.shape == (2, 2, 10)
    assert many.confidence_half_width.shape == (2, 2, 21)
    alone = expected_precision(FIFTEEN, sigma=0.3)
    np.testing.assert_allclose(many.term_half_width[1, 0], alone.term_half_width)


def test_scatter_of_fitted_surfaces_is_what_was_expected():
    rng = np.random.default_rng(7)
    matrix = model_matrix(FIFTEEN, quadratic_exponents(3))
    coefficient = np.linalg.lstsq(matrix, rng.standard_normal((15, 40_000)), rcond=None)[0]
    found = coefficient.var(axis=1)
    expected = expected_precision(FIFTEEN, sigma=1.0).term_variance_factor
    np.testing.assert_allclose(found, expected, rtol=0.05)


@pytest.mark.parametrize("lost", [0, 14])
def test_a_lost_run_widens_every_interval_or_leaves_it(lost):
    whole = expected_precision(FIFTEEN, sigma=1.0)
    short = expected_precision(np.delete(FIFTEEN, lost, axis=0), sigma=1.0)
    assert short.degrees_of_freedom == 4
    assert np.all(short.term_half_width > whole.term_half_width)


def test_corners_that_are_runs_are_not_named_twice():
    cube = np.array(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 2)).reshape(2, -1).T
    precision = expected_precision(cube, sigma=1.0, factor_names=("f", "Tm"))
    assert precision.point_kind == ("centre",) + ("design",) * 8
    assert precision.terms[1] == "f^2"


def test_runs_that_cannot_carry_a_surface_are_refused():
    with pytest.raises(FitError, match="fewer runs than terms"):
        expected_precision(FIFTEEN[:8], sigma=1.0)
    with pytest.raises(
        FitError, match="as many runs as terms .* found 3 runs; needed more than the 3"
    ):
        expected_precision([[-1.0], [0.0], [1.0]], sigma=1.0)
    with pytest.raises(FitError, match="cannot tell all terms apart"):
        expected_precision(plackett_burman(3).coded, sigma=1.0)


@pytest.mark.parametrize("sigma", [0.0, -1.0, float("nan")])
def test_a_scatter_that_cannot_be_is_refused(sigma):
    with pytest.raises(DataError, match="sigma are not"):
        expected_precision(FIFTEEN, sigma=sigma)
