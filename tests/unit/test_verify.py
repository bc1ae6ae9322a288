"""What no longer belongs together is found, by its kind and under its name; nothing else is."""

import json
import os
import shutil
from pathlib import Path
from typing import get_args

import netCDF4
import pytest
from documentedcampaign import ROOT, copied, run

from reduction.archive.seal import write_seal
from reduction.batch.progress import Silent
from reduction.campaign.load import load_campaign
from reduction.verify.archives import Looked, look_at
from reduction.verify.campaign import look_at_all, stated_campaign, verify_campaign
from reduction.verify.finding import Finding, Kind
from reduction.verify.sources import SourceCheck

NAME = "two-tethers"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verified")
    (folder / "raw").mkdir()
    assert run(copied(folder / "raw"), folder).exit_status == 0
    return folder


@pytest.fixture
def place(made, tmp_path):
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path


@pytest.fixture
def without_tables(monkeypatch):
    """Leave out what takes longest, where a test is not about tables and pages."""
    monkeypatch.setattr("reduction.verify.campaign.check_tables", lambda *given: (0, []))
    monkeypatch.setattr("reduction.batch.run.write_report", lambda *given, **more: None)


def verified(place):
    campaign = load_campaign(place / "raw" / "campaign.toml")
    return verify(place / "processed" / NAME, campaign)


def verify(folder, campaign, **more):
    archives = look_at_all(folder, progress=Silent())
    return verify_campaign(folder, archives, campaign, progress=Silent(), **more)


def kinds(verification):
    return [(one.product, one.kind) for one in verification.findings]


def flip(path, at=0.5):
    """Turn over one bit of a file."""
    data = bytearray(path.read_bytes())
    data[int(at * len(data))] ^= 1
    path.write_bytes(data)


def swap(one, other):
    aside = one.with_suffix(".aside")
    one.rename(aside)
    other.rename(one)
    aside.rename(other)


def edit(path, before, after):
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after), encoding="utf-8")


def test_what_a_run_has_just_made_belongs_together(made):
    found = verified(made)
    assert found.findings == () and found.remarks == ()
    n_tables = len(list((made / "processed" / NAME / "tables").iterdir()))
    assert (found.campaign, found.n_archives, found.n_sources) == (NAME, 2, 2)
    assert found.n_tables == n_tables > 5


def test_nothing_is_written(made):
    def stamps():
        files = (path for path in sorted(made.rglob("*")) if path.is_file())
        return [(path, path.stat().st_mtime_ns, path.read_bytes()) for path in files]

    before = stamps()
    verified(made)
    assert stamps() == before


@pytest.mark.parametrize("at", [0.1, 0.5, 0.9])
def test_a_bit_that_is_turned_over_in_a_raw_file_is_found(place, at, without_tables):
    flip(place / "raw" / "T-2.csv", at)
    findings = verified(place).findings
    assert ("T-2.nc", "raw_file") in [(one.product, one.kind) for one in findings]
    (one,) = [one for one in findings if one.kind == "raw_file"]
    assert "T-2.csv is not the file from which it was made" in str(one)
    assert "take a copy of it that is as it was" in one.hint


@pytest.mark.parametrize("at", [0.0, 0.01, 0.3, 0.6, 0.9, 0.999])
def test_a_bit_that_is_turned_over_in_an_archive_is_found(place, at):
    path = place / "processed" / NAME / "T-1.nc"
    assert look_at(path).findings == []
    flip(path, at)
    kinds = [one.kind for one in look_at(path).findings]
    assert kinds in (["damaged"], ["changed"])  # the bytes, or the words of their sum


def test_what_rests_on_a_damaged_archive_is_not_said_to_be_sound(place):
    flip(place / "processed" / NAME / "T-1.nc")
    assert kinds(verified(place)) == [("T-1.nc", "damaged"), ("tables", "not_compared")]


def test_two_archives_that_are_swapped_are_found(place, without_tables):
    folder = place / "processed" / NAME
    swap(folder / "T-1.nc", folder / "T-2.nc")
    found = verified(place).findings
    assert [one.product for one in found if one.kind == "misplaced"] == ["T-1.nc", "T-2.nc"]
    assert "the archive 'two-tethers/T-2'; needed 'two-tethers/T-1'" in str(found[0])


