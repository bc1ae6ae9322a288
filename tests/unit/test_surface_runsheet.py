"""Order of the runs: rising load, repeats together or spread, loads that are not known."""

from dataclasses import fields, replace

import numpy as np
import pytest
from refusals import refusals
from scipy import stats

from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    model_matrix,
    plackett_burman,
    quadratic_exponents,
    term_names,
)
from reduction.experiments.run_sheet import (
    _find_confounded,
    covariance_factor,
    expected_precision,
    find_cautions,
    levels_off_plan,
    make_run_sheet,
    smallest_effect,
    variance_factor,
)
from reduction.experiments.screening import screening_effects
from reduction.record.errors import DataError, FitError, SettingsError

FREQUENCY = FactorLevels("frequency", 0.1, 0.5)
MEAN = FactorLevels("mean_tension", 1000.0, 3000.0)
AMPLITUDE = FactorLevels("tension_amplitude", 200.0, 600.0)


def test_every_run_stands_on_the_sheet_once_with_its_own_levels():
    design = box_behnken(3)
    sheet = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE))
    assert sorted(sheet.run) == list(range(1, 16))
    np.testing.assert_array_equal(sheet.coded, design.coded[sheet.run - 1])
    np.testing.assert_allclose(sheet.engineering[:, 1], 2000 + 1000 * sheet.coded[:, 1])
    assert sheet.names == ("frequency", "mean_tension", "tension_amplitude")
    assert sheet.n_runs == 15


def test_peak_never_falls_and_blocks_count_from_one():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    assert np.all(np.diff(sheet.peak_tension) >= 0)
    assert np.all(np.isin(np.diff(sheet.load_block), [0, 1])) and sheet.load_block[0] == 1


def test_runs_of_equal_peak_share_a_block_though_their_last_bit_differs():
    # 0.1 + 0.2 is not 0.3: mean and amplitude swap places at equal peaks
    mean = FactorLevels("mean_tension", 0.3, 0.5)
    amplitude = FactorLevels("tension_amplitude", 0.05, 0.25)
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, mean, amplitude))
    corner = [(0, -1, 1), (0, 1, -1)]
    blocks = {
        int(b) for row, b in zip(sheet.coded, sheet.load_block, strict=True) if tuple(row) in corner
    }
    assert len(blocks) == 1
    # and the lower mean comes first
    assert [tuple(row) for row in sheet.coded if tuple(row) in corner] == corner


@pytest.mark.parametrize("n_centre", [2, 3, 5])
def test_spread_repeats_end_the_sheet_and_never_load_a_later_run_beforehand(n_centre):
    design = box_behnken(3, n_centre=n_centre)
    together = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE))
    sheet = make_run_sheet(design, (FREQUENCY, MEAN, AMPLITUDE), repeats="spread")
    centre = np.flatnonzero(np.all(sheet.coded == 0, axis=1))
    assert centre[0] == np.flatnonzero(np.all(together.coded == 0, axis=1))[0]
    assert centre[-1] == sheet.n_runs - 1
    assert np.all(np.diff(centre) > 1) and np.ptp(np.diff(centre)) <= 1
    rest = np.delete(sheet.peak_tension, centre[1:])
    assert np.all(np.diff(rest) >= 0)
    assert sorted(sheet.run) == list(range(1, design.n_runs + 1))


def test_shares_are_not_numbers_without_a_break_strength():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    assert np.isnan(sheet.peak_share).all() and np.isnan(sheet.minimum_share).all()
    assert np.isfinite(sheet.peak_tension).all()


def test_shares_follow_the_break_strength_of_each_run():
    design = plackett_burman(3)
    strength = np.where(design.coded[:, 2] > 0, 20e3, 10e3)
    factors = (MEAN, AMPLITUDE, FactorLevels("diameter", 0.5, 1.0))
    sheet = make_run_sheet(design, factors, rated_break_strength=strength)
    expected = sheet.peak_tension / np.where(sheet.coded[:, 2] > 0, 20e3, 10e3)
    np.testing.assert_allclose(sheet.peak_share, expected)


def test_without_a_load_the_standard_order_is_kept():
    design = box_behnken(3)
    factors = (FREQUENCY, MEAN, FactorLevels("temperature", 5.0, 20.0))
    sheet = make_run_sheet(design, factors)
    np.testing.assert_array_equal(sheet.run, np.arange(1, 16))
    assert np.isnan(sheet.peak_tension).all() and not sheet.load_block.any()
    np.testing.assert_allclose(sheet.mean_tension, 2000 + 1000 * design.coded[:, 1])


