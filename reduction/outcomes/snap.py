"""Cyclic loading that leaves the line slack in each cycle: which peak load it survives.

References
----------
.. [1] CG-D-39-80, section 5 and Figure 19: nylon plaited 1/2 inch fails in fatigue where the
   peak load exceeds about 30 % of the rated break strength (between 27 and 35 %), and not
   by 200,000 cycles below; with 3 % kept in the line, not even at 62 %.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.outcomes.fatigue import load_levels
from reduction.outcomes.life_product import SnapLevels
from reduction.record import Bools, Floats, Integers


def _threshold(
    load: Floats, failed: Integers, suspended: Integers
) -> tuple[float, float, tuple[str, ...]]:
    """Highest level without failure at or below it, lowest with one, and what contradicts."""
    has_failed = failed > 0
    high = float(load[has_failed][0]) if has_failed.any() else float("nan")
    below = ~has_failed & ~(load > high)
    low = float(load[below][-1]) if below.any() else float("nan")
    survived = (suspended > 0) & (load > high)
    if not survived.any():
        return low, high, ()
    note = (
        f"a line failed at {100 * high:.3g} % of its break strength, and one survived "
        f"{100 * load[survived][-1]:.3g} %: the threshold is no sharp load"
    )
    return low, high, (note,)


def summarise_snap_loading(
    peak_load_ratio: ArrayLike,
    minimum_load_ratio: ArrayLike,
    cycles: ArrayLike,
    is_suspended: ArrayLike,
    *,
    slack_load_ratio: float = 0.0,
    confidence: float = 0.95,
) -> SnapLevels:
    r"""What each level of peak load did to lines that go slack, and where failures begin.

    Parameters
    ----------
    peak_load_ratio, minimum_load_ratio : array_like, shape (n,)
        Of each cycle over the rated break strength; a minimum that is NaN is not stated. [1]
    cycles : array_like, shape (n,)
        To failure, or to the end of a test that was stopped. [1]
    is_suspended : array_like of bool, shape (n,)
        True for a run-out or a suspended test. [1]
    slack_load_ratio : float
        Greatest minimum load at which a line counts as slack. [1]
    confidence : float
        Of the upper bound of the share that fails. [1]

    Returns
    -------
    levels : SnapLevels
        Threshold loads are those of the tests; none is assumed.

    Raises
    ------
    DataError
        If the series do not pair up, a number cannot be, or no test has a slack line.

    Notes
    -----
    Of m lines that all survived, the share p that would have failed by then is bounded
    by :math:`(1 - p)^m = 1 - c` [-].  The three samples a level of [1]_ leave it at 63 % (95 %):
    its 30 % of break strength is where failures were seen to end, not a safe load.

    Examples
    --------
    >>> levels = summarise_snap_loading([0.35, 0.35, 0.35, 0.27, 0.27, 0.27], [0.0] * 6,
    ...     [90e3, 120e3, 150e3, 200e3, 200e3, 200e3], [False] * 3 + [True] * 3)
    >>> print(levels.threshold_low, levels.threshold_high, levels.failed_share_high[0].round(2))
    0.27 0.35 0.63
    """
    load, lives = as_positive("peak_load_ratio", peak_load_ratio), as_positive("cycles", cycles)
    least = np.asarray(minimum_load_ratio, dtype=np.float64)
    stopped: Bools = np.asarray(is_suspended, dtype=np.bool_)
    if not load.shape == least.shape == lives.shape == stopped.shape or load.ndim != 1:
        raise DataError(
            "loads, cycles and suspensions do not pair up",
            found=f"shapes {load.shape}, {least.shape}, {lives.shape}, {stopped.shape}",
            needed="equal lengths",
        )
    if not 0 < confidence < 1:
        raise DataError(
            "a confidence is not between 0 and 1", found=f"{confidence:g}", needed="0 to 1"
        )
    slack = least <= slack_load_ratio
    if not slack.any():
        raise DataError(
            "no test has a line that goes slack",
            found=f"least minimum load {100 * np.nanmin(least, initial=np.inf):.3g} %",
            needed=f"a minimum load of {100 * slack_load_ratio:.3g} % or less",
            hint="Use fit_load_life for lines that keep a tension.",
        )
    not_stated = int(np.isnan(least).sum())
    notes = (f"{not_stated} tests without a minimum load are left out",) if not_stated else ()
    load, lives, stopped = load[slack], lives[slack], stopped[slack]
    level = load_levels(load)
    n_levels = int(level.max()) + 1
    failed = np.bincount(level[~stopped], minlength=n_levels)
    suspended = np.bincount(level[stopped], minlength=n_levels)
    shortest, longest = np.full(n_levels, np.inf), np.zeros(n_levels)
    np.minimum.at(shortest, level, lives)
    np.maximum.at(longest, level, lives)
    mean_load = np.bincount(level, weights=load) / np.bincount(level)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_cycles = np.bincount(level[~stopped], lives[~stopped], n_levels) / failed
        share = 1 - (1 - confidence) ** (1 / suspended)
    low, high, contradiction = _threshold(mean_load, failed, suspended)
    return SnapLevels(
        peak_load_ratio=mean_load,
        n_failed=failed,
        n_suspended=suspended,
        mean_cycles=mean_cycles,
        least_cycles=shortest,
        most_cycles=longest,
        failed_share_high=np.where(failed == 0, share, np.nan),
        threshold_low=low,
        threshold_high=high,
        n_never_slack=int((least > slack_load_ratio).sum()),
        confidence=confidence,
        notes=notes + contradiction,
    )
