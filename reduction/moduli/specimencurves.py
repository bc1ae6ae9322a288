"""Curves of each specimen from the blocks of a record, and how blocks add up.

A block is a run of whole cycles that fits into memory; blocks are reduced side by side.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np

from reduction.cycles.product import Cycles
from reduction.moduli.grid import StrainGrid
from reduction.moduli.groups import CycleGroups
from reduction.moduli.moments import BranchMoments, accumulate_moments, fit_windows
from reduction.moduli.running import RunningStatistics
from reduction.record import Floats, Integers
from reduction.samples.blocks import sample_blocks, take_samples
from reduction.workers import run_blocks

_PART = 1 << 18  # samples of a block of which sums are taken together


@dataclass(frozen=True)
class SpecimenCurves:
    """What one specimen gives in a block: statistics (2, n_bins) [N] and selected curves."""

    trimmed: RunningStatistics
    untrimmed: RunningStatistics
    tension: RunningStatistics
    selected: Floats
    selected_variance: Floats
    n_outside: int

    def __add__(self, later: SpecimenCurves) -> SpecimenCurves:
        """Both blocks together, in the order of the record."""
        return SpecimenCurves(
            self.trimmed + later.trimmed,
            self.untrimmed + later.untrimmed,
            self.tension + later.tension,
            np.concatenate([self.selected, later.selected]),
            np.concatenate([self.selected_variance, later.selected_variance]),
            self.n_outside + later.n_outside,
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
    curve[~cycles.is_constant_rate[samples]] += 2 * (stop - start)
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
    series = (strain, tension, cycles.cycle_number, cycles.branch, cycles.is_constant_rate)
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
) -> SpecimenCurves:
    """Curves of one block and specimen; its first ``n_break_in`` groups are in no mean."""
    n_groups = weight.size
    shape = (2, n_groups, 2, grid.n_bins)
    trimmed = moments.curves(0, 2 * n_groups)
    whole = trimmed + moments.curves(2 * n_groups, 4 * n_groups)
    fits = fit_windows(trimmed.followed_by(whole), minimum_count=minimum_count)
    slope, slope_variance = fits.slope.reshape(shape), fits.slope_variance.reshape(shape)

    def statistics(values: Floats, variance: Floats, which: int) -> RunningStatistics:
        return RunningStatistics.of(
            values.reshape(shape)[which, n_break_in:],
            variance.reshape(shape)[which, n_break_in:],
            weight=weight[n_break_in:],
        )

    return SpecimenCurves(
        trimmed=statistics(slope, slope_variance, 0),
        untrimmed=statistics(slope, slope_variance, 1),
        tension=statistics(fits.tension, fits.tension_variance, 0),
        selected=slope[0, chosen],
        selected_variance=slope_variance[0, chosen],
        n_outside=n_outside,
    )


def reduce_specimens(
    strain: Floats,
    tension: Floats,
    *,
    cycles: Cycles,
    groups: CycleGroups,
    grid: StrainGrid,
    minimum_count: int,
    selected: Integers,
) -> list[SpecimenCurves]:
    """Return the curves of each specimen of a record over all its blocks."""
    references = [_tension_reference(row, cycles) for row in tension]
    sizes = np.diff(np.append(groups.first, cycles.n_cycles)).astype(np.float64)

    def reduce_block(block: tuple[int, int, slice]) -> list[SpecimenCurves]:
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

    samples = (strain, tension, cycles.cycle_number, cycles.branch, cycles.is_constant_rate)
    blocks = run_blocks(reduce_block, groups.blocks(cycles, grid.n_bins), samples=samples)
    return [reduce(add, of_specimen) for of_specimen in zip(*blocks, strict=True)]
