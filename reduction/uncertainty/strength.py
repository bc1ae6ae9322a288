r"""What the rated break strength adds to numbers that are divided by it.

.. math:: y = q / S^p: \qquad \delta y = -p \, y \, \delta S / S

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.6 (relative uncertainty of products of powers).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reduction.record import Floats
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors


def over_strength(
    found: Contributions, errors: InstrumentErrors, powers: Mapping[str, tuple[Floats, float]]
) -> Contributions:
    """Contributions with that of the rated break strength.

    Parameters
    ----------
    found : Contributions
        To these quantities, and others. [as quantity]
    errors : InstrumentErrors
        For the break strength.
    powers : mapping of str to (ndarray, float)
        Of those that know the strength: the value, and the power with which it grows with the
        strength, -1 for what is divided by it.

    Returns
    -------
    contributions : Contributions
        As given where no error of the strength is stated. [as quantity]

    Raises
    ------
    ValueError
        If a value does not fit its contributions.

    Notes
    -----
    First order ([1]_, 5.1.6).

    Examples
    --------
    >>> none = Contributions((), {"share": np.empty((0, 1)), "tension": np.empty((0, 1))})
    >>> errors = InstrumentErrors("rope", rated_break_strength=0.1)
    >>> found = over_strength(none, errors, {"share": (np.array([0.2]), -1.0)})
    >>> print(found.values["share"], found.values["tension"] + 0.0)
    [[-0.02]] [[0.]]
    """
    if not errors.rated_break_strength:
        return found
    rows = {}
    for name, array in found.values.items():
        value, power = powers.get(name, (np.zeros(array.shape[1:]), 0.0))
        own = power * errors.rated_break_strength * np.broadcast_to(value, array.shape[1:])
        rows[name] = np.concatenate([array, own[None]])
    component = Component("rated_break_strength", errors.specimen)
    return Contributions((*found.component, component), rows)
