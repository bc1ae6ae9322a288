"""Laws that hold for any series: scale, shift, order."""

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.stages.holds.hold_selection import _find_ramp
from reduction.stages.holds.prony_series import _ramp_factor, prony_tension
from reduction.stages.holds.relaxation_numbers import (
    logarithmic_blocks,
    rate_per_decade,
    relaxation_drop,
)
from reduction.stages.moduli.elastomer_laws import fit_elastomers, hyperelastic_stress
from reduction.stages.moduli.secant_modulus import slope_per_decade
from reduction.stages.moduli.slack_length import _slack_position
from reduction.stages.moduli.splice_slip import _ramp_of, find_steps

positive = st.floats(1e-3, 1e3)


@given(st.floats(1, 1e4), st.floats(0, 1e4), positive)
def test_a_drop_does_not_depend_on_the_unit_of_tension(initial, final, unit):
    one, other = relaxation_drop(initial, final), relaxation_drop(unit * initial, unit * final)
    assert other == pytest.approx(float(one), rel=1e-9, abs=1e-12)


@given(st.lists(st.floats(0.1, 1e4), min_size=1, max_size=4), st.floats(0, 1e3))
def test_a_ramp_leaves_between_nothing_and_all_of_a_term(times, duration):
    factor = _ramp_factor(times, ramp_duration=duration)
    assert np.all((factor > 0) & (factor <= 1))


@given(st.lists(st.tuples(positive, positive), min_size=1, max_size=4), st.floats(0, 1e3))
def test_a_prony_series_only_falls(terms, long_time_tension):
    size, times = np.array(terms).T
    tension = prony_tension(
        np.geomspace(1e-3, 1e4, 60),
        tension=size,
        relaxation_time=times,
        long_time_tension=long_time_tension,
    )
    assert np.all(np.diff(tension) <= 1e-9 * tension[0])
    assert tension[-1] >= long_time_tension


@given(st.floats(0.1, 100), st.floats(1.5, 4), st.floats(-50, 50))
def test_a_rate_per_decade_does_not_depend_on_the_unit_of_time(unit, decades, slope):
    time = np.geomspace(1, 10**decades, 300)
    rates = [
        rate_per_decade(
            logarithmic_blocks(scale * time, slope * np.log10(time)), ramp_duration=0.0
        ).value
        for scale in (1.0, unit)
    ]
    assert rates[1] == pytest.approx(rates[0], abs=1e-3 * abs(slope) + 1e-9)


@given(st.floats(0.05, 5), st.floats(0.2, 3), st.floats(1, 4), st.floats(-100, 100))
def test_the_centre_of_a_ramp_lies_in_it_and_moves_with_the_clock(rate, stroke, power, clock):
    time = np.arange(0, 10 + stroke / rate, 0.02)
    position = np.clip((time - 10) * rate, 0, stroke)
    tension = 100 * position**power
    ramp = _find_ramp(time, position, tension, band=stroke / 100)
    later = _find_ramp(time + clock, position, tension, band=stroke / 100)
    assert ramp.start_time <= ramp.centre_time <= ramp.end_time
    assert 0 <= ramp.duration <= ramp.end_time - ramp.start_time
    assert later.centre_time - clock == pytest.approx(ramp.centre_time, abs=1e-6)


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_steps_do_not_depend_on_unit_and_zero_of_the_series(seed, unit, zero):
    rng = np.random.default_rng(seed)
    series = 0.3 * rng.standard_normal(300) - 2 * _ramp_of(300, onset=150, extent=3)
    one = find_steps(series, false_alarm=1e-3)
    other = find_steps(unit * series + zero * unit, false_alarm=1e-3)
    assert [step.onset for step in other] == [step.onset for step in one]
    for left, right in zip(one, other, strict=True):
        assert right.size == pytest.approx(unit * left.size, rel=1e-5)


@settings(max_examples=examples(8), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_mirrored_series_has_mirrored_steps(seed):
    rng = np.random.default_rng(seed)
    series = 0.3 * rng.standard_normal(300) - 2 * _ramp_of(300, onset=150, extent=3)
    one, other = (find_steps(sign * series, false_alarm=1e-3) for sign in (1, -1))
    assert [step.onset for step in other] == [step.onset for step in one]
    assert [step.size for step in other] == pytest.approx([-step.size for step in one])


@given(st.floats(-100, 100), st.floats(-1e3, 1e3), st.integers(1, 50))
def test_a_line_in_the_logarithm_gives_its_slope(slope, level, first):
    number = np.arange(first, first + 60)
    found, uncertainty = slope_per_decade([level + slope * np.log10(number)], number=number)
    assert found[0] == pytest.approx(slope, abs=1e-6)
    assert uncertainty[0] < 1e-6


@given(st.floats(0, 5), st.floats(10, 500), st.floats(1, 20))
def test_a_slack_crossing_is_where_the_line_is(start, stiffness, slack):
    place = start + np.linspace(0, 6 * slack / stiffness, 200)
    crossing, _, _ = _slack_position(place, stiffness * (place - start), slack_tension=slack)
    assert crossing == pytest.approx(start + slack / stiffness, abs=1e-9)


@settings(max_examples=examples(8), deadline=None)
@given(st.floats(1e4, 1e6), st.floats(0, 1e6), st.floats(0.5, 3))
def test_small_strain_modulus_of_a_fit_is_the_slope_at_zero(c10, c01, strain_high):
    truth = {"c10": c10, "c01": c01}
    strain = np.linspace(1e-3, strain_high, 600)
    stress = hyperelastic_stress(strain, law="mooney-rivlin", parameters=truth)
    fit = fit_elastomers(strain, stress, specimen="a")[1]
    found = 6 * (fit.parameters["c10"] + fit.parameters["c01"])
    assert found == pytest.approx(6 * (c10 + c01), rel=1e-3)
