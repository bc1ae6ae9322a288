"""A hose prediction as it was asked for and as it came out.

`reduction.pipeline.prediction` makes it, `reduction.archive` stores it; neither knows the other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from reduction.predict.product import HoseDesign, HoseEvents, HosePrediction
from reduction.predict.uncertainty import HoseUncertainty


@dataclass(frozen=True)
class HelicalLayer:
    """A layer that carries no load: fish-bite protection, conductors.

    ``wrap_angle`` is from the axis [rad]; ``strain_limit`` is the greatest tensile strain
    that it bears and ``compression_limit`` the greatest compressive one, a positive number
    [1]; NaN where none is stated.
    """

    name: str
    wrap_angle: float
    strain_limit: float
    compression_limit: float


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


@dataclass(frozen=True)
class HoseTarget:
    """What a hose is to do where its cords bear their working share.

    ``strain`` is of the whole length [1], ``tension`` the safe working load, None where any
    will do [N].
    """

    strain: float
    tension: float | None


@dataclass(frozen=True)
class LayerResponse:
    """Strain of a layer that carries no load while the hose goes to its working load.

    ``least_strain``, ``greatest_strain`` and ``break_strain``, the greatest one up to the
    break of the cords, are of the layer [1]; ``least_angle`` is the smallest angle at which it
    is not stretched beyond its limit, ``greatest_angle`` the greatest at which it is not
    compressed beyond its own, NaN where no limit is stated [rad].
    """

    layer: HelicalLayer
    least_strain: float
    greatest_strain: float
    break_strain: float
    least_angle: float
    greatest_angle: float


@dataclass(frozen=True)
class PredictedHose:
    """A plan with its response, its events, their uncertainty and its other layers.

    ``ribbon_width`` is of each of the two cord layers [m], ``number_of_cords`` of both [1].
    """

    plan: HosePlan
    prediction: HosePrediction
    events: HoseEvents
    uncertainty: HoseUncertainty
    ribbon_width: tuple[float, float]
    number_of_cords: float
    layers: tuple[LayerResponse, ...]
    notes: tuple[str, ...]
