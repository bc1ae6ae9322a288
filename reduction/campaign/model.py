"""What a user may write in campaign.toml, as pydantic models; `reduction schema` prints them.

Values that carry a unit are text here ("21.5 ft"); `reduction.campaign.load` turns
them into SI.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, field_validator

from reduction.campaign.hosemodel import ComparisonSection, HoseSection
from reduction.campaign.limits import LimitsSection
from reduction.campaign.reportspec import ReportSection
from reduction.campaign.uncertaintyspec import UncertaintySection
from reduction.errors import SettingsError
from reduction.ingest.layout import Layout
from reduction.settings import StrainMethod

TestKind = Literal[
    "cyclic",
    "fatigue",
    "snap",
    "bedding-in",
    "relaxation",
    "creep",
    "quasi-static",
    "tensile",
    "stepwise",
]
# a name becomes a file name, so it may hold nothing that a path or a shell reads
Identifier = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_\-]{0,99}$")]
StepName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_ \-]{0,99}$")]
RunName = Annotated[
    str,
    StringConstraints(
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_\-]{0,99}(/[A-Za-z0-9][A-Za-z0-9_ \-]{0,99})?$"
    ),
]
Response = Literal[
    "apparent_spring_constant",
    "hysteresis_energy",
    "dissipation_spring_constant",
    "relaxation_time",
    "storage_spring_constant",
    "loss_spring_constant",
    "loss_factor",
    "dashpot_coefficient",
]
"""What a surface may be fitted to; the first four are those of CG-D-39-80."""
Text = Annotated[str, StringConstraints(max_length=2000)]
_MOST = 999_999_999  # of what is counted: a netCDF integer holds it


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class CampaignSection(_Section):
    """``[campaign]``: who, what and under which terms."""

    id: Identifier
    title: Text
    institution: Text = ""
    source: Text = ""
    synthetic: bool = False
    """True where no specimen was ever pulled; every product then says so."""
    references: Text = ""
    license: Text = ""
    summary: Text = ""
    comment: Text = ""
    tests: Text = ""
    """A CSV with one row a test, beside or instead of ``[tests.*]``."""
    results: Text = ""
    """A CSV with one row an outcome of which there is no log."""


class SpecimenSection(_Section):
    """``[specimens.NAME]``: the specimen before its first test."""

    kind: Literal["rubber tether", "stretch hose", "rope", "wire", "elastomer"]
    material: Text = ""
    construction: Text = ""
    condition: Text = ""
    diameter: tuple[str, ...] | str = ()
    """Readings before stretch; the nominal area uses their mean."""
    stretched_diameter: dict[str, tuple[str, ...]] = Field(default_factory=dict)
    """Readings at a stretch, by stretch: ``{ "10 %" = ["0.997 in", "0.980 in"] }``."""
    rated_break_strength: str | None = None
    rated_break_strength_source: Text = ""
    linear_density: str | None = None
    """Mass a length in air."""
    wet_linear_density: str | None = None
    """The same less the water it displaces."""
    gauge_length: str | None = None
    gauge_length_standard_uncertainty: str | None = None
    earlier_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Cycles of tension before the first test of the campaign; none where left out."""
    earlier_flex_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Cycles of flexing before it; not known where left out."""
    note: Text = ""


class StrainSection(_Section):
    """``strain = { method = "...", marks = "marks.csv" }``."""

    method: StrainMethod | None = None
    marks: Text = ""


class FilePiece(_Section):
    """One file of a record in pieces."""

    file: Text
    layout: Identifier | None = None


class _Kept(_Section):
    """What a laboratory keeps about a test; goes into the product as written."""

    layout: Identifier | None = None
    specimens: tuple[Identifier, ...] = ()
    control: Literal["position", "load"] = "position"
    waveform: Literal["triangular", "sinusoidal", "other"] = "triangular"
    rate: Text = ""
    medium: Text = ""
    """``dry``, ``wet``, ``soaked since ...``."""
    soak: Text = ""
    temperature: Text = ""
    machine: Text = ""
    load_cell: Text = ""
    calibration_due: Text = ""
    operator: Text = ""
    procedure: Text = ""
    note: Text = ""
    strain: StrainSection = StrainSection()
    reduction: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """Numbers of `reduction.settings`, by group: ``reduction.cycles.trim_threshold = 0.95``."""


class Defaults(_Kept):
    """``[defaults]``: what every test has unless it says otherwise."""

    kind: TestKind = "cyclic"


class StepSection(_Section):
    """``[[tests.ID.steps]]``: one step of a log that holds many."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, populate_by_name=True
    )

    name: StepName
    start: str | int = Field(alias="from")
    """A time with its unit, or a cycle number of the whole log."""
    end: str | int = Field(alias="to")
    kind: TestKind | None = None
    target_strain: tuple[float, ...] = ()
    n_cycles: int | None = Field(default=None, ge=1, le=_MOST)
    failed: bool | None = None
    """As of a test."""
    note: Text = ""


