import tomllib

import numpy as np
import pytest

from reduction.campaign.hose_spec import ComparisonSection, load_hose
from reduction.campaign.load import _plan_comparison, load_campaign
from reduction.record.errors import SettingsError

INCH, POUND, PSI = 0.0254, 4.4482216152605, 6894.757293168
SPEC = """
[hose]
wrap_angle = "68 deg"
wrap_diameter = "3.5 in"
inner_diameter = "2.5 in"
outer_diameter = "5 in"
cords_per_length = "34 1/in"
cord_diameter = "0.022 in"
rubber_modulus = "200 psi"
length = "2 m"
dead_length = "0.1 m"
[hose.standard_uncertainty]
wrap_angle = "0.5 deg"
rubber_modulus = "5 %"
cord_load_scale = "3 %"
dead_length = "10 mm"
[cord]
strain = [0.0, "10 %", 0.2]
load = ["0 lbf", "10 lbf", "30 lbf"]
"""


def write(tmp_path, text):
    path = tmp_path / "hose.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_hose_is_read_in_si(tmp_path):
    plan, _ = load_hose(write(tmp_path, SPEC))
    design = plan.design
    assert plan.name == "hose"
    assert np.degrees(design.wrap_angle) == pytest.approx(68)
    assert design.layer_diameter == pytest.approx((3.5 * INCH, 3.5 * INCH))
    assert design.cords_per_length == pytest.approx(34 / INCH)
    assert design.rubber_modulus == pytest.approx(200 * PSI)
    assert design.cord.load == pytest.approx(np.array([0, 10, 30]) * POUND)
    assert design.cord.strain == pytest.approx([0, 0.1, 0.2])
    assert design.dead_length_share == pytest.approx(0.05)
    assert design.working_share == pytest.approx(1 / 3)


def test_uncertainties_are_in_the_unit_of_their_number_or_a_share_of_it(tmp_path):
    plan, _ = load_hose(write(tmp_path, SPEC))
    assert plan.standard_uncertainty == pytest.approx(
        {
            "wrap_angle": np.radians(0.5),
            "rubber_modulus": 10 * PSI,
            "cord_load_scale": 0.03,
            "dead_length_share": 0.005,
        }
    )


def test_two_layers_have_their_own_diameters(tmp_path):
    text = SPEC.replace('wrap_diameter = "3.5 in"', 'layer_diameters = ["3.4 in", "3.6 in"]')
    plan, _ = load_hose(write(tmp_path, text))
    assert plan.design.layer_diameter == pytest.approx((3.4 * INCH, 3.6 * INCH))
    assert plan.design.wrap_diameter == pytest.approx(3.5 * INCH)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"68 deg"', '"98 deg"', "wrap_angle is not that of a hose; found .* needed between 0 and 90 deg"),
        ('"68 deg"', '"68"', "hose.wrap_angle: a value has no unit"),
        ('"68 deg"', '"68 m"', "hose.wrap_angle: unit 'm' is not a unit of angle"),
        ('"2.5 in"', '"-2.5 in"', "inner_diameter is not that of a hose; found -0.0635"),
        ('"2.5 in"', '"3.6 in"', "wrap_diameter is not that of a hose; .*above inner_diameter"),
        ('"5 in"', '"3.4 in"', "outer_diameter is not that of a hose; .*above the diameter of the cord"),
        ('"0 lbf", "10 lbf"', '"0 lbf", "40 lbf"', "cord.load does not rise at point 3"),
        ('"0 lbf", "10 lbf"', '"1 lbf", "10 lbf"', "cord.load does not begin at zero"),
        ('[0.0, "10 %", 0.2]', "[0.0, 0.2]", "2 strains, 3 loads"),
        ('[0.0, "10 %", 0.2]', '[0.0, "10 lbf", 0.2]', "cord.strain.2: unit 'lbf'"),
        ('wrap_diameter = "3.5 in"', "", "needs the position of its cords, stated once; found neither"),
        ('length = "2 m"\n', "", "hose.dead_length is stated without length"),
        ('length = "2 m"', 'length = "0 m"', "hose.length: is not positive"),
        ('"0.1 m"', '"2.1 m"', "dead_length over length is not that of a hose"),
        ('wrap_angle = "0.5 deg"', 'wrap = "0.5 deg"', "is not a hose parameter that can have"),
        ('wrap_angle = "0.5 deg"', 'wrap_angle = "-1 deg"', "is not a standard uncertainty"),
        (
            'wrap_angle = "0.5 deg"', 'layer_diameters = "1 mm"',
            "is stated without layer_diameters",
        ),
        ("[cord]", '[[hose.layers]]\nname = "K"\nwrap_angle = "1 m"\n[cord]', "hose.layers.K"),
        ("[hose.standard", "strain_step = 0\n[hose.standard", "hose.strain_step is out of range"),
        ("[hose.standard", 'greatest_strain = "-5 %"\n[hose.standard', "hose.greatest_strain: is not positive"),
        ("[hose]", '[hose]\nrubber_law = "ogden"', "rubber_law"),
        ('[0.0, "10 %", 0.2]', "[0.0, 10, 22]", "is more than a cord can stretch; found 2200 %"),
        ('wrap_angle = "0.5 deg"', 'wrap_angle = "70 deg"', "below the number itself"),
        ('"2 m"', '"1e300 m"', "hose.length: a number is outside the physical range"),
        ("[hose]", "[hose]\ncord_load_scale = true", "cord_load_scale"),
        (
            "[cord]", '[[hose.layers]]\nname = "K"\nwrap_angle = "95 deg"\n[cord]',
            "hose.layers.K.wrap_angle is out of range",
        ),
        (
            "[cord]",
            '[[hose.layers]]\nname = "K"\nwrap_angle = "70 deg"\nstrain_limit = "-2 %"\n[cord]',
            "hose.layers.K has an impossible strain limit; found -0.02 in tension",
        ),
    ],
)  # fmt: skip
def test_a_hose_that_cannot_be_is_refused_with_its_key(tmp_path, old, new, message):
    assert old in SPEC
    path = write(tmp_path, SPEC.replace(old, new, 1))
    with pytest.raises(SettingsError, match=message) as caught:
        load_hose(path)
    assert str(caught.value).startswith(str(path))


