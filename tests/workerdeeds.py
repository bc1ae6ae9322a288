"""What tests have worker processes do: a process that is started anew imports it from here."""

import os
import signal
import time


def double(value):
    return 2 * value


def add_a_line(path, text):
    with path.open("a") as file:
        file.write(f"{text}\n")
    time.sleep(0.05)


def raise_data_error(value):
    from reduction.record.errors import DataError

    raise DataError("no sense in it", found=value, file="a.csv", row=3, channel="load")


def variables():
    return {name: os.environ.get(name) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}


def die_slowly(value):
    """Is killed as by the system when memory ends; others are at work and done."""
    time.sleep(0.5)
    if value is None:
        os.kill(os.getpid(), signal.SIGKILL)
    return value


def refuse_to_begin(threads):
    raise OSError(f"no room for {threads} threads")


def say_and_wait(folder):
    """Leave one's number in a folder, and be at work until somebody ends it."""
    (folder / str(os.getpid())).touch()
    time.sleep(600)
