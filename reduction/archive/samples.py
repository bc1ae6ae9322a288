"""The samples of a test, and the account of every row of its log."""

from __future__ import annotations

import numpy as np

from reduction.archive.schema import QUALITY_MASKS
from reduction.archive.values import Values, texts
from reduction.product import ReducedTest
from reduction.record import Record

__all__ = ["row_account", "sample_values"]


def sample_values(test: ReducedTest, record: Record) -> Values:
    """Return everything that stands along ``sample``, with the declared uncertainties.

    Position and tension stand there as they were logged, in SI, with sign and zero
    applied: a flagged sample keeps its number.  Strain and nominal stress are made from
    usable samples and are NaN elsewhere.
    """
    position = "crosshead_position" if record.position_is_length else "crosshead_displacement"
    values: Values = {
        "time": record.time,
        position: record.crosshead_position,
        f"{position}_standard_uncertainty": np.array(record.position_standard_uncertainty),
        "crosshead_position_quality_flag": record.crosshead_position_quality_flag,
        "tension": record.tension,
        "quality_flag": record.quality_flag,
    }
    if record.tension_standard_uncertainty:
        values["tension_standard_uncertainty"] = np.array(record.tension_standard_uncertainty)
    if record.measured_strain is not None:
        values["measured_strain"] = record.measured_strain
    if record.cycle_counter is not None:
        values["machine_cycle_number"] = record.cycle_counter
    if test.strain is not None:
        values["strain"] = test.strain
    if test.strain_standard_uncertainty is not None:
        values["strain_standard_uncertainty"] = test.strain_standard_uncertainty
    if test.nominal_stress is not None:
        values["nominal_stress"] = test.nominal_stress
    if test.nominal_stress_standard_uncertainty is not None:
        values["nominal_stress_standard_uncertainty"] = test.nominal_stress_standard_uncertainty
    if test.phase is not None:
        values["phase"] = test.phase
    if test.cycles is not None:
        values["cycle_number"] = test.cycles.cycle_number
        values["branch"] = test.cycles.branch
    return values


def row_account(record: Record) -> Values:
    """Count rows read, kept, and flagged, by channel and mask."""
    flags = [record.crosshead_position_quality_flag, *record.quality_flag]
    return {
        "n_rows_read": np.array(record.n_rows_read),
        "n_rows_kept": np.array(record.n_samples),
        "channel": texts(
            ["time and crosshead position", *(f"tension of {name}" for name in record.specimens)]
        ),
        "quality_mask": texts(list(QUALITY_MASKS)),
        "n_flagged": np.array(
            [[np.count_nonzero(row & bit) for bit in QUALITY_MASKS.values()] for row in flags]
        ),
    }