def test_a_break_strength_that_cannot_be_is_refused_though_no_level_needs_it():
    with pytest.raises(DataError, match="rated_break_strength are not positive"):
        make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), rated_break_strength=0.0)
    with pytest.raises(DataError, match="break strength does not fit the runs"):
        make_run_sheet(
            box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), rated_break_strength=[1.0, 2.0]
        )


def test_a_sheet_is_read_only():
    sheet = make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE))
    with pytest.raises(ValueError, match="read-only"):
        sheet.peak_tension[0] = 0


# cautions: each stands where its cause is, and not where it is not

MEAN_OF_CAUTIONS = FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength")
AMPLITUDE_OF_CAUTIONS = FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength")
SHARE = FactorLevels("tension_amplitude", 0.3, 0.6, "mean_tension")


def sheet(amplitude=AMPLITUDE_OF_CAUTIONS, *, n_centre=None, **options):
    design = box_behnken(3, n_centre=n_centre)
    return make_run_sheet(
        design, (FREQUENCY, MEAN_OF_CAUTIONS, amplitude), rated_break_strength=1e4, **options
    )


def found(run_sheet, **limits):
    return {caution.kind: caution for caution in find_cautions(run_sheet, **limits)}


def test_the_slack_run_of_the_report_is_named_with_its_peak():
    caution = found(sheet())["slack"]
    assert caution.runs == (11,)
    assert "run 11 reaches zero" in caution.message
    assert "its peak is 24 % of the break strength" in caution.message
    assert "fraction of the mean" in caution.hint


def test_a_negative_minimum_is_told_with_its_size():
    # 12 less 15 % of 10 kN is -300 N
    caution = found(sheet(FactorLevels("tension_amplitude", 0.05, 0.15, "rated_break_strength")))[
        "slack"
    ]
    assert "falls below zero, to -300 N" in caution.message


def test_an_amplitude_as_a_fraction_of_the_mean_removes_the_slack_run():
    assert "slack" not in found(sheet(SHARE))


def test_the_whole_mean_as_amplitude_is_slack():
    whole = found(sheet(FactorLevels("tension_amplitude", 0.5, 1.0, "mean_tension")))["slack"]
    # amplitude at +1: with the mean at -1 and +1, and with the frequency at -1 and +1
    assert len(whole.runs) == 4 and "runs" in whole.message


def test_a_sheet_in_newtons_names_no_share_of_strength():
    factors = (
        FREQUENCY,
        FactorLevels("mean_tension", 100, 300),
        FactorLevels("tension_amplitude", 50, 100),
    )
    caution = found(make_run_sheet(box_behnken(3), factors))["slack"]
    assert "break strength" not in caution.message


@pytest.mark.parametrize(("limit", "n_over"), [(4200.0, 0), (4199.0, 1), (3000.0, 6)])
def test_runs_above_a_load_limit_are_counted(limit, n_over):
    caution = found(sheet(), load_limit=limit).get("load-over-limit")
    assert (0 if caution is None else len(caution.runs)) == n_over


def test_runs_above_a_share_of_the_strength_are_named():
    caution = found(sheet(), peak_share_limit=0.40)["share-over-limit"]
    assert caution.runs == (12,)
    assert "run 12 is above 40 % of the rated break strength, up to 42 %" in caution.message
    assert "share-over-limit" not in found(sheet(), peak_share_limit=0.5)


def test_a_load_at_its_limit_is_not_above_it():
    # the peak of run 12, 30 + 12 %, is 0.42000000000000004 of the strength
    assert sheet().peak_share.max() == pytest.approx(0.42)
    assert "share-over-limit" not in found(sheet(), peak_share_limit=0.42)


def test_a_share_that_is_not_known_is_said():
    factors = (
        FREQUENCY,
        FactorLevels("mean_tension", 1e3, 3e3),
        FactorLevels("tension_amplitude", 50, 100),
    )
    unknown = found(make_run_sheet(box_behnken(3), factors), peak_share_limit=0.4)
    assert "Give rated_break_strength" in unknown["share-not-known"].hint


def test_consecutive_centres_leave_out_drift_and_spread_ones_do_not():
    assert found(sheet())["pure-error-excludes-drift"].runs == (13, 14, 15)
    assert "pure-error-excludes-drift" not in found(sheet(repeats="spread"))


