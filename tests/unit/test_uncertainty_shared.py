"""Contributions of shared errors to numbers of cycles, curves and surfaces."""

from dataclasses import replace

import numpy as np
import pytest
from experiments import surface_experiment

from reduction.experiments.response_surfaces import fit_surfaces
from reduction.record.contributions import Component, Contributions, InstrumentErrors, merged
from reduction.record.settings import CycleSettings
from reduction.stages.moduli.modulus_product import Ratio
from reduction.stages.moduli.secant_modulus import fit_peak_trend
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.rope_programme import (
    RopeStep,
    dynamic_stiffness,
    summarise_bedding_in,
)
from reduction.uncertainty.errors_of_curves import errors_of_ratios, with_shared_ratios
from reduction.uncertainty.errors_of_cycles import (
    errors_of_slips,
    trend_and_step_contributions,
    with_shared_steps,
)
from reduction.uncertainty.propagation import with_shared_interval
from reduction.uncertainty.surface_errors import with_shared_surfaces

MODEL = StrainModel("new", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
CELL, NEW, USED = (
    Component("tension_gain", "cell"), Component("diameter", "new"), Component("diameter", "used"),
)  # fmt: skip


def ratio(numerator="used", denominator="new", freedom=np.inf):
    one = np.ones((2, 3))
    return Ratio(
        numerator, denominator, np.arange(3.0), 1.1 * one, 0.01 * one, 1.08 * one, 1.12 * one,
        one > 0, notes=("type A",), degrees_of_freedom=np.full((2, 3), freedom),
    )  # fmt: skip


def test_one_load_cell_cancels_in_a_ratio_and_two_diameters_add(rich_test):
    moduli = replace(
        rich_test.curves,
        tangent_modulus=np.array([10.0, 11.0])[:, None, None] * np.ones((2, 2, 3)),
    )
    rows = np.zeros((3, 2, 2, 3))
    rows[0] = 0.01 * moduli.tangent_modulus
    rows[1, 0], rows[2, 1] = 0.2, 0.22
    found = Contributions((CELL, NEW, USED), {"tangent_modulus": rows})
    test = replace(
        rich_test, curves=moduli, ratios=(ratio(), ratio("new, cycles 9", "new, cycles 1"))
    )
    (shared,) = errors_of_ratios(test, found)
    of_ratio = shared.values["modulus_ratio"]
    assert of_ratio[:, 0, 0, 0] == pytest.approx([0.0, -0.022, 0.022])
    # two sets of cycles of one specimen share all of it
    assert not of_ratio[:, 1].any()
    wider, alike = with_shared_ratios(replace(test, contributions=shared)).ratios
    reach = 1.959964 * np.sqrt(0.01**2 + 2 * 0.022**2)
    assert wider.ratio_low[0, 0] == pytest.approx(1.1 - reach)
    assert wider.is_different.all()
    assert alike.ratio_low[0, 0] == 1.08


def test_few_cycles_widen_the_interval_less_where_instruments_dominate():
    few = ratio(freedom=2.0)
    alone = with_shared_interval(few, np.zeros((1, 2, 3)))
    assert alone.ratio_high[0, 0] - 1.1 == pytest.approx(4.302653 * 0.01, rel=1e-5)
    both = with_shared_interval(few, np.full((1, 2, 3), 0.1))
    assert both.ratio_high[0, 0] - 1.1 == pytest.approx(1.96 * np.hypot(0.1, 0.01), rel=1e-3)
    assert not both.is_different.any()


def test_ratios_of_a_test_without_shared_errors_stay_as_they_are(rich_test):
    test = replace(rich_test, contributions=None)
    assert with_shared_ratios(test) is test
    assert errors_of_ratios(replace(rich_test, ratios=()), Contributions(())) == []


def test_a_slip_scales_with_the_cell_and_its_length_with_the_scale_of_position(rich_test):
    errors = [
        InstrumentErrors(name, tension_gain=0.01, tension_offset=5.0, position_gain=0.002)
        for name in ("new", "used")
    ]
    test = replace(rich_test, strain_models=(MODEL, replace(MODEL, specimen="used")))
    (found,) = errors_of_slips(test, errors)
    step = found.values["slip_tension_step"]
    by_source = {one.source: row for row, one in enumerate(found.component)}
    assert step[by_source["tension_gain"]] == pytest.approx(0.01 * test.slips.slip_tension_step)
    assert not step[by_source["tension_offset"]].any()
    length = found.values["slip_length"]
    assert length[by_source["position_gain"]] == pytest.approx(0.002 * test.slips.slip_length)
    assert not length[by_source["tension_gain"]].any()
    assert errors_of_slips(replace(rich_test, slips=None), errors) == []


def test_a_stepwise_test_has_the_gauge_length_and_the_diameter_in_its_moduli(stepwise_test):
    errors = InstrumentErrors("old", diameter=1e-4)
    test = with_shared_steps(stepwise_test, (errors,))
    sources = {one.source for one in test.contributions.component}
    assert sources == {"diameter", "gauge_length"}
    assert test.contributions.values["interval_modulus"].shape == (2, 2)
    assert test.contributions.values["diameter"].max() == 1e-4
    assert test.contributions.values["secant_modulus"].shape == (2, 3)
    assert set(test.shared_uncertainty_of_cycles) == {"tension", "strain"}
    assert with_shared_steps(stepwise_test, ()) is stepwise_test


# means, drifts and trends over cycles: the errors of the cycles go through the same sums

AREA = 5e-4
MODEL_OF_SHARED_CYCLES = StrainModel(
    "new", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0}
)
TENSIONS = (
    "mean_tension", "tension_amplitude", "peak_tension", "valley_tension",
    "apparent_spring_constant",
)  # fmt: skip
STRENGTH = np.array([9000.0, 9000.0])


