"""Which samples of a test are stored: all, or of a long log those of selected cycles.

What is in no cycle is stored too: what rests, holds and the way to the first cycle show is drawn
from samples, and there is seldom much of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.moduli.groups import select_cycles
from reduction.product import ReducedTest
from reduction.record import Integers, read_only_arrays
from reduction.samples.blocks import take_samples
from reduction.settings import ReductionSettings

_SHARE = 8
"""Of a longer record than is stored whole, this part of it at most for cycles, and for the rest."""


@dataclass(frozen=True)
@read_only_arrays
class KeptSamples:
    """What is stored of a record that is not stored whole.

    Parameters
    ----------
    index : ndarray of int, shape (n_stored,)
        Places in the record, from 0, rising. [1]
    words : str
        What they are, for the archive.
    note : str
        The same for a reader of the notes.
    """

    index: Integers
    words: str
    note: str

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the stored samples of a series, shape (..., n_stored)."""
        return take_samples(values, self.index)


def kept_samples(test: ReducedTest, settings: ReductionSettings) -> KeptSamples | None:
    """Choose the samples of a test that its archive holds.

    Parameters
    ----------
    test : ReducedTest
        All that one log gave.
    settings : ReductionSettings
        In force: ``archive``, and how many cycles' curves are kept.

    Returns
    -------
    kept : KeptSamples or None
        None where every sample is stored: on request, of a log of ``longest_record`` samples or
        fewer, and of a test without a log.

    Notes
    -----
    Stored are the selected cycles and what is in no cycle, each of them whole unless it is more
    than an eighth of ``longest_record``: then evenly spaced samples of it, with the ends.
    """
    record, wanted = test.record, settings.archive
    if record is None or wanted.samples == "all":
        return None
    if wanted.samples is None and record.n_samples <= wanted.longest_record:
        return None
    numbers = _cycles_with_curves(test, settings.modulus.selected_cycles)
    first, last = (
        (np.empty(0, dtype=np.int64),) * 2
        if test.cycles is None
        else (test.cycles.first, test.cycles.last)
    )
    most = wanted.longest_record // _SHARE
    of_cycles, step = _places(first[numbers - 1], last[numbers - 1] + 1, most)
    outside, step_outside = _places(
        np.concatenate([[0], last + 1]), np.concatenate([first, [record.n_samples]]), most
    )
    # two cycles share the sample at which one turns to the other
    index = np.union1d(of_cycles, outside)
    if index.size == record.n_samples:
        return None
    words = f"{index.size} of {record.n_samples}"
    if numbers.size:
        listed = ", ".join(map(str, numbers))
        words += f"; {numbers.size} of {first.size} cycles ({listed}){_every(step)}"
    words += f"; what is in no cycle{_every(step_outside)}"
    return KeptSamples(
        index=index,
        words=words,
        note=f"samples are stored in part: {words}; every number was made from the whole record, "
        'of which reduction.archive.samples = "all" stores every sample',
    )


def _cycles_with_curves(test: ReducedTest, longest: int) -> Integers:
    if test.cycles is None or not test.cycles.n_cycles:
        return np.empty(0, dtype=np.int64)
    numbers = select_cycles(test.cycles.n_cycles, longest=longest)
    # curves that pool cycles go by the first of them
    return numbers if test.curves is None else np.union1d(numbers, test.curves.selected_cycle)


def _places(start: Integers, stop: Integers, most: int) -> tuple[Integers, int]:
    """Every k-th sample of stretches and the last of each, about ``most`` in all; and k."""
    is_stretch = stop > start
    start, stop = start[is_stretch], stop[is_stretch]
    step = max(1, -(-int((stop - start).sum()) // most))
    pairs = zip(start.tolist(), stop.tolist(), strict=True)
    return np.concatenate([stop - 1, *(np.arange(*pair, step) for pair in pairs)]), step


def _every(step: int) -> str:
    return "" if step == 1 else f", one sample in {step} of it and its ends"


def stored_cycles(dataset: xr.Dataset) -> Integers:
    """Return the numbers of the cycles whose samples an archive holds.

    One that is not among them can have both its ends there, since two cycles share the sample at
    which one turns to the other; that sample goes by the number of the later one.

    Parameters
    ----------
    dataset : xarray.Dataset
        The archive.

    Returns
    -------
    numbers : ndarray of int, shape (n_stored,)
        From 1; none where the test has no cycles. [1]
    """
    if "cycle" not in dataset:
        return np.empty(0, dtype=np.int64)
    numbers: Integers = dataset.variables["cycle"].values
    if "sample_index" not in dataset:
        return numbers
    index = dataset.variables["sample_index"].values
    begin = np.searchsorted(index, dataset.variables["cycle_first_sample"].values, side="left")
    end = np.searchsorted(index, dataset.variables["cycle_last_sample"].values, side="right")
    return numbers[end - begin > 2]
