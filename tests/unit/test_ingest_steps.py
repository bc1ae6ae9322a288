import numpy as np
import pytest

from reduction.readers.sample_flags import _find_lone_steps, _noise_of, flag_record
from reduction.record.measurement import Record
from reduction.record.settings import QualitySettings

TIME = np.arange(0, 200, 0.1)
WAVE = np.abs(TIME % 20 - 10)
RANDOM = np.random.default_rng(19970612)
TENSION_NOISE, POSITION_NOISE = 0.3, 1e-3
TENSION = 200 + 10 * WAVE + RANDOM.normal(0, TENSION_NOISE, TIME.size)
POSITION = 6.0 + 0.1 * WAVE + RANDOM.normal(0, POSITION_NOISE, TIME.size)


def steps(tension, position=POSITION, noise=TENSION_NOISE):
    return _find_lone_steps(
        tension, position[np.newaxis], noise=noise, factor=12.0,
        noise_beside=np.array([POSITION_NOISE]),
    ).tolist()  # fmt: skip


def notes(*, tension=TENSION, position=POSITION, time=TIME, specimens=("new",)):
    load = np.atleast_2d(tension)
    record = Record(
        test_id="T-1", specimens=specimens, time=time.copy(), crosshead_position=position.copy(),
        tension=load.copy(), quality_flag=np.zeros(load.shape, dtype=np.uint16),
        crosshead_position_quality_flag=np.zeros(time.size, dtype=np.uint16),
        n_rows_read=time.size,
    )  # fmt: skip
    return tuple(map(str, flag_record(record, settings=QualitySettings()).notes))


@pytest.mark.parametrize("at", [None, 1234])
@pytest.mark.parametrize("is_sine", [False, True])
@pytest.mark.parametrize("until", [1860, 1903])  # between two turns, beside one
def test_friction_that_turns_with_the_motion_is_no_step(at, is_sine, until):
    wave = (
        5 - 5 * np.sin(np.pi * (TIME + 0.03) / 10) if is_sine else np.abs((TIME + 0.03) % 20 - 10)
    )
    tension = 200 + 10 * wave + 15 * np.sign(np.diff(wave, append=wave[-1]))
    tension += RANDOM.normal(0, TENSION_NOISE, TIME.size)
    if at is not None:
        tension[at:] += 60
    position = 6.0 + 0.1 * wave + RANDOM.normal(0, POSITION_NOISE / 10, TIME.size)
    found = notes(tension=tension[:until], position=position[:until], time=TIME[:until])
    steps_of = [one for one in found if "steps from" in one]
    assert len(steps_of) == (at is not None)
    assert all(f"between sample {at} " in one and "more such" not in one for one in steps_of)


@pytest.mark.parametrize("place", [1, 50, 100, 777, 1500, 1998])
@pytest.mark.parametrize("size", [-60.0, 9.0, 400.0])
def test_a_step_that_stays_is_found_at_its_sample(place, size):
    tension = TENSION.copy()
    tension[place:] += size
    assert steps(tension) == [place - 1]


@pytest.mark.parametrize("factor", [4.4482216, 1 / 4.4482216, 0.1, -1.0])
def test_another_unit_from_a_row_on_is_a_step(factor):
    tension = TENSION.copy()
    tension[912:] *= factor
    assert steps(tension) == [911]


def test_a_step_that_the_other_channel_makes_as_well_is_the_test():
    tension, position = TENSION.copy(), POSITION.copy()
    tension[912:] += 80.0
    position[912:] += 0.8
    assert steps(tension) == [911]
    assert steps(tension, position) == []


def test_a_step_whose_motion_the_noise_of_the_position_hides_is_none():
    tension = TENSION.copy()
    tension[912:] += 80.0
    # of a stiff wire: 80 N are a tenth of what the position can show
    assert steps(tension, 6.0 + (POSITION - 6.0) / 1e3, noise=TENSION_NOISE) == []


@pytest.mark.parametrize("readings", [3.3, 4.4, 6.3])
def test_the_end_of_a_quick_ramp_of_a_stiffening_rope_is_no_step(readings):
    """Three to six readings a ramp: the load rises most in the last, the position evenly."""
    time = np.arange(400.0) + 0.3
    away = np.interp(time, [0, 99, 99 + readings, 250, 250 + readings, 400], [0, 0, 1, 1, 0, 0])
    position = 6.0 + away + RANDOM.normal(0, POSITION_NOISE, time.size)
    tension = 200 * np.expm1(3.5 * away) / np.expm1(3.5) + RANDOM.normal(0, 0.05, time.size)
    assert steps(tension, position, noise=0.05) == []


