"""A mass per length that a campaign states: in the archive, the tables, the look-up, the export."""

import json
import shutil
from pathlib import Path

import pytest
from commandruns import answered
from csvrows import csv_rows

from reduction.archive.open import open_archive

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"


@pytest.fixture(scope="module")
def processed(command, tmp_path_factory):
    folder = tmp_path_factory.mktemp("mass")
    shutil.copytree(RAW, folder / "c")
    path = folder / "c" / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    new, old = "[specimens.new]\n", "[specimens.used]\n"
    assert text.count(new) == 1
    stated = 'linear_density = "0.6 kg/m"\nwet_linear_density = "50 g/m"\n'
    path.write_text(text.replace(new, new + stated), encoding="utf-8")
    assert old in text
    done = command(
        "run", path, "--test", "T-1", "--processed", folder / "p", "--reports", folder / "r",
        "--quiet",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder / "p" / "tmt-synthetic"


def test_it_is_in_the_archive_of_whom_it_is_stated_for(processed):
    with open_archive(processed / "T-1.nc") as archive:
        assert archive["linear_density"].attrs["units"] == "kg m-1"
        assert archive["linear_density"].to_numpy()[0] == pytest.approx(0.6)
        assert archive["wet_linear_density"].to_numpy()[0] == pytest.approx(0.05)
        assert archive["linear_density"].isnull().to_numpy().tolist() == [False, True]


def test_an_archive_without_one_has_no_such_variable(synthetic):
    with open_archive(synthetic.processed / "T-1.nc") as archive:
        assert "linear_density" not in archive


def test_it_is_in_the_table_of_specimens(processed):
    rows = {row["specimen"]: row for row in csv_rows(processed / "tables" / "specimens.csv")}
    assert float(rows["new"]["linear_density [kg m-1]"]) == pytest.approx(0.6)
    assert rows["used"]["wet_linear_density [kg m-1]"] == ""


def test_it_is_part_of_every_answer_of_the_look_up(command, processed):
    ask = ("lookup", processed / "T-1.nc", "--line", "new", "--quantity", "tangent_modulus",
           "--strain", "100 %", "--branch", "ascending")  # fmt: skip
    answer = json.loads(command(*ask, "--json").stdout)
    assert answer["linear_density"] == pytest.approx(0.6)
    assert answer["wet_linear_density"] == pytest.approx(0.05)
    assert answer["linear_density_unit"] == "kg m-1"
    text = command(*ask).stdout
    assert "linear density in air: 0.6 kg/m" in text
    assert "linear density in water: 0.05 kg/m" in text
    other = command(*ask[:3], "used", *ask[4:], "--json")
    assert json.loads(other.stdout)["linear_density"] is None


@pytest.mark.parametrize("source", ["T-1.nc", ""], ids=["one test", "the composite"])
def test_an_export_needs_nobody_to_state_it_again(command, processed, tmp_path, source):
    done = command(
        "export", processed / source, "--specimen", "new", "--to", "moordyn", "--out",
        tmp_path / "t.dat", "--json",
    )  # fmt: skip
    assert answered(done)["linear_density"]["value"] == pytest.approx(0.6)
    refused = command(
        "export", processed / "T-1.nc", "--specimen", "used", "--to", "moordyn", "--out",
        tmp_path / "u.dat",
    )  # fmt: skip
    assert refused.returncode == 2
    assert "--linear-density" in refused.stderr
