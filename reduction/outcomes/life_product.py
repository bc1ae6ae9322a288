"""What statistics make of cycles to failure.

References
----------
.. [1] CG-D-39-80, section 5 and Figure 19.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import Literal

from reduction.record import Floats, Integers, read_only_arrays

LifeDistribution = Literal["weibull", "lognormal"]


@dataclass(frozen=True)
class LifeFit:
    """Lives of one group of specimens, run-outs counted as what they are.

    Parameters
    ----------
    life, low, high : float
        Cycles by which ``failed_share`` of the specimens have failed, and its bounds. [1]
    life_standard_uncertainty : float
        To first order, from the observed information (type A). [1]
    log_location, log_scale : float
        Of ln cycles; for a Weibull law ln of the characteristic life and one over the shape.
    log_location_uncertainty, log_scale_uncertainty : float
        Standard, from the observed information.
    log_likelihood : float
        Of the cycles themselves, to compare laws.
    reason : int
        A key of `REASONS`.
    """

    distribution: LifeDistribution
    failed_share: float
    confidence: float
    n_failed: int
    n_suspended: int
    life: float = nan
    life_standard_uncertainty: float = nan
    low: float = nan
    high: float = nan
    log_location: float = nan
    log_scale: float = nan
    log_location_uncertainty: float = nan
    log_scale_uncertainty: float = nan
    log_likelihood: float = nan
    reason: int = 0


@dataclass(frozen=True)
@read_only_arrays
class LoadLife:
    """Life against peak load: ln N = ``log_life`` - ``exponent`` ln(S / S_0) + scatter.

    Parameters
    ----------
    log_life : float
        ln of the median life at ``reference_load_ratio``, S_0. [1]
    exponent : float
        m: how many times steeper ln N falls than ln S rises. [1]
    log_scale : float
        Of ln N about the line; for a Weibull law one over the shape. [1]
    covariance : ndarray, shape (3, 3)
        Of log_life, exponent and log_scale, from the observed information.
    log_likelihood : float
        Of the cycles themselves.
    lack_of_fit_chi_square, lack_of_fit_p_value : float
        Twice the gain in log likelihood when each level has a median of its own;
        NaN where there are no more than two levels.
    lack_of_fit_degrees_of_freedom : int
    load_ratio_low, load_ratio_high : float
        Range of peak loads tested, run-outs with them. [1]
    """

    distribution: LifeDistribution
    reference_load_ratio: float
    log_life: float
    exponent: float
    log_scale: float
    covariance: Floats
    log_likelihood: float
    lack_of_fit_chi_square: float
    lack_of_fit_p_value: float
    lack_of_fit_degrees_of_freedom: int
    load_ratio_low: float
    load_ratio_high: float
    n_failed: int
    n_suspended: int


@dataclass(frozen=True)
@read_only_arrays
class SnapLevels:
    """What tests with a slack line in each cycle say, by level of peak load, rising.

    Parameters
    ----------
    peak_load_ratio : ndarray, shape (n_levels,)
        Mean of the tests of a level. [1]
    n_failed, n_suspended : ndarray of int, shape (n_levels,)
    mean_cycles : ndarray, shape (n_levels,)
        Of the failures alone, as Figure 19 of CG-D-39-80 joins them. [1]
    least_cycles, most_cycles : ndarray, shape (n_levels,)
        Over all tests of a level. [1]
    failed_share_high : ndarray, shape (n_levels,)
        Upper bound of the share that fails before the shortest run-out of the level. [1]
    threshold_low : float
        Highest level without failure that has none below it either; NaN if there is none. [1]
    threshold_high : float
        Lowest level with a failure; NaN if nothing failed. [1]
    n_never_slack : int
        Tests left out, since their line keeps a tension.
    confidence : float
    notes : tuple of str
    """

    peak_load_ratio: Floats
    n_failed: Integers
    n_suspended: Integers
    mean_cycles: Floats
    least_cycles: Floats
    most_cycles: Floats
    failed_share_high: Floats
    threshold_low: float
    threshold_high: float
    n_never_slack: int
    confidence: float
    notes: tuple[str, ...] = ()
