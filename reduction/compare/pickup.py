r"""Where a measured curve bends upward: the cords take up load.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.
.. [2] G. A. F. Seber and C. J. Wild, "Nonlinear Regression," Wiley, 1989, ch. 9 (two phases
   with a change point that is not known).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.residuals import autocorrelation_length
from reduction.record import Floats, Integers

_MARGIN = 5  # bins on either side of a bend, for the curve to be known there
_CANDIDATES = 41
_ENDS = (1.0, 0.8, 0.65, 0.5)  # of the strains: a pull to the break bends in other ways as well
_LEAST_RATIO = 5.0  # of the change of slope to its standard uncertainty
_LEAST_SHARE = 0.1  # of the change of slope to the mean slope: less is no cord
_ORDER = 3  # of the curve on either side
_TINY = 1e-9  # N: points without scatter


class PickUp(NamedTuple):
    """Strain at which the judged curve bends, with its standard uncertainty [1].

    NaN where the curve does not show it; ``reason`` says why.
    """

    strain: float
    standard_uncertainty: float
    reason: str


class _Fit(NamedTuple):
    strain: float
    uncertainty: float
    jump: float
    jump_uncertainty: float
    is_inside: bool


class _Fitted(NamedTuple):
    squares: float
    residual: Floats
    jump: float
    variance: float  # of the jump, for noise as it is stated


def measured_pick_up(measured: MeasuredCurve) -> PickUp:
    r"""Find the strain at which a measured curve bends, whatever was predicted.

    .. math:: D(\varepsilon) = \sum_{k=0}^{3} b_k \varepsilon^k
              + \sum_{k=1}^{m} c_k (\varepsilon - \varepsilon_p)_+^k

    Parameters
    ----------
    measured : MeasuredCurve
        The test; its judged curve counts. [SI]

    Returns
    -------
    found : PickUp
        Strain and standard uncertainty, or why there is none. [1]

    Raises
    ------
    Nothing
        A curve without a bend has none.

    Notes
    -----
    Below the bend the rubber alone carries, above it the cords as well [1]_: the curve has no
    jump and its slope has one, :math:`c_1`.  Every place of the bend is tried [2]_, read as the
    samples were, in the part of the curve from its beginning that shows it best.  Its uncertainty
    is the width over which the sum of squares stays within one variance of the residuals, times
    the length over which these err together; and the difference to a curve of the second degree
    above the bend over half as far, since neither is that of the cords.  An error of the
    strain moves the bend as it is.

    It is a bend that is found, not a law of a hose: it answers to a hose that was not built as
    drawn, and is not as fine as a calibrated wrap angle.

    Examples
    --------
    >>> from reduction.compare.measured import measured_curve
    >>> stroke = np.linspace(0, 1, 2001)
    >>> bent = 900 * stroke + 3000 * np.maximum(stroke - 0.4137, 0)
    >>> print(round(measured_pick_up(measured_curve(stroke, bent, loading="static")).strain, 4))
    0.4137
    """
    curve = measured.tension_of(measured.judged)
    place: Integers = np.flatnonzero(np.isfinite(curve))
    if place.size < 4 * _MARGIN:
        return _nothing(f"{place.size} strains of the judged curve are too few to show a bend")
    place = _window(measured, place)
    fit = _bend(measured, place, _ORDER)
    if not (fit.jump > 0 and fit.jump > _LEAST_RATIO * fit.jump_uncertainty):
        return _nothing("the judged curve has no upward bend that stands out of its scatter")
    rise = float(np.ptp(curve[place]) / np.ptp(measured.strain[place]))
    if fit.jump < _LEAST_SHARE * rise:
        return _nothing("the judged curve bends upward by less than a tenth of its slope")
    if not fit.is_inside:
        return _nothing("the judged curve bends too near to its ends")
    strain = measured.strain[place]
    near = place[strain < (fit.strain + strain[-1]) / 2]
    of_model = _bend(measured, near, _ORDER - 1).strain - fit.strain
    return PickUp(
        strain=fit.strain,
        standard_uncertainty=float(
            np.linalg.norm(
                [
                    fit.uncertainty,
                    of_model,
                    *(np.interp(fit.strain, measured.strain, row) for row in measured.strain_error),
                ]
            )
        ),
        reason="",
    )


def _nothing(reason: str) -> PickUp:
    return PickUp(float("nan"), float("nan"), reason)


def _window(measured: MeasuredCurve, place: Integers) -> Integers:
    """Strains from the first one on among which a bend stands out most."""
    best, kept = -np.inf, place
    for end in _ENDS:
        part = place[: int(end * place.size)]
        if part.size < 4 * _MARGIN:
            break
        axis = measured.strain
        tried = axis[part[_MARGIN:-_MARGIN]]
        found = [_fitted(measured, part, at, _ORDER, axis) for at in tried]
        k = int(np.argmin([one.squares for one in found]))
        one = found[k]
        freedom = max(part.size - 2 * _ORDER - 2, 1)
        ratio = one.jump / np.sqrt(one.variance * max(one.squares / freedom, 1e-12))
        if ratio > best and 0 < k < len(found) - 1:
            best, kept = ratio, part
    return kept


def _bend(measured: MeasuredCurve, place: Integers, degree: int) -> _Fit:
    strain, node = measured.strain[place], measured.reading.node
    step = float(measured.strain[1] - measured.strain[0])
    low, high = float(strain[_MARGIN]), float(strain[-1 - _MARGIN])

    def squares_at(tried: Floats, axis: Floats) -> Floats:
        return np.array([_fitted(measured, place, at, degree, axis).squares for at in tried])

    tried = strain[_MARGIN:-_MARGIN]
    at = float(tried[np.argmin(squares_at(tried, measured.strain))])
    width = 2 * step
    for _ in range(2):
        tried = np.linspace(max(low, at - width), min(high, at + width), _CANDIDATES)
        at, width = float(tried[np.argmin(squares_at(tried, node))]), 2 * width / _CANDIDATES
    fit = _fitted(measured, place, at, degree, node)
    freedom = max(place.size - _ORDER - 2 - degree, 1)
    unit = max(fit.squares / freedom, 1e-12) * autocorrelation_length(fit.residual)
    around = np.linspace(max(low, at - 3 * step), min(high, at + 3 * step), _CANDIDATES)
    above = squares_at(around, node) - fit.squares
    inside = around[above <= unit]
    uncertainty = float(np.ptp(inside)) / 2 if inside.size > 1 else 0.0
    if uncertainty < 2 * (around[1] - around[0]):  # narrower than the steps: from its curvature
        near = np.abs(around - at) <= step
        by_square = (around[near] - at) ** 2
        bend = float(by_square @ above[near] / (by_square @ by_square))
        uncertainty = float(np.sqrt(unit / bend)) if bend > 0 else step / np.sqrt(12.0)
    return _Fit(
        strain=at,
        uncertainty=uncertainty,
        jump=fit.jump,
        jump_uncertainty=float(np.sqrt(fit.variance * unit)),
        is_inside=low + step < at < high - step,
    )


def _fitted(
    measured: MeasuredCurve, place: Integers, at: float, degree: int, axis: Floats
) -> _Fitted:
    """Least squares with the bend at one strain, on the nodes of the reading or at the centres."""
    x, past = axis / axis[-1], np.maximum(axis - at, 0.0)  # powers that are not alike
    below = [x**k for k in range(_ORDER + 1)]
    above = [past * (past / axis[-1]) ** k for k in range(degree)]
    curves = np.array([*below, *above])
    is_node = axis.size == measured.reading.node.size
    basis = (measured.reading.of(curves) if is_node else curves)[:, place].T
    noise = measured.independent_uncertainty()[place]
    noise = np.maximum(noise, np.median(noise) / 10 + _TINY)
    tension = measured.tension_of(measured.judged)[place]
    directions, triangle = np.linalg.qr(basis / noise[:, None])
    along = directions.T @ (tension / noise)
    residual = tension / noise - directions @ along
    of_jump = np.linalg.pinv(triangle)[_ORDER + 1]
    return _Fitted(
        squares=float(residual @ residual),
        residual=residual,
        jump=float(of_jump @ along),
        variance=float(of_jump @ of_jump),
    )
