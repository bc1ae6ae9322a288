r"""Errors of tension and strain at a point of the loop, and how they change from point to point.

Whatever is wrong with a test moves each point of its tension-strain plane by a small vector
:math:`(\delta\varepsilon, \delta T)` that depends on where the point is.  From that field and its
slopes follow the errors of everything that is read off the plane: of a modulus, a spring
constant, an area.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3 (sensitivity coefficients) and 5.2.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Table 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.record import Floats, freeze_arrays
from reduction.strain.evaluate import strain_by_model, strain_sensitivity_of
from reduction.strain.inverse import position_by_model
from reduction.strain.model import StrainModel
from reduction.uncertainty.product import Component, InstrumentErrors
from reduction.uncertainty.splicemethod import splice_method_error

__all__ = ["ErrorField", "error_field"]

_ARRAYS = (
    "tension", "strain", "tension_slope", "strain_slope", "strain_slope_over_tension",
)  # fmt: skip
_STEP = 1e-4  # of the strain 1, and of the tension: for the slopes of the field


@dataclass(frozen=True)
class ErrorField:
    """Errors at points of the plane; arrays have shape (n_components, ...).

    Parameters
    ----------
    component : tuple of Component, length n_components
        Lag is not among them: it depends on rates.
    tension, strain : ndarray
        Logged less true. [N], [1]
    tension_slope : ndarray
        Of the tension's error, over tension. [1]
    strain_slope : ndarray
        Of the strain's error, over strain at one tension. [1]
    strain_slope_over_tension : ndarray
        Of the strain's error, over tension at one strain. [N-1]
    strain_by_tension : ndarray, shape (...)
        Change of strain with the tension that is logged at one position: negative where the
        splices are taken to stretch by it, else zero. [N-1]
    """

    component: tuple[Component, ...]
    tension: Floats
    strain: Floats
    tension_slope: Floats
    strain_slope: Floats
    strain_slope_over_tension: Floats
    strain_by_tension: Floats

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def divergence(self) -> Floats:
        """Relative growth of a small area of the plane: of the energy of a loop about it. [1]."""
        return self.tension_slope + self.strain_slope


def error_field(
    errors: InstrumentErrors, model: StrainModel, *, strain: ArrayLike, tension: ArrayLike
) -> ErrorField:
    r"""What each shared error does to tension and strain at points of the plane.

    .. math::

        \delta T &= g_T T + o_T \\
        \delta\varepsilon &= \frac{\partial\varepsilon}{\partial p} (g_p p + o_p)
            + \frac{\partial\varepsilon}{\partial F} \delta T
            + \sum_i \frac{\partial\varepsilon}{\partial\theta_i} \delta\theta_i
            + g_\varepsilon \varepsilon

    Parameters
    ----------
    errors : InstrumentErrors
        Standard uncertainties.
    model : StrainModel
        How position became strain, with the covariance of its coefficients.
    strain, tension : array_like, shape (...)
        Points, NaN where there is none. [1], [N]

    Returns
    -------
    field : ErrorField
        One component an error that is not zero.

    Raises
    ------
    DataError
        If strain and tension differ in shape.

    Notes
    -----
    First order ([1]_, 5.1.3).  Where the marks were read under tensions from the same load cell,
    the splice law is fitted to them: an error of that cell is in the law too, and a splice
    strains at its marks what the tape says, whatever the cell reads.  A wrong gain then leaves
    strain as it is, and a wrong zero nearly so; without that, 1 % of gain would be 0.14 % of
    strain on the tethers of [2]_.  An extensometer knows neither; what position alone misses is
    `splice_method_error`.

    Examples
    --------
    A gauge length of 1 m known to 2 mm, 1 % of load cell gain, at 50 % and 900 N:

    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> field = error_field(InstrumentErrors("rope", tension_gain=0.01), model,
    ...     strain=0.5, tension=900.0)
    >>> print([one.source for one in field.component], field.tension, field.strain.round(6))
    ['tension_gain', 'strain_calibration'] [9. 0.] [ 0.    -0.001]
    """
    at, load = as_same_shape(strain=strain, tension=tension)
    parts = [
        *_of_tension(errors, model, load),
        *_of_position(errors, model, at, load),
        *_of_coefficients(errors, model, at, load),
    ]
    missed = splice_method_error(model, strain=at, tension=load)
    if missed is not None:
        rows = _rows(load, strain=missed[0], strain_slope=missed[1],
                     strain_slope_over_tension=missed[2])  # fmt: skip
        parts.append((Component("splice_method", errors.specimen), rows))
    if errors.stiffness:
        # the rubber is warmer or colder than the test says: the cell reads what there is
        rows = _rows(load, tension=errors.stiffness * load, tension_slope=errors.stiffness)
        parts.append((Component("temperature", errors.test), rows))
    if errors.strain_gain:
        rows = _rows(load, strain=errors.strain_gain * at, strain_slope=errors.strain_gain)
        parts.append((Component("strain_gain", errors.strain_model or errors.specimen), rows))
    table = np.stack([rows for _, rows in parts]) if parts else np.empty((0, 5, *load.shape))
    arrays = dict(zip(_ARRAYS, np.moveaxis(table, 1, 0), strict=True))
    return ErrorField(
        tuple(one for one, _ in parts),
        **arrays,
        strain_by_tension=_strain_by_tension(model, at, load),
    )


def _strain_by_tension(model: StrainModel, at: Floats, load: Floats) -> Floats:
    """Slope of strain over the logged tension at one position."""
    if model.method == "extensometer":
        return np.zeros(load.shape)
    position = position_by_model(model, strain=at, tension=load)
    step = _STEP * np.maximum(np.abs(load), 1.0)
    above, below = (
        strain_by_model(model, position=position, tension=load + way * step) for way in (1, -1)
    )
    return np.asarray((above - below) / (2 * step))


def _rows(
    like: Floats,
    *,
    tension: Floats | float = 0.0,
    strain: Floats | float = 0.0,
    tension_slope: Floats | float = 0.0,
    strain_slope: Floats | float = 0.0,
    strain_slope_over_tension: Floats | float = 0.0,
) -> Floats:
    """The five arrays of an `ErrorField` for one component."""
    given = (tension, strain, tension_slope, strain_slope, strain_slope_over_tension)
    return np.stack([np.broadcast_to(one, like.shape) for one in given])


def _of_tension(
    errors: InstrumentErrors, model: StrainModel, load: Floats
) -> list[tuple[Component, Floats]]:
    """Gain and zero of the load cell, in tension and, by the splices, in strain."""
    found = []
    for source, gain, offset in (
        ("tension_gain", errors.tension_gain, 0.0),
        ("tension_offset", 0.0, errors.tension_offset),
    ):
        if not (gain or offset):
            continue
        step = _STEP * np.maximum(np.abs(load), 1.0)
        strain, above, below = (
            _splice_error(model, force, gain, offset) for force in (load, load + step, load - step)
        )
        found.append(
            (
                Component(source, errors.tension_instrument),
                _rows(
                    load,
                    tension=gain * load + offset,
                    strain=strain,
                    tension_slope=gain,
                    strain_slope_over_tension=(above - below) / (2 * step),
                ),
            )
        )
    return found


def _splice_error(model: StrainModel, load: Floats, gain: float, offset: float) -> Floats:
    """Error of the strain that a load cell's makes through the law of the splices."""
    if model.method != "tension-driven":
        return np.zeros(load.shape)
    known = model.coefficients
    compliance, exponent = known["splice_compliance"], known["splice_exponent"]
    share = known["relaxed_splice_length"] / known["relaxed_free_length"]
    force = np.maximum(load, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.where(force > 0, np.log(force), 0.0)
        relative = np.where(force > 0, gain + offset / force, 0.0)
    of_factor, of_exponent = _refitted(model, gain, offset)
    splice = compliance * force**exponent
    change = splice * (exponent * relative + of_factor + logarithm * of_exponent)
    return np.where(np.isnan(load), np.nan, -share * change)


def _refitted(model: StrainModel, gain: float, offset: float) -> tuple[float, float]:
    """Change of ln c and n of the splice law whose marks were read with the same load cell."""
    used = np.isfinite(model.mark_tension) & (model.mark_tension > 0)
    force = model.mark_tension[used]
    exponent = model.coefficients["splice_exponent"]
    if force.size == 0:
        return 0.0, 0.0
    # marks weigh by the strain of the splices there, as in their fit
    weight = force**exponent
    wanted = -exponent * (gain + offset / force) * weight
    basis = np.stack([weight, np.log(force) * weight], axis=1)
    if np.ptp(force) < 0.05 * force.max():
        basis = basis[:, :1]
    solved = np.linalg.lstsq(basis, wanted, rcond=None)[0]
    return float(solved[0]), float(solved[1]) if solved.size > 1 else 0.0


def _of_position(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[tuple[Component, Floats]]:
    """Gain and zero of the crosshead's scale."""
    gain, offset = errors.position_gain, errors.position_offset
    if model.method == "extensometer" or not (gain or offset):
        return []
    position = position_by_model(model, strain=at, tension=load)
    step = _STEP * np.maximum(np.abs(load), 1.0)
    longer = position_by_model(model, strain=at, tension=load + step)
    shorter = position_by_model(model, strain=at, tension=load - step)
    slope = 1 / (position_by_model(model, strain=at + 1, tension=load) - position)
    found = []
    if gain:
        rows = _rows(
            load,
            strain=gain * slope * position,
            strain_slope=gain,
            strain_slope_over_tension=gain * slope * (longer - shorter) / (2 * step),
        )
        found.append((Component("position_gain", errors.position_instrument), rows))
    if offset:
        rows = _rows(load, strain=offset * slope)
        found.append((Component("position_offset", errors.position_instrument), rows))
    return found


def _of_coefficients(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[tuple[Component, Floats]]:
    """Coefficients of the strain model, their covariance taken apart into independent errors."""
    size = len(model.coefficients)
    if model.covariance.shape != (size, size) or not model.covariance.any():
        return []
    # of correlations: the coefficients have units many powers of ten apart
    deviation = np.sqrt(np.diag(model.covariance))
    scale = np.where(deviation > 0, deviation, 1.0)
    variance, direction = np.linalg.eigh(model.covariance / np.outer(scale, scale))
    kept = variance > 1e-12 * variance.max()
    root = (scale[:, None] * direction * np.sqrt(np.maximum(variance, 0)))[:, kept]
    position = position_by_model(model, strain=at, tension=load)
    reach = _STEP * (position_by_model(model, strain=at + 1, tension=load) - position)
    push = _STEP * np.maximum(np.abs(load), 1.0)

    def strain_error(place: Floats, force: Floats) -> Floats:
        _, slope = strain_sensitivity_of(model, position=place, tension=force)
        return np.tensordot(root.T, slope, axes=1)

    def strain_at(place: Floats, force: Floats) -> Floats:
        return strain_by_model(model, position=place, tension=force)

    centre = strain_error(position, load)
    by_position = (strain_error(position + reach, load) - strain_error(position - reach, load)) / (
        2 * reach
    )
    by_tension = (strain_error(position, load + push) - strain_error(position, load - push)) / (
        2 * push
    )
    of_position = (strain_at(position + reach, load) - strain_at(position - reach, load)) / (
        2 * reach
    )
    of_tension = (strain_at(position, load + push) - strain_at(position, load - push)) / (2 * push)
    along = by_position / of_position
    across = by_tension - along * of_tension
    of = errors.strain_model or errors.specimen
    return [
        (
            Component("strain_calibration", of, number),
            _rows(
                load,
                strain=centre[number],
                strain_slope=along[number],
                strain_slope_over_tension=across[number],
            ),
        )
        for number in range(root.shape[1])
    ]
