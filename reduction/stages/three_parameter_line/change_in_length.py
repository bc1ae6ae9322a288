r"""The six change-in-length properties of rope practice.

**Definitions of the six change-in-length properties, and the numbers they are made from.** A step
has the form in an archive: one specimen, numbers without samples.

**The six change-in-length properties of rope practice, from the steps of a programme.** [1]_ names
original, static and dynamic stiffness, and construction, polymer and working strain, from one
programme of many steps.  Only its abstract was read, which gives no formula: the definitions
are this package's interpretation of the names.

================== =====================================================================
original stiffness chord of the first rise of a new rope, end to end
static stiffness   secant between two held tensions, at a time after the upper one was applied
dynamic stiffness  apparent spring constant, mean over the last cycles of a level
construction       strain left by bedding-in at equal tension, first rise and cycles
polymer            :math:`c \log_{10}(t / t_{ref})` to the end of a hold, c its creep a decade
working            :math:`(T_h - T_l) / K_s(t_{ref})` of a rope that has been bedded in
================== =====================================================================

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length Properties
   of Fibre Rope," OIPEEC (abstract).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, read_only_arrays

PropertyName = Literal[
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
]

PROPERTY_NAMES: tuple[PropertyName, ...] = (
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
)
"""In the order of the abstract."""

_NAN = float("nan")

MANY = float("inf")
"""Degrees of freedom of a regression on many samples. [1]"""

RISE_GAP = 1.5
"""A rise has a gap where its strains are further apart than this, over the grid's spacing."""


def _none_shared() -> Floats:
    return np.empty(0)


@dataclass(frozen=True)
@read_only_arrays
class StepNumber:
    """A number of a step, with the two parts of its uncertainty.

    Parameters
    ----------
    value, random_standard_uncertainty : float
        The uncertainty is the part that is not shared with other numbers. [as the quantity]
    contribution : ndarray, shape (n_components,)
        Signed effect of each error shared by the numbers of the step. [as the quantity]
    degrees_of_freedom : float
        Of the random part. [1]
    """

    value: float
    random_standard_uncertainty: float
    contribution: Floats = field(default_factory=_none_shared)
    degrees_of_freedom: float = MANY


@dataclass(frozen=True)
@read_only_arrays
class FirstRise:
    """Tension on the first rise of a test, at two or more strains, all of them known.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        Rising; it has a gap where the rise was held or has too few samples. [1]
    tension, tension_random_standard_uncertainty : ndarray, shape (n_points,)
        [N]
    spacing : float
        Spacing of the grid of the strains. [1]
    strain_contribution, tension_contribution : ndarray, shape (n_components, n_points)
        Effect of each shared error on the points. [1], [N]
    """

    strain: Floats
    tension: Floats
    tension_random_standard_uncertainty: Floats
    spacing: float
    strain_contribution: Floats
    tension_contribution: Floats


@dataclass(frozen=True)
@read_only_arrays
class BeddingCycles:
    """Cycles that bed a rope in.

    Parameters
    ----------
    first_stiffness : StepNumber
        Secant of the first cycle. [N]
    permanent_strain : StepNumber
        Shift of the foot of the loop, at equal tension. [1]
    foot_strain : float
        Strain at the foot of the first cycle. [1]
    foot_strain_contribution : ndarray, shape (n_components,)
        Effect of each shared error on that strain. [1]
    valley_tension, first_peak_tension, peak_tension : float
        Valley and peak of the first cycle, and the greatest peak of all. [N]
    """

    first_stiffness: StepNumber
    permanent_strain: StepNumber
    foot_strain: float
    foot_strain_contribution: Floats
    valley_tension: float
    first_peak_tension: float
    peak_tension: float


@dataclass(frozen=True)
class CyclicLevel:
    """Dynamic stiffness of one level: mean over its last cycles. [N]."""

    stiffness: StepNumber
    mean_tension: float
    tension_amplitude: float


