"""Samples that ingest flagged change neither the cycles nor the loops of a test."""

from dataclasses import replace

import numpy as np
from examples import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st

from reduction.pipeline.located_test import _without_flagged_samples, locate
from reduction.readers.sample_flags import flag_record
from reduction.record.measurement import Quality, Record
from reduction.record.settings import QualitySettings, ReductionSettings
from reduction.stages.cycles.loops import close_loops

STEP = 0.1  # s
N_CYCLES, PER_CYCLE = 8, 80
KNOTS = np.cumsum([0, 120, 60, *[PER_CYCLE // 2] * (2 * N_CYCLES), 60, 120])
LEVELS = [1.0, 1.0, *[1.5, 2.5] * N_CYCLES, 1.5, 1.0, 1.0]
PART = {"rest": (8, 110), "ramp": (122, 178), "cycling": (186, KNOTS[-3] - 8)}


def clean_record():
    """Rest, ramp, eight cycles between 1.5 and 2.5 m, and back to rest; one specimen."""
    samples = np.arange(KNOTS[-1] + 1)
    noise = np.random.default_rng(20051010).normal(0, [[0.0005], [0.5]], (2, samples.size))
    course = np.interp(samples, KNOTS, LEVELS)
    rate = np.gradient(course)
    position = course + noise[0]
    tension = 1000 * (course - 1) + 20 * np.sign(rate) * (course - 1) + noise[1]
    return Record(
        test_id="A",
        specimens=("one",),
        time=STEP * samples,
        crosshead_position=position,
        tension=tension[None],
        quality_flag=np.zeros((1, samples.size), np.uint16),
        crosshead_position_quality_flag=np.zeros(samples.size, np.uint16),
        n_rows_read=samples.size,
    )


CLEAN = clean_record()


def reduced(record):
    """Located test and its loops, strain being position less 1 m."""
    located = locate(record, kind="cyclic", settings=ReductionSettings())
    position = _without_flagged_samples(
        record.crosshead_position, record.crosshead_position_quality_flag
    )
    tension = _without_flagged_samples(record.tension, record.quality_flag)
    return located, close_loops(record.time, tension, (position - 1)[None], located.cycles)


LOCATED, LOOPS = reduced(CLEAN)


@st.composite
def drop_outs(draw, longest):
    """Channel, first sample and length of up to ten drop-outs, three samples apart at least."""
    found = []
    for first, last in (PART[part] for part in draw(st.lists(st.sampled_from(sorted(PART))))[:10]):
        length = draw(st.integers(1, longest))
        begin = draw(st.integers(first, last - length))
        channel = draw(st.sampled_from(["position", "tension"]))
        if all(abs(begin - other) > 2 * longest + 5 for _, other, _ in found):
            found.append((channel, begin, length))
    return found


def with_drop_outs(places, level):
    position, tension = CLEAN.crosshead_position.copy(), CLEAN.tension.copy()
    for channel, begin, length in places:
        target = position if channel == "position" else tension[0]
        target[begin : begin + length] = level[channel]
    return replace(CLEAN, crosshead_position=position, tension=tension)


@settings(max_examples=examples(60), deadline=None)
@given(drop_outs(longest=1), st.sampled_from([-1.0, 5.0]))
def test_single_samples_that_drop_out_change_no_cycle_and_no_loop(places, share):
    level = {"position": share, "tension": 1000.0 * share}
    record = flag_record(with_drop_outs(places, level), settings=QualitySettings())
    flagged = {
        "position": record.crosshead_position_quality_flag & Quality.SPIKE,
        "tension": record.quality_flag[0] & Quality.SPIKE,
    }
    for channel, flags in flagged.items():
        wanted = [
            begin + offset
            for name, begin, length in places
            for offset in range(length)
            if name == channel
        ]
        assert np.flatnonzero(flags).tolist() == sorted(wanted)
    located, loops = reduced(record)
    assert located.cycles.n_cycles == N_CYCLES
    assert located.standstills.n_standstills == LOCATED.standstills.n_standstills == 2
    assert located.standstills.is_rest.all()
    assert np.abs(located.cycles.first - LOCATED.cycles.first).max() <= 11
    # a drop-out at a turn hides up to its length of the turn
    near_turn = 11 * 25.0
    for name in ("peak_tension", "valley_tension"):
        assert np.abs(getattr(loops, name) - getattr(LOOPS, name)).max() <= near_turn
    assert np.allclose(loops.hysteresis_energy, LOOPS.hysteresis_energy, rtol=0.1)


@settings(max_examples=examples(60), deadline=None)
@given(drop_outs(longest=10), st.sampled_from([-1.0, 5.0]))
@example([("position", 808, 4)], -1.0)
@example([("position", 188, 8)], -1.0)
def test_drop_outs_of_up_to_ten_samples_are_flagged_and_change_no_count(places, share):
    record = flag_record(
        with_drop_outs(places, {"position": share, "tension": 1000.0 * share}),
        settings=QualitySettings(),
    )
    by_channel = {
        "position": record.crosshead_position_quality_flag,
        "tension": record.quality_flag[0],
    }
    for channel, flags in by_channel.items():
        off = {b + i for name, b, length in places if name == channel for i in range(length)}
        assert set(np.flatnonzero(flags & Quality.SPIKE).tolist()) == off
    located, loops = reduced(record)
    assert located.cycles.n_cycles == N_CYCLES
    assert located.standstills.n_standstills == 2 and located.standstills.is_rest.all()
    # a loop that lacks a tenth of its readings at most has them bridged, at a turn by a chord
    known = np.isfinite(loops.hysteresis_energy)
    assert np.allclose(
        loops.apparent_spring_constant[known], LOOPS.apparent_spring_constant[known], rtol=0.2
    )
    assert (loops.hysteresis_energy[known] > 0).all()
