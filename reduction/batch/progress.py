"""What a campaign says of itself while it runs."""

from __future__ import annotations

from typing import Protocol

from reduction.batch.status import TestStatus


class Progress(Protocol):
    """One who is told how far a campaign is."""

    def stage(self, name: str, n_tests: int) -> None:
        """A stage begins that works on so many tests; none for tables and report."""
        ...

    def begun(self, test: str) -> None:
        """Work on a test began in this process."""
        ...

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Work on a test ended in this stage; with its status where nothing more comes."""
        ...


class Silent:
    """Nobody listens."""

    def stage(self, name: str, n_tests: int) -> None:
        """Nothing."""

    def begun(self, test: str) -> None:
        """Nothing."""

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Nothing."""
