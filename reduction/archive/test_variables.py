"""Variables of a reduced test by stage."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.archive.variables import (
    Values,
    numbers,
    pad,
    texts,
)
from reduction.quantities.flags import LINE_METHODS, STEP_MASKS
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.contributions import LineSpread
from reduction.record.measurement import Floats, Specimen
from reduction.stages.channel_lag import LagEstimate
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.holds.hold_product import HoldResult, hold_numbers
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    CycleIdentity,
    ElastomerFit,
    EndModuli,
    ModulusCurves,
    PeakTrend,
    Ratio,
    Segments,
    Slips,
)
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.standstills import Standstills
from reduction.stages.three_parameter_line.hold_pairs import CreepOfHold, HeldPair
from reduction.stages.three_parameter_line.line_product import (
    LINE_PARAMETERS,
    LineParameters,
    SlowPull,
)
from reduction.stages.three_parameter_line.rope_programme import (
    BeddingIn,
    CyclesToFailure,
    DynamicStiffness,
    RopeStep,
    TensilePull,
)
from reduction.stages.three_parameter_line.slow_pull import (
    BREAK_SHARES,
    quasi_static_spring_constant,
    strain_at_break_share,
    strain_at_tension,
    tension_grid,
)

COEFFICIENTS = {
    "relaxed_free_length": "relaxed_free_length",
    "relaxed_splice_length": "relaxed_splice_length",
    "splice_compliance": "splice_compliance",
    "splice_exponent": "splice_exponent",
    "splice_strain_ratio": "splice_strain_ratio",
    "splice_offset": "splice_offset",
    "splice_strain_curvature": "splice_strain_curvature",
    "splice_strain_cubic": "splice_strain_cubic",
    "splice_limit": "splice_limit",
    "splice_saturation": "splice_saturation",
    "free_length_intercept": "free_length_intercept",
    "free_length_slope": "free_length_slope",
    "free_fraction": "free_fraction",
    "reference_position": "reference_position",
    "gauge_length": "strain_gauge_length",
}
"""Archive name, along ``specimen``, by coefficient of a strain method.

