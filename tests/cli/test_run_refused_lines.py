"""What an experiment says of runs without K_1 and tau, of slack lines and of itself."""

import shutil
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "nylon-synthetic"
# mean tensions of 768 and 1920 lbf; that of R05 is its amplitude too
KEPT = ("R01", "R05", "R11")


def remarks(folder, pull, cut):
    """Remark of each run, and the message, with the slow pull read up to a share of its rows."""
    shutil.copytree(RAW, folder / "raw")
    lines = (RAW / "Q01.csv").read_text().splitlines(keepends=True)
    if cut is not None:
        (folder / "raw" / "Q01.csv").write_text("".join(cut(lines)))
    whole = load_campaign(folder / "raw" / "campaign.toml")
    plan = whole.experiments["nylon"]
    runs = {name: plan.runs[name] for name in KEPT}
    few = replace(plan, runs=runs, quasi_static={"line-1": "Q01"} if pull else {})
    tests = {name: whole.tests[name] for name in (*KEPT, "Q01")}
    campaign = replace(whole, tests=tests, experiments={"nylon": few})
    done = run_campaign(campaign, processed=folder / "p", reports=folder / "r", clock=lambda: 0.0)
    with open_archive(done.processed / "surfaces.nc") as archive:
        said = archive["run_remark"].to_numpy()[0].tolist() if "run_remark" in archive else []
    return dict(zip(KEPT, said, strict=True)), done.parts["experiments"][0].message


def below(lines):
    """Rows of a pull up to 1500 lbf: above a mean of 768 lbf, below one of 1920 lbf."""
    head = next(place for place, line in enumerate(lines) if line.startswith("time_s"))
    table = pd.DataFrame([line.split(",") for line in lines[head + 1 :]]).astype(float)
    load = lines[head].strip().split(",").index("load_lbf")
    stop = int((table[load] > 1500).to_numpy().argmax())
    return lines[: head + 1 + stop]


@pytest.mark.parametrize(
    ("pull", "cut", "reasons"),
    [
        pytest.param(
            False,
            None,
            dict.fromkeys(KEPT, "no slow pull is named for the specimen"),
            marks=pytest.mark.nightly,
        ),
        pytest.param(
            True,
            lambda lines: lines[:8],
            dict.fromkeys(KEPT, "the slow pull Q01 gave no"),
            marks=pytest.mark.nightly,
        ),
        (True, below, {"R11": "the mean tension lies outside the slow pull Q01"}),
    ],
    ids=["no pull", "a pull that failed", "a mean tension beyond the pull"],
)
def test_each_run_has_its_own_reason(tmp_path, pull, cut, reasons):
    said, message = remarks(tmp_path, pull, cut)
    for name, text in said.items():
        assert reasons.get(name, "") in text and ("not given" in text) == (name in reasons), said
    # its valleys are at zero in the law that made it
    assert "goes slack" in said["R05"] and "goes slack" not in said["R01"]
    assert "response surfaces not given" in message and "R05: the line goes slack" in message