def test_a_single_centre_is_no_repeat():
    kinds = found(sheet(n_centre=1))
    assert "Add centre runs" in kinds["no-repeats"].hint
    assert "pure-error-excludes-drift" not in kinds


def test_an_order_by_load_is_confounded_with_the_mean_tension():
    caution = found(sheet())["order-confounded"]
    # by hand: place of the runs with the mean at +1 less at -1 is (12+13+14+15)-(1+2+3+4) = 44;
    # the four and four levels have norm sqrt(8), the places 1 to 15 have norm sqrt(280)
    assert f"mean_tension {44 / (8 * 280) ** 0.5:+.2f}" in caution.message
    assert "frequency" not in caution.message


def test_an_order_that_was_drawn_is_named_in_one_plan_of_twenty():
    """Runs in an order drawn at random follow some factor by chance."""
    rng = np.random.default_rng(7)
    plan = sheet()
    named = 0
    for _ in range(600):
        order = rng.permutation(plan.n_runs)
        moved = {
            one.name: getattr(plan, one.name)[order]
            for one in fields(plan)
            if one.name != "factors"
        }
        named += "order-confounded" in found(replace(plan, **moved))
    # 0.05 +- 0.009 of 600
    assert 0.03 < named / 600 < 0.08


def test_loads_that_are_not_known_are_said():
    factors = (FREQUENCY, MEAN_OF_CAUTIONS, FactorLevels("temperature", 5.0, 20.0))
    kinds = found(make_run_sheet(box_behnken(3), factors, rated_break_strength=1e4), load_limit=1.0)
    assert "standard order" in kinds["load-not-known"].message
    assert "load-over-limit" not in kinds and "order-confounded" not in kinds


def test_screening_of_the_report_keeps_three_per_cent_and_is_not_slack():
    # Table A-1: 15 to 50 and 5 to 12 % of break strength
    factors = (
        FREQUENCY,
        FactorLevels("mean_tension", 0.15, 0.50, "rated_break_strength"),
        AMPLITUDE_OF_CAUTIONS,
        FactorLevels("duration", 2e4, 2e5),
    )
    run_sheet = make_run_sheet(plackett_burman(4), factors, rated_break_strength=1.0)
    assert run_sheet.minimum_tension.min() == pytest.approx(0.03)
    assert "slack" not in found(run_sheet)


@pytest.mark.parametrize("name", ["load_limit", "peak_share_limit"])
def test_a_limit_of_nothing_is_refused(name):
    with pytest.raises(SettingsError, match=f"{name} is not above zero; found 0"):
        find_cautions(sheet(), **{name: 0.0})


def test_runs_are_called_by_their_names_where_those_are_given():
    plan = sheet()
    names = [f"A{number:02d}" for number in plan.run]
    kinds = {caution.kind: caution for caution in find_cautions(plan, run_names=names)}
    assert "of run A11 reaches zero" in kinds["slack"].message
    assert "runs A13, A14, A15 repeat one run" in kinds["pure-error-excludes-drift"].message
    assert kinds["slack"].runs == (11,)


def test_a_measured_minimum_near_zero_is_slack_and_a_planned_one_is_not():
    # 12 less 11.9 % of 10 kN is 10 N under a peak of 2390 N
    near = sheet(FactorLevels("tension_amplitude", 0.05, 0.119, "rated_break_strength"))
    assert "slack" not in found(near)
    message = found(near, is_measured=True)["slack"].message
    assert "run 11 falls to 10 N" in message and "every cycle" not in message


# runs that are not where the plan has them

PLAN = box_behnken(3).coded
NAMES = [f"R{number}" for number in range(1, 16)]
FACTORS = ["f", "T", "a"]


def off(coded, beyond=0.3):
    return levels_off_plan(coded, PLAN, beyond=beyond, run_names=NAMES, factor_names=FACTORS)


def test_two_runs_swapped_are_named_by_id_and_factor():
    swapped = np.arange(15)
    swapped[[0, 3]] = swapped[[3, 0]]
    words = off(PLAN[swapped])
    # the first four runs of a Box-Behnken design are the corners of the first two factors
    assert {word.split()[0] for word in words} == {"R1", "R4"}
    assert words[0] == "R1 f +1.00, planned -1.00" and len(words) == 4


def test_scatter_within_the_tolerance_and_missing_runs_are_silent():
    near = PLAN + np.random.default_rng(1).uniform(-0.29, 0.29, PLAN.shape)
    near[5] = np.nan
    assert off(near) == ()
    assert len(off(near, beyond=0.0)) == 42


