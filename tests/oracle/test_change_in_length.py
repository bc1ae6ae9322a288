"""Six change-in-length properties of a rope programme against the law that made its log."""

import json
from dataclasses import asdict

import numpy as np
import programme as made
import pytest

from reduction.archive.rope_properties import step_of_archive
from reduction.archive.test_dataset import to_dataset
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.measurement import Record, Specimen
from reduction.record.settings import CycleSettings, ReductionSettings, RopeSettings
from reduction.stages.reduced_test import TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.change_in_length import change_in_length

GAUGE = 10.0
REFERENCE_TIME = 120.0
ROPE = Specimen("R-1", kind="rope", diameter=(0.02,), rated_break_strength=made.STRENGTH)
MODEL = StrainModel("R-1", "gauge-length", {"gauge_length": GAUGE, "reference_position": 0.0})


def reduced(log, name):
    time, tension, strain = (np.concatenate(one) for one in (log.time, log.tension, log.strain))
    begin, end = log.steps[name]
    inside = (time >= begin) & (time <= end)
    noise = np.random.default_rng(5)
    n = int(inside.sum())
    kind = made.KINDS.get(name, "cyclic")
    settings = ReductionSettings(
        cycles=CycleSettings(control="load"), rope=RopeSettings(reference_time=REFERENCE_TIME)
    )
    record = Record(
        test_id=name,
        specimens=("R-1",),
        time=time[inside] - begin,
        crosshead_position=GAUGE * (strain[inside] + noise.normal(0, 2e-6, n)),
        tension=(tension[inside] + noise.normal(0, made.NOISE, n))[None],
        quality_flag=np.zeros((1, n), dtype=np.uint16),
        crosshead_position_quality_flag=np.zeros(n, dtype=np.uint16),
        tension_standard_uncertainty=(made.NOISE,),
    )
    test = reduce_test(
        locate(record, kind=kind, settings=settings),
        description=TestDescription("c", name, kind, "load", "triangular", 1, {}),
        specimens=(ROPE,),
        models=(MODEL,),
        history=None,
        sources=(),
        settings=settings,
        settings_json=json.dumps({"reduction": asdict(settings)}),
    )
    return step_of_archive(to_dataset(test, version="0", command=""), "R-1").step


@pytest.fixture(scope="module")
def found():
    log = made.programme_log()
    names = [name for name in log.steps if name != "life"]
    steps = [reduced(log, name) for name in names]
    return change_in_length(steps, rated_break_strength=made.STRENGTH)


def of(found, name):
    return [one for one in found if one.name == name]


def test_every_property_has_a_number(found):
    names = [one.name for one in found]
    counts = {name: names.count(name) for name in dict.fromkeys(names)}
    assert counts == {
        "original stiffness": 1,
        "static stiffness": 1,
        "dynamic stiffness": 3,
        "construction strain": 1,
        "polymer strain": 3,  # two holds of the quasi-static step, one of the creep
        "working strain": 1,
    }
    assert all(np.isfinite([one.value, one.standard_uncertainty]).all() for one in found)


def test_original_stiffness_is_the_chord_of_the_first_rise(found):
    (one,) = of(found, "original stiffness")

    def strain(tension):  # 5 % of the strength at 0.01, then the stiffness of the first cycle
        return np.where(
            tension < 5000,
            tension * 0.01 / 5000,
            0.01 + (tension - 5000) / made.bedding_stiffness(1),
        )

    low, high = one.low_tension, one.high_tension
    truth = (high - low) / (strain(high) - strain(low))
    assert one.value == pytest.approx(truth, abs=3 * one.standard_uncertainty)
    assert one.over_strength == pytest.approx(one.value / made.STRENGTH)
    assert high > 0.27 * made.STRENGTH


def test_static_stiffness_and_working_strain_are_two_readings_of_one_pair_of_holds(found):
    (stiffness,), (strain,) = of(found, "static stiffness"), of(found, "working strain")
    truth = made.static_stiffness(REFERENCE_TIME)
    assert stiffness.value == pytest.approx(truth, abs=3 * stiffness.standard_uncertainty)
    assert strain.value == pytest.approx(2e4 / truth, abs=3 * strain.standard_uncertainty)
    assert (strain.low_tension, strain.high_tension) == pytest.approx((1e4, 3e4), rel=1e-3)
    assert stiffness.reference_time == strain.reference_time == REFERENCE_TIME
    assert stiffness.reason == strain.reason == ""


def test_dynamic_stiffness_is_that_of_each_level(found):
    for level, one in enumerate(of(found, "dynamic stiffness")):
        last = np.arange(made.N_LEVEL - made.LAST, made.N_LEVEL) + 1
        truth = made.level_stiffness(level, last).mean()
        # extremes of noisy readings are wide: 0.05 to 0.2 %
        assert one.value == pytest.approx(truth, rel=3e-3)
        mean, amplitude = made.LEVELS[level]
        ends = ((mean - amplitude) * made.STRENGTH, (mean + amplitude) * made.STRENGTH)
        assert (one.low_tension, one.high_tension) == pytest.approx(ends, rel=5e-3)


def test_construction_strain_is_what_bedding_in_left(found):
    (one,) = of(found, "construction strain")
    # the rope was held at the valley before its cycles: their first foot is on the first rise
    assert "has a hold there" in one.reason
    truth = made.bedding_foot(made.N_BEDDING) - made.bedding_foot(1)
    assert one.value == pytest.approx(truth, abs=3 * one.standard_uncertainty, rel=0.005)


def test_polymer_strain_is_that_gained_from_the_reference_time_to_the_end_of_the_hold(found):
    *_, one = of(found, "polymer strain")
    # the law counts from the centre of its ramp of 20 s
    truth = made.CREEP * np.log10(7210 / REFERENCE_TIME)
    assert one.value == pytest.approx(truth, abs=3 * one.standard_uncertainty)
    assert one.standard_uncertainty < 1e-3 * truth
    assert one.low_tension == one.high_tension == pytest.approx(4e4, rel=1e-3)
