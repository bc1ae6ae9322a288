"""The stated gauge length against the displacement of a pull that begins without a rest."""

import numpy as np
import pytest
from typer.testing import CliRunner

from reduction.cli.main import app

CAMPAIGN = """
[campaign]
id = "pull"
title = "A pull (synthetic)"
source = "synthetic"
[specimens.coupon]
kind = "other"
gauge_length = "{gauge} mm"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = {{ column = "t", unit = "s" }}
tension.1 = {{ column = "f", unit = "N" }}
[layouts.log.channels.crosshead_position]
column = "x"
unit = "mm"
datum = "displacement"
reference_length = "115 mm"
[tests.P-1]
kind = "tensile"
file = "P-1.csv"
layout = "log"
specimens = ["coupon"]
"""


# as between the grips; of a strand that hangs bent at displacement zero; a decimal point misplaced
@pytest.mark.parametrize(
    ("gauge", "bent", "is_named"),
    [(115, 0, False), (25, 0, False), (170, 55, False), (1150, 0, True), (5, 0, True)],
)
def test_a_gauge_length_that_does_not_fit_between_the_pins_is_named(
    gauge, bent, is_named, tmp_path, monkeypatch
):
    travel = np.linspace(0, bent + 20.0, 500)
    load = 100 * np.clip(travel - bent, 0, None)
    rows = zip(np.arange(500) / 10, travel, load, strict=True)
    text = "t,x,f\n" + "".join(f"{t:.1f},{x:.4f},{f:.2f}\n" for t, x, f in rows)
    (tmp_path / "P-1.csv").write_text(text, encoding="utf-8")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.format(gauge=gauge), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["check", "campaign.toml"], env={"COLUMNS": "4000"})
    assert done.exit_code == 0
    assert ("the gauge length is" in done.output) == is_named
