"""Tangent modulus against strain, for every cycle and over the cycles, by branch.

**Curves of each specimen from the blocks of a record, and addition of blocks.** A block is a run of
whole cycles that fits into memory; blocks are reduced in parallel.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape, run_blocks, runs_of_true
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import sample_blocks, take_samples
from reduction.record.settings import ModulusSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli.local_regression import (
    BranchMoments,
    CycleGroups,
    RunningStatistics,
    accumulate_moments,
    fit_windows,
    select_cycles,
)
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.tangent_window import (
    StrainGrid,
    adapt_window,
    choose_grid_and_window,
    is_filled_by_many,
    narrower_windows,
    pooled_spacing,
    sample_spacing,
    window_blur,
)

_PART = 1 << 18  # samples of a block that are summed together


# of the curves of a branch: a mean over fewer represents some cycles, not the test
_REACHED = 0.9

_REFUSED = 0.1  # of the bins that some cycles reach: if more are not given, a note says which


@dataclass(frozen=True)
class _CycleMeans:
    """Means along a branch over the cycles, shape (2, n_bins), and of the steps between bins.

    ``n_seen`` (2,) is the number of curves that have a value in any bin.
    """

    level: RunningStatistics
    step: RunningStatistics
    n_seen: Floats

    @classmethod
    def of(cls, values: Floats, variance: Floats, *, weight: Floats) -> _CycleMeans:
        """Means over the first axis of curves (n_curves, 2, n_bins)."""
        steps = np.diff(values, axis=-1)
        return cls(
            RunningStatistics.of(values, variance, weight=weight),
            RunningStatistics.of(steps, np.zeros_like(steps), weight=weight),
            np.isfinite(values).any(axis=-1).sum(axis=0).astype(np.float64),
        )

    def __add__(self, later: _CycleMeans) -> _CycleMeans:
        """Both blocks together."""
        return _CycleMeans(
            self.level + later.level, self.step + later.step, self.n_seen + later.n_seen
        )

    def is_reached(self) -> Bools:
        """Bins in which nearly all curves of the branch have a value."""
        n_curves = self.level.n_curves
        reached: Bools = (n_curves > 0) & (n_curves >= _REACHED * self.n_seen[:, None])
        return reached

    def value(self) -> Floats:
        """Mean of the bins that most cycles reach, and by the mean step of those beside them.

        Where some cycles do not reach a bin, the mean of the others is higher or lower by their
        difference, which is not a slope of the specimen; a step between two bins is from cycles
        that reach both.  Between two bins that most cycles reach, the steps are fitted to both.
        """
        n_curves, mean = self.level.n_curves, self.level.value()
        curve = np.full_like(mean, np.nan)
        for branch in range(mean.shape[0]):
            joined = self.step.n_curves[branch] > 0
            alone = np.flatnonzero(n_curves[branch] > 0)
            curve[branch, alone] = mean[branch, alone]
            for first, last in runs_of_true(joined):
                part = slice(first, last + 1)
                most = n_curves[branch, part].max()
                if self.step.n_curves[branch, first:last].min() == most:
                    continue  # one population: the mean is not changed
                rise = np.concatenate([[0.0], np.cumsum(self.step.mean[branch, first:last])])
                full = np.flatnonzero(n_curves[branch, part] == most)
                above = mean[branch, part][full] - rise[full]
                curve[branch, part] = rise + np.interp(np.arange(rise.size), full, above)
        return self.given(curve)

    def given(self, values: Floats) -> Floats:
        """Values without those in bins that too few cycles reach."""
        return np.where(self.is_reached(), values, np.nan)

    def count(self) -> Integers:
        """Number of cycles in the mean."""
        return np.where(self.is_reached(), self.level.count, 0).astype(np.int64)


@dataclass(frozen=True)
class _SpecimenCurves:
    """Results of one specimen in a block: statistics (2, n_bins) [N] and selected curves.

    ``pooled`` holds the moments of both branches over the cycles of each block.
    """

    trimmed: _CycleMeans
    untrimmed: _CycleMeans
    tension: _CycleMeans
    selected: Floats
    selected_variance: Floats
    n_outside: int
    pooled: BranchMoments

    def __add__(self, later: _SpecimenCurves) -> _SpecimenCurves:
        """Both blocks together, in the order of the record."""
        return _SpecimenCurves(
            self.trimmed + later.trimmed,
            self.untrimmed + later.untrimmed,
            self.tension + later.tension,
            np.concatenate([self.selected, later.selected]),
            np.concatenate([self.selected_variance, later.selected_variance]),
            self.n_outside + later.n_outside,
            self.pooled.followed_by(later.pooled).pooled(2),
        )


def _tension_reference(tension: Floats, cycles: Cycles) -> float:
    ends = take_samples(tension, cycles.branch_first)
    return float(np.nanmean(ends)) if np.isfinite(ends).any() else 0.0


def _curve_of_sample(
    cycles: Cycles, groups: CycleGroups, start: int, stop: int, samples: slice
) -> Integers:
    """Curve of each sample of a block: trimmed parts first, then the ends; -1 for none."""
    number, branch = cycles.cycle_number[samples], cycles.branch[samples]
    group = groups.of_cycle.take(number) - start
    curve = 2 * group + branch - 1
    curve[~cycles.is_in_trimmed_branch[samples]] += 2 * (stop - start)
    outside = (group < 0) | (group >= stop - start) | (branch == 0)
    if outside.any():
        curve[outside] = -1
    return curve


def _block_moments(
    strain: Floats,
    tension: Floats,
    *,
    cycles: Cycles,
    groups: CycleGroups,
    block: tuple[int, int, slice],
    references: list[float],
    grid: StrainGrid,
) -> list[tuple[BranchMoments, int]]:
    """Moments of each specimen over a block, and its samples off the grid; long blocks in parts."""
    start, stop, samples = block
    found: list[tuple[BranchMoments, int]] = []
    series = (strain, tension, cycles.cycle_number, cycles.branch, cycles.is_in_trimmed_branch)
    for part in sample_blocks(samples.stop - samples.start, *series, size=_PART):
        here = slice(samples.start + part.start, samples.start + part.stop)
        curve = _curve_of_sample(cycles, groups, start, stop, here)
        of_part = [
            accumulate_moments(
                strain[row, here],
                tension[row, here],
                curve=curve,
                n_curves=4 * (stop - start),
                grid=grid,
                tension_reference=reference,
            )
            for row, reference in enumerate(references)
        ]
        found = (
            [(one + other, n + m) for (one, n), (other, m) in zip(found, of_part, strict=True)]
            if found
            else of_part
        )
    return found


def _reduce_block(
    moments: BranchMoments,
    *,
    n_outside: int,
    grid: StrainGrid,
    minimum_count: int,
    weight: Floats,
    n_break_in: int,
    chosen: Integers,
) -> _SpecimenCurves:
    """Curves of one block and specimen; its first ``n_break_in`` groups are in no mean."""
    n_groups = weight.size
    shape = (2, n_groups, 2, grid.n_bins)
    trimmed = moments.curves(0, 2 * n_groups)
    whole = trimmed + moments.curves(2 * n_groups, 4 * n_groups)
    fits = fit_windows(trimmed.followed_by(whole), minimum_count=minimum_count)
    slope, slope_variance = fits.slope.reshape(shape), fits.slope_variance.reshape(shape)

    def statistics(values: Floats, variance: Floats, which: int) -> _CycleMeans:
        return _CycleMeans.of(
            values.reshape(shape)[which, n_break_in:],
            variance.reshape(shape)[which, n_break_in:],
            weight=weight[n_break_in:],
        )

    return _SpecimenCurves(
        trimmed=statistics(slope, slope_variance, 0),
        untrimmed=statistics(slope, slope_variance, 1),
        tension=statistics(fits.tension, fits.tension_variance, 0),
        selected=slope[0, chosen],
        selected_variance=slope_variance[0, chosen],
        n_outside=n_outside,
        pooled=moments.curves(2 * n_break_in, 2 * n_groups).pooled(2),
    )


def _adapted(
    specimens: Sequence[_SpecimenCurves],
    *,
    halves: Sequence[int],
    minimum_count: int,
    n_cycles: int,
) -> tuple[Floats, Floats, Floats, Floats]:
    """Slope in the widest window and by `adapt_window`, from all cycles together. [N].

    A narrow window holds few samples of a single cycle.
    """
    slopes, deviations, blurs = [], [], []
    for half in halves:
        fits = [
            fit_windows(one.pooled.in_windows(half), minimum_count=minimum_count)
            for one in specimens
        ]
        slope = np.stack([fit.slope for fit in fits])
        blur, gain = window_blur(slope, half_window=half)
        slopes.append(slope - blur)
        deviations.append(gain * np.sqrt(np.stack([fit.slope_variance for fit in fits])))
        blurs.append(blur)
    adapted = adapt_window(slopes, deviations, blurs, half_windows=halves, n_cycles=n_cycles)
    return slopes[0], *adapted


def _reduce_specimens(
    strain: Floats,
    tension: Floats,
    *,
    cycles: Cycles,
    groups: CycleGroups,
    grid: StrainGrid,
    minimum_count: int,
    selected: Integers,
) -> list[_SpecimenCurves]:
    """Return the curves of each specimen of a record over all its blocks."""
    references = [_tension_reference(row, cycles) for row in tension]
    sizes = np.diff(np.append(groups.first, cycles.n_cycles)).astype(np.float64)

    def reduce_block(block: tuple[int, int, slice]) -> list[_SpecimenCurves]:
        start, stop, _ = block
        found = _block_moments(
            strain, tension, cycles=cycles, groups=groups, block=block, references=references,
            grid=grid,
        )  # fmt: skip
        return [
            _reduce_block(
                moments,
                n_outside=n_outside,
                grid=grid,
                minimum_count=minimum_count,
                weight=sizes[start:stop],
                n_break_in=int(np.count_nonzero(groups.is_break_in[start:stop])),
                chosen=selected[(selected >= start) & (selected < stop)] - start,
            )
            for moments, n_outside in found
        ]

    samples = (strain, tension, cycles.cycle_number, cycles.branch, cycles.is_in_trimmed_branch)
    blocks = run_blocks(reduce_block, groups.blocks(cycles, grid.n_bins), samples=samples)
    return [reduce(add, of_specimen) for of_specimen in zip(*blocks, strict=True)]


def pair_specimens(
    strain: ArrayLike, tension: ArrayLike, area: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Return the three as arrays with a specimen axis, or raise where they do not pair up."""
    strains, tensions = as_same_shape(strain=strain, tension=tension)
    areas = np.atleast_1d(as_positive("area", area))
    if strains.ndim != 2 or areas.shape != strains.shape[:1]:
        raise DataError(
            "strain, tension and area do not pair up",
            found=f"strain {strains.shape}, area {areas.shape}",
            needed="(n_specimens, n_samples) and (n_specimens,)",
        )
    return strains, tensions, areas


