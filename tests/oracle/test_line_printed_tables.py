"""Tables 6 to 9 of CG-D-39-80 as copied cell by cell: slope of strain against the printed K_0."""

import csv

import numpy as np
import pytest
from measured_logs import LOGS

from reduction.stages.three_parameter_line.slow_pull import (
    fit_pull,
    quasi_static_spring_constant,
    slope_of_cubic,
)

TABLES = LOGS.parent / "reference" / "line"
pytestmark = pytest.mark.skipif(
    not TABLES.exists(), reason="copies of the printed tables are not part of the project"
)
POWERS = {"strain": [1e-4, 1e-4, 1e-8, 1e-12], "K0": [1, 1e-4, 1e-7, 1e-11]}


def column(name, quantity, **wanted):
    with (TABLES / name).open(newline="", encoding="utf-8") as rows:
        found = {
            row["term"]: float(row["value"])
            for row in csv.DictReader(rows)
            if row["property"] == quantity and all(row[key] == wanted[key] for key in wanted)
        }
    return np.array([found[term] for term in "ABCD"]) * POWERS[quantity]


def line(table, material, construction, diameter, condition="new"):
    return {
        "table": table, "material": material, "construction": construction,
        "diameter_in": diameter, "condition": condition,
    }  # fmt: skip


BRAID = ("nylon", "double braid", "1/2")
PLAITED = ("nylon", "8-strand plaited", "1/2")


@pytest.mark.parametrize(
    ("which", "levels", "expected"),
    [
        (line("8", *BRAID), (768, 1344, 1920), (1.168, 1.836, 3.238)),
        (line("8", *PLAITED), (691.2, 1209.6, 1728), (0.839, 1.146, 1.662)),
        (line("9", *PLAITED, "5yr"), (691.2, 1209.6, 1728), (0.578, 1.031, 2.331)),
        (line("8", "nylon", "double braid", "3/4"), (4011, 5730), (8.20, 8.29)),
        (line("8", "polyester", "8-strand plaited", "1/2"), (1386,), (2.014,)),
        (line("9", "polyester", "8-strand plaited", "1/2"), (1386,), (1.969,)),
    ],
)
def test_slope_of_the_load_strain_cubic(which, levels, expected):
    slope = slope_of_cubic(levels, column("load_strain.csv", "strain", **which)) / 1e4
    digits = 2 if which["diameter_in"] == "3/4" else 3
    assert slope == pytest.approx(expected, abs=0.5 * 10.0**-digits)


@pytest.mark.parametrize(
    ("table", "expected"),
    [("7", (1.159, 1.864, 3.293)), ("6", (1.026, 1.152, 1.217))],
)
def test_table_6_has_lost_a_digit_of_nylon_braid(table, expected):
    printed = column("k0_polynomials.csv", "K0", **line(table, *BRAID))
    levels = np.array([768.0, 1344, 1920])
    assert levels[:, None] ** np.arange(4) @ printed == pytest.approx(expected, abs=0.5e-3)
    slope = slope_of_cubic(levels, column("load_strain.csv", "strain", **line("8", *BRAID))) / 1e4
    # only the Table 7 row is the slope of Table 8
    assert (np.abs(slope / expected - 1).max() < 0.02) == (table == "7")


def test_polyester_braid_after_exposure_agrees_once_both_misprints_are_taken_back():
    which = line("9", "polyester", "double braid", "1/2", "5yr")
    levels = np.array([840.0, 1470, 2100])
    strain = column("load_strain.csv", "strain", **which)
    printed = column(
        "k0_polynomials.csv", "K0", **{**which, "table": "7", "condition": "field exposure"}
    )
    assert (levels[1:, None] ** np.arange(4) @ printed < 0).all()
    strain[2] *= 10
    printed[2] /= 10
    assert slope_of_cubic(levels, strain) / 1e4 == pytest.approx([1.145, 2.443, 5.713], abs=0.5e-3)
    assert levels[:, None] ** np.arange(4) @ printed == pytest.approx(
        [1.141, 2.447, 5.711], abs=0.5e-3
    )


def test_a_pull_along_a_printed_curve_gives_its_slope():
    printed = column("load_strain.csv", "strain", **line("8", *BRAID))
    load = np.linspace(0, 1980, 2000)
    pull = fit_pull(np.arange(2000.0), load[:, None] ** np.arange(4) @ printed, load)
    constant, _ = quasi_static_spring_constant(pull, [768.0, 1344, 1920])
    assert constant / 1e4 == pytest.approx([1.168, 1.836, 3.238], abs=0.5e-3)
