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
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.record import Floats, read_only_arrays
from reduction.strain.model import StrainModel
from reduction.uncertainty.fieldlength import coefficient_parts, position_parts
from reduction.uncertainty.fieldload import load_parts, strain_by_tension
from reduction.uncertainty.fieldrows import ROWS, field_rows
from reduction.uncertainty.product import Component, InstrumentErrors
from reduction.uncertainty.splicemethod import splice_method_error

_PIECE = 4096  # points


@dataclass(frozen=True)
@read_only_arrays
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

    @property
    def divergence(self) -> Floats:
        """Relative growth of a small area of the plane: of the energy of a loop about it. [1]."""
        return self.tension_slope + self.strain_slope


def error_field(
    errors: InstrumentErrors,
    model: StrainModel,
    *,
    strain: ArrayLike,
    tension: ArrayLike,
    held: Literal["position", "tension"] = "position",
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
    held : {"position", "tension"}, optional
        Which of both the temperature of the specimen leaves alone: what the machine (or a weight)
        keeps to its set value, or at which a number is read.

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
    the splice law is fitted to them: an error of that cell is in the law too, and strain stays
    what the tape says; a law made under another cell has the errors of that one
    (`reduction.uncertainty.fieldload.load_parts`, [2]_).  An extensometer knows neither; what
    position alone misses is `splice_method_error`.

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
    # point by point, in pieces that stay in the cache of a processor
    pieces = [
        _table_at(errors, model, at.ravel()[begin : begin + _PIECE],
                  load.ravel()[begin : begin + _PIECE], held)
        for begin in range(0, max(load.size, 1), _PIECE)
    ]  # fmt: skip
    components, tables, by_tension = zip(*pieces, strict=True)
    table = np.concatenate(tables, axis=-1).reshape(len(components[0]), len(ROWS), *load.shape)
    return ErrorField(
        components[0],
        **dict(zip(ROWS, np.moveaxis(table, 1, 0), strict=True)),
        strain_by_tension=np.concatenate(by_tension).reshape(load.shape),
    )


def _table_at(
    errors: InstrumentErrors,
    model: StrainModel,
    at: Floats,
    load: Floats,
    held: Literal["position", "tension"],
) -> tuple[tuple[Component, ...], Floats, Floats]:
    """Errors at points in a row, what each does there, and the strain by tension."""
    parts = [
        *load_parts(errors, model, load),
        *position_parts(errors, model, at, load),
        *coefficient_parts(errors, model, at, load),
    ]
    missed = splice_method_error(model, strain=at, tension=load)
    if missed is not None:
        rows = field_rows(load, strain=missed[0], strain_slope=missed[1],
                     strain_slope_over_tension=missed[2])  # fmt: skip
        parts.append((Component("splice_method", errors.specimen), rows))
    if errors.stiffness:
        # the rubber is warmer or colder than the test says: the cell reads what there is, or the
        # specimen stretches less under what is hung on it
        rows = (
            field_rows(load, strain=-errors.stiffness * at, strain_slope=-errors.stiffness)
            if held == "tension"
            else field_rows(load, tension=errors.stiffness * load, tension_slope=errors.stiffness)
        )
        parts.append((Component("temperature", errors.test), rows))
    if errors.strain_gain:
        rows = field_rows(load, strain=errors.strain_gain * at, strain_slope=errors.strain_gain)
        parts.append((Component("strain_gain", errors.strain_model or errors.specimen), rows))
    table = np.stack([rows for _, rows in parts]) if parts else np.empty((0, len(ROWS), load.size))
    return tuple(one for one, _ in parts), table, strain_by_tension(model, at, load)
