"""The modulus to design with: one row a test and specimen, with what a designer has to know."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from reportparts import texts

from reduction.report.answer_tables import (
    _at_one_strain,
    _Series,
    design_modulus_table,
    hold_table,
    lacking_answer,
    pull_table,
    unlike_tests_table,
)
from reduction.report.campaign_summary import tiles
from reduction.report.test_view import OF_NO_TEST, Status, TestView
from reduction.report.text_style import NOT_GIVEN

S, B = "specimen", ("specimen", "branch_name", "strain_bin")
NAN = np.nan


def make_view(test="T-1", *, units="si", kind="rubber tether", whole=(1.2e6, 1.1e6), notes=()):
    """Two specimens of 500 mm2; the descending branch of the second is not reached at its middle.

    Ten cycles, nine of them in the tangents; standard uncertainties of 0.01 MPa, so that
    what is shown is 1.96 and, of the tangents, 2.306 times as much.
    """
    modulus = 1e6 * np.array(
        [[[1.0, 1.2, 1.4], [0.8, 1.0, 1.2]], [[0.9, 1.0, 1.1], [0.7, NAN, NAN]]]
    )
    spread = np.where(np.isfinite(modulus), 1e4, NAN)
    data = {
        "specimen_kind": (S, [kind, kind]),
        "tangent_modulus": (B, modulus),
        "tangent_modulus_standard_uncertainty": (B, spread),
        "tangent_modulus_count": (B, np.full(modulus.shape, 9)),
        "test_dynamic_modulus": (S, np.array(whole)),
        "test_dynamic_modulus_standard_uncertainty": (S, [1e4, 1e4]),
        "test_apparent_spring_constant": (S, 500e-6 * np.array(whole)),
        "test_mean_strain": (S, [1.0, 1.1]),
        "test_strain_amplitude": (S, [0.25, 0.25]),
        "test_frequency": (S, [0.1, 0.1]),
        "note_stage": ("note", [stage for stage, _, _ in notes]),
        "note": ("note", [text for _, text, _ in notes]),
        "note_code": ("note", ["fixture" for _ in notes]),
        "note_severity": ("note", [severity for *_, severity in notes]),
        "note_effect": ("note", np.full(len(notes), NAN)),
    }
    own = {
        S: ["new", "used"], "branch_name": ["ascending", "descending"],
        "strain_bin": [0.9, 1.1, 1.3], "cycle": np.arange(1, 11),
    }  # fmt: skip
    return TestView(test, xr.Dataset(data, own, {"test": test}), units)


def test_a_row_says_range_branches_and_cycles():
    table = design_modulus_table([make_view()])
    first, second = texts(table)
    # the middle of 75 to 125 % lies half-way between two bins
    assert first[:4] == ["new", "T-1", "75 to 125", "0.10"]
    assert first[4] == "600.0"  # N: 1.2 MPa over 500 mm2, and nothing is known of its uncertainty
    assert first[5].startswith("1.200 ± 0.0")
    assert first[6:8] == ["1.100 ± 0.023", "0.900 ± 0.023"]
    assert first[8] == "10; 9"
    assert second[:3] == ["used", "T-1", "85 to 135"]
    assert second[6] == "1.000 ± 0.023"
    assert float(table.rows[0][6].value) == pytest.approx(1.1e6)


def test_a_branch_without_a_value_there_has_a_dash_and_words_for_it():
    table = design_modulus_table([make_view()])
    assert texts(table)[1][7] == NOT_GIVEN
    assert any("no trustworthy value" in text for text in table.remarks)
    assert table.remarks[0].startswith("±: expanded uncertainty, 95 % (k = ")


def test_specimens_stand_together_in_the_order_of_the_campaign():
    table = design_modulus_table([make_view("T-2"), make_view("T-1")])
    assert [row[:2] for row in texts(table)] == [
        ["new", "T-2"], ["new", "T-1"], ["used", "T-2"], ["used", "T-1"],
    ]  # fmt: skip


def test_a_test_with_a_doubt_says_so_beside_its_numbers():
    notes = [
        ("cycles", "the last cycle is broken", "warning"),
        ("moduli", "one cycle only", "note"),
    ]
    doubted, sound = make_view(notes=notes), make_view("T-2")
    column = {row[1]: row[-1] for row in texts(design_modulus_table([doubted, sound]))}
    assert column == {"T-1": "check", "T-2": "reduced"}


@pytest.mark.parametrize("kind", ["rope", "stretch hose"])
def test_a_rope_and_a_hose_have_forces_per_unit_strain_alone(kind):
    table = design_modulus_table([make_view(kind=kind)])
    assert table.columns[4:7] == ("EA [N]", "ascending [N]", "descending [N]")
    # 500 mm2 of 1.2, 1.1 and 0.9 MPa; 0.023 MPa is 11.5 N
    assert texts(table)[0][4:7] == ["600.0", "550 ± 12", "450 ± 12"]
    assert table.caption.startswith("Design stiffness. EA:")


def test_ea_stands_over_the_rated_break_strength_where_it_is_known():
    view = make_view()
    data = view.data.assign(rated_break_strength=(S, [1500.0, NAN]))
    table = design_modulus_table([TestView("k", data)])
    assert table.columns[5] == "EA/MBL"
    assert [row[5] for row in texts(table)] == ["0.400", NOT_GIVEN]


def test_the_units_of_the_page_are_those_of_the_table():
    table = design_modulus_table([make_view(units="us")])
    assert table.columns[5:8] == ("whole cycle [psi]", "ascending [psi]", "descending [psi]")
    # 1.1 MPa; 0.023 MPa is 3.3 psi
    assert texts(table)[0][6] == "159.5 ± 3.3"


def test_without_cycles_there_is_no_table():
    view = make_view()
    assert design_modulus_table([]) is None
    assert design_modulus_table([make_view(whole=(NAN, NAN))]) is None
    assert design_modulus_table([TestView("k", view.data.drop_vars("test_mean_strain"))]) is None


def test_a_test_without_curves_has_its_whole_cycle_alone():
    view = make_view()
    table = design_modulus_table([TestView("k", view.data.drop_dims("strain_bin"))])
    assert texts(table)[0][6:9] == [NOT_GIVEN, NOT_GIVEN, "10"]


def test_cycles_used_are_those_after_the_break_in_that_have_a_number():
    view = make_view()
    amplitude = np.full((2, 10), 100.0)
    amplitude[1, 5:8] = NAN
    data = view.data.assign(tension_amplitude=((S, "cycle"), amplitude))
    data.attrs["settings"] = '{"reduction": {"cycles": {"break_in_cycles": 1}}}'
    table = design_modulus_table([TestView("k", data)])
    assert [row[8] for row in texts(table)] == ["9", "6; 9"]
    assert [row[8].value for row in table.rows] == ["9", "6"]


def test_numbers_of_an_earlier_run_say_so_in_their_row():
    for status in ("failed", OF_NO_TEST):
        old = replace(make_view("T-1"), status=Status("T-1", status))
        now = replace(make_view("T-2"), status=Status("T-2", "unchanged"))
        names = [row[1] for row in texts(design_modulus_table([old, now]))]
        assert names == ["T-1 (earlier run)", "T-2"] * 2


def with_level(view, *, middle, half, whole, **more):
    """The same test over other strains, with another modulus of the whole cycle [Pa]."""
    new = {
        "test_mean_strain": (S, [middle, middle]),
        "test_strain_amplitude": (S, [half, half]),
        "test_apparent_spring_constant": (S, 500e-6 * np.array([whole, whole])),
        **{name: (S, [value, value]) for name, value in more.items()},
    }
    return replace(view, data=view.data.assign(new))


def test_tests_of_one_specimen_that_differ_over_the_same_strains_stand_side_by_side():
    early = with_level(make_view("early"), middle=1.5, half=0.5, whole=1.4e6, earlier_cycles=0,
                       earlier_maximum_strain=1.2)  # fmt: skip
    late = with_level(make_view("late"), middle=1.52, half=0.53, whole=0.7e6, earlier_cycles=30,
                      earlier_maximum_strain=2.8)  # fmt: skip
    first, second = texts(unlike_tests_table([early, late]))
    assert [first[0], second[0]] == ["new", "used"]
    assert first[1:3] == ["early, late", "100 to 200"]
    assert first[5] == "0.500"
    assert "stretched to 280 % in between, at most 200 % before" in first[6]
    assert "30 cycles" in first[6] and "strain amplitude and frequency equal" in first[6]


def test_other_strains_parts_of_a_test_and_like_values_are_no_such_pair():
    level = {"middle": 1.5, "half": 0.5, "whole": 1.4e6}
    one = with_level(make_view("one"), **level)
    others = [
        with_level(make_view("elsewhere"), middle=2.2, half=0.5, whole=0.7e6),
        with_level(make_view("like"), middle=1.5, half=0.5, whole=1.3e6),
    ]
    part = with_level(make_view("part"), middle=1.5, half=0.5, whole=0.7e6)
    part.data.attrs["part_of"] = "one"
    assert unlike_tests_table([one, *others, part]) is None
    slow = with_level(make_view("slow"), middle=1.5, half=0.5, whole=0.7e6, test_frequency=0.01)
    (row, _) = texts(unlike_tests_table([one, slow]))
    assert row[6].startswith("frequency 0.10 times")


RISE = ("specimen", "branch_name", "first_loading_strain_bin")


def pulled(kind="quasi-static", *, of="rubber tether", **more):
    """A first rise of a specimen of 500 mm2 to 40 %, of a tangent of 1, 2, 3 and 4 MPa.

    Loads are those of the tangent; standard uncertainties 0.01 MPa and 1 N.
    """
    modulus = np.full((1, 2, 4), NAN)
    modulus[0, 0] = [1e6, 2e6, 3e6, 4e6]
    load = np.full((1, 2, 4), NAN)
    load[0, 0] = [50.0, 150.0, 300.0, 500.0]
    data = {
        "specimen_kind": (S, [of]), "area": (S, [500e-6]),
        "tangent_modulus_first_loading": (RISE, modulus),
        "tangent_modulus_first_loading_standard_uncertainty": (RISE, modulus / modulus * 1e4),
        "branch_tension_first_loading": (RISE, load),
        "branch_tension_first_loading_standard_uncertainty": (RISE, load / load),
        **{name: (("note",), []) for name in ("note", "note_stage", "note_code", "note_severity")},
        "note_effect": ("note", np.zeros(0)),
        **more,
    }  # fmt: skip
    own = {S: ["new"], "branch_name": ["ascending", "descending"],
           "first_loading_strain_bin": [0.1, 0.2, 0.3, 0.4]}  # fmt: skip
    return TestView(kind, xr.Dataset(data, own, {"test": "P-1", "test_kind": kind}))


def test_a_pull_has_its_end_and_the_stiffness_half_way_there():
    table = pull_table([pulled().without_samples().of_campaign({})])
    assert table.columns[3:7] == (
        "strain [%]", "load [N]", "EA at half that strain [N]", "modulus there [MPa]",
    )  # fmt: skip
    # 2 MPa at 20 %, over 500 mm2
    assert texts(table) == [
        ["new", "P-1", "peak load", "40.00", "500.0 ± 2.0", "1,000.0 ± 9.8", "2.000 ± 0.020",
         "reduced"]
    ]  # fmt: skip


def test_a_break_has_its_own_load_and_strain_and_a_line_no_modulus():
    more = {name: (S, [value]) for name, value in {
        "pull_is_break": 1, "pull_peak_strain": 0.45, "pull_peak_strain_standard_uncertainty": 0.01,
        "pull_peak_tension": 600.0, "pull_peak_tension_standard_uncertainty": 10.0,
    }.items()}  # fmt: skip
    table = pull_table([pulled("tensile", of="rope", **more)])
    # half of 45 %: a quarter of the way from 2 MPa at 20 % to 3 MPa at 30 %
    assert texts(table) == [
        ["new", "P-1", "break", "45.0 ± 2.0", "600 ± 20", "1,125.0 ± 9.8", "reduced"]
    ]


def test_a_break_without_a_curve_before_it_has_its_load_and_strain():
    # cycles before the pull, and no diameter: neither K_0 nor a first loading is known
    more = {name: (S, [value]) for name, value in {
        "pull_is_break": 1, "pull_peak_strain": 0.45, "pull_peak_strain_standard_uncertainty": 0.01,
        "pull_peak_tension": 600.0, "pull_peak_tension_standard_uncertainty": 10.0,
    }.items()}  # fmt: skip
    view = pulled("tensile", of="rope", **more)
    bare = view.data.drop_dims("first_loading_strain_bin")
    (row,) = texts(pull_table([replace(view, data=bare)]))
    assert row == ["new", "P-1", "break", "45.0 ± 2.0", "600 ± 20", NOT_GIVEN, "reduced"]


@pytest.mark.parametrize(("is_break", "end"), [(1, "break"), (0, "peak load")])
def test_a_pull_whose_strain_is_not_known_has_not_that_of_its_curve(is_break, end):
    # an extensometer was taken off at 40 %, and the load rose on to 600 N
    more = {name: (S, [value]) for name, value in {
        "pull_is_break": is_break, "pull_peak_strain": NAN, "pull_peak_tension": 600.0,
    }.items()}  # fmt: skip
    told = {
        "note": ("note", ["new: strain at the greatest load not given"]),
        "note_stage": ("note", ["tensile strength"]), "note_severity": ("note", ["refusal"]),
        "note_code": ("note", ["no-strain-at-failure"]), "note_effect": ("note", [NAN]),
    }  # fmt: skip
    view = pulled("tensile", of="rope", **more, **told)
    (row,) = texts(pull_table([view]))
    assert row[2:5] == [end, NOT_GIVEN, "600.0"]
    assert "strain at the greatest load not given" in lacking_answer(view)


def test_breaks_of_one_kind_have_their_mean_deviation_and_least():
    def broken(load, material="nylon"):
        return pulled(
            "tensile", of="rope", specimen_material=(S, [material]), pull_is_break=(S, [1]),
            tensile_strength=(S, [load]),
        )  # fmt: skip

    views = [*map(broken, (900.0, 1000.0, 1100.0)), broken(500.0, "polyester")]
    (found,) = (one for one in pull_table(views).remarks if one.startswith("Breaks of"))
    # deviations of -100, 0 and 100 N over n - 1
    assert found.startswith(
        "Breaks of 3 specimens (rope, nylon): mean 1,000 N, standard deviation 100.0 N (10.0 %),"
        " least 900.0 N."
    )


def test_a_slow_pull_of_a_rope_has_k_0_half_way():
    grid = (S, "tension_grid")
    more = {
        "tension_grid": ("tension_grid", [100.0, 200.0, 300.0]),
        "quasi_static_strain": (grid, [[0.02, 0.05, 0.10]]),
        "quasi_static_spring_constant": (grid, [[3e3, 4e3, 5e3]]),
        "quasi_static_spring_constant_standard_uncertainty": (grid, [[100.0] * 3]),
    }
    (row,) = texts(pull_table([pulled(of="rope", **more)]))
    assert row[3:6] == ["10.00", "300.0", "4,000 ± 200"]
    # a rubber stiffens at both ends of its curve, which no cubic of load does
    (row,) = texts(pull_table([pulled(of="elastomer", **more)]))
    assert row[3:6] == ["40.00", "500.0 ± 2.0", "1,000.0 ± 9.8"]


MISSED = {
    "note": ("note", ["new: a cubic misses the load-strain curve by 2.9 % of its strain"]),
    "note_stage": ("note", ["test"]), "note_code": ("note", ["pull-misfit"]),
    "note_severity": ("note", ["note"]), "note_effect": ("note", [NAN]),
    "tension_grid": ("tension_grid", [100.0, 200.0, 300.0]),
    "quasi_static_strain": ((S, "tension_grid"), [[0.02, 0.05, 0.10]]),
    "quasi_static_spring_constant": ((S, "tension_grid"), [[3e3, 4e3, 5e3]]),
}  # fmt: skip


def test_k_0_is_at_half_the_strain_and_not_at_the_tension_of_the_grid_next_to_it():
    more = MISSED | {"quasi_static_strain": ((S, "tension_grid"), [[0.02, 0.06, 0.10]])}
    (row,) = texts(pull_table([pulled(of="rope", **more)]))
    assert row[3:6] == ["10.00", "300.0", "3,750"]


def test_a_curve_that_a_cubic_misses_answers_with_the_spline_where_no_area_is_stated():
    (row,) = texts(pull_table([pulled(of="other", **MISSED)]))
    assert row[3:6] == ["40.00", "500.0 ± 2.0", "1,000.0 ± 9.8"]
    # without a first rise, as without an area or where the log begins under a load
    view = pulled(of="other", **MISSED)
    (row,) = texts(pull_table([replace(view, data=view.data.drop_dims("branch_name"))]))
    assert row[3:6] == ["10.00", "300.0", "4,000"]


def test_ea_is_at_half_the_strain_of_the_greatest_load_not_of_the_end():
    # necking goes on to 40 % behind the greatest load at 20 %: 1 MPa at 10 %, over 500 mm2
    more = {"pull_is_break": (S, [1]), "pull_peak_strain": (S, [0.2])}
    (row,) = texts(pull_table([pulled("tensile", of="other", **more)]))
    assert row[3] == "20.00" and row[5] == "500.0 ± 9.8"


def test_a_pull_that_begins_under_a_load_has_k_0_in_its_middle():
    grid = (S, "tension_grid")
    more = {
        "tension_grid": ("tension_grid", [100.0, 200.0, 300.0]),
        "quasi_static_strain": (grid, [[0.08, 0.09, 0.10]]),
        "quasi_static_spring_constant": (grid, [[3e3, 4e3, 5e3]]),
        "quasi_static_spring_constant_standard_uncertainty": (grid, [[2500.0, 100.0, 100.0]]),
    }
    (row,) = texts(pull_table([pulled(of="rope", **more)]))
    assert row[5] == "4,000 ± 200"


def test_weights_have_the_modulus_half_way():
    more = {
        "tension": ("step", [0.0, 100.0, 200.0, 100.0]), "strain": ("step", [0.0, 0.1, 0.4, 0.2]),
        "interval_strain": ("interval", [0.05, 0.25, 0.3]),
        "interval_branch": ("interval", [1, 1, 2]),
        "interval_modulus": ("interval", [2e6, 1e6, 9e6]),
        "interval_modulus_standard_uncertainty": ("interval", [1e4] * 3),
    }  # fmt: skip
    view = pulled("stepwise", **more)
    (row,) = texts(pull_table([replace(view, data=view.data.drop_dims("branch_name"))]))
    # at 20 %, three quarters of the way from 2 MPa at 5 % to 1 MPa at 25 %
    assert row[3:7] == ["40.00", "200.0", "625.0 ± 9.8", "1.250 ± 0.020"]


def test_a_relaxation_test_has_its_longest_hold_and_others_have_neither_table():
    hold = {
        "hold_specimen": ["new", "new"], "hold_duration": [60.0, 7200.0],
        "hold_strain": [1.0, 1.5], "hold_initial_tension": [300.0, 400.0],
        "hold_initial_tension_standard_uncertainty": [1.0, 2.0],
        "relaxation_drop": [0.01, 0.05], "relaxation_rate_per_decade": [NAN, 0.02],
        "creep_rate_per_decade": [NAN, NAN],
    }  # fmt: skip
    view = pulled("relaxation", **{name: ("hold", value) for name, value in hold.items()})
    table = hold_table([view])
    assert table.columns[-2:] == ("tension per decade [%]", "status")
    assert texts(table) == [
        ["new", "P-1", "150.0", "400.0 ± 3.9", "2.00", "5.000", "2.000", "reduced"]
    ]
    assert pull_table([view]) is None
    assert pull_table([make_view()]) is None and hold_table([make_view()]) is None


def test_a_hold_without_its_drop_says_why():
    hold = {
        "hold_specimen": ["new", "new"], "hold_duration": [60.0, 7200.0],
        "hold_refusal": ["too short", "tension steps"], "relaxation_drop": [NAN, NAN],
        "creep_rate_per_decade": [NAN, NAN],
    }  # fmt: skip
    view = pulled("relaxation", **{name: ("hold", value) for name, value in hold.items()})
    assert lacking_answer(view) == "new: tension steps"
    hold["relaxation_drop"] = [NAN, 0.05]
    view = pulled("relaxation", **{name: ("hold", value) for name, value in hold.items()})
    assert lacking_answer(view) == "" == lacking_answer(make_view())


def test_a_warning_of_one_specimen_leaves_the_other_as_it_is():
    def status(*note):
        view = make_view(notes=[(*note, "warning")])
        return [row[-1] for row in texts(design_modulus_table([view]))]

    assert status("moduli", "new: the splices slipped") == ["check", "reduced"]
    assert status("hold 2 used", "drifts") == ["reduced", "check"]
    assert status("cycles", "the load cell drifts") == ["check", "check"]


def test_cycles_of_a_part_are_counted_in_the_whole_test_only():
    whole, part = make_view("T-1"), make_view("T-1-end")
    part.data.attrs["part_of"] = "T-1"
    assert "10" in [tile.number for tile in tiles([whole, part], [], [])]
    assert "10" in [tile.number for tile in tiles([part], [], [])]


# EA of a pull at a strain: its uncertainty is that at this strain, not at this tension

GAIN, POWER = 0.01, 3.0


def test_the_gain_of_a_load_cell_changes_a_slope_at_one_strain_by_all_of_itself():
    """T = e^3: K = 3 T^(2/3) at one tension changes by a third of the gain."""
    load = np.linspace(1.0, 8.0, 2001)
    strain, stiffness = load ** (1 / POWER), POWER * load ** (1 - 1 / POWER)
    # readings g T at the strain of T: strain and slope at a reading T are those of T / g
    read = load / (1 + GAIN)
    slope = (1 + GAIN) * POWER * read ** (1 - 1 / POWER)
    found = {
        "quasi_static_spring_constant_uncertainty_contribution": slope - stiffness,
        "quasi_static_strain_uncertainty_contribution": read ** (1 / POWER) - strain,
    }
    arrays = {name: values[None, None] for name, values in found.items()} | {
        f"{name}_random_standard_uncertainty": np.zeros((1, load.size))
        for name in ("quasi_static_spring_constant", "quasi_static_strain")
    }
    at_tension = _Series(stiffness, 1.96 * np.abs(slope - stiffness), np.full(load.size, 1.96))
    view = SimpleNamespace(array=arrays.get)
    made = _at_one_strain(view, 0, at_tension, load)
    assert (at_tension.half / stiffness)[1000] == pytest.approx(1.96 * GAIN / POWER, rel=0.02)
    assert (made.half / stiffness)[1:-1] == pytest.approx(1.96 * GAIN, rel=0.02)
    alone = SimpleNamespace(array={}.get)
    assert _at_one_strain(alone, 0, at_tension, load) is at_tension
