"""None"""

import dataclasses

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm

from reduction import fit_surface
from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.fit_results import FIT_REASONS
from reduction.experiments.response_surfaces import MOST_RUNS, fit_surfaces, scatter_by_scale
from reduction.experiments.response_transform import (
    back_transform,
    box_cox_exponent,
    retransformed_mean,
    transform,
)
from reduction.record.errors import DataError, FitError, SettingsError

RUNS = box_behnken(3).coded
EXPONENTS = quadratic_exponents(3)
MATRIX = model_matrix(RUNS, EXPONENTS)
LOW, HIGH = np.array([0.1, 768.0, 320.0]), np.array([0.5, 1920.0, 768.0])
FACTORS = ["frequency", "mean_tension", "tension_amplitude"]


def surfaces(responses, runs=RUNS, **change):
    values = np.atleast_2d(np.asarray(responses, dtype=float))
    settings = {
        "factor_names": FACTORS,
        "response_names": [f"y{number}" for number in range(len(values))],
        "low": LOW,
        "high": HIGH,
        "units": "coded",
    }
    return fit_surfaces(runs, values, **{**settings, **change})


@pytest.fixture
def noise():
    return np.random.default_rng(21).normal(10.0, 1.0, (4, 15))


def test_coded_levels_and_levels_in_units_give_one_surface(noise):
    coded = surfaces(noise)
    levels = (LOW + HIGH) / 2 + RUNS * (HIGH - LOW) / 2
    in_units = surfaces(noise, runs=levels, units="engineering")
    np.testing.assert_allclose(in_units.coefficient, coded.coefficient, rtol=1e-9, atol=1e-12)


def test_the_equation_in_units_is_the_fit_in_units(noise):
    """Coefficients and uncertainties carried over against a fit to the levels themselves."""
    found = surfaces(noise)
    levels = (LOW + HIGH) / 2 + RUNS * (HIGH - LOW) / 2
    for row, response in enumerate(noise):
        other = sm.OLS(response, model_matrix(levels, EXPONENTS)).fit()
        np.testing.assert_allclose(found.coefficient_engineering[row], other.params, rtol=1e-6)
        np.testing.assert_allclose(
            found.coefficient_engineering_standard_uncertainty[row], other.bse, rtol=1e-6
        )


def test_overall_f_and_adjusted_r2_are_those_of_statsmodels(noise):
    noise[2, 14] = np.nan
    found = surfaces(noise)
    for row, response in enumerate(noise):
        has = np.isfinite(response)
        other = sm.OLS(response[has], MATRIX[has]).fit()
        assert found.overall_f[row] == pytest.approx(other.fvalue, rel=1e-9)
        assert found.overall_p_value[row] == pytest.approx(other.f_pvalue, rel=1e-9)
        assert found.adjusted_r2[row] == pytest.approx(other.rsquared_adj, rel=1e-9)
        press = np.sum(other.get_influence().resid_press ** 2)
        assert found.predicted_r2[row] == pytest.approx(1 - press / other.centered_tss, rel=1e-9)
        np.testing.assert_allclose(found.p_value[row], other.pvalues, rtol=1e-8)


def test_a_batch_is_each_response_alone(noise):
    together = surfaces(noise)
    for row, response in enumerate(noise):
        alone = surfaces(response)
        for name in ("coefficient", "t", "p_value", "r2", "predicted_r2", "printed_f", "fitted"):
            np.testing.assert_allclose(
                getattr(together, name)[row], getattr(alone, name)[0], rtol=1e-9
            )


