"""Unit tests of reduction.stages.strain.strain_model and tensiondriven: limit cases of each formula, and what it refuses."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import (
    StrainModel,
    _gauge_length_strain,
    _marked_line_strain,
    _splice_ratio_strain,
    _tension_driven_strain,
    extrapolated,
    free_length_fraction,
    free_length_strain,
    position_by_model,
    splice_strain,
    strain_by_model,
    strain_sensitivity_of,
    with_free_length,
)

LENGTHS = {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.2}
LAW = {"splice_compliance": 0.0012, "splice_exponent": 0.85}


def test_a_line_through_the_origin_with_unit_slope_takes_the_whole_length_as_free():
    strain = _marked_line_strain(
        [2.0, 3.0], free_length_intercept=0.0, free_length_slope=1.0, relaxed_free_length=2.0
    )
    np.testing.assert_allclose(strain, [0.0, 0.5])


def test_a_splice_ratio_of_one_is_the_strain_of_the_whole_length():
    strain = _splice_ratio_strain([3.7, 7.4], **LENGTHS, splice_strain_ratio=1.0)
    np.testing.assert_allclose(strain, [0.0, 1.0], atol=1e-15)


def test_a_splice_ratio_of_zero_charges_all_travel_to_the_free_length():
    strain = _splice_ratio_strain([3.7, 3.7 + 2.5], **LENGTHS, splice_strain_ratio=0.0)
    np.testing.assert_allclose(strain, [0.0, 1.0], atol=1e-15)


def test_splice_strain_is_the_power_law():
    force = np.array([1.0, 50.0, 1800.0])
    np.testing.assert_allclose(splice_strain(force, **LAW), 0.0012 * force**0.85, rtol=1e-13)


def test_slack_and_noise_below_it_give_no_splice_strain():
    strain = splice_strain([0.0, -3.0], **LAW)
    assert np.all(strain >= 0)
    assert np.all(strain < 1e-100)


def test_splice_strain_leaves_its_input_alone():
    force = np.array([10.0, 20.0])
    splice_strain(force, **LAW)
    assert force.tolist() == [10.0, 20.0]


@pytest.mark.parametrize("name", list(LAW))
def test_a_law_without_strength_is_refused(name):
    with pytest.raises(DataError, match=name):
        splice_strain([1.0], **{**LAW, name: 0.0})


def test_tension_driven_strain_inverts_the_geometry_of_rubber_and_splice():
    strain, force = np.array([0.0, 0.8, 1.6, 2.6]), np.array([0.0, 350.0, 800.0, 1700.0])
    position = 2.5 * (1 + strain) + 1.2 * (1 + 0.0012 * force**0.85)
    found = _tension_driven_strain(position, force, **LENGTHS, **LAW)
    np.testing.assert_allclose(found, strain, atol=1e-13)


def test_one_position_at_two_tensions_has_two_strains():
    relaxed, first_pull = _tension_driven_strain([8.0, 8.0], [300.0, 500.0], **LENGTHS, **LAW)
    assert relaxed > first_pull


@pytest.mark.parametrize(("position", "force"), [(np.nan, 100.0), (5.0, np.nan)])
def test_missing_position_or_tension_is_missing_strain(position, force):
    found = _tension_driven_strain([5.0, position], [100.0, force], **LENGTHS, **LAW)
    assert np.isnan(found).tolist() == [False, True]


@pytest.mark.parametrize("name", list(LENGTHS))
def test_a_relaxed_length_of_zero_is_refused(name):
    lengths = {**LENGTHS, name: 0.0}
    with pytest.raises(DataError, match=name):
        _tension_driven_strain([5.0], [100.0], **lengths, **LAW)
    with pytest.raises(DataError, match=name):
        _splice_ratio_strain([5.0], **lengths, splice_strain_ratio=0.2)


def test_a_displacement_over_a_gauge_length():
    strain = _gauge_length_strain([0.0, 0.025, np.nan], reference_position=0.0, gauge_length=0.05)
    np.testing.assert_allclose(strain, [0.0, 0.5, np.nan])


def test_gauge_length_needs_a_length_and_a_reference():
    with pytest.raises(DataError, match="gauge_length"):
        _gauge_length_strain([1.0], reference_position=0.0, gauge_length=0.0)
    with pytest.raises(DataError, match="reference_position"):
        _gauge_length_strain([1.0], reference_position=np.nan, gauge_length=1.0)


# unit tests of reduction.stages.strain.strain_model

POSITION, TENSION = np.array([5.9, 6.6, 7.3]), np.array([380.0, 480.0, 590.0])
OF_POSITION = {
    "marks": (
        _marked_line_strain,
        {"free_length_intercept": -0.8, "free_length_slope": 0.9, "relaxed_free_length": 2.55},
    ),
    "strain-ratio": (
        _splice_ratio_strain,
        {
            "relaxed_free_length": 2.55,
            "relaxed_splice_length": 1.18,
            "splice_strain_ratio": 0.23,
        },
    ),
    "constant-fraction": (
        free_length_strain,
        {"free_fraction": 0.777, "relaxed_free_length": 2.55},
    ),
    "gauge-length": (_gauge_length_strain, {"reference_position": 3.7, "gauge_length": 2.5}),
}
LAW_OF_EVALUATION = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.18,
    "splice_compliance": 0.0012,
    "splice_exponent": 0.85,
}
TENSION_DRIVEN = StrainModel(
    "new", "tension-driven", LAW_OF_EVALUATION, tension_low=0.0, tension_high=500.0
)


@pytest.mark.parametrize("method", list(OF_POSITION))
def test_each_method_of_position_is_evaluated_by_its_own_formula(method):
    function, coefficients = OF_POSITION[method]
    found = strain_by_model(
        StrainModel("new", method, coefficients), position=POSITION, tension=TENSION
    )
    np.testing.assert_array_equal(found, function(POSITION, **coefficients))


def test_tension_driven_uses_the_tension():
    found = strain_by_model(TENSION_DRIVEN, position=POSITION, tension=TENSION)
    np.testing.assert_array_equal(
        found, _tension_driven_strain(POSITION, TENSION, **LAW_OF_EVALUATION)
    )


def test_a_block_of_a_log_gives_what_the_whole_log_gives():
    position, tension = np.linspace(4, 9, 1000), np.linspace(10, 900, 1000)
    whole = strain_by_model(TENSION_DRIVEN, position=position, tension=tension)
    blocks = [
        strain_by_model(TENSION_DRIVEN, position=p, tension=f)
        for p, f in zip(np.split(position, 8), np.split(tension, 8), strict=True)
    ]
    np.testing.assert_allclose(np.concatenate(blocks), whole, rtol=1e-14)


def test_the_extensometer_is_believed():
    model = StrainModel("rope", "extensometer")
    found = strain_by_model(
        model, position=POSITION, tension=TENSION, measured_strain=[0.01, 0.02, np.nan]
    )
    np.testing.assert_array_equal(found, [0.01, 0.02, np.nan])


def test_an_extensometer_that_is_not_there_is_missed():
    with pytest.raises(DataError, match="to come from an extensometer, and the log has none"):
        strain_by_model(StrainModel("rope", "extensometer"), position=POSITION, tension=TENSION)


def test_a_position_outside_the_marks_is_extrapolated():
    model = StrainModel("new", "marks", position_low=5.9, position_high=7.3)
    position = [3.7, 5.88, 5.89, 6.6, 7.31, 7.32, np.nan]
    assert extrapolated(model, position, np.zeros(7)).tolist() == [
        True, True, False, False, False, True, False,
    ]  # fmt: skip


def test_a_tension_above_the_marks_is_extrapolated_and_slack_is_not():
    tension = [-2.0, 0.0, 499.0, 504.0, 506.0, np.nan]
    assert extrapolated(TENSION_DRIVEN, np.full(6, 99.0), tension).tolist() == [
        False, False, False, False, True, False,
    ]  # fmt: skip


def test_a_model_without_marks_extrapolates_nowhere():
    model = StrainModel("rope", "gauge-length", OF_POSITION["gauge-length"][1])
    assert not extrapolated(model, POSITION, TENSION).any()


def test_sensitivity_of_tension_driven_strain_is_its_derivative():
    names, slope = strain_sensitivity_of(TENSION_DRIVEN, position=POSITION, tension=TENSION)
    assert names == tuple(LAW_OF_EVALUATION)
    l0, ls, c, n = LAW_OF_EVALUATION.values()
    power = TENSION**n
    splice = ls * (1 + c * power)
    expected = [
        -(POSITION - splice) / l0**2,
        -(1 + c * power) / l0,
        -ls * power / l0,
        -ls * c * power * np.log(TENSION) / l0,
    ]
    np.testing.assert_allclose(slope, expected, rtol=1e-6)


def test_a_coefficient_of_zero_has_a_sensitivity_too():
    coefficients = {"reference_position": 0.0, "gauge_length": 2.0}
    model = StrainModel("rope", "gauge-length", coefficients)
    _, slope = strain_sensitivity_of(model, position=[0.1], tension=[1.0])
    np.testing.assert_allclose(slope, [[-0.5], [-0.025]], rtol=1e-6)


def test_a_model_without_coefficients_has_no_sensitivity():
    names, slope = strain_sensitivity_of(
        StrainModel("rope", "extensometer"), position=POSITION, tension=TENSION
    )
    assert names == ()
    assert slope.shape == (0, 3)


@pytest.mark.parametrize(
    "bend", [(0.0, 0.0), (0.02, 0.0), (0.02, -0.004)], ids=["straight", "curved", "cubic"]
)
@pytest.mark.parametrize("limit", [(0.0, 0.0), (0.2, 1 / 300)], ids=["power", "saturating"])
def test_sensitivity_of_mixed_strain_is_its_derivative(bend, limit):
    coefficients = {
        "relaxed_free_length": 2.55, "relaxed_splice_length": 1.19, "splice_offset": 0.01,
        "splice_strain_ratio": 0.11, "splice_strain_curvature": bend[0],
        "splice_strain_cubic": bend[1], "splice_compliance": 0.11 / 450, "splice_exponent": 0.9,
        "splice_limit": limit[0], "splice_saturation": limit[1],
    }  # fmt: skip
    # slack, and a tension below zero, which counts as none; nothing known, and no tension known
    place = np.array([5.0, 6.5, 7.5, 3.8, np.nan, 6.0])
    load = np.array([100.0, 400, 900, -2, 100, np.nan])

    def strain(**changed):
        model = StrainModel("used", "mixed", coefficients | changed)
        return strain_by_model(model, position=place, tension=load)

    model = StrainModel("used", "mixed", coefficients)
    names, slope = strain_sensitivity_of(model, position=place, tension=load)
    assert names == tuple(coefficients)
    for name, own in zip(names, slope, strict=True):
        value = coefficients[name]
        step = 1e-4 * abs(value) or 1e-5
        by_steps = (strain(**{name: value + step}) - strain(**{name: value - step})) / (2 * step)
        np.testing.assert_allclose(own, by_steps, rtol=1e-5, atol=1e-8)


TENSION_OF_INVERSE = np.array([0.0, 40.0, 300.0, 1200.0])
POSITION_OF_INVERSE = np.array([3.74, 5.1, 6.6, 11.0])
DRIVEN = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.19,
    "splice_compliance": 0.00113,
    "splice_exponent": 0.86,
}
RATIO = {"relaxed_free_length": 2.55, "relaxed_splice_length": 1.19, "splice_strain_ratio": 0.23}
MODELS = [
    StrainModel("T", "tension-driven", DRIVEN),
    StrainModel("T", "strain-ratio", RATIO),
    StrainModel(
        "T",
        "marks",
        {"free_length_intercept": -0.8, "free_length_slope": 0.9, "relaxed_free_length": 2.5},
    ),
    StrainModel("T", "constant-fraction", {"free_fraction": 0.777, "relaxed_free_length": 2.55}),
    StrainModel("T", "gauge-length", {"reference_position": 3.74, "gauge_length": 3.74}),
]


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.method)
def test_length_and_strain_are_inverse_by_every_method(model):
    strain = strain_by_model(model, position=POSITION_OF_INVERSE, tension=TENSION_OF_INVERSE)
    back = position_by_model(model, strain=strain, tension=TENSION_OF_INVERSE)
    np.testing.assert_allclose(back, POSITION_OF_INVERSE, rtol=1e-13)


def test_splices_stretch_by_the_tension_they_carry():
    found = position_by_model(MODELS[0], strain=[0.0, 1.0], tension=[0.0, 400.0])
    by_hand = 2.55 * 2.0 + 1.19 * (1 + 0.00113 * 400.0**0.86)
    assert found == pytest.approx([3.74, by_hand], rel=1e-12)


def test_splices_that_saturate_stretch_to_their_limit():
    saturating = StrainModel("T", "mixed", {
        "relaxed_free_length": 2.55, "relaxed_splice_length": 1.19, "splice_offset": 0.0,
        "splice_strain_ratio": 0.0, "splice_strain_curvature": 0.0, "splice_strain_cubic": 0.0,
        "splice_compliance": 0.0, "splice_exponent": 1.0, "splice_limit": 0.25,
        "splice_saturation": 1 / 300.0,
    })  # fmt: skip
    found = position_by_model(saturating, strain=[0.0, 1.0, 1.0], tension=[0.0, 300.0, 1e5])
    by_hand = 2.55 * 2.0 + 1.19 * (1 + 0.25 * np.array([1 - np.exp(-1.0), 1.0]))
    assert found == pytest.approx([3.74, *by_hand], rel=1e-12)
    back = strain_by_model(saturating, position=found, tension=[0.0, 300.0, 1e5])
    assert back == pytest.approx([0.0, 1.0, 1.0], abs=1e-12)


def test_one_strain_at_several_tensions_is_several_lengths():
    found = position_by_model(MODELS[0], strain=1.0, tension=TENSION_OF_INVERSE)
    assert found.shape == (4,)
    assert (np.diff(found) > 0).all()


@pytest.mark.parametrize("index", [0, 1])
def test_a_longer_tether_has_the_same_splices(index):
    longer = with_free_length(MODELS[index], 10.0)
    added = position_by_model(longer, strain=1.0, tension=400.0) - position_by_model(
        MODELS[index], strain=1.0, tension=400.0
    )
    assert added == pytest.approx(2 * (10.0 - 2.55))
    assert "measured on a different free length: 10 m" in str(longer.notes[-1])


def test_a_gauge_length_scales_with_where_it_begins():
    longer = with_free_length(MODELS[4], 7.48)
    assert position_by_model(longer, strain=0.5, tension=0.0) == pytest.approx(1.5 * 7.48)
    displaced = StrainModel("T", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
    assert position_by_model(with_free_length(displaced, 4.0), strain=0.5, tension=0.0) == 2.0


@pytest.mark.parametrize("index", [2, 3])
def test_methods_that_hold_for_one_length_are_refused_another(index):
    with pytest.raises(DataError, match="holds for the length that was tested"):
        with_free_length(MODELS[index], 10.0)


# unit tests of reduction.stages.strain.strain_model


def test_strain_is_zero_at_the_relaxed_length():
    got = free_length_strain(10.0, free_fraction=0.8, relaxed_free_length=8.0)
    assert got == pytest.approx(0.0, abs=1e-15)


def test_nan_in_nan_out():
    got = free_length_strain([10.0, np.nan], free_fraction=0.8, relaxed_free_length=8.0)
    assert np.isnan(got).tolist() == [False, True]


def test_the_mean_is_of_shares_and_not_of_lengths():
    # (1/2 + 3/4) / 2, not (1 + 3) / (2 + 4)
    assert free_length_fraction([1.0, 3.0], [2.0, 4.0]) == 0.625


@pytest.mark.parametrize(("free", "total"), [([], []), ([1.0], [2.0, 3.0]), (1.0, 2.0)])
def test_marks_that_do_not_pair_up_are_refused(free, total):
    with pytest.raises(DataError, match="splice marks do not pair up"):
        free_length_fraction(free, total)


@pytest.mark.parametrize("share", [0.0, 1.0, -0.2, np.nan])
def test_a_share_that_is_none_is_refused(share):
    with pytest.raises(DataError, match="free_fraction is out of range"):
        free_length_strain(10.0, free_fraction=share, relaxed_free_length=8.0)


REFUSED = {
    "a ratio that leaves no length is refused": (
        lambda: _splice_ratio_strain([4.0], **LENGTHS, splice_strain_ratio=-3.0),
        DataError,
        "splice_strain_ratio",
    ),
    "series that do not pair up are refused": (
        lambda: _tension_driven_strain([5.0, 6.0], [100.0], **LENGTHS, **LAW),
        DataError,
        "series do not pair up",
    ),
    "a line on no length is refused": (
        lambda: _marked_line_strain(
            [5.0], free_length_intercept=0.0, free_length_slope=1.0, relaxed_free_length=-1.0
        ),
        DataError,
        "relaxed_free_length",
    ),
    "an extensometer knows no length": (
        lambda: position_by_model(StrainModel("T", "extensometer"), strain=1.0, tension=0.0),
        DataError,
        "from an extensometer, which does not know the length",
    ),
    "a length is positive": (
        lambda: with_free_length(MODELS[0], 0.0),
        DataError,
        "free_length are not positive",
    ),
    "free longer than total is refused with index and values": (
        lambda: free_length_fraction([8.0, 12.0], [10.0, 11.0]),
        DataError,
        r"1 of 2 .* index 1; found free_length 12, total_length 11",
    ),
    "a relaxed length of zero is refused in splice": (
        lambda: free_length_strain(10.0, free_fraction=0.8, relaxed_free_length=0.0),
        DataError,
        "relaxed_free_length is not positive",
    ),
}


test_refusals = refusals(REFUSED)
