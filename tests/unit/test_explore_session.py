"""What the explorer shows is what a run makes, and what it saves is what it showed."""

import os
import re
import shutil
from dataclasses import fields
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from documentedcampaign import copied, run
from nopage import NO_ANSWERS

from reduction.archive.open import open_archive
from reduction.archive.product_files import CAMPAIGN_PLACE
from reduction.archive.write import write_archive
from reduction.campaign.load import find_campaign
from reduction.pages.explorer_campaign import (
    _BY_KEY,
    SETTINGS,
    CampaignText,
    Session,
    settings_of_kind,
)
from reduction.pages.explorer_server import _campaign_document, _change_document, _save_document
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.settings import ReductionSettings


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("explored")
    (folder / "raw").mkdir()
    path = copied(folder / "raw")
    assert run(path, folder).exit_status == 0
    return path


@pytest.fixture
def place(campaign, tmp_path):
    """A copy of the campaign with its archives, for a test that writes."""
    shutil.copytree(campaign.parent.parent, tmp_path, dirs_exist_ok=True)
    return tmp_path


def session_of(place):
    return Session(place / "raw" / "campaign.toml", place / "processed" / "two-tethers")


def modulus(made):
    return made.dataset["tangent_modulus"].values


@pytest.fixture(scope="module")
def session(campaign):
    return session_of(campaign.parent.parent)


_NO_ANSWERS = NO_ANSWERS


def test_an_archive_stands_while_nothing_is_changed(session):
    made = session.made("T-1", session.text)
    assert made.error == "" and made.is_standing and made.also == ()


@pytest.mark.nightly  # tests/browser/test_explorer.py saves and runs one setting by each click
def test_numbers_that_are_shown_are_those_of_a_run_after_the_save(place, monkeypatch):
    # what is made of archives takes long
    nothing = {"write_tables": [], "CampaignPage.write": (None, _NO_ANSWERS)}
    for name, given in nothing.items():
        monkeypatch.setattr(
            f"reduction.batch.run_campaign.{name}", lambda *_, given=given, **__: given
        )
    session = session_of(place)
    changes = {"cycles.trim_threshold": "0.9", "modulus.window": "6 %"}
    text = session.changed("T-1", changes)
    shown = session.made("T-1", text)
    before = session.made("T-1", session.text)
    assert not np.array_equal(modulus(before), modulus(shown), equal_nan=True)
    session.save(text)
    assert run(place / "raw" / "campaign.toml", place, tests=["T-1"]).exit_status == 0
    with open_archive(place / "processed" / "two-tethers" / "T-1.nc") as archive:
        xr.testing.assert_identical(archive.drop_attrs(deep=True), _as_read(shown, place))
        assert archive.attrs["settings"] == shown.dataset.attrs["settings"]
    assert session.made("T-1", session.text).is_standing


def _as_read(made, place):
    """The dataset as it comes back from a disk."""
    write_archive(made.dataset, place / "shown.nc")
    with open_archive(place / "shown.nc") as archive:
        return archive.drop_attrs(deep=True).load()


def test_raw_files_and_archives_are_never_written(place):
    def stamps():
        return {
            path: (path.stat().st_mtime_ns, path.read_bytes())
            for path in place.rglob("*")
            if path.is_file() and path.name != "campaign.toml"
        }

    before = stamps()
    session = session_of(place)
    text = session.changed("T-2", {"cycles.break_in_cycles": "1"})
    session.made("T-2", text)
    session.save(text)
    assert stamps() == before


def test_tests_that_share_what_a_change_moves_are_named(session):
    moved = session.changed("T-1", {"phases.minimum_duration": "100 s"})
    assert session.made("T-1", moved).also == ("T-2",), "a mark has lost its hold"
    alone = session.changed("T-1", {"modulus.window": "6 %"})
    assert session.made("T-1", alone).also == ()


