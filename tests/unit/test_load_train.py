"""What a load cell and a crosshead's scale see beside the specimen."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.linalg import solve_banded

from reduction.pipeline.located_test import locate
from reduction.readers.layout import Channel, Layout
from reduction.record.contributions import InstrumentErrors
from reduction.record.errors import DataError
from reduction.record.measurement import LoadTrain, Record, Specimen
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.load_train import acceleration, end_mass, turn_acceleration
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.effects_on_answers import _sag, _wave_left
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.errors_of_cycles import inertia_of

SETTINGS = ReductionSettings(cycles=CycleSettings(waveform="sinusoidal"))


def test_a_chain_of_masses_and_springs_is_felt_as_a_third_and_a_sixth():
    # end moved by x = cos(w t), far below resonance: forces of the springs against their mean
    n, mass, stiffness, turn = 400, 1.2, 500.0, 0.2
    spring, lump = stiffness * n, mass / n
    matrix = np.diag(np.full(n - 1, 2 * spring - lump * turn**2))
    matrix -= np.diag(np.full(n - 2, spring), 1) + np.diag(np.full(n - 2, spring), -1)
    pushed = np.zeros(n - 1)
    pushed[-1] = spring
    place = np.concatenate(([0.0], np.linalg.solve(matrix, pushed), [1.0]))
    force = spring * np.diff(place)
    felt = (force[-1] - lump / 2 * turn**2, force[0])
    for cell, one in zip(("moving", "fixed"), felt, strict=True):
        counted, _ = end_mass(LoadTrain(cell, 0.0), linear_density=mass, slack_length=1.0)
        assert (one - force.mean()) / -(turn**2) == pytest.approx(counted, rel=0.01)


def test_noise_of_the_position_is_not_amplified_beyond_what_is_said():
    generator = np.random.default_rng(1)
    time, half = np.arange(4000) / 100, 0.25
    noise = generator.normal(0, 1e-4, time.size)
    found = acceleration(time, noise, half_width=half)[100:-100]
    assert np.std(found) == pytest.approx(52 * 1e-4 / half**2 / np.sqrt(51), rel=0.1)


def test_uneven_times_and_missing_samples_leave_a_sine_what_it_is():
    generator = np.random.default_rng(2)
    time = np.arange(600) / 64 + generator.uniform(-0.3, 0.3, 600) / 64
    position = np.cos(2 * np.pi * time)
    seen = position.copy()
    seen[generator.integers(100, 500, 20)] = np.nan
    found = acceleration(time, seen, half_width=0.25)
    inside = slice(40, -40)
    assert np.allclose(found[inside], -((2 * np.pi) ** 2) * position[inside], atol=0.02 * 39.5)


def test_rounded_times_leave_the_narrowest_window_all_its_samples():
    time = np.round(np.arange(600) * 0.0053721, 5)  # an even clock, written to 10 microseconds
    position = np.cos(2 * np.pi * time)
    found = acceleration(time, position, half_width=4 * 0.0053721)[10:-10]
    assert np.allclose(found, -((2 * np.pi) ** 2) * position[10:-10], atol=0.002 * 39.5)


def logged(train, *, mass=0.0, compliance=0.0, rate=64, n_cycles=12):
    """Ten newton a centimetre, 1 Hz, 0.2 m about 0.5 m, with a rest before."""
    time = np.arange(-5 * rate, n_cycles * rate + 1) / rate
    length = np.where(time < 0, 2.0, 2.5 - 0.2 * np.cos(2 * np.pi * time))
    ease = (time > -2) & (time < 0)
    length[ease] = 2.15 - 0.15 * np.cos(np.pi * (time[ease] + 2) / 2)
    tension = 1000 * (length - 2.0)
    bend = np.where(time >= 0, 0.2 * (2 * np.pi) ** 2 * np.cos(2 * np.pi * time), 0.0)
    record = Record(
        "R-1", ("rope",), time, length + compliance * tension, (tension + mass * bend)[None],
        np.zeros((1, time.size), np.uint16), np.zeros(time.size, np.uint16), load_train=train,
    )  # fmt: skip
    return record, length, tension


@pytest.mark.parametrize(
    ("train", "linear_density", "mass", "compliance"),
    [
        (LoadTrain("moving", 5.0), None, 5.0, 0.0),
        (LoadTrain("moving", 5.0, 1e-5), None, 5.0, 1e-5),
        (LoadTrain("moving", 5.0), 0.6, 5.4, 0.0),
        (LoadTrain("fixed", 5.0), None, 0.0, 0.0),
        (LoadTrain("fixed", 5.0), 0.6, -0.2, 0.0),
        (LoadTrain(machine_compliance=1e-5), None, 0.0, 1e-5),
        (LoadTrain(), 0.6, 0.0, 0.0),
    ],
)
def test_tension_and_length_of_the_specimen_come_back(train, linear_density, mass, compliance):
    record, length, tension = logged(train, mass=mass, compliance=compliance)
    rope = Specimen("rope", "rope", linear_density=linear_density)
    found = locate(record, kind="cyclic", settings=SETTINGS, specimens=(rope,))
    assert found.cycles.n_cycles >= 11
    # the first cycle begins where the acceleration of the approach ends: between two readings
    inside = found.cycles.cycle_number > 1
    assert np.abs(found.tension[0] - tension)[inside].max() < 0.002 * (400 + mass * 8)
    assert np.abs(found.position - length)[inside].max() < 1e-5
    assert np.array_equal(found.record.tension, found.tension)


def test_a_log_that_is_too_sparse_for_acceleration_is_refused():
    record, _, _ = logged(LoadTrain("moving", 5.0), mass=5.0, rate=12, n_cycles=40)
    with pytest.raises(DataError, match="too few samples for the acceleration"):
        locate(record, kind="cyclic", settings=SETTINGS, specimens=(Specimen("rope", "rope"),))


def layout(**keys):
    return Layout(format="delimited", channels={"time": Channel(column="t", unit="s")}, **keys)


def test_a_layout_states_its_load_train_in_any_unit():
    stated = layout(load_cell_at="moving", attached_mass="5000 g", machine_compliance="2e-4 mm/N")
    assert stated.load_train == LoadTrain("moving", 5.0, pytest.approx(2e-7))


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"attached_mass": "5 kg"}, "does not say where the load cell is"),
        ({"load_cell_at": "moving", "attached_mass": "-5 kg"}, "attached_mass of a layout is neg"),
        ({"machine_compliance": "-1e-7 m/N"}, "machine_compliance of a layout is negative"),
        ({"machine_compliance": "1e-7 N/m"}, "N/m"),
    ],
)
def test_what_is_no_load_train_is_refused(keys, message):
    with pytest.raises(ValidationError, match=message):
        layout(**keys)


def turning(*, period=1.0, turn=0.05, amplitude=0.1, step=0.005, n_cycles=12):
    """Straight ramps joined by parabolas that last so long; valleys at whole periods."""
    t = np.arange(round(n_cycles * period / step) + 1) * step
    rate = 2 * amplitude / (period / 2 - turn / 2)
    away = (t + period / 4) % period - period / 4  # from the nearest valley behind
    x = np.zeros(t.shape)
    for centre, way in ((0.0, 1.0), (period / 2, -1.0)):
        here = np.abs(away - centre) <= period / 4
        near = np.abs(away[here] - centre)
        rise = np.where(near < turn / 2, near**2 * rate / turn, (near - turn / 4) * rate)
        x[here] = -way * amplitude + way * rise
    first = np.round(np.arange(n_cycles) * period / step).astype(int)
    half = round(period / 2 / step)
    branch = np.stack([first, first + half], axis=1)
    none = np.zeros(t.size, int)
    cycles = Cycles(
        first, first + 2 * half, branch, branch + half, np.full((n_cycles, 2), rate), none,
        none, none > 0, 0.01,
    )  # fmt: skip
    return t, x, cycles, 2 * rate / turn


def test_a_turn_between_ramps_has_twice_the_rate_over_its_duration():
    t, x, cycles, want = turning()
    assert turn_acceleration(t, x, cycles) == pytest.approx(want, rel=0.01)
    noise = np.random.default_rng(1).normal(0.0, 2e-5, t.size)
    assert turn_acceleration(t, x + noise, cycles) == pytest.approx(want, rel=0.15)


def test_two_readings_at_one_time_have_no_acceleration():
    t, x, cycles, want = turning()
    t[cycles.first + 1] = t[cycles.first]
    assert turn_acceleration(t, x, cycles) < 2 * want


def test_noise_alone_is_no_acceleration():
    t, _, cycles, _ = turning()
    noise = np.random.default_rng(2).normal(0.0, 1e-3, t.size)
    assert turn_acceleration(t, noise, cycles) < 2e-3 / 0.005**2


def test_a_window_longer_than_the_turn_leaves_inertia_and_of_a_sine_none():
    t, x, cycles, want = turning()
    found = acceleration(t, x, half_width=0.15)
    left = turn_acceleration(t, x, cycles, found=found)
    around = np.abs(t - 5.0) < 0.05
    true = np.where(np.abs(t - 5.0) < 0.025, want, 0.0)
    assert left == pytest.approx(np.abs(true - found)[around].max(), rel=0.3)
    wave = -0.1 * np.cos(2 * np.pi * t)
    found = acceleration(t, wave, half_width=0.15)
    assert turn_acceleration(t, wave, cycles, found=found) < 0.01 * 0.1 * (2 * np.pi) ** 2


@pytest.mark.parametrize("is_moving", [True, False])
@pytest.mark.parametrize("angle", [0.5, 1.2, 2.0])
def test_what_the_mass_of_a_line_leaves_is_that_of_a_chain_of_many_masses(angle, is_moving):
    n = 2000  # springs of stiffness n between masses of 1/n: a line of unit stiffness and mass
    diagonal = np.full(n - 1, 2.0 * n - angle**2 / n)
    beside = np.full(n - 2, -float(n))
    force = np.zeros(n - 1)
    force[-1] = n
    banded = np.stack([np.append(0.0, beside), diagonal, np.append(beside, 0.0)])
    place = np.concatenate([[0.0], solve_banded((1, 1), banded, force), [1.0]])
    tension = n * np.diff(place)
    assert tension.mean() == pytest.approx(1.0)
    taken_off = angle**2 * (1 / 3 if is_moving else -1 / 6)
    felt = tension[-1] - angle**2 / (2 * n) if is_moving else tension[0]
    assert _wave_left(angle, is_moving=is_moving) == pytest.approx(
        felt + taken_off - 1, abs=2e-3 * max(angle, 1.0)
    )


def test_a_corner_between_two_readings_has_no_acceleration_that_a_log_resolves():
    t = np.arange(4 * 64 + 1) / 64
    first = np.arange(0, 256, 64)
    branch = np.stack([first, first + 32], axis=1)
    none = np.zeros(t.size)
    cycles = Cycles(
        first, first + 64, branch, branch + 32, np.ones((4, 2)), none.astype(int),
        none.astype(int), none > 0, 0.01,
    )  # fmt: skip
    corner, sine = np.abs(2 * (t % 1) - 1), 0.5 * np.cos(2 * np.pi * t)
    ratio = [
        turn_acceleration(t, x, cycles) / turn_acceleration(t, x, cycles, finest=2)
        for x in (corner, sine)
    ]
    # 2 v / h over h at a corner, and a smooth second derivative over any h
    assert ratio[0] == pytest.approx(2, rel=1e-6)
    assert ratio[1] == pytest.approx(1, rel=0.01)


def test_of_an_extensometer_the_crosshead_tells_how_far_the_mass_moves():
    # 3 m from pin to pin, 0.02 of strain to either side at 1.5 Hz; 0.5 kg of doubt
    length, amplitude, frequency, spread = 3.0, 0.02, 1.5, 0.5
    time = np.arange(0, 4, 1 / 240)
    strain = 0.05 - amplitude * np.cos(2 * np.pi * frequency * time)
    turns = np.arange(0, time.size - 160, 160)
    branch = np.stack([turns, turns + 80], axis=1)
    none = np.zeros(time.size, dtype=int)
    cycles = Cycles(
        turns, turns + 160, branch, branch + 80, np.ones(branch.shape), none, none, none > 0, 0.01
    )
    record = Record(
        "R", ("line",), time, length * (1 + strain), np.zeros((1, time.size)),
        np.zeros((1, time.size), np.uint16), np.zeros(time.size, np.uint16),
        load_train=LoadTrain("moving", 8.0, end_mass=(8.0,), end_mass_by_density=(0.0,)),
    )  # fmt: skip
    level = {"mean_strain": [0.05], "mean_tension": [1e4], "frequency": [frequency]}
    loops = SimpleNamespace(
        strain_amplitude=np.array([amplitude]),
        **{name: np.array(value) for name, value in level.items()},
    )
    errors = replace(InstrumentErrors("line"), attached_mass=spread)
    model = StrainModel("line", "extensometer", {})
    inertia = inertia_of(record, loops, 0, errors, model, cycles)
    at = np.array([0.05 - amplitude, 0.05, 0.05 + amplitude])
    field = error_field(errors, model, strain=at, tension=np.full(3, 1e4), inertia=inertia)
    force = spread * length * amplitude * (2 * np.pi * frequency) ** 2
    np.testing.assert_allclose(field.tension[0], [-force, 0, force], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("density", "strength", "spread", "severity"),
    [(8.0, 1e6, 1e-3, "warning"), (None, 8 / 2.2e-6, 1e-3, "warning"), (8.0, 1e6, 0.5, None),
     (0.5, None, 1e-4, "note"), (None, None, 1e-3, None)],
)  # fmt: skip
def test_the_sag_of_a_horizontal_rope_is_that_of_a_catenary(density, strength, spread, severity):
    # an inextensible chain between ends at one height: chord 2 a asinh(S / 2 a), a = H / w
    length, low, high, own = 50.0, 2e4, 8e4, 2e-3  # strain amplitude of the rope itself
    a = np.array([low, high]) / (9.80665 * (density or 8.0))
    chord = 2 * a * np.arcsinh(length / (2 * a))
    taken_out = float(np.diff(chord)[0]) / length
    seen = own + taken_out / 2
    test = SimpleNamespace(
        specimens=[Specimen("line", kind="rope", linear_density=density,
                            rated_break_strength=strength)]
    )  # fmt: skip
    summary = SimpleNamespace(
        mean_tension=np.array([(low + high) / 2]), tension_amplitude=np.array([(high - low) / 2]),
        strain_amplitude=np.array([seen]),
    )  # fmt: skip
    found = list(_sag(test, summary, 0, length, spread))
    assert [one.severity for one in found] == ([] if severity is None else [severity])
    for one in found:
        assert one.numbers["effect"] == pytest.approx(own / seen - 1, rel=0.01)


def test_a_sag_of_more_than_the_stroke_was_not_there():
    # 2 m of a rope of 0.11 kg/m, unloaded to a tenth of a newton: it hung, or was supported
    test = SimpleNamespace(specimens=[Specimen("line", kind="rope", linear_density=0.11)])
    summary = SimpleNamespace(
        mean_tension=np.array([1000.1]), tension_amplitude=np.array([1000.0]),
        strain_amplitude=np.array([0.03]),
    )  # fmt: skip
    assert list(_sag(test, summary, 0, 2.0, 1e-3)) == []