def test_true_coefficients_come_back_from_levels_as_met():
    rng = np.random.default_rng(3)
    runs = RUNS + rng.uniform(-0.08, 0.08, RUNS.shape)
    truth = np.array([9.457, 0.1, -0.2, 0.05, 0.4, 2.6, -0.3, 0.1, 0.0, 0.2])
    values = model_matrix(runs, EXPONENTS) @ truth + rng.normal(0, 0.02, (5000, 15))
    found = surfaces(values, runs, with_tests=False)
    np.testing.assert_allclose(found.coefficient.mean(axis=0), truth, atol=0.002)
    np.testing.assert_allclose(
        found.coefficient.std(axis=0),
        np.sqrt(np.mean(found.coefficient_standard_uncertainty**2, axis=0)),
        rtol=0.05,
    )
    covered = np.abs(found.coefficient - truth) < 2.5706 * found.coefficient_standard_uncertainty
    assert covered.mean() == pytest.approx(0.95, abs=0.01)
    assert any("repeated runs differ by up to" in note for note in map(str, found.notes))


def test_reasons_stand_in_the_notes_and_nothing_is_tested_there(noise):
    noise[0] = 3.0
    noise[1] = MATRIX @ np.arange(1.0, 11.0)
    noise[2, :7] = np.nan
    found = surfaces(noise)
    assert [FIT_REASONS[code] for code in found.reason[3:]] == [""]
    for row, text in ((0, "does not vary"), (1, "are rounding"), (2, "fewer runs")):
        assert text in FIT_REASONS[found.reason[row]]
        assert any(note.startswith(f"y{row}:") and text in note for note in map(str, found.notes))
        for name in ("t", "p_value", "overall_f", "printed_f"):
            assert np.isnan(getattr(found, name)[row]).all()
    assert np.isnan(found.r2[0]) and found.r2[1] == pytest.approx(1.0)


def test_a_run_not_done_is_named(noise):
    noise[:, 7] = np.nan
    runs = RUNS.copy()
    runs[7] = np.nan
    found = surfaces(noise, runs)
    assert "runs without any value: 8" in tuple(map(str, found.notes))
    assert "runs that alone determine a term (leverage 1), without a residual: 5" in tuple(
        map(str, found.notes)
    )
    assert found.degrees_of_freedom.tolist() == [4] * 4
    assert np.isnan(found.predicted_r2).all() and np.isfinite(found.overall_p_value).all()


def test_a_response_that_misses_a_run_is_named(noise):
    noise[1, 13] = np.nan
    assert "responses missing in further runs: y1" in tuple(map(str, surfaces(noise).notes))


def test_a_run_that_may_have_been_entered_twice_is_named(noise):
    runs = np.vstack([RUNS, RUNS[3]])
    doubled = np.hstack([noise, noise[:, 3:4]])
    (note,) = [
        note for note in map(str, surfaces(doubled, runs).notes) if "one run entered twice" in note
    ]
    assert note.startswith("runs 4 and 16 agree in every level and response")


@pytest.mark.parametrize(
    ("scale", "text"), [(1.3, "go beyond the plan"), (0.7, "fall short of the plan")]
)
def test_levels_far_from_the_plan_are_named(noise, scale, text):
    found = surfaces(noise, RUNS * [scale, 1, 1])
    (note,) = [note for note in map(str, found.notes) if text in note]
    assert note.startswith("levels of frequency")


def test_terms_that_lean_on_each_other_are_named(noise):
    runs = RUNS.copy()
    runs[:, 1] = 0.95 * runs[:, 0] + 0.05 * runs[:, 1]
    assert any("terms are correlated" in note for note in map(str, surfaces(noise, runs).notes))


