"""Result of a hold of one specimen: relaxation at constant length, creep at constant tension."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.notes import Note


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
        Mean strain [1]; tension at the start and at the end of the hold, each from a
        line through a short stretch that ``made`` names. [N]
    relaxation_drop, relaxation_drop_standard_uncertainty : float
        Fraction of the initial tension lost over the hold. [1]
    rate_per_decade, rate_per_decade_standard_uncertainty : float
        Fraction of tension (relaxation) or strain (creep) per decade of time. [1]
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
    refusals : tuple of Note
        Numbers that are missing, each with its reason.
    notes : tuple of Note
        Further remarks on the result.
    made : tuple of str
        History: samples used at each end, treatment of the finite ramp.
    ramp_centre_time : float
        Time at which the ramp acts as a step: zero of time for the rate per decade; NaN where the
        record does not show the ramp. [s]
    ramp_end_time, ramp_duration : float
        End of the ramp, between two samples; duration of the equivalent constant-rate ramp,
        whose triple the rate per decade leaves out. [s]
    logged_peak_tension, ramp_end_tension : float
        Greatest logged tension near the end of the ramp; tension of the Prony series at the end
        of the ramp. [N]
    hold_strain_standard_uncertainty : float
        Type A, of the mean, as are the next ones. [1]
    hold_initial_tension_standard_uncertainty, hold_final_tension_standard_uncertainty : float
        [N]
    tension_at_time_standard_uncertainty, strain_at_time_standard_uncertainty : ndarray
        Shape (n_times,), or empty. [N], [1]
    is_unloading : bool
        Whether tension fell on the ramp that led to the hold.
    prony_fraction_at_ramp_end : ndarray, shape (n_terms,)
        Fraction of each term left at the end of the ramp. [1]
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
    refusals: tuple[Note, ...] = field(default=())
    notes: tuple[Note, ...] = field(default=())
    made: tuple[str, ...] = field(default=())
    ramp_centre_time: float = float("nan")
    ramp_end_time: float = float("nan")
    ramp_duration: float = float("nan")
    logged_peak_tension: float = float("nan")
    ramp_end_tension: float = float("nan")
    hold_strain_standard_uncertainty: float = float("nan")
    hold_initial_tension_standard_uncertainty: float = float("nan")
    hold_final_tension_standard_uncertainty: float = float("nan")
    tension_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    strain_at_time_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    is_unloading: bool = False
    prony_fraction_at_ramp_end: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def refused(self) -> str:
        """Numbers that it does not give, each with the reason; empty where it gives all."""
        return "; ".join(str(one) for one in self.refusals)


def hold_numbers(holds: Sequence[HoldResult]) -> Integers:
    """Number of each hold in its test, by time from 1; shared by all specimens in the machine.

    Equal where the holds begin together.

    Notes
    -----
    This numbering is not from the report: WHOI-2005-10 does not number its holds.

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
