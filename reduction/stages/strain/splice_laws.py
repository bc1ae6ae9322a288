r"""The splice laws that tape readings at the toes support, each fitted, judged and weighted.

Every law gives the strain of the splices as

.. math:: \varepsilon_s = s_0 + \rho\,\varepsilon + \kappa\,\varepsilon^2
   + \gamma\,\varepsilon^3 + c F^n + a\,(1 - e^{-b F})

and the laws differ in their terms: the splices strain by the tension that they carry
(:math:`c, n`, or up to a limit, :math:`a, b`), by a fraction of the free strain
(:math:`\rho`), by a fraction that changes along the stroke (:math:`\kappa, \gamma`), by both, or
after they have bedded in (:math:`s_0`).

Tape readings distinguish a law of tension from one of strain by curvature alone, and the loops of
the two have different widths.  Each side therefore has laws with enough curvature, a
power of the tension and a cubic in the strain.  None may have splices that shorten as the free
length stretches at one tension: a mixture would use that to imitate a curve.

References
----------
.. [1] K. P. Burnham and D. R. Anderson, Model Selection and Multimodel Inference, 2nd ed.,
   Springer, 2002, ch. 2 and 4 (weights by Akaike's criterion; variance of an average over models).
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import scipy

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.stages.plausible_bands import words_of_ratio

LAWS: dict[str, tuple[str, ...]] = {
    "tension-driven": ("tension",),
    "strain-ratio": ("strain",),
    "mixture": ("strain", "tension"),
    "marks-linear": ("offset", "strain"),
    "strain-curve": ("strain", "square"),
    "strain-cubic": ("strain", "square", "cube"),
    "bedded tension-driven": ("offset", "tension"),
    "bedded curve": ("offset", "strain", "square"),
    "bedded mixture": ("offset", "strain", "tension"),
    "mixture with curve": ("strain", "square", "tension"),
    "saturating": ("saturating",),
    "bedded saturating": ("offset", "saturating"),
    "saturating mixture": ("strain", "saturating"),
    "saturating with line": ("tension", "saturating"),
}
"""Laws and the terms of the splice strain in each of them."""

SATURATING = {
    "saturating": "tension-driven",
    "bedded saturating": "bedded tension-driven",
    "saturating mixture": "mixture",
    "saturating with line": "tension-driven",
}
"""Laws whose strain by tension tends to a limit, and the corresponding law without one."""

TERMS = {"offset": 0, "strain": 1, "square": 2, "cube": 3, "tension": 4, "saturating": 6}
"""Places in `FittedLaw.values`: the last two are splice strains at the reference tension."""

OF_TENSION = frozenset({"tension", "saturating"})
"""Terms for strain of the splices by the tension that they carry."""

_EXPONENT, _SATURATION, _N_VALUES = 5, 7, 10
_OF_TENSION = np.arange(4, 8)  # both of them, each with its shape

_TENSIONS = 24  # at which laws that saturate are compared

_RANK = 1e-6  # of the change of these strains with a law: smaller singular values are dropped

REJECTED = 0.001
"""Least chance of a misfit, for sound marks, at which a law is still used. [1]"""

_EXACT = 1e-14  # variance of a relative length

_FAR = 4.0  # standard errors from every law beyond which a mark is set aside

_ENOUGH = 6  # loaded marks for each one that may be set aside

_PASSES = 3

_DOUBT = 0.05  # chance of a misfit below which slip and outlying marks are tested

_SLIPS = np.geomspace(0.5, 100.0, 16)  # of a reading of the tape

_STEP = 0.01  # of the exponent, for the curvature of the misfit

_EXPONENTS = np.linspace(0.3, 1.9, 9)

# of the exponent between those: used where the misfit's curvature does not limit it to the range
_FINE_EXPONENTS = np.linspace(0.3, 1.9, 33)

# of the saturation b times the reference tension: zero is a straight line, and above the last
# splices no longer lengthen
_SATURATIONS = np.array([0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 2.7, 3.5, 4.5, 6.0, 8.0])
_FINE_SATURATIONS = np.linspace(0.1, 8.0, 33)

_NOWHERE = 1e12

# of the splices' length: settlement of splices when they are first loaded; for a law of position
# also the misfit of its line or curve below the lowest mark
_BEDDING, _INTERCEPT = 0.03, 0.1

_MOST_FALL = 2.0  # standard errors by which splice strain per free strain may be negative

# least weight of the laws of a side that fits: for two laws with this weight and the rest, the 95 %
# interval about their mean reaches both, as 1.96 sqrt(w (1 - w)) >= 1 - w
_LEAST = 1 / (1 + 1.96**2)

_CURVE = 4  # coefficients of the tension over the strain, at most

_SPARE = 2  # marks in excess of coefficients from which a cubic is tried

_ONE_STRETCH = 0.02  # of the free strain: range within which marks are at one stretch

_SPAN = 1.5  # ratio of tensions from which an exponent is fitted


@dataclass(frozen=True)
@read_only_arrays
class SpliceReadings:
    """Stretched and slack rows of a specimen, in the form that the laws need; shape (n_rows,).

    ``free`` [1] and ``splice`` [1] are strains of the free length and of both splices; ``tension``
    [N] is NaN where it is not known and ``tension_uncertainty`` [1] its relative standard
    uncertainty; ``test`` numbers the test of a row from 0.  ``share`` is the
    relaxed length of the splices over that of the free length [1], ``tape`` the standard
    uncertainty of one reading over the relaxed length of the splices [1], worth
    ``tape_freedom`` readings where it was not stated, and ``relaxed`` the covariance of the
    relative errors of free and splice length [1]; ``row`` is the place of each among the marks.
    """

    free: Floats
    splice: Floats
    tension: Floats
    test: np.ndarray
    is_slack: Bools
    share: float
    tape: float
    relaxed: Floats
    row: np.ndarray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    tension_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    tape_freedom: float = np.inf

    @property
    def reference(self) -> float:
        """Geometric mean of the known tensions; 1 where there is none. [N]."""
        known = self.tension[np.nan_to_num(self.tension) > 0]
        return float(np.exp(np.mean(np.log(known)))) if known.size else 1.0

    @property
    def is_one_stretch(self) -> bool:
        """Whether all loaded rows are at one stretch: a law between it and slack is assumed."""
        free = self.free[~self.is_slack]
        return bool(free.size and np.ptp(free) <= _ONE_STRETCH * free.max())

    def without(self, row: int) -> SpliceReadings:
        """Return the readings without one row."""
        kept = np.arange(self.free.size) != row
        return SpliceReadings(
            self.free[kept], self.splice[kept], self.tension[kept], self.test[kept],
            self.is_slack[kept], self.share, self.tape, self.relaxed,
            self.row[kept[: self.row.size]],
            self.tension_uncertainty[kept[: self.tension_uncertainty.size]],
            self.tape_freedom,
        )  # fmt: skip


@dataclass(frozen=True)
@read_only_arrays
class FittedLaw:
    """Best fit of one law: coefficients of `TERMS`, shapes and relaxed lengths, with covariance.

    Shape (10,) and (10, 10), zero for missing terms.  The tension is followed by its exponent,
    the saturating term by its saturation, b times the reference tension; the last two are the
    relative excess of free and splice length over the slack rows.  ``chi_square`` is
    relative to the stated error of the tape, with ``freedom``; ``chance`` is its probability,
    ``criterion`` that of Akaike.
    """

    name: str
    values: Floats
    covariance: Floats
    chi_square: float
    freedom: int
    criterion: float
    residual: Floats

    @property
    def chance(self) -> float:
        """Probability of a misfit at least as large if law and stated error are right. [1]."""
        # the usual settlement of splices is known beforehand, and counts as one more reading
        freedom = self.freedom + ("offset" in LAWS[self.name])
        return 1.0 if freedom <= 0 else float(scipy.special.chdtrc(freedom, self.chi_square))

    @property
    def spread(self) -> Floats:
        """Covariance, scaled up for a doubtful law according to its misfit, shape (10, 10)."""
        is_doubtful = self.freedom > 0 and self.chance < _DOUBT
        return self.covariance * (self.chi_square / self.freedom if is_doubtful else 1.0)

    @property
    def n_terms(self) -> int:
        """Number of its coefficients."""
        shapes = np.diag(self.covariance)[[_EXPONENT, _SATURATION]]
        return len(LAWS[self.name]) + int(np.count_nonzero(shapes))

    def by_tension(self, relative: Floats) -> tuple[Floats, Floats]:
        """Splice strain by a relative tension, and its derivative by the logarithm."""
        power = self.values[TERMS["tension"]] * relative ** self.values[_EXPONENT]
        limited, steepness = _saturated(relative, float(self.values[_SATURATION]))
        size = self.values[TERMS["saturating"]]
        return power + size * limited, self.values[_EXPONENT] * power + size * steepness


@dataclass(frozen=True)
@read_only_arrays
class SpliceAverage:
    """Average over the laws that the marks do not reject.

    Parameters
    ----------
    values : ndarray, shape (10,)
        Mean coefficients of `TERMS` and of their shapes, and relative excess of relaxed free and
        splice length over the slack rows. [1]
    covariance : ndarray, shape (10, 10)
        From errors of the tape alone. [1]
    between : ndarray, shape (10, 10)
        From the choice of law. [1]
    reference : float
        Tension at which the coefficients of `OF_TENSION` are the splice strains. [N]
    laws : tuple of FittedLaw
        Every law that was fitted, best first.
    weight : ndarray, shape (n_laws,)
        Zero for rejected laws. [1]
    slip : float
        Standard deviation of the splice strain between tests; zero where the marks show none. [1]
    test_offset : ndarray, shape (n_tests,)
        Relative excess length of the splices of each test. [1]
    test_variance : ndarray, shape (n_tests,)
        Variance of these. [1]
    set_aside : tuple of int
        Rows far from every law that the others agree with, at most one of six.
    is_checked : bool
        False where every law with a spare mark is doubtful, and the others follow any marks: a
        misread mark would not show.  Where none of the former passes, laws that the marks
        reject have a weight.  Also false where all marks are at one stretch.
    """

    values: Floats
    covariance: Floats
    between: Floats
    reference: float
    laws: tuple[FittedLaw, ...]
    weight: Floats
    slip: float
    test_offset: Floats
    test_variance: Floats
    set_aside: tuple[int, ...] = ()
    is_checked: bool = True


def fit_splice_laws(
    readings: SpliceReadings, *, specimen: str = "", names: Sequence[str] = ()
) -> SpliceAverage:
    r"""Fit every law that the marks support, and average those that they do not reject.

    Parameters
    ----------
    readings : SpliceReadings
        Rows of all tests of the specimen.
    specimen : str
        Name, for messages.
    names : sequence of str
        Names of the rows, for messages.

    Returns
    -------
    average : SpliceAverage
        With the laws, best first.

    Raises
    ------
    DataError
        If no law has a mark to be fitted to, or the marks reject every law.

    Notes
    -----
    A law passes if its misfit, relative to the stated error of the tape, has a chance of at least
    one in a thousand.  Laws that pass are weighted by Akaike's criterion,
    :math:`w \propto e^{-\mathrm{AIC}/2}`; equally where one of them has fewer marks than
    coefficients plus two, since the misfit then shows nothing.  Where a law of tension alone and
    one of strain alone both fit, neither has less than a fifth.  Only curvature distinguishes them,
    the width of a loop depends on the choice, and it is an assumption that the true curve is a
    power or a cubic.  The difference between the laws is a source
    of uncertainty of its own, the second term of

    .. math:: \sum w_k C_k + \sum w_k (\theta_k - \bar\theta)(\theta_k - \bar\theta)^T

    ([1]_, eq. 4.9, without its square root).  An exponent of one law counts in that of the
    mean in proportion to the strain of its law by tension.  An exponent that the marks do not
    determine has the variance that the misfit leaves within its range.  Where readings of one test
    are off together, the splices have slipped between tests ([2]_, sec. 4.7): the variance between
    tests is the most likely one, and each test has the offset by its own marks, shrunk towards
    zero.

    Examples
    --------
    Splices that strain 22 % of the free strain, read without error:

    >>> free = np.array([0.0, 0.8, 1.0, 1.2, 1.5, 1.8, 2.1])
    >>> found = fit_splice_laws(SpliceReadings(
    ...     free, 0.22 * free, np.array([0, 210.0, 240, 300, 380, 470, 600]), np.zeros(7, int),
    ...     free == 0, 0.47, 1e-3, np.zeros((2, 2))))
    >>> print(found.laws[0].name, found.values.round(3)[1])
    strain-ratio 0.22
    """
    kept, left = readings, np.arange(readings.free.size)
    n_loaded = int((~readings.is_slack).sum())
    found = _judged(kept)
    while (
        readings.free.size - left.size < n_loaded // _ENOUGH
        and found.laws
        and found.laws[0].chance < _DOUBT
        and (row := _outlier(kept, found)) is not None
    ):
        kept, left = kept.without(row), np.delete(left, row)
        found = _judged(kept)
    set_aside = tuple(np.setdiff1d(np.arange(readings.free.size), left).tolist())
    laws, slip = found.laws, found.slip
    if not laws:
        raise DataError(
            f"the splices of '{specimen}' have no law",
            found="no stretched mark at a hold that was approached by loading",
            needed="at least one; marks read on unloading give only the friction of the splices",
        )
    passing = np.array([law.chance >= REJECTED for law in laws])
    if not passing.any():
        raise _refusal(readings, found, specimen, names)
    n_loaded = int((~kept.is_slack).sum())
    has_spare = np.array([law.freedom > 0 for law in laws])
    is_sure = np.array([law.chance >= _DOUBT for law in laws])
    is_checked = not kept.is_one_stretch and bool(
        (has_spare & is_sure).any() or not (passing & ~has_spare).any()
    )
    # if not, the sides are distinguished only by how well their curvature fits the marks
    is_told = _is_told_apart(kept, laws)
    if not is_told or not (passing & has_spare).any():
        passing = _with_nearest(laws, passing)
    is_known = is_checked and all(
        n_loaded >= law.n_terms + 2 for law, passes in zip(laws, passing, strict=True) if passes
    )
    criterion = np.array([law.criterion for law in laws])
    if is_known:
        weight = np.exp(-(criterion - criterion[passing].min()) / 2)
    else:  # laws of one side are alike: together they weigh as much as those of another side
        side = np.array([2, 1]) @ _sides(laws)
        weight = 1.0 / np.array([np.count_nonzero(passing & (side == one)) or 1 for one in side])
    weight = np.where(passing, weight, 0.0) / weight[passing].sum()
    weight = _with_both_sides(laws, weight, is_sure if is_told else passing)
    values = np.array([law.values for law in laws])
    mean = weight @ values
    away = values - mean
    spread = np.array([law.spread for law in laws])
    top = 1.2 * float(np.nan_to_num(kept.tension).max(initial=0.0)) / kept.reference
    mean[_OF_TENSION], worth, beyond = _mean_by_tension(values, weight, top)
    away[:, _OF_TENSION] = beyond
    spread = np.einsum("kia,kab,kjb->kij", worth, spread, worth)
    offset, variance = _offsets(kept, laws[int(np.argmax(weight))], slip)
    return SpliceAverage(
        values=mean,
        covariance=np.einsum("k,kij->ij", weight, spread),
        between=np.einsum("k,ki,kj->ij", weight, away, away),
        reference=kept.reference,
        laws=tuple(laws),
        weight=weight,
        slip=slip,
        test_offset=offset,
        test_variance=variance,
        set_aside=set_aside,
        is_checked=is_checked,
    )


def _mean_by_tension(values: Floats, weight: Floats, top: float) -> tuple[Floats, Floats, Floats]:
    """Mean strain by tension, effect of the errors of each law on it, and its distance.

    Shapes (4,), (n_laws, 10, 10) and (n_laws, 4).  Powers of like exponents combine to one of
    their mean, weighted by their strains: the error of an exponent counts in proportion to the
    strain of its own law by tension, and that of the mean to the mean strain.  Laws that saturate
    do not combine to a law of their kind: the mean is then the law nearest to all of them up to
    the top tension, and errors and distances are those of the strain.
    """
    own = values[:, _OF_TENSION]
    mean = weight @ own
    worth = np.repeat(np.eye(values.shape[1])[None], weight.size, axis=0)
    mean[1] = (weight * own[:, 0]) @ own[:, 1] / mean[0] if mean[0] > 0 else 1.0
    if not mean[2] > 0:
        mean[3] = 0.0
        if mean[0] > 0:
            worth[:, _EXPONENT, _EXPONENT] = own[:, 0] / mean[0]
        return mean, worth, (own - mean) * worth[:, _OF_TENSION, _OF_TENSION]
    relative = np.linspace(0.0, top, _TENSIONS + 1)[1:]
    strains = np.array([_strain_by_tension(one, relative)[0] for one in own])
    wanted = weight @ strains
    used = weight > 0
    low = np.array([0.0, _EXPONENTS[0], 0.0, _SATURATIONS[0]])
    high = np.array([np.inf, _EXPONENTS[-1], np.inf, _SATURATIONS[-1]])
    mean[3] = (weight * own[:, 2]) @ own[:, 3] / mean[2]

    def missed(law: Floats) -> Floats:
        return np.asarray(_strain_by_tension(law, relative)[0] - wanted)

    def slope(law: Floats) -> Floats:
        return _strain_by_tension(law, relative)[1].T

    starts = (mean, *own[used & (own[:, 2] > 0)])
    found = [
        scipy.optimize.least_squares(
            missed, np.clip(one, low, high), slope, (low, high), xtol=1e-12, ftol=1e-12, gtol=1e-14
        )
        for one in starts
    ]
    mean = min(found, key=lambda one: float(one.cost)).x
    strain, change = _strain_by_tension(mean, relative)
    back = np.linalg.pinv(change.T, rcond=_RANK)
    for law in np.flatnonzero(used):
        worth[law][np.ix_(_OF_TENSION, _OF_TENSION)] = (
            back @ _strain_by_tension(own[law], relative)[1].T
        )
    beyond = np.where(used[:, None], (strains - strain) @ back.T, 0.0)
    return mean, worth, beyond


def _strain_by_tension(law: Floats, relative: Floats) -> tuple[Floats, Floats]:
    """Strain by a relative tension, and its derivatives by the four numbers of a law."""
    size, exponent, limited, saturation = law
    power = relative**exponent
    share, _ = _saturated(relative, saturation)
    whole = -np.expm1(-saturation)
    of_bend = (
        (relative * np.exp(-saturation * relative) - share * np.exp(-saturation)) / whole
        if saturation > 0
        else relative * (1 - relative) / 2
    )
    strain = size * power + limited * share
    return strain, np.stack([power, size * power * np.log(relative), share, limited * of_bend])


def _sides(laws: Sequence[FittedLaw]) -> Bools:
    """Mark laws of tension alone, and laws of strain alone, shape (2, n_laws)."""
    terms = [frozenset(LAWS[law.name]) - {"offset"} for law in laws]
    return np.array(
        [[only <= OF_TENSION for only in terms], [not only & OF_TENSION for only in terms]]
    )


def _is_told_apart(readings: SpliceReadings, laws: Sequence[FittedLaw]) -> bool:
    """Whether tensions at one strain differ enough to show splices that are driven by tension."""
    loaded = ~readings.is_slack
    driven = [law for law in laws if _sides([law])[0].any()]
    if not driven:
        return True
    tension = readings.tension[loaded]
    # tension as a curve over strain, as for marks of one pull
    powers = np.vander(readings.free[loaded], min(_CURVE, tension.size))
    curve = powers @ np.linalg.lstsq(powers, np.log(tension), rcond=None)[0]
    steepness = driven[0].by_tension(tension / readings.reference)[1]
    shown = steepness * (np.log(tension) - curve) / (np.sqrt(3) * readings.tape)
    return float(scipy.special.chdtrc(1, shown @ shown)) < REJECTED


def _with_nearest(laws: Sequence[FittedLaw], passing: Bools) -> Bools:
    """Laws that pass, and the nearest of a side without one; of all, if a side has no law.

    Those that pass without it follow any marks, so that their misfit would not show a misread one.
    """
    misfit = np.array([law.chi_square / law.freedom if law.freedom > 0 else np.inf for law in laws])
    kept = passing.copy()
    for side in _sides(laws):
        if (side & passing).any():
            continue
        among = side if (side & np.isfinite(misfit)).any() else np.ones(side.size, dtype=bool)
        nearest = np.where(among, misfit, np.inf)
        if np.isfinite(nearest).any():
            kept[int(np.argmin(nearest))] = True
    return kept


def _with_both_sides(laws: Sequence[FittedLaw], weight: Floats, counts: Bools) -> Floats:
    """Weights with at least the share for each side, tension and strain, that an interval needs."""
    sides = _sides(laws)
    fits = counts & (weight > 0)
    if not (sides & fits).any(axis=1).all():
        return weight
    least = np.where(sides, np.where(fits, weight, 0.0), 0.0)
    raised = least * (np.maximum(_LEAST / least.sum(axis=1, keepdims=True), 1.0))
    fixed = (raised > least).any(axis=0)
    kept = np.where(fixed, raised.max(axis=0), weight)
    free = kept[~fixed].sum()
    kept[~fixed] *= (1 - kept[fixed].sum()) / (free if free > 0 else 1.0)
    return np.asarray(kept)


@dataclass(frozen=True)
class _Judged:
    """Laws, best first, and the slip of the splices between tests."""

    laws: list[FittedLaw]
    slip: float


def _judged(readings: SpliceReadings) -> _Judged:
    """Fit every law, with slip between tests if the marks require it."""
    laws = _fitted(readings, 0.0)
    if not laws or np.unique(readings.test).size < 2 or laws[0].chance >= _DOUBT:
        return _Judged(laws, 0.0)
    best = laws[0]
    shapes = {law.name: _shape(law) for law in laws}

    def shape_of(name: str) -> float:
        own = shapes.get(name, 1.0)
        return own if name in SATURATING else float(best.values[_EXPONENT])

    tried = [
        (found.criterion, float(slip))
        for slip in readings.tape * _SLIPS
        for name in LAWS
        if (found := _fit(readings, name, shape_of(name), float(slip))) is not None
    ]
    criterion, slip = min(tried)
    # the slip is one more fitted parameter
    if criterion + 2 >= best.criterion:
        return _Judged(laws, 0.0)
    return _Judged(_fitted(readings, slip), slip)


def _fitted(readings: SpliceReadings, slip: float) -> list[FittedLaw]:
    found = [_law(readings, name, slip) for name in LAWS]
    return sorted((law for law in found if law is not None), key=lambda law: law.criterion)


def _law(readings: SpliceReadings, name: str, slip: float) -> FittedLaw | None:
    """Fit one law, with an exponent or a saturation if the marks determine one."""
    is_limited = name in SATURATING
    at_one = _fit(readings, SATURATING.get(name, name), 1.0, slip)
    if not is_limited and (at_one is None or not set(LAWS[name]) & OF_TENSION):
        return at_one
    # without curvature it is another of the laws
    without = None if is_limited else at_one
    loaded = readings.tension[~readings.is_slack]
    # the law of tension alone may use two marks and leave none to spare: no misfit judges it
    spare = 1 if LAWS[name] == ("tension",) else 3 + (is_limited and len(LAWS[name]) > 1)
    if loaded.size < len(LAWS[name]) + spare or loaded.max() < _SPAN * loaded.min():
        return without if without is None else _with_any_exponent(readings, without)
    grid = _SATURATIONS if is_limited else _EXPONENTS

    def criterion(shape: float) -> float:
        found = _fit(readings, name, shape, slip)
        return _NOWHERE if found is None else min(found.criterion, _NOWHERE)

    # a sharp minimum may lie between the points of any grid, so it is refined by a search
    place = int(np.argmin([criterion(float(one)) for one in grid]))
    ends = grid[max(place - 1, 0)], grid[min(place + 1, grid.size - 1)]
    search = scipy.optimize.minimize_scalar(
        criterion, bounds=ends, method="bounded", options={"xatol": 1e-5}
    )
    shape, best = float(search.x), float(search.fun)
    # one parameter more than the straight line; saturation below the lowest mark is an offset
    is_offset = is_limited and shape > grid[-1] - _STEP
    if is_offset or best + 2 >= (_NOWHERE if at_one is None else at_one.criterion):
        return without
    below, law, above = (_fit(readings, name, shape + way, slip) for way in (-_STEP, 0.0, _STEP))
    if below is None or law is None or above is None:
        return without
    bend = (below.criterion - 2 * best + above.criterion) / _STEP**2
    slope = (above.values - below.values) / (2 * _STEP)
    slope[_SATURATION if is_limited else _EXPONENT] = 1.0
    room = min(shape - grid[0], grid[-1] - shape)
    if bend * room**2 > 2:  # one standard deviation is within the range
        variance = 2 / bend
    else:
        fine = _FINE_SATURATIONS if is_limited else _FINE_EXPONENTS
        misfit = np.array([criterion(float(one)) for one in fine])
        likelihood = np.exp((misfit.min() - misfit) / 2)
        away = fine - shape
        variance = float(likelihood @ away**2 / likelihood.sum())
    return replace(
        law,
        covariance=law.covariance + variance * np.outer(slope, slope),
        criterion=law.criterion + 2.0,
        freedom=law.freedom - 1,
    )


def _with_any_exponent(readings: SpliceReadings, law: FittedLaw) -> FittedLaw:
    """A law whose exponent may be any, if all marks are at one stretch and so say nothing of it."""
    if not readings.is_one_stretch:
        return law
    covariance = law.covariance.copy()
    covariance[_EXPONENT, _EXPONENT] = np.ptp(_EXPONENTS) ** 2 / 12
    return replace(law, covariance=covariance)


def _shape(law: FittedLaw) -> float:
    """Exponent of a law, or its saturation."""
    return float(law.values[_SATURATION if law.name in SATURATING else _EXPONENT])


def _saturated(relative: Floats, saturation: float) -> tuple[Floats, Floats]:
    """1 - exp(-b F) over its value at the reference tension, and its derivative by ln F."""
    if saturation == 0.0:
        return relative, relative
    at_reference = -np.expm1(-saturation)
    limited = -np.expm1(-saturation * relative) / at_reference
    return limited, saturation * relative * np.exp(-saturation * relative) / at_reference


def _terms(readings: SpliceReadings, exponent: float, saturation: float) -> dict[str, Floats]:
    free = readings.free
    load = np.maximum(np.nan_to_num(readings.tension), 0.0) / readings.reference
    return {
        "offset": (~readings.is_slack).astype(np.float64),
        "strain": np.where(readings.is_slack, 0.0, free),
        "square": np.where(readings.is_slack, 0.0, free**2),
        "cube": np.where(readings.is_slack, 0.0, free**3),
        "tension": np.where(readings.is_slack, 0.0, load**exponent),
        "saturating": np.where(readings.is_slack, 0.0, _saturated(load, saturation)[0]),
    }


def _fit(readings: SpliceReadings, name: str, shape: float, slip: float) -> FittedLaw | None:
    """Fit one law by generalised least squares; None where the marks do not support it."""
    places = [TERMS[term] for term in LAWS[name]]
    rows = np.arange(readings.free.size)
    is_driven = bool(set(LAWS[name]) & OF_TENSION)
    exponent, saturation = (1.0, shape) if name in SATURATING else (shape, 0.0)
    if is_driven:
        is_known = readings.is_slack | (np.nan_to_num(readings.tension) > 0)
        if not is_known.all():
            return None
    loaded = ~readings.is_slack
    if "cube" in LAWS[name] and loaded.sum() < len(LAWS[name]) + _SPARE:
        return None
    columns = _terms(readings, exponent, saturation)
    load = np.maximum(np.nan_to_num(readings.tension), 0.0) / readings.reference
    steepness = np.where(readings.is_slack, 0.0, _saturated(load, saturation)[1])
    design = np.stack([columns[term] for term in LAWS[name]], axis=1)
    # columns are scaled by their size: tension and strain differ in magnitude
    size = np.sqrt((design**2).sum(axis=0))
    if (size == 0).any():
        return None
    # what is known of the settlement stands for a reading: marks at one stretch leave it open
    from_marks = (design[loaded] / size)[:, int("offset" in LAWS[name]) :]
    if np.linalg.matrix_rank(from_marks, tol=1e-3) < from_marks.shape[1]:
        return None
    known = np.zeros((len(places) + 2,) * 2)
    if "offset" in LAWS[name]:
        # the first column: settlement of splices is small, whatever the readings allow
        usual = _BEDDING if is_driven else _INTERCEPT
        known[0, 0] = (usual * size[0]) ** -2
    # lengths that count as exact are not changed
    known[-2:, -2:] = np.linalg.inv(readings.relaxed + _EXACT * np.eye(2))
    slope, per_tension = np.zeros(rows.size), np.zeros(rows.size)
    for _ in range(_PASSES):
        covariance = _of_rows(readings, slope, slip, per_tension)
        # the relaxed lengths are fitted again, with the slack rows as prior information
        whole = np.concatenate([design / size, -_common(readings, slope)], axis=1)
        weighed = np.linalg.solve(covariance, whole)
        normal = np.linalg.inv(whole.T @ weighed + known)
        solved = normal @ weighed.T @ readings.splice
        values = np.zeros(_N_VALUES)
        values[[_EXPONENT, _SATURATION]] = exponent, saturation
        values[places] = solved[:-2] / size
        slope = np.where(loaded, _per_strain(readings.free) @ values[1:4], 0.0)
        per_tension = exponent * values[TERMS["tension"]] * columns["tension"]
        per_tension = per_tension + values[TERMS["saturating"]] * steepness
    # refuse splices that shorten under load, or stretch more than the free length that they hold
    if (
        values[list(map(TERMS.__getitem__, OF_TENSION))].min() < 0
        or (1 + readings.share * slope).min() <= 0.05
    ):
        return None
    lengths = solved[-2:]
    residual = readings.splice - whole @ solved
    judged = np.ones(rows.size, dtype=bool) if slip > 0 else loaded
    misfit = residual[judged]
    chi_square = float(misfit @ np.linalg.solve(covariance[np.ix_(judged, judged)], misfit))
    chi_square += float(solved @ known @ solved)
    scale = np.concatenate([1 / size, np.ones(2)])
    values[-2:] = lengths
    at = np.array([*places, _N_VALUES - 2, _N_VALUES - 1])
    own = np.zeros((_N_VALUES, _N_VALUES))
    own[np.ix_(at, at)] = normal * np.outer(scale, scale)
    falling = _per_strain(readings.free[loaded])
    spare = _MOST_FALL * np.sqrt(np.einsum("ri,ij,rj->r", falling, own[1:4, 1:4], falling))
    if (falling @ values[1:4] < -spare).any():
        return None
    spread = np.linalg.slogdet(covariance[np.ix_(judged, judged)] / readings.tape**2)[1]
    if slip > 0:
        slack = np.diag(_of_rows(readings, slope, 0.0))[~loaded] / readings.tape**2
        spread -= float(np.log(slack).sum())
    count, worth = int(judged.sum()), readings.tape_freedom
    # with an uncertain error of the tape, a larger misfit is less significant
    misfit_term = chi_square if np.isinf(worth) else (worth + count) * np.log1p(chi_square / worth)
    return FittedLaw(
        name=name,
        values=values,
        covariance=own,
        chi_square=chi_square,
        freedom=count - len(places),
        criterion=misfit_term + 2.0 * len(places) + spread,
        residual=residual,
    )


def _per_strain(free: Floats) -> Floats:
    """Derivatives of the terms by the strain of the free length; shape (n_rows, 3)."""
    return np.stack([np.ones_like(free), 2 * free, 3 * free**2], axis=-1)


def _of_rows(
    readings: SpliceReadings, slope: Floats, slip: float, per_tension: Floats | None = None
) -> Floats:
    """Covariance of the rows: three readings of the tape, the tension, and the slip of a test."""
    # both toes are in the free length and, with opposite sign, in the splices
    own = readings.tape**2 * (2 * (1 + readings.share * slope) ** 2 + 1)
    if per_tension is not None and readings.tension_uncertainty.size:
        own = own + (per_tension * readings.tension_uncertainty) ** 2
    together = readings.test[:, None] == readings.test[None, :]
    return np.asarray(np.diag(own) + slip**2 * together)


def _common(readings: SpliceReadings, slope: Floats) -> Floats:
    """Derivative of the residuals by the relative errors of relaxed free and splice length."""
    loaded = ~readings.is_slack
    return np.stack(
        [
            np.where(loaded, slope * (1 + readings.free), 0.0),
            np.where(loaded, -(1 + readings.splice), 0.0),
        ],
        axis=1,
    )


def _offsets(readings: SpliceReadings, law: FittedLaw, slip: float) -> tuple[Floats, Floats]:
    """Offset of each test by its own marks, shrunk towards zero, and its variance."""
    n_tests = int(readings.test.max(initial=-1)) + 1
    if slip == 0.0:
        return np.zeros(n_tests), np.zeros(n_tests)
    own = np.diag(_of_rows(readings, np.zeros(readings.free.size), 0.0))
    offset, variance = np.zeros(n_tests), np.full(n_tests, slip**2)
    for one in range(n_tests):
        at = readings.test == one
        known = float(np.sum(1 / own[at]))
        variance[one] = 1 / (1 / slip**2 + known)
        offset[one] = variance[one] * float(np.sum(law.residual[at] / own[at]))
    return offset, variance


def _may_agree(readings: SpliceReadings, judged: _Judged) -> dict[str, Bools]:
    """Masks of the loaded rows without which a law may agree with the other rows.

    Free coefficients of its terms, with both of two neighbouring shapes, fit the rows at least
    as well as the law.  What such a fit gains without one row is known in closed form.
    """
    loaded = ~readings.is_slack
    load = np.maximum(np.nan_to_num(readings.tension), 0.0) / readings.reference
    slopes = [_per_strain(readings.free) @ law.values[1:4] for law in judged.laws]
    slope = np.where(loaded, _ROOMY * np.max(np.maximum(slopes, 0.0), axis=0), 0.0)
    per_tension = [np.abs(law.by_tension(load)[1]) for law in judged.laws]
    rows = np.flatnonzero(loaded | (judged.slip > 0))
    lengths = _common(readings, slope)
    covariance = _of_rows(readings, slope, judged.slip, _ROOMY * np.max(per_tension, axis=0))
    covariance = (covariance + lengths @ readings.relaxed @ lengths.T)[np.ix_(rows, rows)]
    root = np.linalg.cholesky(covariance)
    whitening = np.linalg.inv(root)
    splice = whitening @ readings.splice[rows]

    def least(columns: list[Floats]) -> Floats:
        """Misfit without each of the rows."""
        design = np.stack(columns, axis=1)[rows]
        basis, size, _ = np.linalg.svd(
            whitening @ (design / (np.abs(design).max(axis=0) + _EXACT)), full_matrices=False
        )
        basis = basis[:, size > _ALIKE_TERMS * size[0]]
        residual = splice - basis @ (basis.T @ splice)
        back = whitening - basis @ (basis.T @ whitening)
        each = np.einsum("ij,ij->j", back, back)
        with np.errstate(divide="ignore", invalid="ignore"):
            gain = np.where(each > 0, (residual @ back) ** 2 / each, np.inf)
        return np.maximum(float(residual @ residual) - gain, 0.0)

    powers = [_terms(readings, one, 0.0) for one in _EXPONENTS]
    limits = [_terms(readings, 1.0, one) for one in _SATURATIONS]
    may = {}
    for name, terms in LAWS.items():
        shapes, of_shape = (limits, "saturating") if name in SATURATING else (powers, "tension")
        fixed = [shapes[0][term] if term not in OF_TENSION else limits[0]["tension"]
                 for term in terms if term != of_shape]  # fmt: skip
        # a shape between two of the grid is a sum of both
        left = least(fixed) if of_shape not in terms else np.min([
            least([*fixed, below[of_shape], above[of_shape]]) for below, above in pairwise(shapes)
        ], axis=0)  # fmt: skip
        may[name] = np.zeros(loaded.size, dtype=bool)
        may[name][rows] = scipy.special.chdtrc(rows.size, left) >= REJECTED
        may[name] &= loaded
    return may


# times the slopes of the laws fitted to all rows: an error of a row that is too large is safe
_ROOMY = 2.0

_ALIKE_TERMS = 1e-9  # of the greatest of the orthogonal terms: smaller ones are rounding


def _outlier(readings: SpliceReadings, judged: _Judged) -> int | None:
    """Return the stretched row that is far from every law fitted without it."""
    far, slip = np.zeros(readings.free.size), judged.slip
    ranked = [law.name for law in judged.laws]
    ranked += [name for name in LAWS if name not in ranked]
    may = _may_agree(readings, judged)
    for row in np.flatnonzero(np.any(list(may.values()), axis=0)):
        # a law is used for this row if the other marks agree with it
        kept = readings.without(int(row))
        errors: list[float] = []
        for name in ranked:
            law = _law(kept, name, slip) if may[name][row] else None
            if law is None or law.chance < REJECTED:
                continue
            columns = _terms(readings, float(law.values[_EXPONENT]), float(law.values[_SATURATION]))
            design, at = np.array([columns[term][row] for term in TERMS]), list(TERMS.values())
            slope = float(_per_strain(readings.free[row]) @ law.values[1:4])
            own = readings.tape**2 * (2 * (1 + readings.share * slope) ** 2 + 1) + slip**2
            if readings.tension_uncertainty.size:
                of_tension = law.by_tension(readings.tension[[row]] / readings.reference)[1][0]
                own += (of_tension * readings.tension_uncertainty[row]) ** 2
            of_law = float(design @ law.covariance[np.ix_(at, at)] @ design)
            away = readings.splice[row] - design @ law.values[at]
            errors.append(abs(away) / np.sqrt(own + of_law))
            if errors[-1] <= _FAR:
                break
        far[row] = min(errors, default=0.0)
    worst = int(np.argmax(far))
    if far[worst] <= _FAR:
        return None
    # without it the marks have to agree with a law, otherwise that mark may not be the wrong one;
    # outside the range of the others the law may be wrong instead, so they have to agree well, and
    # a law that saturates is no evidence there
    kept = readings.without(worst)
    known = kept.tension[~kept.is_slack]
    is_inside = known.min() <= readings.tension[worst] <= known.max()
    agrees = any(
        law.chance >= (REJECTED if is_inside else _DOUBT)
        and (is_inside or law.name not in SATURATING)
        for law in _judged(kept).laws
    )
    return worst if agrees else None


# of misfit and terms by which a row may be the wrong one as well as the likeliest
_AS_LIKELY = 4.0

_MOST_NAMED = 3

# of more marks, one in six is set aside before: several are wrong
_MOST_TRIED = 12


def _misread(readings: SpliceReadings, judged: _Judged) -> list[int]:
    """Loaded rows without which a law with a mark to spare agrees with the others; likeliest first.

    The row with the greatest residual need not be wrong: a law bends towards the first and the last
    mark, and away from those beside them.
    """
    if np.count_nonzero(~readings.is_slack) > _MOST_TRIED:
        return []
    may = np.any(list(_may_agree(readings, judged).values()), axis=0)
    loaded = np.flatnonzero(may).tolist()
    if not loaded:
        return []
    misfit = np.array([
        min(
            (
                law.chi_square + 2 * law.n_terms
                for law in _fitted(readings.without(row), judged.slip)
                if law.freedom > 0 and law.chance >= REJECTED
            ),
            default=np.inf,
        )
        for row in loaded
    ])  # fmt: skip
    least = misfit.min()
    if np.isinf(least):
        return []
    return [loaded[at] for at in np.argsort(misfit) if misfit[at] <= least + _AS_LIKELY]


# as different are the tensions of two tests of one specimen where a unit or a gain is wrong
_OTHER_LOAD = 1.7

_ALIKE = 3.0  # times as far from the other tests as those are from one another, in logarithms


def _over_others(free: Floats, force: Floats, own: Bools, others: Bools) -> float:
    """Mean of a force over that of other rows at the same strain; all in logarithms."""
    inside = own & (free >= free[others].min()) & (free <= free[others].max())
    if np.count_nonzero(inside) < 2 or np.unique(free[others]).size < 3:  # one may be misread
        return float("nan")
    curve = np.polyfit(free[others], force[others], 2)
    return float(np.median(force[inside] - np.polyval(curve, free[inside])))


def _other_load(readings: SpliceReadings) -> tuple[int, float] | None:
    """First row of the test whose tensions are those of the others times a factor, and the factor.

    The free length has about one curve of tension in all tests, whatever its splices do.
    """
    loaded = np.flatnonzero((np.nan_to_num(readings.tension) > 0) & (readings.free > 0))
    free, force = np.log(readings.free[loaded]), np.log(readings.tension[loaded])
    of_test, found = readings.test[loaded], []
    for test in np.unique(of_test):
        others = of_test != test
        left = np.unique(of_test[others])
        if left.size < 2:  # of two tests nothing tells which is wrong
            continue
        away = _over_others(free, force, ~others, others)
        among = [
            _over_others(free, force, of_test == one, others & (of_test != one)) for one in left
        ]
        if abs(away) > max(np.log(_OTHER_LOAD), _ALIKE * np.nanmax(np.abs([*among, 0.0]))):
            found.append((int(loaded[np.argmin(others)]), float(np.exp(away))))
    return found[0] if len(found) == 1 else None


def _refusal(
    readings: SpliceReadings, judged: _Judged, specimen: str, names: Sequence[str]
) -> DataError:
    laws = judged.laws
    best = max(laws, key=lambda law: law.chance)
    length = 1 / (1 + readings.share * np.maximum(best.values[1], 0.0))
    points = 100 * readings.share * length * np.abs(best.residual)

    def named(row: int) -> str:
        return names[row] if names else f"row {row + 1} of its marks"

    odd = _other_load(readings)
    suspects = [] if odd is not None else _misread(readings, judged)
    if odd is not None:
        like = words_of_ratio(odd[1])
        look = (
            f"{named(odd[0])} and the others of its test: their tensions are {odd[1]:.3g} times"
            f" those of the other tests at the same strain{f' (as {like})' * bool(like)}. Check the"
            " unit, gain and factor of that load"
        )
    elif 0 < len(suspects) <= _MOST_NAMED:
        look = f"{' or '.join(map(named, suspects))}: without it a law agrees with the others"
    else:
        worst = int(np.argmax(points))
        look = f"{named(worst)}, off by {points[worst]:.2f} points"
    return DataError(
        f"no law of the splices of '{specimen}' agrees with its marks",
        found=f"{best.name}, the best of {len(laws)}, misses them by "
        f"{points[~readings.is_slack].mean():.2f} points of strain where the tape explains "
        f"{100 * readings.share * length * readings.tape * np.sqrt(3):.2f}",
        needed="marks that one of the laws passes within the stated error of the tape",
        hint=f"Look at {look}; at holds whose tension is not that of the marks; or state the error "
        "of the tape.",
    )
