"""Matches the columns of an unknown log to channels by names, units and values.

The result is for a person to confirm, so that a wrong guess costs a check, not a wrong number.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from reduction.quantities.units import DIMENSIONS, Dimension, scale_to_si
from reduction.readers.columns import (
    CLOCK_TEXT,
    FORCE_OF_MASS,
    UNIT_BEHIND_NAME,
    orders_of_dates,
    plain_date,
    stated_scale,
)
from reduction.readers.layout import CLOCK, UNKNOWN
from reduction.record.arrays import MAD_TO_DEVIATION
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats
from reduction.record.plain_text import toml_comment, toml_text
from reduction.stages.cycles.reversals import find_reversals

_NOT_MEASURED = (
    r"sollwert|set ?point|command|cmd|target|maximum|minimum|max|min|rate|speed|velocity|"
    r"geschwindigkeit|consigne|peak|valley|目标|指令"
)

_ELONGATION = (  # a position if stated in a unit of length, else a strain
    r"elongation|allongement|alargamiento|allungamento|verlängerung|dehnung|伸长|伸び|伸長|удлинение"
)

_FORCE = (
    r"load|force|tension|kraft|zuglast|^last$|weight|gewicht|effort|\bcharge\b|fuerza|\bcarga\b|"
    r"forza|carico|kracht|siła|obciążenie|\bforc\b|^f$|力|荷重|载荷|載荷|负荷|負荷|하중|усилие|нагрузка|сила"
)

_LENGTH = (
    r"\bweg\b|weg$|extensi[oó]n|displace?ment|\bdisp\b|^disp|verschiebung|d[eé]placement|chemin|"
    r"\bcourse\b|przemieszczenie|desplazamiento|carrera|recorrido|corsa|spostamento|verplaatsing|位移|變位|変位|"
    r"变形|変形|변위|перемещение"
)

# ranked: the first pattern that matches a column wins; the second text excludes a column
_NAMES: dict[str, tuple[Dimension, tuple[str, ...], str]] = {
    "time": (
        "time",
        (r"^(elapsed|test|total|run|running)? ?time$",
         r"^(gesamt|lauf|prüf|pruef|mess|versuchs)?zeit$", r"^time\b", r"\b(time|zeit)$",
         r"\b(zeit|temps|tiempo|tempo|tijd|czas|время)\b|時間|时间|"
         r"시간|uhrzeit|time ?stamp", r"^t(out)?$", r"^wf increment$|^x value$"),
        r"cycle|date|datum|start",
    ),
    "crosshead_position": (
        "length",
        (r"crosshead|traverse|横梁|クロスヘッド", r"actuator|kolben|ram\b",
         r"^position|^pos$", _LENGTH,
         r"stroke|ストローク|行程|행정|tool separation|einspannlänge",
         r"grip.to.grip|\b(grip|jaw|clamp) separation", r"\btravel\b",
         r"\bposition\b|\bpos\b",
         r"^machine$|^maschine$", _ELONGATION, r"\bdist(ance)?\b", r"^[xl]$"),
        _NOT_MEASURED,
    ),
    "tension": (
        "force",
        (_FORCE,),
        _NOT_MEASURED + r"|friction|pct|percent|mbl|mbs|rbs|dehnung|stress|应力|應力|応力|spannung",
    ),
    "strain": (
        "strain",
        (r"strain|extensometer|odkształcenie|d[eé]formation|deformaci[oó]n|应变|應變|ひずみ|歪|변형률|"
         r"деформация|" + _ELONGATION,),
        _NOT_MEASURED + "|true",
    ),
    "cycle_counter": (
        "number",
        (r"^total cycles$|^gesamtzyklen$",
         r"^(cycle|zyklus|zyklen|lastspiele?)( number| count(er)?)?$",
         r"^total cycle count$", r"^cycles$",
         r"^(machine )?(n|no|nr|num|number)( of)? cycles?$", r"^cycles? (no|nr|num|index|id|n)$"),
        r"elapsed|time",
    ),
    "temperature": ("temperature", (r"^temp(erature?|eratur)?\b",), _NOT_MEASURED),
}  # fmt: skip

FOREIGN_WORDS = re.compile(
    r"[時时]間|时间|시간|[位変變变]移|[変變变][位形]|변위|荷重|[试試][験驗验]|[载載负負]荷|[拉张張]?力|하중|"
    r"ストローク|ひずみ|伸[长長び]|毫米|время|перемещение|нагрузка|усилие|деформация|удлинение|"
    r"prüf|länge|für\b|déplacement|force|é\w+\b|ó\w\b|siła|obciążeni|odkształceni|prób[ek]",
    re.IGNORECASE,
)
"""Words of logs that only the right character encoding decodes."""

_MANY = ("tension", "strain")  # one per specimen

_SUFFIXES = {
    "s": "s", "sec": "s", "ms": "ms", "min": "min", "ft": "ft", "in": "inch", "mm": "mm",
    "cm": "cm", "m": "m", "lb": "lbf", "lbs": "lbf", "lbf": "lbf", "kip": "kip", "n": "N",
    "kn": "kN", "kgf": "kgf", "pct": "%", "percent": "%", "degc": "degC", "degf": "degF",
}  # fmt: skip

_BRACKETED = re.compile(r"\s*[\(\[]([^()\[\]]*)[\)\]]\s*$")

_FOUR_DIGITS = re.compile(r"([01]\d|2[0-3])[0-5]\d")

_RISING = 0.9  # minimum share of steps in a time column that do not go back

_SAME = 1 - 1e-6  # correlation above which two columns are one signal


@dataclass(frozen=True)
class SeenColumn:
    """A column as sampled: ``texts`` and ``values`` (NaN if not a number) of some rows."""

    number: int
    name: str = ""
    unit: str = ""
    values: Floats = field(default_factory=lambda: np.empty(0))
    texts: tuple[str, ...] = ()
    is_named: bool = True


@dataclass(frozen=True)
class _Proposal:
    """Channels as lines of TOML, whether any was found, the guesses among them, kind of test."""

    lines: tuple[str, ...]
    keys: tuple[str, ...]
    remarks: tuple[str, ...]
    kind: str


_EXTREME = re.compile(r"\b(max|min|maximum|minimum|peak|valley)\b", re.IGNORECASE)

_RESULT = re.compile(
    r"\b(storage|loss|speicher|verlust)|\btan[\W_]*(delta|δ)|\bphase\b|^\W*[EG]['\"*]",
    re.IGNORECASE,
)
"""Names of what a machine computes from the cycles at one frequency or temperature."""


@lru_cache(maxsize=4096)
def is_unit(text: str, dimension: Dimension | None = None) -> bool:
    """Whether a text is a unit of one dimension, or of any."""
    if not text:
        return False
    for wanted in (dimension,) if dimension is not None else DIMENSIONS:
        try:
            stated_scale(text, wanted)
        except SettingsError:
            continue
        return True
    return False


def _one_width(text: str) -> str:
    """A text with full-width East Asian letters and brackets replaced by narrow ones."""
    return unicodedata.normalize("NFKC", text).strip()


def _plain(name: str) -> str:
    """A name in lower case, without its unit, with words separated by blanks."""
    text = _BRACKETED.sub("", _one_width(name)).strip()
    words = [word for word in re.split(r"[\W_]+", text.lower()) if word]
    if len(words) > 1 and words[-1] in _SUFFIXES:
        words.pop()
    return " ".join(words)


def _stated_units(column: SeenColumn) -> list[str]:
    """Texts that may be the unit of a column: in a unit row, in brackets, after its name."""
    name = _one_width(column.name)
    found = [column.unit.strip().strip("()[]").strip()]
    if bracketed := _BRACKETED.search(name):
        found.append(bracketed[1].strip())
    elif behind := UNIT_BEHIND_NAME.match(name):
        found.append(behind[1])
    else:
        *stem, suffix = re.split(r"[\s_.,/]+", name)
        unit = _SUFFIXES.get(suffix.lower(), suffix if is_unit(suffix) else "")
        found.append(unit if stem else "")
    return [text for text in found if text and text != "-"]


def _unit(column: SeenColumn, dimension: Dimension) -> str | None:
    """Unit stated by a column; ``?`` if it states none, None if it has another dimension."""
    for text in _stated_units(column):
        if text.startswith("%") and dimension != "strain":  # percent of a break strength
            return None
        if dimension == "force" and text in ("lb", "lbs", *FORCE_OF_MASS):
            return FORCE_OF_MASS.get(text, "lbf")
        if is_unit(text, dimension):
            return text
        if is_unit(text):
            return None
    if dimension == "time" and _plain(column.name) == "x value":  # written by LabVIEW
        return "s"
    return "1" if dimension == "number" else UNKNOWN


def _is_clock(column: SeenColumn) -> bool:
    """Whether all texts are clock times; four digits only if one begins with 0."""
    order = (orders_of_dates(column.texts) or (None,))[0]
    texts = [plain_date(text, order) for text in column.texts if text]
    return (
        bool(texts)
        and all(
            (CLOCK_TEXT if ":" in text else _FOUR_DIGITS).fullmatch(text) is not None
            for text in texts
        )
        and any(":" in text or text.startswith("0") for text in texts)
    )


def _fits(key: str, column: SeenColumn) -> bool:
    """Whether the values are possible for a channel."""
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
            if key == "strain" and _is_of_travel(column.name):
                continue
            unit = _unit(column, dimension)
            if unit == UNKNOWN and (
                (pattern == _ELONGATION and key == "crosshead_position")
                # "Actuator Force": a word for a position beside one for a force
                or (key == "crosshead_position" and _is_of_force(plain))
            ):
                continue
            if unit is not None and _fits(key, column):
                found.append((rank, column, unit))
    if any(unit != UNKNOWN for _, _, unit in found):  # a stated text is not a unit
        found = [one for one in found if one[2] != UNKNOWN or not _stated_units(one[1])]
    # a machine's own coordinate is far from any specimen; its travel begins with the test.  A
    # digital position repeats the position, but some logs have no other
    found.sort(key=lambda one: re.search("absol|digital", _plain(one[1].name)) is not None)
    best: dict[int, tuple[SeenColumn, str]] = {}
    for _, column, unit in found:
        best.setdefault(column.number, (column, unit))
    return list(best.values())


def _is_of_travel(name: str) -> bool:
    """Whether a strain is one that the machine calculates: ``Tensile strain (Extension)``."""
    return any(
        re.search(_LENGTH, text.lower()) for text in re.findall(r"\((.*?)\)", _one_width(name))
    )


def _is_of_force(plain: str) -> bool:
    return bool(re.search(_FORCE, plain)) and not re.search(_LENGTH, plain)


def _by_unit(key: str, columns: Sequence[SeenColumn]) -> list[tuple[SeenColumn, str]]:
    """The column that states a unit of a channel's dimension, if it is the only one."""
    dimension, _, barred = _NAMES[key]
    found = []
    for column in columns:
        unit = _unit(column, dimension)
        plain = _plain(column.name)
        is_other = any(re.search(word, plain) for _, words, _ in _NAMES.values() for word in words)
        is_barred = re.search(rf"\b({barred})\b", plain) is not None
        if unit not in (None, UNKNOWN) and not (is_other or is_barred) and _fits(key, column):
            found.append((column, str(unit)))
    return found if len(found) == 1 else []


