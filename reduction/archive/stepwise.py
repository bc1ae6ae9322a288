"""A stepwise test: readings, and the slopes between them."""

from __future__ import annotations

import numpy as np

from reduction.archive.schema import STEP_MASKS
from reduction.archive.values import Values, texts
from reduction.moduli.stepwise import StepwiseResult

__all__ = ["stepwise_values"]


def stepwise_values(result: StepwiseResult) -> Values:
    """Return the readings as the contract names them: ``gauge_length`` is the length read."""
    flags = {
        "length_and_elongation_disagree": result.is_inconsistent,
        "creep": result.is_creep,
    }
    return {
        "channel": texts(["readings"]),
        "quality_mask": texts(list(flags)),
        "n_flagged": np.array([[np.count_nonzero(rows) for rows in flags.values()]]),
        "n_rows_read": np.array(result.time.size),
        "n_rows_kept": np.array(result.time.size),
        "clock": texts(result.clock),
        "time": result.time,
        "tension": result.tension,
        "gauge_length": result.length,
        "eye_to_eye_length": result.eye_to_eye_length,
        "printed_strain": result.printed_strain,
        "strain": result.strain,
        "branch": result.branch,
        "step_flag": np.sum([STEP_MASKS[name] * rows for name, rows in flags.items()], axis=0),
        "secant_modulus": result.secant_modulus,
        "secant_modulus_standard_uncertainty": result.secant_modulus_standard_uncertainty,
        "relaxed_gauge_length": np.array(result.gauge_length),
        "relaxed_gauge_length_standard_uncertainty": np.array(
            result.gauge_length_standard_uncertainty
        ),
        "interval_strain": result.interval_strain,
        "interval_modulus": result.interval_modulus,
        "interval_modulus_standard_uncertainty": result.interval_modulus_standard_uncertainty,
        "interval_branch": result.interval_branch,
    }
