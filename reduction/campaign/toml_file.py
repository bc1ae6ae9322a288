"""Reads TOML and CSV files written by users; reports all faults with file and key."""

from __future__ import annotations

import csv
import hashlib
import re
import reprlib
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from reduction.campaign.unit_types import Number, value_in_si
from reduction.quantities.units import Dimension
from reduction.readers.layout import UNKNOWN, check_regular
from reduction.record.errors import DataError, FitError, LogError, ReductionError, SettingsError
from reduction.record.plain_text import bare_cell, cut

_LARGEST = 16_000_000  # bytes; a campaign of 10^5 tests has a third of that


_DIGESTS: ContextVar[dict[Path, str] | None] = ContextVar("digests of small files", default=None)


@contextmanager
def noting_small_files() -> Iterator[dict[Path, str]]:
    """Collect the SHA-256 of each small file read in the block, by its resolved path."""
    digests: dict[Path, str] = {}
    before = _DIGESTS.set(digests)
    try:
        yield digests
    finally:
        _DIGESTS.reset(before)


def read_small_text(path: Path) -> str:
    """Text of a small file, in UTF-8 with or without a byte-order mark."""
    status = path.stat()
    check_regular(path, status.st_mode)
    if status.st_size > _LARGEST:
        raise LogError(
            path,
            "the file is too large to be a table or a campaign",
            found=f"{status.st_size:,} bytes",
            needed=f"{_LARGEST:,} bytes at most",
        )
    content = path.read_bytes()
    digests = _DIGESTS.get()
    if digests is not None:
        digests[path.resolve()] = hashlib.sha256(content).hexdigest()
    return content.decode("utf-8-sig")


def not_utf8(error: UnicodeDecodeError) -> dict[str, Any]:
    """What is wrong with a text in another encoding, and where."""
    row = error.object[: error.start].count(b"\n") + 1
    return {
        "found": f"the byte 0x{error.object[error.start]:02x} in row {row}",
        "needed": "a file saved as UTF-8",
    }


def read_csv_rows(
    path: Path, what: str, *, fault: Callable[..., ReductionError] = LogError
) -> tuple[list[str], Iterator[tuple[int, list[str]]]]:
    """Read a small CSV table, separated by commas."""
    try:
        text = read_small_text(path)
    except LogError as error:
        raise fault(path, error.problem, found=error.found, needed=error.needed) from error
    except UnicodeDecodeError as error:
        raise fault(path, f"{what} is not UTF-8 text", **not_utf8(error)) from error
    except OSError as error:
        raise fault(path, f"{what} cannot be read", found=error.strerror or str(error)) from error
    lines = split_rows(text)

    def split(number: int, line: str) -> list[str]:
        cells = split_row(line)
        if cells is None:
            raise fault(
                path, f"a row of {what} cannot be split into cells", row=number,
                found=repr(cut(line, 60)),
                needed="one line per row, with every quote closed, no cell of 131,072 characters",
            )  # fmt: skip
        return cells

    header = [name.strip() for name in split(1, lines[0])]
    if len(header) == 1 and (mark := re.search("[;\t]", header[0])):
        raise fault(
            path, f"the columns of {what} are not separated by commas", row=1,
            found=f"{mark[0]!r} in {cut(lines[0], 60)!r}",
            needed="commas between the columns, and points in the numbers",
        )  # fmt: skip

    def rows() -> Iterator[tuple[int, list[str]]]:
        for number, line in enumerate(lines[1:], start=2):
            cells = split(number, line)
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                raise fault(
                    path, "the number of cells in a row differs from the header", row=number,
                    found=str(len(cells)), needed=str(len(header)),
                )  # fmt: skip
            yield number, cells

    return header, rows()


