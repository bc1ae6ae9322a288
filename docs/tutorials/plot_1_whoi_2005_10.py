"""
WHOI-2005-10: rubber tethers
============================

Irish, Paul and Wyman (2005) pulled a new and a used tether of natural rubber about mean stretches of 100 to
250 %, and tabulated the tangent modulus on the way up, piece by piece (Tables 5 and 6). Three things decide
what those numbers are: the diameter, the strain of the rubber between its splices, and a handful of misprints.
"""

import matplotlib.pyplot as plt
import numpy as np

from reduction.lines.report_figures import figure_in_numbers, figure_rows
from reduction.published.published_lines import published_tethers
from reduction.published.reproduce_page import counts_of, reproduce, touched_errata

PSI, LBF, INCH = 6894.757, 4.4482216, 0.0254
items = reproduce("WHOI-2005-10")["WHOI-2005-10"]
for verdict, number in counts_of(items).items():
    print(f"{verdict:13} {number:5}")

# %%
# The diameter
# ------------
#
# A modulus goes as the inverse square of it. Table 2 prints 1.01 in for the new tether before stretch
# (`WH5-11`_). Every consistent row of Tables 5 and 6 is a chord,
#
# .. math:: E = \frac{\Delta F}{A \, \Delta\varepsilon},
#
# so each row says which area it was made with.
#
# .. _WH5-11: ../errata.html#wh5-11

new, used = published_tethers()
for tether in (new, used):
    rows = [one for one in tether.segments if one.errata == ("WH5-34",)]
    area = np.array(
        [
            (one.tension_high - one.tension_low) / (one.strain_high - one.strain_low) / one.modulus
            for one in rows
        ]
    )
    diameter = np.sqrt(4 * np.median(area) / np.pi)
    print(
        f"{tether.name}: printed {tether.printed_diameter / INCH:.2f} in, behind the moduli {diameter / INCH:.3f} in"
        f" ({area.size} rows); used here {tether.specimen.diameter[0] / INCH:.2f} in"
    )

# %%
# The strain between the splices
# ------------------------------
#
# A machine knows the distance p of the thimbles; the rubber is what lies between the toes of the splices, which stretch
# less. Table 3 has tape readings in test T-1. The report takes one constant share of p. The marks themselves
# say a straight line with another slope:

figure, axes = plt.subplots()
for tether in (new, used):
    marks = tether.marks
    free, position = marks.far_toe - marks.near_toe, marks.far_thimble
    slack = np.array([hold == "slack" for hold in marks.hold])
    relaxed = float(np.mean(free[slack]))
    share = float(np.mean(free[~slack] / position[~slack]))
    strain, printed = free / relaxed - 1, share * position / relaxed - 1
    axes.plot(100 * strain, 100 * (printed - strain), "o-", label=tether.name)
    slope = np.polyfit(position[~slack], strain[~slack], 1)[0]
    print(
        f"{tether.name}: d(strain)/dp of the marks is {slope / (share / relaxed):.3f} of the constant share's"
    )
axes.set(
    xlabel="strain of the rubber by its marks [%]",
    ylabel="constant share less marks [points of strain]",
    title="Table 3, test T-1: published, WHOI-2005-10",
)
axes.legend()

# %%
# Moduli of T-1 by the constant share are high by that factor (`WH5-34`_); the marks of the other tests are not
# printed, so theirs cannot be put right. With a campaign of your own ``reduction run`` takes the splices out by
# every mark of a specimen, and the product says what the constant share would have given
# (``strain_slope_ratio``).
#
# .. _WH5-34: ../errata.html#wh5-34
#
# Printed against computed
# ------------------------

(row,) = (one for one in figure_rows() if (one.report, one.figure) == ("WHOI-2005-10", "31"))
figure, axes = plt.subplots()
for one in figure_in_numbers(row).series:
    colour = "#0072B2" if " new" in one.name else "#D55E00"
    axes.plot(100 * one.x, one.y / PSI, "o" if one.form == "points" else "-", color=colour)
axes.plot([], [], color="#0072B2", label="new")
axes.plot([], [], color="#D55E00", label="used")
axes.set(
    xlabel="strain [%]",
    ylabel="tangent modulus, ascending [psi]",
    title="Table 5: points as published, lines as corrected, WHOI-2005-10",
)
axes.legend()

for one in touched_errata("WHOI-2005-10", items)[:6]:
    print(
        f"{one.erratum.id:7} {one.erratum.place}: {one.erratum.printed} -> {one.erratum.corrected}"
    )

# %%
# The same with commands::
#
#    reduction reproduce WHOI-2005-10
#    reduction figures WHOI-2005-10
#    reduction lookup rubber-tether-new-T-1 --quantity tangent_modulus --strain "100 %" --units us
#    reduction assembly docs/assemblies/new-hampshire.toml --units us
#
# and the method on logs, where the truth is known: :doc:`/get-started`.
