"""What the six change-in-length properties are made from, and what they are.

A step is as an archive keeps it: one specimen, numbers without samples.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from reduction.record import Floats, read_only_arrays

PropertyName = Literal[
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
]
PROPERTY_NAMES: tuple[PropertyName, ...] = (
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
)
"""In the order of the abstract."""
_NAN = float("nan")
MANY = float("inf")
"""Degrees of freedom of a regression on many samples. [1]"""
RISE_GAP = 1.5
"""Strains of a rise further apart than this, over the grid's spacing, have a gap between them."""


def _none_shared() -> Floats:
    return np.empty(0)


@dataclass(frozen=True)
@read_only_arrays
class StepNumber:
    """A number of a step, and the two parts of its uncertainty.

    Parameters
    ----------
    value, random_standard_uncertainty : float
        The uncertainty is of what nothing else shares. [as the quantity]
    contribution : ndarray, shape (n_components,)
        Signed, of each error that the numbers of the step share. [as the quantity]
    degrees_of_freedom : float
        Of the random part. [1]
    """

    value: float
    random_standard_uncertainty: float
    contribution: Floats = field(default_factory=_none_shared)
    degrees_of_freedom: float = MANY


@dataclass(frozen=True)
@read_only_arrays
class FirstRise:
    """Tension on the first rise of a test, at two strains or more, all of them known.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        Rising; a gap is where the rise was held or has too few samples. [1]
    tension, tension_random_standard_uncertainty : ndarray, shape (n_points,)
        [N]
    spacing : float
        Of the grid that the strains are on. [1]
    strain_contribution, tension_contribution : ndarray, shape (n_components, n_points)
        By which each shared error moves the points. [1], [N]
    """

    strain: Floats
    tension: Floats
    tension_random_standard_uncertainty: Floats
    spacing: float
    strain_contribution: Floats
    tension_contribution: Floats


@dataclass(frozen=True)
@read_only_arrays
class BeddingCycles:
    """Cycles that bed a rope in.

    Parameters
    ----------
    first_stiffness : StepNumber
        Secant of the first cycle. [N]
    permanent_strain : StepNumber
        By which the foot of the loop moved, at equal tension. [1]
    foot_strain : float
        At the foot of the first cycle. [1]
    foot_strain_contribution : ndarray, shape (n_components,)
        By which each shared error moves that strain. [1]
    valley_tension, first_peak_tension, peak_tension : float
        Of the first cycle, and the greatest of all. [N]
    """

    first_stiffness: StepNumber
    permanent_strain: StepNumber
    foot_strain: float
    foot_strain_contribution: Floats
    valley_tension: float
    first_peak_tension: float
    peak_tension: float


@dataclass(frozen=True)
class CyclicLevel:
    """Dynamic stiffness of one level: mean over its last cycles. [N]."""

    stiffness: StepNumber
    mean_tension: float
    tension_amplitude: float


@dataclass(frozen=True)
class PairOfHolds:
    """Static stiffness [N] between two held tensions [N]; NaN with a reason where it has none.

    ``reason`` may stand beside a number, too: that the line was read beyond the hold.
    """

    low_tension: StepNumber
    high_tension: StepNumber
    stiffness: StepNumber
    reference_time: float
    reason: str = ""


@dataclass(frozen=True)
class HeldTension:
    """Creep a decade [1] of one hold at a tension [N]; NaN with a reason.

    ``end_time`` [s] is that of the hold since the centre of the ramp to it.
    """

    tension: float
    end_time: float
    creep_per_decade: StepNumber
    reason: str = ""


@dataclass(frozen=True)
@read_only_arrays
class StepOfProgramme:
    """One step of the programme of one specimen; parts that it does not give are None, or empty.

    Parameters
    ----------
    name : str
        Of the test or step.
    reference_time : float
        After loading, from which polymer strain counts. [s]
    first_rise : FirstRise or None
        Of the test.
    bedding : BeddingCycles or None
        Of a step that beds the rope in.
    level : CyclicLevel or None
        Of a step of cycles of a settled rope.
    pairs : tuple of PairOfHolds
        In time.
    holds : tuple of HeldTension
        In time.
    strength_contribution : ndarray, shape (n_components,)
        Relative, of each error that the numbers of the step share to the rated break strength. [1]
    """

    name: str
    reference_time: float
    first_rise: FirstRise | None = None
    bedding: BeddingCycles | None = None
    level: CyclicLevel | None = None
    pairs: tuple[PairOfHolds, ...] = ()
    holds: tuple[HeldTension, ...] = ()
    strength_contribution: Floats = field(default_factory=_none_shared)


@dataclass(frozen=True)
@read_only_arrays
class ChangeInLength:
    """One property between two tensions; NaN with a reason where the record does not support it.

    Parameters
    ----------
    name : str
        One of the six.
    value, random_standard_uncertainty : float
        [N] of a stiffness, [1] of a strain
    over_strength, over_strength_random_standard_uncertainty : float
        A stiffness over the rated break strength; NaN of a strain. [1]
    low_tension, high_tension : float
        Between which it holds; one number twice for a hold. [N]
    reference_time : float
        Where a time belongs to it. [s]
    step : str
        Which step it is from.
    reason : str
        Why there is no number, or what is not in it.
    contribution, over_strength_contribution : ndarray, shape (n_components,)
        Signed, of each error that the numbers of that step share. [as the number]
    degrees_of_freedom : float
        Of the random part. [1]
    """

    name: PropertyName
    value: float = _NAN
    random_standard_uncertainty: float = _NAN
    over_strength: float = _NAN
    over_strength_random_standard_uncertainty: float = _NAN
    low_tension: float = _NAN
    high_tension: float = _NAN
    reference_time: float = _NAN
    step: str = ""
    reason: str = ""
    contribution: Floats = field(default_factory=_none_shared)
    over_strength_contribution: Floats = field(default_factory=_none_shared)
    degrees_of_freedom: float = MANY

    @property
    def is_stiffness(self) -> bool:
        """True of a stiffness, in N; False of a strain."""
        return self.name.endswith("stiffness")

    def with_number(self, number: StepNumber) -> ChangeInLength:
        """Return the property as a number of its step has it."""
        return replace(
            self,
            value=number.value,
            random_standard_uncertainty=number.random_standard_uncertainty,
            contribution=number.contribution,
            degrees_of_freedom=number.degrees_of_freedom,
        )

    @property
    def standard_uncertainty(self) -> float:
        """Shared and random parts together."""
        return _together(self.contribution, self.random_standard_uncertainty)

    @property
    def over_strength_standard_uncertainty(self) -> float:
        """Shared and random parts of that over the strength together."""
        return _together(
            self.over_strength_contribution, self.over_strength_random_standard_uncertainty
        )


def _together(contribution: Floats, random: float) -> float:
    return float(np.sqrt(np.sum(contribution**2) + random**2))
