"""Published tables and lines against what the reports print."""

import csv
from fractions import Fraction
from pathlib import Path

import pytest
from csvrows import csv_rows
from published_typings import (
    ROOM,
    cells_in_order,
    faults_of_the_claims,
    faults_of_the_data,
    typed_in_order,
)

from reduction.published.printed_cells import cells_of, errata_of, number_of, table_of

REPORT = "WHOI-2005-10"
HERE = ROOM / REPORT


def typed(name):
    return csv_rows(HERE / name)


def printed_of(table):
    return {key: cell.printed for key, cell in table_of(REPORT, table).items()}


def compare(table, second, *, as_text=False):
    first = printed_of(table)
    if not as_text:
        first = {key: number_of(text) for key, text in first.items()}
        second = {key: number_of(text) for key, text in second.items()}
    assert first == second


def test_the_plan():
    second = {}
    for row in typed("01_test_plan.csv"):
        if row["test"] == "Overnight Hold":
            name = "overnight hold, rubber tethers new and used"
            assert row["target_strain_low"] == row["target_strain_high"]
            second[name, "target_strain"] = row["target_strain_low"]
        else:
            name = f"dynamic test {row['test']}, rubber tethers new and used"
            for end in ("target_strain_low", "target_strain_high"):
                second[name, end] = row[end]
        second[name, "n_cycles"] = row["n_cycles"]
    compare("1", second)


def test_diameters():
    second = {}
    for row in typed("02_diameters.csv"):
        name = f"rubber tether {row['tether']}, Natsyn 1 in"
        column = f"stretched_diameter at {row['stretch']} % reading {row['reading']}"
        second[name, "diameter" if row["stretch"] == "0" else column] = row["diameter"]
    compare("2", second)


def test_marks():
    second = {}
    for row in typed("03_marks.csv"):
        tether, stretch = row.pop("tether"), row.pop("target_strain")
        name = f"T-1 rubber tether {tether}, "
        name += stretch if stretch == "average" else f"stretch {stretch} %"
        if stretch != "average":
            second[name, "target_strain"] = stretch
        second |= {(name, column): text for column, text in row.items() if text}
    compare("3", second)


def test_weights():
    second = {}
    for place, row in enumerate(typed("04_static.csv")):
        branch = "ascending" if place < 8 else "descending"
        name = (
            f"static test of a short rubber tether, {branch}, {row['tension']} lb at {row['clock']}"
        )
        second |= {(name, column): text for column, text in row.items()}
    compare("4", second)


@pytest.mark.parametrize(
    ("table", "file", "data"),
    [("5", "05_raw_segments.csv", "raw"), ("6", "06_consolidated_segments.csv", "consolidated")],
)
def test_segments(table, file, data):
    second = {}
    for row in typed(file):
        test, tether, condition, number = (
            row.pop(name) for name in ("test", "tether", "condition", "segment")
        )
        if condition != "10 cycles":
            test = f"{test} {condition}"
        name = f"{test} rubber tether {tether}, {data} data, ascending, segment {number}"
        second |= {(name, column): text for column, text in row.items()}
    compare(table, second, as_text=True)


def test_claims_are_those_of_a_second_typing():
    assert faults_of_the_claims(REPORT, lambda table: not table.isdigit()) == {}


def test_every_erratum_touches_a_cell_and_every_touched_cell_names_one():
    known = {one.id for one in errata_of(REPORT)}
    assert {cell.erratum for cell in cells_of(REPORT)} - {""} == known
    assert list(known) and {f"WH5-{i}" for i in range(1, 36)} == known


def test_what_is_open_says_why_and_what_is_corrected_has_an_erratum():
    for cell in cells_of(REPORT):
        if cell.confidence == "open":
            assert cell.corrected is None and cell.note and cell.erratum, cell.key
        if cell.corrected is not None:
            assert cell.erratum and cell.confidence in ("certain", "high"), cell.key
        assert not cell.confidence or cell.erratum, cell.key


def number(table, row, column):
    return table_of(REPORT, table)[row, column].value


@pytest.mark.parametrize(
    ("tether", "segment", "lost"),
    [("new", 1, 23), ("new", 2, 50), ("used", 1, 18), ("used", 2, 33)],
)
def test_moduli_after_three_thousand_cycles_are_lower_than_in_t_4(tether, segment, lost):
    before, after = (
        number("5", f"{test} rubber tether {tether}, raw data, ascending, segment {segment}", "segment_modulus")
        for test in ("T-4", "T-4 after 3000 cycles")
    )  # fmt: skip
    assert 100 * (1 - after / before) == pytest.approx(lost, abs=0.5)


