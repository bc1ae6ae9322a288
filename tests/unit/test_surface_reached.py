"""Runs that are not where the plan has them."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.run_sheet import levels_off_plan
from reduction.record.errors import DataError

PLAN = box_behnken(3).coded
NAMES = [f"R{number}" for number in range(1, 16)]
FACTORS = ["f", "T", "a"]


def off(coded, beyond=0.3):
    return levels_off_plan(coded, PLAN, beyond=beyond, run_names=NAMES, factor_names=FACTORS)


def test_two_runs_swapped_are_named_by_id_and_factor():
    swapped = np.arange(15)
    swapped[[0, 3]] = swapped[[3, 0]]
    words = off(PLAN[swapped])
    # the first four runs of a Box-Behnken design are the corners of the first two factors
    assert {word.split()[0] for word in words} == {"R1", "R4"}
    assert words[0] == "R1 f +1.00, planned -1.00" and len(words) == 4


def test_scatter_within_the_tolerance_and_missing_runs_are_silent():
    near = PLAN + np.random.default_rng(1).uniform(-0.29, 0.29, PLAN.shape)
    near[5] = np.nan
    assert off(near) == ()
    assert len(off(near, beyond=0.0)) == 42


def test_the_farthest_stands_first():
    away = PLAN.copy()
    away[2, 1] += 0.4
    away[7, 0] -= 0.9
    assert [word.split()[:2] for word in off(away)] == [["R8", "f"], ["R3", "T"]]


def test_levels_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        off(PLAN[:14])
