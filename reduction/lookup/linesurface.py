"""A quadratic surface of a line that can be looked up.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.errors import DataError
from reduction.record import Floats, Integers, read_only_arrays
from reduction.uncertainty.product import Component


@dataclass(frozen=True)
@read_only_arrays
class LineSurface:
    """A quadratic surface of one quantity over coded factors.

    Parameters
    ----------
    quantity : str
        Of the vocabulary.
    coefficient : ndarray, shape (n_terms,)
        Coded units, on the scale of ``exponent``. [unit of the quantity]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    low, high : ndarray, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]
    covariance_factor : ndarray, shape (n_terms, n_terms)
        Covariance of the coefficients over sigma squared. [1]
    sigma : float
        Standard deviation of a run about the surface; NaN where not known. [as coefficient]
    degrees_of_freedom : float
        Of sigma. [1]
    greatest_leverage : float
        Of any run: where a point has more, nothing was tested. [1]
    exponent : float
        Of Box and Cox; 1 where the quantity was fitted as it is, 0 for its logarithm. [1]
    component : tuple of Component, length n_components
        Errors that the runs share; none where nothing is known of any.
    contribution : ndarray, shape (n_components, n_terms)
        What each error that the runs share adds to the coefficients, signed. [as coefficient]
    alternatives : ndarray, shape (n_alternatives, n_terms)
        Other coefficients that may be the right ones, where that is open: an interval spans
        them all. [as coefficient]
    alternative_boxes : tuple of (low, high)
        Other levels that may be the right ones, as ``low`` and ``high``: an interval spans those
        too. [SI unit of each factor]
    rounding : ndarray, shape (n_factors,)
        Half the last digit of the levels as printed, within which a point is inside; empty where
        they are exact. [SI unit of each factor]
    line_scatter : float
        Standard deviation between lines of the kind over their mean; NaN where not known. [1]
    n_lines : float
        That the surface is of; NaN where not known. [1]
    errata : tuple of str
        Ids that touch it.
    notes : tuple of str
        What is open, what fails, what else to know.
    """

    quantity: str
    coefficient: Floats
    exponents: Integers
    low: Floats
    high: Floats
    covariance_factor: Floats
    sigma: float
    degrees_of_freedom: float
    greatest_leverage: float
    exponent: float = 1.0
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))
    alternatives: Floats = field(default_factory=lambda: np.empty((0, 0)))
    alternative_boxes: tuple[tuple[Floats, Floats], ...] = ()
    rounding: Floats = field(default_factory=lambda: np.empty(0))
    line_scatter: float = float("nan")
    n_lines: float = float("nan")
    errata: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check that terms and factors pair up, and make the arrays read-only."""
        n_terms, n_factors = self.exponents.shape
        shapes = {
            "coefficient": (n_terms,),
            "low": (n_factors,),
            "high": (n_factors,),
            "covariance_factor": (n_terms, n_terms),
        } | ({"rounding": (n_factors,)} if self.rounding.size else {})
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise DataError(
                    f"{name} does not fit the surface", found=str(found), needed=str(shape)
                )
        if len(self.component) != len(self.contribution):
            raise DataError(
                "contributions to a surface do not pair up with the errors that the runs share",
                found=f"{len(self.contribution)} rows",
                needed=str(len(self.component)),
            )
