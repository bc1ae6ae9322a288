"""How long it takes to begin: the package, the help, the readers that need more.

    python benchmarks/startup.py [runs]

Every row is a process of its own, in turn; seconds from its start to its end, the interpreter's own
start ("python alone") included.
"""

from __future__ import annotations

import shutil
import statistics
import subprocess
import sys
from pathlib import Path
from time import perf_counter

from figures import Figure, hand_on

PYTHON = [sys.executable]
COMMAND = shutil.which("reduction", path=str(Path(sys.executable).parent))
HELP = [COMMAND] if COMMAND else [*PYTHON, "-m", "reduction"]
# what is wanted, where something is, in seconds
SIDES: dict[str, tuple[list[str], float | None]] = {
    "python alone": ([*PYTHON, "-c", "pass"], None),
    "import reduction": ([*PYTHON, "-c", "import reduction"], 0.2),
    "reduction --help": ([*HELP, "--help"], 0.5),
    "reduction run --help": ([*HELP, "run", "--help"], 0.5),
    "import xarray": ([*PYTHON, "-c", "import xarray"], None),
    "reduction.open_campaign": ([*PYTHON, "-c", "import reduction; reduction.open_campaign"], None),
}


def seconds(command: list[str]) -> float:
    """Of one process."""
    start = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def main(runs: int) -> list[Figure]:
    """Print a row a side."""
    taken: dict[str, list[float]] = {name: [] for name in SIDES}
    for _ in range(runs + 1):
        for name, (command, _limit) in SIDES.items():
            taken[name].append(seconds(command))
    print(f"Python {sys.version.split()[0]}, {runs} runs after a warm-up")
    print("| | median s | min | max | times python alone | wanted | |")
    print("|---|---|---|---|---|---|---|")
    alone = statistics.median(taken["python alone"][1:])
    for name, every in taken.items():
        median, limit = statistics.median(every[1:]), SIDES[name][1]
        verdict = "" if limit is None else "met" if median <= limit else "**not met**"
        print(
            f"| {name} | {median:.3f} | {min(every[1:]):.3f} | {max(every[1:]):.3f} "
            f"| {median / alone:.1f} | {'' if limit is None else limit} | {verdict} |"
        )
    return [
        Figure(what=name, values=tuple(every[1:]), at_most=SIDES[name][1], of="value")
        for name, every in taken.items()
    ]


if __name__ == "__main__":
    hand_on(main(int(sys.argv[1]) if len(sys.argv) > 1 else 15))
