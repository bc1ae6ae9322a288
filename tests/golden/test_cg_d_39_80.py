"""CG-D-39-80: plan, surfaces, line and outcomes as printed."""

from math import floor
from typing import NamedTuple

import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    coded_from_engineering,
    engineering_levels,
    model_matrix,
    plackett_burman,
    quadratic_exponents,
    term_names,
)
from reduction.experiments.least_squares_fit import statistics_from_r2
from reduction.experiments.life_statistics import fit_life, ratio_to_published_life
from reduction.experiments.run_sheet import (
    covariance_factor,
    find_cautions,
    make_run_sheet,
    variance_factor,
)
from reduction.experiments.screening import screening_effects
from reduction.experiments.strength_statistics import (
    fit_exposure_trend,
    group_statistics,
    one_way,
    ratio_of_means,
    strength_after,
)
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

LOW_TO_HIGH = {"1/2, 3/4": (0.12, 0.30, 0.05, 0.12), "1, 1 1/4": (0.10, 0.22, 0.05, 0.10)}


def factors(levels):
    low, high, amplitude_low, amplitude_high = LOW_TO_HIGH[levels]
    return (
        FactorLevels("frequency", 0.1, 0.5),
        FactorLevels("mean_tension", low, high, "rated_break_strength"),
        FactorLevels("tension_amplitude", amplitude_low, amplitude_high, "rated_break_strength"),
    )


# Rated break strength [lb]; mean and amplitude at -1, 0, +1 [lb].  The ends are printed with
# Tables 3 to 19 (rounded there to the pound); the centres follow from Tables 1 and 2.
LINES = {
    "nylon double braid 1/2": ("1/2, 3/4", 6400, (768, 1344, 1920), (320, 544, 768)),
    "nylon 8-strand 1/2": ("1/2, 3/4", 5760, (691.2, 1209.6, 1728), (288, 489.6, 691.2)),
    "polyester 8-strand 1/2": ("1/2, 3/4", 6600, (792, 1386, 1980), (330, 561, 792)),
    "polyester double braid 1/2": ("1/2, 3/4", 7000, (840, 1470, 2100), (350, 595, 840)),
    "nylon double braid 3/4": ("1/2, 3/4", 19100, (2292, 4011, 5730), (955, 1623.5, 2292)),
    "nylon double braid 1 and 1 1/4": ("1, 1 1/4", 33600, (3360, 5376, 7392), (1680, 2520, 3360)),
}


@pytest.mark.parametrize("line", LINES)
def test_levels_of_a_line_in_pounds(line):
    levels, strength, mean, amplitude = LINES[line]
    coded = np.repeat([[-1.0], [0.0], [1.0]], 3, axis=1)
    found = engineering_levels(coded, factors(levels), rated_break_strength=strength)
    np.testing.assert_allclose(found[:, 0], [0.1, 0.3, 0.5], rtol=1e-12)
    np.testing.assert_allclose(found[:, 1], mean, rtol=1e-12)
    np.testing.assert_allclose(found[:, 2], amplitude, rtol=1e-12)


# (mean, amplitude), frequencies, peak and minimum [%] for both sets of levels, by rising peak
BLOCKS = [
    ((-1, -1), [0], (17, 7), (15, 5)),
    ((-1, 0), [-1, 1], (20.5, 3.5), (17.5, 2.5)),
    ((-1, 1), [0], (24, 0), (20, 0)),
    ((0, -1), [-1, 1], (26, 16), (21, 11)),
    ((0, 0), [0, 0, 0], (29.5, 12.5), (23.5, 8.5)),
    ((0, 1), [-1, 1], (33, 9), (26, 6)),
    ((1, -1), [0], (35, 25), (27, 17)),
    ((1, 0), [-1, 1], (38.5, 21.5), (29.5, 14.5)),
    ((1, 1), [0], (42, 18), (32, 12)),
]


