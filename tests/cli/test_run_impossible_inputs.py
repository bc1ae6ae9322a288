"""Inputs that cannot be: the first line that a person reads says which, in `check` as in `run`."""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commandruns import ROOT
from smallcampaign import CAMPAIGN, write_logs

from reduction.archive.open import open_archive

pytestmark = pytest.mark.slow

TESTS = """strain = { marks = "marks.csv" }
[tests.A]
file = "A.csv"
[tests.B]
file = "B.csv"
"""
POUND = 4.4482216152605

CORD = """
[campaign]
id = "cord"
title = "A cord (synthetic)"
synthetic = true
[specimens.cord]
kind = "rope"
diameter = ["10 mm"]
SPECIMEN
[layouts.logger]
format = "delimited"
[layouts.logger.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "m", datum = "displacement"KEYS }
tension.1 = { column = "F", unit = "N" }
[tests.A]
file = "A.csv"
layout = "logger"
specimens = ["cord"]
"""


@pytest.fixture
def tethers(tmp_path):
    """Two synthetic tests, with a way to write every row of their logs anew."""
    folder = tmp_path / "small"
    write_logs(folder)
    (folder / "campaign.toml").write_text(CAMPAIGN + TESTS)

    def rewrite(change):
        for name in ("A.csv", "B.csv"):
            lines = (folder / name).read_text().splitlines()
            text = [
                ",".join(f"{one:.4f}" for one in change(*map(float, line.split(","))))
                if line[0].isdigit()
                else line
                for line in lines
            ]
            (folder / name).write_text("\n".join(text) + "\n")

    return folder, rewrite


def both(command, folder):
    """First line of each test by `check` and by `run`, and the status of each command."""
    said = {}
    for name in ("check", "run"):
        done = command(name, folder / "campaign.toml", "--json", cwd=folder)
        answer = json.loads(done.stdout)
        said[name] = done.returncode, {one["id"]: one["message"] for one in answer["tests"]}
    return said


