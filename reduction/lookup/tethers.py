"""What a deployed assembly is made of: tethers with their splices, and parts in line with them.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import SettingsError
from reduction.lookup.composite import CompositeCurve
from reduction.record import Floats
from reduction.strain.inverse import with_free_length
from reduction.strain.model import StrainModel


@dataclass(frozen=True)
class Tether:
    """A tether with its splices.

    Parameters
    ----------
    curve : CompositeCurve
        Tension against strain of the free length. [SI]
    model : StrainModel
        How strain and tension give its length, thimble to thimble: the strain correction.
    is_stated : bool
        The splices are stated: no load cell of the tests is in them.
    """

    curve: CompositeCurve
    model: StrainModel
    is_stated: bool = False


@dataclass(frozen=True)
class SeriesPart:
    """A part in line with the tethers.

    Parameters
    ----------
    name : str
        Chain, bridle, swivel, wire ...
    length : float
        Without tension. [m]
    spring_constant : float
        EA, force per unit strain; infinite where it is rigid. [N]
    curve : CompositeCurve or None
        In place of a spring constant.
    """

    name: str
    length: float
    spring_constant: float = float("inf")
    curve: CompositeCurve | None = None

    def __post_init__(self) -> None:
        """Refuse a part that is no part."""
        if not self.length >= 0:
            raise SettingsError(
                f"{self.name} has no length", found=f"{self.length:g} m", needed="zero or above"
            )
        if not self.spring_constant > 0:
            raise SettingsError(
                f"the spring constant of {self.name} is not positive",
                found=f"{self.spring_constant:g} N",
                needed="above zero",
            )

    def length_at(self, tension: ArrayLike) -> Floats:
        """Length [m] at a tension [N]; NaN beyond a curve."""
        load = np.asarray(tension, dtype=np.float64)
        if self.curve is not None:
            return np.asarray(self.length * (1 + self.curve.strain_at(load)))
        return np.asarray(self.length * (1 + load / self.spring_constant))


def equal_tethers(tether: Tether, n_tethers: int) -> tuple[Tether, ...]:
    """Return tethers that are all alike.

    Parameters
    ----------
    tether : Tether
        One of them.
    n_tethers : int
        How many. [1]

    Returns
    -------
    tethers : tuple of Tether
        The same one again and again.

    Raises
    ------
    SettingsError
        If there are none.

    Notes
    -----
    Assemblies of [1]_ have one, four and six (sec. 2.3.2).

    Examples
    --------
    See `reduction.lookup.assembly.assemble`.
    """
    if n_tethers < 1:
        raise SettingsError("an assembly has tethers", found=str(n_tethers), needed="1 or more")
    return (tether,) * n_tethers


def unequal_tethers(tether: Tether, free_length: ArrayLike) -> tuple[Tether, ...]:
    """Return tethers of one material and one kind of splice, cut to lengths of their own.

    Parameters
    ----------
    tether : Tether
        As it was tested.
    free_length : array_like, shape (n_tethers,)
        Relaxed, splice toe to splice toe. [m]

    Returns
    -------
    tethers : tuple of Tether
        In that order.

    Raises
    ------
    DataError
        If a length is not positive, or the strain method knows no splice apart.

    Notes
    -----
    The shortest carries most; a load that all share equally is that of equal lengths.

    Examples
    --------
    See `reduction.lookup.working.worst_sharing`.
    """
    lengths = np.atleast_1d(as_positive("free_length", free_length))
    return tuple(
        replace(tether, model=with_free_length(tether.model, float(length))) for length in lengths
    )
