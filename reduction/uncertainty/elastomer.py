r"""What shared errors do to the parameters of a hyperelastic law fitted to a first loading.

.. math:: \delta p = \left(J^T J - \sum_i r_i \frac{\partial^2 \sigma_i}{\partial p^2}\right)^{-1}
          J^T \left(\delta\sigma|_\varepsilon\right), \qquad
          J = \partial \sigma / \partial p

with what the law leaves over of the stress, r, which counts where a law is not linear in its
parameters.

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

_STEP, _WIDE_STEP = 1e-6, 1e-4  # of a parameter: for first and for second differences


def elastomer_contributions(
    contribution: ArrayLike,
    *,
    strain: ArrayLike,
    stress: ArrayLike,
    law: Law,
    parameters: dict[str, float],
) -> Floats:
    """Contributions to the parameters of one law.

    Parameters
    ----------
    contribution : array_like, shape (n_components, n_strains)
        To the nominal stress at the strains of the first loading. [Pa]
    strain : array_like, shape (n_strains,)
        [1]
    stress : array_like, shape (n_strains,)
        As it was fitted. [Pa]
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
    intervals of strain, each of which counts alike.  Two Ogden terms may fit alike with very
    different parameters ([2]_): the change is that of the set that was found, and no first order
    tells of a jump to another.

    Examples
    --------
    1 % more stress is 1 % more of both moduli:

    >>> x = np.linspace(0.05, 2.0, 100)
    >>> known = {"c10": 2e5, "c01": 5e4}
    >>> y = hyperelastic_stress(x, law="mooney-rivlin", parameters=known)
    >>> print(elastomer_contributions([0.01 * y], strain=x, stress=y, law="mooney-rivlin",
    ...     parameters=known).round(3))
    [[2000.  500.]]
    """
    rows, at = np.asarray(contribution, dtype=np.float64), np.asarray(strain, dtype=np.float64)
    level = np.asarray(stress, dtype=np.float64)
    known = np.isfinite(rows).all(axis=0) & np.isfinite(level)
    names = PARAMETERS[law]
    if not len(rows):
        return np.empty((0, len(names)))
    grid, fitted = even_grid(at[known], level[known])
    moved = np.stack([even_grid(at[known], row[known])[1] for row in rows])
    centre = np.array([parameters[name] for name in names])
    size = np.maximum(np.abs(centre), _STEP)

    def model(place: Floats) -> Floats:
        given = dict(zip(names, place.tolist(), strict=True))
        return hyperelastic_stress(grid, law=law, parameters=given)

    # over its own size, every parameter is a number of one kind
    near, far = np.diag(_STEP * size), np.diag(_WIDE_STEP * size)
    jacobian = np.stack(
        [(model(centre + one) - model(centre - one)) / (2 * _STEP) for one in near], axis=1
    )
    left = fitted - model(centre)
    bend = np.array(
        [
            [
                left
                @ (
                    model(centre + one + other)
                    - model(centre + one - other)
                    - model(centre - one + other)
                    + model(centre - one - other)
                )
                / (2 * _WIDE_STEP) ** 2
                for other in far
            ]
            for one in far
        ]
    )
    # by the triangle of the first slopes: their product would lose half of the digits
    turn, triangle = np.linalg.qr(jacobian)
    inverse = np.linalg.pinv(triangle)
    inner = np.eye(len(names)) - inverse.T @ bend @ inverse
    return np.asarray((inverse @ np.linalg.solve(inner, (moved @ turn).T)).T * size)
