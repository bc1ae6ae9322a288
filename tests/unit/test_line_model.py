"""None"""

import numpy as np
import pytest
from refusals import refusals
from scipy import stats

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    VERDICTS,
    _power_of_frequency,
    _storage_and_loss,
    amplitude_sensitivities,
    apparent_spring_constant,
    check_single_time,
    hysteresis_energy,
    identify_by_amplitude,
    identify_by_fundamental,
    line_sensitivities,
    refused_lines,
)
from reduction.stages.three_parameter_line.line_product import REASONS

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


LOOP = {
    "apparent_spring_constant": 6.317e4,
    "hysteresis_energy": 1.392,
    "tension_amplitude": 561.0,
    "frequency": 0.3,
    "quasi_static_spring_constant": 2.014e4,
}
UNCERTAINTY = {
    "apparent_spring_constant": 6.317e4 * 0.003,
    "hysteresis_energy": 1.392 * 0.02,
    "tension_amplitude": 561.0 * 0.004,
    "frequency": 0.3 * 0.001,
    "quasi_static_spring_constant": 2.014e4 * 0.02,
}
NAMES = (
    "storage_spring_constant", "loss_spring_constant", "dissipation_spring_constant",
    "relaxation_time", "dashpot_coefficient",
)  # fmt: skip


def test_twenty_thousand_random_lines_come_back():
    rng = np.random.default_rng(42)
    rest, spring = 10 ** rng.uniform(3, 5.3, (2, 20_000))
    turn = 10 ** rng.uniform(-3, 3, 20_000)
    frequency = 10 ** rng.uniform(-2, 0.5, 20_000)
    line = {
        "quasi_static_spring_constant": rest,
        "dissipation_spring_constant": spring,
        "relaxation_time": turn / (2 * np.pi * frequency),
        "frequency": frequency,
    }
    found = identify_by_amplitude(
        apparent_spring_constant=apparent_spring_constant(**line),
        hysteresis_energy=hysteresis_energy(tension_amplitude=500.0, **line),
        tension_amplitude=500.0,
        frequency=frequency,
        quasi_static_spring_constant=rest,
    )
    assert not found.reason.any()
    for name in ("dissipation_spring_constant", "relaxation_time"):
        assert np.abs(getattr(found, name) / line[name] - 1).max() < 1e-7
    assert found.angular_frequency_relaxation_time == pytest.approx(turn, rel=1e-7)
    assert found.dashpot_coefficient == pytest.approx(
        line["dissipation_spring_constant"] * line["relaxation_time"], rel=2e-7
    )


def test_storage_and_loss_give_the_line_too():
    line = {
        "quasi_static_spring_constant": 1.2e4,
        "dissipation_spring_constant": [1.8e4, 5e3],
        "relaxation_time": [2.0, 0.1],
        "frequency": [[0.1], [0.5]],
    }
    stored, lost = _storage_and_loss(**line)
    found = identify_by_fundamental(
        storage_spring_constant=stored,
        loss_spring_constant=lost,
        frequency=line["frequency"],
        quasi_static_spring_constant=1.2e4,
    )
    assert found.relaxation_time == pytest.approx(np.array([[2.0, 0.1]] * 2), rel=1e-10)
    assert found.dissipation_spring_constant == pytest.approx(np.array([[1.8e4, 5e3]] * 2))
    assert found.loss_angle == pytest.approx(np.arctan(lost / stored))
    assert found.reading == "fundamental"


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"quasi_static_spring_constant": np.nan}, 1),
        ({"quasi_static_spring_constant": 0.0}, 2),
        ({"quasi_static_spring_constant": np.inf}, 2),
        ({"hysteresis_energy": np.nan}, 3),
        ({"frequency": np.nan}, 3),
        ({"hysteresis_energy": -1.0}, 4),
        ({"tension_amplitude": 0.0}, 4),
        ({"apparent_spring_constant": np.inf}, 4),
        # the area of a rectangle round the ellipse is more than its pi/4
        ({"hysteresis_energy": 4 * 561.0**2 / 6.317e4}, 5),
        ({"quasi_static_spring_constant": 6.4e4}, 6),
    ],
)
def test_a_line_that_cannot_be_has_no_number_and_a_reason(changed, reason):
    found = identify_by_amplitude(**{**LOOP, **changed}, standard_uncertainty=UNCERTAINTY)
    assert found.reason == reason
    for name in NAMES[2:]:
        assert np.isnan(getattr(found, name)), name
        assert np.isnan(found.uncertainty[name]), name
    assert tuple(map(str, found.notes)) == (
        f"K_1 and tau not given in 1 of 1 cases: {REASONS[reason]}",
    )


