"""Guess which column is which channel, by its name, its unit and its values.

What is not known stands as ``?``, on which a layout does not load.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from reduction.errors import SettingsError
from reduction.ingest.columns import stated_scale
from reduction.ingest.layout import CLOCK
from reduction.record import Floats
from reduction.units import DIMENSIONS, Dimension
from reduction.visible import toml_comment, toml_text

UNKNOWN = "?"
_NOT_MEASURED = (
    r"sollwert|set ?point|command|target|maximum|minimum|max|min|rate|speed|velocity|"
    r"geschwindigkeit|digital"
)
# ranked: the first pattern that fits a column wins; the second text rules a column out
_NAMES: dict[str, tuple[Dimension, tuple[str, ...], str]] = {
    "time": (
        "time",
        (r"^(elapsed|test|total|run|running)? ?time$", r"^(lauf|prüf|pruef|mess)?zeit$",
         r"^time\b", r"\b(time|zeit)$", r"^t$", r"^wf increment$"),
        r"cycle|date|datum|stamp|start",
    ),
    "crosshead_position": (
        "length",
        (r"crosshead|traverse", r"^position|^pos$", r"weg$|\bweg\b", r"extension",
         r"displace?ment|\bdisp\b|^disp",
         r"stroke|tool separation", r"^machine$|^maschine$"),
        _NOT_MEASURED,
    ),
    "tension": (
        "force",
        (r"load|force|kraft|tension|zuglast", r"weight|gewicht"),
        _NOT_MEASURED + r"|friction|cell",
    ),
    "strain": ("strain", (r"strain|dehnung|extensometer|elongation",), _NOT_MEASURED + "|true"),
    "cycle_counter": (
        "number",
        (r"^total cycles$", r"^(cycle|zyklus|zyklen|lastspiele?)( number| count(er)?)?$",
         r"^total cycle count$", r"^cycles$"),
        r"elapsed|time",
    ),
    "temperature": ("temperature", (r"^temp(erature?|eratur)?\b",), _NOT_MEASURED),
}  # fmt: skip
_MANY = ("tension", "strain")  # one a specimen
_SUFFIXES = {
    "s": "s", "sec": "s", "ms": "ms", "min": "min", "ft": "ft", "in": "inch", "mm": "mm",
    "cm": "cm", "m": "m", "lb": "lbf", "lbs": "lbf", "lbf": "lbf", "kip": "kip", "n": "N",
    "kn": "kN", "kgf": "kgf", "pct": "%", "percent": "%", "degc": "degC", "degf": "degF",
}  # fmt: skip
_BRACKETED = re.compile(r"\s*[\(\[]([^()\[\]]*)[\)\]]\s*$")
_CLOCK = re.compile(r"([01]?\d|2[0-3]):[0-5]\d(:[0-5]\d([.,]\d+)?)?|([01]\d|2[0-3])[0-5]\d")
_RISING = 0.9  # share of the steps of a time column that do not go back


@dataclass(frozen=True)
class SeenColumn:
    """One column as it was seen: ``texts`` and ``values`` (NaN where no number) of some rows.

    ``is_named`` is false where the reader will not find the name in the file.
    """

    number: int
    name: str = ""
    unit: str = ""
    values: Floats = field(default_factory=lambda: np.empty(0))
    texts: tuple[str, ...] = ()
    is_named: bool = True


@dataclass(frozen=True)
class Proposal:
    """Channels as lines of TOML, whether any was found, and what is a guess in them."""

    lines: tuple[str, ...]
    keys: tuple[str, ...]
    remarks: tuple[str, ...]


@lru_cache(maxsize=4096)
def is_unit(text: str, dimension: Dimension | None = None) -> bool:
    """Whether a text is a unit, of one dimension or of any."""
    if not text:
        return False
    for wanted in (dimension,) if dimension is not None else DIMENSIONS:
        try:
            stated_scale(text, wanted)
        except SettingsError:
            continue
        return True
    return False


def _plain(name: str) -> str:
    """A name in lower case, without unit in brackets or suffix, words parted by blanks."""
    text = _BRACKETED.sub("", name).strip()
    words = [word for word in re.split(r"[\W_]+", text.lower()) if word]
    if len(words) > 1 and words[-1] in _SUFFIXES:
        words.pop()
    return " ".join(words)


def _unit(column: SeenColumn, dimension: Dimension) -> str | None:
    """Unit that a column states; ``?`` where it states none, None where it is another kind."""
    stated = column.unit.strip().strip("()[]").strip()
    bracketed = _BRACKETED.search(column.name)
    for text in (stated, bracketed[1].strip() if bracketed else ""):
        if is_unit(text, dimension):
            return "lbf" if dimension == "force" and text in ("lb", "lbs") else text
        if is_unit(text):
            return None
    suffix = re.split(r"[\s_.]+", column.name.strip())[-1]
    unit = _SUFFIXES.get(suffix.lower(), "") if suffix != column.name.strip() else ""
    if unit and is_unit(unit):
        return unit if is_unit(unit, dimension) else None
    return "1" if dimension == "number" else UNKNOWN


def _is_clock(column: SeenColumn) -> bool:
    """Whether all texts are clock times; four digits only where one begins with 0."""
    return (
        bool(column.texts)
        and all(_CLOCK.fullmatch(text) for text in column.texts)
        and any(":" in text or text.startswith("0") for text in column.texts)
    )


def _fits(key: str, column: SeenColumn) -> bool:
    """Whether the values can be those of a channel."""
    values = column.values[np.isfinite(column.values)]
    if key == "time" and _is_clock(column):
        return True
    if not values.size:
        return False
    if key == "time":
        return values.size == 1 or float(np.mean(np.diff(values) >= 0)) >= _RISING
    if key == "cycle_counter":
        return bool(np.all(values == np.round(values)) and np.all(np.diff(values) >= 0))
    return True


def _candidates(key: str, columns: Sequence[SeenColumn]) -> list[tuple[SeenColumn, str]]:
    """Columns that may be a channel, best first, each with its unit."""
    dimension, patterns, barred = _NAMES[key]
    found = []
    for rank, pattern in enumerate(patterns):
        for column in columns:
            plain = _plain(column.name)
            if not re.search(pattern, plain) or re.search(rf"\b({barred})\b", plain):
                continue
            unit = _unit(column, dimension)
            if unit is not None and _fits(key, column):
                found.append((rank, column, unit))
    best: dict[int, tuple[SeenColumn, str]] = {}
    for _, column, unit in found:
        best.setdefault(column.number, (column, unit))
    return list(best.values())


def _label(column: SeenColumn) -> str:
    return toml_text(column.name.strip()) if column.name else str(column.number)


def _reference(column: SeenColumn, columns: Sequence[SeenColumn]) -> str:
    """The column's name where it is the only one of that name, else its number."""
    names = [other.name.strip() for other in columns if other.is_named]
    return _label(column) if names.count(column.name.strip()) == 1 else str(column.number)


