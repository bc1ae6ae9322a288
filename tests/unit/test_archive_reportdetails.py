"""Details of the laboratory for the client report."""

import datetime
from pathlib import Path
from types import SimpleNamespace

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
from reduction.campaign.model import _ReportSection, report_details
from reduction.record.errors import ArchiveError, SettingsError

PATH = Path("campaign.toml")
PSI = 6894.757293168361
STEP = SimpleNamespace(
    name="slow pull", kind="quasi-static", product=lambda test: f"{test}.slow-pull"
)
TESTS = {
    "T-1": SimpleNamespace(id="T-1", kind="cyclic", steps=()),
    "P-1": SimpleNamespace(id="P-1", kind="cyclic", steps=(STEP,)),
}
LIMIT = {"quantity": "tangent_modulus", "test": "T-1", "upper": "1 MPa"}


def details(**section):
    return report_details(
        PATH, _ReportSection.model_validate(section), specimens=("new", "used"), tests=TESTS
    )


def limits(*rows, rule="guard band"):
    return details(decision_rule=rule, limits=list(rows)).limits


def test_a_campaign_without_a_report_states_nothing():
    assert report_details(PATH, None, specimens=(), tests={}) is None


def test_an_empty_report_is_one_in_which_nothing_is_stated():
    found = details()
    assert found.number == found.laboratory.name == found.authorised.by == ""
    assert found.limits == () and found.items == {} and found.decision_rule is None


def test_everything_arrives_at_its_place():
    found = details(
        number="17", revision=2, amendment="why", laboratory={"name": "L", "location": "there"},
        client={"name": "C", "order": "4711"}, authorised={"by": "P", "function": "head"},
        items={"new": {"identification": "tag", "condition": "dry"}},
        instruments=[{"name": "cell", "traceable_to": "standard"}], paper="Letter",
    )  # fmt: skip
    assert (found.number, found.revision, found.amendment) == ("17", 2, "why")
    assert (found.laboratory.name, found.laboratory.location) == ("L", "there")
    assert (found.client.name, found.client.order) == ("C", "4711")
    assert (found.authorised.by, found.authorised.function) == ("P", "head")
    assert found.items == {"new": ReportItem(identification="tag", condition="dry")}
    assert found.instruments == (Instrument(name="cell", traceable_to="standard"),)
    assert found.paper == "Letter"


def test_a_date_of_toml_is_shown_as_it_stands_there_and_text_may_be_one_too():
    assert details(issued=datetime.date(2026, 3, 5)).issued == "2026-03-05"
    assert details(issued="5 March 2026").issued == "5 March 2026"


def test_limits_are_in_si_in_whatever_unit_they_were_agreed():
    (found,) = limits(LIMIT | {"lower": "100 psi", "upper": "1.2 MPa"})
    assert (found.lower, found.upper) == pytest.approx((100 * PSI, 1.2e6))


def test_one_end_is_enough():
    (found,) = limits(LIMIT)
    assert found.lower is None and found.upper == pytest.approx(1e6)


def test_a_place_is_read_as_the_budget_reads_it():
    (found,) = limits(LIMIT | {"at": {"strain": "125 %", "branch": "ascending", "segment": 2}})
    assert found.at == {"strain": "1.25", "branch": "ascending", "segment": "2"}


@pytest.mark.parametrize("name", ["K_ap", "EA", "apparent_spring_constant"])
def test_a_limit_of_no_single_cycle_is_of_the_mean_of_the_test(name):
    wanted = {"quantity": name, "test": "T-1", "lower": "500 kN"}
    (found,) = limits(wanted)
    assert (found.quantity, found.lower) == ("test_apparent_spring_constant", 5e5)
    (found,) = limits(wanted | {"at": {"cycle": 3}})
    assert found.quantity == "apparent_spring_constant"


def test_a_step_of_a_test_goes_by_its_product():
    (found,) = limits(LIMIT | {"test": "P-1/slow pull"})
    assert found.test == "P-1.slow-pull"


@pytest.mark.parametrize(
    ("limit", "words"),
    [
        ({"quantity": "colour"}, r"limits\.0\.quantity is not known; found 'colour'"),
        ({"test": "T-9"}, r"limits\.0\.test is not a test of the campaign; found 'T-9'"),
        ({"test": "P-1"}, "is not a test of the campaign"),
        ({"upper": None}, r"limits\.0 has no limit; needed lower, upper, or both"),
        ({"upper": "3 lbf"}, r"limits\.0: a value has the unit of something else"),
        ({"upper": "stiff"}, r"limits\.0: a value is not a number with a unit"),
        ({"upper": "1 parrot"}, r"limits\.0: unit 'parrot' is not known"),
        ({"lower": "2 MPa"}, "the lower limit is not below the upper one; found 2 MPa and 1 MPa"),
        ({"at": {"strain": "2 lbf"}}, r"limits\.0: "),
    ],
)
def test_a_limit_that_cannot_be_used_is_named(limit, words):
    with pytest.raises(SettingsError, match=f"^campaign.toml: report.*{words}"):
        limits(LIMIT | limit)


def test_an_item_that_is_no_specimen_is_refused():
    with pytest.raises(
        SettingsError, match="not a specimen of the campaign; found old; needed one"
    ):
        details(items={"old": {}})


def test_limits_without_a_rule_are_refused():
    with pytest.raises(SettingsError, match="no decision rule for conformity"):
        limits(LIMIT, rule=None)


# ``report.json``: what the laboratory states, beside the archives

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
