r"""Warnings about fitted surfaces: impossible values, drift over the run order, stray runs.

**Test for drift of a response over the order of the runs, beyond its surface**:

.. math:: y = x^T \beta + \delta\,(k - \bar k) + e

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 (order by rising peak load).
.. [2] N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed. New York: Wiley, 1998,
   sec. 4.1 (a variable that enters after the others).
.. [3] CG-D-39-80, sec. 4.3 (runs in the order of rising load, on one line) and 4.4 (surfaces of
   quantities that are above zero by nature).
.. [4] R. D. Cook and S. Weisberg, Residuals and Influence in Regression. New York: Chapman and
   Hall, 1982, sec. 2.2.2 (the largest of many deleted residuals, by Bonferroni).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.designs import model_matrix
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.least_squares_fit import fit_least_squares, two_sided_p
from reduction.experiments.response_matrix import block_contrasts
from reduction.experiments.response_transform import back_transform
from reduction.experiments.surface_points import extremes_in_box
from reduction.quantities.names import SCALES, response_of_surface
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note


class Drift(NamedTuple):
    """Slope over the order, its standard uncertainty, t and p; NaN if it cannot be separated."""

    slope: Floats
    standard_uncertainty: Floats
    t: Floats
    p_value: Floats


def drift_over_order(surfaces: ResponseSurfaces, order: ArrayLike) -> Drift:
    r"""Slope of every response over the order of the runs, in addition to its surface.

    .. math:: t = \delta / s_\delta, \qquad \nu = n - p - 1

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted.
    order : array_like, shape (n_runs,)
        Place of each run, counted within its block if there are several; NaN if it is not
        known. [1]

    Returns
    -------
    drift : Drift
        For the response as fitted, per run; NaN where the terms determine the order, or no
        degree of freedom is left for it. [unit of the fitted response]

    Notes
    -----
    Source: [2]_.  In an order by rising load [1]_, drift is mostly absorbed by the terms of the
    loads and only the remainder is seen: absence of drift here is no proof.

    Examples
    --------
    Centre runs first, in the middle and last reveal a drift of 0.2 a run:

    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded[[12, 0, 5, 2, 7, 8, 1, 13, 3, 4, 10, 6, 9, 11, 14]]
    >>> noise = 0.1 * np.array([1, -1, 1, 1, -1, -1, 1, -1, 1, -1, 1, 1, -1, 1, -1])
    >>> found = fit_surfaces(runs, [3 + runs[:, 0] + 0.2 * np.arange(15) + noise], units="coded",
    ...     factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3, high=[1] * 3)
    >>> drift = drift_over_order(found, np.arange(15))
    >>> print(abs(drift.slope[0] - 0.2) < 2 * drift.standard_uncertainty[0], drift.p_value < 0.01)
    True [ True]
    """
    place = np.array(order, dtype=np.float64)
    known = np.isfinite(place) & np.isfinite(surfaces.coded).all(axis=1)
    if not known.any():
        return Drift(*np.full((4, surfaces.reason.size), np.nan))
    terms = np.zeros((place.size, len(surfaces.exponents)))
    terms[known] = model_matrix(surfaces.coded[known], surfaces.exponents)
    # of about the size of the coded terms, as needed for the check of the columns
    turn = np.where(known, (place - place[known].mean()) / place.size, 0.0)
    blocks = surfaces.blocks
    own = np.empty((place.size, 0)) if blocks is None else block_contrasts(blocks.index)
    fit = fit_least_squares(
        np.hstack([terms[:, :1], own, terms[:, 1:], turn[:, None]]),
        np.where(known, surfaces.fitted + surfaces.residual, np.nan),
        n_baseline=1 + own.shape[1],
        block=None if blocks is None else blocks.index,
    )
    size = place.size
    slope = fit.coefficient[:, -1] / size
    deviation = np.sqrt(fit.covariance_factor[:, -1, -1])[fit.pattern] * fit.sigma / size
    judged = (fit.reason == 0) & (deviation > 0)
    t = np.divide(slope, deviation, out=np.full(slope.shape, np.nan), where=judged)
    freedom = np.where(fit.degrees_of_freedom > 0, fit.degrees_of_freedom, np.nan)
    return Drift(slope, deviation, t, two_sided_p(t, freedom))


_DRIFTS = 0.05
"""Probability that a response is named in an experiment without drift; an upper bound."""


def _replaced(surfaces: ResponseSurfaces) -> set[str]:
    """Responses with an additional transformed surface, which is the one in use."""
    return {
        name
        for name in surfaces.response_names
        if any(scale + name in surfaces.response_names for scale in SCALES)
    }


def negative_surfaces(surfaces: ResponseSurfaces) -> tuple[Note, ...]:
    """Surfaces that fall below zero within the levels, for runs that are all above zero.

    One for each response without a transformed surface.

    Notes
    -----
    A Box-Behnken design has no run in the corners, and between two levels a parabola may fall
    below both.  None of the quantities of [3]_ can be negative.

    Examples
    --------
    One less 1.1 of the factor is -0.1 at its high level, which no run reached:

    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> found = fit_surfaces([[-1.0], [-1.0], [0.0], [0.0], [0.8], [0.8]],
    ...     [[2.11, 2.09, 1.01, 0.99, 0.13, 0.11]], factor_names=["f"], response_names=["energy"],
    ...     low=[0.1], high=[0.5], units="coded")
    >>> [str(one)[:48] for one in negative_surfaces(found)]
    ['the surface of energy falls below zero within th']
    """
    lowest, _, _ = extremes_in_box(surfaces)
    measured = np.where(surfaces.transform_exponent == 1, 1.0, np.nan)[:, None] * (
        surfaces.fitted + surfaces.residual
    )
    bent = _replaced(surfaces)
    return tuple(
        note("surface-below-zero", response=name)
        for name, low, values in zip(surfaces.response_names, lowest, measured, strict=True)
        if low < 0 and np.isfinite(values).any() and np.nanmin(values) > 0 and name not in bent
    )


def drifting_responses(surfaces: ResponseSurfaces, drift: Drift) -> tuple[Note, ...]:
    """Responses that drift over the order of the runs beyond their surface.

    One for each response with a p below 0.05 over the number of responses.

    Notes
    -----
    At most one experiment in twenty names a response though nothing drifts: Bonferroni's
    bound over the responses, each by the surface in use.  Runs in an order by load [3]_ hide a
    drift in the terms of the loads.

    Examples
    --------
    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.surface_warnings import drift_over_order
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded[[12, 0, 5, 2, 7, 8, 1, 13, 3, 4, 10, 6, 9, 11, 14]]
    >>> noise = 0.1 * np.array([1, -1, 1, 1, -1, -1, 1, -1, 1, -1, 1, 1, -1, 1, -1])
    >>> found = fit_surfaces(runs, [3 + runs[:, 0] + 0.2 * np.arange(15) + noise], units="coded",
    ...     factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3, high=[1] * 3)
    >>> [str(one)[:34] for one in drifting_responses(found, drift_over_order(found, range(15)))]
    ['y drifts with run order: its resid']
    """
    # for a logarithm the slope is itself relative
    size = np.where(
        surfaces.transform_exponent == 0, 1.0, np.nan_to_num(np.abs(surfaces.fitted)).mean(axis=1)
    )
    share = np.divide(drift.slope, size, out=np.full(size.shape, np.nan), where=size > 0)
    replaced = _replaced(surfaces)
    in_use = np.array([name not in replaced for name in surfaces.response_names])
    n_judged = int(np.isfinite(drift.p_value[in_use]).sum())
    return tuple(
        note("response-drifts", response=name, slope=float(slope), share=float(part), p=float(p))
        for name, slope, part, p, judged in zip(
            surfaces.response_names, drift.slope, share, drift.p_value, in_use, strict=True
        )
        if judged and n_judged * p < _DRIFTS
    )


_STRAY = 1e-3
"""Probability that a run is named in a response with uniform scatter; an upper bound."""

_STRAY_SHARE = 0.03
"""Distance of a run from the others below which it is not named, as a fraction of the response.

