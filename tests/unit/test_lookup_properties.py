"""Reasons, and the arithmetic that is this module's own; numbers of a log are in the oracle."""

import dataclasses
import math

import numpy as np
import pytest

from reduction.cycles.product import Loops
from reduction.errors import SettingsError
from reduction.line.held import HeldPair
from reduction.line.programme import dynamic_stiffness, summarise_bedding_in
from reduction.line.static import CreepOfHold
from reduction.line.step import RopeStep
from reduction.lookup.properties import StepOfProgramme, change_in_length
from reduction.moduli.product import ModulusCurves

NAMES = (
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
)


def loops(n=4, foot=0.05):
    one = {name: np.full((1, n), 100.0) for name in Loops.__dataclass_fields__}
    zeros = np.zeros((1, n))
    one |= {
        "mean_strain": foot + 0.02 + 0.01 * np.arange(n)[None],
        "strain_amplitude": np.full((1, n), 0.02),
        "apparent_spring_constant": np.full((1, n), 1000.0),
        "valley_tension": np.full((1, n), 40.0),
        "peak_tension": np.full((1, n), 80.0),
        "uncertainty": dict.fromkeys(one, zeros + 0.001),
    }
    return Loops(**one)


def rise(tension):
    """First loading on bins of 0.01 of strain."""
    load = np.full((1, 2, len(tension)), np.nan)
    load[0, 0] = tension
    bins, none = 0.01 * (1 + np.arange(len(tension))), np.empty(0)
    rows = np.zeros_like(load)
    return ModulusCurves(
        bins, none, 0.01, *5 * (rows,), rows, rows, rows, load, rows + 0.5, none, none, none
    )


def bedding(table=None, **more):
    table = loops() if table is None else table
    step = RopeStep(
        "bedding-in",
        bedding_in=summarise_bedding_in(table, rated_break_strength=500.0),
        dynamic=dynamic_stiffness(table, last_cycles=3, rated_break_strength=500.0),
    )
    return StepOfProgramme("B", step, "R-1", 0, table, **more)


def named(steps, name, **given):
    given = {"is_new": True, "reference_time": 60.0} | given
    return [one for one in change_in_length(steps, **given) if one.name == name]


@pytest.mark.parametrize("name", NAMES)
def test_without_steps_every_property_is_absent_with_a_reason(name):
    (one,) = named([], name)
    assert math.isnan(one.value)
    assert math.isnan(one.standard_uncertainty)
    assert one.reason
    assert one.unit == ("N" if "stiffness" in name else "1")


def test_construction_strain_holds_the_first_rise():
    # foot of the first loop at 0.05, the first rise has 40 N at 0.02: 0.03 more than the cycles' 0.03
    (one,) = named([bedding(first_loading=rise([20, 40, 60, 80]))], "construction strain")
    assert one.value == pytest.approx(0.06)
    assert one.reason == ""
    assert (one.low_tension, one.high_tension) == (40.0, 80.0)
    # feet twice, valleys twice; the foot's mean and 0.5 N on 2000 N once more
    feet = 2 * (2e-6 + (1e-3 / 1000) ** 2)
    assert one.standard_uncertainty == pytest.approx(np.sqrt(feet + 1e-6 + (0.5 / 2000) ** 2))


def test_construction_strain_of_the_cycles_alone_is_told():
    (one,) = named([bedding()], "construction strain")
    assert one.value == pytest.approx(0.03)
    assert "of the cycles alone" in one.reason
    (held,) = named(
        [bedding(first_loading=rise([20, 30, np.nan, np.nan, 60, 80]))], "construction strain"
    )
    assert held.value == pytest.approx(0.03)
    assert "held there" in held.reason


def test_a_rope_that_was_loaded_before_has_no_original_stiffness_and_no_construction_strain():
    step = bedding(first_loading=rise([20, 40, 60, 80]))
    for name in ("original stiffness", "construction strain"):
        (one,) = named([step], name, is_new=False)
        assert math.isnan(one.value)
        assert "loaded before" in one.reason
    (late,) = named([dataclasses.replace(step, step=RopeStep("creep")), step],
                    "construction strain")  # fmt: skip
    assert "loaded before it was bedded in" in late.reason


