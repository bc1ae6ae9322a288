"""The midline of a loop at its mean strain, of loops whose spring is known."""

import numpy as np
import pytest

from reduction.stages.three_parameter_line.loop_midline import (
    chord_of_spring,
    spring_of_cycle,
    spring_of_wave,
    tension_above_midline,
)

N, CYCLES = 60, 8
PHASE = np.arange(N * CYCLES + 1) * 2 * np.pi / N
FIRST = np.arange(CYCLES) * N


def found(strain, tension):
    return tension_above_midline(strain, tension, first=FIRST, turn=FIRST + N // 2, last=FIRST + N)


@pytest.mark.parametrize("bend", [0.0, 6e6])
@pytest.mark.parametrize("tau", [0.0, 0.3, 2.0])
def test_the_spring_of_a_driven_line_is_found(bend, tau):
    """K_1 and tau beside 20 kN + 8e5 e + c e^2, steady at 0.2 Hz, in closed form; noise of 10 N."""
    amplitude, turned = 0.009, 2j * np.pi * 0.2 * tau
    wave = -amplitude * np.exp(1j * PHASE)
    beside = (7e5 * turned / (1 + turned) * wave).real
    spring = 20e3 + 8e5 * wave.real + bend * wave.real**2
    tension = spring + beside + np.random.default_rng(4).normal(0, 10, PHASE.size)
    above, u = found(1 / 30 + wave.real, tension)
    cycle = (spring + beside)[:N]
    assert above == pytest.approx((cycle.max() + cycle.min()) / 2 - 20e3, abs=15.0)
    assert 1 < u < 15


def test_a_line_that_is_driven_by_its_load_has_the_bend_in_its_strain():
    """The strain of T = 4e5 e + 6e6 e^2 under 20 +- 6 kN: its mean is not that of 20 kN."""
    tension = 20e3 - 6e3 * np.cos(PHASE)
    strain = (-4e5 + np.sqrt(16e10 + 24e6 * tension)) / 12e6
    middle = (strain.max() + strain.min()) / 2
    above, _ = found(strain, tension)
    assert above == pytest.approx(20e3 - (4e5 * middle + 6e6 * middle**2), rel=1e-3)


def test_too_few_cycles_or_samples_say_nothing():
    rows = slice(0, 2)
    few = tension_above_midline(
        PHASE, PHASE, first=FIRST[rows], turn=FIRST[rows] + 9, last=FIRST[rows] + N
    )
    assert np.isnan(few).all()
    short = tension_above_midline(np.cos(PHASE), PHASE, first=FIRST, turn=FIRST + 3, last=FIRST + 8)
    assert np.isnan(short).all()


def test_the_chord_of_an_exponential_spring():
    """T = 2e4 (exp(e / .05) - 1), K_0 = (T + 2e4) / .05: chord and middle in closed form."""
    middle, d = np.array([1e4, 2e4]), np.array([0.009, 0.012])
    at = 0.05 * np.log1p(middle / 2e4)
    high, low = (2e4 * np.expm1((at + side * d) / 0.05) for side in (1, -1))

    def constant_at(tension):
        return (tension + 2e4) / 0.05

    chord, above = chord_of_spring(constant_at, middle, d)
    assert chord == pytest.approx((high - low) / (2 * d), rel=5e-5)
    assert above == pytest.approx((high + low) / 2 - middle, rel=1e-3)
    assert spring_of_cycle(constant_at, (high + low) / 2, d) == pytest.approx(chord, rel=1e-5)


def test_a_chord_beyond_the_pull_is_not_known():
    def constant_at(tension):
        return np.where(tension < 2.1e4, 8e5, np.nan)

    assert np.isnan(chord_of_spring(constant_at, [2e4, 2e4], [0.001, 0.002])[0]).tolist() == [
        False,
        True,
    ]


@pytest.mark.parametrize("control", ["load", "position"])
@pytest.mark.parametrize("waveform", ["triangular", "sinusoidal"])
def test_k_0_of_a_wave_is_what_its_reading_has_of_an_exponential_spring(waveform, control):
    """Without a dashpot: the fundamental of a triangle by quadrature, a sine by its extremes."""
    start, soft = 2e4, 0.05
    phase = 2 * np.pi * (np.arange(20000) + 0.5) / 20000
    wave = 2 / np.pi * np.arcsin(np.cos(phase)) if waveform == "triangular" else np.cos(phase)
    if control == "load":
        tension = 2e4 + 6e3 * wave
        strain = soft * np.log1p(tension / start)
    else:
        strain = 0.035 + 0.0075 * wave
        tension = start * np.expm1(strain / soft)
    true = np.ptp(tension) / np.ptp(strain)
    if waveform == "triangular":
        true = (tension @ np.cos(phase)) / (strain @ np.cos(phase))
    middle = start * np.expm1((strain.max() + strain.min()) / 2 / soft)
    mean = (tension.max() + tension.min()) / 2
    k_0 = spring_of_wave(
        lambda t: (t + start) / soft, mean, mean - middle, np.ptp(strain) / 2,
        waveform=waveform, control=control,
    )  # fmt: skip
    assert k_0 == pytest.approx(true, rel=1e-4)
    # slope at the mean, and without its share the chord, are both farther off
    assert abs((mean + start) / soft / true - 1) > 1e-3


def test_without_a_chord_k_0_of_a_wave_is_the_slope_at_the_midline():
    def constant_at(tension):
        return np.where(tension < 2.1e4, 8e5 + tension, np.nan)

    assert spring_of_wave(constant_at, 2e4, 500.0, 0.002) == 8e5 + 19500
