"""Write docs/glossary.md from `reduction.quantities.names`: ``python docs/make_glossary.py``."""

from __future__ import annotations

import re
from pathlib import Path

from reduction.archive.csv_columns import OUTCOME_TABLES, GroupColumn
from reduction.quantities.names import (
    BRANCH_VALUES,
    PHASE_VALUES,
    RESPONSE_PATTERNS,
    RESPONSES,
    SINGLE_QUANTITIES,
    _Quantity,
)
from reduction.record.measurement import Quality

__all__ = ["glossary"]

_SOURCES = {"000": "WHOI-2004-06", "002": "WHOI-2005-10", "003": "CG-D-39-80"}
_HEAD = """\
# Glossary

<!-- Written by docs/make_glossary.py from reduction/quantities/names.py; change it there. -->

One name a quantity, the same in code, archives and tables; files are SI. A variable
`NAME_standard_uncertainty` has the unit of `NAME`. A table's header is `NAME [unit]`.

| word | means |
|---|---|
| strain | nominal (engineering) strain of the splice-free length |
| stretch ratio | 1 + strain |
| amplitude | half a range |
| spring constant | force per unit strain |
| modulus | slope of nominal stress on strain, on the area at zero tension |
| stress at an elongation | the M100 of the rubber trade, which is a stress and no modulus |
| free length | splice toe to splice toe |
| hold, rest | the crosshead stands still under tension; with every specimen slack |
| ascending, descending | the control channel (position, or tension) rises; falls |
| type A | found from scatter or residuals; nothing that all samples share is in it |

## Values of flags

| variable | values |
|---|---|
"""
_RESPONSES = f"""\
In `surfaces.nc` a name is made of a response and what is said of it. `<response>` is one of
{", ".join(f"`{name}`" for name in RESPONSES)},
or one of them after `log_` (natural logarithm of the number in SI) or `box_cox_`; `<unit>` is its
unit, 1 where it is transformed; `<response unit>` is that of the response in both cases. In a
table whose rows are of several responses the name begins with `response_`, and the columns `unit`
and `response_unit` say what `[unit]` and `[response_unit]` are."""


def _symbol(text: str) -> str:
    return re.sub(r"\b00[023]\b", lambda match: _SOURCES[match[0]], text)


def _row(*cells: str) -> str:
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|"


def _quantity(one: _Quantity) -> str:
    unit = f"`{one.unit}`" if "<" in one.unit else one.unit or "text"
    return _row(f"`{one.name}`", unit, one.long_name, _symbol(one.symbol))


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


def glossary() -> str:
    """Text of docs/glossary.md."""
    flags = {"phase": PHASE_VALUES, "branch": BRANCH_VALUES}
    masks = {str(mask.name).lower(): mask.value for mask in Quality}
    flags |= dict.fromkeys(("quality_flag", "crosshead_position_quality_flag"), masks)
    lines = [
        _row(f"`{name}`", ", ".join(f"{value} {word}" for word, value in values.items()))
        for name, values in flags.items()
    ]
    lines += ["", "## Quantities", "", _HEADER, _RULE]
    lines += [
        _quantity(one) for one in sorted(SINGLE_QUANTITIES.values(), key=lambda one: one.name)
    ]
    lines += ["", "## Quantities of a response", "", _RESPONSES, "", _HEADER, _RULE]
    lines += [_quantity(one) for one in RESPONSE_PATTERNS]
    lines += ["", "## Columns of the tables of outcomes", "", _OUTCOMES, ""]
    lines += [_row("name", "unit", "what", "table"), _RULE, *_outcome_lines()]
    return _HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("glossary.md").write_text(glossary(), encoding="utf-8", newline="\n")