They differ if the name has another meaning in a product.
"""


def cycle_values(cycles: Cycles, *, control: str) -> Values:
    """Return the cycles and their branches; ``control`` gives the unit of band and rate."""
    band, rate = (
        ("tension_band", "tension_rate")
        if control == "load"
        else ("position_band", "crosshead_rate")
    )
    return {
        "cycle": np.arange(1, cycles.n_cycles + 1),
        "branch_name": texts(BRANCH_NAMES),
        "cycle_first_sample": cycles.first,
        "cycle_last_sample": cycles.last,
        "branch_first_sample": cycles.branch_first,
        "branch_last_sample": cycles.branch_last,
        rate: cycles.plateau_rate,
        band: np.array(cycles.band),
        "cycles_counted_by": np.array(cycles.counted_by),
    } | ({} if cycles.count is None else {"cycle_number_in_test": cycles.count})


def values_of(
    product: EndModuli | CycleIdentity | PeakTrend | ModulusCurves | Segments,
    *,
    without: Collection[str] = (),
) -> Values:
    """Return the fields of a product of a stage, by their names."""
    return {
        item.name: getattr(product, item.name)
        for item in fields(product)
        if item.name not in without
    }


def with_uncertainty(product: Loops | AmplitudeSummary, prefix: str = "") -> Values:
    """Return the fields of a product with an ``uncertainty``, and these uncertainties."""
    values: Values = {
        f"{prefix}{item.name}": getattr(product, item.name)
        for item in fields(product)
        if item.name != "uncertainty"
    }
    for name, uncertainty in product.uncertainty.items():
        values[f"{prefix}{name}_standard_uncertainty"] = uncertainty
    return values


def slip_values(slips: Slips, *, specimens: tuple[str, ...]) -> Values:
    """Return the steps found; ``n_slips`` is zero if a search found none."""
    return {
        "n_slips": np.array([slips.specimen.count(name) for name in specimens]),
        "creep_per_cycle": slips.creep_per_cycle,
        "slip_specimen": texts(slips.specimen),
        "slip_cycle": slips.slip_cycle,
        "slip_cycle_low": slips.slip_cycle_low,
        "slip_cycle_high": slips.slip_cycle_high,
        "slip_tension_step": slips.slip_tension_step,
        "slip_tension_step_standard_uncertainty": slips.slip_tension_step_standard_uncertainty,
        "slip_length": slips.slip_length,
        "slip_length_standard_uncertainty": slips.slip_length_standard_uncertainty,
    }


def curve_values(curves: ModulusCurves) -> Values:
    """Return the tangent modulus curves with their companions."""
    # window smoothing errors are in the contributions
    apart = (
        "window",
        "notes",
        "made",
        "tangent_modulus_window_uncertainty",
    )
    absent = [item.name for item in fields(curves) if getattr(curves, item.name) is None]
    return values_of(curves, without=(*apart, *absent)) | {
        "branch_name": texts(BRANCH_NAMES),
        "strain_window": np.array(curves.window),
    }


def first_loading_values(curves: ModulusCurves) -> Values:
    """Return the curves of the first loading, on their own strain axis."""
    return {
        "branch_name": texts(BRANCH_NAMES),
        "first_loading_strain_bin": curves.strain_bin,
        "first_loading_strain_bin_bounds": curves.strain_bin_bounds,
        "tangent_modulus_first_loading": curves.tangent_modulus,
        "tangent_modulus_first_loading_standard_uncertainty": (
            curves.tangent_modulus_standard_uncertainty
        ),
        "branch_tension_first_loading": curves.branch_tension,
        "branch_tension_first_loading_standard_uncertainty": (
            curves.branch_tension_standard_uncertainty
        ),
    }


def segment_values(segments: Segments) -> Values:
    """Return the piecewise-linear moduli."""
    return values_of(segments, without=("criterion",)) | {
        "branch_name": texts(BRANCH_NAMES),
        "segment": np.arange(1, segments.segment_modulus.shape[-1] + 1),
        "segment_criterion": np.array(segments.criterion),
    }


def ratio_values(ratios: Sequence[Ratio]) -> Values:
    """Return the modulus ratios of a test, which share a strain grid."""

    def stacked(name: str) -> NDArray[Any]:
        return np.stack([getattr(ratio, name) for ratio in ratios])

    return {
        "branch_name": texts(BRANCH_NAMES),
        "ratio_numerator": texts([ratio.numerator for ratio in ratios]),
        "ratio_denominator": texts([ratio.denominator for ratio in ratios]),
        "ratio_strain_bin": ratios[0].strain_bin,
        "modulus_ratio": stacked("ratio"),
        "modulus_ratio_standard_uncertainty": stacked("ratio_standard_uncertainty"),
        "modulus_ratio_low": stacked("ratio_low"),
        "modulus_ratio_high": stacked("ratio_high"),
        "modulus_ratio_degrees_of_freedom": np.stack(
            [np.broadcast_to(one.degrees_of_freedom, one.ratio.shape) for one in ratios]
        ),
        "modulus_ratio_is_different": stacked("is_different"),
    }


def stress_at_strain_values(stress: Floats, uncertainty: Floats, levels: Sequence[float]) -> Values:
    """Return the stress at stated elongations, in ascending order."""
    order = np.argsort(np.asarray(levels, dtype=np.float64), kind="stable")
    return {
        "strain_level": np.asarray(levels, dtype=np.float64)[order],
        "stress_at_strain": stress[..., order],
        "stress_at_strain_standard_uncertainty": uncertainty[..., order],
    }


def elastomer_values(fits: Sequence[ElastomerFit]) -> Values:
    """Return the fitted laws, with one row per parameter, a modulus or an exponent."""
    rows = [
        (number, name, value, fit.standard_uncertainty.get(name))
        for number, fit in enumerate(fits, start=1)
        for name, value in fit.parameters.items()
    ]
    is_exponent = ["exponent" in name for _, name, _, _ in rows]
    values: Values = {
        "elastomer_specimen": texts([fit.specimen for fit in fits]),
        "elastomer_law": texts([fit.law for fit in fits]),
        "elastomer_rms_stress": numbers([fit.rms_stress for fit in fits]),
        "elastomer_strain_low": numbers([fit.strain_low for fit in fits]),
        "elastomer_strain_high": numbers([fit.strain_high for fit in fits]),
        "elastomer_is_stable": np.array([fit.is_stable for fit in fits], dtype=bool),
        "elastomer_aicc": numbers([fit.aicc for fit in fits]),
        "elastomer_parameter_fit": np.array([row[0] for row in rows], dtype=np.int32),
        "elastomer_parameter_name": texts([row[1] for row in rows]),
    }
    for name, wanted in (("elastomer_modulus", False), ("elastomer_exponent", True)):
        chosen = [exponent is wanted for exponent in is_exponent]
        if any(chosen):
            value = numbers([row[2] for row in rows])
            uncertainty = numbers([row[3] for row in rows])
            values[name] = np.where(chosen, value, np.nan)
            values[f"{name}_standard_uncertainty"] = np.where(chosen, uncertainty, np.nan)
    return values


_PLAIN = (
    "hold_start_time",
    "hold_duration",
    "hold_strain",
    "hold_strain_standard_uncertainty",
    "hold_initial_tension",
    "hold_initial_tension_standard_uncertainty",
    "hold_final_tension",
    "hold_final_tension_standard_uncertainty",
    "relaxation_drop",
    "relaxation_drop_standard_uncertainty",
    "long_time_tension",
    "long_time_tension_standard_uncertainty",
)

_OF_RAMP = (
    "ramp_centre_time",
    "ramp_end_time",
    "ramp_duration",
    "logged_peak_tension",
    "ramp_end_tension",
)

_PRONY = (
    "prony_tension",
    "prony_tension_standard_uncertainty",
    "prony_time",
    "prony_time_standard_uncertainty",
    "prony_fraction_at_ramp_end",
)


def standstill_values(standstills: Standstills) -> Values:
    """Return every interval with constant position, or with constant tension at load control."""
    values: Values = {
        "standstill_start_time": standstills.start_time,
        "standstill_end_time": standstills.end_time,
        "standstill_position": standstills.mean_position,
        "standstill_tension": standstills.mean_tension,
        "standstill_is_rest": standstills.is_rest,
        "standstill_position_tolerance": np.array(standstills.position_tolerance),
        "slack_tension": np.array(standstills.slack_tension),
    }
    if standstills.tension_tolerance is not None:
        values["hold_tension_tolerance"] = np.array(standstills.tension_tolerance)
    return values


def hold_values(holds: Sequence[HoldResult]) -> Values:
    """Return one row per hold and specimen, with ragged parts padded with NaN."""
    values: Values = {
        "hold": np.arange(1, len(holds) + 1),
        "hold_number": hold_numbers(holds),
        "hold_specimen": texts([one.specimen for one in holds]),
        "hold_kind": texts([one.kind for one in holds]),
        "hold_criterion": texts([one.criterion for one in holds]),
        "hold_refusal": texts([one.refused for one in holds]),
    }
    for name in _PLAIN:
        values[name] = numbers([getattr(one, name) for one in holds])
    for name in _OF_RAMP:
        values[f"hold_{name}"] = numbers([getattr(one, name) for one in holds])
    for kind in ("relaxation", "creep"):
        # tension ratio and strain gain are two quantities, with two names
        chosen = [one.kind == kind for one in holds]
        for suffix in ("", "_standard_uncertainty"):
            rate = numbers([getattr(one, f"rate_per_decade{suffix}") for one in holds])
            values[f"{kind}_rate_per_decade{suffix}"] = np.where(chosen, rate, np.nan)
    times = np.unique(np.concatenate([np.empty(0), *(one.times for one in holds)]))
    values["hold_time"] = times
    for name in ("tension_at_time", "strain_at_time"):
        for suffix in ("", "_standard_uncertainty"):
            values[f"{name}{suffix}"] = _on_common_times(holds, f"{name}{suffix}", times)
    for name in _PRONY:
        values[name] = pad([getattr(one, name) for one in holds])
    values["prony_term"] = np.arange(1, values["prony_time"].shape[1] + 1)
    return values


def _on_common_times(holds: Sequence[HoldResult], name: str, times: Floats) -> Floats:
    table = np.full((len(holds), times.size), np.nan)
    for row, one in zip(table, holds, strict=True):
        given = getattr(one, name)
        if given.size:
            row[np.searchsorted(times, one.times)] = given
    return table


def lag_values(estimate: LagEstimate) -> Values:
    """Return the channel lag estimated from the turns of the wave."""
    return {
        "channel_lag": estimate.lag,
        "channel_lag_standard_uncertainty": estimate.standard_uncertainty,
        "channel_lag_turns": estimate.n_turns,
        "channel_lag_refusal": estimate.refusal,
    }


def line_values(
    cycles: LineParameters, test: LineParameters, constant_spread: Floats | None
) -> Values:
    """Return parameters of each cycle and of the test, with the uncertainty of its K_0."""
    values: Values = {
        "line_refusal": cycles.reason,
        "test_line_refusal": test.reason,
        "test_line_conditioning": test.conditioning,
        "test_quasi_static_spring_constant": test.quasi_static_spring_constant,
    }
    if constant_spread is not None:
        values["test_quasi_static_spring_constant_standard_uncertainty"] = constant_spread
    for name in LINE_PARAMETERS:
        values[name] = getattr(cycles, name)
        values[f"{name}_standard_uncertainty"] = cycles.uncertainty[name]
        values[f"test_{name}"] = getattr(test, name)
        values[f"test_{name}_standard_uncertainty"] = test.uncertainty[name]
    return values


def random_of_line(cycles: LineParameters, test: LineParameters) -> Values:
    """Return the random part of the lines of cycles and test; the fit of a slow pull is shared."""
    names = {name: cycles.random_uncertainty[name] for name in LINE_PARAMETERS}
    names |= {f"test_{name}": test.random_uncertainty[name] for name in LINE_PARAMETERS}
    constant = test.quasi_static_spring_constant
    return names | {"test_quasi_static_spring_constant": np.where(np.isnan(constant), np.nan, 0.0)}


def spread_of_line_values(spread: LineSpread, values: Values) -> Values:
    """Return interval and method for the line of a test, and its uncertainty if drawn."""
    found: Values = {
        "test_line_uncertainty_method": spread.method,
        "test_line_without_solution_share": spread.without_solution_share,
    }
    drawn = spread.method == LINE_METHODS["monte_carlo"]
    for name in LINE_PARAMETERS:
        key = f"test_{name}_standard_uncertainty"
        found[key] = np.where(drawn, spread.standard_uncertainty[name], values[key])
        found[f"test_{name}_low"] = spread.low[name]
        found[f"test_{name}_high"] = spread.high[name]
    return found


def pull_values(pulls: tuple[SlowPull | None, ...], specimens: tuple[Specimen, ...]) -> Values:
    """Return the slow pull of each specimen on one tension grid; NaN without a pull."""
    given = [one for one in pulls if one is not None]
    if not given:
        return {}
    grid = tension_grid(pulls)
    values: Values = {"tension_grid": grid, "pull_term": np.arange(4)}
    values |= _on_axis("quasi_static_spring_constant", pulls, quasi_static_spring_constant, grid)
    values |= _on_axis("quasi_static_strain", pulls, strain_at_tension, grid)
    columns: dict[str, Callable[[SlowPull], ArrayLike]] = {
        "pull_strain_coefficient": lambda one: one.strain_coefficient,
        "pull_strain_coefficient_standard_uncertainty": lambda one: np.sqrt(
            np.diag(one.strain_coefficient_covariance)
        ),
        "pull_spring_constant_coefficient": lambda one: one.polynomial_coefficient,
        "pull_tension_low": lambda one: one.tension_low,
        "pull_tension_high": lambda one: one.tension_high,
        "pull_strain_rate": lambda one: one.strain_rate,
        "pull_waiting_time": lambda one: one.waiting_time,
        "pull_residual": lambda one: one.residual_deviation,
        "pull_reference_tension": lambda one: one.reference_tension,
    }
    for name, column in columns.items():
        missing = np.full(np.shape(column(given[0])), np.nan)
        values[name] = np.array([missing if one is None else column(one) for one in pulls])
    values["pull_waiting"] = texts(["" if one is None else one.waiting for one in pulls])
    strengths = [specimen.rated_break_strength for specimen in specimens]
    if any(strengths):
        shares = np.array(BREAK_SHARES)
        at_share = [
            (np.full(shares.size, np.nan),) * 2
            if one is None or strength is None
            else strain_at_break_share(one, shares, rated_break_strength=strength)
            for one, strength in zip(pulls, strengths, strict=True)
        ]
        values |= _both("strain_at_break_share", at_share) | {"break_share": shares}
    return values


def _on_axis(
    name: str,
    pulls: tuple[SlowPull | None, ...],
    function: Callable[[SlowPull, ArrayLike], tuple[Floats, Floats]],
    axis: Floats,
) -> Values:
    missing = np.full(axis.size, np.nan)
    return _both(
        name, [(missing, missing) if one is None else function(one, axis) for one in pulls]
    )


def _both(name: str, pairs: Sequence[tuple[Floats, ...]]) -> Values:
    return {
        name: np.array([pair[0] for pair in pairs]),
        f"{name}_standard_uncertainty": np.array([pair[1] for pair in pairs]),
    }


_U = "_standard_uncertainty"

_OVER = re.compile("_over_strength|^creep_compliance")


def rope_values(step: RopeStep, specimens: tuple[Specimen, ...]) -> Values:
    """Return the results of one programme step; missing parts are left out."""
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
    """Values of the single level of a step."""
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
    """One row per pair of holds and specimen; NaN if its stiffness is refused."""
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
    """Values along the holds of the test, one entry each."""
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
    """Strength and strain at failure of broken specimens; the maximum tension of all."""
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


def stepwise_values(result: StepwiseResult) -> Values:
    """Return the readings by their contract names: ``gauge_length`` is the length read."""
    flags = {
        "length_and_elongation_disagree": result.is_inconsistent,
        "creep": result.is_creep,
        "off_its_neighbours": result.is_odd,
    }
    shape, reading = result.strain.shape, result.length_standard_uncertainty
    return {
        "channel": texts(["readings"]),
        "quality_mask": texts(list(flags)),
        "n_flagged": np.array([[np.count_nonzero(rows) for rows in flags.values()]]),
        "n_rows_read": np.array(result.time.size),
        "n_rows_kept": np.array(result.time.size),
        "clock": texts(result.clock),
        "time": result.time,
        "tension": result.tension,
        "tension_standard_uncertainty": np.full(shape, result.tension_standard_uncertainty),
        "gauge_length": result.length,
        "gauge_length_standard_uncertainty": np.full(shape, reading),
        "eye_to_eye_length": result.eye_to_eye_length,
        "printed_strain": result.printed_strain,
        "strain": result.strain,
        "strain_standard_uncertainty": np.full(shape, reading / result.gauge_length),
        "branch": result.branch,
        "step_flag": np.sum([STEP_MASKS[name] * rows for name, rows in flags.items()], axis=0),
        "secant_modulus": result.secant_modulus,
        "secant_modulus_standard_uncertainty": result.secant_modulus_standard_uncertainty,
        "relaxed_gauge_length": np.array(result.gauge_length),
        "relaxed_gauge_length_standard_uncertainty": np.array(
            result.gauge_length_standard_uncertainty
        ),
        "interval_strain": result.interval_strain,
        "interval_modulus": result.interval_modulus,
        "interval_modulus_standard_uncertainty": result.interval_modulus_standard_uncertainty,
        "interval_branch": result.interval_branch,
    }
