"""Ends of a cycle with every look-up, the rule of ropes, and the tether that must not go slack."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from reduction.lines.archive_source import _is_of_mean
from reduction.lines.line_lookup import _loads_of_line, look_up
from reduction.lines.lookup_product import OF_MEAN, LineCurve, LineSource, LineSurface
from reduction.lines.published_source import published_sources
from reduction.record.errors import DataError

LBF = 4.4482216152605
POINTS = np.array([0.2, 1.0, 2.0])


def curve(quantity, value, branch):
    return LineCurve(quantity, "strain", 0.2, 2.0, at=POINTS, value=np.array(value), branch=branch)


SURFACE = LineSurface(
    "apparent_spring_constant", np.array([1e3]), np.array([[0, 0, 0]]), np.array([0.1, 10.0, 5.0]),
    np.array([0.5, 100.0, 100.0]), np.eye(1) / 15, 0.1, 14.0, 1.0,
)  # fmt: skip
TETHER = LineSource(
    "made tether", "synthetic", "Natsyn rubber (synthetic)", "", "new", 0.026, 1000.0,
    factor_names=("frequency", "mean_tension", "tension_amplitude"),
    surfaces={"apparent_spring_constant": SURFACE},
    curves=(
        curve("tangent_modulus", [1e6, 1e6, 3e6], "ascending"),
        curve("branch_tension", [100.0, 500.0, 800.0], "ascending"),
        curve("tangent_modulus", [1e6, 1e6, 3e6], "descending"),
        curve("branch_tension", [0.0, 300.0, 800.0], "descending"),
    ),
    kind="rubber tether",
)  # fmt: skip
ROPE = LineSource(
    "made rope", "synthetic", "nylon", "", "new", 0.026, 1000.0, curves=TETHER.curves[2:],
    kind="rope",
)  # fmt: skip


def test_a_modulus_comes_with_the_tension_of_its_own_branch():
    found = look_up(TETHER, "tangent_modulus", strain=[1.0, 1.5], branch="ascending")
    assert found.peak_tension.tolist() == [500.0, 650.0]
    assert found.minimum_share.tolist() == [0.5, 0.65]
    other = look_up(TETHER, "tangent_modulus", strain=1.0, branch="descending")
    assert other.peak_share == 0.3
    assert (found.branch, other.branch) == ("ascending", "descending")


def test_one_tension_alone_is_both_ends():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    found = look_up(line, "quasi_static_spring_constant", mean_tension=0.21 * 6400 * LBF)
    assert found.peak_share == pytest.approx(0.21)
    assert found.minimum_share == pytest.approx(0.21)
    assert look_up(line, "strain", tension=640 * LBF).peak_share == pytest.approx(0.1)


def test_a_tether_that_reaches_zero_tension_is_refused():
    with pytest.raises(DataError, match="made tether goes slack at 1 of 2 points"):
        look_up(TETHER, "tangent_modulus", strain=[0.2, 1.0], branch="descending")
    cycle = {"frequency": 0.3, "mean_tension": 50.0}
    assert look_up(TETHER, "apparent_spring_constant", tension_amplitude=49.0, **cycle).value == 1e3
    with pytest.raises(DataError, match="minimum tension of zero, peak 100 N"):
        look_up(TETHER, "apparent_spring_constant", tension_amplitude=50.0, **cycle)
    with pytest.raises(DataError, match="above their mean tension"):
        look_up(TETHER, "apparent_spring_constant", tension_amplitude=51.0, **cycle)


def test_a_rope_may_go_slack_and_has_the_rule_for_it():
    found = look_up(ROPE, "tangent_modulus", strain=0.2, branch="descending")
    assert found.peak_tension == 0
    loads = _loads_of_line(
        ROPE, {"mean_tension": np.array([150.0, 180.0]), "tension_amplitude": np.array(150.0)}, (2,)
    )
    # 300 N of 1,000 N from zero is allowed; 330 N from 30 N is always loaded
    assert loads.is_slack.tolist() == [True, False]
    assert not loads.is_above_rule.any()
    above = {"mean_tension": np.array(151.0), "tension_amplitude": np.array(151.0)}
    assert _loads_of_line(ROPE, above, ()).is_above_rule


def test_the_rule_of_fibres_is_not_that_of_rubber():
    assert "60 %" in ROPE.rule
    assert TETHER.rule == "a rubber tether must not go slack (WHOI-2005-10, sec. 2.3.2)"
    # 80 % of the break strength
    found = look_up(TETHER, "branch_tension", strain=2.0, branch="ascending")
    assert found.peak_share == 0.8
    assert not found.is_above_rule


def test_what_is_a_tether_is_said_by_its_kind_else_by_its_material():
    def line(material, kind):
        return LineSource("a", "s", material, "", "", 0.02, 1.0, kind=kind)

    assert line("Natsyn Rubber", "").is_tether
    assert line("", "rubber tether").is_tether
    assert not line("nylon", "").is_tether
    # the cords of a hose carry when it is stretched, and a hose lies slack on the water
    assert not line("rubber", "stretch hose").is_tether


def test_noise_below_zero_is_zero_and_beyond_the_points_nothing_is_known():
    noisy = LineSource(
        "made rope", "synthetic", "nylon", "", "", 0.02, 1000.0,
        curves=(curve("branch_tension", [-2.0, 300.0, 800.0], "ascending"),),
    )  # fmt: skip
    found = look_up(
        noisy, "branch_tension", strain=[0.2, 1.0, 3.0], branch="ascending", extrapolate="flag"
    )
    assert found.value[0] == -2
    assert found.peak_tension[:2].tolist() == [0.0, 300.0]
    assert np.isnan(found.peak_tension[2])
    assert np.isnan(found.peak_share[2])
    assert not found.is_above_rule[2]


def test_a_tether_beyond_its_points_is_not_known_to_be_slack():
    found = look_up(
        TETHER, "tangent_modulus", strain=[1.0, 2.5], branch="ascending", extrapolate="flag"
    )
    assert found.is_inside.tolist() == [True, False]
    assert found.peak_tension[0] == 500
    assert np.isnan(found.peak_tension[1])


def test_a_negative_tension_is_refused():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    with pytest.raises(DataError, match="mean_tension is negative; found -5 N"):
        look_up(line, "quasi_static_spring_constant", mean_tension=-5.0, extrapolate="flag")


def test_published_tethers_have_their_share_of_the_break_strength():
    # WHOI-2005-10, Table 6, T-2 new: 62 lb at 60 % and 127 lb at 120 %, of 800 lb
    found = look_up(
        published_sources()["rubber-tether-new-T-2"], "tangent_modulus", strain=[0.6, 0.9],
        branch="ascending",
    )  # fmt: skip
    assert found.peak_share == pytest.approx([62 / 800, (62 + 127) / 2 / 800])


def test_between_slack_and_three_percent_nothing_was_tested_and_the_lower_share_holds():
    # sec. 5.0: 62 % with a minimum of 3 % did no harm, above 30 % from zero it did
    mean = np.array([290.0, 290.0, 310.0, 120.0])
    amplitude = np.array([290.0, 289.99, 280.0, 120.0])
    found = look_up(
        replace(ROPE, surfaces={"apparent_spring_constant": SURFACE}, factor_names=TETHER.factor_names),
        "apparent_spring_constant", extrapolate="flag", frequency=0.3, mean_tension=mean,
        tension_amplitude=amplitude,
    )  # fmt: skip
    assert found.is_slack.tolist() == [True, False, False, True]
    # 580 N from 0 and from 0.01 N; 590 N from 30 N; 240 N from 0 is allowed, and is a snap load
    assert found.is_above_rule.tolist() == [True, True, False, False]
    assert any("snap load" in note for note in found.notes)


def test_an_old_line_is_judged_by_the_strength_it_has():
    # Table 10: polyester braid of five years breaks at 3,241 lb; its levels are shares of 7,000 lb
    line = published_sources()["polyester-double-braid-0.5in-5-years"]
    found = look_up(
        line, "apparent_spring_constant", frequency=0.3, mean_tension=2100 * LBF,
        tension_amplitude=840 * LBF,
    )  # fmt: skip
    assert found.peak_share == pytest.approx(0.42)
    assert found.own_peak_share == pytest.approx(2940 / 3241)
    assert found.own_minimum_share == pytest.approx(1260 / 3241)
    assert found.is_above_rule
    at = {"mean_tension": 1200 * LBF, "tension_amplitude": 744 * LBF}
    # 1,944 lb is 59.98 % of 3,241 lb
    assert not look_up(line, "apparent_spring_constant", frequency=0.3, **at).is_above_rule
    new = published_sources()["polyester-double-braid-0.5in-new"]
    same = look_up(new, "apparent_spring_constant", frequency=0.3, **at)
    assert same.own_peak_share == same.peak_share


def test_the_rule_of_nylon_is_taken_over_and_says_so():
    lines = published_sources()
    assert "taken over" not in lines["nylon-double-braid-0.5in-new"].rule
    assert "taken over for polyester" in lines["polyester-double-braid-0.5in-new"].rule
    hose = replace(lines["polyester-double-braid-0.5in-new"], kind="stretch hose")
    assert "taken over for a specimen of the kind stretch hose" in hose.rule


def test_a_surface_over_the_share_of_the_mean_is_asked_with_a_load():
    # K = 2000 + 500 x over amplitudes of 20 to 40 % of the mean: 35 % of 1 kN is x = 0.5
    surface = LineSurface(
        "apparent_spring_constant", np.array([2000.0, 500.0]), np.array([[0, 0], [0, 1]]),
        np.array([500.0, 0.2]), np.array([1500.0, 0.4]), np.eye(2) / 15, 1.0, 13.0, 1.0,
    )  # fmt: skip
    line = replace(
        ROPE, factor_names=("mean_tension", OF_MEAN), curves=(),
        surfaces={"apparent_spring_constant": surface},
    )  # fmt: skip
    found = look_up(line, "apparent_spring_constant", mean_tension=1000.0, tension_amplitude=350.0)
    assert float(found.value) == pytest.approx(2250)
    assert float(found.peak_share) == pytest.approx(1.35)
    with pytest.raises(DataError, match="tension_amplitude_over_mean 80 %, tested 20 to 40 %"):
        look_up(line, "apparent_spring_constant", mean_tension=1000.0, tension_amplitude=800.0)


def test_amplitudes_of_runs_that_are_shares_of_their_mean_are_known_as_such():
    mean, share = np.array([[1000.0, 2000.0, np.nan]]), np.array([[0.2, 0.4, 0.3]])
    runs = {"run_mean_tension": ("e", "r"), "run_tension_amplitude": ("e", "r")}
    for of, is_share in ((mean, True), (np.full((1, 3), 5000.0), False)):
        stored = xr.Dataset(
            {"run_level": (("e", "r", "f"), share[..., None])}
            | {name: (dims, value) for (name, dims), value in zip(
                runs.items(), (mean, share * of), strict=True)}
        )  # fmt: skip
        assert _is_of_mean(stored, 0, 0, "tension_amplitude") is is_share
        assert not _is_of_mean(stored, 0, 0, "mean_tension")
