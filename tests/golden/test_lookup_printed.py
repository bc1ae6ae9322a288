"""Every printed design value can be looked up: each source against the corrected cells of its page.

The look-up does no more than change units and evaluate a polynomial at a point: what is left is
the rounding of a double, some ten operations of 2e-16 each.
"""

import re
from functools import cache

import numpy as np
import pytest

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources
from reduction.published.printed_cells import cells_of
from reduction.record.errors import SettingsError

ROUNDING = 1e-12
LBF, PSI = 4.4482216152605, 6894.757293168361
# unit of a printed value in SI: 1e4 lb/(in/in), lb in/in, s
SURFACES = {
    "apparent_spring_constant": 1e4 * LBF,
    "hysteresis_energy": LBF,
    "dissipation_spring_constant": 1e4 * LBF,
    "relaxation_time": 1.0,
}
# of A, B, C, D, with the tension in lb: Tables 6 and 7 give lb, 8 and 9 strain
CUBICS = {
    "quasi_static_spring_constant": ("mean_tension", "quasi_static_spring_constant",
                                     np.array([1e4, 1.0, 1e-3, 1e-7]), LBF),
    "quasi_static_strain": ("tension", "strain", np.array([1e-4, 1e-4, 1e-8, 1e-12]), 1.0),
}  # fmt: skip
# what the page does not give, with the words in which the look-up says so
OPEN = {
    ("polyester-8-strand-plaited-0.5in-4-years", "hysteresis_energy"): "its mean B1 is open",
    ("polyester-8-strand-plaited-0.5in-new", "strain"): "ambiguous: .417",
    ("nylon-8-strand-plaited-0.8125in-new", "strain"): "ambiguous: the printed range",
}
# rows whose range or coefficient is open: the slope of the load-strain curve stands for them
BY_SLOPE = {"nylon-double-braid-0.75in-new", "nylon-double-braid-0.5in-5-years"}
BRAID = ("nylon", "double braid")
SIZES = {"1/2 in": "0.5in", "3/4 in": "0.75in", "1 in": "1in", "1 1/4 in": "1.25in",
         "13/16 in": "0.8125in"}  # fmt: skip


def names_of(row):
    material, construction, size, condition = row.split(" | ")
    conditions = [condition]
    if condition == "field exposure":
        # one row for both; of nylon braid none of four years was tested
        conditions = ["5 years"] if (material, construction) == BRAID else ["4 years", "5 years"]
    return [
        "-".join((material, construction, SIZES[size], one)).replace(" ", "-") for one in conditions
    ]


@cache
def cells():
    return {cell.key: cell for cell in cells_of("CG-D-39-80") if not cell.table.startswith("sec")}


def rows_with(last):
    return [
        (table, row, column.rpartition(" ")[0])
        for table, row, column in cells()
        if column.endswith(f" {last}")
    ]


@pytest.mark.parametrize(("table", "row", "quantity"), rows_with("B1"))
def test_the_centre_of_a_design_is_b1_as_corrected(table, row, quantity):
    (name,) = names_of(row)
    line = published_sources()[name]
    if (name, quantity) in OPEN:
        with pytest.raises(SettingsError, match=OPEN[name, quantity]):
            look_up(line, quantity, frequency=0.3, mean_tension=1.0, tension_amplitude=1.0)
        return
    surface = line.surfaces[quantity]
    middle = (surface.low + surface.high) / 2
    found = look_up(line, quantity, **dict(zip(line.factor_names, middle, strict=True)))
    expected = cells()[table, row, f"{quantity} B1"].value * SURFACES[quantity]
    assert found.value == pytest.approx(expected, rel=ROUNDING)
    assert found.is_inside
    assert found.rule.startswith("peak at most 60 %")
    assert 0 < found.minimum_share < found.peak_share < 0.6


@pytest.mark.parametrize(("table", "row", "quantity"), rows_with("A"))
def test_a_cubic_is_that_of_its_row_as_corrected(table, row, quantity):
    variable, asked, scale, unit = CUBICS[quantity]
    tension = np.array([600.0, 1000.0, 1700.0])  # lb, inside every range
    for name in names_of(row):
        line = published_sources()[name]
        if (name, asked) in OPEN:
            with pytest.raises(SettingsError, match=OPEN[name, asked]):
                look_up(line, asked, **{variable: tension * LBF})
            continue
        found = look_up(line, asked, **{variable: tension * LBF})
        assert found.peak_share == pytest.approx(tension * LBF / line.rated_break_strength)
        if asked == "quasi_static_spring_constant" and name in BY_SLOPE:
            assert any("slope of load against strain" in note for note in found.notes)
            continue
        values = [cells()[table, row, f"{quantity} {term}"].value for term in "ABCD"]
        if values[0] is None:  # A of nylon braid: 4.13 with either sign, and the look-up says so
            assert any("4.13 (Table 9); the first is taken" in note for note in found.notes)
            values[0] = -4.13
        expected = np.polynomial.polynomial.polyval(tension, np.array(values) * scale) * unit
        assert found.value == pytest.approx(expected, rel=ROUNDING, abs=1e-15)


def segments():
    """Rows of Tables 5 and 6 by table, test and tether: strain, tension [lb] and modulus [psi]."""
    found = {}
    for cell in cells_of("WHOI-2005-10"):
        named = re.fullmatch(
            r"(T-\d(?: after 3000 cycles)?) rubber tether (\w+), .* (\d)", cell.row
        )
        if cell.table in ("5", "6") and named:
            test, kind, number = named.groups()
            rows = found.setdefault((cell.table, test.replace(" ", "-"), kind), {})
            rows.setdefault(int(number), {})[cell.column.removeprefix("segment_")] = cell
    return found


@pytest.mark.parametrize(("table", "test", "kind"), sorted(segments()))
def test_a_tether_has_modulus_and_tensions_of_every_segment(table, test, kind):
    rows = segments()[table, test, kind]
    line = published_sources()[f"rubber-tether-{kind}-{test}"]
    if f"Table {table}" not in line.source:
        # one table a test: the consolidated one, or where that is open the raw one
        is_open = any(one["modulus"].confidence == "open" for one in rows.values())
        assert is_open or "Table 6" in line.source
        return
    low, high, modulus, first, last = (
        np.array([one[name].value for _, one in sorted(rows.items())], dtype=float)
        for name in ("strain_low", "strain_high", "modulus", "tension_low", "tension_high")
    )
    found = look_up(line, "tangent_modulus", strain=(low + high) / 2, branch="ascending")
    assert found.value == pytest.approx(modulus * PSI, rel=ROUNDING)
    # at a joint two segments may print two tensions; in the middle the mean of the ends is meant
    tension = look_up(line, "branch_tension", strain=(low + high) / 2, branch="ascending")
    assert tension.value == pytest.approx((first + last) / 2 * LBF, rel=ROUNDING)
    assert found.peak_share == pytest.approx((first + last) / 2 / 800)  # lb, sec. 2.3.2
    assert "must not go slack" in found.rule


def test_every_source_was_held_against_its_page():
    held = {name for _, row, _ in rows_with("B1") + rows_with("A") for name in names_of(row)}
    held |= {f"rubber-tether-{kind}-{test}" for _, test, kind in segments()}
    assert held == set(published_sources())
