"""A campaign as the rest of the package sees it: SI, checked, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from reduction.archive.write import ReportDetails
from reduction.experiments.designs import FactorLevels
from reduction.experiments.outcomes import Outcome
from reduction.prediction.hose_prediction import HosePlan
from reduction.readers.layout import Layout
from reduction.readers.remote_files import in_words
from reduction.record.contributions import StatedErrors
from reduction.record.errors import LogError
from reduction.record.measurement import Source, Specimen, SpliceMarks
from reduction.record.plain_text import is_address
from reduction.record.settings import CycleSettings, Limits, ReductionSettings, Waveform


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

    ``files`` are (path relative to the campaign folder, or what may be shown of an address;
    layout name), in order of time.
    """

    __test__ = False  # a test of a tether, not of this software

    id: str
    kind: str
    files: tuple[tuple[str, str], ...]
    specimens: tuple[str, ...]
    order: int | None
    control: str
    waveform: Waveform
    target_strain: tuple[float, ...]
    attributes: dict[str, str]
    settings: ReductionSettings
    part_of: str | None = None
    log: str = ""
    """Id of the test whose log this is: another than ``id`` for a step of a log."""
    step_place: int = 0
    """Place of a step in its log, from 1; 0 for a test without steps."""
    step_range: tuple[float, float] | None = None
    """Times [s] or cycle numbers between which a step lies; None for a test without steps."""
    failed: bool | None = None
    """Whether the specimens broke, where the laboratory says so."""
    steps: tuple[StepPlan, ...] = ()
    unlogged_cycles: int | None = None
    """Cycles since the test before that are in no log."""
    n_flex_cycles: int | None = None
    """Cycles of flexing in the log, all its steps together."""


def cycles_of_kind(cycles: CycleSettings, kind: str) -> CycleSettings:
    """Settings of the cycles of a kind of test.

    The first cycles of a line that is bedded in are no sine, whatever drives them: they count
    from turn to turn, as in a test whose waveform is not known.
    """
    is_sine = kind == "bedding-in" and cycles.waveform == "sinusoidal"
    return replace(cycles, waveform="other") if is_sine else cycles


@dataclass(frozen=True)
class ExperimentPlan:
    """Tests or steps whose loops make one set of response surfaces.

    ``runs`` holds the coded levels as planned, by the id of the test or step; levels beyond
    the factors are those of dummy columns.  ``quasi_static`` is the test with the slow pull
    of each specimen, ``transform`` the scale of each response of which one is stated.
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
class ComparisonPlan:
    """A measured curve and the prediction that it is held against.

    ``measured`` is the id of the test or step, ``specimen`` one of its specimens,
    ``predicted`` one of the hoses, ``calibrate`` the numbers of the hose to be fitted;
    ``loading`` is None where the kind of the test says it.
    """

    name: str
    measured: str
    specimen: str
    predicted: str
    loading: Literal["static", "dynamic"] | None = None
    calibrate: tuple[str, ...] = ()


@dataclass(frozen=True)
class Campaign:
    """One campaign.toml with everything that it names, resolved.

    ``outcomes`` are the rows of the table ``results``, with what the sheets of their
    specimens say; ``uncertainty`` is what is stated of the instruments, ``report`` what the
    laboratory states for its client, ``limits`` what a log may be.

    ``small_files`` are digests of campaign.toml and the tables that it names, by their names.

    ``addresses`` are whole addresses of logs on the net by their names, until there are
    ``copies`` of them, or ``unread`` says why there is none; ``names`` are what may be shown
    of addresses, by the paths of the copies.
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
    hoses: dict[str, HosePlan] = field(default_factory=dict)
    comparisons: dict[str, ComparisonPlan] = field(default_factory=dict)
    uncertainty: StatedErrors = field(default_factory=StatedErrors)
    report: ReportDetails | None = None
    limits: Limits = field(default_factory=Limits)
    small_files: dict[str, str] = field(default_factory=dict, repr=False)
    addresses: dict[str, str] = field(default_factory=dict, repr=False)
    copies: dict[str, Path] = field(default_factory=dict)
    unread: dict[str, LogError] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)

    @property
    def folder(self) -> Path:
        """Folder of campaign.toml, in which every file of the campaign lies."""
        return self.path.parent

    def file(self, name: str) -> Path:
        """Path of a campaign file, or of the copy of one; `LogError` where there is no copy."""
        if name in self.unread:
            raise self.unread[name]
        return self.copies.get(name, self.folder / name)

    def shown(self, name: str) -> str:
        """A campaign file as messages name it: its path, or what may be shown of its address."""
        return name if is_address(name) else self.in_words(str(self.folder / name))

    def in_words(self, text: str) -> str:
        """A message with addresses instead of the paths of their copies."""
        return in_words(text, self.names)


def product_of(name: str, tests: Mapping[str, TestPlan]) -> tuple[str, str] | None:
    """Id of the product and kind of a test or test/step."""
    test, _, step = name.partition("/")
    plan = tests.get(test)
    if plan is None:
        return None
    if not step:
        return None if plan.steps else (plan.id, plan.kind)
    for known in plan.steps:
        if known.name == step:
            return known.product(plan.id), known.kind
    return None