class TestSection(_Kept):
    """``[tests.ID]``: one test; keys that it leaves out come from ``[defaults]``."""

    __test__ = False  # a test of a tether, not of this software

    kind: TestKind | None = None
    file: Text | tuple[FilePiece, ...] = ""
    """Required, here or in the table of tests."""
    order: int | None = Field(default=None, ge=-_MOST, le=_MOST)
    """Place in the specimens' history."""
    part_of: Identifier | None = None
    """The test of which this log repeats a part; its cycles are not counted twice."""
    date: Text = ""
    rest: Text = ""
    """Time at rest before this test."""
    target_strain: tuple[float, ...] = ()
    n_cycles: int | None = Field(default=None, ge=1, le=_MOST)
    unlogged_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Cycles of tension between the test before and this one, of which there is no log."""
    n_flex_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Cycles of flexing in this test, while it is pulled."""
    flex_angle: str | None = None
    """Half the range of the flexing: ``30 deg`` to either side."""
    failed: bool | None = None
    """Whether the specimens broke in this test, in the laboratory's word; else the log decides."""
    steps: tuple[StepSection, ...] = ()

    @field_validator("file", mode="before")
    @classmethod
    def _pieces_are_tables(cls, value: object) -> object:
        """A list of file names has no room for the layout of each piece."""
        if isinstance(value, list | tuple) and any(isinstance(entry, str) for entry in value):
            raise SettingsError(
                "the pieces of a record are not tables",
                found=repr(value),
                needed='a file name, or a list such as [{ file = "a.csv" }, { file = "b.csv" }]',
            )
        return value


class ExperimentSection(_Section):
    """``[experiments.NAME]``: cyclic tests or steps that make one set of response surfaces."""

    kind: Literal["box-behnken", "plackett-burman"]
    factors: dict[Identifier, tuple[str, str]]
    """Low and high level by factor: ``"0.1 Hz"``, ``"12 %RBS"``, ``"40 % of mean"``."""
    runs: dict[RunName, tuple[float, ...]]
    """Coded levels as planned, by test or test/step; the achieved ones come from the logs."""
    quasi_static: dict[Identifier, Text] = Field(default_factory=dict)
    """Test (or test/step) with the slow pull, by specimen."""
    responses: tuple[Response, ...] = get_args(Response)[:4]
    transform: dict[Response, Literal["none", "log", "box-cox"]] = Field(default_factory=dict)
    specimens_as: Literal["blocks", "random"] = "blocks"
    """How several specimens of one line enter: a mean of each, or a draw from many."""
    term_reduction: Literal["none", "aicc"] = "none"
    """Beside the full surfaces, those with the terms that AICc keeps."""


class CampaignFile(_Section):
    """The whole of campaign.toml."""

    campaign: CampaignSection
    results: Text = ""
    """As in ``[campaign]``."""
    specimens: dict[Identifier, SpecimenSection] = Field(default_factory=dict)
    layouts: dict[Identifier, Layout] = Field(default_factory=dict)
    defaults: Defaults = Defaults()
    tests: dict[Identifier, TestSection] | Text = Field(default_factory=dict)
    experiments: dict[Identifier, ExperimentSection] = Field(default_factory=dict)
    hoses: dict[Identifier, HoseSection] = Field(default_factory=dict)
    comparisons: dict[Identifier, ComparisonSection] = Field(default_factory=dict)
    uncertainty: UncertaintySection = UncertaintySection()
    report: ReportSection | None = None
    limits: LimitsSection = LimitsSection()
