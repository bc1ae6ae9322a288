"""K_0 of cycles whose loops are as bent as the slow pull, in look-up and export."""

from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from export_sources import LEVELS, REST, SPRING, TIME, loop, source, surface

from reduction.lines.archive_source import _with_bend
from reduction.lines.bent_loops import RunOfLine, chord_over_slope, with_bend_of_runs
from reduction.lines.export_dynamics import line_dynamics
from reduction.lines.line_consistency import consistent_values
from reduction.lines.lookup_product import LineCurve
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
