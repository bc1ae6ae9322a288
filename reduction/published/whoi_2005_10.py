"""Recomputation of every printed number of WHOI-2005-10."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from reduction.published.printed_cells import Cell, cells_of, number_of, printed_step
from reduction.published.published_lines import TETHER_REPORT, published_static_test
from reduction.published.reproduced_item import (
    Key,
    ReproducedItem,
    agree,
    compared_item,
    judge,
    judge_limit,
    judge_repeat,
    judge_round,
    measured_item,
)
from reduction.quantities.units import scale_to_si
from reduction.stages.moduli.secant_modulus import chord_modulus
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.strain.strain_model import free_length_fraction, free_length_strain
from reduction.stages.strain.stress import constant_volume_diameter


def _number_in_use(cell: Cell) -> float:
    """Number of a cell as corrected, or as printed where it is open; NaN where there is none."""
    value = number_of(cell.printed) if cell.value is None else cell.value
    return float("nan") if value is None else value


@dataclass(frozen=True)
class _Row:
    """One row of a table; indexed by column it gives the number in use."""

    name: str
    cells: dict[str, Cell]

    def __getitem__(self, column: str) -> float:
        """Number of one column."""
        return _number_in_use(self.cells[column])

    @property
    def tether(self) -> str:
        """Tether of the row, one of two."""
        return "new" if "tether new" in self.name else "used"

    @property
    def branch(self) -> str:
        """Branch of the static test."""
        return "descending" if "descending" in self.name else "ascending"


def _rows_of(cells: Sequence[Cell]) -> list[_Row]:
    """Rows of one table, in the order of the page."""
    rows: dict[str, dict[str, Cell]] = {}
    for cell in cells:
        rows.setdefault(cell.row, {})[cell.column] = cell
    return [_Row(name, columns) for name, columns in rows.items()]


_PART = {
    "splice_fraction near": "splice_length near",
    "free_fraction": "free_length",
    "splice_fraction far": "splice_length far",
}

_STRETCHED = "measured at three places of the tether; {:.3f} in at constant volume"

_TIMES = "time of a reading, later than the one before"


def _items_of_diameters(
    cells: Sequence[Cell], areas: Mapping[str, Sequence[float]]
) -> Iterator[ReproducedItem]:
    """Table 2."""
    for row in _rows_of(cells):
        implied = areas[row.tether]
        before = float(np.mean([sqrt(4 * area / pi) for area in implied]))
        for column, cell in row.cells.items():
            if column == "diameter":
                how = "round section of the areas that the rows of Tables 5 and 6 share, "
                yield judge(cell, before, how + " and ".join(f"{one:.4f}" for one in implied))
            else:
                strain = float(column.split()[2]) / 100
                stretched = before / constant_volume_diameter([strain], [1.0])[0]
                yield measured_item(cell, _STRETCHED.format(stretched))


def _items_of_marks(cells: Sequence[Cell]) -> Iterator[ReproducedItem]:
    """Table 3."""
    rows = _rows_of(cells)
    for row in rows:
        own = [one for one in rows if one.tether == row.tether and "far_thimble" in one.cells]
        stretched = own[1:]
        for column, cell in row.cells.items():
            if "far_thimble" not in row.cells:
                share = [100 * one[_PART[column]] / one["far_thimble"] for one in stretched]
                yield judge(cell, float(np.mean(share)), "mean of the three stretched rows")
            else:
                yield judge(cell, *_mark(column, row, own, stretched))


def _mark(
    column: str, row: _Row, own: Sequence[_Row], stretched: Sequence[_Row]
) -> tuple[float, str]:
    if column in _PART:
        return 100 * row[_PART[column]] / row["far_thimble"], "share of the far thimble's position"
    slack = own[0]["free_length"]
    match column:
        case "target_strain":
            others = [one for one in stretched if one is not row]
            line = np.polynomial.Polynomial.fit(
                [one["far_thimble"] for one in others], [one[column] for one in others], 1
            )
            return float(line(row["far_thimble"])), "line of stretch on position, other rows"
        case "near_toe":
            return row["splice_length near"], "the near splice, printed again"
        case "far_toe":
            return row["near_toe"] + row["free_length"], "near toe and free length"
        case "far_thimble":
            return row["far_toe"] + row["splice_length far"], "far toe and far splice"
        case "splice_length near":
            return row["near_toe"], "the near toe, printed again"
        case "free_length":
            return row["far_toe"] - row["near_toe"], "difference of the marks"
        case "splice_length far":
            return row["far_thimble"] - row["far_toe"], "difference of the marks"
        case "mark_strain actual":
            return 100 * (row["free_length"] / slack - 1), "free length over that of the slack row"
    share = free_length_fraction(
        [one["free_length"] for one in stretched], [one["far_thimble"] for one in stretched]
    )
    strain = free_length_strain(row["far_thimble"], free_fraction=share, relaxed_free_length=slack)
    return 100 * float(strain), "constant-fraction: one mean free share of the stretched rows"


def _static_gauge_length(rows: Sequence[_Row]) -> tuple[float, float]:
    """Range of gauge length that rounds to the elongations of Table 4."""
    length = np.array([one["length"] for one in rows])
    stretch = 1 + np.array([one["strain"] for one in rows]) / 100
    return float(np.max(length / (stretch + 0.005))), float(np.min(length / (stretch - 0.005)))


def _items_of_weights(cells: Sequence[Cell]) -> Iterator[ReproducedItem]:
    """Table 4."""
    rows = _rows_of(cells)
    for place, row in enumerate(rows):
        others = [one for one in rows if one is not row]
        low, high = _static_gauge_length(others)
        gauge, half = (low + high) / 2, abs(high - low) / 2
        for column, cell in row.cells.items():
            match column:
                case "clock":
                    if place and cell.printed <= rows[place - 1].cells["clock"].printed:
                        yield ReproducedItem(
                            cell, float("nan"), "unexplained", "earlier than the row before"
                        )
                    else:
                        yield measured_item(cell, _TIMES)
                case "tension":
                    # weights are removed in the opposite order
                    twin = rows[-1 - place]
                    if twin is row:
                        yield measured_item(cell, "the greatest weight, printed once")
                    else:
                        yield judge_repeat(cell, twin["tension"], f"the same weight, {twin.branch}")
                case "length":
                    stretch = 1 + row["strain"] / 100
                    yield judge(
                        cell,
                        gauge * stretch,
                        f"printed elongation on {gauge:.3f} in, which the other rows share",
                        tolerance=0.005 * gauge + half * stretch,
                    )
                case "strain":
                    yield judge(
                        cell,
                        100 * (row["length"] / gauge - 1),
                        f"length over {gauge:.3f} in, which the other rows share",
                        tolerance=0.5 + 100 * half * row["length"] / gauge**2,
                    )
                case _:
                    line = np.polynomial.Polynomial.fit(
                        [one["length"] for one in others], [one[column] for one in others], 1
                    )
                    miss = [line(one["length"]) - one[column] for one in others]
                    yield measured_item(
                        cell,
                        f"measured; {line(row['length']):.1f} in by the line through the other "
                        f"rows, which scatter by {np.std(miss, ddof=2):.1f} in",
                    )


HIGH, LOW = "segment_tension_high", "segment_tension_low"

UPPER, LOWER = "segment_strain_high", "segment_strain_low"

MODULUS = "segment_modulus"

_HALF_A_PSI = 0.5

_COPIED = "WH5-6"

# each number from the other four and the area, in pound-force, inch and psi throughout
_FROM_OTHERS: dict[str, Callable[[dict[str, float]], float]] = {
    HIGH: lambda at: at[LOW] + at[MODULUS] * at["area"] * (at[UPPER] - at[LOWER]),
    LOW: lambda at: at[HIGH] - at[MODULUS] * at["area"] * (at[UPPER] - at[LOWER]),
    UPPER: lambda at: at[LOWER] + (at[HIGH] - at[LOW]) / (at[MODULUS] * at["area"]),
    LOWER: lambda at: at[UPPER] - (at[HIGH] - at[LOW]) / (at[MODULUS] * at["area"]),
    MODULUS: lambda at: float(
        chord_modulus(at[LOWER], at[UPPER], at[LOW], at[HIGH], area=at["area"])
    ),
}


def _shared_area(rows: Sequence[_Row]) -> tuple[float, float]:
    """Range of area for which every row rounds to its printed modulus."""
    low, high = 0.0, float("inf")
    for row in rows:
        slope = (row[HIGH] - row[LOW]) / (row[UPPER] - row[LOWER])
        low = max(low, slope / (row[MODULUS] + _HALF_A_PSI))
        high = min(high, slope / (row[MODULUS] - _HALF_A_PSI))
    return low, high


def _undisputed(rows: Sequence[_Row], tether: str) -> list[_Row]:
    """Rows in which no number is corrected or open."""
    return [
        row
        for row in rows
        if row.tether == tether and not any(cell.confidence for cell in row.cells.values())
    ]


def _areas_of_tables(*tables: Sequence[Cell]) -> dict[str, tuple[float, ...]]:
    """Area of each tether that each table implies."""
    return {
        tether: tuple(
            sum(_shared_area(_undisputed(_rows_of(cells), tether))) / 2 for cells in tables
        )
        for tether in ("new", "used")
    }


def _items_of_segments(cells: Sequence[Cell]) -> Iterator[ReproducedItem]:
    """Table 5 or Table 6."""
    rows = _rows_of(cells)
    for row in rows:
        low, high = _shared_area([one for one in _undisputed(rows, row.tether) if one is not row])
        area, half_range = (low + high) / 2, abs(high - low) / 2
        given = {column: row[column] for column in row.cells} | {"area": area}
        half = {"area": half_range, MODULUS: _HALF_A_PSI} | {
            column: 0.5 * printed_step(f"{cell.corrected}")
            for column, cell in row.cells.items()
            if cell.corrected is not None
        }
        for column, cell in row.cells.items():
            if cell.erratum == _COPIED and cell.confidence == "open":
                yield measured_item(cell, "agrees with its row, which is that of the new tether")
                continue
            if not cell.erratum and any(one.confidence == "open" for one in row.cells.values()):
                yield measured_item(cell, "modulus and strains of its row contradict each other")
                continue
            recomputed = _FROM_OTHERS[column](given)
            carried = sum(
                abs(_FROM_OTHERS[column](given | {name: given[name] + step}) - recomputed)
                for name, step in half.items()
                if name != column
            )
            if column == MODULUS:
                how = f"chord of the limits on {area:.4f} in2, which the other rows share"
                carried += _HALF_A_PSI
            else:
                how = f"modulus and the other limits on {area:.4f} in2, which the other rows share"
            yield judge(cell, recomputed, how, tolerance=carried)


_SECTION = {
    "T-1": "4.1", "T-2": "4.2", "T-3": "4.3", "T-4": "4.4", "T-5": "4.5", "T-6": "4.6",
    "T-4 Extended": "4.7",
}  # fmt: skip

# rows of claims that do not name a test
_TEST_OF_CLAIM = {
    "typical design": "T-2",
    "typical design, least": "T-2",
    "typical design, greatest": "T-2",
    "smaller cycles": "T-1",
    "larger cycles": "T-2",
    "each run of Table 1": "T-1",
    "greatest of all tests": "T-6",
    "T-6 new tether": "T-6",
    "T-6, caption of Figure 24": "T-6",
    "T-1, caption of Figure 20": "T-1",
    "T-6, where the tethers differ": "T-6",
}

_LEAST = {"elongation about which tethers were cycled, from", "tests of this report, from"}

_GREATEST = {"elongation about which tethers were cycled, to", "tests of this report, to"}

_STATIC, _RUN = "static test", "mooring run"

_YEAR = "year of the static test"

_PAIRS: tuple[tuple[Key, Key], ...] = (
    (
        ("sec 2.3.2", "single tether", "rated_break_strength"),
        ("sec 2.3.3", "single tether", "rated_break_strength"),
    ),
    (
        ("sec 2.3.2", "assembly of four tethers, 1 kt current and 7 m waves", "peak_tension"),
        ("sec 2.3.3", "four tethers, greatest by current", "mean_tension"),
    ),
    (
        ("sec 1", "greatest of all tests", "tangent_modulus"),
        ("sec 6.0", "greatest of all tests", "tangent_modulus"),
    ),
    *(
        (
            ("sec 2.3.5", f"{_RUN}, {end}", "current"),
            ("sec 2.3.5", f"{_RUN}, {end}, caption of Figure 14", "current"),
        )
        for end in ("least", "greatest")
    ),
    *(
        (
            ("sec 2.3.5", f"{_RUN} of Figure 15", column),
            ("sec 2.3.5", f"{_RUN} of Figure 16", column),
        )
        for column in ("wave_height", "wave_period", "current")
    ),
    (
        ("sec 2.3.5", "depressor weight", "weight"),
        ("sec 2.3.5", "depressor weight, caption of Figure 16", "weight"),
    ),
    (("contents", "list of tables, Table 4", _YEAR), ("sec 4.8", _STATIC, _YEAR)),
    (
        ("sec 4.8", f"{_STATIC}, caption of Table 4", _YEAR),
        ("sec 4.8", f"{_STATIC}, caption of Figure 35", _YEAR),
    ),
)

_TWIN: dict[Key, Key] = {
    **dict(_PAIRS),
    **{second: first for first, second in _PAIRS},
    ("sec 2.3.5", "static test of Buoy Technology", _YEAR): ("sec 4.8", _STATIC, _YEAR),
    ("sec 2.3", "buoy on Georges Bank, caption of Figure 5", "mean_tension"): (
        "sec 2.3.2", "assembly of six tethers, no waves or currents", "mean_tension",
    ),
}  # fmt: skip


def _items_of_plan(cells: Sequence[Cell], book: Mapping[Key, Cell]) -> Iterator[ReproducedItem]:
    """Table 1, against the sections on its tests."""
    for cell in cells:
        name = _test_of_row(cell.row)
        if name not in _SECTION:
            if cell.column == "n_cycles":
                yield measured_item(cell, "one hold, not a count of cycles")
                continue
            key = ("sec 4.1", "overnight hold", "strain")
        elif cell.column == "n_cycles" and name != "T-4 Extended":
            key = ("sec 3.2", "each run of Table 1", "n_cycles")
        else:
            column = cell.column.removeprefix("target_")
            key = (f"sec {_SECTION[name]}", f"test {name}", column)
        yield _as_elsewhere(cell, key, book)


def _item_of_programme(cell: Cell, plan: Sequence[Cell]) -> ReproducedItem | None:
    """A claim of the text on a test, against Table 1."""
    rows = {_test_of_row(row.name): row for row in _rows_of(plan)}
    cycled = [row for name, row in rows.items() if name in _SECTION and name != "T-4 Extended"]
    if cell.row in _LEAST | _GREATEST:
        centre = [_columns(row)["mean_strain"] for row in cycled]
        value = min(centre) if cell.row in _LEAST else max(centre)
        return judge(cell, value, "Table 1, centres of T-1 to T-6")
    found = re.search(r"test (T-\d(?: Extended)?)$", cell.row)
    name = found[1] if found else _TEST_OF_CLAIM.get(cell.row, "")
    if cell.row == "overnight hold" and cell.column == "strain":
        return judge_repeat(cell, rows["overnight hold"]["target_strain"], "Table 1")
    column = cell.column
    if column == "strain":
        column = "strain_low" if cell.row.endswith(", least") else "strain_high"
    if name not in rows or column not in _columns(rows[name]):
        return None
    return judge(cell, _columns(rows[name])[column], f"Table 1, {name}")


def _columns(row: _Row) -> dict[str, float]:
    low, high = row["target_strain_low"], row["target_strain_high"]
    return {
        "mean_strain": (low + high) / 2,
        "strain_amplitude": (high - low) / 2,
        "strain_low": low,
        "strain_high": high,
        "n_cycles": row["n_cycles"],
    }


def _as_elsewhere(cell: Cell, key: Key, book: Mapping[Key, Cell]) -> ReproducedItem:
    there = book[key]
    place = f"printed again, {there.page}: {there.printed} {there.unit}"
    return judge_repeat(cell, _number_in_use(there), place)


def _test_of_row(row: str) -> str:
    return row.removeprefix("dynamic test ").partition(",")[0]


_INCH = scale_to_si("inch", "length")[0]

_PSI = scale_to_si("psi", "stress")[0]

_NEAR = 0.1  # of strain: how far the line of a first segment is extrapolated down to 100 %

_SPREAD = 0.1  # of 1 in: the material varied from 0.9 to 1.1 in (sec. 2.3.1)


def _items_of_claims(book: Mapping[Key, Cell]) -> Iterator[ReproducedItem]:
    """Every claim that a table can decide."""
    tables = {
        table: _rows_of([cell for cell in book.values() if cell.table == table])
        for table in "123456"
    }
    yield from _of_lengths(book, tables["2"], tables["3"])
    yield from _of_time(book, tables["1"], tables["3"])
    yield from _of_tension(book, [*tables["5"], *tables["6"]])
    yield _of_strain(book, tables["3"], tables["5"])
    yield from _of_modulus(book, tables["5"], tables["6"])
    yield from _of_static_test(book, tables["4"], tables["5"])


def _of_lengths(
    book: Mapping[Key, Cell], diameters: Sequence[_Row], marks: Sequence[_Row]
) -> Iterator[ReproducedItem]:
    slack = [row for row in marks if row.name.endswith("stretch 0 %")]
    splices = [row[f"splice_length {end}"] for row in slack for end in ("near", "far")]
    free = float(np.mean([row["free_length"] for row in slack]))
    whole = float(np.mean([row["far_thimble"] for row in slack]))
    splice = float(np.mean(splices))
    section = "sec 3.2"
    yield judge(
        book[section, "section of rubber of each tether", "length"],
        whole + 2 * splice,
        "Table 3, slack: thimble to thimble, and both splices again, as the rubber is laid back",
    )
    yield judge(
        book[section, "rubber used at each end", "splice_length"], splice, "Table 3, slack: mean"
    )
    yield judge(book[section, "each tether", "relaxed_free_length"], free, "Table 3, slack: mean")
    yield judge(
        book[section, "each tether, eye to eye", "length at slack"], whole, "Table 3, slack"
    )
    read = [row["diameter"] for row in diameters]
    section, how = "sec 2.3.1", "Table 2 as corrected"
    yield judge(book[section, "tether material", "diameter nominal"], float(np.mean(read)), how)
    least = book[section, "tether material, least supplied", "diameter"]
    yield judge_limit(least, min(read), how, is_upper=False)
    greatest = book[section, "tether material, greatest supplied", "diameter"]
    yield judge_limit(greatest, max(read), how, is_upper=True)


def _of_time(
    book: Mapping[Key, Cell], plan: Sequence[_Row], marks: Sequence[_Row]
) -> Iterator[ReproducedItem]:
    """The extended test: stroke, velocity, rate and duration are consistent."""
    new = [row for row in marks if "far_thimble" in row.cells and row.tether == "new"]
    low, high = new[1], new[-1]
    per_point = (high["far_thimble"] - low["far_thimble"]) / (
        high["target_strain"] - low["target_strain"]
    )
    (test,) = (row for row in plan if "T-4 Extended" in row.name)
    path = 2 * per_point * (test["target_strain_high"] - test["target_strain_low"])
    duration = book["sec 4.7", "test T-4 Extended", "duration"]
    velocity = book["sec 4.1", "all tests", "crosshead velocity"]
    rate = book["sec 4.7", "test T-4 Extended", "cycle rate"]
    at, hours = _number_in_use(velocity), _number_in_use(duration)
    stroke = f"{path / 2:.1f} ft each way (Table 3: {per_point:.3f} ft a point of target)"
    yield judge(duration, test["n_cycles"] * path / at / 3600, f"cycles of {stroke} at {at:g} ft/s")
    yield judge(rate, 60 * at / path, f"cycles of {stroke} at {at:g} ft/s")
    yield judge(
        velocity, test["n_cycles"] * path / (3600 * hours), f"cycles of {stroke} in {hours:g} h"
    )


def _of_tension(book: Mapping[Key, Cell], rows: Sequence[_Row]) -> Iterator[ReproducedItem]:
    """Tension of one tether at 100 %, from every test that comes near it."""
    first: dict[str, tuple[float, _Row]] = {}
    for row in rows:
        if any(cell.confidence == "open" for cell in row.cells.values()):
            continue
        away = max(row[LOWER] - 1, 1 - row[UPPER], 0.0)
        branch = row.name.partition(", segment")[0]
        if away <= _NEAR and away < first.get(branch, (np.inf, row))[0]:
            first[branch] = away, row
    tension = [
        row[LOW] + (1 - row[LOWER]) * (row[HIGH] - row[LOW]) / (row[UPPER] - row[LOWER])
        for _, row in first.values()
    ]
    how = (
        f"{{}} at 100 %, mean of {len(tension)} lines of Tables 5 and 6 within {_NEAR:g} of it, "
        f"{min(tension):.0f} to {max(tension):.0f} lb a tether; {{}} is not stated"
    )
    for key, n_tethers in (
        (("sec 2.3.3", "single tether at 100 % stretch", "tension"), 1),
        (("sec 2.3.2", "assembly of four tethers, no waves or currents", "mean_tension"), 4),
        (("sec 2.3.2", "assembly of six tethers, no waves or currents", "mean_tension"), 6),
    ):
        what, unknown = (
            ("one tether", "which tether it was")
            if n_tethers == 1
            else (f"{n_tethers} tethers", "the stretch when deployed")
        )
        mean = n_tethers * float(np.mean(tension))
        yield compared_item(book[key], mean, how.format(what, unknown))


def _of_strain(
    book: Mapping[Key, Cell], marks: Sequence[_Row], raw: Sequence[_Row]
) -> ReproducedItem:
    """Stretch of Table 3 used for the strains of Table 5: where T-1 ends on both tethers."""
    misses = {"interpolated": 0.0, "actual": 0.0}
    for tether in ("new", "used"):
        top = max(row[UPPER] for row in raw if row.name.startswith("T-1 ") and row.tether == tether)
        (end,) = (
            row for row in marks if row.tether == tether and row.name.endswith("stretch 125 %")
        )
        for kind in misses:
            away = abs(100 * top - end[f"mark_strain {kind}"])
            misses[kind] = max(misses[kind], away)
    return agree(
        book["sec 4.1", "strain of Tables 5 and 6", "strain_method"],
        misses["interpolated"] <= 1 < misses["actual"],
        f"ends of T-1 in Table 5 are within {misses['interpolated']:.1f} points of the "
        f"interpolated stretch of Table 3, up to {misses['actual']:.1f} from the actual one",
    )


def _of_modulus(
    book: Mapping[Key, Cell], raw: Sequence[_Row], consolidated: Sequence[_Row]
) -> Iterator[ReproducedItem]:
    low = [
        row[MODULUS] for row in [*raw, *consolidated]
        if row.name.startswith("T-2") and row.name.endswith("segment 1")
    ]  # fmt: skip
    yield compared_item(
        book["sec 1", "low elongations", "tangent_modulus"],
        float(np.mean(low)),
        f"first segments of T-2 in Tables 5 and 6, {min(low):.0f} to {max(low):.0f} psi, mean; "
        "which are meant is not stated",
    )
    about = [
        row[MODULUS] for row in raw
        if row.name.startswith(("T-1", "T-2")) and row[LOWER] < 1 < row[UPPER]
    ]  # fmt: skip
    how = "of T-1 and T-2 in Table 5, segments through 100 %"
    least, greatest = (
        book["sec 6.0", f"smaller cycles about 100 %, {end}", "tangent_modulus"]
        for end in ("from", "to")
    )
    yield judge_round(least, min(about), f"least {how}")
    yield judge_round(greatest, max(about), f"greatest {how}")
    top = book["sec 6.0", "greatest of all tests", "tangent_modulus"]
    ratio = book["sec 6.0", "greatest modulus to that of lower elongations", "ratio of moduli"]
    yield judge(ratio, _number_in_use(top) / _number_in_use(greatest), "900 over 150 psi, sec 6.0")
    bottom = book["sec 6.0", "relaxation at the low end of a cycle", "tangent_modulus"]
    span = _number_in_use(top) / _number_in_use(bottom)
    yield agree(
        book["sec 6.0", "greatest modulus to the least", "ratio of moduli"],
        10**0.5 < span < 10**1.5,
        f"900 over 100 psi, sec 6.0: {span:.0f}",
    )
    reached = max(row[UPPER] for row in consolidated)
    yield judge_round(
        book["sec 4.9", "all tests, greatest", "strain"], 100 * reached, "greatest of Table 6"
    )
    yield judge_limit(
        book["sec 4.7", "all tests, greatest", "strain"],
        100 * reached,
        "greatest of Table 6",
        is_upper=True,
    )


def _of_static_test(
    book: Mapping[Key, Cell], readings: Sequence[_Row], raw: Sequence[_Row]
) -> Iterator[ReproducedItem]:
    area = pi / 4 * _INCH**2
    reduced = reduce_stepwise(published_static_test(), area=area)
    up, down = (reduced.interval_branch == branch for branch in (1, 2))
    modulus = reduced.interval_modulus / _PSI
    top = int(np.flatnonzero(reduced.branch == 1)[-1])
    chord = chord_modulus(
        reduced.strain[0], reduced.strain[top], reduced.tension[0], reduced.tension[top], area=area
    )
    text, later = "static test of Buoy Technology", "static test"
    yield compared_item(
        book["sec 2.3.5", text, "tangent_modulus"],
        float(chord) / _PSI,
        "Table 4, first to last weight going up, on 1 in; no diameter is printed, 0.9 to 1.1 in "
        f"change it by {200 * _SPREAD:.0f} %; 1.013 in gives 123",
    )
    yield judge_limit(
        book["sec 6.0", "relaxation at the low end of a cycle", "tangent_modulus"],
        float(np.nanmin(modulus[down])),
        "Table 4 going down, on 1 in; of the dynamic tests no descending modulus is tabulated",
        is_upper=True,
    )
    (row,) = (
        row for row in raw
        if row.name.startswith("T-2") and row.tether == "new" and row.name.endswith("segment 1")
    )  # fmt: skip
    nearest = int(np.argmin(np.where(up, np.abs(modulus - row[MODULUS]), np.inf)))
    strain = reduced.strain[nearest : nearest + 2]
    yield judge(
        book["sec 4.8", "static test, where it agrees with T-2", "strain"],
        100 * float(np.mean(strain)),
        f"interval of Table 4 nearest to the {row[MODULUS]:.0f} psi of T-2 new, on 1 in; the "
        "tolerance is half the interval",
        tolerance=50 * float(np.diff(strain)[0]),
    )
    elongation = [one["strain"] for one in readings]
    how = "Table 4"
    yield judge_limit(
        book["sec 2.3.5", f"{text}, greatest", "strain"], max(elongation), how, is_upper=True
    )
    yield judge_limit(
        book["sec 4.8", f"{later}, greatest", "strain"], max(elongation), how, is_upper=False
    )
    yield judge_repeat(book["sec 4.8", f"{later}, first", "strain"], elongation[0], how)
    yield judge_repeat(book["sec 4.8", f"{later}, last", "strain"], elongation[-1], how)
    yield judge(
        book["sec 4.8", later, "strain_gauge_length"],
        float(np.mean(_static_gauge_length(readings))),
        "length over 1 + elongation, range that all rows of Table 4 share",
    )
    minutes = np.diff(reduced.time) / 60
    row_name, how = f"{later}, after a weight was {{}}", "times of Table 4, {} of {}"
    waited, between = (
        ", ".join(f"{one:.0f}" for one in some) for some in (minutes[:top], minutes[top:])
    )
    # the time between two readings is the wait plus the next weight: a wait is at most the least
    yield judge(
        book["sec 4.8", row_name.format("added"), "hold duration"],
        float(np.min(minutes[:top])),
        how.format("least", waited),
    )
    yield judge_round(
        book["sec 4.8", row_name.format("taken off"), "hold duration"],
        float(np.mean(minutes[top:])),
        how.format("mean", between),
    )


_TEXT = "a statement, not a number that others give; see its erratum"

_OF_THE_FIELD = "from use at sea, or a pull without record"

_OF_OTHERS = "of another component or test, with no numbers of it here"

_A_CONDITION = "condition of a deployment"

_A_FIGURE = "read from a figure, which the text lacks"

_A_RUN = "of WHOI Cable runs, whose inputs are not printed"

_WHY_BY_PLACE = {
    "sec 2.1": _OF_OTHERS,
    "sec 2.2": _OF_OTHERS,
    "sec 2.3": _OF_THE_FIELD,
    "sec 2.3.1": _OF_THE_FIELD,
    "sec 2.3.2": _A_CONDITION,
    "sec 2.3.3": _OF_THE_FIELD,
    "sec 2.3.4": _OF_THE_FIELD,
    "sec 2.3.5": _A_RUN,
    "sec 4.1": _A_FIGURE,
}

_WHY_BY_ROW = {
    "T-6 new tether when first stretched": "Figure 24; relaxation of 18.75 % to the next number",
    "T-6 new tether after the hold": "Figure 24; relaxation of 18.75 % from the number before",
    "overnight hold": "of a hold whose record is not printed",
    "scaled position in Figure 24": "scale of a figure: on the 33.62, 36.00 and 38.37 ft that the "
    "marks of T-1 give for 225, 250 and 275 % it reads 69, 88 and 107, so the position is in feet",
    "stretch at which splices slip": _OF_THE_FIELD,
    "tethers at sea": "from use at sea; a wave every 5.2 s",
}


def items() -> list[ReproducedItem]:
    """Every cell of the report, with its verdict."""
    return _items_of(cells_of(TETHER_REPORT))


def _items_of(cells: Sequence[Cell]) -> list[ReproducedItem]:
    """Every cell, with its verdict."""
    book = {cell.key: cell for cell in cells}
    table = {number: [cell for cell in cells if cell.table == number] for number in "123456"}
    found = [
        *_items_of_plan(table["1"], book),
        *_items_of_diameters(table["2"], _areas_of_tables(table["5"], table["6"])),
        *_items_of_marks(table["3"]),
        *_items_of_weights(table["4"]),
        *_items_of_segments(table["5"]),
        *_items_of_segments(table["6"]),
        *_items_of_claims(book),
    ]
    by_key = {item.cell.key: item for item in found}
    return [
        by_key.get(cell.key)
        or _item_of_programme(cell, table["1"])
        or (_as_elsewhere(cell, _TWIN[cell.key], book) if cell.key in _TWIN else None)
        or measured_item(cell, _why_not(cell))
        for cell in cells
    ]


def _why_not(cell: Cell) -> str:
    if cell.row in _WHY_BY_ROW:
        return _WHY_BY_ROW[cell.row]
    if cell.unit == "":
        return _TEXT
    return _WHY_BY_PLACE.get(cell.table, _TEXT)
