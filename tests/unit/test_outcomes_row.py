"""A row before anything is known, and the labels of a group."""

import math

from reduction.experiments.outcome_groups import FATIGUE_COLUMNS, Group, _empty_row, _labels_of


def test_an_empty_row_has_every_column_in_order():
    row = _empty_row(FATIGUE_COLUMNS)
    assert list(row) == [column.name for column in FATIGUE_COLUMNS]
    assert (row["quantity"], row["failed_count"]) == ("", 0) and math.isnan(row["mean_cycles"])


def test_what_a_group_does_not_say_is_no_number():
    labels = _labels_of(Group("PD", "nylon", "plaited", None, "new", None))
    assert labels["line"] == "PD" and labels["condition"] == "new"
    assert math.isnan(labels["diameter"]) and math.isnan(labels["exposure"])
