"""K_0 of cycles whose loops are as bent as the slow pull, in look-up and export."""

from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from export_sources import LEVELS, REST, SPRING, TIME, loop, source, surface

from reduction.lines.archive_source import (
    _are_other_waves,
    _as_sine,
    _cycle_of_level,
    _sine_over_wave,
    _with_bend,
)
from reduction.lines.bent_loops import (
    RunOfLine,
    chord_over_slope,
    with_bend_of_levels,
    with_bend_of_runs,
)
from reduction.lines.export_dynamics import line_dynamics
from reduction.lines.line_consistency import consistent_values
from reduction.lines.lookup_product import LineCurve, LineLevels
from reduction.record.errors import ArchiveError

BEND, START = 20.0, 1000.0
"""Of T = START (exp(BEND e) - 1), with K_0 = BEND (T + START)."""

MEAN, AMPLITUDE = LEVELS["mean_tension"], LEVELS["tension_amplitude"]


def pull(constant, **changed):
    """Slow pull of a line whose K_0 is BEND (T + constant), in points."""
    at = np.linspace(0.0, 6000.0, 601)
    return LineCurve(
        "quasi_static_spring_constant", "mean_tension", 0.0, 6000.0, at=at,
        value=BEND * (at + constant), **changed,
    )  # fmt: skip


def closed_form(half_strain):
    """Ends at +-a about e: mean B cosh - START, chord B sinh / a, slope at the mean B k cosh."""
    turned = BEND * half_strain
    return np.tanh(turned) / turned


def half_strain(load, stiffness, energy):
    return load / stiffness * np.sqrt(1 - (energy * stiffness / (np.pi * load**2)) ** 2)


def runs(share):
    """Cycles of 4 to 20 percent loss, K_0 by a share of the way from slope to chord."""
    rng = np.random.default_rng(2)
    mean, load = rng.uniform(1500, 3000, 12), rng.uniform(200, 900, 12)
    stiffness = 1.3 * BEND * (mean + START)
    energy = rng.uniform(0.04, 0.2, 12) * np.pi * load**2 / stiffness
    ratio = 1 + share * (closed_form(half_strain(load, stiffness, energy)) - 1)
    own = ratio * BEND * (mean + START)
    return [RunOfLine(*row) for row in zip(mean, load, stiffness, energy, own, strict=True)]


def test_the_chord_of_an_exponential_pull():
    table = np.array(runs(1.0))
    found = chord_over_slope(
        pull(START), mean_tension=table[:, 0], tension_amplitude=table[:, 1],
        apparent_spring_constant=table[:, 2], hysteresis_energy=table[:, 3],
    )  # fmt: skip
    expected = table[:, 4] / (BEND * (table[:, 0] + START))
    assert expected.min() < 0.99
    assert found == pytest.approx(expected, abs=2e-4)


def test_a_cycle_beyond_the_pull_keeps_the_slope():
    found = chord_over_slope(
        replace(pull(START), high=2300.0), mean_tension=2000.0, tension_amplitude=700.0,
        apparent_spring_constant=7e4, hysteresis_energy=1.0,
    )  # fmt: skip
    assert found == 1.0


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_runs_say_how_bent_the_loops_are(share):
    found = with_bend_of_runs(pull(START), runs(share))
    assert found.loop_bend == pytest.approx(share, abs=0.01)
    assert found.loop_bend_misfit < 2e-4


def test_two_runs_and_a_straight_pull_say_nothing():
    assert with_bend_of_runs(pull(START), runs(1.0)[:2]).loop_bend == 0
    flat = replace(pull(START), value=np.full(601, 6e4))
    assert with_bend_of_runs(flat, runs(1.0)).loop_bend == 0


def test_the_runs_of_an_experiment_are_read_from_their_archives(tmp_path):
    """One that has no K_0, one that cannot be read, and one of another experiment say nothing."""
    table = {f"R{place}": row for place, row in enumerate(runs(1.0))}

    @contextmanager
    def opener(path):
        if path.stem == "R99":
            raise ArchiveError("not readable")
        row = table.get(path.stem, RunOfLine(2e3, 500.0, 5e4, 1.0, 1.0))
        values = {f"test_{name}": ("specimen", [0.0, one]) for name, one in row._asdict().items()}
        if path.stem == "R98":
            del values["test_quasi_static_spring_constant"]
        yield xr.Dataset(values, coords={"specimen": ["other", "rope"]})

    named = [*table, "R98", "R99"]
    for name in [*named, "X1"]:
        (tmp_path / f"{name}.nc").touch()
    curves = (pull(START), LineCurve("strain", "tension", 0.0, 1.0, coefficient=np.zeros(2)))
    bent, strain = _with_bend(tmp_path, "rope", curves, opener, [(one, "rope") for one in named])
    assert bent.loop_bend == pytest.approx(1.0, abs=0.01)
    assert strain is curves[1]
    (plain, _) = _with_bend(tmp_path, "other", curves, opener, [(one, "rope") for one in named])
    assert plain.loop_bend == 0


