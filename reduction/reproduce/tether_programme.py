"""What WHOI-2005-10 says more than once: test plan, sections, captions.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from reduction.published.cell import Cell
from reduction.reproduce.answers import Key
from reduction.reproduce.item import Item, judge, not_testable
from reduction.reproduce.tether_rows import Row, number_in_use, rows_of

_SECTION = {
    "T-1": "4.1", "T-2": "4.2", "T-3": "4.3", "T-4": "4.4", "T-5": "4.5", "T-6": "4.6",
    "T-4 Extended": "4.7",
}  # fmt: skip
# rows of claims that name no test
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


def items_of_plan(cells: Sequence[Cell], book: Mapping[Key, Cell]) -> Iterator[Item]:
    """Table 1, against the sections on its tests.

    Parameters
    ----------
    cells : sequence of Cell
        Of Table 1.
    book : mapping of (str, str, str) to Cell
        The whole report.

    Yields
    ------
    item : Item
    """
    for cell in cells:
        name = _test_of_row(cell.row)
        if name not in _SECTION:
            if cell.column == "n_cycles":
                yield not_testable(cell, "one hold, not a count of cycles")
                continue
            key = ("sec 4.1", "overnight hold", "strain")
        elif cell.column == "n_cycles" and name != "T-4 Extended":
            key = ("sec 3.2", "each run of Table 1", "n_cycles")
        else:
            column = cell.column.removeprefix("target_")
            key = (f"sec {_SECTION[name]}", f"test {name}", column)
        yield _as_elsewhere(cell, key, book)


def item_of_programme(cell: Cell, plan: Sequence[Cell]) -> Item | None:
    """A claim of the text on a test, against Table 1.

    Parameters
    ----------
    cell : Cell
        Of the text.
    plan : sequence of Cell
        Table 1.

    Returns
    -------
    item : Item or None
        None where the claim is not of the test plan.
    """
    rows = {_test_of_row(row.name): row for row in rows_of(plan)}
    cycled = [row for name, row in rows.items() if name in _SECTION and name != "T-4 Extended"]
    if cell.row in _LEAST | _GREATEST:
        centre = [_columns(row)["mean_strain"] for row in cycled]
        value = min(centre) if cell.row in _LEAST else max(centre)
        return judge(cell, value, "Table 1, centres of T-1 to T-6")
    found = re.search(r"test (T-\d(?: Extended)?)$", cell.row)
    name = found[1] if found else _TEST_OF_CLAIM.get(cell.row, "")
    if cell.row == "overnight hold" and cell.column == "strain":
        return judge(cell, rows["overnight hold"]["target_strain"], "Table 1")
    column = cell.column
    if column == "strain":
        column = "strain_low" if cell.row.endswith(", least") else "strain_high"
    if name not in rows or column not in _columns(rows[name]):
        return None
    return judge(cell, _columns(rows[name])[column], f"Table 1, {name}")


def _columns(row: Row) -> dict[str, float]:
    low, high = row["target_strain_low"], row["target_strain_high"]
    return {
        "mean_strain": (low + high) / 2,
        "strain_amplitude": (high - low) / 2,
        "strain_low": low,
        "strain_high": high,
        "n_cycles": row["n_cycles"],
    }


def item_printed_twice(cell: Cell, book: Mapping[Key, Cell]) -> Item | None:
    """A claim of the text against where the text makes it again.

    Parameters
    ----------
    cell : Cell
        Of the text.
    book : mapping of (str, str, str) to Cell
        The whole report.

    Returns
    -------
    item : Item or None
        None where it is printed once.
    """
    return _as_elsewhere(cell, _TWIN[cell.key], book) if cell.key in _TWIN else None


def _as_elsewhere(cell: Cell, key: Key, book: Mapping[Key, Cell]) -> Item:
    there = book[key]
    place = f"printed again, {there.page}: {there.printed} {there.unit}"
    return judge(cell, number_in_use(there), place)


def _test_of_row(row: str) -> str:
    return row.removeprefix("dynamic test ").partition(",")[0]
