"""The complete example of docs/campaign.md with short logs, and a run of it in this process."""

import re
from pathlib import Path

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
