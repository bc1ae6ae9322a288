r"""Several armour layers on each other: what the cable carries.

Each layer lies on a core of its own that does not give and does not turn, so that all have the
strain of the cable and squeeze what is inside them.  The torque that they leave unbalanced is
what the terminations have to hold; `reduction.predict.armourstiffness` tells what a cable loses
that may turn.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.predict.armour import predict_armour
from reduction.predict.armourdesign import ArmourDesign, ArmourResponse, ArmourTheory
from reduction.predict.armourspacing import wire_gap
from reduction.predict.armourstiffness import layer_stiffness
from reduction.predict.armouryield import wire_stress
from reduction.record import Bools, Floats, read_only_arrays

Lay = Literal["right", "left"]

_TOUCH = 1e-9  # of a wire radius: layers and wires that just touch have rounding between them


@dataclass(frozen=True)
@read_only_arrays
class ArmourLayers:
    """Layers of one cable, the innermost first.

    Parameters
    ----------
    design : ArmourDesign
        Numbers of shape (n_layers,), or floats that all layers share.
    lay : tuple of {"right", "left"}, length n_layers
        Hand of each layer.
    yield_stress : ndarray, shape (n_layers,)
        Of the wires; NaN where none is stated. [Pa]
    """

    design: ArmourDesign
    lay: tuple[Lay, ...]
    yield_stress: Floats

    def __post_init__(self) -> None:
        """Check that the layers pair up, that each has room, and that its wires have."""
        count = len(self.lay)
        for name, shape in (
            ("the armour", self.design.shape),
            ("yield_stress", self.yield_stress.shape),
        ):
            if shape != (count,):
                raise SettingsError(
                    f"{name} does not pair up with the layers",
                    found=f"shape {shape} for {count} hands of lay",
                    needed="one number a layer",
                )
        unknown = [hand for hand in self.lay if hand not in get_args(Lay)]
        if unknown:
            raise SettingsError(
                "the hand of a layer is not known", found=repr(unknown[0]), needed="right, left"
            )
        bad = self.yield_stress <= 0
        if bad.any():
            raise SettingsError(
                f"yield_stress of layer {_first(bad)} is not above zero",
                found=f"{self.yield_stress[bad][0]:g} Pa",
                needed="above 0 Pa",
            )
        core, wire = (self._spread(one) for one in ("core_radius", "wire_radius"))
        inside = core[:-1] + 2 * wire[:-1]
        bad = core[1:] < inside - _TOUCH * wire[:-1]
        if bad.any():
            at = _first(bad)
            raise SettingsError(
                f"layer {at + 1} lies inside layer {at}",
                found=f"core_radius {core[at]:g} m",
                needed=f"{inside[at - 1]:g} m or more",
                hint="Give the layers from the innermost outwards.",
            )
        gap = np.broadcast_to(wire_gap(self.design), (count,))
        bad = gap < -_TOUCH * wire
        if bad.any():
            at = _first(bad)
            n_wires = self._spread("n_wires")[at - 1]
            raise SettingsError(
                f"the wires of layer {at} do not fit on its core",
                found=f"{n_wires:g} wires that overlap by {-gap[bad][0]:g} m",
                needed="fewer or thinner wires, or a smaller angle",
            )

    def _spread(self, name: str) -> Floats:
        value = np.asarray(getattr(self.design, name), dtype=np.float64)
        return np.asarray(np.broadcast_to(value, (len(self.lay),)))

    @property
    def hand(self) -> Floats:
        """1 for a right-handed layer, -1 for a left-handed one, shape (n_layers,)."""
        return np.array([1.0 if hand == "right" else -1.0 for hand in self.lay])


def _first(bad: Bools) -> int:
    return int(np.flatnonzero(bad)[0]) + 1


@dataclass(frozen=True)
@read_only_arrays
class LayersResponse:
    """Response of the cable at each strain; a layer has the shape (n_layers, n_strain).

    Parameters
    ----------
    wire : ArmourResponse
        Of one wire of each layer.
    layer_tension, tension : ndarray, shape (n_layers, n_strain), (n_strain,)
        Along the axis, of all wires of a layer and of all layers. [N]
    layer_torque, torque : ndarray, shape (n_layers, n_strain), (n_strain,)
        About the axis, above zero as of right-handed wires. [N m]
    torque_imbalance : ndarray, shape (n_strain,)
        Size of the torque over the sum of the sizes of the layers'; 0 is balanced, 1 all of one
        hand.  NaN where there is none. [1]
    layer_pressure : ndarray, shape (n_layers, n_strain)
        By the layer alone on the surface it lies on. [Pa]
    core_pressure : ndarray, shape (n_layers, n_strain)
        By the layer and all outside it on that surface. [Pa]
    wire_stress : ndarray, shape (n_layers, n_strain)
        After von Mises. [Pa]
    is_yielding : ndarray of bool, shape (n_layers, n_strain)
        The stress passes the yield stress; beyond it, all loads are too high.
    """

    wire: ArmourResponse
    layer_tension: Floats
    tension: Floats
    layer_torque: Floats
    torque: Floats
    torque_imbalance: Floats
    layer_pressure: Floats
    core_pressure: Floats
    wire_stress: Floats
    is_yielding: Bools


def predict_layers(
    layers: ArmourLayers, strain: ArrayLike, *, theory: ArmourTheory = "conjugate"
) -> LayersResponse:
    r"""Tension, torque, pressure and stress of a cable that is stretched and cannot turn.

    .. math:: F = \sum n (T\cos\bar\alpha + N'\sin\bar\alpha),\quad
       M = \sum \pm n (r(T\sin\bar\alpha - N'\cos\bar\alpha) + H\cos\bar\alpha + G'\sin\bar\alpha),
       \quad p = \frac{-n X_1}{2\pi R_1\cos\bar\alpha}

    Parameters
    ----------
    layers : ArmourLayers
        Of n_layers layers.
    strain : array_like, shape (n_strain,)
        Of the cable. [1]
    theory : {"small", "intermediate", "exact", "conjugate"}
        As `reduction.predict.armour.predict_armour`; the spring has no core to lie on.

    Returns
    -------
    response : LayersResponse
        Arrays of shape (n_layers, n_strain) and (n_strain,).

    Raises
    ------
    SettingsError
        If the theory is none of these, or the strain is not a series of numbers above -1.

    Notes
    -----
    Source: [1]_, eq. (6) for the line load, Figure 2 for the sum; the torque is that of the
    forces and moments of (6) about the axis.  Lines of contact are smeared out to a pressure.
    Friction between layers and the load of the core itself are not in it.

    Examples
    --------
    Two layers of opposite hands, the outer one less steep: most of the torque is balanced

    >>> design = ArmourDesign(np.radians([24.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([30, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.array([800e6, 800e6]))
    >>> cable = predict_layers(layers, [1e-3])
    >>> print((cable.tension / 1e3).round(1), cable.torque_imbalance.round(2))
    [217.6] [0.12]
    """
    if theory == "large":
        raise SettingsError(
            "layers on a core are no springs", found="large", needed="a theory of wires on a core"
        )
    wire = predict_armour(layers.design, strain, theory=theory)
    count = layers._spread("n_wires")[:, None]
    core_radius = layers._spread("core_radius")[:, None]
    layer_tension = count * wire.tension
    layer_torque = layers.hand[:, None] * count * wire.torque
    along = np.cos(wire.current_winding_angle)
    radial = count * wire.contact_line_load / (2 * pi * along)  # pressure times radius
    inwards = np.cumsum(radial[::-1], axis=0)[::-1]
    torque = layer_torque.sum(axis=0)
    size = np.abs(layer_torque).sum(axis=0)
    stress = wire_stress(wire)
    return LayersResponse(
        wire=wire,
        layer_tension=layer_tension,
        tension=layer_tension.sum(axis=0),
        layer_torque=layer_torque,
        torque=torque,
        torque_imbalance=np.divide(
            np.abs(torque), size, out=np.full_like(size, np.nan), where=size > 0
        ),
        layer_pressure=radial / core_radius,
        core_pressure=inwards / core_radius,
        wire_stress=stress,
        is_yielding=stress > layers.yield_stress[:, None],
    )


def cable_stiffness(layers: ArmourLayers) -> tuple[float, float]:
    """Tension per strain of the cable at rest: held against turning, and free to turn.

    Parameters
    ----------
    layers : ArmourLayers
        Of n_layers layers.

    Returns
    -------
    tension_per_strain : float
        Where the cable cannot turn. [N]
    free_tension_per_strain : float
        Where it turns as it likes. [N]

    Raises
    ------
    SettingsError
        By the layers.

    Notes
    -----
    Layers add their stiffness against strain and twist, not their stiffness when free.  After
    [1]_, sec. 5.3, with the energy of `reduction.predict.armourexact`.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([24.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([30, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.full(2, np.nan))
    >>> print("{:.3e} {:.3e}".format(*cable_stiffness(layers)))
    2.175e+08 2.146e+08
    """
    each = layer_stiffness(layers.design)
    held = float(np.sum(each.tension_per_strain))
    coupling = float(np.sum(layers.hand * each.torque_per_strain))
    return held, held - coupling**2 / float(np.sum(each.torque_per_twist))
