import numpy as np
import pytest
from measured_hoses import Truth

from reduction.compare.hose import compare_hose
from reduction.compare.inputs import input_draws
from reduction.compare.measured import SharedUncertainty, measured_curve
from reduction.compare.plausibility import plausibility_of_working_strain
from reduction.compare.trials import design_with, number_of
from reduction.errors import DataError, SettingsError
from reduction.predict.events import find_events

TRUTH = Truth()


def cyclic(top=1.1, loading="static", n_cycles=5):
    phase = np.linspace(0, n_cycles, n_cycles * 600, endpoint=False)
    strain = top * (1 - np.abs(2 * (phase % 1) - 1))
    branch = np.where(phase % 1 < 0.5, 1, 2)
    tension = TRUTH.tension(strain) + np.where(branch == 1, 150, -150)
    noise = np.random.default_rng(1).normal(0, 20, strain.size)
    return measured_curve(
        strain, tension + noise, loading=loading, cycle_number=phase.astype(int) + 1,
        branch=branch, shared=SharedUncertainty(tension_scale=0.005),
    )  # fmt: skip


def test_a_right_prediction_lies_between_the_branches_and_agrees():
    found = compare_hose(
        TRUTH.design(), cyclic(), standard_uncertainty={"wrap_angle": np.radians(0.3)}
    )
    assert set(found.differences) == {"ascending", "descending", "midline"}
    assert found.differences["ascending"].bias == pytest.approx(-150, abs=5)
    assert found.differences["descending"].bias == pytest.approx(150, abs=5)
    assert abs(found.differences["midline"].bias) < 5
    assert found.judged == "midline" and found.validation.agrees
    assert found.validation.verdict.startswith("agrees within U")
    assert found.calibration is None
    assert [one.name for one in found.events] == ["pick_up", "working", "break"]
    assert found.energy.loop == pytest.approx(300 * 1.1, rel=0.02)


def test_a_softer_hose_is_called_different_and_its_modulus_is_found():
    wrong = TRUTH.but(rubber_modulus=1.2 * TRUTH.rubber_modulus).design()
    found = compare_hose(wrong, cyclic(), calibrate=["rubber_modulus"])
    assert not found.validation.agrees and "above the test" in found.validation.verdict
    assert found.calibration.low[0] < TRUTH.rubber_modulus < found.calibration.high[0]


def test_a_dynamic_test_against_a_static_cord_is_noted():
    assert any(
        "is dynamic" in text
        for text in compare_hose(TRUTH.design(), cyclic(loading="dynamic")).notes
    )
    assert not any("is dynamic" in text for text in compare_hose(TRUTH.design(), cyclic()).notes)


def test_what_the_test_did_not_reach_and_what_the_prediction_does_not_is_noted():
    short = compare_hose(TRUTH.design(), cyclic(top=0.7))
    assert any(text.endswith("before the predicted working load") for text in short.notes)
    strong = TRUTH.but(cord_strain_scale=1.2)
    strain = np.linspace(0, 1.5, 800)
    test = measured_curve(strain, strong.tension(strain), loading="static")
    beyond = compare_hose(TRUTH.design(), test)
    assert any("predicted broken at" in text for text in beyond.notes)
    assert beyond.judged == "ascending"


def test_a_working_load_beyond_the_last_bin_is_reached():
    design = TRUTH.design()
    working = find_events(design).working
    top = float(working.strain) // 0.01 * 0.01 + 0.0085
    strain = np.linspace(0, top, 3000)
    # a hose that is a little stiffer has the working load between the last bin and the turn
    factor = float(working.tension) / TRUTH.tension(np.array([top - 0.002]))[0]
    test = measured_curve(strain, factor * TRUTH.tension(strain), loading="static")
    last = test.strain[np.isfinite(test.branch_tension[0])][-1]
    assert last < top - 0.002 < test.end_strain
    found = compare_hose(design, test)
    assert found.events[1].measured_strain == pytest.approx(top - 0.002, abs=1e-4)
    assert not any("before the predicted working load" in text for text in found.notes)


def test_no_tension_is_made_up_where_the_prediction_has_its_kink():
    strain = np.linspace(0, 1, 2001)
    test = measured_curve(strain, 1e-9 * strain, loading="static")
    pick_up = compare_hose(TRUTH.design(), test).events[0]
    assert 0 <= pick_up.measured_tension <= 1e-9


