"""Changes, one after the other in a thread of their own, so that a long log does not hold a page.

A page asks for a change and is told within moments either what it gives or that it is still at
work, and on what.  A newer change ends an older one at the next stage.
"""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from queue import SimpleQueue
from typing import Any

from reduction.errors import ReductionError

__all__ = ["Job", "Superseded", "Work"]

Document = dict[str, Any]
Told = Callable[[str], None]
_MOST_KEPT = 8


class Superseded(Exception):  # noqa: N818 - it is an end of work, and no error
    """A newer change was asked for."""


@dataclass
class Job:
    """One change: how far it is, and what it gave; ``status`` is that of the answer."""

    number: int
    work: Callable[[Told], Document]
    begun: float = field(default_factory=time.monotonic)
    stage: str = "waiting"
    status: int = 200
    document: Document | None = None
    ended: threading.Event = field(default_factory=threading.Event)

    def answer(self) -> tuple[int, Mapping[str, Any]]:
        """What a page is told now."""
        if self.ended.is_set() and self.document is not None:
            return self.status, {"job": self.number, "state": "done", **self.document}
        seconds = time.monotonic() - self.begun
        told = {"job": self.number, "state": "running", "stage": self.stage, "seconds": seconds}
        return 202, told


class Work:
    """A thread that makes one change at a time.

    Parameters
    ----------
    told_of_defect : callable
        Told of what is a defect of this program, which a page is told of in one line.
    """

    def __init__(self, told_of_defect: Callable[[Exception], None]) -> None:
        self._told_of_defect = told_of_defect
        self._queue: SimpleQueue[Job | None] = SimpleQueue()
        self._jobs: OrderedDict[int, Job] = OrderedDict()
        self._lock = threading.Lock()
        self._newest = 0
        self._thread = threading.Thread(target=self._run, daemon=True, name="explore")
        self._thread.start()

    def start(self, work: Callable[[Told], Document]) -> Job:
        """Order work; older work that has not ended is given up."""
        with self._lock:
            self._newest += 1
            job = Job(self._newest, work)
            self._jobs[job.number] = job
            while len(self._jobs) > _MOST_KEPT:
                self._jobs.popitem(last=False)
        self._queue.put(job)
        return job

    def job(self, number: int) -> Job | None:
        """A job that is still known."""
        with self._lock:
            return self._jobs.get(number)

    def close(self) -> None:
        """End the thread; what it is at is given up at the next stage."""
        with self._lock:
            self._newest += 1
        self._queue.put(None)

    def _run(self) -> None:
        while (job := self._queue.get()) is not None:

            def told(stage: str, job: Job = job) -> None:
                if job.number < self._newest:
                    raise Superseded
                job.stage = stage

            try:
                told("begun")
                job.document = job.work(told)
            except Superseded:
                # not of interest any more, and no fault
                job.document = {"state": "superseded", "error": "a newer change was asked for"}
            except ReductionError as error:
                job.status, job.document = 422, {"error": str(error)}
            except Exception as error:
                # the page lives on, and the terminal says what happened
                self._told_of_defect(error)
                said = f"internal error, a defect of this program: {type(error).__name__}"
                job.status, job.document = 500, {"error": said}
            job.ended.set()
