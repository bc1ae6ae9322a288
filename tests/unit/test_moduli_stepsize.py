"""Sizes of known steps in a series."""

import numpy as np
import pytest

from reduction.stages.moduli.splice_slip import _ramp_of, _SlipStep, _step_sizes


def test_the_size_of_a_step_in_another_series_is_free_of_its_neighbours():
    steps = tuple(_SlipStep(onset, 1, onset, onset, onset, 1.0, 0.0, 0.0) for onset in (100, 130))
    series = -2.0 * _ramp_of(300, onset=100, extent=1) - 5.0 * _ramp_of(300, onset=130, extent=1)
    size, uncertainty = _step_sizes(series + 0.01 * np.arange(300), steps)
    np.testing.assert_allclose(size, [-2, -5], atol=1e-9)
    np.testing.assert_allclose(uncertainty, 0, atol=1e-9)


def test_a_size_is_uncertain_by_the_share_that_the_shape_is():
    step = _SlipStep(100, 1, 100, 100, 100, 2.0, 0.5, 0.0)
    size, uncertainty = _step_sizes(-8.0 * _ramp_of(200, onset=100, extent=1), (step,))
    assert size == pytest.approx([-8])
    assert uncertainty == pytest.approx([8 * 0.5 / 2])


def test_no_steps_have_no_sizes():
    size, uncertainty = _step_sizes(np.arange(50.0), ())
    assert size.shape == uncertainty.shape == (0,)
