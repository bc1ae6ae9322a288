"""Pydantic models of the keys allowed in campaign.toml; `reduction schema` prints them.

Values with a unit are text in the file ("21.5 ft") and numbers in SI after reading.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    StringConstraints,
    Tag,
    ValidationInfo,
    field_validator,
)

from reduction.archive.report_details import (
    Date,
    ReportDetails,
    ReportLimit,
    ReportSection,
    ReportText,
    Statement,
)
from reduction.archive.uncertainty_budget import parse_place
from reduction.campaign.hose_spec import ComparisonSection, HoseSection
from reduction.campaign.plan import TestPlan, product_of
from reduction.campaign.toml_file import at_place, in_toml
from reduction.campaign.unit_types import (
    Force,
    InSI,
    Number,
    PositiveArea,
    PositiveDensity,
    PositiveForce,
    PositiveLength,
    ReadKey,
    Strain,
    value_in_si,
)
from reduction.quantities.names import QUANTITIES, name_of_quantity, quantity
from reduction.quantities.units import Dimension, parse_in_unit, parse_quantity
from reduction.readers.layout import Layout
from reduction.record.contributions import (
    USUAL_SPLICE_FRICTION,
    StatedErrors,
    of_expanded,
    of_half_width,
    of_resolution,
)
from reduction.record.errors import SettingsError
from reduction.record.measurement import Specimen
from reduction.record.settings import (
    Control,
    ReductionSettings,
    StoredSamples,
    StrainMethod,
    Waveform,
)

# among pint's many dimensionless units, including turns and percent, those for bytes
_BYTES = re.compile(r"[\d.+\-eE\s]*([kMGT]i?B|B|bytes?)\s*")


@dataclass(frozen=True)
class _Limit(ReadKey):
    """Reads a limit from a size in bytes, from a time, or as an integer."""

    least: float
    most: float
    shown: str
    dimension: Dimension | None = "information"

    @property
    def written(self) -> Any:
        """A text with a unit, or an integer."""
        return int if self.dimension is None else str

    def value(self, stated: Any) -> float:
        """Limit in bytes, in seconds, or as a plain number."""
        needed = self.shown
        if self.dimension == "information":
            needed += ", in bytes (B, kB, MB, GB, TB, KiB, MiB, GiB, TiB)"
            if _BYTES.fullmatch(stated) is None:
                raise SettingsError("a size is not in bytes", found=repr(stated), needed=needed)
        value = stated if self.dimension is None else value_in_si(stated, self.dimension)
        if not self.least <= value <= self.most:
            raise SettingsError("this is not a limit", found=repr(str(stated)), needed=needed)
        return value if self.dimension == "time" else round(value)


class _LimitsSection(BaseModel):
    """``[limits]``: a log beyond them is refused; they affect no number."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    file_size: Annotated[int, _Limit(1e3, 1e14, '"1 kB" to "100 TB"')] | None = None
    """Of one log: default ``"100 GB"``."""
    unpacked_size: Annotated[int, _Limit(1e6, 1e12, '"1 MB" to "1 TB"')] | None = None
    """Memory for a file read whole, or for a piece of one: default ``"2.5 GB"``."""
    line_length: Annotated[int, _Limit(1e3, 1e8, '"1 kB" to "100 MB"')] | None = None
    """Of a line of text: default ``"1 MB"``."""
    columns: (
        Annotated[int, _Limit(1, 1_000_000, "a whole number from 1 to 1000000", None)] | None
    ) = None
    """In a log: default 10000."""
    time: Annotated[float, _Limit(1.0, 7 * 86400.0, '"1 s" to "7 days"', "time")] | None = None
    """To read one log: default ``"1 h"``."""


_HALF = 0.5
"""Larger relative errors are beyond first-order propagation, which would not hold."""

_MOST_BARE = 0.05
"""A larger share without its sign was probably meant in percent."""

_OF_DIAMETER = 0.2
"""Limit for a diameter: 40 % of its area, and of every stress and modulus."""

_GREATEST_OF: dict[Dimension, tuple[float, str]] = {
    "strain": (_HALF, ", at most 50 %"),
    "temperature": (100.0, ", at most 100 K, as a difference: in K"),
}


