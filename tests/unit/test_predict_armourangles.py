"""Theories of small, intermediate and large angles against equations written out by hand."""

import numpy as np
import pytest

from reduction.prediction.armour import (
    ArmourDesign,
    _predict_intermediate,
    _predict_large,
    _predict_small,
)

STRAIN = np.array([1e-3])


def unit(degrees, poisson_ratio=0.0):
    """Wire of unit stiffness E A, radius of the helix 10 times that of the wire."""
    return ArmourDesign(np.radians(degrees), 1.0, 9.0, 1 / np.pi, poisson_ratio)


def test_intermediate_angles_at_30_degrees():
    """sin = 1/2, cos^2 = 3/4, E I = 1/4, r = 10."""
    wire = _predict_intermediate(unit(30.0), STRAIN)
    root = np.sqrt(3.0)
    assert wire.wire_strain == pytest.approx(0.75e-3)
    assert wire.angle_change == pytest.approx(-root / 4 * 1e-3)
    assert wire.curvature_change == pytest.approx(-2 * 3 / 16 * 1e-4)
    assert wire.torsion_change == pytest.approx(root / 4 * (1 / 4 - 3 / 4) * 1e-4)
    assert wire.bending_moment == pytest.approx(-3 / 32 * 1e-4)
    assert wire.torsion_moment == pytest.approx(-root / 32 * 1e-4)
    # N' = E I eps s^3 c / r^2 without Poisson's ratio
    assert wire.shear_force == pytest.approx(0.25 * root / 16 * 1e-5)


def test_small_angles_differ_from_intermediate_by_the_second_order():
    for strain in (1e-3, 1e-4):
        small, linear = (
            one(unit(20.0), np.array([strain])) for one in (_predict_small, _predict_intermediate)
        )
        assert small.angle_change / linear.angle_change - 1 == pytest.approx(0.0, abs=strain)
        assert small.angle_change / linear.angle_change - 1 != pytest.approx(0.0, abs=strain / 10)


def test_small_angles_have_no_answer_where_the_cosine_passes_one():
    wire = _predict_small(unit(5.0), np.array([1e-3, 0.9]))
    assert np.isnan(wire.angle_change).tolist() == [False, True]
    assert np.isnan(wire.bending_moment).tolist() == [False, True]
    assert np.isfinite(wire.axial_force).all()


def test_spring_is_that_of_a_close_coil():
    """f = G J eps / (r^2 tan): G J = 1/4, r = 10, tan 45 = 1."""
    spring = _predict_large(unit(45.0), STRAIN)
    assert spring.tension == pytest.approx(0.25e-5)
    assert spring.torsion_moment == pytest.approx(0.25e-4 / np.sqrt(2))
    assert spring.bending_moment == pytest.approx(-0.25e-4 / np.sqrt(2))
    assert np.isnan(spring.current_winding_angle).all()
    assert not spring.is_lifted.any()


def test_spring_and_conjugate_rod_have_one_torsion_towards_90_degrees():
    spring = _predict_large(unit(89.0, 0.3), STRAIN)
    rod = _predict_intermediate(unit(89.0, 0.3), STRAIN)
    assert spring.torsion_moment == pytest.approx(rod.torsion_moment, rel=2e-3)
