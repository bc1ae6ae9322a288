"""Strength and life on the page: what stands in it, and that nothing stands without data."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import plotly.graph_objects as go
import pytest
import xarray as xr
from pagefigures import figures_of
from reportparts import column, texts

from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.rope_properties import properties_to_dataset
from reduction.archive.write import write_archive
from reduction.experiments.outcome_groups import Group
from reduction.experiments.outcomes import Outcome
from reduction.record.contributions import Component
from reduction.record.measurement import Origin, Source, Step
from reduction.report.campaign_page import write_report
from reduction.report.campaign_sections import (
    _make_outcome_section,
    _make_rope_section,
    _rope_tiles,
)
from reduction.report.client_report import _results
from reduction.report.figures.hold_figures import draw_creep, draw_held_pairs, draw_stiffness
from reduction.report.outcome_tables import (
    answer_of_ropes,
    creep_table,
    draw_exposure,
    draw_lives,
    exposure_table,
    fatigue_table,
    level_table,
    load_life_table,
    pair_table,
    property_table,
    snap_sentences,
    snap_table,
    strength_table,
)
from reduction.report.product_views import OutcomeView, group_names, line_of, view_ropes
from reduction.report.test_view import TestView
from reduction.report.text_style import NOT_GIVEN
from reduction.stages.three_parameter_line.change_in_length import PROPERTY_NAMES, ChangeInLength

LBF = 4.4482216152605
# 6500 lbf - 600 lbf a year, and 100 lbf about it
BREAKS = [
    Outcome("tensile_strength", LBF * (6500 - 600 * years + about), line="PD", exposure=years,
            condition="worn" if years else "new")
    for years in (0.0, 2.0, 4.0)
    for about in (-100.0, 100.0)
]  # fmt: skip
SPLICE = Outcome("tensile_strength", 5000 * LBF, line="PD", exposure=2.0, condition="worn",
                 place="splice", is_valid=False)  # fmt: skip
CYCLES = [
    Outcome("cycles_to_failure", lives, line="N8", minimum_load_ratio=0.0, peak_load_ratio=load)
    for load, of_load in {0.7: (4e3, 5e3, 7e3), 0.5: (3e4, 4e4, 5e4)}.items()
    for lives in of_load
]
SURVIVED = [
    Outcome("cycles_to_failure", 2e5, line="N8", minimum_load_ratio=0.0, peak_load_ratio=0.27,
            is_suspended=True)
] * 3  # fmt: skip


def view(outcomes, synthetic="", units="us"):
    return OutcomeView(tuple(outcomes), {"synthetic": synthetic}, units)


def test_strength_has_its_change_against_new_with_an_interval():
    table = strength_table(view([*BREAKS, SPLICE]), "tensile_strength")
    assert column(table, "group") == ["PD, new, 0 years", "PD, worn, 2 years", "PD, worn, 4 years"]
    # two breaks 100 to either side of their mean: 100 of it, times 12.71 for one degree of freedom
    assert column(table, "mean tensile strength [lbf]")[0] == "6,500 ± 1,300"
    assert "k = " in table.remarks[0] and "12.71)" in table.remarks[0]
    assert column(table, "change against new [%]")[1].startswith("-18.5 ± ")
    assert " to " in column(table, "interval of the change")[1]
    assert column(table, "lower bounds") == [NOT_GIVEN, "1", NOT_GIVEN]


def test_a_column_in_which_nothing_stands_is_left_out():
    table = strength_table(view(BREAKS[:2]), "tensile_strength")
    assert not [name for name in table.columns if "change" in name or "bounds" in name]
    assert strength_table(view(BREAKS), "strain_at_failure") is None
    assert exposure_table(view(BREAKS[:2])) is None
    assert fatigue_table(view(BREAKS), "cycles_to_failure") is None
    assert load_life_table(view(BREAKS)) is None and snap_table(view(BREAKS)) is None


def test_what_is_missing_is_told_below_with_its_group():
    table = strength_table(view([BREAKS[0], *BREAKS[2:4]]), "tensile_strength")
    assert any(
        remark.startswith("PD, new, 0 years: fewer than two values") for remark in table.remarks
    )
    lives = fatigue_table(view([*CYCLES, *SURVIVED]), "cycles_to_failure")
    assert "N8 at 27 %: no failure: only a lower bound can be given." in lives.remarks


def test_a_level_without_failure_has_a_count_and_no_life():
    lives = fatigue_table(view([*CYCLES, *SURVIVED]), "cycles_to_failure")
    assert column(lives, "its interval")[0] == NOT_GIVEN
    assert " to " in column(lives, "its interval")[1]
    assert column(lives, "stopped") == ["3", NOT_GIVEN, NOT_GIVEN]


def test_strength_against_exposure_is_points_a_line_and_its_band():
    (figure,) = draw_exposure(view([*BREAKS, SPLICE], synthetic="yes"))
    names = [trace["name"] for trace in figure.data]
    assert names == ["95 % interval", "fitted line", "breaks", "at least"]
    line, breaks, bound = figure.data[1:]
    assert (line["x"][0], line["x"][-1]) == (0.0, 4.0)
    assert line["y"][0] == pytest.approx(6500) and line["y"][-1] == pytest.approx(4100)
    assert len(breaks["x"]) == 6 and bound["y"] == [5000.0]
    assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
    table = exposure_table(view(BREAKS))
    assert column(table, "change per year [lbf/year]")[0].startswith("-600 ± ")


def test_breaks_without_a_line_are_shown_and_the_reason_told():
    few = [BREAKS[0], BREAKS[2]]
    (figure,) = draw_exposure(view(few))
    assert [trace["name"] for trace in figure.data] == ["breaks"]
    assert (
        "PD: two exposures with one break each leave no scatter."
        in exposure_table(view(few)).remarks
    )


def test_run_outs_are_arrows_and_the_line_ends_at_the_loads_tested():
    (figure,) = draw_lives(view([*CYCLES, *SURVIVED]))
    traces = {trace["name"]: trace for trace in figure.data}
    assert list(traces) == ["95 % bounds", "median life", "failed", "at least"]
    assert traces["at least"]["marker"]["symbol"] == "arrow-up"
    assert traces["at least"]["x"] == [27.0] * 3 and traces["at least"]["y"] == [2e5] * 3
    assert (traces["median life"]["x"][0], traces["median life"]["x"][-1]) == (27.0, 70.0)
    assert figure.layout["yaxis"]["type"] == "log"


def test_conditions_of_a_line_share_a_figure_and_lines_do_not():
    worn = [Outcome("cycles_to_failure", 9e3, line="N8", condition="worn", peak_load_ratio=0.5)]
    other = [Outcome("cycles_to_failure", 9e3, line="PD", peak_load_ratio=0.5)]
    first, second = draw_lives(view([*CYCLES, *worn, *other]))
    assert "N8, worn: failed" in [trace["name"] for trace in first.data]
    assert [trace["name"] for trace in second.data] == ["failed"]


def test_where_failures_begin_is_said_for_lines_that_go_slack():
    table = snap_table(view([*CYCLES, *SURVIVED]))
    assert column(table, "peak load") == ["27.0", "50.0", "70.0"]
    # 1 - 0.05^(1/3)
    assert column(table, "share failing") == ["63", NOT_GIVEN, NOT_GIVEN]
    (sentence,) = snap_sentences(view([*CYCLES, *SURVIVED]))
    assert sentence.startswith("N8: no failure up to 27 %, the first at 50 %")
    below = [Outcome("cycles_to_failure", 9e3, line="N8", minimum_load_ratio=0.0,
                     peak_load_ratio=0.2)]  # fmt: skip
    only, note = snap_sentences(view([*SURVIVED, *below]))
    assert only.startswith("N8: the first at 20 %")
    assert note.startswith("N8: a line failed at 20 %")


def test_names_say_in_what_groups_differ():
    one = Group("", "nylon", "plaited", 0.0127, "new", None)
    two = Group("", "nylon", "plaited", 0.0254, "new", 1.0)
    assert group_names([one, two], "us") == ["nylon, 0.5 in", "nylon, 1 in, 1 year"]
    assert group_names([Group("", "", "", None, "", None)], "si") == ["not named"]
    assert group_names([], "si") == []
    assert line_of(two) == Group("", "nylon", "plaited", 0.0254, "", None)


def test_parts_without_data_are_left_out():
    section = _make_outcome_section(view(BREAKS[:2]))
    assert [part.heading for part in section.parts] == ["Strength"]
    assert section.subtitle == "2 outcomes without a log: 2 used as values"
    everything = _make_outcome_section(
        view([*BREAKS, SPLICE, *CYCLES, Outcome("abrasion_cycles", 7e3)])
    )
    assert [part.heading for part in everything.parts] == [
        "Strength", "Strength against exposure", "Cycles to failure", "Lines that go slack",
        "Abrasion",
    ]  # fmt: skip


@pytest.fixture
def page(tmp_path):
    dataset = outcomes_to_dataset(
        [*BREAKS, SPLICE, *CYCLES, *SURVIVED],
        origin=Origin(
            campaign_id="lines", attributes={"title": "Lines <b>&", "synthetic": "yes"},
            sources=(Source("results.csv", "ab" * 32, 1),), steps=(Step("outcomes", "rows"),),
            settings_json='{"results": "results.csv"}', version="1", command="",
        ),
    )  # fmt: skip
    write_archive(dataset, tmp_path / "lines" / "outcomes.nc")
    return lambda: write_report(tmp_path / "lines", tmp_path / "out", units="us")


def test_outcomes_alone_are_a_page_without_parts_of_tests(page):
    html = page().read_text(encoding="utf-8")
    assert '<h2 id="outcomes">Strength and life</h2>' in html
    assert 'id="tested"' not in html and 'href="#tested"' not in html
    assert "Lines &lt;b&gt;&amp;" in html and "Lines <b>" not in html
    assert "SYNTHETIC DATA" in html and "16 outcomes without a log" in html.replace(
        "<strong>16</strong>", "16"
    )
    assert "ab" * 32 in html  # the hash of the table of results


def test_the_same_archive_gives_the_same_page(page):
    assert page().read_bytes() == page().read_bytes()


def test_an_archive_that_cannot_be_read_is_told_and_not_shown(page, tmp_path):
    page()
    (tmp_path / "lines" / "outcomes.nc").write_bytes(b"no netCDF")
    html = page().read_text(encoding="utf-8")
    assert "outcomes.nc" in html and 'id="outcomes"' not in html


def test_figures_are_on_the_page_as_a_script_reads_them(page):
    assert figures_of(page())["outcomes-lives-0"]["data"]


# the section of a rope's programme: every property, and why one is missing; figures that draw

FOUND = {
    "R-1": (
        ChangeInLength("original stiffness", 3e5, 300.0, 3.0, 3e-3, 10.0, 3e4, step="B",
                       reason="of the first cycle"),
        ChangeInLength("static stiffness", 5e5, 60.0, 5.0, 6e-4, 1e4, 3e4, 600.0, "Q"),
        ChangeInLength("dynamic stiffness", 1e6, 900.0, 10.0, 9e-3, 5e3, 1.5e4, step="D",
                       degrees_of_freedom=9.0),
        ChangeInLength("dynamic stiffness", 1.3e6, 900.0, 13.0, 9e-3, 1.5e4, 2.5e4, step="E"),
        ChangeInLength("construction strain", reason="there is no bedding-in step"),
        ChangeInLength("polymer strain", 0.0012, 1e-5, low_tension=3e4, high_tension=3e4,
                       reference_time=600.0, step="Q"),
        ChangeInLength("working strain", 0.04, 1e-5, low_tension=1e4, high_tension=3e4,
                       reference_time=600.0, step="Q"),
    ),
    "R-2": tuple(ChangeInLength(name, reason="no step") for name in PROPERTY_NAMES),
}  # fmt: skip


def dataset(synthetic="yes"):
    origin = Origin(
        campaign_id="ropes",
        attributes={"title": "Ropes", "synthetic": synthetic},
        sources=[Source("Q.nc", "0" * 64, 12)],
        steps=[Step("change in length", "made for a test")],
        settings_json=json.dumps({"tests": {"R-1": ["D", "Q", "gone"], "R-2": []}}),
        version="0",
        command="reduction run",
    )
    return properties_to_dataset(FOUND, {}, origin=origin)


def level():
    data = {
        "dynamic_mean_tension": [1e4, 2e4],
        "dynamic_tension_amplitude": [5e3, 5e3],
        "dynamic_cycles": [10, 10],
        "dynamic_stiffness": [1e6, 2e6],
        "dynamic_stiffness_standard_uncertainty": [900.0, 900.0],
    }
    variables = {name: ("specimen", np.array(values)) for name, values in data.items()}
    names = {"specimen": ["R-1", "R-9"], "specimen_kind": ["rope", "rope"]}
    texts = {name: ("specimen", values) for name, values in names.items()}
    return xr.Dataset(texts | variables, attrs={"test": "D"})


def held():
    along = {
        "held_pair_specimen": ["R-1", "R-1"],
        "held_pair_low_tension": [1e4, 3e4],
        "held_pair_high_tension": [3e4, 4e4],
        "static_reference_time": [600.0, np.nan],
        "static_stiffness": [5e5, np.nan],
        "static_stiffness_per_decade": [-1.5e4, np.nan],
        "static_refusal": ["", "the lower hold has no strain"],
    }
    of_hold = {
        "hold_specimen": ["R-1", "R-1"],
        "hold_start_time": [100.0, 8000.0],
        "hold_duration": [3600.0, 20.0],
        "hold_ramp_centre_time": [90.0, np.nan],
        "hold_initial_tension": [3e4, 4e4],
        "hold_final_tension": [3e4, 4e4],
        "creep_rate_per_decade": [0.0012, np.nan],
        "creep_tension_over_strength": [0.3, 0.4],
        "hold_refusal": ["", "too short"],
    }
    times = np.array([1.0, 600.0, 3600.0])
    return xr.Dataset(
        {
            "specimen": ("specimen", ["R-1"]),
            "specimen_kind": ("specimen", ["rope"]),
            "hold_time": ("hold_time", times),
        }
        | {name: ("held_pair", np.array(values)) for name, values in along.items()}
        | {name: ("hold", np.array(values)) for name, values in of_hold.items()}
        | {
            "static_elapsed_time": (("held_pair", "point"), [[60.0, 3600.0], [np.nan] * 2]),
            "static_stiffness_at_time": (("held_pair", "point"), [[515e3, 488e3], [np.nan] * 2]),
            "strain_at_time": (
                ("hold", "hold_time"),
                [0.05 + 0.0012 * np.log10(times + 10), [0.06, np.nan, np.nan]],
            ),
        },
        attrs={"test": "Q"},
    )


@pytest.fixture
def ropes():
    return view_ropes(dataset(), views(), "si")


def views():
    return {"D": TestView("test-0", level()), "Q": TestView("test-1", held())}


def test_a_rope_has_its_steps_in_order_and_those_without_an_archive_are_left_out(ropes):
    first, second = ropes
    assert [test.id for test in first.tests] == ["D", "Q"]
    assert second.tests == ()
    assert "D, Q" in _make_rope_section(first).subtitle


def test_the_report_to_a_client_has_each_step_of_the_programme(ropes):
    section = _make_rope_section(ropes[0])
    whole = SimpleNamespace(ropes=((ropes[0], section),), answers=[])
    content = SimpleNamespace(tests=(), sections=(), whole=whole)
    of_rope = [table for part in section.parts for table in part.tables]
    assert len(of_rope) > 2
    found = _results(content)
    assert [table.rows for table in found] == [table.rows for table in of_rope]
    assert all(table.caption.startswith(f"{section.title}: ") for table in found)


def test_every_property_is_a_row_and_a_missing_one_has_its_reason(ropes):
    table = property_table(ropes[0])
    assert [row[0] for row in texts(table)] == [one.name for one in FOUND["R-1"]]
    by_name = {row[0]: row for row in texts(table)}
    assert by_name["static stiffness"][1:4] == ["10,000 to 30,000", "600.0", "500,000 ± 120"]
    # ten cycles: t of nine degrees of freedom is 2.262, where many samples have 1.960
    assert by_name["dynamic stiffness"][3] in ("1,000,000 ± 2,000", "1,300,000 ± 1,800")
    assert by_name["polymer strain"][1] == "30,000"
    assert by_name["construction strain"][5] == NOT_GIVEN
    assert table.remarks[0] == "original stiffness, B: of the first cycle"
    part = _make_rope_section(ropes[0]).parts[0]
    assert part.refusals == ("construction strain: there is no bedding-in step",)


def test_the_answer_has_a_row_a_rope(ropes):
    rows = texts(answer_of_ropes(ropes))
    assert rows[0][:4] == ["R-1", "300,000 ± 590", "500,000 ± 120", "1,000,000 to 1,300,000"]
    assert set(rows[1][1:]) == {NOT_GIVEN}
    assert answer_of_ropes([]) is None
    assert _rope_tiles([]) == []
    assert _rope_tiles(ropes)[0].number == "2"


def test_tables_of_steps_are_of_this_rope_alone(ropes):
    table = level_table(ropes[0])
    assert texts(table) == [["D", "10,000", "5,000", "10", "1,000,000 ± 2,000"]]
    assert level_table(ropes[1]) is None
    assert texts(creep_table(ropes[0]))[1][-1] == "too short"


def test_figures_draw_what_has_a_number(ropes):
    figures = [draw(ropes[0])[0] for draw in (draw_stiffness, draw_held_pairs, draw_creep)]
    for figure in figures:
        go.Figure({"data": figure.data, "layout": figure.layout})
        assert figure.synthetic
    stiffness, static, creep = figures
    assert [trace["name"] for trace in stiffness.data] == [
        "original stiffness", "static stiffness", "dynamic stiffness",
    ]  # fmt: skip
    assert stiffness.data[2]["error_x"]["array"] == [5e3, 5e3]
    # the refused pair and the short hold are not drawn
    assert len(static.data) == 3
    assert len(creep.data) == 2
    # strain is gained from the reference time on
    points, law = creep.data
    assert points["y"][1] == pytest.approx(100 * 0.0012 * np.log10(610 / 600), abs=1e-6)
    assert law["y"][-1] == pytest.approx(100 * 0.0012 * np.log10(3610 / 600), abs=1e-6)
    for draw in (draw_stiffness, draw_held_pairs, draw_creep):
        assert draw(ropes[1]) == []


def test_what_a_page_keeps_of_a_test_is_enough_for_the_figures_and_tables_of_its_rope(ropes):
    kept = {name: view.of_campaign({}) for name, view in views().items()}
    (of_kept, _) = view_ropes(dataset(), kept, "si")
    for draw in (draw_stiffness, draw_held_pairs, draw_creep):
        assert repr([one.data for one in draw(of_kept)]) == repr(
            [one.data for one in draw(ropes[0])]
        )
    for table in (level_table, pair_table, creep_table):
        assert texts(table(of_kept)) == texts(table(ropes[0]))


def test_properties_alone_are_a_page(tmp_path):
    write_archive(dataset(), tmp_path / "change_in_length.nc")
    html = write_report(tmp_path, tmp_path / "out").read_text(encoding="utf-8")
    assert 'id="rope-0"' in html
    assert "Programme of rope R-1" in html
    assert "construction strain: there is no bedding-in step" in html


def test_a_property_that_knows_its_instruments_says_so_and_has_the_factor_of_both(ropes):
    (one,) = [one for one in FOUND["R-1"] if one.step == "D"]
    cell = Component("tension_gain", "load cell")
    known = replace(one, random_standard_uncertainty=1.0, contribution=np.array([900.0]))
    origin = Origin("ropes", {"synthetic": "yes"}, [Source("Q.nc", "0" * 64, 12)],
                    [Step("change in length", "made for a test")],
                    json.dumps({"tests": {"R-1": ["D"]}}), "0", "reduction run")  # fmt: skip
    made = properties_to_dataset({"R-1": (known,)}, {("R-1", "D"): (cell,)}, origin=origin)
    (view,) = view_ropes(made, {}, "si")
    # the scatter of ten cycles is nothing beside the gain: 1.960 and not 2.262
    assert texts(property_table(view))[0][3] == "1,000,000 ± 1,800"
    assert property_table(view).remarks[-1].endswith("errors common to all samples: tension gain.")
    assert "load-cell calibration" in property_table(ropes[0]).remarks[-1]
