"""Comparisons with known answers: tests made by the formulas of `measured_hoses`, then archived."""

from dataclasses import replace
from functools import cache

import numpy as np
from measured_hoses import Truth

from reduction.archive.campaign_products import NamedComparison, comparisons_to_dataset
from reduction.prediction.hose_comparison import _compare_hose
from reduction.prediction.measured_curve import constant_errors, measured_curve, pressure_errors
from reduction.record.measurement import Origin, Source, Step

PSI = 6894.757293168
TRUTH = Truth()
LOOP = 60.0  # N between the branches
SOURCE = Source("D-64.nc", "ab" * 32, 123)
NOT_APART = ("cord_load_scale", "cord_strain_scale")


def cycled(truth, *, reach, n_cycles=3, loading="static", softer=0.0):
    """A test of several cycles with a loop; each decade of cycles it is softer by a share."""
    up = np.linspace(0.0, reach, 401)
    strain = np.tile(np.concatenate([up, up[::-1]]), n_cycles)
    cycle = np.repeat(np.arange(1, n_cycles + 1), 802)
    branch = np.tile(np.repeat([1, 2], 401), n_cycles)
    tension = truth.tension(strain) * (1 - softer * np.log10(cycle))
    tension = tension + np.where(branch == 1, LOOP / 2, -LOOP / 2)
    return measured_curve(
        strain, tension, loading=loading, cycle_number=cycle, branch=branch,
        shared=constant_errors(tension_offset=20.0),
    )  # fmt: skip


def squeezed(truth, *, reach, gauge=2e3):
    """Fill pressure of the test of `cycled`, without a loop."""
    up = np.linspace(0.0, reach, 401)
    strain = np.tile(np.concatenate([up, up[::-1]]), 3)
    return measured_curve(
        strain, truth.pressure(strain), loading="static", cycle_number=np.repeat([1, 2, 3], 802),
        branch=np.tile(np.repeat([1, 2], 401), 3), shared=pressure_errors(None, gauge),
    )  # fmt: skip


def pulled(truth, *, reach):
    strain = np.linspace(0.0, reach, 801)
    return measured_curve(
        strain, truth.tension(strain), loading="static",
        shared=constant_errors(tension_offset=20.0),
    )  # fmt: skip


@cache
def agreeing():
    """Modulus 5 % above what was thought, known to 10 %, and found again by a fit."""
    stiffer = TRUTH.but(rubber_modulus=210 * PSI)
    found = _compare_hose(
        TRUTH.design(), cycled(stiffer, reach=0.9),
        standard_uncertainty={"rubber_modulus": 20 * PSI, "wrap_angle": np.radians(0.5)},
        calibrate=("wrap_angle", "rubber_modulus"), pressure=squeezed(stiffer, reach=0.9),
    )  # fmt: skip
    return NamedComparison("alike", "S-64", "hose-64", "H64", found)


@cache
def differing():
    """A pull to the break of a hose with cords half as strong again; nothing is to be fitted."""
    strong = TRUTH.but(cord_load_scale=1.5)
    found = _compare_hose(
        TRUTH.design(), pulled(strong, reach=1.2),
        standard_uncertainty={"rubber_modulus": 10 * PSI},
    )  # fmt: skip
    return NamedComparison("apart", "B-64", "hose-64", "H64", found)


@cache
def trading():
    """Two scales of the cords from a stretch in which they hardly carry: one makes the other."""
    found = _compare_hose(
        TRUTH.design(), cycled(TRUTH, reach=0.75, n_cycles=10, loading="dynamic", softer=0.02),
        standard_uncertainty={"wrap_angle": np.radians(0.5)}, calibrate=NOT_APART,
    )  # fmt: skip
    return NamedComparison("trade", "D-64", "hose-64", "H64", found)


def judged_as(named, **changes):
    """The same with another judgement."""
    found = named.comparison
    changed = replace(found, validation=replace(found.validation, **changes))
    return replace(named, comparison=changed)


def dataset(*named, synthetic="yes"):
    return comparisons_to_dataset(
        named or (agreeing(), differing(), trading()), origin=Origin(
            campaign_id="c", attributes={"title": "Hoses", "synthetic": synthetic},
            sources=(SOURCE,), steps=(Step("compare", "3 comparisons"),), settings_json="{}",
            version="1", command="reduction run campaign.toml",
        ),
    )  # fmt: skip
