"""The field of errors: many points at once, and what the temperature leaves alone."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import curve_fit

from reduction.record.contributions import Component, InstrumentErrors
from reduction.record.measurement import LoadTrain
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.moduli.elastomer_laws import fit_elastomers, hyperelastic_stress
from reduction.stages.strain.strain_model import (
    StrainModel,
    _tension_driven_strain,
    strain_by_model,
)
from reduction.uncertainty.effects_on_answers import load_train_notes
from reduction.uncertainty.error_field import _load_parts, coefficient_errors, error_field
from reduction.uncertainty.errors_of_curves import (
    _friction_on_branches,
    _logged_rates,
    _of_slack,
    _reversibility_on_branches,
    errors_of_material,
)
from reduction.uncertainty.errors_of_cycles import _of_hold
from reduction.uncertainty.propagation import (
    LoopQuantities,
    elastomer_contributions,
    loop_contributions,
)

MODEL = StrainModel(
    "new", "tension-driven",
    {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.2, "splice_compliance": 5e-4,
     "splice_exponent": 0.9},
    np.diag([1e-6, 2e-6, 1e-10, 1e-4]),
)  # fmt: skip
ERRORS = InstrumentErrors(
    "new", tension_gain=0.0025, tension_offset=2.0, position_gain=0.001, position_offset=0.003,
    strain_gain=0.002, stiffness=0.003,
)  # fmt: skip


def test_many_points_have_the_errors_that_each_has_alone():
    strain = np.linspace(0.3, 1.3, 9_002).reshape(2, -1)
    tension = 500 * strain
    tension[0, 3] = np.nan
    many = error_field(ERRORS, MODEL, strain=strain, tension=tension)
    for place in ((0, 0), (0, 3), (0, 4095), (0, 4096), (1, 4500)):
        one = error_field(ERRORS, MODEL, strain=strain[place], tension=tension[place])
        assert one.component == many.component
        for item in fields(one)[1:]:
            np.testing.assert_allclose(
                getattr(many, item.name)[..., place[0], place[1]], getattr(one, item.name),
                rtol=1e-6, atol=1e-15, err_msg=item.name,
            )  # fmt: skip


def test_no_point_has_an_empty_field():
    none = error_field(ERRORS, MODEL, strain=np.empty(0), tension=np.empty(0))
    assert none.tension.shape == none.strain_slope.shape == (len(none.component), 0)
    assert none.strain_by_tension.shape == (0,)


def test_a_point_without_stated_errors_has_no_components():
    bare = error_field(
        InstrumentErrors("new"), StrainModel("new", MODEL.method, MODEL.coefficients),
        strain=0.5, tension=300.0,
    )  # fmt: skip
    assert bare.component == () and bare.tension.shape == (0,)


@pytest.mark.parametrize(
    ("held", "moved", "left"), [("position", "tension", "strain"), ("tension", "strain", "tension")]
)
def test_temperature_moves_what_is_not_held(held, moved, left):
    warm = InstrumentErrors("new", stiffness=0.01, test="T-1")
    field = error_field(warm, StrainModel("new", MODEL.method, MODEL.coefficients),
                        strain=[0.5], tension=[300.0], held=held)  # fmt: skip
    assert [(one.source, one.of) for one in field.component] == [("temperature", "T-1")]
    size = {"tension": 3.0, "strain": -0.005}[moved]
    assert getattr(field, moved) == pytest.approx(np.array([[size]]))
    assert not getattr(field, left).any()
    # the energy of a loop goes up with the tension, down with the strain
    assert field.divergence == pytest.approx(0.01 if held == "position" else -0.01)


# errors of the tape in coefficients and in what rests on one of them

COEFFICIENTS = {
    "relaxed_free_length": 2.55,
    "relaxed_splice_length": 1.18,
    "splice_compliance": 0.0012,
    "splice_exponent": 0.86,
}
DEVIATION = np.array([1.2e-3, 1.5e-3, 5e-5, 6e-3])
CORRELATION = np.array(
    [[1, -0.8, 0.1, 0.0], [-0.8, 1, -0.3, 0.1], [0.1, -0.3, 1, -0.9], [0.0, 0.1, -0.9, 1]]
)
MODEL_OF_FIELDLENGTH = StrainModel(
    "new", "tension-driven", COEFFICIENTS, CORRELATION * np.outer(DEVIATION, DEVIATION)
)


def test_the_errors_add_up_to_the_covariance():
    errors = coefficient_errors(MODEL_OF_FIELDLENGTH)
    np.testing.assert_allclose(
        errors @ errors.T, MODEL_OF_FIELDLENGTH.covariance, rtol=1e-9, atol=1e-18
    )


def test_a_model_without_covariance_has_no_errors():
    assert coefficient_errors(StrainModel("new", "tension-driven", COEFFICIENTS)).shape == (4, 0)


def slack_contributions(**stated):
    """Of a strain at slack of 3 %, found where 5 N more would be 1 mm per metre more."""
    test = SimpleNamespace(
        stress_at_strain=None, first_loading=None, history=None, standstills=None,
        slack_strain=SimpleNamespace(
            strain=np.array([0.03]), by_tension=np.array([2e-4]), by_lag=np.array([0.1])
        ),
    )  # fmt: skip
    (found,) = errors_of_material(
        test, 0, InstrumentErrors("new", **stated), MODEL_OF_FIELDLENGTH, np.nan
    )
    return dict(zip(found.component, found.values["slack_strain_at_unloading"], strict=True))


def test_strain_at_slack_goes_with_the_strain_of_the_test_by_the_same_tape():
    # a length found 1.2 mm too large makes a strain of 3 % too small by 1.2 mm in 2.55 m of it
    slack = {
        one: row for one, row in slack_contributions().items() if one.source == "strain_calibration"
    }
    assert np.sqrt(sum(row**2 for row in slack.values())) == pytest.approx(0.03 * 1.2e-3 / 2.55)
    field = error_field(InstrumentErrors("new"), MODEL_OF_FIELDLENGTH, strain=1.0, tension=500.0)
    together = sum(slack[one] * row for one, row in zip(field.component, field.strain, strict=True))
    # the same covariance with the coefficients moved one by one at a fixed position
    position = 2.55 * 2 + 1.18 * (1 + 0.0012 * 500.0**0.86)
    slopes = []
    for name, value in COEFFICIENTS.items():
        ends = [
            strain_by_model(
                StrainModel(
                    "new", "tension-driven", {**COEFFICIENTS, name: value * (1 + way * 1e-6)}
                ),
                position=position, tension=500.0,
            )
            for way in (1, -1)
        ]  # fmt: skip
        slopes.append((ends[0] - ends[1]) / (2e-6 * value))
    wanted = (
        np.array([-0.03 / 2.55, 0.0, 0.0, 0.0]) @ MODEL_OF_FIELDLENGTH.covariance @ np.array(slopes)
    )
    assert together == pytest.approx(wanted, rel=1e-5)


def test_gains_of_crosshead_and_strain_method_scale_the_strain_at_slack():
    found = {one.source: row for one, row in slack_contributions(strain_gain=0.02).items()}
    assert found["strain_gain"] == pytest.approx(0.03 * 0.02)
    found = {one.source: row for one, row in slack_contributions(position_gain=0.01).items()}
    assert found["position_gain"] == pytest.approx(0.03 * 0.01)


def test_the_strain_at_which_a_specimen_goes_slack_moves_with_gain_zero_and_lag():
    """Per cent by per cent with the gain; a zero that reads high finds it at less tension.

    0.1 % of 0.03; -0.5 N at 0.002 per N; 20 ms at 0.05 per s.
    """
    test = SimpleNamespace(
        slack_strain=SimpleNamespace(
            strain=np.array([0.03]), by_tension=np.array([2e-3]), by_lag=np.array([0.05])
        ),
        history=SimpleNamespace(
            permanent_set=np.array([0.08]), permanent_set_by_tension=np.array([1e-3])
        ),
    )
    errors = InstrumentErrors("rope", position_gain=1e-3, tension_offset=0.5, lag=0.02)
    [found] = _of_slack(test, 0, errors, SimpleNamespace(coefficients={}))
    assert [one.source for one in found.component] == ["position_gain", "tension_offset", "lag"]
    assert found.values["slack_strain_at_unloading"] == pytest.approx([3e-5, -1e-3, 1e-3])
    # a lag is the same in both first rises of a set
    assert found.values["permanent_set"] == pytest.approx([8e-5, -5e-4, 0.0])


# errors of load cells at points of the plane, against laws fitted again to wrong tensions

FREE, SPLICES, COMPLIANCE, EXPONENT = 2.55, 1.18, 0.0012, 0.86
MARKS = np.array([0.7, 200.0, 420.0, 600.0, 900.0])  # the first while it was slack
POINTS = np.array([250.0, 480.0, 800.0])
SIZE = {"tension_gain": 1e-4, "tension_offset": 0.05}


def model(cells=(), exponent=EXPONENT):
    compliance = COMPLIANCE * 500.0 ** (EXPONENT - exponent)
    return StrainModel(
        "new", "tension-driven",
        {"relaxed_free_length": FREE, "relaxed_splice_length": SPLICES,
         "splice_compliance": compliance, "splice_exponent": exponent},
        mark_hold=("slack", "min", "centre", "max", "far"), mark_tension=MARKS,
        mark_load_cell=cells,
    )  # fmt: skip


def wrong(force, source, size):
    return force * (1 + size) if source == "tension_gain" else force + size


def refitted(strain, is_wrong, source, size, exponent):
    """Strain of the points by a law fitted to marks of which some are wrong, by curve_fit."""
    known = model(exponent=exponent).coefficients
    splice = known["splice_compliance"] * MARKS[1:] ** exponent
    force = np.where(is_wrong[1:], wrong(MARKS[1:], source, size), MARKS[1:]) / 500
    if exponent == 1.0:
        factor, power = float(force @ splice) / float(force @ force), 1.0
    else:
        (factor, power), _ = curve_fit(
            lambda x, c, n: c * x**n, force, splice, p0=(splice.mean(), exponent), xtol=1e-14,
            ftol=1e-14, gtol=1e-14,
        )  # fmt: skip
    position = FREE * (1 + strain) + SPLICES * (1 + known["splice_compliance"] * POINTS**exponent)

    def at(points):
        return _tension_driven_strain(
            position, points, relaxed_free_length=FREE, relaxed_splice_length=SPLICES,
            splice_compliance=factor / 500**power, splice_exponent=power,
        )  # fmt: skip

    return at


@pytest.mark.parametrize("exponent", [EXPONENT, 1.0])
@pytest.mark.parametrize("source", SIZE)
@pytest.mark.parametrize("cells", [("A",) * 5, ("B",) * 5, ("A", "A", "B", "A", "B")])
def test_each_cell_moves_the_points_that_it_logged_and_the_law_by_its_marks(
    cells, source, exponent
):
    errors = InstrumentErrors("new", tension_instrument="A", **SIZE)
    found = dict(_load_parts(errors, model(cells, exponent), POINTS))
    strain = np.array([0.4, 0.9, 1.2])
    for cell in dict.fromkeys(("A", *cells)):
        of_cell = np.array([one == cell for one in cells])
        ends = []
        for way in (1, -1):
            size = way * SIZE[source]
            at = refitted(strain, of_cell, source, size, exponent)
            ends.append(at(wrong(POINTS, source, size) if cell == "A" else POINTS))
        wanted = (ends[0] - ends[1]) / 2
        rows = found[Component(source, cell)]
        np.testing.assert_allclose(rows[1], wanted, rtol=2e-3, atol=2e-9)
        moved = wrong(POINTS, source, SIZE[source]) - POINTS if cell == "A" else 0.0
        np.testing.assert_allclose(rows[0], moved, atol=1e-12)


def test_a_cell_that_read_no_mark_of_the_law_and_no_sample_is_in_nothing():
    cells = ("C", "A", "A", "A", "A")  # C read the slack specimen, which is no mark of the law
    parts = _load_parts(
        InstrumentErrors("new", tension_instrument="A", **SIZE), model(cells), POINTS
    )
    assert {one.of for one, _ in parts} == {"A"}


def test_a_mark_of_which_no_cell_is_known_was_read_by_that_of_the_samples():
    errors = InstrumentErrors("new", tension_instrument="A", **SIZE)
    unknown = dict(_load_parts(errors, model(("A", "", "B", "", "A")), POINTS))
    named = dict(_load_parts(errors, model(("A", "A", "B", "A", "A")), POINTS))
    assert set(unknown) == set(named)
    assert {one.of for one in unknown} == {"A", "B"}
    for one, rows in named.items():
        np.testing.assert_array_equal(unknown[one], rows)


def test_a_method_that_knows_no_tension_has_the_cell_of_the_samples_alone():
    line = StrainModel(
        "new", "marks", {}, mark_hold=("min",), mark_tension=np.array([300.0]),
        mark_load_cell=("B",),
    )  # fmt: skip
    parts = _load_parts(InstrumentErrors("new", tension_instrument="A", **SIZE), line, POINTS)
    assert {one.of for one, _ in parts} == {"A"}
    assert all(not rows[1].any() for _, rows in parts)


def test_a_wrong_gain_of_the_cell_of_the_marks_leaves_the_strain_of_splices_that_saturate():
    """Marks and samples have one wrong tension: the splices strain what the tape says."""
    saturating = StrainModel(
        "new", "mixed",
        {"relaxed_free_length": FREE, "relaxed_splice_length": SPLICES, "splice_offset": 0.0,
         "splice_strain_ratio": 0.0, "splice_strain_curvature": 0.0, "splice_strain_cubic": 0.0,
         "splice_compliance": 0.0, "splice_exponent": 1.0, "splice_limit": 0.25,
         "splice_saturation": 1 / 300.0},
        mark_hold=("slack", "min", "centre", "max", "far"), mark_tension=MARKS,
        mark_load_cell=("A",) * 5,
    )  # fmt: skip
    parts = {}
    for cell in ("A", "B"):
        errors = InstrumentErrors("new", tension_gain=0.01, tension_instrument=cell)
        parts[cell] = {one.of: rows[1] for one, rows in _load_parts(errors, saturating, POINTS)}
    np.testing.assert_allclose(parts["A"]["A"], 0.0, atol=1e-12)
    reached = POINTS / 300.0
    by_hand = -SPLICES / FREE * 0.25 * reached * np.exp(-reached) * 0.01
    np.testing.assert_allclose(parts["B"]["B"], by_hand, rtol=1e-9)
    np.testing.assert_allclose(parts["B"]["A"], -by_hand, rtol=1e-9)


def test_a_wrong_zero_of_the_cell_is_no_slope_without_bounds_at_a_tension_near_none():
    errors = InstrumentErrors("new", tension_offset=1.0, tension_instrument="B")
    load = np.array([1e-3, 1e-2, 0.1, 0.99])
    parts = {one.of: rows for one, rows in _load_parts(errors, model(("A",) * 5), load)}
    # by as much as the splices strain in one newton, per newton
    law = SPLICES / FREE * COMPLIANCE * EXPONENT * load ** (EXPONENT - 1)
    assert (np.abs(parts["B"][4]) <= 2 * law).all()
    assert (np.abs(parts["B"][1]) <= law * load * 1.001).all()


# errors of the crosshead's scale, as the zero of strain is from the log or from elsewhere

LENGTH, START = 2.0, 2.3
STRAIN = np.array([0.0, 0.4, 0.9])


@pytest.mark.parametrize("is_zero_logged", [True, False])
@pytest.mark.parametrize(("source", "size"), [("position_gain", 1e-3), ("position_offset", 2e-3)])
def test_a_crosshead_that_is_wrong_moves_strain_by_what_its_zero_does_not_share(
    source, size, is_zero_logged
):
    """Positions read wrong, once with the zero from the same log and once with the right one."""
    place = START + LENGTH * STRAIN

    def read(position):
        return position * (1 + size) if source == "position_gain" else position + size

    zero = read(START) if is_zero_logged else START
    expected = (read(place) - zero) / LENGTH - STRAIN
    model = StrainModel(
        "rope", "gauge-length", {"reference_position": START, "gauge_length": LENGTH},
        is_zero_logged=is_zero_logged,
    )  # fmt: skip
    found = error_field(
        InstrumentErrors("rope", **{source: size}), model, strain=STRAIN, tension=1e3 * STRAIN
    )
    moved = found.strain[0] if found.component else np.zeros(3)
    np.testing.assert_allclose(moved, expected, rtol=1e-9, atol=1e-15)
    slope = found.strain_slope[0] if found.component else np.zeros(3)
    np.testing.assert_allclose(slope, np.gradient(expected, STRAIN), rtol=1e-9, atol=1e-12)


def test_a_scale_is_wrong_by_a_share_of_the_displacement_it_reads():
    """1 % of the travel from displacement zero, where the pins are a length apart."""
    travel = LENGTH * STRAIN
    expected = 0.01 * travel / LENGTH
    model = StrainModel(
        "rope", "gauge-length", {"reference_position": START, "gauge_length": LENGTH}
    )
    errors = InstrumentErrors("rope", position_gain=0.01, position_of_scale_zero=START)
    found = error_field(errors, model, strain=STRAIN, tension=1e3 * STRAIN)
    np.testing.assert_allclose(found.strain[0], expected, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found.strain_slope[0], 0.01, rtol=1e-9)


# what friction in the splices does to a loop and its branches

MODEL_OF_SPLICE_FRICTION = StrainModel(
    "new", "tension-driven",
    {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.25, "splice_compliance": 0.2 / 450,
     "splice_exponent": 1.0},
)  # fmt: skip
ERRORS_OF_SPLICE_FRICTION = InstrumentErrors("new", splice_friction=0.05)


def contributions(errors, model):
    """Of a triangular loop between 225 and 675 N, and strains of 0.5 and 1.5."""
    loop = LoopQuantities(
        frequency=np.array([0.1]), mean_tension=np.array([450.0]),
        tension_amplitude=np.array([225.0]), mean_strain=np.array([1.0]),
        strain_amplitude=np.array([0.5]), apparent_spring_constant=np.array([450.0]),
        hysteresis_energy=np.array([20.0]), storage_spring_constant=np.array([450.0]),
        loss_spring_constant=np.array([25.0]), closed_loop_energy=np.array([20.0]),
    )  # fmt: skip
    return loop_contributions(errors, model, loop, waveform="triangular")


def test_a_loop_is_wider_by_the_difference_of_the_branches_over_the_range_of_tension():
    """By hand: the splices' extension over the free length is 0.1 at 450 N, 0.05 at 225 N."""
    found = contributions(ERRORS_OF_SPLICE_FRICTION, MODEL_OF_SPLICE_FRICTION)
    place = [one.source for one in found.component].index("splice_friction")
    moved = {name: float(rows[place, 0]) for name, rows in found.values.items()}
    assert moved["hysteresis_energy"] == pytest.approx(2 * 225.0 * 0.05 * 0.1, rel=1e-6)
    assert moved["strain_amplitude"] == pytest.approx(-0.05 * 0.05 / 2, rel=1e-6)
    assert moved["apparent_spring_constant"] == pytest.approx(450 * 0.00125 / 0.5, rel=1e-6)
    assert moved["mean_tension"] == 0.0
    # a valley ends a way down
    assert moved["foot_strain"] == pytest.approx(0.05 * 0.05, rel=1e-6)


