"""Limits of a log: what is refused, with which words, and that they come from campaign.toml."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import numpy as np
import pytest

from reduction.campaign.load import load_campaign
from reduction.campaign.model import _LimitsSection
from reduction.readers.layout import Layout, Watch
from reduction.readers.raw_log import hash_source
from reduction.readers.read_log import read_log
from reduction.readers.sniff import sniff_layout
from reduction.record.errors import LogError, SettingsError
from reduction.record.settings import Limits

_LAYOUT = Layout.model_validate(
    {
        "format": "delimited",
        "channels": {
            "time": {"column": "t", "unit": "s"},
            "tension.1": {"column": "F", "unit": "N"},
        },
    }
)
_TOML = """
[campaign]
id = "synthetic"
title = "Synthetic"
source = "synthetic"
[specimens.new]
kind = "rubber tether"
diameter = ["1 in"]
[layouts.log]
format = "delimited"
channels.time = { column = "t", unit = "s" }
channels.tension.1 = { column = "F", unit = "N" }
[defaults]
layout = "log"
specimens = ["new"]
[tests.T-1]
file = "T-1.csv"
"""


def _log(folder: Path, rows: str = "0,1\n1,2\n") -> Path:
    path = folder / "T-1.csv"
    path.write_text("t,F\n" + rows)
    return path


def test_a_campaign_without_limits_has_the_defaults(tmp_path):
    _log(tmp_path)
    (tmp_path / "campaign.toml").write_text(_TOML)
    assert load_campaign(tmp_path / "campaign.toml").limits == Limits(
        file_size=100_000_000_000,
        unpacked_size=2_500_000_000,
        line_length=1_000_000,
        columns=10_000,
        time=3600.0,
    )


def test_limits_are_read_in_their_units():
    section = _LimitsSection(
        file_size="2 TB", unpacked_size="1.5 GiB", line_length="20 MB", columns=50, time="90 min"
    )
    assert Limits(**section.model_dump()) == Limits(
        file_size=2 * 10**12,
        unpacked_size=3 * 2**29,
        line_length=20 * 10**6,
        columns=50,
        time=5400.0,
    )


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("file_size", "1 B", 'this is not a limit; found \'1 B\'; needed "1 kB" to "100 TB"'),
        ("file_size", "1e30 GB", "a number is outside the physical range"),
        ("file_size", "1e6 TB", "a number is outside the physical range"),
        ("file_size", "900 TB", "this is not a limit"),
        ("file_size", "-5 GB", "this is not a limit"),
        ("unpacked_size", "12 rev", "a size is not in bytes; found '12 rev'"),
        ("unpacked_size", "12", "a size is not in bytes"),
        ("unpacked_size", "2 TB", '"1 MB" to "1 TB"'),
        ("line_length", "200 MB", '"1 kB" to "100 MB"'),
        ("columns", 0, "columns: this is not a limit; found '0'; needed a whole number from 1"),
        ("columns", 10**9, "to 1000000"),
        ("time", "0 s", 'time: this is not a limit; found \'0 s\'; needed "1 s" to "7 days"'),
        ("time", "3 years", "this is not a limit"),
        ("time", "5 m", "unit 'm' is not a unit of time"),
    ],
)
def test_a_limit_that_nobody_can_mean_is_refused(tmp_path, key, value, words):
    _log(tmp_path)
    (tmp_path / "campaign.toml").write_text(f"{_TOML}[limits]\n{key} = {json.dumps(value)}\n")
    with pytest.raises(SettingsError) as caught:
        load_campaign(tmp_path / "campaign.toml")
    assert f"  limits.{key}: " in str(caught.value)
    assert words in str(caught.value)


def test_a_limit_that_is_not_known_is_refused(tmp_path):
    _log(tmp_path)
    (tmp_path / "campaign.toml").write_text(_TOML + '[limits]\nmemory = "1 GB"\n')
    with pytest.raises(SettingsError, match=r"limits.memory: is not a known key"):
        load_campaign(tmp_path / "campaign.toml")


@pytest.mark.parametrize(
    ("limits", "rows", "message"),
    [
        (
            Limits(file_size=10),
            "0,1\n1,2\n",
            "T-1.csv: the file is too large; found 12 bytes; needed 10 bytes at most. If that is "
            "what was logged, raise file_size under [limits] of campaign.toml.",
        ),
        (
            Limits(columns=1),
            "0,1\n",
            "T-1.csv:2: the file has too many columns; found 2; needed 1 at most. If that is what "
            "was logged, raise columns under [limits] of campaign.toml.",
        ),
        (
            Limits(line_length=1000),
            "0,1\n" + "1" * 1001 + ",2\n",
            "T-1.csv:3: a line is too long to be a row of a log; found more than 1,000 bytes "
            "without a line end; needed one line a row. Check the format and the encoding of the "
            "layout. If that is what was logged, raise line_length under [limits] of "
            "campaign.toml.",
        ),
    ],
)
def test_a_log_beyond_a_limit_is_refused(tmp_path, limits, rows, message):
    path = _log(tmp_path, rows)
    with pytest.raises(LogError) as caught:
        read_log(path, _LAYOUT, name=path.name, limits=limits)
    assert str(caught.value) == f"{tmp_path}/{message}"


def test_a_log_that_takes_too_long_is_refused(tmp_path, monkeypatch):
    path = _log(tmp_path)
    clock = iter([0.0, 5000.0])
    monkeypatch.setattr(time, "monotonic", lambda: next(clock, 5000.0))
    with pytest.raises(LogError, match="takes too long to read; found 5e\\+03 s so far; needed 36"):
        read_log(path, _LAYOUT, name=path.name)


def test_a_row_longer_than_a_block_of_the_parser_is_read_where_the_limit_is_raised(tmp_path):
    wide = "0," + "0" * 3_000_000 + "1"
    path = _log(tmp_path, wide + "\n1,2\n")
    with pytest.raises(LogError, match="too long to be a row"):
        read_log(path, _LAYOUT, name=path.name)
    log = read_log(path, _LAYOUT, name=path.name, limits=Limits(line_length=4_000_000))
    np.testing.assert_array_equal(log.columns["tension.1"], [1.0, 2.0])


def test_what_a_file_unpacks_to_is_held_against_its_limit():
    watch = Watch(Path("log.xlsx"), Limits(unpacked_size=1000))
    watch.check_unpacked(1000, "the workbook")
    with pytest.raises(LogError, match=r"the workbook unpacks to more .* found 1,001 bytes"):
        watch.check_unpacked(1001, "the workbook")


@pytest.mark.posix
@pytest.mark.parametrize("look", [lambda path: read_log(path, _LAYOUT, name="log"), sniff_layout])
def test_a_pipe_a_device_and_a_folder_are_no_logs(tmp_path, look):
    os.mkfifo(tmp_path / "pipe")
    for path, found in (
        (tmp_path / "pipe", "a pipe"),
        (Path("/dev/zero"), "a device"),
        (tmp_path, "a folder"),
    ):
        with pytest.raises(LogError, match=f"this is not a readable file; found {found}"):
            look(path)


@pytest.mark.posix
def test_a_pipe_is_not_hashed(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(LogError, match="found a pipe; needed a regular file"):
        hash_source(tmp_path / "pipe", "pipe")
