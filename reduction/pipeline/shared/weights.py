"""What shared errors add to a stepwise test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.product import ReducedTest
from reduction.uncertainty.join import merged, stacked
from reduction.uncertainty.points import section_contributions
from reduction.uncertainty.product import Contributions, InstrumentErrors
from reduction.uncertainty.weights import stepwise_contributions

_OF_READINGS = ("tension", "strain")
_MODULI = ("interval_modulus", "secant_modulus")


def with_shared_steps(test: ReducedTest, instruments: Sequence[InstrumentErrors]) -> ReducedTest:
    """Readings with what they share, and the moduli between them with each contribution."""
    result, (specimen,) = test.stepwise, test.specimens
    if result is None or not instruments:
        return test
    errors = instruments[0]
    found = stepwise_contributions(result, errors, area=specimen.area)
    if not found.component:
        return test
    moduli = Contributions(found.component, {name: found.values[name] for name in _MODULI})
    section = section_contributions(errors, area=specimen.area)
    if np.isnan(result.tension_standard_uncertainty) and np.any(found.values["tension"]):
        # of a reading of a weight nothing is stated: beside what is, that counts as zero
        result = replace(result, tension_standard_uncertainty=0.0)
    whole = merged([moduli, stacked([section])] if section.component else [moduli])
    return replace(
        test,
        stepwise=result,
        contributions=whole,
        shared_uncertainty_of_cycles={
            name: found.shared_standard_uncertainty(name) for name in _OF_READINGS
        },
    )
