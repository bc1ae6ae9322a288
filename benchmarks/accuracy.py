"""Tangent modulus of the synthetic campaign against its truth, as a Markdown table.

    reduction run raw/tmt-synthetic/campaign.toml
    python benchmarks/accuracy.py processed/tmt-synthetic

Each cell: median of |E / E_true - 1| over the strain bins in percent, and in brackets the mean
of E / E_true - 1.  E_true of a bin is the median of the true modulus of the samples in it.  Below
the table: the rms of (E - E_true) / u over all bins, u the standard uncertainty that is stated.
"""

from __future__ import annotations

import sys
from itertools import product
from pathlib import Path

import numpy as np

from reduction.archive.open import open_archive

PSI = 4.4482216152605 / 0.0254**2
TRUTH = Path(__file__).parents[1] / "raw" / "tmt-synthetic" / "truth"
SPECIMENS = ("new", "used")
BRANCHES = ("ascending", "descending")


def errors(processed: Path, test: str, specimen: int, branch: int) -> tuple[np.ndarray, np.ndarray]:
    """One test, specimen and branch: error of each bin in percent, and over its uncertainty."""
    truth = np.genfromtxt(TRUTH / f"{test}_cycles.csv", delimiter=",", names=True)
    strain = truth[f"eps_free_{SPECIMENS[specimen]}"]
    modulus = truth[f"E_tangent_psi_{SPECIMENS[specimen]}"] * PSI
    rising = np.gradient(strain) > 0
    moves = rising if branch == 0 else ~rising
    with open_archive(processed / f"{test}.nc") as archive:
        bounds = archive["strain_bin_bounds"].values
        found = archive["tangent_modulus"].values[specimen, branch]
        u = archive["tangent_modulus_standard_uncertainty"].values[specimen, branch]
    inside = [moves & (strain >= low) & (strain < high) for low, high in bounds]
    true = np.array([np.median(modulus[at]) if at.any() else np.nan for at in inside])
    known = np.isfinite(found) & np.isfinite(true)
    return 100 * (found / true - 1)[known], ((found - true) / u)[known]


def main(processed: Path) -> None:
    """Print the table."""
    heads = [f"{specimen}, {branch}" for specimen in SPECIMENS for branch in BRANCHES]
    print("| test | " + " | ".join(heads) + " |\n|---" * 1 + "|---" * 4 + "|")
    over_u = []
    for number in range(1, 7):
        cells = []
        for index, side in product(range(2), range(2)):
            error, of_u = errors(processed, f"T-{number}", index, side)
            cells.append(f"{np.median(np.abs(error)):.2f} ({np.mean(error):+.2f})")
            over_u.append(of_u)
        print(f"| T-{number} | " + " | ".join(cells) + " |")
    print(f"\nrms of (E - E_true) / u: {np.sqrt(np.mean(np.concatenate(over_u) ** 2)):.2f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