def bent_line(bend):
    """A rope whose chord is K_0 of `loop`, as its surfaces of K_ap and H say."""
    apparent, energy = loop()
    # slope at the mean = chord / ratio = BEND (mean + constant)
    slope = REST / closed_form(half_strain(AMPLITUDE, apparent, energy))
    curve = pull(
        slope / BEND - MEAN, standard_uncertainty=np.full(601, 100.0), loop_bend=bend,
        loop_bend_misfit=bend * 0.004,
    )  # fmt: skip
    surfaces = {
        "apparent_spring_constant": surface("apparent_spring_constant", apparent),
        "hysteresis_energy": surface("hysteresis_energy", energy, sigma=1e-4 * energy),
        "dissipation_spring_constant": surface("dissipation_spring_constant", SPRING),
        "relaxation_time": surface("relaxation_time", TIME, sigma=1e-3),
    }
    for name, one in surfaces.items():
        surfaces[name] = replace(one, discrepancy=np.zeros((10, 10)),
                                 discrepancy_exponents=one.exponents)  # fmt: skip
    return replace(source(), surfaces=surfaces, curves=(curve,), slow_pulls={"pull": curve})


def test_an_export_of_bent_loops_has_the_line_that_made_them():
    part = line_dynamics(bent_line(1.0), LEVELS).part
    assert part.static_stiffness == pytest.approx(REST, rel=2e-4)
    assert part.fast_stiffness - part.static_stiffness == pytest.approx(SPRING, rel=1e-3)
    assert part.relaxation_time == pytest.approx(TIME, rel=2e-3)
    # and straight loops the slope
    assert line_dynamics(bent_line(0.0), LEVELS).part.static_stiffness > 1.01 * REST


def test_the_export_says_so_and_holds_what_the_bend_misses():
    found = line_dynamics(bent_line(1.0), LEVELS)
    assert any("K_0 is the chord of the pull over the cycle, -" in text for text in found.notes)
    half = 1.96 * np.hypot(100.0, 0.004 * REST)
    (said,) = (text for text in found.sources if "quasi_static" in text)
    low, high = (float(word) for word in said.split("surface ")[1].split(" N")[0].split(" to "))
    assert (high - low) / 2 == pytest.approx(half, rel=0.06)
    plain = line_dynamics(bent_line(0.0), LEVELS)
    assert not any("chord" in text for text in plain.notes)


def test_a_look_up_solves_k_1_and_tau_of_bent_loops():
    (found,) = consistent_values(bent_line(1.0), **LEVELS)
    assert found.quasi_static_spring_constant == pytest.approx(REST, rel=2e-4)
    assert found.dissipation_spring_constant == pytest.approx(SPRING, rel=1e-3)
    assert found.relaxation_time == pytest.approx(TIME, rel=2e-3)
    (slope,) = consistent_values(bent_line(0.0), **LEVELS)
    assert slope.quasi_static_spring_constant > 1.01 * REST
    assert found.half_width["relaxation_time"] > slope.half_width["relaxation_time"]


