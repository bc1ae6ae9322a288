"""None"""

import math
import re
from typing import get_args

import numpy as np
import pytest
import yaml
from export_lines import constant, line, rubber
from export_readers import CableExpression, abaqus, cable_material, cable_pairs, orcaflex
from refusals import refusals

from reduction.lines.composite import CompositeRule, compose
from reduction.lines.deck_formats import (
    FORMATS,
    FORMS,
    WhoiCableForm,
    _abaqus_text,
    _fit_smooth_curve,
    _orcaflex_text,
    _whoicable_text,
    closeness_of,
    export_line,
)
from reduction.lines.deck_moordyn import MoorDynForm, MoorPyForm, OpenFastForm
from reduction.lines.deck_text import header_lines, number, one_line, real_number
from reduction.lines.export_line import (
    SEA_WATER,
    ExportLine,
    beside_dashpot,
    cycle_damping,
    loop_stiffness,
    thin_curve,
)
from reduction.lines.export_sources import line_from_composite, line_from_lookup
from reduction.lines.published_source import published_piece_sources, published_sources
from reduction.record.errors import DataError, SettingsError


@pytest.mark.parametrize("to", FORMATS)
def test_the_file_that_was_asked_for_is_there_and_is_the_last(to, tmp_path):
    path = tmp_path / "my line.dat"
    # a code with one stiffness takes that of a cycle
    written = export_line(line(damping=cycle_damping(10.0, 0.1, 0.5)), to, path)
    assert written[-1] == path
    assert set(tmp_path.iterdir()) == set(written)
    assert all(" " not in one.name for one in written[:-1])


def test_files_of_two_codes_may_stand_in_one_folder(tmp_path):
    """MoorDyn does not survive the end of the table that MoorPy needs."""
    first = export_line(line(), "moordyn", tmp_path / "a.dat")
    second = export_line(line(), "moorpy", tmp_path / "a.txt")
    assert not set(first) & set(second)


def test_forms_are_handed_on(tmp_path):
    one = line(viscoelasticity=constant())
    export_line(one, "moordyn", tmp_path / "a.dat", form="static-dynamic")
    assert "20000|50000" in (tmp_path / "a.dat").read_text()
    export_line(one, "whoi-cable", tmp_path / "a.cbl", form="table")
    assert "T = (0.0, 0.0) (" in (tmp_path / "a.cbl").read_text()


def test_a_format_is_told_the_forms_that_its_writer_knows():
    known = {
        "moordyn": MoorDynForm, "openfast": OpenFastForm, "moorpy": MoorPyForm,
        "whoi-cable": WhoiCableForm,
    }  # fmt: skip
    assert FORMS == {to: get_args(known[to]) if to in known else () for to in FORMS}


def test_unknown_formats_and_forms_are_refused(tmp_path):
    with pytest.raises(SettingsError, match="format is not known"):
        export_line(line(), "ansys", tmp_path / "a")
    with pytest.raises(SettingsError, match="orcaflex has no form 'table'"):
        export_line(line(), "orcaflex", tmp_path / "a", form="table")
    with pytest.raises(SettingsError, match=r"needed one of table, library"):
        export_line(line(), "moorpy", tmp_path / "a", form="syrope")
    assert set(FORMS) < set(FORMATS)
    assert list(tmp_path.iterdir()) == []


def test_every_deck_of_a_folder_has_a_table_of_its_own(tmp_path):
    """The second must not take the table of the first, whatever both are called."""
    names = ["leg 1.dat", "leg-1.txt", "leg_1.dat", "leg.dat", "leg.txt", "leg_table.dat", "leg"]
    tables = [export_line(line(), "moordyn", tmp_path / name)[0] for name in names]
    assert len(set(tables)) == len(names)
    assert not set(tables) & {tmp_path / name for name in names}
    for name, table in zip(names, tables, strict=True):
        assert f" {table.name} " in (tmp_path / name).read_text()
    assert export_line(line(), "moordyn", tmp_path / "leg 1.dat")[0] == tables[0]


K, LOSS = 100.0, 0.3  # a spring [N], and the loss factor of the dashpot beside it
REACH = K * math.hypot(1, LOSS) / 2  # half the range of tension in a sine of strain 1 +- 0.5


