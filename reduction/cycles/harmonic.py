r"""Fundamental of a series over each cycle, at the cycle's own frequency.

.. math:: y(t) \approx \bar y + a \cos \omega t + b \sin \omega t, \qquad
          \omega = 2\pi / (t_\text{last} - t_\text{first})

References
----------
.. [1] CG-D-39-80, sec. 2.2 and eqs. 1-4: a rope's tension leads its strain; the part in
   phase is stored, the part in quadrature is lost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.cycles.energy import sums_over_cycles
from reduction.errors import DataError
from reduction.record import Floats, Integers, freeze_arrays

__all__ = ["CycleBasis", "cycle_basis", "fundamental"]


@dataclass(frozen=True)
class CycleBasis:
    """Cosine and sine of each sample's phase in its cycle, times its share of the cycle.

    ``cosine`` and ``sine`` have shape (n_samples,) and carry the trapezoid's weights;
    ``first`` and ``last`` are the cycles they were made for.
    """

    cosine: Floats
    sine: Floats
    first: Integers
    last: Integers

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def cycle_basis(time: Floats, first: Integers, last: Integers) -> CycleBasis:
    """Basis of the fundamental, common to all specimens of a test.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time, rising inside a cycle; steps need not be equal. [s]
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle, both inside. [1]

    Returns
    -------
    basis : CycleBasis
        Weighted cosine and sine.

    Raises
    ------
    DataError
        If a cycle takes no time.

    Examples
    --------
    >>> basis = cycle_basis(np.arange(9.0), np.array([0]), np.array([8]))
    >>> bool(abs(basis.sine[:8].sum()) < 1e-15)
    True
    """
    period = time[last] - time[first]
    if not np.all(period > 0):
        bad = int(np.flatnonzero(~(period > 0))[0])
        raise DataError(
            f"cycle {bad + 1} takes no time",
            found=f"{period[bad]:g} s from its first to its last sample",
            needed="a time channel that rises over the cycle",
        )
    weight = np.zeros_like(time)
    np.subtract(time[2:], time[:-2], out=weight[1:-1])
    # the last sample of a cycle has the phase of its first one, so the two ends make one weight
    weight[first] = (time[first + 1] - time[first]) + (time[last] - time[last - 1])
    # one value a sample from one value a cycle, with nothing between cycles
    gaps = np.diff(first, append=time.size) - (last - first)
    lengths = np.column_stack([last - first, gaps]).ravel()
    nothing = np.zeros(first.size)
    begin = int(first[0]) if first.size else time.size
    rate = np.repeat(np.column_stack([2 * np.pi / period, nothing]).ravel(), lengths)
    phase = time[begin:] - np.repeat(np.column_stack([time[first], nothing]).ravel(), lengths)
    phase *= rate
    rate *= weight[begin:]
    rate /= 2 * np.pi
    cosine, sine = np.zeros_like(time), np.zeros_like(time)
    np.multiply(np.cos(phase), rate, out=cosine[begin:])
    np.multiply(np.sin(phase, out=phase), rate, out=sine[begin:])
    return CycleBasis(cosine=cosine, sine=sine, first=first, last=last)


def fundamental(values: Floats, basis: CycleBasis) -> tuple[Floats, Floats]:
    """Cosine and sine amplitude of the fundamental in each cycle.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Without NaN. [any]
    basis : CycleBasis
        From `cycle_basis`.

    Returns
    -------
    cosine, sine : ndarray, shape (n_cycles,)
        Amplitudes, in the unit of the series. [any]

    Raises
    ------
    IndexError
        If the series is shorter than the cycles.

    Notes
    -----
    A drift over the cycle, from its first to its last sample, is taken as linear in time
    and removed: left in, a drift d would add -d/pi to the sine.

    Examples
    --------
    >>> t = np.arange(13.0)
    >>> basis = cycle_basis(t, np.array([0]), np.array([12]))
    >>> a, b = fundamental(7 + 3 * np.cos(2 * np.pi * t / 12) - np.sin(2 * np.pi * t / 12), basis)
    >>> print(a.round(12), b.round(12))
    [3.] [-1.]
    """
    first, last = basis.first, basis.last
    drift = values[last] - values[first]
    cosine = sums_over_cycles(values * basis.cosine, first, last)
    sine = sums_over_cycles(values * basis.sine, first, last)
    # the first sample's weight holds both ends: its value there is the mean of the two
    cosine += drift / 2 * basis.cosine[first]
    return cosine, sine + drift / np.pi
