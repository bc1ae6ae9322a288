"""Errors that a test shares with others, carried to all of its results.

Names of the contributions are those of the variables of the archive; the axis of the specimens
follows that of the components.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.quantities.flags import LAG_REFUSALS
from reduction.record.contributions import (
    Contributions,
    InstrumentErrors,
    merged,
    renamed,
    stacked,
)
from reduction.record.measurement import Floats, Record, areas_of
from reduction.record.notes import Note, note
from reduction.record.samples import full_like, release_pages
from reduction.record.settings import CycleSettings
from reduction.stages.channel_lag import (
    LagEstimate,
    delay_by_noise,
    lag_at_stops,
    lag_by_turns,
)
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.standstills import Standstills, median_step
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.stages.three_parameter_line.slow_pull import (
    BREAK_SHARES,
    tension_grid,
)
from reduction.uncertainty.errors_of_curves import (
    errors_of_curves,
    errors_of_elastomers,
    errors_of_material,
    errors_of_ratios,
    errors_of_segments,
    rise_rates,
    strain_rates,
)
from reduction.uncertainty.errors_of_cycles import (
    PullOrigin,
    blocks_of_cycles,
    cycles_of_test,
    errors_after_slip,
    errors_of_dynamic_modulus,
    errors_of_ends,
    errors_of_holds,
    errors_of_line,
    errors_of_loops,
    errors_of_pairs,
    errors_of_pull,
    errors_of_slips,
    inertia_of,
    quasi_static_contributions,
    slipped_by_cycle,
    trend_and_step_contributions,
)

_NOTED = 2.0  # standard uncertainties


def lag_of_test(
    record: Record,
    position: Floats,
    tension: Floats,
    cycles: Cycles,
    *,
    standstills: Standstills | None = None,
    stated: Sequence[float] = (),
) -> tuple[LagEstimate, list[Note]]:
    """Estimate the lag of each tension channel, with a note where it exceeds the stated lag."""
    turns = np.concatenate([cycles.branch_first.ravel(), cycles.branch_last.ravel()])
    estimate = lag_by_turns(record.time, position, tension, turns)
    is_of_stops = np.isin(estimate.refusal, _WITHOUT_TURNS).all()
    if standstills is not None and is_of_stops:
        edges = np.concatenate([turns, standstills.first, standstills.last])
        stops = standstills.first[~standstills.is_rest]
        estimate = lag_at_stops(record.time, position, tension, stops, edges)
    known = np.asarray(stated) if len(stated) else np.zeros(len(record.specimens))
    total = np.hypot(estimate.standard_uncertainty, known)
    step = median_step(record.time)
    period = step * float(np.median(cycles.last - cycles.first))
    notes = []
    for place, name in enumerate(record.specimens):
        lag, spread, own = estimate.lag[place], estimate.standard_uncertainty[place], known[place]
        if lag > _NOTED * total[place]:
            notes.append(note(
                "tension-late", name, lag=float(lag), spread=float(spread), stated=float(own),
                is_of_stops=bool(is_of_stops),
            ))  # fmt: skip
            continue
        late = step * delay_by_noise(position, tension[place], samples_per_cycle=period / step)
        if late > max(_NOTED * own, _LEAST_DELAY * period):
            notes.append(note("tension-filtered", name, lag=late, spread=late / 4))
    return estimate, notes


_LEAST_DELAY = 5e-4  # of a period: a phase of 0.003, a thirtieth of a loss factor of 0.1


_WITHOUT_TURNS = [LAG_REFUSALS[name] for name in ("few_turns", "turns_not_sharp")]


# an archive has them for each cycle, not for the means of a test
_OF_CYCLES_ALONE = ("peak_tension", "valley_tension", "foot_strain")


def contributions_of_test(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> Contributions | None:
    """Contribution of each shared error to the curves, segments and means of a test."""
    own = []
    for index, one in enumerate(errors):
        pull = None if pulls is None else pulls[index]
        origin = pull_origins[index] if pull_origins else None
        own.append(merged(list(_of_specimen(test, index, one, cycles, pull, origin))))
    found = stacked(own)
    parts = [
        found,
        *errors_of_holds(test, errors),
        *errors_of_pairs(test, errors),
        *errors_of_slips(test, errors),
        *errors_of_elastomers(test, errors, found),
        *errors_of_ratios(test, found),
    ]
    whole = merged(parts)
    return whole if whole.component else None


def shared_uncertainty_of_cycles(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> dict[str, Floats]:
    """Shared standard uncertainty of each cycle quantity, shape (n_specimens, n_cycles)."""
    if test.loops is None:
        return {}
    n_specimens, n_cycles = test.loops.mean_tension.shape
    shared: dict[str, Floats] = {}
    for block in blocks_of_cycles(n_cycles):
        part = cycles_of_test(test, block)
        for index, one in enumerate(errors):
            pull = None if pulls is None else pulls[index]
            origin = pull_origins[index] if pull_origins else None
            found = slipped_by_cycle(
                _contributions_to_cycles(test, part, index, one, cycles, pull, origin),
                test, index, block,
            )  # fmt: skip
            for name in found.values if found.component else ():
                spread = found.shared_standard_uncertainty(name)
                if name not in shared:
                    # a specimen without a slow pull has no line: its uncertainty is unknown
                    shared[name] = full_like(
                        test.loops.mean_tension, np.nan,
                        shape=(n_specimens, n_cycles, *spread.shape[1:]),
                    )  # fmt: skip
                shared[name][index, block] = spread
        release_pages(*shared.values())
        test.loops.release_pages()
    return shared


def _of_specimen(
    test: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Iterator[Contributions]:
    model = test.strain_models[index]
    area = float(areas_of(test.specimens)[index])
    summary = test.amplitude
    # a first rise comes before the cycles
    at_first = errors_after_slip(test, index, errors, slice(0, 1))
    yield from errors_of_material(test, index, at_first, model, area)
    yield from trend_and_step_contributions(test, index, errors, model, cycles, area)
    own = test.pulls[index] if test.pulls else None
    if own is not None:
        strength = test.specimens[index].rated_break_strength
        yield from errors_of_pull(
            own, errors, model, tension=tension_grid(test.pulls), share=np.array(BREAK_SHARES),
            rated_break_strength=strength,
        )  # fmt: skip
    if test.curves is not None:
        rate = strain_rates(test, index, model, cycles)
        # there is no acceleration along the ramps of a triangle
        inertia = (
            None
            if summary is None or cycles.waveform == "triangular"
            else inertia_of(test.record, summary, index, errors, model, test.cycles)
        )
        at_curves = errors_after_slip(test, index, errors, test.curves.selected_cycle - 1)
        yield errors_of_curves(test.curves, "", index, at_curves, model, area, rate, inertia)
        if test.segments is not None:
            yield errors_of_segments(
                test.curves, test.segments, index, at_curves, model, area, rate, inertia
            )
    # without an area the curve is one of tension, whose slope is not kept
    if test.first_loading is not None and np.isfinite(area):
        rate = rise_rates(test, index) if errors.lag else np.zeros((2, 2, 1))
        yield errors_of_curves(
            test.first_loading, "_first_loading", index, at_first, model, area, rate
        )
    if summary is not None and test.cycles is not None:
        errors = errors_after_slip(test, index, errors, slice(cycles.break_in_cycles, None))
        of_loop = errors_of_loops(summary, index, errors, model, test.cycles, cycles, test.record)
        yield _named_of_test(of_loop, left_out=_OF_CYCLES_ALONE)
        if np.isfinite(area):
            yield _named_of_test(errors_of_dynamic_modulus(of_loop, summary, index, errors, area))
        if test.line_of_test is not None and pull is not None:
            rest = quasi_static_contributions(
                pull, origin or PullOrigin(errors, model),
                np.asarray(summary.mean_tension[index]), of_loop, test.line_of_test, index,
            )  # fmt: skip
            yield _named_of_test(rest)
            line = test.line_of_test
            of_both = errors_of_loops(
                summary, index, errors, model, test.cycles, cycles, test.record, line=line
            )
            yield _named_of_test(errors_of_line(line, summary, index, of_both, rest))


def _contributions_to_cycles(
    test: ReducedTest,
    part: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Contributions:
    """Quantities of each cycle in part of a test; those of its line where it has one."""
    if part.loops is None or part.cycles is None or test.cycles is None:
        return Contributions(())
    model = test.strain_models[index]
    of_loop = errors_of_loops(part.loops, index, errors, model, part.cycles, cycles, test.record)
    parts = [of_loop]
    if part.end_moduli is not None:
        parts += errors_of_ends(part, index, errors, float(areas_of(test.specimens)[index]))
    line, amplitude = test.line_of_test, test.amplitude
    if part.line is not None and line is not None and amplitude is not None and pull is not None:
        rest = quasi_static_contributions(
            pull, origin or PullOrigin(errors, model),
            np.asarray(amplitude.mean_tension[index]),
            errors_of_loops(
                amplitude, index, errors, model, test.cycles, cycles, test.record
            ),
            line, index,
        )  # fmt: skip
        of_both = errors_of_loops(
            part.loops, index, errors, model, part.cycles, cycles, test.record, line=part.line
        )
        parts.append(errors_of_line(part.line, part.loops, index, of_both, rest))
    return merged(parts)


def _named_of_test(found: Contributions, *, left_out: Sequence[str] = ()) -> Contributions:
    return renamed(found, {name: f"test_{name}" for name in found.values if name not in left_out})