def viscous_test(**changed):
    """The mean curve of spring and dashpot, cut off at 0.8 of the amplitude, and its turns."""
    strain = np.array([0.5, 0.6, 1.4, 1.5])
    tension = np.array([100 - REACH, 60.0, 140.0, 100 + REACH])
    damping = cycle_damping(
        math.pi * LOSS * K * 0.25, 0.2, 0.5, apparent_stiffness=K * math.hypot(1, LOSS)
    )
    fields = {
        "turns": (0.5, 1.5), "tested": (0.6, 1.4), "linear_density": 0.6, "diameter": 0.03,
        "damping": damping,
    }  # fmt: skip
    return ExportLine("a", strain, tension, "mean", sources=("none",), **fields | changed)


def test_what_the_dashpot_pulls_is_not_in_its_table_as_well():
    one = viscous_test()
    made = beside_dashpot(one)
    assert made.tension == pytest.approx([50.0, 60.0, 140.0, 150.0], rel=1e-4)
    assert loop_stiffness(made, one.damping) == pytest.approx(K * math.hypot(1, LOSS), rel=1e-5)
    assert "K_ap of that cycle is 104.4" in made.notes[-1]


def test_a_curve_without_a_straight_end_or_a_dashpot_stays_as_it_is():
    for one in (viscous_test(damping=None), viscous_test(tested=(0.5, 1.5))):
        assert beside_dashpot(one) is one


def test_a_code_with_one_stiffness_takes_k_ap_of_the_test(tmp_path):
    export_line(viscous_test(), "raft", tmp_path / "a.yml")
    mooring = yaml.safe_load((tmp_path / "a.yml").read_text())["mooring"]
    (kind,), (whole,) = mooring["line_types"], mooring["lines"]
    # the anchor lies under the fairlead by the length of the line at the middle of the cycle
    length = -mooring["points"][0]["location"][2] / 2
    assert kind["stiffness"] * length / whole["length"] == pytest.approx(
        K * math.hypot(1, LOSS), rel=1e-6
    )


def test_numbers_are_short_and_lose_nothing_that_was_measured():
    assert number(0.1) == "0.1"
    assert number(100.0) == "100"
    assert real_number(100.0) == "100.0"
    assert real_number(1e-20) == "1.0e-20"
    assert float(number(np.pi)) == 3.14159265358979


def test_remarks_have_no_sign_that_a_grammar_knows():
    told = one_line('30 % of "RBS" # \u00e9 --- a|b {c}\n * /* x */')
    assert not set(told) & set('%"#|{}*\n')
    assert "---" not in told
    assert told.isascii()
    # with one hyphen it is no option of the command
    assert one_line("state --wet-linear-density") == "state --wet-linear-density"


def test_a_header_tells_range_error_source_and_that_it_is_synthetic():
    one = line(is_synthetic=True, notes=("a gap from strain 0.4 to 0.6",))
    text = " ".join(header_lines(one, thin_curve(one.strain, one.tension, most=30), "kN"))
    for part in (
        "SYNTHETIC", "mean of both branches", "tested from strain 0.1 to 1.4", "30 points of 400",
        "greatest error", "WHOI-2005-10, Table 5", "a gap from strain", "Remark: kN",
    ):  # fmt: skip
        assert part in text


def test_a_prediction_was_not_tested():
    one = line(tested=(np.nan, np.nan))
    assert "nothing was tested" in " ".join(
        header_lines(one, thin_curve(one.strain, one.tension, most=30))
    )


def test_a_line_of_a_header_never_breaks_inside_an_option():
    said = "9" * 84  # "Note: " and this leave nine signs: room for "--wet-", not for the option
    lines = header_lines(line(notes=(f"{said} --wet-linear-density",)), None)
    assert any(text.split() == ["--wet-linear-density"] for text in lines)


def test_nominal_stress_stands_first_and_the_origin_is_there():
    stress, strain = abaqus(_abaqus_text(line()))
    np.testing.assert_allclose(stress * math.pi / 4 * 0.026**2, rubber(strain), rtol=1e-3)
    assert strain[0] == stress[0] == 0
    assert strain[-1] == 1.5


def test_a_label_begins_with_a_letter():
    assert "*MATERIAL, NAME=M_64_hose\n" in _abaqus_text(line(name="64-hose"))


