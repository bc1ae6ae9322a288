"""Where each statement of a TOML text stands, so that one can be changed and the rest kept.

The text has been read by `tomllib` before: nothing is validated here.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass

__all__ = ["Path", "Statement", "Table", "read_tables"]

Path = tuple[str | int, ...]

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_KEY = re.compile(r"""[ \t]*([A-Za-z0-9_-]+|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')[ \t]*(\.?)""")
_LINE_END = re.compile(r"[^\n]*\n?")
# what ends a value, or may hold what looks like its end
_PIECE = re.compile(
    r'''"""(?:[^\\]|\\.)*?"{3,5}|\'\'\'.*?'{3,5}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'|\#[^\n]*|[\[\]{}\n]''',
    re.DOTALL | re.VERBOSE,
)


@dataclass(frozen=True)
class Statement:
    """One ``key = value``.

    ``path`` are all keys from the top of the document, numbers for entries of arrays of tables;
    ``start`` to ``end`` are its whole lines, ``value_start`` to ``value_end`` its value.
    """

    path: Path
    start: int
    value_start: int
    value_end: int
    end: int


@dataclass(frozen=True)
class Table:
    """A header with the statements under it; the top of a document has no header.

    ``start`` to ``end`` are the lines of the header.
    """

    path: Path
    start: int
    end: int
    statements: tuple[Statement, ...]


def read_tables(text: str) -> list[Table]:
    r"""Find the tables of a document, in order.

    Examples
    --------
    >>> top, tests = read_tables('a = 1\n[tests.T-1]\nfile = "T-1.csv"  # as sent\n')
    >>> tests.path, tests.statements[0].path
    (('tests', 'T-1'), ('tests', 'T-1', 'file'))
    """
    found: list[Table] = []
    header: Path = ()
    start = end = 0
    statements: list[Statement] = []
    counts: dict[Path, int] = {}
    place = _past_blank(text, 0)
    while place < len(text):
        line_start = text.rfind("\n", 0, place) + 1
        if text[place] == "[":
            found.append(Table(header, start, end, tuple(statements)))
            is_array = text.startswith("[[", place)
            keys, place = _keys(text, place + (2 if is_array else 1))
            header = _absolute(keys, counts, is_array=is_array)
            start, end = line_start, _line_end(text, place)
            statements, place = [], end
        else:
            keys, place = _keys(text, place)
            value_start = _after_equals(text, place)
            value_end = _value_end(text, value_start)
            place = _line_end(text, value_end)
            statements.append(
                Statement((*header, *keys), line_start, value_start, value_end, place)
            )
        place = _past_blank(text, place)
    return [*found, Table(header, start, end, tuple(statements))]


def _past_blank(text: str, place: int) -> int:
    match = _BLANK.match(text, place)
    return place if match is None else match.end()


def _line_end(text: str, place: int) -> int:
    match = _LINE_END.match(text, place)
    return place if match is None else match.end()


def _after_equals(text: str, place: int) -> int:
    place = text.index("=", place) + 1
    while text[place] in " \t":
        place += 1
    return place


def _keys(text: str, place: int) -> tuple[tuple[str, ...], int]:
    keys: list[str] = []
    while (match := _KEY.match(text, place)) is not None:
        raw, place = match[1], match.end()
        quoted = raw[0] in "\"'"
        keys.append(str(tomllib.loads(f"key = {raw}")["key"]) if quoted else raw)
        if not match[2]:
            break
    return tuple(keys), place


def _absolute(keys: tuple[str, ...], counts: dict[Path, int], *, is_array: bool) -> Path:
    """Path of a header; a table under an array of tables belongs to its last entry."""
    path: Path = ()
    for number, key in enumerate(keys, start=1):
        path = (*path, key)
        if is_array and number == len(keys):
            counts[path] = counts.get(path, -1) + 1
        if path in counts:
            path = (*path, counts[path])
    return path


def _value_end(text: str, place: int) -> int:
    depth, end = 0, place
    for match in _PIECE.finditer(text, place):
        piece = match[0]
        if depth == 0 and piece[0] in "#\n":
            return place + len(text[place : match.start()].rstrip())
        depth += (piece in "[{") - (piece in "]}")
        end = match.end()
    return end + len(text[end:].rstrip())
