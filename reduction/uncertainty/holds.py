r"""What shared errors do to what is read in a hold: tensions, drop, rates, terms of a series.

.. math::

    d = 1 - T_f / T_i: \qquad \delta d = (1 - d) \delta T_i / T_i - \delta T_f / T_i

A gain is in both tensions and cancels; a zero does not.  What a relaxing tension loses is a
difference: it scales with the gain and knows no zero.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reduction.holds.product import HoldResult
from reduction.record import Floats
from reduction.uncertainty.field import ErrorField
from reduction.uncertainty.product import Contributions


def hold_contributions(
    field_at: Callable[[Floats, Floats], ErrorField], hold: HoldResult
) -> Contributions:
    """Contributions to the numbers of one hold.

    Parameters
    ----------
    field_at : callable
        Errors at strains [1] and tensions [N] of the specimen, shape (n_points,); it is asked once.
        In creep the machine keeps the tension, which the field has to know.
    hold : HoldResult
        As reduced.

    Returns
    -------
    contributions : Contributions
        To ``hold_strain``, ``hold_initial_tension``, ``hold_final_tension``,
        ``relaxation_drop``, ``relaxation_rate_per_decade``, ``creep_rate_per_decade``,
        ``tension_at_time``, ``strain_at_time``, ``prony_tension`` and ``long_time_tension``;
        NaN where the hold has no such number. [SI]

    Raises
    ------
    DataError
        If the model of the strain is impossible.

    Notes
    -----
    First order ([1]_).  Relaxation is at one length of the machine; that splices take up a little
    of it is in the tension itself.  Creep is at one tension, where strain errs by its own slope.
    Times of a series know none of these errors.

    Examples
    --------
    A zero that is 4 N high, on a drop from 400 to 320 N: 0.2 % of 400 N are not lost.

    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> from reduction.uncertainty.product import InstrumentErrors
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, tension_offset=4.0)
    >>> none = np.empty(0)
    >>> hold = HoldResult("rope", "relaxation", 0.0, 600.0, 1.0, 400.0, 320.0, 0.2, 0.0, 0.08, 0.0,
    ...     none, none, none, none, none, none, none, np.nan, np.nan)
    >>> def field_at(strain, tension):
    ...     return error_field(errors, model, strain=strain, tension=tension)
    >>> found = hold_contributions(field_at, hold)
    >>> print(found.values["relaxation_drop"].round(6), found.values["hold_final_tension"])
    [ 0.    -0.002] [3.2 4. ]
    """
    initial, final = hold.hold_initial_tension, hold.hold_final_tension
    # the middle of the hold, both its ends, its long time, and the stated times
    levels = [(initial + final) / 2, initial, final, hold.long_time_tension]
    n_levels = len(levels)
    field = field_at(
        np.concatenate([np.full(n_levels, hold.hold_strain), hold.strain_at_time]),
        np.concatenate([levels, hold.tension_at_time]),
    )
    first, last, long_time = field.tension[:, 1:n_levels].T
    tension_slope, strain_slope = field.tension_slope[:, 0], field.strain_slope[:, 0]
    rate = hold.rate_per_decade
    relaxation = tension_slope * rate - rate * first / initial
    creep = strain_slope * rate
    is_creep = hold.kind == "creep"
    nothing = np.full(first.shape, np.nan)
    terms = tension_slope[:, None] * hold.prony_tension
    values = {
        "hold_strain": field.strain[:, 0],
        "hold_initial_tension": first,
        "hold_final_tension": last,
        "relaxation_drop": (1 - hold.relaxation_drop) * first / initial - last / initial,
        "relaxation_rate_per_decade": nothing if is_creep else relaxation,
        "creep_rate_per_decade": creep if is_creep else nothing,
        "tension_at_time": field.tension[:, n_levels:],
        "strain_at_time": field.strain[:, n_levels:],
        "prony_tension": terms,
        "long_time_tension": long_time,
    }
    return Contributions(field.component, values)
