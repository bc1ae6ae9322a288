"""Runs the tests of a campaign in this process or on worker processes."""

from __future__ import annotations

import ctypes
import gc
import multiprocessing
import os
import platform
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from itertools import islice
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from queue import Empty, SimpleQueue
from types import FrameType
from typing import Any, Generic, TypeVar
from warnings import catch_warnings, simplefilter

from reduction import __version__
from reduction.record.errors import ReductionError, SettingsError, WorkerError

Result = TypeVar("Result")

PATIENCE = 60.0
"""Time to wait for a test to end before checking that workers remain. [s]."""

_AGAIN = "Archives that were finished are kept; run again to continue."

_MEMORY = "The usual cause is too little memory: use fewer workers, or workers with more memory."

# a worker may have several threads, but the netCDF library supports one
_AT_WORK = threading.Lock()

# whether this worker should end after it has sent its message
_TO_END = threading.Event()

_OF_MALLOC = {-3: 1 << 25, -1: 1 << 25, -2: 1 << 22}
"""Bytes for M_MMAP_THRESHOLD and M_TRIM_THRESHOLD of the GNU C library, above which memory is
returned to the system, and for M_TOP_PAD, the additional amount requested.
"""

_SENT = 1.0  # s, by which time a worker's message has been sent

_BEARS_A_FORK = {"jemalloc_bg_thd"}
"""Threads that handle a fork of the process themselves: that of arrow's allocator."""


@dataclass(frozen=True)
class Task:
    """Arguments for the work on one test; in parallel, the largest tests start first."""

    test: str
    arguments: tuple[Any, ...]
    size: int = 0


@dataclass(frozen=True)
class _Ended(Generic[Result]):
    """Finished work: its result, or the error if the worker died."""

    test: str
    value: Result | None
    error: ReductionError | None = None
    worker: str = ""


@dataclass(frozen=True)
class Workers:
    """Processes that work on tests in parallel.

    Parameters
    ----------
    executor : concurrent.futures.Executor
        Executor of any kind.
    end : callable
        Ends their current work at once.
    look : callable
        Raises an error if no worker is left.
    deadly : tuple of type
        Errors that mean that workers died during a test, while others continue.
    number : int
        Number of workers, if known.
    """

    executor: Executor
    end: Callable[[], None]
    look: Callable[[], None] = lambda: None
    deadly: tuple[type[Exception], ...] = ()
    number: int = 1


def work_on(
    function: Callable[..., Result],
    tasks: Iterable[Task],
    *,
    workers: Workers | None,
    begun: Callable[[str], None] = lambda test: None,
) -> Iterator[_Ended[Result]]:
    """Call a function for each task."""
    if workers is None:
        for task in tasks:
            begun(task.test)
            yield _Ended(task.test, function(*task.arguments))
        return
    done: SimpleQueue[Future[tuple[Result, str]]] = SimpleQueue()
    open_tasks: dict[Future[tuple[Result, str]], str] = {}  # in the order of their start
    for task in sorted(tasks, key=lambda task: -task.size):
        try:
            future = workers.executor.submit(_work, __version__, function, *task.arguments)
        except BrokenExecutor:
            raise _died([*open_tasks.values(), task.test], workers) from None
        open_tasks[future] = task.test
        future.add_done_callback(done.put)
    while open_tasks:
        try:
            future = done.get(timeout=PATIENCE)
        except Empty:
            workers.look()
            continue
        yield _ended(future, open_tasks, workers)


def _ended(
    future: Future[tuple[Result, str]],
    open_tasks: dict[Future[tuple[Result, str]], str],
    workers: Workers,
) -> _Ended[Result]:
    """Result of a task, which is removed from the open ones."""
    began = list(islice(open_tasks.values(), workers.number))
    test = open_tasks.pop(future)
    try:
        value, worker = future.result()
        return _Ended(test, value, worker=worker)
    except workers.deadly:
        died = WorkerError(
            "every worker that began this test died",
            found="more of them lost than the scheduler allows",
            needed="workers that live as long as a test takes",
            hint=_MEMORY,
        )
        return _Ended(test, None, died)
    except BrokenExecutor:
        raise _died(began, workers) from None
    except CancelledError:
        raise _scheduler_lost() from None
    except ReductionError:
        raise
    except Exception as error:  # those of a test are results: this one is of the worker itself
        raise WorkerError(
            "a worker could not do what it was asked",
            found=f"{type(error).__name__}: {error}",
            needed=f"workers with reduction {__version__} and the packages of this environment",
        ) from error


