"""Steps of a rope programme arrive at their places."""

from dataclasses import replace

import numpy as np

from reduction.archive.test_dataset import to_dataset
from reduction.archive.test_variables import rope_values
from reduction.stages.three_parameter_line.rope_programme import RopeStep


def test_a_refused_pair_keeps_its_levels_and_its_reason(rich_test):
    dataset = to_dataset(rich_test, version="1", command="run")
    assert dataset["held_pair_specimen"].values.tolist() == ["new", "used"]
    assert dataset["static_refusal"].values.tolist() == ["", "the upper hold is too short"]
    assert np.isnan(dataset["static_stiffness"].values).tolist() == [False, True]
    assert dataset["held_pair_high_tension"].values.tolist() == [300.0, 300.0]
    of_time = dataset["static_stiffness_at_time"].values
    assert np.isfinite(of_time[0]).all() and np.isnan(of_time[1]).all()


def test_only_what_broke_has_a_strength(rich_test):
    dataset = to_dataset(rich_test, version="1", command="run")
    peak = dataset["pull_peak_tension"].values
    assert dataset["tensile_strength"].values[0] == peak[0]
    assert np.isnan(dataset["tensile_strength"].values[1]) and np.isfinite(peak[1])
    assert np.isnan(dataset["strain_at_failure_standard_uncertainty"].values[1])
    assert dataset["cycles_are_run_out"].values.tolist() == [0, 1]


def test_without_any_strength_nothing_over_it_is_there(rich_test):
    bare = tuple(replace(one, rated_break_strength=None) for one in rich_test.specimens)
    values = rope_values(rich_test.rope_step, bare)
    assert not [name for name in values if "over_strength" in name or "compliance" in name]
    assert "dynamic_stiffness" in values


def test_a_step_that_gives_one_thing_has_its_name_and_that():
    assert set(rope_values(RopeStep("creep"), ())) == {"programme_step"}
