r"""Designs, their terms, coded units and levels.

**Designs as published: Box-Behnken for 3 to 7 factors, Plackett-Burman of 12, 20 and 24 runs.** A
row is a run, a column a factor, coded -1, 0, +1.

**Terms of the quadratic surface in the printed order, and the matrices built on them.** For
the factors :math:`X_1 .. X_k` in coded units,

.. math::

    y = B_1 + \sum_j B_{1+j} X_j^2 + \sum_j B_{1+k+j} X_j
        + \sum_{i<j} B_{..} X_i X_j

With frequency, mean tension and tension amplitude these are B1..B10 of [3]_, eq. 5: the mean,
the squares, the linear terms, then f Tm, f dT and Tm dT.  The squares precede the linear
terms; other programs print them last.  As printed, eq. 5a uses the physical factors with the
coefficients of the coded ones; as computed, a coefficient belongs to the units it was found in.

**Coded and engineering units, and the effect of a change between them on a surface**:

.. math:: X = \frac{x - (x_{high} + x_{low}) / 2}{(x_{high} - x_{low}) / 2}

**Levels of the factors of an experiment, and settings of each run.** A level is in SI, a
fraction of the rated break strength, or (an amplitude) a fraction of the run's mean tension.

References
----------
.. [1] G. E. P. Box and D. W. Behnken, "Some new three level designs for the study of quantitative
   variables," Technometrics 2(4), 1960, Table 1.
.. [2] CG-D-39-80 (three factors, sec. 4.3; screening in twelve runs, Appendix A).
.. [3] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, Tables 3-5 and 11-19; App. C, eqs. 5 and
   5a.
.. [4] R. H. Myers and D. C. Montgomery, Response Surface Methodology, 2nd ed. New York: Wiley,
   2002, example 7.5, p. 347.
.. [5] CG-D-39-80, Tables 1, 2 and A-1 (levels in per cent of break strength), App. C (coding).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, Integers, read_only_arrays

DesignKind = Literal["box-behnken", "plackett-burman"]

# Factors (from 1) that move together while the others stay at the centre.
TRIPLES = {
    6: ((1, 2, 4), (2, 3, 5), (3, 4, 6), (1, 4, 5), (2, 5, 6), (1, 3, 6)),
    7: ((4, 5, 6), (1, 6, 7), (2, 5, 7), (1, 2, 4), (3, 4, 7), (1, 3, 5), (2, 3, 6)),
}

PUBLISHED_CENTRES = {3: 3, 4: 3, 5: 6, 6: 6, 7: 6}

FIRST_ROWS = {
    12: "++-+++---+-",
    20: "++--++++-+-+----++-",
    24: "+++++-+-++--++--+-+----",
}


@dataclass(frozen=True)
@read_only_arrays
class Design:
    """Runs of an experiment in coded units, in standard order.

    Parameters
    ----------
    kind : str
        ``box-behnken`` or ``plackett-burman``.
    coded : ndarray, shape (n_runs, n_factors)
        Coded level of each factor: -1, 0 or +1. [1]
    dummy : ndarray, shape (n_runs, n_dummy)
        Columns of a Plackett-Burman design that no factor uses; they show only
        error. [1]
    """

    kind: DesignKind
    coded: Floats
    dummy: Floats

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.coded.shape[0])

    @property
    def n_factors(self) -> int:
        """Number of factors."""
        return int(self.coded.shape[1])


def box_behnken(n_factors: int, *, n_centre: int | None = None) -> Design:
    """Box-Behnken design: three levels of each factor, no corner of the cube.

    Parameters
    ----------
    n_factors : int
        3 to 7.
    n_centre : int, optional
        Centre runs; None: as published (3, 3, 6, 6, 6 for 3 to 7 factors).

    Returns
    -------
    design : Design
        Edge runs, factors of the lower number varying fastest, then the centres:
        15, 27, 46, 54 or 62 runs.

    Raises
    ------
    SettingsError
        If no design is published for the number of factors, or a count is negative.

    Notes
    -----
    Up to five factors move in pairs; six and seven in the triples of [1]_, which takes
    48 and 56 edge runs where all pairs would take 60 and 84.  The published blocks
    (three of nine runs for four factors, two for five and more) are not laid out.
    The design is not rotatable except for four and seven factors: the variance of the
    fitted response depends on the direction from the centre, see
    `reduction.experiments.run_sheet`.

    Examples
    --------
    The fifteen runs of [2]_:

    >>> box_behnken(3).n_runs
    15
    >>> box_behnken(3).coded[:4].astype(int).tolist()
    [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]
    """
    if n_factors not in PUBLISHED_CENTRES:
        raise SettingsError(
            "no Box-Behnken design for this number of factors",
            found=str(n_factors),
            needed="3 to 7 factors",
            hint="Screen first and keep the factors that matter."
            if n_factors > 7
            else "Add a factor, or take a factorial design.",
        )
    centres = PUBLISHED_CENTRES[n_factors] if n_centre is None else n_centre
    if centres < 0:
        raise SettingsError(
            "the number of centre runs is negative", found=str(centres), needed="0 or more"
        )
    factors = range(1, n_factors + 1)
    groups = TRIPLES.get(n_factors, tuple(combinations(factors, 2)))
    # product varies its last place fastest, the standard order its first
    signs = np.array(list(product((-1.0, 1.0), repeat=len(groups[0]))))[:, ::-1]
    edges = np.zeros((len(groups), signs.shape[0], n_factors))
    for block, group in zip(edges, groups, strict=True):
        block[:, np.array(group) - 1] = signs
    coded = np.vstack([edges.reshape(-1, n_factors), np.zeros((centres, n_factors))])
    return Design("box-behnken", coded, np.empty((coded.shape[0], 0)))


def plackett_burman(n_factors: int, *, n_runs: int | None = None) -> Design:
    """Plackett-Burman design: two levels, main effects free of each other.

    Parameters
    ----------
    n_factors : int
        Factors to screen; they take the first columns.
    n_runs : int, optional
        12, 20 or 24; None: the fewest that leave at least one dummy column, or all
        columns of 24 runs.

    Returns
    -------
    design : Design
        The published first row moved one place to the right a run, then a run with
        every factor low; the columns left over are ``dummy``.

    Raises
    ------
    SettingsError
        If the number of runs is not one of the three, or has no room for the factors.

    Notes
    -----
    Every column is orthogonal to every other, and half high, half low.  Two-factor
    interactions are partly aliased with the main effects
    (`reduction.experiments.screening.alias_matrix`).

    Examples
    --------
    Five factors in twelve runs leave six dummies, as in Appendix A of [2]_:

    >>> design = plackett_burman(5)
    >>> design.coded.shape, design.dummy.shape
    ((12, 5), (12, 6))
    """
    if n_factors < 1:
        raise SettingsError(
            "a screening design needs factors", found=str(n_factors), needed="1 to 23 factors"
        )
    enough = [runs for runs in FIRST_ROWS if n_factors < runs - 1]
    runs = (enough[0] if enough else max(FIRST_ROWS)) if n_runs is None else n_runs
    if runs not in FIRST_ROWS:
        raise SettingsError(
            "no Plackett-Burman design of this number of runs is built in",
            found=str(runs),
            needed="12, 20 or 24 runs",
        )
    if n_factors > runs - 1:
        raise SettingsError(
            f"{runs} runs have no room for the factors",
            found=f"{n_factors} factors",
            needed=f"at most {runs - 1}",
            hint="Take 24 runs for up to 23 factors." if n_factors <= 23 else "",
        )
    first = np.array([1.0 if sign == "+" else -1.0 for sign in FIRST_ROWS[runs]])
    place = np.arange(runs - 1)
    cyclic = first[(place[None, :] - place[:, None]) % (runs - 1)]
    columns = np.vstack([cyclic, -np.ones(runs - 1)])
    return Design("plackett-burman", columns[:, :n_factors], columns[:, n_factors:])


def quadratic_exponents(n_factors: int) -> Integers:
    """Powers of each factor in each term of the quadratic surface, in printed order.

    Parameters
    ----------
    n_factors : int
        One or more.

    Returns
    -------
    exponents : ndarray of int, shape (n_terms, n_factors)
        Mean, squares, linear terms, interactions (1, 2), (1, 3), .. (2, 3) .. [1]

    Raises
    ------
    SettingsError
        If there is no factor.

    Notes
    -----
    Source: [3]_, eq. 5.  There are (k + 1)(k + 2) / 2 terms.

    Examples
    --------
    >>> print(quadratic_exponents(2).tolist())
    [[0, 0], [2, 0], [0, 2], [1, 0], [0, 1], [1, 1]]
    """
    if n_factors < 1:
        raise SettingsError("a surface has no factor", found=f"{n_factors}", needed="one or more")
    unit = np.eye(n_factors, dtype=np.int64)
    pairs = [unit[first] + unit[second] for first, second in combinations(range(n_factors), 2)]
    return np.vstack([np.zeros_like(unit[:1]), 2 * unit, unit, *pairs])


def term_kinds(exponents: Integers) -> tuple[str, ...]:
    """Kind of each term: mean, square, linear or interaction.

    Examples
    --------
    >>> term_kinds(quadratic_exponents(2))
    ('mean', 'square', 'square', 'linear', 'linear', 'interaction')
    """
    kinds = {(0, 0): "mean", (1, 1): "linear", (2, 2): "square", (2, 1): "interaction"}
    found = [(int(row.sum()), int(row.max())) for row in exponents]
    strange = [shape for shape in found if shape not in kinds]
    if strange:
        raise SettingsError(
            "a term is above second order", found=f"order {strange[0][0]}", needed="0, 1 or 2"
        )
    return tuple(kinds[shape] for shape in found)


def term_names(exponents: Integers, factor_names: Sequence[str]) -> tuple[str, ...]:
    """Names of the terms, composed of the names of the factors.

    Parameters
    ----------
    exponents : ndarray of int, shape (n_terms, n_factors)
        As from `quadratic_exponents`. [1]
    factor_names : sequence of str, length n_factors
        In the order of the columns.

    Returns
    -------
    names : tuple of str, length n_terms
        ``mean``, ``f^2``, ``f``, ``f*T``.

    Raises
    ------
    SettingsError
        If the names do not pair up with the factors, or one is repeated.

    Examples
    --------
    >>> term_names(quadratic_exponents(2), ["frequency", "mean_tension"])[1:]
    ('frequency^2', 'mean_tension^2', 'frequency', 'mean_tension', 'frequency*mean_tension')
    """
    if len(factor_names) != exponents.shape[1] or len(set(factor_names)) != len(factor_names):
        raise SettingsError(
            "the names do not pair up with the factors",
            found=", ".join(factor_names) or "no name",
            needed=f"{exponents.shape[1]} different names",
        )
    return tuple(
        "*".join(
            name if power == 1 else f"{name}^{power}"
            for name, power in zip(factor_names, row, strict=True)
            if power
        )
        or "mean"
        for row in exponents
    )


def model_matrix(coded: ArrayLike, exponents: Integers) -> Floats:
    r"""Value of each term at each point.

    .. math:: x_{it} = \prod_j X_{ij}^{p_{tj}}

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        Points, in the units the coefficients belong to. [1]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers :math:`p`. [1]

    Returns
    -------
    matrix : ndarray, shape (..., n_terms)
        One row a point. [1]

    Raises
    ------
    DataError
        If a point is not finite, or has a different number of factors.

    Examples
    --------
    The corner (1, -1) of a square:

    >>> print(model_matrix([1.0, -1.0], quadratic_exponents(2)))
    [ 1.  1.  1.  1. -1. -1.]
    """
    points = as_finite("the levels", coded)
    matrix = np.ones((*points.shape[:-1], len(exponents)))
    for term, powers in enumerate(exponents):
        for factor in np.repeat(np.arange(powers.size), powers):
            matrix[..., term] *= points[..., factor]
    return matrix


def gradient_matrix(coded: ArrayLike, exponents: Integers) -> Floats:
    r"""Derivative of each term by each factor at each point.

    .. math:: d_{ijt} = \partial x_{it} / \partial X_{ij}

    Examples
    --------
    Derivatives of 1, X^2 and X at X = 3:

    >>> print(gradient_matrix([3.0], quadratic_exponents(1)))
    [[0. 6. 1.]]
    """
    points = as_finite("the levels", coded)
    slopes = []
    for power, step in zip(exponents.T, np.eye(exponents.shape[1], dtype=np.int64), strict=True):
        lowered = np.maximum(exponents - step, 0)
        slopes.append(power * model_matrix(points, lowered))
    return np.stack(slopes, axis=-2)


def coded_from_engineering(levels: ArrayLike, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Levels on the scale where the low one is -1 and the high one is +1.

    .. math:: X = \frac{x - (x_{high} + x_{low}) / 2}{(x_{high} - x_{low}) / 2}

    Parameters
    ----------
    levels : array_like, shape (..., n_factors)
        Factors in their own units. [SI unit of each factor]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    coded : ndarray, shape (..., n_factors)
        NaN in, NaN out. [1]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    Source: [3]_, App. C.

    Examples
    --------
    Mean loads of the 1/2 in nylon, 768 to 1920 lb:

    >>> print(coded_from_engineering([[768.0], [1344.0], [1920.0]], low=[768.0], high=[1920.0]).T)
    [[-1.  0.  1.]]
    """
    centre, half = _centre_and_half(low, high)
    coded: Floats = (np.asarray(levels, dtype=np.float64) - centre) / half
    return coded