def test_where_the_cords_of_a_test_pick_up_does_not_hang_on_the_prediction():
    test = cyclic()
    designs = [TRUTH.design(), TRUTH.but(wrap_angle=np.radians(67)).design()]
    found = [compare_hose(design, test) for design in designs]
    places = [one.measured_pick_up_strain for one in found]
    assert places[0] == places[1]
    assert abs(places[0] - TRUTH.pick_up_strain()) < 3 * (
        found[0].measured_pick_up_strain_standard_uncertainty
    )
    of_events = [one.events[0].measured_strain for one in found]
    assert abs(of_events[0] - of_events[1]) > 0.1
    short = compare_hose(TRUTH.design(), cyclic(top=0.4))
    assert np.isnan(short.measured_pick_up_strain)
    assert any(text.startswith("where the cords of the test pick up is") for text in short.notes)


def test_many_designs_are_refused():
    many = TRUTH.design(rubber_modulus=np.array([1e6, 2e6]))
    with pytest.raises(SettingsError, match="a comparison is of one hose"):
        compare_hose(many, cyclic())


def test_the_two_reported_hoses_are_bands_and_no_targets():
    inside = plausibility_of_working_strain(np.radians(64), 0.95)
    assert "is inside the band of the hose reported at 64 deg: 70 to 113 %" in inside
    assert "about 79 % at its 115,000th cycle (dynamic, where this is static)" in inside
    assert "above the band" in plausibility_of_working_strain(np.radians(64), 1.2)
    assert "below the band" in plausibility_of_working_strain(np.radians(68), 1.0)
    high = plausibility_of_working_strain(np.radians(68), 1.46, loading="dynamic")
    assert "is inside" in high and "where this is dynamic" in high


def test_another_angle_has_no_band_and_one_nearby_a_moved_one():
    assert plausibility_of_working_strain(np.radians(60), 0.9) == ""
    # half a degree up, 4.3 points of stretch more
    note = plausibility_of_working_strain(np.radians(64.5), 0.79)
    assert "(moved by +0.5 deg)" in note and "75 to 118 %" in note


def test_static_stretch_in_the_band_is_that_of_equation_eight():
    # cord strain 9.5 %, bisection on lambda_c
    for angle, points in ((64, 104.6), (68, 146.1)):
        hose, low, high = Truth(wrap_angle=np.radians(angle)), 1.5, 3.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if hose.cord_stretch(middle) < 1.095 else (low, middle)
        assert 100 * (low - 1) == pytest.approx(points, abs=0.05)


def test_plausibility_needs_numbers_above_zero():
    with pytest.raises(DataError, match="working_strain cannot be compared; found 0"):
        plausibility_of_working_strain(1.1, 0.0)
    with pytest.raises(DataError, match="wrap_angle cannot be compared; found nan"):
        plausibility_of_working_strain(np.nan, 1.0)


def test_draws_see_the_cords_that_pick_up_earlier():
    below = np.array([TRUTH.pick_up_strain() - 0.02])
    known = {"wrap_angle": np.radians(0.5)}
    drawn = np.random.default_rng(3).normal(64, 0.5, 4000)
    spread = [TRUTH.but(wrap_angle=np.radians(a)).tension(below)[0] for a in drawn]
    exact = np.sqrt(np.mean((np.array(spread) - TRUTH.tension(below)[0]) ** 2))
    draws = input_draws(TRUTH.design(), known, below, n_draws=4000)
    assert np.sqrt(np.mean(draws**2)) == pytest.approx(exact, rel=0.1)


def test_a_dead_length_is_not_drawn_below_zero():
    draws = input_draws(TRUTH.design(), {"dead_length_share": 0.01}, np.array([0.5]), n_draws=200)
    assert draws.min() >= 0


def test_nothing_uncertain_is_no_draw():
    assert input_draws(TRUTH.design(), {"wrap_angle": 0.0}, np.zeros(3), n_draws=5).shape == (0, 3)


def test_a_layer_diameter_moves_both_layers():
    design = TRUTH.design()
    assert number_of(design, "layer_diameter") == pytest.approx(3.5 * 0.0254)
    moved = design_with(design, {"layer_diameter": 3.6 * 0.0254}).layer_diameter
    assert np.array(moved) == pytest.approx(np.array([3.5, 3.7]) * 0.0254)
