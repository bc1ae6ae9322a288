"""The command ``verify``: what it says, how it ends, and where it looks for the campaign."""

import json
import os
import shutil

import pytest
from commandruns import loaded_process, reduction
from documentedcampaign import made_without_page

from reduction.archive.product_files import processed_folders

NAME = "two-tethers"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return made_without_page(tmp_path_factory.mktemp("verified"), NAME)


@pytest.fixture
def place(made, tmp_path):
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    return tmp_path


def test_where_all_belongs_together_it_says_so_and_ends_with_0(made):
    done = reduction("verify", "processed", cwd=made)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("processed/two-tethers: 2 archives, 2 sources, ")
    assert done.stdout.endswith(" tables: all agree\n")


def test_findings_are_errors_of_one_line_and_status_6(place):
    log = place / "raw" / NAME / "T-2.csv"
    data = bytearray(log.read_bytes())
    data[-20] ^= 1
    log.write_bytes(data)
    done = reduction("verify", f"processed/{NAME}", cwd=place)
    assert done.returncode == 6
    (line,) = [one for one in done.stderr.splitlines() if "T-2.csv" in one]
    assert line.startswith(f"processed/{NAME}/T-2.nc: T-2.csv is not the file from which it was")
    assert "findings" in done.stdout or "1 finding" in done.stdout


def test_the_answer_in_json_has_each_finding_with_its_kind(place):
    (place / "processed" / NAME / "T-1.nc").unlink()
    done = reduction("verify", "processed", "--json", cwd=place)
    assert done.returncode == 6
    (one,) = json.loads(done.stdout)["campaigns"]
    assert (one["campaign"], one["is_sound"]) == (NAME, False)
    found = {(each["product"], each["kind"]) for each in one["findings"]}
    assert ("T-1.nc", "missing") in found and ("tables/moduli.csv", "table") in found


def test_a_campaign_that_lies_elsewhere_is_named(place):
    (place / "raw").rename(place / "logs")
    done = reduction("verify", f"processed/{NAME}", cwd=place)
    assert done.returncode == 2
    assert "the campaign.toml of 'two-tethers' was not found" in done.stderr
    assert "--campaign CAMPAIGN.toml" in done.stderr
    stated = ("--campaign", f"logs/{NAME}/campaign.toml")
    done = reduction("verify", f"processed/{NAME}", *stated, "--quiet", cwd=place)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_one_campaign_is_not_that_of_several_folders(place):
    shutil.copytree(place / "processed" / NAME, place / "processed" / "other")
    stated = ("--campaign", f"raw/{NAME}/campaign.toml")
    done = reduction("verify", "processed", *stated, cwd=place)
    assert done.returncode == 2
    assert (
        "--campaign applies to the archives of one campaign; found processed, which contains other"
        in (done.stderr)
    )


def test_a_folder_without_archives_is_refused(tmp_path):
    done = reduction("verify", ".", cwd=tmp_path)
    assert done.returncode == 6 and "no archive was found" in done.stderr


def test_damaged_archives_do_not_keep_the_raw_files_from_being_compared(place):
    for name in ("T-1.nc", "T-2.nc"):
        path = place / "processed" / NAME / name
        whole = path.read_bytes()
        path.write_bytes(whole[: len(whole) // 2])
        done = reduction("verify", f"processed/{NAME}", cwd=place)
        assert done.returncode == 6
        told = done.stderr.splitlines()
        assert any(line.startswith(f"processed/{NAME}/{name}: ") for line in told)
        assert "0 tables" in done.stdout


def test_a_folder_that_may_not_be_looked_into_is_no_empty_one(place, monkeypatch):
    def refuse(folder):
        raise PermissionError(13, "Permission denied", str(folder))

    monkeypatch.setattr("os.listdir", refuse)
    with pytest.raises(PermissionError, match="Permission denied"):
        processed_folders(place / "processed")


@pytest.mark.nightly
@pytest.mark.skipif(os.name != "posix", reason="needs a pipe with a name")
def test_a_pipe_among_the_archives_is_a_finding_and_is_not_waited_for(place):
    folder = place / "processed" / NAME
    os.mkfifo(folder / "x.nc")
    (folder / "T-1.nc").unlink()
    os.mkfifo(folder / "T-1.nc")
    for words in (("verify", folder), ("report", folder), ("diff", folder, folder)):
        done = loaded_process().run(*map(str, words), cwd=place, seconds=60)
        assert done.status == 6
        assert "found a pipe, a socket or a device; needed a file" in done.errors
