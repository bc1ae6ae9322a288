"""Impossible strain: the whole length lost, or shorter than at rest while the specimen pulls."""

from __future__ import annotations

import numpy as np

from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note
from reduction.record.samples import finite_extremes
from reduction.stages.load_at_slack import PULLS_BACK, rises_with_stretch

# of the reference tension: noise about it and creep of a rope are no contradiction
_ABOVE = 2.0

_BELOW = 0.01  # of the range of strain: error left by the zero of a tape and by a scale

_FEWEST, _SHARE = 3, 0.005  # samples


def refuse_impossible_strain(strain: Floats, *, specimen: str, test_id: str) -> None:
    """Refuse strain at or below -100 %, which nothing left of a specimen can have.

    Examples
    --------
    >>> refuse_impossible_strain(
    ...     np.array([-1.3, -1.25]), specimen="new", test_id="T-1")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    reduction.record.errors.DataError: strain of 'new' in test 'T-1' is at or below -100 %; ...
    """
    low, high = finite_extremes(strain)
    if low > -1:
        return
    lowest = np.count_nonzero(strain == low)
    is_mark = 1 < lowest < strain.size and float(np.min(strain[strain > low])) > -1
    raise DataError(
        f"strain of '{specimen}' in test '{test_id}' is at or below -100 %",
        found=f"{100 * low:.4g} to {100 * high:.4g} %",
        needed="a length above zero",
        hint=f"{lowest} readings have that lowest value, and no other is below -100 %: if it means "
        "that none was taken, add it to the missing marks of the layout."
        if is_mark
        else "Is the unit, the sign or the zero of crosshead_position right, and that of the marks "
        "or of the gauge length?",
    )


def note_on_strain_below_zero(
    strain: Floats,
    tension: Floats,
    *,
    specimen: str,
    reference_tension: float,
    can_push: bool = False,
) -> tuple[Note, ...]:
    """Report that a specimen is shorter than at its reference tension while it pulls more.

    ``reference_tension`` [N] is the tension of zero strain: that of the gauge length, or that up
    to which the specimen counts as slack.  A position that falls while tension rises has a wrong
    sign, otherwise the zero is wrong.  A pushed specimen pulls on its way back while still short.
    One that ``can_push`` may be shorter than that, unless it is so in the whole record and only
    pulls, the more the longer it is.

    Examples
    --------
    >>> [found] = note_on_strain_below_zero(
    ...     np.linspace(-0.24, 0.38, 100), np.linspace(50, 500, 100), specimen="cord",
    ...     reference_tension=5.0)
    >>> print(found)  # doctest: +ELLIPSIS
    cord: strain falls to -24 % at tensions up to 218 N, above the 5 N at which it should be ...
    """
    with np.errstate(invalid="ignore"):
        push = max(-finite_extremes(tension)[0], 0.0)
        pulls = tension > max(_ABOVE * reference_tension, PULLS_BACK * push)
        low, high = finite_extremes(strain)
        below = pulls & (strain < -_BELOW * (high - low))
    n_below = int(np.count_nonzero(below))
    if n_below < max(_FEWEST, _SHARE * np.count_nonzero(pulls)):
        return ()
    rises = rises_with_stretch(strain, tension)
    if can_push and (high > 0 or push > _ABOVE * reference_tension or not rises):
        return ()
    return (
        note("strain-below-zero", specimen, least=float(strain[below].min()),
             tension=float(tension[below].max()), reference=reference_tension, rises=rises),
    )  # fmt: skip