CAMPAIGN = """
[campaign]
id = "hoses"
title = "hoses"
[specimens.a]
kind = "stretch hose"
[specimens.b]
kind = "stretch hose"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "p", unit = "m", datum = "pin-to-pin" }
tension.1 = { column = "f", unit = "N" }
tension.2 = { column = "g", unit = "N" }
[defaults]
layout = "log"
[tests.S]
kind = "quasi-static"
file = "S.csv"
specimens = ["a"]
[tests.R]
kind = "relaxation"
file = "R.csv"
specimens = ["a"]
[tests.P]
kind = "cyclic"
file = "P.csv"
specimens = ["a", "b"]
"""
HOSE = SPEC.replace("[hose", "[hoses.H").replace("[cord]", "[hoses.H.cord]")


def campaign_of(tmp_path, more):
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN + HOSE + more, encoding="utf-8")
    return load_campaign(path)


def test_a_campaign_names_what_is_measured_and_what_is_predicted(tmp_path):
    campaign = campaign_of(
        tmp_path,
        '[comparisons.one]\nmeasured = "S"\npredicted = "H"\ncalibrate = ["wrap_angle"]\n'
        '[comparisons.two]\nmeasured = "P"\npredicted = "H"\nspecimen = "b"\n',
    )
    assert campaign.hoses["H"].design.cord.break_load == pytest.approx(30 * POUND)
    one, two = campaign.comparisons.values()
    assert (one.measured, one.specimen, one.predicted) == ("S", "a", "H")
    assert one.calibrate == ("wrap_angle",)
    assert two.specimen == "b"


def test_a_rope_is_not_held_against_a_hose(tmp_path):
    path = tmp_path / "campaign.toml"
    text = CAMPAIGN.replace('[specimens.a]\nkind = "stretch hose"', '[specimens.a]\nkind = "rope"')
    path.write_text(
        text + HOSE + '[comparisons.one]\nmeasured = "S"\npredicted = "H"\n', encoding="utf-8"
    )
    with pytest.raises(SettingsError, match="'a' is not a stretch hose; found rope"):
        load_campaign(path)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('measured = "X"\npredicted = "H"', "is not a test of the campaign; found X"),
        ('measured = "R"\npredicted = "H"', "'R' has no curve of tension .* found relaxation"),
        ('measured = "S"\npredicted = "G"', "is not a hose of the campaign; found G"),
        ('measured = "P"\npredicted = "H"', "'P' has several specimens"),
        ('measured = "S"\npredicted = "H"\nspecimen = "b"', "'S' has no such specimen; found b"),
        (
            'measured = "S"\npredicted = "H"\ncalibrate = ["wrap_angle", "wrap_angle"]',
            "calibrated twice",
        ),
    ],
)
def test_a_comparison_with_a_name_that_is_not_there_is_refused(tmp_path, table, message):
    with pytest.raises(SettingsError, match=message):
        campaign_of(tmp_path, f"[comparisons.one]\n{table}\n")


def test_a_campaign_of_hoses_alone_needs_no_tests(tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text('[campaign]\nid = "h"\ntitle = "h"\n' + HOSE, encoding="utf-8")
    assert load_campaign(path).hoses.keys() == {"H"}


def test_steps_are_named_as_test_and_step(tmp_path):
    steps = (
        '[tests.Q]\nfile = "Q.csv"\nspecimens = ["a"]\n[[tests.Q.steps]]\nname = "slow pull"\n'
        'from = "0 s"\nto = "9 s"\nkind = "quasi-static"\n'
    )
    campaign = campaign_of(
        tmp_path, steps + '[comparisons.one]\nmeasured = "Q/slow pull"\npredicted = "H"\n'
    )
    assert campaign.comparisons["one"].measured == "Q.slow-pull"
    section = ComparisonSection.model_validate(tomllib.loads('measured = "Q"\npredicted = "H"'))
    with pytest.raises(SettingsError, match="is not a test of the campaign; found Q"):
        _plan_comparison(
            campaign.path, "one", section, tests=campaign.tests, hoses=campaign.hoses,
            specimens=campaign.specimens,
        )  # fmt: skip
