"""Measured points and the numbers of a hose that are fitted to them.

References
----------
.. [1] G. A. F. Seber and C. J. Wild, "Nonlinear Regression," Wiley, 1989, ch. 2.
.. [2] R. T. Birge, "The calculation of errors by the method of least squares," Phys. Rev.,
   vol. 40, 1932.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy

from reduction.compare.identifiability import plausible_error
from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.residuals import autocorrelation_length
from reduction.compare.trials import number_of, range_of, trial_tension
from reduction.errors import FitError
from reduction.predict.product import HoseDesign
from reduction.record import Bools, Floats, read_only_arrays

_START_STEPS = (-4.0, -2.0, 0.0, 2.0, 4.0)  # plausible errors, tried in all combinations
_DIFFERENCE = 1e-3  # of a plausible error, for derivatives
_NEAR_BOUND = 1e-4  # of the width between the bounds
_POLISHING_STEPS = 30
_LEAST = 1e-14  # information below this part of the greatest is rounding


def parameter_bounds(name: str, start: float) -> tuple[float, float]:
    """Between what a number is kept while it is fitted.

    Parameters
    ----------
    name : str
        One of `reduction.compare.identifiability.CALIBRATED`.
    start : float
        Its value. [SI]

    Returns
    -------
    low, high : float
        10 degrees around a wrap angle, up to half of the length that does not stretch, a fifth to
        five times the others. [SI]

    Raises
    ------
    SettingsError
        If the number is not one to be fitted.

    Examples
    --------
    >>> print(parameter_bounds("cord_load_scale", 1.0))
    (0.2, 5.0)
    """
    plausible_error(name, start)
    if name == "wrap_angle":
        low, high = start - np.radians(10.0), start + np.radians(10.0)
        return max(float(low), float(np.radians(1.0))), min(float(high), float(np.radians(89.0)))
    if name == "dead_length_share":
        return 0.0, 0.5
    return start / 5, start * 5


@dataclass(frozen=True)
@read_only_arrays
class FitProblem:
    """Measured points and what is to be fitted to them.

    What is fitted stands in one vector: numbers in plausible errors, then errors in standard
    uncertainties, those of held numbers, of strain, and those in proportion.

    Parameters
    ----------
    design : HoseDesign
        From which the numbers are that are not fitted.
    names : tuple of str, length n_parameter
        Numbers that are fitted.
    unit, low, high : ndarray, shape (n_parameter,)
        Plausible error of each [SI], and its bounds in that unit.
    held : mapping of str to float
        Standard uncertainties of numbers that are not fitted. [SI]
    moved : ndarray, shape (n_moved, n_node)
        Errors of strain at the nodes of the reading, signed. [1]
    measured : MeasuredCurve
        The test. [SI]
    noise : ndarray, shape (n_used,)
        Standard uncertainty that no two measured points share. [N]
    shared : ndarray, shape (n_source, n_used)
        Errors in proportion that they share, signed. [N]

    Notes
    -----
    A strain that was read high moves the whole curve, and its kink with it.  Minus the slope
    times the error, the change in proportion, leaves the kink where it is: a fit would find the
    error by that alone, and call the place of the kink the angle's.  So strains are moved, the
    numbers that are held are changed in the design, and the hose is read at the strains between
    the bin centres as the test was.
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

    @property
    def used(self) -> Bools:
        """Which strains of the judged curve were measured, shape (n_strain,)."""
        return np.isfinite(self.tension_of_test())

    @property
    def n_traced(self) -> int:
        """Numbers and errors whose effect is computed by the hose, not in proportion."""
        return len(self.names) + len(self.held) + len(self.moved)

    @property
    def n_error(self) -> int:
        """Errors that are fitted beside the numbers."""
        return len(self.held) + len(self.moved) + len(self.shared)

    def tension_of_test(self) -> Floats:
        """Judged curve, shape (n_strain,). [N]."""
        return self.measured.tension_of(self.measured.judged)

    def tension_at(self, traced: Floats) -> Floats:
        """Tension of trials (n_trial, n_traced) as the test shows it, (n_trial, n_used). [N]."""
        p, q = len(self.names), len(self.held)
        values = [traced[:, :p] * self.unit]
        for k, (name, spread) in enumerate(self.held.items()):
            at = number_of(self.design, name) + spread * traced[:, p + k]
            values.append(np.clip(at, *range_of(name))[:, None])
        numbers, names = np.hstack(values), (*self.names, *self.held)
        node = self.measured.reading.node
        tension = np.empty((traced.shape[0], self.noise.size))
        used = self.used
        axes, which = np.unique(traced[:, p + q :], axis=0, return_inverse=True)
        for k, size in enumerate(axes):
            trials = which.ravel() == k
            strain = node - size @ self.moved
            # a record that is read low has strains just below zero: the curve goes on there
            curve = trial_tension(self.design, names, numbers[trials], np.abs(strain))
            tension[trials] = self.measured.reading.of(np.sign(strain) * curve)[:, used]
        return tension

    def slopes(self, traced: Floats) -> Floats:
        """Derivative of tension by each number and traced error, (n_used, n_traced)."""
        step = _DIFFERENCE * np.eye(traced.size)
        ends = np.vstack([traced - step, traced + step])
        p = len(self.names)
        ends[:, :p] = np.clip(ends[:, :p], self.low, self.high)
        below, above = np.split(self.tension_at(ends), 2)
        width = np.diagonal(ends[traced.size :] - ends[: traced.size])
        return np.asarray((above - below) / width[:, None]).T

    def error_slopes(self, x: Floats) -> Floats:
        """What one standard uncertainty of each error does, shape (n_error, n_used). [N]."""
        of_traced = self.slopes(x[: self.n_traced])[:, len(self.names) :]
        return np.vstack([of_traced.T, self.shared])

    def remainder(self, x: Floats) -> Floats:
        """Fitted curve, shared errors in it, less the measured one, shape (n_used,). [N]."""
        traced, z = np.split(x, [self.n_traced])
        curve = self.tension_at(traced[None, :])[0] + z @ self.shared
        return np.asarray(curve - self.tension_of_test()[self.used])

    def residual(self, x: Floats, noise: Floats) -> Floats:
        """What is squared and summed: every strain, then every error."""
        return np.concatenate([self.remainder(x) / noise, x[len(self.names) :]])

    def jacobian(self, x: Floats, noise: Floats) -> Floats:
        """Of `residual`, by the numbers and the errors."""
        slopes = self.slopes(x[: self.n_traced])
        data = np.hstack([slopes, self.shared.T]) / noise[:, None]
        p, k = len(self.names), self.n_error
        prior = np.hstack([np.zeros((k, p)), np.eye(k)])
        return np.vstack([data, prior])

    def start(self, first: Floats) -> Floats:
        """Best of a few values around the design, since the curve has kinks."""
        p = first.size
        offsets = np.array(list(product(_START_STEPS, repeat=p)))
        tried = np.clip(first + offsets, self.low, self.high)
        curve = trial_tension(
            self.design, self.names, tried * self.unit, self.measured.strain[self.used]
        )
        error = (curve - self.tension_of_test()[self.used]) / self.noise
        # a number that the curve does not show stays where the design has it
        cost = np.sum(error**2, axis=1) + 1e-3 * np.sum(offsets**2, axis=1)
        return np.asarray(tried[int(np.argmin(cost))])

    def solve(self, first: Floats, noise: Floats) -> Floats:
        """Least sum of squares, from these numbers; shared errors begin at zero.

        Raises
        ------
        FitError
            If the search does not end.
        """
        k = self.n_error
        margin = 1e-6 * (self.high - self.low)  # a search may not begin on a bound
        inside = np.clip(first[: self.unit.size], self.low + margin, self.high - margin)
        x0 = np.concatenate([inside, np.zeros(k)])
        found = scipy.optimize.least_squares(
            self.residual,
            x0,
            jac=self.jacobian,
            bounds=(
                np.concatenate([self.low, np.full(k, -np.inf)]),
                np.concatenate([self.high, np.full(k, np.inf)]),
            ),
            xtol=1e-10,
            ftol=1e-10,
            gtol=1e-10,
            args=(noise,),
        )
        if not found.success:
            raise FitError(
                "the calibration did not come to an end",
                found=f"{found.nfev} trials",
                needed="a least sum of squares",
                hint="Fit fewer numbers.",
            )
        return self._polished(np.asarray(found.x), noise)

    def _polished(self, x: Floats, noise: Floats) -> Floats:
        """Gauss-Newton steps while they get shorter.

        A search stops where the sum of squares no longer changes, at half the digits of the
        numbers, by the last digits of a processor.  A number at its bound stays there.
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
            # not where a kink of the curve lies between: there a step leads anywhere
            if not after @ after <= (left @ left) * (1 + 1e-9):
                break
            x, shortest, left = trial, length, after
        return x


@dataclass(frozen=True)
@read_only_arrays
class FitSpread:
    """Covariance of the fitted numbers, in plausible errors, and what it rests on."""

    covariance: Floats
    freedom: float
    effective_points: float


def spread_of(problem: FitProblem, best: Floats, noise: Floats) -> FitSpread:
    """Covariance of what was fitted, from the points that the residuals are worth.

    Parameters
    ----------
    problem : FitProblem
        What was fitted.
    best : ndarray, shape (n_parameter + n_source,)
        Its answer. [1]
    noise : ndarray, shape (n_strain,)
        Standard uncertainty that the points were weighed by. [N]

    Returns
    -------
    spread : FitSpread
        Degrees of freedom at least one.

    Raises
    ------
    Nothing
        A number that the curve does not show has a variance beyond all use, not none.

    Notes
    -----
    The information of the data is divided by tau times the reduced chi square, where that is
    above 1 [2]_; shared errors keep the information of their stated uncertainty.

    Examples
    --------
    See `reduction.compare.calibrate.calibrate_hose`.

    >>> FitSpread(np.eye(2), 8.0, 10.0).freedom
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
    return FitSpread(covariance[:p, :p], freedom, worth)
