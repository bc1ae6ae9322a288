"""What is wrong with a campaign, all of it at once: open questions and values that do not fit."""

from __future__ import annotations

import reprlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from reduction.campaign.csvrows import split_row, split_rows
from reduction.campaign.textfiles import read_small_text
from reduction.errors import ReductionError, SettingsError
from reduction.ingest.sniff_channels import UNKNOWN
from reduction.units import Dimension, parse_quantity

_SHOWN = 10
_LONGEST_FOUND = 60
_DEEPEST = 12  # more keys below each other than any setting has
# what stands in the log itself, where a question mark may be one
_MARKS_OF_A_LOG = {"delimiter", "comment", "quote", "missing", "block_marker"}
_TABLES = {(*section, name) for section in ((), ("campaign",)) for name in ("tests", "results")}
_WORDS = {"missing": "is required", "extra_forbidden": "is not a known key"}


@dataclass(frozen=True)
class Fault:
    """A value that cannot be used; ``found`` is empty where nothing is to be shown."""

    place: str
    needed: str
    found: str

    def __str__(self) -> str:
        """``place: what is needed; found ...``."""
        return f"{self.place}: {self.needed}" + (f"; found {self.found}" if self.found else "")


def in_toml(path: Path, problem: str, **kwargs: Any) -> SettingsError:
    """An error of campaign.toml, with the file in front."""
    return SettingsError(f"{path}: {problem}", **kwargs)


def quantity_of(path: Path, place: str, text: str, dimension: Dimension) -> float:
    """Value in SI of what stands at a place of campaign.toml; its error names file and place."""
    try:
        return parse_quantity(text, dimension)
    except SettingsError as error:
        raise in_toml(
            path, f"{place}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip


def listed(headline: str, entries: Sequence[object]) -> str:
    """A first line, and up to ten entries below it."""
    lines = [headline, *(f"  {entry}" for entry in entries[:_SHOWN])]
    if len(entries) > _SHOWN:
        lines.append(f"  and {len(entries) - _SHOWN} more")
    return "\n".join(lines)


def _shown(value: object) -> str:
    """A value in quotes, cut where it is long."""
    if isinstance(value, str):
        room = _LONGEST_FOUND - 2  # for the quotes
        return repr(value if len(value) <= room else value[: room - 3].rstrip() + "...")
    text = reprlib.repr(value)  # tables may be deep
    return text if len(text) <= _LONGEST_FOUND else text[: _LONGEST_FOUND - 3].rstrip() + "..."


def _place(location: Sequence[str | int], table: object, *, is_missing: bool) -> tuple[str, ...]:
    """Keys of the table on the way to a fault, without the names that pydantic gives to choices."""
    place: list[str] = []
    for number, part in enumerate(location, start=1):
        if isinstance(table, list | tuple) and isinstance(part, int) and part < len(table):
            table = table[part]
            place.append(str(part))
        elif isinstance(table, dict) and part in table:
            table = table[part]
            place.append(str(part))
        elif is_missing and number == len(location):
            place.append(str(part))
        elif isinstance(table, dict) and isinstance(part, str):
            # the channel tension.1 stands in TOML as a table in a table
            stem, _, rest = part.partition(".")
            if isinstance(table.get(stem), dict) and rest in table[stem]:
                table = table[stem][rest]
                place.append(part)
    return tuple(place)


def faults_of(error: ValidationError, table: object) -> list[Fault]:
    """Every fault once.

    Parameters
    ----------
    error : pydantic.ValidationError
        As raised for the table.
    table : object
        What was validated, as TOML gives it.

    Returns
    -------
    faults : list of Fault
        In order; a value that fits none of several forms has one fault.
    """
    found: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for entry in error.errors():
        place = _place(entry["loc"], table, is_missing=entry["type"] == "missing")
        cause = entry.get("ctx", {}).get("error")
        if isinstance(cause, ReductionError):
            needed, value = str(cause), ""
        else:
            needed = _WORDS.get(entry["type"], entry["msg"].removeprefix("Value error, "))
            value = "" if entry["type"] == "missing" else _shown(entry["input"])
        found.setdefault(place, []).append((needed, value))
    faults = []
    above = {place[:length] for place in found for length in range(len(place))}
    for place, told in found.items():
        # a table is not a text either, but where its own keys have faults it was meant as a table
        if place in above:
            continue
        needed = " or ".join(
            text if number == 0 else text.removeprefix("Input should be ")
            for number, text in enumerate(dict.fromkeys(text for text, _ in told))
        )
        faults.append(Fault(".".join(place), needed, told[0][1]))
    return faults


def _leaves(value: object, keys: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], object]]:
    """Values of a table with their keys; a key that is open itself stands beside them."""
    if len(keys) > _DEEPEST:
        return
    if isinstance(value, dict):
        for key, entry in value.items():
            if key == UNKNOWN:
                yield (*keys, key), key
            yield from _leaves(entry, (*keys, str(key)))
    elif isinstance(value, list):
        for number, entry in enumerate(value):
            yield from _leaves(entry, (*keys, str(number)) if isinstance(entry, dict) else keys)
    else:
        yield keys, value


