"""Where the work on the tests of a campaign is done: here, or on several workers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from reduction.errors import ReductionError

__all__ = ["Ended", "Executor", "Serial", "Task"]

Result = TypeVar("Result")
Given = TypeVar("Given", covariant=True)


class Task(Protocol[Given]):
    """Work that is to be done once, and whose result other work may take as an argument."""

    @property
    def test(self) -> str:
        """Test that it belongs to."""
        ...

    def result(self) -> Given:
        """What it gave; waits for it."""
        ...


@dataclass(frozen=True)
class Ended(Generic[Result]):
    """Work that ended: what it gave, or the error where no worker lived to tell.

    ``worker`` names who did it where there are several.
    """

    test: str
    value: Result | None
    error: ReductionError | None = None
    worker: str = ""


class Executor(Protocol):
    """One that works on the tests, each by itself.

    ``begun`` is called with the id of a test as work on it begins; ``is_elsewhere`` says whether
    it is done in other processes.
    """

    is_elsewhere: bool
    begun: Callable[[str], None]

    def send(self, value: Result) -> Task[Result]:
        """Send a value that many tasks take, once."""
        ...

    def start(
        self, function: Callable[..., Result], *arguments: Any, stage: str, test: str, size: int = 0
    ) -> Task[Result]:
        """Order a function of arguments; one that is a task stands for what the task gives.

        Of work that is done side by side, that of the largest size is begun first.
        """
        ...

    def ended(self, tasks: Iterable[Task[Result]]) -> Iterator[Ended[Result]]:
        """Give what the tasks gave, as they end."""
        ...


class _Later(Generic[Result]):
    """Work that is done in this process when its result is asked for."""

    def __init__(self, work: Callable[[], Result], test: str) -> None:
        self.test = test
        self._work: Callable[[], Result] | None = work
        self._value: Result | None = None

    def result(self) -> Result:
        if self._work is not None:
            self._value = self._work()
            # what it was made from is let go: a record among it may be large
            self._work = None
        return self._value  # type: ignore[return-value]  # None only where Result is


class Serial:
    """One test after another, in this process and in the order in which they are given."""

    is_elsewhere = False

    def __init__(self) -> None:
        self.begun: Callable[[str], None] = lambda test: None

    def send(self, value: Result) -> Task[Result]:
        """Keep the value."""
        return _Later(lambda: value, "")

    def start(
        self, function: Callable[..., Result], *arguments: Any, stage: str, test: str, size: int = 0
    ) -> Task[Result]:
        """Keep the order until its result is asked for; a stage without a name is not told of."""

        def work() -> Result:
            known = [one.result() if isinstance(one, _Later) else one for one in arguments]
            if stage:
                self.begun(test)
            return function(*known)

        return _Later(work, test)

    def ended(self, tasks: Iterable[Task[Result]]) -> Iterator[Ended[Result]]:
        """Do the tasks in their order."""
        for task in tasks:
            yield Ended(task.test, task.result())