def _label(column: SeenColumn) -> str:
    return toml_text(column.name.strip()) if column.name else str(column.number)


def _reference(column: SeenColumn, columns: Sequence[SeenColumn]) -> str:
    """The column's name if it is unique, else its number."""
    names = [other.name.strip() for other in columns if other.is_named]
    return _label(column) if names.count(column.name.strip()) == 1 else str(column.number)


def _line(key: str, column: str, unit: str, more: str = "") -> str:
    return f"{key} = {{ column = {column}, unit = {toml_text(unit)}{more} }}"


def _date_order(column: SeenColumn) -> tuple[str, list[str]]:
    """Order of day and month in a date, as TOML, with the reasons."""
    orders = orders_of_dates(column.texts)
    if orders is None:
        return "", []
    if len(orders) == 1:
        return f', date_order = "{orders[0]}"', [
            f"sure: dates are {orders[0]}: in the other order some do not exist"
        ]
    return f', date_order = "{UNKNOWN}"', [
        'unknown: whether dates are "month first" or "day first" (date_order)'
    ]


def _without_repeats(
    taken: list[tuple[SeenColumn, str]],
) -> tuple[list[tuple[SeenColumn, str]], list[str]]:
    """Columns without repeats of another column in another unit, with remarks."""
    kept: list[tuple[SeenColumn, str]] = []
    remarks = []
    for column, unit in taken:
        same = next((one for one, _ in kept if _are_one_signal(one, column)), None)
        if same is None:
            kept.append((column, unit))
        else:
            remarks.append(
                f"guess: column {_label(column)} repeats column {_label(same)}, and is not used"
                + _disagreement(column, same, unit)
            )
    return kept, remarks


