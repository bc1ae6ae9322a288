"""
Reducing a tether test
======================

From a log and its ``campaign.toml`` to a modulus with its band. The logs are synthetic: two rubber tethers,
a new and a used one, that were never pulled. From a shell, ``reduction demo`` puts them into a folder.
"""

import matplotlib.pyplot as plt

import reduction

campaign = reduction.run("raw/tmt-synthetic/campaign.toml", tests=["T-1"])
print(campaign.attrs["title"])
for name, node in campaign.children.items():
    print(f"{name:14} {node.attrs['test_kind']:8} {node.sizes['sample']:6} samples")

# %%
# The record: position and tension as they were logged, and the phase that each sample was found to belong to
# (0 rest, 1 approach, 2 hold, 3 cycling). Values are read when they are asked for.

test = campaign["T-1"].to_dataset()
figure, (above, below) = plt.subplots(2, sharex=True)
above.plot(test["time"], test["tension"].sel(specimen="new"), label="new")
above.plot(test["time"], test["tension"].sel(specimen="used"), label="used")
above.set(ylabel="tension [N]", title="T-1 of tmt-synthetic: synthetic data")
above.legend()
below.plot(test["time"], test["phase"], drawstyle="steps")
below.set(xlabel="time [s]", ylabel="phase", yticks=[0, 1, 2, 3])

# %%
# EA of each cycle (tension amplitude over strain amplitude), with its standard uncertainty. Every variable carries
# its unit and meaning.

spring = test["apparent_spring_constant"].sel(specimen="new")
uncertainty = test["apparent_spring_constant_standard_uncertainty"].sel(specimen="new")
print(spring.attrs["long_name"], f"[{spring.attrs['units']}]")
for value, half in zip(spring.values, 1.96 * uncertainty.values, strict=True):
    print(f"{value:6.0f} ± {half:.0f}")

# %%
# The tangent modulus against strain, mean over the cycles, on both branches. The band is 95 %: scatter, and what all
# cycles share (load cell, crosshead, lag, diameter, tape). Dotted: with the ends of the strokes, where the crosshead
# turns, which are not used.

new = test.sel(specimen="new")
strain = 100 * new["strain_bin"]
figure, axes = plt.subplots()
for branch in ("ascending", "descending"):
    one = new.sel(branch_name=branch)
    modulus = one["tangent_modulus"] / 1e6
    half = 1.96 * one["tangent_modulus_standard_uncertainty"] / 1e6
    (line,) = axes.plot(strain, modulus, label=branch)
    axes.fill_between(strain, modulus - half, modulus + half, color=line.get_color(), alpha=0.25)
    axes.plot(strain, one["tangent_modulus_untrimmed"] / 1e6, ":", color=line.get_color())
axes.set(
    xlabel="nominal strain of the free length [%]",
    ylabel="tangent modulus [MPa]",
    ylim=(0, 2.5),
    title="new tether, T-1: synthetic data",
)
axes.legend()
campaign.close()

# %%
# One design value of it: the modulus at 100 % strain on the way up, with its interval.

found = reduction.look_up(
    "processed/tmt-synthetic/T-1.nc",
    "tangent_modulus",
    line="new",
    branch="ascending",
    strain="100 %",
)
low, high = (float(found[f"tangent_modulus_surface_{end}"]) / 1e6 for end in ("low", "high"))
print(f"{float(found['tangent_modulus']) / 1e6:.3f} MPa, {low:.3f} to {high:.3f} MPa")
print(found.attrs["rule"])
