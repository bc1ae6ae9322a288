"""A load cell that all tests have, in their composite: stated, and wrong in every log."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.nightly

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
TESTS = ("T-1", "T-2")
STATED = """
[uncertainty.tension]
gain = "10 %"
one_load_cell = true
"""


def reduced(folder, stated, *, factor=1.0):
    """Two tests of the campaign with nothing stated but this, every log times a factor."""
    raw = folder / "raw"
    raw.mkdir(parents=True)
    for path in RAW.glob("*.csv"):
        if path.name == "marks.csv" or factor == 1.0:
            shutil.copy(path, raw / path.name)
            continue
        log = pd.read_csv(path, comment="#")
        loads = [name for name in log if name.startswith("load_")]
        log[loads] *= factor
        log.to_csv(raw / path.name, index=False, float_format="%.6f")
    text = (RAW / "campaign.toml").read_text(encoding="utf-8")
    head, rest = text.split("[uncertainty]")
    text = head + stated + "\n[defaults]" + rest.split("[defaults]")[1]
    (raw / "campaign.toml").write_text(text, encoding="utf-8")
    run = run_campaign(
        load_campaign(raw / "campaign.toml"), processed=folder / "p", reports=folder / "r",
        clock=lambda: 0.0, tests=list(TESTS),
    )  # fmt: skip
    return run.processed


@pytest.fixture(scope="module")
def nothing(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("nothing"), "")


@pytest.fixture(scope="module")
def gain(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("gain"), STATED)


def composite(command, processed, *options, tests=TESTS):
    paths = [processed / f"{name}.nc" for name in tests]
    done = command("composite", *paths, "--specimen", "new", *options, "--json")
    assert done.returncode in (0, 4), done.stderr
    found = json.loads(done.stdout)
    assert (done.returncode == 4) == bool(found["doubt"])
    return {
        name: np.array(value) if name.startswith(("strain", "tension_", "tension")) else value
        for name, value in found.items()
        if name != "tension_uncertainty_contributions"
    } | {"rows": found["tension_uncertainty_contributions"]}


def test_the_mean_of_both_branches_has_the_whole_gain(command, gain):
    found = composite(command, gain, "--precedence", "cyclic", tests=["T-1"])
    share = found["tension_standard_uncertainty"][3:] / found["tension"][3:]
    assert share == pytest.approx(np.full(share.size, 0.1), rel=2e-3)


@pytest.mark.parametrize("branch", ["mean", "ascending"])
def test_a_gain_makes_the_curve_less_sure_and_its_pieces_no_more_alike(
    command, nothing, gain, branch
):
    """Taken as random, 10 % explained all that is between these tests."""
    before, after = (composite(command, one, "--branch", branch) for one in (nothing, gain))
    assert before["between_pieces"] > 0.04
    assert after["between_pieces"] == pytest.approx(before["between_pieces"], rel=1e-3)
    assert after["tension"] == pytest.approx(before["tension"], rel=1e-6)
    for strain in (0.8, 1.2):
        u = [
            np.interp(strain, one["strain"], one["tension_standard_uncertainty"])
            / np.interp(strain, one["strain"], one["tension"])
            for one in (before, after)
        ]
        assert u[1] == pytest.approx(np.hypot(u[0], 0.1), rel=1e-3)
    parts = [after[f"tension_{part}_standard_uncertainty"] for part in ("random", "shared")]
    assert np.hypot(*parts) == pytest.approx(after["tension_standard_uncertainty"])


@pytest.mark.nightly
def test_the_curve_moves_by_what_it_says_where_every_log_reads_1_percent_high(
    command, gain, tmp_path
):
    high = composite(command, reduced(tmp_path, STATED, factor=1.01))
    found = composite(command, gain)
    (row,) = [one for one in found["rows"] if one["source"] == "tension_gain"]
    moved = np.interp(found["strain"], high["strain"], high["tension"]) - found["tension"]
    # a tenth of the stated gain
    inner = found["tension"] > 0.1 * found["tension"].max()
    assert moved[inner] == pytest.approx(0.1 * np.array(row["contribution"])[inner], rel=0.02)


def test_weights_that_are_heavier_than_they_say_are_in_their_curve_whole(command, tmp_path):
    """One load is on both ways: their mean has the whole of it, and the diameter none."""
    raw = tmp_path / "raw"
    shutil.copytree(RAW.parent / "buoy-technology-1997", raw)
    path = raw / "campaign.toml"
    stated = '\n[uncertainty]\ndiameter = "0.02 inch"\n[uncertainty.tension]\ngain = "10 %"\n'
    path.write_text(path.read_text(encoding="utf-8") + stated, encoding="utf-8")
    run = run_campaign(
        load_campaign(path), processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0
    )
    found = json.loads(command("composite", run.processed, "--branch", "mean", "--json").stdout)
    rows = {
        one["source"]: np.array(one["contribution"])
        for one in found["tension_uncertainty_contributions"]
    }
    assert set(rows) == {"tension_gain", "gauge_length"}
    assert rows["tension_gain"] == pytest.approx(0.1 * np.array(found["tension"]))
