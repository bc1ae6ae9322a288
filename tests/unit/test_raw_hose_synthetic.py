"""The synthetic hose logs are what their generator says, and lie about the slope of an energy.

Wrap angles, modulus and the rest are typed from README.md of the campaign, not imported.
"""

import runpy
from math import atan, cos, degrees, pi, radians, sin, sqrt, tan
from pathlib import Path

import numpy as np
import pytest

from reduction.campaign.load import load_campaign

FOLDER = Path(__file__).parents[2] / "raw" / "hose-synthetic"
LOGS = ("S-64", "L-64", "D-64", "B-64", "S-68", "L-68", "D-68")
ANGLE = {"64": radians(63.6), "68": radians(68.3)}
LOAD_NOISE = 4.0  # lbf
# a position 0.015 in off is tension off by that times the slope, 80 lbf/in at most
READING_NOISE = sqrt(LOAD_NOISE**2 + (0.015 * 80) ** 2)


@pytest.fixture(scope="module")
def again(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hose")
    runpy.run_path(str(FOLDER / "generate.py"))["main"](folder)
    return folder


def numbers(path):
    return np.loadtxt(path, delimiter=",", comments="#", skiprows=2)


def columns(path):
    header = path.read_text(encoding="utf-8").splitlines()[1].split(",")
    return dict(zip(header, np.loadtxt(path, delimiter=",", skiprows=2, dtype=str).T, strict=True))


def energy(stretch, angle, cord_factor=1.0):
    """Stored in one inch of the part that stretches, at rest [lbf]."""
    cord = np.sqrt((stretch * cos(angle)) ** 2 + sin(angle) ** 2 / stretch)
    # integral of 80 e + 340.685 e^2 - 786.883 e^3 over the strain e of a taut cord
    taut = np.maximum(cord - 1, 0)
    one = 80 * taut**2 / 2 + 340.685 * taut**3 / 3 - 786.883 * taut**4 / 4
    wall = pi / 4 * (5**2 - 2.5**2)
    # two layers: in a length L lie pi d cos(a0) n cords of each, L / cos(a0) long
    cords = 2 * pi * 3.5 * cos(angle) * 34 / cos(angle)
    return cords * cord_factor * one + wall * 212 / 6 * (stretch**2 + 2 / stretch - 3)


def tension(strain, angle, cord_factor=1.0):
    """Slope of the energy over the whole length, of which 4 in of 96 in do not stretch [lbf]."""
    stretch = 1 + strain * 96 / 92
    step = 1e-5
    up, down = (energy(stretch + sign * step, angle, cord_factor) for sign in (1, -1))
    return (up - down) / (2 * step)


def cycled(name, start, end, period):
    """Strain, tension and whether it rises, of the cycles of a log, turns left out."""
    time, position, load = numbers(FOLDER / f"{name}.csv").T
    share = (time - start) / period % 1
    kept = (time > start) & (time < end)
    for turn in (0, 0.5, 1):
        kept &= np.abs(share - turn) > 0.01
    return position[kept] / 96 - 1, load[kept], share[kept] < 0.5


@pytest.mark.parametrize("name", LOGS)
def test_the_generator_writes_the_logs_again(again, name):
    # one unit of the last digit is left to other processors' sines
    last_digit = np.array([1e-3, 1e-3, 0.1])
    apart = np.abs(numbers(again / f"{name}.csv") - numbers(FOLDER / f"{name}.csv"))
    assert np.max(apart / last_digit) < 1.1


@pytest.mark.parametrize("name", ["hoses.csv", "cord.csv", "curve_64.csv", "curve_68.csv"])
def test_the_generator_writes_the_truth_again(again, name):
    old, new = columns(FOLDER / "truth" / name), columns(again / "truth" / name)
    assert old.keys() == new.keys()
    for key in old.keys() - {"hose"}:
        np.testing.assert_allclose(new[key].astype(float), old[key].astype(float), rtol=1e-7)


@pytest.mark.parametrize("path", sorted(FOLDER.rglob("*.csv")), ids=lambda path: path.name)
def test_every_table_says_that_it_is_synthetic(path):
    assert path.read_text(encoding="utf-8").startswith("# synthetic, no hose was pulled")


@pytest.mark.parametrize("hose", ["64", "68"])
def test_the_true_curves_are_the_slope_of_the_stored_energy(hose):
    truth = columns(FOLDER / "truth" / f"curve_{hose}.csv")
    strain = truth["strain"].astype(float)
    for key, factor in (("tension_lbf", 1.0), ("dynamic_tension_lbf", 1.4)):
        expected = tension(strain, ANGLE[hose], factor)
        np.testing.assert_allclose(truth[key].astype(float), expected, atol=0.02)


@pytest.mark.parametrize("hose", ["64", "68"])
def test_the_true_fill_pressure_is_that_of_the_end_cap(hose):
    # along the axis N cords carry P cos(a) each, and the water takes p on the circle inside them
    truth = {
        key: value.astype(float)
        for key, value in columns(FOLDER / "truth" / f"curve_{hose}.csv").items()
    }
    stretch = 1 + truth["strain"] * 96 / 92
    angle = np.arccos(stretch * cos(ANGLE[hose]) / (1 + truth["cord_strain"]))
    n_cords = 2 * pi * 3.5 * cos(ANGLE[hose]) * 34
    end_cap = truth["fill_pressure_psi"] * pi / 4 * 3.5**2 / stretch
    expected = (
        n_cords * truth["cord_tension_lbf"] * np.cos(angle) + truth["rubber_tension_lbf"] - end_cap
    )
    np.testing.assert_allclose(truth["tension_lbf"], expected, atol=0.01)


def test_the_cords_pick_up_work_and_break_where_the_closed_forms_say():
    truth = columns(FOLDER / "truth" / "hoses.csv")
    for row, angle in enumerate(ANGLE.values()):
        assert degrees(angle) > degrees(atan(sqrt(2)))
        pick_up = (-1 + sqrt(1 + 4 * tan(angle) ** 2)) / 2
        assert float(truth["pick_up_strain"][row]) == pytest.approx((pick_up - 1) * 92 / 96)
        for event, cord_strain in (("working", 0.095), ("break", 0.26)):
            stretch = 1 + float(truth[f"{event}_strain"][row]) * 96 / 92
            cord = sqrt((stretch * cos(angle)) ** 2 + sin(angle) ** 2 / stretch)
            assert cord - 1 == pytest.approx(cord_strain, abs=2e-5)


@pytest.mark.parametrize(
    ("name", "start", "end", "period", "factor", "share", "power"),
    [
        ("L-64", 10, 310, 100, 1.0, 0.03, 1.0),
        ("L-68", 10, 310, 100, 1.0, 0.03, 1.0),
        ("S-64", 10, 110, 100, 1.0, 0.03, 1.0),
        ("S-68", 10, 110, 100, 1.0, 0.03, 1.0),
        ("D-64", 25.014, 145, 10, 1.4, 0.05, 0.5),
        ("D-68", 25.014, 145, 10, 1.4, 0.05, 0.5),
    ],
)
def test_half_the_sum_of_the_branches_is_the_slope_of_the_energy(
    name, start, end, period, factor, share, power
):
    strain, load, rises = cycled(name, start, end, period)
    apart = load - tension(strain, ANGLE[name[-2:]], factor)
    edges = np.linspace(strain.min() + 0.02, strain.max() - 0.02, 31)
    middle = (edges[:-1] + edges[1:]) / 2
    mean, variance = [], []
    for branch in (rises, ~rises):
        cell = np.digitize(strain[branch], edges) - 1
        inside = (cell >= 0) & (cell < middle.size)
        count = np.bincount(cell[inside], minlength=middle.size)
        assert count.min() >= 5
        mean.append(np.bincount(cell[inside], apart[branch][inside]) / count)
        variance.append(READING_NOISE**2 / count)
    spread = np.sqrt(variance[0] + variance[1]) / 2
    # half a loop changes by at most 3 lbf over a cell, and the cells of the branches differ
    assert np.all(np.abs(mean[0] + mean[1]) / 2 < 4 * spread + 3)
    assert abs(np.mean(mean[0] + mean[1]) / 2) < 0.8
    # and half their difference is the loop that README.md states
    lowest = 0.10 if name[0] == "D" else 0.0
    truth = columns(FOLDER / "truth" / "hoses.csv")
    key = "dynamic_working_strain" if name[0] == "D" else "working_strain"
    highest = float(truth[key][["64", "68"].index(name[-2:])])
    place = (2 * middle - lowest - highest) / (highest - lowest)
    loop = tension(middle, ANGLE[name[-2:]], factor) * share * (1 - place**2) ** power
    assert np.all(np.abs((mean[0] - mean[1]) / 2 - loop) < 4 * spread + 3)


def test_noise_of_a_standstill_is_within_the_stated_uncertainties():
    for name in LOGS:
        time, position, load = numbers(FOLDER / f"{name}.csv").T
        still = time < 9.9
        assert 0.8 * 0.015 < np.std(position[still]) < 0.02
        assert 0.8 * LOAD_NOISE < np.std(load[still]) < 5


def test_the_campaign_is_two_synthetic_stretch_hoses():
    campaign = load_campaign(FOLDER / "campaign.toml")
    assert campaign.attributes["synthetic"] == "yes"
    assert set(campaign.tests) == set(LOGS)
    for specimen in campaign.specimens.values():
        assert specimen.kind == "stretch hose"
        assert specimen.gauge_length == pytest.approx(96 * 0.0254)
