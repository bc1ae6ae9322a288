"""Which samples of a record are a hold of one specimen, and which are its ramp."""

from dataclasses import astuple, replace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.holds import hold_selection
from reduction.stages.holds.hold_selection import _find_ramp, select_hold
from reduction.stages.standstills import Standstills

TIME = np.arange(0.0, 100.0, 0.5)
# 2 m/s up to 4 m, a hold to 40 s, on to 6 m, a hold to the end
POSITION = np.interp(TIME, [0, 10, 12, 40, 41, 100], [0, 0, 4, 4, 6, 6])
TENSION = 100 * POSITION
STAND = Standstills(
    first=np.array([24, 82]), last=np.array([79, 199]), start_time=np.array([12.0, 41.0]),
    end_time=np.array([39.5, 99.5]), mean_position=np.array([4.0, 6.0]),
    mean_tension=np.array([[400.0, 600.0]]), is_rest=np.array([False, False]),
    position_tolerance=0.02, slack_tension=5.0,
)  # fmt: skip


def select(index=0, *, time=TIME, position=POSITION, tension=TENSION, stand=STAND):
    return select_hold(time, position, tension, position / 4, stand, index)


def test_a_hold_has_its_samples_and_the_ramp_before_it():
    one = select()
    assert (one.time[0], one.time[-1], one.time.size) == (12.0, 39.5, 56)
    assert (one.start_time, one.slack_tension, one.position_tolerance) == (12.0, 5.0, 0.02)
    assert one.ramp.centre_time == pytest.approx(11.0)
    assert one.ramp.stiffness == pytest.approx(100.0)
    assert (one.notes, one.refusals) == ([], [])


def test_a_ramp_of_three_readings_leads_to_a_tension_with_the_noise_of_the_hold():
    """Synthetic: 0 to 4 m within three readings, a linear specimen, noise of 0.5 N."""
    position = np.interp(TIME, [0, 10, 11.004, 40, 41, 100], [0, 0, 4, 4, 6, 6])
    stand = replace(STAND, first=np.array([23, 82]), start_time=np.array([11.5, 41.0]))
    off = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        one = select(
            position=position + rng.normal(0, 1e-4, TIME.size),
            tension=10 * position + rng.normal(0, 0.5, TIME.size),
            stand=stand,
        )
        off.append((one.ramp_leads_to - 40) / one.ramp_leads_to_within)
    assert 0.7 < np.sqrt(np.mean(np.square(off))) < 1.5


@pytest.mark.parametrize(("step", "is_ramp"), [(3.0, False), (12.0, True)])
def test_a_step_within_what_counts_as_constant_tension_is_no_ramp(step, is_ramp):
    time = np.arange(0.0, 400.0, 0.25)
    load = np.interp(time, [0, 200, 204, 400], [300 - step, 300 - step, 300, 300])
    stand = replace(
        STAND, first=np.array([0, 816]), last=np.array([799, time.size - 1]),
        start_time=np.array([0.0, 204.0]), end_time=np.array([199.75, time[-1]]),
        mean_tension=np.array([[300.0 - step, 300.0]]), tension_tolerance=0.5,
    )  # fmt: skip
    ramp = select(1, time=time, position=load / 100, tension=load, stand=stand).ramp
    assert (ramp is not None) is is_ramp


@pytest.mark.parametrize("cycled", [False, True])
def test_a_controller_that_overshoots_and_settles_does_not_hide_its_ramp(cycled):
    # 100 N, then in 4 s to 10 % beyond 300 N, from where it swings to it; or it cycles for long
    time = np.arange(0.0, 400.0, 0.25)
    since = np.clip(time - 44.0, 0, None)
    swing = 20 * np.exp(-since / 2) * np.cos(1.5 * since) * (time > 44)
    load = np.interp(time, [0, 40, 44, 400], [100, 100, 320, 320]) - 20 * (time > 44) + swing
    begin = 50.0
    if cycled:
        on = (time > 44) & (time <= 194)
        load = np.where(time > 44, 300.0, load) + 40 * on * np.sin(0.2 * np.pi * (time - 44))
        begin = 194.0
    first = int(np.argmax(time >= begin))
    stand = replace(
        STAND, first=np.array([0, first]), last=np.array([159, time.size - 1]),
        start_time=np.array([0.0, begin]), end_time=np.array([39.75, time[-1]]),
        mean_tension=np.array([[100.0, 300.0]]), tension_tolerance=1.0,
    )  # fmt: skip
    ramp = select(1, time=time, position=load / 100, tension=load, stand=stand).ramp
    if cycled:  # the hold comes after the cycles, and not after the ramp to them
        assert ramp.centre_time > 185
    else:
        # half of the 200 N are there after 4 * 100 / 220 s; what swings comes to nothing
        assert ramp.centre_time == pytest.approx(40 + 4 * 100 / 220, abs=0.5)


