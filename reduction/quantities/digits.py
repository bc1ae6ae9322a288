"""Formats numbers for reading, with powers of ten only where digits do not suffice."""

from __future__ import annotations

from math import isfinite

_LOW, _HIGH, _HIGHEST = 1e-4, 1e7, 1e9
"""Range of numbers shown without a power of ten; up to the third if rounded by uncertainty."""

_MOST_PLACES = 12


def plain_number(value: float, digits: int = 5) -> str:
    """Return a number to a given number of digits; zeros fill the places before the point.

    Examples
    --------
    >>> [plain_number(one) for one in (280991.3, 0.012345678, 0.3, 2.5e8)]
    ['280990', '0.012346', '0.3', '2.5e+08']
    """
    text = f"{value:.{digits}g}"
    if not 10**digits <= abs(float(text)) < _HIGH:
        return text
    return f"{float(text):.0f}"


def fixed_number(value: float, places: int, *, mark: str = ",") -> str:
    """Return a number to a given number of decimal places; negative ones are before the point.

    A value that rounds to zero has no sign; a half rounds to the even digit.

    Text without a power of ten.

    Examples
    --------
    >>> fixed_number(156633.2, -2), fixed_number(0.25, 3), fixed_number(-0.04, 1)
    ('156,600', '0.250', '0.0')
    >>> fixed_number(280991.3, -2, mark="")
    '281000'
    """
    # the same in every language: one division, one multiplication
    unit = 10.0 ** max(-places, 0)
    rounded = round(value / unit) * unit if places < 0 else round(value, places)
    return f"{rounded + 0.0:,.{max(places, 0)}f}".replace(",", mark)


def places_of(value: float, digits: int) -> int:
    """Return the decimal place of the last significant digit, negative before the point.

    At most twelve; zero for the number zero.

    Examples
    --------
    >>> places_of(0.0123, 2), places_of(12300.0, 2)
    (3, -3)
    """
    if value == 0:
        return 0
    power = int(f"{value:.16e}".partition("e")[2])
    return min(digits - 1 - power, _MOST_PLACES)


def places_within(value: float, *halves: float) -> int | None:
    """Return the decimal places for a number with given half-widths: two digits of the narrowest.

    The number has at least two and at most seven digits.

    None if no half-width is known, or the number needs a power of ten.

    Examples
    --------
    >>> places_within(280991.3, 2100.0, 9000.0), places_within(3.2, 500.0)
    (-2, 1)
    """
    known = [half for half in halves if isfinite(half) and half > 0]
    if not known or not _LOW <= max(abs(value), *known) < _HIGHEST:
        return None
    return max(min(places_of(min(known), 2), places_of(value, 7)), places_of(value, 2))
