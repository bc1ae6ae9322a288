import numpy as np
import pytest

from reduction.lines.export_line import LIFT, curve_from_zero, thin_curve
from reduction.record.errors import DataError


def test_chords_of_a_parabola_have_the_error_of_even_steps():
    """T = 100 e + 10 e^2 over n even steps: the chord is off by 10 h^2 / 4."""
    strain = np.linspace(0, 1, 5000)
    found = thin_curve(strain, 100 * strain + 10 * strain**2, most=30)
    assert found.strain.size == 30
    assert found.error == pytest.approx(2.5 / 29**2, rel=0.01)
    assert found.share == found.error / 110


def test_small_tensions_are_as_close_as_great_ones():
    """A line that locks up: 60 N where it works, 320 kN where it breaks."""
    strain = np.linspace(0, 1.2, 5000)
    tension = 300 * strain + 2e6 * np.maximum(strain - 0.8, 0) ** 2
    found = thin_curve(strain, tension, most=30)
    assert np.interp(0.2, found.strain, found.tension) == pytest.approx(60, rel=0.011)
    # no tension above a thousandth of the greatest is off by more than a hundredth
    off = np.abs(np.interp(strain, found.strain, found.tension) - tension)
    counted = tension > 1e-3 * tension[-1]
    assert (off[counted] / tension[counted]).max() <= found.local <= 0.01
    # and the top is as close as ever: 28 even steps of the parabola would be off by 102 N
    assert found.error < 2.5 * 2e6 * (0.4 / 28) ** 2 / 4


def test_where_few_points_cannot_hold_a_hundredth_both_errors_are_stated():
    strain = np.linspace(0, 1, 5000)
    found = thin_curve(strain, 100 * strain**3, most=5)
    off = np.abs(np.interp(strain, found.strain, found.tension) - 100 * strain**3)
    assert found.local == pytest.approx((off / np.maximum(100 * strain**3, 0.1)).max(), rel=1e-6)
    assert found.local > 0.01
    assert found.error == pytest.approx(off.max(), rel=1e-6)


def test_a_curve_with_few_points_is_kept():
    found = thin_curve([0, 0.1, 0.3], [0, 5, 9], most=30)
    np.testing.assert_array_equal(found.strain, [0, 0.1, 0.3])
    assert found.error == 0
    assert found.words == ""


def test_corners_are_found():
    strain = np.linspace(0, 1, 1001)
    tension = np.where(strain < 0.4, strain, 0.4 + 30 * (strain - 0.4))
    found = thin_curve(strain, tension, most=3)
    np.testing.assert_allclose(found.strain, [0, 0.4, 1])
    assert found.error < 1e-9


def test_slack_is_told_from_what_was_not_measured():
    strain, tension, words = curve_from_zero([0.1, 0.2, 0.5], [0.0, 0.0, 8.0])
    np.testing.assert_allclose(strain, [0, 0.2, 0.5])
    np.testing.assert_allclose(tension, [0, LIFT * 8 * 0.4, 8 * (1 + LIFT)])
    assert words.startswith("slack from zero to strain 0.2")
    assert "straight line" in curve_from_zero([0.1, 0.2], [1.0, 2.0])[2]


def test_negative_tension_before_the_line_comes_taut_is_left_out():
    strain, tension, _ = curve_from_zero([-0.1, 0.0, 0.2], [-3.0, 0.0, 8.0])
    np.testing.assert_array_equal(strain, [0, 0.2])
    np.testing.assert_array_equal(tension, [0, 8])


@pytest.mark.parametrize(
    ("strain", "tension", "message"),
    [
        ([0.1], [1.0], "fewer than two points"),
        ([0.1, 0.2], [1.0], "fewer than two points"),
        ([0.1, np.nan], [1.0, 2.0], "not numbers"),
        ([0.0, 0.2, 0.1], [0.0, 2.0, 1.0], "a loop cannot be exported"),
        ([0.0, 0.1, 0.2], [0.0, 2.0, 1.0], "reverses at 1 of 2 steps"),
        ([0.0, 0.2], [5.0, 8.0], "tension at zero strain"),
        ([0.1, 0.2], [0.0, 0.0], "ends at zero tension"),
    ],
)
def test_a_curve_that_no_code_can_take_is_refused(strain, tension, message):
    with pytest.raises(DataError, match=message):
        curve_from_zero(strain, tension)
