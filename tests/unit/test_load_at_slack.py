"""What a load cell reads at slack, and whether its zero or its sign is wrong."""

import numpy as np
import pytest

from reduction.stages.load_at_slack import LoadAtSlack, load_at_slack, notes_on_zero
from reduction.stages.standstills import Standstills

PLACE = np.linspace(0, 1, 500)


def rests(*rows):
    """Standstills of the samples from one to the other, both inside."""
    first, last = np.array(rows).T
    return Standstills(
        first=first, last=last, start_time=0.1 * first, end_time=0.1 * last,
        mean_position=np.zeros(first.size), mean_tension=np.zeros((1, first.size)),
        is_rest=np.ones(first.size, dtype=bool), position_tolerance=0.01, slack_tension=5.0,
    )  # fmt: skip


def notes(load, rest, zero="-14.4 N", offset=0.0):
    found = notes_on_zero(
        ["new"], PLACE, np.array([load]), [rest], [zero], offset_uncertainty=offset
    )
    return [one.code for one in found]


def test_the_mean_over_rests_has_the_noise_of_all_their_samples():
    load = np.random.default_rng(4).normal(-14.4, 0.5, 1000)
    found = load_at_slack(load, rests((0, 299), (900, 999)), np.array([True, True]))
    assert found.n_rests == 2
    # 0.5 N over the root of 400
    assert found.standard_uncertainty == pytest.approx(0.025, rel=0.1)
    assert found.load == pytest.approx(-14.4, abs=4 * 0.025)
    assert load_at_slack(load, rests((0, 9)), np.array([False])) is None


def test_steps_of_a_converter_do_not_average_out():
    # noise of a fifth of a step of 1 N about 0.5: flickers between two codes
    raw = np.random.default_rng(4).normal(0.5, 0.2, 1000)
    found = load_at_slack(np.round(raw), rests((0, 999)), np.array([True]))
    assert found.standard_uncertainty > 1 / 12**0.5 / 2


@pytest.mark.parametrize(
    ("slope", "zero", "said"),
    [
        (400.0, -14.4, ["load-zero-wrong"]),
        (400.0, 14.4, ["load-zero-wrong"]),
        (400.0, -1000.0, ["load-zero-wrong"]),
        (400.0, -2.0, ["load-zero-off"]),  # half a hundredth of 400 N
        (400.0, 0.1, []),  # three standard errors
        (-400.0, 0.0, ["load-falls-with-stretch"]),
        (-400.0, -14.4, ["load-falls-with-stretch"]),
    ],
)
def test_zero_and_sign_are_told_apart_by_the_way_the_load_goes(slope, zero, said):
    rest = LoadAtSlack(zero, 0.035, 1, zero, zero)
    assert notes(slope * PLACE + zero, rest) == said


def test_what_is_stated_of_the_zero_is_no_warning():
    rest = LoadAtSlack(-14.4, 0.035, 1, -14.4, -14.4)
    assert notes(400 * PLACE - 14.4, rest, offset=8.0) == ["load-zero-off"]
    assert notes(400 * PLACE - 14.4, rest, offset=7.0) == ["load-zero-wrong"]


def test_without_a_rest_the_zero_is_not_known():
    assert notes(400 * PLACE - 300, None, "") == ["load-negative"]
    assert notes(400 * PLACE + 300, None, "") == []
