"""At a terminal tables and progress, in a pipe plain text, with --json one object, with --quiet nothing."""

import contextlib
import json
import os
import re
import shutil
import threading

import pytest
from commandruns import ROOT, loaded_process, reduction

pytestmark = pytest.mark.slow

pty = pytest.importorskip("pty", reason="a terminal is imitated where there are pseudo-terminals")
fcntl, termios = pytest.importorskip("fcntl"), pytest.importorskip("termios")

CAMPAIGN = ROOT / "raw" / "buoy-technology-1997" / "campaign.toml"
ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
COLOUR = re.compile(r"\x1b\[(?:\d+;)*(?:3[0-8]|4[0-8]|9[0-7])(?:;\d+)*m")


@pytest.fixture(scope="module")
def at_terminal():
    """Run the command with a terminal of so many columns: its status, and what was on the screen."""

    def run(*arguments, columns=80, **environment):
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, bytes([50, 0, columns, 0, 0, 0, 0, 0]))
        said = []

        def read():
            with contextlib.suppress(OSError):  # how Linux says that the other side is closed
                while part := os.read(ours, 65536):
                    said.append(part)

        reader = threading.Thread(target=read)
        reader.start()
        plain = {"COLUMNS": None, "NO_COLOR": None, "TERM": "xterm-256color"}
        done = runs.run(
            *arguments, seconds=300, environment=plain | environment, is_bounded=False,
            terminal=os.ttyname(theirs),
        )  # fmt: skip
        os.close(theirs)
        reader.join()
        os.close(ours)
        return done.status, b"".join(said).decode()

    runs = loaded_process()
    return run


def places(folder):
    return "--processed", folder / "processed", "--reports", folder / "reports"


@pytest.fixture(scope="module")
def narrow(at_terminal, tmp_path_factory):
    return at_terminal("run", CAMPAIGN, *places(tmp_path_factory.mktemp("narrow")))


def test_a_run_with_one_job_shows_how_far_it_is(narrow):
    status, said = narrow
    assert status == 0
    shown = ESCAPE.sub("", said)
    assert "reading static" in shown and "reducing static" in shown
    assert "writing tables" in shown and "/?" not in shown
    assert "\N{BOX DRAWINGS HEAVY HORIZONTAL}" in said and "1/1 static" in ESCAPE.sub("", said)


def test_what_is_left_on_the_screen_fits_it_and_is_whole(narrow):
    _, said = narrow
    left = [line.split("\r")[-1] for line in ESCAPE.sub("", said).replace("\r\n", "\n").split("\n")]
    start = next(place for place, line in enumerate(left) if line.startswith("Pulls and weights"))
    end = next(place for place, line in enumerate(left) if line.startswith("archives:"))
    assert max(map(len, left[start:end])) <= 80
    text = " ".join(" ".join(left[start:end]).split())
    assert "the moduli of the adjacent intervals would be 0.62 and 0.33 MPa" in text
    assert "\N{HORIZONTAL ELLIPSIS}" not in text


def test_colours_are_left_out_where_nobody_wants_them(at_terminal, tmp_path, narrow):
    assert COLOUR.search(narrow[1])
    status, said = at_terminal("run", CAMPAIGN, *places(tmp_path), NO_COLOR="1")
    assert status == 0 and not COLOUR.search(said)


def test_an_error_of_a_test_is_said_once_on_a_screen_and_stands_in_the_table_of_a_pipe(
    at_terminal, tmp_path
):
    folder = tmp_path / "campaign"
    shutil.copytree(CAMPAIGN.parent, folder)
    (folder / "table_4.csv").unlink()
    status, said = at_terminal("check", folder / "campaign.toml")
    words = " ".join(ESCAPE.sub("", said).split())
    assert status == 3 and words.count("cannot be read") == 1 and "see below" in words
    assert "the file cannot be read" in reduction("check", folder / "campaign.toml").stdout


def test_json_at_a_terminal_is_one_object_and_nothing_else(at_terminal, tmp_path):
    status, said = at_terminal("run", CAMPAIGN, *places(tmp_path), "--json")
    assert status == 0 and json.loads(said)["tests"][0]["id"] == "static"


def test_quiet_at_a_terminal_says_nothing(at_terminal, tmp_path):
    assert at_terminal("run", CAMPAIGN, *places(tmp_path), "--quiet") == (0, "")


def test_a_pipe_has_one_line_a_test_and_progress_beside_it(tmp_path):
    done = reduction("run", CAMPAIGN, *places(tmp_path), FORCE_COLOR="1")
    assert "\x1b" not in done.stdout + done.stderr
    assert done.stderr.startswith(
        "1/1 static check: reading 1325: a length of 416.1 mm gives 167 %"
    )
    lines = done.stdout.splitlines()
    assert lines[0].startswith("Pulls and weights. Strain: ")
    assert lines[lines.index("Check:") + 1].startswith("  static: reading 1325: ")
    place = next(number for number, line in enumerate(lines) if line.startswith("specimen "))
    head, row = lines[place : place + 2]
    columns = re.split(r"  +", head)
    assert columns[:2] == ["specimen", "test"] and columns[-1] == "status"
    cells = re.split(r"  +", row)
    assert len(cells) == len(columns) and cells[:2] == ["short-tether", "static"]
    assert cells[-1] == "check"


def test_help_is_drawn_at_a_terminal_and_plain_and_whole_in_a_pipe(at_terminal):
    _, drawn = at_terminal("--help")
    assert "\N{BOX DRAWINGS LIGHT HORIZONTAL}" in drawn
    plain = reduction("--help", FORCE_COLOR="1").stdout
    assert plain.isascii() and "\x1b" not in plain and "..." not in plain.partition("Options:")[2]
    assert "Write a draft campaign.toml for a folder of logs, for you to complete." in " ".join(
        plain.split()
    )
    assert max(map(len, plain.splitlines())) <= 80


@pytest.mark.nightly
def test_sentences_are_broken_between_words_and_what_is_copied_is_not_broken(at_terminal, tmp_path):
    line = "rubber-tether-new-T-1", "--quantity", "tangent_modulus", "--strain", "100 %"
    status, said = at_terminal("lookup", *line, columns=60)
    said = ESCAPE.sub("", said)
    lines = said.replace("\r\n", "\n").split("\n")
    assert status == 0 and max(map(len, lines)) <= 60
    whole = reduction("lookup", *line).stdout.splitlines()
    notes = [one for one in whole if one.startswith("note: ") and len(one) > 60]
    assert notes and all(one in " ".join(said.split()) for one in notes)
    status, said = at_terminal("lookup", *line[:-1], "900 %", columns=60)
    assert status == 4 and max(map(len, said.replace("\r\n", "\n").split("\n"))) <= 60
    log = tmp_path / ("log " * 20 + ".csv")
    log.write_text("Zeit der Messung in s,Weg des Schlittens in mm,Kraft an der ersten Probe in N\n"
                   + "".join(f"{k},{k % 7},{k % 5}\n" for k in range(40)), encoding="utf-8")  # fmt: skip
    sniffed = reduction("sniff", log).stdout.splitlines()
    _, said = at_terminal("sniff", log)
    assert max(map(len, sniffed)) > 80
    assert said.replace("\r\n", "\n").splitlines() == sniffed
