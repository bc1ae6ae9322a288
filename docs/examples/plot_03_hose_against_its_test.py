"""
A hose against its test
=======================

A stretch hose is predicted from its cords, its wrap angle and its rubber alone; then its test is held against
that, with all that was stated of either. The test is synthetic.
"""

import matplotlib.pyplot as plt

import reduction

# %%
# The design. How steep the cords lie decides how far the hose stretches before they carry.

DESIGN = {
    "wrap_diameter": "3.5 in",
    "inner_diameter": "2.5 in",
    "outer_diameter": "5 in",
    "cords_per_length": "34 1/in",
    "cord_diameter": "0.022 in",
    "rubber_modulus": "200 psi",
    "length": "96 in",
    "dead_length": "4 in",
}
CORD = {
    "strain": [0.0, 0.02, 0.06, 0.10, 0.14, 0.18, 0.22, 0.26],
    "load": [f"{load} lbf" for load in (0.0, 1.73, 5.86, 10.62, 15.72, 20.85, 25.71, 30.0)],
}
figure, axes = plt.subplots()
for angle in (60, 64, 68):
    spec = {"hose": {"wrap_angle": f"{angle} deg", **DESIGN}, "cord": CORD}
    hose = reduction.predict_hose(spec).squeeze("hose")
    axes.plot(100 * hose["strain"], hose["tension"] / 1e3, label=f"{angle} deg")
    pick_up = hose.sel(hose_event="pick_up")
    print(f"{angle} deg: the cords pick up at {100 * float(pick_up['event_strain']):.0f} % strain")
axes.set(
    xlabel="strain of the hose [%]", ylabel="tension [kN]", title="three wrap angles: computed"
)
axes.legend()

# %%
# The test of the hose of 64 degrees, three slow loops, against its prediction as the campaign states it.

with reduction.open_campaign("processed/hose-synthetic") as campaign:
    comparison = campaign["comparisons"].to_dataset().sel(comparison="H64-static").load()

measured = comparison.sel(curve=str(comparison["judged_curve"].values))
strain = 100 * measured["strain"]
figure, (above, below) = plt.subplots(2, sharex=True, height_ratios=(3, 2))
above.plot(strain, measured["measured_tension"] / 1e3, label="measured (synthetic test)")
above.plot(strain, measured["predicted_tension"] / 1e3, "--", label="predicted")
above.set(ylabel="tension [kN]", title="hose of 64 degrees, L-64: synthetic data")
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
# And the verdict.

print(str(comparison["verdict"].values))
