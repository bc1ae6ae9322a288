import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import (
    StrainModel,
    position_by_model,
    strain_by_model,
    with_free_length,
)

TENSION = np.array([0.0, 40.0, 300.0, 1200.0])
POSITION = np.array([3.74, 5.1, 6.6, 11.0])
DRIVEN = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.19,
    "splice_compliance": 0.00113,
    "splice_exponent": 0.86,
}
RATIO = {"relaxed_free_length": 2.55, "relaxed_splice_length": 1.19, "splice_strain_ratio": 0.23}
MODELS = [
    StrainModel("T", "tension-driven", DRIVEN),
    StrainModel("T", "strain-ratio", RATIO),
    StrainModel(
        "T",
        "marks",
        {"free_length_intercept": -0.8, "free_length_slope": 0.9, "relaxed_free_length": 2.5},
    ),
    StrainModel("T", "constant-fraction", {"free_fraction": 0.777, "relaxed_free_length": 2.55}),
    StrainModel("T", "gauge-length", {"reference_position": 3.74, "gauge_length": 3.74}),
]


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.method)
def test_length_and_strain_are_inverse_by_every_method(model):
    strain = strain_by_model(model, position=POSITION, tension=TENSION)
    back = position_by_model(model, strain=strain, tension=TENSION)
    np.testing.assert_allclose(back, POSITION, rtol=1e-13)


def test_splices_stretch_by_the_tension_they_carry():
    found = position_by_model(MODELS[0], strain=[0.0, 1.0], tension=[0.0, 400.0])
    by_hand = 2.55 * 2.0 + 1.19 * (1 + 0.00113 * 400.0**0.86)
    assert found == pytest.approx([3.74, by_hand], rel=1e-12)


def test_splices_that_saturate_stretch_to_their_limit():
    saturating = StrainModel("T", "mixed", {
        "relaxed_free_length": 2.55, "relaxed_splice_length": 1.19, "splice_offset": 0.0,
        "splice_strain_ratio": 0.0, "splice_strain_curvature": 0.0, "splice_strain_cubic": 0.0,
        "splice_compliance": 0.0, "splice_exponent": 1.0, "splice_limit": 0.25,
        "splice_saturation": 1 / 300.0,
    })  # fmt: skip
    found = position_by_model(saturating, strain=[0.0, 1.0, 1.0], tension=[0.0, 300.0, 1e5])
    by_hand = 2.55 * 2.0 + 1.19 * (1 + 0.25 * np.array([1 - np.exp(-1.0), 1.0]))
    assert found == pytest.approx([3.74, *by_hand], rel=1e-12)
    back = strain_by_model(saturating, position=found, tension=[0.0, 300.0, 1e5])
    assert back == pytest.approx([0.0, 1.0, 1.0], abs=1e-12)


def test_one_strain_at_several_tensions_is_several_lengths():
    found = position_by_model(MODELS[0], strain=1.0, tension=TENSION)
    assert found.shape == (4,)
    assert (np.diff(found) > 0).all()


def test_an_extensometer_knows_no_length():
    with pytest.raises(DataError, match="from an extensometer, which does not know the length"):
        position_by_model(StrainModel("T", "extensometer"), strain=1.0, tension=0.0)


@pytest.mark.parametrize("index", [0, 1])
def test_a_longer_tether_has_the_same_splices(index):
    longer = with_free_length(MODELS[index], 10.0)
    added = position_by_model(longer, strain=1.0, tension=400.0) - position_by_model(
        MODELS[index], strain=1.0, tension=400.0
    )
    assert added == pytest.approx(2 * (10.0 - 2.55))
    assert "measured on a different free length: 10 m" in str(longer.notes[-1])


def test_a_gauge_length_scales_with_where_it_begins():
    longer = with_free_length(MODELS[4], 7.48)
    assert position_by_model(longer, strain=0.5, tension=0.0) == pytest.approx(1.5 * 7.48)
    displaced = StrainModel("T", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
    assert position_by_model(with_free_length(displaced, 4.0), strain=0.5, tension=0.0) == 2.0


@pytest.mark.parametrize("index", [2, 3])
def test_methods_that_hold_for_one_length_are_refused_another(index):
    with pytest.raises(DataError, match="holds for the length that was tested"):
        with_free_length(MODELS[index], 10.0)


def test_a_length_is_positive():
    with pytest.raises(DataError, match="free_length are not positive"):
        with_free_length(MODELS[0], 0.0)