def test_the_zero_of_the_crosshead_is_in_the_strain_of_a_valley():
    """By hand: without splices 5 mm of 2.5 m, at the valley as at the peak."""
    found = contributions(
        InstrumentErrors("rope", position_offset=0.005),
        StrainModel("rope", "gauge-length", {"gauge_length": 2.5, "reference_position": 2.5}),
    )
    assert np.linalg.norm(found.values["foot_strain"]) == pytest.approx(0.002, rel=1e-6)


def test_strain_is_as_the_marks_say_on_the_way_up_and_too_large_on_the_way_down():
    strain = np.linspace(0.5, 1.5, 101)
    tension = np.stack([450.0 * strain, 450.0 * strain])
    away, steeper = _friction_on_branches(
        ERRORS_OF_SPLICE_FRICTION, MODEL_OF_SPLICE_FRICTION, strain, tension
    )
    # far from the reversal each branch begins with
    assert away[0, -1] == pytest.approx(0.0, abs=1e-6)
    assert away[1, 0] == pytest.approx(0.05 * 0.05, rel=2e-3)
    # at the reversals both branches meet
    assert away[0, 0] == pytest.approx(0.05 * 0.05)
    assert away[1, -1] == pytest.approx(0.0)
    assert (steeper[1, -5:] < 0).all()
    assert (steeper[0, :5] < 0).all()