def test_the_product_cannot_be_changed(noise):
    found = surfaces(noise)
    with pytest.raises(ValueError, match="read-only"):
        found.coefficient[0, 0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.sigma = 1.0
    assert found.labels[0] == "B1" and found.labels[-1] == "B10"


def test_without_tests_the_surfaces_are_the_same_and_nothing_is_tested(noise):
    whole, bare = surfaces(noise), surfaces(noise, with_tests=False)
    for name in ("coefficient", "coefficient_standard_uncertainty", "sigma", "r2", "fitted"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(whole, name))
    np.testing.assert_array_equal(bare.lack_of_fit.f, whole.lack_of_fit.f)
    for untested in (bare.t, bare.p_value, bare.overall_f, bare.anova.f, bare.anova.sum_of_squares,
                     bare.diagnostics.cooks_distance):  # fmt: skip
        assert np.isnan(untested).all()


@pytest.fixture
def lines():
    """Four lines through the same fifteen runs, one of them without two of its runs."""
    rng = np.random.default_rng(17)
    runs, names = np.tile(RUNS, (4, 1)), np.repeat(["A", "B", "C", "D"], 15)
    truth = np.array([9, 0.3, -0.2, 0.1, 0.5, 3, -0.4, 0.1, 0.2, 0.3])
    level = rng.normal(0, 0.8, (3, 4))[:, np.repeat(np.arange(4), 15)]
    values = model_matrix(runs, EXPONENTS) @ truth + level + rng.normal(0, 0.2, (3, 60))
    values[:, [48, 57]] = np.nan
    return runs, names, values


def test_fixed_blocks_are_those_of_statsmodels(lines):
    runs, names, values = lines
    found = surfaces(values, runs, blocks=names)
    data = pd.DataFrame(runs, columns=list("abc")).assign(line=names, y=values[0]).dropna()
    other = ols(
        "y ~ C(line, Sum) + a + b + c + a:b + a:c + b:c + I(a**2) + I(b**2) + I(c**2)", data
    ).fit()
    pairs = dict(zip(
        ["Intercept", "I(a ** 2)", "I(b ** 2)", "I(c ** 2)", "a", "b", "c", "a:b", "a:c", "b:c"],
        range(10), strict=True,
    ))  # fmt: skip
    for name, place in pairs.items():
        assert found.coefficient[0, place] == pytest.approx(other.params[name], rel=1e-9)
        assert found.coefficient_standard_uncertainty[0, place] == pytest.approx(
            other.bse[name], rel=1e-9
        )
        assert found.p_value[0, place] == pytest.approx(other.pvalues[name], rel=1e-7)
    table = anova_lm(other, typ=1)
    assert found.anova.source[0] == "blocks"
    for source, rows in (("blocks", [0]), ("first order", [1, 2, 3]), ("interactions", [4, 5, 6]),
                         ("squares", [7, 8, 9])):  # fmt: skip
        at = found.anova.source.index(source)
        assert found.anova.sum_of_squares[0, at] == pytest.approx(
            table["sum_sq"].to_numpy()[rows].sum(), rel=1e-9
        )
    assert found.blocks.effect.sum(axis=1) == pytest.approx(0, abs=1e-12)
    effects = [other.params[f"C(line, Sum)[S.{name}]"] for name in "ABC"]
    np.testing.assert_allclose(found.blocks.effect[0, :3], effects, rtol=1e-8)
    assert np.isnan(found.printed_f).all()


def test_r2_with_blocks_leaves_the_level_of_the_lines_out(lines):
    runs, names, values = lines
    shifted = values + 100 * np.repeat([0, 1, 2, 3], 15)
    found = surfaces([values[0], shifted[0]], runs, blocks=names)
    assert found.r2[0] == pytest.approx(found.r2[1], rel=1e-9)


def test_pure_error_with_blocks_is_that_of_blocks_and_cells(lines):
    runs, names, values = lines
    lack = surfaces(values, runs, blocks=names).lack_of_fit
    data = pd.DataFrame({"y": values[0], "cell": lack.cell, "line": names}).dropna()
    other = ols("y ~ C(cell) + C(line)", data).fit()
    assert lack.pure_error_sum_of_squares[0] == pytest.approx(other.ssr, rel=1e-9)
    assert lack.pure_error_degrees_of_freedom[0] == other.df_resid


def test_a_response_that_a_specimen_does_not_have_is_fitted_to_the_others(lines):
    """As K_1 of a line without a slow pull; the last block and one in the middle."""
    runs, names, values = lines
    for missing in "BD":
        partly = values.copy()
        partly[1, names == missing] = np.nan
        found = surfaces(partly, runs, blocks=names)
        rest = names != missing
        alone = surfaces(values[1:2, rest], runs[rest], blocks=names[rest])
        for field in ("coefficient", "coefficient_standard_uncertainty", "p_value", "r2",
                      "adjusted_r2", "predicted_r2", "overall_f", "sigma"):  # fmt: skip
            np.testing.assert_allclose(
                getattr(found, field)[1], getattr(alone, field)[0], rtol=1e-8, atol=1e-12
            )
        np.testing.assert_allclose(found.anova.f[1], alone.anova.f[0], rtol=1e-8)
        np.testing.assert_allclose(
            found.anova.degrees_of_freedom[1], alone.anova.degrees_of_freedom[0]
        )
        np.testing.assert_allclose(found.lack_of_fit.f[1], alone.lack_of_fit.f[0], rtol=1e-8)
        np.testing.assert_allclose(
            found.diagnostics.cooks_distance[1, rest],
            alone.diagnostics.cooks_distance[0],
            rtol=1e-7,
        )
        np.testing.assert_allclose(
            found.blocks.effect[1, np.array(list("ABCD")) != missing],
            alone.blocks.effect[0],
            atol=1e-9,
        )
        assert np.isnan(found.blocks.effect[1, "ABCD".index(missing)])
        random = surfaces(partly, runs, blocks=names, block_treatment="random")
        assert random.term_degrees_of_freedom[1, 0] == 2
        assert np.isnan(random.blocks.effect[1, "ABCD".index(missing)])


def test_random_blocks_widen_the_mean_alone(lines):
    runs, names, values = lines
    fixed = surfaces(values, runs, blocks=names)
    random = surfaces(values, runs, blocks=names, block_treatment="random")
    assert random.error_term[0] == "blocks" and set(random.error_term[1:]) == {"residuals"}
    assert (random.term_degrees_of_freedom[:, 0] == 3).all()
    ratio = random.coefficient_standard_uncertainty / fixed.coefficient_standard_uncertainty
    assert (ratio[:, 0] > 3).all()
    np.testing.assert_allclose(ratio[:, 1:], 1, rtol=0.05)
    assert (random.blocks.standard_deviation > 0.2).all()
    assert any("4 specimens as random blocks (REML)" in note for note in map(str, random.notes))
    assert any("4 specimens as fixed blocks" in note for note in map(str, fixed.notes))


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"run_names": ["R1"] * 15}, SettingsError, "a run is named twice; found R1"),
        ({"run_names": ["R1"]}, SettingsError, "names of the runs do not pair up"),
        ({"response_names": ["a"]}, SettingsError, "names of the responses do not pair up"),
        ({"factor_names": ["f"]}, SettingsError, "the levels do not pair up with the factors"),
        ({"low": HIGH, "high": LOW}, SettingsError, "high level of factor 1 does not lie above"),
        ({"transforms": ["log"]}, SettingsError, "the transforms do not pair up"),
        (
            {"transforms": "log-times-frequency", "factor_names": ["rate", "m", "a"]},
            SettingsError,
            "multiplied by the frequency, which is no factor; found rate, m, a",
        ),
        (
            {"transforms": "square"},
            SettingsError,
            "found square; needed none, log, box-cox or log-times-frequency",
        ),
        ({"blocks": ["A"] * 15}, DataError, "there is one block"),
        ({"blocks": ["A", "B"]}, SettingsError, "names of the blocks do not pair up"),
    ],
)
def test_settings_that_do_not_fit_are_refused(noise, change, error, message):
    with pytest.raises(error, match=message):
        surfaces(noise, **change)


