"""Tolerance limits against published tables of factors and by trial; specimens as one line."""

import json
from dataclasses import replace

import numpy as np
import pytest
from csvrows import csv_rows
from typer.testing import CliRunner

import reduction
from reduction.cli import lookup as command
from reduction.cli.main import app
from reduction.lines.line_lookup import look_up
from reduction.lines.lookup_product import LineLevels, LineSource
from reduction.lines.population import population_values, specimens_of_kind, tolerance_factors
from reduction.record.contributions import Component
from reduction.record.errors import DataError, SettingsError

K_AP = "apparent_spring_constant"


def test_factors_are_those_of_the_tables_to_their_digits():
    # NIST/SEMATECH e-Handbook 7.2.6.3, by the noncentral t
    assert round(tolerance_factors(43, 0.90, 0.99)[0], 4) == 1.8740
    # one-sided, 95 % confidence: 90, 95 and 99 % (Odeh and Owen 1980, Table 1)
    for n, factors in {
        2: (20.581, 26.260, 37.094), 3: (6.155, 7.656, 10.553), 4: (4.162, 5.144, 7.042),
        5: (3.407, 4.203, 5.741), 10: (2.355, 2.911, 3.981), 20: (1.926, 2.396, 3.295),
    }.items():  # fmt: skip
        found = tuple(round(tolerance_factors(n, p)[0], 3) for p in (0.90, 0.95, 0.99))
        assert found == factors
    # two-sided, 95 % confidence, exact (Berthouex and Brown 2002, Table 21.1; ISO 16269-6)
    for n, factors in {
        4: (5.37, 6.34, 8.22), 5: (4.29, 5.08, 6.60), 6: (3.73, 4.42, 5.76), 7: (3.39, 4.02, 5.24),
        8: (3.16, 3.75, 4.89), 10: (2.86, 3.39, 4.44), 20: (2.32, 2.76, 3.62),
        60: (1.96, 2.34, 3.07),
    }.items():  # fmt: skip
        found = [tolerance_factors(n, p)[1] for p in (0.90, 0.95, 0.99)]
        assert found == pytest.approx(factors, abs=0.0101)
    with pytest.raises(SettingsError, match="two specimens or more"):
        tolerance_factors(1, 0.95)
    with pytest.raises(SettingsError, match="share 1"):
        tolerance_factors(5, 1.0)


def test_limits_hold_as_often_as_they_say():
    n, share, trials = 4, 0.9, 20000
    rng = np.random.default_rng(11)
    drawn = rng.normal(size=(trials, n))
    mean, scatter = drawn.mean(axis=1), drawn.std(axis=1, ddof=1)
    one, two = tolerance_factors(n, share)
    from scipy.special import ndtr

    above = 1 - ndtr(mean - one * scatter)
    between = ndtr(mean + two * scatter) - ndtr(mean - two * scatter)
    for held in (above >= share, between >= share):
        # four standard errors of a share of .95
        assert held.mean() == pytest.approx(0.95, abs=4 * np.sqrt(0.95 * 0.05 / trials))


GAIN = Component("tension_gain", "load cell")


def rope(name, value, *, material="nylon", diameter=0.05, gain=0.0):
    own = Component("diameter", name)
    levels = LineLevels(
        K_AP, ("frequency", "mean_tension", "tension_amplitude"),
        np.array([[0.1, 2e5, 5e4], [0.1, 4e5, 5e4]]), np.array([value, 2 * value]),
        np.full(2, 1e3), np.full(2, 9.0), ("D-1", "D-2"), (GAIN, own),
        np.array([[gain, 2 * gain], [2e3, 2e3]]), ({"medium": "wet"},) * 2,
    )  # fmt: skip
    return LineSource(
        name, f"lab, {name}", material, "8-strand", "new", diameter, 1e6, kind="rope",
        levels=(levels,), specimens=(name,),
    )  # fmt: skip


VALUES = (9.6e6, 1.00e7, 1.02e7, 1.05e7)
LEVEL = {"frequency": 0.1, "mean_tension": 2e5, "tension_amplitude": 5e4}


