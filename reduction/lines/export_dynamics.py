r"""K_0, K_1 and tau of an exported line, consistent with its K_ap and H.

**Uncertainty of K_1 and tau of an exported line, from K_ap, H and K_0 of one set of runs**:

.. math:: w^2(y) = \sum_i (s_i w_i)^2 + 1.96^2 \sum_k \Bigl(\sum_i s_i c_{ik}\Bigr)^2

over the inputs i with the half width w_i of each alone, the contribution c_ik of each error that
they share, and the sensitivity s_i of the parameter.  A load cell affects all three: its gain
enters K_1 in full and leaves tau unchanged.

**K_0, K_1 and tau of a line for export, such that the line reproduces its own K_ap and H.** K_1 and
tau have separate surfaces in [1]_, fitted to the values identified in each run.  These are a second
fit of the runs of K_ap and H, and the two do not agree: over the tested levels of the printed
lines, K_ap from K_1 and tau is 0.7 to 2.3 times K_ap from its own surface.  K_ap and H were
measured, so K_1 and tau are identified from them at the requested point.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4; eqs. 1-4, Tables 3-19.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from reduction.lines.bent_loops import constant_of_cycles
from reduction.lines.line_curve import own_half_width, shared_half_width, shared_of
from reduction.lines.line_levels import SAME_LEVEL
from reduction.lines.line_lookup import look_up
from reduction.lines.lookup_product import DesignValues, LineSource
from reduction.quantities.digits import plain_number
from reduction.record.contributions import Contributions
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, read_only_arrays
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    apparent_spring_constant,
    hysteresis_energy,
    identify_by_amplitude,
)
from reduction.stages.three_parameter_line.line_product import REASONS, LineParameters
from reduction.uncertainty.propagation import line_contributions

_STEPS = 201

_SLOPE = 1e-4  # share of a mean tension over which the slope of a working curve is taken


@dataclass(frozen=True)
class Viscoelasticity:
    """A spring K_0 beside a spring K_1 in series with a dashpot: the three parameters of [1]_.

    Parameters
    ----------
    static_stiffness : float
        Stiffness of a slow pull, K_0, per unit strain: EA_s of mooring codes. [N]
    dynamic_stiffness : float
        Stiffness for a fast change, K_0 + K_1: EA_d; where it grows with the mean tension, its
        value at zero mean tension (alpha). [N]
    dashpot_coefficient : float
        N = K_1 tau. [N s]
    dynamic_stiffness_per_mean_tension : float
        beta: EA_d = alpha + beta T_mean. [1]
    mean_tension : float
        Mean tension at which the numbers hold; needed where beta is not zero. [N]
    holds : str
        Levels at which the numbers were found, in words.
    frequency : float
        Frequency at which they were found; NaN where they hold at every one. [Hz]
    growth : str
        How beta was found, or why it is zero, in words.
    tension_amplitude : float
        Amplitude at which they were found; NaN where they hold at every one. [N]
    """

    static_stiffness: float
    dynamic_stiffness: float
    dashpot_coefficient: float
    dynamic_stiffness_per_mean_tension: float = 0.0
    mean_tension: float = math.nan
    holds: str = ""
    frequency: float = math.nan
    growth: str = ""
    tension_amplitude: float = math.nan

    def __post_init__(self) -> None:
        """Check that the line is stiffer in fast changes."""
        numbers = (self.static_stiffness, self.dynamic_stiffness, self.dashpot_coefficient)
        slope = self.dynamic_stiffness_per_mean_tension
        if not all(map(math.isfinite, (*numbers, slope))) or min(*numbers, slope) < 0:
            raise SettingsError(
                "stiffness and damping of a line must be zero or positive",
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
        """Relaxation time of the tension at constant strain, tau = N / K_1. [s]."""
        return self.dashpot_coefficient / (self.fast_stiffness - self.static_stiffness)

    @property
    def apparent_stiffness(self) -> float:
        """Cyclic stiffness for a code without damping: K_ap at the frequency, else EA_d. [N]."""
        known = math.isfinite(self.frequency)
        return self.apparent_stiffness_at(self.frequency) if known else self.fast_stiffness

    @property
    def lag(self) -> float:
        """Time by which strain lags tension at the frequency; infinite without one. [s]."""
        if not math.isfinite(self.frequency):
            return math.inf
        stiffness = self.stiffness_at(self.frequency)
        return stiffness.imag / stiffness.real / (2 * math.pi * self.frequency)

    def stiffness_at(self, frequency: float) -> complex:
        """Complex stiffness, tension over strain, at a frequency in Hz. [N]."""
        turned = 2j * math.pi * frequency * self.relaxation_time
        slow, fast = self.static_stiffness, self.fast_stiffness
        return slow + (fast - slow) * turned / (1 + turned)

    def apparent_stiffness_at(self, frequency: float) -> float:
        """Tension amplitude over strain amplitude, K_ap, at a frequency in Hz. [N]."""
        return float(apparent_spring_constant(**self._three, frequency=frequency))

    def hysteresis_energy_at(self, frequency: float, amplitude: float) -> float:
        """Energy of a cycle, H, at a frequency in Hz and a tension amplitude in N. [J m-1]."""
        found = hysteresis_energy(**self._three, frequency=frequency, tension_amplitude=amplitude)
        return float(found)

    def running_stiffness_at(self, frequency: float) -> complex:
        """Complex stiffness where EA_d follows the running slow tension, as in MoorDyn. [N].

        Notes
        -----
        With slow strain x, EA_d = g(x) = alpha + beta EA_1 x and EA_1 = g EA_s / (g - EA_s):
        T = g (e - x) and BA_s dx/dt = g e - (g + EA_1) x, linearised about the mean, where
        EA_1 x is the mean tension.
        """
        slow, fast = self.static_stiffness, self.fast_stiffness
        beta = self.dynamic_stiffness_per_mean_tension
        series = fast * slow / (fast - slow)
        mean = self.mean_tension / slow
        part = self.mean_tension / series
        of_series = -(slow**2) / (fast - slow) ** 2
        growth = beta * series / (1 - beta * of_series * part)
        rate = 2j * math.pi * frequency * self.slow_dashpot_coefficient
        held = rate + fast + series - growth * mean + (1 + of_series) * growth * part
        follows = fast / held
        return fast * (1 - follows) + growth * (mean - part) * follows

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
        :math:`EA_d`; equal static stiffness requires :math:`1/EA_s = 1/E_1 + 1/EA_d`, and equal
        behaviour at every frequency :math:`B = N (EA_d / (EA_d - EA_s))^2`.
        """
        share = self.fast_stiffness / (self.fast_stiffness - self.static_stiffness)
        return self.dashpot_coefficient * share**2