@pytest.mark.parametrize(("is_unloading", "moved"), [(True, 0.05 * 0.1), (False, 0.0)])
def test_strain_of_a_hold_has_the_friction_where_it_was_approached_by_unloading(
    is_unloading, moved
):
    """By hand: splices of 1.25 m that are 20 % longer at 450 N, over 2.5 m, known to 5 %."""
    none, at = np.empty(0), np.array([10.0])
    hold = HoldResult(
        "new", "relaxation", 0.0, 600.0, 1.0, 460.0, 450.0, 0.02, 0.0, 0.0, 0.0, at,
        np.array([450.0]), np.array([1.0]), none, none, none, none, np.nan, np.nan,
        is_unloading=is_unloading,
    )  # fmt: skip
    found = _of_hold(hold, ERRORS_OF_SPLICE_FRICTION, MODEL_OF_SPLICE_FRICTION)
    error = {name: np.sum(rows, axis=0) for name, rows in found.values.items()}
    assert error["hold_strain"] == pytest.approx(moved)
    assert error["strain_at_time"] == pytest.approx(moved)
    assert not error["hold_final_tension"].any()


def test_a_specimen_without_splices_has_no_such_error():
    bare = StrainModel("new", "gauge-length", {"reference_position": 0.0, "gauge_length": 1.0})
    away, _ = _friction_on_branches(
        ERRORS_OF_SPLICE_FRICTION, bare, np.linspace(0, 1, 5), np.ones((2, 5))
    )
    assert not away.any()


