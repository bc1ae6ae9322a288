"""EA of a pull at a strain: its uncertainty is that at this strain, not at this tension."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.report.answer_tables import _at_one_strain, _Series

GAIN, POWER = 0.01, 3.0


def test_the_gain_of_a_load_cell_changes_a_slope_at_one_strain_by_all_of_itself():
    """T = e^3: K = 3 T^(2/3) at one tension changes by a third of the gain."""
    load = np.linspace(1.0, 8.0, 2001)
    strain, stiffness = load ** (1 / POWER), POWER * load ** (1 - 1 / POWER)
    # readings g T at the strain of T: strain and slope at a reading T are those of T / g
    read = load / (1 + GAIN)
    slope = (1 + GAIN) * POWER * read ** (1 - 1 / POWER)
    found = {
        "quasi_static_spring_constant_uncertainty_contribution": slope - stiffness,
        "quasi_static_strain_uncertainty_contribution": read ** (1 / POWER) - strain,
    }
    arrays = {name: values[None, None] for name, values in found.items()} | {
        f"{name}_random_standard_uncertainty": np.zeros((1, load.size))
        for name in ("quasi_static_spring_constant", "quasi_static_strain")
    }
    at_tension = _Series(stiffness, 1.96 * np.abs(slope - stiffness), np.full(load.size, 1.96))
    view = SimpleNamespace(array=arrays.get)
    made = _at_one_strain(view, 0, at_tension, load)
    assert (at_tension.half / stiffness)[1000] == pytest.approx(1.96 * GAIN / POWER, rel=0.02)
    assert (made.half / stiffness)[1:-1] == pytest.approx(1.96 * GAIN, rel=0.02)
    alone = SimpleNamespace(array={}.get)
    assert _at_one_strain(alone, 0, at_tension, load) is at_tension
