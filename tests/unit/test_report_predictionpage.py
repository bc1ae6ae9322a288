"""Pages of a wave load and of an armour: figures, tables, notes, the page itself."""

import json
from functools import partial

import numpy as np
import plotly.graph_objects as go
import pytest
from predicted_cases import ARMOUR, LEAST_ARMOUR, WAVE, changed, predicted_armour, predicted_wave
from reportparts import numbers, traces

from reduction.report.figures.theory_figures import (
    draw_errors,
    draw_section,
    draw_surface,
    draw_wave_load,
    draw_wire,
)
from reduction.report.page_template import about_page
from reduction.report.single_pages import (
    anchor_table,
    armour_design_table,
    cable_table,
    extremes_table,
    layers_table,
    regime_table,
    use_table,
    wave_coefficient_table,
    wave_table,
    wires_table,
    write_armour_page,
    write_wave_page,
)
from reduction.report.text_style import NOT_GIVEN, Shown, with_prefix

NASTY = "</script><script>alert(1)</script> & <b>"
POUND, FOOT = 4.4482216152605, 0.3048


@pytest.fixture
def wave(tmp_path):
    return partial(predicted_wave, tmp_path / "w.toml", WAVE)


@pytest.fixture
def armour(tmp_path):
    def predicted(text=ARMOUR):
        return predicted_armour(tmp_path / "a.toml", text)

    return predicted


def shown_of(table):
    """First cell of each row to the last."""
    return {row[0].text: row[-1] for row in table.rows}


def test_loads_are_drawn_over_time_with_their_drag(wave):
    found = wave()
    for figure, name in zip(draw_wave_load(found, "si"), ("horizontal", "vertical"), strict=True):
        lines = traces(figure)
        np.testing.assert_allclose(
            numbers(lines["improved: the part under water"]["y"]),
            getattr(found.load, name), rtol=1e-5,
        )  # fmt: skip
        classic = numbers(lines["classic: the whole section"]["y"])
        np.testing.assert_allclose(classic, getattr(found.load, f"{name}_classic"), rtol=1e-5)
        assert figure.layout["yaxis"]["title"]["text"] == f"{name} load [N/m]"
    # with no acceleration under the crest all is drag
    across = traces(draw_wave_load(found, "si")[0])
    assert (
        across["drag of the improved"]["y"][0] == across["improved: the part under water"]["y"][0]
    )


def test_extremes_are_marked_in_every_period_that_is_drawn(wave):
    marks = [trace for trace in draw_wave_load(wave(), "si")[0].data if trace["mode"] == "markers"]
    assert len(marks) == 2
    time, load = numbers(marks[0]["x"]), numbers(marks[0]["y"])
    assert time.size == 4
    # maxima, then minima, a period apart
    np.testing.assert_allclose(np.diff(time)[[0, 2]], 3.57, rtol=1e-5)
    assert load[0] == load[1] > 0 > load[2] == load[3]


def test_a_long_series_is_thinned_and_keeps_its_greatest_load(wave):
    found = wave(time=np.linspace(0, 3570.0, 1_000_001))
    lines = traces(draw_wave_load(found, "si")[0])
    own = numbers(lines["improved: the part under water"]["y"])
    assert own.size <= 2000
    assert own.max() == pytest.approx(found.load.horizontal.max(), rel=1e-5)


def test_loads_in_us_units_are_pounds_a_foot(wave):
    si, us = (
        numbers(traces(draw_wave_load(wave(), units)[0])["classic: the whole section"]["y"])
        for units in ("si", "us")
    )
    np.testing.assert_allclose(si / us, POUND / FOOT, rtol=1e-4)


def test_the_surface_is_half_the_height_above_and_below(wave):
    (figure,) = draw_surface(wave(), "si")
    surface = numbers(traces(figure)["surface"]["y"])
    assert (surface.max(), surface.min()) == pytest.approx((0.625, -0.625), abs=1e-3)
    assert surface[0] == pytest.approx(0.625)
    assert "theory of Airy" in figure.caption
    (second,) = draw_surface(wave(wave_theory="stokes"), "si")
    crest = numbers(traces(second)["surface"]["y"]).max()
    # k H2 / 16 (2 + cosh 2kd) cosh kd / sinh3 kd above Airy's, kd = 0.6 pi
    depth = 0.6 * np.pi
    above = 2 * np.pi / 20 * 1.25**2 / 16 * np.cosh(depth) * (2 + np.cosh(2 * depth))
    assert crest == pytest.approx(0.625 + above / np.sinh(depth) ** 3, rel=1e-5)


