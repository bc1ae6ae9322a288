"""``reduction catalogue``: what a person asks, and what is said."""

import json
import shutil

import pyarrow.parquet
import pytest
from commandruns import answered


@pytest.fixture(scope="module")
def processed(synthetic, static, tmp_path_factory):
    """Both campaigns side by side, as their runs left them."""
    folder = tmp_path_factory.mktemp("catalogue")
    for run in (synthetic, static):
        shutil.copytree(run.processed, folder / run.processed.name)
    return folder


def rows_of(done):
    return answered(done)["rows"]


def test_a_question_is_answered_as_a_table(command, processed):
    done = command(
        "catalogue", processed, "--kind", "cyclic", "--specimen", "new",
        "--where", "frequency >= 0.09 Hz", "--quantity", "apparent_spring_constant",
        "--sort", "apparent_spring_constant", "--descending", "--limit", "2",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    head, *lines = done.stdout.splitlines()
    assert "test_apparent_spring_constant [N]" in head and "standard uncertainty [N]" in head
    # the stiffest window is the one about the greatest stretch
    assert [line.split()[1] for line in lines[:2]] == ["T-6", "T-5"]
    assert all(" yes " in line for line in lines[:2])  # synthetic
    assert lines[-1] == "2 rows"


def test_json_is_one_object_with_units_and_numbers_of_the_archive(command, processed):
    done = command("catalogue", processed, "--test", "T-1", "--quantity", "K_ap", "--json")
    answer = json.loads(done.stdout)
    assert answer["units"]["test_apparent_spring_constant"] == "N"
    assert answer["unreadable"] == {}
    assert [row["specimen"] for row in answer["rows"]] == ["new", "used"]
    assert all(
        row["test_apparent_spring_constant_standard_uncertainty"] > 0 for row in answer["rows"]
    )


def test_units_of_the_terminal_are_those_asked_for(command, processed):
    si = command("catalogue", processed, "--test", "T-1").stdout
    us = command("catalogue", processed, "--test", "T-1", "--units", "us").stdout
    assert "mean_tension [N]" in si and "mean_tension [lbf]" in us


def test_one_table_over_all_campaigns_is_written(command, processed, tmp_path):
    path = tmp_path / "all.parquet"
    done = command("catalogue", processed, "--quantity", "secant_modulus", "--export", path)
    assert done.returncode == 0, done.stderr
    table = pyarrow.parquet.read_table(path)
    assert set(table["campaign"].to_pylist()) == {"tmt-synthetic", "buoy-technology-1997"}
    assert {"cycle", "step"} <= set(table.column_names)
    assert table.schema.field("secant_modulus").metadata[b"units"] == b"Pa"


def test_what_there_is_is_listed_with_its_unit(command, processed):
    done = command("catalogue", processed, "--list", "--json")
    found = json.loads(done.stdout)["quantities"]
    assert found["segment_modulus"]["unit"] == "Pa"
    shown = command("catalogue", processed, "--list").stdout
    assert "segment_modulus" in shown


def test_a_broken_archive_is_named_on_standard_error_and_the_rest_is_answered(
    command, processed, tmp_path
):
    folder = tmp_path / "processed"
    shutil.copytree(processed, folder)
    (folder / "tmt-synthetic" / "T-2.nc").write_bytes(b"not netCDF")
    done = command("catalogue", folder, "--kind", "cyclic", "--rebuild", "--json")
    tests = {row["test"] for row in rows_of(done)}
    assert "T-1" in tests and "T-2" not in tests
    assert (
        done.stderr.startswith("left out: ")
        and "T-2.nc cannot be read as a netCDF file" in done.stderr
    )
    assert list(json.loads(done.stdout)["unreadable"]) == ["tmt-synthetic/T-2.nc"]


def test_a_removed_archive_is_gone_at_the_next_question(command, processed, tmp_path):
    folder = tmp_path / "processed"
    shutil.copytree(processed, folder)
    before = {row["test"] for row in rows_of(command("catalogue", folder, "--json"))}
    (folder / "tmt-synthetic" / "T-2.nc").unlink()
    done = command("catalogue", folder, "--json")
    assert before - {row["test"] for row in rows_of(done)} == {"T-2"} and done.stderr == ""


def test_a_campaign_without_its_catalogue_is_told_with_what_to_do(command, processed, tmp_path):
    folder = tmp_path / "processed"
    shutil.copytree(processed, folder)
    (folder / "tmt-synthetic" / "catalogue.parquet").unlink()
    done = command("catalogue", folder, "--json")
    assert {row["campaign"] for row in rows_of(done)} == {"buoy-technology-1997"}
    assert done.stderr == (
        "left out: tmt-synthetic: catalogue.parquet cannot be read; found No such file or "
        "directory. Run the campaign again, or use --rebuild.\n"
    )


def test_catalogues_made_from_the_archives_are_those_of_the_runs(command, processed, tmp_path):
    folder = tmp_path / "processed"
    shutil.copytree(processed, folder)
    made = {path: path.read_bytes() for path in folder.glob("*/catalogue.parquet")}
    assert len(made) == 2
    (folder / "tmt-synthetic" / "catalogue.parquet").unlink()
    done = command("catalogue", folder, "--rebuild", "--quiet")
    assert done.returncode == 0 and done.stderr == ""
    assert {path: path.read_bytes() for path in made} == made


def test_a_name_in_brackets_is_shown_as_it_is(command, static, tmp_path):
    folder = tmp_path / "processed" / "[red]hot[bold]"
    shutil.copytree(static.processed, folder)
    done = command("catalogue", folder.parent, "--json")
    assert [row["archive"] for row in rows_of(done)] == ["[red]hot[bold]/static.nc"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--where", "frequency is high"], "--where is not a condition"),
        (["--where", "frequency > 1 m"], "unit 'm' is not a unit of frequency"),
        (["--quantity", "stiffness_of_all"], "--quantity names no quantity"),
        (["--export", "all.xlsx"], "--export does not know this file ending"),
        (["--limit", "0"], "--limit"),
    ],
)  # fmt: skip
def test_a_question_that_is_none_is_refused(command, processed, options, words):
    done = command("catalogue", processed, *options)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_a_folder_that_is_not_there_is_refused(command, tmp_path):
    done = command("catalogue", tmp_path / "nowhere")
    assert done.returncode == 2 and "there is no folder" in done.stderr


def test_a_question_opens_no_archive(process, processed):
    done = process(
        "catalogue", processed, "--test", "T-1", "--where", "frequency > 0 Hz", "--json",
        PYTHONPROFILEIMPORTTIME="1",
    )  # fmt: skip
    assert done.returncode == 0
    modules = {line.split("|")[-1].strip() for line in done.stderr.splitlines() if "|" in line}
    assert "pyarrow" in modules
    assert not modules & {"xarray", "netCDF4"}
