"""Set left at slack, and the reasons where there is none."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.slack_length import (
    _slack_position,
    slack_crossings,
    slack_strain_at_unloading,
)

UP, DOWN = np.linspace(0, 2, 401), np.linspace(2, 0, 401)
POSITION = np.concatenate([UP, DOWN])
SLACK = 4.0


def pull(start, end):
    return 100 * np.clip(np.concatenate([UP - start, DOWN - end]), 0, None)


def test_set_is_the_shift_of_the_crossing_over_the_free_length():
    found = slack_strain_at_unloading(
        POSITION,
        [pull(0.2, 0.25), pull(0.3, 0.3)],
        slack_tension=SLACK,
        relaxed_free_length=[2.5, 2.5],
    )
    np.testing.assert_allclose(found.strain, [0.02, 0], atol=1e-9)
    assert found.remarks == (None, None)
    # 1 N later on both ways, at 100 N m-1 each: nothing between them
    np.testing.assert_allclose(found.by_tension, 0, atol=1e-12)


def test_a_specimen_that_is_softer_on_its_way_back_goes_slack_earlier_at_a_higher_tension():
    load = np.concatenate([100 * np.clip(UP - 0.2, 0, None), 50 * np.clip(DOWN - 0.25, 0, None)])
    found, later = (
        slack_strain_at_unloading(
            POSITION, [load], slack_tension=tension, relaxed_free_length=[2.5]
        )
        for tension in (SLACK, SLACK + 0.1)
    )
    assert found.by_tension[0] == pytest.approx((1 / 50 - 1 / 100) / 2.5)
    assert later.strain[0] - found.strain[0] == pytest.approx(0.1 * found.by_tension[0])


def test_a_lag_moves_both_crossings_by_their_rates():
    # up at 0.5 m a second, down at 1 m a second; logged a little late
    time = np.concatenate([UP / 0.5, 4.0 + (2 - DOWN) / 1.0])
    time[401:] += 0.01
    load = pull(0.2, 0.25)
    kwargs = {"slack_tension": SLACK, "relaxed_free_length": [2.5], "time": time}
    found = slack_strain_at_unloading(POSITION, [load], **kwargs)
    late = 0.004
    shifted = np.interp(time - late, time, load)
    later = slack_strain_at_unloading(POSITION, [shifted], **kwargs)
    assert found.by_lag[0] == pytest.approx((-1.0 - 0.5) / 2.5)
    assert later.strain[0] - found.strain[0] == pytest.approx(late * found.by_lag[0], rel=0.01)


def test_set_does_not_depend_on_the_datum_of_position():
    load = [pull(0.2, 0.25)]
    kwargs = {"slack_tension": SLACK, "relaxed_free_length": [2.5]}
    here = slack_strain_at_unloading(POSITION, load, **kwargs)
    there = slack_strain_at_unloading(POSITION + 7, load, **kwargs)
    np.testing.assert_allclose(here.strain, there.strain, atol=1e-9)


def test_the_stated_uncertainty_is_the_scatter_of_repeated_records():
    rng = np.random.default_rng(0)
    runs = [
        slack_strain_at_unloading(
            POSITION,
            [pull(0.2, 0.25) + 0.3 * rng.standard_normal(POSITION.size)],
            slack_tension=SLACK,
            relaxed_free_length=[2.5],
        )
        for _ in range(200)
    ]
    found = np.array([run.strain[0] for run in runs])
    stated = np.mean([run.standard_uncertainty[0] for run in runs])
    assert found.mean() == pytest.approx(0.02, abs=5e-4)
    assert stated == pytest.approx(found.std(), rel=0.25)


def test_missing_samples_are_left_out():
    load = pull(0.2, 0.25)
    load[::7] = np.nan
    found = slack_strain_at_unloading(
        POSITION, [load], slack_tension=SLACK, relaxed_free_length=[2.5]
    )
    assert found.strain[0] == pytest.approx(0.02, abs=1e-9)


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        (slice(0, 700), "the record does not return to slack"),
        (slice(100, None), "the record does not begin slack"),
        (slice(0, 20), "the specimen is never taut"),
        (slice(0, None, 40), "too few samples where the specimen goes slack"),
    ],
)
def test_a_record_that_does_not_show_it_gives_a_reason(rows, reason):
    found = slack_strain_at_unloading(
        POSITION[rows], [pull(0.2, 0.25)[rows]], slack_tension=SLACK, relaxed_free_length=[2.5]
    )
    assert np.isnan(found.strain[0])
    (remark,) = found.remarks
    assert str(remark) == f"slack strain at unloading not given: {reason}"
    assert remark.severity == "refusal"


def test_without_a_free_length_there_is_no_strain():
    found = slack_strain_at_unloading(
        POSITION, [pull(0.2, 0.25)], slack_tension=SLACK, relaxed_free_length=[np.nan]
    )
    assert np.isnan(found.strain[0])
    assert "the relaxed free length is not known" in str(found.remarks[0])


def test_set_after_rest_is_the_shift_between_two_first_crossings():
    first = slack_crossings(POSITION, pull(0.2, 0.4), slack_tension=SLACK).position
    second = slack_crossings(POSITION, pull(0.23, 0.4), slack_tension=SLACK).position
    assert second[0] - first[0] == pytest.approx(0.03)


def test_a_falling_line_has_no_crossing():
    crossing, _, _ = _slack_position(UP[:50], np.linspace(12, 4, 50), slack_tension=SLACK)
    assert np.isnan(crossing)


def test_three_samples_give_a_crossing_without_uncertainty():
    crossing, uncertainty, _ = _slack_position(
        [0.0, 0.1, 0.2], [5.0, 7.0, 9.0], slack_tension=SLACK
    )
    assert crossing == pytest.approx(-0.05)
    assert np.isnan(uncertainty)


def test_a_slack_tension_of_zero_is_refused():
    with pytest.raises(DataError, match="slack_tension are not positive"):
        slack_strain_at_unloading(
            POSITION, [pull(0.2, 0.2)], slack_tension=0.0, relaxed_free_length=[1.0]
        )


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        slack_strain_at_unloading(
            POSITION[:-1], [pull(0.2, 0.2)], slack_tension=1.0, relaxed_free_length=[1]
        )