# what the hysteresis of a load cell does to a loop and its branches

GAUGE = StrainModel("rope", "gauge-length", {"gauge_length": 1.0, "reference_position": 1.0})
PEAK, STROKE, LOSS = 1000.0, 0.01, 0.05  # [N], [1], [1]: tension from zero, strain amplitude


def indication(tension):
    """What a cell reads in whose elastic element small parts stick and slip (play operators)."""
    reach = np.linspace(0, PEAK, 200)
    held, read = np.zeros_like(reach), []
    for one in tension:
        held = np.clip(held, one - reach, one + reach)
        read.append(one + 0.01 * held.mean())
    return np.array(read)


def area(strain, tension):
    """Of a closed polygon."""
    return 0.5 * abs(strain @ np.roll(tension, -1) - tension @ np.roll(strain, -1))


def cycle():
    angle = np.linspace(0, 2 * np.pi, 4001)[:-1]
    strain = 0.02 - STROKE * np.cos(angle)
    tension = PEAK / 2 - PEAK / 2 * np.cos(angle + LOSS)
    return strain, tension


def test_the_energy_of_a_loop_changes_by_the_area_between_the_two_ways_of_the_cell():
    way = np.linspace(0, PEAK, 1001)
    # as a laboratory states it: after a preload, up to the peak and back, at half the load
    _, _, up, down = np.split(indication(np.tile(np.concatenate([way, way[::-1]]), 2)), 4)
    half = np.interp(PEAK / 2, way, up - down[::-1])
    errors = InstrumentErrors("rope", tension_reversibility=abs(half) / (PEAK / 2))
    assert 0.001 < errors.tension_reversibility < 0.01
    strain, tension = cycle()
    # its scale is that of rising load
    read = np.interp(indication(np.tile(tension, 2))[tension.size :], up, way)
    one = np.ones(1)
    loop = LoopQuantities(
        frequency=0.1 * one, mean_tension=PEAK / 2 * one, tension_amplitude=PEAK / 2 * one,
        mean_strain=0.02 * one, strain_amplitude=STROKE * one,
        apparent_spring_constant=PEAK / 2 / STROKE * one,
        hysteresis_energy=area(strain, tension) * one,
        storage_spring_constant=PEAK / 2 / STROKE * np.cos(LOSS) * one,
        loss_spring_constant=PEAK / 2 / STROKE * np.sin(LOSS) * one,
        closed_loop_energy=area(strain, tension) * one,
    )  # fmt: skip
    found = loop_contributions(errors, GAUGE, loop, waveform="sinusoidal")
    (place,) = [k for k, one in enumerate(found.component) if one.source == "tension_reversibility"]
    moved = {name: float(rows[place, 0]) for name, rows in found.values.items()}
    change = abs(area(strain, read) - area(strain, tension))
    assert moved["hysteresis_energy"] == pytest.approx(change, rel=0.01)
    assert moved["loss_spring_constant"] == pytest.approx(change / (np.pi * STROKE**2), rel=0.01)
    for name in ("tension_amplitude", "apparent_spring_constant", "mean_tension", "mean_strain"):
        assert moved[name] == 0.0


