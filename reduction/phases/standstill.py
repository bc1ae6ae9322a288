"""Where the crosshead stands still: holds under tension and rests at slack."""

from __future__ import annotations

from dataclasses import dataclass

from reduction.record import Bools, Floats, Integers, freeze_arrays

__all__ = ["Standstills"]


@dataclass(frozen=True)
class Standstills:
    """Every interval in which the crosshead stands still, in order of time.

    Parameters
    ----------
    first, last : ndarray of int, shape (n_standstills,)
        First and last sample, both inside.
    start_time, end_time : ndarray, shape (n_standstills,)
        Elapsed time at them. [s]
    mean_position : ndarray, shape (n_standstills,)
        Mean crosshead position. [m]
    mean_tension : ndarray, shape (n_specimens, n_standstills)
        Mean tension over the interval. [N]
    is_rest : ndarray of bool, shape (n_standstills,)
        True where every specimen is slack.
    position_tolerance : float
        Range of position that was allowed inside a standstill. [m]
    slack_tension : float
        Tension at or below which a standstill is a rest. [N]
    """

    first: Integers
    last: Integers
    start_time: Floats
    end_time: Floats
    mean_position: Floats
    mean_tension: Floats
    is_rest: Bools
    position_tolerance: float
    slack_tension: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def n_standstills(self) -> int:
        """Number of intervals."""
        return int(self.first.shape[0])
