"""What hostile texts, campaigns, paths and names cost: each alone, in a process of its own.

    python benchmarks/hostile.py [--all]

Prints the table of docs/robustness.md: exit status, seconds and memory of each case beyond those
of the start of the command on a good small campaign. Without --all a choice of the cases. All of
them are synthetic; tests/cli/test_hostile_text.py runs them in one process.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))
from hostile import alone, complaints  # noqa: E402
from hostile_text import CASES, HEADER, SLOW, campaign, rows  # noqa: E402

CHOSEN = (
    "a line of 20 MB", "200 GB, nearly all of it NUL bytes", "10 GB, nearly all of it NUL bytes",
    "100,000 columns", "a NUL byte far below", "UTF-16 with an odd byte at its end",
    "a quote that is never closed", "200,000 comment lines",
    "sniffed: a pipe that nobody writes", "sniffed: a device that never ends",
    "100,000 brackets", "a key of 20,000 parts", "a million keys", "10,000 keys",
    "a file of 100 MB", "a whole number of 5,000 digits", "tests.csv with a cell of a megabyte",
    "tests.csv with 100,000 columns", "log: zero.csv", "log: pipe.csv", "marks: ring",
)  # fmt: skip


def good(folder: Path) -> list[object]:
    """A small campaign in which nothing is wrong but that its log is short."""
    (folder / "log.csv").write_bytes(HEADER + rows())
    arguments: list[object] = campaign(folder)
    return arguments


def main(wanted: list[str]) -> None:
    """Run and print."""
    with tempfile.TemporaryDirectory() as folder:
        start = min(
            (alone(*good(Path(folder)), cwd=folder) for _ in range(3)), key=lambda one: one.seconds
        )
    print(f"Start alone: {start.seconds:.1f} s, {start.megabytes:.0f} MB\n")
    print("| what | exit status | s | MB |\n|---|---|---|---|")
    cases = CASES if "--all" in wanted else [case for case in CASES if case.name in CHOSEN]
    for case in (*cases, *SLOW):
        with tempfile.TemporaryDirectory() as folder:
            ended = alone(*case.make(Path(folder)), cwd=folder, deadline=600)
        seconds = max(ended.seconds - start.seconds, 0.0)
        megabytes = max(ended.megabytes - start.megabytes, 0.0)
        print(f"| {case.name} | {ended.status} | {seconds:.1f} | {megabytes:.0f} |", flush=True)
        known = (start.seconds, start.megabytes)
        for line in complaints(case, ended, started=known):
            print(line, file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
