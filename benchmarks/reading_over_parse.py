"""Time of reading and hashing a log over `pandas.read_csv` of the same file.

    python benchmarks/reading_over_parse.py [ROWS] [REPEATS]

The two run in turn, A B A B ..., each in a process of its own.  Reading is everything up to the
declared columns in the file's own units: the hash, the look for odd characters, and the check that
the file did not change meanwhile.  The log is that of `reduction_over_parse.py` (synthetic).
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path
from statistics import median

from figures import Figure, hand_on
from generate import write_campaign
from reduction_over_parse import PARSE, run

READ = """
import time, json, resource, sys
from pathlib import Path
from reduction.campaign.load import load_campaign
from reduction.ingest.read import read_log
campaign = load_campaign(Path(sys.argv[1]))
(name, layout), = campaign.tests["long"].files
start = time.perf_counter()
log = read_log(campaign.file(name), campaign.layouts[layout], name=name)
print(json.dumps({"seconds": time.perf_counter() - start, "rows": log.n_rows_read,
    "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    folder = Path(os.environ.get("BENCHMARK_DATA", tempfile.gettempdir())) / "reduction-benchmark"
    campaign = write_campaign(folder, n_rows=n_rows)
    log = folder / f"long_{n_rows}.csv"
    pairs = [(run(READ, campaign), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    if any(one["rows"] != n_rows for pair in pairs for one in pair):
        raise SystemExit(f"not {n_rows} rows: {pairs}")
    ratios = tuple(ours["seconds"] / theirs["seconds"] for ours, theirs in pairs)
    print(f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {repeats} pairs after one warm-up")
    print("| | median s | min | max | peak MB |\n|---|---|---|---|---|")
    found = []
    for name, side in (("pandas.read_csv", 1), ("reading alone, hashing included", 0)):
        seconds = tuple(pair[side]["seconds"] for pair in pairs)
        peak = max(pair[side]["peak_mb"] for pair in pairs)
        print(
            f"| {name} | {median(seconds):.2f} | {min(seconds):.2f} | {max(seconds):.2f} "
            f"| {peak:.0f} |"
        )
        found.append(
            Figure(what=f"{name}, {n_rows:,} rows", values=seconds)
            if side
            else Figure(what=name, values=seconds, against="times `pandas.read_csv`", ratios=ratios)
        )
    print(f"| ratio | {median(ratios):.2f} | {min(ratios):.2f} | {max(ratios):.2f} | |")
    return found


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 5_760_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 3,
        )
    )
