"""Records and marks check themselves once and cannot be changed after."""

import math

import numpy as np
import pytest
from refusals import refusals

from reduction.record.arrays import as_finite, as_increasing, as_positive, as_same_shape, as_spread
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Record, Specimen, SpliceMarks, areas_of


def record(**changed):
    fields = {
        "test_id": "T",
        "specimens": ("a",),
        "time": np.arange(3.0),
        "crosshead_position": np.ones(3),
        "tension": np.ones((1, 3)),
        "quality_flag": np.zeros((1, 3), np.uint16),
        "crosshead_position_quality_flag": np.zeros(3, np.uint16),
    }
    return Record(**(fields | changed))


def test_arrays_of_a_record_cannot_be_written():
    with pytest.raises(ValueError, match="read-only"):
        record().time[0] = 1.0


def test_area_uses_the_mean_of_the_readings():
    specimen = Specimen("a", diameter=(1.0, 3.0))
    assert specimen.area == pytest.approx(math.pi)


def test_the_used_tether_has_the_area_of_its_printed_diameter():
    """WHOI-2005-10, Table 2: 0.94 in, and so 0.694 in2."""
    specimen = Specimen("used", diameter=(0.94 * 0.0254,))
    assert round(specimen.area / 0.0254**2, 3) == 0.694


def test_a_specimen_without_a_diameter_has_no_area():
    with pytest.raises(DataError, match=r"specimen 'a' has no diameter.*specimens\.a\.diameter"):
        _ = Specimen("a").area


def test_a_rope_without_a_diameter_has_no_area_and_rubber_is_refused():
    rope = Specimen("a", kind="rope")
    assert np.isnan(areas_of((rope,))).all()
    assert areas_of((Specimen("b", kind="rope", diameter=(2.0,)),)) == pytest.approx(math.pi)
    with pytest.raises(DataError, match="'c' has no diameter"):
        areas_of((rope, Specimen("c", kind="rubber tether")))


@pytest.mark.parametrize(
    ("kind", "is_rubber", "is_rope"),
    [
        ("rubber tether", True, False),
        ("elastomer", True, False),
        ("stretch hose", False, False),
        ("rope", False, True),
        ("wire", False, True),
    ],
)
def test_laws_of_rubber_and_programmes_of_ropes_are_not_for_a_hose(kind, is_rubber, is_rope):
    one = Specimen("a", kind=kind)
    assert (one.is_rubber, one.is_rope) == (is_rubber, is_rope)
    if not is_rubber:
        assert np.isnan(areas_of((one,))).all()


def test_a_mark_row_that_contradicts_itself_is_refused_with_its_test_and_hold():
    with pytest.raises(DataError, match="1 of 1 mark rows of 'a'.*first test T-1, hold max"):
        SpliceMarks("a", ("T-1",), ("max",), np.array([2.0]), np.array([1.0]), np.array([3.0]))


# checks name the count, the first index and the value


def test_finite_refuses_with_count_and_first_index():
    with pytest.raises(DataError, match="2 of 4 values of strain are not finite, first at index 1"):
        as_finite("strain", [1.0, np.nan, np.inf, 2.0])
    assert as_finite("strain", 3).dtype == np.float64


def test_increasing_refuses_a_plateau_and_a_matrix():
    with pytest.raises(DataError, match="first at index 2; found 2"):
        as_increasing("time", [1.0, 2.0, 2.0])
    with pytest.raises(DataError, match="time is not a series"):
        as_increasing("time", np.ones((2, 2)))


@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf])
def test_a_standard_uncertainty_is_zero_or_more(value):
    with pytest.raises(SettingsError, match="standard uncertainty of bore cannot be used; found"):
        as_spread("bore", value)
    assert as_spread("bore", 0.0) == 0.0


REFUSED = {
    "a channel of another length is refused": (
        lambda: record(tension=np.ones((1, 4))),
        DataError,
        r"tension does not fit the record; found \(1, 4\); needed",
    ),
    "positive refuses zero": (
        lambda: as_positive("area", [1.0, 0.0]),
        DataError,
        "1 of 2 values of area are not positive.*found 0",
    ),
    "shapes must pair up": (
        lambda: as_same_shape(a=[1, 2], b=[1, 2, 3]),
        DataError,
        r"found a \(2,\), b \(3,\)",
    ),
}


test_refusals = refusals(REFUSED)
