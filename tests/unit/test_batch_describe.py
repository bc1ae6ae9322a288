"""What the settings of a product hold: all that it rests on beside its own log."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.reuse import _settings_json
from reduction.batch.survey import Survey
from reduction.campaign.plan import TestPlan
from reduction.record.contributions import InstrumentErrors, StatedErrors
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import ReductionSettings
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.errors_of_cycles import PullOrigin

TAPE = SpliceMarks(
    "new", ("P", "P"), ("slack", "min"), near_toe=np.array([0.6, 0.7]),
    far_toe=np.array([3.2, 5.2]), far_thimble=np.array([3.7, 5.9]), reading_uncertainty=0.001,
)  # fmt: skip
MODEL = StrainModel(
    "new", "tension-driven", {"relaxed_free_length": 2.6}, mark_test=("P", "P"),
    mark_hold=("slack", "min"), mark_position=TAPE.far_thimble,
    mark_tension=np.array([np.nan, 380.0]), mark_load_cell=("A", "A"),
)  # fmt: skip


def settings(*, tape=TAPE, model=MODEL, of_pull=MODEL, load_cell="A"):
    plan = TestPlan(
        id="R", kind="cyclic", files=(("R.csv", "logger"),), specimens=("new",), order=None,
        control="position", waveform="triangular", target_strain=(),
        attributes={"load_cell": load_cell}, settings=ReductionSettings(), log="R", step_place=0,
    )  # fmt: skip
    campaign = SimpleNamespace(
        id="c", attributes={}, uncertainty=StatedErrors(tension_gain=0.01), marks={"new": tape},
        layouts={"logger": SimpleNamespace(model_dump=lambda **_: {})},
        specimens={"new": Specimen("new")},
        experiments={"e": SimpleNamespace(runs={"R": ()}, quasi_static={"new": "P"})},
    )  # fmt: skip
    pull = SimpleNamespace(
        curve_coefficient=np.zeros(4),
        strain_coefficient=np.zeros(4),
        tension_low=1.0,
        tension_high=2.0,
    )
    origin = PullOrigin(InstrumentErrors("new"), of_pull)
    return _settings_json(campaign, Survey(plan), [model], None, [pull], [origin])


CELLS = replace(MODEL, mark_load_cell=("A", "B"))


@pytest.mark.parametrize(
    "change",
    [
        {"tape": replace(TAPE, reading_uncertainty=0.002)},
        {"tape": replace(TAPE, splice_creep=0.08)},
        {"tape": replace(TAPE, near_toe=np.array([0.6, 0.71]))},
        {"model": CELLS},
        {"model": replace(MODEL, by_marks=replace(MODEL, method="mixed"))},
        {"of_pull": CELLS},
        {"load_cell": "C"},
    ],
)
def test_what_moves_the_uncertainty_of_a_number_is_in_the_settings(change):
    assert settings(**change) != settings()


def test_settings_have_every_reading_as_it_was_made_and_no_digit_that_was_computed_of_them():
    found = json.loads(settings())
    strain = found["strain"]["new"]
    assert strain["tape"] == {
        "standard_uncertainty": 0.001,
        "splice_creep": 0.02,
        "readings": [["P", "slack", 0.6, 3.2, 3.7], ["P", "min", 0.7, 5.2, 5.9]],
    }
    assert strain["marks"] == [["P", "slack", 3.7, None, "A"], ["P", "min", 5.9, 380.0, "A"]]
    assert found["quasi_static"]["new"]["strain"] == strain
    assert found["instruments"] == {
        "new": {
            "splice_friction": 0.0,
            "tension": "A, channel 1",
            "crosshead_position": "crosshead",
        }
    }


def test_a_model_without_marks_rests_on_no_tape():
    length = StrainModel("new", "gauge-length", {"gauge_length": 2.6})
    assert "tape" not in json.loads(settings(model=length))["strain"]["new"]