def engineering_from_coded(coded: ArrayLike, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Levels in the units of the factors.

    .. math:: x = (x_{high} + x_{low}) / 2 + X (x_{high} - x_{low}) / 2

    Parameters
    ----------
    coded : array_like, shape (..., n_factors)
        Coded levels. [1]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    levels : ndarray, shape (..., n_factors)
        NaN in, NaN out. [SI unit of each factor]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    Source: [3]_, App. C.

    Examples
    --------
    >>> print(engineering_from_coded([0.0], low=[0.1], high=[0.5]).round(3))
    [0.3]
    """
    centre, half = _centre_and_half(low, high)
    levels: Floats = centre + np.asarray(coded, dtype=np.float64) * half
    return levels


def engineering_matrix(exponents: Integers, *, low: ArrayLike, high: ArrayLike) -> Floats:
    r"""Matrix that converts coefficients of coded factors to those of the factors themselves.

    With centre :math:`c` and half range :math:`h` of each factor,

    .. math:: M_{st} = \prod_j \binom{p_{tj}}{p_{sj}} \frac{(-c_j)^{p_{tj} - p_{sj}}}{h_j^{p_{tj}}},
              \qquad b_{eng} = M b_{coded}, \qquad V_{eng} = M V_{coded} M^T

    Parameters
    ----------
    exponents : ndarray of int, shape (n_terms, n_factors)
        Powers :math:`p` of the terms, all terms of the quadratic surface. [1]
    low, high : array_like, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]

    Returns
    -------
    matrix : ndarray, shape (n_terms, n_terms)
        Row s is the coefficient of term s in engineering units.
        [1 over the unit of term s, for a coded coefficient in the unit of the response]

    Raises
    ------
    SettingsError
        If a high level does not lie above its low one, or the shapes do not pair up.

    Notes
    -----
    A coefficient in engineering units mixes several coded ones, so that its uncertainty needs
    the whole covariance; the errors of the engineering coefficients are almost collinear.

    Examples
    --------
    Example 7.5 of [4]_, temperature 175 +- 25: 62 + X - 7.375 X^2 is, in degrees,

    >>> matrix = engineering_matrix(np.array([[0], [2], [1]]), low=[150.0], high=[200.0])
    >>> print((matrix @ [62.0, -7.375, 1.0]).round(4))
    [-3.06375e+02 -1.18000e-02  4.17000e+00]
    """
    centre, half = _centre_and_half(low, high)
    of_row, of_column = exponents[:, None, :], exponents[None, :, :]
    step = np.maximum(of_column - of_row, 0)
    # comb is 0 where the power of the row exceeds that of the column
    factor = scipy.special.comb(of_column, of_row) * (-centre) ** step / half**of_column
    product: Floats = np.prod(factor, axis=-1)
    return product


def _centre_and_half(low: ArrayLike, high: ArrayLike) -> tuple[Floats, Floats]:
    bottom, top = as_finite("low", low), as_finite("high", high)
    if bottom.shape != top.shape or bottom.ndim != 1:
        raise SettingsError(
            "the low and high levels do not pair up",
            found=f"shapes {bottom.shape} and {top.shape}",
            needed="one low and one high level per factor",
        )
    wrong = np.flatnonzero(~(top > bottom))
    if wrong.size:
        first = int(wrong[0])
        raise SettingsError(
            f"the high level of factor {first + 1} does not lie above its low one",
            found=f"{bottom[first]:g} and {top[first]:g}",
            needed="low < high",
        )
    return (top + bottom) / 2, (top - bottom) / 2


LevelBasis = Literal["absolute", "rated_break_strength", "mean_tension"]

LOADS = ("mean_tension", "tension_amplitude")

ABOVE_ZERO = ("frequency", *LOADS)


@dataclass(frozen=True)
class FactorLevels:
    """Low and high level of one factor; the centre is half way between.

    Parameters
    ----------
    name : str
        ``frequency``, ``mean_tension``, ``tension_amplitude``, or any other name.
    low, high : float
        Levels at -1 and +1: in SI, or the fraction that ``basis`` names.
    basis : str
        ``absolute``: SI; ``rated_break_strength``: a fraction of it, so 12 % is 0.12;
        ``mean_tension``: a fraction of the mean tension of the same run, only for
        ``tension_amplitude``. [1]
    """

    name: str
    low: float
    high: float
    basis: LevelBasis = "absolute"

    def __post_init__(self) -> None:
        """Refuse levels that no machine can run."""
        found = f"{self.low:g} and {self.high:g}"
        # not (a < b) also catches NaN
        if not self.low < self.high or not np.isfinite([self.low, self.high]).all():
            raise SettingsError(
                f"the levels of {self.name} do not rise",
                found=found,
                needed="a finite low level below a finite high level",
            )
        if self.name in ABOVE_ZERO and self.low <= 0:
            raise SettingsError(
                f"a level of {self.name} is not above zero", found=found, needed="levels above zero"
            )
        if self.basis == "rated_break_strength" and self.name not in LOADS:
            raise SettingsError(
                f"{self.name} cannot be a fraction of the rated break strength",
                needed=f"a level in its own unit; the fraction is for {' and '.join(LOADS)}",
            )
        if self.basis == "mean_tension" and self.name != "tension_amplitude":
            raise SettingsError(
                f"{self.name} cannot be a fraction of the mean tension",
                needed="a level in its own unit; the fraction is for tension_amplitude",
            )
        if self.basis != "absolute" and self.high > 1:
            of = self.basis.replace("_", " ")
            raise SettingsError(
                f"a level of {self.name} is more than the whole {of}",
                found=found,
                needed="fractions up to 1; 12 % is 0.12",
                hint="The line would go slack in every cycle."
                if self.basis == "mean_tension"
                else "",
            )


def _check_factors(factors: tuple[FactorLevels, ...], n_columns: int) -> None:
    names = [factor.name for factor in factors]
    if len(names) != n_columns:
        raise SettingsError(
            "the factors do not fit the design",
            found=f"{len(names)} factors",
            needed=f"{n_columns}, one a column",
        )
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise SettingsError("a factor appears twice", found=", ".join(twice), needed="each once")


def engineering_levels(
    coded: ArrayLike,
    factors: tuple[FactorLevels, ...],
    *,
    rated_break_strength: ArrayLike | None = None,
) -> Floats:
    r"""Settings of each run, in SI.

    .. math:: \text{level} = \frac{h + l}{2} + X\,\frac{h - l}{2}

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Coded levels, usually of a `Design`. [1]
    factors : tuple of FactorLevels, length n_factors
        In the order of the columns.
    rated_break_strength : array_like, shape () or (n_runs,), optional
        Needed where a factor is a fraction of it; one value per run where the line differs
        from run to run (two diameters in one screening). [N]

    Returns
    -------
    levels : ndarray, shape (n_runs, n_factors)
        Levels of each run in SI; fractions are converted to tensions. [SI unit of each factor]

    Raises
    ------
    SettingsError
        If the factors do not fit the design or are repeated, or the reference of a fraction
        is missing.
    DataError
        If the coded levels or the break strength are not finite numbers, or do not fit.

    Notes
    -----
    Source: [5]_, Appendix C, solved for the level.  With the amplitude as a fraction of
    the mean tension no run reaches zero tension, but the amplitude in newtons is then a
    product of two factors: fit a surface in the fraction.

    Examples
    --------
    Nylon double braid 1/2 in of [5]_, break strength 6400 lb: 768 to 1920 lb, mean 1344:

    >>> mean = FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength")
    >>> print(engineering_levels([[-1.0], [0.0], [1.0]], (mean,), rated_break_strength=6400)[:, 0])
    [ 768. 1344. 1920.]
    """
    runs = as_finite("coded", coded)
    if runs.ndim != 2:
        raise DataError(
            "the coded levels are not a table of runs",
            found=f"shape {runs.shape}",
            needed="one row per run, one column per factor",
        )
    _check_factors(factors, runs.shape[1])
    names = [factor.name for factor in factors]
    low = np.array([factor.low for factor in factors])
    high = np.array([factor.high for factor in factors])
    levels = engineering_from_coded(runs, low=low, high=high)
    strength = None
    if rated_break_strength is not None:
        strength = as_positive("rated_break_strength", rated_break_strength)
        if strength.shape not in ((), runs.shape[:1]):
            raise DataError(
                "the rated break strength does not fit the runs",
                found=f"shape {strength.shape}",
                needed=f"one value, or {runs.shape[0]}",
            )
    of_strength = [factor.basis == "rated_break_strength" for factor in factors]
    if any(of_strength):
        if strength is None:
            raise SettingsError(
                "a level is a fraction of the rated break strength, which is not given",
                found=", ".join(np.array(names)[of_strength]),
                needed="the rated break strength of the line",
                hint="Give rated_break_strength of the specimen, or the levels in newtons.",
            )
        levels[:, of_strength] *= strength[..., None]
    of_mean = [factor.basis == "mean_tension" for factor in factors]
    if any(of_mean):
        if "mean_tension" not in names:
            raise SettingsError(
                "an amplitude is a fraction of the mean tension, which is not a factor",
                needed="a factor mean_tension",
                hint="Give the amplitude in newtons, or as a fraction of the break strength.",
            )
        levels[:, of_mean] *= levels[:, [names.index("mean_tension")]]
    return levels
