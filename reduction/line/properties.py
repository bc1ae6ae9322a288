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
from reduction.line.constructionstrain import bedded_in, construction_strain
from reduction.line.propertyproduct import (
    RISE_GAP,
    ChangeInLength,
    PairOfHolds,
    StepOfProgramme,
)
from reduction.record import Floats

_NAN = float("nan")
_HELD = "the rise was held on its way: what it gained meanwhile is in it"
_NO_RISE = (
    "the first step has no curve of its first rise, which a log that begins slack gives, of "
    "another step than bedding-in with a diameter"
)
_NO_PAIR = "no step holds one tension after a lower one"
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
    Every number is that of a stage before, or one line of arithmetic with it.  An error that
    samples share goes through that line with its sign, what is random by its square: a zero of
    the load cell is in no chord, and its gain in no working strain.  The foot of the first cycle,
    which is in both parts of a construction strain with opposite signs, adds nothing to it.
    Construction strain holds what the polymer gained in the minutes of the bedding-in.

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
        construction_strain(steps, before),
        *_polymer(steps),
        *_working(steps, is_ordered),
    )
    of_strength = {one.name: one.strength_contribution for one in steps}
    return tuple(
        _told(_over(one, rated_break_strength, of_strength.get(one.step)), missing) for one in found
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
    rise = first.first_rise
    if rise is not None:
        gain = float(rise.strain[-1] - rise.strain[0])
        stiffness = float(rise.tension[-1] - rise.tension[0]) / gain
        of_tension, of_strain = (
            rows[:, -1] - rows[:, 0]
            for rows in (rise.tension_contribution, rise.strain_contribution)
        )
        spread = rise.tension_random_standard_uncertainty
        return replace(
            absent,
            value=stiffness,
            random_standard_uncertainty=float(np.hypot(spread[0], spread[-1])) / gain,
            contribution=(of_tension - stiffness * of_strain) / gain,
            low_tension=float(rise.tension[0]),
            high_tension=float(rise.tension[-1]),
            reason=_HELD if float(np.diff(rise.strain).max()) > RISE_GAP * rise.spacing else "",
        )
    if first.bedding is None:
        return replace(absent, reason=_NO_RISE)
    return replace(
        absent.with_number(first.bedding.first_stiffness),
        low_tension=first.bedding.valley_tension,
        high_tension=first.bedding.first_peak_tension,
        reason=(
            "of the first cycle: there is no curve of the first rise, which a log that begins "
            "slack gives"
        ),
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
    # the cycles of bedding-in are of a rope that is still settling
    none = "no step is of cycles of a settled rope"
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
    place = bedded_in(steps)
    if place is None:
        return (replace(absent, reason="no step beds the rope in: construction would be in it"),)
    if not is_ordered:
        return (replace(absent, reason=f"{_NO_ORDER}: a hold may be of a rope not bedded in"),)
    pairs = [(one, pair) for one in steps[place + 1 :] for pair in one.pairs]
    if not pairs:
        return (replace(absent, reason=_NO_PAIR),)
    return tuple(_working_of(_of_pair(one, pair), pair) for one, pair in pairs)


def _working_of(one: ChangeInLength, pair: PairOfHolds) -> ChangeInLength:
    """Rise over stiffness: a gain of the load cell is in both, and in the strain no more."""
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
