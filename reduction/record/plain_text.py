"""Makes texts from untrusted files safe to show, and puts names in order.

An address may contain a password before its host, or a signature after its path.  Neither is shown,
written or kept.
"""

from __future__ import annotations

import json
import re
import unicodedata

_LONGEST = 2000  # characters in one part of a message

_KEPT = "\n\t"

_FORMULA = re.compile(r"'*[=+\-@\t\r]")

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?|[+-]?(inf|nan)|-")

# control characters; format characters, which reverse or hide text; line and paragraph separators;
# lone surrogates, which no file can contain
_CATEGORIES = ("Cc", "Cf", "Zl", "Zp", "Cs")


class _VisibleText(dict[int, str]):
    """Display form of each character, found on first use."""

    def __missing__(self, code: int) -> str:
        sign = chr(code)
        if sign not in _KEPT and unicodedata.category(sign) in _CATEGORIES:
            sign = sign.encode("unicode_escape").decode("ascii")
        self[code] = sign
        return sign


_SHOWN = _VisibleText()


def visible(text: str) -> str:
    r"""A text with its control characters escaped.

    The text itself if it has none.

    Examples
    --------
    >>> print(visible("red\x1b[31m, \u202ebackwards"))
    red\x1b[31m, \u202ebackwards
    """
    return text if text.isprintable() else text.translate(_SHOWN)


def toml_text(value: object) -> str:
    r"""Texts, lists of texts and plain values as TOML, with invisible characters escaped.

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
    """A text on one line, for use after ``#``."""
    return " ".join(visible(text.replace("\n", "\\n")).split())


def safe_cell(text: str) -> str:
    """A text as a CSV cell that no spreadsheet program reads as a formula.

    The text with an apostrophe in front if it begins with ``=``, ``+``, ``-``, ``@``, a tab or a
    carriage return and is neither a number nor a minus alone, or if only apostrophes precede such a
    sign.

    Examples
    --------
    >>> [safe_cell(text) for text in ("=1+1", "-1.5", "-x", "T-1", "'=a")]
    ["'=1+1", '-1.5', "'-x", 'T-1', "''=a"]
    """
    is_formula = _FORMULA.match(text) is not None and _NUMBER.fullmatch(text) is None
    return f"'{text}" if is_formula else text


def bare_cell(cell: str) -> str:
    """Inverse of `safe_cell`.

    Examples
    --------
    >>> [bare_cell(cell) for cell in ("'=1+1", "-1.5", "''=a", "'tis")]
    ['=1+1', '-1.5', "'=a", "'tis"]
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def cut(text: str, longest: int = _LONGEST) -> str:
    """A text cut to a maximum length, with the number of characters removed.

    Examples
    --------
    >>> cut("x" * 2005)[-20:]
    'xxxxxxxx... (5 more)'
    """
    if len(text) <= longest:
        return text
    return f"{text[:longest]}... ({len(text) - longest} more)"


_SCHEME = r"[A-Za-z][A-Za-z0-9+.\-]*://"

_IN_TEXT = re.compile(rf"{_SCHEME}[^\s'\"<>]*")

_STOPS = ".,:;)"

_PORT = re.compile(r":\d*")

_SHORTEST = 4  # characters of a secret: shorter ones occur in ordinary words


def is_address(text: str) -> bool:
    """Whether a text is a remote address rather than a file on this machine.

    True for ``scheme://..``, even if schemes are chained.

    Examples
    --------
    >>> [is_address(text) for text in ("s3://bucket/T-1.csv", "raw/T-1.csv", "C:/raw/T-1.csv")]
    [True, False, False]
    """
    return "://" in text


def shown_address(address: str) -> str:
    """An address without user, password, query and fragment.

    Examples
    --------
    >>> shown_address("https://ann:secret@host:8080/raw/T-1.csv?signature=abc#row")
    'https://host:8080/raw/T-1.csv'
    """
    scheme, _, rest = re.split(r"[?#]", address, maxsplit=1)[0].partition("://")
    host, slash, path = rest.partition("/")
    if "@" in host:
        host = host.rpartition("@")[2]
    elif _has_password(host):
        # a key may contain an unquoted slash: text before the last @ is not a path
        _, at, behind = path.rpartition("@")
        host, slash, path = behind.partition("/") if at else ("...", slash, path)
    return f"{scheme}://{host}{slash}{path}"


def _has_password(host: str) -> bool:
    """Whether a colon is followed by neither a port nor IPv6 digits."""
    name, colon, _ = host.partition(":")
    return bool(colon) and not host.startswith("[") and not _PORT.fullmatch(host[len(name) :])


def without_secrets(text: str) -> str:
    """A text with each address replaced by its `shown_address`.

    The text itself if it contains no address.

    Examples
    --------
    >>> without_secrets("found 'https://ann:secret@host/T.csv?sig=abc', needed a file")
    "found 'https://host/T.csv', needed a file"
    """
    if "://" not in text:
        return text
    return _IN_TEXT.sub(_shown, text)


def _shown(found: re.Match[str]) -> str:
    """Safe form of an address; a full stop after it belongs to the sentence."""
    address = found[0].rstrip(_STOPS)
    return shown_address(address) + found[0][len(address) :]


def secrets_of(address: str) -> tuple[str, ...]:
    """Parts of an address that must not be shown.

    Examples
    --------
    >>> secrets_of("https://ann:secret@host/T.csv?signature=abcdef")
    ('signature=abcdef', 'secret', 'abcdef')
    """
    path, _, behind = address.partition("?")
    before = path.partition("://")[2].rpartition("@")[0]
    pieces = [*before.split(":", 1), behind]
    pieces += [part.partition("=")[2] for part in re.split(r"[&#;]", behind)]
    found = dict.fromkeys(piece for piece in pieces if len(piece) >= _SHORTEST)
    return tuple(sorted(found, key=len, reverse=True))


def natural_order(name: str) -> tuple[tuple[int, int, str], ...]:
    """Sort key that puts T-10 after T-2.

    Examples
    --------
    >>> sorted(["T-10", "T-2", "hold"], key=natural_order)
    ['hold', 'T-2', 'T-10']
    """
    return tuple(
        (0, int(part), "") if part.isdecimal() else (1, 0, part.lower())
        for part in re.split(r"(\d+)", name)
        if part
    )
