import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.comparison_error import (
    N_DRAWS,
    _probability_words,
    validate_curve,
    verdict_words,
)
from reduction.prediction.hose_comparison import _input_draws
from reduction.prediction.hose_tension import predict_hose
from reduction.prediction.measured_curve import constant_errors, measured_curve
from reduction.record.errors import DataError

STROKE = np.linspace(0, 1, 600)


def pulled(tension, **shared):
    return measured_curve(STROKE, tension, loading="static", shared=constant_errors(**shared))


def exact(curve):
    return np.zeros((0, curve.strain.size))


def test_variances_of_test_and_prediction_add():
    test = pulled(1000 + 0 * STROKE, tension_offset=3.0)
    draws = np.random.default_rng(1).normal(0, 4, (20_000, 1)) + np.zeros(test.strain.size)
    found = validate_curve(1000 + 0 * test.strain, test, input_error=draws)
    middle = slice(2, -2)
    assert found.measurement_standard_uncertainty[middle] == pytest.approx(3, abs=1e-6)
    assert found.input_standard_uncertainty[middle] == pytest.approx(4, rel=0.02)
    assert found.validation_uncertainty[middle] == pytest.approx(5, rel=0.02)


def test_one_shared_error_is_one_degree_of_freedom_and_two_sigma():
    test = pulled(500 + 100 * STROKE, tension_offset=10.0)
    found = validate_curve(500 + 100 * test.strain + 15, test, input_error=exact(test))
    assert found.coverage_factor == pytest.approx(1.96, abs=0.06)
    assert found.largest_ratio == pytest.approx(1.5, abs=1e-3)
    # noise of rounding alone is left beside the offset
    assert found.agrees and found.chi_square_probability == pytest.approx(0.1336, abs=0.02)


def test_errors_that_are_each_for_itself_need_a_wider_band():
    rng = np.random.default_rng(3)
    test = pulled(1000 + rng.normal(0, 10, STROKE.size))
    found = validate_curve(1000 + 0 * test.strain, test, input_error=exact(test))
    n = np.isfinite(found.validation_uncertainty).sum()
    # two-sided 95 % for the largest of n independent normals
    from scipy.stats import norm

    expected = norm.ppf(0.5 + 0.5 * 0.95 ** (1 / n))
    assert found.coverage_factor == pytest.approx(expected, abs=0.1)
    assert found.chi_square_freedom == n


def test_a_difference_is_named_with_its_place_sign_and_size():
    tension = 1000 + 0 * STROKE
    test = pulled(tension, tension_offset=10.0)
    wrong = 1000 + 0 * test.strain
    wrong[30] += 55
    found = validate_curve(wrong, test, input_error=exact(test))
    assert not found.agrees and found.largest_ratio == pytest.approx(5.5, rel=1e-3)
    assert found.verdict.startswith("differs by +55 N at 30 % strain, 5.5 times its standard unc")
    assert "the prediction is above the test" in found.verdict
    low = validate_curve(2000 - wrong, test, input_error=exact(test))
    assert low.verdict.startswith("differs by -55 N") and "below the test" in low.verdict


def test_the_share_is_of_the_strains_at_which_a_load_is_predicted():
    """A pressure from strain .7 on, 150 on average, with a gauge off by 10: U is 13 to 15 %.

    Of all strains the median was one of slack cords, with a share of some thousand per cent.
    """
    noise = np.abs(np.random.default_rng(2).normal(0, 1, STROKE.size))
    test = pulled(1000 * np.maximum(STROKE - 0.7, 0) + noise, tension_offset=10.0)
    model = 1000 * np.maximum(test.strain - 0.7, 0)
    found = validate_curve(model, test, input_error=exact(test))
    assert found.agrees and found.is_informative
    assert 0.12 < found.uncertainty_share < 0.17
    assert 19 < found.median_limit < 26


def test_an_uncertainty_that_swallows_everything_is_called_so():
    test = pulled(1000 + 0 * STROKE, tension_offset=300.0)
    found = validate_curve(1200 + 0 * test.strain, test, input_error=exact(test))
    assert found.agrees and not found.is_informative
    assert found.uncertainty_share == pytest.approx(0.588, abs=0.02)
    assert found.verdict.endswith("so wide that agreement says little")
    useful = validate_curve(
        1200 + 0 * test.strain, test, input_error=exact(test), largest_useful_share=0.7
    )
    assert useful.is_informative and "so wide" not in useful.verdict


def test_what_was_not_stated_is_said():
    test = pulled(1000 + np.random.default_rng(2).normal(0, 5, STROKE.size))
    found = validate_curve(1000 + 0 * test.strain, test, input_error=exact(test))
    assert any("no uncertainty of the prediction" in text for text in map(str, found.notes))
    assert any("no calibration uncertainty" in text for text in map(str, found.notes))


