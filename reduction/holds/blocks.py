"""Means over blocks that grow with time: a night of samples becomes a few hundred numbers.

References
----------
.. [1] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_increasing, as_same_shape
from reduction.errors import DataError
from reduction.record import Floats, read_only_arrays
from reduction.samples.blocks import sample_blocks

BLOCKS_PER_DECADE = 40
LARGEST_WEIGHT = 64.0


@dataclass(frozen=True)
@read_only_arrays
class Blocks:
    """Block means of a series, shape (n_blocks,) each.

    Parameters
    ----------
    elapsed : ndarray
        Mean time of the block. [s]
    value : ndarray
        Mean of the series. [unit of the series]
    count : ndarray
        Samples in the block. [1]
    """

    elapsed: Floats
    value: Floats
    count: Floats

    @property
    def weight(self) -> Floats:
        """Relative inverse variance: the count, of which at most 64 are taken as independent.

        Slow drift of a transducer does not average out, so a block of a million samples
        may not outweigh all others.
        """
        return self.count / (1 + (self.count - 1) / LARGEST_WEIGHT)


def logarithmic_blocks(
    elapsed: ArrayLike, values: ArrayLike, *, per_decade: int = BLOCKS_PER_DECADE
) -> Blocks:
    """Means over blocks of equal length in the logarithm of time.

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time, increasing and positive. [s]
    values : array_like, shape (n_samples,)
        Series. [any unit]
    per_decade : int, optional
        Blocks per decade of time. [1]

    Returns
    -------
    blocks : Blocks
        Blocks that hold a sample, in order. [s], [unit of the series]

    Raises
    ------
    DataError
        If the time does not increase from above zero, or the series do not pair up.

    Notes
    -----
    At 40 blocks a decade a block spans 6 % of its time: an exponential that decays within
    it is off by at most 2e-4 of its size.

    Examples
    --------
    >>> blocks = logarithmic_blocks(np.arange(1.0, 1001.0), np.ones(1000))
    >>> bool(blocks.count.sum() == 1000), blocks.elapsed.size < 121
    (True, True)
    """
    time = as_increasing("elapsed", elapsed)
    time, series = as_same_shape(elapsed=time, values=values)
    if time.size == 0 or time[0] <= 0:
        raise DataError(
            "time does not start above zero",
            found="no samples" if time.size == 0 else f"{time[0]:g} s",
            needed="a positive time",
        )
    begin = time[0]
    last = int(np.log10(time[-1] / begin) * per_decade)
    sums = np.zeros((3, last + 1))
    for part in sample_blocks(time.size, time, series):
        number = np.floor(np.log10(time[part] / begin) * per_decade).astype(np.intp)
        first = np.flatnonzero(np.diff(number, prepend=-1))
        here = np.minimum(number[first], last)  # rounding of a logarithm may pass the last one
        count = np.diff(first, append=number.size)
        np.add.at(sums[0], here, np.add.reduceat(time[part], first))
        np.add.at(sums[1], here, np.add.reduceat(series[part], first))
        np.add.at(sums[2], here, count)
    elapsed_sum, value_sum, count = sums[:, sums[2] > 0]
    return Blocks(elapsed_sum / count, value_sum / count, count)
