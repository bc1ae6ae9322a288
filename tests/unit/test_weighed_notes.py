"""Doubts that are told as notes where the interval of an answer holds what they would do."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.record.notes import note
from reduction.uncertainty.effects_on_answers import splice_friction_notes, with_weighed_notes


@pytest.mark.parametrize(("effect", "known_to", "severity"), [
    (0.025, 0.01, "note"),  # creep of settled cycles: the interval is four fifths of it
    (0.13, 0.05, "warning"),  # cycles that bed in
    (0.13, 0.07, "note"),
])  # fmt: skip
def test_drift_that_is_taken_off_is_a_warning_where_the_energy_hangs_on_it(
    rich_test, effect, known_to, severity
):
    summary, name = rich_test.amplitude, rich_test.specimens[0].name
    known = np.abs(summary.hysteresis_energy) * known_to
    summary = replace(summary, uncertainty=summary.uncertainty | {"hysteresis_energy": known})
    told = note("drift-in-energy", name, energy=1.0, closed=1 + effect, effect=effect)
    test = replace(rich_test, amplitude=summary, contributions=None, loop_notes=(told,))
    assert [one.severity for one in with_weighed_notes(test).loop_notes] == [severity]


def test_drift_of_a_step_in_which_the_rope_beds_in_is_no_warning(rich_test):
    name = rich_test.specimens[0].name
    told = note("drift-in-energy", name, energy=30.2, closed=33.5, effect=0.11)
    for kind, severity in (("cyclic", "warning"), ("bedding-in", "note")):
        test = replace(
            rich_test, description=replace(rich_test.description, kind=kind), loop_notes=(told,)
        )
        known = np.abs(test.amplitude.hysteresis_energy) * 0.01
        uncertainty = test.amplitude.uncertainty | {"hysteresis_energy": known}
        test = replace(
            test, contributions=None, amplitude=replace(test.amplitude, uncertainty=uncertainty)
        )
        assert [one.severity for one in with_weighed_notes(test).loop_notes] == [severity]


@pytest.mark.parametrize(("random", "code"), [
    (0.5, "splice-friction-matters"),  # half the interval is 6.1 of 50, the effect 12
    (6.0, "splice-friction-unknown"),  # half the interval is 13.4
])  # fmt: skip
def test_possible_friction_of_splices_is_weighed_against_the_interval_of_the_energy(random, code):
    """Friction of a tenth in place of 2 %: five times its contributions.

    3 of 50 J/m become 15, 30 %, of which four fifths are in a loop: 24 %; 40 of 1600 N: 12.5 %.
    """
    values = {"hysteresis_energy": 50.0, "apparent_spring_constant": 1600.0}
    summary = SimpleNamespace(
        **{name: np.array([value]) for name, value in values.items()},
        uncertainty={name: np.array([random]) for name in values},
    )
    found = Contributions(
        (Component("splice_friction", "rope"),),
        {
            "test_hysteresis_energy": np.array([[3.0]]),
            "test_apparent_spring_constant": np.array([[40.0]]),
        },
    )
    errors = replace(InstrumentErrors("rope"), splice_friction=0.02)
    test = SimpleNamespace(amplitude=summary, contributions=found)
    [told] = splice_friction_notes(test, [errors])
    assert told.code == code
    assert told.numbers["of_energy"] == pytest.approx(0.24)
    assert told.numbers["of_constant"] == pytest.approx(0.125)
