"""Amplitude summary: means over the cycles after break-in, with type A uncertainty."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.cycles.cycle_product import Loops, turns_alike
from reduction.stages.moduli.secant_modulus import late_change, summarise_amplitude

AREA = np.array([5e-4, 4e-4])


def loops_of(values, uncertainty=None):
    fields = {name: values.copy() for name in Loops.__dataclass_fields__ if name != "uncertainty"}
    fields |= dict.fromkeys(
        ("tension_turn_missed", "strain_turn_missed", "energy_turn_missed"), 0 * values
    )
    return Loops(**fields, uncertainty=uncertainty or {})


def test_mean_and_uncertainty_are_those_of_the_cycles_after_break_in():
    rng = np.random.default_rng(15)
    values = 100 + rng.standard_normal((2, 9))
    values[1, 4] = np.nan
    summary = summarise_amplitude(loops_of(values), area=AREA, break_in_cycles=2)
    for row in range(2):
        kept = values[row, 2:][np.isfinite(values[row, 2:])]
        assert summary.loss_factor[row] == pytest.approx(kept.mean())
        assert summary.uncertainty["loss_factor"][row] == pytest.approx(
            kept.std(ddof=1) / np.sqrt(kept.size)
        )
        assert summary.dynamic_modulus[row] == pytest.approx(kept.mean() / AREA[row])
        assert summary.uncertainty["dynamic_modulus"][row] == pytest.approx(
            summary.uncertainty["loss_factor"][row] / AREA[row]
        )


def test_one_cycle_keeps_its_own_uncertainty():
    one = np.full((2, 1), 7.0)
    summary = summarise_amplitude(loops_of(one, {"frequency": one / 10}), area=AREA)
    assert summary.uncertainty["frequency"] == pytest.approx([0.7, 0.7])
    assert np.isnan(summary.uncertainty["loss_factor"]).all()


def test_specimen_without_cycles_is_nan():
    values = np.array([[1.0, 2.0], [np.nan, np.nan]])
    summary = summarise_amplitude(loops_of(values), area=AREA)
    assert summary.frequency[0] == pytest.approx(2 / (1 / 1.0 + 1 / 2.0))  # cycles over their time
    assert np.isnan(summary.frequency[1])


@pytest.mark.parametrize("lag", [0.1, 0.2, 0.4])
def test_a_corner_that_both_channels_miss_is_not_in_the_spring_constant(lag):
    """Corners anywhere between two readings, tension logged late by a lag drawn for each test."""
    rng = np.random.default_rng(22)
    place = rng.random(200_000)
    width = 0.02  # a corner half way between two readings, over the amplitude

    def missed(at):
        return 2 * width * np.abs((at + 0.5) % 1 - 0.5)

    error = missed(place + rng.normal(0, lag, place.size)) - missed(place)
    values = np.full((1, 2), 100.0)
    turns = dict.fromkeys(("tension_turn_missed", "strain_turn_missed"), width * values)
    loops = replace(loops_of(values), **turns)
    summary = summarise_amplitude(loops, area=[1e-4], turns_alike=turns_alike(np.array([lag]), 1.0))
    assert summary.uncertainty["apparent_spring_constant"] == pytest.approx(
        [100 * error.std()], rel=0.01
    )
    # of a lag that is not stated nothing is alike, and the amplitudes have it whatever the lag is
    apart = summarise_amplitude(loops, area=[1e-4])
    assert apart.uncertainty["apparent_spring_constant"] == pytest.approx([100 * width / 2])
    for name in ("tension_amplitude", "strain_amplitude"):
        assert summary.uncertainty[name] == apart.uncertainty[name]


@pytest.mark.parametrize("readings", [50.0, 50.05, 50.3])
def test_corners_at_many_places_between_readings_miss_alike_in_both_channels(readings):
    """Of ten cycles, tension logged late by half an interval, as a standard deviation."""
    rng = np.random.default_rng(23)
    place = rng.random((50_000, 1)) + readings * np.arange(10)
    late = rng.normal(0, 0.5, (50_000, 1))
    both = [2 * np.abs((at + 0.5) % 1 - 0.5).mean(axis=1) for at in (place + late, place)]
    alike = turns_alike(np.array([0.5]), 1.0, period=readings, n_cycles=10)
    assert np.sqrt((1 - alike) / 4) == pytest.approx([(both[0] - both[1]).std()], rel=0.02)


def test_only_as_much_is_alike_as_both_channels_miss():
    values = np.full((1, 2), 100.0)
    loops = replace(loops_of(values), tension_turn_missed=3 * values, strain_turn_missed=values)
    summary = summarise_amplitude(loops, area=[1e-4], turns_alike=np.array([1.0]))
    # 3 and 1 of the amplitude: 9 + 1 - 2
    assert summary.uncertainty["apparent_spring_constant"] == pytest.approx([100.0])


def test_break_in_of_every_cycle_is_refused():
    with pytest.raises(DataError, match="no cycle is left after break-in; found 3 cycles"):
        summarise_amplitude(loops_of(np.ones((2, 3))), area=AREA, break_in_cycles=3)


def test_readings_of_the_slope_of_the_loop_spread_with_the_loss_angle():
    # at 13 degrees 1/cos - cos = 0.0519; its slope on tan by a difference
    tangent = np.tan(np.radians(13.0))
    fields = {name: np.full((2, 3), 50.0) for name in Loops.__dataclass_fields__}
    fields["loss_factor"] = np.array([[tangent - 1e-3, tangent, tangent + 1e-3], [-0.1] * 3])
    summary = summarise_amplitude(Loops(**{**fields, "uncertainty": {}}), area=AREA)
    assert summary.slope_reading_spread[0] == pytest.approx(0.0519, abs=5e-5)

    def spread(angle):
        return 1 / np.cos(angle) - np.cos(angle)

    step = 1e-6
    slope = (spread(np.arctan(tangent + step)) - spread(np.arctan(tangent - step))) / (2 * step)
    expected = slope * summary.uncertainty["loss_factor"][0]
    assert summary.uncertainty["slope_reading_spread"][0] == pytest.approx(expected, rel=1e-4)
    # tension behind strain: no ellipse to read slopes from
    assert np.isnan(summary.slope_reading_spread[1])


def test_a_test_that_softens_has_the_mean_of_its_cycles_and_no_trend_in_its_interval():
    """Stiffness that falls by a tenth; each cycle is known to a thousandth."""
    cycle = np.arange(20.0)
    values = 1000 * (0.9 + 0.1 * np.exp(-cycle / 4))[None]
    own = {"apparent_spring_constant": np.full((1, 20), 1.0)}
    summary = summarise_amplitude(loops_of(values, own), area=[5e-4])
    assert summary.apparent_spring_constant[0] == pytest.approx(values.mean())
    # by the sum of the geometric series the last half lies 9.1 below the mean
    assert late_change(values[0]) == pytest.approx(
        5 * np.exp(-0.25 * 10) * (1 - np.exp(-2.5)) / (1 - np.exp(-0.25)) * 2
        - 5 * (1 - np.exp(-5)) / (1 - np.exp(-0.25))
    )
    # a thousandth over the root of twenty, and what the first steps bend by
    assert 0.22 < summary.uncertainty["apparent_spring_constant"][0] < 1.0
