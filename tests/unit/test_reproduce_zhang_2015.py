"""Zhang (2015) again: what comes back, what is wrong, and what cannot be known."""

from collections import Counter
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from reduction.prediction.wave_load import wave_load
from reduction.published.printed_cells import cells_of, number_of, table_of
from reduction.published.zhang_2015 import (
    _equation_answers,
    _table_answers,
    items,
    printed_airy_wave,
    printed_section,
)

ITEMS = items()
BY_KEY = {item.cell.key: item for item in ITEMS}
# by hand: of Table 7, 40 vertical Airy cells less the four at t = 0, where there is no velocity;
# of Table 5 the four vertical ones; of Table 8 both of P2, the maximum of P3, the averages of P3
# and P4
COUNTS = {
    "1": {"derived": 4, "measured": 3, "open": 1},
    "2": {"measured": 14},
    "3": {"derived": 5},
    "4": {"derived": 3, "erratum": 1, "open": 1},
    "5": {"derived": 4, "erratum": 4},
    "6": {"derived": 8},
    "7": {"derived": 132, "erratum": 36},
    "8": {"derived": 3, "erratum": 5},
}


@pytest.mark.parametrize("table", COUNTS)
def test_counts_of_a_table(table):
    assert Counter(one.verdict for one in ITEMS if one.cell.table == table) == COUNTS[table]


def test_nothing_is_unexplained():
    assert Counter(one.verdict for one in ITEMS) == {
        "derived": 189, "erratum": 52, "open": 2, "measured": 18,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("key", "value", "within"),
    [
        (("3", "floating pipeline", "outer_diameter D"), 114.0, 0.13),
        (("3", "floating pipeline", "wall_thickness d"), 6.0, 0.04),
        (("3", "floating pipeline", "water_density rho1"), 1.025, 0.0005),
        (("3", "floating pipeline", "wall_density rho2"), 1.25, 0.0025),
        (("3", "floating pipeline", "content_density rho3"), 0.83, 0.0006),
        (("4", "level 4 waves", "wave_period T"), 3.663, 0.0005),
        (("4", "level 4 waves", "wave_length L"), 19.90, 0.02),
        (("4", "level 4 waves", "wave_height H"), 1.25, 0.0002),
        (("eq 12", "all examples", "drag_coefficient C_D"), 1.2, 0.0001),
        (("eq 12", "all examples", "inertia_coefficient C_M"), 2.0, 0.0003),
        (("eq 11", "floating pipeline", "immersion_depth h"), 95.124, 0.0005),
        (("eq 11", "floating pipeline", "submerged_section_area S1"), 0.0090994, 5e-8),
        (("sec 5.1", "example of the Airy theory", "water_depth"), 6.0, 0.005),
        (("sec 5.2", "example of the Stokes theory", "water_depth"), 3.0, 0.0005),
        (("sec 3", "velocity and acceleration of the water", "elevation at which they are taken"),
         0.0, 0.11),
        (("8", "average", "P3 (horizontal, Stokes theory)"), 17.1345, 0.0001),
        (("8", "average", "P4 (vertical, Stokes theory)"), 14.1127, 0.0001),
        (("8", "average", "P2 (vertical, Airy theory)"), 10.0, 0.01),
    ],
    ids=lambda one: one[2] if isinstance(one, tuple) else "",
)  # fmt: skip
def test_what_is_recomputed(key, value, within):
    assert BY_KEY[key].recomputed == pytest.approx(value, abs=within)


# equations of Zhang (2015): factors and powers are whole numbers, to the last bits

ANSWERS = _equation_answers()
SPEED = ("eq 14", "wave number k", "divisor of 2 pi")


@pytest.mark.parametrize(
    "key", [key for key in ANSWERS if key != SPEED], ids=lambda key: " ".join(key)
)
def test_answers_are_exact(key):
    cell = table_of("Zhang-2015", key[0])[key[1:]]
    assert ANSWERS[key].value == pytest.approx(cell.value, rel=1e-12)


def test_the_wave_number_is_that_of_the_length():
    # 5.6 m/s over 3.57 s; a period in its place would be off by 16 m
    assert ANSWERS[SPEED].value == pytest.approx(19.992, abs=1e-9)
    assert ANSWERS[SPEED].tolerance == pytest.approx(0.1785, abs=1e-4)


# tables 5 to 8 of Zhang (2015): what the two kinematics of the vertical Airy loads do

ANSWERS_OF_WAVES = _table_answers()
CELLS = [cell for cell in cells_of("Zhang-2015") if cell.table == "7"]
HALF_A_HUNDREDTH = 0.005 * (1 + 1e-9)


def test_there_is_one_answer_for_each_cell_of_the_tables():
    tables = {cell.key for cell in cells_of("Zhang-2015") if cell.table in ("5", "6", "7", "8")}
    assert ANSWERS_OF_WAVES.keys() == tables


def test_every_load_difference_and_ratio_comes_back_to_the_digit_but_for_two_kinematics():
    for cell in CELLS:
        if cell.row.startswith("Airy") and cell.column.startswith("vertical"):
            continue
        assert abs(ANSWERS_OF_WAVES[cell.key].value - number_of(cell.printed)) <= HALF_A_HUNDREDTH


@pytest.mark.parametrize(("column", "which"), [("load F0", "classic"), ("load F1", "improved")])
def test_vertical_airy_loads_come_back_with_the_velocity_of_their_own_column(column, which):
    wave = replace(printed_airy_wave(which), angular_frequency=2 * pi / 3.57)
    rows = [c for c in CELLS if c.row.startswith("Airy") and c.column == f"vertical {column}"]
    time = np.array([float(cell.row.partition("t = ")[2].removesuffix(" s")) for cell in rows])
    load = wave_load(
        wave, printed_section(), time, drag_coefficient=1.2, inertia_coefficient=2.0,
        water_density=1030.0, vertical_width="immersion depth",
    )  # fmt: skip
    found = load.vertical_classic if which == "classic" else load.vertical
    printed = [number_of(cell.printed) for cell in rows]
    assert np.max(np.abs(found - printed)) <= HALF_A_HUNDREDTH


def test_with_one_velocity_the_ratio_at_large_loads_is_twice_the_printed_one():
    for seconds, printed in (("0.90", 8.50), ("2.70", 8.47), ("4.50", 8.44)):
        key = ("7", f"Airy theory, t = {seconds} s", "vertical ratio P")
        assert 16.6 <= ANSWERS_OF_WAVES[key].value <= 16.8
        assert ANSWERS_OF_WAVES[key].value > 1.9 * printed


def test_printed_averages_of_table_8_leave_out_one_row():
    for column, of_all, printed in (("horizontal", 17.1345, 15.26), ("vertical", 14.1127, 14.01)):
        ratios = {
            cell.row: number_of(cell.printed)
            for cell in CELLS
            if cell.row.startswith("Stokes") and cell.column == f"{column} ratio P"
        }
        assert np.mean(list(ratios.values())) == pytest.approx(of_all, abs=5e-5)
        del ratios["Stokes theory, t = 4.00 s"]
        assert np.mean(list(ratios.values())) == pytest.approx(printed, abs=0.005)
