r"""The subset of terms with the smallest corrected information criterion.

.. math::

    AIC_c = n \ln \frac{SS_{res}}{n} + 2K + \frac{2K(K + 1)}{n - K - 1}, \qquad K = p + 1

References
----------
.. [1] C. M. Hurvich and C.-L. Tsai, "Regression and Time Series Model Selection in Small
   Samples," Biometrika, vol. 76, no. 2, pp. 297-307, 1989.
.. [2] J. L. Peixoto, "A Property of Well-Formulated Polynomial Regression Models," Am. Stat.,
   vol. 44, no. 1, pp. 26-30, 1990 (hierarchy).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from reduction.experiments.designs import model_matrix
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.surface_statistics import regress
from reduction.record.errors import SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note

_MOST = 50_000
"""Number of subsets examined before the search is refused."""


@dataclass(frozen=True)
@read_only_arrays
class ReducedSurfaces:
    """The subset of terms of each surface; the full surface is unchanged.

    Parameters
    ----------
    is_kept : ndarray of bool, shape (n_responses, n_terms)
        Printed order; the mean is always kept.
    coefficient : ndarray, shape (n_responses, n_terms)
        Coded units; 0 where a term is left out. [unit of the response]
    coefficient_standard_uncertainty, t, p_value : ndarray, shape (n_responses, n_terms)
        NaN where a term is left out; too small, since the same runs chose the terms.
        [unit of the response], [1], [1]
    coefficient_engineering : ndarray, shape (n_responses, n_terms)
        [unit of the response over that of the term]
    sigma : ndarray, shape (n_responses,)
        [unit of the response]
    degrees_of_freedom : ndarray of int, shape (n_responses,)
        [1]
    criterion, full_criterion : ndarray, shape (n_responses,)
        For the subset and for the full surface; infinite where there are too many terms for the
        correction. [1]
    notes : tuple of Note
        What a reader of the numbers needs to know.
    """

    is_kept: Bools
    coefficient: Floats
    coefficient_standard_uncertainty: Floats
    t: Floats
    p_value: Floats
    coefficient_engineering: Floats
    sigma: Floats
    degrees_of_freedom: Integers
    criterion: Floats
    full_criterion: Floats
    notes: tuple[Note, ...]


def reduce_terms(surfaces: ResponseSurfaces) -> ReducedSurfaces:
    """Best subset of the terms of every surface by the corrected Akaike criterion.

    Notes
    -----
    Source: [1]_ for the criterion, [2]_ for the hierarchy.  All subsets are examined (95 for
    three factors with hierarchy, 512 without).  In fifteen runs ten terms cost so much that the
    full surface seldom wins, which says something about fifteen runs, not about the line.

    Examples
    --------
    A plane over two factors, with scatter of the three centre runs that no term can follow:

    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded
    >>> noise = np.where((runs == 0).all(axis=1), np.arange(len(runs)) - 13.0, 0.0)
    >>> full = fit_surfaces(runs, [3 + 2 * runs[:, 0] - runs[:, 1] + noise], units="coded",
    ...     factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3, high=[1] * 3)
    >>> reduced = reduce_terms(full)
    >>> print([name for name, kept in zip(full.term_names, reduced.is_kept[0]) if kept])
    ['mean', 'f', 'T']
    """
    if surfaces.blocks is not None and surfaces.blocks.treatment == "random":
        raise SettingsError(
            "terms cannot be chosen with random blocks",
            needed="fixed blocks",
            hint="Likelihoods of surfaces with other terms do not compare under REML.",
        )
    n_responses, n_terms = surfaces.coefficient.shape
    subsets = _subsets(surfaces.exponents)
    responses = surfaces.fitted + surfaces.residual
    out = {
        name: np.full((n_responses, n_terms), np.nan)
        for name in ("coefficient", "coefficient_standard_uncertainty", "t", "p_value")
    }
    is_kept = np.zeros((n_responses, n_terms), dtype=bool)
    sigma, best, full = (np.full(n_responses, np.nan) for _ in range(3))
    freedom = np.zeros(n_responses, dtype=np.intp)
    for index, used in enumerate(surfaces.is_used):
        rows = np.flatnonzero((surfaces.pattern == index) & np.isin(surfaces.reason, (0, 3)))
        if rows.size == 0:
            continue
        terms = model_matrix(surfaces.coded[used], surfaces.exponents)
        baseline = terms[:, :1]
        if surfaces.blocks is not None:
            contrasts = block_contrasts(surfaces.blocks.index[used])
            baseline = np.hstack([baseline, contrasts])
        known = responses[rows][:, used]
        criterion = np.stack(
            [_criterion(np.hstack([baseline, terms[:, kept]]), known) for kept in subsets]
        )
        choice = np.argmin(criterion, axis=0)
        best[rows] = criterion[choice, np.arange(rows.size)]
        full[rows] = criterion[-1]
        for row, chosen in zip(rows.tolist(), choice.tolist(), strict=True):
            places = [0, *subsets[chosen]]
            found = regress(responses[row, used], np.hstack([terms[:, places], baseline[:, 1:]]))
            is_kept[row, places] = True
            out["coefficient"][row] = 0.0
            for name, values in (
                ("coefficient", found.params), ("coefficient_standard_uncertainty", found.bse),
                ("t", found.tvalues), ("p_value", found.pvalues),
            ):  # fmt: skip
                out[name][row, places] = values[: len(places)]
            sigma[row], freedom[row] = np.sqrt(found.scale), found.df_resid
    return ReducedSurfaces(
        is_kept=is_kept,
        **out,
        coefficient_engineering=out["coefficient"] @ surfaces.engineering_matrix.T,
        sigma=sigma,
        degrees_of_freedom=freedom,
        criterion=best,
        full_criterion=full,
        notes=(note("terms-chosen-by-runs"),),
    )


def _subsets(exponents: Integers) -> list[Integers]:
    """Indices of the terms other than the mean, fewest first, all of them last.

    A square or an interaction keeps its linear terms.
    """
    order = exponents.sum(axis=1)
    linear = np.flatnonzero(order == 1)
    second = np.flatnonzero(order == 2)
    families = []
    for count in range(linear.size + 1):
        for chosen in combinations(linear, count):
            moved = exponents[list(chosen)].sum(axis=0) if chosen else 0 * exponents[0]
            allowed = second[((exponents[second] > 0) <= moved).all(axis=1)]
            families.append((chosen, tuple(allowed)))
    if sum(2 ** len(free) for _, free in families) > _MOST:
        raise SettingsError(
            "there are too many subsets of terms to look at",
            found=f"{len(order)} terms",
            needed=f"at most {_MOST} subsets",
            hint="Fit fewer factors.",
        )
    found = [
        np.array(sorted((*chosen, *some)), dtype=np.intp)
        for chosen, free in families
        for count in range(len(free) + 1)
        for some in combinations(free, count)
    ]
    return sorted(found, key=lambda places: places.size)


def _criterion(columns: Floats, values: Floats) -> Floats:
    """Criterion of each response, shape (n_responses,); infinite where the correction fails."""
    n_runs, n_parameters = columns.shape[0], columns.shape[1] + 1
    if n_runs - n_parameters - 1 <= 0:
        return np.full(values.shape[0], np.inf)
    basis, _ = np.linalg.qr(columns)
    left = np.sum((values - (values @ basis) @ basis.T) ** 2, axis=1)
    penalty = 2 * n_parameters * (1 + (n_parameters + 1) / (n_runs - n_parameters - 1))
    with_floor = np.maximum(left, np.finfo(float).tiny)
    return np.asarray(n_runs * np.log(with_floor / n_runs) + penalty)
