"""Steps in a series over the cycles: slips of the splices.

**Steps in an evenly sampled series, told apart from smooth drift, at a stated false-alarm rate.**
The series is the sum of a smooth background (constant, drift, logarithmic creep, a softening
transient at the start), noise, and possibly steps, each of which may take many samples to develop.
Steps are detected with matched kernels that are orthogonal to a local parabola, so that drift and
its curvature cannot pass for a step.  Their onset and extent are then found by exact least squares
on the samples around them.

**Slip of a splice: steps of tension from cycle to cycle that steady creep does not explain.** A
splice that slips lets out length, and the tension at every crosshead position falls.  The series
tested is the level of each cycle, from `reduction.stages.moduli.loop_balance`.

References
----------
.. [2] M. Basseville and I. V. Nikiforov, "Detection of Abrupt Changes: Theory and Application,"
   Prentice-Hall, 1993, sec. 2.4 (generalized likelihood ratio).
.. [4] P. Fryzlewicz, "Wild binary segmentation for multiple change-point detection," Ann.
   Statist. 42(6), 2014 (strongest first, local windows).
.. [5] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, lru_cache
from itertools import compress

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import chdtri, ndtri

from reduction.record.arrays import MAD_TO_DEVIATION, as_finite
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import sample_blocks
from reduction.record.settings import SlipSettings
from reduction.stages.moduli.modulus_product import Slips


def sample_noise(values: ArrayLike) -> tuple[float, float]:
    """Noise of single samples and the step of the digitizer, from the series itself.

    Notes
    -----
    A series quieter than half its quantum has an error of the quantum over the root of
    12, which averaging does not remove.  The quantum is taken from at most 4096 samples.

    Examples
    --------
    >>> noise, quantum = sample_noise([1.0, 1.5, 1.0, 1.5])
    >>> print(round(noise, 3), quantum)
    0.354 0.5
    """
    series = np.asarray(values, dtype=np.float64)
    if series.size < 2:
        raise DataError("no noise can be read from one sample", found=f"{series.size}", needed="2")
    steps = np.diff(np.unique(series[:4096]))
    greatest, squares = [], 0.0
    for part in sample_blocks(series.size, series, overlap=1):
        greatest.append(np.max(np.abs(series[part])))
        squares += float(np.sum(np.diff(series[part]) ** 2))
    steps = steps[steps > 1e-9 * max(1e-300, float(np.max(greatest)))]
    noise = float(np.sqrt(squares / (series.size - 1) / 2))
    return noise, float(steps.min()) if steps.size else 0.0


SHORTEST_WINDOW = 8

LONGEST_WINDOW = 128

FIRST_SAMPLE = (
    10  # the softening of the first ten cycles has no common form: no step is dated there
)


@dataclass(frozen=True)
class _Candidate:
    """The strongest response of a scan."""

    score: float
    inflation: float
    onset: int
    window: int
    extent: int


def _ramp_of(n_samples: int, *, onset: ArrayLike, extent: ArrayLike) -> Floats:
    """Unit step that develops linearly: 0 before the onset, 1 from the end of the extent.

    Notes
    -----
    A step of extent 1 is complete at its onset.

    Examples
    --------
    >>> _ramp_of(6, onset=2, extent=2)
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
    """Rows less their best-fitting parabolas."""
    base = _parabola(rows.shape[-1])
    # einsum, not matrix products: their last digits depend on the number of threads
    share = np.einsum("...i,ij->...j", rows, base)
    level: Floats = rows - np.einsum("...j,ij->...i", share, base)
    return level


