"""Comparisons on the page: verdicts, figures, tables, findings, from their archive alone."""

import json
import re
from dataclasses import replace

import numpy as np
import plotly.graph_objects as go
import pytest
from compared_hoses import (
    LOOP,
    NOT_APART,
    TRUTH,
    agreeing,
    dataset,
    differing,
    judged_as,
    trading,
)
from reportparts import column, numbers, traces

from reduction.archive.write import write_archive
from reduction.cli.output import CommandOutput
from reduction.cli.predictions import _show_comparison
from reduction.record.notes import note
from reduction.report.campaign_page import write_report
from reduction.report.campaign_sections import (
    _comparison_findings,
    _comparison_tiles,
    _make_comparison_section,
)
from reduction.report.campaign_summary import SummaryFinding
from reduction.report.figures.hose_figures import (
    draw_all_comparisons,
    draw_comparison,
    draw_cycle_bias,
    draw_error,
)
from reduction.report.prediction_tables import (
    calibration_table,
    compared_curve_table,
    compared_event_table,
    correlation_table,
    energy_table,
    verdict_table,
)
from reduction.report.product_views import ComparisonView
from reduction.report.text_style import NOT_GIVEN

NASTY = "</script><script>alert(1)</script> & <b>"
POUND = 4.4482216152605


def views(*named, units="si", synthetic=""):
    return ComparisonView.rows_of(dataset(*named, synthetic=synthetic), units)


def view(named, **options):
    (one,) = views(named, **options)
    return one


def values(table, heading):
    place = next(i for i, name in enumerate(table.columns) if name.startswith(heading))
    return [row[place].value for row in table.rows]


def all_figures(one):
    return [*draw_comparison(one), *draw_error(one), *draw_cycle_bias(one)]


LITTLE = {"is_informative": False, "verdict": "agrees within U, 9 N: so wide that little is said"}
NOT_JUDGED = {
    "largest_ratio": np.nan, "coverage_factor": np.nan, "agrees": False,
    "verdict": "not judged: neither the test nor the prediction has an uncertainty",
}  # fmt: skip


@pytest.mark.parametrize(
    ("named", "outcome"),
    [
        (agreeing, "agrees"), (differing, "differs"),
        (lambda: judged_as(agreeing(), **LITTLE), "says little"),
        (lambda: judged_as(agreeing(), **NOT_JUDGED), "not judged"),
    ],
)  # fmt: skip
def test_a_verdict_is_a_word_in_the_table_of_all(named, outcome):
    table = verdict_table([view(named())])
    assert column(table, "verdict") == [outcome]


def test_the_table_of_all_has_the_numbers_of_the_judged_curve():
    table = verdict_table(views())
    assert column(table, "comparison") == ["alike", "apart", "trade"]
    assert column(table, "test") == ["S-64", "B-64", "D-64"]
    assert column(table, "loading") == ["static", "static", "dynamic"]
    differences = [
        agreeing().comparison.differences["midline"],
        differing().comparison.differences["ascending"],
        trading().comparison.differences["midline"],
    ]
    assert [float(one) for one in values(table, "bias [N]")] == [one.bias for one in differences]
    assert [float(one) for one in values(table, "largest difference [N]")] == [
        one.worst_tension_difference for one in differences
    ]
    ratios = [one().comparison.validation.largest_ratio for one in (agreeing, differing, trading)]
    assert [float(one) for one in values(table, "largest ratio")] == ratios
    assert column(table, "at strain [%]")[1] == "120"


def test_no_comparison_is_no_table_and_no_tile():
    assert verdict_table([]) is None
    assert _comparison_tiles([]) == []


def test_the_test_and_the_prediction_are_drawn_at_their_strains():
    (figure,) = draw_comparison(view(agreeing()))
    found = traces(figure)
    assert [*found][:7] == [
        "95 % band of the prediction", "95 % band of the test", "predicted", "calibrated", "measured, ascending",
        "measured, descending", "measured, midline",
    ]  # fmt: skip
    strain = numbers(found["predicted"]["x"]) / 100
    np.testing.assert_allclose(
        numbers(found["predicted"]["y"]), TRUTH.tension(strain), rtol=1e-5, atol=1e-3
    )
    apart = numbers(found["measured, ascending"]["y"]) - numbers(found["measured, descending"]["y"])
    np.testing.assert_allclose(apart[np.isfinite(apart)], LOOP, atol=0.05)
    heavy = found["measured, midline"]["line"]["width"]
    assert heavy > found["measured, ascending"]["line"]["width"]