@dataclass(frozen=True)
@read_only_arrays
class Syrope:
    """Working curves of a fibre rope, which depend on its greatest mean tension so far.

    Parameters
    ----------
    strain, tension : ndarray, shape (n_points,)
        Original working curve, from 0 0. [1], [N]
    form : {"LINEAR", "QUADRATIC", "EXP"}
        Form of the working curves below it.
    k1, k2 : float
        LINEAR: k1 below 1 is the strain at zero tension over that at the greatest tension, k1 from
        1 on is the slope; k2 is unused. QUADRATIC: 0 <= k1 < 1, 0 < k2 <= 1. EXP: 0 <= k1 < 1,
        k2 > 0.
        [1], [N]
    dynamic_stiffness, dynamic_stiffness_per_mean_tension : float
        alpha and beta of EA_d = alpha + beta T_mean. [N], [1]
    slow_damping, fast_damping : float
        Dashpots of the slow and of the fast spring. [N s]
    greatest_mean_tension, mean_tension : float
        Start of the line: without them MoorDyn ends with a segmentation fault. [N]
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
        """Check what MoorDyn does not check."""
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
        """Refuse a line that MoorDyn would silently start at another tension."""
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

    @property
    def about_mean(self) -> Viscoelasticity:
        """Parameters of a small cycle about the mean tension, on the greatest working curve.

        Notes
        -----
        MoorDyn has BA_s dz/dt = (e - e_w) (alpha + beta T_w) on the working curve T_w(e_w), with
        z = e_w - ln(1 + beta T_w / alpha) / beta.  Linearised about the mean, this is a spring EA_d
        in series with a dashpot BA_s beside a spring; both springs together have the slope of the
        working curve.
        """
        step = _SLOPE * self.mean_tension
        strains = [
            replace(self, mean_tension=self.mean_tension + side * step).initial_strain
            for side in (-1, 0)
        ]
        slow = step / (strains[1] - strains[0])
        fast = self.dynamic_stiffness + self.dynamic_stiffness_per_mean_tension * self.mean_tension
        return Viscoelasticity(
            static_stiffness=slow,
            dynamic_stiffness=self.dynamic_stiffness,
            dashpot_coefficient=self.slow_damping * (1 - slow / fast) ** 2,
            dynamic_stiffness_per_mean_tension=self.dynamic_stiffness_per_mean_tension,
            mean_tension=self.mean_tension,
        )


def _said_identified(
    part: Viscoelasticity,
    amplitude: float,
    half: Mapping[str, Floats],
    *,
    is_exact: bool,
    measured_as: str,
) -> str:
    """K_1 and tau, the K_ap and H that they give, and their uncertainty.

    ``half`` are half widths of 95 % by name; ``is_exact`` where K_0 has no known interval.
    """
    spring = part.fast_stiffness - part.static_stiffness
    return (
        f"K_1 {plain_number(spring)} N and tau {plain_number(part.relaxation_time, 4)} s are"
        f" identified from {measured_as} of K_ap and H and from K_0 at these levels: the"
        f" three-parameter line gives back K_ap {plain_number(part.apparent_stiffness)} N and H"
        f" {plain_number(part.hysteresis_energy_at(part.frequency, amplitude), 4)} J/m there"
        + _said_known(half, is_exact=is_exact)
    )


def _said_known(half: Mapping[str, Floats], *, is_exact: bool) -> str:
    """Uncertainty of K_1 and tau; errors shared by K_ap, H and K_0 are shared here."""
    spring, time = (
        float(half[name]) for name in ("dissipation_spring_constant", "relaxation_time")
    )
    if not (math.isfinite(spring) and math.isfinite(time)):
        return "; K_ap or H has no interval, and so have K_1 and tau none"
    without = ", K_0 taken as exact: it has no interval" if is_exact else ""
    return (
        f"; 95 percent of K_1 +-{plain_number(spring, 3)} N, of tau +-{plain_number(time, 3)}"
        f" s{without}"
    )


def _said_printed(
    rest: float,
    printed: Mapping[str, DesignValues],
    measured: Mapping[str, DesignValues],
    frequency: float,
    amplitude: float,
) -> str:
    """Result of the surfaces of K_1 and tau, with K_0 ``rest``."""
    if not printed:
        return "the source has no surfaces of K_1 and tau that can be used"
    spring, time = (float(one.value) for one in printed.values())
    said = (
        f"the line's own surfaces of K_1 and tau, {plain_number(spring)} N and "
        f"{plain_number(time, 4)} s, are not used"
    )
    if not (spring > 0 and time > 0):
        return f"{said}: they are not above zero"
    part = Viscoelasticity(rest, rest + spring, spring * time, frequency=frequency)
    return f"{said}: they would give {_against(part, measured, amplitude)}"


def _said_instead(
    part: Viscoelasticity, measured: Mapping[str, DesignValues], amplitude: float, reason: int
) -> str:
    """Statement that the printed K_1 and tau are used, and how far off they are."""
    spring = part.fast_stiffness - part.static_stiffness
    return (
        f"DOUBTFUL: K_1 {plain_number(spring)} N and tau {plain_number(part.relaxation_time, 4)} s"
        " are those of the line's own surfaces; none give back K_ap and H there:"
        f" {REASONS[reason]}. They give {_against(part, measured, amplitude)}"
    )


def _against(part: Viscoelasticity, measured: Mapping[str, DesignValues], amplitude: float) -> str:
    model = (part.apparent_stiffness, part.hysteresis_energy_at(part.frequency, amplitude))
    parts = []
    for value, (name, unit), found in zip(
        model, (("K_ap", "N"), ("H", "J/m")), measured.values(), strict=True
    ):
        own = float(found.value)
        share = f", {100 * (value / own - 1):+.1f} percent" if own > 0 else ""
        parts.append(
            f"{name} {plain_number(value)} {unit} where the line has {plain_number(own)}{share}"
        )
    return "; ".join(parts)


def _warnings_of_identified(
    line: LineParameters, half_widths: Mapping[str, Floats], energy: DesignValues
) -> list[str]:
    """Intervals that include zero damping, or are not known."""
    said = []
    if not math.isfinite(float(energy.surface_low)):
        said.append("DOUBTFUL: the uncertainty of the damping is unknown: H has no interval")
    elif float(energy.surface_low) <= 0:
        said.append(
            "DOUBTFUL: the damping may be zero: the 95 percent interval of H, "
            f"{_interval_of(energy)}, includes zero"
        )
    half = float(half_widths["relaxation_time"])
    time = float(line.relaxation_time)
    if half >= time:
        said.append(
            f"DOUBTFUL: the dashpot is poorly known: tau {plain_number(time, 4)} s with a 95 "
            f"percent interval of +-{plain_number(half, 3)} s, from those of K_ap, H and K_0"
        )
    return said


def _warnings_of_printed(time: DesignValues) -> list[str]:
    """The same for a tau that is itself a design value."""
    if not math.isfinite(float(time.surface_low)):
        return ["DOUBTFUL: the uncertainty of the dashpot is unknown: tau has no interval"]
    if float(time.surface_low) <= 0:
        return [
            "DOUBTFUL: the dashpot may be zero: the 95 percent interval of tau, "
            f"{_interval_of(time)}, includes zero"
        ]
    return []


def _said_over_frequency(part: Viscoelasticity, frequencies: Floats, found: DesignValues) -> str:
    """K_ap of the exported line beside the surface, at several frequencies."""
    rows = []
    for row, frequency in enumerate(frequencies):
        model, own = part.apparent_stiffness_at(float(frequency)), float(found.value[row])
        inside = float(found.surface_low[row]) <= model <= float(found.surface_high[row])
        outside = "" if inside or math.isnan(found.surface_low[row]) else ", OUTSIDE its interval"
        share = f" ({100 * (model / own - 1):+.1f} percent{outside})" if own > 0 else ""
        rows.append(
            f"{plain_number(frequency, 3)} Hz {plain_number(model)} against {plain_number(own)}"
            f" N{share}"
        )
    return (
        "one K_1 and tau do not fit every frequency; K_ap of the exported line against the "
        f"surface at this mean tension and amplitude: {', '.join(rows)}"
    )


def _interval_of(found: DesignValues) -> str:
    """The 95 % interval of one surface, in words."""
    if not math.isfinite(float(found.surface_low)):
        return "an interval, which the source does not have"
    return (
        f"{plain_number(float(found.surface_low), 4)} to"
        f" {plain_number(float(found.surface_high), 4)} {found.unit}"
    )


def _said_of_value(found: DesignValues) -> str:
    """Source of one design value."""
    known = math.isfinite(float(found.surface_high))
    is_vague = known and float(found.surface_low) < 0
    of = (
        found.surface_interval_of
        if found.surface_interval_of.startswith(("the tests", "the curve"))
        else "the surface"
    )
    return (
        f"{found.source}: {found.quantity} {plain_number(float(found.value), 6)} {found.unit}, "
        + (f"95 percent of {of} {_interval_of(found)}" if known else "no interval known")
        + (": the interval includes zero" if is_vague else "")
        + (f", errata {', '.join(found.errata)}" if found.errata else "")
        + ("" if found.is_inside else ", OUTSIDE the tested range")
        + (", untested corner" if found.is_untested else "")
    )


_REST_OF_SPREAD = "quasi_static_spring_constant"

_LOOP = ("apparent_spring_constant", "hysteresis_energy")


def _half_widths(
    line: LineParameters, rest: DesignValues, apparent: DesignValues, energy: DesignValues
) -> dict[str, Floats]:
    """Half widths of the 95 % intervals of K_1 and tau identified from three design values.

    Notes
    -----
    First order ([2]_), by the logarithmic derivatives of eqs. 1 and 4 of [1]_.  The levels of a
    design value are true values: amplitude and frequency are exact, and the effect of a wrong load
    cell on them is in the contributions to the surfaces.

    Examples
    --------
    See `tests/unit/test_export_linespread.py`.
    """
    given = {_LOOP[0]: apparent, _LOOP[1]: energy, _REST_OF_SPREAD: rest}
    values: dict[str, Floats] = {name: one.value for name, one in given.items()}
    values |= {name: getattr(line, name) for name in OUTPUTS}
    shared = shared_of(given)
    moved = line_contributions(
        Contributions(shared.component, {name: shared.values[name] for name in _LOOP}),
        Contributions(shared.component, {_REST_OF_SPREAD: shared.values[_REST_OF_SPREAD]}),
        values,
        reading="amplitude",
    )
    slopes = amplitude_sensitivities(
        line.storage_spring_constant, line.loss_spring_constant, rest.value
    )
    own = {name: own_half_width(one, "surface_high") for name, one in given.items()}
    own[_REST_OF_SPREAD] = np.nan_to_num(own[_REST_OF_SPREAD])
    columns = [AMPLITUDE_INPUTS.index(name) for name in given]
    relative = np.stack([own[name] / values[name] for name in given])
    found = {}
    for row, name in enumerate(OUTPUTS):
        alone = values[name] * np.sqrt(np.sum((slopes[row, columns] * relative) ** 2, axis=0))
        found[name] = np.asarray(np.hypot(alone, shared_half_width(moved.values[name])))
    return found


_REST, _APPARENT, _ENERGY = (
    "quasi_static_spring_constant", "apparent_spring_constant", "hysteresis_energy",
)  # fmt: skip

_SPRING, _TIME = "dissipation_spring_constant", "relaxation_time"

_MEANS, _FEWEST_MEANS, _FREQUENCIES = 9, 3, 3

_ROUNDING = 1e-9

Extrapolate = Literal["refuse", "flag"]


@dataclass(frozen=True)
class _LineDynamics:
    """The three parameters at one point, their sources, and doubts about them."""

    part: Viscoelasticity
    sources: tuple[str, ...]
    notes: tuple[str, ...]


def slow_and_waves(
    source: LineSource, levels: Mapping[str, float] | None = None
) -> tuple[float, float, str] | None:
    """K_0, K_ap, and their point in words: the levels, or the middle of the tested range. [N].

    None where a source lacks one of them.
    """
    if not {_REST, _APPARENT} <= set(source.quantities) or _APPARENT not in source.surfaces:
        return None
    surface = source.surfaces[_APPARENT]
    middle = ((surface.low + surface.high) / 2).tolist()
    at = levels or dict(zip(source.factor_names, middle, strict=True))
    if set(at) != {"frequency", "mean_tension", "tension_amplitude"}:
        return None
    rest, apparent = (float(_value(source, name, at, "flag").value) for name in (_REST, _APPARENT))
    if not (rest > 0 and apparent > 0):
        return None
    return rest, apparent, (
        f"{plain_number(at['frequency'], 3)} Hz, {plain_number(at['mean_tension'] / 1e3, 3)} kN +- "
        f"{plain_number(at['tension_amplitude'] / 1e3, 3)} kN"
    )  # fmt: skip


def line_dynamics(
    source: LineSource, levels: Mapping[str, float], extrapolate: Extrapolate = "refuse"
) -> _LineDynamics:
    """Static and dynamic stiffness and dashpot of a line at a frequency, a mean and an amplitude.

    Notes
    -----
    K_1 and tau are identified from K_ap, H and K_0 ([1]_, eqs. 1 and 4 solved at once), as
    `reduction.stages.three_parameter_line.line_model.identify_by_amplitude` does for a run; so the
    exported line reproduces K_ap and H at that point.  Where no such line exists (E' not above
    K_0, or H not above zero), the printed K_1 and tau are used if their K_ap is in the 95 %
    interval of the surface of K_ap.  Their uncertainty is that of this module, since one load cell
    affects K_ap, H and K_0.  The growth with the mean tension is the slope of the least-squares
    line through K_0 + K_1, found in the same way at nine means over the tested range.
    """
    if "mean_tension" not in levels:
        raise SettingsError(
            "static and dynamic stiffness need a mean tension", needed="--mean-tension"
        )
    known = set(source.quantities)

    def values(*names: str) -> dict[str, DesignValues]:
        return {name: _value(source, name, levels, extrapolate) for name in names}

    loop = values(_APPARENT, _ENERGY) if {_APPARENT, _ENERGY} <= known else {}
    rest = _rest_of_cycle(source, loop, levels, extrapolate)
    measured = {} if source.by_fundamental else loop
    printed = values(_SPRING, _TIME) if {_SPRING, _TIME} <= known or not measured else {}
    amplitude, frequency = (
        float(levels.get(name, math.nan)) for name in ("tension_amplitude", "frequency")
    )
    is_identified = False
    if measured:
        line = _identified(rest, measured, levels)
        reason = int(line.reason)
        is_identified = reason == 0
        if is_identified:
            spring = float(line.dissipation_spring_constant)
            half = _half_widths(line, rest, measured[_APPARENT], measured[_ENERGY])
            part = _part(rest, spring, float(line.relaxation_time), levels)
            notes = [
                _said_identified(
                    part,
                    amplitude,
                    half,
                    is_exact=not np.isfinite(rest.surface_high),
                    measured_as="the surfaces" if _APPARENT in source.surfaces else "the tests",
                ),
                _said_printed(float(rest.value), printed, measured, frequency, amplitude),
                *_warnings_of_identified(line, half, measured[_ENERGY]),
            ]
        else:
            part = _instead(source, rest, measured, printed, levels, reason)
            notes = [
                _said_instead(part, measured, amplitude, reason),
                *_warnings_of_printed(printed[_TIME]),
            ]
        notes += [*_over_frequency(source, part, levels), *_over_tests(source, part, levels)]
    else:
        spring, time = (float(one.value) for one in printed.values())
        part = _part(rest, spring, time, levels)
        notes = [
            "K_1 and tau are those of their own surfaces, by the fundamentals of waves that are no"
            " sine; K_ap and H of such waves are those of no three-parameter line in a sine"
            if source.by_fundamental
            else "K_1 and tau are those of the source: it has no K_ap and H for comparison",
            *_warnings_of_printed(printed[_TIME]),
        ]
    slope, growth = _growth(source, levels, part.fast_stiffness, is_identified=is_identified)
    every = (rest, *measured.values(), *printed.values())
    texts = dict.fromkeys(text for found in every for text in found.notes)
    for text in (one for one in texts if one not in source.notes):
        notes.append(f"{', '.join(one.quantity for one in every if text in one.notes)}: {text}")
    if not source.surfaces:
        doubts = dict.fromkeys(text for one in measured.values() for text in one.warnings)
        notes += [f"DOUBTFUL: {text}" for text in doubts]
    part = replace(
        part,
        dynamic_stiffness=part.fast_stiffness - slope * float(levels["mean_tension"]),
        dynamic_stiffness_per_mean_tension=slope,
        growth=growth,
    )
    return _LineDynamics(part, tuple(map(_said_of_value, every)), (*notes, growth))


def _part(
    rest: DesignValues, spring: float, time: float, levels: Mapping[str, float]
) -> Viscoelasticity:
    holds = ", ".join(
        f"{name.replace('_', ' ')} {plain_number(value)}" for name, value in levels.items()
    )
    return Viscoelasticity(
        static_stiffness=float(rest.value),
        dynamic_stiffness=float(rest.value) + spring,
        dashpot_coefficient=spring * time,
        mean_tension=float(levels["mean_tension"]),
        holds=f"{holds} (SI)",
        frequency=levels.get("frequency", math.nan),
        tension_amplitude=levels.get("tension_amplitude", math.nan),
    )


def _value(
    source: LineSource, quantity: str, levels: Mapping[str, Any], extrapolate: Extrapolate
) -> DesignValues:
    """Design value at those levels with which the quantity varies."""
    if quantity in source.surfaces:
        names = source.factor_names
    else:
        rows = [one.variables for one in source.levels if one.quantity == quantity]
        curves = [one.variable for one in source.curves if one.quantity == quantity]
        names = tuple(curves or (name for one in rows for name in one))
    # a pull is a function of the tension, here the mean of the cycles
    given = {
        name: levels["mean_tension"] if name == "tension" else levels[name]
        for name in names
        if name in levels or name == "tension"
    }
    return look_up(source, quantity, extrapolate=extrapolate, **given)


def _rest_of_cycle(
    source: LineSource,
    measured: Mapping[str, DesignValues],
    levels: Mapping[str, Any],
    extrapolate: Extrapolate,
) -> DesignValues:
    """K_0: slope of the pull at the mean tension, or over the cycle where the loops are bent."""
    slope = _value(source, _REST, levels, extrapolate)
    curve = next((one for one in source.curves if one.quantity == _REST), None)
    if curve is None or not measured:
        return slope
    return constant_of_cycles(
        curve,
        slope,
        mean_tension=levels["mean_tension"],
        tension_amplitude=levels["tension_amplitude"],
        apparent_spring_constant=measured[_APPARENT].value,
        hysteresis_energy=measured[_ENERGY].value,
    )


def _identified(
    rest: DesignValues, measured: Mapping[str, DesignValues], levels: Mapping[str, Any]
) -> LineParameters:
    """K_1 and tau from K_ap, H and K_0."""
    return identify_by_amplitude(
        apparent_spring_constant=measured[_APPARENT].value,
        hysteresis_energy=measured[_ENERGY].value,
        tension_amplitude=levels["tension_amplitude"],
        frequency=levels["frequency"],
        quasi_static_spring_constant=rest.value,
    )


def _instead(
    source: LineSource,
    rest: DesignValues,
    measured: Mapping[str, DesignValues],
    printed: Mapping[str, DesignValues],
    levels: Mapping[str, float],
    reason: int,
) -> Viscoelasticity:
    """Printed K_1 and tau, where their K_ap is within the interval of the surface."""
    apparent = measured[_APPARENT]
    why = f"no K_1 and tau of {source.name} give back its K_ap and H there: {REASONS[reason]}"
    numbers = (
        f"K_0 {plain_number(float(rest.value))} N, K_ap {plain_number(float(apparent.value))} N, H "
        f"{plain_number(float(measured[_ENERGY].value), 4)} J/m"
    )
    if not printed:
        raise DataError(why, found=numbers, needed="other levels")
    spring, time = (float(one.value) for one in printed.values())
    if not (spring > 0 and time > 0):
        raise DataError(
            f"{why}; and the printed ones are not positive",
            found=f"K_1 {plain_number(spring, 4)} N, tau {plain_number(time, 4)} s; {numbers}",
            needed="other levels",
        )
    part = _part(rest, spring, time, levels)
    model = part.apparent_stiffness
    if not float(apparent.surface_low) <= model <= float(apparent.surface_high):
        raise DataError(
            f"{why}; and the printed ones give a K_ap different from that of the line",
            found=f"K_ap {plain_number(model)} N; {numbers}",
            needed=_interval_of(apparent),
            hint="Use another level, or export the curve alone, without levels.",
        )
    return part


def _over_frequency(
    source: LineSource, part: Viscoelasticity, levels: Mapping[str, float]
) -> list[str]:
    surface = source.surfaces.get(_APPARENT)
    if surface is None or "frequency" not in source.factor_names:
        return []
    place = source.factor_names.index("frequency")
    frequencies = np.linspace(surface.low[place], surface.high[place], _FREQUENCIES)
    over = {name: np.full(_FREQUENCIES, value) for name, value in levels.items()}
    found = _value(source, _APPARENT, over | {"frequency": frequencies}, "flag")
    return [_said_over_frequency(part, frequencies, found)]


_CYCLE = ("mean_tension", "frequency", "tension_amplitude")


def _over_tests(
    source: LineSource, part: Viscoelasticity, levels: Mapping[str, float]
) -> list[str]:
    """K_ap of the exported line beside tests at this mean, of other amplitudes or frequencies."""
    rows = []
    for one in source.levels:
        if one.quantity != _APPARENT or not set(_CYCLE) == set(one.variables) <= set(levels):
            continue
        asked = np.array([levels[name] for name in one.variables])
        is_alike = np.abs(one.at / asked - 1) <= SAME_LEVEL
        mean, frequency, amplitude = (one.variables.index(name) for name in _CYCLE)
        for row in np.flatnonzero(is_alike[:, mean] & ~is_alike.all(axis=1)):
            at, own = one.at[row], float(one.value[row])
            model = part.apparent_stiffness_at(float(at[frequency]))
            rows.append(
                f"{one.tests[row]} ({plain_number(at[frequency], 3)} Hz, +-"
                f" {plain_number(at[amplitude], 4)} N) {plain_number(model, 4)} against"
                f" {plain_number(own, 4)} N ({100 * (model / own - 1):+.1f} percent)"
            )
    if not rows:
        return []
    return [
        "the exported line has one K_ap at all amplitudes, and one K_1 and tau do not fit every"
        f" frequency; its K_ap against other tests at this mean tension: {', '.join(rows)}"
    ]


def _growth(
    source: LineSource, levels: Mapping[str, float], fast: float, *, is_identified: bool
) -> tuple[float, str]:
    """Slope of K_0 + K_1 over the mean tension with a description; zero if not exported. [1]."""
    surface = source.surfaces.get(_APPARENT if is_identified else _SPRING)
    if surface is not None and "mean_tension" in source.factor_names:
        place = source.factor_names.index("mean_tension")
        low = max(float(surface.low[place]), levels.get("tension_amplitude", 0.0))
        means = np.linspace(low, float(surface.high[place]), _MEANS)
    else:
        means = _tested_means(source, levels)
    if means.size < _FEWEST_MEANS:
        return 0.0, (
            "growth of the dynamic stiffness with the mean tension is not known: it takes tests at "
            f"{_FEWEST_MEANS} means with this frequency and amplitude"
        )
    n_means = means.size
    over = {name: np.full(n_means, value) for name, value in levels.items()} | {
        "mean_tension": means
    }
    total = _totals(source, over, is_identified=is_identified)
    stands = np.isfinite(total)
    if stands.sum() < _FEWEST_MEANS:
        return 0.0, (
            "growth of the dynamic stiffness with the mean tension is not known: K_1 is found at "
            f"{int(stands.sum())} of {n_means} means"
        )
    means, total = means[stands], total[stands]
    slope, start = (float(one) for one in np.polyfit(means, total, 1))
    worst = float(np.abs(slope * means + start - total).max())
    words = (
        f"growth of the dynamic stiffness with the mean tension: {slope:.4g}, a straight line"
        f" through {means.size} of {n_means} means over the tested ones, off by up to"
        f" {plain_number(worst, 3)} N, {100 * worst / fast:.2g} percent of EA_d"
    )
    if slope * np.ptp(means) < _ROUNDING * np.abs(total).max():
        return 0.0, f"{words}; it does not increase, so no slope is exported"
    if fast - slope * levels["mean_tension"] <= 0:
        return 0.0, (
            f"{words}; with it EA_d would be negative at zero tension, so no slope is exported:"
            " the stiffness holds at this mean tension only"
        )
    return slope, words


def _tested_means(source: LineSource, levels: Mapping[str, float]) -> Floats:
    """Mean tensions of the tests that differ from these levels in the mean only. [N]."""
    means: list[float] = []
    for one in source.levels:
        if one.quantity != _APPARENT or "mean_tension" not in one.variables:
            continue
        others = [name for name in one.variables if name != "mean_tension"]
        alike = np.all(
            [
                np.abs(one.at[:, one.variables.index(name)] / levels[name] - 1) <= SAME_LEVEL
                for name in others
            ],
            axis=0,
        )
        means += one.at[alike, one.variables.index("mean_tension")].tolist()
    return np.sort(np.array(means))


def _totals(source: LineSource, over: Mapping[str, Floats], *, is_identified: bool) -> Floats:
    """K_0 + K_1 at points; NaN where there is none. [N]."""
    names = (_APPARENT, _ENERGY) if is_identified or source.by_fundamental else ()
    measured = {name: _value(source, name, over, "flag") for name in names}
    rest = _rest_of_cycle(source, measured, over, "flag")
    if is_identified:
        spring = _identified(rest, measured, over).dissipation_spring_constant
    else:
        spring = _value(source, _SPRING, over, "flag").value
    # a K_0 that is not trusted gives no growth
    return np.where(rest.is_inside, rest.value + spring, np.nan)
