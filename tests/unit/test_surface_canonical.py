import numpy as np
import pytest

from reduction.experiments.designs import model_matrix, quadratic_exponents
from reduction.experiments.fit_results import STATIONARY_KINDS, STATIONARY_REASONS
from reduction.experiments.stationary_point import _curvature, canonical_analysis

EXPONENTS = quadratic_exponents(3)
# Treb: B1 .. B10 of the published data by least squares
TREB = np.array([90, -9.375, -1.375, -3.375, 19.75, 19.75, -11.5, -6.25, 4.75, 6.75])
BOX = {"low": [0.0, 0.0, 0.0], "high": [1.0, 1.0, 1.0]}


def analysed(coefficient, sigma=0.0, factor=None):
    values = np.atleast_2d(coefficient)
    return canonical_analysis(
        values,
        EXPONENTS,
        covariance_factor=np.eye(10)[None] if factor is None else factor,
        pattern=np.zeros(len(values), dtype=int),
        sigma=np.full(len(values), sigma),
        **BOX,
    )


def test_the_surface_is_level_at_its_stationary_point_and_turns_by_its_eigenvalues():
    found = analysed(TREB)
    point, value = found.stationary_point[0], found.stationary_value[0]
    for eigenvalue, vector in zip(found.eigenvalue[0], found.eigenvector[0].T, strict=True):
        for step in (0.5, -0.5):
            height = model_matrix(point + step * vector, EXPONENTS) @ TREB
            assert height == pytest.approx(value + eigenvalue * step**2, rel=1e-12)


def test_a_bowl_a_dome_and_a_saddle_are_told_apart():
    bowl = np.array([0, 1, 2, 3, 1, 1, 1, 0, 0, 0.0])
    saddle = np.array([0, 1, -2, 3, 1, 1, 1, 0, 0, 0.0])
    found = analysed([bowl, -bowl, saddle])
    assert [STATIONARY_KINDS[kind] for kind in found.kind] == ["minimum", "maximum", "saddle"]
    assert (np.diff(found.eigenvalue, axis=1) < 0).all()
    assert found.is_inside.tolist() == [True, True, True]


def test_a_plane_and_a_missing_surface_have_no_stationary_point_and_say_so():
    plane = np.array([1, 0, 0, 0, 1, 1, 1, 0, 0, 0.0])
    trough = np.array([1, 1, 0, 0, 1, 1, 1, 0, 0, 0.0])
    found = analysed([plane, trough, np.full(10, np.nan), TREB])
    texts = [STATIONARY_REASONS[code] for code in found.reason]
    assert texts == ["the surface has a direction without curvature"] * 2 + [
        "there is no surface", "",
    ]  # fmt: skip
    assert np.isnan(found.stationary_point[:3]).all()
    assert found.kind[:3].tolist() == [0, 0, 0]
    np.testing.assert_allclose(found.eigenvalue[1], [1, 0, 0], atol=1e-15)


def test_uncertainties_are_those_of_repeated_experiments():
    """First-order uncertainties against 100,000 draws of the coefficients."""
    rng = np.random.default_rng(0)
    root = 0.02 * rng.normal(size=(10, 10))
    factor = (root @ root.T)[None]
    draws = TREB + rng.normal(size=(100_000, 10)) @ root.T
    spread = analysed(draws)
    found = analysed(TREB, sigma=1.0, factor=factor)
    np.testing.assert_allclose(
        found.stationary_point_standard_uncertainty[0],
        spread.stationary_point.std(axis=0),
        rtol=0.03,
    )
    np.testing.assert_allclose(
        found.eigenvalue_standard_uncertainty[0], spread.eigenvalue.std(axis=0), rtol=0.03
    )


def test_curvature_gives_the_surface_back():
    slope, form = _curvature([TREB], EXPONENTS)
    point = np.array([0.3, -0.6, 0.9])
    height = TREB[0] + point @ slope[0] + point @ form[0] @ point
    assert height == pytest.approx(model_matrix(point, EXPONENTS) @ TREB, rel=1e-14)
