import numpy as np
import pytest

from reduction.errors import DataError
from reduction.lookup.cyclepiece import piece_of_cycles


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
    assert np.median(one.random_standard_uncertainty) == pytest.approx(0.1 / np.sqrt(50), rel=0.15)


def test_too_few_samples_are_refused():
    with pytest.raises(DataError, match="cycles 1 to 2 of T are too few samples for 50 bins"):
        piece_of_cycles([0.1], [1.0], [1], [1], name="T", cycles=(1, 2))


def test_cycles_of_the_other_branch_alone_give_no_curve():
    at = np.linspace(0.5, 1.0, 300)
    with pytest.raises(DataError, match="T is no curve"):
        piece_of_cycles(at, at, np.ones(300), np.ones(300), name="T", cycles=(1, 1),
                        branch="descending")  # fmt: skip


def test_samples_that_stand_closer_on_one_side_of_a_bin_do_not_move_the_curve():
    strain = 0.5 + 0.5 * np.linspace(0, 1, 400) ** 3  # slow at the foot, as a crosshead starts
    ones = np.ones(400)
    piece = piece_of_cycles(strain, 200 * strain, ones, ones, name="T", cycles=(1, 1),
                            branch="ascending", n_bins=8)  # fmt: skip
    assert piece.tension == pytest.approx(200 * piece.strain, rel=1e-9)
