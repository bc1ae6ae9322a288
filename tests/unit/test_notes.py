"""Which notes a reader sees first, and how serious each is."""

import re
from dataclasses import replace
from string import Formatter

import pytest

from reduction.record.note_sentences import SENTENCES
from reduction.record.notes import SEVERITIES, Note, by_severity, full_note, note, note_message

REFUSED = replace(note("drop-not-told-from-zero", drop=0.0003, spread=0.0011), stage="hold 1 new")
OPEN = replace(
    note(
        "identity-open",
        "new",
        effect=0.022,
        error=0.001,
        is_coarse=False,
        of_lag=0.0,
        is_of_turns=False,
    ),
    stage="identity",
)
SAID = replace(
    note("laboratory", text="the printed diameters contradict each other"), stage="specimen new"
)
# what a reader may be told, and whether it could move an answer
FACTS = {
    "Prony series not given: the drop, 0.03 %, is less than three times its standard uncertainty, "
    "0.11 %": (REFUSED, "refusal"),
    "the printed diameters contradict each other": (SAID, "note"),
    "flagged, of 400 rows: tension of new spike 3. Saturated and stuck readings and spikes are not "
    "used, and a cycle that loses its peak or valley has no EA. Look at them (quality_flag of the "
    "archive): where they are sound, raise reduction.quality.spike_factor or stuck_samples": (
        note("rows-flagged", n_read=400, n_kept=400, flags="tension of new spike 3"), "warning",
    ),
    "400 rows read, 400 kept, flagged: tension of new resampled 400": (
        note("rows-resampled", n_read=400, n_kept=400, flags="tension of new resampled 400"),
        "note",
    ),
    "the mean tension of 45700 N is outside the range of the slow pull Q01, 0 to 9999 N": (
        note("mean-tension-outside-pull", mean=45704.0, pull="Q01", low=0.0, high=9999.0),
        "warning",
    ),
    "9 complete cycles found, 10 planned": (
        note("cycles-not-as-planned", n_found=9, n_planned=10), "warning",
    ),
    "one cycle only: no cycle-to-cycle scatter can be given": (note("one-cycle"), "note"),
    "new: tension falls with stretch (median tangent modulus -1000000 Pa). If the log counts "
    "compression as positive, set sign = -1 for this channel; if it is set already, remove it": (
        note("sign-of-tension", "new", slope=-1e6), "warning",
    ),
    "1325: a length of 416.1 mm gives 167 %, but 151 % is recorded; the row gives no modulus. "
    "A length of 390.5 mm would agree, and the moduli of the adjacent intervals would be 0.62 and 0.33 MPa": (
        note(
            "reading-inconsistent", "1325", length=0.4161, strain=1.67, recorded=1.51,
            corrected=0.3905, speaks_for="", beside=[0.62e6, 0.33e6],
        ),
        "warning",
    ),
    "new: stress at 50 % not given: samples between 40 and 50 % strain: 1; needed 4": (
        note("stress-at-strain-not-given", "new", level=0.5, reason="samples between 40 and 50 % strain: 1; needed 4"),
        "refusal",
    ),
    "new: the slack rows scatter 1.6 times as much as tape reading explains (chi-square 26.5 with "
    "10 degrees of freedom, probability one in 320); their uncertainty is increased by this factor": (
        note(
            "marks-scatter", "new", rows="slack rows", ratio=1.6, chi_square=26.5, freedom=10,
            chance=1 / 320,
        ),
        "note",
    ),
    "new: 3 of 10 cycles drift by more than 20 % of their range; the drift affects their "
    "amplitudes, slopes and energies": (
        note("cycles-drift", "new", n_far=3, n_cycles=10, limit=0.2), "warning",
    ),
    "K_1 and tau not given in 2 of 3 cases: a value of the loop, such as K_ap or H, is missing": (
        note("no-line", n_lines=2, n_all=3, reason="a value of the loop, such as K_ap or H, is missing"),
        "refusal",
    ),
    "R05: the line goes slack in every cycle": (
        note("run-slack", "R05", cycles="every cycle"), "warning",
    ),
    "tau drifts with run order: its residuals change by +0.2 per run, +4.00 % of the response (p 0.01)": (
        note("response-drifts", response="tau", slope=0.2, share=0.04, p=0.01), "warning",
    ),
    "stiffness forms of mooring codes not given: no strength": (
        note("no-stiffness-forms", reason="no strength"), "refusal",
    ),
    "hose: quasi-static spring constant not given: no cubic": (
        note("no-pull", "hose", reason="no cubic"), "refusal",
    ),
    "the cords are broken from 150.9 % strain on: no load given": (
        note("cords-broken", strain=1.509), "refusal",
    ),
}  # fmt: skip


