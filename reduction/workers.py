"""Blocks of work side by side: the same answer, in the same order, on any number of processors."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from numpy.typing import NDArray

from reduction.samples.scratch import give_back, let_go

_TOGETHER = 1 << 20  # samples of blocks that run at a time, if one is long

Item = TypeVar("Item")
Result = TypeVar("Result")


def run_blocks(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    *,
    samples: Sequence[NDArray[Any]] = (),
    longest: int = 1,
) -> list[Result]:
    """Results of a function for each item, in the order of the items.

    The blocks run in as many threads as the process may use processors.  What a block
    holds must not depend on that number, and sums over blocks must be taken from the list,
    so that a product has the same bytes on every machine.

    Parameters
    ----------
    function : callable
        Of one item; changes nothing that another block reads or writes.
    items : iterable
        The blocks.
    samples : sequence of ndarray
        Series that the blocks read or write; those on disk are let go behind each block.
    longest : int
        Samples of the longest block: of long ones fewer run at a time, lest their memory grows
        with the processors. [1]

    Returns
    -------
    results : list
        One an item.

    Raises
    ------
    Exception
        What the function raises for the first item for which it does.

    Examples
    --------
    >>> run_blocks(lambda block: sum(range(block.start, block.stop)), [slice(0, 3), slice(3, 5)])
    [3, 7]
    """
    todo = list(items)

    def run(item: Item) -> Result:
        result = function(item)
        let_go(*samples)
        return result

    n_workers = min(_n_processors(), len(todo), max(1, _TOGETHER // longest))
    if n_workers < 2:
        results = [run(item) for item in todo]
    else:
        with ThreadPoolExecutor(n_workers) as workers:
            results = list(workers.map(run, todo))
    give_back(*samples)
    return results


def _n_processors() -> int:
    """Processors this process may use: of those of the machine, as many as it is given.

    OMP_NUM_THREADS says so too, as to numerical libraries, where several processes share them.
    """
    available = os.cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        available = len(os.sched_getaffinity(0))
    asked = os.environ.get("OMP_NUM_THREADS", "")
    return max(1, min(available, int(asked))) if asked.isdecimal() else available
