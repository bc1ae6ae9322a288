"""Section of one test on the page."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from long_records import cycles_of, long_test
from reportparts import texts

from reduction.archive.test_dataset import kept_samples, stored_cycles, to_dataset
from reduction.record.contributions import InstrumentErrors
from reduction.record.settings import ModulusSettings, ReductionSettings, _ArchiveSettings
from reduction.report.answer_tables import answer_budgets, budget_table
from reduction.report.campaign_summary import brief
from reduction.report.figure_data import with_gaps
from reduction.report.figures.cycle_figures import draw_loops
from reduction.report.figures.modulus_figures import draw_steps
from reduction.report.figures.record_figures import draw_record, draw_tension_position
from reduction.report.test_section import MOST, _cycle_links, design_tables, interval_table
from reduction.report.test_view import NOTHING_STATED, TestView
from reduction.report.text_style import NOT_GIVEN
from reduction.stages.moduli.stepwise_test import StepReadings, reduce_stepwise
from reduction.uncertainty.errors_of_cycles import with_shared_steps


def make_view(test, bins, ascending, descending, *, units="si", specimen="new", half=0.01e6):
    """A test of one specimen; moduli in MPa, the standard uncertainty of every bin the same.

    Ten cycles reach every bin: what is shown is 2.262 times as much.
    """
    modulus = 1e6 * np.array([[ascending, descending]], dtype=np.float64)
    dims = ("specimen", "branch_name", "strain_bin")
    data = xr.Dataset(
        {
            "tangent_modulus": (dims, modulus),
            "tangent_modulus_standard_uncertainty": (dims, np.full(modulus.shape, half)),
            "tangent_modulus_count": (dims, np.full(modulus.shape, 10)),
        },
        coords={
            "specimen": [specimen],
            "branch_name": ["ascending", "descending"],
            "strain_bin": np.asarray(bins, dtype=np.float64),
        },
        attrs={"test": test},
    )
    return TestView(test, data, units)


def test_a_value_between_two_bins_is_on_the_straight_line_between_them():
    # 100 % is three quarters of the way from 0.97 to 1.01
    bins = [0.89, 0.93, 0.97, 1.01]
    (table,) = design_tables([make_view("T-1", bins, [1, 1, 1, 1.4], [2, 2, 2, 2.8])])
    assert table.columns == ("strain [%]", "T-1 [MPa]")
    assert texts(table) == [["100", "1.30 ± 0.02 /\n2.60 ± 0.02"]]
    assert [float(one) for one in table.rows[0][1].value.split()] == pytest.approx([1.3e6, 2.6e6])


def test_nothing_is_extrapolated_and_no_gap_is_bridged():
    bins = np.arange(0.76, 1.265, 0.02)
    rising = np.linspace(1, 2, bins.size)
    gap = np.where(np.abs(bins - 1.0) < 0.03, np.nan, rising)
    (table,) = design_tables([make_view("T-1", bins, gap, rising)])
    # 75 % is below the first bin; 125 % lies between the last two; 100 % is in the gap of one
    assert [row[0] for row in texts(table)] == ["100", "125"]
    assert texts(table)[0][1].startswith(f"{NOT_GIVEN} /\n1.4")
    assert table.rows[0][1].value.startswith("nan ")


def test_a_test_that_reaches_no_round_strain_has_no_column_and_a_strain_not_reached_a_dash():
    low = make_view("T-1", [0.74, 0.76], [1, 1], [1, 1])
    high = make_view("T-3", [1.49, 1.51], [3, 3], [3, 3])
    between = make_view("T-2", [1.10, 1.12], [2, 2], [2, 2])
    (table,) = design_tables([low, between, high])
    assert table.columns == ("strain [%]", "T-1 [MPa]", "T-3 [MPa]")
    assert [row[0] for row in texts(table)] == ["75", "150"]
    assert [row[2].text for row in table.rows] == [NOT_GIVEN, "3.00 ± 0.02 /\n3.00 ± 0.02"]
    assert table.rows[0][2].is_number


def test_each_specimen_has_a_table_and_each_table_says_what_the_plus_minus_is():
    views = [
        make_view("T-1", [0.74, 0.76], [1, 1], [1, 1]),
        make_view("T-2", [0.74, 0.76], [1, 1], [1, 1], specimen="used"),
    ]
    tables = design_tables(views)
    assert [table.caption.split(":")[0] for table in tables] == ["new", "used"]
    for table in tables:
        assert table.remarks == (
            "±: expanded uncertainty, 95 % (k = 2.26): scatter between cycles, noise, regression. No"
            " instrument errors are stated: the uncertainty includes only scatter.",
        )


def test_in_us_units_the_modulus_is_in_psi():
    (table,) = design_tables(
        [make_view("T-1", [0.74, 0.76], [1, 1], [1, 1], units="us", half=np.nan)]
    )
    # 1 MPa is 145.04 psi
    assert table.columns[1] == "T-1 [psi]"
    assert texts(table) == [["75", "145.0 /\n145.0"]]


def test_a_stiff_specimen_is_read_at_finer_strains():
    bins = np.arange(0.0005, 0.025, 0.001)
    (table,) = design_tables([make_view("rope", bins, 100 + bins, 100 + bins)])
    assert [row[0] for row in texts(table)] == ["1", "2"]


def test_a_test_of_one_bin_is_read_at_that_bin_alone():
    (table,) = design_tables([make_view("T-1", [1.0], [2.0], [3.0])])
    assert texts(table) == [["100", "2.00 ± 0.02 /\n3.00 ± 0.02"]]
    assert not design_tables([make_view("T-1", [1.004], [2.0], [3.0])])


def test_without_a_modulus_there_is_no_table():
    assert design_tables([]) == []
    assert design_tables([make_view("T-1", [], [], [])]) == []


# the cycles that a reader can choose on the page, and the line that says what is in a test


def view_of(start, frequency, **more):
    start, frequency = np.atleast_2d(start), np.atleast_2d(frequency)
    dims = ("specimen", "cycle")
    return TestView(
        "test-0",
        xr.Dataset(
            {"cycle_start_time": (dims, start), "frequency": (dims, frequency), **more},
            coords={"cycle": np.arange(1, start.shape[1] + 1)},
        ),
    )


def test_a_cycle_lasts_from_its_start_for_one_period():
    found = _cycle_links(view_of([100.0, 110.0, 135.0], [0.1, 0.04, 0.2]))
    assert found.count == 3
    np.testing.assert_allclose(found.end - found.start, [10, 25, 5])


def test_a_cycle_that_one_specimen_did_not_see_is_timed_by_the_other():
    found = _cycle_links(view_of([[0.0, np.nan], [0.0, 4.0]], [[0.25, np.nan], [0.25, 0.25]]))
    np.testing.assert_array_equal(found.start, [0.0, 4.0])
    np.testing.assert_array_equal(found.end, [4.0, 8.0])


def test_a_cycle_whose_time_nobody_knows_has_none_on_the_page():
    found = _cycle_links(view_of([0.0, np.nan, 8.0], [0.25, 0.25, np.nan]))
    assert json.loads(found.json()) == {
        "count": 3, "start": [0.0, None, 8.0], "end": [4.0, None, None],
    }  # fmt: skip


@pytest.mark.parametrize("view", [
    view_of([1.0], [0.1]),
    TestView("test-0", xr.Dataset(coords={"cycle": [1, 2, 3]})),
    TestView("test-0", xr.Dataset()),
])  # fmt: skip
def test_without_two_cycles_or_their_times_there_is_nothing_to_choose(view):
    assert _cycle_links(view) is None


def test_of_very_many_cycles_the_first_the_last_and_those_with_a_curve_are_listed():
    n_cycles = 100_000
    drawn = [1.0, 54_321.0, 99_999.0]
    found = _cycle_links(
        view_of(10.0 * np.arange(n_cycles), np.full(n_cycles, 0.1), selected_cycle=("kept", drawn))
    )
    assert found.count == n_cycles
    assert MOST <= found.number.size <= MOST + 6
    assert {1, 54_321, 99_999, 50_000, n_cycles} <= set(found.number)
    assert np.diff(found.number).max() <= np.ceil(n_cycles / (MOST - 1))
    np.testing.assert_allclose(found.start, 10.0 * (found.number - 1))
    assert len(found.json()) < 150_000


def test_a_line_says_how_many_cycles_of_which_strain_and_what_is_doubted():
    view = view_of(
        [0.0, 1.0], [1.0, 1.0],
        mean_strain=(("specimen", "cycle"), [[1.0, 1.0]]),
        strain_amplitude=(("specimen", "cycle"), [[0.25, 0.25]]),
        note=("note", ["tests: a plain note"]), note_stage=("note", ["tests"]),
        note_code=("note", ["plain"]), note_severity=("note", ["note"]),
        note_effect=("note", [np.nan]),
    )  # fmt: skip
    assert brief(view) == "2 cycles, strain 75.0 to 125.0 %"
    doubted = replace(view, data=view.data.assign(note_severity=("note", ["warning"])))
    assert brief(doubted) == "2 cycles, strain 75.0 to 125.0 %, check"


def test_a_line_says_nothing_of_what_is_not_there():
    assert brief(TestView("test-0", xr.Dataset())) == ""


# A record of which some cycles are stored: nothing is drawn across the others


def view_of_parts(test, samples="selected", longest=10**6):
    chosen = ReductionSettings(
        archive=_ArchiveSettings(samples, longest), modulus=ModulusSettings(selected_cycles=8)
    )
    kept = kept_samples(test, chosen)
    return TestView("test-0", to_dataset(test, version="1", command="run", kept=kept))


def lines(figure):
    for trace in figure.data:
        if trace["mode"] == "lines":
            yield from pairwise(zip(trace["x"], trace["y"], strict=True))


def test_a_line_of_the_record_never_joins_samples_between_which_cycles_are_left_out():
    test = long_test()
    view = view_of_parts(test)
    (figure,) = draw_record(view)
    joined = [
        (round(10 * one[0]), round(10 * other[0]))
        for one, other in lines(figure)
        if None not in (*one, *other)
    ]
    assert len(joined) > 1000
    is_left = np.ones(test.record.n_samples, dtype=bool)
    is_left[view.data["sample_index"]] = False
    assert not any(is_left[one : other + 1].any() for one, other in joined)
    assert "of the 2,451 samples 614 are stored; the line is broken" in figure.caption.lower()


@pytest.mark.parametrize("n_cycles", [100, 2_000, pytest.param(20_000, marks=pytest.mark.nightly)])
def test_tension_against_position_is_drawn_piece_by_piece(n_cycles):
    cycles = cycles_of(n_cycles, rest=4)
    test = long_test(cycles=cycles)
    # six digits of a position are drawn: here they are its place in the record
    places = 100_000.0 + np.arange(test.record.n_samples)
    test = replace(test, record=replace(test.record, crosshead_position=places))
    (figure,) = draw_tension_position(view_of_parts(test))
    joined = [
        (one[0] - 100_000, other[0] - 100_000)
        for one, other in lines(figure)
        if None not in (*one, *other)
    ]
    assert len(joined) > 100
    crossed = [
        np.flatnonzero((cycles.first >= one) & (cycles.last <= other)) + 1 for one, other in joined
    ]
    assert set(np.concatenate(crossed)) <= set(stored_cycles(view_of_parts(test).data))


def test_a_line_is_broken_where_one_cycle_alone_is_left_out():
    # its first sample is the last of the cycle before it, and its last the first of the next one
    test = long_test(9)
    view = view_of_parts(test)
    assert stored_cycles(view.data).tolist() == [1, 2, 3, 5, 7, 8, 9]
    jump, other = np.flatnonzero(np.diff(view.pieces))
    index = view.data["sample_index"].values
    assert index[jump] == test.cycles.first[3] and index[jump + 1] == test.cycles.last[3]
    assert index[other] == test.cycles.first[5] and index[other + 1] == test.cycles.last[5]


def test_loops_are_those_of_the_nearest_cycles_that_are_stored():
    test = long_test()
    for figure in draw_loops(view_of_parts(test)):
        assert {trace["legendgroup"] for trace in figure.data} == {
            "cycle 1", "cycle 32", "cycle 100",
        }  # fmt: skip
        assert "of those whose samples are stored" in figure.caption
    for figure in draw_loops(view_of_parts(test, "all")):
        assert {trace["legendgroup"] for trace in figure.data} == {
            "cycle 1", "cycle 50", "cycle 100",
        }  # fmt: skip
        assert "stored" not in figure.caption


def test_a_thinned_stretch_is_one_line():
    view = view_of_parts(long_test(n_samples=50_000), longest=4000)
    assert not view.is_whole
    assert not view.pieces.any()


def test_series_of_one_piece_are_drawn_as_they_are():
    values = np.arange(4.0)
    (found,) = with_gaps(np.zeros(4, dtype=int), values)
    np.testing.assert_array_equal(found, values)


# A test with weights: what its ± holds, where that comes from, and the tension of its readings

INCH, POUND = 0.0254, 4.4482216
AREA = np.pi / 4 * 0.0257**2


@pytest.fixture
def weighed(stepwise_test):
    """Six readings that scatter by a sixteenth of an inch, with elongations as recorded."""
    length = INCH * np.array([6.125, 9.19, 12.25, 15.31, 18.38, 15.25])
    readings = StepReadings(
        ("1100", "1110", "1120", "1130", "1140", "1150"), 600.0 * np.arange(6.0),
        POUND * np.array([0.0, 40.0, 80.0, 120.0, 160.0, 120.0]), length, np.full(6, np.nan),
        np.array([0.0, 0.5, 1.0, 1.5, 2.0, 1.5]),
    )  # fmt: skip
    found = reduce_stepwise(readings, area=AREA)
    return replace(stepwise_test, stepwise=found, contributions=None)


def view_of_stepwise(test, errors, **stated):
    told = {"uncertainty": stated} if stated else {}
    test = replace(with_shared_steps(test, (errors,)), settings_json=json.dumps(told))
    return TestView("static", to_dataset(test, version="1", command="reduction run"), "si")


def test_a_stated_gain_and_diameter_are_among_what_the_page_says_it_holds(weighed):
    errors = InstrumentErrors("tether", tension_gain=0.02, diameter=1e-3)
    view = view_of_stepwise(weighed, errors, tension_gain=0.02, diameter=1e-3)
    said = " ".join(interval_table(view).remarks)
    for held in ("tension gain", "diameter", "gauge length"):
        assert held in said
    assert "Not included" not in said and NOTHING_STATED not in said
    assert "all samples: " + said.split("all samples: ")[1] in draw_steps(view)[1].caption


def test_where_nothing_is_stated_the_gauge_length_of_the_readings_is_in_it_alone(weighed):
    view = view_of_stepwise(weighed, InstrumentErrors("tether"))
    (said,) = interval_table(view).remarks
    assert "common to all samples: gauge length." in said and NOTHING_STATED in said


def test_the_bars_of_a_test_with_weights_are_those_of_its_intervals(weighed):
    view = view_of_stepwise(
        weighed, InstrumentErrors("tether", tension_gain=0.02), tension_gain=0.02
    )
    answers = answer_budgets(view)
    assert [one.words for one in answers][:2] == ["1100 to 1110", "1110 to 1120"]
    spread = view.array("interval_modulus_standard_uncertainty")[0]
    # two per cent of the interval's own slope
    wanted = (0.02 * view.array("interval_modulus")[0] / spread) ** 2
    assert answers[0].share("tension_gain") == pytest.approx(wanted)
    assert "K_ap" not in " ".join(budget_table(answers).remarks)


def test_a_stated_gain_is_the_uncertainty_of_a_weight_whose_reading_is_not_stated(weighed):
    view = view_of_stepwise(weighed, InstrumentErrors("tether", tension_gain=0.02))
    tension, spread = view.array("tension"), view.array("tension_standard_uncertainty")
    assert spread == pytest.approx(0.02 * tension)


def test_a_weight_of_which_nothing_is_stated_has_no_uncertainty(weighed):
    view = view_of_stepwise(weighed, InstrumentErrors("tether", diameter=1e-4))
    assert np.isnan(view.array("tension_standard_uncertainty")).all()
