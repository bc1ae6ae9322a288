"""All settings of the reduction, with their defaults.

The pure stages take these; `reduction.campaign` fills them from campaign.toml. None means that the
value is found in a first pass over the whole record and written into the product, so that reading
in pieces does not change it.  `Limits` affects no number and is not stored in any product.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

StrainMethod = Literal[
    "marks",
    "strain-ratio",
    "tension-driven",
    "mixed",
    "constant-fraction",
    "extensometer",
    "gauge-length",
]

StoredSamples = Literal["selected", "all"]

Waveform = Literal["triangular", "sinusoidal", "other"]
"""Programmed waveform of the channel that the machine drives."""

Control = Literal["position", "load"]
"""Channel that the machine drives."""


@dataclass(frozen=True)
class QualitySettings:
    """Criteria for flagging a sample (nothing is deleted)."""

    stuck_samples: int = 50
    """A channel repeating one value this often while the crosshead moves is stuck. [1]"""
    spike_factor: float = 12.0
    """Up to ten samples this many robust deviations off their neighbours are a spike. [1]"""
    gap_factor: float = 3.5
    """A time step this many median steps long is a gap. [1]"""
    rate_tolerance: float = 0.2
    """A note is raised if steps differ by more than this share from their median. [1]"""


@dataclass(frozen=True)
class PhaseSettings:
    """Criteria for a standstill of the crosshead."""

    minimum_duration: float = 3.0
    """Minimum duration of a hold or rest. [s]"""
    position_tolerance: float | None = None
    """Range of position inside a standstill; None: from the record's noise. [m]"""
    tension_tolerance: float | None = None
    """Range of tension inside a hold at constant tension; None: from its noise. [N]"""
    slack_tension: float | None = None
    """A standstill at or below this tension is a rest; None: from the record. [N]"""


@dataclass(frozen=True)
class StrainSettings:
    """Conversion of position to strain of the splice-free length."""

    method: StrainMethod | None = None
    """None: mixed if the specimen has marks, else extensometer or gauge-length."""


@dataclass(frozen=True)
class CycleSettings:
    """Definition of a cycle, and of the constant-rate part of a branch."""

    control: Control = "position"
    """Channel on which reversals are found."""
    waveform: Waveform = "triangular"
    band: float | None = None
    """Smallest range that makes a reversal; None: from the record. [m] or [N]"""
    trim_threshold: float = 0.97
    """A sample is kept in the trimmed branch while its rate is this share of the plateau. [1]"""
    expected_cycles: int | None = None
    """Number of cycles in the test plan; a difference raises a note. [1]"""
    break_in_cycles: int = 0
    """Cycles left out of every mean over cycles. [1]"""


@dataclass(frozen=True)
class ModulusSettings:
    """Grid and window of the tangent modulus."""

    strain_bin_width: float | None = None
    """Spacing of the strain grid; None: a round number near a fortieth of the stroke. [1]"""
    window: float | None = None
    """Width of the regression window; None: five bins, more where samples are few. [1]"""
    minimum_count: int = 4
    """Fewest samples in a window that give a slope. [1]"""
    maximum_segments: int = 5
    """Largest number of piecewise-linear segments tried. [1]"""
    segment_tolerance: float = 0.01
    """Rms distance of the segments from the branch, as a share of its tension range. [1]"""
    stress_at_strain: tuple[float, ...] = (0.5, 1.0, 2.0)
    """Elongations at which stress is reported (M50, M100, M200). [1]"""
    selected_cycles: int = 24
    """Longest test of which all cycles' curves are kept; longer: first, last, log-spaced. [1]"""


@dataclass(frozen=True)
class HoldSettings:
    """Criteria for relaxation or creep results from a hold."""

    minimum_duration: float = 30.0
    """Shortest hold that is fitted. [s]"""
    maximum_terms: int = 3
    """Largest number of Prony terms tried. [1]"""
    times: tuple[float, ...] = (1.0, 10.0, 60.0, 180.0, 600.0, 3600.0)
    """Times after the ramp at which tension is reported. [s]"""


@dataclass(frozen=True)
class SlipSettings:
    """Criteria for a step in peak tension from cycle to cycle, as opposed to creep."""

    minimum_cycles: int = 50
    """Shortest run of cycles searched for steps. [1]"""
    false_alarm: float = 0.001
    """Probability of a false step in a record without steps. [1]"""


@dataclass(frozen=True)
class RopeSettings:
    """Settings for the steps of a rope programme."""

    last_cycles: int = 10
    """Cycles at the end of a step over which its dynamic stiffness is taken. [1]"""
    reference_time: float = 600.0
    """Time after loading used for the static stiffness between two holds. [s]"""
    failure_share: float = 0.5
    """A peak below this share of the median peak, to the end, is a failure. [1]"""


@dataclass(frozen=True)
class _ArchiveSettings:
    """Samples stored in an archive."""

    samples: StoredSamples | None = None
    """All samples, or selected cycles and samples outside cycles; None: by the longest record."""
    longest_record: int = 1_000_000
    """Longest record stored in full; a longer one keeps at most about a quarter of this. [1]"""


@dataclass(frozen=True)
class Limits:
    """Limits on one log before it is refused; they affect no number."""

    file_size: int = 100_000_000_000
    """Maximum file size. [byte]"""
    unpacked_size: int = 2_500_000_000
    """Maximum unpacked size of a file read whole, or of one piece of another file. [byte]"""
    line_length: int = 1_000_000
    """Maximum length of a text line. [byte]"""
    columns: int = 10_000
    """Maximum number of columns. [1]"""
    time: float = 3600.0
    """Maximum reading time, checked between blocks. [s]"""


@dataclass(frozen=True)
class ReductionSettings:
    """All settings of one test."""

    quality: QualitySettings = field(default_factory=QualitySettings)
    phases: PhaseSettings = field(default_factory=PhaseSettings)
    strain: StrainSettings = field(default_factory=StrainSettings)
    cycles: CycleSettings = field(default_factory=CycleSettings)
    modulus: ModulusSettings = field(default_factory=ModulusSettings)
    holds: HoldSettings = field(default_factory=HoldSettings)
    slip: SlipSettings = field(default_factory=SlipSettings)
    rope: RopeSettings = field(default_factory=RopeSettings)
    archive: _ArchiveSettings = field(default_factory=_ArchiveSettings)
