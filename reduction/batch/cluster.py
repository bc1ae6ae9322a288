"""The tests of a campaign on the worker processes of Dask."""

from __future__ import annotations

import pickle
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from queue import Empty, SimpleQueue
from threading import Lock
from typing import Any, Generic, TypeVar

import dask
from distributed import Client, Future, KilledWorker, get_worker

from reduction import __version__
from reduction.batch.executor import Ended, Task
from reduction.errors import ReductionError, SettingsError, WorkerError

__all__ = ["DEATHS", "PATIENCE", "Cluster", "scheduler_lost"]

Result = TypeVar("Result")

PATIENCE = 60.0
"""How long a run waits for the first worker, and for one after the last was lost. [s]."""
_LOOK = 1.0  # between two looks at whether scheduler and workers are there [s]
_FIRST = 1 << 62  # priority of what takes no time
DEATHS = 1
"""Of workers at a test, after which it is tried by itself. [1]."""


# a worker may have several threads, and the netCDF library bears one
_AT_WORK = Lock()


class _Told(Generic[Result]):
    """What a function gave, and which worker was asked."""

    def __init__(self, value: Result, worker: str) -> None:
        self.value = value
        self.worker = worker


class _Sent(Generic[Result]):
    """Work that was sent to the scheduler, and how it was asked for."""

    def __init__(self, order: Callable[[], Future[_Told[Result]]], test: str) -> None:
        self.test = test
        self.order: Callable[[], Future[_Told[Result]]] | None = order
        self.future = order()
        self.takes: tuple[_Sent[Any], ...] = ()

    def result(self) -> Result:
        return self.future.result().value

    def again(self) -> None:
        """Send it anew, with what it takes where that failed too."""
        for one in self.takes:
            if one.future.status != "finished":
                one.again()
        if self.order is not None:
            self.future = self.order()

    def let_go(self) -> None:
        """Forget how it was asked for, and with it what the scheduler keeps for that."""
        self.order, self.takes = None, ()


