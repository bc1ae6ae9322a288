"""Shared errors carried to curves, segments, stress at stated elongations and laws of rubber."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    merged,
    stacked,
)
from reduction.record.measurement import Floats, areas_of
from reduction.record.samples import sample_blocks
from reduction.record.settings import CycleSettings
from reduction.stages.moduli.elastomer_laws import LAWS
from reduction.stages.moduli.modulus_product import (
    ElastomerFit,
    ModulusCurves,
    Segments,
)
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.error_field import (
    Inertia,
    coefficient_errors,
    error_field,
    splice_friction_error,
)
from reduction.uncertainty.errors_of_cycles import ramp_speed_ratio
from reduction.uncertainty.propagation import (
    curve_contributions,
    elastomer_contributions,
    ratio_contributions,
    reversibility_error,
    section_contributions,
    segment_contributions,
    strain_rate_of_wave,
    stress_contributions,
    with_diameter,
    with_shared_interval,
)

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
    if cycles.waveform == "other" and test.record is not None and test.strain is not None:
        rates = _logged_rates(
            test.record.time, test.strain[index], test.cycles.branch, test.curves.strain_bin
        )
        return np.stack([rates, [_smooth_slope(one, test.curves.strain_bin) for one in rates]])
    rate, slope = strain_rate_of_wave(
        test.curves.strain_bin,
        frequency=float(frequency),
        mean_strain=float(summary.mean_strain[index]),
        strain_amplitude=float(amplitude),
        waveform=cycles.waveform,
        speed_ratio=float(
            ramp_speed_ratio(summary, index, model, test.cycles, cycles, test.record)
        ),
    )
    return np.stack([[rate, -rate], [slope, -slope]])


def _logged_rates(
    time: Floats, strain: Floats, branch: NDArray[np.int8], strain_bin: Floats
) -> Floats:
    """Mean strain rate of both branches in the bins of strain, shape (2, n_bins).

    Examples
    --------
    Up at 1 per second to the middle, then at 3 per second, and down at 2 per second:

    >>> time = np.arange(0, 1.166, 0.001)
    >>> strain = np.interp(time, [0, 0.5, 0.5 + 1 / 6, 0.5 + 1 / 6 + 0.5], [0, 0.5, 1, 0])
    >>> branch = np.where(time < 0.5 + 1 / 6, 1, 2).astype(np.int8)
    >>> print(_logged_rates(time, strain, branch, np.array([0.25, 0.75])).round(1))
    [[ 1.  3.]
     [-2. -2.]]
    """
    n_bins = strain_bin.size
    edges = (strain_bin[1:] + strain_bin[:-1]) / 2
    moved, lasted = np.zeros(2 * n_bins), np.zeros(2 * n_bins)
    for part in sample_blocks(time.size, time, strain, overlap=1):
        step, seconds, sides = np.diff(strain[part]), np.diff(time[part]), branch[part][:-1]
        here = np.flatnonzero((sides > 0) & np.isfinite(step))
        place = np.searchsorted(edges, strain[part][here]) + np.where(sides[here] > 1, n_bins, 0)
        moved += np.bincount(place, step[here], 2 * n_bins)
        lasted += np.bincount(place, seconds[here], 2 * n_bins)
    rates = np.zeros((2, n_bins))
    for row, way, over in zip(rates, moved.reshape(2, -1), lasted.reshape(2, -1), strict=True):
        known = over > 0
        if known.any():
            row[:] = np.interp(strain_bin, strain_bin[known], way[known] / over[known])
    return rates


def rise_rates(test: ReducedTest, index: int) -> Floats:
    """Strain rate of the first rise on its grid, and its slope; zero on the descending branch.

    Computed from the times at which each strain is first reached: a stop on the way is one slow
    bin, which a running median removes.
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
    """Slope of the modulus over strain, from lines over a few bins; zero if there are too few."""
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


