"""MoorDyn itself (the wheel of PyPI, in a process of its own) reads what is exported for it."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from export_lines import constant, growing, line, syrope
from export_readers import moordyn_sections, moordyn_table
from moordyn_runs import at_rest, last_cycles, run, write

from reduction.cli.curves import deployed_line
from reduction.cli.export import _with_syrope
from reduction.lines.composite import CompositeRule, compose
from reduction.lines.deck_formats import export_line
from reduction.lines.deck_moordyn import moordyn_files
from reduction.lines.export_sources import line_from_assembly, line_from_composite, line_from_lookup
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_piece_sources, published_sources

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed"
    ),
]
ASSEMBLIES = Path(__file__).parents[2] / "docs" / "assemblies"


def test_a_table_gives_back_its_tension_at_14_strains(tmp_path):
    *_, deck = export_line(line(), "moordyn", tmp_path / "deck.dat")
    assert deck == tmp_path / "deck.dat"
    strains = np.arange(0.1, 1.45, 0.1)
    assert strains.size == 14
    table = moordyn_table((tmp_path / "deck_table.txt").read_text())
    np.testing.assert_allclose(at_rest(tmp_path, strains), np.interp(strains, *table), rtol=1e-6)


@pytest.mark.parametrize(
    ("form", "part"), [("static-dynamic", constant()), ("load-dependent", growing())]
)
@pytest.mark.parametrize("frequency", [0.1, 0.5])
def test_the_dynamic_stiffness_is_that_of_the_three_parameters(tmp_path, form, part, frequency):
    write(tmp_path, moordyn_files(line(viscoelasticity=part), "deck", form=form))
    done, tension = run(tmp_path, mean=0.1, amplitude=0.005, frequency=frequency, cycles=40)
    assert done.returncode == 0, done.stdout[-800:]
    # the tension of a step is that at its end
    rise, lag = last_cycles(tension)
    found = np.hypot(rise, lag) / 0.005
    slow, fast = part.static_stiffness, part.fast_stiffness
    turned = 2j * np.pi * frequency * part.relaxation_time
    expected = abs(slow + (fast - slow) * turned / (1 + turned))
    assert found == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize(
    "name", ["polyester-double-braid-0.5in-new", "polyester-double-braid-0.5in-5-years"]
)
def test_a_running_stiffness_has_the_loop_that_its_header_tells(tmp_path, name):
    source, frequency = published_sources()[name], 0.3
    strength = source.rated_break_strength
    levels = {
        "frequency": frequency, "mean_tension": 0.21 * strength,
        "tension_amplitude": 0.085 * strength,
    }  # fmt: skip
    one = line_from_lookup(source, levels=levels, linear_density=0.11)
    part = one.viscoelasticity
    files = moordyn_files(one, "deck", form="load-dependent")
    write(tmp_path, files)
    amplitude = levels["tension_amplitude"] / part.apparent_stiffness
    mean = levels["mean_tension"] / part.static_stiffness
    _, tension = run(tmp_path, mean=mean, amplitude=amplitude, frequency=frequency, cycles=20)
    # the tension of a step is that at its end
    phase = 2 * np.pi * np.arange(1, 201) / 200
    waves = np.stack([np.ones(200), np.sin(phase), np.cos(phase)], axis=1)
    _, *found = np.linalg.lstsq(waves, tension[-200:], rcond=None)[0] / amplitude
    expected = part.running_stiffness_at(frequency)
    assert np.hypot(*found) == pytest.approx(abs(expected), rel=0.01)
    assert found[1] == pytest.approx(expected.imag, rel=0.02)
    # H of a tension amplitude is pi of its square times the loss of 1 / K
    energy = 100 * ((1 / expected).imag / (1 / part.stiffness_at(frequency)).imag - 1)
    assert f"{energy:+.1f} percent in hysteresis energy at equal tension" in " ".join(
        files[""].split()
    )


@pytest.mark.parametrize("part", [constant(), pytest.param(growing(), marks=pytest.mark.nightly)])
def test_the_slow_stiffness_is_static(tmp_path, part):
    form = "load-dependent" if part.dynamic_stiffness_per_mean_tension else "static-dynamic"
    write(tmp_path, moordyn_files(line(viscoelasticity=part), "deck", form=form))
    tension = at_rest(tmp_path, [0.05, 0.1], step=0.5, rest=int(80 * part.relaxation_time))
    np.testing.assert_allclose(tension, part.static_stiffness * np.array([0.05, 0.1]), rtol=1e-4)


@pytest.mark.parametrize(
    ("form", "k1", "k2"),
    [("LINEAR", 0.2, 0.0), ("LINEAR", 1e8, 0.0), ("QUADRATIC", 0.2, 0.5), ("EXP", 0.2, 1.5)],
)
def test_a_syrope_starts_on_its_working_curve_and_goes_on_along_the_original_one(
    tmp_path, form, k1, k2
):
    part = syrope(form=form, k1=k1, k2=k2)
    write(tmp_path, moordyn_files(line(syrope=part), "deck", form="syrope"))
    strains = [part.initial_strain, 0.045, 0.055]
    tension = at_rest(tmp_path, strains, step=0.5, rest=120)
    # MoorDyn puts its curves through points
    assert tension[0] == pytest.approx(part.mean_tension, rel=1e-3)
    np.testing.assert_allclose(tension[1:], [3.4e6, 4.2e6], rtol=1e-6)


def test_the_traps_are_what_they_are_said_to_be(tmp_path):
    """If one of these goes away in a later MoorDyn, its guard may go too."""
    files = moordyn_files(line(), "deck")
    table = files["deck_table.txt"]
    rows = table.split("\n")
    longer = "\n".join([*rows, "2.0 1000.0"])
    for bad in (table + "\n", longer):
        write(tmp_path, files | {"deck_table.txt": bad})
        assert run(tmp_path, strains=[0.5], step=0.1, rest=10)[0].returncode not in (0, None)
    # beyond the last point the tension stays
    write(tmp_path, files)
    assert at_rest(tmp_path, [2.2])[0] == pytest.approx(float(rows[-1].split()[1]), rel=1e-6)
    # a table beside a dynamic stiffness is replaced by the secant of its last row
    (step,) = (row[0] for row in moordyn_sections(files[""])["OPTIONS"] if row[1] == "dtM")
    end = np.array(rows[-1].split(), dtype=float)
    write(
        tmp_path,
        files
        | {
            "": files[""]
            .replace(" deck_table.txt ", " deck_table.txt|50000 ")
            .replace(" -1 0 ", " 1000|10 0 ")
            # the step of the deck is that of its table, and 50 kN ask for a tenth of it
            .replace(f"{step} dtM", "0.0005 dtM")
        },
    )
    assert at_rest(tmp_path, [0.3])[0] == pytest.approx(0.3 * end[1] / end[0], rel=1e-6)
    # a loop is taken, and the tension is on neither branch
    there = [f"{strain:g} {900 * strain:g}" for strain in np.linspace(0, 1, 12)]
    back = [f"{strain:g} {700 * strain:g}" for strain in np.linspace(0.99, 0.01, 12)]
    write(tmp_path, files | {"deck_table.txt": "\n".join([*rows[:3], *there, *back])})
    tension = at_rest(tmp_path, [0.5], step=0.01)
    assert not 350 <= tension[0] <= 450
    # a Syrope without initial conditions kills the process
    files = moordyn_files(line(syrope=syrope()), "deck", form="syrope")
    deck = files[""]
    start, stop = deck.index("-" * 22 + " SYROPE IC"), deck.index("-" * 22 + " OPTIONS")
    write(tmp_path, files | {"": deck[:start] + deck[stop:]})
    assert run(tmp_path, strains=[0.03], step=0.1, rest=1)[0].returncode < 0


def test_the_deck_states_a_step_because_that_of_moordyn_is_wrong_for_tables(tmp_path):
    files = moordyn_files(line(), "deck")
    (step,) = [row[0] for row in moordyn_sections(files[""])["OPTIONS"] if row[1] == "dtM"]
    write(tmp_path, files | {"": files[""].replace(f"{step} dtM", "0.5 CFL")})
    assert run(tmp_path, strains=[0.1, 0.2], step=0.1, rest=30)[0].returncode != 0


@pytest.mark.parametrize("name", ["composite", "new-hampshire"])
def test_composites_and_assemblies_give_back_their_tension_at_14_strains(tmp_path, name):
    """A tether of all its windows, and four of them with their splices and bridles."""
    stated = {"diameter": 0.06, "linear_density": 2.0}
    if name == "composite":
        source = published_piece_sources()["rubber-tether-used"]
        made = line_from_composite(source, compose(source, CompositeRule()), **stated)
    else:
        made = line_from_assembly(deployed_line(ASSEMBLIES / f"{name}.toml"), **stated)
    export_line(made, "moordyn", tmp_path / "deck.dat")
    strains = np.linspace(0.1, 0.98, 14) * made.strain[-1]
    table = moordyn_table((tmp_path / "deck_table.txt").read_text())
    tension = at_rest(tmp_path, strains)
    np.testing.assert_allclose(tension, np.interp(strains, *table), rtol=1e-6)
    # what 30 rows miss of the curve stands in the header
    missed = np.abs(tension - np.interp(strains, made.strain, made.tension)).max()
    told = re.search(r"greatest error ([\d.e+-]+) N", (tmp_path / "deck.dat").read_text())
    assert missed <= float(told[1]) * (1 + 1e-3)


# levels of the design: -1 to 1 of frequency, mean tension, tension amplitude
POINTS = [
    ("nylon-double-braid-0.5in-new", (0, 0, 0)),
    ("nylon-double-braid-0.5in-new", (1, 0, 0)),
    ("nylon-double-braid-1in-new", (-1, 0, 0)),
    ("nylon-double-braid-1.25in-new", (1, -1, 0)),
    ("polyester-double-braid-0.5in-new", (1, 1, 0)),
    ("nylon-8-strand-plaited-0.5in-new", (0, 0, 1)),
    ("polyester-double-braid-0.5in-5-years", (0, 0, 0)),
]


@pytest.mark.parametrize(
    ("name", "coded"),
    [POINTS[0], *(pytest.param(*one, marks=pytest.mark.nightly) for one in POINTS[1:])],
)
def test_k_ap_is_that_of_the_look_up_within_2_percent(tmp_path, name, coded):
    source = published_sources()[name]
    surface = source.surfaces["apparent_spring_constant"]
    at = (surface.low + surface.high) / 2 + np.array(coded) * (surface.high - surface.low) / 2
    levels = dict(zip(source.factor_names, at.tolist(), strict=True))
    wanted, energy = (
        float(look_up(source, quantity, **levels).value)
        for quantity in ("apparent_spring_constant", "hysteresis_energy")
    )
    line = line_from_lookup(source, levels=levels, linear_density=0.2)
    write(tmp_path, moordyn_files(line, "deck", form="static-dynamic"))
    amplitude = levels["tension_amplitude"] / wanted
    # the slow spring settles in a few tau
    cycles = 20 + int(8 * line.viscoelasticity.relaxation_time * levels["frequency"])
    done, tension = run(
        tmp_path, mean=0.1, amplitude=amplitude, frequency=levels["frequency"], cycles=cycles
    )
    assert done.returncode == 0, done.stdout[-800:]
    # the tension of a step is that at its end, a phase of a two-hundredth cycle later
    sine, cosine = last_cycles(tension)
    turned = complex(sine, cosine) * np.exp(-2j * np.pi / 200)
    assert abs(turned) / amplitude == pytest.approx(wanted, rel=0.02)
    assert np.pi * amplitude * turned.imag == pytest.approx(energy, rel=0.1)


@pytest.mark.parametrize("shape", ["LINEAR, 0.1", "QUADRATIC, 0.2, 0.5", "EXP, 0.1, 0.5"])
def test_a_syrope_of_a_published_line_starts_at_its_mean_tension(tmp_path, shape):
    levels = {"frequency": 0.3, "mean_tension": 5978.4, "tension_amplitude": 2419.8}
    source = published_sources()["polyester-double-braid-0.5in-new"]
    made = line_from_lookup(source, levels=levels, linear_density=0.1)
    made = _with_syrope(made, shape, "8 kN", form="syrope")
    write(tmp_path, moordyn_files(made, "deck", form="syrope"))
    start = made.syrope.initial_strain
    tension = at_rest(
        tmp_path, [start], step=0.5, rest=int(40 * made.viscoelasticity.relaxation_time)
    )
    assert tension[0] == pytest.approx(levels["mean_tension"], rel=2e-3)
