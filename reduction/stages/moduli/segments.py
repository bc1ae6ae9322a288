"""Piecewise-linear moduli of a branch, the form of Tables 5 and 6.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] R. Bellman and R. Roth, "Curve fitting by segmented straight lines," J. Amer. Statist.
   Assoc., vol. 64, 1969.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_increasing, as_positive, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.local_regression import RunningStatistics
from reduction.stages.moduli.modulus_product import ModulusCurves, Segments

_SHORTEST_POINTS = 3  # of a segment: two make any slope

_SHORTEST_SHARE = 10  # a segment has at least a tenth of the points

_MOST_CANDIDATES = 48  # for breakpoints; all their combinations are tried


@dataclass(frozen=True)
@read_only_arrays
class _PiecewiseLine:
    """Best continuous line for a number of segments."""

    knot: Floats
    ordinate: Floats
    covariance: Floats
    chi_square: float


@dataclass(frozen=True)
class _Pairs:
    """Normal equations of a line between every two knots, arrays (n_knots, n_knots)."""

    left: Floats
    cross: Floats
    right: Floats
    left_load: Floats
    right_load: Floats
    is_allowed: Bools

    @classmethod
    def of(cls, x: Floats, y: Floats, weight: Floats, knots: Floats) -> _Pairs:
        index = np.searchsorted(x, knots)
        index[-1] = x.size
        sums = np.cumsum([weight, weight * x, weight * x * x, weight * y, weight * x * y], axis=1)
        at_knot = np.concatenate([np.zeros((5, 1)), sums], axis=1)[:, index]
        s0, s1, s2, t0, t1 = at_knot[:, None, :] - at_knot[:, :, None]
        start = knots[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            length = knots[None, :] - start
            share = (s1 - start * s0) / length
            right = (s2 - 2 * start * s1 + start * start * s0) / length**2
            right_load = (t1 - start * t0) / length
        shortest = max(_SHORTEST_POINTS, -(-x.size // _SHORTEST_SHARE))
        return cls(
            left=s0 - 2 * share + right,
            cross=share - right,
            right=right,
            left_load=t0 - right_load,
            right_load=right_load,
            is_allowed=index[None, :] - index[:, None] >= shortest,
        )


@dataclass(frozen=True)
class _Paths:
    """Lines up to a last knot, each with a parabola in its ordinate for the squares explained."""

    last: Integers
    parent: Integers
    curvature: Floats
    load: Floats
    explained: Floats

    def step(self, pairs: _Pairs, path: Integers, knot: Integers) -> _Paths:
        """Add a segment to each path, with the ordinate at the preceding knot optimised."""
        i, j = self.last[path], knot
        pivot = self.curvature[path] + pairs.left[i, j]
        load = self.load[path] + pairs.left_load[i, j]
        cross = pairs.cross[i, j]
        return _Paths(
            last=j,
            parent=path,
            curvature=pairs.right[i, j] - cross**2 / pivot,
            load=pairs.right_load[i, j] - cross * load / pivot,
            explained=self.explained[path] + load**2 / pivot,
        )

    def total(self) -> Floats:
        """Weighted squares explained by each line, with its last ordinate optimised."""
        return self.explained + self.load**2 / self.curvature


def _search(pairs: _Pairs, maximum_segments: int) -> list[Integers]:
    """Best knots for each number of segments, by trying every combination."""
    end = pairs.left.shape[0] - 1
    start = np.zeros(1, dtype=np.int64)
    levels = [_Paths(start, start, np.zeros(1), np.zeros(1), np.zeros(1))]
    found: list[Integers] = []
    for n_segments in range(1, maximum_segments + 1):
        paths = levels[-1]
        allowed = pairs.is_allowed[paths.last]
        closing = np.flatnonzero(allowed[:, end])
        if closing.size == 0:
            break
        closed = paths.step(pairs, closing, np.full(closing.size, end))
        at = int(closing[np.argmax(closed.total())])
        knots = [end]
        for level in reversed(levels):
            knots.append(int(level.last[at]))
            at = int(level.parent[at])
        found.append(np.array(knots[::-1]))
        if n_segments < maximum_segments:  # the last level is larger than all before
            path, knot = np.nonzero(allowed[:, :end])
            levels.append(paths.step(pairs, path, knot))
    return found


def _solve(x: Floats, y: Floats, weight: Floats, knots: Floats) -> _PiecewiseLine:
    # hat functions: interpolation of each unit ordinate
    hats = np.stack([np.interp(x, knots, unit) for unit in np.eye(knots.size)])
    covariance: Floats = np.linalg.inv((hats * weight) @ hats.T).astype(np.float64)
    ordinate = covariance @ (hats * weight) @ y
    chi_square = float(np.sum(weight * (y - ordinate @ hats) ** 2))
    return _PiecewiseLine(knots, ordinate, covariance, chi_square)


def _fit_piecewise_lines(
    abscissa: ArrayLike,
    ordinate: ArrayLike,
    *,
    standard_uncertainty: ArrayLike,
    maximum_segments: int,
) -> tuple[_PiecewiseLine, ...]:
    """Best continuous piecewise line of one, two, ... segments.

    Notes
    -----
    The segments of Tables 5 and 6 of [1]_ meet in tension and strain, so the line is
    continuous. Continuity couples neighbouring segments, so that the recursion of [2]_
    over independent segments does not hold.  Here each path to a breakpoint carries the
    parabola of its residual in the ordinate there, and every combination of breakpoints
    is tried: the answer is the best one on the candidates.

    Breakpoints lie half-way between neighbouring points, at most 48 of them, evenly
    spaced in count; a segment has at least 3 points and a tenth of all. The covariance
    does not include the freedom of the breakpoints.

    Examples
    --------
    Two lines that meet at 1.25 are reproduced:

    >>> import numpy as np
    >>> x = np.arange(0.0, 2.0, 0.1) + 0.05
    >>> y = np.interp(x, [0.0, 1.2, 2.0], [0.0, 120.0, 360.0])
    >>> one, two = _fit_piecewise_lines(
    ...     x, y, standard_uncertainty=np.ones(20), maximum_segments=2
    ... )
    >>> print(two.knot.round(3), (np.diff(two.ordinate) / np.diff(two.knot)).round(6))
    [0.05 1.2  1.95] [100. 300.]
    """
    x, y, sigma = as_same_shape(
        abscissa=abscissa, ordinate=ordinate, standard_uncertainty=standard_uncertainty
    )
    as_increasing("abscissa", x)
    as_finite("ordinate", y)
    as_positive("standard_uncertainty", sigma)
    if x.size < _SHORTEST_POINTS or maximum_segments < 1:
        raise DataError(
            "a piecewise line needs points and a segment",
            found=f"{x.size} points, {maximum_segments} segments",
            needed=f"{_SHORTEST_POINTS} points, 1 segment",
        )
    middles = (x[1:] + x[:-1]) / 2
    stride = -(-middles.size // _MOST_CANDIDATES)
    knots = np.concatenate([x[:1], middles[stride - 1 : -1 : stride], x[-1:]])
    # about the middle, to preserve the digits of the sums
    centre, level, weight = float(x.mean()), float(y.mean()), sigma**-2
    pairs = _Pairs.of(x - centre, y - level, weight, knots - centre)
    return tuple(_solve(x, y, weight, knots[chosen]) for chosen in _search(pairs, maximum_segments))


_REACHED = 0.9  # of the cycles: a bin reached by fewer has the mean tension of only those

_FEWEST_BINS = 6  # two shortest segments

_FEWEST_CYCLES = 4  # with a curve of their own, for a scatter


def _choose(lines: tuple[_PiecewiseLine, ...], n_points: int) -> _PiecewiseLine:
    """Fewest segments whose rms distance is within the tolerance used as their weight."""
    for line in lines:
        if line.chi_square <= n_points:
            return line
    return lines[-1]


def find_segments(curves: ModulusCurves, *, area: ArrayLike, settings: ModulusSettings) -> Segments:
    r"""Contiguous straight segments of tension against strain, each with its modulus.

    .. math:: E = \frac{F_{high} - F_{low}}{A (\varepsilon_{high} - \varepsilon_{low})}

    Parameters
    ----------
    curves : ModulusCurves
        Mean branch tension on the strain grid, with its uncertainty and count. [SI]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    settings : ModulusSettings
        Largest number of segments. [1]

    Returns
    -------
    segments : Segments
        For each specimen and branch, in order of rising strain. [SI]

    Raises
    ------
    DataError
        If an area is not positive.

    Notes
    -----
    Printed source: Tables 5 and 6 of [1]_, where neighbouring segments meet and
    E is the chord of each; [1]_ does not say how the limits were chosen.

    Breakpoints are those of the best continuous line (`_fit_piecewise_lines`), with equal weights
    of the bins.  Tension at them is that of the branch, so that E is the chord of the branch: a
    line fitted to a bent branch has its largest error where two segments meet.
    *Number of segments:* the fewest whose root-mean-square distance from
    the mean branch is within ``segment_tolerance`` of the branch's range of tension (1 %),
    and the branch's own roughness from bin to bin (root sum of squares). A smooth curve has no true
    breakpoints: they show where straight lines approximate it best.

    Bins that fewer than nine tenths of the cycles reach are left out: at the ends of the
    grid the mean of a few cycles adjoins the mean of all, and a line would follow
    the step between them.

    The uncertainty is type A and of the chord: the scatter from cycle to cycle of
    the mean tangent modulus over the segment, over the root of the cycles.  Where fewer than
    four cycles have a curve of their own it is that of the tangent modulus, root mean square
    over the segment, over the root of the windows that fit in it.  Added are the possible error of
    one bin at each end (roughness); where segments meet between two bins, the possible
    effect of the corner on the branch there; at a reversal, its curvature within the last bin.
    The distance of the branch from the chord is given as ``segment_misfit`` (root mean
    square), to be added by users who take the segment for the curve.

    NaN for a branch with fewer than six bins.

    Examples
    --------
    Two lines that meet at a strain of 1.2; 100 and 300 N per unit strain on 1 cm2:

    >>> import numpy as np
    >>> x = np.arange(0.0, 2.0, 0.1) + 0.05
    >>> load = np.broadcast_to(np.interp(x, [0.0, 1.2, 2.0], [0.0, 120.0, 360.0]), (1, 2, 20))
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((1, 2, 20)))
    >>> curves = ModulusCurves(
    ...     **blank | {"strain_bin": x, "branch_tension": load, "window": 0.3,
    ...     "tangent_modulus_count": np.full((1, 2, 20), 10),
    ...     "tangent_modulus_by_cycle": np.empty((1, 0, 2, 20))}
    ... )
    >>> segments = find_segments(curves, area=[1e-4], settings=ModulusSettings())
    >>> print((segments.segment_modulus[0, 0] / 1e6).round(6))
    [1. 3.]
    """
    areas = np.atleast_1d(as_positive("area", area))
    n_specimens = curves.branch_tension.shape[0]
    table = np.full((9, n_specimens, 2, settings.maximum_segments), np.nan)
    for at in np.ndindex(n_specimens, 2):
        if np.count_nonzero(_reached(curves, at)) < _FEWEST_BINS:
            continue
        columns = _segment_columns(curves, at, float(areas[at[0]]), settings)
        table[:, at[0], at[1], : columns.shape[1]] = columns
    n_used = int(np.isfinite(table[0]).any(axis=(0, 1)).sum())
    table = table[..., : max(n_used, 1)].copy()
    return Segments(
        segment_modulus=table[0],
        segment_modulus_standard_uncertainty=table[1],
        segment_strain_low=table[2],
        segment_strain_high=table[3],
        segment_tension_low=table[4],
        segment_tension_low_standard_uncertainty=table[7],
        segment_tension_high=table[5],
        segment_tension_high_standard_uncertainty=table[8],
        segment_misfit=table[6],
        criterion="chords of the mean branch between the best breakpoints of the fewest contiguous "
        f"lines whose rms distance from it is within {100 * settings.segment_tolerance:g} % of its "
        f"range of tension and its roughness, at most {settings.maximum_segments}",
    )


def _reached(curves: ModulusCurves, at: tuple[int, ...]) -> Bools:
    """Mask of bins of a branch that nearly all of its cycles reach, shape (n_bins,)."""
    count = curves.tangent_modulus_count[at]
    reached: Bools = np.isfinite(curves.branch_tension[at]) & (count >= _REACHED * count.max())
    return reached


def _segment_columns(
    curves: ModulusCurves, at: tuple[int, ...], area: float, settings: ModulusSettings
) -> Floats:
    """Modulus, its uncertainty, strains, tensions, misfit, their uncertainty: (9, n_segments)."""
    used = _reached(curves, at)
    strain, tension = curves.strain_bin[used], curves.branch_tension[at][used]
    # roughness from bin to bin: a drift of the whole branch from cycle to cycle does not matter,
    # and third differences exclude its curvature
    rough = float(np.sqrt(np.mean(np.diff(tension, n=3) ** 2) / 20))
    tolerance = settings.segment_tolerance * (float(np.ptp(tension)) or 1.0)
    lines = _fit_piecewise_lines(
        strain,
        tension,
        standard_uncertainty=np.full(strain.size, np.hypot(tolerance, rough)),
        maximum_segments=settings.maximum_segments,
    )
    line = _choose(lines, strain.size)
    knot = line.knot
    low, high = knot[:-1], knot[1:]
    off = tension - np.interp(strain, knot, line.ordinate)
    at_knot = line.ordinate + np.interp(knot, strain, off)
    modulus = np.diff(at_knot) / (area * (high - low))
    # half-way between two bins a corner is as far off their mean as a line with one is off a bend
    corner = np.zeros(knot.size)
    bin_width = float(np.median(np.diff(strain)))
    corner[1:-1] = np.abs(np.diff(np.diff(line.ordinate) / (high - low))) * bin_width / 4
    # a bin at a reversal has the mean of a branch that bends within it
    corner[[0, -1]] = np.abs([np.diff(tension[:3], n=2)[0], np.diff(tension[-3:], n=2)[0]]) / 2
    reading = np.hypot(rough, corner / np.sqrt(3))
    at_ends = np.hypot(reading[:-1], reading[1:]) / (area * (high - low))
    distance = tension - np.interp(strain, knot, at_knot)
    uncertainty, misfit = [], []
    for start, stop in zip(low, high, strict=True):
        inside = (strain >= start) & (strain <= stop)
        misfit.append(np.sqrt(np.mean(distance[inside] ** 2)))
        uncertainty.append(
            _spread(curves, at, used, inside, windows=(stop - start) / curves.window)
        )
    rows = [modulus, np.hypot(uncertainty, at_ends), low, high, at_knot[:-1], at_knot[1:], misfit]
    # from cycle to cycle the branch shifts as a whole
    scatter = curves.branch_tension_standard_uncertainty[at][used]
    known = np.isfinite(scatter)
    spread = np.full(knot.size, np.nan)
    if known.any():
        spread = np.hypot(np.interp(knot, strain[known], scatter[known]), reading)
    rows += [spread[:-1], spread[1:]]
    return np.array(rows, dtype=np.float64)


def _spread(
    curves: ModulusCurves, at: tuple[int, ...], used: Bools, inside: Bools, *, windows: float
) -> float:
    """Standard uncertainty of the mean modulus over the bins of a segment."""
    modulus_by_cycle = curves.tangent_modulus_by_cycle[at[0], :, at[1]][:, used][:, inside]
    seen = np.isfinite(modulus_by_cycle)
    whole = seen.mean(axis=1) >= _REACHED if seen.size else np.zeros(0, dtype=bool)
    if np.count_nonzero(whole) >= _FEWEST_CYCLES:
        means = np.nanmean(modulus_by_cycle[whole], axis=1)
        count = float(curves.tangent_modulus_count[at][used][inside].max())
        of_whole = RunningStatistics.of(
            means, np.full_like(means, np.nan), weight=np.ones_like(means)
        )
        return float(of_whole.standard_uncertainty() * np.sqrt(means.size / max(count, 1.0)))
    variance = curves.tangent_modulus_standard_uncertainty[at][used][inside] ** 2
    known = variance[np.isfinite(variance)]
    return float(np.sqrt(known.mean() / max(windows, 1.0))) if known.size else float("nan")
