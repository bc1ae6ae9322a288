"""What the six change-in-length properties are made from, and what they are.

A step is as an archive keeps it: one specimen, numbers without samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from reduction.record import Floats, freeze_arrays

__all__ = [
    "PROPERTY_NAMES",
    "BeddingCycles",
    "ChangeInLength",
    "CyclicLevel",
    "FirstRise",
    "HeldTension",
    "PairOfHolds",
    "PropertyName",
    "StepOfProgramme",
]

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


@dataclass(frozen=True)
class FirstRise:
    """Tension on the first rise of a test, at two strains or more, all of them known.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        Rising; a gap is where the rise was held or has too few samples. [1]
    tension, tension_standard_uncertainty : ndarray, shape (n_points,)
        [N]
    spacing : float
        Of the grid that the strains are on. [1]
    """

    strain: Floats
    tension: Floats
    tension_standard_uncertainty: Floats
    spacing: float

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


@dataclass(frozen=True)
class BeddingCycles:
    """Cycles that bed a rope in.

    Parameters
    ----------
    first_stiffness, first_stiffness_standard_uncertainty : float
        Secant of the first cycle. [N]
    permanent_strain, permanent_strain_standard_uncertainty : float
        By which the foot of the loop moved, at equal tension. [1]
    foot_strain, foot_strain_standard_uncertainty : float
        At the foot of the first cycle. [1]
    valley_tension, first_peak_tension, peak_tension : float
        Of the first cycle, and the greatest of all. [N]
    """

    first_stiffness: float
    first_stiffness_standard_uncertainty: float
    permanent_strain: float
    permanent_strain_standard_uncertainty: float
    foot_strain: float
    foot_strain_standard_uncertainty: float
    valley_tension: float
    first_peak_tension: float
    peak_tension: float


@dataclass(frozen=True)
class CyclicLevel:
    """Dynamic stiffness of one level: mean over its last cycles. [N]."""

    stiffness: float
    stiffness_standard_uncertainty: float
    mean_tension: float
    tension_amplitude: float


@dataclass(frozen=True)
class PairOfHolds:
    """Static stiffness [N] between two held tensions [N]; NaN with a reason where it has none.

    ``reason`` may stand beside a number, too: that the line was read beyond the hold.
    """

    low_tension: float
    high_tension: float
    stiffness: float
    stiffness_standard_uncertainty: float
    reference_time: float
    reason: str = ""


@dataclass(frozen=True)
class HeldTension:
    """Creep a decade [1] of one hold at a tension [N]; NaN with a reason.

    ``end_time`` [s] is that of the hold since the centre of the ramp to it.
    """

    tension: float
    end_time: float
    creep_per_decade: float
    creep_per_decade_standard_uncertainty: float
    reason: str = ""


@dataclass(frozen=True)
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
    """

    name: str
    reference_time: float
    first_rise: FirstRise | None = None
    bedding: BeddingCycles | None = None
    level: CyclicLevel | None = None
    pairs: tuple[PairOfHolds, ...] = ()
    holds: tuple[HeldTension, ...] = ()


@dataclass(frozen=True)
class ChangeInLength:
    """One property between two tensions; NaN with a reason where the record does not support it.

    Parameters
    ----------
    name : str
        One of the six.
    value, standard_uncertainty : float
        Type A. [N] of a stiffness, [1] of a strain
    over_strength, over_strength_standard_uncertainty : float
        A stiffness over the rated break strength; NaN of a strain. [1]
    low_tension, high_tension : float
        Between which it holds; one number twice for a hold. [N]
    reference_time : float
        Where a time belongs to it. [s]
    step : str
        Which step it is from.
    reason : str
        Why there is no number, or what is not in it.
    """

    name: PropertyName
    value: float = _NAN
    standard_uncertainty: float = _NAN
    over_strength: float = _NAN
    over_strength_standard_uncertainty: float = _NAN
    low_tension: float = _NAN
    high_tension: float = _NAN
    reference_time: float = _NAN
    step: str = ""
    reason: str = ""

    @property
    def is_stiffness(self) -> bool:
        """True of a stiffness, in N; False of a strain."""
        return self.name.endswith("stiffness")
