"""Stepwise tests: dead weights hung one after another, lengths read with a tape."""

from __future__ import annotations

from dataclasses import dataclass

from reduction.record import Bools, Floats, freeze_arrays

__all__ = ["StepwiseResult"]


@dataclass(frozen=True)
class StepwiseResult:
    """A stepwise test reduced; per-step arrays have shape (n_steps,).

    Parameters
    ----------
    clock : tuple of str
        The clock text of each reading, as printed.
    time : ndarray
        Elapsed time from the first reading. [s]
    tension : ndarray
        Weight hung. [N]
    length, eye_to_eye_length : ndarray
        Length between the gauge marks; eye to eye. [m]
    printed_strain : ndarray
        Elongation as recorded; NaN where not recorded. [1]
    strain : ndarray
        Length over the recovered gauge length, minus one. [1]
    branch : ndarray of int
        1 ascending, 2 descending.
    gauge_length, gauge_length_standard_uncertainty : float
        Recovered from length and recorded elongation (median). [m]
    is_inconsistent : ndarray of bool
        Recorded elongation and length disagree by more than reading error.
    is_creep : ndarray of bool
        Length grew while tension fell.
    interval_strain, interval_modulus, interval_modulus_standard_uncertainty : ndarray, (n_steps-1,)
        Middle of each interval between readings [1] and its slope [Pa]; NaN where
        an end is flagged or the weights turn.
    interval_branch : ndarray of int, shape (n_steps-1,)
    secant_modulus : ndarray
        Stress over strain. [Pa]
    notes : tuple of str
    """

    clock: tuple[str, ...]
    time: Floats
    tension: Floats
    length: Floats
    eye_to_eye_length: Floats
    printed_strain: Floats
    strain: Floats
    branch: Floats
    gauge_length: float
    gauge_length_standard_uncertainty: float
    is_inconsistent: Bools
    is_creep: Bools
    interval_strain: Floats
    interval_modulus: Floats
    interval_modulus_standard_uncertainty: Floats
    interval_branch: Floats
    secant_modulus: Floats
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)