def test_only_the_falling_branch_is_off_and_its_modulus_by_the_slope_of_that_error():
    errors = InstrumentErrors("rope", tension_reversibility=0.002)
    strain = np.linspace(0.0, 1.0, 2001)
    tension = np.stack([200 + 800 * strain**1.5, 200 + 800 * strain**2])
    off, steeper = _reversibility_on_branches(errors, tension)
    assert not off[0].any() and not steeper[0].any()
    # half of the range of 800 N is 400 N, and .2 % of it .8 N
    assert np.abs(off[1]).max() == pytest.approx(0.8, rel=1e-4)
    slope = np.gradient(tension[1], strain)
    assert steeper[1] * slope == pytest.approx(np.gradient(off[1], strain), abs=0.02)


def a_rope_of(*, energy, known_to):
    """A test of 2 m at 0.1 Hz: 500 N and 0.01 of strain to either side, and an energy in J/m."""
    rope = StrainModel("rope", "gauge-length", {"gauge_length": 2.0, "reference_position": 2.0})
    one = np.ones(1)
    summary = SimpleNamespace(
        apparent_spring_constant=50_000.0 * one, frequency=0.1 * one, strain_amplitude=0.01 * one,
        tension_amplitude=500.0 * one, mean_strain=0.02 * one, mean_tension=500.0 * one,
        hysteresis_energy=energy * one,
        uncertainty={
            "apparent_spring_constant": 50.0 * one, "hysteresis_energy": known_to * one,
        },
    )  # fmt: skip
    return SimpleNamespace(
        amplitude=summary, cycles=None, contributions=None, strain_models=[rope],
        specimens=[SimpleNamespace(name="rope", kind="rope", linear_density=None, is_rope=False)],
        record=SimpleNamespace(load_train=LoadTrain("fixed", 0.0)),
    )  # fmt: skip


