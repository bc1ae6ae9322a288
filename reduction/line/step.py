"""What one step of a rope laboratory's programme gave, whichever step it was.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4 to 6.
"""

from __future__ import annotations

from dataclasses import dataclass

from reduction.line.failure import CyclesToFailure
from reduction.line.held import HeldPair
from reduction.line.programme import BeddingIn, DynamicStiffness
from reduction.line.static import CreepOfHold
from reduction.line.tensile import TensilePull


@dataclass(frozen=True)
class RopeStep:
    """One step: parts that it does not give are None, or empty.

    ``name`` says what it gives, in words; ``dynamic`` has one level, the step; ``creep`` has
    one entry a hold, in the order of the holds of the test.
    """

    name: str
    bedding_in: BeddingIn | None = None
    dynamic: DynamicStiffness | None = None
    held: tuple[HeldPair, ...] = ()
    creep: tuple[CreepOfHold, ...] = ()
    lasted: CyclesToFailure | None = None
    tensile: TensilePull | None = None
    notes: tuple[str, ...] = ()
