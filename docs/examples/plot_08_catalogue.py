"""
A question to all campaigns
===========================

Each campaign has a catalogue beside its archives: which tests, under which conditions, with which numbers. A
question goes to those of all campaigns.
"""

from pathlib import Path

import matplotlib.pyplot as plt

from reduction.batch.catalogue import Query, answer, load_catalogue

catalogue = load_catalogue(Path("processed"))

# %%
# Every spring constant of a cyclic test, of whatever campaign. The answer is an Arrow table.

found = answer(
    catalogue, Query(names={"test_kind": ("cyclic",)}, quantity=("apparent_spring_constant",))
)
rows = found.select(
    ["campaign", "test", "specimen", "test_mean_strain", "test_apparent_spring_constant"]
).to_pylist()
for row in rows:
    print(
        "{campaign:16} {test:20} {specimen:10} {test_mean_strain:6.3f} {test_apparent_spring_constant:8.1f}".format(
            **row
        )
    )

figure, axes = plt.subplots()
for specimen in sorted({row["specimen"] for row in rows}):
    own = [row for row in rows if row["specimen"] == specimen]
    axes.plot(
        [100 * row["test_mean_strain"] for row in own],
        [row["test_apparent_spring_constant"] for row in own],
        "o",
        label=specimen,
    )
axes.set(
    xlabel="mean strain [%]",
    ylabel="apparent spring constant [N]",
    yscale="log",
    title="cyclic tests of two campaigns: synthetic data",
)
axes.legend()