class _UncertaintySection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class _Expanded(_UncertaintySection):
    """Form on a calibration certificate: ``{ expanded = "0.2 %", k = 2 }``."""

    expanded: Number
    k: float


class _StatedLimits(_UncertaintySection):
    """Form on a data sheet: ``{ half_width = "0.25 %", shape = "rectangular" }``."""

    half_width: Number
    shape: Literal["rectangular", "triangular", "arcsine"] = "rectangular"


def _is_bare(text: Number) -> bool:
    """Whether a value is a number alone."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _form_of(stated: object) -> str:
    """Form that is meant; faults are then those of this form alone."""
    if not isinstance(stated, dict):
        return "plain"
    return "certificate" if stated.keys() & {"expanded", "k"} else "data sheet"


@dataclass(frozen=True)
class _Standard(ReadKey):
    """Reads a standard uncertainty: stated as such, as an expanded one, or as limits."""

    dimension: Dimension
    has_tables: bool = True

    @property
    def written(self) -> Any:
        """A plain value, or one of the two tables."""
        if not self.has_tables:
            return Number
        return Annotated[
            Annotated[Number, Tag("plain")]
            | Annotated[_Expanded, Tag("certificate")]
            | Annotated[_StatedLimits, Tag("data sheet")],
            Discriminator(_form_of),
        ]

    def value(self, stated: Number | _Expanded | _StatedLimits) -> float:
        """Standard uncertainty in SI."""
        if isinstance(stated, _Expanded):
            found = of_expanded(self._part("expanded", stated.expanded), stated.k)
        elif isinstance(stated, _StatedLimits):
            found = of_half_width(self._part("half_width", stated.half_width), stated.shape)
        else:
            found = self._value(stated)
        # a temperature in degC would be one above freezing
        most, words = _GREATEST_OF.get(self.dimension, (math.inf, ""))
        if not 0 <= found <= most:
            raise SettingsError(
                "this is not a standard uncertainty",
                found=str(stated),
                needed=f"zero or more{words}",
            )
        return found

    def _part(self, key: str, text: Number) -> float:
        try:
            return self._value(text)
        except SettingsError as error:
            error.facts["key"] = key
            raise

    def _value(self, text: Number) -> float:
        value = value_in_si(text, self.dimension)
        if self.dimension == "strain" and _MOST_BARE < value <= _HALF and _is_bare(text):
            raise SettingsError(
                "a share this large needs its sign",
                found=f"{text}, which is {100 * value:g} %",
                needed=f'"{100 * value:g} %", or "{text} %" if that is meant',
            )
        return value


_Relative = Annotated[float, _Standard("strain")]
_OfForce = Annotated[float, _Standard("force")]
_OfLength = Annotated[float, _Standard("length")]


class _TensionSection(_UncertaintySection):
    """``[uncertainty.tension]``."""

    gain: _Relative | None = None
    """Relative to the whole indication: ``"0.1 %"``."""
    offset: _OfForce | None = None
    """Of the zero."""
    reversibility: _Relative | None = None
    """Between indications of falling and rising load, relative: ``"0.1 %"``."""
    noise: _OfForce | None = None
    """Of one reading."""
    resolution: Annotated[float, _Standard("force", has_tables=False)] | None = None
    """One step of the indication."""
    one_load_cell: bool = False
    """Whether all tension channels use one cell, or were calibrated against one."""


class _PositionSection(_UncertaintySection):
    """``[uncertainty.crosshead_position]``."""

    gain: _Relative | None = None
    offset: _OfLength | None = None
    noise: _OfLength | None = None
    resolution: Annotated[float, _Standard("length", has_tables=False)] | None = None


class _TemperatureSection(_UncertaintySection):
    """``[uncertainty.temperature]``: both keys are required."""

    value: Annotated[float, _Standard("temperature")]
    """Of the specimen temperature during the test: ``"2 K"``."""
    stiffness_per_kelvin: Strain
    """Relative change of tension at constant strain: ``"0.3 %"``."""


class UncertaintySection(_UncertaintySection):
    """``[uncertainty]``: standard uncertainties shared by the tests of the campaign."""

    tension: _TensionSection = _TensionSection()
    crosshead_position: _PositionSection = _PositionSection()
    lag: Annotated[float, _Standard("time")] | None = None
    """Between the two channels."""
    diameter: _OfLength | None = None
    """Of the mean of the readings for a specimen."""
    area: _Relative | None = None
    """Relative: of the area of a specimen without a diameter."""
    tape: _OfLength | None = None
    """Of one tape reading at the marks: ``"0.005 ft"``."""
    strain: _Relative | None = None
    """Relative: error of the strain method itself."""
    rated_break_strength: _Relative | None = None
    """Relative."""
    temperature: _TemperatureSection | None = None
    attached_mass: Annotated[float, _Standard("mass")] | None = None
    """Of the mass between the specimen and a load cell at its moving end: ``"0.1 kg"``."""
    linear_density: Annotated[float, _Standard("linear_density")] | None = None
    """Of the mass per length of the specimens."""
    machine_compliance: Annotated[float, _Standard("compliance")] | None = None
    """Of frame, load cell and grips: ``"2e-8 m/N"``."""
    splice_friction: _Relative | None = None
    """Excess of splices when unloading over loading, relative to extension: ``"2 %"``."""
    splice_creep: _Relative | None = None
    """Creep of splices from a cycle to a mark, relative to extension: ``"2 %"``."""


def stated_errors(
    path: Path, section: UncertaintySection, specimens: Iterable[Specimen] = ()
) -> StatedErrors:
    """Standard uncertainties of a campaign; errors name campaign.toml and the key."""
    tension, position, warmth = section.tension, section.crosshead_position, section.temperature
    stiffness = 0.0 if warmth is None else warmth.value * abs(warmth.stiffness_per_kelvin)
    if stiffness > _HALF:
        raise in_toml(
            path,
            "uncertainty.temperature: value times stiffness_per_kelvin is not a standard "
            "uncertainty",
            found=f"{100 * stiffness:,.0f} % of the stiffness", needed="at most 50 %",
        )  # fmt: skip
    diameter = section.diameter or 0.0
    for specimen in specimens:
        if specimen.diameter and diameter > _OF_DIAMETER * specimen.mean_diameter:
            raise in_toml(
                path,
                "uncertainty.diameter: this is not a standard uncertainty of the diameter of "
                f"'{specimen.name}'",
                found=f"{1e3 * diameter:.4g} mm of {1e3 * specimen.mean_diameter:.4g} mm",
                needed="at most 20 % of it, which is 40 % of every modulus",
                hint="It is of the mean of the readings, not the diameter itself.",
            )
    return StatedErrors(
        tension_gain=tension.gain or 0.0,
        tension_offset=tension.offset or 0.0,
        tension_reversibility=tension.reversibility or 0.0,
        tension_reading=_of_reading(tension),
        position_gain=position.gain or 0.0,
        position_offset=position.offset or 0.0,
        position_reading=_of_reading(position),
        lag=section.lag or 0.0,
        diameter=diameter,
        area=section.area or 0.0,
        strain_gain=section.strain or 0.0,
        rated_break_strength=section.rated_break_strength or 0.0,
        stiffness=stiffness,
        attached_mass=section.attached_mass or 0.0,
        linear_density=section.linear_density or 0.0,
        machine_compliance=section.machine_compliance or 0.0,
        splice_friction=(
            USUAL_SPLICE_FRICTION if section.splice_friction is None else section.splice_friction
        ),
        is_splice_friction_known=section.splice_friction is not None,
        has_one_load_cell=tension.one_load_cell,
    )


def _of_reading(section: _TensionSection | _PositionSection) -> float:
    """Combined noise and resolution of one reading."""
    step = of_resolution(section.resolution or 0.0)
    return float(((section.noise or 0.0) ** 2 + step**2) ** 0.5)


class _LimitSection(ReportSection):
    """``[[report.limits]]``: a number compared with a limit."""

    quantity: ReportText
    """Name in `reduction budget`: ``tangent_modulus``, ``segment_modulus``, ..."""
    test: ReportText
    """A test, or ``test/step``."""
    at: dict[str, str | int | float] = Field(default_factory=dict)
    """``{ specimen = "new", branch = "ascending", strain = "125 %" }``."""
    lower: str | None = None
    upper: str | None = None
    source: ReportText = ""


class _ReportSection(Statement[_LimitSection]):
    """``[report]``: all keys are optional; the report says which are not stated."""


def report_details(
    path: Path,
    section: _ReportSection | None,
    *,
    specimens: Collection[str],
    tests: Mapping[str, TestPlan],
) -> ReportDetails | None:
    """Return the statements of the laboratory, with limits in SI."""
    if section is None:
        return None
    unknown = sorted(set(section.items) - set(specimens))
    if unknown:
        raise in_toml(
            path, "report.items names something that is not a specimen of the campaign",
            found=", ".join(unknown), needed=f"one of {', '.join(specimens)}",
        )  # fmt: skip
    if section.limits and section.decision_rule is None:
        raise in_toml(
            path, "report.limits are given, but no decision rule for conformity",
            needed='report.decision_rule = "simple acceptance" or "guard band"',
        )  # fmt: skip
    return ReportDetails(
        **{name: value for name, value in section if name != "limits"},
        limits=tuple(
            _limit(path, f"report.limits.{number}", one, tests)
            for number, one in enumerate(section.limits)
        ),
    )


def _limit(
    path: Path, place: str, one: _LimitSection, tests: Mapping[str, TestPlan]
) -> ReportLimit:
    named = one.quantity if one.quantity in QUANTITIES else name_of_quantity(one.quantity)
    if named not in QUANTITIES:
        raise in_toml(
            path, f"{place}.quantity is not known", found=repr(one.quantity),
            needed="a name such as tangent_modulus; `reduction budget PRODUCT.nc` lists them",
        )  # fmt: skip
    product = product_of(one.test, tests)
    if product is None:
        raise in_toml(
            path, f"{place}.test is not a test of the campaign", found=repr(one.test),
            needed="one of " + ", ".join(tests) + "; of a test with steps TEST/STEP",
        )  # fmt: skip
    if one.lower is None and one.upper is None:
        raise in_toml(path, f"{place} has no limit", needed="lower, upper, or both")
    with at_place(f"{path}: {place}: "):
        lower, upper = (
            None if text is None else parse_in_unit(text, quantity(named).unit)
            for text in (one.lower, one.upper)
        )
        at = {key: parse_place(key, str(value)) for key, value in one.at.items()}
    if lower is not None and upper is not None and not lower < upper:
        raise in_toml(
            path, f"{place}: the lower limit is not below the upper one",
            found=f"{one.lower} and {one.upper}",
        )  # fmt: skip
    # of no single cycle: the mean of the test
    if f"test_{named}" in QUANTITIES and "cycle" not in at:
        named = f"test_{named}"
    return ReportLimit(
        quantity=named, test=product[0], at=at, lower=lower, upper=upper, source=one.source
    )


_DIMENSION: dict[tuple[str, str], Dimension] = {
    ("phases", "minimum_duration"): "time",
    ("phases", "position_tolerance"): "length",
    ("phases", "tension_tolerance"): "force",
    ("phases", "slack_tension"): "force",
    ("holds", "minimum_duration"): "time",
    ("holds", "times"): "time",
    ("modulus", "strain_bin_width"): "strain",
    ("modulus", "window"): "strain",
    ("modulus", "stress_at_strain"): "strain",
    ("rope", "reference_time"): "time",
}

# minimum and maximum valid values for a stage; SI
_LIMITS: dict[tuple[str, str], tuple[float, float]] = {
    ("quality", "stuck_samples"): (3, math.inf),
    ("quality", "spike_factor"): (3, math.inf),
    ("quality", "gap_factor"): (1.01, math.inf),
    ("quality", "rate_tolerance"): (1e-6, math.inf),
    ("phases", "minimum_duration"): (1e-3, math.inf),
    ("phases", "position_tolerance"): (1e-9, math.inf),
    ("cycles", "band"): (1e-9, math.inf),
    ("cycles", "trim_threshold"): (0.0, 1.0),
    ("cycles", "break_in_cycles"): (0, math.inf),
    ("modulus", "strain_bin_width"): (1e-4, 10.0),
    ("modulus", "window"): (1e-4, 10.0),
    ("modulus", "minimum_count"): (3, math.inf),
    ("modulus", "maximum_segments"): (1, 8),
    ("modulus", "segment_tolerance"): (1e-6, 1.0),
    ("modulus", "selected_cycles"): (2, math.inf),
    ("holds", "minimum_duration"): (1e-3, math.inf),
    ("holds", "maximum_terms"): (1, 5),
    ("slip", "minimum_cycles"): (20, math.inf),
    ("slip", "false_alarm"): (1e-9, 0.5),
    ("rope", "last_cycles"): (1, math.inf),
    ("rope", "reference_time"): (1e-3, math.inf),
    ("rope", "failure_share"): (0.01, 0.99),
    ("archive", "longest_record"): (1000, math.inf),
}

_WORDS: dict[tuple[str, str], tuple[str, ...]] = {("archive", "samples"): get_args(StoredSamples)}

_KEY_OF_TEST = {
    ("strain", "method"): 'strain = { method = "..." }',
    ("cycles", "control"): 'control = "..."',
    ("cycles", "waveform"): 'waveform = "..."',
    ("cycles", "expected_cycles"): "n_cycles = ...",
}
"""Keys of a test for numbers that are no settings of ``reduction``."""


def dimension_of(group: str, name: str, *, control: str) -> Dimension | None:
    """Dimension of a number, used for its unit; None if it has none."""
    if (group, name) == ("cycles", "band"):
        return "force" if control == "load" else "length"
    return _DIMENSION.get((group, name))


def limits_of(group: str, name: str) -> tuple[float, float]:
    """Minimum and maximum of a number, in SI."""
    return _LIMITS.get((group, name), (0.0, math.inf))


def _in_si(where: str, value: str | float, dimension: Dimension) -> float:
    """A value with its unit in SI; errors say which number it is."""
    with at_place(f"{where}: "):
        return parse_quantity(value, dimension)


def _value(group: str, name: str, value: object, default: object, control: str) -> object:
    where = f"reduction.{group}.{name}"
    words = _WORDS.get((group, name))
    if words is not None:
        if value not in words:
            needed = " or ".join(f'"{word}"' for word in words)
            raise SettingsError(f"{where} is unknown", found=repr(value), needed=needed)
        return value
    dimension = dimension_of(group, name, control=control)
    if isinstance(default, tuple):
        if not isinstance(value, (list, tuple)):
            raise SettingsError(f"{where} is not a list", found=repr(value), needed="a list")
        return tuple(_in_si(where, item, dimension or "number") for item in value)
    if dimension is not None:
        if not isinstance(value, (str, int, float)):
            raise SettingsError(f"{where} is not a value", found=repr(value), needed="a value")
        number = _in_si(where, value, dimension)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:  # an integer of hundreds of digits
            number = math.inf
    else:
        raise SettingsError(f"{where} is not a number", found=repr(value), needed="a number")
    least, greatest = limits_of(group, name)
    if not least <= number <= greatest or (isinstance(default, float) and math.isinf(number)):
        upper = "" if math.isinf(greatest) else f" and at most {greatest:g}"
        raise SettingsError(
            f"{where} is out of range", found=repr(value), needed=f"at least {least:g}{upper}"
        )
    if isinstance(default, int):
        if not number.is_integer():  # neither is infinity
            raise SettingsError(
                f"{where} is not a whole number", found=repr(value), needed="a whole number"
            )
        return int(number)
    return number


def apply_numbers(
    settings: ReductionSettings, table: Mapping[str, Mapping[str, Any]], *, control: str
) -> ReductionSettings:
    """Settings updated with the numbers of one ``reduction`` table."""
    for group, numbers in table.items():
        known = {item.name for item in fields(settings)}
        if group not in known:
            raise SettingsError(
                f"reduction.{group} is not a group of settings",
                found=f"'{group}'",
                needed="one of " + ", ".join(sorted(known)),
            )
        part = getattr(settings, group)
        names = {
            item.name: item.default
            for item in fields(part)
            if (group, item.name) not in _KEY_OF_TEST
        }
        changed = {}
        for name, value in numbers.items():
            if name not in names:
                stated = _KEY_OF_TEST.get((group, name))
                raise SettingsError(
                    f"reduction.{group}.{name} is not a setting",
                    found=f"'{name}'",
                    needed=f"one of {', '.join(sorted(names))}"
                    if stated is None
                    else f"the key {stated} of the test",
                )
            changed[name] = _value(group, name, value, names[name], control)
        settings = replace(settings, **{group: replace(part, **changed)})
    return settings


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

# a name becomes a file name, so it must not contain path or shell characters
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
"""Possible responses of a surface; the first four are those of CG-D-39-80."""

Text = Annotated[str, StringConstraints(max_length=2000)]

_MOST = 999_999_999  # maximum count: fits in a netCDF integer


class _SpecSection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True, allow_inf_nan=False)


class _CampaignSection(_SpecSection):
    """``[campaign]``: people, subject and terms of use."""

    id: Identifier
    title: Text
    institution: Text = ""
    source: Text = ""
    synthetic: bool = False
    """Whether the data are synthetic; every product then says so."""
    references: Text = ""
    license: Text = ""
    summary: Text = ""
    comment: Text = ""
    tests: Text = ""
    """A CSV with one row per test, in addition to or instead of ``[tests.*]``."""
    results: Text = ""
    """A CSV with one row per outcome without a log."""


class SpecimenSection(_SpecSection):
    """``[specimens.NAME]``: the specimen before its first test."""

    kind: Literal["rubber tether", "stretch hose", "rope", "wire", "elastomer", "other"]
    material: Text = ""
    construction: Text = ""
    condition: Text = ""
    diameter: tuple[PositiveLength, ...] | PositiveLength = ()
    """Readings before stretch; the nominal area uses their mean."""
    area: tuple[PositiveArea, ...] | PositiveArea = ()
    """Readings of the area before stretch, for a specimen without a diameter."""
    width: tuple[PositiveLength, ...] | PositiveLength = ()
    """Width of a strip, used with ``thickness``: readings before stretch."""
    thickness: tuple[PositiveLength, ...] | PositiveLength = ()
    density: PositiveDensity | None = None
    """Density of the material: with ``linear_density`` it gives the area."""
    stretched_diameter: dict[str, tuple[PositiveLength, ...]] = Field(default_factory=dict)
    """Readings at a stretch, by stretch: ``{ "10 %" = ["0.997 in", "0.980 in"] }``."""
    rated_break_strength: Force | None = None
    rated_break_strength_source: Text = ""
    linear_density: Annotated[float, InSI("linear_density", above=0.0)] | None = None
    """Mass per length in air."""
    wet_linear_density: Annotated[float, InSI("linear_density")] | None = None
    """Mass per length minus that of the displaced water."""
    gauge_length: PositiveLength | None = None
    gauge_length_standard_uncertainty: PositiveLength | None = None
    reference_tension: PositiveForce | None = None
    """Tension at which the gauge length was read; default slack."""
    earlier_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Tension cycles before the first test of the campaign; default none."""
    earlier_flex_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Flexing cycles before it; unknown if omitted."""
    note: Text = ""

    @field_validator("reference_tension", mode="before")
    @classmethod
    def _share_of_own_strength(cls, value: object, info: ValidationInfo) -> object:
        """Convert a share of the break strength by that of the specimen, stated above it."""
        strength = info.data.get("rated_break_strength")
        if strength is None or not isinstance(value, str) or "%" not in value:
            return value
        return f"{parse_quantity(value, 'force', rated_break_strength=strength)!r} N"


class _StrainSection(_SpecSection):
    """``strain = { method = "...", marks = "marks.csv" }``."""

    method: StrainMethod | None = None
    marks: Text = ""


class _FilePiece(_SpecSection):
    """One file of a record in pieces."""

    file: Text
    layout: Identifier | None = None


class _Kept(_SpecSection):
    """Information that a laboratory keeps on a test; stored unchanged in the product."""

    layout: Identifier | None = None
    specimens: tuple[Identifier, ...] = ()
    control: Control = "position"
    waveform: Waveform = "triangular"
    rate: Text = ""
    """``1 ft/s``, ``3 cycles per minute``; compared with the log, as are the two keys below."""
    frequency: Text = ""
    mean_tension: Text = ""
    medium: Text = ""
    """``dry``, ``wet``, ``soaked since ...``."""
    soak: Text = ""
    temperature: Text = ""
    machine: Text = ""
    load_cell: Text = ""
    calibration_due: Date = ""
    operator: Text = ""
    procedure: Text = ""
    note: Text = ""
    strain: _StrainSection = _StrainSection()
    reduction: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """By group of `reduction.record.settings`: ``reduction.cycles.trim_threshold = 0.95``."""


class Defaults(_Kept):
    """``[defaults]``: values for all tests that do not state their own."""

    kind: TestKind = "cyclic"


class StepSection(_SpecSection):
    """``[[tests.ID.steps]]``: one step of a log with several."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, defer_build=True, allow_inf_nan=False, populate_by_name=True
    )

    name: StepName
    start: str | int = Field(alias="from")
    """A time with its unit, or a cycle number of the whole log."""
    end: str | int = Field(alias="to")
    kind: TestKind | None = None
    target_strain: tuple[Strain, ...] = ()
    n_cycles: int | None = Field(default=None, ge=1, le=_MOST)
    failed: bool | None = None
    """As for a test."""
    note: Text = ""


