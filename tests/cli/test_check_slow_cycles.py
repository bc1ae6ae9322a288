"""Cycles of hours may be a time in milliseconds, unless the log has dates and times of day."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from typer.testing import CliRunner

from reduction.cli.main import app

CAMPAIGN = """
[campaign]
id = "slow"
title = "Slow cycles (synthetic)"
source = "synthetic"
[specimens.rope]
kind = "rope"
material = "nylon"
diameter = "20 mm"
gauge_length = "2 m"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = {{ column = "t", unit = "{unit}" }}
tension.1 = {{ column = "f", unit = "N" }}
[layouts.log.channels.crosshead_position]
column = "x"
unit = "m"
datum = "displacement"
[tests.S-1]
kind = "cyclic"
waveform = "sinusoidal"
file = "S-1.csv"
layout = "log"
specimens = ["rope"]
"""


@pytest.mark.parametrize(("unit", "is_doubted"), [("s", True), ("clock", False)])
def test_a_time_of_day_has_no_unit_to_doubt(unit, is_doubted, tmp_path, monkeypatch):
    time = np.arange(0.0, 200 + 5 * 3600, 10)
    travel = 0.15 * (1 - np.cos(2 * np.pi * np.clip(time - 200, 0, None) / 3600))
    load = 5e4 * travel + 2e5 * travel**2
    start = datetime(2026, 3, 1, 8, tzinfo=UTC)
    stamps = [
        f"{start + timedelta(seconds=at):%Y-%m-%d %H:%M:%S}" if unit == "clock" else f"{at:.0f}"
        for at in time.tolist()
    ]
    rows = zip(stamps, travel, load, strict=True)
    text = "t,x,f\n" + "".join(f"{t},{x:.5f},{f:.1f}\n" for t, x, f in rows)
    (tmp_path / "S-1.csv").write_text(text, encoding="utf-8")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.format(unit=unit), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["check", "campaign.toml"], env={"COLUMNS": "4000"})
    assert done.exit_code == 0, done.output
    assert ("a cycle takes 1 h" in done.output) == is_doubted
