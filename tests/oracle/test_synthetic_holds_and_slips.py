"""Holds and slips of a synthetic tether log against what was put into it.

The log is generated from a known law (it is synthetic); the truth is its list of slip
lengths per cycle.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.record.settings import CycleSettings, HoldSettings, PhaseSettings, SlipSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.cycles.loops import close_loops
from reduction.stages.holds.relaxation_and_creep import reduce_holds
from reduction.stages.moduli.loop_balance import cycle_tension_level
from reduction.stages.moduli.splice_slip import find_slips
from reduction.stages.standstills import find_standstills

DATA = Path(__file__).parents[2] / "raw" / "tmt-synthetic"

FOOT, POUND_FORCE = 0.3048, 4.4482216152605
SPECIMENS = ("new", "used")


def read(name):
    table = pd.read_csv(DATA / name, comment="#").to_numpy().T
    time, position, tension = table[0], table[1] * FOOT, table[2:] * POUND_FORCE
    return (
        time,
        position,
        tension,
        find_standstills(time, position, tension, settings=PhaseSettings()),
    )


def holds_of(name):
    time, position, tension, standstills = read(name)
    return reduce_holds(
        time,
        position,
        tension,
        np.stack([position, position]),
        standstills,
        specimens=SPECIMENS,
        settings=HoldSettings(),
    )


@pytest.fixture(scope="module")
def extended():
    time, position, tension, standstills = read("T-4_extended.csv")
    cycles = find_cycles(time, position, tension, standstills, settings=CycleSettings())
    # Strain does not enter; position stands in for it.
    loops = close_loops(time, tension, np.stack([position, position]), cycles)
    level, slope = cycle_tension_level(
        position,
        tension,
        cycle_number=cycles.cycle_number,
        branch=cycles.branch,
        n_cycles=cycles.n_cycles,
    )
    return loops, level, slope


@pytest.mark.parametrize("by_level", [True, False])
def test_the_slips_of_the_new_splice_are_dated_and_creep_is_not_a_slip(extended, by_level):
    loops, level, slope = extended
    slips = find_slips(
        loops.peak_tension,
        specimens=SPECIMENS,
        settings=SlipSettings(),
        tension_level=level if by_level else None,
        tension_slope=slope,
    )
    assert slips.specimen == ("new", "new")
    truth = pd.read_csv(DATA / "truth" / "T-4_extended_cycle_peaks.csv")
    let_out = np.diff(truth["slip_ft_new"].to_numpy())
    fast = let_out > 20 * np.median(let_out)
    onsets = truth["cycle"].to_numpy()[1:][fast & ~np.roll(fast, 1)]
    np.testing.assert_array_equal(onsets, [601, 1501])
    np.testing.assert_allclose(slips.slip_cycle, onsets, atol=20)
    # Developed over 20 and 10 cycles; the range holds the whole of it within a few cycles.
    np.testing.assert_allclose(slips.slip_cycle_high, [620, 1510], atol=5)
    # 0.20 and 0.25 ft were let out; a relaxed tether is softer than the slope of a cycle.
    share = slips.slip_length / FOOT / [0.20, 0.25]
    assert np.all((share > 0.4) & (share < 1))


def test_the_level_is_quieter_than_the_peak(extended):
    loops, level, _ = extended
    quiet = slice(700, 1400)
    noise = [
        np.diff(series[:, quiet], axis=1).std(axis=1) for series in (level, loops.peak_tension)
    ]
    assert np.all(noise[0] < 0.5 * noise[1])


def test_the_overnight_hold_has_no_drop_and_says_why_it_has_no_series():
    holds = holds_of("overnight_hold.csv")
    assert len(holds) == 2
    for hold in holds:
        # WHOI-2005-10, sec. 4.1: "no apparent change in tension over the day long hold".
        assert abs(hold.relaxation_drop) < 3 * hold.relaxation_drop_standard_uncertainty
        assert hold.relaxation_drop_standard_uncertainty < 0.005
        assert hold.prony_tension.size == 0
        assert any(
            "less than three times its standard" in reason for reason in map(str, hold.refusals)
        )


def test_the_set_up_holds_of_t_6_relax_and_no_slip_is_seen_in_them():
    holds = [hold for hold in holds_of("T-6.csv") if hold.hold_duration > 30]
    # Minimum, centre and maximum, 1 min, 1 min and 3 min, both tethers.
    assert [round(hold.hold_duration, -1) for hold in holds] == [60, 60, 60, 60, 180, 180]
    for hold in holds:
        assert hold.relaxation_drop > 20 * hold.relaxation_drop_standard_uncertainty
        assert not any("steps" in reason for reason in map(str, hold.refusals))
    longest = [hold for hold in holds if hold.hold_duration > 100]
    assert all(hold.rate_per_decade > 0.05 for hold in longest)


def test_the_short_hold_after_unloading_is_refused_as_a_recovery():
    last = [hold for hold in holds_of("T-6.csv") if hold.hold_duration < 30]
    assert len(last) == 2
    for hold in last:
        assert np.isnan([hold.relaxation_drop, hold.rate_per_decade]).all()
        assert any("tension rises" in reason for reason in map(str, hold.refusals))
        assert any("too short" in reason for reason in map(str, hold.refusals))
