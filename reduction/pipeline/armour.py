"""An armour by every theory, its layers together, and where each theory holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reduction.predict.armour import predict_armour
from reduction.predict.armourdesign import (
    ARMOUR_THEORIES,
    ArmourDesign,
    ArmourResponse,
    ArmourTheory,
)
from reduction.predict.armourerror import (
    AnglesOfUse,
    TheoryErrors,
    angles_of_use,
    theory_errors,
    thinning_loss,
)
from reduction.predict.armourlayers import (
    ArmourLayers,
    LayersResponse,
    cable_stiffness,
    predict_layers,
)
from reduction.predict.armourspacing import fill_factor, wire_gap
from reduction.predict.cablestrength import CableStrength, cable_strength
from reduction.record import Floats

_UNBALANCED = 0.1
_ANGLES = np.radians(np.arange(5.0, 85.5, 0.5))


@dataclass(frozen=True)
class PredictedArmour:
    """An armour at one strain.

    ``responses`` are of one wire of each layer by theory, shape (n_layers, 1); ``use`` is
    of each layer, at the ``tolerance`` [1]; ``axial_stiffness`` is of the cable held from
    turning, and free to [N]; ``thinning_loss`` is the share of its strain that a wire of each
    layer loses as it thins, which no theory has in it [1].
    """

    layer_names: tuple[str, ...]
    layers: ArmourLayers
    strain: Floats
    responses: dict[ArmourTheory, ArmourResponse]
    errors: TheoryErrors
    use: tuple[AnglesOfUse, ...]
    tolerance: float
    together: LayersResponse
    axial_stiffness: tuple[float, float]
    strength: CableStrength | None
    fill: Floats
    gap: Floats
    thinning_loss: Floats
    notes: tuple[str, ...]


def predict_armour_case(
    layers: ArmourLayers, strain: Floats, *, names: Sequence[str], tolerance: float
) -> PredictedArmour:
    """Predict an armour by every theory.

    Parameters
    ----------
    layers : ArmourLayers
        The innermost first.
    strain : ndarray, shape (1,)
        Of the cable. [1]
    names : sequence of str
        Of the layers.
    tolerance : float
        Error at which a theory still counts as right. [1]

    Returns
    -------
    armour : PredictedArmour
        Wire by wire, layer by layer, and the cable.

    Raises
    ------
    SettingsError
        If the layers do not go together.
    DataError
        If the strain is none that a cable can have.
    """
    design = layers.design
    responses = {
        theory: predict_armour(design, strain, theory=theory) for theory in ARMOUR_THEORIES
    }
    together = predict_layers(layers, strain)
    known = np.isfinite(layers.yield_stress)
    notes = []
    for place, name in enumerate(names):
        if responses["exact"].is_lifted[place, 0]:
            notes.append(f"{name}: the wires leave the core; no theory here holds")
        if together.is_yielding[place, 0]:
            notes.append(f"{name}: the wires yield; all loads beyond that are too high")
    if abs(together.torque_imbalance[0]) > _UNBALANCED:
        notes.append(
            f"the layers do not balance: {100 * together.torque_imbalance[0]:.0f} % of their "
            "torque is left, and a cable that is free to turn stretches further"
        )
    return PredictedArmour(
        layer_names=tuple(names),
        layers=layers,
        strain=strain,
        responses=responses,
        errors=theory_errors(design, strain),
        use=tuple(
            angles_of_use(wound_at_all_angles(design, place), float(strain[0]), tolerance=tolerance)
            for place in range(len(names))
        ),
        tolerance=tolerance,
        together=together,
        axial_stiffness=cable_stiffness(layers),
        strength=cable_strength(layers) if known.all() else None,
        fill=fill_factor(design),
        gap=wire_gap(design),
        thinning_loss=thinning_loss(design),
        notes=tuple(notes),
    )


def wound_at_all_angles(design: ArmourDesign, place: int) -> ArmourDesign:
    """Wires of a layer, wound at any angle from 5 to 85 deg.

    Parameters
    ----------
    design : ArmourDesign
        Of all layers.
    place : int
        Of the layer among them; 0 is the innermost.

    Returns
    -------
    designs : ArmourDesign
        One wire, of shape (n_angles,).
    """

    def of_layer(value: float | Floats) -> float:
        return float(np.broadcast_to(value, design.shape)[place])

    return ArmourDesign(
        _ANGLES,
        of_layer(design.wire_radius),
        of_layer(design.core_radius),
        of_layer(design.elastic_modulus),
        of_layer(design.poisson_ratio),
    )
