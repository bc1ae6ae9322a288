"""Coverage on laws that the package does not have: whether the 95 % intervals hold the truth.

    python benchmarks/coverage_strangers.py 24
    python benchmarks/coverage_strangers.py 200 --law tether-ratio-kinked --law line-falling

Each realisation of each law of `tests/strangers` is written as a campaign, run as by the command
but without tables and pages, and its archives are held against the truth beside it.  A cell is one
quantity of one law.  Its coverage has an interval from resampling whole realisations, since what
one campaign gets wrong it gets wrong in every bin.  Width is the median half-width over the
half-width that would have held 95 %.  A test that the command refuses is counted and judged by
nothing.  Status 1 where the upper end of a cell's interval lies below what is wanted.  Everything
is synthetic.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from time import perf_counter
from typing import Any
from unittest.mock import MagicMock, patch

import numpy as np
import xarray as xr

from reduction.archive.open import in_memory, reading
from reduction.batch import run_campaign as runs
from reduction.campaign.load import load_campaign
from reduction.lines.archive_source import lines_of_archive
from reduction.lines.line_lookup import look_up

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from nopage import NO_ANSWERS
from strangers import LAWS, Truth, make

WANTED = 0.93
# next to a reversal the modulus changes fastest, and the samples are fewest
WANTED_AT_ENDS = 0.90
END = 0.08  # of a branch
OF_A_RUN = (
    "apparent_spring_constant", "hysteresis_energy", "loss_factor", "frequency",
    "dissipation_spring_constant", "relaxation_time",
)  # fmt: skip
OF_A_SURFACE = (
    "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
    "relaxation_time",
)  # fmt: skip
# its name in the archive, and in the truth
OF_A_HOLD = {
    "relaxation_drop": "drop_to_end",
    "hold_initial_tension": "peak",
    "long_time_tension": "equilibrium",  # at the strain at the end of the ramp
}
N_POINTS = 40
NO_TESTS = ("surfaces", "comparisons", "predictions", "catalogue", "change_in_length")
NORMAL = 1.959964


@dataclass
class Realisation:
    """What one campaign gave: by cell, relative errors and half-widths; and who was refused."""

    law: str
    n_tests: int
    n_refused: int = 0
    cells: dict[str, list[tuple[float, float]]] = field(default_factory=lambda: defaultdict(list))

    def add(self, cell: str, value: Any, truth: Any, half_width: Any) -> None:
        """Numbers that are known on both sides, as shares of the truth."""
        found, true, half = np.broadcast_arrays(value, truth, half_width)
        known = np.isfinite(found) & np.isfinite(true) & np.isfinite(half)
        # a loss factor of zero has no relative error: the width is what it is judged by
        scale = np.where(np.abs(true[known]) > 0, np.abs(true[known]), 1.0)
        pairs = np.stack([np.abs(found - true)[known] / scale, half[known] / scale], axis=-1)
        self.cells[cell].extend(tuple(pair) for pair in pairs.tolist())


def judge_curves(
    into: Realisation, archive: xr.Dataset, place: int, truth: Truth, prefix: str
) -> None:
    """Tangent modulus by branch, and next to the reversal that a branch begins with."""
    if "tangent_modulus" not in archive or f"{prefix}strain" not in truth.arrays:
        return
    strain = archive["strain_bin"].to_numpy()
    for branch, name in enumerate(archive["branch_name"].to_numpy().astype(str)):
        true = np.interp(
            strain,
            truth.arrays[f"{prefix}strain"],
            truth.arrays[f"{prefix}{name}/tangent_modulus"],
            left=np.nan,
            right=np.nan,
        )
        value = archive["tangent_modulus"].to_numpy()[place, branch]
        spread = archive["tangent_modulus_standard_uncertainty"].to_numpy()[place, branch]
        into.add(f"tangent modulus, {name}", value, true, NORMAL * spread)
        known = np.isfinite(value * true * spread)
        if known.any():
            low, high = strain[known].min(), strain[known].max()
            along = strain - low if name == "ascending" else high - strain
            near = known & (along < END * (high - low))
            into.add("first 8 % of a branch", value[near], true[near], NORMAL * spread[near])


def judge_run(into: Realisation, archive: xr.Dataset, place: int, true: dict[str, Any]) -> None:
    """Numbers of a test."""
    for name in OF_A_RUN:
        key = f"test_{name}"
        if name not in true or key not in archive:
            continue
        spread = archive[f"{key}_standard_uncertainty"].to_numpy()[place]
        into.add(name, archive[key].to_numpy()[place], true[name], NORMAL * spread)


def judge_hold(into: Realisation, archive: xr.Dataset, true: dict[str, Any]) -> None:
    """Drop of the one hold of a test, and the tensions between which it lies."""
    for name, key in OF_A_HOLD.items():
        if key in true and name in archive:
            spread = archive[f"{name}_standard_uncertainty"].to_numpy()
            into.add(name, archive[name].to_numpy(), true[key], NORMAL * spread)


def judge_surfaces(into: Realisation, folder: Path, truth: Truth) -> None:
    """Values that a look-up gives at points that were not tested, drawn inside the design."""
    levels = {
        name: truth.arrays.get(f"interior/{name}", np.empty(0))[:N_POINTS]
        for name in ("frequency", "mean_tension", "tension_amplitude")
    }
    for path in folder.glob("*/surfaces.nc"):
        for line in lines_of_archive(path):
            for name in OF_A_SURFACE:
                if name not in line.surfaces or not levels["frequency"].size:
                    continue
                found = look_up(line, name, extrapolate="flag", **levels)
                true = np.where(
                    found.is_inside, truth.arrays[f"interior/{name}"][:N_POINTS], np.nan
                )
                # an interval need not be even about its value: the side of the truth counts
                half = np.where(
                    true > found.value,
                    found.surface_high - found.value,
                    found.value - found.surface_low,
                )
                into.add(f"surface of {name}", found.value, true, half)


def archives_of(folder: Path) -> Iterator[tuple[str, xr.Dataset]]:
    """Every archive of a test, by its name."""
    for path in sorted(folder.glob("*/*.nc")):
        if path.stem not in NO_TESTS:
            with reading(path) as archive:
                yield path.stem, in_memory(archive)


_NO_PAGE = {"return_value.write.return_value": (None, NO_ANSWERS)}


def realise(law: str, seed: int) -> Realisation:
    """Write one campaign, run it and hold it against its truth."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        truth = make(law, seed, folder)
        found = Realisation(law, sum(len(pieces) for pieces in truth.tests.values()))
        campaign = load_campaign(folder / "campaign.toml")
        with patch.multiple(
            runs, CampaignPage=MagicMock(**_NO_PAGE), write_tables=MagicMock(return_value=[]),
            write_catalogue=MagicMock(),
        ):  # fmt: skip
            done = runs.run_campaign(
                campaign, processed=folder / "p", reports=folder / "r", clock=perf_counter
            )
        for one in done.tests:
            if one.exit_status in (1, 6):
                raise RuntimeError(f"{law}, seed {seed}: {one.test}: {one.message}")
        n_judged = 0
        for test, archive in archives_of(folder / "p"):
            for place, specimen in enumerate(archive["specimen"].to_numpy().astype(str)):
                # what was found at a level of a record is filed by the level
                log, _, level = test.partition(".")
                piece = level.replace("-", " ") or specimen
                true = truth.tests.get(log, {}).get(piece)
                if true is None:
                    continue
                n_judged += 1
                judge_curves(found, archive, place, truth, f"{log}/{piece}/")
                judge_run(found, archive, place, true)
                judge_hold(found, archive, true)
        judge_surfaces(found, folder / "p", truth)
        found.n_refused = found.n_tests - n_judged
        return found


