"""`export --verify`: written decks, run in their programs, beside closed forms and planted faults."""

import importlib.util
import shutil

import numpy as np
import pytest
import yaml
from export_lines import constant, growing, line, syrope

from reduction.lines.client_runs import in_words, verify_deck
from reduction.lines.deck_formats import export_line
from reduction.lines.export_line import CycleDamping, cycle_damping
from reduction.record.errors import SettingsError

NEEDED = {
    "moordyn": importlib.util.find_spec("moordyn"),
    "moorpy": importlib.util.find_spec("moorpy"),
    "openfast": shutil.which("moordyn_driver"),
    "whoi-cable": shutil.which("cable"),
    "raft": importlib.util.find_spec("raft"),
}
FREQUENCY, AMPLITUDE = 0.1, 0.5
DASHPOT = 50.0
LOST = 2 * np.pi**2 * FREQUENCY * AMPLITUDE**2 * DASHPOT
LINES = {
    "table": line(),
    "expression": line(),
    "damped-table": line(damping=CycleDamping(DASHPOT, FREQUENCY, AMPLITUDE, LOST, 0.01 * LOST)),
    "static-dynamic": line(viscoelasticity=constant()),
    "load-dependent": line(viscoelasticity=growing()),
    "syrope": line(syrope=syrope(fast_damping=2e3)),
    "": line(damping=CycleDamping(DASHPOT, FREQUENCY, AMPLITUDE, LOST, 0.01 * LOST)),
    "library": line(viscoelasticity=growing(), rated_break_strength=5e4),
}
FORMS = [
    ("moordyn", "table"), ("moordyn", "damped-table"), ("moordyn", "static-dynamic"),
    pytest.param("moordyn", "load-dependent", marks=pytest.mark.nightly), ("moordyn", "syrope"), ("moorpy", "table"),
    ("moorpy", "library"), ("raft", ""),
    ("openfast", "table"), ("openfast", "damped-table"), ("openfast", "static-dynamic"),
    ("whoi-cable", "expression"), ("whoi-cable", "table"),
]  # fmt: skip
pytestmark = pytest.mark.slow


def needs(to):
    if NEEDED[to] is None:
        pytest.skip(f"no program for {to}")


@pytest.mark.parametrize(("to", "form"), FORMS)
def test_every_program_keeps_what_a_form_promises(tmp_path, to, form):
    needs(to)
    one = LINES[form]
    paths = export_line(one, to, tmp_path / "deck.dat", form=form or None)
    checks = verify_deck(one, to, form, paths)
    assert checks
    assert {check.quantity: round(check.error, 4) for check in checks if not check.is_kept} == {}
    assert all("DOUBTFUL" not in words for words in in_words(checks))


def test_the_promise_is_that_of_the_three_parameters(tmp_path):
    needs("moordyn")
    part = constant()
    one = line(viscoelasticity=part)
    paths = export_line(one, "moordyn", tmp_path / "deck.dat", form="static-dynamic")
    checks = {
        check.quantity: check for check in verify_deck(one, "moordyn", "static-dynamic", paths)
    }
    frequency, amplitude = (
        float(checks["K_ap"].at.split(mark)[place].split(" ")[0])
        for mark, place in ((" Hz", 0), ("+- ", 1))
    )
    turned = 2j * np.pi * frequency * part.relaxation_time
    rise = part.fast_stiffness - part.static_stiffness
    modulus = part.static_stiffness + rise * turned / (1 + turned)
    assert checks["K_ap"].promised == pytest.approx(abs(modulus), rel=2e-3)
    assert checks["H"].promised == pytest.approx(np.pi * amplitude**2 * modulus.imag, rel=5e-3)
    assert checks["tension"].promised == pytest.approx(part.static_stiffness * 0.1, rel=1e-3)


def test_a_small_cycle_of_a_syrope_is_that_of_springs_in_series():
    """EA_d in series with BA_s beside the spring that gives the slope of the working curve."""
    one = syrope(k1=0.2)
    top = float(np.interp(one.greatest_mean_tension, one.tension, one.strain))
    slope = one.greatest_mean_tension / (0.8 * top)
    fast = one.dynamic_stiffness + one.dynamic_stiffness_per_mean_tension * one.mean_tension
    slow = 1 / (1 / slope - 1 / fast) + 2j * np.pi * 0.1 * one.slow_damping
    expected = 1 / (1 / fast + 1 / slow)
    assert one.about_mean.stiffness_at(0.1) == pytest.approx(expected, rel=1e-9)


def test_a_syrope_whose_stiffness_does_not_grow_starts_where_it_is_told_to(tmp_path):
    """MoorDyn divides by the growth."""
    needs("moordyn")
    one = line(syrope=syrope(fast_damping=2e3, dynamic_stiffness_per_mean_tension=0.0))
    paths = export_line(one, "moordyn", tmp_path / "deck.dat", form="syrope")
    checks = verify_deck(one, "moordyn", "syrope", paths)
    assert [one.quantity for one in checks if not one.is_kept] == []


