"""Which notes a reader sees first."""

import pytest

from reduction.batch.survey import note_message
from reduction.record.notes import by_severity, full_note, severity_of

METHOD = ("moduli", "tangent modulus by local regression in a window of 0.13 of strain")
REFUSED = ("hold 1 new", "refused: Prony series: a drop of 0.03% is not told from zero")
DOUBT = ("identity", "new: the closed-cycle identity leaves +2.2% of the stroke-mean modulus")
SAID = ("specimen new", "the printed diameters contradict each other")


@pytest.mark.parametrize(
    ("stage", "text", "severity"),
    [
        (*METHOD, "method"),
        (*REFUSED, "refusal"),
        (*DOUBT, "doubt"),
        (*SAID, "note"),
        ("ingest", "400 rows read, 400 kept, flagged: tension of new spike 3", "doubt"),
        ("cycles", "9 whole cycles found, 10 planned", "doubt"),
        ("test", "new: mean tension of the cycles is negative (-3 N); set sign = -1", "doubt"),
        ("stepwise", "1325: length 416.1 mm is 167 %; the row gives no modulus", "doubt"),
        ("test", "new: stress at 50 % not given: 1 samples within 10 % before it", "refusal"),
        ("experiment", "R05: the line goes slack in every cycle", "doubt"),
        ("experiment", "tau drifts over the order of the runs beyond its surface", "doubt"),
        ("experiment", "refused: stiffness forms of mooring codes: no strength", "refusal"),
        ("test", "hose: refused: quasi-static spring constant: no cubic", "refusal"),
        ("cycles", "one cycle only: there is no scatter from cycle to cycle", "note"),
    ],
)
def test_a_note_has_a_rank(stage, text, severity):
    assert severity_of(stage, text) == severity


def test_doubts_come_first_and_methods_last_and_those_alike_keep_their_order():
    later = ("identity", "used: the closed-cycle identity leaves +2.5%")
    notes = by_severity([METHOD, SAID, REFUSED, DOUBT, later])
    assert notes == (DOUBT, later, REFUSED, SAID, METHOD)


def test_the_message_of_a_test_names_the_most_serious_note():
    message = note_message([METHOD, SAID, REFUSED, DOUBT])
    assert message == f"4 notes (1 doubt, 1 refusal); first: identity: {DOUBT[1]}"
    assert note_message([METHOD]) == f"1 note; first: moduli: {METHOD[1]}"
    assert note_message([]) == ""


def test_the_message_of_a_test_says_of_what_the_first_note_speaks_and_counts_each_specimen():
    text = "the fitted law is not stable: do not use it in a model"
    message = note_message([("yeoh new", text), ("yeoh used", text)])
    assert message == f"2 notes (2 doubts); first: yeoh new: {text}"


def test_a_note_that_names_its_specimen_is_not_given_it_again():
    assert full_note("strain new", "new: marks differ") == "new: marks differ"
    assert full_note("hold 1 new", "new, used: marks differ") == "new, used: marks differ"
    assert full_note("hold 1 new", "newer marks differ") == "hold 1 new: newer marks differ"
    assert full_note("", "of the campaign") == "of the campaign"
