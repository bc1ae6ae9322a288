r"""Stationary point and principal curvatures of quadratic surfaces.

**How stationary points and principal curvatures follow from the coefficients of a surface**:

.. math::

    y = b_0 + x^T b + x^T B x, \qquad x_s = -\tfrac{1}{2} B^{-1} b, \qquad
    B = V \Lambda V^T

References
----------
.. [1] R. H. Myers and D. C. Montgomery, Response Surface Methodology, 2nd ed. New York: Wiley,
   2002, ch. 6.
.. [2] S. Bisgaard and B. Ankenman, "Standard Errors for the Eigenvalues in Second-Order
   Response Surface Models," Technometrics, vol. 38, no. 3, pp. 238-246, 1996.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import engineering_from_coded, gradient_matrix, model_matrix
from reduction.experiments.fit_results import Canonical
from reduction.experiments.run_sheet import variance_factor
from reduction.record.measurement import Floats, Integers


def canonical_slopes(
    point: ArrayLike, eigenvalue: ArrayLike, eigenvector: ArrayLike, exponents: Integers
) -> tuple[Floats, Floats]:
    r"""How stationary points and curvatures change with each coefficient.

    .. math::

        \frac{\partial x_s}{\partial \beta} = -(2B)^{-1} D(x_s), \qquad
        \frac{\partial \lambda_j}{\partial B} = v_j v_j^T

    Notes
    -----
    Source: [1]_; for an eigenvalue [2]_.

    Examples
    --------
    1 + 2 X - X^2: a curvature weaker by 0.1 moves the maximum from 1 to 2 / 1.8, by 0.1 to
    first order.

    >>> from reduction.experiments.designs import quadratic_exponents
    >>> of_point, _ = canonical_slopes([[1.0]], [[-1.0]], [[[1.0]]], quadratic_exponents(1))
    >>> print(of_point @ [0.0, 0.1, 0.0])
    [[0.1]]
    """
    size, vectors = np.asarray(eigenvalue, dtype=np.float64), np.asarray(eigenvector)
    sound = np.isfinite(np.asarray(point)).all(axis=1)
    double = np.where(sound[:, None], 2 * size, np.nan)
    inverse = (vectors / double[:, None, :]) @ vectors.swapaxes(1, 2)
    at = np.where(sound[:, None], point, 0.0)
    # v'Bv, term by term
    squared = model_matrix(np.nan_to_num(vectors.swapaxes(1, 2)), exponents)
    squared *= exponents.sum(axis=1) == 2
    return -inverse @ gradient_matrix(at, exponents), squared


_FLAT = 1e-10
"""Ratio of smallest to largest curvature below which a direction counts as flat."""


def _curvature(coefficient: ArrayLike, exponents: Integers) -> tuple[Floats, Floats]:
    """Linear and quadratic part of surfaces.

    .. math:: y = b_0 + x^T b + x^T B x

    Examples
    --------
    >>> from reduction.experiments.designs import quadratic_exponents
    >>> _, form = _curvature([[0.0, 1.0, 2.0, 0.0, 0.0, 3.0]], quadratic_exponents(2))
    >>> print(form[0])
    [[1.  1.5]
     [1.5 2. ]]
    """
    values = np.asarray(coefficient, dtype=np.float64)
    n_factors = exponents.shape[1]
    slope = np.zeros((values.shape[0], n_factors))
    form = np.zeros((values.shape[0], n_factors, n_factors))
    for index, powers in enumerate(exponents):
        moved = np.repeat(np.arange(n_factors), powers)
        if moved.size == 1:
            slope[:, moved[0]] = values[:, index]
        elif moved.size == 2:
            form[:, moved[0], moved[1]] += values[:, index] / 2
            form[:, moved[1], moved[0]] += values[:, index] / 2
    return slope, form


def canonical_analysis(
    coefficient: ArrayLike,
    exponents: Integers,
    *,
    covariance_factor: ArrayLike,
    pattern: Integers,
    sigma: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
) -> Canonical:
    r"""Stationary point and principal curvatures, with first-order uncertainties.

    .. math::

        x_s = -\tfrac{1}{2} B^{-1} b, \qquad
        \frac{\partial x_s}{\partial \beta} = -(2B)^{-1} D(x_s), \qquad
        \frac{\partial \lambda_j}{\partial B} = v_j v_j^T

    Notes
    -----
    Source: [1]_; uncertainty of an eigenvalue as in [2]_.  Eigenvalues refer to coded units: a
    change of the levels changes them, but not the stationary point.  R's rsm sets small
    eigenvalues to zero, which moves the stationary point; here they are left as they are.

    Examples
    --------
    1 + 2 X - X^2 has its maximum, 2, at X = 1.

    >>> from reduction.experiments.designs import quadratic_exponents
    >>> found = canonical_analysis([[1.0, -1.0, 2.0]], quadratic_exponents(1), sigma=[0.1],
    ...     covariance_factor=np.eye(3)[None], pattern=np.array([0]), low=[0.0], high=[10.0])
    >>> print(found.stationary_point_engineering, found.stationary_value, found.kind)
    [[10.]] [2.] [2]
    """
    values = np.asarray(coefficient, dtype=np.float64)
    slope, form = _curvature(values, exponents)
    known = np.atleast_1d(np.isfinite(values).all(axis=1))
    eigenvalue = np.full(slope.shape, np.nan)
    eigenvector = np.full(form.shape, np.nan)
    rising, vectors = np.linalg.eigh(form[known])
    eigenvalue[known], vectors = rising[:, ::-1], vectors[:, :, ::-1]
    largest = np.take_along_axis(vectors, np.argmax(np.abs(vectors), axis=1)[:, None], axis=1)
    eigenvector[known] = vectors * np.sign(largest)
    size = np.abs(eigenvalue)
    flat = known & ~(size.min(axis=1) > _FLAT * size.max(axis=1))
    sound = known & ~flat

    # in the axes of the curvature each coordinate of the point is a separate quotient
    double = np.where(sound[:, None], 2 * eigenvalue, np.nan)
    along = np.einsum("rij,ri->rj", eigenvector, slope) / -double
    point = np.einsum("rij,rj->ri", eigenvector, along)
    at = np.where(sound[:, None], point, 0.0)
    value = np.sum(model_matrix(at, exponents) * values, axis=1)
    deviation = np.asarray(sigma, dtype=np.float64)[:, None]
    spread = [
        deviation * np.sqrt(variance_factor(rows, covariance_factor, pattern=pattern))
        for rows in canonical_slopes(point, eigenvalue, eigenvector, exponents)
    ]
    rising_count = np.sum(eigenvalue > 0, axis=1)
    kind = np.where(rising_count == 0, 2, np.where(rising_count == exponents.shape[1], 1, 3))
    return Canonical(
        point,
        engineering_from_coded(point, low=low, high=high),
        spread[0],
        np.where(sound, value, np.nan),
        eigenvalue,
        spread[1],
        eigenvector,
        np.where(sound, kind, 0).astype(np.int8),
        (np.abs(point) <= 1).all(axis=1),
        np.select([~known, flat], [1, 2], 0).astype(np.int8),
    )
