"""Channels of a located test that follow from its own: strain, stress, flags."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from reduction.pipeline.locate import Located
from reduction.record import Floats, Quality, Record, Specimen, areas_of
from reduction.samples.blocks import copied, sample_blocks
from reduction.samples.scratch import empty_like, let_go
from reduction.strain.evaluate import extrapolated, strain_by_model
from reduction.strain.model import StrainModel
from reduction.workers import run_blocks


def strain_of_record(
    record: Record, position: Floats, tension: Floats, models: Sequence[StrainModel]
) -> Floats:
    """Strain of each specimen; NaN where position, or a tension that it needs, is not usable."""
    strain = empty_like(tension)
    measured = record.measured_strain

    def fill(place: tuple[int, slice]) -> None:
        index, part = place
        strain[place] = strain_by_model(
            models[index],
            position=position[part],
            tension=tension[place],
            measured_strain=None if measured is None else measured[place],
        )

    parts = list(sample_blocks(record.n_samples))
    run_blocks(
        fill,
        [(row, part) for row in range(len(models)) for part in parts],
        samples=(position, tension, strain, *(() if measured is None else (measured,))),
    )
    return strain


def parts_of_stress(record: Record, specimens: tuple[Specimen, ...]) -> dict[str, Any]:
    """Uncertainty of one reading of nominal stress, by field of `ReducedTest`.

    Stress itself is tension over an area, and is made where it is stored.
    """
    spread = record.tension_standard_uncertainty
    if not spread or not any(specimen.diameter for specimen in specimens):
        return {}
    return {"nominal_stress_standard_uncertainty": np.array(spread) / areas_of(specimens)}


def flagged_record(located: Located, models: Sequence[StrainModel]) -> Record:
    """The record with the flags that only cycles and strain models can set."""
    record, cycles = located.record, located.cycles
    position, tension = record.crosshead_position, record.tension
    flags = copied(record.quality_flag)
    of_position = copied(record.crosshead_position_quality_flag)
    for part in sample_blocks(record.n_samples, position, tension, flags, of_position):
        for index, model in enumerate(models):
            outside = extrapolated(model, position[part], tension[index, part])
            flags[index, part][outside] |= np.uint16(Quality.EXTRAPOLATED)
        if cycles is not None:
            uneven = (cycles.cycle_number[part] > 0) & ~cycles.is_constant_rate[part]
            flags[:, part][:, uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
            of_position[part][uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
            let_go(cycles.cycle_number, cycles.is_constant_rate)
    return replace(record, quality_flag=flags, crosshead_position_quality_flag=of_position)
