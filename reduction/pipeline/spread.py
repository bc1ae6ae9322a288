"""One standard uncertainty a specimen for its samples: of tension, position and strain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from reduction.pipeline.locate import Located
from reduction.record import Floats, Integers
from reduction.strain.evaluate import strain_by_model
from reduction.strain.model import StrainModel
from reduction.strain.uncertainty import strain_uncertainty_of
from reduction.uncertainty.field import error_field
from reduction.uncertainty.product import InstrumentErrors
from reduction.vocabulary import PHASE_VALUES

__all__ = ["strain_spread", "with_stated_channels"]

_SAMPLES = 4096  # spread over the record: the uncertainty changes slowly with strain


def _rows_of(phase: NDArray[np.int8]) -> Integers:
    """Cycling samples, or all but rests where none cycles."""
    rows = np.flatnonzero(phase == PHASE_VALUES["cycling"])
    if rows.size == 0:
        rows = np.flatnonzero(phase != PHASE_VALUES["rest"])
    return np.asarray(rows[:: max(1, rows.size // _SAMPLES)])


def strain_spread(
    located: Located,
    models: Sequence[StrainModel],
    *,
    phase: NDArray[np.int8],
    instruments: Sequence[InstrumentErrors] = (),
) -> Floats:
    """Root mean square over the samples of a reading's error and of what all samples share.

    Where the layout declares the uncertainty of a channel it is taken for that channel; where it
    does not, what is stated of the instrument is.
    """
    record = located.record
    rows = _rows_of(phase)
    position, tension = located.position[rows], located.tension[:, rows]
    declared = record.tension_standard_uncertainty or (np.nan,) * len(models)
    known = instruments or tuple(InstrumentErrors(model.specimen) for model in models)
    found = np.full(len(models), np.nan)
    for index, (model, of_tension, errors) in enumerate(zip(models, declared, known, strict=True)):
        of_position = record.position_standard_uncertainty
        shared = errors
        if np.isfinite(of_tension):
            shared = replace(shared, tension_gain=0.0, tension_offset=0.0)
        if np.isfinite(of_position):
            shared = replace(shared, position_gain=0.0, position_offset=0.0)
        spread = strain_uncertainty_of(
            replace(model, covariance=np.empty((0, 0))),
            position=position,
            tension=tension[index],
            position_uncertainty=of_position
            if np.isfinite(of_position)
            else errors.position_reading or np.nan,
            tension_uncertainty=of_tension
            if np.isfinite(of_tension)
            else errors.tension_reading or np.nan,
        )
        variance = np.nan_to_num(spread) ** 2
        if model.method != "extensometer":
            strain = strain_by_model(model, position=position, tension=tension[index])
            field = error_field(shared, model, strain=strain, tension=tension[index])
            variance = np.where(np.isnan(strain), np.nan, variance + np.sum(field.strain**2, 0))
        elif errors.strain_gain:
            measured = record.measured_strain
            level = np.nan if measured is None else measured[index, rows]
            variance = variance + (errors.strain_gain * level) ** 2
        usable = variance[np.isfinite(variance)]
        # nothing known of it is not the same as nothing wrong with it
        if usable.size and usable.any():
            found[index] = np.sqrt(np.mean(usable))
    return found


def with_stated_channels(
    located: Located, instruments: Sequence[InstrumentErrors], *, phase: NDArray[np.int8]
) -> Located:
    """Record with what is stated of its channels where the layout declares nothing of them.

    Root mean square over the samples of reading, gain and zero.
    """
    record = located.record
    if not instruments:
        return located
    rows = _rows_of(phase)
    if not rows.size:
        return located
    tension = record.tension_standard_uncertainty or (np.nan,) * len(instruments)
    position = record.position_standard_uncertainty
    level = [_root_mean_square(load) for load in located.tension[:, rows]]
    tension = tuple(
        own
        if np.isfinite(own)
        else _root(one.tension_reading, one.tension_offset, one.tension_gain * force)
        for own, one, force in zip(tension, instruments, level, strict=True)
    )
    first = instruments[0]
    if not np.isfinite(position):
        reach = _root_mean_square(located.position[rows])
        position = _root(first.position_reading, first.position_offset, first.position_gain * reach)
    return replace(
        located,
        record=replace(
            record,
            tension_standard_uncertainty=tension if np.isfinite(tension).any() else (),
            position_standard_uncertainty=position,
        ),
    )


def _root_mean_square(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0


def _root(*parts: float) -> float:
    """Root of the sum of squares; NaN where nothing is stated."""
    total = float(np.sqrt(np.sum(np.square(parts))))
    return total if total > 0 else float("nan")
