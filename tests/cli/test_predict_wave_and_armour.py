"""`reduction predict wave-load` and `armour`: text, keys of --json, files, exit statuses."""

import numpy as np
import pytest
from commandruns import answered
from csvrows import csv_rows
from predicted_cases import ARMOUR, LEAST_WAVE, WAVE, changed

SETTINGS, DATA, FIT = 2, 4, 5

OF_WIRE = {
    "axial_force", "shear_force", "bending_moment", "torsion_moment", "axial_stress",
    "bending_stress", "torsion_stress",
}  # fmt: skip
THEORIES = ("small", "intermediate", "large", "exact", "conjugate")


@pytest.fixture
def predict(tmp_path, command):
    """The command on a SPEC.toml."""

    def run(what, spec, *options):
        (tmp_path / "case.toml").write_text(spec, encoding="utf-8")
        return command("predict", what, "case.toml", *options, cwd=tmp_path)

    return run


def test_a_wave_load_has_the_keys_of_the_contract(predict):
    answer = answered(predict("wave-load", WAVE, "--json"))
    series = ("time", "horizontal", "vertical", "horizontal_classic", "vertical_classic")
    assert {len(answer[name]) for name in series} == {401}
    # Zhang (2015), eq. (11)
    assert answer["immersion_depth"] == pytest.approx(0.0951, abs=0.5e-4)
    assert answer["submerged_section_area"] == pytest.approx(0.0091, abs=0.5e-4)
    assert {answer["units"][name] for name in series[1:]} == {"N m-1"}
    assert (answer["units"]["time"], answer["units"]["immersion_depth"]) == ("s", "m")
    assert answer["name"] == "case" and answer["out"] is None
    assert answer["wave"]["theory_used"] == "airy"
    assert any("stated wave length" in note for note in answer["notes"])


def test_the_wave_under_the_crest_is_that_of_the_formula(predict):
    """At time zero there is no acceleration: drag alone, of the velocity at the crest."""
    answer = answered(predict("wave-load", changed(WAVE, '"0.5 m/s"', '"0 m/s"'), "--json"))
    k, depth = 2 * np.pi / 20, 6.0
    level = k * (depth + answer["elevation"])
    velocity = np.pi * 1.25 / 3.57 * np.cosh(level) / np.sinh(k * depth)
    drag = 1.2 * 1025 / 2 * velocity**2
    assert answer["horizontal_classic"][0] == pytest.approx(drag * 0.114)
    assert answer["horizontal"][0] == pytest.approx(drag * answer["immersion_depth"])
    greatest = answer["extremes"]["horizontal"]["maximum"]
    assert greatest >= max(answer["horizontal"])


def test_a_wave_load_is_told_in_words(predict):
    done = predict("wave-load", WAVE)
    assert done.returncode == 0
    for text in (
        "immersed 0.09512 m of 0.114 m (83.4 %), 9099 mm² of its section",
        "wave of 20 m: d/L 0.3, H/L 0.0625", "Keulegan-Carpenter", "anchor force:",
        "note: the stated wave length differs by",
    ):  # fmt: skip
        assert text in done.stdout
    in_us = predict("wave-load", WAVE, "--units", "us").stdout
    # 9,099 mm2
    assert "lbf/ft" in in_us and "14.1 in² of its section" in in_us
    assert predict("wave-load", WAVE, "--quiet").stdout == ""


def test_a_theory_that_does_not_hold_is_the_first_line(predict):
    """A wave of 0.64 of breaking in 0.05 lengths of water: linear theory gives half the load."""
    shallow = LEAST_WAVE.replace("6 m", "4 m").replace("1.25 m", "2 m").replace("3.57", "12")
    done = predict("wave-load", f'{shallow}wave_theory = "airy"\n')
    first, _ = done.stdout.split("\n", 1)
    assert first.startswith("warning: airy does not hold for this wave: the greatest horizontal")
    assert "% too low" in first
    assert 'Use wave_theory = "stream function"' in first