def _line(key: str, column: str, unit: str, *, is_commented: bool = False) -> str:
    datum = f', datum = "{UNKNOWN}"' if key == "crosshead_position" else ""
    text = f"{key} = {{ column = {column}, unit = {toml_text(unit)}{datum} }}"
    if datum:
        text += "\n# datum: pin-to-pin, or displacement with a reference_length"
    return f"# {text}" if is_commented else text


def propose_channels(columns: Sequence[SeenColumn]) -> Proposal:
    """Lines of a layout's ``channels`` table for the columns of a log."""
    lines: list[str] = []
    keys: list[str] = []
    remarks: list[str] = []
    used: set[int] = set()
    first = columns[0] if columns and not any(column.name for column in columns) else None
    if first is not None and first.values.size > 1 and np.all(np.diff(first.values) > 0):
        unit = _unit(first, "time") or UNKNOWN
        lines.append(_line("time", "1", unit))
        keys.append("time")
        used.add(1)
        remarks.append("guess: time is column 1, because it rises all the time")
        if unit == UNKNOWN:
            remarks.append("unknown: the unit of column 1")
    for key in _NAMES:
        candidates = [c for c in _candidates(key, columns) if c[0].number not in used]
        if not candidates:
            continue
        taken = sorted(candidates, key=lambda c: c[0].number) if key in _MANY else candidates[:1]
        for place, (column, unit) in enumerate(taken, start=1):
            full = f"{key}.{place}" if key in _MANY else key
            if key == "time" and unit == UNKNOWN and _is_clock(column):
                unit = CLOCK
            lines.append(_line(full, _reference(column, columns), unit))
            keys.append(full)
            used.add(column.number)
            remarks.append(f"guess: {full} is column {_label(column)}, by its name")
            if key == "time" and np.any(np.diff(column.values) < 0):
                remarks.append("sure: time goes back at least once")
            if unit == UNKNOWN:
                remarks.append(f"unknown: the unit of column {_label(column)}")
        others = [_label(column) for column, _ in candidates if column.number not in used]
        if others:
            remarks.append(f"guess: {key} may also be column {', '.join(others)}")
    if "crosshead_position" in keys:
        remarks.append("unknown: whether the position is pin-to-pin or a displacement (datum)")
    if any(key == "tension.2" for key in keys):
        remarks.append("guess: each load column is one position of a specimen, in file order")
    is_blind = not {"crosshead_position", "tension.1"} & set(keys)
    for key in ("crosshead_position", "tension.1"):
        if key not in keys:
            lines.append(
                _line(key, f'"{UNKNOWN}"', UNKNOWN, is_commented=not is_blind or bool(keys[1:]))
            )
            remarks.append(f"unknown: which column is {key}, if one is")
    lines += [
        f"# not used: column {column.number}{_described(column)}"
        for column in columns
        if column.number not in used
    ]
    return Proposal(tuple(lines), tuple(keys), tuple(remarks))


def _described(column: SeenColumn) -> str:
    name = f", {_label(column)}" if column.name else ""
    unit = f" in {toml_comment(column.unit)}" if column.unit.strip() else ""
    values = column.values[np.isfinite(column.values)]
    seen = f", {values.min():g} to {values.max():g} at the start" if values.size else ""
    return f"{name}{unit}{seen}"