The misfit of a quadratic is not scatter, and may be as improbable; it is seldom as large."""


def outlying_runs(surfaces: ResponseSurfaces) -> tuple[Note, ...]:
    r"""Runs that differ from the surface of all others by far more than their scatter.

    .. math::

        d_i = \frac{e_i}{1 - h_i}, \qquad
        n\, P(\lvert t_{n - p - 1}\rvert > \lvert t_i\rvert) < 0.001

    Parameters
    ----------
    surfaces : ResponseSurfaces
        As fitted, with tests.

    Returns
    -------
    notes : tuple of Note
        One for each run, or set of similar runs, with the responses in which it is stray.

    Notes
    -----
    Method: the largest deleted residual compared with the Student distribution for that number of
    runs [4]_, and a distance of at least 3 % of the response.  In a Box-Behnken design of three
    factors the residuals of two runs on opposite sides of the centre are equal and opposite: one
    that is too high looks like the other too low, and both are named.

    Examples
    --------
    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.response_surfaces import fit_surfaces
    >>> runs = box_behnken(3).coded
    >>> noise = 1e-3 * np.array([1, -1, 1, 1, -1, -1, 1, -1, 1, -1, 1, 1, -1, 1, -1])
    >>> found = fit_surfaces(runs, [3 + runs[:, 0] + noise + (np.arange(15) == 13)],
    ...     units="coded", factor_names=["f", "T", "a"], response_names=["y"], low=[0] * 3,
    ...     high=[1] * 3, run_names=[f"R{run}" for run in range(1, 16)])
    >>> [str(one)[:67] for one in outlying_runs(found)]
    ['run R14 (+33 %) is off the surface of the other runs in y (p 5e-11)']
    """
    leverage, t = surfaces.diagnostics.leverage, surfaces.diagnostics.deleted_residual
    n_used = np.isfinite(t).sum(axis=1, keepdims=True)
    # those of the residuals, also where surfaces are judged by pulls of several runs
    used = surfaces.is_used[surfaces.pattern]
    n_blocks = np.ones(len(used)) if surfaces.blocks is None else [
        np.unique(surfaces.blocks.index[one]).size for one in used
    ]  # fmt: skip
    freedom = used.sum(axis=1) - len(surfaces.term_names) - n_blocks
    p = np.minimum(n_used * two_sided_p(t, np.where(freedom > 0, freedom, np.nan)[:, None]), 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = surfaces.residual / (1 - leverage)
        others = surfaces.fitted + surfaces.residual - off
        exponent = surfaces.transform_exponent[:, None]
        plain = np.array([one == "none" for one in surfaces.transform])[:, None]
        share = np.where(
            plain,
            off / np.abs(others),
            back_transform(others + off, exponent) / back_transform(others, exponent) - 1,
        )
    found: list[tuple[set[int], list[int]]] = []
    replaced = _replaced(surfaces)
    strays = np.isfinite(p) & (p < _STRAY) & (np.abs(share) > _STRAY_SHARE)
    rows = [row for row, name in enumerate(surfaces.response_names) if name not in replaced]
    for row in sorted(
        (row for row in rows if strays[row].any()), key=lambda row: np.nanmin(p[row])
    ):
        runs = set(np.flatnonzero(strays[row]).tolist())
        same = next((one for one in found if one[0] & runs), None)
        if same is None:
            found.append((runs, [row]))
        else:
            same[1].append(row)
    return tuple(
        note(
            "run-off-the-others",
            runs=" or ".join(
                f"{surfaces.run_names[run]} ({100 * share[of[0], run]:+.0f} %)"
                for run in sorted(runs)
            ),
            responses=", and in ".join(
                surfaces.response_names[row]
                if plain[row, 0]
                else response_of_surface(surfaces.response_names[row])
                for row in of
            ),
            p=float(np.nanmin(p[of[0]])),
            n_runs=len(runs),
        )
        for runs, of in found
    )
