"""Cautions: each stands where its cause is, and not where it is not."""

from dataclasses import fields, replace

import numpy as np
import pytest

from reduction.experiments.designs import FactorLevels, box_behnken, plackett_burman
from reduction.experiments.run_sheet import find_cautions, make_run_sheet
from reduction.record.errors import SettingsError

FREQUENCY = FactorLevels("frequency", 0.1, 0.5)
MEAN = FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength")
AMPLITUDE = FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength")
SHARE = FactorLevels("tension_amplitude", 0.3, 0.6, "mean_tension")


def sheet(amplitude=AMPLITUDE, *, n_centre=None, **options):
    design = box_behnken(3, n_centre=n_centre)
    return make_run_sheet(design, (FREQUENCY, MEAN, amplitude), rated_break_strength=1e4, **options)


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
    factors = (FREQUENCY, MEAN, FactorLevels("temperature", 5.0, 20.0))
    kinds = found(make_run_sheet(box_behnken(3), factors, rated_break_strength=1e4), load_limit=1.0)
    assert "standard order" in kinds["load-not-known"].message
    assert "load-over-limit" not in kinds and "order-confounded" not in kinds


def test_screening_of_the_report_keeps_three_per_cent_and_is_not_slack():
    # Table A-1: 15 to 50 and 5 to 12 % of break strength
    factors = (
        FREQUENCY,
        FactorLevels("mean_tension", 0.15, 0.50, "rated_break_strength"),
        AMPLITUDE,
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
    assert "runs A13, A14, A15 are one run" in kinds["pure-error-excludes-drift"].message
    assert kinds["slack"].runs == (11,)


def test_a_measured_minimum_near_zero_is_slack_and_a_planned_one_is_not():
    # 12 less 11.9 % of 10 kN is 10 N under a peak of 2390 N
    near = sheet(FactorLevels("tension_amplitude", 0.05, 0.119, "rated_break_strength"))
    assert "slack" not in found(near)
    message = found(near, is_measured=True)["slack"].message
    assert "run 11 falls to 10 N" in message and "every cycle" not in message
