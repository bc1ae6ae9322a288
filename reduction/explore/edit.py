"""Some keys of a TOML text changed, and every other line as it was: comments, order, spacing.

What was made is read again and compared with what was meant; where they differ the text is
left as it is and a person is told which line to write.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import tomlkit
from tomlkit.container import Container
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable, Item, Table

from reduction.errors import SettingsError

Path = tuple[str | int, ...]
Value = bool | int | float | str | list[Any] | dict[str, Any]
_NAMED = 2
"""Keys of a header that is added where a table is not there, as in ``[tests.T-1]``."""


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
        If the text is written in a way in which a key cannot be changed by itself.

    Examples
    --------
    >>> print(edited('[tests.T-1]\nfile = "a.csv"  # raw\n', {("tests", "T-1", "order"): 2}))
    [tests.T-1]
    file = "a.csv"  # raw
    order = 2
    """
    for path, value in changes.items():
        before = tomllib.loads(text)
        now = value_at(before, path)
        if now == value and type(now) is type(value):
            continue
        try:
            made = _with(text, path, value)
            after = tomllib.loads(made)
            is_meant = value_at(after, path) == value
            is_meant &= dict(_leaves(before, path)) == dict(_leaves(after, path))
        except (TOMLKitError, ValueError, KeyError, TypeError, AttributeError):
            is_meant = False
        if not is_meant:
            raise SettingsError(
                "campaign.toml is written in a way that is not changed here",
                needed=f"the line taken out by hand: {_dotted(path)}"
                if value is None
                else f"the line written by hand: {_line(path, value)}",
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


def _leaves(document: Any, left_out: Path, at: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every value but one by its path; tables that hold nothing say nothing."""
    if at == left_out:
        return
    if isinstance(document, dict | list):
        pairs = document.items() if isinstance(document, dict) else enumerate(document)
        for key, value in pairs:
            yield from _leaves(value, left_out, (*at, key))
    else:
        yield at, document


def _with(text: str, path: Path, value: Value | None) -> str:
    """The text with one key set, or left out."""
    document = tomlkit.parse(text)
    end_of_line = "\r\n" if "\r\n" in text else "\n"
    holder: Any = document
    home, keys = holder, path
    depth, last = 0, len(path) - 1
    while depth < last and (isinstance(path[depth], int) or path[depth] in holder):
        holder = holder[path[depth]]
        depth += 1
        if isinstance(holder, Table) and not holder.is_super_table():
            home, keys = holder, path[depth:]
    key = path[depth]
    if isinstance(holder, InlineTable):
        # of a table on one line the whole is written again
        whole: dict[str, Any] = holder.unwrap()
        for name in reversed(path[depth + 1 :]):
            value = {str(name): value}
        whole[str(key)] = value
        return _with(text, path[:depth], {k: v for k, v in whole.items() if v is not None} or None)
    if value is None:
        del holder[key]
    elif depth == last and (isinstance(key, int) or key in holder):
        holder[key] = _item(value)
    elif depth < min(_NAMED, last):
        gap = "" if not text else end_of_line if text.endswith("\n") else 2 * end_of_line
        lines = f"[{_dotted(path[:_NAMED])}]", _line(path[_NAMED:], value), ""
        return f"{text}{gap}{end_of_line.join(lines)}"
    else:
        # below the last key of its table, which is above the comment of the next table
        before = _last_line(home)
        before.trail = before.trail or end_of_line
        before.trail += f"{before.indent}{_line(keys, value)}{end_of_line}"
    return tomlkit.dumps(document)


def _last_line(table: Any) -> Any:
    """What stands about the last key of a table; about its header where it has no key."""
    body = table.body if isinstance(table, Container) else table.value.body
    for key, item in reversed(body):
        if key is not None and (key.is_dotted() or not isinstance(item, Table | AoT)):
            return _last_line(item) if isinstance(item, Table) else item.trivia
    return table.trivia


def _dotted(keys: Path) -> str:
    return tomlkit.key([str(key) for key in keys]).as_string()


def _line(keys: Path, value: Value) -> str:
    return f"{_dotted(keys)} = {_item(value).as_string()}"


def _item(value: Value) -> Item:
    """A value as it is written on one line."""
    if isinstance(value, dict) and value:
        inside = ", ".join(_line((key,), one) for key, one in value.items())
        return tomlkit.value(f"{{ {inside} }}")
    return tomlkit.inline_table() if value == {} else tomlkit.item(value)