@dataclass(frozen=True)
class PairOfHolds:
    """Static stiffness [N] between two held tensions [N]; NaN with a reason where there is none.

    A number may also have a ``reason``: that the line was read beyond the hold.
    """

    low_tension: StepNumber
    high_tension: StepNumber
    stiffness: StepNumber
    reference_time: float
    reason: str = ""


@dataclass(frozen=True)
class HeldTension:
    """Creep a decade [1] of one hold at a tension [N]; NaN with a reason.

    ``end_time`` [s] is that of the hold since the centre of the ramp to it.
    """

    tension: float
    end_time: float
    creep_per_decade: StepNumber
    reason: str = ""


@dataclass(frozen=True)
@read_only_arrays
class StepOfProgramme:
    """One step of the programme of one specimen; parts that it does not have are None, or empty.

    Parameters
    ----------
    name : str
        Name of the test or step.
    reference_time : float
        Time after loading from which polymer strain counts. [s]
    first_rise : FirstRise or None
        First rise of the test.
    bedding : BeddingCycles or None
        For a step that beds the rope in.
    level : CyclicLevel or None
        For a step of cycles of a settled rope.
    pairs : tuple of PairOfHolds
        In order of time.
    holds : tuple of HeldTension
        In order of time.
    strength_contribution : ndarray, shape (n_components,)
        Relative effect of each error shared by the step on the rated break strength. [1]
    """

    name: str
    reference_time: float
    first_rise: FirstRise | None = None
    bedding: BeddingCycles | None = None
    level: CyclicLevel | None = None
    pairs: tuple[PairOfHolds, ...] = ()
    holds: tuple[HeldTension, ...] = ()
    strength_contribution: Floats = field(default_factory=_none_shared)


@dataclass(frozen=True)
@read_only_arrays
class ChangeInLength:
    """One property between two tensions; NaN with a reason where the record does not support it.

    Parameters
    ----------
    name : str
        One of the six.
    value, random_standard_uncertainty : float
        [N] for a stiffness, [1] for a strain.
    over_strength, over_strength_random_standard_uncertainty : float
        A stiffness over the rated break strength; NaN for a strain. [1]
    low_tension, high_tension : float
        Range in which it holds; the same number twice for a hold. [N]
    reference_time : float
        Time to which it refers, if any. [s]
    step : str
        Step from which it is taken.
    reason : str
        Reason for a missing number, or parts that are not included.
    contribution, over_strength_contribution : ndarray, shape (n_components,)
        Signed effect of each error shared by the numbers of that step. [as the number]
    degrees_of_freedom : float
        Of the random part. [1]
    """

    name: PropertyName
    value: float = _NAN
    random_standard_uncertainty: float = _NAN
    over_strength: float = _NAN
    over_strength_random_standard_uncertainty: float = _NAN
    low_tension: float = _NAN
    high_tension: float = _NAN
    reference_time: float = _NAN
    step: str = ""
    reason: str = ""
    contribution: Floats = field(default_factory=_none_shared)
    over_strength_contribution: Floats = field(default_factory=_none_shared)
    degrees_of_freedom: float = MANY

    @property
    def is_stiffness(self) -> bool:
        """True for a stiffness, in N; False for a strain."""
        return self.name.endswith("stiffness")

    def with_number(self, number: StepNumber) -> ChangeInLength:
        """Return the property with the value of a number of its step."""
        return replace(
            self,
            value=number.value,
            random_standard_uncertainty=number.random_standard_uncertainty,
            contribution=number.contribution,
            degrees_of_freedom=number.degrees_of_freedom,
        )

    @property
    def standard_uncertainty(self) -> float:
        """Shared and random parts together."""
        return _together(self.contribution, self.random_standard_uncertainty)


def _together(contribution: Floats, random: float) -> float:
    return float(np.sqrt(np.sum(contribution**2) + random**2))


