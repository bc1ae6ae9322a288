"""Rows of a table hold the numbers of the archive, each in its place."""

import numpy as np
import pytest
from table_cells import table_rows

from reduction.archive.csv_definitions import TABLES
from reduction.archive.test_dataset import to_dataset

BY_NAME = {table.name: table for table in TABLES}


def rows_of(test, name):
    """Rows as dicts, and the dataset they come from."""
    dataset = to_dataset(test, version="1.2.3", command="reduction run")
    table = BY_NAME[name]
    columns = [column.name for column in table.columns]
    return [dict(zip(columns, row, strict=True)) for row in table_rows(dataset, table)]


def test_a_segment_that_a_branch_does_not_have_has_no_row(rich_test):
    rows = rows_of(rich_test, "moduli")
    assert len(rows) == 2 * 2 * 3 - 1
    last = rows[-1]
    assert (last["test"], last["specimen"], last["branch"], last["segment"]) == (
        "T-1", "used", "descending", 2,
    )  # fmt: skip
    assert last["segment_modulus"] == rich_test.segments.segment_modulus[1, 1, 1]
    shared = rich_test.contributions.values["segment_modulus"][:, 1, 1, 1]
    random = rich_test.segments.segment_modulus_standard_uncertainty[1, 1, 1]
    assert last["segment_modulus_standard_uncertainty"] == pytest.approx(
        np.sqrt(random**2 + np.sum(shared**2))
    )
    assert last["n_cycles"] == 4
    assert last["strain_method"] == "tension-driven"
    assert last["synthetic"] == "yes"


def test_every_cycle_of_every_specimen_has_a_row(rich_test):
    rows = rows_of(rich_test, "cycles")
    assert [(row["specimen"], row["cycle"]) for row in rows] == [
        (specimen, cycle) for specimen in ("new", "used") for cycle in (1, 2, 3, 4)
    ]
    assert rows[5]["loss_factor"] == rich_test.loops.loss_factor[1, 1]
    assert (
        rows[5]["loss_factor_standard_uncertainty"]
        == rich_test.loops.uncertainty["loss_factor"][1, 1]
    )


def test_a_bin_keeps_its_edges_and_its_untrimmed_modulus(rich_test):
    row = rows_of(rich_test, "tangent_modulus")[0]
    low, high = rich_test.curves.strain_bin_bounds[0]
    assert (row["strain_bin_low"], row["strain_bin_high"]) == (low, high)
    assert row["tangent_modulus"] is None
    assert row["tangent_modulus_untrimmed"] == rich_test.curves.tangent_modulus_untrimmed[0, 0, 0]


def test_each_parameter_of_a_law_has_a_row_with_what_is_said_of_the_law(rich_test):
    rows = rows_of(rich_test, "elastomer")
    assert [row["elastomer_parameter_name"] for row in rows] == [
        "shear_modulus", "modulus_1", "exponent_1",
    ]  # fmt: skip
    assert [row["elastomer_law"] for row in rows] == ["neo-hookean", "ogden-2", "ogden-2"]
    assert [row["elastomer_is_stable"] for row in rows] == ["yes", "no", "no"]
    assert rows[2]["elastomer_exponent"] == 1.4
    assert rows[2]["elastomer_modulus"] is None


def test_a_stepwise_reading_names_its_specimen_and_its_flags(stepwise_test):
    rows = rows_of(stepwise_test, "stepwise")
    assert [row["clock"] for row in rows] == ["1130", "1140", "1205"]
    assert {row["specimen"] for row in rows} == {"tether"}
    assert [row["branch"] for row in rows] == ["ascending", "ascending", "descending"]
    assert rows[1]["step_flag"] == "length_and_elongation_disagree creep"
    assert rows[0]["relaxed_gauge_length"] == 0.1556


def test_an_interval_without_a_slope_has_no_row(stepwise_test):
    rows = rows_of(stepwise_test, "stepwise_moduli")
    assert len(rows) == 1
    assert rows[0]["interval_modulus"] == 8e5
    assert rows[0]["interval_branch"] == "descending"


def test_a_hold_keeps_the_reason_of_its_refusal(rich_test):
    rows = rows_of(rich_test, "relaxation")
    assert (
        rows[1]["hold_refusal"]
        == "Prony series not given: the hold lasts 25 s; rate not given: too short"
    )
    assert [row["specimen"] for row in rows] == ["new", "used", "new"]
    assert len(rows_of(rich_test, "prony")) == 4


def test_slips_that_were_not_found_show_in_the_trend_table(bare_test):
    assert rows_of(bare_test, "slips") == []
    assert rows_of(bare_test, "trend")[0]["n_slips"] == 0


def test_rows_of_the_log_are_accounted_for(rich_test):
    rows = rows_of(rich_test, "rows")
    spikes = [row for row in rows if row["quality_mask"] == "spike"]
    assert [row["n_flagged"] for row in spikes] == [0, 1, 0]
    assert {(row["n_rows_read"], row["n_rows_kept"]) for row in rows} == {(61, 60)}


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_an_archive_without_the_subject_gives_no_row(table, holds_only_test):
    dataset = to_dataset(holds_only_test, version="1", command="reduction run")
    rows = table_rows(dataset, table)
    assert bool(rows) == (
        table.name in {"relaxation", "relaxation_times", "specimens", "notes", "rows"}
    )


def test_a_table_has_as_many_cells_as_columns(rich_test):
    dataset = to_dataset(rich_test, version="1", command="reduction run")
    filled = {table: rows for table in TABLES if (rows := table_rows(dataset, table))}
    assert len(filled) > len(TABLES) // 2
    for table, rows in filled.items():
        assert {len(row) for row in rows} == {len(table.columns)}
