"""Commands in a process of their own each, with a deadline and the memory and time they took.

The processes are forked from one that has loaded the package, which is quicker than a start, and
what they share with it counts as theirs: the memory is what a user would see.
"""

import gc
import importlib
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHARE = 5_000_000  # bytes of what was printed that are kept
# what most commands load
LOADED = (
    "reduction.cli.main", "reduction.cli.campaigns", "reduction.cli.remote_paths", "reduction.campaign.load",
    "reduction.batch.run_campaign",
    "reduction.report.campaign_page", "reduction.archive.csv_tables", "reduction.readers.sniff",
    "reduction.lines.line_lookup", "reduction.pages.design_values",
)  # fmt: skip
WIDE = {"NO_COLOR": "1", "COLUMNS": "400"}
MOST_MEMORY = 8_000_000_000  # of one command, that a fault does no harm to the machine
MOST_ON_DISK = 2_000_000_000


@dataclass(frozen=True)
class Bounded:
    """What became of a command: status (minus a signal), what it printed, bytes, seconds."""

    status: int
    out: str
    errors: str
    memory: int
    seconds: float
    is_late: bool

    @property
    def text(self):
        """All that was printed."""
        return self.out + self.errors


class BoundedRuns:
    """Starts the process from which the commands are forked; to be used with ``with``."""

    def __enter__(self):
        self._server = subprocess.Popen(
            [sys.executable, __file__],
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
        )
        return self

    def __exit__(self, *_):
        self._server.stdin.close()
        self._server.wait()
        self._server.stdout.close()

    def run(
        self, *arguments, seconds=60.0, cwd=ROOT, environment=WIDE, is_bounded=True, terminal=None
    ):
        """``reduction ARGUMENTS``, killed after so many seconds.

        ``environment`` is added to that of this process, but for what is None there, which is taken
        away; memory and disk are not bounded where ``is_bounded`` is false; what is printed goes to
        ``terminal``, a path, where there is one.
        """
        asked = {
            "arguments": [*map(str, arguments)],
            "is_bounded": is_bounded,
            "terminal": terminal,
        }
        plain = {
            name: text for name, text in (os.environ | environment).items() if text is not None
        }
        return self._asked(asked, seconds, str(cwd), plain)

    def read(self, path, layout, limits=None, seconds=60.0):
        """The layout of a log proposed, and the log read; both may be refused."""
        asked = {"path": str(path), "layout": layout, "limits": limits or {}}
        return self._asked(asked, seconds, str(ROOT), os.environ | WIDE)

    def _asked(self, asked, seconds, cwd, environment):
        self._server.stdin.write(json.dumps([asked, seconds, cwd, dict(environment)]) + "\n")
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
    from reduction.readers.layout import Layout
    from reduction.readers.read_log import read_log
    from reduction.readers.sniff import sniff_layout
    from reduction.record.errors import ReductionError
    from reduction.record.settings import Limits

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
    loads = sum(log.columns["tension.1"][:30])  # as many rows as every good file has
    _say(f"read {log.n_rows_read} rows, loads {loads:g};", *map(str, log.notes))


def _forked(asked, seconds, cwd, environment):
    """Fork, run, wait for the end or the deadline."""
    is_bounded, terminal = asked.pop("is_bounded", True), asked.pop("terminal", None)
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
        begin, is_late = time.monotonic(), False
        child = os.fork()
        if not child:
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            os.dup2(out.fileno(), 1)
            os.dup2(errors.fileno(), 2)
            if terminal:
                for place in (1, 2):
                    os.dup2(os.open(terminal, os.O_WRONLY | os.O_NOCTTY), place)
            if is_bounded:
                _bound(seconds)
            _child(asked, cwd, environment)
        while not (ended := os.wait4(child, os.WNOHANG))[0]:
            if time.monotonic() - begin > seconds and not is_late:
                os.kill(child, signal.SIGKILL)
                is_late = True
            time.sleep(0.005)
        _, status, usage = ended
        return Bounded(
            os.waitstatus_to_exitcode(status), _printed(out), _printed(errors),
            usage.ru_maxrss * 1024, time.monotonic() - begin, is_late,
        )  # fmt: skip


def _bound(seconds):
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (MOST_ON_DISK, MOST_ON_DISK))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 10, int(seconds) + 10))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


def _child(asked, cwd, environment):
    """What the forked process does; it does not come back."""
    status = 1
    try:
        os.chdir(cwd)
        os.environ.clear()
        os.environ.update(environment)
        time.tzset()
        _command(**asked) if "arguments" in asked else _read(**asked)
        status = 0
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        if "reduction.readers.bounded_reader" in sys.modules:
            sys.modules["reduction.readers.bounded_reader"]._end_reader()  # its memory counts too
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _printed(file):
    file.seek(0)
    return file.read(SHARE).decode(errors="replace")


def _serve():
    for name in LOADED:
        importlib.import_module(name)
    gc.freeze()  # no command looks through what was loaded before it
    os.fsync = os.fstat  # as in conftest.py: no command waits for the disk

    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        answers.write(json.dumps(_forked(*json.loads(line)).__dict__) + "\n")
        answers.flush()


if __name__ == "__main__":
    _serve()
