"""Why a number of a table has no uncertainty where others of its column have one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from reduction.tables.column import Cell, Column
from reduction.tables.outcomes import GroupColumn

__all__ = ["column_descriptions"]

_U = "_standard_uncertainty"
_ONE_READING = "there is one reading, and nothing is stated of it"
_OF_DESIGN = "nothing is stated of the numbers of the hose"
_OF_RUNS = (
    "a run does not keep what it shares with the others (a note of surfaces.nc names it), or the "
    "runs leave no scatter to judge by"
)
_WHY = {
    "diameter": _ONE_READING,
    "area": _ONE_READING,
    "tension": "nothing is stated of it",
    "parameter_value": "the fit does not hold it: its interval is wider than its bounds",
    "event_strain": _OF_DESIGN,
    "event_tension": _OF_DESIGN,
    "event_fill_pressure": _OF_DESIGN,
    "response_coefficient": _OF_RUNS,
    "response_coefficient_engineering": _OF_RUNS,
    "property_stiffness": "property_remark says why",
    "property_stiffness_over_strength": "property_remark says why",
    "property_strain": "property_remark says why",
}
_SILENT = (
    "the archive of the test does not keep what it shares, beside others that do: it would count "
    "as exact; reduce it again"
)
_UNKNOWN = "nothing is known of its scatter"


def column_descriptions(
    columns: Sequence[Column | GroupColumn],
    rows: Sequence[Sequence[Cell]],
    silent: Collection[str] = (),
) -> Iterator[list[Cell]]:
    """Return the rows of columns.csv of one table.

    Parameters
    ----------
    columns : sequence of Column or GroupColumn
        Of the table.
    rows : sequence of sequence
        Of it.
    silent : collection of str
        Quantities that a test has without uncertainty, since it does not keep what it shares.

    Yields
    ------
    description : list
        Of each column; that of an uncertainty says why it is empty where a number stands beside.
    """
    names = ["", *(column.header.partition(" [")[0] for column in columns)]
    for place, column in enumerate(columns):
        *about, reason = column.description
        name, own = names[place : place + 2]
        if own == f"{name}{_U}" and any(
            row[place] is None and row[place - 1] is not None for row in rows
        ):
            known = [_WHY[name]] if name in _WHY else []
            why = [*known, *([_SILENT] if name in silent else [])] or [_UNKNOWN]
            reason = f"{reason}; empty where {', or '.join(why)}"
        yield [*about, reason]
