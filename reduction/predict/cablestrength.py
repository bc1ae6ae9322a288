"""Which armour layer of a cable yields first, and what the cable carries there.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.predict.armourlayers import ArmourLayers, predict_layers
from reduction.predict.armouryield import YieldCriterion, layer_strength, yield_strain
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class CableStrength:
    """First yield of a cable.

    Parameters
    ----------
    layer_strength : ndarray, shape (n_layers,)
        By the axial stress at the angle of rest, were each layer alone. [N]
    layer_yield_strain : ndarray, shape (n_layers,)
        Of the cable, at which each layer yields. [1]
    governing_layer : int
        That which yields first; 0 is the innermost.
    strain : float
        Of the cable at first yield. [1]
    tension : float
        Of the cable at first yield, all layers together. [N]
    """

    layer_strength: Floats
    layer_yield_strain: Floats
    governing_layer: int
    strain: float
    tension: float


def cable_strength(
    layers: ArmourLayers, *, criterion: YieldCriterion = "von-mises"
) -> CableStrength:
    """Where the first wire of the cable yields, and what the cable carries there.

    Parameters
    ----------
    layers : ArmourLayers
        Every layer with its yield stress.
    criterion : {"axial", "normal", "von-mises"}
        As `reduction.predict.armouryield.wire_stress`.

    Returns
    -------
    strength : CableStrength
        The tension is less than the sum of the strengths of the layers, which do not yield at
        one strain.

    Raises
    ------
    SettingsError
        If a layer has no yield stress, or the criterion is unknown.

    Notes
    -----
    After [1]_, sec. 5.3, for several layers and with bending and torsion.

    Examples
    --------
    The less steep layer is strained more:

    >>> from reduction.predict.armourdesign import ArmourDesign
    >>> design = ArmourDesign(np.radians([35.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([26, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.array([800e6, 800e6]))
    >>> strength = cable_strength(layers, criterion="axial")
    >>> strength.governing_layer, round(100 * strength.strain, 3)
    (1, 0.431)
    """
    bare = np.isnan(layers.yield_stress)
    if bare.any():
        raise SettingsError(
            f"layer {int(np.flatnonzero(bare)[0]) + 1} has no yield stress",
            needed="one for every layer",
        )
    strain = yield_strain(layers.design, layers.yield_stress, criterion=criterion)
    governing = int(np.argmin(strain))
    first = float(strain[governing])
    return CableStrength(
        layer_strength=layer_strength(layers.design, layers.yield_stress),
        layer_yield_strain=strain,
        governing_layer=governing,
        strain=first,
        tension=float(predict_layers(layers, first).tension[0]),
    )