def test_nothing_known_is_not_judged():
    test = pulled(0 * STROKE)  # no noise, no calibration
    found = validate_curve(5 + 0 * test.strain, test, input_error=exact(test))
    assert found.verdict.startswith("not judged") and not found.agrees
    assert found.chi_square_freedom == 0 and np.isnan(found.largest_ratio)


def test_a_wrong_shape_inside_the_band_is_noted():
    rng = np.random.default_rng(6)
    test = pulled(1000 + rng.normal(0, 0.5, STROKE.size), tension_offset=100.0)
    found = validate_curve(1000 + 60 * test.strain, test, input_error=exact(test))
    assert found.agrees and found.chi_square_probability < 0.01
    assert any("shape of the difference" in text for text in map(str, found.notes))

    assert found.verdict.startswith(
        "agrees within U point by point, but its shape does not (below 0.1 %); U is "
    )


def test_a_reader_in_pounds_gets_pounds():
    test = pulled(1000 + 0 * STROKE, tension_offset=10.0)
    apart = validate_curve(1044.482 + 0 * test.strain, test, input_error=exact(test))
    words = verdict_words(apart, unit="lbf", factor=1 / 4.4482216)
    assert words.startswith("differs by +10 lbf at 0 % strain") and " N" not in words
    near = validate_curve(1005 + 0 * test.strain, test, input_error=exact(test))
    assert verdict_words(near) == near.verdict
    of_reader = verdict_words(near, unit="lbf", factor=1 / 4.4482216)
    # 1.96 times 10 N
    size, unit = of_reader.removeprefix("agrees within U, ").split()[:2]
    assert unit == "lbf" and float(size) == pytest.approx(1.96 * 10 / 4.448, rel=0.04)


@pytest.mark.parametrize(
    ("probability", "words"), [(0.0153, "1.5 %"), (4e-137, "below 0.1 %"), (0.0, "below 0.1 %")]
)
def test_probabilities_are_no_finer_than_the_draws(probability, words):
    assert _probability_words(probability) == words


def test_a_difference_where_no_stated_error_can_be_is_noted():
    test = pulled(0 * STROKE, tension_offset=100.0)
    found = validate_curve(50 * test.strain, test, input_error=exact(test))
    assert found.chi_square_freedom == 1
    assert any("cannot come from any stated error" in text for text in map(str, found.notes))


def test_the_noise_of_a_test_is_a_stated_error():
    """A load cell that may be 400 N off and reads 20 N high: its noise is 0.02 % of the square."""
    noise = np.random.default_rng(4).normal(0, 0.5, STROKE.size)
    test = pulled(1000 * STROKE + noise, tension_offset=400.0)
    found = validate_curve(1000 * test.strain - 20, test, input_error=exact(test))
    assert found.agrees and found.chi_square_freedom < test.strain.size
    assert not any("cannot come from any stated error" in text for text in map(str, found.notes))


@pytest.mark.parametrize("n_tests", [12, pytest.param(60, marks=pytest.mark.nightly)])
def test_a_right_prediction_is_called_wrong_in_one_of_twenty(n_tests):
    truth = Truth()
    known = {"rubber_modulus": 0.05 * truth.rubber_modulus, "cord_load_scale": 0.05}
    strain = np.linspace(0, 1.1, 400)
    rng = np.random.default_rng(8)
    agrees, exceeds = [], []
    for _ in range(n_tests):
        guess = truth.but(
            rubber_modulus=truth.rubber_modulus * (1 + 0.05 * rng.standard_normal()),
            cord_load_scale=1 + 0.05 * rng.standard_normal(),
        ).design()
        read = truth.tension(strain) * (1 + 0.005 * rng.standard_normal())
        test = measured_curve(
            strain, read + rng.normal(0, 20, strain.size), loading="static",
            shared=constant_errors(tension_gain=0.005),
        )  # fmt: skip
        found = validate_curve(
            predict_hose(guess, test.strain).tension, test,
            input_error=_input_draws(guess, known, test.strain, n_draws=600),
        )  # fmt: skip
        agrees.append(found.agrees)
        exceeds.append(found.chi_square_probability < 0.05)
    assert 0.85 <= np.mean(agrees) <= 1
    assert np.mean(exceeds) <= 0.12


def test_the_same_input_gives_the_same_answer():
    truth = Truth()
    test = measured_curve(STROKE, truth.tension(STROKE), loading="static")
    known = {"wrap_angle": np.radians(0.5)}
    answers = {
        validate_curve(
            truth.tension(test.strain) * 1.01, test,
            input_error=_input_draws(truth.design(), known, test.strain, n_draws=N_DRAWS),
        ).coverage_factor
        for _ in range(2)
    }  # fmt: skip
    assert len(answers) == 1


def test_bad_input_is_refused():
    test = pulled(1000 + 0 * STROKE)
    with pytest.raises(DataError, match="no strain in common"):
        validate_curve(np.full(test.strain.size, np.nan), test, input_error=exact(test))
    with pytest.raises(DataError, match="series do not pair up"):
        validate_curve([1.0], test, input_error=exact(test))
