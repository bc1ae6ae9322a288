"""A campaign as the rest of the package sees it: SI, checked, frozen."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reduction.ingest.layout import Layout
from reduction.record import Specimen, SpliceMarks
from reduction.settings import ReductionSettings

__all__ = ["Campaign", "StepPlan", "TestPlan"]


@dataclass(frozen=True)
class StepPlan:
    """One step of a log: a time range [s] or a range of cycle numbers, both ends inside."""

    name: str
    kind: str
    time_range: tuple[float, float] | None
    cycle_range: tuple[int, int] | None
    expected_cycles: int | None
    target_strain: tuple[float, ...] = ()
    note: str = ""


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
    steps: tuple[StepPlan, ...] = ()


@dataclass(frozen=True)
class Campaign:
    """One campaign.toml with everything that it names, resolved."""

    path: Path
    id: str
    attributes: dict[str, str]
    specimens: dict[str, Specimen]
    layouts: dict[str, Layout]
    tests: dict[str, TestPlan]
    marks: dict[str, SpliceMarks]

    @property
    def folder(self) -> Path:
        """Folder of campaign.toml, in which every file of the campaign lies."""
        return self.path.parent

    def file(self, name: str) -> Path:
        """Path of a campaign file."""
        return self.folder / name