def test_a_test_that_cannot_be_reduced_says_why(session):
    changes = {"cycles.band": "300 ft"}
    made = session.made("T-1", session.changed("T-1", changes))
    assert made.dataset is None and "band" in made.error
    found = _change_document(session, "si", test="T-1", changes=changes)
    assert found["error"] == made.error and found["section"] == ""
    assert "+reduction.cycles.band" in found["diff"]


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"cycles.trim_threshold": "2"}, "trim_threshold is out of range"),
        ({"modulus.window": "1 lbf"}, "unit"),
        ({"phases.minimum_duration": "5"}, "a value has no unit"),
        ({"strain.method": "guess"}, "strain.method"),
        ({"waveform": "<b>"}, "waveform"),
    ],
)
def test_a_value_that_a_run_would_refuse_is_refused(session, changes, match):
    with pytest.raises(SettingsError, match=match):
        session.made("T-1", session.changed("T-1", changes))


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"archive.samples": "all"}, "cannot be changed here; found 'archive.samples'"),
        ({"file": "/etc/passwd"}, "cannot be changed here"),
        ({"cycles.trim_threshold.x": "1"}, "cannot be changed here"),
        ({"cycles.trim_threshold": "steep"}, "is not a number; found 'steep'"),
        ({"steps.0.from": ""}, "a step has both ends"),
    ],
)
def test_keys_that_are_not_offered_are_refused(session, changes, match):
    with pytest.raises(SettingsError, match=match):
        session.changed("T-1", changes)


def test_a_test_that_is_not_there_is_refused(session):
    with pytest.raises(SettingsError, match="no such test; found '../x'"):
        session.changed("../x", {})


def test_a_table_of_tests_goes_on_beside_the_settings_of_one(tmp_path):
    path = copied(tmp_path)
    own = path.read_text(encoding="utf-8").replace('tests = "tests.csv"\n', "")
    text = of_text(tmp_path, 'tests = "tests.csv"\n\n' + own)
    after = text.changed("T-1", {"cycles.trim_threshold": "0.9"}, control="position")
    diff = text.difference(after)
    changed = [line for line in diff.splitlines() if re.match(r"[-+](?![-+])", line)]
    assert changed == [
        '-tests = "tests.csv"', '+tests = "tests.csv"', "+", "+[tests.T-1]",
        "+reduction.cycles.trim_threshold = 0.9",
    ]  # fmt: skip


def test_a_file_that_changed_meanwhile_is_not_written_over(place):
    session = session_of(place)
    path = place / "raw" / "campaign.toml"
    text = session.changed("T-1", {"cycles.trim_threshold": "0.9"})
    theirs = path.read_text("utf-8") + "# of somebody else\n"
    path.write_text(theirs, encoding="utf-8")
    assert session.is_changed_on_disk
    with pytest.raises(SettingsError, match=r"changed on the disk since .* Nothing was written"):
        session.save(text)
    assert path.read_text("utf-8") == theirs
    session.read_again()
    assert not session.is_changed_on_disk


