"""MoorDyn of OpenFAST, where a program `moordyn_driver` is on the path; no part of this package."""

import numpy as np
import pytest
from export_lines import constant, line
from openfast_runs import DRIVER, stretched

from reduction.lines.deck_formats import export_line
from reduction.lines.export_line import CycleDamping
from reduction.lines.export_sources import line_from_lookup
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources

pytestmark = pytest.mark.skipif(DRIVER is None, reason="no program `moordyn_driver` on the path")


@pytest.mark.parametrize("share", [0.0, 0.05, 0.2, 0.5, 0.8, 1.0])
@pytest.mark.parametrize(
    "name", ["a tether", "polyester-double-braid-0.5in-new", "nylon-8-strand-plaited-0.5in-new"]
)
def test_a_table_gives_its_tension(tmp_path, name, share):
    published = published_sources()
    one = line_from_lookup(published[name], linear_density=0.11) if name in published else line()
    export_line(one, "openfast", tmp_path / "deck.dat")
    strain = share * one.strain[-1]
    time = np.arange(0, 60, 0.05)
    _, found, tension = stretched(tmp_path, "deck.dat", time, np.full(time.size, strain))
    assert found[-1] == pytest.approx(strain, abs=1e-6)
    expected = np.interp(strain, np.append(0.0, one.strain), np.append(0.0, one.tension))
    assert tension[-1] == pytest.approx(expected, rel=0.01, abs=1e-3 * one.tension[-1])


def cycle(folder, *, mean, amplitude, frequency, cycles=30):
    """K_ap and H of the last cycles about a mean strain. [N; J/m]."""
    # the driver smooths velocities over some ten steps
    step = 1 / frequency / 1000
    time = np.arange(0, cycles / frequency, step)
    rise = np.minimum(1, time * frequency / 3)
    strain = mean + amplitude * rise * np.sin(2 * np.pi * frequency * time)
    at, found, tension = stretched(folder, "deck.dat", time, strain)
    last = at > (cycles - 6) / frequency
    phase = 2 * np.pi * frequency * at[last]
    waves = np.stack([np.ones(phase.size), np.sin(phase), np.cos(phase)], axis=1)
    _, *of_strain = np.linalg.lstsq(waves, found[last], rcond=None)[0]
    _, *of_tension = np.linalg.lstsq(waves, tension[last], rcond=None)[0]
    modulus = complex(*of_tension) / complex(*of_strain)
    # the waves are sine and cosine: what leads has the greater cosine
    size = abs(complex(*of_strain))
    return abs(modulus), np.pi * size**2 * modulus.imag, size


def test_stiffness_and_energy_are_those_of_the_three_parameters(tmp_path):
    part = constant()
    export_line(
        line(viscoelasticity=part), "openfast", tmp_path / "deck.dat", form="static-dynamic"
    )
    frequency = 0.2
    stiffness, energy, size = cycle(tmp_path, mean=0.1, amplitude=0.005, frequency=frequency)
    turned = 2j * np.pi * frequency * part.relaxation_time
    slow, fast = part.static_stiffness, part.fast_stiffness
    expected = slow + (fast - slow) * turned / (1 + turned)
    assert stiffness == pytest.approx(abs(expected), rel=0.01)
    assert energy == pytest.approx(np.pi * size**2 * expected.imag, rel=0.03)


def test_a_published_rope_has_the_stiffness_and_energy_of_its_look_up(tmp_path):
    source = published_sources()["nylon-double-braid-0.5in-new"]
    strength = source.rated_break_strength
    levels = {
        "frequency": 0.3, "mean_tension": 0.21 * strength, "tension_amplitude": 0.085 * strength,
    }  # fmt: skip
    one = line_from_lookup(source, levels=levels, linear_density=0.11)
    export_line(one, "openfast", tmp_path / "deck.dat", form="static-dynamic")
    value = {
        name: float(look_up(source, name, **levels).value)
        for name in ("apparent_spring_constant", "hysteresis_energy")
    }
    amplitude = levels["tension_amplitude"] / value["apparent_spring_constant"]
    mean = levels["mean_tension"] / one.viscoelasticity.static_stiffness
    stiffness, energy, size = cycle(tmp_path, mean=mean, amplitude=amplitude, frequency=0.3)
    assert stiffness == pytest.approx(value["apparent_spring_constant"], rel=0.01)
    assert energy / (size / amplitude) ** 2 == pytest.approx(value["hysteresis_energy"], rel=0.03)


def test_a_dashpot_beside_a_table_gives_its_energy(tmp_path):
    amplitude, frequency, coefficient = 0.05, 0.1, 50.0
    lost = 2 * np.pi**2 * frequency * amplitude**2 * coefficient
    one = line(damping=CycleDamping(coefficient, frequency, amplitude, lost, 0.01 * lost))
    export_line(one, "openfast", tmp_path / "deck.dat", form="damped-table")
    _, energy, size = cycle(tmp_path, mean=0.5, amplitude=amplitude, frequency=frequency)
    assert energy == pytest.approx(lost * (size / amplitude) ** 2, rel=0.03)