def test_swapped_archives_are_made_again_by_the_next_run(place, without_tables):
    folder = place / "processed" / NAME
    before = {path.name: path.read_bytes() for path in folder.glob("*.nc")}
    swap(folder / "T-1.nc", folder / "T-2.nc")
    run(place / "raw" / "campaign.toml", place)
    assert {path.name: path.read_bytes() for path in folder.glob("*.nc")} == before
    assert verified(place).findings == ()


def test_two_tables_that_are_swapped_and_one_that_is_edited_are_found(place):
    tables = place / "processed" / NAME / "tables"
    swap(tables / "cycles.csv", tables / "notes.csv")
    lines = (tables / "moduli.csv").read_bytes().splitlines(keepends=True)
    lines[3] = lines[3].replace(b"1", b"2", 1)
    (tables / "moduli.csv").write_bytes(b"".join(lines))
    (tables / "specimens.csv").unlink()
    (tables / "older.csv").write_text("a,b\n")
    found = verified(place)
    assert sorted(kinds(found)) == [
        ("tables/cycles.csv", "table"),
        ("tables/moduli.csv", "table"),
        ("tables/notes.csv", "table"),
        ("tables/older.csv", "stray"),
        ("tables/specimens.csv", "missing"),
    ]
    (line,) = [one.found for one in found.findings if one.product == "tables/moduli.csv"]
    assert line == "another line 4"


def test_another_setting_is_named_with_what_it_was(place, without_tables):
    path = place / "raw" / "campaign.toml"
    edit(path, "[defaults]\n", "[defaults]\nreduction.modulus.window = 0.07\n")
    found = verified(place)
    assert kinds(found) == [("T-1.nc", "settings"), ("T-2.nc", "settings")]
    assert "window" in found.findings[0].found and "now 0.07" in found.findings[0].found


def test_other_marks_are_found_though_no_log_has_changed(place, without_tables):
    marks = place / "raw" / "marks.csv"
    lines = marks.read_text(encoding="utf-8").splitlines()
    marks.write_text("\n".join(lines[:-1]) + "\n", encoding="utf-8")
    found = verified(place)
    assert {one.kind for one in found.findings} == {"settings"}
    assert "strain" in found.findings[0].found


def test_an_archive_that_another_program_changed_is_found(place, without_tables):
    path = place / "processed" / NAME / "T-1.nc"
    with netCDF4.Dataset(path, "a") as archive:
        archive.comment = "seen"
    assert ("T-1.nc", "changed") in kinds(verified(place))


def test_an_archive_that_was_changed_and_sealed_again_breaks_the_rules_of_its_schema(place):
    path = place / "processed" / NAME / "T-1.nc"
    with netCDF4.Dataset(path, "a") as archive:
        archive.createVariable("unheard_of", "f8")
    write_seal(path)
    (one,) = look_at(path).findings
    assert one.kind == "damaged" and "unheard_of is not in the schema" in one.found


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("raw_file", "../../etc/passwd", "names a source outside of the folder"),
        ("raw_file", "/etc/passwd", "names a source outside of the folder"),
        ("raw_file_bytes", "many", "does not say what it was made from"),
    ],
)
def test_sources_that_are_none_are_told_and_not_read(place, name, value, words):
    path = place / "processed" / NAME / "T-1.nc"
    with netCDF4.Dataset(path, "a") as archive:
        archive.setncattr(name, value)
    write_seal(path)
    check = SourceCheck(path.parent, load_campaign(place / "raw" / "campaign.toml"))
    (one,) = check.findings(look_at(path))
    assert one.kind == "damaged" and words in one.problem and check.n_read == 0


def test_products_that_are_gone_and_such_as_nothing_asks_for_are_found(place, without_tables):
    folder = place / "processed" / NAME
    (folder / "T-2.nc").unlink()
    edit(place / "raw" / "tests.csv", "T-1,", "T-9,")
    edit(place / "raw" / "marks.csv", "T-1,", "T-9,")
    found = kinds(verified(place))
    assert {("T-2.nc", "missing"), ("T-9.nc", "missing"), ("T-1.nc", "stray")} <= set(found)


