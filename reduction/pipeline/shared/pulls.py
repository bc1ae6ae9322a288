"""What shared errors add to a slow pull itself: its curve on the grid of tension."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from reduction.line.product import SlowPull
from reduction.line.quasistatic import quasi_static_spring_constant, strain_at_tension
from reduction.record import Floats
from reduction.strain.model import StrainModel
from reduction.uncertainty.field import ErrorField, error_field
from reduction.uncertainty.join import added
from reduction.uncertainty.line import pull_contributions
from reduction.uncertainty.product import Contributions, InstrumentErrors
from reduction.uncertainty.pullfit import fit_contributions
from reduction.uncertainty.strength import over_strength

_STEP = 1e-3  # of the range of a pull, for the slope of its compliance


_K_0 = "quasi_static_spring_constant"


@dataclass(frozen=True)
class PullOrigin:
    """With what a slow pull was read: its instruments, and how its position became strain."""

    errors: InstrumentErrors
    model: StrainModel


def compliance_slope(pull: SlowPull, tension: Floats) -> Floats:
    """Second derivative of strain over tension; zero at the very ends of the pull. [N-2]."""
    step = _STEP * pull.tension_half_range
    beside = [1 / quasi_static_spring_constant(pull, tension + way * step)[0] for way in (1, -1)]
    bend = (beside[0] - beside[1]) / (2 * step)
    return np.asarray(np.where(np.isfinite(bend), bend, 0.0))


def of_rest(
    pull: SlowPull, origin: PullOrigin, tension: Floats, of_mean_tension: Contributions
) -> Contributions:
    """K_0 at the mean tension of a run, which has its own errors, on a pull that has others."""
    field, constant = _at(pull, origin.errors, origin.model, tension)
    bend = compliance_slope(pull, tension)
    at_tension = pull_contributions(
        field, quasi_static_spring_constant=constant, compliance_slope=bend
    )
    # K_0 is read where the load cell of the run says that the mean tension is
    along = Contributions(
        of_mean_tension.component,
        {_K_0: -(constant**2) * bend * of_mean_tension.values["mean_tension"]},
    )
    errors = origin.errors
    name = f"{errors.specimen}, {errors.test}" if errors.test else errors.specimen
    return added([at_tension, along, fit_contributions(pull, tension, of=name)])


def of_pull(
    pull: SlowPull,
    errors: InstrumentErrors,
    model: StrainModel,
    *,
    tension: Floats,
    share: Floats,
    rated_break_strength: float | None,
) -> Iterator[Contributions]:
    """K_0 and strain on a grid of tension, and strain at shares of the break strength."""
    field, constant = _at(pull, errors, model, tension)
    found = pull_contributions(
        field,
        quasi_static_spring_constant=constant,
        compliance_slope=compliance_slope(pull, tension),
    )
    yield found
    of_strain = _at_tension(field, constant)
    yield Contributions(
        field.component,
        {
            "quasi_static_strain": of_strain,
            "pull_strain_coefficient": _of_cubic(pull, tension, of_strain),
        },
    )
    if rated_break_strength is None:
        return
    load = share * rated_break_strength
    field, constant = _at(pull, errors, model, load)
    at_share = Contributions(
        field.component, {"strain_at_break_share": _at_tension(field, constant)}
    )
    # more strength is more tension at the share, by the compliance there
    yield over_strength(at_share, errors, {"strain_at_break_share": (load / constant, 1.0)})


def _at(
    pull: SlowPull, errors: InstrumentErrors, model: StrainModel, tension: Floats
) -> tuple[ErrorField, Floats]:
    strain = strain_at_tension(pull, tension)[0]
    # a pull is read at a tension: one that is stiffer has stretched less there
    field = error_field(errors, model, strain=strain, tension=tension, held="tension")
    return field, quasi_static_spring_constant(pull, tension)[0]


def _of_cubic(pull: SlowPull, tension: Floats, of_strain: Floats) -> Floats:
    """Contributions to A, B, C and D: a cubic through those to the strain, where there is one."""
    known = np.isfinite(of_strain).all(axis=0)
    scaled = (tension[known] - pull.tension_centre) / pull.tension_half_range
    basis = np.stack([scaled**power for power in range(4)], axis=1)
    solved = of_strain[:, known] @ np.linalg.pinv(basis).T
    rows = [replace(pull, coefficient=row).strain_coefficient for row in solved]
    return np.reshape(rows, (len(rows), 4))


def _at_tension(field: ErrorField, constant: Floats) -> Floats:
    """Error of strain at one tension of the cell."""
    return np.asarray(field.strain - field.tension / constant)
