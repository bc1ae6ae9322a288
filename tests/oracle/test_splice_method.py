"""Strain by position alone, on splices that follow tension: its error against a loop made of both.

The marks of a synthetic tether over a narrow range of tension give a line; the loop is read with
it, and beside it with the law of tension that made the splices.
"""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import StrainSettings
from reduction.stages.strain.strain_fit import fit_strain_model
from reduction.stages.strain.strain_model import StrainModel, strain_by_model
from reduction.uncertainty.error_field import _splice_method_error, error_field

FREE, SPLICES = 2.55, 1.19
HOLDS = np.array([0.0, 0.75, 1.0, 1.25])
METHODS = ("marks", "strain-ratio", "constant-fraction")


def middle(strain):
    return np.where(strain > 0, 420 * strain + 90 * (strain - 0.6) ** 2 + 40, 0)


def splices(tension):
    """Straight in tension, so that a law with the exponent held at 1 is exact. [m]."""
    return SPLICES * (1 + 0.22 / 450 * tension)


LAW = StrainModel(
    "new", "tension-driven",
    {"relaxed_free_length": FREE, "relaxed_splice_length": SPLICES,
     "splice_compliance": 0.22 / 450, "splice_exponent": 1.0},
)  # fmt: skip


def marks_of(tension):
    free, both = FREE * (1 + HOLDS), splices(tension)
    return SpliceMarks(
        "new", ("T",) * 4, ("slack", "min", "centre", "max"), both / 2, both / 2 + free, both + free
    )


def model_by(method):
    tension = middle(HOLDS)
    fitted = fit_strain_model(
        Specimen("new"), test_id="T", marks=marks_of(tension), mark_tension=tension,
        settings=StrainSettings(method=method),
    )  # fmt: skip
    # as many marks would say
    return replace(fitted, by_marks=LAW)


def loop():
    turn = np.linspace(0, 2 * np.pi, 20_001)
    strain = 1 - 0.25 * np.cos(turn)
    return strain, middle(strain) + 15 * np.sin(turn)


@pytest.mark.parametrize("method", METHODS)
def test_the_error_of_strain_is_what_the_law_of_tension_says_at_every_sample(method):
    strain, tension = loop()
    position = FREE * (1 + strain) + splices(tension)
    model = model_by(method)
    read = strain_by_model(model, position=position, tension=tension)
    error, _, _ = _splice_method_error(model, strain=read, tension=tension)
    assert error == pytest.approx(read - strain, abs=2e-6)


@pytest.mark.parametrize("method", METHODS)
def test_the_energy_of_a_loop_is_wrong_by_its_divergence(method):
    strain, tension = loop()
    model = model_by(method)
    read = strain_by_model(model, position=FREE * (1 + strain) + splices(tension), tension=tension)
    energy, true = (abs(np.trapezoid(tension, one)) for one in (read, strain))
    field = error_field(InstrumentErrors("new"), model, strain=1.0, tension=float(middle(1.0)))
    at = [one.source for one in field.component].index("splice_method")
    # of the energy as it was read
    assert field.divergence[at] == pytest.approx(1 - true / energy, rel=1e-3)
    assert -0.3 < field.divergence[at] < -0.05


def test_the_slope_over_tension_is_that_of_the_error():
    model = model_by("marks")
    above, below, at = (
        _splice_method_error(model, strain=1.0, tension=force) for force in (481.0, 479.0, 480.0)
    )
    assert at[2] == pytest.approx((above[0] - below[0]) / 2, rel=1e-6)


def test_without_a_law_to_judge_by_there_is_no_such_error():
    model = replace(model_by("marks"), by_marks=None)
    assert _splice_method_error(model, strain=1.0, tension=480.0) is None


def test_a_slack_specimen_has_no_slope_over_tension():
    assert _splice_method_error(model_by("marks"), strain=0.0, tension=0.0)[2] == 0


def test_what_is_asked_for_is_judged_by_the_laws_that_the_marks_do_not_reject():
    tension = middle(HOLDS)
    marks = marks_of(tension)
    by_position = fit_strain_model(
        Specimen("new"), test_id="T", marks=marks, settings=StrainSettings(method="marks")
    )
    assert by_position.by_marks.coefficients["splice_compliance"] == 0
    by_both = fit_strain_model(
        Specimen("new"), test_id="T", marks=marks, mark_tension=tension,
        settings=StrainSettings(method="marks"),
    )  # fmt: skip
    assert by_both.by_marks.coefficients["splice_compliance"] > 0
    sources = [
        one.source
        for one in error_field(
            InstrumentErrors("new"), by_both, strain=1.3, tension=float(middle(1.3))
        ).component
    ]
    assert {"splice_method", "splice_law"} <= set(sources)
