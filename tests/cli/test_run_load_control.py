"""Tests under load control, end to end: creep at constant tension, and cycles of tension."""

import numpy as np
import pytest
from csvrows import csv_rows
from scipy.signal import lfilter

pytestmark = pytest.mark.slow

CAMPAIGN = """
[campaign]
id = "load-control"
title = "Load control"
synthetic = true
[specimens.cord]
kind = "elastomer"
diameter = ["20 mm"]
gauge_length = "1 m"
[layouts.logger]
format = "delimited"
delimiter = ","
[layouts.logger.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "m", datum = "pin-to-pin" }
tension.1 = { column = "F", unit = "N" }
[tests.held]
layout = "logger"
specimens = ["cord"]
file = "held.csv"
"""
STIFFNESS = 1000.0  # N per unit strain, one tenth of a second after a step of tension
RATE = 0.05  # of that strain, per decade


def creep_strain(time, start, ramp, load):
    """Superposition over a ramp of constant rate, from 400 steps of it."""
    begins = start + ramp * (np.arange(400) + 0.5) / 400
    strain = np.zeros(time.size)
    for begin in begins:
        since = time - begin
        grown = 1 + RATE * np.log10(1 + np.clip(since, 0, None) / 0.1)
        strain += np.where(since > 0, grown, 0) * load / STIFFNESS / begins.size
    return strain


