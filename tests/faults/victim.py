"""A process that has imported everything and forks one that runs the command, again and again.

It reads a line of JSON for each: arguments, working folder, where what is said goes.  It answers
with the number of the process, and with how that ended.
"""

import json
import os
import signal
import sys
import traceback
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from types import SimpleNamespace


def _warm(arguments, folder):
    """All that is imported late, and what is kept between runs."""
    from reduction.cli.main import app

    os.chdir(folder)
    with (
        Path(os.devnull).open("w") as nowhere,
        redirect_stdout(nowhere),
        redirect_stderr(nowhere),
        suppress(SystemExit),
    ):
        app(arguments)


def _run(order):
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    said = os.open(order["said"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(said, 1)
    os.dup2(said, 2)
    os.chdir(order["folder"])
    status = 1
    try:
        from reduction.cli import campaigns as runs
        from reduction.cli.main import app

        # time that passed stands in status.csv
        runs.time = SimpleNamespace(perf_counter=lambda: 0.0)
        app(order["arguments"])
    except SystemExit as end:
        status = end.code or 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def main():
    """Serve orders until there are no more."""
    _warm(*json.loads(sys.stdin.readline()))
    print(json.dumps("ready"), flush=True)  # noqa: T201
    for line in sys.stdin:
        order = json.loads(line)
        child = os.fork()
        if not child:
            _run(order)
        print(json.dumps(child), flush=True)  # noqa: T201
        _, ended = os.waitpid(child, 0)
        print(json.dumps(os.waitstatus_to_exitcode(ended)), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
