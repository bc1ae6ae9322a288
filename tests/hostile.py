"""Hostile files: what makes each of them, what the command has to say, and what that may cost.

A case is run in this process, where the libraries are loaded, or alone: in a process of its own with a
ceiling on its memory and a deadline.  benchmarks/hostile.py runs all of them alone.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
# a small process in between: the peak of a process counts what it was forked from
_LAUNCH = """
import json, resource, subprocess, sys, time
ceiling, deadline, out, *command = sys.argv[1:]
resource.setrlimit(resource.RLIMIT_AS, (int(ceiling), int(ceiling)))
begin = time.monotonic()
with open(out + ".out", "wb") as said, open(out + ".err", "wb") as wrong:
    try:
        status = subprocess.run(
            command, stdin=subprocess.DEVNULL, stdout=said, stderr=wrong, timeout=float(deadline)
        ).returncode
    except subprocess.TimeoutExpired:
        status = None
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
with open(out, "w") as file:
    json.dump([status, time.monotonic() - begin, peak / 1024], file)
"""


@dataclass(frozen=True)
class Case:
    """One hostile file.

    ``make`` writes it into a folder and returns the arguments of the command; ``status`` is the
    exit status, ``says`` stands in its message (or in what it prints, where it succeeds).
    ``seconds`` and ``megabytes`` are what it may cost beyond the start of the command.
    """

    name: str
    make: Callable[[Path], list]
    status: int
    says: str = ""
    seconds: float = 30.0
    megabytes: float = 100.0

    def __str__(self):
        return self.name


@dataclass(frozen=True)
class Ended:
    """How a command ended; ``status`` is None where the deadline passed."""

    status: int | None
    stdout: str
    stderr: str
    seconds: float
    megabytes: float


def alone(*arguments, cwd, ceiling=8 << 30, deadline=120.0):
    """Run the command in a process of its own; its memory is the peak of what it held."""
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "ended")
        command = [sys.executable, "-m", "reduction", *map(str, arguments)]
        subprocess.run(
            [sys.executable, "-S", "-E", "-c", _LAUNCH, str(ceiling), str(deadline), out, *command],
            cwd=cwd, check=True, env=os.environ | {"PYTHONPATH": str(ROOT), "COLUMNS": "200"},
        )  # fmt: skip
        status, seconds, peak = json.loads(Path(out).read_text())
        said, wrong = (Path(out + end).read_bytes().decode() for end in (".out", ".err"))
    return Ended(status, said, wrong, seconds, peak)


class DeadlinePassed(BaseException):
    """Nothing in the package may catch it."""


@contextmanager
def deadline(seconds):
    """Leave the block with `DeadlinePassed` after so many seconds, even from a pipe's opening."""

    def passed(number, frame):
        raise DeadlinePassed(f"more than {seconds:g} s")

    before = signal.signal(signal.SIGALRM, passed)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _memory(key):
    text = Path("/proc/self/status").read_text()
    return int(text.partition(f"{key}:")[2].split()[0]) / 1024


def in_here(command, *arguments, cwd, seconds=60.0):
    """Run the command in this process; its memory is what it took above what was held before."""
    is_measured = sys.platform == "linux"
    if is_measured:
        Path("/proc/self/clear_refs").write_text("5")  # the peak begins again
        before = _memory("VmRSS")
    begin = time.monotonic()
    with deadline(seconds):
        done = command(*arguments, cwd=cwd)
    took = time.monotonic() - begin
    peak = _memory("VmHWM") - before if is_measured else 0.0
    return Ended(done.returncode, done.stdout, done.stderr, took, peak)


def complaints(case, ended, *, started=(0.0, 0.0)):
    """What is wrong with how a case ended; ``started`` is what the start alone takes: s, MB."""
    told = ended.stderr if case.status else ended.stdout
    found = []
    if ended.status != case.status:
        found.append(f"status {ended.status}, not {case.status}")
    if "Traceback" in ended.stderr or "internal error" in ended.stderr:
        found.append("a traceback or an internal error")
    if case.says not in told:
        found.append(f"{case.says!r} is not said")
    if ended.seconds - started[0] > case.seconds:
        found.append(f"{ended.seconds:.1f} s")
    if ended.megabytes - started[1] > case.megabytes:
        found.append(f"{ended.megabytes:.0f} MB")
    return [*found, told[-2000:]] if found else []
