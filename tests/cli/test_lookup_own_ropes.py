"""Levels of a rope that a campaign tested without a design: looked up, interpolated, exported."""

import csv
import importlib.util
import json
import shutil

import netCDF4
import numpy as np
import pytest
from commandruns import ROOT, run_once, shared_by_processes
from csvrows import csv_rows
from scipy import stats
from typer.testing import CliRunner

import reduction
from reduction.archive.open import reading
from reduction.batch.campaign_status import TestStatus, status_csv
from reduction.cli.lookup import one_line_of
from reduction.cli.main import app
from reduction.lines.archive_source import lines_of_folder
from reduction.lines.line_levels import evaluate_levels
from reduction.lines.line_lookup import look_up
from reduction.lines.line_search import conditions_of, in_conditions
from reduction.lines.lookup_product import LineLevels, LineSource
from reduction.record.errors import DataError, SettingsError

pytestmark = pytest.mark.slow

LBF = 4.4482216152605
STRENGTH = 6400 * LBF
K_AP, KEPT = "apparent_spring_constant", ("R01", "R02", "R04", "R08", "R11", "R14", "Q01")


def at(frequency, mean, amplitude):
    return {
        "frequency": frequency,
        "mean_tension": mean * STRENGTH,
        "tension_amplitude": amplitude * STRENGTH,
    }


CENTRE = at(0.3, 0.21, 0.085)


@pytest.fixture(scope="module")
def rope(tmp_path_factory):
    """Six tests and the slow pull of the synthetic nylon line, without its experiment."""
    made = run_once("nylon-synthetic", shared_by_processes(tmp_path_factory)).processed
    folder = tmp_path_factory.mktemp("own") / "rope"
    folder.mkdir()
    for name in (*KEPT, "change_in_length"):
        shutil.copy(made / f"{name}.nc", folder)
    return folder


@pytest.fixture(scope="module")
def lines(rope):
    return lines_of_folder(rope)


@pytest.fixture(scope="module")
def line(lines):
    return lines[0]


@pytest.fixture(scope="module")
def law():
    """Numbers of the law that made the logs, by run."""
    text = (ROOT / "raw" / "nylon-synthetic" / "truth" / "runs.csv").read_text()
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return {row["run"]: row for row in rows}


def test_a_tested_level_is_the_mean_of_its_tests(line, rope, law):
    assert line.name == "line-1"
    found = look_up(line, K_AP, **CENTRE)
    values, shared = [], []
    for test in ("R02", "R08", "R14"):
        with reading(rope / f"{test}.nc") as archive:
            values.append(float(archive[f"test_{K_AP}"][0]))
            shared.append(archive[f"test_{K_AP}_uncertainty_contribution"].values[:, 0])
    assert float(found.value) == pytest.approx(np.mean(values), rel=1e-12)
    assert float(found.value) == pytest.approx(LBF * float(law["R02"][f"{K_AP}_lbf"]), rel=2e-3)
    # the scatter of three tests beside the instruments that all of them share
    u = np.hypot(np.std(values, ddof=1) / np.sqrt(3), np.linalg.norm(np.mean(shared, axis=0)))
    assert float(found.surface_high - found.value) == pytest.approx(1.96 * u, rel=2e-3)
    assert conditions_of(line, K_AP) == {"medium": "wet"}
    energy = look_up(line, "hysteresis_energy", **CENTRE)
    true = LBF * float(law["R02"]["hysteresis_energy_lbf"])
    assert energy.surface_low < true < energy.surface_high


def test_between_two_levels_the_interval_spans_both_and_outside_nothing_is_given(line, law):
    ends = [look_up(line, K_AP, **at(0.3, mean, 0.05)) for mean in (0.12, 0.30)]
    found = look_up(line, K_AP, **at(0.3, 0.18, 0.05))
    low, high = (float(one.value) for one in ends)
    assert float(found.value) == pytest.approx(low + (high - low) / 3, rel=1e-3)
    assert found.surface_low == ends[0].surface_low
    assert found.surface_high == ends[1].surface_high
    assert any("not tested, interpolated between R01" in note for note in found.notes)
    for extrapolate in ("refuse", "flag"):
        with pytest.raises(DataError, match="the nearest is R11"):
            look_up(line, K_AP, extrapolate=extrapolate, **at(0.3, 0.35, 0.05))
    # inside the box, but on no line between two tests
    with pytest.raises(DataError, match="nor between two tested levels"):
        look_up(line, K_AP, **at(0.37, 0.17, 0.06))
    with pytest.raises(SettingsError, match=r"--frequency with one of 0.3 Hz, 0.5 Hz"):
        look_up(line, K_AP, mean_tension=0.21 * STRENGTH)