def test_the_ramp_of_a_later_hold_begins_after_the_one_before():
    ramp = select(1).ramp
    assert ramp.centre_time == pytest.approx(40.5)
    assert ramp.duration == pytest.approx(1.0)


def test_samples_without_tension_or_out_of_time_are_left_out():
    tension, time = TENSION.copy(), TIME.copy()
    tension[30] = np.nan
    time[40] = time[38]
    one = select(tension=tension, time=time)
    assert one.time.size == 54
    assert not {TIME[30], TIME[40]} & set(one.time)


@pytest.mark.parametrize("channel", ["position", "tension"])
def test_a_hold_without_usable_readings_is_empty(channel):
    # as where a channel that is printed coarsely counts as stuck throughout the hold
    series = {"position": POSITION.copy(), "tension": TENSION.copy()}
    series[channel][24:80] = np.nan
    assert select(**series).time.size == 0


def test_where_the_machine_keeps_the_tension_the_ramp_is_that_of_tension():
    # the length follows 1 s behind the tension and does not date the ramp
    position = np.interp(TIME, [0, 11, 13, 100], [0, 0, 4, 4])
    stand = replace(STAND, tension_tolerance=2.0)
    ramp = select(position=position, stand=stand).ramp
    assert ramp.start_time == pytest.approx(10.0)
    assert ramp.end_time == pytest.approx(12.0)
    assert select(position=position).ramp.start_time == pytest.approx(11.0)


def test_a_record_that_begins_in_the_hold_has_no_ramp():
    inside = slice(24, None)
    stand = replace(
        STAND, first=STAND.first[:1] - 24, last=STAND.last[:1] - 24,
        start_time=STAND.start_time[:1], end_time=STAND.end_time[:1],
        mean_position=STAND.mean_position[:1], mean_tension=STAND.mean_tension[:, :1],
        is_rest=STAND.is_rest[:1],
    )  # fmt: skip
    one = select(time=TIME[inside], position=POSITION[inside], tension=TENSION[inside], stand=stand)
    assert one.ramp is None
    assert one.time.size == 56


def test_a_standstill_that_is_not_there_is_an_error():
    with pytest.raises(IndexError):
        select(2)


def cycled_before_a_hold(seed):
    """Cycles, a way to a hold and the hold, with missing samples and a clock that slips back."""
    rng = np.random.default_rng(seed)
    turns = np.cumsum(rng.integers(3, 30, 20))
    n_before = int(turns[-1])
    position = np.interp(np.arange(n_before), turns, rng.uniform(0, 4, 20))
    position = np.concatenate([position, np.full(50, position[-1])])
    time = np.arange(position.size) / 10
    time[rng.integers(0, n_before, 4)] += rng.uniform(-2, 3, 4)
    tension = 100 * position + rng.normal(0, 0.1, position.size)
    for series in (position, tension):
        series[rng.integers(0, n_before, 6)] = np.nan
    stand = replace(
        STAND, first=np.array([n_before]), last=np.array([position.size - 1]),
        start_time=time[[n_before]], end_time=time[[-1]], mean_position=position[[-1]],
        mean_tension=tension[None, [-1]], is_rest=np.array([False]),
    )  # fmt: skip
    return {"time": time, "position": position, "tension": tension, "stand": stand}


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("length", [1, 2, 5, 64])
def test_the_ramp_is_that_of_the_whole_record_however_far_is_looked_back(monkeypatch, length, seed):
    record = cycled_before_a_hold(seed)
    ramp = select(**record).ramp
    monkeypatch.setattr(hold_selection, "_LOOKED_BACK", length)
    # a ramp of one step has no stiffness, which is NaN
    np.testing.assert_equal(astuple(select(**record).ramp), astuple(ramp))