@pytest.mark.parametrize("whose", ["the prediction", "the test"])
def test_the_bands_are_expanded_uncertainties_with_the_factor_of_the_tables(whose):
    one = view(agreeing())
    (figure,) = draw_comparison(one)
    band = traces(figure)[f"95 % band of {whose}"]
    edges = [pair for pair in zip(band["x"], band["y"], strict=True) if pair[0] is not None]
    at = 100 * one.array("strain")[50]
    high, low = sorted((y for x, y in edges if abs(x - at) < 1e-6), reverse=True)
    found = agreeing().comparison
    if whose == "the prediction":
        spread = found.validation.input_standard_uncertainty[50]
    else:
        # a load cell that may be 20 N off, beside the scatter
        spread = np.hypot(20.0, found.measured.midline_standard_uncertainty[50])
    assert high - low == pytest.approx(2 * 1.96 * spread, rel=1e-4)
    assert "95 % (k = 1.96)" in figure.caption
    assert "errors common to all samples: tension offset" in figure.caption


def test_a_prediction_without_uncertainty_has_no_band():
    named = judged_as(differing(), input_standard_uncertainty=np.zeros(121))
    (figure,) = draw_comparison(view(named))
    assert "95 % band of the prediction" not in traces(figure)


def test_events_are_marked_where_they_are_predicted_and_where_the_test_came_by():
    (figure,) = draw_comparison(view(differing()))
    marks = [trace for trace in figure.data if trace["mode"].startswith("markers")]
    places = {(mark["name"], mark["marker"]["symbol"]): mark["x"][0] for mark in marks}
    assert places["cords pick up", "diamond"] == pytest.approx(100 * TRUTH.pick_up_strain())
    own = differing().comparison.events[1]
    assert places["working load", "circle"] == pytest.approx(100 * own.strain, rel=1e-5)
    assert places["working load", "circle-open"] == pytest.approx(
        100 * own.measured_strain, rel=1e-5
    )
    # the label of what is near the right edge stands on the left
    sides = {mark["name"]: mark["textposition"] for mark in marks if mark["text"] != [""]}
    assert sides == {"cords pick up": "bottom right", "working load": "top left"}
    assert "Thick: the ascending branch of the test" in figure.caption
    # 146 %, beyond the pull to 120 %
    assert "cords break" not in {name for name, _ in places}


def test_the_error_is_drawn_within_what_it_may_be():
    one = view(agreeing())
    (figure,) = draw_error(one)
    found = traces(figure)
    validation = agreeing().comparison.validation
    allowed = validation.coverage_factor * validation.validation_uncertainty
    edges = numbers(found["band of U"]["y"])
    assert np.nanmax(edges) == pytest.approx(np.nanmax(allowed), rel=1e-5)
    assert np.nanmin(edges) == pytest.approx(-np.nanmax(allowed), rel=1e-5)
    judged = numbers(found["midline, judged"]["y"])
    np.testing.assert_allclose(
        judged, agreeing().comparison.differences["midline"].difference, rtol=1e-5
    )
    left = numbers(found["left by the calibration"]["y"])
    assert np.nanmax(np.abs(left)) < 0.05 * np.nanmax(np.abs(judged))


def test_the_greatest_difference_and_the_largest_ratio_are_marked():
    both = traces(draw_error(view(differing()))[0])
    validation = differing().comparison.validation
    assert differing().comparison.differences["ascending"].worst_strain == pytest.approx(1.2)
    assert validation.largest_ratio_strain == pytest.approx(1.2)
    mark = both["greatest difference and ratio"]
    apart = TRUTH.tension(1.2) - TRUTH.but(cord_load_scale=1.5).tension(1.2)
    assert (mark["x"], mark["y"]) == ([120.0], [pytest.approx(apart, rel=2e-3)])
    elsewhere = differing().comparison.measured.strain[40]
    found = traces(draw_error(view(judged_as(differing(), largest_ratio_strain=elsewhere)))[0])
    assert found["greatest difference"]["x"] == [120.0] and found["largest ratio"]["x"] == [40.0]


def test_what_is_not_judged_has_no_band_and_no_ratio():
    named = judged_as(
        agreeing(),
        **NOT_JUDGED,
        largest_ratio_strain=np.nan,
        validation_uncertainty=np.full(91, np.nan),
    )
    (figure,) = draw_error(view(named))
    found = traces(figure)
    assert "largest ratio" not in found and "greatest difference" in found
    assert not found["band of U"]["y"] and "Shaded" not in figure.caption
    assert "No uncertainty is stated" in _sentences(
        judged_as(agreeing(), chi_square_probability=np.nan), "Comparison error"
    )


