"""Commands in a process of their own each, with a deadline and the memory and time they took.

The processes are forked from one that has loaded the package, which is quicker than a start, and
what they share with it counts as theirs: the memory is what a user would see.
"""

import json
import os
import resource
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHARE = 1_000_000  # bytes of what was printed that are kept
MOST_MEMORY = 8_000_000_000  # of one command, that a fault does no harm to the machine
MOST_ON_DISK = 2_000_000_000


@dataclass(frozen=True)
class Bounded:
    """What became of a command: status (minus a signal), printed text, bytes, seconds."""

    status: int
    text: str
    memory: int
    seconds: float
    is_late: bool


class BoundedRuns:
    """Starts the process from which the commands are forked; to be used with ``with``."""

    def __enter__(self):
        self._server = subprocess.Popen(
            [sys.executable, __file__],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"PYTHONPATH": str(ROOT), "NO_COLOR": "1", "COLUMNS": "400"},
        )
        return self

    def __exit__(self, *_):
        self._server.stdin.close()
        self._server.wait()
        self._server.stdout.close()

    def run(self, *arguments, seconds=60.0):
        """``reduction ARGUMENTS``, killed after so many seconds."""
        return self._asked({"arguments": [*map(str, arguments)]}, seconds)

    def read(self, path, layout, limits=None, seconds=60.0):
        """The layout of a log proposed, and the log read; both may be refused."""
        asked = {"path": str(path), "layout": layout, "limits": limits or {}}
        return self._asked(asked, seconds)

    def _asked(self, asked, seconds):
        self._server.stdin.write(json.dumps([asked, seconds]) + "\n")
        self._server.stdin.flush()
        return Bounded(**json.loads(self._server.stdout.readline()))


def _command(arguments):
    """What `python -m reduction` does, in this process."""
    from reduction.cli.main import app

    sys.argv = ["reduction", *arguments]
    app()


def _say(*words):
    sys.stdout.write(" ".join(words) + "\n")


def _read(path, layout, limits):
    """Propose a layout, then read; the status is that of the reading."""
    from reduction.errors import ReductionError
    from reduction.ingest.layout import Layout
    from reduction.ingest.read import read_log
    from reduction.ingest.sniff import sniff_layout
    from reduction.settings import Limits

    path = Path(path)
    try:
        proposed = sniff_layout(path)
        _say("sniffed:", ", ".join(proposed.keys))
    except ReductionError as error:
        _say(f"sniff refused ({error.exit_status}): {error}")
    try:
        log = read_log(path, Layout.model_validate(layout), name=path.name, limits=Limits(**limits))
    except ReductionError as error:
        _say(f"refused: {error}")
        sys.exit(error.exit_status)
    _say(f"read {log.n_rows_read} rows;", *log.notes)


def _forked(asked, seconds):
    """Fork, run, wait for the end or the deadline."""
    reading, writing = os.pipe()
    begin = time.monotonic()
    child = os.fork()
    if not child:
        os.dup2(writing, 1)
        os.dup2(writing, 2)
        os.close(reading)
        status = 1
        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
        resource.setrlimit(resource.RLIMIT_FSIZE, (MOST_ON_DISK, MOST_ON_DISK))
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 10, int(seconds) + 10))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        try:
            _command(**asked) if "arguments" in asked else _read(**asked)
            status = 0
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException:
            import traceback

            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(status)
    os.close(writing)
    os.set_blocking(reading, False)
    text, is_late = b"", False
    while True:
        try:
            text = (text + os.read(reading, SHARE))[:SHARE]
        except BlockingIOError:
            pass
        done, status, usage = os.wait4(child, os.WNOHANG)
        if done:
            break
        if time.monotonic() - begin > seconds and not is_late:
            os.kill(child, signal.SIGKILL)
            is_late = True
        time.sleep(0.005)
    while more := _rest(reading):
        text = (text + more)[:SHARE]
    os.close(reading)
    return Bounded(
        os.waitstatus_to_exitcode(status),
        text.decode(errors="replace"),
        usage.ru_maxrss * 1024,
        time.monotonic() - begin,
        is_late,
    )


def _rest(reading):
    try:
        return os.read(reading, SHARE)
    except BlockingIOError:
        return b""


def _serve():
    import reduction.batch.run
    import reduction.cli.main
    import reduction.ingest.read
    import reduction.ingest.sniff  # noqa: F401

    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        asked, seconds = json.loads(line)
        answers.write(json.dumps(_forked(asked, seconds).__dict__) + "\n")
        answers.flush()


if __name__ == "__main__":
    _serve()
