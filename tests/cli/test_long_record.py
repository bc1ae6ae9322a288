"""A log above the longest record that is stored whole, from its file to its archive and page."""

import re

import numpy as np
import pytest
from csvrows import csv_rows

import reduction

pytestmark = pytest.mark.slow

CAMPAIGN = """
[campaign]
id = "long"
title = "Many cycles (synthetic)"
synthetic = true
[specimens.cord]
kind = "elastomer"
diameter = ["20 mm"]
gauge_length = "1 m"
[layouts.logger]
format = "delimited"
[layouts.logger.channels]
time = {{ column = "t", unit = "s" }}
crosshead_position = {{ column = "x", unit = "m", datum = "pin-to-pin" }}
tension.1 = {{ column = "F", unit = "N" }}
[uncertainty]
lag = "5 ms"
[tests.L-1]
layout = "logger"
specimens = ["cord"]
kind = "fatigue"
file = "log.csv"
reduction.archive.longest_record = 8000
reduction.modulus.selected_cycles = 10
{}
"""
N_CYCLES, PER_CYCLE, HELD = 120, 80, 900


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A hold of 90 s, 120 cycles of 8 s, a rest: 10 readings a second."""
    folder = tmp_path_factory.mktemp("long")
    stroke = np.abs((np.arange(N_CYCLES * PER_CYCLE) % PER_CYCLE) / (PER_CYCLE / 2) - 1)
    rise = np.interp(np.arange(200), [0, 100, 200], [0, 0, 1])
    position = np.concatenate([rise, np.full(HELD, 1.0), 0.5 + 0.5 * stroke, np.zeros(100)])
    side = np.gradient(position) * 300
    tension = 400 * position + 60 * position**3 + side
    noise = np.random.default_rng(5)
    columns = [
        np.arange(position.size) / 10,
        1.2 + position + noise.normal(0, 0.0005, position.size),
        tension + noise.normal(0, 0.5, position.size),
    ]
    np.savetxt(
        folder / "log.csv", np.column_stack(columns), delimiter=",", header="t,x,F", comments="",
        fmt="%.5f",
    )  # fmt: skip
    return folder


def run(command, folder, name, *lines):
    """Archive, status and message of a run."""
    campaign = folder / f"{name}.toml"
    campaign.write_text(CAMPAIGN.format("\n".join(lines)), encoding="utf-8")
    done = command(
        "run", campaign, "--processed", folder / name, "--reports", folder / f"{name}-page"
    )
    assert done.returncode == 0, done.stderr
    (row,) = csv_rows(folder / name / "long" / "status.csv")
    return folder / name / "long", row


@pytest.fixture(scope="module")
def part(command, folder):
    return run(command, folder, "part")


@pytest.fixture(scope="module")
def whole(command, folder):
    return run(command, folder, "whole", 'reduction.archive.samples = "all"')


def test_by_default_some_cycles_are_stored_and_every_number_is_that_of_the_whole(part, whole):
    with (
        reduction.open_campaign(part[0] / "L-1.nc") as kept,
        reduction.open_campaign(whole[0] / "L-1.nc") as all_of_it,
    ):
        index = kept["sample_index"].values
        assert index.size == int(kept["n_rows_stored"]) < 2000 < int(kept["n_rows_kept"])
        assert kept.sizes["cycle"] == all_of_it.sizes["cycle"] == pytest.approx(N_CYCLES, abs=1)
        assert {1, 2, 3, *kept["selected_cycle"].values} <= set(kept["cycle_number"].values)
        for name, variable in kept.variables.items():
            if name in ("sample_index", "n_rows_stored"):
                continue
            other = all_of_it[name].values
            expected = other[..., index] if "sample" in variable.dims else other
            np.testing.assert_array_equal(variable.values, expected, err_msg=name)
        for number in kept["selected_cycle"].values:
            first, last = (
                int(kept[f"cycle_{end}_sample"][number - 1]) for end in ("first", "last")
            )
            assert set(range(first, last + 1)) <= set(index)
    cycles = [folder / "tables" / "cycles.csv" for folder, _ in (part, whole)]
    assert cycles[0].read_bytes() == cycles[1].read_bytes()


def test_an_attribute_says_it_and_no_note(part, whole):
    with reduction.open_campaign(part[0] / "L-1.nc") as archive:
        assert archive.attrs["stored_samples"].startswith(f"{archive.sizes['sample']} of ")
    with reduction.open_campaign(whole[0] / "L-1.nc") as archive:
        assert archive.attrs["stored_samples"] == "all"


def test_the_page_draws_no_line_across_what_is_left_out(part, folder):
    page = (folder / "part-page" / "long" / "index.html").read_text(encoding="utf-8")
    assert "are stored; the line is broken where cycles are left out" in page
    assert "last cycle of those whose samples are stored" in page


def test_a_changed_key_makes_the_test_anew_and_an_unchanged_one_does_not(command, folder):
    _, first = run(command, folder, "again")
    _, second = run(command, folder, "again")
    archive, third = run(command, folder, "again", 'reduction.archive.samples = "all"')
    assert first["status"] == third["status"] == "reduced"
    assert second["status"] == "unchanged"
    with reduction.open_campaign(archive / "L-1.nc") as found:
        assert re.search('"samples": "all"', found.attrs["settings"])
        assert "sample_index" not in found


def test_a_word_that_is_no_choice_is_refused(command, folder):
    campaign = folder / "wrong.toml"
    campaign.write_text(CAMPAIGN.format('reduction.archive.samples = "some"'), encoding="utf-8")
    done = command("check", campaign)
    assert done.returncode == 2
    message = " ".join(done.stderr.split())
    assert "reduction.archive.samples is unknown; found 'some'; needed \"selected\" or" in message
