"""Records and marks check themselves once and cannot be changed after."""

import math

import numpy as np
import pytest

from reduction.record.errors import DataError
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


def test_a_channel_of_another_length_is_refused():
    with pytest.raises(DataError, match=r"tension does not fit the record; found \(1, 4\); needed"):
        record(tension=np.ones((1, 4)))


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