def _sentences(named, heading):
    section = _make_comparison_section(view(named))
    (part,) = [one for one in section.parts if one.heading == heading]
    return " ".join((*part.sentences, *part.warnings))


def test_a_single_cycle_has_no_trend():
    assert draw_cycle_bias(view(differing())) == []


def test_cycles_are_drawn_over_the_logarithm_of_their_number():
    (figure,) = draw_cycle_bias(view(trading()))
    found = traces(figure)
    assert found["bias of the cycle"]["x"] == [float(n) for n in range(1, 11)]
    assert figure.layout["xaxis"]["type"] == "log"
    assert figure.layout["xaxis"]["tickvals"] == [1, 2, 5, 10]
    line = found["straight over decades"]
    # made two percent a decade softer, from the first cycle to the tenth
    strain = trading().comparison.measured.strain
    there = np.isfinite(trading().comparison.measured.midline_tension)
    rise = 0.02 * TRUTH.tension(strain[there]).mean()
    assert line["y"][-1] - line["y"][0] == pytest.approx(rise, rel=2e-3)
    low, high = figure.layout["yaxis"]["range"]
    assert low < min(found["bias of the cycle"]["y"]) and max(line["y"]) < high


def test_two_cycles_are_points_without_a_line():
    cycles = trading().comparison.cycles
    two = replace(
        cycles, cycle_number=np.array([1, 20_000]), cycle_bias=cycles.cycle_bias[:2], cycle_rms=cycles.cycle_rms[:2],
        bias_per_decade=np.nan, bias_per_decade_standard_uncertainty=np.nan,
    )  # fmt: skip
    named = replace(trading(), comparison=replace(trading().comparison, cycles=two))
    (figure,) = draw_cycle_bias(view(named))
    assert [trace["name"] for trace in figure.data] == ["bias of the cycle"]
    assert figure.layout["xaxis"]["ticktext"] == ["1", "10", "100", "1,000", "10,000", "100,000"]


def test_all_comparisons_are_lines_over_their_measured_tension():
    found = views()
    _, figure = draw_all_comparisons(found)
    lines = traces(figure)
    assert [*lines] == ["alike", "apart", "trade"]
    assert lines["trade"]["line"]["dash"] == "dash"
    apart = numbers(lines["apart"]["y"])
    strain = numbers(lines["apart"]["x"])
    # half of the cords' load is missing in the prediction
    strong, plain = TRUTH.but(cord_load_scale=1.5).tension(1.2), TRUTH.tension(1.2)
    assert strain[-1] == pytest.approx(120)
    assert apart[-1] == pytest.approx(100 * (plain / strong - 1), rel=2e-3)
    # below a twentieth of the greatest tension no ratio is drawn
    assert np.isnan(apart[TRUTH.tension(strain / 100) < 0.04 * strong]).all()


def test_one_test_with_one_hose_is_one_line_however_it_was_fitted():
    twice = replace(agreeing(), name="again")
    tension, figure = draw_all_comparisons(views(agreeing(), twice))
    assert [trace["name"] for trace in figure.data] == ["alike, again"]
    assert [name for name in traces(tension) if "measured" in name] == ["alike, again, measured"]
    assert draw_all_comparisons([view(agreeing())]) == []


def test_curves_are_rows_and_the_calibrated_one_stands_below():
    table = compared_curve_table(view(agreeing()))
    assert column(table, "curve") == [
        "ascending", "descending", "midline, judged", "midline, calibrated",
    ]  # fmt: skip
    bias = [float(one) for one in values(table, "bias")]
    assert bias[0] - bias[1] == pytest.approx(-LOOP)
    assert abs(bias[3]) < 0.1 * abs(bias[2])
    assert column(table, "largest difference")[3] == NOT_GIVEN
    one_branch = compared_curve_table(view(differing()))
    assert column(one_branch, "curve") == ["ascending, judged"]
    assert "only its ascending branch" in one_branch.remarks[0]


def test_events_have_both_differences_and_dashes_beyond_the_test():
    table = compared_event_table(view(differing()))
    assert column(table, "event") == ["cords pick up", "working load", "cords break"]
    assert float(values(table, "predicted strain")[0]) == pytest.approx(TRUTH.pick_up_strain())
    working = differing().comparison.events[1]
    assert float(values(table, "tension difference")[1]) == working.tension_difference
    assert re.fullmatch(r"-4,\d+ ± \d+", column(table, "tension difference")[1])
    assert column(table, "measured there")[2] == NOT_GIVEN
    assert any("not reached in the test" in remark for remark in table.remarks)


