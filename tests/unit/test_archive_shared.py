"""Random and shared parts of an uncertainty on their way into an archive."""

import numpy as np
import pytest

from reduction.archive.shared_errors import with_shared
from reduction.record.contributions import Component, Contributions
from reduction.record.errors import ArchiveError

CELL, TAPE = Component("tension_gain", "cell"), Component("strain_calibration", "new", 2)


def values():
    return {
        "segment_modulus": np.array([[[100.0, np.nan]]]),
        "segment_modulus_standard_uncertainty": np.array([[[4.0, np.nan]]]),
        "peak_tension": np.array([[7.0]]),
        "peak_tension_standard_uncertainty": np.array([[3.0]]),
        "tangent_modulus": np.array([[[5.0], [6.0]]]),
        "tangent_modulus_standard_uncertainty": np.zeros((1, 2, 1)),
        "tangent_modulus_by_cycle": np.ones((1, 3, 2, 1)),
        "tangent_modulus_by_cycle_standard_uncertainty": np.full((1, 3, 2, 1), 4.0),
    }


def contributions():
    return Contributions(
        (CELL, TAPE),
        {
            "segment_modulus": np.array([[[[3.0, 1.0]]], [[[0.0, 1.0]]]]),
            "tangent_modulus": np.array([[[[3.0], [0.0]]], [[[0.0], [0.0]]]]),
        },
    )


def test_the_standard_uncertainty_holds_both_parts_and_the_random_one_stands_beside():
    found = with_shared(values(), contributions(), {})
    assert found["segment_modulus_standard_uncertainty"][0, 0, 0] == 5.0
    assert found["segment_modulus_random_standard_uncertainty"][0, 0, 0] == 4.0
    assert found["uncertainty_source"].tolist() == ["tension_gain", "strain_calibration"]
    assert found["uncertainty_source_of"].tolist() == ["cell", "new"]
    assert found["uncertainty_source_number"].tolist() == [0, 2]


def test_nothing_contributes_to_a_number_that_is_not_there():
    found = with_shared(values(), contributions(), {})
    assert np.isnan(found["segment_modulus_uncertainty_contribution"][:, 0, 0, 1]).all()


def test_a_curve_of_one_cycle_shares_the_error_of_the_mean():
    found = with_shared(values(), contributions(), {})
    spread = found["tangent_modulus_by_cycle_standard_uncertainty"]
    assert (spread[:, :, 0] == 5.0).all() and (spread[:, :, 1] == 4.0).all()


def test_a_cycle_has_its_noise_and_what_all_cycles_share():
    found = with_shared(values(), None, {"peak_tension": np.array([[4.0]])})
    assert found["peak_tension_standard_uncertainty"][0, 0] == 5.0
    assert "uncertainty_source" not in found


def test_where_nothing_is_shared_nothing_changes():
    before = values()
    found = with_shared(before, None, {})
    assert found.keys() == before.keys()


def test_where_a_contribution_is_not_known_the_uncertainty_is_not_either():
    unknown = np.full((2, 1, 2, 1), np.nan)
    found = with_shared(
        values() | {"tangent_modulus_standard_uncertainty": np.ones((1, 2, 1))},
        Contributions((CELL, TAPE), {"tangent_modulus": unknown}), {},
    )  # fmt: skip
    assert np.isnan(found["tangent_modulus_standard_uncertainty"]).all()
    assert (found["tangent_modulus_random_standard_uncertainty"] == 1.0).all()


def test_contributions_without_a_variable_are_refused_and_not_dropped():
    lost = Contributions((Component("tension_gain", "cell"),), {"test_speed": np.ones((1, 1))})
    with pytest.raises(ArchiveError, match="no variable for contributions of shared errors"):
        with_shared(values(), lost, {})


def channel(reading, rows):
    """Parts of the uncertainty of tension, by the suffix of their variable."""
    before = {"tension": np.zeros((2, 9))}
    if reading is not None:
        before["tension_standard_uncertainty"] = np.array(reading)
    found = with_shared(before, Contributions((CELL,), {"tension": np.array([rows])}), {})
    return [
        found[f"tension{suffix}"].tolist()
        for suffix in (
            "_random_standard_uncertainty", "_uncertainty_contribution", "_standard_uncertainty",
        )
    ]  # fmt: skip


def test_a_channel_keeps_what_one_reading_adds_apart_from_what_all_samples_share():
    assert channel([3.0, 0.5], [4.0, 0.0]) == [[3.0, 0.5], [[4.0, 0.0]], [5.0, 0.5]]


def test_of_a_channel_nothing_known_of_a_reading_counts_as_zero_beside_what_is_known():
    random, rows, both = channel(None, [4.0, 0.0])
    assert rows == [[4.0, 0.0]]
    assert random[0] == 0.0 and both[0] == 4.0
    # of the second nothing is known at all
    assert np.isnan(random[1]) and np.isnan(both[1])
