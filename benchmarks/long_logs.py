"""Time and memory of the reduction of logs of 10^5 to 10^8 rows, in memory and on disk.

    python benchmarks/long_logs.py [ROWS ...]

Each log is generated (synthetic), reduced without its archive in a process of its own, once in
memory and once in scratch files, in turn; a log of more than 10^7 rows on disk alone.  10^8 rows
are 3.1 GB of CSV, and about 10 GB of scratch files, in the folder BENCHMARK_DATA, or a temporary
one, and in TMPDIR.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

from figures import Figure, hand_on
from programs import REDUCE, run, synthetic_log

MOST_MB, MOST_OVER_MEMORY = 600.0, 1.2
SIZES = (100_000, 1_000_000, 10_000_000, 100_000_000)
MOST_IN_MEMORY = 10_000_000
LINEAR_FROM = 100_000_000
PLACES = {"memory": "in memory", "disk": "on disk"}
END = """
import hashlib
digest = hashlib.sha256(test.curves.tangent_modulus.tobytes())
for name in ("peak_tension", "hysteresis_energy", "apparent_spring_constant"):
    digest.update(getattr(test.loops, name).tobytes())
say(seconds=reduced - start, cycles=test.cycles.n_cycles, digest=digest.hexdigest()[:16])
"""


def figures(found: dict[tuple[int, str], dict[str, float]]) -> Iterator[Figure]:
    """Time of a row beside that of the longest log in memory, growth of time, and memory."""
    longest = max((rows for rows, where in found if where == "memory"), default=0)
    for (n_rows, where), one in found.items():
        per_row = one["seconds"] / n_rows
        ratios: tuple[float, ...] = ()
        if where == "disk" and longest:
            ratios = (per_row / (found[longest, "memory"]["seconds"] / longest),)
        yield Figure(
            what=f"a million rows out of {n_rows:,}, columns {PLACES[where]}",
            values=(1e6 * per_row,),
            against=f"times {longest:,} rows in memory",
            ratios=ratios,
            at_most=MOST_OVER_MEMORY if ratios and n_rows >= longest else None,
        )
        shorter = found.get((n_rows // 10, where))
        if shorter is not None:
            yield Figure(
                what=f"time of {n_rows:,} rows, columns {PLACES[where]}",
                values=(one["seconds"],),
                against="times a tenth of the rows",
                ratios=(one["seconds"] / shorter["seconds"],),
                at_least=9.0 if n_rows >= LINEAR_FROM else None,
                at_most=11.0 if n_rows >= LINEAR_FROM else None,
            )
        yield Figure(
            what=f"peak memory of {n_rows:,} rows, columns {PLACES[where]}",
            unit="MB",
            values=(one["peak_mb"],),
            at_most=MOST_MB if where == "disk" else None,
            of="value",
        )


def main(sizes: tuple[int, ...]) -> list[Figure]:
    """Print a Markdown table: seconds, seconds a million rows, peak memory."""
    print("| rows | cycles | columns in | s | s a million rows | peak MB | numbers |")
    print("|---|---|---|---|---|---|---|")
    all_found: dict[tuple[int, str], dict[str, float]] = {}
    for n_rows in sizes:
        campaign, _ = synthetic_log(n_rows)
        for where in ("memory", "disk") if n_rows <= MOST_IN_MEMORY else ("disk",):
            found = all_found[n_rows, where] = run(REDUCE + END, campaign, where)
            print(
                f"| {n_rows:,} | {found['cycles']:,} | {where} | {found['seconds']:.2f} "
                f"| {found['seconds'] / n_rows * 1e6:.2f} | {found['peak_mb']:.0f} "
                f"| {found['digest']} |",
                flush=True,
            )
    return list(figures(all_found))


if __name__ == "__main__":
    hand_on(main(tuple(int(one) for one in sys.argv[1:]) or SIZES))
