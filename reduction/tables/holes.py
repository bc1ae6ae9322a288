"""Why a number of a table has no uncertainty where others of its column have one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from reduction.tables.column import Cell, Column
from reduction.tables.outcomes import GroupColumn

_U = "_standard_uncertainty"
_ONE_READING = "there is one reading, and nothing is stated of it"
_OF_DESIGN = "nothing is stated of the numbers of the hose"
_OF_RUNS = "the runs leave no scatter to judge by"
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
_UNKNOWN = "nothing is known of its scatter"


def lonely_numbers(
    columns: Sequence[Column | GroupColumn], fields: Sequence[Sequence[str]]
) -> set[int]:
    """Find the uncertainties that are empty where a number stands beside.

    Parameters
    ----------
    columns : sequence of Column or GroupColumn
        Of a table.
    fields : sequence of sequence of str
        Rows of it, by column.

    Returns
    -------
    lonely : set of int
        Places of such columns. [1]
    """
    return {
        place
        for place, _ in _uncertainties(columns)
        if "" in fields[place]
        and any(
            not own and number for own, number in zip(fields[place], fields[place - 1], strict=True)
        )
    }


def column_descriptions(
    columns: Sequence[Column | GroupColumn], lonely: Collection[int] = ()
) -> Iterator[list[Cell]]:
    """Return the rows of columns.csv of one table.

    Parameters
    ----------
    columns : sequence of Column or GroupColumn
        Of the table.
    lonely : collection of int
        From `lonely_numbers`, of all its rows. [1]

    Yields
    ------
    description : list
        Of each column; that of an uncertainty says why it is empty where a number stands beside.
    """
    quantities = dict(_uncertainties(columns))
    for place, column in enumerate(columns):
        *about, reason = column.description
        if place in lonely:
            reason = f"{reason}; empty where {_WHY.get(quantities[place], _UNKNOWN)}"
        yield [*about, reason]


def _uncertainties(columns: Sequence[Column | GroupColumn]) -> Iterator[tuple[int, str]]:
    """Places of the uncertainties, and of which quantity each is."""
    names = [column.header.partition(" [")[0] for column in columns]
    for place, (name, own) in enumerate(pairwise(names), start=1):
        if own == f"{name}{_U}":
            yield place, name