def _construction_strain(
    steps: Sequence[StepOfProgramme], before: str, before_cycles: str
) -> ChangeInLength:
    """Strain left by bedding-in at equal tension, on the first rise and in the cycles.

    Notes
    -----
    A name of [1]_.  It is the permanent strain of the cycles plus the distance of their first foot
    from the first rise at the same tension.  One load cell reads that tension in both places,
    so that its errors affect neither; an error of strain adds its difference between
    them.

    Examples
    --------
    >>> print(_construction_strain([], "", "").reason)
    there is no bedding-in step
    """
    absent = ChangeInLength("construction strain")
    place = _bedded_in(steps)
    if place is None:
        return replace(absent, reason="there is no bedding-in step")
    one = steps[place]
    absent = replace(absent, step=one.name)
    if before or place > 0:
        why = before or f"it had been loaded in {steps[0].name}"
        return replace(absent, reason=f"{why}: what was left before the bedding-in is not known")
    cycles = one.bedding
    if cycles is None or np.isnan(cycles.permanent_strain.value):
        return replace(absent, reason="the cycles give no permanent strain")
    found = absent.with_number(cycles.permanent_strain)
    reason = "from the cycles alone: the first rise does not pass the tension of their valleys"
    at_valley = _on_first_rise(one.first_rise, cycles)
    on_rise = at_valley is not None and np.isfinite(at_valley.value)
    if before_cycles and not on_rise:
        return replace(absent, reason=before_cycles)
    if at_valley is not None and not on_rise:
        reason = "the first valley is taken to be on the first rise, which has a hold there"
    elif at_valley is not None:
        reason = ""
        # the random error at the first foot is in the permanent strain with the opposite sign
        found = replace(
            found,
            value=found.value + cycles.foot_strain - at_valley.value,
            random_standard_uncertainty=float(
                np.hypot(found.random_standard_uncertainty, at_valley.random_standard_uncertainty)
            ),
            contribution=(
                found.contribution + cycles.foot_strain_contribution - at_valley.contribution
            ),
        )
    return replace(
        found, low_tension=cycles.valley_tension, high_tension=cycles.peak_tension, reason=reason
    )


def _bedded_in(steps: Sequence[StepOfProgramme]) -> int | None:
    """Place of the first step that beds the rope in.

    Notes
    -----
    Before that step the rope is in its state of manufacture ([1]_).

    Examples
    --------
    >>> print(_bedded_in([StepOfProgramme("Q", 600.0)]))
    None
    """
    return next((place for place, one in enumerate(steps) if one.bedding is not None), None)


def _on_first_rise(rise: FirstRise | None, cycles: BeddingCycles) -> StepNumber | None:
    """Strain where the rise first reaches the tension of the valleys; None where it never does.

    NaN where the rise has a gap there: it was held, and the cycles begin from the hold.
    """
    tension = cycles.valley_tension
    if rise is None or not rise.tension[0] <= tension <= rise.tension.max():
        return None
    place = max(int(np.argmax(rise.tension >= tension)), 1)
    strain, load, doubt = (
        part[place - 1 : place + 1]
        for part in (rise.strain, rise.tension, rise.tension_random_standard_uncertainty)
    )
    rows = rise.strain_contribution[:, place - 1 : place + 1]
    if strain[1] - strain[0] > RISE_GAP * rise.spacing:
        return StepNumber(_NAN, _NAN)
    slope = float(load[1] - load[0]) / float(strain[1] - strain[0])
    share = float(load[1] - tension) / float(load[1] - load[0])
    return StepNumber(
        float(strain[1] - (load[1] - tension) / slope),
        float(doubt[1]) / slope,
        rows[:, 1] - share * (rows[:, 1] - rows[:, 0]),
    )


_HELD = "the first loading paused in a hold: the strain gained in it is included"

_NO_RISE = (
    "the first step has no curve of its first loading: its log must begin slack and, unless it is "
    "a bedding-in step, the diameter must be stated"
)

_NO_PAIR = "no step has a hold at a higher tension than the hold before it"

_NO_ORDER = "the order of the tests is not stated"


