"""What CG-D-39-80 says of one line, in SI, with what is open and what is lost.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
class OpenTerm:
    """A coefficient of which nothing says what is right.

    ``values`` are those that are printed, in SI, in the order of ``tables``; two open terms of
    one curve go together by that order.
    """

    term: str
    index: int
    values: tuple[float, ...]
    tables: tuple[str, ...]
    erratum: str
    note: str


@dataclass(frozen=True)
class LevelBox:
    """Levels at -1 and +1: the range of use, and the scale of the coded coefficients.

    Parameters
    ----------
    frequency, mean_tension, tension_amplitude : tuple of float
        Low and high; the amplitude is half the range. [Hz], [N], [N]
    rated_break_strength : float
        That the levels are shares of. [N]
    table : str
        That prints them.
    """

    frequency: tuple[float, float]
    mean_tension: tuple[float, float]
    tension_amplitude: tuple[float, float]
    rated_break_strength: float
    table: str


@dataclass(frozen=True)
@read_only_arrays
class PublishedSurface:
    """Response surface of a line: eq. 5 of [1]_ in coded factors.

    Parameters
    ----------
    response : str
        Name in the vocabulary.
    coefficient : ndarray, shape (10,)
        B1 .. B10: mean, squares, linear, interactions of frequency, mean tension and tension
        amplitude; NaN where open. [N], of relaxation time [s]
    open_terms : tuple of OpenTerm
        What stands in the place of NaN.
    boxes : tuple of LevelBox
        One; two where the levels are open, the better supported first.
    r2 : float
        NaN where open.
    passes_f_test : bool
        At 5 %, with 9 and 5 degrees of freedom.
    n_lines : int or None
        Lines tested; None where no table says, or tables disagree.
    tables, errata : tuple of str
        Where the column is printed, and what touches it.
    """

    response: str
    coefficient: Floats
    open_terms: tuple[OpenTerm, ...]
    boxes: tuple[LevelBox, ...]
    r2: float
    passes_f_test: bool
    n_lines: int | None
    tables: tuple[str, ...]
    errata: tuple[str, ...]


@dataclass(frozen=True)
@read_only_arrays
class PublishedCubic:
    """Cubic of tension: K_0, or strain.

    Parameters
    ----------
    quantity : str
        ``quasi_static_spring_constant`` or ``quasi_static_strain``.
    coefficient : ndarray, shape (4,)
        A, B, C, D; NaN where open. [N N-k] or [N-k]
    open_terms : tuple of OpenTerm
        What stands in the place of NaN.
    tension_high : float
        End of the range of use, which begins at zero; the smaller where tables differ, NaN where
        open. [N]
    n_samples : int or None
        Pulls.
    tables, errata : tuple of str
        Where it is printed, and what touches it.
    note : str
        Of which lines, where the row is of several.
    """

    quantity: str
    coefficient: Floats
    open_terms: tuple[OpenTerm, ...]
    tension_high: float
    n_samples: int | None
    tables: tuple[str, ...]
    errata: tuple[str, ...]
    note: str


@dataclass(frozen=True)
class StatedStrength:
    """One statement of a strength; there are several for most lines, and they differ."""

    value: float
    table: str
    what: str
    erratum: str


@dataclass(frozen=True)
class PublishedStrength:
    """Breaks of a line; NaN and None where not printed, or open.

    Parameters
    ----------
    tensile_strength, tensile_strength_standard_deviation : float
        [N]
    strain_at_failure, strain_at_failure_standard_deviation : float
        [1]
    n_samples : int or None
        Breaks.
    table : str
        Where they are printed.
    errata : tuple of str
        What touches them.
    """

    tensile_strength: float
    tensile_strength_standard_deviation: float
    strain_at_failure: float
    strain_at_failure_standard_deviation: float
    n_samples: int | None
    table: str
    errata: tuple[str, ...]


@dataclass(frozen=True)
class PublishedLine:
    """One line in one condition.

    Parameters
    ----------
    name : str
        ``nylon-double-braid-0.5in-new``.
    material, construction, condition : str
        In the words of the tables: ``nylon``, ``8-strand plaited``, ``4 years``.
    diameter : float
        Nominal. [m]
    rated_break_strength : float
        That the tested levels are shares of, or, for a line without, the measured one; of the
        better supported two where that is open. [N]
    stated_strengths : tuple of StatedStrength
        Everything that is printed as strength of the new line.
    surfaces : mapping of str to PublishedSurface
        By response.
    stiffness : PublishedCubic or None
        K_0 against mean tension.
    load_strain : PublishedCubic or None
        Strain against tension, whose slope is 1/K_0.
    strength : PublishedStrength or None
        Breaks.
    absent : mapping of str to str
        Why a response, ``quasi_static_spring_constant``, ``quasi_static_strain`` or
        ``tensile_strength`` is not there.
    """

    name: str
    material: str
    construction: str
    diameter: float
    condition: str
    rated_break_strength: float
    stated_strengths: tuple[StatedStrength, ...]
    surfaces: Mapping[str, PublishedSurface]
    stiffness: PublishedCubic | None
    load_strain: PublishedCubic | None
    strength: PublishedStrength | None
    absent: Mapping[str, str]

    @property
    def errata(self) -> tuple[str, ...]:
        """Everything that touches a number of the line, in the order of the ids."""
        parts = [*self.surfaces.values(), self.stiffness, self.load_strain, self.strength]
        found = {one for part in parts if part is not None for one in part.errata}
        found |= {one.erratum for one in self.stated_strengths if one.erratum}
        return tuple(sorted(found, key=lambda one: int(one.partition("-")[2])))