def ropes(gain=0.0):
    return [rope(f"rope-{place}", value, gain=gain) for place, value in enumerate(VALUES)]


def test_scatter_between_specimens_is_in_the_intervals_and_limits():
    # by hand of the four values: mean 1.00750e7, s 3.7749e5; t of 3 is 3.18245
    lines = ropes()
    every = [look_up(one, K_AP, **LEVEL) for one in lines]
    found = population_values(lines, every, 0.95)
    # what is said of the interval of one specimen is not true of the kind
    (of_one,) = {text for one in every for text in one.notes if "not included" in text}
    assert not any(of_one in text for text in found.values.notes)
    assert float(found.values.value) == pytest.approx(1.0075e7)
    s = 3.774917e5
    assert float(found.standard_deviation) == pytest.approx(s, rel=1e-6)
    assert float(found.values.kind_high - found.values.value) == pytest.approx(
        3.18245 * s / 2, rel=1e-5
    )
    assert float(found.values.value - found.values.line_low) == pytest.approx(
        3.18245 * s * np.sqrt(1.25), rel=1e-5
    )
    # the diameter of each is its own, and in the scatter already
    assert found.values.component == ()
    assert float(found.lower) == pytest.approx(1.0075e7 - 5.144 * s, rel=1e-4)
    assert float(found.upper) == pytest.approx(1.0075e7 + 5.144 * s, rel=1e-4)
    assert float(found.both_low) == pytest.approx(1.0075e7 - 6.341 * s, rel=1e-4)
    assert any("factor 5.144 for one limit alone and 6.341" in text for text in found.values.notes)


def test_what_all_tests_share_widens_the_limits_by_its_half_width():
    alone, shared = (
        population_values(lines, [look_up(one, K_AP, **LEVEL) for one in lines], 0.95)
        for lines in (ropes(), ropes(gain=5e4))
    )
    assert float(alone.lower - shared.lower) == pytest.approx(1.96 * 5e4, rel=1e-3)
    assert float(shared.both_high - alone.both_high) == pytest.approx(1.96 * 5e4, rel=1e-3)
    assert shared.values.component == (GAIN,)


def test_specimens_that_are_no_population_are_refused():
    with pytest.raises(DataError, match="with two the factors of 95 % are 26.3 and 36.5"):
        specimens_of_kind(ropes()[:2], K_AP)
    with pytest.raises(SettingsError, match="differ in material"):
        specimens_of_kind([*ropes(), rope("other", 1e7, material="polyester")], K_AP)
    with pytest.raises(SettingsError, match="differ in diameter"):
        specimens_of_kind([*ropes(), rope("other", 1e7, diameter=0.06)], K_AP)
    with pytest.raises(SettingsError, match="one specimen is in several lines"):
        specimens_of_kind([*ropes(), rope("rope-0", 1e7)], K_AP)
    lines = ropes()
    between = LEVEL | {"mean_tension": 3e5}
    with pytest.raises(DataError, match="rope-0 was not tested at every point"):
        population_values(lines, [look_up(one, K_AP, **between) for one in lines], 0.9)


