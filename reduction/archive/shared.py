"""Errors that a test shares with others: their variables, and the values of a product.

Each error is an entry along ``uncertainty_component``; its signed contribution to a quantity stands
beside the random part of that quantity, and ``<name>_standard_uncertainty`` holds both.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np
import xarray as xr

from reduction.archive.reasons import OF_UNCERTAINTY
from reduction.archive.stored import stored
from reduction.archive.values import Values, texts
from reduction.archive.variable import Variable, companion, count, label, stated
from reduction.errors import ArchiveError
from reduction.record import Floats
from reduction.samples.scratch import beside, let_go
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.product import Component, Contributions

COMPONENT = "uncertainty_component"
FREEDOM = "uncertainty_source_degrees_of_freedom"
"""Of each shared error; there where one of them is from a few readings."""
_S = ("specimen",)
_H = ("hold",)
_G = ("specimen", "branch_name", "segment")
_B = ("specimen", "branch_name", "strain_bin")
_F = ("specimen", "branch_name", "first_loading_strain_bin")
_OF_TEST = (
    "mean_strain", "strain_amplitude", "mean_tension", "tension_amplitude",
    "apparent_spring_constant", "dynamic_modulus", "hysteresis_energy",
    "storage_spring_constant", "loss_spring_constant", "loss_factor",
    "quasi_static_spring_constant", "dissipation_spring_constant", "relaxation_time",
    "dashpot_coefficient",
)  # fmt: skip
_OF_SPECIMEN = (
    "diameter", "area", "slack_strain_at_unloading", "permanent_set",
    "peak_tension_per_decade", "dynamic_modulus_per_decade", "peak_tension_change",
    "bedding_first_stiffness", "bedding_last_stiffness", "bedding_first_stiffness_over_strength",
    "bedding_last_stiffness_over_strength", "bedding_stiffening", "bedding_permanent_strain",
    "dynamic_stiffness", "dynamic_stiffness_over_strength", "dynamic_stiffness_drift",
    "dynamic_mean_tension", "dynamic_mean_tension_over_strength",
    "dynamic_tension_amplitude", "dynamic_tension_amplitude_over_strength",
    "pull_peak_tension", "pull_peak_tension_over_strength", "pull_peak_strain",
    "tensile_strength", "strain_at_failure",
)  # fmt: skip
_OF_HOLD = (
    "hold_strain", "hold_initial_tension", "hold_final_tension", "relaxation_drop",
    "relaxation_rate_per_decade", "creep_rate_per_decade", "long_time_tension",
    "creep_tension_over_strength", "creep_compliance_per_decade",
)  # fmt: skip
_OF_PAIR = (
    "held_pair_low_tension", "held_pair_high_tension", "static_stiffness",
    "static_stiffness_over_strength", "static_stiffness_per_decade",
    "static_stiffness_per_decade_over_strength",
)  # fmt: skip
SHARED: dict[str, tuple[str, ...]] = {
    **{f"test_{name}": _S for name in _OF_TEST},
    "tangent_modulus": _B,
    "tangent_modulus_untrimmed": _B,
    "branch_tension": _B,
    "tangent_modulus_first_loading": _F,
    "branch_tension_first_loading": _F,
    "segment_modulus": _G,
    "segment_tension_low": _G,
    "segment_tension_high": _G,
    **dict.fromkeys(_OF_SPECIMEN, _S),
    "quasi_static_spring_constant": ("specimen", "tension_grid"),
    "quasi_static_strain": ("specimen", "tension_grid"),
    "pull_strain_coefficient": ("specimen", "pull_term"),
    "strain_at_break_share": ("specimen", "break_share"),
    "stress_at_strain": ("specimen", "strain_level"),
    **dict.fromkeys(_OF_HOLD, _H),
    "tension_at_time": ("hold", "hold_time"),
    "strain_at_time": ("hold", "hold_time"),
    "prony_tension": ("hold", "prony_term"),
    **dict.fromkeys(_OF_PAIR, ("held_pair",)),
    "interval_modulus": ("interval",),
    "slip_tension_step": ("slip",),
    "slip_length": ("slip",),
    "elastomer_modulus": ("elastomer_parameter",),
    "elastomer_exponent": ("elastomer_parameter",),
    "modulus_ratio": ("comparison", "branch_name", "ratio_strain_bin"),
}
"""Quantities whose contributions are kept, with their dimensions."""
SHARED_OF_CHANNELS: dict[str, tuple[str, ...]] = {
    "crosshead_position": (),
    "crosshead_displacement": (),
    **dict.fromkeys(("tension", "strain", "nominal_stress"), _S),
}
"""Channels: one contribution for all samples of a specimen, with its dimensions."""
SHARED_OF_STEPS: dict[str, tuple[str, ...]] = {"secant_modulus": ("step",)}
"""Of a stepwise test alone: in a record it is of each cycle."""
# the curve of one cycle has the shared error of the mean
_ALIKE = {"tangent_modulus_by_cycle": "tangent_modulus"}

SHARED_ROWS: tuple[Variable, ...] = tuple(
    chain(
        count(COMPONENT, (COMPONENT,)),
        label("uncertainty_source", (COMPONENT,)),
        label("uncertainty_source_of", (COMPONENT,)),
        count("uncertainty_source_number", (COMPONENT,)),
        stated(FREEDOM, (COMPONENT,), OF_UNCERTAINTY),
        *(
            (
                companion(name, "_random_standard_uncertainty", dims),
                companion(name, "_uncertainty_contribution", (COMPONENT, *dims)),
            )
            for name, dims in (SHARED | SHARED_OF_CHANNELS).items()
        ),
    )
)


def with_shared(
    values: Values,
    contributions: Contributions | None,
    of_cycles: dict[str, Floats],
    random: Values | None = None,
) -> Values:
    """Put the shared part of every uncertainty beside its random part, and both together.

    Parameters
    ----------
    values : dict of str to ndarray
        Of the archive; uncertainties are random.
    contributions : Contributions or None
        By name of the archive.
    of_cycles : dict of str to ndarray
        Shared standard uncertainty of the quantities of each cycle.
    random : dict of str to ndarray, optional
        Random part by quantity, where the uncertainty of ``values`` holds more.

    Returns
    -------
    values : dict of str to ndarray
        New; equal where nothing is shared.

    Raises
    ------
    ArchiveError
        If there are contributions to a quantity that has no variable for them.
    """
    known = SHARED | SHARED_OF_CHANNELS | SHARED_OF_STEPS
    homeless = sorted(set(contributions.values) - set(known)) if contributions else []
    if homeless:
        raise ArchiveError(
            "the archive has no variable for contributions of shared errors",
            found=", ".join(homeless),
            needed="quantities of reduction.archive.shared.SHARED",
            hint="this is a fault of the program, not of the campaign",
        )
    found = dict(values)
    for name, shared in of_cycles.items():
        if random is not None and name in random:
            found[f"{name}_standard_uncertainty"] = random[name]
        _combine(found, name, shared[None])
    if contributions is None:
        return found
    for name, rows in contributions.values.items():
        if name not in values:
            continue  # of a stage that this test has not
        if name in SHARED_OF_CHANNELS:
            _combine_channel(found, name, rows)
            continue
        if random is not None and name in random:
            found[f"{name}_standard_uncertainty"] = random[name]
        found[f"{name}_random_standard_uncertainty"] = _combine(found, name, rows)
        # where there is no number, nothing contributes to it
        found[f"{name}_uncertainty_contribution"] = np.where(np.isnan(values[name]), np.nan, rows)
    for name, mean in _ALIKE.items():
        if name in values and mean in contributions.values:
            shared = contributions.shared_standard_uncertainty(mean)
            _combine(found, name, shared[None, :, None])
    return found | component_values(contributions.component)


def component_values(component: Sequence[Component]) -> Values:
    """Return the axis of the shared errors, and what each of them is."""
    freedom = np.array([one.degrees_of_freedom for one in component], dtype=np.float64)
    return {
        COMPONENT: np.arange(1, len(component) + 1),
        "uncertainty_source": texts([one.source for one in component]),
        "uncertainty_source_of": texts([one.of for one in component]),
        "uncertainty_source_number": np.array([one.number for one in component]),
    } | ({} if np.isinf(freedom).all() else {FREEDOM: freedom})


def shared_contributions(archive: xr.Dataset, name: str, *place: int) -> dict[Component, float]:
    """What each shared error adds to one number of an archive; empty where nothing is known.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.
    name : str
        Of the quantity.
    *place : int
        Along its dimensions.

    Returns
    -------
    contributions : dict of Component to float
        [unit of the quantity]
    """
    rows = stored(archive, f"{name}_uncertainty_contribution")
    if rows is None:
        return {}
    components = components_of(archive)
    found = np.moveaxis(rows.values, 0, -1)[place]
    return {
        one: float(value)
        for one, value in zip(components, found, strict=True)
        if np.isfinite(value) and value != 0
    }


def components_of(archive: xr.Dataset, experiment: int | None = None) -> list[Component]:
    """Every shared error of an archive, or of one of its experiments, in order."""
    names = ("uncertainty_source", "uncertainty_source_of", "uncertainty_source_number")
    columns = [archive.variables[name].values for name in names]
    own = columns if experiment is None else [column[experiment] for column in columns]
    kept = stored(archive, FREEDOM)
    known = np.full(len(own[0]), np.inf)
    if kept is not None:
        known = kept.values if experiment is None else kept.values[experiment]
        # an experiment with fewer errors than another is filled up
        known = np.where(np.isnan(known), np.inf, known)
    return [
        Component(str(source), str(of), int(number), float(freedom))
        for source, of, number, freedom in zip(*own, known, strict=True)
    ]


def _combine(values: Values, name: str, rows: Floats) -> Floats:
    """Make the uncertainty of a quantity the combined one; return its random part."""
    key = f"{name}_standard_uncertainty"
    if key not in values:
        return np.full(np.shape(values.get(name, np.nan)), np.nan)
    random: Floats = values[key]
    values[key] = beside(random, combined_standard_uncertainty(rows, random))
    let_go(rows)
    return random


def _combine_channel(values: Values, name: str, rows: Floats) -> None:
    """Put both parts of a channel's uncertainty side by side: of a reading, of all samples."""
    key = f"{name}_standard_uncertainty"
    reading = np.asarray(values.get(key, np.full(rows.shape[1:], np.nan)), dtype=np.float64)
    # what is not stated of a reading counts as zero where something else is stated
    random = np.where(np.isnan(reading) & np.any(rows != 0, axis=0), 0.0, reading)
    values[f"{name}_random_standard_uncertainty"] = random
    values[f"{name}_uncertainty_contribution"] = rows
    values[key] = combined_standard_uncertainty(rows, random)
