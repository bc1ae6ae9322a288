"""Results of the cycles and of the first loading of a test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from functools import partial
from typing import Any

import numpy as np

from reduction.pipeline.located_test import FEWEST_SLACK, PULLED, Located, slips_of
from reduction.record.arrays import run_blocks
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers, Specimen, areas_of
from reduction.record.notes import Note, note
from reduction.record.samples import copied, finite_extremes, first_sample
from reduction.record.settings import ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles, Loops, turns_alike
from reduction.stages.cycles.cycle_search import control_channel
from reduction.stages.cycles.loop_sense import (
    contradicts_sine,
    without_backward_loops,
    without_loss,
)
from reduction.stages.cycles.loops import close_loops
from reduction.stages.moduli.cycle_alignment import (
    aligned_strain,
    alignment_moves,
    is_shift_of_curve,
    jump_of_mean,
    strain_shifts,
    time_with_hidden,
)
from reduction.stages.moduli.elastomer_laws import fit_elastomers
from reduction.stages.moduli.first_loading import first_loading_curves, stress_at_strain
from reduction.stages.moduli.loop_balance import check_identity
from reduction.stages.moduli.modulus_product import (
    ElastomerFit,
    ModulusCurves,
    PeakTrend,
    Ratio,
)
from reduction.stages.moduli.secant_modulus import (
    compare_curves,
    compare_cycles,
    end_moduli,
    fit_peak_trend,
    slip_of_turns,
    summarise_amplitude,
)
from reduction.stages.moduli.segments import find_segments
from reduction.stages.moduli.tangent_modulus import tangent_curves
from reduction.stages.reduced_test import History
from reduction.stages.standstills import median_step

_SAME_STRAIN = 0.05  # relative difference of greatest strains that count as equal: two splices


def _compare_specimens(
    curves: ModulusCurves, specimens: tuple[Specimen, ...], history: History | None
) -> list[Ratio]:
    """Modulus of each specimen over that of the first, with notes on their histories."""
    first = specimens[0]
    ratios = []
    for index, specimen in enumerate(specimens[1:], start=1):
        ratio = compare_curves(
            curves, curves, numerator_specimen=index, denominator_specimen=0,
            numerator_name=specimen.name, denominator_name=first.name,
        )  # fmt: skip
        pair = f"ratio {specimen.name}/{first.name}"
        unequal = _unequal(first, specimen, index, history)
        notes = tuple(replace(one, subject=pair) for one in unequal)
        ratios.append(replace(ratio, notes=(*ratio.notes, *notes)))
    return ratios


def _unequal(first: Specimen, other: Specimen, index: int, history: History | None) -> list[Note]:
    """All known differences between the histories of two specimens."""
    found = []
    if first.condition != other.condition:
        told = " against ".join(
            f"'{one.condition}'" if one.condition else "not stated" for one in (other, first)
        )
        found.append(note("unequal-condition", told=told))
    if history is None:
        return [*found, note("history-without-order")]
    cycles, strain = history.earlier_cycles[[index, 0]], history.earlier_maximum_strain[[index, 0]]
    if np.isnan(cycles).any():
        return [*found, note("history-with-failed-tests")]
    if cycles[0] != cycles[1]:
        own, of_first = cycles.tolist()
        found.append(note("unequal-cycles", cycles=own, of_first=of_first))
    if history.earlier_flex_cycles is not None:
        flex = history.earlier_flex_cycles[[index, 0]]
        if not np.array_equal(flex[:1], flex[1:], equal_nan=True):
            told = " against ".join("not known" if np.isnan(n) else f"{n:.0f}" for n in flex)
            found.append(note("unequal-flex-cycles", told=told))
    is_known = np.isfinite(strain)
    if is_known[0] != is_known[1] or np.ptp(strain) > _SAME_STRAIN * np.max(strain):
        told = " against ".join(
            f"{100 * value:.0f} %" if known else "none known"
            for value, known in zip(strain, is_known, strict=True)
        )
        softer = "; rubber is softer below what it has seen" if other.is_rubber else ""
        found.append(note("unequal-strain", told=told, softer=softer))
    return found


_DRIFT_NOTED = 0.02  # of the range of strain of a cycle


def _curves_of_cycles(
    strain: Floats,
    tension: Floats,
    cycles: Cycles,
    loops: Loops,
    trend: PeakTrend,
    *,
    names: tuple[str, ...],
    area: Floats,
    settings: ReductionSettings,
) -> ModulusCurves:
    """Curves over the cycles, which are aligned where their mean strain drifts."""
    break_in = settings.cycles.break_in_cycles

    def curves_of(series: Floats) -> ModulusCurves:
        return tangent_curves(
            series, tension, area=area, cycles=cycles, settings=settings.modulus,
            break_in_cycles=break_in,
        )  # fmt: skip

    curves = curves_of(strain)
    shift, reference = strain_shifts(loops.mean_strain, break_in_cycles=break_in)
    moves = alignment_moves(
        curves, shift[:, break_in:], loops.strain_amplitude[:, break_in:], reference, area=area
    ) & is_shift_of_curve(
        shift[:, break_in:], loops.mean_tension[:, break_in:],
        loops.apparent_spring_constant[:, break_in:],
    )  # fmt: skip
    laid_on = np.where(moves, reference, np.nan)
    if not moves.any():
        return replace(curves, alignment_strain=laid_on)
    shift[~moves] = 0.0
    curves = curves_of(aligned_strain(strain, shift, cycles.cycle_number))
    far = np.abs(trend.mean_strain_drift) / (2 * np.nanmedian(loops.strain_amplitude, axis=1))
    notes = [
        note(
            "cycles-aligned", names[index], drift=float(trend.mean_strain_drift[index]),
            effect=float(far[index]), per_decade=float(trend.mean_strain_per_decade[index]),
            reference=float(reference[index]),
        )
        for index in np.flatnonzero(moves & (far > _DRIFT_NOTED)).tolist()
    ]  # fmt: skip
    laid = ", ".join(
        f"{names[index]} {reference[index]:.6g}" for index in np.flatnonzero(moves).tolist()
    )
    return replace(
        curves,
        alignment_strain=laid_on,
        notes=(*curves.notes, *notes),
        made=(*curves.made, f"cycles laid on each other, shifted to a mean strain of: {laid}"),
    )


# cycles on each side of a jump whose stiffness and amplitudes are compared, and the relative
# differences that count: a slip does not change the amplitudes
_BESIDE, _OTHER_STIFFNESS, _OTHER_AMPLITUDE = 10, 0.05, 0.05


def notes_on_jumps(
    loops: Loops, names: Sequence[str], *, break_in: int, number: Integers | None = None
) -> list[Note]:
    """Note slips, partings or shifts of a load cell between two cycles."""
    found = []
    for index, name in enumerate(names):
        time, strain, tension, slope, of_strain, of_tension = (
            one[index, break_in:]
            for one in (
                loops.cycle_start_time, loops.mean_strain, loops.mean_tension,
                loops.apparent_spring_constant, loops.strain_amplitude, loops.tension_amplitude,
            )
        )  # fmt: skip
        if number is not None:
            time = time_with_hidden(time, number[break_in:])
        for code, jump, amplitude in (
            ("strain-jumps", jump_of_mean(time, strain, tension, slope, of_strain), of_strain),
            (
                "tension-jumps",
                jump_of_mean(time, tension, strain, 1 / slope, of_tension),
                of_tension,
            ),
        ):
            if jump is not None:
                place, size = jump
                change, *larger = (
                    float(
                        np.nanmedian(one[place : place + _BESIDE])
                        / np.nanmedian(one[max(place - _BESIDE, 0) : place])
                    )
                    - 1
                    for one in (slope, of_strain, of_tension)
                )
                # the machine changed its amplitude, at which a bent curve has another mean
                if min(larger) > _OTHER_AMPLITUDE or max(larger) < -_OTHER_AMPLITUDE:
                    continue
                place += break_in
                if abs(change) > _OTHER_STIFFNESS:
                    found.append(
                        note("stiffness-changes-at-cycle", name, change=change, number=place)
                    )
                    break
                share = abs(size) / float(np.nanmedian(amplitude))
                found.append(note(code, name, size=size, number=place, effect=share))
    return found


# number of cycles at each end of a long test whose kept curves are compared
ENDS = 6


def parts_of_cycles(
    located: Located,
    strain: Floats,
    tension: Floats,
    *,
    specimens: tuple[Specimen, ...],
    history: History | None,
    settings: ReductionSettings,
    lag: Sequence[float],
    is_open: bool = False,
) -> dict[str, Any]:
    """Loops, curves, segments and derived results, by field of `ReducedTest`."""
    record, cycles = located.record, located.cycles
    if cycles is None:
        return {}
    area = areas_of(specimens)
    break_in = settings.cycles.break_in_cycles
    close = partial(
        close_loops, record.time, tension, strain, cycles, control=settings.cycles.control,
        driven=control_channel(located.position, tension, settings.cycles),
    )  # fmt: skip
    is_sine = settings.cycles.waveform == "sinusoidal"
    loops = close(waveform=settings.cycles.waveform)
    if is_sine and contradicts_sine(loops).any():
        loops, is_sine = close(waveform="other"), False
    loops = without_backward_loops(loops)
    if is_open:
        loops = without_loss(loops)
    known, every = loops.frequency[loops.frequency > 0], median_step(record.time)
    # both channels have the turn of the machine, separated by the stated lag, or by one not known
    alike = np.zeros(len(specimens))
    if settings.cycles.waveform != "sinusoidal":
        alike = turns_alike(
            np.where(np.array(lag) > 0, lag, every), every,
            period=float(np.mean(1 / known)) if known.size else 0.0,
            n_cycles=cycles.n_cycles - break_in,
        )  # fmt: skip
    amplitude = summarise_amplitude(loops, area=area, break_in_cycles=break_in, turns_alike=alike)
    loops.release_pages()
    lasts = float(record.time[cycles.last[-1]] - record.time[cycles.first[0]])
    rests = located.load_at_slack or (None,) * len(specimens)
    trend = fit_peak_trend(
        loops, area=area, break_in_cycles=break_in, cycles=cycles,
        of_zero=[0.0 if rest is None else rest.drift_within(lasts) for rest in rests],
        # the fit of a sine misses no turn
        of_turns=0.0 if is_sine or not known.size else slip_of_turns(known, every, cycles.n_cycles),
    )  # fmt: skip
    if np.isnan(area).any():
        # a rope without a diameter has spring constants, and creeps, but has no modulus
        return {"loops": loops, "amplitude": amplitude, "trend": trend}
    curves = _curves_of_cycles(
        strain, tension, cycles, loops, trend, names=record.specimens, area=area, settings=settings
    )
    parts: dict[str, Any] = {
        "loops": loops,
        "curves": curves,
        "segments": find_segments(curves, area=area, settings=settings.modulus),
        "end_moduli": end_moduli(strain, tension, area=area, cycles=cycles),
        "identity": check_identity(
            strain,
            tension,
            area=area,
            cycles=cycles,
            names=record.specimens,
            time=record.time,
            lag=lag,
            control=settings.cycles.control,
        ),
        "amplitude": amplitude,
        "trend": trend,
    }
    loops.release_pages()
    ratios = _compare_specimens(curves, specimens, history)
    parts["slips"] = slips_of(located, settings)
    if parts["slips"] is not None:
        kept = curves.selected_cycle
        begin = kept[kept <= ENDS].tolist()
        end = kept[kept > cycles.n_cycles - ENDS].tolist()
        for index, name in enumerate(record.specimens):
            ratio = compare_cycles(
                curves, specimen=index, numerator_cycles=end, denominator_cycles=begin
            )
            ratios.append(
                replace(
                    ratio,
                    numerator=f"{name}, {ratio.numerator}",
                    denominator=f"{name}, {ratio.denominator}",
                )
            )
    parts["ratios"] = tuple(ratios)
    loops.release_pages()
    return parts


def _elastomers(
    name: str,
    strain: Floats,
    stress: Floats,
    earlier_maximum_strain: float,
    *,
    is_first: bool,
) -> tuple[tuple[ElastomerFit, ...], Note | None]:
    """Hyperelastic laws of one first loading, or the reason for their absence."""
    known = np.isfinite(stress)
    if not (strain[known] > 0).any():
        reached = "no stress is known on it"
        if known.any():
            reached = f"strain reaches {100 * strain[known].max():.3g} % on it"
        return (), note("law-without-pull", name, reached=reached)
    try:
        fits = fit_elastomers(strain[known], stress[known], specimen=name)
    except (DataError, FitError) as error:
        return (), note("no-law", name, reason=str(error))
    if is_first:
        return fits, None
    softened = note("law-of-softened-rubber", strain=earlier_maximum_strain)
    return tuple(replace(fit, notes=(*fit.notes, softened)) for fit in fits), None


def _first_finite(series: Floats) -> float:
    """First finite sample of a series; NaN if there is none."""
    at = first_sample(lambda part: np.isfinite(series[part]), 0, series.size, series)
    return float("nan") if at is None else float(series[at])


def _is_new(history: History, index: int) -> bool:
    """Whether a specimen was unused before the test, by logged and unlogged history."""
    return not (history.earlier_tests[index] or history.earlier_cycles[index] > 0)


def _without_modulus(curves: ModulusCurves, lacks_area: Bools) -> ModulusCurves:
    """Curves without modulus for specimens without an area; the tension remains."""
    moduli = [item.name for item in fields(curves) if item.name.startswith("tangent_modulus")]
    emptied = {}
    for name in moduli:
        if getattr(curves, name) is None:
            continue
        values = getattr(curves, name).copy()
        values[lacks_area] = 0 if values.dtype.kind == "i" else np.nan
        emptied[name] = values
    return replace(curves, **emptied)


_PRELOAD = 0.2  # of the greatest load


def _until_parted(located: Located, strain: Floats, tension: Floats) -> Floats:
    """Strain up to the last reading before a specimen parts, whose load falls over some readings.

    The machine runs on, and without this the fall would be part of the first rise.
    """
    if max(located.parted, default=-1) < 0:
        return strain
    strain = copied(strain)
    for row, sample in enumerate(located.parted):
        if sample > 0:
            last = tension[row, max(sample - FEWEST_SLACK, 0) : sample]
            strain[row, sample - last.size + int(np.nanargmax(last)) + 1 :] = np.nan
    return strain


def parts_of_first_loading(
    located: Located,
    strain: Floats,
    tension: Floats,
    specimens: tuple[Specimen, ...],
    settings: ReductionSettings,
    history: History | None,
    *,
    kind: str,
) -> tuple[dict[str, Any], list[Note]]:
    """The first rise of a record that begins slack: curve; for rubber, also stress and laws.

    A coupon of any other material may be pulled from a preload.
    """
    begins = [_first_finite(force) for force in tension]
    may_be_loaded = kind in PULLED and not any(one.is_rubber for one in specimens)
    slack = located.standstills.slack_tension
    if all(
        start > (max(slack, _PRELOAD * finite_extremes(force)[1]) if may_be_loaded else slack)
        for start, force in zip(begins, tension, strict=True)
    ):
        return {}, []
    area = areas_of(specimens)
    has_area = np.isfinite(area)
    if not has_area.all() and kind != "bedding-in":
        return (
            {},
            [],
        )  # that of a rope or hose is `stages.three_parameter_line.slow_pull`'s, without an area
    strain = _until_parted(located, strain, tension)
    curves = first_loading_curves(
        strain, tension, area=np.where(has_area, area, 1.0), settings=settings.modulus,
        standstills=located.standstills,
    )  # fmt: skip
    if curves is None or curves.strain_bin.size < 2:
        return {}, []
    curves = _without_modulus(curves, ~has_area)
    rise = curves.branch_tension[:, 0]
    names = located.record.specimens
    parts: dict[str, Any] = {"first_loading": curves}
    rubber = np.array([specimen.is_rubber for specimen in specimens])
    if not rubber.any():
        # cords carry a hose: neither a law of rubber nor the trade's stress at an elongation
        # applies
        return parts, []
    levels = settings.modulus.stress_at_strain
    stresses = run_blocks(
        lambda row: stress_at_strain(
            strain[row],
            tension[row],
            area=area[row],
            levels=levels,
            is_still=located.standstills.covers,
        ),
        range(area.size),
    )
    notes = [
        note("stress-at-strain-not-given", name, level=level, reason=reason)
        for name, (_, _, reasons), given in zip(names, stresses, rubber, strict=True)
        if given
        for level, reason in zip(levels, reasons, strict=True)
        if reason
    ]
    stress, spread = (
        np.where(rubber[:, None], np.array([one[part] for one in stresses]), np.nan)
        for part in (0, 1)
    )
    parts |= {
        "stress_at_strain": stress,
        "stress_at_strain_standard_uncertainty": spread,
        "stress_at_strain_levels": levels,
    }
    earlier = np.full(area.size, np.nan) if history is None else history.earlier_maximum_strain
    is_first = [history is None or _is_new(history, index) for index in range(area.size)]
    found = [
        _elastomers(
            name,
            curves.strain_bin,
            rise[index] / area[index],
            float(earlier[index]),
            is_first=is_first[index],
        )
        for index, name in enumerate(names)
        if rubber[index]
    ]
    parts["elastomers"] = tuple(fit for fits, _ in found for fit in fits)
    notes += [reason for _, reason in found if reason]
    return parts, notes
