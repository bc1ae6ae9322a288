"""Levels in SI, in break strength, in mean tension; what cannot be a level."""

import numpy as np
import pytest

from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    engineering_levels,
    plackett_burman,
)
from reduction.record.errors import DataError, SettingsError

CODED = np.array([[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]])


def loads(low, high, amplitude_low, amplitude_high, basis="rated_break_strength"):
    return (
        FactorLevels("mean_tension", low, high, "rated_break_strength"),
        FactorLevels("tension_amplitude", amplitude_low, amplitude_high, basis),
    )


def test_amplitude_as_a_fraction_of_the_mean_follows_the_mean_of_its_run():
    factors = loads(0.1, 0.3, 0.2, 0.6, basis="mean_tension")
    coded = [[-1.0, 1.0], [1.0, -1.0], [0.0, 0.0]]
    levels = engineering_levels(coded, factors, rated_break_strength=1000.0)
    np.testing.assert_allclose(levels, [[100, 60], [300, 60], [200, 80]])


def test_the_mean_may_stand_after_the_amplitude():
    mean, amplitude = loads(0.1, 0.3, 0.2, 0.6, basis="mean_tension")
    levels = engineering_levels([[1.0, -1.0]], (amplitude, mean), rated_break_strength=1000.0)
    np.testing.assert_allclose(levels, [[60, 100]])


def test_two_diameters_in_one_screening_each_have_their_break_strength():
    # CG-D-39-80, Table A-1: 15 to 50 % of break strength; A-3: 6920 and 17530 lb wet
    design = plackett_burman(2)
    strength = np.where(design.coded[:, 1] > 0, 17530.0, 6920.0)
    factors = (
        FactorLevels("mean_tension", 0.15, 0.50, "rated_break_strength"),
        FactorLevels("diameter", 0.5, 13 / 16),
    )
    levels = engineering_levels(design.coded, factors, rated_break_strength=strength)
    assert set(levels[:, 0].round(1)) == {1038.0, 3460.0, 2629.5, 8765.0}
    assert set(levels[:, 1]) == {0.5, 0.8125}


@pytest.mark.parametrize(
    ("low", "high"), [(0.5, 0.1), (0.1, 0.1), (float("nan"), 1), (0.1, float("inf"))]
)
def test_levels_that_do_not_rise_are_refused(low, high):
    with pytest.raises(SettingsError, match="levels of frequency do not rise; found"):
        FactorLevels("frequency", low, high)


@pytest.mark.parametrize("name", ["frequency", "mean_tension", "tension_amplitude"])
def test_a_level_at_zero_is_refused_where_it_cannot_be_run(name):
    with pytest.raises(SettingsError, match=f"a level of {name} is not above zero; found 0 and 1"):
        FactorLevels(name, 0.0, 1.0)


def test_a_temperature_below_zero_is_a_level():
    assert FactorLevels("temperature", -5.0, 20.0).low == -5


def test_a_fraction_above_the_whole_is_refused():
    with pytest.raises(
        SettingsError,
        match="more than the whole rated break strength; found 12 and 30; needed fractions",
    ):
        FactorLevels("mean_tension", 12, 30, "rated_break_strength")
    with pytest.raises(
        SettingsError, match=r"more than the whole mean tension.*go slack in every cycle"
    ):
        FactorLevels("tension_amplitude", 0.5, 1.2, "mean_tension")


def test_only_loads_are_fractions():
    with pytest.raises(
        SettingsError, match="frequency cannot be a fraction of the rated break strength"
    ):
        FactorLevels("frequency", 0.1, 0.5, "rated_break_strength")
    with pytest.raises(
        SettingsError, match="mean_tension cannot be a fraction of the mean tension"
    ):
        FactorLevels("mean_tension", 0.1, 0.5, "mean_tension")


def test_break_strength_that_is_not_given_is_asked_for():
    with pytest.raises(
        SettingsError,
        match=r"fraction of the rated break strength, which is not given; found mean_tension, "
        r"tension_amplitude; .*Give rated_break_strength",
    ):
        engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1))


@pytest.mark.parametrize("strength", [0.0, -5.0, float("nan")])
def test_break_strength_that_cannot_be_is_refused(strength):
    with pytest.raises(DataError, match="rated_break_strength are not"):
        engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1), rated_break_strength=strength)


def test_break_strength_that_does_not_fit_the_runs_is_refused():
    with pytest.raises(
        DataError, match=r"does not fit the runs; found shape \(2,\); needed one value, or 3"
    ):
        engineering_levels(CODED, loads(0.1, 0.3, 0.05, 0.1), rated_break_strength=[1.0, 2.0])


def test_a_fraction_of_a_mean_that_is_not_a_factor_is_refused():
    amplitude = FactorLevels("tension_amplitude", 0.2, 0.6, "mean_tension")
    with pytest.raises(SettingsError, match="fraction of the mean tension, which is not a factor"):
        engineering_levels([[0.0]], (amplitude,))


def test_factors_that_do_not_fit_are_refused():
    factors = (FactorLevels("frequency", 0.1, 0.5),) * 2
    with pytest.raises(SettingsError, match="do not fit the design; found 2 factors; needed 3"):
        engineering_levels(box_behnken(3).coded, factors)
    with pytest.raises(SettingsError, match="a factor appears twice; found frequency"):
        engineering_levels(CODED, factors)


def test_coded_levels_that_are_no_table_are_refused():
    with pytest.raises(DataError, match=r"not a table of runs; found shape \(1,\)"):
        engineering_levels([0.0], (FactorLevels("frequency", 0.1, 0.5),))
    with pytest.raises(DataError, match="coded are not finite"):
        engineering_levels([[np.nan]], (FactorLevels("frequency", 0.1, 0.5),))