def tangent_curves(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    area: ArrayLike,
    cycles: Cycles,
    settings: ModulusSettings,
    break_in_cycles: int = 0,
    grid: StrainGrid | None = None,
) -> ModulusCurves:
    r"""Tangent modulus on a strain grid, ascending and descending, over the cycles.

    .. math:: E(\varepsilon) = \frac{1}{A} \frac{dF}{d\varepsilon}

    by local regression (`fit_windows`) in each cycle and branch, then the mean.

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    cycles : Cycles
        Cycles, branches and the trimmed part of each. [SI]
    settings : ModulusSettings
        Bins, window, fewest samples, cycles whose curves are kept. [1]
    break_in_cycles : int
        First cycles that are left out of every mean; their own curves are kept. [1]
    grid : StrainGrid, optional
        The grid of the whole record, where a piece of it is reduced; by default
        from `choose_grid_and_window`. [1]

    Returns
    -------
    curves : ModulusCurves
        Mean, scatter, envelope and count over the cycles; the untrimmed curve;
        tension at the bin centres; curves of selected cycles. [SI]

    Raises
    ------
    DataError
        If strain, tension and area do not pair up, an area is not positive, there
        is no cycle, or no cycle is left after break-in.
    SettingsError
        If the bins or the window cannot be used.

    Notes
    -----
    Printed source: eq. 2 and sec. 4.1 of [1]_; ends are trimmed as there ("end
    points have been removed"), and the untrimmed curve is also given. [1]_ does not say
    how it took the derivative.

    *Uncertainty* is type A only: the scatter over the cycles over the root of
    their number, or, for a single curve, from its regression residuals. Errors
    common to all cycles (area, calibration, splice strain) are not included. A trend over
    the cycles is not scatter (`_variance_of_a_cycle`); the mean is over slopes of single
    cycles (or of groups of consecutive ones), so that loss of tension from one to
    the next does not enter a slope.

    *Bias.* A window of width :math:`W` blurs: a slope is too high by :math:`E'' W^2 / 40`,
    0.4 % where E grows e-fold in a strain of 0.3 and W is 0.12. `window_blur` subtracts
    the same correction from every cycle, by the second difference of the mean curve.
    Where windows of half and a quarter of the width, over all cycles together, show
    another slope, theirs is used; the error that may remain is
    ``tangent_modulus_window_uncertainty`` (`adapt_window`). The modulus jumps at a
    reversal; the untrimmed curve smears that jump over :math:`W`, the trimmed one uses
    only the trimmed branch and ends a quarter window short of it, since a slope needs
    samples on both sides.

    *One population.* A bin that fewer than nine tenths of the curves reach is not given: a
    mean over some cycles beside one over all is a step that no cycle has. Along the bins
    that are given, the mean curve follows the mean step from bin to bin, over the curves
    that reach both; where all curves reach all bins, that is their mean.

    NaN: a sample missing in strain or tension is skipped; a bin without support is
    NaN in that cycle and left out of the mean, as the count shows.

    Examples
    --------
    One cycle of a straight line, 1000 N per unit strain on 1 cm2, is 10 MPa:

    >>> import numpy as np
    >>> stroke = np.linspace(1.0, 2.0, 201)
    >>> strain = np.concatenate([stroke, stroke[::-1]])[None, :]
    >>> branch = np.repeat(np.array([1, 2], dtype=np.int8), 201)
    >>> cycles = Cycles(
    ...     first=np.array([0]), last=np.array([401]),
    ...     branch_first=np.array([[0, 201]]), branch_last=np.array([[200, 401]]),
    ...     plateau_rate=np.ones((1, 2)), cycle_number=np.ones(402, dtype=np.int32),
    ...     branch=branch, is_in_trimmed_branch=np.ones(402, dtype=bool), band=0.0,
    ... )
    >>> curves = tangent_curves(
    ...     strain, 1000 * strain, area=[1e-4], cycles=cycles, settings=ModulusSettings()
    ... )
    >>> middle = np.argmin(np.abs(curves.strain_bin - 1.5))
    >>> print((curves.tangent_modulus[0, :, middle] / 1e6).round(6))
    [10. 10.]
    """
    strain, tension, areas = pair_specimens(strain, tension, area)
    n_cycles = cycles.n_cycles
    if grid is None:
        grid = choose_grid_and_window(strain, cycles=cycles, settings=settings)
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than cycles.break_in_cycles",
        )
    groups = CycleGroups.of(n_cycles, break_in_cycles, grid.cycles_pooled)
    numbers = select_cycles(n_cycles, longest=settings.selected_cycles)
    selected = np.unique(groups.of_cycle[numbers])
    specimens = _reduce_specimens(
        strain,
        tension,
        cycles=cycles,
        groups=groups,
        grid=grid,
        minimum_count=settings.minimum_count,
        selected=selected,
    )
    per_area = 1 / areas[:, None, None]
    trimmed = [one.trimmed for one in specimens]
    untrimmed = [one.untrimmed for one in specimens]
    tensions = [one.tension for one in specimens]
    blur, gain = window_blur(
        np.stack([one.value() for one in trimmed]), half_window=grid.half_window
    )

    spacing = max(sample_spacing(row[None], cycles, 0.0) for row in strain)
    halves = narrower_windows(
        grid,
        spacing=spacing,
        pooled=lambda: max(pooled_spacing(row, cycles) for row in strain),
    )
    together, change, noise, missed = _adapted(
        specimens, halves=halves, minimum_count=settings.minimum_count, n_cycles=cycles.n_cycles
    )
    if is_filled_by_many(grid, halves, spacing=spacing):
        off = together - (np.stack([one.value() for one in trimmed]) - blur)
        change = change + np.where(np.isfinite(off), off, 0.0)
    blur = blur - change

    def modulus(means: Sequence[_CycleMeans], slopes: Iterable[Floats]) -> Floats:
        given = [one.given(values) for one, values in zip(means, slopes, strict=True)]
        return (np.stack(given) - blur) * per_area

    def spread(means: Sequence[_CycleMeans], deviations: Iterable[Floats]) -> Floats:
        given = [one.given(values) for one, values in zip(means, deviations, strict=True)]
        return np.stack(given) * per_area

    by_cycle = np.stack([one.selected for one in specimens]) - blur[:, None]
    slope = np.stack([one.value() for one in trimmed]) - blur
    level = np.stack([one.value() for one in tensions])
    by_cycle_variance = np.stack([one.selected_variance for one in specimens])
    return ModulusCurves(
        strain_bin=grid.centres,
        strain_bin_bounds=grid.bounds,
        window=grid.window,
        tangent_modulus=modulus(trimmed, (one.value() for one in trimmed)),
        tangent_modulus_standard_uncertainty=_not_below(
            gain * spread(trimmed, (one.level.standard_uncertainty() for one in trimmed)),
            noise * per_area,
        ),
        tangent_modulus_window_uncertainty=missed * per_area,
        tangent_modulus_count=np.stack([one.count() for one in trimmed]),
        tangent_modulus_minimum=modulus(trimmed, (one.level.lowest() for one in trimmed)),
        tangent_modulus_maximum=modulus(trimmed, (one.level.highest() for one in trimmed)),
        tangent_modulus_scatter=spread(trimmed, (one.level.scatter() for one in trimmed)),
        tangent_modulus_untrimmed=modulus(untrimmed, (one.value() for one in untrimmed)),
        tangent_modulus_untrimmed_standard_uncertainty=_not_below(
            gain * spread(untrimmed, (one.level.standard_uncertainty() for one in untrimmed)),
            noise * per_area,
        ),
        branch_tension=level,
        branch_tension_standard_uncertainty=_not_below(
            np.stack([one.given(one.level.standard_uncertainty()) for one in tensions]),
            _off_the_slopes(level, slope * grid.width, half_window=grid.half_window),
        ),
        branch_tension_count=np.stack([one.count() for one in tensions]),
        selected_cycle=groups.first[selected] + 1,
        tangent_modulus_by_cycle=by_cycle * per_area[..., None],
        tangent_modulus_by_cycle_standard_uncertainty=gain
        * np.sqrt(by_cycle_variance)
        * per_area[..., None],
        notes=tuple(_notes(break_in_cycles, specimens)),
        made=()
        if grid.cycles_pooled == 1
        else (
            f"a window holds too few samples of one cycle: each curve pools {grid.cycles_pooled} "
            f"consecutive cycles ({groups.first.size} curves); the curve listed under a cycle is "
            "that of the group that starts with it",
        ),
    )


