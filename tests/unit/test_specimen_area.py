"""Areas of specimens that have no diameter, from campaign.toml to a modulus and its uncertainty."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import reduction
from reduction.campaign.load import load_campaign
from reduction.record.errors import SettingsError

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"

CAMPAIGN = """
[campaign]
id = "one"
title = "one"
[specimens.new]
kind = "rubber tether"
SIZE
[layouts.logger]
format = "delimited"
comment = "#"
[layouts.logger.channels]
time = { column = "time_s", unit = "s" }
crosshead_position = { column = "crosshead_ft", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "load_new_lb", unit = "lbf" }
[defaults]
layout = "logger"
specimens = ["new"]
strain = { method = "gauge-length" }
[tests.T-1]
file = "T-1.csv"
"""


@pytest.fixture
def stated(tmp_path):
    shutil.copy(RAW / "T-1.csv", tmp_path)

    def write(size, more=""):
        text = CAMPAIGN.replace("SIZE", f'gauge_length = "12.256 ft"\n{size}') + more
        (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
        return tmp_path / "campaign.toml"

    return write


@pytest.mark.parametrize(
    ("size", "area"),
    [
        ('area = "5.5 cm2"', 5.5e-4),
        ('area = ["2.2 mm2", "2.4 mm2"]', 2.3e-6),
        ('width = "11.4 mm"\nthickness = "0.2 mm"', 2.28e-6),
        ('width = ["6 mm", "6.2 mm"]\nthickness = ["3 mm", "3.1 mm"]', (18 + 19.22) / 2 * 1e-6),
        ('linear_density = "0.11 kg/m"\ndensity = "1100 kg/m3"', 1e-4),
        ('diameter = "2 mm"\nlinear_density = "0.11 kg/m"', np.pi * 1e-6),
    ],
)
def test_the_area_is_that_of_what_is_stated(stated, size, area):
    specimen = load_campaign(stated(size)).specimens["new"]
    assert specimen.has_area
    assert specimen.area == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize(
    ("size", "match"),
    [
        ('area = "1 mm2"\ndiameter = "1 mm"', "states its cross-section in two ways"),
        ('width = "1 mm"', "width is stated alone"),
        ('density = "900 kg/m3"', "density is stated alone"),
        (
            'width = ["1 mm", "2 mm"]\nthickness = ["1 mm", "2 mm", "3 mm"]',
            "not of the same places",
        ),
        ('area = "1 mm"', "unit 'mm' is not a unit of area"),
        (
            'area = "1 mm2"\nstretched_diameter = { "10 %" = ["1 mm"] }',
            "stretched_diameter is stated alone",
        ),
    ],
)
def test_a_size_that_is_stated_twice_or_by_half_is_refused(stated, size, match):
    with pytest.raises(SettingsError, match=match):
        load_campaign(stated(size))


def test_an_area_gives_the_moduli_of_the_circle_of_that_area(stated, tmp_path):
    inch = 0.0254
    area = np.pi * (1.04 * inch) ** 2 / 4
    made = {}
    for name, size, error in (
        ("circle", 'diameter = "1.04 in"', 'diameter = "0.0104 in"'),
        ("area", f'area = "{area:.12e} m2"', 'area = "2 %"'),
    ):
        path = stated(size, f"[uncertainty]\n{error}\n")
        reduction.run(path, processed=tmp_path / name, reports=tmp_path / "r").close()
        with xr.open_datatree(tmp_path / name / "one" / "T-1.nc") as tree:
            made[name] = tree.load()
    for name in ("tangent_modulus", "tangent_modulus_standard_uncertainty", "area",
                 "area_standard_uncertainty"):  # fmt: skip
        np.testing.assert_allclose(made["area"][name], made["circle"][name], rtol=1e-9)
    assert np.isnan(made["area"]["diameter"]).all()
    assert re.search("area", made["area"].attrs["settings"])
