"""Life against load: levels, run-outs, and what cannot be fitted."""

import math

import numpy as np
import pytest

from reduction.experiments.life_statistics import fit_load_life, life_at_load, load_levels
from reduction.experiments.outcome_groups import fatigue_rows
from reduction.experiments.outcomes import Outcome
from reduction.record.errors import DataError, FitError

LOAD = np.repeat([0.3, 0.4, 0.5, 0.7], 3)
LIVES = 500 * LOAD**-5.0 * np.tile([0.7, 1.0, 1.4], 4)
NONE = np.zeros(12, dtype=bool)


def test_complete_lives_give_the_line_of_least_squares():
    fit = fit_load_life(LOAD, LIVES, NONE)
    slope, _ = np.polyfit(np.log(LOAD), np.log(LIVES), 1)
    assert fit.exponent == pytest.approx(-slope)
    assert fit.reference_load_ratio == pytest.approx(np.exp(np.log(LOAD).mean()))
    assert fit.log_life == pytest.approx(np.log(LIVES).mean())
    # one shape at all loads, so medians of their own gain nothing
    assert fit.lack_of_fit_p_value == pytest.approx(1.0)


def test_a_limit_below_which_nothing_fails_is_no_line():
    lives = np.where(LOAD < 0.35, 1e7, LIVES)
    fit = fit_load_life(LOAD, lives, LOAD < 0.35)
    assert fit.lack_of_fit_p_value < 0.01
    assert (fit.n_failed, fit.n_suspended) == (9, 3)
    assert (fit.load_ratio_low, fit.load_ratio_high) == (0.3, 0.7)


def test_runouts_make_the_line_steeper_than_failures_there():
    lives = np.where(LOAD < 0.35, 2e5, LIVES)
    assert (
        fit_load_life(LOAD, lives, LOAD < 0.35).exponent > fit_load_life(LOAD, lives, NONE).exponent
    )


def test_bounds_are_narrowest_amid_the_loads_and_a_load_outside_is_told():
    fit = fit_load_life(LOAD, LIVES, NONE)
    life, low, high, inside = life_at_load(fit, [0.2, fit.reference_load_ratio, 0.9])
    assert inside.tolist() == [False, True, False]
    width = np.log(high / low)
    assert width[1] < width.min(initial=9, where=[True, False, True])
    assert (np.diff(life) < 0).all()


def test_a_tenth_fails_before_half_does():
    for distribution in ("lognormal", "weibull"):
        fit = fit_load_life(LOAD, LIVES, NONE, distribution=distribution)
        assert life_at_load(fit, 0.5, failed_share=0.1)[0] < life_at_load(fit, 0.5)[0]


def test_two_failures_and_a_runout_give_a_line_without_bounds():
    fit = fit_load_life([0.5, 0.7, 0.3], [3e4, 4e3, 2e6], [False, False, True])
    _, low, high, _ = life_at_load(fit, 0.5)
    assert math.isnan(low) and math.isnan(high)


def test_loads_that_a_machine_does_not_repeat_are_one_level():
    assert load_levels([0.305, 0.30, 0.31, 0.33]).tolist() == [0, 0, 0, 1]


def test_failures_at_one_load_are_refused():
    with pytest.raises(
        FitError, match="needs failures at two loads; found failures at 1; needed 2"
    ):
        fit_load_life([0.3, 0.5, 0.502], [2e5, 3e4, 4e4], [True, False, False])


def test_failures_that_lie_on_a_line_are_refused():
    with pytest.raises(FitError, match="the failures have no scatter about the law"):
        fit_load_life([0.3, 0.5], [2e5, 3e4], [False, False])


def test_a_load_of_nothing_is_refused():
    with pytest.raises(DataError, match="values of peak_load_ratio are not positive"):
        load_levels([0.0])


def test_abrasion_is_compared_with_new_polypropylene_of_the_same_make():
    """CG-D-39-80, sec. 6.2: nylon three times, polyester twice, jacketed five to six times."""
    lives = np.array([2.6e3, 3.1e3, 3.4e3, 4.0e3])

    def abraded(material, times, *, construction="8-strand plaited", condition="new"):
        return [
            Outcome(
                "abrasion_cycles", times * life, material=material, construction=construction,
                diameter=0.0127, condition=condition,
            )
            for life in lives
        ]  # fmt: skip

    outcomes = [
        *abraded("polypropylene", 1.0), *abraded("nylon", 3.0), *abraded("polyester", 2.0),
        *abraded("polyester", 11.0, condition="jacketed"),
        *abraded("polyester", 2.0, construction="3-strand twisted"),
        *abraded("polypropylene", 0.5, condition="worn"),
    ]  # fmt: skip
    rows = [
        {key: row[f"relative_abrasion_resistance{key}"] for key in ("", "_low", "_high")}
        for row in fatigue_rows(outcomes)
    ]
    found = [row[""] for row in rows]
    expected = [np.nan, 3.0, 2.0, 11.0, np.nan, 0.5]
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    assert all(row["_low"] < row[""] < row["_high"] for row in rows if row[""] > 0)
    of_fatigue = [Outcome("cycles_to_failure", life, material="nylon") for life in lives]
    assert np.isnan(fatigue_rows(of_fatigue)[0]["relative_abrasion_resistance"])
