"""Blanks between thousands; apart from other numbers, since every command loads it at its start."""

from __future__ import annotations

import re

_NUMBERS = re.compile(r"[-+]?[\d.]+(?: to [-+]?[\d.]+)?")
_MANY = re.compile(r"(?<![\d.])\d{6,}")


def grouped(text: str) -> str:
    """A number, or the ends of an interval, with a blank between thousands from 100000 on.

    Any other text stays as it is.

    Examples
    --------
    >>> grouped("98000 to 283100"), grouped("-123456.5"), grouped("0.0001234567")
    ('98000 to 283 100', '-123 456.5', '0.0001234567')
    >>> grouped("T-123456")
    'T-123456'
    """
    if not _NUMBERS.fullmatch(text):
        return text
    return _MANY.sub(lambda found: f"{int(found[0]):,}".replace(",", " "), text)
