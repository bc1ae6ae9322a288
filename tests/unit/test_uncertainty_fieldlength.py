"""Errors of the tape in coefficients and in what rests on one of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.stages.strain.strain_model import StrainModel, strain_by_model
from reduction.uncertainty.error_field import coefficient_errors, error_field
from reduction.uncertainty.errors_of_curves import _of_slack, errors_of_material

COEFFICIENTS = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.18,
    "splice_compliance": 0.0012,
    "splice_exponent": 0.86,
}
DEVIATION = np.array([1.2e-3, 1.5e-3, 5e-5, 6e-3])
CORRELATION = np.array(
    [[1, -0.8, 0.1, 0.0], [-0.8, 1, -0.3, 0.1], [0.1, -0.3, 1, -0.9], [0.0, 0.1, -0.9, 1]]
)
MODEL = StrainModel(
    "new", "tension-driven", COEFFICIENTS, CORRELATION * np.outer(DEVIATION, DEVIATION)
)


def test_the_errors_add_up_to_the_covariance():
    errors = coefficient_errors(MODEL)
    np.testing.assert_allclose(errors @ errors.T, MODEL.covariance, rtol=1e-9, atol=1e-18)


def test_a_model_without_covariance_has_no_errors():
    assert coefficient_errors(StrainModel("new", "tension-driven", COEFFICIENTS)).shape == (4, 0)


def slack_contributions(**stated):
    """Of a strain at slack of 3 %, found where 5 N more would be 1 mm per metre more."""
    test = SimpleNamespace(
        stress_at_strain=None, first_loading=None, history=None, standstills=None,
        slack_strain=SimpleNamespace(
            strain=np.array([0.03]), by_tension=np.array([2e-4]), by_lag=np.array([0.1])
        ),
    )  # fmt: skip
    (found,) = errors_of_material(test, 0, InstrumentErrors("new", **stated), MODEL, np.nan)
    return dict(zip(found.component, found.values["slack_strain_at_unloading"], strict=True))


def test_strain_at_slack_goes_with_the_strain_of_the_test_by_the_same_tape():
    # a length found 1.2 mm too large makes a strain of 3 % too small by 1.2 mm in 2.55 m of it
    slack = {
        one: row for one, row in slack_contributions().items() if one.source == "strain_calibration"
    }
    assert np.sqrt(sum(row**2 for row in slack.values())) == pytest.approx(0.03 * 1.2e-3 / 2.55)
    field = error_field(InstrumentErrors("new"), MODEL, strain=1.0, tension=500.0)
    together = sum(slack[one] * row for one, row in zip(field.component, field.strain, strict=True))
    # the same covariance with the coefficients moved one by one at a fixed position
    position = 2.55 * 2 + 1.18 * (1 + 0.0012 * 500.0**0.86)
    slopes = []
    for name, value in COEFFICIENTS.items():
        ends = [
            strain_by_model(
                StrainModel(
                    "new", "tension-driven", {**COEFFICIENTS, name: value * (1 + way * 1e-6)}
                ),
                position=position, tension=500.0,
            )
            for way in (1, -1)
        ]  # fmt: skip
        slopes.append((ends[0] - ends[1]) / (2e-6 * value))
    wanted = np.array([-0.03 / 2.55, 0.0, 0.0, 0.0]) @ MODEL.covariance @ np.array(slopes)
    assert together == pytest.approx(wanted, rel=1e-5)


def test_gains_of_crosshead_and_strain_method_scale_the_strain_at_slack():
    found = {one.source: row for one, row in slack_contributions(strain_gain=0.02).items()}
    assert found["strain_gain"] == pytest.approx(0.03 * 0.02)
    found = {one.source: row for one, row in slack_contributions(position_gain=0.01).items()}
    assert found["position_gain"] == pytest.approx(0.03 * 0.01)


def test_the_strain_at_which_a_specimen_goes_slack_moves_with_gain_zero_and_lag():
    """Per cent by per cent with the gain; a zero that reads high finds it at less tension.

    0.1 % of 0.03; -0.5 N at 0.002 per N; 20 ms at 0.05 per s.
    """
    test = SimpleNamespace(
        slack_strain=SimpleNamespace(
            strain=np.array([0.03]), by_tension=np.array([2e-3]), by_lag=np.array([0.05])
        ),
        history=SimpleNamespace(
            permanent_set=np.array([0.08]), permanent_set_by_tension=np.array([1e-3])
        ),
    )
    errors = InstrumentErrors("rope", position_gain=1e-3, tension_offset=0.5, lag=0.02)
    [found] = _of_slack(test, 0, errors, SimpleNamespace(coefficients={}))
    assert [one.source for one in found.component] == ["position_gain", "tension_offset", "lag"]
    assert found.values["slack_strain_at_unloading"] == pytest.approx([3e-5, -1e-3, 1e-3])
    # a lag is the same in both first rises of a set
    assert found.values["permanent_set"] == pytest.approx([8e-5, -5e-4, 0.0])
