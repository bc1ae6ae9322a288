"""
A question to all campaigns
===========================

The catalogue is an index over every archive below a folder: which tests, under which conditions, with
which numbers.
"""

from pathlib import Path

import matplotlib.pyplot as plt

from reduction.catalogue.changes import changes_since
from reduction.catalogue.query import Query, answer
from reduction.catalogue.refresh import refresh

processed = Path("processed")
index = refresh(None, changes_since(None, processed), processed / "catalogue.parquet").index

# %%
# Every spring constant of a cyclic test, of whatever campaign. The answer is an Arrow table.

found = answer(
    index, Query(names={"test_kind": ("cyclic",)}, quantity=("apparent_spring_constant",))
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