@pytest.mark.parametrize("to", [to for to in FORMS if to != "raft"])
def test_what_is_said_of_a_curve_is_what_its_header_says(to, tmp_path):
    (words,) = closeness_of(line(), to, None)
    error = words.split("by at most ")[1].replace(" %", " percent")
    *_, path = export_line(line(), to, tmp_path / "x.dat")
    bare = " ".join(path.read_text().replace("*", " ").replace("/", " ").replace("#", " ").split())
    assert f"greatest error {error}" in bare


def test_a_step_that_a_smooth_function_cannot_follow_is_doubtful():
    one = line(
        strain=np.array([0.0, 0.5, 0.5 + 1e-7, 1.0]), tension=np.array([0.0, 10.0, 1e3, 1.1e3])
    )
    assert closeness_of(one, "whoi-cable", None)[0].startswith("DOUBTFUL")
    assert "at most 0 N" in closeness_of(one, "whoi-cable", "table")[0]


def test_where_no_curve_is_thinned_nothing_is_said():
    told = {(to, form) for to, forms in FORMS.items() for form in forms}
    silent = {one for one in told if closeness_of(line(viscoelasticity=constant()), *one) == ()}
    dynamic = {"static-dynamic", "load-dependent", "syrope"}
    assert silent == {("moorpy", "library")} | {
        (to, form) for to in ("moordyn", "openfast") for form in dynamic if form in FORMS[to]
    }
    tables = [to for to in FORMATS if closeness_of(line(), to, None) == ()]
    # a line of RAFT is a straight one
    assert tables == [to for to in FORMATS if to not in FORMS or to == "raft"]


@pytest.mark.parametrize(
    ("to", "form"),
    [("moordyn", "static-dynamic"), ("openfast", "static-dynamic"), ("moorpy", "library")],
)
def test_a_line_of_one_stiffness_says_how_it_gets_its_mean_tension(to, form, tmp_path):
    """T = a e + b e^2 has 20 kN at 1/30, and the tangent there, 800 kN, at 1/40.

    With the length, and the stiffness, f times as large the spring is at rest where the tangent
    meets zero: L f (1 + T / (f K_0)) = L (1 + 1/30), so that f = 1 + 1/30 - 1/40.
    """
    strain = np.linspace(0.0, 0.06, 601)
    rope = line(
        strain=strain,
        tension=400e3 * strain + 6e6 * strain**2,
        viscoelasticity=constant(
            static_stiffness=800e3, dynamic_stiffness=1500e3, mean_tension=20e3
        ),
        rated_break_strength=100e3,
    )
    (said,) = closeness_of(rope, to, form)
    *_, path = export_line(rope, to, tmp_path / "x.dat", form=form)
    bare = " ".join(path.read_text().replace("#", " ").split())
    assert said in bare
    share = float(re.search(r"BA by ([\d.]+) and divide", said)[1])
    assert share == pytest.approx(1 + 1 / 30 - 1 / 40, abs=5e-6)
    assert "33 percent above the mean" in said


def test_a_line_that_is_straight_from_zero_has_nothing_to_correct():
    strain = np.linspace(0.0, 0.06, 61)
    straight = line(
        strain=strain,
        tension=2e4 * strain,
        viscoelasticity=constant(mean_tension=800.0),
    )
    (said,) = closeness_of(straight, "moordyn", "static-dynamic")
    assert "Multiply" not in said


KEYS = {
    "Name", "Category", "OD", "ID", "MassPerUnitLength", "EIx", "EIy", "EA", "GJ", "PoissonRatio",
    "Cd", "Ca", "NormalDragLiftDiameter", "AxialDragLiftDiameter",
}  # fmt: skip


def test_the_line_type_is_in_kilonewton_and_tonnes():
    text = _orcaflex_text(line())
    found, strain, tension = orcaflex(text)
    assert set(found) == KEYS
    assert found["MassPerUnitLength"] == 0.0006
    assert found["Cd"] == [1.2, None, 0.0]
    np.testing.assert_allclose(tension, rubber(strain), atol=1e-6 * rubber(1.5))
    assert strain.size == 100
    assert "syntax checked only" in text


def test_every_number_is_a_number_of_yaml():
    found, *_ = orcaflex(_orcaflex_text(line(diameter=1e-7, linear_density=1e12)))
    assert isinstance(found["OD"], float)
    assert isinstance(found["MassPerUnitLength"], float)


