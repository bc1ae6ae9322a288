"""Search of lines by what they are made of, how, how thick, and in which condition.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Table 2.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from reduction.errors import SettingsError
from reduction.lookup.product import LineSource

DIAMETER_TOLERANCE = 0.03
"""Share within which two diameters are one size: 13 mm stands for 1/2 in, 2.4 % apart. [1]"""
_ROUNDING = 1e-9
_WORD = re.compile(r"[^\W_]+")


def find_lines(
    lines: Iterable[LineSource],
    *,
    material: str | None = None,
    construction: str | None = None,
    condition: str | None = None,
    diameter: float | None = None,
    tolerance: float = DIAMETER_TOLERANCE,
) -> list[LineSource]:
    """Lines of which all that is asked for holds.

    Parameters
    ----------
    lines : iterable of LineSource
        Published, or of a campaign.
    material, construction, condition : str, optional
        Words, in any case and order.  Each has to be in the text of the line; the beginning of a
        word does, but of a number the whole of it.
    diameter : float, optional
        A line without a diameter is not found then. [m]
    tolerance : float
        Greatest difference of a diameter, over the one that is asked for. [1]

    Returns
    -------
    found : list of LineSource
        In the order of ``lines``; one or more.

    Raises
    ------
    SettingsError
        If no line is so, the diameter is not positive, or the tolerance is negative.

    Notes
    -----
    Sizes are nominal ([1]_).  Sizes in inches are 1/16 in or more apart: the default joins names
    of one size in two systems, and parts two sizes up to 2 in.

    Examples
    --------
    >>> rope = LineSource("a", "", "Nylon 6", "double-braid", "new", 0.0127, 28e3)
    >>> [one.name for one in find_lines([rope], material="nylon", diameter=0.013)]
    ['a']
    """
    if diameter is not None and not diameter > 0:
        raise SettingsError(
            "a diameter is not positive", found=f"{diameter:g} m", needed="above zero"
        )
    if not tolerance >= 0:
        raise SettingsError(
            "the tolerance of a diameter is negative", found=f"{tolerance:g}", needed="0 or above"
        )
    known = list(lines)
    asked = {"material": material, "construction": construction, "condition": condition}
    words = {name: text for name, text in asked.items() if text is not None}
    found = [
        one
        for one in known
        if all(_has_words(getattr(one, name), text) for name, text in words.items())
        and (diameter is None or _is_size(one.diameter, diameter, tolerance))
    ]
    if not found:
        sizes = [] if diameter is None else [f"diameter {1e3 * diameter:.4g} mm within "
                                             f"{100 * tolerance:.3g} %"]  # fmt: skip
        raise SettingsError(
            "no line is so",
            found="; ".join([*(f"{name} '{text}'" for name, text in words.items()), *sizes]),
            needed=_there_is(known),
        )
    return found


def _has_words(text: str, wanted: str) -> bool:
    there = _WORD.findall(text.lower())
    return all(
        any(word == one or (word.isalpha() and one.startswith(word)) for one in there)
        for word in _WORD.findall(wanted.lower())
    )


def _is_size(diameter: float, wanted: float, tolerance: float) -> bool:
    return abs(diameter - wanted) <= (tolerance + _ROUNDING) * wanted


def _there_is(lines: Sequence[LineSource]) -> str:
    """What could have been asked for."""
    parts = []
    for name in ("material", "construction", "condition"):
        texts = dict.fromkeys(getattr(one, name) for one in lines if getattr(one, name))
        if texts:
            parts.append(f"{name} {' or '.join(texts)}")
    sizes = sorted({f"{1e3 * one.diameter:.4g}" for one in lines if one.diameter > 0}, key=float)
    if sizes:
        parts.append(f"diameter {', '.join(sizes)} mm")
    return "; ".join(parts) or "lines of which more is known"