def change_in_length(
    steps: Sequence[StepOfProgramme],
    *,
    loaded_before: str = "",
    loaded_in_step: str = "",
    is_ordered: bool = True,
    missing: str = "",
    rated_break_strength: float = _NAN,
) -> tuple[ChangeInLength, ...]:
    """Six change-in-length properties of one rope, from the steps of its programme.

    Notes
    -----
    Every number is taken from an earlier stage, or by one line of arithmetic from it.  A shared
    error goes through that line with its sign, a random one by its square: a zero of
    the load cell cancels in a chord, and its gain in a working strain.  The foot of the first
    cycle, which is in both parts of a construction strain with opposite signs, adds nothing to it.
    Construction strain includes the polymer strain gained in the minutes of the bedding-in.

    Examples
    --------
    >>> found = change_in_length([])
    >>> print(len(found), found[1].name, "--", found[1].reason)
    6 static stiffness -- no step has a hold at a higher tension than the hold before it
    """
    for one in steps:
        if not one.reference_time > 0:
            raise SettingsError(
                f"{one.name}: the reference time is not positive",
                found=f"{one.reference_time:g} s", needed="above 0 s",
            )  # fmt: skip
    before = loaded_before if is_ordered else _NO_ORDER
    found = (
        _original(steps, before, loaded_in_step),
        *_static(steps),
        *_dynamic(steps),
        _construction_strain(steps, before, loaded_in_step),
        *_polymer(steps),
        *_working(steps, is_ordered),
    )
    of_strength = {one.name: one.strength_contribution for one in steps}
    return tuple(
        _with_note(_over(one, rated_break_strength, of_strength.get(one.step)), missing)
        for one in found
    )


def _over(one: ChangeInLength, strength: float, of_strength: Floats | None) -> ChangeInLength:
    if not one.is_stiffness:
        return one
    rows = one.contribution / strength
    if rows.size and of_strength is not None and of_strength.size:
        rows = rows - one.value / strength * of_strength
    return replace(
        one,
        over_strength=one.value / strength,
        over_strength_random_standard_uncertainty=one.random_standard_uncertainty / strength,
        over_strength_contribution=rows,
    )


def _with_note(one: ChangeInLength, missing: str) -> ChangeInLength:
    """Name the missing tests, where the property may have been in one of them."""
    if not missing or one.step or np.isfinite(one.value):
        return one
    return replace(one, reason=f"{one.reason}; {missing}")


# if a first rise covers less of the first cycle than this, its curve rests on a few readings
_LEAST_OF_RISE = 0.5


def _original(steps: Sequence[StepOfProgramme], before: str, before_cycles: str) -> ChangeInLength:
    absent = ChangeInLength("original stiffness")
    if before:
        return replace(absent, reason=f"{before}: the first rise may not be in the logs")
    if not steps:
        return replace(absent, reason="there is no step")
    first = steps[0]
    absent = replace(absent, step=first.name)
    rise, cycles = first.first_rise, first.bedding
    reason = "there is no curve of the first rise; it needs a log that begins slack"
    if rise is not None:
        # a rope creeps on for a while as the load falls again: that is not part of its rise
        top = max(int(np.argmax(rise.tension)), 1)
    if rise is not None and cycles is not None:
        spanned = float(rise.tension[top] - rise.tension[0])
        if spanned < _LEAST_OF_RISE * (cycles.first_peak_tension - cycles.valley_tension):
            rise = None
            reason = f"the curve of the first rise covers only {spanned:.4g} N (too few readings)"
    if rise is not None:
        gain = float(rise.strain[top] - rise.strain[0])
        stiffness = float(rise.tension[top] - rise.tension[0]) / gain
        of_tension, of_strain = (
            rows[:, top] - rows[:, 0]
            for rows in (rise.tension_contribution, rise.strain_contribution)
        )
        spread = rise.tension_random_standard_uncertainty
        return replace(
            absent,
            value=stiffness,
            random_standard_uncertainty=float(np.hypot(spread[0], spread[top])) / gain,
            contribution=(of_tension - stiffness * of_strain) / gain,
            low_tension=float(rise.tension[0]),
            high_tension=float(rise.tension[top]),
            reason=(
                _HELD
                if float(np.diff(rise.strain[: top + 1]).max()) > RISE_GAP * rise.spacing
                else ""
            ),
        )
    if cycles is None:
        return replace(absent, reason=_NO_RISE)
    if before_cycles:
        return replace(absent, reason=before_cycles)
    return replace(
        absent.with_number(cycles.first_stiffness),
        low_tension=cycles.valley_tension,
        high_tension=cycles.first_peak_tension,
        reason=f"from the first cycle: {reason}",
    )