def split_rows(text: str) -> list[str]:
    """Lines of a table, numbered as in an editor; at least one."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def split_row(line: str, delimiter: str = ",") -> list[str] | None:
    """Cells of one line; None if a quote is unclosed, or a cell is too long.

    Examples
    --------
    >>> split_row('T-1,"a, b",2')
    ['T-1', 'a, b', '2']
    >>> split_row('T-1,"a, b,2') is None
    True
    """
    try:
        cells = next(csv.reader([line], delimiter=delimiter, strict=True), [])
    except csv.Error:
        return None
    return [bare_cell(cell) for cell in cells]


_SHOWN = 10

_LONGEST_FOUND = 60

_DEEPEST = 12  # deeper nesting than any setting has

# characters of the log itself, where a question mark is valid
_MARKS_OF_A_LOG = {"delimiter", "comment", "quote", "missing", "block_marker"}

_TABLES = {(*section, name) for section in ((), ("campaign",)) for name in ("tests", "results")}

_WORDS = {"missing": "is required", "extra_forbidden": "is not a known key"}


@dataclass(frozen=True)
class _Fault:
    """An unusable value; ``found`` is empty if nothing is shown."""

    place: str
    needed: str
    found: str
    hint: str = ""

    def __str__(self) -> str:
        """``place: what is needed; found ...``."""
        found = f"; found {self.found}" if self.found else ""
        return f"{self.place}: {self.needed}{found}{self.hint}"


def in_toml(path: Path, problem: str, **kwargs: Any) -> SettingsError:
    """An error in campaign.toml, prefixed with the file."""
    return SettingsError(f"{path}: {problem}", **kwargs)


@contextmanager
def at_place(place: str) -> Iterator[None]:
    """Prefix errors with a place: the file, and a key if there is one."""
    try:
        yield
    except (SettingsError, DataError, FitError) as error:
        raise type(error)(
            f"{place}{error.problem}", found=error.found, needed=error.needed, hint=error.hint
        ) from error


def quantity_of(path: Path, place: str, text: Number, dimension: Dimension) -> float:
    """Value in SI of a text at a place in a file; errors name both."""
    with at_place(f"{path}: {place}: "):
        return value_in_si(text, dimension)


def listed(headline: str, entries: Sequence[object]) -> str:
    """A headline with up to ten entries below it."""
    lines = [headline, *(f"  {entry}" for entry in entries[:_SHOWN])]
    if len(entries) > _SHOWN:
        lines.append(f"  and {len(entries) - _SHOWN} more")
    return "\n".join(lines)


def _shown(value: object) -> str:
    """A value in quotes, shortened if long."""
    if isinstance(value, str):
        room = _LONGEST_FOUND - 2  # without the quotes
        return repr(value if len(value) <= room else value[: room - 3].rstrip() + "...")
    text = reprlib.repr(value)  # tables may be deeply nested
    return text if len(text) <= _LONGEST_FOUND else text[: _LONGEST_FOUND - 3].rstrip() + "..."


def _place(
    location: Sequence[str | int], table: object, *, is_missing: bool, is_value: bool
) -> tuple[str, ...]:
    """Table keys that lead to a fault, without pydantic's names of choices.

    If the value has a unit, a list entry is given by its name, or counted from one.
    """
    place: list[str] = []
    for number, part in enumerate(location, start=1):
        if isinstance(table, list | tuple) and isinstance(part, int) and part < len(table):
            table = table[part]
            name = table.get("name") if is_value and isinstance(table, dict) else None
            is_named = isinstance(name, str) and bool(name)
            place.append(cut(str(name), _LONGEST_FOUND) if is_named else str(part + is_value))
        elif isinstance(table, dict) and part in table:
            table = table[part]
            place.append(str(part))
        elif is_missing and number == len(location):
            place.append(str(part))
        elif isinstance(table, dict) and isinstance(part, str):
            # in TOML the channel tension.1 is a nested table
            stem, _, rest = part.partition(".")
            if isinstance(table.get(stem), dict) and rest in table[stem]:
                table = table[stem][rest]
                place.append(part)
    return tuple(place)


def _known_keys(
    schema: Mapping[str, Any], definitions: Mapping[str, Any], at: tuple[str, ...] = ()
) -> Iterator[tuple[str, ...]]:
    """Keys of a JSON schema with the tables that contain them; ``NAME`` is a user-defined name."""
    if len(at) > _DEEPEST:
        return
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    for name, entry in schema.get("properties", {}).items():
        yield (*at, name)
        yield from _known_keys(entry, definitions, (*at, name))
    for entry in schema.get("patternProperties", {}).values():
        yield from _known_keys(entry, definitions, (*at, "NAME"))
    choices = (*schema.get("anyOf", ()), *schema.get("oneOf", ()))
    for entry in (*choices, *([schema["items"]] if "items" in schema else ())):
        yield from _known_keys(entry, definitions, at)


@cache
def _keys_of(model: type[BaseModel]) -> tuple[tuple[str, ...], ...]:
    """Every key of a file of this model, with the tables that contain it."""
    schema = model.model_json_schema()
    return tuple(dict.fromkeys(_known_keys(schema, schema.get("$defs", {}))))


def _meant_by(place: tuple[str, ...], model: type[BaseModel], *, is_table: bool) -> str:
    """Suggestion for an unknown key: a similar one, or another table.

    If its value is a table, only places that take a table are suggested.
    """
    known = _keys_of(model)
    *table, key = place
    tables = {one[:-1] for one in known}
    here = next(
        (
            one
            for one in sorted(tables, key=lambda one: one.count("NAME"))
            if len(one) == len(table)
            and all(a in ("NAME", b) for a, b in zip(one, table, strict=True))
        ),
        None,
    )
    elsewhere = [
        f"[{'.'.join(one[:-1])}]"
        for one in known
        if one[-1] == key and len(one) > 1 and (not is_table or one in tables)
    ]
    if 0 < len(elsewhere) <= _MOST_PLACES:
        return f". It belongs in {' or '.join(elsewhere)}"
    near = get_close_matches(key, [one[-1] for one in known if one[:-1] == here], n=1, cutoff=0.75)
    return f". Did you mean {near[0]!r}?" if near else ""


_MOST_PLACES = 3  # suggested tables for a key known in others


def _name_words(pattern: str) -> str:
    """Say which characters a name may have, by its pattern.

    Examples
    --------
    >>> _name_words("^[A-Za-z0-9][A-Za-z0-9_ -]{0,99}$").split(",")[0]
    'Input should be a name of unaccented letters'
    """
    if not pattern.startswith("^[A-Za-z0-9]"):
        return (
            "Input should be a name of at most 100 characters, without [ ] * ^ , ; and without #"
            " or space first"
        )
    space = ", spaces" if " " in pattern else ""
    return (
        f"Input should be a name of unaccented letters, digits, - and _{space}, at most 100, the"
        " first a letter or digit; write it in another script in a note or title"
    )


def faults_of(
    error: ValidationError, table: object, model: type[BaseModel] | None = None
) -> list[_Fault]:
    """Every fault once; for a value that fits no choice, the fault of its number."""
    unknown: dict[tuple[str, ...], bool] = {}  # whether its value is a table
    found: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    values: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for entry in error.errors():
        cause = entry.get("ctx", {}).get("error")
        is_missing, is_value = entry["type"] == "missing", isinstance(cause, ReductionError)
        place = _place(entry["loc"], table, is_missing=is_missing, is_value=is_value)
        if isinstance(cause, ReductionError):
            place += (str(cause.facts["key"]),) if "key" in cause.facts else ()
            values[place] = [(str(cause), "")]
        needed = _WORDS.get(entry["type"], entry["msg"].removeprefix("Value error, "))
        needed = needed.replace("valid tuple", "list")
        if entry["type"] == "string_pattern_mismatch":
            needed = _name_words(str(entry["ctx"]["pattern"]))
        if entry["type"] == "extra_forbidden":
            unknown[place] = isinstance(entry["input"], dict)
        shown = "" if is_missing else _shown(entry["input"])
        found.setdefault(place, []).append((needed, shown))
    found |= values
    faults: list[_Fault] = []
    above = {place[:length] for place in found for length in range(len(place))}
    for place, told in found.items():
        # a table is no text either; if its own keys have faults, a table was intended
        if place in above:
            continue
        needed = " or ".join(
            text if number == 0 else text.removeprefix("Input should be ")
            for number, text in enumerate(dict.fromkeys(text for text, _ in told))
        )
        is_shown = len(faults) < _SHOWN
        hint = (
            _meant_by(place, model, is_table=unknown[place])
            if model and is_shown and place in unknown
            else ""
        )
        faults.append(_Fault(".".join(place), needed, told[0][1], hint))
    return faults


def _leaves(value: object, keys: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], object]]:
    """Values of a table with their keys; a key that is itself open is included."""
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
    """Row, column and text of each cell; none for a file that is refused on reading."""
    try:
        path = (folder / name).resolve()
        if not path.is_relative_to(folder.resolve()) or not path.is_file():
            return
        lines = split_rows(read_small_text(path))
    except (OSError, ValueError, RuntimeError):  # circular links
        return
    header = [column.strip() for column in split_row(lines[0]) or ()]
    for number, line in enumerate(lines[1:], start=2):
        yield from (
            (number, column, cell.strip())
            for column, cell in zip(header, split_row(line) or (), strict=False)
        )


def _named_tables(folder: Path, table: dict[str, Any]) -> Iterator[str]:
    """Names of the tables of a campaign (tests, results and marks) without repeats."""
    names = [
        value
        for keys, value in _leaves(table)
        if isinstance(value, str)
        and not _is_open(value)
        and (keys in _TABLES or keys[-2:] == ("strain", "marks"))
    ]
    seen: set[str] = set()
    for name in names:  # grows during the loop
        if name in seen:
            continue
        seen.add(name)
        yield name
        names.extend(
            cell
            for _, column, cell in _cells(folder, name)
            if column == "marks" and cell and not any(map(_is_open, cell.split(";")))
        )


def _open_questions(folder: Path, table: dict[str, Any]) -> list[str]:
    """Places that still contain ``?``, in campaign.toml, its tables and its marks."""
    places = [
        ".".join(keys)
        for keys, value in _leaves(table)
        if _is_open(value) and not (keys[0] == "layouts" and keys[-1] in _MARKS_OF_A_LOG)
    ]
    places += [
        f"{name}:{row} [{column}]"
        for name in _named_tables(folder, table)
        for row, column, cell in _cells(folder, name)
        if any(map(_is_open, cell.split(";")))
    ]
    return list(dict.fromkeys(places))


# input that takes the parser minutes or gigabytes, and that no setting needs
_DEEP = re.compile(r"""(?<![\w-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){40}""")

_MOST_LINES = 500_000

_Model = TypeVar("_Model", bound=BaseModel)


def read_toml(
    path: Path,
    model: type[_Model],
    *,
    what: str,
    needed: str,
    keys: str,
    text: str | None = None,
    hint: Callable[[Path], str | None] = lambda path: None,
) -> _Model:
    """Read and validate a TOML file."""
    try:
        table = _tables(read_small_text(path) if text is None else text)
    except LogError as error:
        raise in_toml(path, error.problem, found=error.found, needed=error.needed) from error
    except OSError as error:
        raise in_toml(
            path, f"{what} cannot be read", found=error.strerror or str(error), needed=needed
        ) from error
    except UnicodeDecodeError as error:
        raise in_toml(path, f"{what} is not TOML in UTF-8", **not_utf8(error)) from error
    except (ValueError, RecursionError) as error:  # too many digits are not a TOML error
        raise in_toml(path, f"{what} is not TOML", found=str(error), hint=hint(path)) from error
    places = _open_questions(path.parent, table)
    if places:
        count = f"{len(places)} values are" if len(places) > 1 else "1 value is"
        raise in_toml(path, listed(f"{count} still '?'", places))
    try:
        return model.model_validate(table)
    except ValidationError as error:
        faults = faults_of(error, table, model)
        count = f"{len(faults)} settings" if len(faults) > 1 else "1 setting"
        headline = f"{count} cannot be used, first '{faults[0].place}' ({keys})"
        raise in_toml(path, listed(headline, faults)) from error


def _tables(text: str) -> dict[str, Any]:
    """Content of a TOML text; `ValueError` if it is invalid or nested too deeply."""
    if text.count("\n") > _MOST_LINES:
        raise ValueError(f"more than {_MOST_LINES:,} lines")
    if deep := _DEEP.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        raise ValueError(f"a key of more than 40 parts (at line {line})")
    return tomllib.loads(text)