def _not_below(deviation: Floats, least: Floats) -> Floats:
    """Greater of both where both are known; an unknown deviation remains unknown."""
    return np.where(np.isfinite(least), np.maximum(deviation, least), deviation)


def _off_the_slopes(level: Floats, step: Floats, *, half_window: int) -> Floats:
    """Deviation of levels from the sum of slopes per bin, within a window about each bin.

    Where windows hold few samples, and the same ones in every cycle of a log in step with its
    period, a curve oscillates about the truth as samples enter them.
    """
    off = np.zeros_like(level)
    for curve in np.ndindex(level.shape[:-1]):
        known = np.flatnonzero(np.isfinite(level[curve]) & np.isfinite(step[curve]))
        if known.size < 2:
            continue
        at, slope = level[curve][known], step[curve][known]
        along = np.diff(known) * (slope[1:] + slope[:-1]) / 2
        beside = np.append(0.0, np.cumsum(np.diff(at) - along))
        beside -= _mean_about(beside, half_window)
        off[(*curve, known)] = np.sqrt(_mean_about(beside**2, half_window))
    return off


def _mean_about(values: Floats, half_window: int) -> Floats:
    """Running mean; beyond the ends the last value is repeated."""
    n_window = 2 * half_window + 1
    beyond = np.pad(values, half_window, mode="edge")
    return np.convolve(beyond, np.full(n_window, 1 / n_window), mode="valid")


def _notes(break_in_cycles: int, specimens: Sequence[_SpecimenCurves]) -> list[Note]:
    notes = [note("break-in-left-out", n_cycles=break_in_cycles)] if break_in_cycles else []
    for place, one in enumerate(specimens, start=1):
        reached, seen = one.trimmed.is_reached(), one.trimmed.level.n_curves > 0
        if not seen.any():
            notes.append(note("no-tangent-modulus", place=place))
        elif np.count_nonzero(seen & ~reached) > _REFUSED * np.count_nonzero(seen):
            notes.append(
                note(
                    "bins-of-some-cycles", place=place, n_given=int(reached.sum()),
                    n_bins=int(seen.sum()), least=_REACHED,
                )
            )  # fmt: skip
    n_outside = sum(one.n_outside for one in specimens)
    if n_outside:
        notes.append(note("samples-off-grid", n_samples=n_outside))
    return notes
