"""What a test says of a tension that was logged late, and that it corrects nothing."""

import numpy as np
import pytest

from reduction.archive.test_variables import lag_values
from reduction.record.measurement import Record
from reduction.stages.cycles.cycle_product import Cycles
from reduction.uncertainty.shared_contributions import lag_of_test

TIME = np.arange(0, 118, 0.1)
TURNS = np.arange(50, 1151, 50)


def ramps(time):
    return 1 - 2 * np.abs(np.mod(time / 10, 1) - 0.5)


def lag_of(lag, **stated):
    position = ramps(TIME)
    tension = np.stack([500 * ramps(TIME - one) for one in lag])
    noise = np.random.default_rng(4).normal(0, 0.3, tension.shape)
    record = Record(
        "T", ("new", "used")[: len(lag)], TIME, position, tension + noise,
        np.zeros(tension.shape, np.uint16), np.zeros(TIME.size, np.uint16), n_rows_read=TIME.size,
    )  # fmt: skip
    first = TURNS[:-2:2]
    halves = np.column_stack([first, first + 50]), np.column_stack([first + 50, first + 100])
    cycles = Cycles(
        first, first + 100, *halves, np.ones((first.size, 2)),
        np.zeros(TIME.size, np.int32), np.zeros(TIME.size, np.int8),
        np.zeros(TIME.size, bool), 0.01,
    )  # fmt: skip
    return lag_of_test(record, position, tension + noise, cycles, **stated)


def test_a_tension_that_is_late_is_noted_for_its_own_channel():
    estimate, notes = lag_of([0.02, 0.0])
    assert estimate.lag == pytest.approx([0.02, 0.0], abs=0.002)
    assert len(notes) == 1
    assert str(notes[0]).startswith("new: tension reverses 20 +- ")
    assert "no lag is stated" in str(notes[0]) and "no correction is made" in str(notes[0])


def test_a_lag_within_what_is_stated_is_no_news():
    _, notes = lag_of([0.02], stated=[0.015])
    assert notes == []
    _, notes = lag_of([0.05], stated=[0.015])
    assert "a lag of 0 +- 15 ms is stated" in str(notes[0])


def test_the_archive_has_the_estimate_and_why_there_is_none():
    estimate, _ = lag_of([0.02, -0.02])
    values = lag_values(estimate)
    assert values["channel_lag_refusal"].tolist() == [0, 4]
    assert np.isnan(values["channel_lag"][1])
