"""Predicted hoses on the page: figures, tables, sentences, and the page of them alone."""

import json
import re

import numpy as np
import plotly.graph_objects as go
import pytest
from pagefigures import figures_of as drawn_on
from predicted_hoses import (
    AT_WORK,
    INCH,
    POUND,
    dataset,
    pick_up_strain,
    plan,
    predicted,
    renamed,
    rubber_tension,
    stretch_at,
    working_tension,
)
from reportparts import traces

from reduction.archive.write import write_archive
from reduction.prediction.cord_curve import CordCurve
from reduction.quantities.flags import HOSE_STATES
from reduction.record.errors import ArchiveError
from reduction.report.campaign_page import write_report
from reduction.report.campaign_sections import _hose_findings, _hose_tiles, _make_hose_section
from reduction.report.figures.hose_figures import (
    draw_all_hoses,
    draw_budget,
    draw_chart,
    draw_limits,
    draw_pressure,
    draw_tension,
)
from reduction.report.prediction_tables import (
    _plus_minus_of_hoses,
    answer_of_hoses,
    cord_table,
    hose_curve_table,
    hose_design_table,
    hose_event_table,
    layer_table,
)
from reduction.report.product_views import HoseView
from reduction.report.text_style import NOT_GIVEN

NASTY = "</script><script>alert(1)</script> & <b>\u2028"
SHORT_CORD = CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0]))


def views(*hoses, units="si", **options):
    return HoseView.rows_of(dataset(*hoses, **options), units)


def view(*arguments, units="si", synthetic="", **options):
    (one,) = views(predicted(*arguments, **options), units=units, synthetic=synthetic)
    return one


def bare(**options):
    """A hose below the neutral angle with neither uncertainty nor idle layers."""
    return predicted("stiff", 50.0, uncertain={}, layers=(), **options)


def figures_of(section):
    return [figure for part in section.parts for figure in part.figures]


def cells(table, column):
    place = table.columns.index(column)
    return [row[place] for row in table.rows]


def test_a_hose_is_cut_to_its_length():
    long, short = views(predicted(), bare(cord=SHORT_CORD))
    assert long.array("tension").size == predicted().prediction.strain.size
    assert np.isfinite(short.array("strain")).all()
    assert short.array("cord_curve_load").tolist() == [0.0, 130.0]
    assert short.texts("hose_layer_name") == () and short.array("hose_layer_wrap_angle").size == 0
    assert long.texts("hose_layer_name") == ("Kevlar", "conductors")
    assert short.sources == () and len(long.sources) == 3
    assert short.array("no such").size == 0 and np.isnan(short.scalar("strain"))
    assert short.text("no such") == "" and short.texts("no such") == ()


def test_a_state_of_the_cords_is_a_bit_at_each_strain():
    one = view()
    state = one.array("hose_state").astype(int)
    is_slack = (state & HOSE_STATES["slack"]) > 0
    assert is_slack.tolist() == (one.array("strain") <= pick_up_strain(68)).tolist()
    assert not (state & HOSE_STATES["jammed"]).any()


@pytest.mark.parametrize("units", ["si", "us"])
@pytest.mark.parametrize("hose", [predicted, bare])
def test_every_figure_is_one_that_plotly_takes_and_says_it_is_synthetic(hose, units):
    (one,) = views(hose(), units=units, synthetic="yes")
    figures = figures_of(_make_hose_section(one))
    assert len({figure.key for figure in figures}) == len(figures) >= 3
    for figure in figures:
        go.Figure(json.loads(figure.json()))
        assert figure.has_data, figure.key
        assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
        assert figure.label.startswith("Synthetic data. ")
        for name, settings in figure.layout.items():
            if name.startswith(("xaxis", "yaxis")):
                assert re.search(r"\[.+\]$", settings["title"]["text"]), (figure.key, name)


def test_a_prediction_that_is_not_of_made_up_numbers_is_not_called_synthetic():
    section = _make_hose_section(view())
    assert not any(figure.synthetic for figure in figures_of(section))
    assert any("without any test of the hose" in text for text in section.parts[0].sentences)


