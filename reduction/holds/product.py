"""What the hold stage hands on: one row a hold and specimen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from reduction.record import Floats, Integers, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class HoldResult:
    """Relaxation (constant length) or creep (constant tension) of one specimen in one hold.

    A number that the record does not support is NaN, and ``refusals`` says why.

    Parameters
    ----------
    specimen : str
        Which specimen.
    kind : str
        ``relaxation`` or ``creep``.
    hold_start_time, hold_duration : float
        [s]
    hold_strain, hold_initial_tension, hold_final_tension : float
        Mean strain [1]; tension at the start and at the end of the hold, each the
        mean of a short stretch that the notes name. [N]
    relaxation_drop, relaxation_drop_standard_uncertainty : float
        Share of the initial tension lost over the hold. [1]
    rate_per_decade, rate_per_decade_standard_uncertainty : float
        Share of tension (relaxation) or strain (creep) per decade of time. [1]
    times : ndarray, shape (n_times,)
        Times after the end of the ramp. [s]
    tension_at_time, strain_at_time : ndarray, shape (n_times,)
        NaN where the hold is shorter. [N], [1]
    prony_tension, prony_time : ndarray, shape (n_terms,)
        Terms of the series; empty where refused. [N], [s]
    prony_tension_standard_uncertainty, prony_time_standard_uncertainty : ndarray, shape (n_terms,)
    long_time_tension, long_time_tension_standard_uncertainty : float
        [N]
    criterion : str
        How the number of terms was chosen.
    refusals : tuple of str
        Numbers that are missing, each with its reason.
    notes : tuple of str
        How the finite ramp was treated, and other remarks.
    ramp_centre_time : float
        When the ramp acts as a step: zero of the time of the rate per decade; NaN where the
        record does not show the ramp. [s]
    hold_strain_standard_uncertainty : float
        Of the mean (type A), as the next ones. [1]
    hold_initial_tension_standard_uncertainty, hold_final_tension_standard_uncertainty : float
        [N]
    tension_at_time_standard_uncertainty, strain_at_time_standard_uncertainty : ndarray
        Shape (n_times,), or empty. [N], [1]
    """

    specimen: str
    kind: str
    hold_start_time: float
    hold_duration: float
    hold_strain: float
    hold_initial_tension: float
    hold_final_tension: float
    relaxation_drop: float
    relaxation_drop_standard_uncertainty: float
    rate_per_decade: float
    rate_per_decade_standard_uncertainty: float
    times: Floats
    tension_at_time: Floats
    strain_at_time: Floats
    prony_tension: Floats
    prony_tension_standard_uncertainty: Floats
    prony_time: Floats
    prony_time_standard_uncertainty: Floats
    long_time_tension: float
    long_time_tension_standard_uncertainty: float
    criterion: str = ""
    refusals: tuple[str, ...] = field(default=())
    notes: tuple[str, ...] = field(default=())
    ramp_centre_time: float = float("nan")
    hold_strain_standard_uncertainty: float = float("nan")
    hold_initial_tension_standard_uncertainty: float = float("nan")
    hold_final_tension_standard_uncertainty: float = float("nan")
    tension_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    strain_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))


def hold_numbers(holds: Sequence[HoldResult]) -> Integers:
    """Number of each hold in its test, by time from 1; one for all specimens that stand.

    Parameters
    ----------
    holds : sequence of HoldResult
        Of one test.

    Returns
    -------
    numbers : ndarray of int, shape (n_holds,)
        Equal where the holds begin together. [1]

    Raises
    ------
    AttributeError
        If an entry is no hold.

    Notes
    -----
    Nothing is computed from a report here ([1]_ does not number its holds).

    Examples
    --------
    >>> hold_numbers([]).size
    0

    References
    ----------
    .. [1] WHOI-2005-10, sec. 4.1.
    """
    if not holds:
        return np.empty(0, dtype=np.int64)
    _, place = np.unique([hold.hold_start_time for hold in holds], return_inverse=True)
    return np.asarray(place + 1)
