"""Tangent modulus on the first rise of a record to its greatest strain.

Rubber is stiffer the first time it is stretched, and again after a hold; neither
belongs in a mean over cycles.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] L. Mullins, "Softening of rubber by deformation," Rubber Chem. Technol.,
   vol. 42, 1969.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.moduli.blur import window_blur
from reduction.moduli.grid import StrainGrid, bins_each_side, round_number
from reduction.moduli.moments import LocalFits, accumulate_moments, fit_windows
from reduction.moduli.product import ModulusCurves
from reduction.moduli.running import RunningStatistics
from reduction.moduli.tangent import pair_specimens
from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats
from reduction.settings import ModulusSettings
from reduction.workers import run_blocks

__all__ = ["first_loading_curves"]

_BAND = 0.01  # of the rise: a sample this far below the greatest strain so far has unloaded
_NEIGHBOURS = 25  # on each side, to tell the usual step from a spike
_SPIKE_STEPS = 6  # usual steps above both neighbours
_CACHED = 16_384  # samples worked on at a time, so that they stay in the cache
_WIDEST = 0.25  # of the rise: a log so slow that its window is wider gives no curve
_BINS = 200  # of the rise, the finest grid


def _without_single_spikes(strain: Floats, low: int, high: int) -> Floats:
    """Median of each sample of a part and its neighbours; the ends of the record as they are."""
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
    """First sample near the greatest strain, spikes left out; block by block in the cache."""
    left_out: list[int] = []

    def part(low: int, high: int) -> Floats:
        low, high = max(low, 0), min(high, strain.size)
        smooth = _without_single_spikes(strain, low, high)
        smooth[[place - low for place in left_out if low <= place < high]] = np.nan
        return smooth

    blocks = range(0, strain.size, _CACHED)
    greatest = np.array([np.fmax.reduce(part(low, low + _CACHED)) for low in blocks])
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


def _rising_pieces(strain: Floats, tension: Floats, is_still: Bools) -> NDArray[np.int64]:
    """Number of the rising piece of each sample, from 0; -1 where the sample is in none.

    The result is as long as the rise; a standstill or an unloading ends a piece.
    """
    is_known = np.isfinite(strain)
    if not is_known.any():
        return np.empty(0, dtype=np.int64)
    start = float(strain[is_known.argmax()])
    end = _end_of_rise(strain, start) + 1
    smooth = _without_single_spikes(strain, 0, end)
    highest = np.fmax.accumulate(smooth)
    floor = highest - _BAND * (highest[-1] - start)
    is_still, tension = is_still[:end], tension[:end]
    # comparisons with NaN are false: a missing sample rises nowhere, and breaks nothing
    is_spike = np.abs(strain[:end] - smooth) > highest - floor
    rises = (smooth >= floor) & ~is_still & ~is_spike & np.isfinite(tension)
    breaks = np.cumsum(is_still | (smooth < floor))
    piece = np.full(end, -1, dtype=np.int64)
    samples = np.flatnonzero(rises)
    reached, number = -np.inf, 0
    for part in np.split(samples, np.flatnonzero(np.diff(breaks[samples])) + 1):
        # not the way down from its top, nor the way up to where the one before it ended
        kept = part[: int(np.argmax(smooth[part])) + 1] if part.size else part
        kept = kept[smooth[kept] >= reached]
        if kept.size:
            piece[kept] = number
            reached, number = float(smooth[kept[-1]]), number + 1
    return piece


def _grid_of_rise(
    strain: Floats, pieces: list[NDArray[np.int64]], settings: ModulusSettings
) -> StrainGrid | None:
    """Grid over the rises of all specimens; None where nothing rises."""
    rises = [row[: piece.size][piece >= 0] for row, piece in zip(strain, pieces, strict=True)]
    low = min((float(rise.min()) for rise in rises if rise.size), default=0.0)
    high = max((float(rise.max()) for rise in rises if rise.size), default=0.0)
    if not high > low:
        return None
    spacing = max((high - low) / rise.size for rise in rises if rise.size)
    wanted = 3 * settings.minimum_count * spacing
    width = settings.strain_bin_width or round_number(max((high - low) / _BINS, wanted / 5))
    window = settings.window or max(5 * width, wanted)
    if window > _WIDEST * (high - low):
        return None  # the curve would be the window, not the rubber
    return StrainGrid.spanning(
        low, high, width=width, half_window=bins_each_side(window, width), cycles_pooled=1
    )


def _fit_rise(
    strain: Floats,
    tension: Floats,
    piece: NDArray[np.int64],
    *,
    grid: StrainGrid,
    minimum_count: int,
) -> LocalFits:
    known = tension[: piece.size][piece >= 0]
    moments, _ = accumulate_moments(
        strain[: piece.size],
        tension[: piece.size],
        curve=piece,
        n_curves=int(piece.max(initial=0)) + 1,
        grid=grid,
        tension_reference=float(known.mean()) if known.size else 0.0,
    )
    return fit_windows(moments, minimum_count=minimum_count)


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
        Bins, window and fewest samples; None is found from the rise. [1]
    standstills : Standstills, optional
        Holds and rests of the record, which are left out; without them a hold is
        taken for slow loading. [SI]

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
    A sample belongs to the rise while no earlier strain was higher by more than 1 %
    of the rise: an unloading on the way, and the reloading up to where it left, are
    left out. A standstill or an unloading ends a piece, and no window reaches from one
    piece into the next: tension drops in a hold, and the stiff recovery after it would
    be read as modulus. The curve has a gap there, a quarter window to each side; after
    a hold it is the modulus of relaxed rubber for a few percent of strain.

    Whether it is the specimen's first loading, its history says: earlier tests soften
    it up to the strain they reached ([2]_).

    The uncertainty is that of the regression (type A); minimum and maximum are the
    curve itself, scatter is NaN, the count is the number of pieces, and
    the untrimmed curve is the same: crosshead speed-up is not trimmed from a rise.

    Examples
    --------
    A pull that stops half-way and unloads a little; 1000 N per unit strain, 1 cm2.

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
    n_samples = strains.shape[1]
    is_still = np.zeros(n_samples, bool) if standstills is None else standstills.covers(n_samples)
    pieces = run_blocks(
        lambda row: _rising_pieces(strains[row], tensions[row], is_still), range(areas.size)
    )
    grid = _grid_of_rise(strains, pieces, settings)
    if grid is None:
        return None
    slope, slope_uncertainty, load, load_uncertainty, count = np.full(
        (5, areas.size, 2, grid.n_bins), np.nan
    )
    for row, piece in enumerate(pieces):
        fits = _fit_rise(
            strains[row], tensions[row], piece, grid=grid, minimum_count=settings.minimum_count
        )
        weight = np.ones(fits.slope.shape[0])
        # by piece: the step of modulus at a hold is not a bend
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
        notes=(
            f"first loading: {max(int(piece.max(initial=-1)) for piece in pieces) + 1} rising "
            f"pieces between holds, window {grid.window:g} of strain",
        ),
    )
