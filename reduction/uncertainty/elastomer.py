r"""What shared errors do to the parameters of a hyperelastic law fitted to a first loading.

.. math:: \delta p = J^{+} \left(\delta\sigma|_\varepsilon\right), \qquad
          J = \partial \sigma / \partial p

A gain scales every modulus by itself, a diameter by twice itself, and neither touches an
exponent.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] R. W. Ogden, G. Saccomandi and I. Sgura, "Fitting hyperelastic models to
   experimental data," Comput. Mech. 34, 2004.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.moduli.elastomer import even_grid
from reduction.moduli.hyperelastic import PARAMETERS, Law, hyperelastic_stress
from reduction.record import Floats

__all__ = ["elastomer_contributions"]

_STEP = 1e-6  # of a parameter: the law is linear in its moduli, nearly so in exponents over this


def elastomer_contributions(
    stress: ArrayLike, *, strain: ArrayLike, law: Law, parameters: dict[str, float]
) -> Floats:
    """Contributions to the parameters of one law.

    Parameters
    ----------
    stress : array_like, shape (n_components, n_strains)
        Contributions to the nominal stress at the strains of the first loading. [Pa]
    strain : array_like, shape (n_strains,)
        [1]
    law : str
        As fitted.
    parameters : dict of str to float
        As fitted. [Pa], [1]

    Returns
    -------
    contribution : ndarray, shape (n_components, n_parameters)
        In the order of `PARAMETERS`. [Pa], [1]

    Raises
    ------
    DataError
        If no strain is above zero.

    Notes
    -----
    First order ([1]_), through the least squares that made the fit: on means over even
    intervals of strain, each of which counts alike.  Where several sets of parameters fit alike
    ([2]_), the change stays beside the set that was found.

    Examples
    --------
    1 % more stress is 1 % more of both moduli:

    >>> x = np.linspace(0.05, 2.0, 100)
    >>> known = {"c10": 2e5, "c01": 5e4}
    >>> more = 0.01 * hyperelastic_stress(x, law="mooney-rivlin", parameters=known)
    >>> print(elastomer_contributions([more], strain=x, law="mooney-rivlin", parameters=known)
    ...     .round(3))
    [[2000.  500.]]
    """
    rows, at = np.asarray(stress, dtype=np.float64), np.asarray(strain, dtype=np.float64)
    known = np.isfinite(rows).all(axis=0)
    grids = [even_grid(at[known], row[known]) for row in rows]
    names = PARAMETERS[law]
    if not grids:
        return np.empty((0, len(names)))
    grid = grids[0][0]
    columns = []
    for name in names:
        step = _STEP * max(abs(parameters[name]), _STEP)
        above, below = (
            hyperelastic_stress(grid, law=law, parameters={**parameters, name: value})
            for value in (parameters[name] + step, parameters[name] - step)
        )
        columns.append((above - below) / (2 * step))
    jacobian = np.stack(columns, axis=1)
    scale = np.linalg.norm(jacobian, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    inverse = np.linalg.pinv(jacobian / scale) / scale[:, None]
    return np.stack([inverse @ values for _, values in grids])