def _fit_ramps(level: Floats, *, onset: Integers, extent: Integers) -> tuple[Floats, Floats]:
    r"""Least squares of a ramp and a parabola on a series, for many ramps without forming them.

    .. math:: g = r \cdot y, \qquad s = r \cdot r - \sum_j (p_j \cdot r)^2

    with r the ramp of `_ramp_of`, y the series and p an orthonormal basis of the parabolas.  The
    product with a ramp of onset o and extent w is that of a slope from o on and of ones from its
    end on, :math:`\frac{1}{w} \sum_{i=o}^{o+w-1} (i - o + 1) c_i + \sum_{i \ge o+w} c_i`.  Both are
    differences of running sums of :math:`c_i` and :math:`i c_i`.

    Examples
    --------
    >>> level = _without_parabola(3.0 * _ramp_of(40, onset=15, extent=4))
    >>> product, power = _fit_ramps(level, onset=np.array([15]), extent=np.array([4]))
    >>> print((product / power).round(6))
    [3.]
    """
    ones, slopes = _sums_from(level)
    end, width = onset + extent, extent.astype(np.float64)
    rising = slopes[onset] - slopes[end] + (1.0 - onset)[:, None] * (ones[onset] - ones[end])
    products = rising / width[:, None] + ones[end]
    squares = (width + 1) * (2 * width + 1) / (6 * width) + (level.size - end)
    return products[:, 0], squares - np.sum(products[:, 1:] ** 2, axis=1)


def _fit_kinks(level: Floats, *, onset: Integers) -> tuple[Floats, Floats]:
    """As `_fit_ramps`, for changes of slope that begin after an onset and go on to the end."""
    ones, slopes = _sums_from(level)
    products = slopes[onset] - onset[:, None] * ones[onset]
    last = (level.size - 1 - onset).astype(np.float64)
    squares = last * (last + 1) * (2 * last + 1) / 6
    return products[:, 0], squares - np.sum(products[:, 1:] ** 2, axis=1)


def _sums_from(level: Floats) -> tuple[Floats, Floats]:
    """Sums from each sample on, of a series and parabolas, and of both times the index."""
    columns = np.column_stack([level, _parabola(level.size)])
    count = np.arange(level.size)[:, None]
    ones, slopes = (
        np.concatenate([np.cumsum(part[::-1], axis=0)[::-1], np.zeros((1, columns.shape[1]))])
        for part in (columns, columns * count)
    )
    return ones, slopes


@lru_cache(maxsize=2)
def _background(n_samples: int) -> Floats:
    """Orthonormal columns that span the forms of creep and softening over a series."""
    count = np.arange(1.0, n_samples + 1)
    times = 2.0 ** np.arange(0, max(1, int(np.log2(n_samples / 8)) + 1))
    columns = [np.ones(n_samples), count / n_samples, np.log(count)]
    columns += [np.exp(-(count - 1) / time) for time in times]
    return np.linalg.qr(np.stack(columns, axis=1))[0]


def _without_background(values: Floats, ramps: Floats | None = None) -> Floats:
    """Series less the forms of creep and softening over its whole length.

    Only a smooth function of log-like form is removed, so a step remains a step; known
    ``ramps``, shape (n_steps, n_samples), are fitted along with it and stay in.
    """
    base = _background(values.size)

    def smooth(rows: Floats) -> Floats:
        # einsum, not matrix products: their last digits depend on the number of threads
        share = np.einsum("...i,ij->...j", rows, base)
        return np.asarray(np.einsum("...j,ij->...i", share, base))

    steady = values
    if ramps is not None:
        size = np.linalg.lstsq((ramps - smooth(ramps)).T, values)[0]
        steady = values - np.einsum("j,ji->i", size, ramps)
    return values - smooth(steady)


def _neighbour_noise(values: Floats) -> float:
    """Standard deviation of the noise, from neighbours; steps and wild samples left out."""
    squares = np.sort(np.diff(values) ** 2)
    kept = squares[: max(1, int(np.ceil(0.98 * squares.size)))]
    # Dropping the largest 2 % of Gaussian differences removes 13 % of their mean square.
    return float(np.sqrt(kept.mean() / 2 / 0.87))


