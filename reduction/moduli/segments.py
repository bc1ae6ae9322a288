"""Piecewise-linear moduli of a branch, the form of Tables 5 and 6.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.moduli.piecewise import PiecewiseLine, fit_piecewise_lines
from reduction.moduli.product import ModulusCurves, Segments
from reduction.record import Bools, Floats
from reduction.settings import ModulusSettings

_REACHED = 0.9  # of the cycles: a bin that fewer reach has the mean tension of those few
_FEWEST_BINS = 6  # two shortest segments
_FEWEST_CYCLES = 4  # with a curve of their own, for a scatter


def _choose(lines: tuple[PiecewiseLine, ...], n_points: int) -> PiecewiseLine:
    """Fewest segments whose rms distance is within the tolerance they were weighted with."""
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
        Of each specimen and branch, in rising strain. [SI]

    Raises
    ------
    DataError
        If an area is not positive, or the areas do not pair up with the curves.

    Notes
    -----
    Printed source: Tables 5 and 6 of [1]_, where neighbouring segments meet and
    E is the chord of each; how [1]_ chose their limits it does not say.

    The line is the best continuous one (`fit_piecewise_lines`), all bins alike, and E the
    chord of the line. *Number of segments:* the fewest whose root-mean-square distance from
    the mean branch is within ``segment_tolerance`` of the branch's range of tension (1 %),
    and the branch's own roughness from bin to bin (root sum of squares). A smooth curve has no true
    breakpoints: they say where straight lines stand in for it best.

    Bins that fewer than nine tenths of the cycles reach are left out: at the ends of the
    grid the mean of a few cycles stands beside the mean of all, and a line would follow
    the step between them.

    The uncertainty is type A and of the chord of the line: the scatter from cycle to cycle of
    the mean tangent modulus over the segment, over the root of the cycles.  Where fewer than
    four cycles have a curve of their own it is that of the tangent modulus, root mean square
    over the segment, over the root of the windows that fit in it.
    How far the branch is from the line stands beside it as ``segment_misfit`` (root mean
    square): who takes the segment for the curve adds what that means to him.

    NaN for a branch with fewer than six bins.

    Examples
    --------
    Two lines meet at a strain of 1.2: 100 and 300 N per unit strain on 1 cm2.

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
    if areas.shape != (n_specimens,):
        raise DataError(
            "the areas do not pair up with the curves",
            found=f"shape {areas.shape}",
            needed=f"({n_specimens},)",
        )
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
        criterion="fewest contiguous segments, best breakpoints, whose rms distance from the "
        f"mean branch is within {100 * settings.segment_tolerance:g} % of its range of tension and "
        f"its roughness, at most {settings.maximum_segments}",
    )


def _reached(curves: ModulusCurves, at: tuple[int, ...]) -> Bools:
    """Bins of a branch that nearly all of its cycles reach, shape (n_bins,)."""
    count = curves.tangent_modulus_count[at]
    reached: Bools = np.isfinite(curves.branch_tension[at]) & (count >= _REACHED * count.max())
    return reached


def _segment_columns(
    curves: ModulusCurves, at: tuple[int, ...], area: float, settings: ModulusSettings
) -> Floats:
    """Modulus, its uncertainty, strains, tensions, misfit, their uncertainty: (9, n_segments)."""
    used = _reached(curves, at)
    strain, tension = curves.strain_bin[used], curves.branch_tension[at][used]
    # roughness from bin to bin: a drift of the whole branch from cycle to cycle bends no line
    rough = float(np.sqrt(np.mean(np.diff(tension, n=2) ** 2) / 6))
    tolerance = settings.segment_tolerance * (float(np.ptp(tension)) or 1.0)
    lines = fit_piecewise_lines(
        strain,
        tension,
        standard_uncertainty=np.full(strain.size, np.hypot(tolerance, rough)),
        maximum_segments=settings.maximum_segments,
    )
    line = _choose(lines, strain.size)
    low, high = line.knot[:-1], line.knot[1:]
    modulus = np.diff(line.ordinate) / (area * (high - low))
    distance = tension - np.interp(strain, line.knot, line.ordinate)
    uncertainty, misfit = [], []
    for start, stop in zip(low, high, strict=True):
        inside = (strain >= start) & (strain <= stop)
        misfit.append(np.sqrt(np.mean(distance[inside] ** 2)))
        uncertainty.append(
            _spread(curves, at, used, inside, windows=(stop - start) / curves.window)
        )
    rows = [modulus, uncertainty, low, high, line.ordinate[:-1], line.ordinate[1:], misfit]
    # from cycle to cycle the branch moves as a whole: the line there is no surer than the branch
    scatter = curves.branch_tension_standard_uncertainty[at][used]
    known = np.isfinite(scatter)
    at_knot = np.full(line.knot.size, np.nan)
    if known.any():
        at_knot = np.interp(line.knot, strain[known], scatter[known])
    rows += [at_knot[:-1], at_knot[1:]]
    return np.array(rows, dtype=np.float64)


def _spread(
    curves: ModulusCurves, at: tuple[int, ...], used: Bools, inside: Bools, *, windows: float
) -> float:
    """Standard uncertainty of the mean modulus over the bins of a segment."""
    of_cycles = curves.tangent_modulus_by_cycle[at[0], :, at[1]][:, used][:, inside]
    seen = np.isfinite(of_cycles)
    whole = seen.mean(axis=1) >= _REACHED if seen.size else np.zeros(0, dtype=bool)
    if np.count_nonzero(whole) >= _FEWEST_CYCLES:
        means = np.nanmean(of_cycles[whole], axis=1)
        count = float(curves.tangent_modulus_count[at][used][inside].max())
        return float(np.std(means, ddof=1) / np.sqrt(max(count, 1.0)))
    variance = curves.tangent_modulus_standard_uncertainty[at][used][inside] ** 2
    known = variance[np.isfinite(variance)]
    return float(np.sqrt(known.mean() / max(windows, 1.0))) if known.size else float("nan")