@pytest.mark.parametrize("levels", LOW_TO_HIGH)
def test_the_fifteen_runs_rise_in_nine_blocks(levels):
    sheet = make_run_sheet(box_behnken(3), factors(levels), rated_break_strength=6400.0)
    column = 2 if levels == "1/2, 3/4" else 3
    expected = [
        (number, (frequency, *block[0]), block[column])
        for number, block in enumerate(BLOCKS, start=1)
        for frequency in block[1]
    ]
    for row, (number, coded, (peak, minimum)) in enumerate(expected):
        assert sheet.load_block[row] == number
        assert tuple(sheet.coded[row]) == coded
        assert 100 * sheet.peak_share[row] == pytest.approx(peak, abs=1e-9)
        assert 100 * sheet.minimum_share[row] == pytest.approx(minimum, abs=1e-9)
        assert sheet.peak_tension[row] == pytest.approx(64 * peak)
        assert sheet.minimum_tension[row] == pytest.approx(64 * minimum, abs=1e-9)


@pytest.mark.parametrize("line", LINES)
def test_one_run_of_every_line_reaches_zero_tension(line):
    levels, strength, *_ = LINES[line]
    sheet = make_run_sheet(box_behnken(3), factors(levels), rated_break_strength=strength)
    slack = next(caution for caution in find_cautions(sheet) if caution.kind == "slack")
    (run,) = slack.runs
    assert tuple(sheet.coded[sheet.run == run][0]) == (0, -1, 1)
    assert "reaches zero" in slack.message


# CG-D-39-80: the F statistics of Table 3, typed from the page, and its design

# Table 3, K_ap of seven new lines: r2, F-STAT as printed
TABLE_3 = (
    ("0.985", "26.98"),
    ("0.977", "17.248"),
    ("0.998", "161.33"),
    ("0.999", "582.04"),
    ("0.995", "80.2"),
    ("0.993", "55.41"),
    ("0.983", "23.248"),
)
CRITICAL_AS_PRINTED = 3.48


@pytest.mark.parametrize(("r2", "printed"), TABLE_3)
def test_table_3_counts_the_mean_twice(r2, printed):
    half = 0.0005
    low, high = statistics_from_r2(
        np.array([float(r2) - half, float(r2) + half]), n_runs=15, n_terms=10
    ).printed_f
    digit = 0.5 * 10 ** -len(printed.partition(".")[2])
    assert low - digit <= float(printed) <= high + digit


def test_the_critical_value_is_that_of_degrees_of_freedom_transposed():
    found = statistics_from_r2(0.9, n_runs=15, n_terms=10)
    assert found.printed_critical == pytest.approx(CRITICAL_AS_PRINTED, abs=0.005)
    assert stats.f.isf(0.05, 10, 4) == pytest.approx(5.964, abs=5e-4)


def test_the_two_errors_nearly_cancel():
    """4.772 on the scale of the printed statistic is 3.436; r2 has to exceed 0.8957."""
    found = statistics_from_r2(0.8957, n_runs=15, n_terms=10)
    assert found.critical * 18 / 25 == pytest.approx(3.436, abs=5e-4)
    assert found.f == pytest.approx(found.critical, rel=1e-3)


def test_variance_factors_of_the_fifteen_runs():
    exponents = quadratic_exponents(3)
    matrix = model_matrix(box_behnken(3).coded, exponents)
    factor = covariance_factor(matrix, names=term_names(exponents, ["f", "Tm", "dT"]))
    expected = [0.3333, *[0.2708] * 3, *[0.125] * 3, *[0.25] * 3]
    np.testing.assert_allclose(np.diag(factor), expected, atol=5e-5)
    assert np.linalg.cond(matrix) == pytest.approx(4.24, abs=0.005)
    assert variance_factor(matrix, factor).max() == pytest.approx(0.75)
    corner = variance_factor(model_matrix([[1.0, 1.0, -1.0]], exponents), factor)[0]
    assert corner == pytest.approx(1.396, abs=5e-4)


