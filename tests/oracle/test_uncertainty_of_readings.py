"""Contributions to single numbers against logs that are made, wrong by one error, and read again.

Each number is computed twice more from the numbers themselves, with the error in them by hand:
a gain multiplies every tension, a zero is added to it, a gauge length or a diameter is another.
"""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import Contributions, InstrumentErrors
from reduction.record.measurement import StepReadings
from reduction.record.settings import HoldSettings
from reduction.stages.holds.relaxation_and_creep import reduce_holds
from reduction.stages.moduli.elastomer_laws import PARAMETERS, fit_elastomers, hyperelastic_stress
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.standstills import Standstills
from reduction.stages.strain.strain_model import StrainModel, position_by_model, strain_by_model
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.propagation import (
    chord_contributions,
    elastomer_contributions,
    hold_contributions,
    secant_contributions,
    stepwise_contributions,
    stress_contributions,
    with_diameter,
)

AREA = 5.48e-4
GAUGE = StrainModel("new", "gauge-length", {"reference_position": 2.55, "gauge_length": 2.55})
ERRORS = {
    "tension_gain": 1e-3,
    "tension_offset": 0.5,
    "position_gain": 1e-4,
    "position_offset": 1e-4,
}


def logged(source, size, *, strain, tension):
    """Strain and tension of a log that is wrong by one error."""
    position = position_by_model(GAUGE, strain=strain, tension=tension)
    if source == "position_gain":
        position = position * (1 + size)
    if source == "position_offset":
        position = position + size
    load = tension * (1 + size) if source == "tension_gain" else np.asarray(tension, dtype=float)
    load = load + size if source == "tension_offset" else load
    return strain_by_model(GAUGE, position=position, tension=load), load


def change_of(number, source, **truth):
    """Central difference of a number over an error."""
    size = ERRORS[source]
    above, below = (number(*logged(source, way * size, **truth)) for way in (1, -1))
    return (np.asarray(above) - np.asarray(below)) / 2


def errors_of(source):
    return InstrumentErrors("new", **{source: ERRORS[source]})


