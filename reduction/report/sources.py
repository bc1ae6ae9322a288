"""Sources of uncertainty on the page: names, one order and one look each, wherever they show.

What is of one instrument or one thing shares a hue and differs in hatching, so that a reader with
any colour vision, and one of a grey print, tells apart more sources than there are colours.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from reduction.report.style import COLOURS
from reduction.uncertainty.budget import RANDOM

_BLUE, _VERMILION, _GREEN, _PURPLE, _ORANGE, _SKY, _GREY = COLOURS
_LOOKS: dict[str, tuple[str, str]] = {
    RANDOM: (_GREY, ""),
    "run_to_run": (_GREY, ""),
    "regression": (_GREY, "/"),
    "tension_gain": (_BLUE, ""),
    "tension_offset": (_BLUE, "/"),
    "position_gain": (_ORANGE, ""),
    "position_offset": (_ORANGE, "/"),
    "lag": (_PURPLE, ""),
    "strain_calibration": (_GREEN, ""),
    "splice_method": (_GREEN, "/"),
    "strain_gain": (_GREEN, "x"),
    "gauge_length": (_GREEN, "."),
    "diameter": (_VERMILION, ""),
    "quasi_static_fit": (_SKY, ""),
    "temperature": (_VERMILION, "/"),
}
_UNKNOWN = (_GREY, "x")
FROM_READINGS = frozenset(
    {"strain_calibration", "splice_method", "quasi_static_fit", "gauge_length"}
)
"""Sources that follow from readings of the tests, not from what is stated of the instruments."""
_MEANINGS = {
    RANDOM: "scatter between cycles, noise, regression",
    "run_to_run": "scatter of runs at one point of the plan",
    "regression": "what the surface misses of its runs beside that",
    "lag": "time between the channels",
    "strain_calibration": "fit to the readings at the splice marks",
    "splice_method": "choice of the splice law",
    "gauge_length": "length that strain is a share of",
    "strain_gain": "what the strain method itself may miss",
    "quasi_static_fit": "fit of the slow pull that gives K_0",
    "temperature": "stiffness at the temperature of the test",
}


def in_order(names: Iterable[str]) -> list[str]:
    """Return sources in their order, those without a place of their own last.

    Examples
    --------
    >>> in_order({"diameter", "what_is_new", "random"})
    ['random', 'diameter', 'what_is_new']
    """
    places = {name: place for place, name in enumerate(_LOOKS)}
    return sorted(names, key=lambda name: (places.get(name, len(places)), name))


def source_words(name: str) -> str:
    """Return a source as a reader sees it; ``reduction budget`` prints the name itself.

    Examples
    --------
    >>> source_words("tension_gain")
    'tension gain'
    """
    return name.replace("_", " ")


def source_meanings(names: Iterable[str]) -> str:
    """Return what those sources are whose name does not say it.

    Examples
    --------
    >>> source_meanings(["tension_gain", "lag"])
    'Lag: time between the channels.'
    """
    told = [f"{source_words(name)}: {_MEANINGS[name]}" for name in names if name in _MEANINGS]
    text = "; ".join(told)
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def is_hatched(name: str) -> bool:
    """Return whether the bar of a source is hatched.

    Examples
    --------
    >>> is_hatched("tension_gain"), is_hatched("tension_offset")
    (False, True)
    """
    return bool(_LOOKS.get(name, _UNKNOWN)[1])


def bar_look(name: str) -> dict[str, Any]:
    """Return the marker of a bar: the colour and the hatching of its source.

    Examples
    --------
    >>> bar_look("tension_offset")["color"], bar_look("tension_offset")["pattern"]["shape"]
    ('#0072B2', '/')
    """
    colour, shape = _LOOKS.get(name, _UNKNOWN)
    return {
        "color": colour,
        "pattern": {
            "shape": shape, "fillmode": "overlay", "fgcolor": "#ffffff", "size": 7,
            "solidity": 0.35,
        },
        "line": {"width": 0.5, "color": "#ffffff"},
    }  # fmt: skip
