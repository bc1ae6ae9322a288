"""Room of the wires beside each other."""

import numpy as np
import pytest

from reduction.prediction.armour import ArmourDesign, _wire_gap


def layer(degrees, n_wires, wire_radius=1.0, core_radius=9.0):
    return ArmourDesign(np.radians(degrees), wire_radius, core_radius, 1.0, n_wires=n_wires)


def distance(degrees, n_wires, radius):
    """Least distance of two neighbouring centre lines, by looking at very many places."""
    place = np.linspace(0, min(2 * np.pi / n_wires, np.pi), 2_000_001)
    cotangent = 1 / np.tan(np.radians(degrees))
    square = 2 * (1 - np.cos(place)) + (cotangent * (2 * np.pi / n_wires - place)) ** 2
    return radius * np.sqrt(np.min(square))


@pytest.mark.parametrize("degrees", [1.0, 20.0, 45.0, 80.0, 89.5])
@pytest.mark.parametrize("n_wires", [1, 2, 3, 12, 60])
def test_gap_is_that_of_the_nearest_points(degrees, n_wires):
    expected = distance(degrees, n_wires, 10.0) - 2.0
    assert _wire_gap(layer(degrees, n_wires)) == pytest.approx(expected, abs=1e-6)


def test_gap_of_straight_wires_is_a_chord():
    gap = _wire_gap(layer(1e-6, np.array([3, 10, 31, 32])))
    chord = 20 * np.sin(np.pi / np.array([3, 10, 31, 32])) - 2
    assert gap == pytest.approx(chord, abs=1e-9)
    assert (gap > 0).tolist() == [True, True, True, False]


def test_a_full_circumference_does_not_fit_since_the_cylinder_is_round():
    full = layer(np.degrees(np.arccos(12 / (10 * np.pi))), 12)
    assert _wire_gap(full) < 0
