"""The section of a rope's programme: every property, and why one is missing; figures that draw."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import plotly.graph_objects as go
import pytest
import xarray as xr

from reduction.archive.rope_properties import properties_to_dataset
from reduction.archive.write import write_archive
from reduction.record.contributions import Component
from reduction.record.measurement import Origin, Source, Step
from reduction.report.campaign_page import write_report
from reduction.report.campaign_sections import _make_rope_section, _rope_tiles
from reduction.report.client_report import _results
from reduction.report.figures.hold_figures import draw_creep, draw_held_pairs, draw_stiffness
from reduction.report.outcome_tables import (
    answer_of_ropes,
    creep_table,
    level_table,
    pair_table,
    property_table,
)
from reduction.report.product_views import view_ropes
from reduction.report.test_view import TestView
from reduction.report.text_style import NOT_GIVEN
from reduction.stages.three_parameter_line.change_in_length import PROPERTY_NAMES, ChangeInLength

FOUND = {
    "R-1": (
        ChangeInLength("original stiffness", 3e5, 300.0, 3.0, 3e-3, 10.0, 3e4, step="B",
                       reason="of the first cycle"),
        ChangeInLength("static stiffness", 5e5, 60.0, 5.0, 6e-4, 1e4, 3e4, 600.0, "Q"),
        ChangeInLength("dynamic stiffness", 1e6, 900.0, 10.0, 9e-3, 5e3, 1.5e4, step="D",
                       degrees_of_freedom=9.0),
        ChangeInLength("dynamic stiffness", 1.3e6, 900.0, 13.0, 9e-3, 1.5e4, 2.5e4, step="E"),
        ChangeInLength("construction strain", reason="no step beds the rope in"),
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


def texts(table):
    return [[cell.text for cell in row] for row in table.rows]


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
    assert part.refusals == ("construction strain: no step beds the rope in",)


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
    assert "construction strain: no step beds the rope in" in html


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