def _without_outliers(values: Floats) -> Floats:
    """Replace single wild samples by the running median of five, which keeps every edge."""
    padded = np.pad(values, 2, mode="edge")
    median = np.median(np.lib.stride_tricks.sliding_window_view(padded, 5), axis=-1)
    distance = np.abs(values - median)
    # By the median alone a rounded series would appear free of noise.
    spread = max(MAD_TO_DEVIATION * float(np.median(distance)), _neighbour_noise(values))
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
    """Weights that give the size of a step in the middle of a window, without any parabola."""
    ramp = _without_parabola(_ramp_of(2 * window + extent, onset=window, extent=extent))
    kernel: Floats = ramp / np.sum(ramp * ramp)
    kernel.flags.writeable = False
    return kernel


def _colour(size: Floats, onset: Integers, white: float, reach: int) -> float | None:
    """Spread of a kernel's responses over that for white noise; None if they are too few.

    Responses that overlap the strongest one are left out, since it may be a step.
    """
    top = onset[np.argmax(np.abs(size))]
    rest = size[np.abs(onset - top) > reach]
    if rest.size < reach:
        return None
    return MAD_TO_DEVIATION * float(np.median(np.abs(rest))) / white


def _noise_memory(residual: Floats) -> float:
    """Spread of a long mean of autoregressive noise over that predicted from its differences."""
    power = max(float(residual @ residual), np.finfo(float).tiny)
    lag_one = min(0.95, max(0.0, float(residual[1:] @ residual[:-1]) / power))
    return float(np.sqrt(1 + lag_one) / (1 - lag_one))


def _strongest_response(
    values: Floats, *, noise: float, allowed: Bools
) -> tuple[_Candidate | None, int]:
    """Strongest response over every window, extent and onset, and how many were tried.

    Notes
    -----
    Windows of 8 to 128 samples on each side, at most a quarter of the series; extents of 1
    to the window; powers of two ([2]_).

    Examples
    --------
    >>> series = 1.0 * (np.arange(200) >= 120)
    >>> found, _ = _strongest_response(series, noise=0.1, allowed=np.ones(200, dtype=bool))
    >>> found.onset, found.extent
    (120, 1)
    """
    best: _Candidate | None = None
    tried = 0
    inflation = 1.0
    length = scipy.fft.next_fast_len(max(1, values.size), real=True)
    spectrum = scipy.fft.rfft(values, length)
    for window, extent in _windows(values.size):
        kernel = _kernel(window, extent)
        # product with the kernel at every place; those that extend beyond the end are left out
        product = scipy.fft.irfft(spectrum * scipy.fft.rfft(kernel, length).conj(), length)
        size = product[: values.size - kernel.size + 1]
        onset = np.arange(size.size) + window
        keep = (onset >= max(2 * window, window + FIRST_SAMPLE)) & allowed[onset]
        if not keep.any():
            continue
        size, onset = size[keep], onset[keep]
        white = noise * float(np.linalg.norm(kernel))
        # Coloured noise shows in the responses; a long window responds at least as much to it as
        # a short one does.
        colour = _colour(size, onset, white, 2 * window + extent)
        inflation = max(inflation, colour or 1.0)
        assumed = max(1.0, colour or inflation)
        tried += size.size
        top = int(np.argmax(np.abs(size)))
        score = float(size[top]) / (white * assumed)
        if best is None or abs(score) > abs(best.score):
            best = _Candidate(score, assumed, int(onset[top]), window, extent)
    return best, tried


@dataclass(frozen=True)
class _SlipStep:
    """One step of a series."""

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


