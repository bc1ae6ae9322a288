"""Tables of outcomes: made from their archive alone, complete, explained, the same bytes again."""

import csv

import pytest

from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.csv_columns import OUTCOME_TABLES
from reduction.archive.csv_tables import write_tables
from reduction.archive.write import write_archive
from reduction.experiments.outcomes import Outcome
from reduction.record.measurement import Origin, Source, Step

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
def tables(tmp_path):
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


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_outcomes_fill_every_table_of_theirs(tables):
    paths = tables([*BREAKS, *CYCLES])
    assert [path.stem for path in paths] == [*OUTCOME_TABLES, "columns"]


def test_numbers_stand_in_si_under_a_header_with_the_unit(tables):
    strength, exposure, fatigue, load_life, _ = map(read, tables([*BREAKS, *CYCLES]))
    assert [row["tensile_strength [N]"] for row in strength] == ["6500.0", "5300.0", "4100.0"]
    assert strength[1]["tensile_strength_change [1]"] == repr(5300 / 6500 - 1)
    assert strength[0]["tensile_strength_change [1]"] == ""
    assert strength[0]["tensile_strength_count"] == "2"
    assert strength[1]["condition"] == "2 years" and strength[1]["exposure [year]"] == "2.0"
    assert float(exposure[0]["strength_slope [N year-1]"]) == pytest.approx(-600)
    assert [row["failed_count"] for row in fatigue] == ["0", "3", "3"]
    assert fatigue[0]["life_reason"] == "no failure: only a lower bound can be given"
    assert float(load_life[0]["life_exponent [1]"]) > 0


def test_every_table_says_whether_the_data_are_synthetic(tables):
    for path in tables([*BREAKS, *CYCLES])[:-1]:
        assert {row["synthetic"] for row in read(path)} == {"yes"}
    assert {row["synthetic"] for row in read(tables(BREAKS, synthetic="")[0])} == {"no"}


def test_every_column_is_explained(tables):
    *paths, columns = tables([*BREAKS, *CYCLES])
    explained = {(row["table"], row["column"]): row for row in read(columns)}
    for path in paths:
        header = list(read(path)[0])
        for name, after in zip(header, [*header[1:], ""], strict=True):
            row = explained[path.name, name]
            assert row["meaning"]
            stem = name.partition(" [")[0]
            has_uncertainty = after.startswith(f"{stem}_standard_uncertainty [")
            assert has_uncertainty != bool(row["no_uncertainty"]), (path.name, name)
            assert (row["unit"] not in ("", "1")) <= (f"[{row['unit']}]" in name)


def test_a_table_that_outcomes_do_not_give_is_not_there(tables, tmp_path):
    tables([*BREAKS, *CYCLES])
    assert [path.stem for path in tables(BREAKS[:1])] == ["strength", "columns"]
    assert not (tmp_path / "tables" / "fatigue.csv").exists()


def test_the_same_outcomes_give_the_same_bytes(tables):
    first = [path.read_bytes() for path in tables([*BREAKS, *CYCLES])]
    assert first == [path.read_bytes() for path in tables([*BREAKS, *CYCLES])]
