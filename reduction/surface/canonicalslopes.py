r"""How stationary points and principal curvatures follow the coefficients of a surface.

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

from reduction.record import Floats, Integers
from reduction.surface.terms import gradient_matrix, model_matrix


def canonical_slopes(
    point: ArrayLike, eigenvalue: ArrayLike, eigenvector: ArrayLike, exponents: Integers
) -> tuple[Floats, Floats]:
    r"""What a change of each coefficient does to stationary points and to curvatures.

    .. math::

        \frac{\partial x_s}{\partial \beta} = -(2B)^{-1} D(x_s), \qquad
        \frac{\partial \lambda_j}{\partial B} = v_j v_j^T

    Parameters
    ----------
    point : array_like, shape (n_responses, n_factors)
        Stationary, coded; NaN where there is none. [1]
    eigenvalue : array_like, shape (n_responses, n_factors)
        [unit of the response]
    eigenvector : array_like, shape (n_responses, n_factors, n_factors)
        A column each. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers of the terms. [1]

    Returns
    -------
    of_point : ndarray, shape (n_responses, n_factors, n_terms)
        NaN where there is no point. [1 per unit of the response]
    of_eigenvalue : ndarray, shape (n_responses, n_factors, n_terms)
        [1]

    Raises
    ------
    ValueError
        If the shapes do not pair up.

    Notes
    -----
    Source: [1]_; of an eigenvalue [2]_.

    Examples
    --------
    1 + 2 X - X^2: a curvature that is 0.1 weaker moves the maximum from 1 to 2 / 1.8, by 0.1 to
    the first order.

    >>> from reduction.surface.terms import quadratic_exponents
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
