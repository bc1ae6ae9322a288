"""Texts from files of strangers, as they may be shown: nothing in them steers a terminal."""

from __future__ import annotations

import json
import re
import unicodedata

_LONGEST = 2000  # characters of a part of a message
_KEPT = "\n\t"
_FORMULA = re.compile(r"'*[=+\-@\t\r]")
_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?|[+-]?(inf|nan)|-")
# controls; format characters, which turn or hide text; line and paragraph separators; halves of
# pairs, which no file can hold
_CATEGORIES = ("Cc", "Cf", "Zl", "Zp", "Cs")


class _Shown(dict[int, str]):
    """What each character is shown as, found when it is first met."""

    def __missing__(self, code: int) -> str:
        sign = chr(code)
        if sign not in _KEPT and unicodedata.category(sign) in _CATEGORIES:
            sign = sign.encode("unicode_escape").decode("ascii")
        self[code] = sign
        return sign


_SHOWN = _Shown()


def visible(text: str) -> str:
    r"""A text with its control characters spelt out.

    Parameters
    ----------
    text : str
        Any; line ends and tabs stay.

    Returns
    -------
    shown : str
        The same where it has none.

    Examples
    --------
    >>> print(visible("red\x1b[31m, \u202ebackwards"))
    red\x1b[31m, \u202ebackwards
    """
    return text if text.isprintable() else text.translate(_SHOWN)


def toml_text(value: object) -> str:
    r"""Texts, lists of them and plain values as TOML, with nothing in them that is not seen.

    Parameters
    ----------
    value : object
        Text, number, boolean, or a list of these.

    Returns
    -------
    toml : str
        What stands behind the sign of equality.

    Examples
    --------
    >>> print(toml_text(["mm", "a\"b\x7f"]))
    ["mm", "a\"b\u007f"]
    """
    text = json.dumps(value, ensure_ascii=False)
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else _escaped(ord(sign)) for sign in text)


def _escaped(code: int) -> str:
    return f"\\u{code:04x}" if code < 1 << 16 else f"\\U{code:08x}"


def toml_comment(text: str) -> str:
    """A text on one line, to stand behind ``#``."""
    return " ".join(visible(text.replace("\n", "\\n")).split())


def safe_cell(text: str) -> str:
    """A text as a cell of a CSV file that no spreadsheet program takes for a formula.

    Parameters
    ----------
    text : str
        As it is.

    Returns
    -------
    cell : str
        With an apostrophe in front where it begins with ``=``, ``+``, ``-``, ``@``, a tab or a
        carriage return and is no number, or where apostrophes alone stand before such a sign.

    Examples
    --------
    >>> [safe_cell(text) for text in ("=1+1", "-1.5", "-x", "T-1", "'=a")]
    ["'=1+1", '-1.5', "'-x", 'T-1', "''=a"]
    """
    is_formula = _FORMULA.match(text) is not None and _NUMBER.fullmatch(text) is None
    return f"'{text}" if is_formula else text


def bare_cell(cell: str) -> str:
    """What `safe_cell` was given.

    Examples
    --------
    >>> [bare_cell(cell) for cell in ("'=1+1", "-1.5", "''=a", "'tis")]
    ['=1+1', '-1.5', "'=a", "'tis"]
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def cut(text: str, longest: int = _LONGEST) -> str:
    """A text of at most so many characters, with how many more there were.

    Examples
    --------
    >>> cut("x" * 2005)[-20:]
    'xxxxxxxx... (5 more)'
    """
    if len(text) <= longest:
        return text
    return f"{text[:longest]}... ({len(text) - longest} more)"
