"""What docs/predictions.md shows can be read, and no key is left out."""

import re
import tomllib
from pathlib import Path

import pytest

from reduction.campaign import hose_spec as hosemodel
from reduction.campaign.armour_spec import _ArmourKeys, _ArmourLayerKeys, load_armour_case
from reduction.campaign.hose_spec import load_hose
from reduction.campaign.wave_spec import _WaveLoadKeys, load_wave_case

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


def written(tmp_path, table):
    path = tmp_path / "spec.toml"
    path.write_text(next(body for body in BLOCKS if f"[{table}]" in body), encoding="utf-8")
    return path


def test_the_wave_load_that_is_shown_can_be_predicted(tmp_path):
    case = load_wave_case(written(tmp_path, "wave_load"))
    assert (case["outer_diameter"], case["content_density"]) == pytest.approx((0.114, 830))
    assert case["wave_length"] is None and case["wave_theory"] == "auto"


def test_the_armour_that_is_shown_can_be_predicted(tmp_path):
    case = load_armour_case(written(tmp_path, "armour"))
    assert case.layer_names == ("inner", "outer")
    assert case.layers.design.core_radius == pytest.approx([0.025, 0.030])
    assert case.tolerance == pytest.approx(0.01)


@pytest.mark.parametrize("section", ["wave_load", "armour"])
def test_defaults_are_told_where_they_are_explained(section):
    """Each value that stands for a missing one is on the page; 0 and none are told in words."""
    models = {"wave_load": (_WaveLoadKeys,), "armour": (_ArmourKeys, _ArmourLayerKeys)}[section]
    rows = [line for line in PAGE.splitlines() if line.startswith("| `")]
    for one in models:
        for name, field in one.model_fields.items():
            if field.default in (None, "") or field.is_required():
                continue
            (row,) = [line for line in rows if f"`{name}`" in line.split("|")[1]][-1:]
            assert str(field.default).split(" ")[0] in row, name


def test_the_comparison_that_is_shown_is_valid():
    (table,) = (tomllib.loads(body) for body in BLOCKS if "[comparisons." in body)
    for section in table["comparisons"].values():
        hosemodel.ComparisonSection.model_validate(section)


def test_every_key_is_explained():
    models = (
        hosemodel.HoseSection, hosemodel.LayerSection, hosemodel.CordSection,
        hosemodel.ComparisonSection, hosemodel._TargetSection, _WaveLoadKeys, _ArmourKeys,
        _ArmourLayerKeys,
    )  # fmt: skip
    named = {name for one in models for name in one.model_fields} - {"cord"}
    assert not {name for name in named if f"`{name}`" not in PAGE}