@pytest.mark.parametrize("stated", [0.0, 0.001])
def test_the_hysteresis_that_moves_the_energy_by_its_uncertainty_is_told_where_none_is_stated(
    stated,
):
    """By hand: tension half range 500 N, 0.01 of strain on 2 m, an energy known to 0.2 J/m.

    0.4 mm of play is 2e-4 of strain: times a range of 1,000 N, it is 0.2 J/m.
    """
    test = a_rope_of(energy=3.0, known_to=0.2)
    errors = [InstrumentErrors("rope", tension_reversibility=stated)]
    codes = {one.code: one for one in load_train_notes(test, errors)}
    assert ("instrument-hysteresis-unknown" in codes) == (not stated)
    if not stated:
        assert codes["instrument-hysteresis-unknown"].numbers == pytest.approx(
            {"reversibility": 0.03, "play": 4e-4}, rel=1e-6
        )


@pytest.mark.parametrize(("known_to", "code"), [(0.2, "lag-unknown"), (0.02, "lag-matters")])
def test_a_usual_lag_beyond_the_interval_of_the_energy_is_a_warning_where_none_is_stated(
    known_to, code
):
    """A loss angle of 0.2 at 0.1 Hz, which 5 ms turn by 0.0031: 1.6 % of an energy of 3.12 J/m."""
    test = a_rope_of(energy=np.pi * 5 * np.sin(0.2), known_to=known_to)
    found = {one.code: one for one in load_train_notes(test, [InstrumentErrors("rope")])}
    turned = 2 * np.pi * 0.1 * 0.005
    of_energy = np.pi * 5 * turned  # J/m
    assert found[code].numbers == pytest.approx(
        {"lag": 0.005 * known_to / of_energy, "usual": 0.005, "effect": -turned / np.sin(0.2)},
        rel=1e-6,
    )
    assert found[code].severity == ("warning" if of_energy > 2 * known_to else "note")
    test.amplitude.hysteresis_energy = np.zeros(1)  # of a spring, in readings without noise
    found = {one.code: one for one in load_train_notes(test, [InstrumentErrors("rope")])}
    assert found[code].numbers["effect"] == pytest.approx(-of_energy / known_to)
    told = load_train_notes(test, [InstrumentErrors("rope", lag=1e-3)])
    assert not {"lag-unknown", "lag-matters"} & {one.code for one in told}


