"""Periods from flank to flank where rests part some cycles and not others."""

import numpy as np
import pytest

from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.periods import own_periods


def test_a_dwell_that_is_a_rest_behind_some_cycles_alone_is_part_of_all_periods():
    # ramps of 80 readings, dwells of 16 at both ends; a quarter of those below were found as rests
    per, n_cycles, step = 192.3, 12, 0.2
    turn = np.arange(int(per * (n_cycles + 0.2))) / per
    ramp, dwell = 80 / per, 0.5 - 80 / per
    wave = np.interp(turn % 1, [0, ramp, ramp + dwell, 2 * ramp + dwell, 1], [0, 1, 1, 0, 0])
    begin = np.ceil(per * np.arange(n_cycles)).astype(int)
    begin[1::2] -= 9  # somewhere in the dwell before it
    end = np.append(begin[1:], begin[-1] + 2 * 80 + 16)
    rests = np.array([2, 5, 6])
    begin[rests + 1] = np.ceil(per * (rests + 1))
    end[rests] = np.floor(per * (rests + 1)) - 16
    peak = np.ceil(per * (np.arange(n_cycles) + ramp + dwell / 2)).astype(int)
    cycles = Cycles(
        begin, end, np.stack([begin, peak], axis=1), np.stack([peak, end], axis=1),
        np.ones((n_cycles, 2)), *np.zeros((3, turn.size)), 0.1,
    )  # fmt: skip
    time = step * np.arange(turn.size)
    period, _ = own_periods(time, wave, cycles, time[end] - time[begin], noise=1e-6)
    assert period[:-1] == pytest.approx(np.full(n_cycles - 1, per * step), rel=1e-3)