def test_a_rope_of_one_pull_has_what_its_change_in_length_says(rope, line, tmp_path):
    for name in ("Q01", "change_in_length"):
        shutil.copy(rope / f"{name}.nc", tmp_path)
    (alone,) = lines_of_folder(tmp_path)
    assert [one.quantity for one in alone.levels] == ["original_stiffness"]
    assert [one.quantity for one in alone.curves] == ["quasi_static_spring_constant", "strain"]
    (own,) = (one for one in line.levels if one.quantity == "original_stiffness")
    assert alone.levels[0].value == own.value
    assert f"specimen {line.name}: slow pull " in alone.source


def test_original_and_slow_stiffness_stand_beside_the_levels(line, lines, rope):
    with reading(rope / "R01.nc") as archive:
        tension, strain = archive["tension"].values[0], archive["strain"].values[0]
        peak = int(archive["cycle_last_sample"].values[0])
    top = int(np.argmax(tension[: peak + 1]))
    start = int(np.flatnonzero(tension[:top] < 60.0)[-1])
    chord = (tension[top] - tension[start]) / (strain[top] - strain[start])
    assert float(look_up(line, "original_stiffness").value) == pytest.approx(chord, rel=0.01)
    with reading(rope / "Q01.nc") as archive:
        tension = archive["tension_grid"].values
        own = archive["quasi_static_spring_constant"].values[0]
    slow = look_up(line, "quasi_static_spring_constant", mean_tension=tension)
    assert slow.value == pytest.approx(own, rel=1e-9)
    # a modulus of one test is found by the name of the test, as before
    assert one_line_of(lines, "tangent_modulus", "R02").name == "R02 line-1"
    with pytest.raises(SettingsError, match="several lines have tangent_modulus"):
        one_line_of(lines, "tangent_modulus", "line-1")


