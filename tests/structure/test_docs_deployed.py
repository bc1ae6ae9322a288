"""What docs/deployed.md shows can be read, no key is left out, and its figures are the answers."""

import re
from pathlib import Path

import pytest

from reduction.campaign.assembly_spec import (
    _AssemblyKeys,
    _CurveKeys,
    _PartKeys,
    _SpliceKeys,
    _WorkingKeys,
    load_assembly_case,
)
from reduction.cli.curves import deployed_line

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "deployed.md").read_text(encoding="utf-8")
LBF = 4.4482216152605


def test_every_key_is_explained():
    models = (_AssemblyKeys, _CurveKeys, _PartKeys, _SpliceKeys, _WorkingKeys)
    named = {name for one in models for name in one.model_fields}
    assert not {name for name in named if f"`{name}`" not in PAGE} - {
        "curve",
        "splices",
        "parts",
        "working",
    }
    for table in (
        "[assembly.curve]",
        "[assembly.splices]",
        "[[assembly.parts]]",
        "[[assembly.working]]",
    ):
        assert f"`{table}`" in PAGE


def test_the_assembly_that_is_shown_is_the_one_beside_the_page(tmp_path):
    (block,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.M | re.S)
    shown = tmp_path / "new-hampshire.toml"
    shown.write_text(block, encoding="utf-8")
    beside = load_assembly_case(DOCS / "assemblies" / "new-hampshire.toml")
    assert repr(load_assembly_case(shown)) == repr(beside)  # a NaN is not equal to itself


@pytest.mark.parametrize(("name", "place"), [("new-hampshire", 0), ("globec", 1)])
def test_the_tensions_on_the_page_are_those_of_the_files(name, place):
    told = re.findall(r"(\d+) \+-\s(\d+) lbf", PAGE)[place]
    state = deployed_line(DOCS / "assemblies" / f"{name}.toml").deployed.working[0]
    assert float(state.point.mean_tension) / LBF == pytest.approx(float(told[0]), abs=0.6)
    assert 1.96 * state.standard_uncertainty / LBF == pytest.approx(float(told[1]), abs=0.6)
