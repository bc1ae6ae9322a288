"""Results of a slow pull and of the steps of a rope programme."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reduction.pipeline.located_test import Located
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Floats, Integers, Specimen
from reduction.record.notes import Note, note
from reduction.record.samples import finite_extremes, last_sample
from reduction.record.settings import CycleSettings, RopeSettings
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.hold_pairs import (
    CreepOfHold,
    HeldPair,
    creep_of_hold,
    held_pairs,
)
from reduction.stages.three_parameter_line.line_model import refused_lines
from reduction.stages.three_parameter_line.line_of_loops import identify_cycles, identify_run
from reduction.stages.three_parameter_line.line_product import SlowPull, mean_of_rows
from reduction.stages.three_parameter_line.loop_midline import tension_above_midline
from reduction.stages.three_parameter_line.rope_programme import (
    CyclesToFailure,
    DynamicStiffness,
    RopeStep,
    TensilePull,
    cycles_to_failure,
    dynamic_stiffness,
    parting_sample,
    summarise_bedding_in,
    tensile_pull,
)
from reduction.stages.three_parameter_line.slow_pull import (
    error_of_pull_rate,
    fit_pull,
    is_short_pull,
    quasi_static_of_run,
)


@dataclass(frozen=True)
class PullConditions:
    """Conditions of a slow pull that its log does not show; None where not stated.

    ``waiting_time`` [s] is the time since the last dynamic test, ``waiting`` the laboratory's words
    for it; ``reference_length`` [m] is the length at zero strain, ``reference_tension`` [N] the
    tension at which it was read.
    """

    waiting: str = ""
    waiting_time: float | None = None
    reference_length: float | None = None
    reference_tension: float | None = None


def pull_specimens(
    located: Located,
    strain: Floats,
    tension: Floats,
    conditions: PullConditions,
    *,
    models: Sequence[StrainModel],
) -> tuple[tuple[SlowPull | None, ...], list[Note]]:
    """Load-strain curve of each specimen of a slow pull; None and a note where there is none."""
    pulls: list[SlowPull | None] = []
    notes: list[Note] = []
    for index, name in enumerate(located.record.specimens):
        length = conditions.reference_length
        if length is None and np.isfinite(models[index].relaxed_length):
            length = models[index].relaxed_length
        try:
            pull = fit_pull(
                located.record.time, strain[index], tension[index], specimen=name,
                reference_tension=conditions.reference_tension,
                reference_length=length,
                waiting_time=conditions.waiting_time, waiting=conditions.waiting,
            )  # fmt: skip
        except (DataError, FitError) as error:
            notes.append(note("no-pull", name, reason=str(error)))
            pulls.append(None)
            continue
        notes += [replace(one, subject=name) for one in pull.notes]
        pulls.append(pull)
    return tuple(pulls), notes


_BEYOND = 2.0  # times the uncertainty of K_0 stated without it


def parts_of_line(
    loops: Loops,
    pulls: Sequence[SlowPull | None],
    settings: CycleSettings,
    *,
    strain: Floats,
    tension: Floats,
    cycles: Cycles,
) -> dict[str, Any]:
    """Parameters of the three-parameter line for each cycle and for the test, and notes."""
    kept = slice(settings.break_in_cycles, None)
    above = [
        tension_above_midline(
            one, load, first=cycles.first[kept], turn=cycles.branch_first[kept, 1],
            last=cycles.last[kept],
        )
        for one, load in zip(strain, tension, strict=True)
    ]  # fmt: skip
    constant, spread, notes = quasi_static_of_run(
        loops, pulls, break_in_cycles=settings.break_in_cycles, above_midline=above,
        waveform=settings.waveform, control=settings.control,
    )  # fmt: skip
    # the amplitudes of a wave that is not a sine are not those of its fundamental
    reading = "amplitude" if settings.waveform == "sinusoidal" else "fundamental"
    if reading == "fundamental":  # a linear line has one complex stiffness at one frequency
        loops = loops.over_time(float(np.median(cycles.last - cycles.first)))
    given: dict[str, Any] = {
        "quasi_static_spring_constant": constant,
        "quasi_static_standard_uncertainty": spread,
        "reading": reading,
    }
    of_test = identify_run(loops, break_in_cycles=settings.break_in_cycles, **given)
    mean = mean_of_rows(loops.mean_tension[:, settings.break_in_cycles :])
    by_rate = np.array(
        [
            0.0
            if pull is None
            else error_of_pull_rate(pull, at, spring_constant=spring, relaxation_time=tau)
            for pull, at, spring, tau in zip(
                pulls, mean.tolist(), of_test.dissipation_spring_constant.tolist(),
                of_test.relaxation_time.tolist(), strict=True,
            )
        ]
    )  # fmt: skip
    is_short = np.array(
        [
            pull is not None and is_short_pull(pull, tau)
            for pull, tau in zip(pulls, of_test.relaxation_time.tolist(), strict=True)
        ]
    )
    of_rate = tuple(
        note(
            "pull-not-slow" if short else "pull-rate-matters", pull.specimen,
            effect=abs(float(wrong / at)),
        )
        for pull, wrong, at, own, short in zip(
            pulls, by_rate, constant, spread, is_short, strict=True
        )
        if pull is not None and abs(wrong) > _BEYOND * own
    )  # fmt: skip
    by_rate = np.where(is_short, by_rate, 0.0)
    spread = given["quasi_static_standard_uncertainty"] = np.hypot(spread, by_rate)
    of_test = identify_run(loops, break_in_cycles=settings.break_in_cycles, **given)
    line_of_cycles = identify_cycles(loops, **given)
    return {
        "line": line_of_cycles,
        "line_of_test": of_test,
        "quasi_static_standard_uncertainty": spread,
        "line_notes": (*notes, *of_rate, *of_test.notes, *refused_lines(line_of_cycles.reason)),
    }


_NAMES = {
    "bedding-in": "bedding-in",
    "cyclic": "dynamic stiffness",
    "quasi-static": "quasi-static stiffness",
    "creep": "creep",
    "fatigue": "cycles to failure",
    "snap": "cycles to failure under snap loads",
    "tensile": "tensile strength",
}

_PULLS = ("tensile", "quasi-static")

# requested by name, and so for any specimen; the others are a programme for ropes only
_OF_ALL = ("bedding-in", "fatigue", "snap", *_PULLS)

# a drift over the cycles used is noted if it exceeds this fraction of the stiffness
_DRIFT_NOTED = 0.01

_SIGNIFICANT = 3.0

# distance of a first valley from the others, over the range, at which its cycle is not like them
_UNEQUAL_VALLEY = 0.05

# relative difference of amplitudes, or of means over an amplitude, that makes another level
_OTHER_LEVEL = 0.3

_FEWEST_OF_LEVEL = 3

# upper part of the stroke, in which a sound line is taut
_TOP = 0.25


def rope_step(
    located: Located,
    strain: Floats,
    tension: Floats,
    *,
    kind: str,
    specimens: tuple[Specimen, ...],
    loops: Loops | None,
    holds: tuple[HoldResult, ...],
    failed: bool | None,
    settings: RopeSettings,
) -> RopeStep | None:
    """Reduce one test as a step of a programme; None if its kind, or a tether, has none."""
    is_rope = any(specimen.is_rope for specimen in specimens)
    if kind not in _NAMES or not (is_rope or kind in _OF_ALL):
        return None
    strength = np.array(
        [
            np.nan if one.rated_break_strength is None else one.rated_break_strength
            for one in specimens
        ]
    )
    names = located.record.specimens
    step = RopeStep(_NAMES[kind])
    if is_rope and kind in ("creep", "quasi-static"):
        step = replace(step, creep=_creep(holds, names, strength))
    notes: list[Note] = []
    if kind in ("cyclic", "bedding-in") and loops is not None:
        dynamic = dynamic_stiffness(
            loops, last_cycles=settings.last_cycles, rated_break_strength=strength
        )
        bedding = None
        if kind == "bedding-in" and loops.frequency.shape[1] > 1 and located.cycles is not None:
            bedding = summarise_bedding_in(
                loops, rated_break_strength=strength,
                begin_tension=tension[:, located.cycles.first[0]],
            )  # fmt: skip
        notes += _stiffness_notes(dynamic, names, settings, kind=kind) + _of_levels(
            loops, dynamic, names
        )
        if kind == "bedding-in":
            notes += _of_first_cycle(loops, names)
        step = replace(step, bedding_in=bedding, dynamic=dynamic)
    if kind in ("fatigue", "snap") and loops is not None:
        lasted = _lasted(located, tension, loops, strength, failed, settings)
        notes += [
            note("cycles-counted-until", name, how=how)
            for name, how in zip(names, lasted.how, strict=True)
        ]
        cycles = located.cycles
        if cycles is not None and not cycles.is_count_sure:
            n_hidden = int(cycles.number[-1]) - cycles.n_cycles
            found = note("life-across-gaps", n_hidden=n_hidden, n_cycles=cycles.n_cycles)
            few = n_hidden <= _SURE_LIFE * cycles.n_cycles
            notes.append(replace(found, severity="note") if few else found)
        if cycles is not None:
            notes += _failed_in_gaps(lasted, cycles, names)
        step = replace(step, lasted=lasted)
    if is_rope and kind == "quasi-static":
        pairs = held_pairs(
            located.record.time, located.position, tension, strain, located.standstills,
            specimens=names, rated_break_strength=strength,
            reference_time=settings.reference_time,
        )  # fmt: skip
        notes += _of_pairs(pairs)
        step = replace(step, held=pairs)
    if kind in _PULLS:
        pull = tensile_pull(
            located.position, tension, strain, rated_break_strength=strength, broke=failed
        )
        if kind == "tensile":  # a slow pull need not end in a break
            notes += _of_pull(pull, tension, names)
        notes += [
            note("no-strain-at-failure", name)
            for name, reached in zip(names, pull.strain_at_peak, strict=True)
            if np.isnan(reached)
        ]
        step = replace(step, tensile=pull)
    if step == RopeStep(step.name):
        return None
    if np.isnan(strength).any() and (
        is_rope or kind in ("bedding-in", "fatigue", "snap", "tensile")
    ):
        notes += [
            note("no-break-strength", name)
            for name, one in zip(names, strength, strict=True)
            if np.isnan(one)
        ]
    return replace(step, notes=tuple(notes))


def _creep(
    holds: tuple[HoldResult, ...], names: Sequence[str], strength: Floats
) -> tuple[CreepOfHold, ...]:
    """Creep of every hold at controlled tension; all holds of a test are of one kind."""
    if any(hold.kind != "creep" for hold in holds):
        return ()
    of_name = dict(zip(names, strength.tolist(), strict=True))
    return tuple(creep_of_hold(hold, rated_break_strength=of_name[hold.specimen]) for hold in holds)


def _of_first_cycle(loops: Loops, names: Sequence[str]) -> list[Note]:
    """Bedding-in that begins at a different tension from its cycles."""
    if loops.frequency.shape[1] < 2:
        return [note("no-bedding-in")]
    notes = []
    for name, valley, amplitude in zip(
        names, loops.valley_tension, loops.tension_amplitude, strict=True
    ):
        usual = float(np.nanmedian(valley))
        if abs(valley[0] - usual) > _UNEQUAL_VALLEY * 2 * float(np.nanmedian(amplitude)):
            notes.append(
                note("first-cycle-begins-elsewhere", name, first=float(valley[0]), usual=usual)
            )
    return notes


def _stiffness_notes(
    dynamic: DynamicStiffness, names: Sequence[str], settings: RopeSettings, *, kind: str
) -> list[Note]:
    """Notes on too few cycles, and on a stiffness that has not settled."""
    notes: list[Note] = []
    for row, name in enumerate(names):
        used = int(dynamic.n_cycles[row, 0])
        if used < settings.last_cycles:
            asked = settings.last_cycles
            notes.append(note("stiffness-of-few-cycles", name, n_cycles=used, n_asked=asked))
        drift = float(dynamic.drift_per_cycle[row, 0])
        spread = float(dynamic.drift_per_cycle_standard_uncertainty[row, 0])
        share = drift * (used - 1) / float(dynamic.dynamic_stiffness[row, 0])
        if abs(drift) > _SIGNIFICANT * spread and abs(share) > _DRIFT_NOTED:
            found = note("stiffness-not-settled", name, effect=share, n_cycles=used)
            # a short bedding-in gives its last cycle, and its first ones are expected to change
            is_bedding = kind == "bedding-in" and used < settings.last_cycles
            notes.append(replace(found, severity="note") if is_bedding else found)
    return notes


def _of_levels(loops: Loops, dynamic: DynamicStiffness, names: Sequence[str]) -> list[Note]:
    """Cycles of another level than those used: a step is one level."""
    notes = []
    for row, name in enumerate(names):
        mean, amplitude = dynamic.mean_tension[row, 0], dynamic.tension_amplitude[row, 0]
        shift = np.abs(loops.mean_tension[row] - mean) > amplitude
        other = np.abs(loops.tension_amplitude[row] / amplitude - 1) > _OTHER_LEVEL
        count = int(np.count_nonzero(shift | other))
        if count >= _FEWEST_OF_LEVEL:
            notes.append(note("cycles-of-another-level", name, n_other=count, n_cycles=shift.size))
    return notes


def _lasted(
    located: Located,
    tension: Floats,
    loops: Loops,
    strength: Floats,
    failed: bool | None,
    settings: RopeSettings,
) -> CyclesToFailure:
    """Cycles until the record shows a failure, with those that its gaps hold."""
    cycles = located.cycles
    number = parted_in = None
    if cycles is not None:
        number = cycles.number
        parted_in = _parted_in(located, tension, cycles, loops, settings.failure_share)
    return cycles_to_failure(
        loops,
        rated_break_strength=strength,
        failed=None if failed is None else np.full(strength.size, failed),
        cycle_number=number,
        parted_in=parted_in,
        failure_share=settings.failure_share,
    )


def _failed_in_gaps(
    lasted: CyclesToFailure, cycles: Cycles, names: Sequence[str]
) -> Iterator[Note]:
    """Failures between two logged cycles that are not neighbours: the life is a lower bound."""
    for name, last, failed in zip(names, lasted.cycles.tolist(), lasted.failed, strict=True):
        later = cycles.number[cycles.number > last]
        if failed and later.size and later[0] > last + 1:
            found = note("failed-in-gap", name, last=last, following=int(later[0]))
            few = later[0] - last <= _SURE_LIFE * last
            yield replace(found, severity="note") if few else found


_SURE_LIFE = 0.02  # of it: cycles that are not logged, or in which it may have failed


def _parted_in(
    located: Located, tension: Floats, cycles: Cycles, loops: Loops, failure_share: float
) -> Integers:
    """Cycle within or after which each specimen is slack where it was taut; -1 if none."""
    found = np.full(len(tension), -1)
    for row, peak in enumerate(loops.peak_tension):
        known = peak[np.isfinite(peak)]
        if not known.size:
            continue
        sound = np.flatnonzero(peak >= failure_share * np.median(known))
        # a cycle in which it parted may look whole by its peak: the one before it is sound
        sure = max(int(sound[-1]) - 1, 0)
        begin, last = int(cycles.first[sure]), int(cycles.last[sure])
        place, load = located.position[begin : last + 1], tension[row, begin : last + 1]
        least = np.nanmax(place) - _TOP * np.ptp(place[np.isfinite(place)])
        slack, lowest = located.standstills.slack_tension, np.fmin.reduce(load[place >= least])
        if not lowest > slack:  # nor if it is not known
            continue
        # as logged: a channel that repeats its zero after a failure is flagged, but not wrong
        sample = parting_sample(
            located.record.crosshead_position, located.record.tension[row], last=last,
            least_position=float(least), tension_low=failure_share * float(lowest),
        )  # fmt: skip
        taut = _last_taut(located.record.tension[row], sample, slack)
        if taut is not None:
            # one that is taut to the end of a cycle parted in the next one
            found[row] = max(int(np.searchsorted(cycles.last, taut, side="right")), 1)
    return found


def _last_taut(load: Floats, stop: int, slack: float) -> int | None:
    """Last sample before a given one at which a specimen is taut."""
    return last_sample(lambda part: load[part] > slack, 0, stop, load)


def _of_pairs(pairs: Sequence[HeldPair]) -> list[Note]:
    notes: list[Note] = []
    for pair in pairs:
        where = f"{pair.specimen}: holds {pair.low_hold} and {pair.high_hold}"
        if pair.stiffness is None:
            notes.append(note("no-static-stiffness", where, reason=pair.reason))
        else:
            notes += [replace(one, subject=where) for one in pair.stiffness.notes]
    return notes


_PUSHED = 2.0  # times the greatest tension: a load below zero that is no recoil


def _of_pull(pull: TensilePull, tension: Floats, names: Sequence[str]) -> list[Note]:
    notes = []
    for row, name in enumerate(names):
        least, most = finite_extremes(tension[row])
        if -least > _PUSHED * max(most, 0.0):
            notes.append(note("pushed-in-pull", name, least=least, most=most))
        if not pull.is_break[row]:
            peak = float(pull.peak_tension[row])
            notes.append(note("no-break", name, how=pull.how[row], tension=peak))
    return notes
