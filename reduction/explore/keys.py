"""What may be moved: the keys of a test in campaign.toml that steer its reduction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from reduction.settings import StrainMethod

Group = Literal[
    "Trim and cycles",
    "Modulus windows",
    "Splice correction",
    "Phases",
    "Holds",
    "Rope",
    "Slips",
    "Flags",
]
"""Headings, in the order of the page."""
_CYCLIC = ("cyclic", "fatigue", "snap", "bedding-in")


@dataclass(frozen=True)
class Slider:
    """Ends and step of a slider, in the unit that is written behind its number."""

    low: float
    high: float
    step: float
    unit: str = ""


@dataclass(frozen=True)
class Setting:
    """One key of ``[tests.ID]``.

    ``key`` is ``GROUP.NAME`` below ``reduction``, or a key of the test itself; ``choices`` are
    the words that it may have. It is offered for the ``kinds`` of test; for all where empty.
    """

    key: str
    group: Group
    words: str
    choices: tuple[str, ...] = ()
    slider: Slider | None = None
    kinds: tuple[str, ...] = ()

    @property
    def path(self) -> tuple[str, ...]:
        """Keys below ``[tests.ID]``."""
        parts = tuple(self.key.split("."))
        return parts if self.key in _OF_TEST else ("reduction", *parts)


_OF_TEST = ("control", "waveform", "strain.method")
_SHARE = Slider(0.5, 1.0, 0.005)
SETTINGS: tuple[Setting, ...] = (
    Setting(
        "cycles.trim_threshold", "Trim and cycles",
        "rate over plateau that keeps a sample: higher cuts more of both ends",
        slider=_SHARE, kinds=_CYCLIC,
    ),
    Setting(
        "cycles.break_in_cycles", "Trim and cycles", "first cycles left out of every mean",
        slider=Slider(0, 20, 1), kinds=_CYCLIC,
    ),
    Setting(
        "cycles.band", "Trim and cycles", "smallest range that makes a reversal", kinds=_CYCLIC
    ),
    Setting(
        "waveform", "Trim and cycles", "how ends are trimmed and the loop area is taken",
        choices=("triangular", "sinusoidal", "other"), kinds=_CYCLIC,
    ),
    Setting(
        "control", "Trim and cycles", "channel on which reversals are found",
        choices=("position", "load"),
    ),
    Setting(
        "modulus.strain_bin_width", "Modulus windows", "spacing of the strain grid",
        slider=Slider(0.25, 10.0, 0.25, "%"),
    ),
    Setting(
        "modulus.window", "Modulus windows", "width of the regression window",
        slider=Slider(0.5, 30.0, 0.5, "%"),
    ),
    Setting(
        "modulus.minimum_count", "Modulus windows", "fewest samples in a window that give a slope"
    ),
    Setting(
        "modulus.maximum_segments", "Modulus windows", "most straight segments tried",
        slider=Slider(1, 8, 1), kinds=_CYCLIC,
    ),
    Setting(
        "modulus.segment_tolerance", "Modulus windows",
        "distance of the segments from the branch, as a share of its tension range",
        kinds=_CYCLIC,
    ),
    Setting(
        "modulus.selected_cycles", "Modulus windows",
        "longest test of which every cycle's curve is kept", kinds=_CYCLIC,
    ),
    Setting(
        "modulus.stress_at_strain", "Modulus windows", "elongations at which stress is given"
    ),
    Setting(
        "strain.method", "Splice correction", "how position becomes strain of the free length",
        choices=get_args(StrainMethod),
    ),
    Setting("phases.minimum_duration", "Phases", "shortest standstill"),
    Setting("phases.position_tolerance", "Phases", "range of position inside a standstill"),
    Setting("phases.tension_tolerance", "Phases", "range of tension inside a hold at one tension"),
    Setting("phases.slack_tension", "Phases", "a standstill at or below it is a rest"),
    Setting("holds.minimum_duration", "Holds", "shortest hold that gives relaxation numbers"),
    Setting(
        "holds.maximum_terms", "Holds", "most Prony terms tried", slider=Slider(1, 5, 1)
    ),
    Setting("holds.times", "Holds", "times after the ramp at which tension is given"),
    Setting("rope.last_cycles", "Rope", "last cycles that give the dynamic stiffness"),
    Setting("rope.reference_time", "Rope", "time after loading of the static stiffness"),
    Setting("rope.failure_share", "Rope", "share of the median peak below which it failed"),
    Setting("slip.minimum_cycles", "Slips", "shortest test in which slips are looked for",
            kinds=_CYCLIC),
    Setting("slip.false_alarm", "Slips", "chance that a sound specimen shows a slip",
            kinds=_CYCLIC),
    Setting("quality.stuck_samples", "Flags", "equal values that are stuck"),
    Setting("quality.spike_factor", "Flags", "deviations off both neighbours that are a spike"),
    Setting("quality.gap_factor", "Flags", "median steps that are a gap"),
    Setting("quality.rate_tolerance", "Flags", "share by which a step may differ"),
)  # fmt: skip
_BY_KEY = {one.key: one for one in SETTINGS}


def setting_of(key: str) -> Setting | None:
    """The setting of a key; None where it is not offered."""
    return _BY_KEY.get(key)


def settings_of_kind(kind: str) -> list[Setting]:
    """Settings that steer a kind of test; of weights hung by hand there is none."""
    if kind == "stepwise":
        return []
    return [one for one in SETTINGS if not one.kinds or kind in one.kinds]
