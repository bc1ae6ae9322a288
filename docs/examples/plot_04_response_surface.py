"""
A response surface, and a value looked up
=========================================

The apparent spring constant of a 1/2 in plaited nylon line, as the surface of CG-D-39-80 has it.
"""

import matplotlib.pyplot as plt
import numpy as np

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources

line = published_sources()["nylon-8-strand-plaited-0.5in-new"]

# %%
# One value: with the interval of one more run at these levels, and of the surface itself.

value = look_up(
    line,
    "apparent_spring_constant",
    frequency=0.3,
    mean_tension=0.21 * line.rated_break_strength,
    tension_amplitude=0.085 * line.rated_break_strength,
)
print(
    f"{float(value.value):,.0f} N, one more run {float(value.low):,.0f} to {float(value.high):,.0f} N"
)
print("inside the tested levels:", bool(value.is_inside))
print("errata that touch it:", ", ".join(value.errata) or "none")

# %%
# And the whole of it at 0.3 Hz. Nothing is extrapolated: what is outside of the levels would be
# refused.

strength = line.rated_break_strength
mean, amplitude = np.meshgrid(np.linspace(0.12, 0.30, 40), np.linspace(0.05, 0.12, 40))
grid = look_up(
    line,
    "apparent_spring_constant",
    frequency=0.3,
    mean_tension=mean * strength,
    tension_amplitude=amplitude * strength,
)
figure, axes = plt.subplots()
drawn = axes.contourf(100 * mean, 100 * amplitude, grid.value / 1e3, levels=12, cmap="cividis")
axes.grid(visible=False)
figure.colorbar(drawn, label="apparent spring constant [kN]")
axes.set(
    xlabel="mean tension [% of the rated break strength]",
    ylabel="tension amplitude [%]",
    title="new nylon, 0.3 Hz: published, CG-D-39-80",
)