def test_a_factor_that_never_moves_is_refused(noise):
    with pytest.raises(DataError, match="mean_tension never moves"):
        surfaces(noise, RUNS * [1, 0, 1])


def test_an_infinite_level_is_refused(noise):
    runs = RUNS.copy()
    runs[4, 1] = np.inf
    with pytest.raises(DataError, match="a level is infinite; found run 5"):
        surfaces(noise, runs)


def test_a_value_without_levels_is_refused(noise):
    runs = RUNS.copy()
    runs[4, 1] = np.nan
    with pytest.raises(DataError, match="a run has a response and no levels; found run 5"):
        surfaces(noise, runs)


def test_no_value_at_all_is_refused():
    with pytest.raises(DataError, match="no run has a value"):
        surfaces(np.full((1, 15), np.nan))


def test_fewer_runs_than_terms_are_refused(noise):
    with pytest.raises(FitError, match="fewer runs than terms; found 9 runs"):
        surfaces(noise[:, :9], RUNS[:9])


def test_two_levels_of_a_factor_are_refused_by_name(noise):
    runs = RUNS.copy()
    runs[:, 0] = np.where(runs[:, 0] > 0, 1, -1)
    with pytest.raises(FitError, match=r"frequency\^2 with mean"):
        surfaces(noise, runs)


