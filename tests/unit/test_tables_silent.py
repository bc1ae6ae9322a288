"""Tests that do not keep what they share, beside others that do; and why a cell is empty."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from reduction.archive.dataset import to_dataset
from reduction.archive.open import open_archive
from reduction.archive.statederrors import says_what_is_shared
from reduction.archive.variable import measured
from reduction.archive.write import write_archive
from reduction.tables.column import Column, uncertainty_of
from reduction.tables.holes import column_descriptions, lonely_numbers
from reduction.tables.silent import as_silent, quantities_kept
from reduction.tables.table import SYNTHETIC
from reduction.tables.write import write_tables
from reduction.uncertainty.product import Component, Contributions

GAIN = 0.02


@pytest.fixture
def pair(rich_test, tmp_path):
    """One test that keeps what its load cell does to a segment, and one of an earlier version."""
    modulus = rich_test.segments.segment_modulus
    shared = Contributions((Component("tension_gain", "cell"),),
                           {"segment_modulus": GAIN * modulus[None]})  # fmt: skip
    kept = replace(rich_test, contributions=shared)
    about = replace(rich_test.description, test_id="T-0")
    old = replace(rich_test, description=about, contributions=None, settings_json="{}")
    paths = []
    for test in (old, kept):
        path = tmp_path / f"{test.description.test_id}.nc"
        write_archive(to_dataset(test, version="1", command="reduction run"), path)
        paths.append(path)
    return paths


def rows_of(folder, name):
    with (folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_beside_a_test_with_its_load_cell_one_of_scatter_alone_has_no_uncertainty(pair, tmp_path):
    write_tables(pair, tmp_path / "t")
    rows = rows_of(tmp_path / "t", "moduli")
    column = "segment_modulus_standard_uncertainty [Pa]"
    given = {name: {bool(row[column]) for row in rows if row["test"] == name}
             for name in {row["test"] for row in rows}}  # fmt: skip
    assert given.pop("T-0") == {False} and True in next(iter(given.values()))
    about = {row["column"]: row["no_uncertainty"]
             for row in rows_of(tmp_path / "t", "columns") if row["table"] == "moduli.csv"}  # fmt: skip
    assert "would count as exact; reduce it again" in about[column]


def test_alone_an_older_test_has_the_uncertainty_that_it_keeps(pair, tmp_path):
    write_tables(pair[:1], tmp_path / "t")
    column = "segment_modulus_standard_uncertainty [Pa]"
    assert any(row[column] for row in rows_of(tmp_path / "t", "moduli"))
    said = [row["no_uncertainty"] for row in rows_of(tmp_path / "t", "columns")]
    assert not any("count as exact" in one for one in said)


def test_what_no_test_shares_keeps_its_scatter(pair):
    with open_archive(pair[0]) as old, open_archive(pair[1]) as new:
        found = as_silent(old, quantities_kept(new))
        assert np.isnan(found["segment_modulus_standard_uncertainty"].values).all()
        assert found["frequency_standard_uncertainty"].equals(old["frequency_standard_uncertainty"])
        assert as_silent(new, quantities_kept(new)) is new


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({}, False),
        ({"uncertainty": {"tension_gain": 0.02}}, False),
        ({"uncertainty": {"tension_gain": 0.0}}, True),
    ],
)
def test_an_archive_says_what_it_shares_where_nothing_is_stated(settings, says):
    assert says_what_is_shared(xr.Dataset(attrs={"settings": json.dumps(settings)})) is says


def test_an_empty_cell_beside_a_number_has_a_reason_and_a_full_column_needs_none():
    diameter = Column("diameter", measured("diameter", ("specimen",))[0])
    columns = [diameter, uncertainty_of(diameter), SYNTHETIC]
    holed = lonely_numbers(columns, [["0.02", "0.02"], ["", "1e-4"], ["no", "no"]])
    full = lonely_numbers(columns, [["", "0.02"], ["", "1e-4"], ["no", "no"]])
    assert (holed, full) == ({1}, set())
    (_, of_holed, _) = column_descriptions(columns, holed)
    assert of_holed[-1] == (
        "is an uncertainty; empty where there is one reading, and nothing is stated of it"
    )
    (_, of_full, _) = column_descriptions(columns, full)
    assert of_full[-1] == "is an uncertainty"


def test_an_uncertainty_that_is_left_out_is_not_read(pair):
    with open_archive(pair[0]) as old, open_archive(pair[1]) as new:
        found = as_silent(old, quantities_kept(new))["segment_modulus_standard_uncertainty"]
        assert set(found.values.strides) == {0}