def test_original_stiffness_falls_back_to_the_first_cycle():
    (rises,) = named([bedding(first_loading=rise([20, 40, 60, 80]))], "original stiffness",
                     rated_break_strength=500.0)  # fmt: skip
    assert (rises.value, rises.over_strength) == pytest.approx((2000.0, 4.0))
    assert rises.standard_uncertainty == pytest.approx(0.5 * np.sqrt(2) / 0.03)
    (cycle,) = named([bedding()], "original stiffness")
    assert cycle.value == 1000.0
    assert "in place of a first rise" in cycle.reason
    assert (cycle.low_tension, cycle.high_tension) == (40.0, 80.0)
    (none,) = named([StepOfProgramme("C", RopeStep("creep"), "R-1", 0)], "original stiffness")
    assert "the first step has no first rise" in none.reason
    (short,) = named([bedding(first_loading=rise([20, np.nan]))], "original stiffness")
    assert short.value == 1000.0
    (bare,) = named([dataclasses.replace(bedding(), loops=None)], "original stiffness")
    assert math.isnan(bare.low_tension)


def test_cycles_of_the_bedding_in_are_no_dynamic_stiffness():
    (one,) = named([bedding()], "dynamic stiffness")
    assert "settled" in one.reason
    step = RopeStep(
        "dynamic stiffness",
        dynamic=dynamic_stiffness(loops(), last_cycles=3, rated_break_strength=500.0),
    )
    (level,) = named([bedding(), StepOfProgramme("D", step, "R-1", 0)], "dynamic stiffness")
    assert (level.value, level.over_strength, level.step) == (1000.0, 2.0, "D")
    nothing = dataclasses.replace(loops(), apparent_spring_constant=np.full((1, 4), np.nan))
    step = RopeStep("d", dynamic=dynamic_stiffness(nothing, last_cycles=3, rated_break_strength=1))
    (level,) = named([StepOfProgramme("D", step, "R-1", 0)], "dynamic stiffness")
    assert level.reason == "no cycle of this level has a stiffness"


def test_refusals_of_the_stages_before_are_handed_on():
    pair = HeldPair("R-1", 1, 2, 10.0, 20.0, None, "the lower hold has no strain")
    hold = CreepOfHold("R-1", math.nan, math.nan, 20.0, 0.1, math.nan, 90.0, "too short")
    other = dataclasses.replace(hold, specimen="R-2")
    step = RopeStep("quasi-static stiffness", held=(pair,), creep=(hold, other))
    steps = [bedding(), StepOfProgramme("Q", step, "R-1", 0)]
    (static,), (polymer,) = named(steps, "static stiffness"), named(steps, "polymer strain")
    (working,) = named(steps, "working strain")
    assert static.reason == working.reason == "the lower hold has no strain"
    assert polymer.reason == "too short"
    elsewhere = [dataclasses.replace(steps[1], specimen="R-3")]
    assert "no step holds" in named(elsewhere, "static stiffness")[0].reason
    assert "no step beds" in named(steps[1:], "working strain")[0].reason


def test_holds_before_the_bedding_in_are_no_working_strain():
    pair = HeldPair("R-1", 1, 2, 10.0, 20.0, None, "held when new")
    before = StepOfProgramme("Q", RopeStep("quasi-static", held=(pair,)), "R-1", 0)
    (one,) = named([before, bedding()], "working strain")
    assert one.reason == "no step holds one tension after a lower one"


def test_a_hold_that_ends_before_the_reference_time_gives_no_polymer_strain():
    hold = CreepOfHold("R-1", 1e-3, 1e-5, 20.0, 0.1, 1e-2, 600.0)
    step = StepOfProgramme("C", RopeStep("creep", creep=(hold,)), "R-1", 0)
    (short,) = named([step], "polymer strain", reference_time=600.0)
    assert "ends before the reference time" in short.reason
    (one,) = named([step], "polymer strain")
    assert (one.value, one.standard_uncertainty) == pytest.approx((1e-3, 1e-5))


def test_a_reference_time_is_positive():
    with pytest.raises(SettingsError, match="reference time is not positive"):
        change_in_length([], is_new=True, reference_time=0.0)


def test_bedding_in_without_its_cycles_says_so():
    (one,) = named([dataclasses.replace(bedding(), loops=None)], "construction strain")
    assert "cycles of the bedding-in are not given" in one.reason
