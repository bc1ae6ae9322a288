"""What shared errors add to holds, and to the pairs of holds of a quasi-static programme."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

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
from reduction.uncertainty.points import chord_contributions
from reduction.uncertainty.product import Contributions, InstrumentErrors
from reduction.uncertainty.strength import over_strength

__all__ = ["of_holds", "of_pairs"]


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
    strains = {
        (hold.specimen, number): hold.hold_strain
        for number, hold in zip(numbers, test.holds, strict=True)
    }
    own = []
    for pair in test.rope_step.held:
        place = _place(test, pair.specimen)
        low, high = (
            strains.get((pair.specimen, number), np.nan)
            for number in (pair.low_hold, pair.high_hold)
        )
        own.append(_of_pair(pair, low, high, errors[place], test.strain_models[place]))
    return [stacked(own)]


def _place(test: ReducedTest, specimen: str) -> int:
    return [one.name for one in test.specimens].index(specimen)


def _padded(hold: HoldResult, n_terms: int) -> HoldResult:
    missing = n_terms - hold.prony_tension.size
    return replace(hold, prony_tension=np.pad(hold.prony_tension, (0, missing),
                                              constant_values=np.nan))  # fmt: skip


def _of_hold(hold: HoldResult, errors: InstrumentErrors, model: StrainModel) -> Contributions:
    def field_at(strain: Floats, tension: Floats) -> ErrorField:
        return error_field(errors, model, strain=strain, tension=tension)

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
    pair: HeldPair, low: float, high: float, errors: InstrumentErrors, model: StrainModel
) -> Contributions:
    """Tensions of a pair, and the secant between them; strains are those of the two holds."""
    found = pair.stiffness
    secant, slope, over = (
        (np.nan,) * 3
        if found is None
        else (found.stiffness_at_reference, found.slope_per_decade, found.stiffness_over_strength)
    )
    rise = pair.high_tension - pair.low_tension
    stroke = rise / secant
    begin, end = (
        error_field(errors, model, strain=at, tension=force)
        for at, force in ((low, pair.low_tension), (high, pair.high_tension))
    )
    chord = chord_contributions(begin, end, stroke=stroke, chord=secant).values["chord"]
    # K is the rise over a + b log t: an error of a is in the slope of K twice, one of b once
    reach = (end.strain - begin.strain) / stroke
    of_slope = slope * ((end.tension - begin.tension) / rise + end.strain_slope - 2 * reach)
    per_strength = over / secant
    values = {
        "held_pair_low_tension": begin.tension,
        "held_pair_high_tension": end.tension,
        "static_stiffness": chord,
        "static_stiffness_per_decade": of_slope,
        "static_stiffness_over_strength": chord * per_strength,
        "static_stiffness_per_decade_over_strength": of_slope * per_strength,
    }
    powers = {
        "static_stiffness_over_strength": (np.array(over), -1.0),
        "static_stiffness_per_decade_over_strength": (np.array(slope * per_strength), -1.0),
    }
    return over_strength(Contributions(begin.component, values), errors, powers)
