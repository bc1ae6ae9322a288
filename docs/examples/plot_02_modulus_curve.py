"""
A modulus against strain, with its band
=======================================

The tangent modulus of a test, mean over its cycles, on both branches. The band is 95 %: scatter and
what all cycles share (load cell, crosshead, lag, diameter, tape).
"""

import matplotlib.pyplot as plt

import reduction

with reduction.open_campaign("processed/tmt-synthetic") as campaign:
    test = campaign["T-1"].to_dataset().sel(specimen="new").load()

figure, axes = plt.subplots()
for branch in ("ascending", "descending"):
    one = test.sel(branch_name=branch)
    modulus = one["tangent_modulus"] / 1e6
    half = 1.96 * one["tangent_modulus_standard_uncertainty"] / 1e6
    (line,) = axes.plot(one["strain_bin"], modulus, label=branch)
    axes.fill_between(
        one["strain_bin"], modulus - half, modulus + half, color=line.get_color(), alpha=0.25
    )
    # with the ends of the strokes, where the crosshead turns: not used, and shown
    axes.plot(
        one["strain_bin"], one["tangent_modulus_untrimmed"] / 1e6, ":", color=line.get_color()
    )
axes.set(
    xlabel="nominal strain of the free length [1]",
    ylabel="tangent modulus [MPa]",
    ylim=(0, 2.5),
    title="new tether, T-1: synthetic data (dotted: with the ends)",
)
axes.legend()

# %%
# The curves cross: on a settled cycle the stroke means of both branches are equal, whatever the
# hysteresis.

for branch in ("ascending", "descending"):
    mean = float(test["tangent_modulus"].sel(branch_name=branch).mean())
    print(f"{branch:10} mean over the bins {mean / 1e6:.3f} MPa")
