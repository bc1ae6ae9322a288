"""Properties of ropes in an archive, and steps out of archives."""

import json
import math

import numpy as np
import pytest
import xarray as xr

from reduction.archive.open import open_archive
from reduction.archive.rope_properties import properties_to_dataset, step_of_archive
from reduction.archive.write import write_archive
from reduction.record.contributions import Component, InstrumentErrors
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Origin, Source, Step
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.change_in_length import ChangeInLength

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
    write_archive(properties_to_dataset(FOUND, {}, origin=ORIGIN), tmp_path / "change_in_length.nc")
    with open_archive(tmp_path / "change_in_length.nc") as archive:
        assert archive["property_specimen"].values.tolist() == ["R-1", "R-1", "R-2"]
        assert archive["property_stiffness"].values[0] == 5e5
        assert np.isnan(archive["property_strain"].values[0])
        assert archive["property_strain_standard_uncertainty"].values[1] == 1e-5
        assert np.isnan(archive["property_stiffness"].values[1:]).all()
        assert archive["property_remark"].values[2] == "no step holds a constant tension"
        assert "R-1 and R-2" in archive.attrs["summary"]
        assert "synthetic" in archive.attrs["title"]


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
    found = step_of_archive(step(), "R-2").step
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
    (hold,) = step_of_archive(held("creep"), "R-2").step.holds
    assert (hold.tension, hold.end_time, hold.creep_per_decade.value) == (21.0, 910.0, 1e-3)
    (bare,) = step_of_archive(held("creep"), "R-1").step.holds
    assert bare.end_time == 900.0
    assert math.isnan(bare.creep_per_decade.value)
    assert bare.reason == "no ramp"


def test_standstills_between_cycles_are_no_holds_of_a_programme():
    assert step_of_archive(held("dynamic stiffness"), "R-2").step.holds == ()


def test_a_stiffness_beyond_the_hold_says_so():
    pair = {
        "held_pair_specimen": ["R-1", "R-1"],
        "static_refusal": ["", "the lower hold has no strain"],
        "held_pair_low_tension": [10.0, 20.0],
        "held_pair_high_tension": [20.0, 30.0],
        "held_pair_low_tension_standard_uncertainty": [0.1, 0.1],
        "held_pair_high_tension_standard_uncertainty": [0.1, 0.1],
        "static_reference_time": [600.0, np.nan],
        "static_stiffness": [500.0, np.nan],
        "static_stiffness_standard_uncertainty": [5.0, np.nan],
    }
    dataset = step(
        **{name: ("held_pair", values) for name, values in pair.items()},
        static_elapsed_time=(("held_pair", "held_pair_point"), [[30.0, 300.0], [np.nan] * 2]),
    )
    beyond, refused = step_of_archive(dataset, "R-1").step.pairs
    assert beyond.reason.startswith("extrapolated beyond the hold")
    assert beyond.stiffness.value == 500.0
    assert refused.reason == "the lower hold has no strain"
    assert step_of_archive(dataset, "R-2").step.pairs == ()


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

    assert step_of_archive(rise(5.0, np.nan, np.nan), "R-1").step.first_rise is None
    found = step_of_archive(rise(5.0, np.nan, 9.0), "R-1").step.first_rise
    assert found.tension.tolist() == [5.0, 9.0]
    assert found.spacing == 0.01


@pytest.mark.parametrize("is_part", [False, True])
def test_the_first_rise_ends_where_the_first_cycle_turns(is_part):
    # the peaks of later cycles go further at the same tension: they are no part of the rise
    dims = ("specimen", "branch_name", "first_loading_strain_bin")
    load = np.full((2, 2, 4), np.nan)
    load[0, 0] = [10.0, 20.0, 30.0, 30.0]
    found = step_of_archive(
        step(
            first_loading_strain_bin=(dims[2], [0.01, 0.02, 0.03, 0.05]),
            branch_tension_first_loading=(dims, load),
            branch_tension_first_loading_standard_uncertainty=(dims, 0 * load),
            # of a record that is stored in part places are still those of the record
            cycle_last_sample=("cycle", [900, 4000] if is_part else [2, 4]),
            **({"sample_index": ("sample", [0, 500, 900, 901, 4000])} if is_part else {}),
            strain=(("specimen", "sample"), [[0.0, 0.032, 0.01, 0.055, 0.02], [0.0] * 5]),
        ),
        "R-1",
    ).step.first_rise
    assert found.tension.tolist() == [10.0, 20.0, 30.0]


def test_bedding_in_has_the_foot_of_its_first_cycle_and_the_greatest_peak():
    of_cycles = {
        "foot_strain": [0.03, 0.06],
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
    ).step
    cycles = found.bedding
    assert (cycles.first_stiffness.value, cycles.permanent_strain.value) == (900.0, 0.03)
    assert cycles.permanent_strain.random_standard_uncertainty == 0.002
    assert cycles.foot_strain == pytest.approx(0.03)
    assert cycles.foot_strain_contribution.size == 0
    assert (cycles.valley_tension, cycles.first_peak_tension, cycles.peak_tension) == (40, 75, 80)
    # of a rope that still settles: no level
    assert found.level is None


CELL = Component("tension_gain", "load cell")
WARMTH = Component("temperature", "T-1")
MODEL = StrainModel("R-1", "gauge-length", {"gauge_length": 1.0, "reference_position": 0.0})


