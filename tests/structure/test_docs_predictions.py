"""What docs/predictions.md shows can be read, and no key is left out."""

import re
import tomllib
from pathlib import Path

import pytest

from reduction.campaign import hosemodel
from reduction.campaign.hoses import load_hose

PAGE = (Path(__file__).parents[2] / "docs" / "predictions.md").read_text(encoding="utf-8")
BLOCKS = [body for _, body in re.findall(r"^```(toml)\n(.*?)^```$", PAGE, re.M | re.S)]


def test_the_hose_that_is_shown_can_be_predicted(tmp_path):
    path = tmp_path / "hose.toml"
    path.write_text(next(body for body in BLOCKS if "[cord]" in body), encoding="utf-8")
    plan, file = load_hose(path)
    assert plan.design.dead_length_share == pytest.approx(4 / 96)
    assert plan.standard_uncertainty["rubber_modulus"] == pytest.approx(10 * 6894.757, rel=1e-6)
    assert [layer.name for layer in plan.layers] == ["Kevlar"]
    assert file.comparison.calibrate == ("wrap_angle", "rubber_modulus")


def test_the_comparison_that_is_shown_is_valid():
    (table,) = (tomllib.loads(body) for body in BLOCKS if "[comparisons." in body)
    for section in table["comparisons"].values():
        hosemodel.ComparisonSection.model_validate(section)


def test_every_key_is_explained():
    models = (
        hosemodel.HoseSection, hosemodel.LayerSection, hosemodel.CordSection,
        hosemodel.ComparisonSection, hosemodel.TargetSection,
    )  # fmt: skip
    named = {name for one in models for name in one.model_fields} - {"cord"}
    assert not {name for name in named if f"`{name}`" not in PAGE}
