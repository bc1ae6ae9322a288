"""Programs that benchmarks run beside each other, each in a process of its own."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from generate import write_campaign

__all__ = [
    "PARSE",
    "REDUCE",
    "Usage",
    "package_of",
    "print_sides",
    "run",
    "seconds_of",
    "sizes",
    "synthetic_log",
    "usage_of",
]

ROOT = Path(__file__).parents[1]

_BEGIN = """
import json, resource, sys, time
from pathlib import Path
def say(**found):
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"peak_mb": peak, **found}))
"""

PARSE = """
import pandas
start = time.perf_counter()
table = pandas.read_csv(sys.argv[1])
say(seconds=time.perf_counter() - start, rows=len(table))
"""
"""A log is parsed: the file is the argument."""

REDUCE = """
from reduction.batch.test_history import fit_strain_models
from reduction.batch.reduce_tests import _reduce_survey
from reduction.batch.survey import survey_log
from reduction.campaign.load import load_campaign
from reduction.readers.layout import LogParts
if sys.argv[2:] in (["memory"], ["disk"]):
    LogParts.folder_of = lambda self, n_bytes: {"memory": None, "disk": self.folder}[sys.argv[2]]
campaign = load_campaign(Path(sys.argv[1]))
start = time.perf_counter()
[survey] = survey_log(campaign, "long")
if survey.error is not None:
    raise survey.error
located = time.perf_counter()
models, _ = fit_strain_models(campaign, [survey])
test = _reduce_survey(
    campaign, survey, [models["long", name] for name in survey.plan.specimens], None, "{}"
)
reduced = time.perf_counter()
"""
"""A log is reduced, and what becomes of ``test`` follows: the arguments are its campaign, and
``memory`` or ``disk`` where the columns lie elsewhere than usual."""


def run(code: str, *arguments: object) -> dict[str, Any]:
    """Run a program to its end; it has ``say``, and gives what it says."""
    done = subprocess.run(
        [sys.executable, "-c", _BEGIN + code, *map(str, arguments)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        sys.exit(done.stderr)
    return dict(json.loads(done.stdout))


@dataclass(frozen=True)
class Usage:
    """What a command took, with all processes that it started: seconds and megabytes."""

    processor: float
    wall: float
    largest_mb: float
    together_mb: float


def usage_of(command: Sequence[str], *, cwd: Path, env: Mapping[str, str]) -> Usage:
    """Run a command to its end; memory together is looked at ten times a second (Linux)."""
    start, together = time.perf_counter(), 0.0
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            command, cwd=cwd, env=env, stdout=subprocess.DEVNULL, stderr=said
        )
        while True:
            ended, status, used = os.wait4(process.pid, os.WNOHANG)
            if ended:
                break
            together = max(together, _memory_of(process.pid))
            time.sleep(0.1)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 4):
            said.seek(0)
            sys.exit(f"{' '.join(command)}: {process.returncode}\n{said.read().decode()[-3000:]}")
    return Usage(
        used.ru_utime + used.ru_stime, time.perf_counter() - start, used.ru_maxrss / 1024,
        max(together, used.ru_maxrss / 1024),
    )  # fmt: skip


def _memory_of(process: int) -> float:
    """Proportional memory of a process and those that it started. [MB]."""
    try:
        tasks = Path(f"/proc/{process}/task").glob("*/children")
        children = [int(one) for task in tasks for one in task.read_text().split()]
        rollup = Path(f"/proc/{process}/smaps_rollup").read_text().partition("\nPss:")[2]
    except OSError:  # it has ended meanwhile
        return 0.0
    return int((rollup.split() or ["0"])[0]) / 1024 + sum(map(_memory_of, children))


def package_of(revision: str, folder: Path, *others: str) -> Path:
    """Unpack the package of another revision of this repository; the folder that it lies in.

    ``others`` are files or folders that are unpacked beside it.
    """
    packed = subprocess.run(
        ["git", "-C", str(ROOT), "archive", revision, "reduction", *others],
        capture_output=True, check=True,
    )  # fmt: skip
    with tarfile.open(fileobj=io.BytesIO(packed.stdout)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def synthetic_log(n_rows: int) -> tuple[Path, Path]:
    """Write a log and its campaign, in the folder BENCHMARK_DATA or a temporary one."""
    folder = Path(os.environ.get("BENCHMARK_DATA", tempfile.gettempdir())) / "reduction-benchmark"
    return write_campaign(folder, n_rows=n_rows), folder / f"long_{n_rows}.csv"


def sizes(n_rows: int = 5_760_000, repeats: int = 3) -> tuple[int, int]:
    """Rows and repeats of the command line."""
    told = [int(one) for one in sys.argv[1:3]]
    return (*told, *(n_rows, repeats)[len(told) :])  # type: ignore[return-value]


def seconds_of(side: Sequence[Mapping[str, Any]], key: str = "seconds") -> tuple[float, ...]:
    """Seconds of all runs of a side."""
    return tuple(one[key] for one in side)


def print_sides(
    sides: Mapping[str, Sequence[Mapping[str, Any]]], to: Sequence[str] = ()
) -> tuple[float, ...]:
    """Print seconds and memory of all sides, and give the ratios of the first to another one.

    That is the second, or of those named the one whose median is least.
    """
    print("| | median s | min | max | peak MB |\n|---|---|---|---|---|")
    for name, side in sides.items():
        taken = seconds_of(side)
        peak = max(one["peak_mb"] for one in side)
        print(f"| {name} | {_spread(taken)} | {peak:.0f} |")
    first, *others = sides
    fastest = min(to or others[:1], key=lambda name: median(seconds_of(sides[name])))
    ratios = tuple(
        ours / theirs
        for ours, theirs in zip(
            *(seconds_of(sides[name]) for name in (first, fastest)), strict=True
        )
    )
    print(f"| ratio{f' to {fastest}' if to else ''} | {_spread(ratios)} | |")
    return ratios


def _spread(numbers: Sequence[float]) -> str:
    return f"{median(numbers):.2f} | {min(numbers):.2f} | {max(numbers):.2f}"
