r"""Plackett-Burman screening: which of many factors affect a response.

**Screening: which of many factors affect a response at all**:

.. math:: E_j = \bar y_{j+} - \bar y_{j-}, \qquad
   S_{FE} = \sqrt{\frac{1}{m} \sum_{dummies} E_d^2}, \qquad
   E_{min} = t_{1 - \alpha/2;\, m}\, S_{FE}

References
----------
.. [1] R. L. Plackett and J. P. Burman, "The design of optimum multifactorial experiments,"
   Biometrika 33(4), 1946.
.. [2] CG-D-39-80, Appendix A, Table A-2: five factors in twelve runs, effects, and the smallest
   significant effect at 90 %.
.. [3] R. V. Lenth, "Quick and easy analysis of unreplicated factorials," Technometrics 31(4),
   1989.
.. [4] G. E. P. Box and R. D. Meyer, "Finding the active factors in fractionated screening
   experiments," Journal of Quality Technology 25(2), 1993 (cast fatigue).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.experiments.designs import Design
from reduction.experiments.least_squares_fit import two_sided_p
from reduction.experiments.run_sheet import SIGNIFICANCE
from reduction.record.arrays import as_finite
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note


def _two_level_columns(columns: ArrayLike) -> Floats:
    """Columns of a two-level design as numbers; a refusal names invalid ones.

    Examples
    --------
    >>> print(_two_level_columns([[-1], [1]]).ravel())
    [-1.  1.]
    """
    levels = as_finite("the design", columns)
    if levels.ndim != 2 or not np.all(np.abs(levels) == 1):
        raise DataError(
            "the design is not a table of two levels",
            found=f"shape {levels.shape}, levels {sorted(set(levels.ravel().tolist()))[:5]}",
            needed="-1 and +1, one row per run",
        )
    return levels


def alias_matrix(coded: ArrayLike) -> tuple[tuple[tuple[int, int], ...], Floats]:
    r"""Fraction of each two-factor interaction contained in the mean and in each main effect.

    .. math:: A = (X_1^T X_1)^{-1} X_1^T X_2, \qquad E[E_j] = E_j + \sum_{kl} A_{j,kl} E_{kl}

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Columns of the factors, without dummies. [1]

    Returns
    -------
    pairs : tuple of (int, int), length n_pairs
        Factors of each interaction, from 0.
    alias : ndarray, shape (1 + n_factors, n_pairs)
        First row the mean, then one row per factor. [1]

    Raises
    ------
    DataError
        If the columns do not have two levels, or two factors always vary together.

    Notes
    -----
    Source: [1]_.  In twelve runs every interaction of two other factors is contained in a main
    effect with a third of its size, plus or minus: a factor that appears active may be
    the sum of interactions.

    Examples
    --------
    >>> from reduction.experiments.designs import plackett_burman
    >>> pairs, alias = alias_matrix(plackett_burman(3).coded)
    >>> pairs[2], round(float(abs(alias[1, 2])), 3)  # the second and third factor in the first
    ((1, 2), 0.333)
    """
    levels = _two_level_columns(coded)
    pairs = tuple(combinations(range(levels.shape[1]), 2))
    first = np.column_stack([np.ones(levels.shape[0]), levels])
    second = np.empty((levels.shape[0], len(pairs)))
    for column, (one, other) in enumerate(pairs):
        second[:, column] = levels[:, one] * levels[:, other]
    if np.linalg.matrix_rank(first) < first.shape[1]:
        raise DataError(
            "the factors of the design cannot be told apart",
            found=f"rank {np.linalg.matrix_rank(first)}",
            needed=f"{first.shape[1]}",
        )
    alias = np.linalg.lstsq(first, second, rcond=None)[0].astype(np.float64)
    return pairs, alias


EffectError = Literal["dummy", "lenth"]


@dataclass(frozen=True)
@read_only_arrays
class ScreeningEffects:
    """Effects of the factors on one or many responses.

    Parameters
    ----------
    names : tuple of str, length n_factors
    effect : ndarray, shape (..., n_factors)
        Mean response at the high level less that at the low one. [unit of the response]
    dummy_effect : ndarray, shape (..., n_dummy)
        The same for the columns that no factor uses. [unit of the response]
    mean : ndarray, shape (...)
        Mean of all runs. [unit of the response]
    effect_standard_error : ndarray, shape (...)
        From the dummies, or Lenth's pseudo standard error. [unit of the response]
    error_from : str
        ``dummy`` or ``lenth``.
    degrees_of_freedom : float
        Of the standard error. [1]
    t_value, p_value : ndarray, shape (..., n_factors)
        For each effect, two-sided. [1]
    minimum_significant_effect : ndarray, shape (...)
        At the level for one effect. [unit of the response]
    simultaneous_minimum_effect : ndarray, shape (...)
        At the level for all effects of a response together (Sidak). [unit of the response]
    is_significant : ndarray of bool, shape (..., n_factors)
        True if the effect exceeds the minimum for one effect.
    significance : float
        The level, two-sided. [1]
    reason : ndarray of str, shape (...)
        Reason why a response has no number; else empty.
    """

    names: tuple[str, ...]
    effect: Floats
    dummy_effect: Floats
    mean: Floats
    effect_standard_error: Floats
    error_from: EffectError
    degrees_of_freedom: float
    t_value: Floats
    p_value: Floats
    minimum_significant_effect: Floats
    simultaneous_minimum_effect: Floats
    is_significant: Bools
    reason: np.ndarray[tuple[int, ...], np.dtype[np.str_]]


def _pseudo_standard_error(effects: Floats) -> Floats:
    """Lenth's estimate: 1.5 medians of the effects, repeated without the large ones [3]_."""
    size = np.abs(effects)
    first = 1.5 * np.median(size, axis=-1, keepdims=True)
    # A constant response has zero effects only, and none to leave out.
    small = np.where((size < 2.5 * first) | (first == 0), size, np.nan)
    second: Floats = 1.5 * np.nanmedian(small, axis=-1)
    return second


