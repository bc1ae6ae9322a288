"""CG-D-39-80: the seven new lines at their centre point, with the equations both ways.

B1 of each response surface is the mean of the three centre runs, at 0.3 Hz.  Units of the
report: K in 1e4 lb, H in lb in/in, tau in s, tension in lb.
"""

from typing import NamedTuple

import numpy as np
import pytest
from scipy import stats

from reduction.stages.three_parameter_line.line_model import (
    VERDICTS,
    apparent_spring_constant,
    check_single_time,
    hysteresis_energy,
    identify_by_amplitude,
)
from reduction.stages.three_parameter_line.slow_pull import (
    fit_pull,
    slope_of_cubic,
    spring_constant_ratio,
    strain_at_break_share,
)


class Line(NamedTuple):
    mean_tension: float
    amplitude: float
    # B1 of Tables 3, 11 (polyester braid: 13, Table 11 repeats its K_1 there), 14, 17
    apparent: float
    energy: float
    spring: float
    time: float
    # A, B, C, D of K_0 as printed in Tables 6 and 7 (powers of ten in the heads)
    polynomial: tuple[float, float, float, float] | None
    # K_0, K_ap, H by the equations, and tau solved from K_ap and H over tau printed
    rest: float
    predicted_apparent: float
    predicted_energy: float
    solved_over_printed: float
    # B1, B2, B5 of Table 17
    time_terms: tuple[float, float, float]
    time_ratio: float


LINES = {
    # Table 7, new; C printed without its minus sign, which gives 9.4 in place of 1.21
    "nylon plaited 1/2": Line(
        1209.6, 489.6, 3.088, 3.10, 1.855, 2.057, (-0.49, 36.22, -28.1, 81.03),
        1.214, 2.987, 3.786, 1.21, (2.057, 2.173, -3.523), 10.97),
    # no row in Tables 6 and 7; slope of Table 8
    "polyester plaited 1/2": Line(
        1386, 561, 6.317, 1.392, 4.353, 4.007, None,
        2.014, 6.318, 1.403, 1.01, (4.007, 4.885, -7.708), 14.02),
    "polyester braid 1/2": Line(
        1344, 544, 9.457, 1.20, 3.593, 1.488, (2.327, 73.12, -41.35, 53.04),
        5.973, 9.231, 1.240, 1.05, (1.488, 1.169, -1.278), 2.85),
    # Table 7; Table 6 prints D = 3.26
    "nylon braid 1/2": Line(
        1344, 544, 3.451, 3.08, 1.699, 2.272, (0.698, 5.80, -2.24, 32.6),
        1.864, 3.496, 2.862, 0.93, (2.272, 0.679, -2.791), 35.9),
    "nylon braid 3/4": Line(
        4011, 1623.5, 11.867, 8.23, 4.463, 1.643, (1.477, -0.329, 5.035, -3.25),
        7.348, 11.464, 8.222, 1.02, (1.643, 0.755, -1.545), 4.62),
    "nylon braid 1": Line(
        5376, 2520, 14.577, 30.92, 8.807, 1.560, (1.492, -1.52, 3.008, -1.798),
        6.575, 14.716, 24.73, 0.79, (1.560, 1.221, -1.591), 3.67),
    "nylon braid 1 1/4": Line(
        5376, 2520, 19.790, 20.567, 13.413, 1.643, (2.66, 2.46, 1.670, -1.208),
        6.932, 19.478, 20.625, 1.00, (1.643, 0.978, -1.718), 4.81),
}  # fmt: skip

# Table 8: A x 1e-4, B x 1e-4, C x 1e-8, D x 1e-12
STRAIN = {
    "nylon braid 1/2": (-4.13, 1.389, -3.906, 3.795),
    "nylon braid 3/4": (33.04, 0.7428, -1.313, 0.896),
    "nylon plaited 1/2": (368, 1.694, -3.943, 3.02),
    "polyester braid 1/2": (2.70, 0.2709, -0.908, 2.568),
    "polyester plaited 1/2": (173.0, 0.417, 0.199, 0.4209),
}
EACH = pytest.mark.parametrize("name", LINES)


