"""One key of a TOML text changed, and every other line as it was: comments, order, spacing.

What was made is read again and compared with what was meant; where they differ the text is
left as it is and a person is told which line to write.
"""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Mapping
from typing import Any

from reduction.errors import SettingsError
from reduction.explore.statements import Path, Statement, Table, read_tables
from reduction.visible import toml_text

__all__ = ["Value", "edited", "literal", "value_at"]

Value = bool | int | float | str | list[Any] | dict[str, Any]
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def edited(text: str, changes: Mapping[Path, Value | None]) -> str:
    r"""Return a TOML text with some keys set, or left out where the value is None.

    Parameters
    ----------
    text : str
        A document that `tomllib` reads.
    changes : mapping of path to value
        In the order in which they are made. The first two keys of a path name a table that
        need not be there: ``("tests", "T-1", "reduction", "cycles", "band")``.

    Returns
    -------
    text : str
        The same lines but those that change.

    Raises
    ------
    SettingsError
        If the text is written in a way that cannot be changed line by line.

    Examples
    --------
    >>> print(edited('[tests.T-1]\nfile = "a.csv"  # raw\n', {("tests", "T-1", "order"): 2}))
    [tests.T-1]
    file = "a.csv"  # raw
    order = 2
    """
    meant: dict[str, Any] = tomllib.loads(text)
    for path, value in changes.items():
        if value_at(meant, path) == value and type(value_at(meant, path)) is type(value):
            continue
        _put(meant, path, value)
        made = _without(text, path) if value is None else _with(text, path, value)
        try:
            is_meant = _pruned(tomllib.loads(made)) == _pruned(meant)
        except tomllib.TOMLDecodeError:
            is_meant = False
        if not is_meant:
            line = f"{'.'.join(map(str, path))} = {'' if value is None else literal(value)}"
            raise SettingsError(
                "campaign.toml is written in a way that is not changed here",
                needed="the line taken out by hand: " + line
                if value is None
                else "the line written by hand: " + line,
            )
        text = made
    return text


def value_at(document: object, path: Path) -> Any:
    """What stands at a path of a document; None where nothing does."""
    for key in path:
        if isinstance(document, dict) and isinstance(key, str):
            document = document.get(key)
        elif isinstance(document, list) and isinstance(key, int) and key < len(document):
            document = document[key]
        else:
            return None
    return document


def literal(value: Value) -> str:
    """Return a value as TOML has it on one line.

    Examples
    --------
    >>> print(literal({"method": "marks", "marks": "marks.csv"}))
    { method = "marks", marks = "marks.csv" }
    """
    if isinstance(value, dict):
        inside = ", ".join(f"{_key(key)} = {literal(one)}" for key, one in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, list):
        return f"[{', '.join(literal(one) for one in value)}]"
    if isinstance(value, str):
        return toml_text(value)
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else literal(key)


def _put(document: Any, path: Path, value: Value | None) -> None:
    """Set, or take out, one key of a document in memory."""
    for key in path[:-1]:
        if isinstance(document, list):
            document = document[int(key)]
        else:
            document = document.setdefault(key, {})
    if value is not None:
        document[path[-1]] = copy.deepcopy(value)
    elif path[-1] in document:
        del document[path[-1]]


def _pruned(document: Any) -> Any:
    """The same without empty tables: they say nothing, and a text may keep their headers."""
    if isinstance(document, list):
        return [_pruned(one) for one in document]
    if not isinstance(document, dict):
        return document
    parts = {key: _pruned(one) for key, one in document.items()}
    return {key: one for key, one in parts.items() if one != {}}


def _holder(tables: list[Table], path: Path) -> Statement | None:
    """The statement of a key, or of a value on one line that holds it."""
    own = [one for table in tables for one in table.statements]
    return next((one for one in own if path[: len(one.path)] == one.path), None)


def _with(text: str, path: Path, value: Value) -> str:
    tables = read_tables(text)
    holder = _holder(tables, path)
    if holder is not None:
        return _rewritten(text, holder, path, value)
    end_of_line = "\r\n" if "\r\n" in text else "\n"
    homes = [table for table in tables if _is_home(table, path)]
    if not homes:
        gap = "" if not text else end_of_line if text.endswith("\n") else 2 * end_of_line
        header = ".".join(_key(str(key)) for key in path[:2])
        line = _line(path[2:], value)
        return f"{text}{gap}[{header}]{end_of_line}{line}{end_of_line}"
    home = max(homes, key=lambda table: len(table.path))
    beside = [one for one in home.statements if one.path[:2] == path[:2]]
    place = beside[-1].end if beside else home.end
    above = text[beside[-1].start if beside else home.start : place]
    indent = above[: len(above) - len(above.lstrip(" \t"))]
    before = "" if place == 0 or text[place - 1] == "\n" else end_of_line
    line = f"{indent}{_line(path[len(home.path) :], value)}"
    return f"{text[:place]}{before}{line}{end_of_line}{text[place:]}"


def _is_home(table: Table, path: Path) -> bool:
    """Whether a key can be written under a header, where others of its test stand."""
    if path[: len(table.path)] != table.path:
        return False
    is_own = len(table.path) >= min(2, len(path) - 1)
    return is_own or any(one.path[:2] == path[:2] for one in table.statements)


def _line(keys: Path, value: Value) -> str:
    return f"{'.'.join(_key(str(key)) for key in keys)} = {literal(value)}"


def _without(text: str, path: Path) -> str:
    holder = _holder(read_tables(text), path)
    return text if holder is None else _rewritten(text, holder, path, None)


def _rewritten(text: str, holder: Statement, path: Path, value: Value | None) -> str:
    """The text with another value of one statement; without it where nothing is left of it."""
    within = path[len(holder.path) :]
    if within:
        whole = tomllib.loads(f"value = {text[holder.value_start : holder.value_end]}")["value"]
        _put(whole, within, value)
        value = whole or None
    if value is None:
        return text[: holder.start] + text[holder.end :]
    return text[: holder.value_start] + literal(value) + text[holder.value_end :]