def test_a_raw_file_that_is_gone_is_found_and_not_taken_for_a_fault_of_the_settings(
    place, without_tables
):
    campaign = load_campaign(place / "raw" / "campaign.toml")
    (place / "raw" / "T-2.csv").unlink()
    found = verify(place / "processed" / NAME, campaign)
    (one,) = [one for one in found.findings if one.product == "T-2.nc"]
    assert one.kind == "raw_file" and "No such file" in one.found


def test_a_lock_and_a_file_that_was_begun_are_told_as_unfinished(place, without_tables):
    folder = place / "processed" / NAME
    (folder / "run.lock").write_text("{}")
    (folder / "tables" / ".cycles.csv.1-a.part").write_text("half")
    assert kinds(verified(place)) == [
        ("run.lock", "unfinished"), ("tables/.cycles.csv.1-a.part", "unfinished"),
    ]  # fmt: skip


def test_rows_of_status_that_speak_of_other_logs_are_found(place, without_tables):
    path = place / "processed" / NAME / "status.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    digest = lines[1].split(",")[-2]
    path.write_text("\n".join([lines[0], lines[1].replace(digest, "0" * 64)]) + "\n")
    assert kinds(verified(place)) == 2 * [("status.csv", "status")]
    path.unlink()
    assert kinds(verified(place)) == [("status.csv", "missing")]


def test_a_test_that_failed_is_a_remark_and_its_older_archive_no_fault(place, without_tables):
    path = place / "processed" / NAME / "status.csv"
    rows = path.read_text(encoding="utf-8").replace("reduced_with_notes,0,", "failed,3,")
    path.write_text(rows, encoding="utf-8")
    found = verified(place)
    assert found.findings == () and len(found.remarks) == 2
    assert "T-1 failed in its last run" in found.remarks[0]


def test_what_the_laboratory_states_now_is_compared_with_what_was_kept(place, without_tables):
    path = place / "raw" / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text + '\n[report]\nclient.name = "Another"\n', encoding="utf-8")
    assert ("report.json", "settings") in kinds(verified(place))
    run(path, place)
    assert verified(place).findings == ()
    kept = place / "processed" / NAME / "report.json"
    assert json.loads(kept.read_text(encoding="utf-8"))["client"]["name"] == "Another"
    kept.write_text("{", encoding="utf-8")
    assert ("report.json", "damaged") in kinds(verified(place))


def test_without_a_campaign_the_products_are_compared_with_each_other_alone(place):
    folder = place / "processed" / NAME
    flip(place / "raw" / "T-1.csv")
    found = verify(folder, None, unknown="it is lost")
    assert kinds(found) == [("campaign.toml", "not_compared")]
    assert found.findings[0].found == "it is lost" and found.n_tables > 5
    swap(folder / "T-1.nc", folder / "T-2.nc")
    found = verify(folder, None)
    assert [one.product for one in found.findings if one.kind == "misplaced"] == [
        "T-1.nc", "T-2.nc",
    ]  # fmt: skip


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads every file")
def test_an_archive_that_is_closed_to_this_user_is_a_finding(place, without_tables):
    path = place / "processed" / NAME / "T-1.nc"
    path.chmod(0)
    assert ("T-1.nc", "damaged") in kinds(verified(place))


def test_a_finding_is_one_line_in_the_form_of_errors():
    assert str(Finding("T-1.nc", "damaged", "it is cut", "a", "b", "Look.")) == (
        "T-1.nc: it is cut; found a; needed b. Look."
    )
    assert str(Finding("T-1.nc", "damaged", "it is cut")) == "T-1.nc: it is cut"


def test_the_campaign_is_that_of_most_archives_and_damaged_ones_say_nothing():
    def looked(campaign):
        attributes = None if campaign is None else {"campaign": campaign}
        return Looked(Path("T-1.nc"), attributes)

    of_two = [looked(name) for name in (None, "other", "own", None, "own")]
    assert stated_campaign(of_two) == "own"
    assert stated_campaign([looked(None)]) == stated_campaign([]) == ""


def test_every_kind_is_explained_on_the_page():
    page = (ROOT / "docs" / "verify.md").read_text(encoding="utf-8")
    rows = [line.split("`")[1] for line in page.splitlines() if line.startswith("| `")]
    assert rows == list(get_args(Kind))
