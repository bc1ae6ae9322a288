"""Errors of the theories and the angles at which they hold."""

import numpy as np
import pytest

from reduction.prediction.armour import (
    ARMOUR_QUANTITIES,
    ArmourDesign,
    _angles_of_use,
    _thinning_loss,
    predict_armour,
    theory_errors,
)
from reduction.record.errors import DataError, SettingsError

DEGREES = np.arange(5.0, 86.0)
DESIGN = ArmourDesign(np.radians(DEGREES), 2.5e-3, 25e-3, 210e9)


def test_errors_are_relative_to_the_reference():
    errors = theory_errors(DESIGN, [1e-3, 2e-3])
    assert errors.error.shape == (3, 4, 81, 2)
    exact = predict_armour(DESIGN, [1e-3, 2e-3])
    linear = predict_armour(DESIGN, [1e-3, 2e-3], theory="intermediate")
    expected = linear.shear_force / exact.shear_force - 1
    place = ARMOUR_QUANTITIES.index("shear_force")
    assert errors.error[1, place] == pytest.approx(expected, abs=1e-14)


def test_error_of_the_torsion_moment_has_no_pole_at_45_degrees():
    errors = theory_errors(DESIGN, 1e-3)
    assert np.max(np.abs(errors.error[1, 3])) < 1.1e-3
    exact = predict_armour(DESIGN, 1e-3).torsion_moment
    assert np.min(np.abs(exact[DEGREES == 45.0])) < 2e-3 * np.max(np.abs(exact))


def test_errors_of_the_first_order_theories_grow_with_the_strain():
    error = theory_errors(DESIGN, [1e-4, 1e-3]).error[:2, 0, 1:]
    assert error[..., 1] / error[..., 0] == pytest.approx(10.0, rel=0.01)


def test_without_strain_there_is_no_error():
    assert np.isnan(theory_errors(DESIGN, 0.0).error).all()


def test_moments_of_the_report_leave_out_torsion_that_a_rod_with_energy_has():
    """Linear: H over GJ is s^3 c, not s c (s^2 - c^2); 77 deg is where they part by 5 %."""
    found = theory_errors(DESIGN, 1e-6, reference="conjugate").error[1, :, :, 0]
    is_within = np.abs(found[ARMOUR_QUANTITIES.index("torsion_moment")]) <= 0.05
    sine, cosine = np.sin(np.radians(DEGREES)), np.cos(np.radians(DEGREES))
    error = sine * cosine**3 / np.hypot(2 * (sine * cosine) ** 2, sine**3 * cosine)
    assert is_within.tolist() == (error <= 0.05).tolist()
    assert 77 in DEGREES[is_within] and 76 not in DEGREES[is_within]


def test_statement_gives_every_run_of_angles():
    use = _angles_of_use(DESIGN, 1e-3, tolerance=0.02)
    assert len(use.statement) == 12
    assert use.statement[4] == "intermediate angles: axial_force within 2 % of exact at 5-85 deg"
    assert use.statement[8] == "large angles: axial_force within 2 % of exact nowhere"
    assert use.statement[9] == "large angles: shear_force within 2 % of exact at 82-85 deg"
    assert use.statement[10] == "large angles: bending_moment within 2 % of exact at 47 deg"
    assert np.degrees(use.least_angle[2]) == pytest.approx([np.nan, 82, 47, 85], nan_ok=True)
    assert np.degrees(use.greatest_angle[2]) == pytest.approx([np.nan, 85, 47, 85], nan_ok=True)


def test_thinning_is_the_first_order_of_a_helix_that_sinks():
    """(1 + zeta)^2 = (1 + eps)^2 cos^2 + (1 - nu zeta R2 / r)^2 sin^2, solved for small eps."""
    loss, strain = _thinning_loss(DESIGN), 1e-7
    sine2, cosine2 = np.sin(np.radians(DEGREES)) ** 2, np.cos(np.radians(DEGREES)) ** 2
    wire_strain = (1 - loss) * strain * cosine2
    left = 2 * wire_strain
    right = 2 * strain * cosine2 - 2 * 0.3 / 11 * wire_strain * sine2
    assert left == pytest.approx(right, rel=1e-12)


def test_bad_settings_are_refused():
    with pytest.raises(SettingsError, match="no theory is held against this; found 'small'"):
        theory_errors(DESIGN, 1e-3, reference="small")
    with pytest.raises(SettingsError, match="tolerance is not above zero"):
        _angles_of_use(DESIGN, 1e-3, tolerance=0.0)
    falling = ArmourDesign(np.radians([50.0, 20.0]), 2.5e-3, 25e-3, 210e9)
    with pytest.raises(DataError, match="winding_angle are not above the one before"):
        _angles_of_use(falling, 1e-3, tolerance=0.02)
