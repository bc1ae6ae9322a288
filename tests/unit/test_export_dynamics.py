import math

import numpy as np
import pytest
from export_lines import constant, growing, syrope

from reduction.record.errors import SettingsError


def test_the_dashpot_of_a_mooring_code_gives_the_same_stiffness_at_every_frequency():
    part = constant()
    slow, fast = part.static_stiffness, part.fast_stiffness
    omega = np.logspace(-4, 3, 40)
    maxwell = slow + (fast - slow) / (1 - 1j / (omega * part.relaxation_time))
    spring = 1 / (1 / slow - 1 / fast)
    series = 1 / (1 / fast + 1 / (spring + 1j * omega * part.slow_dashpot_coefficient))
    np.testing.assert_allclose(series, maxwell, rtol=1e-12)
    assert part.relaxation_time == 3.0


def test_a_stiffness_that_grows_is_taken_at_its_mean_tension():
    assert growing().fast_stiffness == 3e4 + 10 * 2000


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"dashpot_coefficient": -1.0}, "must be zero or positive"),
        ({"dashpot_coefficient": math.nan}, "must be zero or positive"),
        ({"dynamic_stiffness_per_mean_tension": 5.0}, "has no mean tension"),
        ({"dynamic_stiffness": 2e4}, "not above the static one"),
        ({"static_stiffness": 0.0}, "not above the static one"),
    ],
)
def test_a_line_that_is_not_stiffer_when_fast_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        constant(**changed)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"form": "CUBIC"}, "form of a Syrope working curve is not known"),
        ({"k1": 0.0}, "form LINEAR cannot have"),
        ({"form": "QUADRATIC", "k2": 1.5}, "form QUADRATIC cannot have"),
        ({"form": "EXP", "k1": 1.0, "k2": 1.0}, "form EXP cannot have"),
        ({"mean_tension": 4e6}, "do not fit its original working curve"),
        ({"greatest_mean_tension": 7e6}, "do not fit its original working curve"),
        ({"slow_damping": 0.0}, "stiffness and damping of a Syrope line"),
        ({"dynamic_stiffness": 5e7, "dynamic_stiffness_per_mean_tension": 0.0}, "stiffer than"),
    ],
)
def test_a_syrope_that_moordyn_would_not_survive_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        syrope(**changed)


def test_a_working_curve_ends_at_the_greatest_mean_tension_and_begins_at_its_share_of_strain():
    for form, k1, k2 in (("LINEAR", 0.2, 0), ("QUADRATIC", 0.2, 0.5), ("EXP", 0.2, 1.5)):
        at_top = syrope(form=form, k1=k1, k2=k2, mean_tension=3e6)
        assert at_top.initial_strain == pytest.approx(0.04)
        at_zero = syrope(form=form, k1=k1, k2=k2, mean_tension=1e-3)
        assert at_zero.initial_strain == pytest.approx(0.008, abs=1e-9)
    assert syrope(k1=1e8).initial_strain == pytest.approx(0.04 - 2e6 / 1e8)


@pytest.mark.parametrize(
    ("form", "k1", "k2", "slope"),
    [
        # 3 MN over 0.04 (1 - k1) of strain, times 1, 1 + k2 and k2 / (1 - exp(-k2)) at the top
        ("LINEAR", 0.5, 0.0, 3e6 / 0.02),
        ("LINEAR", 1.6e8, 0.0, 1.6e8),
        ("QUADRATIC", 0.2, 1.0, 3e6 / 0.032 * 2),
        ("EXP", 0.2, 1.5, 3e6 / 0.032 * 1.5 / (1 - np.exp(-1.5))),
    ],
)
def test_a_working_curve_that_is_stiffer_than_the_fast_spring_is_refused(form, k1, k2, slope):
    """MoorDyn starts it a fifth below the tension that it is told."""
    fields = {"form": form, "k1": k1, "k2": k2, "dynamic_stiffness_per_mean_tension": 0.0}
    assert syrope(**fields, dynamic_stiffness=1.001 * slope).k1 == k1
    with pytest.raises(SettingsError, match="working curve is stiffer than the dynamic stiffness"):
        syrope(**fields, dynamic_stiffness=0.999 * slope)
