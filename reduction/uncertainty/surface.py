r"""What shared errors of the runs do to a response surface.

.. math:: \delta b = (X^T X)^{-1} X^T
          \left(\delta y - \sum_j \frac{\partial \hat y}{\partial x_j} \delta x_j\right)

An error of a load cell is in the response and in the levels at which it is said to hold.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats, Integers
from reduction.surface.terms import model_matrix


def coefficient_contributions(
    coded: ArrayLike,
    exponents: Integers,
    coefficient: ArrayLike,
    *,
    response: ArrayLike,
    level: ArrayLike,
    blocks: ArrayLike | None = None,
) -> Floats:
    """Contributions to the coefficients of a surface from those to its runs.

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Levels of the runs, as fitted. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    coefficient : array_like, shape (n_terms,)
        As fitted. [unit of the response]
    response : array_like, shape (n_components, n_runs)
        Contributions to the response of each run, on the scale that was fitted; a run with NaN was
        not used. [unit of the response]
    level : array_like, shape (n_components, n_runs, n_factors)
        Contributions to the levels, in coded units. [1]
    blocks : array_like of int, shape (n_runs,), optional
        Specimen of each run, where each has a mean of its own. [1]

    Returns
    -------
    contribution : ndarray, shape (n_components, n_terms)
        [unit of the response]

    Raises
    ------
    DataError
        If the runs do not pair up.

    Notes
    -----
    First order ([1]_).  The surface of [2]_ is linear in its responses, and so is what they share.
    What is random from run to run is in the scatter about the surface already and is not here.

    Examples
    --------
    A gain of 1 % raises every coefficient of a spring constant by 1 %, where no level knows it:

    >>> from reduction.surface.designs import box_behnken
    >>> from reduction.surface.terms import quadratic_exponents
    >>> at, powers = box_behnken(3).coded, quadratic_exponents(3)
    >>> b = np.array([3.4, -0.1, 0.1, 0.3, 0.1, 0.5, -0.5, 0.0, 0.1, -0.2])
    >>> runs = model_matrix(at, powers) @ b
    >>> found = coefficient_contributions(at, powers, b, response=0.01 * runs[None],
    ...     level=np.zeros((1, len(at), 3)))
    >>> print(np.allclose(found, 0.01 * b))
    True
    """
    at, own = np.asarray(coded, dtype=np.float64), np.asarray(coefficient, dtype=np.float64)
    of_response = np.asarray(response, dtype=np.float64)
    of_level = np.asarray(level, dtype=np.float64)
    if of_response.shape[1:] != at.shape[:1] or of_level.shape != (of_response.shape[0], *at.shape):
        raise DataError(
            "the contributions do not pair up with the runs",
            found=f"responses {of_response.shape}, levels {of_level.shape}",
            needed=f"(n_components, {at.shape[0]}) and (n_components, {at.shape[0]}, "
            f"{at.shape[1]})",
        )
    used = np.isfinite(at).all(axis=1) & np.isfinite(of_response).all(axis=0)
    used &= np.isfinite(of_level).all(axis=(0, 2))
    terms = model_matrix(at[used], exponents)
    # a quadratic: the central difference is its slope
    steps = np.eye(at.shape[1])
    slope = np.stack(
        [
            (model_matrix(at[used] + step, exponents) - model_matrix(at[used] - step, exponents))
            @ own
            / 2
            for step in steps
        ],
        axis=1,
    )
    moved = of_response[:, used] - np.einsum("rj,krj->kr", slope, of_level[:, used])
    matrix = terms
    if blocks is not None:
        _, place = np.unique(np.asarray(blocks)[used], return_inverse=True)
        effects = np.eye(int(place.max()) + 1)[place][:, 1:]
        matrix = np.concatenate([terms, effects - effects.mean(axis=0)], axis=1)
    solved: Floats = moved @ np.linalg.pinv(matrix).T
    return solved[:, : terms.shape[1]]
