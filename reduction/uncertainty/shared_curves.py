"""Shared errors in loops, curves, segments, first loading and ratios of a test.

Blocks of cycles: what shared errors do to each cycle is worked out for some at a time.

What shared errors add to the loops of a specimen, to its dynamic modulus and to its line.

What shared errors add to the curves and the segments of a specimen.

What shared errors add to a first loading's stresses and laws, to slack lengths, sections.

What shared errors add to the ratios of moduli of a test.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any, Literal, TypeVar

import numpy as np
import scipy

from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    merged,
    stacked,
)
from reduction.record.measurement import Floats, areas_of
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.line.line_product import LineParameters
from reduction.stages.moduli.elastomer_laws import LAWS
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    ElastomerFit,
    ModulusCurves,
    Segments,
)
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.strain.strain_model import StrainModel, position_by_model
from reduction.uncertainty.error_field import coefficient_errors, error_field
from reduction.uncertainty.propagation import (
    by_diameter,
    curve_contributions,
    diameter_error,
    elastomer_contributions,
    line_contributions,
    loop_contributions,
    ratio_contributions,
    section_contributions,
    segment_contributions,
    strain_rate_of_wave,
    stress_contributions,
    with_diameter,
    with_shared_interval,
)

# every component has a row of each quantity of each cycle
_BLOCK = 1 << 14

Product = TypeVar("Product")


def blocks_of_cycles(n_cycles: int) -> Iterator[slice]:
    """Slices that cover the cycles of a test."""
    for start in range(0, n_cycles, _BLOCK):
        yield slice(start, min(start + _BLOCK, n_cycles))


def cycles_of_test(test: ReducedTest, block: slice) -> ReducedTest:
    """The test with the quantities of some of its cycles; means and curves stay those of all."""
    if test.cycles is None:
        return test
    return replace(
        test,
        cycles=_cycles(test.cycles, block),
        loops=_part(test.loops, block),
        end_moduli=_part(test.end_moduli, block),
        line=_part(test.line, block),
    )


def _cycles(cycles: Cycles, block: slice) -> Cycles:
    return replace(
        cycles,
        first=cycles.first[block],
        last=cycles.last[block],
        branch_first=cycles.branch_first[block],
        branch_last=cycles.branch_last[block],
        plateau_rate=cycles.plateau_rate[block],
    )


def _part(product: Product, block: slice) -> Product:
    """A product whose arrays have shape (n_specimens, n_cycles, ...), of some of the cycles."""
    if product is None:
        return product
    changes: dict[str, Any] = {}
    for item in fields(product):  # type: ignore[arg-type]
        value = getattr(product, item.name)
        if isinstance(value, np.ndarray):
            changes[item.name] = value[:, block]
        elif isinstance(value, dict):
            changes[item.name] = {name: array[:, block] for name, array in value.items()}
    return replace(product, **changes)  # type: ignore[type-var]


Reading = Literal["amplitude", "fundamental"]

_LOOP = (
    "frequency", "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude",
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant",
)  # fmt: skip

_K_0 = "quasi_static_spring_constant"


def _speed_ratio(
    loops: Loops | AmplitudeSummary,
    index: int,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
) -> Floats:
    """Speed of the ramps over that of ramps without a stop at their ends."""
    frequency, mean, amplitude = (
        getattr(loops, name)[index] for name in ("frequency", "mean_strain", "strain_amplitude")
    )
    tension, swing = loops.mean_tension[index], loops.tension_amplitude[index]
    if settings.control == "load":
        half = swing
    elif model.method == "extensometer":
        return np.ones(np.shape(frequency))
    else:
        ends = [
            position_by_model(model, strain=mean + way * amplitude, tension=tension + way * swing)
            for way in (1, -1)
        ]
        half = (ends[0] - ends[1]) / 2
    plateau = cycles.plateau_rate.mean(axis=1)
    if np.ndim(frequency) == 0:
        plateau = np.asarray(np.nanmedian(plateau))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = plateau / (4 * frequency * half)
    usable = np.isfinite(ratio) & (ratio > 1)
    return np.asarray(np.where(usable, ratio, 1.0))


def of_loops(
    loops: Loops | AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
) -> Contributions:
    """Each cycle of a specimen, or the means of its test."""
    return loop_contributions(
        errors, model,
        **{name: np.asarray(getattr(loops, name)[index]) for name in _LOOP},
        waveform=settings.waveform,
        control=settings.control,
        speed_ratio=_speed_ratio(loops, index, model, cycles, settings),
    )  # fmt: skip


def of_dynamic_modulus(
    of_loop: Contributions,
    summary: AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    area: float,
) -> Contributions:
    """Spring constant over area."""
    rows = of_loop.values["apparent_spring_constant"] / area
    component = of_loop.component
    if errors.diameter:
        component = (*component, diameter_error(errors))
        own = by_diameter(summary.dynamic_modulus[index], errors, area=area)
        rows = np.concatenate([rows, own[None]])
    return Contributions(component, {"dynamic_modulus": rows})


def of_line(
    line: LineParameters,
    loops: Loops | AmplitudeSummary,
    index: int,
    of_loop: Contributions,
    of_rest: Contributions,
) -> Contributions:
    """K_1, tau and K_1 tau of each cycle of a specimen, or of the means of its test."""
    values: Mapping[str, Floats] = {
        item.name: getattr(line, item.name)[index]
        for item in fields(line)
        if isinstance(getattr(line, item.name), np.ndarray)
    } | {name: np.asarray(getattr(loops, name)[index]) for name in _LOOP if name not in
         ("storage_spring_constant", "loss_spring_constant")}  # fmt: skip
    # one K_0 a run: its error is that of every cycle
    rest = of_rest.values[_K_0]
    shape = (*rest.shape[:1], *np.shape(values[_K_0]))
    rest = np.broadcast_to(rest.reshape(rest.shape[:1] + (1,) * (len(shape) - 1)), shape)
    reading: Reading = "fundamental" if line.reading == "fundamental" else "amplitude"
    found = line_contributions(
        of_loop, Contributions(of_rest.component, {_K_0: rest}), values, reading=reading
    )
    names = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
    return Contributions(found.component, {name: found.values[name] for name in names})


_SMOOTHED = 5  # bins: a slope of the modulus from bin to bin is mostly scatter


def strain_rates(
    test: ReducedTest, index: int, model: StrainModel, cycles: CycleSettings
) -> Floats:
    """Strain rate on the grid, and its slope over strain; descending below ascending."""
    if test.amplitude is None or test.cycles is None or test.curves is None:
        return np.zeros((2, 2, 0 if test.curves is None else test.curves.strain_bin.size))
    summary = test.amplitude
    frequency, amplitude = summary.frequency[index], summary.strain_amplitude[index]
    if not (frequency > 0 and amplitude > 0):
        return np.zeros((2, 2, test.curves.strain_bin.size))
    rate, slope = strain_rate_of_wave(
        test.curves.strain_bin,
        frequency=float(frequency),
        mean_strain=float(summary.mean_strain[index]),
        strain_amplitude=float(amplitude),
        waveform=cycles.waveform,
        speed_ratio=float(_speed_ratio(summary, index, model, test.cycles, cycles)),
    )
    return np.stack([[rate, -rate], [slope, -slope]])


def rise_rates(test: ReducedTest, index: int) -> Floats:
    """Strain rate of the first rise on its grid, and its slope; zero on the descending branch.

    From the times at which a strain is first reached: a stop on the way is one slow bin, which the
    median of its neighbours leaves out.
    """
    if test.first_loading is None or test.record is None or test.strain is None:
        return np.zeros(
            (2, 2, 0 if test.first_loading is None else test.first_loading.strain_bin.size)
        )
    at = test.first_loading.strain_bin
    still = np.zeros(at.size)
    strain = test.strain[index]
    reached = strain >= at[-1]
    end = int(reached.argmax()) + 1 if reached.any() else strain.size
    highest = np.fmax.accumulate(strain[:end])
    begin = int(np.isfinite(highest).argmax())
    place = np.searchsorted(highest[begin:], at) + begin
    inside = place < end
    if inside.sum() <= _SMOOTHED:
        return np.stack([[still, still], [still, still]])
    reach, time = at[inside], test.record.time[place[inside]]
    with np.errstate(divide="ignore"):
        found = scipy.ndimage.median_filter(
            np.gradient(reach) / np.gradient(time), size=_SMOOTHED, mode="nearest"
        )
    rate = np.interp(at, reach, np.where(np.isfinite(found), found, 0.0))
    return np.stack([[rate, still], [_smooth_slope(rate, at), still]])


def _smooth_slope(modulus: Floats, strain: Floats) -> Floats:
    """Slope of the modulus over strain, of a running mean; zero where there are too few bins."""
    known = np.isfinite(modulus)
    if known.sum() <= _SMOOTHED:
        return np.zeros(modulus.shape)
    at, values = strain[known], modulus[known]
    edge = _SMOOTHED // 2
    # straight lines in windows: a running mean would flatten the ends
    left = np.clip(np.arange(at.size) - edge, 0, at.size - _SMOOTHED)
    window = left[:, None] + np.arange(_SMOOTHED)
    x = at[window] - at[window].mean(axis=1, keepdims=True)
    slope = np.sum(x * values[window], axis=1) / np.sum(x**2, axis=1)
    return np.asarray(np.interp(strain, at, slope))


def of_curves(
    curves: ModulusCurves,
    suffix: str,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
) -> Contributions:
    """Both branches of one specimen, by name of the archive."""
    known = curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index]
    # readers take an error of strain back out of the tension by the slope that an archive has there
    slope = np.where(np.isfinite(known[1]), known[1], known[0])
    tension, slope = _completed(curves.strain_bin, curves.branch_tension[index], slope, area)
    strain = np.broadcast_to(curves.strain_bin, tension.shape)
    field = error_field(errors, model, strain=strain, tension=tension)

    def at_slope(modulus: Floats) -> Contributions:
        bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
        return curve_contributions(
            field, errors, tangent_modulus=modulus, area=area, modulus_slope=bend,
            strain_rate=rate[0], strain_rate_slope=rate[1],
        )  # fmt: skip

    of_tension = at_slope(slope)
    values = {f"branch_tension{suffix}": of_tension.values["branch_tension"]}
    names = ("tangent_modulus",) if suffix else ("tangent_modulus", "tangent_modulus_untrimmed")
    for name, modulus in zip(names, known, strict=False):
        whole = np.where(np.isfinite(modulus), modulus, slope)
        values[f"{name}{suffix}"] = at_slope(whole).values["tangent_modulus"]
    return Contributions(of_tension.component, values)


def _completed(
    strain: Floats, tension: Floats, modulus: Floats, area: float
) -> tuple[Floats, Floats]:
    """Tension and modulus of each branch where either is known, the other from it.

    A bin may have enough samples for a mean and too few for a slope, or the reverse: an error at
    its strain moves both.
    """
    filled, slopes = tension.copy(), modulus.copy()
    for row, slope in zip(filled, slopes, strict=True):
        has = np.isfinite(row)
        if has.sum() < 2:
            continue
        bare = has & ~np.isfinite(slope)
        slope[bare] = np.gradient(row[has], strain[has])[bare[has]] / area
        lacks = np.isfinite(slope) & ~has
        nearest = np.flatnonzero(has)[np.abs(strain[lacks, None] - strain[has]).argmin(axis=1)]
        row[lacks] = row[nearest] + area * slope[lacks] * (strain[lacks] - strain[nearest])
    return filled, slopes


def of_segments(
    curves: ModulusCurves,
    segments: Segments,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
) -> Contributions:
    """Segments of both branches; zero where a branch has none."""
    of_curve = of_curves(curves, "", index, errors, model, area, rate)
    low, high = segments.segment_strain_low[index], segments.segment_strain_high[index]
    shape = (len(of_curve.component), *low.shape)
    names = ("segment_modulus", "segment_tension_low", "segment_tension_high")
    values = {name: np.zeros(shape) for name in names}
    for branch in range(low.shape[0]):
        known = np.isfinite(low[branch])
        if not known.any():
            continue
        knot = np.append(low[branch, known], high[branch, known][-1])
        rows = of_curve.values["branch_tension"][:, branch]
        inside = (curves.strain_bin >= knot[0]) & (curves.strain_bin <= knot[-1])
        inside &= np.isfinite(rows).all(axis=0)
        found = segment_contributions(
            Contributions(of_curve.component, {"branch_tension": rows[:, inside]}),
            errors, strain=curves.strain_bin[inside], knot=knot,
            segment_modulus=segments.segment_modulus[index, branch, known], area=area,
        )  # fmt: skip
        for name in names:
            values[name][:, branch, known] = found.values[name]
    return Contributions(of_curve.component, values)


_LENGTHS = ("relaxed_free_length", "gauge_length")


def of_material(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Iterator[Contributions]:
    """Stress at stated elongations, strain at slack, section of one specimen."""
    if test.stress_at_strain is not None and test.first_loading is not None:
        yield _of_stress(test, index, errors, model, area)
    yield from _of_slack(test, index, errors, model)
    if np.isfinite(area):
        yield section_contributions(errors, area=area)


def _of_stress(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Contributions:
    """In the order of the archive: rising elongation."""
    if test.first_loading is None or test.stress_at_strain is None:
        return Contributions(())
    level = np.asarray(test.stress_at_strain_levels, dtype=np.float64)
    stress = test.stress_at_strain[index]
    modulus = test.first_loading.tangent_modulus[index, 0]
    known = np.isfinite(modulus)
    slope = (
        np.interp(level, test.first_loading.strain_bin[known], modulus[known])
        if known.any()
        else np.full(level.shape, np.nan)
    )
    field = error_field(errors, model, strain=level, tension=stress * area)
    rate = (
        np.interp(level, test.first_loading.strain_bin, rise_rates(test, index)[0, 0])
        if errors.lag
        else 0.0
    )
    found = stress_contributions(
        field, errors, stress=stress, tension_slope=slope * area, area=area, strain_rate=rate
    )
    order = np.argsort(level, kind="stable")
    return Contributions(found.component, {"stress_at_strain": found.values["stress"][:, order]})


def _of_slack(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel
) -> Iterator[Contributions]:
    """Differences of two positions at one small tension, over the relaxed length.

    A zero of the crosshead is in both and cancels; where the zero of the load cell is high both are
    found at less tension than is meant, and move by as much as the specimen stretches for it there.
    A gain moves the slack tension with it, which is a share of the greatest tension; of one that is
    stated it would be a gain's share of that small tension, and is left out.
    """
    of_model = errors.strain_model or errors.specimen
    # of each error: its share of the length, of the tension at the crossings, of their time
    parts = [
        (Component("position_gain", errors.position_instrument), errors.position_gain, 0.0, 0.0),
        (Component("strain_gain", of_model), errors.strain_gain, 0.0, 0.0),
        (Component("tension_offset", errors.tension_instrument), 0.0, -errors.tension_offset, 0.0),
        (Component("lag", errors.tension_instrument), 0.0, 0.0, errors.lag),
    ]
    name = next((one for one in _LENGTHS if one in model.coefficients), None)
    if name is not None:
        # the errors of the tape that are in every strain of the test
        by_tape = coefficient_errors(model)[list(model.coefficients).index(name)]
        parts += [
            (Component("strain_calibration", of_model, number), -share, 0.0, 0.0)
            for number, share in enumerate((by_tape / model.coefficients[name]).tolist())
        ]
    parts = [one for one in parts if any(one[1:])]
    if not parts:
        return
    component = tuple(one[0] for one in parts)
    by_length, by_tension, by_time = np.array([one[1:] for one in parts]).T
    history, slack = test.history, test.slack_strain
    values = {}
    if slack is not None:
        values["slack_strain_at_unloading"] = (
            by_length * slack.strain[index]
            + by_tension * slack.by_tension[index]
            + by_time * slack.by_lag[index]
        )
    if history is not None:
        # both crossings of a set are on first rises, which go at one rate: a lag leaves it alone
        values["permanent_set"] = (
            by_length * history.permanent_set[index]
            + by_tension * history.permanent_set_by_tension[index]
        )
    yield Contributions(component, values)


def of_elastomers(
    test: ReducedTest, errors: Sequence[InstrumentErrors], found: Contributions
) -> list[Contributions]:
    """Every parameter of every law, along one axis; an empty list where there is none.

    ``found`` holds the contributions to the tension of the first loading.
    """
    first = test.first_loading
    rows = found.values.get("branch_tension_first_loading")
    if not test.elastomers or first is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    areas = areas_of(test.specimens)
    own = []
    for fit in test.elastomers:
        place = names.index(fit.specimen)
        area = float(areas[place])
        stress = Contributions(found.component, {"stress": rows[:, place, 0] / area})
        value = {"stress": first.branch_tension[place, 0] / area}
        diameterless = [one.source != "diameter" for one in stress.component]
        stress = Contributions(
            tuple(one for one in stress.component if one.source != "diameter"),
            {"stress": stress.values["stress"][diameterless]},
        )
        stress = with_diameter(stress, errors[place], value, area=area)
        own += _of_fit(stress, first.strain_bin, value["stress"], fit)
    return [stacked(own)]


def _of_fit(
    contribution: Contributions, strain: Floats, stress: Floats, fit: ElastomerFit
) -> list[Contributions]:
    """One entry a parameter: a modulus or an exponent, whichever it is."""
    if np.isfinite(list(fit.parameters.values())).all():
        rows = elastomer_contributions(
            contribution.values["stress"], strain=strain, stress=stress,
            law=next(one for one in LAWS if one == fit.law), parameters=fit.parameters,
        )  # fmt: skip
    else:
        rows = np.full((len(contribution.component), len(fit.parameters)), np.nan)
    return [
        merged(
            [
                Contributions(
                    contribution.component,
                    {"elastomer_modulus": column, "elastomer_exponent": column},
                )
            ]
        )
        for column in rows.T
    ]


def of_ratios(test: ReducedTest, found: Contributions) -> list[Contributions]:
    """Every ratio, along one axis; ``found`` holds the contributions to the moduli.

    Two sets of cycles of one specimen share every error of its instruments, its section and its
    splices in equal shares: they cancel.
    """
    rows = found.values.get("tangent_modulus")
    if not test.ratios or test.curves is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    moduli = test.curves.tangent_modulus
    tables: list[Floats] = []
    for ratio in test.ratios:
        if ratio.numerator not in names or ratio.denominator not in names:
            tables.append(np.zeros((len(found.component), *ratio.ratio.shape)))
            continue
        above, below = names.index(ratio.numerator), names.index(ratio.denominator)
        tables.append(
            ratio_contributions(
                ratio.ratio,
                numerator=moduli[above],
                of_numerator=rows[:, above],
                denominator=moduli[below],
                of_denominator=rows[:, below],
            )
        )
    return [Contributions(found.component, {"modulus_ratio": np.stack(tables, axis=1)})]


def with_shared_ratios(test: ReducedTest) -> ReducedTest:
    """Ratios with the interval of all errors; as they are where none is shared."""
    shared = test.contributions
    rows = None if shared is None else shared.values.get("modulus_ratio")
    if shared is None or rows is None:
        return test
    names = {one.name for one in test.specimens}
    wider = [
        with_shared_interval(ratio, rows[:, place], of_contribution=shared.degrees_of_freedom)
        if ratio.numerator in names
        else ratio
        for place, ratio in enumerate(test.ratios)
    ]
    return replace(test, ratios=tuple(wider))
