"""A product is made anew when what its uncertainty rests on has changed, and only then."""

import json
import shutil
from pathlib import Path

import pytest

from reduction.archive.open import open_archive
from reduction.archive.shared_errors import shared_contributions

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
CAMPAIGN = """
[campaign]
id = "pair"
title = "Two tests of one tether (synthetic)"
source = "synthetic"
synthetic = true
[specimens.new]
kind = "rubber tether"
diameter = ["1.04 in"]
gauge_length = "8.38 ft"
gauge_length_standard_uncertainty = "0.05 ft"
[layouts.logger]
format = "delimited"
comment = "#"
[layouts.logger.channels]
time = { column = "time_s", unit = "s" }
crosshead_position = { column = "crosshead_ft", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "load_new_lb", unit = "lbf" }
[uncertainty.tension]
gain = "0.25 %"
[defaults]
layout = "logger"
specimens = ["new"]
strain = { marks = "marks.csv" }
[tests.A]
file = "A.csv"
load_cell = "first"
[tests.B]
file = "B.csv"
load_cell = "second"
"""


@pytest.fixture(scope="module")
def reduced_once(tmp_path_factory, command):
    folder = tmp_path_factory.mktemp("pair")
    for name, log in {"A": "T-1", "B": "T-2"}.items():
        shutil.copy(RAW / f"{log}.csv", folder / f"{name}.csv")
    rows = [
        line.split(",")
        for line in (RAW / "marks.csv").read_text().splitlines()
        if line.startswith(("test,", "T-1,new,", "T-2,new,"))
    ]
    rows = [[{"T-1": "A", "T-2": "B"}.get(cells[0], cells[0]), *cells[1:]] for cells in rows]
    (folder / "marks.csv").write_text("\n".join(map(",".join, rows)) + "\n")
    (folder / "campaign.toml").write_text(CAMPAIGN)
    statuses = run(folder, command)
    assert statuses == {"A": "check", "B": "check"}
    return folder


@pytest.fixture
def pair(reduced_once, tmp_path):
    shutil.copytree(reduced_once, tmp_path, dirs_exist_ok=True)
    return tmp_path


def run(folder, command):
    done = command("run", folder / "campaign.toml", "--json", cwd=folder)
    return {test["id"]: test["status"] for test in json.loads(done.stdout)["tests"]}


def edit(path, *change):
    text = path.read_text()
    assert change[0] in text
    path.write_text(text.replace(*change, 1))


def shared_of(folder, test, source, quantity="test_strain_amplitude"):
    """What errors of one source add to a number of a test, by their owner: root of the squares."""
    with open_archive(folder / "processed" / "pair" / f"{test}.nc") as archive:
        found = {}
        for one, value in shared_contributions(archive, quantity, 0).items():
            if one.source == source:
                found[one.of] = found.get(one.of, 0.0) + value**2
    return {of: square**0.5 for of, square in found.items()}


def break_log(folder, name):
    lines = (folder / name).read_text().splitlines()
    lines[1000] = "99.7,ovrflw,1,1"
    (folder / name).write_text("\n".join(lines) + "\n")


def content(folder, test):
    return (folder / "processed" / "pair" / f"{test}.nc").read_bytes()


def test_a_tape_that_is_read_to_more_digits_makes_the_tests_of_its_specimen_anew(pair, command):
    assert run(pair, command) == {"A": "unchanged", "B": "unchanged"}
    before = shared_of(pair, "B", "strain_calibration")
    edit(pair / "marks.csv", ",2.06,", ",2.060,")  # the same length, read to a thousandth of a foot
    assert run(pair, command) == {"A": "check", "B": "check"}
    assert shared_of(pair, "B", "strain_calibration") != before


def test_another_load_cell_at_the_marks_makes_the_tests_that_rest_on_them_anew(pair, command):
    assert set(shared_of(pair, "B", "tension_gain")) == {"first, channel 1", "second, channel 1"}
    edit(pair / "campaign.toml", '"first"', '"third"')
    assert run(pair, command) == {"A": "check", "B": "check"}
    assert set(shared_of(pair, "B", "tension_gain")) == {"third, channel 1", "second, channel 1"}


def test_tests_that_rest_on_the_marks_of_one_that_fails_are_made_anew(pair, command):
    before = content(pair, "B")
    sound = (pair / "A.csv").read_text()
    break_log(pair, "A.csv")
    assert run(pair, command) == {"A": "failed", "B": "check"}
    assert content(pair, "B") != before
    assert run(pair, command) == {"A": "failed", "B": "unchanged"}
    (pair / "A.csv").write_text(sound)
    assert run(pair, command) == {"A": "unchanged", "B": "check"}
    assert content(pair, "B") == before


@pytest.mark.nightly
def test_the_law_by_which_a_strain_ratio_is_judged_is_of_all_logs_with_marks(pair, command):
    by_position = ("[tests.A]\n", '[tests.A]\nstrain = { method = "strain-ratio" }\n')
    edit(pair / "campaign.toml", *by_position)
    assert run(pair, command) == {"A": "check", "B": "unchanged"}
    before = shared_of(pair, "A", "splice_method")
    lines = (pair / "B.csv").read_text().splitlines()
    names = next(line for line in lines if not line.startswith("#")).split(",")
    load = names.index("load_new_lb")
    begin = lines.index(",".join(names)) + 1
    for row, line in enumerate(lines[begin:], start=begin):
        cells = line.split(",")
        cells[load] = f"{1.2 * float(cells[load]):.3f}"
        lines[row] = ",".join(cells)
    (pair / "B.csv").write_text("\n".join(lines) + "\n")
    assert run(pair, command) == {"A": "check", "B": "check"}
    assert shared_of(pair, "A", "splice_method") != before


def test_strain_methods_of_one_specimen_share_no_error_and_one_method_of_two_tests_does(
    pair, command
):
    owners = [set(shared_of(pair, test, "strain_calibration")) for test in "AB"]
    assert owners[0] == owners[1] == {"new, mixed"}
    by_length = ("[tests.B]\n", '[tests.B]\nstrain = { method = "gauge-length" }\n')
    edit(pair / "campaign.toml", *by_length)
    assert run(pair, command)["B"] == "check"
    assert set(shared_of(pair, "A", "strain_calibration")) == {"new, mixed"}
    assert set(shared_of(pair, "B", "strain_calibration")) == {"new, gauge-length"}
    # a gauge length rests on no mark
    before = content(pair, "B")
    edit(pair / "marks.csv", ",2.06,", ",2.060,")
    assert run(pair, command) == {"A": "check", "B": "unchanged"}
    assert content(pair, "B") == before


def test_a_test_that_is_parted_into_steps_is_put_aside_and_nothing_answers_from_it(pair, command):
    steps = "".join(
        f'[[tests.B.steps]]\nname = "{name}"\nfrom = "{low} s"\nto = "{high} s"\n'
        for name, low, high in (("first", 0, 300), ("second", 300, 2000))
    )
    with (pair / "campaign.toml").open("a", encoding="utf-8") as stream:
        stream.write(steps)
    run(pair, command)
    products = pair / "processed" / "pair"
    assert (products / "superseded" / "B.nc").is_file()
    found = command("lookup", products, "--line", "B new", "--quantity", "tangent_modulus",
                    "--strain", "100 %", cwd=pair)  # fmt: skip
    assert found.returncode != 0 and "superseded" not in found.stdout
    page = (pair / "reports" / "pair" / "index.html").read_text(encoding="utf-8")
    assert 'id="B"' not in page