@pytest.mark.parametrize("name", ["12.5", "1", "no", "null", "1e3"])
def test_a_name_that_yaml_takes_for_something_else_stays_text(name):
    found = yaml.safe_load(_orcaflex_text(line(name=name)))
    (kind,) = found["LineTypes"]
    assert kind["Name"] == line(name=name).identifier
    (stiffness,) = found["VariableData"]["Axialstiffness"]
    assert kind["EA"] == stiffness["Name"]


def value(curve, strain):
    piece = np.clip(np.searchsorted(curve.start, strain, "right") - 1, 0, None)
    over = strain - curve.start[piece]
    return sum(curve.coefficient[piece, power] * over**power for power in range(4))


def test_a_cubic_comes_back():
    one = line()
    found = _fit_smooth_curve(one.strain, one.tension)
    grid = np.linspace(0, 1.5, 501)
    np.testing.assert_allclose(value(found, grid), rubber(grid), atol=2e-5 * rubber(1.5))
    assert found.share < 1e-5


def test_it_is_smooth_and_rises_where_the_data_are_level():
    strain = np.linspace(0, 1, 101)
    found = _fit_smooth_curve(strain, np.where(strain > 0.6, 100 * (strain - 0.6), 0.0))
    width = np.diff(np.append(found.start, found.end))[:-1]
    tension, slope, bend, third = found.coefficient[:-1].T
    ends = [
        tension + width * (slope + width * (bend + width * third)),
        slope + width * (2 * bend + 3 * width * third),
        2 * bend + 6 * width * third,
    ]
    starts = found.coefficient[1:, :3].T * np.array([[1], [1], [2]])
    for end, start in zip(ends, starts, strict=True):
        np.testing.assert_allclose(end, start, atol=1e-9 * np.abs(starts).max())
    grid = np.linspace(0, 1, 5001)
    assert np.all(np.diff(value(found, grid)) > 0)


def test_the_error_is_the_greatest_anywhere():
    found = _fit_smooth_curve(np.array([0.5, 1.0]), np.array([0.0, 1.0]))
    grid = np.linspace(0, 1, 20001)
    off = np.abs(value(found, grid) - np.interp(grid, [0, 0.5, 1], [0, 0, 1]))
    assert off.max() <= found.error + 2e-6
    assert off.max() == pytest.approx(found.error, rel=0.01)
    assert found.share < 0.003


def test_the_three_expressions_are_the_curve_and_its_derivatives():
    name, material = cable_material(_whoicable_text(line()))
    assert name == "new_tether"
    assert material["type"] == "nonlinear"
    grid = np.linspace(0.01, 1.45, 50)
    top = rubber(1.5)
    np.testing.assert_allclose(CableExpression(material["T"])(grid), rubber(grid), atol=1e-5 * top)
    slope = 900 * (1 - 0.9 * grid + 0.48 * grid**2)
    np.testing.assert_allclose(CableExpression(material["Te"])(grid), slope, rtol=1e-3)
    bend = 900 * (-0.9 + 0.96 * grid)
    np.testing.assert_allclose(CableExpression(material["Tee"])(grid), bend, atol=20)


@pytest.mark.parametrize(
    "name", ["polyester-double-braid-0.5in-new", "nylon-8-strand-plaited-0.5in-new", "tethers"]
)
def test_a_curve_rises_everywhere_and_goes_on_straight_beyond_both_ends(name):
    """Cable finds an equilibrium wherever the expression has the tension."""
    if name == "tethers":
        source = published_piece_sources()["rubber-tether-used"]
        one = line_from_composite(
            source, compose(source, CompositeRule()), diameter=0.06, linear_density=2.0
        )
    else:
        one = line_from_lookup(published_sources()[name], linear_density=0.11)
    _, material = cable_material(_whoicable_text(one))
    end = float(one.strain[-1])
    grid = np.linspace(-0.3, 3.0, 3301) * end
    tension = CableExpression(material["T"])(grid)
    assert (np.diff(tension) > 0).all()
    inside = (grid >= 0) & (grid <= end)
    wanted = np.interp(grid[inside], [0, *one.strain], [0, *one.tension])
    np.testing.assert_allclose(tension[inside], wanted, atol=0.02 * wanted[-1])
    # what is promised beyond: on with the slope of the last fiftieth
    near = np.interp(0.98 * end, [0, *one.strain], [0, *one.tension])
    last = (one.tension[-1] - near) / (0.02 * end)
    for beyond, at_edge in (
        (grid > end * (1 + 1e-9), last),
        (grid < 0, CableExpression(material["Te"])(0.0)[0]),
    ):
        slope = np.diff(tension[beyond]) / np.diff(grid[beyond])
        np.testing.assert_allclose(slope, at_edge, rtol=1e-6)
        np.testing.assert_allclose(
            CableExpression(material["Te"])(grid[beyond]), at_edge, rtol=1e-6
        )
        assert not CableExpression(material["Tee"])(grid[beyond]).any()