def test_tension_is_that_of_rubber_until_the_cords_pick_up():
    (figure,) = draw_tension(view())
    named = traces(figure)
    x, y = (np.array(named["net tension"][axis]) for axis in "xy")
    slack = x <= 100 * pick_up_strain(68)
    assert y[slack] == pytest.approx(rubber_tension(1 + x[slack] / 100), rel=1e-5)
    cords, rubber = (np.array(named[name]["y"]) for name in ("cords, less the end cap", "rubber"))
    assert not cords[slack].any()
    assert cords + rubber == pytest.approx(y, rel=1e-5, abs=1e-3)
    assert rubber[1:] == pytest.approx(rubber_tension(1 + x[1:] / 100), rel=1e-5)
    (zone,) = figure.layout["shapes"]
    assert (zone["x0"], zone["x1"]) == (0, pytest.approx(100 * pick_up_strain(68)))


def test_events_and_the_safe_working_load_stand_where_the_closed_forms_say():
    (figure,) = draw_tension(view(units="us"))
    named = traces(figure)
    load, strain = working_tension(68) / POUND, 100 * (stretch_at(68, AT_WORK) - 1)
    line = named["safe working load"]
    assert line["x"] == pytest.approx([0, strain, strain], rel=1e-5)
    assert line["y"] == pytest.approx([load, load, 0], rel=1e-5)
    assert named["cords pick up"]["x"] == pytest.approx([100 * pick_up_strain(68)], rel=1e-5)
    # slackest where the derivative of eq. (8) is zero: (tan2/2)**(1/3)
    lowest = 100 * ((np.tan(np.radians(68)) ** 2 / 2) ** (1 / 3) - 1)
    assert named["cords slackest"]["x"] == pytest.approx([lowest], rel=1e-5)
    assert named["cords break"]["x"] == pytest.approx([100 * (stretch_at(68, 0.22) - 1)], rel=1e-5)


def test_the_band_is_the_expanded_uncertainty_of_the_tables_and_ends_where_the_load_does():
    one = view(greatest_strain=2.4)
    (figure,) = draw_tension(one)
    band = traces(figure)["95 % band"]
    tension, spread = one.array("tension"), one.array("tension_standard_uncertainty")
    known = np.isfinite(tension)
    assert 0 < known.sum() < known.size
    size = int(known.sum())
    assert band["y"][:size] == pytest.approx((tension + 1.959964 * spread)[known], rel=1e-5)
    assert band["y"][size : 2 * size][::-1] == pytest.approx(
        (tension - 1.959964 * spread)[known], rel=1e-5
    )
    assert traces(figure)["net tension"]["y"][-1] is None


def test_without_uncertainty_there_is_neither_band_nor_word_of_it():
    (one,) = views(bare())
    for figure in (*draw_tension(one), *draw_pressure(one)):
        assert "95 % band" not in traces(figure) and "95 %" not in figure.caption
    assert draw_budget(one) == []
    assert _plus_minus_of_hoses([one]) == [
        "No uncertainty is stated for the construction, so none is given."
    ]


def test_below_the_neutral_angle_nothing_is_shaded_and_no_slack_is_spoken_of():
    (one,) = views(bare())
    (figure,) = draw_tension(one)
    assert "shapes" not in figure.layout and "Grey" not in figure.caption
    assert not {"cords slackest", "cords pick up"} & traces(figure).keys()
    assert [event.name for event in one.events.values()] == ["pick_up", "working", "cord_break"]
    assert "no slack zone" in _make_hose_section(one).parts[0].sentences[0]


def test_events_beyond_the_last_strain_are_in_the_table_and_not_in_the_figure():
    one = view(greatest_strain=0.6)
    (figure,) = draw_tension(one)
    assert "cords slackest" in traces(figure)
    assert not {"cords pick up", "working load", "safe working load"} & traces(figure).keys()
    assert figure.layout["shapes"][0]["x1"] == pytest.approx(60)
    assert [cell.text for cell in cells(hose_event_table(one), "event")][-1] == "cords break"
    assert max(traces(draw_chart(one)[0])["64 deg"]["x"]) > 60


def test_fill_pressure_is_none_while_the_cords_are_slack():
    one = view()
    (figure,) = draw_pressure(one)
    line = traces(figure)["fill pressure"]
    slack = np.array(line["x"]) <= 100 * pick_up_strain(68)
    assert not np.array(line["y"])[slack].any() and min(np.array(line["y"])[~slack]) > 0
    assert figure.layout["yaxis"]["title"]["text"] == "fill pressure [MPa]"
    # the sum over both layers of 2 P n sin2 / (L Lc d), eq. (24) of WHOI-2004-06
    stretch = stretch_at(68, AT_WORK)
    sine2 = np.sin(np.radians(68)) ** 2
    expected = 2 * 10 * POUND * 34 / INCH * sine2 / (stretch * 1.1) * (1 / 3.4 + 1 / 3.6) / INCH
    assert traces(figure)["working load"]["y"] == pytest.approx([expected * 1e-6], rel=1e-5)


