"""A hose prediction as it was asked for and as it came out.

`reduction.pipeline.prediction` makes it, `reduction.archive` stores it; neither knows the other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from reduction.predict.product import HoseDesign

__all__ = ["HelicalLayer", "HosePlan"]


@dataclass(frozen=True)
class HelicalLayer:
    """A layer that carries no load: fish-bite protection, conductors.

    ``wrap_angle`` is from the axis [rad]; ``strain_limit`` is the greatest tensile strain
    that it bears [1], NaN where none is stated.
    """

    name: str
    wrap_angle: float
    strain_limit: float


@dataclass(frozen=True)
class HosePlan:
    """What is to be predicted.

    ``standard_uncertainty`` is by name of `reduction.predict.product.HOSE_PARAMETERS`, in the
    unit of that number; ``strain_step`` and ``greatest_strain`` are of the whole length [1],
    the latter NaN to go on to the break of the cords.
    """

    name: str
    design: HoseDesign
    standard_uncertainty: dict[str, float] = field(default_factory=dict)
    strain_step: float = 0.01
    greatest_strain: float = float("nan")
    layers: tuple[HelicalLayer, ...] = ()
