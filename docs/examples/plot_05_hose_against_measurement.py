"""
A predicted hose against its test
=================================

A hose is predicted from its cords, its wrap angle and its rubber alone; then its test is held against
that, with all that was stated of either.
"""

import matplotlib.pyplot as plt

import reduction

with reduction.open_campaign("processed/hose-synthetic") as campaign:
    comparison = campaign["comparisons"].to_dataset().sel(comparison="H64-static").load()

measured = comparison.sel(curve=str(comparison["judged_curve"].values))
strain = 100 * measured["strain"]
figure, (above, below) = plt.subplots(2, sharex=True, height_ratios=(3, 2))
above.plot(strain, measured["measured_tension"] / 1e3, label="measured (synthetic test)")
above.plot(strain, measured["predicted_tension"] / 1e3, "--", label="predicted")
above.set(ylabel="tension [kN]", title="hose of 64 degrees, weights: synthetic data")
for event in comparison["hose_event"].values:
    at = 100 * float(comparison["event_strain"].sel(hose_event=event))
    if at < float(strain.max()):
        above.axvline(at, color="grey", linewidth=0.8)
        above.annotate(str(event), (at, 0), rotation=90, ha="right", va="bottom")
above.legend()

# below, the difference beside what the uncertainties of both allow
half = float(comparison["coverage_factor"]) * comparison["validation_uncertainty"]
below.fill_between(strain, -half, half, alpha=0.25, label="allowed, 95 % over the whole curve")
below.plot(strain, measured["tension_difference"], label="predicted less measured")
below.set(xlabel="strain of the hose [%]", ylabel="difference [N]")
below.legend()

# %%
# And the verdict in words.

print(str(comparison["verdict"].values))
