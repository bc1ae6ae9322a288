"""
Reading an archive
==================

A processed campaign is one tree of datasets, a node a test. Nothing but labels is read before it is
asked for.
"""

import matplotlib.pyplot as plt

import reduction

campaign = reduction.open_campaign("processed/tmt-synthetic")
print(campaign.attrs["title"])
for name, node in campaign.children.items():
    print(f"{name:20} {node.attrs['test_kind']:12} {node.sizes['sample']:6} samples")

# %%
# The record of a test: position and tension as they were logged, and the phase that each sample was
# found to belong to (0 rest, 1 approach, 2 hold, 3 cycling).

test = campaign["T-1"].to_dataset()
figure, (above, below) = plt.subplots(2, sharex=True)
above.plot(test["time"], test["tension"].sel(specimen="new"), label="new")
above.plot(test["time"], test["tension"].sel(specimen="used"), label="used")
above.set(ylabel="tension [N]", title="T-1 of tmt-synthetic: synthetic data")
above.legend()
below.plot(test["time"], test["phase"], drawstyle="steps")
below.set(xlabel="time [s]", ylabel="phase", yticks=[0, 1, 2, 3])

# %%
# Every variable has its unit and its meaning with it, and where it has a standard uncertainty, that.

spring = test["apparent_spring_constant"]
print(spring.attrs["long_name"], f"[{spring.attrs['units']}]")
for value, uncertainty in zip(
    spring.sel(specimen="new").values,
    test["apparent_spring_constant_standard_uncertainty"].sel(specimen="new").values,
    strict=True,
):
    print(f"{value:7.1f} +- {uncertainty:.1f}")
campaign.close()
