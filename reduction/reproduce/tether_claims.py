"""Claims of the text of WHOI-2005-10 that follow from its tables.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import pi

import numpy as np

from reduction.moduli.secant import chord_modulus
from reduction.moduli.stepwise import reduce_stepwise
from reduction.published.cell import Cell
from reduction.published.tethers import published_static_test
from reduction.reproduce.answers import Key
from reduction.reproduce.item import Item, agree, beside, judge
from reduction.reproduce.tether_marks import static_gauge_length
from reduction.reproduce.tether_moduli import HIGH, LOW, LOWER, MODULUS, UPPER
from reduction.reproduce.tether_rows import Row, number_in_use, rows_of
from reduction.reproduce.wording import judge_limit, judge_round
from reduction.units import scale_to_si

_INCH = scale_to_si("inch", "length")[0]
_PSI = scale_to_si("psi", "stress")[0]
_NEAR = 0.1  # of strain: how far the line of a first segment is carried down to 100 %
_SPREAD = 0.1  # of 1 in: the material varied from 0.9 to 1.1 in (sec. 2.3.1)


def items_of_claims(book: Mapping[Key, Cell]) -> Iterator[Item]:
    """Every claim that a table decides.

    Parameters
    ----------
    book : mapping of (str, str, str) to Cell
        The whole report.

    Yields
    ------
    item : Item
    """
    tables = {
        table: rows_of([cell for cell in book.values() if cell.table == table])
        for table in "123456"
    }
    yield from _of_lengths(book, tables["2"], tables["3"])
    yield from _of_time(book, tables["1"], tables["3"])
    yield from _of_tension(book, [*tables["5"], *tables["6"]])
    yield _of_strain(book, tables["3"], tables["5"])
    yield from _of_modulus(book, tables["5"], tables["6"])
    yield from _of_static_test(book, tables["4"], tables["5"])


def _of_lengths(
    book: Mapping[Key, Cell], diameters: Sequence[Row], marks: Sequence[Row]
) -> Iterator[Item]:
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


def _of_time(book: Mapping[Key, Cell], plan: Sequence[Row], marks: Sequence[Row]) -> Iterator[Item]:
    """The extended test: stroke, velocity, rate and duration say the same."""
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
    at, hours = number_in_use(velocity), number_in_use(duration)
    stroke = f"{path / 2:.1f} ft each way (Table 3: {per_point:.3f} ft a point of target)"
    yield judge(duration, test["n_cycles"] * path / at / 3600, f"cycles of {stroke} at {at:g} ft/s")
    yield judge(rate, 60 * at / path, f"cycles of {stroke} at {at:g} ft/s")
    yield judge(
        velocity, test["n_cycles"] * path / (3600 * hours), f"cycles of {stroke} in {hours:g} h"
    )


def _of_tension(book: Mapping[Key, Cell], rows: Sequence[Row]) -> Iterator[Item]:
    """Tension of one tether at 100 %, by every test that comes near it."""
    first: dict[str, tuple[float, Row]] = {}
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
        yield beside(book[key], mean, how.format(what, unknown))


def _of_strain(book: Mapping[Key, Cell], marks: Sequence[Row], raw: Sequence[Row]) -> Item:
    """Which stretch of Table 3 the strains of Table 5 go by: where T-1 ends on both tethers."""
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
    book: Mapping[Key, Cell], raw: Sequence[Row], consolidated: Sequence[Row]
) -> Iterator[Item]:
    low = [
        row[MODULUS] for row in [*raw, *consolidated]
        if row.name.startswith("T-2") and row.name.endswith("segment 1")
    ]  # fmt: skip
    yield beside(
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
    yield judge(ratio, number_in_use(top) / number_in_use(greatest), "900 over 150 psi, sec 6.0")
    bottom = book["sec 6.0", "relaxation at the low end of a cycle", "tangent_modulus"]
    span = number_in_use(top) / number_in_use(bottom)
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
    book: Mapping[Key, Cell], readings: Sequence[Row], raw: Sequence[Row]
) -> Iterator[Item]:
    area = pi / 4 * _INCH**2
    reduced = reduce_stepwise(published_static_test(), area=area)
    up, down = (reduced.interval_branch == branch for branch in (1, 2))
    modulus = reduced.interval_modulus / _PSI
    top = int(np.flatnonzero(reduced.branch == 1)[-1])
    chord = chord_modulus(
        reduced.strain[0], reduced.strain[top], reduced.tension[0], reduced.tension[top], area=area
    )
    text, later = "static test of Buoy Technology", "static test"
    yield beside(
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
    yield judge(book["sec 4.8", f"{later}, first", "strain"], elongation[0], how)
    yield judge(book["sec 4.8", f"{later}, last", "strain"], elongation[-1], how)
    yield judge(
        book["sec 4.8", later, "strain_gauge_length"],
        float(np.mean(static_gauge_length(readings))),
        "length over 1 + elongation, range that all rows of Table 4 share",
    )
    minutes = np.diff(reduced.time) / 60
    row_name, how = f"{later}, after a weight was {{}}", "times of Table 4, {} of {}"
    waited, between = (
        ", ".join(f"{one:.0f}" for one in some) for some in (minutes[:top], minutes[top:])
    )
    # the time between two readings holds the wait and the next weight: a wait is at most the least
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
