"""Construction strain of a rope: what its bedding-in left, at equal tension.

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length
   Properties of Fibre Rope," OIPEEC (abstract).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.line.propertyproduct import (
    RISE_GAP,
    BeddingCycles,
    ChangeInLength,
    FirstRise,
    StepNumber,
    StepOfProgramme,
)

_NAN = float("nan")


def construction_strain(steps: Sequence[StepOfProgramme], before: str) -> ChangeInLength:
    """Strain that bedding-in left at equal tension, on the first rise and in the cycles.

    Parameters
    ----------
    steps : sequence of StepOfProgramme
        In the order in which they were done.
    before : str
        What was before the first of them, in words; empty of a new rope.

    Returns
    -------
    strain : ChangeInLength
        NaN with a reason where the steps do not support it. [1]

    Raises
    ------
    ValueError
        Never by itself.

    Notes
    -----
    A name of [1]_.  The strain of the cycles' permanent change, and how far their first foot lies
    from the first rise at the same tension.  That tension is read by one load cell in both places,
    so that its errors move neither; what an error of the strain adds is its difference between
    them.

    Examples
    --------
    >>> print(construction_strain([], "").reason)
    no step beds the rope in
    """
    absent = ChangeInLength("construction strain")
    place = bedded_in(steps)
    if place is None:
        return replace(absent, reason="no step beds the rope in")
    one = steps[place]
    absent = replace(absent, step=one.name)
    if before or place > 0:
        why = before or f"it had been loaded in {steps[0].name}"
        return replace(absent, reason=f"{why}: what was left before the bedding-in is not known")
    cycles = one.bedding
    if cycles is None or np.isnan(cycles.permanent_strain.value):
        return replace(absent, reason="the cycles give no permanent strain")
    found = absent.with_number(cycles.permanent_strain)
    reason = "of the cycles alone: the first rise does not pass the tension of their valleys"
    at_valley = _on_first_rise(one.first_rise, cycles)
    if at_valley is not None and np.isnan(at_valley.value):
        reason = "the first foot is taken to be on the first rise, which was held there"
    elif at_valley is not None:
        reason = ""
        # what is random at the first foot is in the permanent strain with the other sign
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


def bedded_in(steps: Sequence[StepOfProgramme]) -> int | None:
    """Place of the first step that beds the rope in.

    Parameters
    ----------
    steps : sequence of StepOfProgramme
        In the order in which they were done.

    Returns
    -------
    place : int or None
        None where none does. [1]

    Raises
    ------
    ValueError
        Never by itself.

    Notes
    -----
    What was there before it is a rope as it was made ([1]_).

    Examples
    --------
    >>> print(bedded_in([StepOfProgramme("Q", 600.0)]))
    None
    """
    return next((place for place, one in enumerate(steps) if one.bedding is not None), None)


def _on_first_rise(rise: FirstRise | None, cycles: BeddingCycles) -> StepNumber | None:
    """Strain where the rise first has the tension of the valleys; None where it nowhere has.

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
