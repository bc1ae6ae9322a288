"""None"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import Contributions, InstrumentErrors
from reduction.record.errors import DataError
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.cycles.loops import close_loops
from reduction.stages.moduli.secant_modulus import mean_frequency, summarise_amplitude
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_model import (
    _storage_and_loss,
    apparent_spring_constant,
)
from reduction.stages.three_parameter_line.line_of_loops import identify_cycles, identify_run
from reduction.stages.three_parameter_line.loop_midline import (
    chord_of_spring,
    spring_of_cycle,
    spring_of_wave,
    tension_above_midline,
)
from reduction.uncertainty.errors_of_cycles import errors_of_line
from reduction.uncertainty.propagation import LoopQuantities, loop_contributions

REST, SPRING, TIME, FREQUENCY = 1.2e4, 1.8e4, 2.0, 0.3
LINE = {
    "quasi_static_spring_constant": REST,
    "dissipation_spring_constant": SPRING,
    "relaxation_time": TIME,
}
NAMES = (
    "storage_spring_constant", "loss_spring_constant", "dissipation_spring_constant",
    "relaxation_time", "dashpot_coefficient",
)  # fmt: skip


def series(n_cycles, per_cycle=100, noise=0.0, seed=0, waveform="sinusoidal", amplitude=0.02):
    """Tension and strain of the line in a steady motion, by its harmonics."""
    turn = np.arange(n_cycles * per_cycle + 1) / per_cycle
    orders = (1,) if waveform == "sinusoidal" else range(1, 40, 2)
    strain, tension = 0.1, 2000.0
    for order in orders:
        size = amplitude * (1 if waveform == "sinusoidal" else 8 / np.pi**2 / order**2)
        stored, lost = _storage_and_loss(frequency=order * FREQUENCY, **LINE)
        angle = 2 * np.pi * order * turn
        strain = strain - size * np.cos(angle)
        tension = tension - size * (stored * np.cos(angle) - lost * np.sin(angle))
    rng = np.random.default_rng(seed)
    tension = tension + noise * np.ptp(tension) * rng.normal(size=turn.size)
    strain = strain + noise * np.ptp(strain) * rng.normal(size=turn.size)
    return turn / FREQUENCY, tension, strain


def loops_of(time, tension, strain, per_cycle=100, waveform="sinusoidal"):
    n_cycles = (time.size - 1) // per_cycle
    first = np.arange(n_cycles) * per_cycle
    half, last = first + per_cycle // 2, first + per_cycle
    cycles = Cycles(
        first, last, np.column_stack([first, half]), np.column_stack([half, last]),
        np.ones((n_cycles, 2)), np.zeros(time.size, np.int32), np.zeros(time.size, np.int8),
        np.zeros(time.size, bool), 0.01,
    )  # fmt: skip
    return close_loops(
        time, np.atleast_2d(tension), np.atleast_2d(strain), cycles, waveform=waveform
    )


K0 = {"quasi_static_spring_constant": [REST], "quasi_static_standard_uncertainty": [200.0]}


@pytest.mark.parametrize("reading", ["amplitude", "fundamental"])
def test_a_line_comes_back_from_its_loops(reading):
    line = identify_cycles(loops_of(*series(6)), **K0, reading=reading)
    assert line.relaxation_time.shape == (1, 6) and tuple(map(str, line.notes)) == ()
    assert line.dissipation_spring_constant == pytest.approx(np.full((1, 6), SPRING), rel=1e-3)
    assert line.relaxation_time == pytest.approx(np.full((1, 6), TIME), rel=1e-3)


def test_triangular_cycles_need_the_fundamental_and_the_note_says_so():
    loops = loops_of(*series(6, waveform="triangular"), waveform="triangular")
    by_fundamental = identify_run(loops.over_time(100), **K0, reading="fundamental")
    assert by_fundamental.relaxation_time == pytest.approx([TIME], rel=2e-3)
    assert tuple(map(str, by_fundamental.notes)) == ()
    # it misses no corner: what the corners of these 100 readings may hide is none of it
    stored, _ = _storage_and_loss(frequency=FREQUENCY, **LINE)
    missed = loops.over_time(100).shared_by_cycles(slice(None))["storage_spring_constant"][0]
    assert abs(loops.storage_over_time.mean() - stored) < 3 * missed < 1e-3 * stored
    by_amplitude = identify_run(loops, **K0)
    # E'' by area and amplitudes is about (8/pi^2)^2 of the true one
    assert by_amplitude.relaxation_time[0] > 1.3 * TIME
    (note,) = map(str, by_amplitude.notes)
    assert note.startswith("the loops are not elliptical: E'' from loop area is 0.6")


def test_losses_of_the_break_in_say_nothing_of_the_ellipses_of_a_run():
    time, tension, strain = series(6)
    loops = loops_of(time, tension, strain)
    lost = loops.loss_over_time.copy()
    lost[:, :2] *= 2.5  # a slow part of the rope that relaxes in the first two cycles
    settling = replace(loops, loss_over_time=lost)
    assert tuple(map(str, identify_run(settling, **K0, break_in_cycles=2).notes)) == ()
    assert "not elliptical" in str(identify_run(settling, **K0).notes[0])


def test_the_random_part_is_the_scatter_of_the_cycles():
    loops = loops_of(*series(800, noise=0.002, seed=1))
    line = identify_cycles(loops, **K0, reading="fundamental")
    # the cycles here begin at a sample each; a log's do not, and the stated period knows
    period = float(np.mean(loops.uncertainty["frequency"] / loops.frequency))
    for name, feels in zip(NAMES, (0, 0, 0, 1, 1), strict=True):
        values = getattr(line, name)
        stated = np.sqrt(np.mean(line.random_uncertainty[name] ** 2))
        scatter = np.hypot(values.std(ddof=1), feels * period * values.mean())
        assert stated == pytest.approx(scatter, rel=0.15), name


def test_the_random_part_by_amplitudes_covers_the_scatter_of_the_cycles():
    # amplitudes are stated with a turn missed at constant rate, which a sine does not have
    loops = loops_of(*series(800, noise=0.002, seed=1))
    line = identify_cycles(loops, **K0)
    for name in NAMES:
        stated = np.sqrt(np.mean(line.random_uncertainty[name] ** 2))
        scatter = getattr(line, name).std(ddof=1)
        assert scatter < 1.2 * stated and stated < 3.5 * scatter, name


@pytest.mark.parametrize("reading", ["amplitude", "fundamental"])
def test_the_random_part_of_a_run_is_the_scatter_of_runs(reading):
    runs = [
        identify_run(loops_of(*series(20, noise=0.002, seed=seed)), **K0, reading=reading)
        for seed in range(60)
    ]
    for name in NAMES:
        values = np.array([getattr(line, name)[0] for line in runs])
        stated = np.sqrt(np.mean([line.random_uncertainty[name][0] ** 2 for line in runs]))
        scatter = values.std(ddof=1)
        # what the turns may miss is in K' of the fundamental too, which has none, and in what is
        # computed from it
        most = 1.25 if reading == "amplitude" else 1.5
        assert 0.75 * scatter < stated < most * scatter, name


@pytest.mark.parametrize("at_a_turn", [False, True], ids=["evenly", "at a turn"])
@pytest.mark.parametrize("reading", ["amplitude", "fundamental"])
def test_creep_may_take_place_anywhere_in_the_cycle(reading, at_a_turn):
    time, tension, strain = series(20)
    turn = time * FREQUENCY
    loops = loops_of(time, tension, strain + 4e-4 * (np.floor(turn) if at_a_turn else turn))
    line = identify_run(loops, **K0, reading=reading)
    summary = summarise_amplitude(loops, area=[1e-4])
    (share,) = loops.drift_not_placed()
    model = StrainModel("line", "gauge-length", {"reference_position": 0.0, "gauge_length": 1.0})
    of_loop = loop_contributions(
        InstrumentErrors("line", drift_not_placed=share), model,
        LoopQuantities(*(getattr(summary, name)[0] for name in LoopQuantities._fields)),
        waveform="sinusoidal",
    )  # fmt: skip
    no_rest = Contributions((), {"quasi_static_spring_constant": np.empty((0,))})
    of_line = errors_of_line(line, summary, 0, of_loop, no_rest)
    stored, lost = _storage_and_loss(frequency=FREQUENCY, **LINE)
    for found, of, name, true in (
        (line, of_loop, "loss_spring_constant", lost),
        (summary, of_loop, "loss_factor", lost / stored),
        (line, of_line, "dissipation_spring_constant", SPRING),
        (line, of_line, "relaxation_time", TIME),
    ):
        error = getattr(found, name)[0] - true
        # all of it at one turn is the root of six: the end of a triangular distribution
        assert abs(error) < 2.6 * of.shared_standard_uncertainty(name), name


def test_noise_of_many_smooth_cycles_is_no_kink():
    loops = loops_of(*series(800, noise=0.002, seed=1))
    scatter = loops.hysteresis_energy.std() / np.sqrt(800)
    assert loops.energy_turn_missed.max() < 2 * scatter


def test_more_cycles_make_the_random_part_smaller_and_the_shared_part_not():
    short, long = (
        identify_run(loops_of(*series(n, noise=0.002, seed=2)), **K0) for n in (10, 1000)
    )
    name = "dissipation_spring_constant"
    assert long.random_uncertainty[name][0] < 0.25 * short.random_uncertainty[name][0]
    assert long.shared_uncertainty[name] == pytest.approx(short.shared_uncertainty[name], rel=0.02)
    # d ln K_1/d ln K_0 by a difference of two inversions
    other = identify_run(
        loops_of(*series(1000, noise=0.002, seed=2)),
        quasi_static_spring_constant=[REST + 1.0],
        quasi_static_standard_uncertainty=[200.0],
    )
    slope = other.dissipation_spring_constant - long.dissipation_spring_constant
    assert long.shared_uncertainty[name] == pytest.approx(np.abs(slope) * 200.0, rel=1e-3)
    assert long.uncertainty[name] == pytest.approx(
        np.hypot(long.random_uncertainty[name], long.shared_uncertainty[name])
    )


def test_break_in_cycles_are_left_out_of_a_run():
    time, tension, strain = series(10)
    tension = tension.copy()
    tension[:300] *= 1.2
    loops = loops_of(time, tension, strain)
    assert identify_run(loops, **K0, break_in_cycles=4).relaxation_time == pytest.approx(
        [TIME], rel=1e-3
    )


def test_a_run_of_two_cycles_has_no_random_part():
    line = identify_run(loops_of(*series(2)), **K0)
    assert np.isnan(line.random_uncertainty["relaxation_time"][0])
    assert line.shared_uncertainty["relaxation_time"][0] > 0


def test_a_missing_cycle_does_not_spoil_the_run():
    time, tension, strain = series(6)
    tension = tension.copy()
    tension[210:290] = np.nan
    loops = loops_of(time, tension, strain)
    assert identify_cycles(loops, **K0).reason.tolist() == [[0, 0, 3, 0, 0, 0]]
    assert identify_run(loops, **K0).relaxation_time == pytest.approx([TIME], rel=2e-3)


def test_a_specimen_without_a_pull_has_no_parameters_and_the_other_has():
    time, tension, strain = series(5)
    loops = loops_of(time, [tension, tension], [strain, strain])
    rest = {
        "quasi_static_spring_constant": [REST, np.nan],
        "quasi_static_standard_uncertainty": [200.0, np.nan],
    }
    line = identify_cycles(loops, **rest)
    assert line.reason.tolist() == [[0] * 5, [1] * 5]
    assert "not given in 5 of 10 cases: the quasi-static spring constant" in str(line.notes[0])
    assert identify_run(loops, **rest).reason.tolist() == [0, 1]


def test_a_spring_constant_of_each_cycle_is_taken_too():
    loops = loops_of(*series(3))
    line = identify_cycles(
        loops,
        quasi_static_spring_constant=np.full((1, 3), REST),
        quasi_static_standard_uncertainty=np.full((1, 3), 1.0),
    )
    assert line.relaxation_time == pytest.approx(np.full((1, 3), TIME), rel=1e-3)


def test_a_slack_line_is_noted():
    time, tension, strain = series(4)
    loops = loops_of(time, np.maximum(tension - 1600, 0), strain)
    notes = tuple(map(str, identify_cycles(loops, **K0).notes))
    assert any("does not apply to 4 of 4 loops" in note for note in notes)


def test_an_uncertain_rest_spring_is_noted():
    rest = REST * 2.2
    stored, _ = _storage_and_loss(frequency=FREQUENCY, **LINE)
    assert rest < stored < apparent_spring_constant(frequency=FREQUENCY, **LINE)
    line = identify_cycles(
        loops_of(*series(4)),
        quasi_static_spring_constant=[rest],
        quasi_static_standard_uncertainty=[0.1 * rest],
    )
    assert any("uncertainty of K_0 exceeds 30 % of K_1" in note for note in map(str, line.notes))


def test_a_spring_constant_that_does_not_fit_is_refused():
    with pytest.raises(DataError, match="does not fit the loops"):
        identify_cycles(
            loops_of(*series(3)),
            quasi_static_spring_constant=[1.0, 2.0],
            quasi_static_standard_uncertainty=[1.0, 2.0],
        )


def test_a_break_in_of_all_cycles_is_refused():
    with pytest.raises(DataError, match="the break-in leaves no cycle; found 3 of 3 cycles"):
        identify_run(loops_of(*series(3)), **K0, break_in_cycles=3)


def test_loops_of_nothing_give_reasons_only():
    shape = (1, 3)
    fields = {
        name: np.full(shape, np.nan) for name in Loops.__dataclass_fields__ if name != "uncertainty"
    }
    loops = Loops(**fields, uncertainty={name: np.full(shape, np.nan) for name in fields})
    assert identify_cycles(loops, **K0).reason.tolist() == [[3, 3, 3]]
    assert identify_run(loops, **K0).reason.tolist() == [3]


def test_the_frequency_of_slow_and_fast_cycles_is_their_number_over_their_time():
    period = np.repeat([40.0, 4.0], [30, 60])
    loops = SimpleNamespace(
        frequency=1 / period[None],
        cycle_start_time=np.cumsum(period)[None],
        uncertainty={"frequency": 0.02 / period[None] ** 2},  # of a turn, in all alike
        **{name: np.ones((1, 90)) for name in (
            "strain_amplitude", "tension_amplitude", "storage_over_time", "loss_over_time",
        )},
    )  # fmt: skip
    (mean,), _ = mean_frequency(loops, slice(None))
    assert mean == pytest.approx(90 / (30 * 40 + 60 * 4))


@pytest.mark.parametrize("cycles_to_settle", [2.0, 4.0, 8.0])
def test_the_interval_of_a_frequency_includes_that_to_which_a_searching_machine_settles(
    cycles_to_settle,
):
    """Phase of the wave against its command: 0.05 rad that dies out over some of 40 cycles."""
    at = np.arange(41.0)
    turn = (at + 0.05 / (2 * np.pi) * (1 - np.exp(-at / cycles_to_settle))) / FREQUENCY
    period = np.diff(turn)
    same = {name: np.ones((1, 40)) for name in (
        "strain_amplitude", "tension_amplitude", "storage_over_time", "loss_over_time",
    )}  # fmt: skip
    loops = SimpleNamespace(
        frequency=1 / period[None],
        cycle_start_time=turn[None, :-1],
        uncertainty={"frequency": np.full((1, 40), 1e-6)},
        **same,
    )
    (mean,), (spread,) = mean_frequency(loops, slice(None))
    assert mean == pytest.approx(40 / (turn[-1] - turn[0]))
    assert 0.5 * spread < abs(mean - FREQUENCY) < 2 * spread
    (late,), (spread,) = mean_frequency(loops, np.arange(40)[-10:])
    assert abs(late - 10 / (turn[-1] - turn[-11])) < 1e-12


# the midline of a loop at its mean strain, of loops whose spring is known

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
