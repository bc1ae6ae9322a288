r"""Effect of unknown properties of a test on its answers, compared with their intervals.

If the effect of a doubt is within the 95 % interval of the answer, it is given as a note, since the
interval covers it.

References
----------
.. [1] Klein Tools, data sheet of cat. no. 1604-20L: a strand grip for 5,000 lb has 2.60 lb.
.. [2] MTS Systems, "Series 322 Load Frames," user manual, p. 20: spring rates of 2.6e8 N/m
   (100 kN) to 7.4e8 N/m (500 kN), without grips.
.. [3] WHOI-2005-10, sec. 1: stretch hoses are terminated with standard pipe flanges; ASME B16.5,
   class 150, NPS 2: a disc of 150 mm by 17.5 mm with a bore of 62 mm, less four holes of 19 mm, of
   steel has 2.0 kg.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import STANDARD_GRAVITY
from reduction.record.notes import Note, note
from reduction.stages.load_train import length_by_stroke, turn_acceleration
from reduction.stages.moduli.modulus_product import AmplitudeSummary
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.strain.strain_model import position_by_model

_USUAL_MASS = 1.2  # kg, [1]: no testing laboratory clamps a mooring line with less

_USUAL_FLANGES = 4.0  # kg, [3]: that of the hose and that of the machine

_USUAL_COMPLIANCE = 3.8e-9  # m/N, the softest frame of [2]; grips and load cell add to it

_USUAL_LAG = 0.005  # s, a filter of one pole at 30 Hz, or two channels read in turn at 200 Hz

_NAME = "apparent_spring_constant"

_SMALL = 1e-3  # step of strain for a slope


def load_train_notes(test: ReducedTest, instruments: Sequence[InstrumentErrors]) -> Iterator[Note]:
    """Note for each unstated term the size at which it moves K_ap or H by its uncertainty."""
    summary, record = test.amplitude, test.record
    if summary is None or record is None:
        return
    turn, is_resolved = 0.0, False
    if test.cycles is not None:
        logged = record.time, record.crosshead_position, test.cycles
        turn = turn_acceleration(*logged)
        # of a corner between two readings a log tells no acceleration, and shows no inertia
        is_resolved = turn < _RESOLVED * turn_acceleration(*logged, finest=2)
    for index, specimen in enumerate(test.specimens):
        constant = float(summary.apparent_spring_constant[index])
        spread = _standard_uncertainty(test, summary, _NAME, index)
        length = _length_of_strain(test, summary, index)
        square = (2 * np.pi * float(summary.frequency[index])) ** 2
        if not (spread > 0 and length > 0 and square > 0 and np.isfinite(constant)):
            continue
        train, of_mass = record.load_train, square * length
        is_hose = specimen.kind == "stretch hose"
        usual_mass = _USUAL_FLANGES if is_hose else _USUAL_MASS
        if is_resolved:  # what a mass does to the extremes of ramps it does while the machine turns
            of_mass = max(of_mass, turn / float(summary.strain_amplitude[index]))
        if test.cycles is not None and train.end_mass:
            yield from _inertia_left(test, summary, index, turn)
        if train.load_cell_at is None or (
            train.load_cell_at == "moving" and train.attached_mass is None
        ):
            yield note(
                "attached-mass-matters"
                if usual_mass * of_mass > spread
                else "attached-mass-unknown",
                specimen.name,
                mass=spread / of_mass,
                usual=usual_mass,
                effect=-usual_mass * of_mass / constant,
                cell=train.load_cell_at or "",
                is_hose=is_hose,
            )
        if train.load_cell_at is None or specimen.linear_density is None:
            yield note(
                "own-mass-unknown", specimen.name, at_moving=3 * spread / of_mass,
                at_fixed=6 * spread / of_mass,
            )  # fmt: skip
        is_crosshead = test.strain_models[index].method != "extensometer"
        # the uncertainty of a compliance of zero is in the interval
        is_stated = index < len(instruments) and instruments[index].machine_compliance > 0
        if train.machine_compliance is None and is_crosshead and not is_stated:
            # the machine yields to the tensions of all specimens, assumed equal
            effect = constant * len(test.specimens) / length
            yield note(
                "compliance-matters"
                if _USUAL_COMPLIANCE * effect * abs(constant) > spread
                else "compliance-unknown",
                specimen.name,
                compliance=spread / abs(constant * effect),
                usual=_USUAL_COMPLIANCE,
                effect=_USUAL_COMPLIANCE * effect,
            )
        if is_crosshead and not train.vertical:
            yield from _sag(test, summary, index, length, spread / abs(constant))
        of_energy = _standard_uncertainty(test, summary, "hysteresis_energy", index)
        stroke = float(summary.tension_amplitude[index] * summary.strain_amplitude[index])
        if not (of_energy > 0 and stroke > 0):
            continue
        if not (index < len(instruments) and instruments[index].tension_reversibility > 0):
            yield note(
                "instrument-hysteresis-unknown",
                specimen.name,
                reversibility=of_energy / (4 / 3 * stroke),
                # a loop of the width of the play over the range of tension
                play=of_energy * length / (2 * float(summary.tension_amplitude[index]))
                if is_crosshead
                else None,
            )
        if not (index < len(instruments) and instruments[index].lag > 0):
            # of an elastic specimen, the energy is not told from zero
            energy = max(abs(float(summary.hysteresis_energy[index])), of_energy)
            # of a sine, whose phase it turns
            of_lag = 2 * np.pi**2 * float(summary.frequency[index]) * stroke
            yield note(
                "lag-matters" if _USUAL_LAG * of_lag > _EXPANDED * of_energy else "lag-unknown",
                specimen.name,
                lag=of_energy / of_lag,
                usual=_USUAL_LAG,
                effect=-_USUAL_LAG * of_lag / energy,
            )


def _sag(
    test: ReducedTest, summary: AmplitudeSummary, index: int, length: float, spread: float
) -> Iterator[Note]:
    r"""Note where the sag of a horizontal specimen would move K_ap beyond its interval.

    The chord of a catenary is :math:`\operatorname{arsinh}(x) / x` of the line, with x half of its
    weight over the tension; a cycle takes out the difference of its turns.
    """
    specimen = test.specimens[index]
    mean, amplitude = (
        float(one[index]) for one in (summary.mean_tension, summary.tension_amplitude)
    )
    density = specimen.linear_density
    if density is None and specimen.is_rope and specimen.rated_break_strength is not None:
        density = _USUAL_DENSITY * specimen.rated_break_strength
    if density is None or not mean > amplitude:
        return
    weight = STANDARD_GRAVITY * density * length
    low, high = (weight / (2 * turn) for turn in (mean - amplitude, mean + amplitude))
    taken_out = float(np.arcsinh(high) / high - np.arcsinh(low) / low)
    effect = taken_out / (2 * float(summary.strain_amplitude[index]))
    # a sag that takes out more than the stroke was not there: the specimen hung or was supported
    if _EXPANDED * spread < effect < 1.0:
        found = note(
            "specimen-sags", specimen.name, effect=-effect, density=density,
            is_stated=specimen.linear_density is not None, length=length,
        )  # fmt: skip
        yield found if effect > _SMALL_SAG else replace(found, severity="note")


_SMALL_SAG = 0.005  # of K_ap

_USUAL_DENSITY = 2.2e-6  # kg/m a newton of break strength: polyester rope; nylon and wire have more


def _inertia_left(
    test: ReducedTest, summary: AmplitudeSummary, index: int, turn: float
) -> Iterator[Note]:
    """Note where the error of K_ap after the correction for stated masses exceeds its interval.

    The turns of ramps are treated as parts of a sine with their ratio of acceleration to rate.
    """
    record, specimen = test.record, test.specimens[index]
    constant = float(summary.apparent_spring_constant[index])
    half = _EXPANDED * _standard_uncertainty(test, summary, _NAME, index) / constant
    if record is None or not half > 0:
        return
    train = record.load_train
    force = train.force_left_at_turns[index] if train.force_left_at_turns else 0.0
    share = force / float(summary.tension_amplitude[index])
    if share > half:
        yield note("inertia-left-at-turns", specimen.name, force=force, effect=share)
    is_moving = train.load_cell_at == "moving"
    mass = abs(train.end_mass_by_density[index]) * (3 if is_moving else 6)
    mass *= specimen.linear_density or 0.0
    length = _length_of_strain(test, summary, index)
    rate = 2 * np.pi * float(summary.frequency[index])
    sharper = max(turn / (rate**2 * length * float(summary.strain_amplitude[index])), 1.0)
    angle = rate * np.sqrt(mass * length / constant)
    error = _wave_left(min(angle * sharper, _NEAR_RESONANCE), is_moving=is_moving) / sharper
    if abs(error) > half:
        yield note("specimen-near-resonance", specimen.name, effect=abs(error), share=angle / np.pi)


_RESOLVED = 1.5  # times the result of differences over twice the steps; at a corner it is 2

_NEAR_RESONANCE = 2.5  # of pi: beyond it damping decides


def _wave_left(angle: float, *, is_moving: bool) -> float:
    r"""Relative error of K_ap by the mass of the specimen after its inertia is subtracted.

    An elastic line held at one end, with its other end in sinusoidal motion, has the tensions
    :math:`k x_a\, \beta \cot\beta` at the moving end and :math:`k x_a\, \beta / \sin\beta` at the
    fixed one; the mean along it is :math:`k x_a`.  The term in beta squared is subtracted.
    """
    if angle < 1e-3:
        return 0.0
    if is_moving:
        return float(angle / np.tan(angle) + angle**2 / 3 - 1)
    return float(angle / np.sin(angle) - angle**2 / 6 - 1)


_POSSIBLE_FRICTION = 0.10  # of the extension of splices: a judgement, no measurement is known

# fraction of it in a loop: splices stand still after each reversal
_IN_LOOP = 0.8


def splice_friction_notes(
    test: ReducedTest, instruments: Sequence[InstrumentErrors]
) -> Iterator[Note]:
    """Note the effect of possible friction in the splices on H, if no mark or campaign shows it.

    A warning if it exceeds the interval of H, where H is known.
    """
    summary, found = test.amplitude, test.contributions
    if summary is None or found is None:
        return
    for index, errors in enumerate(instruments):
        rows = [
            number
            for number, one in enumerate(found.component)
            if one.source == "splice_friction" and one.of == errors.specimen
        ]
        if errors.is_splice_friction_known or not rows:
            continue
        share = _POSSIBLE_FRICTION / errors.splice_friction
        energy, constant = (
            share
            * float(found.values[f"test_{name}"][rows[0], index])
            / float(getattr(summary, name)[index])
            for name in ("hysteresis_energy", _NAME)
        )
        value = abs(float(summary.hysteresis_energy[index]))
        spread = _standard_uncertainty(test, summary, "hysteresis_energy", index)
        half = _EXPANDED * spread / value
        yield note(
            "splice-friction-matters"
            if half < 1 and abs(_IN_LOOP * energy) > half
            else "splice-friction-unknown",
            errors.specimen,
            size=_POSSIBLE_FRICTION,
            of_energy=_IN_LOOP * energy,
            of_constant=constant,
        )


def splice_slip_notes(test: ReducedTest) -> Iterator[Note]:
    """Note the excess of strain after slips: a warning if it exceeds the interval of strain.

    Includes slips of this test, and of earlier tests since the marks were read.  An extensometer is
    on the free length, where splices have no effect.
    """
    slips = test.slips
    for index, specimen in enumerate(test.specimens):
        own = [
            place
            for place, name in enumerate(() if slips is None else slips.specimen)
            if name == specimen.name
        ]
        if slips is not None and own and test.amplitude is not None:
            slipped = float(np.sum(slips.slip_length[own]))
            cycles = "cycle " if len(own) == 1 else "cycles "
            cycles += " and ".join(f"{cycle:,}" for cycle in slips.slip_cycle[own].tolist())
            yield _of_slip(test, index, "splice-slipped", slipped, cycles=cycles)
        before = 0.0 if test.history is None else float(test.history.splices_slipped_by[index])
        if before and test.strain_models[index].method != "extensometer":
            yield _of_slip(test, index, "splice-slipped-before", before)


def _of_slip(test: ReducedTest, index: int, code: str, slipped: float, **numbers: Any) -> Note:
    """Effect of a length let out by the splices on the strain of a test.

    It is compared with the interval of strain from all other sources.
    """
    specimen, model, summary = test.specimens[index], test.strain_models[index], test.amplitude
    if summary is not None:
        excess = slipped / _length_of_strain(test, summary, index)
        mean = float(summary.mean_strain[index])
        half = _EXPANDED * _standard_uncertainty(
            test, summary, "mean_strain", index, left_out="splice_slip"
        )
    else:
        hold = max(
            (one for one in test.holds if one.specimen == specimen.name),
            key=lambda one: one.hold_duration, default=None,
        )  # fmt: skip
        excess = mean = half = float("nan")
        if hold is not None:
            mean = hold.hold_strain
            ends = position_by_model(
                model, strain=[mean, mean + _SMALL], tension=[hold.hold_initial_tension] * 2
            )
            excess = slipped * _SMALL / float(ends[1] - ends[0])
        if test.strain_standard_uncertainty is not None:
            half = _EXPANDED * float(test.strain_standard_uncertainty[index])
    found = note(
        code, specimen.name, length=slipped, excess=excess, effect=excess / mean, **numbers
    )
    is_held = model.method == "extensometer" or excess <= half
    return replace(found, severity="note") if is_held else found


# the work of drift is subtracted as if the drift were even over each cycle: for creep in settled
# cycles this is right to a tenth of it; the interval covers the unknown place of the drift
_OF_ANSWER = {"identity-open": (_NAME, 0.0), "drift-in-energy": ("hysteresis_energy", 0.1)}

_EXPANDED = 2.0  # k of 95 %


def with_weighed_notes(test: ReducedTest) -> ReducedTest:
    """Convert warnings whose effect is within the interval of the affected answer to notes.

    The effect of drift on H, which also determines its interval, is a warning from a tenth of H on;
    in a step intended for bedding-in it is never a warning.
    """
    summary = test.amplitude
    if summary is None:
        return test
    names = [one.name for one in test.specimens]

    def weighed(one: Note) -> Note:
        if one.code not in _OF_ANSWER or one.subject not in names:
            return one
        if one.code == "drift-in-energy" and test.description.kind == "bedding-in":
            return replace(one, severity="note")
        (name, least), index = _OF_ANSWER[one.code], names.index(one.subject)
        value = abs(float(getattr(summary, name)[index]))
        half = max(_EXPANDED * _standard_uncertainty(test, summary, name, index), least * value)
        return replace(one, severity="note") if abs(one.numbers["effect"]) * value <= half else one

    identity = test.identity
    if identity is not None:
        identity = replace(identity, notes=tuple(map(weighed, identity.notes)))
    return replace(test, identity=identity, loop_notes=tuple(map(weighed, test.loop_notes)))


def _standard_uncertainty(
    test: ReducedTest, summary: AmplitudeSummary, name: str, index: int, *, left_out: str = ""
) -> float:
    """Both parts of that of an answer of the test, without one source. [its unit]."""
    random = float(summary.uncertainty[name][index])
    found = test.contributions
    if found is None or f"test_{name}" not in found.values:
        return random
    kept = [one.source != left_out for one in found.component]
    return float(np.hypot(random, np.linalg.norm(found.values[f"test_{name}"][kept, index])))


def _length_of_strain(test: ReducedTest, summary: AmplitudeSummary, index: int) -> float:
    """Stroke of the crosshead over range of strain: that of the gauge with its splices. [m]."""
    model = test.strain_models[index]
    if model.method == "extensometer":
        if test.record is None or test.cycles is None:
            return float("nan")
        return length_by_stroke(
            test.record.crosshead_position, test.cycles, summary.strain_amplitude[index]
        )
    way = np.array([1.0, -1.0])
    strain = summary.mean_strain[index] + way * summary.strain_amplitude[index]
    tension = summary.mean_tension[index] + way * summary.tension_amplitude[index]
    ends = position_by_model(model, strain=strain, tension=tension)
    return float((ends[0] - ends[1]) / (strain[0] - strain[1]))
