"""Strain grid of a test, and the moving window of the tangent modulus.

Both are found from the ends of the branches alone, so that a record read in
pieces gives the same grid as the whole.

The bias of a moving window on a curved modulus is estimated from the curve itself; where a narrower
window contradicts it, the narrower one is used.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] A. Savitzky and M. J. E. Golay, "Smoothing and differentiation of data by simplified
   least squares procedures," Anal. Chem., vol. 36, 1964.
.. [3] J. W. Tukey, *Exploratory Data Analysis*. Reading, MA: Addison-Wesley, 1977 (a smoother
   applied to what it left: "twicing").
.. [4] O. V. Lepskii, "On a problem of adaptive estimation in Gaussian white noise," Theory
   Probab. Appl., vol. 35, 1991 (the widest window that no narrower one contradicts).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, comb, floor, log10, sqrt

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import MAD_TO_DEVIATION, evenly_spread, finite_median
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, Integers
from reduction.record.samples import step_that_fills, take_samples
from reduction.record.settings import ModulusSettings
from reduction.stages.cycles.cycle_product import Cycles

_STROKE_SHARE = 40  # bins per stroke

_WIDEST_WINDOW = 0.25  # of the stroke, to gather samples; a wider one blurs the curve

_BRANCHES_READ = 25  # enough for a median, few enough to cost nothing

_MAXIMUM_BINS = 5000  # a curve, not a copy of the record

_FEWEST_SPACINGS = 3  # of samples, in the narrowest window tried

_CONTRADICTED = 2.0  # standard deviations of a narrower window's slope

_FEWEST_DIFFERENCES = 5

# Halfway over a jump two windows agree on the mean of both sides; beside it their difference is a
# fifth to a third of the jump, and the greatest error of each is half of it.
_UNSEEN = sqrt(2.0)

# if there is only one width: half of the second difference, of which its blur is a tenth
_UNSEEN_OF_BLUR = 5.0

# for a curve shorter than two windows: deviations, over the bias of the slope due to curvature
# and, in case the curvature is zero by chance, over the range of the slope
_UNSEEN_OF_BEND, _UNSEEN_OF_RANGE = 2.0, 0.03

_LEAST_STEP = 2  # bins in a second difference of such a curve

# mean square of the range of ten normal numbers, the equivalent number of independent second
# differences of the noise in two windows
_SQUARE_OF_RANGE = 10.0


@dataclass(frozen=True)
class StrainGrid:
    """Bins of equal width on multiples of that width, and the window over them.

    Parameters
    ----------
    low : float
        Lower edge of the first bin. [1]
    width : float
        Width of a bin. [1]
    n_bins : int
        Number of bins. [1]
    half_window : int
        Bins on each side of the centre bin that share its window. [1]
    cycles_pooled : int
        Consecutive cycles that give one curve; 1 where a single cycle has enough
        samples in a window. [1]
    """

    low: float
    width: float
    n_bins: int
    half_window: int
    cycles_pooled: int = 1

    @property
    def window(self) -> float:
        """Width of the regression window, an odd number of bins. [1]."""
        return (2 * self.half_window + 1) * self.width

    @property
    def centres(self) -> Floats:
        """Bin centres, shape (n_bins,). [1]."""
        return self.low + (np.arange(self.n_bins, dtype=np.float64) + 0.5) * self.width

    @property
    def bounds(self) -> Floats:
        """Bin edges, shape (n_bins, 2). [1]."""
        edges = self.low + np.arange(self.n_bins + 1) * self.width
        return np.column_stack([edges[:-1], edges[1:]])

    @classmethod
    def spanning(
        cls, lowest: float, highest: float, *, width: float, half_window: int, cycles_pooled: int
    ) -> StrainGrid:
        """Grid on multiples of the width that contains both strains and a bin beyond each."""
        first = floor(lowest / width) - 1
        n_bins = ceil(highest / width) + 1 - first
        if n_bins > _MAXIMUM_BINS:
            raise DataError(
                "the strain grid has too many bins",
                found=f"{n_bins} bins of {width:g} from {lowest:g} to {highest:g}",
                needed=f"at most {_MAXIMUM_BINS}",
                hint="Give a larger modulus.strain_bin_width, or flag the spike in position.",
            )
        # a multiple of a decimal width has rounding errors; the printed edge should not
        return cls(round(first * width, 12), width, n_bins, half_window, cycles_pooled)


def round_number(value: float) -> float:
    """Nearest of 1, 2, 5 times a power of ten, by ratio."""
    power = floor(log10(value))
    steps = [m * 10.0**k for k in (power, power + 1) for m in (1, 2, 5)]
    nearest = min(steps, key=lambda step: abs(log10(step / value)))
    return float(f"{nearest:.1g}")


def bins_each_side(window: float, width: float) -> int:
    """Half of the smallest odd number of bins that covers the window, apart from rounding."""
    half_window = ceil((window / width - 1) / 2 - 1e-6)
    if half_window < 1:
        raise SettingsError(
            "modulus.window is not wider than a bin",
            found=f"{window:g} with bins of {width:g}",
            needed=f"more than {width:g}",
            hint="Leave modulus.strain_bin_width out, or make it smaller.",
        )
    return half_window


def sample_spacing(strain: Floats, cycles: Cycles, stroke: float) -> float:
    """Strain between samples at constant rate, median over branches spread over the test."""
    chosen = evenly_spread(np.arange(cycles.n_cycles), _BRANCHES_READ)
    spacings = []
    for first, last in zip(
        cycles.branch_first[chosen].ravel(), cycles.branch_last[chosen].ravel(), strict=True
    ):
        kept = first + np.flatnonzero(cycles.is_in_trimmed_branch[first : last + 1])
        if kept.size < 2:  # nothing at constant rate: only the untrimmed curve is available
            kept = np.array([first, last])
        if last > first:
            begin, end = take_samples(strain, kept[[0, -1]]).T
            spacings.append(np.abs(end - begin) / (kept[-1] - kept[0]))
    return finite_median(np.asarray(spacings), otherwise=stroke)


def choose_grid_and_window(
    strain: ArrayLike, *, cycles: Cycles, settings: ModulusSettings
) -> StrainGrid:
    r"""Bins, window and pooling that the cycles of a test support, for all its specimens.

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    cycles : Cycles
        Beginning and end of the branches. [SI]
    settings : ModulusSettings
        Given values are used; values of None are found here. [1]

    Returns
    -------
    grid : StrainGrid
        One grid for the specimens of the test. [1]

    Raises
    ------
    DataError
        If there is no cycle, no branch of any specimen has strain at both ends,
        the stroke is zero, or if the grid would have more than 5,000 bins.
    SettingsError
        If the bin width is not positive, or the window is not wider than a bin.

    Notes
    -----
    *Bins.* If None: the number of the 1-2-5 series nearest, by ratio, to a fortieth of
    the median stroke of the specimen with the shorter one. Edges are multiples of
    the width, so that tests of one width share their edges.

    *Window.* Always an odd number of bins, symmetric about the bin centre. If None:
    five bins, widened to three times ``minimum_count`` samples of one branch as long
    as it stays within a quarter of the stroke, and to four sample spacings in any case (a
    test logged in step with its period gives every cycle the same few strains).
    The bias of a window of width :math:`W` is given with `tangent_curves`.

    *Pooling.* Where the window still holds fewer than twice ``minimum_count``
    samples, as many consecutive cycles as fill it give one curve.

    Only strains at the ends of branches are read, so that a spike inside a branch does not
    stretch the grid. Drift of the stroke is covered, since all cycles are read.

    Examples
    --------
    A stroke of 47.5 % in 48 samples a branch: bins of 1 %, and a window of 13 of them, the
    smallest odd number that covers a quarter of the stroke:

    >>> import numpy as np
    >>> stroke = np.linspace(0.775, 1.25, 48)
    >>> strain = np.concatenate([stroke, stroke[::-1]])[None, :]
    >>> branch = np.repeat(np.array([1, 2], dtype=np.int8), 48)
    >>> cycles = Cycles(
    ...     first=np.array([0]), last=np.array([95]),
    ...     branch_first=np.array([[0, 48]]), branch_last=np.array([[47, 95]]),
    ...     plateau_rate=np.ones((1, 2)), cycle_number=np.ones(96, dtype=np.int32),
    ...     branch=branch, is_in_trimmed_branch=np.ones(96, dtype=bool), band=0.0,
    ... )
    >>> grid = choose_grid_and_window(strain, cycles=cycles, settings=ModulusSettings())
    >>> print(grid.width, round(grid.window, 3), grid.cycles_pooled)
    0.01 0.13 1
    """
    strain = np.atleast_2d(np.asarray(strain, dtype=np.float64))
    if cycles.n_cycles == 0:
        raise DataError("there is no cycle to make a strain grid from", needed="a whole cycle")
    ends = take_samples(strain, np.stack([cycles.branch_first, cycles.branch_last]))
    travel = np.abs(ends[:, 1] - ends[:, 0])
    live = np.isfinite(travel).any(axis=(1, 2))  # a dead channel does not affect the other one
    if not live.any():
        raise DataError(
            "no branch has strain at both ends",
            needed="at least one branch without missing ends",
            hint="See the quality flags of position and tension.",
        )
    stroke = float(np.min(np.nanmedian(travel[live], axis=(1, 2))))
    if not stroke > 0:
        raise DataError("the strain does not move over the cycles", found=f"a stroke of {stroke:g}")

    width = settings.strain_bin_width
    if width is None:
        finest = stroke / _STROKE_SHARE
        if settings.window is not None and settings.window > 0:
            finest = min(finest, settings.window / 5)
        width = round_number(finest)
    if not width > 0:
        raise SettingsError("modulus.strain_bin_width is not positive", found=f"{width:g}")

    spacing = sample_spacing(strain, cycles, stroke)
    fewest, wanted = (times * settings.minimum_count * spacing for times in (2, 3))
    window = settings.window
    if window is None:
        window = max(5 * width, min(wanted, _WIDEST_WINDOW * stroke), 4 * spacing)
    half_window = bins_each_side(window, width)
    covered = (2 * half_window + 1) * width
    return StrainGrid.spanning(
        float(np.nanmin(ends)),
        float(np.nanmax(ends)),
        width=width,
        half_window=half_window,
        cycles_pooled=min(max(1, ceil(fewest / covered)), cycles.n_cycles),
    )


def _overlap(shift: float) -> float:
    """Correlation of two window slopes of white noise, centres ``shift`` windows apart."""
    if shift >= 1:
        return 0.0
    low = shift - 0.5
    return 12 * ((0.125 - low**3) / 3 - shift / 2 * (0.25 - low**2))


def window_blur(slope: ArrayLike, *, half_window: int) -> tuple[Floats, float]:
    r"""Excess of a window slope over the slope at the window's centre.

    .. math::

        \hat E - E = \frac{W^2}{40} E'' + O(W^4)

    with :math:`E''` from the second difference of the curve over half a window.

    Parameters
    ----------
    slope : array_like, shape (..., n_bins)
        Window slopes at the bin centres, NaN where not supported. [SI]
    half_window : int
        Bins on each side of the centre bin in the window. [1]

    Returns
    -------
    blur : ndarray, shape (..., n_bins)
        Correction to be subtracted from the slope; zero where a curve is too short. [SI]
    noise_gain : float
        Factor by which the correction raises the standard deviation of the slope. [1]

    Raises
    ------
    DataError
        If ``half_window`` is below 1.

    Notes
    -----
    Derivation: over samples spread evenly on :math:`[-W/2, W/2]` the regression slope
    of :math:`y = u^3` is :math:`\int u^4 / \int u^2 = 3 W^2 / 20`, and
    :math:`E'' = y''' = 6`. The step of the second difference is one bin more than
    ``half_window``, or half of a curve that is shorter than two windows, if that is at least half
    of ``half_window``; closer than that to the end of a curve the blur is that of the
    nearest bin that has one. A jump of the modulus remains spread over the window.

    The gain is that of white noise under the combined kernel, about 1.2.

    Examples
    --------
    The window slope of a cubic, E = 3 x2, in windows of 5 bins of width 1, is too high by
    25 / 40 of 6:

    >>> import numpy as np
    >>> centre = np.arange(-10.0, 11.0)
    >>> blur, gain = window_blur(3 * centre**2 + 3.75, half_window=2)
    >>> print(blur[0], blur[10], round(gain, 2))
    3.75 3.75 1.19
    """
    if half_window < 1:
        raise DataError("a window is a bin wide", found=f"half_window {half_window}", needed="1")
    slopes = np.asarray(slope, dtype=np.float64)
    n_window = 2 * half_window + 1
    longest = int(np.isfinite(slopes).sum(axis=-1).max(initial=0))
    # for a curve shorter than two windows the curvature is that of the whole curve
    step = min(half_window + 1, (longest - 1) // 2)
    if step < max(half_window // 2, _LEAST_STEP):
        step = half_window + 1
    share = (n_window / step) ** 2 / 40
    blur = np.zeros_like(slopes)
    n_bins = slopes.shape[-1]
    if n_bins > 2 * step:
        bend = slopes[..., 2 * step :] - 2 * slopes[..., step:-step] + slopes[..., : -2 * step]
        inner = np.arange(step, n_bins - step)
        for curve in np.ndindex(bend.shape[:-1]):
            known = np.isfinite(bend[curve])
            if known.any():
                blur[curve] = share * np.interp(np.arange(n_bins), inner[known], bend[curve][known])
    shift = step / n_window
    variance = (
        (1 + 2 * share) ** 2
        + 2 * share**2 * (1 + _overlap(2 * shift))
        - 4 * share * (1 + 2 * share) * _overlap(shift)
    )
    return blur, sqrt(variance)


_FULLER = 2.0  # factor on the samples, since those of several cycles are irregularly spaced

_MOST_POOLED = 3  # windows that all cycles together fill, where a single cycle fills only one


def pooled_spacing(strain: Floats, cycles: Cycles) -> float:
    """Strain between neighbouring samples of many cycles taken together.

    The less filled of the two branches counts.  A slow log that is not synchronous with its period
    fills the branches a little more with every cycle; a synchronous one reads the same few strains.

    Examples
    --------
    Two cycles of three readings a branch, the second of them offset by half a step:

    >>> strain = np.array([0.0, 2, 4, 2, 0, 1, 3, 5, 3, 1])
    >>> pair = np.array([[0, 2], [5, 7]])
    >>> cycles = Cycles(pair[:, 0], pair[:, 0] + 4, pair, pair + 2, np.ones((2, 2)), np.zeros(10),
    ...     np.zeros(10), np.ones(10, dtype=bool), 0.1)
    >>> print(pooled_spacing(strain, cycles))
    1.0
    """
    chosen = evenly_spread(np.arange(cycles.n_cycles), _BRANCHES_READ)
    found = 0.0
    for column in (0, 1):
        read = np.concatenate([
            strain[first : last + 1][cycles.is_in_trimmed_branch[first : last + 1]]
            for first, last in zip(cycles.branch_first[chosen, column].tolist(),
                                   cycles.branch_last[chosen, column].tolist(), strict=True)
        ])  # fmt: skip
        found = max(found, step_that_fills(read))
    return found


def narrower_windows(grid: StrainGrid, *, spacing: float, pooled: Callable[[], float]) -> list[int]:
    """Half windows in bins, each half of the one before, that samples of this spacing can fill.

    For one cycle, or for all of them together where one cycle fills no narrower window.
    """
    halves = _halved(grid, spacing)
    return halves if len(halves) > 1 else _halved(grid, pooled() * _FULLER)[:_MOST_POOLED]


def is_filled_by_many(grid: StrainGrid, half_windows: Sequence[int], *, spacing: float) -> bool:
    """Whether all cycles together fill narrower windows although a single one does not.

    The few samples of one cycle are uneven in its window: curvature then makes an error of slope.
    """
    return len(half_windows) > len(_halved(grid, spacing)) == 1


def _halved(grid: StrainGrid, spacing: float) -> list[int]:
    """Half windows down to the narrowest that holds a few samples."""
    halves = [grid.half_window]
    while halves[-1] > 1:
        narrower = halves[-1] // 2
        if (2 * narrower + 1) * grid.width < _FEWEST_SPACINGS * spacing:
            break
        halves.append(narrower)
    return halves


def roughness_of(slope: Floats, half_window: int) -> Floats:
    """Standard deviation of window slopes from their differences, the least of three orders.

    Infinite where no order has enough differences.
    """
    found = np.full(slope.shape[:-1], np.inf)
    step = half_window + 1
    for order in (2, 3, 4):
        n_differences = slope.shape[-1] - order * step
        if n_differences < _FEWEST_DIFFERENCES:
            continue
        signs = np.array([(-1) ** place * comb(order, place) for place in range(order + 1)])
        differences = np.sum(
            [sign * slope[..., k * step :][..., :n_differences] for k, sign in enumerate(signs)],
            axis=0,
        )
        # overlapping windows have correlated errors
        shifts = np.abs(np.subtract.outer(np.arange(order + 1), np.arange(order + 1)))
        common = np.vectorize(_overlap)(shifts * step / (2 * half_window + 1))
        # a curve without a known difference is left as it is
        known = np.where(np.isfinite(differences), np.abs(differences), np.inf)
        known.sort(axis=-1)
        middle = np.maximum(np.isfinite(known).sum(axis=-1, keepdims=True) - 1, 0) // 2
        size = np.take_along_axis(known, middle, axis=-1)[..., 0]
        found = np.minimum(found, MAD_TO_DEVIATION * size / sqrt(signs @ common @ signs))
    return found[..., None]


def _near(values: Floats, half_window: int, *, is_highest: bool) -> Floats:
    """Highest or mean of the known values within half a window."""
    size = 2 * half_window + 1
    known = np.isfinite(values)
    if is_highest:
        return np.asarray(scipy.ndimage.maximum_filter1d(
            np.where(known, values, 0.0), size, axis=-1, mode="constant"
        ))  # fmt: skip
    total, count = (
        scipy.ndimage.uniform_filter1d(one, size, axis=-1, mode="constant")
        for one in (np.where(known, values, 0.0), known.astype(np.float64))
    )
    return np.asarray(total / np.maximum(count, 1 / size))


def _without_lone_choices(chosen: Integers, slope: Sequence[Floats], half_window: int) -> Integers:
    """Window choices without single bins that have a narrower window than both neighbours.

    Curvature or a step contradicts a window in several bins.  Of many comparisons with two standard
    deviations one in twenty does so by chance, and the narrow window is the noisier one.  Within
    half the widest window from the ends of a curve, where it changes fastest, all choices stay.

    Examples
    --------
    >>> slope = [np.ones(9)] * 3
    >>> print(_without_lone_choices(np.array([0, 2, 0, 2, 1, 2, 2, 0, 0]), slope, 1))
    [0 2 0 1 1 2 2 0 0]
    """
    is_known = np.isfinite(slope).any(axis=0).astype(np.uint8)
    is_inside = scipy.ndimage.minimum_filter1d(
        is_known, 2 * half_window + 3, axis=-1, mode="constant"
    )
    wider = chosen.copy()
    wider[..., 1:-1] = np.minimum(chosen[..., 1:-1], np.maximum(chosen[..., :-2], chosen[..., 2:]))
    is_better = (is_inside > 0) & np.isfinite(np.choose(wider, slope))
    return np.where(is_better, wider, chosen)


def adapt_window(
    slope: Sequence[Floats],
    deviation: Sequence[Floats],
    blur: Sequence[Floats],
    *,
    half_windows: Sequence[int],
    n_cycles: int | None = None,
) -> tuple[Floats, Floats, Floats]:
    r"""Slope by the widest window that no narrower one contradicts, and the error that remains.

    Parameters
    ----------
    slope, deviation : sequence of ndarray, shape (..., n_bins)
        Slopes at the bin centres, the widest window first, and their standard deviation from
        the residuals; NaN where not supported. [SI]
    blur : sequence of ndarray, shape (..., n_bins)
        Correction that was subtracted from the slopes. [SI]
    half_windows : sequence of int
        Bins on each side of the centre bin in each window. [1]
    n_cycles : int, optional
        Number of cycles from which each slope is determined. [1]

    Returns
    -------
    change : ndarray, shape (..., n_bins)
        Correction to be added to the slope of the widest window. [SI]
    noise : ndarray, shape (..., n_bins)
        Standard deviation of the chosen slope. [SI]
    missed : ndarray, shape (..., n_bins)
        Standard uncertainty of the blur that remains in the chosen window. [SI]

    Raises
    ------
    DataError
        If windows and slopes do not pair up.

    Notes
    -----
    After a reversal the modulus falls from a high value, in rubber along a curve and in a rope or
    a braid in steps as one contact after the other begins to slip.  `window_blur` corrects for
    smooth curvature; at a step no window is right.  In each bin the windows are compared ([4]_):
    the widest one is used whose slope is within two standard deviations of that of every narrower
    one; a bin that alone takes a narrower one than both beside it takes theirs.  A deviation is no
    smaller than the roughness of the curve, since readings rounded alike in every cycle count
    once in the roughness and ``n_cycles`` times in the residuals.  A roughness above the deviation
    from the residuals times the root of their number is not an error of readings but a modulus that
    rises and falls.

    The remaining error is the root mean square difference from the narrower windows over the
    window's width, less their noise.  For the narrowest window it is the greatest difference from
    the next wider one within its width, times :math:`\sqrt 2`: on top of a jump :math:`J` every
    window reads the mean of both sides, wrong by :math:`J / 2`, while two windows differ by
    :math:`0.2\,J` to :math:`0.35\,J` beside it.  One in between, chosen because a wider one is
    contradicted, has the greater of the two.  Near the ends of a curve, where the blur is that of
    the nearest bin that has one, its straight continuation bounds the error, uniformly distributed.

    Examples
    --------
    A modulus of 3 that falls to 1; the wide window reads 2.33 where the narrow one reads
    2.8; within two bins of the narrow one's own bins half of the jump may be missed:

    >>> before, after = np.full(8, 3.0), np.ones(8)
    >>> wide = np.concatenate([before, [2.9, 2.33, 1.67, 1.1], after])[None]
    >>> narrow = np.concatenate([before, [3.0, 2.8, 1.2, 1.0], after])[None]
    >>> change, noise, missed = adapt_window(
    ...     [wide, narrow], [0.01 + 0 * wide] * 2, [0 * wide] * 2, half_windows=[2, 1])
    >>> print((wide + change)[0, 9].round(2), missed[0, 5:11].round(2))
    2.8 [0.   0.04 0.21 0.66 0.66 0.66]
    """
    rough_alone = [roughness_of(*one) for one in zip(slope, half_windows, strict=True)]
    # a wide window averages more than a narrow one: an excess of its differences is the curve
    least = np.minimum.accumulate(rough_alone[::-1])[::-1]
    roughness = np.where(np.isfinite(least), least, 0.0)
    noises = [
        np.fmax(
            by_residuals,
            by_jumps if n_cycles is None else np.fmin(by_jumps, sqrt(n_cycles) * by_residuals),
        )
        for by_residuals, by_jumps in zip(deviation, roughness, strict=True)
    ]
    # for the widest window the scatter of the cycles shows more than the residuals of all together
    rough = [0 * slope[0] + roughness[0], *noises[1:]]
    last = len(slope) - 1
    chosen: Integers = np.zeros(slope[0].shape, dtype=np.int64)
    finest: Integers = np.zeros_like(chosen)
    for wide in range(last, -1, -1):
        is_sound = np.isfinite(slope[wide])
        finest = np.where(is_sound & (finest == 0), wide, finest)
        for narrow in range(wide + 1, last + 1):
            away = np.abs(slope[wide] - slope[narrow])
            is_sound &= ~(away > _CONTRADICTED * noises[narrow])
        chosen = np.where(is_sound, wide, chosen)
    chosen = _without_lone_choices(chosen, slope, half_windows[0])
    missed = _unseen_by_one(blur[0], half_windows[0], noise=deviation[0]) ** 2
    # for a curve shorter than two windows no blur is known: its modulus may change within one
    is_blind = [(one == 0).all(axis=-1, keepdims=True) for one in blur]
    missed += np.where(is_blind[0], _range(slope[0]) ** 2 / 3, 0.0)
    # for one shorter by half, the mean curvature is known, but not where the curve bends
    n_known = np.isfinite(slope[0]).sum(axis=-1, keepdims=True)
    bend = _UNSEEN_OF_BEND * np.abs(blur[0]).max(axis=-1, keepdims=True)
    bend = np.hypot(bend, _UNSEEN_OF_RANGE * _range(slope[0]))
    missed = np.where(n_known <= 2 * (half_windows[0] + 1), np.maximum(missed, bend**2), missed)
    for wide, half in enumerate(half_windows[:-1]):
        squares = {n: (slope[wide] - slope[n]) ** 2 for n in range(wide + 1, last + 1)}
        # noise is not subtracted when a blind window is compared with the next one
        of_wide = np.maximum.reduce([
            _near(
                square - np.where(is_blind[wide] & (narrow == wide + 1), 0.0, noises[narrow] ** 2),
                half, is_highest=False,
            )
            for narrow, square in squares.items()
        ])  # fmt: skip
        if wide:  # where a wider one was contradicted, a noisy narrower one gives nothing new
            of_wide = np.maximum(of_wide, missed)
        missed = np.where((chosen == wide) & (finest > wide), of_wide, missed)
        for narrow, square in squares.items():
            beside = 2 * half_windows[narrow]
            shown = square - np.where(finest > narrow, noises[narrow] ** 2, 0.0)
            of_narrow = _UNSEEN**2 * _near(shown, beside, is_highest=True) + blur[narrow] ** 2
            missed = np.where(chosen == narrow, of_narrow, missed)
    # windows cross halfway over a jump: an error on both sides of a few bins applies to them too
    around = _near(missed, half_windows[-1], is_highest=True)
    missed = np.maximum(missed, -_near(-around, half_windows[-1], is_highest=True))
    adapted = np.choose(chosen, slope)
    change = adapted - slope[0]
    return (
        np.where(np.isfinite(change), change, 0.0),
        np.choose(chosen, rough),
        np.sqrt(
            np.maximum(missed, 0.0)
            + _missed_at_ends(adapted, half_windows[0]) ** 2
            + np.choose(
                chosen,
                [
                    _change_at_ends(*one) ** 2 / 3
                    for one in zip(slope, blur, half_windows, strict=True)
                ],
            )
        ),
    )


def _unseen_by_one(blur: Floats, half_window: int, *, noise: Floats) -> Floats:
    """Possible error of a single width: the change of a smooth curvature, or all of the curvature.

    At a jump the second difference, and with it the blur, changes sign within a window.  For a
    smooth curvature it changes little, apart from the noise of the slopes.  This noise is taken
    from the residuals, since the roughness of a curve includes its jumps.
    """
    size = 4 * half_window + 1
    high = scipy.ndimage.maximum_filter1d(blur, size, axis=-1, mode="nearest")
    low = scipy.ndimage.minimum_filter1d(blur, size, axis=-1, mode="nearest")
    step, n_window = half_window + 1, 2 * half_window + 1
    of_step, of_two = (_overlap(times * step / n_window) for times in (1, 2))
    of_noise = (n_window / step) ** 2 / 40 * sqrt(6 - 8 * of_step + 2 * of_two) * noise
    by_chance = _SQUARE_OF_RANGE * np.nan_to_num(of_noise) ** 2
    changes = np.sqrt(np.maximum((high - low) ** 2 - by_chance, 0.0))
    return np.asarray(np.maximum(_UNSEEN_OF_BLUR * changes / 2, np.abs(blur)))


def _range(slope: Floats) -> Floats:
    """Range of each curve, 0 where all of it is missing."""
    known = np.isfinite(slope)
    high, low = (
        way * np.where(known, way * slope, -np.inf).max(axis=-1, keepdims=True) for way in (1, -1)
    )
    return np.where(known.any(axis=-1, keepdims=True), high - low, 0.0)


def _missed_at_ends(slope: Floats, half_window: int) -> Floats:
    """Half of the rise of the bins next to a reversal above the line of those further inside.

    A jump at the reversal itself, which reaches the first windows through the noise of strain, has
    no bins on its other side that would distinguish it from a rising modulus.
    """
    missed = np.zeros_like(slope)
    for curve in np.ndindex(slope.shape[:-1]):
        known = np.flatnonzero(np.isfinite(slope[curve]))
        if known.size <= 3 * half_window:
            continue
        for inwards in (known, known[::-1]):
            near, inner, further = (
                slope[curve][inwards[k * half_window : (k + 1) * half_window]] for k in range(3)
            )
            share = 1 - np.arange(half_window) / half_window
            rise = share * np.abs(near - 2 * inner + further) / 2
            at = (*curve, inwards[:half_window])
            missed[at] = np.maximum(missed[at], rise)
    return missed


def _change_at_ends(slope: Floats, blur: Floats, half_window: int) -> Floats:
    """Difference between the blur of the nearest bin that has one and its straight continuation."""
    change = np.zeros_like(blur)
    step = half_window + 1
    beside = -(-step // 2)
    for curve in np.ndindex(slope.shape[:-1]):
        known = np.flatnonzero(np.isfinite(slope[curve]))
        if known.size <= 2 * step + beside:  # curvature known in the middle only: may double
            change[curve] = np.abs(blur[curve])
            continue
        for inwards in (known, known[::-1]):
            rate = (blur[curve][inwards[step]] - blur[curve][inwards[step + beside]]) / beside
            change[(*curve, inwards[:step])] = abs(rate) * np.arange(step, 0, -1)
    return change
