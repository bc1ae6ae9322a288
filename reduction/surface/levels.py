r"""Levels of the factors of an experiment, and what each run is to be set to.

A level is in SI, a fraction of the rated break strength, or (an amplitude) a fraction
of the run's mean tension.

References
----------
.. [1] CG-D-39-80, Tables 1, 2 and A-1 (levels in per cent of break strength), App. C
   (coding).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError, SettingsError
from reduction.record import Floats
from reduction.surface.coding import engineering_from_coded

LevelBasis = Literal["absolute", "rated_break_strength", "mean_tension"]

LOADS = ("mean_tension", "tension_amplitude")
ABOVE_ZERO = ("frequency", *LOADS)


@dataclass(frozen=True)
class FactorLevels:
    """Low and high level of one factor; the centre is half way.

    Parameters
    ----------
    name : str
        ``frequency``, ``mean_tension``, ``tension_amplitude``, or any other name.
    low, high : float
        Levels at -1 and +1: in SI, or the fraction that ``basis`` names.
    basis : str
        ``absolute``: SI; ``rated_break_strength``: a fraction of it, so 12 % is 0.12;
        ``mean_tension``: a fraction of the mean tension of the same run, for
        ``tension_amplitude`` alone. [1]
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
        raise SettingsError("a factor stands twice", found=", ".join(twice), needed="each once")


def engineering_levels(
    coded: ArrayLike,
    factors: tuple[FactorLevels, ...],
    *,
    rated_break_strength: ArrayLike | None = None,
) -> Floats:
    r"""What each run is set to, in SI.

    .. math:: \text{level} = \frac{h + l}{2} + X\,\frac{h - l}{2}

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        Coded levels, usually of a `Design`. [1]
    factors : tuple of FactorLevels, length n_factors
        In the order of the columns.
    rated_break_strength : array_like, shape () or (n_runs,), optional
        Needed where a factor is a fraction of it; one a run where the line differs
        from run to run (two diameters in one screening). [N]

    Returns
    -------
    levels : ndarray, shape (n_runs, n_factors)
        Levels of each run in SI; a fraction has become a tension. [SI unit of each factor]

    Raises
    ------
    SettingsError
        If the factors do not fit the design or stand twice, or a fraction has nothing
        that it is a fraction of.
    DataError
        If the coded levels or the break strength are not finite numbers, or do not fit.

    Notes
    -----
    Source: [1]_, Appendix C, solved for the level.  With the amplitude as a fraction of
    the mean tension no run reaches zero tension, but the amplitude in newtons is then a
    product of two factors: a surface is to be fitted in the fraction.

    Examples
    --------
    Nylon double braid 1/2 in of [1]_, break strength 6400 lb: 768 to 1920 lb, mean 1344.

    >>> mean = FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength")
    >>> print(engineering_levels([[-1.0], [0.0], [1.0]], (mean,), rated_break_strength=6400)[:, 0])
    [ 768. 1344. 1920.]
    """
    runs = as_finite("coded", coded)
    if runs.ndim != 2:
        raise DataError(
            "the coded levels are not a table of runs",
            found=f"shape {runs.shape}",
            needed="one row a run, one column a factor",
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
