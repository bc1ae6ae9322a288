import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.hose_comparison import _input_draws

TRUTH = Truth()


def test_draws_see_the_cords_that_pick_up_earlier():
    below = np.array([TRUTH.pick_up_strain() - 0.02])
    known = {"wrap_angle": np.radians(0.5)}
    drawn = np.random.default_rng(3).normal(64, 0.5, 4000)
    spread = [TRUTH.but(wrap_angle=np.radians(a)).tension(below)[0] for a in drawn]
    exact = np.sqrt(np.mean((np.array(spread) - TRUTH.tension(below)[0]) ** 2))
    draws = _input_draws(TRUTH.design(), known, below, n_draws=4000)
    assert np.sqrt(np.mean(draws**2)) == pytest.approx(exact, rel=0.1)


def test_a_dead_length_is_not_drawn_below_zero():
    draws = _input_draws(TRUTH.design(), {"dead_length_share": 0.01}, np.array([0.5]), n_draws=200)
    assert draws.min() >= 0


def test_nothing_uncertain_is_no_draw():
    assert _input_draws(TRUTH.design(), {"wrap_angle": 0.0}, np.zeros(3), n_draws=5).shape == (0, 3)
