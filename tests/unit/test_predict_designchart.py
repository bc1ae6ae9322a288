"""Charts to choose a wrap angle by."""

import numpy as np
import pytest

from reduction.prediction.hose_geometry import NEUTRAL_ANGLE, cord_strain_chart
from reduction.record.errors import DataError

ANGLE = np.radians([40.0, 54.0, 60.0, 64.0, 68.0, 72.0])


@pytest.mark.parametrize("dead", [0.0, 0.1])
def test_the_way_back_is_on_the_curves(dead):
    walk = np.linspace(0, 3, 60001)
    chart = cord_strain_chart(ANGLE, walk, dead_length_share=dead)
    assert chart.cord_strain.shape == (6, 60001)
    for angle, back in zip(ANGLE, chart.pick_up_strain, strict=True):
        again = cord_strain_chart([angle], [back], dead_length_share=dead)
        assert again.cord_strain == pytest.approx(0, abs=1e-14)


def test_no_cord_is_slack_at_or_below_the_neutral_angle():
    angle = np.append(ANGLE, NEUTRAL_ANGLE)
    chart = cord_strain_chart(angle, np.linspace(0, 1, 11))
    assert np.all((chart.pick_up_strain > 0) == (angle > NEUTRAL_ANGLE))


def test_a_hose_that_is_dead_throughout_is_refused():
    with pytest.raises(DataError, match="dead_length_share is not a share; found 1"):
        cord_strain_chart([1.0], [0.1], dead_length_share=1.0)
