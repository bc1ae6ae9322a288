"""A row of a table of outcomes: every column, and the labels of its group.

References
----------
.. [1] CG-D-39-80, Tables 10 and 20: a row is a line in one condition.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import nan

from reduction.outcomes.columns import OutcomeColumn
from reduction.outcomes.groups import Group

Row = dict[str, float | int | str]


def empty_row(columns: Iterable[OutcomeColumn]) -> Row:
    """A row in which nothing is known yet.

    Parameters
    ----------
    columns : iterable of OutcomeColumn
        Of the table.

    Returns
    -------
    row : dict
        Empty text, 0 of what is counted, NaN of any other number.

    Raises
    ------
    TypeError
        Never for columns.

    Examples
    --------
    >>> empty_row([OutcomeColumn("line", "", "line"), OutcomeColumn("load", "N", "load")])
    {'line': '', 'load': nan}
    """
    return {
        column.name: "" if column.unit == "" else 0 if column.unit == "count" else nan
        for column in columns
    }


def labels_of(group: Group) -> Row:
    """What a group is, by column.

    Parameters
    ----------
    group : Group
        One line in one condition.

    Returns
    -------
    labels : dict
        Diameter [m] and exposure [year] NaN where not given.

    Raises
    ------
    TypeError
        Never for a group.

    Examples
    --------
    >>> labels_of(Group("PD", "polyester", "double braid", None, "new", 0.0))["exposure"]
    0.0
    """
    return {
        "line": group.line,
        "material": group.material,
        "construction": group.construction,
        "diameter": nan if group.diameter is None else group.diameter,
        "condition": group.condition,
        "exposure": nan if group.exposure is None else group.exposure,
    }
