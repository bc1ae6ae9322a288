"""What the log shows to be no standard uncertainty; limits by hand from the samples."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.errors import SettingsError
from reduction.pipeline.statedlimits import check_stated_errors
from reduction.uncertainty.product import InstrumentErrors

TIME = np.arange(0.0, 41.0)
PLACE = "campaign.toml: uncertainty"


def located(cycles=True):
    found = SimpleNamespace(first=np.array([0, 20]), last=np.array([20, 36]), n_cycles=2)
    return SimpleNamespace(
        record=SimpleNamespace(test_id="T-1", time=TIME),
        position=np.where(TIME == 7, np.nan, 2.0 + 0.1 * TIME),
        tension=np.array([10.0 * TIME - 50.0]),
        cycles=found if cycles else None,
    )


def check(cycles=True, **stated):
    check_stated_errors(located(cycles), [InstrumentErrors("new", **stated)], place=PLACE)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        (
            {"tension_offset": 351.0},
            r"campaign.toml: uncertainty.tension.offset: this is no standard uncertainty for test "
            r"'T-1'; found 351 N; needed at most 350 N, the greatest tension of 'new'",
        ),
        (
            {"tension_reading": 4448.0},
            r"uncertainty.tension.noise and resolution: .*found 4448 N; needed at most 350 N",
        ),
        (
            {"position_offset": 6.1},
            r"uncertainty.crosshead_position.offset: .*found 6.1 m; needed at most 6 m, the great",
        ),
        (
            {"position_reading": 7.0},
            r"uncertainty.crosshead_position.noise and resolution: .*needed at most 6 m",
        ),
        (
            {"lag": 3600.0},
            r"uncertainty.lag: .*found 3600 s; needed at most 4 s, a quarter of the shortest cycle",
        ),
    ],
)
def test_what_the_log_makes_impossible_is_refused_with_its_key(stated, words):
    with pytest.raises(SettingsError, match=words):
        check(**stated)


def test_without_cycles_a_lag_is_held_against_the_record():
    check(cycles=False, lag=9.9)
    with pytest.raises(SettingsError, match="needed at most 10 s, a quarter of the record"):
        check(cycles=False, lag=10.1)


def test_what_can_be_meant_passes():
    check(tension_offset=350.0, tension_reading=1.0, position_offset=6.0, lag=4.0)
