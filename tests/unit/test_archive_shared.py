"""Random and shared parts of an uncertainty on their way into an archive."""

import json
from dataclasses import asdict

import numpy as np
import pytest
import xarray as xr

from reduction.archive.shared_errors import curve_errors_of, stated_errors_of, with_shared
from reduction.record.contributions import Component, Contributions, StatedErrors
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
    found = with_shared(values(), contributions(), {}, {})
    assert found["segment_modulus_standard_uncertainty"][0, 0, 0] == 5.0
    assert found["segment_modulus_random_standard_uncertainty"][0, 0, 0] == 4.0
    assert found["uncertainty_source"].tolist() == ["tension_gain", "strain_calibration"]
    assert found["uncertainty_source_of"].tolist() == ["cell", "new"]
    assert found["uncertainty_source_number"].tolist() == [0, 2]


def test_nothing_contributes_to_a_number_that_is_not_there():
    found = with_shared(values(), contributions(), {}, {})
    assert np.isnan(found["segment_modulus_uncertainty_contribution"][:, 0, 0, 1]).all()


def test_a_curve_of_one_cycle_shares_the_error_of_the_mean():
    found = with_shared(values(), contributions(), {}, {})
    spread = found["tangent_modulus_by_cycle_standard_uncertainty"]
    assert (spread[:, :, 0] == 5.0).all() and (spread[:, :, 1] == 4.0).all()


def test_a_cycle_has_its_noise_and_what_all_cycles_share():
    found = with_shared(values(), None, {"peak_tension": np.array([[4.0]])}, {})
    assert found["peak_tension_standard_uncertainty"][0, 0] == 5.0
    assert "uncertainty_source" not in found


def test_where_nothing_is_shared_nothing_changes():
    before = values()
    found = with_shared(before, None, {}, {})
    assert found.keys() == before.keys()


def test_where_a_contribution_is_not_known_the_uncertainty_is_not_either():
    unknown = np.full((2, 1, 2, 1), np.nan)
    found = with_shared(
        values() | {"tangent_modulus_standard_uncertainty": np.ones((1, 2, 1))},
        Contributions((CELL, TAPE), {"tangent_modulus": unknown}), {}, {},
    )  # fmt: skip
    assert np.isnan(found["tangent_modulus_standard_uncertainty"]).all()
    assert (found["tangent_modulus_random_standard_uncertainty"] == 1.0).all()


def test_contributions_without_a_variable_are_refused_and_not_dropped():
    lost = Contributions((Component("tension_gain", "cell"),), {"test_speed": np.ones((1, 1))})
    with pytest.raises(ArchiveError, match="no variable for contributions of shared errors"):
        with_shared(values(), lost, {}, {})


def channel(reading, rows):
    """Parts of the uncertainty of tension, by the suffix of their variable."""
    before = {"tension": np.zeros((2, 9))}
    if reading is not None:
        before["tension_standard_uncertainty"] = np.array(reading)
    found = with_shared(before, Contributions((CELL,), {"tension": np.array([rows])}), {}, {})
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


# the statement of a campaign, read from the settings of an archive


def archive(uncertainty=None):
    settings = {} if uncertainty is None else {"uncertainty": uncertainty}
    return xr.Dataset(attrs={"settings": json.dumps(settings)})


def test_what_was_written_is_read_again():
    stated = StatedErrors(tension_gain=0.0025, lag=0.02, has_one_load_cell=True)
    assert stated_errors_of(archive(asdict(stated))) == stated


def test_an_archive_without_a_statement_states_nothing():
    for found in map(stated_errors_of, (archive(), xr.Dataset(), archive({}))):
        assert found == StatedErrors() and not found.has_any


def test_one_load_cell_alone_is_no_error():
    assert not StatedErrors(has_one_load_cell=True).has_any
    assert StatedErrors(diameter=1e-5).has_any


def test_a_key_of_a_later_version_is_left_aside():
    assert stated_errors_of(archive({"lag": 0.02, "humidity": 3.0})) == StatedErrors(lag=0.02)


@pytest.mark.parametrize(
    ("kept", "words"),
    [
        ({"lag": "20 ms"}, "no standard uncertainty as lag; found '20 ms'; needed a number in SI"),
        ({"lag": True}, "as lag; found True"),
        ({"has_one_load_cell": 1.0}, "as has_one_load_cell; found 1.0; needed true or false"),
    ],
)
def test_what_is_no_statement_is_refused(kept, words):
    with pytest.raises(ArchiveError, match=words):
        stated_errors_of(archive(kept))


def test_a_test_without_a_diameter_has_the_scales_and_the_zero_that_were_stated():
    """Load of 2 kN at 40 %: 1 % of both scales, 8 N of zero, and 1 cm of a length of 2 m."""
    stated = StatedErrors(tension_gain=0.01, tension_offset=8.0, position_gain=0.01, lag=0.002)
    test = archive(asdict(stated)).assign(
        strain_gauge_length=("specimen", [2.0]),
        strain_gauge_length_standard_uncertainty=("specimen", [0.01]),
    )
    errors, notes = curve_errors_of(test, 0)
    found = errors.at(np.array([0.4]), np.full((2, 1), 2000.0))
    name = [one.source for one in errors.component]
    assert name == ["tension_offset", "tension_gain", "strain_gain"]
    assert found.tension[:, 0, 0] == pytest.approx([8.0, 20.0, 0.0])
    assert found.strain[:, 0, 0] == pytest.approx([0.0, 0.0, 0.4 * np.hypot(0.005, 0.01)])
    # the lag is left out, and nothing else
    assert [one.code for one in notes] == ["no-curve-of-errors"]
    assert not curve_errors_of(archive({"tension_gain": 0.01}).assign(test.variables), 0)[1]
