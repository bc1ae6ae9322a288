import numpy as np
import pytest
import statsmodels.api as sm
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.record.errors import DataError

RUNS = box_behnken(3).coded
EXPONENTS = quadratic_exponents(3)
MATRIX = model_matrix(RUNS, EXPONENTS)
LOW, HIGH = np.array([0.1, 768.0, 320.0]), np.array([0.5, 1920.0, 768.0])


def surfaces(responses, runs=RUNS, **settings):
    values = np.atleast_2d(responses)
    return fit_surfaces(
        runs,
        values,
        factor_names=["frequency", "mean_tension", "tension_amplitude"],
        response_names=[f"y{number}" for number in range(len(values))],
        low=LOW,
        high=HIGH,
        units="coded",
        **settings,
    )


@pytest.fixture
def responses():
    found = np.random.default_rng(4).normal(10, 1, (3, 15))
    found[1, 12] = np.nan
    return found


def test_intervals_are_those_of_statsmodels(responses):
    points = np.random.default_rng(5).uniform(-1, 1, (7, 3))
    found = evaluate_surfaces(surfaces(responses), points, units="coded")
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX[has]).fit()
        frame = other.get_prediction(model_matrix(points, EXPONENTS)).summary_frame(alpha=0.05)
        np.testing.assert_allclose(found.value[row], frame["mean"], rtol=1e-9)
        np.testing.assert_allclose(
            found.fitted_standard_uncertainty[row], frame["mean_se"], rtol=1e-9
        )
        np.testing.assert_allclose(
            found.confidence_interval[row], frame[["mean_ci_lower", "mean_ci_upper"]], rtol=1e-8
        )
        np.testing.assert_allclose(
            found.prediction_interval[row], frame[["obs_ci_lower", "obs_ci_upper"]], rtol=1e-8
        )


def test_simultaneous_intervals_hold_the_whole_surface_as_often_as_they_say():
    rng = np.random.default_rng(6)
    truth = np.arange(1.0, 11.0)
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 3), axis=-1).reshape(-1, 3)
    found = evaluate_surfaces(
        surfaces(MATRIX @ truth + rng.normal(size=(1500, 15)), with_tests=False),
        grid,
        units="coded",
    )
    true = model_matrix(grid, EXPONENTS) @ truth

    def held(interval):
        inside = (interval[..., 0] <= true) & (true <= interval[..., 1])
        return inside.all(axis=1).mean()

    assert held(found.simultaneous_interval) >= 0.95
    assert held(found.confidence_interval) < 0.8
    half = np.diff(found.simultaneous_interval, axis=2)[..., 0] / 2
    scheffe = np.sqrt(10 * stats.f.isf(0.05, 10, 5))
    np.testing.assert_allclose(half / found.fitted_standard_uncertainty, scheffe, rtol=1e-9)


def test_corners_of_the_cube_are_inside_and_beyond_what_the_runs_say(responses):
    corners = np.array([[1.0, 1, 1], [1, -1, 1], [0, 1, 1], [0, 0, 0]])
    found = evaluate_surfaces(surfaces(responses[0]), corners, units="coded")
    assert found.is_inside.all()
    assert found.above_leverage[0].tolist() == [True, True, False, False]
    np.testing.assert_allclose(found.variance_factor[0], [1.396, 1.396, 0.75, 1 / 3], atol=5e-4)


def test_points_in_units_and_coded_ones_agree(responses):
    model = surfaces(responses)
    in_units = evaluate_surfaces(model, [[0.2, 1200.0, 600.0]])
    coded = evaluate_surfaces(model, in_units.coded, units="coded")
    np.testing.assert_allclose(in_units.value, coded.value, rtol=1e-12)
    np.testing.assert_allclose(coded.engineering, [[0.2, 1200.0, 600.0]], rtol=1e-12)


def test_the_ends_of_the_range_are_inside_after_the_change_of_units(responses):
    found = evaluate_surfaces(surfaces(responses), [LOW, HIGH])
    assert found.is_inside.all()


def test_a_point_outside_is_refused_with_its_range(responses):
    with pytest.raises(DataError, match=r"1 of 2 points lie outside .* first point 2; found "
                       r"mean_tension = 2000; needed 768 to 1920"):  # fmt: skip
        evaluate_surfaces(surfaces(responses), [[0.2, 1000.0, 500.0], [0.2, 2000.0, 500.0]])


def test_a_point_outside_is_flagged_where_that_is_asked_for(responses):
    found = evaluate_surfaces(surfaces(responses), [[0.2, 2000.0, 500.0]], outside="flag")
    assert found.is_inside.tolist() == [False]
    assert not found.above_leverage.any()
    assert np.isfinite(found.value).all()


def test_values_of_a_logarithm_are_medians_above_nought_with_their_means():
    rng = np.random.default_rng(9)
    log_truth = np.array([0.0, 0.1, 0.2, 0.0, -1.0, 2.0, 0.1, 0, 0, 0.3])
    drawn = np.exp(MATRIX @ log_truth + rng.normal(0, 0.3, (4000, 15)))
    model = surfaces(drawn, transforms="log", with_tests=False)
    found = evaluate_surfaces(model, [[0.0, 0.0, 0.0], [1.0, -1.0, 0.0]], units="coded")
    assert (found.value > 0).all() and (found.confidence_interval > 0).all()
    true = model_matrix([[0.0, 0, 0], [1.0, -1, 0]], EXPONENTS) @ log_truth
    np.testing.assert_allclose(np.median(found.value, axis=0), np.exp(true), rtol=0.02)
    ratio = found.mean_value / found.value
    np.testing.assert_allclose(ratio, np.exp(model.sigma**2 / 2)[:, None] * np.ones(2), rtol=1e-12)
    inside = (found.prediction_interval[..., 0] < np.exp(true + 0.3)) & (
        np.exp(true + 0.3) < found.prediction_interval[..., 1]
    )
    assert inside.mean() > 0.9
    assert "medians" in found.notes[0]


def test_a_response_without_a_surface_stays_without_values(responses):
    responses[0, :7] = np.nan
    responses[2] = MATRIX @ np.ones(10)
    found = evaluate_surfaces(surfaces(responses), [[0.0, 0.5, 0.5]], units="coded")
    assert np.isnan(found.value[0]).all() and np.isnan(found.confidence_interval[0]).all()
    assert np.isfinite(found.value[2]).all() and np.isnan(found.confidence_interval[2]).all()
    assert not found.above_leverage[0].any()


def test_another_specimen_scatters_as_specimens_do():
    rng = np.random.default_rng(13)
    runs, names = np.tile(RUNS, (6, 1)), np.repeat(list("ABCDEF"), 15)
    level = rng.normal(0, 2.0, 6)[np.repeat(np.arange(6), 15)]
    values = 50 + 3 * runs[:, 0] + level + rng.normal(0, 0.1, 90)
    centre = np.zeros((1, 3))
    random = surfaces(values, runs, blocks=names, block_treatment="random")
    found = evaluate_surfaces(random, centre, units="coded")
    half = np.diff(found.prediction_interval[0, 0])[0] / 2
    between = random.blocks.standard_deviation[0]
    assert found.degrees_of_freedom[0] == 5
    assert half == pytest.approx(stats.t.ppf(0.975, 5) * between * np.sqrt(1 + 1 / 6), rel=0.01)
    fixed = evaluate_surfaces(surfaces(values, runs, blocks=names), centre, units="coded")
    assert np.diff(fixed.prediction_interval[0, 0])[0] / 2 < 0.3
    assert "not of another specimen" in fixed.notes[0]
