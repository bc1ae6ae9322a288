"""``report.json``: what the laboratory states, beside the archives."""

import pytest

from reduction.archive.report_details import (
    FILE_NAME,
    Client,
    Instrument,
    Laboratory,
    ReportDetails,
    ReportItem,
    ReportLimit,
    keep_details,
    read_details,
)
from reduction.record.errors import ArchiveError

EVERYTHING = ReportDetails(
    number="17 <b>", revision=1, laboratory=Laboratory(name="Läb", location="there"),
    client=Client(name="C"), items={"new": ReportItem(condition='"dry"')},
    instruments=(Instrument(name="cell"),), decision_rule="guard band", paper="Letter",
    limits=(
        ReportLimit(quantity="tangent_modulus", test="T-1", at={"strain": "1.25"}, lower=0.1 + 0.2),
    ),
)  # fmt: skip


def test_what_is_kept_comes_back_to_the_last_bit(tmp_path):
    keep_details(tmp_path, EVERYTHING)
    assert read_details(tmp_path) == EVERYTHING


def test_it_is_taken_away_where_the_campaign_states_nothing_any_more(tmp_path):
    keep_details(tmp_path, EVERYTHING)
    keep_details(tmp_path, None)
    assert not (tmp_path / FILE_NAME).exists()
    assert read_details(tmp_path) is None
    keep_details(tmp_path, None)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"revision": "x"}', '{"paper": "A0"}', "\xff"])
def test_a_file_of_another_form_is_refused(tmp_path, text):
    (tmp_path / FILE_NAME).write_text(text, encoding="latin-1")
    with pytest.raises(
        ArchiveError, match=r"report\.json cannot be read; found .*Run the campaign"
    ):
        read_details(tmp_path)