def _step_sizes(values: ArrayLike, steps: tuple[_SlipStep, ...]) -> tuple[Floats, Floats]:
    """Size of known steps in another series of the same length.

    Examples
    --------
    >>> step = _SlipStep(50, 1, 50, 50, 50, 1.0, 0.0, 0.0)
    >>> size, _ = _step_sizes(3.0 * (np.arange(100) >= 50), (step,))
    >>> print(size.round(6))
    [3.]
    """
    series = as_finite("values", values)
    sizes = np.full((2, len(steps)), np.nan)
    if steps:
        series = _without_background(
            series,
            _ramp_of(
                series.size,
                onset=[step.onset for step in steps],
                extent=[step.extent for step in steps],
            ),
        )
    for index, step in enumerate(steps):
        reach = max(64, 2 * step.extent)
        first, last = max(0, step.onset - reach), min(series.size, step.onset + step.extent + reach)
        ramps = [
            _ramp_of(series.size, onset=other.onset, extent=other.extent)[first:last]
            for other in (step, *(other for other in steps if other is not step))
        ]
        columns = np.stack([row for row in ramps if np.ptp(row) > 0])
        basis = _without_parabola(columns)
        local = _without_parabola(series[first:last])
        # einsum, not matrix products: their last digits depend on the number of threads
        gram = np.linalg.pinv(np.einsum("ij,kj->ik", basis, basis))
        found = gram @ np.einsum("ij,j->i", basis, local)
        residual = local - np.einsum("i,ij->j", found, basis)
        variance = float((residual**2).sum()) / max(1, local.size - 3 - found.size)
        share = step.size_standard_uncertainty / abs(step.size)
        sizes[:, index] = found[0], np.hypot(np.sqrt(variance * gram[0, 0]), share * found[0])
    return sizes[0], sizes[1]


MOST_STEPS = 30


def _refine(
    values: Floats, candidate: _Candidate, sigma: float, quantum: float
) -> tuple[_SlipStep, bool, float]:
    """Onset and extent by least squares around a candidate; False where a kink fits as well.

    The last value is the largest apparent step due to rounding by half a quantum either way.
    """
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
    product, power = _fit_ramps(local, onset=onset, extent=extent)
    gain, sizes = product**2 / power, product / power
    best = int(np.argmax(gain))
    variance = max(sigma**2, (float(local @ local) - float(gain[best])) / max(1, n_local - 6))
    near = gain >= gain[best] - variance * float(chdtri(2, 0.05))

    kink, kink_power = _fit_kinks(local, onset=onsets)
    kink_gain = float(np.max(kink**2 / kink_power))
    is_step = float(gain[best]) - kink_gain > variance * 10 and extent[best] < widest
    ramp = _without_parabola(_ramp_of(n_local, onset=onset[best], extent=extent[best]))
    of_rounding = quantum / 2 * float(np.abs(ramp).sum() / power[best])
    step = _SlipStep(
        onset=int(onset[best]) + first,
        extent=int(extent[best]),
        onset_low=int(onset[near].min()) + first,
        onset_high=int(onset[near].max()) + first,
        end_high=int((onset + extent - 1)[near].max()) + first,
        size=float(sizes[best]),
        # Other shapes fit nearly as well; their sizes differ.
        size_standard_uncertainty=float(
            np.hypot(np.sqrt(variance / power[best]), np.std(sizes[near]))
        ),
        score=candidate.score,
    )
    return step, bool(is_step), of_rounding


def _is_recovery(step: _SlipStep, earlier: list[_SlipStep], reach: int) -> bool:
    """Return whether a change belongs to a larger, opposite step just before it.

    A viscoelastic specimen that has been let out a little recovers part of the loss.
    """
    return any(
        other.size * step.size < 0
        and abs(step.size) < 0.5 * abs(other.size)
        and -reach <= step.onset - other.end <= 2 * reach
        for other in earlier
    )


def _joined(steps: list[_SlipStep]) -> tuple[_SlipStep, ...]:
    """Join touching steps of one sign: parts of one step that does not develop evenly."""
    joined: list[_SlipStep] = []
    for step in sorted(steps, key=lambda step: step.onset):
        last = joined[-1] if joined else None
        if last is None or last.size * step.size < 0 or step.onset > last.end + last.extent:
            joined.append(step)
            continue
        larger = max(last, step, key=lambda part: abs(part.size))
        joined[-1] = _SlipStep(
            # A part much smaller than the other belongs to the shape and does not date it.
            onset=last.onset if abs(last.size) > 0.2 * abs(larger.size) else step.onset,
            extent=max(last.end, step.end) - last.onset + 1,
            onset_low=last.onset_low,
            onset_high=larger.onset_high,
            end_high=max(last.end_high, step.end_high),
            size=last.size + step.size,
            size_standard_uncertainty=last.size_standard_uncertainty,
            score=larger.score,
        )
    return tuple(joined)


