"""Holds at constant tension: the crosshead creeps in them and is no guide to where they are."""

import numpy as np
import pytest

from reduction.record.settings import PhaseSettings
from reduction.stages.standstills import find_standstills, find_tension_stands

LOAD = [(0, 0), (20, 0), (40, 300), (640, 300), (650, 500), (950, 500), (960, 0), (1000, 0)]
START, END = [0, 40, 650, 960], [20, 640, 950, 1000]


def creep(points=LOAD, *, rate=5.0, noise=0.3, wander=0.0):
    """Tension as told, position that creeps 4 cm a decade under it."""
    knots = np.array(points, dtype=float)
    time = np.arange(0, knots[-1, 0] + 0.5 / rate, 1 / rate)
    load = np.interp(time, *knots.T)
    creeping = np.where(load > 0, 0.04 * np.log10(1 + np.clip(time - 40, 0, None)), 0)
    random = np.random.default_rng(1)
    position = 3 + load / 300 + creeping + wander * (load == 0) * time
    position += random.normal(0, 0.0005, time.size)
    return time, position, load + random.normal(0, noise, time.size)


def find(time, position, *tension, **settings):
    return find_tension_stands(time, position, tension, settings=PhaseSettings(**settings))


def test_holds_of_a_creeping_specimen_are_where_its_tension_stands():
    time, position, tension = creep()
    found = find(time, position, tension)
    # the crosshead needs 0.2 s, the load 0.3 s to leave the noise
    assert found.start_time == pytest.approx(START, abs=0.5)
    assert found.end_time == pytest.approx(END, abs=0.5)
    assert found.is_rest.tolist() == [True, False, False, True]
    assert found.mean_tension[0] == pytest.approx([0, 300, 500, 0], abs=0.2)
    assert found.tension_tolerance == pytest.approx(12 * 0.3, rel=0.1)
    by_position = find_standstills(time, position, [tension], settings=PhaseSettings())
    assert by_position.tension_tolerance is None
    assert not np.any(np.abs(by_position.start_time - 40) < 1)


def test_the_mean_of_the_specimens_is_what_stands_still():
    time, position, tension = creep(noise=0.1)
    # one sheds to the other what it loses, as two on one crosshead under load control do
    shift = 30 * np.clip((time - 40) / 600, 0, 1) * (tension > 10)
    found = find(time, position, tension + shift, tension - shift)
    assert found.end_time[1] == pytest.approx(640, abs=0.5)
    assert found.mean_tension[:, 1] == pytest.approx([315, 285], abs=0.5)


def test_a_crosshead_that_wanders_under_a_slack_specimen_is_not_at_rest():
    found = find(*creep(wander=0.01))
    assert not found.is_rest.any()
    assert found.start_time == pytest.approx(START[1:3], abs=0.5)


def test_a_stated_tolerance_holds_what_a_hunting_controller_breaks():
    time, position, tension = creep(noise=0.05)
    hunting = tension + 4 * np.sin(2 * np.pi * time / 9) * (tension > 10)
    assert find(time, position, hunting).is_rest.all()
    found = find(time, position, hunting, tension_tolerance=12.0)
    assert found.tension_tolerance == 12.0
    assert found.start_time[1:3] == pytest.approx(START[1:3], abs=0.5)


def test_missing_tension_does_not_end_a_hold():
    time, position, tension = creep()
    tension[(time > 200) & (time < 230)] = np.nan
    assert find(time, position, tension).end_time == pytest.approx(END, abs=0.5)


def test_a_rest_that_meets_a_hold_ends_before_it():
    time = np.arange(0, 60, 0.1)
    # stands for a minute while the load goes from just below the slack tension to just above
    load = np.where(time < 30, 4.0, 6.0)
    found = find(time, np.ones(time.size), load, slack_tension=5.0)
    assert found.is_rest.tolist() == [True, False]
    assert found.last[0] == found.first[1] - 1


def test_holds_of_a_valve_that_dithers_faster_than_the_log_are_all_found():
    """Six steps of 120 N of 480 N, held for 600 s; a dither of 2.4 N is read near every half turn.

    Its differences are those of noise of 32 N from end to end in twelve deviations, a quarter of a
    step, though it spans 4.8 N.
    """
    levels = [120, 240, 360, 240, 360, 480, 0]
    knots, now = [(0.0, 0.0), (10.0, 0.0)], 10.0
    for level in levels:
        knots += [(now + 20, level), (now + 620, level)]
        now += 620
    time = np.arange(0, now, 0.5)
    tension = np.interp(time, *np.array(knots).T)
    position = 3 + tension / 300 + 0.002 * np.log1p(time)
    tension += (tension > 0) * 2.4 * np.sin(2.2 * time / 0.5)
    tension += np.random.default_rng(6).normal(0, 0.25, time.size)
    found = find(time, position, tension)
    held = ~found.is_rest
    assert found.mean_tension[0, held] == pytest.approx(levels[:-1], abs=1)
    assert found.start_time[held] == pytest.approx(30 + 620 * np.arange(6), abs=3)
    assert found.tension_tolerance < 20
