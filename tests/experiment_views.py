"""Experiments as the page reads them, over laws that are known, for the tests of the report."""

from dataclasses import replace

import numpy as np
from experiments import ABOUT, FACTORS, HIGH, LOW, surface_experiment

from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.report.product_views import ExperimentView

CODED = box_behnken(3).coded


def view_of(*results, index=0, units="si", **attributes):
    """Return one of some experiments, as the page has it."""
    data = surfaces_to_dataset(results, origin=ABOUT)
    return ExperimentView("experiment-0", data.assign_attrs(attributes), index, units)


def law_experiment(laws, *, noise=1e-4, transforms=(), coded=CODED):
    """Return a Box-Behnken experiment whose responses are laws of the coded levels.

    ``laws`` maps a response to a function of frequency, mean tension and tension amplitude,
    each coded; ``coded`` are the levels as reached, exactly the plan's where they are left out,
    and the noise is a share of the first value.
    """
    plain = surface_experiment()
    rng = np.random.default_rng(7)
    level = (HIGH + LOW) / 2 + coded * (HIGH - LOW) / 2
    response = np.array([law(*coded.T) + np.zeros(len(coded)) for law in laws.values()])
    response += noise * response[:, :1] * rng.standard_normal(response.shape)
    bent = dict(transforms)
    rows = [*range(len(laws)), *(list(laws).index(name) for name in bent)]
    names = (*laws, *(f"log_{name}" for name in bent))
    surfaces = fit_surfaces(
        level, response[rows], factor_names=FACTORS, response_names=names, low=LOW, high=HIGH,
        run_names=plain.runs.names, transforms=[*["none"] * len(laws), *bent.values()],
    )  # fmt: skip
    runs = replace(
        plain.runs, coded_plan=CODED, level=level, response=response,
        response_standard_uncertainty=np.abs(response) * 1e-3,
    )  # fmt: skip
    return replace(
        plain, runs=runs, surfaces=surfaces, shared=None, response_names=tuple(laws), stiffness_forms=(),
        form_quality=None, single_time=None,
    )  # fmt: skip
