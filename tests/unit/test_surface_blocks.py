import numpy as np
import pytest
from scipy import optimize
from statsmodels.regression.linear_model import GLS

from reduction.experiments.block_effects import _fit_random_intercept, block_columns
from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.record.errors import DataError

RUNS = np.tile(box_behnken(3).coded, (4, 1))
MATRIX = model_matrix(RUNS, quadratic_exponents(3))
BLOCK = np.repeat(np.arange(4), 15)


@pytest.fixture
def responses():
    rng = np.random.default_rng(31)
    level = rng.normal(0, 0.6, (4, 4))[:, BLOCK]
    values = MATRIX @ np.linspace(3, 1, 10) + level + rng.normal(0, 0.3, (4, 60))
    values[1, [3, 17, 18, 40]] = np.nan  # unbalanced
    values[2, 45:] = np.nan  # one specimen not tested
    return values


def likeliest_ratio(response, matrix, block):
    """Of the restricted likelihood in closed form, from contrasts free of the surface."""
    free = np.linalg.qr(matrix, mode="complete")[0][:, matrix.shape[1] :]
    size, vectors = np.linalg.eigh(free.T @ (block[:, None] == block) @ free)
    square = (response @ free @ vectors) ** 2

    def deviance(power):
        factor = 1 + 10**power * size
        return np.sum(np.log(factor)) + size.size * np.log(np.sum(square / factor))

    best = optimize.minimize_scalar(deviance, bounds=(-6, 6), options={"xatol": 1e-12})
    return 10**best.x


def test_random_blocks_are_those_of_the_restricted_likelihood_in_closed_form(responses):
    found = _fit_random_intercept(MATRIX, responses, block=BLOCK)
    for row, response in enumerate(responses):
        has = np.isfinite(response)
        ratio = likeliest_ratio(response[has], MATRIX[has], BLOCK[has])
        other = GLS(
            response[has],
            MATRIX[has],
            np.eye(has.sum()) + ratio * (BLOCK[has][:, None] == BLOCK[has]),
        ).fit()
        # a thousandth of an uncertainty of a number is asked for
        np.testing.assert_allclose(
            (found.coefficient[row] - other.params) / other.bse, 0, atol=1e-6
        )
        np.testing.assert_allclose(
            found.covariance_factor[row], other.normalized_cov_params, rtol=1e-5, atol=1e-12
        )
        assert found.sigma[row] ** 2 == pytest.approx(other.scale, rel=1e-6)
        assert found.standard_deviation[row] ** 2 == pytest.approx(ratio * other.scale, rel=1e-5)
        for block in np.unique(BLOCK[has]):
            left = other.resid[BLOCK[has] == block]
            effect = ratio * left.sum() / (1 + ratio * left.size)
            assert found.effect[row, block] == pytest.approx(effect, rel=1e-5)


def test_balanced_blocks_have_the_variance_of_the_analysis_of_variance():
    """Equal designs in every block: REML is (MS_blocks - MS_residual) / n."""
    rng = np.random.default_rng(1)
    values = (
        MATRIX @ np.ones(10) + rng.normal(0, 1.0, (1, 4))[:, BLOCK] + rng.normal(0, 0.2, (1, 60))
    )
    found = _fit_random_intercept(MATRIX, values, block=BLOCK)
    means = values.reshape(4, 15).mean(axis=1)
    between = 15 * np.var(means, ddof=1)
    free = values[0] - means[BLOCK]
    left = free - MATRIX @ np.linalg.lstsq(MATRIX, free, rcond=None)[0]
    within = np.sum(left**2) / (60 - 10 - 3)
    assert found.sigma[0] ** 2 == pytest.approx(within, rel=1e-6)
    assert found.standard_deviation[0] ** 2 == pytest.approx((between - within) / 15, rel=1e-5)
    assert found.degrees_of_freedom[0].tolist() == [3.0] + [47.0] * 9


def test_blocks_closer_together_than_the_scatter_have_no_variance():
    rng = np.random.default_rng(2)
    values = rng.normal(size=(1, 15))[:, np.arange(60) % 15] + 0.01 * rng.normal(size=(1, 60))
    values += np.tile([0.5, -0.5], 30)  # scatter within, the same in each block
    found = _fit_random_intercept(np.ones((60, 1)), values, block=BLOCK)
    assert found.at_boundary.tolist() == [True]
    assert found.standard_deviation[0] == 0.0
    np.testing.assert_allclose(found.effect, 0.0)


@pytest.mark.parametrize("values", [np.full(60, 4.0), np.zeros(60)])
def test_a_response_that_does_not_vary_has_no_variance_between_blocks(values):
    found = _fit_random_intercept(MATRIX, values[None], block=BLOCK)
    assert found.at_boundary.tolist() == [True] and found.sigma[0] < 1e-13
    np.testing.assert_allclose(found.coefficient[0], [values[0], *np.zeros(9)], atol=1e-13)


@pytest.mark.parametrize("scatter", [0.0, 1e-9])
def test_blocks_that_do_not_scatter_within_are_apart_by_the_largest_ratio(scatter):
    levels = np.array([0.0, 3.0, 7.0, 2.0])
    noise = scatter * np.random.default_rng(7).normal(size=60)
    values = MATRIX @ np.ones(10) + levels[BLOCK] + noise
    found = _fit_random_intercept(MATRIX, values[None], block=BLOCK)
    assert found.standard_deviation[0] == pytest.approx(1e3 * found.sigma[0], rel=1e-9)
    np.testing.assert_allclose(found.effect[0], levels - levels.mean(), atol=2e-6)


