"""A pull whose machine set the displacement to zero under a preload (synthetic)."""

import numpy as np
import pytest

from reduction.batch.survey import survey_log
from reduction.campaign.load import load_campaign

CAMPAIGN = """
[campaign]
id = "preload"
title = "Preload (synthetic)"
source = "synthetic"
[specimens.bar]
kind = "other"
area = "20 mm2"
gauge_length = "25 mm"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = {{ column = 1, unit = "s" }}
crosshead_position = {{ column = 2, unit = "mm", datum = "displacement", reference_length = "25 mm"{at} }}
tension.1 = {{ column = 3, unit = "N" }}
{strain}
[tests.T-1]
file = "log.csv"
layout = "log"
kind = "tensile"
specimens = ["bar"]
"""


def loads_told(tmp_path, tension, at="", strain=""):
    """What is said of the tension at displacement zero of a pull with that log."""
    travel = 0.01 * np.arange(tension.size)
    rows = np.column_stack([10 * travel, travel, tension, 100 * travel / 25])
    np.savetxt(tmp_path / "log.csv", rows, "%.5f", ",", header="t,x,F,e", comments="")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.format(at=at, strain=strain))
    (survey,) = survey_log(load_campaign(tmp_path / "campaign.toml"), "T-1")
    return [str(one) for one in survey.located.record.notes if "displacement is first" in str(one)]


@pytest.mark.parametrize(
    ("at", "strain", "is_told"),
    [
        ("", "", True),
        (', reference_tension = "150 N"', "", False),
        ("", 'strain.1 = { column = 4, unit = "%" }', False),  # no strain rests on the length
    ],
)
def test_a_zero_under_preload_is_told_where_strain_rests_on_it(tmp_path, at, strain, is_told):
    told = loads_told(tmp_path, 150.0 + 30 * np.arange(60), at, strain)
    assert bool(told) == is_told
    assert all('state reference_tension = "150 N"' in one for one in told)


def test_one_noisy_reading_is_no_preload(tmp_path):
    """The first reading of a weak strip is 6 % of its greatest load, and within its noise."""
    noise = 1.5 * np.random.default_rng(1).standard_normal(400)
    assert loads_told(tmp_path, np.linspace(0, 50, 400) + noise - noise[0] + 3.0) == []
    (told,) = loads_told(tmp_path, np.linspace(0, 50, 400) - 15)  # a zero of the load cell
    assert "preload" not in told
