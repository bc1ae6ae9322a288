"""Time of the whole reduction without archive over `pandas.read_csv` of the same file.

    python benchmarks/reduction_over_parse.py [ROWS] [REPEATS] [memory | disk]

Columns lie where a run puts them, in memory up to 32 MB of text and else on disk, or where asked.
The two run in turn, A B A B ..., each in a process of its own, so that the ratio holds when
the machine's speed drifts; hashing of the raw file is part of the reduction.  The file
is generated (synthetic) in the folder BENCHMARK_DATA, or a temporary one.
"""

from __future__ import annotations

import os
import sys

from figures import Figure, hand_on
from programs import PARSE, REDUCE, print_sides, run, seconds_of, sizes, synthetic_log

WANTED, MOST_MB = 2.5, 1500.0  # times parsing; peak memory
END = "say(seconds=reduced - start, cycles=test.cycles.n_cycles)"


def main(n_rows: int, repeats: int, where: str = "usual") -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    campaign, log = synthetic_log(n_rows)
    pairs = [(run(REDUCE + END, campaign, where), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    ours, theirs = zip(*pairs, strict=True)
    print(
        f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {ours[0]['cycles']} cycles, "
        f"{os.cpu_count()} processors, {repeats} pairs after one warm-up"
        + (f", columns {'on' if where == 'disk' else 'in'} {where}" if where != "usual" else "")
    )
    ratios = print_sides({"reduction, hashing included": ours, "pandas.read_csv": theirs})
    return [
        Figure(
            what=f"reduction of {n_rows:,} rows, no archive",
            values=seconds_of(ours),
            against="times `pandas.read_csv`",
            ratios=ratios,
            at_most=WANTED,
        ),
        Figure(
            what="its peak memory",
            unit="MB",
            values=tuple(one["peak_mb"] for one in ours),
            at_most=MOST_MB,
            of="value",
        ),
    ]


if __name__ == "__main__":
    hand_on(main(*sizes(), *sys.argv[3:]))