def test_a_table_has_the_levels_that_were_tested(command, rope, tmp_path):
    out = tmp_path / "levels.csv"
    done = command(
        "lookup", rope, "--quantity", "apparent_spring_constant", "--table", "--mean-tension", "21 %RBS",
        "--medium", "wet", "--out", out,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    (row,) = csv_rows(out)
    with reading(rope / "R02.nc") as archive:
        own = float(archive[f"test_{K_AP}"][0])
    assert float(row[f"{K_AP} [N]"]) == pytest.approx(own, rel=1e-4)
    assert f"{own / STRENGTH:.3g}" in done.stdout
    listed = command("lookup", rope, "--list")
    assert "Levels of line-1" in listed.stdout and "R11" in listed.stdout


def test_a_condition_that_was_not_tested_says_so(line):
    assert in_conditions(line, K_AP, {"medium": "wet"}).levels[0].tests == line.levels[0].tests
    for asked, told in (
        ({"medium": "dry"}, "medium wet"),
        ({"temperature": "5 degC"}, "temperature not stated"),
    ):
        with pytest.raises(DataError, match=told):
            in_conditions(line, K_AP, asked)
        flagged = look_up(in_conditions(line, K_AP, asked, is_flagged=True), K_AP, **CENTRE)
        assert flagged.warnings[0].startswith("NOT TESTED at")


def test_python_asks_for_conditions_as_the_command_does(rope):
    found = reduction.look_up(rope, "apparent_spring_constant", medium="wet", **CENTRE)
    assert float(found[K_AP]) == float(reduction.look_up(rope, K_AP, **CENTRE)[K_AP])
    with pytest.raises(DataError, match="medium wet"):
        reduction.look_up(rope, K_AP, medium="dry", **CENTRE)
    flagged = reduction.look_up(rope, K_AP, temperature="5 degC", extrapolate="flag", **CENTRE)
    assert flagged.attrs["warnings"].startswith("NOT TESTED at")


def levels(conditions):
    n = len(conditions)
    return LineLevels(
        "apparent_spring_constant", ("frequency", "mean_tension"),
        np.array([[0.1, 100.0 * (1 + row)] for row in range(n)]), np.linspace(1e3, 2e3, n),
        np.full(n, 10.0), np.full(n, 5.0), tuple("abcd"[:n]), conditions=conditions,
    )  # fmt: skip


def test_wet_and_dry_tests_are_not_one_line():
    both = levels(({"medium": "wet", "temperature": "20 degC"}, {"medium": "dry"}))
    line = LineSource("rope", "", "nylon", "", "", 0.05, 3e5, levels=(both,))
    with pytest.raises(SettingsError, match="several conditions; found medium dry; medium wet, "):
        look_up(line, "apparent_spring_constant", mean_tension=100.0)
    for asked in ({"medium": "WET"}, {"temperature": "21 degC"}):
        wet = in_conditions(line, "apparent_spring_constant", asked)
        found = look_up(wet, "apparent_spring_constant", mean_tension=100.0)
        assert float(found.value) == 1e3
        # Student's, of five degrees of freedom
        assert float(found.surface_high) == pytest.approx(1e3 + 10 * stats.t.ppf(0.975, 5))
    with pytest.raises(DataError, match="not tested in these conditions"):
        in_conditions(line, "apparent_spring_constant", {"temperature": "25 degC"})


def test_a_frequency_is_interpolated_by_its_logarithm():
    of = LineLevels(
        "apparent_spring_constant", ("frequency",), np.array([[0.001], [0.1]]),
        np.array([1000.0, 2000.0]), np.zeros(2), np.full(2, np.inf), ("a", "b"),
    )  # fmt: skip
    assert evaluate_levels(of, np.array([[0.01]]), "rope").value == pytest.approx([1500.0])


@pytest.mark.nightly
def test_export_writes_the_level_that_was_tested(command, line, rope, tmp_path):
    is_there = importlib.util.find_spec("moordyn") is not None
    levels = ("--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude")
    asked = ("export", rope, *levels, "8.5 %RBS", "--linear-density", "0.14 kg/m")
    done = command(
        *asked, "--to", "moordyn", "--form", "static-dynamic", "--out", tmp_path / "rope.dat",
        *(("--verify",) if is_there else ()), "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    value = float(look_up(line, K_AP, **CENTRE).value)
    (stated,) = (one for one in json.loads(done.stdout)["notes"] if one.startswith("K_1 "))
    assert "identified from the tests of K_ap and H" in stated
    if is_there:
        checks = {one["quantity"]: one for one in json.loads(done.stdout)["checks"]}
        assert checks["K_ap"]["found"] == pytest.approx(value, rel=0.02)
    for to in ("csv", "netcdf"):
        done = command(*asked, "--to", to, "--out", tmp_path / f"rope.{to}")
        assert done.returncode == 0, done.stderr


@pytest.mark.nightly
@pytest.mark.parametrize("quantity", ["K_ap", "hysteresis_energy", "loss_factor"])
def test_the_levels_of_one_run_of_an_experiment_may_be_left_out(tmp_path_factory, quantity):
    made = run_once("nylon-synthetic", shared_by_processes(tmp_path_factory)).processed
    done = CliRunner().invoke(
        app, ["lookup", str(made), "--line", "R01 line-1", "--quantity", quantity]
    )
    assert done.exit_code == 0 and "95 % interval, the tests" in " ".join(done.output.split()), (
        done.output
    )


ROPE = """
[campaign]
id = "laid"
title = "A rope of unknown diameter"
[specimens.rope-1]
kind = "rope"
rated_break_strength = "100 kN"
gauge_length = "2 m"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "mm", datum = "displacement", reference_length = "2 m" }
tension.1 = { column = "load", unit = "kN" }
[defaults]
layout = "log"
specimens = ["rope-1"]
waveform = "sinusoidal"
[tests.low]
file = "low.csv"
order = 1
[tests.high]
file = "high.csv"
order = 2
"""


@pytest.fixture(scope="module")
def without_diameter(tmp_path_factory):
    """Two tests of a rope of which neither a diameter nor an instrument error is stated."""
    folder = tmp_path_factory.mktemp("laid")
    (folder / "campaign.toml").write_text(ROPE)
    time = np.arange(0, 120, 0.05)
    noise = np.random.default_rng(5).normal(0, 0.002, (2, time.size))
    for (name, mean), scatter in zip({"low": 40.0, "high": 60.0}.items(), noise, strict=True):
        stroke = mean - 20 * np.cos(2 * np.pi * 0.1 * time)
        rows = zip(time, stroke, 0.3 * stroke + scatter, strict=True)
        text = "".join(f"{t:.2f},{x:.4f},{load:.4f}\n" for t, x, load in rows)
        (folder / f"{name}.csv").write_text(f"t,x,load\n{text}")
    reduction.run(
        folder / "campaign.toml", processed=folder / "processed", reports=folder / "reports"
    )
    return folder / "processed" / "laid"


def test_a_rope_without_a_diameter_is_looked_up_at_its_levels(without_diameter):
    (line,) = lines_of_folder(without_diameter)
    assert line.name == "rope-1" and not line.curves
    with pytest.raises(DataError, match="the nearest is"):
        look_up(line, K_AP, frequency=0.1, mean_tension=30e3, tension_amplitude=6e3)
    # 0.3 kN/mm on 2 m
    found = look_up(line, K_AP, frequency=0.1, mean_tension=[12e3, 18e3], tension_amplitude=6e3)
    assert found.value == pytest.approx(600e3, rel=2e-3)
    assert np.all(found.surface_low < found.value) and np.all(found.value < found.surface_high)


def test_a_level_warns_if_the_last_run_could_not_reduce_its_test(rope, tmp_path):
    doubted = tmp_path / "rope"
    shutil.copytree(rope, doubted)
    rows = [
        TestStatus(name, "failed" if name == "R11" else "reduced", 0, "cut off", 0, 0, "", 0.0)
        for name in KEPT
    ]
    (doubted / "status.csv").write_text(status_csv(rows), newline="")
    (line, *_) = lines_of_folder(doubted)
    (said,) = look_up(line, K_AP, **at(0.3, 0.30, 0.05)).warnings
    assert said.startswith("R11 could not be reduced in the last run")
    assert look_up(line, K_AP, **CENTRE).warnings == ()


def test_surfaces_have_the_conditions_and_checks_of_their_runs_alone(tmp_path_factory, tmp_path):
    """One more test of the rope, dry and with the status check, is in no surface."""
    made = run_once("nylon-synthetic", shared_by_processes(tmp_path_factory)).processed
    for path in made.glob("*.nc"):
        (tmp_path / path.name).symlink_to(path)
    shutil.copy(made / "R05.nc", tmp_path / "X1.nc")
    with netCDF4.Dataset(tmp_path / "X1.nc", "a") as archive:
        archive.test, archive.medium = "X1", "dry"
    (line,) = (one for one in lines_of_folder(tmp_path) if one.surfaces)
    assert line.conditions["medium"] == "wet"
    assert line.warnings[0].startswith("1 of 15 runs has the status check; R05")
    assert look_up(in_conditions(line, K_AP, {"medium": "wet"}), K_AP, **CENTRE).value > 0


def test_a_value_brings_along_why_its_own_test_has_the_status_check(rope, command, tmp_path):
    """The reason that `run` prints is above the value and in the header of a deck."""
    doubted = tmp_path / "rope"
    shutil.copytree(rope, doubted)
    with netCDF4.Dataset(doubted / "R11.nc", "a") as archive:
        archive["notes/note_severity"][0] = "warning"
        reason = str(archive["notes/note"][0])
    (line, *_) = lines_of_folder(doubted)
    said = f"R11 has the status check: {reason}"
    assert look_up(line, K_AP, **at(0.3, 0.30, 0.05)).warnings == (said,)
    assert look_up(line, K_AP, **at(0.3, 0.18, 0.05)).warnings == (said,)  # between R01 and R11
    assert look_up(line, K_AP, **CENTRE).warnings == ()
    levels = ("--frequency", "0.3 Hz", "--mean-tension", "30 %RBS", "--tension-amplitude", "5 %RBS")
    done = command("lookup", doubted, "--line", "line-1", "--quantity", "K_ap", *levels)
    assert done.stdout.split("\n")[0] == f"warning: {said}"
    out = tmp_path / "a.dat"
    mass = ("--linear-density", "0.1 kg/m", "--out", out)
    done = command("export", doubted, "--to", "moordyn", "--form", "static-dynamic", *levels, *mass)
    assert f"note: DOUBTFUL: {said}" in done.stdout.split("\n")[1]
    assert "Note: DOUBTFUL: R11 has the status check" in "\n".join(out.read_text().split("\n")[2:6])
    done = command("export", doubted / "R11.nc", "--to", "csv", "--out", tmp_path / "a.csv")
    assert f"note: DOUBTFUL: {said}" in done.stdout
    assert "has the status check" in (tmp_path / "a.csv").read_text()
