"""The samples of a test, and the account of every row of its log."""

from __future__ import annotations

import numpy as np

from reduction.archive.schema import QUALITY_MASKS
from reduction.archive.values import Values, texts
from reduction.product import ReducedTest
from reduction.record import Record

__all__ = ["kept_samples", "row_account", "sample_values"]


def kept_samples(record: Record) -> slice:
    """Say which samples of a record go into its archive: all of them.

    The one place where a selection for very long logs belongs; `row_account` counts
    before it, so that no row goes uncounted.
    """
    return slice(0, record.n_samples)


def sample_values(test: ReducedTest, record: Record) -> Values:
    """Return everything that stands along ``sample``, with the declared uncertainties."""
    kept = kept_samples(record)
    position = "crosshead_position" if record.position_is_length else "crosshead_displacement"
    values: Values = {
        "time": record.time[kept],
        position: record.crosshead_position[kept],
        f"{position}_standard_uncertainty": np.array(record.position_standard_uncertainty),
        "crosshead_position_quality_flag": record.crosshead_position_quality_flag[kept],
        "tension": record.tension[:, kept],
        "quality_flag": record.quality_flag[:, kept],
    }
    if record.tension_standard_uncertainty:
        values["tension_standard_uncertainty"] = np.array(record.tension_standard_uncertainty)
    if record.measured_strain is not None:
        values["measured_strain"] = record.measured_strain[:, kept]
    if record.cycle_counter is not None:
        values["machine_cycle_number"] = record.cycle_counter[kept]
    if test.strain is not None:
        values["strain"] = test.strain[:, kept]
    if test.strain_standard_uncertainty is not None:
        values["strain_standard_uncertainty"] = test.strain_standard_uncertainty
    if any(specimen.diameter for specimen in test.specimens):
        area = np.array([one.area if one.diameter else np.nan for one in test.specimens])
        values["nominal_stress"] = record.tension[:, kept] / area[:, np.newaxis]
        if record.tension_standard_uncertainty:
            values["nominal_stress_standard_uncertainty"] = (
                np.array(record.tension_standard_uncertainty) / area
            )
    if test.phase is not None:
        values["phase"] = test.phase[kept]
    if test.cycles is not None:
        values["cycle_number"] = test.cycles.cycle_number[kept]
        values["branch"] = test.cycles.branch[kept]
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