_DISAGREE = 0.01  # of the range: maximum difference of two readings of one signal without a remark


def _disagreement(column: SeenColumn, same: SeenColumn, unit: str) -> str:
    """Difference between two columns of one signal that have the same unit."""
    is_known = np.isfinite(column.values) & np.isfinite(same.values)
    if unit == UNKNOWN or column.unit != same.unit:
        return ""
    one, other = same.values[is_known], column.values[is_known]
    factor, away = np.polyfit(one, other, 1)
    said = [f"is {factor:.4g} times as great"] if abs(factor - 1) > _DISAGREE else []
    if abs(away) > _DISAGREE * np.ptp(one):
        said.append(f"reads {away:.4g} {unit} where that reads 0")
    return f": it {' and '.join(said)}, so find out which one is right" if said else ""


def _are_one_signal(one: SeenColumn, other: SeenColumn) -> bool:
    is_known = np.isfinite(one.values) & np.isfinite(other.values)
    if one.values.size != other.values.size or np.count_nonzero(is_known) < 10:
        return False
    a, b = one.values[is_known], other.values[is_known]
    if not (np.std(a) > 0 and np.std(b) > 0):
        return False
    return bool(np.corrcoef(a, b)[0, 1] > _SAME)


def _side_by_side(columns: Sequence[SeenColumn]) -> int:
    """Number of tests side by side in a table, each with its own time column.

    Examples
    --------
    >>> names = ["Time", "Force", "Stroke"] * 2
    >>> _side_by_side([SeenColumn(k + 1, name) for k, name in enumerate(names)])
    2
    """
    names = [_plain(column.name) for column in columns]
    is_time = [any(re.search(word, name) for word in _NAMES["time"][1]) for name in names]
    n_tests = names.count(names[is_time.index(True)]) if any(is_time) else 1
    width = len(names) // n_tests
    return n_tests if width > 1 and names == names[:width] * n_tests else 1


