"""A stepwise test: readings, and the slopes between them; their variables and values."""

from __future__ import annotations

from itertools import chain

import numpy as np

from reduction.archive.reasons import CLOCK, STATED
from reduction.archive.shared import COMPONENT, SHARED_OF_STEPS
from reduction.archive.values import Values, texts
from reduction.archive.variable import Variable, companion, flag, label, mask, measured, stated
from reduction.moduli.stepwise import StepwiseResult
from reduction.vocabulary import BRANCH_VALUES

STEP_MASKS = {"length_and_elongation_disagree": 1, "creep": 2}

STEP_ROWS: tuple[Variable, ...] = tuple(
    chain(
        label("clock", ("step",)),
        measured("gauge_length", ("step",)),
        stated("eye_to_eye_length", ("step",), "a tape reading"),
        stated("printed_strain", ("step",), STATED),
        mask("step_flag", ("step",), STEP_MASKS),
        measured("relaxed_gauge_length", ()),
        stated("interval_strain", ("interval",), "middle of two readings"),
        measured("interval_modulus", ("interval",)),
        flag("interval_branch", ("interval",), BRANCH_VALUES),
    )
)
STEPWISE: dict[str, Variable] = {
    row.name: row
    for row in chain(
        stated("time", ("step",), CLOCK),
        measured("tension", ("step",)),
        measured("strain", ("step",), ancillary=("step_flag",)),
        flag("branch", ("step",), BRANCH_VALUES),
        measured("secant_modulus", ("step",)),
        *(
            (
                companion(name, "_random_standard_uncertainty", dims),
                companion(name, "_uncertainty_contribution", (COMPONENT, *dims)),
            )
            for name, dims in SHARED_OF_STEPS.items()
        ),
    )
}
"""Names that stand along ``step`` in a stepwise test."""


def stepwise_values(result: StepwiseResult) -> Values:
    """Return the readings as the contract names them: ``gauge_length`` is the length read."""
    flags = {
        "length_and_elongation_disagree": result.is_inconsistent,
        "creep": result.is_creep,
    }
    shape, reading = result.strain.shape, result.length_standard_uncertainty
    return {
        "channel": texts(["readings"]),
        "quality_mask": texts(list(flags)),
        "n_flagged": np.array([[np.count_nonzero(rows) for rows in flags.values()]]),
        "n_rows_read": np.array(result.time.size),
        "n_rows_kept": np.array(result.time.size),
        "clock": texts(result.clock),
        "time": result.time,
        "tension": result.tension,
        "tension_standard_uncertainty": np.full(shape, result.tension_standard_uncertainty),
        "gauge_length": result.length,
        "gauge_length_standard_uncertainty": np.full(shape, reading),
        "eye_to_eye_length": result.eye_to_eye_length,
        "printed_strain": result.printed_strain,
        "strain": result.strain,
        "strain_standard_uncertainty": np.full(shape, reading / result.gauge_length),
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
