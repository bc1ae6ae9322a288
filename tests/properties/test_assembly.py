"""Properties of assemblies that hold for any tethers."""

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