def test_the_farthest_stands_first():
    away = PLAN.copy()
    away[2, 1] += 0.4
    away[7, 0] -= 0.9
    assert [word.split()[:2] for word in off(away)] == [["R8", "f"], ["R3", "T"]]


# the smallest effect that a screening is expected to see


def test_it_is_the_t_of_the_report_times_the_error_of_a_difference_of_means():
    # CG-D-39-80, Table A-2: t(0.10, 6) = 1.943
    assert smallest_effect(plackett_burman(5), sigma=3.0) == pytest.approx(
        1.943 * 3.0 * np.sqrt(1 / 6 + 1 / 6), rel=2e-4
    )


@pytest.mark.parametrize("n_factors", [5, 11])
def test_it_is_what_screenings_of_noise_come_to(n_factors):
    design = plackett_burman(n_factors, n_runs=12)
    noise = np.random.default_rng(1).normal(0.0, 2.0, (20_000, 12))
    found = screening_effects(design, noise)
    expected = smallest_effect(design, sigma=2.0)
    # the error by dummies is unbiased in its square; Lenth's is close in its median
    error = np.sqrt(np.mean(found.effect_standard_error**2))
    ratio = found.minimum_significant_effect[0] / found.effect_standard_error[0]
    assert ratio * error == pytest.approx(float(expected), rel=0.01 if n_factors == 5 else 0.15)


# expected widths: against the factors of the fifteen runs, a simulation, and lost runs

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


EXPONENTS = quadratic_exponents(3)
NAMES_OF_VARIANCE = term_names(EXPONENTS, ["f", "Tm", "dT"])
MATRIX = model_matrix(box_behnken(3).coded, EXPONENTS)


def test_the_design_of_the_report_has_the_variance_factors_of_its_algebra():
    factor = covariance_factor(MATRIX, names=NAMES_OF_VARIANCE)
    expected = [1 / 3, *[13 / 48] * 3, *[1 / 8] * 3, *[1 / 4] * 3]
    np.testing.assert_allclose(np.diag(factor), expected, rtol=1e-12)
    assert np.linalg.cond(MATRIX) == pytest.approx(4.24, abs=0.005)
    corner = variance_factor(model_matrix([[1.0, 1.0, 1.0]], EXPONENTS), factor)
    assert corner[0] == pytest.approx(1.396, abs=0.0005)
    assert variance_factor(MATRIX, factor).max() == pytest.approx(0.75, abs=1e-12)


def test_variance_factors_of_several_patterns_pair_up_with_their_responses():
    factors = np.stack([np.eye(2), 4 * np.eye(2)])
    rows = np.ones((3, 1, 2))
    found = variance_factor(rows, factors, pattern=np.array([1, 0, 1]))
    np.testing.assert_array_equal(found.ravel(), [8.0, 2.0, 8.0])


def test_a_singular_design_names_what_it_confounds():
    two_levels = np.sign(np.random.default_rng(0).normal(size=(20, 3)))
    with pytest.raises(FitError, match=r"cannot tell all terms apart; found f\^2 with mean; "):
        covariance_factor(model_matrix(two_levels, EXPONENTS), names=NAMES_OF_VARIANCE)


def test_a_column_of_noughts_is_named():
    assert _find_confounded([[1.0, 0.0], [1.0, 0.0]], ["mean", "f"]) == ("f is zero in every run",)
    with pytest.raises(FitError, match="f is zero in every run"):
        covariance_factor([[1.0, 0.0], [1.0, 0.0]], names=["mean", "f"])


REFUSED = {
    "another placing of repeats is refused": (
        lambda: make_run_sheet(box_behnken(3), (FREQUENCY, MEAN, AMPLITUDE), repeats="random"),
        SettingsError,
        "one of two ways; found random; needed together or spread",
    ),
    "levels that do not pair up are refused": (
        lambda: off(PLAN[:14]),
        DataError,
        "series do not pair up",
    ),
    "what is no scatter is refused": (
        lambda: smallest_effect(plackett_burman(5), sigma=0.0),
        DataError,
        "sigma",
    ),
    "fewer runs than terms are refused": (
        lambda: covariance_factor(MATRIX[:9], names=NAMES_OF_VARIANCE),
        FitError,
        "fewer runs than terms; found 9 runs; needed 10",
    ),
}


test_refusals = refusals(REFUSED)
