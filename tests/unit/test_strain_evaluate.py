"""Unit tests of reduction.stages.strain.strain_model."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import (
    StrainModel,
    _gauge_length_strain,
    _marked_line_strain,
    _splice_ratio_strain,
    _tension_driven_strain,
    extrapolated,
    free_length_strain,
    strain_by_model,
    strain_sensitivity_of,
)

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
LAW = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.18,
    "splice_compliance": 0.0012,
    "splice_exponent": 0.85,
}
TENSION_DRIVEN = StrainModel("new", "tension-driven", LAW, tension_low=0.0, tension_high=500.0)


@pytest.mark.parametrize("method", list(OF_POSITION))
def test_each_method_of_position_is_evaluated_by_its_own_formula(method):
    function, coefficients = OF_POSITION[method]
    found = strain_by_model(
        StrainModel("new", method, coefficients), position=POSITION, tension=TENSION
    )
    np.testing.assert_array_equal(found, function(POSITION, **coefficients))


def test_tension_driven_uses_the_tension():
    found = strain_by_model(TENSION_DRIVEN, position=POSITION, tension=TENSION)
    np.testing.assert_array_equal(found, _tension_driven_strain(POSITION, TENSION, **LAW))


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
    assert names == tuple(LAW)
    l0, ls, c, n = LAW.values()
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
