"""What a specimen had seen before a test: from logs, from weights, and where an earlier test failed."""

import hashlib
import json
import shutil

import numpy as np
import pytest

import reduction.batch.reduce_tests
import reduction.batch.requested_products
from reduction.archive.open import open_archive

pytestmark = pytest.mark.slow

CAMPAIGN = """
[campaign]
id = "row"
title = "Four tests of one cord"
synthetic = true
[specimens.cord]
kind = "elastomer"
diameter = ["10 mm"]
gauge_length = "1.2 m"
[layouts.logger]
format = "delimited"
[layouts.logger.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "m", datum = "displacement" }
tension.1 = { column = "F", unit = "N" }
[layouts.weights]
format = "delimited"
[layouts.weights.channels]
time = { column = "t", unit = "s" }
tension.1 = { column = "F", unit = "N" }
gauge_length = { column = "length", unit = "m", standard_uncertainty = "0.5 mm" }
[uncertainty]
lag = "1 ms"
[defaults]
layout = "logger"
specimens = ["cord"]
[tests.A]
file = "A.csv"
order = 1
[tests.weights]
file = "weights.csv"
layout = "weights"
kind = "stepwise"
order = 2
[tests.B]
file = "B.csv"
order = 3
[tests.C]
file = "C.csv"
order = 4
"""
NUMBERS = ("earlier_maximum_strain", "earlier_maximum_tension", "earlier_cycles")
# greatest strain [1], greatest tension [N] and cycles: 2000 N/m on 1.2 m, as drawn below
DRAWN = {"A": (0.25, 600, 10), "weights": (0.35, 840, 0), "B": (0.2, 480, 12)}


def write_log(path, low, high, n_cycles, seed):
    """Cycles of 10 s between two displacements from slack."""
    time = np.arange(0, 10 * n_cycles + 0.05, 0.1)
    position = low + (high - low) * (1 - np.abs(time / 5 % 2 - 1))
    generator = np.random.default_rng(seed)
    columns = [
        time,
        position + generator.normal(0, 1e-4, time.size),
        2000 * position + generator.normal(0, 0.2, time.size),
    ]
    np.savetxt(path, np.column_stack(columns), fmt="%.5f", delimiter=",", header="t,x,F",
               comments="")  # fmt: skip


def write_row(tmp_path):
    write_log(tmp_path / "A.csv", 0.1, 0.3, 10, 1)
    write_log(tmp_path / "B.csv", 0.1, 0.24, 12, 2)
    write_log(tmp_path / "C.csv", 0.1, 0.2, 8, 3)
    forces = np.array([240, 480, 720, 840, 600, 360])
    lengths = 1.2 * (1 + forces / 2400)
    lines = [
        f"{600 * i},{f},{x:.4f}\n" for i, (f, x) in enumerate(zip(forces, lengths, strict=True))
    ]
    (tmp_path / "weights.csv").write_text("t,F,length\n" + "".join(lines))
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    return tmp_path


@pytest.fixture
def row(tmp_path):
    return write_row(tmp_path)


@pytest.fixture(scope="module")
def run_once(tmp_path_factory, command):
    folder = write_row(tmp_path_factory.mktemp("row"))
    assert all(test["status"] != "failed" for test in run(folder, command).values())
    return folder


@pytest.fixture
def row_with_products(run_once, tmp_path):
    """The four tests and what a run of them made, to be changed at will."""
    return shutil.copytree(run_once, tmp_path, dirs_exist_ok=True)


def run(folder, command, *options):
    done = command("run", folder / "campaign.toml", "--json", *options, cwd=folder)
    return {test["id"]: test for test in json.loads(done.stdout)["tests"]}


def history(folder, test):
    with open_archive(folder / "processed" / "row" / f"{test}.nc") as archive:
        numbers = tuple(float(archive[name].values[0]) for name in NUMBERS)
        notes = archive["note"].values.tolist() if "note" in archive else []
        return str(archive["earlier_tests"].values[0]), numbers, notes


def break_log(folder, name):
    lines = (folder / name).read_text().splitlines()
    lines[100] = "ovrflw,1,1"
    (folder / name).write_text("\n".join(lines) + "\n")


def greatest(tests):
    strain, tension, cycles = np.array([DRAWN[test] for test in tests]).T
    return strain.max(), tension.max(), cycles.sum()


