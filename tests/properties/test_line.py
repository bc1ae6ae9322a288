"""Laws of the three-parameter line, for any line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reduction.stages.three_parameter_line.line_model import (
    _storage_and_loss,
    apparent_spring_constant,
    hysteresis_energy,
    identify_by_amplitude,
    identify_by_fundamental,
)

SPRING = st.floats(1e3, 1e6)
TIME = st.floats(1e-3, 1e3)
FREQUENCY = st.floats(1e-2, 10)


def line_of(rest, spring, time, frequency):
    return {
        "quasi_static_spring_constant": rest,
        "dissipation_spring_constant": spring,
        "relaxation_time": time,
        "frequency": frequency,
    }


@given(SPRING, SPRING, TIME, FREQUENCY)
def test_the_apparent_spring_constant_lies_between_the_springs(rest, spring, time, frequency):
    line = line_of(rest, spring, time, frequency)
    apparent = apparent_spring_constant(**line)
    assert rest * (1 - 1e-12) <= apparent <= (rest + spring) * (1 + 1e-12)
    assert apparent_spring_constant(**{**line, "frequency": 2 * frequency}) >= apparent * (
        1 - 1e-12
    )


@given(SPRING, SPRING, TIME, FREQUENCY)
def test_a_line_of_positive_parameters_is_never_refused_and_comes_back(
    rest, spring, time, frequency
):
    line = line_of(rest, spring, time, frequency)
    stored, lost = _storage_and_loss(**line)
    found = identify_by_amplitude(
        apparent_spring_constant=apparent_spring_constant(**line),
        hysteresis_energy=hysteresis_energy(tension_amplitude=400.0, **line),
        tension_amplitude=400.0,
        frequency=frequency,
        quasi_static_spring_constant=rest,
    )
    # rounding of E' enters K_1 by E'/(E' - K_0)
    loss_of_digits = float(stored / max(stored - rest, 1e-300))
    if loss_of_digits < 1e8:
        assert found.reason == 0
        tolerance = 1e-14 * loss_of_digits + 1e-11
        assert found.relaxation_time == pytest.approx(time, rel=tolerance)
        assert found.dissipation_spring_constant == pytest.approx(spring, rel=2 * tolerance)
    assert found.loss_spring_constant == pytest.approx(float(lost), rel=1e-9)


@given(SPRING, SPRING, TIME, FREQUENCY, st.floats(0.1, 10))
def test_the_size_of_the_cycles_and_the_unit_of_force_change_nothing(
    rest, spring, time, frequency, scale
):
    line = line_of(rest, spring, time, frequency)
    stored, lost = _storage_and_loss(**line)
    one = identify_by_fundamental(
        storage_spring_constant=stored, loss_spring_constant=lost, frequency=frequency,
        quasi_static_spring_constant=rest,
    )  # fmt: skip
    other = identify_by_fundamental(
        storage_spring_constant=scale * stored, loss_spring_constant=scale * lost,
        frequency=frequency, quasi_static_spring_constant=scale * rest,
    )  # fmt: skip
    if stored > 1.001 * rest:
        assert other.relaxation_time == pytest.approx(float(one.relaxation_time), rel=1e-9)
        assert other.dissipation_spring_constant == pytest.approx(
            scale * float(one.dissipation_spring_constant), rel=1e-9
        )
    energy = hysteresis_energy(tension_amplitude=scale * 100.0, **line)
    assert energy == pytest.approx(scale**2 * hysteresis_energy(tension_amplitude=100.0, **line))


@given(
    st.lists(st.floats(allow_nan=True, allow_infinity=True), min_size=5, max_size=5),
)
def test_no_reading_whatever_raises_or_gives_a_parameter_that_cannot_be(readings):
    with np.errstate(over="ignore"):
        found = identify_by_amplitude(
            apparent_spring_constant=readings[0],
            hysteresis_energy=readings[1],
            tension_amplitude=readings[2],
            frequency=readings[3],
            quasi_static_spring_constant=readings[4],
        )
    assert (found.reason == 0) == np.isfinite(found.dissipation_spring_constant)
    if found.reason == 0:
        assert found.dissipation_spring_constant > 0 and found.relaxation_time > 0