def find_steps(
    values: ArrayLike, *, false_alarm: float, quantum: float | None = None
) -> tuple[_SlipStep, ...]:
    """Steps of a series that drift, creep and softening do not explain, in order.

    The likelihood ratio of a step of extent w against none, in a window of h samples
    on each side and with a free parabola in both, is scanned over every onset, for h
    of 8 to 128 samples (at most a quarter of the series) and w of 1 to h, powers of
    two.  The strongest response is dated and subtracted, and the scan is repeated.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        One value a cycle, or any evenly spaced series. [any unit]
    false_alarm : float
        Chance that a series of white Gaussian noise on a smooth background shows a
        step: the threshold is Bonferroni's over all windows, extents and onsets, which
        makes it an upper bound. [1]
    quantum : float, optional
        Step of the digitizer, for a series of means that does not show it; by default from the
        series. [any unit]

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
    Generalized likelihood ratio ([2]_), strongest first in local windows ([4]_).
    Noise that is not white shows in the spread of the responses and in the correlation
    of neighbours, and raises the threshold.  The stated chance does not hold for it: with a
    correlation of 0.9, 4 % of generated series of 100 samples showed a step at a stated
    0.1 % (none of 300 with white noise).  The first ten samples are not searched for steps, nor
    those where the window would begin before half the sample number: there
    softening is as fast as a step.  A change that takes longer than twice the window, or
    that a change of slope explains as well, is drift.  An opposite change of less than
    half the size just after a step is its recovery, not a step.  Where the digitizer's
    step is coarser than the noise, a drift moves in jumps of that size.  Then nothing counts as a
    step that errors of half of it at every sample, with the signs of the kernel, could make.

    Examples
    --------
    >>> from reduction.stages.moduli.splice_slip import _ramp_of
    >>> rng = np.random.default_rng(1)
    >>> series = np.log(np.arange(1, 401)) + 0.05 * rng.standard_normal(400)
    >>> series -= 0.3 * _ramp_of(400, onset=250, extent=10)
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
    sigma = max(_neighbour_noise(remaining), 1e-9 * float(np.ptp(remaining)))
    if sigma == 0:
        return ()
    if quantum is None:
        _, quantum = sample_noise(series)
        quantum = quantum if quantum > sigma else 0.0
    allowed = np.ones(series.size, dtype=bool)
    steps: list[_SlipStep] = []
    explained = 0
    while len(steps) + explained < MOST_STEPS:
        candidate, tried = _strongest_response(
            _without_background(remaining), noise=sigma, allowed=allowed
        )
        threshold = -float(ndtri(false_alarm / (2 * max(1, tried))))
        if candidate is None or abs(candidate.score) < threshold:
            break
        guess = _ramp_of(series.size, onset=[candidate.onset], extent=[candidate.extent])
        step, is_step, of_rounding = _refine(
            _without_background(remaining, guess), candidate, sigma, quantum
        )
        without = remaining - step.size * _ramp_of(
            series.size, onset=step.onset, extent=step.extent
        )
        memory = _noise_memory(_without_background(without))
        if abs(candidate.score) * min(1.0, candidate.inflation / memory) < threshold:
            is_step = False
        if not is_step:
            blocked = (candidate.onset - candidate.window, candidate.onset + candidate.window)
        else:
            # A residual close to a step is due to its shape, not another step.
            blocked = (step.onset - step.extent - 2, step.onset + 2 * step.extent + 2)
            remaining = without
            if abs(step.size) < of_rounding or _is_recovery(step, steps, 2 * candidate.window):
                explained += 1
            else:
                steps.append(step)
        allowed[max(0, blocked[0]) : blocked[1] + 1] = False
    joined = _joined(steps)
    sizes = zip(joined, *_step_sizes(_without_outliers(series), joined), strict=True)
    return tuple(
        replace(step, size=float(size), size_standard_uncertainty=float(uncertainty))
        for step, size, uncertainty in sizes
    )


def _filled(series: Floats) -> Floats:
    """Bridge missing cycles linearly."""
    known = np.flatnonzero(np.isfinite(series))
    if known.size == series.size:
        return series
    return np.interp(np.arange(series.size), known, series[known])


def _creep_per_cycle(series: Floats, steps: tuple[_SlipStep, ...]) -> float:
    """Slope of the last half of the series, with steps removed."""
    n_samples = series.size
    half = slice(n_samples // 2, n_samples)
    columns = [np.ones(n_samples), np.arange(n_samples) / n_samples]
    columns += [_ramp_of(n_samples, onset=step.onset, extent=step.extent) for step in steps]
    basis = np.stack(columns, axis=1)[half]
    return float(np.linalg.lstsq(basis, series[half])[0][1] / n_samples)


_PAUSE = 3.0  # times the usual duration of a cycle

_BEFORE_PAUSE = 20  # cycles that show the rate of creep before a pause


def _is_told_from_pause(level: Floats, time: Floats, step: _SlipStep) -> bool:
    """Whether a step exceeds the creep during a pause within it, at the rate before the pause.

    Creep and relaxation slow down, so that they contribute less than this in the pause.
    """
    lasts = np.diff(time)
    at = max(0, step.onset_low - 1)
    at += int(np.argmax(lasts[at : step.end_high + 1]))
    if lasts[at] <= _PAUSE * np.median(lasts):
        return True
    before = slice(max(0, at + 1 - _BEFORE_PAUSE), at + 1)
    moment, series = time[before] - time[before].mean(), level[before]
    speed = float(moment @ series / (moment @ moment))
    left = series - series.mean() - speed * moment
    spread = np.sqrt((left @ left) / max(1, series.size - 2) / (moment @ moment))
    return bool(abs(step.size) > (abs(speed) + 2 * spread) * lasts[at])


_CLEAR_RISE = 3.0  # standard uncertainties


def _remarks(name: str, steps: tuple[_SlipStep, ...], sizes: Floats) -> list[Note]:
    """Remark on steps up; ``sizes`` are those of the peaks, with their standard uncertainties."""
    is_rise = sizes[0] > _CLEAR_RISE * sizes[1]
    rises = [str(step.onset + 1) for step in compress(steps, is_rise)]
    return [note("tension-steps-up", name, cycles=", ".join(rises))] if rises else []


def find_slips(
    peak_tension: ArrayLike,
    *,
    specimens: tuple[str, ...],
    settings: SlipSettings,
    tension_level: ArrayLike | None = None,
    tension_slope: ArrayLike | None = None,
    time: ArrayLike | None = None,
) -> Slips:
    """Slips of the splices, found and dated cycle by cycle.

    Parameters
    ----------
    peak_tension : array_like, shape (n_specimens, n_cycles)
        Peak of each cycle, which gives the size of each step. [N]
    specimens : tuple of str, length n_specimens
        Names, in the order of the rows. [text]
    settings : SlipSettings
        Shortest run of cycles and the false-alarm rate of one specimen. [1]
    tension_level : array_like, shape (n_specimens, n_cycles), optional
        Series in which steps are searched, from
        `reduction.stages.moduli.loop_balance.cycle_tension_level`; by default the
        peaks. [N]
    tension_slope : array_like, shape (n_specimens,), optional
        Slope of tension on position at the top of the loop; without it the length of a
        slip is NaN. [N m-1]
    time : array_like, shape (n_cycles,), optional
        Beginning of each cycle; without it the cycles are taken as evenly spaced. [s]

    Returns
    -------
    slips : Slips
        One row a step, by specimen and cycle; ``slip_cycle`` is the onset, ``slip_cycle_low``
        and ``slip_cycle_high`` enclose the whole step with the 95 % range of both ends. [N]

    Raises
    ------
    DataError
        If the false-alarm rate is not a chance.

    Notes
    -----
    Source: WHOI-2005-10, sec. 4.7 and Figures 32-33, which report the slip but do not
    date it ([5]_).  Method and false-alarm rate: `find_steps`.  ``slip_length`` is the step of
    peak tension over the slope of a cycle; a relaxed specimen is softer than that slope,
    so the length is a lower bound (0.5 to 0.8 of the true length on a generated tether).
    A step at a pause between cycles is ignored where creep at the rate before it explains the size.
    Missing cycles are bridged; a specimen with more than half missing is left
    out, and a note says so.

    Examples
    --------
    >>> peak = 700 + np.random.default_rng(0).standard_normal((1, 200))
    >>> peak[:, 120:] -= 8.0
    >>> slips = find_slips(
    ...     peak, specimens=("new",), settings=SlipSettings(), tension_slope=[200.0]
    ... )
    >>> print(slips.specimen, slips.slip_cycle, slips.slip_length.round(2))
    ('new',) [121] [0.04]
    """
    peaks = np.atleast_2d(np.asarray(peak_tension, dtype=float))
    level = peaks if tension_level is None else np.atleast_2d(np.asarray(tension_level, float))
    slopes = np.asarray([np.nan] * len(peaks) if tension_slope is None else tension_slope, float)
    n_cycles = peaks.shape[1]
    times = np.arange(float(n_cycles)) if time is None else np.asarray(time, float)
    notes: list[Note] = []
    made: tuple[str, ...] = ()
    names: list[str] = []
    steps: list[_SlipStep] = []
    sizes, lengths = [np.empty((2, 0))], [np.empty((2, 0))]
    creep = np.full(len(specimens), np.nan)
    if n_cycles < settings.minimum_cycles:
        made = (f"not looked for: {n_cycles} cycles; {settings.minimum_cycles} or more are needed",)
    for row, name in enumerate(specimens if n_cycles >= settings.minimum_cycles else ()):
        missing = int(np.sum(~np.isfinite(level[row]) | ~np.isfinite(peaks[row])))
        if missing > n_cycles // 2:
            notes.append(note("slip-cycles-missing", name, n_missing=missing, n_cycles=n_cycles))
            continue
        filled, peak = _filled(level[row]), _filled(peaks[row])
        found = find_steps(filled, false_alarm=settings.false_alarm)
        size = np.stack(_step_sizes(peak, found))
        creep[row] = _creep_per_cycle(peak, found)
        is_slip = [_is_told_from_pause(filled, times, step) for step in found]
        found, size = tuple(compress(found, is_slip)), size[:, is_slip]
        notes += _remarks(name, found, size)
        names += [name] * len(found)
        steps += found
        sizes.append(size)
        lengths.append(np.stack([-size[0] / slopes[row], size[1] / abs(slopes[row])]))
    notes += _shared_steps(names, steps)
    step_size, slip_length = np.concatenate(sizes, axis=1), np.concatenate(lengths, axis=1)
    return Slips(
        specimen=tuple(names),
        slip_cycle=np.array([step.onset + 1 for step in steps], dtype=np.int64),
        slip_cycle_low=np.array([step.onset_low + 1 for step in steps], dtype=np.int64),
        slip_cycle_high=np.array([step.end_high + 1 for step in steps], dtype=np.int64),
        slip_tension_step=step_size[0],
        slip_tension_step_standard_uncertainty=step_size[1],
        slip_length=slip_length[0],
        slip_length_standard_uncertainty=slip_length[1],
        creep_per_cycle=creep,
        notes=tuple(notes),
        made=made,
    )


def _shared_steps(names: list[str], steps: list[_SlipStep]) -> list[Note]:
    """Note steps of two specimens in the same cycles: more likely the machine than the splices."""
    shared = {
        step.onset + 1
        for name, step in zip(names, steps, strict=True)
        for other_name, other in zip(names, steps, strict=True)
        if name < other_name
        and step.onset_low <= other.end_high
        and other.onset_low <= step.end_high
    }
    return [note("specimens-step-together", cycle=cycle) for cycle in sorted(shared)]