def test_energies_stand_between_two_strains():
    table = energy_table(view(agreeing()))
    assert column(table, "between strains")[0] == "0.0 to 90.0"
    assert float(values(table, "loop [J/m]")[0]) == pytest.approx(LOOP * 0.9)
    assert column(energy_table(view(differing())), "loop [J/m]") == [NOT_GIVEN]
    energy = replace(
        agreeing().comparison.energy,
        **dict.fromkeys(("measured_energy", "predicted_energy", "energy_difference"), np.nan),
    )
    named = replace(agreeing(), comparison=replace(agreeing().comparison, energy=energy))
    assert energy_table(view(named)) is None


def test_fitted_numbers_are_in_units_of_a_reader():
    table = calibration_table(view(agreeing()))
    assert column(table, "number") == ["wrap angle [deg]", "rubber modulus [MPa]"]
    assert column(table, "start")[0] == "64.00"
    assert float(column(table, "fitted")[0].split(" ± ")[0]) == pytest.approx(64, abs=0.02)
    assert column(table, "at a bound") == ["no", "no"]
    fit = agreeing().comparison.calibration
    low, high = (float(text) for text in column(table, "95 % interval")[0].split(" to "))
    assert low == pytest.approx(np.degrees(fit.low[0]), abs=0.01)
    assert high == pytest.approx(np.degrees(fit.high[0]), abs=0.01)
    in_psi = calibration_table(view(agreeing(), units="us"))
    assert column(in_psi, "number")[1] == "rubber modulus [psi]"
    assert column(in_psi, "start")[1] == "200.0"
    assert calibration_table(view(differing())) is None


def fitted_as(named, **changes):
    fit = replace(named.comparison.calibration, **changes)
    return replace(named, comparison=replace(named.comparison, calibration=fit))


def test_a_number_that_was_stopped_says_so_and_one_without_an_interval_has_none():
    stopped = fitted_as(
        trading(), is_at_bound=np.array([True, False]),
        value_standard_uncertainty=np.array([np.nan, 0.1]), low=np.array([np.nan, 0.9]),
        high=np.array([np.nan, 1.1]), notes=(note("number-at-bound", name="cord_load_scale"),),
    )  # fmt: skip
    one = view(stopped)
    table = calibration_table(one)
    assert column(table, "number")[0] == "scale of the cords' load"
    assert column(table, "at a bound") == ["yes", "no"]
    assert column(table, "95 % interval") == [NOT_GIVEN, "0.90 to 1.10"]
    warned = {one.text for one in _comparison_findings(one) if one.severity == "warning"}
    assert "the fit of cord_load_scale stopped at a bound: its interval is not valid" in warned


def test_correlations_are_a_square_with_the_index_below():
    table = correlation_table(view(trading()))
    assert len(table.rows) == 2 and len(table.columns) == 3
    assert column(table, "scale of the cords' load")[0] == "+1.000"
    (remark,) = table.remarks
    index = trading().comparison.calibration.identifiability.collinearity
    assert float(re.search(r"index: ([\d.]+);", remark)[1]) == pytest.approx(index, rel=0.005)
    assert correlation_table(view(differing())) is None
    words = replace(trading().comparison.calibration.identifiability, collinearity=np.inf)
    table = correlation_table(view(fitted_as(trading(), identifiability=words)))
    assert "does not respond to one of them" in table.remarks[0]


def test_what_differs_is_a_warning_at_the_top():
    findings = _comparison_findings(view(differing()))
    assert findings[0].severity == "warning"
    assert findings[0].tests == ("comparison apart",)
    # as urgent as its size: before warnings without an effect on a number
    assert findings[0].urgency < SummaryFinding("warning", (), "").urgency
    assert findings[0].text == f"The prediction {differing().comparison.validation.verdict}."
    assert not [one for one in _comparison_findings(view(agreeing())) if one.severity == "warning"]


def test_a_fit_that_cannot_tell_its_numbers_apart_is_a_warning_once():
    findings = [one.text for one in _comparison_findings(view(trading()))]
    said = trading().comparison.calibration.identifiability.words
    (text,) = [one for one in findings if said in one]
    assert text.startswith("The curve does not determine the fitted numbers")
    assert all(name in text for name in NOT_APART)
    warnings = [one for one in _comparison_findings(view(trading())) if one.severity == "warning"]
    assert text in {one.text for one in warnings}
    assert "does not determine the fitted numbers" in _sentences(trading(), "Calibration")
    assert "determines these numbers" in _sentences(agreeing(), "Calibration")


@pytest.mark.parametrize(
    ("changes", "begins"), [(LITTLE, "Agrees within U, 9 N"), (NOT_JUDGED, "Not judged: neither")]
)
def test_agreement_that_says_little_is_a_note(changes, begins):
    first = _comparison_findings(view(judged_as(agreeing(), **changes)))[0]
    assert first.severity == "note" and first.text.startswith(begins)


