"""Archives held against CF by tests/compliance.py, which a process of the tests loads once."""

import atexit
import json
import subprocess
import sys
from functools import cache
from pathlib import Path


@cache
def _loaded():
    """The process from which each check is forked; it ends with that of the tests."""
    server = subprocess.Popen(
        [sys.executable, Path(__file__).with_name("compliance.py"), "--serve"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    atexit.register(_end, server)
    return server


def _end(server):
    server.stdin.close()
    server.wait()
    server.stdout.close()


def held_against_cf(*paths):
    """Status and words of the checker; status 0 says that nothing was found."""
    server = _loaded()
    server.stdin.write(json.dumps([str(path) for path in paths]) + "\n")
    server.stdin.flush()
    status, told = json.loads(server.stdout.readline())
    return subprocess.CompletedProcess(paths, status, told)


def hold_against_cf(path):
    """An archive keeps every rule of the schema and of CF."""
    done = held_against_cf(path)
    assert done.returncode == 0, done.stdout
    assert "All tests passed!" in done.stdout