def _has_angle(text: str) -> str:
    """The text of an angle, unchanged after a check."""
    value_in_si(text, "angle")
    return text


class TestSection(_Kept):
    """``[tests.ID]``: one test; missing keys are taken from ``[defaults]``."""

    __test__ = False  # a test of a tether, not of this software

    kind: TestKind | None = None
    file: Text | tuple[_FilePiece, ...] = ""
    """Required, here or in the table of tests."""
    order: int | None = Field(default=None, ge=-_MOST, le=_MOST)
    """Position in the history of the specimens."""
    part_of: Identifier | None = None
    """The test of which this log repeats a part; its cycles are counted only once."""
    date: Date = ""
    rest: Text = ""
    """Rest time before this test."""
    target_strain: tuple[Strain, ...] = ()
    n_cycles: int | None = Field(default=None, ge=1, le=_MOST)
    unlogged_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Tension cycles without a log between the previous test and this one."""
    n_flex_cycles: int | None = Field(default=None, ge=0, le=_MOST)
    """Flexing cycles during this test."""
    flex_angle: Annotated[str, AfterValidator(_has_angle)] | None = None
    """Half the range of flexing: ``30 deg`` to either side."""
    failed: bool | None = None
    """Whether the specimens broke, according to the laboratory; otherwise found from the log."""
    steps: tuple[StepSection, ...] = ()

    @field_validator("file", mode="before")
    @classmethod
    def _pieces_are_tables(cls, value: object) -> object:
        """Refuse a plain list of file names, which has no layout for each piece."""
        if isinstance(value, list | tuple) and any(isinstance(entry, str) for entry in value):
            raise SettingsError(
                "the files of a record are not given as tables",
                found=repr(value),
                needed='a file name, or a list such as [{ file = "a.csv" }, { file = "b.csv" }]',
            )
        return value


class ExperimentSection(_SpecSection):
    """``[experiments.NAME]``: cyclic tests or steps that give one set of response surfaces."""

    kind: Literal["box-behnken", "plackett-burman"]
    factors: dict[Identifier, tuple[str, str]]
    """Low and high level by factor: ``"0.1 Hz"``, ``"12 %RBS"``, ``"40 % of mean"``."""
    runs: dict[RunName, tuple[float, ...]]
    """Planned coded levels, by test or test/step; the achieved ones come from the logs."""
    quasi_static: dict[Identifier, Text] = Field(default_factory=dict)
    """Test (or test/step) with the slow pull, by specimen."""
    responses: tuple[Response, ...] = get_args(Response)[:4]
    transform: dict[Response, Literal["none", "log", "box-cox", "log-times-frequency"]] = Field(
        default_factory=dict
    )
    specimens_as: Literal["blocks", "random"] = "blocks"
    """Treatment of several specimens of one line: a mean of each, or draws from a population."""
    """Also fit surfaces with only the terms kept by AICc."""


class CampaignFile(_SpecSection):
    """The whole of campaign.toml."""

    campaign: _CampaignSection
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
    report: _ReportSection | None = None
    limits: _LimitsSection = _LimitsSection()