def _static(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = [_of_pair(one, pair) for one in steps for pair in one.pairs]
    return tuple(found) or (ChangeInLength("static stiffness", reason=_NO_PAIR),)


def _of_pair(step: StepOfProgramme, pair: PairOfHolds) -> ChangeInLength:
    bare = ChangeInLength(
        "static stiffness", low_tension=pair.low_tension.value,
        high_tension=pair.high_tension.value, reference_time=pair.reference_time,
        step=step.name, reason=pair.reason,
    )  # fmt: skip
    return bare.with_number(pair.stiffness)


def _dynamic(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = []
    for one in steps:
        level = one.level
        if level is None:
            continue
        bare = ChangeInLength(
            "dynamic stiffness", low_tension=level.mean_tension - level.tension_amplitude,
            high_tension=level.mean_tension + level.tension_amplitude, step=one.name,
            reason="" if np.isfinite(level.stiffness.value) else "no cycle of it has a stiffness",
        )  # fmt: skip
        found.append(bare.with_number(level.stiffness))
    # the cycles of bedding-in belong to a rope that is still settling
    none = "no step has cycles other than bedding-in"
    return tuple(found) or (ChangeInLength("dynamic stiffness", reason=none),)


def _polymer(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = []
    for one in steps:
        for hold in one.holds:
            absent = ChangeInLength(
                "polymer strain", low_tension=hold.tension, high_tension=hold.tension,
                reference_time=one.reference_time, step=one.name, reason=hold.reason,
            )  # fmt: skip
            creep = hold.creep_per_decade
            if hold.end_time <= one.reference_time and np.isfinite(creep.value):
                why = f"the hold ends at {hold.end_time:.4g} s, before the reference time"
                found.append(replace(absent, reason=why))
                continue
            decades = float(np.log10(hold.end_time / one.reference_time))
            found.append(
                replace(
                    absent,
                    value=decades * creep.value,
                    random_standard_uncertainty=decades * creep.random_standard_uncertainty,
                    contribution=decades * creep.contribution,
                )
            )
    none = "no step holds a constant tension"
    return tuple(found) or (ChangeInLength("polymer strain", reason=none),)


def _working(steps: Sequence[StepOfProgramme], is_ordered: bool) -> tuple[ChangeInLength, ...]:
    absent = ChangeInLength("working strain")
    place = _bedded_in(steps)
    if place is None:
        return (replace(absent, reason="no bedding-in step: it would include construction strain"),)
    if not is_ordered:
        return (replace(absent, reason=f"{_NO_ORDER}: a hold may be of a rope not bedded in"),)
    pairs = [(one, pair) for one in steps[place + 1 :] for pair in one.pairs]
    if not pairs:
        return (replace(absent, reason=_NO_PAIR),)
    return tuple(_working_of(_of_pair(one, pair), pair) for one, pair in pairs)


def _working_of(one: ChangeInLength, pair: PairOfHolds) -> ChangeInLength:
    """Rise over stiffness: a gain of the load cell is in both, and cancels in the strain."""
    rise = one.high_tension - one.low_tension
    strain = rise / one.value
    of_rise = pair.high_tension.contribution - pair.low_tension.contribution
    return replace(
        one,
        name="working strain",
        value=strain,
        random_standard_uncertainty=strain * one.random_standard_uncertainty / one.value,
        contribution=strain * (of_rise / rise - one.contribution / one.value),
    )