@pytest.mark.parametrize("density", [1250.0, 300.0])
def test_the_section_is_a_circle_cut_by_the_waterline(wave, density):
    """The area that is filled is what the weight displaces."""
    (figure,) = draw_section(wave(wall_density=density, content_density=0.0), "si")
    lines = traces(figure)
    x, y = (numbers(lines["hose"][one]) for one in "xy")
    centre = (y.max() + y.min()) / 2
    np.testing.assert_allclose(np.hypot(x, y - centre), 57.0, rtol=1e-4)
    x, y = (numbers(lines["under water"][one]) for one in "xy")
    area = abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2
    wall = np.pi / 4 * (114**2 - 102**2)
    assert area == pytest.approx(density * wall / 1025, rel=2e-2)
    assert y.max() == 0
    assert figure.layout["yaxis"]["scaleanchor"] == "x"


def test_the_extremes_are_a_table_with_the_difference(wave):
    found = wave()
    table = extremes_table(found, "si")
    assert [row[0].text for row in table.rows] == [
        "horizontal, maximum", "horizontal, minimum", "vertical, maximum", "vertical, minimum",
    ]  # fmt: skip
    assert float(table.rows[0][1].value) == float(found.extremes.horizontal.maximum)
    own, classic = (float(table.rows[0][k].value) for k in (1, 3))
    assert float(table.rows[0][5].value) == pytest.approx(1 - own / classic)
    assert table.columns[1] == "improved [N/m]"
    assert extremes_table(found, "us").columns[1] == "improved [lbf/ft]"


def test_the_wave_is_described_with_what_it_was_computed_by(wave):
    table = wave_table(wave(), "si")
    values = {name: float(cell.value) for name, cell in shown_of(table).items()}
    # Zhang (2015), Table 4: 1.25 m, 20 m, 6 m deep
    assert values["height [m]"] == pytest.approx(1.25)
    assert values["period [s]"] == pytest.approx(3.57)
    assert values["depth over length"] == pytest.approx(0.3)
    assert values["height over length"] == pytest.approx(0.0625)
    assert values["Ursell number"] == pytest.approx(1.25 * 20**2 / 6**3)
    assert "Computed by the theory of Airy" in table.remarks[0]
    assert "Stokes, second order" in wave_table(wave(wave_theory="stokes"), "si").remarks[0]


def test_the_flow_is_told_by_its_numbers(wave):
    found = wave()
    values = {name: float(cell.value) for name, cell in shown_of(regime_table(found, "si")).items()}
    speed = values["maximum velocity of the water [m/s]"]
    assert values["Keulegan-Carpenter number"] == pytest.approx(speed * 3.57 / 0.114)
    assert values["Reynolds number"] == pytest.approx(speed * 0.114 / 1.1892e-6)
    assert values["outer diameter [mm]"] == pytest.approx(0.114)
    assert "[ft/s]" in [*shown_of(regime_table(found, "us"))][5]


def test_the_anchor_force_is_sum_and_combination(wave):
    table = anchor_table(wave(), "si")
    values = {name: float(cell.value) for name, cell in shown_of(table).items()}
    parts = ("wind alone [N]", "current alone [N]", "wave alone, maximum [N]")
    assert sum(values[name] for name in parts) == pytest.approx(values["sum of the three [N]"])
    assert (
        values["wave and current as one flow, with the wind [N]"] > values["sum of the three [N]"]
    )
    assert "100 m of hose" in table.caption
    assert "Wind 10 m/s at the hose, current 0.5 m/s" in table.remarks[0]


def test_published_coefficients_stand_beside_those_of_this_case(wave):
    """Zhang (2015), Table 2 and eq. (12)."""
    table = wave_coefficient_table(wave(drag_coefficient=0.9))
    printed = [
        ("Wiegel et al. (1957)", "1", 0.95), ("Agerschou and Edens (1965)", "1 to 1.4", 2.0),
        ("Keulegan and Carpenter (1958)", "1.34", 1.6),
        ("Agerschou and Edens (1965)", "0.8 to 1", 2.0),
        ("Code of Hydrology for Sea Harbour (1998)", "1.2", 2.0),
    ]  # fmt: skip
    found = [(row[0].text, row[2].text, float(row[3].value)) for row in table.rows[:-1]]
    assert found == printed
    own = table.rows[-1]
    assert (own[0].text, own[1].text, own[2].text) == ("this case", "Airy", "0.900")
    assert own[4].text.startswith("KC ") and ", Re " in own[4].text


