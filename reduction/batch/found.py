"""What the first pass found in a log, in the numbers that a person looks at first."""

from __future__ import annotations

from typing import Any

from reduction.ingest.quality import account_rows
from reduction.phases.intervals import median_step
from reduction.pipeline.locate import Located


def found_in(located: Located) -> dict[str, Any]:
    """Rate, gaps, standstills, flags and notes of a record, beside its rows and cycles.

    Parameters
    ----------
    located : Located
        The record.

    Returns
    -------
    found : dict
        As the JSON answer has it.
    """
    record = located.record
    n_flagged = account_rows(record).n_flagged
    return {
        "rate": {"value": 1 / median_step(record.time), "unit": "Hz"},
        "gaps": int(n_flagged.get("crosshead_position", {}).get("gap", 0)),
        "standstills": located.standstills.n_standstills,
        "flags": {channel: masks for channel, masks in n_flagged.items() if masks},
        "notes": [
            *record.notes,
            *(() if located.cycles is None else located.cycles.notes),
        ],
    }