def test_a_value_at_or_below_nought_has_no_logarithm(noise):
    noise[0, 2] = -1.0
    with pytest.raises(DataError, match="1 of 60 values are not above zero"):
        surfaces(noise, transforms="log")


def test_more_runs_than_an_experiment_has_are_refused_and_pairs_are_counted_quickly():
    runs = np.tile(RUNS, (MOST_RUNS // len(RUNS) + 1, 1))
    measured = np.random.default_rng(3).normal(size=(1, len(runs)))
    with pytest.raises(DataError, match="too many runs for a surface; found 2,010; needed 2,000"):
        surfaces(measured, runs)
    alike = np.tile(measured[:, : len(RUNS)], 3)
    (note,) = [
        one for one in surfaces(alike, np.tile(RUNS, (3, 1))).notes if one.code == "runs-alike"
    ]
    # three runs of each: three pairs
    assert note.numbers["n_pairs"] == 3 * len(RUNS)


MATRIX_OF_TRANSFORM = model_matrix(RUNS, quadratic_exponents(3))


@pytest.mark.parametrize("power", [-1.5, -0.5, 0.0, 0.3, 1.0, 2.0])
def test_there_and_back_is_where_it_began(power):
    values = np.array([0.01, 0.7, 1.0, 3.0, 400.0])
    np.testing.assert_allclose(back_transform(transform(values, power), power), values, rtol=1e-9)


def test_beyond_the_end_of_the_scale_there_is_nought_or_no_bound():
    assert back_transform(-10.0, 0.5) == 0.0
    assert back_transform(10.0, -0.5) == np.inf
    assert np.isnan(back_transform(np.nan, 0.5))


@pytest.mark.parametrize("power", [0.0, 0.25, 0.5, -0.3])
def test_the_mean_is_that_of_many_draws(power):
    rng = np.random.default_rng(1)
    sigma = 0.1 if power == 0 else 0.03  # second order elsewhere
    draws = back_transform(2.0 + sigma * rng.normal(size=1_000_000), power)
    shift = retransformed_mean(2.0, power, sigma=sigma) / back_transform(2.0, power) - 1
    expected = draws.mean() / back_transform(2.0, power) - 1
    noise = draws.std() / draws.mean() / 1000
    assert shift == pytest.approx(expected, rel=0.02, abs=3 * noise)


def test_the_exponent_without_factors_is_that_of_scipy():
    values = np.random.default_rng(2).gamma(3.0, size=(5, 40))
    found = box_cox_exponent(np.ones((40, 1)), values)
    for row, sample in enumerate(values):
        _, best, interval = stats.boxcox(sample, alpha=0.05)
        assert found.exponent[row] == pytest.approx(best, abs=1e-5)
        assert found.low[row] == pytest.approx(interval[0], abs=1e-5)
        assert found.high[row] == pytest.approx(interval[1], abs=1e-5)


@pytest.mark.parametrize("power", [0.0, 0.5, 1.0])
def test_the_interval_holds_the_true_exponent_about_as_often_as_it_says(power):
    """Likelihood of 60 runs, 10 terms: a little short of 95 %, as the terms are not counted."""
    rng = np.random.default_rng(3)
    matrix = np.tile(MATRIX_OF_TRANSFORM, (4, 1))
    unit = 10.0**power  # a hundred per cent of 10, transformed
    mean = transform(10.0, power) + unit * matrix[:, 1:] @ np.linspace(-0.1, 0.1, 9)
    values = back_transform(mean + unit * rng.normal(0, 0.15, (400, 60)), power)
    found = box_cox_exponent(matrix, values)
    held = (found.low <= power) & (power <= found.high)
    assert 0.85 <= held.mean() <= 0.99


def test_an_interval_that_reaches_the_end_of_the_search_is_open():
    values = 100 + 0.01 * np.random.default_rng(4).normal(size=(1, 15))
    found = box_cox_exponent(MATRIX_OF_TRANSFORM, values)
    assert found.low[0] == -np.inf and found.high[0] == np.inf


def test_missing_runs_are_left_out_and_too_few_give_nothing():
    values = np.random.default_rng(5).gamma(5.0, size=(3, 15))
    values[1, 4], values[2, [0, 1, 5, 13, 14]] = np.nan, np.nan
    found = box_cox_exponent(MATRIX_OF_TRANSFORM, values)
    has = np.isfinite(values[1])
    alone = box_cox_exponent(MATRIX_OF_TRANSFORM[has], values[1:2, has])
    assert found.exponent[1] == pytest.approx(alone.exponent[0], abs=1e-9)
    assert np.isnan(found.exponent[2])


def test_a_surface_on_the_scale_of_its_response_shows_the_true_coefficients():
    truth = np.array([1.0, 0.2, -0.1, 0.0, -0.8, 0.5, 0.1, 0, 0, 0.2])
    rng = np.random.default_rng(6)
    values = np.exp(MATRIX_OF_TRANSFORM @ truth + 0.01 * rng.normal(size=(2, 15)))
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["tau", "plain"],
        low=[-1] * 3, high=[1] * 3, transforms=["log", "none"],
    )  # fmt: skip
    np.testing.assert_allclose(found.coefficient[0], truth, atol=0.03)
    assert found.transform == ("log", "none")
    assert found.transform_exponent.tolist() == [0.0, 1.0]
    assert found.r2[0] > found.r2[1]


def test_the_exponent_found_is_the_one_that_was_used():
    rng = np.random.default_rng(7)
    values = (
        5 + MATRIX_OF_TRANSFORM[:, 4:7] @ [1.0, 0.5, 0.2] + 0.05 * rng.normal(size=(2, 15))
    ) ** 2
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["a", "b"],
        low=[-1] * 3, high=[1] * 3, transforms="box-cox",
    )  # fmt: skip
    power = found.transform_exponent
    low, high = found.transform_exponent_interval.T
    assert ((low < power) & (power < high)).all()
    np.testing.assert_allclose(
        found.fitted + found.residual, transform(values, power[:, None]), rtol=1e-10
    )