def test_a_disk_that_refuses_leaves_the_file_as_it_was(place, monkeypatch):
    session = session_of(place)
    text = session.changed("T-1", {"cycles.trim_threshold": "0.9"})
    before = session.path.read_bytes()

    def refuse(self, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", refuse)
    with pytest.raises(ArchiveError, match=r"cannot be written; found No space left"):
        session.save(text)
    assert session.path.read_bytes() == before
    assert sorted(path.name for path in session.path.parent.glob(".*")) == []


@pytest.mark.skipif(os.name != "posix", reason="modes and links of POSIX")
def test_a_link_stays_a_link_and_a_mode_stays(place):
    path = place / "raw" / "campaign.toml"
    real = path.rename(place / "raw" / "real.toml")
    path.symlink_to("real.toml")
    real.chmod(0o640)
    session = session_of(place)
    session.save(session.changed("T-1", {"cycles.trim_threshold": "0.9"}))
    assert path.is_symlink() and "trim_threshold" in real.read_text("utf-8")
    assert real.stat().st_mode & 0o777 == 0o640


def test_a_byte_order_mark_is_read_over_and_stays(place):
    path = place / "raw" / "campaign.toml"
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    session = session_of(place)
    session.save(session.changed("T-1", {"cycles.trim_threshold": "0.9"}))
    assert path.read_bytes().startswith(b"\xef\xbb\xbf[")
    assert "trim_threshold" in path.read_text("utf-8")
    assert not session.is_changed_on_disk


def test_a_file_that_cannot_be_read_is_said(tmp_path):
    with pytest.raises(SettingsError, match="the campaign cannot be read; found No such file"):
        CampaignText.read(tmp_path / "campaign.toml")


def of_text(tmp_path, text):
    return CampaignText(tmp_path / "campaign.toml", text)


@pytest.mark.parametrize(
    ("text", "method", "made"),
    [
        ('[defaults]\nstrain = { marks = "m.csv" }\n[tests.T]\n', "marks",
         '[tests.T]\nstrain = { method = "marks", marks = "m.csv" }\n'),
        ('[tests.T]\nstrain = { method = "marks", marks = "m.csv" }\n', "",
         '[tests.T]\nstrain = { marks = "m.csv" }\n'),
        ('[tests.T]\nstrain = { method = "marks" }\n', "", "[tests.T]\n"),
        ('[defaults]\nstrain = { method = "marks" }\n[tests.T]\nstrain = { method = "strain-ratio" }\n', "",
         "[tests.T]\nstrain = {}\n"),
        ('[defaults]\nstrain = { method = "marks" }\n[tests.T]\n', "marks", "[tests.T]\n"),
        ('[tests.T]\nstrain.marks = "m.csv"\n', "marks",
         '[tests.T]\nstrain.marks = "m.csv"\nstrain.method = "marks"\n'),
    ],
)  # fmt: skip
def test_a_strain_method_keeps_the_marks(tmp_path, text, method, made):
    found = of_text(tmp_path, text).changed("T", {"strain.method": method}, control="position")
    assert found.text.partition("[tests.T]")[2] == made.partition("[tests.T]")[2]


@pytest.mark.parametrize(
    ("key", "text", "line"),
    [
        ("holds.times", "1 s, 60 s", 'reduction.holds.times = ["1 s", "60 s"]'),
        ("modulus.stress_at_strain", "0.5,100 %", 'reduction.modulus.stress_at_strain = [0.5, "100 %"]'),
        ("cycles.break_in_cycles", "3", "reduction.cycles.break_in_cycles = 3"),
        ("cycles.band", "0.2 ft", 'reduction.cycles.band = "0.2 ft"'),
        ("control", "load", 'control = "load"'),
        ("modulus.window", "0.05", "reduction.modulus.window = 0.05"),
    ],
)  # fmt: skip
def test_a_text_is_written_as_campaign_toml_has_it(tmp_path, key, text, line):
    found = of_text(tmp_path, "[tests.T]\n").changed("T", {key: text}, control="position")
    assert found.text == f"[tests.T]\n{line}\n"
    setting = _BY_KEY[key]
    assert found.written("T", setting).place == "test"
    assert found.changed("T", {key: ""}, control="position").text == "[tests.T]\n"


def test_ends_of_a_step_are_moved(tmp_path):
    text = '[tests.T]\n[[tests.T.steps]]\nname = "a"\nfrom = 1\nto = 5\n'
    found = of_text(tmp_path, text).changed("T", {"steps.0.to": "7"}, control="position")
    assert found.text == text.replace("to = 5", "to = 7")
    assert found.step_ends("T", 0) == {"steps.0.from": "1", "steps.0.to": "7"}


def test_what_stands_in_the_table_of_tests_is_changed_there(tmp_path):
    (tmp_path / "tests.csv").write_text("id,file,method\nT,a.csv,marks\n", encoding="utf-8")
    text = of_text(tmp_path, '[campaign]\ntests = "tests.csv"\n')
    assert text.written("T", _BY_KEY["strain.method"]).place == "table"
    with pytest.raises(SettingsError, match="is set in the table of tests"):
        text.changed("T", {"strain.method": "marks"}, control="position")


def test_every_number_of_a_reduction_is_offered_but_those_of_the_archive():
    known = {
        f"{group.name}.{item.name}"
        for group in fields(ReductionSettings)
        for item in fields(group.default_factory)
        if group.name != "archive" and (group.name, item.name) != ("cycles", "expected_cycles")
    }
    known -= {"cycles.control", "cycles.waveform"}  # keys of the test itself
    assert {one.key for one in SETTINGS} == known | {"control", "waveform"}
    assert settings_of_kind("stepwise") == []
    assert "cycles.band" not in {one.key for one in settings_of_kind("relaxation")}


def sections(text):
    """Headings, tables and figures of the section of a test as a report has it."""
    tables = [
        [
            [unescape(cell) for cell in re.findall(r"<t[dh][^>]*>([^<]*)</t[dh]>", row)]
            for row in table.split("<tr>")[1:]
        ]
        for table in text.split("<table>")[1:]
    ]
    return re.findall(r"<h3>([^<]*)</h3>", text), tables, re.findall(r'<figure id="([^"]+)"', text)


def first_modulus(section):
    """Heading and number of the first segment modulus."""
    for rows in sections(section)[1]:
        for place, head in enumerate(rows[0]):
            if head.startswith("segment modulus"):
                return head, float(rows[1][place].split()[0])
    raise AssertionError("there is no table of segments")


def test_the_page_is_sent_settings_the_section_of_the_report_and_the_diff(session):
    changes = {"cycles.trim_threshold": "0.8"}
    before = _change_document(session, "us", test="T-1", changes={})
    found = _change_document(session, "us", test="T-1", changes=changes)
    assert before["diff"] == "" and before["is_standing"] and before["also"] == []
    assert "+reduction.cycles.trim_threshold = 0.8" in found["diff"].splitlines()
    assert not found["is_standing"]
    headings, _, figures = sections(found["section"])
    assert headings == sections(before["section"])[0]
    assert {"Modulus against strain", "Record", "Loops", "Strain and splices"} <= set(headings)
    # both stand on one page: no name of a part of one is that of a part of the other
    assert figures and not set(figures) & set(sections(before["section"])[2])
    made = session.made("T-1", session.changed("T-1", changes))
    in_psi = made.dataset["segment_modulus"].values[0, 0, 0] / 6894.757293168361
    head, value = first_modulus(found["section"])
    assert "psi" in head
    assert value == pytest.approx(in_psi, rel=5e-3)
    assert value != first_modulus(before["section"])[1]
    settings = {one["key"]: one for one in found["settings"]}
    assert settings["cycles.trim_threshold"]["value"] == "0.8"
    assert settings["cycles.trim_threshold"]["place"] == "test"
    assert settings["modulus.strain_bin_width"]["shown"] == "1 %"
    assert settings["modulus.strain_bin_width"]["place"] == "defaults"
    assert settings["cycles.band"]["place"] == "found"
    assert settings["cycles.band"]["shown"].endswith(" ft")
    assert settings["cycles.break_in_cycles"]["place"] == "default"


def test_what_is_shown_of_the_file_is_the_section_of_the_report_of_its_run(session, campaign):
    found = _change_document(session, "si", test="T-1", changes={})
    (page,) = campaign.parent.parent.glob("**/two-tethers/index.html")
    text = page.read_text("utf-8").partition('data-title="T-1"')[2].partition("</section>")[0]
    ours, theirs = sections(found["section"]), sections(text)
    assert ours[:2] == theirs[:2] and len(ours[2]) == len(theirs[2]) > 3


def test_what_was_shown_is_what_is_saved(place):
    session = session_of(place)
    changes = {"cycles.trim_threshold": "0.9"}
    before, after = session.text.digest, session.changed("T-1", changes).digest
    text = session.path.read_text("utf-8")
    for digests in ({"before": before, "after": "other"}, {"before": "other", "after": after}):
        with pytest.raises(SettingsError, match=r"not of this file any more. Nothing was written"):
            _save_document(session, test="T-1", changes=changes, **digests)
    assert session.path.read_text("utf-8") == text
    saved = _save_document(session, test="T-1", changes=changes, before=before, after=after)
    assert saved == {"saved": str(session.path)}
    assert "reduction.cycles.trim_threshold = 0.9" in session.path.read_text("utf-8")


def test_the_page_is_told_of_every_test(session):
    found = _campaign_document(session, "si")
    assert [one["id"] for one in found["tests"]] == ["T-1", "T-2"]
    assert found["synthetic"] is True


def test_the_campaign_that_made_a_folder_is_found_there_also_after_both_were_moved(place):
    # the place is a copy of that in which the run was
    assert find_campaign(place / "processed" / "two-tethers") == place / "raw" / "campaign.toml"


def test_a_campaign_beside_its_products_is_found(place):
    processed = place / "processed" / "two-tethers"
    (processed / CAMPAIGN_PLACE).unlink()
    (place / "two-tethers").mkdir()
    there = place / "two-tethers" / "campaign.toml"
    shutil.copy(place / "raw" / "campaign.toml", there)
    assert find_campaign(processed) == there


def test_a_campaign_is_found_where_it_lies_by_habit(place, monkeypatch):
    processed = place / "processed" / "two-tethers"
    (processed / CAMPAIGN_PLACE).unlink()
    (place / "raw" / "two-tethers").mkdir()
    there = place / "raw" / "two-tethers" / "campaign.toml"
    shutil.copy(place / "raw" / "campaign.toml", there)
    assert find_campaign(processed) == there
    other = place / "elsewhere" / "two-tethers"
    shutil.copytree(processed, other / "archives")
    with pytest.raises(SettingsError, match=r"was not found.*needed --campaign"):
        find_campaign(other / "archives")
    monkeypatch.chdir(place)
    assert find_campaign(other / "archives") == there
    assert (
        find_campaign(other / "archives", place / "raw" / "campaign.toml").name == "campaign.toml"
    )


@pytest.mark.parametrize(
    ("text", "match"),
    [('[campaign]\nid = "other"\n', "found campaign 'other'; needed campaign 'two-tethers'"),
     ("= no toml", "found no campaign.toml"), ("campaign = 3\n", "found no campaign.toml")],
)  # fmt: skip
def test_another_campaign_is_refused(campaign, tmp_path, text, match):
    (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
    processed = campaign.parent.parent / "processed" / "two-tethers"
    with pytest.raises(SettingsError, match=match):
        find_campaign(processed, tmp_path / "campaign.toml")


def test_a_folder_of_several_campaigns_or_of_none_is_refused(campaign, tmp_path):
    with pytest.raises(SettingsError, match="one folder per campaign; found two-tethers"):
        find_campaign(campaign.parent.parent / "processed")
    with pytest.raises(ArchiveError, match=r"there is no archive of a test in .* Run the campaign"):
        find_campaign(tmp_path)


def test_a_step_of_a_log_is_moved_by_itself(tmp_path):
    path = copied(tmp_path)
    (tmp_path / "marks.csv").write_text(
        "test,specimen,hold,near_toe_ft,far_toe_ft,far_thimble_ft\n"
        + "".join(
            line + "\n"
            for line in (tmp_path / "marks.csv").read_text("utf-8").splitlines()
            if line.startswith("T-1,")
        ),
        encoding="utf-8",
    )
    text = path.read_text("utf-8").replace('tests = "tests.csv"\n', "")
    path.write_text(
        text + '\n[tests.T-1]\nfile = "T-1.csv"\norder = 1\n'
        '[[tests.T-1.steps]]\nname = "cycles"\nfrom = "340 s"\nto = "390 s"  # of the drive\n'
        '[[tests.T-1.steps]]\nname = "hold"\nfrom = "150 s"\nto = "330 s"\nkind = "relaxation"\n',
        encoding="utf-8",
    )
    session = Session(path, tmp_path / "processed")
    assert [one.plan.id for one in session.surveys] == ["T-1.cycles", "T-1.hold"]
    before = session.made("T-1.cycles", session.text)
    text = session.changed("T-1.cycles", {"steps.0.to": "380 s"})
    assert 'to = "380 s"  # of the drive' in text.text
    after = session.made("T-1.cycles", text)
    assert 0 < after.dataset.sizes["cycle"] < before.dataset.sizes["cycle"]
    found = _change_document(session, "si", test="T-1.cycles", changes={"steps.0.to": "380 s"})
    steps = {one["key"]: one["value"] for one in found["settings"] if one["group"] == "Steps"}
    assert steps == {"steps.0.from": "340 s", "steps.0.to": "380 s"}
    of_hold = _change_document(session, "si", test="T-1.hold", changes={})["settings"]
    assert {"cycles.band", "waveform"}.isdisjoint(one["key"] for one in of_hold)


def test_marks_that_changed_meanwhile_are_told_and_no_answer_is_of_both(place):
    session = session_of(place)
    as_it_was = modulus(session.made("T-1", session.text))
    marks = place / "raw" / "marks.csv"
    rows = [line.split(",") for line in marks.read_text("utf-8").splitlines()]
    toe = rows[0].index(next(name for name in rows[0] if name.startswith("near_toe")))
    for row in rows[1:]:
        row[toe] = f"{float(row[toe]) + 0.2:.3f}"
    marks.write_text("\n".join(map(",".join, rows)) + "\n", encoding="utf-8")
    assert session.is_changed_on_disk
    with pytest.raises(SettingsError, match="a file that it names, changed on the disk since it"):
        session.made("T-1", session.text)
    session.read_again()
    assert not session.is_changed_on_disk
    now = modulus(session.made("T-1", session.text))
    assert not np.array_equal(now, as_it_was, equal_nan=True)


@pytest.mark.skipif(os.name != "posix", reason="modes of POSIX")
def test_a_file_that_is_read_only_is_not_written_over(place):
    session = session_of(place)
    session.path.chmod(0o444)
    before = session.path.read_bytes()
    text = session.changed("T-1", {"cycles.trim_threshold": "0.9"})
    with pytest.raises(ArchiveError, match=r"cannot be written; found it is read-only"):
        session.save(text)
    assert session.path.read_bytes() == before


@pytest.mark.parametrize("key", ["steps.²1.from", "steps.x.from", "steps..from"])
def test_a_step_without_a_place_is_refused(session, key):
    with pytest.raises(SettingsError, match="cannot be changed here"):
        session.changed("T-1", {key: "1 s"})
