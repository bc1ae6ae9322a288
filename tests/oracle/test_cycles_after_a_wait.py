"""A wait before or after cycling, too short for a standstill, is no part of a cycle.

The logs are synthetic: a standard linear solid on a path whose times are the truth.
"""

from functools import partial

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.record.settings import CycleSettings
from reduction.stages.cycles.loops import close_loops

HALF, N_CYCLES, LOW, HIGH = 5.0, 12, 4.0, 5.0
SPRING, DASHPOT_SPRING, RELAXATION = 100.0, 40.0, 0.1
WAITS = [0.0, 0.5, 1.0, 1.9, 2.5, 2.9]
NOISES = [0.0, 0.002 * (HIGH - LOW)]


def log(*, before=0.0, after=0.0, hold=0.0, comes="down", rate=20.0, noise=0.0):
    """Synthetic: time, position as logged, tension, and when the first cycle begins."""
    knots = [(0, 3), (20, 3), (35, HIGH), (45, HIGH), (50, LOW)]
    if comes == "up":
        knots = [(0, 3), (20, 3), (25, LOW)]
    start = knots[-1][0] + before
    knots += [(start, LOW)] * (before > 0)
    for _ in range(N_CYCLES):
        for level in (HIGH, LOW):
            knots.append((knots[-1][0] + HALF, level))
            knots += [(knots[-1][0] + hold, level)] * (hold > 0 and level == LOW)
    end = knots[-1][0] + after
    knots += [(end, LOW)] * (after > 0)
    knots += [(end + 5, 4.5), (end + 10, 3), (end + 70, 3)]
    time = np.arange(0, end + 70, 1 / rate)
    path = np.interp(time, *np.transpose(knots))
    lag = np.zeros_like(path)
    decay = np.exp(-1 / (rate * RELAXATION))
    for place, speed in enumerate(np.diff(path) * rate, start=1):
        lag[place] = decay * lag[place - 1] + DASHPOT_SPRING * speed * RELAXATION * (1 - decay)
    draw = partial(np.random.default_rng(7).normal, 0.0)
    position = path + draw(noise, path.size) if noise else path
    return time, position, SPRING * (path - 3) + lag, start


def cycles_of(time, position, tension, **settings):
    cycles = cycles_of_log(time, position, tension, settings=CycleSettings(**settings))
    assert cycles.n_cycles == N_CYCLES
    return cycles


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("wait", WAITS)
@pytest.mark.parametrize("comes", ["down", "up"])
def test_the_first_cycle_begins_where_the_movement_does(wait, comes, noise):
    time, position, tension, start = log(before=wait, comes=comes, noise=noise)
    cycles = cycles_of(time, position, tension)
    at_turn = 0.15 if noise else 0.051  # the noise spans 0.024 m, and the stroke goes at 0.2 m/s
    assert time[cycles.first[0]] == pytest.approx(start, abs=at_turn)
    assert time[cycles.last[0]] - time[cycles.first[0]] == pytest.approx(2 * HALF, abs=2 * at_turn)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("wait", WAITS)
def test_the_last_cycle_ends_where_the_movement_does(wait, noise):
    time, position, tension, start = log(after=wait, noise=noise)
    cycles = cycles_of(time, position, tension)
    at_turn = 0.15 if noise else 0.051
    assert time[cycles.last[-1]] == pytest.approx(start + 2 * HALF * N_CYCLES, abs=at_turn)


@pytest.mark.parametrize("wait", WAITS)
def test_the_loop_of_the_first_cycle_is_that_of_the_law(wait):
    time, position, tension, _ = log(before=wait)
    cycles = cycles_of(time, position, tension)
    strain = (position - 3) / 3
    loops = close_loops(time, tension[None], strain[None], cycles)
    # steady cycles of the law: q = A - (A + q_turn) exp(-t / tau) on the rise, A = K_1 rate tau
    rate = (HIGH - LOW) / HALF
    level = DASHPOT_SPRING * rate * RELAXATION
    turn = level * np.tanh(HALF / (2 * RELAXATION))
    area = 2 * rate * (level * HALF - (level + turn) * RELAXATION * -np.expm1(-HALF / RELAXATION))
    assert loops.hysteresis_energy[0, 0] == pytest.approx(area / 3, rel=0.02)
    assert loops.frequency[0, 0] == pytest.approx(1 / (2 * HALF), rel=0.01)
    assert loops.mean_tension[0, 0] == pytest.approx(SPRING * 1.5, rel=0.01)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("wait", [0.0, 1.5, 1.9, 2.9])
@pytest.mark.parametrize("share", [0.3, 0.5, 0.7])
@pytest.mark.parametrize("slack", [3.0, 3.98])
def test_a_rise_that_waits_on_its_way_from_slack_begins_no_cycle(wait, share, slack, noise):
    level = LOW + share * (HIGH - LOW)
    knots = [(0, slack), (20, slack), (20 + 5 * (level - slack), level)]
    knots += [(knots[-1][0] + wait, level)] * (wait > 0)
    start = knots[-1][0] + HALF * (1 - share)  # the first peak
    knots += [(start + HALF * place, (HIGH, LOW)[place % 2]) for place in range(2 * N_CYCLES + 2)]
    end = knots[-1][0] + HALF * (LOW - slack)
    knots += [(end, slack), (end + 60, slack)]
    time = np.arange(0, knots[-1][0], 0.05)
    position = np.interp(time, *np.transpose(knots))
    position += noise * np.random.default_rng(7).normal(size=time.size)
    tension = SPRING * (position - slack)
    cycles = cycles_of_log(time, position, tension)
    assert cycles.n_cycles == N_CYCLES + (wait == 0)
    period = time[cycles.last] - time[cycles.first]
    np.testing.assert_allclose(period, 2 * HALF, atol=0.3)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("hold", [1.0, 2.5])
def test_a_hold_that_every_valley_has_stays_in_the_period(hold, noise):
    time, position, tension, start = log(before=hold, hold=hold, noise=noise)
    cycles = cycles_of(time, position, tension)
    period = time[cycles.last] - time[cycles.first]
    assert period.mean() == pytest.approx(2 * HALF + hold, abs=0.3)
    at_valley = start + (2 * HALF + hold) * np.arange(N_CYCLES)
    begins = at_valley - time[cycles.first]
    assert (begins >= -0.15).all() and (begins <= hold + 0.15).all()


@pytest.mark.parametrize("wait", WAITS)
def test_a_sine_begins_where_it_leaves_the_valley(wait):
    time, position, tension, start = log(before=wait)
    on = (time >= start) & (time <= start + 2 * HALF * N_CYCLES)
    position[on] = 4.5 - 0.5 * np.cos(np.pi * (time[on] - start) / HALF)
    tension = SPRING * (position - 3)
    cycles = cycles_of_log(time, position, tension, settings=CycleSettings(waveform="sinusoidal"))
    assert time[cycles.first[0]] == pytest.approx(start, abs=0.11)
    assert time[cycles.last] - time[cycles.first] == pytest.approx(2 * HALF, abs=0.11)