def _is_open(value: object) -> bool:
    return isinstance(value, str) and value.strip() == UNKNOWN


def _cells(folder: Path, name: str) -> Iterator[tuple[int, str, str]]:
    """Row, column and text of each cell; none of a file that is refused when it is read."""
    try:
        path = (folder / name).resolve()
        if not path.is_relative_to(folder.resolve()) or not path.is_file():
            return
        lines = split_rows(read_small_text(path))
    except (OSError, ValueError, RuntimeError):  # links in a ring
        return
    header = [column.strip() for column in split_row(lines[0]) or ()]
    for number, line in enumerate(lines[1:], start=2):
        yield from (
            (number, column, cell.strip())
            for column, cell in zip(header, split_row(line) or (), strict=False)
        )


def _tables_in(table: dict[str, Any]) -> list[str]:
    """Tables that campaign.toml names itself."""
    return [
        value
        for keys, value in _leaves(table)
        if isinstance(value, str)
        and not _is_open(value)
        and (keys in _TABLES or keys[-2:] == ("strain", "marks"))
    ]


def named_tables(folder: Path, table: dict[str, Any]) -> Iterator[str]:
    """Tables of a campaign by their names: of tests, results and marks, each once.

    Parameters
    ----------
    folder : pathlib.Path
        Of the campaign. Each table is looked into after its name was taken, since a table of
        tests names marks.
    table : dict
        campaign.toml, not validated yet.

    Yields
    ------
    name : str
        As written.
    """
    names = _tables_in(table)
    seen: set[str] = set()
    for name in names:  # grows
        if name in seen:
            continue
        seen.add(name)
        yield name
        names.extend(
            cell
            for _, column, cell in _cells(folder, name)
            if column == "marks" and cell and not any(map(_is_open, cell.split(";")))
        )


def open_questions(folder: Path, table: dict[str, Any]) -> list[str]:
    """Places that still hold ``?``, in campaign.toml, its tables and its marks.

    Parameters
    ----------
    folder : pathlib.Path
        Of the campaign.
    table : dict
        campaign.toml, not validated yet.

    Returns
    -------
    places : list of str
        Dotted keys of campaign.toml, then ``FILE:ROW [COLUMN]``.
    """
    places = [
        ".".join(keys)
        for keys, value in _leaves(table)
        if _is_open(value) and not (keys[0] == "layouts" and keys[-1] in _MARKS_OF_A_LOG)
    ]
    places += [
        f"{name}:{row} [{column}]"
        for name in named_tables(folder, table)
        for row, column, cell in _cells(folder, name)
        if any(map(_is_open, cell.split(";")))
    ]
    return list(dict.fromkeys(places))
