import numpy as np
import pytest
from assemblies import RUBBER, curve_of, spring

from reduction.lines.assembly import (
    SeriesPart,
    _assemble,
    _equal_tethers,
    _span_loads,
    _Tether,
    _unequal_tethers,
)
from reduction.record.errors import DataError, SettingsError
from reduction.stages.strain.strain_model import StrainModel


def test_springs_side_by_side_and_in_line_follow_hooke():
    wire = SeriesPart("wire", 5.0, spring_constant=1e4)
    assembly = _assemble(_equal_tethers(spring(2.0), 4), [wire, SeriesPart("shackles", 0.3)])
    tension = np.array([0.0, 40.0, 400.0, 900.0])
    by_hand = 2 * (1 + tension / 400) + 5 * (1 + tension / 1e4) + 0.3
    assert assembly.length_at(tension) == pytest.approx(by_hand, rel=1e-9)
    assert assembly.tension_at(by_hand) == pytest.approx(tension, rel=1e-6, abs=1e-9)
    assert assembly.slack_length == pytest.approx([7.3] * 4)
    assert assembly.n_tethers == 4


def test_splices_are_put_back_with_the_tension_of_each_tether():
    assembly = _assemble(_equal_tethers(RUBBER, 6))
    each = 400 + 80.0  # at a strain of 1
    length = 2.55 * 2 + 1.19 * (1 + 0.00113 * each**0.86)
    assert assembly.tension_at(length) == pytest.approx(6 * each, rel=1e-4)
    assert assembly.loads_at(6 * each) == pytest.approx(np.full(6, each))


def test_a_rope_in_line_is_a_curve_and_ends_the_assembly_where_it_ends():
    rope = SeriesPart("rope", 10.0, curve=curve_of(lambda at: 3000 * at, low=0.01, high=0.1))
    assembly = _assemble([spring(constant=200.0, high=2.0)], [rope])
    assert assembly.length_at(150.0) == pytest.approx(1.75 + 10.5)
    assert assembly.tension[-1] <= 300
    assert assembly.tension[-1] == pytest.approx(300, rel=0.01)


def test_a_cycle_about_a_length_is_a_small_part_of_the_curve_of_a_rope_too():
    """T = 4e5 e + 6e6 e^2 to 6 %: 5 % to each side was the whole curve, at every length."""
    law = curve_of(lambda at: 4e5 * at + 6e6 * at**2, low=0.001, high=0.06, n=600)
    model = StrainModel("T", "gauge-length", {"reference_position": 50.0, "gauge_length": 50.0})
    assembly = _assemble([_Tether(law, model)])
    low, high = (float(one) for one in _span_loads(assembly, np.array(50 * 1.02)))
    slope = 50 * (high - low) / (2 * assembly.span_share * 50 * 1.02)
    assert slope == pytest.approx(4e5 + 12e6 * 0.02, rel=1e-3)
    # a tether that stretches to three times its length keeps its 5 %
    assert _assemble([spring(high=2.0)]).span_share == 0.05


def test_the_shortest_tether_is_taut_first_and_carries_most():
    assembly = _assemble(_unequal_tethers(spring(), [1.0, 1.1, 0.9]))
    assert assembly.slack_length == pytest.approx([1.0, 1.1, 0.9])
    assert assembly.total_length[0] == pytest.approx(0.9)
    assert assembly.tension_at(1.0) == pytest.approx(100 * (1.0 / 0.9 - 1), rel=1e-6)
    at = 2.0
    loads = 100 * (at / np.array([1.0, 1.1, 0.9]) - 1)
    assert assembly.tension_at(at) == pytest.approx(loads.sum(), rel=1e-6)
    assert assembly.loads_at(loads.sum()) == pytest.approx(loads, rel=1e-6)


def test_beyond_the_curves_there_is_no_tension_and_below_slack_none_either():
    assembly = _assemble([spring()])
    assert assembly.tension_at([0.5, 9.0])[0] == 0
    assert np.isnan(assembly.tension_at(9.0))
    assert np.isnan(assembly.length_at([-1.0, 1e6])).all()
    assert np.isnan(assembly.loads_at(1e6)).all()


def test_what_was_tested_is_what_a_piece_reaches():
    assembly = _assemble([spring(low=0.5)])
    tested = assembly.total_length[assembly.is_tested]
    assert tested.min() == pytest.approx(1.5, abs=0.02)
    assert tested.max() == assembly.total_length[-1]


def test_the_uncertainty_is_that_of_the_curve_times_the_tethers_less_what_gives():
    four = _assemble(_equal_tethers(spring(spread=2.0), 4))
    inside = four.is_tested
    assert four.standard_uncertainty[inside] == pytest.approx(8.0, rel=1e-3)
    # a part as soft as the four together takes half of it
    half = _assemble(_equal_tethers(spring(spread=2.0), 4), [SeriesPart("wire", 1.0, 400.0)])
    assert half.standard_uncertainty[half.is_tested] == pytest.approx(4.0, rel=1e-3)


def test_splices_take_their_share_of_the_uncertainty():
    # F = 400 strain, splices of 2 m that give 0.001 a newton: 2.5 of 4.5 mm/N are the rubber's
    soft = {"relaxed_free_length": 1.0, "relaxed_splice_length": 2.0,
            "splice_compliance": 0.001, "splice_exponent": 1.0}  # fmt: skip
    curve = curve_of(lambda at: 400 * at, spread=3.0)
    one = _assemble([_Tether(curve, StrainModel("T", "tension-driven", soft))])
    found = one.standard_uncertainty[one.is_tested][1:-1]
    assert found == pytest.approx(3.0 * 2.5 / 4.5, rel=1e-3)


def test_what_cannot_be_assembled_is_refused():
    with pytest.raises(SettingsError, match="wire has no length"):
        SeriesPart("wire", -1.0)
    with pytest.raises(SettingsError, match="wire has no length"):
        SeriesPart("wire", float("nan"))
    with pytest.raises(SettingsError, match="spring constant of wire is not positive"):
        SeriesPart("wire", 1.0, 0.0)
    with pytest.raises(DataError, match="at the end of its curve before another one is taut"):
        _assemble(_unequal_tethers(spring(), [1.0, 4.0]))
    back = StrainModel(
        "T",
        "marks",
        {"free_length_intercept": 9.0, "free_length_slope": -0.9, "relaxed_free_length": 2.5},
    )
    with pytest.raises(DataError, match="does not lengthen with tension"):
        _assemble([_Tether(RUBBER.curve, back)])
