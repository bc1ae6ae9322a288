"""Where a series most looks as if it steps: matched kernels that are blind to a parabola.

The parts of `reduction.moduli.steps` that work on arrays alone.

References
----------
.. [1] M. Basseville and I. V. Nikiforov, "Detection of Abrupt Changes: Theory and
   Application," Prentice-Hall, 1993, sec. 2.4 (generalized likelihood ratio).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Bools, Floats, Integers

SHORTEST_WINDOW = 8
LONGEST_WINDOW = 128
FIRST_SAMPLE = (
    10  # the softening of the first ten cycles has no common form: no step is dated there
)
MAD_TO_SIGMA = 1.4826


@dataclass(frozen=True)
class Candidate:
    """The strongest response of a scan.

    Parameters
    ----------
    score : float
        Size over its standard deviation where no step is. [1]
    inflation : float
        What coloured noise was taken to add to that deviation. [1]
    onset : int
        Index of the first sample that has changed.
    window, extent : int
        Samples on each side, and over which the step develops. [1]
    """

    score: float
    inflation: float
    onset: int
    window: int
    extent: int


def ramp_of(n_samples: int, *, onset: ArrayLike, extent: ArrayLike) -> Floats:
    """Unit step that develops linearly: 0 before the onset, 1 from the end of the extent.

    Parameters
    ----------
    n_samples : int
        Length of the series. [1]
    onset : array_like of int, shape (...)
        First sample that has changed. [1]
    extent : array_like of int, shape (...)
        Samples over which it develops. [1]

    Returns
    -------
    ramp : ndarray, shape (..., n_samples)
        Share of the step that has happened. [1]

    Raises
    ------
    DataError
        If an extent is not positive.

    Notes
    -----
    A step of extent 1 is complete at its onset.

    Examples
    --------
    >>> ramp_of(6, onset=2, extent=2)
    array([0. , 0. , 0.5, 1. , 1. , 1. ])
    """
    width = np.asarray(extent, dtype=np.float64)[..., None]
    if np.any(width <= 0):
        raise DataError("a step has no extent", found=f"{width.min():g}", needed="1 or more")
    start = np.asarray(onset, dtype=np.float64)[..., None]
    return np.clip((np.arange(n_samples) - start + 1) / width, 0.0, 1.0)


def _parabola(n_samples: int) -> Floats:
    """Orthonormal columns that span every parabola over the samples."""
    x = np.linspace(-1.0, 1.0, n_samples)
    return np.linalg.qr(np.stack([np.ones_like(x), x, x * x], axis=1))[0]


def without_parabola(rows: Floats) -> Floats:
    """Rows less the parabola that fits each best."""
    base = _parabola(rows.shape[-1])
    # einsum, not matrix products: their last digits depend on the number of threads
    share = np.einsum("...i,ij->...j", rows, base)
    level: Floats = rows - np.einsum("...j,ij->...i", share, base)
    return level


def fit_ramps(level: Floats, *, onset: Integers, extent: Integers) -> tuple[Floats, Floats]:
    r"""Least squares of a ramp and a parabola on a series, for many ramps and without making them.

    .. math:: g = r \cdot y, \qquad s = r \cdot r - \sum_j (p_j \cdot r)^2

    with r the ramp of `ramp_of`, y the series and p an orthonormal basis of the parabolas.  A
    product with a ramp of onset o and extent w is that of a slope from o on and of ones from its
    end on, :math:`\frac{1}{w} \sum_{i=o}^{o+w-1} (i - o + 1) c_i + \sum_{i \ge o+w} c_i`, which are
    differences of running sums of :math:`c_i` and :math:`i c_i`.

    Parameters
    ----------
    level : ndarray, shape (n_samples,)
        Series, the parabola that fits it taken out. [any unit]
    onset, extent : ndarray of int, shape (n_ramps,)
        Of the ramps, each of which ends within the series. [1]

    Returns
    -------
    product : ndarray, shape (n_ramps,)
        Of each ramp with the series; over the power it is the size of the step, and its square over
        the power what the step takes from the sum of squares. [unit of the series]
    power : ndarray, shape (n_ramps,)
        Sum of squares of the ramp less the parabola that fits it best. [1]

    Raises
    ------
    IndexError
        If a ramp does not end within the series.

    Examples
    --------
    >>> level = without_parabola(3.0 * ramp_of(40, onset=15, extent=4))
    >>> product, power = fit_ramps(level, onset=np.array([15]), extent=np.array([4]))
    >>> print((product / power).round(6))
    [3.]
    """
    ones, slopes = _sums_from(level)
    end, width = onset + extent, extent.astype(np.float64)
    rising = slopes[onset] - slopes[end] + (1.0 - onset)[:, None] * (ones[onset] - ones[end])
    products = rising / width[:, None] + ones[end]
    squares = (width + 1) * (2 * width + 1) / (6 * width) + (level.size - end)
    return products[:, 0], squares - np.sum(products[:, 1:] ** 2, axis=1)


def fit_kinks(level: Floats, *, onset: Integers) -> tuple[Floats, Floats]:
    """As `fit_ramps`, of changes of slope that begin after an onset and go on to the end."""
    ones, slopes = _sums_from(level)
    products = slopes[onset] - onset[:, None] * ones[onset]
    last = (level.size - 1 - onset).astype(np.float64)
    squares = last * (last + 1) * (2 * last + 1) / 6
    return products[:, 0], squares - np.sum(products[:, 1:] ** 2, axis=1)


def _sums_from(level: Floats) -> tuple[Floats, Floats]:
    """Sums from each sample on: of a series and parabolas, and of both times the index."""
    columns = np.column_stack([level, _parabola(level.size)])
    count = np.arange(level.size)[:, None]
    ones, slopes = (
        np.concatenate([np.cumsum(part[::-1], axis=0)[::-1], np.zeros((1, columns.shape[1]))])
        for part in (columns, columns * count)
    )
    return ones, slopes


def without_background(values: Floats, ramps: Floats | None = None) -> Floats:
    """Series less what creep and softening look like over the whole of it.

    Only a smooth function of log-like form is taken out, so a step remains a step; known
    ``ramps``, shape (n_steps, n_samples), are fitted beside it and stay in.
    """
    n_samples = values.size
    count = np.arange(1.0, n_samples + 1)
    times = 2.0 ** np.arange(0, max(1, int(np.log2(n_samples / 8)) + 1))
    columns = [np.ones(n_samples), count / n_samples, np.log(count)]
    columns += [np.exp(-(count - 1) / time) for time in times]
    smooth = np.stack(columns, axis=1)
    basis = smooth if ramps is None else np.concatenate([smooth, ramps.T], axis=1)
    size = np.linalg.lstsq(basis, values)[0][: smooth.shape[1]]
    residual: Floats = values - smooth @ size
    return residual


def neighbour_noise(values: Floats) -> float:
    """Standard deviation of the noise, from neighbours; steps and wild samples left out."""
    squares = np.sort(np.diff(values) ** 2)
    kept = squares[: max(1, int(np.ceil(0.98 * squares.size)))]
    # Dropping the largest 2 % of Gaussian differences takes 13 % of their mean square.
    return float(np.sqrt(kept.mean() / 2 / 0.87))


def without_outliers(values: Floats) -> Floats:
    """Replace single wild samples by the running median of five, which keeps every edge."""
    padded = np.pad(values, 2, mode="edge")
    median = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=-1)
    distance = np.abs(values - median)
    # The median alone would take a rounded series for free of noise.
    spread = max(MAD_TO_SIGMA * float(np.median(distance)), neighbour_noise(values))
    return np.where(distance > 6 * spread, median, values)


def _windows(n_samples: int) -> list[tuple[int, int]]:
    """Pairs of window and extent that are scanned, powers of two."""
    longest = min(LONGEST_WINDOW, max(SHORTEST_WINDOW, n_samples // 4))
    sizes = SHORTEST_WINDOW * 2 ** np.arange(int(np.log2(longest / SHORTEST_WINDOW)) + 1)
    return [
        (int(size), 2**power)
        for size in sizes
        for power in range(int(np.log2(size)) + 1)
        if 2 * size + 2**power <= n_samples
    ]


@cache
def _kernel(window: int, extent: int) -> Floats:
    """Weights that give the size of a step in the middle of a window, blind to a parabola."""
    ramp = without_parabola(ramp_of(2 * window + extent, onset=window, extent=extent))
    kernel: Floats = ramp / np.sum(ramp * ramp)
    kernel.flags.writeable = False
    return kernel


def _colour(size: Floats, onset: Integers, white: float, reach: int) -> float | None:
    """Spread of a kernel's responses over that of white noise; None where they are too few.

    What the strongest response touches is left out: it may be a step.
    """
    top = onset[np.argmax(np.abs(size))]
    rest = size[np.abs(onset - top) > reach]
    if rest.size < reach:
        return None
    return MAD_TO_SIGMA * float(np.median(np.abs(rest))) / white


def noise_memory(residual: Floats) -> float:
    """Spread of a long mean of autoregressive noise over what its differences suggest."""
    power = max(float(residual @ residual), np.finfo(float).tiny)
    lag_one = min(0.95, max(0.0, float(residual[1:] @ residual[:-1]) / power))
    return float(np.sqrt(1 + lag_one) / (1 - lag_one))


def strongest_response(
    values: Floats, *, noise: float, allowed: Bools
) -> tuple[Candidate | None, int]:
    """Strongest response over every window, extent and onset, and how many were tried.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        Series, its smooth background taken out. [any unit]
    noise : float
        Standard deviation of single samples. [unit of the series]
    allowed : ndarray of bool, shape (n_samples,)
        Where an onset may lie. [1]

    Returns
    -------
    candidate : Candidate or None
        None where no onset is allowed.
    tried : int
        Number of windows, extents and onsets. [1]

    Raises
    ------
    ValueError
        If the series is shorter than a window.

    Notes
    -----
    Windows of 8 to 128 samples on each side, at most a quarter of the series; extents of 1
    to the window; powers of two ([1]_).

    Examples
    --------
    >>> series = 1.0 * (np.arange(200) >= 120)
    >>> found, _ = strongest_response(series, noise=0.1, allowed=np.ones(200, dtype=bool))
    >>> found.onset, found.extent
    (120, 1)
    """
    best: Candidate | None = None
    tried = 0
    inflation = 1.0
    length = scipy.fft.next_fast_len(max(1, values.size), real=True)
    spectrum = scipy.fft.rfft(values, length)
    for window, extent in _windows(values.size):
        kernel = _kernel(window, extent)
        # product with the kernel at every place; those that run over the end are left out
        product = scipy.fft.irfft(spectrum * scipy.fft.rfft(kernel, length).conj(), length)
        size = product[: values.size - kernel.size + 1]
        onset = np.arange(size.size) + window
        keep = (onset >= max(2 * window, window + FIRST_SAMPLE)) & allowed[onset]
        if not keep.any():
            continue
        size, onset = size[keep], onset[keep]
        white = noise * float(np.linalg.norm(kernel))
        # Coloured noise shows in the responses; a long window sees at least the colour that
        # a short one does.
        colour = _colour(size, onset, white, 2 * window + extent)
        inflation = max(inflation, colour or 1.0)
        assumed = max(1.0, colour or inflation)
        tried += size.size
        top = int(np.argmax(np.abs(size)))
        score = float(size[top]) / (white * assumed)
        if best is None or abs(score) > abs(best.score):
            best = Candidate(score, assumed, int(onset[top]), window, extent)
    return best, tried
