"""What shared errors add to holds, and to the pairs of holds of a quasi-static programme."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from reduction.holds.product import HoldResult, hold_numbers
from reduction.line.held import HeldPair
from reduction.line.static import CreepOfHold
from reduction.product import ReducedTest
from reduction.record import Floats
from reduction.strain.model import StrainModel
from reduction.uncertainty.field import ErrorField, error_field
from reduction.uncertainty.holds import hold_contributions
from reduction.uncertainty.join import merged, stacked
from reduction.uncertainty.product import Contributions, InstrumentErrors
from reduction.uncertainty.strength import over_strength


def of_holds(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every hold of a test, along one axis; an empty list where there is none."""
    if not test.holds:
        return []
    places = [_place(test, hold.specimen) for hold in test.holds]
    terms = max(hold.prony_tension.size for hold in test.holds)
    creep = () if test.rope_step is None else test.rope_step.creep
    own = []
    for number, (hold, place) in enumerate(zip(test.holds, places, strict=True)):
        found = _of_hold(_padded(hold, terms), errors[place], test.strain_models[place])
        parts = [found]
        if len(creep) == len(test.holds):
            parts.append(_of_creep(found, creep[number], hold, errors[place]))
        own.append(merged(parts))
    return [stacked(own)]


def of_pairs(test: ReducedTest, errors: Sequence[InstrumentErrors]) -> list[Contributions]:
    """Every pair of holds of a test, along one axis; an empty list where there is none."""
    if test.rope_step is None or not test.rope_step.held:
        return []
    numbers = hold_numbers(test.holds).tolist()
    upper = {
        (hold.specimen, number): hold for number, hold in zip(numbers, test.holds, strict=True)
    }
    own = []
    for pair in test.rope_step.held:
        place = _place(test, pair.specimen)
        high = upper[pair.specimen, pair.high_hold]
        own.append(_of_pair(pair, high, errors[place], test.strain_models[place]))
    return [stacked(own)]


def _place(test: ReducedTest, specimen: str) -> int:
    return [one.name for one in test.specimens].index(specimen)


def _held(hold: HoldResult) -> Literal["position", "tension"]:
    """What the machine keeps to its set value while it holds."""
    return "tension" if hold.kind == "creep" else "position"


def _padded(hold: HoldResult, n_terms: int) -> HoldResult:
    missing = n_terms - hold.prony_tension.size
    return replace(hold, prony_tension=np.pad(hold.prony_tension, (0, missing),
                                              constant_values=np.nan))  # fmt: skip


def _of_hold(hold: HoldResult, errors: InstrumentErrors, model: StrainModel) -> Contributions:
    def field_at(strain: Floats, tension: Floats) -> ErrorField:
        return error_field(errors, model, strain=strain, tension=tension, held=_held(hold))

    return hold_contributions(field_at, hold)


def _of_creep(
    of_hold: Contributions, creep: CreepOfHold, hold: HoldResult, errors: InstrumentErrors
) -> Contributions:
    """Tension of a hold over the break strength, and its creep over that share."""
    ends = of_hold.values["hold_initial_tension"] + of_hold.values["hold_final_tension"]
    relative = ends / (hold.hold_initial_tension + hold.hold_final_tension)
    value = creep.creep_compliance_per_decade
    rate = of_hold.values["creep_rate_per_decade"] / hold.rate_per_decade
    share = np.array(creep.tension_over_strength)
    found = Contributions(
        of_hold.component,
        {
            "creep_tension_over_strength": share * relative,
            "creep_compliance_per_decade": value * (rate - relative),
        },
    )
    powers = {
        "creep_tension_over_strength": (share, -1.0),
        "creep_compliance_per_decade": (np.array(value), 1.0),
    }
    return over_strength(found, errors, powers)


def _of_pair(
    pair: HeldPair, high: HoldResult, errors: InstrumentErrors, model: StrainModel
) -> Contributions:
    """Tensions of a pair, and the secant between them at the reference time."""
    found = pair.stiffness
    secant, slope, over = (
        (np.nan,) * 3
        if found is None
        else (found.stiffness_at_reference, found.slope_per_decade, found.stiffness_over_strength)
    )
    # of both at the upper hold the machine keeps one, and the secant says the other at that time
    is_creep = high.kind == "creep"
    rise = pair.high_tension - pair.low_tension
    stroke = rise / secant if is_creep else high.hold_strain - pair.low_strain
    rise_then = stroke * secant
    field = error_field(
        errors, model,
        strain=pair.low_strain + np.array([0.0, 0.0, stroke]),
        tension=pair.low_tension + np.array([0.0, rise, rise_then]),
        held=_held(high),
    )  # fmt: skip
    begin, level, then = range(3)
    low_tension, high_tension = field.tension[:, begin], field.tension[:, level]
    of_rise = (field.tension[:, then] - low_tension) / rise_then
    of_stroke = (field.strain[:, then] - field.strain[:, begin]) / stroke
    chord = secant * (of_rise - of_stroke)
    # the secant is rise over stroke, of which one goes on with time: what that gains scales by the
    # slope of its error, and of a stroke that grows the secant changes by its square
    of_slope = slope * (
        of_rise + field.strain_slope[:, then] - 2 * of_stroke
        if is_creep
        else field.tension_slope[:, then] - of_stroke
    )
    per_strength = over / secant
    values = {
        "held_pair_low_tension": low_tension,
        "held_pair_high_tension": high_tension,
        "static_stiffness": chord,
        "static_stiffness_per_decade": of_slope,
        "static_stiffness_over_strength": chord * per_strength,
        "static_stiffness_per_decade_over_strength": of_slope * per_strength,
    }
    powers = {
        "static_stiffness_over_strength": (np.array(over), -1.0),
        "static_stiffness_per_decade_over_strength": (np.array(slope * per_strength), -1.0),
    }
    return over_strength(Contributions(field.component, values), errors, powers)