def test_the_two_sets_of_t_6_in_table_5_differ_by_area_alone():
    rows = [
        [
            cell.printed.replace("2.40", "240")
            for (row, column), cell in table_of(REPORT, "5").items()
            if row.startswith(f"T-6 rubber tether {tether}") and column != "segment_modulus"
        ]
        for tether in ("new", "used")
    ]
    assert rows[0] == rows[1] and len(rows[0]) == 8


def test_lines_of_table_6_carry_the_loads_that_speak_for_the_new_tether_in_t_6():
    def load(tether, segment, strain):
        row = f"T-6 rubber tether {tether}, consolidated data, ascending, segment {segment}"
        low, high, start, end = (
            number("6", row, f"segment_{name}")
            for name in ("tension_low", "tension_high", "strain_low", "strain_high")
        )
        return low + (high - low) * (strain - start) / (end - start)

    assert load("new", 1, 2.58) == pytest.approx(322.7, abs=0.05)  # printed 322
    assert load("used", 2, 2.58) == pytest.approx(309.4, abs=0.05)
    assert load("used", 1, 2.43) == pytest.approx(230, abs=1e-9)  # printed 240


def test_lines_of_table_5_speak_for_182_psi_in_t_1():
    def load(segment, strain):
        row = f"T-1 rubber tether new, raw data, ascending, segment {segment}"
        low, high, start, end = (
            number("5", row, f"segment_{name}")
            for name in ("tension_low", "tension_high", "strain_low", "strain_high")
        )
        return low + (high - low) * (strain - start) / (end - start)

    assert load(1, 0.80) == pytest.approx(83, abs=0.5)
    assert load(2, 1.22) == pytest.approx(143, abs=0.5)
    assert 65 / 0.42 / 0.85 == pytest.approx(182.1, abs=0.05)


# CG-D-39-80: the cells of the package against a second typing of the tables

SECOND = ROOM / "CG-D-39-80"
CELLS = {cell.key: cell for cell in cells_of("CG-D-39-80")}
# files whose columns belong to the quantity of the row
OF_QUANTITY = {
    "03_19_surfaces.csv", "06_07_quasi_static.csv", "08_09_strain.csv", "10_21_strength.csv",
    "a-2_screening.csv", "01_02_levels.csv",
}  # fmt: skip
# a second typing that put right the ranges it typed
RANGES = {
    f"{what} {end}" for what in ("mean_tension", "tension_amplitude") for end in ("low", "high")
}
# Table 16 prints one pair of ranges and not which line it is of; the second typing has it for
# all three columns, the package for the braid, whose levels it is
ONE_RANGE = "polyester | 8-strand plaited | 1/2 in | new"
# counts and words that only the package has: settings, symbols, heads, relative variability
ONLY_HERE = {
    "symbol", "unit", "power of ten", "number of lines", "change", "relative variability",
    "number of samples",
}  # fmt: skip


def column_of(file, row, name):
    quantity = row.get("quantity") or row.get("factor") or ""
    if file == "a-2_screening.csv" and name != "smallest significant effect":
        return f"{quantity} effect of {name}"
    if file == "20_abrasion.csv":
        return f"abrasion_cycles {name}"
    return f"{quantity} {name}" if file in OF_QUANTITY else name


def second_typing():
    for path in sorted(set(SECOND.glob("*.csv")) - {SECOND / "claims.csv"}):
        with path.open(encoding="utf-8") as lines:
            for row in csv.DictReader(lines):
                for name, text in row.items():
                    if name in ("table", "row", "quantity", "factor") or not text:
                        continue
                    yield path.name, row, name, text


def cell_of(row, column):
    """The cell, or that of all conditions of the line: a range is printed once for several."""
    key = (row["table"], row["row"], column)
    whole = (row["table"], row["row"].rpartition(" | ")[0] + " | all", column)
    return CELLS.get(key) or CELLS.get(whole)


TYPED = list(second_typing())