@pytest.mark.parametrize("source", ERRORS)
def test_a_secant_and_a_chord_change_as_their_log_says(source):
    strain, tension = np.array([0.8, 1.25]), np.array([380.0, 610.0])
    errors = errors_of(source)
    low, high = (
        error_field(errors, GAUGE, strain=strain[row], tension=tension[row]) for row in (0, 1)
    )
    secant = secant_contributions(
        high, errors, strain=1.25, secant_modulus=610 / AREA / 1.25, area=AREA
    ).values["secant_modulus"]
    wanted = change_of(lambda e, t: t[1] / AREA / e[1], source, strain=strain, tension=tension)
    assert float(secant.sum()) == pytest.approx(wanted, rel=1e-3, abs=1.0)
    chord = chord_contributions(low, high, stroke=0.45, chord=230 / 0.45).values["chord"]
    wanted = change_of(
        lambda e, t: np.diff(t)[0] / np.diff(e)[0], source, strain=strain, tension=tension
    )
    assert float(chord.sum()) == pytest.approx(wanted, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("source", ERRORS)
def test_stress_at_a_strain_changes_as_its_log_says(source):
    strain = np.linspace(0.5, 1.5, 2001)
    tension = 420 * strain + 90 * (strain - 0.6) ** 2 + 40
    slope = 420 + 180 * (1.0 - 0.6)
    stress = np.interp(1.0, strain, tension) / AREA
    errors = errors_of(source)
    field = error_field(errors, GAUGE, strain=1.0, tension=stress * AREA)
    found = stress_contributions(field, errors, stress=stress, tension_slope=slope, area=AREA)
    wanted = change_of(
        lambda e, t: np.interp(1.0, e, t) / AREA, source, strain=strain, tension=tension
    )
    assert float(found.values["stress"].sum()) == pytest.approx(wanted, rel=2e-3, abs=1.0)


def test_a_diameter_is_in_stress_and_modulus_twice():
    size, u = np.sqrt(4 * AREA / np.pi), 1e-5
    areas = [np.pi * (size + way * u) ** 2 / 4 for way in (1, -1)]
    wanted = (500 / areas[0] - 500 / areas[1]) / 2
    none = Contributions((), {"stress": np.empty((0,)), "tension": np.empty((0,))})
    found = with_diameter(
        none, InstrumentErrors("new", diameter=u), {"stress": np.array(500 / AREA)}, area=AREA
    )
    assert found.values["stress"][0] == pytest.approx(wanted, rel=1e-5)
    assert found.values["tension"][0] == 0


def held(strain, tension, kind):
    """A ramp of 10 s and a hold of half an hour at one length, or under one tension."""
    time = np.arange(0.0, 1800.0, 0.5)
    stand = Standstills(
        first=np.array([20]), last=np.array([time.size - 1]), start_time=np.array([10.0]),
        end_time=time[-1:], mean_position=np.array([5.0]), mean_tension=np.array([[400.0]]),
        is_rest=np.array([False]), position_tolerance=0.05, slack_tension=5.0,
        tension_tolerance=1.0 if kind == "creep" else None,
    )  # fmt: skip
    position = position_by_model(GAUGE, strain=strain, tension=tension)
    (hold,) = reduce_holds(
        time, position, [tension], [strain], stand, specimens=("new",),
        settings=HoldSettings(times=(10.0, 100.0, 1000.0)), kind=kind,
    )  # fmt: skip
    return hold


def true_hold(kind):
    time = np.arange(0.0, 1800.0, 0.5)
    since = np.clip(time - 10, 0, None)
    rise = np.clip(time / 10, 0, 1)
    noise = np.random.default_rng(3).normal(0, 1e-3, (2, time.size))
    if kind == "creep":
        grown = 0.02 * np.log10(1 + since)
        return rise * (1 + grown) + 1e-2 * noise[0], 400 * rise + noise[1]
    relaxed = 325 + 40 * np.exp(-since / 30) + 35 * np.exp(-since / 400)
    return rise + 1e-4 * noise[0], np.where(time < 10, 400 * rise, relaxed) + noise[1]


@pytest.mark.parametrize("kind", ["relaxation", "creep"])
@pytest.mark.parametrize("source", ERRORS)
def test_the_numbers_of_a_hold_change_as_its_log_says(kind, source):
    strain, tension = true_hold(kind)
    hold = held(strain, tension, kind)
    above, below = (
        held(*logged(source, way * ERRORS[source], strain=strain, tension=tension), kind)
        for way in (1, -1)
    )

    def field_at(e, t):
        return error_field(errors_of(source), GAUGE, strain=e, tension=t)

    found = hold_contributions(field_at, hold).values
    rate = "creep_rate_per_decade" if kind == "creep" else "relaxation_rate_per_decade"
    names = {
        "hold_strain": "hold_strain", "hold_initial_tension": "hold_initial_tension",
        "hold_final_tension": "hold_final_tension", "tension_at_time": "tension_at_time",
        "strain_at_time": "strain_at_time", "rate_per_decade": rate,
    }  # fmt: skip
    if kind == "relaxation":
        names |= {name: name for name in ("relaxation_drop", "prony_tension", "long_time_tension")}
    for name, stored in names.items():
        wanted = (np.asarray(getattr(above, name)) - np.asarray(getattr(below, name))) / 2
        scale = np.max(np.abs(np.asarray(getattr(hold, name))))
        assert scale > 0, name
        assert found[stored].sum(axis=0) == pytest.approx(wanted, rel=0.02, abs=1e-6 * scale), name


def test_a_gain_leaves_what_is_a_share_of_tension():
    strain, tension = true_hold("relaxation")
    hold = held(strain, tension, "relaxation")

    def field_at(e, t):
        return error_field(errors_of("tension_gain"), GAUGE, strain=e, tension=t)

    found = hold_contributions(field_at, hold).values
    assert found["relaxation_drop"] == pytest.approx(0, abs=1e-12)
    assert found["relaxation_rate_per_decade"] == pytest.approx(0, abs=1e-12)
    assert np.isnan(found["creep_rate_per_decade"]).all()


@pytest.mark.parametrize(
    ("law", "parameters"),
    [
        ("neo-hookean", {"shear_modulus": 4e5}),
        ("mooney-rivlin", {"c10": 2e5, "c01": 5e4}),
        ("yeoh", {"c10": 2e5, "c20": -4e3, "c30": 300.0}),
    ],
)
@pytest.mark.parametrize("source", ERRORS)
def test_the_moduli_of_a_law_change_as_its_log_says(law, parameters, source):
    strain = np.linspace(0.01, 2.0, 400)
    tension = hyperelastic_stress(strain, law=law, parameters=parameters) * AREA

    def moduli(e, t):
        at = np.interp(strain, e, t)[10:-10] / AREA
        fit = next(
            one for one in fit_elastomers(strain[10:-10], at, specimen="new") if one.law == law
        )
        return [fit.parameters[name] for name in PARAMETERS[law]]

    wide = np.linspace(0.0, 2.05, 20_001)
    wanted = change_of(
        moduli, source, strain=wide,
        tension=hyperelastic_stress(wide, law=law, parameters=parameters) * AREA,
    )  # fmt: skip
    errors = errors_of(source)
    field = error_field(errors, GAUGE, strain=strain, tension=tension)
    stress = stress_contributions(
        field, errors, stress=tension / AREA, tension_slope=np.gradient(tension, strain), area=AREA
    )
    found = elastomer_contributions(
        stress.values["stress"][:, 10:-10], strain=strain[10:-10], stress=tension[10:-10] / AREA,
        law=law, parameters=parameters,
    )  # fmt: skip
    assert found.sum(axis=0) == pytest.approx(wanted, rel=0.02, abs=2.0)


def test_a_gain_scales_the_moduli_of_ogden_and_leaves_its_exponents():
    strain = np.linspace(0.05, 2.0, 200)
    known = {"modulus_1": 3e5, "modulus_2": -2e4, "exponent_1": 1.8, "exponent_2": -2.5}
    stress = hyperelastic_stress(strain, law="ogden-2", parameters=known)
    fitted = fit_elastomers(strain, stress, specimen="new")[-1].parameters
    found = elastomer_contributions(
        [1e-3 * stress], strain=strain, stress=stress, law="ogden-2", parameters=fitted
    )
    wanted = [1e-3 * fitted[name] * name.startswith("modulus") for name in PARAMETERS["ogden-2"]]
    assert found[0] == pytest.approx(wanted, rel=1e-4, abs=1e-6)


def test_a_law_without_an_error_has_no_contribution():
    none = elastomer_contributions(
        np.empty((0, 5)), strain=np.arange(5.0), stress=np.arange(5.0), law="neo-hookean",
        parameters={"shear_modulus": 1e5},
    )  # fmt: skip
    assert none.shape == (0, 1)


STEPS = StepReadings(
    clock=tuple("abcdef"), time=np.arange(6.0) * 60,
    tension=np.array([0.0, 50.0, 100.0, 160.0, 220.0, 290.0]),
    length=np.array([0.155, 0.18, 0.21, 0.25, 0.30, 0.36]),
    eye_to_eye_length=np.full(6, np.nan), printed_strain=np.full(6, np.nan),
    length_standard_uncertainty=5e-4,
)  # fmt: skip


def stepwise(**changed):
    gauge = changed.pop("gauge", 0.155)
    area = changed.pop("area", AREA)
    return reduce_stepwise(replace(STEPS, **changed), area=area, stated_gauge_length=gauge)


SIZE_OF_STEPS = {
    "tension_gain": 1e-3, "tension_offset": 0.01, "gauge": 1e-5, "diameter": 1e-5,
    "stiffness": 1e-3, "strain_gain": 1e-3,
}  # fmt: skip


@pytest.mark.parametrize("source", SIZE_OF_STEPS)
def test_a_stepwise_test_changes_as_its_readings_say(source):
    size = SIZE_OF_STEPS[source]
    wide = np.sqrt(4 * AREA / np.pi)

    def wrong(way):
        if source == "gauge":
            return stepwise(gauge=0.155 + way * size)
        if source == "diameter":
            return stepwise(area=np.pi * (wide + way * size) ** 2 / 4)
        if source in ("stiffness", "strain_gain"):
            # a stiffer tether stretches less under the same weights
            longer = 1 / (1 + way * size) if source == "stiffness" else 1 + way * size
            return stepwise(length=0.155 + longer * (STEPS.length - 0.155))
        gain, offset = (size, 0.0) if source == "tension_gain" else (0.0, size)
        return stepwise(tension=STEPS.tension * (1 + way * gain) + way * offset)

    result = stepwise()
    errors = InstrumentErrors("new")
    if source == "gauge":
        result = replace(result, gauge_length_standard_uncertainty=size)
    else:
        errors = InstrumentErrors("new", **{source: size})
    found = stepwise_contributions(result, errors, area=AREA)
    above, below = wrong(1), wrong(-1)
    for name, rows in found.values.items():
        wanted = (getattr(above, name) - getattr(below, name)) / 2
        there = np.isfinite(wanted)
        assert there.sum() > 3
        scale = np.max(np.abs(getattr(result, name)[there]))
        assert rows.sum(axis=0)[there] == pytest.approx(
            wanted[there], rel=2e-3, abs=1e-8 * scale
        ), name
