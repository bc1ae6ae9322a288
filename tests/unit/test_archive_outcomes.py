"""Outcomes in an archive: every row comes back as it was, and the file follows CF."""

import hashlib
from math import nan

import numpy as np
import pytest
from rulesofcf import hold_against_cf

from reduction.archive.campaign_products import outcomes_of_dataset, outcomes_to_dataset
from reduction.archive.open import open_archive
from reduction.archive.write import write_archive
from reduction.experiments.outcomes import Outcome
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Origin, Source, Step

OUTCOMES = (
    Outcome("tensile_strength", 28468.6, test="B-1", line="PD", material="polyester",
            construction="double braid", condition="new", diameter=0.0127, exposure=0.0, row=2),
    Outcome("tensile_strength", 20000.1, test="B-2", line="PD", condition="worn", exposure=0.3,
            mode="pulled out", place="splice", is_valid=False, note="naïve “note”", row=3),
    Outcome("strain_at_failure", 0.132, test="B-1", line="PD", row=5),
    Outcome("tensile_strength", nan, test="B-3", specimen="s", is_valid=False, row=6),
    Outcome("cycles_to_failure", 2e5, line="N8", minimum_load=0.0, minimum_load_ratio=0.0,
            peak_load=12e3, peak_load_ratio=0.27, is_suspended=True, row=7),
)  # fmt: skip


def dataset(outcomes=OUTCOMES, **changed):
    about = {
        "campaign_id": "c", "attributes": {"title": "Breaks", "synthetic": "yes"},
        "sources": (Source("results.csv", "ab" * 32, 123),), "steps": (Step("outcomes", "5 rows"),),
        "settings_json": "{}", "version": "1", "command": "reduction run campaign.toml",
    }  # fmt: skip
    return outcomes_to_dataset(outcomes, origin=Origin(**(about | changed)))


@pytest.fixture
def path(tmp_path):
    write_archive(dataset(), tmp_path / "outcomes.nc")
    return tmp_path / "outcomes.nc"


def test_outcomes_come_back_as_they_were(path):
    with open_archive(path) as archive:
        back = outcomes_of_dataset(archive)
    # NaN is not itself, but it prints itself
    assert [repr(one) for one in back] == [repr(one) for one in OUTCOMES]


def test_a_value_stands_under_its_quantity_with_its_unit_and_use(path):
    with open_archive(path) as archive:
        np.testing.assert_array_equal(
            archive["tensile_strength"], [28468.6, 20000.1, nan, nan, nan]
        )
        assert archive["tensile_strength"].attrs["units"] == "N"
        assert archive["tensile_strength"].attrs["ancillary_variables"] == "outcome_use"
        use = archive["outcome_use"]
        assert use.attrs["flag_meanings"] == "value lower_bound excluded"
        assert use.values.tolist() == [0, 1, 0, 2, 1]
        assert "abrasion_cycles" not in archive
        assert archive.attrs["raw_file_sha256"] == "ab" * 32
        assert archive.attrs["id"] == "c/outcomes"
        assert archive.attrs["title"] == "Breaks (synthetic data)"
        assert archive.attrs["history"] == "reduction 1 outcomes: 5 rows"


def test_the_file_keeps_every_rule(path):
    hold_against_cf(path)


def test_equal_outcomes_give_equal_bytes(path, tmp_path):
    write_archive(dataset(), tmp_path / "again.nc")
    first, second = (hashlib.sha256(one.read_bytes()) for one in (path, tmp_path / "again.nc"))
    assert first.digest() == second.digest()


def test_one_bare_row_is_an_archive(tmp_path):
    one = (Outcome("abrasion_cycles", 7000.0),)
    write_archive(dataset(one), tmp_path / "outcomes.nc")
    with open_archive(tmp_path / "outcomes.nc") as archive:
        assert repr(outcomes_of_dataset(archive)) == repr(one)


def test_an_archive_of_something_else_is_refused(path):
    with (
        open_archive(path) as archive,
        pytest.raises(ArchiveError, match="the archive holds no outcomes; found strain"),
    ):
        outcomes_of_dataset(archive.isel(outcome=0).expand_dims("strain"))
