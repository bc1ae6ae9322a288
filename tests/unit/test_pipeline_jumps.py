"""What is said where the mean of the cycles jumps."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.cyclic_test import notes_on_jumps

N_CYCLES = 60


def loops_of(strain, stiffness):
    """Cycles of 100 to 300 N in load control, with a strain and a stiffness each."""
    noise = np.random.default_rng(5)
    amplitude = 100.0 / stiffness
    return SimpleNamespace(
        cycle_start_time=10.0 * np.arange(N_CYCLES)[None],
        mean_strain=(strain + noise.normal(0, 1e-5, N_CYCLES))[None],
        mean_tension=(200 + noise.normal(0, 0.05, N_CYCLES))[None],
        apparent_spring_constant=stiffness[None],
        strain_amplitude=amplitude[None],
        tension_amplitude=np.full((1, N_CYCLES), 100.0),
    )


@pytest.mark.parametrize(
    ("left", "code"), [(1.0, "strain-jumps"), (0.79, "stiffness-changes-at-cycle")]
)
def test_a_slip_leaves_the_stiffness_and_a_strand_takes_some_of_it(left, code):
    is_after = np.arange(N_CYCLES) >= 40
    stiffness = np.where(is_after, left, 1.0) * 5000.0
    (found,) = notes_on_jumps(loops_of(0.1 + 0.02 * is_after, stiffness), ["line"], break_in=0)
    assert found.code == code and found.numbers["number"] == 40
    if left < 1:
        assert found.numbers["change"] == pytest.approx(left - 1)


@pytest.mark.parametrize("larger", [1.5, 0.6])
def test_another_amplitude_is_no_slip(larger):
    is_after = np.arange(N_CYCLES) >= 40
    loops = loops_of(0.1 - 0.002 * is_after, np.full(N_CYCLES, 5000.0))
    assert notes_on_jumps(loops, ["line"], break_in=0)
    for one in (loops.strain_amplitude, loops.tension_amplitude):
        one[0, is_after] *= larger
    assert not notes_on_jumps(loops, ["line"], break_in=0)
