"""Contributions against a loop that is made, logged with one error, and read again.

The loop is of a law in closed form; strain is found from the logged position and tension as the
reduction finds it, and every quantity is read off the points by plain numerical means.
"""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.stages.strain.strain_model import StrainModel, position_by_model, strain_by_model
from reduction.uncertainty.error_field import error_field
from reduction.uncertainty.propagation import (
    LoopQuantities,
    curve_contributions,
    loop_contributions,
    pull_contributions,
)

AREA = 5.48e-4
MEAN, AMPLITUDE, FREQUENCY = 1.0, 0.25, 0.05
LOSS = 12.0
MARKS = np.array([300.0, 430.0, 520.0, 610.0])
MODELS = {
    "tension-driven": StrainModel(
        "new",
        "tension-driven",
        {
            "relaxed_free_length": 2.55,
            "relaxed_splice_length": 1.19,
            "splice_compliance": 0.4 / 900**0.85,
            "splice_exponent": 0.85,
        },
        mark_tension=MARKS,
        mark_strain=np.zeros(4),
    ),
    "gauge-length": StrainModel(
        "new", "gauge-length", {"reference_position": 2.55, "gauge_length": 2.55}
    ),
    "marks": StrainModel(
        "new",
        "marks",
        {
            "free_length_intercept": -0.835,
            "free_length_slope": 0.905,
            "relaxed_free_length": 2.55,
        },
    ),
}


def law(strain):
    """Tension of the middle of the loop. [N]."""
    return 420 * strain + 90 * (strain - 0.6) ** 2 + 40


def slope(strain):
    return 420 + 180 * (strain - 0.6)


def bend(strain):
    """Second derivative of the rising branch: of the law, and of half an ellipse. [N]."""
    place = (strain - MEAN) / AMPLITUDE
    return 180 - LOSS / AMPLITUDE**2 * (1 - place**2) ** -1.5


def read(model, *, gain=0.0, offset=0.0, position_gain=0.0, position_offset=0.0, late=0.0):
    """Strain and tension as the reduction has them from a log with these errors."""
    time = np.linspace(0, 1 / FREQUENCY, 40_001)
    turn = 2 * np.pi * FREQUENCY

    def true(t):
        strain = MEAN - AMPLITUDE * np.cos(turn * t)
        return strain, law(strain) + LOSS * np.sin(turn * t)

    strain, tension = true(time)
    position = position_by_model(model, strain=strain, tension=tension)
    logged_position = position * (1 + position_gain) + position_offset
    logged_tension = true(time - late)[1] * (1 + gain) + offset
    if model.method == "tension-driven":
        # the splice law, fitted again to what the tape says at the tensions that the cell says
        known = model.coefficients
        splice = known["splice_compliance"] * MARKS ** known["splice_exponent"]
        seen = MARKS * (1 + gain) + offset
        value = np.array([known["splice_compliance"] * 1e3, known["splice_exponent"]])
        for _ in range(20):
            fit = value[0] * 1e-3 * seen ** value[1]
            jacobian = np.stack([fit / value[0], fit * np.log(seen)], axis=1)
            value = value + np.linalg.lstsq(jacobian, splice - fit, rcond=None)[0]
        model = replace(
            model,
            coefficients={
                **known,
                "splice_compliance": value[0] * 1e-3,
                "splice_exponent": value[1],
            },
        )
    return strain_by_model(model, position=logged_position, tension=logged_tension), logged_tension


def quantities(strain, tension):
    """Read off the points: end to end, area, and the rising branch at five strains."""
    half = strain.size // 2
    at = MEAN + AMPLITUDE * np.array([-0.6, -0.3, 0.0, 0.3, 0.6])
    rising = slice(40, half - 40)
    modulus = np.gradient(tension[rising], strain[rising]) / AREA
    stretch, force = np.ptp(strain) / 2, np.ptp(tension) / 2
    energy = -float(np.trapezoid(strain, tension))
    return {
        "mean_tension": (tension.max() + tension.min()) / 2,
        "mean_strain": (strain.max() + strain.min()) / 2,
        "tension_amplitude": force,
        "strain_amplitude": stretch,
        "apparent_spring_constant": force / stretch,
        "hysteresis_energy": energy,
        "tangent_modulus": np.interp(at, strain[rising], modulus),
        "branch_tension": np.interp(at, strain[rising], tension[rising]),
    }