def errors_of_curves(
    curves: ModulusCurves,
    suffix: str,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
    inertia: Inertia | None = None,
) -> Contributions:
    """Both branches of one specimen, by name of the archive."""
    known = curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index]
    # readers remove an error of strain from the tension by the slope stored in the archive
    slope = np.where(np.isfinite(known[1]), known[1], known[0])
    tension, slope = _completed(curves.strain_bin, curves.branch_tension[index], slope, area)
    strain = np.broadcast_to(curves.strain_bin, tension.shape)
    field = error_field(errors, model, strain=strain, tension=tension, inertia=inertia)
    of_inertia = (
        np.zeros(tension.shape)
        if inertia is None
        else inertia.mass * inertia.acceleration(model, strain=strain, tension=tension)[1]
    )

    def at_slope(modulus: Floats) -> Contributions:
        bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
        return curve_contributions(
            field, errors, tangent_modulus=modulus, area=area, modulus_slope=bend,
            strain_rate=rate[0], strain_rate_slope=rate[1], inertia_slope=of_inertia,
        )  # fmt: skip

    of_tension = at_slope(slope)
    values = {f"branch_tension{suffix}": of_tension.values["branch_tension"]}
    names = ("tangent_modulus",) if suffix else ("tangent_modulus", "tangent_modulus_untrimmed")
    for name, modulus in zip(names, known, strict=False):
        whole = np.where(np.isfinite(modulus), modulus, slope)
        values[f"{name}{suffix}"] = at_slope(whole).values["tangent_modulus"]
    component = of_tension.component
    if errors.splice_friction and not suffix:  # the marks are read on the way of a first rise
        away, steeper = _friction_on_branches(errors, model, curves.strain_bin, tension)
        rise = area * slope
        values["branch_tension"] = np.concatenate([values["branch_tension"], (-rise * away)[None]])
        for name in names:
            modulus = getattr(curves, name)[index]
            modulus = np.where(np.isfinite(modulus), modulus, slope)
            bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
            own = -(modulus * steeper + bend * away)
            values[name] = np.concatenate([values[name], own[None]])
        component = (*component, Component("splice_friction", errors.specimen))
    if errors.tension_reversibility and not suffix:  # a first rise has no way down
        off, steeper = _reversibility_on_branches(errors, tension)
        felt = 1 - field.strain_by_tension * area * slope
        values["branch_tension"] = np.concatenate([values["branch_tension"], (felt * off)[None]])
        for name in names:
            modulus = getattr(curves, name)[index]
            own = felt * steeper * np.where(np.isfinite(modulus), modulus, slope)
            values[name] = np.concatenate([values[name], own[None]])
        component = (*component, Component("tension_reversibility", errors.tension_instrument))
    if curves.tangent_modulus_window_uncertainty is None:
        return Contributions(component, values)
    missed = np.nan_to_num(curves.tangent_modulus_window_uncertainty[index])
    by_window = {
        "branch_tension": np.zeros_like(missed),
        "tangent_modulus_untrimmed": np.hypot(missed, _window_blur(curves, index)),
    }
    values = {
        name: np.concatenate([rows, by_window.get(name, missed)[None]])
        for name, rows in values.items()
    }
    window = Component("window", f"{errors.test} {errors.specimen}")
    return Contributions((*component, window), values)


def _reversibility_on_branches(errors: InstrumentErrors, tension: Floats) -> tuple[Floats, Floats]:
    """Error of tension by the load cell on the way down, and its slope over tension."""
    off, steeper = np.zeros(tension.shape), np.zeros(tension.shape)
    down = tension[1]
    known = np.isfinite(down)
    if known.sum() > 1:
        off[1, known], steeper[1, known] = reversibility_error(
            errors, down[known], np.min(down[known]), np.max(down[known])
        )
    return off, steeper


_TINY = 1e-12  # of the strain 1


