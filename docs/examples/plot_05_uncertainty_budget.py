"""
Where the uncertainty of a number comes from
============================================

Each shared error (a load cell, a crosshead, a diameter) has a signed contribution to each number; the
archive keeps them.
"""

from pathlib import Path

import matplotlib.pyplot as plt

from reduction.archive.open import open_archive
from reduction.archive.uncertainty_budget import budget_from_archive

with open_archive(Path("processed/tmt-synthetic/T-1.nc")) as archive:
    budgets = {
        strain: budget_from_archive(
            archive,
            "tangent_modulus",
            {"specimen": "new", "branch": "ascending", "strain": strain},
        )
        for strain in ("0.9", "1.0", "1.15")
    }

for strain, budget in budgets.items():
    print(
        f"strain {strain}: {budget.value / 1e3:7.1f} +- {budget.standard_uncertainty / 1e3:.1f} kPa (k = 1)"
    )

# %%
# Shares of the variance at 100 % of stretch, largest first.

rows = budgets["1.0"].rows
for row in rows:
    print(f"{row.source:20} {row.of[:34]:34} {row.contribution / 1e3:7.2f} kPa {row.share:6.1%}")

figure, axes = plt.subplots()
names = [row.source for row in reversed(rows)]
axes.barh(names, [100 * row.share for row in reversed(rows)])
axes.set(
    xlabel="share of the variance [%]", title="tangent modulus, T-1 new, 100 %: synthetic data"
)
