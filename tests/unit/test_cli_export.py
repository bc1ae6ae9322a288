"""Cases of export that need no command."""

from dataclasses import replace

import numpy as np
import pytest
from export_lines import constant, line

from reduction.cli.export import _stated_hydrodynamics, _with_syrope
from reduction.lines.export_dynamics import Viscoelasticity
from reduction.lines.export_line import CYLINDER
from reduction.record.errors import SettingsError


def test_both_stand_in_place_of_the_assumed_cylinder():
    found = _stated_hydrodynamics("1.6, 0.02", "0.9,0.1", "towed in 2019")["hydrodynamics"]
    assert (found.normal_drag, found.axial_drag) == (1.6, 0.02)
    assert (found.normal_added_mass, found.axial_added_mass) == (0.9, 0.1)
    assert found.source == "stated at the export, towed in 2019"
    assert "assumed" not in found.source


def test_what_is_not_stated_stays_assumed_and_says_so():
    drag = _stated_hydrodynamics("1.6, 0.02", None, "towed")["hydrodynamics"]
    assert drag.normal_added_mass == CYLINDER.normal_added_mass
    assert drag.source.startswith("drag stated at the export, towed; added mass assumed, not")
    mass = _stated_hydrodynamics(None, "0.9, 0", None)["hydrodynamics"]
    assert mass.normal_drag == CYLINDER.normal_drag
    assert mass.source.startswith("drag assumed, not measured")
    assert mass.source.endswith("added mass stated at the export, without a source")
    assert _stated_hydrodynamics(None, None, None) == {}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (("1.6", None, None), "--drag is not a pair of coefficients; found '1.6'"),
        ((None, "1,0,0", None), "--added-mass is not a pair"),
        (("1.6, -0.1", None, None), "--drag is negative; found '1.6, -0.1'"),
        (("1.6, 0.1 m", None, None), "--drag: .*needed two numbers"),
        (("a, b", None, None), "--drag: "),
        ((None, None, "a book"), "without coefficients; found --hydrodynamics-source a book"),
    ],
)
def test_what_is_no_pair_of_coefficients_is_refused(given, message):
    with pytest.raises(SettingsError, match=message):
        _stated_hydrodynamics(*given)


# 900 N at most: the fast spring has 2,000 N and 1 N more for each N of mean
PART = Viscoelasticity(
    static_stiffness=500.0, dynamic_stiffness=2000.0, dashpot_coefficient=900.0,
    dynamic_stiffness_per_mean_tension=1.0, mean_tension=300.0,
)  # fmt: skip


def test_working_curves_are_stated_and_the_rest_is_of_the_three_parameters():
    one = line(viscoelasticity=PART, linear_density=0.5)
    assert _with_syrope(one, None, None, form="table") is one
    made = _with_syrope(one, "quadratic, 0.2, 0.5", "400 N", form="syrope")
    found = made.syrope
    assert (found.form, found.k1, found.k2) == ("QUADRATIC", 0.2, 0.5)
    assert (found.mean_tension, found.greatest_mean_tension) == (300.0, 400.0)
    # EA_d 2,300 N of 500 N static: N (2300 / 1800)^2
    assert found.slow_damping == pytest.approx(900 * (2300 / 1800) ** 2)
    # a tenth of critical for segments of 2 m
    assert found.fast_damping == pytest.approx(0.2 * np.sqrt(2300 * 0.5))
    assert "stated at the export" in made.sources[-1]
    assert _with_syrope(one, "LINEAR, 0.2", "400 N", form="syrope").syrope.k2 == 0
    own = replace(one, rated_break_strength=1000.0)
    share = _with_syrope(own, "LINEAR, 0.2", "40 %RBS", form="syrope").syrope
    assert share.greatest_mean_tension == 400.0


@pytest.mark.parametrize(
    ("curve", "tension", "form", "message"),
    [
        ("LINEAR, 0.2", None, "syrope", "only partly stated"),
        (None, "400 N", "syrope", "only partly stated"),
        ("LINEAR, 0.2", "400 N", None, "only to a Syrope line"),
        ("LINEAR", "400 N", "syrope", "--working-curve is not understood"),
        ("LINEAR, 1, 2, 3", "400 N", "syrope", "--working-curve is not understood"),
        ("LINEAR, much", "400 N", "syrope", "--working-curve: "),
        ("CUBIC, 0.2", "400 N", "syrope", "form of a Syrope working curve is not known"),
        ("LINEAR, 0.2", "200 N", "syrope", "do not fit its original working curve"),
    ],
)
def test_what_does_not_make_a_syrope_is_refused(curve, tension, form, message):
    with pytest.raises(SettingsError, match=message):
        _with_syrope(line(viscoelasticity=PART), curve, tension, form=form)


def test_a_line_without_dynamics_or_mass_is_refused():
    with pytest.raises(SettingsError, match="needs the dynamics"):
        _with_syrope(line(), "LINEAR, 0.2", "400 N", form="syrope")
    with pytest.raises(SettingsError, match="linear density"):
        _with_syrope(
            line(viscoelasticity=constant(mean_tension=300.0), linear_density=np.nan),
            "LINEAR, 0.2", "400 N", form="syrope",
        )  # fmt: skip