def strain_cubic(name):
    return np.array(STRAIN[name]) * [1e-4, 1e-4, 1e-8, 1e-12]


def rest_of(line):
    if line.polynomial is None:
        return float(slope_of_cubic(line.mean_tension, strain_cubic("polyester plaited 1/2")))
    powers = line.mean_tension ** np.arange(4)
    return float(powers @ (np.array(line.polynomial) * [1, 1e-4, 1e-7, 1e-11])) * 1e4


def predicted(line):
    parameters = {
        "quasi_static_spring_constant": rest_of(line),
        "dissipation_spring_constant": line.spring * 1e4,
        "relaxation_time": line.time,
        "frequency": 0.3,
    }
    return (
        float(apparent_spring_constant(**parameters)) / 1e4,
        float(hysteresis_energy(tension_amplitude=line.amplitude, **parameters)),
    )


def half_digit(number, digits):
    return pytest.approx(number, abs=0.5 * 10.0**-digits)


@EACH
def test_quasi_static_spring_constant_at_the_centre(name):
    assert rest_of(LINES[name]) / 1e4 == half_digit(LINES[name].rest, 3)


@EACH
def test_apparent_spring_constant_and_energy_by_the_equations(name):
    apparent, energy = predicted(LINES[name])
    assert apparent == half_digit(LINES[name].predicted_apparent, 3)
    assert energy == half_digit(LINES[name].predicted_energy, 2 if name == "nylon braid 1" else 3)
    # omega = 2 pi f returns the printed K_ap; omega = f would give 0.55 to 0.80 of it
    assert 0.966 <= round(apparent / LINES[name].apparent, 3) <= 1.013


@EACH
def test_relaxation_time_solved_from_the_printed_loop(name):
    line = LINES[name]
    found = identify_by_amplitude(
        apparent_spring_constant=line.apparent * 1e4,
        hysteresis_energy=line.energy,
        tension_amplitude=line.amplitude,
        frequency=0.3,
        quasi_static_spring_constant=rest_of(line),
    )
    assert found.relaxation_time / line.time == half_digit(line.solved_over_printed, 2)
    # loss angles of the report lie between 5 and 13 degrees
    assert 5 < np.degrees(found.loss_angle) < 13.5


def test_the_constant_of_the_energy_is_pi():
    constant = [np.pi * line.energy / predicted(line)[1] for line in LINES.values()]
    log = np.log(constant)
    width = stats.t.ppf(0.975, 6) * log.std(ddof=1) / np.sqrt(7)
    assert np.exp(log.mean()) == half_digit(3.166, 3)
    assert np.exp(log.mean() - width) == half_digit(2.82, 2)
    assert np.exp(log.mean() + width) == half_digit(3.56, 2)
    assert np.median(constant) == half_digit(3.133, 3)


def test_the_printed_form_of_the_energy_is_three_times_too_small():
    line = LINES["polyester plaited 1/2"]
    x = 2 * np.pi * 0.3 * line.time
    rest, spring = rest_of(line), line.spring * 1e4
    printed = spring * line.amplitude**2 * x / (rest + (rest + spring) ** 2 * x**2)
    assert printed == half_digit(0.447, 3)
    # without the pi, x = A/E'' is near pi times too large and the time with it
    with_pi = predicted(line)[1]
    assert with_pi / printed == pytest.approx(np.pi, rel=0.01)


def ratio_of_times(line):
    mean, square, slope = line.time_terms
    return (mean + square - slope) / (mean + square + slope)


@EACH
def test_printed_times_at_the_two_ends_of_frequency(name):
    digits = 1 if name == "nylon braid 1/2" else 2
    assert ratio_of_times(LINES[name]) == half_digit(LINES[name].time_ratio, digits)


