"""The complete example of docs/campaign.md with short logs, and a run of it in this process."""

import re
from pathlib import Path

import pytest
from nopage import leave_out_page

from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

ROOT = Path(__file__).parents[1]
DOCS = (ROOT / "docs" / "campaign.md").read_text(encoding="utf-8")
SHORT = {"T-1.csv": 3950, "T-2.csv": 4450}
"""Rows of each log that hold the first few of its cycles."""


def copied(folder):
    """The complete example of docs/campaign.md, its logs cut short: a campaign of two tests."""
    for name in ("campaign.toml", "tests.csv", "marks.csv"):
        (body,) = re.findall(rf"^`{name}`:\n\n```\w+\n(.*?)^```$", DOCS, re.M | re.S)
        (folder / name).write_text(body, encoding="utf-8")
    for name, n_rows in SHORT.items():
        lines = (ROOT / "raw" / "tmt-synthetic" / name).read_text("utf-8").splitlines(True)
        (folder / name).write_text("".join(lines[:n_rows]), encoding="utf-8")
    return folder / "campaign.toml"


def run(path, folder, **options):
    return run_campaign(
        load_campaign(path), processed=folder / "processed", reports=folder / "reports",
        clock=lambda: 0.0, command="reduction run campaign.toml", **options,
    )  # fmt: skip


def made_without_page(folder, name):
    """A folder with the raw data and the products of the example."""
    (folder / "raw" / name).mkdir(parents=True)
    with pytest.MonkeyPatch.context() as patch:
        leave_out_page(patch)
        assert run(copied(folder / "raw" / name), folder).exit_status == 0
    return folder
