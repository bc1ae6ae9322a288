"""How far a test went, from records whose samples are known."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.pipeline.extremes import (
    Extremes,
    _outermost,
    _Samples,
    extremes_of_readings,
    extremes_of_test,
    greatest_strain,
    growth_of_slack_length,
)
from reduction.pipeline.located_test import Located
from reduction.record.measurement import Record, StepReadings
from reduction.stages.standstills import _describe_standstills
from reduction.stages.strain.strain_model import StrainModel

POSITION = np.array([3.0, 3.5, 4.0, 4.002, 4.0, 3.5, np.nan])
TENSION = np.array([[0.0, 20, 100, 102, 90, 30, 0], [0, 10, 50, np.nan, 45, 10, 0]])


def located(position=POSITION, tension=TENSION, **told):
    n_samples = position.size
    nothing = np.empty(0, dtype=int)
    record = Record(
        test_id="T",
        specimens=tuple("ab")[: len(tension)],
        time=np.arange(float(n_samples)),
        crosshead_position=position,
        tension=tension,
        quality_flag=np.zeros(tension.shape, np.uint16),
        crosshead_position_quality_flag=np.zeros(n_samples, np.uint16),
        n_rows_read=n_samples,
        **told,
    )
    stand = _describe_standstills(
        record.time, position, tension, nothing, nothing,
        position_tolerance=0.01, slack_tension=2.0,
    )  # fmt: skip
    return Located(record, position, tension, stand, None)


def test_the_greatest_tension_and_the_samples_at_the_greatest_position_are_kept():
    found = extremes_of_test(located())
    assert found.greatest_tension == {"a": 102, "b": 50}
    top = found.at_greatest_position["a"]
    # 100 N at 4.0 m lies between the others: no strain model has its greatest strain there
    assert top.position.tolist() == [4.002, 4.0] and top.tension.tolist() == [102, 90]
    assert found.slack_tension == 2.0 and not found.has_extensometer


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_outermost_samples_hold_the_greatest_strain_of_all(sign):
    rng = np.random.default_rng(3)
    place = 4.0 + 0.001 * rng.integers(0, 8, 3000)
    load = 100.0 - 5.0 * np.log1p(np.arange(3000.0)) + rng.normal(0.0, 0.5, 3000)
    outer = _outermost(place, load)
    assert outer.size < 40
    for compliance in (1e-6, 1e-4, 1e-2):
        strain = place - sign * compliance * load
        assert strain[outer].max() == strain.max()
    load[7] = np.nan
    assert 7 not in _outermost(place, load)


def test_the_first_rise_ends_with_the_first_sample_over_half_of_the_peak():
    found = extremes_of_test(located())
    assert found.first_rise["a"].tension.tolist() == [0, 20, 100]
    assert found.first_rise["b"].tension.tolist() == [0, 10, 50]
    assert found.first_rise["a"].tension.base is None  # the record may be let go


def test_a_specimen_without_a_reading_has_no_entry():
    found = extremes_of_test(located(tension=np.stack([TENSION[0], np.full(7, np.nan)])))
    assert list(found.greatest_tension) == list(found.at_greatest_position) == ["a"]
    nowhere = extremes_of_test(located(position=np.full(7, np.nan)))
    assert nowhere.at_greatest_position == {}


def test_the_greatest_strain_is_that_of_the_model_or_of_the_extensometer():
    measured = np.array([[0, 0.1, 0.3, 0.31, 0.32, 0.1, 0]])
    found = extremes_of_test(located(tension=TENSION[:1], measured_strain=measured))
    assert found.has_extensometer
    by_length = StrainModel("a", "gauge-length", {"reference_position": 3.0, "gauge_length": 2.0})
    assert greatest_strain(found, "a", by_length) == pytest.approx(1.002 / 2)
    assert greatest_strain(found, "a", replace(by_length, method="extensometer")) == 0.32
    assert np.isnan(greatest_strain(found, "a", None))
    assert np.isnan(greatest_strain(found, "b", by_length))


def test_a_stepwise_test_went_as_far_as_its_greatest_reading():
    none = np.full(2, np.nan)
    readings = StepReadings(
        ("1", "2"), np.array([0.0, 60.0]), np.array([100.0, 90.0]), np.array([1.2, 1.5]), none, none
    )
    found = extremes_of_readings(readings, "hose", stated_gauge_length=1.0)
    assert found.greatest_tension == {"hose": 100.0}
    assert greatest_strain(found, "hose", None) == pytest.approx(0.5)


@pytest.mark.parametrize("told", [{"position_is_length": False}, {"first_rise": {}}])
def test_without_a_length_or_a_rise_there_is_no_growth(told):
    position = np.linspace(2, 4, 401)
    rise = Extremes(
        first_rise={"a": _Samples(position, 100 * np.clip(position - 3, 0, None))},
        slack_tension=5.0,
    )
    assert growth_of_slack_length(rise, rise, "a", free_length=3.0) == (
        0.0, pytest.approx(0.0), 0.0,
    )  # fmt: skip
    both = growth_of_slack_length(rise, replace(rise, **told), "a", free_length=3.0)
    assert np.isnan(both).all()


def test_a_softer_specimen_grows_with_the_tension_that_counts_as_slack():
    position = np.linspace(2, 4, 401)

    def rise(stiffness, slack_tension=5.0):
        load = stiffness * np.clip(position - 3, 0, None)
        return Extremes(first_rise={"a": _Samples(position, load)}, slack_tension=slack_tension)

    growth, _, slope = growth_of_slack_length(rise(100.0), rise(50.0), "a", free_length=3.0)
    more, _, _ = growth_of_slack_length(rise(100.0, 6.0), rise(50.0, 6.0), "a", free_length=3.0)
    assert slope == pytest.approx((1 / 50 - 1 / 100) / 3.0)
    assert more - growth == pytest.approx(slope)


def test_a_crossing_through_two_samples_has_no_growth():
    rise = Extremes(
        first_rise={"a": _Samples(np.array([2.0, 4.0]), np.array([0.0, 100.0]))}, slack_tension=5.0
    )
    assert np.isnan(growth_of_slack_length(rise, rise, "a", free_length=3.0)).all()
