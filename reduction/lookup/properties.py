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
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.cycles.product import Loops
from reduction.errors import SettingsError
from reduction.line.step import RopeStep
from reduction.moduli.product import ModulusCurves
from reduction.record import Floats

__all__ = ["ChangeInLength", "PropertyName", "StepOfProgramme", "change_in_length"]

PropertyName = Literal[
    "original stiffness",
    "static stiffness",
    "dynamic stiffness",
    "construction strain",
    "polymer strain",
    "working strain",
]
_NAN = float("nan")


@dataclass(frozen=True)
class StepOfProgramme:
    """One step of the programme of one specimen, as the reduction gave it.

    Parameters
    ----------
    name : str
        Of the test or step.
    step : RopeStep
        What its kind gives.
    specimen : str
        Which.
    row : int
        Of the specimen in the arrays of the step. [1]
    loops : Loops or None
        Its cycles; construction strain needs them for the first rise.
    first_loading : ModulusCurves or None
        Its first rise.
    """

    name: str
    step: RopeStep
    specimen: str
    row: int
    loops: Loops | None = None
    first_loading: ModulusCurves | None = None


@dataclass(frozen=True)
class ChangeInLength:
    """One property between two tensions; NaN with a reason where the record does not support it.

    Parameters
    ----------
    name : str
        One of the six.
    value, standard_uncertainty : float
        Type A. [N] of a stiffness, [1] of a strain
    unit : str
        N or 1.
    over_strength : float
        A stiffness over the rated break strength; NaN of a strain. [1]
    low_tension, high_tension : float
        Between which it holds; one number twice for a hold. [N]
    reference_time : float
        Where a time belongs to it. [s]
    step : str
        Which step it is from.
    reason : str
        Why there is no number, or what is not in it.
    """

    name: PropertyName
    value: float
    standard_uncertainty: float
    unit: Literal["N", "1"]
    over_strength: float = _NAN
    low_tension: float = _NAN
    high_tension: float = _NAN
    reference_time: float = _NAN
    step: str = ""
    reason: str = ""


def change_in_length(
    steps: Sequence[StepOfProgramme],
    *,
    is_new: bool,
    reference_time: float,
    rated_break_strength: float = _NAN,
) -> tuple[ChangeInLength, ...]:
    """Six change-in-length properties of one rope, from the steps of its programme.

    Parameters
    ----------
    steps : sequence of StepOfProgramme
        In the order in which they were done.
    is_new : bool
        Whether the rope had carried nothing before the first of them.
    reference_time : float
        After the centre of the ramp, from which polymer strain counts; the static stiffness
        carries its own. [s]
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
        If the reference time is not positive.

    Notes
    -----
    Every number is that of a stage before, or one line of arithmetic with it; uncertainties are
    theirs, and those that enter together count as independent.  Construction strain holds what
    the polymer gained in the minutes of the bedding-in.

    Examples
    --------
    >>> found = change_in_length([], is_new=True, reference_time=60.0)
    >>> print(len(found), found[1].name, "--", found[1].reason)
    6 static stiffness -- no step holds one tension after a lower one
    """
    if not reference_time > 0:
        raise SettingsError(
            "the reference time is not positive", found=f"{reference_time:g} s", needed="above 0 s"
        )
    return (
        *_original(steps, is_new, rated_break_strength),
        *_static(steps),
        *_dynamic(steps),
        *_construction(steps, is_new),
        *_polymer(steps, reference_time),
        *_working(steps),
    )


def _absent(name: PropertyName, reason: str, step: str = "") -> ChangeInLength:
    unit: Literal["N", "1"] = "N" if name.endswith("stiffness") else "1"
    return ChangeInLength(name, _NAN, _NAN, unit, step=step, reason=reason)


def _first_rise(one: StepOfProgramme) -> tuple[Floats, Floats, Floats] | None:
    """Strain, tension and its uncertainty on the first rise; None where there is none."""
    if one.first_loading is None:
        return None
    tension = one.first_loading.branch_tension[one.row, 0]
    spread = one.first_loading.branch_tension_standard_uncertainty[one.row, 0]
    known = np.isfinite(tension)
    if np.count_nonzero(known) < 2:
        return None
    return one.first_loading.strain_bin[known], tension[known], np.nan_to_num(spread[known])


def _original(
    steps: Sequence[StepOfProgramme], is_new: bool, strength: float
) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "original stiffness"
    if not is_new:
        return (_absent(name, "the rope had been loaded before: its first rise is not in the log"),)
    if not steps:
        return (_absent(name, "no step"),)
    first = steps[0]
    rise = _first_rise(first)
    if rise is not None:
        strain, tension, spread = rise
        gain = float(strain[-1] - strain[0])
        value = float(tension[-1] - tension[0]) / gain
        return (
            ChangeInLength(
                name, value, float(np.hypot(spread[0], spread[-1])) / gain, "N", value / strength,
                float(tension[0]), float(tension[-1]), step=first.name,
            ),
        )  # fmt: skip
    bedding = first.step.bedding_in
    if bedding is None:
        return (_absent(name, "the first step has no first rise", first.name),)
    value = float(bedding.first_stiffness[first.row])
    low, high = _NAN, _NAN
    if first.loops is not None:
        low = float(first.loops.valley_tension[first.row, 0])
        high = float(first.loops.peak_tension[first.row, 0])
    return (
        ChangeInLength(
            name, value, float(bedding.first_stiffness_standard_uncertainty[first.row]), "N",
            value / strength, low, high, step=first.name,
            reason="the first cycle, in place of a first rise that the log does not resolve",
        ),
    )  # fmt: skip


