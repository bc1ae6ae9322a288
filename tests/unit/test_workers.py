"""Blocks side by side: order, errors, and one answer on any number of processors."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from reduction.record import arrays as workers
from reduction.record import samples as samples
from reduction.record.arrays import run_blocks
from reduction.record.settings import ModulusSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli import local_regression, tangent_modulus
from reduction.stages.moduli.tangent_modulus import tangent_curves


def test_results_come_in_the_order_of_the_items() -> None:
    assert run_blocks(lambda item: item**2, range(100)) == [item**2 for item in range(100)]


def test_no_items_give_no_results() -> None:
    assert run_blocks(str, []) == []


@pytest.mark.parametrize("n_processors", [1, 4])
def test_the_error_of_the_first_item_that_fails_is_raised(
    n_processors: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workers, "_n_processors", lambda: n_processors)
    with pytest.raises(KeyError, match="2"):
        run_blocks({0: 0, 1: 1}.__getitem__, [0, 1, 2, 3])


def test_processors_are_counted_where_there_is_no_affinity(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert run_blocks(str, [1, 2]) == ["1", "2"]


@pytest.mark.parametrize(("asked", "used"), [("1", 1), ("2", 2), ("99", 3), ("0", 1), ("4,2", 3)])
def test_a_process_uses_no_more_processors_than_it_is_told_to(
    asked: str, used: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: {0, 1, 2}, raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", asked)
    assert workers._n_processors() == used


@pytest.mark.parametrize(("longest", "most"), [(1, 4), (1 << 18, 4), (1 << 19, 2), (1 << 21, 1)])
def test_of_long_blocks_fewer_run_at_a_time(
    longest: int, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    class Pool(ThreadPoolExecutor):
        def __init__(self, n_workers: int) -> None:
            asked.append(n_workers)
            super().__init__(n_workers)

    monkeypatch.setattr(workers, "_n_processors", lambda: 4)
    monkeypatch.setattr(workers, "ThreadPoolExecutor", Pool)
    assert run_blocks(str, range(9), longest=longest) == [str(item) for item in range(9)]
    assert asked == ([most] if most > 1 else [])


def test_the_moduli_have_the_same_bytes_on_any_number_of_processors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Blocks are short here, so that 80,000 samples of 400 noisy cycles are several."""
    n_blocks = []

    def counted(function: Any, items: Any, **options: Any) -> list[Any]:
        todo = list(items)
        n_blocks.append(len(todo))
        return run_blocks(function, todo, **options)

    monkeypatch.setattr(local_regression, "_BLOCK_SAMPLES", 1 << 14)
    monkeypatch.setattr(tangent_modulus, "run_blocks", counted)
    n_cycles, half = 400, 100
    rng = np.random.default_rng(3)
    ramp = np.linspace(0.75, 1.25, half)
    strain = np.tile(np.concatenate([ramp, ramp[::-1]]), n_cycles)
    strain = strain + rng.normal(0, 1e-3, strain.size)
    tension = 100 * strain**3 + rng.normal(0, 0.1, strain.size)
    start = 2 * half * np.arange(n_cycles)
    up_down = np.column_stack([start, start + half])
    cycles = Cycles(
        first=start,
        last=start + 2 * half - 1,
        branch_first=up_down,
        branch_last=up_down + half - 1,
        plateau_rate=np.ones((n_cycles, 2)),
        cycle_number=np.repeat(np.arange(1, n_cycles + 1, dtype=np.int32), 2 * half),
        branch=np.tile(np.repeat(np.array([1, 2], dtype=np.int8), half), n_cycles),
        is_in_trimmed_branch=rng.random(strain.size) > 0.1,
        band=0.0,
    )
    found = []
    for n_processors in (1, 3):
        monkeypatch.setattr(workers, "_n_processors", lambda count=n_processors: count)
        curves = tangent_curves(
            strain[None], tension[None], area=[1e-4], cycles=cycles, settings=ModulusSettings()
        )
        found.append((curves.tangent_modulus.tobytes(), curves.tangent_modulus_scatter.tobytes()))
    assert found[0] == found[1]
    # of fewer samples no threads are started
    assert min(n_blocks) > 2 and strain.size > samples.BLOCK
