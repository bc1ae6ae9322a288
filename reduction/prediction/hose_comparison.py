"""Comparison of a measured hose with its prediction, and fit of stated parameters to the curve.

**Whether one curve can identify several parameters of a hose.** A formal interval covers noise
only.  A fit of angle, cord scale and dead length to one smooth curve gives three narrow intervals,
yet an error of the model by 1 % of the tension moves all three by more than a workshop would be
off.  What matters is the response of the curve to a plausible error, not the noise.

References
----------
.. [1] R. Brun, P. Reichert and H. R. Kunsch, "Practical identifiability analysis of large
   environmental simulation models," Water Resour. Res., vol. 37, 2001 (collinearity index).
.. [2] JCGM 101:2008, "Propagation of distributions using a Monte Carlo method."
.. [3] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid Dynamics
   and Heat Transfer," sec. 2 (u_num).
.. [4] R. T. Birge, "The calculation of errors by the method of least squares," Phys. Rev., vol. 40,
   1932.
.. [5] G. A. F. Seber and C. J. Wild, "Nonlinear Regression," Wiley, 1989, ch. 2 and 6.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import compress, product
from math import degrees, pi
from typing import Any, Literal, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.prediction.comparison_error import (
    N_DRAWS,
    Comparison,
    EventDifference,
    HoseCalibration,
    Identifiability,
    PickUp,
    PressureComparison,
    autocorrelation_length,
    cycle_differences,
    difference_of,
    energy_difference,
    event_differences,
    measured_pick_up,
    plausibility_of_working_strain,
    validate_curve,
    verdict_words,
)
from reduction.prediction.cord_curve import CordCurve, cord_load
from reduction.prediction.hose_geometry import cord_stretch_ratio
from reduction.prediction.hose_prediction import HosePlan
from reduction.prediction.hose_product import HOSE_PARAMETERS, HoseDesign, HosePrediction
from reduction.prediction.hose_sensitivity import curve_sensitivity, hose_sensitivity
from reduction.prediction.hose_tension import (
    Load,
    find_events,
    hose_load,
    loads_at,
    numbers_of,
    predict_hose,
)
from reduction.prediction.measured_curve import (
    Loading,
    MeasuredCurve,
    SharedErrors,
    error_words,
    measured_curve,
    pressure_errors,
    read_along,
)
from reduction.record.arrays import as_spread
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note

CALIBRATED = (
    "wrap_angle",
    "rubber_modulus",
    "cord_load_scale",
    "cord_strain_scale",
    "dead_length_share",
)
"""Parameters that may be fitted; diameters and the number of cords are measured or counted."""

_ANGLE = np.radians(1.0)

_PART = 0.1

_DEAD_LENGTH = 0.05

_MODEL = 0.01  # share of the tension: a smaller smooth error of a prediction is accepted

_LEAST_SEEN = 1e-6  # share of the tension that counts as no change

_NAMED = 0.1  # share of the largest component of a direction below which a component is not named


def _plausible_error(name: str, start: float) -> float:
    """Plausible error of a hose parameter before it is measured on the hose.

    Examples
    --------
    >>> print(_plausible_error("cord_load_scale", 1.0))
    0.1
    """
    if name not in CALIBRATED:
        raise SettingsError(
            f"'{name}' cannot be calibrated", found=name, needed="one of " + ", ".join(CALIBRATED)
        )
    if name == "wrap_angle":
        return float(_ANGLE)
    if name == "dead_length_share":
        return _DEAD_LENGTH
    if not start > 0:
        raise SettingsError(
            f"{name} has no size to start a calibration from",
            found=f"{start:g}",
            needed="a value above zero",
        )
    return _PART * start


def _identify_directions(
    sensitivity: ArrayLike,
    *,
    tension: ArrayLike,
    names: Sequence[str],
    plausible: ArrayLike,
    value: ArrayLike,
    contribution: ArrayLike,
    misfit: float,
) -> Identifiability:
    r"""Find the directions of the fitted parameters to which the curve hardly responds.

    With :math:`S` the change of tension for one plausible error of each parameter and :math:`C`
    the contributions of shared errors, all over :math:`\sqrt n` and the RMS tension, a unit step
    along :math:`v` cannot be separated from an error of relative size :math:`\delta` where

    .. math:: \min_z \lVert S v + C z \rVert^2 + \delta^2 \lVert z \rVert^2 < \delta^2

    Notes
    -----
    :math:`\delta` is 1 %, or the relative misfit where that is greater: an error of the model
    is smooth, so more strains do not average it out, and a prediction that was off by 3 %
    somewhere cannot be trusted to 1 % elsewhere.  Along a direction whose unit step changes the
    curve by less, such an error moves the parameters by :math:`\delta` over that change: more
    than one plausible error, which the noise does not reveal.  The unit of each parameter is its
    plausible error, so this finds a parameter to which the curve does not respond (the scale of
    cords that carry little yet) as well as two that compensate each other.  The collinearity
    index of [1]_, which detects only the second case, is also given; values above 10 to 15 are
    called poor there.

    Examples
    --------
    Two parameters with the same effect cannot be separated, whatever the noise.

    >>> found = _identify_directions(
    ...     [[1.0, 1.0], [2.0, 2.0]], tension=[10.0, 20.0],
    ...     names=["cord_load_scale", "cord_strain_scale"], plausible=[0.1, 0.1],
    ...     value=[1.0, 1.0], contribution=np.zeros((0, 2)), misfit=0.0,
    ... )
    >>> print(found.is_identified, found.words)
    False cord_load_scale +7.1 % with cord_strain_scale -7.1 % changes the curve by only 0.00 %
    """
    slopes = np.asarray(sensitivity, dtype=np.float64)
    level = np.asarray(tension, dtype=np.float64)
    unit = np.asarray(plausible, dtype=np.float64)
    shared = np.asarray(contribution, dtype=np.float64)
    size = float(np.sqrt(np.mean(level**2)))
    scale = np.sqrt(level.size) * size
    s, c = slopes * unit / scale, shared.T / scale
    needed = max(_MODEL, misfit / size)
    seen = s.T @ s
    if c.shape[1]:
        imitated = c.T @ c + needed**2 * np.eye(c.shape[1])
        seen = seen - s.T @ c @ np.linalg.solve(imitated, c.T @ s)
    strength, axes = np.linalg.eigh(seen)
    change = np.sqrt(np.maximum(strength, 0.0))
    axes = axes * np.where(np.take_along_axis(axes, _largest(axes), 0) < 0, -1.0, 1.0)
    least = axes[:, 0] * unit
    words = [
        _words(names, axes[:, k], unit, np.asarray(value, dtype=np.float64), float(change[k]))
        for k in range(len(names))
        if change[k] < needed
    ]
    unseen = change < needed
    reach = needed / np.maximum(change[unseen], _LEAST_SEEN) * axes[:, unseen] * unit[:, None]
    return Identifiability(
        least_change=float(change[0]),
        needed_change=needed,
        direction=least,
        collinearity=_collinearity(s),
        is_identified=not words,
        words="; ".join(words),
        open_covariance=reach @ reach.T,
    )


def _largest(axes: Floats) -> np.ndarray:
    """Row of the first entry in each column that is the largest up to rounding."""
    size = np.abs(axes)
    return np.asarray(np.argmax(size > 0.999 * size.max(axis=0), axis=0))[None, :]


def _collinearity(s: Floats) -> float:
    length = np.linalg.norm(s, axis=0)
    if not np.all(length > 0):
        return float("inf")
    least = float(np.linalg.svd(s / length, compute_uv=False)[-1])
    return 1 / least if least > 0 else float("inf")


def _words(
    names: Sequence[str], direction: Floats, unit: Floats, value: Floats, change: float
) -> str:
    size = np.abs(direction)
    parts = [
        _step(names[k], float(direction[k] * unit[k]), float(value[k]))
        for k in range(len(names))
        if size[k] >= _NAMED * size.max()
    ]
    return f"{' with '.join(parts)} changes the curve by only {100 * change:.2f} %"


def _step(name: str, step: float, value: float) -> str:
    if name == "wrap_angle":
        return f"{name} {degrees(step):+.2f} deg"
    if name == "dead_length_share":
        return f"{name} {100 * step:+.1f} points"
    return f"{name} {100 * step / value:+.1f} %"


_LOWEST = {"dead_length_share": 0.0, "rubber_modulus": 0.0}

_SMALLEST = 1e-6  # least value of a parameter that has to be positive


def _number_of(design: HoseDesign, name: str) -> float:
    """A parameter of one design by its name.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(round(_number_of(design, "layer_diameter"), 6))
    0.085
    """
    if name not in HOSE_PARAMETERS:
        raise SettingsError(
            "no such number of a hose", found=name, needed="one of " + ", ".join(HOSE_PARAMETERS)
        )
    return float(design.wrap_diameter if name == "layer_diameter" else getattr(design, name))


def _design_with(design: HoseDesign, numbers: Mapping[str, Any]) -> HoseDesign:
    """The design with some of its parameters replaced.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(_design_with(design, {"wrap_angle": 1.2}).wrap_angle)
    1.2
    """
    changes: dict[str, Any] = {}
    for name, value in numbers.items():
        if name == "layer_diameter":
            inner, outer = design.layer_diameter
            wider = value - _number_of(design, name)
            changes[name] = (inner + wider, outer + wider)
        else:
            changes[name] = value
    return replace(design, **changes)


def _trial_load(
    design: HoseDesign,
    names: Sequence[str],
    values: Floats,
    strain: Floats,
    load: Load = "tension",
    beside: Callable[[slice, Floats], Floats] | None = None,
) -> Floats:
    """Tension or fill pressure at trial values of some parameters.

    Notes
    -----
    A trial hose whose cords would break below a measured strain has no tension there, and a fit
    would be caught in the gap.  Its curve is therefore continued along its tangent at the break,
    without a step at any parameter value; its pressure is continued in proportion.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> steps = np.array([0.0, 1.0, 5.0])
    >>> print(np.isfinite(_trial_load(design, ["wrap_angle"], np.array([[1.1]]), steps)).all())
    True
    """
    trials = _design_with(design, {name: values[:, k] for k, name in enumerate(names)})
    found = hose_load(trials, strain, load, beside=beside)
    gap = ~np.isfinite(found)
    if gap.any():
        last = find_events(trials).cord_break
        at_break = getattr(last, load)
        slope = hose_sensitivity(trials, strain[:1]).cord_break.stiffness
        slope = slope * (at_break / last.tension)
        onward = at_break[:, None] + slope[:, None] * (strain - last.strain[:, None])
        found[gap] = onward[gap]
    return found


def _range_of(name: str) -> tuple[float, float]:
    """Allowed range of a hose parameter.

    Examples
    --------
    >>> print(_range_of("dead_length_share"))
    (0.0, 0.99)
    """
    if name == "wrap_angle":
        return _SMALLEST, pi / 2 - _SMALLEST
    return _LOWEST.get(name, _SMALLEST), 0.99 if name == "dead_length_share" else np.inf


_CUT = 3.0

_BETWEEN = 16  # steps from one point of a cord curve to the next

_LEAST_POINTS = 4  # of a cord curve, for a spline to differ from the straight line

_SEED = 20  # arbitrary but fixed, so that answers are repeatable


def _input_draws(
    design: HoseDesign,
    standard_uncertainty: Mapping[str, float],
    strain: Floats,
    *,
    n_draws: int,
    load: Load = "tension",
) -> Floats:
    """Errors of the load of a hose in draws of its uncertain parameters.

    Notes
    -----
    Normal and independent, truncated at three standard uncertainties and at the range of the
    parameter (propagation of distributions, [2]_).  Where cords pick up, tension is not linear in
    the angle over the width of its uncertainty, and a covariance from derivatives does not contain
    the resulting shapes.  Possible errors of the cord curve between its points are drawn as well
    (`_cord_curve_errors`): their effect on the hose depends on the angle.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> error = _input_draws(design, {"rubber_modulus": 1e5}, np.array([0.0, 0.2]), n_draws=500)
    >>> print(error.shape, error[:, 0].max(), bool(abs(error[:, 1].std() / 143 - 1) < 0.1))
    (500, 2) 0.0 True
    """
    known = _known_uncertainties(design, standard_uncertainty)
    if not known:
        return np.zeros((0, strain.size))
    random = np.random.default_rng(_SEED)
    normal = random.standard_normal((n_draws, len(HOSE_PARAMETERS)))
    steps = np.clip(normal, -_CUT, _CUT)
    values = np.stack(
        [
            np.clip(
                _number_of(design, name) + spread * steps[:, HOSE_PARAMETERS.index(name)],
                *_range_of(name),
            )
            for name, spread in known.items()
        ],
        axis=1,
    )
    centre = np.array([[_number_of(design, name) for name in known]])
    cord = _open_cord_of(design.cord)
    size = np.zeros((1 + n_draws, len(cord.apart), design.cord.strain.size + 1))
    size[1:] = random.standard_normal(size[1:].shape)

    def beside(rows: slice, at: Floats) -> Floats:
        return cord.between(at, size[rows])[0]

    found = _trial_load(design, tuple(known), np.vstack([centre, values]), strain, load, beside)
    return np.asarray(found[1:] - found[0])


def _cord_curve_errors(
    design: HoseDesign, strain: Floats, load: Load = "tension"
) -> tuple[Floats, tuple[tuple[str, int], ...]]:
    r"""Possible errors of the load because the cord curve is known only at its points.

    One row for each interval between two points and for each of two other curves through them: a
    cubic spline, and a monotone cubic of ln P over ln e, which continues below the first point as
    a power.  A row is the load with that curve less that with the monotone cubic; zero rows are
    left out.

    Notes
    -----
    This error is not stated by anyone: it belongs to the numerical solution [3]_, sec. 2.  It is a
    few newtons for a curve of fourteen points, far below the noise of any one strain; but it is
    smooth, and bends the curve as a scale of the cord strain does.  A spline fits a law that is
    smooth at rest, but not one with infinite or suddenly changing stiffness there, such as
    :math:`e^{1.15}`; a power does.  Errors in one interval are independent of those in another, so
    each interval has its own.

    Examples
    --------
    Points on a straight line leave no error.

    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.linspace(0.0, 0.2, 5), np.linspace(0.0, 130.0, 5)))
    >>> rows, where = _cord_curve_errors(design, np.array([0.5, 1.0]))
    >>> print(bool(np.all(np.abs(rows) < 1e-6)))
    True
    """
    open_curve = _open_cord_of(design.cord)
    where = tuple(
        product((name for name, _ in open_curve.apart), range(len(design.cord.strain) - 1))
    )
    one = replace(design, cord_load_scale=np.array([_number_of(design, "cord_load_scale")]))
    rows = _load_of_intervals(one, strain, open_curve, where, load)
    is_felt = np.any(rows, axis=1)
    return rows[is_felt], tuple(compress(where, is_felt.tolist()))


class _OpenCord(NamedTuple):
    """Difference of other curves through the points of a cord from its own, at some strains."""

    point: Floats
    strain: Floats
    apart: tuple[tuple[str, Floats], ...]

    def sizes(self, where: Sequence[tuple[str, int]], error: Floats) -> Floats:
        """Errors (n_trial, n_where) in their places, (n_trial, n_curve, n_points + 1).

        The first interval is slack and the last is broken: both are zero.
        """
        names = [name for name, _ in self.apart]
        size = np.zeros((error.shape[0], len(names), self.point.size + 1))
        for (name, place), own in zip(where, error.T, strict=True):
            size[:, names.index(name), place + 1] = own
        return size

    def between(self, at: Floats, size: Floats) -> tuple[Floats, Floats]:
        """Difference of curves of these sizes from the own at strains, and its slope.

        Strains have the shape (n_trial or 1, n_strain).
        """
        # all of them pass through the points, so the intervals join
        apart = np.reshape([one for _, one in self.apart], (-1, self.strain.size))
        interval = np.minimum(np.arange(self.strain.size) // _BETWEEN + 1, self.point.size - 1)
        curve = np.einsum("tcs,cs->ts", size[:, :, interval], apart)
        place = np.searchsorted(self.strain[1:-1], at)
        # zero before the first point and beyond the last
        width = np.diff(self.strain)[place]
        share = (at - self.strain[place]) / width
        inside = np.clip(share, 0.0, 1.0)
        trial = np.arange(len(size))[:, None]
        rise = np.diff(curve, axis=1)[trial, place]
        return curve[trial, place] + inside * rise, np.where(share == inside, rise / width, 0.0)


def _open_cord_of(points: CordCurve) -> _OpenCord:
    if points.strain.size < _LEAST_POINTS:
        return _OpenCord(points.strain, points.strain, ())
    steps = np.arange(_BETWEEN) / _BETWEEN
    dense = points.strain[:-1, None] + np.diff(points.strain)[:, None] * steps
    plain = cord_load(points, dense.ravel()).reshape(dense.shape)
    apart = []
    for name, other in _other_curves(points, dense).items():
        whole = np.hstack([other, points.load[1:, None]])
        rises = np.all(np.diff(whole, axis=1) > 0, axis=1)
        above = np.where(rises[:, None], other - plain, 0.0)
        apart.append((name, np.append(above, 0.0)))
    return _OpenCord(points.strain, np.append(dense, points.strain[-1]), tuple(apart))


def _load_of_intervals(
    hose: HoseDesign,
    strain: Floats,
    cord: _OpenCord,
    where: Sequence[tuple[str, int]],
    load: Load,
) -> Floats:
    """Effect of each other curve on one hose in its interval alone, (n_where, n_strain).

    The load of a hose is proportional to that of its cords, so its difference is that of the cords.
    """
    numbers = numbers_of(hose).column(slice(None))
    stretch = 1 + strain / numbers.free_share
    cord_stretch = cord_stretch_ratio(stretch, np.reshape(hose.wrap_angle, (-1, 1)))
    of_cord = (cord_stretch - 1) / numbers.strain_scale
    # each curve in all its intervals at once, then cut apart: an interval sees its own strains
    names = [name for name, _ in cord.apart]
    size = np.zeros((len(names), len(names), cord.point.size + 1))
    size[np.arange(len(names)), np.arange(len(names)), 1:-1] = 1.0
    above, _ = cord.between(of_cord, size)
    cords = loads_at(numbers, stretch, cord_stretch, numbers.load_scale * above)
    whole = cords.cord_axial_load if load == "tension" else cords.fill_pressure
    interval = np.searchsorted(cord.point[1:-1], of_cord)
    curve, place = np.array(
        [(names.index(name), place) for name, place in where], dtype=np.intp
    ).reshape(-1, 2).T  # fmt: skip
    return np.where(interval == place[:, None], whole[curve], 0.0)


def _other_curves(points: CordCurve, strain: Floats) -> dict[str, Floats]:
    """Loads of other curves through the points of a cord, by name.

    Examples
    --------
    A power law is reproduced, also below the first point.

    >>> at = np.array([0.0, 0.02, 0.06, 0.1, 0.15])
    >>> found = _other_curves(CordCurve(at, 900 * at**1.15), np.array([[0.0, 0.01, 0.04]]))
    >>> print((found["power"] / 900).round(6), np.array([0.01, 0.04]) ** 1.15)
    [[0. 0.005012 0.024681]] [0.00501187 0.02468135]
    """
    spline = scipy.interpolate.CubicSpline(points.strain, points.load)
    at, height = np.log(points.strain[1:]), np.log(points.load[1:])
    power = (height[1] - height[0]) / (at[1] - at[0])
    inside = scipy.interpolate.PchipInterpolator(at, height)
    place = np.log(np.where(strain > 0, strain, points.strain[1]))
    first = place < at[0]
    logarithm = np.where(
        first, height[0] + power * (place - at[0]), inside(np.maximum(place, at[0]))
    )
    return {
        "spline": np.asarray(spline(strain)),
        "power": np.where(strain > 0, np.exp(logarithm), 0.0),
    }


def _known_uncertainties(
    design: HoseDesign, standard_uncertainty: Mapping[str, float]
) -> dict[str, float]:
    """Positive uncertainties, in the order of `HOSE_PARAMETERS`.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(_known_uncertainties(design, {"rubber_modulus": 1e5, "wrap_angle": 0.0}))
    {'rubber_modulus': 100000.0}
    """
    for name, spread in standard_uncertainty.items():
        _number_of(design, name)
        as_spread(name, spread)
    return {
        name: float(standard_uncertainty[name])
        for name in HOSE_PARAMETERS
        if standard_uncertainty.get(name, 0) > 0
    }


_START_STEPS = (-4.0, -2.0, 0.0, 2.0, 4.0)  # plausible errors, tried in all combinations

_DIFFERENCE = 1e-3  # step for derivatives, in plausible errors

_NEAR_BOUND = 1e-4  # share of the width between the bounds

# methods, and the most trials: a search that ends takes ten to thirty
_SEARCHES: tuple[tuple[Literal["dogbox", "trf"], int | None], ...] = (
    ("dogbox", 100),
    ("trf", None),
)

_POLISHING_STEPS = 30

_TOLERANCE = 1e-10  # of a search

_ROUGH = 1e-6  # of a search that is followed by another

_LEAST = 1e-14  # information below this share of the greatest is rounding


def _parameter_bounds(name: str, start: float) -> tuple[float, float]:
    """Bounds of a parameter in the fit.

    Examples
    --------
    >>> print(_parameter_bounds("cord_load_scale", 1.0))
    (0.2, 5.0)
    """
    _plausible_error(name, start)
    if name == "wrap_angle":
        low, high = start - np.radians(10.0), start + np.radians(10.0)
        return max(float(low), float(np.radians(1.0))), min(float(high), float(np.radians(89.0)))
    if name == "dead_length_share":
        return 0.0, 0.5
    return start / 5, start * 5


@dataclass(frozen=True)
@read_only_arrays
class _FitProblem:
    """Measured points and the parameters to be fitted to them.

    The fitted vector has the parameters in plausible errors, then errors in standard
    uncertainties: those of held parameters, of strain, of the cord between its points
    (``between``, curve and interval), and those with a proportional effect.

    Notes
    -----
    An error of strain shifts the whole curve, and its kink with it.  The proportional change,
    minus the slope times the error, leaves the kink in place: a fit would find the error from that
    alone, and attribute the place of the kink to the angle.  So strains are shifted, held
    parameters are changed in the design, and the hose is evaluated at the strains between the bin
    centres, as in the test.
    """

    design: HoseDesign
    names: tuple[str, ...]
    unit: Floats
    low: Floats
    high: Floats
    held: Mapping[str, float]
    moved: Floats
    measured: MeasuredCurve
    noise: Floats
    shared: Floats
    load: Load
    between: tuple[tuple[str, int], ...] = ()

    @cached_property
    def used(self) -> Bools:
        """Whether each strain of the judged curve was measured, shape (n_strain,)."""
        return np.isfinite(self.tension_of_test())

    @cached_property
    def held_at(self) -> dict[str, float]:
        """Design values of parameters that are uncertain but not fitted."""
        return {name: _number_of(self.design, name) for name in self.held}

    @cached_property
    def open_cord(self) -> _OpenCord:
        """Difference of other curves through the points of the cord from its own."""
        return _open_cord_of(self.design.cord)

    @property
    def n_traced(self) -> int:
        """Number of parameters and errors computed with the hose, not in proportion."""
        return len(self.names) + len(self.held) + len(self.moved) + len(self.between)

    @property
    def n_error(self) -> int:
        """Number of errors fitted together with the parameters."""
        return len(self.held) + len(self.moved) + len(self.between) + len(self.shared)

    def tension_of_test(self) -> Floats:
        """Judged curve, shape (n_strain,). [N]."""
        return self.measured.tension_of(self.measured.judged)

    def tension_at(self, traced: Floats) -> Floats:
        """Tension of trials (n_trial, n_traced) as read in the test, (n_trial, n_used). [N]."""
        moved, of_cord = self._errors_of(traced)
        numbers = self._numbers_of(traced)
        node = self.measured.reading.node
        tension = np.empty((traced.shape[0], self.noise.size))
        axes, which = np.unique(moved, axis=0, return_inverse=True)
        for k, axis in enumerate(axes):
            trials = which.ravel() == k
            strain = node - axis @ self.moved
            tension[trials] = self._read(self._curve(numbers[trials], of_cord[trials], strain))
        return tension

    def _curve(self, numbers: Floats, of_cord: Floats, strain: Floats) -> Floats:
        """Tension of trials at strains between the bin centres, (n_trial, n_node). [N]."""
        # a record with low readings has strains just below zero: the curve continues there
        there = np.abs(strain)
        names = (*self.names, *self.held)
        size = self.open_cord.sizes(self.between, of_cord)

        def beside(rows: slice, at: Floats) -> Floats:
            return self.open_cord.between(at, size[rows])[0]

        curve = _trial_load(
            self.design, names, numbers, there, self.load, beside if self.between else None
        )
        return np.asarray(np.sign(strain) * curve)

    def _numbers_of(self, traced: Floats) -> Floats:
        """Fitted and held parameters of trials, (n_trial, n_numbers + n_held)."""
        p = len(self.names)
        return np.hstack([traced[:, :p] * self.unit, np.clip(self._held(traced), *self._ranges)])

    def _held(self, traced: Floats) -> Floats:
        """Held parameters of trials, also beyond their ranges, (n_trial, n_held)."""
        first = len(self.names)
        at, spread = (np.array([*one.values()]) for one in (self.held_at, self.held))
        return np.asarray(at + spread * traced[:, first : first + len(self.held)])

    @cached_property
    def _ranges(self) -> Floats:
        """Allowed ranges of held parameters, (2, n_held)."""
        return np.array([_range_of(name) for name in self.held]).reshape(-1, 2).T

    def _errors_of(self, traced: Floats) -> tuple[Floats, Floats]:
        """Errors of strain and of the cord between its points, of trials."""
        first = len(self.names) + len(self.held)
        of_strain, of_cord = np.split(traced[:, first:], [len(self.moved)], axis=1)
        return of_strain, of_cord

    def _hoses_of(self, numbers: Floats) -> HoseDesign:
        names = (*self.names, *self.held)
        return _design_with(self.design, {name: numbers[:, k] for k, name in enumerate(names)})

    def _read(self, curve: Floats) -> Floats:
        """Curves at the nodes, as read in the test where it measured."""
        return np.asarray(self.measured.reading.of(curve)[:, self.used])

    def slopes(self, traced: Floats) -> Floats:
        """Derivative of tension by each parameter and traced error, (n_used, n_traced)."""
        at = traced[None, :]
        numbers, (moved, of_cord) = self._numbers_of(at), self._errors_of(at)
        strain = self.measured.reading.node - moved[0] @ self.moved
        hose, there, sign = self._hoses_of(numbers), np.abs(strain), np.sign(strain)
        size = self.open_cord.sizes(self.between, of_cord)
        beside = partial(self.open_cord.between, size=size) if self.between else None
        rates = curve_sensitivity(hose, there, beside)[self.load == "fill_pressure"]
        if not np.all(np.isfinite(rates["strain"])):
            return self._differences(traced)
        held, (least, most) = self._held(at)[0], self._ranges
        units = [*self.unit, *np.where((held < least) | (held > most), 0.0, [*self.held.values()])]
        of_numbers = np.zeros((len(units), strain.size))
        for row, name, unit in zip(of_numbers, (*self.names, *self.held), units, strict=True):
            row[:] = unit * rates.get(name, 0.0) * sign
        rows = [of_numbers, -rates["strain"] * self.moved]
        if self.between:
            rows.append(
                sign * _load_of_intervals(hose, there, self.open_cord, self.between, self.load)
            )
        return self._read(np.vstack(rows)).T

    def _differences(self, traced: Floats) -> Floats:
        """The same where cords would break within the test, which has no closed form."""
        p = len(self.names)
        ends = traced + _DIFFERENCE * np.eye(traced.size) * np.array([[[-1.0]], [[1.0]]])
        ends[..., :p] = np.clip(ends[..., :p], self.low, self.high)
        below, above = (self.tension_at(one) for one in ends)
        return np.asarray(((above - below) / np.diagonal(ends[1] - ends[0])[:, None]).T)

    def error_slopes(self, x: Floats) -> Floats:
        """Effect of one standard uncertainty of each error, shape (n_error, n_used). [N]."""
        of_traced = self.slopes(x[: self.n_traced])[:, len(self.names) :]
        return np.vstack([of_traced.T, self.shared])

    def remainder(self, x: Floats) -> Floats:
        """Fitted curve, including shared errors, less the measured one, shape (n_used,). [N]."""
        traced, z = np.split(x, [self.n_traced])
        curve = self.tension_at(traced[None, :])[0] + z @ self.shared
        return np.asarray(curve - self.tension_of_test()[self.used])

    def residual(self, x: Floats, noise: Floats) -> Floats:
        """Terms of the sum of squares: every strain, then every error."""
        return np.concatenate([self.remainder(x) / noise, x[len(self.names) :]])

    def jacobian(self, x: Floats, noise: Floats) -> Floats:
        """Jacobian of `residual`, by the parameters and the errors."""
        slopes = self.slopes(x[: self.n_traced])
        data = np.hstack([slopes, self.shared.T]) / noise[:, None]
        p, k = len(self.names), self.n_error
        prior = np.hstack([np.zeros((k, p)), np.eye(k)])
        return np.vstack([data, prior])

    def start(self, first: Floats) -> Floats:
        """Best of a few starting values around the design, since the curve has kinks."""
        p = first.size
        offsets = np.array(list(product(_START_STEPS, repeat=p)))
        tried = np.clip(first + offsets, self.low, self.high)
        curve = _trial_load(
            self.design, self.names, tried * self.unit, self.measured.strain[self.used], self.load
        )
        error = (curve - self.tension_of_test()[self.used]) / self.noise
        # a parameter to which the curve does not respond keeps its design value
        cost = np.sum(error**2, axis=1) + 1e-3 * np.sum(offsets**2, axis=1)
        return np.asarray(tried[int(np.argmin(cost))])

    def solve(self, first: Floats, noise: Floats, is_rough: bool = False) -> Floats:
        """Least sum of squares, from these starting values; rough where another search follows.

        Raises
        ------
        FitError
            If the search does not converge.
        """
        k = self.n_error
        margin = 1e-6 * (self.high - self.low)  # a search must not start on a bound
        numbers, errors = np.split(first, [self.unit.size])
        inside = np.clip(numbers, self.low + margin, self.high - margin)
        tolerance = _ROUGH if is_rough else _TOLERANCE
        # dogbox reaches the same minima or lower ones in half the steps of the default, but near
        # a kink of the curve it may oscillate endlessly
        for method, most in _SEARCHES:
            found = scipy.optimize.least_squares(
                partial(self.residual, noise=noise),
                np.concatenate([inside, errors]),
                jac=partial(self.jacobian, noise=noise),
                method=method,
                bounds=(
                    np.concatenate([self.low, np.full(k, -np.inf)]),
                    np.concatenate([self.high, np.full(k, np.inf)]),
                ),
                xtol=tolerance,
                ftol=tolerance,
                gtol=tolerance,
                max_nfev=most,
            )
            if found.success:
                break
        if not found.success:
            raise FitError(
                "the calibration did not come to an end",
                found=f"{found.nfev} trials",
                needed="a least sum of squares",
                hint="Fit fewer numbers.",
            )
        return np.asarray(found.x)

    def solve_from(self, begins: Sequence[Floats], noise: Floats) -> Floats:
        """The lowest of the sums of squares from several starts, since the curve has kinks.

        Errors start at zero.  The result is a start itself, so a rough one is enough.
        """
        zero = np.zeros(self.n_error)
        apart = np.unique(begins, axis=0)
        found = [self.solve(np.append(one, zero), noise, is_rough=True) for one in apart]
        squares = [float(np.sum(self.residual(one, noise) ** 2)) for one in found]
        return found[int(np.argmin(squares))]

    def polished(self, x: Floats, noise: Floats) -> Floats:
        """Gauss-Newton steps while they get shorter.

        A search stops where the sum of squares no longer changes, at half the digits of the
        parameters, which depends on rounding in the processor.  Parameters at bounds stay there.
        """
        p = len(self.names)
        margin = _NEAR_BOUND * (self.high - self.low)
        is_free = np.ones(x.size, dtype=np.bool_)
        is_free[:p] = (x[:p] > self.low + margin) & (x[:p] < self.high - margin)
        shortest, left = np.inf, self.residual(x, noise)
        for _ in range(_POLISHING_STEPS):
            step = np.zeros_like(x)
            step[is_free] = -np.linalg.lstsq(self.jacobian(x, noise)[:, is_free], left)[0]
            trial = x + step
            length = float(np.linalg.norm(step))
            if (
                not length < shortest
                or np.any(trial[:p] < self.low)
                or np.any(trial[:p] > self.high)
            ):
                break
            after = self.residual(trial, noise)
            # not across a kink of the curve: a step there is arbitrary
            if not after @ after <= (left @ left) * (1 + 1e-9):
                break
            x, shortest, left = trial, length, after
        return x


@dataclass(frozen=True)
@read_only_arrays
class _FitSpread:
    """Covariance of the fitted parameters, in plausible errors, and its basis."""

    covariance: Floats
    freedom: float
    effective_points: float


def _spread_of(problem: _FitProblem, best: Floats, noise: Floats) -> _FitSpread:
    """Covariance of the fitted values, from the effective number of points in the residuals.

    Notes
    -----
    The information of the data is divided by tau times the reduced chi square, where that is
    above 1 [4]_; shared errors keep the information of their stated uncertainty.

    Examples
    --------
    See `reduction.prediction.hose_comparison._calibrate_hose`.

    >>> _FitSpread(np.eye(2), 8.0, 10.0).freedom
    8.0
    """
    p, n = problem.unit.size, noise.size
    left = problem.remainder(best) / noise
    length = autocorrelation_length(left)
    worth = n / length
    freedom = max(worth - p, 1.0)
    excess = max(1.0, float(left @ left) / n * length * max(worth / freedom, 1.0))
    jacobian = problem.jacobian(best, noise)
    data, prior = jacobian[:n], jacobian[n:]
    information = data.T @ data / excess + prior.T @ prior
    diagonal = np.diagonal(information)
    scale = np.sqrt(np.maximum(diagonal, _LEAST * max(diagonal.max(), 1.0)))
    size, axes = np.linalg.eigh(information / np.outer(scale, scale))
    inverse = (axes / np.maximum(size, _LEAST)) @ axes.T
    covariance = inverse / np.outer(scale, scale)
    return _FitSpread(covariance[:p, :p], freedom, worth)


_LEAST_NOISE = 1e-6  # share of the RMS tension: points without scatter are not exact

_AT_BOUND = 1e-4  # share of the width between the bounds

_FAR = 2.0  # standard uncertainties

_NOTHING = 1e-3  # share of the noise

_WIDE = 0.5  # share of the width between the bounds


def _calibrate_hose(
    design: HoseDesign,
    measured: MeasuredCurve,
    parameters: Sequence[str],
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
    load: Load = "tension",
) -> HoseCalibration:
    r"""Fit parameters of a hose to the judged curve of a test, with reliable intervals.

    Minimises

    .. math:: \sum_i \frac{[T_i(\theta, z) + \sum_j z_j c_{ij} - D_i]^2}{u_i^2 + s^2}
              + \sum_j z_j^2

    over the parameters :math:`\theta` within their bounds and the shared errors :math:`z`, each of
    unit variance.  Errors of strain shift the strains at which T is taken, uncertain parameters
    that are not fitted change the hose, and :math:`T_i` is evaluated as the curve was read from
    the samples; errors of load and the common scatter of cycles are proportional.

    Notes
    -----
    *Weights* [5]_. Type A of each strain, and s, one variance for all strains that brings the
    residuals of a first fit to their expected size: where the model error exceeds the noise, all
    strains count alike instead of the few with the least scatter.

    *Intervals.* An error of the model is smooth, so neighbouring residuals are not independent.
    The variance of the data is multiplied by the autocorrelation length of the residuals, tau,
    and by the remaining reduced chi square where that is above 1 [4]_; the interval is Student's t
    with n / tau - p degrees of freedom.  Shared errors keep their stated variance.  The interval
    leaves out a smooth error of the model that fitted parameters can follow without a residual;
    but where `_identify_directions` finds a direction to which the curve does not respond, the
    effect of a 1 % error is included.  An interval that would exceed the allowed range of a
    parameter is NaN.

    *Start.* The best of five values of each parameter around the design, in all combinations.

    *Break.* Trials whose cords would break within the measured strains are continued along their
    tangent, so that the fit is not caught in the gap.

    Fitted values are those with which the prediction matches this test; a cord scale from a
    dynamic test includes the different behaviour of the cord under dynamic load.

    Examples
    --------
    A pull computed from the hose itself, its modulus assumed a tenth too low.

    >>> from reduction.prediction.measured_curve import measured_curve
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.0, 1001)
    >>> pull = measured_curve(stroke, predict_hose(hose, stroke).tension, loading="static")
    >>> found = _calibrate_hose(
    ...     _design_with(hose, {"rubber_modulus": 1.26e6}), pull, ["rubber_modulus"]
    ... )
    >>> print(found.parameter, (found.value / 1e6).round(3), found.identifiability.is_identified)
    ('rubber_modulus',) [1.4] True
    """
    names, stated = tuple(parameters), dict(standard_uncertainty or {})
    held = {name: u for name, u in stated.items() if name not in names}
    judged = measured.tension_of(measured.judged)
    used = np.isfinite(judged)
    start = np.array([_number_of(design, name) for name in names])
    problem, sources = _pose(design, measured, names, held, load)
    p = len(names)
    at_start = start / problem.unit
    begins = (problem.start(at_start), np.clip(at_start, problem.low, problem.high))
    first = problem.solve_from(begins, problem.noise)
    remainder = problem.remainder(first)
    excess = remainder @ remainder / (remainder.size - p) - np.mean(problem.noise**2)
    model_error = float(np.sqrt(np.maximum(excess, 0.0)))
    noise = np.hypot(problem.noise, model_error)
    best = problem.polished(problem.solve(first, noise), noise)
    value = best[:p] * problem.unit
    fitted = _design_with(design, dict(zip(names, value.tolist(), strict=True)))
    spread = _spread_of(problem, best, noise)
    curve = problem.tension_at(best[None, : problem.n_traced])[0]
    told_apart = _identify_directions(
        problem.slopes(best[: problem.n_traced])[:, :p] / problem.unit,
        # cords that never pick up exert no pressure: shares then refer to the measurement
        tension=curve if curve.any() else judged[used],
        names=names,
        plausible=problem.unit,
        value=value,
        contribution=problem.error_slopes(best),
        misfit=float(np.sqrt(np.mean(problem.remainder(best) ** 2))),
    )
    covariance = spread.covariance * np.outer(problem.unit, problem.unit)
    covariance += told_apart.open_covariance
    deviation = np.sqrt(np.diagonal(covariance))
    width = (problem.high - problem.low) * problem.unit
    half = stdtrit(spread.freedom, 0.975) * deviation
    is_wide = 2 * half > _WIDE * width
    is_known = half <= width
    half, stated_deviation = (np.where(is_known, one, np.nan) for one in (half, deviation))
    margin = _AT_BOUND * (problem.high - problem.low)
    at_bound = (best[:p] - problem.low < margin) | (problem.high - best[:p] < margin)
    predicted = [getattr(predict_hose(one, measured.strain), load) for one in (design, fitted)]
    before, after = (
        difference_of(measured.strain, one, judged, curve=measured.judged) for one in predicted
    )
    return HoseCalibration(
        parameter=names,
        start=start,
        value=value,
        value_standard_uncertainty=stated_deviation,
        low=value - half,
        high=value + half,
        lower_bound=problem.low * problem.unit,
        upper_bound=problem.high * problem.unit,
        is_at_bound=at_bound,
        correlation=covariance / np.outer(deviation, deviation),
        identifiability=told_apart,
        design=fitted,
        before=before,
        after=after,
        model_error=model_error,
        effective_points=spread.effective_points,
        shared_error=sources,
        shared_error_value=best[p:],
        notes=(
            *_notes_of_numbers(names, told_apart, at_bound, is_wide),
            *_notes_of_fit(spread, p, sources, best[p:], used & ~np.isfinite(predicted[1])),
            *_notes_of_stated(names, value - start, stated),
        ),
    )


def _pose(
    design: HoseDesign,
    measured: MeasuredCurve,
    names: tuple[str, ...],
    held: Mapping[str, float],
    load: Load,
) -> tuple[_FitProblem, tuple[str, ...]]:
    """The fit problem, and the names of the errors fitted together with the parameters."""
    if not names or len(set(names)) < len(names):
        raise SettingsError(
            "what to calibrate cannot be read",
            found=", ".join(names) or "nothing",
            needed="one number or more, each once",
        )
    start = np.array([_number_of(design, name) for name in names])
    unit = np.array([_plausible_error(name, at) for name, at in zip(names, start, strict=True)])
    limits = [_parameter_bounds(name, at) for name, at in zip(names, start, strict=True)]
    low_high = np.array(limits) / unit[:, None]
    judged = measured.tension_of(measured.judged)
    used = np.isfinite(judged)
    if used.sum() < len(names) + 2:
        raise DataError(
            f"too few strains were measured to calibrate {len(names)} numbers",
            found=f"{int(used.sum())}",
            needed=f"{len(names) + 2} or more",
        )
    floor = _LEAST_NOISE * float(np.sqrt(np.mean(judged[used] ** 2)))
    stated = _known_uncertainties(design, held)
    is_moved = np.any(measured.strain_error != 0, axis=1)
    in_proportion = measured.contribution_of(measured.judged)[~is_moved]
    node = measured.reading.node
    scatter = measured.scatter_contribution
    problem = _FitProblem(
        design=design,
        names=names,
        unit=unit,
        low=low_high[:, 0],
        high=low_high[:, 1],
        held=stated,
        moved=np.array(
            [read_along(node, measured.strain, row) for row in measured.strain_error[is_moved]]
        ).reshape(-1, node.size),
        measured=measured,
        noise=np.maximum(measured.independent_uncertainty()[used], floor),
        shared=np.vstack([in_proportion, scatter])[:, used],
        load=load,
    )
    common = tuple(f"scatter of the cycles {k + 1}" for k in range(scatter.shape[0]))
    names_of = np.array([error_words(one) for one in measured.component], dtype=object)
    problem = replace(problem, between=_between_seen(problem, start / unit))
    where = tuple(
        f"cord curve between points {place + 1} and {place + 2} ({name})"
        for name, place in problem.between
    )
    return problem, (*stated, *names_of[is_moved], *where, *names_of[~is_moved], *common)


def _between_seen(problem: _FitProblem, first: Floats) -> tuple[tuple[str, int], ...]:
    """Curves and intervals of the cord that affect the measured strains, from either start."""
    strain = problem.measured.strain[problem.used]
    found: dict[tuple[str, int], None] = {}
    for begin in (first, problem.start(first)):
        near = _design_with(
            problem.design,
            dict(zip(problem.names, (begin * problem.unit).tolist(), strict=True)),
        )
        rows, where = _cord_curve_errors(near, strain, problem.load)
        seen = np.any(np.abs(rows) > problem.noise * _NOTHING, axis=1)
        found |= dict.fromkeys(one for one, is_seen in zip(where, seen, strict=True) if is_seen)
    return tuple(found)


def _notes_of_numbers(
    names: tuple[str, ...], told_apart: Identifiability, at_bound: Bools, is_wide: Bools
) -> list[Note]:
    notes = []
    if not told_apart.is_identified:
        notes.append(
            note(
                "numbers-not-told-apart" if len(names) > 1 else "number-not-shown",
                names=" and ".join(names), words=told_apart.words, needed=told_apart.needed_change,
            )
        )  # fmt: skip
    notes += [
        note("number-at-bound", name=name)
        for name, stopped in zip(names, at_bound, strict=True)
        if stopped
    ]
    notes += [
        note("number-not-determined", name=name)
        for name, wide in zip(names, is_wide, strict=True)
        if wide
    ]
    return notes


def _notes_of_fit(
    spread: _FitSpread, n_fitted: int, sources: tuple[str, ...], z: Floats, broken: Bools
) -> list[Note]:
    notes = []
    if spread.effective_points < n_fitted + 1:
        points = spread.effective_points
        notes.append(note("residuals-are-model", n_points=points, n_numbers=n_fitted))
    notes += [
        note("source-far-off", name=name, factor=float(value))
        for name, value in zip(sources, z, strict=True)
        if abs(value) > _FAR
    ]
    if broken.any():
        notes.append(note("fitted-cords-broken", n_strains=int(broken.sum())))
    return notes


def _notes_of_stated(
    names: tuple[str, ...], moved: Floats, stated: Mapping[str, float]
) -> list[Note]:
    return [
        note("number-moved-far", name=name, factor=float(step / stated[name]))
        for name, step in zip(names, moved, strict=True)
        if stated.get(name, 0) > 0 and abs(step) > _FAR * stated[name]
    ]


def _compare_hose(
    design: HoseDesign,
    measured: MeasuredCurve,
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
    calibrate: Sequence[str] = (),
    pressure: MeasuredCurve | None = None,
) -> Comparison:
    """Compare a prediction with a test, including its fill pressure where measured.

    Notes
    -----
    Every difference is predicted less measured [3]_.  The prediction is elastic; it is compared
    with the midline of the loop, since either branch differs by half of a loop that the cord curve
    does not contain.  For the verdict the prediction is evaluated at the strains of the samples, as
    the curve was, so that a kink is rounded in both.  Where only one branch was measured, it is
    used, and a note says so.

    Strains beyond the predicted break of the cords are in no difference; a note counts them.

    Examples
    --------
    >>> from reduction.prediction.measured_curve import measured_curve
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.0, 1001)
    >>> softer = measured_curve(stroke, 0.9 * predict_hose(hose, stroke).tension, loading="static")
    >>> found = _compare_hose(hose, softer, standard_uncertainty={"rubber_modulus": 0.01e6})
    >>> print(round(found.differences["ascending"].relative_rms, 3), found.validation.agrees)
    0.111 False
    """
    known = dict(standard_uncertainty or {})
    prediction = predict_hose(design, measured.strain)
    differences = {
        curve: difference_of(
            measured.strain, prediction.tension, measured.tension_of(curve), curve=curve
        )
        for curve in measured.curves()
    }
    inputs = _input_draws(design, known, measured.strain, n_draws=N_DRAWS)
    events = event_differences(design, measured, standard_uncertainty=known)
    calibration = (
        _calibrate_hose(design, measured, calibrate, standard_uncertainty=known)
        if calibrate
        else None
    )
    pick_up = measured_pick_up(measured)
    return Comparison(
        measured=measured,
        prediction=prediction,
        judged=measured.judged,
        differences=differences,
        events=events,
        energy=energy_difference(prediction.tension, measured),
        cycles=cycle_differences(prediction.tension, measured),
        validation=validate_curve(
            _as_read(design, measured, prediction.tension),
            measured,
            input_error=inputs,
            numerical_error=None if inputs.size else _cord_curve_errors(design, measured.strain)[0],
        ),
        calibration=calibration,
        notes=(*_notes(design, measured, prediction, events[1]), *_of_pick_up(pick_up)),
        measured_pick_up_strain=pick_up.strain,
        measured_pick_up_strain_standard_uncertainty=pick_up.standard_uncertainty,
        pressure=(
            None if pressure is None else _compare_pressure(design, pressure, known, calibrate)
        ),
    )


_WITHOUT_PRESSURE = "rubber_modulus"


def _compare_pressure(
    design: HoseDesign,
    measured: MeasuredCurve,
    known: Mapping[str, float],
    calibrate: Sequence[str],
) -> PressureComparison:
    """Compare the predicted fill pressure with the measured one, in the same way as the tension."""
    predicted = predict_hose(design, measured.strain).fill_pressure
    inputs = _input_draws(design, known, measured.strain, n_draws=N_DRAWS, load="fill_pressure")
    names = [name for name in calibrate if name != _WITHOUT_PRESSURE]
    validation = validate_curve(
        _as_read(design, measured, predicted, "fill_pressure"),
        measured,
        input_error=inputs,
        numerical_error=(
            None if inputs.size else _cord_curve_errors(design, measured.strain, "fill_pressure")[0]
        ),
    )
    words = verdict_words(validation, unit="kPa", factor=1e-3, of="fill pressure")
    return PressureComparison(
        measured=measured,
        predicted=predicted,
        difference=difference_of(
            measured.strain, predicted, measured.tension_of(measured.judged), curve=measured.judged
        ),
        validation=replace(validation, verdict=words),
        calibration=(
            _calibrate_hose(
                design, measured, names, standard_uncertainty=known, load="fill_pressure"
            )
            if names
            else None
        ),
        parameter=tuple(calibrate),
    )


def _as_read(
    design: HoseDesign, measured: MeasuredCurve, prediction: Floats, load: Load = "tension"
) -> Floats:
    """Prediction as the test would show it; without smoothing where it is broken nearby."""
    node = measured.reading.node
    there = np.isfinite(measured.tension_of(measured.judged))
    # the curve continues just below zero, where a record with low readings has strains
    curve = getattr(predict_hose(design, np.abs(node)), load)
    read = measured.reading.of(np.sign(node) * curve)
    return np.where(there & np.isfinite(read), read, prediction)


def _of_pick_up(found: PickUp) -> tuple[Note, ...]:
    return (note("pick-up-not-shown", reason=found.reason),) if found.reason else ()


def _notes(
    design: HoseDesign,
    measured: MeasuredCurve,
    prediction: HosePrediction,
    working: EventDifference,
) -> tuple[Note, ...]:
    notes = list(measured.notes)
    if measured.loading == "dynamic":
        notes.append(note("dynamic-test"))
    seen: Bools = np.isfinite(measured.tension_of(measured.judged))
    n_broken = int(np.sum(seen & prediction.is_broken))
    if n_broken:
        notes.append(
            note(
                "test-beyond-break",
                strain=float(measured.strain[seen].max()),
                n_broken=n_broken,
                n_strains=int(seen.sum()),
            )
        )
    angle = float(design.wrap_angle)
    said = [plausibility_of_working_strain(angle, working.strain)]
    if np.isfinite(working.measured_strain):
        said.append(
            plausibility_of_working_strain(angle, working.measured_strain, loading=measured.loading)
        )
    else:
        last = np.append(measured.strain[seen], measured.end_strain)
        notes.append(note("curve-ends-early", strain=float(np.nanmax(last))))
    sides = ("predicted", "measured")
    notes += [
        note("stretch-beside-reported", side=side, words=text)
        for side, text in zip(sides, said, strict=False)
        if text
    ]
    return tuple(notes)


_STATIC = ("quasi-static", "tensile")

_WAY_BACK = 0.5
"""Least share of the stroke for a return to be a branch of its own."""


def loading_of(kind: str) -> Loading:
    """Default loading of a test of each kind.

    >>> loading_of("cyclic")
    'dynamic'
    """
    return "static" if kind in _STATIC else "dynamic"


def compare_record(
    plan: HosePlan,
    strain: Floats,
    tension: Floats,
    *,
    loading: Loading,
    cycle_number: Integers | None,
    branch: Integers | None,
    break_in_cycles: int = 0,
    shared: SharedErrors | None = None,
    calibrate: Sequence[str] = (),
    fill_pressure: Floats | None = None,
    fill_pressure_standard_uncertainty: float = 0.0,
) -> Comparison:
    """Compare the prediction of a hose with one test."""
    usable = np.isfinite(strain) & np.isfinite(tension)
    if not usable.any():
        raise DataError(
            "the test has no sample with strain and tension", found=f"{strain.size} samples",
            needed="a record with strain and tension",
        )  # fmt: skip
    if cycle_number is None or branch is None:
        cycle_number, branch = _out_and_back(np.where(usable, strain, np.nan))

    def curve_of(series: Floats, errors: SharedErrors | None) -> MeasuredCurve:
        return measured_curve(
            strain,
            np.where(usable, series, np.nan),
            loading=loading,
            cycle_number=cycle_number,
            branch=branch,
            break_in_cycles=break_in_cycles,
            shared=errors,
        )

    return _compare_hose(
        plan.design,
        curve_of(tension, shared),
        standard_uncertainty=plan.standard_uncertainty,
        calibrate=calibrate,
        pressure=None
        if fill_pressure is None
        else curve_of(fill_pressure, pressure_errors(shared, fill_pressure_standard_uncertainty)),
    )


def _out_and_back(strain: Floats) -> tuple[Integers | None, Integers | None]:
    """A pull and its return as one cycle; no cycle where it does not return."""
    top = int(np.nanargmax(strain))
    least = np.nanmin(strain[: top + 1])
    stroke = strain[top] - least
    back = strain[top] - np.nanmin(strain[top:])
    if back < _WAY_BACK * stroke:
        return None, None
    branch = np.where(np.arange(strain.size) <= top, 1, 2)
    return np.ones(strain.size, dtype=np.int64), branch
