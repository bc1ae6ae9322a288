import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.line_model import (
    _storage_and_loss,
    apparent_spring_constant,
    dashpot_coefficient,
    hysteresis_energy,
)

LINE = {
    "quasi_static_spring_constant": 1.2e4,
    "dissipation_spring_constant": 1.8e4,
    "relaxation_time": 2.0,
}


def cycle_by_differential_equation(frequency, strain_amplitude, n=4001):
    """Tension of the line over one steady cycle, by solving for the arm step by step."""
    k0, k1, tau = LINE.values()
    t = np.linspace(0, 1 / frequency, n)
    omega = 2 * np.pi * frequency
    # arm: q' = k1 e' - q/tau, q = k1 e - k1/tau * integral of exp(-(t-s)/tau) e ds; steady part
    strain = strain_amplitude * np.sin(omega * t)
    q = 0.0
    steps = np.diff(t)
    for _ in range(12):  # cycles until the start no longer matters
        arm = [q]
        for i, dt in enumerate(steps):
            decay = np.exp(-dt / tau)
            rate = k1 * (strain[i + 1] - strain[i]) / dt
            q = q * decay + rate * tau * (1 - decay)
            arm.append(q)
    return strain, k0 * strain + np.array(arm)


@pytest.mark.parametrize("frequency", [0.02, 0.1, 0.7])
def test_amplitudes_and_area_are_those_of_the_differential_equation(frequency):
    strain, tension = cycle_by_differential_equation(frequency, 0.05)
    amplitude = np.ptp(tension) / 2
    area = np.trapezoid(tension, strain)
    assert apparent_spring_constant(frequency=frequency, **LINE) == pytest.approx(
        amplitude / 0.05, rel=1e-4
    )
    assert hysteresis_energy(
        frequency=frequency, tension_amplitude=amplitude, **LINE
    ) == pytest.approx(area, rel=1e-4)


def test_the_closed_form_of_the_energy_has_pi_and_the_square_of_the_rest_spring():
    k0, k1, tau = LINE.values()
    x = 2 * np.pi * 0.3 * tau
    closed = np.pi * k1 * 500.0**2 * x / (k0**2 + (k0 + k1) ** 2 * x**2)
    assert hysteresis_energy(frequency=0.3, tension_amplitude=500.0, **LINE) == pytest.approx(
        closed, rel=1e-14
    )


def test_storage_and_loss_are_the_complex_spring_constant():
    stored, lost = _storage_and_loss(frequency=0.3, **LINE)
    k0, k1, tau = LINE.values()
    turn = 2j * np.pi * 0.3 * tau
    whole = k0 + k1 * turn / (1 + turn)
    assert stored == pytest.approx(whole.real, rel=1e-14)
    assert lost == pytest.approx(whole.imag, rel=1e-14)


def test_a_missing_input_gives_a_missing_number():
    assert np.isnan(apparent_spring_constant(frequency=np.nan, **LINE))


def test_shapes_broadcast():
    stored, lost = _storage_and_loss(
        frequency=np.ones((3, 1)), **{**LINE, "relaxation_time": [1, 2]}
    )
    assert stored.shape == lost.shape == (3, 2)


@pytest.mark.parametrize("name", [*LINE, "frequency"])
def test_a_negative_input_is_refused_by_name(name):
    with pytest.raises(DataError, match=f"1 of 2 values of {name.replace('_', ' ')} are negative"):
        _storage_and_loss(**{"frequency": 0.3, **LINE, name: [1.0, -2.0]})


def test_a_negative_amplitude_is_refused():
    with pytest.raises(DataError, match="tension amplitude are negative; found -1"):
        hysteresis_energy(frequency=0.3, tension_amplitude=-1.0, **LINE)
    with pytest.raises(DataError, match="relaxation time are negative"):
        dashpot_coefficient(dissipation_spring_constant=1.0, relaxation_time=-1.0)
