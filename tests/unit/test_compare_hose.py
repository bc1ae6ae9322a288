import numpy as np
import pytest
from measured_hoses import CORD_LOAD, CORD_STRAIN, Truth
from scipy.interpolate import PchipInterpolator

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_comparison import _compare_hose
from reduction.prediction.hose_tension import find_events
from reduction.prediction.measured_curve import constant_errors, measured_curve

TRUTH = Truth()


def cyclic(top=1.1, loading="static", n_cycles=5):
    phase = np.linspace(0, n_cycles, n_cycles * 600, endpoint=False)
    strain = top * (1 - np.abs(2 * (phase % 1) - 1))
    branch = np.where(phase % 1 < 0.5, 1, 2)
    tension = TRUTH.tension(strain) + np.where(branch == 1, 150, -150)
    noise = np.random.default_rng(1).normal(0, 20, strain.size)
    return measured_curve(
        strain, tension + noise, loading=loading, cycle_number=phase.astype(int) + 1,
        branch=branch, shared=constant_errors(tension_gain=0.005),
    )  # fmt: skip


def test_a_right_prediction_lies_between_the_branches_and_agrees():
    found = _compare_hose(
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
    assert found.energy.loop_energy == pytest.approx(300 * 1.1, rel=0.02)


def test_a_softer_hose_is_called_different_and_its_modulus_is_found():
    wrong = TRUTH.but(rubber_modulus=1.2 * TRUTH.rubber_modulus).design()
    found = _compare_hose(wrong, cyclic(), calibrate=["rubber_modulus"])
    assert not found.validation.agrees and "above the test" in found.validation.verdict
    assert found.calibration.low[0] < TRUTH.rubber_modulus < found.calibration.high[0]


def test_a_dynamic_test_against_a_static_cord_is_noted():
    assert any(
        "is dynamic" in text
        for text in map(str, _compare_hose(TRUTH.design(), cyclic(loading="dynamic")).notes)
    )
    assert not any(
        "is dynamic" in text for text in map(str, _compare_hose(TRUTH.design(), cyclic()).notes)
    )


def test_what_the_test_did_not_reach_and_what_the_prediction_does_not_is_noted():
    short = _compare_hose(TRUTH.design(), cyclic(top=0.7))
    assert any(text.endswith("before the predicted working load") for text in map(str, short.notes))
    strong = TRUTH.but(cord_strain_scale=1.2)
    strain = np.linspace(0, 1.5, 800)
    test = measured_curve(strain, strong.tension(strain), loading="static")
    beyond = _compare_hose(TRUTH.design(), test)
    assert any("cord break is predicted for" in text for text in map(str, beyond.notes))
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
    found = _compare_hose(design, test)
    assert found.events[1].measured_strain == pytest.approx(top - 0.002, abs=1e-4)
    assert not any("before the predicted working load" in text for text in map(str, found.notes))


def test_no_tension_is_made_up_where_the_prediction_has_its_kink():
    strain = np.linspace(0, 1, 2001)
    test = measured_curve(strain, 1e-9 * strain, loading="static")
    pick_up = _compare_hose(TRUTH.design(), test).events[0]
    assert 0 <= pick_up.measured_tension <= 1e-9


def test_where_the_cords_of_a_test_pick_up_does_not_hang_on_the_prediction():
    test = cyclic()
    designs = [TRUTH.design(), TRUTH.but(wrap_angle=np.radians(67)).design()]
    found = [_compare_hose(design, test) for design in designs]
    places = [one.measured_pick_up_strain for one in found]
    assert places[0] == places[1]
    assert abs(places[0] - TRUTH.pick_up_strain()) < 3 * (
        found[0].measured_pick_up_strain_standard_uncertainty
    )
    of_events = [one.events[0].measured_strain for one in found]
    assert abs(of_events[0] - of_events[1]) > 0.1
    short = _compare_hose(TRUTH.design(), cyclic(top=0.4))
    assert np.isnan(short.measured_pick_up_strain)
    assert any(
        text.startswith("cord pick-up is not visible in the test") for text in map(str, short.notes)
    )


_LAWS = {
    "power": lambda share: share**1.15,
    "quadratic": lambda share: 0.45 * share + 0.55 * share**2,
    "cubic": lambda share: 1.6 * share - 1.7 * share**2 + 1.1 * share**3,
}


@pytest.mark.parametrize("law", _LAWS)
def test_a_right_hose_has_the_right_shape_although_its_cord_is_known_at_six_points(law):
    def load_of(strain):
        return CORD_LOAD[-1] * _LAWS[law](strain / CORD_STRAIN[-1])

    def tension(truth, strain):
        """That of the hose, with the law in place of the curve through its points."""
        cord = np.maximum(truth.cord_stretch(1 + strain) - 1, 1e-9)
        rubber = truth.but(cord_load_scale=0.0).tension(strain)
        monotone = PchipInterpolator(CORD_STRAIN, CORD_LOAD)(cord)
        return rubber + (truth.tension(strain) - rubber) * load_of(cord) / monotone

    stroke = np.concatenate([np.linspace(0, 0.95, 1500), np.linspace(0.95, 0, 1500)])
    verdicts = []
    for seed in range(6):
        random = np.random.default_rng(seed)
        angle, modulus, scale, gain = random.normal(0, 1, 4)
        built = TRUTH.but(
            wrap_angle=TRUTH.wrap_angle + np.radians(0.4) * angle,
            rubber_modulus=TRUTH.rubber_modulus * (1 + 0.05 * modulus),
            cord_load_scale=1 + 0.03 * scale,
        )
        read = tension(built, stroke) * (1 + 0.003 * gain) + random.normal(0, 8, stroke.size)
        test = measured_curve(
            stroke, read, loading="static", cycle_number=np.ones(stroke.size, dtype=int),
            branch=np.repeat([1, 2], 1500), shared=constant_errors(tension_gain=0.003),
        )  # fmt: skip
        found = _compare_hose(
            TRUTH.design(cord=CordCurve(CORD_STRAIN.copy(), load_of(CORD_STRAIN))), test,
            standard_uncertainty={
                "wrap_angle": np.radians(0.4), "rubber_modulus": 0.05 * TRUTH.rubber_modulus,
                "cord_load_scale": 0.03,
            },
        )  # fmt: skip
        verdicts.append(found.validation.verdict)
        assert found.validation.is_informative
    # one of twenty by chance
    assert sum("its shape does not" in one for one in verdicts) <= 1, verdicts


def test_a_wrong_law_of_the_rubber_has_another_shape():
    softening = cyclic()
    design = TRUTH.design(rubber_law="linear")
    found = _compare_hose(
        design, softening, standard_uncertainty={"rubber_modulus": 0.5 * TRUTH.rubber_modulus}
    )
    assert not found.validation.agrees or found.validation.chi_square_probability < 0.05