@pytest.mark.parametrize("rest", [np.nan, 6.4e4])
def test_storage_and_loss_stand_without_a_quasi_static_spring_constant(rest):
    found = identify_by_amplitude(
        **{**LOOP, "quasi_static_spring_constant": rest}, standard_uncertainty=UNCERTAINTY
    )
    for name in NAMES[:2]:
        assert np.isfinite(getattr(found, name)) and found.uncertainty[name] > 0
        assert found.shared_uncertainty[name] == 0


def test_one_bad_loop_does_not_touch_its_neighbours():
    found = identify_by_amplitude(
        **{**LOOP, "hysteresis_energy": [1.392, np.nan, -1.0, 1.392]},
        standard_uncertainty=UNCERTAINTY,
    )
    assert found.reason.tolist() == [0, 3, 4, 0]
    assert np.isfinite(found.relaxation_time).tolist() == [True, False, False, True]
    assert len(tuple(map(str, found.notes))) == 2


def test_no_reason_gives_no_words():
    assert refused_lines([0, 0]) == ()


def test_the_conditioning_is_how_a_change_of_k0_enters():
    before = identify_by_amplitude(**LOOP)
    after = identify_by_amplitude(**{**LOOP, "quasi_static_spring_constant": 2.014e4 * 1.000001})
    moved = after.angular_frequency_relaxation_time / before.angular_frequency_relaxation_time - 1
    assert moved / 1e-6 == pytest.approx(-before.conditioning, rel=1e-4)


def solve_apart(k_ap, energy, amplitude, frequency, rest):
    """The inversion as the equations stand, on its own."""
    lost = energy * k_ap**2 / (np.pi * amplitude**2)
    stored = (k_ap**2 - lost**2) ** 0.5
    excess = stored - rest
    turn = excess / lost
    spring = excess + lost**2 / excess
    time = turn / (2 * np.pi * frequency)
    return stored, lost, spring, time, spring * time


@pytest.mark.parametrize("rest", [2.014e4, 5.5e4])
@pytest.mark.parametrize("correlation", [0.0, 0.7])
def test_uncertainties_are_those_of_two_hundred_thousand_draws(rest, correlation):
    loop = {**LOOP, "quasi_static_spring_constant": rest}
    stated = {**UNCERTAINTY, "quasi_static_spring_constant": rest * 0.004}
    found = identify_by_amplitude(**loop, standard_uncertainty=stated, correlation=correlation)
    rng = np.random.default_rng(7)
    noise = rng.normal(size=(5, 200_000))
    noise[2] = correlation * noise[0] + np.sqrt(1 - correlation**2) * noise[2]
    centre = np.array(list(loop.values()))[:, None]
    size = np.array([stated[name] for name in loop])[:, None]
    loop_only = np.array([1, 1, 1, 1, 0])[:, None]
    whole = solve_apart(*(centre + size * noise))
    random = solve_apart(*(centre + size * noise * loop_only))
    shared = solve_apart(*(centre + size * noise * (1 - loop_only)))
    for row, name in enumerate(NAMES):
        assert found.uncertainty[name] == pytest.approx(whole[row].std(), rel=0.03), name
        assert found.random_uncertainty[name] == pytest.approx(random[row].std(), rel=0.03), name
        if row > 1:
            assert found.shared_uncertainty[name] == pytest.approx(shared[row].std(), rel=0.03)


def test_uncertainties_of_the_fundamental_are_those_of_draws():
    rng = np.random.default_rng(8)
    centre = np.array([2.7e4, 6e3, 0.3, 1.2e4])[:, None]
    size = np.array([100.0, 100.0, 3e-4, 300.0])[:, None]
    stored, lost, frequency, rest = centre + size * rng.normal(size=(4, 200_000))
    turn = (stored - rest) / lost
    spring, time = (stored - rest) * (1 + turn**-2), turn / (2 * np.pi * frequency)
    names = ("storage_spring_constant", "loss_spring_constant", "frequency",
             "quasi_static_spring_constant")  # fmt: skip
    found = identify_by_fundamental(
        **dict(zip(names, centre[:, 0], strict=True)),
        standard_uncertainty=dict(zip(names, size[:, 0], strict=True)),
    )
    for name, draws in zip(NAMES[2:], (spring, time, spring * time), strict=True):
        assert found.uncertainty[name] == pytest.approx(draws.std(), rel=0.03), name


