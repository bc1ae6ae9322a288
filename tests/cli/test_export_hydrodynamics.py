"""Options --drag and --added-mass of the export, as each format writes them."""

import json
import math
import re

import pytest
from export_readers import cable_material, moordyn_sections

NAME = "polyester-double-braid-0.5in-new"
WATER = ("--drag", "1.6, 0.02", "--added-mass", "0.9, 0.1", "--hydrodynamics-source", "towed 2019")
SAID = "stated at the export, towed 2019"


@pytest.fixture
def export(command, tmp_path):
    def write(to, *more):
        path = tmp_path / f"line.{to}"
        done = command(
            "export", NAME, "--to", to, "--out", path, "--linear-density", "0.11 kg/m", *more
        )
        assert done.returncode == 0, done.stderr
        return path.read_text(encoding="utf-8")

    return write


def whole(text):
    """A header without its broken lines."""
    return " ".join(re.sub(r"[#*/]", " ", text).split())


@pytest.mark.parametrize("to", ["moordyn", "openfast", "moorpy"])
def test_a_deck_has_the_coefficients_and_their_source(export, to):
    text = export(to, *WATER)
    (row,) = moordyn_sections(text)["LINE TYPES"]
    # Cd Ca CdAx CaAx
    assert [float(value) for value in row[-4:]] == [1.6, 0.9, 0.02, 0.1]
    assert SAID in whole(text)
    assert "assumed" not in text


def test_orcaflex_and_cable_have_them_as_their_grammar_is(export):
    text = export("orcaflex", *WATER)
    # nominal 1/2 in; volume of 0.11 kg/m of polyester, 1380 kg/m3: Cd times diameter stays
    volume, nominal = math.sqrt(4 * 0.11 / 1380 / math.pi), 0.0127
    across, along = (float(value) for value in re.search(r"Cd: \[(\S+), ~, (\S+)\]", text).groups())
    assert (across * nominal, along * nominal) == pytest.approx((1.6 * volume, 0.02 * volume))
    for way in ("Normal", "Axial"):
        (found,) = re.findall(rf"{way}DragLiftDiameter: (\S+)", text)
        assert float(found) == pytest.approx(nominal)
    assert float(re.search(r" OD: (\S+)", text)[1]) == pytest.approx(volume)
    assert "Ca: [0.9, ~, 0.1]" in text
    assert f"is times {volume / nominal:.4g} here" in whole(text)
    assert SAID in whole(text)
    text = export("whoi-cable", *WATER)
    _, rows = cable_material(text)
    assert (float(rows["Cdn"]), float(rows["Cdt"])) == (1.6, 0.02)
    # added mass of 0.9 times the displaced polyester, 1380 kg/m3
    assert float(rows["am"]) == pytest.approx(0.9 * 1025 * 0.11 / 1380)
    assert "added mass along the line, 0.1, left out: Cable has none" in whole(text)


def test_without_them_the_cylinder_is_assumed(export):
    text = whole(export("moordyn"))
    assert "assumed, not measured: a smooth cylinder" in text
    assert "left out" not in whole(export("whoi-cable"))
    half = whole(export("moordyn", *WATER[:2]))
    assert "drag stated at the export, without a source; added mass assumed" in half


def test_the_answer_has_them(command, tmp_path):
    done = command("export", NAME, "--to", "csv", "--out", tmp_path / "a.csv", *WATER, "--json")
    assert json.loads(done.stdout)["hydrodynamics"] == {
        "normal_drag": 1.6, "axial_drag": 0.02, "normal_added_mass": 0.9, "axial_added_mass": 0.1,
        "source": SAID,
    }  # fmt: skip
    refused = command("export", NAME, "--to", "csv", "--out", tmp_path / "a.csv", "--drag", "1.6")
    assert refused.returncode == 2
    assert "--drag is not a pair of coefficients" in refused.stderr
