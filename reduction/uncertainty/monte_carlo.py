r"""Monte Carlo of the three-parameter line.

.. math:: A = E' - K_0, \qquad K_1 = A + E''^2 / A, \qquad \tau = A / (2 \pi f E'')

K_1 has its least value 2 E'' at A = E'' and is unbounded as A goes to zero; normal errors of any
size reach A = 0, so that K_1 has no variance in the strict sense.  Draws with negative A are not a
line at all.  Both are counted here: the fraction of draws without a solution is given
beside an interval of those that have one.

References
----------
.. [1] JCGM 101:2008, "Supplement 1 to the Guide - Propagation of distributions using a Monte
   Carlo method," 5.3 (coverage interval), 6.4.7 (normal), 6.4.9 (t of repeated readings), 7, 8
   (validation of the law of propagation).
.. [2] JCGM 102:2011, "Supplement 2 - Extension to any number of output quantities," 5.3.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gammaincinv

from reduction.quantities.flags import LINE_METHODS
from reduction.record.arrays import as_same_shape
from reduction.record.contributions import (
    LineSpread,
    combined_standard_uncertainty,
    covariance_root,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.reduced_test import ReducedTest
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    identify_by_amplitude,
    identify_by_fundamental,
    line_sensitivities,
)
from reduction.stages.three_parameter_line.line_of_loops import (
    covariance_of_means,
    relative_deviations,
    relative_shared,
)
from reduction.stages.three_parameter_line.line_product import LINE_PARAMETERS, LineParameters

"""K_1, tau and N = K_1 tau, in the order of the arrays of `_LineDraws`."""

N_DRAWS = 20_000
"""Number of draws, for which a standard deviation is known to 0.5 %."""

_SEED = 20080

_AGREE = 0.05

_INTERVAL = (0.025, 0.975)

_ONE_SIGMA = (0.158655, 0.841345)


@dataclass(frozen=True)
@read_only_arrays
class _LineDraws:
    """Results of the draws for the line of each specimen; rows are `LINE_PARAMETERS`."""

    linear_standard_uncertainty: Floats
    standard_uncertainty: Floats
    low: Floats
    high: Floats
    without_solution_share: Floats

    @property
    def is_linear(self) -> Bools:
        """Whether both standard uncertainties of all three agree within 5 %, by specimen."""
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = self.standard_uncertainty / self.linear_standard_uncertainty
            near = (np.abs(ratio - 1) <= _AGREE).all(axis=0)
        near &= self.without_solution_share == 0
        return np.asarray(near)


def _draw_line(
    values: Mapping[str, ArrayLike],
    *,
    reading: Literal["amplitude", "fundamental"],
    covariance: ArrayLike,
    degrees_of_freedom: ArrayLike,
    contribution: ArrayLike,
) -> _LineDraws:
    """Propagate the distributions of the inputs of a line.

    Notes
    -----
    [1]_: shared errors are normal; random ones are normal for the standard uncertainty, for
    comparison with the linear one, and for the interval follow the t distribution with their
    degrees of freedom (6.4.9, for several quantities at once as in [2]_).  The line is identified
    by the same functions as in a test.  The seed is fixed: equal inputs give equal results.  Valid
    if the inputs themselves are linear in the errors, as amplitudes and areas of a loop are.

    Examples
    --------
    E' = 3, E'' = 1 and K_0 = 2, known to 1 % and to 20 %:

    >>> values = {"storage_spring_constant": [3.0, 3.0], "loss_spring_constant": [1.0, 1.0],
    ...     "frequency": [0.3, 0.3], "quasi_static_spring_constant": [2.0, 2.0]}
    >>> shared = np.zeros((1, 2, 4))
    >>> shared[0, :, 3] = 0.01, 0.2
    >>> found = _draw_line(values, reading="fundamental", covariance=np.zeros((2, 4, 4)),
    ...     degrees_of_freedom=[9.0, 9.0], contribution=shared)
    >>> print(found.is_linear, found.without_solution_share.round(3))
    [False False] [0.    0.005]

    K_1 is at its minimum there, where first order gives zero:

    >>> print(found.linear_standard_uncertainty[0].round(6), found.low[0].round(3))
    [0. 0.] [2. 2.]
    """
    names = AMPLITUDE_INPUTS if reading == "amplitude" else FUNDAMENTAL_INPUTS
    centre = np.stack(list(as_same_shape(**{name: values[name] for name in names})), axis=-1)
    random, shared = (np.asarray(one, dtype=np.float64) for one in (covariance, contribution))
    freedom = np.asarray(degrees_of_freedom, dtype=np.float64)
    n_specimens, n_inputs = centre.shape
    known = np.isfinite(centre).all(axis=1) & np.isfinite(random).all(axis=(1, 2))
    known &= np.isfinite(shared).all(axis=(0, 2)) & (freedom > 0)
    generator = np.random.default_rng(_SEED)
    own = generator.standard_normal((N_DRAWS, n_inputs))
    common = generator.standard_normal((N_DRAWS, shared.shape[0]))
    uniform = generator.random(N_DRAWS)
    result = {
        name: np.full((len(LINE_PARAMETERS), n_specimens), np.nan)
        for name in ("linear_standard_uncertainty", "standard_uncertainty", "low", "high")
    }
    without = np.full(n_specimens, np.nan)
    for place in np.flatnonzero(known):
        at = centre[place]
        linear = _linear(at, reading, random[place], shared[:, place])
        if not np.isfinite(linear).all():
            continue
        result["linear_standard_uncertainty"][:, place] = linear
        # einsum, not a matrix product, whose last digits depend on the number of threads
        scattered = np.einsum("dj,ij->di", own, covariance_root(random[place]))
        moved = np.einsum("dc,ci->di", common, shared[:, place])
        normal = _identified(at * (1 + scattered + moved), reading)
        wide = np.sqrt(freedom[place] / (2 * gammaincinv(freedom[place] / 2, uniform)))[:, None]
        heavy = _identified(at * (1 + scattered * wide + moved), reading)
        solved = np.isfinite(normal).all(axis=0)
        without[place] = 1 - solved.mean()
        if not (solved.any() and np.isfinite(heavy).all(axis=0).any()):
            continue
        result["standard_uncertainty"][:, place] = (
            normal.std(axis=1, ddof=1)
            if solved.all()
            else np.diff(np.quantile(normal[:, solved], _ONE_SIGMA, axis=1), axis=0)[0] / 2
        )
        ends = np.quantile(heavy[:, np.isfinite(heavy).all(axis=0)], _INTERVAL, axis=1)
        result["low"][:, place], result["high"][:, place] = ends
    return _LineDraws(**result, without_solution_share=without)


def _linear(
    at: Floats,
    reading: Literal["amplitude", "fundamental"],
    random: Floats,
    shared: Floats,
) -> Floats:
    """First-order standard uncertainty of the parameters from the same inputs."""
    line = _parameters(at, reading)
    table = (amplitude_sensitivities if reading == "amplitude" else line_sensitivities)(
        line["storage_spring_constant"],
        line["loss_spring_constant"],
        line["quasi_static_spring_constant"],
    )
    slopes = table[[OUTPUTS.index(name) for name in LINE_PARAMETERS]]
    variance = np.einsum("oi,ij,oj->o", slopes, random + shared.T @ shared, slopes)
    size = np.array([line[name] for name in LINE_PARAMETERS])
    return np.asarray(size * np.sqrt(np.maximum(variance, 0)))


def _parameters(inputs: Floats, reading: Literal["amplitude", "fundamental"]) -> dict[str, Floats]:
    """Fields of the line by name; inputs along the last axis."""
    if reading == "amplitude":
        line = identify_by_amplitude(
            **dict(zip(AMPLITUDE_INPUTS, np.moveaxis(inputs, -1, 0), strict=True))
        )
    else:
        line = identify_by_fundamental(
            **dict(zip(FUNDAMENTAL_INPUTS, np.moveaxis(inputs, -1, 0), strict=True))
        )
    names = (*OUTPUTS, "quasi_static_spring_constant")
    return {name: getattr(line, name) for name in names}


def _identified(inputs: Floats, reading: Literal["amplitude", "fundamental"]) -> Floats:
    """Parameters of each draw, shape (3, n_draws)."""
    line = _parameters(inputs, reading)
    return np.stack([line[name] for name in LINE_PARAMETERS])


def with_line_spread(test: ReducedTest, cycles: CycleSettings) -> ReducedTest:
    """Add to a test the uncertainty of its line, by the propagation that is valid."""
    line, loops = test.line_of_test, test.loops
    if line is None or loops is None or not (line.reason == 0).any():
        return test
    draws, freedom = _drawn(test, line, loops, cycles.break_in_cycles)
    is_given = np.isfinite(draws.standard_uncertainty).all(axis=0)
    method = np.where(draws.is_linear, LINE_METHODS["linear"], LINE_METHODS["monte_carlo"])
    method = np.where(is_given, method, LINE_METHODS["not_given"])
    spreads: dict[str, Floats] = {}
    low: dict[str, Floats] = {}
    high: dict[str, Floats] = {}
    for row, name in enumerate(LINE_PARAMETERS):
        random = line.random_uncertainty[name]
        shared = _shared(test, line, name)
        linear = combined_standard_uncertainty(shared, random)
        half = linear * coverage_factor(
            effective_degrees_of_freedom(random, freedom, contribution=shared)
        )
        value = getattr(line, name)
        chosen = [method == LINE_METHODS[one] for one in ("linear", "monte_carlo")]
        for found, pair in (
            (spreads, (linear, draws.standard_uncertainty[row])),
            (low, (value - half, draws.low[row])),
            (high, (value + half, draws.high[row])),
        ):
            found[name] = np.select(chosen, pair, np.nan)
    spread = LineSpread(method, draws.without_solution_share, spreads, low, high)
    notes = [
        _note(test.specimens[place].name, draws, int(place))
        for place in np.flatnonzero(method == LINE_METHODS["monte_carlo"])
    ]
    return replace(test, line_spread=spread, line_notes=(*test.line_notes, *notes))


def _drawn(
    test: ReducedTest, line: LineParameters, loops: Loops, break_in_cycles: int
) -> tuple[_LineDraws, Floats]:
    """Draws of each specimen, and the degrees of freedom of its random part."""
    reading: Literal["amplitude", "fundamental"] = (
        "fundamental" if line.reading == "fundamental" else "amplitude"
    )
    names = FUNDAMENTAL_INPUTS if reading == "fundamental" else AMPLITUDE_INPUTS
    means, deviations = relative_deviations(loops, names[:-1], break_in_cycles=break_in_cycles)
    of_means, freedom = covariance_of_means(deviations)
    alike = relative_shared(loops, names[:-1], break_in_cycles=break_in_cycles)
    of_means = of_means + np.eye(len(alike)) * alike.T[..., None] ** 2
    rest = line.quasi_static_spring_constant
    values = dict(zip(names, (*means, rest), strict=True))
    # K_0 is from the pull: it does not scatter from cycle to cycle
    covariance = np.pad(of_means, ((0, 0), (0, 1), (0, 1)))
    shared = [
        _shared(test, line, name) / value
        for name, value in values.items()
    ]  # fmt: skip
    n_components = max(len(rows) for rows in shared)
    contribution = np.stack(
        [np.broadcast_to(rows, (n_components, rest.size)) for rows in shared], axis=-1
    )
    draws = _draw_line(
        values, reading=reading, covariance=covariance, degrees_of_freedom=freedom,
        contribution=contribution,
    )  # fmt: skip
    return draws, freedom


def _shared(test: ReducedTest, line: LineParameters, name: str) -> Floats:
    """Contributions of shared errors to a quantity of the test, shape (n_components, ...)."""
    stated = test.contributions
    if stated is not None and f"test_{name}" in stated.values:
        return stated.values[f"test_{name}"]
    if stated is None and name in line.shared_uncertainty:
        return line.shared_uncertainty[name][None]
    if stated is None and name == "quasi_static_spring_constant":
        spread = test.quasi_static_standard_uncertainty
        if spread is not None:
            return spread[None]
    return np.zeros((1, line.reason.size))


def _note(specimen: str, draws: _LineDraws, place: int) -> Note:
    share = float(draws.without_solution_share[place])
    if share > 0:
        return note("line-draws-without-solution", specimen, share=share)
    first = draws.linear_standard_uncertainty[:, place]
    with np.errstate(divide="ignore"):
        ratio = draws.standard_uncertainty[:, place] / first
    worst = int(np.argmax(np.abs(np.log(np.maximum(ratio, 1e-300)))))
    words = ("K_1", "tau", "K_1 tau")
    return note("line-by-monte-carlo", specimen, worst=words[worst], ratio=float(1 / ratio[worst]))