def test_a_line_for_raft_is_the_straight_one_through_the_turns(tmp_path):
    """Tension over length, mass, volume and drag of the whole line are those of the cycle."""
    one = LINES[""]
    (path,) = export_line(one, "raft", tmp_path / "mooring.yaml")
    mooring = yaml.safe_load(path.read_text())["mooring"]
    (made,), (kind,) = mooring["lines"], mooring["line_types"]
    strain = 1.5 - np.array([0.0, 2 * AMPLITUDE])
    turns = np.interp(strain, one.strain, one.tension)
    # the dashpot takes 1.5 % more than the turns here
    rate = 2 * np.pi * FREQUENCY * AMPLITUDE * DASHPOT
    found = kind["stiffness"] * (10 * (1 + strain) / made["length"] - 1)
    assert float(found.mean()) == pytest.approx(float(turns.mean()), rel=1e-9)
    assert np.hypot(np.ptp(turns) / 2, rate) == pytest.approx(np.ptp(found) / 2, rel=0.02)
    assert kind["mass_density"] * made["length"] == pytest.approx(10 * one.linear_density)
    assert kind["diameter"] ** 2 * made["length"] == pytest.approx(10 * one.diameter**2)
    drag = kind["transverse_drag"] * kind["diameter"] * made["length"]
    assert drag == pytest.approx(1.2 * one.diameter * 10)
    assert f"{LOST:.4g} J/m, is NOT included" in " ".join(path.read_text().replace("#", "").split())


def test_inertia_of_a_soft_line_is_not_taken_for_stiffness(tmp_path):
    """A tether of 300 N moved by its own length."""
    needs("moordyn")
    strain, rate = np.array([0.5, 1.5]), 0.8
    damping = cycle_damping(2 * np.pi**2 * rate * 0.25 * 2.0, rate, 0.5, apparent_stiffness=300.0)
    one = line(strain=strain, tension=300 * strain, damping=damping, tested=(0.5, 1.5))
    paths = export_line(one, "moordyn", tmp_path / "deck.dat", form="damped-table")
    checks = verify_deck(one, "moordyn", "damped-table", paths)
    assert {check.quantity for check in checks} == {"tension", "K_ap", "H"}
    assert {check.quantity: round(check.error, 4) for check in checks if not check.is_kept} == {}


@pytest.mark.parametrize(("first", "factor"), [(3, 1.02), (-1, 0.9)])
def test_a_table_that_is_wrong_is_found(tmp_path, first, factor):
    """The last row is the one beyond the curve, where only the strain of 1.2 times its end looks."""
    needs("moordyn")
    one = line()
    table, deck = export_line(one, "moordyn", tmp_path / "deck.dat")
    rows = table.read_text().split("\n")
    for place in range(len(rows))[first:]:
        strain, tension = map(float, rows[place].split())
        rows[place] = f"{strain:.10g} {factor * tension:.10g}"
    table.write_text("\n".join(rows))
    checks = verify_deck(one, "moordyn", "table", [table, deck])
    assert any(not check.is_kept for check in checks)
    assert in_words(checks)[0].startswith("DOUBTFUL: run in MoorDyn")


def test_a_dashpot_that_is_a_tenth_off_is_found_by_its_energy(tmp_path):
    needs("moordyn")
    one = LINES["damped-table"]
    table, deck = export_line(one, "moordyn", tmp_path / "deck.dat", form="damped-table")
    text = deck.read_text()
    assert " 50 0 " in text
    deck.write_text(text.replace(" 50 0 ", " 55 0 "))
    lost = [one.quantity for one in verify_deck(one, "moordyn", "damped-table", [table, deck])
            if not one.is_kept]  # fmt: skip
    assert lost == ["H"]


@pytest.mark.parametrize(
    ("to", "form"),
    [("moordyn", "table"), ("moorpy", "table"), ("whoi-cable", "table"), ("orcaflex", None)],
)
def test_a_form_without_damping_says_how_much_is_left_out(tmp_path, to, form):
    *_, deck = export_line(LINES["damped-table"], to, tmp_path / "deck.dat", form=form)
    head = " ".join(deck.read_text().replace("#", "").replace("/*", "").replace("*/", "").split())
    assert f"{LOST:.4g} J/m at {FREQUENCY:g} Hz, strain 1 +- {AMPLITUDE:g}, is NOT included" in head


def test_a_format_that_nothing_runs_is_refused(tmp_path):
    paths = export_line(line(), "abaqus", tmp_path / "x.inp")
    with pytest.raises(SettingsError, match="nothing here runs --to abaqus"):
        verify_deck(line(), "abaqus", "", paths)


def test_a_program_that_is_not_there_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    paths = export_line(line(), "openfast", tmp_path / "x.dat")
    with pytest.raises(SettingsError, match="moordyn_driver, of OpenFAST, is not installed"):
        verify_deck(line(), "openfast", "table", paths)
