r"""What is known of the errors of a measurement, and what each of them does to a number.

An error that all samples of a test share (a load cell's gain, a tape reading) is no smaller in
the mean of ten cycles.  Each such error is one *component*: a number that is drawn once, with
mean zero and variance one, and moves everything that it touches by its signed *contribution*.
Numbers that name the same component move together, within a test and from test to test.

.. math:: \delta y = \sum_k c_k z_k + r, \qquad u^2(y) = \sum_k c_k^2 + u_r^2(y)

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1, 5.2 and F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields

import numpy as np

from reduction.errors import SettingsError
from reduction.record import Floats, Integers, read_only_arrays

LINE_METHODS = {"not_given": 0, "linear": 1, "monte_carlo": 2}
"""How the uncertainty of a line was found, by its code in `LineSpread`."""


@dataclass(frozen=True)
class InstrumentErrors:
    """Standard uncertainties of the instruments of one specimen; zero where not stated.

    All but those of a reading are of what all samples share.

    Parameters
    ----------
    specimen : str
        Whose tension channel it is.
    tension_gain : float
        Relative, of the load cell and its amplifier. [1]
    tension_offset : float
        Of the zero of the load cell. [N]
    position_gain : float
        Relative, of the crosshead's scale. [1]
    position_offset : float
        Of the crosshead's zero. [m]
    lag : float
        Of the time by which tension is logged late (or early) against position. [s]
    diameter : float
        Of the mean diameter. [m]
    diameter_readings : int
        Readings whose scatter the error of the diameter is; 0 where it is stated. [1]
    strain_gain : float
        Relative, of strain: what the strain method itself may miss. [1]
    rated_break_strength : float
        Relative. [1]
    stiffness : float
        Relative, of the material for the temperature of the test, which is its own. [1]
    test : str
        Which test.
    tension_reading, position_reading : float
        Of a single reading, which no other sample shares. [N], [m]
    tension_instrument, position_instrument : str
        Channels with one name share their gain and offset.
    strain_model : str
        Strain models with one name share the errors of their coefficients.
    """

    specimen: str
    tension_gain: float = 0.0
    tension_offset: float = 0.0
    position_gain: float = 0.0
    position_offset: float = 0.0
    lag: float = 0.0
    diameter: float = 0.0
    diameter_readings: int = 0
    strain_gain: float = 0.0
    rated_break_strength: float = 0.0
    stiffness: float = 0.0
    tension_reading: float = 0.0
    position_reading: float = 0.0
    test: str = ""
    tension_instrument: str = "load cell"
    position_instrument: str = "crosshead"
    strain_model: str = ""

    def __post_init__(self) -> None:
        """Refuse what is no standard uncertainty."""
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, float) and not (np.isfinite(value) and value >= 0):
                raise SettingsError(
                    f"{item.name} of '{self.specimen}' is no standard uncertainty",
                    found=f"{value:g} in SI",
                    needed="zero or more",
                )


@dataclass(frozen=True, order=True)
class Component:
    """One error that is drawn once.

    Parameters
    ----------
    source : str
        What it is called in a budget: ``tension_gain``, ``strain_calibration``, ...
    of : str
        Of which instrument, specimen or model; with `source` it names the error.
    number : int
        Where one source is several independent errors (the coefficients of a fit). [1]
    degrees_of_freedom : float
        Of its standard uncertainty: infinite where that is stated, few where it is the scatter of
        a few readings. It does not tell two errors apart. [1]
    """

    source: str
    of: str
    number: int = 0
    degrees_of_freedom: float = field(default=math.inf, compare=False)


@dataclass(frozen=True)
@read_only_arrays
class Contributions:
    """What each component adds to some quantities.

    Parameters
    ----------
    component : tuple of Component, length n_components
        Each once.
    values : dict of str to ndarray
        By name of the quantity: shape (n_components, ...) before the axes of the quantity;
        the error that one standard deviation of the component makes, with its sign. [as quantity]
    """

    component: tuple[Component, ...]
    values: dict[str, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check that every quantity has a row for each component, and make arrays read-only."""
        if len(set(self.component)) != len(self.component):
            raise SettingsError("a component stands twice among the contributions")
        for name, rows in self.values.items():
            rows.setflags(write=False)
            if rows.shape[:1] != (len(self.component),):
                raise SettingsError(
                    f"contributions to {name} do not fit their components",
                    found=f"shape {rows.shape}",
                    needed=f"({len(self.component)}, ...)",
                )

    @property
    def degrees_of_freedom(self) -> Floats:
        """Of the standard uncertainty of each component, shape (n_components,). [1]."""
        return np.array([one.degrees_of_freedom for one in self.component])

    def shared_standard_uncertainty(self, name: str) -> Floats:
        """Root of the sum of squares over the components, in the shape of the quantity."""
        return np.asarray(np.sqrt(np.sum(self.values[name] ** 2, axis=0)))


@dataclass(frozen=True)
@read_only_arrays
class LineSpread:
    """Uncertainty and 95 % interval of K_1, tau and N of a test, and how they were found.

    Parameters
    ----------
    method : ndarray of int, shape (n_specimens,)
        Of `LINE_METHODS`: linear where Monte Carlo agrees within 5 %, else Monte Carlo. [1]
    without_solution_share : ndarray, shape (n_specimens,)
        Of the draws. [1]
    standard_uncertainty, low, high : dict of str to ndarray, each of shape (n_specimens,)
        By name of the parameter; NaN where not given. [N], [s], [N s]
    """

    method: Integers
    without_solution_share: Floats
    standard_uncertainty: dict[str, Floats]
    low: dict[str, Floats]
    high: dict[str, Floats]
