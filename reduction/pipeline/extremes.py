"""Extremes of a test, which the first pass over a campaign keeps of each record.

They give the strain history of a specimen, the growth of its slack length, and a strain model
that a test contradicts, before any test is reduced.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from reduction.pipeline.located_test import Located
from reduction.record.measurement import Floats, Integers, StepReadings
from reduction.record.notes import Note
from reduction.record.samples import finite_extremes, first_sample, take_samples, thinned
from reduction.stages.moduli.slack_length import slack_crossings
from reduction.stages.moduli.stepwise_test import greatest_step_strain
from reduction.stages.strain.impossible_strain import (
    note_on_strain_below_zero,
    refuse_impossible_strain,
)
from reduction.stages.strain.strain_model import StrainModel, strain_by_model

# fraction of the greatest tension up to which the first rise is kept, to find where slack ends
_FIRST_RISE = 0.5


_MOST_KEPT = 1 << 20  # samples, or up to twice as many


_MOST_SPREAD = 1024  # samples of each test of a campaign, or up to twice as many


@dataclass(frozen=True)
class _Samples:
    """Some samples of one specimen: position [m] and tension [N], shape (n_kept,) each."""

    position: Floats
    tension: Floats


@dataclass(frozen=True)
class Extremes:
    """Extremes reached in one test, by specimen; empty where it could not be read.

    Parameters
    ----------
    greatest_tension : mapping of str to float
        Greatest tension. [N]
    greatest_measured_strain : mapping of str to float
        From the extensometer, where there is one, or the readings of a stepwise test. [1]
    at_greatest_position : mapping of str to Samples
        Outermost samples at the greatest position.  At a held length the rubber goes on stretching
        as its splices relax, so the strain model has its greatest strain at one of them.
    first_rise : mapping of str to Samples
        Samples up to half of the peak tension.
    all_over : mapping of str to Samples
        Some samples spread over the whole test, with those at the least and greatest position.
    slack_tension : float
        At or below this the specimens are slack; NaN where there is no record. [N]
    position_is_length : bool
        False where the channel is a displacement from slack, zero at the start of every test.
    has_extensometer, is_stepwise : bool
        Whether strain was measured on the specimen, and whether a person read it.
    """

    greatest_tension: Mapping[str, float] = field(default_factory=dict)
    greatest_measured_strain: Mapping[str, float] = field(default_factory=dict)
    at_greatest_position: Mapping[str, _Samples] = field(default_factory=dict)
    first_rise: Mapping[str, _Samples] = field(default_factory=dict)
    all_over: Mapping[str, _Samples] = field(default_factory=dict)
    slack_tension: float = float("nan")
    position_is_length: bool = True
    has_extensometer: bool = False
    is_stepwise: bool = False


def extremes_of_test(located: Located) -> Extremes:
    """Extremes reached in a logged test."""
    record = located.record
    measured = record.measured_strain
    return Extremes(
        greatest_tension=_greatest_known(record.specimens, located.tension),
        greatest_measured_strain={}
        if measured is None
        else _greatest_known(record.specimens, measured),
        at_greatest_position=_at_greatest_position(located),
        first_rise=_first_rise(located),
        all_over=_all_over(located),
        # readings at slack due to a drifting zero do not count as a pull
        slack_tension=max(
            (
                located.standstills.slack_tension,
                *(one.later for one in located.load_at_slack if one is not None),
            )
        ),
        position_is_length=record.position_is_length,
        has_extensometer=measured is not None,
    )


def extremes_of_readings(
    readings: StepReadings, specimen: str, *, stated_gauge_length: float | None
) -> Extremes:
    """Extremes reached in a stepwise test; weights hang from one specimen."""
    strain = greatest_step_strain(readings, stated_gauge_length=stated_gauge_length)
    return Extremes(
        greatest_tension={specimen: float(readings.tension.max())},
        greatest_measured_strain={specimen: strain},
        is_stepwise=True,
    )


def greatest_strain(extremes: Extremes, specimen: str, model: StrainModel | None) -> float:
    """Greatest strain of a test: measured, or at one of the samples at the greatest position.

    Examples
    --------
    >>> greatest_strain(
    ...     Extremes(greatest_measured_strain={"hose": 0.3}, is_stepwise=True), "hose", None)
    0.3
    """
    if extremes.is_stepwise or (model is not None and model.method == "extensometer"):
        return extremes.greatest_measured_strain.get(specimen, float("nan"))
    at_top = extremes.at_greatest_position.get(specimen)
    if model is None or at_top is None:
        return float("nan")
    strain = strain_by_model(model, position=at_top.position, tension=at_top.tension)
    return float(np.nanmax(strain))


def growth_of_slack_length(
    first: Extremes, later: Extremes, specimen: str, *, free_length: float
) -> tuple[float, float, float]:
    """Growth of the length at which a specimen becomes taut, from its first test to a later one.

    Examples
    --------
    Taut at 3.0 m in the first test, at 3.3 m in the second.

    >>> position = np.linspace(2.0, 4.0, 401)
    >>> def rise(slack):
    ...     tension = 100 * np.clip(position - slack, 0, None)
    ...     return Extremes(first_rise={"hose": _Samples(position, tension)}, slack_tension=5.0)
    >>> growth, _, _ = growth_of_slack_length(rise(3.0), rise(3.3), "hose", free_length=3.0)
    >>> round(growth, 6)
    0.1
    """
    pair, nothing = (first, later), (float("nan"), float("nan"), float("nan"))
    # a displacement from slack begins at zero again in every test
    if any(specimen not in one.first_rise or not one.position_is_length for one in pair):
        return nothing
    # one tension for both, so that the slope of the first rise does not enter
    slack = max(one.slack_tension for one in pair)
    lengths, spreads, compliances = [], [], []
    for one in pair:
        rise = one.first_rise[specimen]
        at = slack_crossings(rise.position, rise.tension, slack_tension=slack)
        lengths.append(at.position[0])
        spreads.append(at.standard_uncertainty[0])
        compliances.append(at.compliance[0])
    spread = float(np.hypot(*spreads))
    # a crossing through only two samples has no residual, and so no uncertainty
    if not np.isfinite(spread):
        return nothing
    return (
        float(lengths[1] - lengths[0]) / free_length,
        spread / free_length,
        float(compliances[1] - compliances[0]) / free_length,
    )


def _greatest_known(specimens: tuple[str, ...], values: Floats) -> dict[str, float]:
    """The greatest value of each specimen, where one is known."""
    greatest = [finite_extremes(one)[1] for one in values]
    return {name: most for name, most in zip(specimens, greatest, strict=True) if np.isfinite(most)}


def _at_greatest_position(located: Located) -> dict[str, _Samples]:
    """Samples within the standstill tolerance of the greatest position, thinned if many."""
    position = located.position
    near = finite_extremes(position)[1] - located.standstills.position_tolerance
    if not np.isfinite(near):
        return {}
    at_top = thinned(
        lambda part: position[part] >= near, position.size, most=_MOST_KEPT, samples=(position,)
    )
    place, loads = take_samples(position, at_top), take_samples(located.tension, at_top)
    found = {}
    for name, load in zip(located.record.specimens, loads, strict=True):
        outer = _outermost(place, load)
        if outer.size:
            found[name] = _Samples(place[outer], load[outer])
    return found


def _outermost(place: Floats, load: Floats) -> Integers:
    """Index of the samples that no other exceeds both in position and in tension, either way.

    The greatest strain is at one of them, whether strain at one position falls with tension, as
    splices stretch, or rises.

    Examples
    --------
    >>> print(_outermost(np.array([2.0, 2.1, 2.1, 2.0]), np.array([50.0, 60.0, 58.0, 55.0])))
    [0 1 2]
    """
    known = np.flatnonzero(np.isfinite(load))
    kept = []
    for sign in (1.0, -1.0):
        order = known[np.lexsort((sign * load[known], -place[known]))]
        signed = sign * load[order]
        least = np.minimum.accumulate(signed)
        kept.append(order[np.concatenate([signed[:1] < np.inf, signed[1:] < least[:-1]])])
    return np.unique(np.concatenate(kept))


def _all_over(located: Located) -> dict[str, _Samples]:
    """Samples spread over the record, and at its least and greatest position."""
    position, loads = located.position, located.tension
    low, high = finite_extremes(position)
    if not low <= high:
        return {}
    lowest = first_sample(lambda part: position[part] == low, 0, position.size, position)
    highest = first_sample(lambda part: position[part] == high, 0, position.size, position)
    spread = range(0, position.size, max(1, position.size // _MOST_SPREAD))
    rows = np.array(sorted({*spread, lowest or 0, highest or 0}), dtype=np.intp)
    place = take_samples(position, rows)
    return {
        name: _Samples(place, take_samples(load, rows))
        for name, load in zip(located.record.specimens, loads, strict=True)
    }


def judge_strain(
    extremes: Extremes, model: StrainModel, *, test_id: str, can_push: bool = False
) -> tuple[Note, ...]:
    """Refuse a strain model that gives impossible strain, and note improbable strain.

    Examples
    --------
    >>> place = np.linspace(0.76, 1.38, 200)
    >>> test = Extremes(
    ...     all_over={"cord": _Samples(place, 900 * (place - 0.6))}, slack_tension=5.0)
    >>> model = StrainModel(
    ...     "cord", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> [found] = judge_strain(test, model, test_id="A")
    >>> print(found.code, round(found.numbers["least"], 2))
    strain-below-zero -0.24
    """
    samples = extremes.all_over.get(model.specimen)
    if samples is None or model.method == "extensometer":
        return ()
    strain = strain_by_model(model, position=samples.position, tension=samples.tension)
    refuse_impossible_strain(strain, specimen=model.specimen, test_id=test_id)
    reference = max(model.reference_tension, np.nan_to_num(extremes.slack_tension))
    return note_on_strain_below_zero(
        strain,
        samples.tension,
        specimen=model.specimen,
        reference_tension=reference,
        can_push=can_push,
    )


def _first_above(series: Floats, level: float) -> int | None:
    return first_sample(lambda part: series[part] > level, 0, series.size, series)


def _first_rise(located: Located) -> dict[str, _Samples]:
    """Samples up to the first above half of the greatest tension; of many, the last ones."""
    found = {}
    for name, tension in zip(located.record.specimens, located.tension, strict=True):
        taut = _FIRST_RISE * max(finite_extremes(tension)[1], 0.0)
        over = _first_above(tension, taut)
        stop = 0 if over is None else over + 1
        rise = slice(max(stop - _MOST_KEPT, 0), stop)
        # copies, so that the whole record does not stay in memory
        found[name] = _Samples(np.array(located.position[rise]), np.array(tension[rise]))
    return found