def test_a_factor_that_moves_between_blocks_alone_is_judged_between_them():
    diameter = np.array([-1.0, -1.0, 1.0, 1.0])[BLOCK]
    values = np.random.default_rng(3).normal(size=(1, 60))
    found = _fit_random_intercept(
        np.column_stack([np.ones(60), diameter, RUNS[:, 0]]), values, block=BLOCK
    )
    assert found.is_between.tolist() == [True, True, False]
    assert found.degrees_of_freedom[0].tolist() == [2.0, 2.0, 55.0]


def test_too_few_runs_give_nothing():
    values = np.full((1, 60), np.nan)
    values[0, :10] = 1.0
    found = _fit_random_intercept(MATRIX, values, block=BLOCK)
    assert np.isnan(found.coefficient).all() and np.isnan(found.sigma).all()


def test_columns_of_blocks_leave_the_mean_the_mean_over_blocks():
    names, index, columns = block_columns(["x", "y", "y", "z"])
    assert names == ("x", "y", "z") and index.tolist() == [0, 1, 1, 2]
    means = np.array([1.0, 5.0, 9.0])
    full = np.column_stack([np.ones(4), columns])
    found = np.linalg.lstsq(full, means[index], rcond=None)[0]
    np.testing.assert_allclose(found, [5.0, -4.0, 0.0], atol=1e-12)


def test_one_block_is_refused():
    with pytest.raises(DataError, match="one block and nothing to compare it with; found A"):
        block_columns(["A", "A"])


PULLS = [f"R{run}" for run in range(15)]
LEVELS = box_behnken(3).coded
NAMES = {"factor_names": ["f", "T", "a"], "low": [-1] * 3, "high": [1] * 3, "units": "coded"}


def quadratic(coded):
    return model_matrix(coded, quadratic_exponents(3)) @ np.linspace(30, 21, 10)


@pytest.mark.parametrize("treatment", ["fixed", "random"])
def test_specimens_pulled_together_with_one_error_tell_no_more_than_one_specimen(treatment):
    # values of the second are those of the first and a constant: nothing is learnt from them
    one = quadratic(LEVELS) + np.random.default_rng(4).normal(0, 0.3, 15)
    alone = fit_surfaces(LEVELS, [one], response_names=["y"], **NAMES)
    both = fit_surfaces(
        np.vstack([LEVELS, LEVELS]), [np.concatenate([one, one + 2.0])], response_names=["y"],
        blocks=["A"] * 15 + ["B"] * 15, block_treatment=treatment, pulls=PULLS * 2, **NAMES,
    )  # fmt: skip
    for name in ("coefficient_standard_uncertainty", "t", "p_value"):
        found, wanted = getattr(both, name)[0], getattr(alone, name)[0]
        assert found[1:] == pytest.approx(wanted[1:], rel=1e-6)  # REML is iterated
    assert (both.term_degrees_of_freedom[0, 1:] == 5).all()
    assert both.overall_p_value[0] == pytest.approx(alone.overall_p_value[0], rel=1e-6)
    assert both.lack_of_fit.p_value[0] == pytest.approx(alone.lack_of_fit.p_value[0], rel=1e-6)
    told = [one.numbers["freedom"] for one in both.notes if one.code == f"blocks-{treatment}"]
    assert told == [1]  # of two specimens
    for name in ("sum_of_squares", "pure_error_sum_of_squares"):  # each pull has two specimens
        wanted = 2 * getattr(alone.lack_of_fit, name)
        assert getattr(both.lack_of_fit, name) == pytest.approx(wanted, rel=1e-6)
    own, other = both.anova, alone.anova
    for source in ("first order", "interactions", "squares"):
        place, wanted = own.source.index(source), other.source.index(source)
        assert own.p_value[0, place] == pytest.approx(other.p_value[0, wanted], rel=1e-6)
    within = own.sum_of_squares[0, own.source.index("within pulls")]
    assert within == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("missing", [0, 3])
def test_errors_of_pulls_leave_five_percent_of_terms_without_effect_significant(missing):
    rng = np.random.default_rng(12)
    ratio = []
    for _ in range(60):
        own, common = rng.normal(0, 0.5, 30), np.tile(rng.normal(0, 1, 15), 2)
        values = 30 + own + common
        values[rng.choice(30, missing, replace=False)] = np.nan
        found = fit_surfaces(
            np.vstack([LEVELS, LEVELS]), [values], response_names=["y"], with_tests=False,
            blocks=["A"] * 15 + ["B"] * 15, pulls=PULLS * 2, **NAMES,
        )  # fmt: skip
        uncertainty = found.coefficient_standard_uncertainty
        ratio.append(np.abs(found.coefficient / uncertainty)[0, 1:])
    # Student's t at 5 % for five degrees of freedom; by the scatter of thirty rows it is 30 %
    assert 0.02 < np.mean(np.array(ratio) > 2.571) < 0.09


def test_pulls_of_one_specimen_each_change_nothing():
    runs = np.vstack([LEVELS, LEVELS])
    values = [quadratic(runs) + np.random.default_rng(5).normal(0, 0.3, 30)]
    given = {"response_names": ["y"], "blocks": ["A"] * 15 + ["B"] * 15, **NAMES}
    apart = fit_surfaces(runs, values, pulls=[*PULLS, *(f"{one} B" for one in PULLS)], **given)
    plain = fit_surfaces(runs, values, **given)
    assert apart.anova.source == plain.anova.source
    np.testing.assert_array_equal(apart.p_value, plain.p_value)
