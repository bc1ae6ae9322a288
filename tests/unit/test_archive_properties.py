"""Properties of ropes in an archive, and steps out of archives."""

import json
import math

import numpy as np
import pytest
import xarray as xr

from reduction.archive.open import open_archive
from reduction.archive.properties import properties_to_dataset
from reduction.archive.rope_steps import step_of_archive
from reduction.archive.write import write_archive
from reduction.errors import ArchiveError
from reduction.line.propertyproduct import ChangeInLength
from reduction.provenance import Origin, Source, Step

ORIGIN = Origin(
    campaign_id="ropes",
    attributes={"title": "Ropes", "synthetic": "yes"},
    sources=[Source("T-1.nc", "0" * 64, 12)],
    steps=[Step("change in length", "made for a test")],
    settings_json="{}",
    version="0",
    command="reduction run",
)
FOUND = {
    "R-1": (
        ChangeInLength("static stiffness", 5e5, 60.0, 5.0, 6e-4, 1e4, 3e4, 600.0, "T-1"),
        ChangeInLength("working strain", 0.04, 1e-5, low_tension=1e4, high_tension=3e4, step="T-1"),
    ),
    "R-2": (ChangeInLength("polymer strain", reason="no step holds a constant tension"),),
}


def test_a_stiffness_and_a_strain_have_names_of_their_own(tmp_path):
    write_archive(properties_to_dataset(FOUND, origin=ORIGIN), tmp_path / "change_in_length.nc")
    with open_archive(tmp_path / "change_in_length.nc") as archive:
        assert archive["property_specimen"].values.tolist() == ["R-1", "R-1", "R-2"]
        assert archive["property_stiffness"].values[0] == 5e5
        assert np.isnan(archive["property_strain"].values[0])
        assert archive["property_strain_standard_uncertainty"].values[1] == 1e-5
        assert np.isnan(archive["property_stiffness"].values[1:]).all()
        assert archive["property_remark"].values[2] == "no step holds a constant tension"
        assert "R-1 and R-2" in archive.attrs["summary"]
        assert "synthetic" in archive.attrs["title"]


def test_nothing_is_no_archive():
    with pytest.raises(ArchiveError, match="there are no properties to keep"):
        properties_to_dataset({}, origin=ORIGIN)


def step(**variables):
    settings = json.dumps({"reduction": {"rope": {"reference_time": 600.0}}})
    return xr.Dataset(
        {"specimen": ("specimen", ["R-1", "R-2"]), **variables},
        attrs={"test": "T-1", "settings": settings},
    )


def test_a_step_has_the_specimen_that_is_asked_for():
    with pytest.raises(ArchiveError, match="no specimen 'R-3'; found R-1, R-2"):
        step_of_archive(step(), "R-3")


def test_a_test_that_is_no_step_has_nothing_but_its_reference_time():
    found = step_of_archive(step(), "R-2")
    assert (found.name, found.reference_time) == ("T-1", 600.0)
    assert (found.first_rise, found.bedding, found.level) == (None, None, None)
    assert found.pairs == found.holds == ()


def held(programme_step):
    return step(
        programme_step=((), programme_step),
        hold_specimen=("hold", ["R-1", "R-2", "R-2"]),
        hold_kind=("hold", ["creep", "creep", "relaxation"]),
        hold_start_time=("hold", [100.0, 100.0, 100.0]),
        hold_duration=("hold", [900.0, 900.0, 900.0]),
        hold_ramp_centre_time=("hold", [np.nan, 90.0, 90.0]),
        hold_initial_tension=("hold", [10.0, 20.0, 30.0]),
        hold_final_tension=("hold", [10.0, 22.0, 30.0]),
        creep_rate_per_decade=("hold", [np.nan, 1e-3, np.nan]),
        creep_rate_per_decade_standard_uncertainty=("hold", [np.nan, 1e-5, np.nan]),
        hold_refusal=("hold", ["no ramp", "", ""]),
    )


def test_time_in_a_hold_counts_from_the_centre_of_its_ramp():
    (hold,) = step_of_archive(held("creep"), "R-2").holds
    assert (hold.tension, hold.end_time, hold.creep_per_decade) == (21.0, 910.0, 1e-3)
    (bare,) = step_of_archive(held("creep"), "R-1").holds
    assert bare.end_time == 900.0
    assert math.isnan(bare.creep_per_decade)
    assert bare.reason == "no ramp"


