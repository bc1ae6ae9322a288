import numpy as np
import pytest

from reduction.lines.assembly import StatedSplices, _deployed_model, stated_model
from reduction.record.errors import DataError, SettingsError
from reduction.stages.strain.strain_model import StrainModel, position_by_model


def length(splices, strain, tension, free=10.0):
    return position_by_model(stated_model(splices, free, name="T"), strain=strain, tension=tension)


def test_without_splices_a_tether_is_its_rubber():
    assert length(StatedSplices(0.0), [0.0, 1.0], [0.0, 400.0]) == pytest.approx([10.0, 20.0])


def test_rigid_splices_keep_their_length():
    assert length(StatedSplices(1.2), [0.0, 1.0], [0.0, 400.0]) == pytest.approx([11.2, 21.2])


def test_splices_strain_by_a_share_of_the_rubber_or_by_tension():
    assert length(StatedSplices(1.2, strain_ratio=0.25), 2.0, 0.0) == pytest.approx(30 + 1.2 * 1.5)
    by_tension = StatedSplices(1.2, strain=0.4, at_tension=900.0, exponent=0.5)
    assert length(by_tension, 1.0, 225.0) == pytest.approx(20 + 1.2 * 1.2)  # half of 40 %


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"length": -1.0}, "length is not a number of a splice; found -1"),
        ({"length": 1.0, "strain_ratio": -0.1}, "strain_ratio is not a number"),
        ({"length": 1.0, "strain": 0.0, "at_tension": 9.0}, "strain is not a number"),
        ({"length": 1.0, "strain": 0.1, "at_tension": 0.0}, "at_tension is not a number"),
        ({"length": 1.0, "exponent": 2.0}, "exponent is not a number.*needed above 0, below 2"),
    ],
)
def test_numbers_that_no_splice_has_are_refused(keys, told):
    with pytest.raises(SettingsError, match=told):
        StatedSplices(**keys)


def test_a_tether_has_a_length():
    with pytest.raises(DataError, match="free_length"):
        stated_model(StatedSplices(1.0), 0.0, name="T")


def test_a_displacement_becomes_a_length_where_there_are_no_splices():
    tested = StrainModel("T", "gauge-length", {"reference_position": 0.3, "gauge_length": 2.0})
    for free, expected in ((None, 4.0), (5.0, 10.0)):
        model = _deployed_model(tested, free)
        assert position_by_model(model, strain=1.0, tension=0.0) == pytest.approx(expected)


def test_a_tested_tether_is_deployed_as_it_was_tested():
    tested = StrainModel("T", "marks", {"relaxed_free_length": 2.5})
    assert _deployed_model(tested, None) is tested
    with pytest.raises(DataError, match="holds for the length that was tested"):
        _deployed_model(tested, 5.0)


def test_an_extensometer_knows_no_splices():
    with pytest.raises(DataError, match="extensometer, which does not include splices"):
        _deployed_model(StrainModel("T", "extensometer"), np.float64(5.0))