def test_printed_times_follow_one_over_frequency():
    # nylon braid 1/2: the surface of tau fails its own F test
    passing = {name: line for name, line in LINES.items() if name != "nylon braid 1/2"}
    ratios = [ratio_of_times(line) for line in passing.values()]
    assert np.median(ratios) == half_digit(4.7, 1)
    frequency, times, group = [], [], []
    for name, line in passing.items():
        mean, square, slope = line.time_terms
        frequency += [0.1, 0.5]
        times += [mean + square - slope, mean + square + slope]
        group += [name, name]
    check = check_single_time(frequency, times, np.full(12, 0.12), group=group)
    # one factor a line: the exponent is the mean of ln(ratio)/ln(5), with its deviation
    each = np.log(ratios) / np.log(5)
    assert check.exponent == pytest.approx(each.mean())
    assert check.exponent_standard_uncertainty == pytest.approx(each.std(ddof=1) / np.sqrt(6))
    assert check.degrees_of_freedom == 5
    assert check.time_ratio == pytest.approx(np.exp(np.mean(np.log(ratios))))
    assert VERDICTS[int(check.verdict)].startswith("the relaxation time follows 1/f")
    assert check.p_one_time < 0.01 < check.p_inverse_frequency


@pytest.mark.parametrize(
    ("name", "levels", "expected"),
    [
        ("nylon braid 1/2", (768, 1344, 1920), (1.168, 1.836, 3.238)),
        ("nylon plaited 1/2", (691.2, 1209.6, 1728), (0.839, 1.146, 1.662)),
        ("polyester plaited 1/2", (1386,), (2.014,)),
    ],
)
def test_slopes_of_table_8(name, levels, expected):
    slope = slope_of_cubic(levels, strain_cubic(name)) / 1e4
    assert slope == pytest.approx(expected, abs=0.5e-3)


@pytest.mark.parametrize(
    ("name", "strength", "percent"),
    [
        ("nylon braid 1/2", 6400, 14.9),  # Table 2; text: approximately 15 %
        ("nylon plaited 1/2", 7878, 25.7),  # Table 10; text: 25 %
        ("polyester braid 1/2", 6400, 3.7),  # Table 10; text: 4 %
        ("polyester plaited 1/2", 6690, 11.2),  # Table 10; text: 11 %
    ],
)
def test_strain_at_thirty_percent_of_break_strength(name, strength, percent):
    load = np.linspace(0, 0.32 * strength, 900)
    pull = fit_pull(np.arange(900.0), load[:, None] ** np.arange(4) @ strain_cubic(name), load)
    strain, _ = strain_at_break_share(pull, 0.3, rated_break_strength=strength)
    assert 100 * strain == half_digit(percent, 1)
    assert pull.strain_coefficient == pytest.approx(strain_cubic(name), rel=1e-8, abs=1e-16)


def test_rate_and_waiting_time_change_the_quasi_static_spring_constant_as_table_d_1_has_it():
    load = np.linspace(0, 2000, 500)

    def pull(spring, rate_per_minute, waiting):
        strain = load / (spring * 1e4)
        return fit_pull(60 * strain / rate_per_minute, strain, load, waiting=waiting)

    slow = pull(4.22, 0.071, "24 h after the dynamic test")
    fast = pull(6.33, 0.23, "24 h after the dynamic test")
    at_once = pull(7.71, 0.23, "immediately after the dynamic test")
    assert spring_constant_ratio(fast, slow, 1000.0)[0] == half_digit(1.50, 2)
    assert spring_constant_ratio(at_once, slow, 1000.0)[0] == half_digit(1.83, 2)
    assert [60 * one.strain_rate for one in (slow, fast)] == pytest.approx([0.071, 0.23])
    assert "24 h" in slow.waiting and not tuple(map(str, slow.notes))[1:]
