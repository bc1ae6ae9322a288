"""The first rise and the slack end of a tether: logs shifted, in time or load, reduced again."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
LAG = 0.020  # as the campaign states it [s]
STATED_ZERO, ZERO = 0.5, 0.02  # as the campaign says; so small that no sample changes sides [lbf]
NAMES = ("branch_tension_first_loading", "stress_at_strain")


def reduced(folder, late=0.0, zero=0.0):
    raw = folder / "raw"
    shutil.copytree(RAW, raw)
    path = raw / "T-1.csv"
    lines = path.read_text().splitlines(keepends=True)
    head = "".join(line for line in lines if line.startswith("#"))
    table = pd.read_csv(path, comment="#")
    time = table["time_s"].to_numpy()
    for name in ("load_new_lb", "load_used_lb"):
        load = table[name].to_numpy()
        table[name] = np.interp(time - late, time, load) + zero
    path.write_text(head + table.to_csv(index=False, float_format="%.6f"))
    found = run_campaign(
        load_campaign(raw / "campaign.toml"), processed=folder / "p", reports=folder / "r",
        clock=lambda: 0.0, tests=["T-1"],
    )  # fmt: skip
    with open_archive(found.processed / "T-1.nc") as archive:
        return archive.load()


@pytest.fixture(scope="module")
def stated(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("stated"))


def contribution(archive, name, source):
    of = archive["uncertainty_source"].to_numpy().astype(str) == source
    return np.nansum(archive[f"{name}_uncertainty_contribution"].to_numpy()[of], axis=0)


@pytest.fixture(scope="module")
def shifted(tmp_path_factory):
    """Loads that are logged later, and earlier, by the lag that is stated."""
    return [reduced(tmp_path_factory.mktemp("shifted"), late=way * LAG) for way in (1, -1)]


@pytest.mark.nightly
@pytest.mark.parametrize("name", NAMES)
def test_a_later_load_is_lower_on_the_rise_by_its_rate(stated, shifted, name):
    above, below = (one[name].to_numpy() for one in shifted)
    wanted, found = (above - below) / 2, contribution(stated, name, "lag")
    known = np.isfinite(wanted) & np.isfinite(found) & (found != 0)
    assert known.sum() > 3
    assert (wanted[known] < 0).mean() > 0.95
    # at both ends of the rise a window is one-sided, and noise of the log is in the difference
    assert found[known].sum() == pytest.approx(wanted[known].sum(), rel=0.1)
    far = np.abs(found[known] - wanted[known]) > 0.25 * np.abs(wanted[known]).max()
    assert far.mean() < 0.1


@pytest.mark.nightly
def test_a_zero_of_the_load_cell_moves_where_a_specimen_goes_slack(stated, tmp_path):
    name = "slack_strain_at_unloading"
    above, below = (
        reduced(tmp_path / side, zero=way * ZERO)[name].to_numpy()
        for side, way in (("more", 1), ("less", -1))
    )
    wanted = (above - below) / 2
    # both cells are moved here, and each has its own specimen
    found = contribution(stated, name, "tension_offset") * ZERO / STATED_ZERO
    # the slack tension is two hundredths of the greatest tension, which moves too
    assert found == pytest.approx(wanted, rel=0.021)
    assert (wanted < 0).all()


@pytest.mark.nightly
def test_a_later_load_goes_slack_when_the_crosshead_is_further_back(stated, tmp_path):
    name = "slack_strain_at_unloading"
    late = 0.1  # one sample of this log
    above, below = (
        reduced(tmp_path / side, late=way * late)[name].to_numpy()
        for side, way in (("later", 1), ("earlier", -1))
    )
    found = contribution(stated, name, "lag")
    assert found == pytest.approx((above - below) / 2 * LAG / late, rel=0.15)
    assert (found < -1e-3).all()