def test_weights_are_in_the_history_and_have_one(run_once):
    row = run_once
    for test, earlier in (
        ("weights", ["A"]),
        ("B", ["A", "weights"]),
        ("C", ["A", "weights", "B"]),
    ):
        names, numbers, notes = history(row, test)
        assert names == ", ".join(earlier)
        assert numbers == pytest.approx(greatest(earlier), rel=3e-3)
        # the weights are the greatest load of the four
        told = [
            one
            for one in notes
            if one.startswith("cord: test weights loaded the specimen to 840 N")
        ]
        assert len(told) == (test in "BC")
    names, numbers, _ = history(row, "A")
    assert names == "" and np.isnan(numbers[:2]).all() and numbers[2] == 0


def test_what_a_failed_test_did_is_not_known_and_is_said(row, command):
    break_log(row, "A.csv")
    statuses = run(row, command)
    assert [statuses[test]["status"] for test in ("A", "B")] == ["failed", "reduced"]
    for test in ("weights", "B", "C"):
        names, numbers, notes = history(row, test)
        assert names.startswith("A")
        assert np.isnan(numbers).all()
        assert (
            "earlier test A failed: its effect on cord is not known, so earlier_cycles, "
            "earlier_maximum_strain and earlier_maximum_tension are missing"
        ) in notes


def test_products_are_made_anew_without_an_earlier_test_that_fails_and_with_it_when_it_is_mended(
    row_with_products, command
):
    row = row_with_products
    folder = row / "processed" / "row"
    before = {path.name: path.read_bytes() for path in folder.glob("*.nc")}
    sound = (row / "A.csv").read_text()
    break_log(row, "A.csv")
    statuses = run(row, command)
    assert statuses["A"]["status"] == "failed"
    for test in ("weights", "B", "C"):
        assert statuses[test]["status"] == "reduced"
        names, numbers, notes = history(row, test)
        assert names.startswith("A") and np.isnan(numbers).all()
        assert any(note.startswith("earlier test A failed") for note in notes)
    assert (folder / "A.nc").read_bytes() == before["A.nc"]
    again = run(row, command)
    assert {again[test]["status"] for test in ("weights", "B", "C")} == {"unchanged"}
    (row / "A.csv").write_text(sound)
    statuses = run(row, command)
    assert statuses["A"]["status"] == "unchanged"
    assert statuses["B"]["status"] == "reduced"
    assert {path.name: path.read_bytes() for path in folder.glob("*.nc")} == before


def test_a_product_made_while_one_test_failed_does_not_stand_for_another(row, command):
    sound = (row / "A.csv").read_text()
    break_log(row, "A.csv")
    run(row, command)
    (row / "A.csv").write_text(sound)
    break_log(row, "B.csv")
    statuses = run(row, command)
    assert statuses["weights"]["status"] == "reduced"
    assert statuses["C"]["status"] == "reduced"
    assert any(note.startswith("earlier test B failed") for note in history(row, "C")[2])


def test_a_warning_goes_with_the_other_test_that_caused_it(row_with_products, command):
    row = row_with_products
    product = row / "processed" / "row" / "B.nc"
    before = product.read_bytes()
    shutil.copy(row / "B.csv", row / "D.csv")
    text = (row / "campaign.toml").read_text()
    (row / "campaign.toml").write_text(text + '[tests.D]\nfile = "D.csv"\norder = 5\n')
    twice = "its log is identical to that of test D"
    assert twice in run(row, command)["B"]["message"]
    assert twice in run(row, command)["B"]["message"]  # unchanged
    (row / "campaign.toml").write_text(text)
    assert twice not in run(row, command)["B"]["message"]
    assert product.read_bytes() == before


def test_a_setting_of_its_own_makes_a_product_anew_beside_a_failed_test(row_with_products, command):
    row = row_with_products
    break_log(row, "A.csv")
    text = (row / "campaign.toml").read_text()
    (row / "campaign.toml").write_text(text.replace('["10 mm"]', '["11 mm"]'))
    assert run(row, command)["B"]["status"] == "reduced"


def test_an_earlier_test_that_is_new_and_fails_makes_the_later_ones_anew(
    row_with_products, command
):
    row = row_with_products
    (row / "new.csv").write_text("t,x,F\n0,0,ovrflw\n")
    text = (row / "campaign.toml").read_text()
    (row / "campaign.toml").write_text(text + '[tests.new]\nfile = "new.csv"\norder = 0\n')
    statuses = run(row, command)
    assert statuses["new"]["status"] == "failed"
    assert statuses["B"]["status"] == "reduced"
    assert np.isnan(history(row, "B")[1]).all()