def test_standstills_between_cycles_are_no_holds_of_a_programme():
    assert step_of_archive(held("dynamic stiffness"), "R-2").holds == ()


def test_a_stiffness_beyond_the_hold_says_so():
    pair = {
        "held_pair_specimen": ["R-1", "R-1"],
        "static_refusal": ["", "the lower hold has no strain"],
        "held_pair_low_tension": [10.0, 20.0],
        "held_pair_high_tension": [20.0, 30.0],
        "static_reference_time": [600.0, np.nan],
        "static_stiffness": [500.0, np.nan],
        "static_stiffness_standard_uncertainty": [5.0, np.nan],
    }
    dataset = step(
        **{name: ("held_pair", values) for name, values in pair.items()},
        static_elapsed_time=(("held_pair", "held_pair_point"), [[30.0, 300.0], [np.nan] * 2]),
    )
    beyond, refused = step_of_archive(dataset, "R-1").pairs
    assert beyond.reason.startswith("read off the line beyond the hold")
    assert beyond.stiffness == 500.0
    assert refused.reason == "the lower hold has no strain"
    assert step_of_archive(dataset, "R-2").pairs == ()


def test_a_first_rise_of_one_strain_is_none():
    def rise(*tension):
        load = np.full((2, 2, len(tension)), np.nan)
        load[0, 0] = tension
        dims = ("specimen", "branch_name", "first_loading_strain_bin")
        return step(
            first_loading_strain_bin=(dims[2], 0.01 * np.arange(len(tension))),
            branch_tension_first_loading=(dims, load),
            branch_tension_first_loading_standard_uncertainty=(dims, 0 * load),
        )

    assert step_of_archive(rise(5.0, np.nan, np.nan), "R-1").first_rise is None
    found = step_of_archive(rise(5.0, np.nan, 9.0), "R-1").first_rise
    assert found.tension.tolist() == [5.0, 9.0]
    assert found.spacing == 0.01


def test_the_first_rise_ends_where_the_first_cycle_turns():
    # the peaks of later cycles go further at the same tension: they are no part of the rise
    dims = ("specimen", "branch_name", "first_loading_strain_bin")
    load = np.full((2, 2, 4), np.nan)
    load[0, 0] = [10.0, 20.0, 30.0, 30.0]
    found = step_of_archive(
        step(
            first_loading_strain_bin=(dims[2], [0.01, 0.02, 0.03, 0.05]),
            branch_tension_first_loading=(dims, load),
            branch_tension_first_loading_standard_uncertainty=(dims, 0 * load),
            cycle_last_sample=("cycle", [2, 4]),
            strain=(("specimen", "sample"), [[0.0, 0.032, 0.01, 0.055, 0.02], [0.0] * 5]),
        ),
        "R-1",
    ).first_rise
    assert found.tension.tolist() == [10.0, 20.0, 30.0]


def test_bedding_in_has_the_foot_of_its_first_cycle_and_the_greatest_peak():
    of_cycles = {
        "mean_strain": [0.05, 0.07],
        "mean_strain_standard_uncertainty": [0.003, 0.9],
        "strain_amplitude": [0.02, 0.01],
        "strain_amplitude_standard_uncertainty": [0.004, 0.9],
        "valley_tension": [40.0, 41.0],
        "peak_tension": [75.0, 80.0],
    }
    of_step = {
        "bedding_first_stiffness": 900.0,
        "bedding_first_stiffness_standard_uncertainty": 2.0,
        "bedding_permanent_strain": 0.03,
        "bedding_permanent_strain_standard_uncertainty": 0.002,
        "dynamic_stiffness": 1000.0,
    }
    found = step_of_archive(
        step(
            **{
                name: (("specimen", "cycle"), [[np.nan] * 2, values])
                for name, values in of_cycles.items()
            },
            **{name: ("specimen", [np.nan, value]) for name, value in of_step.items()},
        ),
        "R-2",
    )
    cycles = found.bedding
    assert (cycles.first_stiffness, cycles.permanent_strain) == (900.0, 0.03)
    assert cycles.foot_strain == pytest.approx(0.03)
    assert cycles.foot_strain_standard_uncertainty == pytest.approx(0.005)
    assert (cycles.valley_tension, cycles.first_peak_tension, cycles.peak_tension) == (40, 75, 80)
    # of a rope that still settles: no level
    assert found.level is None
