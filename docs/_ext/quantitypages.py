"""The page of every number by name, made from the rows of `reduction.quantities`."""

from __future__ import annotations

import re

from reduction.archive.csv_columns import OUTCOME_TABLES, GroupColumn
from reduction.quantities.names import RESPONSE_PATTERNS, RESPONSES, SINGLE_QUANTITIES
from reduction.quantities.row import Quantity

__all__ = ["pages"]

_SOURCES = {"000": "WHOI-2004-06", "002": "WHOI-2005-10", "003": "CG-D-39-80"}
_HEAD = """\
# Numbers by name

Made from the rows of `reduction.quantities`. One name a number, the same in code, archives and
tables; files are SI. `NAME_standard_uncertainty` has the unit of `NAME`. The header of a table is
`NAME [unit]`. Words are in the [glossary](../glossary.md).

## Values of flags

| variable | values |
|---|---|
"""
_RESPONSES = f"""\
In `surfaces.nc` a name is made of a response and what is said of it. `<response>` is one of
{", ".join(f"`{name}`" for name in RESPONSES)},
or one of them after `log_` (natural logarithm of the number in SI),
`log_frequency_times_` (of its product with the frequency in Hz) or `box_cox_`; `<unit>` is its
unit, 1 where it is transformed; `<response unit>` is that of the response in both cases. In a
table whose rows are of several responses the name begins with `response_`, and the columns `unit`
and `response_unit` say what `[unit]` and `[response_unit]` are."""


def _symbol(text: str) -> str:
    return re.sub(r"\b00[023]\b", lambda match: _SOURCES[match[0]], text)


def _row(*cells: str) -> str:
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|"


def _quantity(one: Quantity) -> str:
    unit = f"`{one.unit}`" if "<" in one.unit else one.unit or "text"
    return _row(f"`{one.name}`", unit, one.long_name, _symbol(one.source))


_OUTCOMES = """\
A row of `tables/strength.csv`, `exposure.csv`, `fatigue.csv` and `load_life.csv` is a group of
outcomes; a column that two of them have may mean what belongs to its own row."""


def _outcome_lines() -> list[str]:
    """One row a column and meaning, with the tables that have it."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for table, columns in OUTCOME_TABLES.items():
        for one in columns:
            if isinstance(one, GroupColumn) and one.column.no_uncertainty != "is an uncertainty":
                name, unit, meaning, _ = map(str, one.description)
                key = (name.partition(" [")[0], unit or "text", meaning)
                found.setdefault(key, []).append(f"{table}.csv")
    return [
        _row(f"`{name}`", unit, meaning, ", ".join(tables))
        for (name, unit, meaning), tables in sorted(found.items())
    ]


_HEADER, _RULE = _row("name", "unit", "what", "symbol in the source"), "|---|---|---|---|"


def pages() -> dict[str, str]:
    """Name below ``reference/`` to text."""
    flags = {one.name: one.flags for one in SINGLE_QUANTITIES.values() if one.flags}
    lines = [
        _row(f"`{name}`", ", ".join(f"{value} {word}" for word, value in values.items()))
        for name, values in sorted(flags.items())
    ]
    lines += ["", "## Quantities", "", _HEADER, _RULE]
    lines += [
        _quantity(one) for one in sorted(SINGLE_QUANTITIES.values(), key=lambda one: one.name)
    ]
    lines += ["", "## Quantities of a response", "", _RESPONSES, "", _HEADER, _RULE]
    lines += [_quantity(one) for one in RESPONSE_PATTERNS]
    lines += ["", "## Columns of the tables of outcomes", "", _OUTCOMES, ""]
    lines += [_row("name", "unit", "what", "table"), _RULE, *_outcome_lines()]
    return {"quantities.md": _HEAD + "\n".join(lines) + "\n"}
