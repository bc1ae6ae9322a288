"""Two specimens of one cell, and a diameter of three readings: wrong logs and readings, reduced."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.archive.open import open_archive
from reduction.archive.uncertainty_budget import budget_from_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign
from reduction.lines.archive_source import _line_source_of_test
from reduction.lines.line_lookup import look_up
from reduction.lines.line_search import compare_values

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
GAIN = 0.1
INCH = 0.0254
READINGS = (1.02, 1.04, 1.06)
STATED = f'\n[uncertainty.tension]\ngain = "{100 * GAIN:g} %"\none_load_cell = true\n'
ONE = 'diameter = ["1.04 in"]'


def reduced(folder, *, gain=0.0, readings=None):
    """T-1 of the synthetic campaign with one load cell, whose logs all read too much by a gain."""
    raw = folder / "raw"
    shutil.copytree(RAW, raw)
    if gain:
        for path in raw.glob("T-*.csv"):
            lines = path.read_text().splitlines(keepends=True)
            table = pd.read_csv(path, comment="#")
            loads = [name for name in table.columns if name.startswith("load_")]
            table[loads] *= 1 + gain
            head = "".join(line for line in lines if line.startswith("#"))
            path.write_text(head + table.to_csv(index=False, float_format="%.6f"))
    path = raw / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    before, _, after = text.partition("[uncertainty]")
    text = before + after[after.index("[defaults]") :] + STATED
    if readings is not None:
        assert ONE in text
        listed = ", ".join(f'"{one:.6f} in"' for one in readings)
        text = text.replace(ONE, f"diameter = [{listed}]")
    path.write_text(text, encoding="utf-8")
    found = run_campaign(
        load_campaign(path), processed=folder / "p", reports=folder / "r", clock=lambda: 0.0,
        tests=["T-1"],
    )  # fmt: skip
    with open_archive(found.processed / "T-1.nc") as archive:
        return archive.load()


def difference(archive, strain=1.0):
    new, used = (
        look_up(
            _line_source_of_test(archive, name),
            "tangent_modulus",
            strain=strain,
            branch="ascending",
        )
        for name in ("new", "used")
    )
    return compare_values(new, used)


@pytest.fixture(scope="module")
def stated(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("stated"), readings=READINGS)


@pytest.fixture(scope="module")
def at(stated):
    return {"specimen": "new", "branch": "ascending", "segment": "1"}


@pytest.mark.nightly
def test_a_gain_of_the_one_cell_moves_the_difference_by_what_its_interval_holds(stated, tmp_path):
    found = difference(stated)
    small = 0.01
    above, below = (
        difference(reduced(tmp_path / side, gain=way * small, readings=READINGS)).difference
        for side, way in (("more", 1), ("less", -1))
    )
    moved = (above - below) / 2 / small * GAIN
    place = [one.source for one in found.first.component].index("tension_gain")
    rows = (
        found.second.contribution[
            [one.source for one in found.second.component].index("tension_gain")
        ]
        - found.first.contribution[place]
    )
    assert moved == pytest.approx(rows, rel=0.02)
    # either modulus alone moves by more than ten times that
    assert np.abs(found.first.contribution[place]) > 10 * np.abs(moved)
    assert found.is_different


@pytest.mark.nightly
def test_a_diameter_of_three_readings_has_two_degrees_of_freedom_in_all_that_it_enters(
    stated, at, tmp_path
):
    readings = np.array(READINGS)
    u = float(np.std(readings, ddof=1) / np.sqrt(readings.size))
    section = budget_from_archive(stated, "diameter", {"specimen": "new"})
    assert section.standard_uncertainty == pytest.approx(u * INCH)
    # t of two degrees of freedom, 97.5 %: 4.303 in the tables
    assert section.coverage_factor == pytest.approx(4.303, abs=1e-3)
    area = budget_from_archive(stated, "area", {"specimen": "new"})
    assert area.coverage_factor == pytest.approx(4.303, abs=1e-3)
    modulus = budget_from_archive(stated, "segment_modulus", at)
    wider = reduced(tmp_path / "wider", readings=readings + u)
    moved = budget_from_archive(wider, "segment_modulus", at).value - modulus.value
    parts = {row.source: row.contribution for row in modulus.rows}
    # a part in a hundred of the diameter: the second order is as much of the first
    assert parts["diameter"] == pytest.approx(moved, rel=0.02)
    total = sum(one**2 for one in parts.values())
    few = parts["diameter"] ** 4 / 2 + parts["random"] ** 4 / modulus.degrees_of_freedom
    assert modulus.effective_degrees_of_freedom == pytest.approx(total**2 / few)


def test_a_look_up_and_a_budget_read_a_strain_alike(stated):
    bins = stated["strain_bin"].to_numpy()
    strain = float(bins[40] + 0.3 * (bins[41] - bins[40]))
    value = look_up(
        _line_source_of_test(stated, "new"), "tangent_modulus", strain=strain, branch="ascending"
    )
    budget = budget_from_archive(
        stated, "tangent_modulus",
        {"specimen": "new", "branch": "ascending", "strain": repr(strain)},
    )  # fmt: skip
    assert budget.value == pytest.approx(float(value.value))
    half = float(value.surface_high - value.value)
    assert budget.expanded_uncertainty == pytest.approx(half, rel=1e-6)


def test_a_first_rise_is_known_by_its_samples_and_not_by_the_cycles_after_it(stated):
    found = budget_from_archive(
        stated, "tangent_modulus_first_loading",
        {"specimen": "used", "branch": "ascending", "strain": "0.5"},
    )  # fmt: skip
    assert found.coverage_factor == pytest.approx(1.96, abs=0.01)