class Cluster:
    """Workers behind a scheduler of Dask; one test is at one worker at a time."""

    is_elsewhere = True

    def __init__(self, client: Client) -> None:
        self.begun: Callable[[str], None] = lambda test: None
        self._client = client
        self._run = uuid.uuid4().hex
        self._number = 0
        client.subscribe_topic(self._run, lambda event: self.begun(event[1]))

    def send(self, value: Result) -> Task[Result]:
        """Send a value once; a worker that is lost with it loses nothing."""
        # a task and not a scattered value, which nobody could make again
        return self.start(pickle.loads, pickle.dumps(value), stage="", test="")

    def start(
        self, function: Callable[..., Result], *arguments: Any, stage: str, test: str, size: int = 0
    ) -> Task[Result]:
        """Order a function of arguments at once; those without a stage come before others."""

        def order() -> Future[_Told[Result]]:
            self._number += 1
            given = [one.future if isinstance(one, _Sent) else one for one in arguments]
            return self._client.submit(
                _work, __version__, self._run if stage else "", test, function, *given,
                key=f"{stage or 'small'}-{self._run}-{self._number}", pure=False,
                priority=size if stage else _FIRST,
            )  # fmt: skip

        sent = _Sent(order, test)
        sent.takes = tuple(one for one in arguments if isinstance(one, _Sent))
        return sent

    def ended(self, tasks: Iterable[Task[Result]]) -> Iterator[Ended[Result]]:
        """Give what the tasks gave, as they end; those at which workers died come last."""
        deadly: list[_Sent[Result]] = []
        for task in self._as_they_end(tasks):
            outcome = self._outcome(task)
            if isinstance(outcome, KilledWorker):
                deadly.append(task)
            else:
                yield _ended(task, outcome)
        for task in deadly:
            # by itself: it may only have been beside another at which they died
            task.again()
            for one in self._as_they_end([task]):
                yield _ended(one, self._outcome(one))

    def _outcome(self, task: _Sent[Result]) -> _Told[Result] | BaseException:
        """Give a result, or what came instead; what was lost with its worker is waited for again.

        A worker may die with results that ended and were not fetched yet. The scheduler has them
        made once more, so that a task that had ended has not, at any line of this method.
        """
        last_seen = time.monotonic()
        on_its_way = _LOOK
        while True:
            try:
                error = task.future.exception(timeout=_LOOK)
                if error is not None:
                    return _in_words(error)
                return task.future.result(timeout=on_its_way)
            except TimeoutError:
                last_seen = self._look(last_seen)
                if task.future.status == "finished":
                    on_its_way *= 2  # a result that is fetched again begins at its first byte
            except Exception as gone:
                if task.future.status == "error":
                    continue
                if isinstance(gone, (OSError, CancelledError)):
                    return scheduler_lost()
                raise

    def _as_they_end(self, tasks: Iterable[Task[Result]]) -> Iterator[_Sent[Result]]:
        ended: SimpleQueue[_Sent[Result]] = SimpleQueue()
        open_tasks = 0
        for task in tasks:
            if isinstance(task, _Sent):
                task.future.add_done_callback(lambda _, one=task: ended.put(one))
                open_tasks += 1
        last_seen = time.monotonic()
        while open_tasks:
            try:
                task = ended.get(timeout=_LOOK)
            except Empty:
                last_seen = self._look(last_seen)
                continue
            open_tasks -= 1
            last_seen = time.monotonic()
            yield task

    def _look(self, last_seen: float) -> float:
        """Refuse to wait for workers that do not come."""
        if self._client.status != "running":
            raise scheduler_lost()
        try:
            if self._client.nthreads():
                return time.monotonic()
        except OSError as gone:  # the client does not know it yet
            raise scheduler_lost() from gone
        if time.monotonic() - last_seen > PATIENCE:
            raise WorkerError(
                "no worker is left",
                found=f"none for {PATIENCE:.0f} s",
                needed="a worker at the scheduler",
                hint="Products that were finished are kept; start workers, and run again to go on.",
            )
        return last_seen


def _ended(task: _Sent[Result], outcome: _Told[Result] | BaseException) -> Ended[Result]:
    task.let_go()
    if isinstance(outcome, _Told):
        return Ended(task.test, outcome.value, worker=outcome.worker)
    if not isinstance(outcome, KilledWorker):
        raise outcome
    died = WorkerError(
        "every worker that began this test died at it",
        found=f"{DEATHS + 1} workers or more lost, also with no other test beside it",
        needed="workers that live as long as a test takes",
        hint="Most often the memory did not suffice: take fewer workers (--jobs), or workers "
        "with more memory.",
    )
    return Ended(task.test, None, died)


def _in_words(error: BaseException) -> BaseException:
    if isinstance(error, (ReductionError, KilledWorker)):
        return error
    return WorkerError(
        "a worker could not do what it was asked",
        found=f"{type(error).__name__}: {error}",
        needed=f"workers with reduction {__version__} and the packages of this environment",
    )


def _work(
    version: str, topic: str, test: str, function: Callable[..., Result], *given: Any
) -> _Told[Result]:
    """Do what a task asks for, on a worker."""
    worker = get_worker()
    if version != __version__:
        raise SettingsError(
            f"the worker {worker.address} has another version of reduction",
            found=__version__,
            needed=version,
        )
    known = [one.value if isinstance(one, _Told) else one for one in given]
    if not topic:
        return _Told(function(*known), worker.address)
    # xarray asks the scheduler for a lock at every variable where it finds itself on a worker;
    # the file is this task's alone
    with _AT_WORK, dask.config.set(scheduler="synchronous"):
        worker.log_event(topic, test)
        return _Told(function(*known), worker.address)


def scheduler_lost() -> WorkerError:
    """The error of a run whose scheduler answers no more."""
    return WorkerError(
        "the scheduler was lost",
        hint="Products that were finished are kept; start it anew, and run again to go on.",
    )