def archive_of_level(*, waveform="sinusoidal", bent=True, stored=None):
    """Cycles of T = START (exp(BEND e) - 1) under a driven load, without loss."""
    n, cycles = 60, 8
    turn = np.arange(n * cycles + 1) / n
    wave = -np.cos(2 * np.pi * turn)
    if waveform == "triangular":
        wave = 1 - 4 * np.abs((turn + 0.5) % 1 - 0.5)
    tension = 2000.0 + 800.0 * wave
    strain = np.log1p(tension / START) / BEND if bent else tension / (BEND * 3000.0)
    first = np.arange(cycles) * n
    ends = np.column_stack([first, first + n // 2])
    rate = 800.0 / (np.ptp(strain) / 2)
    each = np.ones((1, cycles))
    settings = (
        '{"reduction": {"cycles": {"break_in_cycles": 2, "waveform": "%s", "control": "load"}}}'
    )
    values = {
        "strain": (("specimen", "sample"), strain[None]),
        "tension": (("specimen", "sample"), tension[None]),
        "cycle_first_sample": ("cycle", first), "cycle_last_sample": ("cycle", first + n),
        "branch_first_sample": (("cycle", "branch_name"), ends),
        "storage_over_time": (("specimen", "cycle"), 4e4 * each),
        "loss_over_time": (("specimen", "cycle"), 3e4 * each),
        "test_mean_tension": ("specimen", [2000.0]), "test_tension_amplitude": ("specimen", [800.0]),
        "test_apparent_spring_constant": ("specimen", [rate]),
        "test_hysteresis_energy": ("specimen", [1e-3]),
    }  # fmt: skip
    if stored is not None:
        kept = np.flatnonzero(np.isin(np.arange(turn.size) // n, stored) | (turn % 1 == 0))
        for name in ("strain", "tension"):
            values[name] = (("specimen", "sample"), values[name][1][:, kept])
        values["sample_index"] = ("sample", kept)
    return xr.Dataset(values, attrs={"settings": settings % waveform, "test": "L1"})


@pytest.mark.parametrize("stored", [None, [3, 4, 6]])
def test_a_rope_at_levels_has_k_0_of_its_bent_loops(stored):
    chord = 1600.0 * BEND / np.log((2800 + START) / (1200 + START))
    bent = _cycle_of_level(archive_of_level(stored=stored), 0, pull(START))
    assert bent.quasi_static_spring_constant == pytest.approx(chord, rel=2e-4)
    straight = _cycle_of_level(archive_of_level(bent=False, stored=stored), 0, pull(START))
    assert straight.quasi_static_spring_constant == pytest.approx(BEND * (2000 + START))
    # one level is enough, and the export at it has this K_0
    found = with_bend_of_levels(pull(START), [bent])
    assert found.loop_bend == pytest.approx(1.0, abs=0.02)
    assert with_bend_of_levels(pull(START), [straight]).loop_bend == 0


def test_levels_without_stored_cycles_have_k_0_anywhere_between_slope_and_chord():
    unknown = _cycle_of_level(archive_of_level(stored=[3]), 0, pull(START))
    assert np.isnan(unknown.quasi_static_spring_constant)
    found = with_bend_of_levels(pull(START), [unknown])
    apart = 1 - 1600.0 / np.log((2800 + START) / (1200 + START)) / (2000 + START)
    assert found.loop_bend == 0.5
    assert found.loop_bend_misfit == pytest.approx(apart / 12**0.5, rel=0.02)


def test_a_triangle_is_exported_by_its_fundamental():
    """E' 4e4 and E'' 3e4 N of the fundamental, whatever K_ap and H of the triangle are."""
    archive = archive_of_level(waveform="triangular")
    share = _sine_over_wave(archive, 0)
    own = float(archive["test_apparent_spring_constant"][0])
    assert share["apparent_spring_constant"] == pytest.approx(5e4 / own)
    energy = np.pi * 800**2 * 3e4 / 5e4**2
    assert share["hysteresis_energy"] == pytest.approx(energy / 1e-3)
    assert _sine_over_wave(archive_of_level(), 0) == {}
    levels = LineLevels(
        "apparent_spring_constant", ("mean_tension",), np.array([[2000.0], [3000.0]]),
        np.array([own, 7e4]), np.array([0.01 * own, 700.0]), np.full(2, 9.0), ("L1", "S1"),
    )  # fmt: skip
    found = _as_sine(levels, {"L1": share, "S1": {}})
    assert found.value == pytest.approx([5e4, 7e4])
    assert found.random_standard_uncertainty == pytest.approx([500, 700])
    assert "fundamental" in found.notes[0]
    assert _as_sine(levels, {"S1": {}}) is levels


def test_an_experiment_of_triangles_is_exported_by_its_surfaces_of_k_1_and_tau(tmp_path):
    line = bent_line(1.0)
    of_wave = {
        name: replace(one, coefficient=share * one.coefficient)
        for name, share in (("apparent_spring_constant", 1.01), ("hysteresis_energy", 0.66))
        for one in [line.surfaces[name]]
    }
    line = replace(line, surfaces=line.surfaces | of_wave, by_fundamental=True)
    found = line_dynamics(line, LEVELS)
    assert found.part.fast_stiffness - found.part.static_stiffness == pytest.approx(SPRING)
    assert found.part.relaxation_time == pytest.approx(TIME)
    assert found.part.static_stiffness == pytest.approx(REST, rel=2e-3)
    assert any("waves that are no sine" in text for text in found.notes)
    # K_ap and H of the wave contradict nothing
    assert consistent_values(line, **LEVELS) == ()

    @contextmanager
    def opener(path):
        yield archive_of_level(waveform={"T": "triangular", "S": "sinusoidal"}[path.stem])

    for name in "TS":
        (tmp_path / f"{name}.nc").touch()
    assert _are_other_waves(tmp_path, [("T", "rope"), ("S", "rope")], opener)
    assert not _are_other_waves(tmp_path, [("S", "rope")], opener)
