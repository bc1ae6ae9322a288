"""What a slip of the splices adds to the interval of strain, and to that of which cycles."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.stages.moduli.modulus_product import Slips
from reduction.stages.strain.mark_readings import slack_growth, tape_error, tape_freedom
from reduction.stages.strain.strain_fit import PooledMarks, average_over_laws, fit_strain_model
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.errors_of_cycles import (
    errors_after_slip,
    slipped_by_cycle,
    with_splice_slips,
)

# one metre of stroke is a strain of 40 %
LINE = StrainModel(
    "new", "marks",
    {"free_length_intercept": 0.0, "free_length_slope": 1.0, "relaxed_free_length": 2.5},
)  # fmt: skip
BY_STEPS = Component("splice_slip", "new")


def slipped_test(before=0.0):
    """Ten cycles; 40 mm at the fifth, 60 mm at the eighth, ninth or tenth."""
    nothing = np.zeros(3)
    slips = Slips(
        specimen=("new", "new", "used"), slip_cycle=np.array([5, 8, 2]),
        slip_cycle_low=np.array([5, 8, 2]), slip_cycle_high=np.array([5, 10, 2]),
        slip_tension_step=nothing, slip_tension_step_standard_uncertainty=nothing,
        slip_length=np.array([0.04, 0.06, 0.5]), slip_length_standard_uncertainty=nothing,
        creep_per_cycle=nothing,
    )  # fmt: skip
    return SimpleNamespace(
        cycles=SimpleNamespace(n_cycles=10), slips=slips, specimens=(SimpleNamespace(name="new"),),
        history=SimpleNamespace(splices_slipped_by=np.array([before])),
    )  # fmt: skip


def rows_of(errors, model=LINE):
    field = error_field(errors, model, strain=1.0, tension=450.0)
    return dict(zip(field.component, field.strain.tolist(), strict=True))


@pytest.mark.parametrize("before", [0.0, 0.05])
def test_the_length_that_a_step_of_tension_says_is_the_least_and_its_double_the_most(before):
    """At 40 % of strain a metre; the root mean square of what may be let out, about zero."""
    least = 0.1 + before
    possible = np.linspace(least, 2 * least, 100_001)
    (errors,) = with_splice_slips(slipped_test(before), [InstrumentErrors("new")])
    assert rows_of(errors)[BY_STEPS] == pytest.approx(0.4 * np.sqrt(np.mean(possible**2)), rel=1e-4)


def test_slips_by_marks_are_an_error_of_their_own_and_an_extensometer_has_neither():
    errors = InstrumentErrors("new", splice_slip=0.01, splices_slipped_by=0.02, test="T-1")
    found = rows_of(errors)
    assert found[Component("splice_slip", "new, marks of T-1")] == pytest.approx(0.004)
    assert found[BY_STEPS] == pytest.approx(0.008)
    assert rows_of(errors, StrainModel("new", "extensometer")) == {}


def test_only_cycles_after_a_slip_have_it():
    test = slipped_test()
    ten = Contributions(
        (Component("position_offset", "crosshead"), BY_STEPS),
        {"mean_strain": np.ones((2, 10)), "chord_modulus": np.ones((2, 10, 2))},
    )
    found = slipped_by_cycle(ten, test, 0, slice(0, 10))
    # in hundredths of what was let out in the end; a third of the second slip in each cycle
    course = [0, 0, 0, 0, 0.4, 0.4, 0.4, 0.6, 0.8, 1.0]
    assert found.values["mean_strain"][1] == pytest.approx(course)
    assert found.values["chord_modulus"][1, :, 1] == pytest.approx(course)
    assert (found.values["mean_strain"][0] == 1).all()
    part = Contributions(ten.component, {"mean_strain": np.ones((2, 3))})
    found = slipped_by_cycle(part, test, 0, slice(7, 10))
    assert found.values["mean_strain"][1] == pytest.approx(course[7:])


def test_a_mean_over_cycles_has_the_share_of_those_after_the_slip():
    test = slipped_test()
    errors = InstrumentErrors("new", splices_slipped_by=1.0)
    assert errors_after_slip(test, 0, errors, slice(0, 4)).splices_slipped_by == 0.0
    assert errors_after_slip(test, 0, errors, slice(3, 5)).splices_slipped_by == pytest.approx(0.2)
    assert errors_after_slip(test, 0, errors, np.array([0, 9])).splices_slipped_by == pytest.approx(
        0.5
    )


FREE, SPLICES = 2.5, 1.2  # m


def slipping_marks(slip, *, is_slack_alone=False):
    """Tape readings of tests whose splices are longer by ``slip`` [m], else by 20 % at 100 %."""
    strain = np.array([0.0, 0.75, 1.0, 1.25])
    rows = [
        (f"T-{order}", hold, 0.6 * (1 + 0.2 * one) + more / 2,
         FREE * (1 + one), SPLICES * (1 + 0.2 * one) + more, 450 * one)
        for order, more in enumerate(slip, start=1)
        for hold, one in zip(("slack", "min", "centre", "max"), strain, strict=True)
        for more in [more * (hold == "slack" or not is_slack_alone)]
    ]  # fmt: skip
    tests, holds, near, free, both, tension = zip(*rows, strict=True)
    near, free, both = np.array(near), np.array(free), np.array(both)
    marks = SpliceMarks("new", tests, holds, near, near + free, free + both,
                        reading_uncertainty=5e-4, is_reading_stated=True)  # fmt: skip
    return marks, np.array(tension)


def model_of(test, slip, **options):
    marks, tension = slipping_marks(slip, **options)
    average = average_over_laws(PooledMarks(marks, tension, np.zeros(tension.size, dtype=bool)))
    return fit_strain_model(
        Specimen("new"), test_id=test, marks=marks, mark_tension=tension, average=average
    )


def test_what_slips_between_the_marks_of_two_tests_may_have_slipped_at_any_moment_between():
    """20 mm between T-1 and T-2: 10 mm of them are counted, with the spread of an even chance."""
    slip = (0.0, 0.02, 0.03)
    first, second, last = (model_of(f"T-{number}", slip) for number in (1, 2, 3))
    assert first.splice_slip == pytest.approx(0.02 / 12**0.5, rel=0.03)
    assert second.splice_slip == pytest.approx(0.01 / 12**0.5, rel=0.03)
    # T-2 begins 20 mm longer and is taken in the middle of its own 10 mm
    offset = [SPLICES * one.coefficients["splice_offset"] for one in (first, second)]
    assert offset[1] - offset[0] == pytest.approx(0.025 - 0.010, rel=0.03)
    # after T-3 no mark was read: as large as before on average, and as uncertain
    usual = ((0.02**2 + 0.01**2) / 2) ** 0.5
    assert last.splice_slip == pytest.approx(usual * (5 / 12) ** 0.5, rel=0.03)


def test_a_slack_length_that_grows_is_any_length_from_first_to_last():
    """4 mm from the first slack row to all others, which the laws of stretched splices pass."""
    model = model_of("T-2", (0.0, 0.004, 0.004, 0.004), is_slack_alone=True)
    assert any(one.code == "slack-length-grows" for one in model.notes)
    assert model.splice_slip == pytest.approx(0.004 / 12**0.5)


def seated(step):
    """Slack rows of four tests, the first shorter by a step; no error of the tape is stated."""
    marks, tension = slipping_marks((0.0, step, step, step), is_slack_alone=True)
    return replace(marks, reading_uncertainty=1.24e-3, is_reading_stated=False), tension


@pytest.mark.parametrize(("step", "severity"), [(0.04, "note"), (0.09, "warning")])
def test_what_a_tether_keeps_of_its_first_stretch_is_no_scatter_of_the_tape(step, severity):
    """It keeps 1.1 % or 2.4 % of its slack length; the rows after that agree exactly."""
    marks, tension = seated(step)
    rows = PooledMarks(marks, tension, np.zeros(tension.size, dtype=bool))
    of_reading = np.array([[2.0, -2.0], [-2.0, 3.0]])
    np.testing.assert_allclose(rows.relaxed().covariance, 1.24e-3**2 * of_reading / 4)
    np.testing.assert_allclose(rows.relaxed().values, [FREE, SPLICES + 0.75 * step])
    # nine readings after the step, about three means
    assert tape_freedom(marks, slack_growth(marks).course) == 4 + 9 - 3
    assert tape_error(marks, slack_growth(marks).course) == 1.24e-3
    model = fit_strain_model(Specimen("new"), test_id="T-2", marks=marks, mark_tension=tension)
    (told,) = [one for one in model.notes if one.code.startswith("slack-")]
    assert (told.severity, told.numbers["growth"]) == (severity, pytest.approx(step))
    assert model.splice_slip == pytest.approx(step / 12**0.5)


def test_a_set_that_grows_from_test_to_test_accuses_no_row():
    """Readings of a generated tether that keeps 12 mm in four tests; tape good to 1.5 mm."""
    marks, tension = seated(0.0)
    slack = np.flatnonzero(marks.is_slack)
    rows = {
        "near_toe": [2.19, 2.19, 2.20, 2.20], "far_toe": [10.68, 10.69, 10.70, 10.72],
        "far_thimble": [12.37, 12.39, 12.39, 12.41],
    }  # fmt: skip
    columns = {name: getattr(marks, name).copy() for name in rows}
    for name, feet in rows.items():
        columns[name][slack] = np.array(feet) * 0.3048
    marks = replace(marks, reading_uncertainty=0.001524, is_reading_stated=True, **columns)
    assert slack_growth(marks).length == pytest.approx(3 * 0.012 * 0.3048)
    model = fit_strain_model(Specimen("new"), test_id="T-2", marks=marks, mark_tension=tension,
                             average=average_over_laws(PooledMarks(*seated(0.0), tension < 0)))  # fmt: skip
    assert [one.code for one in model.notes if "slack" in one.code] == ["slack-length-grows"]


@pytest.mark.parametrize("thimble", [(0, 0, 0, 0.04), (0, 0.04, 0, 0), (0.04, 0, 0, 0)])
def test_a_single_slack_row_that_is_off_is_no_growth(thimble):
    marks, _ = slipping_marks(thimble, is_slack_alone=True)
    assert slack_growth(marks).length == 0.0


def test_one_reading_of_the_first_slack_row_that_is_off_is_no_growth():
    marks, tension = seated(0.0)
    far_toe = marks.far_toe.copy()
    far_toe[0] -= 0.04
    marks = replace(marks, far_toe=far_toe)
    model = fit_strain_model(Specimen("new"), test_id="T-2", marks=marks, mark_tension=tension)
    (told,) = [one for one in model.notes if one.code.startswith("slack-")]
    assert (told.code, told.numbers["test"]) == ("slack-rows-differ", "T-1")


def test_marks_without_a_slip_add_nothing():
    assert model_of("T-2", (0.0, 0.0, 0.0)).splice_slip == 0.0
