"""Reads binary files in a separate process with a limit on memory and time.

The reading libraries trust the sizes that a file states.  If that exceeds the memory or time limit
of a log, or ends the process, only the reader process is lost, not the run. One process is kept for
all files, because its start takes a second; after a failure the next file gets a new one.  It is
started anew, not forked: a fork of a process with threads may hang.
"""

from __future__ import annotations

import atexit
import faulthandler
import os
import pickle
import secrets
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from reduction.readers.layout import LogParts, Watch
from reduction.record.errors import ReductionError
from reduction.record.samples import mapped, name_of_scratch_file, name_scratch_files

if sys.platform == "linux":
    import resource

Result = TypeVar("Result")

_ROOM = 300_000_000  # bytes beyond unpacked_size: new columns, libraries at first use

_GRACE = 1.0  # s, in which a reader can report between two blocks that its time is over

# library threads take memory, and arrow reserves pools in steps of a gigabyte
_ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1", "ARROW_DEFAULT_MEMORY_POOL": "system"}

_AT_WORK = threading.Lock()


class _Reader:
    """The reader process and the two pipes to it."""

    def __init__(self) -> None:
        code = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import serve; serve()"
        self.process = subprocess.Popen(  # noqa: S603  # this interpreter and this package
            [sys.executable, "-P", "-c", code],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=os.environ | _ENVIRONMENT,
        )
        self.pipes = cast("tuple[IO[bytes], IO[bytes]]", (self.process.stdin, self.process.stdout))
        self.parent = os.getpid()

    def is_ready(self) -> bool:
        """Whether it is running and this process is not a fork of its parent."""
        return self.parent == os.getpid() and self.process.poll() is None

    def ask(self, request: bytes) -> tuple[Any, Exception | None]:
        """Value or error; `EOFError` if the process ended without an answer."""
        requests, answers = self.pipes
        try:
            requests.write(request)
            requests.flush()
            found: tuple[Any, Exception | None] = pickle.load(answers)  # noqa: S301  # of this package
        except (BrokenPipeError, pickle.UnpicklingError) as error:
            raise EOFError from error
        return found

    def end(self) -> None:
        self.process.kill()
        for stream in self.pipes:
            with suppress(OSError):  # what is left in a broken pipe
                stream.close()
        self.process.wait()


_reader: _Reader | None = None


@atexit.register
def _end_reader() -> None:
    """Stop the reader process, if any; the next file starts another."""
    global _reader
    if _reader is not None and _reader.parent == os.getpid():
        _reader.end()
    _reader = None


def bounded(
    function: Callable[..., Result], path: Path, *given: Any, watch: Watch, **named: Any
) -> Result:
    """Call a function in the reader process and return its result."""
    global _reader
    scratch = (
        named.get("parts", LogParts()).folder,
        f"reduction-{os.getpid()}-{secrets.token_hex(8)}-",
    )
    work = pickle.dumps((function, path, given, named))
    request = pickle.dumps((os.getcwd(), scratch, watch.limits, path, work))
    with _AT_WORK:
        if _reader is None or not _reader.is_ready():
            _reader = _Reader()
        begin = time.monotonic()
        try:
            value, error = _reader.ask(request)
        except EOFError:
            status = _reader.process.wait()
            _end_reader()
            seconds = time.monotonic() - begin
            if status == 1 and seconds > watch.limits.time:
                raise watch.too_slow(seconds) from None
            raise watch.broken(_how_it_ended(status)) from None
        except BaseException:  # a late answer would be taken for that of another request
            _end_reader()
            raise
        finally:
            _remove(*scratch)
        if isinstance(error, MemoryError):
            _end_reader()
            raise watch.too_much_memory()
    if error is not None:
        raise error
    result: Result = value
    return result


def _how_it_ended(status: int) -> str:
    if status < 0:
        with suppress(ValueError):  # a signal without a name
            return f"an end by {signal.Signals(-status).name}"
    return f"an end with status {status}"


def _taken_over(name: str, folder: Path, dtype: np.dtype[Any]) -> NDArray[Any]:
    """A column that the reader process has written to disk."""
    with open(name, "r+b") as file:
        return mapped(file, os.fstat(file.fileno()).st_size, folder, dtype)


def _remove(folder: Path, prefix: str) -> None:
    """Remove the names of scratch files; opened ones last as long as their arrays."""
    for left in folder.glob(f"{prefix}*"):
        with suppress(OSError):  # some systems keep the name of a mapped file
            left.unlink()


# the code below runs in the reader process


class _Answer(pickle.Pickler):
    """Pickles columns on disk as the names of their files."""

    def reducer_override(self, given: Any) -> Any:
        """Rebuild arrays on disk from their file name; others as usual."""
        place = name_of_scratch_file(given) if isinstance(given, np.ndarray) else None
        return NotImplemented if place is None else (_taken_over, (*place, given.dtype))


def serve() -> None:
    """Answer requests until the pipe closes."""
    requests, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    silence = os.open(os.devnull, os.O_RDWR)
    os.dup2(silence, 0)
    os.dup2(silence, 1)  # for libraries that print
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # left to the run, which ends this process
    if sys.platform == "linux":
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    while _is_answered(requests, answers, silence):
        pass


def _is_answered(requests: IO[bytes], answers: IO[bytes], silence: int) -> bool:
    """Answer one request; False if there is none."""
    try:
        folder, scratch, limits, path, work = pickle.load(requests)  # noqa: S301  # of the run
    except EOFError:
        return False
    with suppress(OSError):  # a folder that is gone matters to relative paths alone
        os.chdir(folder)
    name_scratch_files(scratch[1])
    answer: tuple[Any, Exception | None]
    watch = Watch(path, limits)
    try:
        function, path, given, named = pickle.loads(work)  # noqa: S301  # of the run
        # a library call that never returns is ended, even if the run is gone
        faulthandler.dump_traceback_later(limits.time + _GRACE, exit=True, file=silence)
        _bound_memory(limits.unpacked_size)
        watch = Watch(path, limits)  # loading time before this does not count
        answer = function(path, *given, watch=watch, **named), None
    except Exception as error:  # the run raises it
        answer = None, _portable_error(error)
    except BaseException as error:  # a failed check in a Rust library
        answer = None, watch.broken(f"{type(error).__name__}: {error}"[:200])
    try:
        _Answer(answers, protocol=5).dump(answer)
        answers.flush()
    except BrokenPipeError:  # the run was killed
        _remove(*scratch)
        return False
    faulthandler.cancel_dump_traceback_later()
    return True


def _bound_memory(n_bytes: int) -> None:
    """Limit the memory growth of this process; mapped files do not count."""
    if sys.platform == "linux":
        pages = int(Path("/proc/self/statm").read_text().split()[5])
        most = pages * resource.getpagesize() + _ROOM + n_bytes
        hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
        resource.setrlimit(
            resource.RLIMIT_DATA,
            (most if hard == resource.RLIM_INFINITY else min(most, hard), hard),
        )


def _portable_error(error: Exception) -> Exception:
    """The error in a form to send to the run, with its location if it is a bug of this package."""
    place = "".join(traceback.format_exception(error))
    error.__cause__ = error.__context__ = None  # library errors, few of which can be pickled
    error = error.with_traceback(None)
    if isinstance(error, (ReductionError, MemoryError)):
        return error
    try:
        made: Exception = pickle.loads(pickle.dumps(error))  # noqa: S301  # made here
    except Exception:  # of any library, whose class may fail in any way
        made = RuntimeError(f"{type(error).__name__}: {error}")
    made.add_note(place)
    return made
