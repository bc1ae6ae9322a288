"""Which channel says where a test is held, and which samples count there."""

import numpy as np
import pytest

from reduction.pipeline.located_test import locate
from reduction.record.errors import DataError
from reduction.record.measurement import Quality, Record
from reduction.record.settings import CycleSettings, ReductionSettings


def record(repeats=False):
    """Rest, ramp, a hold at 300 N in which the crosshead creeps."""
    time = np.arange(0, 300, 0.5)
    load = np.interp(time, [0, 20, 40, 300], [0, 0, 300, 300])
    noise = np.random.default_rng(2)
    position = 1 + load / 1000 + 0.02 * np.log10(1 + np.clip(time - 40, 0, None))
    flags = np.zeros((1, time.size), dtype=np.uint16)
    if repeats:
        flags[0, time >= 40] = Quality.STUCK | Quality.SATURATED
        flags[0, 5:60] = Quality.STUCK
    else:
        load = load + noise.normal(0, 0.2, time.size)
    return Record(
        test_id="A",
        specimens=("cord",),
        time=time,
        crosshead_position=position + noise.normal(0, 0.0002, time.size),
        tension=load[None],
        quality_flag=flags,
        crosshead_position_quality_flag=np.zeros(time.size, dtype=np.uint16),
    )


@pytest.mark.parametrize(
    ("kind", "control", "on_tension"),
    [
        ("creep", "position", True),
        ("creep", "load", True),
        ("quasi-static", "load", True),
        ("quasi-static", "position", False),
        ("relaxation", "position", False),
        ("relaxation", "load", False),
    ],
)
def test_creep_and_load_control_are_held_on_tension_and_relaxation_never(kind, control, on_tension):
    settings = ReductionSettings(cycles=CycleSettings(control=control))
    found = locate(record(), kind=kind, settings=settings).standstills
    assert (found.tension_tolerance is not None) is on_tension
    assert (found.start_time == 40).any() == on_tension


def test_a_load_that_repeats_one_value_in_a_hold_of_it_is_no_fault():
    located = locate(record(repeats=True), kind="creep", settings=ReductionSettings())
    assert located.standstills.mean_tension[0, -1] == pytest.approx(300)
    assert np.isfinite(located.tension[0, 80:]).all()
    flags = located.record.quality_flag[0]
    assert not flags[80:].any()
    # at rest the flag stays: nothing is held there
    assert (flags[5:30] == Quality.STUCK).all()
    assert "520 samples in holds at constant tension repeat one value" in str(
        located.record.notes[0]
    )
    still = locate(record(repeats=True), kind="relaxation", settings=ReductionSettings())
    assert np.isnan(still.tension[0, 80:]).all()


def test_a_kind_that_is_not_reduced_is_refused():
    with pytest.raises(DataError, match="of a kind that this version does not reduce"):
        locate(record(), kind="stepwise", settings=ReductionSettings())
