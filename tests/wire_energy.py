"""Energy of one wire of an armour, whose slope the tension of the rod with an energy has to be.

Virtual work of what bends, twists and stretches: no number of the package is made from it.
"""

import numpy as np


def wire_energy(design, response):
    """(EA zeta^2 + EI dk^2 + GJ dt^2) / (2 cos a), per length of cable at rest. [J m-1]."""
    stiffness = (design.axial_stiffness, design.bending_stiffness, design.torsion_stiffness)
    changes = (response.wire_strain, response.curvature_change, response.torsion_change)
    twice = sum(
        np.asarray(one)[..., np.newaxis] * change**2
        for one, change in zip(stiffness, changes, strict=True)
    )
    return twice / (2 * np.cos(np.asarray(design.winding_angle))[..., np.newaxis])