def resampled(parts: list[np.ndarray], rng: np.random.Generator) -> tuple[float, float]:
    """95 % interval of a share, whole realisations drawn again. [1]."""
    held = np.array([part.sum() for part in parts], dtype=np.float64)
    count = np.array([part.size for part in parts], dtype=np.float64)
    drawn = rng.integers(0, len(parts), (2000, len(parts)))
    shares = held[drawn].sum(axis=1) / np.maximum(count[drawn].sum(axis=1), 1)
    low, high = np.quantile(shares, [0.025, 0.975])
    return float(low), float(high)


def report(found: list[Realisation]) -> tuple[str, bool]:
    """Markdown of every cell, and whether all are as wanted."""
    rng = np.random.default_rng(1)
    lines = [
        "| law | quantity | numbers | held by 95 % | of it, resampled | error, median | width |",
        "|---|---|---|---|---|---|---|",
    ]
    is_sound = True
    by_law: dict[str, list[Realisation]] = defaultdict(list)
    for one in found:
        by_law[one.law].append(one)
    refused = []
    for law, several in by_law.items():
        refused.append(
            f"| {law} | {sum(one.n_refused for one in several)} of "
            f"{sum(one.n_tests for one in several)} |"
        )
        for cell in sorted({name for one in several for name in one.cells}):
            pairs = [np.array(one.cells[cell]) for one in several if one.cells.get(cell)]
            if not pairs:  # every number of it was withheld
                continue
            held = [part[:, 0] <= part[:, 1] for part in pairs]
            error, half = np.concatenate(pairs).T
            low, high = resampled(held, rng)
            enough = np.quantile(error, 0.95)
            share = float(np.concatenate(held).mean())
            wanted = WANTED_AT_ENDS if cell.startswith("first") else WANTED
            is_sound &= high >= wanted
            lines.append(
                f"| {law} | {cell} | {error.size} | {100 * share:.1f} % "
                f"| {100 * low:.0f} to {100 * high:.0f} % | {100 * np.median(error):.2f} % "
                f"| {np.median(half) / enough if enough > 0 else np.nan:.2f} |"
            )
    return "\n".join([*lines, "", "| law | refused |", "|---|---|", *refused]), is_sound


def main() -> int:
    """Run the study that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("realisations", type=int)
    parser.add_argument("--law", action="append", choices=list(LAWS))
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--first-seed", type=int, default=1)
    wanted = parser.parse_args()
    seeds = range(wanted.first_seed, wanted.first_seed + wanted.realisations)
    laws, numbers = zip(*product(wanted.law or LAWS, seeds), strict=True)
    with ProcessPoolExecutor(wanted.workers) as pool:
        text, is_sound = report(list(pool.map(realise, laws, numbers)))
    print(text)
    return 0 if is_sound else 1


if __name__ == "__main__":
    sys.exit(main())
