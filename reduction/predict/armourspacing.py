r"""Whether the wires of a layer find room beside each other.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 2.
"""

from __future__ import annotations

from math import pi

import numpy as np

from reduction.predict.armourdesign import ArmourDesign
from reduction.record import Floats

_STEPS = 40  # each doubles the digits once it is near; the slowest start needs about ten


def fill_factor(design: ArmourDesign) -> Floats:
    r"""Share of the circumference that the wires take, on the unrolled cylinder of their centres.

    .. math:: n R_2 / (\pi r \cos\alpha)

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).

    Returns
    -------
    fill_factor : ndarray, shape (...)
        Above one the wires do not fit; a little below one they may still not, since the
        cylinder is round: `wire_gap` decides. [1]

    Raises
    ------
    SettingsError
        By the design.

    Notes
    -----
    Geometry of [1]_, Figure 2.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(20.0), 2.5e-3, 25e-3, 210e9, n_wires=30)
    >>> print(fill_factor(design).round(3))
    0.924
    """
    across = np.asarray(design.n_wires) * np.asarray(design.wire_radius)
    return np.asarray(across / (pi * design.helix_radius * np.cos(design.winding_angle)))


def wire_gap(design: ArmourDesign) -> Floats:
    r"""Room between neighbouring wires at rest, by the least distance of their centre lines.

    .. math:: \min_\psi r\sqrt{2(1 - \cos\psi) + \cot^2\!\alpha\,(2\pi/n - \psi)^2} - 2 R_2

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).

    Returns
    -------
    wire_gap : ndarray, shape (...)
        Below zero the wires do not fit; of a single wire, to its own next turn. [m]

    Raises
    ------
    SettingsError
        By the design.

    Notes
    -----
    The angle of the nearest point is the root of :math:`\sin\psi = \cot^2\!\alpha(2\pi/n - \psi)`.
    The difference of the two sides is concave up to half a turn and below zero at first, so
    that Newton's steps from zero go up to the first root and never past it.  Geometry of [1]_,
    Figure 2.

    Examples
    --------
    All but straight wires as thick as their core: six would just fit, as in a strand of seven

    >>> design = ArmourDesign(1e-9, 1.0, 1.0, 210e9, n_wires=np.array([5, 7]))
    >>> print(wire_gap(design).round(3))
    [ 0.351 -0.264]
    """
    angle = np.asarray(design.winding_angle, dtype=np.float64)
    slope = 1 / np.tan(angle) ** 2
    neighbour = 2 * pi / np.asarray(design.n_wires, dtype=np.float64)
    farthest = np.minimum(neighbour, pi)
    place = np.zeros(np.broadcast_shapes(slope.shape, neighbour.shape))
    for _ in range(_STEPS):
        rise = np.cos(place) + slope
        miss = slope * (neighbour - place) - np.sin(place)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(rise > 0, miss / rise, pi)
        place = np.clip(place + step, 0, farthest)
    square = 2 * (1 - np.cos(place)) + slope * (neighbour - place) ** 2
    return np.asarray(design.helix_radius * np.sqrt(square) - 2 * np.asarray(design.wire_radius))
