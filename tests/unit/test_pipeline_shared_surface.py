"""Errors of runs in the surface through them: what several share is in it, what one has is scatter."""

from dataclasses import replace

import numpy as np
import pytest
from experiments import surface_experiment

from reduction.experiments.response_surfaces import fit_surfaces
from reduction.record.contributions import Component, Contributions
from reduction.uncertainty.surface_errors import with_shared_surfaces

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