def test_levels_of_table_2_are_coded_as_appendix_c_says():
    """Nylon double braid, 1/2 in: 768, 1344, 1920 lb mean load; 320, 544, 768 lb amplitude."""
    coded = coded_from_engineering(
        [[768.0, 768.0], [1344.0, 544.0], [1920.0, 320.0]], low=[768.0, 320.0], high=[1920.0, 768.0]
    )
    np.testing.assert_allclose(coded, [[-1, 1], [0, 0], [1, -1]], atol=1e-15)


# CG-D-39-80, Table A-2: effects, smallest significant effects, and which factors count

FACTORS = ("f", "Tm", "dT", "duration", "D")
# effects as printed, smallest significant effect as printed, its error, factors that count
TABLE = {
    "K_ap": ((6.1, 14.3, 3.1, 5.3, 3.7), 7.72, 3.973, {"Tm"}),
    "K1": ((5.2, 8.3, 3.5, 5.0, 0.6), 8.0, 4.117, {"Tm"}),
    "K0": ((0.5, 6.5, 1.1, 0.2, 1.6), 1.5, 0.772, {"Tm", "D"}),
    "tau": ((5.3, 2.3, 5.7, 4.5, 4.2), 10.79, 5.553, set()),
    "H": ((0.7, 6.6, 6.1, 0.5, 4.5), 3.12, 1.606, {"Tm", "dT", "D"}),
    "tensile strength": ((0.5, 0.1, 0.4, 1.0, 9.4), 1.4, 0.720, {"D"}),
    "elongation at failure": ((6.9, 8.1, 0.0, 6.6, 9.4), 7.0, 3.602, {"Tm", "D"}),
}
HALF_A_DIGIT = {7.72: 0.005, 10.79: 0.005, 3.12: 0.005, 8.0: 0.05, 1.5: 0.05, 1.4: 0.05, 7.0: 0.05}


def screened():
    design = plackett_burman(5)
    columns = np.hstack([design.coded, design.dummy])
    effects = np.array([[*row[0], *np.full(6, row[2])] for row in TABLE.values()])
    return screening_effects(design, effects @ columns.T / 2, names=FACTORS)


@pytest.mark.parametrize("number", range(len(TABLE)), ids=TABLE)
def test_a_row_of_table_a2_comes_back(number):
    printed, smallest, error, marked = list(TABLE.values())[number]
    found = screened()
    np.testing.assert_allclose(found.effect[number], printed, atol=1e-9)
    assert found.effect_standard_error[number] == pytest.approx(error)
    assert abs(found.minimum_significant_effect[number] - smallest) < HALF_A_DIGIT[smallest]
    counted = {
        name for name, counts in zip(FACTORS, found.is_significant[number], strict=True) if counts
    }
    assert counted == marked


def test_taken_together_the_five_factors_clear_a_higher_bar():
    # Not in the report: at 90 % for one effect, five noise effects give a false mark in 41 %.
    found = screened()
    assert np.all(found.simultaneous_minimum_effect > found.minimum_significant_effect)


# CG-D-39-80: the seven new lines at their centre point, with the equations both ways


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