def test_a_wave_load_has_a_table_and_a_page(predict, tmp_path):
    done = predict("wave-load", WAVE, "--out", "p")
    assert done.returncode == 0, done.stderr
    found = csv_rows(tmp_path / "p" / "tables" / "wave_load.csv")
    assert [*found[0]] == [
        "time [s]", "horizontal [N m-1]", "vertical [N m-1]", "horizontal_classic [N m-1]",
        "vertical_classic [N m-1]",
    ]  # fmt: skip
    answer = answered(predict("wave-load", WAVE, "--json", "--out", "p"))
    assert [float(row["vertical [N m-1]"]) for row in found] == answer["vertical"]
    assert answer["out"] == "p"
    page = (tmp_path / "p" / "index.html").read_text(encoding="utf-8")
    assert "Wave load case" in page and "Anchor force" in page


@pytest.mark.parametrize(
    ("old", "new", "status", "message"),
    [
        ('"114 mm"', '"-114 mm"', SETTINGS, "wave_load.outer_diameter: is not positive"),
        ('"114 mm"', '"114"', SETTINGS, "wave_load.outer_diameter: a value has no unit"),
        ('"20 m"', '"0 m"', SETTINGS, "wave_load.wave_length: is not positive"),
        ('"airy"', '"linear"', SETTINGS, "wave_load.wave_theory"),
        ('"1.25 g/cm^3"', '"2.5 g/cm^3"', DATA, "case.toml: the hose is heavier than water"),
        ('"1.25 m"', '"4 m"', DATA, "case.toml: a wave 20 m long breaks before it is this high"),
        ('"0.5 m/s"', '"-20 m/s"', DATA, "the opposing current stops"),
        ('"6 mm"', '"60 mm"', DATA, "the wall is thicker than half the hose"),
    ],
)
def test_no_such_wave_or_hose(predict, old, new, status, message):
    done = predict("wave-load", changed(WAVE, old, new), "--out", "p")
    assert done.returncode == status
    assert message in done.stderr and done.stdout == ""
    assert "Traceback" not in done.stderr


def test_a_wave_that_is_a_row_of_solitary_ones_is_refused(predict, tmp_path):
    shallow = changed(changed(LEAST_WAVE, '"6 m"', '"0.8 m"'), '"1.25 m"', '"0.1 m"')
    shallow = changed(shallow, '"3.57 s"', '"200 s"')
    done = predict("wave-load", shallow, "--out", "p")
    assert done.returncode == FIT
    assert "do not change with the period" in done.stderr
    assert not (tmp_path / "p").exists()


def test_an_armour_has_the_keys_of_the_contract_for_every_theory(predict):
    answer = answered(predict("armour", ARMOUR, "--json"))
    for theory in THEORIES:
        assert OF_WIRE <= answer[theory].keys()
        assert {len(answer[theory][name]) for name in OF_WIRE} == {2}
    # Wang (2022), sec. 4: 210 GPa times 0.1 % times the squared cosine
    assert answer["intermediate"]["axial_stress"] == pytest.approx([185.43e6] * 2, abs=0.5e4)
    assert answer["units"]["axial_stress"] == "Pa"
    assert answer["units"]["bending_moment"] == "N m"
    assert [layer["name"] for layer in answer["layers"]] == ["inner", "outer"]
    assert answer["cable"]["first_yield"]["governing_layer"] == 0
    assert answer["strain"] == pytest.approx(1e-3)


def test_a_cable_without_yield_stresses_has_no_first_yield(predict):
    answer = answered(predict("armour", ARMOUR.replace('yield_stress = "700 MPa"\n', ""), "--json"))
    assert answer["cable"]["first_yield"] is None