def test_tape_readings_in_another_unit_are_refused_with_the_unit_that_fits(tethers, command):
    folder, _ = tethers
    lines = (folder / "marks.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines[1:]]
    inches = [[*row[:4], *(f"{12 * float(one):.1f}" for one in row[4:])] for row in rows]
    # the header still says feet
    (folder / "marks.csv").write_text("\n".join([lines[0], *map(",".join, inches)]) + "\n")
    for status, tests in both(command, folder).values():
        assert status == 4
        # 19.37 ft, where the crosshead stood, typed as 232.4 under far_thimble_ft: 70.84 m
        assert tests["A"].endswith(
            "All 3 stretched marks of the test fit if their unit is in: is the header far_thimble_in? (Or the "
            "log's crosshead_position, stated 12 times too small.)"
        )
        assert "marks.csv:3 [far_thimble_ft]" in tests["A"]
        assert (
            "found far_thimble 70.84 m (232.4 ft) by the tape, the crosshead at 5.90" in tests["A"]
        )
        assert "far_thimble_in" in tests["B"]
    assert not list(folder.glob("processed/small/*.nc"))


def test_a_test_without_marks_of_its_own_does_not_use_marks_that_are_refused(tethers, command):
    folder, _ = tethers
    text = (folder / "marks.csv").read_text().replace("_ft", "_m")
    (folder / "marks.csv").write_text("".join(
        line for line in text.splitlines(keepends=True) if not line.startswith("B,")
    ))  # fmt: skip
    for status, tests in both(command, folder).values():
        assert status == 4
        assert all("is the header far_thimble_ft?" in one for one in tests.values())


def test_a_wrong_zero_of_the_load_cell_is_told_from_a_wrong_sign(tethers, command):
    folder, rewrite = tethers
    rewrite(lambda time, place, new, used: (time, place, new - 14.4 / POUND, used))
    for status, tests in both(command, folder).values():
        assert status == 0
        # -14.4 N in the unit of the channel
        for message in tests.values():
            assert 'its zero is wrong, not its sign. Set zero = "-3.2' in message
            assert "new: the load cell reads -14.4" in message
            assert "sign = -1" not in message


def test_a_zero_above_a_tenth_of_the_peak_is_told_by_the_length_that_the_tape_read(
    tethers, command
):
    folder, rewrite = tethers
    rewrite(lambda time, place, new, used: (time, place, new + 25, used))
    done = command("check", folder / "campaign.toml", "--json", cwd=folder)
    messages = {one["id"]: one["message"] for one in json.loads(done.stdout)["tests"]}
    assert 'its zero is wrong, or the specimen pulls there. Set zero = "24.9' in messages["A"]


def test_the_zero_that_is_named_puts_it_right(tethers, command):
    folder, rewrite = tethers
    rewrite(lambda time, place, new, used: (time, place, new - 14.4 / POUND, used))
    whole = (folder / "campaign.toml").read_text()
    mended = whole.replace(
        '"load_new_lb", unit = "lbf"', '"load_new_lb", unit = "lbf", zero = "-3.24 lbf"'
    )
    (folder / "campaign.toml").write_text(mended)
    done = command("check", folder / "campaign.toml", cwd=folder)
    assert "zero" not in done.stdout and "A: load at slack rests: new " in done.stdout


@pytest.mark.parametrize("off", [-5.0, 5.0])
def test_a_small_zero_that_a_rest_shows_is_in_the_interval_of_tensions(tmp_path, command, off):
    write_cord(tmp_path, first=0.0, keys=', reference_length = "1 m"', rest=True)
    head, *lines = (tmp_path / "A.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines]
    moved = [f"{t},{x},{float(f) + off:.2f}" for t, x, f in rows]  # 0.4 % of the peak load
    (tmp_path / "A.csv").write_text("\n".join([head, *moved]) + "\n")
    command("run", tmp_path / "campaign.toml", cwd=tmp_path)
    with open_archive(tmp_path / "processed" / "cord" / "A.nc") as archive:
        mean, spread, of_amplitude = (
            float(archive[f"test_{name}"].item())
            for name in (
                "mean_tension", "mean_tension_standard_uncertainty",
                "tension_amplitude_standard_uncertainty",
            )
        )  # fmt: skip
        notes = archive["note"].to_numpy().tolist()
    assert mean == pytest.approx(700 + off, abs=0.5)
    assert spread == pytest.approx(abs(off) / 3**0.5, rel=0.1)
    assert of_amplitude < 1.0  # a difference
    assert any("Until then the interval of every tension includes it" in one for one in notes)


def test_a_damper_that_stands_pushed_after_its_cycles_is_not_slack_there(tmp_path, command):
    # friction of 1 kN behind a spring: it stays under -1 kN when the machine stops
    time = np.arange(0, 260, 0.1)
    place = 0.01 * np.interp(time, np.r_[0:20:2j, 25:226:10, 230, 260], np.r_[
        0, 0, np.tile([1.0, -1.0], 11)[:21], 0.6, 0.6])  # fmt: skip
    load = np.zeros(time.size)
    for row in range(1, time.size):
        load[row] = np.clip(load[row - 1] + 5e5 * (place[row] - place[row - 1]), -1000, 1000)
    noise = np.random.default_rng(4).normal(0, 1.0, time.size)
    rows = zip(time, place, load + noise, strict=True)
    text = "t,x,F\n" + "".join(f"{t:.1f},{x:.5f},{f:.2f}\n" for t, x, f in rows)
    (tmp_path / "A.csv").write_text(text)
    campaign = CORD.replace("KEYS", ', reference_length = "1 m"')
    campaign = campaign.replace("SPECIMEN", 'gauge_length = "1 m"').replace('"rope"', '"other"')
    (tmp_path / "campaign.toml").write_text(campaign)
    command("run", tmp_path / "campaign.toml", cwd=tmp_path)
    with open_archive(tmp_path / "processed" / "cord" / "A.nc") as archive:
        mean, spread = (
            float(archive[f"test_mean_tension{kind}"].item())
            for kind in ("", "_standard_uncertainty")
        )
    assert abs(mean) < 4 * spread < 40


@pytest.mark.parametrize(("lag", "is_told"), [("0.05 s", True), ("0.2 s", False)])
def test_a_late_load_is_told_unless_the_stated_lag_explains_it(tmp_path, command, lag, is_told):
    write_cord(tmp_path, first=0.0, keys=', reference_length = "1 m"', rest=True)
    head, *lines = (tmp_path / "A.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines]
    late = [f"{t},{x},{f}" for (t, x, _), (*_, f) in zip(rows[3:], rows[:-3], strict=True)]  # 0.3 s
    (tmp_path / "A.csv").write_text("\n".join([head, *late]) + "\n")
    text = (tmp_path / "campaign.toml").read_text().replace('"rope"', '"elastomer"')
    (tmp_path / "campaign.toml").write_text(text + f'[uncertainty]\nlag = "{lag}"\n')
    done = command("check", tmp_path / "campaign.toml", "--json", cwd=tmp_path)
    [test] = json.loads(done.stdout)["tests"]
    assert ("tension lags position by 0.3" in test["message"]) == is_told


@pytest.mark.nightly
def test_a_load_cell_with_the_wrong_sign_keeps_that_advice(tethers, command):
    folder, rewrite = tethers
    rewrite(lambda time, place, new, used: (time, place, -new, used))
    for _, tests in both(command, folder).values():
        assert "load is negative" in tests["A"] and "set sign = -1" in tests["A"]
        assert "zero is wrong" not in tests["A"]


def test_a_crosshead_with_the_wrong_zero_contradicts_the_tape(tethers, command):
    folder, rewrite = tethers
    rewrite(lambda time, place, new, used: (time, place + 1, new, used))
    for status, tests in both(command, folder).values():
        assert status == 4
        assert "off by +0.304" in tests["A"]
        assert "the zero of crosshead_position is wrong" in tests["A"]


def write_cord(folder, *, first, keys="", specimen='gauge_length = "1 m"', rest=False):
    """Ten cycles of 2000 N a metre from slack at zero, between two displacements."""
    time = np.arange(0, 100.05, 0.1)
    travel = 0.1 + 0.5 * (1 - np.abs(time / 5 % 2 - 1))
    if rest:  # from 20 s at slack, pulled in 20 s
        ramp = np.concatenate([np.full(200, -0.02), np.linspace(-0.02, 0.1, 200, endpoint=False)])
        travel = np.concatenate([ramp, travel])
        time = 0.1 * np.arange(travel.size)
    load = 2000 * np.maximum(travel, 0)
    generator = np.random.default_rng(9)
    rows = zip(
        time, travel - first + generator.normal(0, 1e-4, time.size),
        load + generator.normal(0, 0.5, time.size), strict=True,
    )  # fmt: skip
    text = "t,x,F\n" + "".join(f"{t:.1f},{x:.5f},{f:.2f}\n" for t, x, f in rows)
    (folder / "A.csv").write_text(text)
    campaign = CORD.replace("KEYS", keys).replace("SPECIMEN", specimen)
    (folder / "campaign.toml").write_text(campaign)


def test_a_position_zero_that_is_not_slack_is_said_first(tmp_path, command):
    # displacement zero at 0.34 m, where 680 N pull: strain -24 to 26 %
    write_cord(tmp_path, first=0.34)
    for status, tests in both(command, tmp_path).values():
        assert status == 0
        assert "cord: strain falls to -24 % at tensions up to 6" in tests["A"]
        assert "crosshead_position is not zero where" in tests["A"]


def test_a_strain_of_less_than_nothing_is_refused(tmp_path, command):
    write_cord(tmp_path, first=1.3)  # zero 1.3 m above slack, on a gauge length of 1 m
    for status, tests in both(command, tmp_path).values():
        assert status == 4
        assert "strain of 'cord' in test 'A' is at or below -100 %; found -12" in tests["A"]


@pytest.mark.parametrize(
    ("keys", "specimen"),
    [
        (', reference_length = "1 m", reference_tension = "60 N"', 'gauge_length = "1 m"'),
        ("", 'gauge_length = "1 m"\nreference_tension = "60 N"'),
        (', reference_length = "1 m"', 'gauge_length = "1 m"\nreference_tension = "60 N"'),
    ],
)
def test_strain_is_zero_at_the_reference_tension(tmp_path, command, keys, specimen):
    write_cord(tmp_path, first=0.0, keys=keys, specimen=specimen, rest=True)
    for status, tests in both(command, tmp_path).values():
        assert status == 0, tests
    with open_archive(tmp_path / "processed" / "cord" / "A.nc") as archive:
        strain = archive["strain"].values[0]
        load = archive["tension"].values[0]
        # 60 N are 0.03 m from slack; a length of 1 m there
        assert np.nanmax(strain) == pytest.approx(0.6 - 0.03, abs=1e-3)
        rise = (load > 20) & (load < 100) & (np.arange(load.size) < 400)
        line = np.polyfit(load[rise] - 60.0, strain[rise], 1)
        assert line[1] == pytest.approx(0.0, abs=2e-4)
        assert float(archive["strain_reference_tension"].values[0]) == 60.0
        constant = archive["apparent_spring_constant"].values[0, 1:]  # the first has the way there
        assert constant == pytest.approx(np.full(constant.shape, 2000.0), rel=0.01)
        notes = [str(one) for one in archive["note"].values]
        assert any("strain is zero at the reference tension of 60 N" in one for one in notes)


def test_a_log_that_begins_above_the_reference_tension_needs_its_position(tmp_path, command):
    write_cord(tmp_path, first=0.0, specimen='gauge_length = "1 m"\nreference_tension = "60 N"')
    for status, tests in both(command, tmp_path).values():
        assert status == 4
        assert "a reference_tension through which the log rises" in tests["A"]
    # stated: displacement zero, 1.03 m, has 60 N
    keys = ', reference_length = "1.03 m", reference_tension = "60 N"'
    write_cord(tmp_path, first=0.03, keys=keys, specimen='gauge_length = "1.03 m"')
    assert both(command, tmp_path)["run"][0] == 0
    with open_archive(tmp_path / "processed" / "cord" / "A.nc") as archive:
        greatest = float(np.nanmax(archive["strain"].values))
    assert math.isclose(greatest, (0.6 - 0.03) / 1.03, abs_tol=1e-3)


def test_a_reference_length_stands_for_a_gauge_length_that_was_asked_for(tmp_path, command):
    write_cord(tmp_path, first=0.0, keys=', reference_length = "1.25 m"', specimen="")
    text = (tmp_path / "campaign.toml").read_text()
    (tmp_path / "campaign.toml").write_text(text + 'strain = { method = "gauge-length" }\n')
    for status, tests in both(command, tmp_path).values():
        assert status == 0
        assert (
            "no gauge_length is stated: strain refers to the whole reference_length" in tests["A"]
        )
    with open_archive(tmp_path / "processed" / "cord" / "A.nc") as archive:
        assert float(np.nanmax(archive["strain"].values)) == pytest.approx(0.6 / 1.25, abs=1e-3)


def thin_out(name, folder, factor):
    """A campaign of the project, every log of it with one row of `factor`."""
    folder.mkdir(parents=True)
    for source in filter(Path.is_file, (ROOT / "raw" / name).iterdir()):
        text = source.read_bytes()
        if source.suffix == ".csv" and source.stem != "marks":
            lines = text.splitlines(keepends=True)
            begin = next(row for row, line in enumerate(lines) if line[:1] in b"-.0123456789")
            text = b"".join([*lines[:begin], *lines[begin::factor]])
        (folder / source.name).write_bytes(text)
    return folder / "campaign.toml"


def run_thinned(command, name, folder, factor):
    """Check and run it: the data are at fault, and neither this program nor the disk."""
    campaign = thin_out(name, folder / "raw", factor)
    checked = command("check", campaign)
    places = ("--processed", folder / "processed", "--reports", folder / "reports")
    done = command("run", campaign, *places)
    told = f"{name}, one row of {factor}: {checked.returncode}, {done.returncode}\n{done.stderr}"
    assert {checked.returncode, done.returncode} <= {0, 4, 5}, told
    assert "Check the disk" not in done.stdout + done.stderr, told
    assert "design values: " in done.stdout, told
    return checked, done


@pytest.mark.nightly
@pytest.mark.parametrize(("name", "factor"), [("nylon-synthetic", 30), ("tmt-synthetic", 80)])
def test_a_log_too_coarse_for_its_cycles_is_refused_by_check_as_by_run(
    command, tmp_path, name, factor
):
    for done in run_thinned(command, name, tmp_path, factor):
        assert done.returncode in (4, 5)  # 5: no run is left for its experiment
        assert re.search(
            r"too few samples in a cycle; found [23] in cycle \d+, which lasts [\d.]+ s; "
            r"needed 4 or more, and 12 for sound peaks and loops\. Log every [\d.]+ s or faster",
            done.stderr,
        )


@pytest.mark.nightly
def test_a_log_with_few_samples_in_its_cycles_is_flagged_by_check(command, tmp_path):
    checked, done = run_thinned(command, "nylon-synthetic", tmp_path, 20)
    assert (checked.returncode, done.returncode) == (0, 0)
    assert "R01: 4 samples per cycle; 12 are needed for reliable peaks" in checked.stdout
    # none of its runs has a curve, and that is no fault of its archives
    assert "design values: " in done.stdout


@pytest.mark.nightly
@pytest.mark.parametrize(
    "name", ["tmt-synthetic", "nylon-synthetic", "hose-synthetic", "buoy-technology-1997"]
)
def test_no_thinned_log_ends_in_a_defect_or_in_a_fault_of_the_disk(command, tmp_path, name):
    for factor in (2, 3, 5, 7, 10, 12, 14, 16, 20, 25, 30, 40, 50, 60, 70, 80, 100, 150, 200):
        run_thinned(command, name, tmp_path / str(factor), factor)


@pytest.mark.skipif(sys.platform != "linux", reason="needs names that are no UTF-8")
def test_a_folder_that_netcdf_cannot_name_is_refused_before_anything_is_reduced(
    command, tethers, tmp_path
):
    folder = tmp_path / os.fsdecode(b"f\xff")
    campaign = tmp_path / "small" / "campaign.toml"
    done = command("run", campaign, "--processed", folder, "--reports", tmp_path / "reports")
    assert done.returncode == 2
    assert "a name that utf-8 cannot represent; needed a path in" in done.stderr
    assert not folder.exists()


@pytest.mark.nightly
def test_errors_stand_once_in_one_file_and_a_run_that_failed_names_no_products(tethers, tmp_path):
    for name in ("A.csv", "B.csv"):
        (tmp_path / "small" / name).write_text("no log\n")
    places = ("--processed", tmp_path / "p", "--reports", tmp_path / "r")
    done = subprocess.run(
        [sys.executable, "-m", "reduction", "run", tmp_path / "small" / "campaign.toml", *places],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, cwd=ROOT,
    )  # fmt: skip
    assert done.returncode == 3
    assert sum("A.csv" in line for line in done.stdout.splitlines()) == 1
    assert "archives: none; all tests failed\n" in done.stdout


@pytest.mark.parametrize(
    ("factor", "keys", "words"),
    [
        (1000, "", "a cycle takes 2."),  # 9 s, in ms
        (1e-3, "", "the crosshead moves at 2"),  # 1 ft/s: 305 m/s, less at its turns
        (1, "", None),
        (1000, 'frequency = "0.00005 Hz"', None),  # compared with the log instead
    ],
)
def test_a_time_in_another_unit_is_named_where_no_rate_is_stated(
    factor, keys, words, tethers, command
):
    folder, rewrite = tethers
    rewrite(lambda time, *others: (factor * time, *others))
    (folder / "campaign.toml").write_text(CAMPAIGN + keys + "\n" + TESTS)
    done = command("check", folder / "campaign.toml", "--json", cwd=folder)
    message = json.loads(done.stdout)["tests"][0]["message"]
    assert ("unit of time" in message) == (words is not None), message
    assert words is None or words in message, message