def test_many_cycles_before_a_hold_are_not_taken_along(monkeypatch):
    number = np.arange(200_000)
    position = np.where(number < 199_000, 2 + 2 * np.cos(number / 50), 6.0)
    stand = replace(
        STAND, first=np.array([199_000]), last=np.array([199_999]), is_rest=np.array([False]),
        start_time=np.array([19_900.0]), end_time=np.array([19_999.9]),
        mean_position=np.array([6.0]), mean_tension=np.array([[600.0]]),
    )  # fmt: skip
    lengths = []

    def find(time, *series, band):
        lengths.append(time.size)
        return _find_ramp(time, *series, band=band)

    monkeypatch.setattr(hold_selection, "_find_ramp", find)
    one = select(time=number / 10, position=position, tension=100 * position, stand=stand)
    assert one.ramp.end_time == 19_900.0
    assert lengths == [1 << 16]


# the ramp before a hold, and what the rule of its centre is worth


def record(rate=0.2, stroke=1.0, power=1.0, rest=10.0, step=0.05):
    """Rest, then a constant-rate ramp of a specimen whose tension is stroke**power."""
    time = np.arange(0, rest + stroke / rate + step / 2, step)
    position = np.clip((time - rest) * rate, 0, stroke)
    return time, position, 100 * position**power


def test_a_linear_specimen_has_its_centre_at_half_the_ramp():
    ramp = _find_ramp(*record(), band=1e-3)
    assert ramp.start_time == pytest.approx(10, abs=0.06)
    assert ramp.end_time == pytest.approx(15)
    assert ramp.centre_time == pytest.approx(12.5, abs=0.05)
    assert ramp.duration == pytest.approx(5, abs=0.05)
    assert ramp.stiffness == pytest.approx(100)


@pytest.mark.parametrize("power", [2.0, 3.0])
def test_a_stiffening_specimen_has_its_centre_later(power):
    # The mean of t over d(t^p), t in 0..5, is 5 p / (p + 1).
    ramp = _find_ramp(*record(power=power), band=1e-3)
    assert ramp.centre_time == pytest.approx(10 + 5 * power / (power + 1), abs=0.05)
    # Its variance is p / ((p + 1)^2 (p + 2)) of the ramp time squared.
    spread = np.sqrt(12 * power / ((power + 1) ** 2 * (power + 2)))
    assert ramp.duration == pytest.approx(5 * spread, abs=0.05)


def test_noise_of_position_does_not_move_the_start():
    rng = np.random.default_rng(0)
    time, position, tension = record(rest=60.0)
    noisy = position + rng.uniform(-0.01, 0.01, time.size)
    ramp = _find_ramp(time, noisy, tension, band=0.02)
    assert ramp.start_time == pytest.approx(60, abs=0.25)
    assert ramp.centre_time == pytest.approx(62.5, abs=0.1)


def test_only_the_last_stroke_counts():
    time = np.arange(0, 20, 0.1)
    position = np.interp(time, [0, 5, 10, 20], [0, 2, 1, 3])
    ramp = _find_ramp(time, position, position, band=0.01)
    assert ramp.start_time == pytest.approx(10, abs=0.2)


def test_unloading_takes_the_centre_of_position():
    time = np.arange(0, 10.05, 0.1)
    position = 3 - np.clip(time - 5, 0, None) / 5
    ramp = _find_ramp(time, position, 100 * position, band=0.01)
    assert ramp.centre_time == pytest.approx(7.5, abs=0.1)


def test_without_motion_there_is_no_ramp():
    assert _find_ramp([0.0, 1.0, 2.0], [1.0, 1.0, 1.0], [5.0, 5.0, 5.0], band=0.01) is None


def test_the_rule_of_the_centre_holds_for_a_relaxation_of_any_spectrum():
    # Superposition of two terms and a logarithm after a ramp of a stiffening specimen.
    def relaxation(time):
        return 100 + 30 * np.exp(-time / 20) + 20 * np.exp(-time / 200) - 4 * np.log1p(time)

    time, position, elastic = record(power=2.0, step=0.01)
    ramp = _find_ramp(time, position, elastic, band=1e-4)
    added = np.diff(elastic) / elastic[-1]
    middle = (time[1:] + time[:-1]) / 2
    for multiple, tolerance in [(3, 0.004), (10, 0.0004)]:
        later = ramp.centre_time + multiple * ramp.duration
        exact = added @ relaxation(later - middle)
        step = relaxation(later - ramp.centre_time)
        assert abs(step - exact) < tolerance * abs(relaxation(1) - relaxation(100))


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        _find_ramp([0.0, 1.0], [0.0, 1.0, 2.0], [0.0, 1.0], band=0.1)
