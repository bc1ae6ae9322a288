"""Global attributes say what the file is and where it came from."""

from dataclasses import replace

import pytest

from reduction.archive.dataset_builder import global_attributes
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Source
from reduction.record.notes import note


def attributes(test, **given):
    about = test.description
    about = replace(about, attributes={**about.attributes, **given})
    return global_attributes(
        replace(test, description=about), version="1.2.3", command="reduction run"
    )


def test_provenance_is_complete(rich_test):
    found = attributes(rich_test)
    assert found["Conventions"] == "CF-1.11 ACDD-1.3"
    assert found["raw_file"] == "T-1.csv\nT-1b.csv"
    assert found["raw_file_sha256"] == "\n".join(["ab" * 32, "cd" * 32])
    assert found["raw_file_bytes"] == "12345\n99"
    assert found["raw_metadata"] == '{"operator": "größe"}'
    assert found["settings"] == rich_test.settings_json
    assert found["command"] == "reduction run"
    assert found["software_version"] == "1.2.3"
    assert found["history"].splitlines() == [
        "reduction 1.2.3 ingest: read 61 rows",
        "reduction 1.2.3 cycles: 4 cycles, band 0.02 m",
    ]
    assert found["machine"] == "tether machine"
    assert found["id"] == "tmt/T-1"


def test_how_uncertainty_was_propagated_is_said(rich_test, bare_test):
    plain = "first order (JCGM 100:2008)"
    assert attributes(bare_test)["uncertainty_propagation"] == plain
    assert attributes(rich_test)["uncertainty_propagation"] == (
        f"{plain}; K_1, tau and K_1 tau as test_line_uncertainty_method says (JCGM 101:2008)"
    )


def test_the_root_says_why_a_test_is_to_be_checked(rich_test, bare_test):
    """A reader of `ncdump -h` sees no data, and so no note of the group notes."""
    assert attributes(bare_test)["test_status"] == "reduced"
    notes = (note("no-snap-loads", n_taut=1, n_cycles=2, slack_tension=3.0),
             note("slack-in-cycles", "new", n_slack=1, n_cycles=2, slack_tension=3.0))  # fmt: skip
    found = attributes(replace(bare_test, notes=notes))["test_status"]
    assert found.startswith("check: new: the specimen goes slack in 1 of 2 cycles")


def test_no_attribute_is_a_list_or_empty(any_test):
    found = attributes(any_test)
    assert all(isinstance(text, str) and text for text in found.values())


def test_one_file_reads_the_same_as_several(rich_test):
    one = replace(rich_test, sources=(Source("T-1.csv", "ab" * 32, 7),))
    assert attributes(one)["raw_file_bytes"] == "7"


def test_synthetic_data_are_called_so_in_title_and_source(rich_test, bare_test):
    found = attributes(rich_test)
    assert found["title"] == "Cycle tests of a new and a used tether (synthetic data)"
    assert found["source"] == "synthetic; from a known law"
    assert found["synthetic"] == "yes"
    assert "synthetic" not in attributes(bare_test)["title"]


def test_synthetic_is_not_said_twice(rich_test):
    found = attributes(rich_test, title="Synthetic tests", source="synthetic, from a law")
    assert found["title"] == "Synthetic tests"
    assert found["source"] == "synthetic, from a law"
    assert attributes(rich_test, source="")["source"] == "synthetic"


def test_a_summary_is_written_where_none_is_given(rich_test):
    assert attributes(rich_test)["summary"] == "Reduced cyclic test T-1 of specimen new and used."
    assert attributes(rich_test, summary="Mine.")["summary"] == "Mine."


def test_a_name_of_the_archive_s_own_is_refused(rich_test):
    with pytest.raises(ArchiveError, match=r"keeps for itself; found history, settings\."):
        attributes(rich_test, history="x", settings="y")


def test_a_name_that_cf_does_not_allow_is_refused(rich_test):
    with pytest.raises(ArchiveError, match=r"CF does not allow; found load cell; needed letters"):
        attributes(rich_test, **{"load cell": "x"})
