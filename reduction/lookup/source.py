"""What the pieces of one line or tether are from: its tests, its splices, what is stated of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from reduction.errors import DataError
from reduction.lookup.composite import CompositeCurve, composite_curve
from reduction.lookup.compositerule import CompositeRule
from reduction.lookup.pieces import CurvePiece, PieceBranch
from reduction.strain.model import StrainModel


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
        Where the pieces are from, and what else is behind them.
    piece_sources : tuple of str
        Of each piece, one of ``sources``; empty where they are not told apart.
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
    piece_sources: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False


def used_of(source: PieceSource, curve: CompositeCurve) -> PieceSource:
    """What of a source stands behind a curve: sources of pieces that are not in it are left out.

    Parameters
    ----------
    source : PieceSource
        Of all pieces.
    curve : CompositeCurve
        Of some of them.

    Returns
    -------
    source : PieceSource
        With the sources of those, and a note that names the other tests.

    Raises
    ------
    ValueError
        If sources of pieces are told, and not of each.

    Notes
    -----
    A rule leaves out kinds: a test with none of those that it names is no source of the curve.

    References
    ----------
    .. [1] WHOI-2005-10, as `reduction.lookup.composite`.

    Examples
    --------
    >>> import numpy as np
    >>> at = np.array([0.5, 1.0])
    >>> pieces = [CurvePiece(name, kind, "ascending", at, 100 * at, 0 * at)
    ...     for name, kind in (("Q", "static"), ("R", "cyclic"))]
    >>> rope = PieceSource("rope", "ascending", tuple(pieces), None, sources=("log Q", "log R"),
    ...     piece_sources=("log Q", "log R"))
    >>> found = used_of(rope, compose(rope, CompositeRule(precedence=("static",))))
    >>> print(found.sources, found.notes)
    ('log Q',) ('of other kinds, and not used: R',)
    """
    if not source.piece_sources:
        return source
    pairs = list(zip(source.pieces, source.piece_sources, strict=True))
    used = {where for one, where in pairs if one.words in curve.piece_words}
    left = {where: one.name for one, where in pairs if where not in used}
    left = {where: name for where, name in left.items() if where in source.sources}
    if not left:
        return source
    return replace(
        source,
        sources=tuple(text for text in source.sources if text not in left),
        notes=(*source.notes, f"of other kinds, and not used: {', '.join(left.values())}"),
    )


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