SMALL = {
    "tension_gain": ("gain", 1e-4),
    "tension_offset": ("offset", 0.05),
    "position_gain": ("position_gain", 1e-4),
    "position_offset": ("position_offset", 1e-4),
}
CASES = [(method, source) for method in MODELS for source in SMALL]


@pytest.mark.parametrize(("method", "source"), CASES)
def test_contributions_are_what_a_log_with_that_error_gives(method, source):
    model = MODELS[method]
    keyword, size = SMALL[source]
    above = quantities(*read(model, **{keyword: size}))
    below = quantities(*read(model, **{keyword: -size}))
    exact = quantities(*read(model))
    change = {name: (above[name] - below[name]) / 2 for name in exact}
    errors = InstrumentErrors("new", **{source: size})
    found = {**of_loop(errors, model, exact), **of_curve(errors, model, exact)}
    for name, wanted in change.items():
        scale = np.max(np.abs(exact[name]))
        # of first order on the law; the loss of the loop bends the ends by its own small share
        tolerance = 0.02 * np.max(np.abs(wanted)) + 1e-7 * scale
        assert found[name] == pytest.approx(wanted, abs=tolerance), name


def of_loop(errors, model, exact, waveform="sinusoidal"):
    turned = np.pi * exact["strain_amplitude"] ** 2
    loss = exact["hysteresis_energy"] / turned
    loop = LoopQuantities(
        frequency=np.array(FREQUENCY),
        storage_spring_constant=np.sqrt(exact["apparent_spring_constant"] ** 2 - loss**2),
        loss_spring_constant=np.array(loss),
        closed_loop_energy=np.array(exact["hysteresis_energy"]),
        **{
            name: np.array(exact[name])
            for name in (
                "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude",
                "apparent_spring_constant", "hysteresis_energy",
            )
        },
    )  # fmt: skip
    rows = loop_contributions(errors, model, loop, waveform=waveform)
    return {
        name: rows.values[name].sum(axis=0)
        for name in exact
        if name not in ("tangent_modulus", "branch_tension")
    }


def of_curve(errors, model, exact):
    at = MEAN + AMPLITUDE * np.array([-0.6, -0.3, 0.0, 0.3, 0.6])
    field = error_field(errors, model, strain=at, tension=exact["branch_tension"])
    modulus = exact["tangent_modulus"]
    rows = curve_contributions(
        field, errors, tangent_modulus=modulus, modulus_slope=bend(at) / AREA, area=AREA,
        strain_rate=2 * np.pi * FREQUENCY * np.sqrt(AMPLITUDE**2 - (at - MEAN) ** 2),
    )  # fmt: skip
    return {name: values.sum(axis=0) for name, values in rows.values.items()}


@pytest.mark.parametrize("method", MODELS)
def test_tension_that_is_logged_late_narrows_the_loop(method):
    model, late = MODELS[method], 1e-3
    exact = quantities(*read(model))
    change = quantities(*read(model, late=late))["hysteresis_energy"] - exact["hysteresis_energy"]
    found = of_loop(InstrumentErrors("new", lag=late), model, exact)
    # the law bends, so that the loop is no ellipse: the third harmonic has a share of its own
    assert found["hysteresis_energy"] == pytest.approx(change, rel=0.02)
    assert change < 0


@pytest.mark.parametrize("method", MODELS)
def test_tension_that_is_logged_late_is_lower_where_it_rises(method):
    model, late = MODELS[method], 1e-3
    exact = quantities(*read(model))
    change = quantities(*read(model, late=late))["branch_tension"] - exact["branch_tension"]
    found = of_curve(InstrumentErrors("new", lag=late), model, exact)["branch_tension"]
    assert found == pytest.approx(change, rel=0.02)
    assert np.all(change < 0)


