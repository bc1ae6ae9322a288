"""What is stated against what drawing gives: a whole synthetic test, reduced eighty times.

The small version of `benchmarks/monte_carlo.py`, from the pieces of `benchmarks/coverage_tethers.py`.
"""

import importlib.util
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reduction.record.contributions import Contributions, combined_standard_uncertainty

pytestmark = pytest.mark.nightly

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "coverage_tethers.py"
N_DRAWS = 80
AGREE = 0.05
# three standard deviations of a standard deviation of so many draws
SAMPLING = 3 / np.sqrt(2 * N_DRAWS)


# what other laws of the splices, or of the rubber beside a turn, would do: those drawn have neither
NOT_DRAWN = {"splice_law", "window"}


def of_what_is_drawn(test):
    """The same with the contributions of sources that the draws have."""
    whole = test.contributions
    kept = np.array([one.source not in NOT_DRAWN for one in whole.component])
    component = tuple(one for one, is_kept in zip(whole.component, kept, strict=True) if is_kept)
    values = {name: rows[kept] for name, rows in whole.values.items()}
    return replace(test, contributions=Contributions(component, values))


@pytest.fixture(scope="module")
def drawn():
    """Errors and standard uncertainties by number, each of its own place: of what is drawn, of all."""
    # by its path: another package has the name of the script
    spec = importlib.util.spec_from_file_location("benchmark_coverage", BENCHMARK)
    tethers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tethers)
    found = defaultdict(list)
    for seed in range(N_DRAWS):
        test = tethers.one_test(np.random.default_rng(1000 + seed))
        place = defaultdict(int)
        both = zip(
            tethers.numbers_of(of_what_is_drawn(test)), tethers.numbers_of(test), strict=True
        )
        for (name, value, truth, random, shared, _), whole in both:
            place[name] += 1
            u, u_whole = (
                float(combined_standard_uncertainty([one], random)) for one in (shared, whole[4])
            )
            found[name, place[name]].append((value - truth, u, u_whole))
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
    # the reduction is not linear in what it leaves to other laws: with them no number is too sure
    for key, (error, u, u_whole) in drawn.items():
        # the tips between readings are the same in all draws, and no scatter
        if key[0] != "strain_amplitude":
            assert ratio_of(error, u) < 1 + AGREE + SAMPLING, key
        assert ratio_of(error, u_whole) > 1 - AGREE - SAMPLING, key


def test_they_agree_closer_over_all_numbers_of_a_kind(drawn):
    """Places of one kind are not all one draw: their mean ratio is known better than each."""
    ratios = defaultdict(list)
    for (name, _), (error, u, _) in drawn.items():
        ratios[name.split(",")[0]].append(ratio_of(error, u))
    for name in ("tangent_modulus", "segment_modulus"):
        assert abs(np.mean(ratios[name]) - 1) < AGREE + SAMPLING / 3, (name, ratios[name])