def test_an_armour_is_told_in_words(predict):
    done = predict("armour", ARMOUR)
    assert done.returncode == 0
    for text in (
        "One wire at 0.1 % strain of the cable", "Layers, theory conjugate", "axial stiffness",
        "first yield: inner at", "large angles: torsion_moment within 1 % of exact nowhere",
        "note: the layers do not balance",
    ):  # fmt: skip
        assert text in done.stdout
    assert "[psi]" in predict("armour", ARMOUR, "--units", "us").stdout
    assert predict("armour", ARMOUR, "--quiet").stdout == ""


def test_an_armour_has_tables_and_a_page(predict, tmp_path):
    answer = answered(predict("armour", ARMOUR, "--json", "--out", "p"))
    wires = csv_rows(tmp_path / "p" / "tables" / "armour_wires.csv")
    assert [(row["theory"], row["layer"]) for row in wires] == [
        (theory, layer) for theory in THEORIES for layer in ("inner", "outer")
    ]
    assert float(wires[0]["axial_force [N]"]) == answer["small"]["axial_force"][0]
    # the spring has no core to press on
    assert wires[4]["theory"] == "large" and wires[4]["angle_change [rad]"] == ""
    layers = csv_rows(tmp_path / "p" / "tables" / "armour_layers.csv")
    assert [row["layer"] for row in layers] == ["inner", "outer"]
    tension = [float(row["layer_tension [N]"]) for row in layers]
    assert sum(tension) == pytest.approx(answer["cable"]["tension"])
    page = (tmp_path / "p" / "index.html").read_text(encoding="utf-8")
    assert "Armour case" in page and "Where each theory holds" in page


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"20 deg"', '"95 deg"', "needed between 0 and 90 deg"),
        ('"20 deg"', '"-1 deg"', "needed between 0 and 90 deg"),
        ('"2.5 mm"', '"-2.5 mm"', "wire_radius of 1 of 2 designs is not that of an armour"),
        ('"5 mm"', '"-5 mm"', "wire_radius of 1 of 2 designs is not that of an armour"),
        ('"60 mm"', '"-60 mm"', "core_radius of 1 of 2 designs is not that of an armour"),
        ('"0.1 %"', '"-100 %"', "the strain is not that of a cable"),
        ('"0.1 %"', "0.1", 'A bare number is a share: 0.1 % is 0.001 or "0.1 %"'),
    ],
)
def test_no_such_armour(predict, old, new, message):
    done = predict("armour", changed(ARMOUR, old, new))
    assert done.returncode == SETTINGS
    assert message in done.stderr and "case.toml: " in done.stderr
    assert done.stdout == "" and "Traceback" not in done.stderr


def test_a_strain_may_be_a_plain_number_and_yielding_is_told(predict):
    done = predict("armour", changed(ARMOUR, '"0.1 %"', "0.01"))
    assert done.returncode == 0 and done.stdout.startswith("warning: inner: the wires yield")


@pytest.mark.parametrize(
    ("what", "key", "said"),
    [
        ("armour", 'elastic_modulus = "210 MPa"', "outer: its elastic_modulus is 0.21 GPa"),
        ("wave-load", 'water_density = "1.4 g/cm^3"', "water_density is 1400 kg/m3"),
        ("wave-load", 'current_velocity = "10 knot"', "current_velocity is 5.144 m/s"),
        ("wave-load", "inertia_coefficient = 0.2", "inertia_coefficient is 0.2"),
        ("wave-load", 'wave_length = "40 m"', "a wave of 3.57 s is 19.13 m long, not 40 m"),
    ],
)
def test_a_number_that_no_cable_or_sea_has_is_the_first_line(predict, what, key, said):
    spec = ARMOUR if what == "armour" else LEAST_WAVE
    assert not predict(what, spec).stdout.startswith("warning")
    done = predict(what, f"{spec}{key}\n")
    assert done.returncode == 0 and done.stdout.startswith(f"warning: {said}")


@pytest.mark.parametrize("what", ["wave-load", "armour"])
def test_a_file_that_is_not_there_is_no_setting(command, tmp_path, what):
    done = command("predict", what, tmp_path / "none.toml")
    assert done.returncode == SETTINGS and "none.toml" in done.stderr
