"""Time of the report page over `pandas.read_csv` of the log that it shows.

    python benchmarks/report_page.py [ROWS] [REPEATS]

The log of `reduction_over_parse.py` (synthetic) is reduced once, with the archive as it is by
default; then page and parsing run in turn, each in a process of its own, programs imported before
the clock starts.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from figures import Figure, hand_on
from generate import write_campaign
from reduction_over_parse import PARSE, run

PAGE = """
import time, json, resource, sys
from pathlib import Path
import netCDF4, xarray
from reduction.report.page import write_report
folder = Path(sys.argv[1])
start = time.perf_counter()
page = write_report(folder, folder / "report")
print(json.dumps({"seconds": time.perf_counter() - start, "size": page.stat().st_size,
    "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    folder = Path(os.environ.get("BENCHMARK_DATA", tempfile.gettempdir())) / "reduction-benchmark"
    campaign = write_campaign(folder, n_rows=n_rows)
    log = folder / f"long_{n_rows}.csv"
    with tempfile.TemporaryDirectory() as place:
        command = [sys.executable, "-m", "reduction", "run", str(campaign), "--quiet"]
        places = ["--processed", f"{place}/processed", "--reports", f"{place}/reports"]
        subprocess.run([*command, *places], check=True, stdout=subprocess.DEVNULL)
        processed = Path(place) / "processed" / "benchmark"
        pairs = [(run(PAGE, processed), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    ratios = tuple(page["seconds"] / parse["seconds"] for page, parse in pairs)
    print(
        f"{n_rows} rows, page of {pairs[0][0]['size'] / 1e6:.1f} MB, {repeats} pairs after one "
        "warm-up"
    )
    print("| | median s | min | max | peak MB |\n|---|---|---|---|---|")
    for name, side in (("report page", 0), ("pandas.read_csv", 1)):
        seconds = [pair[side]["seconds"] for pair in pairs]
        peak = max(pair[side]["peak_mb"] for pair in pairs)
        print(
            f"| {name} | {median(seconds):.2f} | {min(seconds):.2f} | {max(seconds):.2f} "
            f"| {peak:.0f} |"
        )
    print(f"| ratio | {median(ratios):.2f} | {min(ratios):.2f} | {max(ratios):.2f} | |")
    return [
        Figure(
            what=f"report page of a log of {n_rows:,} rows, from its archive",
            values=tuple(page["seconds"] for page, _ in pairs),
            against="times `pandas.read_csv`",
            ratios=ratios,
        )
    ]


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 5_760_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 3,
        )
    )
