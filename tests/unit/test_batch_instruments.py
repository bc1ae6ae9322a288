"""By what names tests share the errors of their strain models."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.batch.survey import Survey
from reduction.batch.test_history import instruments_of
from reduction.campaign.plan import TestPlan
from reduction.record.contributions import StatedErrors
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import ReductionSettings, StrainSettings
from reduction.stages.strain.strain_fit import fit_strain_model
from reduction.stages.strain.zero_strain import ZeroStrain

# lengths of WHOI-2005-10, Table 3, new tether, in feet; the slack row of T-2 reads otherwise
MARKS = SpliceMarks(
    "new", ("T-1", "T-1", "T-1", "T-2"), ("slack", "min", "max", "slack"),
    near_toe=np.array([2.06, 2.42, 2.69, 2.06]), far_toe=np.array([10.44, 17.22, 21.72, 10.48]),
    far_thimble=np.array([12.26, 19.37, 24.12, 12.26]),
)  # fmt: skip
METHODS = ("tension-driven", "marks", "strain-ratio", "constant-fraction", "gauge-length")
CAMPAIGN = SimpleNamespace(
    uncertainty=StatedErrors(), specimens={"new": Specimen("new", gauge_length=8.4)}
)


def model_of(log, method):
    return fit_strain_model(
        CAMPAIGN.specimens["new"], test_id=log, marks=MARKS,
        mark_tension=np.array([0.0, 380.0, 600.0, 0.0]), settings=StrainSettings(method=method),
        zero=ZeroStrain(0.0),
    )  # fmt: skip


def instruments_by(log, model, **found):
    plan = TestPlan(
        id=log, kind="cyclic", files=((f"{log}.csv", "logger"),), specimens=("new",), order=None,
        control="position", waveform="triangular", target_strain=(), attributes={},
        settings=ReductionSettings(), log=log, step_place=0,
    )  # fmt: skip
    return instruments_of(CAMPAIGN, Survey(plan, **found), [model])[0]


def name_of(log, model):
    return instruments_by(log, model).strain_model


def test_models_of_one_name_have_the_same_coefficients():
    """Three tests: one with marks of its own, one with a slack row alone, two without any."""
    coefficients = {}
    for log in ("T-1", "T-2", "T-3", "T-4"):
        for method in METHODS:
            model = model_of(log, method)
            name = name_of(log, model)
            assert coefficients.setdefault(name, model.coefficients) == model.coefficients
            assert name.startswith(f"new, {method}")
    assert len(coefficients) > len(METHODS)


@pytest.mark.parametrize("method", METHODS)
def test_tests_without_marks_of_their_own_share_what_is_pooled(method):
    names = {name_of(log, model_of(log, method)) for log in ("T-3", "T-4")}
    assert names == {f"new, {method}"}


@pytest.mark.parametrize(
    ("log", "method", "name"),
    [
        ("T-1", "tension-driven", "new, tension-driven"),
        ("T-1", "marks", "new, marks, marks of T-1"),
        ("T-2", "marks", "new, marks"),
        ("T-2", "constant-fraction", "new, constant-fraction, marks of T-2"),
    ],
)
def test_a_name_says_specimen_method_and_the_test_whose_marks_they_are(log, method, name):
    assert name_of(log, model_of(log, method)) == name


@pytest.mark.parametrize(("length", "zero"), [(None, 0.0), (3.7, 3.7)])
def test_the_scale_of_a_displacement_reads_zero_at_its_reference_length(length, zero):
    errors = instruments_by("T-1", model_of("T-1", "gauge-length"), reference_length=length)
    assert errors.position_of_scale_zero == zero


@pytest.mark.parametrize(("diameter", "error"), [((), 0.0), ((0.026,), 5e-5)])
def test_a_stated_error_of_diameters_is_one_of_specimens_that_have_a_diameter(
    monkeypatch, diameter, error
):
    """A rope without one, in a campaign with tethers, has no stress for it to change."""
    new = Specimen("new", gauge_length=8.4, diameter=diameter)
    monkeypatch.setattr(CAMPAIGN, "specimens", {"new": new})
    monkeypatch.setattr(CAMPAIGN, "uncertainty", StatedErrors(diameter=5e-5))
    assert instruments_by("T-1", model_of("T-1", "gauge-length")).diameter == error
