r"""Run sheet: what to run, in which order, and how far each run loads the line.

References
----------
.. [1] CG-D-39-80, sec. 4.3: runs ordered by rising peak load, so that the line is
   always tested at successively higher loads.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.record import Floats, Integers, read_only_arrays
from reduction.surface.designs import Design
from reduction.surface.levels import FactorLevels, engineering_levels

RepeatPlacing = Literal["together", "spread"]

SAME_LOAD = 1e-9  # of the greatest peak; levels are typed to three digits


@dataclass(frozen=True)
@read_only_arrays
class RunSheet:
    """Runs in the order in which they are to be run; one row a run.

    Parameters
    ----------
    factors : tuple of FactorLevels, length n_factors
    run : ndarray of int, shape (n_runs,)
        Number of the run in the standard order of the design, from 1.
    coded, engineering : ndarray, shape (n_runs, n_factors)
        Coded levels, and levels in SI. [1], [SI unit of each factor]
    load_block : ndarray of int, shape (n_runs,)
        Runs of equal peak load share a number, from 1 at the lowest; 0 where the peak
        load is not known.
    mean_tension, tension_amplitude, peak_tension, minimum_tension : ndarray, shape (n_runs,)
        NaN where a load is not a factor. [N]
    peak_share, minimum_share : ndarray, shape (n_runs,)
        Of the rated break strength; NaN where that is not given. [1]
    """

    factors: tuple[FactorLevels, ...]
    run: Integers
    coded: Floats
    engineering: Floats
    load_block: Integers
    mean_tension: Floats
    tension_amplitude: Floats
    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.run.size)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the factors."""
        return tuple(factor.name for factor in self.factors)


def _spread(order: Integers, coded: Floats) -> Integers:
    """Move repeats of a run to later places at even distances, the last to the end.

    Only later: a repeat before its own place would load the line above the runs that
    still follow.
    """
    _, group = np.unique(coded[order], axis=0, return_inverse=True)
    group = group.ravel()
    repeat = np.array([np.sum(group[:place] == group[place]) for place in range(order.size)])
    moved = repeat > 0
    kept = order[~moved]
    # Runs kept before each repeat: those up to its first, and its share of the rest.
    own = (np.cumsum(~moved))[moved]
    rest = kept.size - own
    spread: Integers = np.insert(
        kept,
        own + repeat[moved] * rest // (np.bincount(group)[group[moved]] - 1),
        order[moved],
    )
    return spread


def make_run_sheet(
    design: Design,
    factors: tuple[FactorLevels, ...],
    *,
    rated_break_strength: ArrayLike | None = None,
    repeats: RepeatPlacing = "together",
) -> RunSheet:
    """Run sheet of a design, ordered by rising peak tension.

    Parameters
    ----------
    design : Design
        From `box_behnken` or `plackett_burman`.
    factors : tuple of FactorLevels, length n_factors
        In the order of the columns of the design.
    rated_break_strength : array_like, shape () or (n_runs,), optional
        In the standard order of the design where there is one a run. [N]
    repeats : str
        ``together``: repeated runs follow each other in their load block, as in [1]_;
        ``spread``: the first stands there, the others later at even distances, the last
        at the end, so that their scatter holds what the line has gone through.

    Returns
    -------
    sheet : RunSheet
        Without both ``mean_tension`` and ``tension_amplitude`` among the factors the
        standard order is kept and the loads are NaN.

    Raises
    ------
    SettingsError
        If the factors do not fit the design, a fraction has nothing to refer to, or the
        placing of repeats has another name.
    DataError
        If the break strength is not positive or does not fit the runs.

    Notes
    -----
    Peak is mean plus amplitude, minimum mean less amplitude.  [1]_ gives the order by
    load alone, nine blocks in fifteen runs; within a block the lower mean tension comes
    first, then the lower first factor (frequency in [1]_), then the standard order.
    An order by load is confounded with load, see `reduction.surface.cautions`.

    Examples
    --------
    The peaks of [1]_ for levels of 12 to 30 and 5 to 12 % of the break strength.

    >>> from reduction.surface.designs import box_behnken
    >>> levels = (
    ...     FactorLevels("frequency", 0.1, 0.5),
    ...     FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength"),
    ...     FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength"),
    ... )
    >>> sheet = make_run_sheet(box_behnken(3), levels, rated_break_strength=28.5e3)
    >>> print((100 * sheet.peak_share).round(1)[[0, 1, 3, 4, 6, 9, 11, 12, 14]])
    [17.  20.5 24.  26.  29.5 33.  35.  38.5 42. ]
    """
    if repeats not in ("together", "spread"):
        raise SettingsError(
            "repeats are placed in one of two ways", found=repeats, needed="together or spread"
        )
    levels = engineering_levels(design.coded, factors, rated_break_strength=rated_break_strength)
    names = [factor.name for factor in factors]
    strength = np.nan if rated_break_strength is None else rated_break_strength
    unknown = np.full(design.n_runs, np.nan)
    mean, amplitude = (
        levels[:, names.index(name)] if name in names else unknown
        for name in ("mean_tension", "tension_amplitude")
    )
    peak, minimum = mean + amplitude, mean - amplitude
    standard: Integers = np.arange(design.n_runs)
    order: Integers
    if np.isnan(peak).any():
        block, order = np.zeros(design.n_runs, dtype=np.int64), standard
    else:
        rising = np.argsort(peak, kind="stable")
        steps = np.diff(peak[rising], prepend=-np.inf) > SAME_LOAD * peak.max()
        block = np.empty(design.n_runs, dtype=np.int64)
        block[rising] = np.cumsum(steps)
        order = np.lexsort((standard, design.coded[:, 0], mean, block))
    if repeats == "spread":
        order = _spread(order, design.coded)
    share = np.broadcast_to(strength, peak.shape)[order]
    return RunSheet(
        factors=factors,
        run=order + 1,
        coded=design.coded[order],
        engineering=levels[order],
        load_block=block[order],
        mean_tension=mean[order],
        tension_amplitude=amplitude[order],
        peak_tension=peak[order],
        minimum_tension=minimum[order],
        peak_share=peak[order] / share,
        minimum_share=minimum[order] / share,
    )
