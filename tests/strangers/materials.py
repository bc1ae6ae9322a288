"""Materials: elastic curves, viscoelastic branches and rate-independent sliders.

All stresses are nominal (force over the area at zero tension), all strains nominal.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[Any]


def _mooney(strain: Array, c: dict[str, float]) -> Array:
    stretch = 1.0 + strain
    return (1.0 + c["ratio"] / stretch) * (stretch - stretch**-2)


def _ogden(strain: Array, c: dict[str, float]) -> Array:
    stretch = 1.0 + strain
    first = stretch ** (c["alpha_1"] - 1.0) - stretch ** (-c["alpha_1"] / 2.0 - 1.0)
    second = stretch ** (c["alpha_2"] - 1.0) - stretch ** (-c["alpha_2"] / 2.0 - 1.0)
    return first + c["share"] * second


def _gent(strain: Array, c: dict[str, float]) -> Array:
    stretch = 1.0 + strain
    invariant = stretch**2 + 2.0 / stretch - 3.0
    return (stretch - stretch**-2) * c["limit"] / (c["limit"] - invariant)


def _yeoh(strain: Array, c: dict[str, float]) -> Array:
    stretch = 1.0 + strain
    invariant = stretch**2 + 2.0 / stretch - 3.0
    return (stretch - stretch**-2) * (1.0 - c["second"] * invariant + c["third"] * invariant**2)


def _polynomial(strain: Array, c: dict[str, float]) -> Array:
    return strain - c["second"] * strain**2 + c["third"] * strain**3


CURVES: dict[str, Callable[[Array, dict[str, float]], Array]] = {
    "mooney": _mooney,
    "ogden": _ogden,
    "gent": _gent,
    "yeoh": _yeoh,
    "polynomial": _polynomial,
}
_RANGES: dict[str, dict[str, tuple[float, float]]] = {
    "mooney": {"ratio": (0.3, 1.5)},
    "ogden": {"alpha_1": (1.3, 1.9), "alpha_2": (3.2, 4.4), "share": (0.01, 0.06)},
    "gent": {"limit": (28.0, 70.0)},
    "yeoh": {"second": (0.005, 0.02), "third": (0.0008, 0.002)},
    "polynomial": {"second": (0.12, 0.26), "third": (0.03, 0.06)},
}


@dataclass(frozen=True)
class ElasticCurve:
    """Nominal stress [Pa] against nominal strain, up to a strain of about 3."""

    family: str
    constants: dict[str, float]
    scale: float

    def stress(self, strain: Array) -> Array:
        """Stress at a strain."""
        return self.scale * CURVES[self.family](np.asarray(strain, dtype=float), self.constants)

    def slope(self, strain: Array) -> Array:
        """Return the derivative of the stress by central difference."""
        step = 1e-5
        strain = np.asarray(strain, dtype=float)
        return (self.stress(strain + step) - self.stress(strain - step)) / (2.0 * step)


def draw_curve(
    rng: np.random.Generator, stress_at_one: float, family: str | None = None
) -> ElasticCurve:
    """Draw a curve, a monotone one, that passes through a stress at the strain 1."""
    while True:
        name = family or str(rng.choice(list(CURVES)))
        constants = {key: float(rng.uniform(*span)) for key, span in _RANGES[name].items()}
        raw = float(CURVES[name](np.array(1.0), constants))
        curve = ElasticCurve(name, constants, stress_at_one / raw)
        if np.all(curve.slope(np.linspace(0.0, 3.0, 301)) > 0.15 * stress_at_one):
            return curve


def maxwell(time_step: float, drive: Array, relaxation_time: float, start: float = 0.0) -> Array:
    """Response of dq/dt + q/tau = d(drive)/dt, exact for a drive that is linear in each step."""
    ratio = time_step / relaxation_time
    decay = float(np.exp(-ratio))
    gain = -float(np.expm1(-ratio)) / ratio
    rest, _ = lfilter([gain], [1.0, -decay], np.diff(drive), zi=[decay * start])
    return np.concatenate(([start], rest))


def stop(strain: Array, limit: float) -> Array:
    """Stop operator (spring and slider in series): a strain within +-limit, from 0 at the start.

    Each monotone run is treated at once, so the result is exact at every sample.
    """
    step = np.diff(strain)
    step[np.abs(step) < 1e-15] = 0.0
    sign = np.sign(step)
    known = np.flatnonzero(sign)
    out = np.zeros_like(strain)
    if known.size == 0:
        return out
    turns = known[1:][np.diff(sign[known]) != 0]
    edges = np.concatenate(([0], turns, [strain.size - 1]))
    state = 0.0
    for first, last in itertools.pairwise(edges):
        run = np.clip(state + strain[first : last + 1] - strain[first], -limit, limit)
        out[first : last + 1] = run
        state = float(run[-1])
    return out


@dataclass(frozen=True)
class Rubber:
    """Elastic curve, Maxwell branches and sliders side by side.

    ``branches`` are (share, relaxation time); with ``drive`` "curve" the branch is driven by the
    elastic stress, with "line" by the strain times the secant modulus at the strain 1.
    ``sliders`` are (stiffness [Pa], limit [strain]).
    """

    curve: ElasticCurve
    branches: tuple[tuple[float, float], ...] = ()
    drive: str = "curve"
    sliders: tuple[tuple[float, float], ...] = ()

    def stress(self, time_step: float, strain: Array) -> Array:
        """Nominal stress [Pa] of a history of strain that starts from rest."""
        elastic = self.curve.stress(strain)
        if self.drive == "curve":
            drive = elastic
            total = (1.0 - sum(share for share, _ in self.branches)) * elastic
        else:
            drive = float(self.curve.stress(np.array(1.0))) * strain
            total = elastic.copy()
        for share, relaxation_time in self.branches:
            total += share * maxwell(time_step, drive, relaxation_time)
        for stiffness, limit in self.sliders:
            total += stiffness * stop(strain, limit)
        return total

    def instant_slope(self, strain: Array) -> Array:
        """Rough tangent at high rate, to steer an iteration (not part of any truth)."""
        slope = self.curve.slope(strain)
        return slope + sum(stiffness for stiffness, _ in self.sliders) * 0.3

    def constants(self) -> dict[str, object]:
        """Return the constants for the truth file."""
        return {
            "curve": self.curve.family,
            "curve_constants": self.curve.constants,
            "curve_scale_Pa": self.curve.scale,
            "branches_share_and_time_s": [list(pair) for pair in self.branches],
            "branch_drive": self.drive,
            "sliders_stiffness_Pa_and_limit": [list(pair) for pair in self.sliders],
        }


def draw_rubber(rng: np.random.Generator, hysteresis: str, stress_at_one: float) -> Rubber:
    """Draw a rubber: ``hysteresis`` is smooth, kinked or both."""
    curve = draw_curve(rng, stress_at_one)
    branches: tuple[tuple[float, float], ...] = ()
    sliders: tuple[tuple[float, float], ...] = ()
    drive = str(rng.choice(["curve", "line"]))
    if hysteresis in ("smooth", "both"):
        count = int(rng.integers(2, 5))
        times = np.geomspace(0.4, 250.0, count) * rng.uniform(0.6, 1.6, count)
        shares = rng.uniform(0.02, 0.07, count)
        branches = tuple(zip(shares.tolist(), times.tolist(), strict=True))
    if hysteresis in ("kinked", "both"):
        scale = stress_at_one * (1.0 if hysteresis == "kinked" else 0.6)
        if rng.random() < 0.5:  # Coulomb: one slider, one kink after each reversal
            limits = np.array([rng.uniform(0.004, 0.02)])
            yields = np.array([rng.uniform(0.02, 0.05)]) * scale
        else:  # Prandtl-Ishlinskii
            count = int(rng.integers(3, 7))
            limits = np.geomspace(rng.uniform(0.003, 0.008), rng.uniform(0.04, 0.15), count)
            yields = rng.uniform(0.4, 1.0, count) * rng.uniform(0.015, 0.04) * scale / count * 2.0
        sliders = tuple(zip((yields / limits).tolist(), limits.tolist(), strict=True))
    return Rubber(curve, branches, drive, sliders)
