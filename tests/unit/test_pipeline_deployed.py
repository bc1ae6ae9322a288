"""A deployed assembly of springs of a known law: 400 e + 80 e^3 N on the free length."""

import numpy as np
import pytest
from assemblies import DRIVEN, RUBBER

from reduction.lines.assembly import SeriesPart, WorkingLevel, deploy
from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import StrainModel, position_by_model

CURVE = RUBBER.curve
LEVEL = WorkingLevel("strain", 1.0)


def test_a_strain_a_length_and_a_tension_name_the_same_point():
    by_strain = deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL]).working[0]
    assert float(by_strain.point.mean_tension) == pytest.approx(4 * 480, rel=1e-3)
    assert by_strain.strain == pytest.approx([1.0] * 4)
    length, tension = float(by_strain.point.total_length), float(by_strain.point.mean_tension)
    assert length == pytest.approx(
        float(position_by_model(DRIVEN, strain=1.0, tension=480.0)), rel=1e-3
    )
    for level in (WorkingLevel("total_length", length), WorkingLevel("tension", tension)):
        found = deploy(CURVE, DRIVEN, n_tethers=4, levels=[level]).working[0]
        assert float(found.point.mean_tension) == pytest.approx(tension, rel=1e-9)
        assert float(found.point.total_length) == pytest.approx(length, rel=1e-9)


def test_stiffness_is_the_slope_over_the_slack_length():
    """Springs without splices of 100 N in 2 m, and 1 m of bridle: 3 x 50 N/m over 3 m."""
    from_line = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
    straight = deploy(
        CURVE, from_line, n_tethers=3, parts=[SeriesPart("bridle", 1.0)],
        levels=[WorkingLevel("strain", 0.02)],
    )  # fmt: skip
    # below the first piece the curve is a straight line of 400 + 80 * 0.1**2
    slope = 3 * 400.8 / 2.0
    low = straight.assembly.tension < 3 * 20
    assert straight.apparent_spring_constant[low] == pytest.approx(slope * 3.0, rel=1e-6)
    assert straight.strain == pytest.approx(straight.assembly.total_length / 3.0 - 1)
    assert not straight.working[0].point.is_tested
    assert straight.free_length == (2.0,) * 3


def test_the_tolerance_moves_loads_about_the_equal_one():
    found = deploy(
        CURVE, DRIVEN, n_tethers=4, levels=[LEVEL], tolerance=0.01, rated_break_strength=4800.0
    ).working[0]
    assert found.sharing.least_load < 480 < found.sharing.greatest_load
    assert found.point.peak_share == pytest.approx([0.1] * 4, rel=1e-3)
    assert deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL]).working[0].sharing is None


def test_lengths_of_their_own_make_unequal_tethers():
    found = deploy(CURVE, DRIVEN, n_tethers=2, free_lengths=(3.0, 3.3), levels=[])
    assert found.free_length == pytest.approx((3.0, 3.3))
    assert np.diff(found.assembly.slack_length) == pytest.approx([0.3], rel=1e-3)


def test_splices_beyond_their_marks_are_told():
    marked = StrainModel("T", "tension-driven", DRIVEN.coefficients, tension_high=500.0)
    notes = deploy(CURVE, marked, n_tethers=2).notes
    assert any("the splices were marked up to 500 N a tether" in note for note in notes)
    # one tether ends at 2250 N, the two of them at twice that
    enough = StrainModel("T", "tension-driven", DRIVEN.coefficients, tension_high=3000.0)
    assert not any("marked up to" in note for note in deploy(CURVE, enough, n_tethers=2).notes)


@pytest.mark.parametrize(
    ("level", "told"),
    [
        (WorkingLevel("total_length", 3.0), "working.2: the assembly is slack at this total length"),
        (WorkingLevel("total_length", 2.55 + 1.19), "working.2: the assembly is slack"),
        (WorkingLevel("total_length", 30.0), "working.2: the assembly is beyond its curve"),
        (WorkingLevel("strain", 2.6), "beyond its curve at this strain; found 2.6 of the free length"),
        (WorkingLevel("tension", 1e6), "working.2: the peak tension is beyond the curves"),
        (WorkingLevel("tension", 500.0, 600.0), "working.2: "),
    ],
)  # fmt: skip
def test_a_level_that_is_none_is_named_by_its_place(level, told):
    with pytest.raises(DataError, match=told):
        deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL, level])


def test_the_secant_is_over_five_percent_of_the_length_to_each_side():
    """2 m of it at 4 m: strains 0.9 and 1.1, 418.32 and 546.48 N, so 128.16 N in 0.4 m over 2 m."""
    model = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
    found = deploy(CURVE, model, n_tethers=1, levels=[LEVEL, WorkingLevel("strain", 1.0, 50.0)])
    still, cycled = found.working
    assert still.secant_spring_constant == pytest.approx(640.8, rel=2e-3)
    at = np.interp(4.0, found.assembly.total_length, found.secant_spring_constant)
    assert at == pytest.approx(640.8, rel=2e-3)
    assert cycled.secant_spring_constant == float(cycled.point.apparent_spring_constant)
    assert not found.assembly.is_moved.any() and not still.is_moved
