"""Time of the whole reduction without archive over the fastest of four parsers of the same file.

    python benchmarks/reduction_over_parse.py [ROWS] [REPEATS] [memory | disk]

The parsers are pandas (its C parser, and that of pyarrow), pyarrow and polars; one that is not
installed is named and left out.  Columns lie where a run puts them, in memory up to 32 MB of text
and else on disk, or where asked.  All sides run in turn, each in a process of its own, so that the
ratio holds when the machine's speed drifts.  Hashing of the raw file is part of the reduction; what
it takes alone stands beside.  The file is generated (synthetic) in the folder BENCHMARK_DATA, or a
temporary one.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec

from figures import Figure, hand_on
from programs import PARSE, REDUCE, print_sides, run, seconds_of, sizes, synthetic_log

WANTED, MOST_MB = 4.0, 1500.0  # times parsing; peak memory
END = "say(seconds=reduced - start, cycles=test.cycles.n_cycles)"

TIMED = """
start = time.perf_counter()
{call}
say(seconds=time.perf_counter() - start)
"""
PARSERS = {
    "pandas.read_csv": ("pandas", PARSE),
    "pandas.read_csv, pyarrow": (
        "pyarrow",
        "import pandas" + TIMED.format(call="pandas.read_csv(sys.argv[1], engine='pyarrow')"),
    ),
    "pyarrow.csv": (
        "pyarrow",
        "import pyarrow.csv" + TIMED.format(call="pyarrow.csv.read_csv(sys.argv[1])"),
    ),
    "polars": ("polars", "import polars" + TIMED.format(call="polars.read_csv(sys.argv[1])")),
}
HASH = "import hashlib" + TIMED.format(
    call="hashlib.file_digest(open(sys.argv[1], 'rb'), 'sha256').hexdigest()"
)
REDUCTION, HASHING = "reduction, hashing included", "hashing alone"


def main(n_rows: int, repeats: int, where: str = "usual") -> list[Figure]:
    """Print a Markdown table of all sides, and the ratios to the fastest parser."""
    campaign, log = synthetic_log(n_rows)
    parsers = {name: code for name, (needs, code) in PARSERS.items() if find_spec(needs)}
    sides = {name: [] for name in (REDUCTION, *parsers, HASHING)}
    for _ in range(repeats + 1):
        sides[REDUCTION].append(run(REDUCE + END, campaign, where))
        for name, code in (*parsers.items(), (HASHING, HASH)):
            sides[name].append(run(code, log))
    sides = {name: side[1:] for name, side in sides.items()}  # the first is a warm-up
    ours = sides[REDUCTION]
    print(
        f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {ours[0]['cycles']} cycles, "
        f"{len(os.sched_getaffinity(0))} processors, {repeats} rounds after one warm-up"
        + (f", columns {'on' if where == 'disk' else 'in'} {where}" if where != "usual" else "")
    )
    lacking = [name for name in PARSERS if name not in parsers]
    if lacking:
        print(f"not installed: {', '.join(lacking)}")
    ratios = print_sides(sides, to=tuple(parsers))
    return [
        Figure(
            what=f"reduction of {n_rows:,} rows, no archive",
            values=seconds_of(ours),
            against="times the fastest parser",
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