def test_a_response_without_an_exponent_has_no_surface_and_says_why():
    values = np.random.default_rng(8).gamma(5.0, size=(2, 15))
    values[0, [0, 1, 5, 13, 14]] = np.nan  # as many runs as terms
    found = fit_surfaces(
        RUNS, values, factor_names=["f", "T", "a"], response_names=["a", "b"],
        low=[-1] * 3, high=[1] * 3, transforms="box-cox",
    )  # fmt: skip
    assert FIT_REASONS[found.reason[0]].endswith("no exponent can be found")
    assert np.isnan(found.coefficient[0]).all() and np.isfinite(found.coefficient[1]).all()
    assert np.isnan(found.anova.degrees_of_freedom[0]).all()


def test_the_end_of_an_interval_may_lie_beyond_every_number():
    assert back_transform(1e4, 0.0) == np.inf
    assert back_transform(1e300, 0.01) == np.inf


def test_values_not_above_nought_are_refused():
    with pytest.raises(DataError, match="2 of 3 values are not above zero .* found -1"):
        transform([-1.0, 0.0, 1.0], 0.5)


def test_scatter_by_scale_is_the_ratio_of_two_regressions():
    """Box and Cox: residual scatter of the logarithm times the geometric mean, over that of y."""
    level = np.linspace(-1, 1, 12)
    runs = np.exp(level) * (1 + 0.02 * np.random.default_rng(4).normal(size=(2, 12)))
    runs[1] *= 1000  # in another unit: the ratio has none

    def fit(values, names, scales):
        return fit_surfaces(
            level[:, None], values, factor_names=["load"], response_names=names, units="coded",
            low=[-1.0], high=[1.0], transforms=scales,
        )  # fmt: skip

    ratio, p = scatter_by_scale(runs, fit)
    matrix = np.vander(level, 3)
    for row, values in enumerate(runs):
        ss = [np.linalg.lstsq(matrix, one, rcond=None)[1][0] for one in (np.log(values), values)]
        expected = stats.gmean(values) * np.sqrt(ss[0] / ss[1])
        assert ratio[row] == pytest.approx(expected, rel=1e-9)
        assert p[row] == pytest.approx(stats.f.sf(max(expected, 1 / expected) ** 2, 9, 9))


