"""A reduced test becomes a dataset with the names, dimensions and units of the schema."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from reduction import __version__
from reduction.archive.open import open_archive
from reduction.archive.test_dataset import to_dataset
from reduction.quantities.names import TEST_SCHEMA
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Quality


def build(test):
    return to_dataset(test, version=__version__, command="reduction run")


def test_every_kind_of_product_comes_back_as_it_was(any_test, write):
    dataset = build(any_test)
    with open_archive(write(any_test)) as back:
        assert len(back.attrs.pop("values_sha256")) == 64  # of the file
        xr.testing.assert_identical(dataset, back.load())


def test_the_rich_test_fills_every_variable_that_a_log_can_have(rich_test, bare_test):
    filled = set(build(rich_test).variables) | set(build(bare_test).variables)
    steps = {name for name, row in TEST_SCHEMA.items() if {"step", "interval"} & set(row.dims)}
    # another datum, control, strain method or length than that of the examples
    alternatives = {
        "tension_band", "tension_rate", "measured_strain", "fill_pressure", "free_fraction",
        "reference_position", "cycle_number_in_test",
        "free_length_intercept", "free_length_slope", "splice_strain_ratio", "strain_gauge_length",
        "splice_offset", "splice_strain_cubic", "splice_strain_curvature", "strain_reference_tension",
        "splice_limit", "splice_saturation",
        "relaxed_gauge_length", "uncertainty_source_degrees_of_freedom", "sample_index",
        "crosshead_displacement_random", "crosshead_displacement_uncertainty_contribution",
    }  # fmt: skip
    missing = {
        name.removesuffix("_standard_uncertainty") for name in set(TEST_SCHEMA) - filled - steps
    }
    assert missing <= alternatives


@pytest.mark.parametrize(
    ("name", "dims", "units"),
    [
        ("time", ("sample",), "s"),
        ("crosshead_position", ("sample",), "m"),
        ("crosshead_position_standard_uncertainty", (), "m"),
        ("tension", ("specimen", "sample"), "N"),
        ("tension_standard_uncertainty", ("specimen",), "N"),
        ("strain", ("specimen", "sample"), "1"),
        ("nominal_stress", ("specimen", "sample"), "Pa"),
        ("cycle_number", ("sample",), "1"),
        ("frequency", ("specimen", "cycle"), "Hz"),
        ("apparent_spring_constant", ("specimen", "cycle"), "N"),
        ("hysteresis_energy", ("specimen", "cycle"), "J m-1"),
        ("tangent_modulus", ("specimen", "branch_name", "strain_bin"), "Pa"),
        ("tangent_modulus_count", ("specimen", "branch_name", "strain_bin"), "1"),
        ("branch_tension", ("specimen", "branch_name", "strain_bin"), "N"),
        (
            "tangent_modulus_by_cycle",
            ("specimen", "selected_cycle", "branch_name", "strain_bin"),
            "Pa",
        ),
        ("segment_modulus", ("specimen", "branch_name", "segment"), "Pa"),
        ("segment_strain_low", ("specimen", "branch_name", "segment"), "1"),
        ("segment_tension_high", ("specimen", "branch_name", "segment"), "N"),
    ],
)
def test_names_dimensions_and_units_are_the_contract_s(rich_test, name, dims, units):
    variable = build(rich_test)[name]
    assert variable.dims == dims
    assert variable.attrs["units"] == units
    assert variable.attrs["long_name"]


def test_a_stepwise_test_stands_along_step(stepwise_test):
    dataset = build(stepwise_test)
    for name in ("tension", "gauge_length", "eye_to_eye_length", "strain", "branch", "clock"):
        assert dataset[name].dims == ("step",)
    assert "sample" not in dataset.sizes
    np.testing.assert_array_equal(dataset["gauge_length"], stepwise_test.stepwise.length)
    assert dataset["relaxed_gauge_length"].item() == 0.1556
    assert dataset["step_flag"].values.tolist() == [0, 3, 6]
    assert dataset["n_flagged"].values.tolist() == [[1, 2, 1]]


def test_quality_flags_carry_the_masks_of_the_record(rich_test):
    flag = build(rich_test)["quality_flag"]
    assert flag.attrs["flag_masks"].tolist() == [int(mask) for mask in Quality]
    assert flag.attrs["flag_masks"].dtype == flag.dtype == np.uint16
    assert flag.attrs["flag_meanings"].split() == [mask.name.lower() for mask in Quality]
    assert flag.values[0, 3] == Quality.MISSING | Quality.SPIKE
    assert "units" not in flag.attrs


def test_every_row_is_accounted_for_by_channel_and_mask(rich_test):
    dataset = build(rich_test)
    account = dataset["n_flagged"].to_series()
    assert account["tension of new", "spike"] == 1
    assert account["tension of used", "spike"] == 0
    assert account["time and crosshead position", "gap"] == 2
    assert dataset["n_rows_read"].item() == 61
    assert dataset["n_rows_kept"].item() == 60


def test_cycles_count_from_one_and_curves_are_under_their_own_names(rich_test):
    dataset = build(rich_test)
    assert dataset["cycle"].values.tolist() == list(range(1, rich_test.cycles.n_cycles + 1))
    first = rich_test.first_loading
    for name in ("tangent_modulus", "branch_tension"):
        for kept, suffix in (("", ""), ("_random", "_standard_uncertainty")):
            np.testing.assert_array_equal(
                dataset[f"{name}_first_loading{kept}{suffix}"], getattr(first, f"{name}{suffix}")
            )


def test_the_area_is_that_of_the_mean_diameter(rich_test):
    area = np.pi / 4 * np.array([0.02645, 0.0239]) ** 2
    np.testing.assert_allclose(build(rich_test)["area"], area, rtol=1e-15)


def test_tension_stands_as_logged_and_stress_as_it_was_reduced(rich_test):
    dataset = build(rich_test)
    np.testing.assert_array_equal(dataset["tension"], rich_test.record.tension)
    area = np.pi * np.array([0.02645, 0.0239]) ** 2 / 4
    expected = rich_test.record.tension / area[:, None]
    expected[0, 3] = np.nan
    np.testing.assert_allclose(dataset["nominal_stress"], expected, rtol=1e-14)
    assert dataset["nominal_stress_random_standard_uncertainty"].values[0] == 4000


def test_without_a_diameter_there_is_no_stress(holds_only_test):
    assert "nominal_stress" not in build(holds_only_test)


def test_a_displacement_is_not_called_a_position(bare_test):
    dataset = build(bare_test)
    assert "crosshead_position" not in dataset
    assert dataset["crosshead_displacement"].dims == ("sample",)


def test_a_load_controlled_test_has_band_and_rate_in_newton(rich_test):
    about = replace(rich_test.description, control="load")
    dataset = build(replace(rich_test, description=about))
    assert dataset["tension_band"].attrs["units"] == "N"
    assert dataset["tension_rate"].attrs["units"] == "N s-1"
    assert "position_band" not in dataset
    assert "crosshead_rate" not in dataset


def test_an_extensometer_channel_is_kept(bare_test):
    strain = np.zeros((1, bare_test.record.n_samples))
    record = replace(bare_test.record, measured_strain=strain)
    assert build(replace(bare_test, record=record))["measured_strain"].dims == (
        "specimen",
        "sample",
    )


def test_companions_that_are_there_are_named_and_others_are_not(rich_test, bare_test):
    rich = build(rich_test)
    assert rich["tangent_modulus"].attrs["ancillary_variables"].split() == [
        "tangent_modulus_standard_uncertainty",
        "tangent_modulus_count",
        "tangent_modulus_minimum",
        "tangent_modulus_maximum",
        "tangent_modulus_scatter",
    ]
    assert rich["tension"].attrs["ancillary_variables"].split() == [
        "tension_standard_uncertainty",
        "quality_flag",
    ]
    assert build(bare_test)["tension"].attrs["ancillary_variables"] == "quality_flag"


def test_covariance_of_the_coefficients_can_be_had_back(rich_test):
    dataset = build(rich_test)
    assert rich_test.strain_models
    for row, model in enumerate(rich_test.strain_models):
        names = list(dataset["coefficient_name"].values)
        spread = np.array([dataset[f"{n}_standard_uncertainty"].values[row] for n in names])
        correlation = dataset["strain_coefficient_correlation"].values[row]
        order = [names.index(name) for name in model.coefficients]
        back = (correlation * np.outer(spread, spread))[np.ix_(order, order)]
        np.testing.assert_allclose(back, model.covariance, rtol=1e-12)


def test_an_exact_coefficient_is_correlated_with_itself_alone(rich_test):
    model = replace(
        rich_test.strain_models[0],
        coefficients={"free_fraction": 0.777, "relaxed_free_length": 2.55},
        covariance=np.diag([0.01**2, 0.0]),
    )
    dataset = build(replace(rich_test, strain_models=(model, rich_test.strain_models[1])))
    names = list(dataset["coefficient_name"].values)
    at = [names.index("free_fraction"), names.index("relaxed_free_length")]
    matrix = dataset["strain_coefficient_correlation"].values[0][np.ix_(at, at)]
    np.testing.assert_array_equal(matrix, np.eye(2))
    assert dataset["free_fraction_standard_uncertainty"].values[0] == pytest.approx(0.01)
    assert np.isnan(dataset["free_fraction"].values[1])


def test_a_gauge_length_coefficient_does_not_take_the_name_of_a_reading(rich_test):
    model = replace(
        rich_test.strain_models[0],
        coefficients={"gauge_length": 1.2},
        covariance=np.empty((0, 0)),
    )
    dataset = build(replace(rich_test, strain_models=(model, rich_test.strain_models[1])))
    assert dataset["strain_gauge_length"].values[0] == 1.2
    assert "gauge_length" not in dataset


def test_a_coefficient_without_a_name_is_refused(rich_test):
    model = replace(rich_test.strain_models[0], coefficients={"magic": 1.0})
    with pytest.raises(ArchiveError, match=r"has no name for; found magic; needed names among"):
        build(replace(rich_test, strain_models=(model,)))


def test_an_array_that_does_not_fit_is_refused(rich_test):
    with pytest.raises(
        ArchiveError,
        match=r"slack_strain_at_unloading does not fit its dimensions; found shape \(3,\)",
    ):
        build(
            replace(
                rich_test,
                contributions=None,
                slack_strain=replace(rich_test.slack_strain, strain=np.zeros(3)),
            )
        )


def test_an_uncertainty_of_nothing_known_is_refused(rich_test):
    loops = replace(rich_test.loops, uncertainty={"colour": np.zeros((2, 4))})
    with pytest.raises(
        ArchiveError, match=r"without a place in the schema; found colour_standard_uncertainty"
    ):
        build(replace(rich_test, loops=loops))


def test_stress_at_strain_stands_in_rising_order_of_elongation(rich_test):
    dataset = build(rich_test)
    assert dataset["strain_level"].values.tolist() == [0.5, 1.0]
    np.testing.assert_array_equal(
        dataset["stress_at_strain"], rich_test.stress_at_strain[:, [1, 0]]
    )


def test_holds_with_other_times_share_one_axis(rich_test):
    dataset = build(rich_test)
    assert dataset["hold_time"].values.tolist() == [1.0, 10.0, 30.0, 60.0]
    short = dataset["tension_at_time"].values[1]
    assert np.isnan(short[[1, 3]]).all()
    np.testing.assert_array_equal(short[[0, 2]], rich_test.holds[1].tension_at_time)


def test_a_rate_of_creep_is_not_a_rate_of_relaxation(rich_test):
    dataset = build(rich_test)
    assert np.isnan(dataset["relaxation_rate_per_decade"].values).tolist() == [False, False, True]
    assert np.isnan(dataset["creep_rate_per_decade"].values).tolist() == [True, True, False]


def test_an_exponent_is_not_stored_as_a_modulus(rich_test):
    dataset = build(rich_test)
    assert dataset["elastomer_parameter_name"].values.tolist()[-1] == "exponent_1"
    # the law that each parameter is of: one of the first, two of the second
    assert dataset["elastomer_parameter_fit"].values.tolist() == [1, 2, 2]
    assert dataset["elastomer_exponent"].values[-1] == 1.4
    assert np.isnan(dataset["elastomer_modulus"].values[-1])


def test_slips_that_were_looked_for_and_not_found_say_so(bare_test):
    dataset = build(bare_test)
    assert dataset["n_slips"].values.tolist() == [0]
    assert "slip" not in dataset.sizes


def without_cycles(cycles):
    """The same cycles product with no whole cycle in it."""
    per_cycle = ("first", "last", "branch_first", "branch_last", "plateau_rate")
    return replace(cycles, **{name: getattr(cycles, name)[:0] for name in per_cycle})


def test_a_log_without_a_whole_cycle_still_makes_an_archive(rich_test, write):
    without = replace(
        rich_test,
        cycles=without_cycles(rich_test.cycles),
        loops=None,
        end_moduli=None,
        identity=None,
        curves=None,
        segments=None,
        ratios=(),
        amplitude=None,
        trend=None,
        line=None,
        line_of_test=None,
    )
    path = write(without)
    with open_archive(path) as archive:
        assert "cycle" not in archive.sizes
        assert archive["cycles_counted_by"].item() == "reversals"
        assert archive["cycle_number"].dims == ("sample",)


def test_every_note_of_every_stage_is_kept_with_its_stage(rich_test):
    dataset = build(rich_test)
    notes = list(zip(dataset["note_stage"].values, dataset["note"].values, strict=True))
    assert ("hold 3 used", "Prony series not given: the hold lasts 25 s") in notes
    assert ("ogden-2 new", "unstable in equibiaxial extension") in notes
    assert ("specimen new", "printed 1.01 in") in notes
    assert ("test", "=1+1 looks like a formula") in notes
    assert len(notes) == len(set(notes))


def test_a_note_that_two_holds_share_is_kept_for_both(rich_test):
    dataset = build(rich_test)
    stages = dataset["note_stage"].values[dataset["note"].values == "ramp of 4 s left out"]
    assert stages.tolist() == ["hold 1 new", "hold 3 used", "hold 2 new"]


def test_a_note_of_the_test_that_repeats_a_stage_stands_under_the_stage(rich_test):
    dataset = build(rich_test)
    stages = dataset["note_stage"].values[dataset["note"].values == "the last cycle is broken"]
    assert stages.tolist() == ["cycles"]
