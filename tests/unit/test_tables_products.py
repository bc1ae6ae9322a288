"""Tables of comparisons and of outcomes."""

import numpy as np
import pytest
from compared_hoses import LOOP, NOT_APART, agreeing, dataset, differing, trading
from csvrows import csv_rows, hold_columns_explained

from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.csv_columns import OUTCOME_TABLES
from reduction.archive.csv_definitions import COMPARISON_TABLES
from reduction.archive.csv_tables import write_tables
from reduction.archive.write import write_archive
from reduction.experiments.outcomes import Outcome
from reduction.record.measurement import Origin, Source, Step


def written(folder, *named, **options):
    write_archive(dataset(*named, **options), folder / "comparisons.nc")
    paths = write_tables((), folder / "tables", comparisons=folder / "comparisons.nc")
    return {path.stem: csv_rows(path) for path in paths}


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
    for table, rows in tables.items():
        hold_columns_explained(f"{table}.csv", list(rows[0]), tables["columns"])


# tables of outcomes: made from their archive alone, complete, explained, the same bytes again

BREAKS = [
    Outcome("tensile_strength", 6500 - 600 * years + about, line="PD", exposure=years,
            condition=f"{years:g} years" if years else "new")
    for years in (0.0, 2.0, 4.0)
    for about in (-100.0, 100.0)
]  # fmt: skip
CYCLES = [
    *[Outcome("cycles_to_failure", v, peak_load_ratio=0.7) for v in (4e3, 5e3, 7e3)],
    *[Outcome("cycles_to_failure", v, peak_load_ratio=0.5) for v in (3e4, 4e4, 5e4)],
    *[Outcome("cycles_to_failure", 2e5, peak_load_ratio=0.3, is_suspended=True)] * 3,
]


@pytest.fixture
def tables_of_outcomes(tmp_path):
    def written(outcomes, synthetic="yes"):
        dataset = outcomes_to_dataset(
            outcomes,
            origin=Origin(
                campaign_id="c", attributes={"synthetic": synthetic},
                sources=(Source("results.csv", "ab" * 32, 1),),
                steps=(Step("outcomes", "rows"),), settings_json="{}", version="1", command="",
            ),
        )  # fmt: skip
        write_archive(dataset, tmp_path / "outcomes.nc")
        return write_tables((), tmp_path / "tables", outcomes=tmp_path / "outcomes.nc")

    return written


def test_outcomes_fill_every_table_of_theirs(tables_of_outcomes):
    paths = tables_of_outcomes([*BREAKS, *CYCLES])
    assert [path.stem for path in paths] == [*OUTCOME_TABLES, "columns"]


def test_numbers_stand_in_si_under_a_header_with_the_unit(tables_of_outcomes):
    strength, exposure, fatigue, load_life, _ = map(
        csv_rows, tables_of_outcomes([*BREAKS, *CYCLES])
    )
    assert [row["tensile_strength [N]"] for row in strength] == ["6500.0", "5300.0", "4100.0"]
    assert strength[1]["tensile_strength_change [1]"] == repr(5300 / 6500 - 1)
    assert strength[0]["tensile_strength_change [1]"] == ""
    assert strength[0]["tensile_strength_count"] == "2"
    assert strength[1]["condition"] == "2 years" and strength[1]["exposure [year]"] == "2.0"
    assert float(exposure[0]["strength_slope [N year-1]"]) == pytest.approx(-600)
    assert [row["failed_count"] for row in fatigue] == ["0", "3", "3"]
    assert fatigue[0]["life_reason"] == "no failure: only a lower bound can be given"
    assert float(load_life[0]["life_exponent [1]"]) > 0


def test_every_table_says_whether_the_data_are_synthetic_in_outcomes(tables_of_outcomes):
    for path in tables_of_outcomes([*BREAKS, *CYCLES])[:-1]:
        assert {row["synthetic"] for row in csv_rows(path)} == {"yes"}
    assert {row["synthetic"] for row in csv_rows(tables_of_outcomes(BREAKS, synthetic="")[0])} == {
        "no"
    }


def test_every_column_is_explained(tables_of_outcomes):
    *paths, columns = tables_of_outcomes([*BREAKS, *CYCLES])
    for path in paths:
        hold_columns_explained(path.name, list(csv_rows(path)[0]), csv_rows(columns))


def test_a_table_that_outcomes_do_not_give_is_not_there(tables_of_outcomes, tmp_path):
    tables_of_outcomes([*BREAKS, *CYCLES])
    assert [path.stem for path in tables_of_outcomes(BREAKS[:1])] == ["strength", "columns"]
    assert not (tmp_path / "tables" / "fatigue.csv").exists()


def test_the_same_outcomes_give_the_same_bytes(tables_of_outcomes):
    first = [path.read_bytes() for path in tables_of_outcomes([*BREAKS, *CYCLES])]
    assert first == [path.read_bytes() for path in tables_of_outcomes([*BREAKS, *CYCLES])]