def _static(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "static stiffness"
    found = []
    for one in steps:
        for pair in one.step.held:
            if pair.specimen != one.specimen:
                continue
            if pair.stiffness is None:
                found.append(_absent(name, pair.reason, one.name))
                continue
            stiffness = pair.stiffness
            found.append(
                ChangeInLength(
                    name, stiffness.stiffness_at_reference,
                    stiffness.stiffness_at_reference_standard_uncertainty, "N",
                    stiffness.stiffness_over_strength, pair.low_tension, pair.high_tension,
                    stiffness.reference_time, one.name, "; ".join(stiffness.notes),
                )
            )  # fmt: skip
    return tuple(found) or (_absent(name, "no step holds one tension after a lower one"),)


def _dynamic(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "dynamic stiffness"
    found = []
    for one in steps:
        dynamic = one.step.dynamic
        # the cycles of bedding-in are of a rope that is still settling
        if dynamic is None or one.step.bedding_in is not None:
            continue
        for level in range(dynamic.level.size):
            at = one.row, level
            mean, amplitude = float(dynamic.mean_tension[at]), float(dynamic.tension_amplitude[at])
            value = float(dynamic.dynamic_stiffness[at])
            spread = float(dynamic.dynamic_stiffness_standard_uncertainty[at])
            found.append(
                ChangeInLength(
                    name, value, spread, "N",
                    float(dynamic.dynamic_stiffness_over_strength[at]),
                    mean - amplitude, mean + amplitude, step=one.name,
                    reason="" if np.isfinite(value) else "no cycle of this level has a stiffness",
                )
            )  # fmt: skip
    return tuple(found) or (_absent(name, "no step is of cycles of a settled rope"),)


def _construction(steps: Sequence[StepOfProgramme], is_new: bool) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "construction strain"
    bedded = [one for one in steps if one.step.bedding_in is not None]
    if not bedded:
        return (_absent(name, "no step beds the rope in"),)
    one = bedded[0]
    if not is_new or one is not steps[0]:
        return (_absent(name, "the rope had been loaded before it was bedded in", one.name),)
    bedding, row = one.step.bedding_in, one.row
    if bedding is None or one.loops is None:
        return (_absent(name, "the cycles of the bedding-in are not given", one.name),)
    loops = one.loops
    foot = float(loops.mean_strain[row, 0] - loops.strain_amplitude[row, 0])
    valley, peak = float(loops.valley_tension[row, 0]), float(np.nanmax(loops.peak_tension[row]))
    value = float(bedding.permanent_strain[row])
    spread = float(bedding.permanent_strain_standard_uncertainty[row])
    reason = "of the cycles alone: the first rise does not pass the tension of their valleys"
    at_valley = _on_first_rise(one, valley)
    if at_valley is not None and np.isnan(at_valley[0]):
        reason = "the first foot is taken to be on the first rise, which was held there"
    elif at_valley is not None:
        strain, doubt = at_valley
        value += foot - strain
        spread = float(np.hypot(spread, np.hypot(loops.uncertainty["mean_strain"][row, 0], doubt)))
        reason = ""
    return (
        ChangeInLength(
            name, value, spread, "1", low_tension=valley, high_tension=peak, step=one.name,
            reason=reason,
        ),
    )  # fmt: skip


def _on_first_rise(one: StepOfProgramme, tension: float) -> tuple[float, float] | None:
    """Strain and its uncertainty where the first rise first has a tension; None where it has not.

    NaN where the rise has a gap there: it was held, and the cycles begin from the hold.
    """
    rise = _first_rise(one)
    if rise is None or not rise[1][0] <= tension <= rise[1].max():
        return None
    place = max(int(np.argmax(rise[1] >= tension)), 1)
    strain, load, doubt = (part[place - 1 : place + 1] for part in rise)
    if strain[1] - strain[0] > 1.5 * float(np.diff(rise[0]).min()):
        return _NAN, _NAN
    slope = float(load[1] - load[0]) / float(strain[1] - strain[0])
    return float(strain[1] - (load[1] - tension) / slope), float(doubt[1]) / slope


def _polymer(steps: Sequence[StepOfProgramme], reference_time: float) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "polymer strain"
    found = []
    for one in steps:
        for creep in one.step.creep:
            if creep.specimen != one.specimen:
                continue
            if not np.isfinite(creep.creep_per_decade):
                found.append(_absent(name, creep.reason, one.name))
                continue
            if creep.duration <= reference_time:
                why = f"the hold of {creep.duration:.4g} s ends before the reference time"
                found.append(_absent(name, why, one.name))
                continue
            decades = float(np.log10(creep.duration / reference_time))
            found.append(
                ChangeInLength(
                    name, decades * creep.creep_per_decade,
                    decades * creep.creep_per_decade_standard_uncertainty, "1",
                    low_tension=creep.tension, high_tension=creep.tension,
                    reference_time=reference_time, step=one.name,
                )
            )  # fmt: skip
    return tuple(found) or (_absent(name, "no step holds a constant tension"),)


def _working(steps: Sequence[StepOfProgramme]) -> tuple[ChangeInLength, ...]:
    name: PropertyName = "working strain"
    begun = [number for number, one in enumerate(steps) if one.step.bedding_in is not None]
    if not begun:
        return (_absent(name, "no step beds the rope in: construction strain would be in it"),)
    found = []
    for one in _static(steps[begun[0] + 1 :]):
        if not np.isfinite(one.value):
            found.append(_absent(name, one.reason, one.step))
            continue
        value = (one.high_tension - one.low_tension) / one.value
        found.append(
            ChangeInLength(
                name, value, value * one.standard_uncertainty / one.value, "1",
                low_tension=one.low_tension, high_tension=one.high_tension,
                reference_time=one.reference_time, step=one.step, reason=one.reason,
            )
        )  # fmt: skip
    return tuple(found)