@pytest.mark.parametrize("source", SMALL)
def test_contributions_to_a_slow_pull_are_what_its_log_gives(source):
    model = MODELS["tension-driven"]
    keyword, size = SMALL[source]
    strain = np.linspace(0.5, 1.5, 20_001)
    force = law(strain)
    wanted_at = 500.0

    def constant(sign):
        errors = {keyword: sign * size}
        known = model.coefficients
        position = position_by_model(model, strain=strain, tension=force)
        position = position * (1 + errors.get("position_gain", 0.0))
        position = position + errors.get("position_offset", 0.0)
        seen = force * (1 + errors.get("gain", 0.0)) + errors.get("offset", 0.0)
        splice = known["splice_compliance"] * MARKS ** known["splice_exponent"]
        marks = MARKS * (1 + errors.get("gain", 0.0)) + errors.get("offset", 0.0)
        exponent, factor = np.polyfit(np.log(marks), np.log(splice), 1)
        fitted = replace(
            model,
            coefficients={
                **known,
                "splice_compliance": np.exp(factor),
                "splice_exponent": exponent,
            },
        )
        read_strain = strain_by_model(fitted, position=position, tension=seen)
        return 1 / np.interp(wanted_at, seen, np.gradient(read_strain, seen))

    change = (constant(1) - constant(-1)) / 2
    at = np.interp(wanted_at, force, strain)
    stiffness = slope(at)
    bend = -180 / stiffness**3
    field = error_field(
        InstrumentErrors("new", **{source: size}), model, strain=at, tension=wanted_at
    )
    found = pull_contributions(
        field, quasi_static_spring_constant=stiffness, compliance_slope=bend
    ).values["quasi_static_spring_constant"]
    assert float(found.sum()) == pytest.approx(change, abs=0.02 * abs(change) + 1e-6 * stiffness)


def elastic(stiffer, *, control):
    """A loop of a material that is stiffer by a share, T = K strain + loss, under one machine."""
    turn = np.linspace(0, 2 * np.pi, 100_001)
    held = 100.0 + 20.0 * np.sin(turn) if control == "load" else 0.5 + 0.1 * np.sin(turn)
    lag = 0.08  # of the strain behind the tension, in radians
    if control == "load":
        strain = (0.5 + 0.1 * np.sin(turn - lag)) / (1 + stiffer)
        return strain, held
    return held, (1 + stiffer) * (100.0 + 20.0 * np.sin(turn + lag))


@pytest.mark.parametrize("control", ["position", "load"])
def test_a_warmer_specimen_moves_what_the_machine_does_not_set(control):
    share = 1e-3

    def seen(stiffer):
        strain, tension = elastic(stiffer, control=control)
        half, force = np.ptp(strain) / 2, np.ptp(tension) / 2
        energy = -float(np.trapezoid(strain, tension))
        return {
            "mean_tension": (tension.max() + tension.min()) / 2,
            "tension_amplitude": force,
            "peak_tension": tension.max(),
            "valley_tension": tension.min(),
            "mean_strain": (strain.max() + strain.min()) / 2,
            "strain_amplitude": half,
            "apparent_spring_constant": force / half,
            "hysteresis_energy": abs(energy),
            "loss_spring_constant": abs(energy) / (np.pi * half**2),
        }

    above, below, exact = seen(share), seen(-share), seen(0.0)
    loop = LoopQuantities(
        frequency=np.array(FREQUENCY),
        storage_spring_constant=np.array(exact["apparent_spring_constant"]),
        closed_loop_energy=np.array(exact["hysteresis_energy"]),
        **{
            name: np.array(exact[name])
            for name in exact if name not in ("peak_tension", "valley_tension")
        },
    )  # fmt: skip
    rows = loop_contributions(
        InstrumentErrors("new", stiffness=share, test="T"), MODELS["gauge-length"], loop,
        waveform="sinusoidal", control=control,
    )  # fmt: skip
    for name, value in exact.items():
        wanted = (above[name] - below[name]) / 2
        assert rows.values[name].sum(axis=0) == pytest.approx(wanted, abs=1e-5 * abs(value)), name
