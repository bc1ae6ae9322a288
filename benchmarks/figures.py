"""What a benchmark hands on to `suite.py` beside what it prints.

A script ends with ``hand_on(main(...))``, where ``main`` prints as ever and returns its figures.
They go as JSON to the file that the environment names in BENCHMARK_FIGURES, or nowhere.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any, Literal

__all__ = ["TARGET", "Figure", "figures_in", "hand_on"]

TARGET = "BENCHMARK_FIGURES"


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One line of the table.

    ``values`` are of single runs, in ``unit``; ``ratios`` are of single runs too, and ``against``
    says of what, in the same run.  ``at_least`` and ``at_most`` are what is wanted of the median
    ``of``.  A line without either says in ``remark`` why.
    """

    what: str
    unit: str = "s"
    values: tuple[float, ...] = ()
    against: str = ""
    ratios: tuple[float, ...] = ()
    at_least: float | None = None
    at_most: float | None = None
    of: Literal["value", "ratio"] = "ratio"
    remark: str = ""

    @property
    def wanted(self) -> str:
        """Both limits in words; empty where there is none."""
        limits = (("at least", self.at_least), ("at most", self.at_most))
        words = [f"{word} {limit:g}" for word, limit in limits if limit is not None]
        if self.at_least is not None and self.at_least == self.at_most:
            words = [f"{self.at_least:g}"]
        return ", ".join(words) + (f" {self.unit}" if words and self.of == "value" else "").rstrip()

    @property
    def is_met(self) -> bool | None:
        """None where nothing is wanted, or nothing was measured."""
        measured = self.values if self.of == "value" else self.ratios
        if not (measured and self.wanted):
            return None
        found = median(measured)
        return (self.at_least is None or found >= self.at_least) and (
            self.at_most is None or found <= self.at_most
        )


def hand_on(figures: Iterable[Figure]) -> None:
    """Write the figures where the suite wants them."""
    if TARGET in os.environ:
        text = json.dumps([asdict(one) for one in figures])
        Path(os.environ[TARGET]).write_text(text, encoding="utf-8")


def figures_in(path: Path) -> tuple[Figure, ...]:
    """Figures of a script that has ended."""
    found = []
    for row in json.loads(path.read_text(encoding="utf-8")):
        # JSON has no tuples
        kept: dict[str, Any] = {
            name: tuple(one) if isinstance(one, list) else one for name, one in row.items()
        }
        found.append(Figure(**kept))
    return tuple(found)
