"""
Wang 2022: helical armour
=========================

Wang and others (2022) take the round steel wires of a cable's armour as thin rods on a rigid core, and simplify for small, intermediate
and large winding angles. They hold that against finite elements; in the text no figure has numbers, so what can be recomputed are
the equations and what the text says of them.
"""

import matplotlib.pyplot as plt
import numpy as np

from reduction.prediction.armour import ArmourDesign, predict_armour
from reduction.published.reproduce_page import counts_of, reproduce, touched_errata

items = reproduce("Wang-2022")["Wang-2022"]
for verdict, number in counts_of(items).items():
    print(f"{verdict:13} {number:5}")

# %%
# The axial stress is correct
# ---------------------------
#
# To first order a wire at the angle :math:`\alpha` from the axis has the strain :math:`\zeta = \varepsilon\cos^2\alpha` of a cable that is
# stretched by :math:`\varepsilon` and does not turn. With E = 210 GPa and 0.1 % that is 210 MPa times the squared cosine; the exact rod has
#
# .. math:: (1 + \zeta)\cos\alpha' = (1 + \varepsilon)\cos\alpha, \qquad (1 + \zeta)\sin\alpha' = \sin\alpha

degrees = np.arange(1.0, 89.5, 0.5)
design = ArmourDesign(np.radians(degrees), 2.5e-3, 25e-3, 210e9)
exact = predict_armour(design, 1e-3, theory="exact")
figure, (left, right) = plt.subplots(1, 2)
left.plot(degrees, exact.axial_stress[:, 0] / 1e6, "k", label="exact")
for theory in ("small", "intermediate"):
    found = predict_armour(design, 1e-3, theory=theory)
    left.plot(degrees, found.axial_stress[:, 0] / 1e6, "--", label=theory)
    error = found.axial_force / exact.axial_force - 1
    right.plot(degrees, 100 * error[:, 0], label=theory)
    at = int(np.flatnonzero(degrees == 30)[0])
    print(f"{theory}: axial force at 30 degrees differs by {100 * float(error[at, 0]):+.3f} %")
left.set(
    xlabel="winding angle [deg]", ylabel="axial stress [MPa]", title="computed, 0.1 % of strain"
)
right.set(
    xlabel="winding angle [deg]",
    ylabel="axial force less exact [%]",
    title="computed",
    ylim=(-0.1, 0.1),
)
left.legend()

# %%
# Errors in the paper
# -------------------
#
# The pitch of section 2 is over the tangent, not times it (`WA-1`_); the torsion moments of (4) and (16) have the bending
# stiffness in them (`WA-4`_); (22) has the wrong sign and one radius too few (`WA-6`_).
#
# .. _WA-1: ../errata.html#wa-1
# .. _WA-4: ../errata.html#wa-4
# .. _WA-6: ../errata.html#wa-6

for one in touched_errata("Wang-2022", items)[:8]:
    print(f"{one.erratum.id:6} {one.erratum.place}: {one.erratum.corrected}")

# %%
# The torsion moment of these moments vanishes at 45 degrees; a rod whose forces come from an energy (theory ``conjugate``) has torsion
# there, and agrees with three-dimensional elasticity. With commands::
#
#    reduction reproduce Wang-2022
#    reduction figures Wang-2022
#    reduction predict armour SPEC.toml
