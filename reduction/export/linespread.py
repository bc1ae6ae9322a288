r"""How well K_1 and tau of an exported line are known, from K_ap, H and K_0 of one set of runs.

.. math:: w^2(y) = \sum_i (s_i w_i)^2 + 1.96^2 \sum_k \Bigl(\sum_i s_i c_{ik}\Bigr)^2

over the inputs i with the half width w_i of each alone, the contribution c_ik of each error that
they share, and the sensitivity s_i of the parameter.  A load cell is in all three: its gain is in
K_1 as it is, and leaves tau alone.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4.
"""

from __future__ import annotations

import numpy as np

from reduction.line.product import LineParameters
from reduction.line.sensitivity import AMPLITUDE_INPUTS, OUTPUTS, amplitude_sensitivities
from reduction.lookup.parts import own_half_width, shared_half_width, shared_of
from reduction.lookup.product import DesignValues
from reduction.record import Floats
from reduction.uncertainty.line import line_contributions
from reduction.uncertainty.product import Contributions

_REST = "quasi_static_spring_constant"
_LOOP = ("apparent_spring_constant", "hysteresis_energy")


def half_widths(
    line: LineParameters, rest: DesignValues, apparent: DesignValues, energy: DesignValues
) -> dict[str, Floats]:
    """Half widths of the 95 % intervals of what was identified from three design values.

    Parameters
    ----------
    line : LineParameters
        From K_ap, H and K_0, by `reduction.line.identify.identify_by_amplitude`.
    rest, apparent, energy : DesignValues
        K_0, K_ap and H at the point, of the surface. [N], [N], [J m-1]

    Returns
    -------
    half : dict of str to ndarray, shape (...)
        By the names of `reduction.line.sensitivity.OUTPUTS`; NaN where K_ap or H has no interval;
        K_0 counts as exact where it has none. [SI]

    Raises
    ------
    SettingsError
        If an error stands twice among those of one value.

    Notes
    -----
    First order ([1]_), by the logarithmic derivatives of eqs. 1 and 4 of [2]_.  The levels of a
    design value are true ones: amplitude and frequency are exact, and what a wrong load cell does
    to them is in the contributions to the surfaces.

    Examples
    --------
    See `tests/unit/test_export_linespread.py`.
    """
    given = {_LOOP[0]: apparent, _LOOP[1]: energy, _REST: rest}
    values: dict[str, Floats] = {name: one.value for name, one in given.items()}
    values |= {name: getattr(line, name) for name in OUTPUTS}
    shared = shared_of(given)
    moved = line_contributions(
        Contributions(shared.component, {name: shared.values[name] for name in _LOOP}),
        Contributions(shared.component, {_REST: shared.values[_REST]}),
        values,
        reading="amplitude",
    )
    slopes = amplitude_sensitivities(
        line.storage_spring_constant, line.loss_spring_constant, rest.value
    )
    own = {name: own_half_width(one, "surface_high") for name, one in given.items()}
    own[_REST] = np.nan_to_num(own[_REST])
    columns = [AMPLITUDE_INPUTS.index(name) for name in given]
    relative = np.stack([own[name] / values[name] for name in given])
    found = {}
    for row, name in enumerate(OUTPUTS):
        alone = values[name] * np.sqrt(np.sum((slopes[row, columns] * relative) ** 2, axis=0))
        found[name] = np.asarray(np.hypot(alone, shared_half_width(moved.values[name])))
    return found
