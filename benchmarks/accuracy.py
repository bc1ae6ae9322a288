"""Tangent modulus of the synthetic campaign against its truth, as a Markdown table.

    reduction run raw/tmt-synthetic/campaign.toml
    python benchmarks/accuracy.py processed/tmt-synthetic

Each cell: median of |E / E_true - 1| over the strain bins in percent, and in brackets the mean
of E / E_true - 1.  E_true of a bin is the median of the true modulus of the samples in it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from reduction.archive.open import open_archive

PSI = 4.4482216152605 / 0.0254**2
TRUTH = Path(__file__).parents[1] / "raw" / "tmt-synthetic" / "truth"
SPECIMENS = ("new", "used")
BRANCHES = ("ascending", "descending")


def cell(processed: Path, test: str, specimen: int, branch: int) -> str:
    """One test, specimen and branch."""
    truth = np.genfromtxt(TRUTH / f"{test}_cycles.csv", delimiter=",", names=True)
    strain = truth[f"eps_free_{SPECIMENS[specimen]}"]
    modulus = truth[f"E_tangent_psi_{SPECIMENS[specimen]}"] * PSI
    rising = np.gradient(strain) > 0
    moves = rising if branch == 0 else ~rising
    with open_archive(processed / f"{test}.nc") as archive:
        bounds = archive["strain_bin_bounds"].values
        found = archive["tangent_modulus"].values[specimen, branch]
    inside = [moves & (strain >= low) & (strain < high) for low, high in bounds]
    true = np.array([np.median(modulus[at]) if at.any() else np.nan for at in inside])
    error = 100 * (found / true - 1)
    error = error[np.isfinite(error)]
    return f"{np.median(np.abs(error)):.2f} ({np.mean(error):+.2f})"


def main(processed: Path) -> None:
    """Print the table."""
    heads = [f"{specimen}, {branch}" for specimen in SPECIMENS for branch in BRANCHES]
    print("| test | " + " | ".join(heads) + " |\n|---" * 1 + "|---" * 4 + "|")
    for number in range(1, 7):
        test = f"T-{number}"
        cells = [cell(processed, test, index, side) for index in range(2) for side in range(2)]
        print(f"| {test} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
