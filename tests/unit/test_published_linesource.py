"""Published lines as they are looked up, against numbers typed from the tables."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csvrows import csv_rows

from reduction.lines.composite import CompositeRule, compose
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_piece_sources, published_sources
from reduction.record.errors import DataError, SettingsError

LBF = 4.4482216152605


@pytest.fixture(scope="module")
def lines():
    return published_sources()


def centre(line):
    surface = next(iter(line.surfaces.values()))
    middle = (surface.low + surface.high) / 2
    return dict(zip(line.factor_names, middle, strict=True))


@pytest.mark.parametrize(
    ("name", "quantity", "printed"),
    [
        # B1 of Tables 3, 4, 12, 13, 16, 18 of CG-D-39-80: 1e4 lb, lb in/in, 1e4 lb, s
        ("polyester-double-braid-0.5in-new", "apparent_spring_constant", 9.457e4 * LBF),
        ("nylon-double-braid-0.5in-new", "apparent_spring_constant", 3.451e4 * LBF),
        ("nylon-double-braid-1.25in-new", "apparent_spring_constant", 19.790e4 * LBF),
        # Table 13: Table 11 prints the column of K_1 in its place
        ("polyester-double-braid-0.5in-new", "hysteresis_energy", 1.20 * LBF),
        ("nylon-double-braid-0.75in-new", "hysteresis_energy", 8.23 * LBF),
        ("polyester-double-braid-0.5in-new", "dissipation_spring_constant", 3.593e4 * LBF),
        ("nylon-8-strand-plaited-0.5in-new", "relaxation_time", 2.057),
    ],
)
def test_the_centre_of_a_surface_is_its_printed_mean(lines, name, quantity, printed):
    line = lines[name]
    assert look_up(line, quantity, **centre(line)).value == pytest.approx(printed, rel=1e-9)


@pytest.mark.parametrize(
    ("diameter", "frequency", "read", "step"),
    # Figure 4 as read in the text, 1e4 lb; the lines of 3/4 and 1 in stand in each other's place
    [("0.75", 0.3, 11.9, 0.5), ("1", 0.3, 11.4, 0.5), ("1.25", 0.1, 17.5, 0.25)],
)
def test_figure_4_comes_back(lines, diameter, frequency, read, step):
    line = lines[f"nylon-double-braid-{diameter}in-new"]
    at = {"frequency": frequency, "mean_tension": 4000 * LBF, "tension_amplitude": 1600 * LBF}
    if diameter != "0.75":
        with pytest.raises(DataError, match="outside the tested range"):
            look_up(line, "apparent_spring_constant", **at)
    found = look_up(line, "apparent_spring_constant", extrapolate="flag", **at)
    assert found.value / LBF / 1e4 == pytest.approx(read, abs=step)
    assert found.is_inside == (diameter == "0.75")


def test_an_open_coefficient_widens_the_interval_over_both_prints(lines):
    line = lines["polyester-8-strand-plaited-0.5in-new"]
    # B4, of the square of the amplitude: -.188 (Table 3) or -.118 (Table 5), in 1e4 lb
    surface = line.surfaces["apparent_spring_constant"]
    face = centre(line) | {"tension_amplitude": surface.high[2]}
    found = look_up(line, "apparent_spring_constant", **face)
    middle = (found.surface_low + found.surface_high) / 2
    # B1 + B4 + B7 with either; the half width differs by the sigma of either
    assert middle - found.value == pytest.approx(0.5 * 0.070e4 * LBF, rel=0.1)
    assert any("ambiguous: B4 of apparent_spring_constant: " in note for note in found.notes)


def test_a_mean_that_is_open_is_not_given(lines):
    line = lines["polyester-8-strand-plaited-0.5in-4-years"]
    with pytest.raises(SettingsError, match="its mean B1 is open"):
        look_up(line, "hysteresis_energy", **centre(line))


def test_damping_is_the_product_of_its_two_surfaces(lines):
    # B1 of polyester double braid: K_1 3.593e4 lb (Table 16), tau 1.488 s (Table 17)
    line = lines["polyester-double-braid-0.5in-new"]
    found = look_up(line, "dashpot_coefficient", **centre(line))
    assert found.value == pytest.approx(3.593e4 * LBF * 1.488)
    assert found.unit == "N s"
    parts = [
        look_up(line, name, **centre(line))
        for name in ("dissipation_spring_constant", "relaxation_time")
    ]
    share = np.hypot(*[(one.high - one.value) / one.value for one in parts])
    assert (found.high - found.value) / found.value == pytest.approx(share)


def test_what_is_lost_is_told(lines):
    line = lines["nylon-double-braid-0.5in-5-years"]
    with pytest.raises(SettingsError, match="column of Table 15 is lost"):
        look_up(line, "dissipation_spring_constant", **centre(line))


def test_a_surface_that_fails_its_test_says_so(lines):
    line = lines["nylon-double-braid-0.5in-new"]
    found = look_up(line, "relaxation_time", **centre(line))
    assert any("fails its F test" in note for note in found.notes)


def test_the_scatter_is_that_of_r2(lines):
    # Table 3: r2 = .999; 5 of fifteen degrees of freedom; at the centre a third of the variance
    line = lines["nylon-double-braid-0.5in-new"]
    found = look_up(line, "apparent_spring_constant", **centre(line))
    # B5, B6, B7 at +-1 in 8 runs, B8, B9, B10 at +-1 in 4; the squares .000, -.031, .029 are small
    explained = 8 * (0.105**2 + 1.677**2 + 0.274**2) + 4 * (0.065**2 + 0.100**2 + 0.095**2)
    sigma = np.sqrt(explained * 0.001 / 0.999 / 5) * 1e4 * LBF
    half = float(found.surface_high - found.value)
    assert half == pytest.approx(2.570582 * sigma / np.sqrt(3), rel=1e-3)


def test_k_0_of_a_line_without_a_row_is_the_slope_of_its_load_strain_curve(lines):
    # Table 8, nylon double braid 3/4 in; its K_0 row has no range
    line = lines["nylon-double-braid-0.75in-new"]
    tension = 4011 * LBF
    curve = next(one for one in line.curves if one.quantity == "strain")
    step = 1.0
    slope = np.polynomial.polynomial.polyval([tension - step, tension + step], curve.coefficient)
    found = look_up(line, "quasi_static_spring_constant", mean_tension=tension)
    assert found.value == pytest.approx(2 * step / (slope[1] - slope[0]), rel=1e-6)
    assert any("slope of load against strain" in note for note in found.notes)


def test_moduli_of_tethers_are_those_of_table_6(lines):
    # T-2 of the new tether: 128 psi from 0.60 to 1.20
    found = look_up(
        lines["rubber-tether-new-T-2"], "tangent_modulus", strain=[0.6, 0.9, 1.19],
        branch="ascending",
    )  # fmt: skip
    assert found.value == pytest.approx(np.full(3, 128 * 6894.757293168), rel=1e-9)
    with pytest.raises(SettingsError, match="differs by branch"):
        look_up(lines["rubber-tether-new-T-2"], "tangent_modulus", strain=1.0, branch="descending")


def test_every_line_gives_something_or_says_why_not(lines):
    for line in lines.values():
        assert line.quantities or line.absent
        for quantity in line.surfaces:  # those that follow from them are tested above
            found = look_up(line, quantity, **centre(line))
            assert np.isfinite(found.value)
            assert found.is_inside
            assert not found.is_untested


@pytest.mark.parametrize(
    ("name", "pounds"),
    # Table 10: breaks after exposure, lb
    [("nylon-double-braid-0.5in-5-years", 2783), ("polyester-double-braid-0.5in-5-years", 3241)],
)
def test_an_exposed_line_says_at_what_it_breaks(lines, name, pounds):
    line = lines[name]
    (told,) = [note for note in line.notes if "break at" in note]
    share = 100 * pounds * LBF / line.rated_break_strength
    assert f"{pounds * LBF:.0f} N (Table 10), {share:.0f} %" in told
    assert any("exposed specimens scatter by about 50 %" in note for note in line.notes)
    new = lines[name.replace("5-years", "new")]
    assert not any("break at" in note for note in new.notes)


def test_no_report_prints_a_linear_density(lines):
    for line in lines.values():
        assert np.isnan(line.linear_density)
        assert np.isnan(line.wet_linear_density)


def test_the_largest_line_has_the_strength_of_another_and_says_so(lines):
    line = lines["nylon-double-braid-1.25in-new"]
    # Table 1, footnote 3: 33,600 lb is of the 1 in line
    assert line.strength_of == "the 1 in line"
    assert any("its own is not printed" in note for note in line.notes)
    assert lines["nylon-double-braid-1in-new"].strength_of == ""
    assert line.rated_break_strength == lines["nylon-double-braid-1in-new"].rated_break_strength


@pytest.mark.parametrize(
    ("name", "pounds"),
    # Table 10; of polyester braid none of four years was broken
    [
        ("nylon-double-braid-0.5in-5-years", 2783),
        ("nylon-8-strand-plaited-0.5in-4-years", 3525),
        ("nylon-8-strand-plaited-0.5in-5-years", 4416),
        ("polyester-8-strand-plaited-0.5in-4-years", 5096),
        ("polyester-double-braid-0.5in-5-years", 3241),
        ("polyester-double-braid-0.5in-4-years", 3241),
    ],
)
def test_an_old_line_has_the_strength_of_table_10(lines, name, pounds):
    assert lines[name].tensile_strength == pytest.approx(pounds * LBF)
    assert np.isnan(lines[f"{name.rpartition('in-')[0]}in-new"].tensile_strength)


def test_a_level_of_the_design_in_percent_is_inside_though_pounds_are_printed(lines):
    # 12 % of 5,760 lb is 691.2 lb, printed 691
    line = lines["nylon-8-strand-plaited-0.5in-new"]
    found = look_up(
        line, "apparent_spring_constant", frequency=0.1, mean_tension=0.21 * 5760 * LBF,
        tension_amplitude=0.12 * 5760 * LBF,
    )  # fmt: skip
    assert found.is_inside
    assert not found.is_untested
    assert line.surfaces["apparent_spring_constant"].high[2] == pytest.approx(691 * LBF)


def test_open_levels_widen_the_intervals_and_old_lines_say_that_theirs_are_others(lines):
    # levels of polyester braid: shares of 6,400 lb (Table 3) or of 7,000 lb (Table 5)
    line = lines["polyester-double-braid-0.5in-new"]
    at = {"frequency": 0.3, "mean_tension": 1344 * LBF, "tension_amplitude": 544 * LBF}
    found = look_up(line, "hysteresis_energy", **at)
    alone = replace(line.surfaces["hysteresis_energy"], alternative_boxes=())
    one = look_up(replace(line, surfaces={"hysteresis_energy": alone}), "hysteresis_energy", **at)
    assert found.high - found.low > one.high - one.low
    assert any("the intervals span both" in note for note in found.notes)
    for age in ("4-years", "5-years"):
        told = lines[f"polyester-double-braid-0.5in-{age}"].notes
        assert any("one %RBS is two tensions" in note for note in told)
    assert not any("two tensions" in one for one in lines["nylon-double-braid-0.5in-5-years"].notes)


def test_what_the_report_gives_for_documentation_alone_says_so(lines):
    for age in (4, 5):
        line = lines[f"nylon-8-strand-plaited-0.5in-{age}-years"]
        found = look_up(line, "apparent_spring_constant", **centre(line))
        assert any("no inference is drawn from it" in note for note in found.notes)
        assert "the surface was fitted to 2 specimens" in found.notes
    new = lines["nylon-8-strand-plaited-0.5in-new"]
    notes = look_up(new, "apparent_spring_constant", **centre(new)).notes
    assert "the surface was fitted to 3 specimens" in notes
    assert not any("inference" in note for note in notes)


def test_a_remark_on_a_cell_says_that_it_is_one(lines):
    notes = {
        note
        for line in lines.values()
        if line.is_tether
        for one in line.curves
        for note in one.notes
    }
    assert "Table 6: 230- is printed where 230 is meant" in notes
    assert "230- is printed where 230 is meant" not in notes


# cubics end where they cannot be trusted: by the tables, typed here, and by their own slope

REST = "quasi_static_spring_constant"
FIFTH = 0.196  # 1.96 times a tenth: sec. 4.4.1, new lines
# Table 9, nylon double braid, 5 years: B, C, D of strain, 1/lb, 1/lb2, 1/lb3
OLD_NYLON = (2.014e-4, -5.148e-8, 3.259e-12)
# Tables 6 and 8, plaited nylon, new: K_0 in lb, strain
PLAIT_STRAIN = (1.694e-4, -3.943e-8, 3.02e-12)


def slope(tension, terms):
    b, c, d = terms
    return b + 2 * c * tension + 3 * d * tension**2


def curve(name, quantity):
    return next(one for one in published_sources()[name].curves if one.quantity == quantity)


def test_strain_ends_where_its_cubic_turns():
    found = curve("nylon-double-braid-0.5in-5-years", "strain")
    b, c, d = OLD_NYLON
    turn = (-2 * c - np.sqrt(4 * c**2 - 12 * d * b)) / (6 * d)
    assert turn == pytest.approx(2597, abs=1)
    # within a node of 2,700/8,000 lb
    assert found.high / LBF == pytest.approx(turn, abs=0.4)
    line = published_sources()["nylon-double-braid-0.5in-5-years"]
    with pytest.raises(DataError, match="falls under more load"):
        look_up(line, "strain", tension=2650 * LBF)
    flagged = look_up(line, "strain", tension=2650 * LBF, extrapolate="flag")
    assert not flagged.is_inside
    assert any("falls under more load" in note for note in flagged.notes)


def test_rest_stiffness_ends_before_the_slope_is_as_wrong_as_it_is_below_zero():
    found = curve("nylon-double-braid-0.5in-5-years", REST)
    wrong = -slope(2700, OLD_NYLON)
    end = found.high / LBF
    assert wrong == pytest.approx(FIFTH * slope(end, OLD_NYLON), rel=2e-3)
    line = published_sources()["nylon-double-braid-0.5in-5-years"]
    for pounds in (2400, 2500, 2590):
        with pytest.raises(DataError, match="may be wrong by more than 20 %"):
            look_up(line, REST, mean_tension=pounds * LBF)
    assert look_up(line, REST, mean_tension=2000 * LBF).value == pytest.approx(
        LBF / slope(2000, OLD_NYLON), rel=1e-9
    )


@pytest.mark.parametrize(
    "name", [one for one, line in published_sources().items() if not line.is_tether]
)
def test_inside_its_range_rest_stiffness_is_positive_and_strain_rises(name):
    for found in published_sources()[name].curves:
        at = np.linspace(found.low, found.high, 301)
        values = look_up(published_sources()[name], found.quantity, **{found.variable: at}).value
        if found.quantity == "strain":
            assert np.all(np.diff(values) > 0)
        else:
            assert np.all(values > 0)


def test_two_curves_of_one_line_agree_within_the_range():
    found = curve("nylon-8-strand-plaited-0.5in-new", REST)
    line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    at = np.linspace(found.low, found.high, 201)
    both = look_up(line, REST, mean_tension=at).value * slope(at / LBF, PLAIT_STRAIN) / LBF
    assert np.max(np.abs(both - 1)) <= FIFTH * 1.001
    assert both[0] == pytest.approx(1 - FIFTH, abs=1e-3)
    # 348 lb at 165 lb, where strain says 6,384 lb
    with pytest.raises(DataError, match="differs from the slope of the load-strain cubic"):
        look_up(line, REST, mean_tension=165 * LBF)
    flagged = look_up(line, REST, mean_tension=165 * LBF, extrapolate="flag")
    assert not flagged.is_inside
    assert flagged.value == pytest.approx(348 * LBF, rel=0.01)
    assert 1 / slope(165, PLAIT_STRAIN) == pytest.approx(6384, rel=0.01)


def test_a_line_of_four_years_is_held_against_the_strain_of_five():
    # one row of Table 7 for both; Table 9 has no strain of plaited nylon after four years
    four, five = (curve(f"nylon-8-strand-plaited-0.5in-{age}-years", REST) for age in (4, 5))
    assert (four.low, four.high) == (five.low, five.high)
    # Table 9, 5 years
    terms = (3.08e-4, -11.17e-8, 13.5e-12)
    line = published_sources()["nylon-8-strand-plaited-0.5in-4-years"]
    value = look_up(line, REST, mean_tension=four.low).value / LBF
    assert value * slope(four.low / LBF, terms) == pytest.approx(1 - FIFTH, abs=2e-3)


def test_what_is_open_is_not_said_to_be_replaced():
    with pytest.raises(SettingsError, match="whose slope would take its place, is ambiguous"):
        look_up(published_sources()["polyester-8-strand-plaited-0.5in-new"], REST, mean_tension=1e3)


# pieces of the published tethers against Table 6, typed a second time

TABLE = Path(__file__).parents[1] / "golden" / "whoi_2005_10_table_6.csv"
# open in Table 6: Table 5 stands in
OPEN = {("T-1", "new")}


def rows():
    return csv_rows(TABLE, comment="#")


@pytest.mark.parametrize("tether", ["new", "used"])
def test_loads_at_the_ends_of_the_segments_are_those_of_table_6(tether):
    pieces = {one.name: one for one in published_piece_sources()[f"rubber-tether-{tether}"].pieces}
    seen = 0
    for row in rows():
        if row["tether"] != tether or (row["test"], tether) in OPEN:
            continue
        one = pieces[row["test"]]
        for end in ("min", "max"):
            load = float(row[f"load_{end}"].rstrip("-"))  # a stray dash, WH5-10
            at = float(row[f"strain_{end}"])
            assert np.interp(at, one.strain, one.tension) / LBF == pytest.approx(load), row
            seen += 1
        assert one.random_standard_uncertainty / LBF == pytest.approx(
            np.full(one.strain.size, 0.288675), rel=1e-4
        )
    assert seen == {"new": 14, "used": 20}[tether]


@pytest.mark.parametrize(
    ("tether", "free", "ratio"), [("new", 8.38, 0.2386), ("used", 8.34, 0.2177)]
)
def test_splices_are_the_least_squares_of_table_3(tether, free, ratio):
    model = published_piece_sources()[f"rubber-tether-{tether}"].model
    assert model.coefficients["relaxed_free_length"] / 0.3048 == pytest.approx(free)
    assert model.coefficients["splice_strain_ratio"] == pytest.approx(ratio, abs=5e-5)


@pytest.mark.parametrize("tether", ["new", "used"])
def test_pieces_stand_in_the_order_of_the_tests_and_name_their_tables(tether):
    source = published_piece_sources()[f"rubber-tether-{tether}"]
    assert [one.name for one in source.pieces][:6] == [f"T-{number}" for number in range(1, 7)]
    assert all(one.kind == "cyclic" and one.branch == "ascending" for one in source.pieces)
    assert all("WHOI-2005-10, Table" in text for text in source.sources[:6])
    assert compose(source, CompositeRule()).strain[-1] == source.pieces[5].strain[-1]
