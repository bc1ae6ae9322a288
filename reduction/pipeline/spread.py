"""How well a sample of tension, position, strain and stress is known: one number a specimen.

A reading has an error of its own, which no other sample shares; a load cell's gain and zero, a
crosshead's, the tape and the diameter are in every sample of the test.  The two are kept apart, as
in every number of a product.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from reduction.pipeline.locate import Located
from reduction.record import Floats, Integers, Record, Specimen
from reduction.samples.blocks import take_samples
from reduction.samples.search import thinned
from reduction.strain.evaluate import strain_by_model
from reduction.strain.model import StrainModel
from reduction.uncertainty.field import error_field
from reduction.uncertainty.join import merged, stacked
from reduction.uncertainty.points import with_diameter
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors
from reduction.vocabulary import PHASE_VALUES

_SAMPLES = 4096  # spread over the record: the uncertainty changes slowly with strain


def readings_of(
    record: Record, instruments: Sequence[InstrumentErrors]
) -> tuple[InstrumentErrors, ...]:
    """Errors with that of one reading of each channel: the one rule of which statement counts.

    What the layout declares of one reading takes the place of noise and resolution of the
    campaign, which hold for every log: the layout is of this one.  Gain and zero are stated by the
    campaign alone, and stand beside either.
    """
    known = instruments or tuple(InstrumentErrors(name) for name in record.specimens)
    tension = record.tension_standard_uncertainty or (np.nan,) * len(known)
    position = record.position_standard_uncertainty
    return tuple(
        replace(
            errors,
            tension_reading=own if np.isfinite(own) else errors.tension_reading,
            position_reading=position if np.isfinite(position) else errors.position_reading,
        )
        for errors, own in zip(known, tension, strict=True)
    )


def with_readings(record: Record, readings: Sequence[InstrumentErrors]) -> Record:
    """Record with the standard uncertainty of one reading; NaN where nothing says it."""
    tension = tuple(one.tension_reading or np.nan for one in readings)
    return replace(
        record,
        tension_standard_uncertainty=tension if np.isfinite(tension).any() else (),
        position_standard_uncertainty=readings[0].position_reading or np.nan,
    )


def reading_spread(
    located: Located,
    models: Sequence[StrainModel],
    readings: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Floats:
    """Standard uncertainty of strain by one reading of position and tension. [1].

    Root mean square over the samples, shape (n_specimens,); NaN where nothing is known of either
    channel, and for an extensometer, which reads neither.
    """
    rows = _rows_of(phase)
    position, tension = take_samples(located.position, rows), take_samples(located.tension, rows)
    found = np.full(len(models), np.nan)
    for index, (model, errors) in enumerate(zip(models, readings, strict=True)):
        if model.method == "extensometer" or not (
            errors.position_reading or errors.tension_reading
        ):
            continue
        parts = []
        for of_position, of_tension in (
            (errors.position_reading, 0.0),
            (0.0, errors.tension_reading),
        ):
            # a step of one standard uncertainty: finite where a law is steep near no tension
            high, low = (
                strain_by_model(
                    model,
                    position=position + way * of_position,
                    tension=tension[index] + way * of_tension,
                )
                for way in (1, -1)
            )
            parts.append((high - low) / 2)
        found[index] = _rms(np.hypot(*parts))
    return found


def channel_contributions(
    located: Located,
    strain: Floats,
    models: Sequence[StrainModel],
    specimens: Sequence[Specimen],
    errors: Sequence[InstrumentErrors],
    *,
    phase: NDArray[np.int8],
) -> Contributions:
    """What shared errors do to the samples, by archive name of the channel.

    Each contribution is the root mean square over the cycling samples, or over all but rests
    where none cycles, with the sign of the mean.  Of tension and position it is what the channel
    itself may be wrong by; strain has in addition the tape and the strain method, and stress the
    diameter.  The lag between the channels is in none of them.  Nothing without stated errors.
    """
    if not errors:
        return Contributions(())
    rows = _rows_of(phase)
    own = [
        _of_specimen(
            take_samples(located.tension[index], rows),
            take_samples(strain[index], rows),
            model,
            specimen,
            one,
        )
        for index, (model, specimen, one) in enumerate(zip(models, specimens, errors, strict=True))
    ]
    reach = _rms(take_samples(located.position, rows))
    first = errors[0]
    is_length = located.record.position_is_length
    of_position = _of_channel(
        "crosshead_position" if is_length else "crosshead_displacement",
        {
            Component("position_gain", first.position_instrument): first.position_gain * reach,
            Component("position_offset", first.position_instrument): first.position_offset,
        },
    )
    return merged([stacked(own), of_position])


def _of_specimen(
    tension: Floats,
    strain: Floats,
    model: StrainModel,
    specimen: Specimen,
    errors: InstrumentErrors,
) -> Contributions:
    level = _rms(tension)
    cell = errors.tension_instrument
    of_tension = _of_channel(
        "tension",
        {
            Component("tension_gain", cell): errors.tension_gain * level,
            Component("tension_offset", cell): errors.tension_offset,
        },
    )
    field = error_field(errors, model, strain=strain, tension=tension)
    of_strain = Contributions(
        field.component,
        {"strain": np.array([_signed_rms(row) for row in field.strain]).reshape(-1)},
    )
    if not specimen.diameter:
        return merged([of_tension, of_strain])
    of_stress = Contributions(
        of_tension.component, {"nominal_stress": of_tension.values["tension"] / specimen.area}
    )
    value = {"nominal_stress": np.asarray(level / specimen.area)}
    return merged(
        [of_tension, of_strain, with_diameter(of_stress, errors, value, area=specimen.area)]
    )


def _of_channel(name: str, stated: dict[Component, float]) -> Contributions:
    """Contributions to one channel, without those that are zero."""
    kept = {one: value for one, value in stated.items() if value}
    return Contributions(tuple(kept), {name: np.array(list(kept.values()))})


def _rows_of(phase: NDArray[np.int8]) -> Integers:
    """Cycling samples, or all but rests where none cycles."""
    cycling, rest = PHASE_VALUES["cycling"], PHASE_VALUES["rest"]
    rows = thinned(lambda part: phase[part] == cycling, phase.size, most=_SAMPLES, samples=(phase,))
    if rows.size:
        return rows
    return thinned(lambda part: phase[part] != rest, phase.size, most=_SAMPLES, samples=(phase,))


def _rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0


def _signed_rms(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.copysign(_rms(known), known.mean())) if known.size else 0.0