@pytest.mark.parametrize(("kind", "code"), [("rope", "unknown"), ("stretch hose", "matters")])
def test_the_flanges_of_a_hose_are_heavier_than_the_grip_of_a_rope(kind, code):
    """By hand: 2 m at 3 rad/s give 18 N for each kg, against a standard uncertainty of 50 N.

    A grip of 1.2 kg has 22 N. The flanges of a hose, of steel with 7,850 kg/m3: twice 2.0 kg, 72 N.
    """
    test = a_rope_of(energy=3.0, known_to=0.2)
    test.amplitude.frequency = 3 / (2 * np.pi) * np.ones(1)
    test.record.load_train = LoadTrain()
    test.specimens[0].kind = kind
    found = {one.code: one for one in load_train_notes(test, [InstrumentErrors("rope")])}
    numbers = found[f"attached-mass-{code}"].numbers
    assert numbers["mass"] == pytest.approx(50 / 18)
    disc = np.pi / 4 * (0.150**2 - 0.062**2 - 4 * 0.019**2) * 0.0175 * 7850
    assert numbers["usual"] == pytest.approx(2 * disc if "hose" in kind else 1.2, rel=0.08)
    assert numbers["effect"] == pytest.approx(-18 * numbers["usual"] / 50_000)


# contributions to the parameters of a law against the same fit to a stress with that error

