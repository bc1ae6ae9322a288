import numpy as np
import pytest

from reduction.lines.composite import CompositeRule, CurvePiece, PieceSource, compose
from reduction.lines.export_sources import composite_table, line_from_composite, ranges_of


def piece(name, low, high, kind="cyclic"):
    at = np.linspace(low, high, 21)
    return CurvePiece(name, kind, "mean", at, 100 * at, np.full(21, 0.5))


SOURCE = PieceSource(
    "tether", "mean", (piece("T-1", 0.5, 1.0), piece("T-2", 0.8, 1.2), piece("T-3", 1.4, 2.0)),
    diameter=0.02, sources=("archive a",), notes=("held is left out",), is_synthetic=True,
)  # fmt: skip
CURVE = compose(SOURCE, CompositeRule())


def test_joins_and_gaps_are_ranges_of_strain():
    gaps = ranges_of(CURVE, CURVE.is_gap)
    assert np.array(gaps) == pytest.approx(np.array([[0.0, 0.5], [1.2, 1.4]]))
    ((low, high),) = ranges_of(CURVE, CURVE.is_join)
    assert 0.8 <= low < 0.82 and 0.98 < high <= 1.0
    assert ranges_of(CURVE, CURVE.is_moved) == []


def test_the_line_says_what_the_curve_is_made_of():
    line = line_from_composite(SOURCE, CURVE, linear_density=0.6, diameter=None)
    assert line.curve == "composite of 3 tests, mean of both branches; one curve, no loop"
    assert line.tested == pytest.approx((0.5, 2.0))
    assert (line.diameter, line.linear_density, line.is_synthetic) == (0.02, 0.6, True)
    assert line.sources == ("archive a", "linear density: stated at the export")
    told = " ".join(line.notes)
    assert "no piece between strain 1.2 and 1.4" in told
    assert "several pieces contribute at strain 0.8" in told
    assert line.notes[-1] == "held is left out"


def test_the_table_flags_the_way_to_each_node():
    columns = {one.name: one.values for one in composite_table(SOURCE, CURVE).columns}
    at = np.array(columns["strain"])
    flagged = at[columns["is_gap"]]
    assert flagged == pytest.approx([0.25, 0.5, 1.3, 1.4])
    assert columns["piece"][0] == "" and columns["piece"][-1] == "T-3 cycles"
    assert columns["tension"] == pytest.approx(100 * at)


def test_the_header_has_the_stiffness_of_the_tests_beside_that_of_the_table():
    """400 N per unit strain, and 800 N per unit strain 80 % further out: the join is softer."""
    low, high = np.linspace(0.4, 1.5, 41), np.linspace(1.0, 1.6, 41)
    pieces = [
        CurvePiece(name, "cyclic", "mean", at, load, 0 * at)
        for name, at, load in (("T-1", low, 400 * low), ("T-2", high, 800 * (high - 0.8)))
    ]
    for used, is_doubtful in ((pieces, True), (pieces[:1], False)):
        source = PieceSource("tether", "mean", tuple(used), sources=("a log",))
        notes = line_from_composite(source, compose(source, CompositeRule())).notes
        (said,) = (note for note in notes if note.startswith("EA of the tests"))
        assert ("table 400 N" in said) == (not is_doubtful)
        assert ("T-1 cycles 400 N (400 to 400), table 400 N, 160 to 600 N" in said) != is_doubtful
        warned = [
            note for note in notes if note.startswith("DOUBTFUL: the table joins unlike tests")
        ]
        assert bool(warned) == is_doubtful


def test_the_header_of_a_table_that_ends_below_the_loads_of_a_test():
    at = np.linspace(0.5, 1.5, 41)
    pieces = [
        CurvePiece(name, "cyclic", "mean", at, slope * at, 0 * at)
        for name, slope in (("T-1", 400), ("T-2", 1600))
    ]
    source = PieceSource("tether", "mean", tuple(pieces), sources=("a log",))
    curve = compose(source, CompositeRule())
    assert curve.tension[-1] < 0.75 * 2400
    (said,) = (
        note
        for note in line_from_composite(source, curve).notes
        if note.startswith("EA of the tests")
    )
    assert "T-2 cycles 1600 N (1600 to 1600)" in said and "nan" not in said
