r"""What certificates and data sheets say, as standard uncertainties.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.3.3 (expanded), 4.3.7 (rectangular), 4.3.9 (triangular), F.2.2.1 (resolution).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

import numpy as np

from reduction.checks import as_positive
from reduction.errors import SettingsError
from reduction.uncertainty.product import InstrumentErrors

Shape = Literal["rectangular", "triangular", "arcsine"]
_SHAPE: dict[Shape, float] = {
    "rectangular": np.sqrt(3),
    "triangular": np.sqrt(6),
    "arcsine": np.sqrt(2),
}


def of_half_width(half_width: float, shape: Shape = "rectangular") -> float:
    """Standard uncertainty of limits.

    Parameters
    ----------
    half_width : float
        The error lies within plus or minus this. [any]
    shape : {"rectangular", "triangular", "arcsine"}
        How it is spread between the limits; rectangular where nothing is known.

    Returns
    -------
    standard_uncertainty : float
        [as half_width]

    Raises
    ------
    SettingsError
        If the shape is not known.

    Notes
    -----
    [1]_, 4.3.7 and 4.3.9; arcsine is that of something that swings.

    Examples
    --------
    >>> print(round(of_half_width(0.3), 4), round(of_half_width(0.3, "triangular"), 4))
    0.1732 0.1225
    """
    if shape not in _SHAPE:
        raise SettingsError(
            "the shape of an error is not known", found=shape, needed=" or ".join(_SHAPE)
        )
    return half_width / float(_SHAPE[shape])


def of_expanded(expanded: float, coverage_factor: float) -> float:
    """Standard uncertainty of an expanded one.

    Parameters
    ----------
    expanded : float
        As a certificate prints it. [any]
    coverage_factor : float
        Its k. [1]

    Returns
    -------
    standard_uncertainty : float
        [as expanded]

    Raises
    ------
    DataError
        If k is not positive.

    Notes
    -----
    [1]_, 4.3.3.

    Examples
    --------
    >>> of_expanded(0.002, 2.0)
    0.001
    """
    as_positive("coverage_factor", coverage_factor)
    return expanded / coverage_factor


def of_resolution(resolution: float) -> float:
    """Standard uncertainty of a last digit.

    Parameters
    ----------
    resolution : float
        One step of the indication. [any]

    Returns
    -------
    standard_uncertainty : float
        [as resolution]

    Raises
    ------
    DataError
        Never.

    Notes
    -----
    [1]_, F.2.2.1: half a step to either side, all equally likely.

    Examples
    --------
    >>> print(round(of_resolution(0.1), 4))
    0.0289
    """
    return resolution / float(np.sqrt(12))


@dataclass(frozen=True)
class StatedErrors:
    """Standard uncertainties that a campaign states; zero where it says nothing.

    Parameters
    ----------
    tension_gain, position_gain : float
        Relative. [1]
    tension_offset, tension_reading : float
        Of the zero, and of a single reading (noise and resolution). [N]
    position_offset, position_reading : float
        The same of the crosshead. [m]
    lag : float
        [s]
    diameter : float
        Of the mean diameter of a specimen. [m]
    strain_gain, rated_break_strength, stiffness : float
        Relative: of the strain method, of the break strength, and of the stiffness for the
        temperature of the test. [1]
    has_one_load_cell : bool
        All tension channels share the errors of one load cell.
    """

    tension_gain: float = 0.0
    tension_offset: float = 0.0
    tension_reading: float = 0.0
    position_gain: float = 0.0
    position_offset: float = 0.0
    position_reading: float = 0.0
    lag: float = 0.0
    diameter: float = 0.0
    strain_gain: float = 0.0
    rated_break_strength: float = 0.0
    stiffness: float = 0.0
    has_one_load_cell: bool = False

    @property
    def has_any(self) -> bool:
        """True where an error is stated at all."""
        return any(getattr(self, item.name) for item in fields(self) if item.type == "float")

    def of_channel(
        self,
        specimen: str,
        *,
        channel: int,
        test: str,
        load_cell: str = "",
        machine: str = "",
        strain_model: str = "",
    ) -> InstrumentErrors:
        """What they are for one specimen of one test; channels count from 1."""
        return InstrumentErrors(
            specimen=specimen,
            test=test,
            tension_gain=self.tension_gain,
            tension_offset=self.tension_offset,
            position_gain=self.position_gain,
            position_offset=self.position_offset,
            lag=self.lag,
            diameter=self.diameter,
            strain_gain=self.strain_gain,
            rated_break_strength=self.rated_break_strength,
            stiffness=self.stiffness,
            tension_reading=self.tension_reading,
            position_reading=self.position_reading,
            tension_instrument=self.load_cell_name(load_cell, channel=channel),
            position_instrument=machine or "crosshead",
            strain_model=strain_model or specimen,
        )

    def load_cell_name(self, load_cell: str, *, channel: int) -> str:
        """By which tests share the errors of a load cell; channels count from 1."""
        cell = load_cell or "load cell"
        return cell if self.has_one_load_cell else f"{cell}, channel {channel}"
