"""
Loops
=====

Tension against strain in the first and in the last cycle of a test, and what the closed loops give.
"""

import matplotlib.pyplot as plt

import reduction

with reduction.open_campaign("processed/tmt-synthetic") as campaign:
    test = campaign["T-2"].to_dataset().sel(specimen="used").load()

figure, axes = plt.subplots()
for cycle in (0, -1):
    first, last = int(test["cycle_first_sample"][cycle]), int(test["cycle_last_sample"][cycle])
    loop = test.isel(sample=slice(first, last + 1))
    axes.plot(loop["strain"], loop["tension"], label=f"cycle {int(test['cycle'][cycle])}")
axes.set(xlabel="strain [1]", ylabel="tension [N]", title="used tether, T-2: synthetic data")
axes.legend()

# %%
# Amplitudes are half ranges; the energy is the area of the loop, per metre of free length.

for name in ("mean_strain", "strain_amplitude", "apparent_spring_constant", "hysteresis_energy"):
    values = test[name]
    print(
        f"{name:26} first {float(values[0]):9.4g}  last {float(values[-1]):9.4g} {values.attrs['units']}"
    )
