"""Cycles of the synthetic logs against the times they were generated with."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.quantities.flags import PHASE_VALUES
from reduction.record.errors import DataError
from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles, label_phases
from reduction.stages.standstills import find_standstills

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
FOOT, POUND = 0.3048, 4.4482216152605
TESTS = [f"T-{i}" for i in range(1, 7)]


def locate(name, **settings):
    log = pd.read_csv(RAW / f"{name}.csv", comment="#").to_numpy().T
    time, position, tension = log[0], FOOT * log[1], POUND * log[2:]
    stand = find_standstills(time, position, tension, settings=PhaseSettings())
    cycles = find_cycles(time, position, tension, stand, settings=CycleSettings(**settings))
    return time, stand, cycles


@pytest.mark.parametrize("control", ["position", "load"])
@pytest.mark.parametrize("name", TESTS)
def test_ten_cycles_begin_and_end_where_they_were_generated(name, control):
    time, _, cycles = locate(name, control=control)
    truth = pd.read_csv(RAW / "truth" / f"{name}_cycles.csv")
    turn = 0.1 if control == "position" else 0.3  # tension turns flatter at the valley
    assert cycles.n_cycles == 10
    assert time[cycles.first[0]] == pytest.approx(truth["time_s"].iloc[0], abs=turn + 0.05)
    assert time[cycles.last[-1]] == pytest.approx(truth["time_s"].iloc[-1], abs=turn + 0.05)
    path, seconds = truth["crosshead_ft"].to_numpy(), truth["time_s"].to_numpy()
    steps = np.sign(np.diff(path))
    turns = seconds[1:-1][(steps[1:] != steps[:-1]) & (steps[1:] < 0)]
    peaks = time[cycles.branch_last[:, 0]]
    assert np.abs(peaks - turns[:: max(turns.size // 10, 1)][:10]).max() <= 0.16


@pytest.mark.parametrize("name", TESTS)
def test_holds_last_as_generated(name):
    _, stand, _ = locate(name)
    hold = ~stand.is_rest
    duration = (stand.end_time - stand.start_time)[hold]
    assert duration == pytest.approx([60, 60, 180, 10], abs=0.45)
    assert stand.is_rest.tolist() == [True, False, False, False, False, True]


@pytest.mark.parametrize("name", TESTS)
def test_plateau_rate_is_that_of_the_path(name):
    _, _, cycles = locate(name)
    path = pd.read_csv(RAW / "truth" / f"{name}_cycles.csv")
    speed = FOOT * np.abs(np.diff(path["crosshead_ft"]) / np.diff(path["time_s"]))
    assert cycles.plateau_rate == pytest.approx(np.median(speed), rel=0.02)
    n_samples = np.sum(speed > 0.97 * np.median(speed)) + 20  # one more than steps, each branch
    assert cycles.is_in_trimmed_branch.sum() == pytest.approx(n_samples, rel=0.05)


@pytest.mark.parametrize(
    ("name", "n_cycles"),
    [("T-4_extended", 3000), ("T-4_extended_start_5Hz", 20), ("T-4_extended_end_5Hz", 20)],
)
def test_the_long_test_and_its_bursts_are_counted(name, n_cycles):
    time, stand, cycles = locate(name, expected_cycles=n_cycles)
    assert cycles.n_cycles == n_cycles
    assert not any("planned" in note for note in map(str, cycles.notes))
    period = np.diff(time[cycles.branch_last[:, 0]])
    assert period == pytest.approx(20, abs=1.01)
    phase = label_phases(time, standstills=stand, cycles=cycles)
    assert (phase == PHASE_VALUES["cycling"]).sum() == pytest.approx(
        n_cycles * 20 / np.median(np.diff(time)), rel=0.005
    )


def test_an_overnight_hold_has_no_cycles():
    with pytest.raises(DataError, match="no cycle: crosshead position does not reverse"):
        locate("overnight_hold")