@pytest.mark.parametrize("sentence", FACTS)
def test_a_note_has_its_sentence_and_its_rank(sentence):
    found, severity = FACTS[sentence]
    assert (str(found), found.severity) == (sentence, severity)


def test_every_code_is_plain_and_has_a_severity_and_a_sentence():
    for code, (severity, template) in SENTENCES.items():
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", code)
        assert severity in SEVERITIES
        assert callable(template) or list(Formatter().parse(template))


def test_a_code_that_is_not_known_is_refused():
    with pytest.raises(KeyError):
        note("no-such-note")


def test_a_note_of_an_archive_says_what_stands_there():
    assert str(Note("of-a-later-version", "note", text="a sentence")) == "a sentence"


def test_warnings_come_first_and_those_alike_keep_their_order():
    later = replace(OPEN, subject="used")
    assert by_severity([SAID, REFUSED, OPEN, later]) == (OPEN, later, REFUSED, SAID)


def test_the_message_of_a_test_is_what_could_move_an_answer_most():
    assert note_message([SAID, REFUSED, OPEN]) == str(OPEN)
    assert note_message([SAID, REFUSED]) == ""
    far = replace(OPEN, subject="used", numbers={**OPEN.numbers, "effect": 0.3})
    assert note_message([OPEN, far]) == str(far)


def test_a_note_that_names_its_specimen_is_not_given_it_again():
    assert full_note("strain new", "new: marks differ") == "new: marks differ"
    assert full_note("hold 1 new", "new, used: marks differ") == "new, used: marks differ"
    assert full_note("hold 1 new", "newer marks differ") == "hold 1 new: newer marks differ"
    assert full_note("", "of the campaign") == "of the campaign"


def test_a_late_load_comes_before_what_follows_from_it():
    identity = note(
        "identity-open",
        "cord",
        effect=-0.02,
        error=0.001,
        is_coarse=False,
        of_lag=0.0,
        is_of_turns=False,
    )
    late = note("tension-late", "cord", lag=0.08, spread=0.002, stated=0.005,
                is_of_stops=False)  # fmt: skip
    work = note("loops-give-work", "cord", energy=-1.0, n_cycles=9, n_known=9, delay=0.02,
                stated=0.005, time_step=0.05, cause="driven")  # fmt: skip
    assert by_severity([identity, work, late]) == (late, work, identity)


def test_what_is_only_not_stated_of_a_machine_comes_behind_what_the_log_shows():
    unstated = note("compliance-matters", "a", compliance=1e-9, usual=3.8e-9, effect=0.0001)
    shown = note("few-samples-a-cycle", n_samples=7, needed=12, step=0.1)
    wrong = note("reference-length-under-preload", stated=0.0, found=900.0, specimen="a")
    ordered = by_severity([unstated, shown, wrong])
    assert [one.code for one in ordered] == [wrong.code, shown.code, unstated.code]


def test_a_percent_sign_has_a_space_before_it_and_a_name_is_left_as_it_is():
    found = note("cycles-drift", "a 10%-test", n_far=3, n_cycles=10, limit=0.2)
    assert "a 10%-test: 3 of 10 cycles drift by more than 20 % of" in str(found)
    # also in a sentence that a function composes
    assert "differ by 7 % of" in str(note("wave-changes", share=0.07, last=4, first=5, begin=12.0))


@pytest.mark.parametrize(("n_more", "said"), [(0, "a slip, a break"), (188, "moves in jerks")])
def test_many_lone_steps_are_the_way_of_a_channel(n_more, said):
    step = note("channel-steps", channel="tension of 'new'", low=1.6, high=1.9, unit="N", sample=60,
                time=8.2, n_more=n_more, beside="the position does")  # fmt: skip
    assert said in str(step)
