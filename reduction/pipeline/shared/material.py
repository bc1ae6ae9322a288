"""What shared errors add to a first loading's stresses and laws, to slack lengths, sections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.moduli.hyperelastic import LAWS
from reduction.moduli.product import ElastomerFit
from reduction.pipeline.shared.curves import rise_rates
from reduction.product import ReducedTest
from reduction.record import Floats, areas_of
from reduction.strain.model import StrainModel
from reduction.uncertainty.elastomer import elastomer_contributions
from reduction.uncertainty.field import error_field
from reduction.uncertainty.fieldlength import coefficient_errors
from reduction.uncertainty.join import merged, stacked
from reduction.uncertainty.points import section_contributions, stress_contributions, with_diameter
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors

_LENGTHS = ("relaxed_free_length", "gauge_length")


def of_material(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Iterator[Contributions]:
    """Stress at stated elongations, strain at slack, section of one specimen."""
    if test.stress_at_strain is not None and test.first_loading is not None:
        yield _of_stress(test, index, errors, model, area)
    yield from _of_slack(test, index, errors, model)
    if np.isfinite(area):
        yield section_contributions(errors, area=area)


def _of_stress(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel, area: float
) -> Contributions:
    """In the order of the archive: rising elongation."""
    if test.first_loading is None or test.stress_at_strain is None:
        return Contributions(())
    level = np.asarray(test.stress_at_strain_levels, dtype=np.float64)
    stress = test.stress_at_strain[index]
    modulus = test.first_loading.tangent_modulus[index, 0]
    known = np.isfinite(modulus)
    slope = (
        np.interp(level, test.first_loading.strain_bin[known], modulus[known])
        if known.any()
        else np.full(level.shape, np.nan)
    )
    field = error_field(errors, model, strain=level, tension=stress * area)
    rate = (
        np.interp(level, test.first_loading.strain_bin, rise_rates(test, index)[0, 0])
        if errors.lag
        else 0.0
    )
    found = stress_contributions(
        field, errors, stress=stress, tension_slope=slope * area, area=area, strain_rate=rate
    )
    order = np.argsort(level, kind="stable")
    return Contributions(found.component, {"stress_at_strain": found.values["stress"][:, order]})


def _of_slack(
    test: ReducedTest, index: int, errors: InstrumentErrors, model: StrainModel
) -> Iterator[Contributions]:
    """Differences of two positions at one small tension, over the relaxed length.

    A zero of the crosshead is in both and cancels; where the zero of the load cell is high both are
    found at less tension than is meant, and move by as much as the specimen stretches for it there.
    A gain moves the slack tension with it, which is a share of the greatest tension; of one that is
    stated it would be a gain's share of that small tension, and is left out.
    """
    of_model = errors.strain_model or errors.specimen
    # of each error: its share of the length, of the tension at the crossings, of their time
    parts = [
        (Component("position_gain", errors.position_instrument), errors.position_gain, 0.0, 0.0),
        (Component("strain_gain", of_model), errors.strain_gain, 0.0, 0.0),
        (Component("tension_offset", errors.tension_instrument), 0.0, -errors.tension_offset, 0.0),
        (Component("lag", errors.tension_instrument), 0.0, 0.0, errors.lag),
    ]
    name = next((one for one in _LENGTHS if one in model.coefficients), None)
    if name is not None:
        # the errors of the tape that are in every strain of the test
        by_tape = coefficient_errors(model)[list(model.coefficients).index(name)]
        parts += [
            (Component("strain_calibration", of_model, number), -share, 0.0, 0.0)
            for number, share in enumerate((by_tape / model.coefficients[name]).tolist())
        ]
    parts = [one for one in parts if any(one[1:])]
    if not parts:
        return
    component = tuple(one[0] for one in parts)
    by_length, by_tension, by_time = np.array([one[1:] for one in parts]).T
    history, slack = test.history, test.slack_strain
    values = {}
    if slack is not None:
        values["slack_strain_at_unloading"] = (
            by_length * slack.strain[index]
            + by_tension * slack.by_tension[index]
            + by_time * slack.by_lag[index]
        )
    if history is not None:
        # both crossings of a set are on first rises, which go at one rate: a lag leaves it alone
        values["permanent_set"] = (
            by_length * history.permanent_set[index]
            + by_tension * history.permanent_set_by_tension[index]
        )
    yield Contributions(component, values)


def of_elastomers(
    test: ReducedTest, errors: Sequence[InstrumentErrors], found: Contributions
) -> list[Contributions]:
    """Every parameter of every law, along one axis; an empty list where there is none.

    ``found`` holds the contributions to the tension of the first loading.
    """
    first = test.first_loading
    rows = found.values.get("branch_tension_first_loading")
    if not test.elastomers or first is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    areas = areas_of(test.specimens)
    own = []
    for fit in test.elastomers:
        place = names.index(fit.specimen)
        area = float(areas[place])
        stress = Contributions(found.component, {"stress": rows[:, place, 0] / area})
        value = {"stress": first.branch_tension[place, 0] / area}
        diameterless = [one.source != "diameter" for one in stress.component]
        stress = Contributions(
            tuple(one for one in stress.component if one.source != "diameter"),
            {"stress": stress.values["stress"][diameterless]},
        )
        stress = with_diameter(stress, errors[place], value, area=area)
        own += _of_fit(stress, first.strain_bin, value["stress"], fit)
    return [stacked(own)]


def _of_fit(
    contribution: Contributions, strain: Floats, stress: Floats, fit: ElastomerFit
) -> list[Contributions]:
    """One entry a parameter: a modulus or an exponent, whichever it is."""
    if np.isfinite(list(fit.parameters.values())).all():
        rows = elastomer_contributions(
            contribution.values["stress"], strain=strain, stress=stress,
            law=next(one for one in LAWS if one == fit.law), parameters=fit.parameters,
        )  # fmt: skip
    else:
        rows = np.full((len(contribution.component), len(fit.parameters)), np.nan)
    return [
        merged(
            [
                Contributions(
                    contribution.component,
                    {"elastomer_modulus": column, "elastomer_exponent": column},
                )
            ]
        )
        for column in rows.T
    ]