def test_an_uncertainty_that_is_not_stated_is_not_zero():
    found = identify_by_amplitude(**LOOP)
    assert all(np.isnan(found.uncertainty[name]) for name in NAMES)
    stated = {name: value for name, value in UNCERTAINTY.items() if name != "frequency"}
    found = identify_by_amplitude(**LOOP, standard_uncertainty=stated)
    # K_1 does not feel the frequency, tau does
    assert found.uncertainty["dissipation_spring_constant"] > 0
    assert np.isnan(found.uncertainty["relaxation_time"])


def test_shapes_that_do_not_fit_are_refused():
    with pytest.raises(DataError, match="inputs of the line do not fit together; found apparent"):
        identify_by_amplitude(**{**LOOP, "frequency": [0.1, 0.2], "hysteresis_energy": [1, 2, 3]})


def test_arrays_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        identify_by_amplitude(**LOOP).relaxation_time[...] = 0


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


FREQUENCY = np.array([0.1, 0.1, 0.3, 0.3, 0.5, 0.5])


def test_exponent_and_uncertainty_are_those_of_a_regression():
    rng = np.random.default_rng(3)
    values = 4 * FREQUENCY**-0.6 * np.exp(rng.normal(0, 0.1, 6))
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values)
    other = stats.linregress(np.log(FREQUENCY), np.log(values))
    assert exponent == pytest.approx(other.slope)
    assert uncertainty == pytest.approx(other.stderr)
    assert left == 4


def test_groups_are_a_regression_with_one_intercept_each():
    rng = np.random.default_rng(4)
    group = np.array(["low", "high", "low", "high", "low", "high"])
    values = np.where(group == "low", 1.0, 20.0) * FREQUENCY**0.3 * np.exp(rng.normal(0, 0.1, 6))
    design = np.column_stack([group == "low", group == "high", np.log(FREQUENCY)]).astype(float)
    beta, rest, *_ = np.linalg.lstsq(design, np.log(values), rcond=None)
    covariance = rest[0] / 3 * np.linalg.inv(design.T @ design)
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values, group=group)
    assert (exponent, uncertainty) == pytest.approx((beta[2], np.sqrt(covariance[2, 2])))
    assert left == 3


def test_many_lines_at_once_are_each_alone_also_with_runs_missing():
    rng = np.random.default_rng(5)
    values = FREQUENCY**-1 * np.exp(rng.normal(0, 0.1, (4, 3, 6)))
    values[1, 2, 0] = np.nan
    values[0, 0, 5] = -1
    group = [1, 2, 1, 2, 1, 2]
    exponent, uncertainty, left = _power_of_frequency(FREQUENCY, values, group=group)
    assert exponent.shape == uncertainty.shape == left.shape == (4, 3)
    for index in np.ndindex(4, 3):
        kept = values[index] > 0
        one = _power_of_frequency(FREQUENCY[kept], values[index][kept], group=np.array(group)[kept])
        assert exponent[index] == pytest.approx(float(one[0]))
        assert uncertainty[index] == pytest.approx(float(one[1]))
        assert left[index] == one[2]


def test_one_relaxation_time_is_seen_as_one():
    rng = np.random.default_rng(6)
    check = check_single_time(
        FREQUENCY,
        2.0 * np.exp(rng.normal(0, 0.05, 6)),
        0.1 / FREQUENCY * np.exp(rng.normal(0, 0.05, 6)),
    )
    assert VERDICTS[int(check.verdict)].startswith("one relaxation time holds")
    assert check.exponent_low < 0 < check.exponent_high < 1
    assert check.loss_exponent_low < -1 < check.loss_exponent_high
    assert check.p_inverse_frequency < 0.001 < check.p_one_time


@pytest.mark.filterwarnings("error")
def test_relaxation_times_that_are_hardly_known_have_no_upper_ratio():
    tau = np.array([2.0, 1e-200, 2.0, 1e200, 2.0, 1e-200])
    check = check_single_time(FREQUENCY, tau, np.full(6, 0.1))
    assert check.time_ratio_high == np.inf
    assert VERDICTS[int(check.verdict)].startswith("not decided")


