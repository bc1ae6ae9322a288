"""Experiments of a campaign beside its tests: what a check lists, and what a part of a run fits."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from commandruns import answered

from reduction.archive import open as opening
from reduction.archive.open import open_archive
from reduction.batch.experiment_product import write_experiments
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign
from reduction.experiments.designs import FactorLevels
from reduction.record.errors import ArchiveError

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "nylon-synthetic"
KEPT = ("R01", "R02", "R03", "Q01")


def run(folder, tests=(), first_factor=None):
    """Two experiments over three runs: too few for a surface, enough to see what is fitted."""
    whole = load_campaign(folder / "raw" / "campaign.toml")
    plan = whole.experiments["nylon"]
    factors = (first_factor or plan.factors[0], *plan.factors[1:])
    runs = {name: plan.runs[name] for name in ("R01", "R02")}
    one = replace(plan, name="one", factors=factors, runs=runs)
    two = replace(
        plan, name="two", runs={"R03": plan.runs["R03"]}, quasi_static={},
        responses=("hysteresis_energy",),
    )  # fmt: skip
    few = replace(
        whole, tests={name: whole.tests[name] for name in KEPT},
        experiments={"one": one, "two": two},
    )  # fmt: skip
    done = run_campaign(
        few, processed=folder / "p", reports=folder / "r", clock=lambda: 0.0, tests=tests
    )
    return done, {one.id: one for one in done.parts["experiments"]}


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    folder = tmp_path_factory.mktemp("experiments")
    shutil.copytree(RAW, folder / "raw")
    run(folder)
    return folder


@pytest.fixture
def folder(complete, tmp_path):
    shutil.copytree(complete, tmp_path / "again")
    return tmp_path / "again"


def other_pull(folder):
    """A line that is ten per cent stiffer."""
    path = folder / "raw" / "Q01.csv"
    lines = path.read_text().splitlines()
    header = next(place for place, line in enumerate(lines) if line.startswith("time_s"))
    place = lines[header].split(",").index("load_lbf")
    for number in range(header + 1, len(lines)):
        cells = lines[number].split(",")
        cells[place] = repr(1.1 * float(cells[place]))
        lines[number] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")


def pull_of(done, name):
    with open_archive(done.processed / f"{name}.nc") as archive:
        return json.loads(archive.attrs["settings"])["quasi_static"]["line-1"]


@pytest.mark.nightly
def test_a_changed_pull_does_not_fit_runs_that_hold_the_one_before(folder):
    other_pull(folder)
    done, said = run(folder, ["Q01"])
    assert said["one"].status == "no_work"
    assert said["one"].message == (
        "not fitted: 2 of its runs not reduced yet from logs and settings as they stand now "
        "(R01, R02)"
    )
    # the experiment beside it waits for nothing
    assert said["two"].status == "failed"
    with open_archive(done.processed / "surfaces.nc") as archive:
        assert archive["experiment"].to_numpy().tolist() == ["two"]
    before = pull_of(done, "R01")
    assert before["test"] == "Q01"
    done, said = run(folder, ["R01"])
    assert said["one"].message.startswith("not fitted: 1 of its runs not reduced yet from")
    done, said = run(folder, ["R02"])
    assert said["one"].status == "failed"  # as a fit: two runs
    # the whole pull is scaled, and so is its range of use
    now = pull_of(done, "R01")
    assert now["tension_high"] == pytest.approx(1.1 * before["tension_high"], rel=0.01)


def test_a_changed_log_that_was_not_asked_for_is_waited_for(folder):
    log = folder / "raw" / "R03.csv"
    log.write_text("".join(log.read_text().splitlines(keepends=True)[:-1]))
    _, said = run(folder, ["R01"])
    assert said["two"].message == (
        "not fitted: 1 of its runs not reduced yet from logs and settings as they stand now (R03)"
    )
    assert said["one"].status != "no_work"


def test_where_all_wait_what_stands_is_of_an_earlier_run(folder):
    other_pull(folder)
    (folder / "p" / "nylon-synthetic" / "R03.nc").unlink()
    done, said = run(folder, ["Q01"])
    assert said["two"].message == (
        "not fitted: 1 of its runs not reduced yet from logs and settings as they stand now (R03); "
        "surfaces.nc is of an earlier run"
    )
    assert done.exit_status == 0


def test_runs_with_one_log_are_told(folder):
    shutil.copy(folder / "raw" / "R01.csv", folder / "raw" / "R02.csv")
    done, _ = run(folder)
    with open_archive(done.processed / "surfaces.nc") as archive:
        notes = archive["note"].to_numpy().tolist()
    assert any("R01 and R02 have the same log, byte for byte" in note for note in notes)


def test_a_check_lists_runs_pulls_and_what_would_go_slack(command):
    done = command("check", RAW / "campaign.toml", "--json")
    (found,) = answered(done)["experiments"]
    assert (found["id"], found["kind"]) == ("nylon", "box-behnken")
    assert found["runs"] == found["runs_found"] == [f"R{number:02d}" for number in range(1, 16)]
    assert found["runs_failed"] == [] and found["notes"] == []
    assert found["quasi_static"] == [{"specimen": "line-1", "test": "Q01", "found": True}]
    # CG-D-39-80 Table 2: 12 % less 12 % of the break strength
    assert found["slack_runs"] == [
        {
            "run": "R05",
            "specimen": "line-1",
            "planned_minimum_tension": {"value": 0.0, "unit": "N"},
        }
    ]


def test_a_check_says_what_failed_and_what_is_copied(command, tmp_path):
    shutil.copytree(RAW, tmp_path / "raw")
    (tmp_path / "raw" / "Q01.csv").unlink()
    shutil.copy(tmp_path / "raw" / "R01.csv", tmp_path / "raw" / "R02.csv")
    (tmp_path / "raw" / "R04.csv").unlink()
    path = tmp_path / "raw" / "campaign.toml"
    path.write_text(path.read_text().replace('"5 %RBS", "12 %RBS"', '"5 %RBS", "13 %RBS"'))
    done = command("check", path, "--units", "us")
    assert done.returncode == 3
    said = [line.strip() for line in done.stdout.splitlines()]
    assert (
        "experiment nylon: box-behnken of frequency, mean_tension, tension_amplitude; "
        "14 of 15 runs found"
    ) in said
    assert "failed: R04" in said
    assert "slow pull of line-1: Q01, which failed" in said
    # 12 less 13 % of 6400 lbf
    assert "R05 line-1: planned minimum tension -64 lbf: the line goes slack in every cycle" in said
    assert any(line.startswith("R01 and R02 have the same log, byte for byte") for line in said)


def test_a_check_of_a_part_says_what_it_did_not_look_at(command):
    done = command("check", RAW / "campaign.toml", "--test", "R05")
    assert "; 1 of 15 runs found" in done.stdout
    assert "slow pull of line-1: Q01, which was not asked for" in done.stdout


def test_runs_of_which_a_factor_never_moves_end_as_data_that_cannot_carry_a_surface(folder):
    # as `reduction surface` ends; runs fewer than terms end with 5
    assert run(folder)[1]["one"].exit_status == 5
    done, said = run(folder, first_factor=FactorLevels("temperature", 278.0, 298.0))
    assert said["one"].exit_status == 4
    assert "temperature never moves" in said["one"].message
    assert done.exit_status == 4


def test_a_run_whose_archive_cannot_be_read_is_not_one_that_is_missing(folder, monkeypatch):
    """Surfaces over the other runs would be other surfaces."""
    (surfaces,) = folder.glob("p/*/surfaces.nc")
    before = surfaces.read_bytes()
    opened = opening.ReadOnce.__call__

    def refused(self, path):
        if path.name == "R02.nc":
            raise ArchiveError(f"{path} cannot be read", found="Input/output error")
        return opened(self, path)

    monkeypatch.setattr(opening.ReadOnce, "__call__", refused)
    with pytest.raises(ArchiveError, match=r"R02\.nc cannot be read; found Input/output error"):
        run(folder)
    assert surfaces.read_bytes() == before


def test_that_k_1_has_no_surface_is_a_warning_where_the_experiment_names_a_slow_pull(
    nylon_campaign, tmp_path
):
    for path in nylon_campaign.processed.glob("R*.nc"):
        shutil.copy(path, tmp_path)
        with netCDF4.Dataset(tmp_path / path.name, "a") as test:
            for name in ("dissipation_spring_constant", "relaxation_time"):
                found = next(
                    one.variables[f"test_{name}"]
                    for one in (test, *test.groups.values())
                    if f"test_{name}" in one.variables
                )
                found[:] = np.nan
    campaign = load_campaign(RAW / "campaign.toml")
    common = {"failed": (), "waiting": (), "raw_sha256": {}, "command": ""}
    for pulls, severity in (({"line-1": "Q01"}, "warning"), ({}, "refusal")):
        plan = replace(
            campaign.experiments["nylon"],
            quasi_static=pulls,
            responses=("apparent_spring_constant", "dissipation_spring_constant"),
        )
        write_experiments(replace(campaign, experiments={"nylon": plan}), tmp_path, **common)
        with open_archive(tmp_path / "surfaces.nc") as archive:
            codes = archive["note_code"].to_numpy().tolist()
            told = archive["note_severity"].to_numpy()[codes.index("no-surface")]
        assert told == severity