def _friction_on_branches(
    errors: InstrumentErrors, model: StrainModel, strain: Floats, tension: Floats
) -> tuple[Floats, Floats]:
    """Error of strain by the friction of splices, and its slope over strain, for both branches.

    After a reversal a splice stands still until the length by its law differs by more than friction
    can hold.
    """
    at = np.broadcast_to(strain, tension.shape)
    longer = splice_friction_error(errors, model, strain=at, tension=tension)
    away, steeper = np.zeros(tension.shape), np.zeros(tension.shape)
    for branch in range(2):
        known = np.isfinite(longer[branch])
        if known.sum() < 2:
            continue
        own = longer[branch, known]
        reversal = own[-branch]
        gone = np.abs(own / max(reversal, _TINY) - 1)
        share = np.exp(-gone / (2 * errors.splice_friction))
        away[branch, known] = own * (share if branch == 0 else 1 - share)
        steeper[branch, known] = np.gradient(away[branch, known], strain[known])
    return away, steeper


_MOVED = 1e-3


def _window_blur(curves: ModulusCurves, index: int) -> Floats:
    """Possible error of the untrimmed modulus near a reversal, due to the window. [Pa].

    The modulus changes at a reversal within less than a window: where the trimmed
    samples change it, it is known to lie between there and half a window further in.
    """
    half = curves.window / 2
    smeared: Floats = np.zeros_like(curves.tangent_modulus[index])
    rows = zip(
        curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index], smeared, strict=True
    )
    for trimmed, whole, row in rows:
        known = np.isfinite(whole)
        if not known.any():
            continue
        strain = curves.strain_bin[known]
        inwards = np.where(strain < (strain[0] + strain[-1]) / 2, half, -half)
        further = np.interp(strain + inwards, strain, whole[known])
        # a bin without samples left (NaN) counts as moved
        moved = ~np.isclose(trimmed[known], whole[known], rtol=_MOVED, atol=0.0)
        row[known] = np.where(moved, np.abs(whole[known] - further) / np.sqrt(3), 0.0)
    return smeared


def _completed(
    strain: Floats, tension: Floats, modulus: Floats, area: float
) -> tuple[Floats, Floats]:
    """Tension and modulus of each branch where either is known, the other derived from it.

    A bin may have enough samples for a mean and too few for a slope, or the reverse: an error of
    its strain changes both.
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


def errors_of_segments(
    curves: ModulusCurves,
    segments: Segments,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
    inertia: Inertia | None,
) -> Contributions:
    """Segments of both branches; zero where a branch has none."""
    of_curve = errors_of_curves(curves, "", index, errors, model, area, rate, inertia)
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


def errors_of_material(
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

    A zero of the crosshead is in both and cancels.  A load cell with a high zero finds both at less
    tension than intended; they move by the extension of the specimen for that tension there.
    A gain scales the slack tension too where this is a fraction of the greatest tension.  A stated
    slack tension would have only the gain error of that small tension, which is left out.
    """
    of_model = errors.strain_model or errors.specimen
    # for each error: its effect on the length, the tension at the crossings, and their time
    parts = [
        (Component("position_gain", errors.position_instrument), errors.position_gain, 0.0, 0.0),
        (Component("strain_gain", of_model), errors.strain_gain, 0.0, 0.0),
        (Component("tension_offset", errors.tension_instrument), 0.0, -errors.tension_offset, 0.0),
        (Component("lag", errors.tension_instrument), 0.0, 0.0, errors.lag),
    ]
    name = next((one for one in _LENGTHS if one in model.coefficients), None)
    if name is not None:
        # the errors of the tape that enter every strain of the test
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
        # both crossings of a set are on first rises at the same rate: a lag does not change it
        values["permanent_set"] = (
            by_length * history.permanent_set[index]
            + by_tension * history.permanent_set_by_tension[index]
        )
    yield Contributions(component, values)


def errors_of_elastomers(
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


def errors_of_ratios(test: ReducedTest, found: Contributions) -> list[Contributions]:
    """Every ratio, along one axis; ``found`` holds the contributions to the moduli.

    Two sets of cycles of one specimen have the errors of instruments, section and
    splices in equal proportion: they cancel.
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