def test_every_number_of_the_second_typing_is_the_printed_one():
    different = []
    for file, row, name, text in TYPED:
        if name in RANGES and row["table"] == "16" and row["row"] == ONE_RANGE:
            continue
        if file == "10_21_strength.csv" and name == "number of samples":
            # one cell of the plaited polyester line is absent in the text
            if (row["row"], row["quantity"]) == (
                "polyester | 8-strand plaited | 1/2 in | 4 years", "tensile_strength",
            ):  # fmt: skip
                continue
        cell = cell_of(row, column_of(file, row, name))
        assert cell is not None, (file, row["table"], row["row"], name)
        corrected = name in RANGES and file == "03_19_surfaces.csv"
        printed = cell.corrected if corrected and cell.corrected is not None else None
        typed = float(Fraction(text)) if "/" in text else float(text)
        if "/" in cell.printed:
            assert cell.printed == text
        elif (number_of(cell.printed) if printed is None else printed) != typed:
            different.append((cell.key, cell.printed, text))
    assert different == []


def test_every_number_of_the_tables_is_typed_twice():
    seen = set()
    for file, row, name, _ in TYPED:
        cell = cell_of(row, column_of(file, row, name))
        if cell is not None:
            seen.add(cell.key)
    once = [
        cell for key, cell in CELLS.items()
        if key not in seen and not cell.table.startswith(("sec", "eq", "App", "abstract"))
    ]  # fmt: skip
    # frequencies are one pair a table; heads are words; the rest is counted here
    counted = {}
    for cell in once:
        kind = next((word for word in ONLY_HERE if cell.column.endswith(word)), None)
        if " frequency " in cell.column:
            kind = "frequency of a table"
        elif "power of mean_tension" in cell.column or cell.column.startswith("head"):
            kind = "head"
        elif cell.column.endswith((" low", " high")) and cell.table == "15":
            kind = "range without a column"
        elif cell.column.startswith("abrasion "):
            kind = "setting"
        counted[kind] = counted.get(kind, 0) + 1
    assert counted == {
        "symbol": 3, "frequency of a table": 24, "unit": 2, "power of ten": 2, "head": 8,
        "change": 4, "relative variability": 4, "setting": 3, "range without a column": 4,
    }  # fmt: skip


def test_claims_are_those_of_a_second_typing_in_cg_d_39_80():
    of_text = ("sec", "eq", "App", "abstract")
    assert faults_of_the_claims("CG-D-39-80", lambda table: table.startswith(of_text)) == {}


def test_a_doubted_cell_says_why():
    known = {erratum.id for erratum in errata_of("CG-D-39-80")}
    for cell in CELLS.values():
        assert not cell.erratum or cell.erratum in known, cell
        sure = cell.erratum and cell.confidence in ("certain", "high")
        assert cell.corrected is None or sure, cell
        says = cell.note and cell.erratum and cell.corrected is None
        assert cell.confidence != "open" or says, cell
        assert not cell.confidence or cell.erratum, cell


def test_every_erratum_has_evidence_and_a_cell():
    errata = errata_of("CG-D-39-80")
    used = {cell.erratum for cell in CELLS.values()}
    assert [erratum.id for erratum in errata] == [f"CG-{i}" for i in range(1, len(errata) + 1)]
    assert all(one.evidence and one.place and one.corrected and one.confidence for one in errata)
    assert {one.id for one in errata} <= used


# Wang (2022): the cells of the package against a second typing of the paper


def test_the_steel():
    cells = table_of("Wang-2022", "1")
    assert [cell.value for cell in cells.values()] == [210_000.0, 0.3, 7800.0]


# WHOI-2004-06: the cells of the package against a second typing of the report


FABRIC = "nylon tire cord fabric"
# where the numbers of a third reading stand
PLACES = {
    "cords_per_inch": ("sec 1.2.2", FABRIC, "cords_per_length"),
    "cord_diameter": ("sec 1.2.2", FABRIC, "cord_diameter"),
    "cord_break": ("sec 1.2.2", FABRIC, "breaking strength of one cord"),
    "fabric_break": ("sec 1.2.2", FABRIC, "breaking strength of the fabric"),
    "hose64_stretch": ("sec 3.0", "medium high stretching hose", "maximum stretch"),
    "hose68_stretch": ("sec 3.0", "high stretching hose", "maximum stretch"),
    "safe_working_fraction": (
        "sec 1.2.4", "stretch hose", "safe working load over the breaking strength of the cords",
    ),
    "stretch_range_low": ("abstract", "stretch hose", "elastic stretch, from"),
    "stretch_range_high": ("abstract", "stretch hose", "elastic stretch, to"),
    "test_hose_length": ("sec 3.0", "Snubber test hose of 1994", "length"),
}  # fmt: skip
NEUTRAL = ("sec 1.2.1", "stretch hose", "neutral wrap angle")


