"""Any monotone curve becomes a valid file of every format, within the error that the file states."""

import csv
import io
import json
import re
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import xarray as xr
from examples import examples
from export_lines import line
from export_readers import (
    CableExpression,
    abaqus,
    cable_material,
    cable_pairs,
    moordyn_sections,
    moordyn_table,
    moorpy_table,
    orcaflex,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.lines.deck_formats import FORMS, export_line
from reduction.lines.export_line import LIFT, curve_from_zero

AREA = np.pi / 4 * 0.026**2


@st.composite
def curves(draw):
    """Strain rising, tension not falling: smooth, kinked, with plateaus and slack, any size."""
    count = draw(st.one_of(st.integers(2, 60), st.integers(2, 5000)))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    uneven, kinked = draw(st.floats(0, 4)), draw(st.floats(0, 12))
    flat = draw(st.sampled_from([0.0, 0.0, 0.3, 0.9]))
    run = 0.02 + random.random(count) ** uneven
    rise = random.random(count) ** kinked * (random.random(count) >= flat)
    rise[-1] += 0.01
    strain = np.cumsum(run)
    tension = np.cumsum(rise)
    start = draw(st.sampled_from(["zero", "toe", "slack"]))
    if start == "zero":
        strain, tension = strain - strain[0], tension - tension[0]
    elif start == "slack":
        tension = np.maximum(tension - tension[count // 3], 0.0)
    # two points may be what is left of the rise
    if not tension[-1] > 0:
        tension = tension + (strain - strain[0]) / np.ptp(strain)
    strain *= draw(st.floats(1e-3, 4)) / strain[-1]
    tension *= draw(st.floats(1, 1e8)) / tension[-1]
    return strain, tension


def stated(text):
    """Errors that the header states, in N, as printed with three digits."""
    plain = re.sub(r"\s+", " ", re.sub(r"^[*#/ ]+|\*/$", "", text, flags=re.MULTILINE))
    return [float(value) for value in re.findall(r"greatest error ([-+.e\d]+) N", plain)]


def check(strain, tension, found_strain, found_tension, allowed, *, most):
    assert found_strain[0] == 0
    assert found_tension[0] == 0
    assert found_strain.size <= most
    assert np.all(np.diff(found_strain) > 0)
    assert np.all(np.diff(found_tension) > 0)
    own = strain >= 0
    off = np.abs(np.interp(strain[own], found_strain, found_tension) - tension[own]).max()
    # the header rounds to three digits
    assert off <= 1.006 * allowed + 1e-9 * tension[-1]


def written(strain, tension, to, folder, **options):
    one = line(strain=strain, tension=tension, tested=(float(strain[0]), float(strain[-1])))
    paths = export_line(one, to, folder / "x.dat", **options)
    return [path.read_text() for path in paths if to != "netcdf"]


def orcaflex_curve(text):
    return orcaflex(text)[1:]


def abaqus_curve(text):
    stress, strain = abaqus(text)
    return strain, stress * AREA


# by format: what reads its table, and how many rows the program takes
WITH_A_TABLE_BESIDE = {
    "moordyn": (moordyn_table, 30), "openfast": (moordyn_table, 30), "moorpy": (moorpy_table, 30),
}  # fmt: skip
ONE_TEXT = {"orcaflex": (orcaflex_curve, 100), "abaqus": (abaqus_curve, 200)}


@settings(max_examples=examples(30), deadline=None)
@given(curve=curves())
def test_every_format_is_valid_and_within_its_stated_error(curve):
    strain, tension = curve
    with TemporaryDirectory() as name:
        folder = Path(name)
        for to, (reader, most) in WITH_A_TABLE_BESIDE.items():
            table, deck = written(strain, tension, to, folder)
            found = reader(table)
            check(strain, tension, *found, stated(deck)[0], most=most)
            (row,) = moordyn_sections(deck)["LINE TYPES"]
            assert len(row) == 10
            assert row[3].strip("|") in {path.name for path in folder.iterdir()}
            assert ("|" in row[3]) == (to == "moorpy")
        for to, (reader, most) in ONE_TEXT.items():
            (text,) = written(strain, tension, to, folder)
            check(strain, tension, *reader(text), stated(text)[0], most=most)


def test_every_mooring_code_is_read_back():
    # Cable has a test of its own, below; a line of RAFT has no curve
    assert {*WITH_A_TABLE_BESIDE, *ONE_TEXT, "whoi-cable", "raft"} == set(FORMS)


@pytest.mark.nightly
@settings(max_examples=examples(12), deadline=None)
@given(curve=curves())
def test_cable_has_a_table_and_a_rising_function_with_two_derivatives(curve):
    strain, tension = curve
    with TemporaryDirectory() as name:
        folder = Path(name)
        (text,) = written(strain, tension, "whoi-cable", folder, form="table")
        _, material = cable_material(text)
        # the last pair is beyond the curve, straight on
        inside = (one[:-1] for one in cable_pairs(material["T"]))
        check(strain, tension, *inside, stated(text)[0], most=100)
        (text,) = written(strain, tension, "whoi-cable", folder)
    _, material = cable_material(text)
    for derivative in ("T", "Te", "Tee"):
        assert "^" not in material[derivative]
        pieces = re.split(r"[?:]", material[derivative])
        assert all("e" in re.sub(r"\de[+-]", "", piece) for piece in pieces)
    at, load, _ = curve_from_zero(strain, tension)
    grid = np.linspace(0, at[-1], 200)
    value, slope, bend = (CableExpression(material[one]) for one in ("T", "Te", "Tee"))
    top = load[-1]
    assert abs(value(0.0)[0]) <= 1e-8 * top
    off = np.abs(value(grid) - np.interp(grid, at, load)).max()
    assert off <= 1.006 * stated(text)[1] + 2e-6 * top
    assert np.all(slope(grid) > -1e-7 * top / at[-1])
    # Te is the slope of T, and Tee that of Te; a piece is at least a thousandth of the strain
    step = 1e-6 * at[-1]
    inner = grid[1:-1]
    risen = (value(inner + step) - value(inner - step)) / (2 * step)
    steepest = np.abs(slope(grid)).max()
    np.testing.assert_allclose(slope(inner), risen, rtol=0, atol=5e-3 * steepest)
    bent = (slope(inner + step) - slope(inner - step)) / (2 * step)
    sharpest = np.abs(bend(grid)).max()
    assert np.median(np.abs(bent - bend(inner))) <= 1e-3 * sharpest + 1e-3 * steepest / at[-1]


@settings(max_examples=examples(12), deadline=None)
@given(curve=curves())
def test_tables_hold_every_point(curve):
    strain, tension = curve
    at, load, words = curve_from_zero(strain, tension)
    assert at[0] == load[0] == 0
    own = strain >= 0
    lift = LIFT * tension[-1] if "added" in words else 0.0
    assert np.abs(np.interp(strain[own], at, load) - tension[own]).max() <= 1.01 * lift + 1e-12
    with TemporaryDirectory() as name:
        folder = Path(name)
        (text,) = written(strain, tension, "json", folder)
        document = json.loads(text)
        np.testing.assert_allclose(document["values"]["tension"], load)
        (text,) = written(strain, tension, "csv", folder)
        rows = list(csv.DictReader(io.StringIO(text)))
        np.testing.assert_allclose([float(row["tension [N]"]) for row in rows], load, rtol=1e-9)
        (text,) = written(strain, tension, "markdown", folder)
        assert sum(row.startswith("| ") for row in text.split("\n")) == at.size + 2
        (text,) = written(strain, tension, "latex", folder)
        assert text.count(r" \\") == at.size + 2
        written(strain, tension, "netcdf", folder)
        with xr.open_dataset(folder / "x.dat", engine="netcdf4") as dataset:
            np.testing.assert_array_equal(dataset["tension"].values, load)
