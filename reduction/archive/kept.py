"""Which samples of a test are stored: all, or of a long log those of selected cycles.

Outside the selected cycles nothing is left out that is outside cycles, unless it is more than a
quarter of a long log: what rests, holds and the way to the first cycle show is drawn from samples,
and there is seldom much of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.cycles.product import Cycles
from reduction.moduli.groups import select_cycles
from reduction.product import ReducedTest
from reduction.record import UNUSABLE, Floats, Integers, freeze_arrays
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.settings import ReductionSettings

__all__ = ["KeptSamples", "SamplePlaces", "kept_samples", "select_places", "stored_cycles"]

_MOST_STRETCHES = 1000
_SHARE = 4  # of the longest record that is stored whole: the most that is stored of a longer one


@dataclass(frozen=True)
class SamplePlaces:
    """Samples that are stored, and how they were chosen.

    Parameters
    ----------
    index : ndarray of int, shape (n_stored,)
        Places in the record, from 0, rising. [1]
    thinned : ndarray of int, shape (n_thinned, 2)
        First place of each stretch that is thinned, and the one after its last. [1]
    n_left_out : int
        Stretches between cycles of which nothing is stored. [1]
    """

    index: Integers
    thinned: Integers
    n_left_out: int

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

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
    """
    record, wanted = test.record, settings.archive
    if record is None or wanted.samples == "all":
        return None
    if wanted.samples is None and record.n_samples <= wanted.longest_record:
        return None
    numbers = _cycles_with_curves(test, settings.modulus.selected_cycles)
    places = select_places(
        record.n_samples, test.cycles, numbers, most=wanted.longest_record // _SHARE
    )
    index = np.union1d(places.index, _extremes(test, places.thinned))
    if index.size == record.n_samples:
        return None
    words = _words(places, index.size, record.n_samples, numbers, test.cycles)
    return KeptSamples(
        index=index,
        words=words,
        note=f"samples are stored in part: {words}; every number was made from the whole record, "
        'of which reduction.archive.samples = "all" stores every sample',
    )


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


def _cycles_with_curves(test: ReducedTest, longest: int) -> Integers:
    if test.cycles is None or not test.cycles.n_cycles:
        return np.empty(0, dtype=np.int64)
    numbers = select_cycles(test.cycles.n_cycles, longest=longest)
    # curves that pool cycles go by the first of them
    return numbers if test.curves is None else np.union1d(numbers, test.curves.selected_cycle)


def select_places(
    n_samples: int, cycles: Cycles | None, numbers: Integers, *, most: int
) -> SamplePlaces:
    """Choose places of a record: selected cycles, and what is outside cycles.

    Parameters
    ----------
    n_samples : int
        Of the record. [1]
    cycles : Cycles or None
        Of the record.
    numbers : ndarray of int, shape (n_selected,)
        Numbers of the selected cycles, from 1. [1]
    most : int
        Samples that may be stored. [1]

    Returns
    -------
    places : SamplePlaces
        Of stretches between cycles: the first, the last, those beside a selected cycle and the
        thousand longest others. Where all of this together is more than ``most``, the longest
        cycles and stretches are thinned to a common number of samples: a cycle to every k-th;
        of a stretch a quarter are its first ones, a quarter its last, the others every k-th
        between them.

    Examples
    --------
    >>> places = select_places(1000, None, np.empty(0, dtype=int), most=12)
    >>> print(places.index)
    [  0   1   2   3 169 335 501 667 833 997 998 999]
    """
    first, last = (
        (np.empty(0, dtype=np.int64),) * 2 if cycles is None else (cycles.first, cycles.last)
    )
    start = np.concatenate([[0], last + 1])
    stop = np.concatenate([first, [n_samples]])
    beside = np.zeros(start.size, dtype=bool)
    beside[[0, -1]] = True
    beside[numbers - 1] = True
    beside[numbers] = True
    long = np.zeros(start.size, dtype=bool)
    long[np.argsort(start - stop, kind="stable")[:_MOST_STRETCHES]] = True
    is_stretch = stop > start
    kept = is_stretch & (beside | long)
    pieces = np.concatenate(
        [
            np.column_stack([start[kept], stop[kept], np.ones(np.count_nonzero(kept), int)]),
            np.column_stack([first[numbers - 1], last[numbers - 1] + 1, np.zeros_like(numbers)]),
        ]
    )
    lengths = pieces[:, 1] - pieces[:, 0]
    level = _common_length(lengths, most)
    index = [
        _thinned(begin, end, level, has_ends=bool(outside))
        for begin, end, outside in pieces.tolist()
    ]
    return SamplePlaces(
        np.unique(
            np.concatenate(index)
        ),  # two cycles share the sample at which one turns to the other
        pieces[lengths > level, :2],
        int(np.count_nonzero(is_stretch & ~kept)),
    )


