"""What speaks against numbers from a hold: each reason alone."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.record.settings import HoldSettings
from reduction.stages.holds.hold_selection import Hold, _Ramp
from reduction.stages.holds.relaxation_and_creep import _hold_ends, _reasons_against

TIME = np.arange(0.0, 180.0, 0.1)
RELAXING = 350 + 50 * np.exp(-TIME / 40)
RAMP = _Ramp(start_time=-5.0, end_time=0.0, centre_time=-2.5, duration=5.0, stiffness=100.0)


def hold(tension=RELAXING, *, time=TIME, position=None, ramp=RAMP, noise=0.3):
    rng = np.random.default_rng(0)
    place = 6 + 0.001 * rng.standard_normal(time.size)
    return Hold(
        time=time,
        position=place if position is None else place + position,
        tension=tension + noise * rng.standard_normal(time.size),
        strain=np.ones(time.size),
        start_time=float(time[0]),
        ramp=ramp,
        position_tolerance=0.02,
        slack_tension=3.0,
    )


REFUSED = "drop, rate per decade and Prony series not given: "


def reasons(one):
    found = _reasons_against(one, _hold_ends(one), HoldSettings())
    assert all(one.severity == "refusal" for one in found)
    return [str(one).removeprefix(REFUSED) for one in found]


def test_nothing_speaks_against_a_sound_hold():
    assert reasons(hold()) == []


def test_a_short_hold():
    short = TIME < 20
    assert reasons(hold(RELAXING[short], time=TIME[short])) == [
        "the hold is too short, 19.9 s; it needs 30 s or more"
    ]


def test_few_samples():
    rows = slice(None, None, 150)
    assert reasons(hold(RELAXING[rows], time=TIME[rows])) == ["too few samples, 12; 20 are needed"]


def test_a_slack_specimen_beside_a_taut_one():
    (reason,) = reasons(hold(np.full(TIME.size, 2.0)))
    assert reason.startswith("the specimen is slack at ")
    assert reason.endswith("more than 3 N is needed")


def test_rising_tension():
    (reason,) = reasons(hold(400 - RELAXING / 10))
    assert reason.startswith("tension rises by 1.3")


@pytest.mark.parametrize(("motion", "moves"), [(0.3, True), (0.1, False)])
def test_a_moving_crosshead_counts_by_what_is_not_known_of_its_worth(motion, moves):
    # the drop is 49 N; at 100 N/m, known to a half either way (0.29 as a standard uncertainty), a
    # tenth of the drop is what is not known of 0.17 m
    found = reasons(hold(position=motion * TIME / 180))
    assert bool(found) is moves
    if moves:
        assert found[0].startswith("the crosshead moves by 0.2")
        assert "equivalent to" in found[0]


@pytest.mark.parametrize(("motion", "moves"), [(0.015, True), (0.005, False)])
def test_without_a_ramp_half_the_tolerance_is_a_motion(motion, moves):
    assert bool(reasons(hold(position=motion * TIME / 180, ramp=None))) is moves


def test_a_slip_in_the_hold():
    (reason,) = reasons(hold(RELAXING - 6 * (TIME > 90)))
    assert reason.startswith("tension steps by -")
    assert "at 90 s into the hold" in reason
    assert "possibly a splice slip" in reason


def test_a_slip_in_a_night_is_found_on_block_means():
    time = np.arange(0.0, 40000.0, 1.0)
    series = 350 + 20 * np.exp(-time / 3000) - 3 * (time > 25000)
    (reason,) = reasons(hold(series, time=time))
    assert "steps by -3" in reason or "steps by -2.9" in reason


def test_a_gap_in_the_hold_ends_the_search_for_steps():
    kept = (TIME < 60) | (TIME > 80)
    assert reasons(hold(RELAXING[kept], time=TIME[kept])) == []


def test_many_sound_holds_raise_no_alarm():
    rng = np.random.default_rng(5)
    for _ in range(15):
        times, size = rng.uniform(1, 300, 2), rng.uniform(1, 60, 2)
        series = 300 + np.exp(-TIME[:, None] / times) @ size
        one = hold(series, noise=rng.uniform(0.1, 2))
        assert not any("steps" in reason for reason in reasons(one))


def test_the_drop_carries_the_noise_of_both_ends():
    rng = np.random.default_rng(6)
    drops = []
    for _ in range(200):
        one = hold(np.full(TIME.size, 400.0), noise=0.0)
        one.tension[:] += rng.standard_normal(TIME.size)
        drops.append(_hold_ends(one))
    found = np.array([one.drop for one in drops])
    stated = np.mean([one.drop_uncertainty for one in drops])
    assert stated == pytest.approx(found.std(), rel=0.2)


def test_the_drop_of_a_deep_relaxation_carries_the_start_by_what_is_left():
    # 400 N fall to 100 N: drop = 1 - final / initial, so the start counts little over a quarter
    rng = np.random.default_rng(7)
    level = np.linspace(400, 100, TIME.size)
    ends = []
    for _ in range(300):
        one = hold(level, noise=0.0)
        one.tension[:] += rng.standard_normal(TIME.size)
        ends.append(_hold_ends(one))
    found = np.array([one.drop for one in ends])
    stated = np.mean([one.drop_uncertainty for one in ends])
    assert stated == pytest.approx(found.std(), rel=0.15)


@pytest.mark.parametrize("relaxation_time", [1.0, 4.0, 40.0])
def test_the_initial_tension_is_that_of_the_end_of_the_ramp(relaxation_time):
    # a mean of the first 0.9 s has lost a third of a term of one second
    series = 300 + 100 * np.exp(-TIME / relaxation_time)
    ends = _hold_ends(hold(series, noise=0.3))
    assert abs(ends.initial - 400) < 3 * ends.initial_uncertainty
    # what the term loses in half a step of the log, 0.1 s, and a newton
    assert ends.initial_uncertainty < 100 * 0.05 / relaxation_time + 1


def test_the_end_of_a_slow_ramp_is_known_to_where_it_slowed_down():
    at_once = _hold_ends(hold())
    slowly = _hold_ends(hold(ramp=replace(RAMP, end_uncertainty=2.0)))
    # 50 N with a time of 40 s lose 1.25 N a second at first
    grown = np.sqrt(slowly.initial_uncertainty**2 - at_once.initial_uncertainty**2)
    assert grown == pytest.approx(2.5, rel=0.1)


def test_a_log_that_peaks_above_the_found_start_is_refused():
    # beside the end of the ramp a machine may ring: that far the tension is not known
    rung = replace(hold(), logged_peak=430.0)
    assert reasons(rung) == []
    assert _hold_ends(rung).initial_uncertainty == pytest.approx(29 / np.sqrt(3), rel=0.05)
    for peaks in ({"logged_peak": 450.0}, {"earlier_peak": 450.0}):
        (reason,) = reasons(replace(hold(), **peaks))
        assert reason.startswith("the log peaks at 450 N")


def test_a_hold_without_samples_is_refused():
    empty = Hold(*[np.empty(0)] * 4, 0.0, None, 0.01)
    with pytest.raises(DataError, match="no noise can be read"):
        _hold_ends(empty)
