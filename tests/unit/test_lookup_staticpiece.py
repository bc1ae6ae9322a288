from dataclasses import replace

import numpy as np
import pytest

from reduction.lines.composite import CurvePiece, mean_piece, piece_of_pull
from reduction.record.contributions import Component, Contributions
from reduction.record.errors import DataError


def branch(way, low, high, slope, spread=3.0):
    at = np.linspace(low, high, 5)
    return CurvePiece("T", "static", way, at, slope * at, np.full(5, spread))


def test_the_mean_of_two_branches_stands_where_both_were_read():
    mean = mean_piece(branch("ascending", 0.5, 2.0, 110), branch("descending", 0.8, 2.2, 90, 4.0))
    assert (mean.strain[0], mean.strain[-1]) == (0.8, 2.0)
    assert mean.tension == pytest.approx(100 * mean.strain)
    assert mean.random_standard_uncertainty == pytest.approx(
        np.full(mean.strain.size, 2.5)
    )  # 3, 4, 5
    assert (mean.kind, mean.branch) == ("static", "mean")


CELL, TAPE = Component("tension_gain", "cell"), Component("gauge_length", "new")


def test_what_both_ways_share_is_whole_in_their_mean_and_what_one_has_is_half():
    up, down = branch("ascending", 0.5, 2.0, 110), branch("descending", 0.8, 2.2, 90)
    up = replace(
        up, component=(CELL, TAPE), contribution=np.stack([0.1 * up.tension, 0 * up.tension + 4])
    )
    down = replace(down, component=(CELL,), contribution=0.1 * down.tension[None])
    mean = mean_piece(up, down)
    rows = dict(zip(mean.component, mean.contribution, strict=True))
    assert rows[CELL] == pytest.approx(0.1 * mean.tension)
    assert rows[TAPE] == pytest.approx(np.full(mean.strain.size, 2.0))


def test_a_cell_that_reads_high_makes_a_pull_stretch_too_little_and_its_tension_too_high():
    """Strain at a logged tension is 1 % less of its slope: tension at a strain is 1 % more."""
    load = np.array([100.0, 200.0, 300.0])
    strain = 1e-4 * load
    shared = Contributions((CELL,), {"strain": -0.01 * strain[None]})
    found = piece_of_pull(strain, load, np.full(3, 1e-4), name="Q", shared=shared)
    assert found.component == (CELL,)
    assert found.contribution == pytest.approx(0.01 * load[None])


def test_branches_that_do_not_overlap_have_no_mean():
    with pytest.raises(DataError, match="the branches of T do not overlap; found 0.5 to 1 and 1.2"):
        mean_piece(branch("ascending", 0.5, 1.0, 110), branch("descending", 1.2, 2.0, 90))


def test_a_pull_ends_where_its_cubic_turns_back():
    load = np.array([0.0, 100.0, 200.0, 300.0, 400.0])
    found = piece_of_pull([0.0, 0.01, 0.02, 0.019, 0.03], load, np.full(5, 1e-4), name="Q")
    assert found.tension == pytest.approx([100, 200])


def test_a_pull_of_one_point_is_no_curve():
    with pytest.raises(DataError, match="Q is not a curve; found 1 points"):
        piece_of_pull([0.01, np.nan], [100.0, 200.0], [1e-4, 1e-4], name="Q")


def test_a_fit_that_begins_below_zero_strain_begins_where_it_is_above():
    load = np.array([50.0, 100.0, 200.0])
    found = piece_of_pull([-0.001, 0.01, 0.02], load, np.full(3, 1e-4), name="Q")
    assert found.strain == pytest.approx([0.01, 0.02])