@pytest.mark.parametrize(
    ("module", "part"),
    [
        (reduction.batch.requested_products, "basis_of"),
        (reduction.batch.reduce_tests, "reusable_product"),
    ],
)
def test_a_defect_before_the_reduction_is_the_failure_of_one_test(
    row, command, monkeypatch, module, part
):
    sound = getattr(module, part)

    def spoilt(*arguments, **more):
        if any(getattr(getattr(one, "plan", None), "id", "") == "B" for one in arguments):
            raise ZeroDivisionError("for the test")
        return sound(*arguments, **more)

    monkeypatch.setattr(module, part, spoilt)
    statuses = run(row, command)
    assert statuses["B"]["status"] == "failed" and statuses["B"]["exit_status"] == 1
    assert "a defect of this program: ZeroDivisionError: for the test" in statuses["B"]["message"]
    assert [statuses[test]["status"] for test in ("A", "C")] == 2 * ["reduced"]


def test_a_run_tells_the_rate_and_the_gaps_that_it_was_drawn_with(row, command):
    lines = (row / "A.csv").read_text().splitlines()
    (row / "A.csv").write_text("\n".join(lines[:500] + lines[540:]) + "\n")  # 4 s are not there
    for found in (run(row, command), run(row, command)):  # reduced, and then unchanged
        assert found["A"]["found"]["rate"]["value"] == pytest.approx(10.0)
        assert found["A"]["found"]["gaps"] == 1
        assert found["C"]["found"]["gaps"] == 0


def test_a_log_in_steps_has_each_in_the_history_and_one_that_fails_is_one_earlier_test(
    row, command
):
    text = (row / "campaign.toml").read_text()
    steps = "".join(
        f'[[tests.A.steps]]\nname = "{name}"\nfrom = "{low} s"\nto = "{high} s"\n'
        for name, low, high in (("first", 0, 50), ("second", 50, 100))
    )
    (row / "campaign.toml").write_text(text.replace("[tests.weights]", steps + "[tests.weights]"))
    assert {"A.first", "A.second"} < set(run(row, command))
    names, numbers, _ = history(row, "B")
    assert names == "A.first, A.second, weights"
    assert numbers == pytest.approx(greatest(["A", "weights"]), rel=3e-3)
    break_log(row, "A.csv")
    statuses = run(row, command)
    assert statuses["A"]["status"] == "failed"
    assert statuses["B"]["status"] == "reduced"
    names, numbers, _ = history(row, "B")
    assert names == "A, weights" and np.isnan(numbers).all()


def test_a_spike_is_told_in_the_step_in_which_it_is(row, command):
    lines = (row / "A.csv").read_text().splitlines()
    place = 1 + next(at for at, line in enumerate(lines) if line.startswith("30.0"))
    *before, load = lines[place].split(",")
    lines[place] = ",".join([*before, str(float(load) + 100)])
    (row / "A.csv").write_text("\n".join(lines) + "\n")
    steps = "".join(
        f'[[tests.A.steps]]\nname = "{name}"\nfrom = "{low} s"\nto = "{high} s"\n'
        for name, low, high in (("first", 0, 50), ("second", 50, 100))
    )
    text = (row / "campaign.toml").read_text()
    (row / "campaign.toml").write_text(text.replace("[tests.weights]", steps + "[tests.weights]"))
    run(row, command)
    told = []
    for name in ("first", "second"):
        with open_archive(row / "processed" / "row" / f"A.{name}.nc") as archive:
            told.append("rows-flagged" in archive["note_code"].values.tolist())
    assert told == [True, False]


def test_a_step_is_reduced_again_where_its_range_moves(row, command):
    step = '[[tests.A.steps]]\nname = "first"\nfrom = "{} s"\nto = "{} s"\n'
    text = (row / "campaign.toml").read_text()
    for low, high in ((0, 50), (0, 90), (30, 90)):
        (row / "campaign.toml").write_text(
            text.replace("[tests.weights]", step.format(low, high) + "[tests.weights]")
        )
        assert run(row, command)["A.first"]["status"] == "reduced"
        with open_archive(row / "processed" / "row" / "A.first.nc") as archive:
            ends = [float(archive["time"][place]) for place in (0, -1)]
        assert ends == pytest.approx([low, high])
    assert run(row, command)["A.first"]["status"] == "unchanged"


def test_each_product_has_the_key_of_its_settings(run_once):
    for path in (run_once / "processed" / "row").glob("*.nc"):
        with open_archive(path) as archive:
            settings = archive.attrs["settings"].encode()
            assert archive.attrs["key"] == hashlib.sha256(settings).hexdigest()
