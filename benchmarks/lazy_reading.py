"""One cycle of an archive against all of it: time and memory of what is read.

    python benchmarks/lazy_reading.py [ARCHIVE.nc | ROWS]

Without an archive, one is made of a generated log (synthetic) of that many rows, every sample in
it, in the folder BENCHMARK_DATA, or a temporary one.
"""

from __future__ import annotations

import resource
import statistics
import sys
from pathlib import Path
from time import perf_counter

import xarray as xr
from archive_cost import STORE, keeping_all
from figures import Figure, hand_on
from programs import run, synthetic_log

import reduction

SAMPLES = [
    "time", "crosshead_position", "tension", "strain", "nominal_stress", "quality_flag", "branch",
]  # fmt: skip
CYCLES = 20


def peak_mb() -> float:
    """Of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def of_cycle(test: xr.Dataset, cycle: int) -> tuple[float, int]:
    """Seconds for the seven variables of one cycle, and its samples."""
    start = perf_counter()
    first, last = (int(test[f"cycle_{end}_sample"][cycle]) for end in ("first", "last"))
    loop = test[SAMPLES].isel(sample=slice(first, last + 1)).load()
    return perf_counter() - start, loop.sizes["sample"]


def made(n_rows: int) -> Path:
    """Make an archive of a generated log, with every sample in it."""
    campaign, log = synthetic_log(n_rows)
    archive = log.with_name(f"whole_{n_rows}.nc")
    run(STORE, keeping_all(campaign), archive)
    return archive


def main(path: Path) -> list[Figure]:
    """Print a Markdown table."""
    reduction.open_campaign(path).close()  # imports
    start, before = perf_counter(), peak_mb()
    with reduction.open_campaign(path) as test:
        opened = perf_counter() - start
        if "sample_index" in test:
            sys.exit(f"{path} holds a part of its record: {test.attrs['stored_samples']}")
        n_cycles = test.sizes["cycle"]
        ones = [of_cycle(test, n_cycles * k // CYCLES) for k in range(CYCLES)]
        after_cycles = peak_mb()
        start = perf_counter()
        table = test["chord_modulus"].values
        of_table = perf_counter() - start
        start = perf_counter()
        whole = test[SAMPLES].load()
        of_whole = perf_counter() - start
        print(
            f"{whole.sizes['sample']} samples, {whole.sizes['specimen']} specimens, {n_cycles} "
            f"cycles, {ones[0][1]} samples in the first, {len(test.variables)} variables, "
            f"{path.stat().st_size / 1e6:.0f} MB"
        )
    print("| | s | memory, MB |\n|---|---|---|")
    print(f"| opening | {opened:.3f} | |")
    of_one = statistics.median(seconds for seconds, _ in ones)
    print(
        f"| seven variables of one cycle (memory: of {CYCLES}) | {of_one:.3f} | "
        f"{after_cycles - before:.0f} |"
    )
    print(f"| chord moduli of all cycles, {table.size} | {of_table:.3f} | |")
    print(f"| seven variables, whole | {of_whole:.3f} | {peak_mb() - before:.0f} |")
    every = tuple(seconds for seconds, _ in ones)
    samples = f"seven variables of {whole.sizes['sample']:,} samples"
    return [
        Figure(what=f"{samples} read from an archive", values=(of_whole,)),
        Figure(
            what=f"those of one of its {n_cycles:,} cycles",
            values=every,
            against="times the whole record",
            ratios=tuple(one / of_whole for one in every),
        ),
        Figure(what="memory of twenty cycles", unit="MB", values=(after_cycles - before,)),
    ]


if __name__ == "__main__":
    given = sys.argv[1] if len(sys.argv) > 1 else "2000000"
    hand_on(main(made(int(given)) if given.isdecimal() else Path(given)))