STRAIN_OF_ELASTOMER = np.linspace(0.02, 2.2, 500)
# two Ogden terms, and a part that no law here has: what is left over bends the least squares
TRUE = hyperelastic_stress(
    STRAIN_OF_ELASTOMER,
    law="ogden-2",
    parameters={"modulus_1": 4e5, "modulus_2": 2e3, "exponent_1": 1.6, "exponent_2": 6.0},
)
STRESS = TRUE + 6e3 * np.sin(4 * STRAIN_OF_ELASTOMER)
ERRORS_OF_ELASTOMER = {
    "gain": 2e-4 * STRESS,
    "zero": np.full(STRAIN_OF_ELASTOMER.size, 30.0),
    "strain": 4e2 * STRAIN_OF_ELASTOMER**2,
}


@pytest.mark.parametrize("error", ERRORS_OF_ELASTOMER)
@pytest.mark.parametrize("place", range(4))
def test_parameters_move_as_a_fit_to_the_wrong_stress_says(place, error):
    change = ERRORS_OF_ELASTOMER[error]
    fits = [
        fit_elastomers(STRAIN_OF_ELASTOMER, STRESS + way * change, specimen="new")[place]
        for way in (1, 0, -1)
    ]
    exact = fits[1].parameters
    found = elastomer_contributions(
        [change], strain=STRAIN_OF_ELASTOMER, stress=STRESS, law=fits[1].law, parameters=exact
    )[0]
    for name, value in zip(exact, found, strict=True):
        wanted = (fits[0].parameters[name] - fits[2].parameters[name]) / 2
        tolerance = 0.02 * abs(wanted) + 1e-6 * abs(exact[name])
        assert value == pytest.approx(wanted, abs=tolerance), (fits[1].law, name)


def test_no_error_gives_no_row():
    found = elastomer_contributions(
        np.empty((0, STRAIN_OF_ELASTOMER.size)),
        strain=STRAIN_OF_ELASTOMER,
        stress=STRESS,
        law="neo-hookean",
        parameters={"shear_modulus": 2e5},
    )
    assert found.shape == (0, 1)


def test_the_rates_of_a_wave_have_a_grid_of_any_size():
    """On more than 127 bins, the number of a bin of the descending branch exceeds eight bits."""
    time = np.arange(0, 1.5, 0.001)
    strain = np.interp(time, [0, 0.5, 1.5], [0, 2, 0])
    branch = np.where(time < 0.5, 1, 2).astype(np.int8)
    rates = _logged_rates(time, strain, branch, np.arange(0.005, 2, 0.01))
    np.testing.assert_allclose(rates, np.outer([4, -2], np.ones(200)))
