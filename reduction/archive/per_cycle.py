"""What stands along ``cycle``: limits, loops, the identity; and what sums cycles up."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from reduction.archive.values import Values, texts
from reduction.cycles.product import Cycles, Loops
from reduction.moduli.product import (
    AmplitudeSummary,
    CycleIdentity,
    EndModuli,
    PeakTrend,
    Slips,
)
from reduction.vocabulary import BRANCH_NAMES


def cycle_values(cycles: Cycles, *, control: str) -> Values:
    """Return the cycles and their branches; ``control`` gives band and rate their unit."""
    band, rate = (
        ("tension_band", "tension_rate")
        if control == "load"
        else ("position_band", "crosshead_rate")
    )
    return {
        "cycle": np.arange(1, cycles.n_cycles + 1),
        "branch_name": texts(BRANCH_NAMES),
        "cycle_first_sample": cycles.first,
        "cycle_last_sample": cycles.last,
        "branch_first_sample": cycles.branch_first,
        "branch_last_sample": cycles.branch_last,
        rate: cycles.plateau_rate,
        band: np.array(cycles.band),
        "cycles_counted_by": np.array(cycles.counted_by),
    }


def _with_uncertainty(product: Loops | AmplitudeSummary, prefix: str = "") -> Values:
    values: Values = {
        f"{prefix}{item.name}": getattr(product, item.name)
        for item in fields(product)
        if item.name != "uncertainty"
    }
    for name, uncertainty in product.uncertainty.items():
        values[f"{prefix}{name}_standard_uncertainty"] = uncertainty
    return values


def loop_values(loops: Loops) -> Values:
    """Return the numbers of each loop."""
    return _with_uncertainty(loops)


def amplitude_values(amplitude: AmplitudeSummary) -> Values:
    """Return the means over the cycles of a test; ``test_`` keeps them apart from the cycles'."""
    return _with_uncertainty(amplitude, "test_")


def end_modulus_values(moduli: EndModuli) -> Values:
    """Return secant and chord modulus of each cycle."""
    return {item.name: getattr(moduli, item.name) for item in fields(moduli)}


def identity_values(identity: CycleIdentity) -> Values:
    """Return both sides of the closed-cycle identity and what is left."""
    return {
        item.name: getattr(identity, item.name) for item in fields(identity) if item.name != "notes"
    }


def trend_values(trend: PeakTrend) -> Values:
    """Return the slopes against the logarithm of cycle number."""
    return {item.name: getattr(trend, item.name) for item in fields(trend)}


def slip_values(slips: Slips, *, specimens: tuple[str, ...]) -> Values:
    """Return the steps found; ``n_slips`` of zero says that they were looked for."""
    return {
        "n_slips": np.array([slips.specimen.count(name) for name in specimens]),
        "creep_per_cycle": slips.creep_per_cycle,
        "slip_specimen": texts(slips.specimen),
        "slip_cycle": slips.slip_cycle,
        "slip_cycle_low": slips.slip_cycle_low,
        "slip_cycle_high": slips.slip_cycle_high,
        "slip_tension_step": slips.slip_tension_step,
        "slip_tension_step_standard_uncertainty": slips.slip_tension_step_standard_uncertainty,
        "slip_length": slips.slip_length,
        "slip_length_standard_uncertainty": slips.slip_length_standard_uncertainty,
    }
