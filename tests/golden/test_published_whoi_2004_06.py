"""WHOI-2004-06: the cells of the package against a second typing of the report.

The raised degree sign, Greek letters and pi are lost in the text of the report that was typed:
"640" is 64 degrees, "_" a letter or a fraction.  Both typings keep what stands there.
"""

import csv

import pytest
from published_typings import ROOM, cells_in_order, faults_of_the_data, typed_in_order

from reduction.published.printed_cells import cells_of, errata_of

REPORT = "WHOI-2004-06"
FABRIC = "nylon tire cord fabric"
# where the numbers of a third reading stand
PLACES = {
    "cords_per_inch": ("sec 1.2.2", FABRIC, "cords_per_length"),
    "cord_diameter": ("sec 1.2.2", FABRIC, "cord_diameter"),
    "cord_break": ("sec 1.2.2", FABRIC, "breaking strength of one cord"),
    "fabric_break": ("sec 1.2.2", FABRIC, "breaking strength of the fabric"),
    "hose64_stretch": ("sec 3.0", "medium high stretching hose", "maximum stretch"),
    "hose68_stretch": ("sec 3.0", "high stretching hose", "maximum stretch"),
    "safe_working_fraction": (
        "sec 1.2.4", "stretch hose", "safe working load over the breaking strength of the cords",
    ),
    "stretch_range_low": ("abstract", "stretch hose", "elastic stretch, from"),
    "stretch_range_high": ("abstract", "stretch hose", "elastic stretch, to"),
    "test_hose_length": ("sec 3.0", "Snubber test hose of 1994", "length"),
}  # fmt: skip
NEUTRAL = ("sec 1.2.1", "stretch hose", "neutral wrap angle")


def test_both_typings_agree():
    assert cells_in_order(REPORT) == typed_in_order(REPORT)


def test_the_data_keep_their_rules():
    assert faults_of_the_data(REPORT) == {}


def test_stated_numbers_of_a_third_reading():
    cells = {cell.key: cell for cell in cells_of(REPORT)}
    with (ROOM / REPORT / "stated_numbers.csv").open(encoding="utf-8") as lines:
        stated = {row["quantity"]: float(row["value"]) for row in csv.DictReader(lines)}
    assert cells[NEUTRAL].printed == f"about {stated.pop('neutral_angle'):g} degrees"
    assert stated.keys() == PLACES.keys()
    for name, place in PLACES.items():
        assert cells[place].value == pytest.approx(stated[name], abs=5e-5)


def test_what_a_designer_gets_is_what_is_right():
    cells = {cell.key: cell for cell in cells_of(REPORT)}
    right = {
        ("sec 3.0", "medium high stretching hose", "wrap_angle"): 64.0,
        ("sec 3.0", "high stretching hose", "wrap_angle"): 68.0,
        ("sec 2.0", "stretch hose", "temperature of the curing steam"): 300.0,
        ("sec 1.2.2", FABRIC, "number of plies"): 2.0,
        ("sec 1.1", FABRIC, "gap between cords over the cord diameter"): 0.333,
        NEUTRAL: 54.7356,
    }
    assert {place: cells[place].value for place in right} == right


def test_errata_are_numbered_in_order():
    assert [one.id for one in errata_of(REPORT)] == [f"WH4-{n}" for n in range(1, 13)]