LINES_OF_PULLS = {
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
EACH = pytest.mark.parametrize("name", LINES_OF_PULLS)


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
    assert rest_of(LINES_OF_PULLS[name]) / 1e4 == half_digit(LINES_OF_PULLS[name].rest, 3)


@EACH
def test_apparent_spring_constant_and_energy_by_the_equations(name):
    apparent, energy = predicted(LINES_OF_PULLS[name])
    assert apparent == half_digit(LINES_OF_PULLS[name].predicted_apparent, 3)
    assert energy == half_digit(
        LINES_OF_PULLS[name].predicted_energy, 2 if name == "nylon braid 1" else 3
    )
    # omega = 2 pi f returns the printed K_ap; omega = f would give 0.55 to 0.80 of it
    assert 0.966 <= round(apparent / LINES_OF_PULLS[name].apparent, 3) <= 1.013


@EACH
def test_relaxation_time_solved_from_the_printed_loop(name):
    line = LINES_OF_PULLS[name]
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
    constant = [np.pi * line.energy / predicted(line)[1] for line in LINES_OF_PULLS.values()]
    log = np.log(constant)
    width = stats.t.ppf(0.975, 6) * log.std(ddof=1) / np.sqrt(7)
    assert np.exp(log.mean()) == half_digit(3.166, 3)
    assert np.exp(log.mean() - width) == half_digit(2.82, 2)
    assert np.exp(log.mean() + width) == half_digit(3.56, 2)
    assert np.median(constant) == half_digit(3.133, 3)


def test_the_printed_form_of_the_energy_is_three_times_too_small():
    line = LINES_OF_PULLS["polyester plaited 1/2"]
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
    assert ratio_of_times(LINES_OF_PULLS[name]) == half_digit(
        LINES_OF_PULLS[name].time_ratio, digits
    )


def test_printed_times_follow_one_over_frequency():
    # nylon braid 1/2: the surface of tau fails its own F test
    passing = {name: line for name, line in LINES_OF_PULLS.items() if name != "nylon braid 1/2"}
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


# strength, exposure, one-way F and abrasion of CG-D-39-80, typed from the report

NAN = float("nan")
# mean, deviation, n; reference mean, deviation, n; printed change, change of the table's numbers
TABLE_10 = {
    "polyester double braid, 5 years, lb": (3241, NAN, 2, 6400, 473, 16, -49, -49),
    "polyester double braid, 5 years, strain": (0.197, NAN, 2, 0.132, 0.014, 16, 51, 49),
    "polyester plaited, 4 years, lb": (5096, 471, 5, 6690, 335, 10, -23, -24),
    "polyester plaited, 4 years, strain": (0.205, 0.037, 5, 0.184, 0.031, 10, 11, 11),
    "nylon double braid, 5 years, lb": (2783, 248, 4, 6512, 455, 20, -57, -57),
    "nylon double braid, 5 years, strain": (0.312, 0.021, 4, 0.211, 0.028, 20, 47, 48),
    "nylon plaited, 4 years, lb": (3525, NAN, 4, 7878, 461, 13, -55, -55),
    "nylon plaited, 5 years, lb": (4416, NAN, 1, 7878, 461, 13, -44, -44),
    "nylon plaited, 5 years, strain": (0.40, NAN, 1, 0.284, 0.023, 13, 40, 41),
}
# printed with the digits cut off, or (first) with .13 for .132
NOT_ROUNDED = {name for name, row in TABLE_10.items() if row[6] != row[7]}


def change_of(mean, deviation, n, reference, reference_deviation, reference_n):
    return ratio_of_means(
        mean, deviation, n, reference_mean=reference,
        reference_standard_deviation=reference_deviation, reference_n=reference_n,
    )  # fmt: skip


@pytest.mark.parametrize("name", TABLE_10)
def test_changes_of_table_10(name):
    *numbers, printed, computed = TABLE_10[name]
    change = 100 * float(change_of(*numbers).change)
    assert change == pytest.approx(computed, abs=0.5)
    if name not in NOT_ROUNDED:
        assert change == pytest.approx(printed, abs=0.5)


def test_what_table_10_prints_otherwise_is_cut_off_or_of_the_shorter_strain():
    assert len(NOT_ROUNDED) == 4
    assert 100 * (0.197 / 0.13 - 1) == pytest.approx(51, abs=0.6)
    for name in NOT_ROUNDED - {"polyester double braid, 5 years, strain"}:
        *numbers, printed, _ = TABLE_10[name]
        assert int(100 * float(change_of(*numbers).change)) == printed


def test_all_changes_with_known_scatter_are_told_from_zero_but_one():
    known = {name: row for name, row in TABLE_10.items() if row[1] == row[1]}
    crosses = set()
    for name, row in known.items():
        change = change_of(*row[:6])
        assert change.low < change.change < change.high
        if change.low < 0 < change.high:
            crosses.add(name)
    # a strain that rises 11 % with deviations of 17 and 18 % and five specimens
    assert crosses == {"polyester plaited, 4 years, strain"}


def test_changes_of_table_21():
    change = change_of([4365, 0.20], [321, 0.045], [4, 4], [6400, 0.13], [473, 0.014], [16, 16])
    np.testing.assert_allclose(100 * change.change, [-31.8, 53.8], atol=0.05)
    np.testing.assert_allclose(np.rint(100 * change.change), [-32, 54])


def test_relative_variability_of_table_21():
    for mean, deviation, printed in (
        (6400, 473, 0.073), (4365, 321, 0.073), (0.13, 0.014, 0.107), (0.20, 0.045, 0.225),
    ):  # fmt: skip
        (value,) = of_sample(mean, deviation, 16).relative_variability
        assert floor(1000 * value + 1e-9) / 1000 == printed


# mean, deviation, n of both; printed F, F of the numbers; printed degrees of freedom and
# critical value, correct critical value
TABLES_A3_A4 = {
    "A-3 1/2, dry and wet": ((7850, 460, 13), (6920, 320, 9), 26.87, 27.4, 20, 4.35, 4.35),
    "A-3 1/2, before and after": ((6920, 320, 9), (7640, 180, 6), 29.24, 24.7, 13, 4.67, 4.67),
    "A-3 13/16, before and after": ((17530, 900, 9), (17030, 1630, 6), 0.61, 0.59, 13, 4.67, 4.67),
    "A-3 1/2, dry and after": ((7850, 460, 13), (7640, 180, 6), 1.30, 1.14, 17, 3.45, 4.45),
    "A-4 1/2, low and wet": ((38.3, 2.0, 3), (42, 6.8, 9), 0.83, 0.82, 10, 4.96, 4.96),
    "A-4 1/2, high and wet": ((24.7, 1.42, 3), (42, 6.8, 9), 18.13, 18.0, 10, 4.96, 4.96),
    "A-4 1/2, low and high": ((38.3, 2.0, 3), (24.7, 1.42, 3), 89.79, 92.2, 4, 7.71, 7.71),
    "A-4 13/16, low and wet": ((41.9, 9.82, 3), (39.7, 4.57, 9), 0.33, 0.30, 10, 4.96, 4.96),
    "A-4 13/16, high and wet": ((39.5, 9.12, 3), (39.7, 4.57, 9), 0.003, 0.003, 10, 4.96, 4.96),
    "A-4 13/16, low and high": ((41.9, 9.82, 3), (39.5, 9.12, 3), 0.10, 0.10, 14, 7.71, 7.71),
}


@pytest.mark.parametrize("name", TABLES_A3_A4)
def test_one_way_f_of_tables_a3_and_a4(name):
    first, second, printed, computed, freedom, printed_critical, critical = TABLES_A3_A4[name]
    analysis = one_way(*np.transpose([first, second]))
    digits = len(str(computed).partition(".")[2])
    assert float(analysis.f_statistic) == pytest.approx(computed, abs=0.51 * 10**-digits)
    assert float(analysis.critical) == pytest.approx(critical, abs=0.005)
    # the verdict of the report stands, with its own critical value and with the correct one
    assert (computed > critical) == (printed > printed_critical)
    misprinted = {"A-3 1/2, dry and after": 17, "A-4 13/16, low and high": 14}
    assert (int(analysis.within) == freedom) or (misprinted[name], int(analysis.within)) == (14, 4)


# mean, deviation, n, printed relative variability
TABLE_20 = {
    ("nylon", "double braid"): (13606, 3331, 45, 0.24),
    ("nylon", "plaited"): (13173, 3278, 26, 0.24),
    ("nylon", "twisted"): (12575, 2835, 21, 0.22),
    ("polyester", "double braid"): (8134, 1963, 38, 0.24),
    ("polyester", "plaited"): (8212, 1763, 39, 0.21),
    ("polyester", "twisted"): (8086, 1660, 33, 0.20),
    ("polypropylene", "plaited"): (4254, 1221, 29, 0.28),
    ("polypropylene", "twisted"): (6064, 1621, 12, 0.26),  # prints 126
}


def of_sample(mean, deviation, n):
    """Statistics of a sample that has exactly this mean and deviation."""
    raw = np.random.default_rng(n).normal(size=n)
    sample = mean + deviation * (raw - raw.mean()) / raw.std(ddof=1)
    return group_statistics(sample, np.zeros(n, int), np.zeros(n, int), n_groups=1)


@pytest.mark.parametrize("line", TABLE_20, ids=" ".join)
def test_relative_variability_of_table_20_is_printed_cut_off(line):
    mean, deviation, n, printed = TABLE_20[line]
    statistics = of_sample(mean, deviation, n)
    assert statistics.n == n
    assert statistics.mean == pytest.approx(mean)
    assert floor(100 * float(statistics.relative_variability[0])) / 100 == printed


@pytest.mark.parametrize(
    ("material", "construction", "ratio"),
    [
        ("nylon", "plaited", 3.10),
        ("polyester", "plaited", 1.93),
        ("nylon", "twisted", 2.07),
        ("polyester", "twisted", 1.33),
    ],
)
def test_ratios_to_polypropylene(material, construction, ratio):
    result = change_of(
        *TABLE_20[material, construction][:3], *TABLE_20["polypropylene", construction][:3]
    )
    assert float(result.ratio) == pytest.approx(ratio, abs=0.005)
    assert result.low + 1 > 1  # more resistant, with 95 % confidence
    # "three times" and "two times" hold for plaited line, and not for twisted
    claimed = {"nylon": 3, "polyester": 2}[material]
    assert (result.low + 1 < claimed < result.high + 1) == (construction == "plaited")


def test_jacket_lasts_four_to_six_times_longer_than_the_mode():
    lives = np.array([29e3, 39e3, 41e3])
    of_mode = change_of(lives, NAN, 1, 7000.0, NAN, 1)
    np.testing.assert_allclose(of_mode.ratio, [4.14, 5.57, 5.86], atol=0.005)
    assert of_mode.ratio.mean() == pytest.approx(5.2, abs=0.05)
    assert lives.mean() / 8134 == pytest.approx(4.5, abs=0.05)


def test_jacketed_samples_known_only_to_last_longer_raise_the_ratio():
    # the lives of the other ten of thirteen are not printed; they rose from test to test, so that
    # each is taken to have passed the third
    reference = {"reference_mean": 8134, "reference_standard_deviation": 1963, "reference_n": 38}
    three = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3, **reference)
    all_of_them = ratio_to_published_life(
        [29e3, 39e3] + [41e3] * 11, [False] * 3 + [True] * 10, **reference
    )
    assert all_of_them[0] > three[0] and all_of_them[1] > three[1]
    median = fit_life([29e3, 39e3] + [41e3] * 11, [False] * 3 + [True] * 10)
    assert median.life > 41e3


FIGURE_15 = ([0, 2, 3, 5], [6400, 4672, 4365, 3241], [473, NAN, 321, NAN], [16, 1, 4, 2])


def test_polyester_double_braid_loses_a_tenth_of_its_strength_a_year():
    line = fit_exposure_trend(*FIGURE_15)
    slope, intercept = np.polyfit(*FIGURE_15[:2], 1, w=np.sqrt(FIGURE_15[3]))
    assert (line.intercept, line.slope) == pytest.approx((intercept, slope))
    # "linear", "approximately 50 %" after five years
    assert line.lack_of_fit_p_value > 0.05
    _, low, high, _ = strength_after(line, 5.0)
    assert low / 6400 < 0.5 < high / 6400
