r"""Tension and torque of an armour layer for a small strain and twist of the cable.

From the energy of `reduction.predict.armourexact`, with the core twisted by :math:`\theta` per
length: :math:`(1+\zeta)\sin\bar\alpha = \sin\alpha + r\theta\cos\alpha`.

.. math:: K = \frac{n}{\cos\alpha} V^T \operatorname{diag}(EA, EI, GJ)\, V,\quad
   V = \begin{pmatrix} \cos^2\alpha & r\sin\alpha\cos\alpha \\
   -2\sin^2\alpha\cos^2\alpha/r & 2\sin\alpha\cos^3\alpha \\
   \sin^3\alpha\cos\alpha/r & \cos^4\alpha \end{pmatrix}

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 3.1 and 5.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.predict.armourdesign import ArmourDesign
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class LayerStiffness:
    """Stiffness of layers at rest; arrays have the shape (...) of the designs.

    ``torque_per_strain`` is also the tension per twist.  It is that of right-handed wires; of
    left-handed ones it has the other sign.

    Parameters
    ----------
    tension_per_strain : ndarray
        Where the cable cannot turn. [N]
    torque_per_strain : ndarray
        [N m]
    torque_per_twist : ndarray
        Twist in rad per length. [N m2]
    """

    tension_per_strain: Floats
    torque_per_strain: Floats
    torque_per_twist: Floats

    @property
    def free_tension_per_strain(self) -> Floats:
        """Where the cable turns as it likes, shape (...). [N]."""
        lost = self.torque_per_strain**2 / self.torque_per_twist
        return np.asarray(self.tension_per_strain - lost)


def layer_stiffness(design: ArmourDesign) -> LayerStiffness:
    """Stiffness of all wires of a layer together, at rest.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).

    Returns
    -------
    stiffness : LayerStiffness
        Arrays of shape (...).

    Raises
    ------
    SettingsError
        By the design.

    Notes
    -----
    The layer stiffness of [1]_, sec. 5.3, is that of the axial stress alone, n E A cos^3.  A
    single layer that may turn has next to none: the wires turn out of the load, and only their
    bending and torsion is left.

    Examples
    --------
    30 wires at 20 deg, of their 124 MN together: held, and free to turn

    >>> design = ArmourDesign(np.radians(20.0), 2.5e-3, 25e-3, 210e9, n_wires=30)
    >>> stiffness = layer_stiffness(design)
    >>> print((stiffness.tension_per_strain / 1e6).round(2))
    102.66
    >>> print((stiffness.free_tension_per_strain / 1e6).round(3))
    1.748
    """
    angle = np.asarray(design.winding_angle, dtype=np.float64)
    sine, cosine, radius = np.sin(angle), np.cos(angle), design.helix_radius
    by_strain = (cosine**2, -2 * (sine * cosine) ** 2 / radius, sine**3 * cosine / radius)
    by_twist = (radius * sine * cosine, 2 * sine * cosine**3, cosine**4)
    rods = (design.axial_stiffness, design.bending_stiffness, design.torsion_stiffness)
    count = np.asarray(design.n_wires) / cosine

    def pair(one: tuple[Floats, ...], other: tuple[Floats, ...]) -> Floats:
        terms = (rod * x * y for rod, x, y in zip(rods, one, other, strict=True))
        return np.asarray(count * sum(terms))

    return LayerStiffness(
        tension_per_strain=pair(by_strain, by_strain),
        torque_per_strain=pair(by_strain, by_twist),
        torque_per_twist=pair(by_twist, by_twist),
    )