def _died(open_tasks: list[str], workers: Workers) -> WorkerError:
    return WorkerError(
        "a worker process died",
        found=f"it working on one of {', '.join(open_tasks[: workers.number])}",
        needed="workers that live as long as a test takes",
        hint=f"{_MEMORY} {_AGAIN}",
    )


def _scheduler_lost() -> WorkerError:
    """Error for a scheduler that no longer responds."""
    return WorkerError("the scheduler was lost", hint=_AGAIN)


def _work(version: str, function: Callable[..., Result], *arguments: Any) -> tuple[Result, str]:
    """Perform a task on a worker."""
    worker = f"{platform.node()}:{os.getpid()}"
    if version != __version__:
        raise SettingsError(
            f"the worker {worker} has another version of reduction",
            found=__version__,
            needed=version,
        )
    with _AT_WORK, _alone():
        if _TO_END.is_set():
            os._exit(1)
        return function(*arguments), worker


def _alone() -> AbstractContextManager[object]:
    """Avoid xarray's request to the Dask scheduler for a lock at every variable."""
    dask = sys.modules.get("dask")
    return nullcontext() if dask is None else dask.config.set(scheduler="synchronous")


@contextmanager
def local_workers(number: int) -> Iterator[Workers]:
    """Start worker processes on this machine, and stop them afterwards."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    threads = max(1, (available or 1) // number)
    pool = ProcessPoolExecutor(
        number, mp_context=multiprocessing.get_context(_way_to_start()), initializer=_begin,
        initargs=(threads, gc.get_threshold()),
    )  # fmt: skip
    try:
        _start(pool, number)
        yield Workers(pool, _end_children, number=number)
    except BaseException:  # an interrupt too: children would outlive the run
        _end_children()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _way_to_start() -> str:
    """Fork if no other thread can hold a lock meanwhile, otherwise start a new interpreter.

    Forked workers share the libraries of this process, 80 MB each, and need not load them.
    """
    own = str(threading.get_native_id())
    try:
        others = {
            Path(f"/proc/self/task/{one}/comm").read_text().strip()
            for one in os.listdir("/proc/self/task")
            if one != own
        }
    except OSError:  # a system without it
        return "spawn"
    return "fork" if others <= _BEARS_A_FORK else "spawn"


def _start(pool: ProcessPoolExecutor, number: int) -> None:
    """Start all processes, to make sure that they can run."""
    gc.freeze()  # forked processes do not scan existing objects, which therefore stay shared
    try:
        with _interrupts_later(), catch_warnings():
            simplefilter("ignore", DeprecationWarning)  # of forks while any thread runs
            started = [pool.submit(os.getpid) for _ in range(number)]
        for one in started:
            one.result()
    except (OSError, BrokenExecutor) as error:
        raise WorkerError(
            "worker processes cannot be started on this machine",
            found=f"{type(error).__name__}: {error}",
            hint="Run with --jobs 1, which needs none.",
        ) from error
    finally:
        gc.unfreeze()


def keep_freed_memory() -> None:
    """Make the C library keep freed memory of arrays up to 32 MB, and request 4 MB at a time.

    It does the former by itself after arrays of that size, but a test is made of thousands of
    smaller ones, which the system would fill with zeros each time.
    """
    own = getattr(ctypes.CDLL(None), "mallopt", None) if os.name == "posix" else None
    if own is not None:
        for parameter, size in _OF_MALLOC.items():
            own(parameter, size)


def _begin(threads: int, threshold: tuple[int, int, int]) -> None:
    """Divide the processors of the machine before any library counts them.

    Garbage collection has the same thresholds as in the parent process.
    """
    os.environ |= {"OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    gc.set_threshold(*threshold)
    keep_freed_memory()
    signal.signal(signal.SIGTERM, _end)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end(number: int, frame: FrameType | None) -> None:
    """End at once, but not within a message, whose receiver would wait forever."""
    if _AT_WORK.locked():
        os._exit(1)
    _TO_END.set()
    threading.Timer(_SENT, os._exit, (1,)).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _end_children() -> None:
    children = multiprocessing.active_children()
    for child in children:
        child.terminate()
    for child in children:
        child.join()


@contextmanager
def _interrupts_later() -> Iterator[None]:
    """Start processes that ignore Ctrl-C on the terminal: this process ends them itself."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    ensure_running()  # a helper process of Python, whose start would undo the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