def test_forces_of_one_wire_are_drawn_by_every_theory(armour):
    figures = draw_wire(armour(), "si")
    names = ["axial force", "shear force", "bending moment", "torsion moment"]
    assert [figure.layout["yaxis"]["title"]["text"] for figure in figures] == [
        f"{name} [{unit}]" for name, unit in zip(names, ("N", "N", "N m", "N m"), strict=True)
    ]
    lines = traces(figures[0])
    assert {*lines} == {
        "exact", "with an energy", "small angles", "intermediate angles", "large angles, a spring",
    }  # fmt: skip
    angle = np.radians(numbers(lines["exact"]["x"]))
    assert (angle[0], angle[-1]) == pytest.approx((np.radians(5), np.radians(85)))
    # Wang (2022): E A times strain times the squared cosine
    force = 210e9 * np.pi * 2.5e-3**2 * 1e-3 * np.cos(angle) ** 2
    np.testing.assert_allclose(numbers(lines["small angles"]["y"]), force, rtol=1e-4)
    np.testing.assert_allclose(numbers(lines["exact"]["y"]), force, rtol=1e-3)


def test_the_spring_does_not_take_the_height_from_the_others(armour):
    axial, shear, bending, torsion = draw_wire(armour(), "si")
    assert "The spring leaves the figure" not in axial.caption
    for figure in (shear, bending, torsion):
        assert "The spring leaves the figure" in figure.caption
    exact = numbers(traces(bending)["exact"]["y"])
    low, high = bending.layout["yaxis"]["range"]
    assert low < exact.min() < exact.max() < high < 0.2
    assert "[lbf ft]" in draw_wire(armour(), "us")[2].layout["yaxis"]["title"]["text"]


def test_the_layers_own_angle_is_marked(armour):
    for figure in (*draw_wire(armour(), "si"), *draw_errors(armour())):
        (mark,) = figure.layout["shapes"]
        assert mark["x0"] == mark["x1"] == pytest.approx(20)
        (label,) = figure.layout["annotations"]
        assert label["text"] == "inner, 20 deg"


def test_errors_are_drawn_on_decades_and_heavy_where_a_theory_holds(armour):
    found = armour(changed(ARMOUR, "[armour]", '[armour]\ntolerance = "0.01 %"'))
    axial, *_, torsion = draw_errors(found)
    assert axial.layout["yaxis"]["type"] == "log"
    low, high = axial.layout["yaxis"]["range"]
    assert -3 <= low < high <= 3
    lines = traces(axial)
    size = numbers(lines["intermediate angles"]["y"])
    heavy = numbers(lines["intermediate angles, holds"]["y"])
    np.testing.assert_array_equal(np.isfinite(heavy), size <= 0.01)
    assert lines["tolerance, 0.01 %"]["y"] == [0.01, 0.01]
    # a spring has G J / (E A r2 sin) of the axial force: 1.8 % at 5 degrees, 0.16 % at 85
    angle = np.radians(numbers(lines["large angles, a spring"]["x"]))
    share = (2.5 / 27.5) ** 2 / (4 * 1.3 * np.sin(angle))
    miss = numbers(lines["large angles, a spring"]["y"])
    np.testing.assert_allclose(miss, 100 * (1 - share), atol=2e-3)
    assert "Relative to the torsion moment of the whole change" in torsion.caption


def test_a_cable_at_rest_has_a_page_all_the_same(armour, tmp_path):
    found = armour(changed(ARMOUR, '"0.1 %"', "0.0"))
    for figure in (*draw_wire(found, "si"), *draw_errors(found)):
        go.Figure(json.loads(figure.json()))
    assert write_armour_page(found, tmp_path, name="rest").is_file()


def test_wires_are_rows_by_layer_and_theory(armour):
    table = wires_table(armour(), "si")
    assert [row[0].text for row in table.rows[:2]] == [
        "inner, small angles", "inner, intermediate angles",
    ]  # fmt: skip
    assert len(table.rows) == 10
    place = table.columns.index("axial stress [MPa]")
    # Wang (2022), sec. 4
    assert float(table.rows[0][place].value) == pytest.approx(185.43e6, abs=0.5e4)
    assert table.rows[0][place].text == "185.4"


def test_layers_have_a_limit_only_where_one_is_stated(armour):
    found = armour(changed(ARMOUR, 'yield_stress = "700 MPa"\n', ""))
    table = layers_table(found, "si")
    place = table.columns.index("yields")
    assert [row[place].text for row in table.rows] == [NOT_GIVEN, "no"]
    assert [row[place - 1].text for row in table.rows] == [NOT_GIVEN, "700.0"]
    yielding = layers_table(armour(changed(ARMOUR, '"0.1 %"', '"0.5 %"')), "si")
    assert [row[place].text for row in yielding.rows] == ["yes", "yes"]


def test_the_cable_says_which_layer_yields_first_or_why_none_does(armour):
    table = cable_table(armour(), "si")
    assert "Layer inner yields first." in table.remarks
    assert "strain at first yield [%]" in shown_of(table)
    bare = cable_table(armour(LEAST_ARMOUR), "si")
    assert "strain at first yield [%]" not in shown_of(bare)
    assert "not every layer has a yield stress" in bare.remarks[-1]


