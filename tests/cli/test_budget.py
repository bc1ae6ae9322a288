"""The command budget on a synthetic campaign."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import open_archive
from reduction.cli.main import app

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
STATED = """
[uncertainty]
lag = "5 ms"
diameter = "0.005 in"
[uncertainty.tension]
gain = { expanded = "0.5 %", k = 2 }
offset = "0.5 lbf"
[uncertainty.crosshead_position]
gain = "0.1 %"
"""


def run(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


@pytest.fixture(scope="module")
def product(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stated")
    for name in ("T-1.csv", "marks.csv"):
        shutil.copy(RAW / name, folder)
    text = (RAW / "campaign.toml").read_text(encoding="utf-8")
    # with what this test states in place of what the campaign does
    before, _, after = text.partition("[uncertainty]")
    head, _, tests = (before + after[after.index("[defaults]") :]).partition("[tests.T-1]")
    only = tests.partition("[tests.T-2]")[0]
    marks = (RAW / "marks.csv").read_text(encoding="utf-8").splitlines()
    kept = [line for line in marks if not line.startswith("T-") or line.startswith("T-1,")]
    (folder / "marks.csv").write_text("\n".join(kept) + "\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(f"{head}[tests.T-1]{only}{STATED}", encoding="utf-8")
    found = run(
        "run", folder / "campaign.toml", "--processed", folder / "p", "--reports", folder / "r"
    )
    assert found.exit_code == 0, found.output
    return folder / "p" / "tmt-synthetic" / "T-1.nc"


def answer(product, *arguments):
    found = run("budget", product, *arguments, "--json")
    assert found.exit_code == 0, found.output
    return json.loads(found.output)


def test_the_diameter_enters_a_modulus_twice_and_a_gain_once(product):
    told = answer(
        product, "--quantity", "segment_modulus", "--at", "specimen=new", "--at",
        "branch=ascending", "--at", "segment=1",
    )  # fmt: skip
    by_source = {row["source"]: row for row in told["sources"]}
    assert by_source["diameter"]["contribution"] / told["value"] == pytest.approx(
        -2 * 0.005 / 1.04, rel=1e-6
    )
    # strain is what the tape says: the gain of the cell is in the tension alone
    assert by_source["tension_gain"]["contribution"] / told["value"] == pytest.approx(
        0.0025, rel=0.01
    )
    assert told["synthetic"] is True
    assert sum(row["share"] for row in told["sources"]) == pytest.approx(1)
    shares = [row["share"] for row in told["sources"]]
    assert shares == sorted(shares, reverse=True)


def test_a_spring_constant_knows_no_diameter(product):
    told = answer(product, "--quantity", "apparent_spring_constant", "--at", "specimen=new")
    assert told["quantity"] == "test_apparent_spring_constant"
    assert "diameter" not in {row["source"] for row in told["sources"]}


def test_the_parts_make_the_uncertainty_of_the_archive(product):
    told = answer(product, "--quantity", "hysteresis_energy", "--at", "specimen=used")
    with open_archive(product) as archive:
        kept = archive["test_hysteresis_energy_standard_uncertainty"].values[1]
    parts = np.sqrt(sum(row["contribution"] ** 2 for row in told["sources"]))
    assert told["standard_uncertainty"] == pytest.approx(kept) == pytest.approx(parts)


def test_without_a_quantity_it_says_what_there_is(product):
    assert "segment_modulus" in answer(product)["quantities"]


def test_places_have_the_names_by_which_they_are_asked_for(product):
    listed = run("budget", product).output
    assert "specimen, branch, strain" in listed
    assert "branch_name" not in listed and "strain_bin" not in listed
    told = run("budget", product, "--quantity", "tangent_modulus_first_loading", "--at",
               "specimen=new", "--at", "branch=ascending", "--at", "strain=90 %")  # fmt: skip
    assert told.exit_code == 0, told.output
    assert "branch ascending, strain 0.9" in told.output
    # the machine is a sentence in the campaign, and stands there whole
    assert "simulated linear drive (after TMT, WHOI-2005-10 sec. 3.2)" in told.output
    away = run("budget", product, "--quantity", "tangent_modulus", "--at", "specimen=new", "--at",
               "branch=descending", "--at", "strain=131 %")  # fmt: skip
    assert "found specimen=new, branch=descending, strain=1.3" in away.output
    assert "needed strain 0." in away.output


def test_the_screen_says_that_the_data_are_synthetic(product):
    found = run("budget", product, "--quantity", "loss_factor", "--at", "specimen=new")
    assert "synthetic" in found.output and "k = " in found.output


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["--quantity", "colour"], 2, "is not in this archive"),
        (["--quantity", "loss_factor", "--at", "specimen"], 2, "--at is not understood"),
        (["--quantity", "loss_factor"], 2, "specimen is not stated"),
        (["--quantity", "tangent_modulus", "--at", "strain=1 ft"], 2, "ft"),
    ],
)
def test_what_is_no_number_is_refused(product, arguments, status, words):
    found = run("budget", product, *arguments)
    assert found.exit_code == status
    assert words in found.output


def test_a_file_that_is_no_archive_is_refused(tmp_path):
    (tmp_path / "a.nc").write_text("no", encoding="utf-8")
    assert run("budget", tmp_path / "a.nc", "--quantity", "loss_factor").exit_code == 6


@pytest.mark.parametrize(("method", "is_said"), [(1, False), (2, True)])
def test_a_budget_of_what_was_drawn_says_that_the_product_states_another(tmp_path, method, is_said):
    name, component = "test_relaxation_time", "uncertainty_component"
    made = xr.Dataset(
        {
            name: ("specimen", [4.0], {"units": "s"}),
            f"{name}_standard_uncertainty": ("specimen", [0.75]),
            f"{name}_random_standard_uncertainty": ("specimen", [0.3]),
            f"{name}_uncertainty_contribution": ((component, "specimen"), [[0.4]]),
            "test_line_uncertainty_method": ("specimen", [method]),
            "uncertainty_source": (component, ["quasi_static_fit"]),
            "uncertainty_source_of": (component, ["line"]),
            "uncertainty_source_number": (component, [0]),
        },
        coords={"specimen": ["line"]},
        attrs={"schema_version": SCHEMA_VERSION},
    )
    made.to_netcdf(tmp_path / "made.nc")
    found = run("budget", tmp_path / "made.nc", "--quantity", "relaxation_time")
    assert found.exit_code == 0, found.output
    said = "the archive states 0.75 s, by Monte Carlo" in " ".join(found.output.split())
    assert said == is_said


def test_the_names_of_a_look_up_are_known(product):
    at = ("--at", "specimen=new")
    assert answer(product, "--quantity", "K_ap", *at)["quantity"] == "test_apparent_spring_constant"
    at = (*at, "--at", "branch=ascending", "--at", "strain=100 %")
    assert answer(product, "--quantity", "tension", *at)["quantity"] == "branch_tension"


def test_a_product_that_keeps_nothing_shared_says_so_in_a_sentence(product, tmp_path):
    with open_archive(product) as archive:
        kept = [name for name in archive.variables if "uncertainty_contribution" not in str(name)]
        archive[kept].load().to_netcdf(tmp_path / "old.nc", engine="netcdf4")
    found = run("budget", tmp_path / "old.nc")
    assert found.exit_code == 0
    assert "old.nc has no shared errors, and so no budgets" in " ".join(found.output.split())
    assert "--at" not in found.output
