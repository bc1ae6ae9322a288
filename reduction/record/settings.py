"""Every setting of the reduction, with its default.

The pure stages take these; `reduction.campaign` fills them from campaign.toml.
A value of None means: found by the stated first pass over the whole record, and
written into the product, so that reading in pieces changes nothing.  `Limits` alone changes no
number and stands in no product.
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
"""Of the channel that the machine drives, as it was programmed."""

Control = Literal["position", "load"]
"""Channel that the machine drives."""


@dataclass(frozen=True)
class QualitySettings:
    """When a sample is flagged (nothing is deleted)."""

    stuck_samples: int = 50
    """A channel repeating one value this often while the crosshead moves is stuck. [1]"""
    spike_factor: float = 12.0
    """Samples, ten at most, this many robust deviations off their neighbours are a spike. [1]"""
    gap_factor: float = 3.5
    """A time step this many median steps long is a gap. [1]"""
    rate_tolerance: float = 0.2
    """A record whose steps differ by more than this share from their median says so. [1]"""


@dataclass(frozen=True)
class PhaseSettings:
    """When the crosshead stands still."""

    minimum_duration: float = 3.0
    """Shortest standstill that is a hold or a rest. [s]"""
    position_tolerance: float | None = None
    """Range of position inside a standstill; None: from the record's noise. [m]"""
    tension_tolerance: float | None = None
    """Range of tension inside a hold at constant tension; None: from its noise. [N]"""
    slack_tension: float | None = None
    """A standstill at or below this tension is a rest; None: from the record. [N]"""


@dataclass(frozen=True)
class StrainSettings:
    """How position becomes strain of the splice-free length."""

    method: StrainMethod | None = None
    """None: tension-driven where the pooled marks span a factor of 2 in tension, else marks."""


@dataclass(frozen=True)
class CycleSettings:
    """What a cycle is, and which part of a branch has a constant rate."""

    control: Control = "position"
    """Channel on which reversals are found."""
    waveform: Waveform = "triangular"
    band: float | None = None
    """Smallest range that makes a reversal; None: from the record. [m] or [N]"""
    trim_threshold: float = 0.97
    """A sample is kept in the trimmed branch while its rate is this share of the plateau. [1]"""
    expected_cycles: int | None = None
    """Number of cycles the test plan asks for; a difference is a note. [1]"""
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
    """When a hold supports a relaxation or creep number."""

    minimum_duration: float = 30.0
    """Shortest hold that is fitted. [s]"""
    maximum_terms: int = 3
    """Largest number of Prony terms tried. [1]"""
    times: tuple[float, ...] = (1.0, 10.0, 60.0, 180.0, 600.0, 3600.0)
    """Times after the ramp at which tension is reported. [s]"""


@dataclass(frozen=True)
class SlipSettings:
    """When a drop of peak tension from cycle to cycle is a step and not creep."""

    minimum_cycles: int = 50
    """Shortest run of cycles in which steps are looked for. [1]"""
    false_alarm: float = 0.001
    """Chance that a record without steps shows one. [1]"""


@dataclass(frozen=True)
class RopeSettings:
    """What the steps of a rope programme are read at."""

    last_cycles: int = 10
    """Cycles at the end of a step over which its dynamic stiffness is taken. [1]"""
    reference_time: float = 600.0
    """Time after loading at which the static stiffness between two holds stands. [s]"""
    failure_share: float = 0.5
    """A peak below this share of the median peak, to the end, is a failure. [1]"""


@dataclass(frozen=True)
class _ArchiveSettings:
    """Which samples an archive holds."""

    samples: StoredSamples | None = None
    """Every one, or those of selected cycles and outside cycles; None: by the longest record."""
    longest_record: int = 1_000_000
    """Longest record stored whole; of a longer one about a quarter of this at most. [1]"""


@dataclass(frozen=True)
class Limits:
    """What one log may be before it is refused; no number depends on it."""

    file_size: int = 100_000_000_000
    """Largest file. [byte]"""
    unpacked_size: int = 2_500_000_000
    """Memory that a file which is read whole, or one piece of another, may unpack to. [byte]"""
    line_length: int = 1_000_000
    """Longest line of a text. [byte]"""
    columns: int = 10_000
    """Most columns. [1]"""
    time: float = 3600.0
    """Longest time for reading it, looked at between blocks. [s]"""


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
