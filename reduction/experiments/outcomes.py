"""Outcomes without a log: breaks, abrasion, cycles to failure.

References
----------
.. [1] CG-D-39-80, Tables 10, 20, 21, A-3, A-4, Figures 15 and 19.
.. [2] CG-D-39-80, section 5 and Figure 19.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from typing import Literal

import numpy as np
from numpy import int8
from numpy.typing import ArrayLike, NDArray

from reduction.record.measurement import Floats, Integers, read_only_arrays

OutcomeQuantity = Literal[
    "tensile_strength", "strain_at_failure", "cycles_to_failure", "abrasion_cycles"
]

Place = Literal["free", "splice_toe", "splice", "thimble", "grip", "not_stated"]

IN_THE_TERMINATION = ("splice", "thimble", "grip")
"""Breaks of the termination instead of the line: its strength is at least the value."""

REASONS: dict[int, str] = {
    0: "",
    1: "fewer than two values: there is no deviation",
    2: "no deviation is known for one of the means",
    3: "the reference mean is not known well enough to divide by it",
    4: "there is no deviation within the groups",
    5: "no failure: only a lower bound can be given",
    6: "one failure does not tell the deviation of lives",
    7: "the failures have no deviation",
}
"""Reasons for a NaN."""


@dataclass(frozen=True)
class Outcome:
    """One row of a table of outcomes, in SI.

    Parameters
    ----------
    quantity : str
        ``tensile_strength`` [N], ``strain_at_failure`` [1], ``cycles_to_failure`` or
        ``abrasion_cycles`` [1].
    value : float
        In the unit of ``quantity``; NaN where an invalid test gave none.
    test, specimen : str
        Names, if given.
    line, material, construction, condition : str
        Properties that define a group; empty if not given.
    diameter : float
        Nominal diameter; NaN if not given. [m]
    exposure : float
        Time in the field; NaN if not given, 0 for a new line. [year]
    minimum_load, peak_load : float
        Limits of each cycle; NaN if not given. [N]
    minimum_load_ratio, peak_load_ratio : float
        The same over the rated break strength; NaN if not given. [1]
    mode : str
        Description of the failure, in the laboratory's words.
    place : str
        Place of the failure: `Place`.
    is_valid : bool
        Validity of the value as the laboratory states; a break in the termination is not valid
        unless the laboratory says so.
    is_suspended : bool
        True for a run-out, or a test that was stopped.
    note : str
    row : int
        Row of the file, counting the header as 1; 0 if there is none.
    """

    quantity: OutcomeQuantity
    value: float
    test: str = ""
    specimen: str = ""
    line: str = ""
    material: str = ""
    construction: str = ""
    condition: str = ""
    diameter: float = nan
    exposure: float = nan
    minimum_load: float = nan
    peak_load: float = nan
    minimum_load_ratio: float = nan
    peak_load_ratio: float = nan
    mode: str = ""
    place: Place = "not_stated"
    is_valid: bool = True
    is_suspended: bool = False
    note: str = ""
    row: int = 0

    @property
    def use(self) -> Literal["value", "lower_bound", "excluded"]:
        """Use of the value: as the strength of the line, as a lower bound of it, or not."""
        if not self.is_valid:
            is_bound = self.place in IN_THE_TERMINATION and self.value > 0
            return "lower_bound" if is_bound else "excluded"
        return "lower_bound" if self.is_suspended else "value"


@dataclass(frozen=True)
@read_only_arrays
class GroupStatistics:
    """Mean and deviation of groups, shape (n_groups,); NaN with a reason if not available.

    Parameters
    ----------
    n : ndarray of int
        Number of values valid for the line.
    n_lower_bound, n_excluded : ndarray of int
        Number of values that are lower bounds, and of values left out.
    mean, standard_deviation, minimum, maximum : ndarray
        Of the ``n`` values; the deviation is divided by n - 1.
    relative_variability : ndarray
        Deviation over mean. [1]
    mean_standard_uncertainty : ndarray
        Deviation over root n (type A).
    lower_bound_mean : ndarray
        Mean of the lower bounds alone; not a strength of the line.
    reason : ndarray of int8
        Reason for a missing deviation; a key of `REASONS`.
    """

    n: Integers
    n_lower_bound: Integers
    n_excluded: Integers
    mean: Floats
    standard_deviation: Floats
    minimum: Floats
    maximum: Floats
    relative_variability: Floats
    mean_standard_uncertainty: Floats
    lower_bound_mean: Floats
    reason: NDArray[int8]


@dataclass(frozen=True)
@read_only_arrays
class RatioOfMeans:
    """A mean over a reference mean, and its change; every array has the shape of the input.

    ``change`` is ratio - 1; ``low`` and ``high`` are the ends of its interval (Fieller), and
    ``standard_uncertainty`` is that of the ratio to first order.  ``reason`` explains an
    interval of NaN.
    """

    ratio: Floats
    change: Floats
    low: Floats
    high: Floats
    standard_uncertainty: Floats
    degrees_of_freedom: Floats
    reason: NDArray[int8]


@dataclass(frozen=True)
@read_only_arrays
class OneWay:
    """One-way analysis of groups; every array has the shape of the input without its last axis.

    ``f_statistic`` assumes one deviation for all groups.
    """

    f_statistic: Floats
    between: Integers
    within: Integers
    p_value: Floats
    critical: Floats
    reason: NDArray[int8]


@dataclass(frozen=True)
class CensoredMean:
    """Mean and deviation of strength where some breaks are lower bounds, in the unit of the values.

    ``low`` and ``high`` are ends of the interval of the mean; ``reason`` a key of `REASONS`.
    """

    n: int
    n_lower_bound: int
    mean: float = nan
    standard_deviation: float = nan
    low: float = nan
    high: float = nan
    reason: int = 0


@dataclass(frozen=True)
@read_only_arrays
class ExposureTrend:
    """Strength against exposure as a straight line: ``intercept + slope * exposure``.

    Parameters
    ----------
    intercept, slope : float
        In the unit of the strength, and in that unit per year.
    covariance : ndarray, shape (2, 2)
        Of intercept and slope (type A).
    residual_standard_deviation : float
        For one break about the line.
    degrees_of_freedom : int
        Of that deviation.
    lack_of_fit_p_value : float
        Test whether the means of the exposures lie on a line, compared with the deviation
        of breaks of one exposure; NaN if no exposure is repeated or there are only two.
    exposure_low, exposure_high : float
        Range of exposures. [year]
    n : int
        Number of breaks.
    """

    intercept: float
    slope: float
    covariance: Floats
    residual_standard_deviation: float
    degrees_of_freedom: int
    lack_of_fit_p_value: float
    exposure_low: float
    exposure_high: float
    n: int


def reason_codes(shape: tuple[int, ...], cases: Sequence[tuple[ArrayLike, int]]) -> NDArray[int8]:
    """Code of the first case that holds, 0 if none does.

    Examples
    --------
    >>> print(reason_codes((3,), [([True, True, False], 4), (True, 1)]))
    [4 4 1]
    """
    codes = np.zeros(shape, dtype=int8)
    for holds, code in reversed(list(cases)):
        codes = np.where(np.broadcast_to(np.asarray(holds), shape), np.int8(code), codes)
    return codes


LifeDistribution = Literal["weibull", "lognormal"]


@dataclass(frozen=True)
class LifeFit:
    """Lives of one group of specimens, with run-outs as lower bounds.

    Parameters
    ----------
    life, low, high : float
        Cycles by which a fraction ``failed_share`` of the specimens has failed, and its bounds. [1]
    life_standard_uncertainty : float
        To first order, from the observed information (type A). [1]
    log_location, log_scale : float
        Of ln cycles; for a Weibull law, ln of the characteristic life and one over the shape.
    log_location_uncertainty, log_scale_uncertainty : float
        Standard uncertainties, from the observed information.
    log_likelihood : float
        For the cycles themselves, to compare laws.
    reason : int
        A key of `REASONS`.
    """

    distribution: LifeDistribution
    failed_share: float
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
        m, the ratio of the fall of ln N to the rise of ln S. [1]
    log_scale : float
        Of ln N about the line; for a Weibull law, one over the shape. [1]
    covariance : ndarray, shape (3, 3)
        Of log_life, exponent and log_scale, from the observed information.
    log_likelihood : float
        For the cycles themselves.
    lack_of_fit_p_value : float
        Of the gain in log likelihood when each level has its own median;
        NaN if there are no more than two levels.
    load_ratio_low, load_ratio_high : float
        Range of peak loads tested, including run-outs. [1]
    """

    distribution: LifeDistribution
    reference_load_ratio: float
    log_life: float
    exponent: float
    log_scale: float
    covariance: Floats
    log_likelihood: float
    lack_of_fit_p_value: float
    load_ratio_low: float
    load_ratio_high: float
    n_failed: int
    n_suspended: int


@dataclass(frozen=True)
@read_only_arrays
class SnapLevels:
    """Results of tests with a slack line in each cycle, by rising level of peak load.

    Parameters
    ----------
    peak_load_ratio : ndarray, shape (n_levels,)
        Mean of the tests of a level. [1]
    n_failed, n_suspended : ndarray of int, shape (n_levels,)
    mean_cycles : ndarray, shape (n_levels,)
        Of the failures only, as joined in Figure 19 of CG-D-39-80. [1]
    least_cycles, most_cycles : ndarray, shape (n_levels,)
        Over all tests of a level. [1]
    failed_share_high : ndarray, shape (n_levels,)
        Upper bound of the fraction that fails before the shortest run-out of the level. [1]
    threshold_low : float
        Highest level with no failure at or below it; NaN if there is none. [1]
    threshold_high : float
        Lowest level with a failure; NaN if nothing failed. [1]
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
    notes: tuple[str, ...] = ()
