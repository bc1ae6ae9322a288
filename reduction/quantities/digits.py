"""Numbers as a person reads them: without a power of ten where digits alone will do."""

from __future__ import annotations

from math import isfinite

_LOW, _HIGH, _HIGHEST = 1e-4, 1e7, 1e9
"""Where a number has no power of ten; to the third where it ends by its uncertainty."""

_MOST_PLACES = 12


def plain_number(value: float, digits: int = 5) -> str:
    """Return a number of so many digits; before the point zeros stand for those that it has not.

    Parameters
    ----------
    value : float
        The number. [any]
    digits : int
        Of it, without zeros at its end. [1]

    Returns
    -------
    text : str
        With a power of ten below 0.0001 and from ten millions on.

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
    """Return a number to so many places; below zero they are zeros before the point.

    What rounds to zero has no sign; a half goes to the even digit.

    Parameters
    ----------
    value : float
        The number. [any]
    places : int
        Behind the point. [1]
    mark : str, optional
        Between thousands.

    Returns
    -------
    text : str
        Without a power of ten.

    Examples
    --------
    >>> fixed_number(156633.2, -2), fixed_number(0.25, 3), fixed_number(-0.04, 1)
    ('156,600', '0.250', '0.0')
    >>> fixed_number(280991.3, -2, mark="")
    '281000'
    """
    # the same in every language: one quotient, one product
    unit = 10.0 ** max(-places, 0)
    rounded = round(value / unit) * unit if places < 0 else round(value, places)
    return f"{rounded + 0.0:,.{max(places, 0)}f}".replace(",", mark)


def places_of(value: float, digits: int) -> int:
    """Return the place of the last of so many digits, below zero where it is before the point.

    Parameters
    ----------
    value : float
        The number. [any]
    digits : int
        Of it. [1]

    Returns
    -------
    places : int
        Twelve at most; zero of the number zero. [1]

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
    """Return the places of a number that is known within half widths: two digits of the narrowest.

    The number keeps two digits of its own at least, and has seven at most.

    Parameters
    ----------
    value : float
        The number. [any]
    *halves : float
        Half widths of its intervals; NaN of one that is not known. [as value]

    Returns
    -------
    places : int or None
        None where no half width is known, or the number needs a power of ten. [1]

    Examples
    --------
    >>> places_within(280991.3, 2100.0, 9000.0), places_within(3.2, 500.0)
    (-2, 1)
    """
    known = [half for half in halves if isfinite(half) and half > 0]
    if not known or not _LOW <= max(abs(value), *known) < _HIGHEST:
        return None
    return max(min(places_of(min(known), 2), places_of(value, 7)), places_of(value, 2))
