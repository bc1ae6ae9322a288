"""What no longer belongs together is found, by its kind and under its name; nothing else is."""

import os
import shutil
from typing import get_args

import h5py
import netCDF4
import pytest
from documentedcampaign import ROOT, copied, run
from nopage import NO_ANSWERS

from reduction.batch.campaign_status import Silent
from reduction.batch.verification import Kind, _Finding, verify_campaign
from reduction.campaign.load import load_campaign

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
    monkeypatch.setattr("reduction.batch.verification._of_tables", lambda *given: (0, []))
    monkeypatch.setattr(
        "reduction.batch.run_campaign.CampaignPage.write",
        lambda *given, **more: (None, NO_ANSWERS),
    )
    monkeypatch.setattr("reduction.batch.run_campaign.CampaignPage.add", lambda *given: None)


def verified(place):
    campaign = load_campaign(place / "raw" / "campaign.toml")
    return verify_campaign(campaign, place / "processed" / NAME, progress=Silent())


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
    n_tables = len(list((made / "processed" / NAME / "tables").glob("*.csv")))
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
    assert "restore the original" in one.hint


@pytest.mark.parametrize(
    "name", ["tension", "time", "segments/segment_modulus", "notes/note", "strain_bin"]
)
def test_a_bit_that_is_turned_over_in_a_value_is_found(place, name, without_tables):
    path = place / "processed" / NAME / "T-1.nc"
    with h5py.File(path) as file:
        values = file[name].id
        offset, size = values.get_offset(), values.get_storage_size()
        if offset is None:  # in chunks
            chunk = values.get_chunk_info(0)
            offset, size = chunk.byte_offset, chunk.size
    flip(path, (offset + size // 2) / path.stat().st_size)
    assert kinds(verified(place)) == [("T-1.nc", "damaged")]


def test_what_rests_on_a_damaged_archive_is_not_said_to_be_sound(place):
    path = place / "processed" / NAME / "T-1.nc"
    path.write_bytes(path.read_bytes()[:-1000])
    assert kinds(verified(place)) == [("T-1.nc", "damaged")]


def test_swapped_archives_are_found_and_made_again_by_the_next_run(place, without_tables):
    folder = place / "processed" / NAME
    before = {path.name: path.read_bytes() for path in folder.glob("*.nc")}
    swap(folder / "T-1.nc", folder / "T-2.nc")
    assert kinds(verified(place)) == [("T-1.nc", "settings"), ("T-2.nc", "settings")]
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
    found = verified(place)
    assert sorted(kinds(found)) == [
        ("tables/cycles.csv", "table"),
        ("tables/moduli.csv", "table"),
        ("tables/notes.csv", "table"),
        ("tables/specimens.csv", "missing"),
    ]


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


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("raw_file", "../../etc/passwd", "names a source outside of the folder"),
        ("raw_file", "/etc/passwd", "names a source outside of the folder"),
        ("raw_file_bytes", "1\n2", "does not say what it was made from"),
    ],
)
def test_sources_that_are_none_are_told_and_not_read(place, name, value, words, without_tables):
    with netCDF4.Dataset(place / "processed" / NAME / "T-1.nc", "a") as archive:
        archive.setncattr(name, value)
    (one,) = verified(place).findings
    assert one.kind == "damaged" and words in one.problem


def test_products_that_are_gone_are_found(place, without_tables):
    (place / "processed" / NAME / "T-2.nc").unlink()
    edit(place / "raw" / "tests.csv", "T-1,", "T-9,")
    edit(place / "raw" / "marks.csv", "T-1,", "T-9,")
    assert {("T-2.nc", "missing"), ("T-9.nc", "missing")} <= set(kinds(verified(place)))


def test_a_raw_file_that_is_gone_is_found_and_not_taken_for_a_fault_of_the_settings(
    place, without_tables
):
    campaign = load_campaign(place / "raw" / "campaign.toml")
    (place / "raw" / "T-2.csv").unlink()
    found = verify_campaign(campaign, place / "processed" / NAME, progress=Silent())
    (one,) = [one for one in found.findings if one.product == "T-2.nc"]
    assert one.kind == "raw_file" and "No such file" in one.found


@pytest.mark.posix
@pytest.mark.skipif(getattr(os, "geteuid", int)() == 0, reason="root reads every file")
def test_an_archive_that_is_closed_to_this_user_is_a_finding(place, without_tables):
    path = place / "processed" / NAME / "T-1.nc"
    path.chmod(0)
    assert ("T-1.nc", "damaged") in kinds(verified(place))


def test_a_finding_is_one_line_in_the_form_of_errors():
    assert str(_Finding("T-1.nc", "damaged", "it is cut", "a", "b", "Look.")) == (
        "T-1.nc: it is cut; found a; needed b. Look."
    )
    assert (
        str(_Finding("T-1.nc", "damaged", "it is cut"))
        == "T-1.nc: it is cut. Run the campaign again."
    )


def test_every_kind_is_explained_on_the_page():
    page = (ROOT / "docs" / "verify.md").read_text(encoding="utf-8")
    rows = [line.split("`")[1] for line in page.splitlines() if line.startswith("| `")]
    assert rows == list(get_args(Kind))
