import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.errors import DataError, SettingsError
from reduction.lookup.composite import composite_curve
from reduction.lookup.pieces import CurvePiece, piece_of_cycles, piece_of_steps, pieces_of_curves
from reduction.moduli.product import ModulusCurves
from reduction.moduli.stepwise import reduce_stepwise
from reduction.record import StepReadings

TABLE_4 = Path(__file__).parents[1] / "golden" / "whoi_2005_10_table_4.csv"
INCH, LBF = 0.0254, 4.4482216152605


def curves(ascending, descending, spread=1.0):
    load = np.array([[ascending, descending]], dtype=float)
    none, zeros = np.empty(0), np.zeros_like(load)
    bins = 0.1 * (1 + np.arange(load.shape[2]))
    return ModulusCurves(
        bins, none, 0.1, *5 * (zeros,), zeros, zeros, zeros, load, zeros + spread, none, none, none
    )


def table_4():
    with open(TABLE_4, encoding="utf-8") as lines:
        rows = list(csv.reader(line for line in lines if line[0] != "#"))[1:]
    weight, length, elongation, eye = np.array([row[1:5] for row in rows], dtype=float).T
    readings = StepReadings(
        clock=tuple(row[0] for row in rows),
        time=900.0 * np.arange(len(rows)),
        tension=LBF * weight,
        length=INCH * length,
        eye_to_eye_length=INCH * eye,
        printed_strain=elongation / 100,
        length_standard_uncertainty=0.02 * INCH,
    )
    return reduce_stepwise(readings, area=np.pi / 4 * INCH**2)


def test_static_branches_of_table_4_leave_the_row_out_that_contradicts_itself():
    up = piece_of_steps(table_4(), name="1997")
    down = piece_of_steps(table_4(), name="1997", branch="descending")
    assert up.tension / LBF == pytest.approx([51, 74, 97, 119, 141, 163, 185, 208])
    assert 100 * up.strain == pytest.approx([52, 86, 111, 135, 157, 175, 194, 210], abs=0.7)
    assert down.tension / LBF == pytest.approx([51, 97, 119, 141, 163, 185])  # without 74 lb
    # 0.02 in on 3.2 to 12.9 in of elongation, and the tension goes with it by the secant
    share = 0.02 / (6.125 * up.strain)
    assert up.standard_uncertainty / up.tension == pytest.approx(share, rel=0.05)


def test_the_static_test_alone_gives_85_pounds_at_a_stretch_of_100_percent_within_3_percent():
    curve = composite_curve([piece_of_steps(table_4(), name="1997")])
    assert curve.tension_at(1.0) / LBF == pytest.approx(85, rel=0.03)  # sec. 2.3.2 prints 85


def test_a_gap_parts_a_branch_into_pieces_and_slack_is_left_out():
    found = pieces_of_curves(
        curves([-1, 2, 3, np.nan, 5, 6, np.nan, 8], 8 * [1.0]), 0, name="T", branch="ascending"
    )
    assert [one.tension.tolist() for one in found] == [[2, 3], [5, 6]]
    assert found[0].strain == pytest.approx([0.2, 0.3])


def test_the_mean_of_both_branches_stands_where_both_do():
    (found,) = pieces_of_curves(curves([10, 20, 30], [np.nan, 16, 28]), 0, name="T")
    assert found.tension.tolist() == [18, 29]
    assert found.standard_uncertainty == pytest.approx(np.sqrt(2) / 2)


def test_a_first_rise_has_one_branch():
    with pytest.raises(SettingsError, match="a first rise only rises"):
        pieces_of_curves(curves([1, 2], [1, 2]), 0, name="T", kind="first-loading")


def test_cycles_can_be_chosen_and_give_the_tension_of_their_law():
    rng = np.random.default_rng(3)
    cycle = np.repeat([1, 2, 3], 2000)
    up = np.tile(np.repeat([1, 2], 1000), 3)
    strain = np.tile(np.concatenate([np.linspace(0.5, 1, 1000), np.linspace(1, 0.5, 1000)]), 3)
    # softens cycle by cycle; the way down is 4 N below
    tension = (110 - 10 * cycle) * strain**2 - 4.0 * (up == 2) + rng.normal(0, 0.1, strain.size)
    (one, last, mean) = (
        piece_of_cycles(strain, tension, cycle, up, name="T", cycles=pair, branch=way, n_bins=20)
        for pair, way in (((1, 1), "ascending"), ((3, 3), "descending"), ((2, 3), "mean"))
    )
    assert one.tension == pytest.approx(100 * one.strain**2, abs=0.12)
    assert last.tension == pytest.approx(80 * last.strain**2 - 4, abs=0.12)
    assert mean.tension == pytest.approx(85 * mean.strain**2 - 2, abs=0.12)
    # 50 samples of 0.1 N in a bin
    assert np.median(one.standard_uncertainty) == pytest.approx(0.1 / np.sqrt(50), rel=0.15)


def test_too_few_samples_are_refused():
    with pytest.raises(DataError, match="cycles 1 to 2 of T are too few samples for 50 bins"):
        piece_of_cycles([0.1], [1.0], [1], [1], name="T", cycles=(1, 2))


def test_cycles_of_the_other_branch_alone_give_no_curve():
    at = np.linspace(0.5, 1.0, 300)
    with pytest.raises(DataError, match="T is no curve"):
        piece_of_cycles(at, at, np.ones(300), np.ones(300), name="T", cycles=(1, 1),
                        branch="descending")  # fmt: skip


@pytest.mark.parametrize(
    ("strain", "tension", "spread", "message"),
    [
        ([0.1, 0.1], [1, 2], [0, 0], "not above the one before"),
        ([0.1], [1], [0], "is no curve"),
        ([0.0, 0.1], [1, 2], [0, 0], "points that are slack"),
        ([0.1, 0.2], [0, 2], [0, 0], "points that are slack"),
        ([0.1, 0.2], [1, np.nan], [0, 0], "not finite"),
        ([0.1, 0.2], [1, 2], [0, np.nan], "not finite"),
        ([0.1, 0.2], [1, 2], [0, -1], "is negative"),
        ([0.1, 0.2], [1, 2], [0], "do not pair up"),
    ],
)
def test_what_is_no_curve_is_refused(strain, tension, spread, message):
    arrays = [np.array(one, dtype=float) for one in (strain, tension, spread)]
    with pytest.raises(DataError, match=message):
        CurvePiece("T", "cyclic", "mean", *arrays)
