"""Hostile logs, campaigns, tables, paths and names: a status and a message, soon and in little memory."""

import os
import tomllib

import pytest
from csvrows import csv_rows
from hostile import DeadlinePassed, alone, complaints, deadline, in_here
from hostile_text import CASES, HEADER, campaign, log, one_line, rows, sparse

# pipes, devices and links are among the cases
pytestmark = pytest.mark.posix


@pytest.fixture(scope="module", autouse=True)
def loaded(command, tmp_path_factory):
    """What the first command loads is no memory of a case."""
    folder = tmp_path_factory.mktemp("first")
    (folder / "log.csv").write_bytes(HEADER + rows(500))
    command(*campaign(folder), cwd=folder)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_hostile_file_is_refused_soon_and_in_little_memory(case, command, tmp_path):
    ended = in_here(command, *case.make(tmp_path), cwd=tmp_path)
    assert not complaints(case, ended)


@pytest.mark.nightly
def test_a_long_line_in_a_process_with_little_memory(tmp_path):
    ended = alone(*one_line(tmp_path, 50_000_000), cwd=tmp_path, ceiling=6 << 30, deadline=120)
    assert ended.status == 3
    assert "a line is too long to be a row of a log" in ended.stderr
    assert ended.megabytes < 500


@pytest.mark.nightly
def test_ten_gigabytes_of_nothing_in_a_process_of_their_own(tmp_path):
    ended = alone(*sparse(tmp_path, 10**10), cwd=tmp_path, ceiling=6 << 30, deadline=120)
    assert ended.status == 3
    assert "a NUL byte" in ended.stderr
    assert ended.megabytes < 500


def test_the_deadline_of_a_case_ends_what_waits(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(DeadlinePassed), deadline(0.2):
        (tmp_path / "pipe").read_bytes()


def test_a_first_campaign_of_strangers_files_is_toml_and_names_them_as_they_are(command, tmp_path):
    names = ["=cmd.csv", "a\n[tests.evil]\n.csv", "\u202ex.csv", "b'\"c.csv", "d\x7f.csv"]
    for name in names:
        (tmp_path / name).write_bytes(b"time_s,force_N\n" + b"0,1\n1,2\n2,3\n" * 3)
    (tmp_path / "evil\n[x]\n.txt").write_text("no log\x1b[31m")
    (tmp_path / "out.csv").symlink_to("/etc/hostname")
    os.mkfifo(tmp_path / "pipe.csv")
    with deadline(60):
        done = command("init", tmp_path)
    assert done.returncode == 0, done.stderr
    document = tomllib.loads((tmp_path / "campaign.toml").read_text())
    assert set(document) - {"tests"} == {"campaign", "specimens", "defaults", "layouts"}
    assert "a link that leads out of the folder" in (tmp_path / "campaign.toml").read_text()
    written = {row["file"].removeprefix("'") for row in csv_rows(tmp_path / "tests.csv")}
    assert written == set(names)


@pytest.mark.parametrize("name", ["a\x7fb", "\x1b[31mforce", "fo\u202erce \u0085", 'q"]\n'])
def test_a_proposed_layout_of_odd_names_is_toml_that_finds_them(command, tmp_path, name):
    header = "time_s," + '"' + name.replace('"', '""').replace("\n", " ") + ' load_N"\n'
    log(header.encode() + b"0,1\n1,2\n2,3\n3,4\n")(tmp_path)
    done = command("sniff", tmp_path / "log.csv")
    assert done.returncode == 0, done.stderr
    assert "\x1b" not in done.stdout and "\u202e" not in done.stdout
    (layout,) = tomllib.loads(done.stdout)["layouts"].values()
    assert (
        layout["channels"]["tension"]["1"]["column"]
        == (name.replace("\n", " ") + " load_N").strip()
    )
