import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    line_sensitivities,
)


def by_fundamental(stored, lost, frequency, rest):
    excess = stored - rest
    spring = excess + lost**2 / excess
    time = excess / lost / (2 * np.pi * frequency)
    return stored, lost, spring, time, spring * time


def by_amplitude(k_ap, energy, amplitude, frequency, rest):
    lost = energy * k_ap**2 / (np.pi * amplitude**2)
    return by_fundamental(np.sqrt(k_ap**2 - lost**2), lost, frequency, rest)


def complex_step(function, inputs):
    """Log sensitivities without differences: the imaginary part of a step of 1e-30."""
    table = np.empty((5, len(inputs)))
    base = function(*inputs)
    for column, value in enumerate(inputs):
        moved = [complex(one) for one in inputs]
        moved[column] = value * (1 + 1e-30j)
        table[:, column] = [
            (new / old).imag / 1e-30 for new, old in zip(function(*moved), base, strict=True)
        ]
    return table


@pytest.mark.parametrize(
    ("energy", "rest"), [(0.05, 1.2e4), (3.1, 1.2e4), (3.1, 2.5e4), (3.1, 3.0e4), (16.0, 1.2e4)]
)
def test_sensitivities_of_the_amplitudes_are_the_complex_step(energy, rest):
    inputs = (3.088e4, energy, 489.6, 0.3, rest)
    stored, lost, *_ = by_amplitude(*inputs)
    table = amplitude_sensitivities(stored, lost, rest)
    expected = complex_step(by_amplitude, inputs)
    assert table == pytest.approx(expected, rel=1e-10, abs=1e-12)


def test_sensitivities_of_the_fundamental_are_the_complex_step():
    inputs = (3.0e4, 4.0e3, 0.3, 1.2e4)
    table = line_sensitivities(inputs[0], inputs[1], inputs[3])
    assert table == pytest.approx(complex_step(by_fundamental, inputs), rel=1e-10, abs=1e-12)


def test_sensitivities_of_x_are_the_printed_formulas():
    k_ap, lost, rest = 3.0, 0.7, 1.3
    stored = np.sqrt(k_ap**2 - lost**2)
    excess = stored - rest
    row = amplitude_sensitivities(stored, lost, rest)[OUTPUTS.index("relaxation_time")]
    formulas = {
        "hysteresis_energy": -1 - lost**2 / (stored * excess),
        "apparent_spring_constant": (k_ap**2 - 2 * lost**2) / (stored * excess) - 2,
        "quasi_static_spring_constant": -rest / excess,
        "tension_amplitude": 2 + 2 * lost**2 / (stored * excess),
        "frequency": -1.0,
    }
    assert dict(zip(AMPLITUDE_INPUTS, row, strict=True)) == pytest.approx(formulas)


def test_shapes_follow_the_lines():
    assert line_sensitivities(*np.full((3, 2, 4), 1.0)).shape == (5, len(FUNDAMENTAL_INPUTS), 2, 4)
    assert amplitude_sensitivities(*np.full((3, 7), 1.0)).shape == (5, len(AMPLITUDE_INPUTS), 7)


def test_shapes_that_differ_are_refused():
    with pytest.raises(DataError, match="series do not pair up"):
        line_sensitivities([1.0, 2.0], 1.0, 0.5)
