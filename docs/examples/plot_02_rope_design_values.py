"""
Design values of a rope
=======================

The dynamic stiffness of a plaited nylon line, as the response surface of CG-D-39-80 has it, and a line type for
MoorDyn at the same levels. A processed campaign of your own takes the place of the name.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import reduction

line = "nylon-8-strand-plaited-0.5in-new"
levels = {"frequency": "0.3 Hz", "mean_tension": "21 %RBS", "tension_amplitude": "8.5 %RBS"}

# %%
# One value, by its symbol: with the 95 % interval of one more run at these levels, and of another specimen of the kind
# where that is known.

found = reduction.look_up(line, "K_ap", **levels)
stiffness = found["apparent_spring_constant"]
print(f"K_ap {float(stiffness):,.0f} {stiffness.attrs['units']}")
for kind in ("", "line_"):
    low, high = (found[f"apparent_spring_constant_{kind}{end}"] for end in ("low", "high"))
    print(f"{low.attrs['long_name']}: {float(low):,.0f} to {float(high):,.0f} N")
print("within the tested range:", bool(found["is_inside"]))
print("source:", found.attrs["source"])
print("errata that apply:", found.attrs["errata"] or "none")

# %%
# Arrays with named dimensions make a grid. A point outside of the tested range is refused,
# unless ``extrapolate="flag"``.

strength = float(found["mean_tension"]) / 0.21
grid = reduction.look_up(
    line,
    "K_ap",
    frequency="0.3 Hz",
    mean_tension=xr.DataArray(np.linspace(0.12, 0.30, 40) * strength, dims="mean_tension"),
    tension_amplitude=xr.DataArray(
        np.linspace(0.05, 0.12, 40) * strength, dims="tension_amplitude"
    ),
)
stiffness = grid["apparent_spring_constant"].transpose("tension_amplitude", "mean_tension")
figure, axes = plt.subplots()
drawn = axes.contourf(
    100 * grid["mean_tension"] / strength,
    100 * grid["tension_amplitude"] / strength,
    stiffness / 1e3,
    levels=12,
    cmap="cividis",
)
figure.colorbar(drawn, label="K_ap [kN]")
axes.set(
    xlabel="mean tension [% of the rated break strength]",
    ylabel="tension amplitude [%]",
    title="new nylon, 0.3 Hz: published, CG-D-39-80",
)

# %%
# And the line type: the slow-pull stiffness and the dynamic part at these levels. What a tension test does not
# measure is stated.

done = reduction.export(
    line,
    "moordyn",
    "rope.dat",
    form="static-dynamic",
    linear_density="0.1 kg/m",
    wet_linear_density="0.01 kg/m",
    **levels,
)
print(*(path.name for path in done.paths))
text = Path("rope.dat").read_text(encoding="utf-8")
print(text[text.index("LINE TYPES") - 23 :][:400])
