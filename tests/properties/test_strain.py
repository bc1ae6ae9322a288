"""Laws of the strain methods that hold for every input, not only for the published ones."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from reduction.stages.strain.splice_calibration import (
    fit_free_length_line,
    fit_power_law,
    fit_splice_ratio,
)
from reduction.stages.strain.strain_model import (
    _marked_line_strain,
    _splice_ratio_strain,
    _tension_driven_strain,
    free_length_fraction,
    free_length_strain,
)
from reduction.stages.strain.stress import constant_volume_diameter, nominal_stress

lengths = st.floats(min_value=1e-2, max_value=1e2)
shares = st.floats(min_value=0.01, max_value=0.99)
factors = st.floats(min_value=1e-2, max_value=1e2)
strains = st.lists(st.floats(min_value=0.05, max_value=5.0), min_size=2, max_size=12, unique=True)
exponents = st.floats(min_value=0.4, max_value=1.7)


@given(st.lists(lengths, min_size=1, max_size=20), shares)
def test_a_constant_share_is_recovered(total, share):
    assert np.isclose(free_length_fraction([share * t for t in total], total), share, rtol=1e-12)


@given(lengths, lengths, shares, factors)
def test_strain_does_not_depend_on_the_length_unit(total, relaxed, share, unit):
    one = free_length_strain(total, free_fraction=share, relaxed_free_length=relaxed)
    other = free_length_strain(
        unit * total, free_fraction=share, relaxed_free_length=unit * relaxed
    )
    np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)


@given(lengths, st.floats(min_value=1e-6, max_value=1.0), shares, lengths)
def test_strain_grows_with_length(total, step, share, relaxed):
    short, long = free_length_strain(
        [total, total + step], free_fraction=share, relaxed_free_length=relaxed
    )
    assert long >= short


@given(strains, lengths, lengths, st.floats(min_value=0.0, max_value=1.0))
def test_splices_of_a_constant_ratio_are_found_and_inverted(strain, free, splice, ratio):
    strain = np.array(strain)
    free_length, splice_length = free * (1 + strain), splice * (1 + ratio * strain)
    found = fit_splice_ratio(
        free_length,
        splice_length,
        relaxed_free_length=free,
        relaxed_splice_length=splice,
        reading_uncertainty=0.0,
    ).values[0]
    back = _splice_ratio_strain(
        free_length + splice_length,
        relaxed_free_length=free,
        relaxed_splice_length=splice,
        splice_strain_ratio=found,
    )
    np.testing.assert_allclose(back, strain, rtol=1e-6, atol=1e-9)


@given(strains, lengths, lengths, st.floats(min_value=0.0, max_value=1.0))
def test_with_splices_of_a_constant_ratio_line_and_ratio_agree(strain, free, splice, ratio):
    strain = np.array(strain)
    free_length = free * (1 + strain)
    position = free_length + splice * (1 + ratio * strain)
    assume(np.ptp(position) > 1e-3 * position.max())
    line = fit_free_length_line(free_length, position, reading_uncertainty=0.0).values
    back = _marked_line_strain(
        position,
        free_length_intercept=line[0],
        free_length_slope=line[1],
        relaxed_free_length=free,
    )
    np.testing.assert_allclose(back, strain, rtol=1e-6, atol=1e-6)


@given(
    st.lists(st.floats(min_value=20, max_value=2000), min_size=3, max_size=12, unique=True),
    st.floats(min_value=0.02, max_value=0.6),
    exponents,
    factors,
)
def test_a_power_law_is_found_in_any_unit_of_length(force, strain_at_500, exponent, unit):
    force = np.sort(force)
    assume(force[-1] > 2 * force[0])
    compliance = strain_at_500 / 500.0**exponent
    splice = unit * (1 + compliance * force**exponent)
    found = fit_power_law(splice, force, relaxed_splice_length=unit, reading_uncertainty=0.0)
    np.testing.assert_allclose(found.values[1], exponent, atol=1e-5)
    np.testing.assert_allclose(found.values[0] * 500.0 ** found.values[1], strain_at_500, rtol=1e-5)


@given(
    st.floats(min_value=0, max_value=3),
    st.floats(min_value=0, max_value=3000),
    st.floats(min_value=1e-5, max_value=1e-3),
    exponents,
)
def test_tension_driven_strain_inverts_its_own_geometry(strain, force, compliance, exponent):
    law = {
        "relaxed_free_length": 2.5,
        "relaxed_splice_length": 1.2,
        "splice_compliance": compliance,
        "splice_exponent": exponent,
    }
    position = 2.5 * (1 + strain) + 1.2 * (1 + compliance * force**exponent)
    found = _tension_driven_strain(position, force, **law)
    assert np.isclose(found, strain, rtol=1e-9, atol=1e-9 * (1 + position))


@given(st.floats(min_value=-1e4, max_value=1e4), st.floats(min_value=1e-6, max_value=1), factors)
def test_stress_is_linear_in_tension(force, area, factor):
    one, more = nominal_stress(force, area=area), nominal_stress(factor * force, area=area)
    np.testing.assert_allclose(more, factor * one, rtol=1e-12, atol=1e-12)


@given(st.floats(min_value=-0.9, max_value=9), lengths)
def test_volume_is_the_same_before_and_after(strain, diameter):
    before = constant_volume_diameter(strain, diameter)
    assert np.isclose(before**2, diameter**2 * (1 + strain))
