"""Readers that break in the ways in which a library does at a file from a stranger."""

import ctypes
import os
import signal
from pathlib import Path

import numpy as np

from reduction.record.samples import ColumnWriter


def crash(path, *_, watch, **named):
    """A fault of memory."""
    os.kill(os.getpid(), signal.SIGSEGV)


def give_up(path, *_, watch, **named):
    """What a library of Rust does without memory, with words on the standard error."""
    os.write(2, b"memory allocation failed\n")
    os.abort()


def leave(path, *_, watch, **named):
    os._exit(0)


def panic(path, *_, watch, **named):
    """An end that no ``except Exception`` catches."""
    raise BaseException("a check of the library failed")


def hang(path, *_, watch, **named):
    """A call that does not come back, and lets no other thread of Python run meanwhile."""
    ctypes.PyDLL(None).sleep(1000)


def swallow(path, *_, watch, **named):
    """Three gigabytes, touched."""
    return np.ones(375_000_000)


def stumble(path, *_, watch, **named):
    """A fault of this package."""
    raise KeyError("no such key")


def chatter(path, *_, watch, **named):
    """A library that prints."""
    os.write(1, b"loading ...\n")
    os.write(2, b"warning!\n")
    return "read"


def crash_with_columns_on_disk(path, *_, parts, watch):
    column = ColumnWriter(parts.folder)
    column.append(np.ones(1000))
    assert len(list(Path(parts.folder).iterdir())) == 1
    crash(path, watch=watch)


def whereabouts(path, *_, watch):
    return path.resolve(), os.getpid()
