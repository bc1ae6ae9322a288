"""The samples of a test, and the account of every row of its log."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.archive.kept import KeptSamples
from reduction.archive.schema import QUALITY_MASKS
from reduction.archive.values import Values, texts
from reduction.product import ReducedTest
from reduction.record import UNUSABLE, Floats, Integers, Record, Specimen
from reduction.samples.blocks import full_like, sample_blocks
from reduction.samples.scratch import empty_like
from reduction.strain.stress import nominal_stress


def sample_values(test: ReducedTest, record: Record, kept: KeptSamples | None = None) -> Values:
    """Return everything that stands along ``sample``, with the declared uncertainties.

    Position and tension stand there as they were logged, in SI, with sign and zero
    applied: a flagged sample keeps its number.  Strain and nominal stress are made from
    usable samples and are NaN elsewhere.  Of a record that is not stored whole,
    ``sample_index`` says which sample each is.
    """

    def stored(values: NDArray[Any]) -> NDArray[Any]:
        return values if kept is None else kept.of(values)

    position = "crosshead_position" if record.position_is_length else "crosshead_displacement"
    tension, flags = stored(record.tension), stored(record.quality_flag)
    values: Values = {
        "time": stored(record.time),
        position: stored(record.crosshead_position),
        f"{position}_standard_uncertainty": np.array(record.position_standard_uncertainty),
        "crosshead_position_quality_flag": stored(record.crosshead_position_quality_flag),
        "tension": tension,
        "quality_flag": flags,
    }
    if kept is not None:
        values["sample_index"] = kept.index
    if record.tension_standard_uncertainty:
        values["tension_standard_uncertainty"] = np.array(record.tension_standard_uncertainty)
    if record.measured_strain is not None:
        values["measured_strain"] = stored(record.measured_strain)
    if record.cycle_counter is not None:
        values["machine_cycle_number"] = _narrowed(stored(record.cycle_counter))
    if test.strain is not None:
        values["strain"] = stored(test.strain)
    if test.strain_standard_uncertainty is not None:
        values["strain_standard_uncertainty"] = test.strain_standard_uncertainty
    if any(specimen.diameter for specimen in test.specimens):
        values["nominal_stress"] = _stress(tension, flags, test.specimens)
    if test.nominal_stress_standard_uncertainty is not None:
        values["nominal_stress_standard_uncertainty"] = test.nominal_stress_standard_uncertainty
    if test.phase is not None:
        values["phase"] = stored(test.phase)
    if test.cycles is not None:
        values["cycle_number"] = stored(test.cycles.cycle_number)
        values["branch"] = stored(test.cycles.branch)
    return values


def _narrowed(numbers: Integers) -> Integers:
    """Whole numbers of the width that they are stored in, by blocks."""
    narrow: Integers = empty_like(numbers, dtype=np.int32)
    for part in sample_blocks(numbers.size, numbers, narrow):
        narrow[part] = numbers[part]
    return narrow


def _stress(tension: Floats, flags: Integers, specimens: tuple[Specimen, ...]) -> Floats:
    """Nominal stress where a diameter is known and tension is usable, NaN elsewhere."""
    stress: Floats = full_like(tension, np.nan)
    for row, specimen in enumerate(specimens):
        if specimen.diameter:
            for part in sample_blocks(tension.shape[1], tension, flags, stress):
                known = np.where(flags[row, part] & UNUSABLE, np.nan, tension[row, part])
                stress[row, part] = nominal_stress(known, area=specimen.area)
    return stress


def row_account(record: Record, kept: KeptSamples | None = None) -> Values:
    """Count rows read, kept, stored and flagged, by channel and mask.

    Flags are counted over the whole record, whatever is stored of it.
    """
    flags = [record.crosshead_position_quality_flag, *record.quality_flag]
    return {
        "n_rows_read": np.array(record.n_rows_read),
        "n_rows_kept": np.array(record.n_samples),
        "n_rows_stored": np.array(record.n_samples if kept is None else kept.index.size),
        "channel": texts(
            ["time and crosshead position", *(f"tension of {name}" for name in record.specimens)]
        ),
        "quality_mask": texts(list(QUALITY_MASKS)),
        "n_flagged": np.array([_counts(row) for row in flags]),
    }


def _counts(flags: Integers) -> list[int]:
    """Samples with each mask."""
    counts = dict.fromkeys(QUALITY_MASKS.values(), 0)
    for part in sample_blocks(flags.size, flags):
        block = flags[part]
        seen = int(np.bitwise_or.reduce(block))
        for bit in counts:
            if seen & bit:
                counts[bit] += int(np.count_nonzero(block & bit))
    return list(counts.values())
