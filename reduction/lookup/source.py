"""What the pieces of one line or tether are from: its tests, its splices, what is stated of it."""

from __future__ import annotations

from dataclasses import dataclass

from reduction.errors import DataError
from reduction.lookup.composite import CompositeCurve, CompositeRule, composite_curve
from reduction.lookup.pieces import CurvePiece, PieceBranch
from reduction.strain.model import StrainModel

__all__ = ["PieceSource", "compose"]


@dataclass(frozen=True)
class PieceSource:
    """Pieces of one line or tether.

    Parameters
    ----------
    name : str
        Of the line or tether.
    branch : {"ascending", "descending", "mean"}
        Of the cycles.
    pieces : tuple of CurvePiece
        In the order of the tests. [SI]
    model : StrainModel, optional
        How its length follows from strain and tension, where that is known.
    diameter, rated_break_strength : float
        NaN where not stated. [m], [N]
    linear_density, wet_linear_density : float
        In air, and less the displaced water; NaN where not stated. [kg m-1]
    sources : tuple of str
        Where each piece is from.
    notes : tuple of str
        What was left out, and what else to know.
    is_synthetic : bool
        Nothing was tested: the numbers were made.
    """

    name: str
    branch: PieceBranch
    pieces: tuple[CurvePiece, ...]
    model: StrainModel | None = None
    diameter: float = float("nan")
    rated_break_strength: float = float("nan")
    linear_density: float = float("nan")
    wet_linear_density: float = float("nan")
    sources: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False


def compose(source: PieceSource, rule: CompositeRule) -> CompositeCurve:
    """Composite curve of the pieces of a source.

    Parameters
    ----------
    source : PieceSource
        Of one line or tether.
    rule : CompositeRule
        Which kind goes before which.

    Returns
    -------
    curve : CompositeCurve
        From zero. [SI]

    Raises
    ------
    DataError
        If no piece is of a kind that the rule names; names the source.

    Notes
    -----
    See `reduction.lookup.composite.composite_curve`.

    References
    ----------
    .. [1] WHOI-2005-10, as `reduction.lookup.composite`.

    Examples
    --------
    >>> import numpy as np
    >>> at = np.array([0.5, 1.0])
    >>> piece = CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)
    >>> source = PieceSource("tether", "ascending", (piece,))
    >>> print(compose(source, CompositeRule()).tension_at(0.75))
    75.0
    """
    try:
        return composite_curve(source.pieces, rule=rule)
    except DataError as error:
        raise DataError(
            f"{source.name}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