def test_what_comes_back_at_once_is_no_step_that_stays():
    tension = TENSION.copy()
    tension[912] += 80.0
    assert steps(tension) == []


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_step_counts_from_twelve_times_the_noise_and_a_twentieth_of_the_range(share):
    tension = np.where(TIME < 100, 0.0, share * 12 * TENSION_NOISE)
    tension += np.where(TIME % 2 < 1, 0.0, 1e-3)
    assert steps(tension) == ([999] if share > 1 else [])
    tension = np.linspace(0, 100, TIME.size)
    low = 0.05 * 98.0  # of the range between the outer hundredths
    tension[1000:] += share * low / (1 - 0.05 * share)
    assert steps(tension) == ([999] if share > 1 else [])


@pytest.mark.parametrize("every", [7, 40, 100])
def test_coarse_samples_of_waves_step_nowhere(every):
    square = np.where(np.arange(400) % 8 < 4, 0.0, 1.0)
    for values in (TENSION[::every], np.round(TENSION[::every], -1)):
        assert steps(values, POSITION[::every], _noise_of(values)[0]) == []
    assert steps(100 * square, square) == []


def test_missing_samples_hide_nothing_beside_them_and_are_no_step():
    tension = TENSION.copy()
    tension[[200, 909, 1400]] = np.nan
    tension[912:] += 80.0
    assert steps(tension) == [911]
    tension[912] = np.nan
    assert steps(tension) == []


def test_the_note_says_channel_values_sample_and_time():
    tension = TENSION.copy()
    tension[912:] *= 4.4482216
    (note,) = notes(tension=np.array([TENSION, tension]), specimens=("a", "b"))
    low, high = tension[911], tension[912]
    assert note.startswith(
        f"tension of 'b' steps from {low:.4g} to {high:.4g} N between sample 912 (91.1 s) and the "
        "next, and stays there, while the position does not. Possible causes: a slip, a break, "
    )
    position = POSITION.copy()
    position[912:] *= 0.3048
    position[1312:] *= 0.3048
    (note,) = notes(position=position)
    assert note.startswith("crosshead_position steps from ") and "(1 more such step)" in note
    assert "while tension does not" in note


def test_noise_of_a_crosshead_that_stands_is_no_turn_of_friction():
    """Dwells after a drag: with some of these jerks taken for friction, the rest looked few."""
    knots = np.cumsum(np.r_[0, np.tile([3.0, 10.0], 16)])
    place = np.r_[0, np.repeat(np.tile([0.05, 0.0], 8), 2)]
    time = np.arange(0, knots[-1], 0.1)
    moved = np.interp(time, knots, place)
    drag = 30 * np.sign(np.round(np.gradient(moved, time), 6))
    tension = 400 + 2000 * moved + drag + RANDOM.normal(0, TENSION_NOISE, time.size)
    position = 1 + moved + RANDOM.normal(0, 2e-5, time.size)
    (found,) = notes(tension=tension[None], position=position, time=time, specimens=("a",))
    assert "So many are not slips" in found


def test_one_reading_at_the_end_is_no_step_that_stays():
    """`14920.5`, cut off after its fourth digit."""
    tension = TENSION.copy()
    tension[-1] /= 10
    (note,) = notes(tension=np.array([tension]), specimens=("a",))
    assert note.startswith(f"the last reading of tension of 'a' is {tension[-1]:.4g} N, the one")


@pytest.mark.parametrize("fault", ["gap", "missing", "stuck", "drop-out"])
def test_what_a_flag_has_told_is_not_told_twice(fault):
    tension, time = TENSION.copy(), TIME.copy()
    if fault == "gap":
        tension[912:] += 80.0
        time[912:] += 60.0
    elif fault == "missing":
        tension[912:] += 80.0
        tension[912] = np.nan
    elif fault == "stuck":
        tension[730:812] = tension[730]
    else:
        tension[912:920] = 0.0
    assert notes(tension=tension, time=time)
    assert not any("steps from" in note for note in notes(tension=tension, time=time))
