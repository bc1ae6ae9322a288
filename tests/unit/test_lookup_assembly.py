"""None"""

import numpy as np
import pytest
from assemblies import RUBBER, curve_of, spring
from refusals import refusals

from reduction.lines.assembly import (
    SeriesPart,
    StatedSplices,
    _assemble,
    _deployed_model,
    _equal_tethers,
    _span_loads,
    _Tether,
    _unequal_tethers,
    _working_point,
    _worst_sharing,
    stated_model,
)
from reduction.lines.composite import CurvePiece, _composite_curve
from reduction.record.errors import DataError, SettingsError
from reduction.stages.strain.strain_model import StrainModel, position_by_model


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


def test_springs_have_the_length_and_the_loads_of_hooke_at_every_amplitude():
    assembly = _assemble(_equal_tethers(spring(2.0), 4), [SeriesPart("wire", 2.0, 4000.0)])
    point = _working_point(assembly, [200.0, 400.0], [0.0, 100.0], rated_break_strength=500.0)
    stiffness = 1 / (2.0 / 400 + 2.0 / 4000)
    assert point.peak_tether_tension[0] == pytest.approx([50.0, 125.0])
    assert point.minimum_tether_tension[3] == pytest.approx([50.0, 75.0])
    assert point.peak_share[1] == pytest.approx([0.1, 0.25])
    assert point.load_share == pytest.approx(np.full((4, 2), 0.25))
    assert point.total_length == pytest.approx(4 + np.array([200, 400]) / stiffness)


def test_strains_that_were_not_tested_are_flagged():
    assembly = _assemble([spring(low=0.5)])
    found = _working_point(assembly, [40.0, 100.0, 100.0], [0.0, 0.0, 60.0])
    assert found.is_tested.tolist() == [False, True, False]


def test_a_gap_between_two_windows_is_not_tested_where_a_cycle_spans_it():
    model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    at = [np.linspace(*ends, 11) for ends in ((0.2, 0.8), (1.2, 2.0))]
    pieces = [
        CurvePiece(name, "cyclic", "mean", one, 100 * one, 0 * one)
        for name, one in zip(("T-1", "T-2"), at, strict=True)
    ]
    assembly = _assemble([_Tether(_composite_curve(pieces), model)])
    found = _working_point(assembly, [50.0, 160.0, 100.0], [20.0, 20.0, 60.0])
    assert found.is_tested.tolist() == [True, True, False]


def test_zero_tension_is_an_error():
    assembly = _assemble(_equal_tethers(spring(), 4))
    with pytest.raises(DataError, match="tether 1 of 4 goes slack.*above 0 N"):
        _working_point(assembly, 300.0, 300.0)
    with pytest.raises(DataError, match="goes slack"):
        _working_point(assembly, [300.0, 0.0])
    with pytest.raises(DataError, match="amplitudes are above their mean"):
        _working_point(assembly, 300.0, 301.0)


def test_the_longest_tether_goes_slack_while_the_assembly_is_taut():
    assembly = _assemble(_unequal_tethers(spring(), [1.0, 1.2, 1.0]))
    slack = 2 * 100 * 0.2  # the two others at 1.2 m
    with pytest.raises(DataError, match=f"tether 2 of 3 goes slack.*above {slack:g} N"):
        _working_point(assembly, 100.0, 65.0)
    found = _working_point(assembly, 100.0, 55.0)
    # 45 N: all three are taut at the length where 200 (L - 1) + 100 (L / 1.2 - 1) is that
    length = 345 / (200 + 100 / 1.2)
    assert found.minimum_tether_tension[1] == pytest.approx(100 * (length / 1.2 - 1))


def test_one_short_tether_of_four_takes_the_tension_that_springs_say():
    """F = 100 (L / l - 1): the length follows from the sum, the loads from the length."""
    found = _worst_sharing(spring(), 4, 400.0, free_length=1.0, tolerance=0.05)
    for sign, load in ((-1, found.greatest_load), (1, found.least_load)):
        lengths = np.array([1 + sign * 0.05, *3 * [1 - sign * 0.05]])
        length = (400 / 100 + 4) / (1 / lengths).sum()
        assert load == pytest.approx(100 * (length / lengths[0] - 1), rel=1e-4)
    # the long one goes slack at its length, where three carry 100 (1.05 / .95 - 1) each
    assert found.tension_at_slack == pytest.approx(300 * (1.05 / 0.95 - 1), rel=1e-4)


def test_parts_in_line_do_not_change_how_tethers_share():
    one, other = (
        _worst_sharing(RUBBER, 4, 1500.0, free_length=5.0, tolerance=0.02, parts=parts)
        for parts in ((), (SeriesPart("wire", 50.0, 1e5),))
    )
    assert one.greatest_load == pytest.approx(other.greatest_load, rel=1e-9)


def test_no_other_lengths_within_the_tolerance_load_a_tether_more():
    rng = np.random.default_rng(11)
    worst = _worst_sharing(RUBBER, 4, 1500.0, free_length=5.0, tolerance=0.03)
    for _ in range(20):
        lengths = 5.0 * (1 + rng.uniform(-0.03, 0.03, 4))
        loads = _assemble(_unequal_tethers(RUBBER, lengths)).loads_at(1500.0)
        assert loads.max() <= worst.greatest_load
        assert loads.min() >= worst.least_load
        assert loads.sum() == pytest.approx(1500.0)


def test_sharing_that_makes_no_sense_is_refused():
    given = {"free_length": 1.0, "tolerance": 0.01}
    with pytest.raises(DataError, match="without tension shares no load"):
        _worst_sharing(spring(), 2, [100.0, 0.0], **given)
    with pytest.raises(DataError, match="beyond the curves of the assembly"):
        _worst_sharing(spring(), 2, 1000.0, **given)


REFUSED = {
    "a tether has a length": (
        lambda: stated_model(StatedSplices(1.0), 0.0, name="T"),
        DataError,
        "free_length",
    ),
    "an extensometer knows no splices": (
        lambda: _deployed_model(StrainModel("T", "extensometer"), np.float64(5.0)),
        DataError,
        "extensometer, which does not include splices",
    ),
    "a peak beyond the curves is an error": (
        lambda: _working_point(_assemble([spring()]), 200.0, 60.0),
        DataError,
        "beyond the curves of the assembly",
    ),
}


test_refusals = refusals(REFUSED)
