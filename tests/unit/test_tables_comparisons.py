"""Tables of comparisons: from their archive alone, every number with its unit and its u."""

import csv

import numpy as np
import pytest
from compared_hoses import LOOP, NOT_APART, agreeing, dataset, differing, trading

from reduction.archive.csv_definitions import COMPARISON_TABLES
from reduction.archive.csv_tables import write_tables
from reduction.archive.write import write_archive


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def written(folder, *named, **options):
    write_archive(dataset(*named, **options), folder / "comparisons.nc")
    paths = write_tables((), folder / "tables", comparisons=folder / "comparisons.nc")
    return {path.stem: read(path) for path in paths}


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    return written(tmp_path_factory.mktemp("tables"))


def test_comparisons_fill_every_table_of_theirs(tables):
    assert [*tables] == [*(table.name for table in COMPARISON_TABLES), "columns"]


def test_a_comparison_is_a_row_with_its_verdict(tables):
    rows = {row["comparison"]: row for row in tables["comparisons"]}
    assert [*rows] == ["alike", "apart", "trade"]
    assert [row["agrees"] for row in rows.values()] == ["yes", "no", "yes"]
    assert [row["is_identified"] for row in rows.values()] == ["yes", "not_asked", "no"]
    assert rows["apart"]["verdict"] == differing().comparison.validation.verdict
    assert rows["apart"]["judged_curve"] == "ascending"
    assert rows["apart"]["loop_energy [J m-1]"] == ""
    assert float(rows["alike"]["loop_energy [J m-1]"]) == pytest.approx(LOOP * 0.9)
    assert float(rows["trade"]["bias_per_decade_standard_uncertainty [N]"]) >= 0


def test_every_measured_curve_is_a_row_and_no_other(tables):
    rows = [(row["comparison"], row["curve"]) for row in tables["comparison_curves"]]
    three = ("ascending", "descending", "midline")
    expected = [("alike", one) for one in three]
    expected += [("apart", "ascending"), *(("trade", one) for one in three)]
    assert rows == expected
    for row in tables["comparison_curves"]:
        found = {"alike": agreeing, "apart": differing, "trade": trading}[row["comparison"]]()
        own = found.comparison.differences[row["curve"]]
        assert float(row["tension_bias [N]"]) == own.bias
        assert float(row["worst_tension_difference [N]"]) == own.worst_tension_difference


def test_every_strain_at_which_a_curve_was_measured_is_a_row(tables):
    rows = [
        row
        for row in tables["comparison_points"]
        if (row["comparison"], row["curve"]) == ("apart", "ascending")
    ]
    own = differing().comparison
    tension = own.measured.tension_of("ascending")
    there = np.isfinite(tension)
    assert [float(row["measured_tension [N]"]) for row in rows] == tension[there].tolist()
    assert [float(row["strain [1]"]) for row in rows] == own.measured.strain[there].tolist()
    assert {row["calibrated_tension [N]"] for row in rows} == {""}
    header = [*rows[0]]
    place = header.index("measured_tension [N]")
    assert header[place + 1] == "measured_tension_standard_uncertainty [N]"


def test_events_where_the_test_did_not_go_are_empty(tables):
    rows = {(row["comparison"], row["hose_event"]): row for row in tables["comparison_events"]}
    for event in agreeing().comparison.events:
        row = rows["alike", event.name]
        assert float(row["event_strain [1]"]) == event.strain
    assert rows["alike", "break"]["event_tension_difference [N]"] == ""
    assert rows["apart", "working"]["event_strain_difference_standard_uncertainty [1]"] != ""


def test_cycles_are_numbered_as_they_were_made(tables):
    rows = [row for row in tables["comparison_cycles"] if row["comparison"] == "trade"]
    assert [row["comparison_cycle_number"] for row in rows] == [str(n) for n in range(1, 11)]
    assert [float(row["cycle_bias [N]"]) for row in rows] == (
        trading().comparison.cycles.cycle_bias.tolist()
    )


def test_fitted_numbers_and_their_correlations_have_names(tables):
    fits = [(row["comparison"], row["parameter_name"]) for row in tables["calibrations"]]
    alike = [("alike", "wrap_angle"), ("alike", "rubber_modulus")]
    assert fits == [*alike, *(("trade", name) for name in NOT_APART)]
    assert [row["parameter_unit"] for row in tables["calibrations"]] == ["rad", "Pa", "1", "1"]
    value = float(tables["calibrations"][1]["parameter_value [1]"])
    assert value == pytest.approx(210 * 6894.757293168, rel=1e-3)
    own = [row for row in tables["calibration_correlations"] if row["comparison"] == "alike"]
    assert len(own) == 4
    of_itself = [float(row["parameter_correlation [1]"]) for row in own][::3]
    assert of_itself == pytest.approx([1.0, 1.0])


def test_without_a_fit_there_is_no_table_of_fits(tmp_path):
    found = written(tmp_path, differing(), synthetic="")
    assert not {"calibrations", "calibration_correlations"} & {*found}
    assert {row["synthetic"] for row in found["comparisons"]} == {"no"}


def test_every_table_says_whether_the_data_are_synthetic(tables):
    for name, rows in tables.items():
        assert name == "columns" or {row["synthetic"] for row in rows} == {"yes"}


def test_every_column_is_explained_and_has_an_uncertainty_or_a_reason(tables):
    explained = {(row["table"], row["column"]): row for row in tables["columns"]}
    for table, rows in tables.items():
        header = list(rows[0])
        for name, after in zip(header, [*header[1:], ""], strict=True):
            row = explained[f"{table}.csv", name]
            assert row["meaning"]
            stem = name.partition(" [")[0]
            has_uncertainty = after.startswith(f"{stem}_standard_uncertainty [")
            assert has_uncertainty != bool(row["no_uncertainty"]), (table, name)
