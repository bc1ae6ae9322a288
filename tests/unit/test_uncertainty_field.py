"""The field of errors: many points at once, and what the temperature leaves alone."""

from dataclasses import fields

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.error_field import error_field

MODEL = StrainModel(
    "new", "tension-driven",
    {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.2, "splice_compliance": 5e-4,
     "splice_exponent": 0.9},
    np.diag([1e-6, 2e-6, 1e-10, 1e-4]),
)  # fmt: skip
ERRORS = InstrumentErrors(
    "new", tension_gain=0.0025, tension_offset=2.0, position_gain=0.001, position_offset=0.003,
    strain_gain=0.002, stiffness=0.003,
)  # fmt: skip


def test_many_points_have_the_errors_that_each_has_alone():
    strain = np.linspace(0.3, 1.3, 9_002).reshape(2, -1)
    tension = 500 * strain
    tension[0, 3] = np.nan
    many = error_field(ERRORS, MODEL, strain=strain, tension=tension)
    for place in ((0, 0), (0, 3), (0, 4095), (0, 4096), (1, 4500)):
        one = error_field(ERRORS, MODEL, strain=strain[place], tension=tension[place])
        assert one.component == many.component
        for item in fields(one)[1:]:
            np.testing.assert_allclose(
                getattr(many, item.name)[..., place[0], place[1]], getattr(one, item.name),
                rtol=1e-6, atol=1e-15, err_msg=item.name,
            )  # fmt: skip


def test_no_point_has_an_empty_field():
    none = error_field(ERRORS, MODEL, strain=np.empty(0), tension=np.empty(0))
    assert none.tension.shape == none.strain_slope.shape == (len(none.component), 0)
    assert none.strain_by_tension.shape == (0,)


def test_a_point_without_stated_errors_has_no_components():
    bare = error_field(
        InstrumentErrors("new"), StrainModel("new", MODEL.method, MODEL.coefficients),
        strain=0.5, tension=300.0,
    )  # fmt: skip
    assert bare.component == () and bare.tension.shape == (0,)


@pytest.mark.parametrize(
    ("held", "moved", "left"), [("position", "tension", "strain"), ("tension", "strain", "tension")]
)
def test_temperature_moves_what_is_not_held(held, moved, left):
    warm = InstrumentErrors("new", stiffness=0.01, test="T-1")
    field = error_field(warm, StrainModel("new", MODEL.method, MODEL.coefficients),
                        strain=[0.5], tension=[300.0], held=held)  # fmt: skip
    assert [(one.source, one.of) for one in field.component] == [("temperature", "T-1")]
    size = {"tension": 3.0, "strain": -0.005}[moved]
    assert getattr(field, moved) == pytest.approx(np.array([[size]]))
    assert not getattr(field, left).any()
    # the energy of a loop goes up with the tension, down with the strain
    assert field.divergence == pytest.approx(0.01 if held == "position" else -0.01)