def shared_step(control, **variables):
    """A step whose archive knows the gain of its load cell."""
    dataset = step(
        uncertainty_component=("uncertainty_component", [1]),
        uncertainty_source=("uncertainty_component", ["tension_gain"]),
        uncertainty_source_of=("uncertainty_component", ["load cell"]),
        uncertainty_source_number=("uncertainty_component", [0]),
        **variables,
    )
    settings = {"rope": {"reference_time": 600.0}, "cycles": {"control": control}}
    return dataset.assign_attrs(settings=json.dumps({"reduction": settings}))


def test_a_number_of_a_step_has_both_parts_of_its_uncertainty():
    dataset = shared_step(
        "load",
        dynamic_stiffness=("specimen", [800.0, np.nan]),
        dynamic_stiffness_standard_uncertainty=("specimen", [10.0, np.nan]),
        dynamic_stiffness_random_standard_uncertainty=("specimen", [6.0, np.nan]),
        dynamic_stiffness_uncertainty_contribution=(
            ("uncertainty_component", "specimen"), [[8.0, np.nan]],
        ),
        dynamic_mean_tension=("specimen", [50.0, np.nan]),
        dynamic_tension_amplitude=("specimen", [20.0, np.nan]),
        dynamic_cycles=("specimen", [10, 0]),
    )  # fmt: skip
    found = step_of_archive(dataset, "R-1")
    stiffness = found.step.level.stiffness
    assert found.component == (CELL,)
    assert (stiffness.value, stiffness.random_standard_uncertainty) == (800.0, 6.0)
    assert stiffness.contribution.tolist() == [8.0]
    assert stiffness.degrees_of_freedom == 9.0


@pytest.mark.parametrize(
    ("control", "strain", "tension"), [("load", -0.02, 0.0), ("position", 0.0, 0.02)]
)
def test_temperature_moves_what_the_machine_does_not_set(control, strain, tension):
    dims = ("specimen", "branch_name", "first_loading_strain_bin")
    load = np.full((2, 2, 3), np.nan)
    load[0, 0] = [0.0, 50.0, 100.0]
    dataset = shared_step(
        control,
        first_loading_strain_bin=(dims[2], [0.0, 0.05, 0.1]),
        branch_tension_first_loading=(dims, load),
        branch_tension_first_loading_standard_uncertainty=(dims, 0 * load),
    )
    errors = InstrumentErrors(
        "R-1", tension_gain=0.01, tension_instrument="load cell", stiffness=0.02, test="T-1",
        rated_break_strength=0.05,
    )  # fmt: skip
    found = step_of_archive(dataset, "R-1", errors, MODEL)
    rise = found.step.first_rise
    assert [one.source for one in found.component] == [
        "rated_break_strength", "temperature", "tension_gain",
    ]  # fmt: skip
    place = found.component.index(WARMTH)
    assert rise.strain_contribution[place] == pytest.approx(strain * rise.strain)
    assert rise.tension_contribution[place] == pytest.approx(tension * rise.tension)
    assert rise.tension_contribution[found.component.index(CELL)] == pytest.approx(
        0.01 * rise.tension
    )
    assert found.step.strength_contribution.tolist() == [0.05, 0.0, 0.0]


def test_a_kept_tension_does_not_know_the_temperature():
    def pair(name, value, *rows):
        return {
            name: ("held_pair", [value]),
            f"{name}_standard_uncertainty": ("held_pair", [0.5]),
            f"{name}_uncertainty_contribution": (
                ("uncertainty_component", "held_pair"), np.array(rows)[:, None],
            ),
        }  # fmt: skip

    dataset = step(
        uncertainty_component=("uncertainty_component", [1, 2]),
        uncertainty_source=("uncertainty_component", ["temperature", "tension_gain"]),
        uncertainty_source_of=("uncertainty_component", ["T-1", "load cell"]),
        uncertainty_source_number=("uncertainty_component", [0, 0]),
        held_pair_specimen=("held_pair", ["R-1"]),
        static_refusal=("held_pair", [""]),
        static_reference_time=("held_pair", [600.0]),
        **pair("held_pair_low_tension", 10.0, 0.2, 0.1),
        **pair("held_pair_high_tension", 30.0, 0.6, 0.3),
        **pair("static_stiffness", 500.0, 10.0, 5.0),
    )
    (one,) = step_of_archive(dataset, "R-1").step.pairs
    assert one.low_tension.contribution.tolist() == [0.0, 0.1]
    assert one.high_tension.contribution.tolist() == [0.0, 0.3]
    assert one.stiffness.contribution.tolist() == [10.0, 5.0]


def test_errors_of_the_steps_of_all_ropes_are_on_one_axis():
    other = Component("tension_gain", "another cell")
    found = {
        "R-1": (
            ChangeInLength("static stiffness", 5e5, 3e3, step="T-1", contribution=np.array([4e3])),
            ChangeInLength("working strain", reason="no step"),
        ),
        "R-2": (
            ChangeInLength("polymer strain", 1e-3, 0.0, step="T-1",
                           contribution=np.array([2e-5, 3e-5])),
        ),
    }  # fmt: skip
    archive = properties_to_dataset(
        found, {("R-1", "T-1"): (CELL,), ("R-2", "T-1"): (other, CELL)}, origin=ORIGIN
    )
    assert archive["uncertainty_source_of"].values.tolist() == ["another cell", "load cell"]
    rows = archive["property_stiffness_uncertainty_contribution"].values
    assert rows[:, 0].tolist() == [0.0, 4e3]
    assert np.isnan(rows[:, 1:]).all()
    of_strain = archive["property_strain_uncertainty_contribution"].values
    assert of_strain[:, 2].tolist() == [2e-5, 3e-5]
    assert archive["property_stiffness_standard_uncertainty"].values[0] == 5e3
    assert archive["property_stiffness_random_standard_uncertainty"].values[0] == 3e3
