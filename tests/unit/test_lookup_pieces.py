import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.lines.composite import (
    CurvePiece,
    _composite_curve,
    piece_of_steps,
    pieces_of_branches,
)
from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import StepReadings
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.uncertainty.propagation import stepwise_contributions

TABLE_4 = Path(__file__).parents[1] / "golden" / "whoi_2005_10_table_4.csv"
INCH, LBF = 0.0254, 4.4482216152605


def pieces(ascending, descending, **asked):
    load = np.array([ascending, descending], dtype=float)
    strain = 0.1 * (1 + np.arange(load.shape[1]))
    return pieces_of_branches(strain, load, np.ones_like(load), name="T", **asked)


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
    assert up.random_standard_uncertainty / up.tension == pytest.approx(share, rel=0.05)


def test_the_static_test_alone_gives_85_pounds_at_a_stretch_of_100_percent_within_3_percent():
    curve = _composite_curve([piece_of_steps(table_4(), name="1997")])
    assert curve.tension_at(1.0) / LBF == pytest.approx(85, rel=0.03)  # sec. 2.3.2 prints 85


def test_a_gap_parts_a_branch_into_pieces_and_slack_is_left_out():
    found = pieces([-1, 2, 3, np.nan, 5, 6, np.nan, 8], 8 * [1.0], branch="ascending")
    assert [one.tension.tolist() for one in found] == [[2, 3], [5, 6]]
    assert found[0].strain == pytest.approx([0.2, 0.3])


def test_the_mean_of_both_branches_stands_where_both_do():
    (found,) = pieces([10, 20, 30], [np.nan, 16, 28])
    assert found.tension.tolist() == [18, 29]
    assert found.random_standard_uncertainty == pytest.approx(np.sqrt(2) / 2)


def test_a_first_rise_has_one_branch():
    with pytest.raises(SettingsError, match="a first rise only rises"):
        pieces([1, 2], [1, 2], kind="first-loading")


@pytest.mark.parametrize(
    ("strain", "tension", "spread", "message"),
    [
        ([0.1, 0.1], [1, 2], [0, 0], "not above the one before"),
        ([0.1], [1], [0], "is not a curve"),
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


CELL, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")


def test_the_mean_of_two_branches_keeps_a_gain_whole_and_loses_a_lag():
    """A gain is in both branches with one sign, a lag with two; scatter is less by a root of 2."""
    load = np.array([[10.0, 20.0, 30.0], [6.0, 18.0, 30.0]])
    rows = np.stack([0.1 * load, np.array([[-1.0] * 3, [1.0] * 3])])
    shared = Contributions((CELL, CLOCK), {"tension": rows})
    at = [0.1, 0.2, 0.3]
    given = {"name": "T", "shared": shared}
    (mean,) = pieces_of_branches(at, load, np.ones((2, 3)), **given)
    assert mean.contribution[0] == pytest.approx(0.1 * mean.tension)
    assert mean.contribution[1] == pytest.approx(np.zeros(3))
    assert mean.random_standard_uncertainty == pytest.approx(np.full(3, np.sqrt(2) / 2))
    (down,) = pieces_of_branches(at, load, np.ones((2, 3)), branch="descending", **given)
    assert down.component == (CELL, CLOCK)
    assert down.contribution[1] == pytest.approx(np.ones(3))


def test_a_point_of_which_nothing_shared_is_known_stays_in_the_piece():
    rows = np.full((1, 2, 3), 0.5)
    rows[0, 0, 1] = np.nan
    shared = Contributions((CELL,), {"tension": rows})
    load = [[10.0, 20.0, 30.0]] * 2
    (up,) = pieces_of_branches(
        [0.1, 0.2, 0.3], load, np.ones((2, 3)), name="T", branch="ascending", shared=shared
    )
    assert up.contribution.tolist() == [[0.5, 0.0, 0.5]]


def test_contributions_have_to_fit_the_piece():
    at = np.array([0.1, 0.2])
    with pytest.raises(
        DataError, match="contributions to T do not fit.*found shape .1, 3.; needed"
    ):
        CurvePiece("T", "cyclic", "mean", at, at, 0 * at, (CELL,), np.ones((1, 3)))


def test_weights_that_are_heavier_than_they_say_move_the_static_piece_and_a_diameter_does_not():
    steps = table_4()
    area = np.pi / 4 * INCH**2
    errors = InstrumentErrors("1997", tension_gain=0.01, diameter=0.02 * INCH)
    up = piece_of_steps(steps, name="1997", shared=stepwise_contributions(steps, errors, area=area))
    rows = {one.source: row for one, row in zip(up.component, up.contribution, strict=True)}
    assert rows["tension_gain"] == pytest.approx(0.01 * up.tension)
    assert "diameter" not in rows
    # a longer gauge length is less strain at one tension: the chord has more tension at one strain
    relative = steps.gauge_length_standard_uncertainty / steps.gauge_length
    assert rows["gauge_length"] == pytest.approx(
        up.tension * (1 + up.strain) / up.strain * relative
    )


def test_branches_have_to_fit_their_grid():
    with pytest.raises(DataError, match="not that of two branches on the grid"):
        pieces_of_branches([0.1, 0.2], [1.0, 2.0], [0.1, 0.1], name="T")
    with pytest.raises(DataError, match="strain are not above the one before"):
        pieces_of_branches([0.2, 0.1], [[1.0, 2.0]] * 2, [[0.1, 0.1]] * 2, name="T")
