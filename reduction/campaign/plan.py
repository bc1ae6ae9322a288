"""A campaign in the form used by the rest of the package: SI, checked, frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from reduction.archive.report_details import ReportDetails
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
    """One step of a log: a time range [s] or a range of cycle numbers, both inclusive."""

    name: str
    kind: str
    time_range: tuple[float, float] | None
    cycle_range: tuple[int, int] | None
    expected_cycles: int | None
    target_strain: tuple[float, ...] = ()
    failed: bool | None = None
    note: str = ""

    def product(self, test: str) -> str:
        """Id of the product of this step in a test."""
        return f"{test}.{self.name.replace(' ', '-')}"


@dataclass(frozen=True)
class TestPlan:
    """One test of a campaign.

    ``files`` are (path relative to the campaign folder, or safe form of an address; layout name),
    in time order.
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
    """Id of the test that has this log; it differs from ``id`` for a step."""
    step_place: int = 0
    """Position of a step in its log, from 1; 0 for a test without steps."""
    step_range: tuple[float, float] | None = None
    """Limits of a step in time [s] or cycle number; None for a test without steps."""
    failed: bool | None = None
    """Whether the specimens broke, if the laboratory states it."""
    steps: tuple[StepPlan, ...] = ()
    unlogged_cycles: int | None = None
    """Cycles without a log since the previous test."""
    n_flex_cycles: int | None = None
    """Flexing cycles in the log, total of all its steps."""


def cycles_of_kind(cycles: CycleSettings, kind: str) -> CycleSettings:
    """Cycle settings for a kind of test.

    The first cycles of a line during bedding-in are not sinusoidal, however they are driven. They
    are counted from turn to turn, as in a test of unknown waveform.
    """
    is_sine = kind == "bedding-in" and cycles.waveform == "sinusoidal"
    return replace(cycles, waveform="other") if is_sine else cycles


@dataclass(frozen=True)
class ExperimentPlan:
    """Tests or steps whose loops give one set of response surfaces.

    ``runs`` holds the planned coded levels, by the id of the test or step; levels after those of
    the factors belong to dummy columns.  ``quasi_static`` is the test with the slow pull of each
    specimen, ``transform`` the scale of each response with a stated one.
    """

    name: str
    kind: Literal["box-behnken", "plackett-burman"]
    factors: tuple[FactorLevels, ...]
    runs: dict[str, tuple[float, ...]]
    quasi_static: dict[str, str]
    responses: tuple[str, ...]
    transform: dict[str, str]
    specimens_as: Literal["blocks", "random"]


@dataclass(frozen=True)
class ComparisonPlan:
    """A measured curve and the prediction compared with it.

    ``measured`` is the id of the test or step, ``specimen`` one of its specimens, ``predicted`` one
    of the hoses, ``calibrate`` the parameters of the hose to fit; ``loading`` is None if it follows
    from the kind of test.
    """

    name: str
    measured: str
    specimen: str
    predicted: str
    loading: Literal["static", "dynamic"] | None = None
    calibrate: tuple[str, ...] = ()


@dataclass(frozen=True)
class Campaign:
    """One campaign.toml with all its files resolved.

    ``outcomes`` are the rows of the table ``results``, with data from the sheets of their
    specimens; ``uncertainty`` holds stated instrument errors, ``report`` the laboratory's
    statements for its client, ``limits`` the limits on a log.

    ``small_files`` are digests of campaign.toml and its tables, by name.

    ``addresses`` are full addresses of remote logs by name, until there are ``copies`` or
    ``unread`` gives the reason why not; ``names`` are safe forms of addresses by the paths of the
    copies.
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
        """Folder of campaign.toml, which contains every file of the campaign."""
        return self.path.parent

    def file(self, name: str) -> Path:
        """Path of a campaign file or of its copy; `LogError` if there is no copy."""
        if name in self.unread:
            raise self.unread[name]
        return self.copies.get(name, self.folder / name)

    def shown(self, name: str) -> str:
        """A campaign file for messages: its path, or the safe form of its address."""
        return name if is_address(name) else self.in_words(str(self.folder / name))

    def in_words(self, text: str) -> str:
        """A message with the paths of copies replaced by their addresses."""
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
