import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.three_parameter_line.line_model import (
    _storage_and_loss,
    apparent_spring_constant,
    hysteresis_energy,
    identify_by_amplitude,
    identify_by_fundamental,
    refused_lines,
)
from reduction.stages.three_parameter_line.line_product import REASONS

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


def test_an_uncertainty_of_nothing_is_refused():
    with pytest.raises(DataError, match="the line has no input 'strain'; needed one of apparent"):
        identify_by_amplitude(**LOOP, standard_uncertainty={"strain": 0.1})


def test_arrays_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        identify_by_amplitude(**LOOP).relaxation_time[...] = 0
