"""The statement of a campaign, read from the settings of an archive."""

import json
from dataclasses import asdict

import numpy as np
import pytest
import xarray as xr

from reduction.archive.shared_errors import curve_errors_of, stated_errors_of
from reduction.record.contributions import StatedErrors
from reduction.record.errors import ArchiveError


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