def _rises(column: SeenColumn) -> bool:
    """Whether values are above those before, except where a clock was set."""
    steps = np.diff(column.values)
    return steps.size > 0 and bool(np.mean(steps > 0) >= 1 - _CLOCK_SET)


_CLOCK_SET = 1e-3  # of the steps of a column without a name that rises otherwise


_FEW_COLUMNS = 2  # of load and extension, the extension rises all the time in a pull


def propose_channels_table(columns: Sequence[SeenColumn]) -> _Proposal:
    """Lines of a layout's ``channels`` table for the columns of a log."""
    seen, n_tests = columns, _side_by_side(columns)
    remarks: list[str] = []
    if n_tests > 1:
        columns = columns[: len(columns) // n_tests]
        remarks.append(
            f"guess: {n_tests} tests are side by side: this layout is for the first, columns 1 to"
            f" {len(columns)}; each of the others needs a layout with its own columns"
        )
    chosen, of_choice = _choose_columns(columns)
    lines, of_lines = _lines_of_channels(chosen, seen)
    remarks += of_choice + of_lines
    if "tension.2" in chosen:
        remarks.append("guess: each load column is one position of a specimen, in file order")
    is_blind = not {"crosshead_position", "tension.1"} & set(chosen)
    for key, more in (("crosshead_position", f', datum = "{UNKNOWN}"'), ("tension.1", "")):
        if key not in chosen:
            text = _line(key, f'"{UNKNOWN}"', UNKNOWN, more)
            is_commented = not is_blind or len(chosen) > 1
            lines.append(f"# {text}" if is_commented else text)
            remarks.append(f"unknown: which column is {key}, if one is")
    extremes = [column for column in columns if _EXTREME.search(column.name)]
    results = [column for column in columns if _RESULT.search(column.name)]
    are_extremes = len(extremes) > 1 and all(
        _EXTREME.search(column.name)
        for key, (column, _) in chosen.items()
        if key == "crosshead_position" or key.startswith("tension.")
    )
    for is_table, named, of in (
        (are_extremes, extremes, "extremes of each cycle"),
        (len(results) > 1, results, "results of each frequency or temperature"),
    ):
        if is_table:
            remarks.append(
                f"guess: by their names, {_label(named[0])} and {_label(named[1])} are {of}: such a"
                " table has no loops, so use the log of the readings"
            )
    used = {column.number for column, _ in chosen.values()}
    lines += [
        f"# not used: column {column.number}{_described(column)}"
        for column in seen
        if column.number not in used
    ]
    kind = ""
    if "crosshead_position" in chosen and not are_extremes and len(results) < 2:
        kind = _kind_of(chosen["crosshead_position"][0].values)
    return _Proposal(tuple(lines), tuple(chosen), tuple(remarks), kind)


def _kind_of(position: Floats) -> str:
    """Kind of a test whose position moves one way, or goes to one length and stands; else empty.

    Examples
    --------
    >>> pull = np.linspace(0.0, 10.0, 100)
    >>> _kind_of(pull), _kind_of(np.append(pull, np.full(300, 10.0)))
    ('tensile', 'relaxation')
    >>> _kind_of(np.tile(np.append(pull, pull[::-1]), 3))
    ''
    """
    known = position[np.isfinite(position)]
    if known.size < _LEAST_OF_PULL or not np.ptp(known):
        return ""
    turns = known[find_reversals(known, band=_TURN * float(np.ptp(known)))]
    if not 2 <= turns.size <= 3:  # a move out, or out and back
        return ""
    stands = np.abs(known - turns[1]) <= _STANDS * np.ptp(known)
    if np.mean(stands) > _MOSTLY:
        return "relaxation"
    lag = max(known.size // _PARTS, 1)
    moved = np.abs(known[lag:] - known[:-lag])
    pauses = np.mean(moved < _SLOW * moved.mean()) > _PAUSES
    return "tensile" if turns.size == 2 and not pauses else ""


_LEAST_OF_PULL = 10  # readings

_PARTS, _SLOW, _PAUSES = 50, 0.2, 0.4  # a part of a log is a pause below a fifth of the mean rate

_TURN, _STANDS = 0.05, 0.01  # of the range

_MOSTLY = 0.5  # of the rows


def _choose_columns(
    columns: Sequence[SeenColumn],
) -> tuple[dict[str, tuple[SeenColumn, str]], list[str]]:
    """Column and unit of each channel, by name or by unit, with the reasons."""
    chosen: dict[str, tuple[SeenColumn, str]] = {}
    remarks: list[str] = []
    used: set[int] = set()
    rising = [] if any(one.name for one in columns) else [*filter(_rises, columns)]
    if rising and (rising[0].number == 1 or (len(rising) == 1 and len(columns) > _FEW_COLUMNS)):
        unit = _unit(rising[0], "time") or UNKNOWN
        chosen["time"] = rising[0], unit
        used.add(rising[0].number)
        remarks.append(f"guess: time is column {rising[0].number}, because it rises all the time")
        if unit == UNKNOWN:
            remarks.append(f"unknown: the unit of column {rising[0].number}")
    elif len(rising) > 1:
        numbers = ", ".join(str(column.number) for column in rising)
        remarks.append(
            f"unknown: columns {numbers} rise all the time: one of them is time, or each is the"
            " time of a channel (time_column)"
        )
    for key in _NAMES:
        if key in chosen:
            continue
        candidates = [c for c in _candidates(key, columns) if c[0].number not in used]
        if key == "temperature":  # not used in any result, so not worth a question
            candidates = [c for c in candidates if c[1] != UNKNOWN]
        why = "by its name"
        if not candidates and key in ("time", "crosshead_position", "tension"):
            free = [c for c in columns if c.number not in used]
            candidates = _by_unit(key, free)
            why = f"the only one in a unit of {_NAMES[key][0]}"
            clocks = [(c, CLOCK) for c in free if _is_clock(c) and ":" in "".join(c.texts[:1])]
            if key == "time" and not candidates and len(clocks) == 1:
                candidates, why = clocks, "the only one of times of day"
        if not candidates:
            continue
        taken = candidates[:1]
        if key in _MANY:
            taken, repeated = _without_repeats(sorted(candidates, key=lambda c: c[0].number))
            remarks += repeated
            n_loads = sum(name.startswith("tension.") for name in chosen)
            if key == "strain" and n_loads:  # one per specimen, like the loads
                taken = taken[:n_loads]
        for place, (column, unit) in enumerate(taken, start=1):
            full = f"{key}.{place}" if key in _MANY else key
            if key == "time" and unit == UNKNOWN and _is_clock(column):
                unit = CLOCK
            chosen[full] = column, unit
            used.add(column.number)
            remarks.append(f"guess: {full} is column {_label(column)}, {why}")
            if key == "time" and np.any(np.diff(column.values) < 0):
                remarks.append("sure: time goes back at least once")
            if unit == UNKNOWN:
                remarks.append(f"unknown: the unit of column {_label(column)}")
        others = [_label(column) for column, _ in candidates if column.number not in used]
        if others and key not in _MANY:
            remarks.append(f"guess: {key} may also be column {', '.join(others)}")
    return chosen, remarks


def _lines_of_channels(
    chosen: dict[str, tuple[SeenColumn, str]], seen: Sequence[SeenColumn]
) -> tuple[list[str], list[str]]:
    """One line of the table for each chosen channel, with the reasons for its settings."""
    lines: list[str] = []
    remarks: list[str] = []
    start = _Start.of(chosen)
    for key, (column, unit) in chosen.items():
        more, said = start.settings(key, unit) if start is not None else ("", [])
        if unit == CLOCK:
            more, said = _date_order(column)
        if key == "crosshead_position" and not more:
            more, said = f', datum = "{UNKNOWN}"', ["unknown: whether the position is pin-to-pin or"
                                                   " a displacement (datum)"]  # fmt: skip
        lines.append(_line(key, _reference(column, seen), unit, more))
        remarks += said
        if key == "crosshead_position":
            lines.append("# datum: pin-to-pin, or displacement with a reference_length, the length"
                         " from pin to pin where it reads 0")  # fmt: skip
    return lines, remarks


_STILL = 0.01  # of the sampled range of a channel: smaller movement is rest

_LEAST_REST = 5  # samples

_TOLD = 0.005  # of the sampled range of a load: smallest reading at rest that is reported

_EXACT = 0.0002  # the same: standard uncertainty up to which such a reading is taken as the zero

_OF_MEDIAN = 1.25  # standard error of a median over that of a mean

_NOISE = 5.0  # standard deviations

_FAR, _MANY_VALUES = 12.0, 10  # minimum range over the scatter of its steps, and number of values

_OPPOSED = -0.7  # correlation of load and position below which one sign is wrong


@dataclass(frozen=True)
class _Start:
    """Start of a log: its first rest, or its first sample if it has no rest."""

    n_samples: int
    words: str
    position: Floats
    loads: dict[str, Floats]
    strains: dict[str, Floats]

    @classmethod
    def of(cls, chosen: dict[str, tuple[SeenColumn, str]]) -> _Start | None:
        """The first rest of position and loads; None if nothing moves or a channel is empty."""
        if "crosshead_position" not in chosen:
            return None
        position = _without_blanks(chosen["crosshead_position"][0].values)
        loads = {
            key: _without_blanks(one.values)
            for key, (one, _) in chosen.items()
            if key.startswith("tension.")
        }
        strains = {
            key: _without_blanks(one.values)
            for key, (one, _) in chosen.items()
            if key.startswith("strain.")
        }
        channels = np.array([position, *loads.values()])
        if not np.isfinite(channels).all() or not _has_moved(position):
            return None
        away = np.abs(channels - np.median(channels[:, :_LEAST_REST], axis=1)[:, None])
        # in steps of two readings, which the motion of a ramp hardly widens
        noise = (
            MAD_TO_DEVIATION * np.median(np.abs(np.diff(channels, n=2, axis=1)), axis=1) / 6**0.5
        )
        still = np.maximum(_STILL * np.ptp(channels, axis=1), _NOISE * noise)
        # a load that is only noise has no range to compare with
        moves = np.flatnonzero(np.any(away > still[:, None], axis=0))
        n_samples = _still_samples(channels, int(moves[0]))
        words = f"the first {n_samples} samples"
        time, unit = chosen.get("time", (None, UNKNOWN))
        if time is not None and unit not in (UNKNOWN, CLOCK) and n_samples:
            words += f", {time.values[n_samples - 1] - time.values[0]:.3g} {unit}"
        return cls(n_samples, words, position, loads, strains)

    def settings(self, key: str, unit: str) -> tuple[str, list[str]]:
        """Settings of a channel from the start of the log, as TOML, with the reasons."""
        if key == "crosshead_position":
            sign, said = self._sign(key)
            datum, more = self._datum(unit, -1 if sign else 1)
            return sign + datum, said + more
        if key in self.strains:
            return self._sign_of_strain(key)
        if key not in self.loads:
            return "", []
        sign, said = self._sign(key)
        zero, more = self._zero(key, unit) if self.n_samples >= _LEAST_REST else ("", [])
        return sign + zero, said + more

    def _sign(self, key: str) -> tuple[str, list[str]]:
        """Sign reversal of a channel if tension would otherwise fall as the specimen stretches."""
        for load in self.loads.values() if key == "crosshead_position" else [self.loads[key]]:
            if not self._opposes(load):
                return "", []
            is_pulled = abs(float(load.max())) > abs(float(load.min()))
            if is_pulled == (key != "crosshead_position"):
                return "", []  # the sign belongs to the other one
        if not self.loads:
            return "", []
        end = "above" if key == "crosshead_position" else "below"
        return ", sign = -1", [
            f"guess: sign of {key}: the load falls as the position rises, and lies {end} 0"
        ]

    def _opposes(self, load: Floats) -> bool:
        """Whether a load falls as the position rises; of a pull, on the way to its greatest load.

        Behind it a pull that breaks slowly carries less and less over most of its travel.
        """
        place = self.position
        peak = int(np.argmax(np.abs(load - load[0]))) + 1
        if peak >= _LEAST_OF_PULL and _kind_of(place) == "tensile":
            place, load = place[:peak], load[:peak]
        return bool(np.ptp(load) > 0 and np.corrcoef(place, load)[0, 1] < _OPPOSED)

    def _sign_of_strain(self, key: str) -> tuple[str, list[str]]:
        """Sign reversal of a strain that falls as the position rises, once this has its sign."""
        position = -self.position if self._sign("crosshead_position")[0] else self.position
        strain = self.strains[key]
        if not np.ptp(strain) > 0 or not np.corrcoef(position, strain)[0, 1] < _OPPOSED:
            return "", []
        # a clip gauge that is taken off in the test falls at once, and rises before
        if np.median(np.diff(position) * np.diff(strain)) > 0:
            return "", []
        return ", sign = -1", [
            f"guess: sign of {key}: it falls as the position, with its own sign, rises"
        ]

    def _datum(self, unit: str, sign: int) -> tuple[str, list[str]]:
        position = sign * self.position
        begin, travel = float(position[0]) + 0.0, float(np.ptp(position))  # no "-0"
        seen = f"the position begins at {begin:g} {unit} and travels {travel:g} {unit} at the start"
        # a pin-to-pin length is positive, and in most tests above a quarter of the travel; a
        # specimen that is already taut begins at a few millimetres of displacement
        is_length = unit == UNKNOWN or begin * scale_to_si(unit, "length")[0] > _SHORTEST_SPECIMEN
        if is_length and begin > 0.25 * travel and float(position.min()) > 0.1 * travel:
            return ', datum = "pin-to-pin"', [
                f"guess: datum pin-to-pin, because {seen}: a displacement would begin near 0"
            ]
        return f', datum = "displacement", reference_length = "{UNKNOWN}"', [
            f"guess: datum displacement, because {seen}",
            "unknown: reference_length, the length from pin to pin where the position reads 0",
        ]

    def _zero(self, key: str, unit: str) -> tuple[str, list[str]]:
        load = self.loads[key]
        rest = load[: self.n_samples]
        reading = float(np.median(rest))
        # the first readings of a slow ramp scatter too, and move no median
        scatter = MAD_TO_DEVIATION * float(np.median(np.abs(rest - reading)))
        spread = _OF_MEDIAN * scatter / math.sqrt(rest.size)
        shown = f'"{_round(reading, scatter)} {unit}"'
        at_rest = f"in the first rest ({self.words}) {key} reads {shown}"
        if abs(reading) <= 4 * spread:
            return "", [f"guess: no zero is needed: {at_rest}, which is within its noise"]
        if abs(reading) <= _TOLD * float(np.ptp(load)):
            return "", [
                f"guess: no zero is written: {at_rest}, less than {100 * _TOLD:g} % of the range of"
                f" the load; if the specimen was slack there, zero = {shown} is more accurate"
            ]
        is_pulled = reading < 0 and load.max() > -load.min()
        if is_pulled and spread <= _EXACT * float(np.ptp(load)):
            return f", zero = {shown}", [
                f"guess: zero {shown}: {at_rest}, and a slack line cannot push"
            ]
        return f', zero = "{UNKNOWN}"', [
            f"unknown: zero: {at_rest}: that is the zero if the specimen was slack there (then its"
            f' noise is offset = "{spread:.2g} {unit}" in [uncertainty.tension])'
            + ("" if is_pulled else f', and "0 {unit}" if it was under load')
        ]


_SHORTEST_SPECIMEN = 5e-3  # from pin to pin [m]


def _without_blanks(values: Floats) -> Floats:
    """Values interpolated linearly across missing ones; unchanged if most are missing."""
    known = np.isfinite(values)
    if known.all() or np.count_nonzero(known) < max(_MANY_VALUES, values.size / 10):
        return values
    rows = np.arange(values.size)
    return np.interp(rows, rows[known], values[known])


def _still_samples(channels: Floats, n_samples: int) -> int:
    """Number of first samples at rest; none if they are the start of a ramp."""
    half = n_samples // 2
    if not half:
        return 0
    drift = np.abs(channels[:, :half].mean(axis=1) - channels[:, half:n_samples].mean(axis=1))
    return 0 if np.any(drift > _STILL / 4 * np.ptp(channels, axis=1)) else n_samples


def _has_moved(position: Floats) -> bool:
    """Whether a position has left its first rest; noise and converter steps do not count."""
    if np.unique(position).size <= _MANY_VALUES:
        return False
    return bool(np.ptp(position) > _FAR * np.std(np.diff(position)))


def _round(value: float, scatter: float) -> str:
    """A mean rounded to the digits that its scatter justifies."""
    share = scatter / abs(value) if value else 0.0
    digits = max(2, min(6, 2 - math.floor(math.log10(share)))) if share else 4
    return f"{value:.{digits}g}"


def _described(column: SeenColumn) -> str:
    name = f", {_label(column)}" if column.name else ""
    unit = f" in {toml_comment(column.unit)}" if column.unit.strip() else ""
    values = column.values[np.isfinite(column.values)] + 0.0  # no "-0"
    seen = f", {values.min():g} to {values.max():g} at the start" if values.size else ""
    return f"{name}{unit}{seen}"
