"""A slow pull under one load cell, runs under another: logs made wrong and reduced again.

The contributions of an archive against what the same reduction gives of the same logs with an
error of that size in the log of the pull alone, or of the run alone.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.nightly

RAW = Path(__file__).parents[2] / "raw" / "nylon-synthetic"
LBF = 4.4482216152605
RUN = "R11"  # where K_0 changes fastest with tension
NAMES = ("quasi_static_spring_constant", "dissipation_spring_constant", "relaxation_time")
SIZE = {"tension_gain": 0.01, "tension_offset": 3 * LBF}


def reduced(folder, wrong, gain=0.0, offset=0.0):
    """The line of the run, and its contributions by (source, of, number)."""
    raw = folder / "raw"
    shutil.copytree(RAW, raw)
    text = (raw / "campaign.toml").read_text()
    before, rest = text.split("[uncertainty]")
    rest = rest.split("[defaults]", 1)[1].replace("[tests.Q01]", '[tests.Q01]\nload_cell = "A"', 1)
    stated = f'[uncertainty.tension]\ngain = "1 %"\noffset = "{SIZE["tension_offset"]} N"\n'
    warm = '[uncertainty.temperature]\nvalue = "2 K"\nstiffness_per_kelvin = "0.5 %"\n'
    (raw / "campaign.toml").write_text(f'{before}{stated}{warm}\n[defaults]\nload_cell = "B"{rest}')
    assert 'load_cell = "A"' in (raw / "campaign.toml").read_text()
    if wrong is not None:
        path = raw / f"{wrong}.csv"
        with path.open() as log:
            first = log.readline()
        table = pd.read_csv(path, comment="#")
        table["load_lbf"] = table["load_lbf"] * (1 + gain) + offset / LBF
        path.write_text(first + table.to_csv(index=False, float_format="%.8f"))
    campaign = load_campaign(raw / "campaign.toml")
    plan = campaign.experiments["nylon"]
    few = replace(
        campaign,
        tests={name: campaign.tests[name] for name in (RUN, "Q01")},
        experiments={"nylon": replace(plan, runs={RUN: plan.runs[RUN]})},
    )
    found = run_campaign(few, processed=folder / "p", reports=folder / "r", clock=lambda: 0.0)
    with open_archive(found.processed / f"{RUN}.nc") as archive:
        values = {name: float(archive[f"test_{name}"].to_numpy()[0]) for name in NAMES}
        keys = zip(
            archive["uncertainty_source"].to_numpy().astype(str),
            archive["uncertainty_source_of"].to_numpy().astype(str),
            strict=True,
        )
        table = [
            archive[f"test_{name}_uncertainty_contribution"].to_numpy()[:, 0] for name in NAMES
        ]
        rows = {
            key: dict(zip(NAMES, row, strict=True)) for key, *row in zip(keys, *table, strict=True)
        }
    return values, rows


@pytest.fixture(scope="module")
def stated(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("stated"), None)


@pytest.mark.parametrize(
    ("source", "wrong"),
    [
        ("tension_gain", "Q01"),
        *(
            pytest.param(source, wrong, marks=pytest.mark.nightly)
            for source, wrong in (
                ("tension_gain", RUN), ("tension_offset", RUN), ("tension_offset", "Q01")
            )
        ),
    ],
)  # fmt: skip
def test_each_cell_moves_the_line_by_its_own_log(stated, tmp_path, wrong, source):
    keyword = source.removeprefix("tension_")
    above, below = (
        reduced(tmp_path / side, wrong, **{keyword: way * SIZE[source]})[0]
        for side, way in (("above", 1), ("below", -1))
    )
    values, rows = stated
    cell = "A" if wrong == "Q01" else "B"
    (found,) = (
        row for (name, of), row in rows.items() if name == source and cell in of.split(", ")[0]
    )
    for name in NAMES:
        wanted = (above[name] - below[name]) / 2
        # of first order: a curve bends by a share of the step squared
        assert found[name] == pytest.approx(wanted, abs=0.03 * abs(wanted) + 2e-5 * values[name]), (
            name
        )


def test_run_and_pull_were_warm_or_cold_on_their_own_days(stated):
    values, rows = stated
    of = {of: row for (source, of), row in rows.items() if source == "temperature"}
    assert len(of) == 2
    # K_1 and tau follow from K_ap, H and K_0: both a per cent up scales K_1 and leaves tau
    both = {name: sum(row[name] for row in of.values()) for name in NAMES}
    assert both["relaxation_time"] == pytest.approx(0.0, abs=2e-3 * values["relaxation_time"])
    assert both["dissipation_spring_constant"] == pytest.approx(
        0.01 * values["dissipation_spring_constant"], rel=0.1
    )
    assert (
        min(abs(row["relaxation_time"]) for row in of.values()) > 1e-3 * values["relaxation_time"]
    )
