"""Rows by group, references, and what a specimen's sheet adds."""

import math

import pytest

from reduction.experiments.outcome_groups import (
    _group_outcomes,
    _reference_of,
    complete_from_specimens,
)
from reduction.experiments.outcomes import Outcome
from reduction.record.errors import DataError
from reduction.record.measurement import Specimen


def strength(value=28e3, **facts):
    return Outcome("tensile_strength", value, **facts)


def test_every_row_of_the_quantity_has_a_place_and_no_other():
    rows = [
        strength(line="A", diameter=0.0127),
        Outcome("abrasion_cycles", 5e3, line="A"),
        strength(line="A", diameter=0.0127, is_valid=False, place="splice"),
        strength(line="A"),
        strength(math.nan, line="A", is_valid=False),
    ]
    grouped = _group_outcomes(rows, "tensile_strength")
    assert grouped.group.tolist() == [0, 0, 1, 1]
    assert grouped.use.tolist() == [0, 1, 0, 2]
    assert [group.diameter for group in grouped.groups] == [0.0127, None]
    assert grouped.value.tolist() == [28e3, 28e3, 28e3, 1.0]


def test_a_value_that_cannot_be_is_refused_by_its_row():
    with pytest.raises(DataError, match="row 7 has no tensile_strength to be used; found nan"):
        _group_outcomes([strength(math.nan, row=7)], "tensile_strength")


def references(*conditions, **facts):
    rows = [strength(condition=condition, **facts) for condition in conditions]
    return _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist()


def test_each_line_is_held_against_its_own_new_condition():
    assert references("new", "worn", "4 years") == [-1, 0, 0]
    rows = [strength(line=line, condition=c) for line in "AB" for c in ("worn", "new")]
    assert _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist() == [
        1,
        -1,
        3,
        -1,
    ]


def test_no_reference_or_two_of_them_is_none():
    assert references("worn", "4 years") == [-1, -1]
    rows = [strength(condition="new", exposure=e) for e in (0.0, 0.1)]
    rows.append(strength(condition="worn"))
    assert _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist() == [-1, -1, -1]


def test_a_reference_without_a_name_is_refused():
    with pytest.raises(DataError, match="no reference is named; needed a word"):
        _reference_of([], reference_condition="")


SHEET = Specimen(
    "N-1", material="nylon", construction="plaited", condition="new", diameter=(0.012, 0.013),
    rated_break_strength=20e3,
)  # fmt: skip


def test_a_sheet_fills_what_the_row_leaves_open():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-1", condition="wet", peak_load_ratio=0.5,
                  minimum_load=0.0)  # fmt: skip
    (full,) = complete_from_specimens([row], {"N-1": SHEET})
    assert (full.material, full.construction, full.condition) == ("nylon", "plaited", "wet")
    assert full.diameter == pytest.approx(0.0125)
    assert (full.peak_load, full.minimum_load_ratio) == (10e3, 0.0)


def test_a_row_of_another_specimen_is_left_as_it_is():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-2", peak_load=5e3)
    (left,) = complete_from_specimens([row], {"N-1": SHEET})
    assert left is row


def test_without_break_strength_a_load_stays_a_load():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-1", peak_load=5e3, diameter=0.02)
    (full,) = complete_from_specimens([row], {"N-1": Specimen("N-1")})
    assert full.peak_load == 5e3 and math.isnan(full.peak_load_ratio) and full.diameter == 0.02
