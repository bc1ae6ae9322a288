"""Cyclic tests made from a law, for the tests of the stages that reduce them."""

from pathlib import Path

import hypothesis
import numpy as np
import pytest
from visits import browser, visit

from reduction.cycles.product import Cycles

# an example takes as long as the machine lets it: others may work beside
hypothesis.settings.register_profile("any machine", deadline=None)
hypothesis.settings.load_profile("any machine")

# needs atheris, and is run by hand
collect_ignore = ["fuzz_readers.py"]

# each takes minutes; the first makes the campaigns that others read, and would wait for
LONGEST = (
    "browser/test_campaign_pages.py", "docs/test_docs_build.py", "cli/test_run_workers.py",
    "browser/test_design_values.py",
)  # fmt: skip


def pytest_collection_modifyitems(items):
    """The longest files come first, so that no process is left alone with one at the end."""
    tests = Path(__file__).parent
    places = {tests / name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: places.get(item.path, len(LONGEST)))


# a process of the tests has one browser, whichever folder asks for it first
__all__ = ["browser", "visit"]


def make_triangle(
    n_cycles=10, per_cycle=100, low=1.0, high=1.5, *, trimmed=0, begins="valley", phase=0.0
):
    """Strain of a triangular test and its cycles; ``trimmed`` samples go from each branch end."""
    half = per_cycle // 2
    n_samples = 2 * half * n_cycles + 1
    turn = np.arange(2 * n_cycles + 1) * half
    strain = (
        low
        + (high - low) * np.abs((np.arange(n_samples) + phase + half) % (2 * half) - half) / half
    )
    if begins == "peak":
        strain = low + high - strain
    edges = np.stack([turn[:-1], turn[1:]], axis=-1).reshape(n_cycles, 2, 2)
    ascending, descending = (0, 1) if begins == "valley" else (1, 0)
    half_number = np.minimum(np.arange(n_samples) // half, 2 * n_cycles - 1)
    within = np.arange(n_samples) - half * half_number
    first_is_up = begins == "valley"
    cycles = Cycles(
        first=turn[:-1:2],
        last=turn[2::2],
        branch_first=edges[:, [ascending, descending], 0],
        branch_last=edges[:, [ascending, descending], 1],
        plateau_rate=np.ones((n_cycles, 2)),
        cycle_number=(half_number // 2 + 1).astype(np.int32),
        branch=np.where((half_number % 2 == 0) == first_is_up, 1, 2).astype(np.int8),
        is_constant_rate=(within >= trimmed) & (within <= half - trimmed),
        band=0.01,
    )
    return strain, cycles


@pytest.fixture(scope="session")
def triangle():
    return make_triangle
