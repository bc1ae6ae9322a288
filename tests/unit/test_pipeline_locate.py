"""Which channel says where a test is held, and which samples count there."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.pipeline.located_test import locate
from reduction.record.errors import DataError
from reduction.record.measurement import Quality, Record
from reduction.record.row_counts import notes_on_rows
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
    logged = Record(
        test_id="A",
        specimens=("cord",),
        time=time,
        crosshead_position=position + noise.normal(0, 0.0002, time.size),
        tension=load[None],
        quality_flag=flags,
        crosshead_position_quality_flag=np.zeros(time.size, dtype=np.uint16),
    )
    return replace(logged, notes=tuple(notes_on_rows(logged)))


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
    rows, freed = map(str, located.record.notes)
    assert "flagged: tension of cord stuck 55. Saturated" in rows
    assert "520 samples in holds at constant tension repeat one value" in freed
    still = locate(record(repeats=True), kind="relaxation", settings=ReductionSettings())
    assert np.isnan(still.tension[0, 80:]).all()


def test_rests_of_a_load_that_creep_are_no_fault_and_clipped_peaks_are():
    time = np.arange(0, 40, 0.01)
    # rests of 1 s, in which strain lags behind; and a load cell that ends at 0.9 of the amplitude
    load = np.interp(time % 4, [0, 1, 2, 3, 4], [0, 1, 1, 0, 0])
    lags = load + 0.1 * np.convolve(load, 0.02 * np.exp(-time / 0.5))[: time.size]
    sine = np.sin(2 * np.pi * time / 4)
    for tension, position, is_fault in ((load, lags, False), (np.minimum(sine, 0.9), sine, True)):
        is_top = tension == tension.max()
        logged = Record(
            "A", ("cord",), time, 1 + 0.01 * position, (1000 + 500 * tension)[None],
            np.where(is_top, Quality.SATURATED, 0).astype(np.uint16)[None],
            np.zeros(time.size, dtype=np.uint16),
        )  # fmt: skip
        settings = ReductionSettings(cycles=CycleSettings(control="load", waveform="other"))
        kept = locate(logged, kind="quasi-static", settings=settings).record.quality_flag[0]
        np.testing.assert_array_equal(kept != 0, is_top & is_fault)


def test_a_kind_that_is_not_reduced_is_refused():
    with pytest.raises(DataError, match="of a kind that this version does not reduce"):
        locate(record(), kind="stepwise", settings=ReductionSettings())
