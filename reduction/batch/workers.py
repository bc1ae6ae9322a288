"""Where the tests of a campaign are worked on: here, or on worker processes."""

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
"""How long a run waits for a test to end before it looks whether workers are left. [s]."""

_AGAIN = "Archives that were finished are kept; run again to go on."

_MEMORY = "Most often the memory did not suffice: take fewer workers, or workers with more memory."

# a worker may have several threads, and the netCDF library bears one
_AT_WORK = threading.Lock()

# whether this worker is to end once what it sends is sent
_TO_END = threading.Event()

_OF_MALLOC = {-3: 1 << 25, -1: 1 << 25, -2: 1 << 22}
"""Bytes from which memory is the system's again, M_MMAP_THRESHOLD and M_TRIM_THRESHOLD of the GNU C
library, and M_TOP_PAD, by which more is asked for."""

_SENT = 1.0  # s, after which what a worker sends is sent

_BEARS_A_FORK = {"jemalloc_bg_thd"}
"""Threads that look after themselves when a process is forked: the one of arrow's allocator."""


@dataclass(frozen=True)
class Task:
    """Arguments for the work on one test; of tests side by side the largest are begun first."""

    test: str
    arguments: tuple[Any, ...]
    size: int = 0


@dataclass(frozen=True)
class _Ended(Generic[Result]):
    """Work that ended: what it gave, or the error where no worker lived to tell."""

    test: str
    value: Result | None
    error: ReductionError | None = None
    worker: str = ""


@dataclass(frozen=True)
class Workers:
    """Processes that work on tests side by side.

    Parameters
    ----------
    executor : concurrent.futures.Executor
        Of any kind.
    end : callable
        Ends what they are doing, at once.
    look : callable
        Raises an error where nobody is left to wait for.
    deadly : tuple of type
        Errors that say that workers died at a test and live on for others.
    number : int
        How many there are, where that is known.
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
    open_tasks: dict[Future[tuple[Result, str]], str] = {}  # in the order in which they are begun
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
    """What a task gave; it is no longer among those that are open."""
    began = list(islice(open_tasks.values(), workers.number))
    test = open_tasks.pop(future)
    try:
        value, worker = future.result()
        return _Ended(test, value, worker=worker)
    except workers.deadly:
        died = WorkerError(
            "every worker that began this test died at it",
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
    except Exception as error:
        raise WorkerError(
            "a worker could not do what it was asked",
            found=f"{type(error).__name__}: {error}",
            needed=f"workers with reduction {__version__} and the packages of this environment",
        ) from error


def _died(open_tasks: list[str], workers: Workers) -> WorkerError:
    return WorkerError(
        "a worker process died",
        found=f"it at work on one of {', '.join(open_tasks[: workers.number])}",
        needed="workers that live as long as a test takes",
        hint=f"{_MEMORY} {_AGAIN}",
    )


def _scheduler_lost() -> WorkerError:
    """The error of a run whose scheduler answers no more."""
    return WorkerError("the scheduler was lost", hint=_AGAIN)


def _work(version: str, function: Callable[..., Result], *arguments: Any) -> tuple[Result, str]:
    """Do what a task asks for, on a worker."""
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
    """On a worker of Dask xarray would ask the scheduler for a lock at every variable."""
    dask = sys.modules.get("dask")
    return nullcontext() if dask is None else dask.config.set(scheduler="synchronous")


@contextmanager
def local_workers(number: int) -> Iterator[Workers]:
    """Start worker processes on this machine, and end them."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    threads = max(1, (available or 1) // number)
    pool = ProcessPoolExecutor(
        number, mp_context=multiprocessing.get_context(_way_to_start()), initializer=_begin,
        initargs=(threads, gc.get_threshold()),
    )  # fmt: skip
    try:
        _start(pool, number)
        yield Workers(pool, _end_children, number=number)
    except BaseException:
        _end_children()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def _way_to_start() -> str:
    """Fork where no other thread can hold a lock meanwhile, or begin with a new interpreter.

    Workers that are forked share the libraries of this process, 80 MB each, and need not load them.
    """
    own = str(threading.get_native_id())
    try:
        others = {
            Path(f"/proc/self/task/{one}/comm").read_text().strip()
            for one in os.listdir("/proc/self/task")
            if one != own
        }
    except OSError:  # of a system without it
        return "spawn"
    return "fork" if others <= _BEARS_A_FORK else "spawn"


def _start(pool: ProcessPoolExecutor, number: int) -> None:
    """Have all processes begin, so that it is known that they can."""
    gc.freeze()  # what is here is not looked through by those that are forked, and stays shared
    try:
        with _interrupts_later(), catch_warnings():
            simplefilter("ignore", DeprecationWarning)  # of forks beside any thread
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
    """Have the C library keep what arrays up to 32 MB leave free, and ask for 4 MB at a time.

    It comes to the first by itself, after arrays of that size; a test is made of thousands of
    smaller ones, which the system fills with zeros each time.
    """
    own = getattr(ctypes.CDLL(None), "mallopt", None) if os.name == "posix" else None
    if own is not None:
        for parameter, size in _OF_MALLOC.items():
            own(parameter, size)


def _begin(threads: int, threshold: tuple[int, int, int]) -> None:
    """Share the processors of the machine, before any library looks for them.

    Objects are looked through for circles as often as where the worker was started.
    """
    os.environ |= {"OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    gc.set_threshold(*threshold)
    keep_freed_memory()
    signal.signal(signal.SIGTERM, _end)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end(number: int, frame: FrameType | None) -> None:
    """End at once, but not in the middle of a message: whoever waits for the rest waits forever."""
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
    """Start processes that a Ctrl-C on the terminal passes by: this process ends them itself."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    ensure_running()  # a process of Python's own, whose start undoes the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