# intervals of a table of runs half way between its levels, for laws that saturate

LOW_OF_BETWEEN_RUNS, HIGH_OF_BETWEEN_RUNS = (
    np.array([0.1, 3400.0, 1400.0]),
    np.array([0.5, 8500.0, 3400.0]),
)
SPEC = {
    "factors": {
        "frequency": ["0.1 Hz", "0.5 Hz"], "mean_tension": ["3400 N", "8500 N"],
        "tension_amplitude": ["1400 N", "3400 N"],
    },
    "responses": {"relaxation_time": {"unit": "s", "transform": "log"}},
}  # fmt: skip


def law(coded, rng):
    """A response that falls as 1/f and rises with the load to a limit; of one line."""
    frequency, mean, amplitude = (
        (LOW_OF_BETWEEN_RUNS + HIGH_OF_BETWEEN_RUNS) / 2
        + coded * (HIGH_OF_BETWEEN_RUNS - LOW_OF_BETWEEN_RUNS) / 2
    ).T
    power, load = rng.uniform(0.8, 1.1), rng.uniform(3000, 9000)
    return frequency**-power * mean / (mean + load) * (1 - 0.1 * amplitude / 3400)


def test_intervals_between_the_levels_hold_what_a_quadratic_misses():
    held, held_by_scatter = [], []
    plan = box_behnken(3).coded
    for seed in range(25):
        rng = np.random.default_rng(seed)
        state = rng.bit_generator.state
        runs = law(plan, rng) * (1 + rng.normal(0, 0.01, len(plan)))
        level = (LOW_OF_BETWEEN_RUNS + HIGH_OF_BETWEEN_RUNS) / 2 + plan * (
            HIGH_OF_BETWEEN_RUNS - LOW_OF_BETWEEN_RUNS
        ) / 2
        frame = pd.DataFrame(level, columns=["frequency [Hz]", "mean_tension [N]",
                                             "tension_amplitude [N]"])  # fmt: skip
        frame["relaxation_time [s]"] = runs
        found = fit_surface(frame, SPEC)
        at = found["point_coded"].to_numpy()
        rng.bit_generator.state = state
        true = law(at, rng)
        low, high = (found[f"point_{end}"].to_numpy()[0] for end in ("low", "high"))
        held.append((low <= true) & (true <= high))
        coefficient, covariance = (found[name].to_numpy()[0] for name in ("coefficient",
                                                                          "covariance"))  # fmt: skip
        terms = np.array([_terms(found["term"].to_numpy(), one) for one in at])
        spread = np.sqrt(np.einsum("ij,jk,ik->i", terms, covariance, terms))
        held_by_scatter.append(np.abs(np.log(true) - terms @ coefficient) < 2.571 * spread)
    assert np.mean(held) > 0.93
    # Student's 2.571 times the scatter alone
    assert np.mean(held_by_scatter) < 0.85


def _terms(names, coded):
    value = dict(zip(SPEC["factors"], coded, strict=True)) | {"mean": 1.0}
    return [
        value[name.removesuffix("^2")] ** 2
        if name.endswith("^2")
        else np.prod([value[part] for part in name.split("*")])
        for name in names
    ]
