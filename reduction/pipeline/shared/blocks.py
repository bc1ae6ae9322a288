"""Blocks of cycles: what shared errors do to each cycle is worked out for some at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np

from reduction.cycles.product import Cycles
from reduction.product import ReducedTest

# every component has a row of each quantity of each cycle
_BLOCK = 1 << 14

Product = TypeVar("Product")


def blocks_of_cycles(n_cycles: int) -> Iterator[slice]:
    """Slices that cover the cycles of a test."""
    for start in range(0, n_cycles, _BLOCK):
        yield slice(start, min(start + _BLOCK, n_cycles))


def cycles_of_test(test: ReducedTest, block: slice) -> ReducedTest:
    """The test with the quantities of some of its cycles; means and curves stay those of all."""
    if test.cycles is None:
        return test
    return replace(
        test,
        cycles=_cycles(test.cycles, block),
        loops=_part(test.loops, block),
        end_moduli=_part(test.end_moduli, block),
        line=_part(test.line, block),
    )


def _cycles(cycles: Cycles, block: slice) -> Cycles:
    return replace(
        cycles,
        first=cycles.first[block],
        last=cycles.last[block],
        branch_first=cycles.branch_first[block],
        branch_last=cycles.branch_last[block],
        plateau_rate=cycles.plateau_rate[block],
    )


def _part(product: Product, block: slice) -> Product:
    """A product whose arrays have shape (n_specimens, n_cycles, ...), of some of the cycles."""
    if product is None:
        return product
    changes: dict[str, Any] = {}
    for item in fields(product):  # type: ignore[arg-type]
        value = getattr(product, item.name)
        if isinstance(value, np.ndarray):
            changes[item.name] = value[:, block]
        elif isinstance(value, dict):
            changes[item.name] = {name: array[:, block] for name, array in value.items()}
    return replace(product, **changes)  # type: ignore[type-var]
