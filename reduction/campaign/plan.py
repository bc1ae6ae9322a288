"""A campaign as the rest of the package sees it: SI, checked, frozen."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from reduction.ingest.layout import Layout
from reduction.outcomes.product import Outcome
from reduction.provenance import Source
from reduction.record import Specimen, SpliceMarks
from reduction.settings import ReductionSettings
from reduction.surface.levels import FactorLevels

__all__ = ["Campaign", "ExperimentPlan", "StepPlan", "TestPlan"]


@dataclass(frozen=True)
class StepPlan:
    """One step of a log: a time range [s] or a range of cycle numbers, both ends inside."""

    name: str
    kind: str
    time_range: tuple[float, float] | None
    cycle_range: tuple[int, int] | None
    expected_cycles: int | None
    target_strain: tuple[float, ...] = ()
    failed: bool | None = None
    note: str = ""

    def product(self, test: str) -> str:
        """Id of the step's product in a test."""
        return f"{test}.{self.name.replace(' ', '-')}"


@dataclass(frozen=True)
class TestPlan:
    """One test of a campaign.

    ``files`` are (path relative to the campaign folder, layout name), in order of time.
    """

    __test__ = False  # a test of a tether, not of this software

    id: str
    kind: str
    files: tuple[tuple[str, str], ...]
    specimens: tuple[str, ...]
    order: int | None
    control: str
    waveform: str
    target_strain: tuple[float, ...]
    attributes: dict[str, str]
    settings: ReductionSettings
    part_of: str | None = None
    log: str = ""
    """Id of the test whose log this is: another than ``id`` for a step of a log."""
    step_place: int = 0
    """Place of a step in its log, from 1; 0 for a test without steps."""
    failed: bool | None = None
    """Whether the specimens broke, where the laboratory says so."""
    steps: tuple[StepPlan, ...] = ()


@dataclass(frozen=True)
class ExperimentPlan:
    """Tests or steps whose loops make one set of response surfaces.

    ``runs`` holds the coded levels as planned, by the id of the test or step; levels beyond
    the factors are those of dummy columns.  ``quasi_static`` is the test with the slow pull
    of each specimen, ``transform`` that of each response that has one.
    """

    name: str
    kind: Literal["box-behnken", "plackett-burman"]
    factors: tuple[FactorLevels, ...]
    runs: dict[str, tuple[float, ...]]
    quasi_static: dict[str, str]
    responses: tuple[str, ...]
    transform: dict[str, str]
    specimens_as: Literal["blocks", "random"]
    term_reduction: Literal["none", "aicc"] = "none"


@dataclass(frozen=True)
class Campaign:
    """One campaign.toml with everything that it names, resolved.

    ``outcomes`` are the rows of the table ``results``, with what the sheets of their
    specimens say.
    """

    path: Path
    id: str
    attributes: dict[str, str]
    specimens: dict[str, Specimen]
    layouts: dict[str, Layout]
    tests: dict[str, TestPlan]
    marks: dict[str, SpliceMarks]
    experiments: dict[str, ExperimentPlan] = field(default_factory=dict)
    results: Source | None = None
    outcomes: tuple[Outcome, ...] = ()

    @property
    def folder(self) -> Path:
        """Folder of campaign.toml, in which every file of the campaign lies."""
        return self.path.parent

    def file(self, name: str) -> Path:
        """Path of a campaign file."""
        return self.folder / name
