"""What is stated against what drawing gives: a whole synthetic test, reduced eighty times.

The small version of `benchmarks/monte_carlo.py`, from the pieces of `benchmarks/coverage_tethers.py`.
"""

import importlib.util
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from reduction.record.contributions import combined_standard_uncertainty

pytestmark = pytest.mark.nightly

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "coverage_tethers.py"
N_DRAWS = 80
AGREE = 0.05
# three standard deviations of a standard deviation of so many draws
SAMPLING = 3 / np.sqrt(2 * N_DRAWS)


@pytest.fixture(scope="module")
def drawn():
    """Errors and stated standard uncertainties by number, each of its own place."""
    # by its path: another package has the name of the script
    spec = importlib.util.spec_from_file_location("benchmark_coverage", BENCHMARK)
    tethers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tethers)
    found = defaultdict(list)
    for seed in range(N_DRAWS):
        test = tethers.one_test(np.random.default_rng(1000 + seed))
        place = defaultdict(int)
        for name, value, truth, random, shared, _ in tethers.numbers_of(test):
            place[name] += 1
            u = float(combined_standard_uncertainty([shared], random))
            found[name, place[name]].append((value - truth, u))
    return {key: np.array(rows).T for key, rows in found.items() if len(rows) == N_DRAWS}


def test_every_number_is_drawn(drawn):
    names = {name for name, _ in drawn}
    assert {
        "tangent_modulus, ascending", "tangent_modulus, descending", "segment_modulus, ascending",
        "segment_modulus, descending", "apparent_spring_constant", "hysteresis_energy",
        "storage_spring_constant", "loss_spring_constant",
    } <= names  # fmt: skip
    assert sum(name.startswith("tangent_modulus") for name, _ in drawn) == 20


def ratio_of(error, u):
    """Stated over drawn."""
    return np.sqrt(np.mean(u**2)) / np.std(error, ddof=1)


def test_linear_and_drawn_standard_uncertainties_agree(drawn):
    for key, rows in drawn.items():
        ratio = ratio_of(*rows)
        assert 1 - AGREE - SAMPLING < ratio < 1 + AGREE + SAMPLING, (key, ratio)


def test_they_agree_closer_over_all_numbers_of_a_kind(drawn):
    """Places of one kind are not all one draw: their mean ratio is known better than each."""
    ratios = defaultdict(list)
    for (name, _), rows in drawn.items():
        ratios[name.split(",")[0]].append(ratio_of(*rows))
    for name in ("tangent_modulus", "segment_modulus"):
        assert abs(np.mean(ratios[name]) - 1) < AGREE + SAMPLING / 3, (name, ratios[name])
