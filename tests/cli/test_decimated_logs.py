"""Every n-th row of the logs of a campaign: too coarse is a fault of the data, never of a disk."""

import re
import tomllib
from pathlib import Path

import pytest
from mistakes import CAMPAIGN, KEEP, prepare

RAW = Path(__file__).parents[2] / "raw"

FACTORS = (2, 3, 4, 5, 7, 10, 14, 20, 28, 40, 56, 80, 113, 160, 200)

OF_DATA = (0, 3, 4, 5)

pytestmark = pytest.mark.slow


def decimate(folder, factor):
    """Lines that begin with a number are rows; those above them, and the marks, stay."""
    campaign = tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))
    for name in {test["file"] for test in campaign["tests"].values()}:
        lines = (folder / name).read_text(encoding="utf-8").splitlines(keepends=True)
        first = next(i for i, line in enumerate(lines) if re.match(r"\s*[-+.\d]", line))
        kept = lines[:first] + lines[first::factor]
        (folder / name).write_text("".join(kept), encoding="utf-8")


def statuses(command, folder, factor):
    decimate(folder, factor)
    done = [
        command("check", "campaign.toml", cwd=folder),
        command("run", "campaign.toml", "-q", cwd=folder),
    ]
    return [one.returncode for one in done], done[1].stderr


@pytest.mark.parametrize(
    ("of", "factor"),
    [("tether", 24), ("rope", 9), ("hose", 13)],
)
def test_coarse_logs_of_some_tests_end_with_a_status_of_data(command, tmp_path, of, factor):
    prepare(of, RAW, tmp_path / "made", KEEP[of])
    found, said = statuses(command, tmp_path / "made", factor)
    assert set(found) <= set(OF_DATA)
    assert "disk" not in said


@pytest.mark.nightly
@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("campaign", [*CAMPAIGN.values(), "buoy-technology-1997"])
def test_coarse_logs_of_a_whole_campaign_end_with_a_status_of_data(
    command, tmp_path, campaign, factor
):
    made = tmp_path / "made"
    made.mkdir()
    for path in (RAW / campaign).iterdir():
        if path.is_file():
            (made / path.name).write_bytes(path.read_bytes())
    found, said = statuses(command, made, factor)
    assert set(found) <= set(OF_DATA)
    assert "disk" not in said
