"""Array checks shared by physics functions, and parallel execution of blocks."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.samples import BLOCK, any_sample, release_pages, trim_heap_after


def _refuse(name: str, values: Floats, bad: Bools, what: str, needed: str) -> None:
    first = int(np.flatnonzero(bad.ravel())[0])
    raise DataError(
        f"{int(bad.sum())} of {bad.size} values of {name} are {what}, first at index {first}",
        found=f"{values.ravel()[first]:g}",
        needed=needed,
    )


def as_finite(name: str, values: ArrayLike) -> Floats:
    """Return the values as float64, or raise `DataError` if any is not finite."""
    array = np.asarray(values, dtype=np.float64)
    # in a long series, a mask of all samples is made only if one is bad
    if (
        array.ndim == 1
        and array.size > BLOCK
        and not any_sample(lambda part: ~np.isfinite(array[part]), array.size, array)
    ):
        return array
    bad = ~np.isfinite(array)
    if bad.any():
        _refuse(name, array, np.atleast_1d(bad), "not finite", "finite numbers")
    return array


def as_positive(name: str, values: ArrayLike) -> Floats:
    """Return the values as float64, or raise `DataError` if any is not positive."""
    array = as_finite(name, values)
    bad = ~(array > 0)
    if bad.any():
        _refuse(name, array, np.atleast_1d(bad), "not positive", "numbers above zero")
    return array


def as_increasing(name: str, values: ArrayLike) -> Floats:
    """Return a one-dimensional series, or raise `DataError` if it does not increase."""
    array = as_finite(name, values)
    if array.ndim != 1:
        raise DataError(f"{name} is not a series", found=f"shape {array.shape}", needed="1-D")
    if any_sample(lambda part: array[1:][part] <= array[:-1][part], array.size - 1, array):
        bad = np.concatenate([[False], np.diff(array) <= 0])
        _refuse(name, array, bad, "not above the one before", "strictly increasing numbers")
    return array


def as_same_shape(**named: ArrayLike) -> tuple[Floats, ...]:
    """Return the arrays as float64, or raise `DataError` if their shapes differ."""
    arrays = {name: np.asarray(values, dtype=np.float64) for name, values in named.items()}
    shapes = {array.shape for array in arrays.values()}
    if len(shapes) > 1:
        found = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise DataError("series do not pair up", found=found, needed="equal shapes")
    return tuple(arrays.values())


Number = TypeVar("Number", bound=np.generic)

MAD_TO_DEVIATION = 1.4826
"""Standard deviation of a normal error over the median of its magnitude. [1]"""


def noise_of_differences(differences: Floats, weights: float) -> float:
    """Standard deviation of white noise behind finite differences; 0 where none is finite.

    ``weights`` is the sum of the squares of their weights.
    """
    size = np.abs(differences[np.isfinite(differences)])
    return float(MAD_TO_DEVIATION * np.median(size) / np.sqrt(weights)) if size.size else 0.0


def runs_of_true(flags: Bools) -> Integers:
    """First and past-the-last place of each unbroken run of true values, shape (n_runs, 2).

    Examples
    --------
    >>> print(runs_of_true(np.array([True, True, False, True])))
    [[0 2]
     [3 4]]
    """
    return np.flatnonzero(np.diff(flags, prepend=False, append=False)).reshape(-1, 2)


def evenly_spread(values: NDArray[Number], most: int) -> NDArray[Number]:
    """At most ``most`` of some values or rows, spread evenly from the first to the last.

    Examples
    --------
    >>> print(evenly_spread(np.arange(10), 4), evenly_spread(np.arange(3), 4))
    [0 3 6 9] [0 1 2]
    """
    return values[np.linspace(0, len(values) - 1, min(len(values), most)).astype(np.intp)]


def finite_median(values: Floats, *, otherwise: float = float("nan")) -> float:
    """Median of the finite values; ``otherwise`` without any."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else otherwise


def require_of_design(
    what: str, name: str, values: Floats, is_good: Bools, needed: str, unit: str
) -> None:
    """Refuse the first number of a design that is not good, an angle in degrees."""
    if np.all(is_good):
        return
    bad = np.atleast_1d(~is_good)
    found = np.broadcast_to(np.atleast_1d(values), bad.shape)[bad].flat[0]
    where = "" if bad.size == 1 else f" of {int(bad.sum())} of {bad.size} designs"
    raise SettingsError(
        f"{name}{where} is not that of {what}",
        found=f"{np.degrees(found) if unit == 'deg' else found:g} {unit}".rstrip(),
        needed=needed,
    )


def as_spread(name: str, value: float) -> float:
    """Return a standard uncertainty, or raise `SettingsError` if it is negative or unknown."""
    if not (np.isfinite(value) and value >= 0):
        raise SettingsError(
            f"the standard uncertainty of {name} cannot be used",
            found=f"{value:g}",
            needed="zero or more",
        )
    return float(value)


_TOGETHER = 1 << 20  # total samples of simultaneous blocks, if any is long

Item = TypeVar("Item")

Result = TypeVar("Result")


def run_blocks(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    *,
    samples: Sequence[NDArray[Any]] = (),
    longest: int = 1,
) -> list[Result]:
    """Results of a function for each item, in order.

    The number of threads equals the available processors.  The contents of a block must not depend
    on that number, and sums over blocks must be taken from the list, so that a product has the same
    bytes on every machine.

    Examples
    --------
    >>> run_blocks(lambda block: sum(range(block.start, block.stop)), [slice(0, 3), slice(3, 5)])
    [3, 7]
    """
    todo = list(items)

    def run(item: Item) -> Result:
        result = function(item)
        release_pages(*samples)
        return result

    # starting threads takes longer than processing a short series
    is_short = samples and max(one.shape[-1] for one in samples) <= BLOCK
    n_workers = 1 if is_short else min(len(todo), max(1, _TOGETHER // longest))
    if n_workers > 1:
        n_workers = min(n_workers, _n_processors())
    if n_workers < 2:
        results = [run(item) for item in todo]
    else:
        with ThreadPoolExecutor(n_workers) as workers:
            results = list(workers.map(run, todo))
    trim_heap_after(*samples)
    return results


def _n_processors() -> int:
    """Number of processors available to this process.

    OMP_NUM_THREADS also limits it, as in numerical libraries, if several processes share them.
    """
    available = os.cpu_count() or 1
    if hasattr(os, "sched_getaffinity"):
        available = len(os.sched_getaffinity(0))
    asked = os.environ.get("OMP_NUM_THREADS", "")
    return max(1, min(available, int(asked))) if asked.isdecimal() else available
