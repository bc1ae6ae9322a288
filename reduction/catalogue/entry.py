"""What the index keeps of one archive, between the reading of it and the writing of the index."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.record import Floats

__all__ = ["WHOLE", "ArchiveEntry", "Block"]

WHOLE = -1
"""Place of the specimen of a number that belongs to the whole test."""


@dataclass(frozen=True)
class Block:
    """Numbers that stand on the same dimensions.

    Parameters
    ----------
    quantity : NDArray of str
        Names, shape (n_values,).
    specimen : NDArray of int
        Which specimen of the archive, or `WHOLE`, shape (n_values,).
    value, standard_uncertainty : Floats
        NaN where none is known, shape (n_values,). [SI]
    place : dict of str to NDArray
        Text or number along each dimension, each of shape (n_values,).
    """

    quantity: NDArray[np.object_]
    specimen: NDArray[np.int32]
    value: Floats
    standard_uncertainty: Floats
    place: dict[str, NDArray[Any]]


@dataclass(frozen=True)
class ArchiveEntry:
    """What the index keeps of an archive; ``fault`` says why it could not be read."""

    identity: str
    whole: dict[str, str | float]
    specimens: tuple[dict[str, str | float], ...] = ()
    blocks: tuple[Block, ...] = ()
    fault: str = ""