def test_tiles_count_the_comparisons_and_those_that_differ():
    tiles = _comparison_tiles(views())
    assert [(one.number, one.words, one.is_bad) for one in tiles] == [
        ("3", "comparisons", False), ("1", "differs", True),
    ]  # fmt: skip
    assert tiles[1].target == "comparison-1"
    two = _comparison_tiles(views(differing(), replace(differing(), name="too")))
    assert two[1].words == "differ"
    (tile,) = _comparison_tiles(views(agreeing()))
    assert tile.words == "comparison"


def test_a_section_has_its_parts_and_no_empty_one():
    headings = [one.heading for one in _make_comparison_section(view(trading())).parts]
    assert headings == [
        "Measured and predicted tension", "Comparison error", "Cycle by cycle", "Energy",
        "Calibration",
    ]  # fmt: skip
    section = _make_comparison_section(view(differing()))
    assert [one.heading for one in section.parts] == [
        "Measured and predicted tension", "Comparison error", "Energy",
    ]  # fmt: skip
    assert section.title == "Comparison apart"
    assert section.subtitle == "test B-64 (static), specimen hose-64, against hose H64"
    ((_, notes),) = section.notes
    assert notes == list(map(str, differing().notes))


def test_chi_square_is_said_with_its_chance():
    rare = judged_as(agreeing(), chi_square_probability=1e-9)
    assert "in less than 0.01 % of cases" in _sentences(rare, "Comparison error")
    often = judged_as(agreeing(), chi_square_probability=0.25)
    assert "in 25 % of cases" in _sentences(often, "Comparison error")


def test_us_units_reach_figures_and_tables():
    si, us = (view(agreeing(), units=units) for units in ("si", "us"))
    for draw in (draw_comparison, draw_error, draw_cycle_bias):
        assert "[lbf]" in draw(us)[0].layout["yaxis"]["title"]["text"]
    one, other = (
        numbers(traces(draw_comparison(each)[0])["predicted"]["y"])[-1] for each in (si, us)
    )
    assert one / other == pytest.approx(POUND, rel=1e-4)
    assert "bias [lbf]" in compared_curve_table(us).columns


@pytest.mark.parametrize("named", [agreeing, differing, trading])
def test_plotly_takes_every_figure_and_nothing_is_unlabelled(named):
    one = named()
    for figure in all_figures(view(one, synthetic="yes")):
        go.Figure(json.loads(figure.json()))
        assert figure.synthetic
        assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
        assert "[" in figure.layout["xaxis"]["title"]["text"]
        assert "[" in figure.layout["yaxis"]["title"]["text"]


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    named = (agreeing(), differing(), trading(), replace(agreeing(), name=NASTY))
    write_archive(dataset(*named), folder / "p" / "comparisons.nc")
    return write_report(folder / "p", folder / "r").read_text(encoding="utf-8")


def test_a_campaign_of_comparisons_alone_has_a_page(page):
    assert "SYNTHETIC DATA" in page
    for name in ("alike", "apart", "trade"):
        assert f'<h2 id="comparison-{["alike", "apart", "trade"].index(name)}">' in page
        assert f"Comparison {name}" in page
    assert page.index("Tests compared with their predicted hoses") < page.index('id="wrong"')
    assert page.index("The prediction differs by") < page.index('id="comparison-0"')
    assert 'id="comparisons-relative"' in page


def test_names_cannot_leave_their_place(page):
    assert "alert(1)</script>" not in page
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in page


def test_an_archive_that_cannot_be_read_is_told_and_the_rest_stands(tmp_path):
    (tmp_path / "p").mkdir()
    (tmp_path / "p" / "comparisons.nc").write_bytes(b"no archive")
    page = write_report(tmp_path / "p", tmp_path / "r").read_text(encoding="utf-8")
    assert "comparisons.nc" in page and "This file cannot be shown" in page


def test_the_terminal_begins_with_synthetic_and_the_verdict_and_warnings_stand_below(capsys):
    _show_comparison(replace(trading(), is_synthetic=True), CommandOutput())
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "SYNTHETIC DATA: no specimen was tested."
    assert said[1].startswith("D-64 of hose-64 (dynamic) against H64: ")
    table = next(place for place, line in enumerate(said) if "predicted less measured" in line)
    assert all(line.startswith("warning: ") for line in said[2:table])
    assert any("cannot separate cord_load_scale" in line for line in said[2:table])
    assert not any("cannot separate" in line for line in said[table:])
