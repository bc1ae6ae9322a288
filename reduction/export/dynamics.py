"""Stiffness that depends on how fast a line is pulled, and on how far it once was.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4.
.. [2] MoorDyn documentation, "Input Files", v2.7.1, 2026, on the Syrope model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.digits import plain_number
from reduction.errors import SettingsError
from reduction.line.model import apparent_spring_constant, hysteresis_energy
from reduction.record import Floats, read_only_arrays

_STEPS = 201


@dataclass(frozen=True)
class Viscoelasticity:
    """A spring K_0 beside a spring K_1 in series with a dashpot: three parameters of [1]_.

    Parameters
    ----------
    static_stiffness : float
        Of a slow pull, K_0, per unit strain: EA_s of mooring codes. [N]
    dynamic_stiffness : float
        Of a fast change, K_0 + K_1: EA_d; where it grows with the mean tension, its value at zero
        mean tension (alpha). [N]
    dashpot_coefficient : float
        N = K_1 tau. [N s]
    dynamic_stiffness_per_mean_tension : float
        beta: EA_d = alpha + beta T_mean. [1]
    mean_tension : float
        At which the numbers hold; needed where beta is not zero. [N]
    holds : str
        In words: levels at which the numbers were found.
    frequency : float
        At which they were found; NaN where they hold at every one. [Hz]
    growth : str
        In words: how beta was found, or why it is zero.
    """

    static_stiffness: float
    dynamic_stiffness: float
    dashpot_coefficient: float
    dynamic_stiffness_per_mean_tension: float = 0.0
    mean_tension: float = math.nan
    holds: str = ""
    frequency: float = math.nan
    growth: str = ""

    def __post_init__(self) -> None:
        """Check that the line is stiffer when it is fast."""
        numbers = (self.static_stiffness, self.dynamic_stiffness, self.dashpot_coefficient)
        slope = self.dynamic_stiffness_per_mean_tension
        if not all(map(math.isfinite, (*numbers, slope))) or min(*numbers, slope) < 0:
            raise SettingsError(
                "stiffness and damping of a line are not numbers of at least zero",
                found=", ".join(plain_number(value, 6) for value in (*numbers, slope)),
            )
        if slope and not self.mean_tension >= 0:
            raise SettingsError(
                "a dynamic stiffness that grows with the mean tension has no mean tension",
                needed="the mean tension at which the damping was found",
            )
        if not self.fast_stiffness > self.static_stiffness > 0:
            raise SettingsError(
                "the dynamic stiffness is not above the static one",
                found=f"{plain_number(self.fast_stiffness, 6)} N and "
                f"{plain_number(self.static_stiffness, 6)} N",
                needed="a static stiffness above zero and a dynamic one above that",
            )

    @property
    def fast_stiffness(self) -> float:
        """EA_d at the mean tension, K_0 + K_1. [N]."""
        slope = self.dynamic_stiffness_per_mean_tension
        return self.dynamic_stiffness + (slope * self.mean_tension if slope else 0.0)

    @property
    def relaxation_time(self) -> float:
        """Of the tension at constant strain, tau = N / K_1. [s]."""
        return self.dashpot_coefficient / (self.fast_stiffness - self.static_stiffness)

    @property
    def apparent_stiffness(self) -> float:
        """Of a cycle, for a code without damping: K_ap at the frequency, else EA_d. [N]."""
        known = math.isfinite(self.frequency)
        return self.apparent_stiffness_at(self.frequency) if known else self.fast_stiffness

    def apparent_stiffness_at(self, frequency: float) -> float:
        """Tension amplitude over strain amplitude, K_ap, at a frequency in Hz. [N]."""
        return float(apparent_spring_constant(**self._three, frequency=frequency))

    def hysteresis_energy_at(self, frequency: float, amplitude: float) -> float:
        """Energy of a cycle, H, at a frequency in Hz and a tension amplitude in N. [J m-1]."""
        found = hysteresis_energy(**self._three, frequency=frequency, tension_amplitude=amplitude)
        return float(found)

    @property
    def _three(self) -> dict[str, float]:
        return {
            "quasi_static_spring_constant": self.static_stiffness,
            "dissipation_spring_constant": self.fast_stiffness - self.static_stiffness,
            "relaxation_time": self.relaxation_time,
        }

    @property
    def slow_dashpot_coefficient(self) -> float:
        r"""Dashpot of the same line as a spring in series with a spring beside a dashpot. [N s].

        Mooring codes put the slow spring :math:`E_1` and its dashpot :math:`B` in series with
        :math:`EA_d`; equal static stiffness asks for :math:`1/EA_s = 1/E_1 + 1/EA_d`, equal
        behaviour at every frequency for :math:`B = N (EA_d / (EA_d - EA_s))^2`.
        """
        share = self.fast_stiffness / (self.fast_stiffness - self.static_stiffness)
        return self.dashpot_coefficient * share**2


@dataclass(frozen=True)
@read_only_arrays
class Syrope:
    """Working curves of a fibre rope that remembers its greatest mean tension.

    Parameters
    ----------
    strain, tension : ndarray, shape (n_points,)
        Original working curve, from 0 0. [1], [N]
    form : {"LINEAR", "QUADRATIC", "EXP"}
        Of the working curves below it.
    k1, k2 : float
        LINEAR: k1 below 1 is the strain at zero tension over that at the greatest one, from 1 on
        the slope; k2 is not used. QUADRATIC: 0 <= k1 < 1, 0 < k2 <= 1. EXP: 0 <= k1 < 1, k2 > 0.
        [1], [N]
    dynamic_stiffness, dynamic_stiffness_per_mean_tension : float
        alpha and beta of EA_d = alpha + beta T_mean. [N], [1]
    slow_damping, fast_damping : float
        Dashpots of the slow and of the fast spring. [N s]
    greatest_mean_tension, mean_tension : float
        Where the line starts: without them MoorDyn ends with a segmentation fault. [N]
    """

    strain: Floats
    tension: Floats
    form: Literal["LINEAR", "QUADRATIC", "EXP"]
    k1: float
    k2: float
    dynamic_stiffness: float
    dynamic_stiffness_per_mean_tension: float
    slow_damping: float
    fast_damping: float
    greatest_mean_tension: float
    mean_tension: float

    def __post_init__(self) -> None:
        """Check what MoorDyn does not."""
        allowed = {
            "LINEAR": (0 < self.k1, "k1 above 0"),
            "QUADRATIC": (0 <= self.k1 < 1 and 0 < self.k2 <= 1, "0 <= k1 < 1 and 0 < k2 <= 1"),
            "EXP": (0 <= self.k1 < 1 and self.k2 > 0, "0 <= k1 < 1 and k2 above 0"),
        }
        if self.form not in allowed:
            raise SettingsError(
                "the form of a Syrope working curve is not known",
                found=repr(self.form),
                needed=", ".join(allowed),
            )
        is_allowed, needed = allowed[self.form]
        if not is_allowed:
            raise SettingsError(
                f"a Syrope working curve of the form {self.form} cannot have these parameters",
                found=f"k1 {self.k1:g}, k2 {self.k2:g}",
                needed=needed,
            )
        if not 0 < self.mean_tension <= self.greatest_mean_tension <= self.tension[-1]:
            raise SettingsError(
                "the tensions that a Syrope line starts from do not fit its original working curve",
                found=f"mean {self.mean_tension:g} N, greatest mean {self.greatest_mean_tension:g} "
                f"N, end of the curve {self.tension[-1]:g} N",
                needed="0 < mean <= greatest mean <= end of the curve",
            )
        alpha, beta = self.dynamic_stiffness, self.dynamic_stiffness_per_mean_tension
        if not (alpha > 0 and beta >= 0 and self.slow_damping > 0 and self.fast_damping >= 0):
            raise SettingsError(
                "stiffness and damping of a Syrope line are out of range",
                needed="alpha and slow damping above 0, beta and fast damping at least 0",
            )
        elastic = np.log1p(beta / alpha * self.tension) / beta if beta else self.tension / alpha
        steps = np.diff(self.strain - elastic)
        if np.any(steps <= 0):
            first = int(np.argmax(steps <= 0))
            raise SettingsError(
                "the original working curve is stiffer than the dynamic stiffness: its slow part "
                "would shrink as the tension grows",
                found=f"between strains {self.strain[first]:g} and {self.strain[first + 1]:g}",
                needed="alpha + beta T above the slope of the curve",
            )

        self._refuse_stiff_working_curve()

    def _refuse_stiff_working_curve(self) -> None:
        """MoorDyn starts such a line at another tension, without a word."""
        along = np.linspace(0.0, 1.0, _STEPS)
        top = float(np.interp(self.greatest_mean_tension, self.tension, self.strain))
        share, slope = along, np.ones(_STEPS)
        if self.form == "EXP":
            share = np.expm1(self.k2 * along) / math.expm1(self.k2)
            slope = self.k2 * np.exp(self.k2 * along) / math.expm1(self.k2)
        elif self.form == "QUADRATIC":
            share = along * (1 - self.k2 + self.k2 * along)
            slope = 1 - self.k2 + 2 * self.k2 * along
        if self.form == "LINEAR" and self.k1 >= 1:
            slope = slope * self.k1
        else:
            slope = slope * self.greatest_mean_tension / (top * (1 - self.k1))
        load = share * self.greatest_mean_tension
        fast = self.dynamic_stiffness + self.dynamic_stiffness_per_mean_tension * load
        if np.any(slope >= fast):
            first = int(np.argmax(slope >= fast))
            raise SettingsError(
                "the working curve is stiffer than the dynamic stiffness: its slow part would "
                "shrink as the tension grows",
                found=f"{plain_number(slope[first])} N at {plain_number(load[first])} N, "
                f"dynamic {plain_number(fast[first])} N",
                needed="a smaller k1, or a less bent form",
            )

    @property
    def initial_strain(self) -> float:
        """Strain at the mean tension, on the working curve of the greatest one. [1]."""
        top = float(np.interp(self.greatest_mean_tension, self.tension, self.strain))
        share = self.mean_tension / self.greatest_mean_tension
        if self.form == "LINEAR" and self.k1 >= 1:
            return top - (self.greatest_mean_tension - self.mean_tension) / self.k1
        if self.form == "EXP":
            share = math.log1p(share * math.expm1(self.k2)) / self.k2
        elif self.form == "QUADRATIC":
            # k2 x^2 + (1 - k2) x = T / T_max
            rest = 1 - self.k2
            share = (math.sqrt(rest**2 + 4 * self.k2 * share) - rest) / (2 * self.k2)
        return top * (self.k1 + share * (1 - self.k1))