def _common_length(lengths: Integers, most: int) -> int:
    """Greatest length to which the longer pieces can be cut so that all are ``most`` or less."""
    low, high = 8, int(max(lengths.max(initial=0), 8))
    while low < high:
        middle = (low + high + 1) // 2
        if np.minimum(lengths, middle).sum() <= most:
            low = middle
        else:
            high = middle - 1
    return low


def _thinned(start: int, stop: int, length: int, *, has_ends: bool) -> Integers:
    if stop - start <= length:
        return np.arange(start, stop)
    begin, end = (length // 4, length // 4) if has_ends else (0, 1)
    step = ceil((stop - start - begin - end) / (length - begin - end))
    return np.concatenate(
        [
            np.arange(start, start + begin),
            np.arange(start + begin, stop - end, step),
            np.arange(stop - end, stop),
        ]
    )


def _extremes(test: ReducedTest, thinned: Integers) -> Integers:
    """Places of the least and the greatest value of each channel in what is thinned."""
    record = test.record
    if record is None or not thinned.size:
        return np.empty(0, dtype=np.int64)
    channels: list[tuple[Floats, Integers | None]] = [
        (record.crosshead_position, record.crosshead_position_quality_flag),
        *zip(record.tension, record.quality_flag, strict=True),
    ]
    if test.strain is not None:
        channels += [(row, None) for row in test.strain]
    return np.unique([_ends(*channel, thinned.tolist()) for channel in channels])


def _ends(
    values: Floats, flags: Integers | None, stretches: Sequence[Sequence[int]]
) -> tuple[int, int]:
    """Places of the least and the greatest usable value."""
    series = (values,) if flags is None else (values, flags)
    low = high = (np.inf, int(stretches[0][0]))
    for start, stop in stretches:
        for part in sample_blocks(stop - start, *series):
            here = slice(start + part.start, start + part.stop)
            known = np.isfinite(values[here])
            if flags is not None:
                known &= (flags[here] & UNUSABLE) == 0
            for sign in (1, -1):
                own = np.where(known, sign * values[here], np.inf)
                place = int(np.argmin(own))
                found = (float(own[place]), here.start + place)
                low, high = (min(low, found), high) if sign == 1 else (low, min(high, found))
    return low[1], high[1]


def _words(
    places: SamplePlaces, n_stored: int, n_samples: int, numbers: Integers, cycles: Cycles | None
) -> str:
    found = [f"{n_stored} of {n_samples}"]
    if cycles is not None and numbers.size:
        listed = ", ".join(str(number) for number in numbers)
        found.append(
            f"{numbers.size} of {cycles.n_cycles} cycles ({listed}) and what is in no cycle"
        )
    if places.n_left_out:
        found.append(f"{places.n_left_out} of the shorter stretches between cycles are left out")
    if places.thinned.size:
        found.append(
            f"{len(places.thinned)} of the longest cycles and stretches in no cycle are thinned to "
            "every k-th sample, between their ends and with the least and the greatest of each "
            "channel"
        )
    return "; ".join(found)
