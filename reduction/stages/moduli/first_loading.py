"""Tangent modulus and stress at stated strains on the first loading.

**Tangent modulus on the first rise of a record to its greatest strain.** Rubber is stiffer the
first time it is stretched, and again after a hold; neither belongs in a mean over cycles.

**Nominal stress at a stated elongation on a first loading, such as M100.** The rubber trade
calls this stress "modulus" (M100, M300).  Here it is a stress, never mixed with a modulus: on a
curve through the origin it is the secant modulus times the strain.

References
----------
.. [2] L. Mullins, "Softening of rubber by deformation," Rubber Chem. Technol., vol. 42, 1969.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape, finite_median, run_blocks
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.samples import (
    finite_extremes,
    first_sample,
    last_sample,
    release_pages,
    sample_blocks,
    take_samples,
)
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.local_regression import (
    LocalFits,
    RunningStatistics,
    accumulate_moments,
    fit_windows,
)
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.tangent_modulus import pair_specimens
from reduction.stages.moduli.tangent_window import (
    StrainGrid,
    bins_each_side,
    roughness_of,
    round_number,
    window_blur,
)
from reduction.stages.standstills import Standstills, estimate_noise

_BAND = 0.01  # of the rise: a sample this far below the greatest strain so far has unloaded

_NEIGHBOURS = 25  # on each side, to distinguish the usual step from a spike

_SPIKE_STEPS = 6  # usual steps above both neighbours

_CACHED = 16_384  # samples processed at a time, so that they stay in the cache

_WIDEST = 0.25  # of the rise: a log so slow that its window is wider gives no curve

_BINS = 200  # of the rise, the finest grid


def _without_single_spikes(strain: Floats, low: int, high: int) -> Floats:
    """Median of each sample of a part and its neighbours; the ends of the record unchanged."""
    first = max(low, 1)
    stop = max(min(high, strain.size - 1), first)
    before, here, after = (
        strain[first - 1 : stop - 1],
        strain[first:stop],
        strain[first + 1 : stop + 1],
    )
    smooth = strain[low:high].copy()
    smooth[first - low : stop - low] = np.maximum(
        np.minimum(before, here), np.minimum(np.maximum(before, here), after)
    )
    return smooth


def _end_of_rise(strain: Floats, start: float) -> int:
    """First sample near the greatest strain, without spikes; block by block in the cache."""
    left_out: list[int] = []

    def part(low: int, high: int) -> Floats:
        low, high = max(low, 0), min(high, strain.size)
        smooth = _without_single_spikes(strain, low, high)
        smooth[[place - low for place in left_out if low <= place < high]] = np.nan
        return smooth

    blocks = range(0, strain.size, _CACHED)
    greatest = np.full(len(blocks), np.nan)
    for block, low in enumerate(blocks):
        greatest[block] = np.fmax.reduce(part(low, low + _CACHED))
        release_pages(strain)
    while True:
        block = int(np.nanargmax(greatest))
        low = blocks[block]
        top = low + int(np.nanargmax(part(low, low + _CACHED)))
        tolerance = _BAND / 2 * (greatest[block] - start)
        steps = np.abs(np.diff(part(top - _NEIGHBOURS, top + _NEIGHBOURS + 1)))
        steps = steps[np.isfinite(steps)]
        beside = np.append(part(top - 1, top), part(top + 1, top + 2))
        beside = beside[np.isfinite(beside)]
        usual = _SPIKE_STEPS * float(np.median(steps)) if steps.size else 0.0
        if beside.size == 0 or greatest[block] - beside.max() <= max(usual, tolerance):
            level = greatest[block] - tolerance
            low = blocks[int(np.argmax(greatest >= level))]
            return low + int(np.argmax(part(low, low + _CACHED) >= level))
        left_out.append(top)
        greatest[block] = np.fmax.reduce(part(low, low + _CACHED))


class _Rise:
    """Samples of the rising pieces of one specimen, with the number of their piece, from 0."""

    def __init__(self) -> None:
        """Begin without a piece."""
        nothing = np.empty(0, dtype=np.int64)
        self._found: list[tuple[Integers, Integers]] = [(nothing, nothing)]
        self.n_pieces = 0
        self.reached = -np.inf

    def add(self, samples: Integers, level: Floats) -> None:
        """Take the part of a piece that is higher than everything before it."""
        # without the way down from its top, and the way up to the end of the piece before
        up = slice(0, int(np.argmax(level)) + 1 if level.size else 0)
        kept = level[up] >= self.reached
        if kept.any():
            samples = samples[up][kept]
            self._found.append((samples, np.full(samples.size, self.n_pieces)))
            self.reached, self.n_pieces = float(level[up][kept][-1]), self.n_pieces + 1

    @property
    def sample(self) -> Integers:
        """Samples in order of time."""
        return np.concatenate([samples for samples, _ in self._found])

    @property
    def piece(self) -> Integers:
        """Number of the piece, one per sample."""
        return np.concatenate([numbers for _, numbers in self._found])


_CALM = 0.001  # of the rise: a tenth of the band

_LEAST_OF_RISE = 100  # means that remain of it


def _calmed(
    strain: Floats, tension: Floats, is_still: Callable[[slice], Bools] | None
) -> tuple[Floats, Floats, Callable[[slice], Bools] | None]:
    """Means of consecutive samples, where noise of strain is too large to detect the rise.

    A window about a noisy strain holds samples from places beside it, and the greatest strain so
    far is that of the noisiest sample: the curve is distorted at its ends.  Means of both channels
    over time avoid that.
    """
    low, high = finite_extremes(strain)
    rise = high - low
    # the range of a series without readings is not finite
    noise = estimate_noise(strain)[0] if rise > 0 and strain.size > 2 * _LEAST_OF_RISE else 0.0
    if not noise > _CALM * rise:
        return strain, tension, is_still
    top = first_sample(lambda part: strain[part] > high - rise / 10, 0, strain.size, strain)
    foot = last_sample(lambda part: strain[part] < low + rise / 10, 0, top or 0, strain)
    together = min(
        int(np.ceil((noise / (_CALM * rise)) ** 2)),
        ((top or 0) - (foot or 0)) * 10 // 8 // _LEAST_OF_RISE,
    )
    if together < 2:
        return strain, tension, is_still
    whole = strain.size // together * together

    def covers(part: slice) -> Bools:
        if is_still is None:
            return np.zeros(part.stop - part.start, dtype=bool)
        still = is_still(slice(part.start * together, part.stop * together))
        return np.asarray(still.reshape(-1, together).any(axis=1))

    of_both = (one[:whole].reshape(-1, together).mean(axis=1) for one in (strain, tension))
    return (*of_both, covers)


def _rise_of(strain: Floats, tension: Floats, is_still: Callable[[slice], Bools] | None) -> _Rise:
    """Rising pieces up to the greatest strain; a standstill or an unloading ends a piece."""
    rise = _Rise()
    first = first_sample(lambda part: np.isfinite(strain[part]), 0, strain.size, strain)
    if first is None:
        return rise
    end = _end_of_rise(strain, float(strain[first])) + 1
    blocks = sample_blocks(end, strain)
    top = max(np.fmax.reduce(_without_single_spikes(strain, p.start, p.stop)) for p in blocks)
    band = _BAND * (top - float(strain[first]))
    samples, level = np.empty(0, dtype=np.int64), np.empty(0)  # of an unfinished piece
    highest = np.array([-np.inf])
    for part in sample_blocks(end, strain, tension):
        smooth = _without_single_spikes(strain, part.start, part.stop)
        highest = np.fmax.accumulate(np.concatenate([highest[-1:], smooth]))
        floor = highest[1:] - band
        still = np.zeros(smooth.size, dtype=bool) if is_still is None else is_still(part)
        # comparisons with NaN are false: a missing sample never rises, and interrupts nothing
        is_spike = np.abs(strain[part] - smooth) > band
        rises = (smooth >= floor) & ~still & ~is_spike & np.isfinite(tension[part])
        breaks = np.cumsum(still | (smooth < floor))
        rising = np.flatnonzero(rises & (smooth >= rise.reached))
        for at in np.split(rising, np.flatnonzero(np.diff(breaks[rising], prepend=0))):
            if at.size and breaks[at[0]]:
                rise.add(samples, level)
                samples, level = samples[:0], level[:0]
            samples = np.concatenate([samples, part.start + at])
            level = np.concatenate([level, smooth[at]])
        if breaks[-1] > (breaks[rising[-1]] if rising.size else 0):
            rise.add(samples, level)
            samples, level = samples[:0], level[:0]
    rise.add(samples, level)
    return rise


def _grid_of_rise(rises: list[Floats], settings: ModulusSettings) -> StrainGrid | None:
    """Grid over the strains of the rises of all specimens; None where nothing rises."""
    low = min((float(rise.min()) for rise in rises if rise.size), default=0.0)
    high = max((float(rise.max()) for rise in rises if rise.size), default=0.0)
    if not high > low:
        return None
    spacing = max((high - low) / rise.size for rise in rises if rise.size)
    wanted = 3 * settings.minimum_count * spacing
    width = settings.strain_bin_width or round_number(max((high - low) / _BINS, wanted / 5))
    window = settings.window or max(5 * width, wanted)
    if window > _WIDEST * (high - low):
        return None  # the curve would show the window, not the rubber
    return StrainGrid.spanning(
        low, high, width=width, half_window=bins_each_side(window, width), cycles_pooled=1
    )


def _fit_rise(
    strain: Floats, tension: Floats, rise: _Rise, *, grid: StrainGrid, minimum_count: int
) -> LocalFits:
    moments, _ = accumulate_moments(
        strain,
        tension,
        curve=rise.piece,
        n_curves=max(rise.n_pieces, 1),
        grid=grid,
        tension_reference=float(tension.mean()) if tension.size else 0.0,
    )
    fits = fit_windows(moments, minimum_count=minimum_count, is_alone=True)
    correlation = _inflation(strain, tension, rise, fits, grid)
    inflation = correlation * _excess(fits, grid, correlation=correlation)
    return replace(
        fits,
        slope_variance=inflation * fits.slope_variance,
        tension_variance=inflation * fits.tension_variance,
    )


def _inflation(
    strain: Floats, tension: Floats, rise: _Rise, fits: LocalFits, grid: StrainGrid
) -> float:
    """Factor on the variances for the correlation of neighbouring residuals, each over its scatter.

    A filter, or hum aliased by the sampling, correlates neighbours.
    """
    bins = np.clip(((strain - grid.low) / grid.width).astype(np.intp), 0, grid.n_bins - 1)
    off = tension - fits.tension[rise.piece, bins]
    off -= fits.slope[rise.piece, bins] * (strain - grid.centres[bins])
    variance = fits.tension_variance[rise.piece, bins]
    share = off / np.sqrt(np.where(variance > 0, variance, np.nan))
    share = share[np.isfinite(share)]
    return lag_one_inflation(share) if share.size >= _FEWEST_CORRELATED else 1.0


_FEWEST_CORRELATED = 100


def _excess(fits: LocalFits, grid: StrainGrid, *, correlation: float) -> Floats:
    """Factor on the variances of each piece, where its slopes scatter more than they explain.

    Errors of the readings that last as long as a window, such as those of a screw or an encoder,
    leave no residuals in it.
    """
    own = np.array([[finite_median(one)] for one in correlation * fits.slope_variance])
    rough = roughness_of(fits.slope, grid.half_window) ** 2
    is_known = np.isfinite(rough) & (own > 0)
    return np.maximum(np.where(is_known, rough / np.where(is_known, own, 1.0), 1.0), 1.0)


def first_loading_curves(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    area: ArrayLike,
    settings: ModulusSettings,
    standstills: Standstills | None = None,
) -> ModulusCurves | None:
    r"""Tangent modulus and tension on the first rise to the greatest strain of the record.

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    settings : ModulusSettings
        Bins, window and fewest samples; None is determined from the rise. [1]
    standstills : Standstills, optional
        Holds and rests of the record, which are left out; without them a hold counts
        as slow loading. [SI]

    Returns
    -------
    curves : ModulusCurves or None
        The ascending branch (index 0); the descending one is NaN. None where the
        record does not rise, or is so slow that the window is a quarter of the rise. [SI]

    Raises
    ------
    DataError
        If strain, tension and area do not pair up, or an area is not positive.

    Notes
    -----
    A sample belongs to the rise if no earlier strain was higher by more than 1 %
    of the rise: an unloading on the way, and the reloading up to where it began, are
    left out. A standstill or an unloading ends a piece, and no window extends from one
    piece into the next: tension drops in a hold, and the stiff recovery after it would
    appear as modulus. The curve has a gap there, a quarter window to each side; after
    a hold it is the modulus of relaxed rubber for a few percent of strain.

    The history of the specimen shows whether it is its first loading: earlier tests soften
    it up to the strain they reached ([2]_).

    The uncertainty is that of the regression (type A); minimum and maximum are the
    curve itself, scatter is NaN, the count is the number of pieces, and
    the untrimmed curve is the same: crosshead speed-up is not trimmed from a rise.

    Examples
    --------
    A pull that stops half-way and unloads a little; 1000 N per unit strain, 1 cm2:

    >>> import numpy as np
    >>> up, back = np.linspace(0.0, 1.0, 200), np.linspace(1.0, 0.8, 40)
    >>> strain = np.concatenate([up, back, np.linspace(0.8, 2.0, 240)])[None, :]
    >>> curves = first_loading_curves(
    ...     strain, 1000 * strain, area=[1e-4], settings=ModulusSettings()
    ... )
    >>> at = np.argmin(np.abs(curves.strain_bin - 1.5))
    >>> print((curves.tangent_modulus[0, :, at] / 1e6).round(6))
    [10. nan]
    """
    strains, tensions, areas = pair_specimens(strain, tension, area)
    is_still = None if standstills is None else standstills.covers
    calmed = run_blocks(
        lambda row: _calmed(strains[row], tensions[row], is_still), range(areas.size)
    )
    rises = run_blocks(lambda row: _rise_of(*calmed[row]), range(areas.size))
    stretches = [take_samples(one[0], rise.sample) for one, rise in zip(calmed, rises, strict=True)]
    grid = _grid_of_rise(stretches, settings)
    if grid is None:
        return None
    slope, slope_uncertainty, load, load_uncertainty, count = np.full(
        (5, areas.size, 2, grid.n_bins), np.nan
    )
    for row, rise in enumerate(rises):
        load_of_rise = take_samples(calmed[row][1], rise.sample)
        fits = _fit_rise(
            stretches[row], load_of_rise, rise, grid=grid, minimum_count=settings.minimum_count
        )
        weight = np.ones(fits.slope.shape[0])
        # by piece, since the step of modulus at a hold is not curvature
        blur, gain = window_blur(fits.slope, half_window=grid.half_window)
        slopes = RunningStatistics.of(
            fits.slope - blur, gain**2 * fits.slope_variance, weight=weight
        )
        loads = RunningStatistics.of(fits.tension, fits.tension_variance, weight=weight)
        slope[row, 0], slope_uncertainty[row, 0] = slopes.value(), slopes.standard_uncertainty()
        load[row, 0], load_uncertainty[row, 0] = loads.value(), loads.standard_uncertainty()
        count[row, 0] = slopes.count
    per_area = 1 / areas[:, None, None]
    modulus, uncertainty = slope * per_area, slope_uncertainty * per_area
    none_selected = np.empty((areas.size, 0, 2, grid.n_bins))
    return ModulusCurves(
        strain_bin=grid.centres,
        strain_bin_bounds=grid.bounds,
        window=grid.window,
        tangent_modulus=modulus,
        tangent_modulus_standard_uncertainty=uncertainty,
        tangent_modulus_count=np.nan_to_num(count).astype(np.int64),
        tangent_modulus_minimum=modulus.copy(),
        tangent_modulus_maximum=modulus.copy(),
        tangent_modulus_scatter=np.full_like(modulus, np.nan),
        tangent_modulus_untrimmed=modulus.copy(),
        tangent_modulus_untrimmed_standard_uncertainty=uncertainty.copy(),
        branch_tension=load,
        branch_tension_standard_uncertainty=load_uncertainty,
        selected_cycle=np.empty(0, dtype=np.int64),
        tangent_modulus_by_cycle=none_selected,
        tangent_modulus_by_cycle_standard_uncertainty=none_selected.copy(),
        made=(
            f"{max(rise.n_pieces for rise in rises)} rising pieces between holds, window"
            f" {grid.window:g} of strain",
        ),
    )


# samples before the level through which the line is drawn, and the strain that it may span
_SAMPLES = 12

_SPAN = 0.1

_FEWEST = 4

_BESIDE = 0.01  # of strain: distance within which a hold may be on the other side of the level


def stress_at_strain(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    area: float,
    levels: Sequence[float],
    is_still: Callable[[slice], Bools] | None = None,
) -> tuple[Floats, Floats, tuple[str, ...]]:
    r"""Nominal stress where a record first passes stated elongations.

    .. math:: \sigma_L = F(\varepsilon = L) / A

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        Strain of one specimen; NaN where missing. [1]
    tension : array_like, shape (n_samples,)
        NaN where missing. [N]
    area : float
        Cross-sectional area at zero tension. [m2]
    levels : sequence of float
        Elongations; 1.0 is 100 %. [1]
    is_still : callable, optional
        For a slice: samples in a hold or rest, whose tension relaxes; they are left out. [1]

    Returns
    -------
    stress, stress_standard_uncertainty : ndarray, shape (n_levels,)
        NaN where a level is not reached, or not measured. [Pa]
    reasons : tuple of str, length n_levels
        Reason why a level within the range of the record has no number; empty elsewhere. [text]

    Raises
    ------
    DataError
        If the area is not positive or the series do not pair up.

    Notes
    -----
    A line through the samples just before the level, at most twelve and within 10 % of
    strain, is evaluated at the level: what follows (a hold, the turn) has no effect.  The
    uncertainty is that of the line there (type A).  Where the nearest hold is within 1 % of strain
    of the level, the level may have been passed on the other side of it: half of the tension lost
    in the hold is added.

    Examples
    --------
    >>> x = np.linspace(0, 2, 401)
    >>> stress, _, _ = stress_at_strain(x, 100 * x, area=1e-4, levels=(1.0, 3.0))
    >>> print(stress.round(3))
    [1000000.      nan]
    """
    section = float(as_positive("area", area))
    stretch, load = as_same_shape(strain=strain, tension=tension)

    def known(part: slice) -> Bools:
        found: Bools = np.isfinite(stretch[part]) & np.isfinite(load[part])
        return found if is_still is None else found & ~is_still(part)

    def first_at(level: float) -> int | None:
        return first_sample(
            lambda part: known(part) & (stretch[part] >= level), 0, stretch.size, stretch, load
        )

    begin = first_sample(known, 0, stretch.size, stretch, load)
    stress, uncertainty = np.full((2, len(levels)), np.nan)
    reasons = [""] * len(levels)
    for index, level in enumerate(levels):
        reached = first_at(level)
        if reached is None or reached == begin:
            continue
        used = _last_of(known, reached + 1)
        near = stretch[used] >= level - _SPAN
        # a gap in the samples ends the line: a hold, or a reading that was left out
        joined = np.concatenate([np.cumsum(np.diff(used)[::-1] > 1)[::-1] == 0, [True]])
        x, y = stretch[used][near & joined] - level, load[used][near & joined]
        if x.size < _FEWEST:
            reasons[index] = (
                f"samples between {100 * (level - _SPAN):g} and {100 * level:g} % strain:"
                f" {x.size}; needed {_FEWEST}"
            )
            continue
        mean, square = x.mean(), float(np.sum((x - x.mean()) ** 2))
        slope = float(np.sum((x - mean) * y)) / square
        left = y - y.mean() - slope * (x - mean)
        variance = float(left @ left) / (x.size - 2) * (1 / x.size + mean**2 / square)
        lost = 0.0 if is_still is None else _lost_beside(stretch, load, is_still, reached, level)
        stress[index] = (y.mean() - slope * mean) / section
        uncertainty[index] = np.hypot(np.sqrt(variance), lost / 2) / section
    return stress, uncertainty, tuple(reasons)


def _lost_beside(
    stretch: Floats, load: Floats, is_still: Callable[[slice], Bools], reached: int, level: float
) -> float:
    """Tension lost in the hold before or after the sample that reached a level, at that strain."""
    lost = 0.0
    for inside in (
        last_sample(is_still, 0, reached),
        first_sample(is_still, reached, stretch.size),
    ):
        if inside is None or not abs(stretch[inside] - level) <= _BESIDE:
            continue
        before = last_sample(lambda part: ~is_still(part), 0, inside)
        after = first_sample(lambda part: ~is_still(part), inside, stretch.size)
        hold = load[0 if before is None else before + 1 : after]
        held = hold[np.isfinite(hold)]
        lost = max(lost, float(held[0] - held[-1]) if held.size else 0.0)
    return lost


def _last_of(known: Callable[[slice], Bools], stop: int) -> Integers:
    """The last known samples before a given one, as many as the line needs."""
    found: list[int] = []
    while len(found) < _SAMPLES:
        at = last_sample(known, 0, found[-1] if found else stop)
        if at is None:
            break
        found.append(at)
    return np.array(found[::-1])