def test_strain_under_a_tension_is_kept_by_a_curve_of_many_bends():
    """Windows that join in bends, as those of a composite, and a last bend within a fiftieth."""
    slopes = np.array([500, 260, 520, 300, 700, 350, 900, 420, 1100, 500, 1500, 2600.0])
    nodes = np.concatenate([np.linspace(0, 2.6, slopes.size), [2.63]])
    load = np.concatenate([[0], np.cumsum(slopes * np.diff(nodes))])
    strain = np.union1d(np.linspace(0, nodes[-1], 400), nodes)
    one = line(strain=strain, tension=np.interp(strain, nodes, load))
    _, material = cable_material(_whoicable_text(one))
    end = nodes[-1]
    last = (load[-1] - np.interp(0.98 * end, nodes, load)) / (0.02 * end)
    fine = np.linspace(0, 1.6 * end, 20001)
    written = CableExpression(material["T"])(fine)
    wanted = np.array([0.05, 0.2, 0.5, 0.8, 1.0, 1.2]) * load[-1]
    known = np.interp(wanted, load, nodes) + np.maximum(wanted - load[-1], 0) / last
    np.testing.assert_allclose(np.interp(wanted, written, fine), known, rtol=0.01)


def test_a_straight_line_has_no_constant_derivative():
    one = line(strain=np.array([0.0, 0.5]), tension=np.array([0.0, 100.0]))
    _, material = cable_material(_whoicable_text(one))
    for name in ("Te", "Tee"):
        assert "e" in re.sub(r"\de[+-]?\d", "", material[name])
    assert CableExpression(material["Te"])(0.3) == pytest.approx(200)
    assert CableExpression(material["Tee"])(0.3) == pytest.approx(0, abs=1e-6)


def test_every_number_has_a_point_since_others_are_integers_of_32_bits():
    one = line(strain=np.array([0.0, 0.5]), tension=np.array([0.0, 5e9]))
    _, material = cable_material(_whoicable_text(one))
    for name, text in material.items():
        if name not in ("type", "comment"):
            numbers = re.findall(r"(?<![\w.])\d[\d.]*(?:e[+-]?\d+)?", text)
            assert all("." in number for number in numbers), name
    assert material["EA"] == "10000000000.0"


def test_a_table_stands_beside_the_slopes():
    _, material = cable_material(_whoicable_text(line(), form="table"))
    strain, tension = cable_pairs(material["T"])
    np.testing.assert_allclose(tension[:-1], rubber(strain[:-1]), atol=1e-6 * rubber(1.5))
    assert strain.size == 101
    # Cable goes on with the last step of a table: it is that of the last fiftieth of the curve
    slope = (rubber(1.5) - rubber(0.98 * 1.5)) / (0.02 * 1.5)
    assert tension[-1] == pytest.approx(rubber(1.5) + slope * (strain[-1] - 1.5), rel=1e-4)
    assert {"Te", "Tee", "EA"} <= set(material)


def test_weight_in_water_is_newton_a_metre():
    _, material = cable_material(_whoicable_text(line(rated_break_strength=3e3)))
    volume = math.pi / 4 * 0.026**2
    assert float(material["wet"]) == pytest.approx((0.6 - SEA_WATER * volume) * 9.80665)
    assert material["yield"] == "3000.0"


REFUSED = {
    "a line without diameter has no stress": (
        lambda: _abaqus_text(line(diameter=math.nan)),
        SettingsError,
        "diameter",
    ),
    "a line without mass is refused": (
        lambda: _orcaflex_text(line(linear_density=math.nan)),
        SettingsError,
        "linear density",
    ),
    "a loop is refused": (
        lambda: _fit_smooth_curve(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 0.2])),
        DataError,
        "a loop cannot be exported",
    ),
    "a line without mass is refused in whoi cable": (
        lambda: _whoicable_text(line(linear_density=math.nan)),
        SettingsError,
        "linear density",
    ),
}


test_refusals = refusals(REFUSED)
