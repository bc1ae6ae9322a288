"""The command that serves the explorer: what it prints, how it ends, what it refuses."""

import http.client
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
from contextlib import closing

import pytest
from commandruns import ROOT
from manytests import hear_interrupts

CAMPAIGN = ROOT / "raw" / "buoy-technology-1997" / "campaign.toml"


def started(run, *options):
    """The command in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "reduction", "explore", str(run.processed), "--no-browser",
         "--campaign", str(CAMPAIGN), *options],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)}, preexec_fn=hear_interrupts,
    )  # fmt: skip


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    "how", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.nightly)]
)
def test_it_prints_its_address_answers_and_ends_when_asked(static, how):
    process = started(static)
    try:
        first, second = process.stdout.readline(), process.stdout.readline()
        assert first == f"{CAMPAIGN}: 1 tests\n"
        word, address = second.split()
        assert word == "Open" and address.startswith("http://127.0.0.1:")
        place, _, query = address.removeprefix("http://").partition("/")
        for path, status in ((f"/{query}", 200), ("/", 403)):
            with closing(http.client.HTTPConnection(place, timeout=30)) as line:
                line.request("GET", path)
                assert line.getresponse().status == status
    finally:
        process.send_signal(how)
        said, wrong = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said.splitlines()[-1] == "Ended." and wrong == ""


def test_json_is_one_object_and_a_port_that_is_taken_is_refused(static, command):
    process = started(static, "--json")
    try:
        text = ""
        while not text.endswith("}\n"):
            line = process.stdout.readline()
            assert line, process.stderr.read()
            text += line
        found = json.loads(text)
        assert set(found) == {"address", "campaign", "port"}
        assert f"127.0.0.1:{found['port']}/?token=" in found["address"]
        done = command(
            "explore", static.processed, "--campaign", CAMPAIGN, "--no-browser",
            "--port", found["port"],
        )  # fmt: skip
        assert done.returncode == 2 and "the port cannot be had" in done.stderr
    finally:
        process.kill()
        process.communicate(timeout=60)


def test_a_campaign_that_is_not_found_is_said(static, command, tmp_path):
    processed = tmp_path / static.processed.name
    shutil.copytree(static.processed, processed)
    (processed / ".campaign").unlink()
    done = command("explore", processed, "--no-browser", cwd=tmp_path)
    assert done.returncode == 2
    assert "the campaign.toml of 'buoy-technology-1997' was not found" in done.stderr
    assert "needed --campaign CAMPAIGN.toml" in done.stderr


@pytest.mark.parametrize(
    ("options", "status", "said"),
    [
        (("--quiet", "--no-browser"), 2, "the address would not be shown anywhere"),
        (("--port", "65536"), 2, "Invalid value for '--port'"),
        (("--units", "furlongs", "--no-browser"), 2, "--units is not known"),
        (("--campaign", "s3://bucket/campaign.toml"), 2, "reads no URLs"),
    ],
)
def test_options_that_cannot_be_used_are_refused(static, command, options, status, said):
    done = command("explore", static.processed, *options)
    assert done.returncode == status and said in done.stderr


def test_a_folder_without_archives_is_refused(command, tmp_path):
    done = command("explore", tmp_path, "--no-browser")
    assert done.returncode == 6 and "there is no archive of a test" in done.stderr


def test_no_socket_is_left_behind(static):
    process = started(static, "--json")
    text = ""
    while not text.endswith("}\n"):
        text += process.stdout.readline()
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    with socket.socket() as again:
        assert again.connect_ex(("127.0.0.1", json.loads(text)["port"])) != 0