def steps_of(test, gain=0.0, strength=STRENGTH):
    loops = test.loops
    # loops that are at one with themselves
    loops = replace(
        loops,
        peak_tension=loops.mean_tension + loops.tension_amplitude,
        valley_tension=loops.mean_tension - loops.tension_amplitude,
        apparent_spring_constant=loops.tension_amplitude / loops.strain_amplitude,
    )
    loops = replace(loops, **{name: getattr(loops, name) * (1 + gain) for name in TENSIONS})
    return replace(
        test,
        loops=loops,
        trend=fit_peak_trend(loops, area=[AREA, AREA]),
        rope_step=RopeStep(
            "bedding-in",
            bedding_in=summarise_bedding_in(loops, rated_break_strength=strength),
            dynamic=dynamic_stiffness(loops, last_cycles=3, rated_break_strength=strength),
        ),
    )


def numbers(test):
    step, dynamic = test.rope_step.bedding_in, test.rope_step.dynamic
    return {
        "peak_tension_per_decade": test.trend.peak_tension_per_decade[0],
        "dynamic_modulus_per_decade": test.trend.dynamic_modulus_per_decade[0],
        "peak_tension_change": test.trend.peak_tension_change[0],
        "dynamic_stiffness": dynamic.dynamic_stiffness[0, 0],
        "dynamic_stiffness_drift": dynamic.drift_per_cycle[0, 0],
        "dynamic_mean_tension": dynamic.mean_tension[0, 0],
        "dynamic_stiffness_over_strength": dynamic.dynamic_stiffness_over_strength[0, 0],
        "dynamic_mean_tension_over_strength": dynamic.mean_tension_over_strength[0, 0],
        "bedding_first_stiffness": step.first_stiffness[0],
        "bedding_last_stiffness_over_strength": step.last_stiffness_over_strength[0],
        "bedding_stiffening": step.stiffening[0],
        "bedding_permanent_strain": step.permanent_strain[0],
    }


def found_by(test, errors):
    parts = trend_and_step_contributions(
        steps_of(test), 0, errors, MODEL_OF_SHARED_CYCLES, CycleSettings(), AREA
    )
    return {name: rows.sum(axis=0) for name, rows in merged(list(parts)).values.items()}


def test_a_gain_goes_through_every_mean_and_slope(rich_test):
    gain = 1e-4
    found = found_by(rich_test, InstrumentErrors("new", tension_gain=gain))
    above, below = (numbers(steps_of(rich_test, way * gain)) for way in (1, -1))
    for name, value in numbers(steps_of(rich_test)).items():
        wanted = (above[name] - below[name]) / 2
        assert found[name] == pytest.approx(wanted, rel=1e-6, abs=1e-9 * abs(value)), name


def test_the_break_strength_is_in_what_is_divided_by_it_alone(rich_test):
    found = found_by(
        rich_test, InstrumentErrors("new", tension_gain=1e-12, rated_break_strength=1e-4)
    )
    above, below = (
        numbers(steps_of(rich_test, strength=STRENGTH * (1 + way * 1e-4))) for way in (1, -1)
    )
    for name, value in numbers(steps_of(rich_test)).items():
        wanted = (above[name] - below[name]) / 2
        assert found[name] == pytest.approx(wanted, rel=1e-5, abs=1e-9 * abs(value)), name


def test_a_diameter_is_in_the_trend_of_the_modulus_twice(rich_test):
    found = found_by(rich_test, InstrumentErrors("new", diameter=1e-5))
    value = numbers(steps_of(rich_test))["dynamic_modulus_per_decade"]
    size = np.sqrt(4 * AREA / np.pi)
    assert found["dynamic_modulus_per_decade"] == pytest.approx(-2 * value * 1e-5 / size)
    assert found["peak_tension_per_decade"] == 0


