"""Quantities of a test with weights hung by hand."""

from __future__ import annotations

from reduction.quantities.flags import BRANCH_VALUES, STEP_MASKS
from reduction.quantities.row import (
    STATED,
    Quantity,
    again,
    along,
    flag,
    label,
    mask,
    measured,
    stated,
)
from reduction.quantities.samples_and_cycles import OF_RECORD

_INTERVAL = ("interval",)

_STEP = ("step",)

_RECORD = {row.name: row for row in OF_RECORD}


OF_STEPS: tuple[Quantity, ...] = (
    *along(
        _STEP,
        label("clock", "clock time of the reading, as printed", tables=("stepwise",)),
        measured(
            "gauge_length",
            "m",
            "distance between the gauge marks at the step",
            tables=("stepwise",),
            source="002 Table 4",
        ),
        stated(
            "eye_to_eye_length",
            "m",
            "eye-to-eye length",
            "a tape reading",
            tables=("stepwise",),
            source="002 Table 4",
        ),
        stated("printed_strain", "1", "strain as recorded", STATED, tables=("stepwise",)),
        mask("step_flag", "quality of the reading", STEP_MASKS, tables=("stepwise",)),
    ),
    measured("relaxed_gauge_length", "m", "gauge length at zero tension, after recovery"),
    *along(
        _INTERVAL,
        stated(
            "interval_strain",
            "1",
            "mid-point strain between two readings",
            "middle of two readings",
            tables=("stepwise_moduli",),
        ),
        measured(
            "interval_modulus",
            "Pa",
            "slope of stress against strain between two readings",
            shares_errors=True,
            tables=("stepwise_moduli",),
        ),
        flag(
            "interval_branch",
            "branch between two readings",
            BRANCH_VALUES,
            tables=("stepwise_moduli",),
        ),
    ),
)

IN_PLACE_OF_RECORD: tuple[Quantity, ...] = (
    *along(
        _STEP,
        again(_RECORD["time"], tables=("stepwise",)),
        again(_RECORD["tension"], tables=("stepwise",)),
        again(_RECORD["strain"], qualified_by=("step_flag",), tables=("stepwise",)),
        again(_RECORD["branch"], tables=("stepwise",)),
        again(_RECORD["secant_modulus"], shares_errors=True, tables=("stepwise",)),
    ),
)
