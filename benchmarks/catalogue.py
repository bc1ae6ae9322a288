"""Two thousand small campaigns in the catalogue: their files made, and asked.

    python benchmarks/catalogue.py [number of campaigns]

One test of the synthetic tethers is reduced, its record cut to 200 samples, and copied into one
folder a campaign, each with its own name, frequency and mean tension (all synthetic). A question is
timed in this process, where the libraries are loaded, and as the command with its start.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

import netCDF4
import numpy as np
from figures import Figure, hand_on

from reduction.archive.open import open_archive
from reduction.batch.catalogue import (
    FILE_NAME,
    Query,
    answer,
    condition_of,
    load_catalogue,
    needed_quantities,
)
from reduction.batch.catalogue_entries import rebuild

ROOT = Path(__file__).parents[1]
WANTED = 1.0  # s, of a question
N_SAMPLES, PASSES = 200, 7
OPTIONS = ("--kind", "cyclic", "--specimen", "new", "--where", "frequency >= 0.9 Hz")
QUANTITY = "apparent_spring_constant"
SCALED = (
    "test_frequency", "test_mean_tension", f"test_{QUANTITY}", QUANTITY, "tangent_modulus",
    "tangent_modulus_standard_uncertainty", "branch_tension", "segment_modulus",
)  # fmt: skip


def small_product(folder: Path) -> Path:
    """T-1 of the synthetic tethers, reduced, with the first samples of its record."""
    campaign = ROOT / "raw" / "tmt-synthetic" / "campaign.toml"
    command = [sys.executable, "-m", "reduction", "run", campaign, "--test", "T-1", "--quiet"]
    places = ["--processed", folder / "one", "--reports", folder / "reports"]
    subprocess.run([*map(str, command), *map(str, places)], check=True)
    path = folder / "small.nc"
    with open_archive(folder / "one" / "tmt-synthetic" / "T-1.nc") as archive:
        archive.isel(sample=slice(N_SAMPLES)).to_netcdf(path)
    return path


def campaigns(product: Path, folder: Path, count: int) -> None:
    """Copies with names, frequencies and mean tensions of their own."""
    rng = np.random.default_rng(1)
    for number in range(count):
        path = folder / f"campaign-{number:04}" / "T-1.nc"
        path.parent.mkdir(parents=True)
        shutil.copyfile(product, path)
        with netCDF4.Dataset(path, "a") as archive:
            archive.setncatts({"campaign": path.parent.name, "id": f"{path.parent.name}/T-1"})
            for name in SCALED:
                archive[f"cycles/{name}"][:] = archive[f"cycles/{name}"][:] * rng.uniform(0.1, 10.0)


def seconds_of_command(folder: Path, *options: str) -> float:
    """Of one run of the command, its start and its table in it."""
    line = [sys.executable, "-m", "reduction", "catalogue", str(folder), *options]
    start = perf_counter()
    subprocess.run(line, check=True, capture_output=True)
    return perf_counter() - start


def seconds_of_question(folder: Path, query: Query) -> float:
    """Of one question: the numbers, the rows."""
    start = perf_counter()
    catalogue = load_catalogue(folder, needed_quantities(query))
    if catalogue.unreadable:
        raise SystemExit("the catalogue is not what it should be")
    answer(catalogue, query)
    return perf_counter() - start


def main(count: int) -> list[Figure]:
    """Print times as a Markdown table."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "processed"
        product = small_product(Path(place))
        campaigns(product, folder, count)
        start = perf_counter()
        if rebuild(folder):
            raise SystemExit("an archive is not in its catalogue")
        made = perf_counter() - start
        query = Query(
            names={"test_kind": ("cyclic",), "specimen": ("new",)},
            where=(condition_of(OPTIONS[-1]),),
            quantity=(QUANTITY,),
            sort=(QUANTITY,),
        )
        curve = Query(quantity=("tangent_modulus",), where=(condition_of("strain_bin >= 1"),))
        asked = [*OPTIONS, "--quantity", QUANTITY, "--sort", QUANTITY]
        whole = ["--quantity", QUANTITY, "--export", f"{place}/all.csv", "--quiet"]
        rows = {
            "question, libraries loaded": lambda: seconds_of_question(folder, query),
            "curves of every test, libraries loaded": lambda: seconds_of_question(folder, curve),
            "the command": lambda: seconds_of_command(folder, *asked),
            "the command, every test to CSV": lambda: seconds_of_command(folder, *whole),
        }
        size = sum(path.stat().st_size for path in folder.glob(f"*/{FILE_NAME}")) / 1e6
        each, n_numbers = product.stat().st_size / 1e3, len(load_catalogue(folder).numbers)
        print(f"{count} archives of {each:.0f} kB, {n_numbers} numbers, catalogues {size:.1f} MB")
        print(f"load before: {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors\n")
        print("| what | s, median | s, least | s, most |\n|---|---|---|---|")
        print(f"| catalogues made | {made:.1f} | | |")
        found = [Figure(what=f"catalogues of {count:,} campaigns made", values=(made,))]
        for name, time in rows.items():
            times = [time() for _ in range(PASSES)]
            found.append(
                Figure(
                    what=name,
                    values=tuple(times),
                    at_most=None if "every test" in name else WANTED,
                    of="value",
                )
            )
            print(
                f"| {name} | {statistics.median(times):.2f} | {min(times):.2f} | {max(times):.2f} |"
            )
        return found


if __name__ == "__main__":
    hand_on(main(int(sys.argv[1]) if len(sys.argv) > 1 else 2000))
