"""A displacement that never goes slack: strain counts from where its length was stated."""

import json

import numpy as np
import pytest

from reduction.archive.open import open_archive

pytestmark = pytest.mark.slow

CAMPAIGN = """
[campaign]
id = "travel"
title = "Travel (synthetic)"
synthetic = true
[specimens.cord]
kind = "elastomer"
diameter = ["10 mm"]
gauge_length = "1.2 m"
[layouts.logger]
format = "delimited"
[layouts.logger.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "m", datum = "displacement"KEYS }
tension.1 = { column = "F", unit = "N" }
[tests.A]
file = "A.csv"
layout = "logger"
specimens = ["cord"]
"""


@pytest.fixture
def travel(tmp_path):
    """Ten cycles between 0.1 and 0.3 m from slack, logged without the way there."""
    time = np.arange(0, 100.05, 0.1)
    displacement = 0.1 + 0.2 * (1 - np.abs(time / 5 % 2 - 1))
    tension = 2000 * displacement
    generator = np.random.default_rng(9)
    rows = zip(
        time, displacement + generator.normal(0, 1e-4, time.size),
        tension + generator.normal(0, 0.5, time.size), strict=True,
    )  # fmt: skip
    text = "t,x,F\n" + "".join(f"{t:.1f},{x:.5f},{f:.2f}\n" for t, x, f in rows)
    (tmp_path / "A.csv").write_text(text)
    return tmp_path


def run(folder, command, keys):
    (folder / "campaign.toml").write_text(CAMPAIGN.replace("KEYS", keys))
    done = command("run", folder / "campaign.toml", "--json", cwd=folder)
    return json.loads(done.stdout)["tests"][0]


@pytest.mark.parametrize(
    "keys",
    [
        "",
        ', reference_length = "1.5 m"',
        ', reference_length = "1.5 m", reference_tension = "0 N"',
    ],
)
def test_strain_counts_from_displacement_zero(travel, command, keys):
    test = run(travel, command, keys)
    assert test["status"] in ("reduced", "check"), test["message"]
    with open_archive(travel / "processed" / "travel" / "A.nc") as archive:
        strain = archive["strain"].values
        # 0.1 and 0.3 m of travel on 1.2 m
        assert np.nanmin(strain) == pytest.approx(0.1 / 1.2, abs=5e-4)
        assert np.nanmax(strain) == pytest.approx(0.3 / 1.2, abs=5e-4)
        # 2000 N/m on 1.2 m are 2400 N of spring constant
        constant = archive["apparent_spring_constant"].values
        assert constant == pytest.approx(np.full(constant.shape, 2400.0), rel=0.01)


def test_strain_counts_from_the_reference_tension_wherever_the_log_has_it(travel, command):
    test = run(travel, command, ', reference_length = "1.5 m", reference_tension = "200 N"')
    assert test["status"] in ("reduced", "check"), test["message"]
    # 2000 N/m have 200 N at 0.1 m of travel, and not at zero as the layout has it
    assert (
        "reference tension of 200 N at 1.5 m, but the log first reaches it at 1.6 m"
        in test["message"]
    )
    with open_archive(travel / "processed" / "travel" / "A.nc") as archive:
        strain = archive["strain"].values
    assert np.nanmin(strain) == pytest.approx(0.0, abs=1e-3)
    assert np.nanmax(strain) == pytest.approx(0.2 / 1.2, abs=1e-3)
