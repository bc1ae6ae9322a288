"""Properties of the composite curve that hold for any pieces."""

import numpy as np
from assemblies import RUBBER, spring
from examples import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st

from reduction.lines.assembly import (
    SeriesPart,
    _assemble,
    _equal_tethers,
    _unequal_tethers,
    _working_point,
)
from reduction.lines.composite import CompositeRule, CurvePiece, _composite_curve

KINDS = ("cyclic", "static", "first-loading")


@st.composite
def a_piece(draw, kinds=KINDS):
    n = draw(st.integers(2, 40))
    low = draw(st.floats(0.01, 3.0))
    width = draw(st.floats(0.01, 2.0))
    seed = draw(st.integers(0, 2**31))
    rng = np.random.default_rng(seed)
    strain = low + width * np.linspace(0, 1, n)
    rise = np.cumsum(rng.exponential(1.0, n)) * draw(st.floats(0.1, 100.0))
    noise = rng.normal(0, draw(st.sampled_from([0.0, 1.0, 20.0])), n)
    tension = np.maximum(draw(st.floats(0.1, 500.0)) + rise + noise, 1e-3)
    spread = np.full(n, draw(st.sampled_from([0.0, 0.1, 5.0])))
    return CurvePiece("T", draw(st.sampled_from(kinds)), "mean", strain, tension, spread)


rules = st.builds(CompositeRule, precedence=st.permutations(KINDS).map(tuple))


@settings(max_examples=examples(150), deadline=None)
@given(st.lists(a_piece(), min_size=1, max_size=5), rules)
def test_it_rises_strictly_from_zero_and_every_interval_has_its_flags(pieces, rule):
    curve = _composite_curve(pieces, rule=rule)
    assert curve.strain[0] == curve.tension[0] == 0
    assert (np.diff(curve.strain) > 0).all()
    assert (np.diff(curve.tension) > 0).all()
    assert np.isfinite(curve.standard_uncertainty).all()
    n = curve.strain.size
    assert curve.is_gap.size == curve.is_join.size == curve.is_moved.size == n - 1
    assert curve.piece.size == curve.monotone_change.size == n
    assert curve.is_gap[0]
    assert not (curve.is_gap & curve.is_join).any()
    # strain and tension are inverse to one another
    at = np.linspace(0, curve.strain[-1], 50)
    back = curve.strain_at(curve.tension_at(at))
    np.testing.assert_allclose(back, at, rtol=1e-5, atol=1e-5 * curve.strain[-1])


@settings(max_examples=examples(80), deadline=None)
@given(st.lists(a_piece(kinds=("cyclic",)), min_size=1, max_size=4))
def test_a_gap_is_where_no_piece_reaches(pieces):
    curve = _composite_curve(pieces)
    middle = (curve.strain[1:] + curve.strain[:-1]) / 2
    reached = np.any(
        [(middle > one.strain[0]) & (middle < one.strain[-1]) for one in pieces], axis=0
    )
    np.testing.assert_array_equal(curve.is_gap, ~reached)


@settings(max_examples=examples(60), deadline=None)
@given(a_piece(kinds=("cyclic",)), rules)
def test_it_does_not_depend_on_how_often_a_piece_is_given(piece, rule):
    once, twice = _composite_curve([piece], rule=rule), _composite_curve([piece, piece], rule=rule)
    np.testing.assert_allclose(once.tension, twice.tension, rtol=1e-9)


@settings(max_examples=examples(60), deadline=None)
@given(st.lists(a_piece(), min_size=1, max_size=4), st.floats(0.01, 100))
def test_tension_in_another_unit_is_the_same_curve(pieces, unit):
    other = [
        CurvePiece(
            one.name, one.kind, one.branch, one.strain, unit * one.tension,
            unit * one.random_standard_uncertainty,
        )
        for one in pieces
    ]  # fmt: skip
    one, two = _composite_curve(pieces), _composite_curve(other)
    np.testing.assert_allclose(two.tension, unit * one.tension, rtol=1e-6)


@settings(max_examples=examples(60), deadline=None)
@given(a_piece(), rules)
def test_one_piece_that_rises_is_unchanged(piece, rule):
    if (np.diff(piece.tension) <= 1e-3).any():
        return
    curve = _composite_curve([piece], rule=rule)
    assert not curve.is_moved.any()


# properties of assemblies that hold for any tethers

lengths = st.lists(st.floats(2.0, 3.0), min_size=1, max_size=6)
parts = st.lists(
    st.builds(SeriesPart, st.just("wire"), st.floats(0, 50), st.floats(1e3, 1e8)), max_size=3
)


# lengths that differ by rounding alone
@example(free=[2.0, 2.75], in_line=[SeriesPart("wire", 1.0, 1001.0)], soft=True)
@settings(max_examples=examples(80), deadline=None)
@given(lengths, parts, st.booleans())
def test_loads_add_up_and_length_and_tension_are_inverse(free, in_line, soft):
    assembly = _assemble(_unequal_tethers(spring() if soft else RUBBER, free), in_line)
    assert (np.diff(assembly.total_length) > 0).all()
    assert (np.diff(assembly.tension) > 0).all()
    np.testing.assert_allclose(assembly.tether_tension.sum(axis=0), assembly.tension, rtol=1e-12)
    tension = np.linspace(0, assembly.tension[-1], 30)
    np.testing.assert_allclose(
        assembly.tension_at(assembly.length_at(tension)), tension,
        rtol=1e-6, atol=1e-6 * tension[-1],
    )  # fmt: skip
    # the shorter, the more it carries
    order = np.argsort(free, kind="stable")
    assert (np.diff(assembly.tether_tension[order], axis=0) <= 1e-9 * assembly.tension[-1]).all()


@settings(max_examples=examples(40), deadline=None)
@given(st.integers(1, 12), st.floats(0.05, 0.9))
def test_equal_tethers_are_one_tether_times_their_number(n_tethers, share):
    one, many = _assemble([RUBBER]), _assemble(_equal_tethers(RUBBER, n_tethers))
    tension = share * one.tension[-1]
    np.testing.assert_allclose(many.length_at(n_tethers * tension), one.length_at(tension))
    point = _working_point(many, n_tethers * tension, 0.5 * n_tethers * tension * (1 - share))
    np.testing.assert_allclose(point.load_share, 1 / n_tethers)