def test_a_constant_loss_angle_is_seen_as_one_over_frequency_by_way_of_the_inversion():
    # a rope whose loss angle stays 7 degrees while |K| grows a little with frequency
    rng = np.random.default_rng(7)
    modulus = 3.0e4 * (FREQUENCY / 0.3) ** 0.03
    delta = np.radians(7.0) * np.exp(rng.normal(0, 0.03, 6))
    line = identify_by_fundamental(
        storage_spring_constant=modulus * np.cos(delta),
        loss_spring_constant=modulus * np.sin(delta),
        frequency=FREQUENCY,
        quasi_static_spring_constant=1.2e4,
    )
    check = check_single_time(FREQUENCY, line.relaxation_time, np.tan(delta))
    assert VERDICTS[int(check.verdict)].startswith("the relaxation time follows 1/f")
    # A = |K| cos(7 deg) - K_0 grows from 16.81e3 to 18.24e3 N, so tau falls by 4.61 for 5
    assert check.time_ratio == pytest.approx(4.61, rel=0.05)
    assert check.frequency_ratio == pytest.approx(5)
    assert check.loss_exponent == pytest.approx(0, abs=0.05)


def test_a_line_of_three_parameters_passes_its_own_check():
    stored, lost = _storage_and_loss(
        quasi_static_spring_constant=1.2e4,
        dissipation_spring_constant=1.8e4,
        relaxation_time=2.0,
        frequency=FREQUENCY,
    )
    noisy = lost * (1 + 0.02 * np.array([1, -1, -1, 1, 1, -1]))
    line = identify_by_fundamental(
        storage_spring_constant=stored,
        loss_spring_constant=noisy,
        frequency=FREQUENCY,
        quasi_static_spring_constant=1.2e4,
    )
    check = check_single_time(FREQUENCY, line.relaxation_time, noisy / stored)
    assert check.verdict == 1
    assert check.exponent == pytest.approx(0, abs=0.03)


def test_something_between_is_neither():
    wobble = np.exp(0.02 * np.array([1, -1, -1, 1, 1, -1]))
    check = check_single_time(FREQUENCY, FREQUENCY**-0.5 * wobble, 0.1 * wobble)
    assert check.verdict == 3


def test_much_scatter_decides_nothing():
    wobble = np.exp(np.array([1.0, -1, -1, 1, 1, -1]))
    check = check_single_time(FREQUENCY, FREQUENCY**-0.5 * wobble, 0.1 * wobble)
    assert check.verdict == 0


def test_one_pair_of_frequencies_uses_the_stated_uncertainties():
    times = [10.0, 2.0]
    check = check_single_time([0.1, 0.5], times, [0.1, 0.1])
    assert check.verdict == 4 and np.isnan(check.exponent_standard_uncertainty)
    assert check.exponent == pytest.approx(1)
    stated = check_single_time(
        [0.1, 0.5], times, [0.1, 0.1], relative_standard_uncertainty=[0.03, 0.04]
    )
    assert stated.degrees_of_freedom == 0
    assert stated.exponent_standard_uncertainty == pytest.approx(0.05 / np.log(5))
    width = stats.norm.ppf(0.975) * 0.05 / np.log(5)
    assert stated.exponent_high - stated.exponent_low == pytest.approx(2 * width)
    assert stated.verdict == 2


def test_one_frequency_decides_nothing():
    check = check_single_time([0.3, 0.3, 0.3], [2.0, 2.1, 1.9], [0.1, 0.1, 0.1])
    assert check.verdict == 4 and np.isnan(check.exponent)


def test_a_line_without_any_time_decides_nothing():
    check = check_single_time(FREQUENCY, np.full((2, 6), np.nan), np.full((2, 6), 0.1))
    assert check.verdict.tolist() == [4, 4]


def test_the_tolerance_is_what_a_line_may_miss():
    wobble = np.exp(0.002 * np.array([1, -1, -1, 1, 1, -1]))
    times = FREQUENCY**-0.95 * wobble
    assert check_single_time(FREQUENCY, times, wobble).verdict == 2
    assert check_single_time(FREQUENCY, FREQUENCY**-0.85 * wobble, wobble).verdict == 3


REFUSED = {
    "an uncertainty of nothing is refused": (
        lambda: identify_by_amplitude(**LOOP, standard_uncertainty={"strain": 0.1}),
        DataError,
        "the line has no input 'strain'; needed one of apparent",
    ),
    "shapes that differ are refused": (
        lambda: line_sensitivities([1.0, 2.0], 1.0, 0.5),
        DataError,
        "series do not pair up",
    ),
    "a frequency is positive": (
        lambda: _power_of_frequency([0.1, -0.2], [1.0, 2.0]),
        DataError,
        "frequency are not positive",
    ),
}


test_refusals = refusals(REFUSED)
