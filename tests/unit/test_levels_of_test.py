"""Levels of a test as its log shows them, against waves that are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.plausibility import _of_lower_target, _of_mean
from reduction.record.notes import note
from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.standstills import find_standstills, find_tension_stands
from reduction.stages.test_levels import levels_of_test


def levels(position, tension, *, waveform="sinusoidal", counter=None, step=0.05):
    time = step * np.arange(position.size)
    tension = np.atleast_2d(tension)
    stands = find_standstills(time, position, tension, settings=PhaseSettings())
    cycles = find_cycles(
        time, position, tension, stands, settings=CycleSettings(waveform=waveform),
        cycle_counter=counter,
    )  # fmt: skip
    return levels_of_test(time, position, tension, None, stands, cycles, control="position")


def test_a_sine_whose_tension_leads_by_a_known_time():
    time = 0.05 * np.arange(1200)
    position = 2 - 0.5 * np.cos(0.4 * np.pi * time)
    tension = 300 - 100 * np.cos(0.4 * np.pi * (time + 0.1))
    found = levels(position, np.stack([tension, tension]))
    assert found.waveform == "sinusoidal"
    assert found.frequency == pytest.approx(0.2, rel=0.01)
    assert found.mean_tension == pytest.approx([300, 300], rel=0.01)
    assert found.tension_amplitude == pytest.approx([100, 100], rel=0.01)
    assert found.lead == pytest.approx([0.1, 0.1], abs=0.01)
    assert found.is_copy.tolist() == [False, True]
    assert found.n_strokes == 24


@pytest.mark.parametrize(("ramp", "stand", "n_strokes"), [(40, 10, 24), (20, 300, 0)])
def test_dwells_at_the_turns_of_cycles_are_told_from_holds(ramp, stand, n_strokes):
    lasts = np.tile([ramp, stand], 24)
    time = np.arange(0, lasts.sum(), 0.5)
    position = np.interp(time, np.cumsum([0, *lasts]), [20.0, *[40, 40, 20, 20] * 12])
    found = levels(position / 1000, 5 * position, waveform="other", step=0.5)
    assert found.n_strokes == pytest.approx(n_strokes, abs=1)


@pytest.mark.parametrize(
    ("stated", "is_missed"),
    [((0.5, 1.5), False), ((0.45, 1.5), False), ((0.75, 1.5), True), ((0.2, 1.5), True),
     ((1.5,), False)],
)  # fmt: skip
def test_the_lower_target_strain_is_compared_with_the_valleys(stated, is_missed):
    strain = 1.0 - 0.5 * np.cos(0.2 * np.pi * 0.05 * np.arange(1200))
    position = 2 + 4 * strain  # 4 m of free length, slack at 2 m
    found = levels(position, 300 * strain)
    assert found.valley_position == pytest.approx(4.0, abs=0.01)
    assert found.valley_tension == pytest.approx([150.0], abs=1)
    model = SimpleNamespace(method="extensometer")
    survey = SimpleNamespace(
        levels=SimpleNamespace(valley_strain=(found.valley_position - 2) / 4 * np.ones(1))
    )
    plan = SimpleNamespace(target_strain=stated, specimens=("new",))
    missed = [one.code for one in _of_lower_target(plan, survey, 0, model)]
    assert missed == ["lower-target-missed"] * is_missed


@pytest.mark.parametrize("late", [0.0, 0.15])
@pytest.mark.parametrize("bend", [-2.0, 0.1, 2.0])
def test_an_elastic_curve_has_no_lead_in_strokes_of_unequal_speed(bend, late):
    time = 0.05 * np.arange(2400)

    def stretch(time):
        return np.interp(time % 10, [0, 8, 10], [2.0, 3.0, 2.0])

    tension = np.expm1(bend * (stretch(time - late) - 2)) / bend + 1
    found = levels(stretch(time), tension, waveform="triangular")
    assert found.lead == pytest.approx([-late], abs=0.015)


@pytest.mark.parametrize(("reached", "ends_in_pull"), [(2.0, True), (1.1, False)])
@pytest.mark.parametrize("returns", [True, False])
def test_a_pull_to_more_than_the_cycles_before_it_is_told_from_one_more(
    reached, ends_in_pull, returns
):
    back = [0.0] if returns else []
    turns = [0, *[1.0, 0.1] * 8, reached, *back]
    position = 2 + np.interp(np.arange(50 * len(turns)), 50 * np.arange(len(turns)), turns)
    found = levels(position, 1e3 * (position - 2))
    assert found.ends_in_pull == ends_in_pull
    assert found.n_strokes >= 16


def test_a_triangle_is_told_from_a_sine():
    phase = 0.05 * np.arange(1200) / 5 % 1
    position = 2 + np.abs(2 * phase - 1)
    found = levels(position, 100 * position, waveform="triangular")
    assert found.waveform == "triangular"
    assert found.speed == pytest.approx(0.4, rel=0.02)


@pytest.mark.parametrize("dwell", [1.0, 3.5, 5.0])
def test_dwells_at_both_ends_are_part_of_the_period(dwell):
    # 20 s a cycle, with a rest at the valley that may be long enough for a standstill
    ramp = 10.0 - dwell
    times = np.cumsum([5.0, *[ramp, dwell] * 12])
    time = 0.05 * np.arange(int(times[-1] / 0.05))
    position = 2 + np.interp(time, times, [0.0, *[1, 1, 0, 0] * 6])
    found = levels(position, 100 * (position - 1), waveform="other")
    assert found.frequency == pytest.approx(0.05, rel=0.01)


@pytest.mark.filterwarnings("error")
def test_a_cycle_that_a_machine_counts_without_a_stroke_has_no_speed():
    time = 0.05 * np.arange(1200)
    position = 2 - 0.5 * np.cos(0.4 * np.pi * time)
    counter = 1 + (time // 5).astype(np.int64)
    position[1100:] = position[1100]
    found = levels(position, 100 * position, counter=counter)
    assert np.isfinite(found.speed)


@pytest.mark.parametrize("back", [6.0, 30.0, 3000.0])
def test_the_speed_of_a_pull_is_that_of_the_way_out(back):
    time = np.arange(0, 700 + back + 60, 0.5)
    noise = np.random.default_rng(2).normal(0, 2e-5, time.size)
    position = np.interp(time, [20, 620, 680, 680 + back], [0, 0.3, 0.3, 0]) + noise
    stands = find_standstills(time, position, 1e3 * position[None], settings=PhaseSettings())
    found = levels_of_test(
        time, position, 1e3 * position[None], None, stands, None, control="position"
    )
    assert found.speed == pytest.approx(0.3 / 600, rel=0.1)


def cycled(drift, *, rest_after):
    """Two rests about thirty triangles of 10 s; what is added to the tension of the cycles [N]."""
    time = np.arange(0, 420.0, 0.1)
    inside = (time > 60) & (time < 360)
    phase = (time - 60) / 10 % 1
    position = np.where(inside, 1.2 + 0.8 * (1 - np.abs(2 * phase - 1)), 1.0)
    load = 500 * (position - 1) + drift(np.clip(time - 60, 0, 300)) * inside
    if not rest_after:
        time, position, load = (
            one[: np.flatnonzero(inside)[-1] - 30] for one in (time, position, load)
        )
    return levels(position, load, waveform="triangular", step=0.1).like_means[0]


@pytest.mark.parametrize(
    ("drift", "codes"),
    [
        (lambda t: 60 * t / 300, ["zero-or-relaxation"]),
        (lambda t: -60 * t / 300, ["zero-or-relaxation"]),
        (lambda t: -15 * np.log(1 + t), []),  # relaxation slows down
        (lambda t: 3 * t / 300, []),
    ],
)
def test_a_mean_that_a_drifting_zero_would_move_alike_is_said_where_no_rest_can_tell(drift, codes):
    means = cycled(drift, rest_after=False)
    # cycles of 300 N: first, middle and last quarter of those after the first
    assert means == pytest.approx(
        [300 + drift(np.linspace(*at, 500)).mean() for at in ((10, 80), (115, 190), (220, 290))],
        abs=4.0,  # where a cycle begins
    )
    assert [one.code for one in _of_mean("new", means)] == codes
    assert np.isnan(cycled(drift, rest_after=True)).all()


def test_the_step_of_a_coarse_load_is_found_and_that_of_a_fine_one_is_none():
    time = 0.05 * np.arange(1200)
    position = 2 - 0.5 * np.cos(0.4 * np.pi * time)
    fine = 300 - 200 * np.cos(0.4 * np.pi * time)
    found = levels(position, np.stack([20 * np.round(fine / 20), fine, np.round(fine)]))
    assert found.load_step[0] == pytest.approx(20)
    assert np.isnan(found.load_step[1:]).all()


@pytest.mark.parametrize("dwell", [0.075, 0.1, 0.125, 0.15, 0.25])
@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_ramps_with_a_dwell_at_both_ends_are_no_sine(dwell, noise):
    # a quarter of the time at rest has the root mean square of a sine
    ramp = 0.5 - dwell
    phase = 0.05 * np.arange(1200) / 5 % 1
    wave = np.interp(phase, [0, ramp, 0.5, 1 - dwell, 1], [-1, 1, 1, -1, -1])
    position = 2 + wave + np.random.default_rng(3).normal(0, noise, phase.size)
    for stated in ("triangular", "sinusoidal", "other"):
        assert levels(position, 100 * position, waveform=stated).waveform == "other"


@pytest.mark.parametrize("distortion", [0.0, 0.02])
def test_a_sine_with_a_little_of_a_harmonic_stays_one(distortion):
    phase = 0.4 * np.pi * 0.05 * np.arange(1200)
    position = 2 - np.cos(phase) + distortion * np.cos(3 * phase)
    position += np.random.default_rng(4).normal(0, 0.005, phase.size)
    assert levels(position, 100 * position).waveform == "sinusoidal"


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_two_unequal_ramps_are_triangular(share):
    phase = 0.05 * np.arange(1200) / 5 % 1
    position = 2 + np.interp(phase, [0, share, 1], [-1, 1, -1])
    position += np.random.default_rng(5).normal(0, 0.005, phase.size)
    assert levels(position, 100 * position, waveform="triangular").waveform == "triangular"


@pytest.mark.parametrize(("grows", "words"), [
    (True, "the amplitude of tension grows by 74.2 N with it: the cycles are not at one level"),
    (False, "although the machine controls the load: the machine did not hold the level"),
])  # fmt: skip
def test_a_mean_that_rises_with_the_amplitude_is_of_growing_cycles_and_no_lost_level(grows, words):
    """Thirty sines of a driven load from one valley, or of one amplitude; 80 N more at their end.

    From the first of 30 cycles to the last are 29 of them, and a cycle grows by itself; by a
    straight line through them that is 77 N, less what the median of a growing cycle lies off.
    """
    time = 0.05 * np.arange(3001)
    more = 80 * time / time[-1]
    wave = -np.cos(0.4 * np.pi * time)
    tension = 300 + more + (100 + more * grows) * wave
    position = 2 + tension / 1000
    stands = find_standstills(time, position, tension[None], settings=PhaseSettings())
    cycles = find_cycles(
        time, position, tension[None], stands,
        settings=CycleSettings(waveform="sinusoidal", control="load"),
    )  # fmt: skip
    found = levels_of_test(time, position, tension[None], None, stands, cycles, control="load")
    first, last, growth = found.mean_ramps[0]
    assert last - first == pytest.approx(77, abs=4)
    assert growth == pytest.approx(77 if grows else 0, abs=4)
    told = note(
        "mean-tension-ramps", "rope", first=first, last=last, is_of_load=True,
        grows=74.2 if grows else 0.0,
    )  # fmt: skip
    assert words in str(told)


@pytest.mark.parametrize(
    ("out", "load", "share"),
    [
        # synthetic: a coupon that yields at 400 N after 2 mm, and is let back along its slope
        (
            [0, 10.0, 8.0],
            lambda way, back: np.minimum(np.minimum(200 * way, 400), 400 - 200 * back),
            np.nan,
        ),
        # a line that breaks at 10 mm, of which the crosshead comes back by 2
        ([0, 10.0, 8.0], lambda way, back: np.where(back > 0, 0.0, 40 * way), 0.0),
    ],
)
def test_a_coupon_that_is_let_back_has_not_broken(out, load, share):
    position = 1e-3 * np.interp(np.arange(500), [0, 400, 499], out)
    way = 1e3 * position
    tension = load(way, np.maximum.accumulate(way) - way)
    stands = find_standstills(
        np.arange(500.0), position, tension[None], settings=PhaseSettings(minimum_duration=600.0)
    )
    found = levels_of_test(
        np.arange(500.0), position, tension[None], None, stands, None, control="position"
    )
    assert found.final_share == pytest.approx([share], abs=0.01, nan_ok=True)


@pytest.mark.parametrize(
    ("noise", "overshoot", "keeps_length"),
    [(2e-4, 0.0, False), (2e-5, 0.05, False), (2e-5, 0.05, True)],
)
def test_a_rope_that_stiffens_behind_its_slack_is_not_said_to_be_held_in_position(
    noise, overshoot, keeps_length
):
    # synthetic: 0.3 m of slack, then 0.05 m up to 10 kN, kept for half an hour
    rng = np.random.default_rng(0)
    time = np.arange(0, 1860, 0.2)
    since = np.clip(time - 60, 0, None)
    change = overshoot * (np.exp(-since / 5) - keeps_length)
    tension = np.interp(time, [0, 30, 60], [0, 0, 1e4]) * (1 + np.where(time > 60, change, 0))
    stretch = 0.05 * (tension / 1e4) ** 0.4 + 1e-4 * np.log10(1 + since)
    if keeps_length:
        stretch[time > 60] = 0.05
    position = 0.3 * np.clip(time / 30, 0, 1) + stretch + rng.normal(0, noise, time.size)
    tension = tension + rng.normal(0, 5, time.size)
    stands = find_tension_stands(time, position, tension[None], settings=PhaseSettings())
    found = levels_of_test(time, position, tension[None], None, stands, None, control="load")
    assert np.isfinite(found.stood_tension).all() == keeps_length
