"""Steps in an evenly sampled series, told apart from smooth drift, at a stated false-alarm rate.

The series is the sum of a smooth background (constant, drift, logarithmic creep, a
softening transient at the start), noise, and possibly steps, each of which may take
many samples to develop.  A step is looked for with matched kernels that do not see a
local parabola, so that drift and its curvature cannot pass for a step; its onset and
extent are then found by least squares, exactly, on the samples around it.

References
----------
.. [1] M. Basseville and I. V. Nikiforov, "Detection of Abrupt Changes: Theory and
   Application," Prentice-Hall, 1993, sec. 2.4 (generalized likelihood ratio).
.. [2] P. Fryzlewicz, "Wild binary segmentation for multiple change-point detection,"
   Ann. Statist. 42(6), 2014 (strongest first, local windows).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import oaconvolve
from scipy.stats import chi2, norm

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.moduli.noise import sample_noise
from reduction.record import Bools, Floats

__all__ = ["Step", "find_steps", "ramp_of", "step_sizes"]

SHORTEST_WINDOW = 8
LONGEST_WINDOW = 128
FIRST_SAMPLE = (
    10  # the softening of the first ten cycles has no common form: no step is dated there
)
MOST_STEPS = 30
MAD_TO_SIGMA = 1.4826


@dataclass(frozen=True)
class Step:
    """One step of a series.

    Parameters
    ----------
    onset : int
        Index of the first sample that has changed.
    extent : int
        Samples over which the step develops; 1 for an abrupt one. [1]
    onset_low, onset_high : int
        95 % range of the onset.
    end_high : int
        Latest sample, at 95 %, at which the step is still developing.
    size : float
        Change of level. [unit of the series]
    size_standard_uncertainty : float
        Of the size. [unit of the series]
    score : float
        Size over its standard deviation where no step is. [1]
    """

    onset: int
    extent: int
    onset_low: int
    onset_high: int
    end_high: int
    size: float
    size_standard_uncertainty: float
    score: float

    @property
    def end(self) -> int:
        """Index of the last sample in which the step still develops."""
        return self.onset + self.extent - 1


@dataclass(frozen=True)
class _Candidate:
    score: float
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


def _without_parabola(rows: Floats) -> Floats:
    base = _parabola(rows.shape[-1])
    return rows - (rows @ base) @ base.T


def _without_background(values: Floats) -> Floats:
    """Subtract what creep and softening look like over the whole series.

    Only a smooth function of log-like form is taken out, so a step remains a step.
    """
    n_samples = values.size
    count = np.arange(1.0, n_samples + 1)
    times = 2.0 ** np.arange(0, max(1, int(np.log2(n_samples / 8)) + 1))
    columns = [np.ones(n_samples), count / n_samples, np.log(count)]
    columns += [np.exp(-(count - 1) / time) for time in times]
    basis = np.stack(columns, axis=1)
    residual: Floats = values - basis @ np.linalg.lstsq(basis, values)[0]
    return residual


def _noise(values: Floats) -> float:
    """Standard deviation of the noise, from neighbours; steps and wild samples left out."""
    squares = np.sort(np.diff(values) ** 2)
    kept = squares[: max(1, int(np.ceil(0.98 * squares.size)))]
    # Dropping the largest 2 % of Gaussian differences takes 13 % of their mean square.
    return float(np.sqrt(kept.mean() / 2 / 0.87))


def _without_outliers(values: Floats) -> Floats:
    """Replace single wild samples by the running median of five, which keeps every edge."""
    padded = np.pad(values, 2, mode="edge")
    median = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=-1)
    distance = np.abs(values - median)
    # The median alone would take a rounded series for free of noise.
    spread = max(MAD_TO_SIGMA * float(np.median(distance)), _noise(values))
    return np.where(distance > 6 * spread, median, values)


def _windows(n_samples: int) -> list[tuple[int, int]]:
    """Pairs of window and extent that are scanned, powers of two."""
    longest = min(LONGEST_WINDOW, max(SHORTEST_WINDOW, n_samples // 8))
    sizes = SHORTEST_WINDOW * 2 ** np.arange(int(np.log2(longest / SHORTEST_WINDOW)) + 1)
    return [
        (int(size), 2**power)
        for size in sizes
        for power in range(int(np.log2(size)) + 1)
        if 2 * size + 2**power <= n_samples
    ]


def _kernel(window: int, extent: int) -> Floats:
    """Weights that give the size of a step in the middle of a window, blind to a parabola."""
    ramp = _without_parabola(ramp_of(2 * window + extent, onset=window, extent=extent))
    kernel: Floats = ramp / np.sum(ramp * ramp)
    return kernel


def _scan(values: Floats, sigma: float, allowed: Bools) -> tuple[_Candidate | None, int]:
    """Strongest response over every window, extent and onset, and how many were tried."""
    best: _Candidate | None = None
    tried = 0
    for window, extent in _windows(values.size):
        kernel = _kernel(window, extent)
        size = oaconvolve(values, kernel[::-1], mode="valid")
        onset = np.arange(size.size) + window
        keep = (onset >= max(2 * window, window + FIRST_SAMPLE)) & allowed[onset]
        if not keep.any():
            continue
        size, onset = size[keep], onset[keep]
        # Coloured noise shows in the response itself; white noise is known better than that.
        spread = MAD_TO_SIGMA * float(np.median(np.abs(size)))
        score = size / max(spread, sigma * float(np.linalg.norm(kernel)))
        tried += size.size
        top = int(np.argmax(np.abs(score)))
        if best is None or abs(score[top]) > abs(best.score):
            best = _Candidate(float(score[top]), int(onset[top]), window, extent)
    return best, tried


def _refine(values: Floats, candidate: _Candidate, sigma: float) -> tuple[Step, bool]:
    """Onset and extent by least squares around a candidate; False where a kink does as well."""
    reach = 2 * max(candidate.window, candidate.extent)
    first = max(0, candidate.onset - reach, candidate.onset // 2)
    last = min(values.size, candidate.onset + candidate.extent + reach)
    n_local = last - first
    local = _without_parabola(values[first:last])
    widest = max(4, min(2 * candidate.window, n_local // 3))
    onsets = np.arange(
        max(2, candidate.onset - first - candidate.window),
        min(n_local - 3, candidate.onset - first + candidate.extent + candidate.window // 2),
    )
    extents = np.unique(np.geomspace(1, widest, 40).astype(int))
    onset, extent = (grid.ravel() for grid in np.meshgrid(onsets, extents, indexing="ij"))
    inside = onset + extent <= n_local - 2
    onset, extent = onset[inside], extent[inside]
    ramps = _without_parabola(ramp_of(n_local, onset=onset, extent=extent))
    power = np.sum(ramps * ramps, axis=1)
    product = ramps @ local
    gain = product**2 / power
    best = int(np.argmax(gain))
    variance = max(sigma**2, (float(local @ local) - float(gain[best])) / max(1, n_local - 6))
    near = gain >= gain[best] - variance * float(chi2.isf(0.05, 2))

    kinks = _without_parabola(np.maximum(0.0, np.arange(n_local) - onsets[:, None]))
    kink_gain = float(np.max((kinks @ local) ** 2 / np.sum(kinks * kinks, axis=1)))
    is_step = float(gain[best]) - kink_gain > variance * 10 and extent[best] < widest
    step = Step(
        onset=int(onset[best]) + first,
        extent=int(extent[best]),
        onset_low=int(onset[near].min()) + first,
        onset_high=int(onset[near].max()) + first,
        end_high=int((onset + extent - 1)[near].max()) + first,
        size=float(product[best] / power[best]),
        size_standard_uncertainty=float(np.sqrt(variance / power[best])),
        score=candidate.score,
    )
    return step, bool(is_step)


def _is_recovery(step: Step, earlier: list[Step], reach: int) -> bool:
    """Return whether a change belongs to a larger, opposite step just before it.

    A viscoelastic specimen that has been let out a little recovers part of the loss.
    """
    return any(
        other.size * step.size < 0
        and abs(step.size) < 0.5 * abs(other.size)
        and -reach <= step.onset - other.end <= 2 * reach
        for other in earlier
    )


def _joined(steps: list[Step]) -> tuple[Step, ...]:
    """Join steps of one sign that touch: parts of one step that does not develop evenly."""
    joined: list[Step] = []
    for step in sorted(steps, key=lambda step: step.onset):
        last = joined[-1] if joined else None
        if last is None or last.size * step.size < 0 or step.onset > last.end + last.extent:
            joined.append(step)
            continue
        larger = max(last, step, key=lambda part: abs(part.size))
        joined[-1] = Step(
            # A part much smaller than the other belongs to the shape and does not date it.
            onset=last.onset if abs(last.size) > 0.2 * abs(larger.size) else step.onset,
            extent=max(last.end, step.end) - last.onset + 1,
            onset_low=last.onset_low,
            onset_high=larger.onset_high,
            end_high=max(last.end_high, step.end_high),
            size=last.size + step.size,
            size_standard_uncertainty=float(
                np.hypot(last.size_standard_uncertainty, step.size_standard_uncertainty)
            ),
            score=larger.score,
        )
    return tuple(joined)


def find_steps(values: ArrayLike, *, false_alarm: float) -> tuple[Step, ...]:
    """Steps of a series that neither drift, creep nor softening explains, in order.

    The likelihood ratio of a step of extent w against none, in a window of h samples
    on each side and with a free parabola in both, is scanned over every onset, for h
    of 8 to 128 samples (at most an eighth of the series) and w of 1 to h, powers of
    two.  The strongest response is dated, taken out, and the scan repeated.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        One value a cycle, or any evenly spaced series. [any unit]
    false_alarm : float
        Chance that a series of white Gaussian noise on a smooth background shows a
        step: the threshold is Bonferroni's over all windows, extents and onsets, which
        makes it an upper bound. [1]

    Returns
    -------
    steps : tuple of Step
        Onset and extent in samples, size in the unit of the series. [any unit]

    Raises
    ------
    DataError
        If a value is not finite, the series is shorter than 24 samples, or the rate is
        not between 0 and 1.

    Notes
    -----
    Generalized likelihood ratio ([1]_), strongest first in local windows ([2]_).
    Noise that is not white is seen in the spread of the responses themselves, which
    raises the threshold; strongly coloured noise (a random walk) can still pass for
    steps.  No step is looked for in the first ten samples, nor where the window would
    begin before half the sample number: there softening is as fast as a step.  A change
    that takes longer than twice the window, or that a change of slope explains as
    well, is drift.  An opposite change of less than half the size just after a step is
    its recovery, not a step.  Where the digitizer's step is coarser than the noise, a
    drift moves in jumps of it, and nothing below one and a half of them is a step.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> series = np.log(np.arange(1, 401)) + 0.05 * rng.standard_normal(400)
    >>> series -= 0.3 * ramp_of(400, onset=250, extent=10)
    >>> [(abs(s.onset - 250) < 10, round(s.size, 1)) for s in find_steps(series, false_alarm=1e-3)]
    [(True, -0.3)]
    """
    if not 0 < false_alarm < 1:
        raise DataError(
            "the false-alarm rate is not a chance", found=f"{false_alarm:g}", needed="0 to 1"
        )
    series = as_finite("values", values)
    if series.size < 3 * SHORTEST_WINDOW:
        raise DataError(
            "the series is too short for steps",
            found=f"{series.size} samples",
            needed=f"{3 * SHORTEST_WINDOW}",
        )
    remaining = _without_outliers(series)
    sigma = max(_noise(remaining), 1e-9 * float(np.ptp(remaining)))
    if sigma == 0:
        return ()
    _, quantum = sample_noise(series)
    smallest = 1.5 * quantum if quantum > sigma else 0.0
    allowed = np.ones(series.size, dtype=bool)
    steps: list[Step] = []
    explained = 0
    while len(steps) + explained < MOST_STEPS:
        candidate, tried = _scan(_without_background(remaining), sigma, allowed)
        if candidate is None or abs(candidate.score) < norm.isf(false_alarm / (2 * tried)):
            break
        step, is_step = _refine(remaining, candidate, sigma)
        if not is_step:
            blocked = (candidate.onset - candidate.window, candidate.onset + candidate.window)
        else:
            # What is left close to a step is its shape, not another one.
            blocked = (step.onset - step.extent - 2, step.onset + 2 * step.extent + 2)
            remaining = remaining - step.size * ramp_of(
                series.size, onset=step.onset, extent=step.extent
            )
            if abs(step.size) < smallest or _is_recovery(step, steps, 2 * candidate.window):
                explained += 1
            else:
                steps.append(step)
        allowed[max(0, blocked[0]) : blocked[1] + 1] = False
    return _joined(steps)


def step_sizes(values: ArrayLike, steps: tuple[Step, ...]) -> tuple[Floats, Floats]:
    """Size of known steps in another series of the same length.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        The other series, for example peak tension where the steps were found in the
        level of whole branches. [any unit]
    steps : tuple of Step
        Onsets and extents. [1]

    Returns
    -------
    size : ndarray, shape (n_steps,)
        Least squares with a parabola and every step nearby, over 64 samples (or twice
        the extent) on each side. [unit of the series]
    size_standard_uncertainty : ndarray, shape (n_steps,)
        From the residuals. [unit of the series]

    Raises
    ------
    DataError
        If a value is not finite.

    Examples
    --------
    >>> step = Step(50, 1, 50, 50, 50, 0.0, 0.0, 0.0)
    >>> size, _ = step_sizes(3.0 * (np.arange(100) >= 50), (step,))
    >>> print(size.round(6))
    [3.]
    """
    series = as_finite("values", values)
    sizes = np.full((2, len(steps)), np.nan)
    for index, step in enumerate(steps):
        reach = max(64, 2 * step.extent)
        first, last = max(0, step.onset - reach), min(series.size, step.onset + step.extent + reach)
        ramps = [
            ramp_of(series.size, onset=other.onset, extent=other.extent)[first:last]
            for other in (step, *(other for other in steps if other is not step))
        ]
        columns = np.stack([row for row in ramps if np.ptp(row) > 0])
        basis = _without_parabola(columns)
        local = _without_parabola(series[first:last])
        gram = np.linalg.pinv(basis @ basis.T)
        found = gram @ (basis @ local)
        residual = local - found @ basis
        variance = float(residual @ residual) / max(1, local.size - 3 - found.size)
        sizes[:, index] = found[0], np.sqrt(variance * gram[0, 0])
    return sizes[0], sizes[1]