def screening_remarks(n_dummy: int, has_blocks: bool) -> list[Note]:
    """Remarks on the origin of the error of effects.

    Parameters
    ----------
    n_dummy : int
        Number of columns that no factor uses. [1]
    has_blocks : bool
        True if the runs are of several specimens.

    Returns
    -------
    remarks : list of Note
        Empty if dummies of one specimen give the error.

    Raises
    ------
    SettingsError
        If the number of columns is negative.

    Examples
    --------
    >>> screening_remarks(6, False)
    []
    """
    if n_dummy < 0:
        raise SettingsError("a number of columns", found=str(n_dummy), needed="0 or more")
    lenth, blocks = note("error-by-lenth"), note("effects-over-blocks")
    return [lenth] * (n_dummy == 0) + [blocks] * has_blocks


def screening_effects(
    design: Design,
    response: ArrayLike,
    *,
    names: Sequence[str] | None = None,
) -> ScreeningEffects:
    """Effects of a two-level screening, their error, and the smallest significant one.

    Parameters
    ----------
    design : Design
        With two levels; from `plackett_burman`, or the table of an experiment made elsewhere.
    response : array_like, shape (..., n_runs)
        In the order of the rows of the design; any number of responses at once.
        [unit of the response]
    names : sequence of str, optional
        Names of the factors; None: X1, X2, ..

    Returns
    -------
    effects : ScreeningEffects
        A response with a run missing (NaN) has NaN and a reason: without that run the
        columns are no longer orthogonal.

    Raises
    ------
    SettingsError
        If the names do not fit.
    DataError
        If the design is not of two levels, balanced and orthogonal.

    Notes
    -----
    With dummy columns the error is their root mean square, with as many degrees of
    freedom; without, Lenth's pseudo standard error with a third of the effects [3]_.
    Both include two-factor interactions besides noise (`alias_matrix`).  [2]_
    prints neither runs nor formula: this is the published method, with
    ``t(0.10, 6) = 1.943`` for its five factors and six dummies.

    Examples
    --------
    Cast fatigue [4]_; the factor F has the greatest effect, 0.915:

    >>> rows = ["++-+++-", "+-+++--", "-+++---", "+++---+", "++---+-", "+---+-+",
    ...         "---+-++", "--+-++-", "-+-++-+", "+-++-++", "-++-+++", "-------"]
    >>> columns = np.array([[1.0 if sign == "+" else -1.0 for sign in row] for row in rows])
    >>> life = [6.058, 4.733, 4.625, 5.899, 7.000, 5.752, 5.682, 6.607, 5.818, 5.917, 5.863, 4.809]
    >>> design = Design("plackett-burman", columns, np.empty((12, 0)))
    >>> print(screening_effects(design, life, names="ABCDEFG").effect.round(5))
    [ 0.32583  0.29383 -0.24583 -0.51617  0.14983  0.91517  0.18317]
    """
    columns = _two_level_columns(np.hstack([design.coded, design.dummy]))
    n_runs, n_columns = columns.shape
    cross = np.abs(np.column_stack([np.ones(n_runs), columns]).T @ columns)
    np.fill_diagonal(cross[1:], 0)
    if cross.any():
        raise DataError(
            "the columns of the design are not balanced and orthogonal",
            found=f"{int(np.count_nonzero(cross))} pairs of columns that share runs unevenly",
            needed="a complete two-level design",
            hint="Add the runs that are missing, or fit a surface to those there are.",
        )
    values = np.asarray(response, dtype=np.float64)
    labels = tuple(f"X{i + 1}" for i in range(design.n_factors)) if names is None else tuple(names)
    if len(labels) != design.n_factors or len(set(labels)) != len(labels):
        raise SettingsError(
            "the names do not fit the factors",
            found=", ".join(labels),
            needed=f"{design.n_factors} different names",
        )
    is_whole = np.asarray(np.isfinite(values).all(axis=-1))
    usable = np.where(is_whole[..., None], values, np.nan)
    effects = usable @ columns * (2 / n_runs)
    effect, dummy = effects[..., : design.n_factors], effects[..., design.n_factors :]
    error_from: EffectError
    if dummy.shape[-1]:
        error_from, freedom = "dummy", float(dummy.shape[-1])
        error = np.sqrt(np.mean(dummy**2, axis=-1))
    else:
        error_from, freedom = "lenth", n_columns / 3
        error = np.full(is_whole.shape, np.nan)
        error[is_whole] = _pseudo_standard_error(effects[is_whole])
    reach, together = stdtrit(
        freedom, 1 - np.array([SIGNIFICANCE, 1 - (1 - SIGNIFICANCE) ** (1 / len(labels))]) / 2
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        t_value = effect / error[..., None]
    smallest = reach * error
    stands_still = np.asarray(np.ptp(values, axis=-1) == 0)
    return ScreeningEffects(
        names=labels,
        effect=effect,
        dummy_effect=dummy,
        mean=usable.mean(axis=-1),
        effect_standard_error=error,
        error_from=error_from,
        degrees_of_freedom=freedom,
        t_value=t_value,
        p_value=two_sided_p(t_value, freedom),
        minimum_significant_effect=smallest,
        simultaneous_minimum_effect=together * error,
        is_significant=np.abs(effect) > smallest[..., None],
        reason=np.select(
            [~is_whole, stands_still],
            [
                "a run is missing: without it the columns are not orthogonal",
                "every run has the same response",
            ],
            default="",
        ),
    )