def test_the_command_prints_factors_and_writes_every_specimen(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "lines_of_source", lambda source: ropes(gain=5e4))
    asked = ["lookup", "lab", "--quantity", "K_ap", "--population", "95 %", "--table"]
    out = tmp_path / "kind.csv"
    done = CliRunner().invoke(app, [*asked, "--out", str(out)], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    assert "factor 5.144" in done.output
    rows = csv_rows(out)
    assert [float(row["specimen_4 [N]"]) for row in rows] == [VALUES[3], 2 * VALUES[3]]
    assert float(rows[0]["lower_limit [N]"]) == pytest.approx(
        1.0075e7 - 5.144 * 3.774917e5 - 1.96 * 5e4, rel=1e-4
    )
    done = CliRunner().invoke(app, [*asked, "--json"], catch_exceptions=False)
    answer = json.loads(done.stdout)["population"]
    assert answer["one_sided_factor"] == pytest.approx(5.144, abs=5e-4)
    assert answer["specimens"]["rope-0"] == [VALUES[0], 2 * VALUES[0]]
    both = CliRunner().invoke(app, [*asked, "--against", "lab"])
    assert both.exit_code == 2


def test_a_table_has_the_levels_that_every_specimen_was_tested_at(monkeypatch):
    lines = ropes(gain=5e4)
    (whole,) = lines[2].levels
    kept = replace(
        whole, at=whole.at[:1], value=whole.value[:1], contribution=whole.contribution[:, :1],
        random_standard_uncertainty=whole.random_standard_uncertainty[:1],
        degrees_of_freedom=whole.degrees_of_freedom[:1], tests=whole.tests[:1],
        conditions=whole.conditions[:1],
    )  # fmt: skip
    lines[2] = replace(lines[2], levels=(kept,))
    for order in (lines, lines[::-1]):
        monkeypatch.setattr(command, "lines_of_source", lambda source, order=order: order)
        asked = ["lookup", "lab", "--quantity", "K_ap", "--population", "95 %", "--table"]
        done = CliRunner().invoke(app, asked, catch_exceptions=False)
        assert done.exit_code == 0, done.output
        assert "not every specimen was tested are left out" in " ".join(done.output.split())
        answer = CliRunner().invoke(app, [*asked, "--json"], catch_exceptions=False)
        assert json.loads(answer.stdout)["population"]["specimens"]["rope-0"] == [VALUES[0]]


def test_python_gives_the_population_of_the_command(monkeypatch):
    monkeypatch.setattr(command, "lines_of_source", lambda source: ropes(gain=5e4))
    options = [
        "--frequency",
        "0.1 Hz",
        "--mean-tension",
        "20 %RBS",
        "--tension-amplitude",
        "5 %RBS",
    ]
    asked = ["lookup", "lab", "--quantity", "K_ap", "--population", "95 %", *options, "--json"]
    said = json.loads(CliRunner().invoke(app, asked, catch_exceptions=False).stdout)
    found = reduction.look_up(
        "lab", "K_ap", population="95 %", frequency="0.1 Hz", mean_tension="20 %RBS",
        tension_amplitude="5 %RBS",
    )  # fmt: skip
    limits = said["population"]
    assert float(found[K_AP]) == pytest.approx(said["value"])
    for key in ("standard_deviation", "lower_limit", "upper_limit"):
        assert float(found[key]) == pytest.approx(limits[key]), key
    assert [float(found.two_sided_low), float(found.two_sided_high)] == pytest.approx(
        limits["two_sided_limits"]
    )
    by_name = dict(zip(found.specimen.values.tolist(), found.of_specimens.values, strict=True))
    assert by_name == pytest.approx(limits["specimens"])
    assert found.attrs["one_sided_factor"] == pytest.approx(limits["one_sided_factor"])
    grid = reduction.look_up("lab", "K_ap", population=0.95, **LEVEL | {"mean_tension": [2e5, 4e5]})
    assert grid.of_specimens.values.tolist() == [[value, 2 * value] for value in VALUES]
    with pytest.raises(SettingsError, match="only one option that combines lines"):
        reduction.look_up("lab", "K_ap", population=0.95, rank=True, **LEVEL)


@pytest.mark.parametrize(("change", "said"), [(-0.04, "4.0 % lower"), (0.02, "2.0 % higher")])
def test_a_look_up_says_how_far_the_later_cycles_of_a_test_are_from_its_mean(change, said):
    line = rope("rope", 1e7)
    levels = replace(line.levels[0], late_change=np.array([change, change]))
    (found,) = (
        text
        for text in look_up(replace(line, levels=(levels,)), K_AP, **LEVEL).notes
        if "settled" in text
    )
    assert found == f"D-1 had not settled: the mean over the last half of its cycles is {said}"
    # of D-1 the interval is 0.05 %: t of nine times 1 kN, and 2 kN of the diameter
    quiet = replace(line.levels[0], late_change=np.array([0.0004, np.nan]))
    notes = look_up(replace(line, levels=(quiet,)), K_AP, **LEVEL).notes
    assert not any("settled" in text for text in notes)
