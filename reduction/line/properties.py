r"""The six change-in-length properties of rope practice, from the steps of a programme.

[1]_ names original, static and dynamic stiffness, and construction, polymer and working strain,
from one programme of many steps.  It was read in its abstract alone, which gives no formula: the
definitions are this package's reading of the names.

================== =====================================================================
original stiffness chord of the first rise of a new rope, end to end
static stiffness   secant between two held tensions, at a time after the upper one was put on
dynamic stiffness  apparent spring constant, mean over the last cycles of a level
construction       strain that bedding-in left at equal tension, first rise and cycles
polymer            :math:`c \log_{10}(t / t_{ref})` to the end of a hold, c its creep a decade
working            :math:`(T_h - T_l) / K_s(t_{ref})` of a rope that has been bedded in
================== =====================================================================

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length
   Properties of Fibre Rope," OIPEEC (abstract).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.errors import SettingsError
from reduction.line.propertyproduct import (
    BeddingCycles,
    ChangeInLength,
    FirstRise,
    StepOfProgramme,
)

__all__ = ["change_in_length"]

_NAN = float("nan")
# strains further apart than this, over the grid's spacing, have a gap between them
_GAP = 1.5
_HELD = "the rise was held on its way: what it gained meanwhile is in it"
_NO_RISE = (
    "the first step has no curve of its first rise, which a log that begins slack gives, of "
    "another step than bedding-in with a diameter"
)
_NO_ORDER = "the order of the tests is not stated"


def change_in_length(
    steps: Sequence[StepOfProgramme],
    *,
    loaded_before: str = "",
    is_ordered: bool = True,
    missing: str = "",
    rated_break_strength: float = _NAN,
) -> tuple[ChangeInLength, ...]:
    """Six change-in-length properties of one rope, from the steps of its programme.

    Parameters
    ----------
    steps : sequence of StepOfProgramme
        In the order in which they were done.
    loaded_before : str, optional
        What the rope had carried before the first of them, in words; empty of a new rope.
    is_ordered : bool, optional
        Whether their order is known.
    missing : str, optional
        Which steps there are no numbers of, in words; it is told where a property is missing.
    rated_break_strength : float, optional
        NaN where not stated. [N]

    Returns
    -------
    properties : tuple of ChangeInLength
        At least one of each name, in the order of the abstract; one for each pair of holds, level
        or hold where a step has several.

    Raises
    ------
    SettingsError
        If a reference time is not positive.

    Notes
    -----
    Every number is that of a stage before, or one line of arithmetic with it; uncertainties are
    theirs, and those that enter together count as independent.  Construction strain holds what
    the polymer gained in the minutes of the bedding-in.

    Examples
    --------
    >>> found = change_in_length([])
    >>> print(len(found), found[1].name, "--", found[1].reason)
    6 static stiffness -- no step holds one tension after a lower one
    """
    for one in steps:
        if not one.reference_time > 0:
            raise SettingsError(
                f"{one.name}: the reference time is not positive",
                found=f"{one.reference_time:g} s", needed="above 0 s",
            )  # fmt: skip
    before = loaded_before if is_ordered else _NO_ORDER
    found = (
        _original(steps, before),
        *_static(steps),
        *_dynamic(steps),
        _construction(steps, before),
        *_polymer(steps),
        *_working(steps, is_ordered),
    )
    return tuple(_told(_over(one, rated_break_strength), missing) for one in found)


def _over(one: ChangeInLength, strength: float) -> ChangeInLength:
    if not one.is_stiffness:
        return one
    return replace(
        one,
        over_strength=one.value / strength,
        over_strength_standard_uncertainty=one.standard_uncertainty / strength,
    )


def _told(one: ChangeInLength, missing: str) -> ChangeInLength:
    """Say which tests are missing, where the property may have been in one of them."""
    if not missing or one.step or np.isfinite(one.value):
        return one
    return replace(one, reason=f"{one.reason}; {missing}")


def _original(steps: Sequence[StepOfProgramme], before: str) -> ChangeInLength:
    absent = ChangeInLength("original stiffness")
    if before:
        return replace(absent, reason=f"{before}: the first rise may not be in the logs")
    if not steps:
        return replace(absent, reason="there is no step")
    first = steps[0]
    absent = replace(absent, step=first.name)
    if first.first_rise is not None:
        strain, tension = first.first_rise.strain, first.first_rise.tension
        spread = first.first_rise.tension_standard_uncertainty
        gain = float(strain[-1] - strain[0])
        return replace(
            absent,
            value=float(tension[-1] - tension[0]) / gain,
            standard_uncertainty=float(np.hypot(spread[0], spread[-1])) / gain,
            low_tension=float(tension[0]),
            high_tension=float(tension[-1]),
            reason=_HELD if float(np.diff(strain).max()) > _GAP * first.first_rise.spacing else "",
        )
    if first.bedding is None:
        return replace(absent, reason=_NO_RISE)
    return replace(
        absent,
        value=first.bedding.first_stiffness,
        standard_uncertainty=first.bedding.first_stiffness_standard_uncertainty,
        low_tension=first.bedding.valley_tension,
        high_tension=first.bedding.first_peak_tension,
        reason=(
            "of the first cycle: there is no curve of the first rise, which a log that begins "
            "slack gives"
        ),
    )


def _static(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = [
        ChangeInLength(
            "static stiffness", pair.stiffness, pair.stiffness_standard_uncertainty,
            low_tension=pair.low_tension, high_tension=pair.high_tension,
            reference_time=pair.reference_time, step=one.name, reason=pair.reason,
        )
        for one in steps
        for pair in one.pairs
    ]  # fmt: skip
    none = "no step holds one tension after a lower one"
    return tuple(found) or (ChangeInLength("static stiffness", reason=none),)


def _dynamic(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = [
        ChangeInLength(
            "dynamic stiffness", one.level.stiffness, one.level.stiffness_standard_uncertainty,
            low_tension=one.level.mean_tension - one.level.tension_amplitude,
            high_tension=one.level.mean_tension + one.level.tension_amplitude, step=one.name,
            reason="" if np.isfinite(one.level.stiffness) else "no cycle of it has a stiffness",
        )
        for one in steps
        if one.level is not None
    ]  # fmt: skip
    # the cycles of bedding-in are of a rope that is still settling
    none = "no step is of cycles of a settled rope"
    return tuple(found) or (ChangeInLength("dynamic stiffness", reason=none),)


def _construction(steps: Sequence[StepOfProgramme], before: str) -> ChangeInLength:
    absent = ChangeInLength("construction strain")
    place = _bedded_in(steps)
    if place is None:
        return replace(absent, reason="no step beds the rope in")
    one = steps[place]
    absent = replace(absent, step=one.name)
    if before or place > 0:
        why = before or f"it had been loaded in {steps[0].name}"
        return replace(absent, reason=f"{why}: what was left before the bedding-in is not known")
    cycles = one.bedding
    if cycles is None or np.isnan(cycles.permanent_strain):
        return replace(absent, reason="the cycles give no permanent strain")
    value, spread = cycles.permanent_strain, cycles.permanent_strain_standard_uncertainty
    reason = "of the cycles alone: the first rise does not pass the tension of their valleys"
    at_valley = _on_first_rise(one.first_rise, cycles)
    if at_valley is not None and np.isnan(at_valley[0]):
        reason = "the first foot is taken to be on the first rise, which was held there"
    elif at_valley is not None:
        strain, doubt = at_valley
        value += cycles.foot_strain - strain
        spread = float(np.sqrt(spread**2 + cycles.foot_strain_standard_uncertainty**2 + doubt**2))
        reason = ""
    return replace(
        absent, value=value, standard_uncertainty=spread, low_tension=cycles.valley_tension,
        high_tension=cycles.peak_tension, reason=reason,
    )  # fmt: skip


def _bedded_in(steps: Sequence[StepOfProgramme]) -> int | None:
    """Place of the first step that beds the rope in; None where none does."""
    return next((place for place, one in enumerate(steps) if one.bedding is not None), None)


def _on_first_rise(rise: FirstRise | None, cycles: BeddingCycles) -> tuple[float, float] | None:
    """Strain and its uncertainty where the rise first has the valleys' tension; None if nowhere.

    NaN where the rise has a gap there: it was held, and the cycles begin from the hold.
    """
    tension = cycles.valley_tension
    if rise is None or not rise.tension[0] <= tension <= rise.tension.max():
        return None
    place = max(int(np.argmax(rise.tension >= tension)), 1)
    strain, load, doubt = (
        part[place - 1 : place + 1]
        for part in (rise.strain, rise.tension, rise.tension_standard_uncertainty)
    )
    if strain[1] - strain[0] > _GAP * rise.spacing:
        return _NAN, _NAN
    slope = float(load[1] - load[0]) / float(strain[1] - strain[0])
    return float(strain[1] - (load[1] - tension) / slope), float(doubt[1]) / slope


def _polymer(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    found = []
    for one in steps:
        for hold in one.holds:
            absent = ChangeInLength(
                "polymer strain", low_tension=hold.tension, high_tension=hold.tension,
                reference_time=one.reference_time, step=one.name, reason=hold.reason,
            )  # fmt: skip
            if hold.end_time <= one.reference_time and np.isfinite(hold.creep_per_decade):
                why = f"the hold ends at {hold.end_time:.4g} s, before the reference time"
                found.append(replace(absent, reason=why))
                continue
            decades = float(np.log10(hold.end_time / one.reference_time))
            found.append(
                replace(
                    absent, value=decades * hold.creep_per_decade,
                    standard_uncertainty=decades * hold.creep_per_decade_standard_uncertainty,
                )
            )  # fmt: skip
    none = "no step holds a constant tension"
    return tuple(found) or (ChangeInLength("polymer strain", reason=none),)


def _working(steps: Sequence[StepOfProgramme], is_ordered: bool) -> tuple[ChangeInLength, ...]:
    absent = ChangeInLength("working strain")
    place = _bedded_in(steps)
    if place is None:
        return (replace(absent, reason="no step beds the rope in: construction would be in it"),)
    if not is_ordered:
        return (replace(absent, reason=f"{_NO_ORDER}: a hold may be of a rope not bedded in"),)
    found = []
    for one in _static(steps[place + 1 :]):
        strain = (one.high_tension - one.low_tension) / one.value
        spread = strain * one.standard_uncertainty / one.value
        found.append(replace(one, name=absent.name, value=strain, standard_uncertainty=spread))
    return tuple(found)