def test_where_theories_hold_is_a_range_an_angle_or_nowhere(armour):
    table = use_table(armour())
    rows = {row[0].text: [cell.text for cell in row[1:]] for row in table.rows}
    assert rows["inner, small angles"] == ["5.0 to 85.0"] * 4
    # the spring has 1.8 % of the axial force at most
    assert rows["inner, large angles, a spring"][0] == "nowhere"
    use = armour().use[0]
    alone = use.least_angle[2, 2]
    assert alone == use.greatest_angle[2, 2]
    assert rows["inner, large angles, a spring"][2] == f"{np.degrees(alone):.1f}"


def test_what_was_given_of_the_layers_comes_back(armour):
    rows = [[cell.text for cell in row] for row in armour_design_table(armour(), "si").rows]
    assert rows == [
        ["inner", "20.00", "2.500", "25.00", "210,000", "0.3000", "30", "right"],
        ["outer", "20.00", "2.500", "30.00", "210,000", "0.3000", "36", "left"],
    ]


def test_plotly_takes_every_figure_and_every_axis_has_its_unit(wave, armour):
    figures = [
        *draw_wave_load(wave(), "si"), *draw_surface(wave(), "si"), *draw_section(wave(), "si"),
        *draw_wire(armour(), "si"), *draw_errors(armour()),
    ]  # fmt: skip
    for figure in figures:
        go.Figure(json.loads(figure.json()))
        assert figure.has_data and not figure.synthetic
        for name in ("xaxis", "yaxis"):
            assert "[" in figure.layout[name]["title"]["text"]
    assert len({figure.key for figure in figures}) == len(figures)


def test_the_page_of_a_wave_load_stands_alone(wave, tmp_path):
    path = write_wave_page(wave(), tmp_path / "out", name=NASTY)
    assert path == tmp_path / "out" / "index.html"
    page = path.read_text(encoding="utf-8")
    assert "alert(1)</script>" not in page and "Wave load &lt;/script&gt;" in page
    assert page.count("data-figure=") == 4
    assert page.index("Extremes of the load over a period") < page.index('id="wrong"')
    # the page ranks what it says as the terminal does
    assert ">Warnings<" in page and "does not hold for this wave" in page
    assert page.index(">Notes<") < page.index("The stated wave length differs by")
    assert "Where these numbers come from" not in page
    assert "from the numbers of its SPEC.toml alone." in page
    assert "SYNTHETIC" not in page and "https://" not in page.partition("<body>")[2][:5000]


def test_the_page_of_an_armour_stands_alone(armour, tmp_path):
    page = write_armour_page(armour(), tmp_path / "out", name="cable", units="us").read_text(
        "utf-8"
    )
    assert page.count("data-figure=") == 8
    assert "Units: US customary. Notes are in SI." in page
    assert ">Notes<" in page and "The layers do not balance" in page
    for heading in ("The cable and its layers", "One wire", "Where each theory holds"):
        assert f"<h3>{heading}</h3>" in page
    single = write_armour_page(armour(LEAST_ARMOUR), tmp_path / "one", name="one").read_text(
        "utf-8"
    )
    assert "</strong> layer</a>" in single and "at first yield" not in single


def test_what_a_page_is_made_from_is_said_in_sentences():
    si = about_page("si", "archives", in_si="Notes are in SI.", institution="A lab.")
    assert si[:2] == ["Units: SI.", "Laboratory: A lab."]
    assert si[2].startswith("Made by mooring-reduction ") and si[2].endswith(" from archives.")
    us = about_page("us", "archives", in_si="Notes are in SI.", references="R", definitions=["D."])
    assert us[:3] == ["Units: US customary.", "Notes are in SI.", "Reference: R."]
    assert us[-1] == "D."


@pytest.mark.parametrize(("name", "title"), [("armour", "Armour"), ("cable 7", "Armour cable 7")])
def test_a_name_that_says_the_kind_again_is_left_out(tmp_path, armour, name, title):
    page = write_armour_page(armour(), tmp_path / "out", name=name).read_text(encoding="utf-8")
    assert f"<h1>{title}</h1>" in page


@pytest.mark.parametrize(
    ("unit", "size", "shown"),
    [
        ("N", 217_559.0, Shown("kN", 1e-3)),
        ("N", -2.2e8, Shown("MN", 1e-6)),
        ("N", 9999.0, Shown("N", 1.0)),
        ("lbf", 2.2e8, Shown("lbf", 1.0)),
        ("MPa", 2.2e8, Shown("MPa", 1.0)),
    ],
)
def test_a_large_number_has_a_prefix(unit, size, shown):
    assert with_prefix(Shown(unit, 1.0), size) == shown
