"""How far a test went, for the history of later tests.

The first pass over a campaign keeps this of every test; its records may be too long to keep.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from reduction.pipeline.located_test import Located
from reduction.record.measurement import Floats, StepReadings
from reduction.record.samples import finite_extremes, first_sample, take_samples, thinned
from reduction.stages.moduli.slack_length import slack_crossings
from reduction.stages.moduli.stepwise_test import greatest_step_strain
from reduction.stages.strain.strain_model import StrainModel, strain_by_model

# share of the greatest tension up to which the first rise is kept, to tell where slack ends
_FIRST_RISE = 0.5

_MOST_KEPT = 1 << 20  # samples, or up to twice as many


@dataclass(frozen=True)
class _Samples:
    """Some samples of one specimen: position [m] and tension [N], shape (n_kept,) each."""

    position: Floats
    tension: Floats


@dataclass(frozen=True)
class Extremes:
    """How far one test went, by specimen; empty where it could not be read.

    Parameters
    ----------
    greatest_tension : mapping of str to float
        [N]
    greatest_measured_strain : mapping of str to float
        Of the extensometer, where there is one, or of the readings of a stepwise test. [1]
    at_greatest_position : mapping of str to Samples
        Samples at the greatest position: at a held length the rubber goes on stretching as its
        splices relax, so the greatest strain is at one of them, which the strain model tells.
    first_rise : mapping of str to Samples
        Up to half of the peak tension.
    slack_tension : float
        At or below which the specimens are slack; NaN where there is no record. [N]
    position_is_length : bool
        False where a displacement from slack begins at zero in every test.
    has_extensometer, is_stepwise : bool
        Whether strain was measured on the specimen, and whether a person read it.
    """

    greatest_tension: Mapping[str, float] = field(default_factory=dict)
    greatest_measured_strain: Mapping[str, float] = field(default_factory=dict)
    at_greatest_position: Mapping[str, _Samples] = field(default_factory=dict)
    first_rise: Mapping[str, _Samples] = field(default_factory=dict)
    slack_tension: float = float("nan")
    position_is_length: bool = True
    has_extensometer: bool = False
    is_stepwise: bool = False


def extremes_of_test(located: Located) -> Extremes:
    """How far a logged test went."""
    record = located.record
    measured = record.measured_strain
    return Extremes(
        greatest_tension=_greatest(record.specimens, located.tension),
        greatest_measured_strain={} if measured is None else _greatest(record.specimens, measured),
        at_greatest_position=_at_greatest_position(located),
        first_rise=_first_rise(located),
        slack_tension=located.standstills.slack_tension,
        position_is_length=record.position_is_length,
        has_extensometer=measured is not None,
    )


def extremes_of_readings(
    readings: StepReadings, specimen: str, *, stated_gauge_length: float | None
) -> Extremes:
    """How far a stepwise test went; weights hang from one specimen."""
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
    # a crossing through two samples alone has no residual, and so no uncertainty to give
    if not np.isfinite(spread):
        return nothing
    return (
        float(lengths[1] - lengths[0]) / free_length,
        spread / free_length,
        float(compliances[1] - compliances[0]) / free_length,
    )


def _greatest(specimens: tuple[str, ...], values: Floats) -> dict[str, float]:
    """The greatest value of each specimen that has one."""
    greatest = [finite_extremes(one)[1] for one in values]
    return {name: most for name, most in zip(specimens, greatest, strict=True) if np.isfinite(most)}


def _at_greatest_position(located: Located) -> dict[str, _Samples]:
    """Samples within the tolerance of a standstill of the greatest position, some of many."""
    position = located.position
    near = finite_extremes(position)[1] - located.standstills.position_tolerance
    if not np.isfinite(near):
        return {}
    at_top = thinned(
        lambda part: position[part] >= near, position.size, most=_MOST_KEPT, samples=(position,)
    )
    place, loads = take_samples(position, at_top), take_samples(located.tension, at_top)
    return {
        name: _Samples(place, load)
        for name, load in zip(located.record.specimens, loads, strict=True)
        if np.isfinite(load).any()
    }


def _first_above(series: Floats, level: float) -> int | None:
    return first_sample(lambda part: series[part] > level, 0, series.size, series)


def _first_rise(located: Located) -> dict[str, _Samples]:
    """Samples up to the first that is over half of the greatest tension; of many, the last."""
    found = {}
    for name, tension in zip(located.record.specimens, located.tension, strict=True):
        taut = _FIRST_RISE * max(finite_extremes(tension)[1], 0.0)
        over = _first_above(tension, taut)
        stop = 0 if over is None else over + 1
        rise = slice(max(stop - _MOST_KEPT, 0), stop)
        # copies, lest the whole record is kept with its first part
        found[name] = _Samples(np.array(located.position[rise]), np.array(tension[rise]))
    return found
