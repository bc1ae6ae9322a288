"""Implements the command catalogue."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rich.markup import escape

from reduction.batch.catalogue import (
    NUMBERS,
    Catalogue,
    Query,
    answer,
    check_ending,
    condition_of,
    load_catalogue,
    meaning_of,
    needed_quantities,
    quantities_there,
    unit_of,
    write_answer,
)
from reduction.cli.output import CommandOutput, plain_table
from reduction.cli.printed_numbers import plain, short, table_of
from reduction.quantities.names import QUANTITIES, name_of_quantity

_SPREAD = "_standard_uncertainty"

# columns that do not fit in a terminal; JSON and files have every column
_LEFT_TO_FILES = (
    "control", "waveform", "specimen_kind", "specimen_construction", "specimen_material",
    "specimen_condition", "test_mean_strain", "test_strain_amplitude", "diameter",
    "rated_break_strength", "archive",
)  # fmt: skip


def query_of(
    *,
    names: Mapping[str, Sequence[str] | None],
    words: Mapping[str, str | None],
    where: Sequence[str],
    quantity: Sequence[str],
    sort: Sequence[str],
    **rest: Any,
) -> Query:
    """Query from the options; those not given impose no condition."""
    query = Query(
        names={name: tuple(patterns) for name, patterns in names.items() if patterns},
        words={name: text for name, text in words.items() if text},
        where=tuple(condition_of(text) for text in where),
        quantity=tuple(map(_named, quantity)),
        sort=tuple(map(_named, sort)),
        **rest,
    )
    needed_quantities(query)  # unknown names are refused before any file is read
    return query


def _named(text: str) -> str:
    """Name of a quantity, also if requested by its symbol."""
    return text if text in QUANTITIES else name_of_quantity(text)


def show_catalogue(
    folder: Path, query: Query, *, export: Path | None, rebuild: bool, output: CommandOutput
) -> None:
    """Answer a query with a table or JSON, and a file if requested."""
    if export is not None:
        check_ending(export)
    catalogue = _catalogue(folder, needed_quantities(query), rebuild=rebuild)
    table = answer(catalogue, query)
    if export is not None:
        write_answer(table, export)
    _show(table, query, output)
    n_rows = table.num_rows
    output.say(f"{n_rows} row{'' if n_rows == 1 else 's'}" + (f", {export}" if export else ""))
    _say_what_is_left_out(catalogue, output)
    if output.json:
        output.answer(
            {
                "units": {name: unit_of(name) for name in table.column_names},
                "rows": [
                    {name: _plain(value) for name, value in row.items()}
                    for row in table.to_pylist()
                ],
                "unreadable": catalogue.unreadable,
            }
        )


def list_quantities(folder: Path, *, rebuild: bool, output: CommandOutput) -> None:
    """Print the quantities in the catalogue."""
    catalogue = _catalogue(folder, None, rebuild=rebuild)
    found = quantities_there(catalogue)
    table = table_of("quantity", "unit", "meaning", "numbers", texts=3)
    for name, count in found.items():
        table.add_row(name, unit_of(name), escape(meaning_of(name)), str(count))
    output.show(table)
    _say_what_is_left_out(catalogue, output)
    output.answer(
        {
            "quantities": {
                name: {"unit": unit_of(name), "numbers": count} for name, count in found.items()
            },
            "unreadable": catalogue.unreadable,
        }
    )


def _catalogue(folder: Path, quantities: Sequence[str] | None, *, rebuild: bool) -> Catalogue:
    """Catalogue of the campaigns in a folder, with the requested quantities."""
    if not rebuild:
        return load_catalogue(folder, quantities)
    # a query does not need the libraries that read archives
    from reduction.batch.catalogue_entries import rebuild as write_again

    left_out = write_again(folder)
    catalogue = load_catalogue(folder, quantities)
    return replace(catalogue, unreadable=catalogue.unreadable | left_out)


def _say_what_is_left_out(catalogue: Catalogue, output: CommandOutput) -> None:
    for reason in catalogue.unreadable.values():
        output.error(f"left out: {reason}")


def _show(table: Any, query: Query, output: CommandOutput) -> None:
    if not output.is_text:
        return
    asked = {*query.asked, *map(query.column, query.sort)}
    asked |= {query.column(one.name) for one in query.where}
    names = [
        name
        for name in table.column_names
        if name in asked or (name not in _LEFT_TO_FILES and table[name].null_count < table.num_rows)
    ]
    texts = [name for name in names if not unit_of(name)]
    numbers = [name for name in names if unit_of(name)]
    shown = {name: output.unit(unit_of(name)) for name in numbers}
    heads = [_heading(name, shown[name][0]) for name in numbers]
    heads = [*map(_short_name, texts), *heads]
    columns = [[text or "" for text in table[name].to_pylist()] for name in texts]
    columns += [_numbers(table[name].to_pylist(), shown[name][1], name) for name in numbers]
    if not sys.stdout.isatty():
        is_number = [place >= len(texts) for place in range(len(heads))]
        output.say(plain_table(heads, columns, is_number=is_number))
        return
    page = table_of(*heads, texts=len(texts))
    for row in zip(*columns, strict=True):
        page.add_row(*map(escape, row))
    output.show(page)


def _heading(name: str, unit: str) -> str:
    words = "standard uncertainty" if name.endswith(_SPREAD) else _short_name(name)
    return words if unit == "1" else f"{words} [{unit}]"


def _short_name(name: str) -> str:
    return name.removeprefix("test_") if name in NUMBERS else name


def _numbers(column: Sequence[float | None], scale: float, name: str) -> list[str]:
    digits = 3 if name.endswith(_SPREAD) else 5
    return ["" if value is None else short(value * scale, digits) for value in column]


def _plain(value: object) -> object:
    return plain(value) if isinstance(value, float) else value
