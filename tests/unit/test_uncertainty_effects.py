"""Doubts weighed against the intervals of the answers."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.record.measurement import LoadTrain
from reduction.record.notes import note
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.effects_on_answers import (
    load_train_notes,
    splice_friction_notes,
    splice_slip_notes,
    with_weighed_notes,
)


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


# by how much strain is too large after a slip, and when that is worth a warning

GAUGE_LENGTH = 2.5  # m
# strain is 40 % of the position in metres: one metre of stroke over 2.5 m
LINE = StrainModel(
    "new", "marks",
    {"free_length_intercept": 0.0, "free_length_slope": 1.0, "relaxed_free_length": GAUGE_LENGTH},
)  # fmt: skip


def reduced(*, spread, method=None):
    """A test of two slips of 40 and 60 mm: 4 percentage points of strain on a mean of 160 %."""
    model = LINE if method is None else StrainModel("new", method, {})
    summary = SimpleNamespace(
        mean_strain=np.array([1.6]), strain_amplitude=np.array([0.5]),
        mean_tension=np.array([400.0]), tension_amplitude=np.array([200.0]),
        uncertainty={"mean_strain": np.array([spread])},
    )  # fmt: skip
    slips = SimpleNamespace(
        specimen=("new", "new"), slip_cycle=np.array([601, 1501]),
        slip_length=np.array([0.04, 0.06]),
    )  # fmt: skip
    return SimpleNamespace(
        amplitude=summary, slips=slips, specimens=(SimpleNamespace(name="new", kind="rope"),),
        strain_models=(model,), contributions=None, history=None, record=None, cycles=None,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("spread", "method", "severity"),
    [(0.004, None, "warning"), (0.03, None, "note"), (0.004, "extensometer", "note")],
    ids=["beyond its interval", "within its interval", "extensometer"],
)
def test_a_slip_is_a_warning_where_the_strain_moves_beyond_its_interval(spread, method, severity):
    (found,) = splice_slip_notes(reduced(spread=spread, method=method))
    assert found.severity == severity
    words = str(found)
    assert (
        "new: the splices slipped at cycles 601 and 1,501, by about 100 mm or more in all" in words
    )
    assert ("4.0 percentage points too large (2.5 % of the mean strain)" in words) == (
        method is None
    )


@pytest.mark.parametrize(
    ("source", "severity"), [("splice_slip", "warning"), ("position_offset", "note")]
)
def test_what_the_slip_itself_adds_to_the_interval_does_not_silence_it(source, severity):
    test = reduced(spread=0.004)
    test.contributions = Contributions(
        (Component(source, "new"),), {"test_mean_strain": np.array([[0.04]])}
    )
    (found,) = splice_slip_notes(test)
    assert found.severity == severity


def test_no_slip_has_no_note():
    test = reduced(spread=0.004)
    test.slips = SimpleNamespace(specimen=("used",), slip_cycle=np.array([5]),
                                 slip_length=np.array([0.04]))  # fmt: skip
    assert list(splice_slip_notes(test)) == []
    test.slips = None
    assert list(splice_slip_notes(test)) == []


@pytest.mark.parametrize(
    ("spread", "severity"), [(0.004, "warning"), (0.03, "note")], ids=["beyond", "within"]
)
def test_a_slip_before_the_test_is_told_like_one_in_it(spread, severity):
    test = reduced(spread=spread)
    test.slips, test.history = None, SimpleNamespace(splices_slipped_by=np.array([0.1]))
    (found,) = splice_slip_notes(test)
    assert found.severity == severity
    assert "before this test the splices slipped by about 100 mm or more" in str(found)
    # 100 mm over a free length of 2.5 m
    assert "4.0 percentage points too large (2.5 % of the mean strain)" in str(found)


def test_a_hold_after_a_slip_has_the_same_excess():
    test = reduced(spread=0.004)
    test.slips, test.amplitude = None, None
    test.history = SimpleNamespace(splices_slipped_by=np.array([0.1]))
    test.strain_standard_uncertainty = np.array([0.004])
    test.holds = (
        SimpleNamespace(
            specimen="new", hold_duration=60.0, hold_strain=1.6, hold_initial_tension=400.0
        ),
    )
    (found,) = splice_slip_notes(test)
    assert found.severity == "warning"
    assert "4.0 percentage points too large (2.5 % of the mean strain)" in str(found)


@pytest.mark.parametrize("stated", [0.0, 1e-12])
def test_a_compliance_whose_uncertainty_is_stated_is_not_asked_for(stated):
    test = reduced(spread=0.004)
    test.amplitude.apparent_spring_constant = np.array([4e5])
    test.amplitude.frequency = np.array([0.1])
    test.specimens[0].linear_density, test.specimens[0].is_rope = None, False
    test.cycles = None
    test.amplitude.uncertainty["apparent_spring_constant"] = np.array([4.0])
    test.amplitude.hysteresis_energy = np.array([40.0])
    test.amplitude.uncertainty["hysteresis_energy"] = np.array([4.0])
    test.record = SimpleNamespace(load_train=LoadTrain())
    errors = InstrumentErrors("new", machine_compliance=stated)
    codes = [one.code for one in load_train_notes(test, [errors])]
    assert ("compliance-matters" in codes) == (stated == 0)