def test_the_budget_is_of_the_rubber_at_first_and_of_the_angle_at_work():
    (figure,) = draw_budget(view())
    together = np.sum([trace["y"] for trace in figure.data], axis=0)
    assert together == pytest.approx(100, abs=1e-3)
    named = traces(figure)
    assert named["rubber modulus"]["y"][0] == pytest.approx(100)
    assert named["wrap angle"]["y"][-1] > 80
    assert {trace["stackgroup"] for trace in figure.data} == {"share"}
    assert figure.data[0]["x"][0] > 0  # at rest there is no variance to share


def test_small_sources_stand_together():
    many = {"wrap_angle": 0.01, "rubber_modulus": 1e5, "inner_diameter": 1e-7,
            "outer_diameter": 1e-7, "cord_strain_scale": 1e-6}  # fmt: skip
    (figure,) = draw_budget(view(uncertain=many))
    assert [*traces(figure)][-1] == "3 others" and len(figure.data) == 3
    one_small = {name: many[name] for name in ("wrap_angle", "rubber_modulus", "inner_diameter")}
    (figure,) = draw_budget(view(uncertain=one_small))
    assert [*traces(figure)][-1] == "inner diameter"


def test_a_source_of_no_uncertainty_at_all_leaves_nothing_to_share():
    assert draw_budget(view(uncertain={"wrap_angle": 0.0})) == []


def test_the_chart_has_a_family_of_angles_and_this_hose_heavy():
    (figure,) = draw_chart(view())
    named = traces(figure)
    assert "68 deg" not in named  # drawn as the hose's own
    own = named["this hose, 68 deg"]
    widths = {name: trace["line"]["width"] for name, trace in named.items() if "line" in trace}
    assert widths["this hose, 68 deg"] == max(widths.values())
    for angle in (45, 54.74, 64, 72):
        line = named[f"{angle} deg"]
        stretch = 1 + np.array(line["x"]) / 100
        cos2 = np.cos(np.radians(54.73561 if angle == 54.74 else angle)) ** 2
        expected = np.sqrt(stretch**2 * cos2 + (1 - cos2) / stretch) - 1
        assert np.array(line["y"]) == pytest.approx(100 * expected, abs=2e-4)
        assert line["text"][-1] == f"{angle}" and not any(line["text"][:-1])
        assert max(line["y"]) <= 22
    assert own["y"][-1] == pytest.approx(22)
    assert named["cord strain where the hose works"]["y"] == pytest.approx([10, 10])


def test_dead_length_moves_the_family_too():
    (figure,) = draw_chart(view(dead_length_share=0.1))
    line = traces(figure)["64 deg"]
    stretch = 1 + np.array(line["x"]) / 100 / 0.9
    cos2 = np.cos(np.radians(64)) ** 2
    expected = np.sqrt(stretch**2 * cos2 + (1 - cos2) / stretch) - 1
    assert np.array(line["y"]) == pytest.approx(100 * expected, abs=2e-4)


def test_spacing_and_bore_are_drawn_where_a_limit_is_near_or_stated():
    assert draw_limits(view()) == []
    spacing, bore = draw_limits(view(cord_diameter=0.00072, minimum_inner_diameter=0.05))
    line, limit = spacing.data
    assert line["y"][0] == pytest.approx(0.0254 / 34 / 0.00072, rel=1e-5) and limit["y"] == [1, 1]
    line, limit = bore.data
    stretch = 1 + np.array(line["x"]) / 100
    assert np.array(line["y"]) == pytest.approx(63.5 / np.sqrt(stretch), rel=1e-5)
    assert limit["y"] == [50, 50]


def test_hoses_stand_together_in_one_figure_where_there_are_several():
    both = views(predicted(), bare(), synthetic="yes")
    (figure,) = draw_all_hoses(both)
    named = traces(figure)
    assert {"gumby, 68 deg", "stiff, 50 deg"} <= named.keys()
    assert named["working load"]["x"] == pytest.approx(
        [100 * (stretch_at(angle, AT_WORK) - 1) for angle in (68, 50)], rel=1e-5
    )
    assert len(named["cords pick up"]["x"]) == 1
    assert figure.synthetic and len(figure.data) == 6
    assert draw_all_hoses(both[:1]) == []


