r"""
CG-D-39-80: nylon and polyester rope
====================================

Bitting (1980) cycled new and exposed lines, in load control, by Box-Behnken designs of frequency, mean tension and tension
amplitude. Each response is printed as a quadratic surface in coded units: the apparent spring constant K_ap, the
energy H lost in a cycle, and two numbers of a three-parameter line, K_1 and tau.
"""

import matplotlib.pyplot as plt
import numpy as np

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources
from reduction.published.reproduce_page import counts_of, reproduce
from reduction.stages.three_parameter_line.line_model import (
    apparent_spring_constant,
    hysteresis_energy,
)

LBF = 4.4482216
for verdict, number in counts_of(reproduce("CG-D-39-80")["CG-D-39-80"]).items():
    print(f"{verdict:13} {number:5}")

# %%
# What the model of the report gives back
# ---------------------------------------
#
# A spring :math:`K_0` is in parallel with a spring :math:`K_1` and dashpot in series. With :math:`x = 2\pi f\tau`,
#
# .. math:: K_{\mathrm{ap}} = \left|K_0 + K_1 \frac{i x}{1 + i x}\right|, \qquad H = \oint T\,d\varepsilon =
#           \frac{\pi K_1 (\Delta T)^2 x}{K_0^2 + (K_0 + K_1)^2 x^2}
#
# Equation 4 is printed without :math:`\pi` and without the square on :math:`K_0` (`CG-1`_), and "frequency" there has
# to be :math:`2\pi f`. The centre point of new plaited polyester tells: Tables 6, 14 and 17 give the parameters, Table 3
# gives K_ap and Table 11 the energy, 1.392 lb in/in.
#
# .. _CG-1: ../errata.html#cg-1

centre = {
    "quasi_static_spring_constant": 20140.0,
    "dissipation_spring_constant": 43530.0,
    "relaxation_time": 4.007,
    "frequency": 0.3,
}
energy = float(hysteresis_energy(**centre, tension_amplitude=561.0))
print(f"H computed {energy:.3f}, printed 1.392; without pi it would be {energy / np.pi:.3f}")
print(f"K_ap computed {float(apparent_spring_constant(**centre)):,.0f} lbf, printed 63,170")

# %%
# A line in waves, new and old
# ----------------------------
#
# From the surfaces: plaited polyester, new and after four years, at 0.3 Hz and the centre amplitude, as far as
# both were tested. The band is of one more run.

lines = published_sources()
figure, axes = plt.subplots()
for name in ("polyester-8-strand-plaited-0.5in-new", "polyester-8-strand-plaited-0.5in-4-years"):
    line = lines[name]
    strength = line.rated_break_strength
    share = np.linspace(0.14, 0.28, 40)
    values = look_up(
        line,
        "apparent_spring_constant",
        frequency=0.3,
        mean_tension=share * strength,
        tension_amplitude=0.085 * strength,
        extrapolate="flag",
    )
    inside = values.is_inside
    (drawn,) = axes.plot(100 * share[inside], values.value[inside] / 1e3, label=name)
    axes.fill_between(
        100 * share[inside],
        values.low[inside] / 1e3,
        values.high[inside] / 1e3,
        color=drawn.get_color(),
        alpha=0.2,
    )
    print(f"{name}: touched by {', '.join(values.errata) or 'no erratum'}")
axes.set(
    xlabel="mean tension [% of the rated break strength]",
    ylabel="K_ap [kN]",
    title="0.3 Hz, 8.5 % amplitude: published, CG-D-39-80",
)
axes.legend()

# %%
# What to keep in mind: quadratic surfaces of H, K_1 and tau go below zero inside their own box, tau follows 1/f (a nearly
# constant loss angle in other words), and the F test of the report has its degrees of freedom exchanged; no verdict
# changes (:doc:`/method`). The same with commands::
#
#    reduction reproduce CG-D-39-80
#    reduction figures CG-D-39-80
#    reduction lookup published --list --material polyester
#    reduction lookup polyester-8-strand-plaited-0.5in-new --against polyester-8-strand-plaited-0.5in-4-years \\
#        --quantity apparent_spring_constant --table