def run(command, folder, time, position, tension, *lines, interpolated=False):
    noise = np.random.default_rng(7)
    columns = [
        time,
        position if interpolated else position + noise.normal(0, 0.0002, time.size),
        tension + noise.normal(0, 0.3, time.size),
    ]
    np.savetxt(
        folder / "held.csv", np.column_stack(columns), delimiter=",", header="t,x,F", comments="",
        fmt="%.6g",
    )  # fmt: skip
    (folder / "campaign.toml").write_text("\n".join([CAMPAIGN, *lines]), encoding="utf-8")
    done = command(
        "run", folder / "campaign.toml", "--processed", folder / "processed",
        "--reports", folder / "reports",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder / "processed" / "load-control" / "tables"


@pytest.fixture(scope="module")
def creep():
    """Slack for 20 s, 300 N within 20 s, kept for 30 min, and back."""
    time = np.arange(0, 2000, 0.5)
    tension = np.interp(time, [0, 20, 40, 1840, 1860], [0, 0, 300, 300, 0])
    strain = creep_strain(time, 20, 20, 300.0)
    return time, 1 + np.where(time < 1840, strain, strain * tension / 300), tension


def test_creep_at_constant_tension_has_its_rate(command, tmp_path, creep):
    lines = ['kind = "creep"', 'control = "load"']
    tables = run(command, tmp_path, *creep, *lines)
    assert not [
        row for row in csv_rows(tables / "notes.csv") if row["note_code"] == "hold-of-position"
    ]
    (hold,) = csv_rows(tables / "relaxation.csv")
    assert hold["hold_kind"] == "creep"
    assert float(hold["hold_start_time [s]"]) == pytest.approx(40, abs=0.5)
    assert float(hold["hold_duration [s]"]) == pytest.approx(1800, abs=1)
    assert float(hold["hold_initial_tension [N]"]) == pytest.approx(300, abs=0.2)
    rate = float(hold["creep_rate_per_decade [1]"])
    spread = float(hold["creep_rate_per_decade_standard_uncertainty [1]"])
    truth = RATE * 300 / STIFFNESS
    assert rate == pytest.approx(truth, abs=2 * spread)
    assert spread < 0.01 * truth
    assert hold["relaxation_rate_per_decade [1]"] == hold["hold_refusal"] == ""
    at = {
        row["hold_time [s]"]: float(row["strain_at_time [1]"])
        for row in csv_rows(tables / "relaxation_times.csv")
        if row["strain_at_time [1]"]
    }
    # one hour is not reached
    assert set(at) == {"1.0", "10.0", "60.0", "180.0", "600.0"}
    assert at["600.0"] - at["60.0"] == pytest.approx(
        float(np.diff(creep_strain(np.array([100.0, 640.0]), 20, 20, 300.0))[0]), rel=0.01
    )


def test_a_relaxation_test_stated_as_creep_is_a_check(command, tmp_path):
    # the load of the "hold" is what is left after most of the relaxation
    time = np.arange(0, 2000, 0.5)
    strain = np.interp(time, [0, 20, 24], [0, 0, 0.3])
    tension = np.interp(time, [20, 24], [0, 1]) * (300 + 200 * np.exp(-(time - 24) / 100))
    run(command, tmp_path, time, 1 + strain, tension, 'kind = "creep"')
    (row,) = csv_rows(tmp_path / "processed/load-control/status.csv")
    assert row["status"] == "check"
    assert "the machine held the position" in row["message"]
    assert 'kind = "relaxation"' in row["message"]


@pytest.mark.parametrize("n_cycles", [0, 10])
def test_a_hold_of_a_noisy_load_is_not_one_of_the_position(command, tmp_path, n_cycles):
    """A rope that creeps, at 800 N and in cycles up to 3,200 N, with noise of 15 N in the load."""
    step = 0.05
    time = np.arange(0, 300, step)
    turn = np.clip(time - 60, 0, 20 * n_cycles) / 20
    load = np.interp(time, [0, 10, 20], [0, 0, 800]) + 1200 * (1 - np.cos(2 * np.pi * turn))
    kept = np.exp(-step / 3)
    strain = load / 2e4 + lfilter([1 - kept], [1, -kept], load) / 4e4
    load += np.random.default_rng(7).normal(0, 15, time.size)
    kind = ('kind = "cyclic"', 'waveform = "sinusoidal"') if n_cycles else ('kind = "creep"',)
    tables = run(command, tmp_path, time, 1 + strain, load, 'control = "load"', *kind)
    # the load was within its tolerance before the crosshead was where it stood later
    assert not [
        row for row in csv_rows(tables / "notes.csv") if row["note_code"] == "hold-of-position"
    ]


def sine(time):
    """Slack for 20 s, then a sine without a stop."""
    return np.where(time > 20, 150 * (1 - np.cos(2 * np.pi * (time - 20) / 40)), 0)


def test_a_creep_test_without_a_hold_says_so(command, tmp_path, creep):
    time, tension = creep[0], sine(creep[0])
    tables = run(command, tmp_path, time, 1 + tension / STIFFNESS, tension, 'kind = "creep"')
    assert not (tables / "relaxation.csv").exists()
    refusals = [
        row["note"] for row in csv_rows(tables / "notes.csv") if row["note_code"] == "no-hold"
    ]
    assert len(refusals) == 1
    assert "the tension never stays within" in refusals[0]
    assert "phases.tension_tolerance" in refusals[0]


def test_a_relaxation_test_without_a_hold_says_so(command, tmp_path, creep):
    time, tension = creep[0], sine(creep[0])
    tables = run(command, tmp_path, time, 1 + tension / STIFFNESS, tension, 'kind = "relaxation"')
    refusals = [
        row["note"] for row in csv_rows(tables / "notes.csv") if row["note_code"] == "no-hold"
    ]
    assert len(refusals) == 1
    assert "the crosshead never stays within" in refusals[0]


def test_cycles_of_tension_keep_their_holds_of_tension(command, tmp_path):
    """Ten cycles between 100 and 300 N, a creep hold of two minutes, ten more."""
    turns = [100, *[300, 100] * 10]
    knots = [(0, 0), (20, 0), *((30 + 10 * i, load) for i, load in enumerate(turns))]
    knots += [(240, 200), (360, 200), *((370 + 10 * i, load) for i, load in enumerate(turns))]
    knots += [(580, 0), (600, 0)]
    time = np.arange(0, 600, 0.1)
    tension = np.interp(time, *np.array(knots, dtype=float).T)
    held = np.where(time > 240, 0.01 * np.log10(1 + np.clip(time - 240, 0, 120)), 0)
    position = 1 + tension / STIFFNESS + held * (tension > 0)
    tables = run(command, tmp_path, time, position, tension, 'control = "load"', "n_cycles = 20")
    assert len(csv_rows(tables / "cycles.csv")) == 20
    (hold,) = csv_rows(tables / "relaxation.csv")
    assert hold["hold_kind"] == "creep"
    assert float(hold["hold_start_time [s]"]) == pytest.approx(240, abs=0.5)
    assert float(hold["hold_duration [s]"]) == pytest.approx(120, abs=1)


def test_a_position_that_a_logger_interpolated_has_its_zero_at_the_first_rest(command, tmp_path):
    """Synthetic: read every 0.6 s with a noise of 0.2 mm, written every 0.1 s."""
    time = np.arange(0, 140, 0.1)
    place = 1 + 0.4 * np.abs((np.clip(time - 10, 0, 120) / 20 + 0.5) % 1 - 0.5)
    read = place[::6] + np.random.default_rng(2).normal(0, 2e-4, place[::6].size)
    logged = np.interp(time, time[::6], read)
    tables = run(command, tmp_path, time, logged, 1000 * (place - 1), interpolated=True)
    (row,) = csv_rows(tables / "amplitude.csv")
    assert float(row["test_mean_strain [1]"]) == pytest.approx(0.1, abs=0.004)
