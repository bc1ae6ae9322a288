"""The composite of the synthetic tests against the one that their noise-free truth gives.

The same rule is applied to both, so that what is left is the reduction: noise and steps of the
logger, and its load channel, which lags by 0.02 s.  Strain is the true one, as in
`test_moduli_truth`.  How far the rule itself is from any one window is in the uncertainty.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reduction.lines.composite import (
    CompositeRule,
    CurvePiece,
    _composite_curve,
    pieces_of_branches,
)
from reduction.record.settings import CycleSettings, ModulusSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.moduli.tangent_modulus import tangent_curves
from reduction.stages.standstills import find_standstills

DATA = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
FOOT, INCH, LBF = 0.3048, 0.0254, 4.4482216152605
AREA = np.pi / 4 * (np.array([1.04, 0.94]) * INCH) ** 2
SPECIMENS = ("new", "used")
TESTS = tuple(f"T-{number}" for number in range(1, 7))


@cache
def reduced(test):
    log = pd.read_csv(DATA / f"{test}.csv", comment="#")
    truth = pd.read_csv(DATA / "truth" / f"{test}_cycles.csv")
    time = log.time_s.to_numpy()
    position = FOOT * log.crosshead_ft.to_numpy()
    tension = LBF * np.stack([log[f"load_{name}_lb"].to_numpy() for name in SPECIMENS])
    standstills = find_standstills(time, position, tension, settings=PhaseSettings())
    cycles = find_cycles(time, position, tension, standstills, settings=CycleSettings())

    def true(column):
        rows = [
            np.interp(time, truth.time_s, truth[column.format(name)], left=np.nan, right=np.nan)
            for name in SPECIMENS
        ]
        return np.stack(rows)

    strain = true("eps_free_{}")
    curves = tangent_curves(strain, tension, area=AREA, cycles=cycles, settings=ModulusSettings())
    return curves, cycles, strain, LBF * true("load_{}_lb")


def pieces_of(test, specimen, branch="mean"):
    curves = reduced(test)[0]
    return pieces_of_branches(
        curves.strain_bin,
        curves.branch_tension[specimen],
        curves.branch_tension_standard_uncertainty[specimen],
        name=test,
        branch=branch,
    )


def true_tension(test, specimen, branch, at):
    """Mean over the cycles of the noise-free tension of a branch."""
    _, cycles, strain, load = reduced(test)
    rows = []
    for cycle in range(1, cycles.n_cycles + 1):
        kept = (cycles.cycle_number == cycle) & (cycles.branch == branch + 1)
        kept &= np.isfinite(strain[specimen] + load[specimen])
        order = np.flatnonzero(kept)[np.argsort(strain[specimen, kept])]
        rows.append(np.interp(at, strain[specimen, order], load[specimen, order]))
    return np.mean(rows, axis=0)


def both(specimen, branch, **rule):
    pieces, truths = [], []
    for test in TESTS:
        for piece in pieces_of(test, specimen, branch):
            ways = (0, 1) if branch == "mean" else (("ascending", "descending").index(branch),)
            load = np.mean(
                [true_tension(test, specimen, way, piece.strain) for way in ways], axis=0
            )
            pieces.append(piece)
            truths.append(
                CurvePiece(
                    test, "cyclic", branch, piece.strain, load, piece.random_standard_uncertainty
                )
            )
    return [_composite_curve(one, rule=CompositeRule(**rule)) for one in (pieces, truths)]


@pytest.mark.parametrize("specimen", [0, 1])
@pytest.mark.parametrize("branch", ["ascending", "descending", "mean"])
def test_the_composite_is_that_of_the_truth_over_the_whole_range(specimen, branch):
    found, true = both(specimen, branch)
    at = np.linspace(0.05, 0.999 * found.strain[-1], 500)
    error = found.tension_at(at) / true.tension_at(at) - 1
    # the lag is 0.2 to 0.4 % of tension on a branch, and nothing in the mean of both; the last bins
    # of a window are reached by some of its cycles alone
    assert np.median(np.abs(error)) < (0.001 if branch == "mean" else 0.005)
    assert np.abs(error).max() < 0.02
    assert found.between_pieces == pytest.approx(true.between_pieces, abs=0.002)


@pytest.mark.parametrize("specimen", [0, 1])
def test_every_window_is_within_three_uncertainties_of_the_composite(specimen):
    found, _ = both(specimen, "mean")
    z = []
    for test in TESTS:
        for piece in pieces_of(test, specimen):
            spread = np.interp(piece.strain, found.strain, found.standard_uncertainty)
            z.append((piece.tension - found.tension_at(piece.strain)) / spread)
    z = np.concatenate(z)
    assert np.abs(z).max() < 3
    assert 0.3 < np.sqrt(np.mean(z**2)) < 1.5
