import numpy as np
import pytest
from assemblies import RUBBER, spring

from reduction.lines.assembly import (
    SeriesPart,
    _assemble,
    _equal_tethers,
    _Tether,
    _unequal_tethers,
    _working_point,
    _worst_sharing,
)
from reduction.lines.composite import CurvePiece, _composite_curve
from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import StrainModel


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


def test_a_peak_beyond_the_curves_is_an_error():
    with pytest.raises(DataError, match="beyond the curves of the assembly"):
        _working_point(_assemble([spring()]), 200.0, 60.0)


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
