"""Reasons, and the arithmetic that is this module's own; numbers of a log are in the oracle."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.survey import _loaded_before
from reduction.record.errors import SettingsError
from reduction.stages.three_parameter_line.change_in_length import (
    PROPERTY_NAMES,
    BeddingCycles,
    CyclicLevel,
    FirstRise,
    HeldTension,
    PairOfHolds,
    StepNumber,
    StepOfProgramme,
    change_in_length,
)

CYCLES = BeddingCycles(
    first_stiffness=StepNumber(1000.0, 2.0),
    permanent_strain=StepNumber(0.03, 0.002),
    foot_strain=0.05,
    foot_strain_contribution=np.empty(0),
    valley_tension=40.0,
    first_peak_tension=75.0,
    peak_tension=80.0,
)
PAIR = PairOfHolds(
    StepNumber(10.0, 0.0), StepNumber(30.0, 0.0), StepNumber(500.0, 5.0), 600.0
)  # fmt: skip
HOLD = HeldTension(20.0, 6000.0, StepNumber(1e-3, 1e-5))
UNKNOWN = StepNumber(math.nan, math.nan)


def rise(*tension):
    """On strains of 0.01; NaN is a gap."""
    load = np.array(tension)
    known = np.isfinite(load)
    return FirstRise(
        0.01 * (1 + np.flatnonzero(known)), load[known], np.full(known.sum(), 0.5), 0.01,
        np.empty((0, known.sum())), np.empty((0, known.sum())),
    )  # fmt: skip


def step(name="S", **parts):
    return StepOfProgramme(name, 600.0, **parts)


def bedding(**parts):
    return step("B", **({"bedding": CYCLES} | parts))


def named(steps, name, **given):
    return [one for one in change_in_length(steps, **given) if one.name == name]


@pytest.mark.parametrize("name", PROPERTY_NAMES)
def test_without_steps_every_property_is_absent_with_a_reason(name):
    (one,) = named([], name)
    assert math.isnan(one.value)
    assert math.isnan(one.standard_uncertainty)
    assert one.reason
    assert one.is_stiffness == ("stiffness" in name)


@pytest.mark.parametrize("name", PROPERTY_NAMES[1:])
def test_tests_without_a_product_are_told_where_a_property_is_absent(name):
    (one,) = named([step()], name, missing="C failed")
    assert one.reason.endswith("; C failed")


def test_a_refusal_of_a_step_says_nothing_of_missing_tests():
    short = HeldTension(20.0, 90.0, UNKNOWN, "too short")
    (one,) = named([step(holds=(short,))], "polymer strain", missing="C failed")
    assert one.reason == "too short"


def test_a_property_of_a_step_says_nothing_of_missing_tests():
    (one,) = named([step(pairs=(PAIR,))], "static stiffness", missing="C failed")
    assert one.reason == ""


def test_construction_strain_holds_the_first_rise():
    # the rise has 40 N at 0.02; the first foot is 0.03 further, and the cycles left 0.03
    (one,) = named([bedding(first_rise=rise(20, 40, 60, 80))], "construction strain")
    assert one.value == pytest.approx(0.06)
    assert one.reason == ""
    assert (one.low_tension, one.high_tension) == (40.0, 80.0)
    # 0.5 N on a slope of 2000 N; the foot of the first cycle is in it twice, with opposite signs
    spread = math.sqrt(0.002**2 + (0.5 / 2000) ** 2)
    assert one.standard_uncertainty == pytest.approx(spread)


def test_a_rise_that_begins_at_the_valleys_is_read_at_its_foot():
    (one,) = named([bedding(first_rise=rise(40, 60, 80))], "construction strain")
    assert one.value == pytest.approx(0.03 + 0.05 - 0.01)


def test_construction_strain_of_the_cycles_alone_is_told():
    (one,) = named([bedding()], "construction strain")
    assert (one.value, one.standard_uncertainty) == (0.03, 0.002)
    assert "from the cycles alone" in one.reason
    (above,) = named([bedding(first_rise=rise(50, 80))], "construction strain")
    assert "does not pass the tension" in above.reason
    with_gap = bedding(first_rise=rise(20, 30, np.nan, np.nan, 60, 80))
    (held,) = named([with_gap], "construction strain")
    assert held.value == 0.03
    assert "has a hold there" in held.reason


def test_cycles_without_a_permanent_strain_give_no_construction_strain():
    cycles = dataclasses.replace(CYCLES, permanent_strain=UNKNOWN)
    (one,) = named([bedding(bedding=cycles)], "construction strain")
    assert "no permanent strain" in one.reason
    assert one.step == "B"


@pytest.mark.parametrize("name", ["original stiffness", "construction strain"])
def test_what_is_of_a_new_rope_is_absent_of_one_loaded_before(name):
    whole = bedding(first_rise=rise(20, 40, 60, 80))
    (one,) = named([whole], name, loaded_before="it had carried 7 cycles")
    assert math.isnan(one.value)
    assert "7 cycles" in one.reason
    (lost,) = named([whole], name, is_ordered=False)
    assert math.isnan(lost.value)
    assert "order of the tests is not stated" in lost.reason


@pytest.mark.parametrize("name", ["original stiffness", "construction strain"])
def test_cycles_after_a_pull_in_their_step_are_not_those_of_a_new_rope(name):
    # ISO 18692: a pull to half of the strength and a hold come before the cycles
    (one,) = named([bedding()], name, loaded_in_step="B loads it to 125 N")
    assert math.isnan(one.value)
    assert "loads it to 125 N" in one.reason
    whole = bedding(first_rise=rise(20, 40, 60, 80))
    (on_rise,) = named([whole], name, loaded_in_step="B loads it to 125 N")
    assert on_rise.value > 0


@pytest.mark.parametrize(
    ("pulled", "begin", "found"),
    [
        (0.0, 20, {}),
        (60.0, 20, {"rope": (60.0, True)}),
        (60.0, 0, {"rope": (60.0, False)}),
        (12.0, 0, {}),  # the ramp stops a little above the valley
    ],
)
def test_a_load_before_the_first_cycle_from_which_it_went_back_is_found(pulled, begin, found):
    time = np.arange(60.0)
    load = np.interp(time, [0, 10, 20, 30, 40, 50, 59], [0, pulled, 0, 10, 50, 10, 50])

    def located(part, **more):
        record = SimpleNamespace(time=time[part], specimens=("rope",))
        return SimpleNamespace(record=record, tension=load[None, part], **more)

    cycles = SimpleNamespace(first=np.array([30 - begin]))
    step = located(slice(begin, None), cycles=cycles)
    assert _loaded_before(located(slice(None)), step) == found


def test_a_rope_loaded_in_an_earlier_step_has_no_construction_strain():
    (late,) = named([step("C"), bedding()], "construction strain")
    assert "it had been loaded in C" in late.reason


def test_original_stiffness_is_the_chord_of_the_first_rise_end_to_end():
    (one,) = named([bedding(first_rise=rise(20, 35, 60, 80))], "original stiffness",
                   rated_break_strength=500.0)  # fmt: skip
    assert (one.value, one.over_strength) == pytest.approx((2000.0, 4.0))
    assert one.standard_uncertainty == pytest.approx(0.5 * math.sqrt(2) / 0.03)
    assert (one.low_tension, one.high_tension) == (20.0, 80.0)


def test_a_rise_that_was_held_on_its_way_says_so():
    (one,) = named([bedding(first_rise=rise(20, np.nan, 60, 80))], "original stiffness")
    assert one.value == pytest.approx(2000.0)
    assert "paused in a hold" in one.reason
    (whole,) = named([bedding(first_rise=rise(20, 40, 60, 80))], "original stiffness")
    assert whole.reason == ""


def test_original_stiffness_ends_at_the_greatest_load_of_the_rise():
    # the load falls again, and the rope creeps on: no hold, and no part of the rise
    (one,) = named([bedding(first_rise=rise(20, 35, 60, 80, 79, np.nan, 75))], "original stiffness")
    assert (one.value, one.high_tension) == (pytest.approx(60 / 0.03), 80.0)
    assert one.reason == ""


def test_original_stiffness_is_as_uncertain_as_both_ends_of_the_rise():
    whole = dataclasses.replace(
        rise(20, 50, 80), tension_random_standard_uncertainty=np.array([0.3, 9.0, 0.4])
    )
    (one,) = named([bedding(first_rise=whole)], "original stiffness")
    assert one.standard_uncertainty == pytest.approx(0.5 / 0.02)


def test_original_stiffness_falls_back_to_the_first_cycle():
    (cycle,) = named([bedding()], "original stiffness")
    assert (cycle.value, cycle.standard_uncertainty) == (1000.0, 2.0)
    assert "from the first cycle" in cycle.reason
    assert (cycle.low_tension, cycle.high_tension) == (40.0, 75.0)
    # few readings on the rise leave a piece of its curve: 10 N of the 35 N of the first cycle
    (piece,) = named([bedding(first_rise=rise(66, 76))], "original stiffness")
    assert (piece.value, piece.low_tension, piece.high_tension) == (
        cycle.value, cycle.low_tension, cycle.high_tension,
    )  # fmt: skip
    assert piece.reason == (
        "from the first cycle: the curve of the first rise covers only 10 N (too few readings)"
    )
    (none,) = named([step("C", holds=(HOLD,))], "original stiffness")
    assert "the first step has no curve of its first loading" in none.reason
    (empty,) = named([], "original stiffness")
    assert empty.reason == "there is no step"


def test_dynamic_stiffness_is_that_of_each_level():
    steps = [bedding(), step("D", level=CyclicLevel(StepNumber(800.0, 1.0), 50.0, 20.0))]
    (one,) = named(steps, "dynamic stiffness", rated_break_strength=400.0)
    assert (one.value, one.over_strength, one.step) == (800.0, 2.0, "D")
    assert (one.low_tension, one.high_tension) == (30.0, 70.0)
    (none,) = named(steps[:1], "dynamic stiffness")
    assert "other than bedding-in" in none.reason
    bare = step("D", level=CyclicLevel(UNKNOWN, 50.0, 20.0))
    (without,) = named([bare], "dynamic stiffness")
    assert without.reason == "no cycle of it has a stiffness"


def test_working_strain_is_the_rise_over_the_static_stiffness_after_bedding_in():
    steps = [bedding(), step("Q", pairs=(PAIR,))]
    (one,) = named(steps, "working strain")
    assert (one.value, one.standard_uncertainty) == pytest.approx((0.04, 0.0004))
    assert (one.low_tension, one.high_tension, one.reference_time) == (10.0, 30.0, 600.0)
    assert math.isnan(one.over_strength)
    (early,) = named(steps[::-1], "working strain")
    assert early.reason == "no step has a hold at a higher tension than the hold before it"
    (within,) = named([bedding(pairs=(PAIR,))], "working strain")
    assert math.isnan(within.value)
    (never,) = named(steps[1:], "working strain")
    assert "no bedding-in step" in never.reason
    (unknown,) = named(steps, "working strain", is_ordered=False)
    assert "not bedded in" in unknown.reason


def test_refusals_of_the_stages_before_are_handed_on():
    refused = PairOfHolds(
        StepNumber(10.0, 0.0),
        StepNumber(20.0, 0.0),
        UNKNOWN,
        math.nan,
        "the lower hold has no strain",
    )
    short = HeldTension(20.0, 90.0, UNKNOWN, "too short")
    steps = [bedding(), step("Q", pairs=(refused,), holds=(short,))]
    (static,), (polymer,) = named(steps, "static stiffness"), named(steps, "polymer strain")
    (working,) = named(steps, "working strain")
    assert static.reason == working.reason == "the lower hold has no strain"
    assert polymer.reason == "too short"
    assert all(math.isnan(one.value) and one.step == "Q" for one in (static, working, polymer))


def test_polymer_strain_counts_from_the_reference_time_to_the_end_of_the_hold():
    (one,) = named([step(holds=(HOLD,))], "polymer strain")
    assert (one.value, one.standard_uncertainty) == pytest.approx((1e-3, 1e-5))
    assert one.low_tension == one.high_tension == 20.0
    at_once = dataclasses.replace(HOLD, end_time=600.0)
    (short,) = named([step(holds=(at_once,))], "polymer strain")
    assert math.isnan(short.value)
    assert "before the reference time" in short.reason


def test_a_reference_time_is_positive():
    with pytest.raises(SettingsError, match="S: the reference time is not positive; found 0 s"):
        change_in_length([StepOfProgramme("S", 0.0)])


STRAIN = np.linspace(0.01, 0.05, 41)
CHORD = 1e5  # N


def straight_rise(of_tension=0.0, of_strain=0.0):
    """A straight first rise, and what one shared error does to its points."""
    tension = 2e3 + CHORD * (STRAIN - 0.01)
    rows = [np.broadcast_to(one(STRAIN, tension) if callable(one) else one, (1, 41)).copy()
            for one in (of_strain, of_tension)]  # fmt: skip
    return FirstRise(STRAIN, tension, np.zeros(41), 0.001, *rows)


@pytest.mark.parametrize(
    ("error", "truth"),
    [
        ({"of_tension": 10.0}, 0.0),
        ({"of_tension": lambda strain, tension: 0.01 * tension}, 0.01 * CHORD),
        ({"of_strain": 0.002}, 0.0),
        ({"of_strain": lambda strain, tension: 0.01 * strain}, -0.01 * CHORD),
    ],
    ids=["zero of 10 N", "gain of 1 %", "zero of strain", "scale of strain"],
)
def test_a_shared_error_is_at_both_ends_of_the_first_rise(error, truth):
    (one,) = named([bedding(first_rise=straight_rise(**error))], "original stiffness")
    assert one.contribution == pytest.approx([truth], abs=1e-6)
    assert one.standard_uncertainty == pytest.approx(abs(truth), abs=1e-6)


def test_a_gain_of_the_load_cell_is_in_the_rise_and_in_the_stiffness_of_a_working_strain():
    def number(value, gain):
        return StepNumber(value, 0.0, np.array([gain * value, 7.0]))

    pair = PairOfHolds(
        number(1000.0, 0.01), number(3000.0, 0.01), StepNumber(1e5, 0.0, np.array([1e3, -500.0])),
        60.0,
    )  # fmt: skip
    (one,) = named([bedding(), step("Q", pairs=(pair,))], "working strain")
    # the second error, the same at both tensions, is in the stiffness alone: 0.5 % of 0.02
    assert one.contribution == pytest.approx([0.0, 1e-4])


def test_construction_strain_takes_the_difference_of_a_shared_strain_error():
    # the tension of the valleys, 40 N, is between the first two
    rising = rise(20, 50, 65, 80)
    of_strain = np.stack([np.full(4, 0.001), 0.01 * rising.strain])
    whole = dataclasses.replace(
        rising, strain_contribution=of_strain, tension_contribution=np.full((2, 4), 9.0)
    )
    cycles = dataclasses.replace(
        CYCLES,
        permanent_strain=StepNumber(0.03, 0.002, np.array([0.0, 3e-4])),
        foot_strain_contribution=np.array([0.001, 5e-4]),
    )
    (one,) = named([bedding(bedding=cycles, first_rise=whole)], "construction strain")
    # a zero of strain leaves it as it is, a scale of 1 % is 1 % of it
    assert one.contribution == pytest.approx([0.0, 0.01 * one.value], abs=1e-12)


def test_a_share_of_the_strength_has_the_error_of_the_strength_beside_its_own():
    level = CyclicLevel(StepNumber(800.0, 1.0, np.array([8.0, 0.0]), 9.0), 50.0, 20.0)
    of_strength = np.array([0.0, 0.05])
    (one,) = named(
        [step("D", level=level, strength_contribution=of_strength)], "dynamic stiffness",
        rated_break_strength=400.0,
    )  # fmt: skip
    assert one.contribution == pytest.approx([8.0, 0.0])
    assert one.over_strength_contribution == pytest.approx([0.02, -0.1])
    assert one.degrees_of_freedom == 9.0
    assert one.over_strength_random_standard_uncertainty == pytest.approx(0.0025)


def test_polymer_strain_moves_with_its_creep():
    hold = dataclasses.replace(HOLD, creep_per_decade=StepNumber(1e-3, 0.0, np.array([2e-5])))
    (one,) = named([step(holds=(hold,))], "polymer strain")
    assert one.contribution == pytest.approx([2e-5])
