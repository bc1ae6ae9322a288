"""A test with weights: what its ± holds, where that comes from, and the tension of its readings."""

import json
from dataclasses import replace

import numpy as np
import pytest

from reduction.archive.test_dataset import to_dataset
from reduction.record.contributions import InstrumentErrors
from reduction.report.answer_tables import answer_budgets, budget_table
from reduction.report.figures.modulus_figures import draw_steps
from reduction.report.test_section import interval_table
from reduction.report.test_view import NOTHING_STATED, TestView
from reduction.stages.moduli.stepwise_test import StepReadings, reduce_stepwise
from reduction.uncertainty.errors_of_cycles import with_shared_steps

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


def view_of(test, errors, **stated):
    told = {"uncertainty": stated} if stated else {}
    test = replace(with_shared_steps(test, (errors,)), settings_json=json.dumps(told))
    return TestView("static", to_dataset(test, version="1", command="reduction run"), "si")


def test_a_stated_gain_and_diameter_are_among_what_the_page_says_it_holds(weighed):
    errors = InstrumentErrors("tether", tension_gain=0.02, diameter=1e-3)
    view = view_of(weighed, errors, tension_gain=0.02, diameter=1e-3)
    said = " ".join(interval_table(view).remarks)
    for held in ("tension gain", "diameter", "gauge length"):
        assert held in said
    assert "Not included" not in said and NOTHING_STATED not in said
    assert "all samples: " + said.split("all samples: ")[1] in draw_steps(view)[1].caption


def test_where_nothing_is_stated_the_gauge_length_of_the_readings_is_in_it_alone(weighed):
    view = view_of(weighed, InstrumentErrors("tether"))
    (said,) = interval_table(view).remarks
    assert "common to all samples: gauge length." in said and NOTHING_STATED in said


def test_the_bars_of_a_test_with_weights_are_those_of_its_intervals(weighed):
    view = view_of(weighed, InstrumentErrors("tether", tension_gain=0.02), tension_gain=0.02)
    answers = answer_budgets(view)
    assert [one.words for one in answers][:2] == ["1100 to 1110", "1110 to 1120"]
    spread = view.array("interval_modulus_standard_uncertainty")[0]
    # two per cent of the interval's own slope
    wanted = (0.02 * view.array("interval_modulus")[0] / spread) ** 2
    assert answers[0].share("tension_gain") == pytest.approx(wanted)
    assert "K_ap" not in " ".join(budget_table(answers).remarks)


def test_a_stated_gain_is_the_uncertainty_of_a_weight_whose_reading_is_not_stated(weighed):
    view = view_of(weighed, InstrumentErrors("tether", tension_gain=0.02))
    tension, spread = view.array("tension"), view.array("tension_standard_uncertainty")
    assert spread == pytest.approx(0.02 * tension)


def test_a_weight_of_which_nothing_is_stated_has_no_uncertainty(weighed):
    view = view_of(weighed, InstrumentErrors("tether", diameter=1e-4))
    assert np.isnan(view.array("tension_standard_uncertainty")).all()
