"""Which tables of tests there are, in the order in which they are listed."""

from __future__ import annotations

from reduction.tables.changes import CHANGE_TABLES
from reduction.tables.curves import CURVE_TABLES
from reduction.tables.holds import HOLD_TABLES
from reduction.tables.programme import ROPE_TABLES
from reduction.tables.records import RECORD_TABLES, SPLICE_TABLES
from reduction.tables.ropelines import LINE_TABLES
from reduction.tables.rubber import RUBBER_TABLES, STEPWISE_TABLES
from reduction.tables.shared import SHARED_TABLES

TABLES = (
    *CURVE_TABLES,
    *HOLD_TABLES,
    *SPLICE_TABLES,
    *LINE_TABLES,
    *ROPE_TABLES,
    *SHARED_TABLES,
    *CHANGE_TABLES,
    *RUBBER_TABLES,
    *STEPWISE_TABLES,
    *RECORD_TABLES,
)
