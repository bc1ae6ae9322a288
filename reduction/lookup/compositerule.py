"""How pieces of a tension-strain curve become one: which kind goes first, and how they fade."""

from __future__ import annotations

from dataclasses import dataclass

from reduction.errors import SettingsError
from reduction.lookup.pieces import PieceKind

_KINDS: tuple[PieceKind, ...] = ("cyclic", "static", "first-loading")


@dataclass(frozen=True)
class CompositeRule:
    """How pieces become one curve.

    Parameters
    ----------
    precedence : tuple of str
        Kinds, the one that counts first where it exists; kinds that are not named are not used.
    taper : float
        Share of a piece, at each end, over which its weight falls to zero; 0.5 makes the weight
        a triangle over the whole piece.
    least_slope : float
        Share b of the least slope of the pieces there, below which that of the curve may not
        fall: 0 lets it run level where pieces fall, 1 keeps every slope and moves levels more.
    n_points : int
        Of the grid over all pieces; ends of pieces are added.
    """

    precedence: tuple[PieceKind, ...] = _KINDS
    taper: float = 0.5
    least_slope: float = 0.5
    n_points: int = 401

    def __post_init__(self) -> None:
        """Refuse a rule that cannot be followed."""
        if not self.precedence or set(self.precedence) - set(_KINDS):
            raise SettingsError(
                "the precedence names no kind of piece",
                found=", ".join(self.precedence) or "nothing",
                needed="of " + ", ".join(_KINDS),
            )
        if len(set(self.precedence)) < len(self.precedence):
            raise SettingsError(
                "the precedence names a kind twice", found=", ".join(self.precedence)
            )
        if not 0 < self.taper <= 0.5:
            raise SettingsError(
                "the taper is a share of a piece", found=f"{self.taper:g}", needed="above 0, to 0.5"
            )
        if not 0 <= self.least_slope <= 1:
            raise SettingsError(
                "the least slope is a share of that of the pieces",
                found=f"{self.least_slope:g}",
                needed="0 to 1",
            )
        if self.n_points < 2:
            raise SettingsError("a grid has two points", found=str(self.n_points))
