"""Tables 5 to 8 of Zhang (2015): what the two kinematics of the vertical Airy loads do."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from reduction.prediction.wave_load import wave_load
from reduction.published.printed_cells import cells_of, number_of
from reduction.published.zhang_2015 import _table_answers, printed_airy_wave, printed_section

ANSWERS = _table_answers()
CELLS = [cell for cell in cells_of("Zhang-2015") if cell.table == "7"]
HALF_A_HUNDREDTH = 0.005 * (1 + 1e-9)


def test_there_is_one_answer_for_each_cell_of_the_tables():
    tables = {cell.key for cell in cells_of("Zhang-2015") if cell.table in ("5", "6", "7", "8")}
    assert ANSWERS.keys() == tables


def test_every_load_difference_and_ratio_comes_back_to_the_digit_but_for_two_kinematics():
    for cell in CELLS:
        if cell.row.startswith("Airy") and cell.column.startswith("vertical"):
            continue
        assert abs(ANSWERS[cell.key].value - number_of(cell.printed)) <= HALF_A_HUNDREDTH


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
        assert 16.6 <= ANSWERS[key].value <= 16.8
        assert ANSWERS[key].value > 1.9 * printed


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
