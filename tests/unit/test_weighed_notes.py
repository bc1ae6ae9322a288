"""Doubts that are told as notes where the interval of an answer holds what they would do."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.notes import note
from reduction.uncertainty.effects_on_answers import with_weighed_notes


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