def test_hoses_beyond_seven_are_told_apart_by_their_dashes():
    hose = predicted(layers=(), uncertain={})
    (figure,) = draw_all_hoses(views(*(renamed(hose, f"h{k}") for k in range(9))))
    looks = {(t["line"]["color"], t["line"]["dash"]) for t in figure.data if "line" in t}
    assert len(looks) == 9


def test_the_answer_has_the_numbers_of_the_archive_and_their_uncertainty():
    both = views(predicted(), bare())
    table = answer_of_hoses(both)
    load, other = cells(table, "safe working load [N]")
    assert float(load.value) == pytest.approx(working_tension(68), rel=1e-9)
    assert " ± " in load.text and "±" not in other.text
    pick_up = cells(table, "pick-up strain [%]")[0]
    assert float(pick_up.value) == pytest.approx(pick_up_strain(68))
    # half a degree at 12.19 points a degree (WHOI-2004-06: the angle is all), times 1.96
    assert pick_up.text == f"{100 * pick_up_strain(68):.0f} ± 12"
    assert table.remarks[0].startswith("±: expanded uncertainty, 95 % (k = 1.96)")
    assert "wrap angle, rubber modulus, load of the cord curve" in table.remarks[0]
    assert table.remarks[1] == "No uncertainty is stated for stiff."
    assert answer_of_hoses([]) is None


def test_events_are_shown_in_the_units_asked_for_and_kept_in_si_beside():
    si, us = (hose_event_table(view(units=units)) for units in ("si", "us"))
    newton = cells(si, "tension [N]")
    pound = cells(us, "tension [lbf]")
    assert [cell.value for cell in newton] == [cell.value for cell in pound]
    assert cells(us, "tension of a cord [lbf]")[-1].text == "30.00"
    assert "better known than" in si.remarks[-1]
    assert len(hose_event_table(views(bare())[0]).remarks) == 1


def test_construction_is_complete_with_ribbons_and_cords():
    table = hose_design_table(view(units="us", minimum_inner_diameter=0.0254))
    found = {row[0].text: row[1].text for row in table.rows}
    assert found["wrap angle from the axis [deg]"] == "68.00 ± 0.98"
    assert found["diameter of the inner layer [in]"] == "3.400"
    assert found["cords per length of fabric [1/in]"] == "34.00"
    assert found["Young's modulus of the rubber [psi]"] == "200 ± 20"
    assert found["minimum bore allowed [in]"] == "1.000"
    ribbon = np.pi * 3.4 * np.cos(np.radians(68))
    assert found["width of the ribbon of the inner layer [in]"] == f"{ribbon:.3f}"
    assert found["cords in the section, both layers"] == "280.1"
    assert "No dead length is stated" in table.remarks[-1]
    same = hose_design_table(view(layer_diameter=(3.5 * INCH,) * 2, dead_length_share=0.04))
    names = [row[0].text for row in same.rows]
    assert "diameter of both cord layers [mm]" in names and len(same.remarks) == 1
    assert not any("minimum bore" in name for name in names)


def test_layers_that_carry_no_load_have_their_limits_angles_and_verdict():
    table = layer_table(view())
    assert [cell.text for cell in cells(table, "layer")] == ["Kevlar", "conductors"]
    assert [cell.text for cell in cells(table, "within its limits")] == [
        "no: stretched too far", "yes",
    ]  # fmt: skip
    least = float(cells(table, "least angle [deg]")[0].value)
    stretch, cos2 = stretch_at(68, AT_WORK), np.cos(least) ** 2
    assert np.sqrt(stretch**2 * cos2 + (1 - cos2) / stretch) - 1 == pytest.approx(0.02)
    assert cells(table, "greatest angle [deg]")[1].text == NOT_GIVEN
    assert layer_table(views(bare())[0]) is None


@pytest.mark.parametrize(
    ("limits", "verdict"),
    [
        ((np.nan, np.nan), "no limit stated"),
        ((0.5, 0.001), "no: compressed too far"),
        ((0.001, 0.001), "no: stretched and compressed too far"),
    ],
)
def test_the_verdict_on_a_layer_says_which_limit_it_breaks(limits, verdict):
    layer = plan().layers[0].__class__("K", np.radians(66), *limits)
    table = layer_table(view(layers=(layer,)))
    assert cells(table, "within its limits")[0].text == verdict


def test_the_points_of_the_cord_stand_as_measured_and_factors_are_told():
    table = cord_table(view(units="us", cord_load_scale=1.1))
    assert [cell.text for cell in cells(table, "load [lbf]")][-1] == "30.00"
    assert "loads times 1.1 and strains times 1" in table.remarks[-1]
    assert len(cord_table(view()).remarks) == 1