def test_a_gain_is_in_no_change_and_a_zero_is_in_one_by_what_the_peaks_lose(rich_test):
    assert found_by(rich_test, InstrumentErrors("new", tension_gain=1e-3))[
        "peak_tension_change"
    ] == pytest.approx(0, abs=1e-15)
    found = found_by(rich_test, InstrumentErrors("new", tension_offset=0.5))
    peaks = steps_of(rich_test).loops.peak_tension[0]
    # (last + d) / (first + d) to first order in d
    wanted = 0.5 * (peaks[0] - peaks[-1]) / peaks[0] ** 2
    assert found["peak_tension_change"] == pytest.approx(wanted, rel=1e-9)


# errors of runs in the surface through them: what several share is in it, what one has is scatter

STIFFNESS = "apparent_spring_constant"


@pytest.fixture(scope="module")
def fitted():
    return surface_experiment(names=(STIFFNESS,))


def with_rows(result, component, row):
    """The experiment where one error more moves the response of its runs, and no level."""
    known = result.runs.shared
    table = {
        name: np.concatenate([rows, (row if name == STIFFNESS else 0 * row)[None]])
        for name, rows in known.values.items()
    }
    shared = Contributions((*known.component, component), table)
    return with_shared_surfaces(replace(result, runs=replace(result.runs, shared=shared)))


def coefficient(result, component):
    return result.shared.coefficient[result.shared.component.index(component), 0]


def test_an_error_of_one_run_is_in_the_scatter_and_is_not_counted_again(fitted):
    warm = Component("temperature", "R03")
    row = np.zeros(15)
    row[2] = 50.0
    found = with_rows(fitted, warm, row)
    assert (coefficient(found, warm) == 0).all()


def test_an_error_of_two_runs_is_in_the_surface_as_least_squares_have_it(fitted):
    pull = Component("quasi_static_fit", "line, Q01")
    row = np.zeros(15)
    row[[2, 7]] = 50.0
    found = coefficient(with_rows(fitted, pull, row), pull)
    # the fit is linear in its runs: the same fit to the row alone
    x = fitted.surfaces.coded
    one = np.ones(len(x))
    design = np.stack(
        [one, *(x**2).T, *x.T, x[:, 0] * x[:, 1], x[:, 0] * x[:, 2], x[:, 1] * x[:, 2]], axis=1
    )
    assert found == pytest.approx(np.linalg.lstsq(design, row, rcond=None)[0], abs=1e-9)


def test_a_load_cell_of_all_runs_stays(fitted):
    cell = Component("tension_gain", "load cell")
    assert np.abs(coefficient(with_shared_surfaces(fitted), cell)).max() > 0


def of_two_specimens(fitted, *, short):
    """Both specimens in each pull, the second in the first pulls only."""
    runs = fitted.runs
    rows = np.concatenate([np.arange(15), np.arange(short)])
    who = ("A",) * 15 + ("B",) * short
    named = {
        name: getattr(runs, name)[..., rows]
        for name in ("response", "response_standard_uncertainty", "frequency", "mean_tension",
                     "tension_amplitude", "peak_tension", "minimum_tension",
                     "rated_break_strength")
    }  # fmt: skip
    table = replace(
        runs, run=tuple(runs.run[row] for row in rows), specimen=who, level=runs.level[rows],
        coded_plan=runs.coded_plan[rows], remarks=tuple(() for _ in rows), shared=None,
        response_whole_uncertainty=None, **named,
    )  # fmt: skip
    surfaces = fit_surfaces(
        table.level, table.response, factor_names=fitted.factor_names,
        response_names=fitted.response_names, low=fitted.low, high=fitted.high,
        run_names=table.names, blocks=who, pulls=table.run,
    )  # fmt: skip
    return replace(fitted, runs=table, surfaces=surfaces, shared=None)


def shared_by(result, row):
    values = dict.fromkeys((STIFFNESS, *result.factor_names), 0 * row[None])
    shared = Contributions((Component("lag", "x"),), values | {STIFFNESS: row[None]})
    found = with_shared_surfaces(replace(result, runs=replace(result.runs, shared=shared)))
    return found.shared.coefficient[0, 0]


def test_an_error_of_one_pull_of_two_specimens_is_in_the_scatter_of_the_pulls(fitted):
    both = of_two_specimens(fitted, short=15)
    row = np.zeros(30)
    row[[2, 17]] = 50.0
    assert (shared_by(both, row) == 0).all()


def test_an_error_of_one_specimen_moves_the_mean_of_two_by_half_however_many_runs_it_has(fitted):
    both = of_two_specimens(fitted, short=6)
    row = np.where(np.arange(21) < 15, 50.0, 0.0)
    assert shared_by(both, row) == pytest.approx([25.0, *[0.0] * 9], abs=1e-6)
