"""A campaign of outcomes without a log, and the same beside tests: from the table to the page."""

import json
import shutil
from pathlib import Path

import pytest
from commandruns import answered
from csvrows import csv_rows
from rulesofcf import held_against_cf

from reduction.archive.open import open_archive

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "buoy-technology-1997"
CAMPAIGN = """
[campaign]
id = "lines"
title = "Lines by strength and life"
source = "synthetic, from a known law"
results = "results.csv"
[specimens.N-1]
kind = "rope"
material = "nylon"
construction = "8-strand plaited"
condition = "new"
diameter = "0.5 in"
rated_break_strength = "6000 lbf"
"""
HEADER = (
    "id,quantity,specimen,line,condition,exposure_years,value,unit,minimum_load_lbf,peak_load_lbf,"
    "place,valid,run_out\n"
)
# 6500 lbf less 600 a year, and 100 about it
BREAKS = "".join(
    f"B-{years}-{about},tensile_strength,,PD,{'worn' if years else 'new'},{years},"
    f"{6500 - 600 * years + about},lbf,,,,,\n"
    for years in (0, 2, 4)
    for about in (-100, 100)
)
LIVES = (
    "".join(
        f"S-{load}-{lives},cycles_to_failure,N-1,,,,{lives},cycles,0,{load},,,\n"
        for load, of_load in {4200: (4000, 5000, 7000), 3000: (30000, 40000, 50000)}.items()
        for lives in of_load
    )
    + "S-0,cycles_to_failure,N-1,,,,200000,cycles,0,1620,,,yes\n"
)
SPLICE = "B-9,tensile_strength,,PD,worn,2,5000,lbf,,,splice,,\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lines")
    (folder / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (folder / "results.csv").write_text(HEADER + BREAKS + SPLICE + LIVES, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def run(command, folder):
    done = command(
        "run", folder / "campaign.toml", "--processed", folder / "p", "--reports", folder / "r",
        "--json",
    )  # fmt: skip
    return answered(done)


def test_a_check_counts_the_outcomes_and_writes_nothing(command, folder, tmp_path):
    done = command("check", folder / "campaign.toml", cwd=tmp_path)
    assert done.returncode == 0
    assert done.stdout.splitlines() == [
        "results.csv: 14 outcomes",
        "  tensile_strength: 6 values, 1 lower bound",
        "  cycles_to_failure: 6 values, 1 lower bound",
    ]
    assert not any(tmp_path.iterdir())


def test_a_check_gives_the_counts_and_the_hash_as_json(command, folder):
    results = json.loads(command("check", folder / "campaign.toml", "--json").stdout)["results"]
    assert results["outcomes"] == 14 and len(results["sha256"]) == 64
    assert results["quantities"]["tensile_strength"] == {
        "value": 6, "lower_bound": 1, "excluded": 0,
    }  # fmt: skip


def test_outcomes_alone_give_archive_tables_and_report(run, folder):
    products = folder / "p" / "lines"
    assert run["tests"] == []
    assert sorted(path.name for path in products.iterdir()) == [
        "catalogue.parquet", "finished-run.json", "outcomes.nc", "run.lock", "tables",
    ]  # fmt: skip
    assert [Path(path).name for path in run["tables"]] == [
        "strength.csv", "exposure.csv", "fatigue.csv", "load_life.csv", "columns.csv",
    ]  # fmt: skip
    assert 'id="outcomes"' in Path(run["report"]).read_text(encoding="utf-8")


@pytest.mark.usefixtures("run")
def test_numbers_are_those_that_made_the_table(folder):
    tables = folder / "p" / "lines" / "tables"
    (exposure,) = csv_rows(tables / "exposure.csv")
    assert float(exposure["strength_slope [N year-1]"]) == pytest.approx(-600 * 4.4482216152605)
    assert float(exposure["share_lost_per_year [year-1]"]) == pytest.approx(600 / 6500)
    (life,) = csv_rows(tables / "load_life.csv")
    assert (life["failed_count"], life["suspended_count"]) == ("6", "1")
    # a load in pounds-force over the strength on the sheet of the specimen
    assert float(life["peak_load_ratio_low [1]"]) == pytest.approx(0.27)
    assert life["material"] == "nylon" and life["synthetic"] == "yes"


def test_the_archive_follows_cf_and_knows_its_table(run, folder):
    path = folder / "p" / "lines" / "outcomes.nc"
    with open_archive(path) as archive:
        assert archive.attrs["raw_file_sha256"] == run["results"]["sha256"]
        assert archive.attrs["synthetic"] == "yes"
        assert archive.attrs["history"].endswith(
            "outcomes: read 7 tensile_strength, 7 cycles_to_failure; 7 rows completed from sheets"
            " of specimens"
        )
        settings = json.loads(archive.attrs["settings"])
        assert settings["specimens"]["N-1"]["material"] == "nylon"
    done = held_against_cf(path)
    assert done.returncode == 0, done.stdout


def test_another_run_gives_the_same_bytes(command, run, folder, tmp_path):
    shutil.copytree(folder, tmp_path / "elsewhere", ignore=shutil.ignore_patterns("p", "r"))
    done = command(
        "run", "elsewhere/campaign.toml", "--processed", "p", "--reports", "r", cwd=tmp_path
    )
    assert done.returncode == 0
    assert "tables:   p/lines/tables: 4 tables, and columns.csv, which" in done.stdout
    again, before = tmp_path / "p" / "lines", folder / "p" / "lines"
    files = [path for path in before.rglob("*") if path.is_file() and path.name != "run.lock"]
    assert {path.name for path in files} >= {"outcomes.nc", "columns.csv", "finished-run.json"}
    assert len(files) == 8
    for path in files:
        assert (again / path.relative_to(before)).read_bytes() == path.read_bytes(), path.name
    page = Path("lines", "index.html")
    assert (tmp_path / "r" / page).read_bytes() == Path(run["report"]).read_bytes()


def test_a_report_is_made_again_from_the_archive_alone(command, run, folder, tmp_path):
    done = command("report", folder / "p" / "lines", "--reports", tmp_path)
    assert done.returncode == 0
    page = tmp_path / "lines" / "index.html"
    assert page.read_bytes() == Path(run["report"]).read_bytes()


def test_outcomes_stand_beside_tests_and_are_put_aside_without_their_table(command, tmp_path):
    folder = shutil.copytree(RAW, tmp_path / "raw")
    toml = folder / "campaign.toml"
    text = toml.read_text(encoding="utf-8")
    (folder / "results.csv").write_text(HEADER + BREAKS, encoding="utf-8")
    toml.write_text('results = "results.csv"\n' + text, encoding="utf-8")
    arguments = ("run", toml, "--processed", "p", "--reports", "r")
    done = command(*arguments, cwd=tmp_path)
    assert done.returncode == 0 and "results.csv: 6 outcomes" in done.stdout
    (products,) = (tmp_path / "p").iterdir()
    names = {path.name for path in (products / "tables").iterdir()}
    assert {"strength.csv", "exposure.csv", "specimens.csv"} <= names
    page = (tmp_path / "r" / products.name / "index.html").read_text(encoding="utf-8")
    assert 'id="outcomes"' in page and 'id="tested"' in page
    toml.write_text(text, encoding="utf-8")
    done = command(*arguments, cwd=tmp_path)
    assert "superseded/outcomes.nc: this campaign no longer makes it" in done.stderr
    assert (products / "superseded" / "outcomes.nc").is_file()
    assert not (products / "outcomes.nc").exists()
    assert not (products / "tables" / "strength.csv").exists()


def test_a_table_that_cannot_be_used_ends_with_its_row(command, tmp_path):
    (tmp_path / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (tmp_path / "results.csv").write_text(HEADER + BREAKS.replace("6400", "64OO"), encoding="utf-8")
    done = command("run", tmp_path / "campaign.toml", cwd=tmp_path)
    assert done.returncode == 3
    assert "results.csv:2 [value]: a value is not a number; found '64OO'" in done.stderr
    assert not (tmp_path / "processed").exists()