def test_the_curve_has_some_points_with_first_and_last():
    one = view()
    table = hose_curve_table(one)
    strain = [float(cell.value) for cell in cells(table, "strain [%]")]
    assert strain[0] == 0 and strain[-1] == one.array("strain")[-1] and len(strain) <= 26
    tension = [float(cell.value) for cell in cells(table, "tension [N]")]
    kept = np.isin(one.array("strain"), strain)
    assert tension == one.array("tension")[kept].tolist()
    broken = hose_curve_table(view(greatest_strain=2.4))
    assert cells(broken, "tension [N]")[-1].text == NOT_GIVEN


def test_doubts_are_warnings_on_top_and_the_rest_notes():
    one = view(greatest_strain=2.4, cord_diameter=0.00075)
    found = {finding.text[:24]: finding.severity for finding in _hose_findings(one)}
    assert found["layer Kevlar is stretche"] == "warning"
    assert found["layer Kevlar: no wrap an"] == "warning"
    assert found["neighbouring cords touch"] == "warning"
    assert found["the cords are broken fro"] == "refusal"
    (plain,) = views(bare())
    assert {finding.severity for finding in _hose_findings(plain)} == {"note"}
    assert {finding.tests for finding in _hose_findings(plain)} == {("hose stiff",)}
    assert len(_make_hose_section(one).parts[0].warnings) == 3


def test_a_little_known_working_load_is_a_warning():
    one = view(uncertain={"rubber_modulus": 7e5}, layers=())
    assert [finding.severity for finding in _hose_findings(one)] == ["warning"]


def test_tiles_count_hoses_and_give_the_load_of_one_alone():
    one, other = views(predicted(), bare())
    assert [tile.words for tile in _hose_tiles([one, other])] == ["predicted hoses"]
    first, load = _hose_tiles([one])
    assert first.words == "predicted hose"
    assert load.number == f"{working_tension(68):,.0f} N"
    assert _hose_tiles([]) == []


@pytest.fixture
def page(tmp_path):
    """The page of an archive of hoses alone."""

    def made(*hoses, units="si", synthetic="", **about):
        folder = tmp_path / "hoses"
        write_archive(dataset(*hoses, synthetic=synthetic, **about), folder / "predictions.nc")
        return write_report(folder, tmp_path / "out", units=units).read_text(encoding="utf-8")

    return made


def test_hoses_alone_are_a_page_without_parts_of_tests(page):
    html = page(predicted(), bare())
    assert '<h2 id="hose-0">Predicted hose gumby</h2>' in html
    assert '<h2 id="hose-1">Predicted hose stiff</h2>' in html
    # what shows all of them stands first
    assert html.index('id="answer"') < html.index('id="hoses-tension-data"')
    assert html.index('id="hoses-tension-data"') < html.index('id="hose-0"')
    assert 'id="tested"' not in html and "SYNTHETIC" not in html
    assert "splice-free" not in html
    assert "whole relaxed length" in html
    assert "ab" * 32 in html  # the hash of the file that says how the hoses are made


def test_one_hose_has_no_figure_across(page):
    html = page(bare())
    assert "Across the hoses" not in html and 'id="hoses-tension-data"' not in html
    load = f"{working_tension(50):,.0f}"
    assert f"<strong>{load} N</strong> safe working load" in html


def test_the_page_of_a_campaign_marked_synthetic_says_so(page):
    html = page(predicted(), synthetic="yes")
    assert html.count("<strong>SYNTHETIC DATA</strong>") == 1


def test_names_with_markup_are_text(page, tmp_path):
    hose = renamed(predicted(), NASTY)
    html = page(hose, bare())
    assert "<script>alert" not in html and "&lt;script&gt;alert(1)" in html
    (path,) = tmp_path.rglob("index.html")
    figure = drawn_on(path)["hose-0-tension"]
    assert "<b>" not in figure["layout"]["title"]["text"]


def test_the_same_archive_gives_the_same_page(page):
    assert page(predicted()) == page(predicted())


def test_an_archive_that_cannot_be_read_is_told_and_an_empty_folder_refused(page, tmp_path):
    page(predicted())
    (tmp_path / "hoses" / "predictions.nc").write_bytes(b"no netCDF")
    html = write_report(tmp_path / "hoses", tmp_path / "out").read_text(encoding="utf-8")
    assert "predictions.nc" in html and 'id="hose-0"' not in html
    with pytest.raises(ArchiveError, match="nothing to report on"):
        write_report(tmp_path / "empty", tmp_path / "out")
