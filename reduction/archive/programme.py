"""Steps of a rope laboratory's programme: their variables, and the values of a product."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import chain

import numpy as np

from reduction.archive.reasons import CLOCK, NO_YES, SETTING
from reduction.archive.values import Values, numbers, pad, texts
from reduction.archive.variable import Variable, count, flag, label, measured, stated
from reduction.line.failure import CyclesToFailure
from reduction.line.held import HeldPair
from reduction.line.programme import BeddingIn, DynamicStiffness
from reduction.line.static import CreepOfHold
from reduction.line.step import RopeStep
from reduction.line.tensile import TensilePull
from reduction.record import Floats, Specimen

_S = ("specimen",)
_P = ("held_pair",)
_T = ("held_pair", "held_pair_point")
_U = "_standard_uncertainty"
_OVER = re.compile("_over_strength|^creep_compliance")

ROPE_ROWS: tuple[Variable, ...] = tuple(
    chain(
        label("programme_step"),
        # bedding-in
        count("bedding_cycles", _S),
        chain.from_iterable(
            measured(f"bedding_{name}", _S)
            for name in (
                "first_stiffness",
                "last_stiffness",
                "first_stiffness_over_strength",
                "last_stiffness_over_strength",
                "stiffening",
                "permanent_strain",
            )
        ),
        # dynamic stiffness
        count("dynamic_cycles", _S),
        measured("dynamic_stiffness", _S),
        measured("dynamic_stiffness_over_strength", _S),
        measured("dynamic_stiffness_drift", _S),
        measured("dynamic_frequency", _S),
        measured("dynamic_mean_tension", _S),
        measured("dynamic_tension_amplitude", _S),
        measured("dynamic_mean_tension_over_strength", _S),
        measured("dynamic_tension_amplitude_over_strength", _S),
        # quasi-static stiffness
        count("held_pair", _P),
        label("held_pair_specimen", _P),
        count("held_pair_low_hold", _P),
        count("held_pair_high_hold", _P),
        measured("held_pair_low_tension", _P),
        measured("held_pair_high_tension", _P),
        stated("static_reference_time", _P, SETTING),
        measured("static_stiffness", _P),
        measured("static_stiffness_over_strength", _P),
        measured("static_stiffness_per_decade", _P),
        measured("static_stiffness_per_decade_over_strength", _P),
        label("static_refusal", _P),
        count("held_pair_point", ("held_pair_point",)),
        stated("static_elapsed_time", _T, CLOCK),
        stated(
            "static_stiffness_at_time", _T, "mean of readings: static_stiffness has their scatter"
        ),
        # creep
        measured("creep_tension_over_strength", ("hold",)),
        measured("creep_compliance_per_decade", ("hold",)),
        # cycles to failure
        count("cycles_to_failure", _S),
        flag("cycles_are_run_out", _S, NO_YES),
        stated("failure_peak_tension", _S, "mean over the cycles; each cycle has an uncertainty"),
        stated("failure_valley_tension", _S, "mean over the cycles; each cycle has an uncertainty"),
        stated(
            "failure_peak_tension_over_strength",
            _S,
            "mean over the cycles; each cycle has an uncertainty",
        ),
        label("failure_judged_by", _S),
        # pulls to the end
        flag("pull_is_break", _S, NO_YES),
        measured("pull_peak_tension", _S),
        measured("pull_peak_tension_over_strength", _S),
        measured("pull_peak_strain", _S),
        measured("tensile_strength", _S),
        measured("strain_at_failure", _S),
    )
)


def rope_values(step: RopeStep, specimens: tuple[Specimen, ...]) -> Values:
    """Return what one step of a programme gave; a part that it lacks is left out."""
    strength = numbers([one.rated_break_strength for one in specimens])
    values: Values = {"programme_step": np.array(step.name)}
    if step.bedding_in is not None:
        values |= _bedding_values(step.bedding_in, strength)
    if step.dynamic is not None:
        values |= _dynamic_values(step.dynamic)
    if step.held:
        values |= _held_values(step.held, dict(zip(_names(specimens), strength, strict=True)))
    if step.creep:
        values |= _creep_values(step.creep)
    if step.lasted is not None:
        values |= _failure_values(step.lasted)
    if step.tensile is not None:
        values |= _tensile_values(step.tensile)
    if np.isnan(strength).all():
        values = {name: array for name, array in values.items() if not _OVER.search(name)}
    return values


def _names(specimens: tuple[Specimen, ...]) -> list[str]:
    return [one.name for one in specimens]


def _bedding_values(bedding: BeddingIn, strength: Floats) -> Values:
    first, last = bedding.first_stiffness, bedding.last_stiffness
    u_first = bedding.first_stiffness_standard_uncertainty
    u_last = bedding.last_stiffness_standard_uncertainty
    return {
        "bedding_cycles": np.full(first.shape, bedding.n_cycles),
        "bedding_first_stiffness": first,
        f"bedding_first_stiffness{_U}": u_first,
        "bedding_last_stiffness": last,
        f"bedding_last_stiffness{_U}": u_last,
        "bedding_first_stiffness_over_strength": bedding.first_stiffness_over_strength,
        f"bedding_first_stiffness_over_strength{_U}": u_first / strength,
        "bedding_last_stiffness_over_strength": bedding.last_stiffness_over_strength,
        f"bedding_last_stiffness_over_strength{_U}": u_last / strength,
        "bedding_stiffening": bedding.stiffening,
        f"bedding_stiffening{_U}": bedding.stiffening * np.hypot(u_first / first, u_last / last),
        "bedding_permanent_strain": bedding.permanent_strain,
        f"bedding_permanent_strain{_U}": bedding.permanent_strain_standard_uncertainty,
    }


def _dynamic_values(dynamic: DynamicStiffness) -> Values:
    """The one level of a step."""
    given: Values = {
        "dynamic_cycles": dynamic.n_cycles,
        "dynamic_stiffness": dynamic.dynamic_stiffness,
        f"dynamic_stiffness{_U}": dynamic.dynamic_stiffness_standard_uncertainty,
        "dynamic_stiffness_over_strength": dynamic.dynamic_stiffness_over_strength,
        f"dynamic_stiffness_over_strength{_U}": (
            dynamic.dynamic_stiffness_over_strength_standard_uncertainty
        ),
        "dynamic_stiffness_drift": dynamic.drift_per_cycle,
        f"dynamic_stiffness_drift{_U}": dynamic.drift_per_cycle_standard_uncertainty,
        "dynamic_frequency": dynamic.frequency,
        "dynamic_mean_tension": dynamic.mean_tension,
        "dynamic_tension_amplitude": dynamic.tension_amplitude,
        "dynamic_mean_tension_over_strength": dynamic.mean_tension_over_strength,
        "dynamic_tension_amplitude_over_strength": dynamic.tension_amplitude_over_strength,
        f"dynamic_frequency{_U}": dynamic.frequency_standard_uncertainty,
        f"dynamic_mean_tension{_U}": dynamic.mean_tension_standard_uncertainty,
        f"dynamic_tension_amplitude{_U}": dynamic.tension_amplitude_standard_uncertainty,
    }
    for name in ("dynamic_mean_tension", "dynamic_tension_amplitude"):
        share = given[f"{name}_over_strength"] / given[name]
        given[f"{name}_over_strength{_U}"] = given[f"{name}{_U}"] * share
    return {name: array[:, 0] for name, array in given.items()}


def _held_values(pairs: Sequence[HeldPair], strength: dict[str, float]) -> Values:
    """One row a pair of holds and specimen; NaN where its stiffness is refused."""
    of_pair = numbers([strength[one.specimen] for one in pairs])
    found = [one.stiffness for one in pairs]
    level, u_level, slope, u_slope, at = (
        numbers([None if one is None else getattr(one, name) for one in found])
        for name in (
            "stiffness_at_reference",
            "stiffness_at_reference_standard_uncertainty",
            "slope_per_decade",
            "slope_per_decade_standard_uncertainty",
            "reference_time",
        )
    )
    elapsed = pad([[] if one is None else one.elapsed for one in found])
    return {
        "held_pair": np.arange(1, len(pairs) + 1),
        "held_pair_specimen": texts([one.specimen for one in pairs]),
        "held_pair_low_hold": np.array([one.low_hold for one in pairs]),
        "held_pair_high_hold": np.array([one.high_hold for one in pairs]),
        "held_pair_low_tension": numbers([one.low_tension for one in pairs]),
        "held_pair_high_tension": numbers([one.high_tension for one in pairs]),
        f"held_pair_low_tension{_U}": numbers(
            [one.low_tension_standard_uncertainty for one in pairs]
        ),
        f"held_pair_high_tension{_U}": numbers(
            [one.high_tension_standard_uncertainty for one in pairs]
        ),
        "static_reference_time": at,
        "static_stiffness": level,
        f"static_stiffness{_U}": u_level,
        "static_stiffness_over_strength": level / of_pair,
        f"static_stiffness_over_strength{_U}": u_level / of_pair,
        "static_stiffness_per_decade": slope,
        f"static_stiffness_per_decade{_U}": u_slope,
        "static_stiffness_per_decade_over_strength": slope / of_pair,
        f"static_stiffness_per_decade_over_strength{_U}": u_slope / of_pair,
        "static_refusal": texts([one.reason for one in pairs]),
        "held_pair_point": np.arange(1, elapsed.shape[1] + 1),
        "static_elapsed_time": elapsed,
        "static_stiffness_at_time": pad([[] if one is None else one.stiffness for one in found]),
    }


def _creep_values(creep: Sequence[CreepOfHold]) -> Values:
    """Along the holds of the test, of which each has one entry."""
    share = numbers([one.tension_over_strength for one in creep])
    spread = numbers([one.creep_per_decade_standard_uncertainty for one in creep])
    return {
        "creep_tension_over_strength": share,
        f"creep_tension_over_strength{_U}": share
        * numbers([one.tension_standard_uncertainty / one.tension for one in creep]),
        "creep_compliance_per_decade": numbers([one.creep_compliance_per_decade for one in creep]),
        f"creep_compliance_per_decade{_U}": spread / share,
    }


def _failure_values(lasted: CyclesToFailure) -> Values:
    return {
        "cycles_to_failure": lasted.cycles,
        "cycles_are_run_out": ~lasted.failed,
        "failure_peak_tension": lasted.peak_tension,
        "failure_valley_tension": lasted.valley_tension,
        "failure_peak_tension_over_strength": lasted.peak_tension_over_strength,
        "failure_judged_by": texts(lasted.how),
    }


def _tensile_values(pull: TensilePull) -> Values:
    """Strength and strain at failure of what broke alone; the greatest tension of any."""
    u_tension, u_strain = (
        pull.peak_tension_standard_uncertainty,
        pull.strain_at_peak_standard_uncertainty,
    )
    values: Values = {
        "pull_is_break": pull.is_break,
        "pull_peak_tension": pull.peak_tension,
        f"pull_peak_tension{_U}": u_tension,
        "pull_peak_tension_over_strength": pull.peak_tension_over_strength,
        f"pull_peak_tension_over_strength{_U}": (
            pull.peak_tension_over_strength_standard_uncertainty
        ),
        "pull_peak_strain": pull.strain_at_peak,
        f"pull_peak_strain{_U}": u_strain,
    }
    for name, source in (
        ("tensile_strength", "peak_tension"),
        ("strain_at_failure", "peak_strain"),
    ):
        for suffix in ("", _U):
            seen = values[f"pull_{source}{suffix}"]
            values[f"{name}{suffix}"] = np.where(pull.is_break, seen, np.nan)
    return values
