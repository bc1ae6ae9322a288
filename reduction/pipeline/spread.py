"""One standard uncertainty a specimen for the strain of its samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reduction.pipeline.locate import Located
from reduction.record import Floats
from reduction.strain.model import StrainModel
from reduction.strain.uncertainty import strain_uncertainty_of
from reduction.vocabulary import PHASE_VALUES

__all__ = ["strain_spread"]

_SAMPLES = 4096  # spread over the record: the uncertainty changes slowly with strain


def strain_spread(
    located: Located, models: Sequence[StrainModel], *, phase: NDArray[np.int8]
) -> Floats:
    """Root mean square over the cycling samples, or over all but rests where none cycles."""
    record = located.record
    rows = np.flatnonzero(phase == PHASE_VALUES["cycling"])
    if rows.size == 0:
        rows = np.flatnonzero(phase != PHASE_VALUES["rest"])
    rows = rows[:: max(1, rows.size // _SAMPLES)]
    position, tension = located.position[rows], located.tension[:, rows]
    declared = record.tension_standard_uncertainty or (np.nan,) * len(models)
    found = np.full(len(models), np.nan)
    for index, (model, of_tension) in enumerate(zip(models, declared, strict=True)):
        spread = strain_uncertainty_of(
            model,
            position=position,
            tension=tension[index],
            position_uncertainty=record.position_standard_uncertainty,
            tension_uncertainty=of_tension,
        )
        known = np.isfinite(spread)
        if known.any():
            found[index] = np.sqrt(np.mean(spread[known] ** 2))
    return found
