"""What the log shows to be no standard uncertainty; limits by hand from the samples."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.reduce_test import check_stated_errors
from reduction.record.contributions import InstrumentErrors
from reduction.record.errors import SettingsError

TIME = np.arange(0.0, 41.0)
PLACE = "campaign.toml: uncertainty"


def located(cycles=True, **record):
    found = SimpleNamespace(first=np.array([0, 20]), last=np.array([20, 36]), n_cycles=2)
    readings = {"tension_standard_uncertainty": (), "position_standard_uncertainty": np.nan}
    return SimpleNamespace(
        record=SimpleNamespace(test_id="T-1", time=TIME, **(readings | record)),
        position=np.where(TIME == 7, np.nan, 2.0 + 0.1 * TIME),
        tension=np.array([10.0 * TIME - 50.0]),
        cycles=found if cycles else None,
    )


def check(cycles=True, record=(), **stated):
    errors = [InstrumentErrors("new", **stated)]
    return check_stated_errors(located(cycles, **dict(record)), errors, place=PLACE)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (
            {"tension_offset": 3501.0},
            r"campaign.toml: uncertainty.tension.offset: this is not a standard uncertainty for test "
            r"'T-1'; found 3501 N; needed at most 3500 N, ten times the greatest tension of 'new'",
        ),
        ({"tension_offset": 1e9 * 4.448}, r"uncertainty.tension.offset: .*found 4.448e\+09 N"),
        (
            {"tension_reading": 4448.0},
            r"uncertainty.tension.noise and resolution: .*found 4448 N; needed at most 3500 N",
        ),
        (
            {"position_offset": 60.1},
            r"uncertainty.crosshead_position.offset: .*found 60.1 m; needed at most 60 m, ten times",
        ),
        (
            {"position_reading": 70.0},
            r"uncertainty.crosshead_position.noise and resolution: .*needed at most 60 m",
        ),
        (
            {"lag": 3600.0},
            r"uncertainty.lag: .*found 3600 s; needed at most 20 s, the longest cycle",
        ),
        (
            {"lag": 20.1},
            r"uncertainty.lag: .*needed at most 20 s, the longest cycle. Correct it, or the unit"
            r" of time in the layout",
        ),
    ],
)
def test_what_the_log_makes_impossible_is_refused_with_its_key(stated, words):
    with pytest.raises(SettingsError, match=words):
        check(**stated)


def test_without_cycles_a_lag_is_held_against_the_record():
    assert check(cycles=False, lag=9.9) == ()
    with pytest.raises(SettingsError, match="needed at most 10 s, a quarter of the record"):
        check(cycles=False, lag=10.1)


def test_a_zero_of_a_large_instrument_in_a_small_test_can_be_meant():
    assert check(tension_offset=3500.0, tension_reading=400.0, position_offset=60.0) == ()


@pytest.mark.parametrize(
    ("declared", "stated", "words"),
    [
        (
            {"tension_standard_uncertainty": (1.0,)}, {"tension_reading": 1e6},
            "tension stated in [uncertainty] (1000000 N together) are not used",
        ),
        (
            {"position_standard_uncertainty": 1e-3}, {"position_reading": 2e-3},
            "the layout declares standard_uncertainty, 0.001 m",
        ),
    ],
)  # fmt: skip
def test_a_reading_of_which_the_layout_says_something_is_not_used_and_a_note_says_so(
    declared, stated, words
):
    (note,) = check(record=declared, **stated)
    assert note.severity == "note" and words in str(note)
    assert check(record=declared) == ()


@pytest.mark.parametrize(
    ("lag", "words"),
    [
        (0.79, None),
        (0.81, "0.81 s exceeds a twentieth of the period in 1 of 2 cycles (shortest 16 s)"),
        (1.01, "1.01 s exceeds a twentieth of the period in 2 of 2 cycles (shortest 16 s)"),
    ],
)
def test_a_lag_that_turns_a_loop_beyond_the_first_order_is_noted_as_a_warning(lag, words):
    notes = check(lag=lag)
    if words is None:
        assert notes == ()
        return
    (note,) = notes
    assert words in str(note)
    assert note.severity == "warning"


def test_beyond_a_twentieth_of_a_cycle_a_loop_loses_a_twentieth_of_its_stiffness():
    turn = 2 * np.pi / 20
    phase = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    late = np.sin(phase - turn)  # tension of a spring of 1 N/m, logged late
    assert 2 * np.mean(late * np.sin(phase)) == pytest.approx(0.95, abs=0.002)
