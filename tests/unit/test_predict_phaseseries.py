"""Sums of harmonics and the phases of their roots."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import (
    cosine_series,
    phase_derivative,
    root_phases,
    series_product,
    sine_series,
    sum_at,
)
from reduction.record.errors import DataError

PHASE = np.linspace(-7.0, 7.0, 101)
COSINES, SINES = np.array([1.3, -0.4, 0.2]), np.array([0.7, 0.1, -0.5])


def test_sums_are_those_of_cosines_and_sines():
    n = np.arange(1, 4)
    assert sum_at(cosine_series(COSINES, 0.6), PHASE) == pytest.approx(
        0.6 + np.cos(np.outer(PHASE, n)) @ COSINES, abs=1e-14
    )
    assert sum_at(sine_series(SINES), PHASE) == pytest.approx(
        np.sin(np.outer(PHASE, n)) @ SINES, abs=1e-14
    )


def test_derivative_and_product():
    n = np.arange(1, 4)
    first, second = cosine_series(COSINES, 0.6), sine_series(SINES)
    assert sum_at(phase_derivative(first), PHASE) == pytest.approx(
        -np.sin(np.outer(PHASE, n)) @ (n * COSINES), abs=1e-14
    )
    assert sum_at(series_product(first, second), PHASE) == pytest.approx(
        sum_at(first, PHASE) * sum_at(second, PHASE), abs=1e-13
    )


def test_every_zero_is_among_the_roots():
    # sin 3x has six zeros a turn
    found = np.sort(np.mod(root_phases(sine_series(np.array([0.0, 0.0, 1.0]))) + 0.1, 2 * np.pi))
    assert found == pytest.approx(0.1 + np.pi / 3 * np.arange(6), abs=1e-13)


def test_many_sums_at_once_and_an_order_that_is_rounding():
    clean = np.stack([cosine_series(np.array([1.0, 0.0]), c) for c in (0.0, 0.5)])
    noisy = clean + 1e-17
    for coefficients in (clean, noisy):
        phases = root_phases(coefficients)
        assert phases.shape == (2, 2)
        assert np.sort(phases, axis=-1) == pytest.approx(
            np.array([[-1, 1], [-4 / 3, 4 / 3]]) * np.pi / 2, abs=1e-13
        )


def test_a_sum_that_is_zero_gives_a_phase_and_no_sums_none():
    assert root_phases(np.zeros((3, 5), dtype=complex)).shape == (3, 1)
    assert root_phases(np.zeros((0, 5), dtype=complex)).size == 0


def test_shapes_that_are_no_sum_are_refused():
    with pytest.raises(DataError, match="the coefficients have no middle"):
        root_phases(np.ones(4, dtype=complex))