def test_stated_numbers_of_a_third_reading():
    cells = {cell.key: cell for cell in cells_of("WHOI-2004-06")}
    stated = {
        row["quantity"]: float(row["value"])
        for row in csv_rows(ROOM / "WHOI-2004-06" / "stated_numbers.csv")
    }
    assert cells[NEUTRAL].printed == f"about {stated.pop('neutral_angle'):g} degrees"
    assert stated.keys() == PLACES.keys()
    for name, place in PLACES.items():
        assert cells[place].value == pytest.approx(stated[name], abs=5e-5)


def test_what_a_designer_gets_is_what_is_right():
    cells = {cell.key: cell for cell in cells_of("WHOI-2004-06")}
    right = {
        ("sec 3.0", "medium high stretching hose", "wrap_angle"): 64.0,
        ("sec 3.0", "high stretching hose", "wrap_angle"): 68.0,
        ("sec 2.0", "stretch hose", "temperature of the curing steam"): 300.0,
        ("sec 1.2.2", FABRIC, "number of plies"): 2.0,
        ("sec 1.1", FABRIC, "gap between cords over the cord diameter"): 0.333,
        NEUTRAL: 54.7356,
    }
    assert {place: cells[place].value for place in right} == right


# Zhang (2015): the cells of the package against a second typing of the paper


TABLE_7 = Path(__file__).parent / "zhang_2015_table_7.csv"
OF_COLUMN = {
    "classic": "load F0",
    "": "load F1",
    "difference": "difference F2",
    "percent": "ratio P",
}


def test_table_7_cell_by_cell_against_a_third_typing():
    cells = {cell.key: cell.printed for cell in cells_of("Zhang-2015") if cell.table == "7"}
    with TABLE_7.open(encoding="utf-8") as lines:
        for row in csv.DictReader(line for line in lines if not line.startswith("#")):
            place = f"{row.pop('theory')} theory, t = {row.pop('time')} s"
            for name, text in row.items():
                direction, _, rest = name.partition("_")
                assert cells.pop(("7", place, f"{direction} {OF_COLUMN[rest]}")) == text
    assert cells == {}


def test_corrected_ratios_and_differences_follow_from_the_corrected_loads():
    cells = {(c.row, c.column): c for c in cells_of("Zhang-2015") if c.table == "7"}
    rows = {row for row, _ in cells if row.startswith("Airy")}
    for row in rows:
        classic, improved, difference, ratio = (
            cells[row, f"vertical {name}"].value
            for name in ("load F0", "load F1", "difference F2", "ratio P")
        )
        assert abs(classic - improved - difference) <= 0.015 + 1e-9
        rounding = 0.005 + 100 * 0.005 * (1 + abs(improved / classic)) / abs(classic)
        assert abs(100 * (classic - improved) / classic - ratio) <= rounding


def test_what_is_open_has_no_value():
    found = {(c.table, c.column) for c in cells_of("Zhang-2015") if c.confidence == "open"}
    assert found == {("1", "steepness H/L, from"), ("4", "wave_period T")}
    assert all(c.value is None for c in cells_of("Zhang-2015") if c.confidence == "open")


# reports of which each cell is typed twice, in the same order

NUMBER_OF_ERRATA = {"Wang-2022": ("WA", 16), "WHOI-2004-06": ("WH4", 12), "Zhang-2015": ("ZH", 11)}


@pytest.mark.parametrize("report", NUMBER_OF_ERRATA)
def test_both_typings_agree(report):
    assert cells_in_order(report) == typed_in_order(report)


@pytest.mark.parametrize("report", NUMBER_OF_ERRATA)
def test_the_data_keep_their_rules(report):
    assert faults_of_the_data(report) == {}


@pytest.mark.parametrize(("report", "numbered"), NUMBER_OF_ERRATA.items())
def test_errata_are_numbered_in_order(report, numbered):
    letters, last = numbered
    assert [one.id for one in errata_of(report)] == [f"{letters}-{n}" for n in range(1, last + 1)]
